//! The cloth: two layers of yarns, woven, with pores for dye to move in and fibre for it to bind to.
//!
//! Paper D §4.1 and eqs 6, 9; model sections 1 and 2. The cloth does not change while it is dyed.
//! Its yarns are few and its cells many, so what belongs to a yarn is looked up by column or row;
//! of what differs from cell to cell only the resist is stored.

mod grid;
mod mask;
mod weave;
mod yarns;

use std::ops::Deref;

use bevy::prelude::*;
use rayon::prelude::*;

pub use grid::{Grid, Layer};
pub use mask::Mask;
pub use weave::{Face, LARGEST_REPEAT, Measures, Weave, WeaveMatrix};
pub use yarns::{Span, Thread, Yarn, Yarns};

use crate::chance::{Chance, Purpose};
use crate::draft::{self, Draft};
use crate::pattern::{Canvas, Raster};
use crate::scenario::{ClothSpec, Images, YarnSpec};
use crate::schedule::{Prepare, PrepareSet, TheExperiment};
use yarns::Draws;

/// The cloth, woven once.
pub struct ClothPlugin;

impl Plugin for ClothPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Prepare, prepare.in_set(PrepareSet::Cloth));
    }
}

fn prepare(mut commands: Commands, experiment: Res<TheExperiment>) {
    let scenario = &experiment.scenario;
    let resist = Canvas::of(&experiment).draw(&scenario.resist);
    let chance = Chance(scenario.seed);
    let cloth = Cloth::weave(&scenario.cloth, &experiment.images, resist, chance);
    commands.insert_resource(cloth);
}

/// A woven cloth, ready to be dyed.
#[derive(Resource, Debug, Clone)]
pub struct Cloth {
    /// Its size in cells.
    pub grid: Grid,
    /// What it is woven of.
    pub parts: Parts,
    /// What lies along every row of the weft layer and every column of the warp layer.
    lines: [Vec<Line>; 2],
}

/// What a row of the weft layer, or a column of the warp layer, has in common.
#[derive(Debug, Clone, Copy)]
struct Line {
    /// P, of what its own yarn does not squeeze.
    open: f64,
    /// V_d.
    fibre: f32,
}

/// What a cloth is woven of.
#[derive(Debug, Clone)]
pub struct Parts {
    /// Side of a cell Δd, mm.
    pub cell_mm: f64,
    /// The yarns that run down, in the warp layer.
    pub warp: Yarns,
    /// The yarns that run across, in the weft layer.
    pub weft: Yarns,
    /// Which yarn is on top at every crossing.
    pub weave: WeaveMatrix,
    /// Where the warp is on top cell by cell, if a photograph says so rather than the weave.
    pub mask: Option<Mask>,
    /// Porosity of the gaps in the weft layer and in the warp layer.
    pub gap_porosity: [f64; 2],
    /// How far every place is squeezed: the volume ratio B of paper D eq 9, for both layers.
    pub resist: Raster,
}

impl Deref for Cloth {
    type Target = Parts;

    fn deref(&self) -> &Parts {
        &self.parts
    }
}

/// A cell with less room than this holds no liquid at all: its inverse must still be a number.
const SHUT: f64 = 1e-9;

impl Cloth {
    /// Weaves the cloth of a scenario, whose files are in `images`, and ties `resist` around it.
    pub fn weave(spec: &ClothSpec, images: &Images, resist: Raster, chance: Chance) -> Self {
        let (nx, ny) = spec.cells();
        let warp_draws = Draws {
            porosity: Purpose::WarpPorosity,
            twist: Purpose::WarpTwist,
            squeeze: Purpose::WarpSqueeze,
            width: Purpose::WarpWidth,
        };
        let weft_draws = Draws {
            porosity: Purpose::WeftPorosity,
            twist: Purpose::WeftTwist,
            squeeze: Purpose::WeftSqueeze,
            width: Purpose::WeftWidth,
        };
        let nominal = |porosity: f64| spec.gap_porosity.unwrap_or(porosity);
        let draft = match &spec.weave {
            Weave::Wif { file, measures } => images.draft(file).map(|draft| (draft, *measures)),
            _ => None,
        };
        let threads = |threads: fn(&Draft) -> &[draft::Thread], yarn: &YarnSpec| {
            draft.map_or(Vec::new(), |(draft, measures)| {
                let thread = |thread| Thread::of(thread, yarn, measures, spec.cell_mm);
                threads(draft).iter().map(thread).collect()
            })
        };
        let (ends, picks) = (
            threads(Draft::warp, &spec.warp),
            threads(Draft::weft, spec.weft()),
        );
        let warp = Yarns::spun(&spec.warp, spec.cell_mm, nx, chance, warp_draws, &ends);
        let weft = Yarns::spun(spec.weft(), spec.cell_mm, ny, chance, weft_draws, &picks);
        let mask = match &spec.weave {
            Weave::Mask { file } => images.mask(file).cloned(),
            _ => None,
        };
        let seen = mask.as_ref().map(|mask| mask.weave(&warp, &weft));
        let seen = seen.or_else(|| draft.map(|(draft, _)| draft.drawdown()));
        Cloth::assemble(Parts {
            cell_mm: spec.cell_mm,
            weave: seen.unwrap_or_else(|| spec.weave.matrix()),
            warp,
            weft,
            mask,
            gap_porosity: [nominal(spec.weft().porosity), nominal(spec.warp.porosity)],
            resist,
        })
    }

