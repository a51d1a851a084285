//! Where everything is in the window.

use bevy::prelude::*;
use bevy_egui::EguiContexts;
use bevy_egui::egui::{self, Ui, UiBuilder};

use super::settings::Layout;
use super::state::Watch;
use super::view3d::View3d;
use super::{bars, canvas, dialogs, gallery, keys, panel, plots};

/// The textures that the panel shows pictures of the cloth with.
#[derive(Debug, Clone, Copy)]
pub struct Textures {
    /// The flat cloth.
    pub flat: Option<egui::TextureId>,
    /// The field over it.
    pub over: Option<egui::TextureId>,
    /// The studio.
    pub studio: Option<egui::TextureId>,
}

/// Draws the window. It may run twice a frame: it changes what the window knows and gives orders, and
/// advances nothing.
pub fn draw(
    mut contexts: EguiContexts,
    mut watch: ResMut<Watch>,
    mut view: ResMut<View3d>,
    mut is_set_up: Local<bool>,
) -> Result {
    let textures = Textures {
        flat: contexts.image_id(&watch.flat),
        over: contexts.image_id(&watch.over),
        studio: contexts.image_id(&view.image),
    };
    let ctx = contexts.ctx_mut()?.clone();
    if !*is_set_up {
        style(&ctx);
        *is_set_up = true;
    }
    if (ctx.zoom_factor() - watch.settings.zoom).abs() > 1e-3 {
        ctx.set_zoom_factor(watch.settings.zoom);
    }
    let mut root = Ui::new(
        ctx.clone(),
        "root".into(),
        UiBuilder::new()
            .layer_id(egui::LayerId::background())
            .max_rect(ctx.viewport_rect()),
    );
    let watch = &mut *watch;
    keys::act(&ctx, watch, &mut view);
    bars::top(&mut root, watch, &mut view);
    bars::bottom(&mut root, watch);
    side(&mut root, watch);
    if watch.settings.plots {
        plots::panel(&mut root, watch);
    }
    middle(&mut root, watch, &mut view, textures);
    gallery::show(&ctx, watch);
    dialogs::show(&ctx, watch);
    Ok(())
}

/// Colours and distances.
fn style(ctx: &egui::Context) {
    ctx.set_theme(egui::Theme::Dark);
    ctx.all_styles_mut(|style| {
        style.spacing.item_spacing = egui::vec2(6.0, 4.0);
        style.spacing.button_padding = egui::vec2(6.0, 3.0);
        style.interaction.tooltip_delay = 0.35;
    });
}

/// The parameters.
fn side(root: &mut Ui, watch: &mut Watch) {
    if !watch.settings.panel {
        return;
    }
    egui::Panel::left("parameters")
        .resizable(true)
        .default_size(312.0)
        .size_range(290.0..=520.0)
        .show(root, |ui| {
            ui.add_space(2.0);
            ui.horizontal(|ui| {
                ui.selectable_value(&mut watch.weaves, false, "Parameters");
                ui.selectable_value(&mut watch.weaves, true, "Weave editor")
                    .on_hover_text("Click the crossings, choose a weave, load a draft");
            });
            ui.separator();
            if watch.must_wait() {
                ui.disable();
            }
            let change = match watch.weaves {
                true => panel::weave(ui, &mut watch.edit, &mut watch.panel),
                false => panel::parameters(ui, &mut watch.edit, &mut watch.panel),
            };
            if let Some(change) = change {
                watch.held = change.held;
                watch.send_edit(&change.label, change.held);
            }
        });
    if watch.held && !root.ctx().input(|input| input.pointer.any_down()) {
        watch.held = false;
        watch.worker.order(super::worker::Order::Release);
    }
    if let Some(ask) = watch.panel.take_ask() {
        let name = watch.name.clone();
        watch.files.ask(super::files::Wanted::Panel(ask), &name);
    }
}

/// The cloth, flat and draped.
fn middle(root: &mut Ui, watch: &mut Watch, view: &mut View3d, textures: Textures) {
    let frame = egui::Frame::new().fill(egui::Color32::from_gray(22));
    egui::CentralPanel::no_frame()
        .frame(frame)
        .show(root, |ui| {
            problem(ui, watch);
            let space = ui.available_rect_before_wrap();
            view.is_shown = watch.settings.layout != Layout::Flat;
            match watch.settings.layout {
                Layout::Flat => canvas::flat(ui, space, watch, textures),
                Layout::Draped => canvas::draped(ui, space, watch, view, textures),
                Layout::Both => {
                    let (left, right) = space.split_left_right_at_fraction(0.5);
                    canvas::flat(ui, left.shrink2(egui::vec2(0.5, 0.0)), watch, textures);
                    canvas::draped(
                        ui,
                        right.shrink2(egui::vec2(0.5, 0.0)),
                        watch,
                        view,
                        textures,
                    );
                }
            }
        });
}

/// What is wrong, with line and caret where it is in a file; the last good cloth stays below.
fn problem(ui: &mut Ui, watch: &mut Watch) {
    let Some(problem) = watch.problem.clone() else {
        return;
    };
    let frame = egui::Frame::new()
        .fill(egui::Color32::from_rgb(70, 26, 22))
        .inner_margin(8);
    egui::Panel::top("problem").frame(frame).show(ui, |ui| {
        ui.horizontal_top(|ui| {
            if ui
                .button("✖")
                .on_hover_text("Put this message away")
                .clicked()
            {
                watch.problem = None;
            }
            egui::ScrollArea::both().max_height(140.0).show(ui, |ui| {
                let text = egui::RichText::new(problem).monospace();
                ui.add(
                    egui::Label::new(text.color(egui::Color32::from_rgb(255, 214, 204))).extend(),
                );
            });
        });
    });
}
