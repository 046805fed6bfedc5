//! The state that measures term sizes, if impulses act at nodes. Takes the routines of the model; gives numbers.

use super::{LineTrajectory, columns, coordinates, numbers};
use crate::code::Routine;
use crate::opened::at;
use crate::running::{put, run};
use crate::value::Value;

impl LineTrajectory {
    fn ask(&mut self, routine: &Routine<f64>) -> Option<Value<f64>> {
        run(routine, &mut self.places).ok()
    }

    /// The kinetic and the potential energy at the node.
    pub fn energies(&mut self) -> Option<[f64; 2]> {
        let model = self.model.clone();
        self.two(model.energies.as_ref()?)
    }

    /// Calls `of` with the state that measures sizes. If impulses cancel in a momentum, the momentum counts with their
    /// size.
    pub fn measured<R>(&mut self, of: impl FnOnce(&mut Self) -> R) -> R {
        let model = self.model.clone();
        let enlarged = model.enlarged.as_ref().and_then(|e| self.ask(e));
        let Some(enlarged) = enlarged else {
            return of(self);
        };
        let state = self
            .places
            .get_mut(at::STATE)
            .map(|s| std::mem::replace(s, enlarged));
        let found = of(self);
        if let Some(state) = state {
            put(&mut self.places, at::STATE, state);
        }
        found
    }

    /// The sums of the sizes of their terms.
    pub fn energy_sizes(&mut self) -> Option<[f64; 2]> {
        let model = self.model.clone();
        self.two(model.energy_sizes.as_ref()?)
            .map(|[kinetic, potential]| [kinetic.abs(), potential.abs()])
    }

    fn two(&mut self, routine: &Routine<f64>) -> Option<[f64; 2]> {
        match self.ask(routine)? {
            Value::List(both) => match both.as_slice() {
                [Value::Real(kinetic), Value::Real(potential)] => Some([*kinetic, *potential]),
                _ => None,
            },
            _ => None,
        }
    }

    /// A conserved total by its name.
    pub fn total(&mut self, name: &str) -> Option<Vec<f64>> {
        let model = self.model.clone();
        let (_, routine) = model.totals.iter().find(|(own, _)| own == name)?;
        numbers(&self.ask(routine)?)
    }

    /// A scale for each component of a conserved total: the norm of its sums of term sizes. All components get the same
    /// scale, because the terms of a single component may be rounding errors only.
    pub fn total_sizes(&mut self, name: &str) -> Option<Vec<f64>> {
        let model = self.model.clone();
        let (_, routine) = model.total_sizes.iter().find(|(own, _)| own == name)?;
        let all = numbers(&self.ask(routine)?)?;
        let length = all.iter().fold(0.0, |length, x| x.hypot(length));
        Some(vec![length; all.len()])
    }

    /// An observable at all sites, one site after the other, matrices in row-major order.
    pub fn observe(&mut self, name: &str) -> Option<Vec<f64>> {
        let model = self.model.clone();
        for c in &model.coordinates {
            if let Some(told) = coordinates::user_coordinates(c, name, |own| self.seen(own)) {
                return Some(told);
            }
        }
        self.seen(name)
    }

    /// An observable as the program stores it.
    fn seen(&mut self, name: &str) -> Option<Vec<f64>> {
        let model = self.model.clone();
        let values = format!("values_{name}");
        let own = model.observers.iter().find(|(own, _)| own == name);
        let (_, routine) =
            own.or_else(|| model.functionals.iter().find(|(own, _)| *own == values))?;
        let value = self.ask(routine)?;
        // A quantity of the whole chain is a single value.
        columns(&value).or_else(|| numbers(&value))
    }
}
