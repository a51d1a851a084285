//! The flow of dye into every cell of one row: the inner loop of the accelerated solver.
//!
//! The loop is written once, in vectors of whatever length the processor has (the `pulp` crate
//! chooses while the program runs). Every cell is computed by the same operations in the same
//! order and none is fused, so all processors give the same bytes.
//!
//! Each face is computed once: what passes it eastwards is moved on by one lane and becomes the
//! next cell's flow from the west, and what passes southwards is kept for the row below. So
//! what one cell loses the other gains, to the last bit.

use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};

use super::lanes::{Cells, LANES, Ways};
use super::passage::Passage;

/// Where in a row a vector of cells lies.
#[derive(Debug, Clone, Copy)]
pub struct At {
    /// The block, counted from the beginning of the row.
    pub block: usize,
    /// The layer.
    pub layer: usize,
    /// Which part of the block's lanes.
    pub part: usize,
}

impl At {
    /// The vector of these cells in a row.
    #[inline(always)]
    pub fn of<S: Simd>(self, row: &[Cells]) -> S::f32s {
        part::<S>(&row[self.block].0[self.layer])[self.part]
    }

    /// The vector of these cells in a row, to be changed.
    #[inline(always)]
    pub fn of_mut<S: Simd>(self, row: &mut [Cells]) -> &mut S::f32s {
        let lanes = &mut row[self.block].0[self.layer];
        &mut S::as_mut_simd_f32s(lanes).0[self.part]
    }
}

#[inline(always)]
fn part<S: Simd>(lanes: &[f32; LANES]) -> &[S::f32s] {
    S::as_simd_f32s(lanes).0
}

/// What is done with the rate at which each cell fills: dc/dt, per step.
pub trait Take {
    /// Takes the rates of some cells; `here` is what the row holds there.
    fn take<S: Simd>(&mut self, simd: S, at: At, here: S::f32s, rate: S::f32s);
}

/// One row to compute; every slice is one row of blocks.
pub struct Row<'a, P, T> {
    /// How faces pass dye.
    pub passage: P,
    /// The row itself.
    pub here: &'a [Cells],
    /// The row below; at the lower edge the row itself.
    pub below: &'a [Cells],
    /// The ways of the row.
    pub ways: &'a [Ways],
    /// What flowed south out of the row above, and in the end out of this one.
    pub south: &'a mut [Cells],
    /// Which blocks to compute.
    pub blocks: Range<usize>,
    /// What to do with the rates.
    pub take: T,
}

impl<P: Passage, T: Take> Row<'_, P, T> {
    /// Computes the row.
    pub fn compute(self) {
        Arch::new().dispatch(self);
    }
}

impl<P: Passage, T: Take> WithSimd for Row<'_, P, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Row {
            passage,
            here,
            below,
            ways,
            south,
            blocks,
            mut take,
        } = self;
        let parts = LANES / S::F32_LANES;
        let last_lane = S::F32_LANES as u32 - 1;
        let first = simd.mask_between_m32s(0, 1).mask();
        let last = simd.mask_between_m32s(last_lane, last_lane + 1).mask();
        // What flows east into the first block from the one before.
        let mut from_west = [simd.splat_f32s(0.0); 2];
        if let Some(before) = blocks.start.checked_sub(1) {
            for (layer, flow) in from_west.iter_mut().enumerate() {
                let [g, here, there] = [
                    ways[before].east[layer][LANES - 1],
                    here[before].0[layer][LANES - 1],
                    here[blocks.start].0[layer][0],
                ]
                .map(|one| simd.splat_f32s(one));
                *flow = passage.flow(simd, g, here, there);
            }
        }
        // Slices of one length let the compiler drop every bounds check.
        let end = blocks.end;
        let (below, ways, south) = (&below[..end], &ways[..end], &mut south[..end]);
        let beyond = &here[end.min(here.len() - 1)];
        let here = &here[..end];
        for block in blocks {
            let (this, way) = (&here[block], &ways[block]);
            let next = if block + 1 < end {
                &here[block + 1]
            } else {
                beyond
            };
            for p in 0..parts {
                let c = [part::<S>(&this.0[0])[p], part::<S>(&this.0[1])[p]];
                let across = passage.flow(simd, part::<S>(&way.beside)[p], c[0], c[1]);
                for layer in 0..2 {
                    let at = At {
                        block,
                        layer,
                        part: p,
                    };
                    let c = c[layer];
                    let after = if p + 1 < parts {
                        part::<S>(&this.0[layer])[p + 1]
                    } else {
                        part::<S>(&next.0[layer])[0]
                    };
                    let there = simd.rotate_left_f32s(simd.select_f32s(first, after, c), 1);
                    let g = part::<S>(&way.east[layer])[p];
                    let to_east = passage.flow(simd, g, c, there);
                    let carried = simd.select_f32s(last, from_west[layer], to_east);
                    let west = simd.rotate_right_f32s(carried, 1);
                    from_west[layer] = to_east;

                    let g = part::<S>(&way.south[layer])[p];
                    let to_south = passage.flow(simd, g, c, at.of::<S>(below));
                    let kept = at.of_mut::<S>(south);
                    let north = std::mem::replace(kept, to_south);

                    // Opposite faces in pairs, so that a mirrored cloth gives the mirrored result.
                    let along = simd.sub_f32s(to_east, west);
                    let down = simd.sub_f32s(to_south, north);
                    let flow = simd.add_f32s(along, down);
                    let flow = if layer == 0 {
                        simd.add_f32s(flow, across)
                    } else {
                        simd.sub_f32s(flow, across)
                    };
                    let rate = simd.mul_f32s(part::<S>(&way.per_capacity[layer])[p], flow);
                    take.take(simd, at, c, rate);
                }
            }
        }
    }
}

