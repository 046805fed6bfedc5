//! Expands a model with labels, for chosen numbers of sites and end conditions, into a model with that many bodies.
//! Each body has its own name, and the Lagrangian is the sum over the existing sites.

mod definitions;
mod holds;
mod lagrangian;
mod mesh;
mod motionless;
mod names;
mod prescribed;
#[cfg(test)]
mod prescribed_tests;
mod totals;
mod warnings;
#[cfg(test)]
mod warnings_tests;

use super::chain_config::ChainConfig;
use super::declared::{Lattice, Quantity, Sites};
use super::names::{Copied, copy, copy_name};
use super::range::{Range, reach};
use super::substitution::{FixedCopy, PrescribedCopies, SiteSubstitution, any_name};
use crate::check::circular_definitions;
use crate::derive::warnings::Warning;
use crate::diagnostic::{Diagnostic, Errors, Place};
use crate::syntax::ast::{
    Alternative, Expression, Extent, Kind, Model, Name, SizedName, Statement,
};
pub(crate) use definitions::{definitions, inlined};
use std::collections::BTreeMap;
pub use totals::{StatedTotal, Summed};
use warnings::without_a_ring;

/// The largest expanded Lagrangian, in quantities, numbers and operations.
pub(crate) const LARGEST: usize = 60_000;

/// The maximum number of copies of quantities.
const MOST_COPIES: usize = 20_000;

/// One term of the declared Lagrangian, after substitution of definitions.
#[derive(Clone, Debug)]
pub struct Summand {
    /// The term.
    pub stated: Expression,
    /// The sites that it is summed over; `None` if it is not summed.
    pub range: Option<Range>,
    /// The end condition that it belongs to: whether of the last site, and its number.
    pub end: Option<(bool, usize)>,
    /// The largest distance between its letters, in sites.
    pub width: usize,
    /// Kind of sites and offset of its letters, relative to its index.
    pub letters: Vec<(Sites, isize)>,
    /// The term at the displayed site, the middle of its range.
    pub shown: Expression,
    /// The displayed site.
    pub site: usize,
    /// Whether it contains values of functionals of all sites.
    pub of_functionals: bool,
}

/// A declared constraint, and the sites at which it has a multiplier.
#[derive(Clone, Debug)]
pub struct StatedHold {
    /// The name of its multiplier.
    pub name: String,
    /// The indices of its copies.
    pub range: Range,
    /// Kind of sites and offset of its letters, relative to its index.
    pub letters: Vec<(Sites, isize)>,
}

/// An expanded model.
#[derive(Clone, Debug)]
pub struct ExpandedModel {
    /// The model with one body for each site.
    pub model: Model,
    /// The names of all copies.
    pub copies: Vec<Copied>,
    /// Parameters of end conditions: the name in the expanded model, the stated name, whether it belongs to the last site.
    pub end_parameters: Vec<(String, String, bool)>,
    /// Names of the copies that are prescribed at an end.
    pub given: Vec<String>,
    /// The terms of the Lagrangian.
    pub summands: Vec<Summand>,
    /// The constraints at sites.
    pub holds: Vec<StatedHold>,
    /// The constraints on sums over sites.
    pub totals: Vec<StatedTotal>,
    /// Warnings about terms that are probably not intended.
    pub warnings: Vec<Warning>,
    /// The names in all statements, including the end conditions that were not chosen.
    named: warnings::StatementNames,
}

