//! One tile of the sweeps: its cells, what they need of their neighbours, and their update.

use std::ops::Range;

use super::rule::{Around, Rule, update};
use super::{Dye, Exchange};

/// Rows of a band, and diagonals of a tile.
pub(super) const T: usize = 64;
/// A line of cells with one more at both ends, which are copies of other tiles'.
pub(super) const S: usize = T + 2;

/// One tile. Line `j` of it is its diagonal `j − 1`; lines 0 and T + 1, and lanes 0 and T + 1, are
/// copies of its neighbours'.
#[derive(Clone)]
pub(super) struct Tile {
    band: usize,
    chunk: usize,
    /// f, of weft and warp: line by line, S lanes each.
    pub free: [Vec<f32>; 2],
    /// h, T lanes.
    pub bound: [Vec<f32>; 2],
    /// Exchange to the right, from one line before the first: T lanes.
    right: [Vec<f32>; 2],
    /// Exchange downwards, from one line and one lane before the first: T + 1 lanes.
    down: [Vec<f32>; 2],
    between: Vec<f32>,
    /// α·p.
    supply: Vec<f32>,
    pub done: Done,
}

/// What one sweep over a tile has done, lane by lane, before γ.
#[derive(Clone, Copy)]
pub(super) struct Done {
    pub supplied: [f32; T],
    pub made: [f32; T],
    pub truncated: [u32; T],
}

impl Done {
    const NOTHING: Done = Done {
        supplied: [0.0; T],
        made: [0.0; T],
        truncated: [0; T],
    };
}

/// Where a place of a tile lies on the cloth: `(y, x)`, none beyond it. `line` and `lane` count from
/// the tile's first own ones.
fn place(
    grid: (usize, usize),
    band: usize,
    chunk: usize,
    line: isize,
    lane: isize,
) -> Option<(usize, usize)> {
    let y = (band * T) as isize + lane;
    let x = (chunk * T) as isize + line - lane;
    let (nx, ny) = grid;
    let on_cloth = (0..ny as isize).contains(&y) && (0..nx as isize).contains(&x);
    on_cloth.then_some((y as usize, x as usize))
}

impl Tile {
    pub fn new(exchange: &Exchange, band: usize, chunk: usize) -> Self {
        let grid = (exchange.nx, exchange.ny);
        let at = |field: &[f32], line: isize, lane: isize| {
            place(grid, band, chunk, line, lane).map_or(0.0, |(y, x)| field[y * grid.0 + x])
        };
        let fill = |field: &[f32], lines: Range<isize>, lanes: Range<isize>| {
            lines
                .flat_map(|line| lanes.clone().map(move |lane| (line, lane)))
                .map(|(line, lane)| at(field, line, lane))
                .collect::<Vec<f32>>()
        };
        let t = T as isize;
        Tile {
            band,
            chunk,
            free: [vec![0.0; S * S], vec![0.0; S * S]],
            bound: [vec![0.0; T * T], vec![0.0; T * T]],
            right: [0, 1].map(|layer| fill(&exchange.right[layer], -1..t, 0..t)),
            down: [0, 1].map(|layer| fill(&exchange.down[layer], -1..t, -1..t)),
            between: fill(&exchange.between, 0..t, 0..t),
            supply: vec![0.0; T * T],
            done: Done::NOTHING,
        }
    }

    /// Goes through every own cell: its line, its lane, and where it lies.
    pub fn places(
        &self,
        grid: (usize, usize),
    ) -> impl Iterator<Item = (usize, usize, (usize, usize))> {
        let (band, chunk) = (self.band, self.chunk);
        (0..T).flat_map(move |line| {
            (0..T).filter_map(move |lane| {
                place(grid, band, chunk, line as isize, lane as isize).map(|at| (line, lane, at))
            })
        })
    }
}

impl Tile {
    /// Takes in what belongs to its cells.
    pub fn take(&mut self, supply: &[f32], dye: &Dye, grid: (usize, usize)) {
        for (line, lane, (y, x)) in self.places(grid).collect::<Vec<_>>() {
            self.supply[line * T + lane] = supply[y * grid.0 + x];
        }
        self.take_dye(dye, grid);
    }

    /// Takes in the dye of its cells.
    pub fn take_dye(&mut self, dye: &Dye, grid: (usize, usize)) {
        let layer_len = grid.0 * grid.1;
        for (line, lane, (y, x)) in self.places(grid).collect::<Vec<_>>() {
            let i = y * grid.0 + x;
            for layer in 0..2 {
                self.free[layer][(line + 1) * S + lane + 1] = dye.free[layer * layer_len + i];
                self.bound[layer][line * T + lane] = dye.bound[layer * layer_len + i];
            }
        }
    }

