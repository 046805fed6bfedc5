//! The labels that a model declares: chains and sets, the quantities at their sites, and the ends of a chain.
//! Mistakes that can be found before the model is expanded are reported here.

use super::mesh::Mesh;
use crate::diagnostic::{Diagnostic, Errors, Place, closest};
use crate::syntax::ast::{Alternative, At, Extent, Model, Name, Site, SizedName, Statement};
use std::collections::BTreeSet;

/// The kinds of sites of a label.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Sites {
    /// Nodes of a chain.
    Nodes,
    /// Segments of a chain; segment i joins nodes i and i+1.
    Segments,
    /// Members of a set.
    Members,
}

/// The kind of a quantity at sites.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    /// A constant of each site.
    Parameter,
    /// A configuration in a group, or a field.
    Configuration,
    /// The velocity of a configuration in a group.
    Velocity,
    /// An advected quantity.
    Advected,
    /// Values of a functional of all sites.
    Functional,
}

/// A label.
#[derive(Clone, Debug)]
pub struct Label {
    /// Its index.
    pub index: Name,
    /// The name of its number of segments or sites.
    pub count: Name,
    /// The name of its spacing.
    pub step: Option<Name>,
    /// Whether it is a set, without neighbours.
    pub set: bool,
    /// Whether its sites are the nodes of a grid.
    pub grid: bool,
}

/// A quantity at the sites of a label.
#[derive(Clone, Debug)]
pub struct Quantity {
    /// Its name.
    pub name: Name,
    /// Its label, by number.
    pub label: usize,
    /// The kind of sites that it is defined at.
    pub sites: Sites,
    /// Its kind.
    pub kind: Kind,
    /// Its shape or group.
    pub shape: SizedName,
    /// The amount by which it grows once around a ring.
    pub offset: Option<Name>,
    /// For positions of particles, the domain of its values.
    pub domain: Option<Extent>,
}

/// The labels of a model.
#[derive(Clone, Debug, Default)]
pub struct Lattice {
    /// All labels.
    pub labels: Vec<Label>,
    /// The label of the chain.
    pub line: Option<usize>,
    /// Where the chain is declared periodic.
    pub periodic: Option<Place>,
    /// The end conditions at the first and at the last site; if empty, the natural ones.
    pub ends: [Vec<Alternative>; 2],
    /// The quantities at sites.
    pub quantities: Vec<Quantity>,
    /// Functionals of all sites, each after the functionals that it depends on.
    pub meshes: Vec<Mesh>,
    /// Names of scalars, at sites or not.
    pub(super) numbers: BTreeSet<String>,
    /// Names of moving quantities, at sites or not.
    pub(super) moving: BTreeSet<String>,
    /// Velocities of groups, at sites or not.
    pub(super) velocities: BTreeSet<String>,
    /// All declared names.
    pub(super) declared: BTreeSet<String>,
}

/// The name of the end condition of a chain that declares none.
const NATURAL: &str = "free";

/// Names that suggest a prescribed end. An end condition that states nothing cannot have such a name.
const HOLDING: [&str; 6] = ["clamped", "closed", "fixed", "held", "pinned", "wall"];

impl Lattice {
    /// The end conditions at the first or the last site, by name.
    pub fn alternatives(&self, last: bool) -> Vec<String> {
        let [first, at_last] = &self.ends;
        let list = if last { at_last } else { first };
        match list.is_empty() {
            true => vec![NATURAL.to_owned()],
            false => list.iter().map(|a| a.name.text.clone()).collect(),
        }
    }

    /// The quantity with this name.
    pub fn find(&self, name: &str) -> Option<&Quantity> {
        self.quantities.iter().find(|q| q.name.text == name)
    }

    /// The quantity of which a name in the expanded model is a copy. `q_1` is the copy of `q` at site 1 even if another
    /// quantity at sites has that name, since only copies of that quantity occur in the expanded model.
    pub(super) fn of_copy(&self, name: &str) -> Option<&Quantity> {
        if self.declared.contains(name) && self.find(name).is_none() {
            return None;
        }
        let (base, site) = name.rsplit_once('_')?;
        site.parse::<usize>().ok()?;
        self.find(base)
    }

