//! Whether anything passes through anything, decided without rounding errors.
//!
//! Two triangles that share no corner cross where an edge of one passes through the other. That is a
//! matter of signs of determinants, which Shewchuk's adaptive predicates (*Adaptive Precision
//! Floating-Point Arithmetic and Fast Robust Geometric Predicates*, 1997; crate `robust`) give exactly.
//! Touching counts as crossing.

use bevy::math::DVec3;
use robust::{Coord3D, orient3d};

use super::collide::boxes::Box3;
use super::collide::colliders::{Colliders, Exact};
use super::collide::mesh::{Mesh, MeshTree};

/// The sign of the volume of a tetrahedron: −1, 0 or 1.
pub fn side(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> i8 {
    let coordinate = |p: DVec3| Coord3D {
        x: p.x,
        y: p.y,
        z: p.z,
    };
    let volume = orient3d(coordinate(a), coordinate(b), coordinate(c), coordinate(d));
    i8::from(volume > 0.0) - i8::from(volume < 0.0)
}

/// Whether the edge from `p` to `q` passes through (or touches) a triangle. An edge in its plane does so
/// where it crosses one of its sides, which the other edges of a mesh show; alone it does not count.
pub fn edge_crosses(p: DVec3, q: DVec3, [a, b, c]: [DVec3; 3]) -> bool {
    let (from, to) = (side(a, b, c, p), side(a, b, c, q));
    if from == to {
        return false;
    }
    let around = [side(p, q, a, b), side(p, q, b, c), side(p, q, c, a)];
    !(around.contains(&1) && around.contains(&-1))
}

/// The pairs of triangles of the cloth (first) and of the cloth or, counted on from there, a mesh, that
/// cross.
pub fn crossings(x: &[DVec3], triangles: &[[u32; 3]], mesh: &Mesh) -> Vec<(usize, usize)> {
    let mut all = Mesh {
        corners: x.to_vec(),
        triangles: triangles.to_vec(),
    };
    all.add(mesh);
    let tree = MeshTree::new(&all);
    let mut found = Vec::new();
    for (i, t) in triangles.iter().enumerate() {
        let corners = t.map(|k| all.corners[k as usize]);
        let bounds = corners.iter().fold(Box3::EMPTY, |b, p| b.with(*p));
        tree.visit(&bounds, |j| {
            let j = j as usize;
            if j > i && cross(&all, i, j) {
                found.push((i, j));
            }
        });
    }
    found.sort_unstable();
    found
}

fn cross(mesh: &Mesh, i: usize, j: usize) -> bool {
    let through = |one: [u32; 3], two: [u32; 3]| {
        let at = |k: u32| mesh.corners[k as usize];
        (0..3).any(|e| {
            let (p, q) = (one[e], one[(e + 1) % 3]);
            // An edge that begins at the triangle touches it without passing.
            !two.contains(&p) && !two.contains(&q) && edge_crosses(at(p), at(q), two.map(at))
        })
    };
    let (one, two) = (mesh.triangles[i], mesh.triangles[j]);
    through(one, two) || through(two, one)
}

/// The triangles of the cloth that reach into a floor or a ball.
pub fn sunk(x: &[DVec3], triangles: &[[u32; 3]], colliders: &Colliders) -> Vec<usize> {
    let inside = |t: &[u32; 3]| {
        let corners = t.map(|k| x[k as usize]);
        colliders.exact.iter().any(|exact| match *exact {
            Exact::Floor(height) => corners.iter().any(|p| p.y < height),
            Exact::Ball { centre, radius } => {
                let [a, b, c] = corners;
                let quad = [centre, a, b, c];
                let w = super::collide::distance::point_triangle(quad);
                super::collide::distance::combine(w, quad).length() < radius
            }
        })
    };
    (0..triangles.len())
        .filter(|i| inside(&triangles[*i]))
        .collect()
}
