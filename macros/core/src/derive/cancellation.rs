//! Estimates rounding errors far from the origin: `X - Y` of two positions preserves the digits of their distance.
//! Its expanded square loses all digits that the two positions have in common. Takes expressions; gives the power of
//! the distance from the origin to which their rounding error is proportional.

use crate::algebra::Algebra;
use crate::algebra::exact::{ATTEMPTS, Point};
use crate::expr::position_differences;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Letter, Map, Node};

/// Powers of the distance from the origin: one for the value, and one for its rounding error in units of `EPSILON`.
/// The power of an exact value is minus infinity.
#[derive(Clone, Copy)]
struct Order {
    size: f64,
    error: f64,
}

/// The largest part that is searched for cancellation.
const LARGEST: u32 = 400;

/// The power of the distance from the origin to which the rounding error of an expression is proportional. Positions
/// are far from the origin and near each other: values of fields, translations of rigid motions, and constants that
/// are subtracted from these. Zero if no position occurs.
pub(crate) fn error(algebra: &Algebra, e: &Expr) -> f64 {
    let symbols = algebra.symbols();
    if !expr::letters(e).iter().any(|l| is_place(symbols, l)) {
        return 0.0;
    }
    let mut centres = Vec::new();
    position_differences::centres(symbols, e, &mut centres);
    Far { symbols, centres }.order(e).error.max(0.0)
}

/// The preferred of two equal expressions, unless the other has a smaller rounding error far from the origin.
pub(super) fn nearer(algebra: &Algebra, preferred: Expr, other: Expr) -> Expr {
    match error(algebra, &other) < error(algebra, &preferred) {
        true => other,
        false => preferred,
    }
}

/// The reduced form of an expression, unless its rounding error is larger far from the origin. Otherwise the form
/// reduced with differences of positions unchanged, or the expression itself.
pub(super) fn least(algebra: &Algebra, reduced: Expr, e: &Expr) -> Expr {
    let expanded = error(algebra, &reduced);
    if expanded == 0.0 {
        return reduced;
    }
    let kept = between(algebra, e).unwrap_or_else(|| e.clone());
    [kept, e.clone()]
        .into_iter()
        .find(|form| error(algebra, form) < expanded)
        .unwrap_or(reduced)
}

/// The shortest form in which differences of positions are letters of their own.
fn between(algebra: &Algebra, e: &Expr) -> Option<Expr> {
    let named = position_differences::named(algebra.symbols(), e)?;
    let inner = Algebra::new(&named.symbols);
    let reduced = inner.shortest(&named.whole);
    let whole = expr::substitute(&named.symbols, &reduced, &named.definitions);
    (!inner.exhausted()).then_some(whole)
}

/// Whether it is a field or a rigid motion.
fn is_place(s: &Symbols, l: &Letter) -> bool {
    let symbol = s.get(l.symbol);
    let kinds = [Structure::General, Structure::RigidMotion];
    symbol.role == Role::Element && kinds.contains(&symbol.structure)
}

struct Far<'a> {
    /// Constants that are subtracted from positions.
    centres: Vec<Letter>,
    symbols: &'a Symbols,
}

