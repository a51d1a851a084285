//! The laws of single links, and what holds of all of them together.

use bevy::math::{DVec2, DVec3};
use dyelapse::chance::{Chance, Purpose};
use dyelapse::drape::crease::{Crease, press};
use dyelapse::drape::lattice::{Links, Model};
use dyelapse::drape::links::{bend, bend_energy, spring, stretch, stretch_energy};
use dyelapse::drape::response::Response;
use dyelapse::drape::rows::Rows;

const LENGTH: f64 = 0.02;
const K_B: f64 = 3e-6;

/// u with sin u / u = ratio, by halving an interval.
fn inverse_sinc(ratio: f64) -> f64 {
    let (mut low, mut high) = (1e-9, std::f64::consts::PI);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle.sin() / middle > ratio {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Paper C's f_b and df_b/dr, as model section 8 has them.
fn paper(r: f64) -> (f64, f64) {
    let u = inverse_sinc(r / LENGTH);
    let d = u.cos() - u.sin() / u;
    let force = 4.0 * K_B / LENGTH.powi(2) * u * u / d;
    let slope = 4.0 * K_B / LENGTH.powi(3) * u * u * (3.0 * d + u * u.sin()) / d.powi(3);
    (force, slope)
}

/// A spring too stiff to matter before the link buckles.
const STIFF: f64 = 1e12;

#[test]
fn a_type_2_link_pushes_as_the_paper_says() {
    for i in 1..1000 {
        let r = LENGTH * f64::from(i) / 1000.0;
        let (force, slope) = paper(r);
        let pull = bend(r, LENGTH, K_B, STIFF);
        assert!(
            (pull.force / force - 1.0).abs() < 1e-9,
            "r = {r}: {} {force}",
            pull.force
        );
        assert!(
            (pull.stiffness / slope - 1.0).abs() < 1e-7,
            "r = {r}: {} {slope}",
            pull.stiffness
        );
    }
}

#[test]
fn a_type_2_link_that_is_almost_straight_pushes_as_eulers_column() {
    for z in [1e-6, 1e-9, 1e-12] {
        let pull = bend(LENGTH * (1.0 - z), LENGTH, K_B, 1e30);
        let (force, slope) = (-12.0 * K_B / LENGTH.powi(2), 7.2 * K_B / LENGTH.powi(3));
        assert!(
            (pull.force / force - 1.0).abs() < 1e-5,
            "{} {force}",
            pull.force
        );
        assert!(
            (pull.stiffness / slope - 1.0).abs() < 1e-4,
            "{} {slope}",
            pull.stiffness
        );
    }
    assert_eq!(bend(LENGTH, LENGTH, K_B, STIFF).force, 0.0);
    assert_eq!(bend(1.1 * LENGTH, LENGTH, K_B, STIFF).force, 0.0);
}

#[test]
fn a_type_2_link_is_a_spring_until_it_buckles() {
    let c_b = 20.0;
    let (mut springs, mut arcs) = (0, 0);
    for i in 1..2000 {
        let r = LENGTH * f64::from(i) / 2000.0;
        let (of_arc, of_spring) = (paper(r).0, c_b * (r - LENGTH));
        let expected = of_arc.max(of_spring);
        let pull = bend(r, LENGTH, K_B, c_b);
        assert!(
            (pull.force - expected).abs() < 1e-6 * expected.abs(),
            "r = {r}"
        );
        if of_spring > of_arc {
            springs += 1;
            assert_eq!(pull.stiffness, c_b);
        } else {
            arcs += 1;
        }
    }
    assert!(springs > 10 && arcs > 10, "{springs} {arcs}");
}

#[test]
fn stiffness_is_the_slope_of_the_force_and_force_that_of_the_energy() {
    for c_b in [STIFF, 20.0] {
        for i in 1..200 {
            // Off the place where it buckles, at which there is no slope.
            let r = LENGTH * (f64::from(i) + 0.37) / 201.0;
            let step = 1e-5 * LENGTH;
            let between = |f: &dyn Fn(f64) -> f64| (f(r + step) - f(r - step)) / (2.0 * step);
            let pull = bend(r, LENGTH, K_B, c_b);
            let slope = between(&|r| bend(r, LENGTH, K_B, c_b).force);
            let force = between(&|r| bend_energy(r, LENGTH, K_B, c_b));
            let scale = pull.stiffness.abs();
            assert!((slope - pull.stiffness).abs() < 1e-4 * scale, "r = {r}");
            assert!(
                (force - pull.force).abs() < 1e-5 * pull.force.abs(),
                "r = {r} {force} {}",
                pull.force
            );
        }
    }
    let (k, r) = (50.0, 1.03 * LENGTH);
    let rise = stretch_energy(r + 1e-7, LENGTH, k) - stretch_energy(r - 1e-7, LENGTH, k);
    assert!((rise / 2e-7 / stretch(r, LENGTH, k).force - 1.0).abs() < 1e-6);
}

#[test]
fn a_type_1_link_pulls_and_never_pushes_where_landers_does_both() {
    assert_eq!(stretch(0.9 * LENGTH, LENGTH, 7.0).force, 0.0);
    assert_eq!(stretch(0.9 * LENGTH, LENGTH, 7.0).stiffness, 0.0);
    assert!(spring(0.9 * LENGTH, LENGTH, 7.0).force < 0.0);
    let long = 1.2 * LENGTH;
    assert_eq!(stretch(long, LENGTH, 7.0), spring(long, LENGTH, 7.0));
    assert!((stretch(long, LENGTH, 7.0).force - 7.0 * 0.2 * LENGTH).abs() < 1e-15);
}

/// A crumpled piece of cloth, 9 × 7, and velocities.
fn crumpled() -> (Rows, Rows) {
    let mut draw = Chance(5).sequence(Purpose::Unevenness);
    let mut any = |size: f64| size * (2.0 * draw.unit() - 1.0);
    let (mut x, mut v) = (Rows::zero(9, 7, 3), Rows::zero(9, 7, 3));
    for i in 0..63_usize {
        let flat = DVec3::new((i % 9) as f64, (i / 9) as f64, 0.0) * 0.01;
        x.set_particle(i, flat + DVec3::new(any(0.006), any(0.006), any(0.006)));
        v.set_particle(i, DVec3::new(any(1.0), any(1.0), any(1.0)));
    }
    (x, v)
}

#[test]
fn links_and_creases_change_neither_momentum_nor_angular_momentum() {
    for model in [Model::Choi, Model::Lander] {
        // Damping by whole velocity differences does turn the cloth.
        let mut links = Links::uniform(model, (9, 7), (0.01, 0.01), [300.0, 1e-6, 100.0, 0.0]);
        let crease = Crease {
            from: DVec2::new(0.0, 0.013),
            to: DVec2::new(0.08, 0.047),
            angle: 1.3,
            stiffness: 1e-3,
        };
        let creases = press(&mut links, &[crease]);
        assert!(!creases.is_empty());
        let (x, v) = crumpled();
        let mut response = Response::new((9, 7));
        response.compute(&links, &x, &v, None);
        let mut force = Rows::zero(9, 7, 3);
        response.add_forces(&mut force);
        for crease in &creases {
            crease.respond(&x, &mut force, &mut response, 0.0);
        }
        let (x, force) = (x.to_vectors(), force.to_vectors());
        let all: f64 = force.iter().map(|f| f.length()).sum();
        let sum: DVec3 = force.iter().sum();
        let torque: DVec3 = x.iter().zip(&force).map(|(x, f)| x.cross(*f)).sum();
        assert!(all > 1.0, "{all}");
        assert!(sum.length() < 1e-12 * all, "{sum}");
        assert!(torque.length() < 1e-12 * all, "{torque}");
    }
}

#[test]
fn damping_changes_no_momentum() {
    let links = Links::uniform(Model::Choi, (9, 7), (0.01, 0.01), [300.0, 1e-6, 100.0, 0.1]);
    let (x, v) = crumpled();
    let mut force = Rows::zero(9, 7, 3);
    let mut response = Response::new((9, 7));
    response.compute(&links, &x, &v, None);
    response.add_forces(&mut force);
    let force = force.to_vectors();
    let sum: DVec3 = force.iter().sum();
    assert!(sum.length() < 1e-12 * force.iter().map(|f| f.length()).sum::<f64>());
}
