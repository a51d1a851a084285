//! RON text as a tree: what a scenario is serialized to, before it is laid out for people.

/// A piece of RON.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Node {
    /// A number, a text, a name.
    Atom(String),
    /// `Name(field: …)`, the name left out where it says nothing.
    Fields(Option<String>, Vec<(String, Node)>),
    /// `Name(…, …)`.
    Tuple(Option<String>, Vec<Node>),
    /// `[…, …]`.
    List(Vec<Node>),
}

impl Node {
    /// Reads RON without blanks or comments, as it is serialized; none if it is something else.
    pub fn read(text: &str) -> Option<Node> {
        let mut reader = Reader { rest: text };
        let node = reader.value()?;
        reader.rest.is_empty().then_some(node)
    }

    /// All of it on one line.
    pub fn inline(&self) -> String {
        let joined = |parts: Vec<String>| parts.join(", ");
        let name = |name: &Option<String>| name.clone().unwrap_or_default();
        match self {
            Node::Atom(text) => text.clone(),
            Node::Fields(of, fields) => {
                let field = |(key, node): &(String, Node)| format!("{key}: {}", node.inline());
                format!(
                    "{}({})",
                    name(of),
                    joined(fields.iter().map(field).collect())
                )
            }
            Node::Tuple(of, items) => {
                format!(
                    "{}({})",
                    name(of),
                    joined(items.iter().map(Node::inline).collect())
                )
            }
            Node::List(items) => format!("[{}]", joined(items.iter().map(Node::inline).collect())),
        }
    }

    /// The field of this name, if there is one.
    pub fn field(&self, name: &str) -> Option<&Node> {
        let Node::Fields(_, fields) = self else {
            return None;
        };
        let found = fields.iter().find(|(key, _)| key == name);
        found.map(|(_, node)| node)
    }
}

struct Reader<'a> {
    rest: &'a str,
}

impl Reader<'_> {
    fn take(&mut self, c: char) -> bool {
        let stripped = self.rest.strip_prefix(c);
        self.rest = stripped.unwrap_or(self.rest);
        stripped.is_some()
    }

    /// A name or a number: up to the next punctuation.
    fn word(&mut self) -> String {
        let end = self.rest.find(['(', ')', '[', ']', '{', '}', ',', ':']);
        let (word, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
        self.rest = rest;
        word.trim().to_owned()
    }

    fn quoted(&mut self) -> Option<String> {
        let mut escaped = false;
        let end = self.rest.char_indices().skip(1).find(|(_, c)| {
            let ends = *c == '"' && !escaped;
            escaped = *c == '\\' && !escaped;
            ends
        })?;
        let (text, rest) = self.rest.split_at(end.0 + 1);
        self.rest = rest;
        Some(text.to_owned())
    }

    fn value(&mut self) -> Option<Node> {
        if self.rest.starts_with('"') {
            return self.quoted().map(Node::Atom);
        }
        if self.take('[') {
            return self.items(']').map(Node::List);
        }
        let word = self.word();
        if !self.take('(') {
            return (!word.is_empty()).then_some(Node::Atom(word));
        }
        let name = (!word.is_empty()).then_some(word);
        match self.key() {
            Some(key) => self.fields(key).map(|fields| Node::Fields(name, fields)),
            None => self.items(')').map(|items| Node::Tuple(name, items)),
        }
    }

    /// The name of a field, if one is here.
    fn key(&mut self) -> Option<String> {
        let end = self
            .rest
            .find(|c: char| !(c.is_alphanumeric() || c == '_'))?;
        let (key, rest) = self.rest.split_at(end);
        let rest = rest.strip_prefix(':')?;
        self.rest = rest;
        Some(key.to_owned())
    }

    fn fields(&mut self, first: String) -> Option<Vec<(String, Node)>> {
        let mut fields = vec![(first, self.value()?)];
        loop {
            self.take(',');
            if self.take(')') {
                return Some(fields);
            }
            let key = self.key()?;
            fields.push((key, self.value()?));
        }
    }

    fn items(&mut self, close: char) -> Option<Vec<Node>> {
        let mut items = Vec::new();
        while !self.take(close) {
            items.push(self.value()?);
            self.take(',');
        }
        Some(items)
    }
}
