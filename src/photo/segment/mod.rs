//! Finding warp and weft in a photograph of woven cloth by itself: what paper D did by hand, and names
//! as future work (§4.3.1b, §6.3).
//!
//! | step | what is found | by |
//! |---|---|---|
//! | `contrast` | lightness and tint against what is around | OKLab, local mean and contrast |
//! | `pitch` | how far apart yarns lie, and which way they run | peaks of the Fourier spectrum |
//! | `yarns` | the number of the yarn at every pixel, where yarns bend | phase of the yarns' wave |
//! | `crossings` | each crossing as a patch along its own yarns | |
//! | `repeat`, `classes` | the repeat of the weave, and which crossings are alike | likeness over every lattice |
//! | `sides` | in which of them the warp is on top | streaks, texture along yarns, colour |
//! | `outline`, `bends` | where every yarn's outline runs | a shaded relief, fitted |
//! | `decide` | warp or weft for every pixel, and how sure that is | relief and colour together |

mod bends;
mod classes;
mod contrast;
mod crossings;
mod decide;
mod outline;
mod pitch;
mod relief;
mod repeat;
mod sides;
mod single;
mod spectrum;
mod weave;
mod yarns;

use super::{Mask, Photo, PhotoError};
use bends::Weaving;
use classes::Classes;
use contrast::{Contrast, Lab};
use crossings::Crossings;
use outline::Outline;
use pitch::{PITCHES, Wave, waves};
use repeat::Explained;
use sides::Sides;
use yarns::Yarns;

pub use weave::{KnownWeave, Seen};

/// The fewest pixels along a side of a photograph in which yarns are looked for.
pub const LEAST_SIDE: usize = 48;
/// The fewest yarns of either direction.
const LEAST_YARNS: usize = 8;
/// Pixels within which light is taken to be even while pitches are looked for.
const EVEN_LIGHT: f32 = 20.0;
/// The same in pitches once they are known.
const EVEN_LIGHT_PITCHES: f64 = 3.0;
/// Pitches are looked for in a photograph made smaller by 1, 2, 4 …; from the second on, only those that
/// were too large before.
const LEAST_REDUCED_PITCH: f64 = 7.0;
/// Yarns wider than this are looked at in a smaller photograph.
const WIDE_PITCH: f64 = 14.0;
/// What is finer than this is not looked at in crossings, pitches and pixels: a standard deviation.
const SOFTENED_PITCHES: f64 = 0.08;
const LEAST_SOFTENED: f32 = 0.5;
/// Pixels along a side of the part on which pitches are tried.
const TRIED_SIDE: usize = 640;
/// At most so many pairs of pitches are tried.
const MOST_TRIED: usize = 12;
/// Pixels whose chance to be wrong is greater are doubtful.
pub const DOUBTFUL: f32 = 0.2;

/// Bytes of everything kept for one pixel at the most, beside the photograph.
pub(super) const BYTES_PER_PIXEL: u64 = 400;

/// What may be said beforehand.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Hints {
    /// The weave, if it is known.
    pub weave: Option<KnownWeave>,
    /// Pixels from warp yarn to warp yarn and from weft yarn to weft yarn, if they are known.
    pub pitch: Option<[f64; 2]>,
}

/// What was found in a photograph.
#[derive(Debug, Clone)]
pub struct Segmentation {
    /// Warp or weft for every pixel.
    pub mask: Mask,
    /// For every pixel, the chance that the mask is wrong there, 0 to 0.5.
    pub doubt: Vec<f32>,
    /// Pixels from yarn to yarn: warp, weft.
    pub pitch: [f64; 2],
    /// By how many degrees yarns are turned clockwise from straight down (warp) and straight across
    /// (weft).
    pub turned: [f64; 2],
    /// Yarns in the photograph, across its middle: warp, weft.
    pub yarns: [usize; 2],
    /// The weave.
    pub weave: Seen,
    /// Share of the variance of crossings that the repeat of the weave explains, 0 to 1.
    pub regularity: f64,
    /// The chance that warp and weft are not exchanged, 0.5 to 1.
    pub sure: f64,
    /// Whether warp and weft differ in colour: 0 not at all, 1 plainly.
    pub coloured: f64,
}

