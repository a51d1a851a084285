//! From a drawing to wax: any line drawing becomes I, 0 where the cloth is waxed and 1 where it is
//! open (paper B §3.3).
//!
//! What is **drawn** is what differs from the ground: the drawing may be black on white or white on
//! black, in colours, on a transparent ground, in 1, 8 or 16 bits. The ground is the colour that most
//! of the picture's frame has. How much a pixel is drawn is how far its colour lies from that of the
//! ground (the channel in which it lies farthest), in units of the farthest in the picture; the
//! lowest and the highest twelfth count as nothing and all, for the grain of paper and the noise of
//! JPEG.

#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use image::imageops::{self, FilterType};
use image::{DynamicImage, ImageBuffer, Luma};
use thiserror::Error;

use crate::memory;
use crate::pattern::Raster;
use crate::photo::file;
use crate::scenario::beside;

/// The fewest pixels across and down that a drawing may have.
pub const SMALLEST: usize = 8;
/// The least contrast, 0 to 1, with which something counts as drawn.
const LEAST_CONTRAST: f32 = 0.05;
/// The shares at both ends that count as nothing and all.
const GRAIN: f32 = 1.0 / 12.0;
/// Bytes for a pixel while a drawing is loaded: decoded, in four channels, and what is drawn.
const BYTES_PER_PIXEL: u64 = 8 + 16 + 4;

/// A drawing that makes no wax.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum DrawingError {
    /// It is no picture, or cannot be read.
    #[error("the drawing {}: {why}", file.display())]
    Unreadable {
        /// Where it is.
        file: PathBuf,
        /// What is wrong.
        why: String,
    },
    /// It has too few pixels to be a drawing.
    #[error(
        "the drawing {} has only {width}×{height} pixels; at least {SMALLEST}×{SMALLEST} are needed",
        file.display()
    )]
    TooSmall {
        /// Where it is.
        file: PathBuf,
        /// Pixels across.
        width: usize,
        /// Pixels down.
        height: usize,
    },
    /// It does not fit in memory.
    #[error(
        "the drawing {}: its {width}×{height} pixels need {} MB of memory, more than is free",
        file.display(), needed / 1_000_000
    )]
    TooLarge {
        /// Where it is.
        file: PathBuf,
        /// Pixels across.
        width: usize,
        /// Pixels down.
        height: usize,
        /// Bytes needed.
        needed: u64,
    },
    /// Nothing is drawn.
    #[error(
        "the drawing {} is empty: all of it has nearly the same colour, so there is nothing to wax",
        file.display()
    )]
    Empty {
        /// Where it is.
        file: PathBuf,
    },
}

/// Which colour of a picture is its ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Serialize, Deserialize)]
pub enum Ground {
    /// The one that most of its frame has.
    #[default]
    Detect,
    /// White: dark things are drawn.
    Light,
    /// Black: light things are drawn.
    Dark,
}

/// Where the wax goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Waxed {
    /// On what is drawn, which stays pale on dyed cloth.
    #[default]
    Drawing,
    /// On the ground, so that what is drawn is dyed.
    Ground,
}

/// A drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// How much every pixel is drawn, 0 ground to 1.
    pub drawn: Raster,
}

impl Drawing {
    /// Loads a drawing, PNG or JPEG.
    ///
    /// # Errors
    /// A [`DrawingError`] that names the file, if it cannot be read, is too small or too large, or
    /// if nothing is drawn.
    pub fn load(file: &Path, ground: Ground) -> Result<Self, DrawingError> {
        let bytes = beside::read(file).map_err(|why| DrawingError::Unreadable {
            file: file.into(),
            why,
        })?;
        Drawing::read(file, &bytes, ground)
    }

    /// Reads a drawing from the bytes of a file, whose name stands in messages.
    ///
    /// # Errors
    /// As [`Drawing::load`].
    pub fn read(file: &Path, bytes: &[u8], ground: Ground) -> Result<Self, DrawingError> {
        let unreadable = |why| DrawingError::Unreadable {
            file: file.into(),
            why,
        };
        let (width, height) = file::dimensions(bytes).map_err(unreadable)?;
        if width < SMALLEST || height < SMALLEST {
            return Err(DrawingError::TooSmall {
                file: file.into(),
                width,
                height,
            });
        }
        let needed = BYTES_PER_PIXEL * width as u64 * height as u64;
        if needed > memory::free() {
            return Err(DrawingError::TooLarge {
                file: file.into(),
                width,
                height,
                needed,
            });
        }
        let image = file::decode(bytes).map_err(unreadable)?;
        Drawing::of(&image, ground).ok_or_else(|| DrawingError::Empty { file: file.into() })
    }

