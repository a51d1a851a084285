//! How far apart yarns lie and which way they run, from peaks of the spectrum.
//!
//! Every warp yarn of a plain, twill, satin or basket weave is like its neighbours when looked at as a
//! whole, so stripes of the warp's own pitch run down the photograph, and stripes of the weft's across:
//! peaks near the two axes. The repeat of the weave makes peaks too, but aside.

use super::contrast::Contrast;
use super::spectrum::Spectrum;

/// How far yarns may be turned from the edges of the photograph: the tangent of 12°.
const MOST_TURNED: f64 = 0.212_556;
/// How many times the power of chance a peak needs.
const LEAST_PROMINENCE: f64 = 12.0;
/// Peaks of one axis within so many powers of ten of the best are tried.
const WITHIN: f64 = 1.3;
/// At most so many of one axis are tried.
const MOST_TRIED: usize = 3;
/// Pitches that can be found in one size of the photograph, pixels.
pub const PITCHES: (f64, f64) = (2.1, 32.0);

/// A wave across yarns: the yarns of one direction, as the spectrum shows them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wave {
    /// Waves a pixel, across and down.
    pub frequency: [f64; 2],
    /// How strong it is, as a power of ten.
    pub score: f64,
}

impl Wave {
    /// Pixels from yarn to yarn.
    pub fn pitch(self) -> f64 {
        let [fx, fy] = self.frequency;
        1.0 / libm::sqrt(fx * fx + fy * fy)
    }

    /// The same wave in a photograph whose pixels are `factor` times as large.
    pub fn reduced(self, factor: f64) -> Self {
        Wave {
            frequency: self.frequency.map(|f| f * factor),
            ..self
        }
    }
}

/// What a spectrum shows: possible waves of the warp and of the weft, the best first, and the strongest
/// wave in any direction.
pub struct Waves {
    /// Across the warp yarns.
    pub warp: Vec<Wave>,
    /// Across the weft yarns.
    pub weft: Vec<Wave>,
    /// The strongest of all, with its prominence.
    pub strongest: Option<(Wave, f64)>,
}

/// The waves with a pitch within `pitches`, pixels; nothing if the photograph is too small.
pub fn waves(contrast: &Contrast, pitches: (f64, f64)) -> Option<Waves> {
    let spectrum = Spectrum::of(&contrast.light, &contrast.tint)?;
    let half = spectrum.size as i32 / 2;
    let size = spectrum.size as f64;
    let (mut warp, mut weft, mut strongest) = (Vec::new(), Vec::new(), None);
    for fy in -half + 1..half {
        for fx in -half + 1..half {
            let (x, y) = (f64::from(fx), f64::from(fy));
            let length = libm::sqrt(x * x + y * y);
            // At least four waves in a tile, and a pitch that is asked for.
            if length < 4.0 || length * pitches.0 > size || length * pitches.1 < size {
                continue;
            }
            if !spectrum.is_peak(fx, fy) {
                continue;
            }
            let prominence = spectrum.prominence(fx, fy);
            if prominence < LEAST_PROMINENCE {
                continue;
            }
            let wave = Wave {
                frequency: spectrum.top(fx, fy),
                score: libm::log10(spectrum.power(fx, fy)) + libm::log10(prominence),
            };
            let along = |along: f64, aside: f64| {
                along > 0.0 && aside.abs() <= (MOST_TURNED * along).max(1.01)
            };
            if along(x, y) {
                warp.push(wave);
            } else if along(y, x) {
                weft.push(wave);
            }
            let best = strongest.is_none_or(|(best, _): (Wave, f64)| wave.score > best.score);
            if best && (fy > 0 || (fy == 0 && fx > 0)) {
                strongest = Some((wave, prominence));
            }
        }
    }
    for waves in [&mut warp, &mut weft] {
        waves.sort_by(|a, b| b.score.total_cmp(&a.score));
        let best = waves.first().map_or(0.0, |wave| wave.score);
        waves.retain(|wave| wave.score > best - WITHIN);
        waves.truncate(MOST_TRIED);
    }
    Some(Waves {
        warp,
        weft,
        strongest,
    })
}
