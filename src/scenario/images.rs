//! The pictures that a scenario's patterns name, loaded and checked before anything runs.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use image::{RgbImage, imageops};

use super::check::Problem;
use super::error::{did_you_mean, nearest};
use super::{Beside, Scenario};
use crate::batik::drawing::{Drawing, Ground};
use crate::cloth::{Grid, Mask};
use crate::draft::{self, Draft, wif};
use crate::memory;
use crate::pattern::{Fit, Raster};
use crate::photo::{self, file};

/// Loaded pictures by the name that the scenario gives them.
#[derive(Debug, Clone, Default)]
pub struct Images {
    rasters: BTreeMap<String, Raster>,
    photos: BTreeMap<String, Photo>,
    masks: BTreeMap<String, Mask>,
    drafts: BTreeMap<String, Draft>,
    drawings: BTreeMap<(String, Ground), Drawing>,
    /// The drafts that lie beside the scenario, and are copied with it.
    own_drafts: BTreeSet<String>,
}

/// What is wanted of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    /// Its brightness, for a pattern.
    Brightness(Fit),
    /// Its colours, for cloth to look like it.
    Photo(Fit),
    /// Where it is blue and where it is red, for a weave.
    Mask,
    /// What is drawn, for wax.
    Drawing(Ground),
    /// The draft of a weave: no picture at all.
    Draft,
}

impl Wanted {
    fn fit(self) -> Fit {
        match self {
            Wanted::Brightness(fit) | Wanted::Photo(fit) => fit,
            Wanted::Mask | Wanted::Draft => Fit::Exact,
            Wanted::Drawing(_) => Fit::Stretch,
        }
    }
}

/// A photograph of cloth.
#[derive(Debug, Clone, PartialEq)]
pub struct Photo {
    /// 8-bit sRGB.
    pub rgb: RgbImage,
}

impl Photo {
    /// The photograph with one pixel for each cell of a grid.
    pub fn fitted(&self, fit: Fit, grid: Grid) -> Photo {
        let (width, height) = (grid.nx as u32, grid.ny as u32);
        let rgb = if fit == Fit::Exact || self.rgb.dimensions() == (width, height) {
            self.rgb.clone()
        } else {
            imageops::resize(&self.rgb, width, height, imageops::FilterType::Triangle)
        };
        Photo { rgb }
    }
}

/// Bytes for one pixel of a picture while it is loaded: decoded, in grey with alpha, and kept.
const BYTES_PER_PIXEL: u64 = 8 + 8 + 4;

impl Images {
    /// The picture of this name, if it was loaded.
    pub fn get(&self, file: &str) -> Option<&Raster> {
        self.rasters.get(file)
    }

    /// The photograph of this name, if it was loaded.
    pub fn photo(&self, file: &str) -> Option<&Photo> {
        self.photos.get(file)
    }

    /// The mask of this name, if it was loaded.
    pub fn mask(&self, file: &str) -> Option<&Mask> {
        self.masks.get(file)
    }

    /// The drawing of this name on this ground, if it was loaded.
    pub fn drawing(&self, file: &str, ground: Ground) -> Option<&Drawing> {
        self.drawings.get(&(file.to_owned(), ground))
    }

    /// The draft of this name, if it was loaded.
    pub fn draft(&self, file: &str) -> Option<&Draft> {
        self.drafts.get(file)
    }

    /// Bytes that loading the pictures takes at most: one after the other, and then all of them.
    pub fn bytes(&self) -> u128 {
        let rasters = self.rasters.values().map(|raster| raster.values.len());
        let drawings = self.drawings.values().map(|d| d.drawn.values.len());
        let photos = self.photos.values().map(|p| p.rgb.pixels().len());
        let masks = self.masks.values().map(Mask::cells);
        let all = rasters.chain(drawings).chain(photos).chain(masks);
        let pixels: Vec<u128> = all.map(|pixels| pixels as u128).collect();
        let largest = pixels.iter().max().copied().unwrap_or(0);
        u128::from(BYTES_PER_PIXEL) * largest + 4 * pixels.iter().sum::<u128>()
    }

