//! Where in a RON text the value at a dotted path stands.
//!
//! A path walks through struct fields, map keys and positions in lists and tuples: `interfaces.blocks.mu`,
//! `bodies.lower.mesh.max.2`. Names of structs and variants take no part in a path, and neither does the
//! parenthesis of a variant with one unnamed value (`Some(..)`, `Gravity((..))`), just as serde sees them.

use std::ops::Range;

use thiserror::Error;

/// Nesting beyond this is refused; ron itself stops at the same depth.
const MAX_DEPTH: usize = 128;

/// The text is not RON.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("expected {expected} at byte {offset}")]
#[non_exhaustive]
pub struct ScanError {
    /// What should stand there.
    pub expected: &'static str,
    /// Byte offset in the text.
    pub offset: usize,
}

/// A value of the text.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Node {
    /// Bytes of the value, name of struct or variant included.
    pub span: Range<usize>,
    /// What it is.
    pub kind: NodeKind,
}

/// Kinds of values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NodeKind {
    /// Number, string, char, unit, name without content.
    Scalar,
    /// `(name: value, ..)`, with or without a name in front. `open` is the byte after the parenthesis.
    Struct {
        /// Byte where a field can be inserted.
        open: usize,
        /// Fields in order: name, bytes of the name, value.
        fields: Vec<(String, Range<usize>, Node)>,
    },
    /// `{key: value, ..}`; a string key without its quotes.
    Map {
        /// Entries in order: key, bytes of the key, value.
        entries: Vec<(String, Range<usize>, Node)>,
    },
    /// `[..]` or `(..)` of unnamed values.
    Sequence(Vec<Node>),
    /// A variant with one unnamed value.
    Wrapped(Box<Node>),
}

/// The whole text as nested spans.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SpanTree {
    root: Node,
}

impl SpanTree {
    /// Scans a text that holds one RON value, with leading attributes and comments.
    ///
    /// # Errors
    /// The first place where the brackets, strings or separators are not RON. Numbers and names are not checked.
    pub fn scan(text: &str) -> Result<SpanTree, ScanError> {
        let mut scanner = Scanner { text, at: 0 };
        scanner.skip_attributes()?;
        let root = scanner.value(0)?;
        scanner.skip_space()?;
        if scanner.at < text.len() {
            return Err(scanner.expected("the end of the text"));
        }
        Ok(SpanTree { root })
    }

    /// The outermost value.
    pub fn root(&self) -> &Node {
        &self.root
    }

    /// The value at a path; the empty path is the outermost value.
    #[must_use]
    pub fn find(&self, path: &str) -> Option<&Node> {
        let (node, rest) = self.deepest(path);
        rest.is_empty().then_some(node)
    }

    /// Follows a path as far as the text goes: the last value reached, and the segments that the text lacks.
    pub fn deepest<'p>(&self, path: &'p str) -> (&Node, Vec<&'p str>) {
        let mut node = &self.root;
        let mut rest = path.split('.').filter(|s| !s.is_empty());
        while let Some(segment) = rest.next() {
            match node.child(segment) {
                Some(child) => node = child,
                None => return (node, std::iter::once(segment).chain(rest).collect()),
            }
        }
        (node, Vec::new())
    }

    /// Bytes of the name of a field or key at a path.
    #[must_use]
    pub fn find_key(&self, path: &str) -> Option<Range<usize>> {
        let (parent, last) = path.rsplit_once('.').unwrap_or(("", path));
        let parent = self.find(parent)?.content();
        let named = match &parent.kind {
            NodeKind::Struct { fields, .. } => fields,
            NodeKind::Map { entries } => entries,
            _ => return None,
        };
        named
            .iter()
            .find(|(name, ..)| name == last)
            .map(|(_, key, _)| key.clone())
    }

    /// Names that stand twice in one map or struct: dotted path and bytes of the second.
    pub(super) fn duplicates(&self) -> Vec<(String, Range<usize>)> {
        let mut found = Vec::new();
        self.root.duplicates("", &mut found);
        found
    }

    /// Every path of the text with its value, outer before inner.
    pub fn paths(&self) -> Vec<(String, &Node)> {
        let mut found = Vec::new();
        self.root.paths("", &mut found);
        found
    }
}

impl Node {
    /// The value inside `Some(..)` and other one-value variants.
    pub fn content(&self) -> &Node {
        match &self.kind {
            NodeKind::Wrapped(inner) => inner.content(),
            _ => self,
        }
    }

    fn child(&self, segment: &str) -> Option<&Node> {
        match &self.content().kind {
            NodeKind::Struct { fields: named, .. } | NodeKind::Map { entries: named } => named
                .iter()
                .find(|(name, ..)| name == segment)
                .map(|(.., node)| node),
            NodeKind::Sequence(items) => items.get(segment.parse::<usize>().ok()?),
            NodeKind::Scalar | NodeKind::Wrapped(_) => None,
        }
    }