impl Segmentation {
    /// The share of pixels whose chance to be wrong is above [`DOUBTFUL`].
    pub fn doubtful_share(&self) -> f64 {
        let doubtful = self.doubt.iter().filter(|doubt| **doubt > DOUBTFUL).count();
        doubtful as f64 / self.doubt.len().max(1) as f64
    }
}

/// Finds warp and weft in a photograph.
///
/// # Errors
/// [`PhotoError::TooSmall`] or [`PhotoError::NoCloth`], with what may help.
pub fn segment(photo: &Photo, hints: &Hints) -> Result<Segmentation, PhotoError> {
    if photo.nx.min(photo.ny) < LEAST_SIDE {
        return Err(PhotoError::TooSmall {
            path: None,
            nx: photo.nx,
            ny: photo.ny,
            least: LEAST_SIDE,
        });
    }
    let lab = Lab::of(photo);
    let found = match hints.pitch {
        Some(pitch) => given(&lab, pitch, hints)?,
        None => search(&lab, hints)?,
    };
    found.segment(&lab, hints)
}

/// The waves of both directions, in a photograph made smaller by a factor.
#[derive(Debug, Clone, Copy)]
struct Pair {
    factor: usize,
    waves: [Wave; 2],
}

impl Pair {
    fn score(&self) -> f64 {
        self.waves[0].score + self.waves[1].score
    }

    /// Mean pitch in pixels of the photograph made smaller.
    fn pitch(&self) -> f64 {
        0.5 * (self.waves[0].pitch() + self.waves[1].pitch())
    }

    /// The same in a photograph in which yarns are not wider than need be.
    fn handy(self) -> Self {
        let more = (self.pitch() / WIDE_PITCH).floor().max(1.0);
        Pair {
            factor: self.factor * more as usize,
            waves: self.waves.map(|wave| wave.reduced(more)),
        }
    }

    fn contrast(&self, lab: &Lab) -> Contrast {
        Contrast::of(lab, (EVEN_LIGHT_PITCHES * self.pitch()) as f32)
    }

    fn yarns(&self, contrast: &Contrast) -> [Yarns; 2] {
        let coarser = self.waves[0].pitch().max(self.waves[1].pitch());
        self.waves
            .map(|wave| Yarns::follow(contrast, wave, coarser))
    }

    /// What crossings are looked at in: without noise finer than any yarn, which would also beat with
    /// the grid of pixels.
    fn softened(&self, contrast: &Contrast) -> Contrast {
        contrast.softened(((SOFTENED_PITCHES * self.pitch()) as f32).max(LEAST_SOFTENED))
    }

    /// How well the weave of these yarns repeats, in the middle of the photograph.
    fn tried(&self, lab: &Lab, hints: &Hints) -> Option<Explained> {
        let part = lab.reduced(self.factor).middle(TRIED_SIDE);
        let contrast = self.contrast(&part);
        let [warp, weft] = self.yarns(&contrast);
        let soft = self.softened(&contrast);
        let crossings = Crossings::of(&soft, &warp, &weft)?;
        repeat_of(&crossings, &crossings.features(), hints)
    }
}

fn repeat_of(
    crossings: &Crossings,
    features: &[[f32; crossings::FEATURES]],
    hints: &Hints,
) -> Option<Explained> {
    match &hints.weave {
        None => repeat::find(crossings, features),
        Some(weave) => weave
            .lattices()
            .into_iter()
            .filter_map(|lattice| repeat::explained(crossings, features, lattice))
            .max_by(|a, b| a.share.total_cmp(&b.share)),
    }
}

