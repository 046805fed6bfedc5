//! The statements of a model in coordinates: declarations, constraints, prescribed ends, and every expression.

use super::motions::{Motions, call, kind, kindred, name, product, sum, turn_by};
use super::{CoordinateKind, Stated};
use crate::algebra::Rational;
use crate::lattice::{any_name, definitions, inlined};
use crate::line::Refused;
use crate::syntax::ast::{At, Expression, Kind, Model, Name, Statement};
use std::collections::{BTreeMap, BTreeSet};

/// The model.
pub(super) fn restated(model: &Model, all: &[Stated]) -> Result<Model, Refused> {
    let model = &without_carried(model, all)?;
    let lets = definitions(model)?;
    let motions = Motions::of(model, all);
    let mut out = Model {
        statements: Vec::new(),
        remarks: Vec::new(),
        ..model.clone()
    };
    for (statement, docs) in model.statements.iter().zip(&model.remarks) {
        for statement in in_place_of(statement, all) {
            let mut statement = statement;
            for e in statement.expressions_mut() {
                *e = in_coordinates(&inlined(e, &lets), all, &motions)?;
            }
            out.statements.push(statement);
            out.remarks.push(docs.clone());
        }
    }
    Ok(out)
}

/// Substitutes the definitions of quantities that such configurations advect.
fn without_carried(model: &Model, all: &[Stated]) -> Result<Model, Refused> {
    let own = all.iter().flat_map(|x| [&x.of.name, &x.velocity]);
    let mut moved: BTreeSet<String> = own.cloned().collect();
    loop {
        let before = moved.len();
        for statement in &model.statements {
            let (of, value) = match statement {
                Statement::Let { name, value } => (name, value),
                Statement::Advected {
                    names,
                    definition: Some(value),
                    ..
                } => match names.first() {
                    Some(name) => (name, value),
                    None => continue,
                },
                _ => continue,
            };
            if any_name(value, &|n| moved.contains(n)) {
                moved.insert(of.text.clone());
            }
        }
        if moved.len() == before {
            break;
        }
    }
    let mut put: BTreeSet<String> = BTreeSet::new();
    let mut out = model.clone();
    for statement in &mut out.statements {
        if let Statement::Advected {
            names,
            definition: Some(value),
            ..
        } = statement
            && let Some(of) = names.first().filter(|n| moved.contains(&n.text))
        {
            put.insert(of.text.clone());
            *statement = Statement::Let {
                name: of.clone(),
                value: value.clone(),
            };
        }
    }
    let is_kept = |s: &Statement| match s {
        Statement::Constraint { name, .. } => !put.contains(&name.text),
        _ => true,
    };
    let both = out.statements.into_iter().zip(out.remarks);
    (out.statements, out.remarks) = both.filter(|(s, _)| is_kept(s)).unzip();
    let is_own = |n: &str| all.iter().any(|x| x.of.name == n);
    for statement in &out.statements {
        if let Statement::Constraint { name, value, .. } = statement
            && !is_own(&name.text)
            && let Some(by) = value.name_that(&|n| moved.contains(n))
        {
            return Err(Refused::Form(format!(
                "the constraint of `{of}` contains `{by}`: for loops over sites, define a quantity that a linear map, a \
                 rotation of the plane or a rigid motion advects, `advected {of}: ... = ...;`",
                of = name.text
            )));
        }
    }
    Ok(out)
}

