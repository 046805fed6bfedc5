//! Replaces `pi` and `π` in a model by the number, unless the model declares a quantity of that name.

use super::ast::{Expression, Kind, Model, Name, Statement};
use crate::expr::Constant;

/// The names of the number.
const NAMES: [&str; 2] = ["pi", "π"];

/// Whether an undeclared name denotes the number.
pub(crate) fn is_meant(name: &str) -> bool {
    NAMES.contains(&name)
}

/// Replaces the name by the number.
pub(super) fn named(mut model: Model) -> Model {
    let time = model.statements.iter().find_map(|s| match s {
        Statement::Time { index, step } => Some([index.text.clone(), step.text.clone()]),
        _ => None,
    });
    let ends = model.statements.iter().filter_map(|s| match s {
        Statement::End { alternatives, .. } => Some(alternatives),
        _ => None,
    });
    let own = ends.flatten().flat_map(|a| &a.params).flat_map(|(n, _)| n);
    let declared = model
        .statements
        .iter()
        .flat_map(Statement::declared)
        .chain(own);
    let mut taken: Vec<String> = declared.map(|n: &Name| n.text.clone()).collect();
    taken.extend(time.into_iter().flatten());
    let put = |e: &Expression| match &e.kind {
        Kind::Name(n) if is_meant(n) && !taken.contains(n) => Some(Expression {
            kind: Kind::Constant(Constant::PI),
            place: e.place,
        }),
        _ => None,
    };
    for statement in &mut model.statements {
        for e in statement.expressions_mut() {
            e.replace(&put);
        }
    }
    model
}
