//! The cloth in motion: what it is made of, where it is, and how it gets on.
//!
//! A step has three parts. The integrator proposes a move for every particle ([`implicit`](super::implicit)
//! or [`explicit`](super::explicit)); the filter shortens or turns the moves of those that would pass through
//! something ([`filter`](super::collide::filter)); the state takes what is left.

use bevy::math::{DVec2, DVec3};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::collide::colliders::Colliders;
use super::collide::distance::Pair;
use super::collide::filter::{Bodies, Filtered, filter};
use super::collide::near::{Motion, with_colliders, with_itself};
use super::collide::topology::Topology;
use super::collide::tree::Tree;
use super::contact::{Anchor, FASTEST_OUT, Rule, STIFFNESS, Touch};
use super::crease::{Crease, CreaseLink, press};
use super::explicit::{Explicit, Pulls};
use super::hand::Hand;
use super::implicit::Implicit;
use super::lattice::Links;
use super::limit::{LOCKED, limit};
use super::material::MaterialSpec;
use super::pcg::Solved;
use super::pins::Pin;
use super::rows::Rows;
use super::surface::Surface;
use super::weights::assemble;
use super::wind::{AIR_DENSITY, Wind};

/// How time is stepped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Integrator {
    /// Forward Euler.
    Euler,
    /// The classic Runge–Kutta method of fourth order.
    RungeKutta,
    /// Backward Euler.
    BackwardEuler,
    /// The backward difference of second order.
    Bdf2,
}

/// How the cloth is computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// How time is stepped.
    pub integrator: Integrator,
    /// The longest step, s.
    pub step: f64,
    /// By how much conjugate gradients bring the residual down (of less than thrice the weight, of that).
    pub tolerance: f64,
    /// The most iterations of conjugate gradients in a step.
    pub iterations: usize,
    /// Acceleration of everything, m/s².
    pub gravity: DVec3,
    /// The density of the air, kg/m³; 0 for none.
    pub air: f64,
    /// The distance that the cloth keeps from everything, m.
    pub thickness: f64,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// Whether the cloth collides with itself.
    pub itself: bool,
    /// The strain at which yarns lock; implicit steps do not go beyond it.
    pub locks_at: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            integrator: Integrator::Bdf2,
            step: 1.0 / 180.0,
            tolerance: 1e-3,
            iterations: 40,
            gravity: DVec3::new(0.0, -9.81, 0.0),
            air: AIR_DENSITY,
            thickness: 1e-3,
            friction: 0.3,
            itself: true,
            locks_at: LOCKED,
        }
    }
}

/// What a cloth is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// Its links.
    pub links: Links,
    /// Its creases.
    pub creases: Vec<CreaseLink>,
    /// Plane 0: mass, kg; plane 1 is filled with whether the particle is free.
    pub mass: Rows,
    /// How its particles make a surface.
    pub topology: Topology,
    /// How much cloth there is in every cell, m², a row of `particles.0 − 1` at a time.
    pub area: Vec<f64>,
}

impl Sheet {
    /// The mass of the whole, kg.
    pub(super) fn weighs(&self) -> f64 {
        let (nx, ny) = self.links.particles;
        let row = |y: usize| (0..nx).map(|x| self.mass.get(x, y, 0)).sum::<f64>();
        (0..ny).map(row).sum()
    }
}

/// Why a cloth cannot go on.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum DrapeError {
    /// A number is no longer finite.
    #[error(
        "the cloth flew apart after {time:.4} s: steps of {step} s are too long for it. \
         Shorter steps help, or an implicit integrator (BackwardEuler, Bdf2), softer cloth, more damping"
    )]
    FlewApart {
        /// When, s.
        time: f64,
        /// The step, s.
        step: f64,
    },
}

/// What a step took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepReport {
    /// How the system was solved.
    pub solved: Solved,
    /// Pairs that were near each other.
    pub pairs: usize,
    /// What the filter had to do.
    pub filtered: Filtered,
}

/// Where the cloth is and was.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct State {
    pub x: Vec<DVec3>,
    pub v: Vec<DVec3>,
    /// The last move, and the velocity before it.
    pub last_move: Vec<DVec3>,
    pub last_v: Vec<DVec3>,
    /// The length of the last step; none if there is nothing to go on from.
    pub last_step: Option<f64>,
    /// Which particles were stopped or turned in the last step, so that BDF2 has nothing to go on from.
    pub is_fresh: Vec<bool>,
    /// What each particle rests on.
    pub anchors: Vec<Option<Anchor>>,
}

