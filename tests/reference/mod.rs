//! An independent solver: double precision, one cell after the other, written from the model
//! (sections 2 to 4) and sharing nothing with the engine but the cloth's own description.

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
    held: Vec<Option<f64>>,
    until: u64,
    equilibrium: f64,
    share: f64,
    isotherm: Option<Isotherm>,
    step: u64,
}

impl Reference {
    pub fn of(experiment: &Experiment, cloth: &Cloth) -> Self {
        let scenario = &experiment.scenario;
        let Grid { nx, ny } = cloth.grid;
        let paths = scenario.cloth.paths;
        let d0 = scenario.dye.diffusivity.in_water();
        let scale = scenario.process.step_h / (cloth.cell_mm * cloth.cell_mm);
        let at = |i: usize| (i / (nx * ny), i / nx % ny, i % nx);
        let layer_of = |l: usize| Layer::BOTH[l];
        let v_u: Vec<f64> = cloth.capacity_free.iter().map(|v| f64::from(*v)).collect();
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
        let until = scenario.supply.iter().find_map(|supply| match supply {
            SupplySpec::Hold { until, .. } => Some(until.map(|t| t.steps(0.0005))),
            SupplySpec::Dose { .. } => None,
        });
        Reference {
            nx,
            ny,
            links,
            v_d: cloth.capacity_bound.iter().map(|v| f64::from(*v)).collect(),
            phi: Vec::new(),
            bound: vec![0.0; v_u.len()],
            held: Vec::new(),
            until: until.flatten().unwrap_or(u64::MAX),
            equilibrium: scenario.dye.equilibrium,
            share: scenario.adsorption.map_or(0.0, |a| a.rate * d0 * scale),
            isotherm: scenario.adsorption.map(|a| a.isotherm),
            step: 0,
            v_u,
        }
    }

    /// Begins from a concentration in which only held cells are full.
    pub fn begin(&mut self, concentration: &[f32]) {
        let c = concentration.iter().map(|c| f64::from(*c));
        self.phi = c.zip(&self.v_u).map(|(c, v)| c * v).collect();
        let held = |c: &f32| (*c == 1.0).then_some(1.0);
        self.held = concentration.iter().map(held).collect();
    }

    pub fn go_on(&mut self, step: u64) {
        while self.step < step {
            self.one_step();
            self.step += 1;
            self.keep_held();
        }
    }

    fn keep_held(&mut self) {
        if self.step > self.until {
            return;
        }
        for (i, held) in self.held.iter().enumerate() {
            if let Some(c) = held {
                self.phi[i] = c * self.v_u[i];
            }
        }
    }

    fn one_step(&mut self) {
        let c: Vec<f64> = (0..self.phi.len())
            .map(|i| {
                if self.v_u[i] > 0.0 {
                    self.phi[i] / self.v_u[i]
                } else {
                    0.0
                }
            })
            .collect();
        for i in 0..c.len() {
            for (j, conductance) in &self.links[i] {
                let mean = (c[i] + c[*j]) / 2.0;
                let rho = if mean > self.equilibrium {
                    self.equilibrium / mean
                } else {
                    1.0
                };
                self.phi[i] += conductance * rho * (c[*j] - c[i]);
            }
        }
        let Some(isotherm) = self.isotherm else {
            return;
        };
        for i in 0..c.len() {
            let (phi, v_d) = (self.phi[i], self.v_d[i]);
            let a_d = match isotherm {
                Isotherm::Partition { k } => k * phi,
                Isotherm::Freundlich { k, b } => k * phi.max(0.0).powf(b),
                Isotherm::Langmuir { kl } => v_d * kl * phi / (1.0 + kl * phi),
            };
            let room = (a_d.min(v_d) - self.bound[i]).max(0.0);
            let gained = (self.share * phi).clamp(0.0, room);
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
