//! What cloth looks like, and cloth that is dyed before it is woven or read off a photograph.

mod common;

use common::{dyed, experiment, ledger};
use dyelapse::prelude::*;
use dyelapse::scenario::{Origin, Side};
use dyelapse::schedule::TheExperiment;
use dyelapse::texture::Texture;

const KASURI: &str =
    "kasuri: (weft: Sections(pattern: Disc(diameter: Cells(30)), shift: Cells(0)))";

fn cloth(more: &str, rest: &str) -> String {
    format!(
        "(title: \"t\", cloth: (size: (Cells(60), Cells(50)), warp: (width: Cells(4), gap: Cells(1)), {more}),
          process: (duration: Steps(1000)), {rest})"
    )
}

fn picture(text: &str, steps: u64) -> Picture {
    dyed(experiment(text), steps)
        .world()
        .resource::<Picture>()
        .clone()
}

/// Mean brightness of a picture within some columns and rows, 0 to 255.
fn brightness(picture: &Picture, columns: std::ops::Range<usize>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for row in picture.rgb.chunks(3 * picture.width) {
        for channel in &row[3 * columns.start..3 * columns.end] {
            sum += f64::from(*channel);
            count += 1.0;
        }
    }
    sum / count
}

#[test]
fn yarns_dyed_before_weaving_bring_their_dye_and_the_ledger_knows_it() {
    let app = dyed(experiment(&cloth(KASURI, "supply: []")), 500);
    let ledger = ledger(&app);
    assert!(ledger.bound > 10.0 && ledger.free == 0.0);
    assert!(ledger.imbalance().abs() < 1e-9 * ledger.supplied);
    let cloth = app.world().resource::<Cloth>();
    let bound = app.world().resource::<BoundDye>();
    for (i, amount) in bound.amount.iter().enumerate() {
        let (layer, y, x) = cloth.grid.place(i);
        let most = 0.9 * cloth.capacity_bound(layer, y, x) + 1e-6;
        assert!((0.0..=most).contains(amount));
        assert!(
            layer == Layer::Weft || *amount == 0.0,
            "the warp was not dyed"
        );
    }
}

#[test]
fn cloth_of_dyed_yarns_can_be_dyed_again_and_loses_none_of_its_dye() {
    for solver in ["Explicit", "Accelerated"] {
        let supply = "supply: [Dose(shape: Everywhere, dose: 0.6)], adsorption: (isotherm: Langmuir(kl: 20))";
        let text =
            cloth(KASURI, supply).replace("Steps(1000)", &format!("Steps(1000), solver: {solver}"));
        let before = dyed(experiment(&text), 0);
        let after = dyed(experiment(&text), 800);
        let amount = |app: &bevy::app::App| app.world().resource::<BoundDye>().amount.clone();
        let more = amount(&before)
            .into_iter()
            .zip(amount(&after))
            .map(|(before, after)| f64::from(after) - f64::from(before));
        let (mut least, mut most) = (0.0_f64, 0.0_f64);
        for change in more {
            least = least.min(change);
            most = most.max(change);
        }
        assert!(least >= 0.0 && most > 0.01, "{solver}: {least} to {most}");
        let ledger = ledger(&after);
        assert!(ledger.imbalance().abs() < 1e-6 * ledger.supplied);
    }
}

#[test]
fn a_cloth_turned_over_twice_is_the_cloth() {
    let app = dyed(
        experiment(&cloth("weave: Twill(over: 3, under: 1)", "supply: []")),
        0,
    );
    let cloth = app.world().resource::<Cloth>();
    let (back, again) = (cloth.turned_over(), cloth.turned_over().turned_over());
    let Grid { nx, ny } = cloth.grid;
    for y in 0..ny {
        for x in 0..nx {
            let fibre = |cloth: &Cloth, x| Layer::BOTH.map(|layer| cloth.fibre(layer, y, x));
            assert_eq!(fibre(cloth, x), fibre(&back, nx - 1 - x));
            assert_eq!(fibre(cloth, x), fibre(&again, x));
            if fibre(cloth, x) == [true; 2] {
                assert_ne!(cloth.warp_up(y, x), back.warp_up(y, nx - 1 - x));
                assert_eq!(cloth.warp_up(y, x), again.warp_up(y, x));
            }
        }
    }
}

