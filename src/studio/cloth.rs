//! Both sides of the cloth as a renderer has them: two meshes a hair apart, each with the picture and the
//! relief of its own yarns.

use bevy::asset::RenderAssetUsages;
use bevy::image::{ImageAddressMode, ImageFilterMode, ImageSampler, ImageSamplerDescriptor};
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bevy::render::render_resource::{
    Extent3d, Face, TextureDimension, TextureFormat, TextureUsages,
};

use super::fine::Fine;
use super::mips::{self, Kind};
use crate::cloth::Cloth;
use crate::scenario::{Scenario, Side};
use crate::texture::{Picture, Relief};

/// One side of the cloth in the studio.
#[derive(Component, Debug, Clone, Copy, PartialEq, Eq)]
pub struct ClothSide {
    /// Whether it is the back.
    pub is_back: bool,
}

/// What is changed from frame to frame.
#[derive(Resource, Debug, Clone)]
pub struct ClothAssets {
    /// The meshes of front and back.
    pub meshes: [Handle<Mesh>; 2],
    /// The pictures of front and back.
    pub pictures: [Handle<Image>; 2],
    /// The materials of front and back.
    pub materials: [Handle<StandardMaterial>; 2],
}

/// How far the sides lie from the middle of the cloth, m: half a cloth's thickness.
const APART: f64 = 2.5e-4;

/// Meshes of both sides of cloth, from its front.
pub fn shapes(front: &Fine) -> [Mesh; 2] {
    let back = front.turned_over();
    [front.clone(), back].map(|side| mesh(&side.moved_out(APART)))
}

/// A surface as a mesh.
pub fn mesh(fine: &Fine) -> Mesh {
    let three = |v: &bevy::math::DVec3| v.as_vec3().to_array();
    let positions: Vec<_> = fine.positions.iter().map(three).collect();
    let normals: Vec<_> = fine.normals.iter().map(three).collect();
    let uv: Vec<_> = fine.uv.iter().map(|uv| uv.as_vec2().to_array()).collect();
    // Up on the picture is normal × tangent: the sign of glTF's fourth number is +1.
    let tangents: Vec<_> = fine
        .tangents
        .iter()
        .map(|t| t.as_vec3().extend(1.0).to_array())
        .collect();
    let indices = fine.triangles.iter().flatten().copied().collect();
    Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
    .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
    .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uv)
    .with_inserted_attribute(Mesh::ATTRIBUTE_TANGENT, tangents)
    .with_inserted_indices(Indices::U32(indices))
}

fn sampler(anisotropy: u16) -> ImageSampler {
    ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: ImageAddressMode::ClampToEdge,
        address_mode_v: ImageAddressMode::ClampToEdge,
        mag_filter: ImageFilterMode::Linear,
        min_filter: ImageFilterMode::Linear,
        mipmap_filter: ImageFilterMode::Linear,
        anisotropy_clamp: anisotropy,
        ..default()
    })
}

/// RGB bytes as an image for the renderer, with all its halves.
pub fn image(rgb: &[u8], width: usize, height: usize, kind: Kind) -> Image {
    let levels = mips::chain(rgb, width, height, kind);
    image_of_levels(levels, (width, height), kind, FINE)
}

/// How finely cloth that is seen at a slant is sampled in recordings, and in the window with a driver
/// that draws on a graphics card.
pub const FINE: u16 = 8;

/// A picture and its halves ([`mips::chain`]) as an image for the renderer, with so many samples where it
/// is seen at a slant.
pub fn image_of_levels(
    levels: Vec<u8>,
    (width, height): (usize, usize),
    kind: Kind,
    anisotropy: u16,
) -> Image {
    let format = match kind {
        Kind::Colour => TextureFormat::Rgba8UnormSrgb,
        Kind::Normal => TextureFormat::Rgba8Unorm,
    };
    let mut image = Image::new_uninit(
        Extent3d {
            width: width as u32,
            height: height as u32,
            depth_or_array_layers: 1,
        },
        TextureDimension::D2,
        format,
        RenderAssetUsages::default(),
    );
    image.texture_descriptor.mip_level_count = mips::levels(width, height);
    image.data = Some(levels);
    image.sampler = sampler(anisotropy);
    // Bevy writes only the first level into a texture that it can copy to; this one it makes anew.
    image.texture_descriptor.usage = TextureUsages::TEXTURE_BINDING;
    image
}

