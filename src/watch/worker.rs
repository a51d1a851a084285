//! The process, on a thread of its own: the window never waits for it.
//!
//! The window gives [`Order`]s, and takes what is there to be seen ([`Seen`]) when it draws. While the
//! process plays it is one frame ahead of the window and no more, so what is seen is what there is.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use bevy::app::App;
use bevy::prelude::World;

use crate::DyeingPlugins;
use crate::cloth::Cloth;
use crate::pattern::Stroke;
use crate::scenario::{Experiment, Origin, Scenario};
use crate::schedule::ProcessClock;
use crate::session::Session;
use crate::session::course::Course;
use crate::session::effect::Effect;
use crate::session::overlay::{self, Field, Overlay};
use crate::session::paint::Paint;
use crate::session::section::Section;
use crate::studio::mips::{self, Kind};
use crate::texture::{OtherSide, Picture, Relief, Scale, change_look, see_both_sides};

/// How fast the process plays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pace {
    /// Steps a second.
    PerSecond(f64),
    /// Steps a frame.
    PerFrame(u64),
}

/// A line across the cloth: from place to place, as shares of its width and height.
pub type Cut = ((f64, f64), (f64, f64));

/// What the window wants.
#[derive(Debug)]
pub enum Order {
    /// Another experiment.
    Open(Box<Experiment>),
    /// Another scenario.
    Edit {
        /// The whole of it.
        scenario: Box<Scenario>,
        /// What an undo list calls the change.
        label: String,
        /// Whether it is one of many while a slider is held.
        held: bool,
    },
    /// The slider was let go.
    Release,
    /// Undo the last edit.
    Undo,
    /// Do it again.
    Redo,
    /// Play, or pause.
    Play(bool),
    /// How fast.
    Pace(Pace),
    /// Go to a step.
    GoTo(u64),
    /// One frame on, as fast as it plays.
    Forward,
    /// Paint.
    Paint(Paint, Stroke),
    /// Draw so many pixels along one side of a cell.
    Scale(u32),
    /// Show a field over the cloth.
    Overlay(Option<(Field, overlay::Seen)>),
    /// Show what lies below a line.
    Cut(Option<Cut>),
    /// The scenario lies somewhere else from now on.
    Origin(Origin),
    /// End.
    Quit,
}

/// A picture of the cloth, ready for the renderer.
#[derive(Debug)]
pub struct Shown {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// RGBA of it and of all its halves.
    pub levels: Vec<u8>,
}

impl Shown {
    fn new(rgb: &[u8], width: usize, height: usize, kind: Kind) -> Arc<Self> {
        Arc::new(Shown {
            width,
            height,
            levels: mips::chain(rgb, width, height, kind),
        })
    }

    fn of(picture: &Picture) -> Arc<Self> {
        Shown::new(&picture.rgb, picture.width, picture.height, Kind::Colour)
    }
}

/// What is there to be seen.
#[derive(Debug, Clone)]
pub struct Seen {
    /// The experiment as it is now.
    pub experiment: Arc<Experiment>,
    /// Counts experiments that were opened: a new one is another cloth.
    pub opened: u64,
    /// Counts edits, undone ones as well.
    pub edits: u64,
    /// Steps done.
    pub step: u64,
    /// Hours done.
    pub hours: f64,
    /// Where the process is going.
    pub target: u64,
    /// Whether it plays.
    pub playing: bool,
    /// Front and back.
    pub sides: [Arc<Shown>; 2],
    /// Relief of front and back; made anew with the cloth.
    pub reliefs: [Arc<Shown>; 2],
    /// Width and height of the cloth, cells.
    pub cells: (usize, usize),
    /// The field that is shown.
    pub overlay: Option<Arc<Overlay>>,
    /// What lies below the line.
    pub section: Option<Arc<Section>>,
    /// The ledger over time.
    pub course: Arc<Course>,
    /// The steps of the moments that are kept.
    pub kept: Vec<u64>,
    /// What would be undone and redone.
    pub undo: [Option<String>; 2],
    /// Why the last order could not be followed.
    pub problem: Option<String>,
}

/// Where the thread and the window meet.
#[derive(Default)]
struct Meeting {
    seen: Mutex<Option<Seen>>,
    taken: Condvar,
}

