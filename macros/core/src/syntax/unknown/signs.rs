//! Signs that do not occur in expressions: comparisons, dots, lists.

use super::super::token::{Cursor, SIZES, Token};
use super::{MODULES, function};
use crate::diagnostic::{Diagnostic, closest};
use crate::syntax::FUNCTIONS;

/// The advice for vectors.
pub(in crate::syntax) const VECTOR: &str =
    "write a vector in unit vectors, `a*E1 + b*E2`, or declare it, `param v: Vec<3>;`";

/// The error for a sign after which an expression cannot continue.
pub(in crate::syntax) fn ends_expression(c: &Cursor) -> Option<Diagnostic> {
    let sign = comparison(c).or_else(|| point(c)).or_else(|| product(c));
    sign.or_else(|| {
        let error = c.is_word("in").then(|| c.unexpected("an operator"))?;
        Some(error.help("the language has no loops: the Lagrangian is summed over the sites of its label, `label i in 0..N;`"))
    })
}

/// The advice for a sign in place of the `;` of a statement.
pub(in crate::syntax) fn ends_statement(c: &Cursor) -> &'static str {
    match c.peek() {
        Some(Token::Open('(')) => SIZES,
        Some(Token::Punct(',', _)) if matches!(c.peek_at(2), Some(Token::Punct(':', _))) => {
            "one statement declares names of one shape, `param a, b: Real;`: write another statement for another shape"
        }
        Some(Token::Punct('^', _)) => {
            "put the expression of a function in quotes, `= \"x^2\"`; the shape of a vector with three components is `Vec<3>`"
        }
        Some(Token::Punct('=', _)) => "values belong in the case, not in the model",
        Some(Token::Punct('#', _)) => "write a comment after `//`",
        Some(Token::Punct(':', _)) => {
            "end every statement with `;`; to declare a function of the position, write `given V(Real): Real = \"k*x^2/2\";`"
        }
        _ => "end every statement with `;`",
    }
}

/// The error for a sign in place of a quantity.
pub(in crate::syntax) fn instead_of_operand(c: &Cursor) -> Diagnostic {
    let error = c.unexpected("a quantity, a number or `(`");
    match c.peek() {
        Some(Token::Punct('|', _)) => error.help(
            "the length of a vector is `sqrt(dot(X, X))`, the magnitude of a number `abs(x)`",
        ),
        Some(Token::Punct('*', _)) => error.help("write a power as `a^2`"),
        Some(Token::Punct('=', _)) => error.help("write one `=` before the expression"),
        Some(Token::Open('[')) => error.help(VECTOR),
        _ => error,
    }
}

/// `x > 0`, `x == 0`, `x != 0`: expressions do not have cases.
fn comparison(c: &Cursor) -> Option<Diagnostic> {
    let doubled = matches!(c.peek_at(1), Some(Token::Punct('=', _)));
    let sign = match c.peek() {
        Some(Token::Punct(sign @ ('<' | '>'), _)) if doubled => format!("{sign}="),
        Some(Token::Punct(sign @ ('<' | '>'), _)) => sign.to_string(),
        Some(Token::Punct(sign @ ('=' | '!'), _)) if doubled => format!("{sign}="),
        _ => return None,
    };
    let message = format!(
        "expressions cannot contain the comparison `{sign}`: piecewise potentials are not supported yet"
    );
    Some(Diagnostic::new(c.place(), message).help(
        "use `abs` and `sign`: `(x + abs(x))/2` is x where x > 0 and 0 elsewhere, `(1 + sign(x))/2` is 1 or 0",
    ))
}

/// `x.dot(y)`, `np.sin(q)`, `x.T`, `x.z`.
fn point(c: &Cursor) -> Option<Diagnostic> {
    let (Some(Token::Punct('.', _)), Some(Token::Name(after))) = (c.peek(), c.peek_at(1)) else {
        let error = c.unexpected("an operator");
        return c
            .is_punct('.')
            .then(|| error.help("write a component of a vector as `x[1]`, counted from 1"));
    };
    let before = match c.before() {
        Some(Token::Name(name)) => name.as_str(),
        _ => "x",
    };
    let called = matches!(c.peek_at(2), Some(Token::Open('(')));
    let whole = format!("`{before}.{after}`: names contain no dots");
    let d = Diagnostic::new(c.place(), whole);
    let component = ["x", "y", "z"].iter().position(|n| n == after);
    let help = match after.as_str() {
        _ if MODULES.contains(&before) => match function(after) {
            _ if FUNCTIONS.contains(&after.as_str()) => {
                format!("functions need no module: write `{after}(...)`")
            }
            Some(written) => written.to_owned(),
            None if after == "pi" => "write `pi`".to_owned(),
            None if MODULES.contains(&after.as_str()) => {
                "functions need no module: the length of a vector x is `sqrt(dot(x, x))`, the inverse of a matrix `inv(A)`".to_owned()
            }
            None => match closest(after, FUNCTIONS) {
                Some(near) => format!("functions need no module: did you mean `{near}`?"),
                None => format!("functions: {}", crate::syntax::AVAILABLE),
            },
        },
        "T" => format!("write the transpose as `{before}^T`"),
        "dot" if !called => format!("write a rate of change as `(next({before}) - {before})/h`"),
        "dot" | "cross" => format!("write `{after}({before}, ...)`"),
        "norm" if called => format!("the length of a vector is `sqrt(dot({before}, {before}))`"),
        _ if called && FUNCTIONS.contains(&after.as_str()) => format!("write `{after}({before})`"),
        _ => format!(
            "write a component of a vector as `{before}[{}]`, counted from 1",
            component.map_or(1, |i| i + 1)
        ),
    };
    Some(d.help(help))
}

/// The error for `A @ b`.
fn product(c: &Cursor) -> Option<Diagnostic> {
    let Some(Token::Punct('@', _)) = c.peek() else {
        return None;
    };
    let error = c.unexpected("an operator");
    Some(error.help("write `A*b` for a matrix times a vector or a matrix, `dot(a, b)` for the scalar product of vectors"))
}