    /// The field whose values lie in a domain, that is, the particle positions.
    pub fn places(&self) -> Option<&Quantity> {
        self.quantities.iter().find(|q| q.domain.is_some())
    }

    /// The grid.
    pub fn grid(&self) -> Option<&Label> {
        self.labels.iter().find(|l| l.grid)
    }

    /// Whether the sites of a label are the nodes of the grid.
    pub fn is_grid(&self, label: usize) -> bool {
        self.labels.get(label).is_some_and(|l| l.grid)
    }

    /// The label of the chain.
    pub fn line_label(&self) -> Option<&Label> {
        self.line.and_then(|i| self.labels.get(i))
    }

    /// Reads the declarations of a model.
    pub fn read(model: &Model) -> Result<Lattice, Errors> {
        let mut errors = Errors::new();
        let mut out = Lattice::default();
        out.labels(model, &mut errors);
        out.names(model);
        for statement in &model.statements {
            out.statement(statement, &mut errors);
        }
        out.functionals(model, &mut errors);
        out.check_ends(model, &mut errors);
        out.check_names(model, &mut errors);
        errors.propagate()?;
        Ok(out)
    }

    fn labels(&mut self, model: &Model, errors: &mut Errors) {
        let sets = model.statements.iter().filter_map(|s| match at_of(s) {
            Some(At {
                site: Site::Set(name),
                ..
            }) => Some(name.text.clone()),
            _ => None,
        });
        let sets: BTreeSet<String> = sets.collect();
        for statement in &model.statements {
            if let Statement::Grid(name) = statement {
                let known = self
                    .labels
                    .iter()
                    .find(|l| l.index.text == name.text || l.count.text == name.text);
                if let Some(first) = known {
                    let d =
                        Diagnostic::new(name.place, format!("`{}` is declared twice", name.text));
                    errors.push(d.also(first.index.place, "it is declared here first"));
                    continue;
                }
                self.labels.push(Label {
                    index: name.clone(),
                    count: name.clone(),
                    step: None,
                    set: true,
                    grid: true,
                });
                continue;
            }
            let Statement::Label { index, count, step } = statement else {
                continue;
            };
            let names = |l: &Label| [l.index.clone(), l.count.clone()];
            let mut taken = self.labels.iter().flat_map(names);
            if let Some(first) = taken.find(|n| n.text == index.text || n.text == count.text) {
                let d = Diagnostic::new(
                    index.place.to(count.place),
                    format!("`{}` is declared twice", first.text),
                );
                errors.push(d.also(
                    first.place,
                    format!("`{}` is declared here first", first.text),
                ));
                continue;
            }
            if index.text == count.text {
                let d = Diagnostic::new(count.place, "the index and the count have the same name");
                errors.push(d.help("write for example `label i in 0..N;`"));
            }
            let set = sets.contains(&index.text);
            if !set && let Some(line) = self.line_label() {
                let message = format!(
                    "a model has at most one chain of nodes and segments, and `{}` is one already",
                    line.index.text
                );
                let d = Diagnostic::new(index.place, message).help(format!(
                    "for a set of sites without neighbours, declare quantities `at {}`",
                    index.text
                ));
                errors.push(d.also(line.index.place, "the chain is declared here"));
                continue;
            }
            if let (true, Some(step)) = (set, step) {
                let d = Diagnostic::new(step.place, "a set of sites has no spacing");
                errors.push(d.help("remove `step ...`"));
            }
            if !set {
                self.line = Some(self.labels.len());
            }
            self.labels.push(Label {
                index: index.clone(),
                count: count.clone(),
                step: step.clone(),
                set,
                grid: false,
            });
        }
    }

