//! The growth of cracks, one after the other.

use super::course::{Course, STEP, about_normal, between, turned};
use super::crumple::Crumple;
use super::field::{Field, Nearest, ahead};
use super::{Crack, CrackleSpec, End, Network, Point};
use crate::chance::{Chance, Purpose, Sequence};
use crate::pattern::Raster;

/// A crack that comes as near as this to another one, or to an edge, is there.
const THERE: f32 = 0.8;
/// Places that are looked at before a crack begins at the one under most tension.
const CANDIDATES: usize = 4;
/// The least tension that breaks wax: distance to what is open over the width of a mesh there.
const BREAKS: f32 = 0.14;
/// So many places in a row where nothing breaks: the wax holds.
const GIVE_UP: usize = 400;
/// The share of later cracks that run out in whole wax.
const TIPS: f64 = 0.12;
/// The share of folds with another one close beside.
const COMPANIONS: f64 = 0.4;

/// Breaks the wax.
pub(super) fn network(
    drawing: &Raster,
    spec: &CrackleSpec,
    crumpled: Option<&Raster>,
    chance: Chance,
) -> Network {
    let mut network = Network::default();
    if drawing.nx == 0 || drawing.ny == 0 || spec.density <= 0.0 {
        return network;
    }
    let field = Field::new(drawing);
    let most = spec.density * field.waxed() as f64;
    let mut growth = Growth {
        field,
        spec,
        chance: chance.sequence(Purpose::Crackle),
        crumple: Crumple::new(spec, crumpled, chance),
        mesh: (2.0 / spec.density) as f32,
    };
    let mut grown = 0.0;
    let mut in_vain = 0;
    while grown < most && in_vain < GIVE_UP {
        let Some(start) = growth.place_to_break() else {
            in_vain += 1;
            continue;
        };
        let pieces = if grown < spec.folds * most {
            growth.folds(start)
        } else {
            vec![growth.crack(start, &network)]
        };
        let before = grown;
        for piece in pieces.into_iter().filter(|piece| piece.line.len() > 1) {
            growth.field.add(network.cracks.len(), &piece.line);
            grown += piece.length();
            network.cracks.push(piece);
        }
        in_vain = if grown > before { 0 } else { in_vain + 1 };
    }
    network
}

struct Growth<'a> {
    field: Field,
    spec: &'a CrackleSpec,
    chance: Sequence,
    crumple: Crumple<'a>,
    /// Cells across a mesh of cracks.
    mesh: f32,
}

