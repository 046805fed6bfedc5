//! Velocities in three-dimensional parts: a unit quaternion as a scalar and a vector, a rigid motion as a rotation
//! and a vector. The equations of each step are then vector equations. Takes the model and expressions of its
//! derivation; gives these expressions in the parts.

use super::Letters;
use crate::algebra::Rational;
use crate::check::spec::{Group, Side, Spec};
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Map, Node, Part, Shift};

const THREE: Dim = Dim::Fixed(3);

/// The parts of one velocity.
#[derive(Clone, Copy, Debug)]
pub enum Velocity {
    /// SO(3): the rotation itself.
    Rotation(SymbolId),
    /// SU(2): real and imaginary part.
    Quaternion(SymbolId, SymbolId),
    /// SE(3): rotation and translation.
    Motion(SymbolId, SymbolId),
}

/// All velocities by parts.
#[derive(Clone, Debug)]
pub struct Parts {
    /// The letters of the derivation, the letters of the parts, and [`Parts::direction`].
    pub symbols: Symbols,
    /// The parts, one configuration after the other.
    pub velocities: Vec<Velocity>,
    /// The vector of three coordinates along which tangents are computed.
    pub direction: SymbolId,
    /// The velocities in the model.
    whole: Vec<Letter>,
}

/// The letter at its own edge.
fn at(symbol: SymbolId) -> Letter {
    Letter {
        symbol,
        shift: Shift::HERE,
    }
}

impl Parts {
    /// The parts of a model; `None` if one of its groups is not a group of space.
    pub fn of(spec: &Spec, letters: &Letters) -> Option<Parts> {
        let mut symbols = letters.symbols.clone();
        let mut add = |name: &str, shape: Shape, structure: Structure| {
            let name = symbols.fresh_name(name);
            symbols.add(&name, shape, structure, Role::Derived)
        };
        let mut velocities = Vec::new();
        for c in &spec.configurations {
            let name = &letters.symbols.get(c.velocity).name;
            let named = |part: &str| format!("{name}_{part}");
            velocities.push(match c.group {
                group if group.is_of_space() => Velocity::Rotation(c.velocity),
                Group::UnitQuaternions(_) => Velocity::Quaternion(
                    add(&named("re"), Shape::SCALAR, Structure::General),
                    add(&named("im"), Shape::vector(THREE), Structure::General),
                ),
                Group::RigidMotions(_) => Velocity::Motion(
                    add(&named("rot"), Shape::square(THREE), Structure::Orthogonal),
                    add(&named("pos"), Shape::vector(THREE), Structure::General),
                ),
                _ => return None,
            });
        }
        let direction = add("η", Shape::vector(THREE), Structure::General);
        let whole = spec.configurations.iter().map(|c| at(c.velocity));
        Some(Parts {
            whole: whole.collect(),
            symbols,
            velocities,
            direction,
        })
    }

    /// A covector of every configuration as vectors of three components.
    pub fn covectors(&self, list: &[Expr]) -> Vec<Expr> {
        let mut all = Vec::new();
        for (e, v) in list.iter().zip(&self.velocities) {
            match v {
                Velocity::Rotation(_) | Velocity::Quaternion(..) => all.push(e.clone()),
                Velocity::Motion(..) => {
                    all.extend([0, 3].map(|row| expr::taken_rows(&self.symbols, e, row, THREE)));
                }
            }
        }
        all
    }

    /// The changes of the parts if the velocity moves along the direction, from the right (the side of the body) or
    /// from the left: one list per block of three coordinates, in the order of the coordinates of the group.
    pub fn changes(&self, side: Side) -> Vec<Vec<(Letter, Expr)>> {
        let letter = |id: SymbolId| expr::here(&self.symbols, id);
        let along = letter(self.direction);
        let half = |e: Expr| expr::scale(Rational::HALF, e);
        let turned = |w: SymbolId| side.product(letter(w), expr::hat(along.clone()));
        let mut all = Vec::new();
        for v in &self.velocities {
            match *v {
                Velocity::Rotation(w) => all.push(vec![(at(w), turned(w))]),
                Velocity::Quaternion(re, im) => {
                    let (first, second) = side.ordered(letter(im), along.clone());
                    let across = expr::cross(first, second);
                    let turned = expr::add(expr::mul(letter(re), along.clone()), across);
                    let real = expr::neg(half(expr::dot(letter(im), along.clone())));
                    all.push(vec![(at(re), real), (at(im), half(turned))]);
                }
                Velocity::Motion(rot, pos) => match side.is_body() {
                    true => {
                        let shift = expr::mul(letter(rot), along.clone());
                        all.push(vec![(at(rot), turned(rot))]);
                        all.push(vec![(at(pos), shift)]);
                    }
                    // The translation rotates too.
                    false => {
                        let carried = expr::mul(expr::hat(along.clone()), letter(pos));
                        all.push(vec![(at(rot), turned(rot)), (at(pos), carried)]);
                        all.push(vec![(at(pos), along.clone())]);
                    }
                },
            }
        }
        all
    }

