//! Kasuri: yarns are dyed in sections before they are woven, so that the pattern has feathered edges
//! (paper Y, results; warp, weft or double).
//!
//! The pattern is that of the cloth as the weaver plans it. Each yarn is dyed where its own line crosses
//! the pattern. Dye bleeds along the yarn under the binding, which softens the edges of a section; and
//! on the loom no yarn lies exactly where it was planned, so the sections of neighbours are shifted.
//! What the yarns bring with them is bound dye at the beginning of the process: the cloth can be dyed
//! again.

use rayon::prelude::*;

use crate::chance::{Chance, Purpose, Sequence};
use crate::cloth::{Cloth, Layer, Span};
use crate::pattern::{Canvas, Raster};
use crate::scenario::KasuriSpec;

/// Bound dye A that the yarns bring, `(layer, y, x)`, as shares of a cell's volume; none where no yarn
/// was dyed.
pub fn bound(cloth: &Cloth, spec: &[Option<KasuriSpec>; 2], canvas: &Canvas) -> Option<Vec<f32>> {
    if spec.iter().all(Option::is_none) {
        return None;
    }
    let mut bound = vec![0.0; cloth.grid.len()];
    for (layer, spec) in Layer::BOTH.into_iter().zip(spec) {
        if let Some(spec) = spec {
            dye(cloth, layer, spec, canvas, &mut bound);
        }
    }
    Some(bound)
}

/// Dyes the yarns of one layer.
fn dye(cloth: &Cloth, layer: Layer, spec: &KasuriSpec, canvas: &Canvas, bound: &mut [f32]) {
    let plan = canvas.draw(&spec.pattern);
    let (yarns, length, purpose) = match layer {
        Layer::Weft => (&cloth.weft, cloth.grid.nx, Purpose::WeftKasuri),
        Layer::Warp => (&cloth.warp, cloth.grid.ny, Purpose::WarpKasuri),
    };
    let mut chance = Chance(canvas.seed).sequence(purpose);
    let [shift, bleed] = [spec.shift, spec.bleed].map(|length| length.cells(cloth.cell_mm));
    let mut draw = |span: &Span| {
        let moved = draw_shift(shift, &mut chance);
        (*span, moved, bleed * chance.between((0.6, 1.4)))
    };
    let drawn: Vec<(Span, f64, f64)> = yarns.spans().iter().map(&mut draw).collect();
    let dyed = drawn.into_par_iter().map(|(span, moved, bled)| {
        let middle = (span.middle() as usize).min(yarns.cells() - 1);
        (span, section(&plan, layer, middle, length, moved, bled))
    });
    for (span, section) in dyed.collect::<Vec<_>>() {
        for across in span.begin..(span.begin + span.width).min(yarns.cells()) {
            for (along, value) in section.iter().enumerate() {
                let (y, x) = match layer {
                    Layer::Weft => (across, along),
                    Layer::Warp => (along, across),
                };
                let amount = spec.amount as f32 * value * cloth.capacity_bound(layer, y, x);
                bound[cloth.grid.index(layer, y, x)] = amount;
            }
        }
    }
}

/// How far a yarn lies from where it was planned: most a little, few a lot.
fn draw_shift(most: f64, chance: &mut Sequence) -> f64 {
    let two = [0, 1].map(|_| chance.between((-0.5, 0.5)));
    most * (two[0] + two[1])
}

/// How much a yarn is dyed at every cell along it, 0 to 1: the pattern on its line, shifted, and bled
/// along the yarn as by a Gaussian of standard deviation `bleed`.
fn section(
    plan: &Raster,
    layer: Layer,
    middle: usize,
    length: usize,
    shift: f64,
    bleed: f64,
) -> Vec<f32> {
    let at = |along: i64| {
        // The yarn goes on beyond the cloth as it ends there.
        let along = along.clamp(0, length as i64 - 1) as usize;
        f64::from(match layer {
            Layer::Weft => plan.at(middle, along),
            Layer::Warp => plan.at(along, middle),
        })
    };
    let reach = (3.0 * bleed).ceil() as i64 + 1;
    let weight = |offset: f64| match bleed {
        b if b < 0.05 => (1.0 - offset.abs()).max(0.0),
        b => libm::exp(-0.5 * (offset / b) * (offset / b)),
    };
    let whole = shift.round();
    let weights: Vec<f64> = (-reach..=reach)
        .map(|i| weight(i as f64 + (shift - whole)))
        .collect();
    let sum: f64 = weights.iter().sum();
    let line: Vec<f64> = (-reach..length as i64 + reach)
        .map(|i| at(i - whole as i64))
        .collect();
    (0..length)
        .map(|i| {
            let window = line[i..].iter().zip(&weights);
            (window.map(|(value, weight)| value * weight).sum::<f64>() / sum) as f32
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stripes() -> Raster {
        Raster::from_rule(
            200,
            40,
            |x, _| {
                if (x / 40.0).fract() < 0.5 { 1.0 } else { 0.0 }
            },
        )
    }

    #[test]
    fn bleeding_softens_edges_and_neither_makes_nor_loses_dye() {
        let plan = stripes();
        let section = |bleed| section(&plan, Layer::Weft, 10, 200, 0.0, bleed);
        let steepest = |line: &[f32]| {
            let steps = line.windows(2).map(|pair| (pair[1] - pair[0]).abs());
            steps.fold(0.0, f32::max)
        };
        let (sharp, soft, softer) = (section(0.0), section(2.0), section(5.0));
        assert!(steepest(&sharp) == 1.0);
        assert!(steepest(&soft) < 0.5 && steepest(&softer) < steepest(&soft));
        // Away from the ends, over whole periods.
        let sum = |line: &[f32]| line[40..160].iter().sum::<f32>();
        assert!((sum(&soft) - sum(&sharp)).abs() < 1e-3);
        assert!((sum(&softer) - sum(&sharp)).abs() < 1e-2);
    }

    #[test]
    fn a_yarn_is_shifted_by_parts_of_a_cell_as_well() {
        let plan = stripes();
        // The middle of the dye of one section, whose edges are at 40 and 60.
        let middle = |shift| {
            let line = section(&plan, Layer::Weft, 10, 200, shift, 1.0);
            let section = line.iter().enumerate().skip(31).take(38);
            let (sum, place) = section.fold((0.0, 0.0), |(sum, place), (x, value)| {
                (sum + value, place + value * (x as f32 + 0.5))
            });
            place / sum
        };
        for shift in [-1.6, -0.4, 0.3, 0.6, 1.4] {
            let moved = middle(shift) - middle(0.0);
            assert!((moved - shift as f32).abs() < 0.05, "{shift}: {moved}");
        }
    }

    #[test]
    fn a_shifted_yarn_has_the_same_sections_elsewhere() {
        let plan = stripes();
        let still = section(&plan, Layer::Weft, 10, 200, 0.0, 1.5);
        let moved = section(&plan, Layer::Weft, 10, 200, 7.0, 1.5);
        for x in 20..190 {
            assert!((moved[x] - still[x - 7]).abs() < 1e-6);
        }
    }
}
