//! What does not move: configurations that are given at an end, their velocities, and what follows them.

use super::definitions::inlined;
use super::{Writer, velocity_of};
use crate::lattice::declared::Kind as Role;
use crate::lattice::names::copy_name;
use crate::lattice::put::{Still, any_name};
use crate::syntax::ast::{Expression, Kind, Model, Statement};

impl Writer<'_> {
    /// Finds what does not move.
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
                self.pinned.insert(own, Still::Given);
                if let Some(velocity) = velocity_of(model, &name.text) {
                    let own = copy_name(&velocity.text, site);
                    self.pinned.insert(own, Still::Identity);
                }
            }
        }
        // What follows a configuration that is given stands still with it.
        for q in self.lattice.quantities.iter() {
            if q.kind != Role::Advected || self.pinned.is_empty() {
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
            for site in 0..self.choice.sites_of(self.lattice, q) {
                let at = isize::try_from(site).unwrap_or(isize::MAX);
                let own = copy_name(&q.name.text, site);
                let Ok(put) = self.put(at).put(&update) else {
                    continue;
                };
                let others =
                    |n: &str| n != own && self.put(at).is_moving(&name_expression(n, &put));
                if any_name(&put, &others) {
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
                    Some(value) => match self.put(at).put(&inlined(value, self.lets)) {
                        Ok(defined) => Still::Defined(defined),
                        Err(d) => return self.errors.push(*d),
                    },
                    None => {
                        self.out.given.push(own.clone());
                        Still::Given
                    }
                };
                self.pinned.insert(own, still);
            }
        }
    }
}

fn name_expression(n: &str, like: &Expression) -> Expression {
    Expression {
        kind: Kind::Name(n.to_owned()),
        place: like.place,
    }
}
