//! The bar above the cloth, and the one below: time.

use bevy_egui::egui::{self, Color32, Rect, Sense, Stroke, Ui, pos2, vec2};

use super::files::Wanted;
use super::settings::Layout;
use super::state::Watch;
use super::tools::{Kind, Tool};
use super::view3d::View3d;
use super::worker::{Order, Pace};
use crate::session::overlay::Field;

/// A button that can be off.
fn button(ui: &mut Ui, on: bool, text: &str, tip: &str) -> bool {
    ui.add_enabled(on, egui::Button::new(text))
        .on_hover_text(tip)
        .on_disabled_hover_text(tip)
        .clicked()
}

/// Files, undo, views, tools.
pub fn top(root: &mut Ui, watch: &mut Watch, view: &mut View3d) {
    egui::Panel::top("top").show(root, |ui| {
        ui.add_space(2.0);
        ui.horizontal_wrapped(|ui| {
            files(ui, watch);
            ui.separator();
            views(ui, watch, view);
            ui.separator();
            tools(ui, watch);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if ui.button("?").on_hover_text("Keys (?)").clicked() {
                    watch.open.keys = !watch.open.keys;
                }
            });
        });
        ui.horizontal_wrapped(|ui| second_row(ui, watch));
        ui.add_space(2.0);
    });
}

fn files(ui: &mut Ui, watch: &mut Watch) {
    if button(
        ui,
        true,
        "Gallery",
        "The scenarios that come with the program (G)",
    ) {
        watch.open.gallery = true;
    }
    if button(ui, true, "Open…", "Open a scenario (Ctrl O)") {
        watch.files.ask(Wanted::Open, "");
    }
    let star = if watch.unsaved { "Save •" } else { "Save" };
    if button(
        ui,
        true,
        star,
        "Save the scenario as RON, with comments (Ctrl S); Ctrl Shift S saves elsewhere",
    ) {
        watch.save();
    }
    let [undo, redo] = watch
        .seen
        .as_ref()
        .map_or([None, None], |seen| seen.undo.clone());
    let tip = |what: &str, label: &Option<String>| match label {
        Some(label) => format!("{what}: {label}"),
        None => format!("Nothing to {}", what.to_lowercase()),
    };
    if button(
        ui,
        undo.is_some(),
        "⟲",
        &format!("{} (Ctrl Z)", tip("Undo", &undo)),
    ) {
        watch.order_edit(Order::Undo);
    }
    if button(
        ui,
        redo.is_some(),
        "⟳",
        &format!("{} (Ctrl Y)", tip("Redo", &redo)),
    ) {
        watch.order_edit(Order::Redo);
    }
    if button(
        ui,
        watch.recording.is_none(),
        "⏺ Record…",
        "Record the process from its beginning, as `dyelapse record` does (R)",
    ) {
        watch.open.record = true;
    }
    if button(
        ui,
        true,
        "📷",
        "Keep a picture of the cloth as it is now (P)",
    ) {
        watch.script.keep_picture();
    }
}

fn views(ui: &mut Ui, watch: &mut Watch, view: &mut View3d) {
    for (layout, name, key) in [
        (Layout::Both, "Both", "1"),
        (Layout::Flat, "Flat", "2"),
        (Layout::Draped, "Draped", "3"),
    ] {
        let chosen = watch.settings.layout == layout;
        let tip = format!("Show the cloth {} ({key})", name.to_lowercase());
        if ui
            .selectable_label(chosen, name)
            .on_hover_text(tip)
            .clicked()
        {
            watch.settings.layout = layout;
            view.touch();
        }
    }
    if button(ui, true, "🏠", "Reset both views (F)") {
        watch.tools.flat = Default::default();
        view.reset(&watch.edit.view);
    }
}

fn tools(ui: &mut Ui, watch: &mut Watch) {
    for tool in Tool::ALL {
        let chosen = watch.tools.tool == tool;
        let tip = format!("{} ({})", tool.tip(), tool.key());
        if ui
            .selectable_label(chosen, tool.name())
            .on_hover_text(tip)
            .clicked()
        {
            watch.take_tool(tool);
        }
    }
}

