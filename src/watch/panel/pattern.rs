//! Patterns as a tree: every part with its own kind and measures.

use bevy_egui::egui::Ui;

use super::kinds::{KINDS, kind, of_kind, parts, word};
use super::presets;
use super::row::{Pass, row};
use super::shapes::shape_rows;
use crate::pattern::Pattern;
use crate::scenario::{BatikStep, Scenario, SupplySpec};

/// How deep patterns may lie within each other here.
const DEEPEST: usize = 12;

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
