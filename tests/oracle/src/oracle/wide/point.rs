//! Random values for a random model, and the variation of its unreduced action at that point. Gives the value of every symbol at a
//! node, and the discrete Euler-Lagrange residual by dual numbers, with components in the order of the language.

use super::grid::Grid;
use super::model::{Action, Family, Kind, Model, Role};
use super::tree::{Edge, Tree};
use crate::oracle::dual::{Dual, Number};
use crate::oracle::points::{NamedValue, Source, Variation};
use crate::oracle::sides::Side;
use crate::oracle::square::Square;

/// A model at random values of its parameters.
#[derive(Clone, Debug)]
pub struct Point<'a> {
    model: &'a Model,
    /// The step size.
    pub step: f64,
    /// For each symbol, the parameter, or the value of an advected quantity at the identity.
    pub constants: Vec<Grid<f64>>,
    nodal: Vec<bool>,
}

/// A node: the element of each body.
pub type Node = Vec<Grid<f64>>;

fn square<const N: usize>(a: &Square<f64, N>) -> Grid<f64> {
    Grid::from_entries(N, N, |i, j| a.0[i][j])
}

fn any(source: &mut Source, rows: usize, cols: usize) -> Grid<f64> {
    let data = (0..rows * cols)
        .map(|_| source.between(-1.0, 1.0))
        .collect();
    Grid { rows, cols, data }
}

/// A random element, anywhere on the group.
pub fn element(source: &mut Source, family: Family) -> Grid<f64> {
    match family {
        Family::Rotation(2) => square(&source.orthogonal::<2>()),
        Family::Rotation(3) => square(&source.orthogonal::<3>()),
        Family::Rotation(4) => square(&source.orthogonal::<4>()),
        Family::Rotation(_) => square(&source.orthogonal::<5>()),
        Family::Quaternion => {
            let q: [f64; 4] = source.vector();
            let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
            let [w, x, y, z] = q.map(|c| c / length);
            Grid::quaternion(w, [x, y, z])
        }
        Family::Motion => {
            let (turn, shift) = (source.orthogonal::<3>(), source.vector::<3>());
            Grid::from_entries(4, 4, |i, j| match (i, j) {
                (3, 3) => 1.0,
                (3, _) => 0.0,
                (i, 3) => shift[i],
                (i, j) => turn.0[i][j],
            })
        }
        Family::Plane => {
            let (turn, shift) = (source.orthogonal::<2>(), source.vector::<2>());
            Grid::from_entries(3, 3, |i, j| match (i, j) {
                (2, 2) => 1.0,
                (2, _) => 0.0,
                (i, 2) => shift[i],
                (i, j) => turn.0[i][j],
            })
        }
        Family::Added(n, m) => any(source, n, m),
        // Close to the identity, so that the determinant is positive and the inverse is well conditioned.
        Family::Linear(n) => Grid::identity(n).plus(&any(source, n, n).scaled(0.3)),
    }
}

/// The basis of the Lie algebra for residuals.
fn basis(family: Family) -> Vec<Grid<f64>> {
    let axis = |k: usize| Grid::from_entries(3, 1, |i, _| f64::from(u8::from(i == k)));
    match family {
        Family::Rotation(3) => (0..3).map(|k| axis(k).hat()).collect(),
        Family::Rotation(n) => {
            let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
            pairs
                .map(|(i, j)| {
                    Grid::from_entries(n, n, |r, c| match (r, c) {
                        _ if (r, c) == (j, i) => 1.0,
                        _ if (r, c) == (i, j) => -1.0,
                        _ => 0.0,
                    })
                })
                .collect()
        }
        Family::Quaternion => (0..3)
            .map(|k| Grid::quaternion(0.0, [0, 1, 2].map(|i| if i == k { 0.5 } else { 0.0 })))
            .collect(),
        Family::Motion => (0..6)
            .map(|k| {
                Grid::from_entries(4, 4, |i, j| match (i, j) {
                    (3, _) => 0.0,
                    (i, 3) => f64::from(u8::from(k == i + 3)),
                    (i, j) if k < 3 => axis(k).hat().at(i, j),
                    _ => 0.0,
                })
            })
            .collect(),
        Family::Plane => (0..3)
            .map(|k| {
                Grid::from_entries(3, 3, |i, j| match (k, i, j) {
                    (0, 1, 0) | (1, 0, 2) | (2, 1, 2) => 1.0,
                    (0, 0, 1) => -1.0,
                    _ => 0.0,
                })
            })
            .collect(),
        Family::Linear(n) => basis(Family::Added(n, n)),
        Family::Added(n, m) => (0..n * m)
            .map(|k| Grid::from_entries(n, m, |i, j| f64::from(u8::from(i * m + j == k))))
            .collect(),
    }
}

