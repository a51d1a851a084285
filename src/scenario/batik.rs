//! What a scenario says about batik: wax, dye, wax again, dye darker, boil the wax off.

use serde::{Deserialize, Serialize};

use super::check::{Checker, Problem};
use super::units::Time;
use crate::batik::crackle::CrackleSpec;
use crate::batik::drawing::{Ground, Waxed};
use crate::batik::permeation::PermeationSpec;
use crate::batik::sweep::BathSpec;
use crate::pattern::Pattern;

/// The most baths of one recipe.
pub const MOST_BATHS: usize = 16;

/// A batik: what is done to the cloth, in order (paper B; model section 7).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Batik", deny_unknown_fields)]
pub struct BatikSpec {
    /// What is done, in order.
    pub steps: Vec<BatikStep>,
    /// The colour of the undyed cloth as (hue in degrees, saturation, value).
    #[serde(default = "cotton")]
    pub cloth: (f64, f64, f64),
    /// How dye moves through the waxed cloth.
    #[serde(default)]
    pub solver: BatikSolver,
    /// What is shown.
    #[serde(default)]
    pub show: BatikShow,
    /// Whether wax is seen until it is boiled off.
    #[serde(default = "yes")]
    pub show_wax: bool,
}

/// How dye moves through waxed cloth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum BatikSolver {
    /// Sweeps in place (paper B §3.4): a step of the process is a scan.
    PixelDiffusing {
        /// Which reading of paper B's Table 1 is taken.
        #[serde(default)]
        reading: Reading,
        /// Δt, in units of Δd²/D₀ times 1.93: see `docs/batik.md`.
        #[serde(default = "scan_time")]
        step: f64,
    },
    /// The solvers of paper D's model with its `paths`, `dye` and `adsorption`; wax is then the cover
    /// of a bath.
    Diffusion,
}

impl Default for BatikSolver {
    fn default() -> Self {
        BatikSolver::PixelDiffusing {
            reading: Reading::default(),
            step: scan_time(),
        }
    }
}

/// What a batik shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum BatikShow {
    /// The cloth.
    #[default]
    Cloth,
    /// I: the wax with its cracks, black, on what is open, white (paper B Fig 5, middle).
    Drawing,
    /// p: how well it lets dye through, from black to white (paper B Fig 5, right).
    Permeation,
}

/// A reading of the τ₂ of paper B's Table 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Reading {
    /// What the text says: dye runs mainly along yarns.
    #[default]
    Physical,
    /// The table as it is printed.
    Printed,
}

/// Something that is done to the cloth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum BatikStep {
    /// Wax is laid on, beside what is there, and cracks. Lasts one step.
    Wax {
        /// A line drawing beside the scenario file, PNG or JPEG.
        #[serde(default)]
        drawing: Option<String>,
        /// Which colour of the drawing is its ground.
        #[serde(default)]
        ground: Ground,
        /// Whether the drawing is waxed or its ground.
        #[serde(default)]
        waxed: Waxed,
        /// Instead of a drawing: where wax goes, 1 wax, 0 open.
        #[serde(default)]
        pattern: Option<Pattern>,
        /// How it breaks.
        #[serde(default)]
        crackle: CrackleSpec,
        /// How it thins out towards its edges.
        #[serde(default)]
        edge: PermeationSpec,
    },
    /// The cloth hangs in a bath of dye, which is then fixed.
    Dye {
        /// The colour of cloth full of this dye as (hue in degrees, saturation, value).
        colour: (f64, f64, f64),
        /// How long; a step is a scan of `PixelDiffusing`.
        lasts: Time,
        /// The bath.
        #[serde(default)]
        bath: BathSpec,
        /// Whether what has not bound is washed out afterwards; else all dye is fixed in the cloth.
        #[serde(default)]
        rinse: bool,
    },
    /// All wax is boiled off. Lasts one step.
    Boil,
}

fn cotton() -> (f64, f64, f64) {
    (44.0, 0.07, 0.955)
}

fn yes() -> bool {
    true
}

/// The Δt that `docs/batik.md` finds: 4 scans stay crisp, 16 show mottle.
fn scan_time() -> f64 {
    80.0
}

impl BatikStep {
    /// Steps of the process that this takes.
    pub fn steps(&self, step_h: f64) -> u64 {
        match self {
            BatikStep::Wax { .. } | BatikStep::Boil => 1,
            BatikStep::Dye { lasts, .. } => lasts.steps(step_h),
        }
    }
}

impl BatikSpec {
    /// Where every step of the recipe begins, and where the last one ends, in steps of the process.
    pub fn begins(&self, step_h: f64) -> Vec<u64> {
        let mut begins = vec![0_u64];
        let mut at = 0_u64;
        for step in &self.steps {
            at = at.saturating_add(step.steps(step_h));
            begins.push(at);
        }
        begins
    }

    /// The moments at which the work of every step of the recipe is seen: wax when it is laid on, dye
    /// at the end of its bath, the cloth at its end.
    pub fn shown(&self, step_h: f64) -> Vec<u64> {
        let begins = self.begins(step_h);
        let end = begins.last().copied().unwrap_or(0);
        let spans = self.steps.iter().zip(begins.windows(2));
        let mut shown: Vec<u64> = spans
            .map(|(step, span)| match step {
                BatikStep::Dye { .. } if span[1] > span[0] + 1 => span[1] - 1,
                _ => span[0],
            })
            .collect();
        if !matches!(self.steps.last(), Some(BatikStep::Boil)) {
            shown.push(end);
        }
        shown.dedup();
        shown
    }

