//! `dyelapse segment`.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::answer;
use crate::cli::Segment;
use dyelapse::photo::segment::{Hints, Segmentation, segment};
use dyelapse::photo::{Photo, PhotoError, draw};

pub fn run(arguments: &Segment) -> ExitCode {
    answer(done(arguments))
}

fn done(arguments: &Segment) -> Result<String, PhotoError> {
    let hints = Hints {
        weave: arguments.weave.as_deref().map(str::parse).transpose()?,
        pitch: arguments.pitch.as_deref().map(pitch).transpose()?,
    };
    let out = arguments
        .out
        .clone()
        .unwrap_or_else(|| beside(&arguments.photo));
    let drawn = [
        Some(&out),
        arguments.doubt.as_ref(),
        arguments.overlay.as_ref(),
    ];
    for file in drawn.into_iter().flatten() {
        draw::may_write(file, arguments.force, &arguments.photo)?;
    }
    let photo = Photo::load_to_segment(&arguments.photo)?;
    let found = segment(&photo, &hints).map_err(|why| why.in_file(&arguments.photo))?;
    draw::write(&out, &found.mask.picture())?;
    if let Some(file) = &arguments.doubt {
        draw::write(file, &draw::doubt(&photo, &found.doubt))?;
    }
    if let Some(file) = &arguments.overlay {
        draw::write(file, &draw::overlay(&photo, &found.mask))?;
    }
    Ok(report(&found, &out))
}

/// The mask of `cloth.jpg` is `cloth_mask.png`.
fn beside(photo: &Path) -> PathBuf {
    let mut name = photo.file_stem().unwrap_or_default().to_os_string();
    name.push("_mask.png");
    photo.with_file_name(name)
}

fn pitch(text: &str) -> Result<[f64; 2], PhotoError> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
    match numbers.unwrap_or_default()[..] {
        [warp, weft] if [warp, weft].iter().all(|p| (2.1..=1000.0).contains(p)) => Ok([warp, weft]),
        _ => Err(PhotoError::Pitch { text: text.into() }),
    }
}

fn report(found: &Segmentation, out: &Path) -> String {
    let mut text = String::new();
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let names = ["warp", "weft"];
    for (k, name) in names.into_iter().enumerate() {
        let _ = writeln!(
            text,
            "{name}: {} yarns, {:.2} pixels apart, turned by {:.1}°",
            found.yarns[k], found.pitch[k], found.turned[k]
        );
    }
    let _ = writeln!(text, "weave: {}", found.weave);
    for row in &found.weave.rows {
        let _ = writeln!(text, "  {row}");
    }
    let warp = found.mask.warp_share();
    let _ = writeln!(
        text,
        "on top: warp {}, weft {}",
        percent(warp),
        percent(1.0 - warp)
    );
    let _ = writeln!(text, "doubtful: {}", percent(found.doubtful_share()));
    let _ = writeln!(text, "mask: {}", out.display());
    text
}
