//! How well wax lets dye through (paper B §3.3, eqs 6 and 7).
//!
//! Melted wax runs into the cloth around it before it sets, so it grows thinner towards its edges
//! and cracks. With I the drawing (0 waxed, 1 open) and d the distance to what is open, in cells:
//!
//! ```text
//! Cdist = max(Th − d, 0)      Ndist = Cdist / Th      p = a·I + (1 − a)·Ndist
//! ```
//!
//! which is 1 where the cloth is open and 0 in whole wax, Th and more from anything open. It widens
//! and softens edges and cracks.
//!
//! Paper B says "distance to the edge of the dye" of a drawing that also has greys. Here a place
//! that is open by I spreads I as far: Cdist = max over all places y of (I(y)·Th − |x − y|). For a
//! drawing of 0 and 1 this is eq 6 itself; a hairline crack gets a hairline's halo, and a wash of
//! thin wax lets through p = I.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::distance::distance_within;
use crate::pattern::Raster;

/// Steps of openness for which distances are taken.
const LEVELS: u32 = 4;

/// How wax thins out towards its edges.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PermeationSpec {
    /// Th: how far from an edge wax is thinner, cells, 0 or more.
    pub reach: f64,
    /// a: how much the drawing counts, 0 to 1; the rest is the distance to what is open.
    pub drawing: f64,
}

impl Default for PermeationSpec {
    fn default() -> Self {
        PermeationSpec {
            reach: 3.0,
            drawing: 0.9,
        }
    }
}

/// p of every cell, 0 (nothing gets through) to 1 (open), for a drawing with its cracks.
pub fn permeation(drawing: &Raster, spec: &PermeationSpec) -> Raster {
    let (th, a) = (spec.reach.max(0.0) as f32, spec.drawing as f32);
    let near = nearness(drawing, th);
    let mut p = drawing.clone();
    p.values.par_iter_mut().zip(&near).for_each(|(p, near)| {
        *p = (a * *p + (1.0 - a) * near).clamp(0.0, 1.0);
    });
    p
}

/// Ndist of every cell, 0 to 1.
fn nearness(drawing: &Raster, th: f32) -> Vec<f32> {
    if th < 1.0 {
        // Nothing but the place itself is within reach.
        return drawing.values.clone();
    }
    let level = |i: u32| i as f32 / LEVELS as f32;
    let of_levels: Vec<Vec<f32>> = (1..=LEVELS)
        .into_par_iter()
        .map(|i| {
            let least = level(i) - 0.5 / LEVELS as f32;
            let mut far = distance_within(drawing, least, (level(i) * th).ceil() as usize);
            far.iter_mut()
                .for_each(|d| *d = (level(i) - *d / th).max(0.0));
            far
        })
        .collect();
    (0..drawing.values.len())
        .into_par_iter()
        .map(|i| of_levels.iter().map(|near| near[i]).fold(0.0, f32::max))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stripe() -> Raster {
        Raster::from_rule(64, 16, |x, _| if x < 20.0 { 1.0 } else { 0.0 })
    }

    #[test]
    fn it_is_open_where_the_cloth_is_open_and_shut_beyond_the_reach() {
        let p = permeation(&stripe(), &PermeationSpec::default());
        assert!((0..20).all(|x| p.at(5, x) == 1.0));
        // The last open cell is 19: cell 25 is six away.
        assert!((25..64).all(|x| p.at(5, x) == 0.0));
    }

    #[test]
    fn it_falls_from_the_edge_as_equations_6_and_7_say() {
        let spec = PermeationSpec {
            reach: 8.0,
            drawing: 0.3,
        };
        let p = permeation(&stripe(), &spec);
        for x in 20..28 {
            let expected = 0.7 * (8.0 - (x as f32 - 19.0)) / 8.0;
            assert!((p.at(3, x) - expected).abs() < 1e-6);
        }
    }

    #[test]
    fn a_wash_of_thin_wax_lets_through_what_it_is() {
        for wash in [0.25, 0.5, 0.75, 1.0] {
            let p = permeation(&Raster::uniform(30, 20, wash), &PermeationSpec::default());
            assert!(p.values.iter().all(|p| (p - wash).abs() < 1e-6));
        }
    }

    #[test]
    fn more_open_is_never_less_permeable() {
        let less = Raster::from_rule(50, 40, |x, y| ((x * 7.3 + y * 3.1) % 1.0) as f32 * 0.6);
        let mut more = less.clone();
        more.values.iter_mut().step_by(7).for_each(|v| *v += 0.3);
        let spec = PermeationSpec::default();
        let (less, more) = (permeation(&less, &spec), permeation(&more, &spec));
        assert!(less.values.iter().zip(&more.values).all(|(a, b)| a <= b));
    }

    #[test]
    fn without_reach_the_drawing_alone_counts() {
        let spec = PermeationSpec {
            reach: 0.0,
            drawing: 0.2,
        };
        let drawing = Raster::from_rule(9, 9, |x, y| (x * y / 81.0) as f32);
        let p = permeation(&drawing, &spec);
        assert!(
            p.values
                .iter()
                .zip(&drawing.values)
                .all(|(a, b)| (a - b).abs() < 1e-6)
        );
    }
}
