//! Windows that ask: what to record, whether to leave; and the one that shows the keys.

use std::path::PathBuf;

use bevy_egui::egui::{self, vec2};

use super::files::{Dropped, Wanted, kind_of};
use super::keys::KEYS;
use super::panel;
use super::recording::{Ended, Running};
use super::state::{Then, Watch};
use super::worker::Order;
use crate::pattern::{Fit, Pattern};
use crate::record::{Options, View, ffmpeg_is_there};

/// What is to be done if the changes need not be saved.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Leaving {
    /// Open another scenario.
    Open(String),
    /// Close the window.
    Close,
}

/// What is to be recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordForm {
    /// The folder.
    pub folder: String,
    /// Frames.
    pub frames: u32,
    /// Draped or flat.
    pub draped: bool,
    /// A film as well.
    pub video: bool,
    /// Replace what is there.
    pub force: bool,
}

/// Shows the windows that are open.
pub fn show(ctx: &egui::Context, watch: &mut Watch) {
    keys(ctx, watch);
    record(ctx, watch);
    recorded(ctx, watch);
    leave(ctx, watch);
    if let Some((wanted, path)) = watch.files.show(ctx) {
        chosen(watch, wanted, path);
    }
}

/// A file has been chosen.
fn chosen(watch: &mut Watch, wanted: Wanted, path: PathBuf) {
    match wanted {
        Wanted::Open => watch.leave_for(Leaving::Open(path.display().to_string())),
        Wanted::SaveAs => watch.save_to(path),
        Wanted::RecordTo => {
            if let Some(form) = &mut watch.record_form {
                form.folder = path.display().to_string();
            }
            watch.open.record = true;
        }
        Wanted::Panel(ask) => {
            let change = panel::answer(&mut watch.edit, &ask, &absolute(path));
            watch.send_edit(&change.label, change.held);
        }
    }
}

/// A path that means the same wherever the scenario lies.
fn absolute(path: PathBuf) -> String {
    path.canonicalize().unwrap_or(path).display().to_string()
}

/// A file was dropped on the window.
pub fn dropped(watch: &mut Watch, path: PathBuf) {
    match kind_of(&path) {
        Dropped::Scenario => watch.leave_for(Leaving::Open(path.display().to_string())),
        Dropped::Draft => {
            let change = panel::answer(&mut watch.edit, &panel::PanelAsk::OpenWif, &absolute(path));
            watch.send_edit(&change.label, change.held);
        }
        Dropped::Picture => {
            watch.edit.resist = Pattern::Image {
                file: absolute(path),
                fit: Fit::Stretch,
            };
            watch.send_edit("resist from a picture", false);
            watch.tell("the picture is resist now: dark keeps dye out");
        }
        Dropped::Unknown => {
            watch.problem = Some(format!(
                "{} is neither a scenario (.ron), a draft (.wif) nor a picture (.png, .jpg)",
                path.display()
            ))
        }
    }
}

impl Watch {
    /// Leaves this scenario, after asking if there are changes.
    pub fn leave_for(&mut self, leaving: Leaving) {
        if self.unsaved {
            self.leaving = Some(leaving);
        } else {
            self.go(leaving);
        }
    }

    /// Leaves this scenario.
    pub fn go(&mut self, leaving: Leaving) {
        self.leaving = None;
        self.changed_on_disk = false;
        match leaving {
            Leaving::Open(name) => self.open(&name),
            Leaving::Close => {
                self.unsaved = false;
                self.closing = true;
            }
        }
    }

    /// Begins to record.
    ///
    /// # Errors
    /// What stands in the way.
    pub fn start_recording(&mut self, form: &RecordForm) -> Result<(), String> {
        if !self.is_in_step() {
            self.then.push(Then::Record(form.clone()));
            return Ok(());
        }
        let experiment = self.as_saved()?;
        let options = Options {
            out: form.folder.clone().into(),
            frames: Some(form.frames),
            video: form.video,
            force: form.force,
            view: if form.draped {
                View::Draped
            } else {
                View::Flat
            },
            ..Options::default()
        };
        self.recorded = None;
        // The process and the recorder share the machine.
        self.worker.order(Order::Play(false));
        let running = Running::start(experiment, options).map_err(|why| why.to_string())?;
        self.recording = Some(running);
        Ok(())
    }

    /// Notes if the recording has ended.
    pub fn attend_recording(&mut self) {
        let Some(ended) = self.recording.as_mut().and_then(Running::ended) else {
            return;
        };
        self.recording = None;
        self.recorded = Some(ended);
    }

    fn new_form(&self) -> RecordForm {
        let moments = self.edit.process.steps().saturating_add(1);
        RecordForm {
            folder: format!("recordings/{}", self.name),
            frames: self.edit.record.frames(moments),
            draped: false,
            video: false,
            force: false,
        }
    }
}

