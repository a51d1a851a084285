//! Patterns as a tree: every part with its own kind and measures.

use bevy_egui::egui::Ui;

use super::mend::LONGEST;
use super::presets;
use super::row::{Pass, row};
use crate::pattern::{Fit, Pattern, Stroke};
use crate::scenario::{BatikStep, Length, Scenario, SupplySpec};

/// The kinds of pattern, in the order in which they are offered.
const KINDS: [&str; 20] = [
    "nothing",
    "everywhere",
    "picture",
    "disc",
    "discs",
    "rectangle",
    "stripes",
    "rings",
    "rays",
    "radial",
    "ramp",
    "clouds",
    "seikaiha",
    "union of",
    "intersection of",
    "one without another",
    "inverse of",
    "blurred",
    "weakened",
    "strokes",
];

/// How deep patterns may lie within each other here.
const DEEPEST: usize = 12;

fn kind(pattern: &Pattern) -> usize {
    match pattern {
        Pattern::Nowhere => 0,
        Pattern::Everywhere => 1,
        Pattern::Image { .. } => 2,
        Pattern::Disc { .. } => 3,
        Pattern::Discs { .. } => 4,
        Pattern::Rectangle { .. } => 5,
        Pattern::Stripes { .. } => 6,
        Pattern::Rings { .. } => 7,
        Pattern::Rays { .. } => 8,
        Pattern::Radial { .. } => 9,
        Pattern::Ramp { .. } => 10,
        Pattern::Noise { .. } => 11,
        Pattern::Seikaiha { .. } => 12,
        Pattern::Union(_) => 13,
        Pattern::Intersection(_) => 14,
        Pattern::Without { .. } => 15,
        Pattern::Invert(_) => 16,
        Pattern::Blur { .. } => 17,
        Pattern::Strength { .. } => 18,
        Pattern::Strokes(_) => 19,
    }
}

/// The kind of a pattern in a word.
pub(super) fn word(pattern: &Pattern) -> &'static str {
    KINDS[kind(pattern)]
}

/// A pattern of another kind: one that is combined of others keeps what was there as its part.
fn of_kind(kind: usize, was: Pattern, (width, height): (f64, f64)) -> Pattern {
    let centre = (0.5, 0.5);
    let across = width.min(height);
    let cells = |share: f64| Length::Cells((share * across).round().max(2.0));
    let mut parts = parts(was).into_iter();
    let mut part = || {
        let plain = || Pattern::Disc {
            diameter: cells(0.4),
            centre,
        };
        Box::new(parts.next().unwrap_or_else(plain))
    };
    match kind {
        0 | 2 => Pattern::Nowhere,
        1 => Pattern::Everywhere,
        3 => Pattern::Disc {
            diameter: cells(0.4),
            centre,
        },
        4 => Pattern::Discs {
            diameter: cells(0.1),
            pitch: cells(0.2),
            staggered: false,
        },
        5 => Pattern::Rectangle {
            size: (cells(0.5), cells(0.5)),
            centre,
        },
        6 => Pattern::Stripes {
            width: cells(0.1),
            gap: cells(0.1),
            offset: Length::Cells(0.0),
            angle: 0.0,
        },
        7 => Pattern::Rings {
            width: cells(0.05),
            gap: cells(0.05),
            centre,
        },
        8 => Pattern::Rays {
            count: 12,
            share: 0.5,
            centre,
        },
        9 => Pattern::Radial {
            from: Length::Cells(0.0),
            to: cells(0.5),
            centre,
        },
        10 => Pattern::Ramp { angle: 0.0 },
        11 => Pattern::Noise {
            grain: cells(0.1),
            octaves: 3,
            seed: 0,
        },
        12 => Pattern::Seikaiha {
            radius: cells(0.2),
            arcs: 4,
            open: 0.5,
        },
        13 => Pattern::Union([*part()].into_iter().chain(parts).collect()),
        14 => Pattern::Intersection([*part()].into_iter().chain(parts).collect()),
        15 => Pattern::Without {
            of: part(),
            cut: part(),
        },
        16 => Pattern::Invert(part()),
        17 => Pattern::Blur {
            of: part(),
            radius: Length::Cells(1.0),
        },
        18 => Pattern::Strength {
            of: part(),
            by: 0.9,
        },
        _ => Pattern::Strokes(vec![Stroke::along(
            cells(0.05),
            vec![(0.3, 0.5), (0.7, 0.5)],
        )]),
    }
}

