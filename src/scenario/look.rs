//! What a scenario says about the picture: which dye is shown, in which colours, on which yarns.

use serde::{Deserialize, Serialize};

use super::check::{Checker, Problem};
use crate::batik::ellipse::EllipseSpec;
use crate::pattern::Fit;

/// The most pixels along one side of a cell.
pub const LARGEST_SCALE: u32 = 64;

/// How the cloth is drawn (paper D §4.3).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Look", deny_unknown_fields, default)]
pub struct LookSpec {
    /// Which dye is shown.
    pub show: Show,
    /// The colours of dyed cloth from the lightest to the darkest.
    pub colours: Colours,
    /// The way from one of them to the next.
    pub path: ColourPath,
    /// The amount of dye in a cell that has the darkest colour. Left out: as much as the cloth holds.
    pub darkest_at: Option<f64>,
    /// Pixels along one side of a cell.
    pub pixels_per_cell: u32,
    /// Which side of the cloth is seen.
    pub side: Side,
    /// What the undyed cloth looks like.
    pub texture: TextureLook,
    /// How shaded yarns look.
    pub yarn: YarnLook,
}

impl Default for LookSpec {
    fn default() -> Self {
        LookSpec {
            show: Show::FreeAndBound,
            colours: Colours::Indigo,
            path: ColourPath::Hsv,
            darkest_at: None,
            pixels_per_cell: 1,
            side: Side::Face,
            texture: TextureLook::Shaded,
            yarn: YarnLook::default(),
        }
    }
}

/// A side of the cloth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Side {
    /// The side that the weave is drawn for.
    Face,
    /// The other one: left and right exchanged, and the yarns that lie beneath on top.
    Back,
}

/// What the undyed cloth looks like; the colour of the dye is multiplied with it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum TextureLook {
    /// Yarns of twisted fibre in the light, as `yarn` says (paper D §4.3.1 a).
    #[default]
    Shaded,
    /// Yarns whose colour is unevenly dense (paper Y).
    Fractal(FractalLook),
    /// A raised ellipse at every crossing, in HSV with noise (paper B §3.5, eq 8).
    Ellipses(EllipseSpec),
    /// A photograph of cloth beside the scenario file (paper D §4.3.1 b).
    Photo {
        /// The photograph, PNG or JPEG.
        file: String,
        /// What to do with one of another size than the cloth: one pixel is one cell.
        #[serde(default)]
        fit: Fit,
    },
}

/// Fractal yarns (paper Y §2).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Fractal", deny_unknown_fields, default)]
pub struct FractalLook {
    /// H of the curves: near 1 smooth, near 0 rough.
    pub roughness: f64,
    /// N: where a curve from 0 to 1 lies above it, the unit yarn has colour.
    pub threshold: f64,
    /// Unit yarns in a yarn.
    pub unit_yarns: u32,
    /// How much paler a place without any colour is, 0 to 1.
    pub contrast: f64,
    /// How much of the roundness of yarns is seen, 0 (flat, as in paper Y) to 1.
    pub relief: f64,
}

impl Default for FractalLook {
    fn default() -> Self {
        FractalLook {
            roughness: 0.5,
            threshold: 0.3,
            unit_yarns: 8,
            contrast: 0.6,
            relief: 0.7,
        }
    }
}

/// Which dye is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Show {
    /// All dye in the cloth.
    FreeAndBound,
    /// Only what has bound to the fibre: the cloth after rinsing (paper D Fig 9, lower row).
    BoundOnly,
}

/// The way from one stop of the colours to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum ColourPath {
    /// Straight in hue, saturation and value, hue the short way round (paper D §4.3.1).
    #[default]
    Hsv,
    /// Straight in perceived lightness, chroma and hue: equal steps of dye look equal.
    Oklch,
}

/// Colours of dyed cloth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Colours {
    /// Cotton dyed with indigo.
    Indigo,
    /// Cotton dyed with madder.
    Madder,
    /// Cotton dyed with walnut husks.
    Walnut,
    /// Three colours as (hue in degrees, saturation 0 to 1, value 0 to 1).
    Stops {
        /// Undyed cloth.
        lightest: (f64, f64, f64),
        /// Half dyed cloth.
        middle: (f64, f64, f64),
        /// Fully dyed cloth.
        darkest: (f64, f64, f64),
    },
}

