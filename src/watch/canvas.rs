//! The cloth itself in the window, flat and draped, and what the pointer does on it.

use bevy::math::{DVec3, UVec2};
use bevy_egui::egui::{
    self, Color32, PointerButton, Pos2, Rect, Response, Sense, Stroke, Ui, pos2, vec2,
};

use super::hanger::{Deed, Place};
use super::layout::Textures;
use super::state::Watch;
use super::tools::{FlatView, Kind, Tool, wanted_scale};
use super::view3d::{Hit, View3d, hit};
use super::worker::Order;
use crate::drape::spec::{CreaseSpec, Fold, Hold, PinSpec};
use crate::scenario::Draping;
use crate::scenario::check::Checker;
use crate::studio::hung::spec_of;

const WHOLE: Rect = Rect {
    min: Pos2::ZERO,
    max: Pos2::new(1.0, 1.0),
};

/// The flat cloth.
pub fn flat(ui: &mut Ui, space: Rect, watch: &mut Watch, textures: Textures) {
    let response = ui.allocate_rect(space, Sense::click_and_drag());
    let Some(cells) = watch.seen.as_ref().map(|seen| seen.cells) else {
        ui.painter_at(space).text(
            space.center(),
            egui::Align2::CENTER_CENTER,
            "weaving…",
            egui::FontId::proportional(16.0),
            ui.visuals().weak_text_color(),
        );
        return;
    };
    watch.tools.flat = zoomed_and_moved(ui, &response, watch, space, cells);
    let rect = watch.tools.flat.rect(space, cells);
    let painter = ui.painter_at(space);
    if let Some(texture) = textures.flat {
        painter.image(texture, rect, WHOLE, Color32::WHITE);
    }
    let overlay = watch.seen.as_ref().and_then(|seen| seen.overlay.clone());
    if let (Some(texture), Some(overlay)) = (textures.over, &overlay)
        && watch.tools.overlay.is_some()
    {
        painter.image(texture, rect, WHOLE, Color32::from_white_alpha(235));
        legend(&painter, space, overlay);
    }
    use_flat(ui, &response, watch, space, cells);
    marks(&painter, watch, rect, cells);
    let zoom = watch.tools.flat.zoom_in(space, cells);
    let wanted = wanted_scale(zoom * ui.ctx().pixels_per_point(), cells);
    if wanted != watch.tools.scale {
        watch.tools.scale = wanted;
        watch.worker.order(Order::Scale(wanted));
    }
    let mm = f64::from(1.0 / zoom) * 100.0 * watch.edit.cloth.cell_mm;
    ruler(&painter, space, mm);
    if let Some(at) = response
        .hover_pos()
        .filter(|_| watch.tools.tool != Tool::Brush)
    {
        tell_place(&painter, watch, space, at, cells);
    }
}

fn zoomed_and_moved(
    ui: &Ui,
    response: &Response,
    watch: &Watch,
    space: Rect,
    cells: (usize, usize),
) -> FlatView {
    let mut view = watch.tools.flat;
    if let Some(at) = response.hover_pos() {
        let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta.y, input.zoom_delta()));
        let factor = libm::expf(scroll * 0.004) * pinch;
        if factor != 1.0 {
            view = view.zoomed(factor, at, space, cells);
        }
    }
    let looks = matches!(
        watch.tools.tool,
        Tool::Look | Tool::Hand | Tool::Pin | Tool::Crease
    );
    let moves = response.dragged_by(PointerButton::Middle)
        || response.dragged_by(PointerButton::Secondary)
        || (looks && response.dragged_by(PointerButton::Primary));
    if moves {
        view = view.moved(response.drag_delta(), space, cells);
    }
    if response.double_clicked() && watch.tools.tool == Tool::Look {
        view = FlatView::default();
    }
    view
}

