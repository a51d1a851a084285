//! What a scenario says about how its draped cloth is seen: the camera and its way, the size of a frame.

use serde::{Deserialize, Serialize};

use super::check::{Checker, Problem};

/// A place in space, m: x to the right, y up, z to the viewer.
type Xyz = (f64, f64, f64);

/// The most pixels of a frame across or down.
pub const LARGEST_VIEW: u32 = 4096;

/// How draped cloth is seen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename = "View", deny_unknown_fields, default)]
pub struct ViewSpec {
    /// Pixels of a frame across and down.
    pub pixels: (u32, u32),
    /// Where it is seen from.
    pub camera: CameraSpec,
    /// Angle between the upper and the lower edge of what is seen, degrees.
    pub field_of_view: f64,
    /// The colour of the studio's ground: (hue in degrees, saturation, value).
    pub ground: (f64, f64, f64),
    /// Where the light comes from: degrees around the upright (0 from the viewer, 90 from the right)
    /// and above the horizon.
    pub light: (f64, f64),
    /// How long the cloth moves while it is dyed, s; it does so evenly over the whole process. 0: it
    /// has settled before.
    pub moves_s: f64,
}

impl Default for ViewSpec {
    fn default() -> Self {
        ViewSpec {
            pixels: (960, 720),
            camera: CameraSpec::default(),
            field_of_view: 30.0,
            ground: (36.0, 0.05, 0.82),
            light: (-38.0, 52.0),
            moves_s: 0.0,
        }
    }
}

/// The camera and its way from the beginning of the process to its end.
///
/// It looks at `at_m`; left out, at the middle of the cloth. Its distance is a multiple of the one at
/// which the whole cloth just fits into the frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum CameraSpec {
    /// It stands still.
    Still {
        /// Degrees around the upright: 0 in front, 90 at the right.
        #[serde(default = "default_turn")]
        turn: f64,
        /// Degrees above the horizon.
        #[serde(default = "default_elevation")]
        elevation: f64,
        /// How far away.
        #[serde(default = "default_distance")]
        distance: f64,
        /// What it looks at.
        #[serde(default)]
        at_m: Option<Xyz>,
    },
    /// It goes around the cloth.
    Orbit {
        /// Where it begins, degrees around the upright: 0 in front, 90 at the right.
        from: f64,
        /// Where it ends; 360 more than `from` is once around.
        to: f64,
        /// Degrees above the horizon.
        #[serde(default = "default_elevation")]
        elevation: f64,
        /// How far away.
        #[serde(default = "default_distance")]
        distance: f64,
        /// What it looks at.
        #[serde(default)]
        at_m: Option<Xyz>,
    },
    /// It comes nearer, or goes away.
    Dolly {
        /// How far away it begins.
        from: f64,
        /// How far away it ends.
        to: f64,
        /// Degrees around the upright: 0 in front, 90 at the right.
        #[serde(default = "default_turn")]
        turn: f64,
        /// Degrees above the horizon.
        #[serde(default = "default_elevation")]
        elevation: f64,
        /// What it looks at.
        #[serde(default)]
        at_m: Option<Xyz>,
    },
}

impl Default for CameraSpec {
    fn default() -> Self {
        CameraSpec::Still {
            turn: default_turn(),
            elevation: default_elevation(),
            distance: default_distance(),
            at_m: None,
        }
    }
}

fn default_turn() -> f64 {
    25.0
}

fn default_elevation() -> f64 {
    18.0
}

fn default_distance() -> f64 {
    1.0
}

/// Where the camera stands at one moment, in the terms of [`CameraSpec`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standing {
    /// Degrees around the upright.
    pub turn: f64,
    /// Degrees above the horizon.
    pub elevation: f64,
    /// Multiple of the distance at which the cloth fits.
    pub distance: f64,
    /// What it looks at, m, if not the middle of the cloth.
    pub at_m: Option<Xyz>,
}

impl CameraSpec {
    /// Where the camera stands when a share (0 to 1) of the process is done.
    pub fn at(&self, share: f64) -> Standing {
        let between = |from: f64, to: f64| from + share * (to - from);
        match *self {
            CameraSpec::Still {
                turn,
                elevation,
                distance,
                at_m,
            } => Standing {
                turn,
                elevation,
                distance,
                at_m,
            },
            CameraSpec::Orbit {
                from,
                to,
                elevation,
                distance,
                at_m,
            } => Standing {
                turn: between(from, to),
                elevation,
                distance,
                at_m,
            },
            CameraSpec::Dolly {
                from,
                to,
                turn,
                elevation,
                at_m,
            } => Standing {
                turn,
                elevation,
                distance: between(from, to),
                at_m,
            },
        }
    }

    fn check(&self, at: &Checker) -> Result<(), Problem> {
        // Both ends of its way: what lies between is then right as well.
        for share in [0.0, 1.0] {
            let standing = self.at(share);
            let (turn, distance) = match self {
                CameraSpec::Still { .. } => ("turn", "distance"),
                CameraSpec::Orbit { .. } if share == 0.0 => ("from", "distance"),
                CameraSpec::Orbit { .. } => ("to", "distance"),
                CameraSpec::Dolly { .. } if share == 0.0 => ("turn", "from"),
                CameraSpec::Dolly { .. } => ("turn", "to"),
            };
            at.field(turn).within(standing.turn, -36_000.0..=36_000.0)?;
            at.field("elevation")
                .within(standing.elevation, -89.0..=89.0)?;
            at.field(distance).within(standing.distance, 0.05..=20.0)?;
            if let Some((x, y, z)) = standing.at_m {
                for (i, value) in [x, y, z].into_iter().enumerate() {
                    at.field("at_m").item(i).within(value, -1e4..=1e4)?;
                }
            }
        }
        Ok(())
    }
}

impl ViewSpec {
    /// Checks every value against what is possible.
    ///
    /// # Errors
    /// The first [`Problem`], with its field path and what is allowed there.
    pub fn check(&self, at: &Checker) -> Result<(), Problem> {
        let pixels = at.field("pixels");
        for (i, n) in [self.pixels.0, self.pixels.1].into_iter().enumerate() {
            pixels.item(i).within(n, 16..=LARGEST_VIEW)?;
        }
        self.camera.check(&at.field("camera"))?;
        at.field("field_of_view")
            .within(self.field_of_view, 5.0..=120.0)?;
        at.field("ground").hsv(self.ground)?;
        at.field("light")
            .item(0)
            .within(self.light.0, -360.0..=360.0)?;
        at.field("light").item(1).within(self.light.1, 5.0..=90.0)?;
        at.field("moves_s").within(self.moves_s, 0.0..=3600.0)
    }
}
