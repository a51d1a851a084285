//! Loose fibres that stand out from yarns (hairiness).

use libm::{cosf, sinf};

use super::noise;
use super::shade::Shade;
use crate::cloth::{Cloth, Layer, Yarns};
use crate::scenario::YarnLook;

/// Hairs on each stretch of a yarn that is as long as it is wide, for a hairiness of 1.
const HAIRS: f32 = 9.0;
/// The longest hair, in widths of its yarn.
const LONGEST: f32 = 0.9;
/// Brightness of a hair: it lies on top, in the light.
const BRIGHT: f32 = 0.95;
/// How much of what lies beneath a hair of one pixel hides.
const OPACITY: f32 = 0.22;
/// Where hairs are thinner than this part of a pixel none are drawn.
const THINNEST: f32 = 0.12;

/// Draws hairs over a picture of `scale` pixels a cell.
pub fn draw(cloth: &Cloth, look: &YarnLook, seed: u64, scale: usize, picture: &mut [Shade]) {
    if look.hairiness <= 0.0 {
        return;
    }
    for (layer, yarns, length) in [
        (Layer::Weft, &cloth.weft, cloth.grid.nx),
        (Layer::Warp, &cloth.warp, cloth.grid.ny),
    ] {
        let seed = noise::seed(seed, 200 + layer as u32);
        let mut pen = Pen {
            layer,
            scale: scale as f32,
            size: (cloth.grid.nx * scale, cloth.grid.ny * scale),
            picture: &mut *picture,
        };
        pen.yarns(yarns, length, look, seed);
    }
}

struct Pen<'a> {
    layer: Layer,
    scale: f32,
    size: (usize, usize),
    picture: &'a mut [Shade],
}

impl Pen<'_> {
    fn yarns(&mut self, yarns: &Yarns, length: usize, look: &YarnLook, seed: u32) {
        for (yarn, span) in yarns.spans().iter().enumerate() {
            let width = span.width as f32;
            let alpha = OPACITY * (self.scale * width / 40.0).min(1.0);
            if alpha < THINNEST * OPACITY {
                continue;
            }
            let hairs = (HAIRS * look.hairiness as f32 * length as f32 / width) as u32;
            for hair in 0..hairs {
                // Numbers without order, four to a hair.
                let draw = |i: u32| {
                    let place = (hair * 4 + i) as f32;
                    0.5 + 0.5 * noise::along(place, seed ^ (yarn as u32).wrapping_mul(0x9e37_79b1))
                };
                let root = draw(0) * length as f32;
                let side = if draw(1) < 0.5 { -1.0 } else { 1.0 };
                let across = span.begin as f32 + width * (0.5 + side * (0.2 + 0.3 * draw(2)));
                let long = LONGEST * width * (0.3 + 0.7 * draw(3));
                // It leaves its yarn at a slant and bends back along it.
                let slant = 0.25 + 1.1 * draw(2);
                let bend = 5.0 * (draw(1) - 0.5);
                self.hair([root, across], side, slant, bend, long, alpha);
            }
        }
    }

    fn hair(
        &mut self,
        [mut along, mut across]: [f32; 2],
        side: f32,
        slant: f32,
        bend: f32,
        long: f32,
        alpha: f32,
    ) {
        let step = 0.7 / self.scale;
        let steps = (long / step) as usize;
        for i in 0..steps {
            let t = i as f32 / steps as f32;
            let angle = slant + bend * t;
            along += step * cosf(angle);
            across += step * side * sinf(angle);
            let (v, u) = match self.layer {
                Layer::Weft => (across, along),
                Layer::Warp => (along, across),
            };
            self.dot(v * self.scale, u * self.scale, alpha * (1.0 - t));
        }
    }

    /// Lightens the four pixels around a place.
    fn dot(&mut self, v: f32, u: f32, alpha: f32) {
        let (v, u) = (v - 0.5, u - 0.5);
        let (fv, fu) = (v.floor(), u.floor());
        for (dy, dx) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let (y, x) = (fv as i64 + dy, fu as i64 + dx);
            let inside =
                (0..self.size.1 as i64).contains(&y) && (0..self.size.0 as i64).contains(&x);
            if !inside {
                continue;
            }
            let cover = (1.0 - (v - y as f32).abs()) * (1.0 - (u - x as f32).abs());
            let pixel = &mut self.picture[y as usize * self.size.0 + x as usize];
            let shade = pixel.value();
            let lighter = shade + alpha * cover * (BRIGHT - shade).max(0.0);
            *pixel = pixel.shaded(lighter);
        }
    }
}
