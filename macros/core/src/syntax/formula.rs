//! Functions that are given by what they are: `given b(Vec<2>): Real = "A*cos(2*pi*x/L)";`. Takes a model as it was
//! written; gives the same with each call replaced by the expression at its argument, so that the engine differentiates it.

use super::ast::{Expression, Kind, Kindred, Model, Name, Statement};
use super::token::{Cursor, Token};
use crate::algebra::Rational;
use crate::diagnostic::{Diagnostic, Errors, Place};

const ONLY: &str =
    "a function that is written out takes one number or vector of known size, and gives one";
const OTHERWISE: &str = "give functions of matrices or of several arguments by a path of Rust; x, y, z are the components of the argument in `given b(Vec<2>): Real = \"x*y\";`";

/// The components of a vector by letters, as a paper calls the place.
const LETTERS: [&str; 3] = ["x", "y", "z"];

/// The ratio of a circle to its diameter: the shortest fraction whose quotient is that of a double. Exact arithmetic holds its
/// fourth power.
pub const PI: (i128, i128) = (245_850_922, 78_256_779);

/// After `=`: one expression in quotes, or a list of them for the components of a vector; nothing where a path follows.
pub(super) fn components(c: &mut Cursor) -> Result<Vec<(String, Expression)>, Diagnostic> {
    if !c.take_delimiter('[') {
        let is_text = matches!(c.peek(), Some(Token::Literal(t)) if t.ends_with('"'));
        return match is_text {
            true => Ok(vec![quoted(c)?]),
            false => Ok(Vec::new()),
        };
    }
    let mut list = vec![quoted(c)?];
    while c.take_punct(',') {
        list.push(quoted(c)?);
    }
    c.delimiter(']')?;
    Ok(list)
}

fn quoted(c: &mut Cursor) -> Result<(String, Expression), Diagnostic> {
    let place = c.place();
    let Some(Token::Literal(text)) = c.peek() else {
        return Err(c
            .unexpected("an expression in quotes")
            .help("a component is written in quotes, for example `[\"-f*y/2\", \"f*x/2\"]`"));
    };
    let text = super::statement::unquoted(text);
    c.advance();
    match read(&text) {
        Ok(e) => Ok((text, at(&e, place))),
        Err(errors) => {
            let said = errors.to_string();
            let first = said.lines().next().unwrap_or_default();
            Err(Diagnostic::new(
                place,
                format!("in this expression: {first}"),
            ))
        }
    }
}

/// An expression in quotes; `pi` is the number.
fn read(text: &str) -> Result<Expression, Errors> {
    let parsed = super::expression(text)?;
    let number = Rational::new(PI.0, PI.1);
    Ok(mapped(&parsed, &|e| match (&e.kind, number) {
        (Kind::Name(n), Some(q)) if n == "pi" || n == "π" => Some(Expression {
            kind: Kind::Number(q),
            place: e.place,
        }),
        _ => None,
    }))
}

/// The same expression, all of it at one place.
fn at(e: &Expression, place: Place) -> Expression {
    let mut e = mapped(e, &|_| None);
    set(&mut e, place);
    e
}

fn set(e: &mut Expression, place: Place) {
    e.place = place;
    if let Kind::Call(name, _) = &mut e.kind {
        name.place = place;
    }
    children(e, &mut |child| set(child, place));
}

/// How such functions are stated, without the word that ends a statement.
pub fn stated(model: &Model) -> Vec<String> {
    let kind = |k: &Kindred| match k.components() {
        Some(n) if k.name.text == "Vec" => format!("Vec<{n}>"),
        _ => k.name.text.clone(),
    };
    let of = |s: &Statement| match s {
        Statement::Given {
            name,
            arguments,
            value,
            texts,
            by_case,
            ..
        } if !texts.is_empty() => {
            let arguments: Vec<String> = arguments.iter().map(kind).collect();
            let quoted: Vec<String> = texts.iter().map(|t| format!("{t:?}")).collect();
            let list = match quoted.as_slice() {
                [only] => only.clone(),
                all => format!("[{}]", all.join(", ")),
            };
            let case = if by_case.is_some() { "case " } else { "" };
            Some(format!(
                "given {}({}): {} = {case}{list}",
                name.text,
                arguments.join(", "),
                kind(value)
            ))
        }
        _ => None,
    };
    model.statements.iter().filter_map(of).collect()
}

