//! Weaves: which yarn lies on top where a warp end crosses a weft pick (paper D §4.1).
//!
//! The weave matrix W(e, p) is true where the **warp** is on top at end `e` (counted from the left)
//! and pick `p` (counted from the top). It repeats over the cloth.

use serde::{Deserialize, Serialize};

use crate::scenario::check::{Checker, Problem};

/// A weave, by name or drawn by hand.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Weave {
    /// Over one, under one: W = (e + p) mod 2 = 0.
    #[default]
    Plain,
    /// Each warp end goes over `over` picks and under `under`, one further along on every pick:
    /// W = ((e − p) mod (over + under)) < over.
    Twill {
        /// Picks that the warp floats over.
        over: u32,
        /// Picks that the warp dives under.
        under: u32,
    },
    /// One crossing in every `shafts`, spread by `counter` so that no two touch:
    /// warp up where e ≡ counter · p (mod shafts), or the complement for a warp-faced satin.
    Satin {
        /// Ends and picks in one repeat, at least 5.
        shafts: u32,
        /// The move from pick to pick, between 2 and shafts − 2, sharing no factor with `shafts`.
        counter: u32,
        /// Which yarn covers the face.
        #[serde(default)]
        face: Face,
    },
    /// Drawn by hand: one string a pick from the top, `X` where the warp is on top and `.` where
    /// the weft is.
    Matrix(Vec<String>),
    /// Read from a weaver's draft: its interlacing, the colours of its yarns, and their measures.
    Wif {
        /// A WIF file beside the scenario file, or the name of a bundled draft.
        file: String,
        /// Whose widths the yarns have.
        #[serde(default)]
        measures: Measures,
    },
    /// Read off a photograph, cell by cell (paper D §4.3.1 b, Fig 7).
    Mask {
        /// A picture as large as the cloth, beside the scenario file: blue where the warp is on top, red
        /// where the weft is.
        file: String,
    },
}

/// Whose widths the yarns of a draft have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Measures {
    /// Those of the draft, in millimetres; where it gives none, those of the scenario's yarns.
    #[default]
    Draft,
    /// Those of the scenario's yarns.
    Yarns,
}

/// The yarn that covers the face of a satin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Face {
    /// The weft covers the face (sateen).
    #[default]
    Weft,
    /// The warp covers the face.
    Warp,
}

/// The widest repeat a weave may have, in ends and in picks.
pub const LARGEST_REPEAT: u32 = 4096;

impl Weave {
    /// Reports what cannot be woven.
    ///
    /// # Errors
    /// A [`Problem`] that names the field and what is allowed there.
    pub fn check(&self, at: &Checker) -> Result<(), Problem> {
        match self {
            Weave::Plain | Weave::Mask { .. } | Weave::Wif { .. } => Ok(()),
            Weave::Twill { over, under } => {
                at.field("over").within(*over, 1..=LARGEST_REPEAT / 2)?;
                at.field("under").within(*under, 1..=LARGEST_REPEAT / 2)
            }
            Weave::Satin {
                shafts, counter, ..
            } => {
                at.field("shafts").within(*shafts, 5..=LARGEST_REPEAT)?;
                let fits = |s: u32| (2..=shafts - 2).contains(&s) && gcd(*shafts, s) == 1;
                if fits(*counter) {
                    return Ok(());
                }
                let some: Vec<String> = (2..=shafts - 2)
                    .filter(|s| fits(*s))
                    .take(8)
                    .map(|s| s.to_string())
                    .collect();
                if some.is_empty() {
                    return Err(at.field("shafts").problem(format!(
                        "no satin has {shafts} shafts; 5 and any number from 7 on do"
                    )));
                }
                Err(at.field("counter").problem(format!(
                    "a satin of {shafts} shafts can move by {}, but this says {counter}",
                    some.join(", ")
                )))
            }
            Weave::Matrix(picks) => check_matrix(picks, &at.field("Matrix")),
        }
    }

    /// The weave as one repeat, ready to be looked up. What only a file says counts as plain.
    pub fn matrix(&self) -> WeaveMatrix {
        match self {
            Weave::Plain | Weave::Mask { .. } | Weave::Wif { .. } => {
                WeaveMatrix::from_rule(2, 2, |e, p| (e + p) % 2 == 0)
            }
            Weave::Twill { over, under } => {
                let n = over + under;
                WeaveMatrix::from_rule(n, n, |e, p| (e + n - p) % n < *over)
            }
            Weave::Satin {
                shafts: n,
                counter,
                face,
            } => WeaveMatrix::from_rule(*n, *n, |e, p| {
                let rises = u64::from(e) == u64::from(*counter) * u64::from(p) % u64::from(*n);
                rises == (*face == Face::Weft)
            }),
            Weave::Matrix(picks) => {
                let rows: Vec<Vec<bool>> = picks
                    .iter()
                    .map(|pick| pick.chars().map(|c| warp_on_top(c) == Some(true)).collect())
                    .collect();
                WeaveMatrix::new(rows.first().map_or(1, Vec::len), rows.concat())
            }
        }
    }
}

