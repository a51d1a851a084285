//! The draped cloth, on a thread of its own and in real time: it falls, is pulled, comes to rest.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use bevy::math::{DVec2, DVec3};

use super::worker::on_own_cores;
use crate::drape::hand::Hand;
use crate::drape::spec::Hold;
use crate::scenario::Scenario;
use crate::studio::camera::Subject;
use crate::studio::fine::Fine;
use crate::studio::hung::{Hung, PIECES_A_SECOND};
use crate::studio::things::Furniture;

/// A place on the cloth: shares of its width and height.
pub type Place = (f64, f64);

/// What is done to the cloth.
#[derive(Debug)]
pub enum Deed {
    /// Hang the cloth of a scenario anew.
    Hang(Box<Scenario>),
    /// Take hold of it, or move the hand that holds it.
    Hold(Place, DVec3),
    /// Let go.
    LetGo,
    /// Fix it where it is, or take what fixes it off.
    Pin(Place),
    /// Fold it from place to place, by an angle in degrees: positive where the front is outside.
    Crease(Place, Place, f64),
    /// Let it move on, or stop.
    Move(bool),
    /// End.
    Quit,
}

/// A moment of the cloth.
#[derive(Debug, Clone)]
pub struct Moment {
    /// Counts how often it was hung anew.
    pub hung: u64,
    /// Whether it has settled: what is around it is then seen as in a recording.
    pub settled: bool,
    /// Its front.
    pub front: Arc<Fine>,
    /// What stands around it.
    pub furniture: Arc<Furniture>,
    /// What is to be seen.
    pub subject: Arc<Subject>,
    /// Seconds since it was hung.
    pub time: f64,
    /// Whether it moves.
    pub moving: bool,
    /// Particles that were pinned by hand, as places in space, m.
    pub pinned: Vec<DVec3>,
    /// Why it cannot be draped, or go on.
    pub problem: Option<String>,
}

/// The thread.
pub struct Hanger {
    deeds: Sender<Deed>,
    moment: Arc<Mutex<Option<Moment>>>,
    told: Arc<Mutex<Option<String>>>,
    thread: Option<JoinHandle<()>>,
}

impl Hanger {
    /// Begins with nothing; `wake` is called when there is something new.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn start(wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let (deeds, given) = channel();
        let moment = Arc::new(Mutex::new(None));
        let there = moment.clone();
        let told = Arc::new(Mutex::new(None));
        let tell = told.clone();
        let thread = std::thread::Builder::new()
            .name("drape".into())
            .spawn(move || on_own_cores(4, move || run(&given, &there, &tell, &wake)))?;
        Ok(Hanger {
            deeds,
            moment,
            told,
            thread: Some(thread),
        })
    }

    /// Does something to the cloth.
    pub fn act(&self, deed: Deed) {
        let _ = self.deeds.send(deed);
    }

    /// Takes what is new.
    pub fn take(&self) -> Option<Moment> {
        self.moment.lock().ok()?.take()
    }

    /// Why the cloth could not be hung, once.
    pub fn problem(&self) -> Option<String> {
        self.told.lock().ok()?.take()
    }

    /// Whether the thread has ended by itself, which it never should.
    pub fn has_died(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }
}

