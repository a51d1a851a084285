//! Warp or weft for every pixel, and how sure that is.

use rayon::prelude::*;

use super::bends::{Bends, Weaving};
use super::relief::Fit;
use super::sides::Sides;
use crate::photo::Mask;
use crate::photo::plane::Plane;

/// The lead of one yarn over the other, in pitches, that makes its chance e times as great.
const LEAD: f32 = 0.1;
/// How much of what colour says counts: neighbouring pixels say much the same.
const COLOUR: f32 = 0.5;
/// Pixels over which colour is averaged: a standard deviation.
const COLOUR_BLUR: f32 = 0.5;
/// Evidence is cut off here.
const MOST: f32 = 30.0;

/// Decides every pixel of a photograph of `size`, of which `weaving` knows one made smaller by `factor`.
/// Returns the mask, and for every pixel the chance that it is wrong.
pub fn decide(
    weaving: &Weaving,
    sides: &Sides,
    factor: usize,
    (nx, ny): (usize, usize),
) -> (Mask, Vec<f32>) {
    let (bends, light) = weaving.bends();
    let colour = (sides.coloured > 0.0).then(|| colour(weaving, &bends, light, sides));
    let trust: Vec<f32> = weaving
        .crossed
        .iter()
        .map(|crossed| trust(*crossed))
        .collect();
    let evidence: Vec<f32> = (0..nx * ny)
        .into_par_iter()
        .map(|i| {
            // The middle of the pixel, in pixels of the smaller photograph.
            let place = |i: usize| (i as f32 + 0.5) / factor as f32 - 0.5;
            let (x, y) = (place(i % nx), place(i / nx));
            let trust = trust[nearest(weaving, x, y)];
            let lead = trust * weaving.place(&bends, x, y).lead() / LEAD;
            lead + colour.as_ref().map_or(0.0, |colour| colour.at(x, y))
        })
        .collect();
    let sure = sides.sure as f32;
    let doubt = evidence
        .iter()
        .map(|evidence| {
            let right = chance(evidence.abs());
            // Wrong if either this or the whole is the other way round, but not both.
            1.0 - (right * sure + (1.0 - right) * (1.0 - sure))
        })
        .collect();
    let mask = Mask {
        nx,
        ny,
        warp_on_top: evidence
            .into_iter()
            .map(|evidence| evidence > 0.0)
            .collect(),
    };
    (mask, doubt)
}

fn nearest(weaving: &Weaving, x: f32, y: f32) -> usize {
    let (nx, ny) = weaving.yarns[0].size();
    let inside = |i: f32, n: usize| (i.round().max(0.0) as usize).min(n - 1);
    weaving.crossings.at_pixel(inside(x, nx), inside(y, ny))
}

/// How much the weave says at a crossing with this evidence: 1 all, 0 nothing.
fn trust(crossed: f32) -> f32 {
    2.0 * chance(crossed.abs()) - 1.0
}

/// The chance that goes with evidence: the logistic function.
fn chance(evidence: f32) -> f32 {
    (1.0 / (1.0 + libm::exp(-f64::from(evidence)))) as f32
}

/// What colour says, pixel by pixel: how much better warp explains it than weft.
fn colour(weaving: &Weaving, bends: &Bends, light: Fit, sides: &Sides) -> Plane {
    let first = compared(weaving, bends, &light, sides);
    // Once more with the light of the pixels that are now known better.
    let (nx, ny) = (first.nx, first.ny);
    let warp: Vec<bool> = (0..nx * ny)
        .into_par_iter()
        .map(|i| {
            let (x, y) = (i % nx, i / nx);
            let lead = weaving.place(bends, x as f32, y as f32).lead();
            trust(weaving.crossed[weaving.crossings.at_pixel(x, y)]) * lead / LEAD + first.values[i]
                > 0.0
        })
        .collect();
    let light = weaving.light(bends, Some(&warp));
    compared(weaving, bends, &light, sides)
}

fn compared(weaving: &Weaving, bends: &Bends, light: &Fit, sides: &Sides) -> Plane {
    let contrast = weaving.contrast;
    let (nx, ny) = (contrast.light.nx, contrast.light.ny);
    let weight = COLOUR * sides.coloured as f32;
    Plane::new(nx, ny, |x, y| {
        let place = weaving.place(bends, x as f32, y as f32);
        let seen = [contrast.light.get(x, y), contrast.tint.get(x, y)];
        let off = |warp: bool| -> f32 {
            let shade = light.light.shade(&place.regressors(warp));
            (0..2)
                .map(|k| {
                    let apart = seen[k] - shade[k];
                    apart * apart / (2.0 * light.left[k] as f32 + 1e-4)
                })
                .sum()
        };
        (weight * (off(false) - off(true))).clamp(-MOST, MOST)
    })
    .blurred(COLOUR_BLUR)
}
