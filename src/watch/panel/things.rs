//! What draped cloth falls on.

use bevy_egui::egui::Ui;

use super::row::{Pass, row};
use super::scene::{FURTHEST, metres, xyz};
use crate::drape::spec::ColliderSpec;

pub(super) fn colliders(p: &mut Pass, ui: &mut Ui, on: &mut Vec<ColliderSpec>) {
    let add = row("add a thing", "Something that the cloth falls on.");
    let title = |collider: &ColliderSpec| {
        let name = match collider {
            ColliderSpec::Floor { .. } => "floor",
            ColliderSpec::Ball { .. } => "ball",
            ColliderSpec::RoundTable { .. } => "round table",
            ColliderSpec::SquareTable { .. } => "square table",
            ColliderSpec::Mesh { .. } => "mesh",
        };
        name.to_owned()
    };
    let names = ["floor", "ball", "round table", "square table"];
    let (centre_m, thickness_m, edge_m) = ((0.0, 0.5, 0.0), 0.03, 0.008);
    let make = |kind: usize| {
        Some(match kind {
            0 => ColliderSpec::Floor { height_m: 0.0 },
            1 => ColliderSpec::Ball {
                centre_m,
                radius_m: 0.2,
            },
            2 => ColliderSpec::RoundTable {
                centre_m,
                radius_m: 0.4,
                thickness_m,
                edge_m,
            },
            _ => ColliderSpec::SquareTable {
                centre_m,
                size_m: (0.6, 0.6),
                thickness_m,
                edge_m,
            },
        })
    };
    p.list(
        ui,
        &add,
        on,
        (0, 1000),
        title,
        &names,
        make,
        |p, ui, _, collider| {
            collider_rows(p, ui, collider);
        },
    );
}

fn collider_rows(p: &mut Pass, ui: &mut Ui, collider: &mut ColliderSpec) {
    let upper = "The middle of its upper side, m: to the right, up, to the viewer.";
    match collider {
        ColliderSpec::Floor { height_m } => {
            metres(
                p,
                ui,
                "height",
                "Everything below is solid.",
                height_m,
                (-FURTHEST, FURTHEST),
            );
        }
        ColliderSpec::Ball { centre_m, radius_m } => {
            xyz(
                p,
                ui,
                "middle",
                "Its centre, m: to the right, up, to the viewer.",
                centre_m,
            );
            metres(p, ui, "radius", "Of the ball.", radius_m, (1e-4, FURTHEST));
        }
        ColliderSpec::RoundTable {
            centre_m,
            radius_m,
            thickness_m,
            edge_m,
        } => {
            xyz(p, ui, "middle", upper, centre_m);
            metres(
                p,
                ui,
                "radius",
                "Of the table top.",
                radius_m,
                (1e-3, FURTHEST),
            );
            slab(p, ui, thickness_m, edge_m, *radius_m);
        }
        ColliderSpec::SquareTable {
            centre_m,
            size_m,
            thickness_m,
            edge_m,
        } => {
            xyz(p, ui, "middle", upper, centre_m);
            let size = row("width, depth", "Of the table top.")
                .unit(" m")
                .scale(0.5);
            p.numbers(
                ui,
                &size,
                [&mut size_m.0, &mut size_m.1],
                [(1e-3, FURTHEST); 2],
            );
            slab(p, ui, thickness_m, edge_m, size_m.0.min(size_m.1));
        }
        ColliderSpec::Mesh {
            corners_m,
            triangles,
        } => {
            let said = format!(
                "A solid of {} triangles and {} corners; the scenario file says where they are.",
                triangles.len(),
                corners_m.len()
            );
            p.say(ui, &said);
        }
    }
}

fn slab(p: &mut Pass, ui: &mut Ui, thickness: &mut f64, edge: &mut f64, least: f64) {
    metres(
        p,
        ui,
        "table thickness",
        "How thick the table top is.",
        thickness,
        (1e-4, FURTHEST),
    );
    let most = 0.49 * least.min(2.0 * *thickness);
    metres(
        p,
        ui,
        "edge",
        "By how much its edge is rounded.",
        edge,
        (0.0, most),
    );
}
