//! Plots: where the dye is over time, and what lies below a line.

use bevy_egui::egui::{self, Color32, Rect, Sense, Stroke, Ui, pos2, vec2};
use egui_plot::{Legend, Line, Plot, PlotPoints, VLine};

use super::state::Watch;
use super::worker::Order;
use crate::session::course::Account;
use crate::session::section::Section;
use crate::texture::{Ramp, darkest_at};

/// Colours of the accounts, apart in hue and in lightness.
const COLOURS: [Color32; 4] = [
    Color32::from_rgb(235, 235, 235),
    Color32::from_rgb(86, 156, 240),
    Color32::from_rgb(240, 165, 70),
    Color32::from_rgb(130, 200, 120),
];

/// The panel of plots.
pub fn panel(root: &mut Ui, watch: &mut Watch) {
    egui::Panel::bottom("plots")
        .resizable(true)
        .default_size(150.0)
        .size_range(110.0..=400.0)
        .show(root, |ui| {
            let cut = watch.tools.cut.is_some();
            let space = ui.available_rect_before_wrap();
            if cut {
                let (left, right) = space.split_left_right_at_fraction(0.4);
                ledger(
                    &mut ui.new_child(egui::UiBuilder::new().max_rect(left.shrink(2.0))),
                    watch,
                );
                section(
                    &mut ui.new_child(egui::UiBuilder::new().max_rect(right.shrink(4.0))),
                    watch,
                );
            } else {
                ledger(ui, watch);
            }
            ui.allocate_rect(space, Sense::hover());
        });
}

/// The ledger over time.
fn ledger(ui: &mut Ui, watch: &Watch) {
    let Some(seen) = &watch.seen else { return };
    let total = watch.edit.process.steps() as f64 * watch.edit.process.step_h;
    let lines: Vec<_> = Account::ALL
        .into_iter()
        .zip(COLOURS)
        .map(|(account, colour)| {
            let points: PlotPoints = seen.course.series(account).collect();
            Line::new(account.name(), points).color(colour).width(1.6)
        })
        .collect();
    Plot::new("ledger")
        .legend(Legend::default().text_style(egui::TextStyle::Small))
        .x_axis_label("hours")
        .y_axis_label("dye (cells full)")
        .include_x(0.0)
        .include_x(total)
        .include_y(0.0)
        .allow_scroll(false)
        .allow_zoom(false)
        .allow_drag(false)
        .allow_boxed_zoom(false)
        .show(ui, |plot| {
            for line in lines {
                plot.line(line);
            }
            plot.vline(
                VLine::new("now", seen.hours)
                    .color(Color32::from_gray(150))
                    .width(1.0),
            );
        });
}

/// What lies below the line: both layers with the colours of their dye, and the concentration.
fn section(ui: &mut Ui, watch: &mut Watch) {
    let section = watch.seen.as_ref().and_then(|seen| seen.section.clone());
    ui.horizontal(|ui| {
        ui.strong("Cross-section");
        if let Some(section) = &section {
            ui.weak(format!("{:.2} mm", section.mm));
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            if ui
                .small_button("✖")
                .on_hover_text("Put the line away")
                .clicked()
            {
                watch.tools.cut = None;
                watch.worker.order(Order::Cut(None));
            }
        });
    });
    let Some(section) = section.filter(|section| !section.places.is_empty()) else {
        ui.weak("The line lies beside the cloth.");
        return;
    };
    layers(ui, watch, &section);
    let curve = |layer: usize, name: &str, colour: Color32| {
        let points = section.places.iter();
        let points: PlotPoints = points
            .map(|place| [place.mm, f64::from(place.layers[layer].concentration)])
            .collect();
        Line::new(name.to_owned(), points).color(colour).width(1.4)
    };
    let lines = [
        curve(0, "c in the weft", Color32::from_rgb(86, 156, 240)),
        curve(1, "c in the warp", Color32::from_rgb(240, 165, 70)),
    ];
    Plot::new("section")
        .legend(Legend::default().text_style(egui::TextStyle::Small))
        .x_axis_label("mm")
        .include_y(0.0)
        .include_y(1.0)
        .allow_scroll(false)
        .allow_zoom(false)
        .allow_drag(false)
        .allow_boxed_zoom(false)
        .show(ui, |plot| {
            for line in lines {
                plot.line(line);
            }
        });
}

/// A drawing of both layers: the one that is seen on top; yarns are filled with the colour of their dye,
/// gaps are empty, and what is squeezed shut is hatched.
fn layers(ui: &mut Ui, watch: &Watch, section: &Section) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 34.0), Sense::hover());
    response.on_hover_text(
        "Cut through the cloth: the layer that is seen lies on top. Yarns have the colour of their dye; a \
         bar between them is resist.",
    );
    let look = &watch.edit.look;
    let ramp = Ramp::new(&look.colours, look.path, darkest_at(&watch.edit));
    let painter = ui.painter_at(rect);
    let length = section.mm.max(1e-9);
    let half = 0.5 * rect.height();
    for (i, place) in section.places.iter().enumerate() {
        let end = section.places.get(i + 1).map_or(section.mm, |next| next.mm);
        let x = |mm: f64| rect.left() + (mm / length) as f32 * rect.width();
        let (left, right) = (x(place.mm), x(end).max(x(place.mm) + 0.7));
        for sample in &place.layers {
            let top = if sample.on_top {
                rect.top()
            } else {
                rect.top() + half
            };
            let cell = Rect::from_min_max(pos2(left, top + 1.0), pos2(right, top + half - 1.0));
            if sample.yarn.is_some() {
                let [r, g, b] = ramp
                    .colour(sample.free + sample.bound)
                    .map(|c| (255.0 * c) as u8);
                painter.rect_filled(cell, 0.0, Color32::from_rgb(r, g, b));
            }
        }
        let resist = place
            .layers
            .iter()
            .map(|sample| sample.resist)
            .fold(0.0, f32::max);
        if resist > 0.01 {
            let alpha = (200.0 * resist) as u8;
            let bar = [pos2(left, rect.center().y), pos2(right, rect.center().y)];
            let colour = Color32::from_rgba_unmultiplied(230, 80, 60, alpha);
            painter.line_segment(bar, Stroke::new(2.5, colour));
        }
    }
}
