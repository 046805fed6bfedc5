//! What a model states, by name: quantities, constraints, end conditions, the Lagrangian with its definitions put in.
//! Takes a syntax tree; gives the statements sorted, or why they cannot be judged.

use crate::expression::{Expression, Kind, Sizes as Dimensions};
use crate::group::Group;
use crate::terms::{Term, Terms};
use clebsch_core::syntax::ast::{self, At, Kindred, Model, NodeRule, Site, Size, Statement};
use std::collections::BTreeMap;

/// How deep definitions may stand in one another.
const DEEPEST: usize = 64;

/// Where a quantity lives along a label.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Sites {
    /// At nodes of the line, or at the members of a set.
    Nodes,
    /// At segments.
    Segments,
}

/// On which side of an element its velocity stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// `next(R) = R*O`.
    Body,
    /// `next(R) = O*R`.
    Space,
}

/// What a quantity is.
#[derive(Clone, Debug)]
pub enum Role {
    /// Constant.
    Parameter,
    /// An element of a group, with the side of its velocity.
    Element(Group, Side),
    /// Values that are added.
    Field(Layout),
    /// Carried by the configurations.
    Advected,
}

/// How a field is kept as numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Entry by entry.
    Entries,
    /// The diagonal of a matrix.
    Diagonal,
    /// The entries on and above the diagonal, by rows.
    Symmetric,
    /// An axial vector, or the entries below the diagonal.
    Skew,
}

/// A quantity of the model.
#[derive(Clone, Debug)]
pub struct Quantity {
    /// Its name.
    pub name: String,
    /// What it is.
    pub role: Role,
    /// The label that it lives along, by its number, and at which sites.
    pub at: Option<(usize, Sites)>,
    /// The parameter by which it grows around a ring.
    pub offset: Option<String>,
    /// How it goes on, of what is advected.
    pub update: Option<Expression>,
    /// What it is, of what is advected by definition.
    pub definition: Option<Expression>,
    /// Whether it is a number.
    pub is_number: bool,
    /// Whether its four rows are those of a quaternion.
    pub is_quaternion: bool,
}

/// A way to end a line.
#[derive(Clone, Debug)]
pub struct End {
    /// Its name.
    pub name: String,
    /// Parameters of its own, and whether each is a quaternion.
    pub params: Vec<String>,
    /// Configurations that are given.
    pub given: Vec<String>,
    /// Terms that it adds.
    pub terms: Vec<Term>,
}

/// A constraint that is held: zero, and the sites that it is counted over.
#[derive(Clone, Debug)]
pub struct Hold {
    /// The name of its multiplier.
    pub name: String,
    /// Left side less right side.
    pub value: Term,
    /// Whether it holds sums over sites.
    pub of_sums: bool,
}

/// A model, sorted.
#[derive(Clone, Debug)]
pub struct Stated {
    /// Quantities by name.
    pub quantities: BTreeMap<String, Quantity>,
    /// The element of each velocity.
    pub velocities: BTreeMap<String, String>,
    /// The name of the step.
    pub step: String,
    /// Sizes by name.
    pub sizes: BTreeMap<String, usize>,
    /// Functions by path of Rust.
    pub functions: BTreeMap<String, String>,
    /// The index of each label.
    pub labels: Vec<String>,
    /// The terms of the Lagrangian.
    pub terms: Vec<Term>,
    /// By what the typed Lagrangian is divided.
    pub scale: Option<Expression>,
    /// The node rule.
    pub rule: NodeRule,
    /// What is held.
    pub holds: Vec<Hold>,
    /// End conditions at the first and at the last site.
    pub ends: [Vec<End>; 2],
    /// Whether there is a line, by the number of its label.
    pub line: Option<usize>,
}

impl Stated {
    /// Reads a model.
    ///
    /// # Errors
    /// What of it cannot be judged.
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
            Statement::Grid(_) | Statement::Mesh { .. } => {
                return Err("functionals of all sites are not evaluated here".to_owned());
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
        // A parameter of several ends is one.
        self.quantities.entry(name.to_owned()).or_insert(quantity);
    }

    fn place(&mut self, at: Option<&At>) -> Result<Option<(usize, Sites)>, String> {
        let Some(at) = at else { return Ok(None) };
        Ok(Some(match &at.site {
            Site::Set(name) => {
                let found = self.labels.iter().position(|l| *l == name.text);
                let label = found.ok_or_else(|| format!("`{}` is no label", name.text))?;
                (label, Sites::Nodes)
            }
            line => {
                let label = self.line.or_else(|| (self.labels.len() == 1).then_some(0));
                let label = label.ok_or("several labels beside a line are not read here")?;
                self.line = Some(label);
                match line {
                    Site::Segments => (label, Sites::Segments),
                    _ => (label, Sites::Nodes),
                }
            }
        }))
    }

    /// The size of a shape with one size.
    fn size(&self, shape: &Kindred) -> Result<usize, String> {
        match shape.sizes.first() {
            Some(Size::Number(n, _)) => usize::try_from(*n).map_err(|e| e.to_string()),
            Some(Size::Name(name)) => {
                let size = self.sizes.get(&name.text).copied();
                size.ok_or_else(|| format!("the size `{}` is not known", name.text))
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
        _ => None,
    });
    each.collect()
}

/// Whether a shape is a number, and whether it is that of quaternions.
fn kind(shape: &Kindred) -> (bool, bool) {
    let name = shape.name.text.as_str();
    (name == "Real", name == "SU")
}

/// On which side of the element the velocity stands.
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
                "the constraint of `{element}` is no product of it and its velocity"
            )),
        },
        _ => Err(format!("the constraint of `{element}` is no product")),
    }
}

/// Definitions by name, and sizes by name.
struct Lets(BTreeMap<String, Expression>, Dimensions);

impl Lets {
    fn of(model: &Model, sizes: &Dimensions) -> Self {
        let each = model.statements.iter().filter_map(|s| match s {
            Statement::Let { name, value } => {
                Some((name.text.clone(), Expression::of(value, sizes)))
            }
            _ => None,
        });
        Self(each.collect(), sizes.clone())
    }

    /// An expression with definitions put in, to the last one.
    fn put(&self, e: &ast::Expression) -> Result<Expression, String> {
        let mut out = Expression::of(e, &self.1);
        for _ in 0..DEEPEST {
            let mut there = false;
            out.each(&mut |e| {
                there |= matches!(&e.kind, Kind::Name(n) if self.0.contains_key(n));
            });
            if !there {
                return Ok(out);
            }
            out.replace(&|e| match &e.kind {
                Kind::Name(n) => self.0.get(n).cloned(),
                _ => None,
            });
        }
        Err("definitions stand in one another too deep".to_owned())
    }
}