/// What is given for a step.
pub(super) struct Given<'a> {
    pub settings: &'a Settings,
    pub sheet: &'a Sheet,
    pub colliders: &'a Colliders,
    pub wind: &'a Wind,
    pub hands: &'a [Hand],
    pub state: &'a State,
    pub pairs: &'a [Pair],
    pub time: f64,
    pub step: f64,
    /// Where pins lead their particles, m from where they are.
    pub lead: &'a [DVec3],
    /// 1/mass of every particle and of every corner of the colliders; 0 for what is held.
    pub mobility: &'a [f64],
    /// Radius of a circle that covers any triangle, m.
    pub covered: f64,
}

/// What an integrator proposes.
pub(super) struct Proposed {
    pub moves: Vec<DVec3>,
    /// The velocities at the end, if the moves are made.
    pub v: Vec<DVec3>,
    pub touches: Vec<Touch>,
    /// α, s².
    pub alpha: f64,
    pub solved: Solved,
}

/// A cloth in motion.
pub struct Drape {
    /// How it is computed.
    pub settings: Settings,
    /// The air.
    pub wind: Wind,
    /// What holds it.
    pub pins: Vec<Pin>,
    /// Hands that draw at it; implicit steps heed them.
    pub hands: Vec<Hand>,
    /// Seconds since it began.
    pub time: f64,
    sheet: Sheet,
    colliders: Colliders,
    state: State,
    /// Where pins took hold of their particles.
    taken: Vec<Option<Vec<DVec3>>>,
    /// What was near when the last step ended.
    pairs: Vec<Pair>,
    tree: Tree,
    triangles: Vec<[u32; 3]>,
    implicit: Implicit,
}

impl Drape {
    /// A cloth at rest whose particles are at `x`, row by row.
    pub fn new(settings: Settings, sheet: Sheet, x: Vec<DVec3>, colliders: Colliders) -> Self {
        let particles = sheet.links.particles;
        let none = vec![DVec3::ZERO; x.len()];
        let mut drape = Drape {
            settings,
            wind: Wind::still(),
            pins: Vec::new(),
            hands: Vec::new(),
            time: 0.0,
            tree: Tree::new(particles, sheet.links.spacing),
            implicit: Implicit::new(&sheet),
            triangles: sheet.topology.triangles(),
            state: State {
                v: none.clone(),
                last_move: none.clone(),
                last_v: none,
                last_step: None,
                is_fresh: vec![false; x.len()],
                anchors: vec![None; x.len()],
                x,
            },
            sheet,
            colliders,
            taken: Vec::new(),
            pairs: Vec::new(),
        };
        let still = drape.corners();
        drape.pairs = drape.near(&still, &still);
        drape
    }

    /// Where the particles are, m, row by row.
    pub fn positions(&self) -> &[DVec3] {
        &self.state.x
    }

    /// How fast they are, m/s.
    pub fn velocities(&self) -> &[DVec3] {
        &self.state.v
    }

    /// Gives the particles velocities, m/s.
    pub fn set_velocities(&mut self, v: &[DVec3]) {
        for (to, from) in self.state.v.iter_mut().zip(v) {
            *to = *from;
        }
        self.state.last_step = None;
    }

    /// What the cloth is made of.
    pub fn sheet(&self) -> &Sheet {
        &self.sheet
    }

    /// What it falls on.
    pub fn colliders(&self) -> &Colliders {
        &self.colliders
    }

    /// The triangles of its surface, by particles.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The surface as it is now.
    pub fn surface(&self) -> Surface {
        Surface::new(&self.sheet.topology, &self.state.x)
    }

    /// The largest strain of any yarn: how much longer than at rest, as a share.
    pub fn stretched(&self) -> f64 {
        let links = &self.sheet.links;
        let (nx, ny) = links.particles;
        let mut most = 0.0_f64;
        for direction in 0..2 {
            let length = links.length(direction);
            for y in 0..ny {
                for x in 0..nx {
                    let is_yarn = links.stiffness.get(x, y, direction) > 0.0;
                    let Some((i, j)) = links.other_end((x, y), direction, 1).filter(|_| is_yarn)
                    else {
                        continue;
                    };
                    let r = (self.state.x[j * nx + i] - self.state.x[y * nx + x]).length();
                    most = most.max(r / length - 1.0);
                }
            }
        }
        most
    }

