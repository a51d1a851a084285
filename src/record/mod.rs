//! Recording: frames of the cloth at chosen moments, and everything needed to use them later.
//!
//! A recording is a folder: frames, a contact sheet, a manifest, the ledger, the scenario itself,
//! and on request the fields behind the pictures and a film. A figure is one picture of several
//! cloths.

#[cfg_attr(not(feature = "viewer"), path = "not_draped.rs")]
mod draped;
mod error;
mod export;
mod fields;
mod figure;
mod folder;
mod manifest;
mod maps;
mod plan;
mod recorder;
mod sheet;
mod video;
mod writer;

use std::path::{Path, PathBuf};

pub use error::RecordError;
pub use export::{Export, export};
pub use figure::{PictureFile, draw_figure, draw_panels};
pub use manifest::{Frame, Manifest};
pub use plan::{Plan, Stop};
pub use recorder::{RecordPlugin, Recorder};
pub(crate) use sheet::LARGEST_TILE;
pub use video::ffmpeg_is_there;

use crate::memory::{self, Use};
use crate::scenario::check::Checker;
use crate::scenario::{Draping, Experiment, LARGEST_SCALE, Origin};
use crate::schedule::advance_to;
use crate::studio::hung::{Hung, HungError};
use crate::texture::Scale;
use crate::{DyeingPlugins, look, prepare};
pub(crate) use folder::write_whole;

use draped::Draped;
use folder::Folder;
use recorder::Seen;

/// How a recording shows the cloth.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum View {
    /// Flat, every cell in its place.
    #[default]
    Flat,
    /// Draped, in the studio.
    Draped,
}

/// What to record, where it differs from what the scenario says.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// The folder for the recording.
    pub out: PathBuf,
    /// Frames of the time-lapse.
    pub frames: Option<u32>,
    /// Steps of the process.
    pub steps: Option<u64>,
    /// Pixels along one side of a cell.
    pub scale: Option<u32>,
    /// Whether to keep the fields behind every frame.
    pub fields: bool,
    /// Whether to write the relief of the undyed cloth, as maps of height and normals.
    pub maps: bool,
    /// Whether frames show the cloth flat or draped.
    pub view: View,
    /// How to drape it, where not as the scenario says.
    pub drape: Option<Draping>,
    /// Pixels of a frame of draped cloth, across and down, where not as the scenario says.
    pub pixels: Option<(u32, u32)>,
    /// Whether to make a film of the frames.
    pub video: bool,
    /// Whether to replace a recording that is already in the folder.
    pub force: bool,
}

/// What a recording came to.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// The folder.
    pub folder: PathBuf,
    /// Frames kept.
    pub frames: usize,
    /// Steps done.
    pub steps: u64,
    /// Whether it reached its end; false if it was stopped.
    pub complete: bool,
}

