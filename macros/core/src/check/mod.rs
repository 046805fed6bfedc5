//! Checks the syntax tree and turns it into a typed specification: names, shapes, sides of actions. Every error names
//! the token and the remedy. After this stage, the only mistake left to find is an action that the certificate
//! rejects.

mod declare;
mod elaborate;
mod entries;
mod functional;
mod hold;
mod lets;
mod members;
mod messages;
mod names;
mod shapes;
pub mod spec;
#[cfg(test)]
mod tests;

use crate::diagnostic::{Diagnostic, Errors, Place};
use crate::expr::shape::{Shape, Structure};
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Letter, Shift};
use crate::syntax::ast::{Expression, Model, NodeRule, SizedName, Statement};
use crate::{schedule, work};
pub(crate) use members::name_of_function;
pub(crate) use names::is_rust_word;

use declare::Declared;
use elaborate::Elaborator;
pub(crate) use messages::unused_velocity;
use spec::{Advected, Assumption, Configuration, Hold, Side, Spec, Subject};

/// The largest expression tree that the derivation accepts.
const LARGEST: u32 = 1_000;

/// The origin of a model, which determines its requirements.
#[derive(Clone, Copy, PartialEq)]
enum Extent {
    /// Declared by the user.
    Stated,
    /// An expanded chain, whose size was limited when it was expanded.
    WrittenOut,
    /// One site of a chain without its neighbours: terms of neighbours may contain all its velocities.
    Site,
}

/// Checks a model. The work is limited; a model that exceeds the limit is rejected.
pub fn check(model: &Model) -> Result<Spec, Errors> {
    counted(model, Extent::Stated)
}

/// Checks an expanded chain, whose size was limited when it was expanded. If several copies have the same mistake,
/// only the first is reported. Configurations [`without_velocity`] are left to the caller, who knows their sites.
pub fn check_written_out(model: &Model) -> Result<Spec, Errors> {
    counted(model, Extent::WrittenOut).map_err(Errors::first_at_each_place)
}

/// Checks the model of one site of a chain. The Lagrangian of the site need not contain the velocities of its
/// configurations.
pub fn check_site(model: &Model) -> Result<Spec, Errors> {
    counted(model, Extent::Site).map_err(Errors::first_at_each_place)
}

fn counted(model: &Model, extent: Extent) -> Result<Spec, Errors> {
    let _count = work::Count::begin();
    let checked = checked(model, extent);
    match work::exhausted() {
        true => Err(messages::too_much_work(model.name.place, work::excess()).into()),
        false => checked,
    }
}

/// Reports circular definitions.
pub fn circular_definitions(model: &Model, errors: &mut Errors) {
    lets::circular(model, errors);
}

/// The names of unused definitions.
pub fn unused_definitions(model: &Model) -> Vec<(String, Place)> {
    let unused = lets::unused(model).into_iter();
    unused.map(|n| (n.text.clone(), n.place)).collect()
}

/// Elaborates scalar expressions with the names of a model; `None` for an expression that is not scalar.
pub fn numbers(model: &Model, list: &[&Expression]) -> Vec<Option<Expr>> {
    let names = declare::declare(model, &mut Errors::new());
    let elaborator = Elaborator::new(&names, Vec::new());
    list.iter().map(|e| elaborator.number(e).ok()).collect()
}

/// Elaborates two expressions of equal shape with the names of a model.
pub fn sides(model: &Model, a: &Expression, b: &Expression) -> Option<(Expr, Expr)> {
    let names = declare::declare(model, &mut Errors::new());
    Elaborator::new(&names, Vec::new()).pair(a, b).ok()
}

/// Whether two expressions are equal, with the names of a model; `false` if their shapes differ.
pub fn are_same(model: &Model, a: &Expression, b: &Expression) -> bool {
    let names = declare::declare(model, &mut Errors::new());
    let both = Elaborator::new(&names, Vec::new()).pair(a, b);
    both.is_ok_and(|(a, b)| crate::algebra::Algebra::new(&names.symbols).equal(&a, &b))
}

