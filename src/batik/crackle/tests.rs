//! Laws of crackle.
#![allow(clippy::disallowed_methods)] // A test may use the platform's own functions.

use super::field::{Field, dot, length, minus, unit};
use super::*;
use crate::batik::distance::distance_to;

const SIDE: usize = 360;

/// Flowers that are open, on wax.
fn flowers() -> Raster {
    Raster::from_rule(SIDE, SIDE, |x, y| {
        let (dx, dy) = (x.rem_euclid(180.0) - 90.0, y.rem_euclid(180.0) - 90.0);
        let petal = 38.0 + 14.0 * (6.0 * dy.atan2(dx)).cos();
        if dx.hypot(dy) < petal { 1.0 } else { 0.0 }
    })
}

fn wax() -> Raster {
    Raster::uniform(SIDE, SIDE, 0.0)
}

fn grown(drawing: &Raster, spec: CrackleSpec, seed: u64) -> Crackle {
    Crackle::grow(drawing, &spec, None, Chance(seed))
}

fn dense() -> CrackleSpec {
    CrackleSpec {
        density: 0.06,
        ..CrackleSpec::default()
    }
}

/// Distance from a point to the course of a crack.
fn away(at: Point, crack: &Crack) -> f32 {
    let to_segment = |pair: &[Point]| {
        let along = minus(pair[1], pair[0]);
        let t = (dot(minus(at, pair[0]), along) / dot(along, along).max(1e-9)).clamp(0.0, 1.0);
        length(minus(
            at,
            [pair[0][0] + t * along[0], pair[0][1] + t * along[1]],
        ))
    };
    crack
        .line
        .windows(2)
        .map(to_segment)
        .fold(f32::INFINITY, f32::min)
}

#[test]
fn dye_reaches_every_crack_through_edges_and_other_cracks() {
    for drawing in [flowers(), wax()] {
        for seed in 0..5 {
            let network = grown(&drawing, dense(), seed).network;
            assert!(network.cracks.len() > 50);
            assert!(network.reached().iter().all(|reached| *reached));
        }
    }
}

#[test]
fn cracks_end_where_they_say() {
    let drawing = flowers();
    let network = grown(&drawing, dense(), 3).network;
    let from_open = distance_to(&drawing, 0.5);
    for (i, crack) in network.cracks.iter().enumerate() {
        for (end, at) in crack
            .ends
            .into_iter()
            .zip([crack.line[0], crack.line[crack.line.len() - 1]])
        {
            match end {
                End::Crack(other) => {
                    assert!(other < i, "a crack ends on an earlier one");
                    assert!(away(at, &network.cracks[other]) < 0.01);
                }
                End::Open => {
                    let (x, y) = (at[0] as usize, at[1] as usize);
                    assert!(from_open[y * SIDE + x] <= 1.5);
                }
                End::Border => {
                    let inside = |v: f32| v > 1.0 && v < SIDE as f32 - 1.0;
                    assert!(!(inside(at[0]) && inside(at[1])));
                }
                End::Tip => {}
            }
        }
    }
}

#[test]
fn cracks_run_in_wax_alone() {
    let drawing = flowers();
    let network = grown(&drawing, dense(), 1).network;
    for crack in &network.cracks {
        for at in &crack.line[1..crack.line.len() - 1] {
            assert!(drawing.at(at[1] as usize, at[0] as usize) < 0.5);
        }
    }
}

#[test]
fn later_cracks_meet_earlier_ones_at_nearly_right_angles() {
    let mut angles = Vec::new();
    for seed in 0..4 {
        let network = grown(&wax(), dense(), seed).network;
        for crack in network.cracks.iter().filter(|crack| crack.generation >= 2) {
            let End::Crack(other) = crack.ends[1] else {
                continue;
            };
            let line = &crack.line;
            if line.len() < 8 {
                continue;
            }
            let end = line[line.len() - 1];
            let way = unit(minus(end, line[line.len() - 5]));
            let other = &network.cracks[other].line;
            let nearest = (2..other.len().saturating_sub(2)).min_by(|a, b| {
                length(minus(other[*a], end)).total_cmp(&length(minus(other[*b], end)))
            });
            let Some(i) = nearest else { continue };
            let across = unit(minus(other[i + 2], other[i - 2]));
            angles.push(dot(way, across).abs().acos().to_degrees());
        }
    }
    angles.sort_by(f32::total_cmp);
    assert!(angles.len() > 100);
    let (median, tenth) = (angles[angles.len() / 2], angles[angles.len() / 10]);
    assert!(
        median > 70.0 && tenth > 40.0,
        "median {median}, lowest tenth {tenth}"
    );
}

#[test]
fn cracks_are_thinner_by_generation() {
    let mut widths = [(0.0, 0); 4];
    for seed in 0..4 {
        for crack in grown(&wax(), dense(), seed).network.cracks {
            if let Some((sum, count)) = widths.get_mut(crack.generation as usize) {
                *sum += crack.width;
                *count += 1;
            }
        }
    }
    let mean: Vec<f32> = widths
        .iter()
        .map(|(sum, count)| sum / *count as f32)
        .collect();
    assert!(mean.windows(2).all(|pair| pair[1] < pair[0]), "{mean:?}");
}