/// The best pair of waves whose crossings repeat as those of a weave do.
fn search(lab: &Lab, hints: &Hints) -> Result<Pair, PhotoError> {
    let mut pairs = Vec::new();
    let mut seen = None;
    let (nx, ny) = lab.size();
    let mut factor = 1;
    while nx.min(ny) / factor >= LEAST_SIDE {
        let least = if factor == 1 {
            PITCHES.0
        } else {
            LEAST_REDUCED_PITCH
        };
        let contrast = Contrast::of(&lab.reduced(factor), EVEN_LIGHT);
        if let Some(found) = waves(&contrast, (least, PITCHES.1)) {
            for warp in &found.warp {
                for weft in &found.weft {
                    pairs.push(Pair {
                        factor,
                        waves: [*warp, *weft],
                    });
                }
            }
            if let Some((wave, prominence)) = found.strongest {
                seen.get_or_insert((wave, prominence, factor));
            }
        }
        factor *= 2;
    }
    pairs.sort_by(|a, b| b.score().total_cmp(&a.score()));
    let mut tried: Vec<([f64; 2], bool)> = Vec::new();
    for pair in pairs {
        let pitch = pair.waves.map(|wave| wave.pitch() * pair.factor as f64);
        let same = |other: &[f64; 2]| (0..2).all(|k| (pitch[k] / other[k] - 1.0).abs() < 0.05);
        if tried.iter().any(|(other, _)| same(other)) {
            continue;
        }
        if tried.len() == MOST_TRIED {
            break;
        }
        let pair = pair.handy();
        let t = pair.tried(lab, hints);
        if std::env::var("DYEDBG").is_ok() {
            eprintln!("DBG try {:?} score {:.2} {:?}", pitch, pair.score(), t);
        }
        if t.is_some_and(Explained::is_certain) {
            return Ok(pair);
        }
        tried.push((pitch, false));
    }
    Err(no_cloth(seen, !tried.is_empty()))
}

/// Why no cloth is seen, and what may help.
fn no_cloth(strongest: Option<(Wave, f64, usize)>, tried: bool) -> PhotoError {
    let why = match strongest {
        None => "nothing in it repeats as yarns do".to_owned(),
        Some((wave, _, factor)) if !tried => {
            let [fx, fy] = wave.frequency;
            let turned = libm::atan2(fy, fx).to_degrees();
            let pitch = wave.pitch() * factor as f64;
            format!(
                "something repeats every {pitch:.1} pixels at {turned:.0}°, but yarns are looked for \
                 that run down and across; turn the photograph so that the warp runs down"
            )
        }
        Some(_) => {
            "lines run both ways, but where they cross they do not change as warp and weft do"
                .to_owned()
        }
    };
    PhotoError::NoCloth {
        path: None,
        why: format!(
            "{why}. Photograph it flat, from straight above and in even light, so near that a yarn is 4 \
             to 12 pixels wide"
        ),
    }
}

/// Waves of pitches that were told: near them the strongest of the spectrum.
fn given(lab: &Lab, pitch: [f64; 2], hints: &Hints) -> Result<Pair, PhotoError> {
    let mean = 0.5 * (pitch[0] + pitch[1]);
    let factor = (mean / WIDE_PITCH).floor().max(1.0) as usize;
    let contrast = Contrast::of(
        &lab.reduced(factor),
        (EVEN_LIGHT_PITCHES * mean) as f32 / factor as f32,
    );
    let near = |k: usize| {
        let pitch = pitch[k] / factor as f64;
        let found = waves(&contrast, (0.9 * pitch, 1.1 * pitch));
        let best = found.and_then(|found| [found.warp, found.weft][k].first().copied());
        best.unwrap_or(Wave {
            frequency: if k == 0 {
                [1.0 / pitch, 0.0]
            } else {
                [0.0, 1.0 / pitch]
            },
            score: 0.0,
        })
    };
    let pair = Pair {
        factor,
        waves: [near(0), near(1)],
    };
    match pair.tried(lab, hints) {
        Some(explained) if explained.is_certain() => Ok(pair),
        _ => Err(PhotoError::NoCloth {
            path: None,
            why: format!(
                "with warp yarns every {} and weft yarns every {} pixels, crossings do not repeat as those \
                 of a weave do",
                pitch[0], pitch[1]
            ),
        }),
    }
}