    /// Collects the names of scalars and of moving quantities.
    fn names(&mut self, model: &Model) {
        let mut time_step = "h".to_owned();
        for statement in &model.statements {
            match statement {
                Statement::Time { step, .. } => time_step.clone_from(&step.text),
                Statement::Label {
                    step: Some(step), ..
                } => {
                    self.numbers.insert(step.text.clone());
                }
                Statement::Param { names, shape, .. } => self.shaped(names, shape),
                Statement::Mesh { name, shape, .. } => {
                    self.shaped(std::slice::from_ref(name), shape);
                    self.moving.insert(name.text.clone());
                }
                Statement::Field {
                    names,
                    shape,
                    offset,
                    domain,
                    ..
                } => {
                    self.shaped(names, shape);
                    self.shaped(offset.as_slice(), shape);
                    if let Some(Extent::Torus(lengths)) = domain {
                        self.shaped(std::slice::from_ref(lengths), shape);
                    }
                    self.moving.extend(names.iter().map(|n| n.text.clone()));
                }
                Statement::Advected { names, shape, .. } => {
                    self.shaped(names, shape);
                    self.moving.extend(names.iter().map(|n| n.text.clone()));
                }
                Statement::Group { name, velocity, .. } => {
                    self.moving.insert(name.text.clone());
                    self.moving.insert(velocity.text.clone());
                    self.velocities.insert(velocity.text.clone());
                }
                Statement::End { alternatives, .. } => {
                    for (names, shape) in alternatives.iter().flat_map(|a| &a.params) {
                        self.shaped(names, shape);
                    }
                }
                _ => {}
            }
        }
        self.numbers.insert(time_step);
    }

    fn shaped(&mut self, names: &[Name], shape: &SizedName) {
        if shape.name.text == "Real" {
            self.numbers.extend(names.iter().map(|n| n.text.clone()));
        }
    }

    fn statement(&mut self, statement: &Statement, errors: &mut Errors) {
        match statement {
            Statement::Param { names, shape, at } => {
                self.quantities_at(names, shape, at.as_ref(), Kind::Parameter, errors);
            }
            Statement::Advected {
                names, shape, at, ..
            } => self.quantities_at(names, shape, at.as_ref(), Kind::Advected, errors),
            Statement::Field {
                names,
                shape,
                at,
                offset,
                domain,
            } => {
                let before = self.quantities.len();
                self.quantities_at(names, shape, at.as_ref(), Kind::Configuration, errors);
                for q in self.quantities.iter_mut().skip(before) {
                    q.domain.clone_from(domain);
                }
                let Some(offset) = offset else { return };
                let added = self.quantities.iter_mut().skip(before);
                let mut on_line = false;
                for q in added.filter(|q| q.sites != Sites::Members) {
                    q.offset = Some(offset.clone());
                    on_line = true;
                }
                let known = at.as_ref().is_none_or(|at| self.knows(at));
                if !on_line && known {
                    let d =
                        Diagnostic::new(offset.place, "only a field on a chain can have an offset");
                    errors.push(d.help("write for example `field X: Real at nodes offset L;`"));
                }
            }
            Statement::Group {
                name,
                group,
                at,
                velocity,
            } => {
                let one = std::slice::from_ref;
                self.quantities_at(one(name), group, at.as_ref(), Kind::Configuration, errors);
                let mut again = Errors::new();
                self.quantities_at(
                    one(velocity),
                    group,
                    at.as_ref(),
                    Kind::Velocity,
                    &mut again,
                );
            }
            Statement::Periodic(place) => {
                if self.line.is_none() {
                    let d =
                        Diagnostic::new(*place, "the model has no chain that could be periodic");
                    errors.push(d.help("declare a chain: `label i in 0..N;`"));
                }
                if let Some(first) = self.periodic {
                    let d = Diagnostic::new(*place, "`periodic` is stated twice");
                    errors.push(d.also(first, "it is stated here first"));
                }
                self.periodic = Some(*place);
            }
            Statement::End {
                label,
                at,
                alternatives,
            } => self.end(label, at, alternatives, errors),
            _ => {}
        }
    }

