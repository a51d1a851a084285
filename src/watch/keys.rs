//! Keys.

use bevy_egui::egui::{self, Key, Modifiers};

use super::files::Wanted;
use super::hanger::Deed;
use super::settings::Layout;
use super::state::{Open, Watch};
use super::tools::Tool;
use super::view3d::View3d;
use super::worker::{Order, Pace};
use crate::session::overlay::Field;

/// What the keys do, as the overlay shows it.
pub const KEYS: [(&str, &str); 34] = [
    ("Space", "play or pause"),
    ("→", "one frame on"),
    ("←", "one frame back"),
    ("Home, End", "to the beginning, to the end"),
    (", .", "slower, faster"),
    ("1 2 3", "both views, flat, draped"),
    ("F", "reset both views"),
    ("Tab", "parameters"),
    ("L", "plots"),
    ("O", "next overlay"),
    ("Shift O", "no overlay"),
    ("G", "gallery"),
    ("M", "cloth moves on, or rests"),
    ("D", "drape the cloth anew"),
    ("?", "these keys"),
    ("Esc", "put away what is open"),
    ("scroll", "zoom"),
    ("V", "look: drag turns or moves"),
    ("B", "brush"),
    ("[ ]", "smaller, larger brush"),
    ("H", "hand: pull the cloth"),
    ("N", "pin"),
    ("C", "crease"),
    ("X", "cross-section"),
    ("right drag", "turn, with any tool"),
    ("middle drag", "move, with any tool (or Shift drag)"),
    ("Ctrl Z", "undo"),
    ("Ctrl Y", "redo"),
    ("Ctrl O", "open"),
    ("Ctrl S", "save"),
    ("Ctrl Shift S", "save elsewhere"),
    ("R", "record"),
    ("P", "keep a picture"),
    ("Ctrl + −", "everything larger, smaller"),
];

/// How much faster or slower a key makes it.
const FASTER: f64 = 1.5;

/// Does what the keys that were pressed ask for.
pub fn act(ctx: &egui::Context, watch: &mut Watch, view: &mut View3d) {
    let press =
        |modifiers: Modifiers, key: Key| ctx.input_mut(|input| input.consume_key(modifiers, key));
    if press(Modifiers::COMMAND | Modifiers::SHIFT, Key::S) {
        let name = watch.name.clone();
        watch.files.ask(Wanted::SaveAs, &name);
    }
    if press(Modifiers::COMMAND, Key::S) {
        watch.save();
    }
    if press(Modifiers::COMMAND, Key::O) {
        watch.files.ask(Wanted::Open, "");
    }
    for (key, by) in [
        (Key::Plus, 1.1),
        (Key::Equals, 1.1),
        (Key::Minus, 1.0 / 1.1),
    ] {
        if press(Modifiers::COMMAND, key) {
            watch.settings.zoom = (watch.settings.zoom * by).clamp(0.5, 3.0);
        }
    }
    // Everything else is for what has the focus first.
    if ctx.egui_wants_keyboard_input() {
        return;
    }
    if press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) || press(Modifiers::COMMAND, Key::Y) {
        watch.order_edit(Order::Redo);
    }
    if press(Modifiers::COMMAND, Key::Z) {
        watch.order_edit(Order::Undo);
    }
    time(&press, watch);
    views(&press, watch, view);
    for (tool, key) in Tool::ALL
        .into_iter()
        .zip([Key::V, Key::B, Key::H, Key::N, Key::C, Key::X])
    {
        if press(Modifiers::NONE, key) {
            watch.take_tool(tool);
        }
    }
    for (key, by) in [(Key::OpenBracket, 1.0 / 1.2), (Key::CloseBracket, 1.2)] {
        if press(Modifiers::NONE, key) {
            watch.tools.brush.size = (watch.tools.brush.size * by).clamp(0.002, 0.2);
        }
    }
    if press(Modifiers::NONE, Key::R) && watch.recording.is_none() {
        watch.open.record = true;
    }
    if press(Modifiers::NONE, Key::P) {
        watch.script.keep_picture();
    }
    if press(Modifiers::NONE, Key::Escape) {
        watch.open = Open::default();
        watch.leaving = None;
        watch.problem = None;
        watch.take_tool(Tool::Look);
    }
}

fn time(press: &impl Fn(Modifiers, Key) -> bool, watch: &mut Watch) {
    let total = watch.edit.process.steps();
    let seen = watch.seen.as_ref();
    let (playing, target) = seen.map_or((false, 0), |seen| (seen.playing, seen.target));
    let speed = watch.speed(total);
    if press(Modifiers::NONE, Key::Space) {
        watch.worker.order(Order::Play(!playing));
    }
    if press(Modifiers::NONE, Key::ArrowRight) {
        watch.worker.order(Order::Forward);
    }
    if press(Modifiers::NONE, Key::ArrowLeft) {
        let frame = (speed / 60.0).round().max(1.0) as u64;
        watch
            .worker
            .order(Order::GoTo(target.saturating_sub(frame)));
    }
    if press(Modifiers::NONE, Key::Home) {
        watch.worker.order(Order::GoTo(0));
    }
    if press(Modifiers::NONE, Key::End) {
        watch.worker.order(Order::GoTo(total));
    }
    for (key, by) in [(Key::Comma, 1.0 / FASTER), (Key::Period, FASTER)] {
        if press(Modifiers::NONE, key) {
            let speed = (speed * by).clamp(1.0, total.max(2) as f64);
            watch.set_pace(Pace::PerSecond(speed));
        }
    }
}

fn views(press: &impl Fn(Modifiers, Key) -> bool, watch: &mut Watch, view: &mut View3d) {
    for (key, layout) in [
        (Key::Num1, Layout::Both),
        (Key::Num2, Layout::Flat),
        (Key::Num3, Layout::Draped),
    ] {
        if press(Modifiers::NONE, key) {
            watch.settings.layout = layout;
            view.touch();
        }
    }
    if press(Modifiers::NONE, Key::F) {
        watch.tools.flat = Default::default();
        view.reset(&watch.edit.view);
    }
    if press(Modifiers::NONE, Key::Tab) {
        watch.settings.panel = !watch.settings.panel;
    }
    if press(Modifiers::NONE, Key::L) {
        watch.settings.plots = !watch.settings.plots;
    }
    if press(Modifiers::SHIFT, Key::O) {
        watch.overlay(None);
    }
    if press(Modifiers::NONE, Key::O) {
        let next = match watch.tools.overlay {
            None => Some(Field::ALL[0]),
            Some(field) => {
                let at = Field::ALL.iter().position(|other| *other == field);
                at.and_then(|at| Field::ALL.get(at + 1)).copied()
            }
        };
        watch.overlay(next);
    }
    if press(Modifiers::NONE, Key::G) {
        watch.open.gallery = !watch.open.gallery;
    }
    if press(Modifiers::NONE, Key::M) {
        watch.moves = !watch.moves;
        watch.hanger.act(Deed::Move(watch.moves));
    }
    if press(Modifiers::NONE, Key::D) {
        watch.hang();
    }
    if press(Modifiers::SHIFT, Key::Questionmark) || press(Modifiers::NONE, Key::Questionmark) {
        watch.open.keys = !watch.open.keys;
    }
}
