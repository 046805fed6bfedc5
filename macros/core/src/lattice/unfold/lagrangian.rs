//! The Lagrangian as a sum over the existing sites, with the terms of the end conditions.

use super::definitions::inlined;
use super::warnings::one_neighbour;
use super::{LARGEST, Summand, Writer};
use crate::diagnostic::Diagnostic;
use crate::lattice::names::copy_name;
use crate::lattice::range::{beside_sum, of_one_neighbour, reach};
use crate::lattice::substitution::SiteSubstitution;
use crate::lattice::summands::summands;
use crate::syntax::ast::{Alternative, Expression, Kind, Statement};

impl Writer<'_> {
    pub(super) fn lagrangian(&mut self, value: &Expression, docs: &[String]) {
        let value = inlined(value, self.lets);
        let mut terms: Vec<(bool, Expression)> = Vec::new();
        let mut large = 0;
        for stated in summands(self.lattice, &value) {
            let found = match reach(self.lattice, &stated) {
                Ok(found) => found,
                Err(d) => {
                    self.errors.push(d);
                    continue;
                }
            };
            if let Some(d) = found.over.and_then(|_| beside_sum(self.lattice, &stated)) {
                self.errors.push(d);
                continue;
            }
            if found.over.is_none() && of_one_neighbour(self.lattice, &stated) {
                self.out.warnings.push(one_neighbour(&stated));
            }
            let range = found.range(self.lattice, self.choice);
            let sites: Vec<isize> = match range {
                Some(r) => r.indices(self.choice.count(r.label)).collect(),
                None => vec![0],
            };
            let mut copies = Vec::new();
            for site in &sites {
                match self.substitution(*site).substitute(&stated) {
                    Ok(e) => copies.push(e),
                    Err(d) => {
                        self.errors.push(*d);
                        break;
                    }
                }
            }
            large += copies.iter().map(Expression::size).sum::<usize>();
            if large > LARGEST {
                let words = self.choice.words(self.lattice);
                let message = format!("this model is too large to be expanded: {words}");
                let d = Diagnostic::new(value.place, message);
                self.errors.push(d.help(format!(
                    "the expanded Lagrangian may have {LARGEST} quantities, numbers and operations: use fewer sites"
                )));
                return;
            }
            let middle = sites.len() / 2;
            if let (Some(shown), Some(site)) = (copies.get(middle), sites.get(middle)) {
                self.out.summands.push(Summand {
                    shown: shown.clone(),
                    of_functionals: self.lattice.has_functional(&stated),
                    site: usize::try_from(*site).unwrap_or(0),
                    stated,
                    range,
                    end: None,
                    width: found.width(),
                    letters: found.letters.clone(),
                });
            }
            terms.extend(copies.into_iter().map(|e| (false, e)));
        }
        for (last, which, alternative) in self.ends() {
            for stated in &alternative.terms {
                let stated = inlined(stated, self.lets);
                let site = self.last_site(last);
                let locals = self.locals(last, alternative);
                let put = SiteSubstitution {
                    locals: &locals,
                    at_last: last,
                    ..self.substitution(isize::try_from(site).unwrap_or(0))
                };
                match (reach(self.lattice, &stated), put.substitute(&stated)) {
                    (Ok(found), Ok(shown)) => {
                        terms.push((false, shown.clone()));
                        self.out.summands.push(Summand {
                            of_functionals: self.lattice.has_functional(&stated),
                            stated,
                            range: None,
                            end: Some((last, which)),
                            width: found.width(),
                            letters: found.letters.clone(),
                            shown,
                            site,
                        });
                    }
                    (Err(d), _) => self.errors.push(d),
                    (_, Err(d)) => self.errors.push(*d),
                }
            }
        }
        let place = value.place;
        let value = match <[(bool, Expression); 1]>::try_from(terms) {
            Ok([(_, only)]) => only,
            Err(terms) if terms.is_empty() => value,
            Err(terms) => Expression {
                kind: Kind::Sum(terms),
                place,
            },
        };
        self.push(Statement::Lagrangian(value), docs);
    }

    fn locals(&self, last: bool, alternative: &Alternative) -> Vec<(String, String)> {
        let names = alternative.params.iter().flat_map(|(names, _)| names);
        let site = self.last_site(last);
        names
            .map(|n| (n.text.clone(), copy_name(&n.text, site)))
            .collect()
    }
}
