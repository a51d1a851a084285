//! What is seen: dye as colour on the undyed cloth (paper D §4.3; paper Y; model section 6).
//!
//! The undyed cloth is drawn once, at the scale of the picture: which layer each pixel shows, and in
//! what shade. For every frame the amount of dye in that layer gives the colour, which is
//! multiplied with the shade.

mod colour;
mod fractal;
mod geometry;
mod hair;
mod noise;
pub mod oklab;
mod relief;
mod shade;
mod sides;
mod taps;
mod yarn;

use std::sync::Arc;

use bevy::prelude::*;
use rayon::prelude::*;

pub use colour::{Hsv, Ramp, Rgb, between, to_hsv, to_rgb};
pub use relief::Relief;
use shade::Shade;
pub use shade::seen;
pub use sides::{OtherSide, see_both_sides};
use taps::Tap;

use crate::adsorption::BoundDye;
use crate::batik::crossings::Crossings;
use crate::batik::ellipse::EllipseWeave;
use crate::cloth::{Cloth, Layer, Yarns};
use crate::diffusion::FreeDye;
use crate::pattern::Raster;
use crate::scenario::{Experiment, Images, LookSpec, Photo, Scenario, Show, Side, TextureLook};
use crate::schedule::{DyeFrame, FrameSet, Prepare, PrepareSet, TheExperiment};

/// Pictures of the cloth.
pub struct TexturePlugin;

impl Plugin for TexturePlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Prepare, prepare.in_set(PrepareSet::Stages))
            .add_systems(DyeFrame, draw.in_set(DrawDye).in_set(FrameSet::Draw));
    }
}

/// Drawing the cloth with the one dye that the process is about; a stage that draws the cloth in
/// another way turns it off.
#[derive(SystemSet, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct DrawDye;

/// Pixels along one side of a cell, where it is not the scenario's own.
#[derive(Resource, Debug, Clone, Copy)]
pub struct Scale(pub u32);

/// What stays the same from picture to picture.
#[derive(Resource)]
pub struct Texture {
    /// Pixels along one side of a cell.
    pub scale: usize,
    /// The side that is drawn.
    pub side: Side,
    /// Layers and shade of every pixel, row by row.
    shade: Vec<Shade>,
    /// The ellipse weave, where the cloth is drawn as one.
    weave: Option<EllipseWeave>,
    /// The photograph that the colours are multiplied with, if there is one: RGB of every pixel.
    photo: Option<Vec<u8>>,
    /// Where every column finds its dye in the weft and in the warp layer, and every row.
    columns: [Vec<Tap>; 2],
    rows: [Vec<Tap>; 2],
    /// The colours of undyed weft and warp for every row and column, where they are not white.
    tints: Option<[Vec<Rgb>; 2]>,
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

impl Texture {
    /// Prepares pictures of a cloth at `scale` pixels a cell, from one side.
    pub fn new(
        cloth: &Cloth,
        scenario: &Scenario,
        images: &Images,
        scale: usize,
        side: Side,
    ) -> Self {
        let turned;
        let face = match side {
            Side::Face => cloth,
            Side::Back => {
                turned = cloth.turned_over();
                &turned
            }
        };
        let look = &scenario.look;
        let mut weave = None;
        let (shade, photo) = match &look.texture {
            TextureLook::Ellipses(spec) => {
                let up = |y, x| face.warp_up(y, x);
                let crossings = Crossings::of(face);
                weave = Some(EllipseWeave::new(
                    &crossings,
                    up,
                    *spec,
                    scale,
                    scenario.seed,
                ));
                (Vec::new(), None)
            }
            TextureLook::Shaded => (shade::draw(face, look.yarn, scenario.seed, scale), None),
            TextureLook::Fractal(fractal) => {
                (fractal::draw(face, fractal, scenario.seed, scale), None)
            }
            TextureLook::Photo { file, fit } => {
                let photo = images
                    .photo(file)
                    .map(|photo| photo.fitted(*fit, face.grid));
                let photo = photo.map(|photo| enlarged(&photo, scale, side));
                (shade::flat(face, scale), photo)
            }
        };
        let turn = |taps: Vec<Tap>| match side {
            Side::Face => taps,
            Side::Back => taps::mirrored(&taps, cloth.grid.nx),
        };
        Texture {
            scale,
            shade,
            weave,
            photo,
            side,
            columns: [
                turn(taps::along(cloth.grid.nx, scale)),
                turn(taps::across(&face.warp, scale)),
            ],
            rows: [
                taps::across(&cloth.weft, scale),
                taps::along(cloth.grid.ny, scale),
            ],
            tints: tints(face, scale),
            ramp: Ramp::new(&look.colours, look.path, darkest_at(scenario)),
            show: look.show,
        }
    }

