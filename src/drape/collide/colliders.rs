//! What the cloth falls on.
//!
//! Floor and ball are exact, and it is enough that the particles keep off them: a floor is flat, and a
//! triangle whose corners are at least √(R² + c²) from the centre of a ball of radius R, and that a
//! circle of radius c covers, nowhere comes nearer than R. Everything else is a [`Mesh`].

use std::collections::{BTreeMap, BTreeSet};

use bevy::math::DVec3;

use super::super::exact::side;
use super::boxes::Box3;
use super::mesh::{Mesh, MeshTree};

/// Something exact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Exact {
    /// Everything below a height, m.
    Floor(f64),
    /// A ball.
    Ball {
        /// Its centre, m.
        centre: DVec3,
        /// Its radius, m.
        radius: f64,
    },
}

impl Exact {
    /// How far a point is outside (m, negative inside), and the way out. Cloth whose triangles fit into
    /// circles of radius `covered` is outside where all its corners are.
    pub fn distance(&self, point: DVec3, covered: f64) -> (f64, DVec3) {
        match *self {
            Exact::Floor(height) => (point.y - height, DVec3::Y),
            Exact::Ball { centre, radius } => {
                let out = point - centre;
                let reach = (radius * radius + covered * covered).sqrt();
                let length = out.length();
                let way = if length > 0.0 { out / length } else { DVec3::Y };
                (length - reach, way)
            }
        }
    }

    /// The first moment, 0 to 1, of a straight move at which `distance` falls below `least`; at once for
    /// a move further inwards from there.
    pub fn meets(&self, from: DVec3, by: DVec3, covered: f64, least: f64) -> Option<f64> {
        match *self {
            Exact::Floor(height) => {
                let begin = from.y - height - least;
                if by.y >= 0.0 {
                    None
                } else if begin <= 0.0 {
                    Some(0.0)
                } else {
                    (begin + by.y < 0.0).then(|| begin / -by.y)
                }
            }
            Exact::Ball { centre, radius } => {
                let reach = (radius * radius + covered * covered).sqrt() + least;
                let out = from - centre;
                // |out + t·by|² = reach²
                let (a, b) = (by.length_squared(), out.dot(by));
                let c = out.length_squared() - reach * reach;
                if b >= 0.0 {
                    return None;
                }
                if c <= 0.0 {
                    return Some(0.0);
                }
                let root = b * b - a * c;
                if root <= 0.0 {
                    return None;
                }
                let t = c / (root.sqrt() - b);
                (t < 1.0).then_some(t)
            }
        }
    }

    /// A straight move from `from` that keeps at least `least` away: what leads inwards is taken out where
    /// it meets, and some of the rest by friction. `None` if the move is free.
    pub fn slide(
        &self,
        from: DVec3,
        by: DVec3,
        covered: f64,
        least: f64,
        friction: f64,
    ) -> Option<DVec3> {
        let time = self.meets(from, by, covered, least)?;
        let (_, way) = self.distance(from + time * by, covered);
        let rest = (1.0 - time) * by;
        let inwards = rest.dot(way).min(0.0);
        let along = rest - inwards * way;
        let speed = along.length();
        let brake = (friction * -inwards).min(speed);
        Some(time * by + along - brake * along.normalize_or_zero())
    }
}

/// Everything that the cloth may fall on.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Colliders {
    /// Floors and balls.
    pub exact: Vec<Exact>,
    /// Everything else.
    pub mesh: Mesh,
    tree: MeshTree,
    /// By triangle: which of its corners and edges (those that begin at its corners) are its own.
    owned: Vec<[(bool, bool); 3]>,
    /// By triangle: its own plane, from either side, and the upright ones on its sides.
    planes: Vec<[Plane; 5]>,
}

/// A point of a plane and the way out of it.
pub type Plane = (DVec3, DVec3);

impl Colliders {
    /// Colliders of these shapes.
    pub fn new(exact: Vec<Exact>, mesh: Mesh) -> Self {
        let flat = flat_parts(&mesh);
        let mut corners = flat.corners;
        let mut edges = flat.edges;
        let owned = mesh.triangles.iter().map(|t| {
            std::array::from_fn(|i| {
                let (a, b) = (t[i], t[(i + 1) % 3]);
                let is_new = !std::mem::replace(&mut corners[a as usize], true);
                (is_new, edges.insert((a.min(b), a.max(b))))
            })
        });
        let owned = owned.collect();
        let planes = mesh.triangles.iter().map(|t| {
            let t = t.map(|i| mesh.corners[i as usize]);
            let normal = (t[1] - t[0]).cross(t[2] - t[0]);
            let side = |i: usize| (t[(i + 1) % 3] - t[i]).cross(normal);
            let ways = [normal, -normal, side(0), side(1), side(2)];
            std::array::from_fn(|i| (t[i.saturating_sub(2)], ways[i].normalize_or_zero()))
        });
        Colliders {
            planes: planes.collect(),
            tree: MeshTree::new(&mesh),
            exact,
            mesh,
            owned,
        }
    }

    /// The box around the mesh.
    pub fn bounds(&self) -> Box3 {
        self.tree.bounds()
    }

    /// Calls `meet` with every triangle of the mesh whose box meets `bounds`.
    pub fn visit(&self, bounds: &Box3, meet: impl FnMut(u32)) {
        self.tree.visit(bounds, meet);
    }

    /// Planes beyond any of which (by a margin) nothing is near a triangle: its own, from either side, and
    /// the upright ones on its sides.
    pub fn planes(&self, triangle: u32) -> &[Plane; 5] {
        &self.planes[triangle as usize]
    }

    /// Corners and edges of the mesh that belong to a triangle, so that each is met once.
    pub fn owned(&self, triangle: u32) -> ([Option<u32>; 3], [Option<[u32; 2]>; 3]) {
        let t = self.mesh.triangles[triangle as usize];
        let owned = self.owned[triangle as usize];
        (
            std::array::from_fn(|i| owned[i].0.then_some(t[i])),
            std::array::from_fn(|i| owned[i].1.then_some([t[i], t[(i + 1) % 3]])),
        )
    }
}

/// Corners and edges inside a flat face.
///
/// Cloth whose particles keep off the face keeps off them too, so they need not be met. Whether a face is
/// flat is decided exactly.
struct Flat {
    corners: Vec<bool>,
    edges: BTreeSet<(u32, u32)>,
}

fn flat_parts(mesh: &Mesh) -> Flat {
    let mut beside: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
    for (number, t) in mesh.triangles.iter().enumerate() {
        for i in 0..3 {
            let (a, b) = (t[i], t[(i + 1) % 3]);
            beside.entry((a.min(b), a.max(b))).or_default().push(number);
        }
    }
    let is_flat = |numbers: &[usize]| {
        let [one, two] = numbers else {
            return false;
        };
        let corners = mesh.triangles[*one].map(|i| mesh.corners[i as usize]);
        let others = mesh.triangles[*two].map(|i| mesh.corners[i as usize]);
        let in_plane = |p: DVec3| side(corners[0], corners[1], corners[2], p) == 0;
        others.into_iter().all(in_plane) && mesh.normal(*one).dot(mesh.normal(*two)) > 0.0
    };
    let mut corners = vec![true; mesh.corners.len()];
    let mut edges = BTreeSet::new();
    for (edge, numbers) in beside {
        if is_flat(&numbers) {
            edges.insert(edge);
        } else {
            corners[edge.0 as usize] = false;
            corners[edge.1 as usize] = false;
        }
    }
    Flat { corners, edges }
}
