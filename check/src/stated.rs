//! The statements of a model, by name: quantities, constraints, end conditions, the Lagrangian with its definitions
//! substituted. Takes a syntax tree; gives the sorted statements, or the reason why they cannot be judged.

use crate::expression::{Expression, Kind};
use crate::group::Group;
use crate::lets::Lets;
pub use crate::records::{End, Hold, Layout, Quantity, Role, Side, Sites, Stated};
use crate::terms::Terms;
use clebsch_core::syntax::ast::{At, Model, NodeRule, Site, Size, SizedName, Statement};
use std::collections::{BTreeMap, BTreeSet};

impl Stated {
    /// Reads a model.
    ///
    /// # Errors
    /// The part of the model that cannot be judged.
    pub fn read(model: &Model, sizes: &[(String, usize)]) -> Result<Self, String> {
        let mut out = Self {
            quantities: BTreeMap::new(),
            velocities: BTreeMap::new(),
            step: "h".to_owned(),
            sizes: sizes.iter().cloned().collect(),
            functions: BTreeMap::new(),
            labels: Vec::new(),
            terms: Vec::new(),
            scale: None,
            rule: NodeRule::Symmetric,
            holds: Vec::new(),
            ends: [Vec::new(), Vec::new()],
            line: None,
            functionals: BTreeSet::new(),
        };
        out.labels = labels(model);
        for statement in &model.statements {
            out.declare(statement)?;
        }
        let lets = Lets::of(model, &out.sizes);
        for statement in &model.statements {
            out.constrain(statement, &lets)?;
        }
        for statement in &model.statements {
            out.state(statement, &lets)?;
        }
        Ok(out)
    }

    fn declare(&mut self, statement: &Statement) -> Result<(), String> {
        match statement {
            Statement::Time { step, .. } => self.step.clone_from(&step.text),
            Statement::Label {
                step: Some(step), ..
            } => self.add(&step.text, Role::Parameter, None, true, false),
            Statement::Mesh { name, .. } => {
                self.functionals.insert(name.text.clone());
            }
            Statement::Param { names, shape, at } => {
                let at = self.place(at.as_ref())?;
                for name in names {
                    let (number, quaternion) = kind(shape);
                    self.add(&name.text, Role::Parameter, at, number, quaternion);
                }
            }
            Statement::Group {
                name,
                group,
                at,
                velocity,
            } => {
                let at = self.place(at.as_ref())?;
                let group = Group::read(&group.name.text, self.size(group)?)?;
                let role = Role::Element(group, Side::Body);
                self.add(&name.text, role, at, false, group == Group::Quaternion);
                let (velocity, name) = (velocity.text.clone(), name.text.clone());
                self.velocities.insert(velocity, name);
            }
            Statement::Field {
                names,
                shape,
                at,
                offset,
                ..
            } => {
                let at = self.place(at.as_ref())?;
                let layout = match shape.name.text.as_str() {
                    "Diag" => Layout::Diagonal,
                    "Sym" => Layout::Symmetric,
                    "Skew" => Layout::Skew,
                    _ => Layout::Entries,
                };
                for name in names {
                    self.add(&name.text, Role::Field(layout), at, kind(shape).0, false);
                    if let (Some(q), Some(offset)) = (self.quantities.get_mut(&name.text), offset) {
                        q.offset = Some(offset.text.clone());
                    }
                }
                if let Some(offset) = offset {
                    self.add(&offset.text, Role::Parameter, None, kind(shape).0, false);
                }
            }
            Statement::Advected {
                names, shape, at, ..
            } => {
                let at = self.place(at.as_ref())?;
                for name in names {
                    let (number, quaternion) = kind(shape);
                    self.add(&name.text, Role::Advected, at, number, quaternion);
                }
            }
            Statement::Given {
                name,
                path,
                components,
                ..
            } if components.is_empty() => {
                self.functions.insert(name.text.clone(), path.text.clone());
            }
            Statement::End { alternatives, .. } => {
                for (names, shape) in alternatives.iter().flat_map(|a| &a.params) {
                    for name in names {
                        let (number, quaternion) = kind(shape);
                        self.add(&name.text, Role::Parameter, None, number, quaternion);
                    }
                }
            }
            Statement::Node(rule, _) => self.rule = *rule,
            _ => {}
        }
        Ok(())
    }

    fn add(
        &mut self,
        name: &str,
        role: Role,
        at: Option<(usize, Sites)>,
        is_number: bool,
        is_quaternion: bool,
    ) {
        let quantity = Quantity {
            name: name.to_owned(),
            role,
            at,
            offset: None,
            update: None,
            definition: None,
            is_number,
            is_quaternion,
        };
        // A parameter of several ends is a single quantity.
        self.quantities.entry(name.to_owned()).or_insert(quantity);
    }

