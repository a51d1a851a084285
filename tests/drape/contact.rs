//! Nothing passes through anything, and what rests stays.

use bevy::math::DVec3;
use dyelapse::drape::collide::colliders::Exact;
use dyelapse::drape::drape::Drape;

use super::{advance, assert_whole, drape, furthest};

#[test]
fn cloth_at_rest_on_a_table_stays_where_it_is() {
    let mut cloth = drape(
        "(particles: (17, 17), size_m: (0.3, 0.3), start: Flat(centre_m: (0, 0.502, 0), turn: 20),
          on: [SquareTable(centre_m: (0, 0.5, 0), size_m: (0.5, 0.5))])",
    );
    advance(&mut cloth, 2.0);
    let before = cloth.positions().to_vec();
    advance(&mut cloth, 3.0);
    assert!(furthest(&before, cloth.positions()) < 1e-5);
    assert_whole(&cloth, "on a table");
}

#[test]
fn cloth_at_rest_that_hangs_over_an_edge_is_held_by_friction() {
    let on_edge = |friction: f64| {
        let mut cloth = drape(&format!(
            "(particles: (25, 9), size_m: (0.3, 0.1), start: Flat(centre_m: (0.05, 0.502, 0)),
              material: Measured((friction: {friction})),
              on: [SquareTable(centre_m: (-0.2, 0.5, 0), size_m: (0.5, 0.5))])"
        ));
        advance(&mut cloth, 3.0);
        let before = cloth.positions().to_vec();
        advance(&mut cloth, 2.0);
        furthest(&before, cloth.positions())
    };
    // 0.15 m lie on the table, as much hangs: μ = 1.2 is enough, μ = 0.05 is not.
    let (rough, slippery) = (on_edge(1.2), on_edge(0.05));
    assert!(rough < 1e-4, "{rough}");
    assert!(slippery > 0.1, "{slippery}");
}

#[test]
fn cloth_on_a_slope_slides_as_coulomb_says() {
    // A slope of 30°: tan 30° = 0.577.
    let (sin, cos) = (0.5, 0.75_f64.sqrt());
    let cloth = |friction: f64| {
        let mut cloth = drape(&format!(
            "(particles: (9, 9), size_m: (0.1, 0.1), start: Flat(centre_m: (0, 0.002, 0)),
              material: Measured((friction: {friction}, bending: (1e-4, 1e-4))),
              on: [SquareTable(centre_m: (0, 0, 0), size_m: (20, 20))],
              solver: (air: false, itself: false))"
        ));
        advance(&mut cloth, 0.5);
        cloth.settings.gravity = 9.81 * DVec3::new(sin, -cos, 0.0);
        cloth
    };
    let mut rough = cloth(0.65);
    let before = rough.positions().to_vec();
    advance(&mut rough, 1.0);
    assert!(furthest(&before, rough.positions()) < 1e-4);
    let mut smooth = cloth(0.3);
    let speed = |cloth: &Drape| cloth.velocities()[40].x;
    advance(&mut smooth, 0.3);
    let before = speed(&smooth);
    advance(&mut smooth, 0.3);
    let found = (speed(&smooth) - before) / 0.3;
    let expected = 9.81 * (sin - 0.3 * cos);
    println!("slides at {found:.3} m/s², Coulomb's {expected:.3}");
    assert!((found / expected - 1.0).abs() < 0.05, "{found} {expected}");
}

#[test]
fn cloth_folded_onto_itself_does_not_pass() {
    // One edge is carried over the rest of the cloth and through where it lies.
    let mut cloth = drape(
        "(particles: (25, 25), size_m: (0.3, 0.3), material: CottonLawn,
          start: Flat(centre_m: (0, 0.002, 0)), on: [Floor()],
          pins: [(at: Point(0, 0), path: [(0.3, (0.02, 0.15, 0.02)), (0.6, (0.2, 0.1, 0.2)), (0.8, (0.25, 0.006, 0.25))], until_s: 1.0)])",
    );
    for _ in 0..30 {
        advance(&mut cloth, 1.0 / 15.0);
        assert_whole(&cloth, "a folded corner");
    }
    let corner = cloth.positions()[0];
    assert!(
        corner.x > 0.0 && corner.z > 0.0,
        "it was folded over: {corner}"
    );
}

