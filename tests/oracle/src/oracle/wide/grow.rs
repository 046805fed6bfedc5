//! Random summands of reduced statements, in velocities and advected quantities. Given a model with its groups, adds a kinetic term
//! for each group, advected quantities, and other terms. Over all models, these terms contain every function of the language.

use super::model::{Action, Family, Kind, Model, Role};
use super::tree::{SCALAR, Shape, Tree};
use crate::oracle::points::Source;
use crate::oracle::sides::Side;

/// Functions, powers and quotients that wrap a scalar. Models use them in turn, so that all of them occur.
pub const AROUND: [&str; 16] = [
    "exp", "sin", "cos", "log", "tanh", "sqrt", "sinh", "third", "cosh", "abs", "quotient", "cube",
    "half", "sign", "inverse", "square",
];

/// Functions of vectors and matrices, used in turn.
const WORDS: [&str; 14] = [
    "vee",
    "I2",
    "cross",
    "hat",
    "det",
    "sym",
    "diag",
    "skew",
    "I1",
    "inv",
    "diagonal",
    "next",
    "rectangular",
    "component",
];
/// Functions of quaternions.
const OF_QUATERNIONS: [&str; 4] = ["im", "quat", "rot", "re"];
/// Functions of rigid motions.
const OF_MOTIONS: [&str; 2] = ["pos", "rot"];

/// A smooth function of a scalar of order one, by its name in [`AROUND`].
pub fn around(name: &str, x: Tree) -> Tree {
    let small = |x: Tree| Tree::number("0.3").times(x);
    let square = |x: Tree| x.power(2, 1);
    match name {
        "exp" => Tree::call("exp", small(x)),
        "sin" => Tree::call("sin", x),
        "cos" => Tree::call("cos", x),
        "sinh" => Tree::call("sinh", small(x)),
        "cosh" => Tree::call("cosh", small(x)),
        "tanh" => Tree::call("tanh", x),
        "abs" => Tree::call("abs", x),
        "sign" => Tree::call("sign", x.clone()).times(x),
        "log" => Tree::call("log", Tree::number("2").plus(square(x))),
        "sqrt" => Tree::call("sqrt", Tree::number("1").plus(square(x))),
        "third" => Tree::number("2").plus(square(x)).power(1, 3),
        "half" => Tree::number("1").plus(square(x)).power(-3, 2),
        "quotient" => x.clone().over(Tree::number("2").plus(square(x))),
        "inverse" => Tree::number("3").plus(square(x)).power(-1, 1),
        "cube" => small(x).power(3, 1),
        _ => square(x),
    }
}

/// The kinetic term of a body, convex in small velocities.
pub fn kinetic(model: &mut Model, body: usize) -> Tree {
    let family = model.bodies[body].family;
    let n = family.size();
    let v = model.letter(model.bodies[body].element + 1);
    let twice = Tree::Product(vec![Tree::number("2"), Tree::Step]);
    match family {
        Family::Rotation(_) => {
            let j = model.parameter(Kind::Positive(n));
            Tree::call("tr", j.times(v)).over(Tree::Step)
        }
        Family::Quaternion => {
            let c = model.parameter(Kind::Real);
            let four = Tree::Product(vec![Tree::number("4"), c]);
            four.over(Tree::Step).times(Tree::call("re", v))
        }
        Family::Added(..) => added(model, body),
        Family::Motion | Family::Plane => {
            let (j, m) = (
                model.parameter(Kind::Positive(family.turned())),
                model.parameter(Kind::Positive(family.turned())),
            );
            let turn = Tree::call("tr", j.times(Tree::call("rot", v.clone())));
            let shift = Tree::call("pos", v);
            let square = Tree::Call("dot", vec![shift.clone(), m.times(shift)]);
            turn.over(Tree::Step).minus(square.over(twice))
        }
        Family::Linear(_) => {
            let j = model.parameter(Kind::Positive(n));
            let rate = v.minus(Tree::Identity(n));
            let square = Tree::Product(vec![rate.clone(), j, rate.transposed()]);
            // Subtracted, like the other kinetic terms.
            Tree::number("-1").times(Tree::call("tr", square).over(twice))
        }
    }
}