/// What the tool in hand can be set to, and which field lies over the cloth.
fn second_row(ui: &mut Ui, watch: &mut Watch) {
    let panel = ui.selectable_label(watch.settings.panel, "Parameters");
    if panel
        .on_hover_text("Show or hide the parameters (Tab)")
        .clicked()
    {
        watch.settings.panel = !watch.settings.panel;
    }
    let plots = ui.selectable_label(watch.settings.plots, "Plots");
    if plots
        .on_hover_text("Show or hide ledger and cross-section (L)")
        .clicked()
    {
        watch.settings.plots = !watch.settings.plots;
    }
    ui.separator();
    let now = watch.tools.overlay;
    let mut chosen = now;
    ui.label("Overlay");
    egui::ComboBox::from_id_salt("overlay")
        .width(120.0)
        .selected_text(now.map_or("none", Field::name))
        .show_ui(ui, |ui| {
            ui.selectable_value(&mut chosen, None, "none");
            for field in Field::ALL {
                ui.selectable_value(&mut chosen, Some(field), field.name());
            }
        })
        .response
        .on_hover_text("Show a field over the flat cloth, with a legend (O: the next one)");
    if chosen != now {
        watch.overlay(chosen);
    }
    ui.separator();
    match watch.tools.tool {
        Tool::Brush => brush(ui, watch),
        Tool::Crease => {
            ui.label("Fold");
            ui.selectable_value(&mut watch.tools.valley, false, "mountain")
                .on_hover_text("The front is outside: a ridge");
            ui.selectable_value(&mut watch.tools.valley, true, "valley")
                .on_hover_text("The back is outside: a furrow");
        }
        tool => {
            ui.weak(tool.tip());
        }
    }
}

fn brush(ui: &mut Ui, watch: &mut Watch) {
    let brush = &mut watch.tools.brush;
    for (kind, name, tip) in [
        (Kind::Dye, "dye", "Dye is given where and when you paint"),
        (
            Kind::Resist,
            "resist",
            "Paste that keeps dye out; ↻ the process begins anew with it",
        ),
        (
            Kind::Wax,
            "wax",
            "Wax for batik, which cracks; without a batik it keeps all dye out; ↻ the process begins anew with it",
        ),
    ] {
        ui.selectable_value(&mut brush.kind, kind, name)
            .on_hover_text(tip);
    }
    ui.add(
        egui::Slider::new(&mut brush.size, 0.002..=0.2)
            .logarithmic(true)
            .text("size")
            .custom_formatter(|v, _| format!("{:.1} %", 100.0 * v)),
    )
    .on_hover_text("From the middle of the brush to its edge, as a share of the cloth ([ and ])");
    ui.add(egui::Slider::new(&mut brush.strength, 0.05..=1.0).text("strength"))
        .on_hover_text("How much there is in the middle");
    ui.add(egui::Slider::new(&mut brush.hardness, 0.0..=1.0).text("hardness"))
        .on_hover_text("0: soft up to the middle; 1: a sharp edge");
}

/// Time: play, pause, where in the process, how fast.
pub fn bottom(root: &mut Ui, watch: &mut Watch) {
    egui::Panel::bottom("time").show(root, |ui| {
        ui.add_space(4.0);
        let total = watch.edit.process.steps();
        let (step, hours, playing) = watch.seen.as_ref().map_or((0, 0.0, false), |seen| {
            (seen.step, seen.hours, seen.playing)
        });
        ui.horizontal(|ui| {
            if button(ui, true, "⏮", "To the beginning (Home)") {
                watch.worker.order(Order::GoTo(0));
            }
            let (sign, tip) = if playing {
                ("⏸", "Pause (Space)")
            } else {
                ("▶", "Play (Space)")
            };
            if button(ui, true, sign, tip) {
                watch.worker.order(Order::Play(!playing));
            }
            if button(ui, step < total, "⏭", "One frame on (→)") {
                watch.worker.order(Order::Forward);
            }
            timeline(ui, watch, step, total);
        });
        ui.horizontal(|ui| {
            let hours_all = total as f64 * watch.edit.process.step_h;
            ui.monospace(format!("step {} of {}", grouped(step), grouped(total)));
            ui.separator();
            ui.monospace(format!("{} of {}", duration(hours), duration(hours_all)));
            ui.separator();
            pace(ui, watch, total);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                status(ui, watch);
            });
        });
        ui.add_space(2.0);
    });
}

/// A number with its thousands apart.
pub fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Hours in a unit that reads well.
pub fn duration(hours: f64) -> String {
    match hours {
        h if h >= 48.0 => format!("{:.1} d", h / 24.0),
        h if h >= 1.0 || h == 0.0 => format!("{h:.2} h"),
        h if h >= 1.0 / 60.0 => format!("{:.1} min", 60.0 * h),
        h => format!("{:.1} s", 3600.0 * h),
    }
}