/// A function that the case gives, before it is given.
#[derive(Clone, Debug)]
pub struct Open {
    /// Its name.
    pub name: Name,
    /// What it takes, a number or a vector.
    pub argument: Kindred,
    /// How many components it has.
    pub components: usize,
    /// Whether what it is stands there already.
    pub is_filled: bool,
    /// Line and column of the word `case` in the text, from 1.
    pub at: Option<(usize, usize)>,
}

/// The functions of a model that the case gives.
///
/// # Errors
/// One that takes or gives what no expression can.
pub fn open(model: &Model) -> Result<Vec<Open>, Diagnostic> {
    let mut all = Vec::new();
    for statement in &model.statements {
        let Statement::Given {
            name,
            arguments,
            value,
            by_case: Some(word),
            components: filled,
            ..
        } = statement
        else {
            continue;
        };
        let one = match arguments.as_slice() {
            [argument] => argument.components().map(|_| argument),
            _ => None,
        };
        let (Some(argument), Some(components)) = (one, value.components()) else {
            return Err(Diagnostic::new(name.place, ONLY).help(OTHERWISE));
        };
        all.push(Open {
            name: name.clone(),
            argument: argument.clone(),
            components,
            is_filled: !filled.is_empty(),
            at: word.line_and_column(),
        });
    }
    Ok(all)
}

/// Whether a text is an expression in the components of such an argument; what is wrong of it otherwise. `known` are the names
/// that it may hold beside them.
///
/// # Errors
/// What cannot be read, or the first name that is not known.
pub fn check(text: &str, argument: &Kindred, known: &dyn Fn(&str) -> bool) -> Result<(), String> {
    let parsed = read(text).map_err(|errors| {
        let said = errors.to_string();
        said.lines().next().unwrap_or_default().to_owned()
    })?;
    let names = names(argument);
    let mut unknown = None;
    each(&parsed, &mut |e| {
        if let Kind::Name(n) = &e.kind {
            let own = names.iter().flatten().any(|own| own == n);
            if !own && !known(n) {
                unknown.get_or_insert_with(|| n.clone());
            }
        }
    });
    match unknown {
        None => Ok(()),
        Some(n) => {
            let own: Vec<&str> = names
                .iter()
                .filter_map(|n| n.first().map(String::as_str))
                .collect();
            Err(format!(
                "`{n}` is not known here: the argument is {}, and parameters of the model and `pi` may stand beside",
                own.join(", ")
            ))
        }
    }
}

/// What each component of the argument may be called.
fn names(argument: &Kindred) -> Vec<Vec<String>> {
    let n = argument.components().unwrap_or(0);
    (0..n)
        .map(|i| {
            let letter = LETTERS.get(i).filter(|_| n <= 3);
            let numbered = (argument.name.text != "Real").then(|| format!("x{}", i + 1));
            letter
                .map(|l| (*l).to_owned())
                .into_iter()
                .chain(numbered)
                .collect()
        })
        .collect()
}

/// A function with its components.
struct Formula<'a> {
    name: &'a Name,
    argument: &'a Kindred,
    components: &'a [Expression],
}

impl Formula<'_> {
    /// Its value where it is called.
    fn called(&self, argument: &Expression) -> Expression {
        let names = names(self.argument);
        let place = argument.place;
        let component = |i: usize| match self.argument.name.text == "Real" {
            true => argument.clone(),
            false => Expression {
                kind: Kind::Component(Box::new(argument.clone()), vec![i as u64 + 1]),
                place,
            },
        };
        let put = |e: &Expression| {
            mapped(e, &|e| match &e.kind {
                Kind::Name(n) => {
                    let which = names.iter().position(|all| all.contains(n));
                    which.map(component)
                }
                _ => None,
            })
        };
        match self.components {
            [only] => put(only),
            all => Expression {
                kind: Kind::Sum(
                    all.iter()
                        .enumerate()
                        .map(|(i, e)| {
                            let unit = Expression {
                                kind: Kind::Name(format!("E{}", i + 1)),
                                place,
                            };
                            let kind = Kind::Product(vec![put(e), unit]);
                            (false, Expression { kind, place })
                        })
                        .collect(),
                ),
                place,
            },
        }
    }
}

