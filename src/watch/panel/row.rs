//! Rows: a name at the left, its value at the right; what they belong to, and whether they are looked for.

use bevy_egui::egui::{Ui, vec2};

pub(super) use super::pass::Pass;

/// Width of the values at the right, points.
pub(super) const VALUE: f32 = 148.0;
/// Height of a row.
pub(super) const HEIGHT: f32 = 20.0;

/// What a change of a parameter means for the process that runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Effect {
    /// It begins anew.
    Anew,
    /// Only the picture changes.
    Look,
    /// Only what is recorded changes.
    Kept,
}

/// A parameter: its name and what it does to cloth.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row<'a> {
    pub name: &'a str,
    pub tip: &'a str,
    pub unit: &'a str,
    /// A typical value: near 0, a pixel of the pointer moves by a hundredth of it.
    pub scale: f64,
}

/// A row.
pub(super) const fn row<'a>(name: &'a str, tip: &'a str) -> Row<'a> {
    Row {
        name,
        tip,
        unit: "",
        scale: 1.0,
    }
}

impl<'a> Row<'a> {
    pub const fn unit(self, unit: &'a str) -> Self {
        Row { unit, ..self }
    }

    pub const fn scale(self, scale: f64) -> Self {
        Row { scale, ..self }
    }
}

/// A control that the panel shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Control {
    /// What it changes.
    pub name: String,
    /// What can be done to it.
    pub kind: Kind,
}

/// What can be done to a control.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// It is moved between two numbers.
    Number(f64, f64),
    /// One of so many is chosen.
    Choice(usize),
    /// It is ticked or not.
    Tick,
    /// It is pressed.
    Button,
}

/// What is done to a control.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pull {
    /// A number is moved here, and no further than is allowed.
    To(f64),
    /// This one is chosen.
    Choose(usize),
    /// It is pressed, or ticked the other way.
    Press,
}

/// The look of the panel: a grid of 4 points.
pub(super) fn style(ui: &mut Ui) {
    let spacing = ui.spacing_mut();
    spacing.item_spacing = vec2(4.0, 4.0);
    spacing.interact_size.y = HEIGHT;
    spacing.button_padding = vec2(4.0, 1.0);
    spacing.combo_width = 0.0;
    spacing.icon_width = 12.0;
    spacing.icon_spacing = 2.0;
}
