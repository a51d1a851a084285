//! No move lets anything pass through anything: the last word on every step.
//!
//! The solver proposes moves. Where two things would touch on the way ([`ccd`](super::ccd)), they are
//! first pushed apart, pair after pair, as inelastic impacts with friction (after Bridson, Fedkiw and
//! Anderson, *Robust Treatment of Collisions, Contact and Friction for Cloth Animation*, 2002). Impacts
//! that make new ones are met again, a few times. What still collides then is a zone in which all go
//! only as far as the first of them may; a zone that meets others takes them in. That always ends, at
//! the latest when nothing moves, and as every pair keeps a tenth of its distance, nothing ever passes:
//! this is the guarantee (the step filter of Li et al., *Incremental Potential Contact*, 2020, by zones).

use bevy::math::DVec3;
use rayon::prelude::*;

use super::ccd::{time_of_impact, time_to_ball};
use super::colliders::Exact;
use super::distance::{Pair, combine};

/// Rounds of impacts before moves are shortened.
const ROUNDS: usize = 4;

/// What takes part in a step.
#[derive(Debug, Clone, Copy)]
pub struct Bodies<'a> {
    /// How many of the corners are particles; those of colliders follow.
    pub particles: usize,
    /// Where every corner begins, m.
    pub from: &'a [DVec3],
    /// The inverse mass of every corner, 1/kg; 0 for what is held, and for colliders.
    pub mobility: &'a [f64],
    /// Distance that impacts leave between things, m.
    pub apart: f64,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// Floors and balls.
    pub exact: &'a [Exact],
    /// The radius of a circle that covers any triangle, m.
    pub covered: f64,
    /// The cloth's triangles.
    pub triangles: &'a [[u32; 3]],
    /// Squares of the longest sides of a triangle that such a circle surely covers: along and across the
    /// grid, and the diagonal, m².
    pub longest: [f64; 2],
}

/// What the filter had to do.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Filtered {
    /// Impacts that pushed things apart.
    pub impacts: usize,
    /// Corners whose move was shortened.
    pub shortened: usize,
}

/// Changes `moves` until none of `pairs` touches. Marks the corners it changed in `changed`.
///
/// `again` finds `pairs` anew; it is called when moves have changed by more than `slack`, the margin that
/// `pairs` was found with.
pub fn filter(
    bodies: Bodies,
    pairs: &mut Vec<Pair>,
    moves: &mut [DVec3],
    changed: &mut [bool],
    slack: f64,
    mut again: impl FnMut(&[DVec3]) -> Vec<Pair>,
) -> Filtered {
    let mut done = Filtered::default();
    let proposed: Vec<DVec3> = moves.to_vec();
    let mut base = proposed;
    let mut refresh = |moves: &[DVec3], base: &mut Vec<DVec3>, pairs: &mut Vec<Pair>| {
        let left = moves
            .iter()
            .zip(base.iter())
            .any(|(a, b)| (*a - *b).length_squared() > slack * slack);
        if left {
            *pairs = again(moves);
            base.clear();
            base.extend_from_slice(moves);
        }
    };
    let mut hits = touching(bodies, pairs, moves);
    for _ in 0..ROUNDS {
        if hits.is_empty() {
            break;
        }
        for (_, pair) in &hits {
            done.impacts += usize::from(impact(bodies, *pair, moves, changed));
        }
        for (_, pair) in &hits {
            for corner in pair.corners() {
                bodies.keep_out(corner as usize, moves, changed);
            }
        }
        refresh(moves, &mut base, pairs);
        hits = touching(bodies, pairs, moves);
    }
    let mut over_balls = meeting_balls(bodies, moves);
    if hits.is_empty() && over_balls.is_empty() {
        return done;
    }
    let mut zones = Zones::new(moves.len());
    let mut shortened = vec![false; moves.len()];
    let mut patience = 10;
    while !hits.is_empty() || !over_balls.is_empty() {
        let of_pairs = hits.iter().map(|(time, pair)| (*time, pair.corners()));
        let of_balls = over_balls
            .iter()
            .map(|(time, [a, b, c])| (*time, [*a, *a, *b, *c]));
        let all: Vec<(f64, [u32; 4])> = of_pairs.chain(of_balls).collect();
        for (_, corners) in &all {
            zones.join(corners.iter().copied().filter(|i| bodies.is_cloth(*i)));
        }
        // How far each zone may go: the shortest of its times.
        let mut most = vec![1.0_f64; moves.len()];
        for (time, corners) in &all {
            for corner in corners.iter().filter(|i| bodies.is_cloth(**i)) {
                let root = zones.root(*corner as usize);
                // A zone that hardly moves is stopped, and in the end every one, so that this ends.
                let stops = *time < 0.05 || patience == 0;
                let time = if stops { 0.0 } else { 0.9 * time };
                most[root] = most[root].min(time);
            }
        }
        patience = patience.max(1) - 1;
        for i in 0..bodies.particles {
            let share = most[zones.root(i)];
            if share < 1.0 {
                moves[i] *= share;
                changed[i] = true;
                shortened[i] = true;
            }
        }
        refresh(moves, &mut base, pairs);
        hits = touching(bodies, pairs, moves);
        over_balls = meeting_balls(bodies, moves);
    }
    done.shortened = shortened.iter().filter(|s| **s).count();
    done
}

