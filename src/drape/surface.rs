//! The cloth as a surface to be drawn: corners, smooth normals, where on the cloth each lies.

use std::fmt::Write;

use bevy::math::{DVec2, DVec3};

use super::collide::topology::Topology;

/// A surface of triangles.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Corners, m; y is up.
    pub positions: Vec<DVec3>,
    /// Unit normals, out of the front.
    pub normals: Vec<DVec3>,
    /// Place on the cloth: 0 to 1 across and down.
    pub uv: Vec<DVec2>,
    /// Triangles, anticlockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// The surface of particles at `x`.
    pub fn new(topology: &Topology, x: &[DVec3]) -> Self {
        let triangles = topology.triangles();
        let mut normals = vec![DVec3::ZERO; x.len()];
        for t in &triangles {
            let [a, b, c] = t.map(|i| x[i as usize]);
            // Longer than one by twice the area: large triangles count for more.
            let normal = (b - a).cross(c - a);
            for i in t {
                normals[*i as usize] += normal;
            }
        }
        for normal in &mut normals {
            *normal = normal.try_normalize().unwrap_or(DVec3::Y);
        }
        let (nx, ny) = topology.particles;
        let place = |i: usize| {
            let (x, y) = ((i % nx) as f64, (i / nx) as f64);
            DVec2::new(x / (nx.max(2) - 1) as f64, y / (ny.max(2) - 1) as f64)
        };
        Surface {
            positions: x.to_vec(),
            normals,
            uv: (0..x.len()).map(place).collect(),
            triangles,
        }
    }

    /// The same surface moved out of its front by `by` metres (or, negative, out of its back), and for
    /// the back turned over: the two faces of a cloth that has a thickness.
    pub fn offset(&self, by: f64) -> Self {
        let mut moved = self.clone();
        for (position, normal) in moved.positions.iter_mut().zip(&mut moved.normals) {
            *position += by * *normal;
            if by < 0.0 {
                *normal = -*normal;
            }
        }
        if by < 0.0 {
            for [_, b, c] in &mut moved.triangles {
                std::mem::swap(b, c);
            }
        }
        moved
    }

    /// Wavefront OBJ text, with texture places (their second coordinate runs up there) and normals.
    pub fn to_obj(&self) -> String {
        let mut text = String::new();
        for p in &self.positions {
            let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
        }
        for uv in &self.uv {
            let _ = writeln!(text, "vt {} {}", uv.x, 1.0 - uv.y);
        }
        for n in &self.normals {
            let _ = writeln!(text, "vn {} {} {}", n.x, n.y, n.z);
        }
        for t in &self.triangles {
            let [a, b, c] = t.map(|i| i + 1);
            let _ = writeln!(text, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}");
        }
        text
    }
}
