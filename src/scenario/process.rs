//! What a scenario says about the process: when dye is given, how long it lasts, what is recorded.

use serde::{Deserialize, Serialize};

use super::check::{Checker, Problem};
use super::units::Time;
use crate::pattern::Pattern;

/// Frames of a recording whose scenario does not say: a second of film.
const DEFAULT_FRAMES: u32 = 25;
/// The most frames one recording may have.
pub const MOST_FRAMES: u32 = 1_000_000;

/// One way in which dye is given to the cloth (paper D §2; model section 3).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Supply", deny_unknown_fields)]
pub enum SupplySpec {
    /// Given once: the liquid there gets at least this much dye.
    Dose {
        /// Where on the cloth; half a pattern gives half the dose.
        shape: Pattern,
        /// Concentration of the dye in the liquid, 0 to 1 (full).
        #[serde(default = "full")]
        dose: f64,
        /// When.
        #[serde(default = "start")]
        at: Time,
    },
    /// Kept up: the liquid there stays at this concentration while it lasts.
    Hold {
        /// Where on the cloth; half a pattern holds half the dose.
        shape: Pattern,
        /// Concentration of the dye in the liquid, 0 to 1 (full).
        #[serde(default = "full")]
        dose: f64,
        /// From when.
        #[serde(default = "start")]
        from: Time,
        /// Until when. Left out: to the end.
        #[serde(default)]
        until: Option<Time>,
    },
    /// Taken up from a bath through wax or other cover (paper B; model section 3): each step brings
    /// the liquid nearer to the bath's by s = α·p·(M_s − c).
    Bath {
        /// p, how far the bath reaches through: all of it where 1, nothing where 0.
        shape: Pattern,
        /// M_s, the concentration of the bath, 0 to 1 (full).
        #[serde(default = "full")]
        dose: f64,
        /// α, the share of the difference that one step makes up, 0 to 0.5.
        #[serde(default = "bath_speed")]
        speed: f64,
        /// From when.
        #[serde(default = "start")]
        from: Time,
        /// Until when. Left out: to the end.
        #[serde(default)]
        until: Option<Time>,
    },
}

fn bath_speed() -> f64 {
    0.3
}

fn full() -> f64 {
    1.0
}

fn start() -> Time {
    Time::Steps(0)
}

impl SupplySpec {
    /// Where dye is given.
    pub fn shape(&self) -> &Pattern {
        match self {
            SupplySpec::Dose { shape, .. }
            | SupplySpec::Hold { shape, .. }
            | SupplySpec::Bath { shape, .. } => shape,
        }
    }

    pub(super) fn check(&self, at: &Checker, cell_mm: f64, step_h: f64) -> Result<(), Problem> {
        self.shape().check(&at.field("shape"), cell_mm)?;
        match self {
            SupplySpec::Dose { dose, at: when, .. } => {
                at.field("dose").within(*dose, 0.0..=1.0)?;
                when.check(&at.field("at"), step_h)
            }
            SupplySpec::Hold {
                dose, from, until, ..
            } => {
                at.field("dose").within(*dose, 0.0..=1.0)?;
                check_span(at, *from, *until, step_h)
            }
            SupplySpec::Bath {
                dose,
                speed,
                from,
                until,
                ..
            } => {
                at.field("dose").within(*dose, 0.0..=1.0)?;
                at.field("speed").within(*speed, 0.0..=0.5)?;
                check_span(at, *from, *until, step_h)
            }
        }
    }
}

fn check_span(at: &Checker, from: Time, until: Option<Time>, step_h: f64) -> Result<(), Problem> {
    from.check(&at.field("from"), step_h)?;
    let Some(until) = until else { return Ok(()) };
    until.check(&at.field("until"), step_h)?;
    if until.steps(step_h) < from.steps(step_h) {
        return Err(at.field("until").problem(format!(
            "it ends after it begins, but {until:?} is before {from:?}"
        )));
    }
    Ok(())
}

/// How long dyeing lasts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Process", deny_unknown_fields)]
pub struct ProcessSpec {
    /// From the first dye to the end.
    pub duration: Time,
    /// Δt, the length of one step in hours.
    #[serde(default = "default_step_h")]
    pub step_h: f64,
    /// How the process is computed.
    #[serde(default)]
    pub solver: Solver,
    /// The largest error that the accelerated solver may make in the concentration of any cell in
    /// one of its leaps, as estimated, as a share of full scale.
    #[serde(default = "default_tolerance")]
    pub tolerance: f64,
}

/// How the process is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Solver {
    /// In leaps over many steps, as long as the tolerance allows.
    #[default]
    Accelerated,
    /// One step at a time, as in paper D: the reference.
    Explicit,
}

/// So small that no pixel differs visibly.
fn default_tolerance() -> f64 {
    0.004
}

/// Δt of paper D's Table 1, h.
fn default_step_h() -> f64 {
    0.0005
}

impl ProcessSpec {
    /// Steps from the first dye to the end.
    pub fn steps(&self) -> u64 {
        self.duration.steps(self.step_h)
    }

    pub(super) fn check(&self, at: &Checker) -> Result<(), Problem> {
        at.field("step_h").within(self.step_h, 1e-9..=24.0)?;
        at.field("tolerance").within(self.tolerance, 1e-6..=0.1)?;
        self.duration.check(&at.field("duration"), self.step_h)
    }
}

/// What a recording keeps.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename = "Record", deny_unknown_fields, default)]
pub struct RecordSpec {
    /// Frames of the time-lapse, evenly spread from the first moment to the last. Left out: 25.
    pub frames: Option<u32>,
    /// The moments on the contact sheet. Left out: eight of the frames.
    pub sheet: Vec<Time>,
}

impl RecordSpec {
    /// Frames of a process of `moments` moments, where no one asks for another number.
    pub fn frames(&self, moments: u64) -> u32 {
        let frames = self.frames.unwrap_or(DEFAULT_FRAMES);
        u64::from(frames).min(moments) as u32
    }

    pub(super) fn check(&self, at: &Checker, process: &ProcessSpec) -> Result<(), Problem> {
        let moments = process.steps().saturating_add(1);
        if let Some(frames) = self.frames {
            let at = at.field("frames");
            at.within(frames, 1..=MOST_FRAMES)?;
            // Two frames of one moment would be a still in the film.
            if u64::from(frames) > moments {
                return Err(at.problem(format!(
                    "{} steps have {moments} moments, but this asks for {frames} frames",
                    process.steps(),
                )));
            }
        }
        let at = at.field("sheet");
        if self.sheet.len() > 100 {
            return Err(at.problem(format!(
                "a sheet has room for 100 moments, but this lists {}",
                self.sheet.len()
            )));
        }
        for (i, time) in self.sheet.iter().enumerate() {
            let at = at.item(i);
            time.check(&at, process.step_h)?;
            if time.steps(process.step_h) > process.steps() {
                return Err(at.problem(format!(
                    "the process ends at step {}, but this asks for {time:?}",
                    process.steps()
                )));
            }
        }
        Ok(())
    }
}
