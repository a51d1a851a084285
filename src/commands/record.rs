//! `dyelapse record`.

use std::fs;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use super::progress::Progress;
use super::{BAD_INPUT, INTERRUPTED, complain, failed, say};
use crate::cli::{self, Record};
use dyelapse::drape::scenes;
use dyelapse::record::{Options, View, default_folder, record};
use dyelapse::scenario::check::Checker;
use dyelapse::scenario::{Draping, Experiment, unknown_drape};

pub fn run(arguments: &Record) -> ExitCode {
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
        view: match arguments.view {
            cli::View::Flat => View::Flat,
            cli::View::Draped => View::Draped,
        },
        drape,
        pixels: arguments.size,
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

/// What `--drape` means: a bundled drape, or a file of one.
pub fn draping(name: &str) -> Result<Draping, String> {
    let path = Path::new(name);
    if !path.is_file() {
        return match scenes::text(name) {
            Some(_) => Ok(Draping::Bundled(name.into())),
            None => Err(format!("--drape: {}", unknown_drape(name))),
        };
    }
    let text = fs::read_to_string(path).map_err(|why| format!("cannot read {name}: {why}"))?;
    let spec = scenes::parse(&text).map_err(|why| format!("{name}:{why}"))?;
    let checked = spec.check(&Checker::root());
    checked.map_err(|problem| format!("{name}: {problem}"))?;
    Ok(Draping::Own(Box::new(spec)))
}
