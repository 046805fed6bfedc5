//! The gradient of a cost of a run, from its last step to its first. States are stored at about the square root of the number of
//! steps; the run between two of them is repeated when its derivatives are needed.

use super::functions::by_parameter;
use super::linear::Linear;
use super::trajectory::{Differentiated, Taken, by_recording};
use super::values::{count, numbers};
use clebsch::card::{Field, Kind};
use clebsch::derivatives::{Cost, Derivatives, Gradient, NoDerivative, Point, Seen};

/// Sums of derivatives while the run is read backwards.
struct Sums {
    /// With respect to the numbers of the model.
    model: Vec<f64>,
    /// With respect to the step size.
    step: f64,
    /// With respect to the numbers of the state at the current node.
    state: Vec<f64>,
}

impl Sums {
    /// Adds derivatives with respect to all inputs of a function: the model, a step size that is this share of the whole one, and
    /// the changing inputs. Returns the changing inputs.
    fn add<'a>(&mut self, pulled: &'a [f64], share: f64) -> &'a [f64] {
        let (model, others) = pulled.split_at(self.model.len().min(pulled.len()));
        for (sum, x) in self.model.iter_mut().zip(model) {
            *sum += x;
        }
        let Some((step, late)) = others.split_first() else {
            return &[];
        };
        self.step += share * step;
        late
    }

    /// Adds derivatives with respect to the state.
    fn add_state(&mut self, late: &[f64]) {
        for (sum, x) in self.state.iter_mut().zip(late) {
            *sum += x;
        }
    }
}

impl Differentiated {
    /// The gradient of a cost.
    pub fn pulled_back(
        &mut self,
        steps: u64,
        cost: &mut dyn Cost,
    ) -> Result<Gradient, NoDerivative> {
        let stride = steps.isqrt().max(1);
        let mut state = self.started.state.clone();
        let mut stored = vec![state.clone()];
        for node in 1..=steps {
            self.advance(&mut state, None)?;
            if node % stride == 0 && node < steps {
                stored.push(state.clone());
            }
        }
        let mut sums = Sums {
            model: vec![0.0; count(&self.started.begun.model)],
            step: 0.0,
            state: vec![0.0; state.numbers.len()],
        };
        self.weighed(&state, cost, &mut sums)?;
        let mut last = steps;
        while let Some(first) = stored.pop() {
            let node = first.node;
            let mut state = first;
            let mut run = Vec::new();
            for _ in node..last {
                let mut taken = Vec::with_capacity(self.stages.len());
                self.advance(&mut state, Some(&mut taken))?;
                run.push(taken);
            }
            while let Some(taken) = run.pop() {
                self.back(&taken, &mut sums)?;
                if let Some(Taken { before, .. }) = taken.first() {
                    self.weighed(before, cost, &mut sums)?;
                }
            }
            last = node;
        }
        self.at_start(&sums)
    }

    /// Moves the derivatives from the end of a step to its start.
    fn back(&mut self, taken: &[Taken], sums: &mut Sums) -> Result<(), NoDerivative> {
        for (stage, taken) in taken.iter().enumerate().rev() {
            let weights = std::mem::take(&mut sums.state);
            let pulled = self.at_step(stage, taken, &|linear, late| linear.pull(late, &weights))?;
            let share = self.started.factors.get(stage).copied().unwrap_or(1.0);
            let late = sums.add(&pulled, share);
            sums.state = late.get(..weights.len()).unwrap_or_default().to_vec();
        }
        Ok(())
    }

    /// Adds the derivatives of the cost at a node.
    fn weighed(
        &mut self,
        at: &Point,
        cost: &mut dyn Cost,
        sums: &mut Sums,
    ) -> Result<(), NoDerivative> {
        if !cost.is_at(at.node) {
            return Ok(());
        }
        let observables = self.at_observables(at, &|linear, late| linear.value(late))?;
        // Without a weight on invariants, a model whose invariants cannot be recorded has gradients, too.
        let invariants = self.at_invariants(at, &|linear, late| linear.value(late));
        let seen = Seen {
            observables: &observables,
            invariants: invariants.as_deref().unwrap_or_default(),
        };
        let mut weights = vec![0.0; observables.len()];
        let mut of_invariants = vec![0.0; self.card().invariant_count()];
        cost.weigh(at.node, &seen, &mut weights, &mut of_invariants);
        if weights.iter().any(|x| *x != 0.0) {
            let pulled = self.at_observables(at, &|linear, late| linear.pull(late, &weights))?;
            let late = sums.add(&pulled, 1.0);
            sums.add_state(late);
        }
        if of_invariants.iter().any(|x| *x != 0.0) {
            let weights = of_invariants;
            let pulled = self.at_invariants(at, &|linear, late| linear.pull(late, &weights))?;
            let late = sums.add(&pulled, 1.0);
            sums.add_state(late);
        }
        Ok(())
    }

    /// Moves the derivatives from the initial state to the parameters and the initial values.
    fn at_start(&mut self, sums: &Sums) -> Result<Gradient, NoDerivative> {
        let started = &self.started;
        let mut given = Vec::new();
        let _ = numbers(&started.begun.parameters, &mut given);
        let of_parameters = given.len();
        let _ = numbers(&started.begun.initial, &mut given);
        let weights: Vec<f64> = sums.model.iter().chain(&sums.state).copied().collect();
        let record = || started.record_start();
        let pulled = by_recording(
            &mut Vec::new(),
            &given,
            record,
            &|linear: &mut Linear, late| linear.pull(late, &weights),
        );
        let pulled = pulled.ok_or(NoDerivative::Unrecorded {
            what: "the initial state",
        })?;
        let of_parameters = pulled.get(..of_parameters).unwrap_or_default();
        let parameters = by_parameter(started.source, of_parameters);
        let parameters = parameters.ok_or(NoDerivative::Unrecorded {
            what: "the parameters",
        })?;
        let fields = self.card().parameters.iter().zip(&parameters);
        let parameters = fields.map(|(field, own)| shared(field, own)).collect();
        let columns = self.columns_at_start()?;
        let along = |column: &Vec<f64>| column.iter().zip(&sums.state).map(|(x, w)| x * w).sum();
        let moved: Vec<f64> = columns.iter().map(along).collect();
        let mut rest = moved.as_slice();
        let initial = self.dimensions().into_iter().map(|count| {
            let (own, others) = rest.split_at(count.min(rest.len()));
            rest = others;
            own.to_vec()
        });
        let initial = initial.collect();
        Ok(Gradient {
            parameters,
            initial,
            step: sums.step,
        })
    }
}

/// Shares the derivatives of entries that must be equal or opposite.
fn shared(field: &Field, own: &[f64]) -> Vec<f64> {
    let cols = field.cols;
    let entry = |i: usize, j: usize| own.get(i * cols + j).copied().unwrap_or(f64::NAN);
    let of = |i: usize, j: usize| match field.kind {
        Kind::Symmetric | Kind::SecondMoments => 0.5 * (entry(i, j) + entry(j, i)),
        Kind::Skew => 0.5 * (entry(i, j) - entry(j, i)),
        Kind::Diagonal if i != j => 0.0,
        _ => entry(i, j),
    };
    (0..field.count()).map(|k| of(k / cols, k % cols)).collect()
}
