//! What is measured of a dyed cloth: where its dye is, how far it has spread along the yarns and
//! across them, how mottled it is, and how far a streak goes.
//!
//! Crossings stand for *cloth cells* (paper D §4.1): each is the mean over the cells where warp end
//! `e` and weft pick `p` are both yarn.

use bevy::prelude::World;
use dyelapse::prelude::*;

/// A cloth and the dye in it.
pub struct Dyed {
    pub cloth: Cloth,
    /// φ, the free dye of each cell, as a share of its volume.
    pub free: Vec<f64>,
    /// A, the bound dye of each cell, likewise.
    pub bound: Vec<f64>,
}

impl Dyed {
    pub fn of(world: &World) -> Self {
        let cloth = world.resource::<Cloth>().clone();
        let (dye, binding) = (world.resource::<FreeDye>(), world.resource::<BoundDye>());
        let free = (0..cloth.grid.len()).map(|i| {
            let (layer, y, x) = cloth.grid.place(i);
            f64::from(dye.concentration[i]) * f64::from(cloth.capacity_free(layer, y, x))
        });
        let bound = (0..cloth.grid.len()).map(|i| f64::from(binding.at(i)));
        Dyed {
            free: free.collect(),
            bound: bound.collect(),
            cloth,
        }
    }

    /// All dye of a cell.
    pub fn dye(&self, layer: Layer, y: usize, x: usize) -> f64 {
        let i = self.cloth.grid.index(layer, y, x);
        self.free[i] + self.bound[i]
    }

    /// Every cell: its index, row and column.
    pub fn cells(&self) -> impl Iterator<Item = (usize, usize, usize)> {
        (0..self.cloth.grid.len()).map(|i| {
            let (_, y, x) = self.cloth.grid.place(i);
            (i, y, x)
        })
    }

    /// Cells from the middle of the cloth to a place.
    pub fn distance_from_middle(&self, y: usize, x: usize) -> f64 {
        let Grid { nx, ny } = self.cloth.grid;
        let away = |at: usize, cells: usize| at as f64 + 0.5 - cells as f64 / 2.0;
        libm::hypot(away(x, nx), away(y, ny))
    }

    /// The share of all dye that is at most so many cells from the middle.
    pub fn share_within(&self, radius: f64) -> f64 {
        let (mut near, mut all) = (0.0, 0.0);
        for (i, y, x) in self.cells() {
            let dye = self.free[i] + self.bound[i];
            all += dye;
            if self.distance_from_middle(y, x) <= radius {
                near += dye;
            }
        }
        near / all
    }

    /// The variance of the place of the dye in the weft yarns along them, over that across them.
    pub fn spread_along_over_across(&self) -> f64 {
        let Grid { nx, ny } = self.cloth.grid;
        let (mut all, mut first, mut second) = (0.0, [0.0; 2], [0.0; 2]);
        for y in 0..ny {
            for x in 0..nx {
                if !self.cloth.fibre(Layer::Weft, y, x) {
                    continue;
                }
                let dye = self.dye(Layer::Weft, y, x);
                all += dye;
                for (i, place) in [x as f64, y as f64].into_iter().enumerate() {
                    first[i] += dye * place;
                    second[i] += dye * place * place;
                }
            }
        }
        let variance = |i: usize| second[i] / all - (first[i] / all) * (first[i] / all);
        variance(0) / variance(1)
    }

    /// The dye of what `shows` at each crossing.
    fn crossings(&self, shows: impl Fn(usize, usize) -> Layer) -> Crossings {
        let (warp, weft) = (&self.cloth.warp, &self.cloth.weft);
        let Grid { nx, ny } = self.cloth.grid;
        let (across, down) = (nx / warp.span(0).pitch(), ny / weft.span(0).pitch());
        let mean = |e: usize, p: usize| {
            let layer = shows(e, p);
            let mut sum = 0.0;
            for y in 0..weft.span(0).width {
                for x in 0..warp.span(0).width {
                    sum += self.dye(
                        layer,
                        p * weft.span(0).pitch() + y,
                        e * warp.span(0).pitch() + x,
                    );
                }
            }
            sum / (warp.span(0).width * weft.span(0).width) as f64
        };
        let dye = (0..down).flat_map(|p| (0..across).map(move |e| (e, p)));
        Crossings {
            across,
            down,
            dye: dye.map(|(e, p)| mean(e, p)).collect(),
        }
    }

