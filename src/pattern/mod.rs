//! Patterns: where on the cloth something is, and how much of it, from 0 (nothing) to 1 (all).
//!
//! Resist (paper D eq 9: the volume ratio B) and supply both take a pattern, from an image or from
//! the shapes that dyers tie, clamp, paste and paint, alone or combined.

mod raster;
mod seikaiha;
mod shapes;
mod strokes;

use serde::{Deserialize, Serialize};

pub use raster::{Canvas, Raster};
pub(crate) use shapes::clouds;
pub use strokes::{MOST_POINTS, Stroke};

use crate::scenario::check::{Checker, Problem};
use crate::scenario::units::Length;

/// The widest blur, in cells.
const WIDEST_BLUR: f64 = 1000.0;
/// The longest length in a pattern, in cells.
const LONGEST: f64 = 1e7;

/// A pattern over the whole cloth.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Pattern {
    /// Nothing anywhere.
    #[default]
    Nowhere,
    /// All of the cloth.
    Everywhere,
    /// The brightness of a picture: black 0, white 1.
    Image {
        /// The picture, PNG or JPEG, beside the scenario file.
        file: String,
        /// What to do with a picture of another size than the cloth.
        #[serde(default)]
        fit: Fit,
    },
    /// One round spot.
    Disc {
        /// Across the spot.
        diameter: Length,
        /// Where its middle is, as shares of the cloth across and down.
        #[serde(default = "middle")]
        centre: (f64, f64),
    },
    /// Round spots in rows.
    Discs {
        /// Across each spot.
        diameter: Length,
        /// From spot to spot.
        pitch: Length,
        /// Every other row moved by half a pitch.
        #[serde(default)]
        staggered: bool,
    },
    /// One rectangle.
    Rectangle {
        /// Across and down.
        size: (Length, Length),
        /// Where its middle is, as shares of the cloth across and down.
        #[serde(default = "middle")]
        centre: (f64, f64),
    },
    /// Straight stripes.
    Stripes {
        /// Width of a stripe.
        width: Length,
        /// Width of the space between stripes.
        gap: Length,
        /// Where the first stripe begins.
        #[serde(default = "nothing")]
        offset: Length,
        /// Degrees from upright: 0 runs down the cloth, 90 across it.
        #[serde(default)]
        angle: f64,
    },
    /// Rings around a middle, beginning with a disc.
    Rings {
        /// Width of a ring.
        width: Length,
        /// Width of the space between rings.
        gap: Length,
        /// Where the middle is, as shares of the cloth across and down.
        #[serde(default = "middle")]
        centre: (f64, f64),
    },
    /// Rays from a middle, as in a folded and clamped cloth.
    Rays {
        /// How many rays.
        count: u32,
        /// The share of the circle that is ray.
        #[serde(default = "half")]
        share: f64,
        /// Where the middle is, as shares of the cloth across and down.
        #[serde(default = "middle")]
        centre: (f64, f64),
    },
    /// A round patch that fades outwards.
    Radial {
        /// All of it up to this far from the middle.
        #[serde(default = "nothing")]
        from: Length,
        /// Nothing beyond this far from the middle.
        to: Length,
        /// Where the middle is, as shares of the cloth across and down.
        #[serde(default = "middle")]
        centre: (f64, f64),
    },
    /// From nothing at one edge to all at the other.
    Ramp {
        /// Degrees: 0 grows from left to right, 90 from top to bottom.
        #[serde(default)]
        angle: f64,
    },
    /// Clouds of chance.
    Noise {
        /// The size of a cloud.
        grain: Length,
        /// Finer and finer clouds on top of each other.
        #[serde(default = "three")]
        octaves: u32,
        /// Another number gives other clouds.
        #[serde(default)]
        seed: u32,
    },
    /// Waves of the blue sea: overlapping fans of rings. 1 is the paste, 0 the arcs left open.
    Seikaiha {
        /// Radius of a fan.
        radius: Length,
        /// Open arcs in a fan.
        arcs: u32,
        /// The share of a ring that its arc leaves open.
        #[serde(default = "half")]
        open: f64,
    },
    /// Strokes of a brush; where they cross the most of them counts.
    Strokes(Vec<Stroke>),
    /// Everything that is in any of these (the most of them).
    Union(Vec<Pattern>),
    /// Only what is in all of these (the least of them).
    Intersection(Vec<Pattern>),
    /// A pattern with another one cut out of it.
    Without {
        /// What to cut from.
        of: Box<Pattern>,
        /// What to cut away.
        cut: Box<Pattern>,
    },
    /// The other way round: 1 where it was 0.
    Invert(Box<Pattern>),
    /// With soft edges: a Gaussian blur.
    Blur {
        /// What to soften.
        of: Box<Pattern>,
        /// Standard deviation of the blur.
        radius: Length,
    },
    /// Weaker: every value multiplied.
    Strength {
        /// What to weaken.
        of: Box<Pattern>,
        /// By what, 0 to 1.
        by: f64,
    },
}

/// What to do with a picture of another size than the cloth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Fit {
    /// Refuse it: one pixel is one cell.
    #[default]
    Exact,
    /// Stretch or shrink it to the cloth.
    Stretch,
}

fn middle() -> (f64, f64) {
    (0.5, 0.5)
}

fn half() -> f64 {
    0.5
}

fn nothing() -> Length {
    Length::Cells(0.0)
}

fn three() -> u32 {
    3
}

