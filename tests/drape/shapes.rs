//! The shapes of cloth at rest, against curves computed independently, and the drape coefficient.

use bevy::math::DVec3;
use dyelapse::drape::drape::Drape;

use super::{advance, drape};

/// The middle row of a strip.
fn middle_row(drape: &Drape) -> Vec<DVec3> {
    let (nx, ny) = drape.sheet().links.particles;
    drape.positions()[ny / 2 * nx..][..nx].to_vec()
}

#[test]
fn a_strip_held_at_both_ends_hangs_in_a_catenary() {
    let mut strip = drape(
        "(particles: (65, 3), size_m: (0.4, 0.0125), start: Flat(centre_m: (0, 1, 0)),
          material: Measured((weight: 130, bending: (1e-9, 1e-9), stretch: (3000, 3000))),
          pins: [(at: Line((0, 0), (0, 1)), radius_m: 0, path: [(1, (0.06, 0, 0))]),
                 (at: Line((1, 0), (1, 1)), radius_m: 0, path: [(1, (-0.06, 0, 0))])],
          solver: (integrator: BackwardEuler, step_s: 0.01, itself: false, tolerance: 1e-5, iterations: 200))",
    );
    advance(&mut strip, 8.0);
    // 2a·sinh(d/2a) = length.
    let (length, d) = (0.4_f64, 0.28_f64);
    let (mut low, mut high) = (0.01_f64, 10.0_f64);
    for _ in 0..100 {
        let a: f64 = 0.5 * (low + high);
        if 2.0 * a * (d / (2.0 * a)).sinh() > length {
            low = a;
        } else {
            high = a;
        }
    }
    let catenary = |x: f64| low * ((x / low).cosh() - (0.5 * d / low).cosh());
    let sag = -catenary(0.0);
    let worst = middle_row(&strip)
        .iter()
        .map(|p| (p.y - 1.0 - catenary(p.x)).abs())
        .fold(0.0, f64::max);
    println!("catenary: off by {:.3} % of the sag", 100.0 * worst / sag);
    assert!(sag > 0.1 && worst < 0.02 * sag, "{worst} of {sag}");
}

/// Drop and reach of the end of a heavy elastic strip of length `length` that leaves a clamp level:
/// B·θ″ = −w·(length − s)·cos θ, θ(0) = 0, θ′(length) = 0, by shooting.
fn elastica(length: f64, weight_over_bending: f64) -> (f64, f64) {
    const STEPS: usize = 4000;
    let h = length / STEPS as f64;
    let shoot = |curvature: f64| {
        let (mut angle, mut turn, mut drop, mut reach) = (0.0_f64, curvature, 0.0, 0.0);
        for i in 0..STEPS {
            let s = (i as f64 + 0.5) * h;
            // The midpoint rule.
            let bend = |angle: f64, s: f64| -weight_over_bending * (length - s) * angle.cos();
            let (angle_half, turn_half) = (
                angle + 0.5 * h * turn,
                turn + 0.5 * h * bend(angle, s - 0.5 * h),
            );
            drop += h * angle_half.sin();
            reach += h * angle_half.cos();
            angle += h * turn_half;
            turn += h * bend(angle_half, s);
        }
        (turn, drop, reach)
    };
    let (mut low, mut high) = (0.0, 0.5 * weight_over_bending * length * length);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if shoot(middle).0 > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    let (_, drop, reach) = shoot(low);
    (drop, reach)
}

