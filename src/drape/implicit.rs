//! One implicit time step: backward Euler, or the second-order backward difference (BDF2), after Choi
//! and Ko (model section 8).
//!
//! Both ask for the move Δ = xⁿ⁺¹ − xⁿ at which
//!
//! M(Δ − Δ₀) = α·f(xⁿ + Δ, v(Δ)),
//!
//! | | α | Δ₀ | v(Δ) | β |
//! |---|---|---|---|---|
//! | Euler | h² | h·vⁿ | Δ/h | h |
//! | BDF2 | 4h²/9 | δ/3 + (h/9)(8vⁿ − 2vⁿ⁻¹) | (3Δ − δ)/(2h) | 2h/3 |
//!
//! with δ = xⁿ − xⁿ⁻¹. The forces are taken linear about xⁿ (one step of Newton's method), so that
//! M − α·∂f/∂x − β·∂f/∂v is to be solved once. Conjugate gradients begin with the best sum of multiples of
//! the last two moves: cloth hardly changes its mind within a 240th of a second.

mod contacts;

use bevy::math::DVec3;

use super::contact::{Contact, product};
use super::drape::{Given, Integrator, Proposed, Sheet};
use super::pcg::{Goal, Work};
use super::response::{Ahead, Response};
use super::rows::{Rows, each, each2};
use super::system::System;
use super::wind::drag;
use super::yarns::Yarns;

/// What implicit steps keep, so that no memory is asked for in each.
pub(super) struct Implicit {
    response: Response,
    mass: Rows<f32>,
    own: Rows<f32>,
    /// Positions, and velocities, about which forces are linear.
    x: Rows,
    v: Rows,
    /// The moves that are about to be made.
    coming: Rows,
    /// α·f + M·Δ₀.
    pull: Rows,
    u: Rows<f32>,
    /// The last two moves.
    pub guesses: [Rows<f32>; 2],
    solver: Work,
    yarns: Yarns,
    contacts: Vec<Contact>,
}

/// α of BDF2 as a share of backward Euler's: a particle whose past says nothing, as it was stopped by
/// something, takes a step of backward Euler among others that take one of BDF2.
const FRESH: f64 = 4.0 / 9.0;

/// The tolerance is a share of the forces there are, but at least of so many times the weight: cloth almost
/// at rest need not be solved for to a thousandth of next to nothing. What is left is there in the next step.
const TIMES_WEIGHT: f64 = 3.0;

/// α, β and whether the step is BDF2's.
#[derive(Clone, Copy)]
struct Scheme {
    alpha: f64,
    beta: f64,
    bdf2: bool,
}

impl Scheme {
    fn new(given: &Given) -> Self {
        let h = given.step;
        let same = |last: f64| (last - h).abs() < 1e-9 * h;
        // The first step has no past, nor has one of another length.
        if given.settings.integrator == Integrator::Bdf2 && given.state.last_step.is_some_and(same)
        {
            Scheme {
                alpha: 4.0 * h * h / 9.0,
                beta: 2.0 * h / 3.0,
                bdf2: true,
            }
        } else {
            Scheme {
                alpha: h * h,
                beta: h,
                bdf2: false,
            }
        }
    }

    /// v(Δ).
    fn velocity(self, by: DVec3, last_move: DVec3, h: f64) -> DVec3 {
        if self.bdf2 {
            (3.0 * by - last_move) / (2.0 * h)
        } else {
            by / h
        }
    }
}

impl Implicit {
    pub fn new(sheet: &Sheet) -> Self {
        let (nx, ny) = sheet.links.particles;
        let (three, three_single) = (Rows::zero(nx, ny, 3), Rows::zero(nx, ny, 3));
        Implicit {
            response: Response::new((nx, ny)),
            mass: Rows::zero(nx, ny, 2),
            own: Rows::zero(nx, ny, 6),
            x: three.clone(),
            v: three.clone(),
            coming: three.clone(),
            pull: three,
            u: three_single.clone(),
            guesses: [three_single.clone(), three_single],
            solver: Work::new((nx, ny)),
            yarns: Yarns::new((nx, ny)),
            contacts: Vec::new(),
        }
    }