impl Bodies<'_> {
    /// Held particles are among those that may be stopped.
    fn is_cloth(&self, corner: u32) -> bool {
        (corner as usize) < self.particles
    }

    /// Keeps a particle out of floors and balls.
    pub fn keep_out(&self, corner: usize, moves: &mut [DVec3], changed: &mut [bool]) {
        if corner >= self.particles {
            return;
        }
        let least = 0.25 * self.apart;
        for exact in self.exact {
            let (from, by) = (self.from[corner], moves[corner]);
            if let Some(by) = exact.slide(from, by, self.covered, least, self.friction) {
                moves[corner] = by;
                changed[corner] = true;
            }
        }
    }
}

/// The pairs that touch, the earliest first.
fn touching(bodies: Bodies, pairs: &[Pair], moves: &[DVec3]) -> Vec<(f64, Pair)> {
    let meet = |pair: &Pair| {
        let corners = pair.corners().map(|i| i as usize);
        let time = time_of_impact(
            *pair,
            corners.map(|i| bodies.from[i]),
            corners.map(|i| moves[i]),
        );
        time.map(|time| (time, *pair))
    };
    let found: Vec<Vec<(f64, Pair)>> = pairs
        .par_chunks(512)
        .map(|pairs| pairs.iter().filter_map(meet).collect())
        .collect();
    let mut found: Vec<_> = found.into_iter().flatten().collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    found
}

/// Triangles, stretched so far that their corners do not keep them off a ball, that would meet one; with
/// the time up to which they may go.
fn meeting_balls(bodies: Bodies, moves: &[DVec3]) -> Vec<(f64, [u32; 3])> {
    let balls: Vec<(DVec3, f64)> = bodies
        .exact
        .iter()
        .filter_map(|exact| match *exact {
            Exact::Ball { centre, radius } => Some((centre, radius)),
            Exact::Floor(_) => None,
        })
        .collect();
    if balls.is_empty() {
        return Vec::new();
    }
    let [side, diagonal] = bodies.longest;
    let is_covered = |[a, b, c]: [DVec3; 3]| {
        let mut sides = [a, b, c].map(|_| 0.0);
        for (i, (p, q)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
            sides[i] = (q - p).length_squared();
        }
        let longest = sides[0].max(sides[1]).max(sides[2]);
        let over = sides.iter().filter(|s| **s > side).count();
        longest <= diagonal && over <= 1
    };
    let meet = |t: &[u32; 3]| {
        let from = t.map(|i| bodies.from[i as usize]);
        let by = t.map(|i| moves[i as usize]);
        let to = [from[0] + by[0], from[1] + by[1], from[2] + by[2]];
        if is_covered(from) && is_covered(to) {
            return None;
        }
        let times = balls
            .iter()
            .filter_map(|ball| time_to_ball(*ball, from, by));
        let first = times.fold(f64::INFINITY, f64::min);
        first.is_finite().then_some((first, *t))
    };
    let chunks = bodies.triangles.par_chunks(1024);
    let found: Vec<Vec<(f64, [u32; 3])>> = chunks
        .map(|part| part.iter().filter_map(meet).collect())
        .collect();
    found.into_iter().flatten().collect()
}

/// Pushes a pair apart, so that it ends the step on the side where it began. Returns whether it had to.
fn impact(bodies: Bodies, pair: Pair, moves: &mut [DVec3], changed: &mut [bool]) -> bool {
    let corners = pair.corners().map(|i| i as usize);
    let from = corners.map(|i| bodies.from[i]);
    let by = corners.map(|i| moves[i]);
    let Some(time) = time_of_impact(pair, from, by) else {
        return false;
    };
    let at = [0, 1, 2, 3].map(|i| from[i] + time * by[i]);
    let w = pair.weights(at);
    let normal = combine(w, at).normalize_or_zero();
    let mobility = corners.map(|i| bodies.mobility[i]);
    let give: f64 = (0..4).map(|i| w[i] * w[i] * mobility[i]).sum();
    if give <= 0.0 || normal == DVec3::ZERO {
        return false;
    }
    let begin = combine(w, from).dot(normal);
    let relative = combine(w, by);
    let closing = relative.dot(normal);
    let apart = bodies.apart.min(begin.max(0.2 * bodies.apart));
    let push = (apart - begin - closing) / give;
    if push <= 0.0 {
        return false;
    }
    let sliding = relative - closing * normal;
    let speed = sliding.length();
    let brake = (bodies.friction * push).min(speed / give);
    let change = push * normal - brake * sliding.normalize_or_zero();
    for i in 0..4 {
        moves[corners[i]] += w[i] * mobility[i] * change;
        changed[corners[i]] |= mobility[i] > 0.0;
    }
    true
}

/// Corners that move as far as each other.
struct Zones(Vec<usize>);

impl Zones {
    fn new(corners: usize) -> Self {
        Zones((0..corners).collect())
    }

    fn root(&mut self, corner: usize) -> usize {
        let mut at = corner;
        while self.0[at] != at {
            self.0[at] = self.0[self.0[at]];
            at = self.0[at];
        }
        at
    }

    fn join(&mut self, corners: impl Iterator<Item = u32>) {
        let mut first = None;
        for corner in corners {
            let root = self.root(corner as usize);
            let with = *first.get_or_insert(root);
            let (low, high) = (with.min(root), with.max(root));
            self.0[high] = low;
            first = Some(low);
        }
    }
}
