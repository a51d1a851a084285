//! Batik as a scenario: wax, dye, wax again, dye darker, boil.

mod common;

use common::{dyed, experiment, go_on, ledger};
use dyelapse::batik::stage::Batik;
use dyelapse::prelude::*;
use dyelapse::scenario::Origin;

/// Two baths on 120 by 90 cells; the first wax keeps a disc, the second one a larger one.
fn recipe(batik: &str, more: &str) -> String {
    format!(
        "(title: \"t\", seed: 4,
          cloth: (size: (Cells(120), Cells(90)), warp: (width: Cells(5), gap: Cells(1),
            vary_porosity: (0.5, 1.0), twist: 0.025)),
          batik: ({batik} steps: [
            Wax(pattern: Disc(diameter: Cells(40)), crackle: (density: 0)),
            Dye(colour: (10, 0.8, 0.6), lasts: Steps(6)),
            Wax(pattern: Disc(diameter: Cells(70)), crackle: (density: 0)),
            Dye(colour: (220, 0.8, 0.5), lasts: Steps(6)),
            Boil,
          ]),
          supply: [], process: (duration: Steps(15)) {more})"
    )
}

/// The mean colour around a place, 0 to 255.
fn colour(picture: &Picture, (x, y): (usize, usize)) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for dy in 0..6 {
        for dx in 0..6 {
            let at = 3 * ((y + dy) * picture.width + x + dx);
            (0..3).for_each(|i| sum[i] += f64::from(picture.rgb[at + i]) / 36.0);
        }
    }
    sum
}

const WHITE: (usize, usize) = (57, 42);
const RED: (usize, usize) = (57, 14);
const BOTH: (usize, usize) = (4, 4);

#[test]
fn what_was_waxed_twice_is_white_what_was_waxed_once_red_and_the_rest_has_both_dyes() {
    for look in ["", ", look: (texture: Ellipses(()))"] {
        let app = dyed(experiment(&recipe("", look)), 15);
        let picture = app.world().resource::<Picture>();
        let [white, red, both] = [WHITE, RED, BOTH].map(|place| colour(picture, place));
        assert!(white.iter().all(|channel| *channel > 150.0), "{white:?}");
        assert!(red[0] > red[2] + 40.0, "{red:?}");
        assert!(
            both.iter().sum::<f64>() < red.iter().sum::<f64>(),
            "{both:?}"
        );
        assert!((0..3).all(|i| both[i] < white[i]));
    }
}

#[test]
fn the_ledger_balances_at_every_moment_of_a_recipe() {
    for more in ["", "rinsed"] {
        let text = recipe("", "");
        let text = match more {
            "" => text,
            _ => text.replace("lasts: Steps(6)", "lasts: Steps(6), rinse: true"),
        };
        let mut app = dyed(experiment(&text), 0);
        for step in 1..=15 {
            go_on(&mut app, step);
            let ledger = ledger(&app);
            assert!(
                ledger.imbalance().abs() <= 1e-6 * ledger.supplied,
                "step {step}"
            );
            assert_eq!(app.world().resource::<Batik>().truncated(), 0);
        }
        assert_eq!(ledger(&app).removed > 1.0, more == "rinsed");
    }
}

#[test]
fn looking_often_changes_no_batik() {
    let text = recipe("", "");
    let mut often = dyed(experiment(&text), 0);
    (1..=15).for_each(|step| go_on(&mut often, step));
    let once = dyed(experiment(&text), 15);
    assert!(often.world().resource::<Picture>() == once.world().resource::<Picture>());
}

#[test]
fn what_is_done_at_every_moment_is_told_in_order() {
    let experiment = experiment(&recipe("", ""));
    let batik = experiment.scenario.batik.as_ref().unwrap();
    let told = [0, 1, 6, 7, 8, 14, 15].map(|step| batik.told(step, 0.0005));
    let expected = [
        "1. waxed",
        "2. dyed, 0 of 6 scans",
        "2. dyed, 5 of 6 scans",
        "3. waxed",
        "4. dyed, 0 of 6 scans",
        "5. boiled",
        "5. boiled",
    ];
    assert_eq!(told, expected);
}

#[test]
fn from_the_back_wax_and_dye_lie_in_mirrored_places() {
    let batik = |side: &str, show: &str| {
        let wax = "Rectangle(size: (Cells(60), Cells(90)), centre: (0.25, 0.5))";
        let text = recipe(
            &format!("show: {show},"),
            &format!(", look: (side: {side})"),
        )
        .replace("Disc(diameter: Cells(40))", wax)
        .replace("Disc(diameter: Cells(70))", wax);
        dyed(experiment(&text), 6)
            .world()
            .resource::<Picture>()
            .clone()
    };
    for show in ["Cloth", "Drawing", "Permeation"] {
        let left = |side| {
            let picture = batik(side, show);
            let light = |x| colour(&picture, (x, 40)).iter().sum::<f64>();
            light(20) - light(95)
        };
        let (face, back) = (left("Face"), left("Back"));
        assert!(face * back < 0.0, "{show}: {face} and {back}");
    }
}

