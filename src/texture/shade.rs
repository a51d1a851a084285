//! The shade of every pixel of the undyed cloth, and which layer each shows.

use rayon::prelude::*;

use super::geometry::{Geometry, Place};
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

/// What a pixel shows, in two bytes: how much of it is warp rather than weft, in fifteenths, and its
/// shade, 0 to 2, finer than the colours of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Shade(u16);

impl Shade {
    const BITS: u32 = 12;
    const MOST: u16 = (1 << Self::BITS) - 1;
    const STEPS: f32 = Self::MOST as f32 / 2.0;
    const ALL: f32 = 15.0;

    /// A pixel of which the share `warp` shows the warp, with a shade from 0 to 2.
    pub fn new(warp: f32, shade: f32) -> Self {
        // Casting saturates.
        let warp = (warp * Self::ALL + 0.5) as u16;
        Shade((warp.min(15) << Self::BITS) | steps(shade))
    }

    /// The same pixel in another shade.
    pub fn shaded(self, shade: f32) -> Self {
        Shade((self.0 & !Self::MOST) | steps(shade))
    }

    /// The shade as a number.
    #[inline]
    pub fn value(self) -> f32 {
        f32::from(self.0 & Self::MOST) * (1.0 / Self::STEPS)
    }

    /// The share that shows the warp.
    #[inline]
    pub fn warp(self) -> f32 {
        f32::from(self.0 >> Self::BITS) * (1.0 / Self::ALL)
    }

    /// The layer, if only one is seen.
    #[inline]
    pub fn only(self) -> Option<Layer> {
        match self.0 >> Self::BITS {
            0 => Some(Layer::Weft),
            15 => Some(Layer::Warp),
            _ => None,
        }
    }
}

fn steps(shade: f32) -> u16 {
    ((shade * Shade::STEPS + 0.5) as u16).min(Shade::MOST)
}

/// How much of a pixel shows the warp.
pub fn warp_share(places: &[Place]) -> f32 {
    let warp = places.iter().filter(|place| place.layer == Layer::Warp);
    warp.count() as f32 / places.len() as f32
}

/// Samples along one side of a pixel: what is finer than a pixel is averaged.
pub fn samples(scale: usize) -> usize {
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
        Shade::new(warp_share(places), yarns.of(places))
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
                let layer = seen(cloth, py / scale, px / scale);
                *shade = Shade::new(f32::from(layer as u8), 1.0);
            }
        });
    picture
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_keeps_its_layers_and_its_shade_to_a_fraction_of_a_step_of_the_picture() {
        for warp in 0..=15_u8 {
            let share = f32::from(warp) / 15.0;
            for i in 0..200 {
                let shade = i as f32 / 100.0;
                let kept = Shade::new(share, 0.3).shaded(shade);
                assert!((kept.warp() - share).abs() < 1e-6);
                assert!((kept.value() - shade).abs() < 3e-4);
            }
        }
        assert_eq!(Shade::new(0.0, 1.0).only(), Some(Layer::Weft));
        assert_eq!(Shade::new(1.0, 1.0).only(), Some(Layer::Warp));
        assert_eq!(Shade::new(0.5, 1.0).only(), None);
    }
}
