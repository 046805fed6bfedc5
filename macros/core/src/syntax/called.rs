//! Expands calls of functions that are defined by a formula. Each call in the model becomes the formula at its
//! argument, so that the engine can differentiate it.

use super::ast::{Expression, Kind, Model, Name, SizedName, Statement};
use super::formula::{foreign, names, signature};
use crate::diagnostic::{Diagnostic, Errors};
use crate::lattice::LARGEST;
use std::cell::Cell;

/// A function defined by a formula.
struct Formula {
    name: Name,
    argument: SizedName,
    value: SizedName,
    components: Vec<Expression>,
}

impl Formula {
    /// The value of a call.
    fn called(&self, argument: &Expression) -> Expression {
        let names = names(&self.argument);
        let place = argument.place;
        let shaped = |e: Expression, shape: &SizedName| Expression {
            kind: Kind::Shaped(Box::new(e), shape.clone()),
            place,
        };
        let argument = &shaped(argument.clone(), &self.argument);
        let component = |i: usize| match self.argument.name.text == "Real" {
            true => argument.clone(),
            false => Expression {
                kind: Kind::Component(Box::new(argument.clone()), vec![i as u64 + 1]),
                place,
            },
        };
        let put = |e: &Expression| {
            e.replaced(&|e| match &e.kind {
                Kind::Name(n) => {
                    let which = names.iter().position(|all| all.contains(n));
                    which.map(component)
                }
                _ => None,
            })
        };
        let value = match self.components.as_slice() {
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
        };
        shaped(value, &self.value)
    }
}

/// Expands all calls of such functions in a model.
pub(super) fn written_out(mut model: Model) -> Result<Model, Errors> {
    let stated = formulas(&model)?;
    if stated.is_empty() {
        return Ok(model);
    }
    let room = Cell::new(Some(LARGEST));
    let formulas = by_others(stated, &room)?;
    let mut errors = Errors::new();
    for statement in &mut model.statements {
        for e in statement.expressions_mut() {
            misused(e, &formulas, &mut errors);
            *e = put_in(e, &formulas, &room);
        }
    }
    errors.propagate()?;
    match room.get() {
        Some(_) => Ok(model),
        None => Err(Diagnostic::new(
            model.name.place,
            "the model is too large once its functions are substituted",
        )
        .help("every call inserts the expression of the function, and its argument wherever the expression contains it")
        .into()),
    }
}

/// The functions that the model defines by formulas, which may contain only their argument and constants.
fn formulas(model: &Model) -> Result<Vec<Formula>, Errors> {
    let mut errors = Errors::new();
    let mut found = Vec::new();
    let constants = constants(model);
    for statement in &model.statements {
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
        let (argument, n) = match signature(name, arguments, value) {
            Ok(found) => found,
            Err(wrong) => {
                errors.push(wrong);
                continue;
            }
        };
        if n != components.len() {
            let message = format!(
                "the function declares {n} components and gives {}",
                components.len()
            );
            errors.push(
                Diagnostic::new(name.place, message)
                    .help("write a list with an expression in quotes for each component"),
            );
        }
        let known = |n: &str| constants.contains(&n);
        for e in components {
            let wrong = foreign(e, argument, &known);
            errors.extend(wrong.map(|said| Diagnostic::new(e.place, said)));
        }
        found.push(Formula {
            name: name.clone(),
            argument: argument.clone(),
            value: value.clone(),
            components: components.clone(),
        });
    }
    errors.propagate().map(|()| found)
}

/// The constants that a formula may contain besides its argument: parameters, definitions, step size, spacing and
/// unit vectors.
fn constants(model: &Model) -> Vec<&str> {
    let mut all = vec!["Id", "E1", "E2", "E3", "h"];
    for statement in &model.statements {
        match statement {
            Statement::Param { names, .. } => all.extend(names.iter().map(|n| n.text.as_str())),
            Statement::Let { name, .. } => all.push(&name.text),
            Statement::Time { step, .. } => all.push(&step.text),
            Statement::Label {
                step: Some(step), ..
            } => all.push(&step.text),
            Statement::Field {
                offset: Some(offset),
                ..
            } => all.push(&offset.text),
            Statement::End { alternatives, .. } => {
                let own = alternatives.iter().flat_map(|a| &a.params);
                all.extend(own.flat_map(|(names, _)| names).map(|n| n.text.as_str()));
            }
            _ => {}
        }
    }
    all
}

/// Functions with the calls of other functions expanded, each after the functions that it calls.
fn by_others(mut open: Vec<Formula>, room: &Cell<Option<usize>>) -> Result<Vec<Formula>, Errors> {
    let mut done: Vec<Formula> = Vec::new();
    let mut errors = Errors::new();
    while !open.is_empty() {
        let names: Vec<String> = open.iter().map(|f| f.name.text.clone()).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let waits = |f: &Formula| f.components.iter().any(|e| e.call_of(&names).is_some());
        let (waiting, ready): (Vec<Formula>, Vec<Formula>) = open.into_iter().partition(waits);
        if ready.is_empty() {
            for f in &waiting {
                let message = format!("`{}` calls itself", f.name.text);
                errors.push(Diagnostic::new(f.name.place, message).help(
                    "a function may call other functions, but not itself, directly or through them",
                ));
            }
            return Err(errors);
        }
        for mut f in ready {
            for e in &mut f.components {
                misused(e, &done, &mut errors);
                *e = put_in(e, &done, room);
            }
            done.push(f);
        }
        open = waiting;
    }
    errors.propagate().map(|()| done)
}

/// Reports functions that are used without an argument or with several arguments.
fn misused(e: &Expression, formulas: &[Formula], errors: &mut Errors) {
    let of = |name: &str| formulas.iter().find(|f| f.name.text == name);
    e.each(&mut |e| match &e.kind {
        Kind::Name(n) => {
            let wrong = of(n).map(|f| {
                let message = format!("`{n}` is a function and needs an argument");
                let places = Diagnostic::new(e.place, message).help(format!("write `{n}(...)`"));
                places.also(f.name.place, "it is declared here")
            });
            errors.extend(wrong);
        }
        Kind::Call(name, list) if list.len() != 1 => {
            let wrong = of(&name.text).map(|f| {
                let message = format!("`{}` takes one argument, not {}", name.text, list.len());
                Diagnostic::new(name.place, message).also(f.name.place, "it is declared here")
            });
            errors.extend(wrong);
        }
        _ => {}
    });
}

/// Expands calls, inner calls first, as long as the expanded size stays within `room` quantities, numbers and
/// operations.
fn put_in(e: &Expression, formulas: &[Formula], room: &Cell<Option<usize>>) -> Expression {
    e.replaced(&|e| {
        let Kind::Call(name, arguments) = &e.kind else {
            return None;
        };
        let formula = formulas.iter().find(|f| f.name.text == name.text)?;
        let [argument] = arguments.as_slice() else {
            return None;
        };
        let argument = put_in(argument, formulas, room);
        // A call is not expanded if the result could be too large: each name in the formula becomes at most the
        // argument.
        let own: usize = formula.components.iter().map(Expression::size).sum();
        let most = own.saturating_mul(argument.size() + 1);
        let left = room.get().filter(|left| most <= *left);
        let called = left.map(|left| (left, formula.called(&argument)));
        room.set(
            called
                .as_ref()
                .and_then(|(left, called)| left.checked_sub(called.size())),
        );
        // A call that was not expanded is not searched again.
        Some(called.map_or_else(|| e.clone(), |(_, called)| called))
    })
}
