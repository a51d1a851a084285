//! The studio in the window: drawn into an image that the panel shows, and only when something changed.

use std::time::{Duration, Instant};

use bevy::asset::RenderAssetUsages;
use bevy::camera::RenderTarget;
use bevy::math::DVec3;
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat, TextureUsages};
use bevy_egui::{EguiTextureHandle, EguiUserTextures};

use super::worker::{Seen, Shown};
use crate::drape::hand::first_hit;
use crate::scenario::{CameraSpec, ViewSpec};
use crate::studio::camera::{Opening, Subject};
use crate::studio::cloth::{self, ClothAssets, ClothSide};
use crate::studio::fine::Fine;
use crate::studio::light::{self, Ground, Lamp, Quality};
use crate::studio::mips::Kind;
use crate::studio::things::{self, Furniture, Thing};

/// Frames that are drawn after a change: what was changed takes one to reach the renderer.
const FRAMES: u32 = 2;

/// The image that the studio is drawn into, and the camera that draws.
#[derive(Resource)]
pub struct View3d {
    /// The image.
    pub image: Handle<Image>,
    /// Its size, pixels.
    pub size: UVec2,
    /// Pixels of it for one of the window, across and down; fewer where the processor draws.
    pub share: f32,
    camera: Entity,
    /// Frames still to be drawn.
    dirty: u32,
    /// Where the camera stands.
    pub eye: Eye,
    /// What it sees at distance one.
    pub subject: Option<Subject>,
    /// Angle between upper and lower edge, degrees.
    pub field_of_view: f64,
    /// Whether someone has moved the camera.
    pub moved_by_hand: bool,
    /// Whether it is shown.
    pub is_shown: bool,
    /// The least time between two pictures of which only the dye differs: where the processor draws, the flat
    /// cloth would else wait for the draped one.
    pub apart: Duration,
}

/// Where the camera stands: around what it looks at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Eye {
    /// Degrees around the upright.
    pub turn: f64,
    /// Degrees above the horizon.
    pub elevation: f64,
    /// Metres away.
    pub distance: f64,
    /// What it looks at, m.
    pub at: DVec3,
}

impl Eye {
    /// The way from what it looks at to it.
    pub fn out(&self) -> DVec3 {
        let (turn, up) = (self.turn.to_radians(), self.elevation.to_radians());
        DVec3::new(
            libm::sin(turn) * libm::cos(up),
            libm::sin(up),
            libm::cos(turn) * libm::cos(up),
        )
    }

    /// Where it is and how it is turned.
    pub fn transform(&self) -> Transform {
        let eye = self.at + self.distance * self.out();
        Transform::from_translation(eye.as_vec3()).looking_at(self.at.as_vec3(), Vec3::Y)
    }

    /// Turned by a drag of so many points.
    pub fn turned(mut self, (x, y): (f32, f32)) -> Self {
        self.turn = (self.turn - 0.4 * f64::from(x)).rem_euclid(360.0);
        self.elevation = (self.elevation + 0.4 * f64::from(y)).clamp(-89.0, 89.0);
        self
    }

    /// Moved sideways by a drag of so many points in a picture so many points high.
    pub fn shifted(mut self, (x, y): (f32, f32), height: f32, field_of_view: f64) -> Self {
        let right = DVec3::Y.cross(self.out()).normalize_or(DVec3::X);
        let up = self.out().cross(right);
        let span = 2.0 * self.distance * libm::tan(0.5 * field_of_view.to_radians());
        let point = span / f64::from(height.max(1.0));
        self.at += point * (f64::from(y) * up - f64::from(x) * right);
        self
    }

    /// Nearer by a factor.
    pub fn nearer(mut self, factor: f64) -> Self {
        self.distance = (self.distance / factor).clamp(0.01, 100.0);
        self
    }

    /// The ray from the camera through a place of its picture (shares of its width and height): where it
    /// begins, and its way.
    pub fn ray(&self, (x, y): (f64, f64), opening: Opening) -> (DVec3, DVec3) {
        let out = self.out();
        let right = DVec3::Y.cross(out).normalize_or(DVec3::X);
        let up = out.cross(right);
        let way =
            (2.0 * x - 1.0) * opening.across * right + (1.0 - 2.0 * y) * opening.up * up - out;
        (self.at + self.distance * out, way.normalize())
    }
}

