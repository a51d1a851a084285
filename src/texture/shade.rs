//! The shade of every pixel of the undyed cloth, and which cell each place of it shows.

use rayon::prelude::*;

use super::yarn::{Point, YarnShade};
use crate::cloth::{Cloth, Layer};
use crate::scenario::YarnLook;

/// Shade of a gap that is open through both layers.
const GAP_SHADE: f32 = 0.30;
/// Samples along one side of a cell at the least: what is finer than a pixel is averaged.
const SAMPLES_A_CELL: usize = 4;

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

/// Draws the shade of undyed cloth at `scale` pixels a cell, row by row, 0 to about 1.
pub fn draw(cloth: &Cloth, look: YarnLook, seed: u64, scale: usize) -> Vec<f32> {
    let shades = [
        YarnShade::new(look, &cloth.weft, false, seed),
        YarnShade::new(look, &cloth.warp, true, seed),
    ];
    let width = cloth.grid.nx * scale;
    let samples = SAMPLES_A_CELL.div_ceil(scale);
    let fine = (scale * samples) as f32;
    let mut picture = vec![0.0; width * cloth.grid.ny * scale];
    picture
        .par_chunks_mut(width)
        .enumerate()
        .for_each(|(py, row)| {
            for (px, shade) in row.iter_mut().enumerate() {
                let (y, x) = (py / scale, px / scale);
                let mut sum = 0.0;
                for j in 0..samples {
                    let v = ((py * samples + j) as f32 + 0.5) / fine;
                    for i in 0..samples {
                        let u = ((px * samples + i) as f32 + 0.5) / fine;
                        sum += at(cloth, &shades, (y, x), (v, u));
                    }
                }
                *shade = sum / (samples * samples) as f32;
            }
        });
    picture
}

/// The shade at a point `(v, u)`, down and across in cells, of the cell `(y, x)`.
fn at(cloth: &Cloth, shades: &[YarnShade; 2], (y, x): (usize, usize), (v, u): (f32, f32)) -> f32 {
    let layer = seen(cloth, y, x);
    if !cloth.fibre(layer, y, x) {
        return GAP_SHADE;
    }
    let point = match layer {
        Layer::Warp => on_yarn(cloth, layer, (x, u), v),
        Layer::Weft => on_yarn(cloth, layer, (y, v), u),
    };
    shades[layer as usize].at(point)
}

/// A point on a yarn, `across` it at a cell and a place in cells, and `along` it in cells.
fn on_yarn(cloth: &Cloth, layer: Layer, across: (usize, f32), along: f32) -> Point {
    let (own, crossed) = match layer {
        Layer::Warp => (&cloth.warp, &cloth.weft),
        Layer::Weft => (&cloth.weft, &cloth.warp),
    };
    let yarn = own.number(across.0);
    let middle = (yarn * own.pitch()) as f32 + own.width as f32 / 2.0;
    let up = |crossing: usize| {
        let warp_up = match layer {
            Layer::Warp => cloth.weave.warp_up(yarn, crossing),
            Layer::Weft => cloth.weave.warp_up(crossing, yarn),
        };
        if warp_up == (layer == Layer::Warp) {
            1.0
        } else {
            -1.0
        }
    };
    // In pitches from the middle of the first yarn that is crossed; the weave goes on beyond the
    // edge of the cloth, so one repeat of two is added to stay above zero.
    let place = (along - crossed.width as f32 / 2.0) / crossed.pitch() as f32;
    let before = place.floor();
    let from = up_at(&up, before, cloth);
    let to = up_at(&up, before + 1.0, cloth);
    let t = place - before;
    // A smooth rise from one crossing to the next.
    let rise = t * t * (3.0 - 2.0 * t);
    Point {
        yarn,
        across: (across.1 - middle) / (own.width as f32 / 2.0),
        along,
        height: from + (to - from) * rise,
        slope: (to - from) * 3.0 * t * (1.0 - t),
    }
}

/// The height at a crossing that may lie one before the first.
fn up_at(up: &impl Fn(usize) -> f32, crossing: f32, cloth: &Cloth) -> f32 {
    if crossing < 0.0 {
        let repeat = cloth.weave.ends() * cloth.weave.picks();
        up(repeat - 1)
    } else {
        up(crossing as usize)
    }
}
