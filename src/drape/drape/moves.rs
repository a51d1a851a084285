//! What becomes of the moves that an integrator proposes: nothing passes through anything, and the state
//! takes what is left.

use bevy::math::DVec3;

use super::super::collide::distance::Pair;
use super::super::collide::filter::{Bodies, Filtered, filter};
use super::super::collide::near::{Motion, with_colliders, with_itself};
use super::super::contact::{Anchor, Rule, anchored};
use super::super::pcg::Solved;
use super::{Drape, DrapeError, Proposed};

impl Drape {
    /// The particles, and behind them the corners of the colliders.
    pub(super) fn corners(&self) -> Vec<DVec3> {
        let mut all = self.state.x.clone();
        all.extend_from_slice(&self.colliders.mesh.corners);
        all
    }

    /// What may touch on the way from one place to another.
    pub(super) fn near(&mut self, from: &[DVec3], to: &[DVec3]) -> Vec<Pair> {
        let count = self.state.x.len();
        let meshes = !self.colliders.mesh.triangles.is_empty();
        if !self.settings.itself && !meshes {
            return Vec::new();
        }
        let topology = &self.sheet.topology;
        self.tree.fit(topology, &from[..count], &to[..count]);
        let motion = Motion { from, to };
        let margin = 1.5 * self.settings.thickness;
        let mut pairs = Vec::new();
        if self.settings.itself {
            pairs = with_itself(topology, &self.tree, motion, margin);
        }
        if meshes {
            let colliders = &self.colliders;
            pairs.extend(with_colliders(
                topology, &self.tree, colliders, motion, margin,
            ));
        }
        pairs
    }

    /// Makes moves such that nothing passes through anything.
    pub(super) fn filter(
        &mut self,
        mobility: &[f64],
        covered: f64,
        moves: &mut Vec<DVec3>,
        changed: &mut [bool],
    ) -> (Filtered, usize) {
        let from = self.corners();
        let exact = self.colliders.exact.clone();
        let triangles = std::mem::take(&mut self.triangles);
        let (one, two) = self.sheet.links.spacing;
        let (leg, shorter) = (one.max(two), one.min(two));
        let diagonal = self.sheet.links.length(2);
        let bodies = Bodies {
            particles: self.state.x.len(),
            from: &from,
            mobility,
            apart: self.settings.thickness,
            friction: self.settings.friction,
            exact: &exact,
            covered,
            triangles: &triangles,
            longest: [1.05 * 1.05 * leg * leg, 1.21 * diagonal * diagonal],
        };
        moves.resize(from.len(), DVec3::ZERO);
        for i in 0..bodies.particles {
            bodies.keep_out(i, moves, changed);
        }
        let ends = |moves: &[DVec3]| -> Vec<DVec3> {
            from.iter().zip(moves).map(|(x, by)| *x + *by).collect()
        };
        let mut pairs = self.near(&from, &ends(moves));
        let near = pairs.len();
        // Little enough, too, that what was smooth remains so: see `tree`.
        let slack = (0.5 * self.settings.thickness).min(0.04 * shorter);
        let filtered = filter(bodies, &mut pairs, moves, changed, slack, |moves| {
            self.near(&from, &ends(moves))
        });
        self.pairs = pairs;
        self.triangles = triangles;
        (filtered, near)
    }

    /// Takes over what a step has come to.
    pub(super) fn take(
        &mut self,
        proposed: Proposed,
        mut changed: Vec<bool>,
        mobility: &[f64],
        step: f64,
    ) -> Result<Solved, DrapeError> {
        let Proposed {
            moves,
            v,
            touches,
            alpha,
            solved,
        } = proposed;
        let rule = Rule {
            apart: self.settings.thickness,
            friction: self.settings.friction,
            alpha,
            step,
        };
        let state = &mut self.state;
        let mut anchors = vec![None; state.x.len()];
        for touch in &touches {
            let i = touch.particle as usize;
            changed[i] = true;
            let end = state.x[i] + moves[i];
            let anchor = anchored(
                *touch,
                moves[i],
                end,
                1.0 / mobility[i],
                state.anchors[i],
                rule,
            );
            if let Some(anchor) = anchor
                && anchors[i].is_none_or(|other: Anchor| other.pressed < anchor.pressed)
            {
                anchors[i] = Some(anchor);
            }
        }
        state.anchors = anchors;
        for i in 0..state.x.len() {
            state.last_v[i] = state.v[i];
            state.v[i] = if changed[i] { moves[i] / step } else { v[i] };
            state.is_fresh[i] = changed[i];
            state.last_move[i] = moves[i];
            state.x[i] += moves[i];
        }
        state.last_step = Some(step);
        self.time += step;
        Ok(solved)
    }
}
