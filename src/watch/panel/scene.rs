//! How draped cloth begins, what holds it, the wind, and where it was pressed.

use bevy_egui::egui::Ui;

use super::row::{Pass, row};
use crate::drape::spec::{CreaseSpec, Fold, Hold, PinSpec, Start, WindSpec, Xyz};

pub(super) const FURTHEST: f64 = 1e4;

pub(super) fn xyz(p: &mut Pass, ui: &mut Ui, name: &str, tip: &str, at: &mut Xyz) {
    p.xyz(ui, &row(name, tip).scale(0.5), at, FURTHEST);
}

pub(super) fn metres(
    p: &mut Pass,
    ui: &mut Ui,
    name: &str,
    tip: &str,
    value: &mut f64,
    ends: (f64, f64),
) {
    p.number(
        ui,
        &row(name, tip).unit(" m").scale(0.1),
        value,
        ends.0..=ends.1,
    );
}

fn place(p: &mut Pass, ui: &mut Ui, name: &str, tip: &str, at: &mut (f64, f64)) {
    p.numbers(
        ui,
        &row(name, tip).scale(0.5),
        [&mut at.0, &mut at.1],
        [(0.0, 1.0); 2],
    );
}

pub(super) fn start(p: &mut Pass, ui: &mut Ui, start: &mut Start) {
    let kind = row(
        "begins",
        "Level above things, hanging upright, or on the outside of a ball.",
    );
    let (now, at) = match *start {
        Start::Flat { centre_m, .. } => (0, centre_m),
        Start::Hanging { top_m, .. } => (1, top_m),
        Start::Sphere { centre_m, .. } => (2, centre_m),
    };
    if let Some(kind) = p.variant(ui, &kind, now, &["flat", "hanging", "on a ball"]) {
        let turn = 0.0;
        *start = match kind {
            0 => Start::Flat { centre_m: at, turn },
            1 => Start::Hanging { top_m: at, turn },
            _ => Start::Sphere {
                centre_m: at,
                radius_m: 0.25,
            },
        };
    }
    let turn_row = row("turned by", "Degrees, anticlockwise seen from above.")
        .unit("°")
        .scale(20.0);
    match start {
        Start::Flat { centre_m, turn } => {
            xyz(
                p,
                ui,
                "middle",
                "Where its middle is, m: to the right, up, to the viewer.",
                centre_m,
            );
            p.number(ui, &turn_row, turn, -360.0..=360.0);
        }
        Start::Hanging { top_m, turn } => {
            xyz(
                p,
                ui,
                "upper edge",
                "Where the middle of its upper edge is, m: to the right, up, to the viewer.",
                top_m,
            );
            p.number(ui, &turn_row, turn, -360.0..=360.0);
        }
        Start::Sphere { centre_m, radius_m } => {
            xyz(
                p,
                ui,
                "middle",
                "Where the centre of the ball is, m.",
                centre_m,
            );
            metres(p, ui, "radius", "Of the ball.", radius_m, (1e-4, FURTHEST));
        }
    }
}

pub(super) fn pins(p: &mut Pass, ui: &mut Ui, pins: &mut Vec<PinSpec>) {
    let add = row(
        "add a pin",
        "Holds the cloth at a point, along a line, or all of it.",
    );
    let title = |pin: &PinSpec| match pin.at {
        Hold::Point(..) => "pin at a point".to_owned(),
        Hold::Line(..) => "pin along a line".to_owned(),
        Hold::All => "pin over all".to_owned(),
    };
    let make = |kind: usize| {
        Some(PinSpec {
            at: hold(kind),
            radius_m: 0.008,
            from_s: 0.0,
            until_s: None,
            path: Vec::new(),
        })
    };
    p.list(
        ui,
        &add,
        pins,
        (0, 1000),
        title,
        &HOLDS,
        make,
        |p, ui, _, pin| pin_rows(p, ui, pin),
    );
}

const HOLDS: [&str; 3] = ["point", "line", "all"];

fn hold(kind: usize) -> Hold {
    match kind {
        0 => Hold::Point(0.5, 0.0),
        1 => Hold::Line((0.0, 0.0), (1.0, 0.0)),
        _ => Hold::All,
    }
}

