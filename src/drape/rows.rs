//! How numbers of the particles lie in memory: row by row of the cloth, and within a row one plane
//! for each quantity, so that a loop over a row reads whole vectors.
//!
//! Around the cloth lie two rows above and below and at least two columns on each side that belong to
//! no particle. They are zero, so loops need no case for the edge: what links to them has no stiffness.
//! A row is a whole number of vectors wide, ghosts on its right included; those on its left are the
//! right ones of the plane before.

use bevy::math::DVec3;
use rayon::prelude::*;

/// Ghosts on each side of the cloth: as far as the longest link reaches.
pub const GHOSTS: usize = 2;

/// The longest vector that a loop over a row is made of.
pub const VECTOR: usize = 16;

/// Particles that one task computes: enough to outweigh handing the task out.
const PARTICLES_A_TASK: usize = 1 << 10;

/// Several numbers (planes) for every particle of a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Rows<T = f64> {
    /// Particles across.
    pub nx: usize,
    /// Particles down.
    pub ny: usize,
    /// Numbers kept for each particle.
    pub planes: usize,
    data: Vec<T>,
}

/// The numbers of a plane of a row: the particles and ghosts, in whole vectors.
pub fn width(nx: usize) -> usize {
    (nx + GHOSTS).next_multiple_of(VECTOR)
}

impl<T: Number> Rows<T> {
    /// Zero everywhere.
    pub fn zero(nx: usize, ny: usize, planes: usize) -> Self {
        // The first plane of all needs ghosts on its left, the last may be seen from beside.
        let length = (ny + 2 * GHOSTS) * planes * width(nx) + 2 * VECTOR;
        Rows {
            nx,
            ny,
            planes,
            data: vec![T::default(); length],
        }
    }

    /// Length of all planes of a row.
    fn row_length(&self) -> usize {
        self.planes * width(self.nx)
    }

    /// Where a number lies.
    fn at(&self, x: usize, y: usize, plane: usize) -> usize {
        VECTOR + ((y + GHOSTS) * self.planes + plane) * width(self.nx) + x
    }

    /// One number of a particle.
    pub fn get(&self, x: usize, y: usize, plane: usize) -> T {
        self.data[self.at(x, y, plane)]
    }

    /// One number of a particle, to be changed.
    pub fn get_mut(&mut self, x: usize, y: usize, plane: usize) -> &mut T {
        let at = self.at(x, y, plane);
        &mut self.data[at]
    }

    /// `N` planes of a row from plane `first` on, seen from `shift` columns beside. The row may be a
    /// ghost row, −2 to ny + 1.
    #[inline(always)]
    pub fn lines<const N: usize>(&self, y: isize, first: usize, shift: isize) -> [&[T]; N] {
        let width = width(self.nx);
        let begin = VECTOR + ((y + GHOSTS as isize) as usize * self.planes + first) * width;
        std::array::from_fn(|plane| {
            let at = (begin + plane * width).wrapping_add_signed(shift);
            &self.data[at..at + width]
        })
    }

    /// All planes of a row and what lies around them: plane `p` begins at `VECTOR + p·width`.
    #[inline(always)]
    pub fn around(&self, y: isize) -> &[T] {
        let length = self.row_length();
        let begin = (y + GHOSTS as isize) as usize * length;
        &self.data[begin..begin + length + 2 * VECTOR]
    }

    /// The rows of particles, a task's worth at a time.
    fn tasks(&mut self) -> impl IndexedParallelIterator<Item = (usize, &mut [T])> {
        let length = self.row_length();
        let rows = rows_a_task(self.nx);
        let inner = VECTOR + GHOSTS * length..VECTOR + (GHOSTS + self.ny) * length;
        self.data[inner].par_chunks_mut(rows * length).enumerate()
    }

    /// All numbers, ghosts included.
    pub fn all(&self) -> &[T] {
        &self.data
    }

    /// All numbers, ghosts included, to be changed. Ghosts must stay zero.
    pub fn all_mut(&mut self) -> &mut [T] {
        &mut self.data
    }
}