/// Runs an experiment and records it.
///
/// `go_on` is told the step before every (split) step, and asked whether to go on; a recording that
/// is stopped is shorter, and valid.
///
/// # Errors
/// A [`RecordError`]; nothing is written where the options themselves are wrong.
pub fn record(
    experiment: &Experiment,
    options: &Options,
    mut go_on: impl FnMut(u64) -> bool,
) -> Result<Recording, RecordError> {
    let scenario = &experiment.scenario;
    let scale = options.scale.unwrap_or(scenario.look.pixels_per_cell);
    if !(1..=LARGEST_SCALE).contains(&scale) {
        return Err(RecordError::Scale(scale));
    }
    let fields = options.fields;
    memory::check(scenario, Use { scale, fields })?;
    let plan = Plan::new(scenario, options.frames, options.steps)?;
    if options.video && !ffmpeg_is_there() {
        return Err(RecordError::NoFfmpeg);
    }
    if let Some(own) = lies_in(experiment, &options.out) {
        return Err(RecordError::OwnFolder(own));
    }
    let (nx, ny) = scenario.cloth.cells();
    let mut view = scenario.view.clone();
    if let Some(pixels) = options.pixels {
        view.pixels = pixels;
    }
    let manifest = Manifest {
        dyelapse: env!("CARGO_PKG_VERSION").into(),
        title: scenario.title.clone(),
        scenario: "scenario.ron".into(),
        pictures: recorder::pictures_beside(experiment),
        scenario_sha256: experiment.hash(),
        seed: scenario.seed,
        steps: plan.steps,
        step_h: scenario.process.step_h,
        draped: options.view == View::Draped,
        pixels: match options.view {
            View::Flat => (nx * scale as usize, ny * scale as usize),
            View::Draped => (view.pixels.0 as usize, view.pixels.1 as usize),
        },
        pixels_per_cell: scale,
        frames_planned: plan.frames(),
        fields,
        maps: options.maps,
        video: options.video,
        complete: false,
        frames: Vec::new(),
    };
    if options.view == View::Draped {
        view.check(&Checker::root().field("view"))
            .map_err(HungError::from)?;
        Draped::check()?;
        // What cannot be draped is told before anything is cleared away.
        Hung::new(scenario, options.drape.as_ref())?;
    }
    let folder = Folder::claim(&options.out, options.force, &manifest)?;
    let recorder = Recorder::start(experiment, folder.clone(), manifest)?;

    let mut app = bevy::app::App::new();
    app.add_plugins((DyeingPlugins, RecordPlugin))
        .insert_resource(Scale(scale))
        .insert_resource(recorder);
    if options.view == View::Draped {
        Draped::add_plugins(&mut app)?;
    }
    prepare(&mut app, experiment.clone());
    if options.maps {
        maps::write(&folder, app.world().resource(), scenario, scale as usize)?;
    }
    let mut draped = None;
    let mut broken = None;
    let mut complete = true;
    if options.view == View::Draped {
        let drape = options.drape.as_ref();
        let studio = Draped::start(&mut app, experiment, view, drape, &mut || go_on(0));
        complete = !matches!(studio, Err(RecordError::Stopped));
        if complete {
            draped = Some(studio?);
        }
    }

    for stop in &plan.stops {
        complete = complete && advance_to(app.world_mut(), stop.step, &mut go_on);
        if !complete {
            break;
        }
        if let Some(draped) = &mut draped {
            look(app.world_mut());
            let share = stop.step as f64 / plan.steps.max(1) as f64;
            let seen = match draped.see(&mut app, share, &mut || go_on(stop.step)) {
                Ok(seen) => seen,
                Err(RecordError::Stopped) => {
                    complete = false;
                    break;
                }
                Err(why) => {
                    // What is there by now is told of.
                    complete = false;
                    broken = Some(why);
                    break;
                }
            };
            app.world_mut().insert_resource(Seen(seen));
        }
        let world = app.world_mut();
        world.resource_mut::<Recorder>().expect(*stop);
        match draped {
            // It has been looked at, and is the same.
            Some(_) => world.run_system_cached(recorder::keep).unwrap_or_default(),
            None => look(world),
        }
        if world.resource::<Recorder>().has_failed() {
            break;
        }
    }
    let world = app.world_mut();
    let steps = world.resource::<crate::schedule::ProcessClock>().step;
    let Some(recorder) = world.remove_resource::<Recorder>() else {
        return Err(RecordError::Lost);
    };
    let manifest = recorder.finish(complete)?;
    if let Some(why) = broken {
        return Err(why);
    }
    if options.video {
        video::make(&folder, &manifest)?;
    }
    Ok(Recording {
        folder: options.out.clone(),
        frames: manifest.frames.len(),
        steps,
        complete,
    })
}

/// The scenario's file or the first of its pictures that lies in a folder: clearing the folder might
/// clear it away.
fn lies_in(experiment: &Experiment, folder: &Path) -> Option<PathBuf> {
    let Origin::File(file) = &experiment.origin else {
        return None;
    };
    let beside = file.parent().unwrap_or(Path::new(""));
    let pictures = experiment.images.files().map(|name| beside.join(name));
    let folder = folder.canonicalize().ok()?;
    [file.clone()]
        .into_iter()
        .chain(pictures)
        .find(|own| own.canonicalize().is_ok_and(|own| own.starts_with(&folder)))
}

/// The default folder for a recording of an experiment.
pub fn default_folder(experiment: &Experiment) -> PathBuf {
    Path::new("recordings").join(&experiment.name)
}
