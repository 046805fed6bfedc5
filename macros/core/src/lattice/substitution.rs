//! Substitutes the copies at one site into an expression: each quantity of the chain becomes its copy. Across the
//! seam of a ring the copy is shifted by the offset of its field; prescribed quantities do not move.

use super::chain_config::ChainConfig;
use super::declared::{Lattice, Quantity, Sites};
use super::names::copy_name;
use crate::algebra::Rational;
use crate::diagnostic::Diagnostic;
use crate::syntax::ast::{Expression, Kind, Name, Size, SizedName};
use std::collections::BTreeMap;

/// The replacement of a copy that does not move.
#[derive(Clone, Debug)]
pub(super) enum FixedCopy {
    /// A parameter of the same name.
    Given,
    /// The identity, for the velocity of a prescribed configuration.
    Identity,
    /// A definition in terms of prescribed values.
    Defined(Expression),
}

/// Copies that do not move, by name.
pub(super) type PrescribedCopies = BTreeMap<String, FixedCopy>;

/// The site of a substitution.
pub(super) struct SiteSubstitution<'a> {
    /// The labels, with their quantities and ends.
    pub lattice: &'a Lattice,
    /// The chosen sites and ends.
    pub choice: &'a ChainConfig,
    /// The copies that do not move.
    pub pinned: &'a PrescribedCopies,
    /// Names of an end condition, with their names in the expanded model.
    pub locals: &'a [(String, String)],
    /// The index of the site.
    pub site: isize,
    /// Whether the index is the last node; a segment is then the last segment.
    pub at_last: bool,
}

type Placed = Result<Expression, Box<Diagnostic>>;

