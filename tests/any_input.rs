//! Any text that is given as a scenario gives a run or a clean error, and never a panic.

mod common;

use dyelapse::prelude::*;
use dyelapse::scenario::{Origin, bundled};
use proptest::prelude::*;

/// Runs a few steps of what is a scenario and small; tells how it ended.
fn try_out(text: String) -> Result<(), String> {
    let experiment =
        Experiment::parse("any", Origin::Memory, text).map_err(|why| why.to_string())?;
    let (nx, ny) = experiment.scenario.cloth.cells();
    if nx * ny > 10_000 {
        return Ok(());
    }
    let mut app = dyeing_app(experiment);
    for step in [3, 7] {
        assert!(advance_to(app.world_mut(), step, |_| true));
        look(app.world_mut());
    }
    let concentration = &app.world().resource::<FreeDye>().concentration;
    assert!(concentration.iter().all(|c| (0.0..=1.0).contains(c)));
    let ledger = app.world().resource::<Ledger>();
    assert!(
        ledger.imbalance().abs() <= 1e-5 * ledger.supplied + 1e-12,
        "{ledger:?}"
    );
    Ok(())
}

/// A number as a person might write it, rightly or wrongly.
fn number() -> impl Strategy<Value = String> {
    prop_oneof![
        (-3.0..3.0_f64).prop_map(|x| format!("{x}")),
        (0.0..1.0_f64).prop_map(|x| format!("{x}")),
        (-2..50_i64).prop_map(|x| format!("{x}")),
        prop::sample::select(vec![
            "NaN", "inf", "-inf", "1e300", "1e-300", "0", "-0.0", "1_000"
        ])
        .prop_map(str::to_owned),
    ]
}

/// Mostly right, since a scenario has many of them and one wrong one ends it.
fn length() -> impl Strategy<Value = String> {
    let units = prop::sample::select(vec!["Cells", "Mm", "Cm"]);
    prop_oneof![
        40 => (1.0..20.0_f64).prop_map(|n| format!("Cells({n})")),
        10 => (0.05..1.0_f64).prop_map(|n| format!("Mm({n})")),
        1 => (units, number()).prop_map(|(unit, n)| format!("{unit}({n})")),
    ]
}

/// A share from 0 to 1, now and then anything.
fn share() -> impl Strategy<Value = String> {
    prop_oneof![40 => (0.0..=1.0_f64).prop_map(|x| format!("{x}")), 1 => number()]
}

fn pattern() -> impl Strategy<Value = String> {
    let simple = prop_oneof![
        Just("Everywhere".to_owned()),
        Just("Nowhere".to_owned()),
        length().prop_map(|d| format!("Disc(diameter: {d})")),
        (length(), length(), share())
            .prop_map(|(w, g, a)| format!("Stripes(width: {w}, gap: {g}, angle: {a})")),
        (length(), length())
            .prop_map(|(d, p)| format!("Discs(diameter: {d}, pitch: {p}, staggered: true)")),
        (length(), length()).prop_map(|(w, g)| format!("Rings(width: {w}, gap: {g})")),
        (1..9_u32, share()).prop_map(|(n, s)| format!("Rays(count: {n}, share: {s})")),
        (length(), length()).prop_map(|(f, t)| format!("Radial(from: {f}, to: {t})")),
        share().prop_map(|a| format!("Ramp(angle: {a})")),
        (length(), 1..13_u32).prop_map(|(g, o)| format!("Noise(grain: {g}, octaves: {o})")),
        (length(), 1..9_u32, share())
            .prop_map(|(r, n, o)| format!("Seikaiha(radius: {r}, arcs: {n}, open: {o})")),
        (length(), share(), share()).prop_map(|(r, h, x)| {
            format!("Strokes([(radius: {r}, hardness: {h}, path: [({x}, 0.2), (0.5, {x})])])")
        }),
        Just("Strength(of: Everywhere, by: 0.99)".to_owned()),
        Just("Disc(diameter: Cells(9), centre: (0.1, 0.9))".to_owned()),
    ];
    simple.prop_recursive(3, 8, 3, |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..3)
                .prop_map(|l| format!("Union([{}])", l.join(", "))),
            prop::collection::vec(inner.clone(), 0..3)
                .prop_map(|l| format!("Intersection([{}])", l.join(", "))),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("Without(of: {a}, cut: {b})")),
            inner.clone().prop_map(|p| format!("Invert({p})")),
            (inner.clone(), number()).prop_map(|(p, r)| format!("Blur(of: {p}, radius: {r})")),
            (inner, share()).prop_map(|(p, b)| format!("Strength(of: {p}, by: {b})")),
        ]
    })
}

fn weave() -> impl Strategy<Value = String> {
    prop_oneof![
        Just("Plain".to_owned()),
        (1..5_u32, 1..5_u32).prop_map(|(o, u)| format!("Twill(over: {o}, under: {u})")),
        (5..9_u32, 2..4_u32)
            .prop_map(|(n, s)| format!("Satin(shafts: {n}, counter: {s}, face: Warp)")),
        prop::collection::vec("[X.]{3}", 1..4).prop_map(|rows| format!("Matrix({rows:?})")),
        (0..6_usize, any::<bool>()).prop_map(|(i, own)| {
            let names = dyelapse::draft::bundled_names();
            let measures = if own { "Draft" } else { "Yarns" };
            format!(
                "Wif(file: \"{}\", measures: {measures})",
                names[i % names.len()]
            )
        }),
    ]
}

fn kasuri() -> impl Strategy<Value = String> {
    prop_oneof![
        9 => Just(String::new()),
        1 => (pattern(), length(), length()).prop_map(|(p, s, b)| {
            format!("kasuri: (warp: Sections(pattern: {p}, shift: {s}, bleed: {b})),")
        }),
    ]
}