    /// The move of one step.
    pub fn propose(&mut self, given: &Given) -> Proposed {
        let scheme = Scheme::new(given);
        let h = given.step;
        let (state, sheet) = (given.state, given.sheet);
        self.take_links(given, scheme);
        self.take_inertia_and_air(given, scheme);
        self.take_hands(given, scheme);
        let touches = self.take_contacts(given, scheme);
        let (mass, pull) = (&sheet.mass, &self.pull);
        each(&mut self.solver.r, |y, r| {
            let r: [&mut [f32]; 3] = r.planes().take();
            let pull: [&[f64]; 3] = pull.lines(y as isize, 0, 0);
            let [free] = mass.lines(y as isize, 1, 0);
            for (r, pull) in r.into_iter().zip(pull) {
                for ((r, pull), free) in r.iter_mut().zip(pull).zip(free) {
                    *r = (pull * free) as f32;
                }
            }
        });
        let system = System {
            mass: &self.mass,
            links: &self.response,
            own: &self.own,
            contacts: &self.contacts,
        };
        self.yarns.factor(&system);
        if state.last_step.is_none() {
            // Falling as one is what rounding errors of very stiff links would hide.
            let fall = given.settings.gravity * (h * h);
            let nx = sheet.links.particles.0;
            for i in (0..state.x.len()).filter(|i| given.mobility[*i] > 0.0) {
                for (c, by) in fall.to_array().into_iter().enumerate() {
                    *self.guesses[0].get_mut(i % nx, i / nx, c) = by as f32;
                }
            }
        }
        let [last, before] = &self.guesses;
        self.solver.begin(&system, [last, before], &mut self.u);
        let goal = Goal {
            tolerance: given.settings.tolerance,
            least: TIMES_WEIGHT
                * given.settings.gravity.length()
                * scheme.alpha
                * sheet.weighs().sqrt(),
            iterations: given.settings.iterations,
        };
        let solved = self
            .solver
            .solve(&system, &mut self.yarns, &mut self.u, goal);
        self.guesses.swap(0, 1);
        self.guesses[0].clone_from(&self.u);
        let nx = sheet.links.particles.0;
        let moves: Vec<DVec3> = (0..state.x.len())
            .map(|i| {
                let u = [0, 1, 2].map(|c| f64::from(self.u.get(i % nx, i / nx, c)));
                given.lead[i] + DVec3::from_array(u)
            })
            .collect();
        let v = moves.iter().zip(&state.last_move);
        Proposed {
            v: v.map(|(by, last)| scheme.velocity(*by, *last, h)).collect(),
            moves,
            touches,
            alpha: scheme.alpha,
            solved,
        }
    }

    /// The forces and blocks of links and creases. Pins have led their particles on already.
    fn take_links(&mut self, given: &Given, scheme: Scheme) {
        let (state, sheet) = (given.state, given.sheet);
        for (i, lead) in given.lead.iter().enumerate() {
            self.x.set_particle(i, state.x[i] + *lead);
            let v = scheme.velocity(*lead, state.last_move[i], given.step);
            self.v.set_particle(i, v);
            let held = given.mobility[i] <= 0.0;
            self.coming
                .set_particle(i, if held { DVec3::ZERO } else { about(given, i) });
        }
        for (single, double) in self.mass.all_mut().iter_mut().zip(sheet.mass.all()) {
            *single = *double as f32;
        }
        if scheme.bdf2 {
            // BDF2 has α = 4h²/9, backward Euler h²: divided by that, both are one symmetric system.
            let nx = self.mass.nx;
            for i in (0..state.x.len()).filter(|i| state.is_fresh[*i]) {
                *self.mass.get_mut(i % nx, i / nx, 0) *= FRESH as f32;
            }
        }
        let ahead = Ahead {
            alpha: scheme.alpha,
            beta: scheme.beta,
            moves: &self.coming,
        };
        self.response
            .compute(&sheet.links, &self.x, &self.v, Some(ahead));
        self.pull.all_mut().fill(0.0);
        self.response.add_forces(&mut self.pull);
        for crease in &sheet.creases {
            crease.respond(&self.x, &mut self.pull, &mut self.response, scheme.alpha);
        }
    }

