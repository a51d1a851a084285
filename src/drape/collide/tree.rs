//! Which parts of the cloth may meet in a step: a tree of rectangles over the grid.
//!
//! The grid itself is the tree: four cells make a node, four nodes the next. For every node it keeps a
//! box around its corners at both ends of the step, and bounds of the cloth's two tangents,
//! f_u = ∂x/∂u and f_v = ∂x/∂v.
//!
//! **Smooth pieces are left out, and provably so.** The cloth is a map f from the plane into space,
//! linear on every triangle, and rectangles are convex. If for a fixed linear map A the matrix AᵀF + FᵀA
//! is positive definite for the gradient F = (f_u, f_v) of every triangle of a rectangle, then for any
//! two of its points (f(q) − f(p))·A(q − p) = ∫(q − p)ᵀAᵀF(q − p) > 0 along the straight line between
//! them: they are apart (the idea of Noshiro and Warschawski). The condition is convex in F, so if it
//! holds at both ends of a step it holds at every moment between. With margins, points a distance d
//! apart in the cloth stay at least d/10 apart in space. Bounds of f_u and f_v are enough to check it.

use bevy::math::DVec3;
use rayon::prelude::*;

use super::boxes::Box3;
use super::topology::Topology;

/// One rectangle of cells.
#[derive(Debug, Clone, Copy)]
struct Node {
    bounds: Box3,
    /// Of f_u and f_v.
    tangents: [Box3; 2],
}

const NOTHING: Node = Node {
    bounds: Box3::EMPTY,
    tangents: [Box3::EMPTY; 2],
};

/// A level of nodes.
#[derive(Debug, Clone)]
struct Level {
    across: usize,
    down: usize,
    nodes: Vec<Node>,
}

/// The tree over the cells of a cloth.
#[derive(Debug, Clone)]
pub struct Tree {
    particles: (usize, usize),
    spacing: (f64, f64),
    /// From single cells to the whole.
    levels: Vec<Level>,
}

/// A node: its level, column and row.
type Place = (usize, usize, usize);

impl Tree {
    /// A tree for `particles` across and down, `spacing` metres apart.
    ///
    /// There is a cell for every particle, so that each corner, edge and triangle has a cell of its
    /// own; those in the last column and row are flat.
    pub fn new(particles: (usize, usize), spacing: (f64, f64)) -> Self {
        let mut levels = Vec::new();
        let (mut across, mut down) = particles;
        loop {
            levels.push(Level {
                across,
                down,
                nodes: vec![NOTHING; across * down],
            });
            if across <= 1 && down <= 1 {
                break;
            }
            (across, down) = (across.div_ceil(2), down.div_ceil(2));
        }
        Tree {
            particles,
            spacing,
            levels,
        }
    }