/// The parts of a combination; another pattern is a part itself.
fn parts(pattern: Pattern) -> Vec<Pattern> {
    match pattern {
        Pattern::Nowhere => Vec::new(),
        Pattern::Union(parts) | Pattern::Intersection(parts) => parts,
        Pattern::Without { of, cut } => vec![*of, *cut],
        Pattern::Invert(of) | Pattern::Blur { of, .. } | Pattern::Strength { of, .. } => vec![*of],
        other => vec![other],
    }
}

/// Shows a pattern that stands at a place of the scenario, such as `resist.of`.
pub(super) fn show(p: &mut Pass, ui: &mut Ui, pattern: &mut Pattern, path: &str) {
    node(p, ui, "pattern", pattern, path, 0);
}

fn node(p: &mut Pass, ui: &mut Ui, name: &str, pattern: &mut Pattern, path: &str, depth: usize) {
    ui.push_id(path, |ui| {
        let shape = row(
            name,
            "Where on the cloth, from nothing to all: a shape, a picture, or other patterns combined. \
             What there was becomes a part of a combination. The last ones are named resists.",
        );
        let names: Vec<&str> = KINDS.into_iter().chain(presets::RESISTS).collect();
        if let Some(chosen) = p.variant(ui, &shape, kind(pattern), &names) {
            if chosen == 2 {
                p.ask_image(format!("{path}.file"));
            } else if let Some(name) = names.get(chosen).filter(|_| chosen >= KINDS.len()) {
                if let Some(resist) = presets::scenario(name).map(|scenario| scenario.resist) {
                    *pattern = resist;
                }
            } else if chosen < 13 || chosen == 19 || depth < DEEPEST {
                *pattern = of_kind(chosen, std::mem::take(pattern), p.cells);
            }
        }
        p.indented(ui, |p, ui| match pattern {
            Pattern::Union(_)
            | Pattern::Intersection(_)
            | Pattern::Without { .. }
            | Pattern::Invert(_)
            | Pattern::Blur { .. }
            | Pattern::Strength { .. } => combination(p, ui, pattern, path, depth + 1),
            _ => shape_rows(p, ui, pattern, path),
        });
    });
}

fn combination(p: &mut Pass, ui: &mut Ui, pattern: &mut Pattern, path: &str, depth: usize) {
    let of_path = format!("{path}.of");
    let alone = matches!(
        pattern,
        Pattern::Invert(_) | Pattern::Blur { .. } | Pattern::Strength { .. }
    );
    let each = match pattern {
        Pattern::Union(_) => "Union",
        _ => "Intersection",
    };
    match pattern {
        Pattern::Union(list) | Pattern::Intersection(list) => {
            let add = row(
                "add a part",
                "A further pattern. A union has the most of its parts, an intersection the least.",
            );
            let cells = p.cells;
            let title = |part: &Pattern| word(part).to_owned();
            let make = |kind: usize| {
                let kind = if kind == 2 { 3 } else { kind };
                Some(of_kind(kind, Pattern::Nowhere, cells))
            };
            p.list(
                ui,
                &add,
                list,
                (0, 200),
                title,
                &KINDS,
                make,
                |p, ui, i, part| {
                    node(p, ui, "part", part, &format!("{path}.{each}[{i}]"), depth);
                },
            );
        }
        Pattern::Without { of, cut } => {
            node(p, ui, "of", of, &of_path, depth);
            node(p, ui, "cut away", cut, &format!("{path}.cut"), depth);
        }
        Pattern::Invert(of) => node(p, ui, "of", of, &format!("{path}.Invert"), depth),
        Pattern::Blur { of, radius } => {
            let blur = row(
                "blur radius",
                "Standard deviation of the soft edge: how far paste or a knot leaks.",
            );
            p.length(ui, &blur, radius, 0.1, 1000.0);
            node(p, ui, "of", of, &of_path, depth);
        }
        Pattern::Strength { of, by } => {
            let by_row = row(
                "strength",
                "Every value is multiplied by it: 0.98 leaves two hundredths of the pores open.",
            );
            p.number(ui, &by_row, by, 0.0..=1.0);
            node(p, ui, "of", of, &of_path, depth);
        }
        _ => {}
    }
    if alone
        && p.button(ui, "Unwrap", "Leaves only the part that lies within")
        && let Some(part) = parts(std::mem::take(pattern)).pop()
    {
        *pattern = part;
        p.change("pattern");
    }
}

