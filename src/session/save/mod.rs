//! A scenario as a file that people can read: what differs from the defaults, a field a line, each with
//! a comment that says what it is and in which unit.
//!
//! **Laws.** Reading what was saved gives the same scenario, and saving that again the same text. A
//! field is left out exactly where reading the text without it gives the same scenario; so no list of
//! defaults can fall behind.

mod comments;
mod layout;
mod tree;

use ron::Options;
use ron::extensions::Extensions;

pub(crate) use tree::Node;

use crate::scenario::Scenario;

/// What a saved file begins with.
const HEAD: &str = "\
// A scenario for dyelapse. What is left out has its default.
// Lengths are Cells, Mm or Cm; times are Steps, Minutes, Hours or Days; places are shares of the cloth.
";

fn options() -> Options {
    Options::default().with_default_extension(Extensions::IMPLICIT_SOME)
}

/// Reads the text of a scenario, as it stands: nothing is checked, and no picture is loaded.
///
/// # Errors
/// What RON says of it.
pub fn read(text: &str) -> Result<Scenario, ron::error::SpannedError> {
    options().from_str(text)
}

/// Everything that a scenario says, defaults and all; none if it says what RON cannot.
pub(crate) fn tree(scenario: &Scenario) -> Option<Node> {
    let text = options().to_string(scenario).ok()?;
    Node::read(&text)
}

/// A scenario as text.
pub fn save(scenario: &Scenario) -> String {
    let plain = || options().to_string(scenario).unwrap_or_default();
    let Some(mut root) = tree(scenario) else {
        return plain();
    };
    // Paths are long, and nothing of them is ever left out.
    let mut paths = Vec::new();
    take_paths(&mut root, &mut paths);
    if let Ok(said) = read(&root.inline()) {
        let mut place = Vec::new();
        leave_out(&mut root, &mut place, &said);
        let mut shorter = root.clone();
        shorten(&mut shorter);
        if read(&shorter.inline()).is_ok_and(|short| short == said) {
            root = shorter;
        }
    }
    paths.reverse();
    put_paths(&mut root, &mut paths);
    format!("{HEAD}{}", layout::write(&root))
}

/// Writes whole numbers without a point.
fn shorten(node: &mut Node) {
    match node {
        Node::Atom(text) => {
            let whole = text.strip_suffix(".0");
            if let Some(whole) = whole.filter(|whole| whole.parse::<i64>().is_ok()) {
                *text = whole.to_owned();
            }
        }
        Node::Fields(_, fields) => fields.iter_mut().for_each(|(_, value)| shorten(value)),
        Node::Tuple(_, items) | Node::List(items) => items.iter_mut().for_each(shorten),
    }
}

/// Takes all but the first place out of every path.
fn take_paths(node: &mut Node, paths: &mut Vec<Vec<Node>>) {
    each_path(node, &mut |path| {
        paths.push(path.split_off(path.len().min(1)))
    });
}

/// Puts back what was taken, the last of `paths` first.
fn put_paths(node: &mut Node, paths: &mut Vec<Vec<Node>>) {
    each_path(node, &mut |path| {
        path.extend(paths.pop().unwrap_or_default())
    });
}

fn each_path(node: &mut Node, what: &mut impl FnMut(&mut Vec<Node>)) {
    match node {
        Node::Atom(_) => {}
        Node::Fields(_, fields) => {
            for (key, value) in fields {
                match value {
                    Node::List(path) if key == "path" => what(path),
                    other => each_path(other, what),
                }
            }
        }
        Node::Tuple(_, items) | Node::List(items) => {
            for item in items {
                each_path(item, what);
            }
        }
    }
}

/// Leaves out of the part at `place` what the text says without.
fn leave_out(root: &mut Node, place: &mut Vec<usize>, said: &Scenario) {
    let Some(here) = find(root, place) else {
        return;
    };
    let (parts, has_names) = match here {
        Node::Atom(_) => return,
        Node::Fields(_, fields) => (fields.len(), true),
        Node::Tuple(_, items) | Node::List(items) => (items.len(), false),
    };
    // From the end, so that what is left out moves nothing that is still to be tried.
    for i in (0..parts).rev() {
        if has_names && try_without(root, place, i, said) {
            continue;
        }
        place.push(i);
        leave_out(root, place, said);
        place.pop();
    }
}

/// Leaves out field `i` of the part at `place`, if the text says the same without it.
fn try_without(root: &mut Node, place: &[usize], i: usize, said: &Scenario) -> bool {
    let Some(Node::Fields(_, fields)) = find(root, place) else {
        return false;
    };
    let field = fields.remove(i);
    if read(&root.inline()).is_ok_and(|without| without == *said) {
        return true;
    }
    if let Some(Node::Fields(_, fields)) = find(root, place) {
        fields.insert(i, field);
    }
    false
}

fn find<'a>(root: &'a mut Node, place: &[usize]) -> Option<&'a mut Node> {
    let mut node = root;
    for i in place {
        node = match node {
            Node::Atom(_) => return None,
            Node::Fields(_, fields) => &mut fields.get_mut(*i)?.1,
            Node::Tuple(_, items) | Node::List(items) => items.get_mut(*i)?,
        };
    }
    Some(node)
}
