//! The repeat of the weave: which crossings look alike.
//!
//! A weave repeats over a lattice of crossings; those a lattice step apart look alike and fall into one
//! class. Every lattice with few classes is tried: the means of the classes in one block of crossings
//! are multiplied with those in a block that shares no yarn with it. What yarns have of their own
//! cancels on the average, what the weave makes stays. Blocks are small and near each other, so that a
//! yarn lost on the way does little harm.

use rayon::prelude::*;

use super::crossings::{Crossings, FEATURES, weights};

/// The most classes of a repeat that is looked for.
const MOST_CLASSES: usize = 32;
/// The most of which every lattice is tried. Of those with more, only the ones of herringbones and the
/// like, in rectangles or shifted by half.
const MOST_OF_ANY_LATTICE: usize = 16;
/// Crossings along a side of a block, if there are enough.
const BLOCK: usize = 9;
/// The most crossings that lattices are tried on.
const MOST_TRIED: usize = 15_000;
/// Features that are independent of each other, about.
const INDEPENDENT: f64 = 5.0;
/// How far what a repeat explains must lie above what chance makes, in standard errors: so much, and so
/// much more for every class, for there are the more repeats to choose from.
const LEAST_CERTAINTY: f64 = 3.5;
const CERTAINTY_PER_CLASS: f64 = 0.25;
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
            .filter(move |lattice| {
                classes <= MOST_OF_ANY_LATTICE || lattice.b == 0 || 2 * lattice.b == lattice.a
            })
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
    fn certainty(self) -> f64 {
        self.share / self.error
    }

    /// Whether this can hardly be chance.
    pub fn is_certain(self) -> bool {
        let least = LEAST_CERTAINTY + CERTAINTY_PER_CLASS * self.lattice.classes() as f64;
        self.share > LEAST_EXPLAINED && self.certainty() > least
    }
}

/// The repeat that explains the crossings best with as few classes as it takes.
pub fn find(crossings: &Crossings, features: &[[f32; FEATURES]]) -> Option<Explained> {
    let blocks = Blocks::of(crossings);
    let lattices: Vec<Lattice> = (2..=MOST_CLASSES).flat_map(Lattice::all).collect();
    let tried: Vec<[Explained; 2]> = lattices
        .par_iter()
        .filter_map(|lattice| blocks.explained(crossings, features, *lattice))
        .collect();
    let best = |k: usize| {
        let of = tried.iter().map(|explained| explained[k]);
        of.max_by(|a, b| a.share.total_cmp(&b.share))
    };
    let k = usize::from(best(1)?.certainty() > best(0)?.certainty());
    let best = best(k)?;
    let tried = || tried.iter().map(|explained| explained[k]);
    // Lattices come in the order of their classes. A coarser part of the true one explains less, a
    // finer one as much, and of so many some a little more by chance.
    let nearly = |one: &Explained| {
        let apart = best.share - one.share;
        let error = libm::sqrt(one.error * one.error + best.error * best.error);
        one.share > 0.85 * best.share || (one.share > 0.4 * best.share && apart < 3.5 * error)
    };
    let classes = tried().find(nearly)?.lattice.classes();
    tried()
        .filter(|one| one.lattice.classes() == classes)
        .max_by(|a, b| a.share.total_cmp(&b.share))
}

