//! How fast pictures are drawn: `cargo bench --bench pictures`.
//!
//! Prints the time of one picture of the dyed seikaiha, 800×600 cells, at several pixels a cell, the best
//! of many, and of drawing the undyed cloth, which is done once.

use std::time::Instant;

use dyelapse::prelude::*;
use dyelapse::scenario::Side;
use dyelapse::schedule::TheExperiment;
use dyelapse::texture::Texture;

fn main() {
    let mut app = dyeing_app(Experiment::load("seikaiha").expect("it is bundled"));
    advance_to(app.world_mut(), 5000, |_| true);
    let world = app.world();
    let (cloth, free) = (world.resource::<Cloth>(), world.resource::<FreeDye>());
    let (bound, experiment) = (
        world.resource::<BoundDye>(),
        world.resource::<TheExperiment>(),
    );
    let mut picture = Picture::default();
    for scale in [1, 4] {
        let begin = Instant::now();
        let scenario = &experiment.scenario;
        let texture = Texture::new(cloth, scenario, &experiment.images, scale, Side::Face);
        let once = begin.elapsed().as_secs_f64();
        let mut draw = || {
            let begin = Instant::now();
            texture.draw(cloth, free, bound, &mut picture);
            1e3 * begin.elapsed().as_secs_f64()
        };
        let best = (0..50).map(|_| draw()).fold(f64::INFINITY, f64::min);
        println!(
            "{}×{} pixels: {best:.2} ms a picture; {once:.2} s once",
            picture.width, picture.height
        );
    }
}
