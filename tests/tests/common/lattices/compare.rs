//! Compares the derivation with the hand-written action at random fields: momenta at both ends of a step, and the residual.

use super::AGREEMENT;
use super::change::Change;
use super::sum::{Body, Kind, Sum, Typed, turn};
use clebsch_core::expr::Expr;
use clebsch_core::interpret::evaluate;
use clebsch_core::{Assignment, Derivation};
use clebsch_oracle::oracle::action::rotations;
use clebsch_oracle::oracle::dual::{Dual, Number};
use clebsch_oracle::oracle::points::{NamedValue, Source};
use clebsch_oracle::physics::measure::worse;

/// The variation of an action at the configurations of one node, one component per direction.
pub struct Variation {
    derivative: Vec<f64>,
    /// For each component, the largest summand in the variation at its site.
    scale: Vec<f64>,
    /// The largest slope of each summand.
    pub largest: Vec<f64>,
}

/// The directions of variation of a configuration, each as the change of its entries.
fn directions(body: &Body, x: &[f64]) -> Vec<Vec<f64>> {
    match body.kind {
        Kind::Rotation => {
            let here = turn(x, body.at);
            let moved = rotations().into_iter();
            moved.map(|d| (here * d).0.concat()).collect()
        }
        Kind::Spatial => {
            let here = turn(x, body.at);
            let moved = rotations().into_iter();
            moved.map(|d| (d * here).0.concat()).collect()
        }
        Kind::Vector(_) | Kind::Number => {
            let n = body.kind.entries();
            let unit = |i: usize| (0..n).map(|j| f64::from(u8::from(i == j))).collect();
            (0..n).map(unit).collect()
        }
    }
}

/// The variation of the summands in `action` at the configurations `x`.
fn vary(model: &impl Typed, x: &[f64], action: impl Fn(&[Dual]) -> Vec<Dual>) -> Variation {
    let mut out = Variation {
        derivative: Vec::new(),
        scale: Vec::new(),
        largest: Vec::new(),
    };
    let still: Vec<Dual> = x.iter().map(|v| Dual::constant(*v)).collect();
    for body in &model.bodies().0 {
        let mut largest = 0.0f64;
        let all = directions(body, x);
        for direction in &all {
            let mut moved = still.clone();
            for (entry, slope) in moved[body.at..].iter_mut().zip(direction) {
                entry.slope = *slope;
            }
            let slopes: Vec<f64> = action(&moved).iter().map(|t| t.slope).collect();
            out.derivative.push(slopes.iter().sum());
            out.largest.resize(slopes.len(), 0.0);
            for (seen, slope) in out.largest.iter_mut().zip(&slopes) {
                *seen = worse(*seen, slope.abs());
                largest = worse(largest, slope.abs());
            }
        }
        out.scale.extend(all.iter().map(|_| largest));
    }
    out
}

fn summands(model: &impl Typed, tail: &[Dual], head: &[Dual], change: Change) -> Vec<Dual> {
    let mut sum = Sum::new(change);
    model.action(tail, head, &mut sum);
    sum.summands
}

fn still(x: &[f64]) -> Vec<Dual> {
    x.iter().map(|v| Dual::constant(*v)).collect()
}

/// The momentum at the start of a step, at its end, and the residual at the node between two steps.
pub fn typed(model: &impl Typed, nodes: &[Vec<f64>; 3], change: Change) -> [Variation; 3] {
    let [before, here, after] = nodes.each_ref().map(|x| still(x));
    let mut start = vary(model, &nodes[1], |x| summands(model, x, &after, change));
    for p in &mut start.derivative {
        *p = -*p;
    }
    let end = vary(model, &nodes[2], |x| summands(model, &here, x, change));
    let both = vary(model, &nodes[1], |x| {
        let mut all = summands(model, &before, x, change);
        all.extend(summands(model, x, &after, change));
        all
    });
    [start, end, both]
}

fn set(values: &mut Assignment, given: &[NamedValue]) {
    for g in given {
        values.set(&g.name, g.shift, g.rows, g.cols, &g.data);
    }
}

fn configuration(body: &Body, shift: i8, x: &[f64]) -> NamedValue {
    let (rows, cols) = match body.kind {
        Kind::Rotation | Kind::Spatial => (3, 3),
        Kind::Vector(n) => (n, 1),
        Kind::Number => (1, 1),
    };
    NamedValue {
        name: body.name.clone(),
        shift,
        rows,
        cols,
        data: x[body.at..body.at + body.kind.entries()].to_vec(),
    }
}

/// The values of all names at three nodes.
pub fn values(model: &impl Typed, nodes: &[Vec<f64>; 3]) -> Assignment {
    let mut values = Assignment::new();
    set(&mut values, &model.parameters());
    for (shift, x) in (-1..=1).zip(nodes) {
        let each = model.bodies().0.iter();
        let each: Vec<NamedValue> = each.map(|b| configuration(b, shift, x)).collect();
        set(&mut values, &each);
        set(&mut values, &model.advected(shift, x));
    }
    values
}

