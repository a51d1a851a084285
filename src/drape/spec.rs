//! What a scenario says about draped cloth: its material, how it begins, what holds it, what it falls on.
//!
//! Metres, seconds, degrees; x to the right, y up, z to the viewer. The cloth's own places run from (0, 0) at
//! its upper left corner to (1, 1) at its lower right, seen from the front.

use serde::{Deserialize, Serialize};

use super::drape::Integrator;
use super::material::Material;
use crate::scenario::check::{Checker, Problem};

/// A vector or place in space: x, y, z.
pub type Xyz = (f64, f64, f64);

/// A place on the cloth: share of its width, share of its height.
pub type Place = (f64, f64);

/// The most particles along one side.
pub const MOST_PARTICLES: usize = 1025;

/// Furthest that anything may be from the middle of the world, m.
const FURTHEST: f64 = 1e4;

/// Draped cloth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Drape", deny_unknown_fields)]
pub struct DrapeSpec {
    /// Particles across and down. Their number has nothing to do with the cells of the dye.
    #[serde(default = "default_particles")]
    pub particles: (usize, usize),
    /// Width and height, m. Left out: those of the dyed cloth.
    #[serde(default)]
    pub size_m: Option<(f64, f64)>,
    /// Rectangle or ellipse.
    #[serde(default)]
    pub outline: Outline,
    /// What it is made of.
    #[serde(default = "default_material")]
    pub material: Material,
    /// How it lies or hangs in the beginning.
    pub start: Start,
    /// What holds it.
    #[serde(default)]
    pub pins: Vec<PinSpec>,
    /// What it falls on.
    #[serde(default)]
    pub on: Vec<ColliderSpec>,
    /// The wind. Left out: still air.
    #[serde(default)]
    pub wind: Option<WindSpec>,
    /// Where it was pressed.
    #[serde(default)]
    pub creases: Vec<CreaseSpec>,
    /// How long it moves before anything is shown, s.
    #[serde(default)]
    pub settle_s: f64,
    /// How it is computed.
    #[serde(default)]
    pub solver: SolverSpec,
}

/// The cloth's outline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Outline {
    /// A rectangle.
    #[default]
    Rectangle,
    /// The ellipse that fits into it; a circle if it is a square.
    Ellipse,
}

/// How the cloth begins, smooth and without stretch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Start {
    /// Level, front up, its middle at a place; turned around the upright.
    Flat {
        /// The middle.
        centre_m: Xyz,
        /// Degrees, anticlockwise seen from above.
        #[serde(default)]
        turn: f64,
    },
    /// Upright, front to the viewer, the middle of its upper edge at a place.
    Hanging {
        /// The middle of the upper edge.
        top_m: Xyz,
        /// Degrees, anticlockwise seen from above.
        #[serde(default)]
        turn: f64,
    },
    /// On the outside of a ball, its middle to the viewer: columns are meridians, the middle row is the
    /// equator. Meant to be held everywhere, to show a picture on a ball.
    Sphere {
        /// The centre of the ball.
        centre_m: Xyz,
        /// Its radius.
        radius_m: f64,
    },
}

/// What holds the cloth: all particles within a distance of a place on it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Pin", deny_unknown_fields)]
pub struct PinSpec {
    /// Where on the cloth.
    pub at: Hold,
    /// Particles within this distance are held, m; the nearest always is.
    #[serde(default = "default_pin")]
    pub radius_m: f64,
    /// When it takes hold, s.
    #[serde(default)]
    pub from_s: f64,
    /// When it lets go, s. Left out: never.
    #[serde(default)]
    pub until_s: Option<f64>,
    /// Where it leads what it holds: moments (s after it took hold) and moves (m from where it did).
    #[serde(default)]
    pub path: Vec<(f64, Xyz)>,
}

/// Where a pin holds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Hold {
    /// A place on the cloth.
    Point(f64, f64),
    /// A line from place to place.
    Line(Place, Place),
    /// The whole cloth.
    All,
}

