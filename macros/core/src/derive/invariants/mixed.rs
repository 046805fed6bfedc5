//! Motions that mix the components of fields: each component moves in proportion to another. Rotations of space
//! stated by coordinates, rotations about any axis and other linear maps are combinations of these. Takes the fields;
//! gives such motions and their momenta.

use super::motions::{Motion, Sort, Way, in_space};
use super::{Inputs, length};
use crate::expr::shape::{Dim, Shape};
use crate::expr::{self, Expr};

/// The largest number of components of all fields that are moved in proportion to each other.
const MIXED: usize = 6;

/// A component of a field, counted from 0; a scalar has a single one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Component {
    pub(super) configuration: usize,
    pub(super) entry: u8,
}

/// Every component of a field in proportion to every other, if there are few. On a chain, both components belong to
/// one site, and the motion is the same at all sites.
pub(super) fn motions(x: &Inputs) -> Vec<Motion> {
    let components = components(x);
    let copy = |c: &Component| x.spec.configurations[c.configuration].copy;
    let is_first = |c: &&Component| copy(c).is_none_or(|own| own.family == c.configuration);
    let stated = components.iter().filter(is_first).count();
    if !(2..=MIXED).contains(&stated) {
        return Vec::new();
    }
    let number = |c: &Component| {
        x.spec.configurations[c.configuration]
            .group
            .shape()
            .is_scalar()
    };
    // Rotations then have the usual form, x p_y - y p_x.
    let pairs = components
        .iter()
        .flat_map(|by| components.iter().map(move |to| (by, to)));
    let of_pair = |(by, to): (&Component, &Component)| {
        let place = by.of(&by.field(x));
        let momentum = to.of(&in_space(x, to.configuration));
        Motion {
            configuration: to.configuration,
            way: Way::Mixing {
                entry: to.entry,
                by: *by,
            },
            sort: Sort::Mixed,
            scale: expr::mul(length(x, &place), length(x, &momentum)),
            value: expr::mul(place, momentum),
            scales: None,
            spanned: false,
        }
    };
    // The angular momenta of vectors contain their common rotations; other mixtures mostly describe the centre of
    // mass, which moves along the total momentum.
    let told = |(by, to): &(&Component, &Component)| {
        let at_one_site = copy(by).map(|c| c.site) == copy(to).map(|c| c.site);
        at_one_site && (by.configuration == to.configuration || number(by) || number(to))
    };
    pairs.filter(told).map(of_pair).collect()
}

/// The components of all scalar and vector fields.
fn components(x: &Inputs) -> Vec<Component> {
    let list = x.spec.configurations.iter().enumerate();
    let single = |shape: Shape| shape.is_vector() || shape.is_scalar();
    let fields = list.filter(|(_, c)| c.group.is_additive() && single(c.group.shape()));
    let all = fields.flat_map(|(configuration, c)| {
        let count = match c.group.shape().rows {
            Dim::Fixed(n) => u8::try_from(n).unwrap_or(0),
            Dim::Named(_) => 0,
        };
        (0..count).map(move |entry| Component {
            configuration,
            entry,
        })
    });
    all.collect()
}

impl Component {
    /// Its field at the node.
    pub(super) fn field(self, x: &Inputs) -> Expr {
        let c = &x.spec.configurations[self.configuration];
        expr::here(&x.letters.symbols, c.element)
    }

    /// Its value, computed from the field's value.
    pub(super) fn of(self, field: &Expr) -> Expr {
        let shape = field.shape();
        match shape.is_scalar() {
            true => field.clone(),
            false => expr::dot(field.clone(), expr::unit(shape.rows, self.entry)),
        }
    }
}