fn check_matrix(picks: &[String], at: &Checker) -> Result<(), Problem> {
    let ends = picks.first().map_or(0, |pick| pick.chars().count());
    if ends == 0 {
        return Err(at.problem("a weave needs at least one pick with at least one end".into()));
    }
    let largest = LARGEST_REPEAT as usize;
    if ends > largest || picks.len() > largest {
        return Err(at.problem(format!(
            "a weave repeats within {largest} ends and {largest} picks, but this one is {ends} by {}",
            picks.len()
        )));
    }
    for (p, pick) in picks.iter().enumerate() {
        let at = at.item(p);
        if pick.chars().count() != ends {
            return Err(at.problem(format!(
                "every pick needs as many ends as the first ({ends}), but this one has {}",
                pick.chars().count()
            )));
        }
        if let Some(c) = pick.chars().find(|c| warp_on_top(*c).is_none()) {
            return Err(at.problem(format!(
                "a pick is drawn with `X` (warp on top) and `.` (weft on top), but this one has {c:?}"
            )));
        }
    }
    Ok(())
}

fn warp_on_top(c: char) -> Option<bool> {
    match c {
        'X' | 'x' | '#' | '1' => Some(true),
        '.' | '-' | '0' => Some(false),
        _ => None,
    }
}

fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// One repeat of a weave: W(e, p) for all ends and picks in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WeaveMatrix {
    ends: usize,
    picks: usize,
    warp_up: Vec<bool>,
}

impl WeaveMatrix {
    /// A repeat of so many ends, from rows of picks; `warp_up` holds at least one whole pick.
    pub fn new(ends: usize, warp_up: Vec<bool>) -> Self {
        WeaveMatrix {
            ends: ends.max(1),
            picks: (warp_up.len() / ends.max(1)).max(1),
            warp_up,
        }
    }

    /// A weave from a rule: whether the warp is on top at an end and a pick. It repeats after `ends`
    /// ends and `picks` picks, at least one of each.
    pub fn from_rule(ends: u32, picks: u32, rule: impl Fn(u32, u32) -> bool) -> Self {
        let (ends, picks) = (ends.max(1), picks.max(1));
        let warp_up = (0..picks)
            .flat_map(|p| (0..ends).map(move |e| (e, p)))
            .map(|(e, p)| rule(e, p))
            .collect();
        WeaveMatrix::new(ends as usize, warp_up)
    }

    /// Whether the warp is on top where end `e` crosses pick `p`, for any end and pick of the cloth.
    pub fn warp_up(&self, e: usize, p: usize) -> bool {
        self.warp_up[p % self.picks * self.ends + e % self.ends]
    }

    /// Ends in one repeat.
    pub fn ends(&self) -> usize {
        self.ends
    }

    /// Picks in one repeat.
    pub fn picks(&self) -> usize {
        self.picks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(weave: &Weave) -> Vec<String> {
        let m = weave.matrix();
        (0..m.picks())
            .map(|p| {
                (0..m.ends())
                    .map(|e| if m.warp_up(e, p) { 'X' } else { '.' })
                    .collect()
            })
            .collect()
    }

    #[test]
    fn plain_weave_alternates_both_ways() {
        assert_eq!(drawn(&Weave::Plain), ["X.", ".X"]);
    }

    #[test]
    fn twill_moves_one_end_on_at_every_pick() {
        let twill = Weave::Twill { over: 2, under: 1 };
        assert_eq!(drawn(&twill), ["XX.", ".XX", "X.X"]);
    }

    #[test]
    fn satin_has_one_riser_in_every_pick_and_every_end() {
        for (shafts, counter) in [(5, 2), (8, 3), (7, 4)] {
            let satin = Weave::Satin {
                shafts,
                counter,
                face: Face::Weft,
            }
            .matrix();
            let n = shafts as usize;
            for i in 0..n {
                assert_eq!((0..n).filter(|j| satin.warp_up(*j, i)).count(), 1);
                assert_eq!((0..n).filter(|j| satin.warp_up(i, *j)).count(), 1);
                // No two risers touch along the diagonal: that would be a twill.
                let e = (0..n).find(|e| satin.warp_up(*e, i)).unwrap();
                assert!(!satin.warp_up(e + 1, i + 1) && !satin.warp_up(e + n - 1, i + 1));
            }
        }
    }

    #[test]
    fn a_warp_faced_satin_is_the_complement_of_the_weft_faced() {
        let with = |face| {
            Weave::Satin {
                shafts: 8,
                counter: 3,
                face,
            }
            .matrix()
        };
        let (weft, warp) = (with(Face::Weft), with(Face::Warp));
        assert!((0..64).all(|i| weft.warp_up(i % 8, i / 8) != warp.warp_up(i % 8, i / 8)));
    }

    #[test]
    fn a_weave_drawn_by_hand_is_the_weave_it_draws() {
        let by_hand = Weave::Matrix(vec!["XX.".into(), ".XX".into(), "X.X".into()]);
        assert_eq!(
            by_hand.matrix(),
            Weave::Twill { over: 2, under: 1 }.matrix()
        );
    }
}
