//! The files that lie beside a scenario: in its folder, or bundled with it.

use std::fs;
use std::path::{Path, PathBuf};

use super::experiment::Origin;
use super::library;
use crate::memory;

/// Where the files lie that a scenario names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Beside {
    /// In a folder.
    Folder(PathBuf),
    /// Among the bundled ones.
    Bundled,
}

impl Beside {
    /// Where the files of a scenario lie that came from `origin`.
    pub fn of(origin: &Origin) -> Self {
        match origin {
            Origin::Bundled => Beside::Bundled,
            Origin::File(path) => Beside::Folder(path.parent().unwrap_or(Path::new("")).into()),
            Origin::Memory => Beside::Folder(PathBuf::new()),
        }
    }

    /// The path of a file, to be shown in messages.
    pub fn path(&self, name: &str) -> PathBuf {
        match self {
            Beside::Folder(folder) => folder.join(name),
            Beside::Bundled => PathBuf::from(name),
        }
    }

    /// Reads a file.
    ///
    /// # Errors
    /// What is wrong, in a few words.
    pub fn read(&self, name: &str) -> Result<Vec<u8>, String> {
        let Beside::Folder(_) = self else {
            return match library::file(name) {
                Some(bytes) => Ok(bytes.to_vec()),
                None => Err("it is not among the bundled files".into()),
            };
        };
        read(&self.path(name))
    }
}

/// Reads a file that fits in memory.
///
/// # Errors
/// What is wrong, in a few words.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, String> {
    let cannot = |why| format!("it cannot be read: {why}");
    let size = fs::metadata(path).map_err(cannot)?;
    if size.is_dir() {
        return Err("it is a folder".into());
    }
    if size.len() > memory::free() {
        return Err(format!("its {} bytes do not fit in memory", size.len()));
    }
    fs::read(path).map_err(cannot)
}
