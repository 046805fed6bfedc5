//! Turns syntax into expressions with shapes: names become symbols, and every operation checks its shapes. `Id`, `0`
//! and `E1 E2 ...` take their shape from the context.

mod components;
mod domains;
mod functions;
mod names;
mod products;
mod user_functions;

use super::declare::Declared;
use super::messages::{self, shape_text};
use crate::algebra::Rational;
use crate::diagnostic::{Diagnostic, Errors};
use crate::expr::shape::{Dim, Shape};
use crate::expr::{self, Expr};
use crate::syntax::ast::{Expression, Kind, Name, SizedName};

/// Elaborates the expressions of one model.
pub struct Elaborator<'a> {
    names: &'a Declared,
    bindings: Vec<(String, Expr)>,
    /// Names of `let`s without a binding: not yet defined, or (`true`) faulty.
    unbound: Vec<(String, bool)>,
}

/// The top-level summands of a scalar with their positions, also within signs and numerators.
pub fn terms(e: &Expression) -> Vec<&Expression> {
    match &e.kind {
        Kind::Sum(list) => list.iter().flat_map(|(_, t)| terms(t)).collect(),
        Kind::Neg(a) | Kind::Quotient(a, _) => terms(a),
        Kind::Number(_)
        | Kind::Constant(_)
        | Kind::Name(_)
        | Kind::Product(_)
        | Kind::Transpose(_)
        | Kind::Power(..)
        | Kind::Component(..)
        | Kind::Shaped(..)
        | Kind::Call(..) => vec![e],
    }
}

/// Names of unit vectors, up to the largest dimension with a stepper.
const UNITS: [&str; 8] = ["E1", "E2", "E3", "E4", "E5", "E6", "E7", "E8"];

type Elaborated = Result<Expr, Box<Diagnostic>>;

fn fail<T>(d: Diagnostic) -> Result<T, Box<Diagnostic>> {
    Err(Box::new(d))
}

impl<'a> Elaborator<'a> {
    /// Starts without bindings; `lets` are the names of later definitions.
    pub fn new(names: &'a Declared, lets: Vec<String>) -> Self {
        Elaborator {
            names,
            bindings: Vec::new(),
            unbound: lets.into_iter().map(|name| (name, false)).collect(),
        }
    }

    /// Marks the `let` of this name as faulty, so that its uses are not reported as well.
    pub fn spoil(&mut self, name: &Name) {
        self.unbound.push((name.text.clone(), true));
    }

    /// The `let` definitions so far, in order.
    pub fn bound(&self) -> &[(String, Expr)] {
        &self.bindings
    }

    /// Adds `let name = value`.
    pub fn bind(&mut self, name: &Name, value: Expr, errors: &mut Errors) {
        let mut fresh = self.names.clone();
        let taken = self.bindings.iter().any(|(n, _)| *n == name.text);
        if taken {
            errors.push(Diagnostic::new(
                name.place,
                format!("`{}` is declared twice", name.text),
            ));
        } else if fresh.admit(name, errors) {
            self.bindings.push((name.text.clone(), value));
        } else {
            self.spoil(name);
        }
    }

    /// Elaborates an expression of any shape.
    pub fn any(&self, e: &Expression) -> Elaborated {
        self.elaborate(e, None)
    }

    /// Elaborates a scalar.
    pub fn number(&self, e: &Expression) -> Elaborated {
        self.of_shape(e, Shape::SCALAR)
    }

    /// Elaborates an expression of a given shape.
    pub fn of_shape(&self, e: &Expression, wanted: Shape) -> Elaborated {
        let value = self.elaborate(e, Some(wanted))?;
        if value.shape() == wanted {
            return Ok(value);
        }
        let symbols = &self.names.symbols;
        let mut d = Diagnostic::new(
            e.place,
            format!(
                "this is {}, but {} is needed here",
                shape_text(symbols, value.shape()),
                shape_text(symbols, wanted)
            ),
        );
        if wanted.is_scalar() && value.shape().is_square() {
            d = d.help("take its trace: `tr(...)`");
        } else if wanted.is_scalar() && value.shape().is_vector() {
            d = d.help("pair it with another vector: `dot(a, b)`");
        } else if value.shape() == wanted.transposed() {
            d = d.help("transpose it with `^T`");
        }
        fail(d)
    }

