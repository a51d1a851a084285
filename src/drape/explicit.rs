//! Explicit time steps: forward Euler and the classic Runge–Kutta method (paper C §3).
//!
//! Forward Euler takes the old velocity in the position update, as the paper has it; it is not symplectic
//! and needs damping to be stable at all.

use bevy::math::DVec3;

use super::crease::CreaseLink;
use super::drape::{Given, Integrator, Proposed};
use super::lattice::Links;
use super::pcg::Solved;
use super::response::Response;
use super::rows::{Rows, each};

/// A cloth of links alone, in explicit steps.
#[derive(Debug, Clone)]
pub struct Explicit {
    /// Positions, m.
    pub x: Rows,
    /// Velocities, m/s.
    pub v: Rows,
    response: Response,
    force: Rows,
}

/// What pulls at a cloth.
#[derive(Debug, Clone, Copy)]
pub struct Pulls<'a> {
    /// Its links.
    pub links: &'a Links,
    /// Its creases.
    pub creases: &'a [CreaseLink],
    /// Plane 0: mass, kg; plane 1: 1 where the particle is free, 0 where it is held.
    pub mass: &'a Rows,
    /// Acceleration of everything, m/s².
    pub gravity: DVec3,
}

impl Explicit {
    /// A cloth at `x` moving at `v`.
    pub fn new(x: Rows, v: Rows) -> Self {
        Explicit {
            response: Response::new((x.nx, x.ny)),
            force: Rows::zero(x.nx, x.ny, 3),
            x,
            v,
        }
    }

    /// The acceleration of every particle at `x` and `v`.
    fn acceleration(&mut self, pulls: Pulls, x: &Rows, v: &Rows) -> Rows {
        self.response.compute(pulls.links, x, v, None);
        self.force.all_mut().fill(0.0);
        self.response.add_forces(&mut self.force);
        for crease in pulls.creases {
            crease.respond(x, &mut self.force, &mut self.response, 0.0);
        }
        let mut a = self.force.clone();
        let gravity = pulls.gravity.to_array();
        each(&mut a, |y, a| {
            let a: [&mut [f64]; 3] = a.planes().take();
            let [mass, free] = pulls.mass.lines(y as isize, 0, 0);
            for (line, gravity) in a.into_iter().zip(gravity) {
                for ((a, mass), free) in line.iter_mut().zip(mass).zip(free) {
                    *a = if *free > 0.0 {
                        *a / mass + gravity
                    } else {
                        0.0
                    };
                }
            }
        });
        a
    }

    /// One step of forward Euler, `h` seconds long.
    pub fn euler(&mut self, pulls: Pulls, h: f64) {
        let (x, v) = (self.x.clone(), self.v.clone());
        let a = self.acceleration(pulls, &x, &v);
        add(&mut self.x, &v, h);
        add(&mut self.v, &a, h);
    }

    /// One step of the classic Runge–Kutta method, `h` seconds long.
    pub fn runge_kutta(&mut self, pulls: Pulls, h: f64) {
        let (x, v) = (self.x.clone(), self.v.clone());
        // (share of the step before, weight)
        let stages = [(0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)];
        let (mut speed, mut a) = (v.clone(), Rows::zero(x.nx, x.ny, 3));
        for (share, weight) in stages {
            let (mut x_stage, mut v_stage) = (x.clone(), v.clone());
            add(&mut x_stage, &speed, share * h);
            add(&mut v_stage, &a, share * h);
            a = self.acceleration(pulls, &x_stage, &v_stage);
            speed = v_stage;
            add(&mut self.x, &speed, weight * h / 6.0);
            add(&mut self.v, &a, weight * h / 6.0);
        }
    }
}

/// a += by·b.
fn add(a: &mut Rows, b: &Rows, by: f64) {
    each(a, |y, a| {
        let lines: [&mut [f64]; 3] = a.planes().take();
        let of_b: [&[f64]; 3] = b.lines(y as isize, 0, 0);
        for (a, b) in lines.into_iter().zip(of_b) {
            for (a, b) in a.iter_mut().zip(b) {
                *a += by * b;
            }
        }
    });
}

/// What an explicit integrator proposes.
pub(super) fn propose(given: &Given) -> Proposed {
    let (nx, ny) = given.sheet.links.particles;
    let (mut x, mut v) = (Rows::zero(nx, ny, 3), Rows::zero(nx, ny, 3));
    for (i, lead) in given.lead.iter().enumerate() {
        let held = given.mobility[i] <= 0.0;
        x.set_particle(i, given.state.x[i]);
        v.set_particle(
            i,
            if held {
                *lead / given.step
            } else {
                given.state.v[i]
            },
        );
    }
    let mut cloth = Explicit::new(x, v);
    let pulls = Pulls {
        links: &given.sheet.links,
        creases: &given.sheet.creases,
        mass: &given.sheet.mass,
        gravity: given.settings.gravity,
    };
    if given.settings.integrator == Integrator::Euler {
        cloth.euler(pulls, given.step);
    } else {
        cloth.runge_kutta(pulls, given.step);
    }
    let moves = cloth.x.to_vectors().into_iter().zip(&given.state.x);
    Proposed {
        moves: moves.map(|(end, begin)| end - *begin).collect(),
        v: cloth.v.to_vectors(),
        touches: Vec::new(),
        alpha: given.step * given.step,
        solved: Solved {
            iterations: 0,
            residual: 0.0,
        },
    }
}
