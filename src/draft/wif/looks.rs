//! How the threads of a WIF look: their colours and measures.
//!
//! Spacing is the room that a thread takes up: programs write the reciprocal of the sett, and the
//! same number as the thickness where threads lie close.

use std::collections::HashMap;

use super::counts::numbered;
use super::text::{Entry, Sections};
use super::values::{self, Range, Unit};
use crate::draft::error::Remarks;
use crate::draft::{DraftError, Thread, WIDEST_MM};

/// What stands for a colour that cannot be found.
const WHITE: [u8; 3] = [255; 3];

/// The colours that a file gives numbers to.
#[derive(Debug)]
pub struct Palette {
    range: Range,
    /// None without a colour table.
    table: Option<HashMap<u64, [u8; 3]>>,
}

impl Palette {
    /// Reads `[COLOR PALETTE]` and `[COLOR TABLE]`.
    pub fn read(sections: &Sections, remarks: &mut Remarks) -> Self {
        let lines = numbered(sections, "COLOR TABLE", remarks);
        let triple = |entry: &Entry| <[f64; 3]>::try_from(values::numbers(entry.value)?).ok();
        let largest = lines.values().filter_map(triple).flatten();
        let guess = Range::guessed(largest.fold(0.0, f64::max));
        let range = match sections.find("COLOR PALETTE", "Range") {
            Some(entry) => Range::named(entry.value).unwrap_or_else(|| {
                remarks.note("range", entry.place(), || {
                    format!(
                        "a range is two numbers such as 0,255; 0,{} is assumed",
                        guess.most
                    )
                });
                guess
            }),
            None => {
                if let Some(entry) = lines.values().next().filter(|_| guess != Range::BYTES) {
                    remarks.note("range", entry.place(), || {
                        let most = guess.most;
                        format!("[COLOR PALETTE] gives no Range; 0,{most} is assumed")
                    });
                }
                guess
            }
        };
        let mut palette = Palette {
            range,
            table: sections.has("COLOR TABLE").then(HashMap::new),
        };
        if let Some(mut table) = palette.table.take() {
            for (number, entry) in &lines {
                let colour = match triple(entry) {
                    Some(values) => palette.mixed(values, entry, remarks),
                    None => {
                        remarks.note("colour", entry.place(), || {
                            "a colour is three numbers such as 255,128,0; it is read as white"
                                .into()
                        });
                        WHITE
                    }
                };
                table.insert(*number, colour);
            }
            palette.table = Some(table);
        }
        palette
    }

    /// A colour of three values.
    fn mixed(&self, values: [f64; 3], entry: &Entry, remarks: &mut Remarks) -> [u8; 3] {
        let (colour, inside) = self.range.bytes(values);
        if !inside {
            remarks.note("outside", entry.place(), || {
                let Range { least, most } = self.range;
                format!("colour values go from {least} to {most} here; the nearest is taken")
            });
        }
        colour
    }

    /// The colour that a line of `[WARP COLORS]` and the like means: by number, by number with its
    /// values repeated, or by values alone. None where it is number 0 and there is no table.
    ///
    /// # Errors
    /// The colour is named by number, and there is no table.
    fn meant(&self, entry: &Entry, remarks: &mut Remarks) -> Result<Option<[u8; 3]>, DraftError> {
        let Some(numbers) = values::numbers(entry.value) else {
            remarks.note("colour", entry.place(), || {
                "a colour is the number of a line of [COLOR TABLE]; it is read as white".into()
            });
            return Ok(Some(WHITE));
        };
        if let [r, g, b] = numbers[..] {
            return Ok(Some(self.mixed([r, g, b], entry, remarks)));
        }
        let number = entry.value.split(',').next().unwrap_or("").trim();
        let number = values::whole(number);
        let found = self.table.as_ref().zip(number);
        if let Some(colour) = found.and_then(|(table, number)| table.get(&number)) {
            return Ok(Some(*colour));
        }
        if let [_, r, g, b, ..] = numbers[..] {
            return Ok(Some(self.mixed([r, g, b], entry, remarks)));
        }
        if self.table.is_none() {
            if number == Some(0) {
                return Ok(None);
            }
            let what = "there is no [COLOR TABLE], which says what colour that is";
            return Err(remarks.refuse(entry.place(), what));
        }
        remarks.note("unknown", entry.place(), || {
            "[COLOR TABLE] has no such colour; it is read as white".into()
        });
        Ok(Some(WHITE))
    }
}

/// The names of the sections about one direction.
#[derive(Debug, Clone, Copy)]
pub struct Names {
    /// About all threads.
    pub all: &'static str,
    colours: &'static str,
    spacing: &'static str,
    thickness: &'static str,
    /// What the threads are called.
    pub many: &'static str,
}