/// Something that the cloth falls on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum ColliderSpec {
    /// Everything below a height.
    Floor {
        /// The height.
        #[serde(default)]
        height_m: f64,
    },
    /// A ball.
    Ball {
        /// Its centre.
        centre_m: Xyz,
        /// Its radius.
        radius_m: f64,
    },
    /// A round table top.
    RoundTable {
        /// The middle of its upper side.
        centre_m: Xyz,
        /// Its radius.
        radius_m: f64,
        /// How thick it is.
        #[serde(default = "default_table")]
        thickness_m: f64,
        /// By how much its edge is rounded.
        #[serde(default = "default_edge")]
        edge_m: f64,
    },
    /// A rectangular table top.
    SquareTable {
        /// The middle of its upper side.
        centre_m: Xyz,
        /// Width and depth.
        size_m: (f64, f64),
        /// How thick it is.
        #[serde(default = "default_table")]
        thickness_m: f64,
        /// By how much its edges and corners are rounded.
        #[serde(default = "default_edge")]
        edge_m: f64,
    },
    /// Any solid of triangles.
    Mesh {
        /// Its corners.
        corners_m: Vec<Xyz>,
        /// Its triangles by the numbers of their corners, from 0.
        triangles: Vec<(u32, u32, u32)>,
    },
}

/// Wind.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Wind", deny_unknown_fields)]
pub struct WindSpec {
    /// Mean velocity, m/s. A light breeze is 1.6 to 3.3.
    pub velocity: Xyz,
    /// How much its speed varies (root mean square), as a share.
    #[serde(default = "default_gusts")]
    pub gusts: f64,
}

/// A line along which the cloth was pressed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Crease", deny_unknown_fields)]
pub struct CreaseSpec {
    /// Where it begins.
    pub from: Place,
    /// Where it ends.
    pub to: Place,
    /// Which side of the cloth is outside.
    #[serde(default)]
    pub fold: Fold,
    /// How far it folds if nothing holds it, degrees: 0 flat, 180 shut.
    #[serde(default = "default_angle")]
    pub angle: f64,
    /// Torque by length and angle, N·m/(m·rad). Left out: that of 2 mm of the cloth bent over.
    #[serde(default)]
    pub stiffness: Option<f64>,
}

/// The side to which a crease folds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Fold {
    /// The front is outside: a ridge seen from there.
    #[default]
    Mountain,
    /// The back is outside: a furrow seen from the front.
    Valley,
}

/// How draped cloth is computed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename = "DrapeSolver", deny_unknown_fields, default)]
pub struct SolverSpec {
    /// How time is stepped.
    pub integrator: Integrator,
    /// The longest step, s.
    pub step_s: f64,
    /// By how much conjugate gradients bring the residual of a step down.
    pub tolerance: f64,
    /// The most iterations of conjugate gradients in a step.
    pub iterations: usize,
    /// The distance that cloth keeps from everything, mm.
    pub apart_mm: f64,
    /// Whether it collides with itself.
    pub itself: bool,
    /// Whether there is air.
    pub air: bool,
    /// How uneven the cloth is in the beginning, mm: perfectly flat cloth would not know which way to
    /// fold.
    pub uneven_mm: f64,
}

impl Default for SolverSpec {
    fn default() -> Self {
        SolverSpec {
            integrator: Integrator::Bdf2,
            step_s: 1.0 / 180.0,
            tolerance: 1e-3,
            iterations: 40,
            apart_mm: 1.0,
            itself: true,
            air: true,
            uneven_mm: 0.2,
        }
    }
}

fn default_particles() -> (usize, usize) {
    (65, 65)
}

fn default_material() -> Material {
    Material::Muslin
}

/// Half the width of a clothes peg.
fn default_pin() -> f64 {
    0.008
}

fn default_table() -> f64 {
    0.03
}

fn default_edge() -> f64 {
    0.008
}

fn default_gusts() -> f64 {
    0.3
}

/// At which a link's ends are 0.7 of its length apart, as in paper C.
fn default_angle() -> f64 {
    91.146
}

