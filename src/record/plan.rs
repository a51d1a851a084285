//! When to stop for a frame, and when for a place on the contact sheet.

use std::collections::BTreeMap;

use super::RecordError;
use crate::scenario::{MOST_FRAMES, Scenario, units::MOST_STEPS};

/// A moment that is recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stop {
    /// The step.
    pub step: u64,
    /// Which frame of the time-lapse it is, if it is one.
    pub frame: Option<u32>,
    /// Whether it has a place on the contact sheet.
    pub sheet: bool,
}

/// Every moment that is recorded, in order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Plan {
    /// The moments.
    pub stops: Vec<Stop>,
    /// Steps of the process.
    pub steps: u64,
}

/// Places on a contact sheet of a scenario that names none.
const SHEET_PLACES: u64 = 8;

impl Plan {
    /// Plans a recording of a scenario. `frames` and `steps` come before what it says itself.
    ///
    /// # Errors
    /// [`RecordError::Frames`] or [`RecordError::Steps`] where there cannot be so many.
    pub fn new(
        scenario: &Scenario,
        frames: Option<u32>,
        steps: Option<u64>,
    ) -> Result<Self, RecordError> {
        let total = steps.unwrap_or_else(|| scenario.process.steps());
        if total > MOST_STEPS {
            return Err(RecordError::Steps {
                steps: total,
                most: MOST_STEPS,
            });
        }
        let moments = total.saturating_add(1);
        let count = frames.unwrap_or_else(|| scenario.record.frames(moments));
        let most = moments.min(u64::from(MOST_FRAMES));
        // Two frames of one moment would be a still in the film.
        if count == 0 || u64::from(count) > most {
            return Err(RecordError::Frames {
                frames: count,
                most,
                steps: total,
            });
        }
        let mut stops = BTreeMap::new();
        for frame in 0..count {
            let step = spread(u64::from(frame), u64::from(count), total);
            stop_at(&mut stops, step).frame = Some(frame);
        }
        let step_h = scenario.process.step_h;
        let sheet: Vec<u64> = match &scenario.batik {
            // As every step of the recipe leaves the cloth.
            Some(batik) if scenario.record.sheet.is_empty() => batik.shown(step_h),
            _ => {
                let sheet = scenario.record.sheet.iter();
                sheet.map(|time| time.steps(step_h)).collect()
            }
        };
        let named: Vec<u64> = sheet
            .iter()
            .copied()
            .filter(|step| *step <= total)
            .collect();
        // A process cut short by `--steps` may end before most of the sheet's moments.
        let enough = named.len() > 1 || named.len() == sheet.len();
        let moments = if enough && !named.is_empty() {
            named
        } else {
            let frames: Vec<u64> = stops.keys().copied().collect();
            let places = SHEET_PLACES.min(frames.len() as u64);
            let last = frames.len() as u64 - 1;
            (0..places)
                .map(|place| frames[spread(place, places, last) as usize])
                .collect()
        };
        for step in moments {
            stop_at(&mut stops, step).sheet = true;
        }
        Ok(Plan {
            stops: stops.into_values().collect(),
            steps: total,
        })
    }

    /// Frames of the time-lapse.
    pub fn frames(&self) -> u32 {
        let frames = self.stops.iter().filter(|stop| stop.frame.is_some());
        frames.count() as u32
    }
}

fn stop_at(stops: &mut BTreeMap<u64, Stop>, step: u64) -> &mut Stop {
    stops.entry(step).or_insert(Stop {
        step,
        frame: None,
        sheet: false,
    })
}

/// The `i`th of `count` numbers spread evenly from 0 to `last`; a single one is the last.
fn spread(i: u64, count: u64, last: u64) -> u64 {
    if count < 2 {
        return last;
    }
    let (i, gaps, last) = (u128::from(i), u128::from(count - 1), u128::from(last));
    ((i * last + gaps / 2) / gaps) as u64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Experiment;

    fn plan(name: &str, frames: Option<u32>, steps: Option<u64>) -> Plan {
        let experiment = Experiment::load(name).unwrap();
        Plan::new(&experiment.scenario, frames, steps).unwrap()
    }

    #[test]
    fn frames_are_numbered_in_order_and_reach_both_ends() {
        for frames in [2, 3, 7, 100] {
            let plan = plan("seikaiha", Some(frames), None);
            let kept: Vec<_> = plan.stops.iter().filter_map(|stop| stop.frame).collect();
            assert_eq!(kept, (0..frames).collect::<Vec<_>>());
            assert_eq!(plan.stops[0].step, 0);
            assert_eq!(plan.stops.last().unwrap().step, 400_000);
        }
    }

    #[test]
    fn the_sheet_of_seikaiha_has_the_papers_moments_whatever_the_frames() {
        for frames in [None, Some(1), Some(10)] {
            let on_sheet: Vec<_> = plan("seikaiha", frames, None)
                .stops
                .iter()
                .filter(|stop| stop.sheet)
                .map(|stop| stop.step)
                .collect();
            assert_eq!(
                on_sheet,
                [
                    0, 12_500, 25_000, 50_000, 100_000, 200_000, 300_000, 400_000
                ]
            );
        }
    }

    #[test]
    fn no_moment_is_recorded_twice() {
        let plan = plan("one_drop", Some(6), Some(5));
        let steps: Vec<_> = plan.stops.iter().map(|stop| stop.step).collect();
        assert_eq!(steps, [0, 1, 2, 3, 4, 5]);
        let experiment = Experiment::load("one_drop").unwrap();
        assert!(Plan::new(&experiment.scenario, Some(7), Some(5)).is_err());
    }
}
