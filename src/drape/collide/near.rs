//! Which corners, edges and triangles may touch in a step.

use bevy::math::DVec3;
use rayon::prelude::*;

use super::boxes::Box3;
use super::colliders::Colliders;
use super::distance::Pair;
use super::topology::{CellParts, Topology};
use super::tree::Tree;

/// Where the corners of cloth and colliders are at both ends of a step: the particles first, then the
/// corners of the mesh.
#[derive(Debug, Clone, Copy)]
pub struct Motion<'a> {
    /// At the beginning, m.
    pub from: &'a [DVec3],
    /// At the end, m.
    pub to: &'a [DVec3],
}

impl Motion<'_> {
    fn bounds(&self, corners: &[u32]) -> Box3 {
        let add = |bounds: Box3, i: &u32| {
            let i = *i as usize;
            bounds.with(self.from[i]).with(self.to[i])
        };
        corners.iter().fold(Box3::EMPTY, add)
    }
}

/// What of a cell or a triangle may touch others, with boxes.
#[derive(Debug, Clone, Default)]
struct Parts {
    corners: Vec<(u32, Box3)>,
    edges: Vec<([u32; 2], Box3)>,
    triangles: Vec<([u32; 3], Box3)>,
}

impl Parts {
    fn of_cell(&mut self, parts: CellParts, motion: Motion) {
        self.clear();
        let corners = parts.corner.into_iter();
        self.corners
            .extend(corners.map(|c| (c, motion.bounds(&[c]))));
        let edges = parts.edges.into_iter().flatten();
        self.edges.extend(edges.map(|e| (e, motion.bounds(&e))));
        let triangles = parts.triangles.into_iter().flatten();
        self.triangles
            .extend(triangles.map(|t| (t, motion.bounds(&t))));
    }

    fn of_triangle(&mut self, colliders: &Colliders, triangle: u32, first: u32, motion: Motion) {
        self.clear();
        let (corners, edges) = colliders.owned(triangle);
        let corners = corners.into_iter().flatten().map(|c| c + first);
        self.corners
            .extend(corners.map(|c| (c, motion.bounds(&[c]))));
        let edges = edges.into_iter().flatten().map(|e| e.map(|i| i + first));
        self.edges.extend(edges.map(|e| (e, motion.bounds(&e))));
        let t = colliders.mesh.triangles[triangle as usize].map(|i| i + first);
        self.triangles.push((t, motion.bounds(&t)));
    }

    fn clear(&mut self) {
        self.corners.clear();
        self.edges.clear();
        self.triangles.clear();
    }

    /// Adds the pairs of a cell's corner and those of its triangles that it is no corner of.
    fn corner_with_own(&self, margin: f64, found: &mut Vec<Pair>) {
        for (p, bounds) in &self.corners {
            let bounds = bounds.grown(margin);
            for (t, other) in &self.triangles {
                if bounds.meets(other) && !t.contains(p) {
                    found.push(Pair::PointTriangle([*p, t[0], t[1], t[2]]));
                }
            }
        }
    }

    /// Adds the pairs of these parts whose boxes, grown by `margin`, meet and that share no corner.
    fn pair_with(&self, other: &Parts, margin: f64, found: &mut Vec<Pair>) {
        for (one, two) in [(self, other), (other, self)] {
            for (p, bounds) in &one.corners {
                let bounds = bounds.grown(margin);
                for (t, other) in &two.triangles {
                    if bounds.meets(other) && !t.contains(p) {
                        found.push(Pair::PointTriangle([*p, t[0], t[1], t[2]]));
                    }
                }
            }
        }
        for (e, bounds) in &self.edges {
            let bounds = bounds.grown(margin);
            for (f, other) in &other.edges {
                if bounds.meets(other) && !e.iter().any(|i| f.contains(i)) {
                    found.push(Pair::EdgeEdge([e[0], e[1], f[0], f[1]]));
                }
            }
        }
    }
}

/// All pairs of the cloth with itself whose boxes, grown by `margin`, meet during a motion to which
/// `tree` has been fitted.
pub fn with_itself(topology: &Topology, tree: &Tree, motion: Motion, margin: f64) -> Vec<Pair> {
    let found: Vec<Vec<Pair>> = tree
        .meetings(margin)
        .par_chunks(64)
        .map(|meetings| {
            let (mut a, mut b) = (Parts::default(), Parts::default());
            let mut found = Vec::new();
            for (one, two) in meetings {
                a.of_cell(topology.parts(*one), motion);
                if one == two {
                    a.corner_with_own(margin, &mut found);
                    continue;
                }
                b.of_cell(topology.parts(*two), motion);
                a.pair_with(&b, margin, &mut found);
            }
            found
        })
        .collect();
    found.into_iter().flatten().collect()
}

/// All pairs of the cloth with the mesh of the colliders, whose corners follow the particles in
/// `motion`.
pub fn with_colliders(
    topology: &Topology,
    tree: &Tree,
    colliders: &Colliders,
    motion: Motion,
    margin: f64,
) -> Vec<Pair> {
    let around = colliders.bounds().grown(margin);
    let mut cells = Vec::new();
    tree.visit(|bounds| around.meets(bounds), |cell| cells.push(cell));
    let first = (topology.particles.0 * topology.particles.1) as u32;
    let found: Vec<Vec<Pair>> = cells
        .par_chunks(64)
        .map(|cells| {
            let (mut a, mut b) = (Parts::default(), Parts::default());
            let mut found = Vec::new();
            for cell in cells {
                let bounds = tree.cell(*cell).grown(margin);
                let mut fresh = true;
                let corners = topology.corners(*cell);
                colliders.visit(&bounds, |triangle| {
                    if is_beside(colliders, triangle, &corners, motion, margin) {
                        return;
                    }
                    if std::mem::take(&mut fresh) {
                        a.of_cell(topology.parts(*cell), motion);
                    }
                    b.of_triangle(colliders, triangle, first, motion);
                    a.pair_with(&b, margin, &mut found);
                });
            }
            found
        })
        .collect();
    found.into_iter().flatten().collect()
}

/// Whether a cell stays further than `margin` from a triangle on the outer side of its plane, or of an
/// upright plane on one of its sides. Boxes alone say little about large triangles.
fn is_beside(
    colliders: &Colliders,
    triangle: u32,
    cell: &[u32; 4],
    motion: Motion,
    margin: f64,
) -> bool {
    let planes = colliders.planes(triangle);
    planes.iter().any(|(at, way)| {
        cell.iter().all(|i| {
            let i = *i as usize;
            (motion.from[i] - *at).dot(*way) > margin && (motion.to[i] - *at).dot(*way) > margin
        })
    })
}