/// Expands a model.
///
/// # Errors
/// Mistakes in the model, with the tokens where they occur.
pub fn unfold(
    model: &Model,
    lattice: &Lattice,
    choice: &ChainConfig,
) -> Result<ExpandedModel, Errors> {
    let mut errors = Errors::new();
    circular_definitions(model, &mut errors);
    errors.propagate()?;
    let sites = (lattice.quantities.iter()).map(|q| choice.sites_of(lattice, q));
    let copies = sites.fold(0, usize::saturating_add);
    if copies > MOST_COPIES {
        let message = format!(
            "this model is too large to be expanded: with {} it has {copies} quantities at sites, at most {MOST_COPIES}",
            choice.words(lattice)
        );
        return Err(Diagnostic::new(model.name.place, message)
            .help("use fewer sites")
            .into());
    }
    let lets = definitions(model)?;
    let mut writer = Writer {
        lattice,
        choice,
        lets: &lets,
        pinned: PrescribedCopies::new(),
        errors: Errors::new(),
        out: ExpandedModel {
            model: Model {
                statements: Vec::new(),
                remarks: Vec::new(),
                ..model.clone()
            },
            copies: Vec::new(),
            end_parameters: Vec::new(),
            given: Vec::new(),
            summands: Vec::new(),
            holds: Vec::new(),
            totals: Vec::new(),
            warnings: warnings::without_use(model),
            named: warnings::StatementNames::of(model),
        },
    };
    writer.pin(model);
    for (statement, docs) in model.statements.iter().zip(&model.remarks) {
        writer.statement(model, statement, docs);
    }
    let moves = |s: &Statement| matches!(s, Statement::Group { .. } | Statement::Field { .. });
    let nothing_left = !writer.out.model.statements.iter().any(moves);
    if nothing_left && model.statements.iter().any(moves) {
        let words = choice.words(lattice);
        let message = format!("every configuration is prescribed ({words}), so nothing moves");
        let d = Diagnostic::new(model.name.place, message);
        writer
            .errors
            .push(d.help("use more sites, or another end condition"));
    }
    writer
        .errors
        .propagate()
        .map_err(Errors::first_at_each_place)?;
    Ok(writer.out)
}

struct Writer<'a> {
    lattice: &'a Lattice,
    choice: &'a ChainConfig,
    lets: &'a BTreeMap<String, Expression>,
    pinned: PrescribedCopies,
    errors: Errors,
    out: ExpandedModel,
}

