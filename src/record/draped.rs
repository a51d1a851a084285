//! Frames of the draped cloth: the studio drawn without a window.

use bevy::prelude::*;

use super::RecordError;
use crate::cloth::Cloth;
use crate::scenario::{Draping, Experiment, ViewSpec};
use crate::studio::camera::Way;
use crate::studio::hung::Hung;
use crate::studio::light::{self, Quality};
use crate::studio::offscreen::{self, NoFrame, Offscreen, most_pixels};
use crate::studio::things::Furniture;
use crate::studio::{cloth, things};
use crate::texture::{OtherSide, Picture, see_both_sides};

/// The studio of a recording.
pub struct Draped {
    hung: Hung,
    offscreen: Offscreen,
    way: Way,
}

impl Draped {
    /// Whether this machine can draw it.
    ///
    /// # Errors
    /// A [`RecordError`] that says what is missing.
    pub fn check() -> Result<(), RecordError> {
        Ok(offscreen::check_driver()?)
    }

    /// Makes an app able to draw.
    ///
    /// # Errors
    /// A [`RecordError`] that says what is missing.
    pub fn add_plugins(app: &mut App) -> Result<(), RecordError> {
        Ok(offscreen::add_plugins(app)?)
    }

    /// Lets the cloth settle and sets the studio up in a prepared app that can draw.
    ///
    /// # Errors
    /// A [`RecordError`]; [`RecordError::Stopped`] where `go_on` says no.
    pub fn start(
        app: &mut App,
        experiment: &Experiment,
        view: ViewSpec,
        instead: Option<&Draping>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Self, RecordError> {
        let scenario = &experiment.scenario;
        let mut hung = Hung::new(scenario, instead)?;
        hung.view = view;
        if !hung.follow(0.0, |_| go_on())? {
            return Err(RecordError::Stopped);
        }
        let subject = hung.subject();
        see_both_sides(app.world_mut());
        crate::look(app.world_mut());
        let world = app.world_mut();
        let picture = world.resource::<Picture>();
        let (pixels, most) = (picture.width.max(picture.height), most_pixels(world));
        if pixels > most {
            return Err(NoFrame::TooLarge { pixels, most }.into());
        }
        things::spawn(world, &Furniture::of(&hung.spec, &hung.drape));
        let way = Way::new(&hung.view, &subject);
        light::spawn(world, &hung.view, &subject, Quality::Fine);
        let bundle = light::camera(world, &hung.view, Quality::Fine);
        let offscreen = Offscreen::new(world, hung.view.pixels, bundle);
        let shapes = cloth::shapes(&hung.front());
        world.resource_scope(|world, picture: Mut<Picture>| {
            world.resource_scope(|world, other: Mut<OtherSide>| {
                world.resource_scope(|world, woven: Mut<Cloth>| {
                    let pictures = [&*picture, &other.picture];
                    cloth::spawn(world, shapes, pictures, scenario, &woven);
                });
            });
        });
        let draped = Draped {
            hung,
            offscreen,
            way,
        };
        draped.stand(app.world_mut(), 0.0);
        draped.offscreen.warm_up(app)?;
        Ok(draped)
    }

    /// The frame when a share (0 to 1) of the process is done, with the cloth as it was last looked at.
    ///
    /// # Errors
    /// A [`RecordError`]; [`RecordError::Stopped`] where `go_on` says no.
    pub fn see(
        &mut self,
        app: &mut App,
        share: f64,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Picture, RecordError> {
        let before = self.hung.drape.time;
        if !self.hung.follow(share, |_| go_on())? {
            return Err(RecordError::Stopped);
        }
        let world = app.world_mut();
        if self.hung.drape.time > before {
            cloth::move_to(world, cloth::shapes(&self.hung.front()));
        }
        world.resource_scope(|world, picture: Mut<Picture>| {
            world.resource_scope(|world, other: Mut<OtherSide>| {
                cloth::paint(world, [&*picture, &other.picture]);
            });
        });
        self.stand(world, share);
        Ok(self.offscreen.frame(app)?)
    }

    fn stand(&self, world: &mut World, share: f64) {
        self.offscreen.stand(world, self.way.at(share));
    }
}
