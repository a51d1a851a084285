//! Weaves by name: what is told beforehand, and what is seen.

use std::fmt;
use std::str::FromStr;

use super::repeat::Lattice;
use crate::cloth::{Face, Weave};
use crate::photo::PhotoError;

/// The most crossings that may differ in a weave that is told.
const MOST_CLASSES: usize = 64;
/// The most ends and picks that its repeat may have.
const LARGEST_REPEAT: usize = 64;

/// One repeat of a weave, row by row of picks.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Repeat {
    ends: usize,
    picks: usize,
    warp_up: Vec<bool>,
}

impl Repeat {
    fn new(ends: usize, picks: usize, warp_up: impl Fn(usize, usize) -> bool) -> Self {
        let crossings = (0..picks).flat_map(|p| (0..ends).map(move |e| (e, p)));
        Repeat {
            ends,
            picks,
            warp_up: crossings.map(|(e, p)| warp_up(e, p)).collect(),
        }
    }

    fn of(weave: &Weave) -> Self {
        let matrix = weave.matrix();
        Repeat::new(matrix.ends(), matrix.picks(), |e, p| matrix.warp_up(e, p))
    }

    fn get(&self, e: usize, p: usize) -> bool {
        self.warp_up[p % self.picks * self.ends + e % self.ends]
    }

    fn mirrored(&self) -> Self {
        Repeat::new(self.ends, self.picks, |e, p| self.get(self.ends - 1 - e, p))
    }

    fn turned_over(&self) -> Self {
        Repeat::new(self.ends, self.picks, |e, p| !self.get(e, p))
    }

    /// Whether moving by so many ends and picks changes nothing.
    fn stays(&self, de: usize, dp: usize) -> bool {
        (0..self.picks).all(|p| (0..self.ends).all(|e| self.get(e, p) == self.get(e + de, p + dp)))
    }

    /// All moves that change nothing.
    fn lattice(&self) -> Lattice {
        let a = (1..self.ends)
            .find(|de| self.stays(*de, 0))
            .unwrap_or(self.ends);
        let row = |dp: usize| (0..a).find(|de| self.stays(*de, dp)).map(|b| (b, dp));
        let (b, c) = (1..self.picks).find_map(row).unwrap_or((0, self.picks));
        Lattice { a, b, c }
    }

    /// Whether the warp is on top in each class of its lattice.
    fn classes(&self) -> Vec<bool> {
        let lattice = self.lattice();
        let crossings = (0..lattice.c).flat_map(|p| (0..lattice.a).map(move |e| (e, p)));
        crossings.map(|(e, p)| self.get(e, p)).collect()
    }

    /// Whether it is the other, begun at another crossing.
    fn is(&self, other: &Repeat) -> bool {
        let lattice = self.lattice();
        if lattice != other.lattice() {
            return false;
        }
        let (ends, picks) = lattice.repeat();
        (0..picks).any(|dp| {
            (0..ends).any(|de| {
                let same = |e: usize, p: usize| self.get(e, p) == other.get(e + de, p + dp);
                (0..picks).all(|p| (0..ends).all(|e| same(e, p)))
            })
        })
    }

    fn rows(&self) -> Vec<String> {
        let row = |p: usize| {
            let drawn = (0..self.ends).map(|e| if self.get(e, p) { 'X' } else { '.' });
            drawn.collect()
        };
        (0..self.picks).map(row).collect()
    }
}

/// A weave that is known before a photograph is looked at: its place is not, nor which way round it
/// lies.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KnownWeave {
    versions: Vec<Repeat>,
}

impl KnownWeave {
    /// The lattices on which it repeats, one for each way round.
    pub(super) fn lattices(&self) -> Vec<Lattice> {
        let mut lattices: Vec<Lattice> = Vec::new();
        for version in &self.versions {
            let lattice = version.lattice();
            if !lattices.contains(&lattice) {
                lattices.push(lattice);
            }
        }
        lattices
    }

    /// The sides of the classes of a lattice, for each way round that lies on it.
    pub(super) fn sides(&self, lattice: Lattice) -> Vec<Vec<bool>> {
        let lies = |version: &&Repeat| version.lattice() == lattice;
        self.versions
            .iter()
            .filter(lies)
            .map(Repeat::classes)
            .collect()
    }
}

impl FromStr for KnownWeave {
    type Err = PhotoError;

