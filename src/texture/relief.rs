//! The relief of the undyed cloth: heights and normals for a surface in 3D, from the same yarns that
//! the picture shows.

use rayon::prelude::*;

use super::geometry::Geometry;
use crate::cloth::Cloth;
use crate::scenario::YarnLook;

/// Height of the middle of a gap, in yarn radii: deeper than anything else.
const GAP_HEIGHT: f32 = -1.4;

/// The heights of a cloth, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Relief {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Height of every pixel over the middle of the cloth, in cells.
    pub heights: Vec<f32>,
    /// Cells along one side of a pixel.
    cells_a_pixel: f32,
}

impl Relief {
    /// The relief of a cloth at `scale` pixels a cell.
    pub fn new(cloth: &Cloth, look: &YarnLook, seed: u64, scale: usize) -> Self {
        let geometry = Geometry::new(cloth, look, seed);
        let (width, height) = (cloth.grid.nx * scale, cloth.grid.ny * scale);
        let heights = geometry.scan(scale, 1, |places| {
            let point = places[0].seen();
            point.height.max(GAP_HEIGHT) * point.radius
        });
        Relief {
            width,
            height,
            heights,
            cells_a_pixel: 1.0 / scale as f32,
        }
    }

    /// The heights from 0 (the deepest) to 65,535 (the highest).
    pub fn to_16_bit(&self) -> Vec<u16> {
        let least = self.heights.iter().copied().fold(f32::INFINITY, f32::min);
        let most = self
            .heights
            .iter()
            .copied()
            .fold(f32::NEG_INFINITY, f32::max);
        let scale = 65_535.0 / (most - least).max(1e-9);
        let step = |h: &f32| ((h - least) * scale + 0.5) as u16;
        self.heights.iter().map(step).collect()
    }

    /// The normal of every pixel as red, green and blue: x to the right, y **up** and z out of the
    /// cloth, −1 to 1 as 0 to 255 (the convention of OpenGL, glTF and Bevy).
    pub fn normals(&self) -> Vec<u8> {
        let (w, h) = (self.width, self.height);
        let mut normals = vec![0; w * h * 3];
        normals
            .par_chunks_mut(w * 3)
            .enumerate()
            .for_each(|(y, row)| {
                let line = |y: usize| &self.heights[y * w..(y + 1) * w];
                let (above, below) = (line(y.saturating_sub(1)), line((y + 1).min(h - 1)));
                let here = line(y);
                for (x, pixel) in row.chunks_exact_mut(3).enumerate() {
                    let (left, right) = (here[x.saturating_sub(1)], here[(x + 1).min(w - 1)]);
                    let slope = |d: f32| 0.5 * d / self.cells_a_pixel;
                    let normal = [-slope(right - left), slope(below[x] - above[x]), 1.0];
                    let length = normal.iter().map(|n| n * n).sum::<f32>().sqrt();
                    for (channel, n) in pixel.iter_mut().zip(normal) {
                        *channel = (127.5 * (n / length) + 128.0) as u8;
                    }
                }
            });
        normals
    }
}
