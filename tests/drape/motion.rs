//! The cloth in motion: energy, pins, hands, the plugin, and the same cloth each time.

use bevy::math::{DVec2, DVec3};
use bevy::prelude::*;
use dyelapse::drape::drape::Drape;
use dyelapse::drape::lattice::{C_B, K, K_B};
use dyelapse::drape::links::{bend_energy, stretch_energy};
use dyelapse::drape::material::Material;
use dyelapse::drape::plugin::{DrapePlugin, Draped, drape_to};

use super::{advance, assert_whole, drape, furthest};

/// Kinetic energy, that of the links and that of weight, J.
fn energy(cloth: &Drape) -> f64 {
    let links = &cloth.sheet().links;
    let (x, nx) = (cloth.positions(), links.particles.0);
    let mut all = cloth.kinetic_energy();
    for (i, from) in x.iter().enumerate() {
        let at = (i % nx, i / nx);
        all += 9.81 * cloth.sheet().mass.get(at.0, at.1, 0) * from.y;
        for direction in 0..4 {
            let length = links.length(direction);
            let stiffness = |plane: usize| links.stiffness.get(at.0, at.1, plane + direction);
            if let Some((a, b)) = links.other_end(at, direction, 1) {
                all += stretch_energy(from.distance(x[b * nx + a]), length, stiffness(K));
            }
            if let Some((a, b)) = links.other_end(at, direction, 2) {
                let r = from.distance(x[b * nx + a]);
                all += bend_energy(r, 2.0 * length, stiffness(K_B), stiffness(C_B));
            }
        }
    }
    all
}

#[test]
fn energy_does_not_grow_with_any_integrator() {
    for (integrator, step) in [
        ("Euler", 2e-5),
        ("RungeKutta", 2e-4),
        ("BackwardEuler", 2e-3),
        ("Bdf2", 2e-3),
    ] {
        let mut cloth = drape(&format!(
            "(particles: (15, 15), size_m: (0.14, 0.14), start: Flat(centre_m: (0, 0, 0)),
              material: Measured((stretch: (50, 50), shear: 5, damping: 5e-5)),
              pins: [(at: Line((0, 0), (1, 0)), radius_m: 0)],
              solver: (integrator: {integrator}, step_s: {step}, air: false, itself: false,
                       tolerance: 1e-6, iterations: 300))"
        ));
        let begin = energy(&cloth);
        // What falling can set free.
        let weight = 0.13 * 0.14 * 0.14 * 9.81 * 0.07;
        let (mut before, mut moved) = (begin, 0.0_f64);
        for _ in 0..20 {
            advance(&mut cloth, 0.01);
            let now = energy(&cloth);
            assert!(now < before + 2e-3 * weight, "{integrator}: {before} {now}");
            before = now;
            moved = moved.max(cloth.kinetic_energy());
        }
        assert!(moved > 0.05 * weight, "{integrator}: it moved");
        assert!(before < begin);
    }
}

#[test]
fn cloth_that_hangs_at_rest_stays_at_rest() {
    let mut cloth = drape(
        "(particles: (13, 13), size_m: (0.3, 0.3), start: Hanging(top_m: (0, 1, 0)),
          pins: [(at: Line((0, 0), (1, 0)), radius_m: 0)])",
    );
    advance(&mut cloth, 4.0);
    let before = cloth.positions().to_vec();
    advance(&mut cloth, 3.0);
    let moved = furthest(&before, cloth.positions());
    assert!(moved < 3e-4, "{moved}");
}

