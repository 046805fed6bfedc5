//! Expressions: a Pratt parser with the precedence of mathematics, lowest first: `+ -`, then `* /` and
//! juxtaposition, then unary `-`, then postfix `^T ^-1 ^number [i] [i, j]`. Expressions that could be read in two
//! ways are errors, see [`ambiguous`].

mod ambiguous;

use super::ast::{Expression, Kind};
use super::token::{Cursor, Token};
use super::unknown;
use crate::algebra::Rational;
use crate::diagnostic::Diagnostic;
use crate::expr::Constant;

/// Words that end an expression, since the statement continues with them.
const FOLLOWING: [&str; 4] = ["at", "on", "periodic", "in"];

/// The maximum number of transposes and powers of one operand.
const MOST_POSTFIXES: usize = 16;

/// The largest absolute value of an exponent.
const LARGEST_EXPONENT: i64 = 256;

type Parsed = Result<Expression, Diagnostic>;

/// Parses one expression.
pub fn expression(c: &mut Cursor) -> Parsed {
    let mut terms = Vec::new();
    let mut minus = false;
    loop {
        terms.push((minus, product(c)?));
        // `->` and similar signs are not sums.
        if c.is_punct('-') && matches!(c.peek_at(1), Some(Token::Punct('>', _))) {
            break;
        }
        if c.take_punct('+') {
            minus = false;
        } else if c.take_punct('-') {
            minus = true;
        } else {
            break;
        }
    }
    if terms.len() == 1
        && let Some((false, only)) = terms.pop()
    {
        return Ok(only);
    }
    let place = match (terms.first(), terms.last()) {
        (Some(a), Some(b)) => a.1.place.to(b.1.place),
        _ => c.place(),
    };
    Ok(Expression {
        kind: Kind::Sum(terms),
        place,
    })
}

fn starts_operand(c: &Cursor) -> bool {
    match c.peek() {
        Some(Token::Name(n)) => !FOLLOWING.contains(&n.as_str()) && !c.starts_statement(),
        Some(Token::Number(_) | Token::Glued(..)) => true,
        Some(Token::Open(d)) => *d == '(',
        Some(Token::Literal(_) | Token::Punct(..) | Token::Close(_)) | None => false,
    }
}

fn product(c: &mut Cursor) -> Parsed {
    let mut opened = matches!(c.peek(), Some(Token::Open('(')));
    let mut factors = vec![signed(c)?];
    loop {
        if c.take_punct('*') {
            opened = matches!(c.peek(), Some(Token::Open('(')));
            factors.push(signed(c)?);
        } else if c.take_punct('/') {
            let numerator = joined(factors);
            let divisor = signed(c)?;
            if starts_operand(c) {
                return Err(ambiguous::after_divisor(c, &divisor));
            }
            let place = numerator.place.to(divisor.place);
            factors = vec![Expression {
                kind: Kind::Quotient(Box::new(numerator), Box::new(divisor)),
                place,
            }];
        } else if starts_operand(c) {
            if let Some(error) = ambiguous::after_factor(c, factors.last(), opened) {
                return Err(error);
            }
            opened = matches!(c.peek(), Some(Token::Open('(')));
            factors.push(postfix(c)?);
        } else {
            return Ok(joined(factors));
        }
    }
}

fn joined(mut factors: Vec<Expression>) -> Expression {
    if factors.len() == 1
        && let Some(only) = factors.pop()
    {
        return only;
    }
    let place = match (factors.first(), factors.last()) {
        (Some(a), Some(b)) => a.place.to(b.place),
        // `product` never joins an empty list.
        _ => crate::diagnostic::Place::token(proc_macro2::Span::call_site()),
    };
    Expression {
        kind: Kind::Product(factors),
        place,
    }
}

fn signed(c: &mut Cursor) -> Parsed {
    let start = c.place();
    let mut minus = false;
    loop {
        if c.take_punct('-') {
            minus = !minus;
        } else if !c.take_punct('+') {
            break;
        }
    }
    let inner = postfix(c)?;
    if !minus {
        return Ok(inner);
    }
    let place = start.to(inner.place);
    Ok(Expression {
        kind: Kind::Neg(Box::new(inner)),
        place,
    })
}

