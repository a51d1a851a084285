//! The shapes that patterns are made of, as functions of a point in cells.

use fastnoise_lite::{FastNoiseLite, FractalType, NoiseType};

use super::{Canvas, Pattern};

/// A shape: the value from 0 to 1 at a point `(x, y)` in cells from the top left corner.
pub(super) type Shape = Box<dyn Fn(f64, f64) -> f32 + Sync>;

fn inside(yes: bool) -> f32 {
    if yes { 1.0 } else { 0.0 }
}

/// The function of a shape that is neither a picture, chance, nor a combination of others.
pub(super) fn rule(pattern: &Pattern, canvas: &Canvas) -> Shape {
    let mm = canvas.cell_mm;
    let (width, height) = (canvas.nx as f64, canvas.ny as f64);
    let point = move |(across, down): (f64, f64)| (across * width, down * height);
    match *pattern {
        Pattern::Disc { diameter, centre } => {
            let (r, (cx, cy)) = (diameter.cells(mm) / 2.0, point(centre));
            Box::new(move |x, y| inside(distance(x - cx, y - cy) <= r))
        }
        Pattern::Discs {
            diameter,
            pitch,
            staggered,
        } => {
            let (r, pitch) = (diameter.cells(mm) / 2.0, pitch.cells(mm));
            Box::new(move |x, y| {
                let odd = (y / pitch).floor().rem_euclid(2.0) == 1.0;
                let shift = if staggered && odd { pitch / 2.0 } else { 0.0 };
                let dx = (x + shift).rem_euclid(pitch) - pitch / 2.0;
                let dy = y.rem_euclid(pitch) - pitch / 2.0;
                inside(distance(dx, dy) <= r)
            })
        }
        Pattern::Rectangle { size, centre } => {
            let (w, h) = (size.0.cells(mm) / 2.0, size.1.cells(mm) / 2.0);
            let (cx, cy) = point(centre);
            Box::new(move |x, y| inside((x - cx).abs() <= w && (y - cy).abs() <= h))
        }
        Pattern::Stripes {
            width: stripe,
            gap,
            offset,
            angle,
        } => {
            let (stripe, gap, offset) = (stripe.cells(mm), gap.cells(mm), offset.cells(mm));
            let (across, down) = direction(angle);
            Box::new(move |x, y| {
                let along = x * across + y * down - offset;
                inside(along.rem_euclid(stripe + gap) < stripe)
            })
        }
        Pattern::Rings {
            width: ring,
            gap,
            centre,
        } => {
            let (ring, gap, (cx, cy)) = (ring.cells(mm), gap.cells(mm), point(centre));
            Box::new(move |x, y| inside(distance(x - cx, y - cy) % (ring + gap) < ring))
        }
        Pattern::Rays {
            count,
            share,
            centre,
        } => {
            let (cx, cy) = point(centre);
            let turn = f64::from(count) / std::f64::consts::TAU;
            Box::new(move |x, y| {
                inside((libm::atan2(y - cy, x - cx) * turn).rem_euclid(1.0) < share)
            })
        }
        Pattern::Radial { from, to, centre } => {
            let (from, to, (cx, cy)) = (from.cells(mm), to.cells(mm), point(centre));
            let fade = (to - from).max(1e-9);
            Box::new(move |x, y| ((to - distance(x - cx, y - cy)) / fade).clamp(0.0, 1.0) as f32)
        }
        Pattern::Ramp { angle } => {
            let (across, down) = direction(angle);
            // Along the slope, from the corner where it begins to the opposite one.
            let reach = across.abs() * width + down.abs() * height;
            let begin = across.min(0.0) * width + down.min(0.0) * height;
            Box::new(move |x, y| ((x * across + y * down - begin) / reach).clamp(0.0, 1.0) as f32)
        }
        _ => Box::new(|_, _| 0.0),
    }
}

/// Clouds of chance over a plane in units of their grain, 0 to 1.
pub(crate) fn clouds(
    scenario_seed: u64,
    seed: u32,
    octaves: u32,
) -> impl Fn(f64, f64) -> f32 + Sync {
    // FastNoise takes 32 bits of seed: fold the scenario's into them.
    let folded = (scenario_seed ^ (scenario_seed >> 32)) as u32;
    let mixed = folded.wrapping_mul(0x9e37_79b1) ^ seed;
    let mut noise = FastNoiseLite::with_seed(mixed as i32);
    noise.set_noise_type(Some(NoiseType::OpenSimplex2));
    noise.set_fractal_type(Some(FractalType::FBm));
    noise.set_fractal_octaves(Some(octaves as i32));
    noise.set_frequency(Some(0.5));
    move |x, y| (0.5 + 0.5 * noise.get_noise_2d(x as f32, y as f32)).clamp(0.0, 1.0)
}

fn distance(dx: f64, dy: f64) -> f64 {
    (dx * dx + dy * dy).sqrt()
}

fn direction(degrees: f64) -> (f64, f64) {
    let angle = degrees.to_radians();
    (libm::cos(angle), libm::sin(angle))
}