/// Strokes of the brush: what may be changed of them afterwards; where they went stays.
fn strokes_rows(p: &mut Pass, ui: &mut Ui, strokes: &mut Vec<Stroke>) {
    let radius = row("radius", "From the middle of the brush to its edge.");
    let hardness = row(
        "hardness",
        "The share of the radius up to which all of the stroke is there: 1 for a sharp edge.",
    );
    let strength = row("strength", "How much there is in the middle of the stroke.");
    let mut gone = None;
    for (i, stroke) in strokes.iter_mut().enumerate() {
        ui.push_id(i, |ui| {
            p.length(ui, &radius, &mut stroke.radius, 0.05, LONGEST);
            p.number(ui, &hardness, &mut stroke.hardness, 0.0..=1.0);
            p.number(ui, &strength, &mut stroke.strength, 0.0..=1.0);
            if p.button(ui, "Remove the stroke", "Takes this stroke away") {
                gone = Some(i);
            }
        });
    }
    if let Some(i) = gone {
        strokes.remove(i);
        p.change("pattern");
    }
}

fn shape_rows(p: &mut Pass, ui: &mut Ui, pattern: &mut Pattern, path: &str) {
    const THIN: f64 = 1e-3;
    let width_row = row("width", "How wide each one is.");
    let gap_row = row("gap", "The space between one and the next.");
    let angle_row = row(
        "angle",
        "Stripes: 0 run down the cloth, 90 across. Ramps: 0 grow to the right, 90 down.",
    )
    .unit("°")
    .scale(45.0);
    match pattern {
        Pattern::Strokes(strokes) => strokes_rows(p, ui, strokes),
        Pattern::Image { file, fit } => {
            let file_row = row(
                "file",
                "A picture beside the scenario: white is all, black nothing.",
            );
            p.text(ui, &file_row, file);
            if p.button(ui, "Open a picture…", "Chooses another picture") {
                p.ask_image(format!("{path}.file"));
            }
            fit_row(p, ui, fit);
        }
        Pattern::Disc { diameter, centre } => {
            p.length(
                ui,
                &row("diameter", "Across the spot."),
                diameter,
                THIN,
                LONGEST,
            );
            centre_row(p, ui, centre);
        }
        Pattern::Discs {
            diameter,
            pitch,
            staggered,
        } => {
            p.length(
                ui,
                &row("diameter", "Across each spot."),
                diameter,
                THIN,
                LONGEST,
            );
            p.length(
                ui,
                &row("pitch", "From the middle of a spot to that of the next."),
                pitch,
                THIN,
                LONGEST,
            );
            p.tick(
                ui,
                &row("staggered", "Every other row is moved by half a pitch."),
                staggered,
            );
        }
        Pattern::Rectangle { size, centre } => {
            p.length(
                ui,
                &row("width", "Across the rectangle."),
                &mut size.0,
                THIN,
                LONGEST,
            );
            p.length(
                ui,
                &row("height", "Down the rectangle."),
                &mut size.1,
                THIN,
                LONGEST,
            );
            centre_row(p, ui, centre);
        }
        Pattern::Stripes {
            width,
            gap,
            offset,
            angle,
        } => {
            p.length(ui, &width_row, width, THIN, LONGEST);
            p.length(ui, &gap_row, gap, 0.0, LONGEST);
            p.length(
                ui,
                &row("offset", "Where the first stripe begins."),
                offset,
                0.0,
                LONGEST,
            );
            p.number(ui, &angle_row, angle, -360.0..=360.0);
        }
        Pattern::Rings { width, gap, centre } => {
            p.length(ui, &width_row, width, THIN, LONGEST);
            p.length(ui, &gap_row, gap, 0.0, LONGEST);
            centre_row(p, ui, centre);
        }
        Pattern::Rays {
            count,
            share,
            centre,
        } => {
            p.number(
                ui,
                &row(
                    "rays",
                    "How many rays go out from the middle: as many as the folds.",
                ),
                count,
                1..=10_000,
            );
            p.number(
                ui,
                &row("share", "The share of the circle that is ray."),
                share,
                0.0..=1.0,
            );
            centre_row(p, ui, centre);
        }
        Pattern::Radial { from, to, centre } => {
            p.length(
                ui,
                &row("full up to", "All of it up to this far from the middle."),
                from,
                0.0,
                LONGEST,
            );
            p.length(
                ui,
                &row("fades until", "Nothing beyond this far from the middle."),
                to,
                THIN,
                LONGEST,
            );
            centre_row(p, ui, centre);
        }
        Pattern::Ramp { angle } => p.number(ui, &angle_row, angle, -360.0..=360.0),
        Pattern::Noise {
            grain,
            octaves,
            seed,
        } => {
            p.length(
                ui,
                &row("grain", "The size of a cloud."),
                grain,
                THIN,
                LONGEST,
            );
            p.number(
                ui,
                &row("octaves", "Finer and finer clouds on top of each other."),
                octaves,
                1..=12,
            );
            p.number(
                ui,
                &row("pattern seed", "Another number gives other clouds."),
                seed,
                0..=u32::MAX,
            );
        }
        Pattern::Seikaiha { radius, arcs, open } => {
            p.length(
                ui,
                &row("radius", "The size of a fan."),
                radius,
                2.0,
                LONGEST,
            );
            p.number(ui, &row("arcs", "Open arcs in a fan."), arcs, 1..=1000);
            p.number(
                ui,
                &row(
                    "open",
                    "The share of a ring that its arc leaves open to dye.",
                ),
                open,
                0.0..=1.0,
            );
        }
        _ => {}
    }
}