    /// Draws dye on the cloth.
    pub fn draw(&self, cloth: &Cloth, free: &FreeDye, bound: &BoundDye, picture: &mut Picture) {
        let amounts = self.amounts(cloth, free, bound);
        if self.weave.is_some() {
            let colour = |i: usize| self.ramp.colour(amounts[i]);
            return self.draw_colours(cloth, colour, picture);
        }
        let (nx, scale) = (cloth.grid.nx, self.scale);
        let width = nx * scale;
        self.size(cloth, picture);
        let (weft, warp) = amounts.split_at(cloth.grid.layer_len());
        let between = |layer: &[f32], tap: Tap, line: &mut Vec<f32>| {
            let row = |y: u32| &layer[y as usize * nx..][..nx];
            let both = row(tap.near).iter().zip(row(tap.far));
            line.clear();
            line.extend(both.map(|(a, b)| a + tap.share * (b - a)));
        };
        // A few rows a task, so that its lines are made once.
        let rows_a_task = 4 * scale;
        picture
            .rgb
            .par_chunks_mut(width * rows_a_task * 3)
            .enumerate()
            .for_each(|(task, rows)| {
                let (mut weft_line, mut warp_line) = (Vec::new(), Vec::new());
                for (j, row) in rows.chunks_exact_mut(width * 3).enumerate() {
                    let py = task * rows_a_task + j;
                    between(weft, self.rows[0][py], &mut weft_line);
                    between(warp, self.rows[1][py], &mut warp_line);
                    self.paint(py, [&weft_line, &warp_line], row);
                }
            });
    }

    fn size(&self, cloth: &Cloth, picture: &mut Picture) {
        picture.width = cloth.grid.nx * self.scale;
        picture.height = cloth.grid.ny * self.scale;
        picture.rgb.resize(picture.width * picture.height * 3, 0);
    }

    /// Draws the cloth with a colour (sRGB, 0 to 1) for every cell of a `(layer, y, x)` field.
    pub fn draw_colours(
        &self,
        cloth: &Cloth,
        colour: impl Fn(usize) -> Rgb + Sync,
        picture: &mut Picture,
    ) {
        self.size(cloth, picture);
        let (nx, width) = (cloth.grid.nx, picture.width);
        if let Some(weave) = &self.weave {
            let shown = |y: usize, x: usize| {
                let (layer, x) = match self.side {
                    Side::Face => (seen(cloth, y, x), x),
                    Side::Back => {
                        let x = nx - 1 - x;
                        (seen(cloth, y, x).other(), x)
                    }
                };
                colour(cloth.grid.index(layer, y, x))
            };
            picture.rgb = weave.draw(shown).bytes();
            return;
        }
        let colours: Vec<Rgb> = (0..cloth.grid.len()).into_par_iter().map(&colour).collect();
        picture
            .rgb
            .par_chunks_mut(width * 3)
            .enumerate()
            .for_each(|(py, row)| {
                let of = |px: usize, layer: Layer| {
                    let row = self.rows[layer as usize][py];
                    let column = self.columns[layer as usize][px];
                    let at =
                        |y: u32, x: u32| colours[cloth.grid.index(layer, y as usize, x as usize)];
                    let line = |y| mixed(at(y, column.near), at(y, column.far), column.share);
                    let colour = mixed(line(row.near), line(row.far), row.share);
                    self.tinted(colour, layer, py, px)
                };
                let shades = &self.shade[py * width..][..width];
                let pixels = row.as_chunks_mut::<3>().0;
                for (px, (pixel, shade)) in pixels.iter_mut().zip(shades).enumerate() {
                    let colour = match shade.only() {
                        Some(layer) => of(px, layer),
                        None => mixed(of(px, Layer::Weft), of(px, Layer::Warp), shade.warp()),
                    };
                    *pixel = display(colour, shade.value());
                }
            });
    }

