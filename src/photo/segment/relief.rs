//! The yarns as round bodies that rise over and dive beneath each other, and the light on them: by
//! which the outline of every yarn is found to a part of a pixel (analysis by synthesis).
//!
//! Heights are in yarn pitches. The axis of a yarn lies `crimp`/2 above the middle of the cloth where it
//! passes over, as far below where it passes under, and goes smoothly between. What light makes of it is
//! not known, and so it is fitted: lightness and tint are linear in what a surface depends on, apart
//! for warp and weft.

use crate::photo::plane::Plane;

/// What the lightness of a yarn may depend on: nothing, the place across it (light from one side), its
/// square and sixth power (the dark edges of a round body), the height and slope of its axis.
const TERMS: usize = 6;
/// The terms of both yarns, and how deep one looks into a gap.
pub const REGRESSORS: usize = 2 * TERMS + 1;
/// How tall a yarn of a pitch's width stands above its axis, in pitches.
const ROUND: f32 = 0.4;
/// How fast a yarn falls away beyond its edge, in its radii.
const BEYOND: f32 = 6.0;

/// The shape of the cloth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relief {
    /// How far yarns lie from where their number says, in yarns: warp, weft.
    pub shift: [f32; 2],
    /// Widths of yarns in pitches: warp, weft.
    pub width: [f32; 2],
    /// How far axes rise and dive, in pitches.
    pub crimp: f32,
}

impl Relief {
    /// Its five numbers.
    pub fn numbers(self) -> [f32; 5] {
        let ([u, v], [warp, weft]) = (self.shift, self.width);
        [u, v, warp, weft, self.crimp]
    }

    /// From its five numbers.
    pub fn from_numbers([u, v, warp, weft, crimp]: [f32; 5]) -> Self {
        Relief {
            shift: [u, v],
            width: [warp, weft],
            crimp,
        }
    }
}

/// A yarn at a place of the cloth.
#[derive(Debug, Clone, Copy)]
pub struct Surface {
    /// Its height.
    pub height: f32,
    /// The place across it, −1 to 1 from edge to edge.
    across: f32,
    /// Height of its axis, −1 beneath to 1 on top.
    axis: f32,
    /// Change of that from yarn to yarn.
    slope: f32,
}

/// Both yarns at a place of the cloth.
#[derive(Debug, Clone, Copy)]
pub struct Place {
    /// The warp.
    pub warp: Surface,
    /// The weft.
    pub weft: Surface,
}

impl Place {
    /// The place with these yarn numbers. `up` tells for an end and a pick 1 where the warp is on top,
    /// else −1; `aspect` is the pitch of warp and weft over their mean.
    #[inline]
    pub fn new(
        relief: &Relief,
        aspect: [f32; 2],
        number: [f64; 2],
        up: impl Fn(i64, i64) -> f32,
    ) -> Self {
        let u = number[0] - f64::from(relief.shift[0]);
        let v = number[1] - f64::from(relief.shift[1]);
        let (end, pick) = (u.floor(), v.floor());
        let (end_before, pick_before) = ((u - 0.5).floor(), (v - 0.5).floor());
        let (tu, tv) = (
            (u - 0.5 - end_before) as f32,
            (v - 0.5 - pick_before) as f32,
        );
        let (e, p) = (end as i64, pick as i64);
        let (e0, p0) = (end_before as i64, pick_before as i64);
        let surface = |place: f64, yarn: f64, k: usize, from: f32, to: f32, t: f32| {
            let across = 2.0 * ((place - yarn) as f32 - 0.5) / relief.width[k];
            let smooth = t * t * (3.0 - 2.0 * t);
            let axis = from + (to - from) * smooth;
            let beyond = across.abs() - 1.0;
            let round = if beyond < 0.0 {
                (1.0 - across * across).sqrt()
            } else {
                -BEYOND * beyond
            };
            Surface {
                height: 0.5 * relief.crimp * axis + ROUND * aspect[k] * relief.width[k] * round,
                across: across.clamp(-1.0, 1.0),
                axis,
                slope: (to - from) * 6.0 * t * (1.0 - t),
            }
        };
        Place {
            warp: surface(u, end, 0, up(e, p0), up(e, p0 + 1), tv),
            weft: surface(v, pick, 1, -up(e0, p), -up(e0 + 1, p), tu),
        }
    }

