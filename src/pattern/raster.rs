//! Drawing a pattern on the cells of a cloth.

use image::{ImageBuffer, Luma, imageops};
use rayon::prelude::*;

use super::{Fit, Pattern, seikaiha, shapes, strokes};
use crate::scenario::{Experiment, Images};

/// One value from 0 to 1 for every position `(y, x)`, row 0 at the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Raster {
    /// Cells across.
    pub nx: usize,
    /// Cells down.
    pub ny: usize,
    /// The values, row by row.
    pub values: Vec<f32>,
}

impl Raster {
    /// A raster with one value everywhere.
    pub fn uniform(nx: usize, ny: usize, value: f32) -> Self {
        Raster {
            nx,
            ny,
            values: vec![value; nx * ny],
        }
    }

    /// A raster of a function of the middle of each cell, in cells.
    pub fn from_rule(nx: usize, ny: usize, rule: impl Fn(f64, f64) -> f32 + Sync) -> Self {
        let mut raster = Raster::uniform(nx, ny, 0.0);
        raster
            .values
            .par_chunks_mut(nx.max(1))
            .enumerate()
            .for_each(|(y, row)| {
                for (x, value) in row.iter_mut().enumerate() {
                    *value = rule(x as f64 + 0.5, y as f64 + 0.5);
                }
            });
        raster
    }

    /// The same seen from the other side: left and right exchanged.
    pub fn mirrored(&self) -> Self {
        let rows = self.values.chunks(self.nx.max(1));
        Raster {
            nx: self.nx,
            ny: self.ny,
            values: rows.flat_map(|row| row.iter().rev().copied()).collect(),
        }
    }

    /// The value at a position.
    pub fn at(&self, y: usize, x: usize) -> f32 {
        self.values[y * self.nx + x]
    }

    fn map(mut self, change: impl Fn(f32) -> f32 + Sync + Send) -> Self {
        self.values.par_iter_mut().for_each(|v| *v = change(*v));
        self
    }

    fn merge(mut self, other: &Raster, choose: impl Fn(f32, f32) -> f32 + Sync + Send) -> Self {
        self.values
            .par_iter_mut()
            .zip(&other.values)
            .for_each(|(a, b)| *a = choose(*a, *b));
        self
    }

    fn into_image(self) -> ImageBuffer<Luma<f32>, Vec<f32>> {
        ImageBuffer::from_raw(self.nx as u32, self.ny as u32, self.values).unwrap_or_default()
    }

    fn from_image(image: ImageBuffer<Luma<f32>, Vec<f32>>) -> Self {
        Raster {
            nx: image.width() as usize,
            ny: image.height() as usize,
            values: image.into_raw(),
        }
        .map(|v| v.clamp(0.0, 1.0))
    }

    fn stretched(&self, nx: usize, ny: usize) -> Self {
        let filter = imageops::FilterType::Triangle;
        let image = self.clone().into_image();
        Raster::from_image(imageops::resize(&image, nx as u32, ny as u32, filter))
    }

    /// With soft edges: a Gaussian blur of standard deviation `sigma` cells.
    pub(crate) fn blurred(self, sigma: f64) -> Self {
        // Out to four standard deviations: beyond lies less than 10⁻⁴ of a Gaussian.
        let reach = (4.0 * sigma).ceil() as i64;
        let bell = |i: i64| libm::exp(-0.5 * (i as f64 / sigma) * (i as f64 / sigma));
        let sum: f64 = (-reach..=reach).map(bell).sum();
        let kernel: Vec<f32> = (-reach..=reach).map(|i| (bell(i) / sum) as f32).collect();
        let image = self.into_image();
        Raster::from_image(imageproc::filter::separable_filter_equal(&image, &kernel))
    }
}

/// What patterns are drawn on: the size of the cloth, the scenario's seed and its pictures.
#[derive(Debug, Clone, Copy)]
pub struct Canvas<'a> {
    /// Cells across.
    pub nx: usize,
    /// Cells down.
    pub ny: usize,
    /// Side of a cell, mm.
    pub cell_mm: f64,
    /// Seed of everything random in the scenario.
    pub seed: u64,
    /// The pictures that patterns name, already loaded.
    pub images: &'a Images,
}

impl<'a> Canvas<'a> {
    /// What the patterns of an experiment are drawn on.
    pub fn of(experiment: &'a Experiment) -> Self {
        let (nx, ny) = experiment.scenario.cloth.cells();
        Canvas {
            nx,
            ny,
            cell_mm: experiment.scenario.cloth.cell_mm,
            seed: experiment.scenario.seed,
            images: &experiment.images,
        }
    }

    /// Draws a pattern.
    ///
    /// A picture that has not been loaded counts as nothing; loading an experiment loads them all.
    pub fn draw(&self, pattern: &Pattern) -> Raster {
        let (nx, ny) = (self.nx, self.ny);
        match pattern {
            Pattern::Nowhere => Raster::uniform(nx, ny, 0.0),
            Pattern::Everywhere => Raster::uniform(nx, ny, 1.0),
            Pattern::Image { file, fit } => match (self.images.get(file), fit) {
                (None, _) => Raster::uniform(nx, ny, 0.0),
                (Some(image), Fit::Exact) => image.clone(),
                (Some(image), Fit::Stretch) => image.stretched(nx, ny),
            },
            Pattern::Union(parts) => self.combine(parts, 0.0, f32::max),
            Pattern::Intersection(parts) => self.combine(parts, 1.0, f32::min),
            Pattern::Without { of, cut } => {
                let cut = self.draw(cut);
                self.draw(of).merge(&cut, |a, b| a.min(1.0 - b))
            }
            Pattern::Invert(of) => self.draw(of).map(|v| 1.0 - v),
            Pattern::Blur { of, radius } => self.draw(of).blurred(radius.cells(self.cell_mm)),
            Pattern::Strength { of, by } => {
                let by = *by as f32;
                self.draw(of).map(move |v| v * by)
            }
            Pattern::Seikaiha { radius, arcs, open } => {
                let radius = radius.cells(self.cell_mm);
                Raster::from_rule(nx, ny, |x, y| {
                    seikaiha::paste(x, y, radius, f64::from(*arcs), *open)
                })
            }
            Pattern::Strokes(all) => strokes::draw(all, nx, ny, self.cell_mm),
            Pattern::Noise {
                grain,
                octaves,
                seed,
            } => {
                let grain = grain.cells(self.cell_mm);
                let clouds = shapes::clouds(self.seed, *seed, *octaves);
                Raster::from_rule(nx, ny, |x, y| clouds(x / grain, y / grain))
            }
            simple => {
                let shape = shapes::rule(simple, self);
                Raster::from_rule(nx, ny, shape)
            }
        }
    }

    fn combine(&self, parts: &[Pattern], none: f32, choose: fn(f32, f32) -> f32) -> Raster {
        let mut whole = Raster::uniform(self.nx, self.ny, none);
        for part in parts {
            whole = whole.merge(&self.draw(part), choose);
        }
        whole
    }
}
