//! Declarations: symbols with their shapes, configurations and advected quantities, and the constraints declared for
//! them.

use super::entries::Entries;
use super::messages;
use super::names::{PRINTED, foreign, model_name, unusable};
use super::shapes;
use super::spec::{Dimension, Group};
use crate::diagnostic::{Diagnostic, Errors, Place, closest};
use crate::expr::shape::{Shape, Structure};
use crate::expr::spelling::{seen, seen_apart, seen_typeset};
use crate::expr::symbol::{Role, SymbolId, Symbols, ascii};
use crate::expr::{Expr, Reach};
use crate::groups::Additive;
use crate::syntax::ast::{Model, Name, Statement};
use std::collections::BTreeSet;

/// A declared configuration, with its constraint once it is declared.
#[derive(Clone)]
pub struct DeclaredGroup {
    pub element: SymbolId,
    pub velocity: SymbolId,
    pub group: Group,
    pub place: Place,
    pub group_place: Place,
    pub update: Option<(Expr, Place)>,
    stated: bool,
}

/// A declared advected quantity, with its constraint and definition once they are declared.
#[derive(Clone)]
pub struct DeclaredAdvected {
    pub quantity: SymbolId,
    pub place: Place,
    pub update: Option<(Expr, Place)>,
    pub definition: Option<(Expr, Place)>,
    stated: bool,
}

/// A name that is in use; no other name may equal it in print or in files.
#[derive(Clone)]
struct UsedName {
    name: String,
    place: Place,
    /// Its printed form.
    seen: String,
    /// Its form in files.
    ascii: String,
    /// Whether it is a copy at a site, which may print its site in brackets.
    is_copy: bool,
}

/// All declarations of a model.
#[derive(Clone)]
pub struct Declared {
    pub symbols: Symbols,
    pub time_index: String,
    pub step: SymbolId,
    pub dimensions: Vec<Dimension>,
    pub parameters: Vec<SymbolId>,
    pub parameter_places: Vec<Place>,
    pub configurations: Vec<DeclaredGroup>,
    pub advected: Vec<DeclaredAdvected>,
    /// Fields whose matrix is built from independent entries.
    pub structured: Vec<(SymbolId, Entries)>,
    taken: Vec<UsedName>,
    /// Typeset names: the printed form, and the declaring name.
    typeset: Vec<(String, Name)>,
    /// Copies that print with their sites in brackets.
    apart: BTreeSet<String>,
}

/// Reads all declarations of a model.
pub fn declare(model: &Model, errors: &mut Errors) -> Declared {
    let mut symbols = Symbols::default();
    symbols.count_time_by("k");
    model_name(&model.name, errors);
    let (mut time_index, mut step_name) = ("k".to_owned(), "h".to_owned());
    let mut step_place = None;
    for statement in &model.statements {
        if let Statement::Time { index, step } = statement {
            time_index = index.text.clone();
            symbols.count_time_by(&time_index);
            step_name = step.text.clone();
            step_place = Some(step.place);
            errors.extend(unusable(step));
            if step.text == index.text {
                errors.push(
                    Diagnostic::new(
                        step.place,
                        format!(
                            "`{}` is the time index and cannot be the step size too",
                            step.text
                        ),
                    )
                    .help("choose another name for the step size, for example `time k step h;`"),
                );
            }
        }
    }
    let step = symbols.add(&step_name, Shape::SCALAR, Structure::General, Role::Step);
    let mut d = Declared {
        symbols,
        time_index,
        step,
        dimensions: Vec::new(),
        parameters: Vec::new(),
        parameter_places: Vec::new(),
        configurations: Vec::new(),
        advected: Vec::new(),
        structured: Vec::new(),
        taken: Vec::new(),
        typeset: Vec::new(),
        apart: BTreeSet::new(),
    };
    if let Some(place) = step_place {
        d.take(&step_name, place);
    }
    for (statement, docs) in model.statements.iter().zip(&model.remarks) {
        d.statement(statement, docs, errors);
    }
    for name in &d.apart {
        d.symbols.tell_apart(name);
    }
    d.increments();
    d
}

