//! The values of a WIF: whole numbers and lists of them, measures, yes and no, units, colours.

use crate::draft::MOST_THREADS;

/// A whole number of 0 or more. One too large to hold is as large as can be.
pub fn whole(text: &str) -> Option<u64> {
    let digits = !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    digits.then(|| text.parse().unwrap_or(u64::MAX))
}

/// Why a list of shafts or treadles cannot be understood.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum BadList<'t> {
    /// This is no whole number.
    NotANumber(&'t str),
    /// This is more than there can be.
    TooLarge(&'t str),
}

/// A list of shafts or treadles, as in `1,3,4`: sorted, without zeros, which mean none.
pub fn list(text: &str) -> Result<Vec<u16>, BadList<'_>> {
    let mut numbers = Vec::new();
    for word in text.split(|c: char| c == ',' || c.is_whitespace()) {
        if word.is_empty() {
            continue;
        }
        match whole(word) {
            None => return Err(BadList::NotANumber(word)),
            Some(0) => {}
            Some(number) if number <= MOST_THREADS as u64 => numbers.push(number as u16),
            Some(_) => return Err(BadList::TooLarge(word)),
        }
    }
    numbers.sort_unstable();
    numbers.dedup();
    Ok(numbers)
}

/// A decimal number, with a point or a comma.
pub fn real(text: &str) -> Option<f64> {
    let number: f64 = match text.split_once(',') {
        Some((whole, rest)) if !text.contains('.') => format!("{whole}.{rest}").parse().ok()?,
        _ => text.parse().ok()?,
    };
    number.is_finite().then_some(number)
}

/// Yes or no, as WIF has it (`true`, `on`, `yes`, `1`) and as people shorten it.
pub fn boolean(text: &str) -> Option<bool> {
    match text.to_ascii_lowercase().as_str() {
        "true" | "on" | "yes" | "1" | "t" | "y" => Some(true),
        "false" | "off" | "no" | "0" | "f" | "n" => Some(false),
        _ => None,
    }
}

/// A unit of length by its first letters, in mm. WIF has decipoints (720 to the inch), inches and
/// centimetres; millimetres and points are what else might be meant.
fn unit(text: &str) -> Option<f64> {
    const INCH: f64 = 25.4;
    let text = text.to_ascii_lowercase();
    let begins = |with: &[&str]| with.iter().any(|with| text.starts_with(with));
    if text == "cm" || begins(&["cent"]) {
        Some(10.0)
    } else if text == "mm" || begins(&["milli"]) {
        Some(1.0)
    } else if text == "in" || text == "\"" || begins(&["inch"]) {
        Some(INCH)
    } else if text == "dp" || begins(&["decip"]) {
        Some(INCH / 720.0)
    } else if text == "pt" || begins(&["point"]) {
        Some(INCH / 72.0)
    } else {
        None
    }
}

/// What a unit of length was understood as.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unit {
    /// This many mm, without doubt.
    Known(f64),
    /// This many mm, by its likeness to the name given here.
    Like(f64, &'static str),
    /// Unlike any.
    Unknown,
}

impl Unit {
    /// Understands the name of a unit, even one that is misspelt.
    pub fn named(text: &str) -> Self {
        if let Some(mm) = unit(text) {
            return Unit::Known(mm);
        }
        let likeness = |name: &str| strsim::jaro_winkler(&text.to_ascii_lowercase(), name);
        let most_like = ["centimeters", "inches", "decipoints"]
            .into_iter()
            .max_by(|a, b| likeness(a).total_cmp(&likeness(b)))
            .filter(|name| likeness(name) > 0.75);
        match most_like.and_then(|name| Some((unit(name)?, name))) {
            Some((mm, name)) => Unit::Like(mm, name),
            None => Unit::Unknown,
        }
    }
}

/// The range of colour values in a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// The value of no light.
    pub least: f64,
    /// The value of full light.
    pub most: f64,
}

impl Range {
    /// 0 to 255.
    pub const BYTES: Range = Range {
        least: 0.0,
        most: 255.0,
    };

