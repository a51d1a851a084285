//! The linear system of an implicit step, A·u = b with A = M + E + Σ blocks (model section 8), and
//! its solution by preconditioned conjugate gradients (Hestenes and Stiefel 1952).
//!
//! A is never written out: a particle needs its mass, its own block E (contact, drag) and the blocks
//! of the sixteen links around it. Particles that are held fixed keep u = 0.

use pulp::{Arch, Simd, WithSimd};

use super::contact::{self, Contact};
use super::lattice::DIRECTIONS;
use super::response::{BLOCK, Response};
use super::rows::{Rows, VECTOR, each, sum};

/// Where entry (row, column) of a symmetric matrix lies.
pub const SYMMETRIC: [[usize; 3]; 3] = [[0, 3, 4], [3, 1, 5], [4, 5, 2]];

/// What an implicit step has to solve. It is the correction of a guess, so single precision is
/// enough: what is left over is seen in double precision by the next step.
pub struct System<'a> {
    /// Plane 0: mass, kg; plane 1: 1 where the particle is free, 0 where it is held.
    pub mass: &'a Rows<f32>,
    /// The links' blocks.
    pub links: &'a Response,
    /// E, the blocks of single particles.
    pub own: &'a Rows<f32>,
    /// What contacts join.
    pub contacts: &'a [Contact],
}

impl System<'_> {
    /// The blocks of the links by how many steps they reach.
    fn blocks(&self) -> [(&Rows<f32>, isize); 2] {
        [
            (&self.links.stretch_blocks, 1),
            (&self.links.bend_blocks, 2),
        ]
    }

    /// out = A·u; returns u·A·u.
    ///
    /// A link acts on the difference of its ends, so that the mass of a particle, a millionth of the
    /// stiffness around it, is not lost to rounding.
    pub fn apply(&self, u: &Rows<f32>, out: &mut Rows<f32>) -> f64 {
        let links = sum(out, |y, out| {
            let row = y as isize;
            let links = self.blocks().map(|(blocks, hops)| Reach {
                blocks: [blocks.around(row), blocks.around(row - hops)],
                u: [u.around(row + hops), u.around(row - hops)],
                hops,
            });
            Arch::new().dispatch(ApplyRow {
                out: out.planes().take(),
                u: u.around(row),
                mass: self.mass.around(row),
                own: self.own.around(row),
                links,
            })
        });
        links + contact::apply(self.contacts, self.mass, u, out)
    }

    /// The diagonal blocks of A.
    pub fn diagonal(&self, out: &mut Rows) {
        each(out, |y, out| {
            let row = y as isize;
            let mut out: [&mut [f64]; BLOCK] = out.planes().take();
            let [mass] = self.mass.lines(row, 0, 0);
            let own: [&[f32]; BLOCK] = self.own.lines(row, 0, 0);
            for (c, out) in out.iter_mut().enumerate() {
                out.fill(0.0);
                add(out, own[c]);
                if c < 3 {
                    add(out, mass);
                }
            }
            for (blocks, hops) in self.blocks() {
                for (direction, (dx, dy)) in DIRECTIONS.into_iter().enumerate() {
                    let first = BLOCK * direction;
                    let ahead: [&[f32]; BLOCK] = blocks.lines(row, first, 0);
                    let behind: [&[f32]; BLOCK] = blocks.lines(row - hops * dy, first, -hops * dx);
                    for c in 0..BLOCK {
                        add(out[c], ahead[c]);
                        add(out[c], behind[c]);
                    }
                }
            }
        });
    }
}

#[multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn add(out: &mut [f64], values: &[f32]) {
    let values = &values[..out.len()];
    for (out, value) in out.iter_mut().zip(values) {
        *out += f64::from(*value);
    }
}

