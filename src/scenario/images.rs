//! The pictures that a scenario's patterns name, loaded and checked before anything runs.

use std::collections::BTreeMap;
use std::path::Path;

use super::check::{Checker, Problem};
use crate::memory;
use crate::pattern::{Fit, Pattern, Raster};
use crate::photo::file;

/// Loaded pictures by the name that the scenario gives them.
#[derive(Debug, Clone, Default)]
pub struct Images {
    rasters: BTreeMap<String, Raster>,
}

/// Bytes for one pixel of a picture while it is loaded: decoded, in grey with alpha, and kept.
const BYTES_PER_PIXEL: u64 = 8 + 8 + 4;

impl Images {
    /// The picture of this name, if it was loaded.
    pub fn get(&self, file: &str) -> Option<&Raster> {
        self.rasters.get(file)
    }

    /// Bytes that loading the pictures takes at most: one after the other, and then all of them.
    pub fn bytes(&self) -> u128 {
        let pixels = || {
            self.rasters
                .values()
                .map(|raster| raster.values.len() as u128)
        };
        let largest = pixels().max().unwrap_or(0);
        u128::from(BYTES_PER_PIXEL) * largest + 4 * pixels().sum::<u128>()
    }

    /// The names of all pictures.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        self.rasters.keys().map(String::as_str)
    }

    /// Loads every picture that `patterns` name, from files beside the scenario in `folder`.
    ///
    /// # Errors
    /// A [`Problem`] at the pattern, naming the file, if it is missing, corrupt or of another size
    /// than the cloth.
    pub(super) fn load(
        patterns: &[(&Pattern, Checker)],
        folder: &Path,
        cloth: (usize, usize),
    ) -> Result<Self, Problem> {
        let mut images = Images::default();
        for (pattern, at) in patterns {
            let Pattern::Image { file, fit } = pattern else {
                continue;
            };
            let path = folder.join(file);
            let named = |why: String| {
                at.field("file")
                    .problem(format!("the picture {}: {why}", path.display()))
            };
            let (width, height) = file::dimensions(&path).map_err(named)?;
            let needed = BYTES_PER_PIXEL * width as u64 * height as u64;
            if needed > memory::free() {
                return Err(named(format!(
                    "its {width}×{height} pixels need {} MB of memory, more than is free",
                    needed / 1_000_000
                )));
            }
            let (nx, ny) = cloth;
            if *fit == Fit::Exact && (width, height) != cloth {
                return Err(named(format!(
                    "it has {width}×{height} pixels but the cloth has {nx}×{ny} cells; \
                     `fit: Stretch` fits it to the cloth"
                )));
            }
            if !images.rasters.contains_key(file) {
                images
                    .rasters
                    .insert(file.clone(), decode(&path).map_err(named)?);
            }
        }
        Ok(images)
    }
}

/// Brightness from 0 to 1; what is transparent counts as black, so that only what is drawn counts.
fn decode(path: &Path) -> Result<Raster, String> {
    let image = file::decode(path)?.to_luma_alpha32f();
    Ok(Raster {
        nx: image.width() as usize,
        ny: image.height() as usize,
        values: image
            .pixels()
            .map(|pixel| (pixel.0[0] * pixel.0[1]).clamp(0.0, 1.0))
            .collect(),
    })
}
