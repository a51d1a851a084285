//! Which classes of crossings have the warp on top.
//!
//! Three things differ between a warp and a weft that lies on top, whatever both look like:
//! - a yarn that passes over several others runs on without a dark line: such floats are streaks along
//!   the yarn;
//! - what is not the same in every crossing of a class, fibres, twist, thick places, changes more across
//!   a yarn than along it;
//! - and it goes on along the same yarn to the next crossing of the class.
//!
//! And where warp and weft differ in colour, classes fall into two groups by it.

use rayon::prelude::*;

use super::classes::Classes;
use super::crossings::{Crossings, Patch, SAMPLES, SIDE, changes};
use super::repeat::Lattice;

/// Evidence is worth no more standard errors than this.
const MOST_CERTAIN: f64 = 16.0;
/// Weights of the three kinds of evidence, fitted to rendered cloth whose truth is known.
const STREAK_WEIGHT: f64 = 6.0;
const TEXTURE_WEIGHT: f64 = 0.2;
const YARN_WEIGHT: f64 = 0.35;
/// At most so many ways to divide the classes are handed on, of those whose groups differ nearly as
/// plainly as the best do.
const LIKELY: usize = 6;
const LIKELY_SCORE: f64 = 0.7;
/// The most classes of which every weave is tried.
const MOST_TRIED_ALL: usize = 14;
/// Features of a class that have to do with the shape of yarns; after them come those of colour.
const SHAPES: usize = 3;
/// Sides of a square that the rest of a patch is kept in, to be compared along yarns.
const REST: usize = 4;

/// Which classes have the warp on top, and how sure that is.
#[derive(Debug, Clone, PartialEq)]
pub struct Sides {
    /// For every class, whether the warp is on top.
    pub warp_up: Vec<bool>,
    /// The chance, 0.5 to 1, that it is not just the other way round.
    pub sure: f64,
    /// How plainly warp and weft differ in lightness or colour: 0 not at all, 1 so that colour alone
    /// tells them apart.
    pub coloured: f64,
}

/// What is measured of a class.
struct Class {
    /// How much more its mean patch changes across the warp than across the weft.
    streak: f64,
    /// The same of what its patches do not have in common, and the variance of that mean.
    texture: f64,
    texture_error: f64,
    /// How much more alike its next crossing along the warp is than along the weft, and the variance.
    yarn: f64,
    yarn_error: f64,
    /// Lightness and tint in the middle, and their variances from crossing to crossing.
    colour: [f64; 2],
    colour_spread: [f64; 2],
}

impl Sides {
    /// The likeliest sides of all classes, the best first. With `known` weaves, each of which says
    /// whether the warp is on top in each class of the lattice, only their place is looked for.
    pub fn likely(
        crossings: &Crossings,
        classes: &Classes,
        known: Option<&[Vec<bool>]>,
    ) -> Vec<Self> {
        let measured = measure(crossings, classes);
        let judge = Judge::new(&measured, classes.lattice);
        let candidates = match known {
            Some(known) => known
                .iter()
                .flat_map(|known| placed(classes.lattice, known))
                .collect(),
            None => possible(classes.lattice, &judge),
        };
        // Of two that are each other's reverse, the one for which there is evidence.
        let mut judged: Vec<(f64, f64, Vec<bool>)> = candidates
            .into_iter()
            .map(|warp_up| (judge.groups(&warp_up), judge.evidence(&warp_up), warp_up))
            .filter(|(_, evidence, _)| known.is_some() || *evidence > 0.0)
            .collect();
        let score = |(groups, evidence, _): &(f64, f64, Vec<bool>)| {
            if *evidence > 0.0 {
                *groups
            } else {
                groups - 100.0
            }
        };
        judged.sort_by(|a, b| score(b).total_cmp(&score(a)));
        let best = judged.first().map_or(0.0, score);
        judged
            .into_iter()
            .take(LIKELY)
            .take_while(|candidate| score(candidate) > LIKELY_SCORE * best)
            .map(|(_, evidence, warp_up)| Sides {
                sure: 1.0 / (1.0 + libm::exp(-2.0 * evidence)),
                coloured: ((judge.colours_apart(&warp_up) - 1.5) / 2.0).clamp(0.0, 1.0),
                warp_up,
            })
            .collect()
    }
}

/// All shifts of a weave.
fn placed(lattice: Lattice, known: &[bool]) -> Vec<Vec<bool>> {
    (0..lattice.c)
        .flat_map(|dp| (0..lattice.a).map(move |de| (de, dp)))
        .map(|(de, dp)| {
            lattice
                .moved(de, dp)
                .into_iter()
                .map(|class| known[class])
                .collect()
        })
        .collect()
}

