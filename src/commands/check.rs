//! `dyelapse check`.

use std::fmt::Write;
use std::process::ExitCode;

use super::{BAD_INPUT, complain, print};
use dyelapse::memory::{self, Use};
use dyelapse::record::Plan;
use dyelapse::scenario::Loaded;

pub fn run(scenarios: &[String]) -> ExitCode {
    let mut good = String::new();
    let mut bad = 0;
    for name in scenarios {
        match check(name) {
            Ok(summary) => {
                let _ = writeln!(good, "{name}: {summary}");
            }
            Err(what) => {
                complain(&what);
                bad += 1;
            }
        }
    }
    let printed = print(good.as_bytes());
    if bad > 0 {
        ExitCode::from(BAD_INPUT)
    } else {
        printed
    }
}

fn check(name: &str) -> Result<String, String> {
    let experiment = match Loaded::load(name).map_err(|why| why.to_string())? {
        Loaded::Scenario(experiment) => experiment,
        Loaded::Figure(figure) => {
            let (panels, cloths) = (figure.panels.len(), figure.experiments.len());
            return Ok(format!(
                "right; a figure of {panels} panels, {cloths} cloths"
            ));
        }
    };
    let scenario = &experiment.scenario;
    let plan = Plan::new(scenario, None, None).map_err(|why| format!("{name}: {why}"))?;
    let (nx, ny) = scenario.cloth.cells();
    let hours = plan.steps as f64 * scenario.process.step_h;
    let megabytes =
        (memory::needed(scenario, Use::of(scenario)) + experiment.images.bytes()) / 1_000_000;
    Ok(format!(
        "right; {nx}×{ny}×2 cells, {} steps ({hours} h), {} frames, at most {} MB of memory",
        plan.steps,
        plan.frames(),
        megabytes
    ))
}
