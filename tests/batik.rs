//! Batik from a drawing to dyed cloth: the laws of the whole.

use std::path::Path;

use dyelapse::batik::crackle::{Crackle, CrackleSpec};
use dyelapse::batik::distance::distance_to;
use dyelapse::batik::drawing::{Drawing, DrawingError, Ground, Waxed};
use dyelapse::batik::permeation::{PermeationSpec, permeation};
use dyelapse::batik::sweep::{BathSpec, Dye, Exchange, ExchangeSpec, PixelDiffusing};
use dyelapse::chance::Chance;
use dyelapse::cloth::{Cloth, Layer};
use dyelapse::pattern::Raster;
use dyelapse::scenario::{ClothSpec, Images, YarnSpec, units::Length};

const SIDE: usize = 400;

/// Paper B's cloth: yarns of five cells, a gap of one, P = 0.5r, τ₁ = 0.025r.
fn cloth(seed: u64) -> Cloth {
    let yarn = YarnSpec {
        width: Length::Cells(5.0),
        gap: Length::Cells(1.0),
        porosity: 0.5,
        vary_porosity: (0.5, 1.0),
        twist: 0.025,
        vary_twist: (0.5, 1.0),
        ..YarnSpec::default()
    };
    let side = Length::Cells(SIDE as f64);
    let text = "(size: (Cells(400), Cells(400)))";
    let mut spec: ClothSpec = ron::from_str(text).expect("a cloth of defaults");
    spec.size = (side, side);
    spec.warp = yarn;
    Cloth::weave(
        &spec,
        &Images::default(),
        Raster::uniform(SIDE, SIDE, 0.0),
        Chance(seed),
    )
}

/// The design that comes with the program.
fn spray() -> Raster {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/scenarios/designs/spray.png");
    let drawing = Drawing::load(&file, Ground::Detect).expect("our own drawing");
    drawing.wax(SIDE, SIDE, Waxed::Ground)
}

/// The waxed cloth and what is in it after some scans.
fn dyed(drawing: &Raster, seed: u64, scans: usize) -> (Raster, PixelDiffusing) {
    let crackle = Crackle::grow(drawing, &CrackleSpec::default(), None, Chance(seed));
    let wax = crackle.over(drawing);
    let p = permeation(&wax, &PermeationSpec::default());
    let exchange = Exchange::of(&cloth(seed), &ExchangeSpec::default(), seed);
    let none = Dye::none(SIDE, SIDE);
    let mut bath = PixelDiffusing::new(&exchange, &p, &BathSpec::default(), &none);
    for _ in 0..scans {
        bath.scan();
    }
    (wax, bath)
}

fn mean_free(dye: &Dye, here: impl Fn(usize) -> bool) -> f64 {
    let layer = SIDE * SIDE;
    let cells = (0..2 * layer).filter(|i| here(i % layer));
    let (sum, count) = cells.fold((0.0, 0), |(sum, count), i| {
        (sum + f64::from(dye.free[i]), count + 1)
    });
    sum / f64::from(count.max(1))
}

#[test]
fn open_cloth_is_dyed_whole_wax_is_not_and_cracks_are() {
    let drawing = spray();
    for seed in [1, 2, 3] {
        let (wax, bath) = dyed(&drawing, seed, 16);
        let dye = bath.dye();
        let from_open = distance_to(&wax, 0.02);
        let from_drawn = distance_to(&drawing, 0.02);
        let open = mean_free(&dye, |i| wax.values[i] > 0.99);
        let whole = mean_free(&dye, |i| from_open[i] > 15.0);
        let cracked = mean_free(&dye, |i| wax.values[i] > 0.5 && from_drawn[i] > 15.0);
        assert!(open > 0.9, "{open}");
        assert!(whole < 0.001, "{whole}");
        assert!(cracked > 0.5, "{cracked}");
        // Not on the average alone: no cell of whole wax takes a fiftieth of the dye.
        let layer = SIDE * SIDE;
        let most = (0..2 * layer).filter(|i| from_open[i % layer] > 15.0);
        let most = most.map(|i| dye.free[i] + dye.bound[i]).fold(0.0, f32::max);
        assert!(most < 0.02, "{most}");
    }
}

#[test]
fn one_seed_is_one_cloth_and_another_seed_another() {
    let drawing = spray();
    let of = |seed| dyed(&drawing, seed, 4).1.dye();
    assert!(of(1) == of(1));
    let (one, other) = (of(1), of(2));
    let apart = one
        .free
        .iter()
        .zip(&other.free)
        .filter(|(a, b)| (**a - **b).abs() > 0.3);
    assert!(apart.count() > 1000);
}

#[test]
fn sixteen_scans_never_truncate_and_their_ledger_balances() {
    let (_, bath) = dyed(&spray(), 5, 16);
    let account = bath.account();
    assert_eq!(account.truncated, 0);
    let missing = bath.dye().total() - account.supplied - account.made;
    assert!(missing.abs() < 1e-6 * account.supplied, "{missing}");
}

