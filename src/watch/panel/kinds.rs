//! The kinds of pattern, and how one becomes another.

use crate::pattern::{Pattern, Stroke};
use crate::scenario::Length;

/// The kinds of pattern, in the order in which they are offered.
pub(super) const KINDS: [&str; 20] = [
    "nothing",
    "everywhere",
    "picture",
    "disc",
    "discs",
    "rectangle",
    "stripes",
    "rings",
    "rays",
    "radial",
    "ramp",
    "clouds",
    "seikaiha",
    "union of",
    "intersection of",
    "one without another",
    "inverse of",
    "blurred",
    "weakened",
    "strokes",
];

pub(super) fn kind(pattern: &Pattern) -> usize {
    match pattern {
        Pattern::Nowhere => 0,
        Pattern::Everywhere => 1,
        Pattern::Image { .. } => 2,
        Pattern::Disc { .. } => 3,
        Pattern::Discs { .. } => 4,
        Pattern::Rectangle { .. } => 5,
        Pattern::Stripes { .. } => 6,
        Pattern::Rings { .. } => 7,
        Pattern::Rays { .. } => 8,
        Pattern::Radial { .. } => 9,
        Pattern::Ramp { .. } => 10,
        Pattern::Noise { .. } => 11,
        Pattern::Seikaiha { .. } => 12,
        Pattern::Union(_) => 13,
        Pattern::Intersection(_) => 14,
        Pattern::Without { .. } => 15,
        Pattern::Invert(_) => 16,
        Pattern::Blur { .. } => 17,
        Pattern::Strength { .. } => 18,
        Pattern::Strokes(_) => 19,
    }
}

/// The kind of a pattern in a word.
pub(super) fn word(pattern: &Pattern) -> &'static str {
    KINDS[kind(pattern)]
}

/// A pattern of another kind: one that is combined of others keeps what was there as its part.
pub(super) fn of_kind(kind: usize, was: Pattern, (width, height): (f64, f64)) -> Pattern {
    let centre = (0.5, 0.5);
    let across = width.min(height);
    let cells = |share: f64| Length::Cells((share * across).round().max(2.0));
    let mut parts = parts(was).into_iter();
    let mut part = || {
        let plain = || Pattern::Disc {
            diameter: cells(0.4),
            centre,
        };
        Box::new(parts.next().unwrap_or_else(plain))
    };
    match kind {
        0 | 2 => Pattern::Nowhere,
        1 => Pattern::Everywhere,
        3 => Pattern::Disc {
            diameter: cells(0.4),
            centre,
        },
        4 => Pattern::Discs {
            diameter: cells(0.1),
            pitch: cells(0.2),
            staggered: false,
        },
        5 => Pattern::Rectangle {
            size: (cells(0.5), cells(0.5)),
            centre,
        },
        6 => Pattern::Stripes {
            width: cells(0.1),
            gap: cells(0.1),
            offset: Length::Cells(0.0),
            angle: 0.0,
        },
        7 => Pattern::Rings {
            width: cells(0.05),
            gap: cells(0.05),
            centre,
        },
        8 => Pattern::Rays {
            count: 12,
            share: 0.5,
            centre,
        },
        9 => Pattern::Radial {
            from: Length::Cells(0.0),
            to: cells(0.5),
            centre,
        },
        10 => Pattern::Ramp { angle: 0.0 },
        11 => Pattern::Noise {
            grain: cells(0.1),
            octaves: 3,
            seed: 0,
        },
        12 => Pattern::Seikaiha {
            radius: cells(0.2),
            arcs: 4,
            open: 0.5,
        },
        13 => Pattern::Union([*part()].into_iter().chain(parts).collect()),
        14 => Pattern::Intersection([*part()].into_iter().chain(parts).collect()),
        15 => Pattern::Without {
            of: part(),
            cut: part(),
        },
        16 => Pattern::Invert(part()),
        17 => Pattern::Blur {
            of: part(),
            radius: Length::Cells(1.0),
        },
        18 => Pattern::Strength {
            of: part(),
            by: 0.9,
        },
        _ => Pattern::Strokes(vec![Stroke::along(
            cells(0.05),
            vec![(0.3, 0.5), (0.7, 0.5)],
        )]),
    }
}

/// The parts of a combination; another pattern is a part itself.
pub(super) fn parts(pattern: Pattern) -> Vec<Pattern> {
    match pattern {
        Pattern::Nowhere => Vec::new(),
        Pattern::Union(parts) | Pattern::Intersection(parts) => parts,
        Pattern::Without { of, cut } => vec![*of, *cut],
        Pattern::Invert(of) | Pattern::Blur { of, .. } | Pattern::Strength { of, .. } => vec![*of],
        other => vec![other],
    }
}
