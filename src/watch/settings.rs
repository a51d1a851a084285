//! What the window remembers from one time to the next.

use std::fs;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

/// What is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Layout {
    /// Flat and draped, side by side.
    #[default]
    Both,
    /// Only flat.
    Flat,
    /// Only draped.
    Draped,
}

/// What the window remembers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Width and height of the window, points.
    pub window: (f32, f32),
    /// What is shown.
    pub layout: Layout,
    /// Whether the parameters are there.
    pub panel: bool,
    /// Whether the plots are there.
    pub plots: bool,
    /// How large everything is, 1 for the system's own size.
    pub zoom: f32,
    /// What was open last.
    pub last: Option<String>,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            window: (1280.0, 800.0),
            layout: Layout::Both,
            panel: true,
            plots: true,
            zoom: 1.0,
            last: None,
        }
    }
}

/// The file; none on a system that has no place for it. The variable `DYELAPSE_SETTINGS` names another.
fn file() -> Option<PathBuf> {
    if let Some(file) = std::env::var_os("DYELAPSE_SETTINGS") {
        return Some(file.into());
    }
    let folders = directories::ProjectDirs::from("", "", "dyelapse")?;
    Some(folders.config_dir().join("window.ron"))
}

impl Settings {
    /// What was remembered; the defaults where nothing was, or not in a way that can be read.
    pub fn load() -> Self {
        let text = file().and_then(|file| fs::read_to_string(file).ok());
        let settings: Option<Settings> = text.and_then(|text| ron::from_str(&text).ok());
        settings.unwrap_or_default().in_bounds()
    }

    fn in_bounds(mut self) -> Self {
        let side = |length: f32| match length.is_finite() {
            true => length.clamp(640.0, 8192.0),
            false => 1280.0,
        };
        self.window = (side(self.window.0), side(self.window.1).max(480.0));
        self.zoom = if self.zoom.is_finite() {
            self.zoom.clamp(0.5, 3.0)
        } else {
            1.0
        };
        self
    }

    /// Remembers. A disk that is full is no reason not to close.
    pub fn save(&self) {
        let Some(file) = file() else { return };
        if let Some(folder) = file.parent() {
            let _ = fs::create_dir_all(folder);
        }
        let text = ron::ser::to_string_pretty(self, ron::ser::PrettyConfig::default());
        if let Ok(text) = text {
            let _ = fs::write(file, text);
        }
    }
}