fn centre_row(p: &mut Pass, ui: &mut Ui, (x, y): &mut (f64, f64)) {
    let centre = row(
        "centre",
        "Where its middle is, as shares of the cloth across and down.",
    );
    p.numbers(ui, &centre, [x, y], [(-10.0, 10.0); 2]);
}

/// What is done with a picture of another size than the cloth.
pub(super) fn fit_row(p: &mut Pass, ui: &mut Ui, fit: &mut Fit) {
    let fit_row = row(
        "fit",
        "What to do with a picture of another size than the cloth: refuse it, or stretch it.",
    );
    p.choice(
        ui,
        &fit_row,
        fit,
        &[("exact", Fit::Exact), ("stretch", Fit::Stretch)],
    );
}

/// The pattern at a place of the scenario, such as `supply[0].shape.of.Union[1]`.
pub(super) fn at<'s>(scenario: &'s mut Scenario, path: &str) -> Option<&'s mut Pattern> {
    let (mut pattern, rest) = root(scenario, path)?;
    for name in rest.split('.').filter(|name| !name.is_empty()) {
        let number = |prefix: &str| {
            let inner = name.strip_prefix(prefix)?.strip_suffix(']')?;
            inner.parse::<usize>().ok()
        };
        pattern = match pattern {
            Pattern::Union(parts) => parts.get_mut(number("Union[")?)?,
            Pattern::Intersection(parts) => parts.get_mut(number("Intersection[")?)?,
            Pattern::Without { cut, .. } if name == "cut" => cut,
            Pattern::Without { of, .. }
            | Pattern::Blur { of, .. }
            | Pattern::Strength { of, .. }
            | Pattern::Invert(of) => of,
            _ => return None,
        };
    }
    Some(pattern)
}

fn root<'s, 'p>(scenario: &'s mut Scenario, path: &'p str) -> Option<(&'s mut Pattern, &'p str)> {
    if let Some(rest) = path.strip_prefix("resist") {
        return Some((&mut scenario.resist, rest));
    }
    if let Some(rest) = path.strip_prefix("supply[") {
        let (number, rest) = rest.split_once("].shape")?;
        let supply = scenario.supply.get_mut(number.parse::<usize>().ok()?)?;
        let (SupplySpec::Dose { shape, .. }
        | SupplySpec::Hold { shape, .. }
        | SupplySpec::Bath { shape, .. }) = supply;
        return Some((shape, rest));
    }
    if let Some(rest) = path.strip_prefix("batik.steps[") {
        let (number, rest) = rest.split_once("].Wax.pattern")?;
        let steps = &mut scenario.batik.as_mut()?.steps;
        return match steps.get_mut(number.parse::<usize>().ok()?)? {
            BatikStep::Wax { pattern, .. } => Some((pattern.as_mut()?, rest)),
            _ => None,
        };
    }
    let rest = path.strip_prefix("cloth.kasuri.")?;
    let (direction, rest) = rest.split_once(".pattern")?;
    let kasuri = &mut scenario.cloth.kasuri;
    let sections = match direction {
        "warp" => kasuri.warp.as_mut()?,
        _ => kasuri.weft.as_mut()?,
    };
    Some((&mut sections.pattern, rest))
}