impl<'a> Writer<'a> {
    fn substitution(&self, site: isize) -> SiteSubstitution<'_> {
        SiteSubstitution {
            lattice: self.lattice,
            choice: self.choice,
            pinned: &self.pinned,
            locals: &[],
            site,
            at_last: false,
        }
    }

    /// The chosen end conditions, and whether each is at the last site.
    fn ends(&self) -> Vec<(bool, usize, &'a Alternative)> {
        if self.choice.periodic || self.lattice.line.is_none() {
            return Vec::new();
        }
        let each = [false, true].into_iter().filter_map(|last| {
            let which = self.choice.ends[usize::from(last)];
            let a = self.lattice.ends[usize::from(last)].get(which)?;
            Some((last, which, a))
        });
        each.collect()
    }

    fn push(&mut self, statement: Statement, docs: &[String]) {
        self.out.model.statements.push(statement);
        self.out.model.remarks.push(docs.to_vec());
    }

    fn copied(&mut self, q: &Quantity, site: usize) -> Name {
        let name = copy(&q.name, site);
        self.out.copies.push(Copied {
            name: name.text.clone(),
            of: q.name.text.clone(),
            site,
        });
        name
    }

    fn statement(&mut self, model: &Model, statement: &Statement, docs: &[String]) {
        match statement {
            Statement::Label { step, .. } => {
                if let Some(step) = step {
                    self.declare_number(step, docs);
                }
            }
            Statement::Periodic(_) | Statement::Let { .. } | Statement::Grid(_) => {}
            Statement::Mesh { name, .. } => self.mesh(statement, name, docs),
            Statement::End { at, .. } => self.end_parameters(at),
            Statement::Param { names, .. } | Statement::Advected { names, .. } => {
                self.declared(statement, names, docs);
            }
            Statement::Field {
                names,
                offset,
                shape,
                domain,
                ..
            } => {
                self.declared(statement, names, docs);
                if let Some(Extent::Torus(lengths)) = domain
                    && is_used(model, lengths)
                {
                    self.declare(lengths, shape);
                }
                if let Some(offset) = offset {
                    if self.lattice.periodic.is_none() {
                        self.out.warnings.push(without_a_ring(offset));
                    }
                    if self.choice.periodic || is_used(model, offset) {
                        self.declare(offset, shape);
                    }
                }
            }
            Statement::Group { name, velocity, .. } => match self.lattice.find(&name.text) {
                None => self.push(statement.clone(), docs),
                Some(q) => self.groups(q, velocity, docs),
            },
            Statement::Constraint { name, value, place } => {
                let value = inlined(value, self.lets);
                match self.lattice.find(&name.text) {
                    None => {
                        self.constant(&value);
                        let (name, place) = (name.clone(), *place);
                        self.push(Statement::Constraint { name, value, place }, docs);
                    }
                    Some(q) => self.constraints(q, name, &value, *place, docs),
                }
            }
            Statement::Assume {
                left,
                relation,
                right,
                place,
            } => {
                let (left, right) = (inlined(left, self.lets), inlined(right, self.lets));
                for put in self.both(&left, &right) {
                    let (left, right) = put;
                    let stated = Statement::Assume {
                        left,
                        relation: *relation,
                        right,
                        place: *place,
                    };
                    self.push(stated, docs);
                }
            }
            Statement::Hold {
                name,
                left,
                right,
                place,
            } => self.holds(name, left, right, *place, docs),
            Statement::Scale(value) => {
                let value = inlined(value, self.lets);
                self.constant(&value);
                self.push(Statement::Scale(value), docs);
            }
            Statement::Lagrangian(value) => self.lagrangian(value, docs),
            Statement::Dim { .. }
            | Statement::Time { .. }
            | Statement::Given { .. }
            | Statement::Node(..) => {
                self.push(statement.clone(), docs);
            }
        }
    }

    fn declare_number(&mut self, name: &Name, docs: &[String]) {
        let shape = SizedName::number(name.place);
        let names = vec![name.clone()];
        let at = None;
        self.push(Statement::Param { names, shape, at }, docs);
    }

    fn declare(&mut self, name: &Name, shape: &SizedName) {
        let known = |s: &Statement| match s {
            Statement::Param { names, .. } => names.iter().any(|n| n.text == name.text),
            _ => false,
        };
        if self.out.model.statements.iter().any(known) {
            return;
        }
        let (names, shape) = (vec![name.clone()], shape.clone());
        self.push(
            Statement::Param {
                names,
                shape,
                at: None,
            },
            &[],
        );
    }

    /// The parameters of the chosen end condition at this end.
    fn end_parameters(&mut self, at: &Name) {
        for (last, _, alternative) in self.ends() {
            if last == (at.text == "0") {
                continue;
            }
            for (names, shape) in &alternative.params {
                for name in names {
                    let site = self.last_site(last);
                    let own = copy(name, site);
                    self.out
                        .end_parameters
                        .push((own.text.clone(), name.text.clone(), last));
                    let (names, shape) = (vec![own], shape.clone());
                    let at = None;
                    self.push(Statement::Param { names, shape, at }, &[]);
                }
            }
        }
    }

    /// The index of the first or the last node.
    fn last_site(&self, last: bool) -> usize {
        let line = self.lattice.line.unwrap_or(0);
        if last { self.choice.count(line) } else { 0 }
    }

    /// Declares the copies of parameters, fields and advected quantities.
    fn declared(&mut self, statement: &Statement, names: &[Name], docs: &[String]) {
        let first = names.first().and_then(|n| self.lattice.find(&n.text));
        if first.is_none() {
            if let Statement::Advected {
                definition: Some(value),
                ..
            } = statement
            {
                self.constant(&inlined(value, self.lets));
            }
            return self.push(statement.clone(), docs);
        }
        for name in names {
            let Some(q) = self.lattice.find(&name.text) else {
                continue;
            };
            for site in 0..self.choice.sites_of(self.lattice, q) {
                let own = copy_name(&q.name.text, site);
                let one = match self.pinned.get(&own) {
                    Some(FixedCopy::Given) => {
                        let (names, shape) = (vec![self.copied(q, site)], q.shape.clone());
                        Statement::Param {
                            names,
                            shape,
                            at: None,
                        }
                    }
                    Some(_) => continue,
                    None => match self.copy_of(statement, q, site) {
                        Some(one) => one,
                        None => continue,
                    },
                };
                self.push(one, docs);
            }
        }
    }

    fn copy_of(&mut self, statement: &Statement, q: &Quantity, site: usize) -> Option<Statement> {
        let (names, shape) = (vec![self.copied(q, site)], q.shape.clone());
        let at = None;
        Some(match statement {
            Statement::Param { .. } => Statement::Param { names, shape, at },
            Statement::Field { .. } => Statement::Field {
                names,
                shape,
                at,
                offset: None,
                domain: None,
            },
            Statement::Advected { definition, .. } => {
                let index = isize::try_from(site).ok()?;
                let definition = match definition {
                    None => None,
                    Some(value) => match self
                        .substitution(index)
                        .substitute(&inlined(value, self.lets))
                    {
                        Ok(e) => Some(e),
                        Err(d) => {
                            self.errors.push(*d);
                            return None;
                        }
                    },
                };
                Statement::Advected {
                    names,
                    shape,
                    at,
                    definition,
                }
            }
            _ => return None,
        })
    }

    fn groups(&mut self, q: &Quantity, velocity: &Name, docs: &[String]) {
        for site in 0..self.choice.sites_of(self.lattice, q) {
            let name = self.copied(q, site);
            if self.pinned.contains_key(&name.text) {
                let (names, shape) = (vec![name], q.shape.clone());
                let at = None;
                self.push(Statement::Param { names, shape, at }, docs);
                continue;
            }
            let own = copy(velocity, site);
            self.out.copies.push(Copied {
                name: own.text.clone(),
                of: velocity.text.clone(),
                site,
            });
            let stated = Statement::Group {
                name,
                group: q.shape.clone(),
                at: None,
                velocity: own,
            };
            self.push(stated, docs);
        }
    }

    fn constraints(
        &mut self,
        q: &Quantity,
        name: &Name,
        value: &Expression,
        place: Place,
        docs: &[String],
    ) {
        for site in 0..self.choice.sites_of(self.lattice, q) {
            let own = copy(name, site);
            if self.pinned.contains_key(&own.text) {
                continue;
            }
            let Ok(index) = isize::try_from(site) else {
                continue;
            };
            match self.substitution(index).substitute(value) {
                Ok(value) => {
                    let stated = Statement::Constraint {
                        name: own,
                        value,
                        place,
                    };
                    self.push(stated, docs);
                }
                Err(d) => return self.errors.push(*d),
            }
        }
    }

    /// A term that is not summed must not contain a letter of a site.
    fn constant(&mut self, e: &Expression) {
        match reach(self.lattice, e) {
            Err(d) => self.errors.push(d),
            Ok(r) if !r.letters.is_empty() => {
                let d = Diagnostic::new(
                    e.place,
                    "this statement is not repeated at sites, but contains a quantity that differs between sites",
                );
                self.errors.push(d.help(
                    "declare its quantity at the same sites, for example `advected Γ: Vec<3> at nodes`",
                ));
            }
            Ok(_) => {}
        }
    }

    /// Both sides of an assumption, once for each site at which they differ.
    fn both(&mut self, left: &Expression, right: &Expression) -> Vec<(Expression, Expression)> {
        let whole = Expression {
            kind: Kind::Sum(vec![(false, left.clone()), (true, right.clone())]),
            place: left.place,
        };
        let range = match reach(self.lattice, &whole) {
            Ok(r) => r.range(self.lattice, self.choice),
            Err(d) => {
                self.errors.push(d);
                return Vec::new();
            }
        };
        let Some(range) = range else {
            return vec![(left.clone(), right.clone())];
        };
        let mut out = Vec::new();
        for site in range.indices(self.choice.count(range.label)) {
            let put = |e| self.substitution(site).substitute(e).ok();
            out.extend(put(left).zip(put(right)));
        }
        out
    }
}

/// Whether the Lagrangian, its scale or an assumption contains a name.
fn is_used(model: &Model, name: &Name) -> bool {
    let used = |e: &Expression| any_name(e, &|n| n == name.text);
    model.statements.iter().any(|s| match s {
        Statement::Assume { left, right, .. } => used(left) || used(right),
        Statement::Lagrangian(e) | Statement::Scale(e) => used(e),
        _ => false,
    })
}

fn velocity_of<'a>(model: &'a Model, element: &str) -> Option<&'a Name> {
    model.statements.iter().find_map(|s| match s {
        Statement::Group { name, velocity, .. } if name.text == element => Some(velocity),
        _ => None,
    })
}
