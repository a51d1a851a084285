//! What can be wrong with a photograph, its mask, or what is asked of it.

use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a photograph or a mask cannot be used, or a picture cannot be written.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PhotoError {
    /// The file is missing, or not a whole picture of a known kind.
    #[error("the picture {}: {why}", .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        why: String,
    },
    /// It does not fit in memory.
    #[error(
        "the picture {}: its {nx}×{ny} pixels need {} MB of memory, but only {} MB are free; \
         cut out a part or make it smaller", .path.display(), .needed / 1_000_000, .free / 1_000_000
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Pixels across.
        nx: usize,
        /// Pixels down.
        ny: usize,
        /// Bytes needed.
        needed: u64,
        /// Bytes free.
        free: u64,
    },
    /// It shows too little to find yarns in.
    #[error(
        "the photograph{} has {nx}×{ny} pixels; to find yarns it needs at least {least} both ways",
        named(.path)
    )]
    TooSmall {
        /// The file, if it is known.
        path: Option<PathBuf>,
        /// Pixels across.
        nx: usize,
        /// Pixels down.
        ny: usize,
        /// Pixels needed.
        least: usize,
    },
    /// No woven cloth is seen in it.
    #[error("no woven cloth is seen in the photograph{}: {why}", named(.path))]
    NoCloth {
        /// The file, if it is known.
        path: Option<PathBuf>,
        /// What is missing, and what may help.
        why: String,
    },
    /// A mask of another size than its photograph.
    #[error(
        "the mask {} has {}×{} pixels but its photograph has {}×{}; a mask has one pixel for each \
         of the photograph", .path.display(), .mask.0, .mask.1, .photo.0, .photo.1
    )]
    MaskSize {
        /// The mask's file.
        path: PathBuf,
        /// Its pixels, across and down.
        mask: (usize, usize),
        /// The photograph's.
        photo: (usize, usize),
    },
    /// Pixels of a mask that are neither blue nor red.
    #[error(
        "the mask {}: {count} pixels are neither blue (warp on top) nor red (weft on top), the first \
         at ({}, {}), which is #{:02x}{:02x}{:02x}; paint them 0,0,255 or 255,0,0",
        .path.display(), .first.0, .first.1, .colour[0], .colour[1], .colour[2]
    )]
    MaskColour {
        /// The mask's file.
        path: PathBuf,
        /// How many there are.
        count: usize,
        /// The place of the first, across and down from the upper left corner.
        first: (usize, usize),
        /// Its colour.
        colour: [u8; 3],
    },
    /// A weave that cannot be read.
    #[error("the weave `{text}`: {why}")]
    Weave {
        /// What was typed.
        text: String,
        /// What is wrong, and what would be right.
        why: String,
    },
    /// Pitches that cannot be read.
    #[error(
        "the pitch `{text}`: it is two numbers of pixels from 2.1 to 1000, warp and weft, as in `3.5,5.3`"
    )]
    Pitch {
        /// What was typed.
        text: String,
    },
    /// A file that is not to be written over.
    #[error("{} {}", .path.display(), if *.is_photo {
        "is the photograph itself, which is not written over"
    } else {
        "is already there; `--force` replaces it"
    })]
    Occupied {
        /// The file.
        path: PathBuf,
        /// Whether it is the photograph.
        is_photo: bool,
    },
    /// A part of a photograph that cannot be measured.
    #[error("the region {text}: {why}")]
    Region {
        /// The region, as it was typed.
        text: String,
        /// What is wrong, and what would be right.
        why: String,
    },
    /// Too few pixels of dyed cloth to measure colours of.
    #[error("colours cannot be measured: {why}")]
    NoColours {
        /// What is missing.
        why: String,
    },
    /// A picture cannot be written.
    #[error("cannot write {}: {why}", .path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// Why.
        why: String,
    },
}

impl PhotoError {
    /// The same about the photograph of a file.
    pub fn in_file(mut self, file: &Path) -> Self {
        if let PhotoError::TooSmall { path, .. } | PhotoError::NoCloth { path, .. } = &mut self {
            *path = Some(file.into());
        }
        self
    }

    /// Whether the one who asked can mend it; else it is the machine's fault.
    pub fn is_bad_input(&self) -> bool {
        !matches!(self, PhotoError::Unwritable { .. })
    }
}

fn named(path: &Option<PathBuf>) -> String {
    path.as_ref()
        .map_or(String::new(), |path| format!(" {}", path.display()))
}