#[test]
fn the_back_of_a_warp_faced_satin_shows_its_dyed_weft() {
    let satin = format!("weave: Satin(shafts: 8, counter: 3, face: Warp), {KASURI}");
    let side = |side| {
        let look = format!("supply: [], look: (side: {side})");
        brightness(&picture(&cloth(&satin, &look), 0), 20..40)
    };
    assert!(side("Back") + 30.0 < side("Face"));
}

#[test]
fn dye_on_the_left_of_the_face_is_on_the_right_of_the_back() {
    let supply = "supply: [Dose(shape: Disc(diameter: Cells(20), centre: (0.2, 0.5)))]";
    let halves = |side: &str| {
        let picture = picture(&cloth("", &format!("{supply}, look: (side: {side})")), 10);
        brightness(&picture, 0..30) - brightness(&picture, 30..60)
    };
    assert!(halves("Face") < -5.0 && halves("Back") > 5.0);
}

#[test]
fn every_look_shows_the_same_dye_in_the_same_places() {
    for texture in ["Shaded", "Fractal(())", "Fractal((relief: 0.0))"] {
        for scale in [1, 3] {
            let look = format!("look: (texture: {texture}, pixels_per_cell: {scale})");
            let supply = "supply: [Dose(shape: Rectangle(size: (Cells(20), Cells(50))))]";
            let picture = picture(&cloth("", &format!("{supply}, {look}")), 10);
            let dark = brightness(&picture, 25 * scale..35 * scale);
            let light = brightness(&picture, 0..10 * scale);
            assert!(
                dark + 60.0 < light,
                "{texture} at {scale}: {dark} and {light}"
            );
        }
    }
}

#[test]
fn a_picture_twice_as_large_shows_the_same_cloth() {
    let supply = "supply: [Dose(shape: Disc(diameter: Cells(30)))]";
    let at = |scale: usize| {
        let text = cloth("", &format!("{supply}, look: (pixels_per_cell: {scale})"));
        let picture = picture(&text, 50);
        // One value a cloth cell of 5 by 5 cells.
        let mean = |cell: usize| {
            let (cx, cy) = (cell % 12, cell / 12);
            let mut sum = 0.0;
            for y in cy * 5 * scale..(cy + 1) * 5 * scale {
                for x in cx * 5 * scale..(cx + 1) * 5 * scale {
                    sum += f64::from(picture.rgb[3 * (y * picture.width + x)]);
                }
            }
            sum / (25 * scale * scale) as f64
        };
        (0..120).map(mean).collect::<Vec<_>>()
    };
    let (small, large) = (at(2), at(8));
    for (a, b) in small.iter().zip(&large) {
        assert!((a - b).abs() < 16.0, "{a} and {b}");
    }
}

/// A folder with a photograph and a mask of a cloth of 40 by 30 cells: weft everywhere but in a square.
fn photographed() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let photo = image::RgbImage::from_fn(40, 30, |x, _| image::Rgb([200 + (x % 4) as u8 * 10; 3]));
    photo.save(folder.path().join("photo.png")).unwrap();
    let mask = image::RgbImage::from_fn(40, 30, |x, y| {
        image::Rgb(if (10..20).contains(&x) && (10..20).contains(&y) {
            [20, 10, 230]
        } else {
            [240, 30, 10]
        })
    });
    mask.save(folder.path().join("mask.png")).unwrap();
    folder
}