    /// Draws a map of the cloth in grey, black 0 and white 1.
    pub fn draw_map(&self, map: &Raster, picture: &mut Picture) {
        picture.width = map.nx * self.scale;
        picture.height = map.ny * self.scale;
        let grey = |i: usize| {
            let (y, x) = (
                i / picture.width / self.scale,
                i % picture.width / self.scale,
            );
            [(255.0 * map.at(y, x) + 0.5) as u8; 3]
        };
        let pixels = 0..picture.width * picture.height;
        picture.rgb = pixels.flat_map(grey).collect();
    }

    /// The amount of dye shown in every cell, `(layer, y, x)`.
    pub(crate) fn amounts(&self, cloth: &Cloth, free: &FreeDye, bound: &BoundDye) -> Vec<f32> {
        let (nx, ny) = (cloth.grid.nx, cloth.grid.ny);
        let mut amounts = vec![0.0; cloth.grid.len()];
        amounts
            .par_chunks_mut(nx)
            .enumerate()
            .for_each(|(row, line)| {
                let (layer, y) = (Layer::BOTH[row / ny], row % ny);
                if self.show == Show::FreeAndBound {
                    let c = &free.concentration[row * nx..][..nx];
                    for (x, (amount, c)) in line.iter_mut().zip(c).enumerate() {
                        *amount = c * cloth.capacity_free(layer, y, x);
                    }
                }
                if let Some(bound) = bound.amount.get(row * nx..(row + 1) * nx) {
                    for (amount, bound) in line.iter_mut().zip(bound) {
                        *amount += bound;
                    }
                }
            });
        amounts
    }

    /// Paints row `py`; `lines` are the amounts in weft and warp at its height.
    fn paint(&self, py: usize, lines: [&[f32]; 2], row: &mut [u8]) {
        let width = row.len() / 3;
        let shades = &self.shade[py * width..][..width];
        let (weft, warp) = (&self.columns[0][..width], &self.columns[1][..width]);
        let pixels = row.as_chunks_mut::<3>().0;
        let colour = |px: usize, layer: Layer| {
            let amount = match layer {
                Layer::Weft => weft[px].of(lines[0]),
                Layer::Warp => warp[px].of(lines[1]),
            };
            self.ramp.colour(amount)
        };
        let plain = self.tints.is_none() && self.photo.is_none();
        for (px, (pixel, shade)) in pixels.iter_mut().zip(shades).enumerate() {
            let seen = |layer| match plain {
                true => colour(px, layer),
                false => self.tinted(colour(px, layer), layer, py, px),
            };
            let colour = match shade.only() {
                Some(layer) => seen(layer),
                None => mixed(seen(Layer::Weft), seen(Layer::Warp), shade.warp()),
            };
            *pixel = display(colour, shade.value());
        }
    }

