//! Sections, overlays and the course of the ledger.

use dyelapse::cloth::Layer;
use dyelapse::prelude::*;
use dyelapse::session::course::{Account, Course};
use dyelapse::session::overlay::{Field, Overlay, Scale, Seen};
use dyelapse::session::section::Section;
use dyelapse::texture::oklab::Oklab;

use crate::cloths::samples;
use crate::common::go_on;

#[test]
fn a_section_passes_through_every_cell_of_its_line_once() {
    let app = samples()[2].straight(600);
    let section = Section::along(app.world(), (0.0, 10.5), (70.0, 10.5));
    assert_eq!(section.places.len(), 70);
    assert!((section.mm - 3.5).abs() < 1e-9);
    let cloth = app.world().resource::<Cloth>();
    let free = app.world().resource::<FreeDye>();
    for (x, place) in section.places.iter().enumerate() {
        assert!((place.mm - (x as f64 + 0.5) * 0.05).abs() < 1e-9);
        for layer in Layer::BOTH {
            let i = cloth.grid.index(layer, 10, x);
            let sample = place.layers[layer as usize];
            assert_eq!(sample.concentration, free.concentration[i]);
            assert_eq!(sample.yarn.is_some(), cloth.fibre(layer, 10, x));
            assert!(sample.free <= sample.concentration);
        }
        assert!(place.layers[0].on_top != place.layers[1].on_top);
    }
    // Aslant: cells follow each other, each next to the one before.
    let aslant = Section::along(app.world(), (2.3, 1.1), (61.7, 40.2));
    let cells: Vec<_> = aslant
        .places
        .iter()
        .map(|place| (place.at.0.floor(), place.at.1.floor()))
        .collect();
    for pair in cells.windows(2) {
        let (dx, dy) = (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
        assert_eq!(dx.abs() + dy.abs(), 1.0);
    }
    assert!(aslant.places.windows(2).all(|pair| pair[0].mm < pair[1].mm));
}

#[test]
fn a_section_there_is_one_back_turned_round() {
    let app = samples()[2].straight(600);
    let (a, b) = ((3.2, 30.9), (66.1, 4.4));
    let there = Section::along(app.world(), a, b);
    let mut back = Section::along(app.world(), b, a);
    back.places.reverse();
    assert_eq!(there.places.len(), back.places.len());
    for (one, other) in there.places.iter().zip(&back.places) {
        assert_eq!(one.layers, other.layers);
        assert!((one.mm + other.mm - there.mm).abs() < 1e-9);
    }
}

#[test]
fn a_section_keeps_to_the_cloth() {
    let app = samples()[2].straight(1);
    let places = |from, to| Section::along(app.world(), from, to).places.len();
    assert_eq!(places((-50.0, 20.5), (200.0, 20.5)), 70);
    assert_eq!(places((-5.0, -5.0), (-1.0, 99.0)), 0);
    assert_eq!(places((10.5, 10.5), (10.5, 10.5)), 1);
    assert_eq!(places((f64::NAN, 0.0), (9.0, 9.0)), 0);
    assert_eq!(places((1e9, 1e9), (2e9, 1e9)), 0);
}

#[test]
fn overlays_show_what_is_there_within_their_range() {
    for sample in samples() {
        let app = sample.straight(sample.stops[0]);
        let cells = 70 * 45;
        for field in Field::ALL {
            for layer in [Seen::Top, Seen::Weft, Seen::Warp] {
                let overlay = Overlay::of(app.world(), field, layer, true);
                assert_eq!(overlay.values.len(), cells);
                let (low, high) = overlay.range;
                assert!(low < high && high <= 1.5, "{field:?}");
                assert!(
                    overlay
                        .values
                        .iter()
                        .all(|v| v.is_nan() || (low..=high).contains(v)),
                    "{}: {field:?}",
                    sample.name
                );
                let rgba = overlay.rgba();
                assert_eq!(rgba.len(), 4 * cells);
                let clear = rgba.chunks(4).filter(|pixel| pixel[3] == 0).count();
                let without = overlay.values.iter().filter(|v| v.is_nan()).count();
                assert_eq!(clear, without);
                let stops = overlay.stops();
                assert_eq!(stops[0].value, low);
                assert_eq!(stops.last().unwrap().value, high);
                assert!(stops.windows(2).all(|pair| pair[0].at < pair[1].at));
                assert!(!field.name().is_empty() && !field.unit().is_empty());
            }
        }
    }
}

#[test]
fn the_scale_grows_lighter_in_even_steps() {
    let scale = Scale::new();
    let lightness = |i: i32| {
        let rgb = scale.colour(i as f32 / 16.0).map(|c| f64::from(c) / 255.0);
        Oklab::from_rgb(rgb).lightness
    };
    let even = (lightness(16) - lightness(0)) / 16.0;
    for i in 0..16 {
        let step = lightness(i + 1) - lightness(i);
        assert!((step / even - 1.0).abs() < 0.2, "{i}: {step} for {even}");
    }
    assert_eq!(scale.colour(-3.0), scale.colour(0.0));
    assert_eq!(scale.colour(7.0), scale.colour(1.0));
}

#[test]
fn the_course_keeps_what_was_seen_when_one_goes_back() {
    let sample = &samples()[2];
    let mut app = sample.app();
    let mut course = Course::default();
    for step in [0, 100, 500, 1000] {
        go_on(&mut app, step);
        course.note(app.world());
    }
    let before = course.clone();
    let mut app = sample.app();
    go_on(&mut app, 100);
    course.note(app.world());
    assert_eq!(course, before);
    for account in Account::ALL {
        let points: Vec<_> = course.series(account).collect();
        assert_eq!(points.len(), 4);
        assert!((points[3][0] - 0.5).abs() < 1e-12, "{}", account.name());
    }
    let supplied: Vec<_> = course.series(Account::Supplied).map(|p| p[1]).collect();
    assert!(supplied.windows(2).all(|pair| pair[0] <= pair[1]));
    course.forget_from(500);
    assert_eq!(
        course.points().map(|(step, _)| step).collect::<Vec<_>>(),
        [0, 100]
    );
}