/// A weave as far as it is known from looking at crossings.
struct Woven {
    explained: Explained,
    /// Evidence for every crossing that the warp is on top.
    crossed: Vec<f32>,
    sides: Sides,
    outline: Outline,
}

impl Pair {
    fn segment(&self, lab: &Lab, hints: &Hints) -> Result<Segmentation, PhotoError> {
        let few = || PhotoError::NoCloth {
            path: None,
            why: format!(
                "it has too few yarns to tell the weave by; at least {LEAST_YARNS} each way are needed"
            ),
        };
        let contrast = self.contrast(&lab.reduced(self.factor));
        let soft = self.softened(&contrast);
        let [warp, weft] = self.yarns(&contrast);
        if warp.count() < LEAST_YARNS || weft.count() < LEAST_YARNS {
            return Err(few());
        }
        // Light from one side makes yarns seem to lie aside. Once their outline is known, crossings are
        // looked at again.
        let first = woven(&contrast, &soft, [&warp, &weft], hints, None).ok_or_else(few)?;
        let [du, dv] = first.outline.relief.shift;
        let mut begin = first.outline;
        begin.relief.shift = [0.0; 2];
        let (warp, weft) = (warp.shifted(du), weft.shifted(dv));
        let yarns = [&warp, &weft];
        let crossings = Crossings::of(&soft, &warp, &weft).ok_or_else(few)?;
        let Woven {
            explained,
            crossed,
            sides,
            outline,
        } = woven(&contrast, &soft, yarns, hints, Some(begin)).ok_or_else(few)?;
        let weaving = Weaving {
            contrast: &contrast,
            yarns,
            crossings: &crossings,
            crossed: &crossed,
            relief: outline.relief,
            blur: outline.blur,
        };
        let (mask, doubt) = decide::decide(&weaving, &sides, self.factor, lab.size());
        let turned = |k: usize| {
            let [fx, fy] = self.waves[k].frequency;
            let angle = if k == 0 {
                libm::atan2(fy, fx)
            } else {
                -libm::atan2(fx, fy)
            };
            angle.to_degrees()
        };
        Ok(Segmentation {
            mask,
            doubt,
            pitch: self.waves.map(|wave| wave.pitch() * self.factor as f64),
            turned: [turned(0), turned(1)],
            yarns: yarns.map(Yarns::count),
            weave: Seen::of(explained.lattice, &sides.warp_up),
            regularity: explained.share,
            sure: sides.sure,
            coloured: sides.coloured,
        })
    }
}

fn woven(
    contrast: &Contrast,
    soft: &Contrast,
    yarns: [&Yarns; 2],
    hints: &Hints,
    begin: Option<Outline>,
) -> Option<Woven> {
    let crossings = Crossings::of(soft, yarns[0], yarns[1])?;
    let features = crossings.features();
    let explained = repeat_of(&crossings, &features, hints)?;
    let classes = Classes::find(&crossings, &features, explained.lattice);
    let known = hints
        .weave
        .as_ref()
        .map(|weave| weave.sides(explained.lattice));
    let likely = Sides::likely(&crossings, &classes, known.as_deref());
    let (sides, outline, left) =
        outline::find(contrast, yarns, &crossings, &classes, &likely, begin)?;
    if std::env::var("DYEDBG").is_ok() {
        eprintln!("DBG {explained:?} {sides:?} {outline:?} left {left:.3}");
    }
    let crossed = single::evidence(&crossings, &features, &classes, &sides);
    Some(Woven {
        explained,
        crossed,
        sides,
        outline,
    })
}
