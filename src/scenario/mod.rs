//! Scenarios: what is dyed, how, and what is recorded of it, as RON files that people can read.
//!
//! [`Scenario`] holds what a file says; [`Experiment`] is a scenario that has been read, checked
//! and given its pictures, ready to run. `docs` of the fields are the reference of the format.

mod batik;
pub(crate) mod beside;
pub mod check;
mod chemistry;
mod draping;
mod error;
mod experiment;
mod fabric;
mod figure;
mod images;
mod library;
mod locate;
mod look;
mod process;
pub mod units;
mod view;

use serde::{Deserialize, Serialize};

pub use batik::{BatikShow, BatikSolver, BatikSpec, BatikStep, MOST_BATHS, Reading};
pub use beside::Beside;
pub use chemistry::{AdsorptionSpec, Diffusivity, DyeSpec, Isotherm};
pub use draping::{Draping, unknown as unknown_drape};
pub(crate) use error::nearest;
pub use error::{ScenarioError, SourceError};
pub use experiment::{Experiment, Origin};
pub use fabric::{ClothSpec, Kasuri, KasuriSpec, Paths, YarnSpec};
pub use figure::{Figure, LARGEST_PANEL, Loaded, MOST_PANELS, Panel, Part};
pub use images::{Images, Photo, Wanted};
pub use library::{Bundled, bundled, bundled_figures, figure_names, names as bundled_names};
pub use look::{
    ColourPath, Colours, FractalLook, LARGEST_SCALE, LookSpec, Show, Side, TextureLook, YarnLook,
};
pub use process::{MOST_FRAMES, ProcessSpec, RecordSpec, Solver, SupplySpec};
pub use units::{Length, Time};
pub use view::{CameraSpec, LARGEST_VIEW, Standing, ViewSpec};

use crate::cloth::Weave;
use crate::pattern::Pattern;
use check::{Checker, Problem};

/// Everything that one dyeing is made of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// What it shows, in a few words.
    pub title: String,
    /// Seed of everything random; another number gives another cloth of the same kind.
    #[serde(default)]
    pub seed: u64,
    /// The cloth.
    pub cloth: ClothSpec,
    /// The dye in the bath.
    #[serde(default)]
    pub dye: DyeSpec,
    /// Where and when dye is given.
    pub supply: Vec<SupplySpec>,
    /// Where the cloth is tied, clamped or pasted: the volume ratio B, 0 free to 1 shut.
    #[serde(default)]
    pub resist: Pattern,
    /// Wax, dye, boil: a batik. Its baths come beside `supply`.
    #[serde(default)]
    pub batik: Option<BatikSpec>,
    /// How dye binds to fibre. Left out: it does not.
    #[serde(default)]
    pub adsorption: Option<AdsorptionSpec>,
    /// How long dyeing lasts.
    pub process: ProcessSpec,
    /// How the cloth is drawn.
    #[serde(default)]
    pub look: LookSpec,
    /// How the cloth hangs or lies: the name of a bundled drape, or a drape of its own.
    #[serde(default)]
    pub drape: Option<Draping>,
    /// How the draped cloth is seen.
    #[serde(default)]
    pub view: ViewSpec,
    /// What a recording keeps.
    #[serde(default)]
    pub record: RecordSpec,
}

impl Scenario {
    /// Checks every value against what is possible.
    ///
    /// # Errors
    /// The first [`Problem`], with its field path and what is allowed there.
    pub fn check(&self) -> Result<(), Problem> {
        let at = Checker::root();
        self.cloth.check(&at.field("cloth"))?;
        self.process.check(&at.field("process"))?;
        self.dye.check(&at.field("dye"))?;
        self.check_step(&at.field("process").field("step_h"))?;
        let (cell_mm, step_h) = (self.cloth.cell_mm, self.process.step_h);
        for (i, supply) in self.supply.iter().enumerate() {
            supply.check(&at.field("supply").item(i), cell_mm, step_h)?;
        }
        self.resist.check(&at.field("resist"), cell_mm)?;
        if let Some(adsorption) = &self.adsorption {
            adsorption.check(&at.field("adsorption"))?;
        }
        if let Some(batik) = &self.batik {
            let steps = self.process.steps();
            batik.check(&at.field("batik"), cell_mm, step_h, steps)?;
            self.check_beside_batik(batik, &at)?;
        }
        self.look.check(&at.field("look"))?;
        if let Some(drape) = &self.drape {
            drape.check(&at.field("drape"))?;
        }
        self.view.check(&at.field("view"))?;
        self.record.check(&at.field("record"), &self.process)
    }