    pub(super) fn quantities_at(
        &mut self,
        names: &[Name],
        shape: &SizedName,
        at: Option<&At>,
        kind: Kind,
        errors: &mut Errors,
    ) {
        let Some(at) = at else { return };
        let (label, sites) = match &at.site {
            Site::Nodes => (self.line, Sites::Nodes),
            Site::Segments => (self.line, Sites::Segments),
            Site::Set(name) => {
                let own = |l: &Label| l.index.text == name.text;
                (self.labels.iter().position(own), Sites::Members)
            }
        };
        let Some(label) = label else {
            errors.push(self.unknown_site(at));
            return;
        };
        for name in names {
            self.quantities.push(Quantity {
                name: name.clone(),
                label,
                sites,
                kind,
                shape: shape.clone(),
                offset: None,
                domain: None,
            });
        }
    }

    /// Whether the model has sites of this kind.
    fn knows(&self, at: &At) -> bool {
        match &at.site {
            Site::Nodes | Site::Segments => self.line.is_some(),
            Site::Set(name) => self.labels.iter().any(|l| l.index.text == name.text),
        }
    }

    fn unknown_site(&self, at: &At) -> Diagnostic {
        let Site::Set(name) = &at.site else {
            return Diagnostic::new(at.place, "the model has no chain of nodes and segments")
                .help("declare a chain: `label i in 0..N;`");
        };
        let d = Diagnostic::new(at.place, format!("`{}` is not a label", name.text));
        let known = self.labels.iter().map(|l| l.index.text.as_str());
        let words = ["nodes", "segments"].into_iter();
        match closest(&name.text, known.chain(words)) {
            Some(near) => d.help(format!("did you mean `at {near}`?")),
            None => d.help(format!(
                "write `nodes` or `segments` of a chain, or the label of a set of sites: `label {} in 0..N;`",
                name.text
            )),
        }
    }

    fn end(&mut self, label: &Name, at: &Name, alternatives: &[Alternative], errors: &mut Errors) {
        let Some(line) = self.line_label() else {
            let d = Diagnostic::new(label.place, "the model has no chain that could have an end");
            errors.push(d.help("declare a chain: `label i in 0..N;`"));
            return;
        };
        if line.index.text != label.text {
            let message = format!(
                "the label of the chain is `{}`, not `{}`",
                line.index.text, label.text
            );
            errors.push(Diagnostic::new(label.place, message));
            return;
        }
        let last = match at.text.as_str() {
            "0" => false,
            n if n == line.count.text => true,
            _ => {
                let (i, n) = (&line.index.text, &line.count.text);
                let d = Diagnostic::new(at.place, format!("the ends of the chain are 0 and {n}"));
                errors.push(d.help(format!("write `end {i} = 0` or `end {i} = {n}`")));
                return;
            }
        };
        let mut names: Vec<&Name> = Vec::new();
        for a in alternatives {
            if let Some(first) = names.iter().find(|n| n.text == a.name.text) {
                let message = format!("`{}` is declared twice at this end", a.name.text);
                let d = Diagnostic::new(a.name.place, message);
                errors.push(d.also(first.place, "it is declared here first"));
            }
            if a.name.text == "periodic" {
                let d = Diagnostic::new(a.name.place, "a ring has no end");
                errors.push(d.help("write `periodic;` in addition to the ends; the case chooses"));
            }
            names.push(&a.name);
        }
        let list = &mut self.ends[usize::from(last)];
        if !list.is_empty() {
            let message = "the conditions of this end are stated twice";
            errors.push(Diagnostic::new(at.place, message).help("list them in one `end` block"));
            return;
        }
        if alternatives.is_empty() {
            let d = Diagnostic::new(at.place, "this end has no condition");
            errors.push(d.help("write `free;` for the natural end condition, or remove the block"));
        }
        *list = alternatives.to_vec();
    }

