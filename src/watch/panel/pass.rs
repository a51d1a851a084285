//! One pass over the panel: what is shown, what is looked for, what changes.

use bevy_egui::egui::{self, Align, Layout, Rect, RichText, Ui, vec2};

use super::row::{Control, Effect, HEIGHT, Kind, Pull, Row, VALUE};
use super::{PanelAsk, PanelState};
use crate::scenario::Scenario;

/// One pass over the panel.
pub(super) struct Pass<'s> {
    pub state: &'s mut PanelState,
    /// mm a cell, hours a step, cells across and down: what lengths and times are converted with.
    pub cell_mm: f64,
    pub step_h: f64,
    pub cells: (f64, f64),
    pub effect: Effect,
    /// What the rows belong to: "warp".
    of: String,
    group: &'static str,
    /// The words that are looked for.
    words: Vec<String>,
    /// A heading that is shown once a row below it is.
    heading: Option<String>,
    shown: usize,
    number: usize,
    changed: Option<String>,
    typed: bool,
}

impl<'s> Pass<'s> {
    pub fn new(scenario: &Scenario, state: &'s mut PanelState) -> Self {
        if let Some(controls) = &mut state.controls {
            controls.clear();
        }
        let cells = scenario.cloth.cells();
        let words = state.search.to_lowercase();
        Pass {
            cell_mm: scenario.cloth.cell_mm,
            step_h: scenario.process.step_h,
            cells: (cells.0.max(1) as f64, cells.1.max(1) as f64),
            effect: Effect::Anew,
            of: String::new(),
            group: "",
            words: words.split_whitespace().map(str::to_owned).collect(),
            heading: None,
            shown: 0,
            number: 0,
            changed: None,
            typed: false,
            state,
        }
    }

    pub fn ignore_search(&mut self) {
        self.words.clear();
    }

    /// What changed, and whether it is still typed.
    pub fn end(self) -> Option<(String, bool)> {
        self.state.pull = None;
        Some((self.changed?, self.typed))
    }