    /// Makes α·f + M·Δ₀ of the links' forces, gravity, drag and inertia.
    fn take_inertia_and_air(&mut self, given: &Given, scheme: Scheme) {
        let h = given.step;
        let (state, mass, nx) = (given.state, &given.sheet.mass, self.x.nx);
        let (x_rows, v_rows) = (&self.x, &self.v);
        each2(&mut self.pull, &mut self.own, |y, pull, own| {
            let [px, py, pz] = pull.planes().take();
            let own: [&mut [f32]; 6] = own.planes().take();
            for x in 0..nx {
                let i = y * nx + x;
                let m = mass.get(x, y, 0);
                let inert = if !scheme.bdf2 {
                    h * state.v[i]
                } else if state.is_fresh[i] {
                    FRESH * h * state.v[i]
                } else {
                    let v = 8.0 * state.v[i] - 2.0 * state.last_v[i];
                    state.last_move[i] / 3.0 + (h / 9.0) * v
                };
                let mut force = DVec3::new(px[x], py[x], pz[x]) + m * given.settings.gravity;
                let mut block = [0.0; 6];
                if given.settings.air > 0.0 && m > 0.0 {
                    let wind = given.wind.at(state.x[i], given.time + h);
                    let area = area_vector(x_rows, x, y);
                    let (of_air, loses) = drag(wind - state.v[i], area, given.settings.air);
                    // Drag by the velocity at the end of the step, linear about the one now.
                    force += of_air - product(loses, v_rows.vector(x, y) - state.v[i]);
                    block = loses.map(|value| scheme.beta * value);
                }
                let all = scheme.alpha * force + m * inert;
                (px[x], py[x], pz[x]) = (all.x, all.y, all.z);
                for c in 0..6 {
                    own[c][x] = block[c] as f32;
                }
            }
        });
    }

    /// Adds the springs by which hands draw.
    fn take_hands(&mut self, given: &Given, scheme: Scheme) {
        let nx = self.x.nx;
        for hand in given.hands {
            let i = hand.particle;
            if given.mobility[i] <= 0.0 {
                continue;
            }
            let (x, y) = (i % nx, i / nx);
            // v as it will be is v + (change of v by the move): linear, so taken at no move here.
            let v = self.v.vector(x, y);
            let (force, stiffness, damping) =
                hand.pull(self.x.vector(x, y), v, 1.0 / given.mobility[i]);
            let pull = self.pull.vector(x, y) + scheme.alpha * force;
            self.pull.set_vector(x, y, pull);
            for c in 0..3 {
                let own = scheme.alpha * stiffness + scheme.beta * damping;
                *self.own.get_mut(x, y, c) += own as f32;
            }
        }
    }
}

/// Where a particle will about go: on as before.
fn about(given: &Given, i: usize) -> DVec3 {
    match given.state.last_step {
        Some(last) => given.state.last_move[i] * (given.step / last),
        None => given.state.v[i] * given.step,
    }
}

/// The area vector of the cloth around a particle, out of its front, from its neighbours, m².
fn area_vector(at: &Rows, x: usize, y: usize) -> DVec3 {
    let (left, right) = (x.saturating_sub(1), (x + 1).min(at.nx - 1));
    let (up, down) = (y.saturating_sub(1), (y + 1).min(at.ny - 1));
    let across = at.vector(right, y) - at.vector(left, y);
    let along = at.vector(x, down) - at.vector(x, up);
    0.25 * along.cross(across)
}
