//! Encoding and writing beside the simulation: two threads behind a bounded queue.

use std::io::{self, BufWriter};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use super::RecordError;
use super::fields::State;
use super::folder::Folder;
use crate::texture::Picture;

/// Frames that may wait for the disk: more would only take memory.
const QUEUE: usize = 2;
/// Threads that write: encoding a frame takes longer than drawing it.
const THREADS: usize = 2;

/// Something to be written.
pub(super) enum Job {
    Picture { name: String, picture: Picture },
    State { name: String, state: Box<State> },
}

/// The threads that write.
pub(super) struct Writer {
    queue: SyncSender<Job>,
    threads: Vec<JoinHandle<Result<(), RecordError>>>,
    failed: Arc<AtomicBool>,
}

impl Writer {
    /// Starts the threads.
    pub fn start(folder: Folder) -> Self {
        let (queue, jobs) = sync_channel(QUEUE);
        let jobs = Arc::new(Mutex::new(jobs));
        let failed = Arc::new(AtomicBool::new(false));
        let thread = |_| {
            let (folder, jobs, failed) = (folder.clone(), jobs.clone(), failed.clone());
            thread::spawn(move || {
                let written = write_all(&folder, &jobs, &failed);
                if written.is_err() {
                    failed.store(true, Ordering::Relaxed);
                }
                written
            })
        };
        let threads = (0..THREADS).map(thread).collect();
        Writer {
            queue,
            threads,
            failed,
        }
    }

    /// Hands over a job; waits while too many are waiting. False if writing has failed.
    pub fn give(&self, job: Job) -> bool {
        !self.failed.load(Ordering::Relaxed) && self.queue.send(job).is_ok()
    }

    /// Waits until everything is written.
    pub fn finish(self) -> Result<(), RecordError> {
        drop(self.queue);
        let wait = |thread: JoinHandle<_>| match thread.join() {
            Ok(result) => result,
            Err(panic) => std::panic::resume_unwind(panic),
        };
        // All are waited for, whatever becomes of the first.
        let results: Vec<_> = self.threads.into_iter().map(wait).collect();
        results.into_iter().collect()
    }
}

/// Writes what comes, until there is no more or something fails.
fn write_all(
    folder: &Folder,
    jobs: &Mutex<Receiver<Job>>,
    failed: &AtomicBool,
) -> Result<(), RecordError> {
    loop {
        // Whoever waits for a job keeps the others waiting for the lock, which is the same.
        let job = jobs.lock().unwrap_or_else(PoisonError::into_inner).recv();
        let Ok(job) = job else { return Ok(()) };
        if failed.load(Ordering::Relaxed) {
            return Ok(());
        }
        match job {
            Job::Picture { name, picture } => {
                folder.write(&name, |file| encode(&picture, file))?;
            }
            Job::State { name, state } => folder.write(&name, |file| state.write(file))?,
        }
    }
}

/// Encodes a picture as PNG: quickly, since a recording has many.
pub(super) fn encode(picture: &Picture, file: &mut BufWriter<std::fs::File>) -> io::Result<()> {
    let (width, height) = (picture.width as u32, picture.height as u32);
    PngEncoder::new_with_quality(file, CompressionType::Fast, FilterType::Sub)
        .write_image(&picture.rgb, width, height, ExtendedColorType::Rgb8)
        .map_err(io::Error::other)
}
