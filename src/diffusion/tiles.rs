//! Many stages in one pass through memory.
//!
//! A stage of the whole cloth reads and writes far more than the processor's own caches hold. But a
//! row of one stage needs only three rows of the stage before. So the cloth is cut into tiles of
//! rows, and within a tile the stages follow each other row by row like a wave: stage 1 of row y,
//! stage 2 of row y − 1, … The [`WAVE`] stages of a wave work on rows that are still in the cache of
//! their core; and a tile is small enough that the large cache keeps it for several waves.
//!
//! At its edges a tile cannot go on alone, and computes one row less in every stage; the wedges that
//! are left between tiles follow in a second round. Wide cloth is taken strip by strip, each
//! leaning one block to the left in every stage. Every row is computed once and from the same
//! numbers whatever the tiles, the strips and the threads, so they do not change a single bit.

use std::ops::Range;

use rayon::prelude::*;

use super::kernel::{Row, Southwards, Take};
use super::lanes::{Cells, Lanes, Ways};
use super::passage::Passage;

/// Stages of a wave.
const WAVE: usize = 16;

/// Blocks in a strip: with [`WAVE`] stages they fill about a megabyte.
const STRIP: usize = 64;

/// Rows of a tile that goes through [`LONG`] stages.
const HIGH: usize = 150;
const LONG: usize = 3 * WAVE;

/// The values of one stage.
pub struct Level<'a> {
    /// Change of concentration, or concentration, row by row.
    pub free: &'a mut [Cells],
    /// Change of bound dye; empty where none binds.
    pub bound: &'a mut [Cells],
    /// What flowed into each of the held cells.
    pub held: &'a mut [f64],
    /// What baths gave to each block and took from it; empty where there are none.
    pub brought: &'a mut [[f64; 2]],
}

/// Rows of two stages that follow each other.
pub struct Rows<'a> {
    /// The first row of these.
    pub top: usize,
    /// The levels of even and of odd stages.
    pub levels: [Level<'a>; 2],
}

/// What is done with each row of each stage.
pub trait Work: Sync {
    /// Blocks in a row.
    fn blocks(&self) -> usize;

    /// Rows in all.
    fn rows(&self) -> usize;

    /// Held cells above a row.
    fn held_above(&self, y: usize) -> usize;

    /// Computes `blocks` of row `y` for one stage, from `from` into `into`.
    fn row(&self, task: Task, from: &Level, into: &mut Level);
}

/// One row of one stage.
pub struct Task<'a> {
    /// The stage, from 0.
    pub stage: usize,
    /// The row of the cloth.
    pub y: usize,
    /// The first row that the levels hold.
    pub top: usize,
    /// Which blocks.
    pub blocks: Range<usize>,
    /// Whether this is the first row of its stage: `south` must be found anew.
    pub first: bool,
    /// What flows south between rows of this stage.
    pub south: &'a mut [Cells],
    /// Room for a row.
    pub spare: &'a mut [Cells],
}

/// Does `stages` stages of work. The first reads `levels[0]` and writes `levels[1]`, the second the
/// other way round, and so on.
pub fn pass(work: &impl Work, stages: usize, levels: [Level; 2]) {
    let rows = work.rows();
    let threads = rayon::current_num_threads();
    // High tiles need less memory traffic, but there must be enough of them for all cores. Every tile
    // needs room for its two slopes.
    let (tiles, at_once) = match rows / HIGH {
        high if high >= 2 * threads => (high, LONG),
        _ => ((rows / (2 * WAVE + 2)).clamp(1, 4 * threads), WAVE),
    };
    let mut whole = Rows { top: 0, levels };
    for first in (0..stages).step_by(at_once) {
        let now = first..stages.min(first + at_once);
        in_tiles(work, now, tiles, whole.again());
    }
}

/// Does some stages in so many tiles.
fn in_tiles(work: &impl Work, stages: Range<usize>, tiles: usize, mut whole: Rows) {
    let rows = work.rows();
    let bounds: Vec<usize> = (0..=tiles).map(|i| i * rows / tiles).collect();
    let middles: Vec<usize> = bounds.windows(2).map(|b| (b[0] + b[1]) / 2).collect();
    split(work, whole.again(), &bounds)
        .into_par_iter()
        .zip(bounds.par_windows(2))
        .for_each(|(tile, ends)| {
            sweep(work, stages.clone(), tile, |done| {
                let top = if ends[0] == 0 { 0 } else { ends[0] + done };
                let end = if ends[1] == rows {
                    rows
                } else {
                    ends[1] - done
                };
                top..end
            });
        });
    // The wedges: between the middles of neighbouring tiles.
    let mut cuts = vec![0];
    cuts.extend(&middles);
    cuts.push(rows);
    split(work, whole, &cuts)
        .into_par_iter()
        .enumerate()
        .filter(|(i, _)| (1..tiles).contains(i))
        .for_each(|(i, tile)| {
            sweep(work, stages.clone(), tile, |done| {
                bounds[i] - done..bounds[i] + done
            });
        });
}

