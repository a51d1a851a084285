//! What undyed cloth looks like: its yarns and their fibres, or a photograph.

use bevy_egui::egui::Ui;

use super::row::{Pass, row};
use super::shapes::fit_row;
use crate::batik::ellipse::EllipseSpec;
use crate::scenario::{FractalLook, LookSpec, TextureLook};

pub(super) fn texture(p: &mut Pass, ui: &mut Ui, look: &mut LookSpec) {
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
            fit_row(p, ui, fit);
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

pub(super) fn fibres(p: &mut Pass, ui: &mut Ui, look: &mut LookSpec) {
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
