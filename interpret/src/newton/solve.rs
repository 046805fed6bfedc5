//! The equations of a step as operations, and the loop that solves them: the calls that emitted code makes,
//! in the same order.

use super::search::{self, Held, Sought};
use super::shape::Shape;
use crate::code::{Code, Exit, Iterate, Places, Routine, unfit};
use crate::failure::Failure;
use crate::over::over;
use crate::recorded::{Function, PlaceFunction, RecordedSolve, Traced, run_alone};
use crate::value::Value;
use clebsch::Real;
use clebsch::emitted::{StepCause, StepError};
use clebsch::linalg::Dense;
use clebsch::solvers::newton::{
    self, AnyNewton, Chart, Lane, NewtonError, Progress, Rounded, Solved,
};
use std::sync::Arc;

/// What is done where a solution is not known to be principal, or none was found.
#[derive(Debug)]
pub struct Settled {
    /// Whether the motion leaves the domain: where the solution, whether the step is only tried, and
    /// what looks.
    pub contact: Option<(usize, usize, Code<f64>)>,
    /// A step of another size by another search, from the same state.
    pub other: Code<f64>,
    /// The names of the configurations.
    pub configurations: &'static &'static [&'static str],
}

/// The equations of a step.
#[derive(Debug)]
pub struct Solve {
    /// The field of the workspace.
    pub search: Code<f64>,
    /// The node that is left.
    pub node: Code<f64>,
    /// If Newton's method searches for a part of the trial: the whole trial over numbers with their rounding. It takes
    /// parameters, step, values of the node, momenta and the part.
    pub completed_at: Option<Routine<Rounded>>,
    /// The parameters, the step, what the residual asks of the node and its momenta.
    pub known: [Code<f64>; 4],
    /// The whole trial and the residual there. The argument is the trial.
    pub residual: PlaceFunction,
    /// The residual at rest.
    pub at_rest: Code<f64>,
    /// The tangent and its factor. The argument is the trial.
    pub tangent: PlaceFunction,
    /// Whether the velocity is moved from the left.
    pub from_left: bool,
    /// Whether the action is convex. The argument is the trial.
    pub convex: Option<PlaceFunction>,
    /// Otherwise.
    pub settled: Settled,
    /// The residual by itself: of parameters, step, what is asked of the node, momenta, trial.
    pub residual_at: Function,
    /// The same over numbers with their rounding.
    pub rounded_at: Routine<Rounded>,
    /// The tangent by itself: of parameters, step, what is asked of the node, trial.
    pub tangent_at: Function,
}

impl Iterate<f64> for Solve {
    fn run(&self, places: &mut Places<f64>) -> Result<Value<f64>, Exit<f64>> {
        let node = unfit(self.node.run(places)?.count())?;
        // Lent for as long as it is at work.
        let place = unfit(self.search.place_mut(places))?;
        let mut held = match std::mem::replace(place, Value::Unit) {
            Value::Search(held) => held,
            _ => return unfit(None),
        };
        let solved = held.solve(self, node as u64, places);
        *unfit(self.search.place_mut(places))? = Value::Search(held);
        solved
    }

