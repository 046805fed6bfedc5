//! Functionals of all sites in an expanded model, which has one site whose letters represent all sites. `A(X)`
//! becomes a function that the engine knows to depend on all sites.

use super::Writer;
use crate::diagnostic::Diagnostic;
use crate::lattice::substitution::any_name;
use crate::lattice::{Kind, Lattice, copy_name};
use crate::syntax::ast::{Expression, Name, Statement};

impl Writer<'_> {
    pub(super) fn mesh(&mut self, statement: &Statement, name: &Name, docs: &[String]) {
        let Statement::Mesh { shape, .. } = statement else {
            return;
        };
        let Some(mesh) = self
            .lattice
            .meshes
            .iter()
            .find(|m| m.name.text == name.text)
        else {
            return;
        };
        let sets = self.lattice.labels.iter().zip(&self.choice.counts);
        if let Some((label, _)) = sets.into_iter().find(|(l, n)| l.set && **n != 1) {
            let message = format!(
                "`{}` depends on all sites of `{}` at once, so clebsch cannot expand the model site by site",
                name.text, label.index.text
            );
            let d = Diagnostic::new(name.place, message)
                .help("use `model! { ... }`, which compiles the model for every number of sites");
            return self.errors.push(d);
        }
        let own = |n: &Name| match self.lattice.find(&n.text) {
            Some(q) if q.kind != Kind::Functional => Name {
                text: copy_name(&n.text, 0),
                ..n.clone()
            },
            _ => n.clone(),
        };
        let stated = Statement::Mesh {
            name: mesh.name.clone(),
            shape: shape.clone(),
            at: None,
            path: Name {
                text: mesh.path.clone(),
                ..mesh.name.clone()
            },
            arguments: mesh.arguments.iter().map(own).collect(),
        };
        self.push(stated, docs);
    }
}

impl Lattice {
    /// Whether an expression contains values of functionals of all sites.
    pub fn has_functional(&self, e: &Expression) -> bool {
        let named = |n: &str| self.find(n).is_some_and(|q| q.kind == Kind::Functional);
        any_name(e, &named)
    }
}
