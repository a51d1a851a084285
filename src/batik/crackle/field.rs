//! The distance field of the wax: how far every place lies from the nearest crack or open area.
//!
//! It begins as a distance transform of the drawing (imageproc's) and is kept up to date crack by
//! crack: from the places of a new crack the improvement spreads to neighbours for as long as it is
//! one, so a crack costs as much as the area that it is now nearest to. Every cell remembers the
//! point of a crack that it is nearest to, so distances are those to points, not to cells.

use std::collections::VecDeque;

use super::Point;
use crate::batik::distance::distance_to;
use crate::pattern::Raster;

/// The cell is nearest to an open area rather than to a crack.
const OPEN: u32 = u32::MAX;

/// A place on a crack.
#[derive(Debug, Clone, Copy)]
struct Place {
    at: Point,
    crack: u32,
}

/// What a place is nearest to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Nearest {
    /// The edge of an open area.
    Open,
    /// A point of a crack.
    Crack(usize, Point),
}

/// Distances over the wax.
pub(super) struct Field {
    pub nx: usize,
    pub ny: usize,
    /// To the nearest crack or edge, cells; 0 in open areas.
    distance: Vec<f32>,
    /// The place that a cell is nearest to, or [`OPEN`].
    nearest: Vec<u32>,
    places: Vec<Place>,
    waiting: VecDeque<u32>,
}

impl Field {
    /// The field of a drawing before any crack. What is at least half open counts as open.
    pub fn new(drawing: &Raster) -> Self {
        let (nx, ny) = (drawing.nx, drawing.ny);
        // Where nothing is open nothing is near: as far as could be.
        let farthest = (nx + ny) as f32;
        let edge = |centre: f32| (centre - 0.5).clamp(0.0, farthest);
        Field {
            nx,
            ny,
            distance: distance_to(drawing, 0.5).into_iter().map(edge).collect(),
            nearest: vec![OPEN; nx * ny],
            places: Vec::new(),
            waiting: VecDeque::new(),
        }
    }

    /// Cells of wax.
    pub fn waxed(&self) -> usize {
        self.distance.iter().filter(|d| **d > 0.0).count()
    }

    fn cell(&self, at: Point) -> usize {
        let x = (at[0].max(0.0) as usize).min(self.nx - 1);
        let y = (at[1].max(0.0) as usize).min(self.ny - 1);
        y * self.nx + x
    }

    /// Whether a point lies on the cloth.
    pub fn holds(&self, at: Point) -> bool {
        at[0] >= 0.0 && at[1] >= 0.0 && at[0] < self.nx as f32 && at[1] < self.ny as f32
    }

    /// Distance from a point to the nearest crack or edge, cells; 0 in open areas.
    pub fn distance(&self, at: Point) -> f32 {
        let i = self.cell(at);
        match self.nearest[i] {
            OPEN => self.distance[i],
            // In an open cell the distance is 0 and no crack was nearer.
            place => length(minus(at, self.places[place as usize].at)),
        }
    }

    /// What a point is nearest to.
    pub fn nearest(&self, at: Point) -> Nearest {
        match self.nearest[self.cell(at)] {
            OPEN => Nearest::Open,
            place => {
                let Place { at, crack } = self.places[place as usize];
                Nearest::Crack(crack as usize, at)
            }
        }
    }

    /// The direction in which the distance grows fastest, a unit vector; zero where it is flat.
    pub fn uphill(&self, at: Point) -> Point {
        if let Nearest::Crack(_, place) = self.nearest(at) {
            return unit(minus(at, place));
        }
        let i = self.cell(at);
        let (x, y) = (i % self.nx, i / self.nx);
        let d = |x: usize, y: usize| self.distance[y * self.nx + x];
        let (left, right) = (x.saturating_sub(2), (x + 2).min(self.nx - 1));
        let (above, below) = (y.saturating_sub(2), (y + 2).min(self.ny - 1));
        unit([d(right, y) - d(left, y), d(x, below) - d(x, above)])
    }

    /// Takes a crack into the field: `line` is its course, in points no farther apart than a cell.
    pub fn add(&mut self, crack: usize, line: &[Point]) {
        for at in line {
            if !self.holds(*at) {
                continue;
            }
            let place = self.places.len() as u32;
            self.places.push(Place {
                at: *at,
                crack: crack as u32,
            });
            let i = self.cell(*at);
            self.improve(i, place);
        }
        // Neighbours of what has improved may improve.
        while let Some(i) = self.waiting.pop_front() {
            let i = i as usize;
            let place = self.nearest[i];
            let (x, y) = (i % self.nx, i / self.nx);
            if x > 0 {
                self.improve(i - 1, place);
            }
            if x + 1 < self.nx {
                self.improve(i + 1, place);
            }
            if y > 0 {
                self.improve(i - self.nx, place);
            }
            if y + 1 < self.ny {
                self.improve(i + self.nx, place);
            }
        }
    }

    fn improve(&mut self, i: usize, place: u32) {
        let middle = [(i % self.nx) as f32 + 0.5, (i / self.nx) as f32 + 0.5];
        let distance = length(minus(middle, self.places[place as usize].at));
        if distance < self.distance[i] {
            self.distance[i] = distance;
            self.nearest[i] = place;
            self.waiting.push_back(i as u32);
        }
    }
}

pub(super) fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

pub(super) fn dot(a: Point, b: Point) -> f32 {
    a[0] * b[0] + a[1] * b[1]
}

pub(super) fn length(a: Point) -> f32 {
    dot(a, a).sqrt()
}

/// The unit vector in a direction; zero for none.
pub(super) fn unit(a: Point) -> Point {
    let length = length(a);
    if length > 1e-6 {
        [a[0] / length, a[1] / length]
    } else {
        [0.0, 0.0]
    }
}

/// The point `t` of `direction` from `from`.
pub(super) fn ahead(from: Point, direction: Point, t: f32) -> Point {
    [from[0] + t * direction[0], from[1] + t * direction[1]]
}
