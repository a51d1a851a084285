//! The window in which dyeing is watched, and played with.
//!
//! | file | what it does |
//! |---|---|
//! | [`worker`] | the process on its own thread: orders in, pictures out |
//! | [`hanger`] | the draped cloth on its own thread, in real time |
//! | [`state`] | what the window knows, and takes over from the threads |
//! | [`view3d`] | the studio, drawn when something has changed |
//! | [`layout`] | where everything is |
//! | [`bars`] | files, tools, time |
//! | [`panel`] | the parameters of the scenario |
//! | [`canvas`] | the cloth, and what the pointer does on it |
//! | [`tools`] | the tools, how the flat cloth is seen |
//! | [`plots`] | ledger and cross-section |
//! | [`gallery`], [`dialogs`], [`keys`] | windows over the others, keys |
//! | [`files`], [`recording`], [`settings`] | the disk |
//! | [`script`] | the window without hands |
//!
//! The window changes nothing in the process itself: it gives orders, and shows what comes back.

pub mod bars;
pub mod canvas;
pub mod dialogs;
pub mod files;
pub mod gallery;
pub mod hanger;
pub mod keys;
pub mod layout;
pub mod panel;
pub mod plots;
pub mod recording;
pub mod script;
pub mod settings;
pub mod state;
pub mod tools;
pub mod view3d;
pub mod worker;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use bevy::app::TerminalCtrlCHandlerPlugin;
use bevy::log::LogPlugin;
use bevy::prelude::*;
use bevy::window::{ExitCondition, PrimaryWindow, WindowCloseRequested, WindowResolution};
use bevy::winit::{EventLoopProxyWrapper, UpdateMode, WinitSettings, WinitUserEvent};
use bevy_egui::{EguiPlugin, EguiPrimaryContextPass};
use thiserror::Error;

use crate::scenario::{Experiment, ScenarioError};
use crate::studio::offscreen::{NoFrame, check_driver, render_plugin};
use hanger::Hanger;
use script::Script;
use settings::Settings;
use state::Watch;
use worker::Worker;

/// What is opened when nothing is named.
pub const FIRST: &str = "seikaiha";

/// Memory for moments to go back to, bytes.
const BUDGET: usize = 768 << 20;

/// How the window is opened.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// The scenario; left out, the one that was open last.
    pub scenario: Option<String>,
    /// A script to follow.
    pub script: Option<PathBuf>,
    /// A file for what happened.
    pub log: Option<PathBuf>,
    /// Width and height of the window, points; left out, as it was last.
    pub size: Option<(u32, u32)>,
}

/// Why there is no window.
#[derive(Debug, Error)]
pub enum NoWindow {
    /// The scenario is not right.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// No driver.
    #[error(transparent)]
    Driver(#[from] NoFrame),
    /// Nothing to show a window on.
    #[error(
        "there is no display to open a window on (neither DISPLAY nor WAYLAND_DISPLAY leads to one). \
         Without one, `dyelapse record` makes pictures and films: dyelapse record seikaiha"
    )]
    Display,
    /// The script cannot be followed.
    #[error("{0}")]
    Script(String),
    /// The window broke off.
    #[error("the window broke off: the graphics driver may have failed")]
    Broken,
    /// The system gives no threads.
    #[error("no thread for the process: {0}")]
    Thread(#[from] std::io::Error),
}

