//! The tools in a hand, and how the flat cloth is seen.

use bevy::math::DVec3;
use bevy_egui::egui::{Pos2, Rect, Vec2, vec2};
use serde::Deserialize;

use super::hanger::Place;
use super::worker::Cut;
use crate::pattern::Stroke;
use crate::scenario::Length;
use crate::session::overlay::Field;
use crate::session::paint::Paint;

/// What the pointer does on the cloth.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
pub enum Tool {
    /// Looks: turns, moves, zooms.
    #[default]
    Look,
    /// Paints.
    Brush,
    /// Pulls the cloth.
    Hand,
    /// Fixes the cloth where it is.
    Pin,
    /// Folds the cloth.
    Crease,
    /// Cuts a cross-section.
    Cut,
}

impl Tool {
    /// All of them, in the order of the bar.
    pub const ALL: [Tool; 6] = [
        Tool::Look,
        Tool::Brush,
        Tool::Hand,
        Tool::Pin,
        Tool::Crease,
        Tool::Cut,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Tool::Look => "Look",
            Tool::Brush => "Brush",
            Tool::Hand => "Hand",
            Tool::Pin => "Pin",
            Tool::Crease => "Crease",
            Tool::Cut => "Section",
        }
    }

    /// Its key.
    pub fn key(self) -> &'static str {
        match self {
            Tool::Look => "V",
            Tool::Brush => "B",
            Tool::Hand => "H",
            Tool::Pin => "N",
            Tool::Crease => "C",
            Tool::Cut => "X",
        }
    }

    /// What it does.
    pub fn tip(self) -> &'static str {
        match self {
            Tool::Look => "Drag to turn the draped cloth or to move the flat one; scroll to zoom",
            Tool::Brush => "Paint dye, resist or wax on the flat or the draped cloth",
            Tool::Hand => "Pull the draped cloth",
            Tool::Pin => "Click the draped cloth to hold it there; click again to let it go",
            Tool::Crease => "Drag over the draped cloth to press a fold into it",
            Tool::Cut => "Drag over the flat cloth to see what lies below that line",
        }
    }
}

/// What is on the brush.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
pub enum Kind {
    /// Dye.
    #[default]
    Dye,
    /// Resist.
    Resist,
    /// Wax.
    Wax,
}

/// The brush.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Brush {
    /// What is on it.
    pub kind: Kind,
    /// From its middle to its edge, as a share of the cloth's longer side.
    pub size: f64,
    /// How much there is in the middle, 0 to 1.
    pub strength: f64,
    /// The share of the radius up to which all of its strength is there.
    pub hardness: f64,
}

impl Default for Brush {
    fn default() -> Self {
        Brush {
            kind: Kind::Dye,
            size: 0.02,
            strength: 1.0,
            hardness: 0.7,
        }
    }
}

impl Brush {
    /// What the process is told is on it.
    pub fn paint(&self) -> Paint {
        match self.kind {
            Kind::Dye => Paint::Dye(1.0),
            Kind::Resist => Paint::Resist,
            Kind::Wax => Paint::Wax,
        }
    }

    /// Its radius on a cloth of so many cells.
    pub fn cells(&self, (nx, ny): (usize, usize)) -> f64 {
        (self.size * nx.max(ny) as f64).max(0.5)
    }

    /// A stroke along places (shares of the cloth).
    pub fn stroke(&self, path: &[Place], cells: (usize, usize)) -> Stroke {
        Stroke {
            radius: Length::Cells((10.0 * self.cells(cells)).round() / 10.0),
            hardness: self.hardness,
            strength: self.strength,
            path: thinned(path, 0.15 * self.cells(cells), cells),
        }
    }
}