    fn recorded(self: Arc<Self>) -> Option<Arc<dyn Iterate<Traced>>> {
        Some(Arc::new(RecordedSolve::of(self)?))
    }
}

/// The velocities of all groups.
type Element = Vec<Value<f64>>;

/// The entries of a vector of so many coordinates.
fn vector(value: &Value<f64>, size: usize) -> Option<Vec<f64>> {
    if let Value::Real(x) = value {
        return (size == 1).then(|| vec![*x]);
    }
    let mut a = value.dense()?;
    a.data.truncate(size);
    (a.data.len() == size && a.cols == 1).then_some(a.data)
}

/// The leading rows and columns of a matrix.
fn matrix<T: Real>(value: &Value<T>, size: usize) -> Option<Dense<T>> {
    let a = value.dense()?;
    match (
        a.rows == size && a.cols == size,
        a.rows >= size && a.cols >= size,
    ) {
        (true, _) => Some(a),
        (_, true) => Some(Dense::from_fn(size, size, |i, j| a.at(i, j))),
        _ => None,
    }
}

/// Iterates to the solution.
pub fn by(
    iteration: &mut AnyNewton<'_, Shape>,
    with: &Solve,
    sought: &'static Sought,
    places: &mut Places<f64>,
) -> Result<Solved<Element>, Exit<f64>> {
    let size = sought.shape.parts().dimension();
    let in_part = with.completed_at.is_some();
    loop {
        let trial = Value::List(iteration.trial().clone());
        let (whole, residual) = with.residual(&trial, size, places)?;
        if iteration.wants_scale() {
            let rounding = with.rounding(&whole, sought, places)?;
            iteration.set_scale(&rounding);
        }
        let wanted = !in_part || iteration.wants_residual();
        if wanted && iteration.assess(residual) {
            let (tangent, unit) = with.tangent(&trial, size, places)?;
            iteration.set_tangent_times(tangent, unit);
        }
        let progress = match (in_part, whole) {
            (true, Value::List(whole)) => iteration.correct_part(whole, with.from_left),
            _ => iteration.correct(with.from_left),
        };
        match progress {
            Progress::Continue => {}
            Progress::Solved(solved) if with.is_convex(&trial, places)? => return Ok(solved),
            ended => {
                if let Progress::Solved(solved) = &ended {
                    let at_rest = with.at_rest.run(places)?;
                    if with.is_principal(iteration, &solved.element, &at_rest, sought, places)? {
                        return Ok(solved.clone());
                    }
                }
                if let Some(solved) = with.settle(iteration, ended, sought, places)? {
                    return Ok(solved);
                }
            }
        }
    }
}

impl Solve {
    /// The whole trial and the residual there.
    fn residual(
        &self,
        trial: &Value<f64>,
        size: usize,
        places: &mut Places<f64>,
    ) -> Result<(Value<f64>, Vec<f64>), Exit<f64>> {
        match self.residual.at(trial, places)? {
            Value::List(mut both) if both.len() == 2 => {
                let residual = unfit(both.pop().and_then(|x| vector(&x, size)))?;
                Ok((unfit(both.pop())?, residual))
            }
            _ => unfit(None),
        }
    }

    /// The tangent and its factor.
    fn tangent(
        &self,
        trial: &Value<f64>,
        size: usize,
        places: &mut Places<f64>,
    ) -> Result<(Dense<f64>, f64), Exit<f64>> {
        match self.tangent.at(trial, places)? {
            Value::List(both) => match both.as_slice() {
                [tangent, Value::Real(unit)] => Ok((unfit(matrix(tangent, size))?, *unit)),
                _ => unfit(None),
            },
            _ => unfit(None),
        }
    }

    fn is_principal(
        &self,
        iteration: &mut AnyNewton<'_, Shape>,
        solution: &Element,
        at_rest: &Value<f64>,
        sought: &'static Sought,
        places: &mut Places<f64>,
    ) -> Result<bool, Exit<f64>> {
        let all = sought.all();
        let at_rest = unfit(vector(at_rest, all.parts().dimension()))?;
        let known = match iteration.asks_equations() {
            true => self.known(places)?,
            false => [const { Value::Unit }; 4],
        };
        if self.completed_at.is_none() {
            return Ok(self.principal(&known, sought, |equations| {
                iteration.is_principal(solution, &at_rest, equations.residual)
            }));
        }
        let tangent = || {
            self.principal(&known, sought, |equations| {
                (equations.tangent)(&all.identity())
            })
        };
        Ok(iteration.is_part_of_principal(solution, &at_rest, tangent))
    }

    fn is_convex(&self, trial: &Value<f64>, places: &mut Places<f64>) -> Result<bool, Exit<f64>> {
        match &self.convex {
            Some(convex) => Ok(matches!(convex.at(trial, places)?, Value::Bool(true))),
            None => Ok(false),
        }
    }

    fn known(&self, places: &mut Places<f64>) -> Result<[Value<f64>; 4], Exit<f64>> {
        let [parameters, step, given, momenta] = &self.known;
        Ok([
            parameters.run(places)?,
            step.run(places)?,
            given.run(places)?,
            momenta.run(places)?,
        ])
    }

    /// Bounds of the rounding of the residual.
    fn rounding(
        &self,
        trial: &Value<f64>,
        sought: &Sought,
        places: &mut Places<f64>,
    ) -> Result<Vec<f64>, Exit<f64>> {
        let known = self.known(places)?;
        let exactly = &mut Rounded::exactly;
        let mut given = Vec::with_capacity(self.rounded_at.places);
        for value in &known {
            given.push(unfit(over(value, exactly))?);
        }
        let mut trial = unfit(over(trial, &mut Rounded::once))?;
        if let (Some(completed_at), Value::List(list)) = (&self.completed_at, &trial) {
            let rotation = |value: &Value<Rounded>| match value {
                Value::Motion(g) => Value::Rotation(g.rotation),
                other => other.clone(),
            };
            let mut known = given.clone();
            known.push(Value::List(list.iter().map(rotation).collect()));
            trial = unfit(run_alone(completed_at, known))?;
        }
        given.push(trial);
        let residual = unfit(run_alone(&self.rounded_at, given))?;
        let rest = unfit(over(&residual, &mut |x: Rounded| x.error()))?;
        let whole = sought.all();
        let all = unfit(vector(&rest, whole.parts().dimension()))?;
        let rows = sought.shape.within(whole).into_iter();
        Ok(rows.filter_map(|i| all.get(i).copied()).collect())
    }

