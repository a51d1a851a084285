//! What leaps carry from one step to the next, kept to go on from there later.

use std::ops::Range;

use super::Leap;
use super::baths::{Baths, Given};
use crate::diffusion::held::{Held, HeldCell};
use crate::diffusion::lanes::Cells;

/// All that a later leap needs of those before.
#[derive(Debug, Clone)]
pub struct KeptLeap {
    span: Range<u64>,
    begun: u64,
    /// c, its rate, and A; at both ends of the leap, or only at the end where nothing between is
    /// asked for any more.
    ends: Vec<[Vec<Cells>; 3]>,
    held: Held,
    /// What flowed into each kept cell.
    flowed: Vec<f64>,
    baths: Option<Baths>,
    soaked: Vec<Cells>,
    soaking: u64,
    stiffness: f64,
    clipped: f64,
    brought: Given,
    booked: Option<[Given; 2]>,
    next: u64,
    depends: u64,
    evaluations: u64,
    leaps: u64,
    rejected: u64,
}

impl KeptLeap {
    /// Bytes of memory.
    pub fn bytes(&self) -> usize {
        let ends = self.ends.iter().flatten().map(Vec::len).sum::<usize>();
        let baths = self.baths.as_ref().map_or(0, Baths::bytes);
        (ends + self.soaked.len()) * size_of::<Cells>()
            + self.held.len() * size_of::<HeldCell>()
            + self.flowed.len() * size_of::<f64>()
            + baths
            + size_of::<Self>()
    }

    /// The step from which on something may happen otherwise without anything being otherwise here.
    pub fn depends(&self) -> u64 {
        self.depends
    }
}

impl Leap {
    /// Whether the process is at the end of a leap at `step`: nothing between its ends will be asked for.
    pub fn rests_at(&self, step: u64) -> bool {
        self.span.end == step
    }

    /// What is needed to go on from `step`, where the process is now.
    pub fn keep(&self, step: u64) -> KeptLeap {
        let ends = if self.rests_at(step) { 1..2 } else { 0..2 };
        let end = |end: usize| {
            [
                self.c[end].clone(),
                self.rate[end].clone(),
                self.a[end].clone(),
            ]
        };
        KeptLeap {
            span: self.span.clone(),
            begun: self.begun,
            ends: ends.map(end).collect(),
            held: self.held.clone(),
            flowed: self.flowed[0].clone(),
            baths: self.baths.clone(),
            soaked: self.soaked.clone(),
            soaking: self.soaking,
            stiffness: self.stiffness,
            clipped: self.clipped,
            brought: self.brought,
            booked: self.booked,
            next: self.next,
            depends: self.depends,
            evaluations: self.evaluations,
            leaps: self.leaps,
            rejected: self.rejected,
        }
    }

    /// Goes on from what was kept once, on the same cloth.
    pub fn resume(&mut self, kept: &KeptLeap) {
        for (end, [c, rate, a]) in kept.ends.iter().rev().enumerate() {
            self.c[1 - end].clone_from(c);
            self.rate[1 - end].clone_from(rate);
            self.a[1 - end].clone_from(a);
        }
        self.span = kept.span.clone();
        self.begun = kept.begun;
        self.held = kept.held.clone();
        self.flowed = [kept.flowed.clone(), vec![0.0; kept.flowed.len()]];
        self.baths = kept.baths.clone();
        self.soaked.clone_from(&kept.soaked);
        self.given = [0, 1].map(|_| vec![[0.0; 2]; kept.soaked.len()]);
        self.soaking = kept.soaking;
        self.stiffness = kept.stiffness;
        self.clipped = kept.clipped;
        self.brought = kept.brought;
        self.booked = kept.booked;
        self.next = kept.next;
        self.depends = kept.depends;
        self.evaluations = kept.evaluations;
        self.leaps = kept.leaps;
        self.rejected = kept.rejected;
        self.bind_after_moving();
    }
}