/// The thread.
pub struct Worker {
    orders: Sender<Order>,
    meeting: Arc<Meeting>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    /// Begins with an experiment. Moments are kept within `budget` bytes; `wake` is called when there is
    /// something new to be seen.
    pub fn start(
        experiment: Experiment,
        budget: usize,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<Self> {
        let (orders, given) = channel();
        let meeting = Arc::new(Meeting::default());
        let there = meeting.clone();
        let thread = std::thread::Builder::new()
            .name("process".into())
            .spawn(move || {
                on_own_cores(2, move || {
                    Process::open(experiment, budget, 1, None).run(&given, &there, &wake);
                });
            })?;
        Ok(Worker {
            orders,
            meeting,
            thread: Some(thread),
        })
    }

    /// Gives an order.
    pub fn order(&self, order: Order) {
        // A thread that has ended is not waited for.
        let _ = self.orders.send(order);
    }

    /// Takes what is new.
    pub fn take(&self) -> Option<Seen> {
        let seen = self.meeting.seen.lock().ok()?.take();
        if seen.is_some() {
            self.meeting.taken.notify_all();
        }
        seen
    }

    /// Whether the thread has ended by itself, which it never should.
    pub fn has_died(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.order(Order::Quit);
        self.meeting.taken.notify_all();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Does work on threads of its own: one of `share` parts of the machine's. Threads that draw, and those
/// of other work, would otherwise keep it waiting wherever its own meet; what it comes to is the same.
pub(super) fn on_own_cores(share: usize, work: impl FnOnce() + Send) {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = (cores / share).max(1);
    match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool.install(work),
        // Then on everyone's.
        Err(_) => work(),
    }
}

/// The longest that the process runs before it looks for orders.
const SLICE: Duration = Duration::from_millis(30);

/// The longest that a frame may count for when the process plays at steps a second.
const LONGEST_FRAME: f64 = 0.1;

/// How often what is on its way to a step far away is shown, at most; where showing takes long, it takes no
/// more than a fifth of the time.
const GLIMPSE: Duration = Duration::from_millis(150);

/// The finest that the back and the reliefs are drawn: only the draped cloth shows them.
const FINEST_BACK: u32 = 2;

/// Draws the cloth of a world anew, at so many pixels a cell; returns the reliefs of front and back.
fn redrawn(world: &mut World, session: &mut Session, scale: u32) -> [Arc<Shown>; 2] {
    let coarse = scale.min(FINEST_BACK);
    world.insert_resource(Scale(scale));
    // This draws the back as well, if it was drawn before; it is drawn more coarsely below.
    world.remove_resource::<OtherSide>();
    change_look(world, session.scenario().look.clone());
    world.insert_resource(Scale(coarse));
    see_both_sides(world);
    world.insert_resource(Scale(scale));
    session.show(world);
    let cloth = world.resource::<Cloth>();
    let scenario = session.scenario();
    let relief = |cloth: &Cloth| {
        let relief = Relief::new(cloth, &scenario.look.yarn, scenario.seed, coarse as usize);
        Shown::new(&relief.normals(), relief.width, relief.height, Kind::Normal)
    };
    let turned = cloth.turned_over();
    match scenario.look.side {
        crate::scenario::Side::Face => [relief(cloth), relief(&turned)],
        crate::scenario::Side::Back => [relief(&turned), relief(cloth)],
    }
}

struct Process {
    app: App,
    session: Session,
    budget: usize,
    scale: u32,
    opened: u64,
    edits: u64,
    playing: bool,
    pace: Pace,
    overlay: Option<(Field, overlay::Seen)>,
    cut: Option<Cut>,
    reliefs: [Arc<Shown>; 2],
    problem: Option<String>,
    /// Whether it is time to end.
    quits: bool,
    /// Threads for what the window waits for.
    all: Option<rayon::ThreadPool>,
    /// When and where the last frame of playing was.
    last: Instant,
    /// When something on the way was shown last.
    glimpse: Instant,
    /// How long it took to show it.
    showing: Duration,
    /// Steps that are due but not whole yet.
    due: f64,
}

impl Process {
    fn open(experiment: Experiment, budget: usize, opened: u64, before: Option<&Process>) -> Self {
        let mut app = App::new();
        app.add_plugins(DyeingPlugins).insert_resource(Scale(1));
        let session = Session::open(app.world_mut(), experiment, budget);
        let total = session.scenario().process.steps();
        let nothing = Shown::new(&[0; 3], 1, 1, Kind::Normal);
        let mut process = Process {
            app,
            session,
            budget,
            scale: 1,
            opened,
            edits: 0,
            playing: true,
            pace: before.map_or(
                Pace::PerSecond(total as f64 / 20.0),
                |before| match before.pace {
                    Pace::PerFrame(steps) => Pace::PerFrame(steps),
                    Pace::PerSecond(_) => Pace::PerSecond(total as f64 / 20.0),
                },
            ),
            overlay: before.and_then(|before| before.overlay),
            cut: before.and_then(|before| before.cut),
            reliefs: [nothing.clone(), nothing],
            problem: None,
            quits: false,
            all: rayon::ThreadPoolBuilder::new().build().ok(),
            last: Instant::now(),
            glimpse: Instant::now(),
            showing: Duration::ZERO,
            due: 0.0,
        };
        process.redraw();
        process
    }

    /// Draws both sides, and their relief, anew. The window waits for nothing else then, so all of the
    /// machine takes part.
    fn redraw(&mut self) {
        let (world, session, scale) = (self.app.world_mut(), &mut self.session, self.scale);
        self.reliefs = match &self.all {
            Some(all) => all.install(|| redrawn(world, session, scale)),
            None => redrawn(world, session, scale),
        };
    }

    fn run(mut self, orders: &Receiver<Order>, meeting: &Meeting, wake: &dyn Fn()) {
        self.publish(orders, meeting, wake);
        loop {
            let busy = self.is_busy();
            let first = match busy {
                true => orders.try_recv().ok(),
                false => match orders.recv() {
                    Ok(order) => Some(order),
                    Err(_) => return,
                },
            };
            let mut changed = first.is_some();
            for order in first.into_iter().chain(orders.try_iter()) {
                self.follow(order);
            }
            if self.is_busy() && !self.quits {
                changed |= self.advance(orders);
            }
            if self.quits {
                return;
            }
            if changed && !self.publish(orders, meeting, wake) {
                return;
            }
        }
    }

    fn world(&self) -> &World {
        self.app.world()
    }

    fn is_busy(&self) -> bool {
        self.playing || !self.session.has_arrived(self.world())
    }

    fn follow(&mut self, order: Order) {
        let world = self.app.world_mut();
        match order {
            Order::Open(experiment) => {
                *self = Process::open(*experiment, self.budget, self.opened + 1, Some(self));
            }
            Order::Edit {
                scenario,
                label,
                held,
            } => {
                let done = self.session.edit(world, *scenario, &label, held);
                self.edited(done.map_err(|why| why.to_string()));
            }
            Order::Release => self.session.release(),
            Order::Undo => {
                let done = self.session.undo(world);
                self.edited(done.map_err(|why| why.to_string()));
            }
            Order::Redo => {
                let done = self.session.redo(world);
                self.edited(done.map_err(|why| why.to_string()));
            }
            Order::Paint(paint, stroke) => {
                let done = self.session.paint(world, paint, stroke);
                self.edited(done.map_err(|why| why.to_string()));
            }
            Order::Play(play) => {
                // At the end, playing begins anew.
                let total = self.session.scenario().process.steps();
                if play && self.session.target() >= total {
                    self.session.go_to(world, 0, |_| false);
                }
                self.playing = play;
                self.last = Instant::now();
            }
            Order::Pace(pace) => self.pace = pace,
            Order::GoTo(step) => {
                self.playing = false;
                self.session.go_to(world, step, |_| false);
            }
            Order::Forward => {
                self.playing = false;
                let steps = match self.pace {
                    Pace::PerFrame(steps) => steps,
                    Pace::PerSecond(steps) => (steps / 60.0).round().max(1.0) as u64,
                };
                let to = self.session.target() + steps;
                self.session.go_to(world, to, |_| false);
            }
            Order::Scale(scale) => {
                self.scale = scale.max(1);
                self.redraw();
            }
            Order::Overlay(overlay) => self.overlay = overlay,
            Order::Cut(cut) => self.cut = cut,
            Order::Origin(origin) => self.session.lies_at(origin),
            Order::Quit => self.quits = true,
        }
    }

    /// What an edit has come to.
    fn edited(&mut self, done: Result<Effect, String>) {
        self.edits += 1;
        match done {
            Ok(Effect::Nothing) => self.problem = None,
            Ok(_) => {
                self.problem = None;
                // The weave may be another, and with it the back and the relief.
                self.redraw();
            }
            Err(why) => self.problem = Some(why),
        }
    }

    /// Goes on for a slice of time. Whether there is something new to be seen.
    fn advance(&mut self, orders: &Receiver<Order>) -> bool {
        let total = self.session.scenario().process.steps();
        let world = self.app.world_mut();
        let began = Instant::now();
        let mut waiting = Vec::new();
        let mut runs = 0;
        let mut go_on = |_: u64| {
            waiting.extend(orders.try_recv());
            runs += 1;
            // One run at least, however long it took to get ready: else it would never arrive.
            waiting.is_empty() && (runs == 1 || began.elapsed() < SLICE)
        };
        let mut glimpsed = false;
        let arrived = if self.playing && self.session.has_arrived(world) {
            let elapsed = self.last.elapsed().as_secs_f64();
            self.last = Instant::now();
            self.due += match self.pace {
                Pace::PerFrame(steps) => steps as f64,
                Pace::PerSecond(steps) => steps * elapsed.min(LONGEST_FRAME),
            };
            let steps = self.due.floor();
            self.due -= steps;
            if steps < 1.0 {
                // Slower than the eye: wait for the step to be due.
                std::thread::sleep(Duration::from_millis(8));
                true
            } else {
                self.session.advance(world, steps as u64, &mut go_on)
            }
        } else {
            let arrived = self.session.go_on(world, &mut go_on);
            // Far away: what lies on the way is a film too.
            if !arrived && self.glimpse.elapsed() > GLIMPSE.max(4 * self.showing) {
                self.session.show(world);
                glimpsed = true;
            }
            arrived
        };
        let now = world.resource::<ProcessClock>().step;
        if self.playing && now >= total {
            self.playing = false;
        }
        for order in waiting {
            self.follow(order);
        }
        // On its way to a frame of the film nothing is shown: the frame is.
        arrived || glimpsed
    }

    /// Gives the window what there is to be seen; waits until it has taken what was there before, or
    /// there are orders. False if it is time to end.
    fn publish(&mut self, orders: &Receiver<Order>, meeting: &Meeting, wake: &dyn Fn()) -> bool {
        let began = Instant::now();
        let mut seen = self.seen();
        self.glimpse = Instant::now();
        // Drawing took about as long as getting it ready for the renderer.
        self.showing = 2 * began.elapsed();
        let Ok(mut slot) = meeting.seen.lock() else {
            return false;
        };
        // While nothing plays the newest is what counts.
        while self.playing && slot.is_some() {
            let waited = meeting.taken.wait_timeout(slot, Duration::from_millis(20));
            let Ok((again, _)) = waited else {
                return false;
            };
            slot = again;
            if slot.is_some() {
                // An order may be to end.
                drop(slot);
                let waiting: Vec<_> = orders.try_iter().collect();
                let asked = !waiting.is_empty();
                for order in waiting {
                    self.follow(order);
                }
                if self.quits {
                    return false;
                }
                if asked {
                    // What was asked for meanwhile is to be seen as well.
                    seen = self.seen();
                }
                let Ok(again) = meeting.seen.lock() else {
                    return false;
                };
                slot = again;
            }
        }
        *slot = Some(seen);
        drop(slot);
        wake();
        true
    }

    fn seen(&self) -> Seen {
        let world = self.world();
        let clock = world.resource::<ProcessClock>();
        let cloth = world.resource::<Cloth>();
        let cells = (cloth.grid.nx, cloth.grid.ny);
        let history = self.session.history();
        let in_cells = |(x, y): (f64, f64)| (x * cells.0 as f64, y * cells.1 as f64);
        Seen {
            experiment: Arc::new(self.session.experiment()),
            opened: self.opened,
            edits: self.edits,
            step: clock.step,
            hours: clock.hours(),
            target: self.session.target(),
            playing: self.playing,
            sides: [
                Shown::of(world.resource::<Picture>()),
                Shown::of(&world.resource::<OtherSide>().picture),
            ],
            reliefs: self.reliefs.clone(),
            cells,
            overlay: self
                .overlay
                .map(|(field, layer)| Arc::new(Overlay::of(world, field, layer, true))),
            section: self
                .cut
                .map(|(from, to)| Arc::new(Section::along(world, in_cells(from), in_cells(to)))),
            course: Arc::new(self.session.course().clone()),
            kept: self.session.timeline().steps().collect(),
            undo: [
                history.undoable().map(|(label, _)| label.to_owned()),
                history.redoable().map(|(label, _)| label.to_owned()),
            ],
            problem: self.problem.clone(),
        }
    }
}
