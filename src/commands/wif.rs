//! `dyelapse wif`.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use super::{BAD_INPUT, FAILED, complain, print, say};
use crate::cli::Wif;
use dyelapse::cloth::Weave;
use dyelapse::draft::{self, Draft, DraftError, Reading, wif};
use dyelapse::scenario::{Experiment, ScenarioError};

pub fn run(arguments: &Wif) -> ExitCode {
    let what = arguments.what.as_str();
    if is_draft(what) {
        return match Draft::load(what) {
            Ok(reading) => tell(&reading, arguments),
            Err(why) => refuse(&why),
        };
    }
    let experiment = match Experiment::load(what) {
        Ok(experiment) => experiment,
        Err(ScenarioError::Unknown { nearest: None, .. }) => return refuse_unknown(what),
        Err(why) => return refuse(&why),
    };
    let draft = match &experiment.scenario.cloth.weave {
        // It was woven from a draft: that is its draft.
        Weave::Wif { file, .. } => experiment.images.draft(file).cloned().map(Ok),
        _ => None,
    };
    match draft.unwrap_or_else(|| Draft::of_scenario(&experiment.scenario)) {
        Ok(draft) => match &arguments.out {
            Some(out) => keep(&draft, out, arguments.force),
            None => print(wif::write(&draft).as_bytes()),
        },
        Err(why) => refuse(&why),
    }
}

/// A file that ends in `.wif`, or a bundled draft that no scenario has the name of.
fn is_draft(what: &str) -> bool {
    let path = Path::new(what);
    let ends = path
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("wif"));
    let bundled = || draft::bundled_names().contains(&what) && !path.exists();
    ends || bundled()
}

/// Nothing has this name, nor is it like that of a scenario; perhaps it is like that of a draft.
fn refuse_unknown(what: &str) -> ExitCode {
    match Draft::load(what) {
        Err(DraftError::Unknown {
            nearest: Some(nearest),
            ..
        }) => refuse(&format!(
            "there is no file, scenario or draft named `{what}`; did you mean `{nearest}`?"
        )),
        _ => refuse(&format!(
            "there is no file, scenario or draft named `{what}`\n`dyelapse list` shows the bundled ones"
        )),
    }
}

/// Sums a draft up; writes it anew if asked to.
fn tell(reading: &Reading, arguments: &Wif) -> ExitCode {
    let mut text = reading.draft.summary();
    if !reading.warnings.is_empty() {
        text.push_str("\nread with warnings:\n");
        for warning in &reading.warnings {
            let _ = writeln!(text, " {warning}");
        }
    }
    let told = print(text.as_bytes());
    match &arguments.out {
        Some(out) if told == ExitCode::SUCCESS => keep(&reading.draft, out, arguments.force),
        _ => told,
    }
}

/// Writes a draft to a file: under another name first, and under its own when it is whole.
fn keep(draft: &Draft, out: &Path, force: bool) -> ExitCode {
    let shown = out.display();
    if out.is_dir() {
        return refuse(&format!(
            "{shown} is a folder; the draft needs the name of a file"
        ));
    }
    if out.exists() && !force {
        return refuse(&format!("{shown} is there already; --force replaces it"));
    }
    let folder = out.parent().filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
        return refuse(&format!("there is no folder {}", folder.display()));
    }
    let Some(name) = out.file_name() else {
        return refuse(&format!("{shown} is no name of a file"));
    };
    let unfinished = out.with_file_name(format!(".{}.part", name.to_string_lossy()));
    let written =
        write(&unfinished, &wif::write(draft)).and_then(|()| fs::rename(&unfinished, out));
    if let Err(why) = written {
        // Best effort: what matters is the first error.
        let _ = fs::remove_file(&unfinished);
        complain(&format!("cannot write {shown}: {why}"));
        return ExitCode::from(FAILED);
    }
    say(&format!("wrote {shown}"));
    ExitCode::SUCCESS
}

fn write(path: &Path, text: &str) -> io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(text.as_bytes())?;
    file.flush()
}

fn refuse(why: &impl std::fmt::Display) -> ExitCode {
    complain(why);
    ExitCode::from(BAD_INPUT)
}