/// Brush and section on the flat cloth.
fn use_flat(ui: &Ui, response: &Response, watch: &mut Watch, space: Rect, cells: (usize, usize)) {
    let view = watch.tools.flat;
    let pointer = response.interact_pointer_pos().or(response.hover_pos());
    let Some(place) = pointer.map(|at| view.place(at, space, cells)) else {
        return;
    };
    let down = ui.input(|input| input.pointer.primary_down());
    match watch.tools.tool {
        Tool::Brush => {
            paint_on(response, watch, Some(place), cells);
        }
        Tool::Cut => {
            if response.drag_started_by(PointerButton::Primary) {
                let origin = ui.input(|input| input.pointer.press_origin());
                let from = origin.map_or(place, |at| view.place(at, space, cells));
                watch.tools.from = Some(from);
            }
            if let (Some(from), true) = (watch.tools.from, response.dragged() && down) {
                let cut = Some((from, place));
                if watch.tools.cut != cut {
                    watch.tools.cut = cut;
                    watch.settings.plots = true;
                    watch.worker.order(Order::Cut(cut));
                }
            }
            if response.drag_stopped_by(PointerButton::Primary) {
                watch.tools.from = None;
            }
        }
        _ => {}
    }
}

/// Paints: collects the path while the button is down, and orders the stroke when it is let go.
fn paint_on(response: &Response, watch: &mut Watch, place: Option<Place>, cells: (usize, usize)) {
    let down = response.ctx.input(|input| input.pointer.primary_down());
    let primary = response.clicked() || (down && response.is_pointer_button_down_on());
    if let Some(place) = place.filter(|_| primary)
        && watch.tools.path.last() != Some(&place)
    {
        watch.tools.path.push(place);
    }
    let ends = response.drag_stopped_by(PointerButton::Primary) || response.clicked();
    if ends {
        end_stroke(watch, cells);
    }
}

/// Orders the stroke that was painted, if there is one.
fn end_stroke(watch: &mut Watch, cells: (usize, usize)) {
    let path = std::mem::take(&mut watch.tools.path);
    if path.is_empty() {
        return;
    }
    let brush = watch.tools.brush;
    let stroke = brush.stroke(&path, cells);
    watch.order_edit(Order::Paint(brush.paint(), stroke));
}

/// Whether a brush has left the cloth, or come over a fold to a place that is far along it: a stroke ends
/// there.
fn is_over_edge(watch: &Watch, place: Option<Place>, (nx, ny): (usize, usize)) -> bool {
    let Some((lx, ly)) = watch.tools.path.last() else {
        return false;
    };
    let far = 6.0 * watch.tools.brush.cells((nx, ny)) + 0.1 * nx.max(ny) as f64;
    place.is_none_or(|(x, y)| libm::hypot((x - lx) * nx as f64, (y - ly) * ny as f64) > far)
}

/// What is being drawn on the flat cloth.
fn marks(painter: &egui::Painter, watch: &Watch, rect: Rect, cells: (usize, usize)) {
    let point = |(x, y): Place| rect.min + vec2(x as f32 * rect.width(), y as f32 * rect.height());
    if let Some((from, to)) = watch.tools.cut {
        let line = [point(from), point(to)];
        painter.line_segment(line, Stroke::new(3.0, Color32::from_black_alpha(140)));
        painter.line_segment(line, Stroke::new(1.5, Color32::from_rgb(255, 200, 60)));
    }
    let radius = watch.tools.brush.cells(cells) as f32 * rect.width() / cells.0 as f32;
    let colour = brush_colour(watch.tools.brush.kind);
    for pair in watch.tools.path.windows(2) {
        let line = [point(pair[0]), point(pair[1])];
        painter.line_segment(line, Stroke::new(2.0 * radius, colour));
    }
    for place in watch.tools.path.iter().take(1) {
        painter.circle_filled(point(*place), radius, colour);
    }
    if watch.tools.tool == Tool::Brush
        && let Some(at) = painter.ctx().pointer_hover_pos()
        && painter.clip_rect().contains(at)
    {
        painter.circle_stroke(at, radius, Stroke::new(2.5, Color32::from_black_alpha(120)));
        painter.circle_stroke(at, radius, Stroke::new(1.0, Color32::WHITE));
    }
}

