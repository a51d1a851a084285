//! A preconditioner that solves every yarn of the cloth by itself: z = (X⁻¹ + Y⁻¹) r.
//!
//! X holds the diagonal of the whole system and the links along the weft, Y those along the warp. A
//! woven cloth is a hundred times stiffer along its yarns than in any other way (shear, bending), and
//! what is far apart on a yarn is felt within one step; conjugate gradients alone carry it on by two
//! particles an iteration. Each yarn is a block-pentadiagonal matrix, factored as L·S·Lᵀ:
//!
//! S_i = D_i − P_{i−1} W_{i−1}ᵀ − Q_{i−2} F_{i−2},  W_i = E_i − F_{i−1} P_{i−1}ᵀ,
//! P_i = W_i S_i⁻¹,  Q_i = F_i S_i⁻¹
//!
//! with E_i, F_i the blocks to the next particle and the one after. Sixteen yarns lie side by side
//! and are solved in step.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::pcg::{Precondition, invert};
use super::response::{BLOCK, Response};
use super::rows::{Number, Rows, sum};
use super::system::{SYMMETRIC, System, dot};

/// Yarns side by side.
const LANES: usize = 16;

type Lanes = [f32; LANES];
type Doubles = [f64; LANES];

/// S⁻¹, P and Q of sixteen particles side by side.
const FACTORS: usize = BLOCK + 9 + 9;

/// Sixteen yarns and their factors.
#[derive(Debug, Clone)]
struct Bundle {
    /// Weft (yarns along x) or warp.
    along_x: bool,
    /// The first of the sixteen yarns.
    first: usize,
    factors: Vec<[Lanes; FACTORS]>,
    solution: Vec<[Lanes; 3]>,
}

/// The yarns of a cloth as a preconditioner.
#[derive(Debug, Clone)]
pub struct Yarns {
    diagonal: Rows,
    bundles: Vec<Bundle>,
    /// How many of them are weft.
    weft: usize,
}

impl Yarns {
    /// Room for `nx` × `ny` particles.
    pub fn new((nx, ny): (usize, usize)) -> Self {
        let bundle = |along_x: bool, first: usize| {
            let length = if along_x { nx } else { ny };
            Bundle {
                along_x,
                first,
                factors: vec![[[0.0; LANES]; FACTORS]; length],
                solution: vec![[[0.0; LANES]; 3]; length],
            }
        };
        let weft = (0..ny).step_by(LANES).map(|first| bundle(true, first));
        let warp = (0..nx).step_by(LANES).map(|first| bundle(false, first));
        let bundles: Vec<_> = weft.chain(warp).collect();
        Yarns {
            diagonal: Rows::zero(nx, ny, BLOCK),
            bundles,
            weft: ny.div_ceil(LANES),
        }
    }

    /// Factors the yarns of a system.
    pub fn factor(&mut self, system: &System) {
        system.diagonal(&mut self.diagonal);
        let diagonal = &self.diagonal;
        self.bundles
            .par_iter_mut()
            .for_each(|bundle| bundle.factor(diagonal, system));
    }
}

impl Precondition for Yarns {
    fn apply(&mut self, r: &Rows<f32>, z: &mut Rows<f32>) -> f64 {
        self.bundles
            .par_iter_mut()
            .for_each(|bundle| bundle.solve(r));
        let (weft, warp) = self.bundles.split_at(self.weft);
        sum(z, |y, z| {
            let z: [&mut [f32]; 3] = z.planes().take();
            let r: [&[f32]; 3] = r.lines(y as isize, 0, 0);
            let (weft, lane) = (&weft[y / LANES].solution, y % LANES);
            let mut sum = 0.0;
            for (c, z) in z.into_iter().enumerate() {
                for (z, bundle) in z.chunks_exact_mut(LANES).zip(warp) {
                    z.copy_from_slice(&bundle.solution[y][c]);
                }
                for (z, along) in z.iter_mut().zip(weft) {
                    *z += along[c][lane];
                }
                sum += dot(z, r[c]);
            }
            sum
        })
    }
}

