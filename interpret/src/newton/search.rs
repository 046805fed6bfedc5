//! The search for one velocity after the other, its type hidden: the solver's own, for any groups.

use super::element::Element;
use super::node::{Asked, Kept, Nodes};
use super::shape::{Shape, of_dimension};
use super::solve::{self, Solve};
use crate::code::{Exit, Places};
use crate::library::NAMES;
use crate::value::{Layout, Struct, Value};
use clebsch::Real;
use clebsch::solvers::newton::{self, NodeValues, Solved};
use std::fmt::Debug;
use std::sync::{Arc, OnceLock};

/// What a search is for.
#[derive(Debug, PartialEq, Eq)]
pub struct Sought {
    /// The groups of the velocities.
    pub shape: Shape,
    /// What the tangent asks of a node.
    pub node: Vec<Kept>,
    /// How many coordinates the velocities have together.
    pub dimension: usize,
}

/// What steps are made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// To go on from there.
    Run,
    /// To find out which one to offer.
    Trial,
    /// To offer it.
    Offer,
}

/// A search without velocities, which only says what steps are made for.
type Bare = newton::Search<f64, Element<1>, [f64; 0], 1>;

impl Purpose {
    fn bare(self) -> Bare {
        match self {
            Purpose::Run => Bare::from_rest(),
            Purpose::Trial => Bare::to_try(),
            Purpose::Offer => Bare::to_offer(),
        }
    }
}

/// A search.
pub trait Searching: Debug + Send + Sync {
    /// A copy.
    fn copied(&self) -> Box<dyn Searching>;

    /// Solves a step that leaves `node`.
    ///
    /// # Errors
    /// [`Exit`] with the error of the step.
    fn solve(
        &mut self,
        equations: &Solve,
        node: u64,
        values: &Value<f64>,
        places: &mut Places<f64>,
    ) -> Result<Value<f64>, Exit<f64>>;

    /// Remembers the solution of the step that began at `node`.
    fn remember(&mut self, node: u64, solution: &Value<f64>) -> Option<()>;

    /// A search for others, with the same purpose.
    fn alike(&self, others: &'static Sought) -> Option<Box<dyn Searching>>;
}

/// A search, as a value.
#[derive(Debug)]
pub struct Held(pub Box<dyn Searching>, pub &'static Sought);

impl Held {
    /// A search for what another is for, with the purpose of this one.
    pub fn alike(&self, other: &Held) -> Option<Held> {
        Some(Held(self.0.alike(other.1)?, other.1))
    }
}

impl Clone for Held {
    fn clone(&self) -> Self {
        Held(self.0.copied(), self.1)
    }
}

#[derive(Clone, Debug)]
struct Search<V: NodeValues<Scalar = f64>, const D: usize> {
    inner: newton::Search<f64, Element<D>, V, D>,
    sought: &'static Sought,
}

/// A search that begins; nothing where it has too many coordinates.
pub fn begun(sought: &'static Sought, purpose: Purpose) -> Option<Held> {
    let _at_work = sought.shape.at_work();
    Some(Held(like(&purpose.bare(), sought)?, sought))
}

fn like(bare: &Bare, sought: &'static Sought) -> Option<Box<dyn Searching>> {
    let _at_work = sought.shape.at_work();
    of_dimension!(sought.dimension, D, {
        Some(match sought.node.is_empty() {
            true => Box::new(Search::<[f64; 0], D> {
                inner: bare.alike(),
                sought,
            }),
            false => Box::new(Search::<Nodes<f64>, D> {
                inner: bare.alike(),
                sought,
            }),
        })
    })
}

impl<V: Asked + 'static, const D: usize> Searching for Search<V, D> {
    fn copied(&self) -> Box<dyn Searching> {
        Box::new(self.clone())
    }

    fn solve(
        &mut self,
        equations: &Solve,
        node: u64,
        values: &Value<f64>,
        places: &mut Places<f64>,
    ) -> Result<Value<f64>, Exit<f64>> {
        let _at_work = self.sought.shape.at_work();
        let values = crate::code::unfit(V::read(values, &self.sought.node))?;
        let mut iteration = self.inner.begin(node, values);
        let solved = solve::by(&mut iteration, equations, self.sought, places)?;
        Ok(told(&solved))
    }

    fn remember(&mut self, node: u64, solution: &Value<f64>) -> Option<()> {
        let _at_work = self.sought.shape.at_work();
        self.inner.remember(node, &read(solution)?);
        Some(())
    }

    fn alike(&self, others: &'static Sought) -> Option<Box<dyn Searching>> {
        let bare = {
            let _at_work = self.sought.shape.at_work();
            self.inner.alike::<Element<1>, [f64; 0], 1>()
        };
        like(&bare, others)
    }
}

/// A search of a type that the solver made, as a value.
pub fn held<V: Asked + 'static, const D: usize>(
    inner: newton::Search<f64, Element<D>, V, D>,
    sought: &'static Sought,
) -> Value<f64> {
    Value::Search(Held(Box::new(Search { inner, sought }), sought))
}

fn layout() -> Arc<Layout> {
    static LAYOUT: OnceLock<Arc<Layout>> = OnceLock::new();
    let number = |name: &str| NAMES.iter().position(|n| *n == name).unwrap_or(0) as u32;
    let made = || {
        Arc::new(Layout {
            name: "Solved".to_owned(),
            fields: ["element", "iterations", "residual"].map(number).to_vec(),
        })
    };
    LAYOUT.get_or_init(made).clone()
}

/// A solution as emitted code has it.
pub fn told<const D: usize>(solved: &Solved<Element<D>>) -> Value<f64> {
    Value::Struct(Struct {
        layout: layout(),
        values: vec![
            solved.element.value(),
            Value::Int(i64::try_from(solved.iterations).unwrap_or(i64::MAX)),
            Value::Double(solved.residual),
        ],
    })
}

fn read<const D: usize>(value: &Value<f64>) -> Option<Solved<Element<D>>> {
    let Value::Struct(s) = value else {
        return None;
    };
    match s.values.as_slice() {
        [element, Value::Int(iterations), Value::Double(residual)] => Some(Solved {
            element: Element::from_value(element)?,
            iterations: usize::try_from(*iterations).ok()?,
            residual: *residual,
        }),
        _ => None,
    }
}

/// `search.remember(node, &found)`, whatever the scalar: searches are in plain numbers.
pub fn remember<T: Real>(search: &mut Value<T>, node: &Value<T>, found: &Value<T>) -> Option<()> {
    let Value::Search(held) = search else {
        return None;
    };
    let found = super::over(found, &mut |x: T| x.value())?;
    held.0.remember(u64::try_from(node.count()?).ok()?, &found)
}
