//! The descriptions of quantities in a model's text: the `///` lines before their declarations.
//! Takes a model and the key of a case; gives the words.

use clebsch_core::expr::symbol::ascii;
use clebsch_core::syntax::ast::{Model, Name, Statement};

/// The description of the quantity with this key. A momentum without one has the description of its
/// configuration.
pub(super) fn remark(model: &Model, key: &str) -> Option<String> {
    let of = |wanted: &str| {
        let mut all = model.statements.iter().zip(&model.remarks);
        all.find_map(|(statement, remark)| {
            let names: Vec<&Name> = match statement {
                Statement::Param { names, .. }
                | Statement::Field { names, .. }
                | Statement::Advected { names, .. } => names.iter().collect(),
                Statement::Group { name, .. } => vec![name],
                _ => Vec::new(),
            };
            let is_own = names.iter().any(|name| ascii(&name.text) == wanted);
            is_own.then(|| {
                remark
                    .iter()
                    .map(|line| line.trim())
                    .collect::<Vec<_>>()
                    .join(" ")
            })
        })
    };
    let own = of(key).filter(|words| !words.is_empty());
    own.or_else(|| {
        let moving = ["momentum_", "body_momentum_", "spatial_momentum_"];
        let of_what = moving.iter().find_map(|prefix| key.strip_prefix(prefix))?;
        of(of_what)?;
        Some(format!("momentum of {of_what} at the first node"))
    })
}
