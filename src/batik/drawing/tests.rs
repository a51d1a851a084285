//! Drawings of all kinds.

use super::*;
use image::{GrayImage, ImageBuffer, Rgb, RgbImage, RgbaImage};

/// A ring on a ground, as a function from a place to whether it is drawn.
fn ring(x: u32, y: u32) -> bool {
    let (dx, dy) = (x as f32 - 31.5, y as f32 - 31.5);
    ((dx * dx + dy * dy).sqrt() - 20.0).abs() < 5.0
}

fn expected() -> Vec<f32> {
    (0..64 * 64)
        .map(|i| if ring(i % 64, i / 64) { 1.0 } else { 0.0 })
        .collect()
}

fn drawn(image: impl Into<DynamicImage>) -> Vec<f32> {
    Drawing::of(&image.into(), Ground::Detect)
        .unwrap()
        .drawn
        .values
}

#[test]
fn black_on_white_and_white_on_black_and_colours_are_the_same_drawing() {
    let grey = |ink, paper| {
        GrayImage::from_fn(64, 64, |x, y| Luma([if ring(x, y) { ink } else { paper }]))
    };
    let colour =
        |ink, paper| RgbImage::from_fn(64, 64, |x, y| Rgb(if ring(x, y) { ink } else { paper }));
    assert_eq!(drawn(grey(0, 255)), expected());
    assert_eq!(drawn(grey(255, 0)), expected());
    assert_eq!(drawn(grey(90, 140)), expected());
    // As light as each other: no grey picture would show it.
    assert_eq!(drawn(colour([200, 30, 30], [40, 110, 40])), expected());
}

#[test]
fn what_is_transparent_is_ground_whatever_the_ink() {
    for ink in [[0, 0, 0, 255], [255, 255, 255, 255], [20, 90, 200, 255]] {
        let image = RgbaImage::from_fn(64, 64, |x, y| {
            image::Rgba(if ring(x, y) { ink } else { [0; 4] })
        });
        assert_eq!(drawn(image), expected());
    }
}

#[test]
fn sixteen_bits_are_read_as_well_as_eight() {
    let image: ImageBuffer<Luma<u16>, Vec<u16>> =
        ImageBuffer::from_fn(64, 64, |x, y| Luma([if ring(x, y) { 3 } else { 65_000 }]));
    assert_eq!(drawn(image), expected());
}

#[test]
fn the_ground_can_be_named() {
    // Drawn up to the frame: what is ground cannot be seen.
    let image: DynamicImage =
        GrayImage::from_fn(64, 64, |x, y| Luma([if ring(x, y) { 255 } else { 0 }])).into();
    let light = Drawing::of(&image, Ground::Light).unwrap().drawn.values;
    let dark = Drawing::of(&image, Ground::Dark).unwrap().drawn.values;
    assert_eq!(dark, expected());
    assert!(light.iter().zip(&dark).all(|(a, b)| *a == 1.0 - b));
}

#[test]
fn an_empty_sheet_is_no_drawing() {
    for shade in [0, 128, 255] {
        let sheet: DynamicImage = GrayImage::from_pixel(64, 64, Luma([shade])).into();
        assert_eq!(Drawing::of(&sheet, Ground::Detect), None);
    }
    let clear: DynamicImage = RgbaImage::new(64, 64).into();
    assert_eq!(Drawing::of(&clear, Ground::Detect), None);
}

#[test]
fn wax_lies_on_what_is_drawn_or_on_the_ground_and_fits_any_cloth() {
    let drawing = Drawing {
        drawn: Raster {
            nx: 64,
            ny: 64,
            values: expected(),
        },
    };
    for (nx, ny) in [(64, 64), (200, 150), (33, 90), (1, 1)] {
        let lines = drawing.wax(nx, ny, Waxed::Drawing);
        let ground = drawing.wax(nx, ny, Waxed::Ground);
        assert_eq!((lines.nx, lines.ny, lines.values.len()), (nx, ny, nx * ny));
        for (a, b) in lines.values.iter().zip(&ground.values) {
            assert!((0.0..=1.0).contains(a) && (a + b - 1.0).abs() < 1e-6);
        }
    }
    // The same share of the drawing's square is drawn at every size.
    let share = |side: usize| {
        let wax = drawing.wax(side, side, Waxed::Ground);
        wax.values.iter().sum::<f32>() / (side * side) as f32
    };
    for side in [40, 64, 150, 300] {
        assert!((share(side) - share(64)).abs() < 0.01, "{side}");
    }
}

#[test]
fn an_enlarged_drawing_has_sharp_edges() {
    let drawing = Drawing {
        drawn: Raster {
            nx: 64,
            ny: 64,
            values: expected(),
        },
    };
    let wax = drawing.wax(640, 640, Waxed::Drawing);
    let between = wax.values.iter().filter(|v| (0.05..0.95).contains(*v));
    // The ring's edges are about 2,500 cells long; enlarging alone blurs them over ten.
    assert!(between.count() < 7_500);
}
