//! Random summands of unreduced statements, in the configurations at both ends of the step. Given a model with its groups, adds
//! kinetic terms and functions of scalars that parameters make invariant, in the usual notation of mechanics.

use super::grow::{AROUND, added, around};
use super::model::{Family, Kind, Model};
use super::tree::Tree;
use crate::oracle::points::Source;
use crate::oracle::sides::Side;

fn dot(a: Tree, b: Tree) -> Tree {
    Tree::Call("dot", vec![a, b])
}

/// The element at both ends of the step.
fn ends(model: &Model, body: usize) -> (Tree, Tree) {
    let element = model.bodies[body].element;
    let here = model.letter(element);
    let shape = here.shape();
    (here, Tree::Next(element, shape))
}

/// Adds the summands.
pub fn state(model: &mut Model, source: &mut Source, turn: usize) {
    for body in 0..model.bodies.len() {
        let term = kinetic(model, body);
        model.summands.push((true, term));
        let count = 1 + source.below(2);
        for i in 0..count {
            let number = number(model, source, body);
            let mut name = AROUND[(turn * 5 + turn / AROUND.len() + i) % AROUND.len()];
            // The square of a squared sum has more terms than the engine expands.
            let squares = !["exp", "sin", "cos", "sinh", "cosh", "tanh", "abs"].contains(&name);
            if model.bodies[body].family.is_motion() && squares {
                name = "tanh";
            }
            let weight = Tree::Step.over(Tree::number("4"));
            let minus = source.chance(50);
            model
                .summands
                .push((minus, weight.times(around(name, number))));
        }
    }
    let families: Vec<Family> = model.bodies.iter().map(|b| b.family).collect();
    let body_side = model.bodies.iter().all(|b| b.side == Side::Body);
    if let ([Family::Motion, Family::Motion], true) = (families.as_slice(), body_side) {
        let ((a, _), (b, _)) = (ends(model, 0), ends(model, 1));
        let d = model.parameter(Kind::Vector(3));
        let pos = |g: Tree| Tree::call("pos", g);
        let anchor = Tree::call("rot", a.clone()).times(d);
        let apart = Tree::Sum(vec![(false, pos(a)), (false, anchor), (true, pos(b))]);
        let spring = Tree::Step
            .over(Tree::number("2"))
            .times(dot(apart.clone(), apart));
        model.summands.push((true, spring));
    }
    let same_side = model.bodies.windows(2).all(|b| b[0].side == b[1].side);
    if let ([Family::Rotation(3), Family::Rotation(3)], true) = (families.as_slice(), same_side) {
        let ((a, _), (b, _)) = (ends(model, 0), ends(model, 1));
        let (u, v) = (
            model.parameter(Kind::Vector(3)),
            model.parameter(Kind::Vector(3)),
        );
        let joint = Tree::Step.times(dot(a.times(u), b.times(v)));
        model.summands.push((true, joint));
    }
}

fn kinetic(model: &mut Model, body: usize) -> Tree {
    let family = model.bodies[body].family;
    let n = family.size();
    let (g, next) = ends(model, body);
    let twice = Tree::Product(vec![Tree::number("2"), Tree::Step]);
    match family {
        Family::Rotation(_) => {
            let j = model.parameter(Kind::Positive(n));
            let word = Tree::Product(vec![j, g.transposed(), next]);
            Tree::call("tr", word).over(Tree::Step)
        }
        Family::Quaternion => {
            let c = model.parameter(Kind::Real);
            let four = Tree::Product(vec![Tree::number("4"), c]);
            let word = Tree::Product(vec![g.transposed(), next]);
            four.over(Tree::Step).times(Tree::call("re", word))
        }
        Family::Added(..) => added(model, body),
        Family::Motion | Family::Plane => {
            let j = model.parameter(Kind::Positive(family.turned()));
            let m = model.parameter(Kind::Real);
            let rot = |g: &Tree| Tree::call("rot", g.clone());
            let pos = |g: &Tree| Tree::call("pos", g.clone());
            let word = Tree::Product(vec![j, rot(&g).transposed(), rot(&next)]);
            let shift = pos(&next).minus(pos(&g));
            let square = m.times(dot(shift.clone(), shift));
            Tree::call("tr", word)
                .over(Tree::Step)
                .minus(square.over(twice))
        }
        Family::Linear(_) => {
            let (c, j) = (
                model.parameter(Kind::Positive(n)),
                model.parameter(Kind::Positive(n)),
            );
            let rate = next.minus(g);
            let square = Tree::Product(vec![c, rate.clone(), j, rate.transposed()]);
            Tree::number("-1").times(Tree::call("tr", square).over(twice))
        }
    }
}

