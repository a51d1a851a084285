//! Golden pictures: a change of how cloth looks is never an accident.
//!
//! `tests/golden/golden.ron` is a figure; each of its panels has a picture beside it. Pictures may
//! differ by what another machine rounds another way, and by no more than nobody sees.
//!
//! After a deliberate change: `DYELAPSE_ACCEPT=1 cargo test --release --test golden`, and look at
//! every picture that changed before it is committed.

mod perceptual;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use dyelapse::cloth::Weave;
use dyelapse::record::{PictureFile, draw_panels};
use dyelapse::scenario::{Colours, Figure};
use dyelapse::texture::Picture;
use perceptual::{Difference, difference};

/// Writes what the pictures are now over what they were to be.
const ACCEPT: &str = "DYELAPSE_ACCEPT";

/// What a picture may differ by, on the whole and in all but one pixel of a hundred.
const ALLOWED: Difference = Difference {
    mean: 0.002,
    most: 0.010,
};

fn is_allowed(found: Difference) -> bool {
    found.mean <= ALLOWED.mean && found.most <= ALLOWED.most
}

fn golden() -> Figure {
    Figure::of(&["tests/golden/golden.ron"]).unwrap_or_else(|why| panic!("{why}"))
}

fn file(label: &str) -> PathBuf {
    Path::new("tests/golden").join(format!("{label}.png"))
}

fn read(path: &Path) -> Option<Picture> {
    let image = image::open(path).ok()?.into_rgb8();
    Some(Picture {
        width: image.width() as usize,
        height: image.height() as usize,
        rgb: image.into_raw(),
    })
}

fn pictures(figure: &Figure) -> Vec<Picture> {
    draw_panels(figure, |_, _| true).unwrap().unwrap()
}

#[test]
fn cloth_looks_as_it_did() {
    let figure = golden();
    let mut wrong = Vec::new();
    for (picture, panel) in pictures(&figure).iter().zip(&figure.panels) {
        let golden = file(&panel.label);
        if std::env::var_os(ACCEPT).is_some() {
            let file = PictureFile::claim(&golden, true).unwrap();
            file.write(picture).unwrap();
        }
        let found =
            read(&golden).filter(|was| (was.width, was.height) == (picture.width, picture.height));
        let found = found.map(|was| difference(&was, picture));
        if found.is_some_and(is_allowed) {
            continue;
        }
        let now = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{}.png", panel.label));
        PictureFile::claim(&now, true)
            .unwrap()
            .write(picture)
            .unwrap();
        let (golden, now) = (golden.display(), now.display());
        wrong.push(match found {
            Some(by) => format!("{golden} differs by {by:.4?}: it is {now} now"),
            None => format!("{golden} is not there, or of another size: it is {now} now"),
        });
    }
    assert!(
        wrong.is_empty(),
        "{}\nAllowed is {ALLOWED:?}. If that is meant: {ACCEPT}=1 cargo test --release --test golden",
        wrong.join("\n")
    );
}

#[test]
fn every_golden_picture_belongs_to_a_panel_and_is_small() {
    let figure = golden();
    for entry in fs::read_dir("tests/golden").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ending| ending == "png") {
            let label = path.file_stem().unwrap().to_str().unwrap();
            assert!(
                figure.panels.iter().any(|panel| panel.label == label),
                "{label}"
            );
            assert!(fs::metadata(&path).unwrap().len() < 150_000, "{label}");
        }
    }
}

/// The pictures as they are now, by label.
fn unchanged(label: &str) -> &'static Picture {
    static PICTURES: OnceLock<BTreeMap<String, Picture>> = OnceLock::new();
    let drawn = PICTURES.get_or_init(|| {
        let figure = golden();
        let labels = figure.panels.iter().map(|panel| panel.label.clone());
        labels.zip(pictures(&figure)).collect()
    });
    &drawn[label]
}

/// How different the panels of these labels look after a change to their figure.
fn changed(labels: &[&str], change: impl Fn(&mut Figure)) -> Vec<Difference> {
    let mut figure = golden();
    figure
        .panels
        .retain(|panel| labels.contains(&panel.label.as_str()));
    change(&mut figure);
    let found = pictures(&figure);
    let panels = found.iter().zip(&figure.panels);
    panels
        .map(|(picture, panel)| {
            let found = difference(unchanged(&panel.label), picture);
            println!("{}: {found:.4?}", panel.label);
            found
        })
        .collect()
}

