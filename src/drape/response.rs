//! The forces and Jacobians of all links of a cloth at a moment (model section 8).
//!
//! A link between x₁ and x₂ pulls its first end with f·n; its Jacobian is
//!
//! ∂f₁/∂x₂ = (df/dr)·n nᵀ + (f/r)·(I − n nᵀ).
//!
//! The implicit systems need it positive. For type 1 it is. The push F of a type 2 link is not: its
//! −(F/r)(I − n nᵀ) is dropped by Choi and Ko. But the push is carried by the type 1 links below,
//! and if p and q are the moves of the two, −(F/r)(p + q)² = −(2F/r)(p² + q²) + (F/r)(p − q)². So
//! here F is taken off the pull of both, as far as something is left of it, and what then remains
//! of type 2, (F/r)(p − q)², is the bending itself. Without this an implicit step sees a cloth
//! under tension where there is only one that bends, and folds form far too slowly.

use super::lattice::{C_B, DIRECTIONS, K, K_B, Links, Model};
use super::links::{Pull, bend, spring, stretch, stretch_ahead};
use super::rows::{Rows, each, each2};

/// Planes of a symmetric 3×3 matrix: xx, yy, zz, xy, xz, yz.
pub const BLOCK: usize = 6;

/// What the links of a cloth do at a moment. Blocks are α·∂f₁/∂x₂ + β·k_d·I for the α (s²) and β (s)
/// of an implicit system, whose off-diagonal they are with the sign changed; by direction.
#[derive(Debug, Clone)]
pub struct Response {
    /// Type 1: by direction, the force on the first end, N.
    pub stretch: Rows,
    /// Type 2: by direction, the force on the first end (planes 0 to 11) and the push (from 12 on), N.
    pub bend: Rows,
    /// The blocks of type 1, kg.
    pub stretch_blocks: Rows<f32>,
    /// The blocks of type 2, kg.
    pub bend_blocks: Rows<f32>,
}

/// The implicit step that blocks are for.
#[derive(Debug, Clone, Copy)]
pub struct Ahead<'a> {
    /// α, s².
    pub alpha: f64,
    /// β, s.
    pub beta: f64,
    /// The moves that particles will about make, m.
    pub moves: &'a Rows,
}

/// The first plane of the pushes.
const PUSH: usize = 12;

impl Response {
    /// Room for the links of `nx` × `ny` particles.
    pub fn new((nx, ny): (usize, usize)) -> Self {
        Response {
            stretch: Rows::zero(nx, ny, 12),
            bend: Rows::zero(nx, ny, 16),
            stretch_blocks: Rows::zero(nx, ny, 4 * BLOCK),
            bend_blocks: Rows::zero(nx, ny, 4 * BLOCK),
        }
    }

    /// Computes what `links` do at positions `x` and velocities `v`; blocks too for an implicit step.
    pub fn compute(&mut self, links: &Links, x: &Rows, v: &Rows, ahead: Option<Ahead>) {
        self.compute_bend(links, x, ahead.map(|ahead| ahead.alpha));
        self.compute_stretch(links, x, v, ahead);
    }

    fn compute_bend(&mut self, links: &Links, x: &Rows, blocks: Option<f64>) {
        let alpha = blocks.unwrap_or(0.0);
        each2(&mut self.bend, &mut self.bend_blocks, |y, out, matrices| {
            let (mut out, mut matrices) = (out.planes(), matrices.planes());
            let (force, push) = (out.take::<12>(), out.take::<4>());
            let mut forces = force.into_iter();
            for (direction, push) in push.into_iter().enumerate() {
                let length = 2.0 * links.length(direction);
                let stiffness = &links.stiffness;
                let [k_b] = stiffness.lines(y as isize, K_B + direction, 0);
                let [c_b] = stiffness.lines(y as isize, C_B + direction, 0);
                let force = std::array::from_fn(|_| forces.next().unwrap_or_default());
                let block = matrices.take();
                let ends = Ends::new(x, y, direction, 2);
                match (links.model, blocks.is_some()) {
                    (Model::Choi, true) => {
                        bend_row::<true>(ends, (k_b, c_b), length, alpha, force, push, block);
                    }
                    (Model::Choi, false) => {
                        bend_row::<false>(ends, (k_b, c_b), length, alpha, force, push, block);
                    }
                    (Model::Lander, _) => spring_row(ends, c_b, length, alpha, force, block),
                }
            }
        });
    }

