//! Preconditioned conjugate gradients (Hestenes and Stiefel 1952) for the systems of implicit steps.

use super::rows::{Rows, each, each2, sum};
use super::system::{System, dot};

/// What turns a residual into a guess of the error: z = P⁻¹ r.
pub trait Precondition {
    /// z = P⁻¹ r; returns r·z.
    fn apply(&mut self, r: &Rows<f32>, z: &mut Rows<f32>) -> f64;
}

/// What conjugate gradients work with.
#[derive(Debug, Clone)]
pub struct Work {
    /// b − A·u.
    pub r: Rows<f32>,
    z: Rows<f32>,
    p: Rows<f32>,
    q: Rows<f32>,
}

/// When a system counts as solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goal {
    /// The share of √(r·P⁻¹r) that may be left.
    pub tolerance: f64,
    /// As much √(r·P⁻¹r) as need not be seen: of less, no share is asked for.
    pub least: f64,
    /// The most iterations.
    pub iterations: usize,
}

/// How a system was solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solved {
    /// Iterations done.
    pub iterations: usize,
    /// By what factor √(r·P⁻¹r) fell.
    pub residual: f64,
}

impl Work {
    /// Room for `nx` × `ny` particles.
    pub fn new((nx, ny): (usize, usize)) -> Self {
        let zero = Rows::zero(nx, ny, 3);
        Work {
            r: zero.clone(),
            z: zero.clone(),
            p: zero.clone(),
            q: zero,
        }
    }

    /// Sets `u` to the best sum of multiples of two guesses, and takes what it explains off `r`.
    pub fn begin(&mut self, system: &System, guesses: [&Rows<f32>; 2], u: &mut Rows<f32>) {
        u.all_mut().fill(0.0);
        let Work { r, z, p, q } = self;
        let (aa, bb) = (system.apply(guesses[0], p), system.apply(guesses[1], q));
        let mut product = |a: &Rows<f32>, b: &Rows<f32>| {
            sum(z, |y, _| {
                let (a, b) = (
                    a.lines::<3>(y as isize, 0, 0),
                    b.lines::<3>(y as isize, 0, 0),
                );
                a.into_iter().zip(b).map(|(a, b)| dot(a, b)).sum()
            })
        };
        let ab = product(guesses[0], q);
        let (ra, rb) = (product(guesses[0], r), product(guesses[1], r));
        let determinant = aa * bb - ab * ab;
        let (a, b) = if determinant > 1e-4 * aa * bb {
            (
                (ra * bb - rb * ab) / determinant,
                (rb * aa - ra * ab) / determinant,
            )
        } else if aa > 0.0 {
            (ra / aa, 0.0)
        } else {
            (0.0, 0.0)
        };
        for (by, guess, image) in [(a, guesses[0], &*p), (b, guesses[1], &*q)] {
            if by != 0.0 {
                advance(u, r, guess, image, by as f32);
            }
        }
    }

    /// Solves A·u = b from the `u` that there is, `r` holding b − A·u, until √(r·P⁻¹r) has fallen by
    /// `goal.tolerance`, or to that share of `goal.least`, or `goal.iterations` are done.
    pub fn solve(
        &mut self,
        system: &System,
        precondition: &mut impl Precondition,
        u: &mut Rows<f32>,
        goal: Goal,
    ) -> Solved {
        let Work { r, z, p, q } = self;
        let mut rz = precondition.apply(r, z);
        p.clone_from(z);
        let begin = rz;
        let enough = goal.tolerance * goal.tolerance * begin.max(goal.least * goal.least);
        let mut iterations = 0;
        while iterations < goal.iterations && rz > enough && rz > 0.0 {
            let pq = system.apply(p, q);
            if pq.is_nan() || pq <= 0.0 {
                break;
            }
            let alpha = rz / pq;
            advance(u, r, p, q, alpha as f32);
            let next = precondition.apply(r, z);
            let beta = next / rz;
            rz = next;
            renew(p, z, beta as f32);
            iterations += 1;
        }
        Solved {
            iterations,
            residual: if begin > 0.0 {
                (rz / begin).max(0.0).sqrt()
            } else {
                0.0
            },
        }
    }
}

