//! A trajectory with its derivatives: steps, their tangents, and what is observed.

use super::linear::Linear;
use super::source::{Source, Stepping};
use super::start::Started;
use super::values::filled;
use crate::value::Value;
use clebsch::card::{Card, Settings};
use clebsch::derivatives::{Cost, Derivatives, Gradient, Jacobian, NoDerivative, Point};
use clebsch::{StartError, validate};

/// The most recordings of one function that are kept, one for each outcome of its decisions.
const MOST: usize = 32;

/// A substep: a step of the model with its own workspace.
pub struct Stage {
    h: f64,
    part: Box<dyn Stepping>,
    /// Recordings of the step with derivatives.
    steps: Vec<Linear>,
}

/// A step of the model as it was taken: the state before it, and the solutions of its equations if they are known.
pub struct Taken {
    pub before: Point,
    pub solutions: Option<Vec<f64>>,
}

/// A trajectory with its derivatives.
pub struct Differentiated {
    pub started: Started,
    pub stages: Vec<Stage>,
    /// The state that the workspaces of the substeps remember.
    remembered: Point,
    observed: Vec<Linear>,
    invariants: Vec<Linear>,
    pub charts: Vec<Linear>,
    pub conserved: Vec<Linear>,
}

/// A use of a recording at changing inputs.
type Use<'a, R> = &'a dyn Fn(&mut Linear, &[f64]) -> Option<R>;

/// Uses a recording of a function, or a new one if no known recording has the same decisions at these inputs. Returns
/// nothing if the function cannot be recorded.
pub fn by_recording<R>(
    known: &mut Vec<Linear>,
    late: &[f64],
    record: impl FnOnce() -> Option<Linear>,
    used: Use<'_, R>,
) -> Option<R> {
    for at in (0..known.len()).rev() {
        let linear = known.get_mut(at)?;
        if linear.late() == late.len()
            && let Some(value) = used(linear, late)
        {
            let newest = known.remove(at);
            known.push(newest);
            return Some(value);
        }
    }
    let mut linear = record()?;
    let own = linear.recorded().to_vec();
    let value = used(&mut linear, &own)?;
    if linear.serves_others {
        if known.len() == MOST {
            known.remove(0);
        }
        known.push(linear);
    }
    Some(value)
}

impl Differentiated {
    /// Starts a trajectory with derivatives.
    ///
    /// # Errors
    /// As opening a trajectory.
    pub fn open(
        source: &'static dyn Source,
        parameters: &[Vec<f64>],
        initial: &[Vec<f64>],
        settings: Settings,
    ) -> Result<Box<dyn Derivatives>, NoDerivative> {
        Ok(Box::new(Self::from(Started::new(
            source, parameters, initial, settings,
        )?)?))
    }

    fn from(started: Started) -> Result<Self, NoDerivative> {
        let parts = started.parts(&started.state)?.into_iter();
        let stages = parts.map(|(h, part)| Stage {
            h,
            part,
            steps: Vec::new(),
        });
        Ok(Differentiated {
            stages: stages.collect(),
            remembered: started.state.clone(),
            started,
            observed: Vec::new(),
            invariants: Vec::new(),
            charts: Vec::new(),
            conserved: Vec::new(),
        })
    }

    /// The state in the form that the functions of the model take.
    pub fn state(&self, at: &Point) -> Result<Value<f64>, NoDerivative> {
        let state = filled(&self.started.begun.state, &at.numbers);
        let mut state = state.ok_or(NoDerivative::Unrecorded { what: "the state" })?;
        self.started.source.set_node(&mut state, at.node);
        Ok(state)
    }

    /// Takes a step; appends its substeps to `taken`.
    pub fn advance(
        &mut self,
        state: &mut Point,
        mut taken: Option<&mut Vec<Taken>>,
    ) -> Result<(), NoDerivative> {
        let node = state.node;
        if *state != self.remembered {
            self.forget(state)?;
        }
        for stage in &mut self.stages {
            state.node = node;
            let before = taken.is_some().then(|| state.clone());
            let solutions = stage.part.advance(state)?;
            if let (Some(taken), Some(before)) = (&mut taken, before) {
                taken.push(Taken { before, solutions });
            }
        }
        state.node = node + 1;
        self.remembered.clone_from(state);
        Ok(())
    }

    /// Prepares new workspaces, because the next step does not continue the last one.
    fn forget(&mut self, state: &Point) -> Result<(), NoDerivative> {
        let parts = self.started.parts(state)?;
        for (stage, (_, part)) in self.stages.iter_mut().zip(parts) {
            stage.part = part;
        }
        Ok(())
    }

