//! The accelerated solver against the explicit one, and the laws it must keep by itself.

mod common;
#[allow(clippy::disallowed_methods)] // A test may use the platform's own functions.
mod reference;

use bevy::app::App;
use common::{bound, concentration, dyed, experiment, go_on, ledger};
use dyelapse::prelude::*;
use reference::Reference;

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

/// Baths through covers of all kinds, on a smaller cloth.
fn soaked(solver: &str, supply: &str, more: &str) -> Experiment {
    experiment(&format!(
        "(
            title: \"soaked\", seed: 5,
            cloth: (
                size: (Cells(45), Cells(60)),
                warp: (width: Cells(4), gap: Cells(1), porosity: 0.5, vary_porosity: (0.4, 1.0)),
                paths: (yarn_to_gap: 0.05),
            ),
            supply: [{supply}],
            resist: Strength(by: 0.95, of: Noise(grain: Cells(9))),
            process: (duration: Steps(1500), {solver}),
            {more}
        )"
    ))
}

const BATHS: [&str; 5] = [
    "Bath(shape: Blur(of: Discs(diameter: Cells(9), pitch: Cells(14)), radius: Cells(2)), speed: 0.03)",
    "Bath(shape: Ramp(), dose: 0.7, speed: 0.5)",
    "Bath(shape: Noise(grain: Cells(7)), from: Steps(80), until: Steps(900)),
     Dose(shape: Disc(diameter: Cells(20)), dose: 0.6, at: Steps(300))",
    "Bath(shape: Noise(grain: Cells(7)), speed: 0.01),
     Hold(shape: Disc(diameter: Cells(20)), dose: 0.4, until: Steps(700))",
    "Bath(shape: Noise(grain: Cells(7)), dose: 0.9, speed: 0.4),
     Bath(shape: Disc(diameter: Cells(40)), dose: 0.2, speed: 0.2, until: Steps(800))",
];

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

/// The same process in both solvers, step by step and in leaps.
fn in_both(experiment: impl Fn(&str) -> Experiment) -> [App; 2] {
    ["solver: Explicit", "solver: Accelerated"].map(|solver| dyeing_app(experiment(solver)))
}

fn assert_agreement(what: &str, mut apps: [App; 2], steps: &[u64]) {
    for step in steps {
        for app in &mut apps {
            go_on(app, *step);
        }
        let [explicit, accelerated] = &apps;
        for (dye, of) in [
            ("free", concentration as fn(&App) -> &[f32]),
            ("bound", bound),
        ] {
            let (largest, rms) = differences(of(explicit), of(accelerated));
            assert!(
                largest < 1.0 / 255.0 && rms < 1.0 / 2000.0,
                "{what}: {dye} dye after {step} steps: {largest} at most, {rms} RMS"
            );
        }
        let [a, b] = [ledger(explicit), ledger(accelerated)];
        let error = (a.supplied - b.supplied)
            .abs()
            .max((a.removed - b.removed).abs());
        assert!(
            error <= 2e-3 * a.supplied,
            "{what}, step {step}: {a:?}, {b:?}"
        );
    }
}

#[test]
fn both_solvers_agree_to_less_than_a_step_of_a_picture() {
    for chemistry in CHEMISTRY {
        let apps = in_both(|solver| uneven(solver, chemistry));
        assert_agreement(chemistry, apps, &[50, 700, 1000, 1500, 3000]);
    }
}

#[test]
fn both_solvers_agree_where_dye_soaks_in_from_baths() {
    for supply in BATHS {
        for chemistry in CHEMISTRY {
            let apps = in_both(|solver| soaked(solver, supply, chemistry));
            let steps = [1, 40, 80, 85, 250, 300, 500, 700, 800, 900, 903, 1200, 1500];
            assert_agreement(&format!("{supply}, {chemistry}"), apps, &steps);
        }
    }
}

#[test]
fn where_dye_is_held_at_many_concentrations_both_solvers_agree() {
    let supply = "Hold(shape: Noise(grain: Cells(7)), until: Steps(900))";
    for chemistry in CHEMISTRY {
        // What binds by paper B's speed where all dye is held is not judged by anything.
        if !chemistry.contains("Saturating") {
            let apps = in_both(|solver| soaked(solver, supply, chemistry));
            assert_agreement(chemistry, apps, &[1, 100, 450, 900, 1500]);
        }
    }
}

#[test]
fn leaps_in_baths_agree_with_an_independent_solver_in_double_precision() {
    for supply in BATHS {
        for chemistry in [CHEMISTRY[1], CHEMISTRY[3]] {
            let experiment = soaked("", supply, chemistry);
            let mut app = dyeing_app(experiment.clone());
            let mut reference = Reference::of(&experiment, app.world().resource(), 1);
            for step in [80, 300, 900, 1500] {
                go_on(&mut app, step);
                reference.go_on(step);
                let (worst, rms) = reference.differences(concentration(&app), bound(&app));
                assert!(
                    worst < 1.0 / 255.0 && rms < 1.0 / 2000.0,
                    "{supply}, {chemistry}: {worst} at most, {rms} RMS at step {step}"
                );
            }
        }
    }
}