impl Pattern {
    /// Reports values that make no pattern.
    ///
    /// # Errors
    /// A [`Problem`] that names the field and what is allowed there.
    pub fn check(&self, at: &Checker, cell_mm: f64) -> Result<(), Problem> {
        let width =
            |name: &str, length: &Length| length.check(&at.field(name), cell_mm, 1e-3, LONGEST);
        let any =
            |name: &str, length: &Length| length.check(&at.field(name), cell_mm, 0.0, LONGEST);
        let place = |(x, y): (f64, f64)| {
            let at = at.field("centre");
            at.item(0).within(x, -10.0..=10.0)?;
            at.item(1).within(y, -10.0..=10.0)
        };
        let degrees = |angle: f64| at.field("angle").within(angle, -360.0..=360.0);
        match self {
            Pattern::Nowhere | Pattern::Everywhere | Pattern::Image { .. } => Ok(()),
            Pattern::Disc { diameter, centre } => {
                width("diameter", diameter)?;
                place(*centre)
            }
            Pattern::Discs {
                diameter, pitch, ..
            } => {
                width("diameter", diameter)?;
                width("pitch", pitch)
            }
            Pattern::Rectangle { size, centre } => {
                let sides = at.field("size");
                size.0.check(&sides.item(0), cell_mm, 1e-3, LONGEST)?;
                size.1.check(&sides.item(1), cell_mm, 1e-3, LONGEST)?;
                place(*centre)
            }
            Pattern::Stripes {
                width: stripe,
                gap,
                offset,
                angle,
            } => {
                width("width", stripe)?;
                any("gap", gap)?;
                any("offset", offset)?;
                degrees(*angle)
            }
            Pattern::Rings {
                width: ring,
                gap,
                centre,
            } => {
                width("width", ring)?;
                any("gap", gap)?;
                place(*centre)
            }
            Pattern::Rays {
                count,
                share,
                centre,
            } => {
                at.field("count").within(*count, 1..=10_000)?;
                at.field("share").within(*share, 0.0..=1.0)?;
                place(*centre)
            }
            Pattern::Radial { from, to, centre } => {
                any("from", from)?;
                width("to", to)?;
                place(*centre)
            }
            Pattern::Ramp { angle } => degrees(*angle),
            Pattern::Noise { grain, octaves, .. } => {
                width("grain", grain)?;
                at.field("octaves").within(*octaves, 1..=12)
            }
            Pattern::Seikaiha { radius, arcs, open } => {
                radius.check(&at.field("radius"), cell_mm, 2.0, LONGEST)?;
                at.field("arcs").within(*arcs, 1..=1000)?;
                at.field("open").within(*open, 0.0..=1.0)
            }
            Pattern::Strokes(strokes) => strokes::check(strokes, &at.field("Strokes"), cell_mm),
            Pattern::Union(_)
            | Pattern::Intersection(_)
            | Pattern::Without { .. }
            | Pattern::Invert(_)
            | Pattern::Blur { .. }
            | Pattern::Strength { .. } => self.check_combination(at, cell_mm),
        }
    }

    fn check_combination(&self, at: &Checker, cell_mm: f64) -> Result<(), Problem> {
        match self {
            Pattern::Blur { radius, .. } => {
                radius.check(&at.field("radius"), cell_mm, 0.1, WIDEST_BLUR)?;
            }
            Pattern::Strength { by, .. } => at.field("by").within(*by, 0.0..=1.0)?,
            _ => {}
        }
        self.parts(at)
            .into_iter()
            .try_for_each(|(part, at)| part.check(&at, cell_mm))
    }

    /// This pattern with a stroke painted over it: what is in either, the most of them. A stroke joins
    /// the strokes that are painted last; painting goes on where it stopped.
    pub fn painted(self, stroke: Stroke) -> Pattern {
        match self {
            Pattern::Nowhere => Pattern::Strokes(vec![stroke]),
            Pattern::Strokes(mut strokes) => {
                strokes.push(stroke);
                Pattern::Strokes(strokes)
            }
            Pattern::Union(mut parts) => {
                match parts.last_mut() {
                    Some(Pattern::Strokes(strokes)) => strokes.push(stroke),
                    _ => parts.push(Pattern::Strokes(vec![stroke])),
                }
                Pattern::Union(parts)
            }
            other => Pattern::Union(vec![other, Pattern::Strokes(vec![stroke])]),
        }
    }

    /// The patterns that this one is combined from, each with its place in the scenario.
    pub fn parts(&self, at: &Checker) -> Vec<(&Pattern, Checker)> {
        let listed = |name: &str, parts: &'_ [Pattern]| {
            let at = at.field(name);
            (0..parts.len()).map(|i| at.item(i)).collect::<Vec<_>>()
        };
        match self {
            Pattern::Union(parts) => parts.iter().zip(listed("Union", parts)).collect(),
            Pattern::Intersection(parts) => {
                parts.iter().zip(listed("Intersection", parts)).collect()
            }
            Pattern::Without { of, cut } => {
                vec![(&**of, at.field("of")), (&**cut, at.field("cut"))]
            }
            Pattern::Invert(of) => vec![(&**of, at.field("Invert"))],
            Pattern::Blur { of, .. } | Pattern::Strength { of, .. } => {
                vec![(&**of, at.field("of"))]
            }
            _ => Vec::new(),
        }
    }

    /// How many rasters exist at once while this pattern is drawn.
    pub fn rasters_at_once(&self) -> usize {
        let parts = self.parts(&Checker::root());
        let deepest = parts.iter().map(|(part, _)| part.rasters_at_once()).max();
        // A blur keeps its source, an intermediate pass and its result.
        let own = if matches!(self, Pattern::Blur { .. }) {
            3
        } else {
            1
        };
        own + deepest.unwrap_or(0)
    }
}
