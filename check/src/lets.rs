//! Definitions of a model, and their expressions in the place of their names.

use crate::expression::{Expression, Kind, Sizes};
use clebsch_core::syntax::ast::{self, Model, Statement};
use std::collections::BTreeMap;

/// How deep definitions may stand in one another.
const DEEPEST: usize = 64;

/// Definitions by name, and sizes by name.
pub struct Lets(BTreeMap<String, Expression>, Sizes);

impl Lets {
    /// Those of a model.
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

    /// An expression with definitions put in, to the last one.
    ///
    /// # Errors
    /// They stand in one another without end.
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
        Err("definitions stand in one another too deep".to_owned())
    }
}
