//! An independent solver: double precision, one cell after the other, written from the model
//! (sections 2 to 4) and sharing nothing with the engine but the cloth's own description.

use dyelapse::pattern::Canvas;
use dyelapse::prelude::*;
use dyelapse::scenario::{Isotherm, SupplySpec};

pub struct Reference {
    nx: usize,
    ny: usize,
    /// Neighbours of every cell: (index, conductance D·min(V_u)·Δt/Δd²).
    links: Vec<Vec<(usize, f64)>>,
    v_u: Vec<f64>,
    v_d: Vec<f64>,
    phi: Vec<f64>,
    bound: Vec<f64>,
    supplies: Vec<Given>,
    /// Into how many parts a step is split.
    parts: u32,
    equilibrium: f64,
    share: f64,
    isotherm: Option<Isotherm>,
    step: u64,
}

struct Given {
    /// The value of the shape in every cell.
    shape: Vec<f64>,
    most: f64,
    kind: Kind,
}

/// When something is given, in steps.
#[derive(Clone, Copy)]
enum Kind {
    Dose(u64),
    Hold(u64, Option<u64>),
    Bath(u64, Option<u64>, f64),
}

impl Reference {
    /// A solver of the same experiment, which splits each step into `parts`.
    pub fn of(experiment: &Experiment, cloth: &Cloth, parts: u32) -> Self {
        let scenario = &experiment.scenario;
        let Grid { nx, ny } = cloth.grid;
        let paths = scenario.cloth.paths;
        let d0 = scenario.dye.diffusivity.in_water();
        let scale = scenario.process.step_h / (cloth.cell_mm * cloth.cell_mm);
        let at = |i: usize| (i / (nx * ny), i / nx % ny, i % nx);
        let layer_of = |l: usize| Layer::BOTH[l];
        let capacities = |of: fn(&Cloth, Layer, usize, usize) -> f32| -> Vec<f64> {
            let at = |i: usize| of(cloth, layer_of(at(i).0), at(i).1, at(i).2);
            (0..2 * nx * ny).map(|i| f64::from(at(i))).collect()
        };
        let v_u: Vec<f64> = capacities(Cloth::capacity_free);
        let coefficient = |i: usize, j: usize| {
            let ((li, yi, xi), (lj, yj, xj)) = (at(i), at(j));
            let (a, b) = (
                cloth.yarn(layer_of(li), yi, xi),
                cloth.yarn(layer_of(lj), yj, xj),
            );
            let (pa, pb) = (
                cloth.porosity(layer_of(li), yi, xi),
                cloth.porosity(layer_of(lj), yj, xj),
            );
            let porosity = 2.0 / (1.0 / pa + 1.0 / pb);
            let tau1 = a.map_or(1.0, |y| y.twist).min(b.map_or(1.0, |y| y.twist));
            let both = a.is_some() && b.is_some();
            let tau2 = if both && li == lj && cloth.warp_up(yi, xi) != cloth.warp_up(yj, xj) {
                paths.dive
            } else {
                1.0
            };
            let tau3 = if a.is_none() && b.is_none() {
                paths.gap_to_gap
            } else if !both {
                paths.yarn_to_gap
            } else if li != lj {
                paths.between_layers
            } else if (li == 0) == (yi != yj) {
                paths.across_yarn
            } else {
                paths.along_yarn
            };
            d0 * porosity * tau1 * tau2 * tau3 * scale * v_u[i].min(v_u[j])
        };
        let links = (0..v_u.len())
            .map(|i| {
                let (l, y, x) = at(i);
                let mut near = vec![((1 - l) * nx * ny + y * nx + x)];
                near.extend((x > 0).then(|| i - 1));
                near.extend((x + 1 < nx).then_some(i + 1));
                near.extend((y > 0).then(|| i - nx));
                near.extend((y + 1 < ny).then_some(i + nx));
                near.into_iter().map(|j| (j, coefficient(i, j))).collect()
            })
            .collect();
        let canvas = Canvas::of(experiment);
        let steps = |time: dyelapse::scenario::Time| time.steps(scenario.process.step_h);
        let supplies = scenario
            .supply
            .iter()
            .map(|spec| {
                let shape = canvas.draw(spec.shape()).values;
                let both = shape.iter().chain(&shape).map(|v| f64::from(*v)).collect();
                let (most, kind) = match spec {
                    SupplySpec::Dose { dose, at, .. } => (dose, Kind::Dose(steps(*at))),
                    SupplySpec::Hold {
                        dose, from, until, ..
                    } => (dose, Kind::Hold(steps(*from), until.map(steps))),
                    SupplySpec::Bath {
                        dose,
                        speed,
                        from,
                        until,
                        ..
                    } => (dose, Kind::Bath(steps(*from), until.map(steps), *speed)),
                };
                Given {
                    shape: both,
                    most: f64::from(*most as f32),
                    kind,
                }
            })
            .collect();
        Reference {
            nx,
            ny,
            links,
            v_d: capacities(Cloth::capacity_bound),
            phi: vec![0.0; v_u.len()],
            bound: vec![0.0; v_u.len()],
            supplies,
            parts,
            equilibrium: scenario.dye.equilibrium,
            share: scenario.adsorption.map_or(0.0, |a| a.rate * d0 * scale),
            isotherm: scenario.adsorption.map(|a| a.isotherm),
            step: 0,
            v_u,
        }
    }

