//! Draped cloth alone, without rendering and without dye: a length of muslin on two pegs, taken hold of and
//! let go again.
//!
//! `cargo run --release --no-default-features --example hanging_cloth [cloth.obj]`

use std::error::Error;

use bevy::math::DVec3;
use bevy::prelude::*;
use dyelapse::drape::plugin::{DrapePlugin, Draped, drape_to};
use dyelapse::drape::scenes;
use dyelapse::scenario::check::Checker;

fn main() -> Result<(), Box<dyn Error>> {
    let text = scenes::text("hanging").ok_or("`hanging` is bundled")?;
    let cloth = scenes::parse(text)?.build((0.8, 0.9), 0, &Checker::root())?;
    let (nx, ny) = cloth.sheet().links.particles;
    let mut app = App::new();
    app.add_plugins(DrapePlugin)
        .insert_resource(Draped::new(cloth));
    let middle = (ny / 2) * nx + nx / 2;
    for tenth in 1..=50_u32 {
        let seconds = f64::from(tenth) / 10.0;
        drape_to(app.world_mut(), seconds)?;
        let mut draped = app.world_mut().resource_mut::<Draped>();
        match tenth {
            20 => {
                // A hand takes the cloth where a ray from the viewer meets it, and draws it nearer.
                let at = draped.drape.positions()[middle];
                let from = at + DVec3::new(0.0, 0.0, 1.0);
                if let Some(hit) = draped.hit(from, DVec3::NEG_Z) {
                    draped.hold(hit.particle, hit.point + DVec3::new(0.0, 0.05, 0.25));
                }
            }
            35 => draped.drape.hands.clear(),
            _ => {}
        }
        if tenth % 5 == 0 {
            let x = draped.drape.positions();
            let sag = 0.5 * (x[0].y + x[nx - 1].y) - x[nx / 2].y;
            let stretch = 100.0 * draped.drape.stretched();
            println!(
                "{seconds:3.1} s: sags {:3.0} mm between the pegs, {stretch:.2} % longer",
                1e3 * sag
            );
        }
    }
    if let Some(path) = std::env::args().nth(1) {
        let surface = app.world().resource::<Draped>().drape.surface();
        std::fs::write(&path, surface.to_obj())?;
        println!("written to {path}");
    }
    Ok(())
}
