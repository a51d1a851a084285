//! The panel of the window, shown without a window: what it shows changes nothing, and what it changes can
//! always be dyed.
#![cfg(feature = "viewer")]

use bevy_egui::egui::{
    Context, Event, FontId, Key, Modifiers, PointerButton, Pos2, RawInput, Rect, pos2, vec2,
};
use dyelapse::cloth::Weave;
use dyelapse::pattern::Pattern;
use dyelapse::scenario::{Draping, Experiment, Length, Scenario, SupplySpec, Time, bundled_names};
use dyelapse::watch::panel::{
    Change, Control, Kind, NAMED_WEAVES, PanelAsk, PanelState, Pull, answer, parameters, weave,
};

/// A panel with everything open, 300 points wide.
struct Shown {
    context: Context,
    state: PanelState,
    editor: bool,
    time: f64,
}

impl Shown {
    fn new(editor: bool) -> Self {
        let mut state = PanelState::default();
        state.open_all(true);
        state.list_controls();
        Shown {
            context: Context::default(),
            state,
            editor,
            time: 0.0,
        }
    }

    fn pass(&mut self, scenario: &mut Scenario, events: Vec<Event>) -> Option<Change> {
        self.time += 0.1;
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(300.0, 800.0))),
            time: Some(self.time),
            events,
            ..RawInput::default()
        };
        let mut change = None;
        let show = if self.editor { weave } else { parameters };
        let output = self.context.run_ui(input, |ui| {
            change = show(ui, scenario, &mut self.state).or(change.take());
        });
        output.drop_without_applying_deltas();
        change
    }

    fn controls(&mut self, scenario: &mut Scenario) -> Vec<Control> {
        self.pass(scenario, Vec::new());
        self.state.controls().to_vec()
    }

    fn pull(&mut self, scenario: &mut Scenario, control: usize, pull: Pull) -> Option<Change> {
        self.state.pull(control, pull);
        self.pass(scenario, Vec::new())
    }

    /// Moves the control of this name.
    fn pull_named(&mut self, scenario: &mut Scenario, name: &str, pull: Pull) -> Option<Change> {
        let controls = self.controls(scenario);
        let control = controls.iter().position(|control| control.name == name);
        let control = control.unwrap_or_else(|| panic!("no control {name} among {controls:?}"));
        self.pull(scenario, control, pull)
    }

    fn click(&mut self, scenario: &mut Scenario, at: Pos2) -> Vec<Change> {
        let button = |pressed| Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::default(),
        };
        let passes = [
            vec![Event::PointerMoved(at)],
            vec![button(true)],
            vec![button(false)],
            vec![Event::PointerMoved(pos2(2.0, 2.0))],
        ];
        let changes = passes.map(|events| self.pass(scenario, events));
        changes.into_iter().flatten().collect()
    }
}

fn scenario(name: &str) -> Scenario {
    Experiment::load(name).unwrap().scenario
}

/// Scenarios that have between them everything that a panel can show.
fn all_kinds() -> Vec<Scenario> {
    let names = [
        "seikaiha",
        "kasuri",
        "batik_lotus",
        "batik_tablecloth",
        "kiku",
        "rain",
        "ripples",
        "moonrise",
        "itajime",
    ];
    let mut all: Vec<Scenario> = names.map(scenario).to_vec();
    for name in [
        "handkerchief",
        "pulled_silk",
        "seikaiha_hanging",
        "fractal_sphere",
    ] {
        let mut scenario = scenario(name);
        let spec = scenario
            .drape
            .as_ref()
            .map(|drape| drape.spec(&Default::default()).unwrap());
        scenario.drape = spec.map(|spec| Draping::Own(Box::new(spec)));
        all.push(scenario);
    }
    let mut diffusion = scenario("batik_lotus");
    diffusion.batik.as_mut().unwrap().solver = dyelapse::scenario::BatikSolver::Diffusion;
    diffusion.supply.push(SupplySpec::Bath {
        shape: Pattern::Everywhere,
        dose: 1.0,
        speed: 0.3,
        from: Time::Minutes(1.0),
        until: Some(Time::Hours(1.0)),
    });
    all.push(diffusion);
    for scenario in &all {
        scenario.check().unwrap();
    }
    all
}

