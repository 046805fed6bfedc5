//! Homogeneous matrices in parts: a product of rigid motions becomes the rotation and the position of each. A
//! vector on which they act becomes its part in space and its last component. Takes expressions as stated; gives
//! them in coordinates.

use super::{CoordinateKind, Stated, size};
use crate::algebra::Rational;
use crate::diagnostic::Place;
use crate::syntax::ast::{Expression, Kind, Model, Name, Size, SizedName, Statement};
use std::collections::{BTreeMap, BTreeSet};

/// The rigid motions of a model, and the kinds of its parameters.
pub(super) struct Motions<'a> {
    all: Vec<&'a Stated>,
    /// Parameters that are rigid motions, with their dimension.
    given: BTreeMap<String, usize>,
    /// Vectors with one component more than the dimension of space, with that dimension.
    points: BTreeMap<String, usize>,
    /// Names of scalars.
    numbers: BTreeSet<String>,
}

/// A rotation and a position; for a vector, its part in space and its last component.
type Two = [Expression; 2];

impl<'a> Motions<'a> {
    pub(super) fn of(model: &Model, all: &'a [Stated]) -> Self {
        let is_motion = |x: &&Stated| {
            matches!(
                x.of.by,
                CoordinateKind::AngleAndPlace(..) | CoordinateKind::TurnAndPlace(..)
            )
        };
        let mut out = Motions {
            all: all.iter().filter(is_motion).collect(),
            given: BTreeMap::new(),
            points: BTreeMap::new(),
            numbers: BTreeSet::from(["h".to_owned()]),
        };
        for statement in &model.statements {
            match statement {
                Statement::Param { names, shape, .. } | Statement::Field { names, shape, .. } => {
                    out.take(names, shape);
                }
                Statement::Label {
                    step: Some(step), ..
                }
                | Statement::Time { step, .. } => {
                    out.numbers.insert(step.text.clone());
                }
                Statement::End { alternatives, .. } => {
                    let each = alternatives.iter().flat_map(|a| &a.params);
                    each.for_each(|(names, shape)| out.take(names, shape));
                }
                _ => {}
            }
        }
        out
    }

    fn take(&mut self, names: &[Name], shape: &SizedName) {
        if shape.name.text == "Real" {
            self.numbers.extend(names.iter().map(|n| n.text.clone()));
        }
        let Some(n) = size(shape) else {
            return;
        };
        for name in names {
            match shape.name.text.as_str() {
                "SE" => self.given.insert(name.text.clone(), n),
                "Vec" => self.points.insert(name.text.clone(), n.saturating_sub(1)),
                _ => None,
            };
        }
    }

    /// Whether this is the name of a rigid motion among the configurations, or of its velocity.
    pub(super) fn moves(&self, name: &str) -> bool {
        let mut all = self.all.iter();
        all.any(|x| x.of.name == name || x.velocity == name)
    }

    /// Replaces `rot` and `pos` of motions, and vectors on which motions act, by rotations and positions.
    pub(super) fn apart(&self, e: &Expression) -> Expression {
        if self.all.is_empty() {
            return e.clone();
        }
        e.replaced(&|e| match &e.kind {
            Kind::Call(name, list) => match (name.text.as_str(), list.as_slice()) {
                ("rot", [motion]) => self.two(motion).map(|[turn, _]| turn),
                ("pos", [motion]) => self.two(motion).map(|[_, place]| place),
                ("dot", [a, b]) if self.carries(a) || self.carries(b) => {
                    let ([a, last_a], [b, last_b]) = (self.point(a)?, self.point(b)?);
                    let in_space = kind(e, Kind::Call(name.clone(), vec![a, b]));
                    Some(sum(
                        e,
                        [(false, in_space), (false, product(e, [last_a, last_b]))],
                    ))
                }
                _ => None,
            },
            Kind::Component(vector, which) if self.carries(vector) => {
                let [in_space, last] = self.point(vector)?;
                let dimension = self.dimension(vector)?;
                match which.as_slice() {
                    [i] if usize::try_from(*i).ok() == Some(dimension + 1) => Some(last),
                    [_] => Some(kind(e, Kind::Component(Box::new(in_space), which.clone()))),
                    _ => None,
                }
            }
            _ => None,
        })
    }

