//! From a weave to a draft: ends that lie alike share a shaft, picks that lie alike share a treadle.

use std::collections::HashMap;
use std::hash::Hash;

use super::{Draft, DraftError, Lifting, MOST_THREADS, Shed, Thread};
use crate::cloth::WeaveMatrix;

/// The most shafts and treadles that are tied up. What needs more is woven on a dobby or a Jacquard
/// loom, which follows a liftplan.
const MOST_TIED: usize = 40;

impl Draft {
    /// Drafts a weave for the given ends (from the left) and picks (from the top); it is repeated, or
    /// cut off, to cover them. Shafts and treadles are numbered as the first end and pick needs them.
    /// With over 40 of either the draft has a liftplan.
    ///
    /// # Errors
    /// [`DraftError::Size`] for no threads, or more than [`MOST_THREADS`], in one direction.
    pub fn of_weave(
        weave: &WeaveMatrix,
        warp: Vec<Thread>,
        weft: Vec<Thread>,
    ) -> Result<Draft, DraftError> {
        let (ends, picks) = (warp.len(), weft.len());
        let allowed = 1..=MOST_THREADS;
        if !allowed.contains(&ends) || !allowed.contains(&picks) {
            return Err(DraftError::Size { ends, picks });
        }
        let column = |e: usize| (0..picks).map(|p| weave.warp_up(e, p)).collect::<Vec<_>>();
        // The first end of a draft is the rightmost.
        let (mut shaft_of, shafts) = numbered((0..ends).rev().map(column));
        shaft_of.reverse();
        // Which shafts each pick lifts: any end on a shaft tells of all.
        let mut on_shaft = vec![0; shafts];
        for (e, shaft) in shaft_of.iter().enumerate() {
            on_shaft[usize::from(*shaft) - 1] = e;
        }
        let lifts = |p: usize| -> Vec<u16> {
            (1..=shafts as u16)
                .filter(|shaft| weave.warp_up(on_shaft[usize::from(*shaft) - 1], p))
                .collect()
        };
        let plan: Vec<Vec<u16>> = (0..picks).map(lifts).collect();
        Ok(Draft {
            title: String::new(),
            author: String::new(),
            notes: Vec::new(),
            warp: warp.into_iter().map(Thread::tidy).collect(),
            weft: weft.into_iter().map(Thread::tidy).collect(),
            shafts,
            threading: shaft_of.into_iter().map(|shaft| vec![shaft]).collect(),
            lifting: tied(plan, shafts),
            shed: Shed::Rising,
        })
    }
}

/// A liftplan by treadles, if a loom has that many.
fn tied(plan: Vec<Vec<u16>>, shafts: usize) -> Lifting {
    let (treadle_of, treadles) = numbered(plan.iter());
    if shafts > MOST_TIED || treadles > MOST_TIED {
        return Lifting::Liftplan(plan);
    }
    let mut tieup = vec![Vec::new(); treadles];
    for (treadle, lifts) in treadle_of.iter().zip(&plan) {
        tieup[usize::from(*treadle) - 1].clone_from(lifts);
    }
    Lifting::Treadles {
        tieup,
        treadling: treadle_of.into_iter().map(|n| vec![n]).collect(),
    }
}

/// Numbers things from 1 in the order they first come, the same ones alike; and how many there are.
/// There are at most [`MOST_THREADS`] things, so that the numbers fit.
fn numbered<T: Eq + Hash>(things: impl Iterator<Item = T>) -> (Vec<u16>, usize) {
    let mut known = HashMap::new();
    let numbers = things
        .map(|thing| {
            let next = known.len() as u16 + 1;
            *known.entry(thing).or_insert(next)
        })
        .collect();
    (numbers, known.len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloth::Weave;

    fn draft(weave: &Weave, ends: usize, picks: usize) -> Draft {
        let threads = |n| vec![Thread::default(); n];
        Draft::of_weave(&weave.matrix(), threads(ends), threads(picks)).unwrap()
    }

    #[test]
    fn a_twill_needs_as_many_shafts_and_treadles_as_its_repeat() {
        let draft = draft(&Weave::Twill { over: 2, under: 1 }, 12, 9);
        assert_eq!((draft.shafts(), draft.treadles()), (3, 3));
        // A straight draw, from the right.
        let drawn: Vec<u16> = draft.threading().iter().rev().map(|s| s[0]).collect();
        assert_eq!(drawn, [1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3]);
    }

    #[test]
    fn what_needs_too_many_treadles_has_a_liftplan() {
        let satin = |shafts, counter| Weave::Satin {
            shafts,
            counter,
            face: crate::cloth::Face::Weft,
        };
        assert_eq!(draft(&satin(40, 7), 40, 40).treadles(), 40);
        let wide = draft(&satin(41, 7), 41, 41);
        assert_eq!((wide.shafts(), wide.treadles()), (41, 0));
    }

    #[test]
    fn no_draft_has_no_threads_or_too_many() {
        let plain = Weave::Plain.matrix();
        for (ends, picks) in [(0, 1), (1, 0), (MOST_THREADS + 1, 1)] {
            let threads = |n| vec![Thread::default(); n];
            let refused = Draft::of_weave(&plain, threads(ends), threads(picks));
            assert_eq!(refused, Err(DraftError::Size { ends, picks }));
        }
    }
}