    /// Understands `0,999`, or `999` alone.
    pub fn named(text: &str) -> Option<Self> {
        let ends: Vec<f64> = numbers(text)?;
        let (least, most) = match ends[..] {
            [most] => (0.0, most),
            [least, most] => (least, most),
            _ => return None,
        };
        (least < most && (most - least).is_finite()).then_some(Range { least, most })
    }

    /// The range that most likely was meant where none is given.
    pub fn guessed(largest: f64) -> Self {
        let most = if largest <= 255.0 {
            255.0
        } else if largest <= 999.0 {
            999.0
        } else {
            65535.0
        };
        Range { least: 0.0, most }
    }

    /// A colour as bytes, and whether its values lay in the range.
    pub fn bytes(&self, values: [f64; 3]) -> ([u8; 3], bool) {
        let share = |value: f64| (value - self.least) / (self.most - self.least);
        let inside = values.iter().all(|v| (0.0..=1.0).contains(&share(*v)));
        let byte = |value: f64| (share(value).clamp(0.0, 1.0) * 255.0).round() as u8;
        (values.map(byte), inside)
    }
}

/// Numbers between commas.
pub fn numbers(text: &str) -> Option<Vec<f64>> {
    let number = |word: &str| word.trim().parse().ok().filter(|n: &f64| n.is_finite());
    text.split(',').map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_is_sorted_and_knows_none() {
        assert_eq!(list("4, 1,3,1"), Ok(vec![1, 3, 4]));
        for none in ["", "0", ",", "0,0"] {
            assert_eq!(list(none), Ok(vec![]), "{none}");
        }
        assert_eq!(list("0,3,4"), Ok(vec![3, 4]));
        assert_eq!(list("1,x"), Err(BadList::NotANumber("x")));
        assert_eq!(list("1,-2"), Err(BadList::NotANumber("-2")));
        assert_eq!(list("4097"), Err(BadList::TooLarge("4097")));
        let huge = "9".repeat(40);
        assert_eq!(list(&huge), Err(BadList::TooLarge(&huge)));
    }

    #[test]
    fn a_measure_has_a_point_or_a_comma() {
        assert_eq!(real("0.212"), Some(0.212));
        assert_eq!(real("0,212"), Some(0.212));
        assert_eq!(real("2"), Some(2.0));
        for bad in ["", "x", "1,2,3", "1.2,3", "inf", "NaN", "1e999"] {
            assert_eq!(real(bad), None, "{bad}");
        }
    }

    #[test]
    fn units_are_understood_in_all_their_spellings() {
        for (mm, names) in [
            (10.0, ["centimeters", "Centimetres", "CM", "centimeter"]),
            (25.4, ["Inches", "inch", "in", "INCHES"]),
            (
                25.4 / 720.0,
                ["Decipoints", "decipoint", "dp", "DECIPOINTS"],
            ),
        ] {
            for name in names {
                assert_eq!(Unit::named(name), Unit::Known(mm), "{name}");
            }
        }
        assert_eq!(Unit::named("Inhces"), Unit::Like(25.4, "inches"));
        assert_eq!(Unit::named("ells"), Unit::Unknown);
    }

    #[test]
    fn colours_of_every_range_span_all_bytes() {
        for (text, least, most) in [
            ("0,255", 0.0, 255.0),
            ("0, 999", 0.0, 999.0),
            ("0,65535", 0.0, 65535.0),
            ("100,200", 100.0, 200.0),
            ("999", 0.0, 999.0),
        ] {
            let range = Range::named(text).unwrap();
            let middle = f64::midpoint(least, most);
            assert_eq!(range.bytes([least, middle, most]), ([0, 128, 255], true));
            assert!(!range.bytes([least - 1.0, most + 1.0, least]).1);
        }
        for bad in ["", "5,5", "9,1", "a,b", "1,2,3"] {
            assert_eq!(Range::named(bad), None, "{bad}");
        }
    }
}