#[test]
fn leaps_agree_with_steps_that_are_split_where_dye_soaks_in() {
    for supply in BATHS {
        let coarse = |solver: &str| {
            let apps = soaked(&format!("step_h: 0.002, {solver}"), supply, "");
            assert_eq!(apps.scenario.process.step_h, 0.002);
            apps
        };
        let apps = in_both(coarse);
        assert!(apps[0].world().resource::<ProcessClock>().splits > 1);
        assert_agreement(supply, apps, &[1, 30, 80, 300, 900, 1500]);
    }
}

#[test]
fn a_bath_that_reaches_all_of_a_cloth_leaves_what_its_speed_leaves_of_the_difference() {
    for solver in ["solver: Explicit", "solver: Accelerated"] {
        for (speeds, doses) in [
            ([0.5, 0.0], [1.0, 0.0]),
            ([0.02, 0.3], [0.9, 0.4]),
            ([0.001, 0.0], [0.6, 0.0]),
        ] {
            let bath = |i: usize| {
                format!(
                    "Bath(shape: Everywhere, dose: {}, speed: {})",
                    doses[i], speeds[i]
                )
            };
            let mut app = dyeing_app(experiment(&format!(
                "(title: \"bath\", cloth: (size: (Cells(9), Cells(9))), supply: [{}, {}],
                  process: (duration: Steps(4000), {solver}))",
                bath(0),
                bath(1)
            )));
            let mut c = 0.0;
            for step in 1..=4000 {
                for (speed, dose) in speeds.iter().zip(doses) {
                    c += speed * (dose - c);
                }
                if [1, 2, 3, 10, 100, 600, 2000, 4000].contains(&step) {
                    go_on(&mut app, step);
                    let within = if step < 20 || solver.contains("Explicit") {
                        1e-6
                    } else {
                        5e-4
                    };
                    for now in concentration(&app) {
                        let now = f64::from(*now);
                        assert!(
                            (now - c).abs() < within,
                            "{solver}, {speeds:?}, step {step}: {now} for {c}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let run = |threads: usize, supply: &str, chemistry: &str| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let mut app = dyed(soaked("", supply, chemistry), 400);
            go_on(&mut app, 1000);
            (
                concentration(&app).to_vec(),
                bound(&app).to_vec(),
                ledger(&app),
            )
        })
    };
    for (supply, chemistry) in BATHS.into_iter().zip(CHEMISTRY) {
        let one = run(1, supply, chemistry);
        for threads in [2, 5] {
            assert!(
                one == run(threads, supply, chemistry),
                "{threads} threads: {supply}, {chemistry}"
            );
        }
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
    let held = CHEMISTRY.map(|chemistry| uneven("", chemistry));
    let in_baths = BATHS.into_iter().zip(CHEMISTRY);
    let in_baths = in_baths.map(|(supply, chemistry)| soaked("", supply, chemistry));
    for experiment in held.into_iter().chain(in_baths) {
        let once = dyed(experiment.clone(), 1400);
        let mut often = dyeing_app(experiment.clone());
        for step in (0..1400).step_by(9) {
            go_on(&mut often, step);
        }
        go_on(&mut often, 1400);
        let text = &experiment.text;
        assert_eq!(concentration(&once), concentration(&often), "{text}");
        assert_eq!(bound(&once), bound(&often), "{text}");
        let [a, b] = [ledger(&once), ledger(&often)];
        let difference = (a.supplied - b.supplied)
            .abs()
            .max((a.removed - b.removed).abs());
        assert!(difference < 1e-9 * a.supplied, "{text}: {a:?}, {b:?}");
    }
}

#[test]
fn dye_is_conserved_at_every_moment() {
    let held = CHEMISTRY.map(|chemistry| uneven("", chemistry));
    let in_baths = BATHS
        .iter()
        .flat_map(|supply| CHEMISTRY.map(|chemistry| soaked("", supply, chemistry)));
    for experiment in held.into_iter().chain(in_baths) {
        let text = experiment.text.clone();
        let end = experiment.scenario.process.steps();
        let mut app = dyeing_app(experiment);
        for step in (0..end).step_by(61) {
            go_on(&mut app, step);
            let ledger = ledger(&app);
            let error = ledger.imbalance().abs();
            assert!(
                error <= 1e-6 * ledger.supplied,
                "{text}, step {step}: {ledger:?}"
            );
            let c = concentration(&app);
            assert!(
                c.iter().all(|c| (0.0..=1.0).contains(c)),
                "{text}, step {step}"
            );
        }
    }
}