/// The kinetic term of a field.
pub fn added(model: &mut Model, body: usize) -> Tree {
    let element = model.bodies[body].element;
    let here = model.letter(element);
    let shape = here.shape();
    let m = model.parameter(Kind::Real);
    let rate = Tree::Next(element, shape).minus(here);
    let square = match shape {
        SCALAR => rate.power(2, 1),
        (_, 1) => Tree::Call("dot", vec![rate.clone(), rate]),
        _ => Tree::call("tr", rate.clone().times(rate.transposed())),
    };
    let twice = Tree::Product(vec![Tree::number("2"), Tree::Step]);
    // Subtracted, like the other kinetic terms.
    Tree::number("-1").times(m.times(square).over(twice))
}

/// A quantity that the group of a body can advect: its kind, the action, and whether the rotation of the element acts.
fn carriable(source: &mut Source, family: Family) -> (Kind, Action, bool) {
    use Action::{Congruence, Conjugation, Dual, DualCongruence, Forward, Weight};
    let n = family.size();
    let d = family.turned();
    let turned = [
        (Kind::Vector(d), Forward, true),
        (Kind::Vector(d), Forward, true),
        (Kind::Symmetric(d), Congruence, true),
        (Kind::Skew(d), Congruence, true),
        (Kind::Matrix(d, 2), Forward, true),
        (Kind::Matrix(d, d), Conjugation, true),
        (Kind::Element(Family::Rotation(d)), Forward, true),
    ];
    let own: Vec<(Kind, Action, bool)> = match family {
        Family::Rotation(_) => vec![
            (Kind::Vector(n), Forward, false),
            (Kind::Vector(n), Forward, false),
            (Kind::Symmetric(n), Congruence, false),
            (Kind::Skew(n), Congruence, false),
            (Kind::Matrix(n, n), Forward, false),
            (Kind::Matrix(n, 2), Forward, false),
            (Kind::Element(family), Forward, false),
        ],
        Family::Quaternion => vec![
            (Kind::Vector(4), Forward, false),
            (Kind::Element(family), Forward, false),
        ],
        Family::Motion | Family::Plane => vec![
            (Kind::Vector(n), Forward, false),
            (Kind::Vector(n), Dual, false),
            (Kind::Symmetric(n), DualCongruence, false),
            (Kind::Matrix(n, n), Conjugation, false),
            (Kind::Element(family), Forward, false),
        ],
        Family::Linear(_) | Family::Added(..) => vec![
            (Kind::Vector(n), Forward, false),
            (Kind::Vector(n), Dual, false),
            (Kind::Symmetric(n), Congruence, false),
            (Kind::Symmetric(n), DualCongruence, false),
            (Kind::Skew(n), DualCongruence, false),
            (Kind::Matrix(n, n), Conjugation, false),
            (Kind::Matrix(n, 2), Forward, false),
            (Kind::Real, Weight, false),
        ],
    };
    let turns = family == Family::Quaternion || family.is_motion();
    let list: &[(Kind, Action, bool)] = match turns && source.chance(55) {
        true => &turned,
        false => &own,
    };
    list[source.below(list.len())]
}

/// Adds advected quantities.
fn carried(model: &mut Model, source: &mut Source) {
    for body in 0..model.bodies.len() {
        let family = model.bodies[body].family;
        let count = if family.is_added() {
            0
        } else {
            1 + source.below(2)
        };
        for i in 0..count {
            let (kind, action, turns) = carriable(source, family);
            // A group element as an advected quantity has no definition.
            let definition = (source.chance(50) && !matches!(kind, Kind::Element(_)))
                .then(|| match model.parameter(kind) {
                    Tree::Letter(index, _) => Some(index),
                    _ => None,
                })
                .flatten();
            let role = Role::Advected {
                body,
                action,
                turns,
                definition,
            };
            model.add(&format!("q{}{}", body + 1, i + 1), kind, role);
        }
    }
    if let [a, b, ..] = model.bodies.as_slice()
        && a.family == b.family
        && a.side == Side::Body
        && b.side == Side::Body
        && !a.family.is_added()
    {
        let role = Role::Relative {
            first: 0,
            second: 1,
            defined: source.chance(60),
        };
        model.add("R12", Kind::Element(a.family), role);
    }
}