/// What can be done to a control at its extremes.
fn pulls(kind: Kind) -> Vec<Pull> {
    match kind {
        Kind::Number(least, most) => vec![Pull::To(least), Pull::To(most)],
        Kind::Choice(n) => (0..n).map(Pull::Choose).collect(),
        Kind::Tick | Kind::Button => vec![Pull::Press],
    }
}

#[test]
fn showing_a_scenario_changes_nothing() {
    for name in bundled_names() {
        let before = scenario(name);
        for editor in [false, true] {
            let mut after = before.clone();
            let mut shown = Shown::new(editor);
            for _ in 0..3 {
                assert_eq!(shown.pass(&mut after, Vec::new()), None, "{name}");
            }
            assert_eq!(after, before, "{name}");
            assert!(shown.state.controls().len() > 2);
        }
    }
}

#[test]
fn whatever_one_control_does_leaves_a_scenario_that_can_be() {
    for before in all_kinds() {
        for editor in [false, true] {
            let mut shown = Shown::new(editor);
            let controls = shown.controls(&mut before.clone());
            for (i, control) in controls.iter().enumerate() {
                for pull in pulls(control.kind) {
                    let mut after = before.clone();
                    let change = shown.pull(&mut after, i, pull);
                    let told = format!("{}: {control:?} {pull:?}", before.title);
                    after.check().unwrap_or_else(|why| panic!("{told}: {why}"));
                    assert_eq!(change.is_some(), after != before, "{told}: {change:?}");
                    let again = after.clone();
                    assert_eq!(shown.pass(&mut after, Vec::new()), None, "{told}");
                    assert_eq!(after, again, "{told}");
                }
            }
        }
    }
}

#[test]
fn however_one_plays_with_the_controls_the_scenario_can_be() {
    for (seed, mut now) in all_kinds().into_iter().enumerate() {
        let mut state = seed as u64 + 1;
        let mut draw = |n: usize| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            ((state >> 33) as usize) % n.max(1)
        };
        let mut shown = Shown::new(false);
        let mut told = Vec::new();
        for _ in 0..250 {
            let controls = shown.controls(&mut now);
            let i = draw(controls.len());
            let pull = match controls[i].kind {
                Kind::Number(least, most) => {
                    let share = [0.0, 0.001, 0.1, 0.5, 1.0][draw(5)];
                    Pull::To(least + share * (most - least))
                }
                Kind::Choice(n) => Pull::Choose(draw(n)),
                Kind::Tick | Kind::Button => Pull::Press,
            };
            shown.pull(&mut now, i, pull);
            told.push((controls[i].name.clone(), pull));
            let last = &told[told.len().saturating_sub(6)..];
            now.check()
                .unwrap_or_else(|why| panic!("{}: {last:?}: {why}", now.title));
        }
    }
}

/// The lengths of a scenario in cells, and its times in steps.
fn measures(scenario: &Scenario) -> Vec<f64> {
    let (cell_mm, step_h) = (scenario.cloth.cell_mm, scenario.process.step_h);
    let cloth = &scenario.cloth;
    let mut lengths = vec![cloth.size.0, cloth.size.1, cloth.warp.width, cloth.warp.gap];
    for (pattern, _) in scenario.patterns() {
        match pattern {
            Pattern::Stripes {
                width, gap, offset, ..
            } => lengths.extend([*width, *gap, *offset]),
            Pattern::Blur { radius, .. } | Pattern::Seikaiha { radius, .. } => {
                lengths.push(*radius)
            }
            Pattern::Disc { diameter, .. } => lengths.push(*diameter),
            _ => {}
        }
    }
    let mut times = vec![scenario.process.duration];
    times.extend(&scenario.record.sheet);
    for supply in &scenario.supply {
        if let SupplySpec::Dose { at, .. } = supply {
            times.push(*at);
        }
    }
    let cells = lengths
        .into_iter()
        .map(|length: Length| length.cells(cell_mm));
    let steps = times
        .into_iter()
        .map(|time: Time| time.steps(step_h) as f64);
    cells.chain(steps).collect()
}

