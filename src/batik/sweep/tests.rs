//! Laws of the sweeps.

use super::*;
use crate::batik::noise;
use crate::batik::permeation::{PermeationSpec, permeation};
use crate::batik::tests::woven;
use crate::pattern::Raster;

fn exchange(nx: usize, ny: usize, in_water: f64, classes: Classes) -> Exchange {
    let spec = ExchangeSpec {
        in_water,
        classes,
        ..ExchangeSpec::default()
    };
    Exchange::of(&woven(nx, ny, 5, 1), &spec, 9)
}

fn physical(nx: usize, ny: usize) -> Exchange {
    exchange(nx, ny, 1.93 * 80.0, Classes::PHYSICAL)
}

/// Wax with holes of all kinds.
fn patchy(nx: usize, ny: usize) -> Raster {
    Raster::from_rule(nx, ny, |x, y| {
        let (i, j) = (x as u32 / 6, y as u32 / 6);
        let value = noise::uniform(3, i, j);
        if value < 0.5 { 0.0 } else { value }
    })
}

/// Dye here and there.
fn spotty(nx: usize, ny: usize) -> Dye {
    let mut dye = Dye::none(nx, ny);
    for (i, f) in dye.free.iter_mut().enumerate() {
        *f = noise::uniform(5, i as u32, 0);
    }
    for (i, h) in dye.bound.iter_mut().enumerate() {
        *h = 0.5 * noise::uniform(5, i as u32, 1);
    }
    dye
}

#[test]
fn tiles_give_the_same_bits_as_the_plain_loop() {
    let bath = BathSpec::default();
    for (nx, ny) in [
        (1, 1),
        (1, 70),
        (70, 1),
        (63, 64),
        (64, 63),
        (65, 130),
        (200, 66),
        (131, 200),
    ] {
        let (exchange, p) = (physical(nx, ny), patchy(nx, ny));
        let mut plain = spotty(nx, ny);
        let mut tiles = PixelDiffusing::new(&exchange, &p, &bath, &plain);
        let mut account = Account::default();
        for _ in 0..3 {
            plain::scan(&mut plain, &exchange, &p, &bath, &mut account);
            tiles.scan();
        }
        assert!(plain == tiles.dye(), "{nx}×{ny}");
        let sums = tiles.account();
        let close = |a: f64, b: f64| (a - b).abs() < 1e-5 * account.supplied.max(1.0);
        assert!(close(account.supplied, sums.supplied) && close(account.made, sums.made));
    }
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let (exchange, p, bath) = (physical(300, 280), patchy(300, 280), BathSpec::default());
    let dyed = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut tiles = PixelDiffusing::new(&exchange, &p, &bath, &Dye::none(300, 280));
            (0..4).for_each(|_| tiles.scan());
            (tiles.dye(), tiles.account())
        })
    };
    assert!(dyed(1) == dyed(2) && dyed(1) == dyed(5));
}

#[test]
fn dye_stays_within_its_bounds_and_is_never_truncated() {
    let (nx, ny) = (90, 75);
    for classes in [Classes::PRINTED, Classes::PHYSICAL] {
        for in_water in [0.0, 1.93, 150.0, 1e4, 1e8] {
            for (supply, binding, most_bound) in [
                (0.5, 1.0, 1.0),
                (0.5, 0.0, 0.0),
                (0.05, 0.3, 0.5),
                (0.0, 1.0, 0.2),
            ] {
                let bath = BathSpec {
                    concentration: 1.0,
                    supply,
                    binding,
                    most_bound,
                };
                let exchange = exchange(nx, ny, in_water, classes);
                let mut dye = spotty(nx, ny);
                dye.bound
                    .iter_mut()
                    .for_each(|h| *h *= 2.0 * most_bound as f32);
                // The extremes themselves, side by side.
                dye.free.iter_mut().step_by(3).for_each(|f| *f = f.round());
                let mut tiles = PixelDiffusing::new(&exchange, &patchy(nx, ny), &bath, &dye);
                for _ in 0..20 {
                    tiles.scan();
                }
                assert_eq!(tiles.account().truncated, 0);
                let dye = tiles.dye();
                assert!(dye.free.iter().all(|f| (0.0..=1.0).contains(f)));
                let most = most_bound as f32 * (1.0 + 1e-6);
                assert!(dye.bound.iter().all(|h| (0.0..=most).contains(h)));
            }
        }
    }
}

