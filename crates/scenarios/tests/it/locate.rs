//! The locator against texts whose spans are known because they were written piece by piece.

use proptest::prelude::*;
use scenarios::spec::SpanTree;

/// A value to write; names and keys are made unique by position.
#[derive(Clone, Debug)]
enum Value {
    Scalar(&'static str),
    Struct(&'static str, Vec<Value>),
    Map(Vec<Value>),
    List(Vec<Value>),
    Tuple(Vec<Value>),
    Wrapped(&'static str, Box<Value>),
}

fn values() -> impl Strategy<Value = Value> {
    let scalars = [
        "1",
        "-2.5e-3",
        ".5",
        "true",
        "Fixed",
        "\"a, b) // no comment\"",
        "\"quote \\\" inside\"",
        "'('",
        "'\\''",
        "r#\"raw \" ) string\"#",
        "r\"plain raw\"",
        "inf",
        "0x1F",
        "\"/* text */\"",
        "r#type",
    ];
    let leaf = prop::sample::select(scalars.to_vec()).prop_map(Value::Scalar);
    leaf.prop_recursive(4, 40, 5, |inner| {
        let some = || prop::collection::vec(inner.clone(), 0..5);
        let two = prop::collection::vec(inner.clone(), 2..5);
        let name = || prop::sample::select(vec!["", "Box", "r#struct"]);
        prop_oneof![
            (name(), some()).prop_map(|(name, items)| Value::Struct(name, items)),
            some().prop_map(Value::Map),
            some().prop_map(Value::List),
            two.prop_map(Value::Tuple),
            (prop::sample::select(vec!["Some", "Gravity"]), inner)
                .prop_map(|(name, item)| Value::Wrapped(name, Box::new(item))),
        ]
    })
}

/// Writes a value and notes the bytes of everything inside it.
struct Writer<'a> {
    text: String,
    spans: Vec<(String, std::ops::Range<usize>)>,
    gaps: &'a [&'static str],
    next: usize,
}

impl Writer<'_> {
    fn gap(&mut self) {
        self.next += 1;
        self.text += self.gaps[self.next % self.gaps.len()];
    }

    fn write(&mut self, value: &Value, path: &str) {
        match value {
            Value::Scalar(text) => self.text += text,
            Value::Struct(name, items) => {
                self.text += name;
                self.items('(', ')', items, path, |i| {
                    (format!("f{i}: "), format!("f{i}"))
                });
            }
            Value::Map(items) => self.items('{', '}', items, path, |i| {
                (format!("\"k{i}\" : "), format!("k{i}"))
            }),
            Value::List(items) => {
                self.items('[', ']', items, path, |i| (String::new(), i.to_string()))
            }
            Value::Tuple(items) => {
                self.items('(', ')', items, path, |i| (String::new(), i.to_string()))
            }
            Value::Wrapped(name, item) => {
                self.text += name;
                self.text.push('(');
                self.gap();
                self.write(item, path);
                self.gap();
                self.text.push(')');
            }
        }
    }

    fn items(
        &mut self,
        open: char,
        close: char,
        items: &[Value],
        path: &str,
        label: impl Fn(usize) -> (String, String),
    ) {
        self.text.push(open);
        for (i, item) in items.iter().enumerate() {
            self.gap();
            let (head, name) = label(i);
            self.text += &head;
            self.gap();
            let path = if path.is_empty() {
                name
            } else {
                format!("{path}.{name}")
            };
            let start = self.text.len();
            self.write(item, &path);
            self.spans.push((path, start..self.text.len()));
            self.gap();
            if i + 1 < items.len() || self.next.is_multiple_of(2) {
                self.text.push(',');
            }
        }
        self.gap();
        self.text.push(close);
    }
}

proptest! {
    #[test]
    fn every_value_is_found_where_it_was_written(
        value in values(),
        gaps in prop::sample::subsequence(vec!["", " ", "\n  ", " // (comment\n", "/* { /* nested */ \" */", "\t", "é".trim_matches('é')], 1..7),
    ) {
        let mut writer = Writer { text: String::new(), spans: Vec::new(), gaps: &gaps, next: 0 };
        writer.write(&value, "");
        let text = writer.text;
        let tree = SpanTree::scan(&text).map_err(|e| TestCaseError::fail(format!("{e}: {text}")))?;
        prop_assert_eq!(&tree.root().span, &(0..text.len()));
        for (path, span) in &writer.spans {
            let node = tree.find(path);
            prop_assert_eq!(node.map(|node| &node.span), Some(span), "{} in {}", path, text);
        }
        prop_assert_eq!(tree.paths().len(), writer.spans.len());
    }

    #[test]
    fn any_text_is_scanned_without_harm(text in "[(){}\\[\\]:,\"'#/*a-z0-9 \\\\\n]{0,40}") {
        if let Ok(tree) = SpanTree::scan(&text) {
            for (path, node) in tree.paths() {
                prop_assert!(text.get(node.span.clone()).is_some(), "{}", path);
            }
        }
    }
}

#[test]
fn keys_are_found_too() {
    let text = "(a: {\"b c\": (d: 1)})";
    let tree = SpanTree::scan(text).unwrap();
    assert_eq!(&text[tree.find_key("a.b c").unwrap()], "\"b c\"");
    assert_eq!(&text[tree.find_key("a.b c.d").unwrap()], "d");
    assert!(tree.find("a.b c.e").is_none());
    let (node, missing) = tree.deepest("a.b c.e.f");
    assert_eq!(
        (&text[node.span.clone()], missing),
        ("(d: 1)", vec!["e", "f"])
    );
}

#[test]
fn attributes_before_the_value_are_passed_over() {
    let text = "#![enable(implicit_some)]\n// note\n(a: 1)";
    let tree = SpanTree::scan(text).unwrap();
    assert_eq!(&text[tree.find("a").unwrap().span.clone()], "1");
}

#[test]
fn deep_nesting_is_refused_not_fatal() {
    let text = format!("{}{}", "[".repeat(100_000), "]".repeat(100_000));
    assert!(SpanTree::scan(&text).is_err());
}