impl Declared {
    /// How the matrix of a quantity is built from its independent entries.
    pub fn entries(&self, id: SymbolId) -> Entries {
        let found = self.structured.iter().find(|(own, _)| *own == id);
        found.map_or(Entries::Own, |(_, entries)| *entries)
    }

    /// Names the increments of fields and sets their constraints: `next(X) = X + ΔX`.
    fn increments(&mut self) {
        let symbols = &mut self.symbols;
        let fields = self.configurations.iter_mut();
        for c in fields.filter(|c| c.group.is_additive()) {
            let symbol = symbols.get(c.element).clone();
            let name = symbols.fresh_name(&format!("Δ{}", symbol.name));
            c.velocity = symbols.add(&name, symbol.shape, Structure::General, Role::Velocity);
            let [x, change] = [c.element, c.velocity].map(|id| crate::expr::here(symbols, id));
            c.update = Some((crate::expr::add(x, change), c.place));
        }
    }

    fn statement(&mut self, statement: &Statement, docs: &[String], errors: &mut Errors) {
        match statement {
            Statement::Dim { name, from, to } => {
                if self.admit(name, errors) {
                    self.symbols.add_dim(&name.text, *from, *to);
                    self.dimensions.push(Dimension {
                        name: name.text.clone(),
                        from: *from,
                        to: *to,
                    });
                }
            }
            Statement::Param { names, shape, .. } => {
                let Some((shape, structure)) = shapes::shape(&self.symbols, shape, errors) else {
                    // Later uses of the names must not be reported as unknown as well.
                    names.iter().for_each(|n| self.take(&n.text, n.place));
                    return;
                };
                for name in names {
                    if self.admit(name, errors) {
                        let id = self
                            .symbols
                            .add(&name.text, shape, structure, Role::Parameter);
                        self.symbols.describe(id, name.latex(), docs);
                        self.parameters.push(id);
                        self.parameter_places.push(name.place);
                    }
                }
            }
            Statement::Group {
                name,
                group,
                velocity,
                ..
            } => {
                let Some(kind) = shapes::group(&self.symbols, group, errors) else {
                    for n in [name, velocity] {
                        self.take(&n.text, n.place);
                    }
                    return;
                };
                if !self.admit(name, errors) || !self.admit(velocity, errors) {
                    return;
                }
                let shape = kind.shape();
                let structure = kind.structure();
                let symbols = &mut self.symbols;
                let element = symbols.add(&name.text, shape, structure, Role::Element);
                symbols.describe(element, name.latex(), docs);
                let typeset = velocity.latex();
                let velocity = symbols.add(&velocity.text, shape, structure, Role::Velocity);
                symbols.describe(velocity, typeset, &[]);
                self.configurations.push(DeclaredGroup {
                    element,
                    velocity,
                    group: kind,
                    place: name.place,
                    group_place: group.place,
                    update: None,
                    stated: false,
                });
            }
            Statement::Field { names, shape, .. } => {
                let Some((shape, entries)) = shapes::field(&self.symbols, shape, errors) else {
                    names.iter().for_each(|n| self.take(&n.text, n.place));
                    return;
                };
                for name in names {
                    if !self.admit(name, errors) {
                        continue;
                    }
                    let element =
                        self.symbols
                            .add(&name.text, shape, Structure::General, Role::Element);
                    self.symbols.describe(element, name.latex(), docs);
                    if entries != Entries::Own {
                        self.structured.push((element, entries));
                    }
                    self.configurations.push(DeclaredGroup {
                        element,
                        // The increment gets its symbol once all names of the model are known.
                        velocity: element,
                        group: Group::Additive(Additive(shape)),
                        place: name.place,
                        group_place: name.place,
                        update: None,
                        stated: true,
                    });
                }
            }
            Statement::Advected { names, shape, .. } => {
                let Some((shape, structure)) = shapes::advected_shape(&self.symbols, shape, errors)
                else {
                    names.iter().for_each(|n| self.take(&n.text, n.place));
                    return;
                };
                for name in names {
                    if !self.admit(name, errors) {
                        continue;
                    }
                    let quantity = self
                        .symbols
                        .add(&name.text, shape, structure, Role::Advected);
                    self.symbols.describe(quantity, name.latex(), docs);
                    self.advected.push(DeclaredAdvected {
                        quantity,
                        place: name.place,
                        update: None,
                        definition: None,
                        stated: false,
                    });
                }
            }
            Statement::Given {
                name,
                arguments,
                value,
                path,
                components,
                ..
            } => {
                if !components.is_empty() {
                    self.admit(name, errors);
                    return;
                }
                let arguments = arguments.iter().map(|k| self.kind(k, errors)).collect();
                self.functional(name, arguments, value, (path, Reach::Point), errors);
            }
            Statement::Mesh {
                name,
                shape,
                path,
                arguments,
                ..
            } => {
                let kinds: Option<Vec<_>> =
                    arguments.iter().map(|a| self.kind_of(&a.text)).collect();
                if kinds.is_none() {
                    let message = format!("an argument of `{}` is not declared", name.text);
                    let d = Diagnostic::new(name.place, message);
                    errors.push(d.help("declare its field and parameters before the functional"));
                }
                self.functional(name, kinds, shape, (path, Reach::Sites), errors);
            }
            Statement::Time { .. }
            | Statement::Grid(_)
            | Statement::Assume { .. }
            | Statement::Constraint { .. }
            | Statement::Hold { .. }
            | Statement::Let { .. }
            | Statement::Scale(_)
            | Statement::Node(..)
            | Statement::Label { .. }
            | Statement::Periodic(_)
            | Statement::End { .. }
            | Statement::Lagrangian(_) => {}
        }
    }

