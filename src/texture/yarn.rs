//! The shade of a yarn: fibres wound in a helix around it, light from the upper left, and the shade
//! of the yarns that cross over it (paper D §4.3.1 after Adabala et al. 2003, whose terms, twist and
//! roughness of the surface, these are; the helix of model section 6).

use libm::{asinf, cosf, expf, sqrtf};

use super::geometry::{Place, Point};
use super::noise;
use crate::chance::{Chance, Purpose};
use crate::cloth::{Cloth, Layer, Yarns};
use crate::scenario::YarnLook;

/// Where light comes from: left, up, and out of the cloth. A unit vector.
const LIGHT: [f32; 3] = [-0.34, -0.44, 0.831];
/// Light from all around, as a share of all light on a surface that faces the viewer.
const AMBIENT: f32 = 0.74;
/// How much less of the light from all around reaches the side of a yarn than its top.
const EDGE_SHADE: f32 = 0.40;
/// How much darker a yarn is where it comes out from beneath another.
const CROSSING_SHADE: f32 = 0.34;
/// How far that shade reaches, in radii.
const CROSSING_REACH: f32 = 0.55;
/// What is seen through a gap: the cloth's own shade on what lies behind.
const GAP_SHADE: f32 = 0.58;
/// Makes up for what all shades together take away, so that undyed cotton is white.
const BRIGHTNESS: f32 = 1.20;
/// How steep a rising yarn looks: its axis is drawn this much higher than wide.
const RELIEF: f32 = 1.0;

/// How the yarns of one direction look.
struct Run {
    /// Brightness of each yarn, around 1.
    brightness: Vec<f32>,
    /// Beginning of each yarn's twist, in turns.
    phase: Vec<f32>,
    /// Cells across a yarn as the scenario has it.
    width: Vec<f32>,
    seed: u32,
}

/// Shades the surface of yarns.
pub struct YarnShade {
    look: YarnLook,
    /// Weft and warp.
    runs: [Run; 2],
    /// Pixels along one side of a cell.
    scale: f32,
}

impl YarnShade {
    /// The look of a cloth's yarns, drawn at `scale` pixels a cell.
    pub fn new(look: YarnLook, cloth: &Cloth, seed: u64, scale: usize) -> Self {
        let run = |yarns: &Yarns, purpose: Purpose| {
            let mut chance = Chance(seed).sequence(purpose);
            let uneven = look.unevenness;
            let mut run = Run {
                brightness: Vec::with_capacity(yarns.yarns.len()),
                phase: Vec::with_capacity(yarns.yarns.len()),
                width: yarns.spans().iter().map(|span| span.width as f32).collect(),
                seed: noise::seed(seed, purpose as u32),
            };
            for _ in &yarns.yarns {
                run.brightness
                    .push(1.0 + (uneven * chance.between((-0.10, 0.06))) as f32);
                run.phase.push(chance.unit() as f32);
            }
            run
        };
        YarnShade {
            look,
            runs: [
                run(&cloth.weft, Purpose::WeftLook),
                run(&cloth.warp, Purpose::WarpLook),
            ],
            scale: scale as f32,
        }
    }

    /// The shade of a pixel from what is seen in it, about 1 where white cotton is brightest.
    pub fn of(&self, places: &[Place]) -> f32 {
        // Fibres are far finer than a pixel or wider: once a pixel is enough.
        let yarn = places.iter().find(|place| place.seen().is_yarn());
        let surface = yarn.map_or(1.0, |place| {
            let (run, point) = (&self.runs[place.layer as usize], place.seen());
            self.fibres(run, point) * self.unevenness(run, point)
        });
        self.smooth(places) * surface
    }

    /// The shade of a pixel without its fibres.
    pub fn smooth(&self, places: &[Place]) -> f32 {
        let sum: f32 = places.iter().map(|place| self.at(place)).sum();
        sum / places.len() as f32
    }

    /// The shade of a smooth and even yarn.
    fn at(&self, place: &Place) -> f32 {
        let point = place.seen();
        if !point.is_yarn() {
            return GAP_SHADE;
        }
        let sine = point.across.clamp(-0.999, 0.999);
        let cosine = sqrtf(1.0 - sine * sine);
        self.light(place.layer, point, sine, cosine) * crossing(place) * BRIGHTNESS
    }

