//! Contact within the implicit step: what is close pushes back and rubs.
//!
//! Cloth keeps a distance d̂, its thickness, from everything and from itself. Where it is nearer, or would
//! be after this step, a spring of stiffness k = [`STIFFNESS`]·m/α keeps it there; α is the step's
//! (`step`), m the mass that is moved. A spring this stiff yields by α·f/(20 m), at rest about a
//! hundredth of a millimetre. Overlap is undone no faster than [`FASTEST_OUT`].
//!
//! **Friction** is Coulomb's, |f_t| ≤ μ·f_n. A particle on a collider that does not move has an anchor
//! there: within the cone it is held to it by the same spring, so cloth at rest stays exactly where it is;
//! beyond, the anchor is drawn after it. f_n is that of the step before. Between pieces of cloth the law is
//! smoothed over sliding speeds below [`SLOWEST`] (as in Li et al., *Incremental Potential Contact*, 2020).

use bevy::math::DVec3;

use super::collide::distance::{Pair, combine};
use super::response::BLOCK;
use super::rows::Rows;

/// Stiffness of a contact in units of m/α.
pub const STIFFNESS: f64 = 20.0;

/// How fast things that overlap come apart, m/s.
pub const FASTEST_OUT: f64 = 0.1;

/// Sliding slower than this is damped in proportion, m/s.
pub const SLOWEST: f64 = 1e-3;

/// A particle that touches something that does not move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// The particle.
    pub particle: u32,
    /// The way out.
    pub normal: DVec3,
    /// How far out it is, m.
    pub distance: f64,
}

/// What a particle remembers of the collider that it rests on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Anchor {
    /// Where it is held, m.
    pub at: DVec3,
    /// How hard it was pressed in the last step, N.
    pub pressed: f64,
}

/// A contact among particles that move: C weighted by the shares of its corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// The corners; those of share 0 do not count.
    pub corners: [u32; 4],
    /// Their shares in the vector between the closest points.
    pub shares: [f32; 4],
    /// C, by plane: xx, yy, zz, xy, xz, yz; kg.
    pub block: [f32; BLOCK],
}

/// along·n nᵀ + across·(I − n nᵀ).
pub fn block(n: DVec3, along: f64, across: f64) -> [f64; BLOCK] {
    let d = along - across;
    [
        d * n.x * n.x + across,
        d * n.y * n.y + across,
        d * n.z * n.z + across,
        d * n.x * n.y,
        d * n.x * n.z,
        d * n.y * n.z,
    ]
}

/// A symmetric matrix, by plane, times a vector.
pub fn product([xx, yy, zz, xy, xz, yz]: [f64; BLOCK], v: DVec3) -> DVec3 {
    DVec3::new(
        xx * v.x + xy * v.y + xz * v.z,
        xy * v.x + yy * v.y + yz * v.z,
        xz * v.x + yz * v.y + zz * v.z,
    )
}

/// A symmetric matrix times a vector, in single precision.
fn times([xx, yy, zz, xy, xz, yz]: [f32; BLOCK], [x, y, z]: [f32; 3]) -> [f32; 3] {
    [
        xx * x + xy * y + xz * z,
        xy * x + yy * y + yz * z,
        xz * x + yz * y + zz * z,
    ]
}

/// What contacts add to a step: blocks of single particles, forces, and what joins several.
pub struct Added<'a> {
    /// E, kg.
    pub own: &'a mut Rows<f32>,
    /// α·f, kg·m.
    pub pull: &'a mut Rows,
    /// Contacts among particles.
    pub contacts: &'a mut Vec<Contact>,
}

