//! The data that a case adds to a statement: numbers of parameters, the positions of numbers in a state, the numbers of
//! sites, and the end conditions.

use crate::stated::{Sites, Stated};
use std::collections::HashMap;
use std::sync::Arc;

/// The position of the numbers of a quantity, and their shape.
#[derive(Clone, Copy, Debug)]
pub struct Numbers {
    /// The first of them.
    pub from: usize,
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub cols: usize,
}

impl Numbers {
    /// The numbers themselves.
    #[must_use]
    pub fn of<'n>(&self, all: &'n [f64]) -> &'n [f64] {
        all.get(self.from..self.from + self.rows * self.cols)
            .unwrap_or_default()
    }
}

/// The name of a field, with its rows and columns.
pub type Field<'a> = (&'a str, usize, usize);

/// The data of a case.
#[derive(Clone, Debug, Default)]
pub struct Setup {
    /// The step size.
    pub h: f64,
    /// The count of each label, in the order of the statement.
    pub counts: Vec<usize>,
    /// Whether the chain is a ring.
    pub periodic: bool,
    /// The end conditions at the first and at the last site.
    pub ends: [usize; 2],
    data: Arc<Data>,
}

/// The numbers of the parameters, and where each quantity has its numbers. They do not depend on the step size.
#[derive(Debug, Default)]
struct Data {
    parameters: HashMap<String, Numbers>,
    given: Vec<f64>,
    observables: HashMap<String, Numbers>,
}

impl Setup {
    /// The data for steps of size `h`, from parameters and from the observables of a state, in row-major order.
    pub fn new<'a>(
        h: f64,
        parameters: impl Iterator<Item = (Field<'a>, &'a [f64])>,
        observables: impl Iterator<Item = Field<'a>>,
    ) -> Self {
        let mut out = Data::default();
        for ((name, rows, cols), numbers) in parameters {
            let from = out.given.len();
            out.given.extend(numbers);
            out.given.resize(from + rows * cols, f64::NAN);
            out.parameters
                .insert(name.to_owned(), Numbers { from, rows, cols });
        }
        let mut from = 0;
        for (name, rows, cols) in observables {
            out.observables
                .insert(name.to_owned(), Numbers { from, rows, cols });
            from += rows * cols;
        }
        Self {
            h,
            data: Arc::new(out),
            ..Self::default()
        }
    }

    /// This setup with steps of size `h`.
    #[must_use]
    pub fn with_step(self, h: f64) -> Self {
        Self { h, ..self }
    }

    /// How many sites of this kind a label has.
    #[must_use]
    pub fn sites(&self, stated: &Stated, label: usize, sites: Sites) -> usize {
        let open = stated.line == Some(label) && !self.periodic;
        let count = self.counts.get(label).copied().unwrap_or(0);
        count + usize::from(open && sites == Sites::Nodes)
    }

    /// The position of the numbers of a quantity in a state, if the quantity moves.
    #[must_use]
    pub fn observed(&self, name: &str, site: Option<usize>) -> Option<&Numbers> {
        match site {
            None => self.data.observables.get(name),
            Some(site) => self.data.observables.get(&format!("{name}_{site}")),
        }
    }

    /// The position of a momentum in a state: under `base` with the name of its configuration, or under `base` alone.
    #[must_use]
    pub fn momentum(&self, base: &str, name: &str, site: Option<usize>) -> Option<&Numbers> {
        let own = self.observed(&format!("{base}_{name}"), site);
        own.or_else(|| self.data.observables.get(base))
    }

    /// The numbers of a parameter.
    #[must_use]
    pub fn parameter(&self, name: &str, site: Option<usize>) -> Option<(&Numbers, &[f64])> {
        let own = match site {
            None => self.data.parameters.get(name),
            Some(site) => self.data.parameters.get(&format!("{name}_{site}")),
        }?;
        Some((own, own.of(&self.data.given)))
    }
}