    fn compute_stretch(&mut self, links: &Links, x: &Rows, v: &Rows, ahead: Option<Ahead>) {
        let bend = &self.bend;
        each2(
            &mut self.stretch,
            &mut self.stretch_blocks,
            |y, out, matrices| {
                let (mut out, mut matrices) = (out.planes(), matrices.planes());
                for (direction, (dx, dy)) in DIRECTIONS.into_iter().enumerate() {
                    let row = y as isize;
                    let [k] = links.stiffness.lines(row, K + direction, 0);
                    let [front] = bend.lines(row, PUSH + direction, 0);
                    let [behind] = bend.lines(row - dy, PUSH + direction, -dx);
                    let ends = Ends::new(x, y, direction, 1);
                    let speeds = Ends::new(v, y, direction, 1);
                    let law = Stretch {
                        length: links.length(direction),
                        damping: links.damping[direction],
                        alpha: ahead.map_or(0.0, |ahead| ahead.alpha),
                        beta: ahead.map_or(0.0, |ahead| ahead.beta),
                    };
                    // Without a step ahead nothing is looked up in it.
                    let moves = ahead.map_or(x, |ahead| ahead.moves);
                    let coming = Ends::new(moves, y, direction, 1);
                    let (force, block, pushes) = (out.take(), matrices.take(), [front, behind]);
                    let ends = [ends, speeds, coming];
                    match (links.model, ahead.is_some()) {
                        (Model::Choi, true) => {
                            stretch_row::<true, true>(ends, k, pushes, law, force, block);
                        }
                        (Model::Choi, false) => {
                            stretch_row::<true, false>(ends, k, pushes, law, force, block);
                        }
                        (Model::Lander, _) => {
                            stretch_row::<false, true>(ends, k, pushes, law, force, block);
                        }
                    }
                }
            },
        );
    }

    /// Adds the forces of all links to `force` (planes 0 to 2, N).
    pub fn add_forces(&self, force: &mut Rows) {
        each(force, |y, out| {
            let mut out = out.planes().take();
            for (of, hops) in [(&self.stretch, 1), (&self.bend, 2)] {
                for (direction, (dx, dy)) in DIRECTIONS.into_iter().enumerate() {
                    let row = y as isize;
                    let here = of.lines(row, 3 * direction, 0);
                    let there = of.lines(row - hops * dy, 3 * direction, -hops * dx);
                    add_row(&mut out, here, there);
                }
            }
        });
    }
}

/// The ends of all links of one kind that begin in one row.
#[derive(Clone, Copy)]
struct Ends<'a> {
    a: [&'a [f64]; 3],
    b: [&'a [f64]; 3],
}

impl<'a> Ends<'a> {
    fn new(field: &'a Rows, y: usize, direction: usize, hops: isize) -> Self {
        let (dx, dy) = DIRECTIONS[direction];
        Ends {
            a: field.lines(y as isize, 0, 0),
            b: field.lines(y as isize + hops * dy, 0, hops * dx),
        }
    }

    /// From the first end of link `i` to the second, after the slices have been cut to one length.
    #[inline(always)]
    fn across(&self, i: usize) -> [f64; 3] {
        [
            self.b[0][i] - self.a[0][i],
            self.b[1][i] - self.a[1][i],
            self.b[2][i] - self.a[2][i],
        ]
    }

    #[inline(always)]
    fn cut(self, n: usize) -> Self {
        Ends {
            a: [&self.a[0][..n], &self.a[1][..n], &self.a[2][..n]],
            b: [&self.b[0][..n], &self.b[1][..n], &self.b[2][..n]],
        }
    }
}

/// Length of a vector, 1/length, and direction; of none, no direction.
#[inline(always)]
fn polar(d: [f64; 3]) -> (f64, f64, [f64; 3]) {
    let r = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
    let per = 1.0 / r.max(1e-150);
    (r, per, [d[0] * per, d[1] * per, d[2] * per])
}

/// along·n nᵀ + all·I.
#[inline(always)]
fn matrix(n: [f64; 3], along: f64, all: f64) -> [f64; BLOCK] {
    let [x, y, z] = n;
    let (ax, ay, az) = (along * x, along * y, along * z);
    [
        ax * x + all,
        ay * y + all,
        az * z + all,
        ax * y,
        ax * z,
        ay * z,
    ]
}

#[multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn bend_row<const BLOCKS_TOO: bool>(
    ends: Ends,
    (k_b, c_b): (&[f64], &[f64]),
    length: f64,
    alpha: f64,
    force: [&mut [f64]; 3],
    push: &mut [f64],
    block: [&mut [f32]; BLOCK],
) {
    let n = push.len();
    let (ends, k_b, c_b) = (ends.cut(n), &k_b[..n], &c_b[..n]);
    let [fx, fy, fz] = force;
    let force = [&mut fx[..n], &mut fy[..n], &mut fz[..n]];
    let [xx, yy, zz, xy, xz, yz] = block;
    let block = [
        &mut xx[..n],
        &mut yy[..n],
        &mut zz[..n],
        &mut xy[..n],
        &mut xz[..n],
        &mut yz[..n],
    ];
    for i in 0..n {
        let (r, _, direction) = polar(ends.across(i));
        let Pull {
            force: f,
            stiffness,
        } = bend(r, length, k_b[i], c_b[i]);
        for c in 0..3 {
            force[c][i] = f * direction[c];
        }
        push[i] = -f;
        if BLOCKS_TOO {
            let block_of = matrix(direction, alpha * stiffness, alpha * f / length);
            for c in 0..BLOCK {
                block[c][i] = block_of[c] as f32;
            }
        }
    }
}

