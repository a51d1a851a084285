//! What hangs together: after one value changed, others move along so that the scenario stays one that can
//! be.

use super::lengths::lengths;
use super::unit::mended_length;
use crate::cloth::Weave;
use crate::drape::spec::{ColliderSpec, DrapeSpec, MOST_PARTICLES};
use crate::pattern::Pattern;
use crate::scenario::units::MOST_STEPS;
use crate::scenario::{
    BatikStep, ClothSpec, Draping, DyeSpec, Kasuri, Length, LookSpec, Paths, Scenario, SupplySpec,
    Time,
};

/// The most parts into which a step may have to be split, less a little for rounding.
const MOST_SPLITS: f64 = 10_000.0 * (1.0 - 1e-9);

/// Moves what no longer fits to what was changed. Nothing in a scenario that passes `check` moves.
pub fn mend(scenario: &mut Scenario) {
    let most_step = most_step_h(scenario);
    let process = &mut scenario.process;
    if process.step_h > most_step {
        process.step_h = most_step;
    }
    let cell_mm = scenario.cloth.cell_mm;
    lengths(scenario, &mut |length, least, most| {
        *length = mended_length(*length, cell_mm, least, most);
    });
    if matches!(scenario.cloth.weave, Weave::Mask { .. }) {
        close_gaps(&mut scenario.cloth);
    }
    beside_batik(scenario);
    times(scenario);
    let size = scenario.cloth.cells();
    if let Some(Draping::Own(drape)) = &mut scenario.drape {
        let of_cloth = (size.0 as f64, size.1 as f64);
        mend_drape(drape, of_cloth);
    }
}

/// The longest step that the speed of the dye and the cells allow, h.
pub(super) fn most_step_h(scenario: &Scenario) -> f64 {
    let cell = scenario.cloth.cell_mm * scenario.cloth.cell_mm;
    let fastest = 5.0 * scenario.dye.diffusivity.in_water() / cell;
    (MOST_SPLITS / fastest).clamp(1e-9, 24.0)
}

/// The fastest dye that the step and the cells allow, mm²/h.
pub(super) fn most_diffusivity(scenario: &Scenario) -> f64 {
    let cell = scenario.cloth.cell_mm * scenario.cloth.cell_mm;
    (MOST_SPLITS * cell / (5.0 * scenario.process.step_h)).min(1000.0)
}

/// The cells that all lengths, the dye and the step allow, mm.
pub(super) fn cell_range(scenario: &mut Scenario) -> (f64, f64) {
    let fastest = 5.0 * scenario.dye.diffusivity.in_water() * scenario.process.step_h;
    let mut least = (fastest / MOST_SPLITS).sqrt().max(1e-4);
    let mut largest = 100.0_f64;
    lengths(scenario, &mut |length, fewest, most| {
        let mm = match *length {
            Length::Cells(_) => return,
            Length::Mm(mm) => mm,
            Length::Cm(cm) => 10.0 * cm,
        };
        if fewest > 0.0 {
            largest = largest.min(mm / fewest);
        }
        least = least.max(mm / most);
    });
    (least, largest)
}

/// A cloth from a photograph has no gaps.
fn close_gaps(cloth: &mut ClothSpec) {
    let cell_mm = cloth.cell_mm;
    for yarn in [Some(&mut cloth.warp), cloth.weft.as_mut()]
        .into_iter()
        .flatten()
    {
        if yarn.gap.whole_cells(cell_mm) > 0 {
            yarn.gap = Length::Cells(0.0);
        }
    }
}