fn postfix(c: &mut Cursor) -> Parsed {
    let mut e = operand(c)?;
    let mut count = 0;
    loop {
        let component = matches!(c.peek(), Some(Token::Open('[')));
        if !component && !c.is_punct('^') {
            break;
        }
        count += 1;
        if count > MOST_POSTFIXES {
            return Err(c.unexpected("fewer than 16 postfixes on one operand"));
        }
        c.advance();
        let kind = if component {
            Kind::Component(Box::new(e.clone()), indices(c)?)
        } else if c.take_word("T") {
            Kind::Transpose(Box::new(e.clone()))
        } else {
            let q = exponent(c)?;
            if let Some(error) = ambiguous::after_exponent(c, &e, q) {
                return Err(error);
            }
            Kind::Power(Box::new(e.clone()), q)
        };
        let place = e.place.to(c.last_place());
        e = Expression { kind, place };
    }
    if let Some(Token::Punct('\'', _)) = c.peek() {
        return Err(c.unexpected("an operator").help(super::characters::PRIME));
    }
    let remedy = match c.peek() {
        Some(Token::Open('{')) => {
            "indices are not written out: write `next(q)` for the next node in time, `next(q, i)` for the next site along a \
             label `i`"
        }
        Some(Token::Punct('%', _)) => "write a comment after `//`; the language has no remainder",
        _ => return Ok(e),
    };
    Err(c.unexpected("an operator").help(remedy))
}

/// After `[`: one or two indices, counted from 1.
fn indices(c: &mut Cursor) -> Result<Vec<u64>, Diagnostic> {
    let remedy = "components are counted from 1: write `v[1]` for a vector, `A[1, 2]` for a matrix";
    let mut list = Vec::new();
    loop {
        let label = match c.peek() {
            Some(Token::Name(n)) => Some(n.clone()),
            _ => None,
        };
        list.push(c.whole_number().map_err(|e| match label {
            Some(i) if c.is_indexed_otherwise(&i) => {
                let message = "sums over pairs of sites are not supported yet";
                Diagnostic::new(e.place, message).help(unknown::PAIRS)
            }
            Some(_) => e.help(remedy).help(
                "write `q` at the site itself, `next(q, i)` or `prev(q, i)` at a neighbour along a \
                label `i`, and `next(q)` at the next node in time",
            ),
            None => e.help(remedy),
        })?);
        if !c.take_punct(',') {
            break;
        }
    }
    c.delimiter(']').map_err(|e| e.help(remedy))?;
    Ok(list)
}

/// After `^`: a number, `-1`, or a fraction in parentheses.
fn exponent(c: &mut Cursor) -> Result<Rational, Diagnostic> {
    let start = c.place();
    let value = signed_exponent(c)?;
    let size = match value.is_negative() {
        true => value.negated(),
        false => value,
    };
    if size > Rational::integer(LARGEST_EXPONENT) {
        let message = format!("exponents range from -{LARGEST_EXPONENT} to {LARGEST_EXPONENT}");
        let remedy = "write `exp(p*log(x))` for positive x, where `p` may be a parameter; otherwise write a product of smaller \
            powers";
        return Err(Diagnostic::new(start.to(c.last_place()), message).help(remedy));
    }
    Ok(value)
}

