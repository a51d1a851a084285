//! Frames without a window: the studio drawn into an image, one frame when one is asked for.

use std::sync::{Arc, Mutex};

use bevy::app::TerminalCtrlCHandlerPlugin;
use bevy::asset::RenderAssetUsages;
use bevy::camera::RenderTarget;
use bevy::log::LogPlugin;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::render_resource::{
    Extent3d, PollType, TextureDimension, TextureFormat, TextureUsages,
};
use bevy::render::renderer::RenderDevice;
use bevy::render::settings::{RenderCreation, WgpuSettings};
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use thiserror::Error;

use crate::texture::Picture;

/// Why there is no frame.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum NoFrame {
    /// No graphics driver.
    #[error(
        "no graphics driver was found, and draped cloth needs one (Vulkan; drawing on the processor \
         will do).\n  Debian, Ubuntu: apt install libvulkan1 mesa-vulkan-drivers\n  Fedora: dnf install \
         vulkan-loader mesa-vulkan-drivers\n  Arch: pacman -S vulkan-icd-loader vulkan-swrast\n\
         Without one, flat cloth can be recorded (leave out --view draped), and draped cloth exported \
         (dyelapse export)"
    )]
    NoDriver,
    /// The driver did not draw.
    #[error("the graphics driver gave no picture after {0} tries")]
    NoPicture(u32),
    /// The driver draws nothing.
    #[error("the graphics driver draws only blank frames")]
    Blank,
    /// A picture is larger than the driver can take.
    #[error(
        "the cloth's picture is {pixels} pixels long, but this graphics driver takes at most {most}; \
         a smaller --scale makes it smaller"
    )]
    TooLarge {
        /// Its longer side.
        pixels: usize,
        /// The most.
        most: usize,
    },
}

/// Whether there is a graphics driver that can draw without a window.
///
/// # Errors
/// [`NoFrame::NoDriver`].
pub fn check_driver() -> Result<(), NoFrame> {
    // As Bevy looks for one, which would end the program if there is none.
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends();
    let instance = wgpu::Instance::new(descriptor);
    let wanted = wgpu::RequestAdapterOptions::default();
    let found = bevy::tasks::block_on(instance.request_adapter(&wanted));
    found.map(|_| ()).map_err(|_| NoFrame::NoDriver)
}

/// The ways to a driver that are tried: Vulkan and its like on other systems, unless the variable
/// `WGPU_BACKEND` names others. (OpenGL would complain aloud where there is no display.)
pub fn backends() -> wgpu::Backends {
    wgpu::Backends::from_env().unwrap_or(wgpu::Backends::PRIMARY)
}

/// How Bevy is to find the driver.
pub fn render_plugin() -> RenderPlugin {
    RenderPlugin {
        render_creation: RenderCreation::Automatic(Box::new(WgpuSettings {
            backends: Some(backends()),
            ..default()
        })),
        ..default()
    }
}

/// Adds all of Bevy that drawing needs, and no window; then it is ready to draw.
///
/// # Errors
/// [`NoFrame::NoDriver`].
pub fn add_plugins(app: &mut App) -> Result<(), NoFrame> {
    check_driver()?;
    let no_window = WindowPlugin {
        primary_window: None,
        exit_condition: ExitCondition::DontExit,
        ..default()
    };
    let at_once = RenderPlugin {
        // The first frame is to have everything.
        synchronous_pipeline_compilation: true,
        ..render_plugin()
    };
    app.add_plugins(
        DefaultPlugins
            .set(no_window)
            .set(at_once)
            .disable::<WinitPlugin>()
            .disable::<LogPlugin>()
            .disable::<TerminalCtrlCHandlerPlugin>()
            // Each frame is drawn when it is asked for, not one later.
            .disable::<PipelinedRenderingPlugin>(),
    );
    app.finish();
    app.cleanup();
    Ok(())
}

/// A camera that draws into an image.
pub struct Offscreen {
    target: Handle<Image>,
    camera: Entity,
    size: (u32, u32),
}

