//! Batik: its steps, how dye moves through waxed cloth, what is shown.

use bevy_egui::egui::Ui;

use super::row::{Effect, Pass, row};
use super::wax::wax_rows;
use crate::batik::drawing::{Ground, Waxed};
use crate::batik::sweep::BathSpec;
use crate::pattern::Pattern;
use crate::scenario::units::MOST_STEPS;
use crate::scenario::{
    BatikShow, BatikSolver, BatikSpec, BatikStep, Length, MOST_BATHS, Reading, Scenario,
    SupplySpec, Time,
};

const KINDS: [&str; 3] = ["wax", "dye", "boil"];

pub(super) fn show(p: &mut Pass, ui: &mut Ui, scenario: &mut Scenario) {
    let mut is_batik = scenario.batik.is_some();
    let batik = row(
        "a batik",
        "Wax, dye, wax again, dye darker, boil the wax off. Takes out what does not go with it: kasuri, \
         other colours, and with sweeps the supply, resist and adsorption.",
    );
    p.tick(ui, &batik, &mut is_batik);
    if is_batik != scenario.batik.is_some() {
        let across = p.cells.0.min(p.cells.1);
        match is_batik {
            true => scenario.batik = Some(recipe(across)),
            false => {
                scenario.batik = None;
                if scenario.supply.is_empty() {
                    scenario.supply.push(everywhere());
                    scenario.process.duration = Time::Hours(1.0);
                }
            }
        }
    }
    let Some(batik) = &mut scenario.batik else {
        return;
    };
    solver(p, ui, batik);
    steps(p, ui, batik);
}

fn everywhere() -> SupplySpec {
    SupplySpec::Hold {
        shape: Pattern::Everywhere,
        dose: 1.0,
        from: Time::Steps(0),
        until: None,
    }
}

/// Waxed discs in one bath of indigo.
fn recipe(across: f64) -> BatikSpec {
    BatikSpec {
        steps: vec![wax(across), dye(), BatikStep::Boil],
        cloth: (44.0, 0.07, 0.955),
        solver: BatikSolver::default(),
        show: BatikShow::Cloth,
        show_wax: true,
    }
}

fn wax(across: f64) -> BatikStep {
    BatikStep::Wax {
        drawing: None,
        ground: Ground::Detect,
        waxed: Waxed::Drawing,
        pattern: Some(discs(across)),
        crackle: Default::default(),
        edge: Default::default(),
    }
}

pub(super) fn discs(across: f64) -> Pattern {
    Pattern::Discs {
        diameter: Length::Cells((across / 4.0).max(2.0)),
        pitch: Length::Cells((across / 3.0).max(2.0)),
        staggered: true,
    }
}

fn dye() -> BatikStep {
    BatikStep::Dye {
        colour: (222.0, 0.70, 0.52),
        lasts: Time::Steps(5),
        bath: BathSpec::default(),
        rinse: false,
    }
}

fn solver(p: &mut Pass, ui: &mut Ui, batik: &mut BatikSpec) {
    let solver = row(
        "dye moves by",
        "Sweeps in place, as in paper B: a step is a scan. Or the diffusion of paper D, with its paths, \
         dye and adsorption; wax then covers the cloth in the bath.",
    );
    let now = usize::from(!batik.sweeps());
    if let Some(kind) = p.variant(ui, &solver, now, &["sweeps", "diffusion"]) {
        batik.solver = match kind {
            0 => BatikSolver::default(),
            _ => BatikSolver::Diffusion,
        };
    }
    if let BatikSolver::PixelDiffusing { reading, step } = &mut batik.solver {
        let table = row(
            "reading of τ₂",
            "Physical: dye runs mainly along yarns, as paper B says. Printed: the numbers of its table.",
        );
        let both = [
            ("physical", Reading::Physical),
            ("printed", Reading::Printed),
        ];
        p.choice(ui, &table, reading, &both);
        let scan = row(
            "scan Δt",
            "How far dye moves in one scan: more makes softer edges.",
        );
        p.number(ui, &scan.scale(10.0), step, 0.0..=1e4);
    }
    p.effect = Effect::Look;
    p.colour(
        ui,
        &row(
            "undyed cloth",
            "The colour of the cloth before the first bath.",
        ),
        &mut batik.cloth,
    );
    let show = row(
        "shown",
        "The cloth, the wax with its cracks, or how well the wax lets dye through.",
    );
    let all = [
        ("cloth", BatikShow::Cloth),
        ("wax drawing", BatikShow::Drawing),
        ("permeation", BatikShow::Permeation),
    ];
    p.choice(ui, &show, &mut batik.show, &all);
    let wax = row(
        "show the wax",
        "Whether wax is seen until it is boiled off.",
    );
    p.tick(ui, &wax, &mut batik.show_wax);
    p.effect = Effect::Anew;
}

fn steps(p: &mut Pass, ui: &mut Ui, batik: &mut BatikSpec) {
    let add = row(
        "add a step",
        "What is done next: wax is laid on, a bath of dye, or all wax is boiled off.",
    );
    let title = |step: &BatikStep| match step {
        BatikStep::Wax { .. } => "wax".to_owned(),
        BatikStep::Dye { .. } => "dye".to_owned(),
        BatikStep::Boil => "boil".to_owned(),
    };
    let is_bath = |step: &&BatikStep| matches!(step, BatikStep::Dye { .. });
    let full = batik.steps.iter().filter(is_bath).count() >= MOST_BATHS;
    let across = p.cells.0.min(p.cells.1);
    let unit = if batik.sweeps() { "scans" } else { "steps" };
    let make = |kind: usize| match kind {
        0 => Some(wax(across)),
        1 if !full => Some(dye()),
        1 => None,
        _ => Some(BatikStep::Boil),
    };
    p.list(
        ui,
        &add,
        &mut batik.steps,
        (1, 100),
        title,
        &KINDS,
        make,
        |p, ui, i, step| match step {
            BatikStep::Wax { .. } => wax_rows(p, ui, i, step),
            BatikStep::Dye { .. } => dye_rows(p, ui, step, unit),
            BatikStep::Boil => p.say(ui, "All wax is boiled off. Lasts one step."),
        },
    );
}

fn dye_rows(p: &mut Pass, ui: &mut Ui, step: &mut BatikStep, unit: &str) {
    let BatikStep::Dye {
        colour,
        lasts,
        bath,
        rinse,
    } = step
    else {
        return;
    };
    p.effect = Effect::Look;
    p.colour(
        ui,
        &row("colour", "The colour of cloth full of this dye."),
        colour,
    );
    p.effect = Effect::Anew;
    let tip = format!("How long the cloth is in the bath, in {unit}.");
    p.time(ui, &row("lasts", &tip), lasts, 1, MOST_STEPS / 1000);
    for (name, tip, value, most) in [
        (
            "concentration M_s",
            "How strong the bath is.",
            &mut bath.concentration,
            1.0,
        ),
        (
            "supply α",
            "How much of what is missing comes in through open wax in one update.",
            &mut bath.supply,
            0.5,
        ),
        ("binding α_d", "How fast dye binds.", &mut bath.binding, 1.0),
        (
            "most bound a_d",
            "The most dye that fibre binds, in units of the most free dye.",
            &mut bath.most_bound,
            1.0,
        ),
    ] {
        p.number(ui, &row(name, tip).scale(0.1), value, 0.0..=most);
    }
    let tip = "Washes out what has not bound after the bath; else all dye is fixed.";
    p.tick(ui, &row("rinse", tip), rinse);
}
