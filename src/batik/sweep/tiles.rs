//! Sweeps in place, many cells at a time, to the same bits as the plain loop.
//!
//! In a sweep a cell needs the new value to its left and above, and the old value to its right and
//! below. Cells on one diagonal x + y = k need nothing of each other, so a diagonal is one vector
//! operation after another. The cloth is cut into bands of `T` rows; a band is kept by diagonals,
//! so that the `T` cells of a diagonal lie side by side, and is cut into tiles of `T` diagonals.
//! Tile (band, chunk) needs its own (band, chunk − 1) and (band − 1, chunk) and (band − 1,
//! chunk + 1): all tiles with the same chunk + 2·band run side by side, wave after wave. The sweep
//! back goes through everything the other way round.
//!
//! Cells of a tile that lie beyond the cloth exchange nothing and are given nothing.

use std::ops::Range;

use rayon::prelude::*;

use super::rule::Rule;
use super::tile::{S, T, Tile, sweep_tile};
use super::{Account, BathSpec, Dye, Exchange};
use crate::pattern::Raster;

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

    /// Goes on from what was kept once, in the same bath.
    pub fn resume(&mut self, dye: &Dye, account: Account) {
        let grid = self.grid;
        let tiles = self.tiles.par_iter_mut();
        tiles.for_each(|tile| tile.take_dye(dye, grid));
        self.account = account;
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
