//! Keeps 0 ≤ c ≤ 1 without losing dye.
//!
//! The solver itself keeps to the bounds but for rounding and for what a curve through two states may
//! overshoot between them (a millionth of full scale). What a row lacks below 0 or has above 1 is
//! taken from, or given to, the other cells of the same row and layer, in proportion to the dye
//! they have (the room they have). Repairs of this kind: Shashkov and Wendroff, J. Comput. Phys.
//! 198, 2004.

use crate::diffusion::lanes::{Cells, LANES, Ways};

/// Brings one row within the bounds. Returns whether its dye allows it; if not nothing is changed.
pub fn limit(row: &mut [Cells], ways: &[Ways]) -> bool {
    (0..2).all(|layer| limit_layer(row, ways, layer))
}

/// Brings cells within the bounds whatever it takes. Returns how much dye that took out of them.
pub fn clip(cells: &mut [Cells], ways: &[Ways]) -> f64 {
    let mut taken = 0.0;
    for (block, way) in cells.iter_mut().zip(ways) {
        let all = block.0.as_flattened_mut().iter_mut();
        for (c, per_capacity) in all.zip(way.per_capacity.as_flattened()) {
            let within = c.clamp(0.0, 1.0);
            if within != *c && *per_capacity > 0.0 {
                taken += (f64::from(*c) - f64::from(within)) / f64::from(*per_capacity);
            }
            *c = within;
        }
    }
    taken
}

fn limit_layer(row: &mut [Cells], ways: &[Ways], layer: usize) -> bool {
    let outside = |c: &f32| !(0.0..=1.0).contains(c);
    if !row.iter().any(|block| block.0[layer].iter().any(outside)) {
        return true;
    }
    // Sums of amounts over the row, in double precision.
    let sum = |row: &[Cells], part: fn(f64) -> f64| -> f64 {
        let mut sum = 0.0;
        for (block, way) in row.iter().zip(ways) {
            for lane in 0..LANES {
                let per_capacity = f64::from(way.per_capacity[layer][lane]);
                if per_capacity > 0.0 {
                    sum += part(f64::from(block.0[layer][lane])) / per_capacity;
                }
            }
        }
        sum
    };
    let lacks = sum(row, |c| (-c).max(0.0));
    let has = sum(row, |c| c.max(0.0));
    let over = sum(row, |c| (c - 1.0).max(0.0));
    let room = sum(row, |c| (1.0 - c).max(0.0));
    if lacks > has || over > room {
        return false;
    }
    if lacks > 0.0 {
        let keeps = 1.0 - lacks / has;
        for_each(row, layer, |c| c.max(0.0) * keeps);
    }
    let over = sum(row, |c| (c - 1.0).max(0.0));
    let room = sum(row, |c| (1.0 - c).max(0.0));
    if over > 0.0 {
        let keeps = 1.0 - over / room;
        for_each(row, layer, |c| 1.0 - (1.0 - c).max(0.0) * keeps);
    }
    true
}

/// Changes every cell of a row in one layer.
fn for_each(row: &mut [Cells], layer: usize, rule: impl Fn(f64) -> f64) {
    for block in row {
        for c in &mut block.0[layer] {
            *c = rule(f64::from(*c)) as f32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limited_row_is_within_bounds_and_holds_what_it_held() {
        let mut way = Ways {
            east: [[0.0; LANES]; 2],
            south: [[0.0; LANES]; 2],
            beside: [0.0; LANES],
            per_capacity: [[2.0; LANES]; 2],
        };
        way.per_capacity[0][3] = 5.0;
        let mut row = [Cells([[0.5; LANES]; 2]); 2];
        row[0].0[0][3] = -0.01;
        row[1].0[0][0] = 1.02;
        row[1].0[1][7] = -1e-6;
        let held = |row: &[Cells]| -> f64 {
            let amounts = row.iter().flat_map(|block| {
                let (c, per) = (block.0.as_flattened(), way.per_capacity.as_flattened());
                c.iter()
                    .zip(per)
                    .map(|(c, per)| f64::from(*c) / f64::from(*per))
            });
            amounts.sum()
        };
        let before = held(&row);
        assert!(limit(&mut row, &[way, way]));
        assert!((held(&row) - before).abs() < 1e-6);
        let all = row.iter().flat_map(|block| block.0.as_flattened());
        assert!(all.into_iter().all(|c| (0.0..=1.0).contains(c)));
    }

    #[test]
    fn what_is_clipped_is_what_the_cells_lose() {
        let way = Ways {
            per_capacity: [[2.0; LANES]; 2],
            ..Ways::SHUT
        };
        let mut cells = [Cells([[1.0; LANES]; 2])];
        cells[0].0[0][1] = 1.5;
        cells[0].0[1][2] = -0.25;
        assert_eq!(clip(&mut cells, &[way]), 0.5 / 2.0 - 0.25 / 2.0);
        assert!(
            cells[0]
                .0
                .as_flattened()
                .iter()
                .all(|c| (0.0..=1.0).contains(c))
        );
    }

    #[test]
    fn a_row_that_owes_more_than_it_has_is_refused() {
        let way = Ways {
            east: [[0.0; LANES]; 2],
            south: [[0.0; LANES]; 2],
            beside: [0.0; LANES],
            per_capacity: [[1.0; LANES]; 2],
        };
        let mut row = [Cells::ZERO];
        row[0].0[0][0] = -0.5;
        assert!(!limit(&mut row, &[way]));
        assert_eq!(row[0].0[0][0], -0.5);
    }
}