/// The declared shape of a parameter, if it is valid.
pub fn parameter_shape(symbols: &Symbols, declared: &SizedName) -> Option<(Shape, Structure)> {
    shapes::shape(symbols, declared, &mut Errors::new())
}

fn checked(model: &Model, extent: Extent) -> Result<Spec, Errors> {
    let largest = match extent {
        Extent::Stated => LARGEST,
        Extent::WrittenOut | Extent::Site => u32::MAX,
    };
    let mut errors = Errors::new();
    let mut declared = declare::declare(model, &mut errors);
    members::refuse(&declared, &mut errors);
    let names = declared.clone();
    let lets = model.statements.iter().filter_map(|s| match s {
        Statement::Let { name, .. } => Some(name.text.clone()),
        _ => None,
    });
    let lets: Vec<String> = lets.collect();
    let mut elaborator = Elaborator::new(&names, lets.clone());
    let circular = lets::circular(model, &mut errors);
    circular.iter().for_each(|name| elaborator.spoil(name));
    let mut typed: Option<(Expr, Place)> = None;
    let mut scale = None;
    let mut assumptions = Vec::new();
    let mut node_rule = NodeRule::Symmetric;
    let mut terms = Vec::new();
    let mut holds = Vec::new();
    for statement in &model.statements {
        match statement {
            Statement::Let { name, .. } if circular.iter().any(|c| c.text == name.text) => {}
            Statement::Let { name, value } => match elaborator.any(value) {
                Ok(e) if e.size() > largest => {
                    errors.push(messages::too_large(value.place, e.size(), largest, true));
                    elaborator.spoil(name);
                }
                Ok(e) => elaborator.bind(name, e, &mut errors),
                Err(e) => {
                    errors.push(*e);
                    elaborator.spoil(name);
                }
            },
            Statement::Assume {
                left,
                relation,
                right,
                place,
            } => match elaborator.pair(left, right) {
                Ok((l, r)) => {
                    if *relation != crate::syntax::ast::Comparison::Equal && !l.shape().is_scalar() {
                        errors.push(
                            Diagnostic::new(*place, "only numbers can be compared by size")
                                .help("compare a number, such as `det(J) > 0` or `J[1, 1] > 0`"),
                        );
                    }
                    if [&l, &r].iter().any(|e| !is_constant(&names, e)) {
                        errors.push(messages::assumption_not_constant(*place));
                    }
                    assumptions.push(Assumption {
                        left: l,
                        relation: *relation,
                        right: r,
                        place: *place,
                    });
                }
                Err(e) => errors.push(*e),
            },
            Statement::Constraint { name, value, place } => {
                if let Some(slot) = declared.slot(name, &mut errors) {
                    let shape = names.symbols.get(slot).shape;
                    match elaborator.of_shape(value, shape) {
                        Ok(e) => declared.set_update(slot, e, *place, &mut errors),
                        Err(e) => {
                            declared.mark_stated(slot);
                            errors.push(*e);
                        }
                    }
                }
            }
            Statement::Hold {
                name,
                left,
                right,
                place,
            } => match elaborator.pair(left, right) {
                Ok(sides) => holds.extend(hold::hold(
                    &mut declared,
                    name,
                    sides,
                    *place,
                    largest,
                    &mut errors,
                )),
                Err(e) => errors.push(*e),
            },
            Statement::Advected {
                names: quantities,
                definition: Some(value),
                ..
            } => {
                let own = quantities.first();
                if let Some(slot) = own.and_then(|name| names.symbols.find(&name.text)) {
                    match elaborator.of_shape(value, names.symbols.get(slot).shape) {
                        Ok(e) => declared.set_definition(slot, e, value.place, &mut errors),
                        Err(e) => errors.push(*e),
                    }
                }
            }
            Statement::Scale(value) => match elaborator.number(value) {
                Ok(e) => {
                    let zero = crate::algebra::Algebra::new(&names.symbols).is_zero(&e);
                    if !is_constant(&names, &e) || zero {
                        errors.push(messages::scale_not_constant(value.place));
                    }
                    scale = Some(e);
                }
                Err(e) => errors.push(*e),
            },
            Statement::Node(rule, _) => node_rule = *rule,
            Statement::Lagrangian(value) => match elaborator.number(value) {
                Ok(_) if typed.is_some() => errors.push(messages::second_lagrangian(value.place)),
                Ok(e) if e.size() > largest => {
                    let lets = !lets.is_empty();
                    errors.push(messages::too_large(value.place, e.size(), largest, lets));
                    typed = Some((expr::integer(0), value.place));
                }
                Ok(e) => {
                    let parts = elaborate::terms(value).into_iter();
                    let parts = parts.filter_map(|t| Some((elaborator.number(t).ok()?, t.place)));
                    terms = parts.collect();
                    typed = Some((e, value.place));
                }
                Err(e) => {
                    errors.push(*e);
                    typed = Some((expr::integer(0), value.place));
                }
            },
            Statement::Dim { .. }
            | Statement::Time { .. }
            | Statement::Given { .. }
            | Statement::Mesh { .. }
            | Statement::Grid(_)
            | Statement::Param { .. }
            | Statement::Group { .. }
            | Statement::Field { .. }
            | Statement::Advected { .. }
            // A chain is expanded before it is checked.
            | Statement::Label { .. }
            | Statement::Periodic(_)
            | Statement::End { .. } => {}
        }
    }
    declared.require_constraints(&mut errors);
    let Some((typed, place)) = typed else {
        errors.push(messages::no_lagrangian(model.name.place));
        errors.propagate()?;
        return Err(messages::no_lagrangian(model.name.place).into());
    };
    errors.propagate()?;
    let lagrangian = match &scale {
        Some(s) => expr::quotient(typed.clone(), s.clone()),
        None => typed.clone(),
    };
    let mut spec = finish(
        model,
        declared,
        assumptions,
        holds,
        typed,
        scale,
        lagrangian,
        place,
        terms,
        node_rule,
    )?;
    spec.lets = elaborator.bound().to_vec();
    spec.unused_lets = unused_definitions(model);
    spec.of_site = extent == Extent::Site;
    usage(&spec, extent)?;
    hold::without_clocks(&spec)?;
    Ok(spec)
}

