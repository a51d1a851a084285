//! What the window knows, and what it does with what the threads give it.

use std::io::Write;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use bevy::prelude::*;
use bevy_egui::egui;
use bevy_egui::{EguiTextureHandle, EguiUserTextures};

use super::dialogs::{Leaving, RecordForm};
use super::files::{Files, Wanted};
use super::hanger::{Deed, Hanger, Moment};
use super::panel::PanelState;
use super::recording::{Ended, Running};
use super::script::Script;
use super::settings::Settings;
use super::tools::{Tool, Tools};
use super::view3d;
use super::worker::{Order, Pace, Seen, Worker};
use crate::record::write_whole;
use crate::scenario::{Beside, Draping, Experiment, Origin, Scenario, ViewSpec};
use crate::session::overlay::{self, Field};
use crate::session::save::save;
use crate::studio::cloth::image_of_levels;
use crate::studio::mips::Kind;
use crate::studio::offscreen::most_pixels;

/// What the draped cloth depends on.
type HangsBy = (Option<Draping>, ViewSpec, (usize, usize), u64);

/// Everything that the window knows.
#[derive(Resource)]
pub struct Watch {
    /// The process.
    pub worker: Worker,
    /// The draped cloth.
    pub hanger: Hanger,
    /// The process as it was seen last.
    pub seen: Option<Seen>,
    /// The draped cloth as it was seen last.
    pub moment: Option<Moment>,
    /// The scenario as the panel shows it: that of the process, or one that the process will have next.
    pub edit: Scenario,
    /// Its name.
    pub name: String,
    /// The file that it was opened from or saved to.
    pub file: Option<PathBuf>,
    /// Whether there are changes that are not saved.
    pub unsaved: bool,
    /// What went wrong last, with place and caret where it is in a file.
    pub problem: Option<String>,
    /// Something to be told for a while, and since when.
    pub message: Option<(String, Instant)>,
    /// The panel.
    pub panel: PanelState,
    /// Tools and how the flat cloth is seen.
    pub tools: Tools,
    /// Whether the panel shows the weave editor.
    pub weaves: bool,
    /// Whether a slider of the panel is held.
    pub held: bool,
    /// The recording that is being made.
    pub recording: Option<Running>,
    /// How the last one ended.
    pub recorded: Option<Ended>,
    /// Files: dialogs, the one that is watched.
    pub files: Files,
    /// What is remembered.
    pub settings: Settings,
    /// Which windows are open over the others.
    pub open: Open,
    /// What is done without hands.
    pub script: Script,
    /// The images of the flat cloth and of what lies over it.
    pub flat: Handle<Image>,
    /// The field over the cloth.
    pub over: Handle<Image>,
    /// Textures of the gallery, as far as they are there.
    pub thumbnails: std::collections::BTreeMap<&'static str, egui::TextureHandle>,
    /// What is asked for in the dialog of a recording.
    pub record_form: Option<RecordForm>,
    /// What is to be done once it is clear whether to save.
    pub leaving: Option<Leaving>,
    /// Whether the question is about the file having changed.
    pub changed_on_disk: bool,
    /// What is to be done once the scenario is saved.
    pub after_save: Option<Leaving>,
    /// Whether the window is to close.
    pub closing: bool,
    /// How fast it plays; none before anyone has said.
    pub pace: Option<Pace>,
    /// Whether the cloth moves on when it need not.
    pub moves: bool,
    opened: u64,
    sent: u64,
    hangs_by: Option<HangsBy>,
    /// The moment whose surroundings stand in the studio.
    furnished: Option<(u64, bool)>,
    /// Where the scenario was opened from.
    origin: Origin,
    /// The edits at which the process will have made the last change that it makes itself.
    asked: u64,
    /// What is to be done as soon as the process has made every change.
    pub then: Vec<Then>,
    /// The scenario as it was opened or saved last.
    kept: Scenario,
}

/// What waits for the process to have made every change.
#[derive(Debug, Clone, PartialEq)]
pub enum Then {
    /// Save to a file.
    Save(PathBuf),
    /// Record.
    Record(RecordForm),
}

/// Windows over the others.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Open {
    /// The gallery.
    pub gallery: bool,
    /// The keys.
    pub keys: bool,
    /// What is to be recorded.
    pub record: bool,
}

/// How long something is told.
const TOLD: Duration = Duration::from_secs(6);

fn hangs_by(scenario: &Scenario) -> HangsBy {
    let view = scenario.view.clone();
    (
        scenario.drape.clone(),
        view,
        scenario.cloth.cells(),
        scenario.seed,
    )
}

