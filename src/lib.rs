//! dyelapse simulates how cloth is dyed, yarn by yarn, and records it as a time-lapse.
//!
//! # The process
//!
//! | where | what happens | what it owns |
//! |---|---|---|
//! | [`scenario`] | a RON file says what is dyed and how | [`scenario::Experiment`] |
//! | [`pattern`] | where resist and dye are | — |
//! | [`draft`] | weavers' drafts are read and written | [`draft::Draft`] |
//! | [`cloth`] | yarns are woven into two layers of cells | [`Cloth`](cloth::Cloth) |
//! | [`schedule`] | the order of the stages, the clock of the process | [`ProcessClock`](schedule::ProcessClock) |
//! | [`kasuri`] | yarns that were dyed before they were woven | — |
//! | [`supply`] | dye enters | [`Supplies`](supply::Supplies) |
//! | [`diffusion`] | dye moves | [`FreeDye`](diffusion::FreeDye), [`Conductances`](diffusion::Conductances) |
//! | [`adsorption`] | dye binds | [`BoundDye`](adsorption::BoundDye) |
//! | [`batik`] | wax and its cracks, and baths one after the other | [`Batik`](batik::stage::Batik) |
//! | [`ledger`] | dye is accounted for | [`Ledger`](ledger::Ledger) |
//! | [`texture`] | dye is seen on yarns | [`Picture`](texture::Picture) |
//! | [`session`] | a cloth is changed while it is dyed, gone back to, and saved | [`Session`](session::Session) |
//! | [`drape`] | the cloth hangs, falls, is creased | [`Drape`](drape::drape::Drape) |
//! | [`studio`] | draped cloth is seen in the light | — |
//! | [`record`] | frames are kept | the output folder |
//! | [`photo`] | photographs of cloth are read: the mask of warp and weft, the colours | [`Mask`](photo::Mask) |
//!
//! Each stage is a Bevy plugin of [`DyeingPlugins`]: its resource, its system, its place in the
//! [`schedule`]. The numerics behind a system are plain functions.
//!
//! # The smallest use
//!
//! ```
//! use dyelapse::prelude::*;
//!
//! let experiment = Experiment::load("one_drop")?;
//! let mut app = dyeing_app(experiment);
//! advance_to(app.world_mut(), 100, |_| true);
//! look(app.world_mut());
//! let ledger = app.world().resource::<Ledger>();
//! assert!(ledger.imbalance().abs() < 1e-5 * ledger.supplied);
//! # Ok::<(), ScenarioError>(())
//! ```
//!
//! Papers are cited by a letter: **D** dyeing by diffusion and adsorption (J. IIEEJ 43(3), 2014),
//! **B** batik by diffusion (2016). `docs/model.md` has the formulas and what was chosen.

pub mod adsorption;
pub mod batik;
pub mod chance;
pub mod cloth;
pub mod diffusion;
pub mod draft;
pub mod drape;
pub mod kasuri;
pub mod ledger;
pub mod memory;
pub mod pattern;
pub mod photo;
pub mod record;
pub mod scenario;
pub mod schedule;
pub mod session;
pub mod studio;
pub mod supply;
pub mod texture;
#[cfg(feature = "viewer")]
pub mod watch;

use std::sync::Arc;

use bevy::app::PluginGroupBuilder;
use bevy::prelude::*;

use scenario::Experiment;
use schedule::{DyeFrame, Prepare, TheExperiment};

/// What most programs that use this library need.
pub mod prelude {
    pub use crate::adsorption::BoundDye;
    pub use crate::cloth::{Cloth, Grid, Layer};
    pub use crate::diffusion::{Conductances, FreeDye};
    pub use crate::ledger::Ledger;
    pub use crate::scenario::{Experiment, Scenario, ScenarioError};
    pub use crate::schedule::{DyeFrame, DyeSet, DyeStep, FrameSet, ProcessClock, advance_to};
    pub use crate::texture::Picture;
    pub use crate::{DyeingPlugins, dyeing_app, look, prepare};
}

/// Every stage of dyeing.
///
/// | plugin | responsible for |
/// |---|---|
/// | [`SchedulePlugin`](schedule::SchedulePlugin) | the schedules, their sets, the clock |
/// | [`ClothPlugin`](cloth::ClothPlugin) | weaving the cloth |
/// | [`SupplyPlugin`](supply::SupplyPlugin) | dye entering |
/// | [`DiffusionPlugin`](diffusion::DiffusionPlugin) | dye moving |
/// | [`AdsorptionPlugin`](adsorption::AdsorptionPlugin) | dye binding |
/// | [`LedgerPlugin`](ledger::LedgerPlugin) | accounts of the dye |
/// | [`TexturePlugin`](texture::TexturePlugin) | pictures of the cloth |
/// | [`BatikPlugin`](batik::stage::BatikPlugin) | wax, and baths one after the other |
pub struct DyeingPlugins;

impl PluginGroup for DyeingPlugins {
    fn build(self) -> PluginGroupBuilder {
        PluginGroupBuilder::start::<Self>()
            .add(schedule::SchedulePlugin)
            .add(cloth::ClothPlugin)
            .add(supply::SupplyPlugin)
            .add(diffusion::DiffusionPlugin)
            .add(adsorption::AdsorptionPlugin)
            .add(ledger::LedgerPlugin)
            .add(texture::TexturePlugin)
            .add(batik::stage::BatikPlugin)
    }
}

/// An app that dyes the cloth of an experiment, prepared and at its first moment.
///
/// To change what is prepared, build the app yourself and call [`prepare`].
pub fn dyeing_app(experiment: Experiment) -> App {
    let mut app = App::new();
    app.add_plugins(DyeingPlugins);
    prepare(&mut app, experiment);
    app
}

/// Gives an app with [`DyeingPlugins`] its experiment, and builds the cloth and all that the stages
/// keep.
pub fn prepare(app: &mut App, experiment: Experiment) {
    app.insert_resource(TheExperiment(Arc::new(experiment)));
    app.world_mut().run_schedule(Prepare);
}

/// Brings ledger and picture up to this moment.
pub fn look(world: &mut World) {
    world.run_schedule(DyeFrame);
}
