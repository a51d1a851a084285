//! Encoding and writing beside the simulation: one thread behind a bounded queue.

use std::io::{self, BufWriter};
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::{self, JoinHandle};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use super::RecordError;
use super::fields::State;
use super::folder::Folder;
use crate::texture::Picture;

/// Frames that may wait for the disk: more would only take memory.
const QUEUE: usize = 2;

/// Something to be written.
pub(super) enum Job {
    Picture { name: String, picture: Picture },
    State { name: String, state: Box<State> },
}

/// The thread that writes.
pub(super) struct Writer {
    queue: SyncSender<Job>,
    thread: JoinHandle<Result<(), RecordError>>,
}

impl Writer {
    /// Starts the thread.
    pub fn start(folder: Folder) -> Self {
        let (queue, jobs) = sync_channel(QUEUE);
        let thread = thread::spawn(move || {
            for job in jobs {
                match job {
                    Job::Picture { name, picture } => {
                        folder.write(&name, |file| encode(&picture, file))?;
                    }
                    Job::State { name, state } => folder.write(&name, |file| state.write(file))?,
                }
            }
            Ok(())
        });
        Writer { queue, thread }
    }

    /// Hands a job to the thread; waits while too many are waiting. False if writing has failed.
    pub fn give(&self, job: Job) -> bool {
        self.queue.send(job).is_ok()
    }

    /// Waits until everything is written.
    pub fn finish(self) -> Result<(), RecordError> {
        drop(self.queue);
        match self.thread.join() {
            Ok(result) => result,
            Err(panic) => std::panic::resume_unwind(panic),
        }
    }
}

/// Encodes a picture as PNG: quickly, since a recording has many.
pub(super) fn encode(picture: &Picture, file: &mut BufWriter<std::fs::File>) -> io::Result<()> {
    let (width, height) = (picture.width as u32, picture.height as u32);
    PngEncoder::new_with_quality(file, CompressionType::Fast, FilterType::Adaptive)
        .write_image(&picture.rgb, width, height, ExtendedColorType::Rgb8)
        .map_err(io::Error::other)
}
