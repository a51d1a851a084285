//! The closest points of a particle and a triangle, and of two edges.
//!
//! Both are given as the shares of the four corners in the vector between the closest points: x = Σ wᵢ·xᵢ
//! points from one to the other, and its length is their distance.

use bevy::math::DVec3;

/// A pair of things that may collide, by the numbers of their corners.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Pair {
    /// A particle (first) and a triangle.
    PointTriangle([u32; 4]),
    /// Two edges, two corners each.
    EdgeEdge([u32; 4]),
}

impl Pair {
    /// The four corners.
    pub fn corners(self) -> [u32; 4] {
        match self {
            Pair::PointTriangle(corners) | Pair::EdgeEdge(corners) => corners,
        }
    }

    /// The four corners' shares in the vector between the closest points.
    pub fn weights(self, x: [DVec3; 4]) -> [f64; 4] {
        match self {
            Pair::PointTriangle(_) => point_triangle(x),
            Pair::EdgeEdge(_) => edge_edge(x),
        }
    }
}

/// Σ wᵢ·xᵢ.
pub fn combine(w: [f64; 4], x: [DVec3; 4]) -> DVec3 {
    (w[0] * x[0] + w[1] * x[1]) + (w[2] * x[2] + w[3] * x[3])
}

/// Where between `a` and `b` the point closest to `p` lies, 0 to 1.
fn along(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let ab = b - a;
    let length = ab.length_squared();
    if length > 0.0 {
        ((p - a).dot(ab) / length).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// Particle `x[0]` and the triangle of the rest: [1, −a, −b, −c].
///
/// The plane's closest point if it lies inside, else the best of the three edges.
pub fn point_triangle([p, a, b, c]: [DVec3; 4]) -> [f64; 4] {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (bb, bc, cc) = (ab.length_squared(), ab.dot(ac), ac.length_squared());
    let (pb, pc) = (ap.dot(ab), ap.dot(ac));
    let determinant = bb * cc - bc * bc;
    if determinant > 1e-14 * bb * cc {
        let v = (pb * cc - pc * bc) / determinant;
        let w = (pc * bb - pb * bc) / determinant;
        if v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
            return [1.0, v + w - 1.0, -v, -w];
        }
    }
    let on = [along(p, a, b), along(p, b, c), along(p, c, a)];
    let candidates = [
        [1.0, on[0] - 1.0, -on[0], 0.0],
        [1.0, 0.0, on[1] - 1.0, -on[1]],
        [1.0, -on[2], 0.0, on[2] - 1.0],
    ];
    nearest(candidates, [p, a, b, c])
}

/// The edges `x[0]`–`x[1]` and `x[2]`–`x[3]`: [1 − s, s, t − 1, −t].
///
/// The closest points of the two lines if both lie inside, else the best of the four ends against the
/// other edge.
pub fn edge_edge(x: [DVec3; 4]) -> [f64; 4] {
    let [a, b, c, d] = x;
    let (u, v, w) = (b - a, d - c, a - c);
    let (uu, uv, vv) = (u.length_squared(), u.dot(v), v.length_squared());
    let (uw, vw) = (u.dot(w), v.dot(w));
    let determinant = uu * vv - uv * uv;
    if determinant > 1e-12 * uu * vv {
        let s = (uv * vw - vv * uw) / determinant;
        let t = (uu * vw - uv * uw) / determinant;
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            return [1.0 - s, s, t - 1.0, -t];
        }
    }
    let (ta, tb) = (along(a, c, d), along(b, c, d));
    let (sc, sd) = (along(c, a, b), along(d, a, b));
    let candidates = [
        [1.0, 0.0, ta - 1.0, -ta],
        [0.0, 1.0, tb - 1.0, -tb],
        [1.0 - sc, sc, -1.0, 0.0],
        [1.0 - sd, sd, 0.0, -1.0],
    ];
    nearest(candidates, x)
}

fn nearest<const N: usize>(candidates: [[f64; 4]; N], x: [DVec3; 4]) -> [f64; 4] {
    let mut best = ([0.0; 4], f64::INFINITY);
    for w in candidates {
        let distance = combine(w, x).length_squared();
        if distance < best.1 {
            best = (w, distance);
        }
    }
    best.0
}
