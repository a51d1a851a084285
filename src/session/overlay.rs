//! Fields as pictures: what cannot be seen on the cloth itself, in colours with a scale.
//!
//! The colours go from dark violet over green to yellow, a way through OKLCH with even steps of
//! lightness: equal steps of a value look equal, it can be read in grey, and red-green blindness hides
//! nothing. What has no value (a gap's wax, say) is transparent.

use bevy::prelude::*;

use crate::adsorption::BoundDye;
use crate::batik::stage::Batik;
use crate::cloth::{Cloth, Layer};
use crate::diffusion::FreeDye;
use crate::texture::oklab::Oklch;
use crate::texture::seen;

/// A field that can be shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize)]
pub enum Field {
    /// c, the concentration of the liquid.
    Concentration,
    /// A, the dye bound to fibre.
    Bound,
    /// φ + A, all dye.
    AllDye,
    /// B, how far the cloth is squeezed shut.
    Resist,
    /// Where wax keeps a bath from the cloth.
    Wax,
    /// P, the share of pores.
    Porosity,
    /// Which layer is on top.
    Weave,
}

/// Which layer's field is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Seen {
    /// What lies on top of the cloth.
    #[default]
    Top,
    /// The weft, also where it lies beneath.
    Weft,
    /// The warp, also where it lies beneath.
    Warp,
}

impl Field {
    /// All of them, in the order of a menu.
    pub const ALL: [Field; 7] = [
        Field::Concentration,
        Field::Bound,
        Field::AllDye,
        Field::Resist,
        Field::Wax,
        Field::Porosity,
        Field::Weave,
    ];

    /// What a menu calls it.
    pub fn name(self) -> &'static str {
        match self {
            Field::Concentration => "concentration",
            Field::Bound => "bound dye",
            Field::AllDye => "all dye",
            Field::Resist => "resist",
            Field::Wax => "wax",
            Field::Porosity => "porosity",
            Field::Weave => "weave",
        }
    }

    /// What it measures, in a legend.
    pub fn unit(self) -> &'static str {
        match self {
            Field::Concentration => "share of a full dye bath",
            Field::Bound | Field::AllDye => "dye, as a share of the cell",
            Field::Resist => "share of the cell squeezed shut",
            Field::Wax => "share of the bath kept out",
            Field::Porosity => "pores, as a share of the yarn",
            Field::Weave => "weft 0, warp 1",
        }
    }
}

/// A field on the cloth, as values: row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlay {
    /// Which field.
    pub field: Field,
    /// Cells across.
    pub nx: usize,
    /// Cells down.
    pub ny: usize,
    /// The value of every position; NaN where there is none.
    pub values: Vec<f32>,
    /// What the first and the last colour stand for.
    pub range: (f32, f32),
}

/// A mark on a legend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// The value.
    pub value: f32,
    /// Where it stands, 0 at the beginning of the scale to 1 at its end.
    pub at: f32,
    /// Its colour, 8-bit RGB.
    pub colour: [u8; 3],
}

impl Overlay {
    /// A field of a world as it is now. Its scale goes from 0 to 1, or to the highest value rounded up if
    /// `fitted`.
    pub fn of(world: &World, field: Field, layer: Seen, fitted: bool) -> Self {
        let cloth = world.resource::<Cloth>();
        let (free, bound) = (world.resource::<FreeDye>(), world.resource::<BoundDye>());
        let wax = world.get_resource::<Batik>().and_then(Batik::wax);
        let (nx, ny) = (cloth.grid.nx, cloth.grid.ny);
        let value = |y: usize, x: usize| {
            let layer = match layer {
                Seen::Top => seen(cloth, y, x),
                Seen::Weft => Layer::Weft,
                Seen::Warp => Layer::Warp,
            };
            let i = cloth.grid.index(layer, y, x);
            let c = || free.concentration.get(i).copied().unwrap_or(0.0);
            match field {
                Field::Concentration => c(),
                Field::Bound => bound.at(i),
                Field::AllDye => c() * cloth.capacity_free(layer, y, x) + bound.at(i),
                Field::Resist => cloth.volume_ratio(layer, y, x) as f32,
                Field::Wax => wax.map_or(f32::NAN, |wax| 1.0 - wax.permeation.at(y, x)),
                Field::Porosity => cloth.porosity(layer, y, x) as f32,
                Field::Weave => f32::from(u8::from(cloth.warp_up(y, x))),
            }
        };
        let values: Vec<f32> = (0..nx * ny).map(|i| value(i / nx, i % nx)).collect();
        let most = values.iter().copied().filter(|v| v.is_finite());
        let most = most.fold(0.0, f32::max);
        let end = if fitted { rounded_up(most) } else { 1.0 };
        Overlay {
            field,
            nx,
            ny,
            values,
            range: (0.0, end),
        }
    }

    /// As a picture, 8-bit RGBA, one pixel a cell.
    pub fn rgba(&self) -> Vec<u8> {
        let scale = Scale::new();
        let (low, high) = self.range;
        let pixel = |value: &f32| match value.is_finite() {
            true => {
                let [r, g, b] = scale.colour((value - low) / (high - low));
                [r, g, b, 255]
            }
            false => [0; 4],
        };
        self.values.iter().flat_map(pixel).collect()
    }

    /// Marks for a legend: both ends and the quarters between; of the weave only the ends.
    pub fn stops(&self) -> Vec<Stop> {
        let scale = Scale::new();
        let (low, high) = self.range;
        let marks: &[f32] = match self.field {
            Field::Weave => &[0.0, 1.0],
            _ => &[0.0, 0.25, 0.5, 0.75, 1.0],
        };
        let stop = |at: &f32| Stop {
            value: low + at * (high - low),
            at: *at,
            colour: scale.colour(*at),
        };
        marks.iter().map(stop).collect()
    }
}

/// The next of 1, 2, 5, 10, … times a power of ten that is no less; 1 at the most, and never nothing.
fn rounded_up(most: f32) -> f32 {
    let steps = [1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1_f32];
    let candidates = steps
        .into_iter()
        .flat_map(|ten| [1.0, 2.0, 5.0].map(|times| times * ten));
    candidates
        .chain([1.0])
        .find(|candidate| *candidate >= most)
        .unwrap_or(most)
}

/// The colours of values from 0 to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Scale {
    colours: Vec<[u8; 3]>,
}

/// The ends of the scale: dark violet, and yellow.
const FIRST: Oklch = Oklch {
    lightness: 0.24,
    chroma: 0.11,
    hue: 305.0,
};
const LAST: Oklch = Oklch {
    lightness: 0.92,
    chroma: 0.17,
    hue: 105.0,
};

impl Default for Scale {
    fn default() -> Self {
        Scale::new()
    }
}

impl Scale {
    /// The scale.
    pub fn new() -> Self {
        let colour = |i: i32| {
            let t = f64::from(i) / 255.0;
            let between = |a: f64, b: f64| a + t * (b - a);
            let lch = Oklch {
                lightness: between(FIRST.lightness, LAST.lightness),
                chroma: between(FIRST.chroma, LAST.chroma),
                hue: between(FIRST.hue, LAST.hue),
            };
            lch.to_rgb().map(|channel| (255.0 * channel + 0.5) as u8)
        };
        Scale {
            colours: (0..256).map(colour).collect(),
        }
    }

    /// The colour of a value; beyond the ends, that of the end.
    pub fn colour(&self, value: f32) -> [u8; 3] {
        // Casting saturates.
        let entry = (255.0 * value + 0.5) as usize;
        self.colours[entry.min(255)]
    }
}
