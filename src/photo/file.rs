//! Pictures in files: read whole or not at all, within the memory there is, and turned upright.

use std::io::Cursor;

use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use crate::memory;

/// Pixels across and down, as the picture is meant to be seen.
///
/// # Errors
/// Why the file is no picture.
pub(crate) fn dimensions(bytes: &[u8]) -> Result<(usize, usize), String> {
    let mut decoder = reader(bytes)?.into_decoder().map_err(not_a_picture)?;
    let (width, height) = decoder.dimensions();
    let (width, height) = (width as usize, height as usize);
    Ok(match upright(&mut decoder) {
        Orientation::Rotate90
        | Orientation::Rotate270
        | Orientation::Rotate90FlipH
        | Orientation::Rotate270FlipH => (height, width),
        _ => (width, height),
    })
}

/// The picture, turned as its camera says it was held.
///
/// # Errors
/// Why the file is no picture, or not a whole one.
pub(crate) fn decode(bytes: &[u8]) -> Result<DynamicImage, String> {
    let reader = reader(bytes)?;
    if reader.format() == Some(ImageFormat::Jpeg) {
        ends(bytes)?;
    }
    let mut decoder = reader.into_decoder().map_err(not_a_picture)?;
    let orientation = upright(&mut decoder);
    let mut image = DynamicImage::from_decoder(decoder).map_err(not_a_picture)?;
    image.apply_orientation(orientation);
    Ok(image)
}

fn reader(bytes: &[u8]) -> Result<ImageReader<Cursor<&[u8]>>, String> {
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|why| format!("it cannot be read: {why}"))?;
    let mut limits = Limits::default();
    limits.max_alloc = Some(memory::free());
    reader.limits(limits);
    Ok(reader)
}

/// How to turn it. What a camera wrote wrongly is not worth refusing a picture for.
fn upright(decoder: &mut impl ImageDecoder) -> Orientation {
    decoder.orientation().unwrap_or(Orientation::NoTransforms)
}

fn not_a_picture(why: image::ImageError) -> String {
    match why {
        image::ImageError::Unsupported(_) => {
            format!("pictures are PNG or JPEG, and this is neither: {why}")
        }
        _ => format!("it is not a whole PNG or JPEG: {why}"),
    }
}

/// Refuses a JPEG that ends too early. Its decoder would show the missing part as grey.
///
/// Markers of the head carry their length; after the first scan begins (FF DA), FF D9 can only be
/// the end: in scans, FF is always followed by 00 or a restart marker (ITU T.81, B.1.1).
fn ends(bytes: &[u8]) -> Result<(), String> {
    let cut = || "it is not a whole JPEG: it ends before its last row".to_owned();
    let mut at = 2;
    loop {
        let Some([first, second]) = bytes.get(at..at + 2).map(|pair| [pair[0], pair[1]]) else {
            return Err(cut());
        };
        match [first, second] {
            // Filling before a marker.
            [0xff, 0xff] => at += 1,
            [0xff, 0xda] => break,
            [0xff, 0x01 | 0xd0..=0xd8] => at += 2,
            [0xff, _] => {
                let Some(length) = bytes.get(at + 2..at + 4) else {
                    return Err(cut());
                };
                at += 2 + usize::from(u16::from_be_bytes([length[0], length[1]])).max(2);
            }
            // Not a marker: the decoder will say what is wrong.
            _ => return Ok(()),
        }
    }
    if bytes[at..].windows(2).any(|pair| pair == [0xff, 0xd9]) {
        Ok(())
    } else {
        Err(cut())
    }
}
