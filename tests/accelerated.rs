//! The accelerated solver against the explicit one, and the laws it must keep by itself.

mod common;

use common::{bound, concentration, dyed, experiment, go_on, ledger};
use dyelapse::prelude::*;

/// A cloth of several tiles with yarns of all kinds, held dye, resist, and a later dose.
fn uneven(solver: &str, more: &str) -> Experiment {
    experiment(&format!(
        "(
            title: \"uneven\", seed: 3,
            cloth: (
                size: (Cells(75), Cells(130)),
                warp: (width: Cells(4), gap: Cells(1), porosity: 0.5, vary_porosity: (0.4, 1.0)),
                paths: (yarn_to_gap: 0.05),
            ),
            supply: [
                Hold(shape: Disc(diameter: Cells(20)), until: Steps(1500)),
                Dose(shape: Stripes(width: Cells(3), gap: Cells(30)), dose: 0.6, at: Steps(700)),
            ],
            resist: Strength(by: 0.95, of: Noise(grain: Cells(9))),
            process: (duration: Steps(3000), {solver}),
            {more}
        )"
    ))
}

const CHEMISTRY: [&str; 7] = [
    "",
    "dye: (equilibrium: 0.3)",
    "adsorption: (isotherm: Partition(k: 1.0))",
    "adsorption: (isotherm: Freundlich(k: 0.5, b: 0.5))",
    "adsorption: (isotherm: Freundlich(k: 0.5, b: 0.3)), dye: (equilibrium: 0.5)",
    "adsorption: (isotherm: Langmuir(kl: 100.0))",
    "adsorption: (isotherm: Saturating(speed: 0.004, most: 0.4))",
];

/// The largest and the root mean square difference of two fields.
fn differences(a: &[f32], b: &[f32]) -> (f64, f64) {
    let difference = |(a, b): (&f32, &f32)| (f64::from(*a) - f64::from(*b)).abs();
    let all = || a.iter().zip(b).map(difference);
    let square: f64 = all().map(|d| d * d).sum();
    (
        all().fold(0.0, f64::max),
        (square / a.len().max(1) as f64).sqrt(),
    )
}

#[test]
fn both_solvers_agree_to_less_than_a_step_of_a_picture() {
    for chemistry in CHEMISTRY {
        let [mut explicit, mut accelerated] = ["solver: Explicit", "solver: Accelerated"]
            .map(|solver| dyeing_app(uneven(solver, chemistry)));
        for step in [50, 700, 1000, 1500, 3000] {
            go_on(&mut explicit, step);
            go_on(&mut accelerated, step);
            let (largest, rms) = differences(concentration(&explicit), concentration(&accelerated));
            assert!(
                largest < 1.0 / 255.0 && rms < 1.0 / 2000.0,
                "{chemistry}: free dye after {step} steps: {largest} at most, {rms} RMS"
            );
            let (largest, rms) = differences(bound(&explicit), bound(&accelerated));
            assert!(
                largest < 1.0 / 255.0 && rms < 1.0 / 2000.0,
                "{chemistry}: bound dye after {step} steps: {largest} at most, {rms} RMS"
            );
        }
        let [a, b] = [ledger(&explicit), ledger(&accelerated)];
        assert!(
            (a.supplied / b.supplied - 1.0).abs() < 2e-3,
            "{chemistry}: {a:?}, {b:?}"
        );
    }
}

#[test]
fn a_smaller_tolerance_gives_a_smaller_error() {
    let explicit = dyed(uneven("solver: Explicit", ""), 1400);
    let errors = [0.05, 0.01, 0.002].map(|tolerance| {
        let app = dyed(uneven(&format!("tolerance: {tolerance}"), ""), 1400);
        differences(concentration(&explicit), concentration(&app)).1
    });
    assert!(
        errors[1] < 0.7 * errors[0] && errors[2] < 0.7 * errors[1],
        "{errors:?}"
    );
}

#[test]
fn looking_often_changes_nothing() {
    for chemistry in CHEMISTRY {
        let once = dyed(uneven("", chemistry), 1600);
        let mut often = dyeing_app(uneven("", chemistry));
        for step in (0..1600).step_by(9) {
            go_on(&mut often, step);
        }
        go_on(&mut often, 1600);
        assert_eq!(concentration(&once), concentration(&often), "{chemistry}");
        assert_eq!(bound(&once), bound(&often), "{chemistry}");
        let difference = ledger(&once).supplied - ledger(&often).supplied;
        assert!(
            difference.abs() < 1e-9 * ledger(&once).supplied,
            "{chemistry}"
        );
    }
}

#[test]
fn dye_is_conserved_at_every_moment() {
    for chemistry in CHEMISTRY {
        let mut app = dyeing_app(uneven("", chemistry));
        for step in (0..3000).step_by(61) {
            go_on(&mut app, step);
            let ledger = ledger(&app);
            let error = ledger.imbalance().abs() / ledger.supplied;
            assert!(error < 1e-6, "{chemistry}, step {step}: {error:e}");
        }
    }
}
