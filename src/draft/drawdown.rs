//! The drawdown of a draft: which crossings have the warp on top. And what weavers ask of it: how
//! long threads float, and how soon it repeats.
//!
//! W(e, p) is true where any shaft of end e is among those of pick p; with a sinking shed, where none
//! is.

use super::{Draft, Lifting, Shed};
use crate::cloth::WeaveMatrix;

/// A set of shafts, one bit each.
#[derive(Debug, Clone)]
struct ShaftSet(Vec<u64>);

impl ShaftSet {
    fn of(shafts: usize, numbers: &[u16]) -> Self {
        let mut bits = vec![0; shafts / 64 + 1];
        for number in numbers {
            if let Some(word) = bits.get_mut(usize::from(*number) / 64) {
                *word |= 1 << (number % 64);
            }
        }
        ShaftSet(bits)
    }

    fn add(&mut self, other: &ShaftSet) {
        for (word, more) in self.0.iter_mut().zip(&other.0) {
            *word |= more;
        }
    }

    fn meets(&self, other: &ShaftSet) -> bool {
        self.0.iter().zip(&other.0).any(|(a, b)| a & b != 0)
    }

    fn numbers(&self) -> Vec<u16> {
        (0..self.0.len() * 64)
            .filter(|i| self.0[i / 64] >> (i % 64) & 1 == 1)
            .map(|i| i as u16)
            .collect()
    }
}

impl Draft {
    /// For each pick from the top the shafts that it chooses, whatever they then do.
    fn chosen(&self) -> Vec<ShaftSet> {
        let set = |numbers: &Vec<u16>| ShaftSet::of(self.shafts, numbers);
        match &self.lifting {
            Lifting::Liftplan(picks) => picks.iter().map(set).collect(),
            Lifting::Treadles { tieup, treadling } => {
                let tied: Vec<ShaftSet> = tieup.iter().map(set).collect();
                let pressed = |treadles: &Vec<u16>| {
                    let mut all = ShaftSet::of(self.shafts, &[]);
                    for treadle in treadles {
                        if let Some(tied) = tied.get(usize::from(*treadle).wrapping_sub(1)) {
                            all.add(tied);
                        }
                    }
                    all
                };
                treadling.iter().map(pressed).collect()
            }
        }
    }

    /// The same draft with a liftplan in place of treadles. It weaves the same cloth.
    #[must_use]
    pub fn with_liftplan(mut self) -> Self {
        let plan = self.chosen().iter().map(ShaftSet::numbers).collect();
        self.lifting = Lifting::Liftplan(plan);
        self
    }

    /// Where the warp lies on top, as one repeat of the whole draft: column `e` is end `e` from the
    /// left, row `p` is pick `p` from the top.
    pub fn drawdown(&self) -> WeaveMatrix {
        let ends: Vec<ShaftSet> = self
            .threading
            .iter()
            .map(|shafts| ShaftSet::of(self.shafts, shafts))
            .collect();
        let picks = self.chosen();
        let rising = self.shed == Shed::Rising;
        WeaveMatrix::from_rule(ends.len() as u32, picks.len() as u32, |e, p| {
            ends[e as usize].meets(&picks[p as usize]) == rising
        })
    }
}

impl Draft {
    /// The fewest ends and picks after which the draft comes again with all its colours and measures.
    pub fn repeat(&self) -> (usize, usize) {
        repeat_where(
            &self.drawdown(),
            |a, b| self.warp.get(a) == self.warp.get(b),
            |a, b| self.weft.get(a) == self.weft.get(b),
        )
    }
}

/// How long the threads of one direction stay on one side of the cloth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Floats {
    /// The most crossings in a row that a thread passes on the same side, of those that change sides
    /// at all.
    pub longest: usize,
    /// Threads that never change sides: nothing binds them into the cloth.
    pub unbound: usize,
}

