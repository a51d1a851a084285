//! The cloth in motion: what it is made of, where it is, and how it gets on.
//!
//! A step has three parts. The integrator proposes a move for every particle (`implicit`
//! or [`explicit`]); the filter shortens or turns the moves of those that would pass through
//! something ([`filter`](super::collide::filter)); the state takes what is left.

mod edit;
mod moves;
mod settings;

use bevy::math::DVec3;

use super::collide::colliders::Colliders;
use super::collide::distance::Pair;
use super::collide::tree::Tree;
use super::contact::{Anchor, Touch};
use super::explicit;
use super::hand::Hand;
use super::implicit::Implicit;
use super::limit::limit;
use super::pcg::Solved;
use super::pins::Pin;
use super::surface::Surface;
use super::wind::Wind;

pub use edit::Snapshot;
pub use settings::{DrapeError, Integrator, Settings, Sheet, StepReport};

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
            Integrator::Euler | Integrator::RungeKutta => explicit::propose(&given),
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
}
