//! `dyelapse list`.

use std::error::Error;
use std::fmt::Write;
use std::process::ExitCode;

use super::{FAILED, complain, print};
use dyelapse::draft::{self, Draft};
use dyelapse::scenario::{Experiment, Figure, bundled_names, figure_names};

pub fn run() -> ExitCode {
    match list() {
        Ok(list) => print(list.as_bytes()),
        Err(why) => {
            complain(&why);
            ExitCode::from(FAILED)
        }
    }
}

fn list() -> Result<String, Box<dyn Error>> {
    let (scenarios, figures) = (bundled_names(), figure_names());
    let drafts = draft::bundled_names();
    let names = scenarios.iter().chain(&figures).chain(&drafts);
    let widest = names.map(|name| name.len()).max().unwrap_or(0);
    let mut list = String::new();
    for name in scenarios {
        let title = Experiment::load(name)?.scenario.title;
        let _ = writeln!(list, "{name:widest$}  {title}");
    }
    let _ = writeln!(list, "\nFigures, for `dyelapse sheet`:");
    for name in figures {
        let title = Figure::of(&[name])?.title;
        let _ = writeln!(list, "{name:widest$}  {title}");
    }
    let _ = writeln!(list, "\nDrafts, for `dyelapse wif`:");
    for name in drafts {
        let title = Draft::load(name)?.draft.title().to_owned();
        let _ = writeln!(list, "{name:widest$}  {title}");
    }
    Ok(list)
}