impl Floats {
    fn of(threads: usize, crossings: usize, over: impl Fn(usize, usize) -> bool) -> Self {
        let mut floats = Floats::default();
        for thread in 0..threads {
            // The cloth repeats: begin where a float begins, and go round once.
            let changes = |i: usize| {
                let next = if i + 1 == crossings { 0 } else { i + 1 };
                over(thread, i) != over(thread, next)
            };
            let Some(first) = (0..crossings).find(|i| changes(*i)) else {
                floats.unbound += 1;
                continue;
            };
            let mut length = 0;
            for i in first + 1..=first + crossings {
                length += 1;
                floats.longest = floats.longest.max(length);
                if changes(i % crossings) {
                    length = 0;
                }
            }
        }
        floats
    }
}

/// The floats of a weave: those of the warp, counted in picks, and those of the weft, in ends. Both
/// sides of the cloth count.
pub fn floats(weave: &WeaveMatrix) -> [Floats; 2] {
    let (ends, picks) = (weave.ends(), weave.picks());
    [
        Floats::of(ends, picks, |e, p| weave.warp_up(e, p)),
        Floats::of(picks, ends, |p, e| weave.warp_up(e, p)),
    ]
}

/// The fewest ends and picks after which a weave comes again, of those that go evenly into it.
pub fn repeat(weave: &WeaveMatrix) -> (usize, usize) {
    repeat_where(weave, |_, _| true, |_, _| true)
}

/// The same, where ends and picks must be alike in other ways too.
fn repeat_where(
    weave: &WeaveMatrix,
    ends_alike: impl Fn(usize, usize) -> bool,
    picks_alike: impl Fn(usize, usize) -> bool,
) -> (usize, usize) {
    let (ends, picks) = (weave.ends(), weave.picks());
    let up = |e, p| weave.warp_up(e, p);
    let same_end = |a, b| ends_alike(a, b) && (0..picks).all(|p| up(a, p) == up(b, p));
    let same_pick = |a, b| picks_alike(a, b) && (0..ends).all(|e| up(e, a) == up(e, b));
    (period(ends, same_end), period(picks, same_pick))
}

/// The smallest divisor d of n after which things 0 to n − 1 come again.
fn period(n: usize, same: impl Fn(usize, usize) -> bool) -> usize {
    (1..n)
        .filter(|d| n.is_multiple_of(*d))
        .find(|d| (0..n - d).all(|i| same(i, i + d)))
        .unwrap_or(n)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloth::{Face, Weave};

    #[test]
    fn a_twill_floats_as_far_as_it_says_and_repeats_in_the_sum() {
        for (over, under) in [(1, 1), (2, 2), (3, 1), (5, 3)] {
            let weave = Weave::Twill { over, under }.matrix();
            let longest = over.max(under) as usize;
            let expected = Floats {
                longest,
                unbound: 0,
            };
            assert_eq!(floats(&weave), [expected; 2]);
            let n = (over + under) as usize;
            assert_eq!(repeat(&weave), (n, n));
        }
    }

    #[test]
    fn a_satin_floats_over_all_threads_but_one() {
        let weave = Weave::Satin {
            shafts: 8,
            counter: 3,
            face: Face::Warp,
        };
        let [warp, weft] = floats(&weave.matrix());
        assert_eq!((warp.longest, weft.longest), (7, 7));
    }

    #[test]
    fn threads_that_never_cross_are_counted_not_measured() {
        let rows = ["XX.", "XX.", ".X."].map(str::to_owned);
        let [warp, weft] = floats(&Weave::Matrix(rows.to_vec()).matrix());
        assert_eq!((warp.longest, warp.unbound), (2, 2));
        assert_eq!((weft.longest, weft.unbound), (2, 0));
    }

    #[test]
    fn a_tiled_weave_repeats_as_its_tile_does() {
        let tile = Weave::Twill { over: 2, under: 1 }.matrix();
        let tiled = WeaveMatrix::from_rule(12, 9, |e, p| tile.warp_up(e as usize, p as usize));
        assert_eq!(repeat(&tiled), (3, 3));
    }
}
