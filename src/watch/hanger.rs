//! The draped cloth, on a thread of its own and in real time: it falls, is pulled, comes to rest.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use bevy::math::{DVec2, DVec3};

use crate::drape::hand::Hand;
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
        let thread = std::thread::Builder::new()
            .name("drape".into())
            .spawn(move || run(&given, &there, &wake))?;
        Ok(Hanger {
            deeds,
            moment,
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
    problem: Option<String>,
}

fn run(deeds: &Receiver<Deed>, there: &Mutex<Option<Moment>>, wake: &dyn Fn()) {
    let mut hanging: Option<Hanging> = None;
    let mut hung = 0;
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
                    let moves = hanging.as_ref().is_some_and(|hanging| hanging.moves);
                    let (new, problem) = match Hanging::new(&scenario, hung, moves) {
                        Ok(new) => (Some(new), None),
                        Err(why) => (hanging.take(), Some(why)),
                    };
                    hanging = new;
                    if let Some(hanging) = &mut hanging {
                        hanging.problem = problem;
                    }
                }
                (deed, Some(hanging)) => hanging.do_to(deed),
                (_, None) => {}
            }
        }
        let Some(hanging) = &mut hanging else {
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
        Ok(Hanging {
            number,
            furniture: Arc::new(Furniture::of(&hung.spec, &hung.drape)),
            subject: Arc::new(hung.subject()),
            hung,
            held: None,
            pinned: Vec::new(),
            moves,
            calm: 0,
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
        if let Err(why) = self.hung.drape.advance(1.0 / PIECES_A_SECOND) {
            self.problem = Some(why.to_string());
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
                let drape = &mut self.hung.drape;
                match self.pinned.iter().position(|pinned| *pinned == particle) {
                    Some(at) => {
                        self.pinned.remove(at);
                        drape.unpin(particle);
                    }
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
