//! The links of a whole cloth: which particles they join and how stiff each is (model section 8).
//!
//! Particles lie on a grid, `spacing` metres apart. From each, links run in four [`DIRECTIONS`]:
//! type 1 to the next particle, type 2 to the one after.

use super::rows::Rows;

/// The directions in which links run, as (x, y): along the weft, along the warp, and two diagonals.
pub const DIRECTIONS: [(isize, isize); 4] = [(1, 0), (0, 1), (1, 1), (-1, 1)];

/// Whether links can push.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Model {
    /// Type 1 links pull, type 2 links bend (Choi and Ko).
    Choi,
    /// Springs both ways (Lander), type 2 links too: nothing bends, all is stretched or compressed.
    Lander,
}

/// The links of a cloth.
#[derive(Debug, Clone, PartialEq)]
pub struct Links {
    /// Choi's or Lander's.
    pub model: Model,
    /// Particles across and down.
    pub particles: (usize, usize),
    /// Metres between them.
    pub spacing: (f64, f64),
    /// By direction, from plane [`K`] on: k of the type 1 link that begins at the particle, N/m; from
    /// [`K_B`] on: k_b of its type 2 link, N·m²; from [`C_B`] on: c_b, N/m.
    pub stiffness: Rows,
    /// k_d of the type 1 links of each direction, as a share of their k, s.
    pub damping: [f64; 4],
}

/// The first plane of k in [`Links::stiffness`].
pub const K: usize = 0;
/// The first plane of k_b in [`Links::stiffness`].
pub const K_B: usize = 4;
/// The first plane of c_b in [`Links::stiffness`].
pub const C_B: usize = 8;

impl Links {
    /// No links between `particles` that are `spacing` metres apart.
    pub fn none(particles: (usize, usize), spacing: (f64, f64)) -> Self {
        Links {
            model: Model::Choi,
            particles,
            spacing,
            stiffness: Rows::zero(particles.0, particles.1, 12),
            damping: [0.0; 4],
        }
    }

    /// The same k, k_b, c_b and k_d for every link, as paper C has it.
    pub fn uniform(
        model: Model,
        particles: (usize, usize),
        spacing: (f64, f64),
        [k, k_b, c_b, k_d]: [f64; 4],
    ) -> Self {
        let mut links = Links::none(particles, spacing);
        links.model = model;
        links.damping = [if k > 0.0 { k_d / k } else { 0.0 }; 4];
        for direction in 0..4 {
            for y in 0..particles.1 {
                for x in 0..particles.0 {
                    if links.other_end((x, y), direction, 1).is_some() {
                        *links.stiffness.get_mut(x, y, K + direction) = k;
                    }
                    // Lander has no links two steps along a diagonal.
                    let has = model == Model::Choi || direction < 2;
                    if has && links.other_end((x, y), direction, 2).is_some() {
                        *links.stiffness.get_mut(x, y, K_B + direction) = k_b;
                        *links.stiffness.get_mut(x, y, C_B + direction) = c_b;
                    }
                }
            }
        }
        links
    }

    /// The natural length of the type 1 links of a direction, m; type 2 links are twice as long.
    pub fn length(&self, direction: usize) -> f64 {
        let (dx, dy) = DIRECTIONS[direction];
        let (x, y) = (dx as f64 * self.spacing.0, dy as f64 * self.spacing.1);
        (x * x + y * y).sqrt()
    }

    /// The particle to which the link of `hops` steps leads, if it lies on the grid.
    pub fn other_end(
        &self,
        (x, y): (usize, usize),
        direction: usize,
        hops: isize,
    ) -> Option<(usize, usize)> {
        let (dx, dy) = DIRECTIONS[direction];
        let x = x.checked_add_signed(hops * dx)?;
        let y = y.checked_add_signed(hops * dy)?;
        (x < self.particles.0 && y < self.particles.1).then_some((x, y))
    }
}
