//! What is wrong with a draft, and what is odd about it: each with its place in the file.

use std::collections::HashMap;
use std::fmt;
use std::path::PathBuf;

use thiserror::Error;

use super::Draft;

/// Why a draft cannot be had.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum DraftError {
    /// Neither a file nor a bundled draft has this name.
    #[error("there is no file and no bundled draft named `{name}`{}", did_you_mean(.nearest.as_deref()))]
    Unknown {
        /// What was asked for.
        name: String,
        /// The bundled name that is most like it.
        nearest: Option<String>,
    },
    /// The file cannot be read.
    #[error("cannot read the draft {}: {why}", .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The reason.
        why: String,
    },
    /// The file says what cannot be woven.
    #[error("{0}")]
    Refused(Box<Remark>),
    /// A program asked for a draft of no or too many threads.
    #[error(
        "a draft has 1 to {} ends and picks, but this is to have {ends} ends and {picks} picks",
        super::MOST_THREADS
    )]
    Size {
        /// Ends asked for.
        ends: usize,
        /// Picks asked for.
        picks: usize,
    },
}

fn did_you_mean(nearest: Option<&str>) -> String {
    nearest.map_or(String::new(), |name| format!("; did you mean `{name}`?"))
}

/// Something about a draft that its reader should know, and where in the file it is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Remark {
    /// The file, or what it is called.
    pub name: String,
    /// Line, from 1; none where it is about the file as a whole.
    pub line: Option<usize>,
    /// What is the matter, and what was made of it or would be right. Begins with the section and the
    /// line itself, as in ``[THREADING] 5=x: …``.
    pub what: String,
    /// How many more lines have the same matter.
    pub more: usize,
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}:", self.name)?;
        if let Some(line) = self.line {
            write!(f, "{line}:")?;
        }
        write!(f, " {}", self.what)?;
        match self.more {
            0 => Ok(()),
            1 => write!(f, " (and one more line like it)"),
            more => write!(f, " (and {more} more lines like it)"),
        }
    }
}

/// A draft that has been read, and what was odd about its file.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// The draft.
    pub draft: Draft,
    /// What had to be guessed or left out, in the order it was found.
    pub warnings: Vec<Remark>,
}

/// A place in a file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place<'t> {
    pub line: usize,
    pub section: &'t str,
    pub text: &'t str,
}

impl Place<'_> {
    /// What is the matter here.
    fn says(&self, what: &str) -> String {
        const ROOM: usize = 60;
        // Nothing in a file drives the terminal, and no line floods it.
        let shown = |c: char| if c.is_control() { ' ' } else { c };
        let mut text: String = self.text.chars().take(ROOM).map(shown).collect();
        if self.text.chars().nth(ROOM).is_some() {
            text.push('…');
        }
        let section = self.section;
        match (section.is_empty(), text.is_empty()) {
            (true, true) => what.into(),
            (true, false) => format!("{text}: {what}"),
            (false, true) => format!("[{section}]: {what}"),
            (false, false) => format!("[{section}] {text}: {what}"),
        }
    }
}

/// The remarks about one file. Of each matter in a section only the first place is kept, and the
/// others are counted, so that a file full of mistakes is told of in a few lines.
#[derive(Debug)]
pub(super) struct Remarks<'t> {
    name: &'t str,
    list: Vec<Remark>,
    known: HashMap<(String, &'static str), usize>,
}

impl<'t> Remarks<'t> {
    pub fn about(name: &'t str) -> Self {
        Remarks {
            name,
            list: Vec::new(),
            known: HashMap::new(),
        }
    }

    /// Notes a `matter` at a place.
    pub fn note(&mut self, matter: &'static str, at: Place, what: impl FnOnce() -> String) {
        let next = self.list.len();
        let key = (at.section.to_owned(), matter);
        let index = *self.known.entry(key).or_insert(next);
        match self.list.get_mut(index) {
            Some(first) => first.more += 1,
            None => self.list.push(Remark {
                name: self.name.into(),
                line: Some(at.line),
                what: at.says(&what()),
                more: 0,
            }),
        }
    }

    /// Notes something about the file as a whole.
    pub fn note_whole(&mut self, what: String) {
        self.list.push(Remark {
            name: self.name.into(),
            line: None,
            what,
            more: 0,
        });
    }

    /// Refuses the file because of a place in it.
    pub fn refuse(&self, at: Place, what: &str) -> DraftError {
        DraftError::Refused(Box::new(Remark {
            name: self.name.into(),
            line: Some(at.line),
            what: at.says(what),
            more: 0,
        }))
    }

    /// Refuses the file as a whole.
    pub fn refuse_whole(&self, what: &str) -> DraftError {
        DraftError::Refused(Box::new(Remark {
            name: self.name.into(),
            line: None,
            what: what.into(),
            more: 0,
        }))
    }

    pub fn into_list(self) -> Vec<Remark> {
        self.list
    }
}
