//! A random model with values: an unreduced action of the rotation alone.
//! Takes a random Lagrangian and a source; gives the action of one step, in which every advected quantity
//! is computed from the rotation, by its definition or from the constant value that the group carries.

use super::RandomLagrangian;
use super::tree::{Carried, Kind, Role, Symbol};
use crate::oracle::action::{DiscreteAction, Side};
use crate::oracle::dual::Number;
use crate::oracle::eval::{Place, Value};
use crate::oracle::points::{Given, Source};
use crate::oracle::square::Square;

/// A random Lagrangian at random values of its parameters.
#[derive(Clone, Debug)]
pub struct Sample<'a> {
    lagrangian: &'a RandomLagrangian,
    /// The step.
    pub step: f64,
    /// By place in the table: the value of a parameter, or the value of an advected quantity at `Λ = Id`.
    pub constants: Vec<Value<f64>>,
    /// Whether each summand has no velocity.
    nodal: Vec<bool>,
}

impl<'a> Sample<'a> {
    /// Random values for all letters.
    pub fn draw(lagrangian: &'a RandomLagrangian, source: &mut Source) -> Self {
        let step = source.between(0.2, 1.0);
        let constants = lagrangian
            .symbols
            .iter()
            .map(|symbol| match symbol.kind {
                Kind::Real => Value::Scalar(source.between(0.3, 1.5)),
                Kind::Vector => Value::Column(source.vector()),
                Kind::Symmetric => Value::Matrix(source.symmetric()),
                Kind::Positive => Value::Matrix(source.positive()),
                Kind::Skew => Value::Matrix(source.skew()),
                Kind::Matrix | Kind::Rotation => Value::Matrix(source.matrix()),
            })
            .collect();
        Self::with(lagrangian, step, constants)
    }

    /// The Lagrangian at given values, by place in the table of letters.
    #[must_use]
    pub fn with(lagrangian: &'a RandomLagrangian, step: f64, constants: Vec<Value<f64>>) -> Self {
        let nodal = lagrangian
            .summands
            .iter()
            .map(|summand| lagrangian.is_nodal(summand))
            .collect();
        Self {
            lagrangian,
            step,
            constants,
            nodal,
        }
    }

    fn velocity<T: Number>(&self, tail: &Square<T, 3>, head: &Square<T, 3>) -> Value<T> {
        Value::Matrix(match self.lagrangian.side {
            Side::Body => tail.transpose() * *head,
            Side::Space => *head * tail.transpose(),
        })
    }

    /// The values of all letters at a node; the velocity is left open.
    fn letters<T: Number>(&self, node: &Square<T, 3>) -> Vec<Value<T>> {
        let constants: Vec<Value<T>> = self.constants.iter().map(Value::constant).collect();
        // Definitions speak of parameters and of the group alone.
        let mut letters = constants.clone();
        if let Some(group) = letters.first_mut() {
            *group = Value::Matrix(*node);
        }
        let here = Place {
            step: self.step,
            letters: &letters,
            at_head: &[],
            lets: &[],
        };
        let mut values = letters.clone();
        for ((value, symbol), constant) in values
            .iter_mut()
            .zip(&self.lagrangian.symbols)
            .zip(&constants)
        {
            match &symbol.role {
                Role::Advected {
                    definition: Some(definition),
                    ..
                } => {
                    *value = here.value(definition);
                }
                Role::Advected {
                    carried,
                    definition: None,
                } => {
                    *value = self.carry(*carried, node, constant);
                }
                Role::Velocity => *value = Value::impossible(),
                Role::Group | Role::Parameter => {}
            }
        }
        values
    }

    fn carry<T: Number>(
        &self,
        carried: Carried,
        node: &Square<T, 3>,
        constant: &Value<T>,
    ) -> Value<T> {
        let left = match self.lagrangian.side {
            Side::Body => node.transpose(),
            Side::Space => *node,
        };
        match (carried, constant) {
            (Carried::Vector, Value::Column(a)) => Value::Column(left.apply(a)),
            (Carried::OneSided, Value::Matrix(a)) => Value::Matrix(left * *a),
            (Carried::Congruence, Value::Matrix(a)) => Value::Matrix(left * *a * left.transpose()),
            _ => Value::impossible(),
        }
    }

    /// Parameters, configurations, and advected quantities that have no definition, at three nodes.
    #[must_use]
    pub fn given(&self, nodes: &[[Square<f64, 3>; 1]; 3]) -> Vec<Given> {
        let mut given = Vec::new();
        for (index, symbol) in self.lagrangian.symbols.iter().enumerate() {
            if index > 0 && !self.lagrangian.uses(index) {
                continue;
            }
            match &symbol.role {
                Role::Group => {
                    given.extend(Given::at_nodes(&symbol.name, nodes.map(|[node]| node)));
                }
                Role::Parameter => {
                    given.extend(
                        self.constants
                            .get(index)
                            .map(|value| plain(symbol, 0, value)),
                    );
                }
                Role::Advected {
                    carried,
                    definition: None,
                } => {
                    for (shift, [node]) in [-1, 0, 1].into_iter().zip(nodes) {
                        let value = self
                            .constants
                            .get(index)
                            .map(|constant| self.carry(*carried, node, constant));
                        given.extend(value.map(|value| plain(symbol, shift, &value)));
                    }
                }
                Role::Advected {
                    definition: Some(_),
                    ..
                }
                | Role::Velocity => {}
            }
        }
        given
    }
}

fn plain(symbol: &Symbol, shift: i8, value: &Value<f64>) -> Given {
    match value {
        Value::Scalar(x) => Given::scalar(&symbol.name, *x),
        Value::Column(x) | Value::Row(x) => Given::column(&symbol.name, shift, x),
        Value::Matrix(x) => Given::square(&symbol.name, shift, x),
    }
}

impl DiscreteAction<3, 1> for Sample<'_> {
    fn side(&self) -> Side {
        self.lagrangian.side
    }

    fn edge<T: Number>(&self, tail: &[Square<T, 3>; 1], head: &[Square<T, 3>; 1]) -> Vec<T> {
        let (mut at_tail, at_head) = (self.letters(&tail[0]), self.letters(&head[0]));
        if let Some(velocity) = at_tail.get_mut(1) {
            *velocity = self.velocity(&tail[0], &head[0]);
        }
        let lets = &self.lagrangian.lets;
        let edge = Place {
            step: self.step,
            letters: &at_tail,
            at_head: &at_head,
            lets,
        };
        let head = Place {
            step: self.step,
            letters: &at_head,
            at_head: &[],
            lets,
        };
        let scale = match &self.lagrangian.scale {
            Some(scale) => edge.value(scale).scalar(),
            None => T::constant(1.0),
        };
        self.lagrangian
            .summands
            .iter()
            .zip(&self.nodal)
            .map(|(summand, nodal)| {
                let sign = T::constant(if summand.subtracted { -1.0 } else { 1.0 });
                let typed = if *nodal {
                    let (from, to) = (edge.value(&summand.expr), head.value(&summand.expr));
                    self.lagrangian.rule.split(from.scalar(), to.scalar())
                } else {
                    edge.value(&summand.expr).scalar()
                };
                sign * typed / scale
            })
            .collect()
    }
}