    fn children(&self) -> Vec<(String, &Node)> {
        match &self.content().kind {
            NodeKind::Struct { fields: named, .. } | NodeKind::Map { entries: named } => named
                .iter()
                .map(|(name, _, node)| (name.clone(), node))
                .collect(),
            NodeKind::Sequence(items) => items
                .iter()
                .enumerate()
                .map(|(i, node)| (i.to_string(), node))
                .collect(),
            NodeKind::Scalar | NodeKind::Wrapped(_) => Vec::new(),
        }
    }

    fn paths<'a>(&'a self, prefix: &str, found: &mut Vec<(String, &'a Node)>) {
        for (name, node) in self.children() {
            let path = join(prefix, &name);
            found.push((path.clone(), node));
            node.paths(&path, found);
        }
    }

    fn duplicates(&self, prefix: &str, found: &mut Vec<(String, Range<usize>)>) {
        if let NodeKind::Struct { fields: named, .. } | NodeKind::Map { entries: named } =
            &self.content().kind
        {
            for (i, (name, key, _)) in named.iter().enumerate() {
                if named[..i].iter().any(|(earlier, ..)| earlier == name) {
                    found.push((join(prefix, name), key.clone()));
                }
            }
        }
        for (name, node) in self.children() {
            node.duplicates(&join(prefix, &name), found);
        }
    }
}

/// `a.b` of `a` and `b`; the other one when one is empty.
pub(super) fn join(prefix: &str, name: &str) -> String {
    match (prefix, name) {
        ("", alone) | (alone, "") => alone.to_owned(),
        _ => format!("{prefix}.{name}"),
    }
}

struct Scanner<'a> {
    text: &'a str,
    at: usize,
}

