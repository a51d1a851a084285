//! A film of the frames, made by ffmpeg where it is installed.

use std::path::Path;
use std::process::{Command, Stdio};

use super::{Manifest, RecordError};

/// Frames a second of the film.
const FRAMES_A_SECOND: &str = "24";

/// Whether ffmpeg can be run.
pub fn ffmpeg_is_there() -> bool {
    Command::new("ffmpeg")
        .arg("-version")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success())
}

/// Makes `video.mp4` of the frames in a folder. Sides are padded to even sizes, since most players
/// need them (yuv420p).
pub(super) fn make(folder: &Path, manifest: &Manifest) -> Result<(), RecordError> {
    if manifest.frames.is_empty() {
        return Ok(());
    }
    let output = Command::new("ffmpeg")
        .current_dir(folder)
        .args(["-y", "-loglevel", "error", "-framerate", FRAMES_A_SECOND])
        .args(["-i", "frame_%05d.png"])
        .args(["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white"])
        .args(["-pix_fmt", "yuv420p", "-movflags", "+faststart"])
        .args(["-f", "mp4", ".video.mp4.part"])
        .stdin(Stdio::null())
        .output()
        .map_err(|why| RecordError::Ffmpeg(why.to_string()))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr).trim().to_owned();
        return Err(RecordError::Ffmpeg(said));
    }
    let path = folder.join("video.mp4");
    std::fs::rename(folder.join(".video.mp4.part"), &path)
        .map_err(|why| RecordError::Write { path, why })
}
