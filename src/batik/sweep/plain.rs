//! The sweeps as paper B writes them: one loop over the cells, and one back.

use super::rule::{Around, Rule, update};
use super::{Account, BathSpec, Dye, Exchange};
use crate::pattern::Raster;

/// One scan: a sweep from the top left to the bottom right and one back.
///
/// `permeation` is p of every position.
pub fn scan(
    dye: &mut Dye,
    exchange: &Exchange,
    permeation: &Raster,
    bath: &BathSpec,
    account: &mut Account,
) {
    let supply: Vec<f32> = permeation
        .values
        .iter()
        .map(|p| bath.supply as f32 * p)
        .collect();
    let rule = Rule::new(exchange, &supply, bath);
    let (nx, ny) = (exchange.nx, exchange.ny);
    let mut one = |back: bool, layer: usize, y: usize, x: usize| {
        let i = y * nx + x;
        let own = layer * nx * ny + i;
        let f = &dye.free;
        let (right, down) = (&exchange.right[layer], &exchange.down[layer]);
        let [left_w, left] = if x > 0 {
            [right[i - 1], f[own - 1]]
        } else {
            [0.0; 2]
        };
        let [right_w, right] = if x + 1 < nx {
            [right[i], f[own + 1]]
        } else {
            [0.0; 2]
        };
        let [up_w, up] = if y > 0 {
            [down[i - nx], f[own - nx]]
        } else {
            [0.0; 2]
        };
        let [down_w, down] = if y + 1 < ny {
            [down[i], f[own + nx]]
        } else {
            [0.0; 2]
        };
        let other = f[(1 - layer) * nx * ny + i];
        let between = exchange.between[i];
        let before = f[own];
        let updated = update(
            &rule,
            Around {
                f: before,
                h: dye.bound[own],
                others: [left, right, up, down, other],
                weights: [left_w, right_w, up_w, down_w, between],
                supply: supply[i],
            },
        );
        dye.free[own] = updated.f;
        dye.bound[own] = updated.h;
        // The neighbours that come after this one in the sweep.
        let warp_first = (layer == 1) != back;
        let beside = if back {
            left_w + up_w
        } else {
            right_w + down_w
        };
        let later = beside + if warp_first { between } else { 0.0 };
        let gamma = f64::from(rule.gamma);
        account.supplied += gamma * f64::from(updated.supplied);
        account.made += gamma * f64::from(later) * f64::from(updated.f - before);
        account.truncated += u64::from(updated.truncated);
    };
    for y in 0..ny {
        for x in 0..nx {
            one(false, 1, y, x);
            one(false, 0, y, x);
        }
    }
    for y in (0..ny).rev() {
        for x in (0..nx).rev() {
            one(true, 0, y, x);
            one(true, 1, y, x);
        }
    }
}
