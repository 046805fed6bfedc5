//! Estimates the rounding error of an expression for small step sizes. Velocities are then near the identity, and
//! `(Ω - 1) a / h` has sixteen correct digits, whereas `Ω a / h - a / h` loses some. Takes expressions; gives the order
//! of their values in the step size, and the order of their rounding errors.

use super::cancellation;
use crate::algebra::Algebra;
use crate::check::spec::Spec;
use crate::expr::shape::Structure;
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Map, Node, Shift};
use crate::schedule;

/// Powers of the step size: `size` for the value, `error` for its rounding error in units of `EPSILON`. For exact
/// values the power is infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    /// The power of the step size to which the value is proportional.
    pub size: f64,
    /// The rounding error is `EPSILON` times this power of the step size.
    pub error: f64,
}

/// The input of the estimate.
pub struct Rounding<'a> {
    /// The model.
    pub spec: &'a Spec,
    /// Letters of the expressions.
    pub symbols: &'a Symbols,
    /// Decides which expressions vanish at zero velocity.
    pub algebra: &'a Algebra<'a>,
}

/// Letters for velocities minus the identity, in which small terms are small.
pub struct Displacements {
    /// The letters of the model, and the letters of the displacements.
    pub symbols: Symbols,
    /// One letter per configuration whose velocity is a matrix in its own coordinates.
    letters: Vec<Option<SymbolId>>,
}

impl Displacements {
    /// Adds the letters for a model.
    pub fn of(spec: &Spec, symbols: &Symbols) -> Displacements {
        let mut symbols = symbols.clone();
        let configurations = spec.configurations.iter();
        let letters = configurations
            .map(|c| {
                let matrices = c.group.coordinates().is_none() && !c.group.is_additive();
                matrices.then(|| {
                    let name = symbols.fresh_name("D");
                    let shape = c.group.shape();
                    symbols.add(&name, shape, Structure::General, Role::Velocity)
                })
            })
            .collect();
        Displacements { symbols, letters }
    }

    /// The normal form of an expression in displacements, with velocities substituted back.
    pub fn normal_form(&self, spec: &Spec, algebra: &Algebra, e: &Expr) -> Expr {
        let s = &self.symbols;
        let (mut there, mut back) = (Vec::new(), Vec::new());
        for (c, small) in spec.configurations.iter().zip(&self.letters) {
            if let Some(small) = small {
                let here = |symbol| Letter {
                    symbol,
                    shift: Shift::HERE,
                };
                let one = c.group.identity();
                there.push((
                    here(c.velocity),
                    expr::add(expr::here(s, *small), one.clone()),
                ));
                back.push((here(*small), expr::sub(expr::here(s, c.velocity), one)));
            }
        }
        let in_small = expr::substitute(s, e, &there);
        expr::substitute(s, &algebra.shortest(&in_small), &back)
    }
}

