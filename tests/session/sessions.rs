//! A session: whatever is changed, what is seen is what a run of the present scenario shows.

use bevy::app::App;
use bevy::ecs::world::World;
use dyelapse::pattern::{Pattern, Stroke};
use dyelapse::prelude::*;
use dyelapse::scenario::{Length, SupplySpec, Time};
use dyelapse::session::Session;
use dyelapse::session::effect::Effect;
use dyelapse::session::paint::Paint;

use crate::cloths::{Sample, assert_same, samples};
use crate::common::{experiment, go_on};

const BUDGET: usize = 16 << 20;

fn open(sample: &Sample) -> (App, Session) {
    let mut app = App::new();
    app.add_plugins(DyeingPlugins);
    let session = Session::open(app.world_mut(), experiment(&sample.text), BUDGET);
    (app, session)
}

/// Demands that a world shows what a run of the session's saved scenario shows.
fn assert_true(world: &World, session: &Session, exact: bool, what: &str) {
    assert!(session.has_arrived(world), "{what} has not arrived");
    let saved = session.experiment().text;
    let mut straight = dyeing_app(experiment(&saved));
    go_on(&mut straight, session.target());
    assert_same(world, straight.world(), exact, what);
}

fn stroke(x: f64) -> Stroke {
    Stroke::along(Length::Cells(5.0), [(x, 0.2), (1.0 - x, 0.8)])
}

#[test]
fn what_is_painted_is_what_the_saved_scenario_shows_and_undo_takes_it_back() {
    for sample in samples() {
        let [at, later, end] = sample.stops;
        let (mut app, mut session) = open(&sample);
        let world = app.world_mut();
        let check = |world: &World, session: &Session, what: &str| {
            let what = format!("{}: {what}", sample.name);
            assert_true(world, session, sample.exact_ledger, &what);
        };
        // Twice at one step, once later, and once after going back.
        for (step, x) in [(at, 0.1), (at, 0.4), (later, 0.3), (at + 1, 0.6)] {
            assert!(session.go_to(world, step, |_| true));
            let painted = session.paint(world, Paint::Dye(0.8), stroke(x));
            if sample.name == "sweeps" {
                assert!(painted.is_err());
                check(world, &session, "nothing painted");
                continue;
            }
            assert_eq!(painted.unwrap(), Effect::FromStep(step));
            assert_eq!(session.target(), step);
            assert!(session.go_on(world, |_| true));
            check(world, &session, "painted");
        }
        assert!(session.go_to(world, end, |_| true));
        check(world, &session, "at the end");
        while session.history().undoable().is_some() {
            session.undo(world).unwrap();
            assert!(session.go_on(world, |_| true));
            check(world, &session, "undone");
        }
        assert_eq!(*session.scenario(), experiment(&sample.text).scenario);
        while session.history().redoable().is_some() {
            session.redo(world).unwrap();
        }
        assert!(session.go_to(world, later, |_| true));
        check(world, &session, "done again");
    }
}

#[test]
fn resist_and_wax_join_what_is_there_and_the_process_begins_anew_up_to_this_step() {
    for sample in samples() {
        let [at, ..] = sample.stops;
        let (mut app, mut session) = open(&sample);
        let world = app.world_mut();
        assert!(session.go_to(world, at, |_| true));
        for paint in [Paint::Wax, Paint::Resist] {
            if sample.name == "sweeps" && paint == Paint::Resist {
                assert!(session.paint(world, paint, stroke(0.2)).is_err());
                continue;
            }
            let needed = session.paint(world, paint, stroke(0.2)).unwrap();
            assert_eq!(needed, Effect::Restart, "{}", sample.name);
            assert_eq!(session.target(), at);
            assert!(session.go_on(world, |_| true));
            let what = format!("{} {paint:?}", sample.name);
            assert_true(world, &session, sample.exact_ledger, &what);
        }
    }
}

