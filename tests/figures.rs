//! What paper D says that its figures show, measured on the bundled scenarios.
//!
//! `docs/figures.md` has the pictures and the numbers, which these tests print:
//! `cargo test --release --test figures -- --nocapture`.

mod common;
mod measures;

use bevy::prelude::World;
use common::dyed;
use dyelapse::prelude::*;
use dyelapse::scenario::{Isotherm, bundled};
use measures::Dyed;

/// A bundled scenario with changes, dyed to its end.
fn figure_with(name: &str, change: impl Fn(&mut Scenario)) -> Dyed {
    let mut scenario = Experiment::load(name).unwrap().scenario;
    change(&mut scenario);
    let steps = scenario.process.steps();
    let app = dyed(Experiment::from_scenario(name, scenario).unwrap(), steps);
    Dyed::of(app.world())
}

/// A bundled scenario, dyed to its end.
fn figure(name: &str) -> Dyed {
    figure_with(name, |_| {})
}

#[test]
fn fig_8b_keeps_more_dye_near_the_source_than_8a() {
    let near = |name| figure(name).share_within(20.0);
    let (free, binding) = (near("fig8a"), near("fig8b"));
    println!("share of the dye within 20 cells: 8a {free:.3}, 8b {binding:.3}");
    assert!(binding > 3.0 * free, "{binding} of 8b, {free} of 8a");
}

#[test]
fn dye_spreads_farther_along_the_yarns_than_across_them_in_8d_and_10_and_not_in_8a() {
    let ratio = |name| {
        let ratio = figure(name).spread_along_over_across();
        println!("{name}: variance along the weft over that across it {ratio:.3}");
        ratio
    };
    let even = ratio("fig8a");
    assert!((even - 1.0).abs() < 0.01, "8a: {even}");
    for name in ["fig10a", "fig10b", "fig10c"] {
        let along = ratio(name);
        assert!(along > 1.05, "{name}: {along}");
    }
    let d = ratio("fig8d");
    assert!(d > 1.15, "8d: {d}");
    assert!(ratio("fig8d_apart") > 1.5);
}

#[test]
fn cloth_is_mottled_in_8d_and_10_and_smooth_in_8a() {
    let mottle = |name| {
        let mottle = figure(name).seen().mottle();
        println!("{name}: mottle {mottle:.4}");
        mottle
    };
    let smooth = mottle("fig8a");
    assert!(smooth < 0.005, "8a: {smooth}");
    for name in ["fig8d", "fig10a", "fig10b", "fig10c"] {
        let mottled = mottle(name);
        assert!(mottled > 5.0 * smooth, "{name}: {mottled}, 8a: {smooth}");
    }
    assert!(mottle("fig8d_apart") > 3.0 * mottle("fig8d"));
}

#[test]
fn neither_layer_alone_shows_the_mottle_of_8d() {
    let cloth = figure("fig8d");
    let seen = cloth.seen().mottle();
    for layer in Layer::BOTH {
        let alone = cloth.layer(layer).mottle();
        println!("8d: mottle {seen:.4} seen, {alone:.4} in {layer:?} alone");
        assert!(seen > 3.0 * alone, "{seen} seen, {alone} in {layer:?}");
    }
}

#[test]
fn a_small_tau_3_v_makes_no_mottle_and_a_small_tau_3_i_does() {
    // Paper D's text has mottle come from a small τ₃ V, its Table 1 prints V = 1 and small I to III.
    let mottle = |i: f64, others: f64, v: f64| {
        let cloth = figure_with("fig8d", |scenario| {
            let paths = &mut scenario.cloth.paths;
            paths.between_layers = i;
            (paths.across_yarn, paths.yarn_to_gap) = (others, others);
            paths.along_yarn = v;
        });
        let layers = Layer::BOTH.map(|layer| cloth.layer(layer).mottle());
        // What neither layer has by itself, such as the steep edge of a drop that stays where it is.
        let mottle = cloth.seen().mottle() - layers[0].max(layers[1]);
        println!("tau 3 I {i}, II and III {others}, V {v}: mottle of both layers {mottle:.4}");
        mottle
    };
    let as_printed = mottle(0.005, 0.005, 1.0);
    for (i, others) in [(1.0, 1.0), (0.005, 1.0), (0.005, 0.005)] {
        let as_told = mottle(i, others, 0.005);
        assert!(
            as_printed > 8.0 * as_told,
            "{as_printed} printed, {as_told} told, I {i}"
        );
    }
    assert!(mottle(0.001, 0.005, 1.0) > 2.0 * as_printed);
    assert!(mottle(0.05, 0.005, 1.0) < 0.5 * as_printed);
}

