//! Fractal yarns (paper Y): a unit yarn is a curve drawn by midpoint displacement, coloured where it
//! lies above a threshold, by its height; a yarn is the mean of several unit yarns.

use rayon::prelude::*;

use super::shade::{Shade, seen};
use crate::chance::{Chance, Purpose, Sequence};
use crate::cloth::{Cloth, Layer};
use crate::scenario::FractalLook;

/// A curve by midpoint displacement of at least `length` points, 0 to 1.
///
/// Every halving draws displacements smaller by 2^(−H): H near 1 is smooth, near 0 rough (Fournier,
/// Fussell, Carpenter 1982, which paper Y cites).
fn curve(length: usize, h: f64, chance: &mut Sequence) -> Vec<f64> {
    let points = length.max(2).next_power_of_two() + 1;
    let mut curve = vec![0.0; points];
    curve[0] = chance.unit();
    curve[points - 1] = chance.unit();
    let mut step = points - 1;
    let mut reach = 0.5;
    while step > 1 {
        let half = step / 2;
        for middle in (half..points).step_by(step) {
            let mean = 0.5 * (curve[middle - half] + curve[middle + half]);
            curve[middle] = mean + chance.between((-reach, reach));
        }
        step = half;
        reach *= libm::exp2(-h);
    }
    let (least, most) = curve
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
            (a.min(*v), b.max(*v))
        });
    let scale = 1.0 / (most - least).max(1e-12);
    curve.truncate(length);
    curve.iter_mut().for_each(|v| *v = (*v - least) * scale);
    curve
}

/// The density of colour along one yarn of `length` cells, 0 to 1 (paper Y §2).
pub fn yarn(look: &FractalLook, length: usize, chance: &mut Sequence) -> Vec<f32> {
    let mut density = vec![0.0; length];
    for _ in 0..look.unit_yarns {
        let unit = curve(length, look.roughness, chance);
        for (sum, height) in density.iter_mut().zip(unit) {
            if height > look.threshold {
                *sum += height;
            }
        }
    }
    let mean = 1.0 / f64::from(look.unit_yarns);
    density.iter().map(|sum| (sum * mean) as f32).collect()
}

/// Draws undyed cloth of fractal yarns at `scale` pixels a cell, row by row: the yarn that is on top
/// gives each pixel its density (paper Y §3).
pub fn draw(cloth: &Cloth, look: &FractalLook, seed: u64, scale: usize) -> Vec<Shade> {
    let (nx, ny) = (cloth.grid.nx, cloth.grid.ny);
    let yarns = |purpose, count: usize, length| -> Vec<Vec<f32>> {
        let mut chance = Chance(seed).sequence(purpose);
        (0..count)
            .map(|_| yarn(look, length, &mut chance))
            .collect()
    };
    let weft = yarns(Purpose::WeftFractal, cloth.weft.yarns.len(), nx);
    let warp = yarns(Purpose::WarpFractal, cloth.warp.yarns.len(), ny);
    let paler = |density: f32| 1.0 - look.contrast as f32 * (1.0 - density);
    let mut picture = vec![Shade::default(); nx * scale * ny * scale];
    picture
        .par_chunks_mut(nx * scale)
        .enumerate()
        .for_each(|(py, row)| {
            let y = py / scale;
            for (px, shade) in row.iter_mut().enumerate() {
                let x = px / scale;
                let layer = seen(cloth, y, x);
                let value = if !cloth.fibre(layer, y, x) {
                    1.0 - look.contrast as f32
                } else {
                    paler(match layer {
                        Layer::Weft => weft[cloth.weft.number(y)][x],
                        Layer::Warp => warp[cloth.warp.number(x)][y],
                    })
                };
                *shade = Shade::new(layer, value);
            }
        });
    picture
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(h: f64) -> Vec<f64> {
        curve(4096, h, &mut Chance(5).sequence(Purpose::WarpFractal))
    }

    /// How much the curve moves over `lag` points, on average.
    fn moves(curve: &[f64], lag: usize) -> f64 {
        let pairs = curve.iter().zip(&curve[lag..]);
        pairs.map(|(a, b)| (a - b).abs()).sum::<f64>() / (curve.len() - lag) as f64
    }

    #[test]
    fn a_curve_is_as_rough_as_its_h_says() {
        // |Δ| ∝ lagᴴ.
        for h in [0.3, 0.5, 0.8] {
            let curve = drawn(h);
            let slope = libm::log2(moves(&curve, 32) / moves(&curve, 2)) / 4.0;
            assert!((slope - h).abs() < 0.12, "H {h} came out as {slope}");
        }
    }

    #[test]
    fn a_higher_threshold_never_makes_a_yarn_denser() {
        let yarn = |threshold| {
            let look = FractalLook {
                threshold,
                ..FractalLook::default()
            };
            yarn(&look, 500, &mut Chance(1).sequence(Purpose::WarpFractal))
        };
        for (low, high) in yarn(0.2).iter().zip(yarn(0.6)) {
            assert!(high <= *low);
        }
    }

    #[test]
    fn more_unit_yarns_make_an_evener_yarn() {
        let spread = |unit_yarns| {
            let look = FractalLook {
                unit_yarns,
                ..FractalLook::default()
            };
            let yarn = yarn(&look, 4000, &mut Chance(1).sequence(Purpose::WarpFractal));
            let mean = yarn.iter().sum::<f32>() / 4000.0;
            yarn.iter().map(|d| (d - mean) * (d - mean)).sum::<f32>() / 4000.0
        };
        assert!(spread(32) < spread(8) && spread(8) < spread(2));
    }
}
