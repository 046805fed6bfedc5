//! The equations of a step as operations, and the loop that solves them: the calls that emitted code makes,
//! in the same order.

use super::search::{self, SearchValue, Sought};
use super::shape::Shape;
use crate::code::{Code, Evaluated, Exit, Iterate, Places, Routine, unfit};
use crate::failure::Failure;
use crate::map_scalar::{map_scalar, numbers};
use crate::recorded::{EquationValues, Function, NewtonFunction, RecordedSolve, Traced, run_alone};
use crate::value::Value;
use clebsch::Real;
use clebsch::emitted::{StepCause, StepError};
use clebsch::linalg::{Dense, Reals};
use clebsch::solvers::newton::{
    self, AnyNewton, Chart, Lane, NewtonError, Progress, Rounded, Solved,
};
use std::cell::RefCell;
use std::sync::Arc;

/// The operations for a solution that is not known to be principal, or for a failed search.
#[derive(Debug)]
pub struct Settled {
    /// If the motion may leave the domain: the place of the solution, the place of the flag for tried steps, and the
    /// check.
    pub contact: Option<(usize, usize, Code<f64>)>,
    /// A step of another size by another search, from the same state.
    pub other: Code<f64>,
    /// The names of the configurations.
    pub configurations: &'static &'static [&'static str],
}

/// Operations on a trial, given its place, and on other places.
#[derive(Clone, Debug)]
pub struct AtTrial {
    /// The place of the trial.
    pub place: usize,
    /// The operations.
    pub body: Code<f64>,
}

impl AtTrial {
    /// The value at a trial.
    ///
    /// # Errors
    /// As the operations have.
    fn at(&self, trial: Value<f64>, places: &mut Places<f64>) -> Evaluated<f64> {
        *unfit(places.get_mut(self.place))? = trial;
        self.body.returned(places)
    }
}

/// The equations of a step.
#[derive(Debug)]
pub struct Solve {
    /// The field of the workspace.
    pub search: Code<f64>,
    /// The node at which the step starts.
    pub node: Code<f64>,
    /// If Newton's method solves for a part of the trial: the whole trial, over numbers with rounding bounds. It
    /// takes parameters, step, values of the node, momenta and the part.
    pub completed_at: Option<Routine<Rounded>>,
    /// The parameters, the step, the values of the node that the residual needs, and the momenta.
    pub known: [Code<f64>; 4],
    /// The whole trial and the residual there.
    pub residual: AtTrial,
    /// The residual at rest.
    pub at_rest: Code<f64>,
    /// The tangent and its factor.
    pub tangent: AtTrial,
    /// Whether the velocity is moved from the left.
    pub from_left: bool,
    /// Whether the action is convex.
    pub convex: Option<AtTrial>,
    /// The operations if the solution may be another root, or if the search fails.
    pub settled: Settled,
    /// The residual as a separate function of parameters, step, values of the node, momenta and trial.
    pub residual_at: Function,
    /// The residual over numbers with their rounding.
    pub rounded_at: Routine<Rounded>,
    /// The tangent as a separate function of parameters, step, values of the node and trial.
    pub tangent_at: Function,
}

impl Iterate<f64> for Solve {
    fn run(&self, places: &mut Places<f64>) -> Result<Value<f64>, Exit<f64>> {
        let node = unfit(self.node.run(places)?.count())?;
        // Take the search out of its place while it runs.
        let place = unfit(self.search.place_mut(places))?;
        let mut held = match std::mem::replace(place, Value::Unit) {
            Value::Search(held) => held,
            _ => return unfit(None),
        };
        let solved = held.solve(self, node as u64, &mut EquationValues::Places(places));
        let shape = held.sought().all();
        let solved = solved.map(|solved| search::solution_value(shape, &solved));
        *unfit(self.search.place_mut(places))? = Value::Search(held);
        solved
    }

