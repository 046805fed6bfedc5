//! The search for the velocities of one step after the other, as a value.

use super::shape::Shape;
use super::solve::{self, Solve};
use crate::code::Exit;
use crate::library::NAMES;
use crate::map_scalar::numbers;
use crate::recorded::EquationValues;
use crate::value::{Layout, Struct, Value};
use clebsch::Real;
use clebsch::linalg::Reals;
use clebsch::saved::{Words, sites};
use clebsch::solvers::newton::{AnySearch, Chart, Solved};
use std::sync::{Arc, OnceLock};

/// The unknowns of a search.
#[derive(Debug, PartialEq, Eq)]
pub struct Sought {
    /// The groups of the velocities that are searched for.
    pub shape: Shape,
    /// The groups of all velocities, if some of them are solved for beforehand.
    pub whole: Option<Shape>,
    /// The number of coordinates for which the emitted code has space.
    pub capacity: usize,
}

impl Sought {
    /// The groups of all velocities.
    pub fn all(&self) -> &Shape {
        self.whole.as_ref().unwrap_or(&self.shape)
    }
}

/// A search, as a value.
#[derive(Clone, Debug)]
pub struct SearchValue {
    search: Box<AnySearch<Shape>>,
    sought: &'static Sought,
}

impl SearchValue {
    /// A new search.
    pub fn begun(sought: &'static Sought, tries: bool) -> Self {
        let dimension = sought.shape.parts().dimension();
        let in_blocks = dimension == sought.capacity;
        SearchValue {
            search: Box::new(AnySearch::new(dimension, in_blocks, tries)),
            sought,
        }
    }

    /// Copies the scales that another search has measured: see [`AnySearch::measure_as`].
    pub fn measure_as(&mut self, other: &SearchValue) {
        self.search.measure_as(&other.search);
    }

    /// From now on, steps are only tried.
    pub fn only_try(&mut self) {
        self.search.only_try();
    }

    /// A new search for the unknowns of `other`. It only tries steps if this search only tries steps.
    pub fn alike(&self, other: &SearchValue) -> SearchValue {
        Self::begun(other.sought, self.search.tries())
    }

    /// Whether steps are only tried.
    pub fn tries(&self) -> bool {
        self.search.tries()
    }

    /// Saves or restores the solutions that the search stores.
    pub fn words(&mut self, words: &mut Words) {
        let chart = &self.sought.shape;
        self.search.words(words, chart, |element, words| {
            sites(element, words);
        });
    }

    /// Solves the step that starts at `node`.
    ///
    /// # Errors
    /// [`Exit`] with the error of the step.
    pub fn solve(
        &mut self,
        equations: &Solve,
        node: u64,
        around: &mut EquationValues,
    ) -> Result<Solved<Reals>, Exit<f64>> {
        let charts = [&self.sought.shape, self.sought.all()];
        let mut iteration = self.search.begin(charts, node);
        solve::by(&mut iteration, equations, self.sought, around)
    }

    /// The velocities that it finds.
    pub fn sought(&self) -> &'static Sought {
        self.sought
    }

    /// Stores the solution of the step that started at `node`.
    pub fn remember(&mut self, node: u64, solution: &Reals) {
        let part = self.sought.shape.part(self.sought.all(), solution);
        self.search.remember(node, part);
    }
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

/// A solution for all groups, in the form of emitted code.
pub fn solution_value(shape: &Shape, solved: &Solved<Reals>) -> Value<f64> {
    Value::Struct(Struct {
        layout: layout(),
        values: vec![
            shape.value(&solved.element),
            Value::Int(i64::try_from(solved.iterations).unwrap_or(i64::MAX)),
            Value::Double(solved.residual),
        ],
    })
}

/// `search.remember(node, &found)`, for any scalar: searches use plain numbers.
pub fn remember<T: Real>(search: &mut Value<T>, node: &Value<T>, found: &Value<T>) -> Option<()> {
    let (Value::Search(held), Value::Struct(found)) = (search, found) else {
        return None;
    };
    let mut element = Vec::new();
    numbers(found.values.first()?, &mut element)?;
    let element = element.into_iter().map(Real::value).collect();
    held.remember(u64::try_from(node.count()?).ok()?, &element);
    Some(())
}
