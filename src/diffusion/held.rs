//! Cells whose concentration supply keeps during a leap.
//!
//! They do not change; what flows into them through their faces is followed stage by stage like the
//! dye of any other cell, and is what supply has to take away (or, negative, to bring).

use super::lanes::{Cells, LANES, Lanes, Ways};

/// One kept cell.
#[derive(Debug, Clone, Copy)]
pub struct HeldCell {
    /// Its block, counted from the first of the cloth.
    pub block: usize,
    /// Its layer.
    pub layer: usize,
    /// Its lane.
    pub lane: usize,
    /// V_u.
    pub capacity: f64,
    /// The rate at which its neighbours would fill it at the beginning of the leap, per step.
    pub rate: f64,
    /// The same at the end of the leap.
    pub rate_after: f64,
}

impl HeldCell {
    fn place(&self) -> (usize, usize, usize) {
        (self.block, self.layer, self.lane)
    }
}

/// All kept cells, row by row.
#[derive(Debug, Clone, Default)]
pub struct Held {
    /// The cells that have to be followed, in the order of their places: where something binds, or a
    /// neighbour is not kept.
    pub rim: Vec<HeldCell>,
    /// The others. What flows into them does not change.
    deep: Vec<HeldCell>,
    /// For every row, how many of the rim lie above it; one more for the end.
    above: Vec<usize>,
    /// Blocks in a row.
    blocks: usize,
}

impl Held {
    /// Those cells of a `(layer, y, x)` field; `all` are to be followed, or only the rim.
    pub fn new(lanes: Lanes, ways: &[Ways], kept: impl Iterator<Item = usize>, all: bool) -> Self {
        let cell = |i| {
            let (block, layer, lane) = lanes.place(i);
            HeldCell {
                block,
                layer,
                lane,
                capacity: 1.0 / f64::from(ways[block].per_capacity[layer][lane]),
                rate: 0.0,
                rate_after: 0.0,
            }
        };
        let mut cells: Vec<HeldCell> = kept.map(cell).collect();
        cells.sort_by_key(HeldCell::place);
        let is_kept = |place| cells.binary_search_by_key(&place, HeldCell::place).is_ok();
        let is_rim = |cell: &HeldCell| all || has_other_neighbour(lanes, ways, cell, is_kept);
        let (rim, deep): (Vec<_>, Vec<_>) = cells.iter().copied().partition(is_rim);
        let row = |y: usize| rim.partition_point(|cell| cell.block < y * lanes.blocks);
        let above = (0..=lanes.grid.ny).map(row).collect();
        Held {
            rim,
            deep,
            above,
            blocks: lanes.blocks,
        }
    }

    /// No kept cells.
    pub fn nothing(lanes: Lanes) -> Self {
        Held {
            above: vec![0; lanes.grid.ny + 1],
            blocks: lanes.blocks,
            ..Held::default()
        }
    }

    /// All kept cells.
    pub fn len(&self) -> usize {
        self.rim.len() + self.deep.len()
    }

    /// How many of the rim lie above row `y`.
    pub fn above(&self, y: usize) -> usize {
        self.above[y]
    }

    /// The rim in some blocks of row `y`, with their numbers.
    pub fn within(
        &self,
        y: usize,
        blocks: std::ops::Range<usize>,
    ) -> impl Iterator<Item = (usize, &HeldCell)> {
        let first = self.above[y];
        let row = self.rim[first..self.above[y + 1]].iter().enumerate();
        row.map(move |(i, cell)| (first + i, cell))
            .filter(move |(_, cell)| blocks.contains(&cell.block))
    }

    /// All kept cells of row `y`.
    pub fn in_row(&self, y: usize) -> impl Iterator<Item = &HeldCell> {
        let rim = self.above[y]..self.above[y + 1];
        self.rim[rim].iter().chain(self.deep_in_row(y))
    }

    /// Those of row `y` that are not followed.
    pub fn deep_in_row(&self, y: usize) -> impl Iterator<Item = &HeldCell> {
        let row = y * self.blocks..(y + 1) * self.blocks;
        let at = |block: usize| self.deep.partition_point(|cell| cell.block < block);
        self.deep[at(row.start)..at(row.end)].iter()
    }

    /// Takes the rates at the end of a leap out of a field of rates: kept cells do not change.
    pub fn take_rates(&mut self, rates: &mut [Cells]) {
        for cell in self.rim.iter_mut().chain(&mut self.deep) {
            let rate = &mut rates[cell.block].0[cell.layer][cell.lane];
            cell.rate_after = f64::from(std::mem::replace(rate, 0.0));
        }
    }

    /// Lets the next leap begin.
    pub fn go_on(&mut self) {
        for cell in self.rim.iter_mut().chain(&mut self.deep) {
            cell.rate = cell.rate_after;
        }
    }
}

/// Whether dye flows between a cell and one that is not kept.
fn has_other_neighbour(
    lanes: Lanes,
    ways: &[Ways],
    cell: &HeldCell,
    is_kept: impl Fn((usize, usize, usize)) -> bool,
) -> bool {
    let (block, layer, lane) = cell.place();
    let (y, in_row) = (block / lanes.blocks, block % lanes.blocks);
    let east = if lane + 1 < LANES {
        Some((block, layer, lane + 1))
    } else {
        (in_row + 1 < lanes.blocks).then_some((block + 1, layer, 0))
    };
    let west = if lane > 0 {
        Some((block, layer, lane - 1))
    } else {
        (in_row > 0).then(|| (block - 1, layer, LANES - 1))
    };
    let south = (y + 1 < lanes.grid.ny).then(|| (block + lanes.blocks, layer, lane));
    let north = (y > 0).then(|| (block - lanes.blocks, layer, lane));
    let east_of = |(b, l, i): (usize, usize, usize)| ways[b].east[l][i];
    let south_of = |(b, l, i): (usize, usize, usize)| ways[b].south[l][i];
    let faces = [
        east.map(|place| (east_of(cell.place()), place)),
        west.map(|place| (east_of(place), place)),
        south.map(|place| (south_of(cell.place()), place)),
        north.map(|place| (south_of(place), place)),
        Some((ways[block].beside[lane], (block, 1 - layer, lane))),
    ];
    faces
        .into_iter()
        .flatten()
        .any(|(g, place)| g > 0.0 && !is_kept(place))
}