impl SiteSubstitution<'_> {
    /// The expression at the site.
    pub(super) fn substitute(&self, e: &Expression) -> Placed {
        self.at(e, 0)
    }

    fn at(&self, e: &Expression, by: isize) -> Placed {
        let one = |a: &Expression| self.at(a, by).map(Box::new);
        let all = |list: &[Expression]| {
            let each = list.iter().map(|a| self.at(a, by));
            each.collect::<Result<Vec<Expression>, _>>()
        };
        let kind = match &e.kind {
            Kind::Number(_) | Kind::Constant(_) => e.kind.clone(),
            Kind::Name(n) => return self.name(n, e, by),
            Kind::Sum(terms) => {
                let each = terms.iter().map(|(minus, t)| Ok((*minus, self.at(t, by)?)));
                Kind::Sum(each.collect::<Result<_, Box<Diagnostic>>>()?)
            }
            Kind::Shaped(a, shape) => Kind::Shaped(one(a)?, shape.clone()),
            Kind::Product(list) => Kind::Product(all(list)?),
            Kind::Quotient(a, b) => Kind::Quotient(one(a)?, one(b)?),
            Kind::Neg(a) => Kind::Neg(one(a)?),
            Kind::Transpose(a) => Kind::Transpose(one(a)?),
            Kind::Power(a, q) => Kind::Power(one(a)?, *q),
            Kind::Component(a, indices) => Kind::Component(one(a)?, indices.clone()),
            Kind::Call(f, arguments) => match (f.text.as_str(), arguments.as_slice()) {
                ("next", [inner, _]) => return self.at(inner, by + 1),
                ("prev", [inner, _]) => return self.at(inner, by - 1),
                ("sum", [inner, _]) => return self.at(inner, by),
                ("next" | "prev", [inner]) => {
                    let placed = self.at(inner, by)?;
                    // A prescribed quantity is the same at the next time level.
                    if self.moves(inner, &self.lattice.moving) && !self.is_moving(&placed) {
                        return Ok(placed);
                    }
                    Kind::Call(f.clone(), vec![placed])
                }
                _ => Kind::Call(f.clone(), all(arguments)?),
            },
        };
        Ok(Expression {
            kind,
            place: e.place,
        })
    }

    fn name(&self, n: &str, e: &Expression, by: isize) -> Placed {
        let place = e.place;
        if let Some((_, own)) = self.locals.iter().find(|(local, _)| local == n) {
            return Ok(named(own.clone(), e));
        }
        let Some(q) = self.lattice.find(n) else {
            return match self.is_name_of_a_copy(n) {
                // The name exists in the expanded model, but not in the model as declared.
                true => Err(Box::new(
                    Diagnostic::new(place, format!("`{n}` is not declared")).help(
                        "use the declared name; the quantity is taken at the site of the term",
                    ),
                )),
                false => Ok(e.clone()),
            };
        };
        if q.kind == super::declared::Kind::Functional {
            return self.functional(n, e);
        }
        let count = self.choice.sites_of(self.lattice, q);
        let size = isize::try_from(count).unwrap_or(isize::MAX);
        let last_segment = self.at_last && q.sites == Sites::Segments;
        let mut at = self.site + by - isize::from(last_segment);
        let ring = self.choice.periodic && self.lattice.line == Some(q.label);
        let mut turns = 0;
        if ring && size > 0 {
            (turns, at) = (at.div_euclid(size), at.rem_euclid(size));
        }
        let Some(site) = usize::try_from(at).ok().filter(|s| *s < count) else {
            let d = Diagnostic::new(place, format!("`{n}` does not exist at this site"));
            return Err(Box::new(d.help(
                "the first site has no `prev(x, i)`, and the last site no `next(x, i)`",
            )));
        };
        let copy = copy_name(n, site);
        let value = match self.pinned.get(&copy) {
            Some(FixedCopy::Identity) => still(q, e),
            Some(FixedCopy::Defined(by_given)) => by_given.clone(),
            Some(FixedCopy::Given) | None => named(copy, e),
        };
        let Some(offset) = q.offset.as_ref().filter(|_| turns != 0) else {
            return Ok(value);
        };
        let mut step = named(offset.text.clone(), e);
        if turns.abs() > 1 {
            let many = i128::try_from(turns.abs())
                .ok()
                .and_then(|t| Rational::new(t, 1));
            let many = Expression {
                kind: Kind::Number(many.unwrap_or(Rational::ONE)),
                place,
            };
            step = Expression {
                kind: Kind::Product(vec![many, step]),
                place,
            };
        }
        Ok(Expression {
            kind: Kind::Sum(vec![(false, value), (turns < 0, step)]),
            place,
        })
    }

    /// The values of a functional of all sites, `A(X)`: taken at the only site of the expanded model, which represents
    /// all sites.
    fn functional(&self, n: &str, e: &Expression) -> Placed {
        let mut meshes = self.lattice.meshes.iter();
        let Some(mesh) = meshes.find(|m| m.name.text == n) else {
            return Ok(e.clone());
        };
        let at_first = SiteSubstitution {
            lattice: self.lattice,
            choice: self.choice,
            pinned: self.pinned,
            locals: self.locals,
            site: 0,
            at_last: false,
        };
        let place = e.place;
        let arguments = mesh.arguments.iter().map(|a| {
            let kind = Kind::Name(a.text.clone());
            at_first.substitute(&Expression { kind, place })
        });
        let name = crate::syntax::ast::Name {
            place,
            ..mesh.name.clone()
        };
        Ok(Expression {
            kind: Kind::Call(name, arguments.collect::<Result<_, _>>()?),
            place,
        })
    }

    /// Whether an undeclared name is the name of a copy.
    fn is_name_of_a_copy(&self, n: &str) -> bool {
        let split = n.rsplit_once('_');
        let copied = split.is_some_and(|(base, site)| {
            site.parse::<usize>().is_ok() && self.lattice.declared.contains(base)
        });
        copied && !self.lattice.declared.contains(n)
    }

    /// Whether an expanded expression contains a moving quantity.
    pub(super) fn is_moving(&self, e: &Expression) -> bool {
        any_name(e, &|n| match self.lattice.of_copy(n) {
            Some(q) => self.lattice.moving.contains(&q.name.text) && !self.pinned.contains_key(n),
            None => self.lattice.moving.contains(n) && self.lattice.find(n).is_none(),
        })
    }

    fn moves(&self, e: &Expression, names: &std::collections::BTreeSet<String>) -> bool {
        any_name(e, &|n| names.contains(n))
    }
}

/// The velocity of a prescribed quantity. For a rigid motion it includes the size, which `pos` does not determine.
fn still(q: &Quantity, e: &Expression) -> Expression {
    let identity = named("Id".to_owned(), e);
    let [Size::Number(n, _)] = q.shape.sizes.as_slice() else {
        return identity;
    };
    if q.shape.name.text != "SE" {
        return identity;
    }
    let shape = SizedName {
        name: Name {
            text: "Mat".to_owned(),
            place: e.place,
            typeset: None,
            is_copy: false,
        },
        sizes: vec![Size::Number(n + 1, e.place)],
        place: e.place,
    };
    Expression {
        kind: Kind::Shaped(Box::new(identity), shape),
        place: e.place,
    }
}

fn named(text: String, e: &Expression) -> Expression {
    Expression {
        kind: Kind::Name(text),
        place: e.place,
    }
}

/// Whether any name in the expression satisfies `is`.
pub(crate) fn any_name(e: &Expression, is: &dyn Fn(&str) -> bool) -> bool {
    e.name_that(is).is_some()
}
