//! The text of a WIF: from bytes to characters, from lines to sections.

use std::borrow::Cow;
use std::collections::BTreeMap;

use encoding_rs::{Encoding, UTF_8, WINDOWS_1252};

use crate::draft::DraftError;
use crate::draft::error::{Place, Remarks};

/// The sections that are read. All others are passed over: private ones, symbols, zoom.
const SECTIONS: [&str; 19] = [
    "WIF",
    "CONTENTS",
    "COLOR PALETTE",
    "COLOR TABLE",
    "TEXT",
    "NOTES",
    "WEAVING",
    "WARP",
    "WEFT",
    "THREADING",
    "TIEUP",
    "TREADLING",
    "LIFTPLAN",
    "WARP COLORS",
    "WARP SPACING",
    "WARP THICKNESS",
    "WEFT COLORS",
    "WEFT SPACING",
    "WEFT THICKNESS",
];

/// A line `key=value`.
#[derive(Debug, Clone, Copy)]
pub struct Entry<'t> {
    /// Line number, from 1.
    pub line: usize,
    /// The section it is in.
    pub section: &'static str,
    /// The whole line, without blanks around it.
    pub text: &'t str,
    /// What stands before `=`.
    pub key: &'t str,
    /// What stands behind it, without a comment.
    pub value: &'t str,
}

impl Entry<'_> {
    pub fn place(&self) -> Place<'_> {
        Place {
            line: self.line,
            section: self.section,
            text: self.text,
        }
    }
}

/// The sections of a file, each with its lines in order; one that comes twice is one.
#[derive(Debug, Default)]
pub struct Sections<'t>(BTreeMap<&'static str, Vec<Entry<'t>>>);

impl<'t> Sections<'t> {
    /// The lines of a section; none if it is not there.
    pub fn lines(&self, section: &str) -> &[Entry<'t>] {
        self.0.get(section).map_or(&[], Vec::as_slice)
    }

    /// Whether a section is there, even an empty one.
    pub fn has(&self, section: &str) -> bool {
        self.0.contains_key(section)
    }

    /// The last line of a section with this key that says anything.
    pub fn find(&self, section: &str, key: &str) -> Option<&Entry<'t>> {
        let key = plain(key);
        let says = |entry: &&Entry| !entry.value.is_empty() && plain(entry.key) == key;
        self.lines(section).iter().rev().find(says)
    }
}

/// A name as it is compared: in capitals, without blanks and the like, in American spelling.
fn plain(name: &str) -> String {
    name.chars()
        .filter(|c| !c.is_whitespace() && !"_-".contains(*c))
        .flat_map(char::to_uppercase)
        .collect::<String>()
        .replace("COLOUR", "COLOR")
}

/// The section that a name means, if it is one that is read.
pub fn known(name: &str) -> Option<&'static str> {
    let name = plain(name);
    SECTIONS.into_iter().find(|section| plain(section) == name)
}

/// Bytes as text: UTF-8 (or UTF-16 with a byte order mark), else Windows-1252, which Latin-1 is a
/// part of and which any bytes are.
pub fn decode(bytes: &[u8]) -> Cow<'_, str> {
    if let Some((encoding, mark)) = Encoding::for_bom(bytes) {
        return encoding.decode_without_bom_handling(&bytes[mark..]).0;
    }
    UTF_8
        .decode_without_bom_handling_and_without_replacement(bytes)
        .unwrap_or_else(|| WINDOWS_1252.decode_without_bom_handling(bytes).0)
}

/// The lines of a text, whatever they end with.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.split('\n')
        .flat_map(|line| line.strip_suffix('\r').unwrap_or(line).split('\r'))
        .enumerate()
        .map(|(i, line)| (i + 1, line.trim()))
}