    /// What is drawn in a picture; none if nothing is.
    pub fn of(image: &DynamicImage, ground: Ground) -> Option<Self> {
        let rgba = image.to_rgba32f();
        let (nx, ny) = (rgba.width() as usize, rgba.height() as usize);
        // Something is transparent: it is the ground, laid on paper on which the rest can be seen.
        let clear = rgba.pixels().any(|p| p.0[3] < 0.9);
        let papers: &[f32] = if clear { &[1.0, 0.0] } else { &[1.0] };
        papers.iter().find_map(|paper| {
            let on_paper = |p: &image::Rgba<f32>| {
                [0, 1, 2].map(|i| (p.0[3] * p.0[i] + (1.0 - p.0[3]) * paper).clamp(0.0, 1.0))
            };
            let colours: Vec<[f32; 3]> = rgba.pixels().map(on_paper).collect();
            let ground = match ground {
                Ground::Detect if clear => [*paper; 3],
                Ground::Detect => frame_colour(&colours, nx, ny),
                Ground::Light => [1.0; 3],
                Ground::Dark => [0.0; 3],
            };
            let apart =
                |c: &[f32; 3]| (0..3).fold(0.0, |most: f32, i| most.max((c[i] - ground[i]).abs()));
            let mut values: Vec<f32> = colours.iter().map(apart).collect();
            let most = values.iter().copied().fold(0.0, f32::max);
            if most < LEAST_CONTRAST {
                return None;
            }
            for value in &mut values {
                *value = ((*value / most - GRAIN) / (1.0 - 2.0 * GRAIN)).clamp(0.0, 1.0);
            }
            Some(Drawing {
                drawn: Raster { nx, ny, values },
            })
        })
    }

    /// The wax on a cloth of `nx` by `ny` cells: I of every cell, 0 waxed to 1 open. The drawing is
    /// as large as fits, in the middle; ground goes on around it.
    pub fn wax(&self, nx: usize, ny: usize, waxed: Waxed) -> Raster {
        let drawn = self.fitted(nx, ny);
        match waxed {
            Waxed::Ground => drawn,
            Waxed::Drawing => Raster {
                values: drawn.values.iter().map(|v| 1.0 - v).collect(),
                ..drawn
            },
        }
    }

    fn fitted(&self, nx: usize, ny: usize) -> Raster {
        let drawn = &self.drawn;
        if (drawn.nx, drawn.ny) == (nx, ny) {
            return drawn.clone();
        }
        let scale = (nx as f64 / drawn.nx as f64).min(ny as f64 / drawn.ny as f64);
        let side = |pixels: usize, cells: usize| {
            ((pixels as f64 * scale).round() as usize).clamp(1, cells.max(1))
        };
        let (width, height) = (side(drawn.nx, nx), side(drawn.ny, ny));
        let image = ImageBuffer::<Luma<f32>, _>::from_raw(
            drawn.nx as u32,
            drawn.ny as u32,
            drawn.values.clone(),
        )
        .unwrap_or_default();
        let filter = if scale > 1.0 {
            FilterType::CatmullRom
        } else {
            FilterType::Triangle
        };
        let sized = imageops::resize(&image, width as u32, height as u32, filter);
        // Enlarging blurs edges over many cells, which would be thin wax: draw them sharp again.
        let steeper = if scale > 1.5 && self.two_toned() {
            scale as f32
        } else {
            1.0
        };
        let (left, top) = (
            (nx.saturating_sub(width)) / 2,
            (ny.saturating_sub(height)) / 2,
        );
        let mut fitted = Raster::uniform(nx, ny, 0.0);
        for (x, y, pixel) in sized.enumerate_pixels() {
            let value = (0.5 + steeper * (pixel.0[0] - 0.5)).clamp(0.0, 1.0);
            let (x, y) = (left + x as usize, top + y as usize);
            if x < nx && y < ny {
                fitted.values[y * nx + x] = value;
            }
        }
        fitted
    }

    /// Whether nearly all of it is either ground or fully drawn.
    fn two_toned(&self) -> bool {
        let between = |v: &&f32| (0.1..0.9).contains(*v);
        let values = &self.drawn.values;
        values.iter().filter(between).count() * 6 < values.len()
    }
}

/// The colour that most of a picture's frame has; where no colour has half of it, the one that most
/// of the picture has.
fn frame_colour(colours: &[[f32; 3]], nx: usize, ny: usize) -> [f32; 3] {
    let frame = |i: &usize| {
        let (x, y) = (i % nx, i / nx);
        x == 0 || y == 0 || x + 1 == nx || y + 1 == ny
    };
    let (colour, votes, all) = commonest((0..nx * ny).filter(frame).map(|i| colours[i]));
    if 2 * votes >= all {
        return colour;
    }
    commonest(colours.iter().copied()).0
}

/// The mean of the colours in the fullest of 12³ boxes, how many they are, and how many there are.
fn commonest(colours: impl Iterator<Item = [f32; 3]>) -> ([f32; 3], usize, usize) {
    let mut boxes: BTreeMap<[u8; 3], ([f64; 3], usize)> = BTreeMap::new();
    let mut all = 0;
    for colour in colours {
        // Rounding puts black, white and what is near them into boxes of their own.
        let (sum, count) = boxes
            .entry(colour.map(|c| (11.0 * c).round() as u8))
            .or_default();
        for (sum, channel) in sum.iter_mut().zip(colour) {
            *sum += f64::from(channel);
        }
        *count += 1;
        all += 1;
    }
    let fullest = boxes.values().max_by_key(|(_, count)| *count);
    let (sum, count) = fullest.copied().unwrap_or(([1.0; 3], 1));
    (sum.map(|sum| (sum / count as f64) as f32), count, all)
}