/// Every weave on a lattice that holds together: each end and each pick lies on top somewhere and
/// beneath somewhere. Of too many, those in which all features together set the groups apart.
fn possible(lattice: Lattice, judge: &Judge) -> Vec<Vec<bool>> {
    let classes = lattice.classes();
    let (ends, picks) = lattice.repeat();
    let bits = |crossings: &mut dyn Iterator<Item = (usize, usize)>| {
        crossings.fold(0_u64, |bits, (e, p)| bits | 1 << lattice.class(e, p))
    };
    let mut lines: Vec<u64> = (0..picks)
        .map(|p| bits(&mut (0..ends).map(|e| (e, p))))
        .chain((0..ends).map(|e| bits(&mut (0..picks).map(|p| (e, p)))))
        .collect();
    lines.sort_unstable();
    lines.dedup();
    let holds = |weave: &u64| {
        lines
            .iter()
            .all(|line| weave & line != 0 && weave & line != *line)
    };
    let weaves: Vec<u64> = if classes <= MOST_TRIED_ALL {
        (1..1_u64 << classes).collect()
    } else {
        let order = judge.order();
        let begun = order.iter().scan(0_u64, |weave, class| {
            *weave |= 1 << class;
            Some(*weave)
        });
        begun.take(classes - 1).collect()
    };
    weaves
        .into_iter()
        .filter(holds)
        .map(|weave| (0..classes).map(|class| weave >> class & 1 == 1).collect())
        .collect()
}

struct Judge<'a> {
    classes: &'a [Class],
    lattice: Lattice,
    /// Streak, texture, likeness along yarns, lightness and tint of every class, standardised, each with its weight.
    features: Vec<(f64, Vec<f64>)>,
}

impl<'a> Judge<'a> {
    fn new(classes: &'a [Class], lattice: Lattice) -> Self {
        let feature = |value: &dyn Fn(&Class) -> f64| -> Vec<f64> {
            let values: Vec<f64> = classes.iter().map(value).collect();
            let n = values.len() as f64;
            let mean = values.iter().sum::<f64>() / n;
            let variance = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n;
            let scale = 1.0 / (libm::sqrt(variance) + 1e-9);
            values.iter().map(|v| (v - mean) * scale).collect()
        };
        let strength = |k: usize| {
            let n = classes.len() as f64;
            let mean = classes.iter().map(|c| c.colour[k]).sum::<f64>() / n;
            let between = classes
                .iter()
                .map(|c| (c.colour[k] - mean) * (c.colour[k] - mean))
                .sum::<f64>();
            let within: f64 = classes.iter().map(|c| c.colour_spread[k]).sum();
            2.0 * ((between / (within + 1e-6) - 1.0) / 3.0).clamp(0.0, 1.0)
        };
        Judge {
            classes,
            lattice,
            features: vec![
                (1.0, feature(&|c| c.streak)),
                (1.0, feature(&|c| c.texture)),
                (1.0, feature(&|c| c.yarn)),
                (strength(0), feature(&|c| c.colour[0])),
                (strength(1), feature(&|c| c.colour[1])),
            ],
        }
    }

