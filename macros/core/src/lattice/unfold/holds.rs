//! Expands constraints at sites: each site gets its own constraint and multiplier.

use super::definitions::inlined;
use super::{StatedHold, Writer};
use crate::diagnostic::Place;
use crate::lattice::declared::Sites;
use crate::lattice::names::{Copied, copy};
use crate::lattice::parts::has_sum;
use crate::lattice::range::{Range, reach};
use crate::lattice::substitution::any_name;
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
        if has_sum(&left) || has_sum(&right) {
            return self.total(name, (left, right), place, docs);
        }
        let whole = Expression {
            kind: Kind::Sum(vec![(false, left.clone()), (true, right.clone())]),
            place,
        };
        let found = match reach(self.lattice, &whole) {
            Ok(found) => found,
            Err(d) => return self.errors.push(d),
        };
        let by = self.first_counted(&whole, &found.letters);
        let range = found.range(self.lattice, self.choice);
        let Some(range) = range.map(|r| self.counted_from(r, by)) else {
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
            letters: found.letters.iter().map(|(s, o)| (*s, o - by)).collect(),
        });
        for site in range.indices(self.choice.count(range.label)) {
            let put = self.substitution(site - by);
            let both = put
                .substitute(&left)
                .and_then(|l| Ok((l, put.substitute(&right)?)));
            let (left, right) = match both {
                Ok(both) => both,
                Err(d) => return self.errors.push(*d),
            };
            // If neither side of the constraint moves, a multiplier is not needed.
            let moving = [&left, &right]
                .iter()
                .any(|e| self.substitution(site).is_moving(e));
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
    /// The offset of the first site of a constraint, if it is negative. The constraint is then indexed from that
    /// site, so that `x - prev(x, i)` is the constraint `next(x, i) - x`. Zero for fields with an offset around a
    /// ring, for which the two differ.
    pub(super) fn first_counted(&self, e: &Expression, letters: &[(Sites, isize)]) -> isize {
        let grows = |n: &str| self.lattice.find(n).is_some_and(|q| q.offset.is_some());
        let first = letters.iter().map(|(_, offset)| *offset).min();
        match first {
            Some(first) if first < 0 && !any_name(e, &grows) => first,
            _ => 0,
        }
    }

    /// Shifts a range by an offset; a range on a ring stays the same.
    pub(super) fn counted_from(&self, range: Range, by: isize) -> Range {
        match self.choice.periodic && self.lattice.line == Some(range.label) {
            true => range,
            false => Range {
                from: range.from + by,
                to: range.to + by,
                ..range
            },
        }
    }
}