fn appearance() -> impl Strategy<Value = String> {
    let texture = prop_oneof![
        Just("Shaded".to_owned()),
        (share(), share(), 1..9_u32).prop_map(|(h, n, units)| {
            format!("Fractal((roughness: {h}, threshold: {n}, unit_yarns: {units}))")
        }),
        share().prop_map(|blur| format!("Ellipses((blur: {blur}, size: (0.5, {blur})))")),
    ];
    let side = prop_oneof![Just("Face"), Just("Back")];
    (texture, side, 1..4_u32, share()).prop_map(|(texture, side, scale, share)| {
        format!(
            "look: (texture: {texture}, side: {side}, pixels_per_cell: {scale},
               yarn: (unevenness: {share}, hairiness: {share}, lustre: {share}, turn: -3))"
        )
    })
}

/// A batik on a small cloth.
fn batik() -> impl Strategy<Value = String> {
    let cloth = (1..40_u32, 1..40_u32, weave(), length(), length());
    let rest = (
        pattern(),
        share(),
        share(),
        0..3_u32,
        any::<bool>(),
        appearance(),
    );
    (cloth, rest).prop_map(
        |((nx, ny, weave, width, gap), (wax, density, thick, lasts, sweeps, look))| {
            let (solver, more) = match sweeps {
                true => ("PixelDiffusing(reading: Printed)", ""),
                false => ("Diffusion", "adsorption: (isotherm: Langmuir(kl: 20)),"),
            };
            let lasts = lasts + 1;
            format!(
                "(title: \"any\", seed: {nx},
                  cloth: (size: (Cells({nx}), Cells({ny})), weave: {weave}, warp: (width: {width}, gap: {gap})),
                  batik: (solver: {solver}, steps: [
                    Wax(pattern: {wax}, crackle: (density: {density}, folds: {thick}), edge: (reach: {lasts}, drawing: {thick})),
                    Dye(colour: (200, {thick}, 0.5), lasts: Steps({lasts}), rinse: {sweeps}),
                    Wax(pattern: {wax}, crackle: (density: 0.1)),
                    Dye(colour: (20, 0.8, 0.5), lasts: Steps(2)),
                    Boil]),
                  supply: [], {more} process: (duration: Steps({})), {look})",
                lasts + 5
            )
        },
    )
}

fn scenario() -> impl Strategy<Value = String> {
    let cloth = (
        1..40_u32,
        1..40_u32,
        weave(),
        length(),
        length(),
        number(),
        number(),
        kasuri(),
    );
    let rest = (
        pattern(),
        pattern(),
        number(),
        number(),
        number(),
        0..4_usize,
        appearance(),
    );
    (cloth, rest).prop_map(
        |(
            (nx, ny, weave, width, gap, porosity, cell, kasuri),
            (shape, resist, dose, step, phi0, iso, look),
        )| {
            let isotherm = [
                "Partition(k: 2)",
                "Freundlich(k: 0.5, b: 0.3)",
                "Langmuir(kl: 50)",
                "Langmuir(kl: 1e6)",
            ][iso];
            // Most numbers are left at their defaults: else hardly any scenario would be right.
            let one_in = |i: usize, text: String| if (nx as usize + i).is_multiple_of(3) { text } else { String::new() };
            format!(
                "(title: \"any\", seed: {nx},
                  cloth: (size: (Cells({nx}), Cells({ny})), weave: {weave}, {kasuri} {}
                          warp: (width: {width}, gap: {gap}, {} vary_porosity: (0.01, 1))),
                  supply: [Hold(shape: {shape}, {} until: Steps(2)), Dose(shape: Everywhere, dose: 0.1, at: Steps(1))],
                  resist: {resist},
                  dye: ({}),
                  adsorption: (isotherm: {isotherm}),
                  process: (duration: Steps(30), {}), {})",
                one_in(0, format!("cell_mm: {cell},")),
                one_in(1, format!("porosity: {porosity},")),
                one_in(2, format!("dose: {dose},")),
                one_in(3, format!("equilibrium: {phi0}")),
                one_in(4, format!("step_h: {step}")),
                look.replace("side:", "path: Oklch, side:"),
            )
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn scenarios_put_together_at_random_run_or_give_a_clean_error(text in scenario()) {
        let _ = try_out(text);
    }

    #[test]
    fn batiks_put_together_at_random_run_or_give_a_clean_error(text in batik()) {
        let _ = try_out(text);
    }

    #[test]
    fn bundled_scenarios_with_random_bytes_changed_run_or_give_a_clean_error(
        which in 0..100_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<char>()), 1..4),
    ) {
        let all: Vec<_> = bundled().collect();
        let mut text: Vec<char> = all[which % all.len()].text.chars().collect();
        for (place, c) in changes {
            let place = place.index(text.len());
            text[place] = c;
        }
        let text: String = text.into_iter().collect();
        let _ = Experiment::parse("any", Origin::Memory, text);
    }

    #[test]
    fn any_text_at_all_gives_a_clean_error(text in "\\PC{0,200}") {
        prop_assert!(Experiment::parse("any", Origin::Memory, text).is_err());
    }
}

#[test]
fn many_of_the_random_scenarios_do_run() {
    use proptest::strategy::ValueTree;
    use proptest::test_runner::TestRunner;
    let mut runner = TestRunner::deterministic();
    for strategy in [scenario().boxed(), batik().boxed()] {
        let ran = (0..300)
            .filter(|_| try_out(strategy.new_tree(&mut runner).unwrap().current()).is_ok())
            .count();
        assert!(ran > 30, "only {ran} of 300 ran: the generator says little");
    }
}
