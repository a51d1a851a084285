//! The draped cloth as glTF 2.0 (ISO/IEC 12113), one binary file that Blender and other modelling
//! programs open: both sides with their pictures, relief and normals; metres, y up.

use std::borrow::Cow;
use std::collections::BTreeMap;

use gltf::binary::{Glb, Header};
use gltf::json::accessor::{ComponentType, GenericComponentType, Type};
use gltf::json::buffer::{Stride, Target, View};
use gltf::json::image::MimeType;
use gltf::json::material::{
    NormalTexture, PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor,
};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::texture::{Info, MagFilter, MinFilter, Sampler, WrappingMode};
use gltf::json::validation::Checked::Valid;
use gltf::json::validation::USize64;
use gltf::json::{Accessor, Buffer, Image, Index, Material, Mesh, Node, Root, Scene, Texture};
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

use super::fine::Fine;
use crate::texture::Picture;

/// One side of the cloth.
pub struct Side<'a> {
    /// What stands for it in the file.
    pub name: &'a str,
    /// Its surface.
    pub surface: Fine,
    /// Its dyed yarns.
    pub picture: &'a Picture,
    /// Its relief: normals as red, green and blue, of as many pixels as there are (width, height, RGB).
    pub normals: (usize, usize, Vec<u8>),
}

/// Writes the sides of a cloth as one binary glTF.
///
/// # Errors
/// Where a picture or the file cannot be encoded.
pub fn to_glb(title: &str, sides: &[Side]) -> std::io::Result<Vec<u8>> {
    let mut file = File::default();
    file.root.asset.generator = Some(format!("dyelapse {}", env!("CARGO_PKG_VERSION")));
    file.root.samplers.push(Sampler {
        mag_filter: Some(Valid(MagFilter::Linear)),
        min_filter: Some(Valid(MinFilter::LinearMipmapLinear)),
        wrap_s: Valid(WrappingMode::ClampToEdge),
        wrap_t: Valid(WrappingMode::ClampToEdge),
        ..Default::default()
    });
    let primitives = sides
        .iter()
        .map(|side| file.primitive(side))
        .collect::<std::io::Result<Vec<_>>>()?;
    let mesh = file.root.push(Mesh {
        name: Some(title.into()),
        primitives,
        weights: None,
        extensions: None,
        extras: Default::default(),
    });
    let node = file.root.push(Node {
        name: Some(title.into()),
        mesh: Some(mesh),
        ..Default::default()
    });
    let scene = file.root.push(Scene {
        name: None,
        nodes: vec![node],
        extensions: None,
        extras: Default::default(),
    });
    file.root.scene = Some(scene);
    file.root.buffers.push(Buffer {
        byte_length: USize64::from(file.bytes.len()),
        name: None,
        uri: None,
        extensions: None,
        extras: Default::default(),
    });
    let json = file.root.to_vec().map_err(std::io::Error::other)?;
    let glb = Glb {
        header: Header {
            magic: *b"glTF",
            version: 2,
            length: 0,
        },
        json: Cow::Owned(json),
        bin: Some(Cow::Owned(file.bytes)),
    };
    glb.to_vec().map_err(std::io::Error::other)
}

/// A file in the making.
#[derive(Default)]
struct File {
    root: Root,
    bytes: Vec<u8>,
}

impl File {
    fn view(&mut self, bytes: &[u8], stride: Option<usize>, target: Option<Target>) -> Index<View> {
        // Numbers of four bytes lie at multiples of four.
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let offset = self.bytes.len();
        self.bytes.extend_from_slice(bytes);
        self.root.push(View {
            buffer: Index::new(0),
            byte_length: USize64::from(bytes.len()),
            byte_offset: Some(USize64::from(offset)),
            byte_stride: stride.map(Stride),
            name: None,
            target: target.map(Valid),
            extensions: None,
            extras: Default::default(),
        })
    }

    fn vectors<const N: usize>(&mut self, of: Type, values: &[[f32; N]]) -> Index<Accessor> {
        let bytes: Vec<u8> = values
            .iter()
            .flatten()
            .flat_map(|v| v.to_le_bytes())
            .collect();
        let view = self.view(&bytes, Some(4 * N), Some(Target::ArrayBuffer));
        let bound = |pick: fn(f32, f32) -> f32| {
            let all = values
                .iter()
                .copied()
                .reduce(|a, b| std::array::from_fn(|i| pick(a[i], b[i])));
            all.map(|bound| bound.to_vec().into())
        };
        self.root.push(Accessor {
            buffer_view: Some(view),
            byte_offset: None,
            count: USize64::from(values.len()),
            component_type: Valid(GenericComponentType(ComponentType::F32)),
            type_: Valid(of),
            min: bound(f32::min),
            max: bound(f32::max),
            name: None,
            normalized: false,
            sparse: None,
            extensions: None,
            extras: Default::default(),
        })
    }