    /// The classes from those most like a warp on top to those most like a weft.
    fn order(&self) -> Vec<usize> {
        let count = self.classes.len();
        let shape: Vec<f64> = (0..count)
            .map(|i| {
                self.features[..SHAPES]
                    .iter()
                    .map(|(_, values)| values[i])
                    .sum()
            })
            .collect();
        let colour = self.features[SHAPES..].iter().map(|(weight, values)| {
            let along: f64 = values.iter().zip(&shape).map(|(a, b)| a * b).sum();
            (weight * along.signum(), values)
        });
        let mut like = shape.clone();
        for (weight, values) in colour {
            for (like, value) in like.iter_mut().zip(values) {
                *like += weight * value;
            }
        }
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|a, b| like[*b].total_cmp(&like[*a]));
        order
    }

    /// How plainly the two groups differ: the share of each feature's variance between them.
    fn groups(&self, warp_up: &[bool]) -> f64 {
        self.features
            .iter()
            .map(|(weight, values)| {
                let mean = |side: bool| {
                    let of = values.iter().zip(warp_up).filter(|(_, up)| **up == side);
                    let (sum, count) = of.fold((0.0, 0.0), |(s, n), (v, _)| (s + v, n + 1.0));
                    sum / f64::max(count, 1.0)
                };
                let means = [mean(false), mean(true)];
                let within: f64 = values
                    .iter()
                    .zip(warp_up)
                    .map(|(v, up)| {
                        let apart = v - means[usize::from(*up)];
                        apart * apart
                    })
                    .sum();
                weight * (1.0 - within / values.len() as f64)
            })
            .sum()
    }

    /// The difference of the group with the warp on top and the other, and its standard error.
    fn apart(
        &self,
        warp_up: &[bool],
        value: impl Fn(&Class) -> f64,
        error: impl Fn(&Class) -> f64,
    ) -> (f64, f64) {
        let (mut means, mut errors, mut counts) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        for (class, up) in self.classes.iter().zip(warp_up) {
            let k = usize::from(*up);
            means[k] += value(class);
            errors[k] += error(class);
            counts[k] += 1.0;
        }
        let apart = means[1] / counts[1] - means[0] / counts[0];
        let error = errors[1] / (counts[1] * counts[1]) + errors[0] / (counts[0] * counts[0]);
        (apart, libm::sqrt(error) + 1e-9)
    }

    /// Evidence that the warp is on top where it is said to be, and not beneath.
    fn evidence(&self, warp_up: &[bool]) -> f64 {
        let certain =
            |(apart, error): (f64, f64)| (apart / error).clamp(-MOST_CERTAIN, MOST_CERTAIN);
        let texture = certain(self.apart(warp_up, |c| c.texture, |c| c.texture_error));
        let yarn = certain(self.apart(warp_up, |c| c.yarn, |c| c.yarn_error));
        let (streak, _) = self.apart(warp_up, |c| c.streak, |_| 0.0);
        let streak = if self.has_floats(warp_up) {
            streak
        } else {
            0.0
        };
        TEXTURE_WEIGHT * texture + YARN_WEIGHT * yarn + STREAK_WEIGHT * streak
    }

    /// Whether some yarn passes over more than one other.
    fn has_floats(&self, warp_up: &[bool]) -> bool {
        let (below, right) = (self.lattice.moved(0, 1), self.lattice.moved(1, 0));
        (0..warp_up.len()).any(|class| {
            (warp_up[class] && warp_up[below[class]]) || (!warp_up[class] && !warp_up[right[class]])
        })
    }

    /// How far the colours of warp and weft lie apart, in standard deviations from crossing to crossing.
    fn colours_apart(&self, warp_up: &[bool]) -> f64 {
        let apart = |k: usize| {
            let (apart, _) = self.apart(warp_up, |c| c.colour[k], |_| 0.0);
            let n = self.classes.len() as f64;
            let within = self.classes.iter().map(|c| c.colour_spread[k]).sum::<f64>() / n;
            // The classes of one group must not differ as much among themselves.
            let mean = [false, true].map(|side| {
                let of = self
                    .classes
                    .iter()
                    .zip(warp_up)
                    .filter(|(_, up)| **up == side);
                let (sum, count) = of.fold((0.0, 0.0), |(s, n), (c, _)| (s + c.colour[k], n + 1.0));
                sum / f64::max(count, 1.0)
            });
            let among = self
                .classes
                .iter()
                .zip(warp_up)
                .map(|(c, up)| {
                    let d = c.colour[k] - mean[usize::from(*up)];
                    d * d
                })
                .sum::<f64>()
                / n;
            apart * apart / (within + among + 1e-6)
        };
        libm::sqrt(apart(0) + apart(1))
    }
}

fn measure(crossings: &Crossings, classes: &Classes) -> Vec<Class> {
    let count = classes.lattice.classes();
    let means = [false, true].map(|tint| mean_patches(crossings, classes, tint));
    let rests: Vec<Option<Rest>> = (0..crossings.len())
        .into_par_iter()
        .map(|i| {
            crossings.whole[i].then(|| {
                let class = classes.of[i];
                Rest::of(&crossings.light(i), &crossings.tint(i), &means[0][class])
            })
        })
        .collect();
    let power: f64 = means[0].iter().map(|mean| both(mean).1).sum::<f64>() / count as f64;
    (0..count)
        .into_par_iter()
        .map(|class| {
            let members = || (0..rests.len()).filter(|i| classes.of[*i] == class);
            let of = || members().filter_map(|i| rests[i].as_ref());
            let (texture, texture_error) = mean_and_error(of().map(|rest| rest.texture));
            let [light, tint] = [0, 1].map(|k| mean_and_spread(of().map(|rest| rest.colour[k])));
            let (yarn, yarn_error) = along_yarns(crossings, classes, &rests, class);
            Class {
                streak: both(&means[0][class]).0 / (power + 1e-9),
                texture,
                texture_error,
                yarn,
                yarn_error,
                colour: [light.0, tint.0],
                colour_spread: [light.1, tint.1],
            }
        })
        .collect()
}

