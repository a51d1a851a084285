//! The studio's light and ground: a large soft lamp, light from all around, and a floor that turns into
//! a wall without an edge.
//!
//! A lamp that has a size is several that have none, side by side: their shadows overlap into one with a
//! soft edge. White cloth that faces the lamp comes out nearly white, without any tone mapping: a dye has
//! the colour here that it has on the flat cloth.

use std::f64::consts::TAU;

use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::light::{
    CascadeShadowConfigBuilder, DirectionalLightShadowMap, EnvironmentMapLight, NotShadowCaster,
    ShadowFilteringMethod,
};
use bevy::math::{DVec2, DVec3};
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bevy::render::renderer::RenderAdapterInfo;

use super::camera::Subject;
use crate::scenario::ViewSpec;
use crate::texture::to_rgb;

/// Light of the lamp on cloth that faces it, lux; with Bevy's usual exposure.
const LAMP: f32 = 2_100.0;

/// Light from above, cd/m².
const SKY: f32 = 370.0;

/// How far the parts of the lamp are from its middle, degrees.
const LAMP_SIZE: f64 = 4.0;

/// How fine shadows are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quality {
    /// For recordings: a lamp of several parts.
    Fine,
    /// For the window: one lamp.
    Fast,
    /// For the window where the processor draws: besides, edges are not smoothed, and shadows hardly.
    Software,
}

impl Quality {
    /// What the window can have with the driver of a world.
    pub fn for_window(world: &World) -> Self {
        let info = world.get_resource::<RenderAdapterInfo>();
        match info.is_some_and(|info| info.device_type == wgpu::DeviceType::Cpu) {
            true => Quality::Software,
            false => Quality::Fast,
        }
    }
}

/// The lamp and its parts.
#[derive(Component, Debug, Clone, Copy)]
pub struct Lamp;

/// The ground.
#[derive(Component, Debug, Clone, Copy)]
pub struct Ground;

/// Lights the studio for a subject.
pub fn spawn(world: &mut World, view: &ViewSpec, subject: &Subject, quality: Quality) {
    let (parts, size) = match quality {
        Quality::Fine => (9, 2048),
        Quality::Fast => (1, 2048),
        Quality::Software => (1, 1024),
    };
    world.insert_resource(DirectionalLightShadowMap { size });
    // As far as a camera stands that sees the whole subject, and a little more: a shadow map that covers
    // more is coarser.
    let narrow = 1.0 / libm::tan(0.5 * view.field_of_view.to_radians());
    let far = (subject.radius * (2.5 * narrow + 6.0)) as f32;
    for way in lamp_ways(view.light, parts) {
        world.spawn((
            Lamp,
            DirectionalLight {
                illuminance: LAMP / parts as f32,
                color: Color::linear_rgb(1.0, 0.985, 0.96),
                shadow_maps_enabled: true,
                shadow_depth_bias: 0.01,
                shadow_normal_bias: 1.2,
                ..default()
            },
            CascadeShadowConfigBuilder {
                num_cascades: 1,
                minimum_distance: 0.01 * subject.radius as f32,
                maximum_distance: far,
                first_cascade_far_bound: far,
                ..default()
            }
            .build(),
            Transform::IDENTITY.looking_to(-way.as_vec3(), Vec3::Y),
        ));
    }
    ground(world, view, subject);
}

/// The ways to the parts of a lamp, evenly spread over its round face as seeds in a sunflower (Vogel 1979).
pub fn lamp_ways((turn, elevation): (f64, f64), parts: usize) -> Vec<DVec3> {
    let (turn, elevation) = (turn.to_radians(), elevation.to_radians());
    let way = DVec3::new(
        libm::sin(turn) * libm::cos(elevation),
        libm::sin(elevation),
        libm::cos(turn) * libm::cos(elevation),
    );
    let (side, up) = way.any_orthonormal_pair();
    let size = libm::tan(LAMP_SIZE.to_radians());
    let part = |i: usize| {
        let turn = i as f64 * GOLDEN_ANGLE;
        let reach = size * ((i as f64 + 0.5) / parts as f64).sqrt();
        let off = libm::cos(turn) * side + libm::sin(turn) * up;
        (way + reach * off).normalize()
    };
    match parts {
        1 => vec![way],
        _ => (0..parts).map(part).collect(),
    }
}

