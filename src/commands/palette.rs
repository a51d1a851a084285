//! `dyelapse palette`.

use std::fmt::Write;
use std::process::ExitCode;

use super::answer;
use crate::cli::Palette;
use dyelapse::photo::palette::{Region, measure};
use dyelapse::photo::{Photo, PhotoError, draw};

pub fn run(arguments: &Palette) -> ExitCode {
    answer(done(arguments))
}

fn done(arguments: &Palette) -> Result<String, PhotoError> {
    let region = arguments.region.as_deref().map(region).transpose()?;
    if let Some(file) = &arguments.swatch {
        draw::may_write(file, arguments.force, &arguments.photo)?;
    }
    let photo = Photo::load(&arguments.photo)?;
    let palette = measure(&photo, region)?;
    if let Some(file) = &arguments.swatch {
        draw::write(file, &palette.swatch())?;
    }
    let mut text = palette.to_ron();
    text.push('\n');
    for (name, stop) in ["lightest", "middle", "darkest"].iter().zip(palette.stops) {
        let _ = match stop.pixels {
            0 => writeln!(
                text,
                "// {name}: nothing is half dyed; half-way between the others"
            ),
            pixels => writeln!(text, "// {name}: from {pixels} pixels"),
        };
    }
    Ok(text)
}

fn region(text: &str) -> Result<Region, PhotoError> {
    let numbers: Result<Vec<usize>, _> = text.split(',').map(|n| n.trim().parse()).collect();
    <Region>::try_from(numbers.unwrap_or_default())
        .ok()
        .ok_or_else(|| PhotoError::Region {
            text: text.into(),
            why: "it is left, top, width and height in pixels, as in `100,50,400,300`".into(),
        })
}
