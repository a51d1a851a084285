//! The window without hands: a list of acts, for tests and for showing something again.

use std::io::Write;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use bevy::prelude::*;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use serde::Deserialize;

use super::canvas;
use super::dialogs::{Leaving, RecordForm};
use super::hanger::{Deed, Place};
use super::settings::Layout;
use super::state::Watch;
use super::tools::{Brush, Kind, Tool};
use super::view3d::View3d;
use super::worker::{Order, Pace};
use crate::scenario::Experiment;
use crate::session::overlay::Field;

/// One act. Each begins when the one before is done.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub enum Act {
    /// Wait so many seconds.
    Wait(f64),
    /// Wait until every edit is done and the process is where it is going.
    Arrive,
    /// Wait until the process has come to its end.
    End,
    /// Wait until the draped cloth has come to rest.
    Rest,
    /// Play.
    Play,
    /// Pause.
    Pause,
    /// So many steps a second.
    PerSecond(f64),
    /// So many steps a frame.
    PerFrame(u64),
    /// Go to a step.
    GoTo(u64),
    /// Open a scenario.
    Open(String),
    /// Change the scenario to what a file says.
    Edit(String),
    /// Undo.
    Undo,
    /// Redo.
    Redo,
    /// Paint a stroke: what, how large (share of the cloth), where.
    Stroke(Kind, f64, Vec<Place>),
    /// Press a crease.
    Crease(Place, Place),
    /// Pull a place of the cloth by so much (m) and hold it.
    Pull(Place, (f64, f64, f64)),
    /// Let go.
    LetGo,
    /// Show the cloth so.
    View(Layout),
    /// Show a field over the cloth.
    Overlay(Option<Field>),
    /// Cut the cloth from place to place.
    Cut(Place, Place),
    /// Come so near that a cell is so many points long, to a place.
    Zoom(f32, Place),
    /// Take a tool.
    Take(Tool),
    /// Show or hide the gallery.
    Gallery(bool),
    /// Show or hide the keys.
    Keys(bool),
    /// Show or hide the dialog of a recording.
    RecordDialog(bool),
    /// Show or hide the parameters.
    Panel(bool),
    /// Show the weave editor, or the parameters.
    WeaveEditor(bool),
    /// Show or hide the plots.
    Plots(bool),
    /// Save to a file.
    Save(PathBuf),
    /// Record into a folder, so many frames, draped or flat.
    Record(PathBuf, u32, bool),
    /// Wait until the recording has ended.
    Recorded,
    /// Keep a picture of the whole window.
    Screenshot(PathBuf),
    /// Write a line to the log.
    Log(String),
    /// Close the window, saved or not.
    Quit,
}

/// How the frames went since the log was written last.
#[derive(Debug, Clone, Copy, Default)]
struct Frames {
    count: u32,
    since: Option<Instant>,
    last: Option<Instant>,
    longest: Duration,
}

/// What is done without hands.
#[derive(Default)]
pub struct Script {
    given: bool,
    acts: std::collections::VecDeque<Act>,
    log: Option<std::fs::File>,
    began: Option<Instant>,
    frames: Frames,
    /// The step that was gone to last.
    going: Option<u64>,
    wants_picture: bool,
    waits_for_picture: std::sync::Arc<std::sync::atomic::AtomicBool>,
}

/// Frames that are drawn before a picture of the window is taken: what was changed is there then.
const SETTLES: Duration = Duration::from_millis(400);

impl Script {
    /// Reads a script, and opens its log.
    ///
    /// # Errors
    /// What is wrong, with the place.
    pub fn load(script: Option<&PathBuf>, log: Option<&PathBuf>) -> Result<Self, String> {
        let mut read = Script::default();
        if let Some(path) = script {
            let at = path.display();
            let text =
                std::fs::read_to_string(path).map_err(|why| format!("cannot read {at}: {why}"))?;
            let options = ron::Options::default()
                .with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
            let acts: Vec<Act> = options
                .from_str(&text)
                .map_err(|why| format!("{at}:{why}"))?;
            read.acts = acts.into();
            read.given = true;
        }
        if let Some(path) = log {
            let file = std::fs::File::create(path);
            read.log = Some(file.map_err(|why| format!("cannot write {}: {why}", path.display()))?);
        }
        Ok(read)
    }

    /// Whether there was a script.
    pub fn was_given(&self) -> bool {
        self.given
    }

    /// Whether there is something left to do.
    pub fn is_running(&self) -> bool {
        !self.acts.is_empty()
    }

    /// A picture of the cloth is to be kept.
    pub fn keep_picture(&mut self) {
        self.wants_picture = true;
    }