    /// What has been done at a step of the process, in a few words.
    pub fn told(&self, step: u64, step_h: f64) -> String {
        let begins = self.begins(step_h);
        let last = self.steps.len().saturating_sub(1);
        let now = begins.partition_point(|begin| *begin <= step);
        let now = now.saturating_sub(1).min(last);
        let unit = if self.sweeps() { "scans" } else { "steps" };
        match self.steps.get(now) {
            Some(BatikStep::Wax { .. }) => format!("{}. waxed", now + 1),
            Some(BatikStep::Dye { lasts, .. }) => {
                let (done, all) = (step - begins[now], lasts.steps(step_h));
                format!("{}. dyed, {done} of {all} {unit}", now + 1)
            }
            Some(BatikStep::Boil) => format!("{}. boiled", now + 1),
            None => String::new(),
        }
    }

    /// Whether dye moves in sweeps.
    pub fn sweeps(&self) -> bool {
        matches!(self.solver, BatikSolver::PixelDiffusing { .. })
    }

    /// The patterns that wax is laid on by, each with its place in the scenario.
    pub(super) fn patterns(&self, at: &Checker) -> Vec<(&Pattern, Checker)> {
        let steps = self.steps.iter().enumerate();
        let each = steps.filter_map(|(i, step)| match step {
            BatikStep::Wax {
                pattern: Some(pattern),
                ..
            } => Some((
                pattern,
                at.field("steps").item(i).field("Wax").field("pattern"),
            )),
            _ => None,
        });
        each.collect()
    }

    /// The drawings, each with its place in the scenario.
    pub(super) fn drawings(&self, at: &Checker) -> Vec<(&str, Ground, Checker)> {
        let steps = self.steps.iter().enumerate();
        let each = steps.filter_map(|(i, step)| match step {
            BatikStep::Wax {
                drawing: Some(file),
                ground,
                ..
            } => {
                let at = at.field("steps").item(i).field("Wax").field("drawing");
                Some((file.as_str(), *ground, at))
            }
            _ => None,
        });
        each.collect()
    }

    pub(super) fn check(
        &self,
        at: &Checker,
        cell_mm: f64,
        step_h: f64,
        duration: u64,
    ) -> Result<(), Problem> {
        at.field("cloth").hsv(self.cloth)?;
        if let BatikSolver::PixelDiffusing { step, .. } = self.solver {
            at.field("solver").field("step").within(step, 0.0..=1e4)?;
        }
        if self.steps.is_empty() || self.steps.len() > 100 {
            return Err(at.field("steps").problem(format!(
                "1 to 100 steps are allowed, but this has {}",
                self.steps.len()
            )));
        }
        let is_bath = |step: &&BatikStep| matches!(step, BatikStep::Dye { .. });
        let baths = self.steps.iter().filter(is_bath).count();
        if baths > MOST_BATHS {
            return Err(at.field("steps").problem(format!(
                "at most {MOST_BATHS} baths are allowed, but this has {baths}"
            )));
        }
        for (i, step) in self.steps.iter().enumerate() {
            step.check(&at.field("steps").item(i), cell_mm, step_h)?;
        }
        let all = self.begins(step_h).last().copied().unwrap_or(0);
        if all != duration {
            return Err(Checker::root()
                .field("process")
                .field("duration")
                .problem(format!(
                    "the steps of `batik` take {all} together, waxing and boiling one each, so \
                     write `Steps({all})`; this is {duration}"
                )));
        }
        Ok(())
    }
}

impl BatikStep {
    fn check(&self, at: &Checker, cell_mm: f64, step_h: f64) -> Result<(), Problem> {
        match self {
            BatikStep::Wax {
                drawing,
                pattern,
                crackle,
                edge,
                ..
            } => {
                let at = at.field("Wax");
                if drawing.is_some() == pattern.is_some() {
                    return Err(at.problem(
                        "wax is laid on by a `drawing` or by a `pattern`, one of both".into(),
                    ));
                }
                if let Some(pattern) = pattern {
                    pattern.check(&at.field("pattern"), cell_mm)?;
                }
                let crackled = at.field("crackle");
                for (name, value, most) in [
                    ("density", crackle.density, 0.2),
                    ("width", crackle.width, 100.0),
                    ("thinning", crackle.thinning, 1.0),
                    ("jitter", crackle.jitter, 1.0),
                    ("folds", crackle.folds, 1.0),
                    ("crumple", crackle.crumple, 1.0),
                ] {
                    crackled.field(name).within(value, 0.0..=most)?;
                }
                crackled
                    .field("crumple_size")
                    .within(crackle.crumple_size, 1.0..=1e6)?;
                if let Some(direction) = crackle.direction {
                    crackled
                        .field("direction")
                        .within(direction, -360.0..=360.0)?;
                }
                let edged = at.field("edge");
                edged.field("reach").within(edge.reach, 0.0..=1000.0)?;
                edged.field("drawing").within(edge.drawing, 0.0..=1.0)
            }
            BatikStep::Dye {
                colour,
                lasts,
                bath,
                ..
            } => {
                let at = at.field("Dye");
                at.field("colour").hsv(*colour)?;
                lasts.check(&at.field("lasts"), step_h)?;
                if lasts.steps(step_h) == 0 {
                    return Err(at
                        .field("lasts")
                        .problem("a bath lasts at least one step".into()));
                }
                let at = at.field("bath");
                at.field("concentration")
                    .within(bath.concentration, 0.0..=1.0)?;
                at.field("supply").within(bath.supply, 0.0..=0.5)?;
                at.field("binding").within(bath.binding, 0.0..=1.0)?;
                at.field("most_bound").within(bath.most_bound, 0.0..=1.0)
            }
            BatikStep::Boil => Ok(()),
        }
    }
}
