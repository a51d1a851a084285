//! The shape of woven yarns: where each one lies, how high, and which is seen.
//!
//! A yarn has an axis that rises over the yarns it covers and dives under the others, wanders a
//! little to its sides, and a lens-shaped cross-section that is thicker in some places (slubs).
//! What is seen at a point is the higher surface. The model of paper D is coarser: there the cell of
//! the upper yarn is seen (model section 6); the two agree but for the outline of yarns.

use rayon::prelude::*;

use super::noise;
use crate::cloth::{Cloth, Layer, Span, Yarns};
use crate::scenario::YarnLook;

/// How far the axis of a yarn lies above the middle of the cloth on its face, in radii.
const CRIMP: f32 = 0.60;
/// Height of the cross-section over its axis, in radii.
const ROUND: f32 = 0.95;

/// A point on the surface of a yarn, or in the gap beside it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// The number of the yarn.
    pub yarn: usize,
    /// Place across it, −1 at its left or upper edge to 1; beyond in the gap.
    pub across: f32,
    /// Place along it, in cells.
    pub along: f32,
    /// Height over the middle of the cloth, in radii.
    pub height: f32,
    /// How steeply the axis rises: radii per cell along the yarn.
    pub slope: f32,
    /// Radius of the yarn here, in cells.
    pub radius: f32,
}

impl Point {
    /// Whether there is yarn at all.
    pub fn is_yarn(self) -> bool {
        self.across.abs() < 1.0
    }
}

/// A place of the cloth as it is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The layer whose surface is higher.
    pub layer: Layer,
    /// The points of the weft and of the warp there.
    pub points: [Point; 2],
}

impl Place {
    /// What is seen of a weft and a warp yarn.
    #[inline]
    fn of(weft: Point, warp: Point) -> Self {
        let layer = match (weft.is_yarn(), warp.is_yarn()) {
            (true, false) => Layer::Weft,
            (false, true) => Layer::Warp,
            _ if warp.height > weft.height => Layer::Warp,
            _ => Layer::Weft,
        };
        Place {
            layer,
            points: [weft, warp],
        }
    }

    /// The point that is seen.
    pub fn seen(&self) -> Point {
        self.points[self.layer as usize]
    }

    /// The point of the other layer, behind or beside it.
    pub fn other(&self) -> Point {
        self.points[self.layer.other() as usize]
    }
}

/// One yarn at one place along it.
#[derive(Debug, Clone, Copy)]
struct Strand {
    /// Where its axis lies across the layer, and its radius there, in cells.
    middle: f32,
    radius: f32,
    /// Height of the axis in radii, and its change per cell.
    height: f32,
    slope: f32,
}

impl Strand {
    /// The point of the yarn at a place across its layer.
    #[inline]
    fn point(&self, yarn: usize, across: f32, along: f32) -> Point {
        let across = (across - self.middle) / self.radius;
        Point {
            yarn,
            across,
            along,
            height: self.height + ROUND * round(across),
            slope: self.slope,
            radius: self.radius,
        }
    }
}

/// The yarns of a cloth in space.
pub struct Geometry<'a> {
    cloth: &'a Cloth,
    /// How much yarns wander, and how uneven their thickness is, as shares of the radius.
    wander: f32,
    slub: f32,
    seeds: [u32; 2],
}

impl<'a> Geometry<'a> {
    /// The geometry of a cloth whose yarns look like this.
    pub fn new(cloth: &'a Cloth, look: &YarnLook, seed: u64) -> Self {
        Geometry {
            cloth,
            wander: 0.10 * look.unevenness as f32,
            slub: 0.22 * look.unevenness as f32,
            seeds: [noise::seed(seed, 100), noise::seed(seed, 101)],
        }
    }

    /// Makes every pixel of a picture at `scale` pixels a cell, row by row, from what is seen at
    /// `samples` × `samples` places within it.
    pub fn scan<T: Send + Clone + Default>(
        &self,
        scale: usize,
        samples: usize,
        pixel: impl Fn(&[Place]) -> T + Sync,
    ) -> Vec<T> {
        let width = self.cloth.grid.nx * scale;
        let mut picture = vec![T::default(); width * self.cloth.grid.ny * scale];
        // Pick by pick, for what happens along a pick is the same for all its rows.
        let mut rest = picture.as_mut_slice();
        let mut picks = Vec::new();
        for (pick, span) in self.cloth.weft.spans().iter().enumerate() {
            let begin = if pick == 0 { 0 } else { span.begin };
            let next = self.cloth.weft.spans().get(pick + 1);
            let end = next.map_or(self.cloth.grid.ny, |next| next.begin);
            let (rows, others) =
                std::mem::take(&mut rest).split_at_mut((end - begin) * scale * width);
            picks.push((pick, begin * scale, rows));
            rest = others;
        }
        picks
            .into_par_iter()
            .for_each(|(pick, top, rows)| self.scan_pick(pick, top, scale, samples, rows, &pixel));
        picture
    }

