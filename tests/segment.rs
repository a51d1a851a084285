//! Warp and weft found in photographs whose truth is known: cloth that the program draws itself.

mod common;
#[path = "common/program.rs"]
mod program;

use common::dyed;
use dyelapse::chance::{Chance, Purpose};
use dyelapse::photo::Photo;
use dyelapse::photo::segment::{Hints, Segmentation, segment};
use dyelapse::prelude::*;
use dyelapse::texture::seen;
use image::{DynamicImage, RgbImage, imageops};

/// A photograph of undyed cloth at some pixels a cell, and where its warp lies on top.
fn photographed(weave: &str, scale: usize) -> (RgbImage, Vec<bool>) {
    let text = format!(
        "(title: \"t\", seed: 5, cloth: (size: (Cells(120), Cells(100)), weave: {weave},
           warp: (width: Cells(4), gap: Cells(0))),
          supply: [], process: (duration: Steps(1)), look: (pixels_per_cell: {scale}))"
    );
    let app = dyed(common::experiment(&text), 0);
    let picture = app.world().resource::<Picture>().clone();
    let (nx, ny) = (picture.width, picture.height);
    let image = RgbImage::from_raw(nx as u32, ny as u32, picture.rgb).unwrap();
    let cloth = app.world().resource::<Cloth>();
    let warp = |i: usize| seen(cloth, i / nx / scale, i % nx / scale) == Layer::Warp;
    (image, (0..nx * ny).map(warp).collect())
}

fn found(image: RgbImage) -> Segmentation {
    let photo = Photo::from_image(DynamicImage::ImageRgb8(image));
    segment(&photo, &Hints::default()).unwrap_or_else(|why| panic!("{why}"))
}

fn right(found: &Segmentation, truth: &[bool]) -> f64 {
    let same = found.mask.warp_on_top.iter().zip(truth);
    same.filter(|(a, b)| a == b).count() as f64 / truth.len() as f64
}

#[test]
fn plain_twill_and_satin_are_told_apart_and_most_pixels_are_right() {
    for (weave, name) in [
        ("Plain", "plain"),
        ("Twill(over: 2, under: 2)", "2/2 twill"),
        ("Satin(shafts: 5, counter: 2)", "satin"),
    ] {
        let (image, truth) = photographed(weave, 2);
        let found = found(image);
        let (share, seen) = (right(&found, &truth), found.weave.to_string());
        println!(
            "{weave}: {:.1} % right, {:.1} % doubtful, {seen}",
            100.0 * share,
            100.0 * found.doubtful_share()
        );
        assert!(share > 0.85, "{weave}: {share}");
        assert!(seen.contains(name), "{weave} is taken for {seen}");
        for pitch in found.pitch {
            assert!((pitch - 8.0).abs() < 0.2, "{pitch}");
        }
    }
}

#[test]
fn where_less_is_right_more_is_in_doubt() {
    let (image, truth) = photographed("Plain", 2);
    let mut worse = imageops::blur(&image, 1.2);
    let mut chance = Chance(7).sequence(Purpose::WarpLook);
    for pixel in worse.pixels_mut() {
        let noise = chance.between((-30.0, 30.0));
        pixel.0 = pixel
            .0
            .map(|channel| (f64::from(channel) + noise).clamp(0.0, 255.0) as u8);
    }
    let (clear, poor) = (found(image), found(worse));
    println!(
        "right {:.3} and {:.3}, doubtful {:.3} and {:.3}",
        right(&clear, &truth),
        right(&poor, &truth),
        clear.doubtful_share(),
        poor.doubtful_share()
    );
    assert!(right(&poor, &truth) < right(&clear, &truth));
    assert!(poor.doubtful_share() > clear.doubtful_share());
}

#[test]
fn a_photograph_without_cloth_is_refused() {
    let mut chance = Chance(3).sequence(Purpose::WarpLook);
    let noise = RgbImage::from_fn(200, 160, |_, _| {
        image::Rgb([chance.between((60.0, 190.0)) as u8; 3])
    });
    for image in [RgbImage::from_pixel(200, 160, image::Rgb([200; 3])), noise] {
        let photo = Photo::from_image(DynamicImage::ImageRgb8(image));
        assert!(segment(&photo, &Hints::default()).is_err());
    }
}

#[test]
fn the_commands_write_what_they_say_and_refuse_the_rest_with_2() {
    let folder = program::folder();
    let (image, _) = photographed("Plain", 2);
    let path = |name: &str| folder.path().join(name);
    image.save(path("cloth.png")).unwrap();
    let run = |arguments: &[&str]| program::dyelapse(&folder).args(arguments).output().unwrap();
    let done = run(&["segment", "cloth.png", "--doubt", "doubt.png"]);
    assert!(done.status.success());
    assert!(String::from_utf8_lossy(&done.stdout).contains("doubtful"));
    assert!(path("cloth_mask.png").exists() && path("doubt.png").exists());
    assert!(
        run(&["palette", "cloth.png", "--swatch", "swatch.png"])
            .status
            .success()
    );
    std::fs::write(path("no.jpg"), b"no picture").unwrap();
    let whole = std::fs::read(path("cloth.png")).unwrap();
    std::fs::write(path("cut.png"), &whole[..whole.len() / 2]).unwrap();
    for arguments in [
        ["segment", "missing.png"].as_slice(),
        &["segment", "no.jpg"],
        &["segment", "cut.png"],
        &["segment", "cloth.png"],
        &["palette", "no.jpg"],
        &["palette", "cloth.png", "--region", "1,2"],
        &["palette", "cloth.png", "--region", "0,0,9999,1"],
    ] {
        assert_eq!(run(arguments).status.code(), Some(2), "{arguments:?}");
    }
}
