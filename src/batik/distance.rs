//! Distances to the nearest place of a set: exact Euclidean distance transforms.
//!
//! The transform is imageproc's (Felzenszwalb and Huttenlocher, *Distance Transforms of Sampled
//! Functions*, Theory of Computing 8, 2012). Strips of rows run side by side where only short
//! distances matter.

use image::{GrayImage, Luma};
use imageproc::distance_transform::euclidean_squared_distance_transform;
use rayon::prelude::*;

use crate::pattern::Raster;

/// Rows in a strip.
const STRIP: usize = 128;

/// Distance, in cells, from the middle of every cell to the middle of the nearest cell whose value
/// is at least `least`; `f32::INFINITY` where there is none.
pub fn distance_to(raster: &Raster, least: f32) -> Vec<f32> {
    transform(raster, least, 0..raster.ny)
}

/// As [`distance_to`], but whatever lies farther than `reach` cells may come out as any distance
/// greater than `reach`. Runs on all cores.
pub fn distance_within(raster: &Raster, least: f32, reach: usize) -> Vec<f32> {
    let (nx, ny) = (raster.nx, raster.ny);
    let mut distances = vec![0.0; nx * ny];
    distances
        .par_chunks_mut((nx * STRIP).max(1))
        .enumerate()
        .for_each(|(strip, own)| {
            let begin = strip * STRIP;
            let end = begin + own.len() / nx;
            // What can be within reach of this strip lies in it, or within reach above or below.
            let from = begin.saturating_sub(reach);
            let to = (end + reach).min(ny);
            let padded = transform(raster, least, from..to);
            own.copy_from_slice(&padded[(begin - from) * nx..(end - from) * nx]);
        });
    distances
}

fn transform(raster: &Raster, least: f32, rows: std::ops::Range<usize>) -> Vec<f32> {
    let nx = raster.nx;
    let inside = &raster.values[rows.start * nx..rows.end * nx];
    if !inside.iter().any(|value| *value >= least) {
        return vec![f32::INFINITY; inside.len()];
    }
    let bits = inside.iter().map(|value| u8::from(*value >= least));
    let mask = GrayImage::from_raw(nx as u32, rows.len() as u32, bits.collect());
    let squares = euclidean_squared_distance_transform(&mask.unwrap_or_default());
    squares
        .pixels()
        .map(|Luma([square])| square.sqrt() as f32)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::batik::noise;

    fn specks(nx: usize, ny: usize, one_in: u32) -> Raster {
        let mut raster = Raster::uniform(nx, ny, 0.0);
        for (i, value) in raster.values.iter_mut().enumerate() {
            if noise::hash(1, i as u32, 0).is_multiple_of(one_in) {
                *value = 1.0;
            }
        }
        raster
    }

    #[test]
    fn strips_and_the_whole_agree_within_reach() {
        let raster = specks(97, 400, 900);
        let whole = distance_to(&raster, 0.5);
        let strips = distance_within(&raster, 0.5, 20);
        for (a, b) in whole.iter().zip(&strips) {
            assert!(a == b || (*a > 20.0 && *b > 20.0), "{a} {b}");
        }
    }

    #[test]
    fn distances_are_those_to_the_nearest_cell() {
        let raster = specks(40, 30, 150);
        let distances = distance_to(&raster, 0.5);
        for y in 0..30 {
            for x in 0..40 {
                let nearest = (0..1200)
                    .filter(|i| raster.values[*i] > 0.5)
                    .map(|i| {
                        let (dx, dy) = (x as f32 - (i % 40) as f32, y as f32 - (i / 40) as f32);
                        (dx * dx + dy * dy).sqrt()
                    })
                    .fold(f32::INFINITY, f32::min);
                assert_eq!(distances[y * 40 + x], nearest);
            }
        }
    }

    #[test]
    fn where_there_is_nothing_it_is_infinitely_far() {
        let nothing = Raster::uniform(9, 7, 0.0);
        assert!(distance_to(&nothing, 0.5).iter().all(|d| d.is_infinite()));
        assert!(distance_within(&nothing, 0.5, 3).iter().all(|d| *d > 3.0));
    }
}
