//! The shade of every pixel of the undyed cloth, and which cell each place of it shows.

use rayon::prelude::*;

use super::yarn::{Point, YarnShade};
use crate::cloth::{Cloth, Layer, Yarns};
use crate::scenario::YarnLook;

/// Shade of a gap that is open through both layers.
const GAP_SHADE: f32 = 0.50;
/// Samples along one side of a cell at the least: what is finer than a pixel is averaged.
const SAMPLES_A_CELL: usize = 3;

/// The layer that is seen at a position: the yarn that is up, if it is fibre; else the other
/// layer's fibre; else the gap, seen in the weft layer.
pub fn seen(cloth: &Cloth, y: usize, x: usize) -> Layer {
    let (up, down) = if cloth.warp_up(y, x) {
        (Layer::Warp, Layer::Weft)
    } else {
        (Layer::Weft, Layer::Warp)
    };
    if cloth.fibre(up, y, x) {
        up
    } else if cloth.fibre(down, y, x) {
        down
    } else {
        Layer::Weft
    }
}

/// The cell whose dye gives a position its colour: the one that is seen. Through a gap nothing is
/// seen but the shaded side of the yarn beside it.
/// It lies in the same row: its layer and column.
pub(super) fn coloured_by(cloth: &Cloth, y: usize, x: usize) -> (Layer, usize) {
    let layer = seen(cloth, y, x);
    if cloth.fibre(layer, y, x) {
        return (layer, x);
    }
    let (warp, number) = (&cloth.warp, cloth.warp.number(x));
    (Layer::Warp, number * warp.pitch() + warp.width - 1)
}

/// A shade in two bytes: 0 to 2, far finer than the colours of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Shade(u16);

impl Shade {
    const STEPS: f32 = 32_767.5;

    fn new(shade: f32) -> Self {
        // Casting saturates.
        Shade((shade * Self::STEPS + 0.5) as u16)
    }

    /// The shade as a number.
    pub fn value(self) -> f32 {
        f32::from(self.0) * (1.0 / Self::STEPS)
    }
}

/// Draws the shade of undyed cloth at `scale` pixels a cell, row by row, 0 to about 1.
pub fn draw(cloth: &Cloth, look: YarnLook, seed: u64, scale: usize) -> Vec<Shade> {
    let shades = [
        YarnShade::new(look, &cloth.weft, false, seed),
        YarnShade::new(look, &cloth.warp, true, seed),
    ];
    let width = cloth.grid.nx * scale;
    let samples = SAMPLES_A_CELL.div_ceil(scale);
    let fine = (scale * samples) as f32;
    let mut picture = vec![Shade::default(); width * cloth.grid.ny * scale];
    picture
        .par_chunks_mut(width)
        .enumerate()
        .for_each(|(py, row)| {
            for (px, shade) in row.iter_mut().enumerate() {
                let (y, x) = (py / scale, px / scale);
                let layer = seen(cloth, y, x);
                if !cloth.fibre(layer, y, x) {
                    *shade = Shade::new(GAP_SHADE);
                    continue;
                }
                let yarns = &shades[layer as usize];
                let point = |v: f32, u: f32| point(cloth, layer, (y, x), (v, u));
                let mut sum = 0.0;
                for j in 0..samples {
                    let v = ((py * samples + j) as f32 + 0.5) / fine;
                    for i in 0..samples {
                        let u = ((px * samples + i) as f32 + 0.5) / fine;
                        sum += yarns.surface(point(v, u));
                    }
                }
                // What changes slowly along a yarn is taken once a pixel.
                let middle = |p: usize| (p as f32 + 0.5) / scale as f32;
                let uneven = yarns.unevenness(point(middle(py), middle(px)));
                *shade = Shade::new(uneven * sum / (samples * samples) as f32);
            }
        });
    picture
}

/// The point on the yarn of `layer` in the cell `(y, x)` at the place `(v, u)`, down and across in
/// cells.
fn point(cloth: &Cloth, layer: Layer, (y, x): (usize, usize), (v, u): (f32, f32)) -> Point {
    let (warp, weft) = (cloth.warp.number(x), cloth.weft.number(y));
    let warp_up = |e, p| if cloth.weave.warp_up(e, p) { 1.0 } else { -1.0 };
    let weft_up = |e, p| -warp_up(e, p);
    // Across and along each yarn, and the height of its axis there.
    let warp_across = across(&cloth.warp, warp, u);
    let weft_across = across(&cloth.weft, weft, v);
    let repeat = (cloth.weave.ends(), cloth.weave.picks());
    let warp_axis = axis(&cloth.weft, v, repeat.1, |crossing| warp_up(warp, crossing));
    let weft_axis = axis(&cloth.warp, u, repeat.0, |crossing| weft_up(crossing, weft));
    let warp_surface = warp_axis.height + round(warp_across);
    let weft_surface = weft_axis.height + round(weft_across);
    match layer {
        Layer::Warp => Point {
            yarn: warp,
            across: warp_across,
            along: v,
            clearance: warp_surface - weft_surface,
            slope: warp_axis.slope,
        },
        Layer::Weft => Point {
            yarn: weft,
            across: weft_across,
            along: u,
            clearance: weft_surface - warp_surface,
            slope: weft_axis.slope,
        },
    }
}

/// The place across a yarn: −1 at one edge, 1 at the other, beyond in the gap.
fn across(yarns: &Yarns, yarn: usize, place: f32) -> f32 {
    let radius = yarns.width as f32 / 2.0;
    (place - (yarn * yarns.pitch()) as f32 - radius) / radius
}

/// The height of a round yarn over its axis, in radii; beyond its edge it falls on.
fn round(across: f32) -> f32 {
    let square = across * across;
    if square < 1.0 {
        (1.0 - square).sqrt()
    } else {
        1.0 - square
    }
}

/// Where the axis of a yarn runs between the face and the back of the cloth.
struct Axis {
    /// 1 on the face, −1 on the back.
    height: f32,
    /// Its change per pitch.
    slope: f32,
}

/// The axis of a yarn at a place along it, in cells. `up` is its height at each crossing with
/// `crossed`, and repeats.
fn axis(crossed: &Yarns, place: f32, repeat: usize, up: impl Fn(usize) -> f32) -> Axis {
    // In pitches from the middle of the first yarn that is crossed. The cloth begins half a yarn
    // before it, so one repeat is added to stay above zero.
    let place = (place - crossed.width as f32 / 2.0) / crossed.pitch() as f32;
    let before = place.floor();
    let crossing = (before + repeat as f32) as usize;
    let (from, to) = (up(crossing), up(crossing + 1));
    let t = place - before;
    Axis {
        height: from + (to - from) * t * t * (3.0 - 2.0 * t),
        slope: (to - from) * 3.0 * t * (1.0 - t),
    }
}