fn signed_exponent(c: &mut Cursor) -> Result<Rational, Diagnostic> {
    let parenthesis = c.take_delimiter('(');
    let minus = c.take_punct('-');
    let mut value = match c.peek() {
        Some(Token::Number(text)) => {
            let value = rational(text).ok_or_else(|| too_large(c))?;
            c.advance();
            value
        }
        Some(Token::Glued(number, name)) => return Err(ambiguous::glued(c, number, name)),
        _ => {
            return Err(c.unexpected("`T`, `-1` or a number after `^`").help(
                "write `x^T` for the transpose, `x^-1` for the inverse, `x^2` and `x^(1/2)` for powers, `exp(a*log(x))` for \
                 other powers, and `exp(x)`",
            ));
        }
    };
    if minus {
        value = value.negated();
    }
    if parenthesis {
        if c.take_punct('/') {
            let bottom = match c.peek() {
                Some(Token::Number(text)) => rational(text).and_then(Rational::inverse),
                _ => None,
            };
            value = bottom
                .and_then(|b| value.times(b))
                .ok_or_else(|| c.unexpected("a non-zero number"))?;
            c.advance();
        }
        c.delimiter(')').map_err(|e| {
            e.help("an exponent is a number: for positive x write `exp(p*log(x))` for the power p")
        })?;
    }
    Ok(value)
}

fn too_large(c: &Cursor) -> Diagnostic {
    Diagnostic::new(
        c.place(),
        "this exponent is too large or has too many digits for exact arithmetic",
    )
    .help("write the power with `exp` and `log`")
}

/// Numbers with at most this numerator and denominator are exact; products and powers of them fit into 37 digits.
const EXACT: i128 = 1_000_000;

/// The value of a decimal literal; `None` if it is infinite.
fn number(text: &str) -> Option<Kind> {
    let exact = rational(text);
    let is_small = |q: &Rational| q.numerator() <= EXACT && q.denominator() <= EXACT;
    match exact.filter(is_small) {
        Some(q) => Some(Kind::Number(q)),
        None => Constant::parse(&text.replace('_', "")).map(Kind::Constant),
    }
}

/// The exact value of a decimal literal.
fn rational(text: &str) -> Option<Rational> {
    let text = text.replace('_', "");
    let (mantissa, exponent) = match text.find(['e', 'E']) {
        Some(i) => (&text[..i], text[i + 1..].parse::<i32>().ok()?),
        None => (text.as_str(), 0),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = format!("{whole}{fraction}");
    if digits.len() > 30 {
        return None;
    }
    let value = Rational::new(digits.parse::<i128>().ok()?, 1)?;
    let shift = exponent.checked_sub(i32::try_from(fraction.len()).ok()?)?;
    if !(-30..=30).contains(&shift) {
        return None;
    }
    value.times(Rational::integer(10).power(shift)?)
}

fn operand(c: &mut Cursor) -> Parsed {
    let start = c.place();
    match c.peek().cloned() {
        Some(Token::Number(text)) => {
            let kind = number(&text).ok_or_else(|| {
                let message =
                    "a number must be between 5e-324 and 1.8e308, the range of double precision";
                Diagnostic::new(c.place(), message).help("change the units")
            })?;
            c.advance();
            Ok(Expression { kind, place: start })
        }
        Some(Token::Glued(number, name)) => Err(ambiguous::glued(c, &number, &name)),
        Some(Token::Open('(')) => {
            c.advance();
            let mut inner = expression(c)?;
            if c.is_punct(',') {
                return Err(c.unexpected("`)`").help(unknown::VECTOR));
            }
            c.delimiter(')')?;
            inner.place = start.to(c.last_place());
            Ok(inner)
        }
        Some(Token::Name(_)) => {
            let name = c.name("a name")?;
            // `check`, which knows the declarations, decides whether the name is a function.
            if !matches!(c.peek(), Some(Token::Open('('))) {
                return Ok(Expression {
                    place: name.place,
                    kind: Kind::Name(name.text),
                });
            }
            c.advance();
            let mut arguments = Vec::new();
            while !c.take_delimiter(')') {
                if !arguments.is_empty() && !c.take_punct(',') {
                    let told = unknown::ends_expression(c).or_else(|| c.unclosed());
                    return Err(told.unwrap_or_else(|| c.unexpected("`,` or `)`")));
                }
                arguments.push(expression(c)?);
            }
            Ok(Expression {
                kind: Kind::Call(name, arguments),
                place: start.to(c.last_place()),
            })
        }
        _ => Err(unknown::instead_of_operand(c)),
    }
}
