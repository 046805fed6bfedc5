//! Elaborates calls of the functions of the language, and reports names that look like functions but are not.

use super::{Elaborated, Elaborator, fail};
use crate::algebra::Rational;
use crate::check::messages::{self, shape_text};
use crate::diagnostic::{Diagnostic, Place, closest};
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Function, Node, Part, Shift};
use crate::groups::{self, Group};
use crate::syntax::ast::{Expression, Kind, Name};
use crate::syntax::{AVAILABLE, FUNCTIONS, HIDEABLE, unknown};

/// Whether an expression is an element of the group of this structure for all values of its letters.
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

impl Elaborator<'_> {
    /// Whether the name denotes a quantity of the model.
    fn is_quantity(&self, n: &str) -> bool {
        self.names.symbols.find(n).is_some()
            || self.names.was_declared(n)
            || self.bindings.iter().any(|(bound, _)| bound == n)
            || self.unbound.iter().any(|(name, _)| name == n)
            || n == "Id"
            || super::UNITS.contains(&n)
    }

    /// The error for parentheses after a name that is not a function, or that the model declares as something else.
    fn no_function(&self, name: &Name) -> Option<Diagnostic> {
        let n = name.text.as_str();
        let function = FUNCTIONS.contains(&n);
        if self.is_quantity(n) && (!function || HIDEABLE.contains(&n)) {
            let message = match function {
                true => format!("`{n}` is declared here as a quantity, which shadows the function"),
                false => format!("`{n}` is a quantity, not a function"),
            };
            let d = Diagnostic::new(name.place, message);
            let moves = self.names.symbols.find(n).is_some_and(|id| {
                let role = self.names.symbols.get(id).role;
                matches!(role, Role::Element | Role::Advected)
            });
            return Some(match (function, moves) {
                (true, _) => d
                    .help(format!("write `{n}*(...)` for the product"))
                    .help(format!("rename the quantity to call the function `{n}`")),
                (false, true) => d.help(format!(
                    "write `{n}*(...)` for the product, `next({n})` for its value at the next node"
                )),
                (false, false) => d
                    .help(format!("write `{n}*(...)` for the product"))
                    .help(format!("functions: {AVAILABLE}")),
            });
        }
        if function {
            return None;
        }
        let d = Diagnostic::new(
            name.place,
            format!("`{n}` is not a function of the language"),
        );
        if let Some(written) = unknown::function(n) {
            return Some(d.help(written));
        }
        let d = match closest(n, AVAILABLE.split(' ')) {
            Some(near) => d.help(format!("did you mean `{near}`?")),
            // A misspelt name of another language.
            None => match unknown::nearest_function(n) {
                Some((near, written)) => d.help(format!("for `{near}`: {written}")),
                None => d,
            },
        };
        Some(d.help(format!("functions: {AVAILABLE}")))
    }

    /// Suggests the kinetic energy of a body, if the expression is the velocity of one.
    fn kinetic_of_body(&self, e: &Expr) -> Option<String> {
        let symbols = &self.names.symbols;
        let Node::Letter(at) = e.node() else {
            return None;
        };
        let velocity = symbols.get(at.symbol);
        (velocity.role == Role::Velocity && velocity.structure == Structure::Orthogonal).then(|| {
            let (w, h) = (&velocity.name, &symbols.get(self.names.step).name);
            format!(
                "the velocity `{w}` is the rotation of one step, a matrix: for a body with second moments J, write the kinetic \
                 energy as `-tr(J*{w})/{h}`"
            )
        })
    }

    /// Parts of quaternions and rigid motions.
    fn of_group(&self, f: &str, a: Expr, place: Place) -> Elaborated {
        let symbols = &self.names.symbols;
        let of = |structure| move |_: &str, g: Group| g.structure() == structure;
        let (quaternions, motions) = (of(Structure::UnitQuaternion), of(Structure::RigidMotion));
        let shaped = |which: &dyn Fn(&str, Group) -> bool| {
            let all = groups::TABLE.iter();
            all.filter_map(|line| Some((line.group)(Dim::Fixed(line.size?))))
                .any(|g| which("", g) && g.shape() == a.shape())
        };
        let quaternion = is_element(symbols, &a, Structure::UnitQuaternion);
        let motion = is_element(symbols, &a, Structure::RigidMotion);
        match f {
            "re" if shaped(&quaternions) => return Ok(expr::real(a)),
            "im" if shaped(&quaternions) => return Ok(expr::imaginary(a)),
            "rot" if shaped(&quaternions) && quaternion => return Ok(expr::rotation(symbols, a)),
            "rot" if shaped(&motions) && motion => return Ok(expr::block(symbols, &a)),
            "pos" if shaped(&motions) && motion => return Ok(expr::column(symbols, &a)),
            _ => {}
        }
        let what = shape_text(symbols, a.shape());
        let (groups, example) = match f {
            "re" | "im" => {
                let d = Diagnostic::new(
                    place,
                    format!("`{f}` needs a 4 x 4 matrix, and this is {what}"),
                );
                let own = groups::listed("and", quaternions);
                return fail(d.help(format!("elements of {own} are 4 x 4 matrices")));
            }
            "rot" => (
                groups::listed("or", |n, g| quaternions(n, g) || motions(n, g)),
                "rot(g)",
            ),
            _ => (groups::listed("or", motions), "pos(G)"),
        };
        let message = match a.shape().is_square() {
            true => {
                format!("`{f}` needs an element of {groups}, or products and inverses of elements")
            }
            false => format!("`{f}` needs an element of {groups}, and this is {what}"),
        };
        fail(Diagnostic::new(place, message).help(format!("write for example `{example}`")))
    }

    pub(super) fn call(
        &self,
        name: &Name,
        args: &[Expression],
        place: Place,
        expected: Option<Shape>,
    ) -> Elaborated {
        if let Some(given) = self.names.symbols.functional_named(&name.text) {
            return self.user_function_call(given, args, place);
        }
        if let Some(d) = self.no_function(name) {
            return fail(d);
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
            let d = Diagnostic::new(place, message).help(format!("write `{example}`"));
            return fail(match (f, unknown::function("derivative")) {
                ("dot", Some(rate))
                    if matches!(
                        args,
                        [Expression {
                            kind: Kind::Name(_),
                            ..
                        }]
                    ) =>
                {
                    d.help(rate)
                }
                _ => d,
            });
        }
        let three = |a: &Expr, at: Place| {
            if a.shape() == Shape::vector(Dim::Fixed(3)) {
                return Ok(());
            }
            let what = shape_text(symbols, a.shape());
            let d = Diagnostic::new(
                at,
                format!("`{f}` needs a vector of length 3, and this is {what}"),
            );
            fail(
                match f == "cross" && a.shape() == Shape::vector(Dim::Fixed(2)) {
                    true => d.help("in the plane `dot(perp(a), b)` is a[1]*b[2] - a[2]*b[1]"),
                    false => d,
                },
            )
        };
        let first = &args[0];
        let argument = |context: Option<Shape>| self.elaborate(first, context);
        match f {
            "diag" => self.diagonal(first, expected),
            "tr" | "Tr" | "det" | "I1" | "I2" | "inv" | "sym" | "skew" => {
                let context = if matches!(f, "inv" | "sym" | "skew") {
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
                    _ => expr::part(Part::Skew, a),
                })
            }
            "sqrt" => {
                let a = self.of_shape(first, Shape::SCALAR)?;
                self.power(a, Rational::HALF, first.place, place)
            }
            "abs" if self.hint(first).is_some_and(Shape::is_vector) => {
                let d = Diagnostic::new(first.place, "`abs` takes a number, and this is a vector");
                fail(d.help("the length of a vector x is `sqrt(dot(x, x))`"))
            }
            _ if let Some(function) = Function::named(f) => {
                let a = self.of_shape(first, Shape::SCALAR)?;
                self.function(function, a, first.place, place)
            }
            "hat" | "quat" => {
                let a = argument(Some(Shape::vector(Dim::Fixed(3))))?;
                three(&a, first.place)?;
                Ok(match f {
                    "hat" => expr::hat(a),
                    _ => expr::pure(a),
                })
            }
            "perp" => {
                let plane = Shape::vector(Dim::Fixed(2));
                let a = argument(Some(plane))?;
                if a.shape() != plane {
                    let what = shape_text(symbols, a.shape());
                    let message = format!("`perp` rotates a vector in the plane, and this is {what}");
                    let d = Diagnostic::new(first.place, message);
                    return fail(d.help("perp(x) = (-x[2], x[1]) takes a `Vec<2>`"));
                }
                Ok(expr::mul(expr::quarter_turn(symbols), a))
            }
            "vee" => {
                let a = argument(Some(Shape::square(Dim::Fixed(3))))?;
                if a.shape() != Shape::square(Dim::Fixed(3)) {
                    let what = shape_text(symbols, a.shape());
                    let message = format!("`vee` needs a 3 x 3 matrix, and this is {what}");
                    return fail(Diagnostic::new(first.place, message));
                }
                Ok(expr::vee(a))
            }
            "dot" | "cross" => {
                if f == "cross" {
                    let context = Some(Shape::vector(Dim::Fixed(3)));
                    let (a, b) = (argument(context)?, self.elaborate(&args[1], context)?);
                    three(&a, first.place)?;
                    three(&b, args[1].place)?;
                    return Ok(expr::cross(a, b));
                }
                let (a, b) = self.pair(first, &args[1])?;
                if !a.shape().is_vector() {
                    let what = shape_text(symbols, a.shape());
                    return fail(
                        Diagnostic::new(
                            first.place,
                            format!("`dot` pairs two vectors, and this is {what}"),
                        )
                        .help(match a.shape().is_scalar() {
                            true => "multiply numbers as `a*b`, and square them as `a^2`".to_owned(),
                            false => self.kinetic_of_body(&a).unwrap_or_else(|| {
                                "for two matrices, write `tr(A^T * B)`".to_owned()
                            }),
                        }),
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
                            format!("`{f}` of a constant is the constant"),
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
                        return fail(messages::shift_too_far(place, symbols, l));
                    }
                }
                Ok(shifted)
            }
            "re" | "im" | "rot" | "pos" => {
                let four = Shape::square(Dim::Fixed(4));
                let a = argument(Some(self.hint(first).unwrap_or(four)))?;
                self.of_group(f, a, first.place)
            }
            "sum" => fail(
                Diagnostic::new(name.place, "`sum` runs over the sites of a label, and this model has no label")
                    .help("declare a label, `label i in 0..N;`, and quantities `at nodes` or `at segments`; then `hold p: \
                        sum(m*x) = X;` constrains their sum"),
            ),
            _ => fail(
                Diagnostic::new(
                    name.place,
                    format!("this version does not derive models with `{f}` yet"),
                )
                .help(format!("functions: {AVAILABLE}")),
            ),
        }
    }
}
