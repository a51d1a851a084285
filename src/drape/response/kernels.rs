//! The links of one direction that begin in one row, all at once.

use super::super::lattice::DIRECTIONS;
use super::super::links::{Pull, bend, spring, stretch, stretch_ahead};
use super::super::rows::Rows;
use super::BLOCK;

/// The ends of all links of one kind that begin in one row.
#[derive(Clone, Copy)]
pub(super) struct Ends<'a> {
    a: [&'a [f64]; 3],
    b: [&'a [f64]; 3],
}

impl<'a> Ends<'a> {
    pub fn new(field: &'a Rows, y: usize, direction: usize, hops: isize) -> Self {
        let (dx, dy) = DIRECTIONS[direction];
        Ends {
            a: field.lines(y as isize, 0, 0),
            b: field.lines(y as isize + hops * dy, 0, hops * dx),
        }
    }

    /// From the first end of link `i` to the second, after the slices have been cut to one length.
    #[inline(always)]
    fn across(&self, i: usize) -> [f64; 3] {
        [
            self.b[0][i] - self.a[0][i],
            self.b[1][i] - self.a[1][i],
            self.b[2][i] - self.a[2][i],
        ]
    }

    #[inline(always)]
    fn cut(self, n: usize) -> Self {
        Ends {
            a: [&self.a[0][..n], &self.a[1][..n], &self.a[2][..n]],
            b: [&self.b[0][..n], &self.b[1][..n], &self.b[2][..n]],
        }
    }
}

/// Length of a vector, 1/length, and direction; of none, no direction.
#[inline(always)]
fn polar(d: [f64; 3]) -> (f64, f64, [f64; 3]) {
    let r = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
    let per = 1.0 / r.max(1e-150);
    (r, per, [d[0] * per, d[1] * per, d[2] * per])
}

/// along·n nᵀ + all·I.
#[inline(always)]
fn matrix(n: [f64; 3], along: f64, all: f64) -> [f64; BLOCK] {
    let [x, y, z] = n;
    let (ax, ay, az) = (along * x, along * y, along * z);
    [
        ax * x + all,
        ay * y + all,
        az * z + all,
        ax * y,
        ax * z,
        ay * z,
    ]
}

#[multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
pub(super) fn bend_row<const BLOCKS_TOO: bool>(
    ends: Ends,
    (k_b, c_b): (&[f64], &[f64]),
    length: f64,
    alpha: f64,
    force: [&mut [f64]; 3],
    push: &mut [f64],
    block: [&mut [f32]; BLOCK],
) {
    let n = push.len();
    let (ends, k_b, c_b) = (ends.cut(n), &k_b[..n], &c_b[..n]);
    let [fx, fy, fz] = force;
    let force = [&mut fx[..n], &mut fy[..n], &mut fz[..n]];
    let [xx, yy, zz, xy, xz, yz] = block;
    let block = [
        &mut xx[..n],
        &mut yy[..n],
        &mut zz[..n],
        &mut xy[..n],
        &mut xz[..n],
        &mut yz[..n],
    ];
    for i in 0..n {
        let (r, _, direction) = polar(ends.across(i));
        let Pull {
            force: f,
            stiffness,
        } = bend(r, length, k_b[i], c_b[i]);
        for c in 0..3 {
            force[c][i] = f * direction[c];
        }
        push[i] = -f;
        if BLOCKS_TOO {
            let block_of = matrix(direction, alpha * stiffness, alpha * f / length);
            for c in 0..BLOCK {
                block[c][i] = block_of[c] as f32;
            }
        }
    }
}

#[multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
pub(super) fn spring_row(
    ends: Ends,
    k: &[f64],
    length: f64,
    alpha: f64,
    force: [&mut [f64]; 3],
    block: [&mut [f32]; BLOCK],
) {
    let n = k.len();
    let ends = ends.cut(n);
    let [fx, fy, fz] = force;
    let force = [&mut fx[..n], &mut fy[..n], &mut fz[..n]];
    let [xx, yy, zz, xy, xz, yz] = block;
    let block = [
        &mut xx[..n],
        &mut yy[..n],
        &mut zz[..n],
        &mut xy[..n],
        &mut xz[..n],
        &mut yz[..n],
    ];
    for i in 0..n {
        let (r, per, direction) = polar(ends.across(i));
        let Pull {
            force: f,
            stiffness,
        } = spring(r, length, k[i]);
        for c in 0..3 {
            force[c][i] = f * direction[c];
        }
        let across = f.max(0.0) * per;
        let block_of = matrix(direction, alpha * (stiffness - across), alpha * across);
        for c in 0..BLOCK {
            block[c][i] = block_of[c] as f32;
        }
    }
}

/// What the type 1 links of a direction have in common.
#[derive(Clone, Copy)]
pub(super) struct Stretch {
    pub length: f64,
    pub damping: f64,
    pub alpha: f64,
    pub beta: f64,
}

#[multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
pub(super) fn stretch_row<const CHOI: bool, const BLOCKS_TOO: bool>(
    [ends, speeds, coming]: [Ends; 3],
    k: &[f64],
    pushes: [&[f64]; 2],
    law: Stretch,
    force: [&mut [f64]; 3],
    block: [&mut [f32]; BLOCK],
) {
    let n = k.len();
    let (ends, speeds, coming) = (ends.cut(n), speeds.cut(n), coming.cut(n));
    let pushes = [&pushes[0][..n], &pushes[1][..n]];
    let [fx, fy, fz] = force;
    let force = [&mut fx[..n], &mut fy[..n], &mut fz[..n]];
    let [xx, yy, zz, xy, xz, yz] = block;
    let block = [
        &mut xx[..n],
        &mut yy[..n],
        &mut zz[..n],
        &mut xy[..n],
        &mut xz[..n],
        &mut yz[..n],
    ];
    let per_length = 1.0 / law.length;
    for i in 0..n {
        let (r, per, direction) = polar(ends.across(i));
        let pull = if CHOI && BLOCKS_TOO {
            let by = coming.across(i);
            let closing = by[0] * direction[0] + by[1] * direction[1] + by[2] * direction[2];
            stretch_ahead(r, r + closing, law.length, k[i])
        } else if CHOI {
            stretch(r, law.length, k[i])
        } else {
            spring(r, law.length, k[i])
        };
        let k_d = law.damping * k[i];
        let speed = speeds.across(i);
        for c in 0..3 {
            force[c][i] = pull.force * direction[c] + k_d * speed[c];
        }
        if BLOCKS_TOO {
            // A type 2 link is as long as two of these: its F/r is ½·F/length.
            let pushed = pushes[0][i] + pushes[1][i];
            // Ghosts at the end of a row look into the next plane.
            let pushed = if k[i] > 0.0 { pushed } else { 0.0 };
            let across = (pull.force - pushed).max(0.0) * per;
            let bending = pushed * per_length;
            let all = law.alpha * (across + bending) + law.beta * k_d;
            let along = law.alpha * (pull.stiffness - across);
            let block_of = matrix(direction, along, all);
            for c in 0..BLOCK {
                block[c][i] = block_of[c] as f32;
            }
        }
    }
}

#[multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
pub(super) fn add_row(out: &mut [&mut [f64]; 3], here: [&[f64]; 3], there: [&[f64]; 3]) {
    for ((out, here), there) in out.iter_mut().zip(here).zip(there) {
        let n = out.len();
        let (here, there) = (&here[..n], &there[..n]);
        for i in 0..n {
            out[i] += here[i] - there[i];
        }
    }
}
