//! What may be written, what is refused, and that nothing that may be written ends in nonsense.

use dyelapse::drape::drape::Integrator;
use dyelapse::drape::material::{Material, MaterialSpec};
use dyelapse::drape::scenes::{names, parse, text};
use dyelapse::drape::spec::{ColliderSpec, DrapeSpec, Start};
use dyelapse::scenario::check::Checker;
use proptest::prelude::*;

use super::{advance, drape};

#[test]
fn every_bundled_drape_can_be_read_and_written_back() {
    for name in names() {
        let spec = parse(text(name).expect("it is bundled")).expect(name);
        let written = ron::to_string(&spec).expect(name);
        assert_eq!(parse(&written).expect(name), spec);
    }
    assert_eq!(text("carpet"), None);
}

#[test]
fn a_value_that_is_not_possible_is_named() {
    for (bad, path) in [
        ("particles: (1, 9)", "particles[0]"),
        ("particles: (9, 40)", "particles"),
        ("size_m: (0, 1)", "size_m[0]"),
        ("material: Measured((weight: -1))", "material.weight"),
        (
            "material: Measured((bending: (1, 1e9)))",
            "material.bending[1]",
        ),
        ("pins: [(at: Point(2, 0))]", "pins[0].at[0]"),
        (
            "pins: [(at: All, path: [(1, (0, 0, 0)), (1, (0, 0, 0))])]",
            "pins[0].path[1][0]",
        ),
        (
            "on: [Floor(), Ball(centre_m: (0, 0, 0), radius_m: 0)]",
            "on[1].radius_m",
        ),
        (
            "on: [Mesh(corners_m: [(0, 0, 0)], triangles: [(0, 0, 3)])]",
            "on[0].triangles[0][2]",
        ),
        (
            "on: [Mesh(corners_m: [(0, 0, 0)], triangles: [])]",
            "on[0].triangles",
        ),
        ("wind: (velocity: (0, 999, 0))", "wind.velocity[1]"),
        ("creases: [(from: (0, 0), to: (0, 0))]", "creases[0].to"),
        (
            "creases: [(from: (0, 0), to: (1, 1), angle: 179)]",
            "creases[0].angle",
        ),
        ("settle_s: -1", "settle_s"),
        ("solver: (step_s: 0)", "solver.step_s"),
        ("solver: (apart_mm: 1e3)", "solver.apart_mm"),
        ("on: [Ball(centre_m: (0, 1, 0), radius_m: 0.1)]", "start"),
    ] {
        let text = format!("(start: Flat(centre_m: (0, 1, 0)), {bad})");
        let spec = parse(&text).unwrap_or_else(|e| panic!("{e} in {text}"));
        let Err(problem) = spec.build((0.5, 0.5), 0, &Checker::root()) else {
            panic!("{bad} is possible");
        };
        assert_eq!(problem.path, path, "{bad}: {problem}");
    }
}

#[test]
fn a_word_that_is_not_known_is_named() {
    for bad in [
        "colour: 3",
        "solver: (stepp: 1)",
        "material: Velvet",
        "pins: [(where: All)]",
    ] {
        let text = format!("(start: Flat(centre_m: (0, 1, 0)), {bad})");
        let error = parse(&text).expect_err(bad).to_string();
        let word = bad
            .split(['(', ':', '['])
            .find(|w| text.contains(*w))
            .unwrap_or_default();
        assert!(
            error.contains("expected") || error.contains("Unexpected") || error.contains(word),
            "{error}"
        );
    }
}

#[test]
fn stiff_cloth_dropped_from_a_hundred_metres_with_steps_of_a_second_holds_or_says_why_not() {
    for integrator in ["Euler", "RungeKutta", "BackwardEuler", "Bdf2"] {
        let mut cloth = drape(&format!(
            "(particles: (6, 6), size_m: (0.2, 0.2), start: Flat(centre_m: (0, 100, 0)), on: [Floor()],
              material: Measured((stretch: (1e9, 1e9), shear: 1e9, bending: (10, 10))),
              solver: (integrator: {integrator}, step_s: 1))"
        ));
        let mut failed = None;
        for _ in 0..20 {
            if let Err(error) = cloth.advance(1.0) {
                failed = Some(error.to_string());
                break;
            }
        }
        assert!(
            cloth.positions().iter().all(|x| x.is_finite()),
            "{integrator}"
        );
        match (integrator, failed) {
            ("Euler" | "RungeKutta", Some(error)) => {
                assert!(
                    error.contains("flew apart") && error.contains("Bdf2"),
                    "{error}"
                );
            }
            ("Euler" | "RungeKutta", None) => {}
            (_, failed) => {
                assert_eq!(failed, None, "{integrator}");
                let highest = cloth.positions().iter().map(|x| x.y).fold(0.0, f64::max);
                assert!(highest < 100.0, "it falls, if slowly: {highest}");
                assert!(cloth.positions().iter().all(|x| x.y >= 0.0));
            }
        }
    }
}

/// A power of ten.
fn any_size(range: std::ops::Range<f64>) -> impl Strategy<Value = f64> {
    range.prop_map(|exponent| 10_f64.powf(exponent))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn whatever_is_let_through_moves_without_nonsense(
        weight in any_size(-2.0..6.0),
        stretch in any_size(-3.0..13.0),
        shear in any_size(-3.0..13.0),
        bending in any_size(-12.0..4.0),
        damping in any_size(-9.0..2.0),
        step in any_size(-4.0..0.5),
        size in any_size(-3.0..2.5),
        height in -1.0..1e4_f64,
        implicit in any::<bool>(),
    ) {
        let mut spec: DrapeSpec = parse("(start: Flat(centre_m: (0, 1, 0)), particles: (5, 5))").expect("it is a drape");
        spec.size_m = Some((size, size));
        spec.start = Start::Flat { centre_m: (0.0, height, 0.0), turn: 10.0 };
        spec.material = Material::Measured(MaterialSpec {
            weight,
            stretch: (stretch, stretch),
            shear,
            bending: (bending, 0.1 * bending),
            damping,
            ..MaterialSpec::default()
        });
        spec.on = vec![
            ColliderSpec::Ball { centre_m: (0.0, height - 0.2, 0.0), radius_m: 0.15 },
            ColliderSpec::Floor { height_m: 0.0 },
        ];
        spec.solver.step_s = step;
        spec.solver.integrator = if implicit { Integrator::Bdf2 } else { Integrator::Euler };
        if let Ok(mut cloth) = spec.build((1.0, 1.0), 3, &Checker::root()) {
            // An error is an answer too.
            let _ = cloth.advance(10.0 * step);
            prop_assert!(cloth.positions().iter().all(|x| x.is_finite()));
        }
    }
}

#[test]
fn presets_are_possible() {
    for (name, material) in Material::PRESETS {
        let measured = Material::Measured(material.measured());
        assert_eq!(measured.check(&Checker::root()), Ok(()), "{name}");
    }
    let mut cloth = drape("(particles: (9, 9), start: Flat(centre_m: (0, 1, 0)))");
    advance(&mut cloth, 0.1);
}
