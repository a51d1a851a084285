//! What a recording says about itself: `recording.ron` and `ledger.csv`.

use std::fmt::Write;

use serde::{Deserialize, Serialize};

use crate::ledger::Ledger;

/// The file that a [`Manifest`] is kept in.
pub(super) const MANIFEST: &str = "recording.ron";

/// The contents of `recording.ron`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of the program that made the recording.
    pub dyelapse: String,
    /// The title of the scenario.
    pub title: String,
    /// The scenario file beside this one.
    pub scenario: String,
    /// The scenario's pictures that were copied with it.
    #[serde(default)]
    pub pictures: Vec<String>,
    /// SHA-256 of the scenario file.
    pub scenario_sha256: String,
    /// Seed of everything random.
    pub seed: u64,
    /// Steps that the recording was to have.
    pub steps: u64,
    /// Δt, the length of a step in hours.
    pub step_h: f64,
    /// Whether the frames show the cloth draped.
    #[serde(default)]
    pub draped: bool,
    /// Pixels of a frame, across and down.
    pub pixels: (usize, usize),
    /// Pixels along one side of a cell.
    pub pixels_per_cell: u32,
    /// Frames that the recording was to have.
    pub frames_planned: u32,
    /// Whether the fields are kept beside the frames.
    pub fields: bool,
    /// Whether maps of the relief of the cloth are there.
    #[serde(default)]
    pub maps: bool,
    /// Whether a film was to be made of them.
    pub video: bool,
    /// Whether it reached its end; false if it was stopped before.
    pub complete: bool,
    /// Every frame, in order.
    pub frames: Vec<Frame>,
}

/// One frame of a recording.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// The picture beside this file.
    pub file: String,
    /// Steps done when it was taken.
    pub step: u64,
    /// Hours of dyeing done when it was taken.
    pub hours: f64,
}

impl Manifest {
    /// The text of `recording.ron`.
    pub fn to_ron(&self) -> String {
        let pretty = ron::ser::PrettyConfig::default()
            .depth_limit(2)
            .compact_arrays(false);
        let body = ron::ser::to_string_pretty(self, pretty).unwrap_or_default();
        format!("// What this recording is. The frames show the cloth at these moments.\n{body}\n")
    }
}

/// The head of `ledger.csv`.
pub(super) const LEDGER_HEAD: &str = "step,time_h,supplied,free,bound,removed,imbalance\n";

/// Adds a frame's line to the text of `ledger.csv`. Amounts are in cell volumes.
pub(super) fn add_line(text: &mut String, step: u64, hours: f64, ledger: &Ledger) {
    let Ledger {
        supplied,
        removed,
        free,
        bound,
    } = ledger;
    let imbalance = ledger.imbalance();
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "{step},{hours},{supplied},{free},{bound},{removed},{imbalance:e}"
    );
}