#[test]
fn the_mottle_of_10_follows_the_weave() {
    let [plain, twill, satin] =
        ["fig10a", "fig10b", "fig10c"].map(|name| figure(name).seen().without_trend());
    for (name, weave) in [("10a", &plain), ("10b", &twill), ("10c", &satin)] {
        let ways = [(1, 0), (0, 1), (1, 1), (-1, 1), (2, 1)];
        let alike = ways.map(|way| format!("{way:?} {:.2}", weave.alike(way)));
        println!("{name}: alike {}", alike.join(", "));
    }
    for (one, other) in [(&plain, &twill), (&plain, &satin), (&twill, &satin)] {
        let alike = one.like(other);
        assert!(
            alike.abs() < 0.3,
            "two weaves have the same mottle: {alike}"
        );
    }
    // Plain: a chequer. Twill: diagonals one way. Satin: the move of its counter, one pick on.
    assert!(plain.alike((1, 0)) < -0.5 && plain.alike((0, 1)) < -0.5);
    assert!(plain.alike((1, 1)) > 0.5 && plain.alike((-1, 1)) > 0.5);
    assert!(twill.alike((1, 1)) > 0.5 && twill.alike((-1, 1)) < -0.4);
    assert!(satin.alike((2, 1)) > 0.3);
    for other in [(1, 0), (0, 1), (1, 1), (-1, 1), (1, 2), (-2, 1)] {
        assert!(satin.alike(other) < 0.1, "{other:?}");
    }
}

#[test]
fn figs_8f_and_8g_have_streaks_as_wide_as_a_yarn_and_many_crossings_long_and_8a_has_none() {
    for name in ["fig8f", "fig8g", "fig8f_text", "fig8g_text"] {
        let cloth = figure(name);
        let [weft, warp] = Layer::BOTH.map(|layer| cloth.layer(layer).without_trend());
        for (layer, deviations, [along, across]) in [
            (Layer::Weft, &weft, [(1, 0), (0, 1)]),
            (Layer::Warp, &warp, [(0, 1), (1, 0)]),
        ] {
            let depth = deviations.mottle;
            let [long, wide] = [along, across].map(|way| deviations.length(way));
            println!("{name}, {layer:?}: streaks {depth:.3} deep, go on for {long}, beside {wide}");
            assert!(depth > 0.05, "{name}, {layer:?}: {depth}");
            // In crossings: the next yarn has nothing to do with it.
            assert!(long >= 4 && wide == 0, "{name}, {layer:?}: {long}, {wide}");
        }
    }
    for layer in Layer::BOTH {
        let depth = figure("fig8a").layer(layer).mottle();
        assert!(depth < 0.005, "8a, {layer:?}: {depth}");
    }
}

#[test]
fn a_random_volume_ratio_shows_more_than_a_random_twist_with_any_seed() {
    for seed in [8, 9, 10] {
        let mottle = |name| {
            let cloth = figure_with(name, |scenario| scenario.seed = seed);
            cloth.seen().mottle()
        };
        // As Table 1 prints it, and as the text tells it.
        let (twist, porosity) = (mottle("fig8e"), mottle("fig8f"));
        println!("seed {seed}: mottle of 8e {twist:.3}, of 8f {porosity:.3}");
        assert!(porosity > 3.0 * twist, "{porosity}, {twist}, seed {seed}");
        let (both, squeezed) = (mottle("fig8e_text"), mottle("fig8f_text"));
        println!("seed {seed}, as in the text: of 8e {both:.3}, of 8f {squeezed:.3}");
        assert!(squeezed > 1.5 * both, "{squeezed}, {both}, seed {seed}");
    }
}

