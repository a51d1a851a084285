//! What the sections of a WIF mean together.

use super::counts::{Lists, declared, numbered, shafts};
use super::looks::{Palette, WARP, WEFT, threads};
use super::text::{Sections, decode, known, split};
use super::values;
use crate::draft::error::Remarks;
use crate::draft::{Draft, DraftError, Lifting, Reading, Shed};

/// Reads a draft from the bytes of a WIF. `name` stands in messages: the path, say.
///
/// # Errors
/// [`DraftError::Refused`] with the line, where what it says cannot be woven.
pub fn read(name: &str, bytes: &[u8]) -> Result<Reading, DraftError> {
    let text = decode(bytes);
    let mut remarks = Remarks::about(name);
    let sections = split(&text, &mut remarks)?;
    note_contents(&sections, &mut remarks);
    let mut draft = weave(&sections, &mut remarks)?;
    let [title, author] = ["Title", "Author"].map(|key| sections.find("TEXT", key));
    if let Some(title) = title {
        draft = draft.with_title(title.value);
    }
    if let Some(author) = author {
        draft = draft.with_author(author.value);
    }
    let draft = draft.with_notes(notes(&sections));
    Ok(Reading {
        draft,
        warnings: remarks.into_list(),
    })
}

/// Threading and lifting, and the threads.
fn weave(sections: &Sections, remarks: &mut Remarks) -> Result<Draft, DraftError> {
    let shafts_said = declared(sections, "WEAVING", "Shafts", remarks)?;
    let treadles_said = declared(sections, "WEAVING", "Treadles", remarks)?;
    let mut lists = |section, names, most| Lists::read(sections, section, names, most, remarks);
    let threading = lists("THREADING", ("ends", "shaft"), shafts_said.as_ref())?;
    let tieup = lists("TIEUP", ("treadles", "shaft"), shafts_said.as_ref())?;
    let treadling = lists("TREADLING", ("picks", "treadle"), treadles_said.as_ref())?;
    let liftplan = lists("LIFTPLAN", ("picks", "shaft"), shafts_said.as_ref())?;
    if threading.is_empty() {
        let what = "there is no [THREADING], which says what shaft each end is on";
        return Err(remarks.refuse_whole(what));
    }
    let (by_liftplan, by_treadles) = (
        !liftplan.is_empty(),
        !tieup.is_empty() && !treadling.is_empty(),
    );
    if !by_liftplan && !by_treadles {
        return Err(remarks.refuse_whole(nothing_lifts(&tieup, &treadling)));
    }
    // A liftplan that lifts nothing is a section that some program left blank.
    let lifts = by_treadles && tieup.name_any() && treadling.name_any();
    let by_liftplan = by_liftplan && (liftplan.name_any() || !lifts);

    let ends_said = declared(sections, WARP.all, "Threads", remarks)?;
    let picks_said = declared(sections, WEFT.all, "Threads", remarks)?;
    let ends = threading.threads((WARP.all, WARP.many), ends_said.as_ref(), remarks)?;
    let plan = if by_liftplan { &liftplan } else { &treadling };
    let picks = plan.threads((WEFT.all, WEFT.many), picks_said.as_ref(), remarks)?;
    if let Some(which) = threading.missing(ends) {
        remarks.note_whole(format!(
            "[THREADING] leaves out ends {which}; they are on no shaft"
        ));
    }
    if let Some(which) = plan.missing(picks) {
        let section = if by_liftplan { "LIFTPLAN" } else { "TREADLING" };
        remarks.note_whole(format!(
            "[{section}] leaves out picks {which}; they lift nothing"
        ));
    }

    let palette = Palette::read(sections, remarks);
    let mut draft = Draft {
        title: String::new(),
        author: String::new(),
        notes: Vec::new(),
        warp: threads(sections, WARP, ends, &palette, remarks)?,
        weft: threads(sections, WEFT, picks, &palette, remarks)?,
        shafts: shafts(
            shafts_said.as_ref(),
            [&threading, &tieup, &liftplan],
            remarks,
        ),
        threading: threading.rows(ends),
        lifting: Lifting::Liftplan(liftplan.rows(picks)),
        shed: shed(sections, remarks)?,
    };
    // A file counts its ends from the right.
    draft.warp.reverse();
    draft.threading.reverse();
    if by_treadles {
        let said = treadles_said.map_or(0, |said| said.count);
        let tied = said.max(tieup.last());
        let pressed = treadling.largest();
        if let Some((treadle, entry)) = pressed.filter(|(treadle, _)| *treadle > tied) {
            remarks.note("untied", entry.place(), || {
                format!("treadle {treadle} is tied to nothing and lifts nothing")
            });
        }
        let treadles = tied.max(pressed.map_or(0, |(treadle, _)| treadle));
        let lifting = Lifting::Treadles {
            tieup: tieup.rows(treadles),
            treadling: treadling.rows(picks),
        };
        if by_liftplan {
            note_both(&draft, lifting, remarks);
        } else {
            draft.lifting = lifting;
        }
    }
    Ok(draft)
}

