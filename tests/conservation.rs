//! Dye is neither made nor lost, and no cell holds less than none or more than it can.

mod common;

use common::{bound, concentration, dyed, experiment, go_on, ledger};
use dyelapse::adsorption::Capacities;
use dyelapse::prelude::*;
use dyelapse::scenario::bundled_names;

/// supplied = free + bound + removed, to a millionth of what was supplied.
fn assert_balanced(name: &str, ledger: &Ledger) {
    let error = ledger.imbalance().abs() / ledger.supplied;
    assert!(ledger.supplied > 0.0, "{name}: nothing was supplied");
    assert!(
        error < 1e-6,
        "{name}: {error:e} of the dye is missing: {ledger:?}"
    );
}

#[test]
fn dye_is_conserved_over_5000_steps_of_every_bundled_scenario() {
    for name in bundled_names() {
        let experiment = Experiment::load(name).unwrap();
        let steps = experiment.scenario.process.steps().min(5000);
        let app = dyed(experiment, steps);
        assert_balanced(name, &ledger(&app));
        assert!(
            concentration(&app).iter().all(|c| (0.0..=1.0).contains(c)),
            "{name}: a concentration has left 0 to 1"
        );
    }
}

/// A cloth as uneven as can be: porosity from 0.01 to 1, resist from 0 to 0.99, cell by cell.
fn wild_cloth(seed: u64, solver: &str, more: &str) -> Experiment {
    experiment(&format!(
        "(
            title: \"wild\", seed: {seed},
            cloth: (
                size: (Cells(61), Cells(47)),
                warp: (width: Cells(1), gap: Cells(0), porosity: 1.0, vary_porosity: (0.01, 1.0)),
                weft: (width: Cells(2), gap: Cells(1), porosity: 1.0, vary_porosity: (0.01, 1.0)),
                gap_porosity: 1.0,
            ),
            supply: [
                Hold(shape: Disc(diameter: Cells(14)), until: Steps(150)),
                Dose(shape: Noise(grain: Cells(2)), dose: 0.7, at: Steps(20)),
            ],
            resist: Strength(of: Noise(grain: Cells(1.5), octaves: 1), by: 0.99),
            process: (duration: Steps(400), solver: {solver}),
            {more}
        )"
    ))
}

#[test]
fn concentration_stays_between_0_and_1_at_every_step_on_wild_cloth() {
    let more = [
        "",
        "dye: (equilibrium: 0.2)",
        "adsorption: (rate: 1.0, isotherm: Langmuir(kl: 1000.0))",
        "adsorption: (rate: 0.3, isotherm: Freundlich(k: 2.0, b: 0.3)), dye: (equilibrium: 0.5)",
        "adsorption: (rate: 1.0, isotherm: Partition(k: 1e6))",
    ];
    for solver in ["Explicit", "Accelerated"] {
        for (seed, more) in more.iter().enumerate() {
            let mut app = dyeing_app(wild_cloth(seed as u64, solver, more));
            for step in 0..=400 {
                go_on(&mut app, step);
                for (i, c) in concentration(&app).iter().enumerate() {
                    assert!(
                        (0.0..=1.0).contains(c),
                        "{solver}, {more}: step {step}, cell {i}: {c}"
                    );
                }
                assert_balanced(&format!("{solver}, {more}"), &ledger(&app));
            }
        }
    }
}

#[test]
fn one_way_adsorption_never_passes_the_fibre_or_the_isotherm_and_never_goes_back() {
    for isotherm in [
        "Partition(k: 0.4)",
        "Freundlich(k: 0.5, b: 0.5)",
        "Freundlich(k: 0.3, b: 0.2)",
        "Langmuir(kl: 20.0)",
    ] {
        let more = format!("adsorption: (rate: 0.2, isotherm: {isotherm})");
        let mut app = dyeing_app(wild_cloth(5, "Explicit", &more));
        let spec = app
            .world()
            .resource::<dyelapse::schedule::TheExperiment>()
            .scenario
            .adsorption
            .unwrap();
        let Capacities {
            free: v_u,
            bound: v_d,
        } = Capacities::of(app.world().resource::<Cloth>());
        let mut before = bound(&app).to_vec();
        // A step of this cloth is split, and each part binds: look at every part.
        for _ in 0..600 {
            app.world_mut().run_schedule(DyeStep);
            let free = concentration(&app);
            for (i, after) in bound(&app).iter().enumerate() {
                assert!(*after >= before[i], "{isotherm}: dye went back");
                assert!(*after <= v_d[i], "{isotherm}: fibre is overfull");
                // The isotherm held for the free dye before it bound, which is more than is left.
                let gained = after - before[i];
                let phi = free[i] * v_u[i] + gained;
                let limit = spec.isotherm.limit(phi * 1.00001, v_d[i]) + 1e-20;
                assert!(
                    gained == 0.0 || *after <= limit,
                    "{isotherm}: {after} > {limit}"
                );
            }
            before.copy_from_slice(bound(&app));
        }
        assert!(
            before.iter().any(|a| *a > 0.01),
            "{isotherm}: nothing was bound"
        );
    }
}

