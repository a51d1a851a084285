//! The look: which dye is shown, in which colours, on which yarns.

use bevy_egui::egui::Ui;

use super::pattern;
use super::presets;
use super::row::{Effect, Pass, row};
use crate::batik::ellipse::EllipseSpec;
use crate::scenario::{
    ColourPath, Colours, FractalLook, LARGEST_SCALE, LookSpec, Scenario, Show, Side, TextureLook,
};

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

fn texture(p: &mut Pass, ui: &mut Ui, look: &mut LookSpec) {
    let kind = row(
        "kind",
        "Shaded yarns in the light, yarns of uneven density (paper Y), raised ellipses (paper B), or a photograph.",
    );
    let now = match look.texture {
        TextureLook::Shaded => 0,
        TextureLook::Fractal(_) => 1,
        TextureLook::Ellipses(_) => 2,
        TextureLook::Photo { .. } => 3,
    };
    match p.variant(
        ui,
        &kind,
        now,
        &["shaded", "fractal", "ellipses", "photograph"],
    ) {
        Some(0) => look.texture = TextureLook::Shaded,
        Some(1) => look.texture = TextureLook::Fractal(FractalLook::default()),
        Some(2) => look.texture = TextureLook::Ellipses(EllipseSpec::default()),
        Some(_) => p.ask_image("look.texture.file".into()),
        None => {}
    }
    match &mut look.texture {
        TextureLook::Shaded => {}
        TextureLook::Fractal(look) => {
            p.number(
                ui,
                &row(
                    "smoothness H",
                    "Near 1 the density changes smoothly, near 0 roughly.",
                ),
                &mut look.roughness,
                0.0..=1.0,
            );
            p.number(
                ui,
                &row("threshold N", "The higher, the fewer places have colour."),
                &mut look.threshold,
                0.0..=1.0,
            );
            p.number(
                ui,
                &row("unit yarns", "Unit yarns in a yarn."),
                &mut look.unit_yarns,
                1..=100,
            );
            p.number(
                ui,
                &row("contrast", "How much paler a place without any colour is."),
                &mut look.contrast,
                0.0..=1.0,
            );
            p.number(
                ui,
                &row("relief", "How much of the roundness of yarns is seen."),
                &mut look.relief,
                0.0..=1.0,
            );
        }
        TextureLook::Ellipses(look) => ellipses(p, ui, look),
        TextureLook::Photo { file, fit } => {
            p.text(
                ui,
                &row("photograph", "A photograph of cloth beside the scenario."),
                file,
            );
            if p.button(ui, "Open a photograph…", "Chooses another photograph") {
                p.ask_image("look.texture.file".into());
            }
            pattern::fit_row(p, ui, fit);
        }
    }
}

fn ellipses(p: &mut Pass, ui: &mut Ui, look: &mut EllipseSpec) {
    for (name, tip, value, most) in [
        (
            "paler R_S",
            "How much paler the raised part of a crossing is.",
            &mut look.paler,
            1.0,
        ),
        (
            "lighter R_V",
            "How much lighter the raised part is.",
            &mut look.lighter,
            1.0,
        ),
        (
            "shade",
            "How much darker the rest is.",
            &mut look.shade,
            1.0,
        ),
        (
            "shade reach",
            "How far from the ellipse it is darkest, in radii of it.",
            &mut look.reach,
            100.0,
        ),
        (
            "cell noise",
            "Noise of a whole crossing.",
            &mut look.cell_noise,
            1.0,
        ),
        (
            "pixel noise",
            "Noise of a pixel.",
            &mut look.pixel_noise,
            1.0,
        ),
        (
            "final blur",
            "Standard deviation of the final blur, in pixels.",
            &mut look.blur,
            100.0,
        ),
    ] {
        p.number(ui, &row(name, tip), value, 0.0..=most);
    }
    let size = row(
        "ellipse size",
        "Length and width of the ellipse as shares of the crossing.",
    );
    p.numbers(
        ui,
        &size,
        [&mut look.size.0, &mut look.size.1],
        [(0.01, 10.0); 2],
    );
}

fn fibres(p: &mut Pass, ui: &mut Ui, look: &mut LookSpec) {
    if look.texture != TextureLook::Shaded {
        p.say(ui, "Only shaded yarns show their fibres.");
    }
    let yarn = &mut look.yarn;
    let mut s_twist = yarn.turn < 0.0;
    let mut turn = yarn.turn.abs();
    p.number(
        ui,
        &row(
            "turn",
            "Length of one full turn of the twist in yarn widths: short turns for hard twist.",
        )
        .scale(5.0),
        &mut turn,
        0.25..=1000.0,
    );
    p.tick(
        ui,
        &row(
            "S twist",
            "Fibres run the other way round the yarn: S rather than Z.",
        ),
        &mut s_twist,
    );
    yarn.turn = if s_twist { -turn } else { turn };
    p.number(
        ui,
        &row("fibres", "Fibres that are seen around the yarn."),
        &mut yarn.fibres,
        1..=1000,
    );
    for (name, tip, value) in [
        (
            "roughness",
            "How deep the grooves between the fibres are.",
            &mut yarn.roughness,
        ),
        (
            "unevenness",
            "How differently thick and bright the yarns are, and how much they wander.",
            &mut yarn.unevenness,
        ),
        (
            "hairiness",
            "How many loose fibres stand out.",
            &mut yarn.hairiness,
        ),
        (
            "lustre",
            "How much the fibres shine: 0 cotton, 1 silk.",
            &mut yarn.lustre,
        ),
    ] {
        p.number(ui, &row(name, tip), value, 0.0..=1.0);
    }
}
