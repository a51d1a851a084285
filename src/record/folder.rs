//! The folder of a recording: claimed once, and every file in it whole or not there at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::RecordError;

/// The folder of a recording.
#[derive(Debug, Clone)]
pub(super) struct Folder {
    path: PathBuf,
}

/// What marks a file that is still being written.
const UNFINISHED: &str = ".part";

impl Folder {
    /// Makes the folder, or takes an empty one. With `force`, one that holds a recording is cleared
    /// of it; files that no recording has are never touched.
    pub fn claim(path: &Path, force: bool) -> Result<Self, RecordError> {
        let failed = |why| RecordError::Folder {
            path: path.into(),
            why,
        };
        if path.exists() && !path.is_dir() {
            return Err(RecordError::NotAFolder(path.into()));
        }
        fs::create_dir_all(path).map_err(failed)?;
        let entries: Vec<_> = fs::read_dir(path)
            .and_then(Iterator::collect::<io::Result<_>>)
            .map_err(failed)?;
        if !entries.is_empty() && !force {
            return Err(RecordError::NotEmpty(path.into()));
        }
        for entry in entries {
            let name = entry.file_name();
            if name.to_str().is_some_and(is_of_a_recording) && entry.path().is_file() {
                fs::remove_file(entry.path()).map_err(failed)?;
            }
        }
        Ok(Folder { path: path.into() })
    }

    /// The path of a file in the folder.
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Writes a file: under another name first, and under its own when it is whole.
    pub fn write(
        &self,
        name: &str,
        fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
    ) -> Result<(), RecordError> {
        let path = self.file(name);
        let unfinished = self.file(&format!(".{name}{UNFINISHED}"));
        let written = File::create(&unfinished).and_then(|file| {
            let mut file = BufWriter::with_capacity(1 << 18, file);
            fill(&mut file)?;
            file.flush()?;
            drop(file);
            fs::rename(&unfinished, &path)
        });
        written.map_err(|why| {
            // Best effort: what matters is the first error.
            let _ = fs::remove_file(&unfinished);
            RecordError::Write { path, why }
        })
    }
}

/// Whether a recording may have made a file of this name.
fn is_of_a_recording(name: &str) -> bool {
    let numbered = |prefix: &str, ending: &str| {
        name.strip_prefix(prefix)
            .and_then(|rest| rest.strip_suffix(ending))
            .is_some_and(|number| {
                number.len() >= 5 && number.bytes().all(|byte| byte.is_ascii_digit())
            })
    };
    [
        "recording.ron",
        "ledger.csv",
        "sheet.png",
        "cloth.npz",
        "video.mp4",
    ]
    .contains(&name)
        || numbered("frame_", ".png")
        || numbered("state_", ".npz")
        || (name.starts_with('.') && name.ends_with(UNFINISHED))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_files_of_a_recording_are_ever_cleared() {
        for name in [
            "frame_00000.png",
            "frame_123456.png",
            "state_00010.npz",
            "sheet.png",
        ] {
            assert!(is_of_a_recording(name), "{name}");
        }
        for name in [
            "frame_1.png",
            "frame_best.png",
            "notes.txt",
            "cloth.ron",
            "my_sheet.png",
        ] {
            assert!(!is_of_a_recording(name), "{name}");
        }
    }
}
