//! Named cases of a model: parameters, initial values, step size, number of steps, and bounds on the drift of
//! invariants, in the order of the model's card.

use clebsch::card::Card;
pub use clebsch_core::document::{Citations, Place, Work};

/// A case of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Its name.
    pub name: String,
    /// Its purpose and its source.
    pub doc: String,
    /// Step size.
    pub h: f64,
    /// Number of steps.
    pub steps: u64,
    /// Values of the parameters, row by row, in the order of the card.
    pub parameters: Vec<Vec<f64>>,
    /// Initial values, row by row, in the order of the card.
    pub initial: Vec<Vec<f64>>,
    /// Bound on the drift of each invariant, relative to its natural scale.
    pub bounds: Vec<(String, f64)>,
}

/// A gallery model with its citations and cases; the first case is the default.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The model as data.
    pub card: Card,
    /// The citations for its equations.
    pub citations: Citations,
    /// Its cases.
    pub cases: Vec<Case>,
}

impl Entry {
    /// The cards of the model, one for each size, with the default size first; a single card if the model does not
    /// have named sizes.
    pub fn cards(&self) -> Vec<Card> {
        let mut all: Vec<Vec<usize>> = vec![Vec::new()];
        for d in self.card.dimensions {
            let longer = |sizes: &Vec<usize>| {
                let values = d.from..=d.to;
                let list = values.map(|n| sizes.iter().copied().chain([n]).collect());
                list.collect::<Vec<Vec<usize>>>()
            };
            all = all.iter().flat_map(longer).collect();
        }
        let own: Vec<usize> = self.card.dimensions.iter().map(|d| d.value).collect();
        let others = all.iter().filter(|sizes| **sizes != own);
        let others = others.filter_map(|sizes| (self.card.sized)(sizes));
        [self.card].into_iter().chain(others).collect()
    }

    /// The card whose fields have as many values as the case, or the default card if none does.
    pub fn card_of(&self, case: &Case) -> Card {
        let fits = |fields: &[clebsch::card::Field], values: &[Vec<f64>]| {
            fields.len() == values.len()
                && fields.iter().zip(values).all(|(f, v)| f.count() == v.len())
        };
        let mut cards = self.cards().into_iter();
        cards
            .find(|c| fits(c.parameters, &case.parameters) && fits(c.initial, &case.initial))
            .unwrap_or(self.card)
    }
}

/// The diagonal of the Poinsot matrix `J = tr(I)/2 - I`, from principal moments of inertia.
pub fn poinsot(moments: [f64; 3]) -> [f64; 3] {
    let half = moments.iter().sum::<f64>() / 2.0;
    moments.map(|i| half - i)
}

/// A diagonal matrix, row by row.
pub fn diagonal(d: [f64; 3]) -> Vec<f64> {
    vec![d[0], 0.0, 0.0, 0.0, d[1], 0.0, 0.0, 0.0, d[2]]
}

/// The identity, row by row.
pub fn identity() -> Vec<f64> {
    diagonal([1.0; 3])
}

/// The rotation matrix of a quaternion `(w, x, y, z)` of any nonzero norm, row by row.
pub fn rotation([w, x, y, z]: [f64; 4]) -> Vec<f64> {
    let s = 2.0 / (w * w + x * x + y * y + z * z);
    vec![
        1.0 - s * (y * y + z * z),
        s * (x * y - w * z),
        s * (x * z + w * y),
        s * (x * y + w * z),
        1.0 - s * (x * x + z * z),
        s * (y * z - w * x),
        s * (x * z - w * y),
        s * (y * z + w * x),
        1.0 - s * (x * x + y * y),
    ]
}

/// The vector `R v`, for a 3 x 3 matrix given row by row.
pub fn turned(r: &[f64], v: [f64; 3]) -> Vec<f64> {
    r.chunks(3)
        .map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum())
        .collect()
}

/// The matrix `R diag(d) Rᵀ`, row by row, exactly symmetric.
pub fn carried(r: &[f64], d: [f64; 3]) -> Vec<f64> {
    let rows: Vec<&[f64]> = r.chunks(3).collect();
    let entry = |a: &[f64], b: &[f64]| -> f64 {
        let products = a.iter().zip(b).zip(d);
        products.map(|((x, y), j)| (x * y) * j).sum()
    };
    rows.iter()
        .flat_map(|a| rows.iter().map(move |b| entry(a, b)))
        .collect()
}

/// The bounds of a case, from names of invariants and their maximum drifts.
pub fn bounds(drifts: &[(&str, f64)]) -> Vec<(String, f64)> {
    drifts
        .iter()
        .map(|(name, drift)| ((*name).to_owned(), *drift))
        .collect()
}
