//! `dyelapse sheet`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use super::progress::Progress;
use super::{BAD_INPUT, INTERRUPTED, complain, failed, say};
use crate::cli::Sheet;
use dyelapse::record::{PictureFile, RecordError, draw_figure};
use dyelapse::scenario::{Figure, MOST_PANELS};

pub fn run(arguments: &Sheet) -> ExitCode {
    let figure = match figure(arguments) {
        Ok(figure) => figure,
        Err(why) => {
            complain(&why);
            return ExitCode::from(BAD_INPUT);
        }
    };
    let out = match &arguments.out {
        Some(out) => out.clone(),
        None => PathBuf::from(format!("{}.png", figure.name)),
    };
    match draw(arguments, &figure, &out) {
        Ok(code) => code,
        Err(why) => failed(&why, why.is_bad_input()),
    }
}

/// What was asked for.
fn figure(arguments: &Sheet) -> Result<Figure, String> {
    let mut figure = Figure::of(&arguments.names).map_err(|why| why.to_string())?;
    if figure.panels.len() > MOST_PANELS {
        return Err(format!(
            "a sheet has room for {MOST_PANELS} panels, but these are {}",
            figure.panels.len()
        ));
    }
    if let Some(columns) = arguments.columns {
        if !(1..=MOST_PANELS as u32).contains(&columns) {
            return Err(format!(
                "--columns: 1 to {MOST_PANELS} is allowed, but this is {columns}"
            ));
        }
        figure.columns = Some(columns);
    }
    if let Some(step) = arguments.steps {
        let shown = figure.show_at(step);
        shown.map_err(|why| format!("--steps: {why}"))?;
    }
    if let Some(scale) = arguments.scale {
        let shown = figure.show_scaled(scale);
        shown.map_err(|why| format!("--scale: {why}"))?;
    }
    Ok(figure)
}

fn draw(arguments: &Sheet, figure: &Figure, out: &Path) -> Result<ExitCode, RecordError> {
    let file = PictureFile::claim(out, arguments.force)?;
    let interrupted = Arc::new(AtomicBool::new(false));
    let heard = interrupted.clone();
    if let Err(why) = ctrlc::set_handler(move || heard.store(true, Ordering::Relaxed)) {
        complain(&format!("Ctrl-C will not end this in order: {why}"));
    }
    let began = Instant::now();
    let steps: u64 = figure
        .panels
        .iter()
        .map(|panel| panel.step)
        .max()
        .unwrap_or(0);
    let panels = figure.panels.len();
    // Every panel is shown as a part as long as the longest.
    let mut progress = None;
    let picture = draw_figure(figure, |panel, step| {
        progress
            .get_or_insert_with(|| {
                let title = if figure.title.is_empty() {
                    &figure.name
                } else {
                    &figure.title
                };
                Progress::new(title, steps * panels as u64, arguments.quiet)
            })
            .at(panel as u64 * steps + step);
        !interrupted.load(Ordering::Relaxed)
    });
    if let Some(progress) = progress {
        progress.end();
    }
    let Some(picture) = picture? else {
        say(&"stopped; no picture was written");
        return Ok(ExitCode::from(INTERRUPTED));
    };
    file.write(&picture)?;
    if !arguments.quiet {
        let seconds = began.elapsed().as_secs_f64();
        let (width, height) = (picture.width, picture.height);
        say(&format!(
            "{panels} panels, {width}×{height} pixels, in {} ({seconds:.2} s)",
            out.display()
        ));
    }
    Ok(ExitCode::SUCCESS)
}