fn brush_colour(kind: Kind) -> Color32 {
    match kind {
        Kind::Dye => Color32::from_rgba_unmultiplied(40, 70, 160, 150),
        Kind::Resist => Color32::from_rgba_unmultiplied(240, 240, 240, 150),
        Kind::Wax => Color32::from_rgba_unmultiplied(230, 200, 110, 150),
    }
}

/// The colours of the field over the cloth.
fn legend(painter: &egui::Painter, space: Rect, overlay: &crate::session::overlay::Overlay) {
    let stops = overlay.stops();
    let size = vec2(14.0, 130.0);
    let title = format!("{}\n{}", overlay.field.name(), overlay.field.unit());
    let galley = painter.layout_no_wrap(title, egui::FontId::proportional(12.0), Color32::WHITE);
    let width = (galley.size().x + 16.0).max(90.0);
    let place = Rect::from_min_size(
        space.left_top() + vec2(8.0, 8.0),
        vec2(width, size.y + galley.size().y + 26.0),
    );
    painter.rect_filled(place, 4.0, Color32::from_black_alpha(190));
    painter.galley(place.min + vec2(8.0, 6.0), galley.clone(), Color32::WHITE);
    let bar = Rect::from_min_size(place.min + vec2(8.0, galley.size().y + 14.0), size);
    let mut mesh = egui::Mesh::default();
    let colour = |[r, g, b]: [u8; 3]| Color32::from_rgb(r, g, b);
    for (i, stop) in stops.iter().enumerate() {
        let y = bar.bottom() - stop.at * bar.height();
        mesh.colored_vertex(pos2(bar.left(), y), colour(stop.colour));
        mesh.colored_vertex(pos2(bar.right(), y), colour(stop.colour));
        if i > 0 {
            let a = 2 * i as u32 - 2;
            mesh.add_triangle(a, a + 1, a + 2);
            mesh.add_triangle(a + 1, a + 2, a + 3);
        }
        painter.text(
            pos2(bar.right() + 6.0, y),
            egui::Align2::LEFT_CENTER,
            format!("{:.3}", stop.value)
                .trim_end_matches('0')
                .trim_end_matches('.'),
            egui::FontId::proportional(11.0),
            Color32::WHITE,
        );
    }
    painter.add(mesh);
}

/// How long something on the cloth is: `mm` is the length of 100 points.
fn ruler(painter: &egui::Painter, space: Rect, mm: f64) {
    if !mm.is_finite() || mm <= 0.0 {
        return;
    }
    let size = libm::pow(10.0, libm::log10(mm).floor());
    let length = [5.0, 2.0, 1.0]
        .into_iter()
        .map(|n| n * size)
        .find(|l| *l <= mm);
    let length = length.unwrap_or(size);
    let points = (100.0 * length / mm) as f32;
    let right = space.right_bottom() + vec2(-12.0, -12.0);
    let left = right - vec2(points, 0.0);
    let text = match length {
        l if l >= 10.0 => format!("{} cm", l / 10.0),
        l if l >= 0.999 => format!("{l} mm"),
        l => format!("{} µm", (1000.0 * l).round()),
    };
    for (width, colour) in [(4.0, Color32::from_black_alpha(150)), (2.0, Color32::WHITE)] {
        painter.line_segment([left, right], Stroke::new(width, colour));
    }
    let middle = left + 0.5 * (right - left) + vec2(0.0, -4.0);
    let font = egui::FontId::proportional(11.0);
    painter.text(
        middle + vec2(1.0, 1.0),
        egui::Align2::CENTER_BOTTOM,
        &text,
        font.clone(),
        Color32::BLACK,
    );
    painter.text(
        middle,
        egui::Align2::CENTER_BOTTOM,
        text,
        font,
        Color32::WHITE,
    );
}

