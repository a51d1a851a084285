//! Where the pixels of a row or column find the dye they show: in two cells of one layer, and how
//! much of each.
//!
//! Along a yarn dye is interpolated from cell to cell; across it only within the yarn, so that no
//! yarn takes colour from its neighbour. A pixel in a gap shows the edge of the yarn before it,
//! whose shaded side is what one sees there.

use crate::cloth::Yarns;

/// Two cells, and the share of the second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tap {
    /// The first cell.
    pub near: u32,
    /// The second one.
    pub far: u32,
    /// The share of the second, 0 to 1.
    pub share: f32,
}

impl Tap {
    /// The value between two cells of a line.
    #[inline]
    pub fn of(self, line: &[f32]) -> f32 {
        let near = line[self.near as usize];
        near + self.share * (line[self.far as usize] - near)
    }

    fn mirrored(self, cells: usize) -> Self {
        let turn = |cell: u32| cells as u32 - 1 - cell;
        Tap {
            near: turn(self.near),
            far: turn(self.far),
            ..self
        }
    }
}

/// The cells beside the middle of pixel `p`, within `least..=most`.
fn tap(p: usize, scale: usize, (least, most): (usize, usize)) -> Tap {
    let place = (p as f32 + 0.5) / scale as f32 - 0.5;
    let before = place.floor();
    let cell = |offset: i64| (before as i64 + offset).clamp(least as i64, most as i64) as u32;
    Tap {
        near: cell(0),
        far: cell(1),
        share: place - before,
    }
}

/// For every pixel along yarns of `cells` cells.
pub fn along(cells: usize, scale: usize) -> Vec<Tap> {
    let whole = (0, cells - 1);
    (0..cells * scale).map(|p| tap(p, scale, whole)).collect()
}

/// For every pixel across yarns.
pub fn across(yarns: &Yarns, scale: usize) -> Vec<Tap> {
    let cells = yarns.cells();
    let one = |p: usize| {
        let span = yarns.span(yarns.number(p / scale));
        let last = (span.begin + span.width - 1).min(cells - 1);
        tap(p, scale, (span.begin, last))
    };
    (0..cells * scale).map(one).collect()
}

/// The same, for a cloth that is seen from its back: left and right are exchanged.
pub fn mirrored(taps: &[Tap], cells: usize) -> Vec<Tap> {
    taps.iter().map(|tap| tap.mirrored(cells)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloth::Yarn;

    #[test]
    fn at_one_pixel_a_cell_every_pixel_of_a_yarn_shows_its_own_cell() {
        let yarns = Yarns::lay(23, |i| (Yarn::default(), 2 + i % 3, i % 2));
        for taps in [along(23, 1), across(&yarns, 1)] {
            for (p, tap) in taps.iter().enumerate() {
                let line: Vec<f32> = (0..23).map(|i| i as f32).collect();
                if yarns.at(p).is_some() {
                    assert_eq!(tap.of(&line), p as f32);
                }
            }
        }
    }

    #[test]
    fn no_pixel_takes_colour_from_the_neighbouring_yarn() {
        let yarns = Yarns::lay(30, |_| (Yarn::default(), 4, 1));
        let line: Vec<f32> = (0..30).map(|i| yarns.number(i) as f32).collect();
        for (p, tap) in across(&yarns, 5).iter().enumerate() {
            assert_eq!(tap.of(&line), yarns.number(p / 5) as f32);
        }
    }
}