    fn indices(&mut self, triangles: &[[u32; 3]]) -> Index<Accessor> {
        let all = triangles.iter().flatten();
        let bytes: Vec<u8> = all.flat_map(|i| i.to_le_bytes()).collect();
        let view = self.view(&bytes, None, Some(Target::ElementArrayBuffer));
        self.root.push(Accessor {
            buffer_view: Some(view),
            byte_offset: None,
            count: USize64::from(3 * triangles.len()),
            component_type: Valid(GenericComponentType(ComponentType::U32)),
            type_: Valid(Type::Scalar),
            min: None,
            max: None,
            name: None,
            normalized: false,
            sparse: None,
            extensions: None,
            extras: Default::default(),
        })
    }

    fn texture(
        &mut self,
        name: String,
        width: usize,
        height: usize,
        rgb: &[u8],
    ) -> std::io::Result<Index<Texture>> {
        let mut png = Vec::new();
        PngEncoder::new(&mut png)
            .write_image(rgb, width as u32, height as u32, ExtendedColorType::Rgb8)
            .map_err(std::io::Error::other)?;
        let view = self.view(&png, None, None);
        let source = self.root.push(Image {
            buffer_view: Some(view),
            mime_type: Some(MimeType("image/png".into())),
            name: Some(name.clone()),
            uri: None,
            extensions: None,
            extras: Default::default(),
        });
        Ok(self.root.push(Texture {
            name: Some(name),
            sampler: Some(Index::new(0)),
            source,
            extensions: None,
            extras: Default::default(),
        }))
    }

    fn primitive(&mut self, side: &Side) -> std::io::Result<Primitive> {
        let surface = &side.surface;
        let three = |of: &[bevy::math::DVec3]| -> Vec<[f32; 3]> {
            of.iter().map(|v| v.as_vec3().to_array()).collect()
        };
        let positions = self.vectors(Type::Vec3, &three(&surface.positions));
        let normals = self.vectors(Type::Vec3, &three(&surface.normals));
        let tangents: Vec<[f32; 4]> = surface
            .tangents
            .iter()
            .map(|t| t.as_vec3().extend(1.0).to_array())
            .collect();
        let tangents = self.vectors(Type::Vec4, &tangents);
        let uv: Vec<[f32; 2]> = surface
            .uv
            .iter()
            .map(|uv| uv.as_vec2().to_array())
            .collect();
        let uv = self.vectors(Type::Vec2, &uv);
        let indices = self.indices(&surface.triangles);
        let Picture { width, height, rgb } = side.picture;
        let colour = self.texture(format!("{} colour", side.name), *width, *height, rgb)?;
        let (width, height, rgb) = &side.normals;
        let relief = self.texture(format!("{} relief", side.name), *width, *height, rgb)?;
        let material = self.root.push(Material {
            name: Some(side.name.into()),
            pbr_metallic_roughness: PbrMetallicRoughness {
                base_color_factor: PbrBaseColorFactor([1.0; 4]),
                base_color_texture: Some(Info {
                    index: colour,
                    tex_coord: 0,
                    extensions: None,
                    extras: Default::default(),
                }),
                metallic_factor: StrengthFactor(0.0),
                roughness_factor: StrengthFactor(0.92),
                ..Default::default()
            },
            normal_texture: Some(NormalTexture {
                index: relief,
                scale: 1.0,
                tex_coord: 0,
                extensions: None,
                extras: Default::default(),
            }),
            ..Default::default()
        });
        Ok(Primitive {
            attributes: BTreeMap::from([
                (Valid(Semantic::Positions), positions),
                (Valid(Semantic::Normals), normals),
                (Valid(Semantic::Tangents), tangents),
                (Valid(Semantic::TexCoords(0)), uv),
            ]),
            indices: Some(indices),
            material: Some(material),
            mode: Valid(Mode::Triangles),
            targets: None,
            extensions: None,
            extras: Default::default(),
        })
    }
}