/// What a ray meets first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Where on the front's picture, shares across and down.
    pub uv: (f64, f64),
    /// Where in space, m.
    pub place: DVec3,
}

/// Where a ray meets the cloth.
pub fn hit(front: &Fine, from: DVec3, way: DVec3) -> Option<Hit> {
    let hit = first_hit(&front.positions, &front.triangles, from, way)?;
    let corners = front.triangles[hit.triangle].map(|i| i as usize);
    let mut uv = bevy::math::DVec2::ZERO;
    for (share, corner) in hit.shares.into_iter().zip(corners) {
        uv += share * front.uv[corner];
    }
    Some(Hit {
        uv: (uv.x, uv.y),
        place: from + hit.distance * way,
    })
}

fn target(size: UVec2) -> Image {
    let mut image = Image::new_uninit(
        Extent3d {
            width: size.x.max(1),
            height: size.y.max(1),
            depth_or_array_layers: 1,
        },
        TextureDimension::D2,
        TextureFormat::Rgba8UnormSrgb,
        RenderAssetUsages::RENDER_WORLD,
    );
    image.texture_descriptor.usage |= TextureUsages::RENDER_ATTACHMENT;
    image
}

/// Sets up camera, light and ground.
pub fn start(world: &mut World) {
    let view = ViewSpec::default();
    let size = UVec2::new(640, 480);
    let image = world.resource_mut::<Assets<Image>>().add(target(size));
    world
        .resource_mut::<EguiUserTextures>()
        .add_image(EguiTextureHandle::Strong(image.clone()));
    let quality = Quality::for_window(world);
    let bundle = light::camera(world, &view, quality);
    let camera = world
        .spawn((bundle, RenderTarget::from(image.clone())))
        .id();
    if let Some(mut camera) = world.get_mut::<Camera>(camera) {
        camera.order = -1;
    }
    world.insert_resource(View3d {
        image,
        size,
        share: if quality == Quality::Software {
            0.7
        } else {
            1.0
        },
        camera,
        dirty: FRAMES,
        eye: Eye {
            turn: 20.0,
            elevation: 15.0,
            distance: 2.0,
            at: DVec3::ZERO,
        },
        subject: None,
        field_of_view: view.field_of_view,
        moved_by_hand: false,
        is_shown: true,
        apart: match quality {
            Quality::Software => Duration::from_millis(300),
            Quality::Fine | Quality::Fast => Duration::ZERO,
        },
    });
}

impl View3d {
    /// Something has changed.
    pub fn touch(&mut self) {
        self.dirty = FRAMES;
    }

    /// Stands where the scenario's camera does in the beginning.
    pub fn reset(&mut self, view: &ViewSpec) {
        let Some(subject) = &self.subject else {
            return;
        };
        self.field_of_view = view.field_of_view;
        let standing = view.camera.at(0.0);
        let at = standing
            .at_m
            .map_or(subject.centre, |(x, y, z)| DVec3::new(x, y, z));
        let mut eye = Eye {
            turn: standing.turn,
            elevation: standing.elevation,
            distance: 1.0,
            at,
        };
        let fits = subject.fitting_distance(at, eye.out(), self.opening());
        let distance = match view.camera {
            CameraSpec::Dolly { to, .. } => to,
            _ => standing.distance,
        };
        eye.distance = distance * fits;
        self.eye = eye;
        self.moved_by_hand = false;
        self.touch();
    }

    /// The opening of its picture.
    pub fn opening(&self) -> Opening {
        Opening::new(self.field_of_view, (self.size.x.max(1), self.size.y.max(1)))
    }
}