/// How well one lattice explains the crossings.
pub fn explained(
    crossings: &Crossings,
    features: &[[f32; FEATURES]],
    lattice: Lattice,
) -> Option<Explained> {
    let explained = Blocks::of(crossings).explained(crossings, features, lattice)?;
    explained
        .into_iter()
        .max_by(|a, b| a.certainty().total_cmp(&b.certainty()))
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
    ) -> Option<[Explained; 2]> {
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
        let cells: Vec<f64> = counts
            .chunks_exact(classes)
            .zip(&good)
            .map(|(counts, good)| {
                if *good {
                    counts.iter().sum::<usize>() as f64
                } else {
                    0.0
                }
            })
            .collect();
        let weighted: Vec<f64> = means
            .iter()
            .enumerate()
            .flat_map(|(k, mean)| {
                let weight = cells[k / classes];
                mean.iter().map(move |value| weight * f64::from(*value))
            })
            .collect();
        Some([
            self.near(&weighted, &cells, lattice)?,
            self.all(&weighted, &cells, lattice)?,
        ])
    }

    /// From blocks that touch at a corner: whatever slips, hardly slips there.
    fn near(&self, weighted: &[f64], cells: &[f64], lattice: Lattice) -> Option<Explained> {
        let per_block = weighted.len() / cells.len();
        let classes = lattice.classes() as f64;
        let of = |block: usize| &weighted[block * per_block..][..per_block];
        let mut pairs = Vec::new();
        for y in 0..self.count.1 - 1 {
            for x in 0..self.count.0 - 1 {
                let at = |i: usize, j: usize| (y + j) * self.count.0 + x + i;
                for (one, other) in [(at(0, 0), at(1, 1)), (at(1, 0), at(0, 1))] {
                    let product: f64 = of(one).iter().zip(of(other)).map(|(a, b)| a * b).sum();
                    pairs.push((
                        cells[one] * cells[other],
                        product / (classes * weight_of_features()),
                    ));
                }
            }
        }
        let weight: f64 = pairs.iter().map(|(weight, _)| weight).sum();
        if weight <= 0.0 {
            return None;
        }
        let share = pairs.iter().map(|(_, product)| product).sum::<f64>() / weight;
        let spread = pairs.iter().map(|(weight, product)| {
            let apart = product - weight * share;
            apart * apart
        });
        let spread = libm::sqrt(spread.sum::<f64>()) / weight;
        // With few blocks their spread says little; then what chance makes of such means counts.
        let chance = chance(lattice, weight);
        Some(Explained {
            lattice,
            share,
            error: spread.max(chance),
        })
    }

    /// From all blocks that share no yarn: the most certain if nothing slips.
    fn all(&self, weighted: &[f64], cells: &[f64], lattice: Lattice) -> Option<Explained> {
        let (nx, ny) = self.count;
        let share = |left_out: &dyn Fn(usize, usize) -> bool| {
            let (product, weight) = self.products(weighted, cells, lattice, left_out);
            (weight > 0.0).then(|| product / weight)
        };
        let all = share(&|_, _| false)?;
        // How much it hangs on single yarns: the jackknife, over columns and over rows of blocks.
        let spread = |shares: Vec<f64>| {
            let n = shares.len() as f64;
            let mean = shares.iter().sum::<f64>() / n;
            let squares = shares.iter().map(|share| (share - mean) * (share - mean));
            squares.sum::<f64>() * (n - 1.0) / n
        };
        let columns = (0..nx)
            .map(|x| share(&|i, _| i == x))
            .collect::<Option<_>>()?;
        let rows = (0..ny)
            .map(|y| share(&|_, j| j == y))
            .collect::<Option<_>>()?;
        let (_, weight) = self.products(weighted, cells, lattice, &|_, _| false);
        let chance = chance(lattice, 0.5 * weight);
        Some(Explained {
            lattice,
            share: all,
            error: libm::sqrt(spread(columns) + spread(rows)).max(chance),
        })
    }

    /// The products of the means of all pairs of blocks that share neither row nor column, and of their
    /// sizes, without the blocks that are left out; each pair twice.
    fn products(
        &self,
        weighted: &[f64],
        cells: &[f64],
        lattice: Lattice,
        left_out: &dyn Fn(usize, usize) -> bool,
    ) -> (f64, f64) {
        let (nx, ny) = self.count;
        let per_block = weighted.len() / cells.len();
        // All pairs, less those in one row, less those in one column, and each with itself once again.
        let mut sums = vec![vec![0.0; per_block + 1]; 1 + nx + ny];
        let mut own = (0.0, 0.0);
        for block in 0..nx * ny {
            let (x, y) = (block % nx, block / nx);
            if left_out(x, y) {
                continue;
            }
            let values = &weighted[block * per_block..][..per_block];
            for sum in [0, 1 + x, 1 + nx + y] {
                for (sum, value) in sums[sum].iter_mut().zip(values) {
                    *sum += value;
                }
                sums[sum][per_block] += cells[block];
            }
            own.0 += values.iter().map(|value| value * value).sum::<f64>();
            own.1 += cells[block] * cells[block];
        }
        for (k, sum) in sums.iter().enumerate() {
            let sign = if k == 0 { 1.0 } else { -1.0 };
            let (weight, values) = (sum[per_block], &sum[..per_block]);
            own.0 += sign * values.iter().map(|value| value * value).sum::<f64>();
            own.1 += sign * weight * weight;
        }
        (
            own.0 / (lattice.classes() as f64 * weight_of_features()),
            own.1,
        )
    }
}

/// The variance of all features together.
fn weight_of_features() -> f64 {
    weights()
        .iter()
        .map(|weight| f64::from(weight * weight))
        .sum()
}

/// The standard error by chance of products of means, of blocks whose products of sizes sum to `weight`.
fn chance(lattice: Lattice, weight: f64) -> f64 {
    let classes = lattice.classes() as f64;
    classes / libm::sqrt(weight * classes * INDEPENDENT)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lattice_step_leads_to_the_same_class() {
        for classes in 2..=20 {
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
