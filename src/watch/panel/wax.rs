//! Wax of a batik: where it is laid on, how it breaks and thins out.

use bevy_egui::egui::Ui;

use super::batik::discs;
use super::pattern;
use super::row::{Pass, row};
use crate::batik::drawing::{Ground, Waxed};
use crate::scenario::BatikStep;

pub(super) fn wax_rows(p: &mut Pass, ui: &mut Ui, i: usize, step: &mut BatikStep) {
    let BatikStep::Wax {
        drawing,
        ground,
        waxed,
        pattern,
        crackle,
        edge,
    } = step
    else {
        return;
    };
    let by = row("laid on by", "A drawing beside the scenario, or a pattern.");
    let path = format!("batik.steps[{i}].Wax");
    match p.variant(
        ui,
        &by,
        usize::from(pattern.is_some()),
        &["drawing", "pattern"],
    ) {
        Some(0) => p.ask_image(format!("{path}.drawing")),
        Some(_) => {
            *pattern = Some(discs(p.cells.0.min(p.cells.1)));
            *drawing = None;
        }
        None => {}
    }
    if let Some(pattern) = pattern {
        pattern::show(p, ui, pattern, &format!("{path}.pattern"));
    }
    if let Some(drawing) = drawing {
        p.text(
            ui,
            &row(
                "drawing",
                "A line drawing beside the scenario, PNG or JPEG.",
            ),
            drawing,
        );
        if p.button(ui, "Open a drawing…", "Chooses another drawing") {
            p.ask_image(format!("{path}.drawing"));
        }
        let grounds = [
            ("detect", Ground::Detect),
            ("light", Ground::Light),
            ("dark", Ground::Dark),
        ];
        let tip = "Which colour of the drawing is its ground.";
        p.choice(ui, &row("ground", tip), ground, &grounds);
        let both = [
            ("the drawing", Waxed::Drawing),
            ("its ground", Waxed::Ground),
        ];
        let tip = "What is waxed stays pale; the rest is dyed.";
        p.choice(ui, &row("waxed", tip), waxed, &both);
    }
    for (name, tip, value, most) in [
        (
            "cracks",
            "Length of all cracks over the area of wax: more makes finer meshes. 0 for wax that does not break.",
            &mut crackle.density,
            0.2,
        ),
        (
            "crack width",
            "How wide the first cracks are, in cells.",
            &mut crackle.width,
            100.0,
        ),
        (
            "thinning",
            "Width of each generation of cracks over the one before.",
            &mut crackle.thinning,
            1.0,
        ),
        (
            "jitter",
            "0 makes smooth cracks, 1 ragged ones.",
            &mut crackle.jitter,
            1.0,
        ),
        (
            "folds",
            "The share of all cracks that is long folds.",
            &mut crackle.folds,
            1.0,
        ),
        (
            "crumple",
            "How unevenly the cloth was crumpled: 0 cracks evenly, 1 hardly at all in places.",
            &mut crackle.crumple,
            1.0,
        ),
    ] {
        let scale = if most < 1.0 { 0.02 } else { 1.0 };
        p.number(ui, &row(name, tip).scale(scale), value, 0.0..=most);
    }
    let size = row("crumple size", "The size of what was crumpled together.").unit(" cells");
    p.number(ui, &size.scale(100.0), &mut crackle.crumple_size, 1.0..=1e6);
    let direction = row(
        "fold direction",
        "0 across the cloth, 90 down. Left out: folds of any direction.",
    );
    let any = (45.0, "any");
    p.optional(
        ui,
        &direction.unit("°").scale(45.0),
        &mut crackle.direction,
        -360.0..=360.0,
        any,
    );
    let reach = row(
        "edge reach Th",
        "How far from an edge or crack wax is thinner: softens edges.",
    );
    p.number(ui, &reach.unit(" cells"), &mut edge.reach, 0.0..=1000.0);
    let share = row(
        "drawing counts a",
        "How much the drawing counts; the rest is the distance to what is open.",
    );
    p.number(ui, &share, &mut edge.drawing, 0.0..=1.0);
}
