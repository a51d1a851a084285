//! What each command does.

mod check;
mod export;
mod list;
mod palette;
mod progress;
mod record;
mod segment;
mod sheet;
mod watch;
mod wif;

use std::fmt::Display;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::CommandFactory;

use crate::cli::{Cli, Command};
use dyelapse::photo::PhotoError;

/// Something the one who asked can mend: a scenario, an argument, a folder.
const BAD_INPUT: u8 = 2;
/// Something that is wrong with the machine: a full disk, say.
const FAILED: u8 = 1;
/// Ended by Ctrl-C.
const INTERRUPTED: u8 = 130;

/// Does what was typed.
pub fn run(cli: Cli) -> ExitCode {
    let command = cli
        .command
        .unwrap_or_else(|| Command::Watch(Default::default()));
    match command {
        Command::Watch(arguments) => watch::run(&arguments),
        Command::Record(arguments) => record::run(&arguments),
        Command::Export(arguments) => export::run(&arguments),
        Command::Sheet(arguments) => sheet::run(&arguments),
        Command::Check { scenarios } => check::run(&scenarios),
        Command::List => list::run(),
        Command::Wif(arguments) => wif::run(&arguments),
        Command::Segment(arguments) => segment::run(&arguments),
        Command::Palette(arguments) => palette::run(&arguments),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "dyelapse", &mut script);
            print(&script)
        }
    }
}

/// Prints to standard output. A reader that has gone (`dyelapse list | head -1`) is no error.
fn print(text: &[u8]) -> ExitCode {
    match io::stdout().write_all(text) {
        Err(why) if why.kind() != io::ErrorKind::BrokenPipe => {
            complain(&format!("cannot print: {why}"));
            ExitCode::from(FAILED)
        }
        _ => ExitCode::SUCCESS,
    }
}

/// Prints what was asked of a photograph, or complains.
fn answer(answer: Result<String, PhotoError>) -> ExitCode {
    match answer {
        Ok(text) => print(text.as_bytes()),
        Err(why) => failed(&why, why.is_bad_input()),
    }
}

/// Complains, and tells by the exit code whether the one who asked can mend it.
fn failed(why: &impl Display, is_bad_input: bool) -> ExitCode {
    complain(why);
    ExitCode::from(if is_bad_input { BAD_INPUT } else { FAILED })
}

/// Says something on standard error. Nobody is left to tell if that fails.
fn say(what: &impl Display) {
    let _ = writeln!(io::stderr(), "{what}");
}

/// Says what is wrong.
fn complain(what: &impl Display) {
    say(&format!("dyelapse: {what}"));
}