    /// Light on the round yarn, tilted where it rises and dives, and the lustre of its fibres.
    fn light(&self, layer: Layer, point: Point, sine: f32, cosine: f32) -> f32 {
        let tilt = -RELIEF * point.slope * point.radius;
        let normal = match layer {
            Layer::Warp => [sine, tilt, cosine.max(0.2)],
            Layer::Weft => [tilt, sine, cosine.max(0.2)],
        };
        let length = sqrtf(normal.iter().map(|n| n * n).sum());
        let facing: f32 = normal.iter().zip(LIGHT).map(|(n, l)| n * l).sum();
        let lit = (facing / length).max(0.0) / LIGHT[2];
        // Soft fibre scatters light: even its edges, turned away, are not dark.
        let soft = AMBIENT * (1.0 - EDGE_SHADE * (1.0 - cosine)) + (1.0 - AMBIENT) * lit;
        // Smooth fibres shine in a band across the yarn, where they bend away from the light.
        let along = match layer {
            Layer::Warp => LIGHT[1],
            Layer::Weft => LIGHT[0],
        };
        let bend = along - 0.9 * tilt;
        let lustre = self.look.lustre as f32;
        if lustre == 0.0 {
            return soft;
        }
        let shine = expf(-14.0 * bend * bend) * cosine * cosine;
        soft + lustre * (0.55 * shine - 0.12)
    }

    /// Grooves between the fibres. Fibres wind around the yarn with phase χ = N(θ − 2πs/p); even
    /// ones shade it by 1 − b + b·|cos(χ/2)|. Spun fibres are short and of all sizes, so most of
    /// the shade is chance along the same helix.
    fn fibres(&self, run: &Run, point: Point) -> f32 {
        let rough = self.look.roughness as f32;
        let (width, count) = (run.width[point.yarn], self.look.fibres as f32);
        let theta = asinf(point.across.clamp(-1.0, 1.0));
        let seed = run.seed ^ (point.yarn as u32).wrapping_mul(0x27d4_eb2f);
        let s = point.along / width;
        let stray = noise::along(0.8 * s, seed ^ 5);
        let turns = s / self.look.turn as f32 + run.phase[point.yarn] + 0.02 * stray;
        let helix = theta - std::f32::consts::TAU * turns;
        let chi = count * helix;
        let even = 1.0 - cosf(0.5 * chi).abs();
        // Single fibres, and strands of several that lie together.
        let fine = noise::over(0.40 * chi, 2.1 * s, seed ^ 6);
        let coarse = noise::over(0.12 * chi, 1.3 * s, seed ^ 7);
        // What is finer than a pixel averages out.
        let spacing = std::f32::consts::PI * width * self.scale / count;
        let (sharp, soft) = (
            (spacing / 2.5).clamp(0.25, 1.0),
            (spacing / 0.8).clamp(0.35, 1.0),
        );
        let grooves = sharp * (0.30 * (even - 0.36) + 0.34 * fine) + soft * 0.30 * coarse;
        1.0 - rough * (0.30 + grooves)
    }

    /// Thick and thin places along the yarn, and loose fibre on it: a factor around 1.
    fn unevenness(&self, run: &Run, point: Point) -> f32 {
        let uneven = self.look.unevenness as f32;
        let seed = run.seed ^ (point.yarn as u32).wrapping_mul(0x9e37_79b1);
        let s = point.along / run.width[point.yarn];
        let slub = noise::along(0.11 * s, seed ^ 8) + 0.6 * noise::along(0.45 * s, seed ^ 9);
        let fuzz = noise::over(1.3 * s, 1.7 * point.across, seed ^ 10);
        run.brightness[point.yarn] * (1.0 + uneven * (0.07 * slub + 0.07 * fuzz))
    }
}

/// The shade that a yarn lies in where another comes over it, or stands beside it and higher.
fn crossing(place: &Place) -> f32 {
    let (point, other) = (place.seen(), place.other());
    let clearance = (point.height - other.height).max(0.0);
    // About exp(−clearance / reach), in a fraction of the time.
    let far = clearance / CROSSING_REACH;
    let covered = 1.0 / (1.0 + far + 0.5 * far * far);
    1.0 - CROSSING_SHADE * covered
}