/// Says which cell is under the pointer, and the value of the field there.
fn tell_place(
    painter: &egui::Painter,
    watch: &Watch,
    space: Rect,
    at: Pos2,
    cells: (usize, usize),
) {
    let (x, y) = watch.tools.flat.place(at, space, cells);
    if !(0.0..1.0).contains(&x) || !(0.0..1.0).contains(&y) {
        return;
    }
    let (cx, cy) = ((x * cells.0 as f64) as usize, (y * cells.1 as f64) as usize);
    let mm = watch.edit.cloth.cell_mm;
    let mut text = format!("{:.2}, {:.2} mm", cx as f64 * mm, cy as f64 * mm);
    let overlay = watch.seen.as_ref().and_then(|seen| seen.overlay.as_ref());
    if let Some(overlay) = overlay.filter(|_| watch.tools.overlay.is_some()) {
        let value = overlay.values.get(cy * overlay.nx + cx).copied();
        if let Some(value) = value.filter(|value| value.is_finite()) {
            text = format!("{text}   {} {value:.3}", overlay.field.name());
        }
    }
    let font = egui::FontId::proportional(11.0);
    let galley = painter.layout_no_wrap(text, font, Color32::WHITE);
    let corner = space.left_bottom() + vec2(8.0, -10.0 - galley.size().y);
    let back = Rect::from_min_size(corner, galley.size()).expand(3.0);
    painter.rect_filled(back, 3.0, Color32::from_black_alpha(170));
    painter.galley(corner, galley, Color32::WHITE);
}

/// The draped cloth.
pub fn draped(ui: &mut Ui, space: Rect, watch: &mut Watch, view: &mut View3d, textures: Textures) {
    let response = ui.allocate_rect(space, Sense::click_and_drag());
    let points = ui.ctx().pixels_per_point() * view.share;
    let size = UVec2::new(
        (space.width() * points).round().max(16.0) as u32,
        (space.height() * points).round().max(16.0) as u32,
    );
    if size != view.size {
        view.size = size;
        if !view.moved_by_hand {
            view.reset(&watch.edit.view);
        }
    }
    let painter = ui.painter_at(space);
    if let Some(texture) = textures.studio {
        painter.image(texture, space, WHOLE, Color32::WHITE);
    }
    if response.hovered() {
        let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta.y, input.zoom_delta()));
        let factor = libm::expf(scroll * 0.003) * pinch;
        if factor != 1.0 {
            view.eye = view.eye.nearer(f64::from(factor));
            view.moved_by_hand = true;
        }
    }
    let looks = watch.tools.tool == Tool::Look || watch.tools.tool == Tool::Cut;
    let drag = response.drag_delta();
    let shift = ui.input(|input| input.modifiers.shift);
    let primary = looks && response.dragged_by(PointerButton::Primary);
    let pans = response.dragged_by(PointerButton::Middle) || (primary && shift);
    let turns = response.dragged_by(PointerButton::Secondary) || (primary && !shift);
    if pans && drag != egui::Vec2::ZERO {
        view.eye = view
            .eye
            .shifted((drag.x, drag.y), space.height(), view.field_of_view);
        view.moved_by_hand = true;
    } else if turns && drag != egui::Vec2::ZERO {
        view.eye = view.eye.turned((drag.x, drag.y));
        view.moved_by_hand = true;
    }
    if response.double_clicked() && looks {
        view.reset(&watch.edit.view);
    }
    use_draped(ui, &response, watch, view, space);
    marks_in_space(&painter, watch, view, space);
}

/// The ray under a point.
fn ray(view: &View3d, space: Rect, at: Pos2) -> (DVec3, DVec3) {
    let off = at - space.min;
    let share = (
        f64::from(off.x / space.width()),
        f64::from(off.y / space.height()),
    );
    view.eye.ray(share, view.opening())
}

fn hit_at(watch: &Watch, view: &View3d, space: Rect, at: Pos2) -> Option<Hit> {
    let (from, way) = ray(view, space, at);
    hit(&watch.moment.as_ref()?.front, from, way)
}

