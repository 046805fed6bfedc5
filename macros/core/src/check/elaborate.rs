//! From syntax to shaped expressions: names become symbols, every operation checks its shapes,
//! `Id`, `0` and `E1 E2 E3` take theirs from the context.

use super::declare::Declared;
use super::messages::{self, shape_text};
use crate::algebra::{Algebra, Rational};
use crate::diagnostic::{Diagnostic, Errors, Place, closest};
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Function, Node, Part, Shift};
use crate::syntax::ast::{Expression, Kind, Name};
use crate::syntax::{FUNCTIONS, HIDEABLE};

/// Whether an expression is an element of the group of this structure whatever its letters are.
fn is_element(symbols: &Symbols, e: &Expr, structure: Structure) -> bool {
    let go = |x: &Expr| is_element(symbols, x, structure);
    match e.node() {
        Node::Letter(at) => symbols.get(at.symbol).structure == structure,
        Node::Identity(_) => true,
        Node::Product(factors) => factors.iter().all(go),
        Node::Inverse(a) => go(a),
        Node::Transpose(a) => structure.is_orthogonal() && go(a),
        _ => false,
    }
}

/// Elaborates the expressions of one model.
pub struct Elaborator<'a> {
    names: &'a Declared,
    bindings: Vec<(String, Expr)>,
    /// Names of `let`s that are not among the bindings: still to come, or (`true`) faulty.
    unbound: Vec<(String, bool)>,
}

/// Longest product: its derivatives grow with the square of its length.
const LONGEST_PRODUCT: usize = 40;

/// What the functions of the language are called elsewhere.
const OTHERWISE: [(&str, &str); 8] = [
    ("trace", "tr(A)"),
    ("determinant", "det(A)"),
    ("inverse", "inv(A)"),
    ("transpose", "A^T"),
    ("ln", "log(a)"),
    ("inner", "dot(a, b)"),
    ("norm", "sqrt(dot(a, a))"),
    ("previous", "prev(a)"),
];

/// The terms of a number, each with its place: summands at the top, through signs and divisors.
pub fn terms(e: &Expression) -> Vec<&Expression> {
    match &e.kind {
        Kind::Sum(list) => list.iter().flat_map(|(_, t)| terms(t)).collect(),
        Kind::Neg(a) | Kind::Quotient(a, _) => terms(a),
        Kind::Number(_)
        | Kind::Name(_)
        | Kind::Product(_)
        | Kind::Transpose(_)
        | Kind::Power(..)
        | Kind::Call(..) => vec![e],
    }
}

/// Unit vectors along the first axes.
const UNITS: [&str; 3] = ["E1", "E2", "E3"];

type Elaborated = Result<Expr, Box<Diagnostic>>;

fn fail<T>(d: Diagnostic) -> Result<T, Box<Diagnostic>> {
    Err(Box::new(d))
}

impl<'a> Elaborator<'a> {
    /// With the declared names and no bindings yet; `lets` are the names of those to come.
    pub fn new(names: &'a Declared, lets: Vec<String>) -> Self {
        Elaborator {
            names,
            bindings: Vec::new(),
            unbound: lets.into_iter().map(|name| (name, false)).collect(),
        }
    }