    /// Reads `plain`, `twill2/1`, `satin5/2`, `basket2`, or a repeat drawn as `XX.,.XX,X.X`.
    fn from_str(text: &str) -> Result<Self, PhotoError> {
        let wrong = |why: String| PhotoError::Weave {
            text: text.into(),
            why,
        };
        let repeat = named(text).or_else(|| drawn(text)).ok_or_else(|| {
            wrong(
                "it is written `plain`, `twill2/1` (over 2, under 1), `satin5/2` (5 shafts, moved by 2), \
                 `basket2`, or drawn from the top, pick by pick, as in `XX.,.XX,X.X` with `X` where the \
                 warp is on top"
                    .into(),
            )
        })?;
        let alike = |line: Vec<bool>| line.iter().all(|up| *up == line[0]);
        let pick = |p: usize| (0..repeat.ends).map(|e| repeat.get(e, p)).collect();
        let end = |e: usize| (0..repeat.picks).map(|p| repeat.get(e, p)).collect();
        let loose =
            (0..repeat.picks).any(|p| alike(pick(p))) || (0..repeat.ends).any(|e| alike(end(e)));
        if loose {
            return Err(wrong(
                "a yarn in it passes only over or only under the others".into(),
            ));
        }
        let classes = repeat.lattice().classes();
        if classes > MOST_CLASSES {
            return Err(wrong(format!(
                "{classes} of its crossings differ, but at most {MOST_CLASSES} can be told apart"
            )));
        }
        let mut versions = vec![repeat.clone(), repeat.mirrored()];
        // Which face of a satin is seen is left to the photograph.
        if text.starts_with("satin") {
            versions.extend([repeat.turned_over(), repeat.mirrored().turned_over()]);
        }
        let mut different: Vec<Repeat> = Vec::new();
        for version in versions {
            if !different.iter().any(|other| version.is(other)) {
                different.push(version);
            }
        }
        Ok(KnownWeave {
            versions: different,
        })
    }
}

fn named(text: &str) -> Option<Repeat> {
    let two = |numbers: &str| -> Option<(u32, u32)> {
        let (one, other) = numbers.trim().split_once('/')?;
        Some((one.trim().parse().ok()?, other.trim().parse().ok()?))
    };
    let fits = |n: u32| (1..=LARGEST_REPEAT as u32 / 2).contains(&n);
    if text == "plain" {
        return Some(Repeat::of(&Weave::Plain));
    }
    if let Some(numbers) = text.strip_prefix("twill") {
        let (over, under) = two(numbers).filter(|(over, under)| fits(*over) && fits(*under))?;
        return Some(Repeat::of(&Weave::Twill { over, under }));
    }
    if let Some(numbers) = text.strip_prefix("satin") {
        let (shafts, counter) = two(numbers).filter(|(shafts, _)| fits(*shafts))?;
        let satin = Weave::Satin {
            shafts,
            counter,
            face: Face::Weft,
        };
        let at = crate::scenario::check::Checker::root();
        return satin.check(&at).is_ok().then(|| Repeat::of(&satin));
    }
    let side: usize = text.strip_prefix("basket")?.trim().parse().ok()?;
    (1..=LARGEST_REPEAT / 2)
        .contains(&side)
        .then(|| basket(side))
}

fn basket(side: usize) -> Repeat {
    Repeat::new(2 * side, 2 * side, |e, p| {
        (e / side + p / side).is_multiple_of(2)
    })
}

fn drawn(text: &str) -> Option<Repeat> {
    let rows: Vec<Vec<char>> = text
        .split(',')
        .map(|row| row.trim().chars().collect())
        .collect();
    let ends = rows[0].len();
    let fits = (1..=LARGEST_REPEAT).contains(&ends) && rows.len() <= LARGEST_REPEAT;
    let even = rows.iter().all(|row| row.len() == ends);
    let clear = rows.iter().flatten().all(|c| matches!(c, 'X' | 'x' | '.'));
    (fits && even && clear).then(|| Repeat::new(ends, rows.len(), |e, p| rows[p][e] != '.'))
}

/// A weave as it is seen in a photograph.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Seen {
    /// The weave as a scenario has it.
    pub weave: Weave,
    /// One repeat from the top, pick by pick: `X` where the warp is on top, `.` where the weft is.
    pub rows: Vec<String>,
    /// What it is called, if it has a name.
    pub name: Option<String>,
}

impl Seen {
    pub(super) fn of(lattice: Lattice, warp_up: &[bool]) -> Self {
        let (ends, picks) = lattice.repeat();
        let whole = Repeat::new(ends, picks, |e, p| warp_up[lattice.class(e, p)]);
        // The classes may repeat in less.
        let (ends, picks) = whole.lattice().repeat();
        let repeat = Repeat::new(ends, picks, |e, p| whole.get(e, p));
        let (name, weave) = recognised(&repeat);
        let rows = repeat.rows();
        Seen {
            weave: weave.unwrap_or_else(|| Weave::Matrix(rows.clone())),
            rows,
            name,
        }
    }
}

