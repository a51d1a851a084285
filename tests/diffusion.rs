//! Diffusion against what is known of it: the analytic solution, its symmetries, and an
//! independent solver in double precision.
#![allow(clippy::disallowed_methods)] // A test may use the platform's own functions.

mod common;
mod reference;

use common::{bound, concentration, dyed, experiment, go_on};
use dyelapse::cloth::{Parts, Weave, Yarn, Yarns};
use dyelapse::diffusion::{self, Faces};
use dyelapse::pattern::Raster;
use dyelapse::prelude::*;
use dyelapse::scenario::Paths;
use reference::Reference;

/// The largest error against the Gaussian, relative to its peak, with cells of `cell_mm`.
fn error_against_the_gaussian(cell_mm: f64) -> f64 {
    // A uniform cloth: one endless yarn, no gaps, no dives; D = D₀·P in all directions.
    let (side_mm, hours, begin_variance) = (6.4, 0.04, 0.09);
    let step_h = 0.2 * cell_mm * cell_mm;
    let mut app = dyeing_app(experiment(&format!(
        "(
            title: \"drop\",
            cloth: (
                size: (Mm({side_mm}), Mm({side_mm})), cell_mm: {cell_mm},
                warp: (width: Mm({side_mm}), gap: Cells(0)), paths: (dive: 1.0),
            ),
            supply: [],
            process: (duration: Hours({hours}), step_h: {step_h}, solver: Explicit),
        )"
    )));
    let steps = (hours / step_h).round() as u64;
    let d = 1.93 * 0.5;
    let grid = app.world().resource::<Cloth>().grid;
    let gaussian = |y: usize, x: usize, variance: f64| {
        let distance = |i: usize| (i as f64 + 0.5) * cell_mm - side_mm / 2.0;
        let square = distance(x).powi(2) + distance(y).powi(2);
        begin_variance / variance * (-square / (2.0 * variance)).exp()
    };
    let dye = &mut app.world_mut().resource_mut::<FreeDye>().concentration;
    for layer in Layer::BOTH {
        for y in 0..grid.ny {
            for x in 0..grid.nx {
                dye[grid.index(layer, y, x)] = gaussian(y, x, begin_variance) as f32;
            }
        }
    }
    assert!(advance_to(app.world_mut(), steps, |_| true));
    let variance = begin_variance + 2.0 * d * steps as f64 * step_h;
    let mut worst = 0.0_f64;
    for y in 0..grid.ny {
        for x in 0..grid.nx {
            let c = f64::from(concentration(&app)[grid.index(Layer::Weft, y, x)]);
            worst = worst.max((c - gaussian(y, x, variance)).abs());
        }
    }
    worst / (begin_variance / variance)
}

#[test]
fn a_drop_on_uniform_cloth_follows_the_gaussian_and_its_error_falls_with_the_cells_square() {
    // With Δt ∝ Δd² both errors of the scheme fall with Δd²: a quarter for every halving.
    let errors = [0.2, 0.1, 0.05].map(error_against_the_gaussian);
    assert!(errors[2] < 1e-3, "{errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!(
            (1.8..2.3).contains(&order),
            "order {order}, errors {errors:?}"
        );
    }
}

/// A small uneven cloth whose first and last cells are yarn, so that it can be turned over.
fn uneven(nx: usize, ny: usize, gap: usize) -> Parts {
    let yarns = |width: usize, cells: usize, salt: usize| {
        Yarns::lay(cells, |i| {
            let yarn = Yarn {
                porosity: 0.2 + 0.3 * ((i * 7 + salt) % 5) as f64 / 4.0,
                twist: 0.4 + 0.6 * ((i * 3 + salt) % 4) as f64 / 3.0,
                squeeze: 0.1 * ((i + salt) % 3) as f64,
                ..Yarn::default()
            };
            (yarn, width, gap)
        })
    };
    Parts {
        cell_mm: 0.05,
        warp: yarns(3, nx, 1),
        weft: yarns(2, ny, 2),
        weave: Weave::Matrix(vec!["XX.X.".into(), ".X..X".into(), "X.XX.".into()]).matrix(),
        mask: None,
        gap_porosity: [0.35, 0.45],
        resist: Raster::from_rule(nx, ny, |x, y| {
            (0.9 * (0.5 + 0.5 * (0.9 * x + 1.7 * y + 0.13 * x * y).sin())) as f32
        }),
    }
}