impl Rows<f64> {
    /// Planes 0 to 2 of a particle as a vector.
    pub fn vector(&self, x: usize, y: usize) -> DVec3 {
        let (at, stride) = (self.at(x, y, 0), width(self.nx));
        let data = &self.data;
        DVec3::new(data[at], data[at + stride], data[at + 2 * stride])
    }

    /// Sets planes 0 to 2 of a particle.
    pub fn set_vector(&mut self, x: usize, y: usize, to: DVec3) {
        let (at, stride) = (self.at(x, y, 0), width(self.nx));
        self.data[at] = to.x;
        self.data[at + stride] = to.y;
        self.data[at + 2 * stride] = to.z;
    }

    /// Planes 0 to 2 of the particle of a number in reading order.
    pub fn particle(&self, i: usize) -> DVec3 {
        self.vector(i % self.nx, i / self.nx)
    }

    /// Sets planes 0 to 2 of the particle of a number in reading order.
    pub fn set_particle(&mut self, i: usize, to: DVec3) {
        self.set_vector(i % self.nx, i / self.nx, to);
    }

    /// Planes 0 to 2 of all particles, in reading order.
    pub fn to_vectors(&self) -> Vec<DVec3> {
        (0..self.nx * self.ny).map(|i| self.particle(i)).collect()
    }
}

/// Rows that one task computes; the cloth fixes it, not the machine.
fn rows_a_task(nx: usize) -> usize {
    (PARTICLES_A_TASK / nx.max(1)).max(1)
}

/// All planes of one row, to be changed.
#[derive(Debug)]
pub struct Row<'a, T> {
    nx: usize,
    data: &'a mut [T],
}

impl<'a, T> Row<'a, T> {
    /// The planes, one after another.
    pub fn planes(self) -> Planes<'a, T> {
        Planes {
            width: width(self.nx),
            rest: self.data,
        }
    }

    /// All planes, ghosts included. Ghosts must stay zero.
    pub fn all(self) -> &'a mut [T] {
        self.data
    }
}

/// The planes of a row, handed out in order.
#[derive(Debug)]
pub struct Planes<'a, T> {
    width: usize,
    rest: &'a mut [T],
}

impl<'a, T> Planes<'a, T> {
    /// The next `N` planes.
    #[inline(always)]
    pub fn take<const N: usize>(&mut self) -> [&'a mut [T]; N] {
        std::array::from_fn(|_| {
            let rest = std::mem::take(&mut self.rest);
            let (plane, rest) = rest.split_at_mut(self.width);
            self.rest = rest;
            plane
        })
    }
}

/// Calls `work` with the number and planes of every row, on all cores.
pub fn each<T: Number>(a: &mut Rows<T>, work: impl Fn(usize, Row<T>) + Sync) {
    sum(a, |y, a| {
        work(y, a);
        0.0
    });
}

/// Calls `work` for every row and adds up what it returns, in an order that the cloth fixes.
pub fn sum<T: Number>(a: &mut Rows<T>, work: impl Fn(usize, Row<T>) -> f64 + Sync) -> f64 {
    let (nx, length, rows) = (a.nx, a.row_length(), rows_a_task(a.nx));
    let sums: Vec<f64> = a
        .tasks()
        .map(|(task, chunk)| {
            let each = chunk.chunks_exact_mut(length).enumerate();
            each.map(|(i, data)| work(task * rows + i, Row { nx, data }))
                .sum()
        })
        .collect();
    sums.iter().sum()
}

/// [`each`] for two fields of the same cloth.
pub fn each2<T: Number, U: Number>(
    a: &mut Rows<T>,
    b: &mut Rows<U>,
    work: impl Fn(usize, Row<T>, Row<U>) + Sync,
) {
    let (nx, rows) = (a.nx, rows_a_task(a.nx));
    let (of_a, of_b) = (a.row_length(), b.row_length());
    a.tasks().zip(b.tasks()).for_each(|((task, a), (_, b))| {
        let each = a.chunks_exact_mut(of_a).zip(b.chunks_exact_mut(of_b));
        for (i, (a, b)) in each.enumerate() {
            work(task * rows + i, Row { nx, data: a }, Row { nx, data: b });
        }
    });
}

/// A number that rows hold.
pub trait Number: Copy + Default + Send + Sync {}
impl Number for f32 {}
impl Number for f64 {}
