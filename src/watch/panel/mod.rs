//! The parameters of a scenario, as a person changes them: plain egui, no systems.
//!
//! [`parameters`] and [`weave()`] show a scenario and edit it in place; they say what changed, and the app
//! begins anew or only looks again. A scenario that passed `check` still passes it after every change: a
//! row goes no further than is allowed, and [`mend`] moves what hangs together with it.

mod batik;
mod cloth;
mod drape;
mod drawdown;
mod dye;
mod kinds;
mod lengths;
mod list;
mod look;
pub mod mend;
mod named;
mod pass;
mod pattern;
mod presets;
mod process;
mod resist;
mod row;
mod scene;
mod shapes;
mod texture;
mod things;
mod unit;
mod value;
mod view;
mod wax;
mod weave;
mod weave_rows;

use std::collections::BTreeSet;

use bevy_egui::egui;
use serde::{Deserialize, Serialize};

use crate::cloth::{Weave, WeaveMatrix};
use crate::scenario::{BatikStep, Scenario, TextureLook};

pub use named::{NAMED as NAMED_WEAVES, NamedWeave};
pub use row::{Control, Kind, Pull};

use row::Pass;

/// What the panel did to the scenario in this pass.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Change {
    /// What was changed, in a few words, such as "porosity of the warp".
    pub label: String,
    /// The pointer is still down on it, or text still typed: more of the same may follow.
    pub held: bool,
}

/// What the panel asks the app for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PanelAsk {
    /// A weaver's draft.
    OpenWif,
    /// A picture.
    OpenImage {
        /// The field that gets its file, such as `resist.of.file`.
        path: String,
    },
}

/// What the panel remembers from pass to pass.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct PanelState {
    search: String,
    /// What is not folded as it was in the beginning.
    folds: BTreeSet<String>,
    #[serde(skip)]
    weave: weave::WeaveState,
    #[serde(skip)]
    ask: Option<PanelAsk>,
    #[serde(skip)]
    all_open: bool,
    #[serde(skip)]
    controls: Option<Vec<Control>>,
    #[serde(skip)]
    pull: Option<(usize, Pull)>,
}

impl PanelState {
    /// What the panel asks for, once.
    pub fn take_ask(&mut self) -> Option<PanelAsk> {
        self.ask.take()
    }

    /// Shows only the rows that all these words are about; all rows for none.
    pub fn search(&mut self, words: &str) {
        self.search = words.to_owned();
    }

    /// Opens everything that can be folded while it is on.
    pub fn open_all(&mut self, on: bool) {
        self.all_open = on;
    }

    /// Gives the panel the weave of a draft that a scenario names, so that the editor can show it.
    pub fn set_draft(&mut self, file: &str, matrix: WeaveMatrix) {
        self.weave.set_draft(file, matrix);
    }

    /// Where the editor showed a crossing in its last pass, in points; none where it did not.
    pub fn weave_cell(&self, end: usize, pick: usize) -> Option<egui::Rect> {
        self.weave.cell(end, pick)
    }

    /// Keeps a list of the controls that are shown, from the next pass on.
    pub fn list_controls(&mut self) {
        self.controls = Some(Vec::new());
    }

    /// The controls of the last pass, in order, if they are listed.
    pub fn controls(&self) -> &[Control] {
        self.controls.as_deref().unwrap_or(&[])
    }

    /// Moves a control of the next pass by its number in [`controls`](Self::controls), as a person
    /// would with pointer or keys.
    pub fn pull(&mut self, control: usize, pull: Pull) {
        self.pull = Some((control, pull));
    }
}