/// Reorders a residual from the order of the derivation to that of the hand-written configurations.
pub fn ordered(residual: &[f64], order: &[usize], model: &impl Typed) -> Vec<f64> {
    let sizes = order.iter().zip(&model.bodies().0);
    let sizes: Vec<(usize, usize)> = sizes.map(|(i, b)| (*i, b.kind.directions())).collect();
    let begin = |i: usize| -> usize {
        let before = sizes.iter().filter(|(j, _)| *j < i);
        before.map(|(_, n)| n).sum()
    };
    let each = sizes.iter();
    let each = each.flat_map(|(i, n)| residual[begin(*i)..begin(*i) + n].to_vec());
    each.collect()
}

/// The same quantities from the derivation, in the order of the hand-written configurations.
pub fn found(d: &Derivation, model: &impl Typed, nodes: &[Vec<f64>; 3]) -> [Vec<f64>; 3] {
    let s = &d.letters.symbols;
    let order = order(d, model);
    let mut values = values(model, nodes);
    let residual = d.residual(&values).unwrap_or_else(|e| panic!("{e}"));
    // On the outgoing edge of the middle node.
    for (body, i) in model.bodies().0.iter().zip(&order) {
        let velocity = s.get(d.spec.configurations[*i].velocity);
        let mut given = configuration(body, 0, &nodes[1]);
        velocity.name.clone_into(&mut given.name);
        given.data = match body.kind {
            Kind::Rotation | Kind::Spatial => {
                let [here, after] = [&nodes[1], &nodes[2]].map(|x| turn(x, body.at));
                let back = here.transpose();
                let velocity = match body.kind {
                    Kind::Spatial => after * back,
                    _ => back * after,
                };
                velocity.0.concat()
            }
            Kind::Vector(_) | Kind::Number => {
                let pairs = nodes[2][body.at..].iter().zip(&nodes[1][body.at..]);
                let n = body.kind.entries();
                pairs.take(n).map(|(b, a)| b - a).collect()
            }
        };
        set(&mut values, &[given]);
    }
    let momenta = |of: &dyn Fn(usize) -> Expr| -> Vec<f64> {
        let each = order.iter().map(|i| evaluate(s, &of(*i), &values));
        let each = each.flat_map(|m| m.unwrap_or_else(|e| panic!("{e}")).data);
        each.collect()
    };
    let start = momenta(&|i| d.balances[i].outgoing.clone());
    let end = momenta(&|i| d.balances[i].incoming.clone());
    [start, end, ordered(&residual, &order, model)]
}

/// For each hand-written configuration, its index in the derivation, which contains no others.
pub fn order(d: &Derivation, model: &impl Typed) -> Vec<usize> {
    let s = &d.letters.symbols;
    let names: Vec<&str> = d
        .spec
        .configurations
        .iter()
        .map(|c| s.get(c.element).name.as_str())
        .collect();
    assert_eq!(names.len(), model.bodies().0.len(), "{names:?}");
    let place = |b: &Body| names.iter().position(|n| *n == b.name);
    let each = model.bodies().0.iter();
    each.map(|b| place(b).unwrap_or_else(|| panic!("{} is not in {names:?}", b.name)))
        .collect()
}

/// The largest difference of a component, and its index; infinite if a value is not finite.
pub fn disagreement(wanted: &Variation, found: &[f64]) -> (f64, usize) {
    assert_eq!(wanted.derivative.len(), found.len());
    let mut worst = (0.0f64, 0);
    for (i, (a, b)) in wanted.derivative.iter().zip(found).enumerate() {
        let difference = (a - b).abs() / wanted.scale[i];
        if !difference.is_finite() {
            return (f64::INFINITY, i);
        }
        if difference > worst.0 {
            worst = (difference, i);
        }
    }
    worst
}

/// The name and site of a component.
fn site(model: &impl Typed, component: usize) -> String {
    let mut left = component;
    for b in &model.bodies().0 {
        let n = b.kind.directions();
        if left < n {
            return format!("component {} at {}", left + 1, b.name);
        }
        left -= n;
    }
    "no site".to_owned()
}

/// Names of the compared quantities.
pub const WHAT: [&str; 3] = ["momentum at the start", "momentum at the end", "residual"];

/// Checks that the derivation agrees with the hand-written action at random fields.
pub fn agrees(d: &Derivation, model: &impl Typed, source: &mut Source) {
    for _ in 0..3 {
        let nodes = [(); 3].map(|()| model.draw(source));
        let found = found(d, model, &nodes);
        let wanted = typed(model, &nodes, Change::None);
        for ((wanted, found), what) in wanted.iter().zip(&found).zip(WHAT) {
            let (worst, at) = disagreement(wanted, found);
            let place = site(model, at);
            assert!(
                worst <= AGREEMENT,
                "{}, {what}, {place}: {} by the action, {} derived, {worst:e} apart",
                d.spec.name,
                wanted.derivative[at],
                found[at]
            );
        }
    }
}
