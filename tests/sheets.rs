//! Figures and `dyelapse sheet`: the bundled ones are right, broken ones are told what is wrong with
//! them, and one picture holds all panels.

#[path = "common/program.rs"]
mod program;

use std::fs;

use dyelapse::record::draw_figure;
use dyelapse::scenario::{Figure, Origin, bundled, bundled_figures};
use program::{contents, dyelapse, folder, said};

#[test]
fn every_bundled_figure_loads_and_begins_by_saying_what_it_shows() {
    for figure in bundled_figures() {
        Figure::of(&[figure.name]).unwrap_or_else(|why| panic!("{why}"));
        let comment = figure.text.lines().take_while(|l| l.starts_with("//"));
        assert!(comment.count() >= 2, "{}", figure.name);
    }
}

#[test]
fn no_figure_has_the_name_of_a_scenario() {
    for figure in bundled_figures() {
        assert!(bundled().all(|scenario| scenario.name != figure.name));
    }
}

/// Writes what the messages are now over what they were to be: look at the difference well.
const ACCEPT: &str = "DYELAPSE_ACCEPT";

#[test]
fn every_broken_figure_gets_exactly_the_expected_message() {
    let mut seen = 0;
    for entry in fs::read_dir("tests/broken/figures").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|ending| ending != "ron") {
            continue;
        }
        let message = match Figure::of(&[path.to_str().unwrap()]) {
            Ok(_) => "it is not broken".into(),
            Err(why) => why.to_string() + "\n",
        };
        let expected = path.with_extension("txt");
        if std::env::var_os(ACCEPT).is_some() {
            fs::write(&expected, &message).unwrap();
        }
        let expected = fs::read_to_string(&expected).unwrap_or_default();
        assert_eq!(message, expected, "{}", path.display());
        seen += 1;
    }
    assert!(seen > 10, "only {seen} broken figures were found");
}

#[test]
fn any_beginning_of_a_figure_is_told_and_none_panics() {
    let figure = bundled_figures().find(|f| f.name == "fig10").unwrap();
    for end in (0..figure.text.len()).filter(|end| figure.text.is_char_boundary(*end)) {
        let text = &figure.text[..end];
        let parsed = Figure::parse("cut.ron", Origin::Memory, text);
        let whole = text.trim_end().ends_with("\n)");
        assert_eq!(parsed.is_ok(), whole, "{text}");
    }
}

/// Two small cloths, one of them twice.
const SMALL: &str = r#"(
    title: "Small",
    columns: 3,
    panels: [
        (scenario: "a.ron", label: "late", pixels_per_cell: 3),
        (scenario: "b.ron"),
        (scenario: "a.ron", label: "early", at: Steps(1), show: BoundOnly,
         crop: (size: (Cells(8), Cells(6)))),
    ],
)"#;

fn small_cloth(name: &str) -> String {
    format!(
        "(title: {name:?}, cloth: (size: (Cells(40), Cells(30))),
          supply: [Hold(shape: Disc(diameter: Cells(9)))],
          adsorption: (), process: (duration: Steps(20)))"
    )
}

#[test]
fn a_sheet_is_one_picture_of_all_panels_and_always_the_same() {
    let here = folder();
    for name in ["a", "b"] {
        fs::write(here.path().join(format!("{name}.ron")), small_cloth(name)).unwrap();
    }
    fs::write(here.path().join("small.ron"), SMALL).unwrap();
    for (threads, out) in [("1", "one.png"), ("3", "three.png")] {
        dyelapse(&here)
            .env("RAYON_NUM_THREADS", threads)
            .args(["sheet", "small.ron", "--out", out])
            .assert()
            .success();
    }
    let files = contents(here.path());
    assert!(files["one.png"] == files["three.png"]);
    let picture = image::load_from_memory(&files["one.png"]).unwrap();
    assert!(picture.width() > 3 * 120 && picture.height() > 90);
    // The name of the picture, where nobody says one, and JPEG.
    dyelapse(&here)
        .args(["sheet", "small.ron", "--quiet"])
        .assert()
        .success()
        .stderr("");
    dyelapse(&here)
        .args(["sheet", "a.ron", "small.ron", "b.ron", "--columns", "2"])
        .args(["--steps", "3", "--scale", "2", "--out", "all.jpg"])
        .assert()
        .success();
    let files = contents(here.path());
    assert!(files["small.png"] == files["one.png"]);
    let all = image::load_from_memory(&files["all.jpg"]).unwrap();
    assert!(all.height() > all.width(), "five panels in two columns");
    assert!(!files.keys().any(|name| name.ends_with(".part")));
}