    fn recorded(self: Arc<Self>) -> Option<Arc<dyn Iterate<Traced>>> {
        Some(Arc::new(RecordedSolve::of(self)?))
    }
}

/// The numbers of the velocities of all groups.
type Element = Reals;

/// The entries of a vector with this number of coordinates.
pub fn vector<T: Real>(value: &Value<T>, size: usize) -> Option<Vec<T>> {
    if let Value::Real(x) = value {
        return (size == 1).then(|| vec![*x]);
    }
    let mut a = value.dense()?;
    a.data.truncate(size);
    (a.data.len() == size && a.cols == 1).then_some(a.data)
}

/// The leading rows and columns of a matrix.
pub fn matrix<T: Real>(value: &Value<T>, size: usize) -> Option<Dense<T>> {
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
    around: &mut EquationValues,
) -> Result<Solved<Element>, Exit<f64>> {
    let in_part = with.completed_at.is_some();
    let size = sought.shape.parts().dimension();
    let mut residual = Reals::new();
    let mut tangent = Dense::zeros(0, 0);
    loop {
        with.residual(iteration.trial(), &mut residual, sought, around)?;
        let whole: Option<Element> = in_part.then(|| residual.drain(size..).collect());
        if iteration.wants_scale() {
            let trial = whole.as_ref().unwrap_or(iteration.trial());
            let rounding = with.rounding(trial, sought, around)?;
            iteration.set_scale(&rounding);
        }
        let wanted = !in_part || iteration.wants_residual();
        if wanted && iteration.assess(&residual) {
            let unit = with.tangent(iteration.trial(), &mut tangent, sought, around)?;
            iteration.set_tangent_times(&tangent, unit);
        }
        let progress = match whole {
            Some(whole) => iteration.correct_part(whole, with.from_left),
            None => iteration.correct(with.from_left),
        };
        match progress {
            Progress::Continue => {}
            Progress::Solved(solved) if with.is_convex(iteration.assessed(), sought, around)? => {
                return Ok(solved);
            }
            ended => {
                if let Progress::Solved(solved) = &ended
                    && with.is_principal(iteration, &solved.element, sought, around)?
                {
                    return Ok(solved.clone());
                }
                if let Some(solved) = with.settle(iteration, ended, sought, around)? {
                    return Ok(solved);
                }
            }
        }
    }
}

impl Solve {
    /// The residual at a trial, then the whole trial if only a part of it is unknown.
    fn residual(
        &self,
        trial: &Element,
        out: &mut Reals,
        sought: &'static Sought,
        around: &mut EquationValues,
    ) -> Result<(), Exit<f64>> {
        let size = sought.shape.parts().dimension();
        out.clear();
        if around.by_tape(NewtonFunction::Residual, trial, out) {
            return Ok(());
        }
        let places = around.all();
        let Value::List(mut both) = self.residual.at(sought.shape.value(trial), places)? else {
            return unfit(None);
        };
        let mut all = unfit(both.pop().and_then(|x| vector(&x, size)))?;
        if self.completed_at.is_some() {
            unfit(both.pop().and_then(|x| numbers(&x, &mut all)))?;
        }
        *out = all.into();
        Ok(())
    }

    /// Evaluates the tangent; returns its factor.
    fn tangent(
        &self,
        trial: &Element,
        out: &mut Dense<f64>,
        sought: &'static Sought,
        around: &mut EquationValues,
    ) -> Result<f64, Exit<f64>> {
        let size = sought.shape.parts().dimension();
        out.data.clear();
        if around.by_tape(NewtonFunction::Tangent, trial, &mut out.data) {
            (out.rows, out.cols) = (size, size);
            return unfit(out.data.pop());
        }
        let places = around.all();
        match self.tangent.at(sought.shape.value(trial), places)? {
            Value::List(both) => match both.as_slice() {
                [tangent, Value::Real(unit)] => {
                    *out = unfit(matrix(tangent, size))?;
                    Ok(*unit)
                }
                _ => unfit(None),
            },
            _ => unfit(None),
        }
    }

    /// The residual of all equations at rest.
    fn at_rest(
        &self,
        trial: &Element,
        sought: &'static Sought,
        around: &mut EquationValues,
    ) -> Result<Element, Exit<f64>> {
        let mut found = Reals::new();
        if around.by_tape(NewtonFunction::AtRest, trial, &mut found) {
            return Ok(found);
        }
        let value = self.at_rest.run(around.all())?;
        unfit(vector(&value, sought.all().parts().dimension())).map(Reals::from)
    }

