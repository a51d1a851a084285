//! Lengths and times in their units, at the right of a row.

use bevy_egui::egui::Ui;

use super::row::{Pass, Row, VALUE};
use crate::scenario::{Length, Time, units};

impl Pass<'_> {
    /// A length with its unit, between so many cells.
    pub fn length(&mut self, ui: &mut Ui, row: &Row, length: &mut Length, least: f64, most: f64) {
        let mm = self.cell_mm;
        self.row(ui, row, |p, ui| {
            let ends = length_ends(*length, mm, least, most);
            let value = in_unit(*length);
            if let Some(new) = p.drag(ui, row, value, ends, VALUE - 60.0, false) {
                *length = with_value(*length, new);
            }
            let unit = length_unit(*length);
            if let Some(unit) = p.pick(ui, row.name, unit, &["cells", "mm", "cm"], 56.0) {
                // What rounding moves over an end is moved back.
                *length = mended_length(convert_length(*length, unit, mm), mm, least, most);
                p.change(row.name);
            }
        });
    }

    /// A time with its unit, between so many steps.
    pub fn time(&mut self, ui: &mut Ui, row: &Row, time: &mut Time, least: u64, most: u64) {
        self.row(ui, row, |p, ui| p.time_value(ui, row, time, least, most));
    }

    pub fn time_value(&mut self, ui: &mut Ui, row: &Row, time: &mut Time, least: u64, most: u64) {
        let step_h = self.step_h;
        let per = hours_per(*time).map_or(1.0, |hours| step_h / hours);
        let ends = (least as f64 * per, most as f64 * per);
        let whole = matches!(time, Time::Steps(_));
        let value = match *time {
            Time::Steps(steps) => steps as f64,
            Time::Minutes(t) | Time::Hours(t) | Time::Days(t) => t,
        };
        if let Some(new) = self.drag(ui, row, value, ends, VALUE - 60.0, whole) {
            *time = match *time {
                Time::Steps(_) => Time::Steps(new as u64),
                Time::Minutes(_) => Time::Minutes(new),
                Time::Hours(_) => Time::Hours(new),
                Time::Days(_) => Time::Days(new),
            };
        }
        let unit = match time {
            Time::Steps(_) => 0,
            Time::Minutes(_) => 1,
            Time::Hours(_) => 2,
            Time::Days(_) => 3,
        };
        let units = ["steps", "min", "h", "days"];
        if let Some(unit) = self.pick(ui, row.name, unit, &units, 56.0) {
            *time = convert_time(*time, unit, step_h);
            self.change(row.name);
        }
    }
}

fn length_unit(length: Length) -> usize {
    match length {
        Length::Cells(_) => 0,
        Length::Mm(_) => 1,
        Length::Cm(_) => 2,
    }
}

fn in_unit(length: Length) -> f64 {
    match length {
        Length::Cells(n) | Length::Mm(n) | Length::Cm(n) => n,
    }
}

fn with_value(length: Length, value: f64) -> Length {
    match length {
        Length::Cells(_) => Length::Cells(value),
        Length::Mm(_) => Length::Mm(value),
        Length::Cm(_) => Length::Cm(value),
    }
}

/// The ends of a length in its own unit, as near as its cells allow.
fn length_ends(length: Length, cell_mm: f64, least: f64, most: f64) -> (f64, f64) {
    let per = match length {
        Length::Cells(_) => 1.0,
        Length::Mm(_) => cell_mm,
        Length::Cm(_) => cell_mm / 10.0,
    };
    let (mut low, mut high) = (least * per, most * per);
    let cells = |value| with_value(length, value).cells(cell_mm);
    while cells(low) < least {
        low = low.next_up();
    }
    while cells(high) > most {
        high = high.next_down();
    }
    (low, high)
}

/// The same length in another unit: 0 cells, 1 mm, 2 cm.
pub(super) fn convert_length(length: Length, unit: usize, cell_mm: f64) -> Length {
    let cells = length.cells(cell_mm);
    // So that 0.05 · 3 is 0.15.
    let tidy = |value: f64| units::rounded(value, 12);
    match unit {
        0 => Length::Cells(tidy(cells)),
        1 => Length::Mm(tidy(cells * cell_mm)),
        _ => Length::Cm(tidy(cells * cell_mm / 10.0)),
    }
}

/// A length moved between so many cells.
pub(super) fn mended_length(length: Length, cell_mm: f64, least: f64, most: f64) -> Length {
    if (least..=most).contains(&length.cells(cell_mm)) {
        return length;
    }
    let (low, high) = length_ends(length, cell_mm, least, most);
    with_value(length, in_unit(length).clamp(low, high))
}

fn hours_per(time: Time) -> Option<f64> {
    match time {
        Time::Steps(_) => None,
        Time::Minutes(_) => Some(1.0 / 60.0),
        Time::Hours(_) => Some(1.0),
        Time::Days(_) => Some(24.0),
    }
}

/// The same time in another unit: 0 steps, 1 minutes, 2 hours, 3 days.
pub(super) fn convert_time(time: Time, unit: usize, step_h: f64) -> Time {
    let hours = match time {
        Time::Steps(steps) => steps as f64 * step_h,
        Time::Minutes(t) => t / 60.0,
        Time::Hours(t) => t,
        Time::Days(t) => t * 24.0,
    };
    let tidy = |value: f64| units::rounded(value, 15);
    match unit {
        0 => Time::Steps(time.steps(step_h)),
        1 => Time::Minutes(tidy(hours * 60.0)),
        2 => Time::Hours(tidy(hours)),
        _ => Time::Days(tidy(hours / 24.0)),
    }
}