    /// An expression in the parts; `None` if a velocity of a group other than SO(3) remains whole.
    pub fn write(&self, e: &Expr) -> Option<Expr> {
        let written = self.straight(&expr::collect(&self.symbols, &self.lowered(e)));
        let whole = self.whole.iter().zip(&self.velocities);
        let mut other = whole.filter(|(_, v)| !matches!(v, Velocity::Rotation(_)));
        let stays = other.any(|(w, _)| expr::contains(&written, *w));
        (!stays).then_some(written)
    }

    /// Whether this letter is a velocity or a part of one.
    pub fn varies(&self, l: Letter) -> bool {
        self.velocities.iter().any(|v| match v {
            Velocity::Rotation(w) => l == at(*w),
            Velocity::Quaternion(x, y) | Velocity::Motion(x, y) => l == at(*x) || l == at(*y),
        })
    }

    /// The parts of an expression that is a velocity itself.
    fn velocity(&self, e: &Expr) -> Option<Velocity> {
        let Node::Letter(letter) = e.node() else {
            return None;
        };
        let i = self.whole.iter().position(|w| w == letter)?;
        self.velocities.get(i).copied()
    }

    fn lowered(&self, e: &Expr) -> Expr {
        let letter = |id: SymbolId| expr::here(&self.symbols, id);
        if let Node::Map(map, a) = e.node() {
            match (map, self.velocity(a)) {
                (Map::Rotation, Some(Velocity::Motion(rot, _))) => return letter(rot),
                (Map::Translation, Some(Velocity::Motion(_, pos))) => return letter(pos),
                (Map::Rotation, Some(Velocity::Quaternion(re, im))) => {
                    // Id + 2 hat(v) (w + hat(v)).
                    let hat = expr::hat(letter(im));
                    let w = expr::mul(letter(re), expr::identity(THREE));
                    let two = Rational::integer(2);
                    let turn = expr::scale(two, expr::mul(hat.clone(), expr::add(w, hat)));
                    return expr::add(expr::identity(THREE), turn);
                }
                (Map::Real, _) => {
                    if let Some((real, _)) = self.quaternion(a) {
                        return real;
                    }
                }
                (Map::Imaginary, _) => {
                    if let Some((_, imaginary)) = self.quaternion(a) {
                        return imaginary;
                    }
                }
                _ => {}
            }
        }
        if let Node::Trace(a) = e.node()
            && a.shape() == Shape::square(Dim::Fixed(4))
            && let Some((real, _)) = self.quaternion(a)
        {
            return expr::scale(Rational::integer(4), real);
        }
        expr::rebuild(&self.symbols, e, &mut |x| self.lowered(x))
    }

    /// A sum of words of quaternions as real and imaginary part.
    fn quaternion(&self, e: &Expr) -> Option<(Expr, Expr)> {
        let vector = Shape::vector(THREE);
        let none = || expr::zero(vector);
        Some(match e.node() {
            Node::Letter(_) => match self.velocity(e)? {
                Velocity::Quaternion(re, im) => {
                    (expr::here(&self.symbols, re), expr::here(&self.symbols, im))
                }
                Velocity::Rotation(_) | Velocity::Motion(..) => return None,
            },
            Node::Identity(_) => (expr::integer(1), none()),
            Node::Map(Map::Pure, v) => (expr::integer(0), self.lowered(v)),
            Node::Transpose(a) | Node::Inverse(a) => {
                let (re, im) = self.quaternion(a)?;
                (re, expr::neg(im))
            }
            Node::Part(Part::Symmetric, a) => (self.quaternion(a)?.0, none()),
            Node::Part(Part::Skew, a) => (expr::integer(0), self.quaternion(a)?.1),
            Node::Neg(a) => {
                let (re, im) = self.quaternion(a)?;
                (expr::neg(re), expr::neg(im))
            }
            Node::Quotient(a, b) => {
                let ((re, im), b) = (self.quaternion(a)?, self.lowered(b));
                (expr::quotient(re, b.clone()), expr::quotient(im, b))
            }
            Node::Sum(terms) => {
                let parts: Option<Vec<(Expr, Expr)>> =
                    terms.iter().map(|t| self.quaternion(t)).collect();
                let (re, im): (Vec<Expr>, Vec<Expr>) = parts?.into_iter().unzip();
                (expr::sum(re, Shape::SCALAR), expr::sum(im, vector))
            }
            Node::Product(factors) => {
                let (mut re, mut im) = (expr::integer(1), none());
                for f in factors {
                    if f.shape().is_scalar() {
                        let f = self.lowered(f);
                        (re, im) = (expr::mul(f.clone(), re), expr::mul(f, im));
                        continue;
                    }
                    let (b, v) = self.quaternion(f)?;
                    let real = expr::sub(
                        expr::mul(re.clone(), b.clone()),
                        expr::dot(im.clone(), v.clone()),
                    );
                    let turned = [
                        expr::mul(re, v.clone()),
                        expr::mul(b, im.clone()),
                        expr::cross(im, v),
                    ];
                    (re, im) = (real, expr::sum(turned, vector));
                }
                (re, im)
            }
            _ => return None,
        })
    }

