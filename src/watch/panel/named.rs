//! Weaves by the names that weavers give them.

use crate::cloth::{Face, Weave};

/// A weave with a name.
#[derive(Debug, Clone, Copy)]
pub struct NamedWeave {
    /// The name.
    pub name: &'static str,
    make: fn() -> Weave,
}

impl NamedWeave {
    /// The weave.
    pub fn weave(&self) -> Weave {
        (self.make)()
    }
}

/// The weaves that the editor offers by name.
pub const NAMED: [NamedWeave; 13] = [
    named("plain", || Weave::Plain),
    named("hopsack 2/2", || drawn(&["XX..", "XX..", "..XX", "..XX"])),
    named("warp rib 2/2", || drawn(&["X.", "X.", ".X", ".X"])),
    named("weft rib 2/2", || drawn(&["XX..", "..XX"])),
    named("twill 2/1", || twill(2, 1)),
    named("twill 1/2", || twill(1, 2)),
    named("twill 2/2", || twill(2, 2)),
    named("twill 3/1 (denim)", || twill(3, 1)),
    named("twill 1/3", || twill(1, 3)),
    named("satin 5", || satin(5, 2, Face::Warp)),
    named("satin 8", || satin(8, 3, Face::Warp)),
    named("sateen 8", || satin(8, 3, Face::Weft)),
    named("herringbone", || {
        drawn(&[
            "XX..XX..X..XX..X",
            ".XX..XX..XX..XX.",
            "..XX..XX..XX..XX",
            "X..XX..XX..XX..X",
        ])
    }),
];

const fn named(name: &'static str, make: fn() -> Weave) -> NamedWeave {
    NamedWeave { name, make }
}

fn twill(over: u32, under: u32) -> Weave {
    Weave::Twill { over, under }
}

fn satin(shafts: u32, counter: u32, face: Face) -> Weave {
    Weave::Satin {
        shafts,
        counter,
        face,
    }
}

fn drawn(picks: &[&str]) -> Weave {
    Weave::Matrix(picks.iter().map(|pick| (*pick).to_owned()).collect())
}