impl DrapeSpec {
    /// Checks every value against what is possible.
    ///
    /// # Errors
    /// The first [`Problem`], with its field path and what is allowed there.
    pub fn check(&self, at: &Checker) -> Result<(), Problem> {
        let particles = at.field("particles");
        for (i, n) in [self.particles.0, self.particles.1].into_iter().enumerate() {
            particles.item(i).within(n, 2..=MOST_PARTICLES)?;
        }
        if let Some(size) = self.size_m {
            for (i, length) in [size.0, size.1].into_iter().enumerate() {
                at.field("size_m").item(i).within(length, 1e-4..=100.0)?;
            }
            self.check_cells(size, &particles)?;
        }
        self.material.check(&at.field("material"))?;
        self.start.check(&at.field("start"))?;
        for (i, pin) in self.pins.iter().enumerate() {
            pin.check(&at.field("pins").item(i))?;
        }
        for (i, collider) in self.on.iter().enumerate() {
            collider.check(&at.field("on").item(i))?;
        }
        if let Some(wind) = &self.wind {
            let at = at.field("wind");
            check_xyz(&at.field("velocity"), wind.velocity, 100.0)?;
            at.field("gusts").within(wind.gusts, 0.0..=2.0)?;
        }
        for (i, crease) in self.creases.iter().enumerate() {
            crease.check(&at.field("creases").item(i))?;
        }
        at.field("settle_s").within(self.settle_s, 0.0..=3600.0)?;
        self.solver.check(&at.field("solver"))
    }

    /// Refuses cells so long and thin that diagonals could not stand for shear.
    pub(super) fn check_cells(&self, size: (f64, f64), at: &Checker) -> Result<(), Problem> {
        let (dx, dy) = (
            size.0 / (self.particles.0 - 1) as f64,
            size.1 / (self.particles.1 - 1) as f64,
        );
        if (0.6..=1.0 / 0.6).contains(&(dx / dy)) {
            return Ok(());
        }
        let fitting = (size.1 / dx).round() + 1.0;
        Err(at.problem(format!(
            "particles should be about as far apart across as down, but they are {:.3} mm and {:.3} mm \
             apart; ({}, {fitting}) would do",
            1e3 * dx,
            1e3 * dy,
            self.particles.0
        )))
    }
}

fn check_xyz(at: &Checker, (x, y, z): Xyz, most: f64) -> Result<(), Problem> {
    for (i, value) in [x, y, z].into_iter().enumerate() {
        at.item(i).within(value, -most..=most)?;
    }
    Ok(())
}

fn check_place(at: &Checker, (u, v): Place) -> Result<(), Problem> {
    at.item(0).within(u, 0.0..=1.0)?;
    at.item(1).within(v, 0.0..=1.0)
}

impl Start {
    fn check(&self, at: &Checker) -> Result<(), Problem> {
        match *self {
            Start::Flat { centre_m, turn } => {
                check_xyz(&at.field("centre_m"), centre_m, FURTHEST)?;
                at.field("turn").within(turn, -360.0..=360.0)
            }
            Start::Hanging { top_m, turn } => {
                check_xyz(&at.field("top_m"), top_m, FURTHEST)?;
                at.field("turn").within(turn, -360.0..=360.0)
            }
            Start::Sphere { centre_m, radius_m } => {
                check_xyz(&at.field("centre_m"), centre_m, FURTHEST)?;
                at.field("radius_m").within(radius_m, 1e-4..=FURTHEST)
            }
        }
    }
}

impl PinSpec {
    fn check(&self, at: &Checker) -> Result<(), Problem> {
        let place = at.field("at");
        match self.at {
            Hold::Point(u, v) => check_place(&place, (u, v))?,
            Hold::Line(from, to) => {
                check_place(&place.item(0), from)?;
                check_place(&place.item(1), to)?;
            }
            Hold::All => {}
        }
        at.field("radius_m").within(self.radius_m, 0.0..=100.0)?;
        at.field("from_s").within(self.from_s, 0.0..=1e6)?;
        if let Some(until) = self.until_s {
            at.field("until_s").within(until, self.from_s..=1e6)?;
        }
        let mut before = 0.0;
        for (i, (moment, to)) in self.path.iter().enumerate() {
            let at = at.field("path").item(i);
            at.item(0).within(*moment, 0.0..=1e6)?;
            if *moment <= before {
                let moments = format!("moments go up, but {moment} s comes after {before} s");
                return Err(at.item(0).problem(moments));
            }
            before = *moment;
            check_xyz(&at.item(1), *to, FURTHEST)?;
        }
        Ok(())
    }
}

