//! How much dye neighbours exchange in one update (paper B eqs 3 to 5, Fig 4, Table 1).
//!
//! w_ij = D_ij·Δt/Δd², D_ij = D₀·P·T, T = τ₁τ₂, without a unit. P of a face is the harmonic mean of
//! both cells, τ₁ the smaller one of both yarns, as in the model of paper D. Paper B disturbs P along
//! the yarns as well: spun yarn is thick and thin, and dye runs through it in places farther than in
//! others.

use rayon::prelude::*;

use crate::batik::crossings::Crossings;
use crate::batik::noise::{along, fold_seed};
use crate::cloth::{Cloth, Layer};

/// τ₂ by how two neighbours lie (paper B Fig 4), 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Classes {
    /// I: in one layer, along the yarn.
    pub along: f64,
    /// II: in one layer, across the yarn.
    pub across: f64,
    /// III: in the other layer.
    pub between_layers: f64,
    /// IV: from yarn to gap.
    pub yarn_to_gap: f64,
    /// V: from gap to gap.
    pub gap_to_gap: f64,
}

impl Classes {
    /// Table 1 of paper B as it is printed: I and V 0.001; II, III and IV 0.5.
    pub const PRINTED: Classes = Classes {
        along: 0.001,
        across: 0.5,
        between_layers: 0.5,
        yarn_to_gap: 0.5,
        gap_to_gap: 0.001,
    };

    /// What the text of paper B says, that dye runs mainly along yarns: the two numbers of the table
    /// exchanged, and twenty times as much across as that would give, without which no yarn ever
    /// colours the next one.
    pub const PHYSICAL: Classes = Classes {
        along: 0.5,
        across: 0.02,
        between_layers: 0.02,
        yarn_to_gap: 0.02,
        gap_to_gap: 0.5,
    };
}

/// What [`Exchange`] is worked out from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExchangeSpec {
    /// D₀·Δt/Δd²: what neighbours would exchange in clean water.
    pub in_water: f64,
    /// τ₂.
    pub classes: Classes,
    /// τ₁ in gaps. Paper B draws τ₁ for every cell, gaps included.
    pub gap_twist: f64,
    /// The share of a yarn's porosity that it loses in its worst places, 0 to 1.
    pub uneven: f64,
    /// Cells from one place of a yarn to another that has nothing to do with it.
    pub grain: f64,
}

impl Default for ExchangeSpec {
    /// D₀ of paper B with the time step of `docs/batik.md`, and the physical reading of its table.
    fn default() -> Self {
        ExchangeSpec {
            in_water: 1.93 * 40.0,
            classes: Classes::PHYSICAL,
            // Half way between the limits of paper B's 0.025r.
            gap_twist: 0.025 * 0.75,
            uneven: 0.6,
            grain: 7.0,
        }
    }
}

/// What every cell exchanges with its neighbours in one update: symmetric, 0 through the edges of
/// the cloth.
#[derive(Debug, Clone)]
pub struct Exchange {
    /// Cells across.
    pub nx: usize,
    /// Cells down.
    pub ny: usize,
    /// With the cell to the right, of both layers: `(layer, y, x)`.
    pub right: [Vec<f32>; 2],
    /// With the cell below.
    pub down: [Vec<f32>; 2],
    /// Between both layers.
    pub between: Vec<f32>,
}

#[derive(Clone, Copy)]
struct Side {
    layer: Layer,
    y: usize,
    x: usize,
}

impl Exchange {
    /// The exchange between the cells of a cloth. `seed` is that of the unevenness of its yarns.
    pub fn of(cloth: &Cloth, spec: &ExchangeSpec, seed: u64) -> Self {
        let (nx, ny) = (cloth.grid.nx, cloth.grid.ny);
        let crossings = Crossings::of(cloth);
        let numbers = [
            Crossings::numbers(&crossings.rows),
            Crossings::numbers(&crossings.columns),
        ];
        let seeds = [0xe0, 0xe1].map(|channel| fold_seed(seed, channel));
        let (uneven, grain) = (spec.uneven, spec.grain.max(1.0) as f32);
        let porosity = |s: Side| {
            let (across, place) = match s.layer {
                Layer::Weft => (s.y, s.x),
                Layer::Warp => (s.x, s.y),
            };
            let number = numbers[s.layer as usize][across];
            let thick = along(seeds[s.layer as usize], number, place as f32 / grain);
            let share = 1.0 - uneven * 0.5 * (1.0 + f64::from(thick));
            cloth.porosity(s.layer, s.y, s.x) * share
        };
        let weight = |a: Side, b: Side| {
            let (pa, pb) = (porosity(a), porosity(b));
            let mean = if pa + pb > 0.0 {
                2.0 * pa * pb / (pa + pb)
            } else {
                0.0
            };
            let yarn = |s: Side| cloth.yarn(s.layer, s.y, s.x);
            let twist = |s: Side| yarn(s).map_or(spec.gap_twist, |yarn| yarn.twist);
            let along = match a.layer {
                Layer::Weft => a.x != b.x,
                Layer::Warp => a.y != b.y,
            };
            let classes = &spec.classes;
            let class = match (yarn(a).is_some(), yarn(b).is_some()) {
                (false, false) => classes.gap_to_gap,
                (true, false) | (false, true) => classes.yarn_to_gap,
                _ if a.layer != b.layer => classes.between_layers,
                _ if along => classes.along,
                _ => classes.across,
            };
            (spec.in_water * mean * twist(a).min(twist(b)) * class) as f32
        };
        let field = |rule: &(dyn Fn(usize, usize) -> f32 + Sync)| {
            let mut field = vec![0.0; nx * ny];
            field
                .par_chunks_mut(nx.max(1))
                .enumerate()
                .for_each(|(y, row)| {
                    for (x, cell) in row.iter_mut().enumerate() {
                        *cell = rule(y, x);
                    }
                });
            field
        };
        let right = |layer| {
            field(&move |y, x| {
                if x + 1 == nx {
                    return 0.0;
                }
                weight(Side { layer, y, x }, Side { layer, y, x: x + 1 })
            })
        };
        let down = |layer| {
            field(&move |y, x| {
                if y + 1 == ny {
                    return 0.0;
                }
                weight(Side { layer, y, x }, Side { layer, y: y + 1, x })
            })
        };
        Exchange {
            nx,
            ny,
            right: Layer::BOTH.map(right),
            down: Layer::BOTH.map(down),
            between: field(&|y, x| {
                let [weft, warp] = Layer::BOTH.map(|layer| Side { layer, y, x });
                weight(weft, warp)
            }),
        }
    }

    /// Σ_j w_ij of a cell, in the order of the update.
    pub(super) fn sum(&self, layer: usize, y: usize, x: usize) -> f64 {
        let i = y * self.nx + x;
        let (right, down) = (&self.right[layer], &self.down[layer]);
        let left = if x > 0 { right[i - 1] } else { 0.0 };
        let up = if y > 0 { down[i - self.nx] } else { 0.0 };
        [left, right[i], up, down[i], self.between[i]]
            .into_iter()
            .map(f64::from)
            .sum()
    }
}