    /// The names of all pictures.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        let all = self.rasters.keys().chain(self.photos.keys());
        all.chain(self.masks.keys())
            .chain(&self.own_drafts)
            .chain(self.drawings.keys().map(|(file, _)| file))
            .map(String::as_str)
    }

    /// Loads every picture that a scenario names.
    ///
    /// # Errors
    /// A [`Problem`] at the field, naming the file, if it is missing, corrupt or of another size than
    /// the cloth.
    pub(crate) fn load(scenario: &Scenario, beside: &Beside) -> Result<Self, Problem> {
        let mut images = Images::default();
        for (file, wanted, at) in scenario.pictures() {
            let path = beside.path(file);
            if wanted == Wanted::Draft {
                let (draft, is_own) = read_draft(file, beside).map_err(|why| at.problem(why))?;
                images.drafts.insert(file.to_owned(), draft);
                if is_own {
                    images.own_drafts.insert(file.to_owned());
                }
                continue;
            }
            let named = |why: String| at.problem(format!("the picture {}: {why}", path.display()));
            let bytes = beside.read(file).map_err(named)?;
            let size = file::dimensions(&bytes).map_err(named)?;
            check_size(size, wanted, scenario.cloth.cells()).map_err(named)?;
            let name = file.to_owned();
            match wanted {
                Wanted::Brightness(_) if !images.rasters.contains_key(file) => {
                    let raster = decode(&bytes).map_err(named)?;
                    images.rasters.insert(name, raster);
                }
                Wanted::Photo(_) if !images.photos.contains_key(file) => {
                    let image = file::decode(&bytes).map_err(named)?;
                    let rgb = photo::Photo::from_image(image).picture();
                    images.photos.insert(name, Photo { rgb });
                }
                Wanted::Drawing(ground) => {
                    let drawing = Drawing::read(&path, &bytes, ground);
                    let drawing = drawing.map_err(|why| at.problem(why.to_string()))?;
                    images.drawings.insert((name, ground), drawing);
                }
                Wanted::Mask if !images.masks.contains_key(file) => {
                    let mask = mask(&path, &bytes).map_err(|why| at.problem(why))?;
                    images.masks.insert(name, mask);
                }
                _ => {}
            }
        }
        Ok(images)
    }
}

/// Demands that a picture fits in memory and, where it is not to be fitted, to the cloth.
fn check_size(
    (width, height): (usize, usize),
    wanted: Wanted,
    cloth: (usize, usize),
) -> Result<(), String> {
    let needed = BYTES_PER_PIXEL * width as u64 * height as u64;
    if needed > memory::free() {
        return Err(format!(
            "its {width}×{height} pixels need {} MB of memory, more than is free",
            needed / 1_000_000
        ));
    }
    let (nx, ny) = cloth;
    if wanted.fit() == Fit::Stretch || (width, height) == cloth {
        return Ok(());
    }
    let help = match wanted {
        Wanted::Mask => {
            format!("; `size: (Cells({width}), Cells({height}))` makes a cloth of its size")
        }
        _ => "; `fit: Stretch` fits it to the cloth".into(),
    };
    Err(format!(
        "it has {width}×{height} pixels but the cloth has {nx}×{ny} cells{help}"
    ))
}

/// Brightness from 0 to 1; what is transparent counts as black, so that only what is drawn counts.
fn decode(bytes: &[u8]) -> Result<Raster, String> {
    let image = file::decode(bytes)?.to_luma_alpha32f();
    Ok(Raster {
        nx: image.width() as usize,
        ny: image.height() as usize,
        values: image
            .pixels()
            .map(|pixel| (pixel.0[0] * pixel.0[1]).clamp(0.0, 1.0))
            .collect(),
    })
}

/// A mask that is blue where the warp is on top and red where the weft is.
fn mask(path: &Path, bytes: &[u8]) -> Result<Mask, String> {
    let picture = photo::Photo::from_image(file::decode(bytes)?);
    let mask = photo::Mask::read(path, &picture).map_err(|why| why.to_string())?;
    Ok(Mask::new(mask.nx, mask.warp_on_top))
}

/// A draft that lies beside the scenario, or else comes with the program; and whether it is the former.
fn read_draft(file: &str, beside: &Beside) -> Result<(Draft, bool), String> {
    let bundled = draft::bundled_names();
    let (reading, is_own) = match beside.read(file) {
        Ok(bytes) => (wif::read(file, &bytes), true),
        Err(_) if bundled.contains(&file) => (Draft::load(file), false),
        Err(why) => {
            let path = beside.path(file);
            let mean = did_you_mean(nearest(file, bundled));
            return Err(format!("the draft {}: {why}{mean}", path.display()));
        }
    };
    let reading = reading.map_err(|why| why.to_string())?;
    Ok((reading.draft, is_own))
}
