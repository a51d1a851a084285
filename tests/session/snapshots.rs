//! Moments that are kept and put back.

use dyelapse::prelude::*;
use dyelapse::session::snapshot::Snapshot;

use crate::cloths::{assert_same, samples};
use crate::common::go_on;

#[test]
fn a_step_shows_the_same_cloth_wherever_one_stops_before() {
    for sample in samples() {
        let [a, b, c] = sample.stops;
        let mut app = sample.app();
        for stop in [0, 1, a, a + 1, b, b + 1, c - 1, c] {
            go_on(&mut app, stop);
        }
        let straight = sample.straight(c);
        assert_same(
            app.world(),
            straight.world(),
            sample.exact_ledger,
            sample.name,
        );
    }
}

#[test]
fn what_is_put_back_goes_on_as_if_nothing_had_been_in_between() {
    for sample in samples() {
        let [_, _, end] = sample.stops;
        // Everywhere: at steps where supply acts, between the ends of leaps, after the last step.
        for at in [0, 1, sample.stops[0], sample.stops[1], end / 2 + 1, end] {
            for looked in [false, true] {
                let what = format!("{} at {at}, looked at: {looked}", sample.name);
                let mut app = sample.app();
                assert!(advance_to(app.world_mut(), at, |_| true));
                if looked {
                    look(app.world_mut());
                }
                let snapshot = Snapshot::take(app.world());
                assert_eq!(snapshot.clock().step, at);
                go_on(&mut app, end);

                let mut fresh = sample.app();
                let mut back = sample.app();
                go_on(&mut back, end);
                for other in [&mut fresh, &mut back] {
                    snapshot.restore(other.world_mut());
                    go_on(other, end);
                    assert_same(app.world(), other.world(), true, &what);
                }
                let straight = sample.straight(end);
                assert_same(straight.world(), fresh.world(), sample.exact_ledger, &what);
            }
        }
    }
}

#[test]
fn a_moment_that_is_put_back_is_the_moment_that_was_kept() {
    for sample in samples() {
        let [at, _, end] = sample.stops;
        let mut app = sample.straight(at);
        let snapshot = Snapshot::take(app.world());
        go_on(&mut app, end);
        snapshot.restore(app.world_mut());
        look(app.world_mut());
        let straight = sample.straight(at);
        assert_same(app.world(), straight.world(), true, sample.name);
    }
}

#[test]
fn dye_that_someone_adds_after_a_moment_is_put_back_is_not_overlooked() {
    for sample in samples() {
        if sample.name == "sweeps" {
            // Their dye is elsewhere.
            continue;
        }
        let [at, _, end] = sample.stops;
        let add = |app: &mut bevy::app::App| {
            let mut free = app.world_mut().resource_mut::<FreeDye>();
            free.grow(7, 0.01);
        };
        let mut app = sample.app();
        assert!(advance_to(app.world_mut(), at, |_| true));
        let snapshot = Snapshot::take(app.world());
        add(&mut app);
        let touched = Snapshot::take(app.world());
        go_on(&mut app, end);
        let mut other = sample.app();
        snapshot.restore(other.world_mut());
        add(&mut other);
        go_on(&mut other, end);
        assert_same(app.world(), other.world(), true, sample.name);
        touched.restore(other.world_mut());
        go_on(&mut other, end);
        assert_same(app.world(), other.world(), true, sample.name);
    }
}

#[test]
fn a_moment_says_how_much_memory_it_takes() {
    for sample in samples() {
        let [at, ..] = sample.stops;
        let app = sample.straight(at);
        let cells = 2 * 70 * 45;
        let bytes = Snapshot::take(app.world()).bytes();
        assert!(bytes > 4 * cells, "{}: {bytes}", sample.name);
        assert!(bytes < 200 * cells, "{}: {bytes}", sample.name);
    }
}
