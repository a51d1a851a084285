//! The repeat of the weave: which crossings look alike.
//!
//! A weave repeats over a lattice of crossings; those a lattice step apart look alike and fall into one
//! class. Every lattice with few classes is tried: the means of the classes in one block of crossings
//! are multiplied with those in a block that shares no yarn with it. What yarns have of their own
//! cancels on the average, what the weave makes stays. Blocks are small and near each other, so that a
//! yarn lost on the way does little harm.

use rayon::prelude::*;

use super::crossings::{Crossings, FEATURES};

/// The most classes of a repeat that is looked for.
pub const MOST_CLASSES: usize = 16;
/// Crossings along a side of a block, if there are enough.
const BLOCK: usize = 9;
/// The most crossings that lattices are tried on.
const MOST_TRIED: usize = 30_000;
/// Features that are independent of each other, about.
const INDEPENDENT: f64 = 10.0;
/// How far what a repeat explains must lie above what chance makes, in standard errors.
const LEAST_CERTAINTY: f64 = 6.0;
/// How much of all variance a repeat must explain.
const LEAST_EXPLAINED: f64 = 0.006;

/// Steps from a crossing to others alike: `(a, 0)` and `(b, c)`, in ends and picks, 0 ≤ b < a. It has
/// a·c classes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Lattice {
    /// Ends to the next alike in the same pick.
    pub a: usize,
    /// Ends to one alike `c` picks down.
    pub b: usize,
    /// Picks to the next row that has one alike in a line.
    pub c: usize,
}

impl Lattice {
    /// Crossings that differ.
    pub fn classes(self) -> usize {
        self.a * self.c
    }

    /// The class of the crossing of end `e` and pick `p`.
    #[inline]
    pub fn class(self, e: usize, p: usize) -> usize {
        let shift = p / self.c * self.b % self.a;
        p % self.c * self.a + (e + self.a - shift) % self.a
    }

    /// The class that lies `(de, dp)` from every class.
    pub fn moved(self, de: usize, dp: usize) -> Vec<usize> {
        let mut moved = vec![0; self.classes()];
        for p in 0..self.c {
            for e in 0..self.a {
                moved[self.class(e, p)] = self.class(e + de, p + dp);
            }
        }
        moved
    }

    /// Ends and picks of the smallest rectangle that repeats.
    pub fn repeat(self) -> (usize, usize) {
        let rows = if self.b == 0 {
            1
        } else {
            self.a / gcd(self.a, self.b)
        };
        (self.a, self.c * rows)
    }

    /// Every lattice with this many classes on which a cloth holds together: not all ends alike, nor
    /// all picks.
    fn all(classes: usize) -> impl Iterator<Item = Lattice> {
        (2..=classes)
            .filter(move |a| classes.is_multiple_of(*a))
            .flat_map(move |a| {
                let c = classes / a;
                (0..a).map(move |b| Lattice { a, b, c })
            })
            .filter(|lattice| lattice.c > 1 || lattice.b > 0)
    }
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// How well a lattice explains the crossings.
#[derive(Debug, Clone, Copy)]
pub struct Explained {
    /// The lattice.
    pub lattice: Lattice,
    /// Share of the variance of features, without what chance adds.
    pub share: f64,
    /// Its standard error.
    pub error: f64,
}

impl Explained {
    /// Whether this can hardly be chance.
    pub fn is_certain(self) -> bool {
        self.share > LEAST_EXPLAINED && self.share > LEAST_CERTAINTY * self.error
    }
}

/// The repeat that explains the crossings best with as few classes as it takes.
pub fn find(crossings: &Crossings, features: &[[f32; FEATURES]]) -> Option<Explained> {
    let blocks = Blocks::of(crossings);
    let lattices: Vec<Lattice> = (2..=MOST_CLASSES).flat_map(Lattice::all).collect();
    let tried: Vec<Explained> = lattices
        .par_iter()
        .filter_map(|lattice| blocks.explained(crossings, features, *lattice))
        .collect();
    let best = *tried.iter().max_by(|a, b| a.share.total_cmp(&b.share))?;
    // Lattices come in the order of their classes. A coarser part of the true one explains less, a
    // finer one as much, and a little more or less by chance.
    let nearly = |one: &Explained| {
        let apart = best.share - one.share;
        let error = libm::sqrt(one.error * one.error + best.error * best.error);
        one.share > 0.85 * best.share || (one.share > 0.5 * best.share && apart < 2.5 * error)
    };
    let classes = tried.iter().find(|one| nearly(one))?.lattice.classes();
    tried
        .into_iter()
        .filter(|one| one.lattice.classes() == classes)
        .max_by(|a, b| a.share.total_cmp(&b.share))
}

/// How well one lattice explains the crossings.
pub fn explained(
    crossings: &Crossings,
    features: &[[f32; FEATURES]],
    lattice: Lattice,
) -> Option<Explained> {
    Blocks::of(crossings).explained(crossings, features, lattice)
}

/// The middle part of the crossings, in blocks.
struct Blocks {
    first: (usize, usize),
    size: (usize, usize),
    /// Blocks across and down.
    count: (usize, usize),
}

impl Blocks {
    fn of(crossings: &Crossings) -> Self {
        let (ends, picks) = (crossings.ends, crossings.picks);
        let all = (ends * picks) as f64;
        let cut = libm::sqrt((MOST_TRIED as f64 / all).min(1.0));
        let size = (
            ((ends as f64 * cut) as usize).max(4).min(ends),
            ((picks as f64 * cut) as usize).max(4).min(picks),
        );
        let count = |n: usize| {
            if n >= 3 * BLOCK {
                n / BLOCK
            } else {
                (n / 4).clamp(2, 3)
            }
        };
        Blocks {
            first: ((ends - size.0) / 2, (picks - size.1) / 2),
            size,
            count: (count(size.0), count(size.1)),
        }
    }