/// The name of a weave, and the weave of a scenario that it is.
fn recognised(repeat: &Repeat) -> (Option<String>, Option<Weave>) {
    let Lattice { a, b, c } = repeat.lattice();
    let is = |weave: &Weave| repeat.is(&Repeat::of(weave));
    if is(&Weave::Plain) {
        return (Some("plain weave".into()), Some(Weave::Plain));
    }
    let up = (0..a).filter(|e| repeat.get(*e, 0)).count() as u32;
    let shafts = a as u32;
    if c == 1 && (b == 1 || b == a - 1) && up > 0 && up < shafts {
        let (over, under) = (up, shafts - up);
        let twill = Weave::Twill { over, under };
        // Down a pick and on by an end to the right: from the upper left to the lower right.
        let falls = is(&twill);
        if falls || repeat.is(&Repeat::of(&twill).mirrored()) {
            let way = if falls { "S, falling" } else { "Z, rising" };
            let name = format!("{over}/{under} twill ({way} to the right)");
            return (Some(name), falls.then_some(twill));
        }
    }
    if c == 1 && (up == 1 || up == shafts - 1) {
        let (face, faced) = if up == 1 {
            (Face::Weft, "weft")
        } else {
            (Face::Warp, "warp")
        };
        let satin = Weave::Satin {
            shafts,
            counter: b as u32,
            face,
        };
        let at = crate::scenario::check::Checker::root();
        if satin.check(&at).is_ok() && is(&satin) {
            let name = format!("{faced}-faced satin of {shafts}, moved by {b}");
            return (Some(name), Some(satin));
        }
    }
    for side in 2..=a.max(c) {
        if repeat.is(&basket(side)) {
            return (Some(format!("{side}/{side} basket weave")), None);
        }
        let of_warp = Repeat::new(2, 2 * side, |e, p| (e + p / side).is_multiple_of(2));
        if repeat.is(&of_warp) {
            return (Some(format!("warp rib over {side} picks")), None);
        }
        let of_weft = Repeat::new(2 * side, 2, |e, p| (e / side + p).is_multiple_of(2));
        if repeat.is(&of_weft) {
            return (Some(format!("weft rib over {side} ends")), None);
        }
    }
    (None, None)
}

impl fmt::Display for Seen {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match &self.name {
            Some(name) => f.write_str(name),
            None => {
                let (ends, picks) = (self.rows[0].len(), self.rows.len());
                write!(
                    f,
                    "a weave without a common name, repeating every {ends} ends and {picks} picks"
                )
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(text: &str) -> Seen {
        let repeat = named(text).or_else(|| drawn(text)).unwrap();
        Seen::of(repeat.lattice(), &repeat.classes())
    }

    #[test]
    fn weaves_are_called_by_their_names() {
        let name = |text| seen(text).name.unwrap_or_default();
        assert_eq!(name("plain"), "plain weave");
        assert_eq!(name("twill2/1"), "2/1 twill (S, falling to the right)");
        assert_eq!(name("X.X,.XX,XX."), "2/1 twill (Z, rising to the right)");
        assert_eq!(name("satin5/2"), "weft-faced satin of 5, moved by 2");
        assert_eq!(name("basket3"), "3/3 basket weave");
        assert_eq!(name("X.,X.,.X,.X"), "warp rib over 2 picks");
        assert_eq!(name("XX..,..XX"), "weft rib over 2 ends");
        assert_eq!(name("XX.X,X..X,.XX.,X.X."), "");
    }

    #[test]
    fn a_weave_drawn_twice_over_is_the_same_weave() {
        assert_eq!(seen("X.X.,.X.X,X.X.,.X.X"), seen("plain"));
    }

    #[test]
    fn what_is_seen_can_be_woven_as_it_is_seen() {
        for text in [
            "plain",
            "twill3/1",
            "satin8/3",
            "basket2",
            "X.X,.XX,XX.",
            "X...,.X..,...X,..X.",
        ] {
            let seen = seen(text);
            let drawn = Repeat::of(&Weave::Matrix(seen.rows.clone()));
            assert!(Repeat::of(&seen.weave).is(&drawn), "{text}");
        }
    }

    #[test]
    fn a_twill_is_known_both_ways_round_and_a_satin_by_both_faces() {
        let versions = |text: &str| text.parse::<KnownWeave>().unwrap().versions.len();
        assert_eq!(versions("plain"), 1);
        assert_eq!(versions("twill2/2"), 2);
        assert_eq!(versions("satin8/3"), 4);
        assert_eq!(versions("basket2"), 1);
    }

    #[test]
    fn what_is_no_weave_is_told() {
        for text in [
            "", "plane", "twill", "twill0/2", "satin6/2", "X", "XX,XX", "X.,.", "basket0",
        ] {
            assert!(text.parse::<KnownWeave>().is_err(), "{text}");
        }
    }
}
