//! The yarns of one direction: where each lies, and how it differs from its neighbours.
//!
//! Paper D gives every yarn a small random variation ("0.5r", r ∈ U(0.5, 1), one r a yarn).

use super::Measures;
use crate::chance::{Chance, Purpose};
use crate::draft;
use crate::scenario::YarnSpec;

/// What one yarn is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Yarn {
    /// P: the share of the yarn that is pores, 0 to 1.
    pub porosity: f64,
    /// τ₁: 1 where the fibres lie straight, towards 0 the harder the yarn is twisted.
    pub twist: f64,
    /// B: how far this yarn is squeezed, 0 to 1.
    pub squeeze: f64,
    /// The colour of its fibre before it is dyed, as displayed (sRGB, 0 to 1); white is undyed cotton.
    pub colour: [f32; 3],
}

impl Default for Yarn {
    /// Half pores, straight, free and white.
    fn default() -> Self {
        Yarn {
            porosity: 0.5,
            twist: 1.0,
            squeeze: 0.0,
            colour: [1.0; 3],
        }
    }
}

/// Where a yarn lies across its layer, in cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Span {
    /// The first cell of the yarn.
    pub begin: usize,
    /// Cells across the yarn.
    pub width: usize,
    /// Cells from its edge to the next yarn.
    pub gap: usize,
}

impl Span {
    /// Cells from the beginning of this yarn to the beginning of the next.
    pub fn pitch(self) -> usize {
        self.width + self.gap
    }

    /// The middle of the yarn, in cells.
    pub fn middle(self) -> f64 {
        self.begin as f64 + self.width as f64 / 2.0
    }
}

/// The yarns of one direction, side by side from the left (warp) or the top (weft).
#[derive(Debug, Clone, PartialEq)]
pub struct Yarns {
    /// Every yarn of the cloth, in order.
    pub yarns: Vec<Yarn>,
    spans: Vec<Span>,
    /// The number of the yarn in whose cloth cell each position lies.
    numbers: Vec<u32>,
}

/// The random choices of one direction.
#[derive(Debug, Clone, Copy)]
pub(super) struct Draws {
    pub porosity: Purpose,
    pub twist: Purpose,
    pub squeeze: Purpose,
    pub width: Purpose,
}

/// A thread of a draft: its width and the gap after it in cells, and its colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thread {
    /// Cells across it, at least 1.
    pub width: usize,
    /// Cells to the next one.
    pub gap: usize,
    /// Its colour before dyeing (sRGB, 0 to 1).
    pub colour: [f32; 3],
}

impl Thread {
    /// A thread of a draft on cells of `cell_mm`, with the measures of `yarn` where it has none or they
    /// are not wanted.
    pub(super) fn of(
        thread: &draft::Thread,
        yarn: &YarnSpec,
        measures: Measures,
        cell_mm: f64,
    ) -> Self {
        let own = match (measures, thread.width_mm()) {
            (Measures::Draft, Some(width)) => Some((width, thread.gap_mm())),
            _ => None,
        };
        let (width, gap) = match own {
            Some((width, gap)) => {
                // Rounded together, so that the gap does not widen the pitch.
                let pitch = ((width + gap) / cell_mm).round().max(1.0);
                let width = (width / cell_mm).round().clamp(1.0, pitch);
                (width as usize, (pitch - width) as usize)
            }
            None => (
                yarn.width.whole_cells(cell_mm).max(1),
                yarn.gap.whole_cells(cell_mm),
            ),
        };
        let colour = thread.colour.unwrap_or([255; 3]);
        Thread {
            width,
            gap,
            colour: colour.map(|channel| f32::from(channel) / 255.0),
        }
    }
}

impl Yarns {
    /// Lays yarns side by side over `cells` cells: `make(i)` says what the `i`th is made of and gives
    /// its width (at least 1 is taken) and the gap after it, in cells.
    pub fn lay(cells: usize, mut make: impl FnMut(usize) -> (Yarn, usize, usize)) -> Self {
        let (mut yarns, mut spans) = (Vec::new(), Vec::new());
        let mut numbers = Vec::with_capacity(cells);
        while numbers.len() < cells {
            let (yarn, width, gap) = make(yarns.len());
            let span = Span {
                begin: numbers.len(),
                width: width.max(1),
                gap,
            };
            let end = cells.min(span.begin + span.pitch());
            numbers.resize(end, yarns.len() as u32);
            yarns.push(yarn);
            spans.push(span);
        }
        Yarns {
            yarns,
            spans,
            numbers,
        }
    }

