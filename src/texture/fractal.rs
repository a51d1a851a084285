//! Fractal yarns (paper Y): a unit yarn is a curve drawn by midpoint displacement, coloured where it
//! lies above a threshold, by its height; a yarn is the mean of several unit yarns.

use super::geometry::{Geometry, Place};
use super::shade::{Shade, samples, warp_share};
use super::yarn::YarnShade;
use crate::chance::{Chance, Purpose, Sequence};
use crate::cloth::{Cloth, Yarns};
use crate::scenario::{FractalLook, YarnLook};

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
/// gives each pixel its density (paper Y §3). Paper Y's cloth is flat and leaves its relief for later;
/// here as much of it is added as the look says.
pub fn draw(cloth: &Cloth, look: &FractalLook, seed: u64, scale: usize) -> Vec<Shade> {
    let yarns = |purpose, yarns: &Yarns, length| -> Vec<Vec<f32>> {
        let mut chance = Chance(seed).sequence(purpose);
        let all = 0..yarns.yarns.len();
        all.map(|_| yarn(look, length, &mut chance)).collect()
    };
    let densities = [
        yarns(Purpose::WeftFractal, &cloth.weft, cloth.grid.nx),
        yarns(Purpose::WarpFractal, &cloth.warp, cloth.grid.ny),
    ];
    let even = YarnLook {
        roughness: 0.0,
        hairiness: 0.0,
        unevenness: 0.5,
        ..YarnLook::default()
    };
    let light = YarnShade::new(even, cloth, seed, scale);
    let (contrast, relief) = (look.contrast as f32, look.relief as f32);
    let density = |place: &Place| {
        let point = place.seen();
        let yarn = &densities[place.layer as usize][point.yarn];
        let along = (point.along - 0.5).clamp(0.0, (yarn.len() - 1) as f32);
        let cell = (along as usize).min(yarn.len() - 1);
        let next = yarn[(cell + 1).min(yarn.len() - 1)];
        yarn[cell] + (next - yarn[cell]) * (along - cell as f32)
    };
    Geometry::new(cloth, &even, seed).scan(scale, samples(scale), |places| {
        let paler = |place| 1.0 - contrast * (1.0 - density(place));
        let sum: f32 = places.iter().map(paler).sum();
        let shade = sum / places.len() as f32 * (1.0 - relief * (1.0 - light.smooth(places)));
        Shade::new(warp_share(places), shade)
    })
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