#[multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn spring_row(
    ends: Ends,
    k: &[f64],
    length: f64,
    alpha: f64,
    force: [&mut [f64]; 3],
    block: [&mut [f32]; BLOCK],
) {
    let n = k.len();
    let ends = ends.cut(n);
    let [fx, fy, fz] = force;
    let force = [&mut fx[..n], &mut fy[..n], &mut fz[..n]];
    let [xx, yy, zz, xy, xz, yz] = block;
    let block = [
        &mut xx[..n],
        &mut yy[..n],
        &mut zz[..n],
        &mut xy[..n],
        &mut xz[..n],
        &mut yz[..n],
    ];
    for i in 0..n {
        let (r, per, direction) = polar(ends.across(i));
        let Pull {
            force: f,
            stiffness,
        } = spring(r, length, k[i]);
        for c in 0..3 {
            force[c][i] = f * direction[c];
        }
        let across = f.max(0.0) * per;
        let block_of = matrix(direction, alpha * (stiffness - across), alpha * across);
        for c in 0..BLOCK {
            block[c][i] = block_of[c] as f32;
        }
    }
}

/// What the type 1 links of a direction have in common.
#[derive(Clone, Copy)]
struct Stretch {
    length: f64,
    damping: f64,
    alpha: f64,
    beta: f64,
}

#[multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn stretch_row<const CHOI: bool, const BLOCKS_TOO: bool>(
    [ends, speeds, coming]: [Ends; 3],
    k: &[f64],
    pushes: [&[f64]; 2],
    law: Stretch,
    force: [&mut [f64]; 3],
    block: [&mut [f32]; BLOCK],
) {
    let n = k.len();
    let (ends, speeds, coming) = (ends.cut(n), speeds.cut(n), coming.cut(n));
    let pushes = [&pushes[0][..n], &pushes[1][..n]];
    let [fx, fy, fz] = force;
    let force = [&mut fx[..n], &mut fy[..n], &mut fz[..n]];
    let [xx, yy, zz, xy, xz, yz] = block;
    let block = [
        &mut xx[..n],
        &mut yy[..n],
        &mut zz[..n],
        &mut xy[..n],
        &mut xz[..n],
        &mut yz[..n],
    ];
    let per_length = 1.0 / law.length;
    for i in 0..n {
        let (r, per, direction) = polar(ends.across(i));
        let pull = if CHOI && BLOCKS_TOO {
            let by = coming.across(i);
            let closing = by[0] * direction[0] + by[1] * direction[1] + by[2] * direction[2];
            stretch_ahead(r, r + closing, law.length, k[i])
        } else if CHOI {
            stretch(r, law.length, k[i])
        } else {
            spring(r, law.length, k[i])
        };
        let k_d = law.damping * k[i];
        let speed = speeds.across(i);
        for c in 0..3 {
            force[c][i] = pull.force * direction[c] + k_d * speed[c];
        }
        if BLOCKS_TOO {
            // A type 2 link is as long as two of these: its F/r is ½·F/length.
            let pushed = pushes[0][i] + pushes[1][i];
            // Ghosts at the end of a row look into the next plane.
            let pushed = if k[i] > 0.0 { pushed } else { 0.0 };
            let across = (pull.force - pushed).max(0.0) * per;
            let bending = pushed * per_length;
            let all = law.alpha * (across + bending) + law.beta * k_d;
            let along = law.alpha * (pull.stiffness - across);
            let block_of = matrix(direction, along, all);
            for c in 0..BLOCK {
                block[c][i] = block_of[c] as f32;
            }
        }
    }
}

#[multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn add_row(out: &mut [&mut [f64]; 3], here: [&[f64]; 3], there: [&[f64]; 3]) {
    for ((out, here), there) in out.iter_mut().zip(here).zip(there) {
        let n = out.len();
        let (here, there) = (&here[..n], &there[..n]);
        for i in 0..n {
            out[i] += here[i] - there[i];
        }
    }
}