/// The model with calls of such functions replaced by what they are.
pub(super) fn written_out(mut model: Model) -> Result<Model, Errors> {
    let statements = model.statements.clone();
    let mut errors = Errors::new();
    let mut formulas = Vec::new();
    for statement in &statements {
        let Statement::Given {
            name,
            arguments,
            value,
            components,
            ..
        } = statement
        else {
            continue;
        };
        if components.is_empty() {
            continue;
        }
        let one = match arguments.as_slice() {
            [argument] => argument.components().map(|_| argument),
            _ => None,
        };
        let (Some(argument), Some(n)) = (one, value.components()) else {
            errors.push(Diagnostic::new(name.place, ONLY).help(OTHERWISE));
            continue;
        };
        if n != components.len() {
            let message = format!(
                "{n} components are declared and {} written",
                components.len()
            );
            errors.push(
                Diagnostic::new(name.place, message)
                    .help("write a list, an expression in quotes for each component"),
            );
        }
        formulas.push(Formula {
            name,
            argument,
            components,
        });
    }
    errors.propagate()?;
    if formulas.is_empty() {
        return Ok(model);
    }
    let put = |e: &Expression| put_in(e, &formulas);
    for statement in &mut model.statements {
        of_statement(statement, &mut |e| *e = put(e));
    }
    Ok(model)
}

/// Calls replaced, those within arguments first.
fn put_in(e: &Expression, formulas: &[Formula<'_>]) -> Expression {
    mapped(e, &|e| {
        let Kind::Call(name, arguments) = &e.kind else {
            return None;
        };
        let formula = formulas.iter().find(|f| f.name.text == name.text)?;
        let [argument] = arguments.as_slice() else {
            return None;
        };
        Some(formula.called(&put_in(argument, formulas)))
    })
}

/// The expression with what `of` replaces, from outside.
fn mapped(e: &Expression, of: &dyn Fn(&Expression) -> Option<Expression>) -> Expression {
    if let Some(put) = of(e) {
        return put;
    }
    let mut out = e.clone();
    children(&mut out, &mut |child| *child = mapped(child, of));
    out
}

fn each(e: &Expression, see: &mut dyn FnMut(&Expression)) {
    see(e);
    let mut copy = e.clone();
    children(&mut copy, &mut |child| each(child, see));
}

fn children(e: &mut Expression, of: &mut dyn FnMut(&mut Expression)) {
    match &mut e.kind {
        Kind::Number(_) | Kind::Name(_) => {}
        Kind::Sum(terms) => terms.iter_mut().for_each(|(_, t)| of(t)),
        Kind::Product(factors) => factors.iter_mut().for_each(of),
        Kind::Quotient(a, b) => {
            of(a);
            of(b);
        }
        Kind::Neg(a) | Kind::Transpose(a) | Kind::Power(a, _) | Kind::Component(a, _) => of(a),
        Kind::Call(_, arguments) => arguments.iter_mut().for_each(of),
    }
}

/// Every expression of a statement.
fn of_statement(statement: &mut Statement, of: &mut dyn FnMut(&mut Expression)) {
    match statement {
        Statement::Assume { left, right, .. } | Statement::Hold { left, right, .. } => {
            of(left);
            of(right);
        }
        Statement::Advected { definition, .. } => definition.iter_mut().for_each(of),
        Statement::Constraint { value, .. }
        | Statement::Let { value, .. }
        | Statement::Scale(value)
        | Statement::Lagrangian(value) => of(value),
        Statement::End { alternatives, .. } => {
            let terms = alternatives.iter_mut().flat_map(|a| a.terms.iter_mut());
            terms.for_each(of);
        }
        Statement::Label { .. }
        | Statement::Periodic(_)
        | Statement::Dim { .. }
        | Statement::Time { .. }
        | Statement::Param { .. }
        | Statement::Group { .. }
        | Statement::Field { .. }
        | Statement::Given { .. }
        | Statement::Grid(_)
        | Statement::Mesh { .. }
        | Statement::Node(..) => {}
    }
}
