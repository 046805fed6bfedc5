//! Prints functionals of all sites: the value at a site as a letter, `A_{a,k}`, and the pull-back as a transposed
//! derivative, with arguments that have no site index.

use super::super::indexed_notation::{IndexOrigin, IndexedNotation, Part};
use crate::check;
use crate::expr::shape::Structure;
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Applied, Expr, Node, Reach, Shift};
use crate::print::document::{Document, Inline};
use crate::print::formula::Formula;
use crate::syntax::ast::Extent;

impl IndexedNotation<'_> {
    /// Replaces the values of functionals in an expression by letters at their sites.
    pub(in crate::document) fn with_functionals(
        &mut self,
        part: &Part,
        e: &Expr,
        from: IndexOrigin,
    ) -> Expr {
        let functionals = self.symbols.functionals();
        if !functionals.iter().any(|f| f.reach == Reach::Sites) {
            return e.clone();
        }
        match e.node() {
            Node::Given(a) if self.is_of_sites(a) && a.along.is_empty() => {
                let name = self.symbols.functional(a.functional).name.clone();
                let label = self.lattice.find(&name).map_or(0, |q| q.label);
                let index = self.index(part, label, 0, from);
                self.value_letter(&format!("{name}_{{{index}}}"), e)
            }
            Node::PullBack(a, which, seed) if self.is_of_sites(a) => {
                let seed = self.with_functionals(part, seed, from);
                let arguments = a.arguments.iter().map(|x| self.plain(part, x)).collect();
                let applied = Applied {
                    arguments,
                    ..a.clone()
                };
                expr::pull_back(&self.symbols, applied, *which, seed)
            }
            _ => {
                let mut children = Vec::new();
                for child in e.children() {
                    children.push(self.with_functionals(part, child, from));
                }
                expr::with_children(&self.symbols, e, children)
            }
        }
    }

    /// The value of a functional as a letter, and its pull-back of a seed `s`.
    fn shown(&mut self, part: &Part, name: &str) -> Option<(Formula, Formula)> {
        let model = &part.unfolded.model;
        let mut called = None;
        for term in &part.unfolded.summands {
            let found = check::numbers(model, &[&term.shown]).into_iter().next()??;
            called = called.or_else(|| given_of(&part.d.letters.symbols, &found, name));
        }
        let value = called?;
        let Node::Given(applied) = value.node() else {
            return None;
        };
        let letter = self.with_functionals(part, &value, IndexOrigin::Site(0));
        let kind = (value.shape(), Structure::General, Role::Parameter);
        let seed = self.named("s", kind, None, &[]);
        let arguments = applied
            .arguments
            .iter()
            .map(|x| self.plain(part, x))
            .collect();
        let applied = Applied {
            arguments,
            ..applied.clone()
        };
        let seed = expr::here(&self.symbols, seed);
        let back = expr::pull_back(&self.symbols, applied, 0, seed);
        Some((Formula::Expr(letter), Formula::Expr(back)))
    }

    fn is_of_sites(&self, a: &Applied) -> bool {
        self.symbols.functional(a.functional).reach == Reach::Sites
    }

    /// An argument of a functional without its site index, for the field as a whole: `X_k`.
    fn plain(&mut self, part: &Part, e: &Expr) -> Expr {
        match e.node() {
            Node::Letter(l) => {
                let own = part.d.letters.symbols.get(l.symbol).clone();
                let Some(copy) = part.unfolded.copy(&own.name) else {
                    return e.clone();
                };
                let typeset = self.lattice.find(&copy.of).and_then(|q| q.name.latex());
                let name = copy.of.clone();
                let kind = (own.shape, own.structure, own.role);
                let id = self.named(&name, kind, typeset, &own.docs);
                expr::letter(&self.symbols, id, l.shift)
            }
            Node::Given(a) if self.is_of_sites(a) => {
                let name = self.symbols.functional(a.functional).name.clone();
                self.value_letter(&name, e)
            }
            _ => e.clone(),
        }
    }

    /// A letter for the values of a functional, at the time node of its arguments.
    fn value_letter(&mut self, name: &str, e: &Expr) -> Expr {
        let s = &self.symbols;
        let moving = |l: &expr::Letter| s.get(l.symbol).role != Role::Parameter;
        let at = expr::letters(e).into_iter().find(|l| moving(l));
        let shift = at.map_or(Shift::HERE, |l| l.shift);
        let kind = (e.shape(), Structure::General, Role::Element);
        let id = self.named(name, kind, None, &[]);
        expr::letter(&self.symbols, id, shift)
    }
}

/// Finds the value of the named functional in an expression.
fn given_of(s: &Symbols, e: &Expr, name: &str) -> Option<Expr> {
    match e.node() {
        Node::Given(a) if s.functional(a.functional).name == name && a.along.is_empty() => {
            Some(e.clone())
        }
        _ => e.children().into_iter().find_map(|x| given_of(s, x, name)),
    }
}

/// Defines the functionals and their pull-backs.
pub(super) fn functionals(folded: &mut IndexedNotation, part: &Part, doc: &mut Document) {
    let meshes = folded.lattice.meshes.clone();
    if meshes.is_empty() {
        return;
    }
    let mut told: Vec<Vec<Inline>> = Vec::new();
    let s = part.d.letters.symbols.clone();
    for f in s.functionals().iter().filter(|f| f.reach == Reach::Sites) {
        let Some(mesh) = meshes.iter().find(|m| m.name.text == f.name) else {
            continue;
        };
        let Some((value, back)) = folded.shown(part, &f.name) else {
            continue;
        };
        let what = mesh.path.rsplit("::").next().unwrap_or(&mesh.path);
        let arguments: Vec<&str> = mesh.arguments.iter().map(|a| a.text.as_str()).collect();
        let label = folded.lattice.find(&f.name).map_or(0, |q| q.label);
        let index = folded.index(part, label, 0, IndexOrigin::Site(0));
        told.push(vec![
                value.into(),
                format!(" is the value at {index} of {what}({}), ", arguments.join(", ")).into(),
                "which depends on all sites; at each site of the argument, ".into(),
                back.into(),
                " is the derivative of the sum of s times the values with respect to the argument there, with s held fixed".into(),
        ]);
    }
    let section = doc.section("Functionals");
    section.list(told);
    let boxed = |q: &crate::lattice::Quantity| matches!(q.domain, Some(Extent::Box(_)));
    if let Some(q) = folded.lattice.quantities.iter().find(|q| boxed(q)) {
        section.text(&format!(
            "A wall reflects particles: if a step takes a position {} beyond a wall, its mirror image replaces it, and the normal component of the kinetic momentum changes sign. No momentum is listed as conserved. If the potential has a nonzero slope at a wall, the step is of first order there, and the energy may drift.",
            q.name.text
        ));
    }
}