    fn is_principal(
        &self,
        iteration: &mut AnyNewton<'_, Shape>,
        solution: &Element,
        sought: &'static Sought,
        around: &mut EquationValues,
    ) -> Result<bool, Exit<f64>> {
        let all = sought.all();
        let at_rest = self.at_rest(iteration.trial(), sought, around)?;
        if self.completed_at.is_none() {
            let around = RefCell::new(around);
            let residual = |trial: &Element| {
                let mut around = around.borrow_mut();
                let mut found = Reals::new();
                if around.by_tape(NewtonFunction::Alone, trial, &mut found) {
                    return found;
                }
                match self.known(&mut around) {
                    Ok(known) => self.principal(&known, sought, |e| (e.residual)(trial)),
                    Err(_) => Reals::from_elem(f64::NAN, all.parts().dimension()),
                }
            };
            return Ok(iteration.is_principal(solution, &at_rest, residual));
        }
        let known = match iteration.asks_equations() {
            true => self.known(around)?,
            false => [const { Value::Unit }; 4],
        };
        let tangent = || {
            self.principal(&known, sought, |equations| {
                (equations.tangent)(&all.identity())
            })
        };
        Ok(iteration.is_part_of_principal(solution, &at_rest, tangent))
    }

    fn is_convex(
        &self,
        trial: &Element,
        sought: &'static Sought,
        around: &mut EquationValues,
    ) -> Result<bool, Exit<f64>> {
        let Some(convex) = &self.convex else {
            return Ok(false);
        };
        // The tape exists only where the action was convex.
        if around.by_tape(NewtonFunction::Convex, trial, &mut Reals::new()) {
            return Ok(true);
        }
        let found = convex.at(sought.shape.value(trial), around.all())?;
        Ok(matches!(found, Value::Bool(true)))
    }

    fn known(&self, around: &mut EquationValues) -> Result<[Value<f64>; 4], Exit<f64>> {
        let places = around.all();
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
        trial: &Element,
        sought: &Sought,
        around: &mut EquationValues,
    ) -> Result<Vec<f64>, Exit<f64>> {
        let known = self.known(around)?;
        let exactly = &mut Rounded::exactly;
        let mut given = Vec::with_capacity(self.rounded_at.places);
        for value in &known {
            given.push(unfit(map_scalar(value, exactly))?);
        }
        let trial = sought.all().value(trial);
        let mut trial = unfit(map_scalar(&trial, &mut Rounded::once))?;
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
        let rest = unfit(map_scalar(&residual, &mut |x: Rounded| x.error()))?;
        let whole = sought.all();
        let all = unfit(vector(&rest, whole.parts().dimension()))?;
        let rows = sought.shape.within(whole).into_iter();
        Ok(rows.filter_map(|i| all.get(i).copied()).collect())
    }

    /// The solution to use if the iteration fails or its solution may not be principal.
    /// `None` if the iteration restarts at the principal root.
    #[cold]
    fn settle(
        &self,
        iteration: &mut AnyNewton<'_, Shape>,
        ended: Progress<Element>,
        sought: &'static Sought,
        around: &mut EquationValues,
    ) -> Result<Option<Solved<Element>>, Exit<f64>> {
        let failed = match ended {
            Progress::Continue => return Ok(None),
            Progress::Solved(solved) => Ok(solved),
            Progress::Failed(e) => Err(e),
        };
        let known = self.known(around)?;
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
                    let places = around.all();
                    *unfit(places.get_mut(*at))? = search::solution_value(sought.all(), &solved);
                    *unfit(places.get_mut(*tries))? = Value::Bool(iteration.tries());
                    if let Value::Failed(e) = look.run(places)? {
                        return Err(Exit::Return(Box::new(Value::Failed(e))));
                    }
                }
                iteration.folded(fold, failed)
            }
        };
        if iteration.begin_afresh() {
            return Ok(None);
        }
        let e = self.refused(e, sought, around.all())?;
        Err(Failure::from(StepCause::from(e)).into())
    }

    /// The equations of the step, with all values at the start node fixed.
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
            let trial = shape.value(trial);
            let all = [parameters, step, given, momenta, &trial];
            let found = self.residual_at.at(&all);
            let found = found.and_then(|v| vector(&v, size));
            found.map_or_else(|| Reals::from_elem(f64::NAN, size), Reals::from)
        };
        let tangent = |trial: &Element| {
            let trial = shape.value(trial);
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

    /// Reports the equation with the largest residual, and a step size that can be solved.
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
        let places = RefCell::new(places);
        let other = |h: f64| -> Result<(), StepError> {
            let search = Value::Search(SearchValue::begun(sought, true));
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
