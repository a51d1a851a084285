//! The cloth: its size, its yarns, its weave, the paths of dye, and what was dyed before weaving.

use bevy_egui::egui::Ui;

use super::lengths::LONGEST_SIDE;
use super::mend::cell_range;
use super::pattern;
use super::presets;
use super::row::{Effect, Pass, row};
use super::weave_rows;
use crate::pattern::Pattern;
use crate::scenario::{KasuriSpec, Length, Scenario, YarnSpec};

pub(super) fn show(p: &mut Pass, ui: &mut Ui, scenario: &mut Scenario) {
    p.group(ui, "Cloth", |p, ui| {
        p.effect = Effect::Kept;
        p.text(ui, &row("title", "What the scenario shows, in a few words."), &mut scenario.title);
        p.effect = Effect::Anew;
        let seed = row("seed", "Everything that is left to chance follows from it: another number gives another cloth of the same kind.");
        p.number(ui, &seed, &mut scenario.seed, 0..=1 << 53);
        p.heading("cloth");
        p.length(ui, &row("width", "How far the cloth goes across."), &mut scenario.cloth.size.0, 1.0, LONGEST_SIDE);
        p.length(ui, &row("height", "How far the cloth goes down."), &mut scenario.cloth.size.1, 1.0, LONGEST_SIDE);
        let (least, most) = cell_range(scenario);
        let cell = row("cell Δd", "Side of one cell of the computation. Smaller cells show finer yarns and take longer.").unit(" mm").scale(0.05);
        p.number(ui, &cell, &mut scenario.cloth.cell_mm, least..=most.max(least));
        p.heading("weave");
        weave_rows::rows(p, ui, &mut scenario.cloth);
        yarns(p, ui, scenario);
        gaps_and_paths(p, ui, scenario);
        kasuri(p, ui, scenario);
    });
}

fn yarns(p: &mut Pass, ui: &mut Ui, scenario: &mut Scenario) {
    p.heading("yarns");
    let preset = row(
        "kind of yarn",
        "Sets the width, pores and twist of all yarns, and how they look, to those of a common kind.",
    );
    if let Some(kind) = p.variant(ui, &preset, usize::MAX, &presets::YARNS) {
        let (yarn, look) = presets::yarn(kind);
        scenario.cloth.warp = yarn;
        scenario.cloth.weft = None;
        scenario.look.yarn = look;
    }
    let gaps = !matches!(scenario.cloth.weave, crate::cloth::Weave::Mask { .. });
    let cloth = &mut scenario.cloth;
    p.heading("warp");
    ui.push_id("warp", |ui| yarn(p, ui, &mut cloth.warp, gaps));
    p.heading("weft");
    let mut own = cloth.weft.is_some();
    p.tick(
        ui,
        &row(
            "yarns of its own",
            "The weft runs across. Without yarns of its own it has those of the warp.",
        ),
        &mut own,
    );
    if own != cloth.weft.is_some() {
        cloth.weft = own.then_some(cloth.warp);
    }
    if let Some(weft) = &mut cloth.weft {
        ui.push_id("weft", |ui| yarn(p, ui, weft, gaps));
    }
}

fn yarn(p: &mut Pass, ui: &mut Ui, yarn: &mut YarnSpec, gaps: bool) {
    p.length(
        ui,
        &row(
            "yarn width",
            "How wide a yarn lies in the cloth. Wide yarns make coarse cloth.",
        ),
        &mut yarn.width,
        1.0,
        LONGEST_SIDE,
    );
    if gaps {
        p.length(
            ui,
            &row(
                "gap",
                "The space to the next yarn. Wide gaps make open, thin cloth.",
            ),
            &mut yarn.gap,
            0.0,
            LONGEST_SIDE,
        );
    }
    p.range(ui, &row("width varies", "Each yarn multiplies its width by a random factor between these: thick and thin yarns."), &mut yarn.vary_width, 0.1..=10.0);
    p.number(ui, &row("porosity", "P, the share of a yarn that is pores. More pores let more dye in, and let it run further.").scale(0.1), &mut yarn.porosity, 0.001..=1.0);
    p.range(ui, &row("porosity varies", "Each yarn multiplies its porosity by a random factor between these: some yarns take up more dye than others."), &mut yarn.vary_porosity, 0.01..=1.0);
    p.number(ui, &row("straightness τ₁", "1 where the fibres lie straight, towards 0 the harder the yarn is twisted. Hard twist slows dye along the yarn."), &mut yarn.twist, 0.0..=1.0);
    p.range(
        ui,
        &row(
            "τ₁ varies",
            "Each yarn multiplies its τ₁ by a random factor between these.",
        ),
        &mut yarn.vary_twist,
        0.0..=1.0,
    );
    p.range(ui, &row("squeeze B", "Each yarn is squeezed by a random share of its volume between these; squeezed yarn has less room for dye."), &mut yarn.squeeze, 0.0..=1.0);
}