    /// Kinetic energy, J.
    pub fn kinetic_energy(&self) -> f64 {
        let nx = self.sheet.links.particles.0;
        let mass = |i: usize| self.sheet.mass.get(i % nx, i / nx, 0);
        let each = self.state.v.iter().enumerate();
        each.map(|(i, v)| 0.5 * mass(i) * v.length_squared()).sum()
    }

    /// Advances by `seconds`, in equal steps no longer than the settings allow.
    ///
    /// # Errors
    /// [`DrapeError`] if the cloth flies apart. What was before the step that failed is kept.
    pub fn advance(&mut self, seconds: f64) -> Result<Option<StepReport>, DrapeError> {
        let steps = (seconds / self.settings.step - 1e-6).ceil().max(0.0);
        let step = seconds / steps;
        let mut report = None;
        for _ in 0..steps as u64 {
            // Inside the pool, so that loops need not wait for its threads to wake up.
            report = Some(rayon::scope(|_| self.step(step))?);
        }
        Ok(report)
    }

    /// The particles, and behind them the corners of the colliders.
    fn corners(&self) -> Vec<DVec3> {
        let mut all = self.state.x.clone();
        all.extend_from_slice(&self.colliders.mesh.corners);
        all
    }

    /// What may touch on the way from one place to another.
    fn near(&mut self, from: &[DVec3], to: &[DVec3]) -> Vec<Pair> {
        let count = self.state.x.len();
        let meshes = !self.colliders.mesh.triangles.is_empty();
        if !self.settings.itself && !meshes {
            return Vec::new();
        }
        let topology = &self.sheet.topology;
        self.tree.fit(topology, &from[..count], &to[..count]);
        let motion = Motion { from, to };
        let margin = 1.5 * self.settings.thickness;
        let mut pairs = Vec::new();
        if self.settings.itself {
            pairs = with_itself(topology, &self.tree, motion, margin);
        }
        if meshes {
            let colliders = &self.colliders;
            pairs.extend(with_colliders(
                topology, &self.tree, colliders, motion, margin,
            ));
        }
        pairs
    }

    /// Where the pins that hold now lead their particles; `None` where nothing does.
    fn led(&mut self, step: f64) -> Vec<Option<DVec3>> {
        let x = &self.state.x;
        let mut led = vec![None; x.len()];
        self.taken.resize(self.pins.len(), None);
        for (pin, taken) in self.pins.iter().zip(&mut self.taken) {
            if !pin.holds(self.time) {
                continue;
            }
            let taken = taken.get_or_insert_with(|| pin.particles.iter().map(|i| x[*i]).collect());
            let moved = pin.moved(self.time + step);
            for (i, from) in pin.particles.iter().zip(taken) {
                led[*i] = Some(*from + moved - x[*i]);
            }
        }
        led
    }

    fn step(&mut self, step: f64) -> Result<StepReport, DrapeError> {
        let count = self.state.x.len();
        let nx = self.sheet.links.particles.0;
        let led = self.led(step);
        let mut mobility = vec![0.0; count + self.colliders.mesh.corners.len()];
        for i in 0..count {
            let (x, y) = (i % nx, i / nx);
            let mass = self.sheet.mass.get(x, y, 0);
            let free = led[i].is_none() && mass > 0.0;
            *self.sheet.mass.get_mut(x, y, 1) = f64::from(u8::from(free));
            mobility[i] = if free { 1.0 / mass } else { 0.0 };
        }
        let lead: Vec<DVec3> = led.iter().map(|led| led.unwrap_or(DVec3::ZERO)).collect();
        let given = Given {
            settings: &self.settings,
            sheet: &self.sheet,
            colliders: &self.colliders,
            wind: &self.wind,
            hands: &self.hands,
            state: &self.state,
            pairs: &self.pairs,
            time: self.time,
            step,
            lead: &lead,
            mobility: &mobility,
            // The circle around a right-angled triangle has its longest side as diameter; cloth may be
            // stretched by a tenth.
            covered: 0.55 * self.sheet.links.length(2),
        };
        let mut proposed = match self.settings.integrator {
            Integrator::Euler | Integrator::RungeKutta => propose_explicit(&given),
            Integrator::BackwardEuler | Integrator::Bdf2 => self.implicit.propose(&given),
        };
        let covered = given.covered;
        let is_finite = |v: &DVec3| v.length_squared() < 1e100;
        if !proposed.moves.iter().all(is_finite) || !proposed.v.iter().all(is_finite) {
            return Err(DrapeError::FlewApart {
                time: self.time,
                step,
            });
        }
        let mut changed = vec![false; mobility.len()];
        if matches!(
            self.settings.integrator,
            Integrator::BackwardEuler | Integrator::Bdf2
        ) {
            let (links, most) = (&self.sheet.links, self.settings.locks_at);
            limit(
                links,
                most,
                &mobility,
                &self.state.x,
                &mut proposed.moves,
                &mut changed,
            );
        }
        let (filtered, pairs) = self.filter(&mobility, covered, &mut proposed.moves, &mut changed);
        self.take(proposed, changed, &mobility, step)
            .map(|solved| StepReport {
                solved,
                pairs,
                filtered,
            })
    }