impl Watch {
    /// A window on an experiment.
    pub fn new(
        experiment: &Experiment,
        (worker, hanger): (Worker, Hanger),
        settings: Settings,
        script: Script,
        images: [Handle<Image>; 2],
    ) -> Self {
        let [flat, over] = images;
        let mut watch = Watch {
            worker,
            hanger,
            seen: None,
            moment: None,
            edit: experiment.scenario.clone(),
            name: experiment.name.clone(),
            file: None,
            unsaved: false,
            problem: None,
            message: None,
            panel: PanelState::default(),
            tools: Tools::default(),
            weaves: false,
            held: false,
            recording: None,
            recorded: None,
            files: Files::default(),
            settings,
            open: Open::default(),
            script,
            flat,
            over,
            thumbnails: std::collections::BTreeMap::new(),
            record_form: None,
            leaving: None,
            changed_on_disk: false,
            after_save: None,
            closing: false,
            pace: None,
            moves: false,
            opened: 1,
            sent: 0,
            hangs_by: None,
            furnished: None,
            origin: Origin::Memory,
            asked: 0,
            then: Vec::new(),
            kept: experiment.scenario.clone(),
        };
        watch.has_opened(experiment);
        watch
    }

    fn has_opened(&mut self, experiment: &Experiment) {
        self.edit = experiment.scenario.clone();
        self.kept = experiment.scenario.clone();
        self.origin = experiment.origin.clone();
        self.asked = 0;
        self.then.clear();
        self.name = experiment.name.clone();
        self.file = match &experiment.origin {
            Origin::File(file) => Some(file.clone()),
            _ => None,
        };
        self.settings.last = Some(match &self.file {
            // From another folder it is to be found as well.
            Some(file) => file
                .canonicalize()
                .unwrap_or(file.clone())
                .display()
                .to_string(),
            None => experiment.name.clone(),
        });
        let watched = self.files.watch(self.file.as_deref());
        if let Err(why) = watched {
            self.tell(format!("changes of the file will not be seen: {why}"));
        }
        self.unsaved = false;
        self.problem = None;
        self.tools.forget();
    }

    /// Tells something for a while.
    pub fn tell(&mut self, what: impl Into<String>) {
        self.message = Some((what.into(), Instant::now()));
    }

    /// Whether something is still being told.
    pub fn told(&self) -> Option<&str> {
        let (what, since) = self.message.as_ref()?;
        (since.elapsed() < TOLD).then_some(what.as_str())
    }

    /// Opens a scenario by path or name.
    pub fn open(&mut self, name: &str) {
        match Experiment::load(name) {
            Ok(experiment) => {
                self.has_opened(&experiment);
                self.opened += 1;
                self.sent = 0;
                self.pace = None;
                self.record_form = None;
                self.worker.order(Order::Open(Box::new(experiment)));
            }
            // The cloth that is there stays.
            Err(why) => self.problem = Some(why.to_string()),
        }
    }

    /// Gives the process the scenario that the panel shows.
    pub fn send_edit(&mut self, label: &str, held: bool) {
        self.sent += 1;
        self.unsaved = true;
        self.worker.order(Order::Edit {
            scenario: Box::new(self.edit.clone()),
            label: label.into(),
            held,
        });
    }

    /// Orders a change that the process makes itself.
    pub fn order_edit(&mut self, order: Order) {
        self.sent += 1;
        self.asked = self.sent;
        self.worker.order(order);
    }

    /// Whether the scenario that the panel shows lacks a change that the process is making: one that was
    /// made on top of it would undo that.
    pub fn must_wait(&self) -> bool {
        let seen = self.seen.as_ref().filter(|seen| seen.opened == self.opened);
        seen.is_none_or(|seen| seen.edits < self.asked)
    }

    /// Whether the process has done everything that it was told to change.
    pub fn is_in_step(&self) -> bool {
        let seen = self.seen.as_ref();
        seen.is_some_and(|seen| seen.opened == self.opened && seen.edits == self.sent)
    }

    /// The drape of the scenario changes in a way that the hanging cloth knows of already.
    pub fn hangs_already(&mut self) {
        self.hangs_by = Some(hangs_by(&self.edit));
    }

    /// Hangs the cloth anew.
    pub fn hang(&mut self) {
        self.hangs_by = Some(hangs_by(&self.edit));
        self.hanger.act(Deed::Hang(Box::new(self.edit.clone())));
    }