fn gaps_and_paths(p: &mut Pass, ui: &mut Ui, scenario: &mut Scenario) {
    let sweeps = scenario.sweeps();
    let cloth = &mut scenario.cloth;
    p.heading("gaps");
    let gap = row("gap porosity", "The share of the gaps between yarns that dye can move in. Left out: that of the yarns beside them.").scale(0.1);
    p.optional(
        ui,
        &gap,
        &mut cloth.gap_porosity,
        0.001..=1.0,
        (cloth.warp.porosity, "as the yarns"),
    );
    p.heading("paths");
    if sweeps {
        p.say(ui, "Sweeps of batik take paper B's numbers for the paths; take the solver “diffusion” to change them.");
        return;
    }
    let paths = &mut cloth.paths;
    for (name, tip, value) in [
        (
            "dive τ₂",
            "How well dye gets through where a yarn dives from the face to the back.",
            &mut paths.dive,
        ),
        (
            "between layers",
            "τ₃ class I: between a warp and a weft yarn. 0 keeps dye in its own yarns.",
            &mut paths.between_layers,
        ),
        (
            "across a yarn",
            "τ₃ class II: across a yarn. Low values make streaks along yarns.",
            &mut paths.across_yarn,
        ),
        (
            "yarn to gap",
            "τ₃ class III: between a yarn and a gap. 0 keeps dye in the yarns.",
            &mut paths.yarn_to_gap,
        ),
        (
            "gap to gap",
            "τ₃ class IV: from gap to gap.",
            &mut paths.gap_to_gap,
        ),
        (
            "along a yarn",
            "τ₃ class V: along a yarn, the way dye runs furthest.",
            &mut paths.along_yarn,
        ),
    ] {
        p.number(ui, &row(name, tip), value, 0.0..=1.0);
    }
}

fn kasuri(p: &mut Pass, ui: &mut Ui, scenario: &mut Scenario) {
    p.heading("kasuri");
    if scenario.batik.is_some() {
        p.say(
            ui,
            "A batik begins with undyed yarns, so that it has no kasuri.",
        );
        return;
    }
    let kasuri = &mut scenario.cloth.kasuri;
    for (name, path, sections) in [
        (
            "warp dyed before",
            "cloth.kasuri.warp.pattern",
            &mut kasuri.warp,
        ),
        (
            "weft dyed before",
            "cloth.kasuri.weft.pattern",
            &mut kasuri.weft,
        ),
    ] {
        let mut is_there = sections.is_some();
        p.tick(ui, &row(name, "Kasuri (ikat): yarns are dyed in sections before they are woven, so that the pattern has feathered edges."), &mut is_there);
        if is_there != sections.is_some() {
            let across = p.cells.0.min(p.cells.1);
            *sections = is_there.then(|| KasuriSpec {
                pattern: Pattern::Invert(Box::new(Pattern::Discs {
                    diameter: Length::Cells((across / 6.0).round().max(2.0)),
                    pitch: Length::Cells((across / 3.0).round().max(4.0)),
                    staggered: false,
                })),
                amount: 0.9,
                shift: Length::Cells(4.0),
                bleed: Length::Cells(2.0),
            });
        }
        let Some(sections) = sections else { continue };
        ui.push_id(path, |ui| {
            p.indented(ui, |p, ui| {
                p.number(ui, &row("amount", "How much of what fibre can bind is bound where it was dyed."), &mut sections.amount, 0.0..=1.0);
                p.length(ui, &row("shift", "The farthest that a yarn lies from where it was planned: feathers the edges across."), &mut sections.shift, 0.0, LONGEST_SIDE);
                p.length(ui, &row("bleed", "How far dye crept under the binding: softens the edges along the yarn."), &mut sections.bleed, 0.0, 200.0);
                pattern::show(p, ui, &mut sections.pattern, path);
            });
        });
    }
}
