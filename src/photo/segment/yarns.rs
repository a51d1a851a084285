//! Which yarn a pixel lies on: a number that grows by one from yarn to yarn and follows them where they
//! bend.
//!
//! The contrast is multiplied by the yarns' wave and blurred; what is left has the phase by which yarns
//! lie beside where straight ones would (fringe analysis after M. Takeda, 1982). The phase is unwrapped
//! from the clearest place outwards.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::f64::consts::{PI, TAU};

use super::contrast::Contrast;
use super::pitch::Wave;
use crate::photo::plane::Plane;

/// Pitches over which the phase is averaged: the standard deviation of the blur.
const AVERAGED: f64 = 2.0;

/// The yarns of one direction.
#[derive(Debug, Clone)]
pub struct Yarns {
    /// Their wave.
    pub wave: Wave,
    /// What bends add to the number of straight yarns.
    bend: Plane,
}

impl Yarns {
    /// Follows the yarns of a wave; `pitch` is that of the coarser of both directions.
    pub fn follow(contrast: &Contrast, wave: Wave, pitch: f64) -> Self {
        let light = &contrast.light;
        let (nx, ny) = (light.nx, light.ny);
        let [fx, fy] = wave.frequency;
        let turn = |n: usize, f: f64| -> Vec<(f32, f32)> {
            (0..n)
                .map(|i| TAU * f * i as f64)
                .map(|angle| (libm::cos(angle) as f32, -libm::sin(angle) as f32))
                .collect()
        };
        let (across, down) = (turn(nx, fx), turn(ny, fy));
        let part = |imaginary: bool| {
            Plane::new(nx, ny, |x, y| {
                let ((c, s), (d, t)) = (across[x], down[y]);
                let turned = if imaginary {
                    c * t + s * d
                } else {
                    c * d - s * t
                };
                light.get(x, y) * turned
            })
            // Mirrored yarns would run another way.
            .blurred_alone((AVERAGED * pitch) as f32)
        };
        let (re, im) = (part(false), part(true));
        let step = (wave.pitch().min(pitch) as usize).max(1);
        let coarse = unwrapped(&re, &im, step);
        let bend = Plane::new(nx, ny, |x, y| {
            let near = f64::from(coarse.at(x as f32 / step as f32, y as f32 / step as f32));
            let here = libm::atan2(f64::from(im.get(x, y)), f64::from(re.get(x, y)));
            // The turn of the phase that lies nearest to what is around.
            let phase = here + TAU * ((near - here) / TAU).round();
            // Brightest in the middle of a yarn.
            (phase / TAU + 0.5) as f32
        });
        Yarns { wave, bend }
    }

    /// The same yarns, counted from where they lie `by` yarns further on.
    pub fn shifted(mut self, by: f32) -> Self {
        for bend in &mut self.bend.values {
            *bend -= by;
        }
        self
    }

    /// The number of the yarn at a place: its whole part counts yarns, a half is the middle of one.
    #[inline]
    pub fn number(&self, x: f32, y: f32) -> f64 {
        let [fx, fy] = self.wave.frequency;
        fx * f64::from(x) + fy * f64::from(y) + f64::from(self.bend.at(x, y))
    }

    /// The number at a pixel.
    #[inline]
    pub fn number_at(&self, x: usize, y: usize) -> f64 {
        let [fx, fy] = self.wave.frequency;
        fx * x as f64 + fy * y as f64 + f64::from(self.bend.get(x, y))
    }

    /// How fast the number grows around a place, per pixel across and down.
    pub fn slope(&self, x: f32, y: f32) -> [f64; 2] {
        let reach = (0.5 * self.wave.pitch()).max(1.0) as f32;
        let change = |dx: f32, dy: f32| {
            (self.number(x + dx, y + dy) - self.number(x - dx, y - dy)) / f64::from(2.0 * reach)
        };
        // Beyond an edge the bend stands still, but straight yarns go on: that is well enough.
        [change(reach, 0.0), change(0.0, reach)]
    }