    /// Elaborates two sides of equal shape.
    pub fn pair(&self, a: &Expression, b: &Expression) -> Result<(Expr, Expr), Box<Diagnostic>> {
        let shape = self
            .hint(a)
            .or_else(|| self.hint(b))
            .unwrap_or_else(|| self.unhinted(a));
        Ok((self.of_shape(a, shape)?, self.of_shape(b, shape)?))
    }

    fn default_size(&self) -> Dim {
        let mut sizes = self.names.configurations.iter().map(|g| g.group.size());
        // Unit vectors exist only for sizes above 1.
        let first = sizes.find(|size| *size != Dim::Fixed(1));
        first.unwrap_or(Dim::Fixed(3))
    }

    /// The shape of an expression that contains unit vectors alone: a column or a row, of the size that the context
    /// gives.
    fn of_units(&self, e: &Expression) -> Option<Shape> {
        match &e.kind {
            Kind::Name(n) if UNITS.contains(&n.as_str()) => {
                Some(Shape::vector(self.default_size()))
            }
            Kind::Transpose(a) => self.of_units(a).map(Shape::transposed),
            Kind::Neg(a) | Kind::Quotient(a, _) => self.of_units(a),
            Kind::Sum(terms) => terms.iter().find_map(|(_, t)| self.of_units(t)),
            Kind::Product(factors) => factors.iter().rev().find_map(|f| self.of_units(f)),
            _ => None,
        }
    }

    /// The declared shape of a scalar, vector or matrix.
    fn stated_shape(&self, shape: &SizedName) -> Option<Shape> {
        let found = super::parameter_shape(&self.names.symbols, shape);
        found.map(|(shape, _)| shape)
    }

    /// The shape of a context-dependent expression without a context.
    fn unhinted(&self, e: &Expression) -> Shape {
        self.elaborate(e, None)
            .map_or(Shape::SCALAR, |value| value.shape())
    }

    /// The shape of an expression as far as it does not depend on the context.
    fn hint(&self, e: &Expression) -> Option<Shape> {
        match &e.kind {
            Kind::Number(q) if q.is_zero() => None,
            Kind::Number(_) | Kind::Power(..) if !matches!(&e.kind, Kind::Power(_, q) if *q == Rational::MINUS_ONE) => {
                Some(Shape::SCALAR)
            }
            Kind::Number(_) | Kind::Constant(_) => Some(Shape::SCALAR),
            Kind::Power(a, _) => self.hint(a),
            Kind::Name(n) if n == "Id" => None,
            Kind::Name(n) if UNITS.contains(&n.as_str()) => None,
            Kind::Name(n) => {
                if let Some((_, value)) = self.bindings.iter().find(|(b, _)| b == n) {
                    return Some(value.shape());
                }
                if let Some(id) = self.names.symbols.find(n) {
                    let shape = self.names.symbols.get(id).shape;
                    return Some(self.names.entries(id).shape(shape));
                }
                None
            }
            Kind::Sum(terms) => terms.iter().find_map(|(_, t)| self.hint(t)),
            Kind::Neg(a) => self.hint(a),
            Kind::Quotient(a, _) => self.hint(a),
            Kind::Transpose(a) => self.hint(a).map(Shape::transposed),
            Kind::Product(factors) => {
                let known = factors.iter().filter_map(|f| {
                    let shape = self.hint(f).map(|s| (s, false));
                    shape.or_else(|| self.of_units(f).map(|s| (s, true)))
                });
                let known: Vec<(Shape, bool)> = known.collect();
                let open = known.len() < factors.len();
                let mut matrices = known.iter().filter(|(s, _)| !s.is_scalar());
                let first = matrices.next();
                match (first, matrices.next_back().or(first)) {
                    // A unit vector has one dimension of size 1; its other dimension is open.
                    (Some((a, true)), _) if a.rows != Dim::Fixed(1) => None,
                    (_, Some((b, true))) if b.cols != Dim::Fixed(1) => None,
                    (Some((a, _)), Some((b, _))) => Some(Shape {
                        rows: a.rows,
                        cols: b.cols,
                    }),
                    _ if open => None,
                    _ => Some(Shape::SCALAR),
                }
            }
            Kind::Call(name, args) => {
                let first = || args.first().and_then(|a| self.hint(a));
                let symbols = &self.names.symbols;
                if let Some(given) = symbols.functional_named(&name.text) {
                    return Some(symbols.functional(given).value.shape);
                }
                match name.text.as_str() {
                    "im" | "vee" | "cross" => Some(Shape::vector(Dim::Fixed(3))),
                    "perp" => Some(Shape::vector(Dim::Fixed(2))),
                    "hat" => Some(Shape::square(Dim::Fixed(3))),
                    "pos" => first().map(|s| Shape::vector(expr::within(s.rows))),
                    "rot" => first().map(|s| Shape::square(expr::within(s.rows))),
                    "quat" => Some(Shape::square(Dim::Fixed(4))),
                    "diag" => first().map(|s| Shape::square(s.rows)),
                    "inv" | "sym" | "skew" | "next" | "prev" => first(),
                    _ => Some(Shape::SCALAR),
                }
            }
            Kind::Component(..) => Some(Shape::SCALAR),
            Kind::Shaped(_, shape) => self.stated_shape(shape),
        }
    }