/// The statements that replace one statement; their expressions are not yet in coordinates.
fn in_place_of(statement: &Statement, all: &[Stated]) -> Vec<Statement> {
    let found = |n: &Name| all.iter().find(|x| x.of.name == n.text);
    match statement {
        Statement::Let { .. } => Vec::new(),
        Statement::Group { name: own, at, .. } => match found(own) {
            Some(x) => declared(x, own, at.as_ref()),
            None => vec![statement.clone()],
        },
        Statement::Constraint {
            name: own, place, ..
        } => match found(own) {
            Some(x) => match &x.of.by {
                CoordinateKind::TurnAndPlace(turn, _) => {
                    let at = Expression {
                        kind: Kind::Name(turn.clone()),
                        place: *place,
                    };
                    vec![Statement::Constraint {
                        name: renamed(own, turn),
                        value: product(&at, [at.clone(), name(&at, &x.turning)]),
                        place: *place,
                    }]
                }
                CoordinateKind::Entries(_)
                | CoordinateKind::Angle(_)
                | CoordinateKind::AngleAndPlace(..) => Vec::new(),
            },
            None => vec![statement.clone()],
        },
        Statement::End {
            label,
            at,
            alternatives,
        } => {
            let mut alternatives = alternatives.clone();
            for alternative in &mut alternatives {
                let given = alternative.given.iter().flat_map(|own| match found(own) {
                    Some(x) => x.of.names().into_iter().map(|n| renamed(own, n)).collect(),
                    None => vec![own.clone()],
                });
                alternative.given = given.collect();
            }
            vec![Statement::End {
                label: label.clone(),
                at: at.clone(),
                alternatives,
            }]
        }
        _ => vec![statement.clone()],
    }
}

fn renamed(name: &Name, text: &str) -> Name {
    Name {
        text: text.to_owned(),
        place: name.place,
        typeset: name.typeset.clone().filter(|_| name.text == text),
        is_copy: name.is_copy,
    }
}

/// The declarations that replace a group.
fn declared(x: &Stated, own: &Name, at: Option<&At>) -> Vec<Statement> {
    let field = |text: &str, family: &str, n: Option<usize>| Statement::Field {
        names: vec![renamed(own, text)],
        shape: kindred(own.place, family, n),
        at: at.cloned(),
        offset: None,
        domain: None,
    };
    match &x.of.by {
        CoordinateKind::Entries(n) => vec![field(&own.text, "Mat", Some(*n))],
        CoordinateKind::Angle(angle) => vec![field(angle, "Real", None)],
        CoordinateKind::AngleAndPlace(angle, place) => {
            vec![field(angle, "Real", None), field(place, "Vec", Some(2))]
        }
        CoordinateKind::TurnAndPlace(turn, place) => vec![
            Statement::Group {
                name: renamed(own, turn),
                group: kindred(own.place, "SO", Some(3)),
                at: at.cloned(),
                velocity: renamed(own, &x.turning),
            },
            field(place, "Vec", Some(3)),
        ],
    }
}

/// An expression without definitions, in coordinates.
fn in_coordinates(
    e: &Expression,
    all: &[Stated],
    motions: &Motions<'_>,
) -> Result<Expression, Refused> {
    let out = motions.apart(e);
    if let Some(left) = out.name_that(&|n| motions.moves(n)) {
        return Err(Refused::Form(format!(
            "a term contains the homogeneous matrix of `{left}` outside of `rot`, `pos` and products with vectors: a chain \
             represents a rigid motion by its rotation and position, so write the term with `rot` and `pos`"
        )));
    }
    let mut by: BTreeMap<String, Expression> = BTreeMap::new();
    for x in all {
        match &x.of.by {
            CoordinateKind::Entries(_) => {
                by.insert(x.velocity.clone(), velocity_of_map(x, &out));
            }
            CoordinateKind::Angle(angle) => {
                let angle = name(&out, angle);
                let after = call(&out, "next", [angle.clone()]);
                let turned = sum(&out, [(false, after), (true, angle.clone())]);
                by.insert(x.velocity.clone(), turn_by(&out, turned));
                by.insert(x.of.name.clone(), turn_by(&out, angle));
            }
            CoordinateKind::AngleAndPlace(..) | CoordinateKind::TurnAndPlace(..) => {}
        }
    }
    Ok(inlined(&out, &by))
}

/// `Id + Q^-1*(next(Q) - Q)`, seen from space `Id + (next(Q) - Q)*Q^-1`.
fn velocity_of_map(x: &Stated, at: &Expression) -> Expression {
    let own = name(at, &x.of.name);
    let back = kind(at, Kind::Power(Box::new(own.clone()), Rational::MINUS_ONE));
    let after = call(at, "next", [own.clone()]);
    let way = sum(at, [(false, after), (true, own)]);
    let (first, second) = x.of.side.ordered(back, way);
    let moved = product(at, [first, second]);
    sum(at, [(false, name(at, "Id")), (false, moved)])
}
