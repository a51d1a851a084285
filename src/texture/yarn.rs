//! The shade of a yarn: fibres wound in a helix around it, light from the upper left, and the way
//! it rises over the yarns it crosses and dives under them (paper D §4.3.1 after Adabala et al.
//! 2003; the helix of model section 6).

use fastnoise_lite::{FastNoiseLite, NoiseType};
use libm::{asinf, cosf, sqrtf};

use crate::chance::{Chance, Purpose};
use crate::cloth::Yarns;
use crate::scenario::YarnLook;

/// Where light comes from: left, up, and out of the cloth. A unit vector.
const LIGHT: [f32; 3] = [-0.30, -0.40, 0.866];
/// Light from all around, as a share of all light on a surface that faces the viewer.
const AMBIENT: f32 = 0.66;
/// How much darker a yarn is where others lie over it.
const DEPTH_SHADE: f32 = 0.55;
/// How much darker the edge of a yarn is than its middle, without any direct light.
const EDGE_SHADE: f32 = 0.30;
/// Makes up for what all shades together take away, so that undyed cotton is white.
const BRIGHTNESS: f32 = 1.14;
/// How steeply a yarn rises and dives, as height over half a pitch.
const CRIMP: f32 = 0.55;

/// A point on a yarn.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    /// Number of the yarn.
    pub yarn: usize,
    /// Place across it, −1 at its left or upper edge to 1.
    pub across: f32,
    /// Place along it, in cells.
    pub along: f32,
    /// How far its surface lies above that of the yarn which crosses it there, in yarn radii:
    /// 2 and more on top of a crossing, less beside it, negative beneath one.
    pub clearance: f32,
    /// How steeply the height changes along the yarn, per half pitch.
    pub slope: f32,
}

/// How the yarns of one direction look.
pub struct YarnShade {
    look: YarnLook,
    /// Radius of a yarn in cells.
    radius: f32,
    /// Cells along the yarn for one full turn of its fibres.
    turn: f32,
    /// Brightness of each yarn, around 1.
    brightness: Vec<f32>,
    /// Beginning of each yarn's twist, in turns.
    phase: Vec<f32>,
    slub: FastNoiseLite,
    runs_down: bool,
}

impl YarnShade {
    /// The look of `yarns`, which run down (warp) or across (weft).
    pub fn new(look: YarnLook, yarns: &Yarns, runs_down: bool, seed: u64) -> Self {
        let purpose = if runs_down {
            Purpose::WarpLook
        } else {
            Purpose::WeftLook
        };
        let mut chance = Chance(seed).sequence(purpose);
        let uneven = look.unevenness;
        let mut brightness = Vec::with_capacity(yarns.yarns.len());
        let mut phase = Vec::with_capacity(yarns.yarns.len());
        for _ in &yarns.yarns {
            brightness.push(1.0 + (uneven * chance.between((-0.09, 0.05))) as f32);
            phase.push(chance.unit() as f32);
        }
        let mut slub = FastNoiseLite::with_seed((seed as i32) ^ purpose as i32);
        slub.set_noise_type(Some(NoiseType::OpenSimplex2));
        slub.set_frequency(Some(1.0));
        YarnShade {
            look,
            radius: yarns.width as f32 / 2.0,
            turn: look.turn as f32 * yarns.width as f32,
            brightness,
            phase,
            slub,
            runs_down,
        }
    }

    /// The shade at a point of an even yarn, about 1 where it is brightest.
    pub fn surface(&self, point: Point) -> f32 {
        let sine = point.across.clamp(-0.999, 0.999);
        let cosine = sqrtf(1.0 - sine * sine);
        self.light(point, sine, cosine)
            * self.depth(point.clearance)
            * self.fibres(point, sine)
            * BRIGHTNESS
    }

    /// Light on the round yarn, tilted where it rises or dives.
    fn light(&self, point: Point, sine: f32, cosine: f32) -> f32 {
        let tilt = -CRIMP * point.slope;
        let normal = if self.runs_down {
            [sine, tilt, cosine]
        } else {
            [tilt, sine, cosine]
        };
        let length = sqrtf(normal.iter().map(|n| n * n).sum());
        let facing: f32 = normal.iter().zip(LIGHT).map(|(n, l)| n * l).sum();
        let lit = (facing / length).max(0.0) / LIGHT[2];
        // Soft cotton scatters light: even its edges, turned away, are not dark.
        AMBIENT * (1.0 - EDGE_SHADE * (1.0 - cosine)) + (1.0 - AMBIENT) * lit
    }

    /// The yarns that cross over this one keep light from it: the more, the less it stands out
    /// above them.
    fn depth(&self, clearance: f32) -> f32 {
        let covered = ((1.0 - clearance) * 0.5).clamp(0.0, 1.0);
        1.0 - DEPTH_SHADE * covered * covered
    }

    /// Grooves between the fibres. Fibres wind around the yarn with phase χ = N(θ − 2πs/p); even
    /// ones shade it by 1 − b + b·|cos(χ/2)|. Spun fibres are short and of all sizes, so half of
    /// the shade is chance along the same helix.
    fn fibres(&self, point: Point, sine: f32) -> f32 {
        let rough = self.look.roughness as f32;
        let theta = asinf(sine);
        let own = 53.0 * point.yarn as f32;
        let stray = self
            .slub
            .get_noise_2d(point.along / (3.0 * self.radius), own + 500.0);
        let turns = point.along / self.turn + self.phase[point.yarn] + 0.06 * stray;
        let chi = self.look.fibres as f32 * (theta - std::f32::consts::TAU * turns);
        let even = 1.0 - cosf(0.5 * chi).abs();
        let uneven = 0.5
            - 0.5
                * self
                    .slub
                    .get_noise_2d(0.32 * chi, own + point.along / (3.0 * self.radius));
        1.0 - rough * (0.45 * even + 0.55 * uneven)
    }

    /// Thick and thin places along the yarn, and loose fibre on it: a factor around 1.
    pub fn unevenness(&self, point: Point) -> f32 {
        let uneven = self.look.unevenness as f32;
        let own = 37.0 * point.yarn as f32;
        let slub = self
            .slub
            .get_noise_2d(point.along / (16.0 * self.radius), own);
        let fuzz = self.slub.get_noise_2d(
            point.along / (1.6 * self.radius),
            own + 1000.0 + 2.2 * point.across,
        );
        self.brightness[point.yarn] * (1.0 + uneven * (0.08 * slub + 0.06 * fuzz))
    }
}