impl Colours {
    /// The three stops in HSV, lightest first.
    pub fn stops(&self) -> [(f64, f64, f64); 3] {
        match *self {
            Colours::Indigo => [
                (205.0, 0.015, 0.985),
                (211.0, 0.62, 0.66),
                (226.0, 0.78, 0.30),
            ],
            Colours::Madder => [(30.0, 0.02, 0.985), (8.0, 0.66, 0.76), (354.0, 0.82, 0.42)],
            Colours::Walnut => [(40.0, 0.03, 0.985), (29.0, 0.52, 0.62), (20.0, 0.66, 0.28)],
            Colours::Stops {
                lightest,
                middle,
                darkest,
            } => [lightest, middle, darkest],
        }
    }
}

/// How a yarn is shaded: fibres wound in a helix around it (paper D §4.3.1; model section 6).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct YarnLook {
    /// Length of one full turn of the twist in yarn widths; negative for an S twist.
    pub turn: f64,
    /// Fibres that are seen around the yarn.
    pub fibres: u32,
    /// How deep the grooves between the fibres are, 0 to 1.
    pub roughness: f64,
    /// How differently thick and bright the yarns are, and how much they wander, 0 to 1.
    pub unevenness: f64,
    /// How many loose fibres stand out from them, 0 to 1.
    pub hairiness: f64,
    /// How much their fibres shine, 0 (cotton) to 1 (silk).
    pub lustre: f64,
}

impl Default for YarnLook {
    fn default() -> Self {
        YarnLook {
            turn: 5.0,
            fibres: 44,
            roughness: 0.3,
            unevenness: 0.4,
            hairiness: 0.35,
            lustre: 0.0,
        }
    }
}

impl LookSpec {
    pub(super) fn check(&self, at: &Checker) -> Result<(), Problem> {
        at.field("pixels_per_cell")
            .within(self.pixels_per_cell, 1..=LARGEST_SCALE)?;
        if let Some(amount) = self.darkest_at {
            at.field("darkest_at").within(amount, 0.001..=1.0)?;
        }
        if let Colours::Stops {
            lightest,
            middle,
            darkest,
        } = self.colours
        {
            let at = at.field("colours");
            at.field("lightest").hsv(lightest)?;
            at.field("middle").hsv(middle)?;
            at.field("darkest").hsv(darkest)?;
        }
        if let TextureLook::Fractal(look) = &self.texture {
            let at = at.field("texture").field("Fractal");
            at.field("roughness").within(look.roughness, 0.0..=1.0)?;
            at.field("threshold").within(look.threshold, 0.0..=1.0)?;
            at.field("unit_yarns").within(look.unit_yarns, 1..=100)?;
            at.field("contrast").within(look.contrast, 0.0..=1.0)?;
            at.field("relief").within(look.relief, 0.0..=1.0)?;
        }
        if let TextureLook::Ellipses(look) = &self.texture {
            let at = at.field("texture").field("Ellipses");
            for (name, value, most) in [
                ("paler", look.paler, 1.0),
                ("lighter", look.lighter, 1.0),
                ("shade", look.shade, 1.0),
                ("reach", look.reach, 100.0),
                ("cell_noise", look.cell_noise, 1.0),
                ("pixel_noise", look.pixel_noise, 1.0),
                ("blur", look.blur, 100.0),
            ] {
                at.field(name).within(value, 0.0..=most)?;
            }
            at.field("size").item(0).within(look.size.0, 0.01..=10.0)?;
            at.field("size").item(1).within(look.size.1, 0.01..=10.0)?;
        }
        let at = at.field("yarn");
        let turn = self.yarn.turn;
        if !(0.25..=1000.0).contains(&turn.abs()) {
            return Err(at.field("turn").problem(format!(
                "0.25 to 1000 (or −0.25 to −1000 for an S twist) is allowed, but this is {turn}"
            )));
        }
        at.field("fibres").within(self.yarn.fibres, 1..=1000)?;
        at.field("roughness")
            .within(self.yarn.roughness, 0.0..=1.0)?;
        at.field("unevenness")
            .within(self.yarn.unevenness, 0.0..=1.0)?;
        at.field("hairiness")
            .within(self.yarn.hairiness, 0.0..=1.0)?;
        at.field("lustre").within(self.yarn.lustre, 0.0..=1.0)
    }
}
