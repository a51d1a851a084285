//! Making a figure: every panel's cloth is dyed to its moment, looked at, and put on the sheet.

use std::ffi::OsStr;
use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use super::RecordError;
use super::folder::write_whole;
use super::sheet::Sheet;
use crate::memory::{self, Use};
use crate::scenario::{Figure, LARGEST_SCALE, Panel, Part};
use crate::schedule::advance_to;
use crate::texture::{Picture, change_look};
use crate::{dyeing_app, look};

/// Quality of JPEG pictures, of 100: no ringing that anyone sees around the yarns.
const JPEG_QUALITY: u8 = 80;

/// Makes a figure: all panels with their labels in one picture. The same figure gives the same
/// picture.
///
/// `go_on` is told the panel, in the order of the work, and the step, and asked whether to go on;
/// where it says no there is no picture.
///
/// # Errors
/// [`RecordError::Memory`] where a cloth does not fit.
pub fn draw_figure(
    figure: &Figure,
    go_on: impl FnMut(usize, u64) -> bool,
) -> Result<Option<Picture>, RecordError> {
    let mut sheet = Sheet::new(&figure.title).arranged(figure.columns, figure.panel_pixels);
    let pictures = draw_panels(figure, go_on)?;
    let sheet = pictures.map(|pictures| {
        for (picture, panel) in pictures.iter().zip(&figure.panels) {
            sheet.add(picture, panel.label.clone());
        }
        sheet.draw()
    });
    Ok(sheet)
}

/// Makes the pictures of a figure's panels, each by itself and as large as it is, in their order.
/// `go_on` and errors are those of [`draw_figure`].
///
/// # Errors
/// [`RecordError::Memory`] where a cloth does not fit.
pub fn draw_panels(
    figure: &Figure,
    mut go_on: impl FnMut(usize, u64) -> bool,
) -> Result<Option<Vec<Picture>>, RecordError> {
    let mut pictures = vec![Picture::default(); figure.panels.len()];
    let mut done = 0;
    for (i, experiment) in figure.experiments.iter().enumerate() {
        let is_its = |(_, panel): &(usize, &Panel)| panel.experiment == i;
        let mut panels: Vec<_> = figure.panels.iter().enumerate().filter(is_its).collect();
        panels.sort_by_key(|(_, panel)| panel.step);
        for (_, panel) in &panels {
            let scale = panel.look.pixels_per_cell;
            if !(1..=LARGEST_SCALE).contains(&scale) {
                return Err(RecordError::Scale(scale));
            }
            let fields = false;
            memory::check(&experiment.scenario, Use { scale, fields })?;
        }
        let Some((_, first)) = panels.first() else {
            continue;
        };
        let mut experiment = experiment.clone();
        experiment.scenario.look = first.look.clone();
        let mut app = dyeing_app(experiment);
        let world = app.world_mut();
        let mut shown = first.look.clone();
        for (place, panel) in panels {
            if !advance_to(world, panel.step, |step| go_on(done, step)) {
                return Ok(None);
            }
            if panel.look != shown {
                change_look(world, panel.look.clone());
                shown = panel.look.clone();
            }
            look(world);
            let scale = panel.look.pixels_per_cell as usize;
            let whole = world.resource::<Picture>();
            pictures[place] = match panel.part {
                None => whole.clone(),
                Some(part) => cut_out(whole, part, scale),
            };
            done += 1;
        }
    }
    Ok(Some(pictures))
}

/// A part of a picture that has `scale` pixels a cell; as much of it as there is.
fn cut_out(whole: &Picture, part: Part, scale: usize) -> Picture {
    let (left, top) = (part.x * scale, part.y * scale);
    let width = (part.width * scale).min(whole.width.saturating_sub(left));
    let height = (part.height * scale).min(whole.height.saturating_sub(top));
    let rows = whole.rgb.chunks_exact(3 * whole.width.max(1));
    let rgb = rows
        .skip(top)
        .take(height)
        .flat_map(|row| &row[3 * left..][..3 * width])
        .copied()
        .collect();
    Picture { width, height, rgb }
}

/// How a picture is written, by the ending of its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Png,
    Jpeg,
}

impl Format {
    fn of(path: &Path) -> Option<Self> {
        let ending = path.extension().and_then(OsStr::to_str)?;
        match ending.to_ascii_lowercase().as_str() {
            "png" => Some(Format::Png),
            "jpg" | "jpeg" => Some(Format::Jpeg),
            _ => None,
        }
    }
}

/// The file of one picture, asked for before the work begins.
#[derive(Debug, Clone)]
pub struct PictureFile {
    path: PathBuf,
    format: Format,
}

impl PictureFile {
    /// Claims a file with the ending of a PNG or JPEG picture. One that is there already is refused
    /// unless `replace` says otherwise, and is not touched before the new one is whole.
    ///
    /// # Errors
    /// [`RecordError::NotAPicture`], [`RecordError::Exists`].
    pub fn claim(path: &Path, replace: bool) -> Result<Self, RecordError> {
        let path = path.to_path_buf();
        if path.is_dir() {
            return Err(RecordError::IsAFolder(path));
        }
        let Some(format) = Format::of(&path) else {
            return Err(RecordError::NotAPicture(path));
        };
        if path.exists() && !replace {
            return Err(RecordError::Exists(path));
        }
        Ok(PictureFile { path, format })
    }

    /// Writes the picture.
    ///
    /// # Errors
    /// [`RecordError::Write`]; the file is whole or as it was.
    pub fn write(&self, picture: &Picture) -> Result<(), RecordError> {
        write_whole(&self.path, |file| encode(picture, self.format, file))
    }
}

fn encode(picture: &Picture, format: Format, file: &mut BufWriter<File>) -> io::Result<()> {
    let (width, height) = (picture.width as u32, picture.height as u32);
    let colour = ExtendedColorType::Rgb8;
    let written = match format {
        Format::Png => {
            PngEncoder::new_with_quality(file, CompressionType::Best, FilterType::Adaptive)
                .write_image(&picture.rgb, width, height, colour)
        }
        Format::Jpeg => JpegEncoder::new_with_quality(file, JPEG_QUALITY).write_image(
            &picture.rgb,
            width,
            height,
            colour,
        ),
    };
    written.map_err(io::Error::other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_of_a_picture_is_cut_out_at_any_scale() {
        let (width, height) = (6, 4);
        let rgb = (0..width * height * 3).map(|i| i as u8).collect();
        let whole = Picture { width, height, rgb };
        let part = |x, y, width, height| Part {
            x,
            y,
            width,
            height,
        };
        let cut = cut_out(&whole, part(1, 1, 2, 1), 2);
        assert_eq!((cut.width, cut.height), (4, 2));
        let first = 3 * (2 * 6 + 2) as u8;
        assert_eq!(cut.rgb[..3], [first, first + 1, first + 2]);
        assert_eq!(cut_out(&whole, part(0, 0, 6, 4), 1), whole);
        // More than there is gives what there is.
        assert_eq!(cut_out(&whole, part(5, 0, 9, 9), 1).rgb.len(), 4 * 3);
    }

    #[test]
    fn only_png_and_jpeg_are_claimed() {
        for name in ["a.png", "a.PNG", "a.jpg", "a.jpeg"] {
            assert!(Format::of(Path::new(name)).is_some(), "{name}");
        }
        for name in ["a", "a.gif", "png", ".png"] {
            assert!(Format::of(Path::new(name)).is_none(), "{name}");
        }
    }
}