const WEAVES: [&str; 4] = ["plain", "twill", "satin", "herringbone"];

#[test]
fn a_changed_colour_is_noticed() {
    let all = ["plain", "twill", "satin", "afar", "yarn"];
    let found = changed(&all, |figure| {
        for panel in &mut figure.panels {
            let [lightest, mut middle, darkest] = Colours::Indigo.stops();
            // A little greener, where it is half dyed.
            middle.0 -= 12.0;
            panel.look.colours = Colours::Stops {
                lightest,
                middle,
                darkest,
            };
        }
    });
    assert!(found.iter().all(|found| !is_allowed(*found)), "{found:.4?}");
    let undyed = changed(&all, |figure| {
        for panel in &mut figure.panels {
            let [mut lightest, middle, darkest] = Colours::Indigo.stops();
            lightest.2 -= 0.02;
            panel.look.colours = Colours::Stops {
                lightest,
                middle,
                darkest,
            };
        }
    });
    assert!(
        undyed.iter().all(|found| !is_allowed(*found)),
        "{undyed:.4?}"
    );
}

#[test]
fn another_weave_is_noticed() {
    let found = changed(&["plain", "twill", "afar"], |figure| {
        for experiment in &mut figure.experiments {
            let weave = &mut experiment.scenario.cloth.weave;
            *weave = match weave {
                Weave::Plain => Weave::Twill { over: 1, under: 2 },
                // The diagonals run the other way.
                _ => Weave::Matrix(["X..X", "..XX", ".XX.", "XX.."].map(Into::into).into()),
            };
        }
    });
    assert!(found.iter().all(|found| !is_allowed(*found)), "{found:.4?}");
}

#[test]
fn a_missing_or_reversed_twist_is_noticed() {
    let smooth = changed(&WEAVES, |figure| {
        for panel in &mut figure.panels {
            panel.look.yarn.roughness = 0.0;
        }
    });
    let reversed = changed(&WEAVES, |figure| {
        for panel in &mut figure.panels {
            panel.look.yarn.turn *= -1.0;
        }
    });
    for found in smooth.iter().chain(&reversed) {
        assert!(!is_allowed(*found), "{smooth:.4?} {reversed:.4?}");
    }
}

#[test]
fn another_seed_and_another_moment_are_noticed() {
    let seed = changed(&WEAVES, |figure| {
        for experiment in &mut figure.experiments {
            experiment.scenario.seed += 1;
        }
    });
    let moment = changed(&["plain", "twill", "yarn"], |figure| {
        for panel in &mut figure.panels {
            panel.step -= panel.step / 10;
        }
    });
    for found in seed.iter().chain(&moment) {
        assert!(!is_allowed(*found), "{seed:.4?} {moment:.4?}");
    }
}

#[test]
fn what_another_machine_rounds_another_way_is_not_noticed() {
    for panel in golden().panels {
        let was = unchanged(&panel.label);
        let mut rounded = was.clone();
        // A third of all values a step up, another a step down.
        for (i, value) in rounded.rgb.iter_mut().enumerate() {
            *value = match i.wrapping_mul(2_654_435_761) >> 7 & 3 {
                0 => value.saturating_add(1),
                1 => value.saturating_sub(1),
                _ => *value,
            };
        }
        let found = difference(was, &rounded);
        println!("{}: {found:.4?}", panel.label);
        assert!(is_allowed(found), "{}: {found:.4?}", panel.label);
    }
}

#[test]
fn equal_pictures_do_not_differ_and_black_and_white_do_by_one() {
    let plain = |value: u8| Picture {
        width: 5,
        height: 4,
        rgb: vec![value; 60],
    };
    assert_eq!(difference(&plain(7), &plain(7)).most, 0.0);
    let most = difference(&plain(0), &plain(255));
    assert!(
        (most.mean - 1.0).abs() < 1e-3 && (most.most - 1.0).abs() < 1e-3,
        "{most:?}"
    );
}
