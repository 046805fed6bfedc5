//! Prints terms in mathematical notation: `Ω^T (J Ω^T - Ω J) Ω`. Brackets show the nesting, since some steps change
//! only the nesting.

use super::language::{Leaf, Term};
use clebsch_core::expr::Letter;
use clebsch_core::expr::symbol::Symbols;
use egg::{FlatTerm, Id, Language, RecExpr};

/// Precedence of a text: higher levels need fewer brackets.
const SUM: u8 = 0;
const TIMES: u8 = 1;
const POWER: u8 = 2;
const ATOM: u8 = 3;

/// The text of a term.
pub fn text(symbols: &Symbols, term: &FlatTerm<Term>) -> String {
    write(symbols, term).0
}

/// The text of a term given as a list of nodes.
pub fn whole(symbols: &Symbols, term: &RecExpr<Term>) -> String {
    fn from(term: &RecExpr<Term>, id: Id) -> FlatTerm<Term> {
        let node = term[id].clone();
        let children = node.children().iter().map(|c| from(term, *c)).collect();
        FlatTerm::new(node, children)
    }
    text(symbols, &from(term, term.root()))
}

/// The text of a leaf; a shifted letter shows its offset, as in `Λ[+1]`.
pub fn leaf(symbols: &Symbols, leaf: Leaf) -> String {
    match leaf {
        Leaf::Letter(at, _) => letter(symbols, at),
        Leaf::Constant(c) => c.to_string(),
        Leaf::Size(dim) => symbols.dim_text(dim),
        Leaf::Unit(_, axis) => format!("e{}", u32::from(axis) + 1),
    }
}

fn letter(symbols: &Symbols, at: Letter) -> String {
    let name = &symbols.get(at.symbol).name;
    match (at.shift.time, at.shift.label) {
        (0, [0, 0]) => name.clone(),
        (time, [0, 0]) => format!("{name}[{time:+}]"),
        (time, [a, b]) => format!("{name}[{time:+}; {a:+}, {b:+}]"),
    }
}

fn within(symbols: &Symbols, term: Option<&FlatTerm<Term>>, least: u8) -> String {
    let Some(term) = term else {
        return String::new();
    };
    let (text, binds) = write(symbols, term);
    if binds < least {
        format!("({text})")
    } else {
        text
    }
}

fn is_minus_one(term: Option<&FlatTerm<Term>>) -> bool {
    term.is_some_and(
        |t| matches!(t.node, Term::Number(q) if q.0 == clebsch_core::algebra::Rational::MINUS_ONE),
    )
}

fn write(symbols: &Symbols, term: &FlatTerm<Term>) -> (String, u8) {
    let first = term.children.first();
    let second = term.children.get(1);
    let part = |t, least| within(symbols, t, least);
    let function = |name: &str| (format!("{name}({})", part(first, SUM)), ATOM);
    match &term.node {
        Term::Number(q) if q.0.is_negative() => (q.to_string(), SUM),
        Term::Number(q) if q.0.denominator() != 1 => (q.to_string(), TIMES),
        Term::Number(q) => (q.to_string(), ATOM),
        Term::Leaf(l) => (leaf(symbols, *l), ATOM),
        Term::Sum(_) => {
            let head = part(first, TIMES);
            let opposite = second
                .filter(|t| matches!(t.node, Term::Scale(_)) && is_minus_one(t.children.first()));
            let tail = match (opposite, second) {
                (Some(t), _) => format!("- {}", part(t.children.get(1), TIMES)),
                (None, Some(t)) if matches!(t.node, Term::Sum(_)) => {
                    format!("+ {}", write(symbols, t).0)
                }
                (None, _) => format!("+ {}", part(second, TIMES)),
            };
            (format!("{head} {tail}"), SUM)
        }
        Term::Scale(_) if is_minus_one(first) => (format!("-{}", part(second, TIMES)), SUM),
        Term::Scale(_) | Term::Product(_) => {
            let right = second.is_some_and(|t| {
                core::mem::discriminant(&t.node) == core::mem::discriminant(&term.node)
            });
            let least = if right || matches!(term.node, Term::Scale(_)) {
                TIMES
            } else {
                POWER
            };
            (
                format!("{} {}", part(first, POWER), part(second, least)),
                TIMES,
            )
        }
        Term::Power(_) => (
            format!("{}^{}", part(first, ATOM), part(second, ATOM)),
            POWER,
        ),
        Term::Transpose(_) => (format!("{}^T", part(first, ATOM)), POWER),
        Term::Inverse(_) => (format!("{}^-1", part(first, ATOM)), POWER),
        Term::Trace(_) => function("tr"),
        Term::Det(_) => function("det"),
        Term::Dot(_) => (
            format!("dot({}, {})", part(first, SUM), part(second, SUM)),
            ATOM,
        ),
        Term::Cross(_) => (
            format!("{} x {}", part(first, POWER), part(second, POWER)),
            TIMES,
        ),
        Term::Hat(_) => function("hat"),
        Term::Vee(_) => function("vee"),
        Term::Symmetric(_) => function("sym"),
        Term::Skew(_) => function("skew"),
        Term::Diagonal(_) => function("diag"),
        Term::Exp(_) => function("exp"),
        Term::Log(_) => function("log"),
        Term::Identity(_) => ("Id".to_owned(), ATOM),
        Term::Zero(_) => ("0".to_owned(), ATOM),
    }
}
