//! The cloth's surface, finer than its particles: what is drawn and exported.
//!
//! Between particles lies the Catmull–Rom surface through them (Catmull and Rom, *A class of local
//! interpolating splines*, 1974), so that folds and outlines are round. Its derivatives along weft and
//! warp give normals and tangents.

use bevy::math::{DVec2, DVec3};

/// A surface with all that a renderer needs of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Fine {
    /// Corners, m; y is up.
    pub positions: Vec<DVec3>,
    /// Unit normals, out of this side.
    pub normals: Vec<DVec3>,
    /// Unit tangents, to the right on the picture of this side.
    pub tangents: Vec<DVec3>,
    /// Place on the picture of this side: 0 to 1 across and down.
    pub uv: Vec<DVec2>,
    /// Triangles, anticlockwise seen from this side.
    pub triangles: Vec<[u32; 3]>,
}

/// The corners that a surface may have before it is no longer made finer.
const CORNERS: usize = 40_000;

/// Pieces that a cell of a grid of particles is divided into along each side.
pub fn pieces((nx, ny): (usize, usize)) -> usize {
    (1..=6)
        .rev()
        .find(|k| (nx * k) * (ny * k) <= CORNERS)
        .unwrap_or(1)
}

/// Weights of the four particles around a place `t` (0 to 1) between the middle two, and of their
/// slope there.
fn weights(t: f64) -> ([f64; 4], [f64; 4]) {
    let (t2, t3) = (t * t, t * t * t);
    let place = [
        0.5 * (-t + 2.0 * t2 - t3),
        0.5 * (2.0 - 5.0 * t2 + 3.0 * t3),
        0.5 * (t + 4.0 * t2 - 3.0 * t3),
        0.5 * (-t2 + t3),
    ];
    let slope = [
        0.5 * (-1.0 + 4.0 * t - 3.0 * t2),
        0.5 * (-10.0 * t + 9.0 * t2),
        0.5 * (1.0 + 8.0 * t - 9.0 * t2),
        0.5 * (-2.0 * t + 3.0 * t2),
    ];
    (place, slope)
}

/// The particle at (`x`, `y`), and beyond the edge the one that goes on as straight.
fn at(particles: &[DVec3], (nx, ny): (usize, usize), x: isize, y: isize) -> DVec3 {
    let inside = |i: isize, n: usize| i.clamp(0, n as isize - 1);
    let (cx, cy) = (inside(x, nx), inside(y, ny));
    let get = |x: isize, y: isize| particles[y as usize * nx + x as usize];
    let edge = get(cx, cy);
    if (cx, cy) == (x, y) {
        return edge;
    }
    let (ix, iy) = (inside(2 * cx - x, nx), inside(2 * cy - y, ny));
    2.0 * edge - get(ix, iy)
}

impl Fine {
    /// The front of cloth with `nx`×`ny` particles; only cells (x, y) where `is_there` are drawn.
    pub fn new(
        particles: &[DVec3],
        (nx, ny): (usize, usize),
        is_there: impl Fn(usize, usize) -> bool,
    ) -> Self {
        let k = pieces((nx, ny));
        let (fx, fy) = ((nx - 1) * k + 1, (ny - 1) * k + 1);
        let mut fine = Fine {
            positions: Vec::with_capacity(fx * fy),
            normals: Vec::with_capacity(fx * fy),
            tangents: Vec::with_capacity(fx * fy),
            uv: Vec::with_capacity(fx * fy),
            triangles: Vec::new(),
        };
        // Where along one side of the grid: the particle before, and how far from it.
        let along = |i: usize, n: usize| {
            let before = (i / k).min(n - 2);
            (before as isize, (i - before * k) as f64 / k as f64)
        };
        // Curves through the rows at every column, then through those down the column.
        let (mut rows, mut slopes) = (Vec::new(), Vec::new());
        for y in -1..=ny as isize {
            for i in 0..fx {
                let (x, t) = along(i, nx);
                let (w, dw) = weights(t);
                let four = [-1, 0, 1, 2].map(|d| at(particles, (nx, ny), x + d, y));
                rows.push(mix(w, four));
                slopes.push(mix(dw, four));
            }
        }
        for j in 0..fy {
            let (y, t) = along(j, ny);
            let (w, dw) = weights(t);
            for i in 0..fx {
                let line = |of: &[DVec3]| [0, 1, 2, 3].map(|d| of[(y as usize + d) * fx + i]);
                let (across, down) = (mix(w, line(&slopes)), mix(dw, line(&rows)));
                fine.positions.push(mix(w, line(&rows)));
                let normal = down.cross(across).try_normalize().unwrap_or(DVec3::Y);
                fine.normals.push(normal);
                let tangent = (across - across.dot(normal) * normal).try_normalize();
                fine.tangents
                    .push(tangent.unwrap_or_else(|| normal.any_orthonormal_vector()));
                fine.uv.push(DVec2::new(
                    i as f64 / (fx - 1) as f64,
                    j as f64 / (fy - 1) as f64,
                ));
            }
        }
        for j in 0..fy - 1 {
            for i in 0..fx - 1 {
                if is_there(i / k, j / k) {
                    let a = (j * fx + i) as u32;
                    let (b, c, d) = (a + 1, a + fx as u32, a + fx as u32 + 1);
                    fine.triangles.extend([[a, c, b], [b, c, d]]);
                }
            }
        }
        fine
    }