impl Far<'_> {
    fn order(&self, e: &Expr) -> Order {
        let exact = |size| Order {
            size,
            error: f64::NEG_INFINITY,
        };
        match e.node() {
            Node::Number(_)
            | Node::Constant(_)
            | Node::Identity(_)
            | Node::Zero(_)
            | Node::Unit(..)
            | Node::Inclusion(..) => exact(0.0),
            Node::Letter(l) => exact(f64::from(u8::from(self.is_far(l)))),
            Node::Sum(terms) => {
                let inside = terms.iter().map(|t| self.order(t)).fold(exact(0.0), sum);
                // The partial sums of more than two terms are rounded before the last term cancels; differences of
                // positions, which are emitted first, are not.
                let size = self.size(e, inside.size);
                let paired = terms.len() == 2 || position_differences::is_between(self.symbols, e);
                let rounded = if paired { size } else { inside.size };
                Order {
                    size,
                    error: inside.error.max(rounded),
                }
            }
            Node::Product(factors) => {
                let mut all = factors.iter().map(|f| self.order(f));
                match all.next() {
                    Some(first) => all.fold(first, product),
                    None => exact(0.0),
                }
            }
            Node::Dot(a, b) | Node::Cross(a, b) => {
                let inside = product(self.order(a), self.order(b));
                Order {
                    size: self.size(e, inside.size),
                    ..inside
                }
            }
            Node::Quotient(a, b) => product(self.order(a), power(self.order(b), -1.0)),
            Node::Power(a, q) => power(self.order(a), q.value()),
            Node::Map(Map::Rotation, a) if expr::is_motion(self.symbols, a) => exact(0.0),
            Node::Neg(a)
            | Node::Transpose(a)
            | Node::Hat(a)
            | Node::Vee(a)
            | Node::Part(_, a)
            | Node::Map(_, a) => self.order(a),
            Node::Trace(a) => {
                let inside = self.order(a);
                Order {
                    size: self.size(e, inside.size),
                    error: inside.error.max(inside.size),
                }
            }
            Node::Inverse(a) | Node::Det(a) | Node::Adjugate(a) | Node::Call(_, a) => Order {
                size: 0.0,
                error: self.order(a).error.max(0.0),
            },
            // Only the rounding of its arguments is known.
            Node::Given(_) | Node::PullBack(..) => Order {
                size: 0.0,
                error: {
                    let inside = e.children().into_iter().map(|x| self.order(x).error);
                    inside.fold(0.0, |worst: f64, error| worst.max(error))
                },
            },
        }
    }

    /// The power of the value; zero if the value is invariant under translation of all positions.
    fn size(&self, e: &Expr, largest: f64) -> f64 {
        // A weighted sum is invariant if its positions move together, but not if each position of a shape moves by
        // the same amount.
        let weighted = match e.node() {
            Node::Sum(terms) => position_differences::are_weighted(self.symbols, e, terms),
            _ => false,
        };
        let stays = largest > 0.0 && e.size() <= LARGEST && (weighted || self.stays(e));
        if stays { 0.0 } else { largest }
    }

    fn is_far(&self, l: &Letter) -> bool {
        is_place(self.symbols, l) || self.centres.contains(l)
    }

    /// Whether the expression is invariant under translations. Positions of each shape are translated separately.
    fn stays(&self, e: &Expr) -> bool {
        let letters = expr::letters(e);
        let far: Vec<Letter> = letters.into_iter().filter(|l| self.is_far(l)).collect();
        let shape = |l: &Letter| {
            let symbol = self.symbols.get(l.symbol);
            match symbol.structure {
                Structure::RigidMotion => Shape::vector(expr::within(symbol.shape.rows)),
                _ => symbol.shape,
            }
        };
        let mut shapes: Vec<Shape> = far.iter().map(shape).collect();
        shapes.dedup();
        shapes.into_iter().all(|moved| {
            let along = far.iter().filter(|l| shape(l) == moved);
            let along: Vec<(Letter, Expr)> = along.map(|l| (*l, self.shift(l))).collect();
            let change = expr::directional(self.symbols, e, &along);
            change.is_zero() || self.vanishes(&change)
        })
    }

    /// Whether it is zero at random points, which cost less than a normal form. This is reliable enough, because only
    /// the choice between equal forms depends on it.
    fn vanishes(&self, e: &Expr) -> bool {
        let values = (0..ATTEMPTS).filter_map(|attempt| Point::new(self.symbols, attempt).value(e));
        let mut two = values.take(2).peekable();
        two.peek().is_some() && two.all(|value| value.vanishes())
    }

    /// A displacement of a position, in a direction different from every axis.
    fn shift(&self, l: &Letter) -> Expr {
        let symbol = self.symbols.get(l.symbol);
        let generic = |n: Dim| {
            let count = match n {
                Dim::Fixed(n) => n.min(3),
                Dim::Named(_) => 1,
            };
            let along = |k| expr::mul(expr::integer(i64::from(k) + 2), expr::unit(n, k));
            expr::sum((0..count as u8).map(along), Shape::vector(n))
        };
        if symbol.structure == Structure::RigidMotion {
            let whole = symbol.shape.rows;
            let last = expr::last_axis(whole);
            let along = |k| expr::mul(expr::integer(i64::from(k) + 2), expr::unit(whole, k));
            let by = expr::sum((0..last).map(along), Shape::vector(whole));
            return expr::mul(by, expr::transpose(self.symbols, expr::unit(whole, last)));
        }
        match (symbol.shape.is_scalar(), symbol.shape.is_vector()) {
            (true, _) => expr::integer(1),
            (_, true) => generic(symbol.shape.rows),
            _ => expr::mul(
                generic(symbol.shape.rows),
                expr::transpose(self.symbols, generic(symbol.shape.cols)),
            ),
        }
    }
}

