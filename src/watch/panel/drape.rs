//! The drape: what the cloth is made of, how it hangs, how it is seen.

use bevy_egui::egui::Ui;

use super::row::{Effect, Pass, row};
use super::scene;
use super::things;
use super::view::view;
use crate::drape::drape::Integrator;
use crate::drape::material::{Material, MaterialSpec};
use crate::drape::scenes;
use crate::drape::spec::{DrapeSpec, MOST_PARTICLES, Outline, SolverSpec};
use crate::scenario::check::Checker;
use crate::scenario::{Draping, Scenario};

pub(super) fn show(p: &mut Pass, ui: &mut Ui, scenario: &mut Scenario) {
    p.group(ui, "Drape", |p, ui| {
        p.heading("drape");
        let named = scenes::names();
        let kind = row(
            "drape",
            "How the cloth hangs or lies: flat, a bundled scene, or one of its own to change.",
        );
        let names: Vec<&str> = ["none"]
            .into_iter()
            .chain(named.clone())
            .chain(["its own"])
            .collect();
        let own = names.len() - 1;
        let now = match &scenario.drape {
            None => 0,
            Some(Draping::Bundled(name)) => named
                .iter()
                .position(|one| one == name)
                .map_or(own, |i| i + 1),
            Some(Draping::Own(_)) => own,
        };
        if let Some(chosen) = p.variant(ui, &kind, now, &names) {
            scenario.drape = match chosen {
                0 => None,
                i if i == own => own_drape(&scenario.drape),
                i => Some(Draping::Bundled(names[i].into())),
            };
        }
        if let Some(Draping::Bundled(_)) = &scenario.drape
            && p.button(
                ui,
                "Change this drape",
                "Makes it the scenario's own, with all its parameters",
            )
        {
            scenario.drape = own_drape(&scenario.drape);
            p.change("drape");
        }
        if let Some(Draping::Own(spec)) = &mut scenario.drape {
            own_rows(p, ui, spec);
        }
        p.effect = Effect::Look;
        p.heading("view");
        view(p, ui, &mut scenario.view);
    });
}

/// The drape that is there as the scenario's own; a tablecloth where there is none.
fn own_drape(now: &Option<Draping>) -> Option<Draping> {
    let tablecloth = Draping::Bundled("tablecloth".into());
    let spec = now.as_ref().unwrap_or(&tablecloth).spec(&Checker::root());
    spec.ok().map(|spec| Draping::Own(Box::new(spec)))
}

fn own_rows(p: &mut Pass, ui: &mut Ui, spec: &mut DrapeSpec) {
    let across = row(
        "particles across",
        "How finely the draped cloth is computed. The particles down follow, so that they are as far apart.",
    );
    p.number(ui, &across, &mut spec.particles.0, 2..=MOST_PARTICLES);
    let down = row(
        "particles down",
        "The particles across follow where the two would not fit.",
    );
    let before = spec.particles.1;
    p.number(ui, &down, &mut spec.particles.1, 2..=MOST_PARTICLES);
    if spec.particles.1 != before {
        let (width, height) = spec.size_m.unwrap_or(p.cells);
        let apart = height / (spec.particles.1.max(2) - 1) as f64;
        let fitting = (width / apart).round() as usize + 1;
        spec.particles.0 = fitting.clamp(2, MOST_PARTICLES);
    }
    let mut sized = spec.size_m.is_some();
    let size = row(
        "its own size",
        "The draped cloth shows the dyed one at this size. Left out: as large as it was dyed.",
    );
    p.tick(ui, &size, &mut sized);
    if sized != spec.size_m.is_some() {
        let (nx, ny) = p.cells;
        let height = (0.8 * ny / nx).clamp(0.01, 50.0);
        spec.size_m = sized.then_some((0.8, height));
    }
    if let Some((width, height)) = &mut spec.size_m {
        let near = |other: f64| ((other / 100.0).max(1e-4), (other * 100.0).min(100.0));
        let ranges = [near(*height), near(*width)];
        let size = row("width, height", "How large the draped cloth is.").unit(" m");
        p.numbers(ui, &size, [width, height], ranges);
    }
    let outline = row("outline", "A rectangle, or the ellipse that fits into it.");
    let both = [
        ("rectangle", Outline::Rectangle),
        ("ellipse", Outline::Ellipse),
    ];
    p.choice(ui, &outline, &mut spec.outline, &both);
    let settle = row("settles for", "How long it moves before anything is shown.").unit(" s");
    p.number(ui, &settle, &mut spec.settle_s, 0.0..=3600.0);
    p.heading("material");
    material(p, ui, &mut spec.material);
    p.heading("start");
    scene::start(p, ui, &mut spec.start);
    p.heading("pins");
    scene::pins(p, ui, &mut spec.pins);
    p.heading("things");
    things::colliders(p, ui, &mut spec.on);
    p.heading("wind");
    scene::wind(p, ui, &mut spec.wind);
    p.heading("creases");
    scene::creases(p, ui, &mut spec.creases);
    p.heading("cloth solver");
    p.fold(ui, "How it is computed", |p, ui| {
        solver(p, ui, &mut spec.solver)
    });
}