/// Why there is nothing to weave by.
fn nothing_lifts(tieup: &Lists, treadling: &Lists) -> &'static str {
    match (tieup.is_empty(), treadling.is_empty()) {
        (true, false) => {
            "there is a [TREADLING] but no [TIEUP], which says what shafts each treadle lifts, nor a \
             [LIFTPLAN]"
        }
        (false, true) => {
            "there is a [TIEUP] but no [TREADLING], which says what treadles each pick presses, nor a \
             [LIFTPLAN]"
        }
        _ => {
            "nothing says what each pick lifts: a [LIFTPLAN] is needed, or a [TIEUP] and a [TREADLING]"
        }
    }
}

fn note_both(by_liftplan: &Draft, treadles: Lifting, remarks: &mut Remarks) {
    let mut by_treadles = by_liftplan.clone();
    by_treadles.lifting = treadles;
    let same = by_treadles.drawdown() == by_liftplan.drawdown();
    remarks.note_whole(format!(
        "there are a [LIFTPLAN] and a [TIEUP] with [TREADLING]; the [LIFTPLAN] is used{}",
        if same {
            ", and both weave the same"
        } else {
            ", and the other would weave something else"
        }
    ));
}

fn shed(sections: &Sections, remarks: &Remarks) -> Result<Shed, DraftError> {
    let Some(entry) = sections.find("WEAVING", "Rising Shed") else {
        return Ok(Shed::Rising);
    };
    match values::boolean(entry.value) {
        Some(true) => Ok(Shed::Rising),
        Some(false) => Ok(Shed::Sinking),
        None => Err(remarks.refuse(entry.place(), "true or false is needed")),
    }
}

/// The notes in the order of their numbers; what has no number comes last.
fn notes<'t>(sections: &Sections<'t>) -> Vec<&'t str> {
    let mut lines: Vec<_> = sections
        .lines("NOTES")
        .iter()
        .map(|entry| (values::whole(entry.key).unwrap_or(u64::MAX), entry.value))
        .collect();
    lines.sort_by_key(|(number, _)| *number);
    lines.into_iter().map(|(_, note)| note).collect()
}

/// Tells where `[CONTENTS]` is wrong. What is there counts.
fn note_contents(sections: &Sections, remarks: &mut Remarks) {
    for entry in sections.lines("CONTENTS") {
        let (Some(section), Some(said)) = (known(entry.key), values::boolean(entry.value)) else {
            continue;
        };
        match (said, sections.has(section)) {
            (true, false) => remarks.note("absent", entry.place(), || {
                "there is no such section".into()
            }),
            (false, true) if !numbered(sections, section, &mut Remarks::about("")).is_empty() => {
                remarks.note("present", entry.place(), || {
                    "there is such a section, and it counts".into()
                });
            }
            _ => {}
        }
    }
}
