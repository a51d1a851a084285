//! The drafts that come with the program, and drafts from files.

use std::fs;
use std::path::Path;

use include_dir::{Dir, include_dir};

use super::{Draft, DraftError, Reading, wif};
use crate::scenario::nearest;

static DRAFTS: Dir = include_dir!("$CARGO_MANIFEST_DIR/assets/drafts");

/// The longest draft file that is read, bytes. The largest draft that can be written has fewer.
const LONGEST_FILE: u64 = 128 << 20;

/// A draft that comes with the program.
#[derive(Debug, Clone, Copy)]
pub struct Bundled {
    /// Its name, such as `houndstooth`.
    pub name: &'static str,
    /// Its text, a WIF.
    pub text: &'static str,
}

/// All bundled drafts, by name.
pub fn bundled() -> impl Iterator<Item = Bundled> {
    DRAFTS.files().filter_map(|file| {
        let path = file.path();
        let name = path.file_stem()?.to_str()?;
        let is_wif = path.extension().is_some_and(|ext| ext == "wif");
        is_wif.then_some(Bundled {
            name,
            text: file.contents_utf8()?,
        })
    })
}

/// The names of all bundled drafts, sorted.
pub fn names() -> Vec<&'static str> {
    let mut names: Vec<_> = bundled().map(|draft| draft.name).collect();
    names.sort_unstable();
    names
}

impl Draft {
    /// Loads a draft from a WIF file, or the bundled one of this name (with or without `.wif`) if
    /// there is no such file.
    ///
    /// # Errors
    /// A [`DraftError`] that names the file, and the line if it is about one.
    pub fn load(name_or_path: &str) -> Result<Reading, DraftError> {
        let path = Path::new(name_or_path);
        if !path.exists() {
            let name = name_or_path.strip_suffix(".wif").unwrap_or(name_or_path);
            if let Some(draft) = bundled().find(|draft| draft.name == name) {
                return wif::read(name_or_path, draft.text.as_bytes());
            }
            if path.components().count() <= 1 {
                return Err(DraftError::Unknown {
                    name: name_or_path.into(),
                    nearest: nearest(name, names()).map(Into::into),
                });
            }
        }
        let bytes = bytes_of(path).map_err(|why| DraftError::Unreadable {
            path: path.into(),
            why,
        })?;
        wif::read(name_or_path, &bytes)
    }
}

fn bytes_of(path: &Path) -> Result<Vec<u8>, String> {
    let size = fs::metadata(path).map_err(|why| why.to_string())?;
    if size.is_dir() {
        return Err("it is a folder".into());
    }
    if size.len() > LONGEST_FILE {
        return Err(format!(
            "it has {} bytes, more than the {LONGEST_FILE} that a draft may have",
            size.len()
        ));
    }
    fs::read(path).map_err(|why| why.to_string())
}