/// Sorts the lines of a text into sections.
///
/// # Errors
/// The text is no WIF at all.
pub fn split<'t>(text: &'t str, remarks: &mut Remarks) -> Result<Sections<'t>, DraftError> {
    let begins = lines(text).find(|(_, line)| header(line) == Header::Known("WIF"));
    let begin = match begins {
        Some((begin, _)) => begin,
        None if lines(text).any(|(_, line)| header(line) == Header::Known("THREADING")) => {
            remarks
                .note_whole("there is no [WIF] section; it is read as a WIF nevertheless".into());
            1
        }
        None => return Err(remarks.refuse_whole("this is no WIF: there is no [WIF] section")),
    };
    let mut sections = Sections::default();
    let mut current: Option<&'static str> = None;
    for (line, text) in lines(text) {
        let at = |section| Place {
            line,
            section,
            text,
        };
        if text.is_empty() || text.starts_with([';', '#']) {
            continue;
        }
        if line < begin {
            remarks.note("before", at(""), || {
                "this comes before [WIF] and is passed over".into()
            });
            continue;
        }
        match header(text) {
            Header::Known(name) => {
                if sections.has(name) {
                    remarks.note("twice", at(""), || {
                        "this section comes again; both are read as one".into()
                    });
                }
                sections.0.entry(name).or_default();
                current = Some(name);
            }
            Header::Other => current = None,
            Header::No => {
                let Some(section) = current else { continue };
                let Some((key, value)) = text.split_once('=') else {
                    remarks.note("stray", at(section), || {
                        "there is no `=`; the line is passed over".into()
                    });
                    continue;
                };
                // What people write may have a `;` in it.
                let value = match section {
                    "TEXT" | "NOTES" => value,
                    _ => value.split(';').next().unwrap_or(""),
                };
                sections.0.entry(section).or_default().push(Entry {
                    line,
                    section,
                    text,
                    key: key.trim(),
                    value: value.trim(),
                });
            }
        }
    }
    Ok(sections)
}

#[derive(Debug, PartialEq, Eq)]
enum Header {
    /// The head of a section that is read.
    Known(&'static str),
    /// The head of another section.
    Other,
    /// No head.
    No,
}

/// Whether a line is the head of a section. That of a known section may lack its bracket or have
/// something behind it; for any other that would be too bold, since `[12]Border` is how a program
/// marks a part of a threading.
fn header(line: &str) -> Header {
    let Some(rest) = line.strip_prefix('[') else {
        return Header::No;
    };
    let (name, behind) = match rest.split_once(']') {
        Some((name, behind)) => (name, behind.trim_start()),
        None => (rest, "no bracket"),
    };
    match known(name) {
        Some(name) => Header::Known(name),
        None if behind.is_empty() || behind.starts_with(';') => Header::Other,
        None => Header::No,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_counted_whatever_they_end_with() {
        let counted: Vec<_> = lines("a\r\nb\rc\n\nd").collect();
        assert_eq!(counted, [(1, "a"), (2, "b"), (3, "c"), (4, ""), (5, "d")]);
    }

    #[test]
    fn any_bytes_are_text() {
        assert_eq!(decode("Größe".as_bytes()), "Größe");
        assert_eq!(decode(b"Gr\xf6\xdfe \x96 5 \x80"), "Größe – 5 €");
        assert_eq!(decode(b"\xef\xbb\xbf[WIF]"), "[WIF]");
        assert_eq!(decode(b"\xff\xfe[\0W\0I\0F\0]\0"), "[WIF]");
    }

    #[test]
    fn a_section_is_known_by_any_spelling_of_its_name() {
        for head in [
            "[WARP COLORS]",
            "[ Warp  Colours ] ; of the warp",
            "[warp_colors",
            "[WARPCOLORS] x",
        ] {
            assert_eq!(header(head), Header::Known("WARP COLORS"), "{head}");
        }
        assert_eq!(header("[PRIVATE X WARP]"), Header::Other);
        assert_eq!(header("[12]Border"), Header::No);
    }
}