#[test]
fn another_unit_leaves_lengths_and_times_as_they_are() {
    for name in ["seikaiha", "kiku", "rain", "itajime"] {
        let before = scenario(name);
        let mut shown = Shown::new(false);
        let controls = shown.controls(&mut before.clone());
        let mut units = 0;
        for (i, pair) in controls.windows(2).enumerate() {
            let (Kind::Number(..), Kind::Choice(n)) = (pair[0].kind, pair[1].kind) else {
                continue;
            };
            if pair[0].name != pair[1].name {
                continue;
            }
            units += 1;
            for unit in 0..n {
                let mut after = before.clone();
                shown.pull(&mut after, i + 1, Pull::Choose(unit));
                for (was, is) in measures(&before).iter().zip(measures(&after)) {
                    assert!(
                        (was - is).abs() <= 1e-9 * was.abs(),
                        "{name} {pair:?}: {was} {is}"
                    );
                }
            }
        }
        assert!(units > 5, "{name}: {units}");
    }
}

#[test]
fn a_number_that_is_dragged_is_held_until_it_is_let_go() {
    let before = scenario("seikaiha");
    let button = |pos, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::default(),
    };
    let mut found = 0;
    // Somewhere below the search field is the one row that is looked for.
    for y in (24..120).step_by(6) {
        let mut now = before.clone();
        let mut shown = Shown::new(false);
        shown.state.search("dye diffusivity");
        let at = |x: f32| pos2(x, y as f32);
        shown.pass(&mut now, vec![Event::PointerMoved(at(220.0))]);
        shown.pass(&mut now, vec![button(at(220.0), true)]);
        let mut changes = Vec::new();
        for x in [230.0, 250.0, 290.0, 1e6, -1e6, 240.0] {
            changes.extend(shown.pass(&mut now, vec![Event::PointerMoved(at(x))]));
            now.check().unwrap();
        }
        let let_go = shown.pass(&mut now, vec![button(at(240.0), false)]);
        if changes.is_empty() {
            assert_eq!(now, before);
            continue;
        }
        found += 1;
        assert!(changes.len() > 2 && let_go.is_none_or(|change| !change.held));
        for change in changes {
            assert!(
                change.held && change.label.contains("diffusivity"),
                "{change:?}"
            );
        }
    }
    assert!(found > 0);
}

#[test]
fn the_strangest_scenarios_that_can_be_are_shown_and_changed() {
    let mut strange = Vec::new();
    let mut large = scenario("seikaiha");
    large.cloth.weave = Weave::Twill {
        over: 2048,
        under: 2048,
    };
    large.cloth.size = (Length::Cells(1_048_576.0), Length::Cells(1.0));
    strange.push(large);
    let mut small = scenario("rain");
    small.cloth.size = (Length::Cells(1.0), Length::Cells(1.0));
    small.cloth.cell_mm = 1e-4;
    small.process.step_h = 1e-9;
    small.cloth.weave = Weave::Matrix(vec!["X".into()]);
    small.resist = Pattern::Union(Vec::new());
    small.supply.clear();
    strange.push(small);
    let mut deep = scenario("kasuri");
    deep.resist = (0..40).fold(Pattern::Everywhere, |of, _| Pattern::Invert(Box::new(of)));
    deep.process.duration = Time::Days(1e6);
    deep.record.frames = Some(1_000_000);
    deep.process.step_h = 1e-3;
    strange.push(deep);
    for before in strange {
        before.check().unwrap();
        for editor in [false, true] {
            let mut shown = Shown::new(editor);
            let controls = shown.controls(&mut before.clone());
            for (i, control) in controls.iter().enumerate() {
                for pull in pulls(control.kind) {
                    let mut after = before.clone();
                    shown.pull(&mut after, i, pull);
                    let told = format!("{control:?} {pull:?}");
                    after.check().unwrap_or_else(|why| panic!("{told}: {why}"));
                    shown.pass(&mut after, Vec::new());
                }
            }
        }
    }
}

