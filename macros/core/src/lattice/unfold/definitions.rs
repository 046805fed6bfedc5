//! Replaces the name of every `let` by its expression, since the range of a term depends on the whole term.

use super::LARGEST;
use crate::diagnostic::{Diagnostic, Errors};
use crate::lattice::substitution::any_name;
use crate::syntax::ast::{Expression, Kind, Model, Name, Statement};
use std::collections::BTreeMap;

/// The expression of every `let`, with other definitions substituted.
pub(crate) fn definitions(model: &Model) -> Result<BTreeMap<String, Expression>, Errors> {
    let mut out = BTreeMap::new();
    let stated: Vec<(&Name, &Expression)> = model
        .statements
        .iter()
        .filter_map(|s| match s {
            Statement::Let { name, value } => Some((name, value)),
            _ => None,
        })
        .collect();
    // Definitions are not circular: each round substitutes one more level.
    for _ in 0..=stated.len() {
        for (name, value) in &stated {
            let put = inlined(value, &out);
            if put.size() > LARGEST {
                let message = format!("the expression of `{}` is too large", name.text);
                let d = Diagnostic::new(name.place, message);
                return Err(d.help("a `let` counts in full wherever it is used").into());
            }
            out.insert(name.text.clone(), put);
        }
        let left = |e: &Expression| any_name(e, &|n| out.contains_key(n));
        if !out.values().any(left) {
            break;
        }
    }
    Ok(out)
}

/// Substitutes definitions for their names.
pub(crate) fn inlined(e: &Expression, lets: &BTreeMap<String, Expression>) -> Expression {
    e.replaced(&|e| match &e.kind {
        Kind::Name(n) => lets.get(n).map(|value| Expression {
            kind: value.kind.clone(),
            place: e.place,
        }),
        _ => None,
    })
}
