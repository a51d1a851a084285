//! The fields behind the pictures, as NumPy archives: `cloth.npz` once, `state_00000.npz` a frame.
//!
//! Layer 0 is weft, 1 is warp; row 0 is the top of the picture. `docs/fields.md` lists every array.

use std::fs::File;
use std::io::{self, BufWriter, Seek, Write};

use npyz::{AutoSerialize, WriterBuilder};
use zip::write::{SimpleFileOptions, ZipWriter};
use zip::{CompressionMethod, DateTime};

use super::recorder::Dyed;
use crate::cloth::{Cloth, Grid, Layer};
use crate::diffusion::Faces;
use crate::scenario::{Experiment, Isotherm};

/// A NumPy archive being written.
struct Archive<W: Write + Seek> {
    zip: ZipWriter<W>,
}

impl<W: Write + Seek> Archive<W> {
    /// Writes an archive of what `fill` adds to it.
    fn write(file: W, fill: impl FnOnce(&mut Self) -> io::Result<()>) -> io::Result<()> {
        let mut archive = Archive {
            zip: ZipWriter::new(file),
        };
        match fill(&mut archive) {
            Ok(()) => archive.zip.finish().map(|_| ()).map_err(Into::into),
            Err(why) => {
                // Dropped, it would try to finish the archive and complain that it cannot.
                std::mem::forget(archive.zip);
                Err(why)
            }
        }
    }

    /// Adds an array; an empty shape makes a scalar.
    fn add<T: AutoSerialize>(
        &mut self,
        name: &str,
        shape: &[usize],
        values: impl IntoIterator<Item = T>,
    ) -> io::Result<()> {
        // The same fields give the same bytes, whenever they are written.
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .compression_level(Some(1))
            .last_modified_time(DateTime::default())
            .large_file(true);
        self.zip.start_file(format!("{name}.npy"), options)?;
        let shape: Vec<u64> = shape.iter().map(|n| *n as u64).collect();
        let mut array = npyz::WriteOptions::new()
            .default_dtype()
            .shape(&shape)
            .writer(&mut self.zip)
            .begin_nd()?;
        array.extend(values)?;
        array.finish()
    }

    fn scalar<T: AutoSerialize>(&mut self, name: &str, value: T) -> io::Result<()> {
        self.add(name, &[], [value])
    }
}

/// Every cell `(layer, y, x)` in the order of the arrays, with `less_y` rows and `less_x` columns
/// fewer: faces lie between cells.
fn cells(grid: Grid, less_y: usize, less_x: usize) -> impl Iterator<Item = (Layer, usize, usize)> {
    let (ny, nx) = (grid.ny - less_y, grid.nx - less_x);
    Layer::BOTH
        .into_iter()
        .flat_map(move |layer| (0..ny).flat_map(move |y| (0..nx).map(move |x| (layer, y, x))))
}