/// A picture of the cloth as an image.
pub fn picture_image(picture: &Picture) -> Image {
    image(&picture.rgb, picture.width, picture.height, Kind::Colour)
}

/// The normal map of a side of the cloth, at `scale` pixels a cell.
fn normal_map(cloth: &Cloth, scenario: &Scenario, side: Side, scale: usize) -> Image {
    let turned;
    let seen = match side {
        Side::Face => cloth,
        Side::Back => {
            turned = cloth.turned_over();
            &turned
        }
    };
    let relief = Relief::new(seen, &scenario.look.yarn, scenario.seed, scale);
    image(&relief.normals(), relief.width, relief.height, Kind::Normal)
}

/// Hangs the cloth in the studio. `pictures` are of front and back.
pub fn spawn(
    world: &mut World,
    shapes: [Mesh; 2],
    pictures: [&Picture; 2],
    scenario: &Scenario,
    cloth: &Cloth,
) {
    let scale = pictures[0].width / cloth.grid.nx.max(1);
    let side = scenario.look.side;
    let normals = [side, side.other()].map(|side| normal_map(cloth, scenario, side, scale.max(1)));
    hang(world, shapes, pictures.map(picture_image), normals);
}

/// Hangs cloth of a shape in the studio; `pictures` and `reliefs` are of front and back.
pub fn hang(world: &mut World, shapes: [Mesh; 2], pictures: [Image; 2], reliefs: [Image; 2]) {
    let mut images = world.resource_mut::<Assets<Image>>();
    let normals = reliefs.map(|map| images.add(map));
    let pictures = pictures.map(|picture| images.add(picture));
    let material = |i: usize| StandardMaterial {
        base_color_texture: Some(pictures[i].clone()),
        normal_map_texture: Some(normals[i].clone()),
        perceptual_roughness: 0.92,
        reflectance: 0.25,
        cull_mode: Some(Face::Back),
        ..default()
    };
    let materials = [material(0), material(1)];
    let mut all = world.resource_mut::<Assets<StandardMaterial>>();
    let materials = materials.map(|material| all.add(material));
    let mut all = world.resource_mut::<Assets<Mesh>>();
    let meshes = shapes.map(|mesh| all.add(mesh));
    for i in 0..2 {
        world.spawn((
            ClothSide { is_back: i == 1 },
            Mesh3d(meshes[i].clone()),
            MeshMaterial3d(materials[i].clone()),
            bevy::camera::visibility::NoFrustumCulling,
        ));
    }
    world.insert_resource(ClothAssets {
        meshes,
        pictures,
        materials,
    });
}

/// Shows the cloth in another shape.
pub fn move_to(world: &mut World, shapes: [Mesh; 2]) {
    let assets = world.resource::<ClothAssets>().clone();
    let mut meshes = world.resource_mut::<Assets<Mesh>>();
    for (handle, shape) in assets.meshes.iter().zip(shapes) {
        // A handle that is held is there.
        let _ = meshes.insert(handle, shape);
    }
}

/// Shows the cloth in other colours.
pub fn paint(world: &mut World, pictures: [&Picture; 2]) {
    repaint(world, pictures.map(picture_image));
}

/// Shows the cloth with other pictures of front and back.
pub fn repaint(world: &mut World, pictures: [Image; 2]) {
    let assets = world.resource::<ClothAssets>().clone();
    let mut images = world.resource_mut::<Assets<Image>>();
    for (handle, picture) in assets.pictures.iter().zip(pictures) {
        let _ = images.insert(handle, picture);
    }
    // A material binds the texture that the image had when it was last changed.
    let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
    for (handle, picture) in assets.materials.iter().zip(&assets.pictures) {
        if let Some(mut material) = materials.get_mut(handle) {
            material.base_color_texture = Some(picture.clone());
        }
    }
}

/// Gives the cloth other reliefs of front and back.
pub fn emboss(world: &mut World, reliefs: [Image; 2]) {
    let assets = world.resource::<ClothAssets>().clone();
    let mut images = world.resource_mut::<Assets<Image>>();
    let reliefs = reliefs.map(|relief| images.add(relief));
    let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
    for (handle, relief) in assets.materials.iter().zip(reliefs) {
        if let Some(mut material) = materials.get_mut(handle) {
            material.normal_map_texture = Some(relief);
        }
    }
}
