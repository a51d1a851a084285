//! The contacts of a step.

use bevy::math::DVec3;

use super::super::collide::distance::{Pair, combine};
use super::super::contact::{Added, Rule, Touch};
use super::super::drape::Given;
use super::{Implicit, Scheme, about};

impl Implicit {
    /// Adds contacts; returns those of particles with what does not move.
    pub(super) fn take_contacts(&mut self, given: &Given, scheme: Scheme) -> Vec<Touch> {
        let state = given.state;
        let count = state.x.len();
        let rule = Rule {
            apart: given.settings.thickness,
            friction: given.settings.friction,
            alpha: scheme.alpha,
            step: given.step,
        };
        let guess = |i: usize| {
            if i < count {
                about(given, i)
            } else {
                DVec3::ZERO
            }
        };
        let corner = |i: usize| match state.x.get(i) {
            Some(x) => *x,
            None => given.colliders.mesh.corners[i - count],
        };
        let mut touches = Vec::new();
        let mut touch = |i: usize, distance: f64, normal: DVec3| {
            // What was pressed stays in touch until a step has shown that it leaves: deciding anew
            // in every step would let cloth at rest tremble.
            let rests = state.anchors[i].is_some() && distance < 1.1 * rule.apart;
            if given.mobility[i] > 0.0 && (rests || rule.acts(distance, guess(i).dot(normal))) {
                touches.push(Touch {
                    particle: i as u32,
                    normal,
                    distance,
                });
            }
        };
        self.contacts.clear();
        let mut added = Added {
            own: &mut self.own,
            pull: &mut self.pull,
            contacts: &mut self.contacts,
        };
        for exact in &given.colliders.exact {
            for (i, x) in state.x.iter().enumerate() {
                let (distance, normal) = exact.distance(*x, given.covered);
                touch(i, distance, normal);
            }
        }
        for pair in given.pairs {
            let corners = pair.corners().map(|i| i as usize);
            let alone = matches!(pair, Pair::PointTriangle(_)) && corners[0] < count;
            if alone && corners[1] >= count {
                let x = corners.map(corner);
                let out = combine(pair.weights(x), x);
                touch(corners[0], out.length(), out.normalize_or_zero());
            } else {
                added.pair(*pair, corner, guess, |i| given.mobility[i], rule);
            }
        }
        drop_the_same_face(&mut touches, &state.x);
        for touch in &touches {
            let i = touch.particle as usize;
            let mass = 1.0 / given.mobility[i];
            added.touch(*touch, mass, (state.x[i], guess(i)), state.anchors[i], rule);
        }
        touches
    }
}

/// Leaves of the touches of a particle with the triangles of one flat face only the nearest: the closest
/// points of the others lie on their edges, and would push along the face.
fn drop_the_same_face(touches: &mut Vec<Touch>, x: &[DVec3]) {
    touches.sort_by(|a, b| {
        a.particle
            .cmp(&b.particle)
            .then(a.distance.total_cmp(&b.distance))
    });
    let mut kept: Vec<Touch> = Vec::with_capacity(touches.len());
    for touch in touches.iter() {
        let at = |touch: &Touch| x[touch.particle as usize] - touch.distance * touch.normal;
        let is_same = |nearer: &&Touch| {
            let along = at(touch) - at(nearer);
            along.dot(nearer.normal).abs() <= 1e-6 * nearer.distance
        };
        let before = kept
            .iter()
            .rev()
            .take_while(|nearer| nearer.particle == touch.particle);
        if before.filter(is_same).count() == 0 {
            kept.push(*touch);
        }
    }
    *touches = kept;
}