    fn scan_pick<T>(
        &self,
        pick: usize,
        top: usize,
        scale: usize,
        samples: usize,
        rows: &mut [T],
        pixel: &impl Fn(&[Place]) -> T,
    ) {
        let (nx, fine) = (self.cloth.grid.nx, scale * samples);
        let place = |sample: usize| (sample as f32 + 0.5) / fine as f32;
        // The pick and its neighbours at every sample along them.
        let last = self.cloth.weft.yarns.len() - 1;
        let near = [pick.saturating_sub(1), pick, (pick + 1).min(last)];
        let wefts = near.map(|pick| -> Vec<Strand> {
            let strand = |i| self.strand(Layer::Weft, pick, place(i));
            (0..nx * fine).map(strand).collect()
        });
        let mut warps = Vec::with_capacity(self.cloth.warp.yarns.len());
        let mut places = Vec::with_capacity(nx * fine * samples);
        let mut one = Vec::with_capacity(samples * samples);
        for (j, row) in rows.chunks_exact_mut(nx * scale).enumerate() {
            places.clear();
            for sample in 0..samples {
                let v = place((top + j) * samples + sample);
                warps.clear();
                let strand = |yarn| self.strand(Layer::Warp, yarn, v);
                warps.extend((0..self.cloth.warp.yarns.len()).map(strand));
                places.extend((0..nx * fine).map(|i| {
                    let u = place(i);
                    let weft = nearest(&self.cloth.weft, v, u, |yarn| {
                        let known = if yarn < pick { 0 } else { yarn + 1 - pick };
                        wefts[known][i]
                    });
                    let warp = nearest(&self.cloth.warp, u, v, |yarn| warps[yarn]);
                    Place::of(weft, warp)
                }));
            }
            for (px, value) in row.iter_mut().enumerate() {
                one.clear();
                for sample in 0..samples {
                    let at = sample * nx * fine + px * samples;
                    one.extend_from_slice(&places[at..at + samples]);
                }
                *value = pixel(&one);
            }
        }
    }

    /// The yarns of a layer, and those that cross them.
    fn yarns(&self, layer: Layer) -> (&Yarns, &Yarns) {
        match layer {
            Layer::Weft => (&self.cloth.weft, &self.cloth.warp),
            Layer::Warp => (&self.cloth.warp, &self.cloth.weft),
        }
    }

    /// A yarn at a place along it.
    fn strand(&self, layer: Layer, yarn: usize, along: f32) -> Strand {
        let (yarns, crossed) = self.yarns(layer);
        let span = yarns.span(yarn);
        let wide = span.width as f32;
        let nominal = wide / 2.0;
        let seed = self.seeds[layer as usize] ^ (yarn as u32).wrapping_mul(0x27d4_eb2f);
        let wander = self.wander * noise::along(along / (2.5 * wide), seed);
        let slub = 0.6 * noise::along(along / (9.0 * wide), seed ^ 1)
            + 0.4 * noise::along(along / (2.2 * wide), seed ^ 2);
        let axis = axis(crossed, along, |crossing| self.is_up(layer, yarn, crossing));
        // Where it lies free a yarn spreads; where it dives it is pressed together.
        let radius = nominal * (0.97 + self.slub * slub + 0.11 * axis.height);
        Strand {
            middle: middle(span) + wander * nominal,
            radius: radius.max(0.3),
            height: CRIMP * axis.height,
            slope: CRIMP * axis.slope,
        }
    }

    /// 1 where a yarn lies on top at a crossing, −1 where it lies beneath. Crossing 0 is the one before
    /// the first yarn that is crossed.
    fn is_up(&self, layer: Layer, yarn: usize, crossing: usize) -> f32 {
        let weave = &self.cloth.weave;
        let warp_up = match layer {
            Layer::Warp => weave.warp_up(yarn, crossing + weave.picks() - 1),
            Layer::Weft => weave.warp_up(crossing + weave.ends() - 1, yarn),
        };
        if warp_up == (layer == Layer::Warp) {
            1.0
        } else {
            -1.0
        }
    }
}

/// The nearer of the two yarns of a layer that a place lies between.
#[inline]
fn nearest(yarns: &Yarns, across: f32, along: f32, strand: impl Fn(usize) -> Strand) -> Point {
    let number = yarns.number(across as usize);
    let own = strand(number).point(number, across, along);
    if own.is_yarn() {
        return own;
    }
    // A neighbour counts only where it reaches into this cloth cell.
    let beside = if own.across < 0.0 {
        number.checked_sub(1)
    } else {
        Some(number + 1).filter(|next| *next < yarns.yarns.len())
    };
    match beside.map(|beside| strand(beside).point(beside, across, along)) {
        Some(other) if other.is_yarn() => other,
        _ => own,
    }
}

fn middle(span: Span) -> f32 {
    span.begin as f32 + span.width as f32 / 2.0
}

/// The height of a yarn's surface over its axis, in heights of its cross-section: a lens, for soft
/// yarns are pressed flat. Beyond its edge it falls on.
fn round(across: f32) -> f32 {
    1.0 - across * across
}

/// Where the axis of a yarn runs between the face and the back of the cloth.
struct Axis {
    /// 1 on the face, −1 on the back.
    height: f32,
    /// Its change per cell.
    slope: f32,
}

/// The axis of a yarn at a place along it. `up` is its height at each crossing with `crossed`, counted
/// from 1; 0 is the one before the first.
fn axis(crossed: &Yarns, along: f32, up: impl Fn(usize) -> f32) -> Axis {
    let last = crossed.yarns.len() - 1;
    let number = crossed.number((along as usize).min(crossed.cells() - 1));
    let here = middle(crossed.span(number));
    let (before, from, to) = if along < here {
        let from = match number.checked_sub(1) {
            Some(previous) => middle(crossed.span(previous)),
            None => here - crossed.span(0).pitch() as f32,
        };
        (number, from, here)
    } else {
        let to = match number {
            n if n < last => middle(crossed.span(n + 1)),
            n => here + crossed.span(n).pitch() as f32,
        };
        (number + 1, here, to)
    };
    let (a, b) = (up(before), up(before + 1));
    let t = ((along - from) / (to - from)).clamp(0.0, 1.0);
    Axis {
        height: a + (b - a) * t * t * (3.0 - 2.0 * t),
        slope: (b - a) * 6.0 * t * (1.0 - t) / (to - from),
    }
}