#[test]
fn fibre_is_never_overfull_and_never_gives_dye_back_between_the_frames_of_the_accelerated_solver() {
    for isotherm in [
        "Partition(k: 0.4)",
        "Freundlich(k: 0.5, b: 0.5)",
        "Freundlich(k: 0.3, b: 0.2)",
        "Langmuir(kl: 20.0)",
        "Saturating(speed: 0.1, most: 0.3)",
    ] {
        let more = format!("adsorption: (rate: 0.2, isotherm: {isotherm})");
        let mut app = dyeing_app(wild_cloth(5, "Accelerated", &more));
        let v_d = Capacities::of(app.world().resource::<Cloth>()).bound;
        let mut before = bound(&app).to_vec();
        for step in (0..=400).step_by(7) {
            go_on(&mut app, step);
            for (i, after) in bound(&app).iter().enumerate() {
                assert!(*after >= before[i], "{isotherm}: dye went back");
                let full = v_d[i] * (1.0 + 1e-6);
                assert!(*after <= full, "{isotherm}: fibre is overfull");
            }
            before.copy_from_slice(bound(&app));
        }
        assert!(
            before.iter().any(|a| *a > 0.01),
            "{isotherm}: nothing was bound"
        );
    }
}

#[test]
fn a_cell_squeezed_shut_neither_holds_nor_passes_dye() {
    let walled = |by: f64| {
        experiment(&format!(
            "(
                title: \"wall\",
                cloth: (size: (Cells(40), Cells(12)), warp: (width: Cells(3), gap: Cells(1))),
                supply: [Hold(shape: Rectangle(size: (Cells(10), Cells(12)), centre: (0.125, 0.5)))],
                resist: Strength(of: Rectangle(size: (Cells(4), Cells(12))), by: {by}),
                process: (duration: Steps(2000)),
            )"
        ))
    };
    // Dye is held in the left quarter; the wall stands in the middle.
    let reached = |by: f64| {
        let app = dyed(walled(by), 2000);
        let cloth = app.world().resource::<Cloth>();
        let c = concentration(&app);
        let (mut inside, mut behind) = (0.0_f64, 0.0_f64);
        for layer in Layer::BOTH {
            for y in 0..12 {
                for x in 18..40 {
                    let i = cloth.grid.index(layer, y, x);
                    let phi = f64::from(c[i] * cloth.capacity_free(layer, y, x));
                    *(if x < 22 { &mut inside } else { &mut behind }) += phi;
                }
            }
        }
        (inside, behind)
    };
    assert_eq!(reached(1.0), (0.0, 0.0));
    let mut last = f64::INFINITY;
    for by in [0.0, 0.5, 0.9, 0.99, 0.999, 0.99999] {
        let (inside, behind) = reached(by);
        assert!(inside + behind < last, "more resist let more dye in");
        last = inside + behind;
    }
    assert!(last < 0.01, "an all but shut wall let {last} through");
}

#[test]
fn a_hold_keeps_its_dose_to_its_end_and_takes_back_what_is_too_much() {
    let mut app = dyeing_app(experiment(
        "(
            title: \"two holds\",
            cloth: (size: (Cells(30), Cells(30)), warp: (gap: Cells(0))),
            supply: [
                Dose(shape: Everywhere, dose: 1.0),
                Hold(shape: Disc(diameter: Cells(8)), dose: 0.25, until: Steps(100)),
            ],
            process: (duration: Steps(200)),
        )",
    ));
    let middle = app
        .world()
        .resource::<Cloth>()
        .grid
        .index(Layer::Warp, 15, 15);
    for step in [0, 1, 50, 99, 100] {
        go_on(&mut app, step);
        assert_eq!(concentration(&app)[middle], 0.25);
    }
    let removed = ledger(&app).removed;
    assert!(
        removed > 0.0,
        "dye that flowed into the weaker hold was not booked as removed"
    );
    go_on(&mut app, 200);
    assert!(
        concentration(&app)[middle] > 0.5,
        "the hold went on after its end"
    );
    assert_balanced("two holds", &ledger(&app));
}

#[test]
fn where_holds_overlap_only_the_one_that_counts_supplies() {
    let mut app = dyeing_app(experiment(
        "(
            title: \"one hold over another\",
            cloth: (size: (Cells(4), Cells(4)), warp: (gap: Cells(0))),
            supply: [
                Hold(shape: Everywhere, dose: 0.2, until: Steps(10)),
                Hold(shape: Everywhere, dose: 1.0, until: Steps(10)),
            ],
            process: (duration: Steps(20)),
        )",
    ));
    for step in 0..=20 {
        go_on(&mut app, step);
        let ledger = ledger(&app);
        assert_eq!(
            (ledger.supplied, ledger.removed),
            (16.0, 0.0),
            "step {step}"
        );
    }
}

#[test]
fn a_second_dose_never_takes_dye_away() {
    let mut app = dyeing_app(experiment(
        "(
            title: \"two doses\",
            cloth: (size: (Cells(20), Cells(20))),
            supply: [
                Dose(shape: Everywhere, dose: 0.8),
                Dose(shape: Everywhere, dose: 0.3, at: Steps(10)),
            ],
            process: (duration: Steps(20)),
        )",
    ));
    go_on(&mut app, 20);
    assert!(concentration(&app).iter().all(|c| (c - 0.8).abs() < 1e-6));
    assert_eq!(ledger(&app).removed, 0.0);
}
