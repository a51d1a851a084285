//! The contact sheet: the chosen moments side by side, each with its time.

use ab_glyph::{Font, FontRef, PxScale};
use image::{Rgb, RgbImage, imageops};
use imageproc::drawing::{draw_text_mut, text_size};

use crate::scenario::units::rounded;
use crate::texture::Picture;

/// A picture on the sheet is made smaller until both sides are at most this, pixels.
pub const LARGEST_TILE: u32 = 800;
/// A tiny one is enlarged while both sides stay below this, and each has at least so much room, so
/// that its label fits.
const ROOM: u32 = 240;
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
        let longest = width.max(height);
        let scaled =
            |side: u32| (u64::from(side) * u64::from(LARGEST_TILE) / u64::from(longest)).max(1);
        let tile = if longest > LARGEST_TILE {
            let (width, height) = (scaled(width) as u32, scaled(height) as u32);
            imageops::resize(&image, width, height, imageops::FilterType::CatmullRom)
        } else {
            let times = (ROOM / longest).max(1);
            let (width, height) = (width * times, height * times);
            imageops::resize(&image, width, height, imageops::FilterType::Nearest)
        };
        self.tiles.push((tile, label(step, hours)));
    }

    /// Draws the sheet.
    pub fn draw(&self) -> Picture {
        let (width, height) = self
            .tiles
            .first()
            .map_or((1, 1), |(tile, _)| tile.dimensions());
        let width = width.max(ROOM);
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

/// Writes a line of text, made smaller until it fits on the sheet. Letters that the font does not
/// have are left out.
fn write(sheet: &mut RgbImage, text: &str, x: u32, y: u32, letters: u32) {
    let Ok(font) = FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT) else {
        return;
    };
    let known = |c: &char| *c == ' ' || font.glyph_id(*c).0 != 0;
    let spaced = text
        .chars()
        .map(|c| if c.is_whitespace() { ' ' } else { c });
    let text: String = spaced.filter(known).collect();
    let room = sheet.width().saturating_sub(x + MARGIN);
    let (wide, _) = text_size(PxScale::from(letters as f32), &font, &text);
    let fit = (room as f32 / wide.max(1) as f32).min(1.0);
    let scale = PxScale::from((letters as f32 * fit).max(6.0));
    draw_text_mut(sheet, INK, x as i32, y as i32, scale, &font, &text);
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
    format!("t = {grouped}    {} h", rounded(hours, 6))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_group_their_thousands() {
        assert_eq!(label(0, 0.0), "t = 0    0 h");
        assert_eq!(label(12_500, 6.25), "t = 12,500    6.25 h");
        assert_eq!(label(3, 0.0015), "t = 3    0.0015 h");
        assert_eq!(label(1_234_567, 617.2835), "t = 1,234,567    617.284 h");
    }

    #[test]
    fn a_sheet_of_any_cloth_stays_small() {
        for (width, height) in [(1, 1), (1, 5000), (5000, 1), (20, 4000), (3200, 2400)] {
            let mut sheet = Sheet::new("any");
            let rgb = vec![200; width * height * 3];
            let picture = Picture { width, height, rgb };
            for step in 0..8 {
                sheet.add(&picture, step, 0.0);
            }
            let drawn = sheet.draw();
            assert!(drawn.width * drawn.height < 8_000_000, "{width}×{height}");
        }
    }

    #[test]
    fn eight_pictures_stand_in_two_rows() {
        assert_eq!(columns(8, 800, 600), 4);
        assert_eq!(columns(1, 800, 600), 1);
    }
}
