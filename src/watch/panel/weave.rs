//! The weave editor: a matrix to click, and the cloth that it gives.

use std::sync::Arc;

use bevy_egui::egui::{self, EventFilter, Key, Pos2, Rect, Sense, Stroke, Ui, vec2};

use super::drawdown::{draw, preview};
use super::row::{HEIGHT, Kind, Pass, row};
use super::weave_rows::{kinds, load, parameters};
use crate::cloth::{Weave, WeaveMatrix};
use crate::draft::{self, Draft, Floats, floats};
use crate::scenario::Scenario;

/// The largest repeat that is edited here, in ends and in picks.
const LARGEST_EDITED: usize = 256;

/// What the editor remembers between passes.
#[derive(Debug, Clone, Default)]
pub(super) struct WeaveState {
    /// The weave that was shown last, as a matrix, and its floats; none where only a file says.
    known: Option<(Weave, Option<Arc<WeaveMatrix>>, [Floats; 2])>,
    /// The weave of a draft that the app has read.
    draft: Option<(String, WeaveMatrix)>,
    /// Where the matrix is, and the side of a crossing.
    grid: Option<(Rect, f32)>,
    /// What a stroke over the matrix sets.
    paints: Option<bool>,
    /// The crossing that the keys are at.
    cursor: (usize, usize),
}

impl WeaveState {
    pub fn set_draft(&mut self, file: &str, matrix: WeaveMatrix) {
        self.draft = Some((file.to_owned(), matrix));
        self.known = None;
    }

    pub fn cell(&self, end: usize, pick: usize) -> Option<Rect> {
        let (grid, side) = self.grid?;
        let corner = grid.min + vec2(end as f32, pick as f32) * side;
        let cell = Rect::from_min_size(corner, vec2(side, side));
        grid.expand(0.5).contains_rect(cell).then_some(cell)
    }

    /// The matrix of a weave, if it is known, kept from pass to pass.
    fn matrix(&mut self, weave: &Weave) -> Option<Arc<WeaveMatrix>> {
        if self.known.as_ref().is_none_or(|known| known.0 != *weave) {
            let matrix = match weave {
                Weave::Mask { .. } => None,
                Weave::Wif { file, .. } => self.of_draft(file),
                _ => Some(weave.matrix()),
            };
            let floats = matrix.as_ref().map(floats).unwrap_or_default();
            self.known = Some((weave.clone(), matrix.map(Arc::new), floats));
        }
        self.known.as_ref()?.1.clone()
    }

    fn of_draft(&self, file: &str) -> Option<WeaveMatrix> {
        if let Some((_, matrix)) = self.draft.as_ref().filter(|(name, _)| name == file) {
            return Some(matrix.clone());
        }
        let name = file.strip_suffix(".wif").unwrap_or(file);
        if !draft::bundled_names().contains(&name) {
            return None;
        }
        Draft::load(name)
            .ok()
            .map(|reading| reading.draft.drawdown())
    }
}

/// A weave drawn by hand from a matrix.
pub(super) fn by_hand(matrix: &WeaveMatrix) -> Weave {
    let (ends, picks) = (matrix.ends(), matrix.picks());
    drawn(ends, picks, |e, p| matrix.warp_up(e, p))
}

fn drawn(ends: usize, picks: usize, up: impl Fn(usize, usize) -> bool) -> Weave {
    let pick = |p| {
        (0..ends)
            .map(|e| if up(e, p) { 'X' } else { '.' })
            .collect()
    };
    Weave::Matrix((0..picks).map(pick).collect())
}