/// All parameters, grouped as cloth, dye, resist, process, look and drape, below a search field. Scrolls
/// within the room that is left. Edits `scenario` in place; returns what changed.
pub fn parameters(
    ui: &mut egui::Ui,
    scenario: &mut Scenario,
    state: &mut PanelState,
) -> Option<Change> {
    let before = before(ui, scenario, state);
    let mut pass = Pass::new(scenario, state);
    row::style(ui);
    pass.search_field(ui);
    egui::ScrollArea::vertical()
        .id_salt("parameters")
        .auto_shrink(false)
        .show(ui, |ui| {
            cloth::show(&mut pass, ui, scenario);
            dye::show(&mut pass, ui, scenario);
            resist::show(&mut pass, ui, scenario);
            process::show(&mut pass, ui, scenario);
            look::show(&mut pass, ui, scenario);
            drape::show(&mut pass, ui, scenario);
            pass.nothing_found(ui);
        });
    finish(pass, ui, before, scenario)
}

/// The weave editor: the matrix to click, its repeat, moves, named weaves and drafts, and the cloth that
/// it gives. Edits `scenario` in place; returns what changed.
pub fn weave(ui: &mut egui::Ui, scenario: &mut Scenario, state: &mut PanelState) -> Option<Change> {
    let before = before(ui, scenario, state);
    let mut editor = std::mem::take(&mut state.weave);
    let mut pass = Pass::new(scenario, state);
    pass.ignore_search();
    row::style(ui);
    egui::ScrollArea::vertical()
        .id_salt("weave")
        .auto_shrink(false)
        .show(ui, |ui| {
            weave::show(&mut pass, ui, scenario, &mut editor);
        });
    let change = finish(pass, ui, before, scenario);
    state.weave = editor;
    change
}

/// The scenario before a pass in which it may change: one with input.
fn before(ui: &egui::Ui, scenario: &Scenario, state: &PanelState) -> Option<Scenario> {
    let is_busy = ui.input(|input| !input.events.is_empty() || input.pointer.any_down());
    (is_busy || state.pull.is_some()).then(|| scenario.clone())
}

fn finish(
    pass: Pass,
    ui: &egui::Ui,
    before: Option<Scenario>,
    scenario: &mut Scenario,
) -> Option<Change> {
    let (label, typed) = pass.end()?;
    mend::mend(scenario);
    if before.is_some_and(|before| before == *scenario) {
        // The same was chosen again, or a file is asked for.
        return None;
    }
    let held = typed || ui.input(|input| input.pointer.any_down());
    Some(Change { label, held })
}

/// Puts a chosen file where it was asked for.
pub fn answer(scenario: &mut Scenario, ask: &PanelAsk, file: &str) -> Change {
    let file = file.to_owned();
    let label = match ask {
        PanelAsk::OpenWif => {
            scenario.cloth.weave = Weave::Wif {
                file,
                measures: Default::default(),
            };
            "draft of the weave"
        }
        PanelAsk::OpenImage { path } => put_image(scenario, path, file),
    };
    mend::mend(scenario);
    Change {
        label: label.to_owned(),
        held: false,
    }
}

/// Puts the file of a picture into a field; says what changed.
fn put_image(scenario: &mut Scenario, path: &str, file: String) -> &'static str {
    if path == "cloth.weave.file" {
        scenario.cloth.weave = Weave::Mask { file };
        return "picture of the weave";
    }
    if path == "look.texture.file" {
        let fit = crate::pattern::Fit::Stretch;
        scenario.look.texture = TextureLook::Photo { file, fit };
        return "photograph of the cloth";
    }
    if let Some(step) = path.strip_prefix("batik.steps[")
        && let Some((number, "Wax.drawing")) = step.split_once("].")
    {
        let steps = scenario.batik.as_mut().map(|batik| &mut batik.steps);
        let step = number.parse().ok().and_then(|i: usize| steps?.get_mut(i));
        if let Some(BatikStep::Wax {
            drawing, pattern, ..
        }) = step
        {
            *drawing = Some(file);
            *pattern = None;
        }
        return "drawing of the wax";
    }
    let place = path.strip_suffix(".file").unwrap_or(path);
    if let Some(pattern) = pattern::at(scenario, place) {
        *pattern = crate::pattern::Pattern::Image {
            file,
            fit: crate::pattern::Fit::Stretch,
        };
    }
    "picture of the pattern"
}