    /// Copies what it needs of its neighbours.
    pub fn meet<'a>(&mut self, tile: &impl Fn(usize, usize) -> Option<&'a Tile>) {
        let (band, chunk) = (self.band, self.chunk);
        let (above, before) = (band.checked_sub(1), chunk.checked_sub(1));
        let find = |band: Option<usize>, chunk: Option<usize>| tile(band?, chunk?);
        let left = find(Some(band), before);
        let right = find(Some(band), Some(chunk + 1));
        let above_left = find(above, Some(chunk));
        let above_right = find(above, Some(chunk + 1));
        let below_left = find(Some(band + 1), before);
        let below_right = find(Some(band + 1), Some(chunk));
        for layer in 0..2 {
            let own = &mut self.free[layer];
            if let Some(tile) = left {
                own[1..=T].copy_from_slice(&tile.free[layer][T * S + 1..][..T]);
            }
            if let Some(tile) = right {
                own[(T + 1) * S + 1..][..T].copy_from_slice(&tile.free[layer][S + 1..][..T]);
            }
            // The last row of the band above, one diagonal on; the first row of the band below.
            if let Some(tile) = above_left {
                own[0] = tile.free[layer][T * S + T];
            }
            if let Some(tile) = above_right {
                for line in 1..T {
                    own[line * S] = tile.free[layer][line * S + T];
                }
            }
            if let Some(tile) = below_left {
                for line in 2..=T {
                    own[line * S + T + 1] = tile.free[layer][line * S + 1];
                }
            }
            if let Some(tile) = below_right {
                own[(T + 1) * S + T + 1] = tile.free[layer][S + 1];
            }
        }
    }
}

#[multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
pub(super) fn sweep_tile(tile: &mut Tile, rule: &Rule, back: bool) {
    tile.done = Done::NOTHING;
    if back {
        for line in (0..T).rev() {
            sweep_line(tile, rule, line, true, 0);
            sweep_line(tile, rule, line, true, 1);
        }
    } else {
        for line in 0..T {
            sweep_line(tile, rule, line, false, 1);
            sweep_line(tile, rule, line, false, 0);
        }
    }
}

/// Updates the cells of one diagonal in one layer.
#[inline(always)]
fn sweep_line(tile: &mut Tile, rule: &Rule, line: usize, back: bool, layer: usize) {
    let [weft, warp] = &mut tile.free;
    let (own, other) = if layer == 0 {
        (weft, warp)
    } else {
        (warp, weft)
    };
    let (earlier, rest) = own.split_at_mut((line + 1) * S);
    let (own, later) = rest.split_at_mut(S);
    let earlier = &earlier[line * S..];
    let own = &mut own[1..=T];
    let other = &other[(line + 1) * S + 1..][..T];
    let (left, up) = (&earlier[1..=T], &earlier[..T]);
    let (right, down) = (&later[1..=T], &later[2..T + 2]);
    let left_w = &tile.right[layer][line * T..][..T];
    let right_w = &tile.right[layer][(line + 1) * T..][..T];
    let up_w = &tile.down[layer][line * (T + 1)..][..T];
    let down_w = &tile.down[layer][(line + 1) * (T + 1) + 1..][..T];
    let between = &tile.between[line * T..][..T];
    let supply = &tile.supply[line * T..][..T];
    let bound = &mut tile.bound[layer][line * T..][..T];
    let warp_first = (layer == 1) != back;
    let done = &mut tile.done;
    for i in 0..T {
        let before = own[i];
        let updated = update(
            rule,
            Around {
                f: before,
                h: bound[i],
                others: [left[i], right[i], up[i], down[i], other[i]],
                weights: [left_w[i], right_w[i], up_w[i], down_w[i], between[i]],
                supply: supply[i],
            },
        );
        own[i] = updated.f;
        bound[i] = updated.h;
        let beside = if back {
            left_w[i] + up_w[i]
        } else {
            right_w[i] + down_w[i]
        };
        let later = beside + if warp_first { between[i] } else { 0.0 };
        done.supplied[i] += updated.supplied;
        done.made[i] += later * (updated.f - before);
        done.truncated[i] += u32::from(updated.truncated);
    }
}