    /// Fits the tree to the particles at both ends of a step.
    pub fn fit(&mut self, topology: &Topology, from: &[DVec3], to: &[DVec3]) {
        let ((nx, ny), (dx, dy)) = (self.particles, self.spacing);
        let cell = |x: usize, y: usize| {
            let (right, below) = ((x + 1).min(nx - 1), (y + 1).min(ny - 1));
            let mut node = NOTHING;
            let whole = right > x && below > y;
            if whole && !topology.is_cloth(x, y) {
                // What is cut out is nowhere, and nothing around it counts as smooth.
                let any = Box3 {
                    low: DVec3::NEG_INFINITY,
                    high: DVec3::INFINITY,
                };
                node.tangents = [any; 2];
                return node;
            }
            for at in [from, to] {
                let corner = |x: usize, y: usize| at[y * nx + x];
                let corners = [
                    corner(x, y),
                    corner(right, y),
                    corner(x, below),
                    corner(right, below),
                ];
                for corner in corners {
                    node.bounds = node.bounds.with(corner);
                }
                if whole {
                    let [a, b, c, d] = corners;
                    let (u, v) = ([(b - a) / dx, (d - c) / dx], [(c - a) / dy, (d - b) / dy]);
                    node.tangents[0] = node.tangents[0].with(u[0]).with(u[1]);
                    node.tangents[1] = node.tangents[1].with(v[0]).with(v[1]);
                }
            }
            node
        };
        let leaves = &mut self.levels[0];
        leaves
            .nodes
            .par_chunks_mut(nx)
            .with_min_len(8)
            .enumerate()
            .for_each(|(y, row)| {
                for (x, node) in row.iter_mut().enumerate() {
                    *node = cell(x, y);
                }
            });
        for level in 1..self.levels.len() {
            let (below, above) = self.levels.split_at_mut(level);
            let (below, above) = (&below[level - 1], &mut above[0]);
            for y in 0..above.down {
                for x in 0..above.across {
                    let mut node = NOTHING;
                    for (i, j) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                        let (x, y) = (2 * x + i, 2 * y + j);
                        if x < below.across && y < below.down {
                            node = node.join(&below.nodes[y * below.across + x]);
                        }
                    }
                    above.nodes[y * above.across + x] = node;
                }
            }
        }
    }

    fn node(&self, (level, x, y): Place) -> &Node {
        let level = &self.levels[level];
        &level.nodes[y * level.across + x]
    }

    fn children(&self, (level, x, y): Place) -> impl Iterator<Item = Place> + Clone {
        let below = &self.levels[level - 1];
        let (across, down) = (below.across, below.down);
        [(0, 0), (1, 0), (0, 1), (1, 1)]
            .into_iter()
            .map(move |(i, j)| (level - 1, 2 * x + i, 2 * y + j))
            .filter(move |(_, x, y)| *x < across && *y < down)
    }

    /// The pairs of cells whose boxes, grown by `margin` together, meet, and that are not part of one
    /// smooth piece; as particle numbers of their first corners, in an order that the cloth fixes.
    pub fn meetings(&self, margin: f64) -> Vec<(u32, u32)> {
        let top = (self.levels.len() - 1, 0, 0);
        // Some pairs of large nodes first, which are then followed down at once.
        let mut tasks = vec![(top, top)];
        let mut found = Vec::new();
        for _ in 0..4 {
            let mut next = Vec::new();
            for task in tasks {
                self.split(task, margin, &mut next, &mut found);
            }
            tasks = next;
        }
        let below: Vec<Vec<(u32, u32)>> = tasks
            .into_par_iter()
            .with_min_len(4)
            .map(|task| {
                let (mut stack, mut found) = (vec![task], Vec::new());
                while let Some(task) = stack.pop() {
                    self.split(task, margin, &mut stack, &mut found);
                }
                found
            })
            .collect();
        found.extend(below.into_iter().flatten());
        found
    }

    /// Replaces a pair of nodes by those of their children that may meet.
    fn split(
        &self,
        (a, b): (Place, Place),
        margin: f64,
        next: &mut Vec<(Place, Place)>,
        found: &mut Vec<(u32, u32)>,
    ) {
        if a == b {
            if self.node(a).is_smooth() {
                return;
            }
            if a.0 == 0 {
                // Its corner may go through its own second triangle.
                let number = (a.2 * self.particles.0 + a.1) as u32;
                found.push((number, number));
                return;
            }
            let children = self.children(a);
            for (i, child) in children.clone().enumerate() {
                next.push((child, child));
                next.extend(children.clone().skip(i + 1).map(|other| (child, other)));
            }
            return;
        }
        let (one, two) = (self.node(a), self.node(b));
        if !one.bounds.grown(margin).meets(&two.bounds) {
            return;
        }
        // Side by side they are a rectangle too.
        let beside = a.1.abs_diff(b.1) + a.2.abs_diff(b.2) == 1;
        if beside && one.join(two).is_smooth() {
            return;
        }
        if a.0 == 0 {
            let number = |(_, x, y): Place| (y * self.particles.0 + x) as u32;
            found.push((number(a), number(b)));
            return;
        }
        for i in self.children(a) {
            next.extend(self.children(b).map(|j| (i, j)));
        }
    }

    /// Calls `meet` with the numbers of all cells whose boxes `touches` accepts.
    pub fn visit(&self, touches: impl Fn(&Box3) -> bool, mut meet: impl FnMut(u32)) {
        let mut stack = vec![(self.levels.len() - 1, 0, 0)];
        while let Some(place) = stack.pop() {
            if !touches(&self.node(place).bounds) {
                continue;
            }
            if place.0 == 0 {
                meet((place.2 * self.particles.0 + place.1) as u32);
            } else {
                stack.extend(self.children(place));
            }
        }
    }

    /// The box of one cell.
    pub fn cell(&self, number: u32) -> &Box3 {
        &self.levels[0].nodes[number as usize].bounds
    }
}

impl Node {
    fn join(&self, other: &Node) -> Node {
        Node {
            bounds: self.bounds.join(other.bounds),
            tangents: [
                self.tangents[0].join(other.tangents[0]),
                self.tangents[1].join(other.tangents[1]),
            ],
        }
    }

    /// Whether no two of its points can meet: see the [module](self). A is the middle of the bounds.
    fn is_smooth(&self) -> bool {
        let [u, v] = &self.tangents;
        if u.low.x > u.high.x {
            // Flat cells at the edge have no inside.
            return true;
        }
        let (a, b) = (u.middle(), v.middle());
        let uu = least_and_most(u, a).0;
        let vv = least_and_most(v, b).0;
        let (ub, va) = (least_and_most(u, b), least_and_most(v, a));
        let shear = 0.5 * (ub.0 + va.0).abs().max((ub.1 + va.1).abs());
        // Stricter than positive: what is left over keeps a distance.
        const LEFT: f64 = 0.25;
        uu > LEFT && vv > LEFT && (uu - LEFT) * (vv - LEFT) > shear * shear
    }
}

/// The least and most that f·a can be for f in a box.
fn least_and_most(f: &Box3, a: DVec3) -> (f64, f64) {
    let (low, high) = (f.low * a, f.high * a);
    let (least, most) = (low.min(high), low.max(high));
    (least.x + least.y + least.z, most.x + most.y + most.z)
}
