//! Files: what is asked for in dialogs, dropped on the window, or changed on disk.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use bevy_egui::egui;
use egui_file_dialog::FileDialog;
use notify::{RecommendedWatcher, RecursiveMode, Watcher};

use super::panel::PanelAsk;

/// What a dialog is open for.
#[derive(Debug, Clone, PartialEq)]
pub enum Wanted {
    /// A scenario to open.
    Open,
    /// Where to save.
    SaveAs,
    /// The folder of a recording.
    RecordTo,
    /// Something for the panel.
    Panel(PanelAsk),
}

/// What a file that was dropped is for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Dropped {
    /// A scenario: open it.
    Scenario,
    /// A draft: weave it.
    Draft,
    /// A picture: resist, dark where cloth stays white.
    Picture,
    /// None of these.
    Unknown,
}

/// What a file is by its name.
pub fn kind_of(path: &Path) -> Dropped {
    let ending = path.extension().and_then(|ending| ending.to_str());
    match ending.map(str::to_lowercase).as_deref() {
        Some("ron") => Dropped::Scenario,
        Some("wif") => Dropped::Draft,
        Some("png" | "jpg" | "jpeg") => Dropped::Picture,
        _ => Dropped::Unknown,
    }
}

/// Changes of one save come close together.
const SETTLED: Duration = Duration::from_millis(150);

/// Dialogs, and the file that is watched.
#[derive(Default)]
pub struct Files {
    dialog: FileDialog,
    wanted: Option<Wanted>,
    watched: Option<(RecommendedWatcher, Arc<AtomicBool>)>,
    changed: Option<Instant>,
    ignored_until: Option<Instant>,
}

impl Files {
    /// Opens a dialog.
    pub fn ask(&mut self, wanted: Wanted, name: &str) {
        let dialog = FileDialog::new().as_modal(true);
        self.dialog = match &wanted {
            Wanted::Open => dialog
                .title("Open a scenario")
                .add_file_filter_extensions("scenarios", vec!["ron"])
                .default_file_filter("scenarios"),
            Wanted::SaveAs => dialog
                .title("Save the scenario")
                .default_file_name(&format!("{name}.ron"))
                .add_save_extension("scenarios", "ron")
                .default_save_extension("scenarios"),
            Wanted::RecordTo => dialog.title("A folder for the recording"),
            Wanted::Panel(PanelAsk::OpenWif) => dialog
                .title("Open a draft")
                .add_file_filter_extensions("drafts", vec!["wif"])
                .default_file_filter("drafts"),
            Wanted::Panel(PanelAsk::OpenImage { .. }) => dialog
                .title("Open a picture")
                .add_file_filter_extensions("pictures", vec!["png", "jpg", "jpeg"])
                .default_file_filter("pictures"),
        };
        match wanted {
            Wanted::SaveAs => self.dialog.save_file(),
            Wanted::RecordTo => self.dialog.pick_directory(),
            _ => self.dialog.pick_file(),
        }
        self.wanted = Some(wanted);
    }

    /// Shows the dialog, if one is open; what was chosen, and what for.
    pub fn show(&mut self, ctx: &egui::Context) -> Option<(Wanted, PathBuf)> {
        self.wanted.as_ref()?;
        self.dialog.update(ctx);
        let path = self.dialog.take_picked()?;
        Some((self.wanted.take()?, path))
    }

    /// Watches a file from now on, or none.
    ///
    /// # Errors
    /// Where the system cannot watch it.
    pub fn watch(&mut self, file: Option<&Path>) -> notify::Result<()> {
        self.watched = None;
        self.changed = None;
        let Some(file) = file else { return Ok(()) };
        let file = file.canonicalize().unwrap_or_else(|_| file.into());
        let told = Arc::new(AtomicBool::new(false));
        let tell = told.clone();
        let own = file.clone();
        let mut watcher =
            notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
                let is_change = |event: &notify::Event| !event.kind.is_access();
                if event.is_ok_and(|event| is_change(&event) && event.paths.contains(&own)) {
                    tell.store(true, Ordering::Relaxed);
                }
            })?;
        // The folder: many editors write another file and rename it.
        let folder = file.parent().unwrap_or(Path::new("."));
        watcher.watch(folder, RecursiveMode::NonRecursive)?;
        self.watched = Some((watcher, told));
        Ok(())
    }

    /// The next change is our own.
    pub fn ignore_own_change(&mut self) {
        self.ignored_until = Some(Instant::now() + 4 * SETTLED);
    }

    /// Whether the watched file has changed, and nothing since a little while.
    pub fn has_changed(&mut self) -> bool {
        let told = self.watched.as_ref();
        if told.is_some_and(|(_, told)| told.swap(false, Ordering::Relaxed)) {
            let own = self
                .ignored_until
                .is_some_and(|until| Instant::now() < until);
            self.changed = (!own).then(Instant::now);
        }
        let settled = self
            .changed
            .is_some_and(|changed| changed.elapsed() > SETTLED);
        if settled {
            self.changed = None;
        }
        settled
    }

    /// Whether a change has been seen that is not settled yet.
    pub fn is_waiting(&self) -> bool {
        self.changed.is_some()
    }
}
