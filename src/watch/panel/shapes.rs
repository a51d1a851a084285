//! The measures of every shape of pattern.

use bevy_egui::egui::Ui;

use super::lengths::LONGEST;
use super::row::{Pass, row};
use crate::pattern::{Fit, Pattern, Stroke};

/// Strokes of the brush: what may be changed of them afterwards; where they went stays.
fn strokes_rows(p: &mut Pass, ui: &mut Ui, strokes: &mut Vec<Stroke>) {
    let radius = row("radius", "From the middle of the brush to its edge.");
    let hardness = row(
        "hardness",
        "The share of the radius up to which all of the stroke is there: 1 for a sharp edge.",
    );
    let strength = row("strength", "How much there is in the middle of the stroke.");
    let mut gone = None;
    for (i, stroke) in strokes.iter_mut().enumerate() {
        ui.push_id(i, |ui| {
            p.length(ui, &radius, &mut stroke.radius, 0.05, LONGEST);
            p.number(ui, &hardness, &mut stroke.hardness, 0.0..=1.0);
            p.number(ui, &strength, &mut stroke.strength, 0.0..=1.0);
            if p.button(ui, "Remove the stroke", "Takes this stroke away") {
                gone = Some(i);
            }
        });
    }
    if let Some(i) = gone {
        strokes.remove(i);
        p.change("pattern");
    }
}

pub(super) fn shape_rows(p: &mut Pass, ui: &mut Ui, pattern: &mut Pattern, path: &str) {
    const THIN: f64 = 1e-3;
    let width_row = row("width", "How wide each one is.");
    let gap_row = row("gap", "The space between one and the next.");
    let angle_row = row(
        "angle",
        "Stripes: 0 run down the cloth, 90 across. Ramps: 0 grow to the right, 90 down.",
    )
    .unit("°")
    .scale(45.0);
    match pattern {
        Pattern::Strokes(strokes) => strokes_rows(p, ui, strokes),
        Pattern::Image { file, fit } => {
            let file_row = row(
                "file",
                "A picture beside the scenario: white is all, black nothing.",
            );
            p.text(ui, &file_row, file);
            if p.button(ui, "Open a picture…", "Chooses another picture") {
                p.ask_image(format!("{path}.file"));
            }
            fit_row(p, ui, fit);
        }
        Pattern::Disc { diameter, centre } => {
            p.length(
                ui,
                &row("diameter", "Across the spot."),
                diameter,
                THIN,
                LONGEST,
            );
            centre_row(p, ui, centre);
        }
        Pattern::Discs {
            diameter,
            pitch,
            staggered,
        } => {
            p.length(
                ui,
                &row("diameter", "Across each spot."),
                diameter,
                THIN,
                LONGEST,
            );
            p.length(
                ui,
                &row("pitch", "From the middle of a spot to that of the next."),
                pitch,
                THIN,
                LONGEST,
            );
            p.tick(
                ui,
                &row("staggered", "Every other row is moved by half a pitch."),
                staggered,
            );
        }
        Pattern::Rectangle { size, centre } => {
            p.length(
                ui,
                &row("width", "Across the rectangle."),
                &mut size.0,
                THIN,
                LONGEST,
            );
            p.length(
                ui,
                &row("height", "Down the rectangle."),
                &mut size.1,
                THIN,
                LONGEST,
            );
            centre_row(p, ui, centre);
        }
        Pattern::Stripes {
            width,
            gap,
            offset,
            angle,
        } => {
            p.length(ui, &width_row, width, THIN, LONGEST);
            p.length(ui, &gap_row, gap, 0.0, LONGEST);
            p.length(
                ui,
                &row("offset", "Where the first stripe begins."),
                offset,
                0.0,
                LONGEST,
            );
            p.number(ui, &angle_row, angle, -360.0..=360.0);
        }
        Pattern::Rings { width, gap, centre } => {
            p.length(ui, &width_row, width, THIN, LONGEST);
            p.length(ui, &gap_row, gap, 0.0, LONGEST);
            centre_row(p, ui, centre);
        }
        Pattern::Rays {
            count,
            share,
            centre,
        } => {
            p.number(
                ui,
                &row(
                    "rays",
                    "How many rays go out from the middle: as many as the folds.",
                ),
                count,
                1..=10_000,
            );
            p.number(
                ui,
                &row("share", "The share of the circle that is ray."),
                share,
                0.0..=1.0,
            );
            centre_row(p, ui, centre);
        }
        Pattern::Radial { from, to, centre } => {
            p.length(
                ui,
                &row("full up to", "All of it up to this far from the middle."),
                from,
                0.0,
                LONGEST,
            );
            p.length(
                ui,
                &row("fades until", "Nothing beyond this far from the middle."),
                to,
                THIN,
                LONGEST,
            );
            centre_row(p, ui, centre);
        }
        Pattern::Ramp { angle } => p.number(ui, &angle_row, angle, -360.0..=360.0),
        Pattern::Noise {
            grain,
            octaves,
            seed,
        } => {
            p.length(
                ui,
                &row("grain", "The size of a cloud."),
                grain,
                THIN,
                LONGEST,
            );
            p.number(
                ui,
                &row("octaves", "Finer and finer clouds on top of each other."),
                octaves,
                1..=12,
            );
            p.number(
                ui,
                &row("pattern seed", "Another number gives other clouds."),
                seed,
                0..=u32::MAX,
            );
        }
        Pattern::Seikaiha { radius, arcs, open } => {
            p.length(
                ui,
                &row("radius", "The size of a fan."),
                radius,
                2.0,
                LONGEST,
            );
            p.number(ui, &row("arcs", "Open arcs in a fan."), arcs, 1..=1000);
            p.number(
                ui,
                &row(
                    "open",
                    "The share of a ring that its arc leaves open to dye.",
                ),
                open,
                0.0..=1.0,
            );
        }
        _ => {}
    }
}

fn centre_row(p: &mut Pass, ui: &mut Ui, (x, y): &mut (f64, f64)) {
    let centre = row(
        "centre",
        "Where its middle is, as shares of the cloth across and down.",
    );
    p.numbers(ui, &centre, [x, y], [(-10.0, 10.0); 2]);
}

/// What is done with a picture of another size than the cloth.
pub(super) fn fit_row(p: &mut Pass, ui: &mut Ui, fit: &mut Fit) {
    let fit_row = row(
        "fit",
        "What to do with a picture of another size than the cloth: refuse it, or stretch it.",
    );
    p.choice(
        ui,
        &fit_row,
        fit,
        &[("exact", Fit::Exact), ("stretch", Fit::Stretch)],
    );
}