    /// The same surface moved out of its side by `by` metres.
    pub fn moved_out(mut self, by: f64) -> Self {
        for (position, normal) in self.positions.iter_mut().zip(&self.normals) {
            *position += by * *normal;
        }
        self
    }

    /// The other side: what was left on the picture is right.
    pub fn turned_over(&self) -> Self {
        Fine {
            positions: self.positions.clone(),
            normals: self.normals.iter().map(|n| -*n).collect(),
            tangents: self.tangents.iter().map(|t| -*t).collect(),
            uv: self
                .uv
                .iter()
                .map(|uv| DVec2::new(1.0 - uv.x, uv.y))
                .collect(),
            triangles: self
                .triangles
                .iter()
                .map(|[a, b, c]| [*a, *c, *b])
                .collect(),
        }
    }
}

fn mix(w: [f64; 4], v: [DVec3; 4]) -> DVec3 {
    w[0] * v[0] + w[1] * v[1] + w[2] * v[2] + w[3] * v[3]
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRID: (usize, usize) = (7, 5);

    fn waves() -> Vec<DVec3> {
        let place = |i: usize| {
            let (x, y) = ((i % 7) as f64, (i / 7) as f64);
            DVec3::new(x, -y, libm::sin(0.9 * x) * libm::cos(0.7 * y))
        };
        (0..35).map(place).collect()
    }

    #[test]
    fn the_surface_goes_through_every_particle() {
        let particles = waves();
        let fine = Fine::new(&particles, GRID, |_, _| true);
        let k = pieces(GRID);
        let fx = 6 * k + 1;
        for (i, particle) in particles.iter().enumerate() {
            let at = fine.positions[(i / 7) * k * fx + (i % 7) * k];
            assert!(at.distance(*particle) < 1e-12);
        }
    }

    #[test]
    fn flat_cloth_stays_flat_and_even_up_to_its_edges() {
        let place = |i: usize| DVec3::new((i % 7) as f64, -((i / 7) as f64), 0.5);
        let flat: Vec<_> = (0..35).map(place).collect();
        let fine = Fine::new(&flat, GRID, |_, _| true);
        for (i, p) in fine.positions.iter().enumerate() {
            let expected = DVec3::new(6.0 * fine.uv[i].x, -4.0 * fine.uv[i].y, 0.5);
            assert!(p.distance(expected) < 1e-12);
            assert!(fine.normals[i].distance(DVec3::Z) < 1e-12);
            assert!(fine.tangents[i].distance(DVec3::X) < 1e-12);
        }
    }

    #[test]
    fn triangles_of_either_side_turn_the_way_its_normals_point() {
        let front = Fine::new(&waves(), GRID, |_, _| true);
        for side in [front.clone(), front.turned_over()] {
            for t in &side.triangles {
                let [a, b, c] = t.map(|i| side.positions[i as usize]);
                let normal = side.normals[t[0] as usize];
                assert!((b - a).cross(c - a).dot(normal) > 0.0);
            }
        }
    }

    #[test]
    fn cells_that_are_not_there_have_no_triangles() {
        let whole = Fine::new(&waves(), GRID, |_, _| true).triangles.len();
        let holed = Fine::new(&waves(), GRID, |x, y| (x, y) != (2, 2));
        let k = pieces(GRID);
        assert_eq!(holed.triangles.len(), whole - 2 * k * k);
    }
}