    fn line(&mut self, text: &str) {
        if let Some(log) = &mut self.log {
            // A log that cannot be written is missed by whoever reads it.
            let _ = writeln!(log, "{text}");
            let _ = log.flush();
        }
    }
}

/// Does what the script asks for, as far as it can be done now.
pub fn act(world: &mut World) {
    world.resource_scope(|world, mut watch: Mut<Watch>| {
        let watch = &mut *watch;
        count_frame(&mut watch.script.frames);
        if watch.script.wants_picture {
            watch.script.wants_picture = false;
            keep_picture(world, watch);
        }
        let mut steps = 0;
        while let Some(act) = watch.script.acts.front().cloned() {
            let began = *watch.script.began.get_or_insert_with(Instant::now);
            steps += 1;
            if steps > 20 || !is_done(world, watch, &act, began.elapsed()) {
                break;
            }
            watch.script.acts.pop_front();
            watch.script.began = None;
            let line = state(watch, &act);
            watch.script.line(&line);
        }
    });
}

fn count_frame(frames: &mut Frames) {
    let now = Instant::now();
    frames.since.get_or_insert(now);
    if let Some(last) = frames.last {
        frames.longest = frames.longest.max(now - last);
    }
    frames.last = Some(now);
    frames.count += 1;
}

/// A line of the log: what was done, and how things are.
fn state(watch: &mut Watch, act: &Act) -> String {
    let frames = std::mem::take(&mut watch.script.frames);
    let seconds = frames
        .since
        .map_or(0.0, |since| since.elapsed().as_secs_f64());
    let seen = watch.seen.as_ref();
    let (step, target, edits) = seen.map_or((0, 0, 0), |seen| (seen.step, seen.target, seen.edits));
    let act = format!("{act:?}").replace(' ', "");
    let act: String = act.chars().take(60).collect();
    format!(
        "act={act} step={step} target={target} edits={edits} frames={} seconds={seconds:.3} longest_ms={:.1} \
         problem={}",
        frames.count,
        1e3 * frames.longest.as_secs_f64(),
        watch.problem.is_some(),
    )
}

/// Does an act, or sees whether it is done; true once it is.
fn is_done(world: &mut World, watch: &mut Watch, act: &Act, elapsed: Duration) -> bool {
    let arrived = |watch: &Watch| {
        let there = |step: u64| watch.script.going.is_none_or(|going| going == step);
        let seen = watch.seen.as_ref();
        watch.is_in_step() && seen.is_some_and(|seen| seen.step == seen.target && there(seen.step))
    };
    match act {
        Act::Wait(seconds) => return elapsed.as_secs_f64() >= *seconds,
        Act::Arrive => return arrived(watch),
        Act::End => {
            let total = watch.edit.process.steps();
            return watch.seen.as_ref().is_some_and(|seen| seen.step >= total);
        }
        Act::Rest => return watch.moment.as_ref().is_some_and(|moment| !moment.moving),
        Act::Recorded => return watch.recording.is_none() && watch.then.is_empty(),
        Act::Screenshot(path) => return screenshot(world, watch, path, elapsed),
        // What follows is done at once.
        Act::Play => {
            watch.script.going = None;
            watch.worker.order(Order::Play(true));
        }
        Act::Pause => watch.worker.order(Order::Play(false)),
        Act::PerSecond(steps) => watch.set_pace(Pace::PerSecond(*steps)),
        Act::PerFrame(steps) => watch.set_pace(Pace::PerFrame(*steps)),
        Act::GoTo(step) => {
            watch.worker.order(Order::GoTo(*step));
            watch.script.going = Some((*step).min(watch.edit.process.steps()));
        }
        Act::Open(name) => watch.open(name),
        Act::Edit(file) => match Experiment::load(file) {
            Ok(experiment) => {
                watch.edit = experiment.scenario;
                watch.send_edit("script", false);
            }
            Err(why) => watch.problem = Some(why.to_string()),
        },
        Act::Undo => watch.order_edit(Order::Undo),
        Act::Redo => watch.order_edit(Order::Redo),
        Act::Stroke(kind, size, path) => {
            let brush = Brush {
                kind: *kind,
                size: *size,
                ..Brush::default()
            };
            let cells = watch.edit.cloth.cells();
            let stroke = brush.stroke(path, cells);
            watch.order_edit(Order::Paint(brush.paint(), stroke));
        }
        Act::Crease(from, to) => canvas::crease(watch, *from, *to),
        Act::Pull(place, by) => {
            if let Some(at) = canvas::on_cloth(watch, *place) {
                let by = bevy::math::DVec3::new(by.0, by.1, by.2);
                watch.hanger.act(Deed::Hold(*place, at + by));
            }
        }
        Act::LetGo => watch.hanger.act(Deed::LetGo),
        Act::View(layout) => {
            watch.settings.layout = *layout;
            world.resource_mut::<View3d>().touch();
        }
        Act::Overlay(field) => watch.overlay(*field),
        Act::Cut(from, to) => {
            watch.tools.cut = Some((*from, *to));
            watch.settings.plots = true;
            watch.worker.order(Order::Cut(Some((*from, *to))));
        }
        Act::Zoom(zoom, (x, y)) => {
            let (nx, ny) = watch.edit.cloth.cells();
            watch.tools.flat.zoom = Some(*zoom);
            let middle = bevy_egui::egui::vec2((x * nx as f64) as f32, (y * ny as f64) as f32);
            watch.tools.flat.middle = middle;
        }
        Act::Take(tool) => watch.take_tool(*tool),
        Act::Gallery(open) => watch.open.gallery = *open,
        Act::Keys(open) => watch.open.keys = *open,
        Act::RecordDialog(open) => watch.open.record = *open,
        Act::Panel(open) => watch.settings.panel = *open,
        Act::WeaveEditor(open) => watch.weaves = *open,
        Act::Plots(open) => watch.settings.plots = *open,
        Act::Save(path) => watch.save_to(path.clone()),
        Act::Record(folder, frames, draped) => {
            let form = RecordForm {
                folder: folder.display().to_string(),
                frames: *frames,
                draped: *draped,
                video: false,
                force: false,
            };
            if let Err(why) = watch.start_recording(&form) {
                watch.problem = Some(why);
            }
        }
        Act::Log(text) => watch.script.line(text),
        Act::Quit => {
            watch.unsaved = false;
            watch.leave_for(Leaving::Close);
        }
    }
    true
}

