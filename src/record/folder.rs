//! The folder of a recording: claimed once, and every file in it whole or not there at all.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Component, Path, PathBuf};

use super::RecordError;
use super::manifest::{MANIFEST, Manifest};
use super::maps::MAPS;

/// The folder of a recording.
#[derive(Debug, Clone)]
pub(super) struct Folder {
    path: PathBuf,
}

/// What marks a file that is still being written.
const UNFINISHED: &str = ".part";

/// The names of everything that a recording may make.
pub(super) fn names_of(recording: &Manifest) -> BTreeSet<String> {
    let mut names: BTreeSet<String> = ["scenario.ron", "ledger.csv", "sheet.png", MANIFEST]
        .map(Into::into)
        .into();
    for frame in 0..recording.frames_planned {
        names.insert(frame_name(frame));
        if recording.fields {
            names.insert(state_name(frame));
        }
    }
    if recording.fields {
        names.insert("cloth.npz".into());
    }
    if recording.maps {
        names.extend(MAPS.map(Into::into));
    }
    if recording.video {
        names.insert("video.mp4".into());
    }
    names.extend(recording.pictures.iter().filter_map(|name| below(name)));
    names
}

/// The name of a frame's picture.
pub(super) fn frame_name(frame: u32) -> String {
    format!("frame_{frame:05}.png")
}

/// The name of a frame's fields.
pub(super) fn state_name(frame: u32) -> String {
    format!("state_{frame:05}.npz")
}

/// A path written plainly, if it leads to something below where it begins: no `..`, no root.
pub(super) fn below(path: &str) -> Option<String> {
    let mut parts = Vec::new();
    for part in Path::new(path).components() {
        match part {
            Component::Normal(part) => parts.push(part.to_str()?),
            Component::CurDir => {}
            _ => return None,
        }
    }
    (!parts.is_empty()).then(|| parts.join("/"))
}

impl Folder {
    /// Makes the folder, or takes an empty one. With `force`, a recording in it is cleared away: what
    /// its manifest says that it made. Everything else is left alone, and where the `new` recording
    /// would need the name of something else, the folder is refused.
    pub(super) fn claim(path: &Path, force: bool, new: &Manifest) -> Result<Self, RecordError> {
        let failed = |why| RecordError::Folder {
            path: path.into(),
            why,
        };
        if path.exists() && !path.is_dir() {
            return Err(RecordError::NotAFolder(path.into()));
        }
        let folder = Folder { path: path.into() };
        let own = names_of(&Manifest {
            pictures: Vec::new(),
            ..new.clone()
        });
        if let Some(picture) = new.pictures.iter().find(|name| own.contains(*name)) {
            return Err(RecordError::TakenName(picture.into()));
        }
        fs::create_dir_all(path).map_err(failed)?;
        let mut entries = fs::read_dir(path).map_err(failed)?;
        if entries.next().is_none() {
            return Ok(folder);
        }
        if !force {
            return Err(RecordError::NotEmpty(path.into()));
        }
        let old = folder
            .old_manifest()
            .map_or(BTreeSet::new(), |old| names_of(&old));
        let exists = |name: &&String| folder.file(name).symlink_metadata().is_ok();
        if let Some(foreign) = names_of(new).difference(&old).find(exists) {
            return Err(RecordError::Foreign(folder.file(foreign)));
        }
        let here = path.canonicalize().map_err(failed)?;
        // The manifest goes last: until then the rest is known to be a recording's.
        let others = old.iter().filter(|name| *name != MANIFEST);
        for name in others.chain(old.get(MANIFEST)) {
            for file in [unfinished(&folder.file(name)), folder.file(name)] {
                // A link on the way must not lead out of the folder.
                let is_inside = |parent: PathBuf| parent.starts_with(&here);
                let parent = file.parent().and_then(|parent| parent.canonicalize().ok());
                if file.symlink_metadata().is_ok() && parent.is_some_and(is_inside) {
                    fs::remove_file(&file).map_err(failed)?;
                }
            }
            // A picture's own folder, if nothing else is in it: removing fails where there is.
            if let Some(parent) = Path::new(name)
                .parent()
                .filter(|p| !p.as_os_str().is_empty())
            {
                let _ = fs::remove_dir(folder.path.join(parent));
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
        write_whole(&self.file(name), fill)
    }

    /// Writes a file of text.
    pub(super) fn write_text(&self, name: &str, text: &str) -> Result<(), RecordError> {
        self.write(name, |file| file.write_all(text.as_bytes()))
    }
}

/// Writes a file, and the folders that lead to it: under another name first, and under its own when
/// it is whole.
pub(crate) fn write_whole(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), RecordError> {
    let unfinished = unfinished(path);
    let beside = path.parent().map_or(Ok(()), fs::create_dir_all);
    let written = beside
        .and_then(|()| File::create(&unfinished))
        .and_then(|file| {
            let mut file = BufWriter::with_capacity(1 << 18, file);
            fill(&mut file)?;
            file.flush()?;
            drop(file);
            fs::rename(&unfinished, path)
        });
    written.map_err(|why| {
        // Best effort: what matters is the first error.
        let _ = fs::remove_file(&unfinished);
        let path = path.into();
        RecordError::Write { path, why }
    })
}

/// The name of a file while it is being written.
pub(super) fn unfinished(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}{UNFINISHED}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_below_is_written_plainly_and_no_other_is_one() {
        assert_eq!(below("a.png").as_deref(), Some("a.png"));
        assert_eq!(below("./pics//a.png").as_deref(), Some("pics/a.png"));
        for path in ["../a.png", "pics/../../a.png", "/a.png", "", "."] {
            assert_eq!(below(path), None, "{path}");
        }
    }
}