/// A cloth whose particles all fly at `velocity`.
fn thrown(text: &str, velocity: DVec3) -> Drape {
    let mut cloth = drape(text);
    let all = vec![velocity; cloth.positions().len()];
    cloth.set_velocities(&all);
    cloth
}

#[test]
fn fast_cloth_does_not_pass_through_a_ball_or_a_thin_table() {
    for (what, on) in [
        ("ball", "Ball(centre_m: (0, 0, 0), radius_m: 0.05)"),
        (
            "table",
            "SquareTable(centre_m: (0, 0.02, 0), size_m: (0.1, 0.1), thickness_m: 0.002, edge_m: 0)",
        ),
        (
            "mesh",
            "Mesh(corners_m: [(0, 0.05, 0), (0.05, 0, 0.05), (-0.05, 0, 0.04), (0, 0, -0.06)],
                       triangles: [(0, 2, 1), (0, 3, 2), (0, 1, 3), (1, 2, 3)])",
        ),
    ] {
        let text = format!(
            "(particles: (17, 17), size_m: (0.2, 0.2), material: CottonLawn,
              start: Flat(centre_m: (0.01, 0.2, 0)), on: [{on}])"
        );
        for speed in [2.0, 20.0, 100.0] {
            let mut cloth = thrown(&text, DVec3::new(0.0, -speed, 0.0));
            for _ in 0..15 {
                advance(&mut cloth, 1.0 / 60.0);
                assert_whole(&cloth, what);
            }
        }
    }
}

#[test]
fn cloth_thrown_at_itself_does_not_pass() {
    // The halves of a hanging strip are thrown at each other.
    for speed in [3.0, 30.0] {
        let mut cloth = drape(
            "(particles: (33, 9), size_m: (0.4, 0.1), material: SilkHabotai,
              start: Flat(centre_m: (0, 1, 0)), pins: [(at: Line((0.5, 0), (0.5, 1)), radius_m: 0)])",
        );
        let (mut v, nx) = (vec![DVec3::ZERO; cloth.positions().len()], 33);
        for (i, v) in v.iter_mut().enumerate() {
            let side = (i % nx) as f64 - 16.0;
            *v = DVec3::new(-0.3 * speed * side / 16.0, -speed * side.abs() / 16.0, 0.0);
        }
        cloth.set_velocities(&v);
        let mut met = 0;
        for _ in 0..30 {
            let report = cloth.advance(1.0 / 60.0).expect("it holds together");
            met += report.map_or(0, |r| r.pairs);
            assert_whole(&cloth, "thrown at itself");
        }
        assert!(met > 0, "it met itself");
    }
}

#[test]
fn cloth_dropped_on_itself_piles_up() {
    let mut cloth = drape(
        "(particles: (13, 49), size_m: (0.06, 0.24), material: CottonLawn,
          start: Hanging(top_m: (0, 0.26, 0)), on: [Floor()])",
    );
    advance(&mut cloth, 2.0);
    assert_whole(&cloth, "dropped on edge");
    let top = cloth.positions().iter().map(|x| x.y).fold(0.0, f64::max);
    assert!(top < 0.12, "it fell over: {top}");
}

#[test]
fn without_itself_cloth_still_keeps_off_everything_else() {
    let mut cloth = drape(
        "(particles: (17, 17), size_m: (0.3, 0.3), start: Flat(centre_m: (0, 0.3, 0)),
          on: [Ball(centre_m: (0, 0.15, 0), radius_m: 0.1), Floor()], solver: (itself: false))",
    );
    advance(&mut cloth, 2.0);
    let [Exact::Ball { centre, radius }, Exact::Floor(height)] = cloth.colliders().exact[..] else {
        panic!("a ball and a floor");
    };
    for x in cloth.positions() {
        assert!(x.distance(centre) > radius && x.y > height);
    }
}
