//! A draft in a few lines, for people.

use std::collections::HashMap;
use std::fmt::{Display, Write};

use super::{Draft, Floats, Lifting, Shed, Thread, floats, repeat};
use crate::cloth::WeaveMatrix;

/// The widest and the tallest weave that is drawn.
const DRAWN: (usize, usize) = (64, 64);

/// The most colours of one direction that are named.
const COLOURS: usize = 6;

impl Draft {
    /// What a weaver would ask of a draft: threads, loom, repeat, colours, measures, floats; and one
    /// repeat of its weave, drawn, if it is small.
    pub fn summary(&self) -> String {
        let weave = self.drawdown();
        let mut text = String::new();
        let mut say = |what: &str, how: &dyn Display| {
            let _ = writeln!(text, "{what:8} {how}");
        };
        let title = if self.title().is_empty() {
            "(without a title)"
        } else {
            self.title()
        };
        say("title", &title);
        if !self.author().is_empty() {
            say("author", &self.author());
        }
        let (ends, picks) = (weave.ends(), weave.picks());
        say(
            "threads",
            &format!("{}, {}", count(ends, "end"), count(picks, "pick")),
        );
        say("loom", &self.loom());
        let of_weave = repeat(&weave);
        let of_all = self.repeat();
        let mut repeats = format!("{} × {}", of_weave.0, of_weave.1);
        if of_all != of_weave {
            let _ = write!(
                repeats,
                "; with colours and measures {} × {}",
                of_all.0, of_all.1
            );
        }
        say("repeat", &repeats);
        say("warp", &looks(self.warp()));
        say("weft", &looks(self.weft()));
        let [warp, weft] = floats(&weave);
        say(
            "floats",
            &format!(
                "{}; {}",
                told(warp, "end", "pick"),
                told(weft, "pick", "end")
            ),
        );
        if of_weave.0 <= DRAWN.0 && of_weave.1 <= DRAWN.1 {
            text.push_str(&drawing(&weave, of_weave));
        }
        text
    }

    fn loom(&self) -> String {
        let shed = match self.shed() {
            Shed::Rising => "rising",
            Shed::Sinking => "sinking",
        };
        let by = match self.lifting() {
            Lifting::Liftplan(_) => "liftplan".into(),
            Lifting::Treadles { tieup, .. } => count(tieup.len(), "treadle"),
        };
        format!("{}, {by}, {shed} shed", count(self.shafts(), "shaft"))
    }
}

fn count(n: usize, what: &str) -> String {
    let s = if n == 1 { "" } else { "s" };
    format!("{n} {what}{s}")
}

fn told(floats: Floats, thread: &str, crossed: &str) -> String {
    if floats.longest == 0 {
        return format!("no {thread} bound in at all");
    }
    let mut text = format!("{thread}s over at most {}", count(floats.longest, crossed));
    if floats.unbound > 0 {
        let _ = write!(
            text,
            " ({} not bound in at all)",
            count(floats.unbound, thread)
        );
    }
    text
}

/// Colours from the most common, and measures.
fn looks(threads: &[Thread]) -> String {
    let mut counts: HashMap<Option<[u8; 3]>, usize> = HashMap::new();
    for thread in threads {
        *counts.entry(thread.colour).or_default() += 1;
    }
    let mut colours: Vec<_> = counts.into_iter().collect();
    colours.sort_by_key(|(colour, n)| (std::cmp::Reverse(*n), *colour));
    let name = |(colour, n): &(Option<[u8; 3]>, usize)| match colour {
        Some([r, g, b]) => format!("{n} of #{r:02x}{g:02x}{b:02x}"),
        None => format!("{n} of no colour"),
    };
    let mut words: Vec<String> = colours.iter().take(COLOURS).map(name).collect();
    if colours.len() > COLOURS {
        words.push("and others".into());
    }
    for (what, of) in [
        (
            "apart",
            (|thread| thread.spacing_mm) as fn(&Thread) -> Option<f64>,
        ),
        ("thick", |thread| thread.thickness_mm),
    ] {
        if let Some(mm) = measure(threads, of) {
            words.push(format!("{mm} mm {what}"));
        }
    }
    words.join(", ")
}

/// The least and the most of a measure; none if no thread has it.
fn measure(threads: &[Thread], of: fn(&Thread) -> Option<f64>) -> Option<String> {
    let values = threads.iter().filter_map(of);
    let range = values.fold(None, |range, mm| {
        let (least, most) = range.unwrap_or((mm, mm));
        Some((mm.min(least), mm.max(most)))
    });
    let short = |mm: f64| (mm * 1000.0).round() / 1000.0;
    range.map(|(least, most): (f64, f64)| {
        if least == most {
            short(most).to_string()
        } else {
            format!("{} to {}", short(least), short(most))
        }
    })
}

/// One repeat, as a scenario's `Matrix` has it.
fn drawing(weave: &WeaveMatrix, (ends, picks): (usize, usize)) -> String {
    let mut text = "\nX where the warp is on top:\n".to_owned();
    for p in 0..picks {
        let up = |e| if weave.warp_up(e, p) { 'X' } else { '.' };
        text.extend(std::iter::once(' ').chain((0..ends).map(up)));
        text.push('\n');
    }
    text
}
