//! Elaborates calls of user-defined functions, and checks the number, shapes and structures of their arguments.

use super::{Elaborated, Elaborator, fail};
use crate::algebra::Algebra;
use crate::diagnostic::{Diagnostic, Place};
use crate::expr::functional::FunctionalId;
use crate::expr::shape::Structure;
use crate::expr::{self, Expr};
use crate::syntax::ast::Expression;

impl Elaborator<'_> {
    pub(super) fn user_function_call(
        &self,
        function: FunctionalId,
        args: &[Expression],
        place: Place,
    ) -> Elaborated {
        let symbols = &self.names.symbols;
        let known = symbols.functional(function);
        if args.len() != known.arguments.len() {
            let message = format!(
                "`{}` takes {} arguments, and this call has {}",
                known.name,
                known.arguments.len(),
                args.len()
            );
            return fail(
                Diagnostic::new(place, message)
                    .help("write as many arguments as the `given` statement declares"),
            );
        }
        let mut arguments = Vec::new();
        for (e, kind) in args.iter().zip(&known.arguments) {
            let value = self.of_shape(e, kind.shape)?;
            if !self.obeys(&value, kind.structure) {
                let (what, remedy) = match kind.structure {
                    Structure::Symmetric => ("a symmetric matrix", "write `Q*Q^T`, or `sym(A)`"),
                    Structure::Skew => ("a skew matrix", "write `skew(A)`, or `hat(v)`"),
                    _ => ("a diagonal matrix", "take `diag(A)`"),
                };
                let message = format!(
                    "`{}` takes {what} here, and this expression is not one for all values",
                    known.name
                );
                return fail(Diagnostic::new(e.place, message).help(remedy));
            }
            arguments.push(value);
        }
        Ok(expr::given(symbols, function, arguments))
    }

    /// Whether a value has a structure for all values of its letters.
    fn obeys(&self, value: &Expr, structure: Structure) -> bool {
        let symbols = &self.names.symbols;
        let transposed = expr::transpose(symbols, value.clone());
        let other = match structure {
            Structure::Symmetric => transposed,
            Structure::Skew => expr::neg(transposed),
            Structure::Diagonal => expr::part(expr::Part::Diagonal, value.clone()),
            _ => return true,
        };
        Algebra::new(symbols).is_zero(&expr::sub(value.clone(), other))
    }
}