fn pin_rows(p: &mut Pass, ui: &mut Ui, pin: &mut PinSpec) {
    let now = match pin.at {
        Hold::Point(..) => 0,
        Hold::Line(..) => 1,
        Hold::All => 2,
    };
    if let Some(kind) = p.variant(
        ui,
        &row("holds", "A point, a line, or the whole cloth."),
        now,
        &HOLDS,
    ) {
        pin.at = hold(kind);
    }
    let shares = "Shares of the cloth across and down: (0, 0) is its upper left corner.";
    match &mut pin.at {
        Hold::Point(u, v) => {
            let at = row("at", shares).scale(0.5);
            p.numbers(ui, &at, [u, v], [(0.0, 1.0); 2]);
        }
        Hold::Line(from, to) => {
            place(p, ui, "from place", shares, from);
            place(p, ui, "to place", shares, to);
        }
        Hold::All => {}
    }
    metres(
        p,
        ui,
        "reach",
        "Particles within this distance are held; the nearest always is.",
        &mut pin.radius_m,
        (0.0, 100.0),
    );
    let latest = pin.until_s.unwrap_or(1e6);
    p.number(
        ui,
        &row("takes hold", "When it takes hold.").unit(" s"),
        &mut pin.from_s,
        0.0..=latest,
    );
    let until = row("lets go", "When it lets go. Left out: never.").unit(" s");
    p.optional(
        ui,
        &until,
        &mut pin.until_s,
        pin.from_s..=1e6,
        (pin.from_s + 1.0, "never"),
    );
    way(p, ui, &mut pin.path);
}

/// Where a pin leads what it holds.
fn way(p: &mut Pass, ui: &mut Ui, path: &mut Vec<(f64, Xyz)>) {
    let moments: Vec<f64> = path.iter().map(|(moment, _)| *moment).collect();
    let last = path.last().copied().unwrap_or((0.0, (0.0, 0.0, 0.0)));
    let add = row(
        "add a move",
        "Leads what the pin holds somewhere else, at a moment after it took hold.",
    );
    let make = |_| (last.0 + 1.0 <= 1e6).then_some((last.0 + 1.0, last.1));
    let title = |(moment, _): &(f64, Xyz)| format!("move at {moment} s");
    p.list(
        ui,
        &add,
        path,
        (0, 1000),
        title,
        &["one later"],
        make,
        |p, ui, i, (moment, to)| {
            let least = if i == 0 {
                1e-3
            } else {
                moments.get(i - 1).copied().unwrap_or(0.0) + 1e-3
            };
            let most = moments.get(i + 1).map_or(1e6, |next| next - 1e-3);
            let when = row("moment", "When it is there, after the pin took hold.").unit(" s");
            p.number(ui, &when, moment, least..=most.max(least));
            xyz(
                p,
                ui,
                "move",
                "How far from where it took hold, m: to the right, up, to the viewer.",
                to,
            );
        },
    );
}

pub(super) fn wind(p: &mut Pass, ui: &mut Ui, wind: &mut Option<WindSpec>) {
    let mut blows = wind.is_some();
    p.tick(ui, &row("blows", "Left out: still air."), &mut blows);
    if blows != wind.is_some() {
        let breeze = WindSpec {
            velocity: (0.6, 0.0, 1.6),
            gusts: 0.3,
        };
        *wind = blows.then_some(breeze);
    }
    if let Some(wind) = wind {
        let tip =
            "Mean velocity, m/s: to the right, up, to the viewer. A light breeze has 1.6 to 3.3.";
        p.xyz(ui, &row("velocity", tip), &mut wind.velocity, 100.0);
        let gusts = row("gusts", "How much its speed varies, as a share.");
        p.number(ui, &gusts.scale(0.3), &mut wind.gusts, 0.0..=2.0);
    }
}

pub(super) fn creases(p: &mut Pass, ui: &mut Ui, creases: &mut Vec<CreaseSpec>) {
    let add = row("add a crease", "A line along which the cloth was pressed.");
    let title = |crease: &CreaseSpec| match crease.fold {
        Fold::Mountain => "mountain crease".to_owned(),
        Fold::Valley => "valley crease".to_owned(),
    };
    let make = |kind: usize| {
        let (from, to) = match kind {
            0 => ((0.0, 0.5), (1.0, 0.5)),
            _ => ((0.5, 0.0), (0.5, 1.0)),
        };
        Some(CreaseSpec {
            from,
            to,
            fold: Fold::Mountain,
            angle: 91.146,
            stiffness: None,
        })
    };
    p.list(ui, &add, creases, (0, 1000), title, &["across", "down"], make, |p, ui, _, crease| {
        let shares = "Shares of the cloth across and down.";
        place(p, ui, "from place", shares, &mut crease.from);
        place(p, ui, "to place", shares, &mut crease.to);
        let fold = row("fold", "Mountain: a ridge seen from the front. Valley: a furrow.");
        let both = [("mountain", Fold::Mountain), ("valley", Fold::Valley)];
        p.choice(ui, &fold, &mut crease.fold, &both);
        let angle = row("fold angle", "How far it folds if nothing holds it: 0 flat, 180 shut.");
        p.number(ui, &angle.unit("°").scale(30.0), &mut crease.angle, 1.0..=160.0);
        let stiffness = row("crease stiffness", "Torque by length and angle, N·m/(m·rad). Left out: that of 2 mm of the cloth bent over.");
        p.optional(ui, &stiffness.scale(1e-3), &mut crease.stiffness, 0.0..=1e3, (0.01, "as the cloth"));
    });
}