/// π·(3 − √5).
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// What a camera in the studio needs beside its place.
pub fn camera(world: &mut World, view: &ViewSpec, quality: Quality) -> impl Bundle + use<> {
    let mut images = world.resource_mut::<Assets<Image>>();
    let grey = |v: f32| Color::linear_rgb(v, v, v);
    let mut sky = EnvironmentMapLight::hemispherical_gradient(
        &mut images,
        Color::linear_rgb(0.97, 0.99, 1.0),
        grey(0.72),
        Color::linear_rgb(0.40, 0.385, 0.37),
    );
    sky.intensity = SKY;
    let wall = ground_colour(view);
    (
        Camera3d::default(),
        Projection::Perspective(PerspectiveProjection {
            fov: view.field_of_view.to_radians() as f32,
            near: 0.01,
            far: 1000.0,
            ..default()
        }),
        Camera {
            clear_color: ClearColorConfig::Custom(wall),
            ..default()
        },
        Tonemapping::None,
        match quality {
            Quality::Fine | Quality::Fast => Msaa::Sample4,
            Quality::Software => Msaa::Off,
        },
        match quality {
            Quality::Fine => ShadowFilteringMethod::Hardware2x2,
            Quality::Fast => ShadowFilteringMethod::Gaussian,
            Quality::Software => ShadowFilteringMethod::Hardware2x2,
        },
        sky,
    )
}

/// The colour of the ground, and of what is beyond it.
pub fn ground_colour(view: &ViewSpec) -> Color {
    let [r, g, b] = to_rgb(view.ground);
    Color::srgb(r, g, b)
}

/// Where the ground is, m.
#[derive(Resource, Debug, Clone, Copy)]
pub struct FloorHeight(pub f64);

fn ground(world: &mut World, view: &ViewSpec, subject: &Subject) {
    let height = world
        .get_resource::<FloorHeight>()
        .map_or(0.0, |floor| floor.0);
    let bowl = bowl(
        DVec2::new(subject.centre.x, subject.centre.z),
        height,
        subject.radius,
    );
    let mesh = world.resource_mut::<Assets<Mesh>>().add(bowl);
    let material = world
        .resource_mut::<Assets<StandardMaterial>>()
        .add(StandardMaterial {
            base_color: ground_colour(view),
            perceptual_roughness: 1.0,
            reflectance: 0.1,
            ..default()
        });
    world.spawn((
        Ground,
        Mesh3d(mesh),
        MeshMaterial3d(material),
        NotShadowCaster,
    ));
}

/// A floor that rises into a wall all around.
fn bowl(middle: DVec2, height: f64, radius: f64) -> Mesh {
    const AROUND: usize = 96;
    const UP: usize = 24;
    let (flat, bend) = (9.0 * radius, 7.0 * radius);
    // From the middle over the floor, around the bend and up the wall: (radius, height, normal in, up).
    let mut profile = vec![(0.0, 0.0, 0.0, 1.0), (flat, 0.0, 0.0, 1.0)];
    for i in 1..=UP {
        let turn = 0.25 * TAU * i as f64 / UP as f64;
        let (sin, cos) = (libm::sin(turn), libm::cos(turn));
        profile.push((flat + bend * sin, bend * (1.0 - cos), sin, cos));
    }
    profile.push((flat + bend, 30.0 * radius, 1.0, 0.0));
    let (mut positions, mut normals, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for (r, y, inwards, up) in &profile {
        for i in 0..=AROUND {
            let turn = TAU * i as f64 / AROUND as f64;
            let (sin, cos) = (libm::sin(turn), libm::cos(turn));
            let place = DVec3::new(middle.x + r * sin, height + y, middle.y + r * cos);
            positions.push(place.as_vec3().to_array());
            normals.push([-(inwards * sin) as f32, *up as f32, -(inwards * cos) as f32]);
        }
    }
    let row = AROUND as u32 + 1;
    for j in 0..profile.len() as u32 - 1 {
        for i in 0..AROUND as u32 {
            let a = j * row + i;
            indices.extend([a, a + row, a + 1, a + 1, a + row, a + row + 1]);
        }
    }
    Mesh::new(
        PrimitiveTopology::TriangleList,
        bevy::asset::RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
    .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
    .with_inserted_indices(Indices::U32(indices))
}
