//! The look: which dye is shown, in which colours, on which yarns.

use bevy_egui::egui::Ui;

use super::presets;
use super::row::{Effect, Pass, row};
use super::texture::{fibres, texture};
use crate::scenario::{ColourPath, Colours, LARGEST_SCALE, LookSpec, Scenario, Show, Side};

pub(super) fn show(p: &mut Pass, ui: &mut Ui, scenario: &mut Scenario) {
    p.group(ui, "Look", |p, ui| {
        p.effect = Effect::Look;
        let (batik, sweeps) = (scenario.batik.is_some(), scenario.sweeps());
        let look = &mut scenario.look;
        p.heading("picture");
        if batik {
            p.say(
                ui,
                "The dyes of a batik have colours of their own: see its steps (process, batik).",
            );
        } else {
            colours(p, ui, look);
        }
        if sweeps {
            p.say(ui, "Sweeps show all dye, full at 1 + most bound.");
        } else {
            shown(p, ui, look);
        }
        let scale = row(
            "pixels a cell",
            "How large the picture is: pixels along one side of a cell.",
        );
        p.number(ui, &scale, &mut look.pixels_per_cell, 1..=LARGEST_SCALE);
        let side = row(
            "side",
            "Which side of the cloth is seen. On the back left and right are exchanged.",
        );
        p.choice(
            ui,
            &side,
            &mut look.side,
            &[("face", Side::Face), ("back", Side::Back)],
        );
        p.heading("texture");
        texture(p, ui, look);
        p.heading("fibres");
        fibres(p, ui, look);
    });
}

fn colours(p: &mut Pass, ui: &mut Ui, look: &mut LookSpec) {
    let preset = row(
        "dye colours",
        "The colours of dyed cloth from undyed to full: those of a common dye.",
    );
    p.choice(ui, &preset, &mut look.colours, &presets::DYES);
    let stops = look.colours.stops();
    let mut new = stops;
    let [lightest, middle, darkest] = &mut new;
    p.colour(
        ui,
        &row("undyed", "Hue, saturation and value of undyed cloth."),
        lightest,
    );
    p.colour(
        ui,
        &row("half dyed", "Hue, saturation and value of half dyed cloth."),
        middle,
    );
    p.colour(
        ui,
        &row("full", "Hue, saturation and value of fully dyed cloth."),
        darkest,
    );
    if new != stops {
        let [lightest, middle, darkest] = new;
        look.colours = Colours::Stops {
            lightest,
            middle,
            darkest,
        };
    }
    let path = row(
        "way between",
        "Straight in hue, saturation and value, or so that equal steps of dye look equal.",
    );
    p.choice(
        ui,
        &path,
        &mut look.path,
        &[("HSV", ColourPath::Hsv), ("OKLCH", ColourPath::Oklch)],
    );
}

fn shown(p: &mut Pass, ui: &mut Ui, look: &mut LookSpec) {
    let shown = row(
        "dye shown",
        "All dye in the cloth, or only what has bound: the cloth after rinsing.",
    );
    p.choice(
        ui,
        &shown,
        &mut look.show,
        &[
            ("free and bound", Show::FreeAndBound),
            ("bound only", Show::BoundOnly),
        ],
    );
    let darkest = row(
        "darkest at",
        "The amount of dye that has the darkest colour. Left out: as much as the cloth holds.",
    )
    .scale(0.1);
    p.optional(
        ui,
        &darkest,
        &mut look.darkest_at,
        0.001..=1.0,
        (0.5, "full cloth"),
    );
}
