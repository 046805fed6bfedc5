//! Elaborates sums, products and inverses. Shapes must agree; the error names both sides.

use super::{Elaborated, Elaborator, fail};
use crate::algebra::Algebra;
use crate::check::messages::shape_text;
use crate::diagnostic::{Diagnostic, Place};
use crate::expr::shape::{Dim, Shape};
use crate::expr::{self, Expr};
use crate::syntax::ast::{Expression, Kind};

/// The maximum length of a product: its derivatives grow with the square of its length.
const LONGEST_PRODUCT: usize = 40;

impl Elaborator<'_> {
    pub(super) fn sum(&self, terms: &[(bool, Expression)], expected: Option<Shape>) -> Elaborated {
        let context = terms.iter().find_map(|(_, t)| self.hint(t)).or(expected);
        let mut out: Vec<Expr> = Vec::new();
        for (minus, t) in terms {
            let value = self.elaborate(t, context)?;
            if let Some(first) = out.first()
                && first.shape() != value.shape()
            {
                let symbols = &self.names.symbols;
                let message = format!(
                    "{} and {} cannot be added",
                    shape_text(symbols, first.shape()),
                    shape_text(symbols, value.shape())
                );
                let place = terms[0].1.place.to(t.place);
                return fail(Diagnostic::new(place, message).help(
                    "all terms of a sum must have the same shape; `Id` and `0` take the shape of the other terms",
                ));
            }
            out.push(if *minus { expr::neg(value) } else { value });
        }
        let shape = out.first().map_or(Shape::SCALAR, Expr::shape);
        Ok(expr::sum(out, shape))
    }

    pub(super) fn product(&self, factors: &[Expression], expected: Option<Shape>) -> Elaborated {
        if factors.len() > LONGEST_PRODUCT {
            let place = factors[0].place.to(factors[factors.len() - 1].place);
            let message = format!("this product has more than {LONGEST_PRODUCT} factors");
            return fail(Diagnostic::new(place, message).help("turn parts of it into parameters"));
        }
        let mut left: Option<(Expr, Place)> = None;
        let mut numbers = Vec::new();
        for (i, f) in factors.iter().enumerate() {
            // The shape required here, from the factor before or after.
            let before = left.as_ref().map(|(l, _)| Shape::square(l.shape().cols));
            let after = factors[i + 1..]
                .iter()
                .find_map(|g| self.hint(g).filter(|s| !s.is_scalar()));
            let mut context = before.or(after.map(|s| Shape::square(s.rows))).or(expected);
            // If a column is followed by a row, the row has as many columns as the whole product.
            if context == Some(Shape::SCALAR) {
                context = expected.map(|s| Shape {
                    rows: Dim::Fixed(1),
                    cols: s.cols,
                });
            }
            let value = if matches!(&f.kind, Kind::Number(q) if q.is_zero()) {
                expr::integer(0)
            } else {
                self.elaborate(f, context.filter(|s| !s.is_scalar()))?
            };
            if value.shape().is_scalar() {
                numbers.push(value);
                continue;
            }
            left = Some(match left {
                None => (value, f.place),
                Some((l, place)) => {
                    if l.shape().cols != value.shape().rows {
                        return fail(self.mismatch(&l, place, &value, f.place));
                    }
                    (expr::mul(l, value), place.to(f.place))
                }
            });
        }
        Ok(expr::product(
            numbers.into_iter().chain(left.map(|(l, _)| l)),
        ))
    }

    fn mismatch(&self, a: &Expr, ap: Place, b: &Expr, bp: Place) -> Diagnostic {
        let symbols = &self.names.symbols;
        let d = Diagnostic::new(
            ap.to(bp),
            format!(
                "{} cannot be multiplied by {}",
                shape_text(symbols, a.shape()),
                shape_text(symbols, b.shape())
            ),
        );
        if a.shape().is_vector() && b.shape().is_vector() && a.shape() == b.shape() {
            d.help("write `dot(a, b)` for the scalar product, `a * b^T` for the outer one")
        } else if a.shape().is_vector() {
            d.help("a vector is a column: write the matrix first, `A * v`, or transpose, `v^T * A`")
        } else {
            d.help("the left factor needs as many columns as the right factor has rows")
        }
    }

    pub(super) fn inverse(&self, a: Expr, place: Place) -> Elaborated {
        if self.vanishes(&a) {
            return fail(Diagnostic::new(
                place,
                "this is identically zero, so it has no inverse",
            ));
        }
        if !expr::is_invertible(&self.names.symbols, &a) && self.vanishes(&expr::det(a.clone())) {
            let message = "this matrix has no inverse: its determinant is identically zero";
            return fail(Diagnostic::new(place, message).help(
                "a skew matrix of odd size, such as `hat(v)`, is singular, and so is `a*b^T`; add a regular matrix, for \
                 example `Id`",
            ));
        }
        Ok(expr::inverse(&self.names.symbols, a))
    }

    /// Whether an expression is zero for all values of its letters.
    pub(super) fn vanishes(&self, e: &Expr) -> bool {
        Algebra::new(&self.names.symbols).is_zero(e)
    }

    pub(super) fn square(&self, a: &Expr, place: Place, what: &str) -> Result<(), Box<Diagnostic>> {
        if a.shape().is_square() {
            return Ok(());
        }
        let shape = shape_text(&self.names.symbols, a.shape());
        fail(
            Diagnostic::new(
                place,
                format!("{what} needs a square matrix, and this is {shape}"),
            )
            .help("multiply by a transpose, as in `tr(a * b^T)`, or use `dot(a, b)` for vectors"),
        )
    }
}