    /// Notes that the `let` of this name is faulty: its uses are not reported as well.
    pub fn spoil(&mut self, name: &Name) {
        self.unbound.push((name.text.clone(), true));
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

    /// An expression of whatever shape.
    pub fn any(&self, e: &Expression) -> Elaborated {
        self.elaborate(e, None)
    }

    /// A number.
    pub fn number(&self, e: &Expression) -> Elaborated {
        self.of_shape(e, Shape::SCALAR)
    }

    /// An expression of a given shape.
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

    /// Two sides of one shape.
    pub fn pair(&self, a: &Expression, b: &Expression) -> Result<(Expr, Expr), Box<Diagnostic>> {
        let shape = self
            .hint(a)
            .or_else(|| self.hint(b))
            .unwrap_or(Shape::SCALAR);
        Ok((self.of_shape(a, shape)?, self.of_shape(b, shape)?))
    }

    fn default_size(&self) -> Dim {
        let groups = &self.names.configurations;
        groups.first().map_or(Dim::Fixed(3), |g| g.group.size())
    }

    /// The shape of an expression as far as it does not depend on the context.
    fn hint(&self, e: &Expression) -> Option<Shape> {
        match &e.kind {
            Kind::Number(q) if q.is_zero() => None,
            Kind::Number(_) | Kind::Power(..) if !matches!(&e.kind, Kind::Power(_, q) if *q == Rational::MINUS_ONE) => {
                Some(Shape::SCALAR)
            }
            Kind::Number(_) => Some(Shape::SCALAR),
            Kind::Power(a, _) => self.hint(a),
            Kind::Name(n) if n == "Id" => None,
            Kind::Name(n) if UNITS.contains(&n.as_str()) => {
                Some(Shape::vector(self.default_size()))
            }
            Kind::Name(n) => {
                if let Some((_, value)) = self.bindings.iter().find(|(b, _)| b == n) {
                    return Some(value.shape());
                }
                if let Some(id) = self.names.symbols.find(n) {
                    return Some(self.names.symbols.get(id).shape);
                }
                None
            }
            Kind::Sum(terms) => terms.iter().find_map(|(_, t)| self.hint(t)),
            Kind::Neg(a) => self.hint(a),
            Kind::Quotient(a, _) => self.hint(a),
            Kind::Transpose(a) => self.hint(a).map(Shape::transposed),
            Kind::Product(factors) => {
                let known: Vec<Shape> = factors.iter().filter_map(|f| self.hint(f)).collect();
                let open = known.len() < factors.len();
                let matrices: Vec<&Shape> = known.iter().filter(|s| !s.is_scalar()).collect();
                match (matrices.first(), matrices.last()) {
                    (Some(a), Some(b)) => Some(Shape {
                        rows: a.rows,
                        cols: b.cols,
                    }),
                    _ if open => None,
                    _ => Some(Shape::SCALAR),
                }
            }
            Kind::Call(name, args) => {
                if let Some(product) = self.hidden(name, args) {
                    return self.hint(&product);
                }
                let first = || args.first().and_then(|a| self.hint(a));
                match name.text.as_str() {
                    "hat" => first().map(|s| Shape::square(s.rows)),
                    "vee" => first().map(|s| Shape::vector(s.rows)),
                    "im" | "pos" => Some(Shape::vector(Dim::Fixed(3))),
                    "rot" => Some(Shape::square(Dim::Fixed(3))),
                    "quat" => Some(Shape::square(Dim::Fixed(4))),
                    "inv" | "sym" | "skew" | "diag" | "cross" | "next" | "prev" => first(),
                    _ => Some(Shape::SCALAR),
                }
            }
        }
    }

    fn elaborate(&self, e: &Expression, expected: Option<Shape>) -> Elaborated {
        match &e.kind {
            Kind::Number(q) if q.is_zero() => Ok(expr::zero(expected.unwrap_or(Shape::SCALAR))),
            Kind::Number(q) => Ok(expr::number(*q)),
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
                            format!("only numbers divide, and this is {what}"),
                        )
                        .help("multiply by the inverse: `inv(A) * b` or `A^-1 * b`"),
                    );
                }
                if self.vanishes(&bottom) {
                    return fail(Diagnostic::new(b.place, "this divisor is identically zero"));
                }
                Ok(expr::quotient(top, bottom))
            }
            Kind::Transpose(a) => {
                let inner = self.elaborate(a, expected.map(Shape::transposed))?;
                Ok(expr::transpose(&self.names.symbols, inner))
            }
            Kind::Power(a, q) => {
                let base = self.elaborate(a, None)?;
                if base.shape().is_scalar() {
                    return Ok(expr::power(base, *q));
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
                            "a matrix has the powers ^-1 and ^1 to ^8, and ^T",
                        )
                        .help("for a number, take the trace or determinant first"),
                    ),
                }
            }
            Kind::Call(name, args) => self.call(name, args, e.place, expected),
        }
    }

    fn name(&self, n: &str, place: Place, expected: Option<Shape>) -> Elaborated {
        if let Some((_, value)) = self.bindings.iter().find(|(b, _)| b == n) {
            return Ok(value.clone());
        }
        if let Some(id) = self.names.symbols.find(n) {
            return Ok(expr::here(&self.names.symbols, id));
        }
        if n == "Id" {
            let size = match expected {
                Some(s) if s.is_square() && !s.is_scalar() => s.rows,
                Some(s) if !s.is_square() => {
                    let what = shape_text(&self.names.symbols, s);
                    let message = format!("`Id` is square, but {what} is needed here");
                    return fail(Diagnostic::new(place, message));
                }
                _ => self.default_size(),
            };
            return Ok(expr::identity(size));
        }
        if let Some(axis) = UNITS.iter().position(|u| *u == n) {
            let size = match expected {
                Some(s) if s.is_vector() => s.rows,
                _ => self.default_size(),
            };
            return Ok(expr::unit(size, axis as u8));
        }
        let declared = self
            .names
            .symbols
            .ids()
            .map(|id| &self.names.symbols.get(id).name);
        let bound = self.bindings.iter().map(|(b, _)| b);
        let mut d = Diagnostic::new(place, format!("`{n}` is not declared"));
        if self.names.was_declared(n) || self.unbound.contains(&(n.to_owned(), true)) {
            d = Diagnostic::following(place, format!("`{n}` has a faulty declaration"));
        } else if n == "T" {
            d = d.help("`T` is the transpose and only stands after `^`");
        } else if self.unbound.contains(&(n.to_owned(), false)) {
            d = Diagnostic::new(place, format!("`{n}` is used before its `let`"))
                .help(format!("move `let {n} = ...;` up, before its first use"));
        } else if FUNCTIONS.contains(&n) {
            d = Diagnostic::new(place, format!("`{n}` is a function of the language"))
                .help(format!("write `{n}(...)`"));
        } else if let Some(near) = closest(n, declared.chain(bound).map(String::as_str)) {
            d = d.help(format!("did you mean `{near}`?"));
        } else if let Some((_, written)) = OTHERWISE.iter().find(|(other, _)| *other == n) {
            d = d.help(format!("the language writes `{written}`"));
        } else if let Some(near) = closest(n, FUNCTIONS) {
            d = d.help(format!("did you mean the function `{near}`?"));
        } else if n == self.names.time_index {
            d = d.help(format!(
                "`{n}` is the time index; `next(x)` is `x` at the node after"
            ));
        } else {
            d = d.help(format!("declare it, for example `param {n}: Real;`"));
        }
        fail(d)
    }

    fn sum(&self, terms: &[(bool, Expression)], expected: Option<Shape>) -> Elaborated {
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
                    "every term of a sum has one shape; `Id` and `0` take that of the others",
                ));
            }
            out.push(if *minus { expr::neg(value) } else { value });
        }
        let shape = out.first().map_or(Shape::SCALAR, Expr::shape);
        Ok(expr::sum(out, shape))
    }

    fn product(&self, factors: &[Expression], expected: Option<Shape>) -> Elaborated {
        if factors.len() > LONGEST_PRODUCT {
            let place = factors[0].place.to(factors[factors.len() - 1].place);
            let message = format!("a product of more than {LONGEST_PRODUCT} factors is refused");
            return fail(Diagnostic::new(place, message).help("make parts of it parameters"));
        }
        let mut left: Option<(Expr, Place)> = None;
        let mut numbers = Vec::new();
        for (i, f) in factors.iter().enumerate() {
            // What must stand here, from the neighbour before or after.
            let before = left.as_ref().map(|(l, _)| Shape::square(l.shape().cols));
            let after = factors[i + 1..]
                .iter()
                .find_map(|g| self.hint(g).filter(|s| !s.is_scalar()));
            let context = before.or(after.map(|s| Shape::square(s.rows))).or(expected);
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
            d.help("columns of the left factor and rows of the right one must agree")
        }
    }

    fn inverse(&self, a: Expr, place: Place) -> Elaborated {
        if self.vanishes(&a) {
            return fail(Diagnostic::new(
                place,
                "this is identically zero and has no inverse",
            ));
        }
        Ok(expr::inverse(&self.names.symbols, a))
    }

    /// Whether an expression is zero whatever its letters are.
    fn vanishes(&self, e: &Expr) -> bool {
        Algebra::new(&self.names.symbols).is_zero(e)
    }

    fn square(&self, a: &Expr, place: Place, what: &str) -> Result<(), Box<Diagnostic>> {
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

    /// A word that is declared is no function: `rot (a)` is then a product.
    fn hidden(&self, name: &Name, args: &[Expression]) -> Option<Expression> {
        let n = name.text.as_str();
        let declared = self.names.symbols.find(n).is_some()
            || self.bindings.iter().any(|(bound, _)| bound == n);
        let [argument] = args else { return None };
        if !HIDEABLE.contains(&n) || !declared {
            return None;
        }
        let factor = Expression {
            kind: Kind::Name(n.to_owned()),
            place: name.place,
        };
        Some(Expression {
            place: name.place.to(argument.place),
            kind: Kind::Product(vec![factor, argument.clone()]),
        })
    }

    /// Parts of elements of SU(2) and SE(3).
    fn of_group(&self, f: &str, a: Expr, place: Place) -> Elaborated {
        let symbols = &self.names.symbols;
        if a.shape() != Shape::square(Dim::Fixed(4)) {
            let what = shape_text(symbols, a.shape());
            let d = Diagnostic::new(
                place,
                format!("`{f}` needs a 4 x 4 matrix, and this is {what}"),
            );
            return fail(d.help("elements of SU<2> and of SE<3> are 4 x 4 matrices"));
        }
        let quaternion = is_element(symbols, &a, Structure::UnitQuaternion);
        let motion = is_element(symbols, &a, Structure::RigidMotion);
        match f {
            "re" => return Ok(expr::real(a)),
            "im" => return Ok(expr::imaginary(a)),
            "rot" if quaternion => return Ok(expr::rotation(symbols, a)),
            "rot" if motion => return Ok(expr::block(symbols, &a)),
            "pos" if motion => return Ok(expr::column(symbols, &a)),
            _ => {}
        }
        let (what, example) = match f {
            "rot" => ("SU<2> or SE<3>", "rot(g)"),
            _ => ("SE<3>", "pos(G)"),
        };
        let message =
            format!("`{f}` needs an element of {what}: products and inverses of such letters");
        fail(Diagnostic::new(place, message).help(format!("write for example `{example}`")))
    }

    fn call(
        &self,
        name: &Name,
        args: &[Expression],
        place: Place,
        expected: Option<Shape>,
    ) -> Elaborated {
        if let Some(product) = self.hidden(name, args) {
            return self.elaborate(&product, expected);
        }
        let symbols = &self.names.symbols;
        let f = name.text.as_str();
        let count = if matches!(f, "dot" | "cross") { 2 } else { 1 };
        if args.len() != count {
            let (wanted, example) = match count {
                1 => ("one argument", format!("{f}(a)")),
                _ => ("two arguments", format!("{f}(a, b)")),
            };
            let message = format!("`{f}` takes {wanted}, {} given", args.len());
            return fail(Diagnostic::new(place, message).help(format!("write `{example}`")));
        }
        let three = |a: &Expr, at: Place| {
            if a.shape() == Shape::vector(Dim::Fixed(3)) {
                return Ok(());
            }
            let what = shape_text(symbols, a.shape());
            fail(Diagnostic::new(
                at,
                format!("`{f}` needs a vector of length 3, and this is {what}"),
            ))
        };
        let first = &args[0];
        let argument = |context: Option<Shape>| self.elaborate(first, context);
        match f {
            "tr" | "Tr" | "det" | "I1" | "I2" | "inv" | "sym" | "skew" | "diag" => {
                let context = if matches!(f, "inv" | "sym" | "skew" | "diag") {
                    expected
                } else {
                    None
                };
                let a = argument(context)?;
                self.square(&a, first.place, &format!("`{f}`"))?;
                Ok(match f {
                    "tr" | "Tr" | "I1" => expr::trace(a),
                    "det" => expr::det(a),
                    // I2 = ((tr A)^2 - tr A^2)/2
                    "I2" => expr::scale(
                        Rational::HALF,
                        expr::sub(
                            expr::power(expr::trace(a.clone()), Rational::integer(2)),
                            expr::trace(expr::mul(a.clone(), a)),
                        ),
                    ),
                    "inv" => self.inverse(a, first.place)?,
                    "sym" => expr::part(Part::Symmetric, a),
                    "skew" => expr::part(Part::Skew, a),
                    _ => expr::part(Part::Diagonal, a),
                })
            }
            "log" | "exp" | "sqrt" => {
                let a = self.of_shape(first, Shape::SCALAR)?;
                Ok(match f {
                    "log" => expr::call(Function::Log, a),
                    "exp" => expr::call(Function::Exp, a),
                    _ => expr::power(a, Rational::HALF),
                })
            }
            "hat" | "quat" => {
                let a = argument(Some(Shape::vector(Dim::Fixed(3))))?;
                three(&a, first.place)?;
                Ok(match f {
                    "hat" => expr::hat(a),
                    _ => expr::pure(a),
                })
            }
            "vee" => {
                let a = argument(expected.map(|s| Shape::square(s.rows)))?;
                if a.shape() != Shape::square(Dim::Fixed(3)) {
                    let what = shape_text(symbols, a.shape());
                    let message = format!("`vee` needs a 3 x 3 matrix, and this is {what}");
                    return fail(Diagnostic::new(first.place, message));
                }
                Ok(expr::vee(a))
            }
            "dot" | "cross" => {
                let (a, b) = self.pair(first, &args[1])?;
                if f == "cross" {
                    three(&a, first.place)?;
                    return Ok(expr::cross(a, b));
                }
                if !a.shape().is_vector() {
                    let what = shape_text(symbols, a.shape());
                    return fail(
                        Diagnostic::new(
                            first.place,
                            format!("`dot` pairs two vectors, and this is {what}"),
                        )
                        .help("the pairing of two matrices is `tr(A^T * B)`"),
                    );
                }
                Ok(expr::dot(a, b))
            }
            "next" | "prev" => {
                let a = argument(expected)?;
                let moves = expr::letters(&a).iter().any(|l| {
                    matches!(
                        symbols.get(l.symbol).role,
                        Role::Element | Role::Velocity | Role::Advected
                    )
                });
                if !moves {
                    return fail(
                        Diagnostic::new(
                            place,
                            format!("`{f}` of a constant is the constant itself"),
                        )
                        .help(format!("drop `{f}`")),
                    );
                }
                let by = if f == "next" {
                    Shift::NEXT
                } else {
                    Shift::PREVIOUS
                };
                let shifted = expr::shift_time(symbols, &a, by.time);
                for l in expr::letters(&shifted) {
                    if symbols.get(l.symbol).role == Role::Velocity {
                        let name = &symbols.get(l.symbol).name;
                        return fail(messages::shifted_velocity(place, name));
                    }
                    if !messages::EDGE.contains(&l.shift.time) {
                        return fail(messages::shift_too_far(place));
                    }
                }
                Ok(shifted)
            }
            "re" | "im" | "rot" | "pos" => {
                let a = argument(Some(Shape::square(Dim::Fixed(4))))?;
                self.of_group(f, a, first.place)
            }
            _ => fail(
                Diagnostic::new(
                    name.place,
                    format!("`{f}` belongs to models that this version does not derive yet"),
                )
                .help(
                    "available: tr det log exp sqrt inv sym skew diag hat vee dot cross re im quat rot pos I1 I2 next",
                ),
            ),
        }
    }
}
