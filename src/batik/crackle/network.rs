//! Cracks as lines, and what they are connected to.

use super::Point;

/// Where a crack ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// At the edge of an open area.
    Open,
    /// On an earlier crack, by its number.
    Crack(usize),
    /// At the edge of the cloth.
    Border,
    /// In whole wax, running out.
    Tip,
}

/// One crack.
#[derive(Debug, Clone, PartialEq)]
pub struct Crack {
    /// Its course, in points about a cell apart.
    pub line: Vec<Point>,
    /// Where its first and its last point lie.
    pub ends: [End; 2],
    /// 0 for folds; for other cracks one more than what they end on.
    pub generation: u32,
    /// Width in its middle, cells.
    pub width: f32,
    /// How far the wax is broken through, 0 to 1.
    pub depth: f32,
}

impl Crack {
    /// Length of its course, cells.
    pub fn length(&self) -> f64 {
        let step = |pair: &[Point]| {
            let (dx, dy) = (pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]);
            f64::from((dx * dx + dy * dy).sqrt())
        };
        self.line.windows(2).map(step).sum()
    }
}

/// All cracks of a cloth, in the order in which they broke.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Network {
    /// The cracks; an [`End::Crack`] counts in them.
    pub cracks: Vec<Crack>,
}

impl Network {
    /// Length of all cracks, cells.
    pub fn length(&self) -> f64 {
        self.cracks.iter().map(Crack::length).sum()
    }

    /// For every crack, whether dye can reach it: through an open area or the edge of the cloth,
    /// itself or by way of the cracks that it is connected with.
    pub fn reached(&self) -> Vec<bool> {
        let mut beside: Vec<Vec<usize>> = vec![Vec::new(); self.cracks.len()];
        let mut reached = vec![false; self.cracks.len()];
        let mut waiting = Vec::new();
        for (i, crack) in self.cracks.iter().enumerate() {
            for end in crack.ends {
                match end {
                    End::Open | End::Border => {
                        if !reached[i] {
                            reached[i] = true;
                            waiting.push(i);
                        }
                    }
                    End::Crack(j) => {
                        beside[i].push(j);
                        beside[j].push(i);
                    }
                    End::Tip => {}
                }
            }
        }
        while let Some(i) = waiting.pop() {
            for j in &beside[i] {
                if !reached[*j] {
                    reached[*j] = true;
                    waiting.push(*j);
                }
            }
        }
        reached
    }
}
