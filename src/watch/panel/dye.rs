//! The dye: how fast it moves, where and when it is given, how it binds.

use bevy_egui::egui::Ui;

use super::kinds;
use super::mend::most_diffusivity;
use super::pattern;
use super::presets;
use super::row::{Pass, row};
use crate::pattern::Pattern;
use crate::scenario::units::MOST_STEPS;
use crate::scenario::{AdsorptionSpec, Diffusivity, Isotherm, Scenario, SupplySpec, Time};

const SWEEPS: &str = "The baths of a batik by sweeps are all its dye, take paper B's numbers and bind by \
                      themselves. Take the solver “diffusion” (process, batik) to change these.";

pub(super) fn show(p: &mut Pass, ui: &mut Ui, scenario: &mut Scenario) {
    p.group(ui, "Dye", |p, ui| {
        if scenario.sweeps() {
            p.say(ui, SWEEPS);
            return;
        }
        speed(p, ui, scenario);
        p.heading("supply");
        supplies(p, ui, scenario);
        p.heading("adsorption");
        adsorption(p, ui, &mut scenario.adsorption);
    });
}

fn speed(p: &mut Pass, ui: &mut Ui, scenario: &mut Scenario) {
    let fastest = most_diffusivity(scenario);
    let lightest = (76.0 * (3.6 / fastest) * (3.6 / fastest) * (1.0 + 1e-9)).clamp(1.0, 1e6);
    let dye = &mut scenario.dye;
    p.heading("dye");
    let preset = row(
        "molecule",
        "Sets the speed of the dye by the mass of its molecule: large ones move slowly.",
    );
    let names: Vec<&str> = presets::MOLECULES.iter().map(|(name, _)| *name).collect();
    let is = |(_, mass): &(&str, f64)| dye.diffusivity == Diffusivity::MolarMass(*mass);
    let now = presets::MOLECULES.iter().position(is);
    if let Some(i) = p.variant(ui, &preset, now.unwrap_or(usize::MAX), &names) {
        dye.diffusivity = Diffusivity::MolarMass(presets::MOLECULES[i].1.max(lightest));
    }
    let by = row(
        "speed given by",
        "The diffusion coefficient in water itself, or the molar mass that it follows from.",
    );
    let now = usize::from(matches!(dye.diffusivity, Diffusivity::MolarMass(_)));
    if let Some(kind) = p.variant(ui, &by, now, &["diffusivity D₀", "molar mass M"]) {
        let d0 = dye.diffusivity.in_water();
        dye.diffusivity = match kind {
            0 => Diffusivity::InWater(d0.min(fastest)),
            _ => {
                let mass = 76.0 * (3.6 / d0.max(1e-3)) * (3.6 / d0.max(1e-3));
                Diffusivity::MolarMass(mass.clamp(lightest, 1e6))
            }
        };
    }
    match &mut dye.diffusivity {
        Diffusivity::InWater(d0) => {
            let tip =
                "How fast dye spreads in water. Twice as much, and it is as far in half the time.";
            let d0_row = row("diffusivity D₀", tip).unit(" mm²/h");
            p.number(ui, &d0_row, d0, 0.0..=fastest);
        }
        Diffusivity::MolarMass(mass) => {
            let tip =
                "Dye of heavy molecules spreads slowly: D₀ = 3.6·√(76/M) mm²/h. Indigo has 262.27.";
            let mass_row = row("molar mass M", tip).unit(" g/mol");
            p.number(ui, &mass_row, mass, lightest..=1e6);
        }
    }
    let equilibrium = row(
        "equilibrium φ₀",
        "Above this share of the free capacity dye moves more slowly, so that its fronts are steeper. 1 \
         leaves the speed alone.",
    );
    p.number(
        ui,
        &equilibrium.scale(0.1),
        &mut dye.equilibrium,
        0.001..=1.0,
    );
}

fn supplies(p: &mut Pass, ui: &mut Ui, scenario: &mut Scenario) {
    let add = row(
        "add dye",
        "A dose is poured on once. What is held stays at its concentration. A bath soaks in slowly \
         through wax or cover.",
    );
    let title = |supply: &SupplySpec| {
        let kind = match supply {
            SupplySpec::Dose { .. } => "dose",
            SupplySpec::Hold { .. } => "held",
            SupplySpec::Bath { .. } => "bath",
        };
        format!("{kind}, {}", kinds::word(supply.shape()))
    };
    let cells = p.cells;
    let make = |kind: usize| Some(of_kind(kind, stripe(cells), 1.0, Time::Steps(0)));
    p.list(
        ui,
        &add,
        &mut scenario.supply,
        (0, 1000),
        title,
        &KINDS,
        make,
        |p, ui, i, supply| supply_rows(p, ui, i, supply),
    );
}

const KINDS: [&str; 3] = ["dose", "held", "bath"];

fn stripe((width, _): (f64, f64)) -> Pattern {
    use crate::scenario::Length::Cells;
    Pattern::Stripes {
        width: Cells(8.0),
        gap: Cells((width - 8.0).max(0.0)),
        offset: Cells((width / 2.0 - 4.0).max(0.0)),
        angle: 0.0,
    }
}

fn of_kind(kind: usize, shape: Pattern, dose: f64, from: Time) -> SupplySpec {
    let until = None;
    match kind {
        0 => SupplySpec::Dose {
            shape,
            dose,
            at: from,
        },
        1 => SupplySpec::Hold {
            shape,
            dose,
            from,
            until,
        },
        _ => SupplySpec::Bath {
            shape,
            dose,
            speed: 0.3,
            from,
            until,
        },
    }
}