    /// Goes on to a step and gives what is due there.
    pub fn go_on(&mut self, step: u64) {
        while self.step < step {
            for part in 0..self.parts {
                if part == 0 {
                    self.give();
                }
                self.keep();
                self.soak();
                self.spread();
                self.bind();
            }
            self.step += 1;
        }
        self.give();
        self.keep();
    }

    fn is_on(&self, from: u64, until: Option<u64>) -> bool {
        from <= self.step && until.is_none_or(|until| self.step < until)
    }

    /// What is kept in a cell now: the last hold of the scenario that reaches it.
    fn kept(&self, i: usize) -> Option<f64> {
        let reaching = self.supplies.iter().rev().find(|given| match given.kind {
            Kind::Hold(from, until) => self.is_on(from, until) && given.shape[i] > 0.0,
            _ => false,
        });
        reaching.map(|given| given.most * given.shape[i])
    }

    fn give(&mut self) {
        for i in (0..self.phi.len()).filter(|i| self.v_u[*i] > 0.0) {
            if self.kept(i).is_some() {
                continue;
            }
            let v_u = self.v_u[i];
            for given in self.supplies.iter().filter(|given| given.shape[i] > 0.0) {
                if matches!(given.kind, Kind::Hold(_, Some(until)) if until == self.step) {
                    self.phi[i] = given.most * given.shape[i] * v_u;
                }
            }
            for given in self.supplies.iter().filter(|given| given.shape[i] > 0.0) {
                if matches!(given.kind, Kind::Dose(at) if at == self.step) {
                    self.phi[i] = self.phi[i].max(given.most * given.shape[i] * v_u);
                }
            }
        }
    }

    fn keep(&mut self) {
        for i in 0..self.phi.len() {
            if let Some(c) = self.kept(i) {
                self.phi[i] = c * self.v_u[i];
            }
        }
    }

    fn soak(&mut self) {
        for given in &self.supplies {
            let Kind::Bath(from, until, speed) = given.kind else {
                continue;
            };
            if !self.is_on(from, until) {
                continue;
            }
            for i in 0..self.phi.len() {
                if self.kept(i).is_some() {
                    continue;
                }
                let missing = given.most * self.v_u[i] - self.phi[i];
                self.phi[i] += speed / f64::from(self.parts) * given.shape[i] * missing;
            }
        }
    }

    fn spread(&mut self) {
        let concentration = |i: usize| {
            if self.v_u[i] > 0.0 {
                self.phi[i] / self.v_u[i]
            } else {
                0.0
            }
        };
        let c: Vec<f64> = (0..self.phi.len()).map(concentration).collect();
        for i in 0..c.len() {
            for (j, conductance) in &self.links[i] {
                let mean = (c[i] + c[*j]) / 2.0;
                let rho = if mean > self.equilibrium {
                    self.equilibrium / mean
                } else {
                    1.0
                };
                let part = conductance / f64::from(self.parts);
                self.phi[i] += part * rho * (c[*j] - c[i]);
            }
        }
    }

    fn bind(&mut self) {
        let Some(isotherm) = self.isotherm else {
            return;
        };
        for i in 0..self.phi.len() {
            let (phi, v_d, a) = (self.phi[i], self.v_d[i], self.bound[i]);
            let parts = f64::from(self.parts);
            let share = self.share / parts * phi;
            let up_to = |a_d: f64| share.min((a_d.min(v_d) - a).max(0.0));
            let gained = match isotherm {
                Isotherm::Partition { k } => up_to(k * phi),
                Isotherm::Freundlich { k, b } => up_to(k * phi.max(0.0).powf(b)),
                Isotherm::Langmuir { kl } => up_to(v_d * kl * phi / (1.0 + kl * phi)),
                Isotherm::Saturating { speed, most } => {
                    speed / parts * (most.min(v_d) - a).max(0.0) * phi
                }
            };
            self.bound[i] += gained;
            self.phi[i] -= gained;
        }
    }

    /// The largest and the root mean square difference of free concentration and bound amount.
    pub fn differences(&self, concentration: &[f32], bound: &[f32]) -> (f64, f64) {
        assert_eq!(self.phi.len(), 2 * self.nx * self.ny);
        let wet = (0..self.phi.len()).filter(|i| self.v_u[*i] > 0.0);
        let free = wet.map(|i| self.phi[i] / self.v_u[i] - f64::from(concentration[i]));
        let both = self.bound.iter().zip(bound);
        let all: Vec<f64> = free.chain(both.map(|(a, b)| a - f64::from(*b))).collect();
        let worst = all.iter().fold(0.0, |worst: f64, d| worst.max(d.abs()));
        let squares: f64 = all.iter().map(|d| d * d).sum();
        (worst, (squares / all.len() as f64).sqrt())
    }
}