/// Numbers side by side: of many rows at column `i`, or of many columns in row `i`.
#[inline(always)]
fn load<T: Number>(
    rows: &Rows<T>,
    along_x: bool,
    first: usize,
    i: usize,
    plane: usize,
) -> [T; LANES] {
    let mut lanes = [T::default(); LANES];
    if along_x {
        for (lane, value) in lanes.iter_mut().enumerate() {
            if first + lane < rows.ny {
                *value = rows.get(i, first + lane, plane);
            }
        }
    } else {
        let [line] = rows.lines(i as isize, plane, 0);
        lanes.copy_from_slice(&line[first..first + LANES]);
    }
    lanes
}

type Symmetric = [Doubles; BLOCK];
type Full = [Doubles; 9];

impl Bundle {
    fn factor(&mut self, diagonal: &Rows, system: &System) {
        let Response {
            stretch_blocks: stretch,
            bend_blocks: bend,
            ..
        } = system.links;
        let kind = if self.along_x { 0 } else { BLOCK };
        let place = (self.along_x, self.first);
        factor(
            place,
            diagonal,
            system.mass,
            (stretch, bend, kind),
            &mut self.factors,
        );
    }

    fn solve(&mut self, r: &Rows<f32>) {
        if self.along_x {
            for lane in 0..LANES.min(r.ny - self.first) {
                let lines: [&[f32]; 3] = r.lines((self.first + lane) as isize, 0, 0);
                let [x, y, z] = lines;
                for (((out, x), y), z) in self.solution.iter_mut().zip(x).zip(y).zip(z) {
                    (out[0][lane], out[1][lane], out[2][lane]) = (*x, *y, *z);
                }
            }
        } else {
            for (i, out) in self.solution.iter_mut().enumerate() {
                let lines: [&[f32]; 3] = r.lines(i as isize, 0, 0);
                for (out, line) in out.iter_mut().zip(lines) {
                    out.copy_from_slice(&line[self.first..self.first + LANES]);
                }
            }
        }
        Arch::new().dispatch(Solve {
            factors: &self.factors,
            solution: &mut self.solution,
        });
    }
}

#[multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn factor(
    (along_x, first): (bool, usize),
    diagonal: &Rows,
    mass: &Rows<f32>,
    (stretch, bend, kind): (&Rows<f32>, &Rows<f32>, usize),
    factors: &mut [[Lanes; FACTORS]],
) {
    // Of the particle before: F, P, and what the next two diagonals lose.
    let mut f_before: Symmetric = [[0.0; LANES]; BLOCK];
    let mut p_before: Full = [[0.0; LANES]; 9];
    let (mut loss, mut next_loss) = (f_before, f_before);
    for (i, out) in factors.iter_mut().enumerate() {
        let d: Symmetric = std::array::from_fn(|c| load(diagonal, along_x, first, i, c));
        let e: Symmetric =
            std::array::from_fn(|c| load(stretch, along_x, first, i, kind + c).map(f64::from));
        let f: Symmetric =
            std::array::from_fn(|c| load(bend, along_x, first, i, kind + c).map(f64::from));
        let free = load(mass, along_x, first, i, 1);
        let (mut later, mut p, mut q) = (f_before, p_before, p_before);
        for l in 0..LANES {
            let s = invert(std::array::from_fn(|c| d[c][l] - loss[c][l]));
            let s = s.map(|value| value * f64::from(free[l]));
            let mut w = [0.0; 9];
            // Links' blocks are the off-diagonal with its sign changed.
            for row in 0..3 {
                for column in 0..3 {
                    let mut value = -e[SYMMETRIC[row][column]][l];
                    for k in 0..3 {
                        value += f_before[SYMMETRIC[row][k]][l] * p_before[column * 3 + k][l];
                    }
                    w[row * 3 + column] = value;
                }
            }
            for row in 0..3 {
                for column in 0..3 {
                    let (mut of_p, mut of_q) = (0.0, 0.0);
                    for k in 0..3 {
                        of_p += w[row * 3 + k] * s[SYMMETRIC[k][column]];
                        of_q -= f[SYMMETRIC[row][k]][l] * s[SYMMETRIC[k][column]];
                    }
                    p[row * 3 + column][l] = of_p;
                    q[row * 3 + column][l] = of_q;
                }
            }
            for row in 0..3 {
                for column in row..3 {
                    let (mut of_next, mut of_later) = (next_loss[SYMMETRIC[row][column]][l], 0.0);
                    for k in 0..3 {
                        of_next += p[row * 3 + k][l] * w[column * 3 + k];
                        of_later -= q[row * 3 + k][l] * f[SYMMETRIC[k][column]][l];
                    }
                    loss[SYMMETRIC[row][column]][l] = of_next;
                    later[SYMMETRIC[row][column]][l] = of_later;
                }
            }
            for c in 0..BLOCK {
                out[c][l] = s[c] as f32;
            }
        }
        for c in 0..9 {
            for l in 0..LANES {
                out[BLOCK + c][l] = p[c][l] as f32;
                out[BLOCK + 9 + c][l] = q[c][l] as f32;
            }
        }
        next_loss = later;
        f_before = f;
        p_before = p;
    }
}