impl Added<'_> {
    fn add(&mut self, particle: usize, block: [f64; BLOCK], pull: DVec3) {
        let nx = self.own.nx;
        let (x, y) = (particle % nx, particle / nx);
        for (plane, value) in block.into_iter().enumerate() {
            *self.own.get_mut(x, y, plane) += value as f32;
        }
        let old = self.pull.vector(x, y);
        self.pull.set_vector(x, y, old + pull);
    }

    /// Adds the contact of a particle of `mass` with something that does not move. `guess` is the move
    /// that it will about make.
    pub fn touch(
        &mut self,
        touch: Touch,
        mass: f64,
        (position, guess): (DVec3, DVec3),
        anchor: Option<Anchor>,
        rule: Rule,
    ) {
        let Touch {
            particle,
            normal,
            distance,
        } = touch;
        let stiff = STIFFNESS * mass;
        let wanted = rule.wanted(distance);
        let mut pull = stiff * (wanted - distance) * normal;
        let mut across = 0.0;
        if let Some(anchor) = anchor {
            let off = position - anchor.at;
            let off = off - off.dot(normal) * normal;
            let ahead = off + guess - guess.dot(normal) * normal;
            let most = rule.friction * anchor.pressed * rule.alpha;
            // Within the cone the spring, beyond it what gives the cone's force there.
            across = (most / ahead.length().max(1e-12)).min(stiff);
            pull -= across * off;
        }
        self.add(particle as usize, block(normal, stiff, across), pull);
    }

    /// Adds the contact of a pair, if it is or comes close enough.
    pub fn pair(
        &mut self,
        pair: Pair,
        at: impl Fn(usize) -> DVec3,
        guess: impl Fn(usize) -> DVec3,
        mobility: impl Fn(usize) -> f64,
        rule: Rule,
    ) {
        let corners = pair.corners().map(|i| i as usize);
        let x = corners.map(&at);
        let shares = pair.weights(x);
        let out = combine(shares, x);
        let distance = out.length();
        let moves = corners.map(&guess);
        if distance <= 0.0 {
            return;
        }
        let normal = out / distance;
        let relative = combine(shares, moves);
        let closing = relative.dot(normal);
        if !rule.acts(distance, closing) {
            return;
        }
        let mobile = corners.map(&mobility);
        let give: f64 = (0..4).map(|i| shares[i] * shares[i] * mobile[i]).sum();
        if give <= 0.0 {
            return;
        }
        let stiff = STIFFNESS / give;
        let push = stiff * (rule.wanted(distance) - distance);
        let sliding = (relative - closing * normal).length();
        let slowest = SLOWEST * rule.step;
        let across = (rule.friction * push.max(0.0) / sliding.max(slowest)).min(stiff);
        let c = block(normal, stiff, across);
        let mut kept = shares;
        for i in 0..4 {
            if mobile[i] > 0.0 && shares[i] != 0.0 {
                let w = shares[i];
                self.add(corners[i], c.map(|value| w * w * value), w * push * normal);
            } else {
                kept[i] = 0.0;
            }
        }
        if kept.iter().filter(|w| **w != 0.0).count() > 1 {
            self.contacts.push(Contact {
                corners: pair.corners(),
                shares: kept.map(|w| w as f32),
                block: c.map(|value| value as f32),
            });
        }
    }
}

/// What all contacts of a step have in common.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rule {
    /// d̂, m.
    pub apart: f64,
    /// μ.
    pub friction: f64,
    /// α, s².
    pub alpha: f64,
    /// The length of the step, s.
    pub step: f64,
}

impl Rule {
    /// The distance that a contact aims at in this step.
    fn wanted(&self, distance: f64) -> f64 {
        self.apart.min(distance + FASTEST_OUT * self.step)
    }

    /// Whether a contact has anything to do: where it would come closer than wanted, if the distance
    /// changes by `guess`. What moves away faster is let go.
    pub fn acts(&self, distance: f64, guess: f64) -> bool {
        distance + guess < self.wanted(distance)
    }
}

/// Adds to `out` = A·u what contacts join; what they do to single particles is in E.
pub fn apply(contacts: &[Contact], mass: &Rows<f32>, u: &Rows<f32>, out: &mut Rows<f32>) -> f64 {
    let nx = u.nx;
    let mut sum = 0.0;
    for contact in contacts {
        let places = contact.corners.map(|i| (i as usize % nx, i as usize / nx));
        let at = [0, 1, 2, 3].map(|i| {
            let (x, y) = places[i];
            if contact.shares[i] == 0.0 {
                return [0.0; 3];
            }
            [u.get(x, y, 0), u.get(x, y, 1), u.get(x, y, 2)]
        });
        let mut all = [0.0; 3];
        for (i, at) in at.iter().enumerate() {
            for c in 0..3 {
                all[c] += contact.shares[i] * at[c];
            }
        }
        for (i, at) in at.iter().enumerate() {
            let w = contact.shares[i];
            if w == 0.0 {
                continue;
            }
            let (x, y) = places[i];
            let others = [0, 1, 2].map(|c| all[c] - w * at[c]);
            let force = times(contact.block, others);
            let free = mass.get(x, y, 1);
            for c in 0..3 {
                let force = w * force[c] * free;
                *out.get_mut(x, y, c) += force;
                sum += f64::from(force * at[c]);
            }
        }
    }
    sum
}

/// What a particle that touches something rests on at the end of a step; nothing if it was let go.
pub fn anchored(
    touch: Touch,
    by: DVec3,
    end: DVec3,
    mass: f64,
    before: Option<Anchor>,
    rule: Rule,
) -> Option<Anchor> {
    let out = touch.distance + by.dot(touch.normal);
    let wanted = rule.apart.min(touch.distance + FASTEST_OUT * rule.step);
    let stiffness = STIFFNESS * mass / rule.alpha;
    let pressed = stiffness * (wanted - out);
    if pressed <= 0.0 {
        return None;
    }
    let mut at = before.map_or(end, |anchor| anchor.at);
    let off = end - at;
    let off = off - off.dot(touch.normal) * touch.normal;
    let most = rule.friction * pressed / stiffness;
    if off.length() > most {
        at = end - off * (most / off.length());
    }
    Some(Anchor { at, pressed })
}
