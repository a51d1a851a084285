//! Lists: what is added, taken out, and moved up and down.

use bevy_egui::egui::{self, Align, Layout, Rect, Ui, UiBuilder, pos2, vec2};

use super::row::{HEIGHT, Kind, Pass, Row, VALUE};

/// What is done to one element of a list.
enum Done {
    Up,
    Down,
    Out,
}

impl Pass<'_> {
    /// A list that has between `least` and `most` elements. `names` can be added, made by `make`.
    #[allow(clippy::too_many_arguments)]
    pub fn list<T>(
        &mut self,
        ui: &mut Ui,
        row: &Row,
        items: &mut Vec<T>,
        (least, most): (usize, usize),
        title: impl Fn(&T) -> String,
        names: &[&str],
        make: impl FnOnce(usize) -> Option<T>,
        mut show: impl FnMut(&mut Self, &mut Ui, usize, &mut T),
    ) {
        let mut done = None;
        let count = items.len();
        for (i, item) in items.iter_mut().enumerate() {
            let title = format!("{}. {}", i + 1, title(item));
            ui.push_id((row.name, i), |ui| {
                let title = self.fold(ui, &title, |p, ui| {
                    p.indented(ui, |p, ui| show(p, ui, i, item));
                });
                let moved = title.and_then(|at| self.moves(ui, row, at, (i, count), count > least));
                if let Some(moved) = moved {
                    done = Some((i, moved));
                }
            });
        }
        match done {
            Some((i, Done::Up)) => items.swap(i - 1, i),
            Some((i, Done::Down)) => items.swap(i, i + 1),
            Some((i, Done::Out)) => {
                items.remove(i);
            }
            None => {}
        }
        if items.len() < most {
            let added = self.row(ui, row, |p, ui| {
                p.pick(ui, row.name, usize::MAX, names, VALUE)
            });
            if let Some(new) = added.flatten().and_then(make) {
                items.push(new);
                self.change(row.name);
            }
        }
    }

    /// The buttons that move an element and take it out, at the right of its title.
    fn moves(
        &mut self,
        ui: &mut Ui,
        row: &Row,
        title: Rect,
        (i, count): (usize, usize),
        out: bool,
    ) -> Option<Done> {
        let mut done = None;
        let right = ui.max_rect().right();
        let corner = pos2(right - 3.0 * HEIGHT - 3.0 * 4.0, title.top());
        let room = Rect::from_min_max(corner, pos2(right, title.bottom()));
        let layout = Layout::left_to_right(Align::Center);
        let builder = UiBuilder::new()
            .id_salt("moves")
            .max_rect(room)
            .layout(layout);
        // Over the title, which takes up the whole row.
        let mut over = ui.new_child(builder);
        for (text, tip, is_on, what) in [
            ("⬆", "Move up", i > 0, Done::Up),
            ("⬇", "Move down", i + 1 < count, Done::Down),
            ("×", "Take out", out, Done::Out),
        ] {
            let button = egui::Button::new(text).min_size(vec2(HEIGHT, HEIGHT));
            let button = over.add_enabled(is_on, button).on_hover_text(tip);
            let pulled = is_on && self.control(tip, Kind::Button).is_some();
            if button.clicked() || pulled {
                done = Some(what);
                self.change(row.name);
            }
        }
        done
    }

    /// Rows a little to the right, with a line beside them.
    pub fn indented(&mut self, ui: &mut Ui, add: impl FnOnce(&mut Self, &mut Ui)) {
        if self.searching() {
            add(self, ui);
            return;
        }
        let indent = std::mem::replace(&mut ui.spacing_mut().indent, 8.0);
        ui.indent("parts", |ui| {
            ui.spacing_mut().indent = indent;
            add(self, ui);
        });
        ui.spacing_mut().indent = indent;
    }
}