    fn explained(
        &self,
        crossings: &Crossings,
        features: &[[f32; FEATURES]],
        lattice: Lattice,
    ) -> Option<Explained> {
        let classes = lattice.classes();
        let blocks = self.count.0 * self.count.1;
        let mut means = vec![[0.0_f32; FEATURES]; blocks * classes];
        let mut counts = vec![0_usize; blocks * classes];
        for j in 0..self.size.1 {
            for i in 0..self.size.0 {
                let (e, p) = (self.first.0 + i, self.first.1 + j);
                let crossing = p * crossings.ends + e;
                if !crossings.whole[crossing] {
                    continue;
                }
                let (x, y) = (
                    i * self.count.0 / self.size.0,
                    j * self.count.1 / self.size.1,
                );
                let k = (y * self.count.0 + x) * classes + lattice.class(e, p);
                counts[k] += 1;
                for (mean, value) in means[k].iter_mut().zip(features[crossing]) {
                    *mean += value;
                }
            }
        }
        let mut good = vec![true; blocks];
        for (block, (means, counts)) in means
            .chunks_exact_mut(classes)
            .zip(counts.chunks_exact(classes))
            .enumerate()
        {
            good[block] = counts.iter().all(|count| *count >= 2);
            let mut middle = [0.0; FEATURES];
            for (mean, count) in means.iter_mut().zip(counts) {
                for (mean, middle) in mean.iter_mut().zip(&mut middle) {
                    *mean /= (*count).max(1) as f32;
                    *middle += *mean / classes as f32;
                }
            }
            for mean in means {
                for (mean, middle) in mean.iter_mut().zip(middle) {
                    *mean -= middle;
                }
            }
        }
        let mut products = Vec::new();
        let mut chance = 0.0;
        for y in 0..self.count.1 - 1 {
            for x in 0..self.count.0 - 1 {
                let at = |i: usize, j: usize| (y + j) * self.count.0 + x + i;
                for (one, other) in [(at(0, 0), at(1, 1)), (at(1, 0), at(0, 1))] {
                    if !good[one] || !good[other] {
                        continue;
                    }
                    let of = |block: usize| &means[block * classes..][..classes];
                    let product: f64 = of(one)
                        .iter()
                        .zip(of(other))
                        .map(|(a, b)| a.iter().zip(b).map(|(a, b)| f64::from(a * b)).sum::<f64>())
                        .sum();
                    products.push(product / (classes * FEATURES) as f64);
                    let each = counts[one * classes..][..classes].iter().sum::<usize>();
                    chance += classes as f64 / each as f64;
                }
            }
        }
        let n = products.len() as f64;
        if products.is_empty() {
            return None;
        }
        let share = products.iter().sum::<f64>() / n;
        let variance = products
            .iter()
            .map(|p| (p - share) * (p - share))
            .sum::<f64>()
            / n;
        // With few blocks their spread says little; then what chance makes of such means counts.
        let chance = chance / n / libm::sqrt(classes as f64 * INDEPENDENT);
        Some(Explained {
            lattice,
            share,
            error: libm::sqrt(variance.max(chance * chance) / n),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lattice_step_leads_to_the_same_class() {
        for classes in 2..=12 {
            for lattice in Lattice::all(classes) {
                for p in 0..20 {
                    for e in 0..20 {
                        let here = lattice.class(e, p);
                        assert!(here < classes);
                        assert_eq!(here, lattice.class(e + lattice.a, p));
                        assert_eq!(here, lattice.class(e + lattice.b, p + lattice.c));
                    }
                }
            }
        }
    }

    #[test]
    fn moving_twice_is_moving_once_by_both() {
        for lattice in Lattice::all(8) {
            let (once, twice) = (lattice.moved(1, 2), lattice.moved(2, 4));
            assert!((0..8).all(|class| once[once[class]] == twice[class]));
        }
    }

    #[test]
    fn the_repeat_of_a_satin_of_five_is_five_by_five() {
        assert_eq!(Lattice { a: 5, b: 2, c: 1 }.repeat(), (5, 5));
        assert_eq!(Lattice { a: 2, b: 1, c: 1 }.repeat(), (2, 2));
        assert_eq!(Lattice { a: 4, b: 2, c: 2 }.repeat(), (4, 4));
    }
}
