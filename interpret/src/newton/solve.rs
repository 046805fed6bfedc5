//! The equations of a step as operations, and the loop that solves them: the calls that emitted code makes,
//! in the same order.

use super::bound::{Bound, VARIABLES};
use super::element::{self, Element};
use super::node::Asked;
use super::over;
use super::region::Regions;
use super::search::{self, Sought};
use crate::code::{Code, Exit, Iterate, Places, Routine, unfit};
use crate::failure::Failure;
use crate::value::Value;
use clebsch::Real;
use clebsch::emitted::{StepCause, StepError};
use clebsch::solvers::newton::{
    self, Anchor, Enclosure, Fold, Newton, NewtonError, Progress, Solved, Verdict, trace,
};
use nalgebra::{SMatrix, SVector};

/// A function over numbers in bounds.
pub type Bounded = Routine<Bound>;

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
    /// What the tangent asks of it.
    pub values: Code<f64>,
    /// Where the trial stands.
    pub trial: usize,
    /// The parameters, the step, what the residual asks of the node and its momenta.
    pub known: [Code<f64>; 4],
    /// What both need of the trial.
    pub at_trial: Vec<Code<f64>>,
    /// The residual.
    pub residual: Code<f64>,
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
    pub rounded_at: Bounded,
    /// The tangent by itself: of parameters, step, what is asked of the node, trial.
    pub tangent_at: Routine<f64>,
    /// The same over numbers in bounds.
    pub bounded_at: Bounded,
}

impl Iterate<f64> for Solve {
    fn run(&self, places: &mut Places<f64>) -> Result<Value<f64>, Exit<f64>> {
        let node = unfit(self.node.run(places)?.count())?;
        let values = self.values.run(places)?;
        // Lent for as long as it is at work.
        let place = unfit(self.search.place_mut(places))?;
        let mut held = match std::mem::replace(place, Value::Unit) {
            Value::Search(held) => held,
            _ => return unfit(None),
        };
        let solved = held.0.solve(self, node as u64, &values, places);
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

type At<'a, V, const D: usize> = Newton<'a, f64, Element<D>, V, D>;
type Found<const D: usize> = Result<Solved<Element<D>>, Exit<f64>>;

/// Iterates to the solution.
pub fn by<V: Asked + 'static, const D: usize>(
    iteration: &mut At<'_, V, D>,
    with: &Solve,
    sought: &'static Sought,
    places: &mut Places<f64>,
) -> Found<D> {
    loop {
        let trial = iteration.trial();
        *unfit(places.get_mut(with.trial))? = trial.value();
        if iteration.wants_scale() {
            let rounding = with.rounding::<D>(&trial, places)?;
            iteration.set_scale(|_| rounding);
        }
        for code in &with.at_trial {
            code.run(places)?;
        }
        let residual = with.residual.run(places)?;
        if iteration.assess(unfit(element::vector(&residual))?) {
            let tangent = with.tangent.run(places)?;
            let tangent: SMatrix<f64, D, D> = unfit(element::matrix(&tangent))?;
            match &with.unit {
                Some(unit) => match unit.run(places)? {
                    Value::Real(h) => iteration.set_tangent_times(&tangent, h),
                    _ => return unfit(None),
                },
                None => iteration.set_tangent(&tangent),
            }
        }
        let progress = match with.from_left {
            true => iteration.correct_from_left(),
            false => iteration.correct(),
        };
        match progress {
            Progress::Continue => {}
            Progress::Solved(solved)
                if with.is_convex(places)? || iteration.is_principal(&solved.element) =>
            {
                return Ok(solved);
            }
            ended => {
                if let Some(solved) = with.settle(iteration, ended, sought, places)? {
                    return Ok(solved);
                }
            }
        }
    }
}

impl Solve {
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
    fn rounding<const D: usize>(
        &self,
        trial: &Element<D>,
        places: &mut Places<f64>,
    ) -> Result<SVector<f64, D>, Exit<f64>> {
        let known = self.known(places)?;
        let exactly = &mut Bound::exactly;
        let mut given = Vec::with_capacity(self.rounded_at.places);
        for value in &known {
            given.push(unfit(over(value, exactly))?);
        }
        given.push(unfit(over(&trial.value(), &mut Bound::rounded))?);
        let residual = unfit(run(&self.rounded_at, given))?;
        let rest = unfit(over(&residual, &mut |x: Bound| x.0.rest()))?;
        unfit(element::vector(&rest))
    }