fn material(p: &mut Pass, ui: &mut Ui, material: &mut Material) {
    let kind = row(
        "material",
        "What the draped cloth is made of: how heavy, stiff and stretchy it is.",
    );
    let names = [
        "cotton lawn",
        "muslin",
        "denim",
        "silk habotai",
        "linen",
        "wool",
        "measured",
    ];
    let now = Material::PRESETS
        .iter()
        .position(|(_, one)| one == material);
    if let Some(i) = p.variant(ui, &kind, now.unwrap_or(6), &names) {
        *material = match Material::PRESETS.get(i) {
            Some((_, preset)) => *preset,
            None => Material::Measured(material.measured()),
        };
    }
    // Changing a number of a preset makes a measured one of it.
    let before = material.measured();
    let mut spec = before;
    measured(p, ui, &mut spec);
    if spec != before {
        *material = Material::Measured(spec);
    }
}

fn measured(p: &mut Pass, ui: &mut Ui, spec: &mut MaterialSpec) {
    let weight = row("weight", "Mass by area. Heavy cloth hangs in deep folds.").unit(" g/m²");
    p.number(ui, &weight.scale(100.0), &mut spec.weight, 0.1..=1e5);
    let thickness = row("thickness", "Only seen, not felt.").unit(" mm");
    p.number(
        ui,
        &thickness.scale(0.3),
        &mut spec.thickness_mm,
        0.0..=100.0,
    );
    let stretch = row(
        "stretch E",
        "Tensile modulus along warp and weft, N/m: how hard it is to stretch.",
    );
    p.numbers(
        ui,
        &stretch.scale(1000.0),
        [&mut spec.stretch.0, &mut spec.stretch.1],
        [(0.01, 1e12); 2],
    );
    let shear = row(
        "shear G",
        "How hard it is to pull askew. Little lets cloth fit round things.",
    )
    .unit(" N/m");
    p.number(ui, &shear.scale(50.0), &mut spec.shear, 0.0..=1e12);
    let bending = row(
        "bending B",
        "Bending rigidity along warp and weft, N·m: stiff cloth makes few wide folds.",
    );
    p.numbers(
        ui,
        &bending.scale(1e-5),
        [&mut spec.bending.0, &mut spec.bending.1],
        [(0.0, 1e3); 2],
    );
    let friction = row(
        "friction",
        "Coulomb's coefficient against itself and other things.",
    );
    p.number(ui, &friction.scale(0.4), &mut spec.friction, 0.0..=10.0);
    let damping = row("damping", "How long a stretch takes to die away.").unit(" s");
    p.number(ui, &damping.scale(2e-6), &mut spec.damping, 0.0..=10.0);
}

fn solver(p: &mut Pass, ui: &mut Ui, spec: &mut SolverSpec) {
    let integrator = row(
        "integrator",
        "How time is stepped. The implicit ones (backward Euler, BDF2) are stable at long steps.",
    );
    let all = [
        ("Euler", Integrator::Euler),
        ("Runge–Kutta 4", Integrator::RungeKutta),
        ("backward Euler", Integrator::BackwardEuler),
        ("BDF2", Integrator::Bdf2),
    ];
    p.choice(ui, &integrator, &mut spec.integrator, &all);
    p.number(
        ui,
        &row(
            "longest step",
            "Short steps are more exact and take longer.",
        )
        .unit(" s")
        .scale(4e-3),
        &mut spec.step_s,
        1e-6..=1.0,
    );
    p.number(
        ui,
        &row(
            "residual",
            "By how much conjugate gradients bring the residual of a step down.",
        )
        .scale(1e-3),
        &mut spec.tolerance,
        1e-7..=0.1,
    );
    p.number(
        ui,
        &row(
            "iterations",
            "The most iterations of conjugate gradients in a step.",
        ),
        &mut spec.iterations,
        1..=100_000,
    );
    p.number(
        ui,
        &row(
            "kept apart",
            "The distance that cloth keeps from everything.",
        )
        .unit(" mm"),
        &mut spec.apart_mm,
        0.01..=100.0,
    );
    p.number(ui, &row("uneven by", "How uneven the cloth is in the beginning: perfectly flat cloth would not know which way to fold.").unit(" mm").scale(0.2), &mut spec.uneven_mm, 0.0..=10.0);
    p.tick(
        ui,
        &row(
            "collides with itself",
            "Else folds may pass through each other.",
        ),
        &mut spec.itself,
    );
    p.tick(
        ui,
        &row("air", "Whether air slows the cloth down."),
        &mut spec.air,
    );
}