impl Rounding<'_> {
    /// The form with the smallest rounding error for small steps; among equals, the one with the smallest rounding
    /// error far from the origin, then the shortest.
    pub fn best(&self, forms: Vec<Expr>) -> Expr {
        let mut best: Option<((f64, f64), Expr)> = None;
        for form in forms {
            let small = self.error(&form).min(0.0);
            let kept = (small, -cancellation::error(self.algebra, &form));
            let better = best.as_ref().is_none_or(|(least, known)| {
                kept > *least || kept == *least && form.size() < known.size()
            });
            if better {
                best = Some((kept, form));
            }
        }
        best.map_or_else(|| expr::integer(0), |(_, form)| form)
    }

    /// The power of the step size to which the rounding error of an expression is proportional.
    pub fn error(&self, e: &Expr) -> f64 {
        self.order(e).error
    }

    /// Whether it vanishes at zero velocity, that is, for velocities at the identity.
    fn rests_at_zero(&self, e: &Expr) -> bool {
        let velocities = self.spec.configurations.iter().map(|c| {
            let letter = Letter {
                symbol: c.velocity,
                shift: Shift::HERE,
            };
            (letter, c.group.identity())
        });
        let rest: Vec<(Letter, Expr)> = velocities.collect();
        let forward = expr::substitute(self.symbols, e, &self.spec.end_of_edge());
        self.algebra
            .is_zero(&expr::substitute(self.symbols, &forward, &rest))
    }

    /// Whether it is the increment of a field, which is a small number of its own.
    fn is_increment(&self, l: &Letter) -> bool {
        let fields = self.spec.configurations.iter();
        fields
            .filter(|c| c.group.is_additive())
            .any(|c| c.velocity == l.symbol)
    }

    fn moves(&self, e: &Expr) -> bool {
        expr::letters(e)
            .iter()
            .any(|l| self.symbols.get(l.symbol).role == Role::Velocity || l.shift.time != 0)
    }

    /// The order `inside`, with one more power of the step size in the value if the expression vanishes at zero
    /// velocity.
    fn cancelling(&self, e: &Expr, inside: Order) -> Order {
        let gains = self.moves(e) && self.rests_at_zero(e);
        Order {
            size: inside.size + f64::from(u8::from(gains)),
            error: inside.error,
        }
    }

    fn order(&self, e: &Expr) -> Order {
        let exact = |size| Order {
            size,
            error: f64::INFINITY,
        };
        let small = Order {
            size: 1.0,
            error: 1.0,
        };
        match e.node() {
            Node::Number(_)
            | Node::Constant(_)
            | Node::Identity(_)
            | Node::Zero(_)
            | Node::Unit(..)
            | Node::Inclusion(..) => exact(0.0),
            Node::Letter(l) => {
                let is_small =
                    self.symbols.get(l.symbol).role == Role::Step || self.is_increment(l);
                let size = f64::from(u8::from(is_small));
                Order { size, error: size }
            }
            // Emitted without loss of digits.
            Node::Sum(_) if schedule::is_difference(self.symbols, e) => small,
            // Off-diagonal entries have digits of their own.
            Node::Vee(a) if schedule::at_rest(self.symbols, a).is_some() => small,
            Node::Sum(terms) => {
                let all = terms.iter().map(|t| self.order(t));
                let inside = all.fold(exact(f64::INFINITY), |a, b| Order {
                    size: a.size.min(b.size),
                    error: a.error.min(b.error),
                });
                self.cancelling(e, inside)
            }
            Node::Product(factors) => {
                let all = factors.iter().map(|f| self.order(f));
                all.fold(exact(0.0), product)
            }
            Node::Dot(a, b) => product(self.order(a), self.order(b)),
            Node::Cross(a, b) => self.cancelling(e, product(self.order(a), self.order(b))),
            Node::Quotient(a, b) => product(self.order(a), power(self.order(b), -1.0)),
            Node::Power(a, q) => power(self.order(a), q.value()),
            Node::Neg(a) | Node::Transpose(a) | Node::Hat(a) => self.order(a),
            Node::Trace(a) | Node::Vee(a) | Node::Part(_, a) => self.cancelling(e, self.order(a)),
            // Stored as numbers of their own, so small values have all digits.
            Node::Map(Map::Imaginary | Map::Translation, a)
                if matches!(a.node(), Node::Letter(_)) && self.moves(a) =>
            {
                small
            }
            Node::Map(_, a) => self.cancelling(e, self.order(a)),
            Node::Inverse(a) | Node::Det(a) | Node::Adjugate(a) | Node::Call(_, a) => Order {
                size: 0.0,
                error: self.order(a).error.min(0.0),
            },
            // Only the rounding of its arguments is known.
            Node::Given(_) | Node::PullBack(..) => Order {
                size: 0.0,
                error: {
                    let inside = e.children().into_iter().map(|x| self.order(x).error);
                    inside.fold(0.0, f64::min)
                },
            },
        }
    }
}

fn product(a: Order, b: Order) -> Order {
    Order {
        size: a.size + b.size,
        error: (a.error + b.size).min(b.error + a.size),
    }
}

fn power(a: Order, q: f64) -> Order {
    Order {
        size: a.size * q,
        error: a.error + a.size * (q - 1.0),
    }
}