const PHOTO: &str =
    "(title: \"t\", cloth: (size: (Cells(40), Cells(30)), weave: Mask(file: \"mask.png\"),
      warp: (width: Cells(5), gap: Cells(0)),
      kasuri: (warp: Sections(pattern: Everywhere))),
    supply: [], process: (duration: Steps(1)),
    look: (texture: Photo(file: \"photo.png\"), colours: Indigo))";

#[test]
fn in_a_photographed_cloth_each_pixel_shows_the_yarn_that_its_mask_names() {
    let folder = photographed();
    let origin = Origin::File(folder.path().join("scenario.ron"));
    let experiment = Experiment::parse("scenario.ron", origin, PHOTO.into()).unwrap();
    let app = dyed(experiment, 0);
    let picture = app.world().resource::<Picture>();
    for (i, pixel) in picture.rgb.chunks(3).enumerate() {
        let (x, y) = (i % 40, i / 40);
        let warp = (10..20).contains(&x) && (10..20).contains(&y);
        // Only the warp is dyed.
        assert_eq!(pixel[0] < 100, warp, "{x}, {y}: {pixel:?}");
    }
    let world = app.world();
    let experiment = world.resource::<TheExperiment>();
    let back = Texture::new(
        world.resource::<Cloth>(),
        &experiment.scenario,
        &experiment.images,
        1,
        Side::Back,
    );
    let mut behind = Picture::default();
    let (free, bound) = (world.resource(), world.resource());
    back.draw(world.resource(), free, bound, &mut behind);
    let dark = |picture: &Picture| picture.rgb.chunks(3).filter(|pixel| pixel[0] < 100).count();
    assert_eq!(dark(&behind), 40 * 30 - dark(picture));
}

#[test]
fn masks_and_photographs_that_do_not_match_are_told_with_both_sizes() {
    let folder = photographed();
    let origin = Origin::File(folder.path().join("scenario.ron"));
    let parse = |text: String| {
        Experiment::parse("scenario.ron", origin.clone(), text)
            .unwrap_err()
            .to_string()
    };
    let told = parse(PHOTO.replace("(Cells(40), Cells(30))", "(Cells(41), Cells(30))"));
    assert!(told.contains("40×30") && told.contains("41×30"), "{told}");
    let told = parse(PHOTO.replace("gap: Cells(0)", "gap: Cells(1)"));
    assert!(told.contains("no gaps"), "{told}");
    std::fs::write(folder.path().join("photo.png"), [0; 10]).unwrap();
    let told = parse(PHOTO.into());
    assert!(
        told.contains("photo.png") && told.contains("scenario.ron:5:"),
        "{told}"
    );
}

#[test]
fn a_cloth_woven_from_a_draft_has_its_interlacing_its_colours_and_its_measures() {
    for name in dyelapse::draft::bundled_names() {
        let draft = dyelapse::draft::Draft::load(name).unwrap().draft;
        let text = format!(
            "(title: \"t\", cloth: (size: (Cells(300), Cells(200)), weave: Wif(file: \"{name}\")),
              supply: [], process: (duration: Steps(1)))"
        );
        let app = dyed(experiment(&text), 0);
        let cloth = app.world().resource::<Cloth>();
        let (weave, repeat) = (draft.drawdown(), (draft.warp().len(), draft.weft().len()));
        for (i, (y, x)) in (0..200)
            .flat_map(|y| (0..300).map(move |x| (y, x)))
            .enumerate()
        {
            let (e, p) = (cloth.warp.number(x), cloth.weft.number(y));
            let up = weave.warp_up(e % repeat.0, p % repeat.1);
            assert_eq!(cloth.warp_up(y, x), up, "{name}, cell {i}");
        }
        for (yarns, threads) in [(&cloth.warp, draft.warp()), (&cloth.weft, draft.weft())] {
            for (i, (yarn, span)) in yarns.yarns.iter().zip(yarns.spans()).enumerate() {
                let thread = &threads[i % threads.len()];
                let colour = thread.colour.unwrap_or([255; 3]);
                assert_eq!(yarn.colour, colour.map(|c| f32::from(c) / 255.0));
                if let Some(spacing) = thread.spacing_mm {
                    let pitch = span.pitch() as f64 * cloth.cell_mm;
                    assert!(
                        (pitch - spacing).abs() <= 0.5 * cloth.cell_mm + 1e-9,
                        "{name}"
                    );
                }
            }
        }
    }
}

#[test]
fn measures_of_the_scenario_can_be_laid_on_a_draft() {
    let text = "(title: \"t\", cloth: (size: (Cells(60), Cells(40)),
          weave: Wif(file: \"houndstooth\", measures: Yarns), warp: (width: Cells(3), gap: Cells(2))),
        supply: [], process: (duration: Steps(1)))";
    let app = dyed(experiment(text), 0);
    let cloth = app.world().resource::<Cloth>();
    let all = cloth.warp.spans().iter().chain(cloth.weft.spans());
    assert!(all.clone().count() > 10);
    for span in all {
        assert_eq!((span.width, span.gap), (3, 2));
    }
}
