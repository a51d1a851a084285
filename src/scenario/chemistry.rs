//! What a scenario says about the dye: how fast it moves in water and how it binds to fibre.

use serde::{Deserialize, Serialize};

use super::check::{Checker, Problem};

/// The dye in the bath.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Dye", deny_unknown_fields, default)]
pub struct DyeSpec {
    /// How fast the dye spreads in water.
    pub diffusivity: Diffusivity,
    /// φ₀, the equilibrium amount as a share of the free capacity: above it dye moves more slowly
    /// (Weisz–Zollinger, paper D eq 4). 1 leaves the speed alone.
    pub equilibrium: f64,
}

impl Default for DyeSpec {
    fn default() -> Self {
        DyeSpec {
            diffusivity: Diffusivity::InWater(1.93),
            equilibrium: 1.0,
        }
    }
}

/// D₀, the diffusion coefficient in water.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Diffusivity {
    /// D₀ itself, mm²/h (1.93 in paper D's Table 1).
    InWater(f64),
    /// From the molar mass M in g/mol (indigo: 262.27): D₀ = 3.6·√(76/M) mm²/h (paper D eq 5).
    MolarMass(f64),
}

impl Diffusivity {
    /// D₀ in mm²/h.
    pub fn in_water(self) -> f64 {
        match self {
            Diffusivity::InWater(d0) => d0,
            Diffusivity::MolarMass(m) => 3.6 * (76.0 / m).sqrt(),
        }
    }
}

impl DyeSpec {
    pub(super) fn check(&self, at: &Checker) -> Result<(), Problem> {
        let diffusivity = at.field("diffusivity");
        match self.diffusivity {
            Diffusivity::InWater(d0) => diffusivity.within(d0, 0.0..=1000.0)?,
            Diffusivity::MolarMass(m) => diffusivity.within(m, 1.0..=1e6)?,
        }
        at.field("equilibrium")
            .within(self.equilibrium, 0.001..=1.0)
    }
}

/// How free dye binds to fibre, one way (paper D §4.2b).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Adsorption", deny_unknown_fields)]
pub struct AdsorptionSpec {
    /// D_ab as a share of D₀ (0.01 in paper D). `Saturating` has a speed of its own instead.
    #[serde(default = "default_rate")]
    pub rate: f64,
    /// How much a fibre can bind at a given amount of free dye.
    #[serde(default)]
    pub isotherm: Isotherm,
}

fn default_rate() -> f64 {
    0.01
}

/// An adsorption isotherm: the most dye A_d that fibre binds when φ is free beside it
/// (paper D eqs 7, 8, Fig 6). Amounts are shares of a cell's volume.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Isotherm {
    /// Nernst partition, A_d = k·φ.
    Partition {
        /// k, bound per free dye.
        k: f64,
    },
    /// Freundlich, A_d = k·φᵇ.
    Freundlich {
        /// k, the amount bound at φ = 1.
        k: f64,
        /// b, 0.1 to 1: the smaller, the more binds from thin dye.
        b: f64,
    },
    /// Langmuir, A_d = V_d·K_L·φ / (1 + K_L·φ).
    Langmuir {
        /// K_L, the equilibrium constant: the larger, the sooner fibre is full.
        kl: f64,
    },
    /// No isotherm but a speed that falls as fibre fills (paper B): each step binds
    /// α_d·(a_d − A)·φ.
    Saturating {
        /// α_d, 0 to 1.
        speed: f64,
        /// a_d, the most that fibre binds, 0 to 1.
        most: f64,
    },
}

impl Default for Isotherm {
    fn default() -> Self {
        Isotherm::Partition { k: 1.0 }
    }
}

impl AdsorptionSpec {
    pub(super) fn check(&self, at: &Checker) -> Result<(), Problem> {
        at.field("rate").within(self.rate, 0.0..=1.0)?;
        let at = at.field("isotherm");
        match self.isotherm {
            Isotherm::Partition { k } => at.field("k").within(k, 0.0..=1e6),
            Isotherm::Freundlich { k, b } => {
                at.field("k").within(k, 0.0..=1e6)?;
                at.field("b").within(b, 0.1..=1.0)
            }
            Isotherm::Langmuir { kl } => at.field("kl").within(kl, 0.0..=1e6),
            Isotherm::Saturating { speed, most } => {
                at.field("speed").within(speed, 0.0..=1.0)?;
                at.field("most").within(most, 0.0..=1.0)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_molar_mass_of_indigo_gives_the_papers_diffusivity() {
        // Paper D's 1.93 mm²/h belongs to M ≈ 264; indigo is C₁₆H₁₀N₂O₂, 262.27 g/mol.
        let d0 = Diffusivity::MolarMass(262.27).in_water();
        assert!((d0 - 1.938).abs() < 5e-4, "{d0}");
    }
}
