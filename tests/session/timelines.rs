//! The timeline: any step, there and back, within a budget.

use dyelapse::prelude::*;
use dyelapse::session::snapshot::Snapshot;
use dyelapse::session::timeline::Timeline;

use crate::cloths::{Sample, assert_same, samples};

/// Steps in no order.
fn here_and_there(end: u64) -> Vec<u64> {
    (0..12).map(|i| (i * 7919 + 13) % 101 * end / 100).collect()
}

fn bytes_of_one(sample: &Sample) -> usize {
    let bytes = |stop: &u64| Snapshot::take(sample.straight(*stop).world()).bytes();
    sample.stops.iter().map(bytes).max().unwrap_or(0)
}

#[test]
fn every_step_is_reached_from_everywhere_as_by_a_straight_run_within_any_budget() {
    for sample in samples() {
        let [.., end] = sample.stops;
        let one = bytes_of_one(&sample);
        for budget in [0, one / 2, 3 * one, 8 * one, 1000 * one] {
            let mut app = sample.app();
            let mut timeline = Timeline::new(budget);
            for step in here_and_there(end) {
                let step = step.min(end);
                assert!(timeline.go_to(app.world_mut(), step, |_| true));
                assert!(timeline.bytes() <= budget, "{}", sample.name);
                look(app.world_mut());
                let straight = sample.straight(step);
                let what = format!("{} to {step} with {budget} bytes", sample.name);
                assert_same(app.world(), straight.world(), sample.exact_ledger, &what);
            }
        }
    }
}

#[test]
fn what_is_done_in_pieces_comes_to_the_same() {
    for sample in samples() {
        let [a, b, end] = sample.stops;
        let mut app = sample.app();
        let mut timeline = Timeline::new(4 * bytes_of_one(&sample));
        for step in [b, a, end] {
            let mut calls = 0;
            loop {
                // Every call may do three runs and has to come back.
                let mut runs = 0;
                let reached = timeline.go_to(app.world_mut(), step, |_| {
                    runs += 1;
                    runs <= 3
                });
                calls += 1;
                if reached {
                    break;
                }
                assert!(calls < 10_000, "{} gets nowhere", sample.name);
            }
            look(app.world_mut());
            let straight = sample.straight(step);
            assert_same(
                app.world(),
                straight.world(),
                sample.exact_ledger,
                sample.name,
            );
        }
    }
}

#[test]
fn going_back_begins_at_the_nearest_moment_that_is_kept() {
    for sample in samples() {
        let [a, .., end] = sample.stops;
        let mut app = sample.app();
        let mut timeline = Timeline::new(20 * bytes_of_one(&sample));
        assert!(timeline.go_to(app.world_mut(), end, |_| true));
        let nearest = timeline.nearest_before(a).unwrap().clock().step;
        assert!(nearest <= a);
        let mut first = None;
        assert!(timeline.go_to(app.world_mut(), a, |step| {
            first.get_or_insert(step);
            true
        }));
        assert_eq!(first.unwrap_or(a), nearest, "{}", sample.name);
        // And forwards where something that is kept lies between.
        let mut first = None;
        let nearest = timeline.nearest_before(end).unwrap().clock().step;
        assert!(timeline.go_to(app.world_mut(), end, |step| {
            first.get_or_insert(step);
            true
        }));
        assert_eq!(first.unwrap_or(end), nearest.max(a), "{}", sample.name);
    }
}

#[test]
fn moments_are_spread_over_what_had_to_be_computed() {
    for sample in samples() {
        let [.., end] = sample.stops;
        let mut app = sample.app();
        let mut timeline = Timeline::new(10 * bytes_of_one(&sample));
        assert!(timeline.go_to(app.world_mut(), end, |_| true));
        let all = dyelapse::session::snapshot::effort(app.world());
        let mut efforts: Vec<u64> = timeline
            .steps()
            .filter_map(|step| timeline.nearest_before(step).map(Snapshot::effort))
            .collect();
        efforts.push(all);
        let kept = efforts.len() as u64;
        let widest = efforts.windows(2).map(|pair| pair[1] - pair[0]).max();
        // A single leap may be wider than all between two moments should be.
        let leap = 1 + all / 4;
        let widest = widest.unwrap_or(0);
        assert!(
            widest <= (4 * all / kept).max(leap).max(16),
            "{}: {efforts:?}",
            sample.name
        );
    }
}

#[test]
fn a_timeline_forgets_what_is_no_longer_true() {
    for sample in samples() {
        let [a, .., end] = sample.stops;
        let mut app = sample.app();
        let mut timeline = Timeline::new(usize::MAX);
        assert!(timeline.go_to(app.world_mut(), end, |_| true));
        timeline.forget_after(a);
        assert!(timeline.steps().all(|step| step <= a));
        assert!(timeline.nearest_before(a).is_some(), "{}", sample.name);
        timeline.forget_all();
        assert!(timeline.nearest_before(end).is_none());
        assert_eq!(timeline.bytes(), 0);
    }
}
