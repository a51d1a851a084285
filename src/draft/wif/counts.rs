//! Numbered lines, and how many threads, shafts and treadles there are.

use std::collections::BTreeMap;

use super::text::{Entry, Sections};
use super::values::{self, BadList};
use crate::draft::error::Remarks;
use crate::draft::{DraftError, MOST_THREADS};

/// The lines of a section by their number, of those that say anything; of two with the same number
/// the later one.
pub fn numbered<'t>(
    sections: &Sections<'t>,
    section: &str,
    remarks: &mut Remarks,
) -> BTreeMap<u64, Entry<'t>> {
    let mut lines: BTreeMap<u64, Entry> = BTreeMap::new();
    for entry in sections.lines(section) {
        if entry.value.is_empty() {
            continue;
        }
        let Some(number) = values::whole(entry.key).filter(|n| *n > 0) else {
            remarks.note("key", entry.place(), || {
                "numbers from 1 stand before the `=` here; the line is passed over".into()
            });
            continue;
        };
        let earlier = lines.insert(number, *entry);
        if let Some(earlier) = earlier.filter(|earlier| earlier.value != entry.value) {
            remarks.note("again", entry.place(), || {
                format!(
                    "line {} says otherwise ({}); this one counts",
                    earlier.line, earlier.value
                )
            });
        }
    }
    lines
}

/// A number that a file declares, such as that of its shafts; 0 is as good as nothing.
pub struct Declared<'t> {
    /// How many.
    pub count: usize,
    entry: Entry<'t>,
}

/// The number that a file declares in one line of a section.
///
/// # Errors
/// It is no whole number, or more than there can be.
pub fn declared<'t>(
    sections: &Sections<'t>,
    section: &str,
    key: &str,
    remarks: &Remarks,
) -> Result<Option<Declared<'t>>, DraftError> {
    let Some(entry) = sections.find(section, key) else {
        return Ok(None);
    };
    match values::whole(entry.value) {
        None => Err(remarks.refuse(entry.place(), "a whole number is needed")),
        Some(count) if count > MOST_THREADS as u64 => Err(remarks.refuse(
            entry.place(),
            &format!("a draft has at most {MOST_THREADS} of them"),
        )),
        Some(0) => Ok(None),
        Some(count) => Ok(Some(Declared {
            count: count as usize,
            entry: *entry,
        })),
    }
}

/// Lists of shafts or treadles by number, from 1.
#[derive(Debug)]
pub struct Lists<'t>(BTreeMap<usize, (Entry<'t>, Vec<u16>)>);

impl<'t> Lists<'t> {
    /// Reads a section of lists. Its lines are numbered by `keys` ("ends", say); `thing` is what the
    /// lists name, of which there are `most`.
    ///
    /// # Errors
    /// A list with something else than numbers in it, or a number that is too large.
    pub fn read(
        sections: &Sections<'t>,
        section: &str,
        (keys, thing): (&str, &str),
        most: Option<&Declared>,
        remarks: &mut Remarks,
    ) -> Result<Self, DraftError> {
        let mut lists = BTreeMap::new();
        for (number, entry) in numbered(sections, section, remarks) {
            if number > MOST_THREADS as u64 {
                let what = format!("a draft has at most {MOST_THREADS} {keys}");
                return Err(remarks.refuse(entry.place(), &what));
            }
            let list = values::list(entry.value).map_err(|bad| {
                let what = match bad {
                    BadList::NotANumber(word) => {
                        let most = most.map_or(String::new(), |most| format!(" to {}", most.count));
                        let word: String = word.chars().take(20).collect();
                        format!("a {thing} is a whole number from 0{most}, but this has {word:?}")
                    }
                    BadList::TooLarge(_) => {
                        format!("a draft has at most {MOST_THREADS} {thing}s")
                    }
                };
                remarks.refuse(entry.place(), &what)
            })?;
            lists.insert(number as usize, (entry, list));
        }
        Ok(Lists(lists))
    }