/// A scalar that parameters make invariant.
fn number(model: &mut Model, source: &mut Source, body: usize) -> Tree {
    let family = model.bodies[body].family;
    let n = family.size();
    let (g, next) = ends(model, body);
    let pick = source.below(3);
    match family {
        Family::Rotation(_) | Family::Linear(_) => {
            let (a, b) = (
                model.parameter(Kind::Vector(n)),
                model.parameter(Kind::Vector(n)),
            );
            match (pick, family) {
                (0, _) => dot(a, g.times(b)),
                (1, Family::Linear(_)) => {
                    let s = model.parameter(Kind::Symmetric(n));
                    let word = Tree::Product(vec![s, g.clone(), g.transposed()]);
                    Tree::call("tr", word)
                }
                (1, _) => {
                    let s = model.parameter(Kind::Symmetric(n));
                    let seen = g.clone().transposed().times(a);
                    dot(seen.clone(), s.times(seen))
                }
                _ => dot(next.minus(g).times(b), a),
            }
        }
        Family::Quaternion => {
            let (a, b) = (
                model.parameter(Kind::Vector(3)),
                model.parameter(Kind::Vector(3)),
            );
            let rot = |g: Tree| Tree::call("rot", g);
            match pick {
                0 => dot(a, rot(g).times(b)),
                1 => {
                    let s = model.parameter(Kind::Symmetric(3));
                    let seen = rot(g).transposed().times(a);
                    dot(seen.clone(), s.times(seen))
                }
                _ => dot(a, rot(next).minus(rot(g)).times(b)),
            }
        }
        Family::Added(1, 1) => match pick {
            0 => g,
            1 => next,
            _ => next.plus(g),
        },
        // In the frame of another body, if one rotates vectors of this size.
        Family::Added(rows, 1) => {
            let other = model.bodies.iter().position(|b| {
                matches!(
                    b.family,
                    Family::Rotation(3) | Family::Quaternion | Family::Linear(3)
                )
            });
            let a = model.parameter(Kind::Vector(rows));
            match other.map(|other| (model.bodies[other].family, ends(model, other).0)) {
                Some((Family::Quaternion, q)) => dot(Tree::call("rot", q).times(a), g),
                Some((_, turn)) => dot(turn.times(a), g),
                None => dot(a, next),
            }
        }
        Family::Added(rows, cols) => {
            let (a, b) = (
                model.parameter(Kind::Vector(rows)),
                model.parameter(Kind::Vector(cols)),
            );
            dot(a, g.times(b))
        }
        Family::Motion | Family::Plane => {
            let (a, b) = (
                model.parameter(Kind::Vector(family.turned())),
                model.parameter(Kind::Vector(family.turned())),
            );
            let (rot, pos) = (Tree::call("rot", g.clone()), Tree::call("pos", g));
            match pick {
                0 => dot(a, pos),
                1 => dot(a, rot.times(b)),
                _ => {
                    let away = Tree::Sum(vec![(false, pos), (false, rot.times(a)), (true, b)]);
                    Tree::number("0.5").times(dot(away.clone(), away))
                }
            }
        }
    }
}
