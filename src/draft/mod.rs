//! Drafts: how weavers write down a weave, and the file that every weaving program reads (WIF).
//!
//! A draft says which **shaft** each warp end is threaded on, and which shafts each pick lifts:
//! either directly (a **liftplan**), or by treadles (the **treadling**) that are tied to shafts (the
//! **tie-up**). Where a shaft that carries an end is lifted, that end lies over the pick; all those
//! crossings together are the **drawdown**. On a loom with a sinking shed the tied shafts go down
//! instead, and the drawdown is the complement.
//!
//! # Which way round
//! A [`Draft`] counts as the cloth does, ends from the left and picks from the top, so that
//! `draft.warp()[e]` is the end of [`Draft::drawdown`]'s column `e`. Files number ends and picks
//! from 1 without saying where these lie. Drafts on paper, and the programs that draw them, have the
//! tie-up in the upper right corner and count away from it: **end 1 is the rightmost, pick 1 is the
//! topmost**. So end 1 of a file of n ends is our end n − 1, pick 1 is our pick 0, and the picture is
//! the drawdown that a weaver knows from the draft. Only [`wif`] knows of this, reading and writing
//! alike. (On the loom pick 1 is woven first and lies nearest the weaver: there the cloth is the
//! mirror image of its draft, which weavers are used to.)

mod drawdown;
mod error;
mod library;
mod plan;
mod scenario;
mod summary;
pub mod wif;

pub use drawdown::{Floats, floats, repeat};
pub use error::{DraftError, Reading, Remark};
pub use library::{Bundled, bundled, names as bundled_names};

use crate::cloth::LARGEST_REPEAT;

/// The most ends, picks, shafts and treadles that a draft may have.
pub const MOST_THREADS: usize = LARGEST_REPEAT as usize;

/// The widest a thread may be or lie from the next, mm.
pub const WIDEST_MM: f64 = 1000.0;

/// One warp end or weft pick: what a draft says about its looks. What it leaves out is `None`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Thread {
    /// Its colour, red, green and blue as displayed (sRGB).
    pub colour: Option<[u8; 3]>,
    /// The room it takes up, from the middle of one gap to the middle of the next, mm. The reciprocal
    /// of the sett: 12 ends per inch lie 2.12 mm apart.
    pub spacing_mm: Option<f64>,
    /// How thick it is, mm.
    pub thickness_mm: Option<f64>,
}

impl Thread {
    /// How wide the thread lies in the cloth, mm: as thick as it is, but no wider than the room it
    /// has. Where no thickness is given it fills its room.
    pub fn width_mm(&self) -> Option<f64> {
        match (self.thickness_mm, self.spacing_mm) {
            (Some(thickness), Some(spacing)) => Some(thickness.min(spacing)),
            (one, other) => one.or(other),
        }
    }

    /// The gap between this thread and the next, mm; none where no spacing is given.
    pub fn gap_mm(&self) -> f64 {
        match (self.spacing_mm, self.width_mm()) {
            (Some(spacing), Some(width)) => spacing - width,
            _ => 0.0,
        }
    }

    /// The same thread with measures that a file can hold: positive, at most [`WIDEST_MM`], whole
    /// nanometres.
    fn tidy(self) -> Self {
        let tidy = |mm: Option<f64>| {
            mm.map(|mm| (mm * 1e6).round() / 1e6)
                .filter(|mm| *mm > 0.0 && *mm <= WIDEST_MM)
        };
        Thread {
            spacing_mm: tidy(self.spacing_mm),
            thickness_mm: tidy(self.thickness_mm),
            ..self
        }
    }
}

/// What the shafts do that a pick names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shed {
    /// They rise (jack and dobby looms): their ends lie over the pick.
    #[default]
    Rising,
    /// They sink: their ends lie under the pick, all others over it.
    Sinking,
}

/// How the picks of a draft choose their shafts. Shafts and treadles are numbered from 1; every list
/// is sorted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Lifting {
    /// By treadles.
    Treadles {
        /// For each treadle the shafts that it is tied to.
        tieup: Vec<Vec<u16>>,
        /// For each pick from the top the treadles that are pressed.
        treadling: Vec<Vec<u16>>,
    },
    /// Directly: for each pick from the top its shafts.
    Liftplan(Vec<Vec<u16>>),
}

/// A weaving draft. It has at least one end and one pick, and names only shafts and treadles that it
/// has.
#[derive(Debug, Clone, PartialEq)]
pub struct Draft {
    title: String,
    author: String,
    notes: Vec<String>,
    warp: Vec<Thread>,
    weft: Vec<Thread>,
    shafts: usize,
    threading: Vec<Vec<u16>>,
    lifting: Lifting,
    shed: Shed,
}

impl Draft {
    /// What it is called; may be empty.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// Who made it; may be empty.
    pub fn author(&self) -> &str {
        &self.author
    }

    /// What is noted about it, line by line.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The warp ends, from the left.
    pub fn warp(&self) -> &[Thread] {
        &self.warp
    }

    /// The weft picks, from the top.
    pub fn weft(&self) -> &[Thread] {
        &self.weft
    }

    /// How many shafts it needs.
    pub fn shafts(&self) -> usize {
        self.shafts
    }

    /// How many treadles it needs; none with a liftplan.
    pub fn treadles(&self) -> usize {
        match &self.lifting {
            Lifting::Treadles { tieup, .. } => tieup.len(),
            Lifting::Liftplan(_) => 0,
        }
    }

    /// For each end from the left the shafts that it is threaded on, from 1; mostly one.
    pub fn threading(&self) -> &[Vec<u16>] {
        &self.threading
    }

    /// How the picks choose their shafts.
    pub fn lifting(&self) -> &Lifting {
        &self.lifting
    }

    /// Whether the chosen shafts rise or sink.
    pub fn shed(&self) -> Shed {
        self.shed
    }

    /// The same draft with another title, in one line.
    #[must_use]
    pub fn with_title(mut self, title: &str) -> Self {
        self.title = line(title);
        self
    }

    /// The same draft with another author, in one line.
    #[must_use]
    pub fn with_author(mut self, author: &str) -> Self {
        self.author = line(author);
        self
    }

    /// The same draft with other notes, each in one line.
    #[must_use]
    pub fn with_notes<'n>(mut self, notes: impl IntoIterator<Item = &'n str>) -> Self {
        self.notes = notes.into_iter().map(line).collect();
        self
    }
}

/// Text as one line of a file.
fn line(text: &str) -> String {
    let shown = |c: char| if c.is_control() { ' ' } else { c };
    let text: String = text.chars().map(shown).collect();
    text.trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thread_is_no_wider_than_its_room_and_the_gap_is_what_is_left() {
        let thread = |spacing_mm, thickness_mm| Thread {
            spacing_mm,
            thickness_mm,
            ..Thread::default()
        };
        let measured = |thread: Thread| (thread.width_mm(), thread.gap_mm());
        assert_eq!(measured(thread(Some(2.0), Some(1.5))), (Some(1.5), 0.5));
        assert_eq!(measured(thread(Some(2.0), Some(3.0))), (Some(2.0), 0.0));
        assert_eq!(measured(thread(Some(2.0), None)), (Some(2.0), 0.0));
        assert_eq!(measured(thread(None, Some(3.0))), (Some(3.0), 0.0));
        assert_eq!(measured(thread(None, None)), (None, 0.0));
    }
}
