//! Writing a draft as a WIF.
//!
//! Readable by as many programs as possible, some of which take nothing for granted: where threads
//! differ, every thread has its line; a treadle that is tied to nothing has none, since 0 is not
//! understood everywhere; a liftplan comes with no treadles.

use std::collections::HashMap;
use std::fmt::Write;
use std::hash::Hash;

use crate::draft::{Draft, Lifting, Shed, Thread};

/// Writes a draft as the text of a WIF 1.1. [`read`](super::read()) makes the same draft of it.
pub fn write(draft: &Draft) -> String {
    // A file counts its ends from the right.
    let warp: Vec<Thread> = draft.warp().iter().rev().copied().collect();
    let palette = Palette::of(warp.iter().chain(draft.weft()));
    let mut sections = Sections::default();
    sections.text(draft);
    sections.weave(draft);
    sections.palette(&palette);
    sections.threads("WARP", &warp, &palette);
    sections.threads("WEFT", draft.weft(), &palette);

    let mut file = format!(
        "[WIF]\nVersion=1.1\nDate=April 20, 1997\nDevelopers=wif@mhsoft.com\n\
         Source Program=dyelapse\nSource Version={}\n\n[CONTENTS]\n",
        env!("CARGO_PKG_VERSION")
    );
    for (name, _) in &sections.0 {
        let _ = writeln!(file, "{name}=true");
    }
    for (name, lines) in &sections.0 {
        let _ = write!(file, "\n[{name}]\n{lines}");
    }
    file
}

/// The sections in order, each with its lines.
#[derive(Default)]
struct Sections(Vec<(String, String)>);

impl Sections {
    fn add(&mut self, name: &str, lines: String) {
        if !lines.is_empty() {
            self.0.push((name.into(), lines));
        }
    }

    fn text(&mut self, draft: &Draft) {
        let mut lines = String::new();
        for (key, value) in [("Title", draft.title()), ("Author", draft.author())] {
            if !value.is_empty() {
                let _ = writeln!(lines, "{key}={value}");
            }
        }
        self.add("TEXT", lines);
        self.add("NOTES", numbered(draft.notes()));
    }

    fn weave(&mut self, draft: &Draft) {
        self.add(
            "WEAVING",
            format!(
                "Rising Shed={}\nTreadles={}\nShafts={}\n",
                draft.shed() == Shed::Rising,
                draft.treadles(),
                draft.shafts()
            ),
        );
        self.add(
            "THREADING",
            numbered(draft.threading().iter().rev().map(list)),
        );
        match draft.lifting() {
            Lifting::Liftplan(picks) => self.add("LIFTPLAN", numbered(picks.iter().map(list))),
            Lifting::Treadles { tieup, treadling } => {
                let all_loose = tieup.iter().all(Vec::is_empty);
                let tied = tieup.iter().enumerate();
                let mut lines = String::new();
                for (i, shafts) in tied.filter(|(_, shafts)| all_loose || !shafts.is_empty()) {
                    let _ = writeln!(lines, "{}={}", i + 1, list(shafts));
                }
                self.add("TIEUP", lines);
                self.add("TREADLING", numbered(treadling.iter().map(list)));
            }
        }
    }

    fn palette(&mut self, palette: &Palette) {
        if palette.colours.is_empty() {
            return;
        }
        let entries = palette.colours.len();
        self.add(
            "COLOR PALETTE",
            format!("Entries={entries}\nForm=RGB\nRange=0,255\n"),
        );
        let colours = palette.colours.iter();
        self.add(
            "COLOR TABLE",
            numbered(colours.map(|[r, g, b]| format!("{r},{g},{b}"))),
        );
    }

    fn threads(&mut self, name: &str, threads: &[Thread], palette: &Palette) {
        let colours = of_each(threads, |thread| thread.colour.map(|c| palette.number[&c]));
        let spacing = of_each(threads, |thread| thread.spacing_mm.map(centimetres));
        let thickness = of_each(threads, |thread| thread.thickness_mm.map(centimetres));
        let mut all = format!("Threads={}\n", threads.len());
        if let Some(colour) = &colours.most {
            let _ = writeln!(all, "Color={colour}");
        }
        all.push_str("Units=centimeters\n");
        for (key, values) in [("Spacing", &spacing), ("Thickness", &thickness)] {
            if let Some(value) = &values.most {
                let _ = writeln!(all, "{key}={value}");
            }
        }
        self.add(name, all);
        self.add(&format!("{name} COLORS"), colours.lines);
        self.add(&format!("{name} SPACING"), spacing.lines);
        self.add(&format!("{name} THICKNESS"), thickness.lines);
    }
}

/// A value that each thread may have.
struct Each {
    /// The most common one, which stands for all; none where a thread has no value, since nothing
    /// can say of a single thread that it has none.
    most: Option<String>,
    /// A line for each thread; empty where all are alike.
    lines: String,
}

fn of_each<T: Eq + Hash + ToString>(threads: &[Thread], of: impl Fn(&Thread) -> Option<T>) -> Each {
    let values: Vec<Option<T>> = threads.iter().map(of).collect();
    let mut counts: HashMap<&T, (usize, usize)> = HashMap::new();
    for (i, value) in values.iter().enumerate() {
        if let Some(value) = value {
            // Of equally common ones the first.
            counts.entry(value).or_insert((0, values.len() - i)).0 += 1;
        }
    }
    let alike = counts.len() <= 1;
    let most = counts.into_iter().max_by_key(|(_, count)| *count);
    let most = most.map(|(value, _)| value.to_string());
    let gaps = values.contains(&None);
    let mut lines = String::new();
    if !alike || gaps {
        for (i, value) in values.iter().enumerate() {
            if let Some(value) = value {
                let _ = writeln!(lines, "{}={}", i + 1, value.to_string());
            }
        }
    }
    Each {
        most: most.filter(|_| !gaps),
        lines,
    }
}

/// The colours of a draft, numbered from 1 in the order they first come.
#[derive(Default)]
struct Palette {
    colours: Vec<[u8; 3]>,
    number: HashMap<[u8; 3], usize>,
}

impl Palette {
    fn of<'t>(threads: impl Iterator<Item = &'t Thread>) -> Self {
        let mut palette = Palette::default();
        for colour in threads.filter_map(|thread| thread.colour) {
            let next = palette.colours.len() + 1;
            if *palette.number.entry(colour).or_insert(next) == next {
                palette.colours.push(colour);
            }
        }
        palette
    }
}

/// Lines numbered from 1.
fn numbered(values: impl IntoIterator<Item = impl std::fmt::Display>) -> String {
    let mut lines = String::new();
    for (i, value) in values.into_iter().enumerate() {
        let _ = writeln!(lines, "{}={value}", i + 1);
    }
    lines
}

/// Shafts or treadles; 0 for none.
fn list(numbers: impl AsRef<[u16]>) -> String {
    let words: Vec<String> = numbers.as_ref().iter().map(u16::to_string).collect();
    if words.is_empty() {
        "0".into()
    } else {
        words.join(",")
    }
}

/// Whole nanometres in centimetres, without needless zeros.
fn centimetres(mm: f64) -> String {
    let text = format!("{:.7}", mm / 10.0);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