/// One row of A·u to compute. Rows are as [`Rows::around`] gives them.
struct ApplyRow<'a> {
    out: [&'a mut [f32]; 3],
    u: &'a [f32],
    mass: &'a [f32],
    own: &'a [f32],
    links: [Reach<'a>; 2],
}

/// The links of `hops` steps of a row.
#[derive(Clone, Copy)]
struct Reach<'a> {
    /// Of the links that begin in this row, and in the row `hops` above.
    blocks: [&'a [f32]; 2],
    /// u in the rows `hops` below and above.
    u: [&'a [f32]; 2],
    hops: isize,
}

impl WithSimd for ApplyRow<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let ApplyRow {
            out,
            u,
            mass,
            own,
            links,
        } = self;
        let width = out[0].len();
        let mut products = [0.0; VECTOR];
        for x in (0..width).step_by(S::F32_LANES) {
            let at = At { width, x };
            let here = at.three::<S>(u, 0);
            let m = load::<S>(mass, at.plane(0, 0));
            let zero = simd.splat_f32s(0.0);
            let mut sum = [zero; 3];
            for c in 0..3 {
                sum[c] = simd.mul_f32s(m, here[c]);
            }
            add_times(simd, &mut sum, at.six::<S>(own, 0, 0), here);
            for Reach {
                blocks,
                u: there,
                hops,
            } in links
            {
                let [b0, b1] = blocks;
                // Along the row, down, and down to the right and left.
                at.add_link(simd, &mut sum, here, (b0, 0, 0), (u, hops));
                at.add_link(simd, &mut sum, here, (b0, 6, 0), (there[0], 0));
                at.add_link(simd, &mut sum, here, (b0, 12, 0), (there[0], hops));
                at.add_link(simd, &mut sum, here, (b0, 18, 0), (there[0], -hops));
                // And the links that end here.
                at.add_link(simd, &mut sum, here, (b0, 0, -hops), (u, -hops));
                at.add_link(simd, &mut sum, here, (b1, 6, 0), (there[1], 0));
                at.add_link(simd, &mut sum, here, (b1, 12, -hops), (there[1], -hops));
                at.add_link(simd, &mut sum, here, (b1, 18, hops), (there[1], hops));
            }
            let free = load::<S>(mass, at.plane(1, 0));
            let part = x % VECTOR / S::F32_LANES;
            let product = &mut S::as_mut_simd_f32s(&mut products).0[part];
            for c in 0..3 {
                let sum = simd.mul_f32s(free, sum[c]);
                *product = simd.add_f32s(*product, simd.mul_f32s(sum, here[c]));
                S::as_mut_simd_f32s(&mut out[c][x..]).0[0] = sum;
            }
        }
        total(products)
    }
}

/// Where in the planes of a row a vector lies.
#[derive(Clone, Copy)]
struct At {
    width: usize,
    x: usize,
}

impl At {
    #[inline(always)]
    fn plane(self, plane: usize, shift: isize) -> usize {
        (VECTOR + plane * self.width + self.x).wrapping_add_signed(shift)
    }

    #[inline(always)]
    fn three<S: Simd>(self, row: &[f32], shift: isize) -> [S::f32s; 3] {
        [
            load::<S>(row, self.plane(0, shift)),
            load::<S>(row, self.plane(1, shift)),
            load::<S>(row, self.plane(2, shift)),
        ]
    }

    #[inline(always)]
    fn six<S: Simd>(self, row: &[f32], first: usize, shift: isize) -> [S::f32s; BLOCK] {
        [
            load::<S>(row, self.plane(first, shift)),
            load::<S>(row, self.plane(first + 1, shift)),
            load::<S>(row, self.plane(first + 2, shift)),
            load::<S>(row, self.plane(first + 3, shift)),
            load::<S>(row, self.plane(first + 4, shift)),
            load::<S>(row, self.plane(first + 5, shift)),
        ]
    }

    /// sum += block·(here − there); the block begins at a plane and is seen from beside, as is u.
    #[inline(always)]
    fn add_link<S: Simd>(
        self,
        simd: S,
        sum: &mut [S::f32s; 3],
        here: [S::f32s; 3],
        (blocks, first, beside): (&[f32], usize, isize),
        (u, shift): (&[f32], isize),
    ) {
        let block = self.six::<S>(blocks, first, beside);
        let there = self.three::<S>(u, shift);
        let mut apart = there;
        for c in 0..3 {
            apart[c] = simd.sub_f32s(here[c], there[c]);
        }
        add_times(simd, sum, block, apart);
    }
}

/// The vector that begins at a place.
#[inline(always)]
pub fn load<S: Simd>(row: &[f32], at: usize) -> S::f32s {
    S::as_simd_f32s(&row[at..at + S::F32_LANES]).0[0]
}

/// sum += block·u.
#[inline(always)]
fn add_times<S: Simd>(simd: S, sum: &mut [S::f32s; 3], block: [S::f32s; BLOCK], u: [S::f32s; 3]) {
    for c in 0..3 {
        for (entry, u) in SYMMETRIC[c].into_iter().zip(u) {
            // Fused wherever it runs, so that it comes out the same.
            sum[c] = simd.mul_add_f32s(block[entry], u, sum[c]);
        }
    }
}

/// The sum of products, in sixteen sums side by side whatever the processor: fast and the same
/// everywhere.
#[inline(always)]
pub fn dot(a: &[f32], b: &[f32]) -> f64 {
    let mut lanes = [0.0_f32; VECTOR];
    for (a, b) in a.chunks_exact(VECTOR).zip(b.chunks_exact(VECTOR)) {
        for i in 0..VECTOR {
            lanes[i] += a[i] * b[i];
        }
    }
    total(lanes)
}

/// The sum of lanes, in pairs.
#[inline(always)]
fn total(lanes: [f32; VECTOR]) -> f64 {
    let mut sums = [0.0; VECTOR];
    for i in 0..VECTOR {
        sums[i] = f64::from(lanes[i]);
    }
    for length in [8, 4, 2, 1] {
        for i in 0..length {
            sums[i] += sums[i + length];
        }
    }
    sums[0]
}
