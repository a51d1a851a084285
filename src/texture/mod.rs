//! What is seen: dye as colour on shaded yarns (paper D §4.3; model section 6).

mod colour;
pub mod oklab;
mod shade;
mod yarn;

use bevy::prelude::*;
use rayon::prelude::*;

pub use colour::{Hsv, Ramp, Rgb, between, to_hsv, to_rgb};
use shade::Shade;
pub use shade::seen;

use crate::adsorption::BoundDye;
use crate::cloth::{Cloth, Layer};
use crate::diffusion::FreeDye;
use crate::scenario::{Scenario, Show};
use crate::schedule::{DyeFrame, FrameSet, Prepare, PrepareSet, TheExperiment};

/// Pictures of the cloth.
pub struct TexturePlugin;

impl Plugin for TexturePlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Prepare, prepare.in_set(PrepareSet::Stages))
            .add_systems(DyeFrame, draw.in_set(FrameSet::Draw));
    }
}

/// Pixels along one side of a cell, where it is not the scenario's own.
#[derive(Resource, Debug, Clone, Copy)]
pub struct Scale(pub u32);

/// What stays the same from picture to picture.
#[derive(Resource)]
pub struct Texture {
    /// Pixels along one side of a cell.
    pub scale: usize,
    /// For every position `(y, x)`, the cell that gives it its colour.
    seen: Vec<Seen>,
    /// The shade of every pixel, row by row.
    shade: Vec<Shade>,
    /// Colours by amount of dye.
    pub ramp: Ramp,
    /// Which dye is shown.
    pub show: Show,
}

/// The cloth as it is seen: 8-bit RGB, row by row.
#[derive(Resource, Debug, Clone, Default, PartialEq)]
pub struct Picture {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Red, green and blue of every pixel.
    pub rgb: Vec<u8>,
}

/// Which cell of its row gives a position its colour, in two bytes: the layer in the highest bit,
/// and how many columns to the left.
#[derive(Debug, Clone, Copy)]
struct Seen(u16);

impl Seen {
    const WARP: u16 = 1 << 15;

    fn new((layer, column): (Layer, usize), x: usize) -> Self {
        // Nobody could tell by which yarn a gap of 32,768 cells is shaded.
        let left = (x - column).min(usize::from(Self::WARP) - 1) as u16;
        match layer {
            Layer::Weft => Seen(left),
            Layer::Warp => Seen(left | Self::WARP),
        }
    }

    fn cell(self, x: usize) -> (Layer, usize) {
        let layer = Layer::BOTH[usize::from(self.0 >> 15)];
        (layer, x - usize::from(self.0 & !Self::WARP))
    }
}

impl Texture {
    /// Prepares pictures of a cloth at `scale` pixels a cell.
    pub fn new(cloth: &Cloth, scenario: &Scenario, scale: usize) -> Self {
        let nx = cloth.grid.nx;
        let mut seen = vec![Seen(0); cloth.grid.layer_len()];
        seen.par_chunks_mut(nx).enumerate().for_each(|(y, row)| {
            for (x, cell) in row.iter_mut().enumerate() {
                *cell = Seen::new(shade::coloured_by(cloth, y, x), x);
            }
        });
        Texture {
            scale,
            seen,
            shade: shade::draw(cloth, scenario.look.yarn, scenario.seed, scale),
            ramp: Ramp::new(
                &scenario.look.colours,
                scenario.look.path,
                darkest_at(scenario),
            ),
            show: scenario.look.show,
        }
    }

    /// Draws dye on the cloth.
    pub fn draw(&self, cloth: &Cloth, free: &FreeDye, bound: &BoundDye, picture: &mut Picture) {
        let (nx, ny, scale) = (cloth.grid.nx, cloth.grid.ny, self.scale);
        picture.width = nx * scale;
        picture.height = ny * scale;
        picture.rgb.resize(picture.width * picture.height * 3, 0);
        let amount = |(layer, x): (Layer, usize), y: usize| {
            let i = cloth.grid.index(layer, y, x);
            match self.show {
                Show::FreeAndBound => {
                    free.concentration[i] * cloth.capacity_free(layer, y, x) + bound.at(i)
                }
                Show::BoundOnly => bound.at(i),
            }
        };
        let width = picture.width;
        picture
            .rgb
            .par_chunks_mut(width * scale * 3)
            .enumerate()
            .for_each(|(y, rows)| {
                let cells = &self.seen[y * nx..][..nx];
                let colours: Vec<Rgb> = cells
                    .iter()
                    .enumerate()
                    .map(|(x, seen)| self.ramp.colour(amount(seen.cell(x), y)).map(|c| 255.0 * c))
                    .collect();
                for (j, row) in rows.chunks_exact_mut(width * 3).enumerate() {
                    let shades = &self.shade[(y * scale + j) * width..][..width];
                    for (px, pixel) in row.chunks_exact_mut(3).enumerate() {
                        for (channel, colour) in pixel.iter_mut().zip(colours[px / scale]) {
                            // Casting rounds down and saturates.
                            *channel = (colour * shades[px].value() + 0.5) as u8;
                        }
                    }
                }
            });
    }
}

/// The amount of dye that has the darkest colour: as much as the cloth holds of what is shown.
pub fn darkest_at(scenario: &Scenario) -> f64 {
    if let Some(amount) = scenario.look.darkest_at {
        return amount;
    }
    let (warp, weft) = (&scenario.cloth.warp, scenario.cloth.weft());
    let porosity = warp.porosity.max(weft.porosity);
    let fibre = (1.0 - warp.porosity).max(1.0 - weft.porosity).max(0.001);
    match (scenario.look.show, scenario.adsorption) {
        (Show::BoundOnly, _) => fibre,
        (Show::FreeAndBound, None) => porosity,
        (Show::FreeAndBound, Some(_)) => 1.0,
    }
}

fn prepare(
    mut commands: Commands,
    cloth: Res<Cloth>,
    experiment: Res<TheExperiment>,
    scale: Option<Res<Scale>>,
) {
    let scenario = &experiment.scenario;
    let scale = scale.map_or(scenario.look.pixels_per_cell, |scale| scale.0);
    commands.insert_resource(Texture::new(&cloth, scenario, scale as usize));
    commands.insert_resource(Picture::default());
}

fn draw(
    texture: Res<Texture>,
    cloth: Res<Cloth>,
    free: Res<FreeDye>,
    bound: Res<BoundDye>,
    mut picture: ResMut<Picture>,
) {
    texture.draw(&cloth, &free, &bound, &mut picture);
}
