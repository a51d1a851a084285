//! A photograph freed from uneven light: lightness and the one tint that varies most, both against
//! what is around, in units of the contrast that is around.

use super::super::Photo;
use super::super::photograph::ToOklab;
use super::super::plane::Plane;

/// Contrast less than this counts as none, in OKLab.
const LEAST_CONTRAST: f32 = 2e-3;
/// Contrast is cut off here.
const MOST: f32 = 3.0;

/// The three channels of OKLab.
#[derive(Debug, Clone)]
pub struct Lab([Plane; 3]);

impl Lab {
    /// The channels of a photograph.
    pub fn of(photo: &Photo) -> Self {
        let table = ToOklab::new();
        let mut planes = [0, 1, 2].map(|_| Plane {
            nx: photo.nx,
            ny: photo.ny,
            values: Vec::with_capacity(photo.rgb.len()),
        });
        for rgb in &photo.rgb {
            let lab = table.of(*rgb);
            planes[0].values.push(lab.lightness as f32);
            planes[1].values.push(lab.a as f32);
            planes[2].values.push(lab.b as f32);
        }
        Lab(planes)
    }

    /// Pixels across and down.
    pub fn size(&self) -> (usize, usize) {
        (self.0[0].nx, self.0[0].ny)
    }

    /// Made smaller.
    pub fn reduced(&self, factor: usize) -> Self {
        Lab(self.0.each_ref().map(|plane| plane.reduced(factor)))
    }

    /// The middle part, at most so many pixels along a side.
    pub fn middle(&self, side: usize) -> Self {
        let (nx, ny) = self.size();
        let size = (nx.min(side), ny.min(side));
        let begin = ((nx - size.0) / 2, (ny - size.1) / 2);
        Lab(self.0.each_ref().map(|plane| plane.cut(begin, size)))
    }
}

/// A photograph against its surroundings.
#[derive(Debug, Clone)]
pub struct Contrast {
    /// Lighter or darker than around.
    pub light: Plane,
    /// To one side or the other of the colours around.
    pub tint: Plane,
}

impl Contrast {
    /// The contrast of every pixel with what lies within `sigma` pixels.
    pub fn of(lab: &Lab, sigma: f32) -> Self {
        let [light, a, b] = lab.0.each_ref().map(|plane| {
            let around = plane.blurred(sigma);
            Plane::new(plane.nx, plane.ny, |x, y| {
                plane.get(x, y) - around.get(x, y)
            })
        });
        let (nx, ny) = (light.nx, light.ny);
        // The axis of the largest variance in (a, b).
        let mut moments = [0.0; 3];
        for (a, b) in a.values.iter().zip(&b.values) {
            let (a, b) = (f64::from(*a), f64::from(*b));
            moments[0] += a * a;
            moments[1] += a * b;
            moments[2] += b * b;
        }
        let angle = 0.5 * libm::atan2(2.0 * moments[1], moments[0] - moments[2]);
        let (cos, sin) = (libm::cos(angle) as f32, libm::sin(angle) as f32);
        let tint = Plane::new(nx, ny, |x, y| cos * a.get(x, y) + sin * b.get(x, y));
        let power = Plane::new(nx, ny, |x, y| {
            let (l, t) = (light.get(x, y), tint.get(x, y));
            l * l + t * t
        })
        .blurred(sigma);
        let scaled = |plane: &Plane| {
            Plane::new(nx, ny, |x, y| {
                let around = power.get(x, y).sqrt() + LEAST_CONTRAST;
                (plane.get(x, y) / around).clamp(-MOST, MOST)
            })
        };
        Contrast {
            light: scaled(&light),
            tint: scaled(&tint),
        }
    }

    /// Freed from what is finer than `sigma` pixels.
    pub fn softened(&self, sigma: f32) -> Self {
        Contrast {
            light: self.light.blurred(sigma),
            tint: self.tint.blurred(sigma),
        }
    }
}