impl Scanner<'_> {
    fn expected(&self, expected: &'static str) -> ScanError {
        ScanError {
            expected,
            offset: self.at,
        }
    }

    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn eat(&mut self, token: &str) -> bool {
        let found = self.rest().starts_with(token);
        if found {
            self.at += token.len();
        }
        found
    }

    fn skip_while(&mut self, keep: impl Fn(char) -> bool) {
        let rest = self.rest();
        self.at += rest.find(|c| !keep(c)).unwrap_or(rest.len());
    }

    fn skip_space(&mut self) -> Result<(), ScanError> {
        loop {
            self.skip_while(char::is_whitespace);
            if self.eat("//") {
                self.skip_while(|c| c != '\n');
            } else if self.rest().starts_with("/*") {
                self.skip_block_comment()?;
            } else {
                return Ok(());
            }
        }
    }

    fn skip_block_comment(&mut self) -> Result<(), ScanError> {
        let mut depth = 0_usize;
        loop {
            if self.eat("/*") {
                depth += 1;
            } else if self.eat("*/") {
                depth -= 1;
                if depth == 0 {
                    return Ok(());
                }
            } else {
                let c = self
                    .peek()
                    .ok_or_else(|| self.expected("the end `*/` of a comment"))?;
                self.at += c.len_utf8();
            }
        }
    }

    fn skip_attributes(&mut self) -> Result<(), ScanError> {
        self.skip_space()?;
        while self.eat("#!") {
            self.skip_while(|c| c != ']');
            if !self.eat("]") {
                return Err(self.expected("the end `]` of an attribute"));
            }
            self.skip_space()?;
        }
        Ok(())
    }

    fn value(&mut self, depth: usize) -> Result<Node, ScanError> {
        self.skip_space()?;
        if depth > MAX_DEPTH {
            return Err(self.expected("less nesting"));
        }
        let start = self.at;
        let kind = match self.peek().ok_or_else(|| self.expected("a value"))? {
            '(' => self.parenthesis(depth, false)?,
            '[' => {
                self.at += 1;
                NodeKind::Sequence(self.items(']', depth)?)
            }
            '{' => {
                self.at += 1;
                self.map(depth)?
            }
            _ if self.string()?.is_some() => NodeKind::Scalar,
            '\'' => {
                self.character()?;
                NodeKind::Scalar
            }
            c if is_name_start(c) => self.named(depth)?,
            c if c.is_ascii_digit() || matches!(c, '+' | '-' | '.') => {
                self.skip_while(|c| c.is_alphanumeric() || matches!(c, '+' | '-' | '.' | '_'));
                NodeKind::Scalar
            }
            _ => return Err(self.expected("a value")),
        };
        Ok(Node {
            span: start..self.at,
            kind,
        })
    }

    /// A name, and its content when a parenthesis follows.
    fn named(&mut self, depth: usize) -> Result<NodeKind, ScanError> {
        self.name()?;
        let end = self.at;
        self.skip_space()?;
        if self.peek() == Some('(') {
            return self.parenthesis(depth, true);
        }
        self.at = end;
        Ok(NodeKind::Scalar)
    }

    fn name(&mut self) -> Result<String, ScanError> {
        let raw = self.eat("r#");
        let start = self.at;
        if !raw && !self.peek().is_some_and(is_name_start) {
            return Err(self.expected("a name"));
        }
        self.skip_while(|c| {
            c.is_alphanumeric() || c == '_' || (raw && matches!(c, '.' | '+' | '-'))
        });
        Ok(self.text[start..self.at].to_owned())
    }

    /// `(..)`: a struct when the first thing is a name and a colon, unnamed values otherwise.
    fn parenthesis(&mut self, depth: usize, named: bool) -> Result<NodeKind, ScanError> {
        self.at += 1;
        let open = self.at;
        self.skip_space()?;
        if self.is_field()? || (named && self.peek() == Some(')')) {
            self.at = open;
            let fields = self.entries(')', depth, Scanner::name)?;
            return Ok(NodeKind::Struct { open, fields });
        }
        if self.peek() == Some(')') {
            self.at += 1;
            return Ok(NodeKind::Struct {
                open,
                fields: Vec::new(),
            });
        }
        let mut items = self.items(')', depth)?;
        match items.pop() {
            Some(only) if named && items.is_empty() => Ok(NodeKind::Wrapped(Box::new(only))),
            last => {
                items.extend(last);
                Ok(NodeKind::Sequence(items))
            }
        }
    }

    fn is_field(&mut self) -> Result<bool, ScanError> {
        let back = self.at;
        let named = self.peek().is_some_and(is_name_start) && self.name().is_ok();
        self.skip_space()?;
        let field = named && self.peek() == Some(':');
        self.at = back;
        Ok(field)
    }

    fn items(&mut self, close: char, depth: usize) -> Result<Vec<Node>, ScanError> {
        let mut items = Vec::new();
        while !self.closes(close)? {
            items.push(self.value(depth + 1)?);
            self.separator(close)?;
        }
        Ok(items)
    }

    fn map(&mut self, depth: usize) -> Result<NodeKind, ScanError> {
        let entries = self.entries('}', depth, |scanner| {
            if let Some(key) = scanner.string()? {
                return Ok(key);
            }
            let key = scanner.value(MAX_DEPTH)?;
            Ok(scanner.text[key.span].to_owned())
        })?;
        Ok(NodeKind::Map { entries })
    }

    fn entries(
        &mut self,
        close: char,
        depth: usize,
        key: impl Fn(&mut Self) -> Result<String, ScanError>,
    ) -> Result<Vec<(String, Range<usize>, Node)>, ScanError> {
        let mut entries = Vec::new();
        while !self.closes(close)? {
            let start = self.at;
            let name = key(self)?;
            let span = start..self.at;
            self.skip_space()?;
            if !self.eat(":") {
                return Err(self.expected("`:`"));
            }
            entries.push((name, span, self.value(depth + 1)?));
            self.separator(close)?;
        }
        Ok(entries)
    }

    fn closes(&mut self, close: char) -> Result<bool, ScanError> {
        self.skip_space()?;
        Ok(self.eat(close.encode_utf8(&mut [0; 4])))
    }

    fn separator(&mut self, close: char) -> Result<(), ScanError> {
        self.skip_space()?;
        if self.eat(",") || self.peek() == Some(close) {
            return Ok(());
        }
        Err(self.expected("`,` or the closing bracket"))
    }

    /// A string literal of any kind, unquoted (escapes are kept as written); `None` when none starts here.
    fn string(&mut self) -> Result<Option<String>, ScanError> {
        let rest = self.rest();
        let prefix = ["br", "b", "r", ""].into_iter().find(|prefix| {
            rest.strip_prefix(prefix).is_some_and(|tail| {
                let hashes = if prefix.ends_with('r') {
                    tail.trim_start_matches('#')
                } else {
                    tail
                };
                hashes.starts_with('"')
            })
        });
        let Some(prefix) = prefix else {
            return Ok(None);
        };
        self.at += prefix.len();
        if prefix.ends_with('r') {
            self.raw_string().map(Some)
        } else {
            self.plain_string().map(Some)
        }
    }

    fn raw_string(&mut self) -> Result<String, ScanError> {
        let before = self.at;
        self.skip_while(|c| c == '#');
        let end = format!("\"{}", "#".repeat(self.at - before));
        let start = self.at + 1;
        let Some(length) = self.text[start..].find(&end) else {
            return Err(self.expected("the end of a raw string"));
        };
        self.at = start + length + end.len();
        Ok(self.text[start..start + length].to_owned())
    }

    fn plain_string(&mut self) -> Result<String, ScanError> {
        let start = self.at + 1;
        self.at = start;
        loop {
            self.skip_while(|c| c != '"' && c != '\\');
            if self.eat("\\") {
                let c = self.peek().ok_or_else(|| self.expected("an escape"))?;
                self.at += c.len_utf8();
            } else if self.eat("\"") {
                return Ok(self.text[start..self.at - 1].to_owned());
            } else {
                return Err(self.expected("the end `\"` of a string"));
            }
        }
    }

    fn character(&mut self) -> Result<(), ScanError> {
        self.at += 1;
        if self.eat("\\") && self.peek() == Some('\'') {
            self.at += 1;
        } else if let Some(c) = self.peek() {
            self.at += c.len_utf8();
        }
        self.skip_while(|c| c != '\'' && c != '\n');
        if self.eat("'") {
            Ok(())
        } else {
            Err(self.expected("the end `'` of a character"))
        }
    }
}

fn is_name_start(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}