impl<'a> Point<'a> {
    /// Random values for all symbols.
    pub fn draw(model: &'a Model, source: &mut Source, step: f64) -> Self {
        let constants = model
            .letters
            .iter()
            .map(|l| match (l.kind, &l.role) {
                (_, Role::Relative { defined: true, .. }) => Grid::identity(l.kind.shape().0),
                (Kind::Real, _) => Grid::number(source.between(0.3, 1.5)),
                (Kind::Vector(n), _) => any(source, n, 1),
                (Kind::Symmetric(n), _) => {
                    let a = any(source, n, n);
                    Grid::from_entries(n, n, |i, j| a.at(i.min(j), i.max(j)))
                }
                (Kind::Positive(n), _) => {
                    let a = any(source, n, n).scaled(0.4);
                    let product = Grid::identity(n).plus(&a.times(&a.transposed()));
                    // Exactly symmetric, because constructors check it.
                    Grid::from_entries(n, n, |i, j| product.at(i.min(j), i.max(j)))
                }
                (Kind::Skew(n), _) => {
                    let a = any(source, n, n);
                    Grid::from_entries(n, n, |i, j| match i.cmp(&j) {
                        std::cmp::Ordering::Less => a.at(i, j),
                        std::cmp::Ordering::Equal => 0.0,
                        std::cmp::Ordering::Greater => -a.at(j, i),
                    })
                }
                (Kind::Diagonal(n), _) => {
                    let a = any(source, n, 1);
                    Grid::from_entries(n, n, |i, j| if i == j { a.at(i, 0) } else { 0.0 })
                }
                (Kind::Matrix(n, m), _) => any(source, n, m),
                (Kind::Element(family), _) => element(source, family),
            })
            .collect();
        let nodal = model
            .summands
            .iter()
            .map(|(_, t)| model.is_nodal(t))
            .collect();
        Self {
            model,
            step,
            constants,
            nodal,
        }
    }

    /// A random node.
    pub fn node(&self, source: &mut Source) -> Node {
        let bodies = self.model.bodies.iter();
        bodies.map(|b| element(source, b.family)).collect()
    }

    /// The value of every symbol at a node, except velocities.
    #[must_use]
    pub fn letters<T: Number>(&self, node: &[Grid<T>]) -> Vec<Grid<T>> {
        let letters = self.model.letters.iter().zip(&self.constants);
        letters
            .map(|(l, constant)| {
                let own: Grid<T> = Grid::constant(constant);
                match l.role {
                    Role::Parameter | Role::Velocity(_) => own,
                    Role::Element(body) => node[body].clone(),
                    Role::Advected {
                        body,
                        action,
                        turns,
                        definition,
                    } => {
                        let at_identity = match definition.and_then(|by| self.constants.get(by)) {
                            Some(by) => Grid::constant(by),
                            None => own,
                        };
                        let b = &self.model.bodies[body];
                        let g = match (turns, b.family) {
                            (true, family) if family.is_motion() => {
                                node[body].block(family.turned(), family.turned(), (0, 0))
                            }
                            (true, _) => node[body].covered(),
                            (false, _) => node[body].clone(),
                        };
                        let (g, inverse) = match b.side {
                            Side::Body => (g.inverse(), g),
                            Side::Space => (g.clone(), g.inverse()),
                        };
                        acted(action, &g, &inverse, &at_identity)
                    }
                    Role::Relative { first, second, .. } => {
                        node[first].inverse().times(&own).times(&node[second])
                    }
                }
            })
            .collect()
    }

    /// Parameters, configurations and quantities without a definition, at three nodes.
    #[must_use]
    pub fn given(&self, nodes: &[Node; 3]) -> Vec<NamedValue> {
        let mut list = Vec::new();
        for (shift, node) in [-1, 0, 1].into_iter().zip(nodes) {
            for (index, value) in self.letters(node).into_iter().enumerate() {
                let letter = &self.model.letters[index];
                let constant = matches!(letter.role, Role::Parameter) && shift == 0;
                if self.model.uses(index) && (constant || letter.role.is_given()) {
                    list.push(NamedValue {
                        name: letter.name.clone(),
                        shift,
                        rows: value.rows,
                        cols: value.cols,
                        data: value.data,
                    });
                }
            }
        }
        list
    }