/// Builds everything that the cloth lies on or hangs from, for another cloth.
pub fn furnish(world: &mut World, view: &ViewSpec, subject: Subject, furniture: &Furniture) {
    type Old = Or<(With<Thing>, With<Lamp>, With<Ground>)>;
    let old: Vec<Entity> = world.query_filtered::<Entity, Old>().iter(world).collect();
    for entity in old {
        world.despawn(entity);
    }
    things::spawn(world, furniture);
    let quality = Quality::for_window(world);
    light::spawn(world, view, &subject, quality);
    let colour = light::ground_colour(view);
    world.resource_scope(|world, mut view3d: Mut<View3d>| {
        if let Some(mut camera) = world.get_mut::<Camera>(view3d.camera) {
            camera.clear_color = ClearColorConfig::Custom(colour);
        }
        if let Some(mut projection) = world.get_mut::<Projection>(view3d.camera)
            && let Projection::Perspective(perspective) = &mut *projection
        {
            perspective.fov = view.field_of_view.to_radians() as f32;
        }
        view3d.field_of_view = view.field_of_view;
        view3d.subject = Some(subject);
        view3d.touch();
    });
}

/// Shows the cloth in a shape, with what it looks like; hangs it first if it is not there.
pub fn show(world: &mut World, front: Option<&Fine>, seen: Option<&Seen>) {
    let quality = Quality::for_window(world);
    let is_there = world.contains_resource::<ClothAssets>();
    match (is_there, front, seen) {
        (false, Some(front), Some(seen)) => {
            let images = seen
                .sides
                .each_ref()
                .map(|side| image(side, Kind::Colour, quality));
            let reliefs = seen
                .reliefs
                .each_ref()
                .map(|side| image(side, Kind::Normal, quality));
            cloth::hang(world, cloth::shapes(front), images, reliefs);
            let handles = world.resource::<ClothAssets>().pictures.clone();
            let mut textures = world.resource_mut::<EguiUserTextures>();
            for handle in handles {
                textures.add_image(EguiTextureHandle::Strong(handle));
            }
        }
        (true, front, seen) => {
            if let Some(front) = front {
                cloth::move_to(world, cloth::shapes(front));
            }
            if let Some(seen) = seen {
                let images = seen
                    .sides
                    .each_ref()
                    .map(|side| image(side, Kind::Colour, quality));
                cloth::repaint(world, images);
            }
        }
        _ => return,
    }
    world.resource_mut::<View3d>().touch();
}

/// Gives the cloth another relief.
pub fn relief(world: &mut World, seen: &Seen) {
    let quality = Quality::for_window(world);
    if world.contains_resource::<ClothAssets>() {
        let reliefs = seen
            .reliefs
            .each_ref()
            .map(|side| image(side, Kind::Normal, quality));
        cloth::emboss(world, reliefs);
    }
}

fn image(shown: &Shown, kind: Kind, quality: Quality) -> Image {
    let size = (shown.width, shown.height);
    let anisotropy = match quality {
        Quality::Fine | Quality::Fast => cloth::FINE,
        Quality::Software => 1,
    };
    cloth::image_of_levels(shown.levels.clone(), size, kind, anisotropy)
}

/// Moves the camera, fits its image to the space there is, and draws only if something has changed.
pub fn draw(
    mut view: ResMut<View3d>,
    mut images: ResMut<Assets<Image>>,
    mut cameras: Query<(&mut Camera, &mut Transform), Without<ClothSide>>,
    mut drawn: Local<Option<(UVec2, Eye)>>,
    mut last: Local<Option<Instant>>,
) {
    let now = (view.size, view.eye);
    let stood_still = *drawn == Some(now);
    if *drawn != Some(now) {
        if drawn.is_none_or(|(size, _)| size != view.size)
            && let Some(mut image) = images.get_mut(&view.image)
        {
            *image = target(view.size);
        }
        *drawn = Some(now);
        view.dirty = view.dirty.max(2);
    }
    if let Ok((mut camera, mut transform)) = cameras.get_mut(view.camera) {
        let waits = stood_still && last.is_some_and(|last| last.elapsed() < view.apart);
        let draws = view.is_shown && view.dirty > 0 && !waits;
        camera.set_if_neq_active(draws);
        transform.set_if_neq(view.eye.transform());
        if draws {
            view.dirty -= 1;
            *last = Some(Instant::now());
        }
    }
}

/// Turning a camera on and off without marking it as changed where it has not.
trait SetActive {
    fn set_if_neq_active(&mut self, active: bool);
}

impl SetActive for Mut<'_, Camera> {
    fn set_if_neq_active(&mut self, active: bool) {
        if self.is_active != active {
            self.is_active = active;
        }
    }
}
