//! Checking values: what is allowed, and the field path of what is not.

use std::fmt::Display;
use std::ops::RangeInclusive;

use thiserror::Error;

/// Something a scenario says that cannot be.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("`{path}`: {what}")]
pub struct Problem {
    /// The field path, such as `cloth.warp.porosity` or `supply[0].dose`.
    pub path: String,
    /// What is wrong and what is allowed.
    pub what: String,
}

/// A place in a scenario whose value is being checked.
#[derive(Debug, Clone, Default)]
pub struct Checker {
    path: String,
}

impl Checker {
    /// The scenario as a whole.
    pub fn root() -> Self {
        Checker::default()
    }

    /// A named field (or enum variant) of this place.
    pub fn field(&self, name: &str) -> Checker {
        let dot = if self.path.is_empty() { "" } else { "." };
        Checker {
            path: format!("{}{dot}{name}", self.path),
        }
    }

    /// Element `i` of this list.
    pub fn item(&self, i: usize) -> Checker {
        Checker {
            path: format!("{}[{i}]", self.path),
        }
    }

    /// The field path of this place.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// A problem at this place.
    pub fn problem(&self, what: String) -> Problem {
        Problem {
            path: self.path.clone(),
            what,
        }
    }

    /// Demands that `value` lies in `range`, both ends included. NaN never does.
    ///
    /// # Errors
    /// A [`Problem`] with the value and the range.
    pub fn within<T: PartialOrd + Display>(
        &self,
        value: T,
        range: RangeInclusive<T>,
    ) -> Result<(), Problem> {
        if range.contains(&value) {
            return Ok(());
        }
        let (least, most) = (range.start(), range.end());
        Err(self.problem(format!("{least} to {most} is allowed, but this is {value}")))
    }

    /// Demands a colour as (hue in degrees, saturation 0 to 1, value 0 to 1).
    ///
    /// # Errors
    /// A [`Problem`] with the value and its range.
    pub fn hsv(&self, (hue, saturation, value): (f64, f64, f64)) -> Result<(), Problem> {
        self.item(0).within(hue, 0.0..=360.0)?;
        self.item(1).within(saturation, 0.0..=1.0)?;
        self.item(2).within(value, 0.0..=1.0)
    }

    /// Demands that a pair is a range (least, most) within `range`.
    ///
    /// # Errors
    /// A [`Problem`] with the values and the range.
    pub fn range(
        &self,
        (least, most): (f64, f64),
        range: RangeInclusive<f64>,
    ) -> Result<(), Problem> {
        self.item(0).within(least, range.clone())?;
        self.item(1).within(most, range)?;
        if least <= most {
            return Ok(());
        }
        Err(self.problem(format!(
            "the least comes first, but {least} is more than {most}"
        )))
    }
}