/// How much more a patch changes across the warp than across the weft, and how much in all; squares.
fn both(patch: &Patch) -> (f64, f64) {
    changes(patch).fold((0.0, 0.0), |(more, all), (_, x, y)| {
        let (x, y) = (f64::from(x * x), f64::from(y * y));
        (more + x - y, all + x + y)
    })
}

/// What sets a crossing apart from the others of its class.
struct Rest {
    /// How much more it changes across the warp than across the weft, −1 to 1.
    texture: f64,
    /// Its lightness in parts.
    parts: [f32; REST * REST],
    /// Mean lightness and tint in the middle, with what it has in common.
    colour: [f64; 2],
}

impl Rest {
    fn of(light: &Patch, tint: &Patch, mean: &Patch) -> Self {
        let rest: Patch = std::array::from_fn(|i| light[i] - mean[i]);
        let (more, all) = both(&rest);
        let mut parts = [0.0; REST * REST];
        for (i, value) in rest.iter().enumerate() {
            let (x, y) = (i % SIDE * REST / SIDE, i / SIDE * REST / SIDE);
            parts[y * REST + x] += value * ((REST * REST) as f32 / SAMPLES as f32);
        }
        let inner = |i: &usize| {
            let within = |k: usize| (2..SIDE - 2).contains(&k);
            within(i % SIDE) && within(i / SIDE)
        };
        let middle = |patch: &Patch| {
            let sum: f32 = (0..SAMPLES).filter(inner).map(|i| patch[i]).sum();
            f64::from(sum) / (0..SAMPLES).filter(inner).count() as f64
        };
        Rest {
            texture: more / (all + 1e-6),
            parts,
            colour: [middle(light), middle(tint)],
        }
    }
}

fn mean_patches(crossings: &Crossings, classes: &Classes, tint: bool) -> Vec<Patch> {
    (0..classes.lattice.classes())
        .into_par_iter()
        .map(|class| {
            let mut sum = [0.0_f64; SAMPLES];
            let mut count = 0.0;
            for i in (0..crossings.len()).filter(|i| crossings.whole[*i] && classes.of[*i] == class)
            {
                let patch = if tint {
                    crossings.tint(i)
                } else {
                    crossings.light(i)
                };
                for (sum, value) in sum.iter_mut().zip(patch) {
                    *sum += f64::from(value);
                }
                count += 1.0;
            }
            sum.map(|sum| (sum / f64::max(count, 1.0)) as f32)
        })
        .collect()
}

/// The mean and the variance.
fn mean_and_spread(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.clone().count().max(1) as f64;
    let mean = values.clone().sum::<f64>() / count;
    let spread = values.map(|v| (v - mean) * (v - mean)).sum::<f64>() / count;
    (mean, spread)
}

/// The mean and its variance.
fn mean_and_error(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.clone().count().max(1) as f64;
    let (mean, spread) = mean_and_spread(values);
    (mean, spread / count + 1e-9)
}

/// How much more alike the crossings of a class are along the warp than along the weft, as correlations
/// of what sets them apart, and the variance of that.
fn along_yarns(
    crossings: &Crossings,
    classes: &Classes,
    rests: &[Option<Rest>],
    class: usize,
) -> (f64, f64) {
    let (ends, picks) = classes.lattice.repeat();
    let members = || (0..rests.len()).filter(|i| classes.of[*i] == class);
    let power: f64 = members()
        .filter_map(|i| rests[i].as_ref())
        .map(|rest| rest.parts.iter().map(|v| f64::from(v * v)).sum::<f64>())
        .sum::<f64>()
        / members().count().max(1) as f64;
    let alike = |step: usize, across: usize| {
        let (mut sum, mut pairs) = (0.0, 0.0);
        for i in members() {
            let next = i + step;
            let in_photograph = next < rests.len() && i % crossings.ends + across < crossings.ends;
            if !in_photograph || classes.of[next] != class {
                continue;
            }
            if let (Some(one), Some(other)) = (&rests[i], &rests[next]) {
                let product: f32 = one.parts.iter().zip(other.parts).map(|(a, b)| a * b).sum();
                sum += f64::from(product);
                pairs += 1.0;
            }
        }
        (sum / f64::max(pairs, 1.0) / (power + 1e-9), pairs)
    };
    let (along_warp, down) = alike(picks * crossings.ends, 0);
    let (along_weft, right) = alike(ends, ends);
    // Some six of the parts of a patch are independent.
    let error = |pairs: f64| 1.0 / (6.0 * f64::max(pairs, 0.5));
    (along_warp - along_weft, error(down) + error(right))
}