#[test]
fn a_panel_shows_what_a_recording_of_its_scenario_shows() {
    let here = folder();
    fs::write(here.path().join("a.ron"), small_cloth("a")).unwrap();
    // One panel as large as the least that is never enlarged, so that its pixels are the cloth's.
    let figure = r#"(title: "", panels: [
        (scenario: "a.ron", label: "", pixels_per_cell: 2),
        (scenario: "a.ron", label: "", pixels_per_cell: 8),
        (scenario: "a.ron", label: "", pixels_per_cell: 8, at: Steps(7)),
    ])"#;
    let path = here.path().join("figure.ron");
    fs::write(&path, figure).unwrap();
    let figure = Figure::parse(path.to_str().unwrap(), Origin::File(path.clone()), figure).unwrap();
    let sheet = draw_figure(&figure, |_, _| true).unwrap().unwrap();
    for (steps, out) in [("20", "end"), ("7", "seventh")] {
        dyelapse(&here)
            .args(["record", "a.ron", "--scale", "8", "--frames", "1"])
            .args(["--steps", steps, "--out", out])
            .assert()
            .success();
        let frame = here.path().join(out).join("frame_00000.png");
        let frame = image::open(frame).unwrap().into_rgb8();
        let row = &frame.as_raw()[3 * 320 * 120..][..3 * 320];
        let is_there = sheet
            .rgb
            .chunks(3 * sheet.width)
            .any(|line| line.windows(row.len()).step_by(3).any(|part| part == row));
        assert!(is_there, "{out}");
    }
}

#[test]
fn what_cannot_be_is_told_on_one_place_ends_with_2_and_writes_nothing() {
    let here = folder();
    fs::write(here.path().join("mine.png"), "mine").unwrap();
    fs::write(
        here.path().join("bad.ron"),
        "(title: \"x\", panels: [(scenario: \"fig8a\", at: Steps(5001))])",
    )
    .unwrap();
    let cases: [(&[&str], &str); 10] = [
        (&["sheet"], "<NAME>"),
        (&["sheet", "fig88"], "did you mean `fig8`?"),
        (&["sheet", "bad.ron"], "bad.ron:1:47: `panels[0].at`"),
        (&["sheet", "no/such.ron"], "no/such.ron"),
        (&["sheet", "fig8a", "--columns", "0"], "--columns: 1 to"),
        (&["sheet", "fig8a", "--scale", "65"], "--scale: 1 to 64"),
        (
            &["sheet", "fig8a", "--steps", "18446744073709551615"],
            "--steps: 0 to",
        ),
        (&["sheet", "fig8a", "--out", "a.gif"], ".png or .jpg"),
        (&["sheet", "fig8a", "--out", "mine.png"], "--force"),
        (&["sheet", "fig8a", "--out", "."], "folder"),
    ];
    let before = contents(here.path());
    for (arguments, expected) in cases {
        let (code, text) = said(dyelapse(&here).args(arguments));
        assert_eq!(code, 2, "{arguments:?}: {text}");
        assert!(text.contains(expected), "{arguments:?}: {text}");
        assert!(contents(here.path()) == before, "{arguments:?}");
    }
    let (code, text) = said(dyelapse(&here).args(["check", "bad.ron", "fig8"]));
    assert_eq!(code, 2, "{text}");
}
