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
    /// exchanged, and twenty times as much across as that would give, without which hardly any yarn
    /// would ever colour the next one.
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
            in_water: 1.93 * 80.0,
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

/// What faces ask of a cell.
#[derive(Clone, Copy)]
struct Cell {
    /// P.
    porosity: f32,
    /// τ₁.
    twist: f32,
    fibre: bool,
}

/// How two neighbours lie.
#[derive(Clone, Copy)]
enum Way {
    Along,
    Across,
    Between,
}

impl ExchangeSpec {
    /// w of the face between two cells.
    fn weight(&self, a: Cell, b: Cell, way: Way) -> f32 {
        let sum = a.porosity + b.porosity;
        if sum <= 0.0 {
            return 0.0;
        }
        let mean = 2.0 * a.porosity * b.porosity / sum;
        let classes = &self.classes;
        let class = match (a.fibre, b.fibre) {
            (false, false) => classes.gap_to_gap,
            (true, true) => match way {
                Way::Along => classes.along,
                Way::Across => classes.across,
                Way::Between => classes.between_layers,
            },
            _ => classes.yarn_to_gap,
        };
        (self.in_water * class) as f32 * mean * a.twist.min(b.twist)
    }

    /// The cells of one layer.
    fn cells(&self, cloth: &Cloth, layer: Layer, crossings: &Crossings, seed: u64) -> Vec<Cell> {
        let numbers = Crossings::numbers(match layer {
            Layer::Weft => &crossings.rows,
            Layer::Warp => &crossings.columns,
        });
        let seed = fold_seed(seed, 0xe0 + layer as u32);
        let (uneven, grain) = (self.uneven as f32, self.grain.max(1.0) as f32);
        let cell = |y: usize, x: usize| {
            let (across, place) = match layer {
                Layer::Weft => (y, x),
                Layer::Warp => (x, y),
            };
            let thick = along(seed, numbers[across], place as f32 / grain);
            let yarn = cloth.yarn(layer, y, x);
            Cell {
                porosity: cloth.porosity(layer, y, x) as f32 * (1.0 - uneven * 0.5 * (1.0 + thick)),
                twist: yarn.map_or(self.gap_twist, |yarn| yarn.twist) as f32,
                fibre: yarn.is_some(),
            }
        };
        let nx = cloth.grid.nx;
        (0..cloth.grid.layer_len())
            .into_par_iter()
            .map(|i| cell(i / nx, i % nx))
            .collect()
    }
}

impl Exchange {
    /// The exchange between the cells of a cloth. `seed` is that of the unevenness of its yarns.
    pub fn of(cloth: &Cloth, spec: &ExchangeSpec, seed: u64) -> Self {
        let (nx, ny) = (cloth.grid.nx, cloth.grid.ny);
        let crossings = Crossings::of(cloth);
        let cells = Layer::BOTH.map(|layer| spec.cells(cloth, layer, &crossings, seed));
        let len = nx * ny;
        let right = |layer: Layer| {
            let cells = &cells[layer as usize];
            let way = if layer == Layer::Weft {
                Way::Along
            } else {
                Way::Across
            };
            let face = |i: usize| {
                let last = (i + 1).is_multiple_of(nx);
                if last {
                    0.0
                } else {
                    spec.weight(cells[i], cells[i + 1], way)
                }
            };
            (0..len).into_par_iter().map(face).collect()
        };
        let down = |layer: Layer| {
            let cells = &cells[layer as usize];
            let way = if layer == Layer::Warp {
                Way::Along
            } else {
                Way::Across
            };
            let face = |i: usize| {
                let below = cells.get(i + nx);
                below.map_or(0.0, |below| spec.weight(cells[i], *below, way))
            };
            (0..len).into_par_iter().map(face).collect()
        };
        let [weft, warp] = &cells;
        Exchange {
            nx,
            ny,
            right: Layer::BOTH.map(right),
            down: Layer::BOTH.map(down),
            between: (0..len)
                .into_par_iter()
                .map(|i| spec.weight(weft[i], warp[i], Way::Between))
                .collect(),
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