    /// Makes moves such that nothing passes through anything.
    fn filter(
        &mut self,
        mobility: &[f64],
        covered: f64,
        moves: &mut Vec<DVec3>,
        changed: &mut [bool],
    ) -> (Filtered, usize) {
        let from = self.corners();
        let exact = self.colliders.exact.clone();
        let triangles = std::mem::take(&mut self.triangles);
        let (one, two) = self.sheet.links.spacing;
        let (leg, shorter) = (one.max(two), one.min(two));
        let diagonal = self.sheet.links.length(2);
        let bodies = Bodies {
            particles: self.state.x.len(),
            from: &from,
            mobility,
            apart: self.settings.thickness,
            friction: self.settings.friction,
            exact: &exact,
            covered,
            triangles: &triangles,
            longest: [1.05 * 1.05 * leg * leg, 1.21 * diagonal * diagonal],
        };
        moves.resize(from.len(), DVec3::ZERO);
        for i in 0..bodies.particles {
            bodies.keep_out(i, moves, changed);
        }
        let ends = |moves: &[DVec3]| -> Vec<DVec3> {
            from.iter().zip(moves).map(|(x, by)| *x + *by).collect()
        };
        let mut pairs = self.near(&from, &ends(moves));
        let near = pairs.len();
        // Little enough, too, that what was smooth remains so: see `tree`.
        let slack = (0.5 * self.settings.thickness).min(0.04 * shorter);
        let filtered = filter(bodies, &mut pairs, moves, changed, slack, |moves| {
            self.near(&from, &ends(moves))
        });
        self.pairs = pairs;
        self.triangles = triangles;
        (filtered, near)
    }

    /// Takes over what a step has come to.
    fn take(
        &mut self,
        proposed: Proposed,
        mut changed: Vec<bool>,
        mobility: &[f64],
        step: f64,
    ) -> Result<Solved, DrapeError> {
        let Proposed {
            moves,
            v,
            touches,
            alpha,
            solved,
        } = proposed;
        let rule = Rule {
            apart: self.settings.thickness,
            friction: self.settings.friction,
            alpha,
            step,
        };
        let state = &mut self.state;
        let mut anchors = vec![None; state.x.len()];
        for touch in &touches {
            let i = touch.particle as usize;
            changed[i] = true;
            let end = state.x[i] + moves[i];
            let anchor = anchored(
                *touch,
                moves[i],
                end,
                1.0 / mobility[i],
                state.anchors[i],
                rule,
            );
            if let Some(anchor) = anchor
                && anchors[i].is_none_or(|other: Anchor| other.pressed < anchor.pressed)
            {
                anchors[i] = Some(anchor);
            }
        }
        state.anchors = anchors;
        for i in 0..state.x.len() {
            state.last_v[i] = state.v[i];
            state.v[i] = if changed[i] { moves[i] / step } else { v[i] };
            state.is_fresh[i] = changed[i];
            state.last_move[i] = moves[i];
            state.x[i] += moves[i];
        }
        state.last_step = Some(step);
        self.time += step;
        Ok(solved)
    }
}

/// All that a cloth needs to come back to a moment, and go on from it as it did.
#[derive(Debug, Clone)]
pub struct Snapshot {
    time: f64,
    state: State,
    pins: Vec<Pin>,
    taken: Vec<Option<Vec<DVec3>>>,
    hands: Vec<Hand>,
    wind: Wind,
    sheet: Sheet,
    settings: Settings,
    guesses: [Rows<f32>; 2],
    pairs: Vec<Pair>,
}