/// Updates until a picture must have come.
const TRIES: u32 = 60;

/// Frames until one must have something on it.
const WARM_UP: u32 = 20;

impl Offscreen {
    /// A camera that draws `size` pixels; `bundle` is the rest of it.
    pub fn new(world: &mut World, size: (u32, u32), bundle: impl Bundle) -> Self {
        let mut image = Image::new_uninit(
            Extent3d {
                width: size.0,
                height: size.1,
                depth_or_array_layers: 1,
            },
            TextureDimension::D2,
            TextureFormat::Rgba8UnormSrgb,
            RenderAssetUsages::RENDER_WORLD,
        );
        image.texture_descriptor.usage |= TextureUsages::RENDER_ATTACHMENT;
        let target = world.resource_mut::<Assets<Image>>().add(image);
        let camera = world
            .spawn((bundle, RenderTarget::from(target.clone())))
            .id();
        Offscreen {
            target,
            camera,
            size,
        }
    }

    /// Moves the camera.
    pub fn stand(&self, world: &mut World, at: Transform) {
        if let Some(mut transform) = world.get_mut::<Transform>(self.camera) {
            *transform = at;
        }
    }

    /// Draws until there is something on a frame: the first are blank while the driver gets ready.
    ///
    /// # Errors
    /// [`NoFrame`] if that never happens.
    pub fn warm_up(&self, app: &mut App) -> Result<(), NoFrame> {
        for _ in 0..WARM_UP {
            let picture = self.frame(app)?;
            let first = picture.rgb.first_chunk::<3>();
            let pixels = picture.rgb.as_chunks::<3>().0;
            if pixels.iter().any(|pixel| Some(pixel) != first) {
                return Ok(());
            }
        }
        Err(NoFrame::Blank)
    }

    /// Draws the world as it is now.
    ///
    /// # Errors
    /// [`NoFrame::NoPicture`].
    pub fn frame(&self, app: &mut App) -> Result<Picture, NoFrame> {
        // What was changed reaches the driver first, with nothing drawn: so no frame shows the cloth of
        // the one before.
        self.set_active(app.world_mut(), false);
        self.update(app);
        self.set_active(app.world_mut(), true);
        let slot: Arc<Mutex<Option<Image>>> = Arc::default();
        let given = slot.clone();
        app.world_mut()
            .spawn(Screenshot::image(self.target.clone()))
            .observe(move |captured: On<ScreenshotCaptured>| {
                if let Ok(mut slot) = given.lock() {
                    *slot = Some(captured.image.clone());
                }
            });
        for _ in 0..TRIES {
            self.update(app);
            // Drawn once; until it has come there is no need to draw again.
            self.set_active(app.world_mut(), false);
            let image = slot.lock().ok().and_then(|mut slot| slot.take());
            if let Some(image) = image {
                return self.picture(&image).ok_or(NoFrame::NoPicture(1));
            }
        }
        Err(NoFrame::NoPicture(TRIES))
    }

    fn set_active(&self, world: &mut World, active: bool) {
        if let Some(mut camera) = world.get_mut::<Camera>(self.camera) {
            camera.is_active = active;
        }
    }

    fn update(&self, app: &mut App) {
        app.update();
        let device = app.world().resource::<RenderDevice>();
        // A driver that fails here gives no picture, which is told.
        let _ = device.wgpu_device().poll(PollType::Wait {
            submission_index: None,
            timeout: None,
        });
    }

    fn picture(&self, image: &Image) -> Option<Picture> {
        let (width, height) = (self.size.0 as usize, self.size.1 as usize);
        let pixels = image.data.as_ref()?.as_chunks::<4>().0;
        if pixels.len() != width * height {
            return None;
        }
        let rgb = pixels.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]);
        Some(Picture {
            width,
            height,
            rgb: rgb.collect(),
        })
    }
}

/// The longest side that a picture on the cloth may have.
pub fn most_pixels(world: &World) -> usize {
    world
        .resource::<RenderDevice>()
        .limits()
        .max_texture_dimension_2d as usize
}