const PATHS: Paths = Paths {
    dive: 0.47,
    between_layers: 0.3,
    across_yarn: 0.2,
    yarn_to_gap: 0.6,
    gap_to_gap: 0.9,
    along_yarn: 0.8,
};

/// Spreads `begin` on a cloth for 300 steps.
fn spread(parts: Parts, dive: f64, begin: &[f32], equilibrium: f64) -> Vec<f32> {
    let cloth = Cloth::assemble(parts);
    let faces = Faces {
        cloth: &cloth,
        paths: &Paths { dive, ..PATHS },
        in_water: 1.93,
    };
    let conductances = Conductances::new(&cloth, &faces, 0.0005, 0.0);
    let (mut now, mut next) = (begin.to_vec(), vec![0.0; begin.len()]);
    let mut carry = vec![0.0; begin.len()];
    for _ in 0..300 {
        diffusion::step(&conductances, equilibrium, &now, &mut carry, &mut next);
        std::mem::swap(&mut now, &mut next);
    }
    now
}

fn rearranged(
    field: &[f32],
    from: Grid,
    to: Grid,
    at: impl Fn(Layer, usize, usize) -> (Layer, usize, usize),
) -> Vec<f32> {
    let mut turned = vec![0.0; field.len()];
    for layer in Layer::BOTH {
        for y in 0..to.ny {
            for x in 0..to.nx {
                let (l, v, u) = at(layer, y, x);
                turned[to.index(layer, y, x)] = field[from.index(l, v, u)];
            }
        }
    }
    turned
}

fn turned_raster(
    raster: &Raster,
    nx: usize,
    ny: usize,
    at: impl Fn(usize, usize) -> (usize, usize),
) -> Raster {
    let mut turned = Raster::uniform(nx, ny, 0.0);
    for y in 0..ny {
        for x in 0..nx {
            let (v, u) = at(y, x);
            turned.values[y * nx + x] = raster.at(v, u);
        }
    }
    turned
}

/// A weave redrawn over `ends` × `picks` crossings.
fn redrawn(ends: usize, picks: usize, up: impl Fn(usize, usize) -> bool) -> Weave {
    let drawn = |p: usize| {
        (0..ends)
            .map(|e| if up(e, p) { 'X' } else { '.' })
            .collect()
    };
    Weave::Matrix((0..picks).map(drawn).collect())
}

fn begin(cells: usize) -> Vec<f32> {
    (0..cells)
        .map(|i| ((i * 37) % 101) as f32 / 100.0 * if i % 3 == 0 { 1.0 } else { 0.2 })
        .collect()
}

#[test]
fn a_mirrored_cloth_gives_exactly_the_mirrored_dye() {
    // A gap belongs to the cloth cell before it, so yarns dive behind gaps and not before them: a
    // mirrored cloth is one of the same kind only without gaps or without dives.
    let kinds = [(0, 0.47, 1.0), (1, 1.0, 1.0), (0, 0.47, 0.3)];
    let turns = [(true, false), (false, true), (true, true)];
    for ((gap, dive, equilibrium), (left_right, up_down)) in kinds
        .iter()
        .flat_map(|kind| turns.iter().map(move |turn| (*kind, *turn)))
    {
        // Both edges of the cloth are yarn.
        let grid = Grid {
            nx: 10 * (3 + gap) - gap,
            ny: 10 * (2 + gap) - gap,
        };
        let parts = uneven(grid.nx, grid.ny, gap);
        let dye = spread(parts.clone(), dive, &begin(grid.len()), equilibrium);

        let flip = |yes: bool, i: usize, n: usize| if yes { n - 1 - i } else { i };
        let (ends, picks) = (parts.warp.yarns.len(), parts.weft.yarns.len());
        let weave = parts.weave.clone();
        let mut mirrored = parts;
        if left_right {
            mirrored.warp.yarns.reverse();
        }
        if up_down {
            mirrored.weft.yarns.reverse();
        }
        let turned = |e, p| weave.warp_up(flip(left_right, e, ends), flip(up_down, p, picks));
        mirrored.weave = redrawn(ends, picks, turned).matrix();
        let over = |y, x| (flip(up_down, y, grid.ny), flip(left_right, x, grid.nx));
        mirrored.resist = turned_raster(&mirrored.resist, grid.nx, grid.ny, over);
        let turn = |layer, y, x| (layer, over(y, x).0, over(y, x).1);
        let begin = rearranged(&begin(grid.len()), grid, grid, turn);
        let turned = spread(mirrored, dive, &begin, equilibrium);
        assert!(turned == rearranged(&dye, grid, grid, turn), "gap {gap}");
        assert!(turned != dye, "the test cloth is its own mirror image");
    }
}