#[test]
fn a_number_that_is_typed_is_taken_to_its_last_digit() {
    let mut before = scenario("seikaiha");
    before.seed = 123_456_789;
    let enter = |pressed| Event::Key {
        key: Key::Enter,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: Modifiers::default(),
    };
    let seeds = (24..120).step_by(6).map(|y| {
        let mut now = before.clone();
        let mut shown = Shown::new(false);
        shown.state.search("seed");
        shown.click(&mut now, pos2(220.0, y as f32));
        shown.pass(&mut now, vec![Event::Text("123456790".into())]);
        shown.pass(&mut now, vec![enter(true), enter(false)]);
        shown.pass(&mut now, Vec::new());
        now.seed
    });
    let seeds: Vec<u64> = seeds.collect();
    assert!(seeds.contains(&123_456_790), "{seeds:?}");
}

#[test]
fn a_named_weave_is_the_weave_of_that_name() {
    for (i, named) in NAMED_WEAVES.iter().enumerate() {
        for editor in [false, true] {
            let mut now = scenario("ripples");
            let name = "named weave of the weave";
            Shown::new(editor).pull_named(&mut now, name, Pull::Choose(i));
            assert_eq!(now.cloth.weave, named.weave(), "{}", named.name);
            now.check().unwrap();
        }
    }
    let matrix = |name: &str| {
        let named = NAMED_WEAVES.iter().find(|named| named.name == name);
        named.unwrap().weave().matrix()
    };
    let risers = |name, p| {
        let matrix = matrix(name);
        (0..matrix.ends()).filter(|e| matrix.warp_up(*e, p)).count()
    };
    assert_eq!(risers("twill 3/1 (denim)", 0), 3);
    assert_eq!(risers("satin 8", 3), 7);
    assert_eq!(risers("sateen 8", 3), 1);
    assert_eq!(risers("hopsack 2/2", 1), 2);
}

#[test]
fn a_click_turns_over_the_crossing_that_is_clicked_and_no_other() {
    for named in NAMED_WEAVES {
        let mut now = scenario("ripples");
        now.cloth.weave = named.weave();
        let before = now.cloth.weave.matrix();
        let mut shown = Shown::new(true);
        shown.pass(&mut now, Vec::new());
        shown.pass(&mut now, Vec::new());
        let (e, p) = (before.ends() - 1, 1);
        let cell = shown.state.weave_cell(e, p).unwrap();
        let changes = shown.click(&mut now, cell.center());
        assert_eq!(changes.len(), 1, "{}: {changes:?}", named.name);
        let after = now.cloth.weave.matrix();
        assert_eq!(
            (after.ends(), after.picks()),
            (before.ends(), before.picks())
        );
        for pick in 0..before.picks() {
            for end in 0..before.ends() {
                let turned = before.warp_up(end, pick) != after.warp_up(end, pick);
                assert_eq!(
                    turned,
                    (end, pick) == (e, p),
                    "{}: {end} {pick}",
                    named.name
                );
            }
        }
    }
}