    /// The solution to be taken where the one found is not known to be principal, or none was found.
    /// None where the iteration begins again, at the principal root.
    #[cold]
    fn settle(
        &self,
        iteration: &mut AnyNewton<'_, Shape>,
        ended: Progress<Element>,
        sought: &'static Sought,
        places: &mut Places<f64>,
    ) -> Result<Option<Solved<Element>>, Exit<f64>> {
        let failed = match ended {
            Progress::Continue => return Ok(None),
            Progress::Solved(solved) => Ok(solved),
            Progress::Failed(e) => Err(e),
        };
        let known = self.known(places)?;
        let asked = failed.as_ref().ok().map(|solved| &solved.element);
        let settled = self.principal(&known, sought, |equations| {
            iteration.settle(equations, asked)
        });
        let e = match (settled, failed) {
            (Ok(newton::Settled::Principal), Ok(solved)) => return Ok(Some(solved)),
            (Ok(newton::Settled::Again), _) => return Ok(None),
            (Ok(_), Err(e)) => e,
            (Ok(_), Ok(_)) => iteration.unpolished(),
            (Err(fold), failed) => {
                let (solved, failed) = match failed {
                    Ok(solved) => (Some(solved), None),
                    Err(e) => (None, Some(e)),
                };
                if let (Some((at, tries, look)), Some(solved)) = (&self.settled.contact, solved) {
                    *unfit(places.get_mut(*at))? = search::told(solved);
                    *unfit(places.get_mut(*tries))? = Value::Bool(iteration.tries());
                    if let Value::Failed(e) = look.run(places)? {
                        return Err(Exit::Return(Box::new(Value::Failed(e))));
                    }
                }
                iteration.folded(fold, failed)
            }
        };
        let e = self.refused(e, sought, places)?;
        Err(Failure::from(StepCause::from(e)).into())
    }

    /// The equations of the step, with everything at its node held fixed.
    fn principal<R>(
        &self,
        known: &[Value<f64>; 4],
        sought: &'static Sought,
        then: impl FnOnce(&Lane<Shape>) -> R,
    ) -> R {
        let [parameters, step, given, momenta] = known;
        let shape = sought.all();
        let size = shape.parts().dimension();
        let residual = |trial: &Element| {
            let trial = Value::List(trial.clone());
            let all = [parameters, step, given, momenta, &trial];
            let found = self.residual_at.at(&all);
            let found = found.and_then(|v| vector(&v, size));
            found.unwrap_or_else(|| vec![f64::NAN; size])
        };
        let tangent = |trial: &Element| {
            let trial = Value::List(trial.clone());
            let found = self.tangent_at.at(&[parameters, step, given, &trial]);
            let found = found.and_then(|v| matrix(&v, size));
            found.unwrap_or_else(|| Dense::unknown(size, size))
        };
        then(&Lane {
            chart: shape,
            residual: &residual,
            tangent: &tangent,
        })
    }

    /// Says which equation is worst, and which step could be solved.
    #[cold]
    fn refused(
        &self,
        e: NewtonError,
        sought: &'static Sought,
        places: &mut Places<f64>,
    ) -> Result<NewtonError, Exit<f64>> {
        let h = match self.known[1].run(places)? {
            Value::Real(h) => h,
            _ => return unfit(None),
        };
        let places = std::cell::RefCell::new(places);
        let other = |h: f64| -> Result<(), StepError> {
            let search = Value::Search(Held::begun(sought, true));
            let untold = |what| Err(StepCause::Unread { what }.at_node(0));
            let given = vec![Value::Real(h), search];
            match self.settled.other.call(given, &mut places.borrow_mut()) {
                Ok(Value::Failed(e)) => Err(e.step(0)),
                Ok(_) => Ok(()),
                Err(Exit::Return(_)) => untold("step"),
                Err(Exit::Unfit(what)) => untold(what),
            }
        };
        Ok(e.explained_by(h, self.settled.configurations, &other))
    }
}
