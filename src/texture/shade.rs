//! The shade of every pixel of the undyed cloth, and which layer each shows.

use rayon::prelude::*;

use super::geometry::Geometry;
use super::hair;
use super::yarn::YarnShade;
use crate::cloth::{Cloth, Layer};
use crate::scenario::YarnLook;

/// The layer that is seen at a position: the yarn that is up, if it is fibre; else the other
/// layer's fibre; else the gap, seen in the weft layer (model section 6).
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

/// What a pixel shows, in two bytes: the layer in the highest bit, and its shade, 0 to 2, far finer
/// than the colours of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Shade(u16);

impl Shade {
    const WARP: u16 = 1 << 15;
    const STEPS: f32 = 16_383.5;

    /// A pixel that shows `layer` with a shade from 0 to 2.
    pub fn new(layer: Layer, shade: f32) -> Self {
        // Casting saturates.
        let steps = ((shade * Self::STEPS + 0.5) as u16).min(Self::WARP - 1);
        Shade(match layer {
            Layer::Weft => steps,
            Layer::Warp => steps | Self::WARP,
        })
    }

    /// The shade as a number.
    #[inline]
    pub fn value(self) -> f32 {
        f32::from(self.0 & !Self::WARP) * (1.0 / Self::STEPS)
    }

    /// The layer that is seen.
    #[inline]
    pub fn layer(self) -> Layer {
        Layer::BOTH[usize::from(self.0 >> 15)]
    }
}

/// Samples along one side of a pixel: what is finer than a pixel is averaged.
fn samples(scale: usize) -> usize {
    match scale {
        1 => 3,
        _ => 2,
    }
}

/// Draws undyed cloth of shaded yarns at `scale` pixels a cell, row by row.
pub fn draw(cloth: &Cloth, look: YarnLook, seed: u64, scale: usize) -> Vec<Shade> {
    let geometry = Geometry::new(cloth, &look, seed);
    let yarns = YarnShade::new(look, cloth, seed, scale);
    let mut picture = geometry.scan(scale, samples(scale), |places| {
        let warp = places.iter().filter(|place| place.layer == Layer::Warp);
        let layer = Layer::BOTH[usize::from(2 * warp.count() > places.len())];
        Shade::new(layer, yarns.of(places))
    });
    hair::draw(cloth, &look, seed, scale, &mut picture);
    picture
}

/// Cloth without any shade of its own, for a photograph to give it one: only the layers.
pub fn flat(cloth: &Cloth, scale: usize) -> Vec<Shade> {
    let width = cloth.grid.nx * scale;
    let mut picture = vec![Shade::default(); width * cloth.grid.ny * scale];
    picture
        .par_chunks_mut(width)
        .enumerate()
        .for_each(|(py, row)| {
            for (px, shade) in row.iter_mut().enumerate() {
                *shade = Shade::new(seen(cloth, py / scale, px / scale), 1.0);
            }
        });
    picture
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_keeps_its_layer_and_its_shade_to_a_fraction_of_a_step_of_the_picture() {
        for layer in Layer::BOTH {
            for i in 0..200 {
                let shade = i as f32 / 100.0;
                let kept = Shade::new(layer, shade);
                assert_eq!(kept.layer(), layer);
                assert!((kept.value() - shade).abs() < 1e-4);
            }
        }
    }
}
