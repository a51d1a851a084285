//! How draped cloth is seen: the camera and its way, the light, the frame.

use bevy_egui::egui::Ui;

use super::presets;
use super::row::{Pass, row};
use crate::scenario::{CameraSpec, LARGEST_VIEW, ViewSpec};

pub(super) fn view(p: &mut Pass, ui: &mut Ui, view: &mut ViewSpec) {
    let preset = row("camera preset", "A place or a way of the camera.");
    p.choice(ui, &preset, &mut view.camera, &presets::CAMERAS);
    camera(p, ui, &mut view.camera);
    let pixels = row("frame width", "Pixels of a frame across.");
    p.number(ui, &pixels, &mut view.pixels.0, 16..=LARGEST_VIEW);
    let pixels = row("frame height", "Pixels of a frame down.");
    p.number(ui, &pixels, &mut view.pixels.1, 16..=LARGEST_VIEW);
    let angle = row(
        "field of view",
        "Angle between the upper and the lower edge of what is seen.",
    )
    .unit("°");
    p.number(ui, &angle.scale(30.0), &mut view.field_of_view, 5.0..=120.0);
    p.colour(
        ui,
        &row("ground", "The colour of the studio's ground."),
        &mut view.ground,
    );
    let light = row(
        "light",
        "Where the light comes from: degrees around the upright (90 from the right) and above the horizon.",
    );
    p.numbers(
        ui,
        &light.scale(30.0),
        [&mut view.light.0, &mut view.light.1],
        [(-360.0, 360.0), (5.0, 90.0)],
    );
    let moves = row("moves for", "How long the cloth moves while it is dyed, evenly over the process. 0: it has settled before.").unit(" s");
    p.number(ui, &moves, &mut view.moves_s, 0.0..=3600.0);
}

const TURN: (f64, f64) = (-36_000.0, 36_000.0);

const DISTANCE: (f64, f64) = (0.05, 20.0);

fn camera(p: &mut Pass, ui: &mut Ui, camera: &mut CameraSpec) {
    let kind = row(
        "camera",
        "It stands still, goes around the cloth, or comes nearer or goes away.",
    );
    let now = match camera {
        CameraSpec::Still { .. } => 0,
        CameraSpec::Orbit { .. } => 1,
        CameraSpec::Dolly { .. } => 2,
    };
    if let Some(chosen) = p.variant(ui, &kind, now, &["still", "orbit", "dolly"]) {
        let at = camera.at(0.0);
        let (turn, elevation, distance, at_m) = (at.turn, at.elevation, at.distance, at.at_m);
        *camera = match chosen {
            0 => CameraSpec::Still {
                turn,
                elevation,
                distance,
                at_m,
            },
            1 => CameraSpec::Orbit {
                from: turn.min(TURN.1 - 360.0),
                to: turn.min(TURN.1 - 360.0) + 360.0,
                elevation,
                distance,
                at_m,
            },
            _ => CameraSpec::Dolly {
                from: distance,
                to: (0.5 * distance).max(DISTANCE.0),
                turn,
                elevation,
                at_m,
            },
        };
    }
    let degrees = |name, tip| row(name, tip).unit("°").scale(20.0);
    let turn_row = degrees(
        "turn",
        "Degrees around the upright: 0 in front, 90 at the right.",
    );
    let distance_row = row(
        "distance",
        "Multiples of the distance at which the whole cloth just fits.",
    );
    let (elevation, at_m) = match camera {
        CameraSpec::Still {
            turn,
            elevation,
            distance,
            at_m,
        } => {
            p.number(ui, &turn_row, turn, TURN.0..=TURN.1);
            p.number(ui, &distance_row, distance, DISTANCE.0..=DISTANCE.1);
            (elevation, at_m)
        }
        CameraSpec::Orbit {
            from,
            to,
            elevation,
            distance,
            at_m,
        } => {
            p.number(
                ui,
                &degrees("turn from", "Where it begins: 0 in front, 90 at the right."),
                from,
                TURN.0..=TURN.1,
            );
            p.number(
                ui,
                &degrees("turn to", "Where it ends; 360 more is once around."),
                to,
                TURN.0..=TURN.1,
            );
            p.number(ui, &distance_row, distance, DISTANCE.0..=DISTANCE.1);
            (elevation, at_m)
        }
        CameraSpec::Dolly {
            from,
            to,
            turn,
            elevation,
            at_m,
        } => {
            p.number(ui, &turn_row, turn, TURN.0..=TURN.1);
            p.number(
                ui,
                &row("distance from", "How far away it begins."),
                from,
                DISTANCE.0..=DISTANCE.1,
            );
            p.number(
                ui,
                &row("distance to", "How far away it ends."),
                to,
                DISTANCE.0..=DISTANCE.1,
            );
            (elevation, at_m)
        }
    };
    p.number(
        ui,
        &degrees("elevation", "Degrees above the horizon."),
        elevation,
        -89.0..=89.0,
    );
    let mut aims = at_m.is_some();
    p.tick(
        ui,
        &row("looks at a place", "Left out: at the middle of the cloth."),
        &mut aims,
    );
    if aims != at_m.is_some() {
        *at_m = aims.then_some((0.0, 0.5, 0.0));
    }
    if let Some(at) = at_m {
        p.xyz(
            ui,
            &row(
                "place",
                "What it looks at, m: to the right, up, to the viewer.",
            )
            .scale(0.5),
            at,
            1e4,
        );
    }
}