    /// Whether the name is free; reports an error if it is not.
    pub fn admit(&mut self, name: &Name, errors: &mut Errors) -> bool {
        let text = name.text.as_str();
        if let Some(d) = unusable(name) {
            errors.push(d);
            // Later uses of the name must not be reported as well.
            self.take(text, name.place);
            return false;
        }
        if let Some(first) = self.taken.iter().find(|t| t.name == text) {
            errors.push(
                Diagnostic::new(name.place, format!("`{text}` is declared twice"))
                    .also(first.place, format!("`{text}` is declared here first")),
            );
            return false;
        }
        let spelt = ascii(text);
        if let Some(first) = self.taken.iter().find(|t| t.ascii == spelt) {
            let other = &first.name;
            errors.push(
                Diagnostic::new(
                    name.place,
                    format!("`{text}` and `{other}` have the same name in files, `{spelt}`"),
                )
                .help("choose names that differ when Greek letters are spelt out")
                .also(first.place, format!("`{other}` is declared here")),
            );
            return false;
        }
        self.tell_apart(name);
        let shown = self.shown(name);
        if let Some(first) = self.taken.iter().find(|t| t.seen == shown) {
            let other = &first.name;
            let d = Diagnostic::new(
                name.place,
                format!("`{text}` and `{other}` look the same in print"),
            );
            errors.push(match foreign(text, other) {
                Some(characters) => d.help(characters),
                None => d.help(format!("choose names that differ in print: Greek words become letters, digits and what follows \
                    `_` become subscripts, and `_{}` is the time index", self.time_index)),
            }
            .also(first.place, format!("`{other}` is declared here")));
            return false;
        }
        let step = &self.symbols.get(self.step).name;
        if seen(step, &self.time_index) == shown {
            let message = match step == text {
                true => format!("`{text}` is the time step"),
                false => format!("`{text}` prints like the time step `{step}`"),
            };
            errors.push(
                Diagnostic::new(name.place, message)
                    .help("choose another name, or rename the step: `time k step dt;`"),
            );
            return false;
        }
        errors.extend(self.typeset_as_another(name));
        let latex = self.in_latex(name);
        self.typeset.push((latex, name.clone()));
        self.taken.push(UsedName {
            name: text.to_owned(),
            place: name.place,
            seen: shown,
            ascii: spelt,
            is_copy: name.is_copy,
        });
        true
    }