/// Hand, pin, crease and brush on the draped cloth.
fn use_draped(ui: &Ui, response: &Response, watch: &mut Watch, view: &View3d, space: Rect) {
    let Some(at) = response.interact_pointer_pos().or(response.hover_pos()) else {
        return;
    };
    let origin = ui.input(|input| input.pointer.press_origin()).unwrap_or(at);
    let pressed = response.drag_started_by(PointerButton::Primary);
    let dragged = response.dragged_by(PointerButton::Primary);
    match watch.tools.tool {
        Tool::Hand => {
            if pressed && let Some(hit) = hit_at(watch, view, space, origin) {
                watch.tools.held = Some((hit.uv, hit.place));
                watch.hanger.act(Deed::Hold(hit.uv, hit.place));
            }
            if let (Some((uv, place)), true) = (watch.tools.held, dragged) {
                // In the plane through the hand that faces the camera.
                let (from, way) = ray(view, space, at);
                let out = view.eye.out();
                let along = (place - from).dot(out) / way.dot(out);
                watch.hanger.act(Deed::Hold(uv, from + along * way));
            }
            if response.drag_stopped_by(PointerButton::Primary) && watch.tools.held.take().is_some()
            {
                watch.hanger.act(Deed::LetGo);
            }
        }
        Tool::Pin => {
            if response.clicked()
                && let Some(hit) = hit_at(watch, view, space, at)
            {
                pin(watch, hit);
            }
        }
        Tool::Crease => {
            if pressed && let Some(hit) = hit_at(watch, view, space, origin) {
                watch.tools.from = Some(hit.uv);
                watch.tools.to = Some(hit.uv);
            }
            if watch.tools.from.is_some()
                && dragged
                && let Some(hit) = hit_at(watch, view, space, at)
            {
                watch.tools.to = Some(hit.uv);
            }
            if response.drag_stopped_by(PointerButton::Primary)
                && let (Some(from), Some(to)) = (watch.tools.from.take(), watch.tools.to.take())
            {
                crease(watch, from, to);
            }
        }
        Tool::Brush => {
            let cells = watch.seen.as_ref().map_or((1, 1), |seen| seen.cells);
            let place = hit_at(watch, view, space, at).map(|hit| hit.uv);
            if is_over_edge(watch, place, cells) {
                end_stroke(watch, cells);
            }
            paint_on(response, watch, place, cells);
        }
        Tool::Look | Tool::Cut => {}
    }
}

fn rounded((x, y): Place) -> Place {
    let rounded = |v: f64| (1e4 * v.clamp(0.0, 1.0)).round() / 1e4;
    (rounded(x), rounded(y))
}

/// Changes the drape of the scenario in the way in which the hanging cloth was changed already.
pub fn also_in_scenario(
    watch: &mut Watch,
    label: &str,
    change: impl FnOnce(&mut crate::drape::spec::DrapeSpec),
) {
    if watch.must_wait() {
        watch.tell("wait until the last change is done");
        return;
    }
    let Ok(mut spec) = spec_of(&watch.edit, None) else {
        return;
    };
    change(&mut spec);
    if let Err(why) = spec.check(&Checker::root().field("drape")) {
        watch.problem = Some(why.to_string());
        return;
    }
    watch.edit.drape = Some(Draping::Own(Box::new(spec)));
    watch.hangs_already();
    watch.send_edit(label, false);
}

/// Presses a crease into the cloth, and into the scenario.
pub fn crease(watch: &mut Watch, from: Place, to: Place) {
    let (from, to) = (rounded(from), rounded(to));
    if libm::hypot(from.0 - to.0, from.1 - to.1) < 0.01 {
        return;
    }
    let fold = if watch.tools.valley {
        Fold::Valley
    } else {
        Fold::Mountain
    };
    let angle = 110.0;
    let signed = if watch.tools.valley { -angle } else { angle };
    watch.hanger.act(Deed::Crease(from, to, signed));
    also_in_scenario(watch, "crease", |spec| {
        spec.creases.push(CreaseSpec {
            from,
            to,
            fold,
            angle,
            stiffness: None,
        });
    });
}

