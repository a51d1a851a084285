//! Sweeps in place, many cells at a time, to the same bits as the plain loop.
//!
//! In a sweep a cell needs the new value to its left and above, and the old value to its right and
//! below. Cells on one diagonal x + y = k need nothing of each other, so a diagonal is one vector
//! operation after another. The cloth is cut into bands of [`T`] rows; a band is kept by diagonals,
//! so that the [`T`] cells of a diagonal lie side by side, and is cut into tiles of [`T`] diagonals.
//! Tile (band, chunk) needs its own (band, chunk − 1) and (band − 1, chunk) and (band − 1,
//! chunk + 1): all tiles with the same chunk + 2·band run side by side, wave after wave. The sweep
//! back goes through everything the other way round.
//!
//! Cells of a tile that lie beyond the cloth exchange nothing and are given nothing.

use std::ops::Range;

use rayon::prelude::*;

use super::rule::{Around, Rule, update};
use super::{Account, BathSpec, Dye, Exchange};
use crate::pattern::Raster;

/// Rows of a band, and diagonals of a tile.
const T: usize = 64;
/// A line of cells with one more at both ends, which are copies of other tiles'.
const S: usize = T + 2;

/// One tile. Line `j` of it is its diagonal `j − 1`; lines 0 and T + 1, and lanes 0 and T + 1, are
/// copies of its neighbours'.
#[derive(Clone)]
struct Tile {
    band: usize,
    chunk: usize,
    /// f, of weft and warp: line by line, S lanes each.
    free: [Vec<f32>; 2],
    /// h, T lanes.
    bound: [Vec<f32>; 2],
    /// Exchange to the right, from one line before the first: T lanes.
    right: [Vec<f32>; 2],
    /// Exchange downwards, from one line and one lane before the first: T + 1 lanes.
    down: [Vec<f32>; 2],
    between: Vec<f32>,
    /// α·p.
    supply: Vec<f32>,
    done: Done,
}

/// What one sweep over a tile has done, lane by lane, before γ.
#[derive(Clone, Copy)]
struct Done {
    supplied: [f32; T],
    made: [f32; T],
    truncated: [u32; T],
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
    fn new(exchange: &Exchange, band: usize, chunk: usize) -> Self {
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
    fn places(&self, grid: (usize, usize)) -> impl Iterator<Item = (usize, usize, (usize, usize))> {
        let (band, chunk) = (self.band, self.chunk);
        (0..T).flat_map(move |line| {
            (0..T).filter_map(move |lane| {
                place(grid, band, chunk, line as isize, lane as isize).map(|at| (line, lane, at))
            })
        })
    }
}

/// Dye that moves through waxed cloth, scan by scan.
#[derive(Clone)]
pub struct PixelDiffusing {
    grid: (usize, usize),
    chunks: usize,
    /// Wave by wave.
    tiles: Vec<Tile>,
    waves: Vec<Range<usize>>,
    /// Where the tile (band, chunk) is.
    found: Vec<usize>,
    rule: Rule,
    account: Account,
}

impl PixelDiffusing {
    /// Hangs waxed cloth with `dye` in it into a bath. `permeation` is p of every position.
    pub fn new(exchange: &Exchange, permeation: &Raster, bath: &BathSpec, dye: &Dye) -> Self {
        let (nx, ny) = (exchange.nx, exchange.ny);
        let bands = ny.div_ceil(T);
        let chunks = (nx + T - 1).div_ceil(T);
        let wave = |band: usize, chunk: usize| chunk + 2 * band;
        let mut order: Vec<(usize, usize)> = (0..bands)
            .flat_map(|band| (0..chunks).map(move |chunk| (band, chunk)))
            .collect();
        order.sort_by_key(|(band, chunk)| (wave(*band, *chunk), *band));
        let mut found = vec![0; bands * chunks];
        for (i, (band, chunk)) in order.iter().enumerate() {
            found[band * chunks + chunk] = i;
        }
        let mut waves = Vec::new();
        let mut begin = 0;
        for same in order.chunk_by(|a, b| wave(a.0, a.1) == wave(b.0, b.1)) {
            waves.push(begin..begin + same.len());
            begin += same.len();
        }
        let supply: Vec<f32> = permeation
            .values
            .iter()
            .map(|p| bath.supply as f32 * p)
            .collect();
        let tiles = order
            .par_iter()
            .map(|(band, chunk)| {
                let mut tile = Tile::new(exchange, *band, *chunk);
                tile.take(&supply, dye, (nx, ny));
                tile
            })
            .collect();
        PixelDiffusing {
            grid: (nx, ny),
            chunks,
            tiles,
            waves,
            found,
            rule: Rule::new(exchange, &supply, bath),
            account: Account::default(),
        }
    }