    /// The least and the greatest number in the photograph.
    pub fn range(&self) -> (f64, f64) {
        let (nx, ny) = (self.bend.nx, self.bend.ny);
        let numbers = (0..ny).flat_map(|y| (0..nx).map(move |x| (x, y)));
        numbers.fold((f64::MAX, f64::MIN), |(least, most), (x, y)| {
            let number = self.number_at(x, y);
            (least.min(number), most.max(number))
        })
    }

    /// Yarns that are crossed on the way through the middle of the photograph.
    pub fn count(&self) -> usize {
        let (nx, ny) = (self.bend.nx as f32, self.bend.ny as f32);
        let [fx, fy] = self.wave.frequency;
        let (from, to) = if fx.abs() > fy.abs() {
            ((0.0, 0.5 * ny), (nx - 1.0, 0.5 * ny))
        } else {
            ((0.5 * nx, 0.0), (0.5 * nx, ny - 1.0))
        };
        let crossed = self.number(to.0, to.1) - self.number(from.0, from.1);
        crossed.abs().round() as usize
    }

    /// Pixels across and down.
    pub fn size(&self) -> (usize, usize) {
        (self.bend.nx, self.bend.ny)
    }
}

/// A place that waits to be unwrapped, with how clear its phase is.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Waiting {
    clear: f32,
    place: usize,
    from: usize,
}

impl Eq for Waiting {}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        self.clear
            .total_cmp(&other.clear)
            .then(other.place.cmp(&self.place))
            .then(other.from.cmp(&self.from))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The phase at every `step`-th pixel, unwrapped: neighbours differ by at most half a turn, as seen
/// from whichever of them is reached first on the clearest way.
fn unwrapped(re: &Plane, im: &Plane, step: usize) -> Plane {
    let (nx, ny) = (re.nx.div_ceil(step), re.ny.div_ceil(step));
    let at = |place: usize| {
        let (x, y) = (place % nx * step, place / nx * step);
        (f64::from(re.get(x, y)), f64::from(im.get(x, y)))
    };
    let clear: Vec<f32> = (0..nx * ny)
        .map(|place| {
            let (re, im) = at(place);
            libm::sqrt(re * re + im * im) as f32
        })
        .collect();
    let phase: Vec<f64> = (0..nx * ny)
        .map(|place| {
            let (re, im) = at(place);
            libm::atan2(im, re)
        })
        .collect();
    // Begin where it is clear all around, not at a bright speck.
    let around = Plane {
        nx,
        ny,
        values: clear.clone(),
    }
    .blurred(3.0);
    let first = (0..nx * ny)
        .max_by(|a, b| {
            around.values[*a]
                .total_cmp(&around.values[*b])
                .then(b.cmp(a))
        })
        .unwrap_or(0);
    let mut found: Vec<Option<f64>> = vec![None; nx * ny];
    let mut heap = BinaryHeap::from([Waiting {
        clear: f32::MAX,
        place: first,
        from: first,
    }]);
    while let Some(Waiting { place, from, .. }) = heap.pop() {
        if found[place].is_some() {
            continue;
        }
        let before = found[from].unwrap_or(phase[first]);
        let turn = (phase[place] - before + PI).rem_euclid(TAU) - PI;
        found[place] = Some(before + turn);
        let (x, y) = (place % nx, place / nx);
        let neighbours = [
            (x > 0).then(|| place - 1),
            (x + 1 < nx).then_some(place + 1),
            (y > 0).then(|| place - nx),
            (y + 1 < ny).then_some(place + nx),
        ];
        for next in neighbours.into_iter().flatten() {
            if found[next].is_none() {
                heap.push(Waiting {
                    clear: clear[place].min(clear[next]),
                    place: next,
                    from: place,
                });
            }
        }
    }
    Plane {
        nx,
        ny,
        values: found
            .into_iter()
            .map(|phase| phase.unwrap_or(0.0) as f32)
            .collect(),
    }
}