#[test]
fn a_free_cloth_keeps_its_momentum_while_its_links_work() {
    for integrator in ["RungeKutta", "BackwardEuler", "Bdf2"] {
        let mut cloth = drape(&format!(
            "(particles: (9, 9), size_m: (0.1, 0.1), start: Flat(centre_m: (0, 0, 0)),
              solver: (integrator: {integrator}, step_s: 1e-4, air: false, itself: false,
                       tolerance: 1e-7, iterations: 500))"
        ));
        cloth.settings.gravity = DVec3::ZERO;
        let v: Vec<DVec3> = cloth
            .positions()
            .iter()
            .map(|x| DVec3::new(1.0 + 9.0 * x.z, 5.0 * x.x, -6.0 * x.x + 100.0 * x.x * x.z))
            .collect();
        cloth.set_velocities(&v);
        let momentum = |cloth: &Drape| -> DVec3 {
            let mass = |i: usize| cloth.sheet().mass.get(i % 9, i / 9, 0);
            let each = cloth.velocities().iter().enumerate();
            each.map(|(i, v)| mass(i) * *v).sum()
        };
        let before = momentum(&cloth);
        advance(&mut cloth, 0.02);
        let after = momentum(&cloth);
        let off = (after - before).length() / before.length();
        assert!(off < 1e-3, "{integrator}: {before} {after}");
        assert!(furthest(cloth.velocities(), &v) > 0.1, "its links worked");
    }
}

#[test]
fn landers_cloth_pushes_where_chois_folds() {
    // Two opposite edges come together: Choi's cloth gives way, Lander's springs press back hard.
    use dyelapse::drape::lattice::{Links, Model};
    use dyelapse::drape::response::Response;
    use dyelapse::drape::rows::Rows;
    let push = |model: Model| {
        let links = Links::uniform(model, (9, 9), (0.01, 0.01), [100.0, 1e-6, 100.0, 0.0]);
        let (mut x, mut force) = (Rows::zero(9, 9, 3), Rows::zero(9, 9, 3));
        for i in 0..81_usize {
            x.set_particle(
                i,
                DVec3::new(0.007 * (i % 9) as f64, 0.01 * (i / 9) as f64, 0.0),
            );
        }
        let mut response = Response::new((9, 9));
        response.compute(&links, &x, &Rows::zero(9, 9, 3), None);
        response.add_forces(&mut force);
        -(0..9).map(|y| force.vector(0, y).x).sum::<f64>()
    };
    let (choi, lander) = (push(Model::Choi), push(Model::Lander));
    println!("pressed together by 30 %: Choi pushes with {choi:.3} N, Lander with {lander:.3} N");
    assert!(choi > 0.0 && lander > 5.0 * choi, "{choi} {lander}");
}

#[test]
fn pins_lead_where_they_are_told_and_let_go() {
    let mut cloth = drape(
        "(particles: (9, 9), size_m: (0.2, 0.2), start: Hanging(top_m: (0, 1, 0)),
          pins: [(at: Point(0, 0), radius_m: 0, path: [(1, (0.05, 0.02, 0.1)), (2, (0, 0, 0))]),
                 (at: Point(1, 0), radius_m: 0, until_s: 0.5)])",
    );
    let begin = [cloth.positions()[0], cloth.positions()[8]];
    let off = |cloth: &Drape, to: DVec3| cloth.positions()[0].distance(begin[0] + to);
    advance(&mut cloth, 0.5);
    assert!(off(&cloth, 0.5 * DVec3::new(0.05, 0.02, 0.1)) < 1e-9);
    assert!(cloth.positions()[8].distance(begin[1]) < 1e-9);
    advance(&mut cloth, 0.5);
    assert!(off(&cloth, DVec3::new(0.05, 0.02, 0.1)) < 1e-9);
    assert!(cloth.positions()[8].distance(begin[1]) > 0.05, "let go");
    advance(&mut cloth, 2.0);
    assert!(
        off(&cloth, DVec3::ZERO) < 1e-9,
        "it stays after the last stop"
    );
}

/// A cloth that meets a ball and itself, in wind.
const LIVELY: &str = "(particles: (33, 33), size_m: (0.4, 0.4), material: SilkHabotai,
    start: Flat(centre_m: (0.03, 0.35, 0)), wind: (velocity: (1, 0, 0.5)),
    on: [Ball(centre_m: (0, 0.2, 0), radius_m: 0.1), Floor()],
    creases: [(from: (0, 0.2), to: (1, 0.7))])";

#[test]
fn the_same_cloth_moves_the_same_on_any_number_of_threads() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads").install(|| {
            let mut cloth = drape(LIVELY);
            advance(&mut cloth, 0.7);
            cloth.positions().to_vec()
        })
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one, on(1));
}

