//! Creases keep their side, in any direction.

use bevy::math::DVec3;
use dyelapse::drape::drape::Drape;

use super::{advance, assert_whole, drape};

/// A cloth with one crease, floating free.
fn creased(from: (f64, f64), to: (f64, f64), fold: &str) -> Drape {
    let mut cloth = drape(&format!(
        "(particles: (21, 21), size_m: (0.2, 0.2), start: Flat(centre_m: (0, 0, 0)),
          material: Measured((bending: (2e-5, 2e-5))),
          creases: [(from: {from:?}, to: {to:?}, fold: {fold}, angle: 90)])"
    ));
    cloth.settings.gravity = DVec3::ZERO;
    cloth
}

/// By how many degrees the cloth is folded along its crease: positive for a mountain, seen from the front.
fn angle(cloth: &Drape, from: (f64, f64), to: (f64, f64)) -> f64 {
    let surface = cloth.surface();
    let line = DVec3::new(to.0 - from.0, to.1 - from.1, 0.0).normalize();
    // Normals of both sides, a little off the crease, and the way across.
    let (mut sides, mut middles, mut counts) = ([DVec3::ZERO; 2], [DVec3::ZERO; 2], [0.0; 2]);
    for (i, uv) in surface.uv.iter().enumerate() {
        let off = DVec3::new(uv.x - from.0, uv.y - from.1, 0.0);
        let beside = line.cross(off).z;
        let along = line.dot(off);
        if (0.12..0.25).contains(&beside.abs()) && (0.2..0.8).contains(&along) {
            let side = usize::from(beside > 0.0);
            sides[side] += surface.normals[i];
            middles[side] += surface.positions[i];
            counts[side] += 1.0;
        }
    }
    assert!(counts[0] > 5.0 && counts[1] > 5.0);
    let [a, b] = sides.map(DVec3::normalize);
    let across = middles[1] / counts[1] - middles[0] / counts[0];
    // On a mountain the normals lean apart.
    (b - a).dot(across).signum() * a.angle_between(b).to_degrees()
}

/// Along warp and weft, along the diagonal, and at angles at which no link runs.
const LINES: [((f64, f64), (f64, f64)); 5] = [
    ((0.5, 0.0), (0.5, 1.0)),
    ((0.0, 0.47), (1.0, 0.47)),
    ((0.0, 0.0), (1.0, 1.0)),
    ((0.0, 0.31), (1.0, 0.62)),
    ((0.37, 0.0), (0.58, 1.0)),
];

#[test]
fn creases_fold_to_their_side_in_any_direction() {
    for (from, to) in LINES {
        for (fold, sign) in [("Mountain", 1.0), ("Valley", -1.0)] {
            let mut cloth = creased(from, to, fold);
            advance(&mut cloth, 1.5);
            let folded = sign * angle(&cloth, from, to);
            println!("{fold} from {from:?} to {to:?}: {folded:.0}°");
            assert!(
                (40.0..130.0).contains(&folded),
                "{fold} {from:?} {to:?}: {folded}"
            );
            assert_whole(&cloth, fold);
        }
    }
}

#[test]
fn a_crease_turned_inside_out_comes_back() {
    // The paper's fold may flip; this one, started on the wrong side, does not stay there.
    for (from, to) in LINES {
        let mut wrong = creased(from, to, "Valley");
        advance(&mut wrong, 1.0);
        assert!(angle(&wrong, from, to) < -40.0);
        let mut cloth = creased(from, to, "Mountain");
        // Thrown to the valley's side by hands that take it there.
        let lead: Vec<DVec3> = wrong
            .positions()
            .iter()
            .zip(cloth.positions())
            .map(|(to, from)| (*to - *from) / 0.1)
            .collect();
        cloth.set_velocities(&lead);
        advance(&mut cloth, 0.1);
        advance(&mut cloth, 2.0);
        let folded = angle(&cloth, from, to);
        assert!(folded > 40.0, "{from:?} {to:?}: {folded}");
    }
}

#[test]
fn a_crease_pressed_while_the_cloth_moves_folds_it() {
    use bevy::math::DVec2;
    let mut cloth = drape(
        "(particles: (21, 21), size_m: (0.2, 0.2), start: Flat(centre_m: (0, 0, 0)),
          material: Measured((bending: (2e-5, 2e-5))))",
    );
    cloth.settings.gravity = DVec3::ZERO;
    advance(&mut cloth, 0.2);
    let (from, to) = ((0.0, 0.31), (1.0, 0.62));
    assert!(angle(&cloth, from, to).abs() < 10.0);
    let links = cloth.add_crease(DVec2::from(from), DVec2::from(to), 1.5, 0.01);
    assert!(links > 20, "{links}");
    advance(&mut cloth, 1.5);
    assert!(angle(&cloth, from, to) > 40.0);
}