/// The share of the fibre that has bound at least a tenth of what it can.
fn share_that_binds(cloth: &Dyed) -> f64 {
    let (mut binds, mut all) = (0, 0);
    for (i, y, x) in cloth.cells() {
        let layer = Layer::BOTH[i / cloth.cloth.grid.layer_len()];
        let most = f64::from(cloth.cloth.capacity_bound(layer, y, x));
        if most > 0.0 {
            all += 1;
            binds += usize::from(cloth.bound[i] >= 0.1 * most);
        }
    }
    f64::from(binds as u32) / f64::from(all)
}

/// How far from the middle free dye has come, in cells: up to where there is 1 % of what is kept up
/// there. The corner of the cloth is 141 cells away.
fn front(cloth: &Dyed) -> f64 {
    let reached = cloth.cells().filter(|(i, ..)| cloth.free[*i] >= 0.01 * 0.5);
    let distances = reached.map(|(_, y, x)| cloth.distance_from_middle(y, x));
    distances.fold(0.0, f64::max)
}

#[test]
fn fig_9b_binds_dye_over_the_widest_area_and_the_front_of_9c_stays_closest_to_the_source() {
    let [a, b, c] = ["fig9a", "fig9b", "fig9c"].map(figure);
    let [area_a, area_b, area_c] = [&a, &b, &c].map(share_that_binds);
    assert!(
        area_b > 1.5 * area_a && area_b > 1.5 * area_c,
        "{area_a} {area_b} {area_c}"
    );
    let [front_a, front_b, front_c] = [&a, &b, &c].map(front);
    println!(
        "share that binds {area_a:.3} {area_b:.3} {area_c:.3}, front {front_a:.0} {front_b:.0} {front_c:.0}"
    );
    assert!(
        front_c < 0.75 * front_a.min(front_b),
        "{front_a} {front_b} {front_c}"
    );
}

#[test]
fn fig_9_is_so_with_other_constants_too_as_long_as_dye_has_not_reached_the_edges() {
    // φ₀ = 1 and a fifth of the time; K_L five times and k a fifth smaller.
    let at = |name, isotherm: Option<Isotherm>| {
        figure_with(name, |scenario| {
            scenario.dye.equilibrium = 1.0;
            scenario.process.duration = dyelapse::scenario::Time::Steps(10_000);
            if let (Some(isotherm), Some(adsorption)) = (isotherm, &mut scenario.adsorption) {
                adsorption.isotherm = isotherm;
            }
        })
    };
    let a = at("fig9a", None);
    for (b, c) in [
        (None, None),
        (
            Some(Isotherm::Freundlich { k: 0.4, b: 0.5 }),
            Some(Isotherm::Langmuir { kl: 20.0 }),
        ),
    ] {
        let (b, c) = (at("fig9b", b), at("fig9c", c));
        let [area_a, area_b, area_c] = [&a, &b, &c].map(share_that_binds);
        assert!(
            area_b > area_a && area_b > area_c,
            "{area_a} {area_b} {area_c}"
        );
        let [front_a, front_b, front_c] = [&a, &b, &c].map(front);
        println!("with phi 0 = 1 after 10,000 steps:");
        println!(
            "share that binds {area_a:.3} {area_b:.3} {area_c:.3}, front {front_a:.0} {front_b:.0} {front_c:.0}"
        );
        assert!(
            front_c < front_a.min(front_b),
            "{front_a} {front_b} {front_c}"
        );
    }
}