    /// The printed form of a name.
    fn shown(&self, name: &Name) -> String {
        match self.apart.contains(&name.text) {
            true => seen_apart(&name.text, &self.time_index),
            false => seen(&name.text, &self.time_index),
        }
    }

    /// Prints the site of a copy in brackets if the copy would otherwise print like another name or like a sign of
    /// derivations. The user does not write the copy, and so cannot rename it.
    fn tell_apart(&mut self, name: &Name) {
        let shown = seen(&name.text, &self.time_index);
        let alike = |t: &UsedName| t.seen == shown;
        let sign = || PRINTED.into_iter().any(|sign| seen(sign, "") == shown);
        if name.is_copy {
            if self.taken.iter().any(alike) || sign() {
                self.apart.insert(name.text.clone());
            }
            return;
        }
        for copy in self
            .taken
            .iter_mut()
            .filter(|t| t.is_copy && t.seen == shown)
        {
            copy.seen = seen_apart(&copy.name, &self.time_index);
            self.apart.insert(copy.name.clone());
            for (latex, own) in &mut self.typeset {
                if own.text == copy.name && own.typeset.is_none() {
                    latex.clone_from(&copy.seen);
                }
            }
        }
    }

    /// Marks the name as used. Its printed form is computed here once; computing it for each comparison would
    /// dominate the work of a long list of parameters.
    pub(super) fn take(&mut self, name: &str, place: Place) {
        self.taken.push(UsedName {
            name: name.to_owned(),
            place,
            seen: seen(name, &self.time_index),
            ascii: ascii(name),
            is_copy: false,
        });
    }

    /// The printed form of a name in LaTeX formulas.
    fn in_latex(&self, name: &Name) -> String {
        match &name.typeset {
            Some((latex, _)) => seen_typeset(latex, &self.time_index),
            None => self.shown(name),
        }
    }

    /// The error if a name is typeset like another name. Uses of the name are not errors.
    fn typeset_as_another(&self, name: &Name) -> Option<Diagnostic> {
        let latex = self.in_latex(name);
        let text = &name.text;
        let help =
            "write another text after `as`: names must differ in print, not counting a time index";
        if let Some((shown, place)) = &name.typeset {
            let fixed = PRINTED.into_iter().find(|sign| seen(sign, "") == latex);
            let step = &self.symbols.get(self.step).name;
            let message = match fixed {
                Some(sign) => format!(
                    "`{shown}` prints like `{sign}`, which has a fixed meaning in derivations"
                ),
                None if seen(step, &self.time_index) == latex => {
                    format!("`{shown}` prints like the time step `{step}`")
                }
                None => String::new(),
            };
            if !message.is_empty() {
                return Some(Diagnostic::new(*place, message).help(help));
            }
        }
        let (_, other) = self.typeset.iter().find(|(l, _)| *l == latex)?;
        let place = |n: &Name| n.typeset.as_ref().map_or(n.place, |(_, place)| *place);
        let message = format!("`{text}` and `{}` look the same in LaTeX", other.text);
        let first = format!("`{}` is declared here", other.text);
        Some(
            Diagnostic::new(place(name), message)
                .help(help)
                .also(place(other), first),
        )
    }

    /// Whether the name was declared, successfully or not.
    pub fn was_declared(&self, text: &str) -> bool {
        self.taken.iter().any(|t| t.name == text)
    }