    fn elaborate(&self, e: &Expression, expected: Option<Shape>) -> Elaborated {
        match &e.kind {
            Kind::Number(q) if q.is_zero() => Ok(expr::zero(expected.unwrap_or(Shape::SCALAR))),
            Kind::Number(q) => Ok(expr::number(*q)),
            Kind::Constant(c) => Ok(expr::constant(*c)),
            Kind::Name(n) => self.name(n, e.place, expected),
            Kind::Neg(a) => Ok(expr::neg(self.elaborate(a, expected)?)),
            Kind::Sum(terms) => self.sum(terms, expected),
            Kind::Product(factors) => self.product(factors, expected),
            Kind::Quotient(a, b) => {
                let top = self.elaborate(a, expected)?;
                let bottom = self.elaborate(b, None)?;
                if !bottom.shape().is_scalar() {
                    let what = shape_text(&self.names.symbols, bottom.shape());
                    return fail(
                        Diagnostic::new(
                            b.place,
                            format!("the divisor must be a number, and this is {what}"),
                        )
                        .help(match bottom.shape().is_vector() {
                            true => "divide by a number, such as the length `sqrt(dot(x, x))`",
                            false => "multiply by the inverse: `inv(A) * b` or `A^-1 * b`",
                        }),
                    );
                }
                if self.vanishes(&bottom) {
                    return fail(Diagnostic::new(b.place, "this divisor is identically zero"));
                }
                self.finite(expr::quotient(top, bottom), e.place)
            }
            Kind::Transpose(a) => {
                let inner = self.elaborate(a, expected.map(Shape::transposed))?;
                Ok(expr::transpose(&self.names.symbols, inner))
            }
            Kind::Power(a, q) => {
                let base = self.elaborate(a, None)?;
                if base.shape().is_scalar() {
                    return self.power(base, *q, a.place, e.place);
                }
                if base.shape().is_vector() {
                    let what = shape_text(&self.names.symbols, base.shape());
                    return fail(messages::power_of_vector(a.place, &what, *q));
                }
                self.square(&base, a.place, "a power")?;
                match q.as_integer() {
                    Some(-1) => self.inverse(base, a.place),
                    Some(n) if (1..=8).contains(&n) => {
                        Ok(expr::product((0..n).map(|_| base.clone())))
                    }
                    _ => fail(
                        Diagnostic::new(
                            e.place,
                            "a matrix has only the powers ^-1 and ^1 to ^8, and ^T",
                        )
                        .help("to get a number, take the trace or determinant first"),
                    ),
                }
            }
            Kind::Call(name, args) => self.call(name, args, e.place, expected),
            Kind::Component(a, indices) => self.component(a, indices, e.place),
            Kind::Shaped(a, shape) => match self.stated_shape(shape) {
                Some(shape) => self.of_shape(a, shape),
                None => self.elaborate(a, expected),
            },
        }
    }
}