    /// One scan: a sweep from the top left to the bottom right and one back.
    pub fn scan(&mut self) {
        for wave in self.waves.clone() {
            self.sweep_wave(wave, false);
        }
        for wave in self.waves.clone().into_iter().rev() {
            self.sweep_wave(wave, true);
        }
    }

    /// The dye in the cloth now.
    pub fn dye(&self) -> Dye {
        let (nx, ny) = self.grid;
        let mut dye = Dye::none(nx, ny);
        let gather = |field: &mut [f32], of: &(dyn Fn(&Tile, usize, usize) -> f32 + Sync)| {
            field
                .par_chunks_mut((nx * T).max(1))
                .enumerate()
                .for_each(|(band, rows)| {
                    for chunk in 0..self.chunks {
                        let tile = &self.tiles[self.found[band * self.chunks + chunk]];
                        for (line, lane, (_, x)) in tile.places(self.grid) {
                            rows[lane * nx + x] = of(tile, line, lane);
                        }
                    }
                });
        };
        for layer in 0..2 {
            let own = layer * nx * ny..(layer + 1) * nx * ny;
            gather(&mut dye.free[own.clone()], &|tile, line, lane| {
                tile.free[layer][(line + 1) * S + lane + 1]
            });
            gather(&mut dye.bound[own], &|tile, line, lane| {
                tile.bound[layer][line * T + lane]
            });
        }
        dye
    }

    /// What the scans have done.
    pub fn account(&self) -> Account {
        self.account
    }

    /// γ, the share of every change that is taken.
    pub fn gamma(&self) -> f32 {
        self.rule.gamma
    }

    fn sweep_wave(&mut self, wave: Range<usize>, back: bool) {
        let (before, rest) = self.tiles.split_at_mut(wave.start);
        let (own, after) = rest.split_at_mut(wave.len());
        let tile = |band: usize, chunk: usize| {
            if chunk >= self.chunks {
                return None;
            }
            let i = *self.found.get(band * self.chunks + chunk)?;
            // A neighbour is never in the same wave.
            if i < wave.start {
                before.get(i)
            } else {
                after.get(i - wave.end)
            }
        };
        let rule = self.rule;
        own.par_iter_mut().for_each(|own| {
            own.meet(&tile);
            sweep_tile(own, &rule, back);
        });
        let gamma = f64::from(rule.gamma);
        let sum = |lanes: &[f32; T]| lanes.iter().map(|v| f64::from(*v)).sum::<f64>();
        for tile in own {
            self.account.supplied += gamma * sum(&tile.done.supplied);
            self.account.made += gamma * sum(&tile.done.made);
            let truncated = tile.done.truncated.iter().map(|n| u64::from(*n));
            self.account.truncated += truncated.sum::<u64>();
        }
    }
}

impl Tile {
    /// Takes in what belongs to its cells.
    fn take(&mut self, supply: &[f32], dye: &Dye, grid: (usize, usize)) {
        let layer_len = grid.0 * grid.1;
        for (line, lane, (y, x)) in self.places(grid).collect::<Vec<_>>() {
            let i = y * grid.0 + x;
            self.supply[line * T + lane] = supply[i];
            for layer in 0..2 {
                self.free[layer][(line + 1) * S + lane + 1] = dye.free[layer * layer_len + i];
                self.bound[layer][line * T + lane] = dye.bound[layer * layer_len + i];
            }
        }
    }

    /// Copies what it needs of its neighbours.
    fn meet<'a>(&mut self, tile: &impl Fn(usize, usize) -> Option<&'a Tile>) {
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
fn sweep_tile(tile: &mut Tile, rule: &Rule, back: bool) {
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
