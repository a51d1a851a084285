//! A weave as it is drawn: its matrix, and the cloth that it gives.

use bevy_egui::egui::{self, Color32, Rect, Sense, Ui, pos2, vec2};

use crate::cloth::WeaveMatrix;

const WARP: Color32 = Color32::from_rgb(38, 60, 110);

const WEFT: Color32 = Color32::from_rgb(236, 228, 208);

const GROUND: Color32 = Color32::from_rgb(120, 112, 100);

/// The crossings within `clip`.
pub(super) fn draw(
    painter: &egui::Painter,
    rect: Rect,
    side: f32,
    matrix: &WeaveMatrix,
    clip: Rect,
) {
    painter.rect_filled(rect, 0.0, GROUND);
    let first = ((clip.min - rect.min) / side).max(vec2(0.0, 0.0));
    let last = (clip.max - rect.min) / side;
    for p in first.y as usize..matrix.picks().min(last.y.max(0.0) as usize + 1) {
        for e in first.x as usize..matrix.ends().min(last.x.max(0.0) as usize + 1) {
            let corner = rect.min + vec2(e as f32, p as f32) * side;
            let cell = Rect::from_min_size(corner, vec2(side - 1.0, side - 1.0));
            let colour = if matrix.warp_up(e, p) { WARP } else { WEFT };
            painter.rect_filled(cell, 0.0, colour);
        }
    }
}

/// The cloth that the weave gives, with its floats.
pub(super) fn preview(ui: &mut Ui, matrix: &WeaveMatrix) {
    ui.add_space(4.0);
    let side = 8.0;
    let across = ((ui.available_width() / side) as usize).clamp(8, 48);
    let down = 20;
    let size = vec2(side * across as f32, side * down as f32);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    response.on_hover_text("The cloth from the face: warp dark, weft light. Long bars are floats.");
    let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
    painter.rect_filled(rect, 0.0, GROUND);
    for p in 0..down {
        for e in 0..across {
            let corner = rect.min + vec2(e as f32, p as f32) * side;
            // A yarn on top reaches over the gap to the next crossing where it stays on top.
            let up = matrix.warp_up(e, p);
            let floats_on = match up {
                true => matrix.warp_up(e, p + 1),
                false => !matrix.warp_up(e + 1, p),
            };
            let long = if floats_on { side } else { side - 1.5 };
            let thick = side - 2.0;
            let (size, colour) = match up {
                true => (vec2(thick, long), WARP),
                false => (vec2(long, thick), WEFT),
            };
            let yarn = Rect::from_min_size(pos2(corner.x + 0.5, corner.y + 0.5), size);
            painter.rect_filled(yarn, 0.0, colour);
        }
    }
}
