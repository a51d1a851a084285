//! What the cloth falls on, and what it hangs from, as they are seen.

use bevy::math::DVec3;
use bevy::mesh::PrimitiveTopology;
use bevy::prelude::*;

use super::light::FloorHeight;
use crate::drape::collide::mesh::Mesh as Solid;
use crate::drape::drape::Drape;
use crate::drape::spec::{ColliderSpec, DrapeSpec, Hold, Start};

/// A thing in the studio.
#[derive(Component, Debug, Clone, Copy)]
pub struct Thing;

/// Colours of things: light wood, matt paint, metal.
const WOOD: Color = Color::srgb(0.60, 0.46, 0.33);
const PAINT: Color = Color::srgb(0.78, 0.76, 0.72);

/// How far below the surface of a ball its picture lies, m: cloth lies on it without showing through.
const BELOW: f64 = 5e-4;

/// The height of the ground: the floor that a drape names, or 0, or just below the cloth.
fn floor_height(spec: &DrapeSpec, drape: &Drape) -> f64 {
    let named = spec.on.iter().filter_map(|thing| match thing {
        ColliderSpec::Floor { height_m } => Some(*height_m),
        _ => None,
    });
    let heights = drape.positions().iter().map(|place| place.y);
    let lowest = heights.fold(0.0, f64::min);
    named.reduce(f64::max).unwrap_or(lowest)
}

/// Puts everything there that a drape names.
pub fn spawn(world: &mut World, spec: &DrapeSpec, drape: &Drape) {
    let floor = floor_height(spec, drape);
    world.insert_resource(FloorHeight(floor));
    let solid = &drape.colliders().mesh;
    if !solid.triangles.is_empty() {
        put(world, faceted(solid), WOOD, Transform::IDENTITY);
    }
    for thing in &spec.on {
        match thing {
            ColliderSpec::Ball { centre_m, radius_m } => {
                ball(world, *centre_m, *radius_m, floor);
            }
            ColliderSpec::RoundTable {
                centre_m,
                radius_m,
                thickness_m,
                ..
            } => {
                let top = place(*centre_m) - Vec3::Y * *thickness_m as f32;
                stand(world, top, floor, 0.035, 0.45 * *radius_m as f32);
            }
            ColliderSpec::SquareTable {
                centre_m,
                size_m,
                thickness_m,
                ..
            } => {
                let top = place(*centre_m) - Vec3::Y * *thickness_m as f32;
                legs(world, top, floor, *size_m);
            }
            ColliderSpec::Floor { .. } | ColliderSpec::Mesh { .. } => {}
        }
    }
    match spec.start {
        Start::Hanging { .. } => pegs(world, spec, drape),
        Start::Sphere { centre_m, radius_m } => ball(world, centre_m, radius_m, floor),
        Start::Flat { .. } => {}
    }
}

fn place((x, y, z): (f64, f64, f64)) -> Vec3 {
    Vec3::new(x as f32, y as f32, z as f32)
}

fn put(world: &mut World, mesh: impl Into<Mesh>, colour: Color, at: Transform) {
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh.into());
    let material = world
        .resource_mut::<Assets<StandardMaterial>>()
        .add(StandardMaterial {
            base_color: colour,
            perceptual_roughness: 0.75,
            reflectance: 0.3,
            ..default()
        });
    world.spawn((Thing, Mesh3d(mesh), MeshMaterial3d(material), at));
}

/// A ball on a foot.
fn ball(world: &mut World, centre: (f64, f64, f64), radius: f64, floor: f64) {
    let mesh = Sphere::new((radius - BELOW) as f32).mesh().uv(96, 48);
    let at = Transform::from_translation(place(centre));
    put(world, mesh, PAINT, at);
    let radius = radius as f32;
    stand(world, place(centre), floor, 0.2 * radius, 0.5 * radius);
}