impl Growth<'_> {
    fn between(&mut self, least: f64, most: f64) -> f32 {
        between(&mut self.chance, least, most)
    }

    fn normal(&mut self) -> f32 {
        about_normal(&mut self.chance)
    }

    /// The place under most tension among a few of chance.
    fn place_to_break(&mut self) -> Option<Point> {
        let (nx, ny) = (self.field.nx as f64, self.field.ny as f64);
        let mut best = None;
        let mut most = BREAKS;
        for _ in 0..CANDIDATES {
            let at = [self.between(0.0, nx), self.between(0.0, ny)];
            let distance = self.field.distance(at);
            let tension = distance / self.mesh * self.crumple.at(at);
            if distance > 1.5 && tension > most {
                most = tension;
                best = Some(at);
            }
        }
        best
    }

    /// A fold, and now and then a finer one close beside it.
    fn folds(&mut self, start: Point) -> Vec<Crack> {
        let heading = self.fold_heading();
        let mut cracks = self.fold(start, heading, 0);
        if self.chance.unit() < COMPANIONS {
            let aside = [-heading[1], heading[0]];
            let beside = ahead(start, aside, self.between(0.06, 0.3) * self.mesh);
            if self.field.holds(beside) && self.field.distance(beside) > 0.0 {
                let heading = turned(heading, 0.06 * self.normal());
                cracks.extend(self.fold(beside, heading, 1));
            }
        }
        cracks
    }

    /// A long crack through everything, in pieces of wax.
    fn fold(&mut self, start: Point, heading: Point, generation: u32) -> Vec<Crack> {
        let width = self.width(generation);
        let depth = self.depth(generation);
        let mut pieces = Vec::new();
        let mut first = self.run_fold(start, heading);
        let mut second = self.run_fold(start, [-heading[0], -heading[1]]);
        // Both begin in the same wax: their first pieces are one.
        let (mut middle, middle_end) = first.remove(0);
        let (other, other_end) = second.remove(0);
        middle.reverse();
        middle.extend(other.into_iter().skip(1));
        pieces.push((middle, [middle_end, other_end]));
        for (line, end) in first.into_iter().chain(second) {
            pieces.push((line, [End::Open, end]));
        }
        pieces
            .into_iter()
            .map(|(line, ends)| Crack {
                line,
                ends,
                generation,
                width,
                depth,
            })
            .collect()
    }

    fn fold_heading(&mut self) -> Point {
        let angle = match self.spec.direction {
            Some(degrees) => {
                // Folded cloth is often folded again across.
                let across = if self.chance.unit() < 0.15 { 90.0 } else { 0.0 };
                degrees as f32 + across + 14.0 * self.normal()
            }
            None => self.between(0.0, 360.0),
        };
        let angle = angle.to_radians();
        [libm::cosf(angle), libm::sinf(angle)]
    }

    /// One way of a fold: the pieces of wax it breaks, each with where it ends.
    fn run_fold(&mut self, start: Point, heading: Point) -> Vec<(Vec<Point>, End)> {
        let mut pieces = Vec::new();
        let mut line = vec![start];
        let mut course = Course::new(start, heading);
        // Crossing what was met: not met again until left behind.
        let mut crossing = false;
        let mut open = 0.0;
        let longest = 2 * (self.field.nx + self.field.ny);
        for _ in 0..longest {
            course.stray(0.35 * self.spec.jitter as f32, &mut self.chance);
            course.at = ahead(course.at, course.heading, STEP);
            if !self.field.holds(course.at) {
                if !line.is_empty() {
                    line.push(course.at);
                    pieces.push((line, End::Border));
                    return pieces;
                }
                break;
            }
            let distance = self.field.distance(course.at);
            let nearest = self.field.nearest(course.at);
            if line.is_empty() {
                // In the open, on the way to more wax.
                open += STEP;
                if distance > 0.0 {
                    line.push(ahead(course.at, course.heading, -STEP));
                    line.push(course.at);
                    open = 0.0;
                } else if open > 2.0 * self.mesh {
                    break;
                }
                continue;
            }
            line.push(course.at);
            match nearest {
                Nearest::Open if distance <= 0.0 => {
                    pieces.push((std::mem::take(&mut line), End::Open));
                }
                Nearest::Crack(crack, at) if distance < THERE && !crossing => {
                    if self.chance.unit() < 0.4 {
                        line.push(at);
                        pieces.push((line, End::Crack(crack)));
                        return pieces;
                    }
                    crossing = true;
                }
                _ => crossing &= distance < 4.0 * THERE,
            }
        }
        if !line.is_empty() {
            pieces.push((line, End::Tip));
        }
        pieces
    }

    /// A later crack: across the mesh that it begins in.
    fn crack(&mut self, start: Point, so_far: &Network) -> Crack {
        let uphill = self.field.uphill(start);
        let heading = if uphill == [0.0, 0.0] {
            self.fold_heading()
        } else {
            turned(uphill, 0.35 * self.normal())
        };
        let runs_out = self.chance.unit() < TIPS;
        let (first, first_end) = self.run(start, [-heading[0], -heading[1]], f32::INFINITY);
        let reach = if runs_out {
            self.between(0.2, 0.7) * self.mesh
        } else {
            f32::INFINITY
        };
        let (second, second_end) = self.run(start, heading, reach);
        let mut line = first;
        line.reverse();
        line.extend(second.into_iter().skip(1));
        let ends = [first_end, second_end];
        let of = |end: End| match end {
            End::Crack(crack) => so_far.cracks[crack].generation,
            _ => 0,
        };
        let generation = 1 + of(first_end).max(of(second_end));
        let (width, depth) = (self.width(generation), self.depth(generation));
        Crack {
            line,
            ends,
            generation,
            width,
            depth,
        }
    }

    /// One way of a crack, for `reach` cells at most.
    fn run(&mut self, start: Point, heading: Point, reach: f32) -> (Vec<Point>, End) {
        let mut line = vec![start];
        let mut course = Course::new(start, heading);
        let longest = reach.min((2 * (self.field.nx + self.field.ny)) as f32);
        let mut run = 0.0;
        while run < longest {
            let distance = self.field.distance(course.at);
            course.steer(self.field.uphill(course.at), distance);
            course.stray(self.spec.jitter as f32, &mut self.chance);
            let step = STEP.min(distance.max(0.5));
            course.at = ahead(course.at, course.heading, step);
            run += step;
            line.push(course.at);
            if !self.field.holds(course.at) {
                return (line, End::Border);
            }
            let distance = self.field.distance(course.at);
            match self.field.nearest(course.at) {
                Nearest::Crack(crack, at) if distance < THERE => {
                    line.push(at);
                    return (line, End::Crack(crack));
                }
                Nearest::Open if distance <= 0.0 => return (line, End::Open),
                _ => {}
            }
        }
        (line, End::Tip)
    }

    fn width(&mut self, generation: u32) -> f32 {
        let thinner = (0..generation.min(12)).fold(1.0, |w, _| w * self.spec.thinning);
        (self.spec.width * thinner) as f32 * self.between(0.65, 1.35)
    }

    fn depth(&mut self, generation: u32) -> f32 {
        let least = 0.75 - 0.08 * f64::from(generation.min(6));
        self.between(least, 1.0)
    }
}