    /// The summands of the action of one edge.
    pub fn edge<T: Number>(&self, tail: &[Grid<T>], head: &[Grid<T>]) -> Vec<T> {
        let (mut here, next) = (self.letters(tail), self.letters(head));
        for (i, b) in self.model.bodies.iter().enumerate() {
            here[b.element + 1] = match b.side {
                _ if b.family.is_added() => head[i].plus(&tail[i].each(|x| -x)),
                Side::Body => tail[i].inverse().times(&head[i]),
                Side::Space => head[i].times(&tail[i].inverse()),
            };
        }
        let edge = Edge {
            step: self.step,
            here: &here,
            next: &next,
        };
        let at_head = Edge {
            step: self.step,
            here: &next,
            next: &next,
        };
        let scale = self.model.scale.as_ref().map(|s| s.value(&edge).scalar());
        let summands = self.model.summands.iter().zip(&self.nodal);
        summands
            .map(|((minus, t), nodal)| {
                let value = |at: &Edge<'_, T>, t: &Tree| t.value(at).scalar();
                let typed = match nodal {
                    true => self.model.rule.split(value(&edge, t), value(&at_head, t)),
                    false => value(&edge, t),
                };
                let signed = if *minus { -typed } else { typed };
                match scale {
                    Some(scale) => signed / scale,
                    None => signed,
                }
            })
            .collect()
    }

    /// The derivative of the action of both edges along each direction at the middle node.
    #[must_use]
    pub fn stationarity(&self, nodes: &[Node; 3]) -> Variation {
        let [before, here, after] = nodes;
        let (before, after) = (steady(before), steady(after));
        self.varied(here, |varied| {
            let mut summands = self.edge(&before, varied);
            summands.extend(self.edge(varied, &after));
            summands
        })
    }

    /// The momenta at both ends of an edge: minus the derivative at the tail, and the derivative at the head.
    #[must_use]
    pub fn momenta(&self, tail: &Node, head: &Node) -> [Variation; 2] {
        let (from, to) = (steady(tail), steady(head));
        let mut out = self.varied(tail, |varied| self.edge(varied, &to));
        out.derivative.iter_mut().for_each(|x| *x = -*x);
        [out, self.varied(head, |varied| self.edge(&from, varied))]
    }

    /// The directions of variation at a node, body by body.
    #[must_use]
    pub fn directions(&self, node: &Node) -> Vec<(usize, Grid<f64>)> {
        let bodies = self.model.bodies.iter().enumerate();
        let all = bodies.flat_map(|(i, b)| {
            let tangent = move |direction: Grid<f64>| match b.side {
                _ if b.family.is_added() => direction,
                Side::Body => node[i].times(&direction),
                Side::Space => direction.times(&node[i]),
            };
            let own = basis(b.family).into_iter();
            own.map(move |direction| (i, tangent(direction)))
        });
        all.collect()
    }

    /// The derivative of summands along each direction at a node.
    fn varied(&self, node: &Node, summands: impl Fn(&[Grid<Dual>]) -> Vec<Dual>) -> Variation {
        let mut derivative = Vec::new();
        let mut largest: Vec<f64> = Vec::new();
        for (i, tangent) in self.directions(node) {
            let mut varied = steady(node);
            varied[i] = Grid::from_entries(tangent.rows, tangent.cols, |r, c| Dual {
                value: node[i].at(r, c),
                slope: tangent.at(r, c),
            });
            let summands = summands(&varied);
            largest.resize(summands.len(), 0.0);
            for (size, s) in largest.iter_mut().zip(&summands) {
                // `max` would ignore a NaN summand.
                let own = s.slope.abs() + s.value.abs();
                *size = if own.is_finite() {
                    size.max(own)
                } else {
                    f64::NAN
                };
            }
            derivative.push(summands.iter().map(|s| s.slope).sum());
        }
        Variation {
            derivative,
            scale: largest.iter().sum(),
        }
    }
}

fn steady(node: &Node) -> Vec<Grid<Dual>> {
    node.iter().map(Grid::constant).collect()
}

/// A quantity acted on by `g`.
fn acted<T: Number>(action: Action, g: &Grid<T>, inverse: &Grid<T>, c: &Grid<T>) -> Grid<T> {
    match action {
        Action::Forward => g.times(c),
        Action::Dual => inverse.transposed().times(c),
        Action::Congruence => g.times(c).times(&g.transposed()),
        Action::DualCongruence => inverse.transposed().times(c).times(inverse),
        Action::Conjugation => g.times(c).times(inverse),
        Action::Weight => c.scaled(g.determinant()),
    }
}
