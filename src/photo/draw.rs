//! Pictures beside a photograph: its mask laid over it, its doubtful pixels, its colours.

use std::path::Path;

use image::{ImageFormat, Rgb, RgbImage};

use super::segment::DOUBTFUL;
use super::{Mask, Photo, PhotoError, WARP, WEFT};

/// The colour of doubtful pixels.
const DOUBT: [u8; 3] = [255, 220, 0];

/// The photograph, tinted blue where the warp lies on top and red where the weft does.
pub fn overlay(photo: &Photo, mask: &Mask) -> RgbImage {
    each(photo, |i, rgb| {
        let tint = if mask.warp_on_top[i] { WARP } else { WEFT };
        let grey = grey(rgb);
        mixed([grey; 3], tint, 0.4)
    })
}

/// The photograph in grey, with yellow where the mask is in doubt: the more, the stronger.
pub fn doubt(photo: &Photo, doubt: &[f32]) -> RgbImage {
    each(photo, |i, rgb| {
        let grey = [grey(rgb) / 2; 3];
        if doubt[i] > DOUBTFUL {
            mixed(grey, DOUBT, 0.4 + doubt[i].min(0.5))
        } else {
            grey
        }
    })
}

fn each(photo: &Photo, colour: impl Fn(usize, [u8; 3]) -> [u8; 3]) -> RgbImage {
    RgbImage::from_fn(photo.nx as u32, photo.ny as u32, |x, y| {
        let i = y as usize * photo.nx + x as usize;
        Rgb(colour(i, photo.rgb[i]))
    })
}

fn grey([r, g, b]: [u8; 3]) -> u8 {
    ((u32::from(r) * 54 + u32::from(g) * 183 + u32::from(b) * 19) / 256) as u8
}

fn mixed(one: [u8; 3], other: [u8; 3], share: f32) -> [u8; 3] {
    std::array::from_fn(|c| {
        (f32::from(one[c]) * (1.0 - share) + f32::from(other[c]) * share + 0.5) as u8
    })
}

/// Refuses to write over a file that is there, or over the photograph itself.
///
/// # Errors
/// [`PhotoError::Occupied`].
pub fn may_write(file: &Path, force: bool, photo: &Path) -> Result<(), PhotoError> {
    let is_photo = match (file.canonicalize(), photo.canonicalize()) {
        (Ok(file), Ok(photo)) => file == photo,
        _ => false,
    };
    if is_photo || (!force && file.exists()) {
        return Err(PhotoError::Occupied {
            path: file.into(),
            is_photo,
        });
    }
    Ok(())
}

/// Writes a picture as PNG, whole or not at all.
///
/// # Errors
/// [`PhotoError::Unwritable`].
pub fn write(file: &Path, picture: &RgbImage) -> Result<(), PhotoError> {
    let unwritable = |why: String| PhotoError::Unwritable {
        path: file.into(),
        why,
    };
    let mut part = file.as_os_str().to_os_string();
    part.push(".part");
    let written = picture
        .save_with_format(&part, ImageFormat::Png)
        .map_err(|why| why.to_string())
        .and_then(|()| std::fs::rename(&part, file).map_err(|why| why.to_string()));
    if written.is_err() {
        // What is half written helps nobody; that it cannot be removed either is no news.
        let _ = std::fs::remove_file(&part);
    }
    written.map_err(unwritable)
}
