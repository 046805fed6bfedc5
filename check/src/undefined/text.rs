//! An expression as text of the model. Takes the tree; gives text with as few parentheses as its meaning allows.

use crate::expression::{Expression, Kind};

/// The precedence of an expression.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
enum Strength {
    Sum,
    Product,
    Power,
    Atom,
}

/// The text.
pub(super) fn of(e: &Expression) -> String {
    written(e).0
}

/// In parentheses if its precedence is lower than `least`.
fn within(e: &Expression, least: Strength) -> String {
    let (text, strength) = written(e);
    match strength < least {
        true => format!("({text})"),
        false => text,
    }
}

fn written(e: &Expression) -> (String, Strength) {
    let list = |all: &[Expression]| all.iter().map(of).collect::<Vec<_>>().join(", ");
    match &e.kind {
        Kind::Number(a, 1) => (a.to_string(), Strength::Atom),
        Kind::Number(a, b) => (format!("{a}/{b}"), Strength::Product),
        Kind::Constant(c) => (c.to_string(), Strength::Atom),
        Kind::Name(n) => (n.clone(), Strength::Atom),
        Kind::Shaped(a, ..) => written(a),
        Kind::Sum(terms) => {
            let mut text = String::new();
            for (n, (minus, t)) in terms.iter().enumerate() {
                text.push_str(match (n, minus) {
                    (0, false) => "",
                    (0, true) => "-",
                    (_, false) => " + ",
                    (_, true) => " - ",
                });
                text.push_str(&within(t, Strength::Product));
            }
            (text, Strength::Sum)
        }
        Kind::Product(all) => {
            let factors: Vec<String> = all.iter().map(|f| within(f, Strength::Product)).collect();
            (factors.join("*"), Strength::Product)
        }
        Kind::Quotient(a, b) => {
            let (a, b) = (within(a, Strength::Product), within(b, Strength::Power));
            (format!("{a}/{b}"), Strength::Product)
        }
        Kind::Neg(a) => (format!("-{}", within(a, Strength::Product)), Strength::Sum),
        Kind::Transpose(a) => (format!("{}^T", within(a, Strength::Atom)), Strength::Power),
        Kind::Power(a, above, below) => {
            let power = match (*below, *above < 0) {
                (1, false) => above.to_string(),
                (1, true) => format!("({above})"),
                _ => format!("({above}/{below})"),
            };
            (
                format!("{}^{power}", within(a, Strength::Atom)),
                Strength::Power,
            )
        }
        // A component is parsed as a product with a unit vector.
        Kind::Call(f, all) if f == "dot" && component(all).is_some() => {
            (component(all).unwrap_or_default(), Strength::Atom)
        }
        Kind::Call(f, all) => (format!("{f}({})", list(all)), Strength::Atom),
        Kind::Component(a, at) => {
            let at: Vec<String> = at.iter().map(u64::to_string).collect();
            let text = format!("{}[{}]", within(a, Strength::Atom), at.join(", "));
            (text, Strength::Atom)
        }
    }
}

/// `x[1]` of `dot(x, E1)`.
fn component(all: &[Expression]) -> Option<String> {
    let [a, unit] = all else { return None };
    let Kind::Name(name) = &unit.kind else {
        return None;
    };
    let number: u64 = name.strip_prefix('E')?.parse().ok()?;
    Some(format!("{}[{number}]", within(a, Strength::Atom)))
}
