//! `dyelapse watch`.

use std::process::ExitCode;

use crate::cli::Watch;

/// Opens the window.
#[cfg(feature = "viewer")]
pub fn run(arguments: &Watch) -> ExitCode {
    use super::failed;
    use dyelapse::watch::{NoWindow, Options, run};

    let options = Options {
        scenario: arguments.scenario.clone(),
        script: arguments.script.clone(),
        log: arguments.log.clone(),
        size: arguments.size,
    };
    match run(&options) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => failed(&why, !matches!(why, NoWindow::Thread(_) | NoWindow::Broken)),
    }
}

/// Tells that there is no window in this build.
#[cfg(not(feature = "viewer"))]
pub fn run(_: &Watch) -> ExitCode {
    super::failed(
        &"this dyelapse was built without the feature `viewer`, and has no window: build it with `cargo \
          build --release`, or record instead (dyelapse record seikaiha)",
        true,
    )
}
