//! Many explicit steps in one pass through memory.
//!
//! The same forward Euler steps as [`explicit`](super::explicit), with the same carry, where nothing
//! but diffusion happens between them and supply keeps what it keeps: so the rows of many
//! steps can follow each other through the cache ([`tiles`]).

use bevy::ecs::system::SystemChangeTick;
use bevy::prelude::*;
use pulp::Simd;

use super::held::Held;
use super::kernel::{At, Take};
use super::lanes::{Cells, Lanes, Ways};
use super::passage::{Fick, Law, Passage};
use super::tiles::{self, Level, Task, Work, flow};
use super::{Faces, FreeDye, changed_since};
use crate::cloth::Cloth;
use crate::ledger::Ledger;
use crate::schedule::ProcessClock;
use crate::supply::Supplies;

/// Concentrations and what rounding has left over of them, in blocks; twice, for a step reads one
/// and writes the other.
#[derive(Debug, Clone)]
pub struct State {
    /// c.
    pub c: [Vec<Cells>; 2],
    /// What rounding has left over.
    pub carry: [Vec<Cells>; 2],
    /// What supply has brought to each followed cell, as concentration.
    pub brought: [Vec<f64>; 2],
}

/// What steps are taken on.
#[derive(Debug, Clone, Copy)]
pub struct Ground<'a> {
    /// The layout.
    pub lanes: Lanes,
    /// The cloth.
    pub ways: &'a [Ways],
    /// How faces pass dye.
    pub law: Law,
    /// The kept cells.
    pub held: &'a Held,
}

impl State {
    /// Room for a cloth.
    pub fn new(lanes: Lanes) -> Self {
        let room = || vec![Cells::ZERO; lanes.len()];
        State {
            c: [room(), room()],
            carry: [room(), room()],
            brought: [Vec::new(), Vec::new()],
        }
    }

    /// Takes steps.
    pub fn advance(&mut self, ground: Ground, steps: usize) {
        for brought in &mut self.brought {
            brought.clear();
            brought.resize(ground.held.rim.len(), 0.0);
        }
        let ([c0, c1], [r0, r1], [b0, b1]) = (&mut self.c, &mut self.carry, &mut self.brought);
        let level = |free, bound, held| Level {
            free,
            bound,
            held,
            brought: &mut [],
        };
        tiles::pass(&ground, steps, [level(c0, r0, b0), level(c1, r1, b1)]);
        if steps % 2 == 1 {
            self.c.swap(0, 1);
            self.carry.swap(0, 1);
            self.brought.swap(0, 1);
        }
    }
}

/// Explicit steps of a process in which nothing but diffusion happens between the changes of supply.
#[derive(Resource, Debug)]
pub struct Steps {
    lanes: Lanes,
    ways: Vec<Ways>,
    law: Law,
    held: Held,
    state: State,
}

/// Steps of one run at the most, so that whoever waits hears of them in time.
const LONGEST: u64 = 240;

impl Steps {
    /// Prepares steps on a cloth.
    pub fn new(cloth: &Cloth, faces: &Faces, step_h: f64, equilibrium: f64) -> Self {
        let lanes = Lanes::new(cloth.grid);
        Steps {
            lanes,
            ways: lanes.ways(cloth, faces, step_h),
            law: Law::of(equilibrium),
            held: Held::nothing(lanes),
            state: State::new(lanes),
        }
    }

    /// Says which cells are kept from now on.
    pub fn keep(&mut self, kept: impl Iterator<Item = usize>) {
        self.held = Held::new(self.lanes, &self.ways, kept, true);
    }

    /// Takes steps, and books what supply brought to the kept cells, or took away.
    pub fn take(&mut self, dye: &mut FreeDye, steps: u64, ledger: &mut Ledger) {
        self.lanes.pack(&dye.concentration, &mut self.state.c[0]);
        self.lanes.pack(&dye.carry, &mut self.state.carry[0]);
        let ground = Ground {
            lanes: self.lanes,
            ways: &self.ways,
            law: self.law,
            held: &self.held,
        };
        self.state.advance(ground, steps as usize);
        self.lanes.unpack(&self.state.c[0], &mut dye.concentration);
        self.lanes.unpack(&self.state.carry[0], &mut dye.carry);
        for (brought, cell) in self.state.brought[0].iter().zip(&self.held.rim) {
            ledger.book(brought * cell.capacity);
        }
    }
}

/// As many steps as the clock asks for.
pub(super) fn many_steps(
    mut steps: ResMut<Steps>,
    mut clock: ResMut<ProcessClock>,
    mut dye: ResMut<FreeDye>,
    supplies: Res<Supplies>,
    mut ledger: ResMut<Ledger>,
    ticks: SystemChangeTick,
) {
    // Where a stage of one's own changes the dye, it must see every step.
    let disturbed = changed_since(&dye, &steps, ticks.this_run());
    if supplies.is_changed() {
        let kept = supplies.kept_at(clock.step);
        steps.keep(kept.iter().map(|(i, _)| *i as usize));
    }
    clock.stride = if disturbed {
        1
    } else {
        let until = clock.until.min(supplies.next_change(clock.step));
        // Runs end at the same steps wherever they began.
        let run = LONGEST - clock.step % LONGEST;
        (until - clock.step).min(run)
    };
    steps.take(&mut dye, clock.stride, &mut ledger);
}

