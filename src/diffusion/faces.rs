//! The coefficients of diffusion on the faces between cells (paper D eqs 3, 4, Fig 4; model
//! section 2): D_face = D₀ · P_face · T_face, in mm²/h, for ρ = 1.

use crate::cloth::{Cloth, Layer};
use crate::scenario::Paths;

/// A cell, as a face sees it.
#[derive(Debug, Clone, Copy)]
struct Side {
    layer: Layer,
    y: usize,
    x: usize,
}

/// What the faces of a cloth let through.
#[derive(Debug, Clone, Copy)]
pub struct Faces<'a> {
    /// The cloth.
    pub cloth: &'a Cloth,
    /// Its tortuosity factors.
    pub paths: &'a Paths,
    /// D₀, the diffusion coefficient of the dye in water, mm²/h.
    pub in_water: f64,
}

impl Faces<'_> {
    /// D_face between `(layer, y, x)` and `(layer, y, x + 1)`, mm²/h.
    pub fn x(&self, layer: Layer, y: usize, x: usize) -> f64 {
        self.between(Side { layer, y, x }, Side { layer, y, x: x + 1 })
    }

    /// D_face between `(layer, y, x)` and `(layer, y + 1, x)`, mm²/h.
    pub fn y(&self, layer: Layer, y: usize, x: usize) -> f64 {
        self.between(Side { layer, y, x }, Side { layer, y: y + 1, x })
    }

    /// D_face between the two layers at `(y, x)`, mm²/h.
    pub fn z(&self, y: usize, x: usize) -> f64 {
        let [weft, warp] = Layer::BOTH.map(|layer| Side { layer, y, x });
        self.between(weft, warp)
    }

    fn between(&self, a: Side, b: Side) -> f64 {
        self.in_water * self.porosity(a, b) * self.tortuosity(a, b)
    }

    /// P_face: the harmonic mean, as of two resistances in a row.
    fn porosity(&self, a: Side, b: Side) -> f64 {
        let [a, b] = [a, b].map(|s| self.cloth.porosity(s.layer, s.y, s.x));
        2.0 * a * b / (a + b)
    }

    /// T = τ₁·τ₂·τ₃ (paper D eq 3).
    fn tortuosity(&self, a: Side, b: Side) -> f64 {
        let yarn = |s: Side| self.cloth.yarn(s.layer, s.y, s.x);
        let twist = |s: Side| yarn(s).map_or(1.0, |yarn| yarn.twist);
        let same_layer = a.layer == b.layer;
        let both_fibre = yarn(a).is_some() && yarn(b).is_some();
        let up = |s: Side| self.cloth.warp_up(s.y, s.x) == (s.layer == Layer::Warp);
        let dives = same_layer && both_fibre && up(a) != up(b);
        let along = match a.layer {
            Layer::Weft => a.x != b.x,
            Layer::Warp => a.y != b.y,
        };
        // Classes IV, III, I, II, V of paper D Fig 4: the first that fits.
        let class = match (yarn(a).is_some(), yarn(b).is_some()) {
            (false, false) => self.paths.gap_to_gap,
            (true, false) | (false, true) => self.paths.yarn_to_gap,
            _ if !same_layer => self.paths.between_layers,
            _ if !along => self.paths.across_yarn,
            _ => self.paths.along_yarn,
        };
        let dive = if dives { self.paths.dive } else { 1.0 };
        twist(a).min(twist(b)) * dive * class
    }
}