#[test]
fn gamma_is_below_one_and_no_larger_one_would_do() {
    // Free of exchange and binding, all of α = ½ could be taken twice over.
    let none = exchange(20, 20, 0.0, Classes::PHYSICAL);
    let open = Raster::uniform(20, 20, 1.0);
    let bath = BathSpec {
        binding: 0.0,
        ..BathSpec::default()
    };
    let tiles = PixelDiffusing::new(&none, &open, &bath, &Dye::none(20, 20));
    assert!(tiles.gamma() < 1.0 && tiles.gamma() > 0.999_99);
    // Where exchange is fast, γ times what the most open cell gives away is just below 1.
    let fast = exchange(20, 20, 1e4, Classes::PHYSICAL);
    let gamma = f64::from(PixelDiffusing::new(&fast, &open, &bath, &Dye::none(20, 20)).gamma());
    let cells = (0..800).map(|i| fast.sum(i / 400, i % 400 / 20, i % 20));
    let most = cells.fold(0.0, f64::max) + 0.5;
    assert!(gamma * most < 1.0 && gamma * most > 0.999_99);
}

#[test]
fn the_ledger_balances_with_what_the_bath_gave_and_what_updates_in_place_made() {
    let (nx, ny) = (150, 140);
    for classes in [Classes::PRINTED, Classes::PHYSICAL] {
        let exchange = exchange(nx, ny, 1.93 * 80.0, classes);
        let begin = spotty(nx, ny);
        let mut tiles =
            PixelDiffusing::new(&exchange, &patchy(nx, ny), &BathSpec::default(), &begin);
        for _ in 0..16 {
            tiles.scan();
            let account = tiles.account();
            let missing = tiles.dye().total() - begin.total() - account.supplied - account.made;
            assert!(
                missing.abs() < 1e-6 * begin.total(),
                "{missing} of {}",
                begin.total()
            );
        }
        // In place is not in step: what it makes is small beside what the bath gives, but not nothing.
        let account = tiles.account();
        assert!(account.supplied > 0.0 && account.made.abs() < 0.5 * account.supplied);
    }
}

#[test]
fn evenly_dyed_cloth_out_of_the_bath_stays_as_it_is() {
    let mut dye = Dye::none(80, 70);
    dye.free.fill(0.625);
    let bath = BathSpec {
        binding: 0.0,
        supply: 0.0,
        ..BathSpec::default()
    };
    let mut tiles = PixelDiffusing::new(
        &physical(80, 70),
        &Raster::uniform(80, 70, 1.0),
        &bath,
        &dye,
    );
    (0..5).for_each(|_| tiles.scan());
    assert!(tiles.dye() == dye);
}

#[test]
fn cloth_turned_by_half_a_turn_ends_up_with_the_turned_dye() {
    // A scan is a sweep and its mirror image, so what differs is only which of them comes first.
    let (nx, ny) = (66, 66);
    let exchange = physical(nx, ny);
    let turned = Exchange {
        right: exchange.right.clone().map(|field| turn_faces(&field, 1)),
        down: exchange.down.clone().map(|field| turn_faces(&field, nx)),
        between: exchange.between.iter().rev().copied().collect(),
        ..exchange
    };
    let p = patchy(nx, ny);
    let back = Raster {
        values: p.values.iter().rev().copied().collect(),
        ..p.clone()
    };
    let bath = BathSpec::default();
    let mut one = PixelDiffusing::new(&exchange, &p, &bath, &Dye::none(nx, ny));
    let mut other = PixelDiffusing::new(&turned, &back, &bath, &Dye::none(nx, ny));
    for _ in 0..60 {
        one.scan();
        other.scan();
    }
    let (one, other) = (one.dye().free, other.dye().free);
    let layer = nx * ny;
    let apart = one.iter().enumerate().map(|(i, f)| {
        let turned = i / layer * layer + (layer - 1 - i % layer);
        (f - other[turned]).abs()
    });
    let worst = apart.fold(0.0, f32::max);
    assert!(worst < 0.005, "{worst}");
}