    /// Uses a recording of a substep with derivatives, at a step that was taken.
    pub fn at_step<R>(
        &mut self,
        stage: usize,
        taken: &Taken,
        used: Use<'_, R>,
    ) -> Result<R, NoDerivative> {
        let state = self.state(&taken.before)?;
        let started = &self.started;
        let what = "a step";
        let Some(Stage { h, steps, .. }) = self.stages.get_mut(stage) else {
            return Err(NoDerivative::Unrecorded { what });
        };
        let mut late = taken.before.numbers.clone();
        // Without solutions, no known recording has this number of inputs, unless the step solves no equations.
        if let Some(solutions) = &taken.solutions {
            late.extend_from_slice(solutions);
        }
        let record = || started.record_step(*h, &state);
        by_recording(steps, &late, record, used).ok_or(NoDerivative::Unrecorded { what })
    }

    /// Uses a recording of the observables.
    pub fn at_observables<R>(&mut self, at: &Point, used: Use<'_, R>) -> Result<R, NoDerivative> {
        let (state, started) = (self.state(at)?, &self.started);
        let record = || started.record_observables(&state);
        let found = by_recording(&mut self.observed, &at.numbers, record, used);
        found.ok_or(NoDerivative::Unrecorded {
            what: "the observables",
        })
    }

    /// Uses a recording of the invariants.
    pub fn at_invariants<R>(&mut self, at: &Point, used: Use<'_, R>) -> Result<R, NoDerivative> {
        let (state, started) = (self.state(at)?, &self.started);
        let record = || started.record_invariants(&state);
        let found = by_recording(&mut self.invariants, &at.numbers, record, used);
        found.ok_or(NoDerivative::Unrecorded {
            what: "the invariants",
        })
    }
}

impl Derivatives for Differentiated {
    fn card(&self) -> &'static Card {
        self.started.source.card()
    }

    fn h(&self) -> f64 {
        self.started.h
    }

    fn with_step(&self, h: f64) -> Result<Box<dyn Derivatives>, NoDerivative> {
        validate::directed_step(h).map_err(StartError::from)?;
        let started = Started {
            h,
            ..self.started.clone()
        };
        Ok(Box::new(Self::from(started)?))
    }

    fn start(&self) -> Point {
        self.started.state.clone()
    }

    fn dimensions(&self) -> Vec<usize> {
        self.started.coordinates.dimensions.clone()
    }

    fn observe(&mut self, at: &Point) -> Result<Vec<f64>, NoDerivative> {
        self.at_observables(at, &|linear, late| linear.value(late))
    }

    fn invariants(&mut self, at: &Point) -> Result<Vec<f64>, NoDerivative> {
        self.at_invariants(at, &|linear, late| linear.value(late))
    }

    fn moved(&mut self, at: &Point, by: &[f64]) -> Result<Point, NoDerivative> {
        self.moved_by(at, by)
    }

    fn difference(&mut self, from: &Point, to: &Point) -> Result<Vec<f64>, NoDerivative> {
        self.coordinates_between(from, to)
    }

    fn step(&mut self, at: &Point) -> Result<Point, NoDerivative> {
        let mut state = at.clone();
        self.advance(&mut state, None)?;
        Ok(state)
    }

    fn tangent(&mut self, at: &Point) -> Result<(Point, Jacobian), NoDerivative> {
        let mut state = at.clone();
        let mut columns = self.columns(&state)?;
        let mut taken = Vec::new();
        self.advance(&mut state, Some(&mut taken))?;
        for (stage, taken) in taken.iter().enumerate() {
            columns = self.at_step(stage, taken, &|linear, late| {
                linear.push_each(late, &columns)
            })?;
        }
        let tangent = self.in_coordinates(&state, &columns)?;
        Ok((state, tangent))
    }

    fn observed(&mut self, at: &Point) -> Result<Jacobian, NoDerivative> {
        let columns = self.columns(at)?;
        let pushed = self.at_observables(at, &|linear, late| linear.push_each(late, &columns))?;
        Ok(Jacobian {
            rows: self.card().observable_count(),
            cols: pushed.len(),
            entries: pushed.concat(),
        })
    }

    fn conserved(&mut self, at: &Point) -> Result<Jacobian, NoDerivative> {
        self.slopes_of_invariants(at)
    }

    fn curvature(&mut self, at: &Point, weights: &[f64]) -> Result<Jacobian, NoDerivative> {
        self.curvature_of_invariants(at, weights)
    }

    fn gradient(&mut self, steps: u64, cost: &mut dyn Cost) -> Result<Gradient, NoDerivative> {
        self.pulled_back(steps, cost)
    }
}
