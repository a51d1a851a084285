//! A film of the frames, made by ffmpeg where it is installed.

use std::fs;
use std::process::{Command, Stdio};

use super::folder::{Folder, unfinished};
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
pub(super) fn make(folder: &Folder, manifest: &Manifest) -> Result<(), RecordError> {
    if manifest.frames.is_empty() {
        return Ok(());
    }
    let film = folder.file("video.mp4");
    let unfinished = unfinished(&film);
    let mut ffmpeg = Command::new("ffmpeg");
    // Ctrl-C is for the recording; the film of what there is gets finished.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut ffmpeg, 0);
    let output = ffmpeg
        // In the folder itself: a `%` in its path would mean something to ffmpeg.
        .current_dir(folder.file("."))
        .args(["-y", "-loglevel", "error", "-framerate", FRAMES_A_SECOND])
        .args(["-i", "frame_%05d.png"])
        .args(["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white"])
        .args(["-pix_fmt", "yuv420p", "-movflags", "+faststart"])
        .args(["-f", "mp4"])
        .arg(unfinished.file_name().unwrap_or_default())
        .stdin(Stdio::null())
        .output();
    let failed = match output {
        Err(why) => why.to_string(),
        Ok(output) if !output.status.success() => {
            String::from_utf8_lossy(&output.stderr).trim().to_owned()
        }
        Ok(_) => {
            return fs::rename(&unfinished, &film)
                .map_err(|why| RecordError::Write { path: film, why });
        }
    };
    // Best effort: what matters is why there is no film.
    let _ = fs::remove_file(&unfinished);
    Err(RecordError::Ffmpeg(failed))
}
