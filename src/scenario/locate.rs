//! Finding the value of a field path in RON text, so that a problem found after parsing can still
//! point at its line and column.

/// Where a value stands: byte offsets of its beginning and end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Found {
    pub begin: usize,
    pub end: usize,
}

/// Finds the value at `path`, or the nearest one around it that is written out.
///
/// A path is made of field names and `[i]`; a name may also be that of an enum variant, which then
/// stands for what is in its parentheses. The text is known to be good RON.
pub(super) fn locate(text: &str, path: &str) -> Option<Found> {
    let mut scanner = Scanner::new(text);
    scanner.skip_blanks();
    while scanner.rest().starts_with("#!") {
        scanner.skip_past(']');
    }
    let mut found = scanner.value_here()?;
    for segment in segments(path) {
        scanner.at = found.begin;
        match scanner.enter(segment) {
            Some(inner) => found = inner,
            None => break,
        }
    }
    Some(found)
}

/// Something in a text that has no partner.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Unbalanced {
    /// Where it begins, in bytes.
    pub begin: usize,
    /// What it lacks.
    pub what: String,
    /// Whether only the end of the text shows it: the partner may be missing anywhere.
    pub at_end: bool,
}

/// Finds the first bracket, quote or comment that has no partner.
pub(super) fn unbalanced(text: &str) -> Option<Unbalanced> {
    let mut scanner = Scanner::new(text);
    let mut open: Vec<(usize, char)> = Vec::new();
    let found = |begin, what, at_end| {
        Some(Unbalanced {
            begin,
            what,
            at_end,
        })
    };
    loop {
        scanner.skip_blanks();
        let Some(c) = scanner.peek() else { break };
        let at = scanner.at;
        match c {
            '(' | '[' | '{' => open.push((at, c)),
            ')' | ']' | '}' => match (open.pop(), c) {
                (Some((_, '(')), ')') | (Some((_, '[')), ']') | (Some((_, '{')), '}') => {}
                (Some((opened, other)), _) => {
                    let line = text[..at].matches('\n').count() + 1;
                    let what =
                        format!("this `{other}` is not closed: `{c}` comes first, in line {line}");
                    return found(opened, what, false);
                }
                (None, _) => return found(at, format!("this `{c}` closes nothing"), false),
            },
            _ if scanner.at_string() => {
                scanner.skip_string();
                continue;
            }
            // A whole word, so that the `r` in it is not taken for the beginning of a raw string.
            _ if c.is_alphanumeric() || c == '_' => {
                scanner.word();
                continue;
            }
            _ => {}
        }
        scanner.at += c.len_utf8();
    }
    if let Some((at, what)) = scanner.unclosed {
        return found(at, format!("this {what} is not closed"), false);
    }
    let (at, c) = open.pop()?;
    found(at, format!("this `{c}` is not closed"), true)
}

#[derive(Debug, Clone, Copy)]
enum Segment<'a> {
    Name(&'a str),
    Item(usize),
}

fn segments(path: &str) -> impl Iterator<Item = Segment<'_>> {
    path.split(['.', '['])
        .filter(|part| !part.is_empty())
        .map(|part| match part.strip_suffix(']').map(str::parse) {
            Some(Ok(i)) => Segment::Item(i),
            _ => Segment::Name(part),
        })
}

struct Scanner<'a> {
    text: &'a str,
    at: usize,
    /// Where a quote or comment begins that goes on to the end of the text, and which.
    unclosed: Option<(usize, &'static str)>,
}

impl<'a> Scanner<'a> {
    fn new(text: &'a str) -> Self {
        Scanner {
            text,
            at: 0,
            unclosed: None,
        }
    }

    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn skip_past(&mut self, c: char) {
        self.at = match self.rest().find(c) {
            Some(i) => self.at + i + c.len_utf8(),
            None => self.text.len(),
        };
        self.skip_blanks();
    }