/// A path without the places that lie closer together than `least` cells; rounded to what a file keeps.
pub fn thinned(path: &[Place], least: f64, (nx, ny): (usize, usize)) -> Vec<Place> {
    let rounded = |v: f64| (1e5 * v).round() / 1e5;
    let mut kept: Vec<Place> = Vec::new();
    for (i, (x, y)) in path.iter().enumerate() {
        let is_last = i + 1 == path.len();
        let far = kept.last().is_none_or(|(kx, ky)| {
            let (dx, dy) = ((x - kx) * nx as f64, (y - ky) * ny as f64);
            (dx * dx + dy * dy).sqrt() >= least
        });
        if far || is_last {
            kept.push((rounded(*x), rounded(*y)));
        }
    }
    kept.dedup();
    kept
}

/// How the flat cloth is seen: points a cell, and which place of it is in the middle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlatView {
    /// Points along one side of a cell; none: as many as fit.
    pub zoom: Option<f32>,
    /// The place in the middle, in cells.
    pub middle: Vec2,
}

/// The most points along one side of a cell.
pub const CLOSEST: f32 = 80.0;

impl FlatView {
    /// Points a cell in a space.
    pub fn zoom_in(&self, space: Rect, (nx, ny): (usize, usize)) -> f32 {
        self.zoom.unwrap_or_else(|| {
            let (w, h) = (space.width() - 16.0, space.height() - 16.0);
            (w / nx as f32).min(h / ny as f32).max(0.01)
        })
    }

    fn middle_of(&self, (nx, ny): (usize, usize)) -> Vec2 {
        match self.zoom {
            Some(_) => self.middle,
            None => 0.5 * vec2(nx as f32, ny as f32),
        }
    }

    /// Where the cloth lies in a space.
    pub fn rect(&self, space: Rect, cells: (usize, usize)) -> Rect {
        let zoom = self.zoom_in(space, cells);
        let corner = space.center() - zoom * self.middle_of(cells);
        Rect::from_min_size(corner, zoom * vec2(cells.0 as f32, cells.1 as f32))
    }

    /// The place of the cloth (shares) under a point.
    pub fn place(&self, at: Pos2, space: Rect, cells: (usize, usize)) -> Place {
        let rect = self.rect(space, cells);
        let off = at - rect.min;
        (
            f64::from(off.x / rect.width()),
            f64::from(off.y / rect.height()),
        )
    }

    /// Nearer by a factor; what lies under a point stays there.
    pub fn zoomed(self, factor: f32, at: Pos2, space: Rect, cells: (usize, usize)) -> Self {
        let old = self.zoom_in(space, cells);
        let fit = FlatView::default().zoom_in(space, cells);
        let zoom = (old * factor).clamp(0.5 * fit, CLOSEST.max(fit));
        let from_middle = at - space.center();
        let under = self.middle_of(cells) + from_middle / old;
        FlatView {
            zoom: Some(zoom),
            middle: under - from_middle / zoom,
        }
    }

    /// Moved by points.
    pub fn moved(self, by: Vec2, space: Rect, cells: (usize, usize)) -> Self {
        let zoom = self.zoom_in(space, cells);
        let middle = self.middle_of(cells) - by / zoom;
        FlatView {
            zoom: Some(zoom),
            middle: middle.clamp(Vec2::ZERO, vec2(cells.0 as f32, cells.1 as f32)),
        }
    }
}

impl Default for FlatView {
    fn default() -> Self {
        FlatView {
            zoom: None,
            middle: Vec2::ZERO,
        }
    }
}

/// The tools, and what is being done with them.
#[derive(Debug, Clone, Default)]
pub struct Tools {
    /// The one in hand.
    pub tool: Tool,
    /// The brush.
    pub brush: Brush,
    /// The stroke that is being painted: shares of the cloth.
    pub path: Vec<Place>,
    /// Where a line begins that is being drawn: a crease or a cut.
    pub from: Option<Place>,
    /// Where it ends now.
    pub to: Option<Place>,
    /// Where the hand holds the cloth: on it (shares), and in space (m).
    pub held: Option<(Place, DVec3)>,
    /// Whether creases fold towards the front.
    pub valley: bool,
    /// The line of the cross-section.
    pub cut: Option<Cut>,
    /// The field over the cloth.
    pub overlay: Option<Field>,
    /// How the flat cloth is seen.
    pub flat: FlatView,
    /// Pixels a cell that are asked for.
    pub scale: u32,
}

