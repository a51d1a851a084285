//! The gallery: the scenarios that come with the program, with pictures.

use bevy_egui::egui::{self, ColorImage, TextureOptions, vec2};
use include_dir::{Dir, include_dir};

use super::files::Wanted;
use super::state::Watch;
use crate::scenario::bundled;

static THUMBNAILS: Dir = include_dir!("$CARGO_MANIFEST_DIR/assets/thumbnails");

/// Width and height of a picture in the gallery, points.
const SIZE: egui::Vec2 = vec2(132.0, 99.0);

/// The bytes of a scenario's picture.
pub fn thumbnail(name: &str) -> Option<&'static [u8]> {
    THUMBNAILS
        .get_file(format!("{name}.jpg"))
        .map(include_dir::File::contents)
}

/// The title of a scenario, from its text.
pub fn title(text: &str) -> &str {
    let after = text.split_once("title: \"").map(|(_, after)| after);
    after
        .and_then(|after| after.split_once('"'))
        .map_or("", |(title, _)| title)
}

/// What the comment at the top of a scenario says.
pub fn about(text: &str) -> String {
    let lines = text.lines().map_while(|line| line.strip_prefix("//"));
    lines.map(str::trim).collect::<Vec<_>>().join(" ")
}

/// Shows the gallery, if it is open.
pub fn show(ctx: &egui::Context, watch: &mut Watch) {
    if !watch.open.gallery {
        return;
    }
    let mut open = true;
    let mut chosen = None;
    let screen = ctx.content_rect().size();
    egui::Window::new("Gallery")
        .open(&mut open)
        .collapsible(false)
        .resizable(true)
        .default_size(vec2((0.8 * screen.x).min(900.0), 0.75 * screen.y))
        .anchor(egui::Align2::CENTER_CENTER, vec2(0.0, 0.0))
        .show(ctx, |ui| {
            ui.horizontal(|ui| {
                ui.label("Choose a cloth, or drop a .ron, .wif or picture on the window.");
                if ui.button("Open a file…").clicked() {
                    chosen = Some(None);
                }
            });
            ui.separator();
            egui::ScrollArea::vertical()
                .auto_shrink([false, false])
                .show(ui, |ui| {
                    ui.horizontal_wrapped(|ui| {
                        let mut all: Vec<_> = bundled().collect();
                        all.sort_by_key(|scenario| scenario.name);
                        for scenario in all {
                            if card(ui, watch, scenario.name, scenario.text) {
                                chosen = Some(Some(scenario.name));
                            }
                        }
                    });
                });
        });
    match chosen {
        Some(Some(name)) => {
            watch.open.gallery = false;
            watch.leave_for(super::dialogs::Leaving::Open(name.into()));
        }
        Some(None) => {
            watch.open.gallery = false;
            watch.files.ask(Wanted::Open, "");
        }
        None if !open => watch.open.gallery = false,
        None => {}
    }
}

/// A scenario's picture and name; whether it was clicked.
fn card(ui: &mut egui::Ui, watch: &mut Watch, name: &'static str, text: &'static str) -> bool {
    let texture = watch.thumbnails.get(name).cloned().or_else(|| {
        let picture = image::load_from_memory(thumbnail(name)?).ok()?.to_rgb8();
        let size = [picture.width() as usize, picture.height() as usize];
        let picture = ColorImage::from_rgb(size, picture.as_raw());
        let texture = ui.ctx().load_texture(name, picture, TextureOptions::LINEAR);
        watch.thumbnails.insert(name, texture.clone());
        Some(texture)
    });
    let mut clicked = false;
    ui.allocate_ui(SIZE + vec2(0.0, 24.0), |ui| {
        ui.vertical(|ui| {
            ui.set_width(SIZE.x);
            let response = match texture {
                Some(texture) => ui.add(
                    egui::Button::image(
                        egui::Image::new(&texture).fit_to_exact_size(SIZE - vec2(12.0, 6.0)),
                    )
                    .min_size(SIZE),
                ),
                None => ui.add_sized(SIZE, egui::Button::new(name)),
            };
            let tip = format!("{}\n\n{}", title(text), about(text));
            clicked = response.on_hover_text(tip).clicked();
            ui.add(egui::Label::new(egui::RichText::new(name).small()).truncate());
        });
    });
    clicked
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bundled_scenario_has_a_picture_a_title_and_something_to_say() {
        for scenario in bundled() {
            let picture = thumbnail(scenario.name);
            let picture = picture.unwrap_or_else(|| {
                panic!(
                    "{} has no thumbnail: cargo run --release --example draw_thumbnails",
                    scenario.name
                )
            });
            let picture = image::load_from_memory(picture).unwrap();
            assert!(picture.width() >= 160, "{}", scenario.name);
            assert!(!title(scenario.text).is_empty());
            assert!(about(scenario.text).len() > 30, "{}", scenario.name);
        }
    }
}
