//! The folder of a recording: what is in it, that it is whole, and that nothing else is ever lost.

#[path = "common/program.rs"]
mod program;

use std::fs;

use program::{contents, dyelapse, folder, manifest, said};

#[test]
fn a_recording_has_every_frame_and_says_what_each_shows() {
    let here = folder();
    dyelapse(&here)
        .args([
            "record", "one_drop", "--steps", "100", "--frames", "5", "--scale", "2",
        ])
        .assert()
        .success();
    let out = here.path().join("recordings/one_drop");
    let files = contents(&out);
    for name in ["sheet.png", "ledger.csv", "recording.ron", "scenario.ron"] {
        assert!(files.contains_key(name), "{name} is missing");
    }
    let manifest = manifest(&out);
    assert!(manifest.complete);
    assert_eq!(manifest.pixels, (240, 160));
    assert_eq!(
        manifest
            .frames
            .iter()
            .map(|frame| frame.step)
            .collect::<Vec<_>>(),
        [0, 25, 50, 75, 100]
    );
    for frame in &manifest.frames {
        let picture = image::open(out.join(&frame.file)).unwrap();
        assert_eq!((picture.width(), picture.height()), (240, 160));
        assert!((frame.hours - frame.step as f64 * 0.0005).abs() < 1e-12);
    }
    let ledger = String::from_utf8(files["ledger.csv"].clone()).unwrap();
    let mut lines = ledger.lines();
    let head = "step,time_h,supplied,free,bound,removed,imbalance";
    assert_eq!(lines.next(), Some(head));
    assert_eq!(lines.count(), 5);
    assert!(!files.keys().any(|name| name.ends_with(".part")));
}

#[test]
fn the_scenario_in_a_recording_makes_the_same_recording_again() {
    let here = folder();
    let few = ["--steps", "30", "--frames", "2"];
    dyelapse(&here)
        .args(["record", "one_drop", "--out", "a"])
        .args(few)
        .assert()
        .success();
    dyelapse(&here)
        .args(["record", "a/scenario.ron", "--out", "b"])
        .args(few)
        .assert()
        .success();
    assert!(contents(&here.path().join("a")) == contents(&here.path().join("b")));
}

const SHORT: [&str; 6] = ["record", "one_drop", "--steps", "2", "--frames", "1"];

#[test]
fn a_folder_with_anything_in_it_is_refused_and_force_clears_only_a_recording() {
    let here = folder();
    let out = here.path().join("out");
    let long = [
        "record", "fig8a", "--steps", "9", "--frames", "4", "--fields", "--out", "out",
    ];
    dyelapse(&here).args(long).assert().success();
    // The user's own, some with names that the recording could have given but did not.
    for name in [
        "notes.txt",
        "video.mp4",
        "frame_00099.png",
        "state_12345.npz",
    ] {
        fs::write(out.join(name), "mine").unwrap();
    }
    let before = contents(&out);
    let (code, text) = said(dyelapse(&here).args(SHORT).args(["--out", "out"]));
    assert_eq!(code, 2);
    assert!(
        text.contains("not empty") && text.contains("--force"),
        "{text}"
    );
    assert!(contents(&out) == before);

    dyelapse(&here)
        .args(SHORT)
        .args(["--out", "out", "--force"])
        .assert()
        .success();
    let files = contents(&out);
    let names: Vec<&str> = files.keys().map(String::as_str).collect();
    assert_eq!(
        names,
        [
            "frame_00000.png",
            "frame_00099.png",
            "ledger.csv",
            "notes.txt",
            "recording.ron",
            "scenario.ron",
            "sheet.png",
            "state_12345.npz",
            "video.mp4"
        ]
    );
    for name in [
        "notes.txt",
        "video.mp4",
        "frame_00099.png",
        "state_12345.npz",
    ] {
        assert_eq!(files[name], b"mine", "{name}");
    }
}

