//! Functionals of all sites in a paper section: their values by the index of a site, `A_{a,k}`, their pull-backs
//! as transposed derivatives at what they are made of, without one.

use super::super::folded::{Folded, From, Part};
use crate::expr::shape::Structure;
use crate::expr::symbol::Role;
use crate::expr::{self, Applied, Expr, Node, Reach, Shift};
use crate::print::document::Document;

impl Folded<'_> {
    /// An expression with the values of functionals as letters of their sites.
    pub(in crate::document) fn with_functionals(
        &mut self,
        part: &Part,
        e: &Expr,
        from: From,
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
                let mut each = children.into_iter();
                let symbols = self.symbols.clone();
                expr::rebuild(&symbols, e, &mut |x| {
                    each.next().unwrap_or_else(|| x.clone())
                })
            }
        }
    }

    fn is_of_sites(&self, a: &Applied) -> bool {
        self.symbols.functional(a.functional).reach == Reach::Sites
    }

    /// What a functional is made of, as the whole of it: `X_k`.
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

    /// A letter for the values of a functional, at the node in time of what they are made of.
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

/// The functionals, and what their pull-backs are.
pub(super) fn functionals(folded: &mut Folded, part: &Part, doc: &mut Document) {
    let meshes = folded.lattice.meshes.clone();
    if meshes.is_empty() {
        return;
    }
    let section = doc.section("Functionals");
    let k = &part.d.spec.time_index;
    for mesh in &meshes {
        let name = &mesh.name.text;
        let label = folded.lattice.find(name).map_or(0, |q| q.label);
        let index = folded.index(part, label, 0, From::Site(0));
        let what = mesh.path.rsplit("::").next().unwrap_or(&mesh.path);
        let arguments: Vec<&str> = mesh.arguments.iter().map(|a| a.text.as_str()).collect();
        section.text(&format!(
            "{name}_{{{index},{k}}} is the value of {what}({}) at {index}, made of all sites at the node {k}.",
            arguments.join(", ")
        ));
    }
    section.text(
        "Derivatives of such values are kept by name: (DA(X))ᵀ[s] is at each site the derivative of the sum of s A over all sites by X there, s being held.",
    );
}
