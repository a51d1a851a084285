//! Strokes of a brush as patterns.

use dyelapse::pattern::{Canvas, Pattern, Raster, Stroke};
use dyelapse::scenario::{Images, Length};

use crate::common::experiment;

/// Draws strokes on 60 by 40 cells.
fn drawn(strokes: Vec<Stroke>) -> Raster {
    let images = Images::default();
    let canvas = Canvas {
        nx: 60,
        ny: 40,
        cell_mm: 0.05,
        seed: 0,
        images: &images,
    };
    canvas.draw(&Pattern::Strokes(strokes))
}

fn stroke(radius: f64, hardness: f64, path: &[(f64, f64)]) -> Stroke {
    Stroke {
        radius: Length::Cells(radius),
        hardness,
        strength: 1.0,
        path: path.to_vec(),
    }
}

const WINDING: [(f64, f64); 5] = [
    (0.1, 0.2),
    (0.4, 0.75),
    (0.75, 0.3),
    (0.75, 0.3),
    (0.95, 0.6),
];

#[test]
fn a_dab_is_a_disc_where_it_is_hard() {
    let dab = drawn(vec![stroke(9.0, 1.0, &[(0.5, 0.5)])]);
    let disc = Raster::from_rule(60, 40, |x, y| {
        let (dx, dy) = (x - 30.0, y - 20.0);
        if dx * dx + dy * dy <= 81.0 { 1.0 } else { 0.0 }
    });
    assert_eq!(dab, disc);
}

#[test]
fn a_stroke_is_what_its_distance_says_and_reaches_no_farther() {
    let (radius, hardness) = (6.0, 0.5);
    let path = WINDING.map(|(x, y)| (60.0 * x, 40.0 * y));
    let raster = drawn(vec![stroke(radius, hardness, &WINDING)]);
    // The slow way: every cell against a thousand points of every part.
    let nearest = |x: f64, y: f64| {
        let parts = path.windows(2).flat_map(|part| {
            (0..=1000).map(move |i| {
                let t = f64::from(i) / 1000.0;
                let at = |side: fn((f64, f64)) -> f64| {
                    side(part[0]) + t * (side(part[1]) - side(part[0]))
                };
                let (dx, dy) = (at(|p| p.0) - x, at(|p| p.1) - y);
                (dx * dx + dy * dy).sqrt()
            })
        });
        parts.fold(f64::INFINITY, f64::min)
    };
    let mut between = 0;
    for y in 0..40 {
        for x in 0..60 {
            let distance = nearest(x as f64 + 0.5, y as f64 + 0.5);
            let t = ((radius - distance) / (radius - hardness * radius)).clamp(0.0, 1.0);
            let expected = t * t * (3.0 - 2.0 * t);
            let found = f64::from(raster.at(y, x));
            assert!((found - expected).abs() < 1e-3, "{x}, {y}");
            assert!(distance < radius + 0.05 || found == 0.0);
            between += usize::from(found > 0.0 && found < 1.0);
        }
    }
    assert!(between > 100, "no soft edge");
}

#[test]
fn a_stroke_is_the_same_there_and_back_and_mirrored_with_its_path() {
    let there = drawn(vec![stroke(5.0, 0.3, &WINDING)]);
    let back: Vec<_> = WINDING.iter().rev().copied().collect();
    let back = drawn(vec![stroke(5.0, 0.3, &back)]);
    let mirrored = WINDING.map(|(x, y)| (1.0 - x, y));
    let mirrored = drawn(vec![stroke(5.0, 0.3, &mirrored)]).mirrored();
    for other in [back, mirrored] {
        for (a, b) in there.values.iter().zip(&other.values) {
            assert!((a - b).abs() < 1e-5);
        }
    }
}

#[test]
fn of_strokes_that_cross_the_most_counts_whatever_their_order() {
    let one = stroke(5.0, 0.3, &WINDING);
    let mut other = stroke(8.0, 0.0, &[(0.0, 0.5), (1.0, 0.5)]);
    other.strength = 0.6;
    let both = drawn(vec![one.clone(), other.clone()]);
    assert_eq!(both, drawn(vec![other.clone(), one.clone()]));
    let (one, other) = (drawn(vec![one]), drawn(vec![other]));
    for i in 0..both.values.len() {
        assert_eq!(both.values[i], one.values[i].max(other.values[i]));
    }
}

#[test]
fn no_stroke_leaves_its_bounds_wherever_it_goes() {
    let paths: [&[(f64, f64)]; 3] = [
        &[(-3.0, -2.0), (4.0, 3.0)],
        &[(0.0, 0.0)],
        &[(10.0, 0.5), (0.2, 0.5), (0.2, -10.0)],
    ];
    for path in paths {
        for radius in [0.01, 0.5, 1000.0] {
            let raster = drawn(vec![stroke(radius, 0.7, path)]);
            assert!(raster.values.iter().all(|v| (0.0..=1.0).contains(v)));
        }
    }
    let outside = drawn(vec![stroke(5.0, 0.7, &[(-1.0, 0.5), (-1.0, 0.9)])]);
    assert!(outside.values.iter().all(|v| *v == 0.0));
}

#[test]
fn a_hand_s_path_is_rounded_and_painting_goes_on_where_it_stopped() {
    let hand = [(0.123_456_789, 0.5), (0.123_457, 0.5), (0.3, 0.25)];
    let one = Stroke::along(Length::Mm(0.8), hand);
    assert_eq!(one.path, [(0.12346, 0.5), (0.3, 0.25)]);
    let painted = Pattern::Everywhere
        .painted(one.clone())
        .painted(one.clone());
    let expected = Pattern::Union(vec![
        Pattern::Everywhere,
        Pattern::Strokes(vec![one.clone(), one.clone()]),
    ]);
    assert_eq!(painted, expected);
    let first = Pattern::Nowhere.painted(one.clone());
    assert_eq!(first, Pattern::Strokes(vec![one]));
}

#[test]
fn strokes_are_read_from_a_file_and_what_cannot_be_is_told() {
    let text = |strokes: &str| {
        format!(
            "(title: \"t\", cloth: (size: (Cells(60), Cells(40))), supply: [],
              resist: Strokes({strokes}), process: (duration: Steps(1)))"
        )
    };
    let scenario = experiment(&text("[(radius: Mm(0.25), path: [(0.5, 0.5)])]")).scenario;
    let brush = Stroke::along(Length::Mm(0.25), [(0.5, 0.5)]);
    assert_eq!(scenario.resist, Pattern::Strokes(vec![brush]));
    for (strokes, place) in [
        ("[(radius: Mm(0.25), path: [])]", "resist.Strokes[0].path"),
        (
            "[(radius: Mm(0), path: [(0.5, 0.5)])]",
            "resist.Strokes[0].radius",
        ),
        (
            "[(radius: Mm(1), hardness: 2, path: [(0.5, 0.5)])]",
            "resist.Strokes[0].hardness",
        ),
        (
            "[(radius: Mm(1), path: [(0.5, 0.5), (99, 0)])]",
            "resist.Strokes[0].path[1][0]",
        ),
    ] {
        let origin = dyelapse::scenario::Origin::Memory;
        let message = dyelapse::scenario::Experiment::parse("t", origin, text(strokes))
            .expect_err(strokes)
            .to_string();
        assert!(message.contains(place), "{message}");
    }
}