fn sum(a: Order, b: Order) -> Order {
    Order {
        size: a.size.max(b.size),
        error: a.error.max(b.error),
    }
}

fn product(a: Order, b: Order) -> Order {
    let size = a.size + b.size;
    Order {
        size,
        error: (a.error + b.size).max(b.error + a.size).max(size),
    }
}

fn power(a: Order, q: f64) -> Order {
    let size = a.size * q;
    Order {
        size,
        error: (a.error + a.size * (q - 1.0)).max(size),
    }
}

#[cfg(test)]
mod tests {
    use super::error;
    use crate::algebra::Algebra;
    use crate::{Derivation, derive_source};

    fn derived(body: &str) -> Derivation {
        let text = format!("model Far {{ param m, k: Real; param J: Sym<3>; {body} }}");
        derive_source(&text).unwrap_or_else(|e| panic!("{text}: {e:?}"))
    }

    /// For each force, the power of the distance from the origin to which its rounding error is proportional.
    fn roundings(d: &Derivation) -> Vec<f64> {
        let algebra = Algebra::new(&d.letters.symbols);
        let parts = d
            .balances
            .iter()
            .flat_map(|b| [&b.outgoing, &b.incoming].into_iter().chain(&b.increment));
        let carried = d.carries.iter().flat_map(|c| c.parts());
        let all = parts.chain(carried);
        all.map(|e| error(&algebra, e)).collect()
    }

    #[test]
    fn forces_are_rounded_to_distances() {
        let mass = |x: &str| format!("m*dot(next({x}) - {x}, next({x}) - {x})/(2*h)");
        let (x, y) = (mass("X"), mass("Y"));
        for body in [
            format!("field X, Y: Vec<3>; lagrangian = {x} + {y} - h*k*dot(X - Y, X - Y)^2;"),
            format!(
                "param c: Vec<2>; field X: Vec<2>; lagrangian = {x} - h*k*dot(X - c, X - c)^3;"
            ),
            format!(
                "param a: Vec<3>; group G: SE<3> velocity V; field X: Vec<3>; \
                 constraint next(G) = G*V; let s = pos(G) + rot(G)*a - X; \
                 lagrangian = {x} - tr(J*rot(V))/h + m*dot(pos(V), pos(V))/(2*h) \
                 - h*k*dot(s, s)^2;"
            ),
            "field X, Y: Real; lagrangian = m*(next(X) - X)^2/(2*h) + m*(next(Y) - Y)^2/(2*h) \
             - h*k*(X - Y)^4;"
                .to_owned(),
        ] {
            let found = roundings(&derived(&body));
            assert!(found.iter().all(|power| *power == 0.0), "{found:?} {body}");
        }
        // With weights, along axes and by components: the rounding error of a product with a weight grows with the
        // distance.
        for body in [
            format!(
                "field x: Real; field X: Vec<2>; let w = X - x*E1; \
                 lagrangian = m*(next(x) - x)^2/(2*h) + {x} - h*k*(dot(w, w) - m^2)^2;"
            ),
            format!(
                "field x: Real; field X: Vec<2>; \
                 lagrangian = m*(next(x) - x)^2/(2*h) + {x} - h*k*(X[1] - x)^4;"
            ),
            "param r: Real; field X, Y: Real; lagrangian = m*(next(X) - X)^2/(2*h) \
             + m*(next(Y) - Y)^2/(2*h) - h*k*(X - r*Y)^4;"
                .to_owned(),
        ] {
            let found = roundings(&derived(&body));
            assert!(found.iter().all(|power| *power <= 1.0), "{found:?} {body}");
        }
        // The rounding error of a force about the origin grows with the distance.
        let about = format!("field X: Vec<3>; lagrangian = {x} - h*k*dot(X, X)^2;");
        let found = roundings(&derived(&about));
        assert!(found.iter().any(|power| *power >= 3.0), "{found:?}");
    }
}
