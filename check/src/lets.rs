//! Definitions of a model, and their substitution into expressions.

use crate::expression::{Expression, Kind, Sizes};
use clebsch_core::syntax::ast::{self, Model, Statement};
use std::collections::BTreeMap;

/// The largest depth of nested definitions.
const DEEPEST: usize = 64;

/// Definitions by name, and sizes by name.
pub struct Lets(BTreeMap<String, Expression>, Sizes);

impl Lets {
    /// The definitions of a model.
    #[must_use]
    pub fn of(model: &Model, sizes: &Sizes) -> Self {
        let each = model.statements.iter().filter_map(|s| match s {
            Statement::Let { name, value } => {
                Some((name.text.clone(), Expression::of(value, sizes)))
            }
            _ => None,
        });
        Self(each.collect(), sizes.clone())
    }

    /// An expression in which all definitions are substituted.
    ///
    /// # Errors
    /// The definitions are nested too deeply.
    pub fn put(&self, e: &ast::Expression) -> Result<Expression, String> {
        let mut out = Expression::of(e, &self.1);
        for _ in 0..DEEPEST {
            let mut there = false;
            out.each(&mut |e| {
                there |= matches!(&e.kind, Kind::Name(n) if self.0.contains_key(n));
            });
            if !there {
                return Ok(out);
            }
            out.replace(&|e| match &e.kind {
                Kind::Name(n) => self.0.get(n).cloned(),
                _ => None,
            });
        }
        Err("definitions are nested too deeply".to_owned())
    }
}