/// Faces of a field turned by half a turn: the face after a cell becomes the one before it.
fn turn_faces(field: &[f32], step: usize) -> Vec<f32> {
    let len = field.len();
    (0..len)
        .map(|i| (len - 1 - i).checked_sub(step).map_or(0.0, |j| field[j]))
        .collect()
}

/// Columns to the left of this one are open.
const EDGE: usize = 40;

/// Mean dye beside an upright edge, of as many columns as a yarn and its gap have from each column
/// on: open to the left.
fn profile(dye: &Dye, nx: usize, ny: usize) -> Vec<f64> {
    let columns = |layer: usize, x: usize| (0..ny).map(move |y| (layer * ny + y) * nx + x);
    let of_column = |x: usize| {
        let cells = columns(0, x).chain(columns(1, x));
        cells.map(|i| f64::from(dye.free[i])).sum::<f64>() / (2 * ny) as f64
    };
    let means: Vec<f64> = (0..nx).map(of_column).collect();
    means
        .windows(6)
        .map(|own| own.iter().sum::<f64>() / 6.0)
        .collect()
}

/// Where a profile last falls below a level, in columns.
fn falls_below(profile: &[f64], level: f64) -> f64 {
    let last = profile.iter().rposition(|f| *f >= level).unwrap_or(0);
    let (above, below) = (profile[last], profile[last + 1]);
    last as f64 + (above - level) / (above - below)
}

/// Unevenness along an upright edge: the spread of dye over the rows, summed over the columns of wax.
fn mottle(dye: &Dye, nx: usize, ny: usize) -> f64 {
    let f = |layer: usize, y: usize, x: usize| f64::from(dye.free[(layer * ny + y) * nx + x]);
    (EDGE..nx)
        .map(|x| {
            let mean = (0..ny).map(|y| f(0, y, x)).sum::<f64>() / ny as f64;
            let square = (0..ny)
                .map(|y| (f(0, y, x) - mean) * (f(0, y, x) - mean))
                .sum::<f64>();
            (square / ny as f64).sqrt()
        })
        .sum()
}

#[test]
fn edges_fade_in_steps_that_widen_and_grow_mottled_from_4_to_16_scans() {
    let (nx, ny) = (96, 240);
    let drawing = Raster::from_rule(nx, ny, |x, _| if x < EDGE as f64 { 1.0 } else { 0.0 });
    let p = permeation(&drawing, &PermeationSpec::default());
    for classes in [Classes::PRINTED, Classes::PHYSICAL] {
        let exchange = exchange(nx, ny, 1.93 * 80.0, classes);
        let mut tiles =
            PixelDiffusing::new(&exchange, &p, &BathSpec::default(), &Dye::none(nx, ny));
        let mut seen = Vec::new();
        for scan in 1..=16 {
            tiles.scan();
            if scan == 4 || scan == 16 {
                let dye = tiles.dye();
                let profile = profile(&dye, nx, ny);
                for pair in profile[EDGE - 6..].windows(2) {
                    assert!(pair[1] <= pair[0], "{pair:?}");
                }
                // From nine tenths of the dye in the open to a fiftieth of it.
                let falls = |share: f64| falls_below(&profile, share * profile[EDGE - 10]);
                seen.push((falls(0.02) - falls(0.9), mottle(&dye, nx, ny)));
                assert!(
                    profile[EDGE + 20..].iter().all(|f| *f < 0.02),
                    "20 cells into the wax"
                );
            }
        }
        let [(width4, mottle4), (width16, mottle16)] = [seen[0], seen[1]];
        assert!(mottle16 > 1.5 * mottle4, "{mottle4} {mottle16}");
        assert!(width16 > width4 + 0.3, "{width4} {width16}");
    }
}
