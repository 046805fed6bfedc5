//! Components of vectors and matrices, and matrices with a given diagonal. Indices in the text count from 1; the axes
//! of the resulting unit vectors count from 0.

use super::{Elaborated, Elaborator, fail};
use crate::check::messages::shape_text;
use crate::diagnostic::{Diagnostic, Place};
use crate::expr::shape::{Dim, Shape};
use crate::expr::symbol::Role;
use crate::expr::{self, Part};
use crate::syntax::ast::Expression;

impl Elaborator<'_> {
    /// `v[i]` or `A[i, j]`.
    pub(super) fn component(&self, a: &Expression, indices: &[u64], place: Place) -> Elaborated {
        let value = self.elaborate(a, None)?;
        let shape = value.shape();
        let symbols = &self.names.symbols;
        let remedy = match (shape.is_scalar(), shape.is_vector()) {
            (true, _) => "remove the brackets: a number has no components",
            (_, true) => "write components of a vector as `v[1]`, `v[2]`, ...",
            _ => "write components of a matrix as `A[1, 1]`, `A[1, 2]`, ...: row, then column",
        };
        match (shape.is_scalar(), shape.is_vector(), indices) {
            (false, true, [i]) => {
                let i = self.axis(*i, shape.rows, place)?;
                Ok(expr::dot(value, expr::unit(shape.rows, i)))
            }
            (false, false, [i, j]) if shape.rows != Dim::Fixed(1) => {
                let i = self.axis(*i, shape.rows, place)?;
                let j = self.axis(*j, shape.cols, place)?;
                let column = expr::mul(value, expr::unit(shape.cols, j));
                Ok(expr::dot(column, expr::unit(shape.rows, i)))
            }
            _ => {
                let what = shape_text(symbols, shape);
                let count = match indices.len() {
                    1 => "one index".to_owned(),
                    n => format!("{n} indices"),
                };
                let message = format!("this is {what}, which has no component with {count}");
                fail(Diagnostic::new(place, message).help(remedy))
            }
        }
    }

    /// The axis of an index, if it exists for every allowed size.
    fn axis(&self, index: u64, dim: Dim, place: Place) -> Result<u8, Box<Diagnostic>> {
        let symbols = &self.names.symbols;
        let (least, _) = symbols.sizes(dim);
        if (1..=least as u64).contains(&index) {
            return Ok(u8::try_from(index - 1).unwrap_or(0));
        }
        let bound = match dim {
            Dim::Fixed(n) => format!("from 1 to {n}"),
            Dim::Named(_) => format!(
                "from 1 to {least}, the smallest `{}`",
                symbols.dim_text(dim)
            ),
        };
        fail(
            Diagnostic::new(place, format!("this quantity has no component {index}"))
                .help(format!("components are counted {bound}")),
        )
    }

    /// `diag` of a vector is the matrix with that diagonal; `diag` of a matrix is its diagonal part.
    pub(super) fn diagonal(&self, a: &Expression, expected: Option<Shape>) -> Elaborated {
        let context = expected.filter(|_| self.hint(a).is_none());
        let value = self.elaborate(a, context)?;
        if value.shape().is_vector() {
            let symbols = &self.names.symbols;
            let named = matches!(value.shape().rows, Dim::Named(_));
            if named && expr::contains_role(symbols, &value, Role::Advected) {
                let message = format!(
                    "`diag` of an advected quantity needs a size that is a number, and `{}` is a name",
                    symbols.dim_text(value.shape().rows)
                );
                return fail(
                    Diagnostic::new(a.place, message)
                        .help("write the size out, for example `Vec<3>`"),
                );
            }
            return Ok(expr::diagonal(value));
        }
        self.square(&value, a.place, "`diag`")?;
        Ok(expr::part(Part::Diagonal, value))
    }
}
