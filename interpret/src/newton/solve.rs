//! The equations of a step as operations, and the loop that solves them: the calls that emitted code makes,
//! in the same order.

use super::over;
use super::search::{self, Held, Sought};
use super::shape::Shape;
use crate::code::{Code, Exit, Iterate, Places, Routine, unfit};
use crate::failure::Failure;
use crate::value::Value;
use clebsch::Real;
use clebsch::emitted::{StepCause, StepError};
use clebsch::linalg::Dense;
use clebsch::solvers::newton::{
    self, AnyNewton, Chart, Lane, NewtonError, Progress, Rounded, Solved,
};

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

/// What is solved for beforehand.
#[derive(Debug)]
pub struct Rest {
    /// Where the part that is searched for stands.
    pub part: usize,
    /// What makes the whole trial of it.
    pub code: Vec<Code<f64>>,
    /// The same by itself, over numbers with their rounding: of parameters, step, what is asked of the node,
    /// momenta, part.
    pub rounded_at: Routine<Rounded>,
}

/// The equations of a step.
#[derive(Debug)]
pub struct Solve {
    /// The field of the workspace.
    pub search: Code<f64>,
    /// The node that is left.
    pub node: Code<f64>,
    /// Where the trial stands.
    pub trial: usize,
    /// What finds the rest of it, where a part is searched for.
    pub rest: Option<Rest>,
    /// The parameters, the step, what the residual asks of the node and its momenta.
    pub known: [Code<f64>; 4],
    /// What both need of the trial.
    pub at_trial: Vec<Code<f64>>,
    /// The residual.
    pub residual: Code<f64>,
    /// The residual at rest.
    pub at_rest: Code<f64>,
    /// The tangent.
    pub tangent: Code<f64>,
    /// What the tangent stands times.
    pub unit: Option<Code<f64>>,
    /// Whether the velocity is moved from the left.
    pub from_left: bool,
    /// Whether the action is convex there.
    pub convex: Option<Code<f64>>,
    /// Otherwise.
    pub settled: Settled,
    /// The residual by itself: of parameters, step, what is asked of the node, momenta, trial.
    pub residual_at: Routine<f64>,
    /// The same over numbers with their rounding.
    pub rounded_at: Routine<Rounded>,
    /// The tangent by itself: of parameters, step, what is asked of the node, trial.
    pub tangent_at: Routine<f64>,
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
}

/// A function with places of its own.
fn run<T: Real>(routine: &Routine<T>, given: Vec<Value<T>>) -> Option<Value<T>> {
    let mut places = given;
    places.resize(routine.places.max(places.len()), Value::Unit);
    match routine.body.run(&mut places) {
        Ok(value) => Some(value),
        Err(Exit::Return(value)) => Some(*value),
        Err(Exit::Unfit(_)) => None,
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
    loop {
        let trial = Value::List(iteration.trial().clone());
        let trial = with.whole(trial, places)?;
        if iteration.wants_scale() {
            let rounding = with.rounding(&trial, sought, places)?;
            iteration.set_scale(&rounding);
        }
        *unfit(places.get_mut(with.trial))? = trial.clone();
        for code in &with.at_trial {
            code.run(places)?;
        }
        let wanted = with.rest.is_none() || iteration.wants_residual();
        if wanted && iteration.assess(with.residual(size, places)?) {
            let tangent = with.tangent.run(places)?;
            let tangent = unfit(matrix(&tangent, size))?;
            match &with.unit {
                Some(unit) => match unit.run(places)? {
                    Value::Real(h) => iteration.set_tangent_times(tangent, h),
                    _ => return unfit(None),
                },
                None => iteration.set_tangent_times(tangent, 1.0),
            }
        }
        let progress = match (&with.rest, trial) {
            (Some(_), Value::List(whole)) => iteration.correct_part(whole, with.from_left),
            _ => iteration.correct(with.from_left),
        };
        match progress {
            Progress::Continue => {}
            Progress::Solved(solved) if with.is_convex(places)? => return Ok(solved),
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
    fn residual(&self, size: usize, places: &mut Places<f64>) -> Result<Vec<f64>, Exit<f64>> {
        let residual = self.residual.run(places)?;
        unfit(vector(&residual, size))
    }

    /// The whole trial.
    fn whole(&self, trial: Value<f64>, places: &mut Places<f64>) -> Result<Value<f64>, Exit<f64>> {
        let Some(rest) = &self.rest else {
            return Ok(trial);
        };
        *unfit(places.get_mut(rest.part))? = trial;
        for code in &rest.code {
            code.run(places)?;
        }
        Ok(unfit(places.get(self.trial))?.clone())
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
        if self.rest.is_none() {
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

    fn is_convex(&self, places: &mut Places<f64>) -> Result<bool, Exit<f64>> {
        match &self.convex {
            Some(code) => Ok(matches!(code.run(places)?, Value::Bool(true))),
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
        if let (Some(rest), Value::List(list)) = (&self.rest, &trial) {
            let rotation = |value: &Value<Rounded>| match value {
                Value::Motion(g) => Value::Rotation(g.rotation),
                other => other.clone(),
            };
            let mut known = given.clone();
            known.push(Value::List(list.iter().map(rotation).collect()));
            trial = unfit(run(&rest.rounded_at, known))?;
        }
        given.push(trial);
        let residual = unfit(run(&self.rounded_at, given))?;
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
            let all = [parameters, step, given, momenta];
            let mut all: Vec<Value<f64>> = all.map(Value::clone).to_vec();
            all.push(Value::List(trial.clone()));
            let found = run(&self.residual_at, all);
            let found = found.and_then(|v| vector(&v, size));
            found.unwrap_or_else(|| vec![f64::NAN; size])
        };
        let tangent = |trial: &Element| {
            let all = [parameters, step, given];
            let mut all: Vec<Value<f64>> = all.map(Value::clone).to_vec();
            all.push(Value::List(trial.clone()));
            let found = run(&self.tangent_at, all);
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