#[test]
fn warp_and_weft_exchanged_give_exactly_the_transposed_dye() {
    let grid = Grid { nx: 39, ny: 29 };
    let across = Grid { nx: 29, ny: 39 };
    let parts = uneven(grid.nx, grid.ny, 1);
    let dye = spread(parts.clone(), 0.47, &begin(grid.len()), 1.0);

    let (ends, picks) = (parts.weft.yarns.len(), parts.warp.yarns.len());
    let transposed = Parts {
        warp: parts.weft.clone(),
        weft: parts.warp.clone(),
        weave: redrawn(ends, picks, |e, p| !parts.weave.warp_up(p, e)).matrix(),
        gap_porosity: [parts.gap_porosity[1], parts.gap_porosity[0]],
        resist: turned_raster(&parts.resist, across.nx, across.ny, |y, x| (x, y)),
        ..parts
    };
    let turn = |layer: Layer, y: usize, x: usize| (layer.other(), x, y);
    let begin = rearranged(&begin(grid.len()), grid, across, turn);
    let turned = spread(transposed, 0.47, &begin, 1.0);
    assert!(turned == rearranged(&dye, grid, across, turn));
}

#[test]
fn the_solver_agrees_with_an_independent_one_in_double_precision() {
    // Where an isotherm limits what binds, the model itself is touchy: a cell at its limit binds in
    // one step and not in the next, and the last bit decides when it begins. What one step binds,
    // 0.4 % of the free dye at paper D's rate, is then the measure of agreement, cell by cell.
    let exact = (2e-7, 5e-8);
    let one_step_binds = (0.004, 2e-4);
    let table = [
        ("", 0.0005, exact),
        ("", 0.002, exact), // so long that each step is split
        (
            "dye: (diffusivity: MolarMass(262.27), equilibrium: 0.15)",
            0.0005,
            exact,
        ),
        (
            "adsorption: (isotherm: Partition(k: 0.8))",
            0.0005,
            one_step_binds,
        ),
        (
            "adsorption: (isotherm: Freundlich(k: 0.4, b: 0.35))",
            0.0005,
            one_step_binds,
        ),
        (
            "adsorption: (isotherm: Langmuir(kl: 30.0)), dye: (equilibrium: 0.4)",
            0.0005,
            one_step_binds,
        ),
        (
            "adsorption: (isotherm: Saturating(speed: 0.05, most: 0.4))",
            0.0005,
            exact,
        ),
        (
            "adsorption: (isotherm: Saturating(speed: 0.05, most: 0.4))",
            0.002,
            exact,
        ),
    ];
    for (more, step_h, (most, rms)) in table {
        let experiment = experiment(&format!(
            "(
                title: \"all of it\", seed: 3,
                cloth: (
                    size: (Cells(70), Cells(50)),
                    weave: Twill(over: 2, under: 1),
                    warp: (width: Cells(5), gap: Cells(1),
                           vary_porosity: (0.5, 1.0), twist: 0.8, vary_twist: (0.3, 1.0)),
                    weft: (width: Cells(3), gap: Cells(2), porosity: 0.4, squeeze: (0.0, 0.5)),
                    gap_porosity: 0.45,
                    paths: (between_layers: 0.3, across_yarn: 0.4, yarn_to_gap: 0.2),
                ),
                supply: [
                    Hold(shape: Disc(diameter: Cells(20)), dose: 0.5, until: Steps(600)),
                    Hold(shape: Disc(diameter: Cells(8)), from: Steps(50), until: Steps(700)),
                    Dose(shape: Disc(diameter: Cells(9), centre: (0.2, 0.3)), dose: 0.6),
                    Dose(shape: Disc(diameter: Cells(9)), dose: 0.9, at: Steps(600)),
                    Bath(shape: Ramp(), dose: 0.3, speed: 0.001, from: Steps(80), until: Steps(900)),
                ],
                resist: Strength(of: Blur(of: Rays(count: 5), radius: Cells(2)), by: 0.95),
                process: (duration: Steps(2000), step_h: {step_h}, solver: Explicit),
                {more}
            )"
        ));
        let mut app = dyeing_app(experiment.clone());
        let cloth = app.world().resource::<Cloth>();
        let splits = app.world().resource::<ProcessClock>().splits;
        assert_eq!(splits > 1, step_h > 0.001);
        let mut reference = Reference::of(&experiment, cloth, splits);
        for step in [0, 50, 80, 100, 600, 601, 700, 900, 2000] {
            go_on(&mut app, step);
            reference.go_on(step);
            let (worst, mean) = reference.differences(concentration(&app), bound(&app));
            assert!(
                worst < most && mean < rms,
                "{more}: at most {worst:e}, {mean:e} RMS at step {step}"
            );
        }
    }
}

