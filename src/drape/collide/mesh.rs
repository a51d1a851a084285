//! Solid things made of triangles: what the cloth falls on, and a tree of boxes over them.

use bevy::math::DVec3;

use super::boxes::Box3;

/// A mesh of triangles that does not move.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mesh {
    /// Corners, m.
    pub corners: Vec<DVec3>,
    /// Triangles, by the numbers of their corners, anticlockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Adds another mesh.
    pub fn add(&mut self, other: &Mesh) {
        let first = self.corners.len() as u32;
        self.corners.extend_from_slice(&other.corners);
        let moved = other.triangles.iter().map(|t| t.map(|i| i + first));
        self.triangles.extend(moved);
    }

    /// The mesh somewhere else.
    pub fn moved(mut self, by: DVec3) -> Self {
        for corner in &mut self.corners {
            *corner += by;
        }
        self
    }

    /// A box with sharp edges, `size` wide, high and deep, around `centre`.
    pub fn cuboid(centre: DVec3, size: DVec3) -> Self {
        let corners = (0..8).map(|i| {
            let side = |bit: u32| if i >> bit & 1 == 1 { 0.5 } else { -0.5 };
            centre + DVec3::new(side(0), side(1), side(2)) * size
        });
        let faces: [[u32; 4]; 6] = [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
        ];
        let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
        Mesh {
            corners: corners.collect(),
            triangles: faces.into_iter().flat_map(halves).collect(),
        }
    }

    /// A slab with upright sides: `ring` gives its outline, moved inwards by a distance, clockwise seen
    /// from above and always of as many points; `profile` goes down its edge as (how far inwards, height).
    /// Top and bottom are flat.
    pub fn slab(ring: impl Fn(f64) -> Vec<(f64, f64)>, profile: &[(f64, f64)]) -> Self {
        let mut mesh = Mesh::default();
        let mut rings: Vec<Vec<u32>> = Vec::new();
        for (inwards, height) in profile {
            let first = mesh.corners.len() as u32;
            let points = ring(*inwards);
            rings.push((first..first + points.len() as u32).collect());
            let points = points.into_iter().map(|(x, z)| DVec3::new(x, *height, z));
            mesh.corners.extend(points);
        }
        for pair in rings.windows(2) {
            let n = pair[0].len();
            for i in 0..n {
                let (a, b) = (pair[0][i], pair[0][(i + 1) % n]);
                let (c, d) = (pair[1][i], pair[1][(i + 1) % n]);
                mesh.triangles.extend([[a, b, c], [b, d, c]]);
            }
        }
        // Top and bottom, as fans around their middles.
        for (ring, is_top) in [(rings.first(), true), (rings.last(), false)] {
            let Some(ring) = ring.filter(|ring| !ring.is_empty()) else {
                continue;
            };
            let sum: DVec3 = ring.iter().map(|i| mesh.corners[*i as usize]).sum();
            let middle = mesh.corners.len() as u32;
            mesh.corners.push(sum / ring.len() as f64);
            for i in 0..ring.len() {
                let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
                let triangle = if is_top {
                    [middle, b, a]
                } else {
                    [middle, a, b]
                };
                mesh.triangles.push(triangle);
            }
        }
        mesh
    }

    /// The unit normal of a triangle.
    pub fn normal(&self, triangle: usize) -> DVec3 {
        let [a, b, c] = self.triangles[triangle].map(|i| self.corners[i as usize]);
        (b - a).cross(c - a).normalize_or_zero()
    }
}

/// A tree of boxes over the triangles of a mesh.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MeshTree {
    nodes: Vec<Node>,
}

#[derive(Debug, Clone, PartialEq)]
struct Node {
    bounds: Box3,
    /// The triangle of a leaf, or the number of the second child; the first follows its parent.
    leads: Lead,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Lead {
    Triangle(u32),
    Second(u32),
}

impl MeshTree {
    /// The tree of a mesh, halved along the longest side again and again.
    pub fn new(mesh: &Mesh) -> Self {
        let bounds: Vec<Box3> = mesh
            .triangles
            .iter()
            .map(|t| {
                t.iter()
                    .fold(Box3::EMPTY, |b, i| b.with(mesh.corners[*i as usize]))
            })
            .collect();
        let mut all: Vec<u32> = (0..bounds.len() as u32).collect();
        let mut tree = MeshTree::default();
        tree.build(&bounds, &mut all);
        tree
    }

    fn build(&mut self, bounds: &[Box3], part: &mut [u32]) {
        let all = part
            .iter()
            .fold(Box3::EMPTY, |all, i| all.join(bounds[*i as usize]));
        let here = self.nodes.len();
        match part {
            [] => {}
            [one] => self.nodes.push(Node {
                bounds: all,
                leads: Lead::Triangle(*one),
            }),
            _ => {
                self.nodes.push(Node {
                    bounds: all,
                    leads: Lead::Second(0),
                });
                let size = all.high - all.low;
                let axis = (0..3).fold(0, |best, i| if size[i] > size[best] { i } else { best });
                let middle = |i: &u32| bounds[*i as usize].middle()[axis];
                part.sort_by(|a, b| middle(a).total_cmp(&middle(b)).then(a.cmp(b)));
                let (low, high) = part.split_at_mut(part.len() / 2);
                self.build(bounds, low);
                self.nodes[here].leads = Lead::Second(self.nodes.len() as u32);
                self.build(bounds, high);
            }
        }
    }

    /// The box around everything.
    pub fn bounds(&self) -> Box3 {
        self.nodes.first().map_or(Box3::EMPTY, |node| node.bounds)
    }

    /// Calls `meet` with every triangle whose box meets `bounds`.
    pub fn visit(&self, bounds: &Box3, mut meet: impl FnMut(u32)) {
        let mut stack = vec![0];
        while let Some(at) = stack.pop() {
            let Some(node) = self.nodes.get(at) else {
                continue;
            };
            if !node.bounds.meets(bounds) {
                continue;
            }
            match node.leads {
                Lead::Triangle(triangle) => meet(triangle),
                Lead::Second(second) => stack.extend([second as usize, at + 1]),
            }
        }
    }
}
