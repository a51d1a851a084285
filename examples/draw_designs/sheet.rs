//! The sheet that designs are drawn on, and the shapes they are drawn with.

use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Stroke, Transform,
};

use std::f32::consts::TAU;

/// Pixels along one side of a design.
pub const SIDE: u32 = 1024;
/// Width of an outline, and of a vein: a drop of wax from the canting.
pub const OUTLINE: f32 = 8.0;
pub const VEIN: f32 = 6.5;

/// What becomes of a place.
#[derive(Clone, Copy)]
pub enum Tone {
    /// Waxed in both baths.
    White,
    /// Waxed in the second bath: only the first dye.
    First,
    /// Waxed in the first bath: only the second dye.
    Second,
    /// Never waxed.
    Ground,
}

impl Tone {
    /// Wax in the first bath as red, in the second as green.
    fn colour(self) -> Color {
        match self {
            Tone::White => Color::from_rgba8(255, 255, 0, 255),
            Tone::First => Color::from_rgba8(0, 255, 0, 255),
            Tone::Second => Color::from_rgba8(255, 0, 0, 255),
            Tone::Ground => Color::from_rgba8(0, 0, 0, 255),
        }
    }

    fn paint(self) -> Paint<'static> {
        let mut paint = Paint::default();
        paint.set_color(self.colour());
        paint
    }
}

/// A point across and up from the middle of the design.
pub type Point = (f32, f32);

/// The sheet that is drawn on, with the place and turn of what is being drawn.
pub struct Sheet {
    pixels: Pixmap,
    at: Transform,
}

impl Sheet {
    /// An empty sheet of one tone. Across and up are counted from its middle.
    pub fn new(ground: Tone) -> Option<Self> {
        let mut pixels = Pixmap::new(SIDE, SIDE)?;
        pixels.fill(ground.colour());
        let middle = SIDE as f32 / 2.0;
        Some(Sheet {
            pixels,
            at: Transform::from_row(1.0, 0.0, 0.0, -1.0, middle, middle),
        })
    }

    /// Where there is wax in the first and in the second bath, 0 to 255, row by row from the top.
    pub fn wax(&self) -> [Vec<u8>; 2] {
        let pixels = || self.pixels.pixels().iter();
        [
            pixels().map(|p| p.red()).collect(),
            pixels().map(|p| p.green()).collect(),
        ]
    }

    pub fn fill(&mut self, path: &Path, tone: Tone) {
        let rule = FillRule::Winding;
        self.pixels
            .fill_path(path, &tone.paint(), rule, self.at, None);
    }

    pub fn line(&mut self, path: &Path, width: f32, tone: Tone) {
        let stroke = Stroke {
            width,
            line_cap: LineCap::Round,
            line_join: LineJoin::Round,
            ..Stroke::default()
        };
        self.pixels
            .stroke_path(path, &tone.paint(), &stroke, self.at, None);
    }

    /// A shape with an outline of wax around it.
    pub fn shape(&mut self, path: &Path, tone: Tone) {
        self.line(path, 2.0 * OUTLINE, Tone::White);
        self.fill(path, tone);
    }

    pub fn dot(&mut self, (x, y): Point, radius: f32, tone: Tone) {
        if let Some(circle) = PathBuilder::from_circle(x, y, radius) {
            self.fill(&circle, tone);
        }
    }

    /// Draws the same thing moved and turned: `turn` in radians against the clock.
    pub fn placed(&mut self, (x, y): Point, turn: f32, draw: impl FnOnce(&mut Sheet)) {
        let before = self.at;
        let turn = Transform::from_rotate(turn.to_degrees());
        self.at = before
            .pre_concat(Transform::from_translate(x, y))
            .pre_concat(turn);
        draw(self);
        self.at = before;
    }

    pub fn mirrored(&mut self, draw: impl FnOnce(&mut Sheet)) {
        let before = self.at;
        self.at = before.pre_concat(Transform::from_scale(1.0, -1.0));
        draw(self);
        self.at = before;
    }
}

pub fn path(draw: impl FnOnce(&mut PathBuilder)) -> Path {
    let mut builder = PathBuilder::new();
    draw(&mut builder);
    // Only a path without a line in it cannot be finished.
    builder.finish().expect("the design draws whole paths")
}

/// A petal from the origin to the right, pointed.
pub fn petal(length: f32, width: f32) -> Path {
    let half = 0.5 * width;
    path(|p| {
        p.move_to(0.0, 0.0);
        p.cubic_to(
            0.25 * length,
            1.2 * half,
            0.75 * length,
            1.3 * half,
            length,
            0.0,
        );
        p.cubic_to(
            0.75 * length,
            -1.3 * half,
            0.25 * length,
            -1.2 * half,
            0.0,
            0.0,
        );
        p.close();
    })
}

/// A leaf from the origin to the right that bends upwards.
pub fn leaf(sheet: &mut Sheet, length: f32, tone: Tone) {
    let (l, w) = (length, 0.34 * length);
    let blade = path(|p| {
        p.move_to(0.0, 0.0);
        p.cubic_to(0.18 * l, 0.9 * w, 0.62 * l, 0.95 * w, l, 0.62 * w);
        p.cubic_to(0.78 * l, 0.1 * w, 0.45 * l, -0.75 * w, 0.0, 0.0);
        p.close();
    });
    sheet.shape(&blade, tone);
    let rib = path(|p| {
        p.move_to(0.05 * l, 0.02 * w);
        p.quad_to(0.45 * l, 0.02 * w, 0.74 * l, 0.4 * w);
    });
    sheet.line(&rib, VEIN, Tone::White);
}

/// Points of a curve as one broad stroke that grows thinner.
pub fn tapered(points: &[Point], from: f32, to: f32) -> Path {
    let last = (points.len() - 1).max(1);
    let side = |i: usize, sign: f32| {
        let (a, b) = (points[i.saturating_sub(1)], points[(i + 1).min(last)]);
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let length = (dx * dx + dy * dy).sqrt().max(1e-6);
        let half = 0.5 * sign * (from + (to - from) * i as f32 / last as f32);
        (
            points[i].0 - dy / length * half,
            points[i].1 + dx / length * half,
        )
    };
    path(|p| {
        let there = (0..=last).map(|i| side(i, 1.0));
        let back = (0..=last).rev().map(|i| side(i, -1.0));
        for (i, (x, y)) in there.chain(back).enumerate() {
            if i == 0 {
                p.move_to(x, y);
            } else {
                p.line_to(x, y);
            }
        }
        p.close();
    })
}

/// A flower of round petals around a seed head.
pub fn flower(sheet: &mut Sheet, radius: f32, petals: u32, tone: Tone) {
    for i in 0..petals {
        sheet.placed((0.0, 0.0), TAU * i as f32 / petals as f32, |sheet| {
            sheet.shape(&petal(radius, 3.9 * radius / petals as f32), tone);
        });
    }
    sheet.dot((0.0, 0.0), 0.30 * radius + OUTLINE, Tone::White);
    sheet.dot((0.0, 0.0), 0.30 * radius, Tone::Ground);
    sheet.dot((0.0, 0.0), 0.13 * radius, Tone::White);
}