#[test]
fn one_drawing_can_be_taken_on_either_ground() {
    let folder = tempfile::tempdir().unwrap();
    let half =
        image::RgbImage::from_fn(40, 30, |x, _| image::Rgb([if x < 20 { 0 } else { 255 }; 3]));
    half.save(folder.path().join("half.png")).unwrap();
    let text = "(title: \"t\", cloth: (size: (Cells(40), Cells(30))), supply: [],
      batik: (show: Drawing, steps: [
        Wax(drawing: \"half.png\", ground: Light, crackle: (density: 0)), Boil,
        Wax(drawing: \"half.png\", ground: Dark, crackle: (density: 0)), Boil]),
      process: (duration: Steps(4)))";
    let origin = Origin::File(folder.path().join("scenario.ron"));
    let mut app = dyed(
        Experiment::parse("scenario.ron", origin, text.into()).unwrap(),
        0,
    );
    let left = |app: &bevy::app::App| colour(app.world().resource::<Picture>(), (5, 10))[0];
    assert!(left(&app) < 50.0);
    go_on(&mut app, 2);
    assert!(left(&app) > 200.0);
}

#[test]
fn what_a_recipe_would_ignore_is_refused() {
    let told = |from: &str, to: &str| {
        let text = recipe("", "").replacen(from, to, 1);
        Experiment::parse("t", Origin::Memory, text)
            .unwrap_err()
            .to_string()
    };
    let cloth = "vary_porosity: (0.5, 1.0), twist: 0.025)";
    let kasuri = format!("{cloth}, kasuri: (warp: Sections(pattern: Everywhere))");
    for (from, to, expected) in [
        (
            "supply: []",
            "supply: [Dose(shape: Everywhere)]",
            "`supply`",
        ),
        ("supply: []", "supply: [], resist: Everywhere", "`resist`"),
        ("supply: []", "supply: [], adsorption: ()", "`adsorption`"),
        ("supply: []", "supply: [], dye: (equilibrium: 0.5)", "`dye`"),
        (
            "supply: []",
            "supply: [], look: (colours: Walnut)",
            "`look.colours`",
        ),
        (
            "supply: []",
            "supply: [], look: (show: BoundOnly)",
            "`look`",
        ),
        (cloth, kasuri.as_str(), "`cloth.kasuri`"),
    ] {
        let told = told(from, to);
        assert!(told.contains(expected), "{told}");
    }
}

#[test]
fn wax_is_seen_until_it_is_boiled_off() {
    let at = |batik: &str, step| {
        let app = dyed(experiment(&recipe(batik, "")), step);
        colour(app.world().resource::<Picture>(), WHITE)
    };
    // Wax is yellowish: it takes blue away.
    let (waxed, bare) = (at("", 0), at("show_wax: false,", 0));
    assert!(waxed[2] + 10.0 < bare[2], "{waxed:?} {bare:?}");
    assert_eq!(at("", 15), at("show_wax: false,", 15));
}

#[test]
fn the_solvers_of_paper_d_dye_the_same_places_through_the_same_wax() {
    let solvers = "solver: Diffusion,";
    let more = ", adsorption: (isotherm: Langmuir(kl: 20))";
    let text = recipe(solvers, more)
        .replace("Steps(6)", "Steps(200)")
        .replace("duration: Steps(15)", "duration: Steps(403)")
        .replace("twist: 0.025", "twist: 0.5");
    let app = dyed(experiment(&text), 403);
    let picture = app.world().resource::<Picture>();
    let [white, red, both] = [WHITE, RED, BOTH].map(|place| colour(picture, place));
    assert!(white.iter().all(|channel| *channel > 150.0), "{white:?}");
    assert!(red[0] > red[2] + 20.0, "{red:?}");
    assert!(
        both.iter().sum::<f64>() < red.iter().sum::<f64>(),
        "{both:?}"
    );
    let ledger = ledger(&app);
    assert!(ledger.supplied > 100.0);
    assert!(ledger.imbalance().abs() <= 1e-6 * ledger.supplied);
}

#[test]
fn one_seed_cracks_one_way_and_another_another() {
    let picture = |seed: u32| {
        let text = recipe("", "")
            .replace("density: 0", "density: 0.05")
            .replace("seed: 4", &format!("seed: {seed}"));
        dyed(experiment(&text), 15)
            .world()
            .resource::<Picture>()
            .clone()
    };
    assert!(picture(1) == picture(1));
    assert!(picture(1) != picture(2));
}

#[test]
fn mistakes_in_a_recipe_are_told_with_their_place() {
    let told = |from: &str, to: &str| {
        let text = recipe("", "").replacen(from, to, 1);
        Experiment::parse("t", Origin::Memory, text)
            .unwrap_err()
            .to_string()
    };
    let cases = [
        ("duration: Steps(15)", "duration: Steps(20)", "`Steps(15)`"),
        (
            "lasts: Steps(6)",
            "lasts: Steps(0)",
            "batik.steps[1].Dye.lasts",
        ),
        (
            "density: 0",
            "density: 7",
            "batik.steps[0].Wax.crackle.density",
        ),
        (
            "pattern: Disc(diameter: Cells(40))",
            "drawing: \"none.png\"",
            "none.png",
        ),
        ("pattern: Disc(diameter: Cells(40)),", "", "one of both"),
        (
            "(10, 0.8, 0.6)",
            "(10, 0.8, 6)",
            "batik.steps[1].Dye.colour[2]",
        ),
    ];
    for (from, to, expected) in cases {
        let told = told(from, to);
        assert!(told.contains(expected), "{told}");
    }
}