fn supply_rows(p: &mut Pass, ui: &mut Ui, i: usize, supply: &mut SupplySpec) {
    let way = row(
        "way",
        "Poured on once, held at its concentration, or soaked in from a bath.",
    );
    let now = match supply {
        SupplySpec::Dose { .. } => 0,
        SupplySpec::Hold { .. } => 1,
        SupplySpec::Bath { .. } => 2,
    };
    if let Some(kind) = p.variant(ui, &way, now, &KINDS) {
        let (SupplySpec::Dose { dose, at: from, .. }
        | SupplySpec::Hold { dose, from, .. }
        | SupplySpec::Bath { dose, from, .. }) = *supply;
        *supply = of_kind(kind, supply.shape().clone(), dose, from);
    }
    let strength = row(
        "concentration",
        "How strong the dye is in the liquid. 0 washes dye out.",
    );
    match supply {
        SupplySpec::Dose { dose, at, .. } => {
            p.number(ui, &strength, dose, 0.0..=1.0);
            p.time(
                ui,
                &row("poured on at", "When the dose is given."),
                at,
                0,
                MOST_STEPS,
            );
        }
        SupplySpec::Hold {
            dose, from, until, ..
        } => {
            p.number(ui, &strength, dose, 0.0..=1.0);
            span(p, ui, from, until);
        }
        SupplySpec::Bath {
            dose,
            speed,
            from,
            until,
            ..
        } => {
            p.number(ui, &strength, dose, 0.0..=1.0);
            let soak = row(
                "speed α",
                "The share of what is missing that soaks in during one step.",
            );
            p.number(ui, &soak.scale(0.1), speed, 0.0..=0.5);
            span(p, ui, from, until);
        }
    }
    let (SupplySpec::Dose { shape, .. }
    | SupplySpec::Hold { shape, .. }
    | SupplySpec::Bath { shape, .. }) = supply;
    pattern::show(p, ui, shape, &format!("supply[{i}].shape"));
}

fn span(p: &mut Pass, ui: &mut Ui, from: &mut Time, until: &mut Option<Time>) {
    let step_h = p.step_h;
    let latest = until.map_or(MOST_STEPS, |until| until.steps(step_h));
    p.time(ui, &row("from", "When it begins."), from, 0, latest);
    let ends = row("until", "When it ends. Left out: with the process.");
    let mut is_there = until.is_some();
    let earliest = from.steps(step_h);
    p.ticked_row(ui, &ends, Some(&mut is_there), |p, ui| match until {
        Some(until) => p.time_value(ui, &ends, until, earliest, MOST_STEPS),
        None => {
            ui.weak("the end");
        }
    });
    if is_there != until.is_some() {
        let later = Time::Steps(earliest.saturating_add(1000).min(MOST_STEPS));
        *until = is_there.then_some(later);
    }
}

fn adsorption(p: &mut Pass, ui: &mut Ui, adsorption: &mut Option<AdsorptionSpec>) {
    let binds = row(
        "binds to fibre",
        "Dye that has bound stays where it is and is not rinsed out. Without, all dye goes on moving.",
    );
    let mut is_there = adsorption.is_some();
    p.tick(ui, &binds, &mut is_there);
    if is_there != adsorption.is_some() {
        *adsorption = is_there.then_some(presets::BINDINGS[1].1);
    }
    let Some(spec) = adsorption else { return };
    let preset = row("kind of binding", "Sets the isotherm to a common kind.");
    p.choice(ui, &preset, spec, &presets::BINDINGS);
    let kind = row(
        "isotherm",
        "How much fibre binds beside a given amount of free dye: in proportion (Nernst), much from thin \
         dye (Freundlich), until its places are taken (Langmuir), or ever more slowly (saturating).",
    );
    let now = match spec.isotherm {
        Isotherm::Partition { .. } => 0,
        Isotherm::Freundlich { .. } => 1,
        Isotherm::Langmuir { .. } => 2,
        Isotherm::Saturating { .. } => 3,
    };
    let names = ["partition", "Freundlich", "Langmuir", "saturating"];
    if let Some(kind) = p.variant(ui, &kind, now, &names) {
        spec.isotherm = match kind {
            0 => Isotherm::Partition { k: 1.0 },
            1 => Isotherm::Freundlich { k: 0.6, b: 0.5 },
            2 => Isotherm::Langmuir { kl: 20.0 },
            _ => Isotherm::Saturating {
                speed: 0.1,
                most: 0.5,
            },
        };
    }
    if !matches!(spec.isotherm, Isotherm::Saturating { .. }) {
        let rate = row(
            "rate D_ab/D₀",
            "How fast dye binds. Fast, and it stays near where it came in.",
        );
        p.number(ui, &rate.scale(0.01), &mut spec.rate, 0.0..=1.0);
    }
    let k_row = row(
        "k",
        "How much binds beside dye: larger takes more dye out of the bath.",
    );
    match &mut spec.isotherm {
        Isotherm::Partition { k } => p.number(ui, &k_row, k, 0.0..=1e6),
        Isotherm::Freundlich { k, b } => {
            p.number(ui, &k_row, k, 0.0..=1e6);
            let b_row = row("exponent b", "The smaller, the more binds from thin dye.");
            p.number(ui, &b_row, b, 0.1..=1.0);
        }
        Isotherm::Langmuir { kl } => {
            let tip = "The equilibrium constant: the larger, the sooner fibre is full.";
            p.number(ui, &row("K_L", tip), kl, 0.0..=1e6);
        }
        Isotherm::Saturating { speed, most } => {
            let tip = "The share of what has room that binds in one step.";
            p.number(ui, &row("speed α_d", tip), speed, 0.0..=1.0);
            let tip = "The most that fibre binds, as a share of a cell.";
            p.number(ui, &row("most bound a_d", tip), most, 0.0..=1.0);
        }
    }
}