    /// Refuses what would be ignored beside a recipe.
    fn check_beside_batik(&self, batik: &BatikSpec, at: &Checker) -> Result<(), Problem> {
        if self.cloth.kasuri.is_there() {
            return Err(at
                .field("cloth")
                .field("kasuri")
                .problem("a batik begins with undyed yarns; leave `kasuri` out".into()));
        }
        let plain = LookSpec::default();
        let look = at.field("look");
        if self.look.colours != plain.colours || self.look.path != plain.path {
            return Err(look.field("colours").problem(
                "the dyes of a recipe have colours of their own; leave `colours` and `path` out"
                    .into(),
            ));
        }
        if !batik.sweeps() {
            return Ok(());
        }
        if self.look.darkest_at.is_some() || self.look.show != plain.show {
            return Err(look.problem(
                "sweeps show all dye, full at 1 + `most_bound`; leave `show` and `darkest_at` out"
                    .into(),
            ));
        }
        if self.dye != DyeSpec::default() || self.cloth.paths != Paths::default() {
            return Err(at.field("batik").field("solver").problem(
                "sweeps take paper B's numbers, not `dye` and `paths`; leave these out, or take \
                 `solver: Diffusion`"
                    .into(),
            ));
        }
        let instead = "the baths of a recipe by `PixelDiffusing` are all its dye, and bind by \
                       themselves; leave this out, or take `solver: Diffusion`";
        if !self.supply.is_empty() {
            return Err(at.field("supply").problem(instead.into()));
        }
        if self.adsorption.is_some() {
            return Err(at.field("adsorption").problem(instead.into()));
        }
        if self.resist != Pattern::Nowhere {
            return Err(at.field("resist").problem(
                "sweeps know no resist but wax; leave this out, or take `solver: Diffusion`".into(),
            ));
        }
        Ok(())
    }

    /// Refuses a step so long that it would have to be split without end: see
    /// [`Conductances::splits`](crate::diffusion::Conductances::splits).
    fn check_step(&self, at: &Checker) -> Result<(), Problem> {
        const MOST_SPLITS: f64 = 10_000.0;
        let cell = self.cloth.cell_mm * self.cloth.cell_mm;
        // A cell has five neighbours, and no path is faster than clear water.
        let fastest = 5.0 * self.dye.diffusivity.in_water() / cell;
        if fastest * self.process.step_h <= MOST_SPLITS {
            return Ok(());
        }
        Err(at.problem(format!(
            "dye this fast in cells this small allows steps of at most {} h, but this is {} h",
            units::rounded(MOST_SPLITS / fastest, 3),
            self.process.step_h
        )))
    }

    /// Whether dye moves in the sweeps of paper B.
    pub fn sweeps(&self) -> bool {
        self.batik.as_ref().is_some_and(BatikSpec::sweeps)
    }

    /// Whether dye is taken up from a bath.
    pub fn has_baths(&self) -> bool {
        let is_bath = |supply: &SupplySpec| matches!(supply, SupplySpec::Bath { .. });
        let waxed = self.batik.as_ref().is_some_and(|batik| !batik.sweeps());
        waxed || self.supply.iter().any(is_bath)
    }

    /// Every file that the scenario names, each with its place and what is wanted of it.
    pub fn pictures(&self) -> Vec<(&str, Wanted, Checker)> {
        let mut all: Vec<_> = Vec::new();
        for (pattern, at) in self.patterns() {
            if let Pattern::Image { file, fit } = pattern {
                all.push((file.as_str(), Wanted::Brightness(*fit), at.field("file")));
            }
        }
        let root = Checker::root();
        if let Some(batik) = &self.batik {
            for (file, ground, at) in batik.drawings(&root.field("batik")) {
                all.push((file, Wanted::Drawing(ground), at));
            }
        }
        if let Weave::Mask { file } = &self.cloth.weave {
            let at = root.field("cloth").field("weave").field("file");
            all.push((file, Wanted::Mask, at));
        }
        if let Weave::Wif { file, .. } = &self.cloth.weave {
            let at = root.field("cloth").field("weave").field("file");
            all.push((file, Wanted::Draft, at));
        }
        if let TextureLook::Photo { file, fit } = &self.look.texture {
            let at = root.field("look").field("texture").field("file");
            all.push((file, Wanted::Photo(*fit), at));
        }
        all
    }

    /// Every pattern that the scenario names, each with its place.
    pub fn patterns(&self) -> Vec<(&Pattern, Checker)> {
        let at = Checker::root();
        let mut waiting: Vec<_> = vec![(&self.resist, at.field("resist"))];
        for (i, supply) in self.supply.iter().enumerate() {
            waiting.push((supply.shape(), at.field("supply").item(i).field("shape")));
        }
        if let Some(batik) = &self.batik {
            waiting.extend(batik.patterns(&at.field("batik")));
        }
        waiting.extend(
            self.cloth
                .kasuri
                .patterns(&at.field("cloth").field("kasuri")),
        );
        let mut all = Vec::new();
        while let Some((pattern, place)) = waiting.pop() {
            waiting.extend(pattern.parts(&place));
            all.push((pattern, place));
        }
        all
    }
}
