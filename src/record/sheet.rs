//! The contact sheet: the chosen moments side by side, each with its time.

use ab_glyph::{FontRef, PxScale};
use image::{Rgb, RgbImage, imageops};
use imageproc::drawing::{draw_text_mut, text_size};

use crate::texture::Picture;

/// The widest a picture stands on the sheet, pixels.
const WIDEST: usize = 800;
/// The narrowest, so that its label fits.
const NARROWEST: usize = 240;
const MARGIN: u32 = 24;
const PAPER: Rgb<u8> = Rgb([250, 249, 246]);
const INK: Rgb<u8> = Rgb([38, 40, 46]);

/// A contact sheet being put together.
pub(super) struct Sheet {
    title: String,
    tiles: Vec<(RgbImage, String)>,
}

impl Sheet {
    pub fn new(title: &str) -> Self {
        Sheet {
            title: title.into(),
            tiles: Vec::new(),
        }
    }

    /// Adds the cloth at a moment.
    pub fn add(&mut self, picture: &Picture, step: u64, hours: f64) {
        let (width, height) = (picture.width as u32, picture.height as u32);
        let Some(image) = RgbImage::from_raw(width, height, picture.rgb.clone()) else {
            return;
        };
        let tile = if picture.width > WIDEST {
            let height = (u64::from(height) * WIDEST as u64 / u64::from(width)).max(1) as u32;
            let filter = imageops::FilterType::CatmullRom;
            imageops::resize(&image, WIDEST as u32, height, filter)
        } else if picture.width < NARROWEST {
            let times = (NARROWEST as u32).div_ceil(width);
            let filter = imageops::FilterType::Nearest;
            imageops::resize(&image, width * times, height * times, filter)
        } else {
            image
        };
        self.tiles.push((tile, label(step, hours)));
    }

    /// Draws the sheet.
    pub fn draw(&self) -> Picture {
        let (width, height) = self
            .tiles
            .first()
            .map_or((1, 1), |(tile, _)| tile.dimensions());
        let columns = columns(self.tiles.len(), width, height);
        let rows = self.tiles.len().div_ceil(columns) as u32;
        let letters = (width / 24).clamp(14, 30);
        let line = letters * 2;
        let head = MARGIN + letters * 2;
        let mut sheet = RgbImage::from_pixel(
            MARGIN + (width + MARGIN) * columns as u32,
            head + MARGIN / 2 + (height + line + MARGIN / 2) * rows,
            PAPER,
        );
        write(&mut sheet, &self.title, MARGIN, MARGIN, letters * 3 / 2);
        for (i, (tile, label)) in self.tiles.iter().enumerate() {
            let x = MARGIN + (width + MARGIN) * (i % columns) as u32;
            let y = head + MARGIN / 2 + (height + line + MARGIN / 2) * (i / columns) as u32;
            imageops::replace(&mut sheet, tile, i64::from(x), i64::from(y));
            write(&mut sheet, label, x, y + height + letters / 3, letters);
        }
        Picture {
            width: sheet.width() as usize,
            height: sheet.height() as usize,
            rgb: sheet.into_raw(),
        }
    }
}

/// Writes a line of text, made smaller until it fits on the sheet.
fn write(sheet: &mut RgbImage, text: &str, x: u32, y: u32, letters: u32) {
    let Ok(font) = FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT) else {
        return;
    };
    let room = sheet.width().saturating_sub(x + MARGIN);
    let (wide, _) = text_size(PxScale::from(letters as f32), &font, text);
    let fit = (room as f32 / wide.max(1) as f32).min(1.0);
    let scale = PxScale::from((letters as f32 * fit).max(6.0));
    draw_text_mut(sheet, INK, x as i32, y as i32, scale, &font, text);
}

/// How many pictures to put in a row: a sheet a little wider than high, with few places left empty.
fn columns(tiles: usize, width: u32, height: u32) -> usize {
    let cost = |columns: usize| {
        let rows = tiles.div_ceil(columns);
        let empty = (rows * columns - tiles) as f64;
        let shape = (columns as f64 * f64::from(width)) / (rows as f64 * f64::from(height));
        libm::log(shape / 1.7).abs() + 0.5 * empty
    };
    (1..=tiles.max(1))
        .min_by(|a, b| cost(*a).total_cmp(&cost(*b)))
        .unwrap_or(1)
}

/// "t = 12,500   6.25 h".
fn label(step: u64, hours: f64) -> String {
    let digits = step.to_string();
    let mut grouped = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    let rounded = (hours * 1000.0).round() / 1000.0;
    format!("t = {grouped}    {rounded} h")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_group_their_thousands() {
        assert_eq!(label(0, 0.0), "t = 0    0 h");
        assert_eq!(label(12_500, 6.25), "t = 12,500    6.25 h");
        assert_eq!(label(1_234_567, 617.2835), "t = 1,234,567    617.284 h");
    }

    #[test]
    fn eight_pictures_stand_in_two_rows() {
        assert_eq!(columns(8, 800, 600), 4);
        assert_eq!(columns(1, 800, 600), 1);
    }
}
