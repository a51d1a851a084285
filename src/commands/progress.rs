//! How far a recording has come: a bar on a terminal, plain lines elsewhere.

use std::io::{self, IsTerminal};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::say;

/// Shows progress in steps.
pub struct Progress {
    shown: Shown,
    steps: u64,
    began: Instant,
    next: Instant,
}

enum Shown {
    Nothing,
    Bar(ProgressBar),
    Lines,
}

const BAR_EVERY: Duration = Duration::from_millis(100);
const LINE_EVERY: Duration = Duration::from_secs(10);

impl Progress {
    /// Begins to show progress over `steps` steps.
    pub fn new(title: &str, steps: u64, quiet: bool) -> Self {
        let shown = if quiet {
            Shown::Nothing
        } else if io::stderr().is_terminal() {
            let bar = ProgressBar::new(steps);
            let template = "{msg}  {wide_bar} {human_pos}/{human_len} steps  {per_sec}  {eta} left";
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style);
            }
            bar.set_message(title.to_owned());
            Shown::Bar(bar)
        } else {
            say(&format!("{title}: {steps} steps"));
            Shown::Lines
        };
        let began = Instant::now();
        let first = if matches!(shown, Shown::Bar(_)) {
            BAR_EVERY
        } else {
            LINE_EVERY
        };
        Progress {
            shown,
            steps,
            began,
            next: began + first,
        }
    }

    /// Tells that `step` steps are done.
    pub fn at(&mut self, step: u64) {
        let now = Instant::now();
        if now < self.next {
            return;
        }
        match &self.shown {
            Shown::Nothing => {}
            Shown::Bar(bar) => {
                bar.set_position(step);
                self.next = now + BAR_EVERY;
            }
            Shown::Lines => {
                let rate = step as f64 / (now - self.began).as_secs_f64();
                let left = (self.steps - step.min(self.steps)) as f64 / rate.max(1e-9);
                let share = 100 * step / self.steps.max(1);
                let of = self.steps;
                say(&format!(
                    "{share} %: step {step} of {of}, {rate:.0} steps a second, {left:.0} s left"
                ));
                self.next = now + LINE_EVERY;
            }
        }
    }

    /// Ends; a bar is wiped away.
    pub fn end(self) {
        if let Shown::Bar(bar) = self.shown {
            bar.finish_and_clear();
        }
    }
}