    /// The rotation and the position of a motion.
    fn two(&self, e: &Expression) -> Option<Two> {
        match &e.kind {
            Kind::Name(n) => self.named(n, e),
            Kind::Shaped(a, _) => self.two(a),
            Kind::Product(list) => self.composed(e, list),
            Kind::Power(a, q) if *q == Rational::MINUS_ONE => Some(inverse(e, self.two(a)?)),
            Kind::Call(name, list) => match (name.text.as_str(), list.as_slice()) {
                ("inv", [a]) => Some(inverse(e, self.two(a)?)),
                ("next" | "prev", [a, rest @ ..]) => Some(self.two(a)?.map(|part| {
                    let list = [part].into_iter().chain(rest.iter().cloned());
                    kind(e, Kind::Call(name.clone(), list.collect()))
                })),
                _ => None,
            },
            _ => None,
        }
    }

    fn named(&self, n: &str, e: &Expression) -> Option<Two> {
        if self.given.contains_key(n) {
            return Some(["rot", "pos"].map(|f| call(e, f, [name(e, n)])));
        }
        let x = self
            .all
            .iter()
            .find(|x| x.of.name == n || x.velocity == n)?;
        let (own, place) = match &x.of.by {
            CoordinateKind::TurnAndPlace(turn, place) => (name(e, turn), name(e, place)),
            CoordinateKind::AngleAndPlace(angle, place) => {
                (turn_by(e, name(e, angle)), name(e, place))
            }
            CoordinateKind::Entries(_) | CoordinateKind::Angle(_) => return None,
        };
        if x.of.name == n {
            return Some([own, place]);
        }
        let there = call(e, "next", [place.clone()]);
        let of_body = x.of.side.is_body();
        let turn = match &x.of.by {
            CoordinateKind::TurnAndPlace(..) if of_body => name(e, &x.turning),
            CoordinateKind::TurnAndPlace(..) => {
                let turning = name(e, &x.turning);
                product(e, [own.clone(), turning, transposed(e, own.clone())])
            }
            CoordinateKind::AngleAndPlace(angle, _) => {
                let angle = name(e, angle);
                let after = call(e, "next", [angle.clone()]);
                turn_by(e, sum(e, [(false, after), (true, angle)]))
            }
            CoordinateKind::Entries(_) | CoordinateKind::Angle(_) => return None,
        };
        let moved = match of_body {
            true => {
                let way = sum(e, [(false, there), (true, place)]);
                product(e, [transposed(e, own), way])
            }
            false => {
                let turned = product(e, [turn.clone(), place]);
                sum(e, [(false, there), (true, turned)])
            }
        };
        Some([turn, moved])
    }

    /// A product: an inverse is combined with the next factor by the difference of their positions.
    fn composed(&self, e: &Expression, list: &[Expression]) -> Option<Two> {
        let mut out: Option<Two> = None;
        let mut rest = list;
        while let [first, others @ ..] = rest {
            rest = others;
            let of_inverse = match &first.kind {
                Kind::Power(a, q) if *q == Rational::MINUS_ONE => Some(a),
                _ => None,
            };
            let next = match (of_inverse, others) {
                (Some(a), [b, beyond @ ..]) => {
                    rest = beyond;
                    let ([turn, place], [after, there]) = (self.two(a)?, self.two(b)?);
                    let back = transposed(e, turn);
                    let way = sum(e, [(false, there), (true, place)]);
                    [product(e, [back.clone(), after]), product(e, [back, way])]
                }
                _ => self.two(first)?,
            };
            out = Some(match out {
                None => next,
                Some([turn, place]) => {
                    let [after, there] = next;
                    let moved = product(e, [turn.clone(), there]);
                    [
                        product(e, [turn, after]),
                        sum(e, [(false, place), (false, moved)]),
                    ]
                }
            });
        }
        out
    }