/// Adds the summands of a reduced statement.
pub fn state(model: &mut Model, source: &mut Source, turn: usize) {
    for body in 0..model.bodies.len() {
        let term = kinetic(model, body);
        model.summands.push((true, term));
    }
    carried(model, source);
    for body in 0..model.bodies.len() {
        let n = model.bodies[body].family.size();
        for kind in [
            Kind::Real,
            Kind::Vector(n),
            Kind::Vector(3),
            Kind::Matrix(n, n),
            Kind::Symmetric(3),
            Kind::Diagonal(n),
            Kind::Skew(3),
        ] {
            if source.chance(40) {
                model.parameter(kind);
            }
        }
    }
    let count = 2 + source.below(2);
    for i in 0..count {
        let moving = i == 0 || source.chance(60);
        // The first two summands contain the function whose turn it is, if the model has an argument for it.
        let round = turn + turn / 16;
        let special = match model.bodies.iter().map(|b| b.family).collect::<Vec<_>>() {
            list if list.contains(&Family::Quaternion) => OF_QUATERNIONS[round % 4],
            list if list.iter().any(|f| f.is_motion()) => OF_MOTIONS[round % 2],
            _ => WORDS[(round + 6) % WORDS.len()],
        };
        let word = match i {
            0 => special,
            _ => WORDS[round % WORDS.len()],
        };
        let mut garden = Garden {
            model,
            source,
            moving,
        };
        // Normal forms of products of motions, and of three or more groups and fields, are long.
        let bodies = garden.model.bodies.iter();
        let motions = bodies.filter(|b| b.family == Family::Motion).count();
        let many = motions > 1 || garden.model.bodies.len() > 2;
        let depth = if many { 1 } else { 2 };
        let given = match i < 2 && depth == 2 {
            true => garden.word(word),
            false => None,
        };
        let number = given.unwrap_or_else(|| garden.scalar(depth));
        let name = AROUND[(turn * 3 + turn / AROUND.len() + i) % AROUND.len()];
        let term = around(name, number);
        let minus = source.chance(50);
        let weight = match source.below(5) {
            0 => Tree::Step.over(Tree::number("4")),
            1 => Tree::number("0.2").times(Tree::Step),
            2 => Tree::number("0.1")
                .times(Tree::Step.power(2, 1))
                .over(Tree::Step),
            3 => Tree::number("0.02").over(Tree::Step),
            _ => Tree::Step.times(Tree::number("0.15")),
        };
        model.summands.push((minus, weight.times(term)));
    }
}

/// Grows expressions from the symbols of a model.
struct Garden<'a> {
    model: &'a mut Model,
    source: &'a mut Source,
    /// Whether velocities and values at the end of the edge may occur.
    moving: bool,
}

