//! Both sides of the cloth at once, for those who show both: draped cloth, hems, a hand lens.

use bevy::prelude::*;

use super::{Picture, Scale, Texture};
use crate::cloth::Cloth;
use crate::scenario::Side;
use crate::schedule::TheExperiment;

/// The side of the cloth that [`Picture`] does not show. It is drawn with it from the moment that
/// [`see_both_sides`] was called.
#[derive(Resource)]
pub struct OtherSide {
    /// What stays the same from picture to picture.
    pub texture: Texture,
    /// The side as it is seen.
    pub picture: Picture,
}

impl Side {
    /// The other one.
    pub fn other(self) -> Side {
        match self {
            Side::Face => Side::Back,
            Side::Back => Side::Face,
        }
    }
}

/// From now on every look at the cloth of a prepared world draws both of its sides.
pub fn see_both_sides(world: &mut World) {
    let experiment = world.resource::<TheExperiment>();
    let scenario = &experiment.scenario;
    let scale = world.get_resource::<Scale>().map(|scale| scale.0);
    let scale = scale.unwrap_or(scenario.look.pixels_per_cell) as usize;
    let side = scenario.look.side.other();
    let cloth = world.resource::<Cloth>();
    let texture = Texture::new(cloth, scenario, &experiment.images, scale, side);
    world.insert_resource(OtherSide {
        texture,
        picture: Picture::default(),
    });
}
