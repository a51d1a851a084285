//! Where the cloth was crumpled more, wax is under more tension.

use super::{CrackleSpec, Point};
use crate::chance::{Chance, Purpose};
use crate::pattern::{Raster, clouds};

/// How much the cloth was crumpled, place by place: tension is as many times as great, 1 on the
/// whole.
pub(super) struct Crumple<'a> {
    map: Option<&'a Raster>,
    clouds: Box<dyn Fn(f64, f64) -> f32 + Sync>,
    size: f64,
    strength: f32,
}

impl<'a> Crumple<'a> {
    pub fn new(spec: &CrackleSpec, map: Option<&'a Raster>, chance: Chance) -> Self {
        Crumple {
            map,
            clouds: Box::new(clouds(chance.0, Purpose::Crumple as u32, 2)),
            size: spec.crumple_size.max(1.0),
            strength: spec.crumple as f32,
        }
    }

    /// Tension at a place, in units of the mean.
    pub fn at(&self, at: Point) -> f32 {
        let much = match self.map {
            Some(map) => {
                let (x, y) = (at[0] as usize, at[1] as usize);
                map.at(y.min(map.ny - 1), x.min(map.nx - 1))
            }
            None => (self.clouds)(f64::from(at[0]) / self.size, f64::from(at[1]) / self.size),
        };
        // Clouds are mostly near a half: spread them out.
        let spread = ((much - 0.5) * 2.6).clamp(-1.0, 1.0);
        1.0 + self.strength * spread * if spread > 0.0 { 1.5 } else { 0.9 }
    }
}