impl Garden<'_> {
    /// A symbol of this shape, if there is one; sometimes its value at the end of the edge.
    fn atom(&mut self, shape: Shape) -> Option<Tree> {
        let mut fitting = Vec::new();
        for (index, l) in self.model.letters.iter().enumerate() {
            let (allowed, shifts) = match l.role {
                // Reduced statements contain fields, but no group elements.
                Role::Element(body) => {
                    let added = self.model.bodies[body].family.is_added();
                    (added, added && self.moving)
                }
                Role::Velocity(body) => {
                    let added = self.model.bodies[body].family.is_added();
                    (self.moving && !added, false)
                }
                Role::Parameter => (true, false),
                Role::Advected { .. } | Role::Relative { .. } => (true, self.moving),
            };
            if allowed && l.kind.shape() == shape {
                fitting.push((index, shifts));
                // Adds dynamic symbols twice, so that they occur more often than parameters.
                if !matches!(l.role, Role::Parameter) {
                    fitting.push((index, shifts));
                }
            }
        }
        let (index, shifts) = *self.source.choose(&fitting)?;
        Some(match shifts && self.source.chance(25) {
            true => Tree::Next(index, shape),
            false => Tree::Letter(index, shape),
        })
    }

    /// A size that vectors and matrices of the model have.
    fn size(&mut self) -> usize {
        let sizes: Vec<usize> = self
            .model
            .bodies
            .iter()
            .flat_map(|b| match b.family {
                Family::Quaternion | Family::Motion => vec![3, 3, 4],
                Family::Plane => vec![2, 2, 3],
                Family::Added(..) => vec![3],
                other => vec![other.size()],
            })
            .collect();
        self.source.choose(&sizes).copied().unwrap_or(3)
    }

    /// A body whose velocity is a quaternion or a motion.
    fn special(&mut self, family: Family) -> Option<Tree> {
        let list: Vec<usize> = self
            .model
            .letters
            .iter()
            .enumerate()
            .filter(|(_, l)| {
                l.kind == Kind::Element(family)
                    && !matches!(l.role, Role::Element(_))
                    && (self.moving || !matches!(l.role, Role::Velocity(_)))
            })
            .map(|(i, _)| i)
            .collect();
        let index = *self.source.choose(&list)?;
        Some(self.model.letter(index))
    }

    /// A scalar expression that contains this function; `None` if no symbol can be its argument.
    fn word(&mut self, name: &'static str) -> Option<Tree> {
        let three = (1..=3).find_map(|_| (self.size() == 3).then_some(3));
        let n = self.size();
        Some(match name {
            "im" => {
                let q = self.special(Family::Quaternion)?;
                let v = self.vector(3, 1);
                Tree::Call("dot", vec![Tree::call("im", q), v])
            }
            "re" => Tree::call("re", self.special(Family::Quaternion)?),
            "quat" => {
                let q = self.special(Family::Quaternion)?;
                let v = self.vector(3, 1);
                Tree::call("re", Tree::call("quat", v).times(q))
            }
            "pos" => {
                let g = self.special(Family::Motion);
                let g = g.or_else(|| self.special(Family::Plane))?;
                let v = self.vector(g.shape().0 - 1, 1);
                Tree::Call("dot", vec![v, Tree::call("pos", g.power(-1, 1))])
            }
            "rot" => {
                let motion = self.special(Family::Motion);
                let g = motion.or_else(|| self.special(Family::Quaternion));
                let g = g.or_else(|| self.special(Family::Plane))?;
                let a = self.matrix(if g.shape().0 == 3 { 2 } else { 3 }, 1);
                Tree::call("tr", a.times(Tree::call("rot", g)))
            }
            "vee" | "hat" | "cross" => {
                let n = three?;
                let (a, b) = (self.vector(n, 1), self.vector(n, 1));
                match name {
                    "vee" => {
                        let m = self.matrix(n, 1);
                        Tree::Call("dot", vec![Tree::call("vee", m), a])
                    }
                    "hat" => {
                        let c = self.vector(n, 0);
                        Tree::Call("dot", vec![Tree::call("hat", a).times(b), c])
                    }
                    _ => {
                        let c = self.vector(n, 0);
                        let product = Tree::Call("cross", vec![a, b]);
                        Tree::Call("dot", vec![product, c])
                    }
                }
            }
            "next" => {
                let a = self.atom((n, 1))?;
                let b = self.vector(n, 1);
                Tree::Call("dot", vec![a, b])
            }
            "component" => {
                let (a, b) = (self.vector(n, 1), self.matrix(n, 1));
                let first = Tree::Component(Box::new(a), vec![1]);
                first.times(Tree::Component(Box::new(b), vec![1, 1]))
            }
            "rectangular" => {
                let f = self.model.parameter(Kind::Matrix(n, 2));
                let a = self.matrix(n, 0);
                Tree::call("tr", Tree::Product(vec![f.clone().transposed(), a, f]))
            }
            "det" if n > 3 => return None,
            "I1" | "I2" | "det" => Tree::call(name, self.matrix(n, 1)),
            "inv" => {
                let p = self.positive(n);
                Tree::call("tr", Tree::call("inv", p))
            }
            _ => {
                let (a, b) = (self.matrix(n, usize::from(n < 4)), self.matrix(n, 0));
                let part = match name {
                    "diagonal" => Tree::call("diag", self.vector(n, 1)),
                    "sym" => Tree::call("sym", a),
                    "skew" => Tree::call("skew", a),
                    _ => Tree::call("diag", a),
                };
                Tree::call("tr", part.times(b))
            }
        })
    }

    fn scalar(&mut self, depth: usize) -> Tree {
        let next = depth.saturating_sub(1);
        let n = self.size();
        match self.source.below(if depth == 0 { 7 } else { 13 }) {
            0 | 1 => {
                let (a, b) = (self.vector(n, next), self.vector(n, next));
                Tree::Call("dot", vec![a, b])
            }
            2 => {
                let a = self.matrix(n, next);
                // The difference of two rigid motions is singular, and the derivative of its determinant needs the inverse.
                let names: &[&'static str] = match n {
                    4.. => &["tr", "I1", "I2"],
                    _ => &["tr", "I1", "I2", "det"],
                };
                let name = *self.source.choose(names).unwrap_or(&"tr");
                Tree::call(name, a)
            }
            3 => {
                let i = 1 + self.source.below(n);
                let v = self.vector(n, next);
                Tree::Component(Box::new(v), vec![i])
            }
            4 => {
                let (i, j) = (1 + self.source.below(n), 1 + self.source.below(n));
                let a = self.matrix(n, next);
                Tree::Component(Box::new(a), vec![i, j])
            }
            5 => match self.special(Family::Quaternion) {
                Some(q) => Tree::call("re", q),
                None => self.scalar(next.min(depth)),
            },
            6 => self.atom(SCALAR).unwrap_or_else(|| Tree::number("1.25")),
            7 | 8 => {
                let x = self.scalar(next);
                let name = AROUND[self.source.below(AROUND.len())];
                around(name, x)
            }
            9 => self.scalar(next).plus(self.scalar(next)),
            10 => self.scalar(next).minus(self.scalar(next)),
            11 => self.scalar(next).times(self.scalar(next)),
            _ => {
                let (a, b) = (self.vector(n, 0), self.vector(n, 0));
                let outer = a.times(b.transposed());
                let m = self.matrix(n, 0);
                Tree::call("tr", m.times(outer))
            }
        }
    }

    fn vector(&mut self, n: usize, depth: usize) -> Tree {
        let next = depth.saturating_sub(1);
        let three = n == 3;
        let choice = if depth == 0 { 0 } else { self.source.below(14) };
        match choice {
            1..=3 => self.matrix(n, next).times(self.vector(n, next)),
            4 if three => {
                let (a, b) = (self.vector(n, next), self.vector(n, next));
                Tree::Call("cross", vec![a, b])
            }
            5 if three => {
                let a = self.matrix(n, next);
                Tree::call("vee", a)
            }
            6 => self.vector(n, next).plus(self.vector(n, next)),
            7 => self.vector(n, next).minus(self.vector(n, next)),
            8 => self.scalar(0).times(self.vector(n, next)),
            9 => {
                let inverse = Tree::call("inv", self.positive(n));
                inverse.times(self.vector(n, next))
            }
            10 if three => match self.special(Family::Quaternion) {
                Some(q) => Tree::call("im", q),
                None => self.vector(n, next),
            },
            11 if n < 4 => match self.special(if three { Family::Motion } else { Family::Plane }) {
                Some(g) => {
                    let g = if self.source.chance(30) {
                        g.power(-1, 1)
                    } else {
                        g
                    };
                    Tree::call("pos", g)
                }
                None => self.vector(n, next),
            },
            12 => self.vector(n, next).over(Tree::number("2")),
            _ => match self.atom((n, 1)) {
                Some(v) => v,
                None => Tree::Axis(n, 1 + self.source.below(n.min(3))),
            },
        }
    }

    /// A matrix that is always invertible.
    fn positive(&mut self, n: usize) -> Tree {
        let a = self.matrix(n, 0);
        Tree::Identity(n).plus(a.clone().times(a.transposed()))
    }

    fn matrix(&mut self, n: usize, depth: usize) -> Tree {
        let next = depth.saturating_sub(1);
        let three = n == 3;
        let choice = if depth == 0 { 0 } else { self.source.below(18) };
        match choice {
            1..=3 => self.matrix(n, next).times(self.matrix(n, next)),
            4 => self.matrix(n, next).plus(self.matrix(n, next)),
            5 => self.matrix(n, next).minus(Tree::Identity(n)),
            6 => self.matrix(n, next).transposed(),
            7 => {
                let (a, b) = (self.vector(n, next), self.vector(n, next));
                a.times(b.transposed())
            }
            8 => Tree::call("sym", self.matrix(n, next)),
            9 => Tree::call("skew", self.matrix(n, next)),
            10 => Tree::call("diag", self.matrix(n, if n > 3 { 0 } else { next })),
            11 => Tree::call("diag", self.vector(n, next)),
            12 if three => Tree::call("hat", self.vector(n, next)),
            13 => self.positive(n).power(-1, 1),
            14 if three => {
                let family = match self.source.chance(50) {
                    true => Family::Quaternion,
                    false => Family::Motion,
                };
                match self.special(family) {
                    Some(g) => Tree::call("rot", g),
                    None => self.matrix(n, next),
                }
            }
            14 if n == 2 => match self.special(Family::Plane) {
                Some(g) => Tree::call("rot", g),
                None => self.matrix(n, next),
            },
            15 if n == 4 => Tree::call("quat", self.vector(3, next)),
            16 => self.scalar(0).times(self.matrix(n, next)),
            _ => match self.atom((n, n)) {
                Some(a) => a,
                None => Tree::Identity(n),
            },
        }
    }
}