fn record(ctx: &egui::Context, watch: &mut Watch) {
    if !watch.open.record {
        return;
    }
    let mut form = watch.record_form.take().unwrap_or_else(|| watch.new_form());
    let mut open = true;
    let mut go = false;
    egui::Window::new("Record")
        .open(&mut open)
        .collapsible(false)
        .resizable(false)
        .anchor(egui::Align2::CENTER_CENTER, vec2(0.0, 0.0))
        .show(ctx, |ui| {
            egui::Grid::new("record")
                .num_columns(2)
                .spacing([10.0, 8.0])
                .show(ui, |ui| {
                    ui.label("Folder");
                    ui.horizontal(|ui| {
                        ui.add(egui::TextEdit::singleline(&mut form.folder).desired_width(300.0));
                        if ui.button("…").on_hover_text("Choose a folder").clicked() {
                            watch.files.ask(Wanted::RecordTo, "");
                            watch.open.record = false;
                        }
                    });
                    ui.end_row();
                    ui.label("Frames");
                    let most = watch.edit.process.steps().saturating_add(1).min(100_000) as u32;
                    ui.add(egui::DragValue::new(&mut form.frames).range(1..=most));
                    ui.end_row();
                    ui.label("View");
                    ui.horizontal(|ui| {
                        ui.selectable_value(&mut form.draped, false, "flat");
                        ui.selectable_value(&mut form.draped, true, "draped");
                    });
                    ui.end_row();
                    ui.label("Film");
                    ui.add_enabled(
                        ffmpeg_is_there(),
                        egui::Checkbox::new(&mut form.video, "video.mp4"),
                    )
                    .on_disabled_hover_text("needs the program ffmpeg");
                    ui.end_row();
                    ui.label("");
                    ui.checkbox(&mut form.force, "replace a recording that is there");
                    ui.end_row();
                });
            ui.add_space(4.0);
            ui.weak("From the beginning to the end, in frames like those of `dyelapse record`.");
            ui.add_space(6.0);
            go = ui.button("⏺ Record").clicked();
        });
    if go {
        watch.open.record = false;
        if let Err(why) = watch.start_recording(&form) {
            watch.problem = Some(why);
        }
    } else if !open {
        watch.open.record = false;
    }
    watch.record_form = Some(form);
}

fn recorded(ctx: &egui::Context, watch: &mut Watch) {
    let Some(ended) = watch.recorded.clone() else {
        return;
    };
    let mut open = true;
    egui::Window::new("Recording")
        .open(&mut open)
        .collapsible(false)
        .resizable(false)
        .anchor(egui::Align2::RIGHT_BOTTOM, vec2(-16.0, -90.0))
        .show(ctx, |ui| match &ended {
            Ended::Done {
                folder,
                frames,
                complete,
            } => {
                let folder = folder.canonicalize().unwrap_or_else(|_| folder.clone());
                let how = if *complete { "" } else { ", stopped early" };
                ui.label(format!("{frames} frames{how}"));
                ui.monospace(folder.display().to_string());
                if ui.button("Copy the path").clicked() {
                    ctx.copy_text(folder.display().to_string());
                }
            }
            Ended::Failed(why) => {
                ui.colored_label(egui::Color32::from_rgb(255, 150, 130), why);
            }
        });
    if !open {
        watch.recorded = None;
    }
}

fn leave(ctx: &egui::Context, watch: &mut Watch) {
    let Some(leaving) = watch.leaving.clone() else {
        return;
    };
    egui::Modal::new("leave".into()).show(ctx, |ui| {
        ui.set_width(320.0);
        if watch.changed_on_disk {
            ui.heading("The file has changed on disk");
            ui.label("Open it again, and lose the changes that were made here? Save them elsewhere to keep both.");
        } else {
            ui.heading("Leave without saving?");
            ui.label(format!("{} has changes that are not saved.", watch.name));
        }
        ui.add_space(8.0);
        ui.horizontal(|ui| {
            if !watch.changed_on_disk && ui.button("Save").clicked() {
                watch.leaving = None;
                watch.after_save = Some(leaving.clone());
                watch.save();
            }
            if ui.button("Leave them").clicked() {
                watch.go(leaving.clone());
            }
            if ui.button("Stay").clicked() {
                watch.leaving = None;
                watch.changed_on_disk = false;
            }
        });
    });
}

fn keys(ctx: &egui::Context, watch: &mut Watch) {
    if !watch.open.keys {
        return;
    }
    let mut open = true;
    egui::Window::new("Keys")
        .open(&mut open)
        .collapsible(false)
        .resizable(false)
        .anchor(egui::Align2::CENTER_CENTER, vec2(0.0, 0.0))
        .show(ctx, |ui| {
            ui.horizontal_top(|ui| {
                for (i, half) in KEYS.chunks(KEYS.len().div_ceil(2)).enumerate() {
                    egui::Grid::new(("keys", i))
                        .num_columns(2)
                        .spacing([14.0, 4.0])
                        .show(ui, |ui| {
                            for (key, what) in half {
                                ui.monospace(*key);
                                ui.label(*what);
                                ui.end_row();
                            }
                        });
                    if i == 0 {
                        ui.separator();
                    }
                }
            });
        });
    if !open {
        watch.open.keys = false;
    }
}
