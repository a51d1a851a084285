//! Scenario files: the bundled ones are right, and broken ones are told what is wrong with them.

mod common;

use std::fs;

use dyelapse::record::Plan;
use dyelapse::scenario::{Experiment, bundled};

#[test]
fn every_bundled_scenario_loads_and_can_be_recorded() {
    for scenario in bundled() {
        let experiment = Experiment::load(scenario.name).unwrap_or_else(|why| panic!("{why}"));
        Plan::new(&experiment.scenario, None, None).unwrap_or_else(|why| panic!("{why}"));
    }
}

#[test]
fn every_bundled_scenario_begins_by_saying_what_it_shows_and_where_it_comes_from() {
    for scenario in bundled() {
        let comment: Vec<_> = scenario
            .text
            .lines()
            .take_while(|line| line.starts_with("//"))
            .collect();
        assert!(comment.len() >= 2, "{}: {comment:?}", scenario.name);
        let width = scenario.text.lines().map(|line| line.chars().count()).max();
        assert!(width <= Some(110), "{} has long lines", scenario.name);
    }
}

#[test]
fn the_scenarios_of_paper_d_have_the_parameters_of_its_table_1() {
    for (name, tau3, weave) in [
        ("fig8a", [1.0, 1.0, 1.0, 1.0, 1.0], "Plain"),
        ("fig8b", [1.0, 1.0, 1.0, 1.0, 1.0], "Plain"),
        ("fig8c", [0.0, 0.05, 1.0, 1.0, 0.0], "Plain"),
        ("fig8d", [0.005, 0.005, 0.005, 1.0, 1.0], "Plain"),
        ("fig8e", [1.0, 1.0, 0.0, 1.0, 1.0], "Plain"),
        ("fig8f", [1.0, 1.0, 0.0, 1.0, 1.0], "Plain"),
        ("fig8g", [1.0, 1.0, 0.0, 1.0, 1.0], "Plain"),
        ("fig9a", [1.0, 1.0, 1.0, 1.0, 1.0], "Plain"),
        ("fig9b", [1.0, 1.0, 1.0, 1.0, 1.0], "Plain"),
        ("fig9c", [1.0, 1.0, 1.0, 1.0, 1.0], "Plain"),
        ("fig10a", [0.01, 0.01, 0.01, 1.0, 1.0], "Plain"),
        ("fig10b", [0.01, 0.01, 0.01, 1.0, 1.0], "Twill"),
        ("fig10c", [0.01, 0.01, 0.01, 1.0, 1.0], "Satin"),
        ("seikaiha", [1.0, 1.0, 0.0, 1.0, 1.0], "Plain"),
    ] {
        let scenario = Experiment::load(name).unwrap().scenario;
        let paths = scenario.cloth.paths;
        let classes = [
            paths.between_layers,
            paths.across_yarn,
            paths.yarn_to_gap,
            paths.gap_to_gap,
            paths.along_yarn,
        ];
        assert_eq!(classes, tau3, "{name}");
        assert_eq!(paths.dive, 0.47, "{name}");
        assert!(
            format!("{:?}", scenario.cloth.weave).starts_with(weave),
            "{name}"
        );
        assert_eq!(scenario.dye.diffusivity.in_water(), 1.93, "{name}");
        assert_eq!(scenario.cloth.warp.porosity, 0.5, "{name}");
        let steps = match name {
            "seikaiha" => 400_000,
            _ if name.starts_with("fig9") => 50_000,
            _ => 5_000,
        };
        assert_eq!(scenario.process.steps(), steps, "{name}");
    }
}

/// Writes what the messages are now over what they were to be: look at the difference well.
const ACCEPT: &str = "DYELAPSE_ACCEPT";

#[test]
fn every_broken_scenario_gets_exactly_the_expected_message() {
    let mut seen = 0;
    let mut wrong = Vec::new();
    let mut paths: Vec<_> = fs::read_dir("tests/broken")
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "ron"))
        .collect();
    paths.sort();
    for path in paths {
        let loaded = Experiment::load(path.to_str().unwrap());
        let planned = loaded
            .map_err(|why| why.to_string())
            .and_then(|experiment| {
                Plan::new(&experiment.scenario, None, None).map_err(|why| why.to_string())
            });
        let message = match planned {
            Ok(_) => "it is not broken".into(),
            Err(message) => message + "\n",
        };
        let expected = path.with_extension("txt");
        if std::env::var_os(ACCEPT).is_some() {
            fs::write(&expected, &message).unwrap();
        }
        if fs::read_to_string(&expected).unwrap_or_default() != message {
            wrong.push(message);
        }
        seen += 1;
    }
    assert!(seen > 30, "only {seen} broken scenarios were found");
    assert!(
        wrong.is_empty(),
        "unexpected messages:\n{}",
        wrong.join("\n")
    );
}

#[test]
fn a_name_that_is_nearly_right_is_told_the_right_one() {
    let message = Experiment::load("seikahia").unwrap_err().to_string();
    assert!(message.contains("did you mean `seikaiha`?"), "{message}");
    let message = Experiment::load("no/such/file.ron")
        .unwrap_err()
        .to_string();
    assert!(message.contains("no/such/file.ron"), "{message}");
}
