//! How fast the solvers are: `cargo bench`.
//!
//! Prints billions of cell updates a second of explicit steps for cloth of several sizes, what an
//! evaluation of the accelerated solver costs there, memory, and the time of the whole seikaiha,
//! start to end, beside its error.
//!
//! `--steps NX NY STEPS` prints speed and error of explicit steps alone, for `benches/peers`.

use std::time::Instant;

use dyelapse::diffusion::{Leap, Peer};
use dyelapse::prelude::*;
use dyelapse::scenario::Origin;

/// The seikaiha of the library, as large as wanted.
fn seikaiha(nx: usize, ny: usize, solver: &str) -> Experiment {
    let text = Experiment::load("seikaiha").expect("it is bundled").text;
    let text = text
        .replace(
            "(Cells(800), Cells(600))",
            &format!("(Cells({nx}), Cells({ny}))"),
        )
        .replace(
            "step_h: 0.0005,",
            &format!("step_h: 0.0005, solver: {solver},"),
        );
    Experiment::parse("seikaiha", Origin::Memory, text).expect("it is a scenario")
}

/// Billions of cell updates a second.
fn speed(cells: usize, updates: u64, begin: Instant) -> f64 {
    cells as f64 * updates as f64 / begin.elapsed().as_secs_f64() / 1e9
}

/// Bytes of memory that this process holds.
fn memory() -> u64 {
    let pid = sysinfo::get_current_pid().expect("a process has a number");
    let mut system = sysinfo::System::new().expect("the system tells");
    system.refresh_processes(sysinfo::ProcessesToUpdate::Some(&[pid]), true);
    system.process(pid).map_or(0, |process| process.memory())
}

fn explicit(nx: usize, ny: usize, steps: u64) {
    let mut app = dyeing_app(seikaiha(nx, ny, "Explicit"));
    advance_to(app.world_mut(), 2, |_| true);
    let begin = Instant::now();
    advance_to(app.world_mut(), 2 + steps, |_| true);
    println!(
        "explicit     {nx:>5}×{ny:<5} {:>8.3} billion cell updates a second",
        speed(2 * nx * ny, steps, begin)
    );
}

fn accelerated(nx: usize, ny: usize, until: u64) {
    let before = memory();
    let mut app = dyeing_app(seikaiha(nx, ny, "Accelerated"));
    let begin = Instant::now();
    advance_to(app.world_mut(), until, |_| true);
    let evaluations = app.world().resource::<Leap>().evaluations;
    println!(
        "accelerated  {nx:>5}×{ny:<5} {:>8.3} billion cell updates a second, {:.1} bytes a cell",
        speed(2 * nx * ny, evaluations, begin),
        (memory() - before) as f64 / (2 * nx * ny) as f64
    );
}

fn whole_seikaiha() {
    let seconds = |_| {
        let mut app = dyeing_app(seikaiha(800, 600, "Accelerated"));
        let begin = Instant::now();
        advance_to(app.world_mut(), 400_000, |_| true);
        let leap = app.world().resource::<Leap>();
        (begin.elapsed().as_secs_f64(), leap.evaluations, leap.leaps)
    };
    let best = (0..5).map(seconds).min_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((seconds, evaluations, leaps)) = best {
        println!(
            "seikaiha, 400,000 steps: {seconds:.2} s ({evaluations} evaluations, {leaps} leaps)"
        );
    }
}

fn accuracy() {
    let [mut explicit, mut accelerated] =
        ["Explicit", "Accelerated"].map(|solver| dyeing_app(seikaiha(800, 600, solver)));
    for step in [1250, 5000, 12_500] {
        let fields = [&mut explicit, &mut accelerated].map(|app| {
            advance_to(app.world_mut(), step, |_| true);
            app.world().resource::<FreeDye>().concentration.clone()
        });
        let differences = fields[0]
            .iter()
            .zip(&fields[1])
            .map(|(a, b)| f64::from((a - b).abs()));
        let (mut largest, mut squares) = (0.0_f64, 0.0);
        for difference in differences {
            largest = largest.max(difference);
            squares += difference * difference;
        }
        println!(
            "its error after {step:>6} steps: {largest:.5} at most, {:.6} RMS of full scale",
            (squares / fields[0].len() as f64).sqrt()
        );
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| a != "--bench")
        .collect();
    if let [flag, nx, ny, steps] = arguments.as_slice()
        && flag == "--steps"
    {
        let [nx, ny, steps] = [nx, ny, steps].map(|n| n.parse().expect("a number"));
        let mut small = Peer::new(200, 150);
        small.advance(200);
        let error = small.error_after(200);
        let mut peer = Peer::new(nx, ny);
        peer.advance(2);
        let begin = Instant::now();
        peer.advance(steps);
        println!("{} {error}", speed(2 * nx * ny, steps as u64, begin));
        return;
    }
    if arguments.iter().any(|a| a == "--seikaiha") {
        whole_seikaiha();
        return;
    }
    for (nx, ny, steps) in [(800, 600, 1200), (2048, 2048, 120), (4096, 4096, 48)] {
        explicit(nx, ny, steps);
    }
    for (nx, ny) in [(800, 600), (2048, 2048), (4096, 4096), (8192, 8192)] {
        // Enough evaluations for what is done once, when the process begins, to count for little.
        accelerated(nx, ny, 3000);
    }
    whole_seikaiha();
    accuracy();
}
