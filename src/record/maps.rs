//! The relief of the undyed cloth for a renderer: `height.png` and `normal.png`.

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

use super::RecordError;
use super::folder::Folder;
use crate::cloth::Cloth;
use crate::scenario::{Scenario, Side};
use crate::texture::Relief;

/// The names of the maps.
pub(super) const MAPS: [&str; 2] = ["height.png", "normal.png"];

/// Writes the maps of the side of a cloth that a scenario shows, at `scale` pixels a cell.
pub(super) fn write(
    folder: &Folder,
    cloth: &Cloth,
    scenario: &Scenario,
    scale: usize,
) -> Result<(), RecordError> {
    let look = &scenario.look;
    let relief = match look.side {
        Side::Face => Relief::new(cloth, &look.yarn, scenario.seed, scale),
        Side::Back => Relief::new(&cloth.turned_over(), &look.yarn, scenario.seed, scale),
    };
    let (width, height) = (relief.width as u32, relief.height as u32);
    let [heights, normals] = MAPS;
    folder.write(heights, |file| {
        let steps = relief.to_16_bit();
        // As the encoder wants them: in the order of this machine.
        let bytes: Vec<u8> = steps.iter().flat_map(|step| step.to_ne_bytes()).collect();
        PngEncoder::new(file)
            .write_image(&bytes, width, height, ExtendedColorType::L16)
            .map_err(std::io::Error::other)
    })?;
    folder.write(normals, |file| {
        PngEncoder::new(file)
            .write_image(&relief.normals(), width, height, ExtendedColorType::Rgb8)
            .map_err(std::io::Error::other)
    })
}
