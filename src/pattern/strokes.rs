//! Strokes of a brush: a round tip drawn along a path.
//!
//! A place is covered as its distance d from the path says: all of it up to `hardness`·`radius`,
//! nothing from `radius` on, and between them t²(3 − 2t), which falls without an edge. Where strokes
//! cross, and where one crosses itself, the most of them counts: painting twice over a place does not
//! make it darker than the darker stroke.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{LONGEST, Raster};
use crate::scenario::check::{Checker, Problem};
use crate::scenario::units::{Length, rounded};

/// The most points of all strokes of a pattern.
pub const MOST_POINTS: usize = 100_000;

/// One stroke of a brush.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stroke {
    /// From the middle of the brush to its edge.
    pub radius: Length,
    /// The share of the radius up to which all of the brush's strength is there: 1 for a sharp edge.
    #[serde(default = "firm", skip_serializing_if = "is_firm")]
    pub hardness: f64,
    /// How much there is in the middle, 0 to 1.
    #[serde(default = "all", skip_serializing_if = "is_all")]
    pub strength: f64,
    /// Where the middle of the brush went: places as shares of the cloth, across and down.
    pub path: Vec<(f64, f64)>,
}

fn firm() -> f64 {
    0.7
}

fn is_firm(hardness: &f64) -> bool {
    *hardness == firm()
}

fn all() -> f64 {
    1.0
}

fn is_all(strength: &f64) -> bool {
    *strength == all()
}

impl Stroke {
    /// A stroke along places that a hand has given. They are rounded to what a file should say (less than
    /// a hundredth of a cell on any cloth that fits a screen), and places twice in a row are left out.
    pub fn along(radius: Length, path: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let share = |share: f64| (share * 1e5).round() / 1e5;
        let mut path: Vec<_> = path
            .into_iter()
            .map(|(across, down)| (share(across), share(down)))
            .collect();
        path.dedup();
        Stroke {
            radius,
            hardness: firm(),
            strength: all(),
            path,
        }
    }

    pub(super) fn check(&self, at: &Checker, cell_mm: f64) -> Result<(), Problem> {
        self.radius
            .check(&at.field("radius"), cell_mm, 1e-3, LONGEST)?;
        at.field("hardness").within(self.hardness, 0.0..=1.0)?;
        at.field("strength").within(self.strength, 0.0..=1.0)?;
        let path = at.field("path");
        if self.path.is_empty() {
            return Err(path.problem("a stroke needs at least one place".into()));
        }
        for (i, (across, down)) in self.path.iter().enumerate() {
            let at = path.item(i);
            at.item(0).within(*across, -10.0..=10.0)?;
            at.item(1).within(*down, -10.0..=10.0)?;
        }
        Ok(())
    }

    /// Cells from the middle of the brush to its edge.
    pub fn cells(&self, cell_mm: f64) -> f64 {
        rounded(self.radius.cells(cell_mm), 9)
    }
}

/// Reports strokes that cannot be drawn.
pub(super) fn check(strokes: &[Stroke], at: &Checker, cell_mm: f64) -> Result<(), Problem> {
    let points: usize = strokes.iter().map(|stroke| stroke.path.len()).sum();
    if points > MOST_POINTS {
        return Err(at.problem(format!(
            "at most {MOST_POINTS} places are allowed, but these strokes have {points}"
        )));
    }
    let mut each = strokes.iter().enumerate();
    each.try_for_each(|(i, stroke)| stroke.check(&at.item(i), cell_mm))
}

/// A straight part of a stroke, in cells.
#[derive(Debug, Clone, Copy)]
struct Part {
    from: (f64, f64),
    to: (f64, f64),
    brush: Brush,
}

/// The tip of a brush.
#[derive(Debug, Clone, Copy)]
struct Brush {
    radius: f64,
    /// Up to here it is whole.
    whole: f64,
    strength: f64,
}

impl Brush {
    fn at(self, distance: f64) -> f32 {
        if distance <= self.whole {
            return self.strength as f32;
        }
        let t = ((self.radius - distance) / (self.radius - self.whole)).clamp(0.0, 1.0);
        (self.strength * t * t * (3.0 - 2.0 * t)) as f32
    }
}

impl Part {
    /// Its lowest and its highest point along one side, brush and all.
    fn reach(self, side: fn((f64, f64)) -> f64) -> (f64, f64) {
        let (from, to) = (side(self.from), side(self.to));
        let r = self.brush.radius;
        (from.min(to) - r, from.max(to) + r)
    }

    /// How far a point is from it.
    fn distance(self, (x, y): (f64, f64)) -> f64 {
        let (dx, dy) = (self.to.0 - self.from.0, self.to.1 - self.from.1);
        let (px, py) = (x - self.from.0, y - self.from.1);
        let length = dx * dx + dy * dy;
        let along = if length > 0.0 {
            ((px * dx + py * dy) / length).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let (ax, ay) = (px - along * dx, py - along * dy);
        (ax * ax + ay * ay).sqrt()
    }

    /// Paints its share of row `y`.
    fn paint(self, y: usize, row: &mut [f32]) {
        let (top, bottom) = self.reach(|point| point.1);
        let middle = y as f64 + 0.5;
        if middle < top || bottom < middle {
            return;
        }
        let (left, right) = self.reach(|point| point.0);
        // Cell x has its middle at x + ½.
        let first = (left - 0.5).ceil().max(0.0) as usize;
        let end = ((right - 0.5).floor() + 1.0).clamp(0.0, row.len() as f64) as usize;
        for (x, value) in row.iter_mut().enumerate().take(end).skip(first) {
            let distance = self.distance((x as f64 + 0.5, middle));
            *value = value.max(self.brush.at(distance));
        }
    }
}

/// Rows that are painted in one go.
const ROWS_A_TASK: usize = 16;

/// Draws strokes on `nx` by `ny` cells of `cell_mm`.
pub(super) fn draw(strokes: &[Stroke], nx: usize, ny: usize, cell_mm: f64) -> Raster {
    let mut raster = Raster::uniform(nx, ny, 0.0);
    let parts: Vec<Part> = strokes
        .iter()
        .flat_map(|stroke| parts(stroke, nx, ny, cell_mm))
        .collect();
    // Each task asks once which parts reach it: a long drawing costs little more than the cells that it
    // covers.
    let tasks = raster.values.par_chunks_mut((ROWS_A_TASK * nx).max(1));
    tasks.enumerate().for_each(|(task, rows)| {
        let first = task * ROWS_A_TASK;
        let reaches = |part: &&Part| {
            let (top, bottom) = part.reach(|point| point.1);
            top < (first + ROWS_A_TASK) as f64 && first as f64 <= bottom
        };
        let reaching: Vec<&Part> = parts.iter().filter(reaches).collect();
        for (row, values) in rows.chunks_mut(nx.max(1)).enumerate() {
            for part in &reaching {
                part.paint(first + row, values);
            }
        }
    });
    raster
}

fn parts(stroke: &Stroke, nx: usize, ny: usize, cell_mm: f64) -> Vec<Part> {
    let radius = stroke.cells(cell_mm);
    let brush = Brush {
        radius,
        whole: stroke.hardness * radius,
        strength: stroke.strength,
    };
    let cells = |(across, down): (f64, f64)| (across * nx as f64, down * ny as f64);
    let part = |from, to| Part {
        from: cells(from),
        to: cells(to),
        brush,
    };
    match stroke.path.as_slice() {
        [] => Vec::new(),
        [dab] => vec![part(*dab, *dab)],
        path => path.windows(2).map(|two| part(two[0], two[1])).collect(),
    }
}