    /// A colour on the undyed cloth of a pixel, where that is not white.
    fn tinted(&self, mut colour: Rgb, layer: Layer, py: usize, px: usize) -> Rgb {
        if let Some([weft, warp]) = &self.tints {
            colour = times(
                colour,
                match layer {
                    Layer::Weft => weft[py],
                    Layer::Warp => warp[px],
                },
            );
        }
        if let Some(photo) = &self.photo {
            let at = 3 * (py * self.columns[0].len() + px);
            colour = times(colour, [0, 1, 2].map(|i| f32::from(photo[at + i]) / 255.0));
        }
        colour
    }
}

fn mixed(a: Rgb, b: Rgb, share: f32) -> Rgb {
    [0, 1, 2].map(|i| a[i] + share * (b[i] - a[i]))
}

fn times(a: Rgb, b: Rgb) -> Rgb {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

/// A shaded colour in 8 bits.
#[inline]
fn display(colour: Rgb, shade: f32) -> [u8; 3] {
    // Casting rounds down and saturates.
    colour.map(|channel| (channel * (255.0 * shade) + 0.5) as u8)
}

/// A photograph of one pixel a cell at `scale` pixels a cell, as it is seen from one side.
fn enlarged(photo: &Photo, scale: usize, side: Side) -> Vec<u8> {
    let image = &photo.rgb;
    let (width, height) = (image.width() * scale as u32, image.height() * scale as u32);
    let filter = image::imageops::FilterType::CatmullRom;
    let mut image = match scale {
        1 => image.clone(),
        _ => image::imageops::resize(image, width, height, filter),
    };
    if side == Side::Back {
        image::imageops::flip_horizontal_in_place(&mut image);
    }
    image.into_raw()
}

/// The colours of undyed yarns for every row (weft) and column (warp) of pixels.
fn tints(cloth: &Cloth, scale: usize) -> Option<[Vec<Rgb>; 2]> {
    let is_white = |yarns: &Yarns| yarns.yarns.iter().all(|yarn| yarn.colour == [1.0; 3]);
    if is_white(&cloth.weft) && is_white(&cloth.warp) {
        return None;
    }
    let lines = |yarns: &Yarns| {
        let colour = |p: usize| yarns.yarns[yarns.number(p / scale)].colour;
        (0..yarns.cells() * scale).map(colour).collect()
    };
    Some([lines(&cloth.weft), lines(&cloth.warp)])
}

/// The amount of dye that has the darkest colour: as much as the cloth holds of what is shown.
pub fn darkest_at(scenario: &Scenario) -> f64 {
    if let Some(amount) = scenario.look.darkest_at {
        return amount;
    }
    let (warp, weft) = (&scenario.cloth.warp, scenario.cloth.weft());
    let porosity = warp.porosity.max(weft.porosity);
    let fibre = (1.0 - warp.porosity).max(1.0 - weft.porosity).max(0.001);
    let kasuri = scenario.cloth.kasuri.is_there();
    match (scenario.look.show, scenario.adsorption) {
        (Show::BoundOnly, _) => fibre,
        (Show::FreeAndBound, None) if kasuri && scenario.supply.is_empty() => fibre,
        (Show::FreeAndBound, None) if kasuri => 1.0,
        (Show::FreeAndBound, None) => porosity,
        (Show::FreeAndBound, Some(_)) => 1.0,
    }
}

/// Draws the cloth of a prepared world in another way from now on. The dye is not touched.
pub fn change_look(world: &mut World, look: LookSpec) {
    let mut experiment = Experiment::clone(&world.resource::<TheExperiment>().0);
    experiment.scenario.look = look;
    let scale = world.get_resource::<Scale>().map(|scale| scale.0);
    let scale = scale.unwrap_or(experiment.scenario.look.pixels_per_cell) as usize;
    let cloth = world.resource::<Cloth>();
    let side = experiment.scenario.look.side;
    let texture = Texture::new(cloth, &experiment.scenario, &experiment.images, scale, side);
    world.insert_resource(texture);
    world.insert_resource(TheExperiment(Arc::new(experiment)));
    if world.contains_resource::<OtherSide>() {
        see_both_sides(world);
    }
}

fn prepare(
    mut commands: Commands,
    cloth: Res<Cloth>,
    experiment: Res<TheExperiment>,
    scale: Option<Res<Scale>>,
) {
    let scenario = &experiment.scenario;
    let scale = scale.map_or(scenario.look.pixels_per_cell, |scale| scale.0) as usize;
    let side = scenario.look.side;
    let texture = Texture::new(&cloth, scenario, &experiment.images, scale, side);
    commands.insert_resource(texture);
    commands.insert_resource(Picture::default());
}

fn draw(
    texture: Res<Texture>,
    cloth: Res<Cloth>,
    free: Res<FreeDye>,
    bound: Res<BoundDye>,
    mut picture: ResMut<Picture>,
    other: Option<ResMut<OtherSide>>,
) {
    texture.draw(&cloth, &free, &bound, &mut picture);
    if let Some(mut other) = other {
        let OtherSide { texture, picture } = &mut *other;
        texture.draw(&cloth, &free, &bound, picture);
    }
}
