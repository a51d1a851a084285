//! Sheets: pictures of cloth side by side, each with a line or two below. The contact sheet of a
//! recording is one, and so is a figure.

use ab_glyph::{Font, FontRef, PxScale};
use image::{Rgb, RgbImage, imageops};
use imageproc::drawing::{draw_text_mut, text_size};

use crate::scenario::units::rounded;
use crate::texture::Picture;

/// A picture on the sheet is made smaller until both sides are at most this, pixels, unless someone
/// says otherwise.
pub const LARGEST_TILE: u32 = 800;
/// A tiny one is enlarged while both sides stay below this, and each has at least so much room, so
/// that its label fits.
const ROOM: u32 = 240;
const MARGIN: u32 = 24;
const PAPER: Rgb<u8> = Rgb([250, 249, 246]);
const INK: Rgb<u8> = Rgb([38, 40, 46]);

/// A sheet being put together.
pub(super) struct Sheet {
    title: String,
    /// Pictures in a row; none: as many as look well.
    columns: Option<usize>,
    /// The longest that the side of a picture may be.
    largest: u32,
    tiles: Vec<(RgbImage, String)>,
}

impl Sheet {
    pub fn new(title: &str) -> Self {
        Sheet {
            title: title.into(),
            columns: None,
            largest: LARGEST_TILE,
            tiles: Vec::new(),
        }
    }

    /// Puts so many pictures in a row, each as long as `largest` at most.
    pub fn arranged(self, columns: Option<u32>, largest: u32) -> Self {
        Sheet {
            columns: columns.map(|columns| columns.max(1) as usize),
            largest: largest.max(1),
            ..self
        }
    }

    /// Adds a picture and what stands below it.
    pub fn add(&mut self, picture: &Picture, label: String) {
        self.tiles
            .extend(self.tile(picture).map(|tile| (tile, label)));
    }

    /// A picture as large as it will be on the sheet.
    fn tile(&self, picture: &Picture) -> Option<RgbImage> {
        let (width, height) = (picture.width as u32, picture.height as u32);
        let image = RgbImage::from_raw(width, height, picture.rgb.clone())?;
        let (longest, largest) = (width.max(height).max(1), self.largest);
        let scaled =
            |side: u32| (u64::from(side) * u64::from(largest) / u64::from(longest)).max(1) as u32;
        Some(if longest > largest {
            let filter = imageops::FilterType::CatmullRom;
            imageops::resize(&image, scaled(width), scaled(height), filter)
        } else {
            let times = (ROOM.min(largest) / longest).max(1);
            let filter = imageops::FilterType::Nearest;
            imageops::resize(&image, width * times, height * times, filter)
        })
    }

    /// Draws the sheet.
    pub fn draw(&self) -> Picture {
        let tiles = || self.tiles.iter().map(|(tile, _)| tile);
        let width = tiles().map(RgbImage::width).max().unwrap_or(1).max(ROOM);
        let height = tiles().map(RgbImage::height).max().unwrap_or(1);
        let columns = match self.columns {
            Some(columns) => columns.min(self.tiles.len().max(1)),
            None => columns(self.tiles.len(), width, height),
        };
        let letters = (width / 24).clamp(14, 30);
        let labels: Vec<Vec<String>> = self
            .tiles
            .iter()
            .map(|(_, label)| wrapped(label, width, letters))
            .collect();
        let leading = letters * 5 / 4;
        // A row is as high as what stands in it needs.
        let needs = |((tile, _), label): (&(RgbImage, String), &Vec<String>)| {
            tile.height() + letters * 2 + leading * (label.len() as u32).saturating_sub(1)
        };
        let rows: Vec<u32> = (0..self.tiles.len())
            .step_by(columns)
            .map(|first| {
                let tiles = self.tiles[first..].iter().zip(&labels[first..]);
                tiles.take(columns).map(needs).max().unwrap_or(0) + MARGIN / 2
            })
            .collect();
        let head = match self.title.as_str() {
            "" => MARGIN / 2,
            _ => MARGIN + letters * 2,
        };
        let mut sheet = RgbImage::from_pixel(
            MARGIN + (width + MARGIN) * columns as u32,
            head + MARGIN / 2 + rows.iter().sum::<u32>(),
            PAPER,
        );
        write(&mut sheet, &self.title, MARGIN, MARGIN, letters * 3 / 2);
        let mut y = head + MARGIN / 2;
        for (row, height) in rows.iter().enumerate() {
            let first = row * columns;
            let tiles = self.tiles[first..].iter().zip(&labels[first..]);
            for (column, ((tile, _), label)) in tiles.take(columns).enumerate() {
                let x = MARGIN + (width + MARGIN) * column as u32;
                imageops::replace(&mut sheet, tile, i64::from(x), i64::from(y));
                let mut below = y + tile.height() + letters / 3;
                for text in label {
                    write(&mut sheet, text, x, below, letters);
                    below += leading;
                }
            }
            y += height;
        }
        Picture {
            width: sheet.width() as usize,
            height: sheet.height() as usize,
            rgb: sheet.into_raw(),
        }
    }
}

