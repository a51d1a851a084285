//! The mask of a photograph of woven cloth: whether warp or weft lies on top at each pixel (paper D
//! Fig 7). Warp is blue, 0,0,255; weft is red, 255,0,0.

use std::path::Path;

use image::{Rgb, RgbImage};

use super::{Photo, PhotoError};

/// Colour of the warp in a mask.
pub const WARP: [u8; 3] = [0, 0, 255];
/// Colour of the weft in a mask.
pub const WEFT: [u8; 3] = [255, 0, 0];

/// How far a pixel may be from the straight line between blue and red, in steps of a channel. Soft
/// edges lie on that line; black, white, grey, green and magenta lie 180 and more from it.
const TOLERANCE: f64 = 110.0;

/// Which yarns lie on top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mask {
    /// Pixels across.
    pub nx: usize,
    /// Pixels down.
    pub ny: usize,
    /// For every pixel, row by row, whether the warp lies on top.
    pub warp_on_top: Vec<bool>,
}

impl Mask {
    /// Reads a mask, each pixel as what it is nearer to, blue or red. Soft edges from a paint
    /// program and the noise of a JPEG do no harm.
    ///
    /// # Errors
    /// A [`PhotoError`] that names the file: if it is no picture, or if pixels are neither blue nor
    /// red, with their number and the first place.
    pub fn load(path: &Path) -> Result<Self, PhotoError> {
        Mask::read(path, &Photo::load(path)?)
    }

    /// Reads the mask of a photograph of `nx` by `ny` pixels.
    ///
    /// # Errors
    /// As [`Mask::load`], or if it has another size than the photograph.
    pub fn load_for(path: &Path, photo: (usize, usize)) -> Result<Self, PhotoError> {
        let mask = Photo::dimensions(path)?;
        if mask != photo {
            return Err(PhotoError::MaskSize {
                path: path.into(),
                mask,
                photo,
            });
        }
        Mask::load(path)
    }

    /// Reads a mask that is in memory; `path` stands in messages.
    ///
    /// # Errors
    /// As [`Mask::load`].
    pub fn read(path: &Path, picture: &Photo) -> Result<Self, PhotoError> {
        let sides: Vec<Option<bool>> = picture.rgb.iter().map(|rgb| side(*rgb)).collect();
        let strange = |i: &usize| sides[*i].is_none();
        let mut neither = (0..sides.len()).filter(strange);
        if let Some(first) = neither.next() {
            return Err(PhotoError::MaskColour {
                path: path.into(),
                count: 1 + neither.count(),
                first: (first % picture.nx, first / picture.nx),
                colour: picture.rgb[first],
            });
        }
        Ok(Mask {
            nx: picture.nx,
            ny: picture.ny,
            warp_on_top: sides.into_iter().map(|side| side == Some(true)).collect(),
        })
    }

    /// Whether the warp lies on top at a pixel.
    pub fn warp(&self, x: usize, y: usize) -> bool {
        self.warp_on_top[y * self.nx + x]
    }

    /// The share of pixels where the warp lies on top, 0 to 1.
    pub fn warp_share(&self) -> f64 {
        let warp = self.warp_on_top.iter().filter(|warp| **warp).count();
        warp as f64 / self.warp_on_top.len().max(1) as f64
    }

    /// The mask as a picture.
    pub fn picture(&self) -> RgbImage {
        RgbImage::from_fn(self.nx as u32, self.ny as u32, |x, y| {
            let warp = self.warp(x as usize, y as usize);
            Rgb(if warp { WARP } else { WEFT })
        })
    }
}

/// Whether a pixel is warp or weft, if it is either: the nearer end of the line from red to blue.
fn side(rgb: [u8; 3]) -> Option<bool> {
    let [r, g, b] = rgb.map(f64::from);
    // The place along the line, 0 at red and 1 at blue.
    let t = (0.5 + (b - r) / 510.0).clamp(0.0, 1.0);
    let (dr, db) = (r - 255.0 * (1.0 - t), b - 255.0 * t);
    let near = dr * dr + g * g + db * db <= TOLERANCE * TOLERANCE;
    near.then_some(b > r)
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{DynamicImage, imageops};

    fn read(image: RgbImage) -> Result<Mask, PhotoError> {
        let photo = Photo::from_image(DynamicImage::ImageRgb8(image));
        Mask::read(Path::new("mask.png"), &photo)
    }

    fn checks() -> Mask {
        let (nx, ny) = (24, 18);
        Mask {
            nx,
            ny,
            warp_on_top: (0..nx * ny)
                .map(|i| (i % nx / 6 + i / nx / 6) % 2 == 0)
                .collect(),
        }
    }

    #[test]
    fn a_mask_drawn_and_read_is_the_same_mask() {
        assert_eq!(read(checks().picture()).unwrap(), checks());
    }

    #[test]
    fn soft_edges_change_a_mask_at_the_edges_alone() {
        let soft = imageops::blur(&checks().picture(), 0.8);
        let found = read(soft).unwrap();
        for y in 0..18 {
            for x in 0..24 {
                let inside = (1..5).contains(&(x % 6)) && (1..5).contains(&(y % 6));
                assert!(!inside || found.warp(x, y) == checks().warp(x, y));
            }
        }
    }

    #[test]
    fn the_noise_of_a_jpeg_does_no_harm() {
        let mut bytes = Vec::new();
        let encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, 60);
        checks().picture().write_with_encoder(encoder).unwrap();
        let found = read(image::load_from_memory(&bytes).unwrap().to_rgb8()).unwrap();
        let wrong = (0..found.warp_on_top.len())
            .filter(|i| found.warp_on_top[*i] != checks().warp_on_top[*i])
            .count();
        assert!(wrong < found.warp_on_top.len() / 20, "{wrong}");
    }

    #[test]
    fn what_is_neither_blue_nor_red_is_told_with_number_and_place() {
        for colour in [
            [0, 0, 0],
            [255, 255, 255],
            [128, 128, 128],
            [0, 255, 0],
            [255, 0, 255],
            [255, 255, 0],
            [0, 255, 255],
        ] {
            let mut picture = checks().picture();
            picture.put_pixel(7, 3, Rgb(colour));
            picture.put_pixel(2, 9, Rgb(colour));
            let told = PhotoError::MaskColour {
                path: "mask.png".into(),
                count: 2,
                first: (7, 3),
                colour,
            };
            assert_eq!(read(picture), Err(told));
        }
    }
}
