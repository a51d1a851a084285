//! Cloth cells: where warp yarns cross weft yarns, as ranges of columns and rows.

use std::ops::Range;

use crate::cloth::{Cloth, Layer};

/// The cloth cells of a cloth: each holds one crossing, a yarn and the gap after it either way.
#[derive(Debug, Clone, PartialEq)]
pub struct Crossings {
    /// Columns of every warp yarn and the gap after it.
    pub columns: Vec<Range<usize>>,
    /// Rows of every weft yarn and the gap after it.
    pub rows: Vec<Range<usize>>,
}

impl Crossings {
    /// The cloth cells of a woven cloth.
    pub fn of(cloth: &Cloth) -> Self {
        // A cell begins where another yarn does; the places of one yarn all lead to the same one.
        let ranges = |layer: Layer, cells: usize| {
            let yarn = |i: usize| match layer {
                Layer::Warp => cloth.yarn(layer, 0, i),
                Layer::Weft => cloth.yarn(layer, i, 0),
            };
            let begins = |i: &usize| match (yarn(*i), yarn(i.saturating_sub(1))) {
                _ if *i == 0 => true,
                (None, _) => false,
                (Some(_), None) => true,
                (Some(here), Some(before)) => !std::ptr::eq(here, before),
            };
            let starts: Vec<usize> = (0..cells).filter(begins).collect();
            let ends = starts.iter().skip(1).copied().chain([cells]);
            starts
                .iter()
                .copied()
                .zip(ends)
                .map(|(a, b)| a..b)
                .collect()
        };
        Crossings {
            columns: ranges(Layer::Warp, cloth.grid.nx),
            rows: ranges(Layer::Weft, cloth.grid.ny),
        }
    }

    /// The number of the range that every place lies in.
    pub(super) fn numbers(ranges: &[Range<usize>]) -> Vec<u32> {
        let number = |(i, range): (usize, &Range<usize>)| vec![i as u32; range.len()];
        ranges.iter().enumerate().flat_map(number).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::batik::tests::woven;

    #[test]
    fn cells_are_a_yarn_and_its_gap_and_cover_the_cloth() {
        let cells = Crossings::of(&woven(40, 23, 4, 2));
        assert_eq!(cells.columns[1], 6..12);
        assert_eq!(cells.columns.last(), Some(&(36..40)));
        assert_eq!(cells.rows.iter().map(Range::len).sum::<usize>(), 23);
        assert_eq!(Crossings::numbers(&cells.columns)[13], 2);
    }

    #[test]
    fn yarns_without_gaps_are_told_apart() {
        let cells = Crossings::of(&woven(12, 12, 3, 0));
        assert_eq!(cells.columns, [0..3, 3..6, 6..9, 9..12]);
    }
}
