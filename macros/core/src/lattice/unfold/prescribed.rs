//! Finds quantities that do not move: configurations prescribed at an end, their velocities, and advected quantities
//! that depend only on these.

use super::definitions::inlined;
use super::{Writer, velocity_of};
use crate::check::are_same;
use crate::lattice::declared::Kind as Role;
use crate::lattice::names::copy_name;
use crate::lattice::parts::names;
use crate::lattice::substitution::{FixedCopy, any_name};
use crate::syntax::ast::{Expression, Kind, Model, Name, SizedName, Statement};
use std::collections::BTreeSet;

impl Writer<'_> {
    /// Finds the quantities that do not move.
    pub(super) fn pin(&mut self, model: &Model) {
        for (last, _, alternative) in self.ends() {
            for name in &alternative.given {
                let Some(q) = self.lattice.find(&name.text) else {
                    continue;
                };
                let count = self.choice.sites_of(self.lattice, q);
                let site = if last { count.saturating_sub(1) } else { 0 };
                let own = copy_name(&name.text, site);
                self.out.given.push(own.clone());
                self.pinned.insert(own, FixedCopy::Given);
                if let Some(velocity) = velocity_of(model, &name.text) {
                    let own = copy_name(&velocity.text, site);
                    self.pinned.insert(own, FixedCopy::Identity);
                }
            }
        }
        if !self.pinned.is_empty() {
            while self.followers(model) {}
        }
    }

    /// Finds advected quantities that follow prescribed ones. Returns whether it found new ones.
    fn followers(&mut self, model: &Model) -> bool {
        let before = self.pinned.len();
        for q in self.lattice.quantities.iter() {
            if q.kind != Role::Advected {
                continue;
            }
            let update = model.statements.iter().find_map(|s| match s {
                Statement::Constraint { name, value, .. } if name.text == q.name.text => {
                    Some(value)
                }
                _ => None,
            });
            let Some(update) = update.map(|u| inlined(u, self.lets)) else {
                continue;
            };
            // A quantity that advances by itself, such as a clock, does not follow another quantity.
            let follows = |n: &str| n != q.name.text && self.lattice.moving.contains(n);
            if !any_name(&update, &follows) {
                continue;
            }
            for site in 0..self.choice.sites_of(self.lattice, q) {
                let at = isize::try_from(site).unwrap_or(isize::MAX);
                let own = copy_name(&q.name.text, site);
                if self.pinned.contains_key(&own) || !self.stands_still(model, &own, &update, at) {
                    continue;
                }
                let definition = model.statements.iter().find_map(|s| match s {
                    Statement::Advected {
                        names,
                        definition: Some(value),
                        ..
                    } if names.iter().any(|n| n.text == q.name.text) => Some(value),
                    _ => None,
                });
                let still = match definition {
                    Some(value) => {
                        match self.substitution(at).substitute(&inlined(value, self.lets)) {
                            Ok(defined) => FixedCopy::Defined(defined),
                            Err(d) => {
                                self.errors.push(*d);
                                return false;
                            }
                        }
                    }
                    None => {
                        self.out.given.push(own.clone());
                        FixedCopy::Given
                    }
                };
                self.pinned.insert(own, still);
            }
        }
        self.pinned.len() > before
    }

    /// Whether the update of a copy leaves the copy unchanged: it contains no other moving quantity, and after
    /// substitution of prescribed values it equals the copy.
    fn stands_still(&self, model: &Model, own: &str, update: &Expression, at: isize) -> bool {
        let Ok(put) = self.substitution(at).substitute(update) else {
            return false;
        };
        let named = |n: &str| Expression {
            kind: Kind::Name(n.to_owned()),
            place: put.place,
        };
        let moves = |n: &str| n != own && self.substitution(at).is_moving(&named(n));
        if any_name(&put, &moves) {
            return false;
        }
        are_same(&self.of_parameters(model, &put), &put, &named(own))
    }

    /// A model in which every name of an expression of copies is declared, as a parameter.
    fn of_parameters(&self, model: &Model, put: &Expression) -> Model {
        let mut out = Model {
            statements: Vec::new(),
            remarks: Vec::new(),
            ..model.clone()
        };
        let mut declare = |statement| {
            out.statements.push(statement);
            out.remarks.push(Vec::new());
        };
        let parameter = |name: Name, shape: SizedName| Statement::Param {
            names: vec![name],
            shape,
            at: None,
        };
        for statement in &model.statements {
            match statement {
                Statement::Label {
                    step: Some(step), ..
                } => declare(parameter(step.clone(), SizedName::number(step.place))),
                Statement::Param { at: None, .. }
                | Statement::Time { .. }
                | Statement::Dim { .. }
                | Statement::Given { .. } => declare(statement.clone()),
                _ => {}
            }
        }
        let copies: BTreeSet<&str> = names(put).into_iter().collect();
        for copy in copies {
            if let Some(q) = self.lattice.of_copy(copy) {
                let name = Name {
                    text: copy.to_owned(),
                    place: q.name.place,
                    typeset: None,
                    is_copy: true,
                };
                declare(parameter(name, q.shape.clone()));
            }
        }
        out
    }
}
