//! Held constraints at the sites that they have: one with a multiplier of its own at each.

use super::definitions::inlined;
use super::{StatedHold, Writer};
use crate::diagnostic::Place;
use crate::lattice::names::{Copied, copy};
use crate::lattice::range::reach;
use crate::syntax::ast::{Expression, Kind, Name, Statement};

impl Writer<'_> {
    pub(super) fn holds(
        &mut self,
        name: &Name,
        left: &Expression,
        right: &Expression,
        place: Place,
        docs: &[String],
    ) {
        let (left, right) = (inlined(left, self.lets), inlined(right, self.lets));
        let whole = Expression {
            kind: Kind::Sum(vec![(false, left.clone()), (true, right.clone())]),
            place,
        };
        let found = match reach(self.lattice, &whole) {
            Ok(found) => found,
            Err(d) => return self.errors.push(d),
        };
        let range = found.range(self.lattice, self.choice);
        let Some(range) = range else {
            let name = name.clone();
            let stated = Statement::Hold {
                name,
                left,
                right,
                place,
            };
            return self.push(stated, docs);
        };
        self.out.holds.push(StatedHold {
            name: name.text.clone(),
            range,
            letters: found.letters,
        });
        for site in range.indices(self.choice.count(range.label)) {
            let both = self
                .put(site)
                .put(&left)
                .and_then(|l| Ok((l, self.put(site).put(&right)?)));
            let (left, right) = match both {
                Ok(both) => both,
                Err(d) => return self.errors.push(*d),
            };
            // What stands still at both ends of a segment needs no multiplier.
            let moving = [&left, &right].iter().any(|e| self.put(site).is_moving(e));
            let Ok(site) = usize::try_from(site) else {
                continue;
            };
            if !moving {
                continue;
            }
            let own = copy(name, site);
            self.out.copies.push(Copied {
                name: own.text.clone(),
                of: name.text.clone(),
                site,
            });
            let stated = Statement::Hold {
                name: own,
                left,
                right,
                place,
            };
            self.push(stated, docs);
        }
    }
}