/// Opens the window, and returns when it is closed.
///
/// # Errors
/// [`NoWindow`] if there is none.
pub fn run(options: &Options) -> Result<(), NoWindow> {
    let settings = Settings::load();
    let script =
        Script::load(options.script.as_ref(), options.log.as_ref()).map_err(NoWindow::Script)?;
    let experiment = match (&options.scenario, &settings.last) {
        (Some(name), _) => Experiment::load(name)?,
        // What was open last may be gone.
        (None, Some(last)) => Experiment::load(last).or_else(|_| Experiment::load(FIRST))?,
        (None, None) => Experiment::load(FIRST)?,
    };
    if !has_display() {
        return Err(NoWindow::Display);
    }
    check_driver()?;
    let (width, height) = options
        .size
        .unwrap_or((settings.window.0 as u32, settings.window.1 as u32));
    let window = WindowPlugin {
        primary_window: Some(Window {
            title: "dyelapse".into(),
            resolution: WindowResolution::new(width, height),
            ..default()
        }),
        // Changes may have to be saved first, and a recording ended.
        close_when_requested: false,
        exit_condition: ExitCondition::DontExit,
        ..default()
    };
    let mut app = open(window).ok_or(NoWindow::Display)?;
    let interrupted = Arc::new(AtomicBool::new(false));
    let heard = interrupted.clone();
    // Without a handler Ctrl-C ends the program at once.
    let _ = ctrlc::set_handler(move || heard.store(true, Ordering::Relaxed));
    let proxy = app.world().get_resource::<EventLoopProxyWrapper>();
    let proxy = proxy.map(|proxy| (**proxy).clone());
    let wake = move || {
        if let Some(proxy) = &proxy {
            // A window that has closed needs no waking.
            let _ = proxy.send_event(WinitUserEvent::WakeUp);
        }
    };
    let worker = Worker::start(experiment.clone(), BUDGET, wake.clone())?;
    let hanger = Hanger::start(wake)?;
    let always = script.is_running();
    app.insert_resource(WinitSettings {
        focused_mode: mode(always),
        unfocused_mode: mode(always),
    });
    app.add_systems(Startup, move |world: &mut World| start(world))
        .add_systems(EguiPrimaryContextPass, layout::draw)
        .add_systems(
            Update,
            (state::receive, script::act, attend, view3d::draw).chain(),
        );
    let world = app.world_mut();
    let images = [state::blank(world), state::blank(world)];
    let watch = Watch::new(&experiment, (worker, hanger), settings, script, images);
    world.insert_resource(watch);
    world.insert_resource(Interrupted(interrupted));
    match app.run() {
        AppExit::Success => Ok(()),
        AppExit::Error(_) => Err(NoWindow::Broken),
    }
}

/// Whether Ctrl-C was pressed where the window was opened from.
#[derive(Resource)]
struct Interrupted(Arc<AtomicBool>);

fn mode(always: bool) -> UpdateMode {
    match always {
        true => UpdateMode::Continuous,
        // Threads and people wake it; a file that changes is seen soon.
        false => UpdateMode::reactive(Duration::from_millis(250)),
    }
}

/// Whether there may be a display; other systems always have one.
fn has_display() -> bool {
    let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !cfg!(target_os = "linux") || is_set("DISPLAY") || is_set("WAYLAND_DISPLAY")
}

/// An app with a window to come; none if the display cannot be reached, over which winit panics.
fn open(window: WindowPlugin) -> Option<App> {
    let old = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let opened = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        let mut app = App::new();
        app.add_plugins(
            DefaultPlugins
                .set(window)
                .set(render_plugin())
                .disable::<LogPlugin>()
                .disable::<TerminalCtrlCHandlerPlugin>(),
        )
        .add_plugins(EguiPlugin::default())
        .insert_resource(ClearColor(Color::srgb_u8(22, 22, 22)));
        app
    }));
    std::panic::set_hook(old);
    opened.ok()
}

fn start(world: &mut World) {
    // The camera that the panel is drawn with.
    world.spawn((Camera2d, Msaa::Off, bevy_egui::PrimaryEguiContext));
    view3d::start(world);
}

/// Files that were dropped or have changed, recordings that have ended, the end.
fn attend(
    mut watch: ResMut<Watch>,
    mut dropped: MessageReader<FileDragAndDrop>,
    mut close: MessageReader<WindowCloseRequested>,
    mut exit: MessageWriter<AppExit>,
    interrupted: Res<Interrupted>,
    window: Option<Single<&Window, With<PrimaryWindow>>>,
) {
    let watch = &mut *watch;
    for event in dropped.read() {
        if let FileDragAndDrop::DroppedFile { path_buf, .. } = event {
            dialogs::dropped(watch, path_buf.clone());
        }
    }
    if watch.files.has_changed()
        && let Some(file) = watch.file.clone()
    {
        let name = file.display().to_string();
        if watch.unsaved {
            watch.changed_on_disk = true;
            watch.leaving = Some(dialogs::Leaving::Open(name));
        } else {
            watch.open(&name);
            if watch.problem.is_none() {
                watch.tell("the file has changed: opened again");
            }
        }
    }
    watch.attend_recording();
    if close.read().count() > 0 {
        watch.leave_for(dialogs::Leaving::Close);
    }
    if interrupted.0.load(Ordering::Relaxed) {
        watch.closing = true;
    }
    if watch.closing {
        if let Some(window) = window {
            watch.settings.window = (window.width(), window.height());
        }
        if !watch.script.was_given() {
            watch.settings.save();
        }
        if let Some(mut recording) = watch.recording.take() {
            recording.stop();
            recording.wait();
        }
        exit.write(AppExit::Success);
    }
}