    /// `R (a x R^T b)` as `R a x b` for a rotation among the velocities, without rotating back and forth.
    fn straight(&self, e: &Expr) -> Expr {
        let e = expr::rebuild(&self.symbols, e, &mut |x| self.straight(x));
        let Node::Product(factors) = e.node() else {
            return e;
        };
        let [before @ .., turn, last] = factors.as_slice() else {
            return e;
        };
        if !matches!(last.node(), Node::Cross(..)) || !self.is_turn(turn) {
            return e;
        }
        match expr::turned(&self.symbols, turn, last) {
            Some(last) => expr::product(before.iter().cloned().chain([last])),
            None => e,
        }
    }

    /// Whether this is a rotation among the velocities, or its inverse.
    fn is_turn(&self, e: &Expr) -> bool {
        let e = match e.node() {
            Node::Transpose(a) => a,
            _ => e,
        };
        let Node::Letter(l) = e.node() else {
            return false;
        };
        let mut all = self.velocities.iter();
        all.any(|v| match v {
            Velocity::Rotation(w) | Velocity::Motion(w, _) => *l == at(*w),
            Velocity::Quaternion(..) => false,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Parts, THREE, Velocity};
    use crate::algebra::Algebra;
    use crate::expr;
    use crate::pipeline::derive_source;

    #[test]
    fn quaternions_multiply_and_turn_by_their_parts() {
        let text = "model M { param J, K: Sym<3>; group P: SU<2> velocity V; group Q: SU<2> velocity W; \
            constraint next(P) = P*V; constraint next(Q) = Q*W; \
            lagrangian = 2*(dot(im(V), J*im(V)) + dot(im(W), K*im(W)))/h; }";
        let d = derive_source(text).unwrap_or_else(|e| panic!("{e}"));
        let parts = Parts::of(&d.spec, &d.letters).expect("groups of space");
        let s = &parts.symbols;
        let algebra = Algebra::new(s);
        let [(a, u), (b, v)] = [0, 1].map(|i| match parts.velocities[i] {
            Velocity::Quaternion(re, im) => (expr::here(s, re), expr::here(s, im)),
            other => panic!("{other:?}"),
        });
        let [p, q] = [0, 1].map(|i| expr::here(s, d.spec.configurations[i].velocity));
        let product = parts.quaternion(&expr::mul(p.clone(), q)).expect("parts");
        let dot = expr::dot(u.clone(), v.clone());
        let real = expr::sub(expr::mul(a.clone(), b.clone()), dot.clone());
        assert!(algebra.equal(&product.0, &real));
        let flat = expr::add(
            expr::mul(a.clone(), v.clone()),
            expr::mul(b.clone(), u.clone()),
        );
        let across = expr::cross(u.clone(), v);
        assert!(algebra.equal(&product.1, &expr::add(flat.clone(), across.clone())));
        // The product in the other order, and the product with the conjugate, are different.
        assert!(!algebra.equal(&product.1, &expr::sub(flat, across)));
        assert!(!algebra.equal(&product.0, &expr::add(expr::mul(a.clone(), b), dot)));
        // Rodrigues: Id + 2 a hat(u) + 2 hat(u)^2.
        let turn = parts.lowered(&expr::rotation(s, p));
        let hat = expr::hat(u);
        let rodrigues = |sign: i64| {
            let terms = [
                expr::identity(THREE),
                expr::product([expr::integer(2), a.clone(), hat.clone()]),
                expr::product([expr::integer(2 * sign), hat.clone(), hat.clone()]),
            ];
            expr::sum(terms, hat.shape())
        };
        assert!(algebra.equal(&turn, &rodrigues(1)));
        assert!(!algebra.equal(&turn, &rodrigues(-1)));
    }
}
