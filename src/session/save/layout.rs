//! Laying RON out for people: a field a line with its comment, short things on one line.

use super::comments::{ITEM, comment};
use super::tree::Node;

/// The longest line.
const WIDEST: usize = 105;
/// The longest thing that stays on one line.
const INLINE: usize = 70;
/// The same, where it holds nothing that has parts of its own.
const INLINE_PLAIN: usize = 96;
/// Comments stand in one column where what is before them is no longer than this.
const COLUMN: usize = 46;

struct Line {
    indent: usize,
    text: String,
    comment: Option<String>,
}

/// A scenario as text.
pub(super) fn write(root: &Node) -> String {
    let mut lines = Vec::new();
    lay(root, "", String::new(), "", 0, &mut lines);
    let mut text = String::new();
    for paragraph in paragraphs(lines) {
        let width = |line: &&Line| line.indent + line.text.chars().count();
        let commented = paragraph.iter().filter(|line| line.comment.is_some());
        let column = commented
            .map(|line| width(&line))
            .filter(|w| *w <= COLUMN)
            .max();
        for line in &paragraph {
            put(line, column.unwrap_or(0), &mut text);
        }
    }
    text
}

/// Puts blank lines around the larger parts of the outermost level.
fn paragraphs(lines: Vec<Line>) -> Vec<Vec<Line>> {
    let mut all: Vec<Vec<Line>> = vec![Vec::new()];
    let mut was_large = false;
    for line in lines {
        let opens = line.indent == 4 && line.text.ends_with(['(', '[']);
        if (opens || was_large) && line.indent <= 4 && !line.text.starts_with([')', ']']) {
            all.push(Vec::new());
        }
        was_large = line.indent == 4 && line.text.starts_with([')', ']']);
        if let Some(paragraph) = all.last_mut() {
            paragraph.push(line);
        }
    }
    all.retain(|paragraph| !paragraph.is_empty());
    let blank = || Line {
        indent: 0,
        text: String::new(),
        comment: None,
    };
    let last = all.len() - 1;
    for paragraph in &mut all[..last] {
        paragraph.push(blank());
    }
    all
}

fn put(line: &Line, column: usize, text: &mut String) {
    let blanks = |n: usize| " ".repeat(n);
    let written = format!("{}{}", blanks(line.indent), line.text);
    let width = written.chars().count();
    match &line.comment {
        None => text.push_str(&written),
        Some(comment) => {
            let at = width.max(column) + 1;
            if at + comment.chars().count() + 3 > WIDEST {
                text.push_str(&format!("{}// {comment}\n{written}", blanks(line.indent)));
            } else {
                text.push_str(&format!("{written}{}// {comment}", blanks(at - width)));
            }
        }
    }
    text.push('\n');
}

/// Lays a value out. `before` stands before it on its first line; `owner` is the name of what it is a
/// field of, and `key` its own.
fn lay(node: &Node, owner: &str, before: String, key: &str, indent: usize, lines: &mut Vec<Line>) {
    let end = if indent == 0 { "" } else { "," };
    let comment = comment(owner, key, node);
    let inline = node.inline();
    let most = if is_plain(node) { INLINE_PLAIN } else { INLINE };
    let fits = indent + before.chars().count() + inline.chars().count() <= most;
    if fits && !is_section(node, key) {
        lines.push(Line {
            indent,
            text: format!("{before}{inline}{end}"),
            comment,
        });
        return;
    }
    let name = |name: &Option<String>| name.clone().unwrap_or_default();
    // `Union([` opens both at once.
    if let Node::Tuple(of, items) = node
        && let [Node::List(parts)] = items.as_slice()
    {
        let line = |text, comment| Line {
            indent,
            text,
            comment,
        };
        lines.push(line(format!("{before}{}([", name(of)), comment));
        lay_items(parts, of.as_deref().unwrap_or(key), indent + 4, lines);
        lines.push(line(format!("]){end}"), None));
        return;
    }
    let (open, close) = match node {
        Node::Atom(text) => (text.clone(), String::new()),
        Node::Fields(of, _) | Node::Tuple(of, _) => (format!("{}(", name(of)), ")".into()),
        Node::List(_) => ("[".into(), "]".into()),
    };
    let first = Line {
        indent,
        text: format!("{before}{open}{}", if close.is_empty() { end } else { "" }),
        comment,
    };
    lines.push(first);
    let inner = indent + 4;
    match node {
        Node::Atom(_) => return,
        Node::Fields(of, fields) => {
            let own = of.as_deref().unwrap_or(key);
            for (field, value) in fields {
                lay(value, own, format!("{field}: "), field, inner, lines);
            }
        }
        Node::Tuple(of, items) => {
            let own = of.as_deref().unwrap_or(key);
            for item in items {
                lay(item, ITEM, String::new(), own, inner, lines);
            }
        }
        Node::List(items) => lay_items(items, key, inner, lines),
    }
    lines.push(Line {
        indent,
        text: format!("{close}{end}"),
        comment: None,
    });
}

/// Lays out what is in a list; what has no name of its own goes by `key`.
fn lay_items(items: &[Node], key: &str, indent: usize, lines: &mut Vec<Line>) {
    if items.iter().all(is_short) {
        return pack(items, indent, lines);
    }
    for item in items {
        lay(item, ITEM, String::new(), key, indent, lines);
    }
}

/// Whether something has no parts that have fields of their own.
fn is_plain(node: &Node) -> bool {
    let is_leaf = |node: &Node| match node {
        Node::Atom(_) => true,
        Node::Fields(..) => false,
        Node::Tuple(_, items) | Node::List(items) => {
            items.iter().all(|item| matches!(item, Node::Atom(_)))
        }
    };
    match node {
        Node::Fields(_, fields) => fields.iter().all(|(_, value)| is_leaf(value)),
        Node::Tuple(_, items) => items.iter().all(is_plain),
        Node::Atom(_) => true,
        Node::List(_) => false,
    }
}

/// What is never written on one line: every one of its fields has its own, with a comment.
fn is_section(node: &Node, key: &str) -> bool {
    match node {
        Node::Fields(None, fields) => key != "Strokes" && !fields.is_empty(),
        Node::Fields(Some(_), _) => key == "supply" || key == "steps",
        Node::List(items) => key == "supply" && !items.is_empty(),
        _ => false,
    }
}

fn is_short(node: &Node) -> bool {
    !matches!(node, Node::Fields(..)) && node.inline().len() <= 30
}

/// Several short items a line.
fn pack(items: &[Node], indent: usize, lines: &mut Vec<Line>) {
    let mut text = String::new();
    let mut flush = |text: &mut String| {
        let text = std::mem::take(text);
        if !text.is_empty() {
            lines.push(Line {
                indent,
                text,
                comment: None,
            });
        }
    };
    for item in items {
        let item = format!("{},", item.inline());
        if indent + text.len() + item.len() + 1 > WIDEST - 5 {
            flush(&mut text);
        }
        if !text.is_empty() {
            text.push(' ');
        }
        text.push_str(&item);
    }
    flush(&mut text);
}