#[test]
fn a_step_too_long_to_be_stable_is_split_and_ends_near_the_fine_one() {
    let with_step = |step_h: f64| {
        dyed(
            experiment(&format!(
                "(
                    title: \"coarse\",
                    cloth: (size: (Cells(40), Cells(40)), warp: (porosity: 1.0)),
                    supply: [Hold(shape: Disc(diameter: Cells(10)))],
                    process: (duration: Hours(0.5), step_h: {step_h}, solver: Explicit),
                )"
            )),
            (0.5 / step_h).round() as u64,
        )
    };
    let (fine, coarse) = (with_step(0.0001), with_step(0.0125));
    assert_eq!(fine.world().resource::<ProcessClock>().splits, 1);
    assert!(coarse.world().resource::<ProcessClock>().splits > 40);
    for (a, b) in concentration(&fine).iter().zip(concentration(&coarse)) {
        assert!((a - b).abs() < 0.01, "{a} and {b}");
    }
}

#[test]
fn frames_do_not_change_the_process_nor_the_ledger() {
    let everything = experiment(
        "(
            title: \"all kinds of supply\",
            cloth: (size: (Cells(40), Cells(30)), warp: (porosity: 1.0)),
            supply: [
                Hold(shape: Everywhere, dose: 0.5, until: Steps(10)),
                Hold(shape: Disc(diameter: Cells(10)), from: Steps(3)),
                Dose(shape: Disc(diameter: Cells(20)), at: Steps(10)),
                Bath(shape: Ramp(), speed: 0.01),
            ],
            adsorption: (),
            process: (duration: Steps(40), solver: Explicit),
        )",
    );
    let run = |looks: &[u64]| {
        let mut app = dyeing_app(everything.clone());
        assert!(app.world().resource::<ProcessClock>().splits > 1);
        for step in looks {
            go_on(&mut app, *step);
            go_on(&mut app, *step);
        }
        let ledger = *app.world().resource::<Ledger>();
        (concentration(&app).to_vec(), bound(&app).to_vec(), ledger)
    };
    let every: Vec<u64> = (0..=40).collect();
    assert!(run(&[40]) == run(&every));
}

#[test]
fn two_systems_that_leave_their_order_open_are_an_error() {
    use bevy::prelude::*;
    fn changes_dye(mut dye: ResMut<FreeDye>) {
        dye.concentration[0] = 0.0;
    }
    let initialized = |app: &mut App| {
        app.world_mut().schedule_scope(DyeStep, |world, schedule| {
            schedule.initialize(world).is_ok()
        })
    };
    let mut app = dyeing_app(Experiment::load("one_drop").unwrap());
    assert!(initialized(&mut app));
    app.add_systems(
        DyeStep,
        changes_dye.after(DyeSet::Adsorption).before(DyeSet::Tick),
    );
    assert!(initialized(&mut app));
    app.add_systems(DyeStep, changes_dye);
    assert!(!initialized(&mut app));
}