/// The whole editor. The matrix stands where no choice moves it.
pub(super) fn show(p: &mut Pass, ui: &mut Ui, scenario: &mut Scenario, state: &mut WeaveState) {
    p.heading("weave");
    ui.push_id("kinds", |ui| kinds(p, ui, &mut scenario.cloth));
    state.grid = None;
    let weave = &mut scenario.cloth.weave;
    let matrix = state.matrix(weave);
    let small = |matrix: &&Arc<WeaveMatrix>| matrix.ends().max(matrix.picks()) <= LARGEST_EDITED;
    match &matrix {
        None => p.say(ui, "Only its file says what this weave is like."),
        Some(_) if matrix.as_ref().filter(small).is_none() => {
            p.say(ui, "Its repeat is too large to be drawn here.");
        }
        Some(matrix) => {
            grid(p, ui, weave, matrix, state);
            moves(p, ui, weave, matrix);
            repeat_rows(p, ui, weave, matrix);
        }
    }
    ui.push_id("parameters", |ui| parameters(p, ui, weave));
    if !matches!(weave, Weave::Wif { .. }) {
        load(p, ui);
    }
    let Some(matrix) = matrix else { return };
    preview(ui, &matrix);
    if let Some((_, _, [warp, weft])) = &state.known {
        let text = format!(
            "Longest floats: warp {} picks, weft {} ends.",
            warp.longest, weft.longest
        );
        p.say(ui, &text);
        if warp.unbound + weft.unbound > 0 {
            let text = format!(
                "Not bound in: {} ends, {} picks of the repeat. They would fall out.",
                warp.unbound, weft.unbound
            );
            p.say(ui, &text);
        }
    }
}

fn repeat_rows(p: &mut Pass, ui: &mut Ui, weave: &mut Weave, matrix: &WeaveMatrix) {
    let (mut ends, mut picks) = (matrix.ends(), matrix.picks());
    p.number(
        ui,
        &row(
            "ends",
            "Warp yarns in one repeat. What is added goes on as the repeat does.",
        ),
        &mut ends,
        1..=LARGEST_EDITED,
    );
    p.number(
        ui,
        &row("picks", "Weft yarns in one repeat."),
        &mut picks,
        1..=LARGEST_EDITED,
    );
    if (ends, picks) != (matrix.ends(), matrix.picks()) {
        *weave = drawn(ends, picks, |e, p| matrix.warp_up(e, p));
    }
}

fn moves(p: &mut Pass, ui: &mut Ui, weave: &mut Weave, matrix: &WeaveMatrix) {
    let (n, m) = (matrix.ends(), matrix.picks());
    let up = |e: usize, p: usize| matrix.warp_up(e, p);
    ui.horizontal_wrapped(|ui| {
        let mut button = |text: &str, tip: &str| {
            let pulled = p.control(tip, Kind::Button).is_some();
            let button = egui::Button::new(text).min_size(vec2(HEIGHT, HEIGHT));
            let pressed = ui.add(button).on_hover_text(tip).clicked() || pulled;
            if pressed {
                p.change(tip);
            }
            pressed
        };
        if button("⬅", "Shift to the left") {
            *weave = drawn(n, m, |e, p| up(e + 1, p));
        }
        if button("➡", "Shift to the right") {
            *weave = drawn(n, m, |e, p| up(e + n - 1, p));
        }
        if button("⬆", "Shift up") {
            *weave = drawn(n, m, |e, p| up(e, p + 1));
        }
        if button("⬇", "Shift down") {
            *weave = drawn(n, m, |e, p| up(e, p + m - 1));
        }
        if button("Rotate", "Rotate by a quarter turn: warp becomes weft") {
            *weave = drawn(m, n, |e, p| !up(p, m - 1 - e));
        }
        if button("Invert", "Invert: what was up is down") {
            *weave = drawn(n, m, |e, p| !up(e, p));
        }
        if button("Mirror", "Mirror left and right") {
            *weave = drawn(n, m, |e, p| up(n - 1 - e, p));
        }
        if button("Flip", "Mirror top and bottom") {
            *weave = drawn(n, m, |e, p| up(e, m - 1 - p));
        }
    });
}

