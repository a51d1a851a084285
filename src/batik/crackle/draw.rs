//! Cracks drawn on cells: the share of every cell that a crack leaves open.

use super::{Crack, End, Network, Point};
use crate::batik::noise;
use crate::chance::Chance;
use crate::pattern::Raster;

/// Draws all cracks, 0 whole wax to 1 open.
pub(super) fn map(network: &Network, nx: usize, ny: usize, chance: Chance) -> Raster {
    let seed = noise::fold_seed(chance.0, 0xc2ac);
    let mut map = Raster::uniform(nx, ny, 0.0);
    for (number, crack) in network.cracks.iter().enumerate() {
        let stroke = Stroke::of(crack, seed, number as u32);
        for pair in stroke.windows(2) {
            segment(&mut map, pair[0], pair[1]);
        }
    }
    map
}

/// A point of a crack as it is drawn.
#[derive(Debug, Clone, Copy)]
struct Stroke {
    at: Point,
    half: f32,
    depth: f32,
}

impl Stroke {
    /// The course of a crack with its width and depth. Both vary along it; it is chipped wide where
    /// it ends on another crack, and fades where it runs out.
    fn of(crack: &Crack, seed: u32, number: u32) -> Vec<Stroke> {
        let last = crack.line.len() - 1;
        crack
            .line
            .iter()
            .enumerate()
            .map(|(i, at)| {
                let s = i as f32;
                let slow = noise::along(seed, 2 * number, s / 23.0);
                let fast = noise::along(seed, 2 * number + 1, s / 3.5);
                let deep = noise::along(seed ^ 0x5eed, number, s / 40.0);
                let mut half = 0.5 * crack.width * (1.0 + 0.3 * slow + 0.25 * fast);
                let mut depth = crack.depth * (0.86 + 0.22 * deep);
                for (end, from) in crack.ends.into_iter().zip([i, last - i]) {
                    let from = from as f32 / crack.width.max(1.0);
                    match end {
                        End::Crack(_) => half *= 1.0 + 0.9 / (1.0 + from * from),
                        End::Tip => {
                            let fade = (from / 14.0).min(1.0);
                            half *= fade;
                            depth *= 0.3 + 0.7 * fade;
                        }
                        _ => {}
                    }
                }
                Stroke {
                    at: *at,
                    half: half.max(0.0),
                    depth: depth.clamp(0.0, 1.0),
                }
            })
            .collect()
    }
}

fn segment(map: &mut Raster, a: Stroke, b: Stroke) {
    let reach = a.half.max(b.half) + 1.0;
    let range = |axis: usize, cells: usize| {
        let (low, high) = (a.at[axis].min(b.at[axis]), a.at[axis].max(b.at[axis]));
        let from = (low - reach).floor().max(0.0) as usize;
        let to = (high + reach).ceil().max(0.0) as usize;
        from..to.min(cells)
    };
    let along = [b.at[0] - a.at[0], b.at[1] - a.at[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    for y in range(1, map.ny) {
        for x in range(0, map.nx) {
            let from = [x as f32 + 0.5 - a.at[0], y as f32 + 0.5 - a.at[1]];
            let t = if square > 0.0 {
                ((from[0] * along[0] + from[1] * along[1]) / square).clamp(0.0, 1.0)
            } else {
                0.0
            };
            let (dx, dy) = (from[0] - t * along[0], from[1] - t * along[1]);
            let distance = (dx * dx + dy * dy).sqrt();
            let half = a.half + t * (b.half - a.half);
            // The share of a cell, one wide at this distance, that lies within half the width.
            let share = ((distance + 0.5).min(half) - (distance - 0.5).max(-half)).clamp(0.0, 1.0);
            let open = share * (a.depth + t * (b.depth - a.depth));
            let cell = &mut map.values[y * map.nx + x];
            *cell = cell.max(open);
        }
    }
}
