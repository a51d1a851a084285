//! The kinds of weave with their parameters.

use bevy_egui::egui::Ui;

use super::PanelAsk;
use super::named::NAMED;
use super::row::{Pass, row};
use super::weave::by_hand;
use crate::cloth::{Face, LARGEST_REPEAT, Measures, Weave};
use crate::draft;
use crate::scenario::ClothSpec;

/// The kinds of weave with their parameters.
pub(super) fn rows(p: &mut Pass, ui: &mut Ui, cloth: &mut ClothSpec) {
    kinds(p, ui, cloth);
    parameters(p, ui, &mut cloth.weave);
}

pub(super) fn kinds(p: &mut Pass, ui: &mut Ui, cloth: &mut ClothSpec) {
    let named = row(
        "named weave",
        "Sets the weave to one that weavers have a name for.",
    );
    let names: Vec<&str> = NAMED.iter().map(|named| named.name).collect();
    if let Some(i) = p.variant(ui, &named, usize::MAX, &names) {
        cloth.weave = NAMED[i].weave();
    }
    let kind = row(
        "weave",
        "Which yarn lies on top at every crossing: by a rule, drawn by hand, from a weaver's draft (WIF), \
         or read off a photograph.",
    );
    let now = match cloth.weave {
        Weave::Plain => 0,
        Weave::Twill { .. } => 1,
        Weave::Satin { .. } => 2,
        Weave::Matrix(_) => 3,
        Weave::Wif { .. } => 4,
        Weave::Mask { .. } => 5,
    };
    let kinds = [
        "plain",
        "twill",
        "satin",
        "by hand",
        "draft (WIF)",
        "from a mask",
    ];
    match p.variant(ui, &kind, now, &kinds) {
        Some(0) => cloth.weave = Weave::Plain,
        Some(1) => cloth.weave = Weave::Twill { over: 2, under: 2 },
        Some(2) => {
            cloth.weave = Weave::Satin {
                shafts: 8,
                counter: 3,
                face: Face::Warp,
            };
        }
        Some(3) => cloth.weave = by_hand(&cloth.weave.matrix()),
        Some(4) => {
            let file = draft::bundled_names().first().copied().unwrap_or_default();
            cloth.weave = Weave::Wif {
                file: file.to_owned(),
                measures: Measures::Yarns,
            };
        }
        Some(_) => p.ask_image("cloth.weave.file".into()),
        None => {}
    }
}

pub(super) fn parameters(p: &mut Pass, ui: &mut Ui, weave: &mut Weave) {
    match weave {
        Weave::Twill { over, under } => {
            let half = LARGEST_REPEAT / 2;
            p.number(
                ui,
                &row(
                    "over",
                    "Picks that the warp floats over: more shows more warp.",
                ),
                over,
                1..=half,
            );
            p.number(
                ui,
                &row("under", "Picks that the warp dives under."),
                under,
                1..=half,
            );
        }
        Weave::Satin {
            shafts,
            counter,
            face,
        } => satin(p, ui, shafts, counter, face),
        Weave::Wif { file, measures } => {
            let names = draft::bundled_names();
            let now = names
                .iter()
                .position(|name| name == file)
                .unwrap_or(usize::MAX);
            if let Some(i) = p.variant(
                ui,
                &row("bundled draft", "A draft that comes with the program."),
                now,
                &names,
            ) {
                *file = names[i].to_owned();
            }
            p.text(
                ui,
                &row(
                    "draft file",
                    "A WIF file beside the scenario, or the name of a bundled draft.",
                ),
                file,
            );
            let both = [
                ("the draft's", Measures::Draft),
                ("the yarns'", Measures::Yarns),
            ];
            p.choice(
                ui,
                &row(
                    "measures",
                    "Whether yarns are as wide as the draft says, or as the rows below.",
                ),
                measures,
                &both,
            );
            load(p, ui);
        }
        Weave::Mask { file } => {
            p.text(ui, &row("mask file", "A picture as large as the cloth: blue where the warp is on top, red where the weft is."), file);
        }
        Weave::Plain | Weave::Matrix(_) => {}
    }
}

pub(super) fn load(p: &mut Pass, ui: &mut Ui) {
    if p.button(ui, "Load a WIF…", "Reads a weaver's draft") {
        p.state.ask = Some(PanelAsk::OpenWif);
    }
}

fn satin(p: &mut Pass, ui: &mut Ui, shafts: &mut u32, counter: &mut u32, face: &mut Face) {
    let fits =
        |shafts: u32, s: u32| (2..=shafts.saturating_sub(2)).contains(&s) && gcd(shafts, s) == 1;
    let nearest = |shafts: u32, from: u32| {
        (2..shafts)
            .filter(|s| fits(shafts, *s))
            .min_by_key(|s| s.abs_diff(from))
    };
    let before = *shafts;
    p.number(ui, &row("shafts", "Ends and picks in one repeat; 6 make no satin. More makes longer floats and smoother cloth."), shafts, 5..=LARGEST_REPEAT);
    if *shafts == 6 {
        *shafts = if before < 6 { 7 } else { 5 };
    }
    p.number(
        ui,
        &row(
            "counter",
            "The move from pick to pick; it shares no factor with the shafts.",
        ),
        counter,
        2..=shafts.saturating_sub(2).max(2),
    );
    if !fits(*shafts, *counter) {
        *counter = nearest(*shafts, *counter).unwrap_or(2);
    }
    let both = [("warp", Face::Warp), ("weft (sateen)", Face::Weft)];
    p.choice(
        ui,
        &row("faced by", "Which yarn covers the face."),
        face,
        &both,
    );
}

fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { gcd(b, a % b) }
}