/// A round foot from what it carries down to the floor.
fn stand(world: &mut World, top: Vec3, floor: f64, radius: f32, foot: f32) {
    let height = top.y - floor as f32;
    if height <= 0.02 {
        return;
    }
    let middle = Vec3::new(top.x, top.y - 0.5 * height, top.z);
    put(
        world,
        Cylinder::new(radius, height),
        WOOD,
        Transform::from_translation(middle),
    );
    let base = Vec3::new(top.x, floor as f32 + 0.0125, top.z);
    put(
        world,
        Cylinder::new(foot, 0.025),
        WOOD,
        Transform::from_translation(base),
    );
}

/// Four legs.
fn legs(world: &mut World, top: Vec3, floor: f64, (width, depth): (f64, f64)) {
    let height = top.y - floor as f32;
    if height <= 0.02 {
        return;
    }
    let side = (0.05 * width.min(depth)).clamp(0.01, 0.06) as f32;
    let (x, z) = (
        0.5 * width as f32 - 1.5 * side,
        0.5 * depth as f32 - 1.5 * side,
    );
    for (x, z) in [(x, z), (-x, z), (x, -z), (-x, -z)] {
        let middle = Vec3::new(top.x + x, top.y - 0.5 * height, top.z + z);
        put(
            world,
            Cuboid::new(side, height, side),
            WOOD,
            Transform::from_translation(middle),
        );
    }
}

/// A line and pegs, where points of hanging cloth are held.
fn pegs(world: &mut World, spec: &DrapeSpec, drape: &Drape) {
    let held: Vec<Vec3> = spec
        .pins
        .iter()
        .zip(&drape.pins)
        .filter(|(pin, _)| matches!(pin.at, Hold::Point(..)))
        .filter_map(|(_, pin)| {
            let all = pin.particles.iter().map(|i| drape.positions()[*i]);
            let count = pin.particles.len() as f64;
            (count > 0.0).then(|| (all.sum::<DVec3>() / count).as_vec3())
        })
        .collect();
    let (Some(first), Some(last)) = (held.first(), held.last()) else {
        return;
    };
    for peg in &held {
        let at = Transform::from_translation(*peg + Vec3::Y * 0.012);
        put(world, Cuboid::new(0.011, 0.055, 0.014), WOOD, at);
    }
    let along = *last - *first;
    if held.len() < 2 || along.length() < 1e-3 {
        return;
    }
    let middle = 0.5 * (*first + *last) + Vec3::Y * 0.016;
    let turned = Quat::from_rotation_arc(Vec3::Y, along.normalize());
    let line = Cylinder::new(0.0022, along.length() * 6.0);
    put(
        world,
        line,
        PAINT,
        Transform::from_translation(middle).with_rotation(turned),
    );
}

/// Faces that meet at a smaller angle than this (as its cosine) look as one round face.
const ROUND: f32 = 0.8;

/// A solid whose faces are flat where they meet at an edge, and round where they nearly lie in a plane.
fn faceted(solid: &Solid) -> Mesh {
    let corner = |i: &u32| solid.corners[*i as usize].as_vec3();
    let faces: Vec<Vec3> = solid
        .triangles
        .iter()
        .map(|[a, b, c]| (corner(b) - corner(a)).cross(corner(c) - corner(a)))
        .collect();
    let mut around = vec![Vec::new(); solid.corners.len()];
    for (face, corners) in solid.triangles.iter().enumerate() {
        for i in corners {
            around[*i as usize].push(face);
        }
    }
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    for (face, corners) in solid.triangles.iter().enumerate() {
        let own = faces[face].normalize_or_zero();
        for i in corners {
            let near = around[*i as usize].iter().map(|other| faces[*other]);
            let near = near.filter(|other| other.normalize_or_zero().dot(own) > ROUND);
            normals.push(near.sum::<Vec3>().normalize_or(own).to_array());
            positions.push(corner(i).to_array());
        }
    }
    Mesh::new(
        PrimitiveTopology::TriangleList,
        bevy::asset::RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
    .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
}
