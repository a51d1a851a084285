//! What a scenario says about draped cloth: its material, how it begins, what holds it, what it falls on.
//!
//! Metres, seconds, degrees; x to the right, y up, z to the viewer. The cloth's own places run from (0, 0) at
//! its upper left corner to (1, 1) at its lower right, seen from the front.

mod checks;

use serde::{Deserialize, Serialize};

use super::drape::Integrator;
use super::material::Material;

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
