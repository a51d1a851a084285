//! Why a recording could not be made.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use crate::memory::MemoryError;
use crate::scenario::LARGEST_SCALE;
use crate::studio::hung::HungError;
#[cfg(feature = "viewer")]
use crate::studio::offscreen::NoFrame;

/// Why a recording could not be made.
#[derive(Debug, Error)]
pub enum RecordError {
    /// The scale is out of range.
    #[error("--scale: 1 to {LARGEST_SCALE} pixels a cell is allowed, but this is {0}")]
    Scale(u32),
    /// The number of frames is out of range.
    #[error(
        "--frames: 1 to {most} frames are possible in {steps} steps, but this asks for {frames}"
    )]
    Frames {
        /// The number asked for.
        frames: u32,
        /// The most that are possible.
        most: u64,
        /// The steps of the process.
        steps: u64,
    },
    /// The number of steps is out of range.
    #[error("--steps: 0 to {most} is allowed, but this is {steps}")]
    Steps {
        /// The number asked for.
        steps: u64,
        /// The most that are possible.
        most: u64,
    },
    /// The cloth does not fit in memory.
    #[error(transparent)]
    Memory(#[from] MemoryError),
    /// A film was asked for but cannot be made here.
    #[error(
        "--video needs the program ffmpeg, and it is not on the path: install it (its package is \
         usually called ffmpeg), or record without --video"
    )]
    NoFfmpeg,
    /// There is something in the folder already.
    #[error(
        "the folder {} is not empty: choose another with --out, or give --force to replace the \
         recording in it", .0.display()
    )]
    NotEmpty(PathBuf),
    /// With `force`, a file that no recording made would have to be replaced.
    #[error(
        "{} is in the way, and no recording made it: move it, or choose another folder with --out",
        .0.display()
    )]
    Foreign(PathBuf),
    /// The scenario, or a picture of it, lies in the folder itself.
    #[error("{} lies in the folder of the recording itself: choose another with --out", .0.display())]
    OwnFolder(PathBuf),
    /// A picture of the scenario has the name of a file that a recording makes.
    #[error("the picture {0} has the name of a file that a recording makes: give it another name")]
    TakenName(String),
    /// The folder is a file.
    #[error("{} is a file, not a folder", .0.display())]
    NotAFolder(PathBuf),
    /// The file of a picture is a folder.
    #[error("{} is a folder, not a file", .0.display())]
    IsAFolder(PathBuf),
    /// The file of a picture has an ending that says something else.
    #[error("--out: pictures are written as .png or .jpg, but this is {}", .0.display())]
    NotAPicture(PathBuf),
    /// The file of a picture is there already.
    #[error(
        "{} is there already: choose another name with --out, or give --force to replace it",
        .0.display()
    )]
    Exists(PathBuf),
    /// The folder cannot be made or looked into.
    #[error("cannot use the folder {}: {why}", .path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// The reason.
        why: io::Error,
    },
    /// A file could not be written.
    #[error("cannot write {}: {why}", .path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// The reason.
        why: io::Error,
    },
    /// The cloth cannot be draped.
    #[error("the cloth cannot be draped: {0}")]
    Draped(#[from] HungError),
    /// Draped cloth cannot be drawn.
    #[cfg(feature = "viewer")]
    #[error(transparent)]
    NoFrame(#[from] NoFrame),
    /// Draped cloth was asked for, and the program was built without it.
    #[error(
        "this dyelapse was built without the feature `viewer`, and cannot draw draped cloth: build it \
         with `cargo build --release`, or leave out --view draped"
    )]
    NoViewer,
    /// It was stopped before there was a frame.
    #[error("stopped before the first frame")]
    Stopped,
    /// ffmpeg failed.
    #[error("the frames are all there, but ffmpeg could not make a film of them: {0}")]
    Ffmpeg(String),
    /// A plugin took the recorder away while it was at work.
    #[error("the recorder was removed from the app before the recording was done")]
    Lost,
}

impl RecordError {
    /// Whether the one who asked can mend it by asking otherwise; the rest is the machine's fault.
    pub fn is_bad_input(&self) -> bool {
        !matches!(
            self,
            RecordError::Write { .. } | RecordError::Ffmpeg(_) | RecordError::Lost
        )
    }
}
