//! The folder of a recording: claimed once, and every file in it whole or not there at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::RecordError;
use super::manifest::{MANIFEST, Manifest};

/// The folder of a recording.
#[derive(Debug, Clone)]
pub(super) struct Folder {
    path: PathBuf,
}

/// What marks a file that is still being written.
const UNFINISHED: &str = ".part";

impl Folder {
    /// Makes the folder, or takes an empty one. With `force`, a recording in it is cleared away;
    /// files that no recording has made are never touched, and where the new recording would
    /// need the name of one, the folder is refused. `pictures` are the scenario's, by their paths.
    pub(super) fn claim(
        path: &Path,
        force: bool,
        pictures: &[String],
    ) -> Result<Self, RecordError> {
        let failed = |why| RecordError::Folder {
            path: path.into(),
            why,
        };
        if path.exists() && !path.is_dir() {
            return Err(RecordError::NotAFolder(path.into()));
        }
        let folder = Folder { path: path.into() };
        if let Some(picture) = pictures.iter().find(|name| is_of_a_recording(name)) {
            return Err(RecordError::TakenName(picture.into()));
        }
        fs::create_dir_all(path).map_err(failed)?;
        let entries: Vec<_> = fs::read_dir(path)
            .and_then(Iterator::collect::<io::Result<_>>)
            .map_err(failed)?;
        if entries.is_empty() {
            return Ok(folder);
        }
        if !force {
            return Err(RecordError::NotEmpty(path.into()));
        }
        let old = folder.old_manifest();
        let named: Vec<PathBuf> = entries
            .iter()
            .filter(|entry| entry.file_name().to_str().is_some_and(is_of_a_recording))
            .map(fs::DirEntry::path)
            .collect();
        let old_pictures = old.as_ref().map_or(&[][..], |old| &old.pictures);
        let foreign_picture = pictures
            .iter()
            .filter(|name| !old_pictures.contains(name))
            .map(|name| folder.file(name))
            .find(|file| file.exists());
        let foreign = match &old {
            None => named.first().cloned().or(foreign_picture),
            Some(_) => foreign_picture,
        };
        if let Some(file) = foreign {
            return Err(RecordError::Foreign(file));
        }
        let old_pictures = old_pictures.iter().map(|name| folder.file(name));
        for file in named.into_iter().chain(old_pictures) {
            if file.is_file() {
                fs::remove_file(&file).map_err(failed)?;
            }
        }
        Ok(folder)
    }

    fn old_manifest(&self) -> Option<Manifest> {
        let text = fs::read_to_string(self.file(MANIFEST)).ok()?;
        ron::from_str(&text).ok()
    }

    /// The path of a file in the folder.
    pub(super) fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Writes a file: under another name first, and under its own when it is whole.
    pub(super) fn write(
        &self,
        name: &str,
        fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
    ) -> Result<(), RecordError> {
        let path = self.file(name);
        let unfinished = unfinished(&path);
        let beside = path.parent().map_or(Ok(()), fs::create_dir_all);
        let written = beside
            .and_then(|()| File::create(&unfinished))
            .and_then(|file| {
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

    /// Writes a file of text.
    pub(super) fn write_text(&self, name: &str, text: &str) -> Result<(), RecordError> {
        self.write(name, |file| file.write_all(text.as_bytes()))
    }
}

/// The name of a file while it is being written.
pub(super) fn unfinished(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}{UNFINISHED}"))
}

/// Whether a recording makes files of this name.
fn is_of_a_recording(name: &str) -> bool {
    let numbered = |prefix: &str, ending: &str| {
        name.strip_prefix(prefix)
            .and_then(|rest| rest.strip_suffix(ending))
            .is_some_and(|number| {
                number.len() >= 5 && number.bytes().all(|byte| byte.is_ascii_digit())
            })
    };
    let single = [
        MANIFEST,
        "scenario.ron",
        "ledger.csv",
        "sheet.png",
        "cloth.npz",
        "video.mp4",
    ];
    let whole = name
        .strip_prefix('.')
        .and_then(|name| name.strip_suffix(UNFINISHED));
    single.contains(&name)
        || numbered("frame_", ".png")
        || numbered("state_", ".npz")
        || whole.is_some_and(is_of_a_recording)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_of_a_recording_are_its_own() {
        for name in [
            "frame_00000.png",
            "frame_123456.png",
            "state_00010.npz",
            "sheet.png",
            ".frame_00001.png.part",
        ] {
            assert!(is_of_a_recording(name), "{name}");
        }
        for name in [
            "frame_1.png",
            "frame_best.png",
            "notes.txt",
            "cloth.ron",
            "my_sheet.png",
            ".notes.txt.part",
        ] {
            assert!(!is_of_a_recording(name), "{name}");
        }
    }
}
