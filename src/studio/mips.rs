//! A picture with all its halves, so that cloth that is far away neither glitters nor shows moiré.

use rayon::prelude::*;

/// Levels that a picture has until it is one pixel.
pub fn levels(width: usize, height: usize) -> u32 {
    width.max(height).max(1).ilog2() + 1
}

/// How the bytes of a picture are to be averaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Colours as they are displayed (sRGB): averaged as light.
    Colour,
    /// Normals: averaged as vectors.
    Normal,
}

/// RGBA of a picture and of all its halves, one after the other, from its RGB.
pub fn chain(rgb: &[u8], width: usize, height: usize, kind: Kind) -> Vec<u8> {
    let mut all = Vec::with_capacity(width * height * 16 / 3 + 64);
    all.extend(
        rgb.as_chunks::<3>()
            .0
            .iter()
            .flat_map(|[r, g, b]| [*r, *g, *b, 255]),
    );
    let light = light();
    let (mut from, mut w, mut h) = (0, width, height);
    while w > 1 || h > 1 {
        let (hw, hh) = ((w / 2).max(1), (h / 2).max(1));
        let mut half = vec![0; hw * hh * 4];
        let level = &all[from..from + w * h * 4];
        half.par_chunks_mut(hw * 4)
            .enumerate()
            .for_each(|(y, row)| {
                for (x, pixel) in row.as_chunks_mut::<4>().0.iter_mut().enumerate() {
                    let at = |dx: usize, dy: usize| {
                        let (x, y) = ((2 * x + dx).min(w - 1), (2 * y + dy).min(h - 1));
                        &level[4 * (y * w + x)..][..3]
                    };
                    let four = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
                    *pixel = match kind {
                        Kind::Colour => mean_colour(four, &light),
                        Kind::Normal => mean_normal(four),
                    };
                }
            });
        from = all.len();
        all.extend(half);
        (w, h) = (hw, hh);
    }
    all
}

/// The amount of light of every byte of sRGB (IEC 61966-2-1).
fn light() -> [f32; 256] {
    std::array::from_fn(|i| {
        let v = i as f64 / 255.0;
        let light = match v {
            v if v <= 0.040_45 => v / 12.92,
            v => libm::pow((v + 0.055) / 1.055, 2.4),
        };
        light as f32
    })
}

fn mean_colour(four: [&[u8]; 4], light: &[f32; 256]) -> [u8; 4] {
    let channel = |c: usize| {
        let sum: f32 = four.iter().map(|pixel| light[pixel[c] as usize]).sum();
        let mean = 0.25 * sum;
        // The byte whose light is nearest: the table rises.
        let above = light.partition_point(|l| *l < mean).min(255);
        let below = above.saturating_sub(1);
        let nearer = mean - light[below] < light[above] - mean;
        if nearer { below as u8 } else { above as u8 }
    };
    [channel(0), channel(1), channel(2), 255]
}

fn mean_normal(four: [&[u8]; 4]) -> [u8; 4] {
    let sum = [0, 1, 2].map(|c| four.iter().map(|n| f32::from(n[c]) - 128.0).sum::<f32>());
    let length = sum.iter().map(|v| v * v).sum::<f32>().sqrt().max(1e-6);
    let [x, y, z] = sum.map(|v| (127.0 * v / length + 128.0).round() as u8);
    [x, y, z, 255]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_is_half_as_large_down_to_one_pixel() {
        let bytes = chain(&vec![90; 13 * 6 * 3], 13, 6, Kind::Colour);
        let pixels = 13 * 6 + 6 * 3 + 3 + 1;
        assert_eq!(bytes.len(), 4 * pixels);
        assert_eq!(levels(13, 6), 4);
        assert!(
            bytes
                .as_chunks::<4>()
                .0
                .iter()
                .all(|p| *p == [90, 90, 90, 255])
        );
    }

    #[test]
    fn black_and_white_mix_as_light_and_not_as_bytes() {
        let bytes = chain(&[0, 0, 0, 255, 255, 255], 2, 1, Kind::Colour);
        assert_eq!(bytes[8..], [188, 188, 188, 255]);
    }

    #[test]
    fn opposite_slopes_make_a_flat_place() {
        let bytes = chain(&[218, 128, 218, 38, 128, 218], 2, 1, Kind::Normal);
        assert_eq!(bytes[8..], [128, 128, 255, 255]);
    }
}
