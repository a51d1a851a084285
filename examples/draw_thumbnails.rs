//! Draws the pictures of the gallery: every bundled scenario as it is in the end, or, where there is nothing
//! to be seen then, in the middle.
//!
//! ```sh
//! cargo run --release --example draw_thumbnails -- assets/thumbnails
//! ```

use std::path::PathBuf;

use dyelapse::prelude::*;
use dyelapse::scenario::bundled;
use image::codecs::jpeg::JpegEncoder;
use image::imageops::{FilterType, crop_imm, resize};

/// Width and height of a picture.
const SIZE: (u32, u32) = (240, 180);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args()
        .nth(1)
        .map_or_else(|| "thumbnails".into(), PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    for scenario in bundled() {
        let experiment = Experiment::load(scenario.name)?;
        let steps = experiment.scenario.process.steps();
        let mut picture = seen(&experiment, steps);
        if is_blank(&picture) {
            picture = seen(&experiment, steps / 2);
        }
        let (width, height) = (picture.width as u32, picture.height as u32);
        let whole = image::RgbImage::from_raw(width, height, picture.rgb.clone())
            .ok_or("a picture has another size than it says")?;
        // The middle of it, in the proportions of a card.
        let across = width.min(height * SIZE.0 / SIZE.1);
        let down = height.min(width * SIZE.1 / SIZE.0);
        let (x, y) = ((width - across) / 2, (height - down) / 2);
        let middle = crop_imm(&whole, x, y, across, down).to_image();
        let small = resize(&middle, SIZE.0, SIZE.1, FilterType::CatmullRom);
        let mut bytes = Vec::new();
        JpegEncoder::new_with_quality(&mut bytes, 82).encode_image(&small)?;
        std::fs::write(folder.join(format!("{}.jpg", scenario.name)), bytes)?;
    }
    Ok(())
}

fn seen(experiment: &Experiment, step: u64) -> Picture {
    let mut app = dyeing_app(experiment.clone());
    advance_to(app.world_mut(), step, |_| true);
    look(app.world_mut());
    app.world().resource::<Picture>().clone()
}

fn is_blank(picture: &Picture) -> bool {
    let least = picture.rgb.iter().min();
    let most = picture.rgb.iter().max();
    least == most
}