    /// The crossings as they are seen: the yarn that is up.
    pub fn seen(&self) -> Crossings {
        self.crossings(|e, p| match self.cloth.weave.warp_up(e, p) {
            true => Layer::Warp,
            false => Layer::Weft,
        })
    }

    /// The crossings of one layer, whether it is seen or not.
    pub fn layer(&self, layer: Layer) -> Crossings {
        self.crossings(|_, _| layer)
    }
}

/// The dye at every crossing.
pub struct Crossings {
    across: usize,
    down: usize,
    dye: Vec<f64>,
}

/// How far each crossing is off the smooth trend around it, as a share of that; 0 where there is
/// next to no dye, and near the edge of the cloth.
pub struct Deviations {
    across: usize,
    down: usize,
    off: Vec<f64>,
    /// √mean(residual²) / mean(trend) where there is dye.
    pub mottle: f64,
}

/// Where the trend is less than this share of its most, there is next to no dye.
const NEXT_TO_NOTHING: f64 = 0.1;

impl Crossings {
    /// Takes away the trend: at each crossing the quadratic surface that fits the 5 × 5 crossings
    /// around it best (the weights of Savitzky and Golay in two dimensions).
    pub fn without_trend(&self) -> Deviations {
        let (across, down) = (self.across, self.down);
        let mut trend = vec![0.0; self.dye.len()];
        for p in 2..down - 2 {
            for e in 2..across - 2 {
                for (j, i) in (0..25).map(|k| (k / 5, k % 5)) {
                    let (dy, dx) = (j as f64 - 2.0, i as f64 - 2.0);
                    let weight = (27.0 - 5.0 * (dx * dx + dy * dy)) / 175.0;
                    trend[p * across + e] += weight * self.dye[(p + j - 2) * across + e + i - 2];
                }
            }
        }
        let most = trend.iter().fold(0.0, |most: f64, t| most.max(*t));
        let (mut off, mut squares, mut sum, mut count) = (vec![0.0; trend.len()], 0.0, 0.0, 0.0);
        for (i, t) in trend
            .iter()
            .enumerate()
            .filter(|(_, t)| **t > NEXT_TO_NOTHING * most)
        {
            let residual = self.dye[i] - t;
            off[i] = residual / t;
            squares += residual * residual;
            sum += t;
            count += 1.0;
        }
        Deviations {
            across,
            down,
            off,
            mottle: (squares / count).sqrt() / (sum / count),
        }
    }

    /// The mottle: how far crossings are off the trend, as a share of it.
    pub fn mottle(&self) -> f64 {
        self.without_trend().mottle
    }
}

impl Deviations {
    /// The correlation with those so many crossings across and down.
    pub fn alike(&self, (across, down): (i64, i64)) -> f64 {
        self.product(self, (across, down)) / self.product(self, (0, 0))
    }

    /// The correlation with those of another cloth, place by place.
    pub fn like(&self, other: &Deviations) -> f64 {
        let own = self.product(self, (0, 0)) * other.product(other, (0, 0));
        self.product(other, (0, 0)) / own.sqrt()
    }

    fn product(&self, other: &Deviations, (across, down): (i64, i64)) -> f64 {
        let mut sum = 0.0;
        for p in 0..self.down as i64 {
            for e in 0..self.across as i64 {
                let (x, y) = (e + across, p + down);
                if (0..self.across as i64).contains(&x) && (0..self.down as i64).contains(&y) {
                    let at = |e: i64, p: i64| p as usize * self.across + e as usize;
                    sum += self.off[at(e, p)] * other.off[at(x, y)];
                }
            }
        }
        sum
    }

    /// How many crossings a deviation goes on along a direction: until the correlation is less than
    /// a half.
    pub fn length(&self, (across, down): (i64, i64)) -> i64 {
        (1..)
            .take_while(|lag| self.alike((lag * across, lag * down)) > 0.5)
            .count() as i64
    }
}
