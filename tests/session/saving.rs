//! Scenarios written for people, and read again.

use dyelapse::scenario::bundled;
use dyelapse::session::save::{read, save};

use crate::cloths::samples;

/// The texts of all scenarios there are.
fn texts() -> Vec<(String, String)> {
    let bundled = bundled().map(|scenario| (scenario.name.into(), scenario.text.into()));
    let painted = "(title: \"painted \\\"twice\\\"\", cloth: (size: (Cells(60), Cells(40))),
        supply: [Dose(shape: Strokes([(radius: Mm(0.8), strength: 0.5, path: [(0.1, 0.2)]),
            (radius: Cells(9), hardness: 0.1, path: [(0.1, 0.2), (0.15, 0.25), (0.2, 0.3),
            (0.25, 0.35), (0.3, 0.4), (0.35, 0.45), (0.4, 0.5), (0.45, 0.55), (0.5, 0.6)])]),
            at: Steps(7))],
        drape: \"tablecloth\", view: (field_of_view: 40, light: (10, 20)),
        resist: Union([Ramp(), Strokes([(radius: Mm(1), path: [(0.5, 0.5)])])]),
        process: (duration: Steps(20)))";
    let own = samples()
        .into_iter()
        .map(|sample| (sample.name.into(), sample.text));
    let painted = [("painted".into(), painted.into())];
    bundled.chain(own).chain(painted).collect()
}

#[test]
fn what_is_saved_is_read_again_as_the_same_scenario() {
    for (name, text) in texts() {
        let scenario = read(&text).unwrap_or_else(|why| panic!("{name}: {why}"));
        let saved = save(&scenario);
        let again = read(&saved).unwrap_or_else(|why| panic!("{name}: {why}\n{saved}"));
        assert_eq!(again, scenario, "{name}");
        assert_eq!(save(&again), saved, "{name}");
    }
}

#[test]
fn every_field_of_a_saved_scenario_has_a_comment() {
    for (name, text) in texts() {
        let Ok(scenario) = read(&text) else { continue };
        let saved = save(&scenario);
        let lines: Vec<&str> = saved.lines().collect();
        for (i, line) in lines.iter().enumerate() {
            let is_field = line
                .trim_start()
                .split_once(": ")
                .is_some_and(|(key, _)| key.chars().all(|c| c.is_ascii_lowercase() || c == '_'));
            let above = i.checked_sub(1).map_or("", |i| lines[i]).trim_start();
            assert!(
                !is_field || line.contains("// ") || above.starts_with("// "),
                "{name}: {line}"
            );
            assert!(line.chars().count() <= 110, "{name}: {line}");
        }
    }
}

#[test]
fn what_is_as_ever_is_left_out() {
    let text = "(title: \"t\", seed: 0, cloth: (size: (Cells(60), Cells(40)), cell_mm: 0.05,
        weave: Plain, warp: (width: Cells(8), gap: Cells(3))), dye: (equilibrium: 1.0), supply: [],
        process: (duration: Steps(20), solver: Accelerated), look: (pixels_per_cell: 1))";
    let saved = save(&read(text).unwrap());
    for gone in [
        "seed", "cell_mm", "weave", "width", "dye:", "solver", "look",
    ] {
        assert!(!saved.contains(gone), "{gone}:\n{saved}");
    }
    assert!(saved.contains("gap: Cells(3),"), "{saved}");
}
