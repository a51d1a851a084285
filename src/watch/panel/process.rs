//! The process: how long it lasts, how it is computed, the steps of a batik, what is recorded.

use bevy_egui::egui::Ui;

use super::batik;
use super::mend::most_step_h;
use super::row::{Effect, Pass, row};
use crate::scenario::units::MOST_STEPS;
use crate::scenario::{MOST_FRAMES, Scenario, Solver, Time};

pub(super) fn show(p: &mut Pass, ui: &mut Ui, scenario: &mut Scenario) {
    p.group(ui, "Process", |p, ui| {
        p.heading("process");
        duration(p, ui, scenario);
        let longest = most_step_h(scenario);
        let step = row(
            "step Δt",
            "The length of one step. Short steps are more exact and take longer.",
        );
        let step_h = &mut scenario.process.step_h;
        p.number(ui, &step.unit(" h").scale(5e-4), step_h, 1e-9..=longest);
        let process = &mut scenario.process;
        let solver = row(
            "solver",
            "Accelerated leaps over many steps as far as the tolerance allows. Explicit takes one step at \
             a time: the reference.",
        );
        let both = [
            ("accelerated", Solver::Accelerated),
            ("explicit", Solver::Explicit),
        ];
        p.choice(ui, &solver, &mut process.solver, &both);
        let tolerance = row(
            "tolerance",
            "The largest error of a leap in the concentration of any cell, as a share of full. Larger is \
             faster.",
        );
        p.number(ui, &tolerance.scale(0.004), &mut process.tolerance, 1e-6..=0.1);
        p.heading("batik");
        batik::show(p, ui, scenario);
        p.effect = Effect::Kept;
        p.heading("recording");
        record(p, ui, scenario);
    });
}

fn duration(p: &mut Pass, ui: &mut Ui, scenario: &mut Scenario) {
    if scenario.batik.is_some() {
        let steps = scenario.process.steps();
        p.say(
            ui,
            &format!("The steps of the batik take {steps} together: they say how long it lasts."),
        );
        return;
    }
    let process = &mut scenario.process;
    let before = process.steps();
    let lasts = row(
        "duration",
        "How long the cloth is dyed. Longer, and dye comes further.",
    );
    p.time(ui, &lasts, &mut process.duration, 0, MOST_STEPS);
    let after = process.steps();
    if after == before || before == 0 {
        return;
    }
    // The moments of the sheet stay where they were between beginning and end.
    let share = after as f64 / before as f64;
    for time in &mut scenario.record.sheet {
        *time = match *time {
            Time::Steps(steps) => Time::Steps((share * steps as f64).round() as u64),
            Time::Minutes(t) => Time::Minutes(share * t),
            Time::Hours(t) => Time::Hours(share * t),
            Time::Days(t) => Time::Days(share * t),
        };
    }
}

fn record(p: &mut Pass, ui: &mut Ui, scenario: &mut Scenario) {
    let steps = scenario.process.steps();
    let moments = steps.saturating_add(1).min(u64::from(MOST_FRAMES)) as u32;
    let frames = row(
        "frames",
        "Pictures of the time-lapse, evenly spread from the first moment to the last. Left out: 25.",
    );
    let record = &mut scenario.record;
    let mut count = record.frames.map(f64::from);
    let mut is_there = count.is_some();
    p.ticked_row(ui, &frames, Some(&mut is_there), |p, ui| match &mut count {
        Some(count) => {
            let ends = (1.0, f64::from(moments));
            let width = super::row::VALUE;
            if let Some(new) = p.drag(ui, &frames, *count, ends, width, true) {
                record.frames = Some(new as u32);
            }
        }
        None => {
            ui.weak("25");
        }
    });
    if is_there != count.is_some() {
        record.frames = is_there.then_some(moments.min(25));
    }
    let sheet = row(
        "add to the sheet",
        "A moment on the contact sheet. Without any it shows eight of the frames.",
    );
    let title = |time: &Time| match time {
        Time::Steps(t) => format!("step {t}"),
        Time::Minutes(t) => format!("{t} min"),
        Time::Hours(t) => format!("{t} h"),
        Time::Days(t) => format!("{t} days"),
    };
    let names = ["the beginning", "the middle", "the end"];
    let make = |i: usize| {
        Some(Time::Steps(
            steps / 2 * (i as u64 % 2) + steps * (i as u64 / 2),
        ))
    };
    p.list(
        ui,
        &sheet,
        &mut record.sheet,
        (0, 100),
        title,
        &names,
        make,
        |p, ui, _, time| {
            p.time(
                ui,
                &row("moment", "When this picture is taken."),
                time,
                0,
                steps,
            );
        },
    );
}
