//! Values at the right of a row: numbers, lengths and times with their units, colours, choices.

use std::ops::RangeInclusive;

use bevy_egui::egui::{self, Ui, emath::Numeric, vec2};

use super::row::{HEIGHT, Kind, Pass, Pull, Row, VALUE};
use crate::scenario::units;
use crate::texture::to_rgb;

/// All digits of a whole number.
const WHOLE: usize = usize::MAX;

/// A number as the panel writes it: so many digits at most, or all of a whole number.
fn written(value: f64, digits: usize) -> String {
    if digits == WHOLE {
        return format!("{value:.0}");
    }
    let value = units::rounded(value, digits);
    match value.abs() {
        0.0 => "0".into(),
        size if !(1e-4..1e7).contains(&size) => format!("{value:e}"),
        _ => value.to_string(),
    }
}

impl Pass<'_> {
    /// A number to drag or type, `width` points wide; the new one if there is one.
    pub fn drag(
        &mut self,
        ui: &mut Ui,
        row: &Row,
        value: f64,
        (least, most): (f64, f64),
        width: f32,
        whole: bool,
    ) -> Option<f64> {
        let most = most.max(least);
        let pulled = self.pulled(row, least, most);
        let mut now = pulled.unwrap_or(value);
        let speed = (0.01 * value.abs()).max(0.01 * row.scale);
        let speed = if whole { speed.max(0.1) } else { speed };
        let slide = row.unit.is_empty()
            && width > 100.0
            && (0.0..0.01).contains(&least)
            && most == 1.0
            && !whole;
        let digits = match (whole, slide) {
            (true, _) => WHOLE,
            (_, true) => 4,
            _ => 6,
        };
        // What is written is not all there is: leaving the row must not round it.
        let get_set = |new: Option<f64>| {
            if let Some(new) = new {
                let new = if whole { new.round() } else { new };
                if written(new, digits) != written(now, digits) {
                    now = new;
                }
            }
            now
        };
        let range = format!(
            "{} to {}{}",
            written(least, digits),
            written(most, digits),
            row.unit
        );
        if slide {
            ui.spacing_mut().slider_width = width - 54.0;
            ui.spacing_mut().interact_size.x = 50.0;
            let slider = egui::Slider::from_get_set(least..=most, get_set)
                .clamping(egui::SliderClamping::Edits)
                .update_while_editing(false)
                .custom_formatter(|value, _| written(value, digits));
            ui.add(slider).on_hover_text(range);
        } else {
            let number = egui::DragValue::from_get_set(get_set)
                .speed(speed)
                .range(least..=most)
                .clamp_existing_to_range(false)
                .update_while_editing(false)
                .suffix(row.unit)
                .custom_formatter(|value, _| written(value, digits));
            ui.add_sized([width, HEIGHT], number).on_hover_text(range);
        }
        let now = if whole { now.round() } else { now };
        (now != value).then(|| {
            self.change(row.name);
            now
        })
    }

    fn pulled(&mut self, row: &Row, least: f64, most: f64) -> Option<f64> {
        match self.control(row.name, Kind::Number(least, most)) {
            Some(Pull::To(value)) => Some(value.clamp(least, most)),
            _ => None,
        }
    }

    /// A number.
    pub fn number<N: Numeric>(
        &mut self,
        ui: &mut Ui,
        row: &Row,
        value: &mut N,
        range: RangeInclusive<N>,
    ) {
        let ends = (range.start().to_f64(), range.end().to_f64());
        self.row(ui, row, |p, ui| {
            let new = p.drag(ui, row, value.to_f64(), ends, VALUE, N::INTEGRAL);
            if let Some(new) = new {
                *value = N::from_f64(new);
            }
        });
    }

    /// A number that may be left out.
    pub fn optional(
        &mut self,
        ui: &mut Ui,
        row: &Row,
        value: &mut Option<f64>,
        range: RangeInclusive<f64>,
        (instead, without): (f64, &str),
    ) {
        let mut is_there = value.is_some();
        self.ticked_row(ui, row, Some(&mut is_there), |p, ui| match value {
            Some(value) => {
                let ends = (*range.start(), *range.end());
                if let Some(new) = p.drag(ui, row, *value, ends, VALUE, false) {
                    *value = new;
                }
            }
            None => {
                let text = egui::RichText::new(without).weak();
                ui.add(egui::Label::new(text).truncate());
            }
        });
        if is_there != value.is_some() {
            *value = is_there.then_some(instead.clamp(*range.start(), *range.end()));
        }
    }

    /// Two or three numbers side by side, each with its range.
    pub fn numbers<const N: usize>(
        &mut self,
        ui: &mut Ui,
        row: &Row,
        values: [&mut f64; N],
        ranges: [(f64, f64); N],
    ) {
        let width = ((VALUE - 4.0 * (N as f32 - 1.0)) / N as f32).floor();
        self.row(ui, row, |p, ui| {
            for (i, (value, range)) in values.into_iter().zip(ranges).enumerate() {
                ui.push_id(i, |ui| {
                    if let Some(new) = p.drag(ui, row, *value, range, width, false) {
                        *value = new;
                    }
                });
            }
        });
    }

    /// The least and the most of something.
    pub fn range(
        &mut self,
        ui: &mut Ui,
        row: &Row,
        (least, most): &mut (f64, f64),
        range: RangeInclusive<f64>,
    ) {
        let ranges = [(*range.start(), *most), (*least, *range.end())];
        self.numbers(ui, row, [least, most], ranges);
    }

    /// A place or vector in space.
    pub fn xyz(&mut self, ui: &mut Ui, row: &Row, at: &mut (f64, f64, f64), most: f64) {
        let values = [&mut at.0, &mut at.1, &mut at.2];
        self.numbers(ui, row, values, [(-most, most); 3]);
    }

    /// One of several by its number; the new one if another is chosen.
    pub fn pick(
        &mut self,
        ui: &mut Ui,
        name: &str,
        now: usize,
        names: &[&str],
        width: f32,
    ) -> Option<usize> {
        let pulled = self.control(name, Kind::Choice(names.len()));
        let mut chosen = match pulled {
            Some(Pull::Choose(i)) => i.min(names.len() - 1),
            _ => now,
        };
        let selected = names.get(now).copied().unwrap_or("choose");
        egui::ComboBox::from_id_salt((name, "pick"))
            .width(width)
            .truncate()
            .height(400.0)
            .selected_text(selected)
            .show_ui(ui, |ui| {
                for (i, name) in names.iter().enumerate() {
                    ui.selectable_value(&mut chosen, i, *name);
                }
            });
        (chosen != now).then_some(chosen)
    }

    /// A row with one of several; the new one if another is chosen.
    pub fn variant(&mut self, ui: &mut Ui, row: &Row, now: usize, names: &[&str]) -> Option<usize> {
        self.row(ui, row, |p, ui| p.pick(ui, row.name, now, names, VALUE))
            .flatten()
            .inspect(|_| self.change(row.name))
    }

    /// A row with one of several values.
    pub fn choice<T: PartialEq + Clone>(
        &mut self,
        ui: &mut Ui,
        row: &Row,
        value: &mut T,
        all: &[(&str, T)],
    ) {
        let names: Vec<&str> = all.iter().map(|(name, _)| *name).collect();
        let now = all.iter().position(|(_, one)| one == value);
        if let Some(i) = self.variant(ui, row, now.unwrap_or(usize::MAX), &names) {
            *value = all[i].1.clone();
        }
    }

    /// A row that is ticked or not.
    pub fn tick(&mut self, ui: &mut Ui, row: &Row, value: &mut bool) {
        let mut ticked = *value;
        self.ticked_row(ui, row, Some(&mut ticked), |_, _| ());
        *value = ticked;
    }

    /// A row of text.
    pub fn text(&mut self, ui: &mut Ui, row: &Row, text: &mut String) {
        self.row(ui, row, |p, ui| {
            let edit = egui::TextEdit::singleline(text);
            if ui.add_sized([VALUE, HEIGHT], edit).changed() {
                p.type_in(row.name);
            }
        });
    }

    /// A colour as hue, saturation and value.
    pub fn colour(&mut self, ui: &mut Ui, row: &Row, colour: &mut (f64, f64, f64)) {
        self.row(ui, row, |p, ui| {
            let shown = to_rgb(*colour).map(|c| (255.0 * c.clamp(0.0, 1.0)).round() as u8);
            let mut rgb = shown;
            ui.spacing_mut().interact_size = vec2(22.0, HEIGHT);
            ui.color_edit_button_srgb(&mut rgb);
            if rgb != shown {
                *colour = hsv(rgb, *colour);
                p.change(row.name);
            }
            ui.spacing_mut().item_spacing.x = 3.0;
            let most = [360.0, 1.0, 1.0];
            let parts = [&mut colour.0, &mut colour.1, &mut colour.2];
            for (i, (part, most)) in parts.into_iter().zip(most).enumerate() {
                let part_row = row.scale(most);
                ui.push_id(i, |ui| {
                    if let Some(new) = p.drag(ui, &part_row, *part, (0.0, most), 38.0, false) {
                        *part = units::rounded(new, 4).clamp(0.0, most);
                    }
                });
            }
        });
    }
}

/// A colour as hue in degrees, saturation and value; grey keeps the hue that was.
fn hsv(rgb: [u8; 3], was: (f64, f64, f64)) -> (f64, f64, f64) {
    let [r, g, b] = rgb.map(|c| f64::from(c) / 255.0);
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    let chroma = most - least;
    if chroma == 0.0 {
        return (was.0, 0.0, units::rounded(most, 4));
    }
    let sixth = match () {
        () if most == r => ((g - b) / chroma).rem_euclid(6.0),
        () if most == g => (b - r) / chroma + 2.0,
        () => (r - g) / chroma + 4.0,
    };
    let tidy = |x: f64| units::rounded(x, 4);
    (tidy(60.0 * sixth), tidy(chroma / most), tidy(most))
}
