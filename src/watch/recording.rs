//! Recording from the window: the same recorder as `dyelapse record`, on a thread of its own.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::JoinHandle;

use crate::record::{Options, RecordError, Recording, record};
use crate::scenario::Experiment;

/// A recording that is being made.
pub struct Running {
    /// Where it is made.
    pub folder: PathBuf,
    total: u64,
    step: Arc<AtomicU64>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<Result<Recording, RecordError>>>,
}

/// How a recording ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Ended {
    /// It is there; with so many frames, whole or stopped.
    Done {
        /// Where it is.
        folder: PathBuf,
        /// Frames kept.
        frames: usize,
        /// Whether it reached its end.
        complete: bool,
    },
    /// It could not be made.
    Failed(String),
}

impl Running {
    /// Begins to record an experiment. What is recorded is what its text says, so that recording the saved
    /// file gives the same bytes.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn start(experiment: Experiment, options: Options) -> std::io::Result<Self> {
        let total = options
            .steps
            .unwrap_or_else(|| experiment.scenario.process.steps());
        let (step, stop) = (
            Arc::new(AtomicU64::new(0)),
            Arc::new(AtomicBool::new(false)),
        );
        let (at, stopped) = (step.clone(), stop.clone());
        let folder = options.out.clone();
        let thread = std::thread::Builder::new()
            .name("recording".into())
            .spawn(move || {
                record(&experiment, &options, |step| {
                    at.store(step, Ordering::Relaxed);
                    !stopped.load(Ordering::Relaxed)
                })
            })?;
        Ok(Running {
            folder,
            total,
            step,
            stop,
            thread: Some(thread),
        })
    }

    /// The share that is done, 0 to 1.
    pub fn progress(&self) -> f32 {
        self.step.load(Ordering::Relaxed) as f32 / self.total.max(1) as f32
    }

    /// Ends early; what is there by then is a valid recording.
    pub fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    /// How it ended, once it has.
    pub fn ended(&mut self) -> Option<Ended> {
        if !self.thread.as_ref()?.is_finished() {
            return None;
        }
        self.wait()
    }

    /// Waits until it has ended.
    pub fn wait(&mut self) -> Option<Ended> {
        let ended = match self.thread.take()?.join() {
            Ok(Ok(recording)) => Ended::Done {
                folder: recording.folder,
                frames: recording.frames,
                complete: recording.complete,
            },
            Ok(Err(why)) => Ended::Failed(why.to_string()),
            Err(_) => Ended::Failed("the recorder broke off".into()),
        };
        Some(ended)
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // The window may be closed while it records: what is there then is whole.
        self.stop();
        self.wait();
    }
}
