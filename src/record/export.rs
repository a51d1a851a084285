//! The draped cloth of one moment as a file for modelling programs.

use std::io::Write;
use std::path::PathBuf;

use bevy::app::App;

use super::RecordError;
use super::write_whole;
use crate::cloth::Cloth;
use crate::memory::{self, Use};
use crate::scenario::units::MOST_STEPS;
use crate::scenario::{Draping, Experiment, LARGEST_SCALE};
use crate::schedule::advance_to;
use crate::studio::gltf::{Side, to_glb};
use crate::studio::hung::Hung;
use crate::texture::{OtherSide, Picture, Relief, Scale, see_both_sides};
use crate::{DyeingPlugins, look, prepare};

/// What to export.
#[derive(Debug, Clone, Default)]
pub struct Export {
    /// The file, `.glb`.
    pub out: PathBuf,
    /// The step of the process; left out, its end.
    pub step: Option<u64>,
    /// Pixels along one side of a cell, where not as the scenario says.
    pub scale: Option<u32>,
    /// How to drape it, where not as the scenario says.
    pub drape: Option<Draping>,
    /// Whether to replace the file if it is there.
    pub force: bool,
}

/// How far the sides lie from the middle of the cloth, m: half a cloth's thickness.
const APART: f64 = 1e-4;

/// Dyes and drapes the cloth of an experiment up to a step, and writes it as binary glTF 2.0.
///
/// `go_on` is asked now and then whether to go on.
///
/// # Errors
/// A [`RecordError`]; [`RecordError::Stopped`] where `go_on` says no.
pub fn export(
    experiment: &Experiment,
    options: &Export,
    mut go_on: impl FnMut(u64) -> bool,
) -> Result<(), RecordError> {
    let scenario = &experiment.scenario;
    let scale = options.scale.unwrap_or(scenario.look.pixels_per_cell);
    if !(1..=LARGEST_SCALE).contains(&scale) {
        return Err(RecordError::Scale(scale));
    }
    let steps = options.step.unwrap_or_else(|| scenario.process.steps());
    if steps > MOST_STEPS {
        let most = MOST_STEPS;
        return Err(RecordError::Steps { steps, most });
    }
    if options.out.is_dir() {
        return Err(RecordError::IsAFolder(options.out.clone()));
    }
    if options.out.exists() && !options.force {
        return Err(RecordError::Exists(options.out.clone()));
    }
    let fields = false;
    memory::check(scenario, Use { scale, fields })?;
    let share = steps as f64 / scenario.process.steps().max(1) as f64;
    let mut hung = Hung::new(scenario, options.drape.as_ref())?;
    if !hung.follow(share.min(1.0), |_| go_on(0))? {
        return Err(RecordError::Stopped);
    }
    let mut app = App::new();
    app.add_plugins(DyeingPlugins).insert_resource(Scale(scale));
    prepare(&mut app, experiment.clone());
    let world = app.world_mut();
    see_both_sides(world);
    if !advance_to(world, steps, &mut go_on) {
        return Err(RecordError::Stopped);
    }
    look(world);
    let cloth = world.resource::<Cloth>();
    let relief = |cloth: &Cloth| {
        let relief = Relief::new(cloth, &scenario.look.yarn, scenario.seed, scale as usize);
        (relief.width, relief.height, relief.normals())
    };
    let turned = cloth.turned_over();
    let [front, back] = match scenario.look.side {
        crate::scenario::Side::Face => [cloth, &turned],
        crate::scenario::Side::Back => [&turned, cloth],
    };
    let surface = hung.front();
    let sides = [
        Side {
            name: "front",
            surface: surface.clone().moved_out(APART),
            picture: world.resource::<Picture>(),
            normals: relief(front),
        },
        Side {
            name: "back",
            surface: surface.turned_over().moved_out(APART),
            picture: &world.resource::<OtherSide>().picture,
            normals: relief(back),
        },
    ];
    let path = options.out.clone();
    let glb = to_glb(&scenario.title, &sides).map_err(|why| RecordError::Write {
        path: path.clone(),
        why,
    })?;
    write_whole(&path, |file| file.write_all(&glb))
}
