//! Photographs: 8-bit red, green and blue as displayed, the right way up.

use std::path::Path;

use image::{DynamicImage, RgbImage};

use super::{PhotoError, file, segment};
use crate::memory;
use crate::scenario::beside;
use crate::texture::oklab::{Oklab, linear};

/// Bytes for one pixel while a photograph is loaded: as decoded, in 8 bits with opacity, and kept.
const BYTES_PER_PIXEL: u64 = 8 + 4 + 4;

/// A photograph.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Photo {
    /// Pixels across.
    pub nx: usize,
    /// Pixels down.
    pub ny: usize,
    /// Red, green and blue of every pixel, row by row. What is transparent lies over white.
    pub rgb: Vec<[u8; 3]>,
    /// How opaque every pixel is, 0 to 255, where not all are.
    pub opacity: Option<Vec<u8>>,
}

impl Photo {
    /// Reads a PNG or JPEG of any depth and kind of colour, turned as its camera was held.
    ///
    /// # Errors
    /// A [`PhotoError`] that names the file, if it is missing, cut off, no picture or too large.
    pub fn load(path: &Path) -> Result<Self, PhotoError> {
        Photo::load_with(path, BYTES_PER_PIXEL)
    }

    /// Reads a photograph in which yarns are to be looked for, which takes far more memory.
    ///
    /// # Errors
    /// As [`Photo::load`].
    pub fn load_to_segment(path: &Path) -> Result<Self, PhotoError> {
        Photo::load_with(path, segment::BYTES_PER_PIXEL)
    }

    fn load_with(path: &Path, bytes_per_pixel: u64) -> Result<Self, PhotoError> {
        let bytes = beside::read(path).map_err(|why| unreadable(path, why))?;
        let (nx, ny) = file::dimensions(&bytes).map_err(|why| unreadable(path, why))?;
        let needed = bytes_per_pixel * nx as u64 * ny as u64;
        let free = memory::free();
        if needed > free {
            return Err(PhotoError::TooLarge {
                path: path.into(),
                nx,
                ny,
                needed,
                free,
            });
        }
        let image = file::decode(&bytes).map_err(|why| unreadable(path, why))?;
        Ok(Photo::from_image(image))
    }

    /// Pixels across and down of the photograph in a file, the right way up.
    ///
    /// # Errors
    /// A [`PhotoError`] that names the file.
    pub fn dimensions(path: &Path) -> Result<(usize, usize), PhotoError> {
        let bytes = beside::read(path).map_err(|why| unreadable(path, why))?;
        file::dimensions(&bytes).map_err(|why| unreadable(path, why))
    }

    /// A photograph that is in memory.
    pub fn from_image(image: DynamicImage) -> Self {
        let (nx, ny) = (image.width() as usize, image.height() as usize);
        if !image.color().has_alpha() {
            let rgb = image.into_rgb8();
            return Photo {
                nx,
                ny,
                rgb: rgb.pixels().map(|pixel| pixel.0).collect(),
                opacity: None,
            };
        }
        let image = image.into_rgba8();
        let over_white = |channel: u8, opacity: u8| {
            let (channel, opacity) = (u32::from(channel), u32::from(opacity));
            ((channel * opacity + 255 * (255 - opacity) + 127) / 255) as u8
        };
        let opacity: Vec<u8> = image.pixels().map(|pixel| pixel.0[3]).collect();
        let opaque = opacity.iter().all(|opacity| *opacity == 255);
        Photo {
            nx,
            ny,
            rgb: image
                .pixels()
                .map(|pixel| {
                    let [r, g, b, opacity] = pixel.0;
                    [r, g, b].map(|channel| over_white(channel, opacity))
                })
                .collect(),
            opacity: (!opaque).then_some(opacity),
        }
    }

    /// Whether there is something to be seen at a pixel.
    pub fn is_opaque(&self, i: usize) -> bool {
        self.opacity
            .as_ref()
            .is_none_or(|opacity| opacity[i] >= 128)
    }

    /// The photograph as a picture to draw on.
    pub fn picture(&self) -> RgbImage {
        let bytes = self.rgb.concat();
        RgbImage::from_raw(self.nx as u32, self.ny as u32, bytes).unwrap_or_default()
    }
}

/// OKLab of 8-bit colours, with the linear light of every channel value looked up.
pub(super) struct ToOklab([f64; 256]);

impl ToOklab {
    pub(super) fn new() -> Self {
        let mut light = [0.0; 256];
        for (value, light) in light.iter_mut().enumerate() {
            *light = linear(value as f64 / 255.0);
        }
        ToOklab(light)
    }

    pub(super) fn of(&self, rgb: [u8; 3]) -> Oklab {
        Oklab::from_linear(rgb.map(|channel| self.0[usize::from(channel)]))
    }
}

fn unreadable(path: &Path, why: String) -> PhotoError {
    PhotoError::Unreadable {
        path: path.into(),
        why,
    }
}