#[test]
fn a_snapshot_leads_back_to_the_same_future() {
    let mut cloth = drape(LIVELY);
    advance(&mut cloth, 0.4);
    let then = cloth.snapshot();
    advance(&mut cloth, 0.3);
    let future = cloth.positions().to_vec();
    cloth.add_crease(DVec2::ZERO, DVec2::ONE, 1.0, 1e-3);
    cloth.pin(5);
    cloth.restore(&then);
    advance(&mut cloth, 0.3);
    assert_eq!(future, cloth.positions());
}

#[test]
fn the_plugin_follows_its_clock() {
    let mut app = App::new();
    app.add_plugins(DrapePlugin);
    assert_eq!(
        drape_to(app.world_mut(), 1.0),
        Ok(()),
        "no cloth is no mistake"
    );
    app.insert_resource(Draped::new(drape(LIVELY)));
    assert_eq!(drape_to(app.world_mut(), 0.3), Ok(()));
    assert_eq!(
        drape_to(app.world_mut(), 0.1),
        Ok(()),
        "the past asks for nothing"
    );
    let mut alone = drape(LIVELY);
    advance(&mut alone, 0.3);
    let draped = app.world().resource::<Draped>();
    assert!((draped.time() - 0.3).abs() < 1e-9);
    assert_eq!(draped.drape.positions(), alone.positions());
}

#[test]
fn a_hand_draws_the_cloth_and_a_ray_finds_it() {
    let mut app = App::new();
    app.add_plugins(DrapePlugin)
        .insert_resource(Draped::new(drape(
            "(particles: (17, 17), size_m: (0.2, 0.2), start: Hanging(top_m: (0, 1, 0)),
          pins: [(at: Line((0, 0), (1, 0)), radius_m: 0)])",
        )));
    drape_to(app.world_mut(), 1.0).expect("it holds together");
    let mut draped = app.world_mut().resource_mut::<Draped>();
    let hit = draped
        .hit(DVec3::new(0.03, 0.86, 1.0), DVec3::NEG_Z)
        .expect("the cloth is there");
    assert!(
        (hit.uv - DVec2::new(0.65, 0.7)).length() < 0.01,
        "{}",
        hit.uv
    );
    assert!((hit.point.z - (1.0 - hit.distance)).abs() < 1e-12);
    assert!(
        draped
            .hit(DVec3::new(0.3, 0.86, 1.0), DVec3::NEG_Z)
            .is_none()
    );
    let target = hit.point + DVec3::new(0.0, 0.02, 0.06);
    draped.hold(hit.particle, target);
    draped.hold(1_000_000, target);
    drape_to(app.world_mut(), 2.0).expect("it holds together");
    let mut draped = app.world_mut().resource_mut::<Draped>();
    let held = draped.drape.positions()[hit.particle];
    assert!(held.distance(target) < 0.01, "{held} {target}");
    draped.let_go(hit.particle);
    draped.pin(200);
    let fixed = draped.drape.positions()[200];
    drape_to(app.world_mut(), 4.0).expect("it holds together");
    let mut draped = app.world_mut().resource_mut::<Draped>();
    assert!(
        draped.drape.positions()[hit.particle].distance(target) > 0.02,
        "let go"
    );
    assert!(draped.drape.positions()[200].distance(fixed) < 1e-9);
    draped.unpin(200);
    assert_whole(&draped.drape, "held");
}

#[test]
fn another_material_takes_over_while_the_cloth_moves() {
    let mut cloth = drape(
        "(particles: (17, 9), size_m: (0.1, 0.05), start: Flat(centre_m: (0, 1, 0)), material: SilkHabotai,
          pins: [(at: Line((0, 0), (0, 1)), radius_m: 0.007)])",
    );
    advance(&mut cloth, 2.0);
    let end = |cloth: &Drape| cloth.positions()[16].x;
    let silk = end(&cloth);
    cloth.set_material(&Material::Denim.measured());
    advance(&mut cloth, 2.0);
    let denim = end(&cloth);
    assert!(
        denim > silk + 0.002,
        "denim stands out further: {silk} {denim}"
    );
}