/// What flows south out of a row into the one below, which stands at the beginning of a sweep.
pub struct Southwards<'a, P> {
    /// How faces pass dye.
    pub passage: P,
    /// The row.
    pub here: &'a [Cells],
    /// The row below.
    pub below: &'a [Cells],
    /// The ways of the row.
    pub ways: &'a [Ways],
    /// What flows.
    pub south: &'a mut [Cells],
    /// Which blocks to compute.
    pub blocks: Range<usize>,
}

impl<P: Passage> Southwards<'_, P> {
    /// Computes the flows.
    pub fn compute(self) {
        Arch::new().dispatch(self);
    }
}

impl<P: Passage> WithSimd for Southwards<'_, P> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for block in self.blocks.clone() {
            for layer in 0..2 {
                for p in 0..LANES / S::F32_LANES {
                    let at = At {
                        block,
                        layer,
                        part: p,
                    };
                    let g = part::<S>(&self.ways[block].south[layer])[p];
                    let (here, there) = (at.of::<S>(self.here), at.of::<S>(self.below));
                    *at.of_mut::<S>(self.south) = self.passage.flow(simd, g, here, there);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diffusion::passage::{Fick, Law};

    /// Numbers from 0 to 1 without any order.
    fn noise(i: usize) -> f32 {
        (i.wrapping_mul(2_654_435_761) >> 7 & 0xffff) as f32 / 65536.0
    }

    fn cells(salt: usize) -> Cells {
        Cells([0, 1].map(|l| std::array::from_fn(|i| noise(salt * 97 + l * LANES + i))))
    }

    struct Keep<'a>(&'a mut [Cells]);

    impl Take for Keep<'_> {
        #[inline(always)]
        fn take<S: Simd>(&mut self, _: S, at: At, _: S::f32s, rate: S::f32s) {
            *at.of_mut::<S>(self.0) = rate;
        }
    }

    /// The rates of a row, by vectors of this machine or one cell at a time.
    fn rates<P: Passage>(passage: P, blocks: Range<usize>, one_by_one: bool) -> Vec<Cells> {
        const BLOCKS: usize = 5;
        let row = |salt: usize| -> Vec<Cells> { (0..BLOCKS).map(|b| cells(salt + b)).collect() };
        let ways: Vec<Ways> = (0..BLOCKS)
            .map(|b| Ways {
                east: cells(40 + b).0,
                south: cells(50 + b).0,
                beside: cells(60 + b).0[0],
                per_capacity: cells(70 + b).0,
            })
            .collect();
        let (mut south, mut rates) = (row(30), vec![Cells::ZERO; BLOCKS]);
        let row = Row {
            passage,
            here: &row(10),
            below: &row(20),
            ways: &ways,
            south: &mut south,
            blocks,
            take: Keep(&mut rates),
        };
        if one_by_one {
            row.with_simd(pulp::Scalar);
        } else {
            row.compute();
        }
        rates
    }

    #[test]
    fn every_instruction_set_gives_the_same_bytes() {
        let Law::Slowed(slowed) = Law::of(0.3) else {
            panic!("much dye slows itself down");
        };
        for blocks in [0..5, 0..2, 1..4, 4..5] {
            let [vectors, cells] = [false, true].map(|one| rates(Fick, blocks.clone(), one));
            assert_eq!(vectors, cells);
            let [vectors, cells] = [false, true].map(|one| rates(slowed, blocks.clone(), one));
            assert_eq!(vectors, cells);
        }
    }

    #[test]
    fn a_row_in_pieces_gives_the_bytes_of_the_whole() {
        let whole = rates(Fick, 0..5, false);
        for (from, to) in [(0, 1), (1, 3), (3, 5)] {
            assert_eq!(rates(Fick, from..to, false)[from..to], whole[from..to]);
        }
    }
}