impl Drape {
    /// What it takes to come back to this moment.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            time: self.time,
            state: self.state.clone(),
            pins: self.pins.clone(),
            taken: self.taken.clone(),
            hands: self.hands.clone(),
            wind: self.wind.clone(),
            sheet: self.sheet.clone(),
            settings: self.settings.clone(),
            guesses: self.implicit.guesses.clone(),
            pairs: self.pairs.clone(),
        }
    }

    /// Goes to a moment of the same cloth.
    pub fn restore(&mut self, to: &Snapshot) {
        let to = to.clone();
        self.time = to.time;
        self.state = to.state;
        self.pins = to.pins;
        self.taken = to.taken;
        self.hands = to.hands;
        self.wind = to.wind;
        self.sheet = to.sheet;
        self.settings = to.settings;
        self.implicit.guesses = to.guesses;
        self.pairs = to.pairs;
    }

    /// Fixes a particle where it is, from now on.
    pub fn pin(&mut self, particle: usize) {
        if particle < self.state.x.len() {
            self.pins.push(Pin {
                particles: vec![particle],
                from: self.time,
                until: f64::INFINITY,
                path: Vec::new(),
            });
        }
    }

    /// Takes every pin off a particle; other particles of the same pins stay held.
    pub fn unpin(&mut self, particle: usize) {
        self.taken.resize(self.pins.len(), None);
        for (pin, taken) in self.pins.iter_mut().zip(&mut self.taken) {
            let Some(at) = pin.particles.iter().position(|i| *i == particle) else {
                continue;
            };
            pin.particles.remove(at);
            if let Some(taken) = taken {
                taken.remove(at);
            }
        }
    }

    /// Presses a crease between two places on the cloth (shares of its width and height), folding by
    /// `angle` radians, positive where the front is outside; `stiffness` in N·m/(m·rad). Returns how many
    /// links it crosses: none where it lies on an older crease.
    pub fn add_crease(&mut self, from: DVec2, to: DVec2, angle: f64, stiffness: f64) -> usize {
        let links = &mut self.sheet.links;
        let (nx, ny) = links.particles;
        let size = DVec2::new((nx - 1) as f64, (ny - 1) as f64) * DVec2::from(links.spacing);
        let crease = Crease {
            from: from * size,
            to: to * size,
            angle,
            stiffness,
        };
        if from == to {
            return 0;
        }
        let pressed = press(links, &[crease]);
        let count = pressed.len();
        self.sheet.creases.extend(pressed);
        count
    }

    /// Makes the cloth of another material, on the same grid and where it is. Creases stay as stiff as they
    /// were pressed.
    pub fn set_material(&mut self, material: &MaterialSpec) {
        let Sheet { links, area, .. } = &self.sheet;
        let (particles, spacing) = (links.particles, links.spacing);
        let (mass, mut links) = assemble(&material.in_si(), particles, spacing, area);
        for crease in &self.sheet.creases {
            crease.take_from(&mut links);
        }
        let size = (particles.0 as f64 * spacing.0).max(particles.1 as f64 * spacing.1);
        self.settings.friction = material.friction;
        self.settings.locks_at = material.locks_at(size);
        self.sheet.mass = mass;
        self.sheet.links = links;
    }
}

/// What a particle that touches something rests on at the end of a step; nothing if it was let go.
fn anchored(
    touch: Touch,
    by: DVec3,
    end: DVec3,
    mass: f64,
    before: Option<Anchor>,
    rule: Rule,
) -> Option<Anchor> {
    let out = touch.distance + by.dot(touch.normal);
    let wanted = rule.apart.min(touch.distance + FASTEST_OUT * rule.step);
    let stiffness = STIFFNESS * mass / rule.alpha;
    let pressed = stiffness * (wanted - out);
    if pressed <= 0.0 {
        return None;
    }
    let mut at = before.map_or(end, |anchor| anchor.at);
    let off = end - at;
    let off = off - off.dot(touch.normal) * touch.normal;
    let most = rule.friction * pressed / stiffness;
    if off.length() > most {
        at = end - off * (most / off.length());
    }
    Some(Anchor { at, pressed })
}

/// What an explicit integrator proposes.
fn propose_explicit(given: &Given) -> Proposed {
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
