//! A cross-section: what lies below a line that is drawn on the cloth, in both layers.

use bevy::prelude::*;

use crate::adsorption::BoundDye;
use crate::cloth::{Cloth, Layer};
use crate::diffusion::FreeDye;
use crate::texture::seen;

/// What is in one layer at one place.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sample {
    /// c, the concentration of the liquid, 0 to 1.
    pub concentration: f32,
    /// φ, the free dye, as a share of the cell.
    pub free: f32,
    /// A, the bound dye, as a share of the cell.
    pub bound: f32,
    /// P, the share of the cell that is pores, unsqueezed.
    pub porosity: f32,
    /// B, how far the cell is squeezed shut, 0 to 1.
    pub resist: f32,
    /// The number of the yarn here; none in a gap.
    pub yarn: Option<u32>,
    /// Whether this layer is the one that is seen.
    pub on_top: bool,
}

/// A place of a cross-section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Where it is on the cloth, in cells across and down.
    pub at: (f64, f64),
    /// How far from the beginning of the line, mm.
    pub mm: f64,
    /// The weft layer and the warp layer.
    pub layers: [Sample; 2],
}

/// A cross-section of the cloth.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Section {
    /// The places along the line: one in the middle of each cell that it passes through.
    pub places: Vec<Place>,
    /// Length of the line, mm.
    pub mm: f64,
}

impl Section {
    /// The section along the line between two points in cells (across, down), whose corner is the
    /// upper left one of the cloth. Of a line that leaves the cloth the part on it is taken.
    pub fn along(world: &World, from: (f64, f64), to: (f64, f64)) -> Self {
        let cloth = world.resource::<Cloth>();
        let (free, bound) = (world.resource::<FreeDye>(), world.resource::<BoundDye>());
        let (across, down) = (to.0 - from.0, to.1 - from.1);
        let length = (across * across + down * down).sqrt();
        let mm = length * cloth.cell_mm;
        let places = cuts(from, to, (cloth.grid.nx as f64, cloth.grid.ny as f64))
            .windows(2)
            .filter(|cut| cut[1] - cut[0] > 1e-9)
            .map(|cut| {
                let t = 0.5 * (cut[0] + cut[1]);
                let at = (from.0 + t * (to.0 - from.0), from.1 + t * (to.1 - from.1));
                let cell = |along: f64, cells: usize| (along.max(0.0) as usize).min(cells - 1);
                let (x, y) = (cell(at.0, cloth.grid.nx), cell(at.1, cloth.grid.ny));
                let layers = Layer::BOTH.map(|layer| sample(cloth, free, bound, (layer, y, x)));
                Place {
                    at,
                    mm: t * mm,
                    layers,
                }
            })
            .collect();
        Section { places, mm }
    }
}

/// Where a line crosses from cell to cell, as shares of it, in order; with its ends, as far as it
/// lies on `size` cells. Empty where it does not.
fn cuts(from: (f64, f64), to: (f64, f64), size: (f64, f64)) -> Vec<f64> {
    let axes = [(from.0, to.0, size.0), (from.1, to.1, size.1)];
    let (mut begin, mut end) = (0.0_f64, 1.0_f64);
    for (from, to, size) in axes {
        let way = to - from;
        if way == 0.0 {
            if !(0.0..size).contains(&from) {
                return Vec::new();
            }
            continue;
        }
        let (a, b) = (-from / way, (size - from) / way);
        begin = begin.max(a.min(b));
        end = end.min(a.max(b));
    }
    let all = [from.0, from.1, to.0, to.1];
    if begin > end || all.iter().any(|number| !number.is_finite()) {
        return Vec::new();
    }
    let mut cuts = vec![begin, end];
    for (from, to, _) in axes {
        let way = to - from;
        if way == 0.0 {
            continue;
        }
        let (a, b) = (from + begin * way, from + end * way);
        let lines = a.min(b).ceil() as i64..=a.max(b).floor() as i64;
        cuts.extend(lines.map(|line| (line as f64 - from) / way));
    }
    cuts.retain(|t| (begin..=end).contains(t));
    cuts.sort_by(f64::total_cmp);
    if begin == end {
        // A point: one cell, as a line of no length.
        return vec![begin, begin + 1e-6];
    }
    cuts
}

fn sample(
    cloth: &Cloth,
    free: &FreeDye,
    bound: &BoundDye,
    (layer, y, x): (Layer, usize, usize),
) -> Sample {
    let i = cloth.grid.index(layer, y, x);
    let concentration = free.concentration.get(i).copied().unwrap_or(0.0);
    let yarns = match layer {
        Layer::Weft => (&cloth.weft, y),
        Layer::Warp => (&cloth.warp, x),
    };
    let is_yarn = cloth.yarn(layer, y, x).is_some();
    Sample {
        concentration,
        free: concentration * cloth.capacity_free(layer, y, x),
        bound: bound.at(i),
        porosity: cloth.porosity(layer, y, x) as f32,
        resist: cloth.volume_ratio(layer, y, x) as f32,
        yarn: is_yarn.then(|| yarns.0.number(yarns.1) as u32),
        on_top: seen(cloth, y, x) == layer,
    }
}