    /// Parameters of end conditions, indices and numbers of sites must not reuse other names.
    fn check_names(&mut self, model: &Model, errors: &mut Errors) {
        let known: Vec<&Name> = model
            .statements
            .iter()
            .flat_map(Statement::declared)
            .collect();
        self.declared = known.iter().map(|n| n.text.clone()).collect();
        let ends = self.ends.iter().flatten();
        let own = ends.flat_map(|a| &a.params).flat_map(|(names, _)| names);
        let labels = self.labels.iter().flat_map(|l| match l.grid {
            true => vec![&l.index],
            false => vec![&l.index, &l.count],
        });
        for name in own.chain(labels) {
            if let Some(first) = known.iter().find(|k| k.text == name.text) {
                let message = format!("`{}` is declared twice", name.text);
                let d = Diagnostic::new(name.place, message);
                errors.push(d.also(
                    first.place,
                    format!("`{}` is also declared here", name.text),
                ));
            }
        }
    }

    /// Checks that ends prescribe configurations only, and that an end with a name such as `pinned` states something.
    fn check_ends(&self, model: &Model, errors: &mut Errors) {
        for alternative in self.ends.iter().flatten() {
            let name = &alternative.name;
            let states = !alternative.given.is_empty() || !alternative.terms.is_empty();
            if !states && HOLDING.contains(&name.text.as_str()) {
                let message = format!(
                    "`{}` prescribes nothing, and such an end is free",
                    name.text
                );
                errors.push(Diagnostic::new(name.place, message).help(format!(
                    "say what the case prescribes, `{} {{ q = given; }}`, or name the condition `free`",
                    name.text
                )));
            }
            for name in &alternative.given {
                let kind = self.find(&name.text).map(|q| (q.kind, q.sites));
                let message = match kind {
                    Some((Kind::Configuration, Sites::Nodes | Sites::Segments)) => continue,
                    Some((Kind::Velocity, _)) => format!(
                        "`{}` is a velocity: prescribe the configuration; its velocity then vanishes",
                        name.text
                    ),
                    Some((Kind::Advected, _)) => {
                        format!(
                            "`{}` follows from its configuration: prescribe the configuration",
                            name.text
                        )
                    }
                    Some(_) => format!("`{}` is not a configuration", name.text),
                    None => format!("`{}` is not a quantity of the chain", name.text),
                };
                let known = self.quantities.iter();
                let known = known.filter(|q| q.kind == Kind::Configuration);
                let known: Vec<String> = known.map(|q| format!("`{}`", q.name.text)).collect();
                let d = Diagnostic::new(name.place, message);
                let d = match elsewhere(model, name) {
                    Some(stated) => d.help(format!("write `{stated}`")),
                    None => d,
                };
                errors.push(match known.is_empty() {
                    true => d,
                    false => d.help(format!("configurations on the chain: {}", known.join(", "))),
                });
            }
        }
    }
}

/// The statement, rewritten at nodes, of a configuration that is declared without sites; `None` for other names.
fn elsewhere(model: &Model, name: &Name) -> Option<String> {
    model.statements.iter().find_map(|s| match s {
        Statement::Field {
            names,
            shape,
            at: None,
            ..
        } if names.iter().any(|own| own.text == name.text) => {
            Some(format!("field {}: {} at nodes;", name.text, shape.text()))
        }
        Statement::Group {
            name: own,
            group,
            at: None,
            velocity,
        } if own.text == name.text => Some(format!(
            "group {}: {} at nodes velocity {};",
            own.text,
            group.text(),
            velocity.text
        )),
        _ => None,
    })
}

/// The sites of what a statement declares.
fn at_of(statement: &Statement) -> Option<&At> {
    match statement {
        Statement::Param { at, .. }
        | Statement::Group { at, .. }
        | Statement::Field { at, .. }
        | Statement::Mesh { at, .. }
        | Statement::Advected { at, .. } => at.as_ref(),
        _ => None,
    }
}