#[test]
fn moving_a_weave_back_and_forth_leaves_it_as_it_was() {
    let there_and_back = [
        ["Shift to the left", "Shift to the right"],
        ["Shift up", "Shift down"],
        ["Mirror left and right", "Mirror left and right"],
        ["Mirror top and bottom", "Mirror top and bottom"],
        ["Invert: what was up is down", "Invert: what was up is down"],
    ];
    let before = scenario("ripples");
    let move_by = |now: &mut Scenario, name: &str| {
        Shown::new(true).pull_named(now, &format!("{name} of the weave"), Pull::Press)
    };
    for [there, back] in there_and_back {
        let mut now = before.clone();
        assert!(move_by(&mut now, there).is_some());
        assert_ne!(
            now.cloth.weave.matrix(),
            before.cloth.weave.matrix(),
            "{there}"
        );
        move_by(&mut now, back);
        assert_eq!(
            now.cloth.weave.matrix(),
            before.cloth.weave.matrix(),
            "{there}"
        );
    }
    let mut now = before.clone();
    for _ in 0..4 {
        move_by(&mut now, "Rotate by a quarter turn: warp becomes weft");
    }
    assert_eq!(now.cloth.weave.matrix(), before.cloth.weave.matrix());
}

#[test]
fn a_larger_repeat_goes_on_as_the_smaller_one_did() {
    let mut now = scenario("seikaiha");
    let mut shown = Shown::new(true);
    shown.pull_named(&mut now, "ends of the weave", Pull::To(6.0));
    shown.pull_named(&mut now, "picks of the weave", Pull::To(4.0));
    let (large, plain) = (now.cloth.weave.matrix(), Weave::Plain.matrix());
    assert_eq!((large.ends(), large.picks()), (6, 4));
    assert!((0..24).all(|i| large.warp_up(i % 6, i / 6) == plain.warp_up(i % 6, i / 6)));
}

#[test]
fn a_picture_is_put_where_it_was_asked_for() {
    for name in [
        "seikaiha", "kasuri", "itajime", "moonrise", "kumo", "danzome",
    ] {
        let before = scenario(name);
        let places: Vec<String> = before
            .patterns()
            .iter()
            .map(|(_, at)| at.path().into())
            .collect();
        for place in places {
            let mut after = before.clone();
            let path = format!("{place}.file");
            answer(
                &mut after,
                &PanelAsk::OpenImage { path: path.clone() },
                "cloud.png",
            );
            let pictures = after.pictures();
            let found: Vec<(&str, &str)> = pictures
                .iter()
                .map(|(file, _, at)| (*file, at.path()))
                .collect();
            assert_eq!(found, [("cloud.png", path.as_str())], "{name}");
        }
    }
    let mut cloth = scenario("seikaiha");
    answer(&mut cloth, &PanelAsk::OpenWif, "twill.wif");
    assert!(matches!(&cloth.cloth.weave, Weave::Wif { file, .. } if file == "twill.wif"));
}

#[test]
fn a_shape_that_is_combined_becomes_a_part_of_the_combination() {
    let mut now = scenario("seikaiha");
    let before = now.resist.clone();
    let union = Pull::Choose(13);
    Shown::new(false).pull_named(&mut now, "pattern of the resist", union);
    let Pattern::Strength { of, .. } = before else {
        panic!("the resist of seikaiha is weakened")
    };
    assert_eq!(now.resist, Pattern::Union(vec![*of]));
}

#[test]
fn a_search_shows_only_what_is_looked_for() {
    let mut now = scenario("seikaiha");
    let mut shown = Shown::new(false);
    shown.state.search("warp porosity");
    let controls = shown.controls(&mut now);
    assert!(!controls.is_empty());
    for control in controls {
        let name = control.name.to_lowercase();
        assert!(name.contains("warp") && name.contains("porosity"), "{name}");
    }
}

#[test]
fn the_default_font_has_every_sign_that_names_and_buttons_use() {
    let mut names = String::from("↻×…°²·√τ₀₁₂₃φαΔ–“”");
    for mut scenario in all_kinds() {
        for editor in [false, true] {
            let controls = Shown::new(editor).controls(&mut scenario);
            names.extend(controls.into_iter().map(|control| control.name));
        }
    }
    let mut shown = Shown::new(false);
    shown.pass(&mut scenario("seikaiha"), Vec::new());
    let font = FontId::default();
    let missing: String = shown.context.fonts_mut(|fonts| {
        names
            .chars()
            .filter(|c| !fonts.has_glyph(&font, *c))
            .collect()
    });
    assert_eq!(missing, "");
}