/// Pins the cloth where it was clicked, or takes the pin off.
pub fn pin(watch: &mut Watch, hit: Hit) {
    let place = rounded(hit.uv);
    let time = watch.moment.as_ref().map_or(0.0, |moment| moment.time);
    let near = |moment: &super::hanger::Moment| {
        moment
            .pinned
            .iter()
            .any(|pinned| pinned.distance(hit.place) < super::hanger::NEAR_PIN)
    };
    let takes_off = watch.moment.as_ref().is_some_and(near);
    watch.hanger.act(Deed::Pin(place));
    also_in_scenario(
        watch,
        if takes_off { "take a pin off" } else { "pin" },
        |spec| {
            let close = |pin: &PinSpec| match pin.at {
                Hold::Point(u, v) => libm::hypot(u - place.0, v - place.1) < 0.02,
                _ => false,
            };
            if takes_off {
                spec.pins.retain(|pin| !close(pin));
            } else {
                spec.pins.push(PinSpec {
                    at: Hold::Point(place.0, place.1),
                    radius_m: 0.002,
                    // While it settles: a recording has it from the first frame on.
                    from_s: ((100.0 * time).round() / 100.0).min(spec.settle_s),
                    until_s: None,
                    path: Vec::new(),
                });
            }
        },
    );
}

/// Where a place in space is on the picture of the studio.
fn seen_at(view: &View3d, space: Rect, place: DVec3) -> Option<Pos2> {
    let out = view.eye.out();
    let right = DVec3::Y.cross(out).normalize_or(DVec3::X);
    let up = out.cross(right);
    let from = place - (view.eye.at + view.eye.distance * out);
    let depth = -from.dot(out);
    let opening = view.opening();
    (depth > 0.0).then(|| {
        let x = from.dot(right) / depth / opening.across;
        let y = from.dot(up) / depth / opening.up;
        space.center() + 0.5 * vec2(x as f32 * space.width(), -y as f32 * space.height())
    })
}

/// Where a place on the cloth is in space, m.
pub fn on_cloth(watch: &Watch, (u, v): Place) -> Option<DVec3> {
    let front = &watch.moment.as_ref()?.front;
    let nearest = |i: &usize| {
        let uv = front.uv[*i];
        uv.distance_squared(bevy::math::DVec2::new(u, v))
    };
    let all = 0..front.positions.len();
    let best = all.min_by(|a, b| nearest(a).total_cmp(&nearest(b)))?;
    Some(front.positions[best])
}

/// Pins, the hand, and the line of a crease that is being drawn.
fn marks_in_space(painter: &egui::Painter, watch: &Watch, view: &View3d, space: Rect) {
    let Some(moment) = &watch.moment else { return };
    for pinned in &moment.pinned {
        if let Some(at) = seen_at(view, space, *pinned) {
            painter.circle_filled(at, 5.0, Color32::from_rgb(214, 60, 52));
            painter.circle_stroke(at, 5.0, Stroke::new(1.0, Color32::WHITE));
        }
    }
    if let (Some(from), Some(to)) = (watch.tools.from, watch.tools.to)
        && watch.tools.tool == Tool::Crease
    {
        let ends =
            [from, to].map(|place| on_cloth(watch, place).and_then(|p| seen_at(view, space, p)));
        if let [Some(from), Some(to)] = ends {
            painter.line_segment([from, to], Stroke::new(3.0, Color32::from_black_alpha(140)));
            painter.line_segment(
                [from, to],
                Stroke::new(1.5, Color32::from_rgb(255, 200, 60)),
            );
        }
    }
    if let Some((uv, _)) = watch.tools.held
        && let Some(at) = on_cloth(watch, uv).and_then(|p| seen_at(view, space, p))
    {
        painter.circle_stroke(at, 8.0, Stroke::new(2.0, Color32::from_rgb(255, 200, 60)));
    }
    if watch.tools.tool == Tool::Brush {
        for place in &watch.tools.path {
            if let Some(at) = on_cloth(watch, *place).and_then(|p| seen_at(view, space, p)) {
                painter.circle_filled(at, 3.0, brush_colour(watch.tools.brush.kind));
            }
        }
    }
}
