//! Undo and redo: every edit is another scenario, with a label that says what was done.

use std::collections::VecDeque;
use std::sync::Arc;

use crate::scenario::Scenario;

/// Edits that can be undone at the most.
pub const LONGEST: usize = 256;

/// A scenario, and what was done to get to the next or came from the one before.
#[derive(Debug, Clone)]
struct Edit {
    label: String,
    scenario: Arc<Scenario>,
}

/// Scenarios, from the first that can still be gone back to up to the last that was undone.
#[derive(Debug, Clone)]
pub struct History {
    now: Arc<Scenario>,
    /// What was before each edit, the last at the end.
    past: VecDeque<Edit>,
    /// What was after each edit that was undone, the next at the end.
    future: Vec<Edit>,
    /// Whether the next edit with the label of the last one belongs to it.
    held: bool,
}

impl History {
    /// A history that begins here.
    pub fn new(scenario: Scenario) -> Self {
        History {
            now: Arc::new(scenario),
            past: VecDeque::new(),
            future: Vec::new(),
            held: false,
        }
    }

    /// The scenario as it is now.
    pub fn now(&self) -> &Arc<Scenario> {
        &self.now
    }

    /// Takes an edit. While it is `held` (a slider that is dragged), those that follow with the same label
    /// are the same edit.
    pub fn edit(&mut self, scenario: Scenario, label: &str, held: bool) {
        let same = self.held && self.past.back().is_some_and(|edit| edit.label == label);
        self.held = held;
        if *self.now == scenario {
            return;
        }
        let before = std::mem::replace(&mut self.now, Arc::new(scenario));
        self.future.clear();
        if same {
            // Dragged back to where it began, it was no edit at all.
            if self
                .past
                .back()
                .is_some_and(|edit| edit.scenario == self.now)
            {
                self.past.pop_back();
                self.held = false;
            }
            return;
        }
        self.past.push_back(Edit {
            label: label.into(),
            scenario: before,
        });
        if self.past.len() > LONGEST {
            self.past.pop_front();
        }
    }

    /// Ends what was held: the next edit is one of its own.
    pub fn release(&mut self) {
        self.held = false;
    }

    /// What undoing would undo, and where it would lead.
    pub fn undoable(&self) -> Option<(&str, &Arc<Scenario>)> {
        let edit = self.past.back()?;
        Some((&edit.label, &edit.scenario))
    }

    /// What redoing would do again, and where it would lead.
    pub fn redoable(&self) -> Option<(&str, &Arc<Scenario>)> {
        let edit = self.future.last()?;
        Some((&edit.label, &edit.scenario))
    }

    /// Goes back by one edit; whether there was one.
    pub fn undo(&mut self) -> bool {
        self.held = false;
        let Some(Edit { label, scenario }) = self.past.pop_back() else {
            return false;
        };
        let scenario = std::mem::replace(&mut self.now, scenario);
        self.future.push(Edit { label, scenario });
        true
    }

    /// Goes on again by one edit; whether there was one.
    pub fn redo(&mut self) -> bool {
        self.held = false;
        let Some(Edit { label, scenario }) = self.future.pop() else {
            return false;
        };
        let scenario = std::mem::replace(&mut self.now, scenario);
        self.past.push_back(Edit { label, scenario });
        true
    }

    /// What was done, the first first.
    pub fn labels(&self) -> impl Iterator<Item = &str> {
        self.past.iter().map(|edit| edit.label.as_str())
    }

    /// Edits that can be undone.
    pub fn len(&self) -> usize {
        self.past.len()
    }

    /// Whether there is nothing to undo.
    pub fn is_empty(&self) -> bool {
        self.past.is_empty()
    }
}