impl Tools {
    /// Puts down what belongs to one cloth.
    pub fn forget(&mut self) {
        self.path.clear();
        self.from = None;
        self.to = None;
        self.held = None;
        self.cut = None;
        self.flat = FlatView::default();
        self.scale = 1;
    }
}

/// The most pixels along one side of a flat cloth's picture in the window.
const MOST_PIXELS: usize = 4096;

/// Pixels a cell that a zoom wants (points a cell times pixels a point), on a cloth of so many cells: a
/// power of two, so that it changes rarely.
pub fn wanted_scale(pixels_a_cell: f32, (nx, ny): (usize, usize)) -> u32 {
    let most = (MOST_PIXELS / nx.max(ny).max(1)).max(1) as u32;
    let most = 1 << most.ilog2();
    let wanted = pixels_a_cell.max(1.0).ceil() as u32;
    wanted.next_power_of_two().min(most).min(16)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPACE: Rect = Rect {
        min: Pos2::new(100.0, 50.0),
        max: Pos2::new(700.0, 450.0),
    };
    const CELLS: (usize, usize) = (800, 600);

    #[test]
    fn at_first_the_whole_cloth_is_seen() {
        let rect = FlatView::default().rect(SPACE, CELLS);
        assert!(SPACE.contains_rect(rect));
        assert!(rect.width() > 0.9 * SPACE.width() || rect.height() > 0.9 * SPACE.height());
        assert!((rect.center() - SPACE.center()).length() < 1e-3);
    }

    #[test]
    fn zooming_keeps_what_is_under_the_pointer() {
        let at = Pos2::new(222.0, 311.0);
        let mut view = FlatView::default();
        let before = view.place(at, SPACE, CELLS);
        for factor in [1.3, 4.0, 0.7, 2.5] {
            view = view.zoomed(factor, at, SPACE, CELLS);
            let now = view.place(at, SPACE, CELLS);
            assert!((now.0 - before.0).abs() < 1e-4 && (now.1 - before.1).abs() < 1e-4);
        }
    }

    #[test]
    fn one_can_come_so_near_that_a_yarn_fills_the_view() {
        let mut view = FlatView::default();
        for _ in 0..60 {
            view = view.zoomed(1.2, SPACE.center(), SPACE, CELLS);
        }
        // A yarn is four cells wide.
        assert!(4.0 * view.zoom_in(SPACE, CELLS) > 0.5 * SPACE.height());
    }

    #[test]
    fn moving_carries_the_cloth_along_with_the_pointer() {
        let view = FlatView::default().zoomed(5.0, SPACE.center(), SPACE, CELLS);
        let at = Pos2::new(300.0, 200.0);
        let by = vec2(37.0, -21.0);
        let (before, after) = (
            view.place(at, SPACE, CELLS),
            view.moved(by, SPACE, CELLS).place(at + by, SPACE, CELLS),
        );
        assert!((before.0 - after.0).abs() < 1e-4 && (before.1 - after.1).abs() < 1e-4);
    }

    #[test]
    fn a_thinned_path_keeps_its_ends_and_is_no_denser_than_asked() {
        let path: Vec<Place> = (0..=1000).map(|i| (f64::from(i) / 1000.0, 0.5)).collect();
        let thin = thinned(&path, 8.0, CELLS);
        assert_eq!(thin.first(), path.first());
        assert_eq!(thin.last(), path.last());
        assert!(thin.len() < 102 && thin.len() > 90, "{}", thin.len());
    }

    #[test]
    fn the_scale_follows_the_zoom_up_to_what_fits() {
        assert_eq!(wanted_scale(0.3, CELLS), 1);
        assert_eq!(wanted_scale(2.2, CELLS), 4);
        assert_eq!(wanted_scale(50.0, CELLS), 4);
        assert_eq!(wanted_scale(50.0, (200, 200)), 16);
        assert_eq!(wanted_scale(50.0, (5000, 5000)), 1);
    }
}