    /// Whether there is no list, not even one that says "none".
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether any list names anything.
    pub fn name_any(&self) -> bool {
        self.largest().is_some()
    }

    /// The highest number of a list.
    pub fn last(&self) -> usize {
        self.0.keys().next_back().copied().unwrap_or(0)
    }

    /// The highest number that stands in a list, and the first line that has it.
    pub fn largest(&self) -> Option<(usize, &Entry<'t>)> {
        let tops = self.0.values().filter_map(|(entry, list)| {
            let top = usize::from(*list.last()?);
            Some((top, entry))
        });
        tops.reduce(|best, next| if next.0 > best.0 { next } else { best })
    }

    /// The lists from number 1 to `count`, empty where there is none.
    pub fn rows(&self, count: usize) -> Vec<Vec<u16>> {
        let row = |n| self.0.get(&n).map_or(Vec::new(), |(_, list)| list.clone());
        (1..=count).map(row).collect()
    }

    /// The numbers from 1 to `count` that have no list, as text; none if all have.
    pub fn missing(&self, count: usize) -> Option<String> {
        let missing: Vec<usize> = (1..=count).filter(|n| !self.0.contains_key(n)).collect();
        (!missing.is_empty()).then(|| runs(&missing))
    }

    /// How many threads there are: as many as declared, or as have a list if these are more. Beyond the
    /// declared ones, a thread on nothing is none.
    ///
    /// # Errors
    /// Nothing tells of any thread.
    pub fn threads(
        &self,
        (section, many): (&str, &str),
        declared: Option<&Declared>,
        remarks: &mut Remarks,
    ) -> Result<usize, DraftError> {
        let last = self.last();
        let named = |(_, (_, list)): &(&usize, &(Entry, Vec<u16>))| !list.is_empty();
        let named = self.0.iter().rev().find(named).map_or(0, |(n, _)| *n);
        match declared {
            Some(declared) if declared.count >= named => Ok(declared.count),
            Some(declared) => {
                remarks.note("few", declared.entry.place(), || {
                    format!("there are {named} {many}; that is how many are read")
                });
                Ok(named)
            }
            None if last > 0 => Ok(last),
            None => {
                let what =
                    format!("there are no {many}: [{section}] Threads= does not say how many");
                Err(remarks.refuse_whole(&what))
            }
        }
    }
}

/// How many shafts there are: as many as declared, or as the lists name if these are more.
pub fn shafts(declared: Option<&Declared>, lists: [&Lists; 3], remarks: &mut Remarks) -> usize {
    let named = lists.into_iter().filter_map(Lists::largest);
    let largest = named.reduce(|best, next| if next.0 > best.0 { next } else { best });
    let count = declared.map_or(0, |declared| declared.count);
    match largest {
        Some((largest, entry)) if largest > count => {
            if let Some(declared) = declared {
                remarks.note("shafts", entry.place(), || {
                    format!(
                        "line {} says that there are {count} shafts; it is read as {largest}",
                        declared.entry.line
                    )
                });
            }
            largest
        }
        _ => count,
    }
}

/// Sorted numbers as text, neighbours drawn together: `3, 5 to 8`.
fn runs(numbers: &[usize]) -> String {
    const SHOWN: usize = 5;
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for number in numbers {
        match runs.last_mut() {
            Some((_, end)) if *end + 1 == *number => *end = *number,
            _ => runs.push((*number, *number)),
        }
    }
    let mut words: Vec<String> = runs
        .iter()
        .take(SHOWN)
        .map(|(begin, end)| match end - begin {
            0 => begin.to_string(),
            1 => format!("{begin}, {end}"),
            _ => format!("{begin} to {end}"),
        })
        .collect();
    if runs.len() > SHOWN {
        words.push("…".into());
    }
    words.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_a_row_are_told_as_one() {
        assert_eq!(runs(&[3]), "3");
        assert_eq!(runs(&[1, 2, 4, 5, 6, 9]), "1, 2, 4 to 6, 9");
        assert_eq!(runs(&[1, 3, 5, 7, 9, 11]), "1, 3, 5, 7, 9, …");
    }
}
