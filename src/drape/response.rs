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

mod kernels;

use super::lattice::{C_B, DIRECTIONS, K, K_B, Links, Model};
use super::rows::{Rows, each, each2};
use kernels::{Ends, Stretch, add_row, bend_row, spring_row, stretch_row};

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
