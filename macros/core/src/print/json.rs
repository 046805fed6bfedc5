//! JSON: the structure of a document, with every formula as Unicode, LaTeX and MathML. Keys have a fixed order, so
//! that equal documents give equal bytes.

use super::document::{Block, Document, Inline, Remark, plain};
use super::formula::Formula;
use super::latex::{self, Dialect};
use super::{Page, mathml, unicode};

enum Value {
    Null,
    Number(usize),
    Text(String),
    List(Vec<Value>),
    Object(Vec<(&'static str, Value)>),
}

/// A whole document.
pub(super) fn document(page: &Page, document: &Document) -> String {
    let mut number = 0usize;
    let sections = document
        .sections
        .iter()
        .map(|section| {
            let blocks = section
                .blocks
                .iter()
                .map(|b| block(page, b, &mut number))
                .collect();
            Value::Object(vec![
                ("title", Value::Text(section.title.clone())),
                ("blocks", Value::List(blocks)),
            ])
        })
        .collect();
    let root = Value::Object(vec![
        ("title", Value::Text(document.title.clone())),
        (
            "warnings",
            Value::List(document.remarks.iter().map(remark).collect()),
        ),
        ("sections", Value::List(sections)),
    ]);
    let mut out = String::new();
    write(&root, 0, &mut out);
    out.push('\n');
    out
}

fn remark(remark: &Remark) -> Value {
    let help = remark.help.iter().cloned().map(Value::Text).collect();
    let (line, column) = remark.at;
    Value::Object(vec![
        ("topic", Value::Text(remark.topic.to_owned())),
        ("message", Value::Text(remark.message.clone())),
        ("help", Value::List(help)),
        ("line", Value::Number(line)),
        ("column", Value::Number(column)),
    ])
}

/// One formula.
pub(super) fn formula(page: &Page, f: &Formula) -> String {
    let mut out = String::new();
    write(&Value::Object(spellings(page, f)), 0, &mut out);
    out
}

fn spellings(page: &Page, f: &Formula) -> Vec<(&'static str, Value)> {
    let stacked = page.stacked(f);
    vec![
        ("unicode", Value::Text(unicode::line(&page.linear(f)))),
        (
            "latex",
            Value::Text(latex::line(&stacked, Dialect::Amsmath)),
        ),
        ("mathml", Value::Text(mathml::inline(page, f))),
    ]
}

fn block(page: &Page, block: &Block, number: &mut usize) -> Value {
    let kind = |name: &str| ("kind", Value::Text(name.to_owned()));
    match block {
        Block::Paragraph(parts) => {
            Value::Object(vec![kind("paragraph"), ("content", sentence(page, parts))])
        }
        Block::Equation {
            formula, tag, note, ..
        } => {
            *number += 1;
            let optional = |text: &Option<String>| text.clone().map_or(Value::Null, Value::Text);
            let mut fields = vec![
                kind("equation"),
                ("number", Value::Number(*number)),
                ("tag", optional(&tag.as_deref().map(plain))),
                ("note", optional(note)),
            ];
            fields.extend(spellings(page, formula));
            Value::Object(fields)
        }
        Block::List(items) => Value::Object(vec![
            kind("list"),
            (
                "items",
                Value::List(items.iter().map(|i| sentence(page, i)).collect()),
            ),
        ]),
        Block::Code(text) => Value::Object(vec![kind("code"), ("text", Value::Text(text.clone()))]),
    }
}

fn sentence(page: &Page, parts: &[Inline]) -> Value {
    let part = |part: &Inline| match part {
        Inline::Plain(words) | Inline::Notation { page: words, .. } => {
            Value::Object(vec![("text", Value::Text(words.clone()))])
        }
        Inline::Code(code) => Value::Object(vec![("code", Value::Text(code.clone()))]),
        Inline::Math(f) => Value::Object(spellings(page, f)),
        Inline::Reference { number, .. } => {
            Value::Object(vec![("reference", Value::Number(*number))])
        }
    };
    Value::List(parts.iter().map(part).collect())
}

fn write(value: &Value, indent: usize, out: &mut String) {
    let inner = indent + 2;
    let line = |out: &mut String, columns: usize| {
        out.push('\n');
        out.push_str(&" ".repeat(columns));
    };
    match value {
        Value::Null => out.push_str("null"),
        Value::Number(n) => out.push_str(&n.to_string()),
        Value::Text(text) => quote(text, out),
        Value::List(items) => {
            out.push('[');
            for (i, item) in items.iter().enumerate() {
                if i > 0 {
                    out.push(',');
                }
                line(out, inner);
                write(item, inner, out);
            }
            if !items.is_empty() {
                line(out, indent);
            }
            out.push(']');
        }
        Value::Object(fields) => {
            out.push('{');
            for (i, (key, field)) in fields.iter().enumerate() {
                if i > 0 {
                    out.push(',');
                }
                line(out, inner);
                quote(key, out);
                out.push_str(": ");
                write(field, inner, out);
            }
            if !fields.is_empty() {
                line(out, indent);
            }
            out.push('}');
        }
    }
}

fn quote(text: &str, out: &mut String) {
    out.push('"');
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\r' => out.push_str("\\r"),
            '\t' => out.push_str("\\t"),
            _ if c < ' ' => out.push_str(&format!("\\u{:04x}", u32::from(c))),
            _ => out.push(c),
        }
    }
    out.push('"');
}