#[test]
fn density_is_the_length_of_cracks_over_the_area_of_wax() {
    let drawing = flowers();
    let waxed = drawing.values.iter().filter(|v| **v < 0.5).count() as f64;
    for density in [0.03, 0.06, 0.1] {
        let spec = CrackleSpec {
            density,
            crumple: 0.0,
            ..CrackleSpec::default()
        };
        let measured = grown(&drawing, spec, 2).network.length() / waxed;
        assert!(
            (measured / density - 1.0).abs() < 0.1,
            "{density}: {measured}"
        );
    }
    let whole = CrackleSpec {
        density: 0.0,
        ..CrackleSpec::default()
    };
    let whole = grown(&drawing, whole, 2);
    assert!(whole.network.cracks.is_empty() && whole.map.values.iter().all(|v| *v == 0.0));
}

#[test]
fn one_seed_is_one_crackle_and_another_seed_another() {
    let drawing = flowers();
    let (a, b, c) = (
        grown(&drawing, dense(), 7),
        grown(&drawing, dense(), 7),
        grown(&drawing, dense(), 8),
    );
    assert!(a.network == b.network && a.map == b.map);
    assert!(a.network != c.network);
    // Little of one cloth's crackle lies where the other's does.
    let both = a
        .map
        .values
        .iter()
        .zip(&c.map.values)
        .map(|(a, c)| a.min(*c))
        .sum::<f32>();
    let one = a.map.values.iter().sum::<f32>();
    assert!(both < 0.3 * one, "{both} of {one}");
}

#[test]
fn where_the_cloth_was_crumpled_cracks_are_denser() {
    let half = Raster::from_rule(SIDE, SIDE, |x, _| if x < 180.0 { 0.0 } else { 1.0 });
    let spec = CrackleSpec {
        crumple: 1.0,
        folds: 0.1,
        ..dense()
    };
    let crackle = Crackle::grow(&wax(), &spec, Some(&half), Chance(5));
    let sides = |right: bool| {
        let points = crackle.network.cracks.iter().flat_map(|crack| &crack.line);
        points.filter(|at| (at[0] >= 180.0) == right).count()
    };
    assert!(
        sides(true) > 2 * sides(false),
        "{} {}",
        sides(true),
        sides(false)
    );
}

#[test]
fn folds_run_the_way_the_cloth_was_folded() {
    for degrees in [0.0_f64, 40.0, 115.0] {
        let spec = CrackleSpec {
            direction: Some(degrees),
            folds: 1.0,
            ..dense()
        };
        let network = grown(&wax(), spec, 3).network;
        // Twice the angle, so that both ways along a line are one direction.
        let (mut c, mut s) = (0.0, 0.0);
        for crack in network.cracks.iter().filter(|crack| crack.generation == 0) {
            let way = minus(crack.line[crack.line.len() - 1], crack.line[0]);
            let angle = 2.0 * way[1].atan2(way[0]);
            c += length(way) * angle.cos();
            s += length(way) * angle.sin();
        }
        let mean = f64::from(0.5 * s.atan2(c)).to_degrees();
        let off = (mean - degrees + 90.0).rem_euclid(180.0) - 90.0;
        assert!(off.abs() < 15.0, "{degrees}: {mean}");
    }
}

#[test]
fn the_field_that_cracks_update_is_the_distance_transform_of_all_of_them() {
    let drawing = flowers();
    let network = grown(&drawing, dense(), 4).network;
    let mut field = Field::new(&drawing);
    let mut all = drawing.clone();
    for (i, crack) in network.cracks.iter().enumerate() {
        field.add(i, &crack.line);
        for at in crack.line.iter().filter(|at| field.holds(**at)) {
            all.values[at[1] as usize * SIDE + at[0] as usize] = 1.0;
        }
    }
    let transform = distance_to(&all, 0.5);
    for y in 0..SIDE {
        for x in 0..SIDE {
            let kept = field.distance([x as f32 + 0.5, y as f32 + 0.5]);
            // A cell's middle and a crack's point in it are up to 0.71 apart.
            let whole = transform[y * SIDE + x];
            assert!((kept - whole).abs() < 0.9, "{kept} {whole} at {x} {y}");
        }
    }
}

#[test]
fn cracks_open_wax_and_never_close_what_is_open() {
    let drawing = flowers();
    let crackle = grown(&drawing, dense(), 6);
    let both = crackle.over(&drawing);
    for ((both, drawn), crack) in both
        .values
        .iter()
        .zip(&drawing.values)
        .zip(&crackle.map.values)
    {
        assert!((0.0..=1.0).contains(both) && (0.0..=1.0).contains(crack));
        assert!(both >= drawn && *both >= crack - 1e-6);
    }
}

#[test]
fn cloth_without_wax_and_cloth_of_a_few_cells_do_no_harm() {
    for (nx, ny, open) in [
        (50, 40, 1.0),
        (1, 1, 0.0),
        (2, 7, 0.0),
        (300, 1, 0.0),
        (0, 0, 0.0),
    ] {
        let drawing = Raster::uniform(nx, ny, open);
        let spec = CrackleSpec {
            density: 2.0,
            ..CrackleSpec::default()
        };
        let crackle = grown(&drawing, spec, 1);
        assert_eq!(crackle.map.values.len(), nx * ny);
        assert!(open < 1.0 || crackle.network.cracks.is_empty());
    }
}