impl ColliderSpec {
    fn check(&self, at: &Checker) -> Result<(), Problem> {
        let check_slab = |thickness: f64, edge: f64, least: f64| {
            at.field("thickness_m").within(thickness, 1e-4..=FURTHEST)?;
            let most = 0.49 * least.min(2.0 * thickness);
            at.field("edge_m").within(edge, 0.0..=most)
        };
        match self {
            ColliderSpec::Floor { height_m } => {
                at.field("height_m").within(*height_m, -FURTHEST..=FURTHEST)
            }
            ColliderSpec::Ball { centre_m, radius_m } => {
                check_xyz(&at.field("centre_m"), *centre_m, FURTHEST)?;
                at.field("radius_m").within(*radius_m, 1e-4..=FURTHEST)
            }
            ColliderSpec::RoundTable {
                centre_m,
                radius_m,
                thickness_m,
                edge_m,
            } => {
                check_xyz(&at.field("centre_m"), *centre_m, FURTHEST)?;
                at.field("radius_m").within(*radius_m, 1e-3..=FURTHEST)?;
                check_slab(*thickness_m, *edge_m, *radius_m)
            }
            ColliderSpec::SquareTable {
                centre_m,
                size_m,
                thickness_m,
                edge_m,
            } => {
                check_xyz(&at.field("centre_m"), *centre_m, FURTHEST)?;
                for (i, length) in [size_m.0, size_m.1].into_iter().enumerate() {
                    at.field("size_m").item(i).within(length, 1e-3..=FURTHEST)?;
                }
                check_slab(*thickness_m, *edge_m, size_m.0.min(size_m.1))
            }
            ColliderSpec::Mesh {
                corners_m,
                triangles,
            } => {
                for (i, corner) in corners_m.iter().enumerate() {
                    check_xyz(&at.field("corners_m").item(i), *corner, FURTHEST)?;
                }
                if triangles.is_empty() {
                    return Err(at.field("triangles").problem("there is no triangle".into()));
                }
                let last = corners_m.len().saturating_sub(1) as u32;
                for (i, (a, b, c)) in triangles.iter().enumerate() {
                    let at = at.field("triangles").item(i);
                    for (k, corner) in [*a, *b, *c].into_iter().enumerate() {
                        at.item(k).within(corner, 0..=last)?;
                    }
                    if a == b || b == c || a == c {
                        return Err(at.problem("a triangle has three different corners".into()));
                    }
                }
                Ok(())
            }
        }
    }
}

impl CreaseSpec {
    fn check(&self, at: &Checker) -> Result<(), Problem> {
        check_place(&at.field("from"), self.from)?;
        check_place(&at.field("to"), self.to)?;
        if self.from == self.to {
            return Err(at
                .field("to")
                .problem("a crease ends where it does not begin".into()));
        }
        // Beyond, the side would no longer be certain: see `crease`.
        at.field("angle").within(self.angle, 1.0..=160.0)?;
        match self.stiffness {
            Some(stiffness) => at.field("stiffness").within(stiffness, 0.0..=1e3),
            None => Ok(()),
        }
    }
}

impl SolverSpec {
    fn check(&self, at: &Checker) -> Result<(), Problem> {
        at.field("step_s").within(self.step_s, 1e-6..=1.0)?;
        at.field("tolerance").within(self.tolerance, 1e-7..=0.1)?;
        at.field("iterations")
            .within(self.iterations, 1..=100_000)?;
        at.field("apart_mm").within(self.apart_mm, 0.01..=100.0)?;
        at.field("uneven_mm").within(self.uneven_mm, 0.0..=10.0)
    }
}
