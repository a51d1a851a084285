//! `dyelapse list`.

use std::fmt::Write;
use std::process::ExitCode;

use super::{FAILED, complain, print};
use dyelapse::draft::{self, Draft};
use dyelapse::scenario::{Experiment, bundled_names};

pub fn run() -> ExitCode {
    let names = bundled_names();
    let drafts = draft::bundled_names();
    let all = names.iter().chain(&drafts);
    let widest = all.map(|name| name.len()).max().unwrap_or(0);
    let mut list = String::new();
    for name in names {
        match Experiment::load(name) {
            Ok(experiment) => {
                let title = &experiment.scenario.title;
                let _ = writeln!(list, "{name:widest$}  {title}");
            }
            Err(why) => {
                complain(&why);
                return ExitCode::from(FAILED);
            }
        }
    }
    let _ = writeln!(list, "\ndrafts for `dyelapse wif`:");
    for name in drafts {
        match Draft::load(name) {
            Ok(reading) => {
                let _ = writeln!(list, "{name:widest$}  {}", reading.draft.title());
            }
            Err(why) => {
                complain(&why);
                return ExitCode::from(FAILED);
            }
        }
    }
    print(list.as_bytes())
}
