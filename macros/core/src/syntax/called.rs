//! Calls of functions that are written out. Takes a model as it was written; gives the same with each call replaced by the
//! expression at its argument, so that the engine differentiates it.

use super::ast::{Expression, Kind, Kindred, Model, Name, Statement};
use super::formula::{names, signature};
use crate::diagnostic::{Diagnostic, Errors};
use crate::lattice::LARGEST;
use std::cell::Cell;

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
            e.replaced(&|e| match &e.kind {
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
        let (argument, n) = match signature(name, arguments, value) {
            Ok(found) => found,
            Err(wrong) => {
                errors.push(wrong);
                continue;
            }
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
    let room = Cell::new(Some(LARGEST));
    for statement in &mut model.statements {
        for e in statement.expressions_mut() {
            *e = put_in(e, &formulas, &room);
        }
    }
    match room.get() {
        Some(_) => Ok(model),
        None => Err(Diagnostic::new(
            model.name.place,
            "what functions stand for is too large where they are called",
        )
        .help("a function is counted wherever it is called, and its argument wherever that stands in it")
        .into()),
    }
}

/// Calls replaced, those within arguments first, while there is room for so many quantities, numbers and operations.
fn put_in(e: &Expression, formulas: &[Formula<'_>], room: &Cell<Option<usize>>) -> Expression {
    e.replaced(&|e| {
        let Kind::Call(name, arguments) = &e.kind else {
            return None;
        };
        let formula = formulas.iter().find(|f| f.name.text == name.text)?;
        let [argument] = arguments.as_slice() else {
            return None;
        };
        let argument = put_in(argument, formulas, room);
        // It is not made where it could be too large: each of its names stands for the argument at most.
        let own: usize = formula.components.iter().map(Expression::size).sum();
        let most = own.saturating_mul(argument.size() + 1);
        let left = room.get().filter(|left| most <= *left);
        let called = left.map(|left| (left, formula.called(&argument)));
        room.set(
            called
                .as_ref()
                .and_then(|(left, called)| left.checked_sub(called.size())),
        );
        // A call that is left alone is not looked into again.
        Some(called.map_or_else(|| e.clone(), |(_, called)| called))
    })
}