/// Concentrations below this round to nothing: see [`explicit`](super::explicit).
const NOTHING: f32 = 1e-24;

/// Adds the rate of one step.
struct Add<'a> {
    carry: &'a [Cells],
    into: &'a mut [Cells],
    left_over: &'a mut [Cells],
}

impl Take for Add<'_> {
    #[inline(always)]
    fn take<S: Simd>(&mut self, simd: S, at: At, here: S::f32s, rate: S::f32s) {
        let change = simd.add_f32s(rate, at.of::<S>(self.carry));
        let sum = simd.add_f32s(here, change);
        let left_over = simd.sub_f32s(change, simd.sub_f32s(sum, here));
        let nothing = simd.less_than_f32s(sum, simd.splat_f32s(NOTHING));
        let zero = simd.splat_f32s(0.0);
        *at.of_mut::<S>(self.into) = simd.select_f32s(nothing, zero, sum);
        *at.of_mut::<S>(self.left_over) = simd.select_f32s(nothing, zero, left_over);
    }
}

impl Work for Ground<'_> {
    fn blocks(&self) -> usize {
        self.lanes.blocks
    }

    fn rows(&self) -> usize {
        self.lanes.grid.ny
    }

    fn held_above(&self, y: usize) -> usize {
        self.held.above(y)
    }

    fn row(&self, task: Task, from: &Level, into: &mut Level) {
        match self.law {
            Law::Fick => self.step(Fick, task, from, into),
            Law::Slowed(law) => self.step(law, task, from, into),
        }
    }
}

impl Ground<'_> {
    fn step<P: Passage>(&self, passage: P, mut task: Task, from: &Level, into: &mut Level) {
        let blocks = self.lanes.blocks;
        let row = |y: usize| y * blocks..(y + 1) * blocks;
        let here = row(task.y - task.top);
        let take = Add {
            carry: &from.bound[here.clone()],
            into: &mut into.free[here.clone()],
            left_over: &mut into.bound[here.clone()],
        };
        flow(passage, self.lanes, self.ways, &mut task, from.free, take);
        let above = self.held.above(task.top);
        let first = task.y * blocks;
        let within = first + task.blocks.start..first + task.blocks.end;
        for (i, cell) in self.held.within(task.y, within) {
            let block = here.start + cell.block - first;
            let kept = from.free[block].0[cell.layer][cell.lane];
            let c = &mut into.free[block].0[cell.layer][cell.lane];
            let carry = &mut into.bound[block].0[cell.layer][cell.lane];
            let missing = f64::from(kept) - f64::from(*c) - f64::from(*carry);
            (*c, *carry) = (kept, 0.0);
            into.held[i - above] = from.held[i - above] + missing;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diffusion::{Conductances, explicit};
    use crate::scenario::{Experiment, Solver};
    use crate::schedule::TheExperiment;

    #[test]
    fn steps_in_one_pass_give_the_bytes_of_steps_one_by_one() {
        for equilibrium in [1.0, 0.4] {
            let text = format!(
                "(title: \"t\", cloth: (size: (Cells(53), Cells(131)),
                    warp: (width: Cells(3), gap: Cells(1), vary_porosity: (0.3, 1.0))),
                  supply: [Dose(shape: Noise(grain: Cells(5)))],
                  dye: (equilibrium: {equilibrium}),
                  process: (duration: Steps(1), solver: Explicit))"
            );
            let origin = crate::scenario::Origin::Memory;
            let experiment = Experiment::parse("t", origin, text).unwrap();
            let app = crate::dyeing_app(experiment);
            let world = app.world();
            let cloth = world.resource::<Cloth>();
            let scenario = &world.resource::<TheExperiment>().scenario;
            let faces = Faces {
                cloth,
                paths: &scenario.cloth.paths,
                in_water: scenario.dye.diffusivity.in_water(),
            };
            let lanes = Lanes::new(cloth.grid);
            let mut dye = FreeDye::clean(cloth.grid, Solver::Explicit);
            for (i, c) in dye.concentration.iter_mut().enumerate() {
                *c = (i * 7919 % 1000) as f32 / 1000.0;
            }
            let mut state = State::new(lanes);
            lanes.pack(&dye.concentration, &mut state.c[0]);
            let ground = Ground {
                lanes,
                ways: &lanes.ways(cloth, &faces, scenario.process.step_h),
                law: Law::of(equilibrium),
                held: &Held::nothing(lanes),
            };
            state.advance(ground, 31);
            let conductances = Conductances::new(cloth, &faces, scenario.process.step_h, 0.0);
            for _ in 0..31 {
                let FreeDye {
                    concentration,
                    carry,
                    next,
                } = &mut dye;
                explicit::step(&conductances, equilibrium, concentration, carry, next);
                std::mem::swap(concentration, next);
            }
            for (i, c) in dye.concentration.iter().enumerate() {
                let (block, layer, lane) = lanes.place(i);
                assert_eq!(state.c[0][block].0[layer][lane], *c);
                assert_eq!(state.carry[0][block].0[layer][lane], dye.carry[i]);
            }
        }
    }
}