fn grid(
    p: &mut Pass,
    ui: &mut Ui,
    weave: &mut Weave,
    matrix: &WeaveMatrix,
    state: &mut WeaveState,
) {
    let (ends, picks) = (matrix.ends(), matrix.picks());
    let room = ui.available_width();
    let side = (room / ends as f32).floor().clamp(6.0, 20.0);
    let size = vec2(side * ends as f32, side * picks as f32);
    let shown = egui::ScrollArea::both()
        .id_salt("matrix")
        .max_height(300.0)
        .scroll_source(
            egui::scroll_area::ScrollSource::SCROLL_BAR
                | egui::scroll_area::ScrollSource::MOUSE_WHEEL,
        )
        .show(ui, |ui| {
            let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
            (rect, response, ui.clip_rect())
        });
    let (rect, response, clip) = shown.inner;
    state.grid = Some((rect, side));
    let painter = ui.painter().with_clip_rect(clip);
    draw(&painter, rect, side, matrix, clip);
    let at = |place: Pos2| {
        let from = (place - rect.min) / side;
        let inside = rect.contains(place) && clip.contains(place);
        inside.then(|| {
            (
                (from.x as usize).min(ends - 1),
                (from.y as usize).min(picks - 1),
            )
        })
    };
    // A stroke sets all it passes to what its first crossing becomes.
    let pointed = response.interact_pointer_pos().and_then(at);
    let mut set = None;
    let moved = ui.input(|input| input.pointer.delta() != egui::Vec2::ZERO);
    if response.is_pointer_button_down_on()
        && (moved || state.paints.is_none())
        && let Some((e, p)) = pointed
    {
        let paints = *state.paints.get_or_insert(!matrix.warp_up(e, p));
        set = Some((e, p, paints));
        state.cursor = (e, p);
    }
    if !response.is_pointer_button_down_on() {
        state.paints = None;
    }
    if response.clicked() {
        response.request_focus();
    }
    if response.has_focus() {
        set = keys(ui, &response, matrix, state).or(set);
        let corner = rect.min + vec2(state.cursor.0 as f32, state.cursor.1 as f32) * side;
        let cursor = Rect::from_min_size(corner, vec2(side, side));
        let stroke = Stroke::new(2.0, ui.visuals().selection.stroke.color);
        painter.rect_stroke(cursor, 0.0, stroke, egui::StrokeKind::Inside);
    }
    response.on_hover_text_at_pointer(
        "Click a crossing to turn it over; drag to draw. Dark: the warp is on top.",
    );
    if let Some((end, pick, value)) = set.filter(|(e, p, value)| matrix.warp_up(*e, *p) != *value) {
        *weave = drawn(ends, picks, |e, p| {
            if (e, p) == (end, pick) {
                value
            } else {
                matrix.warp_up(e, p)
            }
        });
        p.change("crossings");
    }
}

/// Arrow keys move the cursor, space turns the crossing over.
fn keys(
    ui: &Ui,
    response: &egui::Response,
    matrix: &WeaveMatrix,
    state: &mut WeaveState,
) -> Option<(usize, usize, bool)> {
    let filter = EventFilter {
        horizontal_arrows: true,
        vertical_arrows: true,
        ..EventFilter::default()
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    let (n, m) = (matrix.ends(), matrix.picks());
    let pressed = |key| ui.input(|input| input.key_pressed(key));
    let (e, p) = (state.cursor.0 % n, state.cursor.1 % m);
    state.cursor = match () {
        () if pressed(Key::ArrowLeft) => ((e + n - 1) % n, p),
        () if pressed(Key::ArrowRight) => ((e + 1) % n, p),
        () if pressed(Key::ArrowUp) => (e, (p + m - 1) % m),
        () if pressed(Key::ArrowDown) => (e, (p + 1) % m),
        () => (e, p),
    };
    let (e, p) = state.cursor;
    pressed(Key::Space).then(|| (e, p, !matrix.warp_up(e, p)))
}
