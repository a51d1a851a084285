//! Errors in scenarios, told so that the reader can mend them: place, line, caret, what was
//! expected, and the nearest valid name.

use std::fmt;
use std::path::PathBuf;

use thiserror::Error;
use unicode_width::UnicodeWidthStr;

use super::check::Problem;
use super::locate::{self, locate};

/// Why a scenario cannot be run.
#[derive(Debug, Error)]
pub enum ScenarioError {
    /// Neither a file nor anything bundled has this name.
    #[error("there is no file and nothing bundled named `{name}`{}\n`dyelapse list` shows what is bundled", did_you_mean(.nearest.as_deref()))]
    Unknown {
        /// What was asked for.
        name: String,
        /// The bundled name that is most like it.
        nearest: Option<String>,
    },
    /// The file cannot be read.
    #[error("cannot read the scenario {}: {why}", .path.display())]
    Unreadable {
        /// The scenario file.
        path: PathBuf,
        /// The reason.
        why: String,
    },
    /// The text says something that is not RON, not a scenario, or not possible.
    #[error("{0}")]
    Source(Box<SourceError>),
    /// A scenario made by a program, not by a file, says something impossible.
    #[error("the scenario says something impossible: {0}")]
    Problem(#[from] Problem),
    /// The cloth does not fit in memory.
    #[error("{0}")]
    Memory(#[from] crate::memory::MemoryError),
}

/// An error at a place in the text of a scenario.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SourceError {
    /// The file, or the bundled name.
    pub name: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The line itself; of a long one, the part around the column.
    pub text: String,
    /// Characters of `text` before the place.
    pub before: usize,
    /// Characters that the caret underlines.
    pub width: usize,
    /// What is wrong, and what was expected.
    pub what: String,
}

impl fmt::Display for SourceError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let number = self.line.to_string();
        let margin = " ".repeat(number.len());
        let (name, line, column, what) = (&self.name, self.line, self.column, &self.what);
        writeln!(f, "{name}:{line}:{column}: {what}")?;
        writeln!(f, "{margin} |")?;
        // Tabs and other control characters become one space each, so that the caret stands where
        // the column says and nothing in a file drives the terminal.
        let shown = |c: char| if c.is_control() { ' ' } else { c };
        let text: String = self.text.chars().map(shown).collect();
        writeln!(f, "{number} | {text}")?;
        let before: String = text.chars().take(self.before).collect();
        let before = " ".repeat(before.width());
        write!(f, "{margin} | {before}{}", "^".repeat(self.width.max(1)))
    }
}

impl SourceError {
    /// An error about the bytes `begin..end` of `source`.
    fn between(name: &str, source: &str, begin: usize, end: usize, what: String) -> Self {
        let begin = floor_boundary(source, begin);
        let end = floor_boundary(source, end.max(begin));
        let line_begin = source[..begin].rfind('\n').map_or(0, |i| i + 1);
        let text = source[line_begin..].lines().next().unwrap_or("");
        let column = source[line_begin..begin].chars().count() + 1;
        let marked = source[begin..end].lines().next().unwrap_or("").trim_end();
        let width = marked.chars().count().clamp(1, 60);
        let (text, before) = excerpt(text, column, width);
        SourceError {
            name: name.into(),
            line: source[..begin].matches('\n').count() + 1,
            column,
            text,
            before,
            width,
            what,
        }
    }

    /// What RON could not make a scenario of.
    pub(super) fn from_ron(name: &str, source: &str, error: &ron::error::SpannedError) -> Self {
        // Brackets that do not fit together make the parser stumble far from where they are.
        use ron::Error as E;
        let is_about_a_name = matches!(
            error.code,
            E::NoSuchStructField { .. }
                | E::NoSuchEnumVariant { .. }
                | E::MissingStructField { .. }
        );
        let unbalanced = locate::unbalanced(source);
        if let Some(found) = unbalanced.filter(|found| !(found.at_end && is_about_a_name)) {
            return SourceError::between(name, source, found.begin, found.begin + 1, found.what);
        }
        let begin = offset(source, error.span.start);
        let end = offset(source, error.span.end);
        let (begin, end) = token_near(source, begin, end, &error.code);
        SourceError::between(name, source, begin, end, describe(&error.code))
    }

    /// A value that parsed but cannot be.
    pub(super) fn from_problem(name: &str, source: &str, problem: &Problem) -> Self {
        let (begin, end) = locate(source, &problem.path).map_or((0, 0), |f| (f.begin, f.end));
        SourceError::between(name, source, begin, end, problem.to_string())
    }
}

fn floor_boundary(source: &str, at: usize) -> usize {
    let mut at = at.min(source.len());
    while !source.is_char_boundary(at) {
        at -= 1;
    }
    at
}

/// A line, or of a long one the part around a column, and how much of it comes before the column.
fn excerpt(line: &str, column: usize, width: usize) -> (String, usize) {
    const ROOM: usize = 110;
    let characters: Vec<char> = line.chars().collect();
    let before = column - 1;
    if characters.len() <= ROOM || before + width <= ROOM {
        let cut = if characters.len() > ROOM { "…" } else { "" };
        return (
            characters
                .iter()
                .take(ROOM)
                .chain(&cut.chars().collect::<Vec<_>>())
                .collect(),
            before,
        );
    }
    let from = before.min(characters.len()).saturating_sub(ROOM / 2);
    let until = characters.len().min(from + ROOM);
    let end = if until < characters.len() { "…" } else { "" };
    let part: String = characters[from..until].iter().collect();
    (format!("…{part}{end}"), before - from + 1)
}