    /// How much higher the warp lies than the weft.
    pub fn lead(&self) -> f32 {
        self.warp.height - self.weft.height
    }

    /// What lightness depends on, if the warp is seen, or the weft.
    pub fn regressors(&self, warp: bool) -> [f32; REGRESSORS] {
        let (seen, begin) = if warp {
            (&self.warp, 0)
        } else {
            (&self.weft, TERMS)
        };
        let square = seen.across * seen.across;
        let mut regressors = [0.0; REGRESSORS];
        let terms = [
            1.0,
            seen.across,
            square,
            square * square * square,
            seen.axis,
            seen.slope,
        ];
        regressors[begin..begin + TERMS].copy_from_slice(&terms);
        let highest = self.warp.height.max(self.weft.height);
        regressors[2 * TERMS] = (-highest).clamp(0.0, 1.0);
        regressors
    }
}

/// What the light makes of a relief: a coefficient for each regressor, for lightness and for tint.
#[derive(Debug, Clone, PartialEq)]
pub struct Light {
    coefficients: [[f32; 2]; REGRESSORS],
}

impl Light {
    /// Lightness and tint of a place.
    #[inline]
    pub fn shade(&self, regressors: &[f32; REGRESSORS]) -> [f32; 2] {
        let mut shade = [0.0; 2];
        for (value, coefficients) in regressors.iter().zip(&self.coefficients) {
            shade[0] += value * coefficients[0];
            shade[1] += value * coefficients[1];
        }
        shade
    }
}

/// What is left over when a light is fitted.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The light.
    pub light: Light,
    /// Mean squares of what it leaves, lightness and tint.
    pub left: [f64; 2],
    /// The share of all variance that it leaves.
    pub share: f64,
}

/// Fits the light to a picture of lightness and tint, each value with its weight, by least squares.
/// `regressors` are blurred as the picture is.
pub fn fit(picture: [&Plane; 2], weight: Option<&Plane>, regressors: &[Plane]) -> Fit {
    let count = picture[0].values.len();
    let mut squares = [[0.0; REGRESSORS]; REGRESSORS];
    let mut products = [[0.0; 2]; REGRESSORS];
    let (mut total, mut sums, mut powers) = (0.0, [0.0; 2], [0.0; 2]);
    // Row by row in single precision, the rows in double: fast, and the same on any machine.
    let nx = picture[0].nx;
    for row in (0..count).step_by(nx) {
        let of = |plane: &'_ Plane| plane.values[row..row + nx].to_vec();
        let weights = weight.map_or_else(|| vec![1.0; nx], of);
        let weighted = |plane: &Plane| -> Vec<f32> {
            plane.values[row..row + nx]
                .iter()
                .zip(&weights)
                .map(|(v, w)| v * w)
                .collect()
        };
        let dot = |a: &[f32], b: &Plane| -> f64 {
            let b = &b.values[row..row + nx];
            f64::from(a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>())
        };
        total += f64::from(weights.iter().sum::<f32>());
        for k in 0..2 {
            let shade = weighted(picture[k]);
            sums[k] += f64::from(shade.iter().sum::<f32>());
            powers[k] += dot(&shade, picture[k]);
        }
        for (i, one) in regressors.iter().enumerate() {
            let one = weighted(one);
            for (j, other) in regressors.iter().enumerate().take(i + 1) {
                squares[i][j] += dot(&one, other);
            }
            for k in 0..2 {
                products[i][k] += dot(&one, picture[k]);
            }
        }
    }
    let mut triangle = squares;
    for (i, row) in triangle.iter_mut().enumerate() {
        row[i] += 1e-5 * total + 1e-9;
    }
    let coefficients = solve(triangle, products);
    // |y − Xb|² = |y|² − 2 b·Xᵀy + b·XᵀX·b.
    let left = [0, 1].map(|k| {
        let mut left = powers[k];
        for i in 0..REGRESSORS {
            left -= 2.0 * coefficients[i][k] * products[i][k];
            for j in 0..REGRESSORS {
                let square = if j <= i { squares[i][j] } else { squares[j][i] };
                left += coefficients[i][k] * coefficients[j][k] * square;
            }
        }
        left.max(0.0) / total.max(1e-9)
    });
    let variance: f64 = (0..2)
        .map(|k| powers[k] / total - (sums[k] / total) * (sums[k] / total))
        .sum();
    Fit {
        light: Light {
            coefficients: coefficients.map(|row| row.map(|c| c as f32)),
        },
        left,
        share: (left[0] + left[1]) / (variance + 1e-12),
    }
}

