//! What must hold of draped cloth.
#![allow(clippy::disallowed_methods)] // A test may use the platform's own functions.

mod contact;
mod creases;
mod forces;
mod motion;
mod scenes;
mod shapes;
mod spec;

use bevy::math::DVec3;
use dyelapse::drape::drape::Drape;
use dyelapse::drape::exact::{crossings, sunk};
use dyelapse::drape::scenes::parse;
use dyelapse::scenario::check::Checker;

/// The cloth that a text in RON describes.
fn drape(text: &str) -> Drape {
    let spec = parse(text).unwrap_or_else(|e| panic!("{e} in {text}"));
    spec.build((0.5, 0.5), 1, &Checker::root())
        .unwrap_or_else(|e| panic!("{e} in {text}"))
}

/// Advances a cloth that must not fly apart.
fn advance(drape: &mut Drape, seconds: f64) {
    drape.advance(seconds).expect("the cloth holds together");
}

/// That nothing passes through anything, decided exactly.
fn assert_whole(drape: &Drape, what: &str) {
    let triangles = drape.sheet().topology.triangles();
    assert!(!triangles.is_empty());
    assert!(drape.positions().iter().all(|x| x.is_finite()), "{what}");
    let crossing = crossings(drape.positions(), &triangles, &drape.colliders().mesh);
    assert_eq!(crossing, [], "{what}: crossing after {} s", drape.time);
    let inside = sunk(drape.positions(), &triangles, drape.colliders());
    assert_eq!(
        inside,
        [] as [usize; 0],
        "{what}: sunk after {} s",
        drape.time
    );
}

/// How far any particle is from where it was.
fn furthest(a: &[DVec3], b: &[DVec3]) -> f64 {
    let apart = a.iter().zip(b).map(|(a, b)| a.distance(*b));
    apart.fold(0.0, f64::max)
}
