//! `dyelapse record`.

use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use super::progress::Progress;
use super::{BAD_INPUT, INTERRUPTED, complain, failed, say};
use crate::cli::Record;
use dyelapse::record::{Options, default_folder, record};
use dyelapse::scenario::Experiment;

pub fn run(arguments: &Record) -> ExitCode {
    let experiment = match Experiment::load(&arguments.scenario) {
        Ok(experiment) => experiment,
        Err(why) => {
            complain(&why);
            return ExitCode::from(BAD_INPUT);
        }
    };
    let options = Options {
        out: arguments
            .out
            .clone()
            .unwrap_or_else(|| default_folder(&experiment)),
        frames: arguments.frames,
        steps: arguments.steps,
        scale: arguments.scale,
        fields: arguments.fields,
        maps: arguments.maps,
        video: arguments.video,
        force: arguments.force,
    };

    let interrupted = Arc::new(AtomicBool::new(false));
    let heard = interrupted.clone();
    if let Err(why) = ctrlc::set_handler(move || heard.store(true, Ordering::Relaxed)) {
        complain(&format!("Ctrl-C will not leave a whole recording: {why}"));
    }
    let steps = arguments
        .steps
        .unwrap_or_else(|| experiment.scenario.process.steps());
    let began = Instant::now();
    // Begun by the first step: what is refused before is told in one message and no other.
    let mut progress = None;
    let recorded = record(&experiment, &options, |step| {
        let title = &experiment.scenario.title;
        progress
            .get_or_insert_with(|| Progress::new(title, steps, arguments.quiet))
            .at(step);
        !interrupted.load(Ordering::Relaxed)
    });
    if let Some(progress) = progress {
        progress.end();
    }
    match recorded {
        Ok(recording) => {
            let seconds = began.elapsed().as_secs_f64();
            let ended = if recording.complete { "" } else { "stopped; " };
            if !arguments.quiet {
                say(&format!(
                    "{ended}{} frames in {} ({} steps in {seconds:.2} s)",
                    recording.frames,
                    recording.folder.display(),
                    recording.steps
                ));
            }
            if recording.complete {
                ExitCode::SUCCESS
            } else {
                ExitCode::from(INTERRUPTED)
            }
        }
        Err(why) => failed(&why, why.is_bad_input()),
    }
}
