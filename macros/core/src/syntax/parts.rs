//! Traversal of expressions: names, size, and replacement of parts.

use super::ast::{Expression, Extent, Kind, Name, Statement};

impl Expression {
    /// Its direct subexpressions, in order.
    pub fn parts(&self) -> Vec<&Expression> {
        match &self.kind {
            Kind::Number(_) | Kind::Constant(_) | Kind::Name(_) => Vec::new(),
            Kind::Sum(terms) => terms.iter().map(|(_, t)| t).collect(),
            Kind::Product(list) | Kind::Call(_, list) => list.iter().collect(),
            Kind::Quotient(a, b) => vec![a, b],
            Kind::Neg(a)
            | Kind::Transpose(a)
            | Kind::Power(a, _)
            | Kind::Component(a, _)
            | Kind::Shaped(a, _) => {
                vec![a]
            }
        }
    }

    /// Its direct subexpressions, mutable.
    pub(super) fn parts_mut(&mut self) -> Vec<&mut Expression> {
        match &mut self.kind {
            Kind::Number(_) | Kind::Constant(_) | Kind::Name(_) => Vec::new(),
            Kind::Sum(terms) => terms.iter_mut().map(|(_, t)| t).collect(),
            Kind::Product(list) | Kind::Call(_, list) => list.iter_mut().collect(),
            Kind::Quotient(a, b) => vec![a, b],
            Kind::Neg(a)
            | Kind::Transpose(a)
            | Kind::Power(a, _)
            | Kind::Component(a, _)
            | Kind::Shaped(a, _) => {
                vec![a]
            }
        }
    }

    /// The first name of a quantity that satisfies `is`.
    pub(crate) fn name_that(&self, is: &dyn Fn(&str) -> bool) -> Option<&str> {
        match &self.kind {
            Kind::Name(n) => is(n).then_some(n),
            _ => self.parts().into_iter().find_map(|part| part.name_that(is)),
        }
    }

    /// The first called function among these.
    pub(crate) fn call_of(&self, of: &[&str]) -> Option<&str> {
        self.call_that(&|name| of.contains(&name))
    }

    /// The first called function that satisfies `is`.
    pub(crate) fn call_that(&self, is: &dyn Fn(&str) -> bool) -> Option<&str> {
        match &self.kind {
            Kind::Call(name, _) if is(&name.text) => Some(&name.text),
            _ => self.parts().into_iter().find_map(|part| part.call_that(is)),
        }
    }

    /// Visits the expression and all its subexpressions.
    pub fn each(&self, visit: &mut dyn FnMut(&Expression)) {
        visit(self);
        for part in self.parts() {
            part.each(visit);
        }
    }

    /// The number of quantities, numbers and operations.
    pub(crate) fn size(&self) -> usize {
        1 + self.parts().into_iter().map(Self::size).sum::<usize>()
    }

    /// Replaces parts by the results of `of`, larger parts first. Replacements are not searched again.
    pub(crate) fn replaced(&self, of: &dyn Fn(&Expression) -> Option<Expression>) -> Expression {
        let mut out = self.clone();
        out.replace(of);
        out
    }

    /// Replaces parts in place.
    pub(crate) fn replace(&mut self, of: &dyn Fn(&Expression) -> Option<Expression>) {
        match of(self) {
            Some(put) => *self = put,
            None => self
                .parts_mut()
                .into_iter()
                .for_each(|part| part.replace(of)),
        }
    }
}

impl Statement {
    /// The names that it declares, except names of ends and of numbers of sites.
    pub(crate) fn declared(&self) -> Vec<&Name> {
        match self {
            Statement::Param { names, .. } | Statement::Advected { names, .. } => {
                names.iter().collect()
            }
            Statement::Field {
                names,
                offset,
                domain,
                ..
            } => {
                let lengths = match domain {
                    Some(Extent::Torus(lengths)) => Some(lengths),
                    Some(Extent::Box(_)) | None => None,
                };
                names.iter().chain(offset).chain(lengths).collect()
            }
            Statement::Group { name, velocity, .. } => vec![name, velocity],
            Statement::Let { name, .. }
            | Statement::Dim { name, .. }
            | Statement::Hold { name, .. }
            | Statement::Given { name, .. }
            | Statement::Mesh { name, .. } => vec![name],
            Statement::Label {
                step: Some(step), ..
            } => vec![step],
            _ => Vec::new(),
        }
    }

    /// All its expressions, including formulas of functions.
    pub(crate) fn expressions(&self) -> Vec<&Expression> {
        match self {
            Statement::Assume { left, right, .. } | Statement::Hold { left, right, .. } => {
                vec![left, right]
            }
            Statement::Advected { definition, .. } => definition.iter().collect(),
            Statement::Constraint { value, .. }
            | Statement::Let { value, .. }
            | Statement::Scale(value)
            | Statement::Lagrangian(value) => vec![value],
            Statement::End { alternatives, .. } => {
                alternatives.iter().flat_map(|a| &a.terms).collect()
            }
            Statement::Given { components, .. } => components.iter().collect(),
            Statement::Label { .. }
            | Statement::Periodic(_)
            | Statement::Dim { .. }
            | Statement::Time { .. }
            | Statement::Param { .. }
            | Statement::Group { .. }
            | Statement::Field { .. }
            | Statement::Grid(_)
            | Statement::Mesh { .. }
            | Statement::Node(..) => Vec::new(),
        }
    }

    /// All its expressions, mutable.
    pub(crate) fn expressions_mut(&mut self) -> Vec<&mut Expression> {
        match self {
            Statement::Assume { left, right, .. } | Statement::Hold { left, right, .. } => {
                vec![left, right]
            }
            Statement::Advected { definition, .. } => definition.iter_mut().collect(),
            Statement::Constraint { value, .. }
            | Statement::Let { value, .. }
            | Statement::Scale(value)
            | Statement::Lagrangian(value) => vec![value],
            Statement::End { alternatives, .. } => alternatives
                .iter_mut()
                .flat_map(|a| a.terms.iter_mut())
                .collect(),
            Statement::Label { .. }
            | Statement::Periodic(_)
            | Statement::Dim { .. }
            | Statement::Time { .. }
            | Statement::Param { .. }
            | Statement::Group { .. }
            | Statement::Field { .. }
            | Statement::Given { .. }
            | Statement::Grid(_)
            | Statement::Mesh { .. }
            | Statement::Node(..) => Vec::new(),
        }
    }
}
