//! Every length of a scenario, with the fewest and the most cells it may have.

use crate::pattern::Pattern;
use crate::scenario::{BatikStep, Length, Scenario, SupplySpec};

/// The most cells along one side of a cloth.
pub(super) const LONGEST_SIDE: f64 = (1_u64 << 20) as f64;

/// The longest length in a pattern, cells.
pub(super) const LONGEST: f64 = 1e7;

/// Every length with the fewest and the most cells it may have.
pub(super) fn lengths(scenario: &mut Scenario, each: &mut dyn FnMut(&mut Length, f64, f64)) {
    let cloth = &mut scenario.cloth;
    each(&mut cloth.size.0, 1.0, LONGEST_SIDE);
    each(&mut cloth.size.1, 1.0, LONGEST_SIDE);
    for yarn in [Some(&mut cloth.warp), cloth.weft.as_mut()]
        .into_iter()
        .flatten()
    {
        each(&mut yarn.width, 1.0, LONGEST_SIDE);
        each(&mut yarn.gap, 0.0, LONGEST_SIDE);
    }
    for sections in [&mut cloth.kasuri.warp, &mut cloth.kasuri.weft]
        .into_iter()
        .flatten()
    {
        each(&mut sections.shift, 0.0, LONGEST_SIDE);
        each(&mut sections.bleed, 0.0, 200.0);
        pattern_lengths(&mut sections.pattern, each);
    }
    pattern_lengths(&mut scenario.resist, each);
    for supply in &mut scenario.supply {
        let (SupplySpec::Dose { shape, .. }
        | SupplySpec::Hold { shape, .. }
        | SupplySpec::Bath { shape, .. }) = supply;
        pattern_lengths(shape, each);
    }
    for step in scenario.batik.iter_mut().flat_map(|batik| &mut batik.steps) {
        if let BatikStep::Wax {
            pattern: Some(pattern),
            ..
        } = step
        {
            pattern_lengths(pattern, each);
        }
    }
}

fn pattern_lengths(pattern: &mut Pattern, each: &mut dyn FnMut(&mut Length, f64, f64)) {
    const THIN: f64 = 1e-3;
    match pattern {
        Pattern::Disc { diameter, .. } => each(diameter, THIN, LONGEST),
        Pattern::Discs {
            diameter, pitch, ..
        } => {
            each(diameter, THIN, LONGEST);
            each(pitch, THIN, LONGEST);
        }
        Pattern::Rectangle { size, .. } => {
            each(&mut size.0, THIN, LONGEST);
            each(&mut size.1, THIN, LONGEST);
        }
        Pattern::Stripes {
            width, gap, offset, ..
        } => {
            each(width, THIN, LONGEST);
            each(gap, 0.0, LONGEST);
            each(offset, 0.0, LONGEST);
        }
        Pattern::Rings { width, gap, .. } => {
            each(width, THIN, LONGEST);
            each(gap, 0.0, LONGEST);
        }
        Pattern::Radial { from, to, .. } => {
            each(from, 0.0, LONGEST);
            each(to, THIN, LONGEST);
        }
        Pattern::Noise { grain, .. } => each(grain, THIN, LONGEST),
        Pattern::Seikaiha { radius, .. } => each(radius, 2.0, LONGEST),
        Pattern::Union(parts) | Pattern::Intersection(parts) => {
            for part in parts {
                pattern_lengths(part, each);
            }
        }
        Pattern::Without { of, cut } => {
            pattern_lengths(of, each);
            pattern_lengths(cut, each);
        }
        Pattern::Blur { of, radius } => {
            each(radius, 0.1, 1000.0);
            pattern_lengths(of, each);
        }
        Pattern::Invert(of) | Pattern::Strength { of, .. } => pattern_lengths(of, each),
        _ => {}
    }
}