impl Drop for Hanger {
    fn drop(&mut self) {
        self.act(Deed::Quit);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Slower than this, cloth is at rest, m/s.
const REST: f64 = 4e-3;

/// Pieces of time for which it must be.
const CALM: u32 = 20;

/// A click nearer to a pin than this takes it off, m.
pub const NEAR_PIN: f64 = 0.015;

fn drape_positions(hung: &Hung) -> &[DVec3] {
    hung.drape.positions()
}

/// Cloth on its hanger.
struct Hanging {
    hung: Hung,
    number: u64,
    furniture: Arc<Furniture>,
    subject: Arc<Subject>,
    /// The particle that a hand holds.
    held: Option<usize>,
    /// Particles pinned by hand.
    pinned: Vec<usize>,
    /// Whether it goes on when it need not.
    moves: bool,
    calm: u32,
    /// Whether it has settled, and is seen so.
    settled: bool,
    problem: Option<String>,
}

fn run(
    deeds: &Receiver<Deed>,
    there: &Mutex<Option<Moment>>,
    told: &Mutex<Option<String>>,
    wake: &dyn Fn(),
) {
    let mut hanging: Option<Hanging> = None;
    let mut hung = 0;
    let mut moves = false;
    loop {
        let busy = hanging.as_ref().is_some_and(Hanging::is_busy);
        let first = match busy {
            true => deeds.try_recv().ok(),
            false => match deeds.recv() {
                Ok(deed) => Some(deed),
                Err(_) => return,
            },
        };
        let mut changed = first.is_some();
        for deed in first.into_iter().chain(deeds.try_iter()) {
            match (deed, &mut hanging) {
                (Deed::Quit, _) => return,
                (Deed::Hang(scenario), _) => {
                    hung += 1;
                    let (new, problem) = match Hanging::new(&scenario, hung, moves) {
                        Ok(new) => (Some(new), None),
                        Err(why) => (hanging.take(), Some(why)),
                    };
                    hanging = new;
                    if let Ok(mut told) = told.lock() {
                        told.clone_from(&problem);
                    }
                    if let Some(hanging) = &mut hanging {
                        hanging.problem = problem;
                    }
                }
                (Deed::Move(on), None) => moves = on,
                (deed, Some(hanging)) => {
                    hanging.do_to(deed);
                    moves = hanging.moves;
                }
                (_, None) => {}
            }
        }
        let Some(hanging) = &mut hanging else {
            wake();
            continue;
        };
        let began = Instant::now();
        if hanging.is_busy() {
            hanging.go_on();
            changed = true;
        }
        if changed {
            let moment = hanging.moment();
            if let Ok(mut slot) = there.lock() {
                *slot = Some(moment);
            }
            wake();
        }
        if hanging.is_busy() {
            let piece = Duration::from_secs_f64(1.0 / PIECES_A_SECOND);
            std::thread::sleep(piece.saturating_sub(began.elapsed()));
        }
    }
}

impl Hanging {
    fn new(scenario: &Scenario, number: u64, moves: bool) -> Result<Self, String> {
        let hung = Hung::new(scenario, None).map_err(|why| why.to_string())?;
        // Points that the scenario pins can be taken off as those pinned by hand.
        let pins = hung.spec.pins.iter().zip(&hung.drape.pins);
        let pinned = pins
            .filter(|(pin, held)| matches!(pin.at, Hold::Point(..)) && held.particles.len() == 1)
            .flat_map(|(_, held)| held.particles.clone())
            .collect();
        Ok(Hanging {
            number,
            furniture: Arc::new(Furniture::of(&hung.spec, &hung.drape)),
            subject: Arc::new(hung.subject()),
            hung,
            held: None,
            pinned,
            moves,
            calm: 0,
            settled: false,
            problem: None,
        })
    }

    fn is_busy(&self) -> bool {
        if self.problem.is_some() {
            return false;
        }
        let settling = self.hung.drape.time < self.hung.spec.settle_s;
        settling || self.moves || self.held.is_some() || self.calm < CALM
    }

    fn go_on(&mut self) {
        let before = self.hung.drape.time;
        if let Err(why) = self.hung.drape.advance(1.0 / PIECES_A_SECOND) {
            self.problem = Some(why.to_string());
        }
        let settles_at = self.hung.spec.settle_s;
        if before < settles_at && self.hung.drape.time >= settles_at {
            // Seen from now on as a recording sees it.
            self.furniture = Arc::new(Furniture::of(&self.hung.spec, &self.hung.drape));
            self.subject = Arc::new(self.hung.subject());
            self.settled = true;
        }
        let fastest = self.hung.drape.velocities().iter();
        let fastest = fastest.map(|v| v.length_squared()).fold(0.0, f64::max);
        // In the wind cloth never rests; then it stops when it has settled.
        let rests = self.hung.spec.wind.is_some() || fastest < REST * REST;
        self.calm = if rests { self.calm + 1 } else { 0 };
    }

    fn nearest(&self, (u, v): Place) -> usize {
        let (nx, ny) = self.hung.drape.sheet().topology.particles;
        let along =
            |share: f64, n: usize| (share.clamp(0.0, 1.0) * (n - 1) as f64).round() as usize;
        along(v, ny) * nx + along(u, nx)
    }

    fn do_to(&mut self, deed: Deed) {
        self.calm = 0;
        let drape = &mut self.hung.drape;
        match deed {
            Deed::Hold(place, target) => {
                let particle = match self.held {
                    Some(particle) => particle,
                    None => self.nearest(place),
                };
                self.held = Some(particle);
                self.hung.drape.hands = vec![Hand { particle, target }];
            }
            Deed::LetGo => {
                drape.hands.clear();
                self.held = None;
            }
            Deed::Pin(place) => {
                let particle = self.nearest(place);
                let x = drape_positions(&self.hung);
                let near = |pinned: &usize| x[*pinned].distance(x[particle]) < NEAR_PIN;
                let at = self.pinned.iter().position(near);
                let drape = &mut self.hung.drape;
                match at {
                    Some(at) => drape.unpin(self.pinned.remove(at)),
                    None => {
                        self.pinned.push(particle);
                        drape.pin(particle);
                    }
                }
            }
            Deed::Crease(from, to, angle) => {
                let bending = self.hung.spec.material.measured().bending;
                // As a crease of a scenario that does not say otherwise.
                let stiffness = 0.5 * (bending.0 + bending.1) / 0.002;
                let place = |(u, v): Place| DVec2::new(u, v);
                drape.add_crease(place(from), place(to), angle.to_radians(), stiffness);
            }
            Deed::Move(moves) => self.moves = moves,
            Deed::Hang(_) | Deed::Quit => {}
        }
    }

    fn moment(&self) -> Moment {
        let positions = self.hung.drape.positions();
        Moment {
            hung: self.number,
            settled: self.settled,
            front: Arc::new(self.hung.front()),
            furniture: self.furniture.clone(),
            subject: self.subject.clone(),
            time: self.hung.drape.time,
            moving: self.is_busy(),
            pinned: self.pinned.iter().map(|i| positions[*i]).collect(),
            problem: self.problem.clone(),
        }
    }
}