    /// The quantity that a constraint updates.
    pub fn slot(&self, name: &Name, errors: &mut Errors) -> Option<SymbolId> {
        let found = self.symbols.find(&name.text);
        let mut fields = self.configurations.iter().filter(|g| g.group.is_additive());
        if found.is_some_and(|id| fields.any(|g| g.element == id)) {
            errors.push(messages::constraint_of_field(&name.text, name.place));
            return None;
        }
        match found.map(|id| (id, self.symbols.get(id).role)) {
            Some((id, Role::Element | Role::Advected)) => Some(id),
            Some((_, Role::Velocity)) => {
                errors.push(
                    Diagnostic::new(
                        name.place,
                        format!(
                            "`{}` is a velocity: it belongs to one edge and has no evolution \
                        constraint",
                            name.text
                        ),
                    )
                    .help("write constraints for group elements and advected quantities"),
                );
                None
            }
            Some(_) => {
                errors.push(
                    Diagnostic::new(
                        name.place,
                        format!(
                            "`{}` is constant in time, so it has no evolution constraint",
                            name.text
                        ),
                    )
                    .help("declare it with `advected` if it moves with the group"),
                );
                None
            }
            None if self.was_declared(&name.text) => None,
            None => {
                let known = self.configurations.iter().map(|g| g.element);
                let known = known.chain(self.advected.iter().map(|a| a.quantity));
                let names: Vec<String> =
                    known.map(|id| self.symbols.get(id).name.clone()).collect();
                let mut e = Diagnostic::new(name.place, format!("`{}` is not declared", name.text));
                if let Some(near) = closest(&name.text, names.iter().map(String::as_str)) {
                    e = e.help(format!("did you mean `{near}`?"));
                } else {
                    e = e.help("declare it with `group` or `advected`");
                }
                errors.push(e);
                None
            }
        }
    }

    /// Marks the constraint of a quantity as declared, although it was faulty.
    pub fn mark_stated(&mut self, id: SymbolId) {
        for g in self.configurations.iter_mut().filter(|g| g.element == id) {
            g.stated = true;
        }
        for a in self.advected.iter_mut().filter(|a| a.quantity == id) {
            a.stated = true;
        }
    }

    /// Stores the right side of a constraint.
    pub fn set_update(&mut self, id: SymbolId, e: Expr, place: Place, errors: &mut Errors) {
        let name = self.symbols.get(id).name.clone();
        let groups = self.configurations.iter_mut().filter(|g| g.element == id);
        let slots = groups.map(|g| (&mut g.update, &mut g.stated));
        let advected = self.advected.iter_mut().filter(|a| a.quantity == id);
        let slots = slots.chain(advected.map(|a| (&mut a.update, &mut a.stated)));
        for (update, stated) in slots {
            *stated = true;
            match update {
                Some((_, first)) => errors.push(
                    Diagnostic::new(place, format!("`{name}` has two constraints"))
                        .also(*first, "the first constraint is here"),
                ),
                None => *update = Some((e.clone(), place)),
            }
        }
    }

    /// Stores the definition of an advected quantity.
    pub fn set_definition(&mut self, id: SymbolId, e: Expr, place: Place, errors: &mut Errors) {
        let allowed = crate::expr::letters(&e).iter().all(|l| {
            let role = self.symbols.get(l.symbol).role;
            l.shift == crate::expr::Shift::HERE && matches!(role, Role::Element | Role::Parameter)
        });
        if !allowed {
            errors.push(messages::definition_not_of_configuration(place));
        }
        for a in self.advected.iter_mut().filter(|a| a.quantity == id) {
            a.definition = Some((e.clone(), place));
        }
    }

    /// Reports configurations and advected quantities without a constraint.
    pub fn require_constraints(&self, errors: &mut Errors) {
        for g in self.configurations.iter().filter(|g| !g.stated) {
            errors.push(messages::missing_constraint(
                &self.symbols,
                g.element,
                g.velocity,
                g.place,
            ));
        }
        let turning = self.configurations.iter().find(|g| !g.group.is_additive());
        for a in self.advected.iter().filter(|a| !a.stated) {
            let (s, quantity) = (&self.symbols, a.quantity);
            errors.push(match (turning, self.configurations.first()) {
                (None, Some(field)) => {
                    messages::not_carried_by_field(s, quantity, field.element, a.place)
                }
                (turning, _) => {
                    let v = turning.map_or(quantity, |g| g.velocity);
                    messages::missing_constraint(s, quantity, v, a.place)
                }
            });
        }
    }
}