/// Takes a picture of the window; true once it is written.
fn screenshot(world: &mut World, watch: &mut Watch, path: &PathBuf, elapsed: Duration) -> bool {
    use std::sync::atomic::Ordering;
    let taken = watch.script.waits_for_picture.clone();
    if elapsed < SETTLES {
        world.resource_mut::<View3d>().touch();
        taken.store(false, Ordering::Relaxed);
        return false;
    }
    if taken.load(Ordering::Relaxed) {
        return std::fs::metadata(path).is_ok_and(|file| file.len() > 0);
    }
    taken.store(true, Ordering::Relaxed);
    // An older picture of this name is not this one.
    let _ = std::fs::remove_file(path);
    let path = path.clone();
    world
        .spawn(Screenshot::primary_window())
        .observe(move |captured: On<ScreenshotCaptured>| {
            let image = captured.image.clone();
            if let Ok(picture) = image.try_into_dynamic() {
                let _ = picture.to_rgb8().save(&path);
            }
        });
    false
}

/// Keeps a picture of the cloth: flat, or as it is draped if only that is shown.
fn keep_picture(world: &mut World, watch: &mut Watch) {
    let Some(seen) = &watch.seen else { return };
    let file = free_name(&format!("{}_{}", watch.name, seen.step));
    if watch.settings.layout == Layout::Draped {
        let image = world.resource::<View3d>().image.clone();
        let path = file.clone();
        world
            .spawn(Screenshot::image(image))
            .observe(move |captured: On<ScreenshotCaptured>| {
                if let Ok(picture) = captured.image.clone().try_into_dynamic() {
                    let _ = picture.to_rgb8().save(&path);
                }
            });
        world.resource_mut::<View3d>().touch();
        watch.tell(format!("kept {}", file.display()));
        return;
    }
    let shown = &seen.sides[0];
    let pixels = shown
        .levels
        .as_chunks::<4>()
        .0
        .iter()
        .take(shown.width * shown.height);
    let rgb: Vec<u8> = pixels.flat_map(|[r, g, b, _]| [*r, *g, *b]).collect();
    let picture = image::RgbImage::from_raw(shown.width as u32, shown.height as u32, rgb);
    match picture.map(|picture| picture.save(&file)) {
        Some(Ok(())) => watch.tell(format!("kept {}", file.display())),
        Some(Err(why)) => watch.problem = Some(format!("cannot write {}: {why}", file.display())),
        None => {}
    }
}

/// The first of NAME.png, NAME_2.png… that is not there yet.
fn free_name(name: &str) -> PathBuf {
    let numbered = |i: u32| match i {
        1 => PathBuf::from(format!("{name}.png")),
        i => PathBuf::from(format!("{name}_{i}.png")),
    };
    (1..)
        .map(numbered)
        .find(|file| !file.exists())
        .unwrap_or_default()
}