/// The solution of sixteen factored yarns, in two sweeps; `solution` holds the right-hand side.
struct Solve<'a> {
    factors: &'a [[Lanes; FACTORS]],
    solution: &'a mut [[Lanes; 3]],
}

impl WithSimd for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Solve { factors, solution } = self;
        let n = solution.len();
        let factors = &factors[..n];
        let zero = [simd.splat_f32s(0.0); 3];
        for part in 0..LANES / S::F32_LANES {
            // What the particles before explain: P_{i−1}·y_{i−1}, Q_{i−2}·y_{i−2}, Q_{i−1}·y_{i−1}.
            let (mut one, mut two, mut two_next) = (zero, zero, zero);
            for (f, out) in factors.iter().zip(solution.iter_mut()) {
                let mut y = zero;
                for c in 0..3 {
                    let out = &mut S::as_mut_simd_f32s(&mut out[c]).0[part];
                    y[c] = simd.sub_f32s(*out, simd.add_f32s(one[c], two[c]));
                    *out = y[c];
                }
                two = two_next;
                for c in 0..3 {
                    let (p, q) = (BLOCK + 3 * c, BLOCK + 9 + 3 * c);
                    one[c] = times(
                        simd,
                        [
                            at::<S>(f, p, part),
                            at::<S>(f, p + 1, part),
                            at::<S>(f, p + 2, part),
                        ],
                        y,
                    );
                    two_next[c] = times(
                        simd,
                        [
                            at::<S>(f, q, part),
                            at::<S>(f, q + 1, part),
                            at::<S>(f, q + 2, part),
                        ],
                        y,
                    );
                }
            }
            let (mut one, mut two) = (zero, zero);
            for (f, out) in factors.iter().zip(solution.iter_mut()).rev() {
                let y = [
                    at::<S>(out, 0, part),
                    at::<S>(out, 1, part),
                    at::<S>(out, 2, part),
                ];
                let mut x = zero;
                for c in 0..3 {
                    let (p, q) = (BLOCK + c, BLOCK + 9 + c);
                    let s = times(
                        simd,
                        [
                            at::<S>(f, SYMMETRIC[c][0], part),
                            at::<S>(f, SYMMETRIC[c][1], part),
                            at::<S>(f, SYMMETRIC[c][2], part),
                        ],
                        y,
                    );
                    let p = times(
                        simd,
                        [
                            at::<S>(f, p, part),
                            at::<S>(f, p + 3, part),
                            at::<S>(f, p + 6, part),
                        ],
                        one,
                    );
                    let q = times(
                        simd,
                        [
                            at::<S>(f, q, part),
                            at::<S>(f, q + 3, part),
                            at::<S>(f, q + 6, part),
                        ],
                        two,
                    );
                    x[c] = simd.sub_f32s(s, simd.add_f32s(p, q));
                    S::as_mut_simd_f32s(&mut out[c]).0[part] = x[c];
                }
                two = one;
                one = x;
            }
        }
    }
}

/// A vector of lanes.
#[inline(always)]
fn at<S: Simd>(lanes: &[Lanes], i: usize, part: usize) -> S::f32s {
    S::as_simd_f32s(&lanes[i]).0[part]
}

/// One row of a matrix times a vector.
#[inline(always)]
fn times<S: Simd>(simd: S, row: [S::f32s; 3], y: [S::f32s; 3]) -> S::f32s {
    let ab = simd.mul_add_f32s(row[1], y[1], simd.mul_f32s(row[0], y[0]));
    simd.mul_add_f32s(row[2], y[2], ab)
}