    /// Whether it is a vector on which a motion acts.
    fn carries(&self, e: &Expression) -> bool {
        match &e.kind {
            Kind::Product(list) => match list.as_slice() {
                [first @ .., last] => {
                    self.carries(last)
                        || first.last().is_some_and(|m| self.is_motion(m))
                            && self.point(last).is_some()
                }
                [] => false,
            },
            Kind::Sum(terms) => terms.iter().any(|(_, t)| self.carries(t)),
            Kind::Neg(a) | Kind::Shaped(a, _) | Kind::Quotient(a, _) => self.carries(a),
            Kind::Call(f, list) if matches!(f.text.as_str(), "next" | "prev") => {
                list.first().is_some_and(|a| self.carries(a))
            }
            _ => false,
        }
    }

    fn is_motion(&self, e: &Expression) -> bool {
        match &e.kind {
            Kind::Transpose(a) => self.two(a).is_some(),
            _ => self.two(e).is_some(),
        }
    }

    /// The dimension of space for a vector with one component more.
    fn dimension(&self, e: &Expression) -> Option<usize> {
        let known = e.name_that(&|n| self.points.contains_key(n))?;
        self.points.get(known).copied()
    }

    /// A vector by its part in space and its last component.
    fn point(&self, e: &Expression) -> Option<Two> {
        match &e.kind {
            Kind::Name(n) => {
                let dimension = *self.points.get(n)?;
                let component = |i: usize| {
                    let which = vec![u64::try_from(i).unwrap_or(0)];
                    kind(e, Kind::Component(Box::new(e.clone()), which))
                };
                let terms = (1..=dimension).map(|i| {
                    let axis = name(e, &format!("E{i}"));
                    (false, product(e, [component(i), axis]))
                });
                let in_space = kind(e, Kind::Sum(terms.collect()));
                Some([
                    shaped(e, in_space, "Vec", dimension),
                    component(dimension + 1),
                ])
            }
            Kind::Shaped(a, _) => self.point(a),
            Kind::Neg(a) => Some(
                self.point(a)?
                    .map(|part| kind(e, Kind::Neg(Box::new(part)))),
            ),
            Kind::Sum(terms) => {
                let (mut in_space, mut last) = (Vec::new(), Vec::new());
                for (minus, term) in terms {
                    let [a, b] = self.point(term)?;
                    in_space.push((*minus, a));
                    last.push((*minus, b));
                }
                Some([in_space, last].map(|terms| kind(e, Kind::Sum(terms))))
            }
            Kind::Call(f, list) if matches!(f.text.as_str(), "next" | "prev") => {
                let (first, rest) = list.split_first()?;
                Some(self.point(first)?.map(|part| {
                    let list = [part].into_iter().chain(rest.iter().cloned());
                    kind(e, Kind::Call(f.clone(), list.collect()))
                }))
            }
            Kind::Product(list) => {
                let (first, rest) = list.split_first()?;
                let rest = match rest {
                    [] => return None,
                    [only] => only.clone(),
                    _ => kind(e, Kind::Product(rest.to_vec())),
                };
                let [in_space, last] = self.point(&rest)?;
                if let Kind::Transpose(motion) = &first.kind
                    && let Some([turn, place]) = self.two(motion)
                {
                    // A plane: a motion rotates its normal and changes its distance from the origin.
                    let along = call(e, "dot", [place, in_space.clone()]);
                    return Some([
                        product(e, [transposed(e, turn), in_space]),
                        sum(e, [(false, along), (false, last)]),
                    ]);
                }
                if let Some([turn, place]) = self.two(first) {
                    let turned = product(e, [turn, in_space]);
                    let moved = product(e, [last.clone(), place]);
                    return Some([sum(e, [(false, turned), (false, moved)]), last]);
                }
                let by = self.is_number(first).then(|| self.apart(first))?;
                Some([product(e, [by.clone(), in_space]), product(e, [by, last])])
            }
            Kind::Quotient(a, b) => {
                let by = self.apart(b);
                let parts = self.point(a)?.map(|part| {
                    let (part, by) = (Box::new(part), Box::new(by.clone()));
                    kind(e, Kind::Quotient(part, by))
                });
                Some(parts)
            }
            _ => None,
        }
    }

