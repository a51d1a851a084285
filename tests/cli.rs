//! The command line, end to end: what is said, what is refused, and that bytes repeat.

#[path = "common/program.rs"]
mod program;

use std::fs;

use assert_cmd::Command;
use program::{contents, dyelapse, folder, said};

#[test]
fn the_same_scenario_gives_the_same_bytes_on_any_number_of_threads() {
    let here = folder();
    let mut scenario = fs::read_to_string("assets/scenarios/fig9c.ron").unwrap();
    scenario = scenario.replace(
        "size: (Cells(200), Cells(200))",
        "size: (Cells(300), Cells(190))",
    );
    fs::write(here.path().join("cloth.ron"), scenario).unwrap();
    let mut recordings = Vec::new();
    for (run, threads) in ["1", "2", "5", "5"].iter().enumerate() {
        let out = format!("run{run}");
        dyelapse(&here)
            .env("RAYON_NUM_THREADS", threads)
            .args(["record", "cloth.ron", "--out", &out, "--fields"])
            .args(["--steps", "200", "--frames", "3"])
            .assert()
            .success();
        recordings.push(contents(&here.path().join(out)));
    }
    for other in &recordings[1..] {
        assert!(recordings[0] == *other);
    }
}

#[test]
fn another_seed_gives_another_cloth() {
    let here = folder();
    let text = fs::read_to_string("assets/scenarios/fig8f.ron").unwrap();
    for seed in ["8", "9"] {
        let text = text.replace("seed: 8", &format!("seed: {seed}"));
        fs::write(here.path().join(format!("{seed}.ron")), text).unwrap();
        dyelapse(&here)
            .args([
                "record",
                &format!("{seed}.ron"),
                "--out",
                seed,
                "--steps",
                "20",
                "--frames",
                "1",
            ])
            .assert()
            .success();
    }
    let frame = |seed: &str| fs::read(here.path().join(seed).join("frame_00000.png")).unwrap();
    assert!(frame("8") != frame("9"));
}

#[test]
fn every_broken_scenario_ends_with_2() {
    for entry in fs::read_dir("tests/broken").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ending| ending == "ron") {
            let (code, text) = said(
                Command::new(env!("CARGO_BIN_EXE_dyelapse"))
                    .arg("check")
                    .arg(&path),
            );
            assert_eq!(code, 2, "{}: {text}", path.display());
        }
    }
}

#[test]
fn bad_input_is_told_on_one_place_ends_with_2_and_writes_nothing() {
    let here = folder();
    fs::write(here.path().join("bad.ron"), "(titel: \"x\")").unwrap();
    fs::write(here.path().join("a_file"), "").unwrap();
    fs::write(
        here.path().join("huge.ron"),
        "(title: \"huge\", cloth: (size: (Cells(1000000), Cells(1000000))), supply: [],
          process: (duration: Steps(1)))",
    )
    .unwrap();
    let cases: [(&[&str], &str); 12] = [
        (
            &["record", "bad.ron"],
            "bad.ron:1:2: there is no field `titel`",
        ),
        (&["record", "seikahia"], "did you mean `seikaiha`?"),
        (&["record", "no/such.ron"], "no/such.ron"),
        (&["record", "."], "folder"),
        (&["record", "huge.ron"], "GB of memory"),
        (&["record", "one_drop", "--scale", "0"], "--scale: 1 to 64"),
        (&["record", "one_drop", "--scale", "65"], "--scale: 1 to 64"),
        (
            &["record", "one_drop", "--frames", "0"],
            "--frames: 1 to 2001",
        ),
        (
            &["record", "one_drop", "--frames", "12", "--steps", "10"],
            "--frames: 1 to 11",
        ),
        (
            &["record", "one_drop", "--steps", "18446744073709551615"],
            "--steps: 0 to",
        ),
        (&["record", "one_drop", "--out", "a_file"], "is a file"),
        (&["record", "one_drop", "--steps", "many"], "invalid value"),
    ];
    let before = fs::read_dir(here.path()).unwrap().count();
    for (arguments, expected) in cases {
        let (code, text) = said(dyelapse(&here).args(arguments));
        assert_eq!(code, 2, "{arguments:?}: {text}");
        assert!(text.contains(expected), "{arguments:?}: {text}");
        assert!(!text.contains("panicked"), "{text}");
        // One message and no other.
        assert_eq!(
            text.matches("dyelapse: ").count() + text.matches("error: ").count(),
            1,
            "{text}"
        );
    }
    assert_eq!(fs::read_dir(here.path()).unwrap().count(), before);
}

#[test]
fn check_tells_right_from_wrong_and_goes_through_all() {
    let here = folder();
    fs::write(here.path().join("bad.ron"), "(titel: \"x\")").unwrap();
    let output = dyelapse(&here)
        .args(["check", "bad.ron", "seikaiha"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let right = String::from_utf8(output.stdout).unwrap();
    assert!(
        right.contains("seikaiha: right; 800×600×2 cells, 400000 steps (200 h)"),
        "{right}"
    );
    dyelapse(&here)
        .args(["check", "one_drop"])
        .assert()
        .success();
}

#[test]
fn list_help_version_and_completions_teach() {
    let here = folder();
    let print = |arguments: &[&str]| {
        let output = dyelapse(&here).args(arguments).output().unwrap();
        assert!(output.status.success(), "{arguments:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let list = print(&["list"]);
    for name in ["seikaiha", "one_drop", "fig8a", "fig9c", "fig10b"] {
        assert!(list.lines().any(|line| line.starts_with(name)), "{name}");
    }
    assert!(print(&["--help"]).contains("dyelapse record one_drop"));
    assert!(print(&["record", "--help"]).contains("Ctrl-C"));
    assert!(print(&["--version"]).contains(env!("CARGO_PKG_VERSION")));
    for shell in ["bash", "zsh", "fish"] {
        assert!(print(&["completions", shell]).contains("dyelapse"));
    }
}

#[test]
fn video_without_ffmpeg_is_refused_before_anything_is_written() {
    let here = folder();
    let (code, text) = said(dyelapse(&here).env("PATH", here.path()).args([
        "record", "one_drop", "--steps", "2", "--frames", "1", "--video",
    ]));
    assert_eq!(code, 2, "{text}");
    assert!(text.contains("ffmpeg"), "{text}");
    assert_eq!(fs::read_dir(here.path()).unwrap().count(), 0);
}
