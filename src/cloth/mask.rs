//! A cloth whose weave is read off a photograph, cell by cell (paper D §4.3.1 b, Fig 7).

use super::{WeaveMatrix, Yarns};

/// Where the warp is on top, cell by cell.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mask {
    nx: usize,
    warp_up: Vec<bool>,
}

impl Mask {
    /// A mask of rows of `nx` cells, from the top.
    pub fn new(nx: usize, warp_up: Vec<bool>) -> Self {
        Mask { nx, warp_up }
    }

    /// Cells that it covers.
    pub fn cells(&self) -> usize {
        self.warp_up.len()
    }

    /// Whether the warp is on top at a position.
    pub fn warp_up(&self, y: usize, x: usize) -> bool {
        self.warp_up[y * self.nx + x]
    }

    /// What is seen from the other side: left and right exchanged, and what lies beneath on top.
    pub(super) fn turned_over(&self) -> Self {
        let rows = self.warp_up.chunks(self.nx.max(1));
        let warp_up = rows
            .flat_map(|row| row.iter().rev().map(|up| !up))
            .collect();
        Mask::new(self.nx, warp_up)
    }

    /// The weave that the mask shows: at every crossing the yarn that is on top of most of it.
    pub fn weave(&self, warp: &Yarns, weft: &Yarns) -> WeaveMatrix {
        let (ends, picks) = (warp.yarns.len(), weft.yarns.len());
        let mut votes = vec![0_i64; ends * picks];
        for (i, warp_up) in self.warp_up.iter().enumerate() {
            let (y, x) = (i / self.nx, i % self.nx);
            let crossing = weft.number(y) * ends + warp.number(x);
            votes[crossing] += if *warp_up { 1 } else { -1 };
        }
        WeaveMatrix::new(ends, votes.into_iter().map(|vote| vote > 0).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloth::{Weave, Yarn};

    #[test]
    fn the_mask_of_a_woven_cloth_shows_its_weave() {
        let yarns = |cells| Yarns::lay(cells, |i| (Yarn::default(), 3 + i % 2, 0));
        let (warp, weft) = (yarns(40), yarns(30));
        let twill = Weave::Twill { over: 2, under: 1 }.matrix();
        let up = |i: usize| twill.warp_up(warp.number(i % 40), weft.number(i / 40));
        let mask = Mask::new(40, (0..1200).map(up).collect());
        let seen = mask.weave(&warp, &weft);
        for e in 0..warp.yarns.len() {
            assert!((0..weft.yarns.len()).all(|p| seen.warp_up(e, p) == twill.warp_up(e, p)));
        }
    }
}