/// Writes what stays the same from frame to frame.
pub(super) fn write_cloth(
    cloth: &Cloth,
    experiment: &Experiment,
    splits: u32,
    file: &mut BufWriter<File>,
) -> io::Result<()> {
    let scenario = &experiment.scenario;
    let grid = cloth.grid;
    let Grid { nx, ny } = grid;
    let faces = Faces {
        cloth,
        paths: &scenario.cloth.paths,
        in_water: scenario.dye.diffusivity.in_water(),
    };
    let whole = [2, ny, nx];
    let one_layer = || (0..ny).flat_map(|y| (0..nx).map(move |x| (y, x)));
    Archive::write(file, |archive| {
        let x = cells(grid, 0, 1).map(|(l, y, x)| faces.x(l, y, x) as f32);
        archive.add("face_x", &[2, ny, nx - 1], x)?;
        let y = cells(grid, 1, 0).map(|(l, y, x)| faces.y(l, y, x) as f32);
        archive.add("face_y", &[2, ny - 1, nx], y)?;
        let z = one_layer().map(|(y, x)| faces.z(y, x) as f32);
        archive.add("face_z", &[ny, nx], z)?;
        let free = cells(grid, 0, 0).map(|(l, y, x)| cloth.capacity_free(l, y, x));
        archive.add("capacity_free", &whole, free)?;
        let bound = cells(grid, 0, 0).map(|(l, y, x)| cloth.capacity_bound(l, y, x));
        archive.add("capacity_bound", &whole, bound)?;
        let porosity = cells(grid, 0, 0).map(|(l, y, x)| cloth.porosity(l, y, x) as f32);
        archive.add("porosity", &whole, porosity)?;
        let resist = cells(grid, 0, 0).map(|(l, y, x)| cloth.volume_ratio(l, y, x) as f32);
        archive.add("resist", &whole, resist)?;
        let fibre = cells(grid, 0, 0).map(|(l, y, x)| cloth.fibre(l, y, x));
        archive.add("fibre", &whole, fibre)?;
        let warp_up = one_layer().map(|(y, x)| cloth.warp_up(y, x));
        archive.add("warp_up", &[ny, nx], warp_up)?;
        archive.scalar("cell_mm", cloth.cell_mm)?;
        archive.scalar("dt_h", scenario.process.step_h)?;
        archive.scalar("d0_mm2_h", scenario.dye.diffusivity.in_water())?;
        archive.scalar("phi0", scenario.dye.equilibrium)?;
        let (isotherm, k, b) = match scenario.adsorption.map(|adsorption| adsorption.isotherm) {
            None => (0_i64, 0.0, 0.0),
            Some(Isotherm::Partition { k }) => (1, k, 1.0),
            Some(Isotherm::Freundlich { k, b }) => (2, k, b),
            Some(Isotherm::Langmuir { kl }) => (3, kl, 0.0),
            Some(Isotherm::Saturating { speed, most }) => (4, speed, most),
        };
        archive.scalar("isotherm", isotherm)?;
        archive.scalar("isotherm_k", k)?;
        archive.scalar("isotherm_b", b)?;
        archive.scalar("splits", i64::from(splits))?;
        let rate = scenario
            .adsorption
            .map_or(0.0, |adsorption| adsorption.rate);
        archive.scalar("dab_mm2_h", rate * scenario.dye.diffusivity.in_water())?;
        Ok(())
    })
}

/// What changes from frame to frame.
pub(super) struct State {
    grid: Grid,
    free: Vec<f32>,
    bound: Vec<f32>,
    held: Vec<f32>,
    step: u64,
    hours: f64,
}

impl State {
    /// Takes the fields as they are at this moment.
    pub fn take(dyed: &mut Dyed, step: u64, hours: f64) -> Self {
        let cloth = &dyed.cloth;
        // Paper B's f knows no capacity.
        let plain = dyed.experiment.scenario.sweeps();
        let amounts = |concentration: &[f32]| -> Vec<f32> {
            let both = concentration.iter().zip(cells(cloth.grid, 0, 0));
            let amount = |(c, (l, y, x)): (&f32, _)| match plain {
                true => *c,
                false => c * cloth.capacity_free(l, y, x),
            };
            both.map(amount).collect()
        };
        let held = dyed.supplies.held(step, cloth.grid.len());
        State {
            grid: cloth.grid,
            free: amounts(&dyed.free.concentration),
            bound: (0..cloth.grid.len()).map(|i| dyed.bound.at(i)).collect(),
            held: amounts(&held),
            step,
            hours,
        }
    }

    /// Writes them as an archive.
    pub fn write(&self, file: &mut BufWriter<File>) -> io::Result<()> {
        let shape = [2, self.grid.ny, self.grid.nx];
        Archive::write(file, |archive| {
            archive.add("free", &shape, self.free.iter().copied())?;
            archive.add("bound", &shape, self.bound.iter().copied())?;
            archive.add("held", &shape, self.held.iter().copied())?;
            archive.scalar("step", self.step as i64)?;
            archive.scalar("time_h", self.hours)?;
            Ok(())
        })
    }
}