    /// Skips white space and comments; block comments nest.
    fn skip_blanks(&mut self) {
        loop {
            let rest = self.rest();
            let trimmed = rest.trim_start();
            self.at += rest.len() - trimmed.len();
            if trimmed.starts_with("//") {
                self.at += trimmed.find('\n').unwrap_or(trimmed.len());
            } else if trimmed.starts_with("/*") {
                let (begin, mut depth) = (self.at, 0);
                while !self.rest().is_empty() {
                    if self.rest().starts_with("/*") {
                        depth += 1;
                        self.at += 2;
                    } else if self.rest().starts_with("*/") {
                        depth -= 1;
                        self.at += 2;
                        if depth == 0 {
                            break;
                        }
                    } else {
                        self.at += self.peek().map_or(0, char::len_utf8);
                    }
                }
                if depth > 0 {
                    self.unclosed.get_or_insert((begin, "comment"));
                }
            } else {
                return;
            }
        }
    }

    /// The identifier, number or other plain word at the cursor.
    fn word(&mut self) -> &'a str {
        let rest = self.rest();
        let end = rest
            .find(|c: char| c.is_whitespace() || "()[]{},:\"'".contains(c) || c == '/')
            .unwrap_or(rest.len());
        self.at += end;
        &rest[..end]
    }

    fn skip_string(&mut self) {
        let begin = self.at;
        if let Some(rest) = self.rest().strip_prefix('r') {
            let hashes = rest.len() - rest.trim_start_matches('#').len();
            self.at += 1 + hashes + 1;
            let close = format!("\"{}", "#".repeat(hashes));
            match self.rest().find(&close) {
                Some(i) => self.at += i + close.len(),
                None => {
                    self.at = self.text.len();
                    self.unclosed.get_or_insert((begin, "text in quotes"));
                }
            }
            return;
        }
        let quote = self.peek();
        self.at += 1;
        while let Some(c) = self.peek() {
            self.at += c.len_utf8();
            if c == '\\' {
                self.at += self.peek().map_or(0, char::len_utf8);
            } else if Some(c) == quote {
                return;
            }
        }
        self.unclosed.get_or_insert((begin, "text in quotes"));
    }

    fn at_string(&self) -> bool {
        let rest = self.rest();
        let mut letters = rest.chars();
        match letters.next() {
            Some('"') => true,
            // One character, or one that is written with a backslash; else it is an apostrophe.
            Some('\'') => letters.next() == Some('\\') || letters.next() == Some('\''),
            Some('r') => rest[1..].trim_start_matches('#').starts_with('"'),
            _ => false,
        }
    }

    /// Skips one whole value: a word, a string, a bracket, or a word with a bracket.
    fn skip_value(&mut self) {
        if self.at_string() {
            return self.skip_string();
        }
        self.word();
        let after_word = self.at;
        self.skip_blanks();
        if !self.rest().starts_with(['(', '[', '{']) {
            self.at = after_word;
            return;
        }
        let mut depth = 0_usize;
        while let Some(c) = self.peek() {
            match c {
                '(' | '[' | '{' => depth += 1,
                ')' | ']' | '}' => depth -= 1,
                _ if self.at_string() => {
                    self.skip_string();
                    self.skip_blanks();
                    continue;
                }
                _ => {}
            }
            self.at += c.len_utf8();
            if depth == 0 {
                return;
            }
            self.skip_blanks();
        }
    }

    fn value_here(&mut self) -> Option<Found> {
        let begin = self.at;
        self.skip_value();
        (self.at > begin).then_some(Found {
            begin,
            end: self.at,
        })
    }

    /// From the beginning of a value, the value inside it that `segment` names.
    fn enter(&mut self, segment: Segment) -> Option<Found> {
        let name = if self.at_string() { "" } else { self.word() };
        self.skip_blanks();
        let open = self.peek().filter(|c| "([{".contains(*c))?;
        let bracket = self.at;
        self.at += open.len_utf8();
        self.skip_blanks();
        match segment {
            Segment::Name(wanted) if wanted == name => {
                // `Variant(field: …)` or `Variant(value)`: what the parentheses hold.
                let is_fields = {
                    let mut ahead = Scanner { ..*self };
                    ahead.word();
                    ahead.skip_blanks();
                    ahead.rest().starts_with(':')
                };
                if is_fields {
                    self.at = bracket;
                }
                self.value_here()
            }
            Segment::Name(wanted) => {
                while self.peek().is_some_and(|c| !")]}".contains(c)) {
                    let field = self.word();
                    self.skip_blanks();
                    if !self.rest().starts_with(':') {
                        return None;
                    }
                    self.skip_past(':');
                    let value = self.value_here()?;
                    if field == wanted {
                        return Some(value);
                    }
                    self.next_element();
                }
                None
            }
            Segment::Item(wanted) => {
                for _ in 0..wanted {
                    self.value_here()?;
                    self.next_element();
                }
                self.value_here()
            }
        }
    }

    fn next_element(&mut self) {
        self.skip_blanks();
        if self.rest().starts_with(',') {
            self.skip_past(',');
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r##"#![enable(implicit_some)]
// A comment with cloth: (size: 7).
(
    title: "not (a [bracket\"", /* nor /* nested */ cloth: ( */
    raw: r#"a " quote"#,
    cloth: Cloth(
        size: (Cells(800), Mm(30.0)),
    ),
    supply: [Dose(dose: 0.5), Hold(shape: Union([Nowhere, Disc(diameter: Mm(1))]))],
    resist: Invert(Disc(diameter: Cells(3))),
)"##;

    fn found(path: &str) -> &str {
        let Found { begin, end } = locate(TEXT, path).unwrap();
        &TEXT[begin..end]
    }

    #[test]
    fn a_path_leads_to_the_text_of_its_value() {
        assert_eq!(found("title"), r#""not (a [bracket\"""#);
        assert_eq!(found("raw"), r##"r#"a " quote"#"##);
        assert_eq!(found("cloth.size[1]"), "Mm(30.0)");
        assert_eq!(found("supply[0].dose"), "0.5");
        assert_eq!(found("supply[1].shape.Union[1].diameter"), "Mm(1)");
        assert_eq!(found("resist.Invert.diameter"), "Cells(3)");
    }

    #[test]
    fn a_field_that_is_left_out_leads_to_what_it_was_left_out_of() {
        assert_eq!(found("supply[0].at"), "Dose(dose: 0.5)");
        assert!(found("nothing.here").starts_with('('));
    }

    #[test]
    fn brackets_without_a_partner_are_found_and_those_in_text_are_not_counted() {
        assert_eq!(unbalanced(TEXT), None);
        let found = |text| unbalanced(text).map(|found| found.begin);
        assert_eq!(found("(a: [1, 2)"), Some(4));
        assert_eq!(found("(a: 1))"), Some(6));
        assert_eq!(found("(a: \")\", b: ']'"), Some(0));
        assert_eq!(found("(over: 1) // ("), None);
        assert_eq!(found("(a: \"b, c: (1)"), Some(4));
        assert_eq!(found("(a: r#\"b\", c: (1))"), Some(4));
        assert_eq!(found("(a: 1, /* b /* c */ d)"), Some(7));
        assert_eq!(found("(a: Bob's cloth)"), None);
    }

    #[test]
    fn any_text_is_scanned_without_a_panic() {
        for end in (0..TEXT.len()).filter(|i| TEXT.is_char_boundary(*i)) {
            for path in [
                "title",
                "cloth.size[1]",
                "supply[1].shape.Union[1].diameter",
                "x[3]",
            ] {
                locate(&TEXT[..end], path);
                locate(&TEXT[end..], path);
            }
            unbalanced(&TEXT[..end]);
            unbalanced(&TEXT[end..]);
        }
    }
}
