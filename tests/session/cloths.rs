//! Small cloths that use every way in which dye moves.

use bevy::app::App;
use bevy::ecs::world::World;
use dyelapse::prelude::*;

use crate::common::{self, experiment};

/// A cloth: its name, its text, and the steps at which it is looked at.
pub struct Sample {
    pub name: &'static str,
    pub text: String,
    pub stops: [u64; 3],
    /// Whether the ledger is the same to the last bit wherever one stops.
    pub exact_ledger: bool,
}

const CLOTH: &str = "cloth: (size: (Cells(70), Cells(45)), warp: (width: Cells(4), gap: Cells(1),
    vary_porosity: (0.5, 1.0)),";

fn sample(name: &'static str, rest: &str, stops: [u64; 3]) -> Sample {
    let paths = match name {
        "sweeps" => "",
        _ => "paths: (yarn_to_gap: 0.2)",
    };
    Sample {
        name,
        text: format!("(title: \"t\", seed: 5, {CLOTH} {paths}), {rest})"),
        stops,
        exact_ledger: true,
    }
}

/// One cloth for every solver, and for everything that supply, fibre and wax can do.
pub fn samples() -> Vec<Sample> {
    let mut all = vec![
        sample(
            "seikaiha",
            "supply: [Hold(shape: Stripes(width: Cells(4), gap: Cells(31), offset: Cells(15)))],
             resist: Strength(by: 0.98, of: Blur(radius: Cells(1),
                of: Seikaiha(radius: Cells(30), arcs: 4, open: 0.45))),
             process: (duration: Steps(20000))",
            [1234, 7000, 20_000],
        ),
        sample(
            "doses",
            "supply: [Dose(shape: Disc(diameter: Cells(20)), dose: 0.9),
                      Dose(shape: Noise(grain: Cells(9)), dose: 0.4, at: Steps(700)),
                      Hold(shape: Ramp(), dose: 0.3, from: Steps(300), until: Steps(1500))],
             dye: (equilibrium: 0.4), process: (duration: Steps(3000))",
            [700, 1501, 3000],
        ),
        sample(
            "langmuir",
            "supply: [Hold(shape: Disc(diameter: Cells(20)), until: Steps(2500))],
             adsorption: (isotherm: Langmuir(kl: 20)), process: (duration: Steps(4000))",
            [333, 2500, 4000],
        ),
        sample(
            "bath",
            "supply: [Bath(shape: Noise(grain: Cells(6)), speed: 0.2, until: Steps(900))],
             adsorption: (isotherm: Saturating(speed: 0.1, most: 0.4)),
             process: (duration: Steps(1500))",
            [111, 901, 1500],
        ),
        sample(
            "explicit",
            "supply: [Hold(shape: Disc(diameter: Cells(20)), until: Steps(300)),
                      Dose(shape: Ramp(), at: Steps(100))],
             process: (duration: Steps(700), solver: Explicit)",
            [100, 450, 700],
        ),
        sample(
            "explicit and bound",
            "supply: [Dose(shape: Disc(diameter: Cells(20)))],
             adsorption: (isotherm: Freundlich(k: 0.5, b: 0.5)),
             process: (duration: Steps(400), solver: Explicit)",
            [77, 200, 400],
        ),
        sample(
            "explicit in parts, in a bath",
            "supply: [Bath(shape: Ramp(), speed: 0.4, until: Steps(60))],
             process: (duration: Steps(100), step_h: 0.004, solver: Explicit)",
            [33, 60, 100],
        ),
        sample(
            "sweeps",
            "batik: (steps: [
                Wax(pattern: Disc(diameter: Cells(30))),
                Dye(colour: (17, 0.8, 0.5), lasts: Steps(4)),
                Wax(pattern: Stripes(width: Cells(9), gap: Cells(20))),
                Dye(colour: (222, 0.7, 0.5), lasts: Steps(5), rinse: true),
                Boil]),
             supply: [], process: (duration: Steps(12))",
            [3, 8, 12],
        ),
        sample(
            "batik by diffusion",
            "batik: (solver: Diffusion, steps: [
                Wax(pattern: Disc(diameter: Cells(30))),
                Dye(colour: (17, 0.8, 0.5), lasts: Steps(40)),
                Wax(pattern: Stripes(width: Cells(9), gap: Cells(20))),
                Dye(colour: (222, 0.7, 0.5), lasts: Steps(50), rinse: true),
                Boil]),
             adsorption: (isotherm: Saturating(speed: 0.1, most: 0.4)),
             supply: [], process: (duration: Steps(93))",
            [23, 60, 93],
        ),
    ];
    // Explicit steps taken many at a time, and scans, are booked in the parts in which they are done.
    for sample in &mut all {
        sample.exact_ledger = !["explicit", "sweeps"].contains(&sample.name);
    }
    all
}

impl Sample {
    /// A world at the first moment.
    pub fn app(&self) -> App {
        dyeing_app(experiment(&self.text))
    }

    /// A world that went straight to a step, and was looked at only there.
    pub fn straight(&self, step: u64) -> App {
        common::dyed(experiment(&self.text), step)
    }
}

/// Demands that two worlds are the same to the last bit; the ledger only if it is `exact`.
pub fn assert_same(a: &World, b: &World, exact: bool, what: &str) {
    let step = |world: &World| {
        let clock = world.resource::<ProcessClock>();
        (clock.step, clock.part)
    };
    assert_eq!(step(a), step(b), "{what}: clock");
    let (free_a, free_b) = (a.resource::<FreeDye>(), b.resource::<FreeDye>());
    let same = |a: &[f32], b: &[f32]| {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
    };
    assert!(
        same(&free_a.concentration, &free_b.concentration),
        "{what}: free"
    );
    assert!(same(&free_a.carry, &free_b.carry), "{what}: left over");
    let (bound_a, bound_b) = (a.resource::<BoundDye>(), b.resource::<BoundDye>());
    // Where nothing was ever bound, or nothing was asked for, there is no field.
    let whole = |field: &[f32]| {
        let mut field = field.to_vec();
        field.resize(free_a.concentration.len(), 0.0);
        field
    };
    for (a, b) in [
        (&bound_a.amount, &bound_b.amount),
        (&bound_a.carry, &bound_b.carry),
    ] {
        assert!(same(&whole(a), &whole(b)), "{what}: bound");
    }
    let picture = |world: &World| world.resource::<Picture>().rgb.clone();
    assert!(picture(a) == picture(b), "{what}: picture");
    let (a, b) = (a.resource::<Ledger>(), b.resource::<Ledger>());
    if exact {
        assert_eq!(a, b, "{what}");
        return;
    }
    for (a, b) in [
        (a.supplied, b.supplied),
        (a.removed, b.removed),
        (a.free, b.free),
        (a.bound, b.bound),
    ] {
        assert!((a - b).abs() <= 1e-9 * (1.0 + a.abs()), "{what}: ledger");
    }
}