/// Does the stages of one tile; `range` gives the rows that a stage computes, from how many are done
/// when it is.
fn sweep(
    work: &impl Work,
    stages: Range<usize>,
    rows: Rows,
    range: impl Fn(usize) -> Range<usize>,
) {
    let blocks = work.blocks();
    let Rows {
        top,
        levels: [mut even, mut odd],
    } = rows;
    let end = top + even.free.len() / blocks;
    let mut south = vec![Cells::ZERO; WAVE.min(stages.len()) * blocks];
    let mut spare = vec![Cells::ZERO; blocks];
    let strips = blocks.div_ceil(STRIP);
    let width = blocks.div_ceil(strips);
    for strip in 0..strips {
        for first in stages.clone().step_by(WAVE) {
            let wave = first..stages.end.min(first + WAVE);
            for front in top..end + wave.len() {
                for (behind, stage) in wave.clone().enumerate() {
                    let Some(y) = front.checked_sub(behind) else {
                        continue;
                    };
                    let done = stage + 1 - stages.start;
                    let range = range(done);
                    let left = (strip * width).saturating_sub(done);
                    let right = if strip + 1 == strips {
                        blocks
                    } else {
                        ((strip + 1) * width).saturating_sub(done)
                    };
                    if !range.contains(&y) || left >= right {
                        continue;
                    }
                    let task = Task {
                        stage,
                        y,
                        top,
                        blocks: left..right,
                        first: y == range.start,
                        south: &mut south[behind * blocks..][..blocks],
                        spare: &mut spare,
                    };
                    if stage % 2 == 0 {
                        work.row(task, &even, &mut odd);
                    } else {
                        work.row(task, &odd, &mut even);
                    }
                }
            }
        }
    }
}

/// Lets dye flow in the row of a task, through the row's faces and from the rows beside it in
/// `free`, which holds the rows of the tile.
pub fn flow<P: Passage>(
    passage: P,
    lanes: Lanes,
    ways: &[Ways],
    task: &mut Task,
    free: &[Cells],
    take: impl Take,
) {
    let row = |y: usize| y * lanes.blocks..(y + 1) * lanes.blocks;
    let free = |y: usize| &free[row(y - task.top)];
    let blocks = task.blocks.clone();
    if task.first {
        match task.y.checked_sub(1) {
            None => task.south[blocks.clone()].fill(Cells::ZERO),
            Some(above) => Southwards {
                passage,
                here: free(above),
                below: free(task.y),
                ways: &ways[row(above)],
                south: &mut *task.south,
                blocks: blocks.clone(),
            }
            .compute(),
        }
    }
    Row {
        passage,
        here: free(task.y),
        below: free((task.y + 1).min(lanes.grid.ny - 1)),
        ways: &ways[row(task.y)],
        south: &mut *task.south,
        blocks,
        take,
    }
    .compute();
}

impl Rows<'_> {
    /// The same rows for a shorter while.
    fn again(&mut self) -> Rows<'_> {
        Rows {
            top: self.top,
            levels: self.levels.each_mut().map(|level| Level {
                free: level.free,
                bound: level.bound,
                held: level.held,
                brought: level.brought,
            }),
        }
    }
}

/// Cuts rows apart at `cuts`, which begin with the first row and end after the last.
fn split<'a>(work: &impl Work, rows: Rows<'a>, cuts: &[usize]) -> Vec<Rows<'a>> {
    let blocks = work.blocks();
    let [mut even, mut odd] = rows.levels;
    let mut take = |from: usize, to: usize| {
        let held = work.held_above(to) - work.held_above(from);
        [&mut even, &mut odd].map(|level| {
            let cells = (to - from) * blocks;
            let unless_empty = |empty: bool| if empty { 0 } else { cells };
            let bound = unless_empty(level.bound.is_empty());
            let brought = unless_empty(level.brought.is_empty());
            Level {
                free: take_front(&mut level.free, cells),
                bound: take_front(&mut level.bound, bound),
                held: take_front(&mut level.held, held),
                brought: take_front(&mut level.brought, brought),
            }
        })
    };
    let tile = |cut: &[usize]| Rows {
        top: cut[0],
        levels: take(cut[0], cut[1]),
    };
    cuts.windows(2).map(tile).collect()
}

fn take_front<'a, T>(rest: &mut &'a mut [T], len: usize) -> &'a mut [T] {
    let (front, back) = std::mem::take(rest).split_at_mut(len);
    *rest = back;
    front
}