fn is_constant(names: &Declared, e: &Expr) -> bool {
    expr::letters(e).iter().all(|l| {
        matches!(
            names.symbols.get(l.symbol).role,
            Role::Parameter | Role::Step
        )
    })
}

#[allow(clippy::too_many_arguments)]
fn finish(
    model: &Model,
    declared: Declared,
    assumptions: Vec<Assumption>,
    holds: Vec<Hold>,
    typed: Expr,
    scale: Option<Expr>,
    lagrangian: Expr,
    lagrangian_place: Place,
    terms: Vec<(Expr, Place)>,
    node_rule: NodeRule,
) -> Result<Spec, Errors> {
    let mut errors = Errors::new();
    let mut configurations = Vec::new();
    for g in &declared.configurations {
        let Some((update, place)) = g.update.clone() else {
            continue;
        };
        let side = match g.group.is_additive() {
            // For an additive group both frames are equivalent; the momentum is spatial.
            true => Some(Side::Spatial),
            false => shapes::side(&declared.symbols, g, &update),
        };
        match side {
            Some(side) => configurations.push(Configuration {
                element: g.element,
                velocity: g.velocity,
                group: g.group,
                side,
                update,
                place,
                name_place: g.place,
                group_place: g.group_place,
                copy: None,
            }),
            None => errors.push(messages::not_a_reconstruction(&declared.symbols, g, place)),
        }
    }
    let advected = declared
        .advected
        .iter()
        .filter_map(|a| {
            let (update, place) = a.update.clone()?;
            Some(Advected {
                quantity: a.quantity,
                definition: a.definition.clone().map(|(e, _)| e),
                definition_place: a.definition.as_ref().map(|(_, p)| *p),
                update,
                place,
                name_place: a.place,
                found: false,
            })
        })
        .collect();
    let remarks = remarks(model, &declared);
    errors.propagate()?;
    let step = Letter {
        symbol: declared.step,
        shift: Shift::HERE,
    };
    let mut symbols = declared.symbols;
    symbols.keep_differences(
        schedule::divides_twice(&lagrangian, step)
            || schedule::varies_with_rotations(&symbols, &lagrangian),
    );
    Ok(Spec {
        name: model.name.text.clone(),
        name_place: model.name.place,
        docs: model.docs.clone(),
        remarks,
        public: model.public,
        symbols,
        time_index: declared.time_index,
        step: declared.step,
        dimensions: declared.dimensions,
        parameters: declared.parameters,
        parameter_places: declared.parameter_places,
        assumptions,
        formulas: crate::syntax::formula::stated(model),
        lets: Vec::new(),
        unused_lets: Vec::new(),
        configurations,
        advected,
        holds,
        typed,
        scale,
        lagrangian,
        lagrangian_place,
        terms,
        of_site: false,
        node_rule,
        reduction: None,
    })
}