    /// Assembles a cloth of yarns that are already laid; the resist gives its size.
    pub fn assemble(parts: Parts) -> Self {
        let mut cloth = Cloth {
            grid: Grid {
                nx: parts.resist.nx,
                ny: parts.resist.ny,
            },
            parts,
            lines: [Vec::new(), Vec::new()],
        };
        let line = |layer: Layer, yarn: Option<&Yarn>| Line {
            open: match yarn {
                Some(yarn) => yarn.porosity * (1.0 - yarn.squeeze),
                None => cloth.gap_porosity[layer as usize],
            },
            fibre: yarn.map_or(0.0, |yarn| 1.0 - yarn.porosity) as f32,
        };
        let weft = (0..cloth.grid.ny).map(|y| line(Layer::Weft, cloth.weft.at(y)));
        let warp = (0..cloth.grid.nx).map(|x| line(Layer::Warp, cloth.warp.at(x)));
        cloth.lines = [weft.collect(), warp.collect()];
        cloth
    }

    /// The same cloth seen from its back: left and right are exchanged, and the yarns that lay beneath
    /// are on top.
    pub fn turned_over(&self) -> Self {
        let (ends, picks) = (self.warp.yarns.len(), self.weft.yarns.len());
        let up = |i: usize| !self.weave.warp_up(ends - 1 - i % ends, i / ends);
        Cloth::assemble(Parts {
            warp: self.warp.mirrored(),
            weave: WeaveMatrix::new(ends, (0..ends * picks).map(up).collect()),
            mask: self.mask.as_ref().map(Mask::turned_over),
            resist: self.resist.mirrored(),
            ..self.parts.clone()
        })
    }

    fn line(&self, layer: Layer, y: usize, x: usize) -> Line {
        let across = match layer {
            Layer::Weft => y,
            Layer::Warp => x,
        };
        self.lines[layer as usize][across]
    }

    /// V_u = P·V_max·(1−B) of a cell, the most free dye that it holds, with V_max = 1 (eq 9).
    pub fn capacity_free(&self, layer: Layer, y: usize, x: usize) -> f32 {
        let left = 1.0 - f64::from(self.resist.at(y, x));
        let capacity = self.line(layer, y, x).open * left;
        if capacity < SHUT {
            0.0
        } else {
            capacity as f32
        }
    }

    /// V_d = (1−P)·V_max of a cell, the most dye that its fibre binds; 0 in gaps (eq 6).
    pub fn capacity_bound(&self, layer: Layer, y: usize, x: usize) -> f32 {
        self.line(layer, y, x).fibre
    }

    /// The yarn in a cell; none in a gap.
    pub fn yarn(&self, layer: Layer, y: usize, x: usize) -> Option<&Yarn> {
        match layer {
            Layer::Weft => self.weft.at(y),
            Layer::Warp => self.warp.at(x),
        }
    }

    /// Whether a cell is fibre rather than gap.
    pub fn fibre(&self, layer: Layer, y: usize, x: usize) -> bool {
        self.yarn(layer, y, x).is_some()
    }

    /// Whether the warp is on top in the cloth cell that a position lies in, or where a mask says so.
    pub fn warp_up(&self, y: usize, x: usize) -> bool {
        match &self.mask {
            Some(mask) => mask.warp_up(y, x),
            None => self.weave.warp_up(self.warp.number(x), self.weft.number(y)),
        }
    }

    /// P of a cell, 0 to 1.
    pub fn porosity(&self, layer: Layer, y: usize, x: usize) -> f64 {
        match self.yarn(layer, y, x) {
            Some(yarn) => yarn.porosity,
            None => self.gap_porosity[layer as usize],
        }
    }

    /// B of a cell, 0 to 1: what the resist leaves of it, squeezed again by its own yarn.
    pub fn volume_ratio(&self, layer: Layer, y: usize, x: usize) -> f64 {
        let squeeze = self.yarn(layer, y, x).map_or(0.0, |yarn| yarn.squeeze);
        1.0 - (1.0 - f64::from(self.resist.at(y, x))) * (1.0 - squeeze)
    }

    /// A field over all cells from a rule for one.
    pub fn field(&self, rule: impl Fn(Layer, usize, usize) -> f64 + Sync) -> Vec<f32> {
        let Grid { nx, ny } = self.grid;
        let mut field = vec![0.0; self.grid.len()];
        field
            .par_chunks_mut(nx.max(1))
            .enumerate()
            .for_each(|(row, cells)| {
                let layer = Layer::BOTH[row / ny];
                for (x, cell) in cells.iter_mut().enumerate() {
                    *cell = rule(layer, row % ny, x) as f32;
                }
            });
        field
    }
}