    /// What the text of the scenario says, where the window's files lie: what is recorded.
    ///
    /// # Errors
    /// What is wrong with it, which should never be.
    pub fn as_saved(&self) -> Result<Experiment, String> {
        let name = format!("{}.ron", self.name);
        let text = save(&self.edit);
        Experiment::parse(&name, self.origin.clone(), text).map_err(|why| why.to_string())
    }

    /// Saves the scenario, as soon as the process has made every change.
    pub fn save_to(&mut self, file: PathBuf) {
        if !self.is_in_step() {
            self.then.push(Then::Save(file));
            return;
        }
        if let Err(why) = self.write(&file) {
            self.leaving = None;
            self.problem = Some(why);
            return;
        }
        self.tell(format!("saved {}", file.display()));
        self.kept = self.edit.clone();
        self.unsaved = false;
        if let Some(stem) = file.file_stem().and_then(|stem| stem.to_str()) {
            self.name = stem.into();
        }
        let whole = file.canonicalize().unwrap_or(file.clone());
        self.settings.last = Some(whole.display().to_string());
        self.files.ignore_own_change();
        if let Err(why) = self.files.watch(Some(&file)) {
            self.tell(format!(
                "saved; changes of the file will not be seen: {why}"
            ));
        }
        self.origin = Origin::File(file.clone());
        self.worker.order(Order::Origin(self.origin.clone()));
        self.file = Some(file);
        if let Some(leaving) = self.after_save.take() {
            self.go(leaving);
        }
    }

    /// Writes the scenario, and the pictures and drafts beside it that it names.
    fn write(&self, file: &std::path::Path) -> Result<(), String> {
        let folder = file.parent().unwrap_or(std::path::Path::new(""));
        let (from, to) = (Beside::of(&self.origin), Beside::Folder(folder.into()));
        for (name, _, _) in self.edit.pictures() {
            if std::path::Path::new(name).is_absolute() {
                continue;
            }
            let bytes = from.read(name).map_err(|why| format!("{name}: {why}"))?;
            let there = to.path(name);
            match std::fs::read(&there) {
                Ok(old) if old == bytes => {}
                Ok(_) => {
                    return Err(format!(
                        "{} is another file than the one that this scenario names: save into another folder",
                        there.display()
                    ));
                }
                Err(_) => write_whole(&there, |file| file.write_all(&bytes))
                    .map_err(|why| why.to_string())?,
            }
        }
        let text = save(&self.edit);
        write_whole(file, |file| file.write_all(text.as_bytes())).map_err(|why| why.to_string())
    }

    /// Saves where it was saved before, or asks where.
    pub fn save(&mut self) {
        match self.file.clone() {
            Some(file) => self.save_to(file),
            None => self.files.ask(Wanted::SaveAs, &self.name),
        }
    }

    /// Takes another tool, and lets go of what the old one held.
    pub fn take_tool(&mut self, tool: Tool) {
        if self.tools.held.take().is_some() {
            self.hanger.act(Deed::LetGo);
        }
        self.tools.path.clear();
        self.tools.from = None;
        self.tools.to = None;
        self.tools.tool = tool;
    }

    /// Steps a second that it plays with.
    pub fn speed(&self, total: u64) -> f64 {
        let most = total.max(2) as f64;
        match self.pace {
            Some(Pace::PerSecond(speed)) => speed.clamp(1.0, most),
            Some(Pace::PerFrame(steps)) => (60.0 * steps as f64).clamp(1.0, most),
            None => (total as f64 / 20.0).max(1.0),
        }
    }

    /// Plays at another speed.
    pub fn set_pace(&mut self, pace: Pace) {
        self.pace = Some(pace);
        self.worker.order(Order::Pace(pace));
    }

    /// Shows a field over the cloth, or none.
    pub fn overlay(&mut self, field: Option<Field>) {
        self.tools.overlay = field;
        let with_layer = field.map(|field| (field, overlay::Seen::Top));
        self.worker.order(Order::Overlay(with_layer));
    }
}