    pub fn search_field(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            let edit = egui::TextEdit::singleline(&mut self.state.search).hint_text("Search");
            ui.add_sized([ui.available_width() - 28.0, HEIGHT], edit);
            let clear = egui::Button::new("×");
            let clear = ui.add_enabled(!self.state.search.is_empty(), clear);
            if clear.on_hover_text("Show all parameters").clicked() {
                self.state.search.clear();
            }
        });
    }

    pub fn nothing_found(&mut self, ui: &mut Ui) {
        if !self.words.is_empty() && self.shown == 0 {
            ui.weak("No parameter has that name.");
        }
    }

    pub fn searching(&self) -> bool {
        !self.words.is_empty()
    }

    fn is_looked_for(&self, name: &str) -> bool {
        if self.words.is_empty() {
            return true;
        }
        let all = format!("{} {} {name}", self.group, self.of).to_lowercase();
        self.words.iter().all(|word| all.contains(word.as_str()))
    }

    /// Notes that something changed.
    pub fn change(&mut self, name: &str) {
        self.changed = Some(match self.of.as_str() {
            "" => name.to_owned(),
            of => format!("{name} of the {of}"),
        });
    }

    /// The same, by a text that is still typed.
    pub fn type_in(&mut self, name: &str) {
        self.change(name);
        self.typed = true;
    }

    /// Asks for a picture. Until there is one nothing changes.
    pub fn ask_image(&mut self, path: String) {
        self.state.ask = Some(PanelAsk::OpenImage { path });
    }

    /// Counts a control; says what a script does to it.
    pub fn control(&mut self, name: &str, kind: Kind) -> Option<Pull> {
        let number = self.number;
        self.number += 1;
        if let Some(controls) = &mut self.state.controls {
            let name = match self.of.as_str() {
                "" => name.to_owned(),
                of => format!("{name} of the {of}"),
            };
            controls.push(Control { name, kind });
        }
        let due = self.state.pull.take_if(|(at, _)| *at == number);
        due.map(|(_, pull)| pull)
    }

    /// A group of parameters that opens and closes.
    pub fn group(
        &mut self,
        ui: &mut Ui,
        title: &'static str,
        add: impl FnOnce(&mut Self, &mut Ui),
    ) {
        self.group = title;
        self.of = String::new();
        self.heading = None;
        self.effect = Effect::Anew;
        let open = title == "Dye";
        self.folded(ui, title, title, open, true, add);
    }

    /// Something that opens and closes within a group; says where its title stands, if it is shown.
    pub fn fold(
        &mut self,
        ui: &mut Ui,
        title: &str,
        add: impl FnOnce(&mut Self, &mut Ui),
    ) -> Option<Rect> {
        let path = format!("{}/{}/{title}", self.group, self.of);
        self.folded(ui, title, &path, false, false, add)
    }

    fn folded(
        &mut self,
        ui: &mut Ui,
        title: &str,
        path: &str,
        begins_open: bool,
        strong: bool,
        add: impl FnOnce(&mut Self, &mut Ui),
    ) -> Option<Rect> {
        if self.searching() {
            self.heading = Some(title.to_owned());
            ui.push_id(path, |ui| add(self, ui));
            self.heading = None;
            return None;
        }
        self.show_heading(ui);
        let is_open = self.state.all_open || begins_open != self.state.folds.contains(path);
        let title = match strong {
            true => RichText::new(title).strong(),
            false => RichText::new(title),
        };
        let header = egui::CollapsingHeader::new(title)
            .id_salt(path)
            .default_open(is_open)
            .open(Some(is_open));
        let shown = header.show_unindented(ui, |ui| add(self, ui));
        if shown.header_response.clicked() && !self.state.folds.remove(path) {
            self.state.folds.insert(path.to_owned());
        }
        Some(shown.header_response.rect)
    }

    /// What the rows belong to from here on, with a small heading above them; none for "".
    pub fn heading(&mut self, of: &str) {
        self.of = of.to_owned();
        self.heading = (!of.is_empty()).then(|| of.to_owned());
    }

    fn show_heading(&mut self, ui: &mut Ui) {
        let heading = self.heading.take();
        // Below the name of a group it need not be said again.
        let is_new =
            |heading: &String| self.searching() || !heading.eq_ignore_ascii_case(self.group);
        if let Some(heading) = heading.filter(is_new) {
            let mut letters = heading.chars();
            let first = letters.next().map(|c| c.to_uppercase().to_string());
            let heading = first.unwrap_or_default() + letters.as_str();
            ui.add_space(4.0);
            ui.label(RichText::new(heading).small().strong());
        }
    }

    /// A few words between the rows: why something is not there.
    pub fn say(&mut self, ui: &mut Ui, text: &str) {
        if self.searching() {
            return;
        }
        self.show_heading(ui);
        ui.add(egui::Label::new(RichText::new(text).small()).wrap());
    }

    /// A row with its value; none where another is looked for.
    pub fn row<R>(
        &mut self,
        ui: &mut Ui,
        row: &Row,
        add: impl FnOnce(&mut Self, &mut Ui) -> R,
    ) -> Option<R> {
        self.ticked_row(ui, row, None, add)
    }

    /// The same with a tick box before the name.
    pub fn ticked_row<R>(
        &mut self,
        ui: &mut Ui,
        row: &Row,
        tick: Option<&mut bool>,
        add: impl FnOnce(&mut Self, &mut Ui) -> R,
    ) -> Option<R> {
        if !self.is_looked_for(row.name) {
            return None;
        }
        self.show_heading(ui);
        self.shown += 1;
        let added = ui.push_id(row.name, |ui| {
            ui.horizontal(|ui| {
                self.name(ui, row, tick);
                add(self, ui)
            })
        });
        Some(added.inner.inner)
    }

    fn name(&mut self, ui: &mut Ui, row: &Row, tick: Option<&mut bool>) {
        let width = (ui.available_width() - VALUE - 4.0).max(48.0);
        let effect = self.effect;
        let tip = |ui: &mut Ui| {
            ui.set_max_width(280.0);
            ui.strong(row.name);
            ui.label(row.tip);
            match effect {
                Effect::Anew => ui.weak("↻ begins anew"),
                Effect::Look => ui.weak("changes the look only"),
                Effect::Kept => ui.weak("changes what is recorded only"),
            };
        };
        let cell = Layout::left_to_right(Align::Center);
        ui.allocate_ui_with_layout(vec2(width, HEIGHT), cell, |ui| {
            ui.set_min_width(width);
            ui.spacing_mut().item_spacing.x = 2.0;
            if let Some(tick) = tick {
                let pulled = self.control(row.name, Kind::Tick).is_some();
                let ticked = ui.checkbox(tick, "").on_hover_ui(tip);
                if pulled {
                    *tick = !*tick;
                }
                if pulled || ticked.changed() {
                    self.change(row.name);
                }
            }
            let mark = if effect == Effect::Anew { 12.0 } else { 0.0 };
            let room = vec2((ui.available_width() - mark).max(8.0), HEIGHT);
            ui.allocate_ui_with_layout(room, cell, |ui| {
                let label = egui::Label::new(row.name).truncate();
                ui.add(label.selectable(false).show_tooltip_when_elided(false))
                    .on_hover_ui(tip);
                ui.set_min_width(ui.available_width());
            });
            if effect == Effect::Anew {
                let mark = egui::Label::new(RichText::new("↻").weak().small());
                ui.add(mark.selectable(false)).on_hover_text("begins anew");
            }
        });
    }

    /// A button over a whole row.
    pub fn button(&mut self, ui: &mut Ui, text: &str, tip: &str) -> bool {
        if !self.is_looked_for(text) {
            return false;
        }
        self.show_heading(ui);
        self.shown += 1;
        let pulled = self.control(text, Kind::Button).is_some();
        ui.button(text).on_hover_text(tip).clicked() || pulled
    }
}