#[test]
fn edits_of_every_kind_show_what_their_scenario_shows() {
    for sample in samples() {
        let [at, ..] = sample.stops;
        let (mut app, mut session) = open(&sample);
        let world = app.world_mut();
        assert!(session.go_to(world, at, |_| true));
        let mut edits: Vec<Scenario> = Vec::new();
        let mut edit = |change: &dyn Fn(&mut Scenario)| {
            let mut scenario = edits.last().cloned().unwrap_or(session.scenario().clone());
            change(&mut scenario);
            edits.push(scenario);
        };
        edit(&|s| s.look.pixels_per_cell = 2);
        edit(&|s| s.look.side = dyelapse::scenario::Side::Back);
        edit(&|s| s.title = "another".into());
        edit(&|s| s.cloth.warp.gap = Length::Cells(2.0));
        edit(&|s| {
            if let Some(batik) = &mut s.batik {
                batik.show_wax = false;
                batik.cloth = (10.0, 0.2, 0.9);
            } else {
                s.process.duration = Time::Steps(s.process.steps() + 500);
                s.process.solver = dyelapse::scenario::Solver::Accelerated;
            }
        });
        edit(&|s| {
            if s.batik.is_none() {
                s.supply.insert(
                    0,
                    SupplySpec::Hold {
                        shape: Pattern::Everywhere,
                        dose: 0.1,
                        from: Time::Steps(at / 2),
                        until: None,
                    },
                );
            }
        });
        for scenario in edits {
            session.edit(world, scenario, "edit", false).unwrap();
            assert!(session.go_on(world, |_| true));
            assert_true(world, &session, sample.exact_ledger, sample.name);
        }
        while session.history().undoable().is_some() {
            session.undo(world).unwrap();
            assert!(session.go_on(world, |_| true));
            assert_true(world, &session, sample.exact_ledger, sample.name);
        }
    }
}

#[test]
fn an_edit_that_cannot_be_changes_nothing() {
    let sample = &samples()[1];
    let (mut app, mut session) = open(sample);
    let world = app.world_mut();
    assert!(session.go_to(world, 700, |_| true));
    let mut wrong = session.scenario().clone();
    wrong.cloth.warp.porosity = 7.0;
    let why = session.edit(world, wrong, "porosity", false).unwrap_err();
    assert!(why.to_string().contains("cloth.warp.porosity"), "{why}");
    let mut gone = session.scenario().clone();
    gone.resist = Pattern::Image {
        file: "no_such.png".into(),
        fit: Default::default(),
    };
    assert!(session.edit(world, gone, "resist", false).is_err());
    assert!(session.history().is_empty());
    assert_true(world, &session, true, "unchanged");
}

#[test]
fn a_session_that_may_do_little_at_a_time_gets_there_all_the_same() {
    let sample = &samples()[0];
    let (mut app, mut session) = open(sample);
    let world = app.world_mut();
    // A frame of the window: a few runs, then back.
    let mut frames = 0;
    while session.target() < 6000 || !session.has_arrived(world) {
        let mut runs = 0;
        session.advance(world, 500, |_| {
            runs += 1;
            runs <= 2
        });
        assert!(session.timeline().bytes() <= BUDGET);
        frames += 1;
        assert!(frames < 10_000);
    }
    assert_true(world, &session, true, "played");
    assert!(session.course().points().count() > 5);
    // Beyond the end there is nothing.
    assert!(session.go_to(world, u64::MAX, |_| true));
    assert_eq!(session.target(), 20_000);
}

#[test]
fn a_recording_of_what_is_saved_has_the_pictures_that_were_seen() {
    let sample = &samples()[2];
    let (mut app, mut session) = open(sample);
    let world = app.world_mut();
    assert!(session.go_to(world, 1000, |_| true));
    session.paint(world, Paint::Dye(0.9), stroke(0.3)).unwrap();
    assert!(session.go_to(world, 1700, |_| true));
    session.paint(world, Paint::Resist, stroke(0.7)).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("saved.ron");
    std::fs::write(&file, session.experiment().text).unwrap();
    let experiment = Experiment::load(file.to_str().unwrap()).unwrap();
    let out = folder.path().join("recording");
    let options = dyelapse::record::Options {
        out: out.clone(),
        frames: Some(5),
        ..Default::default()
    };
    let recording = dyelapse::record::record(&experiment, &options, |_| true).unwrap();
    assert_eq!(recording.frames, 5);
    let manifest = std::fs::read_to_string(out.join("manifest.ron")).unwrap_or_default();
    let mut frames: Vec<_> = std::fs::read_dir(&out)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| {
            let name = path.file_name().and_then(|name| name.to_str());
            name.is_some_and(|name| name.starts_with("frame") && name.ends_with(".png"))
        })
        .collect();
    frames.sort();
    assert_eq!(frames.len(), 5, "{manifest}");
    // Seen in another order than they were recorded in.
    for i in [2, 4, 0, 3, 1] {
        assert!(session.go_to(world, 1000 * i, |_| true));
        let frame = image::open(&frames[i as usize]).unwrap().to_rgb8();
        assert!(frame.into_raw() == world.resource::<Picture>().rgb, "{i}");
    }
}
