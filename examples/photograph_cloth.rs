//! Takes a "photograph" of white cotton, and its true mask.
//!
//!     cargo run --release --example photograph_cloth -- FOLDER
//!
//! Photographs of real cloth belong to others, so one is made here to try photo mode on: handwoven cloth of
//! uneven yarns, drawn four times as large and made smaller as a lens does, in uneven light, with the
//! noise of a sensor. `plain_cotton.jpg` is the photograph, `truth.png` says where its warp (blue) and
//! its weft (red) lie on top.

use std::error::Error;
use std::path::PathBuf;

use dyelapse::chance::{Chance, Purpose};
use dyelapse::prelude::*;
use dyelapse::scenario::{Origin, Side};
use dyelapse::texture::{Texture, seen};
use image::{Rgb, RgbImage, imageops};

const CLOTH: &str = r#"(
    title: "Handwoven cotton",
    seed: 41,
    cloth: (
        size: (Cells(400), Cells(300)),
        weave: Plain,
        warp: (width: Cells(7), gap: Cells(1), vary_width: (0.8, 1.25)),
        weft: (width: Cells(6), gap: Cells(1), vary_width: (0.75, 1.35)),
    ),
    supply: [],
    process: (duration: Steps(1)),
    look: (yarn: (unevenness: 0.9, roughness: 0.4, turn: 4.5)),
)"#;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args()
        .nth(1)
        .map_or(std::env::temp_dir(), PathBuf::from);
    let experiment = Experiment::parse("cotton", Origin::Memory, CLOTH.into())?;
    let app = dyeing_app(experiment.clone());
    let world = app.world();
    let cloth: &Cloth = world.resource();
    let texture = Texture::new(
        cloth,
        &experiment.scenario,
        &experiment.images,
        4,
        Side::Face,
    );
    let mut picture = Picture::default();
    texture.draw(cloth, world.resource(), world.resource(), &mut picture);
    let large = RgbImage::from_raw(picture.width as u32, picture.height as u32, picture.rgb)
        .ok_or("a picture has three bytes a pixel")?;
    let mut photo = imageops::resize(&large, 400, 300, imageops::FilterType::Lanczos3);
    let mut noise = Chance(41).sequence(Purpose::WarpLook);
    for (x, y, pixel) in photo.enumerate_pixels_mut() {
        // A window to the upper left, and a warm wall opposite.
        let (x, y) = (f64::from(x) / 400.0, f64::from(y) / 300.0);
        let light =
            1.10 - 0.16 * x - 0.10 * y - 0.12 * ((x - 0.4) * (x - 0.4) + (y - 0.4) * (y - 0.4));
        let grain = noise.between((-0.5, 0.5)) + noise.between((-0.5, 0.5));
        for (channel, warmth) in pixel.0.iter_mut().zip([1.0, 0.985, 0.955]) {
            let value = f64::from(*channel) * light * warmth + 5.0 * grain;
            *channel = (value + 0.5).clamp(0.0, 255.0) as u8;
        }
    }
    photo.save(folder.join("plain_cotton.jpg"))?;
    let truth = RgbImage::from_fn(400, 300, |x, y| match seen(cloth, y as usize, x as usize) {
        Layer::Warp => Rgb([0, 0, 255]),
        Layer::Weft => Rgb([255, 0, 0]),
    });
    truth.save(folder.join("truth.png"))?;
    println!("{}", folder.display());
    Ok(())
}