    /// Whether it is recognised as a scalar.
    fn is_number(&self, e: &Expression) -> bool {
        match &e.kind {
            Kind::Number(_) | Kind::Constant(_) | Kind::Component(..) => true,
            Kind::Name(n) => self.numbers.contains(n),
            Kind::Sum(terms) => terms.iter().all(|(_, t)| self.is_number(t)),
            Kind::Product(list) => list.iter().all(|f| self.is_number(f)),
            Kind::Quotient(a, b) => self.is_number(a) && self.is_number(b),
            Kind::Neg(a) | Kind::Power(a, _) => self.is_number(a),
            Kind::Call(f, list) => match f.text.as_str() {
                "dot" | "tr" | "det" | "I1" | "I2" | "re" => true,
                "sqrt" | "exp" | "log" | "sin" | "cos" | "sinh" | "cosh" | "tanh" | "abs"
                | "sign" | "next" | "prev" => list.first().is_some_and(|a| self.is_number(a)),
                _ => false,
            },
            Kind::Transpose(_) | Kind::Shaped(..) => false,
        }
    }
}

pub(super) fn kind(at: &Expression, kind: Kind) -> Expression {
    Expression {
        kind,
        place: at.place,
    }
}

pub(super) fn name(at: &Expression, text: &str) -> Expression {
    kind(at, Kind::Name(text.to_owned()))
}

pub(super) fn call<const N: usize>(at: &Expression, of: &str, list: [Expression; N]) -> Expression {
    let of = Name {
        text: of.to_owned(),
        place: at.place,
        typeset: None,
        is_copy: false,
    };
    kind(at, Kind::Call(of, list.to_vec()))
}

pub(super) fn sum<const N: usize>(at: &Expression, terms: [(bool, Expression); N]) -> Expression {
    kind(at, Kind::Sum(terms.to_vec()))
}

pub(super) fn product<const N: usize>(at: &Expression, list: [Expression; N]) -> Expression {
    kind(at, Kind::Product(list.to_vec()))
}

pub(super) fn transposed(at: &Expression, e: Expression) -> Expression {
    kind(at, Kind::Transpose(Box::new(e)))
}

fn inverse(at: &Expression, [turn, place]: Two) -> Two {
    let back = transposed(at, turn);
    let moved = product(at, [back.clone(), place]);
    [back, kind(at, Kind::Neg(Box::new(moved)))]
}

/// A shape or a group, with one size or none.
pub(super) fn kindred(place: Place, family: &str, n: Option<usize>) -> SizedName {
    let size = |n| Size::Number(u64::try_from(n).unwrap_or(0), place);
    SizedName {
        name: Name {
            text: family.to_owned(),
            place,
            typeset: None,
            is_copy: false,
        },
        sizes: n.map(size).into_iter().collect(),
        place,
    }
}

/// An expression annotated with a shape of one size.
pub(super) fn shaped(at: &Expression, e: Expression, shape: &str, n: usize) -> Expression {
    let shape = kindred(at.place, shape, Some(n));
    kind(at, Kind::Shaped(Box::new(e), shape))
}

/// The rotation of the plane by an angle.
pub(super) fn turn_by(at: &Expression, angle: Expression) -> Expression {
    let [x, y] = ["E1", "E2"].map(|axis| name(at, axis));
    let xy = product(at, [y.clone(), transposed(at, x.clone())]);
    let yx = product(at, [x, transposed(at, y)]);
    let quarter = sum(at, [(false, xy), (true, yx)]);
    let along = product(at, [call(at, "cos", [angle.clone()]), name(at, "Id")]);
    let across = product(at, [call(at, "sin", [angle]), quarter]);
    shaped(at, sum(at, [(false, along), (false, across)]), "Mat", 2)
}