/// Takes what the threads have come to, and shows it.
pub fn receive(world: &mut World) {
    world.resource_scope(|world, mut watch: Mut<Watch>| {
        let watch = &mut *watch;
        if let Some(seen) = watch.worker.take() {
            take_seen(world, watch, seen);
        }
        if let Some(moment) = watch.hanger.take() {
            take_moment(world, watch, moment);
        }
        if watch.is_in_step() {
            for then in std::mem::take(&mut watch.then) {
                match then {
                    Then::Save(file) => watch.save_to(file),
                    Then::Record(form) => {
                        if let Err(why) = watch.start_recording(&form) {
                            watch.problem = Some(why);
                        }
                    }
                }
            }
        }
        if let Some(why) = watch.hanger.problem() {
            watch.problem = Some(format!("the cloth cannot be draped: {why}"));
        }
        if (watch.worker.has_died() || watch.hanger.has_died()) && watch.problem.is_none() {
            watch.problem = Some(
                "the process has broken off; save the scenario, close the window and open it again"
                    .into(),
            );
        }
    });
}

fn take_seen(world: &mut World, watch: &mut Watch, seen: Seen) {
    if seen.opened != watch.opened {
        // The last of a cloth that is no longer there.
        return;
    }
    let most = most_pixels(world);
    let longest = seen.sides[0].width.max(seen.sides[0].height);
    if longest > most {
        watch.problem = Some(format!(
            "this cloth is {longest} cells long, and the graphics driver shows at most {most}: record it instead"
        ));
        watch.seen = Some(seen);
        return;
    }
    let front = &seen.sides[0];
    let image = image_of_levels(
        front.levels.clone(),
        (front.width, front.height),
        Kind::Colour,
        1,
    );
    put(world, &watch.flat, image);
    if let Some(overlay) = &seen.overlay {
        let levels = overlay.rgba();
        let mut image = image_of_levels(levels, (overlay.nx, overlay.ny), Kind::Colour, 1);
        image.texture_descriptor.mip_level_count = 1;
        put(world, &watch.over, image);
    }
    let new_relief = watch
        .seen
        .as_ref()
        .is_none_or(|old| !std::sync::Arc::ptr_eq(&old.reliefs[0], &seen.reliefs[0]));
    let in_step = seen.edits == watch.sent;
    if in_step {
        if watch.edit != seen.experiment.scenario {
            watch.edit = seen.experiment.scenario.clone();
        }
        watch.unsaved = watch.edit != watch.kept;
        let by = hangs_by(&watch.edit);
        if watch.hangs_by.as_ref() != Some(&by) {
            watch.hang();
        }
        if watch
            .seen
            .as_ref()
            .is_none_or(|old| old.problem != seen.problem)
        {
            watch.problem = seen.problem.clone();
        }
    }
    watch.seen = Some(seen);
    let seen = watch.seen.as_ref();
    let front = watch.moment.as_ref().map(|moment| &*moment.front);
    if world.contains_resource::<crate::studio::cloth::ClothAssets>() {
        view3d::show(world, None, seen);
    } else {
        view3d::show(world, front, seen);
    }
    if let Some(seen) = seen.filter(|_| new_relief) {
        view3d::relief(world, seen);
    }
}

/// Gives an image other contents.
fn put(world: &mut World, handle: &Handle<Image>, image: Image) {
    let _ = world.resource_mut::<Assets<Image>>().insert(handle, image);
}

fn take_moment(world: &mut World, watch: &mut Watch, moment: Moment) {
    let stands = (moment.hung, moment.settled);
    if watch.furnished != Some(stands) {
        let first = watch.furnished.is_none();
        watch.furnished = Some(stands);
        let view = watch.edit.view.clone();
        let subject = crate::studio::camera::Subject::clone(&moment.subject);
        view3d::furnish(world, &view, subject, &moment.furniture);
        let mut view3d = world.resource_mut::<view3d::View3d>();
        if first || !view3d.moved_by_hand {
            view3d.reset(&view);
        }
    }
    if watch.moment.as_ref().map(|old| &old.problem) != Some(&moment.problem)
        && moment.problem.is_some()
    {
        watch.problem.clone_from(&moment.problem);
    }
    watch.moment = Some(moment);
    let front = watch.moment.as_ref().map(|moment| &*moment.front);
    let seen = watch.seen.as_ref();
    if world.contains_resource::<crate::studio::cloth::ClothAssets>() {
        view3d::show(world, front, None);
    } else {
        view3d::show(world, front, seen);
    }
}

/// A picture of one pixel, and its place among the textures of the panel.
pub fn blank(world: &mut World) -> Handle<Image> {
    let image = image_of_levels(vec![0; 4], (1, 1), Kind::Colour, 1);
    let handle = world.resource_mut::<Assets<Image>>().add(image);
    world
        .resource_mut::<EguiUserTextures>()
        .add_image(EguiTextureHandle::Strong(handle.clone()));
    handle
}