    /// Lays the yarns of a scenario; `threads` are those of a draft, which repeat.
    pub(super) fn spun(
        spec: &YarnSpec,
        cell_mm: f64,
        cells: usize,
        chance: Chance,
        draws: Draws,
        threads: &[Thread],
    ) -> Self {
        let plain = Thread {
            width: spec.width.whole_cells(cell_mm).max(1),
            gap: spec.gap.whole_cells(cell_mm),
            colour: [1.0; 3],
        };
        // Each property draws from its own sequence, so that varying one leaves the others alone.
        let mut porosity = chance.sequence(draws.porosity);
        let mut twist = chance.sequence(draws.twist);
        let mut squeeze = chance.sequence(draws.squeeze);
        let mut width = chance.sequence(draws.width);
        Yarns::lay(cells, |i| {
            let thread = match threads.len() {
                0 => plain,
                n => threads[i % n],
            };
            let yarn = Yarn {
                porosity: spec.porosity * porosity.between(spec.vary_porosity),
                twist: spec.twist * twist.between(spec.vary_twist),
                squeeze: squeeze.between(spec.squeeze),
                colour: thread.colour,
            };
            let wide = thread.width as f64 * width.between(spec.vary_width);
            (yarn, wide.round() as usize, thread.gap)
        })
    }

    /// The same yarns seen from the other side: the last comes first.
    pub(super) fn mirrored(&self) -> Self {
        let cells = self.cells();
        let mut spans: Vec<Span> = Vec::with_capacity(self.spans.len());
        for span in self.spans.iter().rev() {
            // The last yarn may reach over the edge.
            let end = cells.min(span.begin + span.width);
            let begin = cells - end;
            if let Some(last) = spans.last_mut() {
                last.gap = begin - (last.begin + last.width);
            }
            spans.push(Span {
                begin,
                width: end - span.begin,
                gap: 0,
            });
        }
        let yarns = self.yarns.iter().rev().copied().collect();
        let last = spans.len() as u32 - 1;
        let numbers = self.numbers.iter().rev().map(|n| last - n).collect();
        Yarns {
            yarns,
            spans,
            numbers,
        }
    }

    /// Where the yarn of a number lies.
    pub fn span(&self, yarn: usize) -> Span {
        self.spans[yarn]
    }

    /// Where every yarn lies.
    pub fn spans(&self) -> &[Span] {
        &self.spans
    }

    /// Cells that the yarns are laid over.
    pub fn cells(&self) -> usize {
        self.numbers.len()
    }

    /// The number of the cloth cell, and so of the yarn, at a position across the yarns.
    pub fn number(&self, across: usize) -> usize {
        self.numbers[across] as usize
    }

    /// The yarn at a position across the yarns; none in a gap.
    pub fn at(&self, across: usize) -> Option<&Yarn> {
        let number = self.number(across);
        let span = self.spans[number];
        (span.begin..span.begin + span.width)
            .contains(&across)
            .then(|| &self.yarns[number])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_position_lies_in_the_cloth_cell_of_the_last_yarn_that_began() {
        let yarns = Yarns::lay(57, |i| (Yarn::default(), 1 + i % 4, i % 3));
        for across in 0..57 {
            let number = yarns.number(across);
            let span = yarns.span(number);
            assert!((span.begin..span.begin + span.pitch()).contains(&across));
            let is_yarn = across - span.begin < span.width;
            assert_eq!(yarns.at(across).is_some(), is_yarn);
        }
    }

    #[test]
    fn from_the_other_side_the_same_yarns_lie_in_mirrored_places() {
        let yarns = Yarns::lay(41, |i| {
            let porosity = 0.1 + 0.01 * i as f64;
            let yarn = Yarn {
                porosity,
                ..Yarn::default()
            };
            (yarn, 2 + i % 3, 1 + i % 2)
        });
        let turned = yarns.mirrored();
        assert!((0..41).all(|across| turned.at(across) == yarns.at(40 - across)));
        assert!((0..41).all(|across| turned.mirrored().at(across) == yarns.at(across)));
    }

    #[test]
    fn yarns_follow_each_other_without_overlap() {
        let yarns = Yarns::lay(100, |i| (Yarn::default(), 2 + i % 3, 1));
        for pair in yarns.spans().windows(2) {
            assert_eq!(pair[0].begin + pair[0].pitch(), pair[1].begin);
        }
    }
}
