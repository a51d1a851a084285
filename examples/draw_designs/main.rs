//! Draws batik designs of our own.
//!
//! `cargo run --release --example draw_designs -- FOLDER`
//!
//! The lotus is for two baths, black where there is wax in each: what is waxed both times stays
//! white, what is waxed in one bath takes the other dye alone, and the ground takes both. The spray
//! is for one, black where the cloth is dyed.

mod lotus;
mod sheet;
mod spray;

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use image::GrayImage;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};

use sheet::SIDE;

fn save(black: impl Iterator<Item = u8>, file: &Path) -> Result<(), Box<dyn Error>> {
    let grey = black.map(|black| 255 - black).collect();
    let image = GrayImage::from_raw(SIDE, SIDE, grey).ok_or("a sheet of another size")?;
    let out = BufWriter::new(File::create(file)?);
    let (quality, filter) = (CompressionType::Best, FilterType::Adaptive);
    image.write_with_encoder(PngEncoder::new_with_quality(out, quality, filter))?;
    println!("{}", file.display());
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args()
        .nth(1)
        .map_or_else(std::env::temp_dir, PathBuf::from);
    let [first, second] = lotus::draw().ok_or("no room for the lotus")?.wax();
    save(first.into_iter(), &folder.join("lotus_first_wax.png"))?;
    save(second.into_iter(), &folder.join("lotus_second_wax.png"))?;
    let [wax, _] = spray::draw().ok_or("no room for the spray")?.wax();
    save(
        wax.into_iter().map(|wax| 255 - wax),
        &folder.join("spray.png"),
    )
}