#[test]
fn force_never_touches_what_no_recording_made() {
    let here = folder();
    let forced = |arguments: &[&str]| {
        let before = contents(here.path());
        let (code, text) = said(dyelapse(&here).args(arguments).arg("--force"));
        assert_eq!(code, 2, "{arguments:?}: {text}");
        assert!(contents(here.path()) == before, "{arguments:?}");
        text
    };
    // A file that only has the name of one of a recording.
    fs::write(here.path().join("sheet.png"), "mine").unwrap();
    let text = forced(&["record", "one_drop", "--out", "."]);
    assert!(text.contains("sheet.png is in the way"), "{text}");
    fs::remove_file(here.path().join("sheet.png")).unwrap();
    // The scenario's own folder, and its own picture.
    image::GrayImage::new(20, 10)
        .save(here.path().join("paste.png"))
        .unwrap();
    let scenario = "(title: \"own\", cloth: (size: (Cells(20), Cells(10))), supply: [],
        resist: Image(file: \"./paste.png\"), process: (duration: Steps(2)))";
    fs::write(here.path().join("own.ron"), scenario).unwrap();
    let text = forced(&["record", "own.ron", "--out", "."]);
    assert!(text.contains("own.ron lies in the folder"), "{text}");
    // A manifest that names what lies elsewhere.
    fs::write(here.path().join("precious.txt"), "mine").unwrap();
    dyelapse(&here)
        .args(SHORT)
        .args(["--out", "w"])
        .assert()
        .success();
    let manifest = here.path().join("w/recording.ron");
    let text = fs::read_to_string(&manifest).unwrap();
    let absolute = here.path().join("precious.txt").display().to_string();
    let text = text.replace(
        "pictures: []",
        &format!("pictures: [\"../precious.txt\", {absolute:?}]"),
    );
    fs::write(&manifest, text).unwrap();
    dyelapse(&here)
        .args(SHORT)
        .args(["--out", "w", "--force"])
        .assert()
        .success();
    assert_eq!(fs::read(here.path().join("precious.txt")).unwrap(), b"mine");
    // A picture of that name which is not the scenario's copy.
    fs::create_dir(here.path().join("out")).unwrap();
    fs::write(here.path().join("out/paste.png"), "mine").unwrap();
    let (code, text) = said(dyelapse(&here).args(["record", "own.ron", "--out", "out", "--force"]));
    assert_eq!(code, 2, "{text}");
    assert_eq!(
        fs::read(here.path().join("out/paste.png")).unwrap(),
        b"mine"
    );
}

#[test]
fn a_scenario_is_kept_with_its_pictures_and_runs_again_from_there() {
    let here = folder();
    fs::create_dir(here.path().join("patterns")).unwrap();
    let picture = image::GrayImage::from_fn(20, 10, |x, _| image::Luma([10 * x as u8]));
    picture.save(here.path().join("patterns/ramp.png")).unwrap();
    let scenario = "(title: \"ramp\", cloth: (size: (Cells(20), Cells(10))),
        supply: [Hold(shape: Image(file: \"patterns/ramp.png\"))],
        process: (duration: Steps(9)))";
    // A byte order mark, as some editors write it.
    fs::write(here.path().join("ramp.ron"), format!("\u{feff}{scenario}")).unwrap();
    dyelapse(&here)
        .args(["record", "ramp.ron", "--out", "a"])
        .assert()
        .success();
    dyelapse(&here)
        .args(["record", "a/scenario.ron", "--out", "b"])
        .assert()
        .success();
    // And over an older recording of itself.
    dyelapse(&here)
        .args(["record", "ramp.ron", "--out", "a", "--force"])
        .assert()
        .success();
    let picture =
        |folder: &str| fs::read(here.path().join(folder).join("patterns/ramp.png")).unwrap();
    assert!(picture("a") == picture("b"));
    let frame = |folder: &str| fs::read(here.path().join(folder).join("frame_00009.png")).unwrap();
    assert!(frame("a") == frame("b"));
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_a_valid_shorter_recording() {
    let here = folder();
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_dyelapse"))
        .current_dir(here.path())
        .args([
            "record", "seikaiha", "--out", "out", "--frames", "40001", "--quiet",
        ])
        .spawn()
        .unwrap();
    let out = here.path().join("out");
    // It takes minutes in all: wait until it is well on its way.
    while !out.join("frame_00002.png").exists() {
        assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let killed = std::process::Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(killed.success());
    assert_eq!(child.wait().unwrap().code(), Some(130));

    let manifest = manifest(&out);
    assert!(!manifest.complete);
    assert!(manifest.frames.len() >= 3);
    for frame in &manifest.frames {
        image::open(out.join(&frame.file)).unwrap();
    }
    let files = contents(&out);
    let frames = files
        .keys()
        .filter(|name| name.starts_with("frame_"))
        .count();
    assert_eq!(frames, manifest.frames.len());
    assert!(files.contains_key("sheet.png") && files.contains_key("ledger.csv"));
    assert!(!files.keys().any(|name| name.ends_with(".part")));
}