/// About the warp.
pub const WARP: Names = Names {
    all: "WARP",
    colours: "WARP COLORS",
    spacing: "WARP SPACING",
    thickness: "WARP THICKNESS",
    many: "ends",
};

/// About the weft.
pub const WEFT: Names = Names {
    all: "WEFT",
    colours: "WEFT COLORS",
    spacing: "WEFT SPACING",
    thickness: "WEFT THICKNESS",
    many: "picks",
};

/// The looks of the threads of one direction, in the order of their numbers.
///
/// # Errors
/// A colour is named by number, and there is no table of colours.
pub fn threads(
    sections: &Sections,
    names: Names,
    count: usize,
    palette: &Palette,
    remarks: &mut Remarks,
) -> Result<Vec<Thread>, DraftError> {
    let colours = of_single(sections, names.colours, names, count, remarks);
    let every = match sections.find(names.all, "Color") {
        Some(entry) if colours.len() < count => palette.meant(entry, remarks)?,
        _ => None,
    };
    let mut threads = vec![
        Thread {
            colour: every,
            ..Thread::default()
        };
        count
    ];
    for (i, entry) in &colours {
        threads[*i].colour = palette.meant(entry, remarks)?;
    }

    let spacing = of_single(sections, names.spacing, names, count, remarks);
    let thickness = of_single(sections, names.thickness, names, count, remarks);
    let every = ["Spacing", "Thickness"].map(|key| sections.find(names.all, key));
    let any = every.iter().flatten().count() + spacing.len() + thickness.len() > 0;
    let unit = if any {
        unit(sections, names, remarks)
    } else {
        0.0
    };
    let [every_spacing, every_thickness] =
        every.map(|entry| entry.and_then(|entry| measure(entry, unit, remarks)));
    for thread in &mut threads {
        thread.spacing_mm = every_spacing;
        thread.thickness_mm = every_thickness;
    }
    for (i, entry) in &spacing {
        threads[*i].spacing_mm = measure(entry, unit, remarks);
    }
    for (i, entry) in &thickness {
        threads[*i].thickness_mm = measure(entry, unit, remarks);
    }
    Ok(threads.into_iter().map(Thread::tidy).collect())
}

/// The lines about single threads, with the index of each thread.
fn of_single<'t>(
    sections: &Sections<'t>,
    section: &str,
    names: Names,
    count: usize,
    remarks: &mut Remarks,
) -> Vec<(usize, Entry<'t>)> {
    let mut lines = Vec::new();
    for (number, entry) in numbered(sections, section, remarks) {
        if number <= count as u64 {
            lines.push((number as usize - 1, entry));
        } else {
            let many = names.many;
            remarks.note("beyond", entry.place(), || {
                format!("there are only {count} {many}; the line is passed over")
            });
        }
    }
    lines
}

/// The unit of the measures of one direction, mm. Where it is left out, that of the other direction;
/// where both are, centimetres, which most programs write.
fn unit(sections: &Sections, names: Names, remarks: &mut Remarks) -> f64 {
    const CENTIMETRES: f64 = 10.0;
    let all = names.all;
    if let Some(entry) = sections.find(all, "Units") {
        return match Unit::named(entry.value) {
            Unit::Known(mm) => mm,
            Unit::Like(mm, name) => {
                remarks.note("unit", entry.place(), || format!("it is read as {name}"));
                mm
            }
            Unit::Unknown => {
                remarks.note("unit", entry.place(), || {
                    "units are decipoints, inches or centimeters; it is read as centimeters".into()
                });
                CENTIMETRES
            }
        };
    }
    let other = if all == WARP.all { WEFT.all } else { WARP.all };
    if let Some(entry) = sections.find(other, "Units")
        && let Unit::Known(mm) | Unit::Like(mm, _) = Unit::named(entry.value)
    {
        remarks.note_whole(format!(
            "[{all}] has measures but no Units; those of [{other}] are assumed"
        ));
        return mm;
    }
    remarks.note_whole(format!(
        "[{all}] has measures but no Units; centimeters are assumed"
    ));
    CENTIMETRES
}

/// A spacing or thickness, mm; none where it is 0 or cannot be.
fn measure(entry: &Entry, unit: f64, remarks: &mut Remarks) -> Option<f64> {
    match values::real(entry.value).map(|value| value * unit) {
        Some(0.0) => None,
        Some(mm) if mm > 0.0 && mm <= WIDEST_MM => Some(mm),
        _ => {
            remarks.note("measure", entry.place(), || {
                format!("a measure is a number over 0, up to {WIDEST_MM} mm; it is left out")
            });
            None
        }
    }
}
