//! Declarations of functionals: of the values at one site, by a path, and of all sites.

use super::declare::Declared;
use super::shapes;
use crate::diagnostic::Errors;
use crate::expr::{Functional, Kind, Reach};
use crate::syntax::ast::{Name, SizedName};

impl Declared {
    /// The kind of a declared shape.
    pub(super) fn kind(&self, k: &SizedName, errors: &mut Errors) -> Option<Kind> {
        let (shape, structure) = shapes::shape(&self.symbols, k, errors)?;
        Some(Kind { shape, structure })
    }

    /// The kind of a letter, or of the value of a functional.
    pub(super) fn kind_of(&self, name: &str) -> Option<Kind> {
        if let Some(id) = self.symbols.find(name) {
            let symbol = self.symbols.get(id);
            let (shape, structure) = (symbol.shape, symbol.structure);
            return Some(Kind { shape, structure });
        }
        let mut all = self.symbols.functionals().iter();
        all.find(|f| f.name == name).map(|f| f.value)
    }

    /// Adds a functional, or only reserves its name if the declaration is faulty.
    pub(super) fn functional(
        &mut self,
        name: &Name,
        arguments: Option<Vec<Kind>>,
        value: &SizedName,
        (path, reach): (&Name, Reach),
        errors: &mut Errors,
    ) {
        let (Some(arguments), Some(value)) = (arguments, self.kind(value, errors)) else {
            return self.take(&name.text, name.place);
        };
        if self.admit(name, errors) {
            self.symbols.add_functional(Functional {
                name: name.text.clone(),
                arguments,
                value,
                reach,
                path: path.text.clone(),
                typeset: name.latex(),
            });
        }
    }
}