fn font() -> Option<FontRef<'static>> {
    FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).ok()
}

/// Breaks a label between words into lines that are as wide as their picture at most, as far as its
/// words let it.
fn wrapped(label: &str, width: u32, letters: u32) -> Vec<String> {
    let Some(font) = font() else {
        return vec![label.into()];
    };
    let fits = |line: &str| text_size(PxScale::from(letters as f32), &font, line).0 <= width;
    let mut lines = vec![String::new()];
    // Spaces within a line stay as they are: a label may set its parts apart with them.
    for word in label.split_inclusive(' ') {
        let line = lines.last().map_or("", String::as_str);
        if line.is_empty() || fits(&format!("{line}{}", word.trim_end())) {
            if let Some(line) = lines.last_mut() {
                line.push_str(word);
            }
        } else {
            lines.push(word.into());
        }
    }
    lines
}

/// Writes a line of text, made smaller until it fits on the sheet. Letters that the font does not
/// have are left out.
fn write(sheet: &mut RgbImage, text: &str, x: u32, y: u32, letters: u32) {
    let Some(font) = font() else {
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

/// What stands below a moment: "t = 12,500   6.25 h".
pub(super) fn moment(step: u64, hours: f64) -> String {
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
        assert_eq!(moment(0, 0.0), "t = 0    0 h");
        assert_eq!(moment(12_500, 6.25), "t = 12,500    6.25 h");
        assert_eq!(moment(3, 0.0015), "t = 3    0.0015 h");
        assert_eq!(moment(1_234_567, 617.2835), "t = 1,234,567    617.284 h");
    }

    #[test]
    fn a_sheet_of_any_cloth_stays_small() {
        for (width, height) in [(1, 1), (1, 5000), (5000, 1), (20, 4000), (3200, 2400)] {
            let mut sheet = Sheet::new("any");
            let rgb = vec![200; width * height * 3];
            let picture = Picture { width, height, rgb };
            for step in 0..8 {
                sheet.add(&picture, moment(step, 0.0));
            }
            let drawn = sheet.draw();
            assert!(drawn.width * drawn.height < 8_000_000, "{width}×{height}");
        }
    }

    #[test]
    fn a_long_label_is_broken_between_words_and_loses_none() {
        let label = "(b) a label that is longer than its picture is wide, set apart:    so";
        let lines = wrapped(label, 240, 14);
        assert!(lines.len() > 1);
        assert_eq!(lines.concat(), label);
        assert_eq!(wrapped("short", 240, 14), ["short"]);
        assert_eq!(wrapped("", 240, 14), [""]);
        assert_eq!(wrapped("anunbreakablewordofmanyletters", 24, 14).len(), 1);
    }

    #[test]
    fn pictures_of_different_sizes_all_have_room() {
        let mut sheet = Sheet::new("two").arranged(Some(2), 300);
        for (width, height) in [(300, 100), (100, 300)] {
            let rgb = vec![9; width * height * 3];
            sheet.add(&Picture { width, height, rgb }, String::new());
        }
        let drawn = sheet.draw();
        let dark = drawn
            .rgb
            .chunks(3)
            .filter(|pixel| *pixel == [9, 9, 9])
            .count();
        assert!(dark >= 2 * 300 * 100, "{dark}");
    }

    #[test]
    fn eight_pictures_stand_in_two_rows() {
        assert_eq!(columns(8, 800, 600), 4);
        assert_eq!(columns(1, 800, 600), 1);
    }
}