/// Takes out what a recipe of batik does not go with, and lets the process last as long as its steps.
fn beside_batik(scenario: &mut Scenario) {
    let step_h = scenario.process.step_h;
    let Some(batik) = &mut scenario.batik else {
        return;
    };
    for step in &mut batik.steps {
        if let BatikStep::Dye { lasts, .. } = step {
            let most = MOST_STEPS / 1000;
            match lasts.steps(step_h) {
                0 => *lasts = Time::Steps(1),
                steps if steps > most => *lasts = Time::Steps(most),
                _ => {}
            }
        }
    }
    let all = batik.begins(step_h).last().copied().unwrap_or(0);
    if scenario.process.duration.steps(step_h) != all {
        scenario.process.duration = Time::Steps(all);
    }
    let sweeps = batik.sweeps();
    let plain = LookSpec::default();
    scenario.cloth.kasuri = Kasuri::default();
    scenario.look.colours = plain.colours;
    scenario.look.path = plain.path;
    if sweeps {
        scenario.look.show = plain.show;
        scenario.look.darkest_at = None;
        scenario.dye = DyeSpec::default();
        scenario.cloth.paths = Paths::default();
        scenario.supply.clear();
        scenario.adsorption = None;
        scenario.resist = Pattern::Nowhere;
    }
}

/// Times end after they begin, and within the process.
fn times(scenario: &mut Scenario) {
    let process = &mut scenario.process;
    let step_h = process.step_h;
    let cut = |time: &mut Time, most: u64| {
        if time.steps(step_h) > most {
            *time = Time::Steps(most);
        }
    };
    cut(&mut process.duration, MOST_STEPS);
    let all = process.steps();
    for supply in &mut scenario.supply {
        match supply {
            SupplySpec::Dose { at, .. } => cut(at, MOST_STEPS),
            SupplySpec::Hold { from, until, .. } | SupplySpec::Bath { from, until, .. } => {
                cut(from, MOST_STEPS);
                if let Some(until) = until {
                    cut(until, MOST_STEPS);
                    if until.steps(step_h) < from.steps(step_h) {
                        *until = *from;
                    }
                }
            }
        }
    }
    for time in &mut scenario.record.sheet {
        cut(time, all);
    }
    if let Some(frames) = &mut scenario.record.frames {
        let moments = all.saturating_add(1).min(u64::from(u32::MAX)) as u32;
        *frames = (*frames).min(moments);
    }
}

fn mend_drape(drape: &mut DrapeSpec, of_cloth: (f64, f64)) {
    let (width, height) = drape.size_m.unwrap_or(of_cloth);
    fit_particles(&mut drape.particles, width, height);
    for pin in &mut drape.pins {
        if let Some(until) = &mut pin.until_s {
            *until = until.max(pin.from_s);
        }
        let mut before = 0.0;
        for (moment, _) in &mut pin.path {
            if *moment <= before {
                *moment = before + 1e-3;
            }
            before = *moment;
        }
        while pin.path.last().is_some_and(|(moment, _)| *moment > 1e6) {
            pin.path.pop();
        }
    }
    for collider in &mut drape.on {
        let (edge, most) = match collider {
            ColliderSpec::RoundTable {
                radius_m,
                thickness_m,
                edge_m,
                ..
            } => (edge_m, radius_m.min(2.0 * *thickness_m)),
            ColliderSpec::SquareTable {
                size_m,
                thickness_m,
                edge_m,
                ..
            } => (edge_m, size_m.0.min(size_m.1).min(2.0 * *thickness_m)),
            _ => continue,
        };
        *edge = edge.min(0.49 * most);
    }
    for crease in &mut drape.creases {
        if crease.from == crease.to {
            let (u, v) = crease.to;
            crease.to = (if u > 0.5 { u - 0.01 } else { u + 0.01 }, v);
        }
    }
}

/// As many particles down as are as far apart as those across.
fn fit_particles(particles: &mut (usize, usize), width: f64, height: f64) {
    let apart = |(nx, ny): (usize, usize)| {
        (width / (nx.max(2) - 1) as f64) / (height / (ny.max(2) - 1) as f64)
    };
    let fits = |particles| (0.6..=1.0 / 0.6).contains(&apart(particles));
    let count = |length: f64, step: f64| {
        let n = (length / step).round() as usize + 1;
        n.clamp(2, MOST_PARTICLES)
    };
    if !fits(*particles) {
        particles.1 = count(height, width / (particles.0.max(2) - 1) as f64);
    }
    if !fits(*particles) {
        particles.0 = count(width, height / (particles.1.max(2) - 1) as f64);
    }
}