    /// The solution to be taken where the one found is not known to be principal, or none was found.
    /// None where the iteration begins again, at the principal root.
    #[cold]
    fn settle<V: Asked + 'static, const D: usize>(
        &self,
        iteration: &mut At<'_, V, D>,
        ended: Progress<Element<D>>,
        sought: &'static Sought,
        places: &mut Places<f64>,
    ) -> Result<Option<Solved<Element<D>>>, Exit<f64>> {
        let failed = match ended {
            Progress::Continue => return Ok(None),
            Progress::Solved(solved) => Ok(solved),
            Progress::Failed(e) => Err(e),
        };
        let asked = failed.as_ref().ok().map(|solved| solved.element);
        let values = iteration.values();
        let known = self.known(places)?;
        let certificate = iteration.certificate();
        let traced = self.principal(&known, &values, certificate, asked.as_ref());
        let e = match (traced, failed) {
            (Ok(None), Ok(solved)) => return Ok(Some(solved)),
            (Ok(Some(root)), _) if iteration.restart(root) => return Ok(None),
            (Ok(_), Err(e)) => e,
            (Ok(_), Ok(_)) => iteration.unpolished(),
            (Err(fold), failed) => {
                if let (Some((at, tries, look)), Ok(solved)) = (&self.settled.contact, &failed) {
                    *unfit(places.get_mut(*at))? = search::told(solved);
                    *unfit(places.get_mut(*tries))? = Value::Bool(iteration.tries());
                    if let Value::Failed(e) = look.run(places)? {
                        return Err(Exit::Return(Box::new(Value::Failed(e))));
                    }
                }
                iteration.folded(fold, failed.err())
            }
        };
        let e = self.refused::<V, D>(e, sought, places)?;
        Err(Failure::from(StepCause::from(e)).into())
    }

    /// Finds the principal root, or shows that the solution is.
    fn principal<V: Asked, const D: usize>(
        &self,
        known: &[Value<f64>; 4],
        values: &V,
        certificate: &mut newton::Certificate<V, D>,
        solution: Option<&Element<D>>,
    ) -> Result<Option<Anchor<Element<D>, D>>, Fold> {
        let [parameters, step, given, momenta] = known;
        let exactly = &mut Bound::exactly;
        let bounds = (over(parameters, exactly), over(step, exactly));
        let near = V::given::<f64>(&values.over(&mut |x: f64| x));
        let residual = |trial: &Element<D>| {
            let all = [parameters, step, given, momenta];
            let mut all: Vec<Value<f64>> = all.map(Value::clone).to_vec();
            all.push(trial.value());
            let found = run(&self.residual_at, all);
            found
                .and_then(|v| element::vector(&v))
                .unwrap_or_else(|| SMatrix::repeat(f64::NAN))
        };
        let tangent = |trial: &Element<D>| {
            let mut all: Vec<Value<f64>> = [parameters, step].map(Value::clone).to_vec();
            all.extend([near.clone(), trial.value()]);
            let found = run(&self.tangent_at, all);
            found
                .and_then(|v| element::matrix(&v))
                .unwrap_or_else(|| SMatrix::repeat(f64::NAN))
        };
        let unknown = || SMatrix::repeat(Enclosure::around(f64::NAN, f64::NAN));
        let enclosed = |spread: newton::Spread, trial: &Regions<D>| {
            let (Some(parameters), Some(step)) = &bounds else {
                return unknown();
            };
            let values = V::given(&values.enclosed::<VARIABLES>(0, spread));
            let Some(values) = over(&values, &mut Bound) else {
                return unknown();
            };
            let all = vec![parameters.clone(), step.clone(), values, trial.value()];
            let found = run(&self.bounded_at, all);
            let found = found.and_then(|v| element::matrix::<Bound, D>(&v));
            found.map_or_else(unknown, |m| m.map(|x| x.0))
        };
        let equations = newton::Equations {
            residual: &residual,
            tangent: &tangent,
            enclosed: &enclosed,
        };
        let first = solution
            .copied()
            .unwrap_or_else(clebsch::groups::Group::<f64>::identity);
        let mut verdict = Verdict::<Element<D>, D>::about(first);
        let care = certificate.care();
        if let Some(root) = verdict.add(trace(&equations, solution, care)?) {
            *verdict.root_mut() = root;
        }
        Ok(verdict.close(certificate, values))
    }

    /// Says which equation is worst, and which step could be solved.
    #[cold]
    fn refused<V: Asked + 'static, const D: usize>(
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
        let other =
            |h: f64, other: newton::Search<f64, Element<D>, V, D>| -> Result<(), StepError> {
                let given = vec![Value::Real(h), search::held(other, sought)];
                let untold = |what| Err(StepCause::Unread { what }.at_node(0));
                match self.settled.other.call(given, &mut places.borrow_mut()) {
                    Ok(Value::Failed(e)) => Err(e.step(0)),
                    Ok(_) => Ok(()),
                    Err(Exit::Return(_)) => untold("step"),
                    Err(Exit::Unfit(what)) => untold(what),
                }
            };
        Ok(e.explained(h, self.settled.configurations, other))
    }
}