/// The documentation of statements that do not declare a symbol.
fn remarks(model: &Model, declared: &Declared) -> Vec<(Subject, Vec<String>)> {
    let (mut dimensions, mut assumptions) = (0, 0);
    let mut out = Vec::new();
    for (statement, docs) in model.statements.iter().zip(&model.remarks) {
        let subject = match statement {
            Statement::Dim { .. } => {
                dimensions += 1;
                Some(Subject::Dimension(dimensions - 1))
            }
            Statement::Assume { .. } => {
                assumptions += 1;
                Some(Subject::Assumption(assumptions - 1))
            }
            Statement::Time { .. } => Some(Subject::Time),
            Statement::Constraint { name, .. } => {
                declared.symbols.find(&name.text).map(Subject::Constraint)
            }
            Statement::Hold { name, .. } => declared.symbols.find(&name.text).map(Subject::Hold),
            Statement::Scale(_) => Some(Subject::Scale),
            Statement::Node(..) => Some(Subject::Node),
            Statement::Lagrangian(_) => Some(Subject::Lagrangian),
            // A definition is substituted where it is used, and is not stored separately.
            Statement::Let { .. }
            | Statement::Given { .. }
            | Statement::Mesh { .. }
            | Statement::Grid(_)
            | Statement::Param { .. }
            | Statement::Group { .. }
            | Statement::Field { .. }
            | Statement::Advected { .. }
            | Statement::Label { .. }
            | Statement::Periodic(_)
            | Statement::End { .. } => None,
        };
        if let Some(subject) = subject.filter(|_| !docs.is_empty()) {
            out.push((subject, docs.clone()));
        }
    }
    out
}

/// The configurations whose velocity or increment the Lagrangian does not contain.
pub fn without_velocity(spec: &Spec) -> Vec<&Configuration> {
    let used = expr::letters(&spec.lagrangian);
    let is_still = |c: &&Configuration| {
        let velocity = Letter {
            symbol: c.velocity,
            shift: Shift::HERE,
        };
        let next = Letter {
            symbol: c.element,
            shift: Shift::NEXT,
        };
        // The Lagrangian may contain the elements at both ends of the step instead; the reduction then introduces the
        // velocity.
        !used.contains(&velocity) && !used.contains(&next)
    };
    spec.configurations.iter().filter(is_still).collect()
}

/// Checks that declared quantities are used where the theory needs them, and only there.
fn usage(spec: &Spec, extent: Extent) -> Result<(), Errors> {
    let mut errors = Errors::new();
    let used = expr::letters(&spec.lagrangian);
    if extent == Extent::Stated {
        for c in without_velocity(spec) {
            errors.push(messages::unused_velocity(spec, c));
        }
    }
    if spec.configurations.is_empty() {
        errors.push(
            Diagnostic::new(spec.name_place, "the model has no configuration").help(
                "declare one, for example `group Λ: SO<3> velocity Ω;` or `field X: Vec<3>;`",
            ),
        );
    }
    for l in &used {
        if !messages::EDGE.contains(&l.shift.time) {
            errors.push(messages::shift_too_far(
                spec.lagrangian_place,
                &spec.symbols,
                *l,
            ));
        }
        if spec.symbols.get(l.symbol).role == Role::Velocity && l.shift != Shift::HERE {
            let name = &spec.symbols.get(l.symbol).name;
            errors.push(messages::shifted_velocity(spec.lagrangian_place, name));
        }
    }
    errors.propagate()
}
