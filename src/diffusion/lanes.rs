//! The layout that the accelerated solver computes in: blocks of neighbouring cells that fill whole
//! vector registers.
//!
//! A block is [`LANES`] cells of a row, of both layers, side by side in memory and aligned to a
//! cache line. What a block is computed from lies together, so a row is a handful of streams rather
//! than a dozen, no vector straddles two cache lines, and no page is opened for a few cells.

use rayon::prelude::*;

use crate::cloth::{Cloth, Grid, Layer};
use crate::diffusion::Faces;

/// Cells of one layer in a block: one AVX-512 register, two of AVX2, four of NEON.
pub const LANES: usize = 16;

/// One number for every cell of a block, as `[layer][x]`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub struct Cells(pub [[f32; LANES]; 2]);

impl Cells {
    /// Nothing anywhere.
    pub const ZERO: Cells = Cells([[0.0; LANES]; 2]);

    /// Every value times a number.
    pub fn times(&self, number: f32) -> Self {
        Cells(self.0.map(|layer| layer.map(|value| value * number)))
    }
}

/// What the faces of a block let through in one step, and what its cells hold.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub struct Ways {
    /// G between `x` and `x + 1`; 0 in the last column.
    pub east: [[f32; LANES]; 2],
    /// G between `y` and `y + 1`; 0 in the last row.
    pub south: [[f32; LANES]; 2],
    /// G between the layers.
    pub beside: [f32; LANES],
    /// 1/V_u; 0 in a cell that holds no liquid, and beyond the edge.
    pub per_capacity: [[f32; LANES]; 2],
}

impl Ways {
    /// Nothing passes anywhere.
    pub const SHUT: Ways = Ways {
        east: [[0.0; LANES]; 2],
        south: [[0.0; LANES]; 2],
        beside: [0.0; LANES],
        per_capacity: [[0.0; LANES]; 2],
    };
}

/// How the cells of a grid lie in blocks: row by row. The last block of a row may reach beyond the
/// edge of the cloth, where nothing holds any liquid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Lanes {
    /// The size of the cloth in cells.
    pub grid: Grid,
    /// Blocks in a row.
    pub blocks: usize,
}

impl Lanes {
    /// The blocks of a grid.
    pub fn new(grid: Grid) -> Self {
        Lanes {
            grid,
            blocks: grid.nx.div_ceil(LANES),
        }
    }

    /// Blocks in all.
    pub fn len(self) -> usize {
        self.blocks * self.grid.ny
    }

    /// Where a cell of a `(layer, y, x)` field lies: its block, layer and lane.
    pub fn place(self, i: usize) -> (usize, usize, usize) {
        let Grid { nx, ny } = self.grid;
        let (row, x) = (i / nx, i % nx);
        let (layer, y) = (row / ny, row % ny);
        (y * self.blocks + x / LANES, layer, x % LANES)
    }

    /// Fills blocks from a `(layer, y, x)` field.
    pub fn pack(self, field: &[f32], blocks: &mut [Cells]) {
        let nx = self.grid.nx;
        let (weft, warp) = field.split_at(self.grid.layer_len());
        let rows = blocks.par_chunks_mut(self.blocks);
        rows.zip(weft.par_chunks(nx).zip(warp.par_chunks(nx)))
            .for_each(|(blocks, (weft, warp))| {
                for (layer, row) in [weft, warp].into_iter().enumerate() {
                    for (block, cells) in blocks.iter_mut().zip(row.chunks(LANES)) {
                        block.0[layer] = [0.0; LANES];
                        block.0[layer][..cells.len()].copy_from_slice(cells);
                    }
                }
            });
    }

    /// Fills a `(layer, y, x)` field from blocks.
    pub fn unpack(self, blocks: &[Cells], field: &mut [f32]) {
        let nx = self.grid.nx;
        let (weft, warp) = field.split_at_mut(self.grid.layer_len());
        let rows = weft.par_chunks_mut(nx).zip(warp.par_chunks_mut(nx));
        rows.zip(blocks.par_chunks(self.blocks))
            .for_each(|((weft, warp), blocks)| unpack_row(blocks, [weft, warp]));
    }

    /// Blocks with the values of a rule for every cell, 0 beyond the edge.
    pub fn field(self, rule: impl Fn(Layer, usize, usize) -> f64 + Sync) -> Vec<Cells> {
        let mut field = vec![Cells::ZERO; self.len()];
        field
            .par_chunks_mut(self.blocks)
            .enumerate()
            .for_each(|(y, row)| {
                for x in 0..self.grid.nx {
                    for layer in Layer::BOTH {
                        row[x / LANES].0[layer as usize][x % LANES] = rule(layer, y, x) as f32;
                    }
                }
            });
        field
    }

    /// The ways through a cloth in one step of `step_h` hours.
    pub fn ways(self, cloth: &Cloth, faces: &Faces, step_h: f64) -> Vec<Ways> {
        let Grid { nx, ny } = self.grid;
        let scale = step_h / (cloth.cell_mm * cloth.cell_mm);
        let capacity = |layer, y, x| f64::from(cloth.capacity_free(layer, y, x));
        let mut ways = vec![Ways::SHUT; self.len()];
        ways.par_chunks_mut(self.blocks)
            .enumerate()
            .for_each(|(y, row)| {
                for x in 0..nx {
                    let (block, lane) = (&mut row[x / LANES], x % LANES);
                    for layer in Layer::BOTH {
                        let (l, here) = (layer as usize, capacity(layer, y, x));
                        if x + 1 < nx {
                            let narrower = here.min(capacity(layer, y, x + 1));
                            let g = scale * faces.x(layer, y, x) * narrower;
                            block.east[l][lane] = g as f32;
                        }
                        if y + 1 < ny {
                            let narrower = here.min(capacity(layer, y + 1, x));
                            let g = scale * faces.y(layer, y, x) * narrower;
                            block.south[l][lane] = g as f32;
                        }
                        if here > 0.0 {
                            block.per_capacity[l][lane] = (1.0 / here) as f32;
                        }
                    }
                    let narrower = capacity(Layer::Weft, y, x).min(capacity(Layer::Warp, y, x));
                    block.beside[lane] = (scale * faces.z(y, x) * narrower) as f32;
                }
            });
        ways
    }
}

/// Writes a row of blocks into the rows of both layers.
pub fn unpack_row(blocks: &[Cells], layers: [&mut [f32]; 2]) {
    for (layer, cells) in layers.into_iter().enumerate() {
        for (cells, block) in cells.chunks_mut(LANES).zip(blocks) {
            cells.copy_from_slice(&block.0[layer][..cells.len()]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_has_a_place_of_its_own_and_is_found_there() {
        for (nx, ny) in [(1, 1), (16, 2), (17, 3), (40, 5)] {
            let lanes = Lanes::new(Grid { nx, ny });
            let field: Vec<f32> = (0..2 * nx * ny).map(|i| 1.0 + i as f32).collect();
            let mut blocks = vec![Cells::ZERO; lanes.len()];
            lanes.pack(&field, &mut blocks);
            for (i, value) in field.iter().enumerate() {
                let (block, layer, lane) = lanes.place(i);
                assert_eq!(blocks[block].0[layer][lane], *value);
            }
            let beyond: f32 = blocks.iter().flat_map(|b| b.0.as_flattened()).sum();
            assert_eq!(beyond, field.iter().sum::<f32>());
        }
    }
}
