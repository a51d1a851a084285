//! What cloth is like: quantities that textile laboratories measure, and presets.
//!
//! | quantity | measured by | unit there | unit here |
//! |---|---|---|---|
//! | weight | a balance (ISO 3801) | g/m² | g/m² |
//! | tensile modulus E | KES-FB1, at the small loads of hanging cloth | gf/cm | 0.981 N/m |
//! | shear rigidity G | KES-FB1 | gf/(cm·degree) | 56.2 N/m |
//! | bending rigidity B | KES-FB2, or Peirce's cantilever (ISO 9073-7) | gf·cm²/cm | 9.81·10⁻⁵ N·m |
//! | friction | KES-FB4 | — | — |
//!
//! The presets are typical cloths of their kind, not single specimens: weights as sold; B, G and E within
//! what is published for such cloth with Kawabata's instruments (S. Kawabata, *The Standardization and
//! Analysis of Hand Evaluation*, 2nd ed. 1980; B. P. Saville, *Physical Testing of Textiles*, 1999; J. Hu,
//! *Structure and Mechanics of Woven Fabrics*, 2004); weight and thickness of plain cotton and wool also in
//! Penava et al., *Determination of the Elastic Constants of Plain Woven Fabrics*, 2014. B is above all
//! chosen so that the bending length ∛(B/weight/g) and the drape coefficient lie where such cloth does:
//! `docs/drape.md` has them side by side.

use serde::{Deserialize, Serialize};

use super::limit::locks_at;
use super::weights::Measured;
use crate::scenario::check::{Checker, Problem};

/// A cloth by its measured properties.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Measured", deny_unknown_fields, default)]
pub struct MaterialSpec {
    /// Mass by area, g/m².
    pub weight: f64,
    /// Thickness, mm; only seen, not felt.
    pub thickness_mm: f64,
    /// E along warp and weft, N/m.
    pub stretch: (f64, f64),
    /// G, N/m.
    pub shear: f64,
    /// B of strips cut along warp and weft, N·m.
    pub bending: (f64, f64),
    /// Coulomb's coefficient against itself and other things.
    pub friction: f64,
    /// How long a stretch takes to die away, as k_d/k, s.
    pub damping: f64,
}

/// A cloth: a preset by name, or measured.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Material {
    /// Fine, sheer cotton, 75 g/m².
    CottonLawn,
    /// Plain unbleached cotton, 130 g/m²; also called calico.
    Muslin,
    /// Cotton twill, 380 g/m² (11 oz).
    Denim,
    /// Plain silk of 8 momme, 36 g/m².
    SilkHabotai,
    /// Plain linen, 170 g/m².
    Linen,
    /// Worsted suiting, 230 g/m².
    Wool,
    /// Any other.
    Measured(MaterialSpec),
}

impl Default for MaterialSpec {
    fn default() -> Self {
        Material::Muslin.measured()
    }
}

impl Material {
    /// All presets by name.
    pub const PRESETS: [(&'static str, Material); 6] = [
        ("CottonLawn", Material::CottonLawn),
        ("Muslin", Material::Muslin),
        ("Denim", Material::Denim),
        ("SilkHabotai", Material::SilkHabotai),
        ("Linen", Material::Linen),
        ("Wool", Material::Wool),
    ];

    /// Its properties.
    pub fn measured(self) -> MaterialSpec {
        // weight, thickness, E, G, B (10⁻⁶ N·m), friction
        let (weight, thickness_mm, stretch, shear, bending, friction) = match self {
            Material::CottonLawn => (75.0, 0.20, (2500.0, 1800.0), 45.0, (5.0, 3.5), 0.35),
            Material::Muslin => (130.0, 0.32, (3000.0, 2500.0), 60.0, (10.0, 8.0), 0.40),
            Material::Denim => (380.0, 0.75, (5000.0, 4000.0), 130.0, (85.0, 50.0), 0.45),
            Material::SilkHabotai => (36.0, 0.10, (2500.0, 2000.0), 15.0, (1.4, 0.9), 0.25),
            Material::Linen => (170.0, 0.38, (4000.0, 3000.0), 35.0, (22.0, 18.0), 0.40),
            Material::Wool => (230.0, 0.55, (1500.0, 1200.0), 35.0, (9.0, 7.0), 0.35),
            Material::Measured(spec) => return spec,
        };
        MaterialSpec {
            weight,
            thickness_mm,
            stretch,
            shear,
            bending: (1e-6 * bending.0, 1e-6 * bending.1),
            friction,
            damping: 2e-6,
        }
    }

    /// Checks every value against what is possible.
    ///
    /// # Errors
    /// The first [`Problem`], with its field path and what is allowed there.
    pub fn check(&self, at: &Checker) -> Result<(), Problem> {
        let Material::Measured(spec) = self else {
            return Ok(());
        };
        at.field("weight").within(spec.weight, 0.1..=1e5)?;
        at.field("thickness_mm")
            .within(spec.thickness_mm, 0.0..=100.0)?;
        for (i, stretch) in [spec.stretch.0, spec.stretch.1].into_iter().enumerate() {
            at.field("stretch").item(i).within(stretch, 0.01..=1e12)?;
        }
        at.field("shear").within(spec.shear, 0.0..=1e12)?;
        for (i, bending) in [spec.bending.0, spec.bending.1].into_iter().enumerate() {
            at.field("bending").item(i).within(bending, 0.0..=1e3)?;
        }
        at.field("friction").within(spec.friction, 0.0..=10.0)?;
        at.field("damping").within(spec.damping, 0.0..=10.0)
    }
}

impl MaterialSpec {
    /// The strain at which its yarns [lock](super::limit) in a cloth `size` metres long.
    pub fn locks_at(&self, size: f64) -> f64 {
        locks_at(
            9.81e-3 * self.weight * size,
            self.stretch.0.min(self.stretch.1),
        )
    }

    /// In SI units, weft first as along a row of particles.
    pub fn in_si(&self) -> Measured {
        Measured {
            weight: 1e-3 * self.weight,
            stretch: (self.stretch.1, self.stretch.0),
            shear: self.shear,
            bending: (self.bending.1, self.bending.0),
            // c_b about k, as the model has it.
            buckling: 1.0,
            damping: self.damping,
        }
    }
}