/// The way through the process: drag it to and fro.
fn timeline(ui: &mut Ui, watch: &mut Watch, step: u64, total: u64) {
    let size = vec2((ui.available_width() - 4.0).max(60.0), 22.0);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let track = Rect::from_center_size(rect.center(), vec2(rect.width() - 12.0, 6.0));
    let x_of = |step: u64| track.left() + track.width() * step as f32 / total.max(1) as f32;
    let painter = ui.painter_at(rect);
    let visuals = ui.visuals();
    painter.rect_filled(track, 3.0, visuals.widgets.inactive.bg_fill);
    let done = Rect::from_min_max(track.min, pos2(x_of(step), track.max.y));
    painter.rect_filled(done, 3.0, visuals.selection.bg_fill);
    let (kept, target) = watch
        .seen
        .as_ref()
        .map_or((&[][..], step), |seen| (&seen.kept[..], seen.target));
    for kept in kept {
        let x = x_of(*kept);
        let mark = [pos2(x, track.max.y + 1.0), pos2(x, track.max.y + 4.0)];
        painter.line_segment(mark, Stroke::new(1.0, visuals.weak_text_color()));
    }
    if target != step {
        let at = pos2(x_of(target), track.center().y);
        painter.circle_stroke(at, 6.0, Stroke::new(1.5, Color32::from_rgb(230, 180, 80)));
    }
    painter.circle_filled(
        pos2(x_of(step), track.center().y),
        6.0,
        visuals.strong_text_color(),
    );
    let at = |x: f32| {
        let share = f64::from(((x - track.left()) / track.width()).clamp(0.0, 1.0));
        (share * total as f64).round() as u64
    };
    if let Some(hover) = response.hover_pos() {
        let there = at(hover.x);
        let hours = duration(there as f64 * watch.edit.process.step_h);
        response.clone().on_hover_text_at_pointer(format!(
            "step {}, {hours}\nDrag to go there, forwards or backwards; marks are moments that are kept",
            grouped(there)
        ));
    }
    if (response.dragged() || response.clicked())
        && let Some(pointer) = response.interact_pointer_pos()
    {
        watch.worker.order(Order::GoTo(at(pointer.x)));
    }
}

/// How fast it plays: from one step a second to the whole process.
fn pace(ui: &mut Ui, watch: &mut Watch, total: u64) {
    let most = total.max(2) as f64;
    let old = watch.speed(total);
    let mut speed = old;
    ui.label("speed");
    ui.add(
        egui::Slider::new(&mut speed, 1.0..=most)
            .logarithmic(true)
            .show_value(false),
    )
    .on_hover_text("Steps a second, from one to the whole process (, slower . faster)");
    ui.monospace(format!("{} steps/s", grouped(speed.round() as u64)));
    if speed != old {
        watch.set_pace(Pace::PerSecond(speed));
    }
}

/// What goes on: recording, computing, messages.
fn status(ui: &mut Ui, watch: &mut Watch) {
    if let Some(recording) = &watch.recording {
        if ui
            .button("Stop")
            .on_hover_text("End the recording early; what is there is valid")
            .clicked()
        {
            recording.stop();
        }
        ui.add(
            egui::ProgressBar::new(recording.progress())
                .desired_width(130.0)
                .text("recording"),
        );
    }
    let moves = watch.moment.as_ref().is_some_and(|moment| moment.moving);
    if moves {
        ui.weak("cloth moves");
    }
    if let Some(told) = watch.told() {
        ui.label(told.to_owned());
    } else if let Some(seen) = &watch.seen
        && seen.step != seen.target
    {
        ui.weak(format!("going to step {}…", grouped(seen.target)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_stand_apart() {
        assert_eq!(grouped(7), "7");
        assert_eq!(grouped(400_000), "400,000");
        assert_eq!(grouped(1_234_567), "1,234,567");
    }

    #[test]
    fn durations_have_the_unit_that_reads_well() {
        assert_eq!(duration(0.0), "0.00 h");
        assert_eq!(duration(200.0), "8.3 d");
        assert_eq!(duration(6.25), "6.25 h");
        assert_eq!(duration(0.5), "30.0 min");
        assert_eq!(duration(0.001), "3.6 s");
    }
}
