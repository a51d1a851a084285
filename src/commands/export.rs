//! `dyelapse export`.

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::progress::Progress;
use super::record::draping;
use super::{BAD_INPUT, INTERRUPTED, complain, failed, say};
use crate::cli;
use dyelapse::record::{Export, RecordError, export};
use dyelapse::scenario::Experiment;

pub fn run(arguments: &cli::Export) -> ExitCode {
    let experiment = match Experiment::load(&arguments.scenario) {
        Ok(experiment) => experiment,
        Err(why) => {
            complain(&why);
            return ExitCode::from(BAD_INPUT);
        }
    };
    let drape = match arguments.drape.as_deref().map(draping).transpose() {
        Ok(drape) => drape,
        Err(why) => return failed(&why, true),
    };
    let default = || PathBuf::from(format!("{}.glb", experiment.name));
    let options = Export {
        out: arguments.out.clone().unwrap_or_else(default),
        step: arguments.step,
        scale: arguments.scale,
        drape,
        force: arguments.force,
    };
    let interrupted = Arc::new(AtomicBool::new(false));
    let heard = interrupted.clone();
    // Without a handler Ctrl-C ends the program, and nothing is written either.
    let _ = ctrlc::set_handler(move || heard.store(true, Ordering::Relaxed));
    let scenario = &experiment.scenario;
    let steps = arguments.step.unwrap_or_else(|| scenario.process.steps());
    let mut progress = Progress::new(&scenario.title, steps, arguments.quiet);
    let exported = export(&experiment, &options, |step| {
        progress.at(step);
        !interrupted.load(Ordering::Relaxed)
    });
    progress.end();
    match exported {
        Ok(()) => {
            if !arguments.quiet {
                say(&format!("wrote {}", options.out.display()));
            }
            ExitCode::SUCCESS
        }
        Err(RecordError::Stopped) => ExitCode::from(INTERRUPTED),
        Err(why) => failed(&why, why.is_bad_input()),
    }
}
