//! Takes expressions apart and assembles them: signs, factors, quotients, and the words by which they are compared.

use crate::expression::{Expression, Kind};

/// A list of factors, with products replaced by their factors.
pub fn flat(list: &[Expression]) -> Vec<Expression> {
    let each = list.iter().flat_map(|f| match &f.kind {
        Kind::Product(inner) => flat(inner),
        _ => vec![f.clone()],
    });
    each.collect()
}

/// An expression of this kind.
pub fn of_kind(kind: Kind) -> Expression {
    Expression { kind }
}

/// A quotient.
pub fn quotient(top: Expression, bottom: &Expression) -> Expression {
    of_kind(Kind::Quotient(Box::new(top), Box::new(bottom.clone())))
}

/// The expression, or its opposite.
pub fn with_sign(e: Expression, minus: bool) -> Expression {
    match (minus, e.kind) {
        (true, Kind::Neg(inner)) => *inner,
        (true, kind) => of_kind(Kind::Neg(Box::new(of_kind(kind)))),
        (false, kind) => of_kind(kind),
    }
}

/// Whether an expression has a minus sign, and the expression without its sign.
pub fn without_sign(e: &Expression) -> (bool, &Expression) {
    match &e.kind {
        Kind::Neg(inner) => {
            let (minus, plain) = without_sign(inner);
            (!minus, plain)
        }
        _ => (false, e),
    }
}

/// The words of an expression, without shifts in time.
pub fn words(e: &Expression) -> String {
    let head = match &e.kind {
        Kind::Call(f, list) if f == "next" && list.len() == 1 => {
            return list.iter().map(words).collect();
        }
        Kind::Number(a, b) => format!("{a}/{b}"),
        Kind::Constant(c) => c.to_string(),
        Kind::Name(n) => n.clone(),
        Kind::Sum(terms) => terms
            .iter()
            .map(|(minus, _)| if *minus { '-' } else { '+' })
            .collect(),
        Kind::Product(_) => "*".to_owned(),
        Kind::Quotient(..) => "/".to_owned(),
        Kind::Neg(_) => "neg".to_owned(),
        Kind::Transpose(_) => "^T".to_owned(),
        Kind::Power(_, a, b) => format!("^{a}/{b}"),
        Kind::Call(f, _) => f.clone(),
        Kind::Component(_, at) => format!("{at:?}"),
        Kind::Shaped(..) => ":".to_owned(),
    };
    let parts: Vec<String> = e.parts().into_iter().map(words).collect();
    format!("{head}({})", parts.join(", "))
}