/// Solves a symmetric positive system, of which the lower triangle is given, for two right sides
/// (Cholesky).
fn solve(
    mut a: [[f64; REGRESSORS]; REGRESSORS],
    mut b: [[f64; 2]; REGRESSORS],
) -> [[f64; 2]; REGRESSORS] {
    for i in 0..REGRESSORS {
        for j in 0..=i {
            let known: f64 = a[i][..j].iter().zip(&a[j][..j]).map(|(x, y)| x * y).sum();
            let sum = a[i][j] - known;
            a[i][j] = if i == j {
                libm::sqrt(sum.max(1e-12))
            } else {
                sum / a[j][j]
            };
        }
    }
    let row = |known: [f64; 2], b: [f64; 2], pivot: f64| {
        [0, 1].map(|side| (b[side] - known[side]) / pivot)
    };
    let sum = |b: &[[f64; 2]], weight: &dyn Fn(usize) -> f64| {
        let mut sum = [0.0; 2];
        for (k, b) in b.iter().enumerate() {
            (0..2).for_each(|side| sum[side] += weight(k) * b[side]);
        }
        sum
    };
    for i in 0..REGRESSORS {
        let known = sum(&b[..i], &|k| a[i][k]);
        b[i] = row(known, b[i], a[i][i]);
    }
    for i in (0..REGRESSORS).rev() {
        let known = sum(&b[i + 1..], &|k| a[i + 1 + k][i]);
        b[i] = row(known, b[i], a[i][i]);
    }
    b
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(e: i64, p: i64) -> f32 {
        if (e + p).rem_euclid(2) == 0 {
            1.0
        } else {
            -1.0
        }
    }

    const RELIEF: Relief = Relief {
        shift: [0.0; 2],
        width: [0.9; 2],
        crimp: 0.7,
    };

    #[test]
    fn the_yarn_that_is_on_top_lies_higher_in_the_middle_of_a_crossing() {
        for (e, p) in [(0, 0), (1, 0), (3, 5), (-2, 7)] {
            let number = [e as f64 + 0.5, p as f64 + 0.5];
            let place = Place::new(&RELIEF, [1.0; 2], number, plain);
            assert_eq!(place.lead() > 0.0, plain(e, p) > 0.0);
        }
    }

    #[test]
    fn turning_plain_weave_by_a_right_angle_exchanges_warp_and_weft() {
        for (u, v) in [(0.1, 0.3), (1.45, 2.9), (4.0, 0.72)] {
            let here = Place::new(&RELIEF, [1.0; 2], [u, v], plain);
            let turned = Place::new(&RELIEF, [1.0; 2], [v, u], |e, p| -plain(p, e));
            assert!((here.lead() + turned.lead()).abs() < 1e-6);
        }
    }

    #[test]
    fn a_light_that_made_a_picture_is_found_again() {
        let places = |x: usize, y: usize| {
            let number = [x as f64 / 9.3, y as f64 / 8.1];
            let place = Place::new(&RELIEF, [1.0; 2], number, plain);
            place.regressors(place.lead() > 0.0)
        };
        let made = Light {
            coefficients: std::array::from_fn(|i| [0.1 * i as f32 - 0.4, 0.3 - 0.05 * i as f32]),
        };
        let (nx, ny) = (90, 70);
        let picture = [0, 1].map(|k| Plane::new(nx, ny, |x, y| made.shade(&places(x, y))[k]));
        let regressors: Vec<Plane> = (0..REGRESSORS)
            .map(|i| Plane::new(nx, ny, |x, y| places(x, y)[i]))
            .collect();
        let found = fit(picture.each_ref(), None, &regressors);
        assert!(found.share < 1e-3, "{}", found.share);
    }
}