/// Means over the open arcs of seikaiha, by their distance from the nearest line of dye: the mean
/// amount of dye in cells of yarn, nearest first. And the same for what is pasted, over everything.
fn along_the_arcs(world: &World) -> (Vec<f64>, f64) {
    const BANDS: usize = 4;
    let dyed = Dyed::of(world);
    let cloth = &dyed.cloth;
    let (mut open, mut count) = ([0.0; BANDS], [0.0; BANDS]);
    let (mut pasted, mut pasted_count) = (0.0, 0.0);
    for (i, y, x) in dyed.cells() {
        let layer = Layer::BOTH[i / cloth.grid.layer_len()];
        if !cloth.fibre(layer, y, x) {
            continue;
        }
        // Lines are 400 cells apart, and begin at 200.
        let away = (x as f64 + 0.5 - 200.0).rem_euclid(400.0);
        let away = away.min(400.0 - away);
        let resist = cloth.resist.at(y, x);
        if resist < 0.01 {
            let band = (away / 200.0 * BANDS as f64) as usize;
            open[band] += dyed.free[i];
            count[band] += 1.0;
        } else if resist > 0.97 {
            pasted += dyed.free[i];
            pasted_count += 1.0;
        }
    }
    let open = open.iter().zip(count).map(|(sum, count)| sum / count);
    (open.collect(), pasted / pasted_count)
}

#[test]
fn seikaiha_fills_its_arcs_in_order_of_time_and_never_the_paste() {
    let mut app = dyeing_app(Experiment::load("seikaiha").unwrap());
    let mut before = vec![0.0; 4];
    for step in [12_500, 25_000, 50_000, 100_000, 200_000, 400_000] {
        common::go_on(&mut app, step);
        let (arcs, paste) = along_the_arcs(app.world());
        println!("step {step}: arcs {arcs:.4?}, paste {paste:.4}");
        for band in 0..arcs.len() {
            assert!(arcs[band] > before[band], "step {step}, band {band}");
            // Farther from the line there is always less.
            assert!(
                band == 0 || arcs[band] < arcs[band - 1],
                "step {step}: {arcs:?}"
            );
        }
        assert!(
            paste < 0.03 * arcs[0],
            "step {step}: {paste} of {}",
            arcs[0]
        );
        before = arcs;
    }
    // In the end all arcs are blue, and what is pasted holds next to nothing.
    assert!(before[3] > 0.5 * before[0], "{before:?}");
}

#[test]
fn the_cloths_of_fig_13_differ_in_every_way_that_they_can() {
    let figure = dyelapse::scenario::Figure::of(&["fig13"]).unwrap();
    let scenarios: Vec<_> = figure.experiments.iter().map(|e| &e.scenario).collect();
    assert!(scenarios.len() >= 8);
    let distinct = |what: &dyn Fn(&Scenario) -> String| {
        let all: std::collections::BTreeSet<_> = scenarios.iter().map(|s| what(s)).collect();
        all.len()
    };
    assert!(distinct(&|s| format!("{:?}", s.cloth.weave)) >= 5);
    assert!(distinct(&|s| format!("{:?}", s.cloth.paths)) >= 6);
    assert!(
        distinct(&|s| format!(
            "{:?} {:?}",
            s.cloth.warp.porosity, s.cloth.warp.vary_porosity
        )) >= 4
    );
    assert!(distinct(&|s| format!("{:?} {:?}", s.cloth.warp.width, s.cloth.warp.gap)) >= 3);
    assert!(distinct(&|s| format!("{:?}", s.look.colours)) >= 7);
    let names = |s: &Scenario| format!("{:?}", s.adsorption.map(|a| a.isotherm));
    let isotherms = distinct(&|s| names(s).chars().take_while(|c| *c != '{').collect());
    assert!(isotherms >= 4, "{isotherms}");
    assert!(distinct(&|s| format!("{:?}", s.resist)) >= 6);
    // All of them come with the program.
    for experiment in &figure.experiments {
        assert!(bundled().any(|bundled| bundled.name == experiment.name));
    }
}