/// u += a·p, r −= a·q.
fn advance(u: &mut Rows<f32>, r: &mut Rows<f32>, p: &Rows<f32>, q: &Rows<f32>, a: f32) {
    each2(u, r, |y, u, r| {
        let (y, u, r) = (y as isize, u.planes().take(), r.planes().take());
        along_row(u, p.lines(y, 0, 0), a);
        along_row(r, q.lines(y, 0, 0), -a);
    });
}

/// p = z + b·p.
fn renew(p: &mut Rows<f32>, z: &Rows<f32>, b: f32) {
    each(p, |y, p| {
        renew_row(p.planes().take(), z.lines(y as isize, 0, 0), b)
    });
}

#[multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn along_row(u: [&mut [f32]; 3], p: [&[f32]; 3], a: f32) {
    for (u, p) in u.into_iter().zip(p) {
        for (u, p) in u.iter_mut().zip(p) {
            *u += a * p;
        }
    }
}

#[multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn renew_row(p: [&mut [f32]; 3], z: [&[f32]; 3], b: f32) {
    for (p, z) in p.into_iter().zip(z) {
        for (p, z) in p.iter_mut().zip(z) {
            *p = z + b * *p;
        }
    }
}

/// Each particle by itself: P is the block diagonal of A (block Jacobi).
#[derive(Debug, Clone)]
pub struct Particles {
    inverse: Rows,
}

impl Particles {
    /// Room for `nx` × `ny` particles.
    pub fn new((nx, ny): (usize, usize)) -> Self {
        Particles {
            inverse: Rows::zero(nx, ny, 6),
        }
    }

    /// Inverts the block diagonal of a system.
    pub fn factor(&mut self, system: &System) {
        system.diagonal(&mut self.inverse);
        each(&mut self.inverse, |y, row| {
            let [free] = system.mass.lines(y as isize, 1, 0);
            invert_row(row.planes().take(), free);
        });
    }
}

#[multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn invert_row(m: [&mut [f64]; 6], free: &[f32]) {
    let n = free.len();
    let [xx, yy, zz, xy, xz, yz] = m.map(|line| &mut line[..n]);
    for i in 0..n {
        let inverse = invert([xx[i], yy[i], zz[i], xy[i], xz[i], yz[i]]);
        let [a, b, c, d, e, f] = inverse.map(|value| value * f64::from(free[i]));
        (xx[i], yy[i], zz[i]) = (a, b, c);
        (xy[i], xz[i], yz[i]) = (d, e, f);
    }
}

/// The inverse of a symmetric matrix; of one without (the ghosts'), zero.
#[inline(always)]
pub fn invert([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> [f64; 6] {
    let (a, b, c) = (yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy);
    let determinant = xx * a + xy * b + xz * c;
    let per = if determinant > 0.0 {
        1.0 / determinant
    } else {
        0.0
    };
    [
        a * per,
        (xx * zz - xz * xz) * per,
        (xx * yy - xy * xy) * per,
        b * per,
        c * per,
        (xy * xz - xx * yz) * per,
    ]
}

impl Precondition for Particles {
    fn apply(&mut self, r: &Rows<f32>, z: &mut Rows<f32>) -> f64 {
        sum(z, |y, z| {
            let y = y as isize;
            particles_row(
                z.planes().take(),
                r.lines(y, 0, 0),
                self.inverse.lines(y, 0, 0),
            )
        })
    }
}

#[multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn particles_row(z: [&mut [f32]; 3], r: [&[f32]; 3], m: [&[f64]; 6]) -> f64 {
    let n = z[0].len();
    let [zx, zy, zz] = z.map(|line| &mut line[..n]);
    let [rx, ry, rz] = r.map(|line| &line[..n]);
    let m = m.map(|line| &line[..n]);
    for i in 0..n {
        let m = m.map(|line| line[i] as f32);
        zx[i] = m[0] * rx[i] + m[3] * ry[i] + m[4] * rz[i];
        zy[i] = m[3] * rx[i] + m[1] * ry[i] + m[5] * rz[i];
        zz[i] = m[4] * rx[i] + m[5] * ry[i] + m[2] * rz[i];
    }
    dot(zx, rx) + dot(zy, ry) + dot(zz, rz)
}