    fn place(&mut self, at: Option<&At>) -> Result<Option<(usize, Sites)>, String> {
        let Some(at) = at else { return Ok(None) };
        Ok(Some(match &at.site {
            Site::Set(name) => {
                let found = self.labels.iter().position(|l| *l == name.text);
                let label = found.ok_or_else(|| format!("`{}` is not a label", name.text))?;
                (label, Sites::Nodes)
            }
            line => {
                let label = self.line.or_else(|| (self.labels.len() == 1).then_some(0));
                let label =
                    label.ok_or("several labels in addition to a chain are not supported here")?;
                self.line = Some(label);
                match line {
                    Site::Segments => (label, Sites::Segments),
                    _ => (label, Sites::Nodes),
                }
            }
        }))
    }

    /// The size of a shape with one size.
    fn size(&self, shape: &SizedName) -> Result<usize, String> {
        match shape.sizes.first() {
            Some(Size::Number(n, _)) => usize::try_from(*n).map_err(|e| e.to_string()),
            Some(Size::Name(name)) => {
                let size = self.sizes.get(&name.text).copied();
                size.ok_or_else(|| format!("the size `{}` is unknown", name.text))
            }
            None => Ok(1),
        }
    }

    fn constrain(&mut self, statement: &Statement, lets: &Lets) -> Result<(), String> {
        match statement {
            Statement::Constraint { name, value, .. } => {
                let value = lets.put(value)?;
                let velocities = &self.velocities;
                let Some(q) = self.quantities.get_mut(&name.text) else {
                    return Err(format!("`{}` is not declared", name.text));
                };
                match &mut q.role {
                    Role::Element(_, side) => *side = side_of(&value, &name.text, velocities)?,
                    _ => q.update = Some(value),
                }
            }
            Statement::Advected {
                names,
                definition: Some(value),
                ..
            } => {
                let value = lets.put(value)?;
                for name in names {
                    if let Some(q) = self.quantities.get_mut(&name.text) {
                        q.definition = Some(value.clone());
                    }
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn state(&mut self, statement: &Statement, lets: &Lets) -> Result<(), String> {
        match statement {
            Statement::Scale(value) => self.scale = Some(lets.put(value)?),
            Statement::Lagrangian(value) => {
                let value = lets.put(value)?;
                self.terms = Terms::of(self).of_lagrangian(&value)?;
            }
            Statement::Hold {
                name, left, right, ..
            } => {
                let both = vec![(false, lets.put(left)?), (true, lets.put(right)?)];
                let value = Expression {
                    kind: Kind::Sum(both),
                };
                let mut of_sums = false;
                value.each(&mut |e| {
                    of_sums |= matches!(&e.kind, Kind::Call(f, _) if f == "sum");
                });
                let value = Terms::of(self).whole(value)?;
                let name = name.text.clone();
                self.holds.push(Hold {
                    name,
                    value,
                    of_sums,
                });
            }
            Statement::End {
                at, alternatives, ..
            } => {
                for one in alternatives {
                    let mut terms = Vec::new();
                    for term in &one.terms {
                        let term = lets.put(term)?;
                        terms.extend(Terms::of(self).of_end(&term)?);
                    }
                    let names = one.params.iter().flat_map(|(names, _)| names);
                    self.ends[usize::from(at.text != "0")].push(End {
                        name: one.name.text.clone(),
                        params: names.map(|n| n.text.clone()).collect(),
                        given: one.given.iter().map(|n| n.text.clone()).collect(),
                        terms,
                    });
                }
            }
            _ => {}
        }
        Ok(())
    }
}

fn labels(model: &Model) -> Vec<String> {
    let each = model.statements.iter().filter_map(|s| match s {
        Statement::Label { index, .. } => Some(index.text.clone()),
        Statement::Grid(index) => Some(index.text.clone()),
        _ => None,
    });
    each.collect()
}

/// Whether a shape is a number, and whether it is a quaternion.
fn kind(shape: &SizedName) -> (bool, bool) {
    let name = shape.name.text.as_str();
    (name == "Real", name == "SU")
}

/// The side of the element on which the velocity acts.
fn side_of(
    value: &Expression,
    element: &str,
    velocities: &BTreeMap<String, String>,
) -> Result<Side, String> {
    let is_element = |e: &Expression| matches!(&e.kind, Kind::Name(n) if n == element);
    let is_velocity = |e: &Expression| matches!(&e.kind, Kind::Name(n) if velocities.get(n).is_some_and(|of| of == element));
    match &value.kind {
        Kind::Product(list) => match list.as_slice() {
            [a, b] if is_element(a) && is_velocity(b) => Ok(Side::Body),
            [a, b] if is_velocity(a) && is_element(b) => Ok(Side::Space),
            _ => Err(format!(
                "the constraint of `{element}` is not a product of the configuration and its velocity"
            )),
        },
        _ => Err(format!("the constraint of `{element}` is not a product")),
    }
}