#[test]
fn a_strip_held_at_one_end_bends_as_the_elastica() {
    for bending in [1e-5, 2e-5] {
        let mut strip = drape(&format!(
            "(particles: (17, 5), size_m: (0.1, 0.025), start: Flat(centre_m: (0, 1, 0)),
              material: Measured((weight: 130, bending: ({bending}, {bending}), stretch: (1e5, 1e5), damping: 0)),
              pins: [(at: Line((0, 0), (0, 1)), radius_m: 0.0063)],
              solver: (integrator: BackwardEuler, step_s: 0.005, itself: false, uneven_mm: 0,
                       tolerance: 1e-5, iterations: 400))"
        ));
        advance(&mut strip, 5.0);
        let row = middle_row(&strip);
        // Two columns are held; the cloth bends from halfway between them on.
        let half = 0.5 * 0.1 / 16.0;
        let length = 0.1 - half;
        let (drop, reach) = elastica(length, 0.13 * 9.81 / bending);
        let end = row[16] - DVec3::new(half - 0.05, 1.0, 0.0);
        let off = (end.x - reach).hypot(end.y + drop) / length;
        println!(
            "elastica, B = {bending}: its end is off by {:.2} % of its length",
            100.0 * off
        );
        assert!(off < 0.02, "{end} {drop} {reach}");
    }
}

/// The drape coefficient, %: Cusick's disc of radius 9 cm under cloth of radius 15 cm.
fn drape_coefficient(material: &str, particles: usize) -> f64 {
    let mut cloth = drape(&format!(
        "(particles: ({particles}, {particles}), size_m: (0.3, 0.3), outline: Ellipse, material: {material},
          start: Flat(centre_m: (0, 0.3015, 0)),
          on: [RoundTable(centre_m: (0, 0.3, 0), radius_m: 0.09, thickness_m: 0.01, edge_m: 0.002)])"
    ));
    advance(&mut cloth, 3.0);
    let surface = cloth.surface();
    // The shadow on a screen of 1 mm squares.
    const ACROSS: i32 = 160;
    let mut shadow = vec![false; (2 * ACROSS as usize).pow(2)];
    for t in &surface.triangles {
        let [a, b, c] = t.map(|i| 1000.0 * surface.positions[i as usize]);
        let low = a.min(b).min(c).floor();
        let high = a.max(b).max(c).ceil();
        for z in low.z as i32..=high.z as i32 {
            for x in low.x as i32..=high.x as i32 {
                let (px, pz) = (f64::from(x) + 0.5, f64::from(z) + 0.5);
                let side = |p: DVec3, q: DVec3| (q.x - p.x) * (pz - p.z) - (q.z - p.z) * (px - p.x);
                let sides = [side(a, b), side(b, c), side(c, a)];
                let inside = sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0);
                if inside && x.abs() < ACROSS && z.abs() < ACROSS {
                    shadow[((z + ACROSS) * 2 * ACROSS + x + ACROSS) as usize] = true;
                }
            }
        }
    }
    // What the disc itself shades.
    let disc = std::f64::consts::PI * 90.0 * 90.0;
    let whole = std::f64::consts::PI * 150.0 * 150.0;
    let area = shadow.iter().filter(|s| **s).count() as f64;
    100.0 * (area - disc) / (whole - disc)
}

#[test]
fn the_drape_coefficient_falls_with_bending_stiffness_over_weight() {
    let cloth = |weight: f64, bending: f64| {
        format!(
            "Measured((weight: {weight}, bending: ({bending}, {bending}), stretch: (2500, 2500), shear: 40))"
        )
    };
    let series = [
        (130.0, 1e-4),
        (130.0, 3e-5),
        (130.0, 1e-5),
        (130.0, 3e-6),
        (260.0, 3e-6),
    ];
    let all = series.map(|(weight, bending)| drape_coefficient(&cloth(weight, bending), 33));
    println!("drape coefficients as B/weight falls: {all:.1?} %");
    for pair in all.windows(2) {
        assert!(pair[1] < pair[0], "{all:?}");
    }
    assert!(all[0] > 60.0 && all[4] < 40.0, "{all:?}");
}

#[test]
fn the_drape_coefficient_does_not_depend_on_the_mesh() {
    for material in ["Denim", "Wool"] {
        let [coarse, fine] = [33, 65].map(|n| drape_coefficient(material, n));
        println!(
            "drape coefficient of {material}: {coarse:.1} % at 33 × 33, {fine:.1} % at 65 × 65"
        );
        assert!((coarse - fine).abs() < 5.0, "{coarse} {fine}");
    }
}
