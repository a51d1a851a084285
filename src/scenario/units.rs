//! Lengths and times as people say them, and what they are on the grid and the clock.

use serde::{Deserialize, Serialize};

use super::check::{Checker, Problem};

/// A length along the cloth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Length {
    /// Diffusion cells: what the papers call pixels.
    Cells(f64),
    /// Millimetres.
    Mm(f64),
    /// Centimetres.
    Cm(f64),
}

impl Length {
    /// The length in cells of `cell_mm` millimetres.
    pub fn cells(self, cell_mm: f64) -> f64 {
        match self {
            Length::Cells(cells) => cells,
            Length::Mm(mm) => mm / cell_mm,
            Length::Cm(cm) => 10.0 * cm / cell_mm,
        }
    }

    /// The nearest whole number of cells.
    pub fn whole_cells(self, cell_mm: f64) -> usize {
        self.cells(cell_mm).round().max(0.0) as usize
    }

    /// Demands that the length lies between `least` and `most` cells.
    ///
    /// # Errors
    /// A [`Problem`] that names the allowed range in the same unit.
    pub fn check(self, at: &Checker, cell_mm: f64, least: f64, most: f64) -> Result<(), Problem> {
        let cells = self.cells(cell_mm);
        if (least..=most).contains(&cells) {
            return Ok(());
        }
        let (given, unit, per_cell) = match self {
            Length::Cells(n) => (n, "cells", 1.0),
            Length::Mm(n) => (n, "mm", cell_mm),
            Length::Cm(n) => (n, "cm", cell_mm / 10.0),
        };
        Err(at.problem(format!(
            "{} to {} {unit} is allowed, but this is {given} {unit}",
            rounded(least * per_cell, 9),
            rounded(most * per_cell, 9)
        )))
    }
}

/// A number rounded to a few significant digits, so that 0.05 · 3 prints as 0.15.
pub(crate) fn rounded(x: f64, digits: usize) -> f64 {
    let places = digits.saturating_sub(1);
    format!("{x:.places$e}").parse().unwrap_or(x)
}

/// A moment or a span of process time.
///
/// A *step* always means the Δt of the scenario (0.0005 h in paper D), whatever the solver does.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Time {
    /// Steps of Δt.
    Steps(u64),
    /// Minutes of dyeing.
    Minutes(f64),
    /// Hours of dyeing.
    Hours(f64),
    /// Days of dyeing.
    Days(f64),
}

/// The longest process, in steps: its hours are still counted exactly in a 64-bit float.
pub const MOST_STEPS: u64 = 1 << 50;

impl Time {
    /// The time in whole steps of `step_h` hours.
    pub fn steps(self, step_h: f64) -> u64 {
        let hours = match self {
            Time::Steps(steps) => return steps,
            Time::Minutes(minutes) => minutes / 60.0,
            Time::Hours(hours) => hours,
            Time::Days(days) => days * 24.0,
        };
        (hours / step_h).round().max(0.0) as u64
    }

    /// Demands a time between nothing and the longest process.
    ///
    /// # Errors
    /// A [`Problem`] that names the allowed range.
    pub fn check(self, at: &Checker, step_h: f64) -> Result<(), Problem> {
        let given = match self {
            Time::Steps(_) => 0.0,
            Time::Minutes(t) | Time::Hours(t) | Time::Days(t) => t,
        };
        if given.is_finite() && given >= 0.0 && self.steps(step_h) <= MOST_STEPS {
            return Ok(());
        }
        Err(at.problem(format!(
            "0 to {MOST_STEPS} steps is allowed, but this is {self:?}"
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_is_the_same_in_every_unit() {
        for time in [
            Time::Hours(200.0),
            Time::Minutes(12_000.0),
            Time::Days(200.0 / 24.0),
            Time::Steps(400_000),
        ] {
            assert_eq!(time.steps(0.0005), 400_000);
        }
    }

    #[test]
    fn a_length_is_the_same_in_every_unit() {
        for length in [Length::Cells(8.0), Length::Mm(0.4), Length::Cm(0.04)] {
            assert_eq!(length.whole_cells(0.05), 8);
        }
    }

    #[test]
    fn a_length_out_of_range_names_the_range_in_its_own_unit() {
        let at = Checker::root().field("width");
        let problem = Length::Mm(0.01).check(&at, 0.05, 1.0, 3.0).unwrap_err();
        assert_eq!(
            problem.to_string(),
            "`width`: 0.05 to 0.15 mm is allowed, but this is 0.01 mm"
        );
    }
}