#[test]
fn dye_fades_outwards_from_a_crack() {
    // One straight crack down the middle of the wax, between yarns' columns and on them.
    let drawing = Raster::from_rule(
        SIDE,
        SIDE,
        |x, _| if (x - 200.5).abs() < 1.0 { 1.0 } else { 0.0 },
    );
    let p = permeation(&drawing, &PermeationSpec::default());
    let exchange = Exchange::of(&cloth(1), &ExchangeSpec::default(), 1);
    let mut bath = PixelDiffusing::new(&exchange, &p, &BathSpec::default(), &Dye::none(SIDE, SIDE));
    (0..16).for_each(|_| bath.scan());
    let dye = bath.dye();
    let column = |x: usize| mean_free(&dye, |i| i % SIDE == x);
    for away in 1..9 {
        assert!(column(200 + away + 1) < column(200 + away));
        assert!(column(200 - away - 1) < column(200 - away));
    }
}

#[test]
fn dye_runs_farther_along_yarns_than_across_them() {
    // A row of open cells: warp yarns carry dye away from it, weft yarns do not.
    let drawing = Raster::from_rule(
        SIDE,
        SIDE,
        |_, y| if (y - 200.5).abs() < 3.0 { 1.0 } else { 0.0 },
    );
    let p = permeation(
        &drawing,
        &PermeationSpec {
            reach: 0.0,
            drawing: 1.0,
        },
    );
    let woven = cloth(4);
    let exchange = Exchange::of(&woven, &ExchangeSpec::default(), 4);
    let mut bath = PixelDiffusing::new(&exchange, &p, &BathSpec::default(), &Dye::none(SIDE, SIDE));
    (0..16).for_each(|_| bath.scan());
    let dye = bath.dye();
    let beside = |layer: Layer| {
        let cells = (206..220).flat_map(|y| (0..SIDE).map(move |x| (y, x)));
        let fibre = cells.filter(|(y, x)| woven.fibre(layer, *y, *x));
        fibre
            .map(|(y, x)| f64::from(dye.free[woven.grid.index(layer, y, x)]))
            .sum::<f64>()
    };
    assert!(beside(Layer::Warp) > 1.5 * beside(Layer::Weft));
}

#[test]
fn drawings_of_one_bit_are_read() {
    // A black square of 8×8 on white, 16×16 pixels, one bit each.
    const PNG: [u8; 81] = [
        137, 80, 78, 71, 13, 10, 26, 10, 0, 0, 0, 13, 73, 72, 68, 82, 0, 0, 0, 16, 0, 0, 0, 16, 1,
        0, 0, 0, 0, 55, 136, 194, 204, 0, 0, 0, 24, 73, 68, 65, 84, 120, 218, 99, 252, 207, 192,
        196, 0, 69, 12, 31, 248, 225, 108, 100, 196, 136, 164, 6, 0, 95, 112, 3, 26, 19, 198, 209,
        104, 0, 0, 0, 0, 73, 69, 78, 68, 174, 66, 96, 130,
    ];
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("square.png");
    std::fs::write(&file, PNG).expect("a file");
    let drawing = Drawing::load(&file, Ground::Detect).expect("a drawing");
    assert_eq!(drawing.drawn.values.iter().sum::<f32>(), 64.0);
}

#[test]
fn what_is_no_drawing_is_refused_by_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str, bytes: &[u8]| {
        let file = folder.path().join(name);
        std::fs::write(&file, bytes).expect("a file");
        file
    };
    let picture = |name: &str, width: u32, height: u32| {
        let file = folder.path().join(name);
        image::GrayImage::new(width, height)
            .save(&file)
            .expect("a picture");
        file
    };
    let load = |file: &Path| Drawing::load(file, Ground::Detect).expect_err("no drawing");
    // A picture that says in its head to be of 4,000,000,000 pixels a side.
    let mut huge = std::fs::read(picture("head.png", 16, 16)).expect("a picture");
    huge[16..24].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
    let cases = [
        (
            folder.path().join("missing.png"),
            "missing.png: it cannot be read",
        ),
        (folder.path().to_path_buf(), "it is a folder"),
        (
            file("words.png", b"these are words"),
            "words.png: pictures are PNG or JPEG",
        ),
        (file("huge.png", &huge), "huge.png"),
        (
            picture("tiny.png", 3, 20),
            "tiny.png has only 3×20 pixels; at least 8×8 are needed",
        ),
        (picture("empty.png", 30, 20), "empty.png is empty"),
    ];
    for (file, expected) in cases {
        let said = load(&file).to_string();
        assert!(said.contains(expected), "{said}");
    }
    let error = load(&folder.path().join("tiny.png"));
    assert!(matches!(
        error,
        DrawingError::TooSmall {
            width: 3,
            height: 20,
            ..
        }
    ));
}