/// Byte offset of a line and column that count from 1.
fn offset(source: &str, position: ron::error::Position) -> usize {
    let line_begin = source
        .split_inclusive('\n')
        .take(position.line.saturating_sub(1))
        .map(str::len)
        .sum::<usize>();
    let line = &source[line_begin.min(source.len())..];
    line_begin
        + line
            .chars()
            .take(position.col.saturating_sub(1))
            .map(char::len_utf8)
            .sum::<usize>()
}

/// The word that an error is about: RON's span may begin before it or end after it.
fn token_near(source: &str, begin: usize, end: usize, code: &ron::Error) -> (usize, usize) {
    use ron::Error as E;
    let named = match code {
        E::NoSuchStructField { found, .. } | E::NoSuchEnumVariant { found, .. } => Some(&**found),
        E::DuplicateStructField { field, .. } => Some(*field),
        E::ExpectedDifferentStructName { found, .. } => Some(&**found),
        _ => None,
    };
    if let Some(word) = named.filter(|word| !word.is_empty()) {
        // The parser stands at or just behind the name.
        let until = source.len().min(floor_boundary(source, end) + word.len());
        let until = floor_boundary(source, until);
        if let Some(at) = source[..until].rfind(word) {
            return (at, at + word.len());
        }
    }
    if matches!(code, E::IntegerOutOfBounds) {
        // The parser stands behind the number.
        let text = &source[..floor_boundary(source, end)];
        let number = text.trim_end_matches(|c: char| c.is_alphanumeric() || "+-_.".contains(c));
        return (number.len(), text.len());
    }
    let points_at_value = matches!(code, E::InvalidValueForType { .. } | E::Message(_));
    if points_at_value && begin < end {
        let text = &source[floor_boundary(source, begin)..floor_boundary(source, end)];
        let blank = text.len() - text.trim_start().len();
        return (begin + blank, end);
    }
    (end, end + 1)
}

fn describe(code: &ron::Error) -> String {
    use ron::Error as E;
    let of = |outer: &Option<String>| match outer {
        Some(outer) => format!(" in `{outer}`"),
        None => String::new(),
    };
    match code {
        E::NoSuchStructField {
            expected,
            found,
            outer,
        } => format!(
            "there is no field `{found}`{}{}\nexpected one of: {}",
            of(outer),
            did_you_mean(nearest(found, expected.iter().copied())),
            expected.join(", ")
        ),
        E::NoSuchEnumVariant {
            expected,
            found,
            outer,
        } => format!(
            "`{found}` is not a {}{}\nexpected one of: {}",
            outer.as_deref().unwrap_or("choice").to_lowercase(),
            did_you_mean(nearest(found, expected.iter().copied())),
            expected.join(", ")
        ),
        E::MissingStructField { field, outer } => {
            format!("the field `{field}` is missing{}", of(outer))
        }
        E::DuplicateStructField { field, outer } => {
            format!("the field `{field}` is given twice{}", of(outer))
        }
        E::InvalidValueForType { expected, found } => {
            format!("expected {expected}, but found {found}")
        }
        E::ExceededRecursionLimit => "this is nested too deeply".into(),
        E::IntegerOutOfBounds => {
            "a whole number of 0 or more is needed here (and this one may be too large)".into()
        }
        E::SuggestRawIdentifier(_) | E::InvalidIdentifier(_) => {
            "a name is needed here; a length has its unit around it, as in `Mm(1.5)` or `Cells(30)`, \
             and so has a time, as in `Hours(2.5)`"
                .into()
        }
        E::ExpectedStructLikeEnd => {
            "expected `)`; decimal numbers are written with a point, as in 1.5, and only where parts \
             make sense"
                .into()
        }
        E::ExpectedMapColon => "expected `:` after the name of the field".into(),
        E::ExpectedArray => "a list stands in square brackets: `[ … , … ]`".into(),
        E::ExpectedInteger | E::InvalidIntegerDigit { .. } => "expected a whole number".into(),
        E::ExpectedFloat => "expected a number".into(),
        E::ExpectedString => "expected text in quotes".into(),
        E::ExpectedIdentifier => "expected a name: of a field, a pattern, a weave …".into(),
        E::ExpectedNamedStructLike(name) => {
            format!("expected `(`, then the fields of `{name}`, then `)`")
        }
        E::Eof => "the text ends too early: a bracket or quote is not closed".into(),
        E::TrailingCharacters => "expected the end of the scenario here".into(),
        other => {
            let text = other.to_string();
            let mut letters = text.chars();
            match letters.next() {
                Some(first) => first.to_lowercase().chain(letters).collect(),
                None => text,
            }
        }
    }
}

pub(super) fn did_you_mean(nearest: Option<&str>) -> String {
    nearest.map_or(String::new(), |name| format!("; did you mean `{name}`?"))
}

/// The valid name most like what was written, if any is.
pub(crate) fn nearest<'a>(
    written: &str,
    valid: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let likeness = |name: &str| strsim::jaro_winkler(&written.to_lowercase(), &name.to_lowercase());
    valid
        .into_iter()
        .map(|name| (likeness(name), name))
        .filter(|(likeness, _)| *likeness > 0.75)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, name)| name)
}
