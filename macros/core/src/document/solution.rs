//! The equation that each step solves: the Moser-Veselov equation, the equivalent matrix Riccati equation, its
//! Hamiltonian matrix and invariant subspace, and the method of the stepper.

use super::citations::Place;
use super::sheet::{Sheet, listed};
use crate::check::spec::{Configuration, Spec};
use crate::derive::convex::convexity;
use crate::derive::select_solver::{BECAUSE, Method, MoserVeselov, StepEquation};
use crate::derive::two_sided_linear::TwoSidedLinear;
use crate::emit;
use crate::expr::symbol::Role;
use crate::expr::{self, Expr, Node};
use crate::print::document::{Document, Inline, Section};
use crate::print::formula::{Formula, Relation};

/// The section on the solution of a step.
pub fn moser_veselov(sheet: &Sheet, doc: &mut Document) {
    let d = sheet.d;
    let fields = d.spec.has_only_fields();
    let section = doc.section(match fields {
        true => "Solution of a step",
        false => "Moser-Veselov and Riccati form",
    });
    let mut explained = false;
    for (i, (c, r)) in d
        .spec
        .configurations
        .iter()
        .zip(&d.solve.riccati)
        .enumerate()
    {
        let (mv, coupled) = match r {
            StepEquation::None(_) if c.group.is_additive() => {
                section.paragraph([
                    "Equation ".into(),
                    Inline::reference(&format!("outgoing {i}")),
                    match d.solve.one_system.contains(&i) {
                        true => {
                            " is linear in the increments, but not of one factor on either side of "
                        }
                        false => " is not linear in the increment ",
                    }
                    .into(),
                    sheet.here(c.velocity).into(),
                    ".".into(),
                ]);
                continue;
            }
            StepEquation::None(why) => {
                section.paragraph([
                    "There is no Riccati form for ".into(),
                    sheet.here(c.velocity).into(),
                    format!(": {why}.").into(),
                ]);
                continue;
            }
            StepEquation::Quaternionic(q) => {
                super::quaternionic::equation(sheet, section, c, q, i);
                continue;
            }
            StepEquation::Linear(form) => {
                linear(sheet, section, c, form, i);
                continue;
            }
            StepEquation::Exact(mv) => (mv, false),
            StepEquation::Coupled(mv) => (mv, true),
        };
        equation(sheet, section, c, mv, i, coupled);
        if !explained {
            riccati(sheet, section, c, mv, i);
            explained = true;
        } else {
            section.text("Its Riccati form is the same, with these letters.");
        }
    }
    method(sheet, section);
}

/// A balance that is linear in the velocity, solved for the velocity.
fn linear(
    sheet: &Sheet,
    section: &mut Section,
    c: &Configuration,
    form: &TwoSidedLinear,
    i: usize,
) {
    let d = sheet.d;
    let s = sheet.symbols();
    let mu = expr::here(s, d.letters.node_momentum[i]);
    match c.group.is_additive() {
        true => section.paragraph([
            "Equation ".into(),
            Inline::reference(&format!("outgoing {i}")),
            " is linear in the increment ".into(),
            sheet.here(c.velocity).into(),
            ", and is solved by".into(),
        ]),
        false => section.paragraph([
            "There is no Riccati form for ".into(),
            sheet.here(c.velocity).into(),
            ": the group is not SO(n). Equation ".into(),
            Inline::reference(&format!("outgoing {i}")),
            " is linear in it, with factors that are known at the node, and is solved by".into(),
        ]),
    };
    let known = expr::sub(mu, form.rest.clone());
    let change = expr::product([
        expr::inverse(s, form.left.clone()),
        known,
        expr::inverse(s, form.right.clone()),
    ]);
    let solved = expr::add(c.group.identity(), change);
    section.equation(Formula::equal(sheet.here(c.velocity), sheet.math(&solved)));
}

/// A letter for the factor, or the factor itself if it is a letter; and whether the letter is a new name.
fn factor(sheet: &Sheet, mv: &MoserVeselov, i: usize) -> (Formula, bool) {
    match mv.factor.node() {
        Node::Letter(_) => (Formula::Expr(mv.factor.clone()), false),
        _ => (sheet.name("C", i), true),
    }
}

/// `C^T`, written `C` if the factor is symmetric.
fn transposed(mv: &MoserVeselov, c: &Formula) -> Formula {
    if mv.symmetric {
        c.clone()
    } else {
        Formula::transpose(c.clone())
    }
}

/// The letter of the edge momentum: that of the node momentum if the two are equal.
fn edge(sheet: &Sheet, mv: &MoserVeselov, i: usize) -> Formula {
    match sheet.d.letters.node_momentum.get(i) {
        Some(mu) if mv.rest.is_zero() => sheet.here(*mu),
        _ => sheet.name("N", i),
    }
}

/// `h N` as a matrix.
fn momentum(sheet: &Sheet, c: &Configuration, mv: &MoserVeselov, i: usize) -> Formula {
    let n = edge(sheet, mv, i);
    let n = if sheet.has_vectors(c) {
        Formula::hat(n)
    } else {
        n
    };
    Formula::Product(vec![sheet.here(sheet.d.spec.step), n])
}

fn equation(
    sheet: &Sheet,
    section: &mut Section,
    c: &Configuration,
    mv: &MoserVeselov,
    i: usize,
    coupled: bool,
) {
    let d = sheet.d;
    let w = sheet.here(c.velocity);
    let (letter, named) = factor(sheet, mv, i);
    let n = edge(sheet, mv, i);
    let mu = expr::here(sheet.symbols(), d.letters.node_momentum[i]);
    section.paragraph([
        "Equation ".into(),
        Inline::reference(&format!("outgoing {i}")),
        " is linear in ".into(),
        w.clone().into(),
        ", a Moser-Veselov equation:".into(),
    ]);
    let product = Formula::Product(vec![w.clone(), transposed(mv, &letter)]);
    let mirrored = Formula::Product(vec![letter.clone(), Formula::transpose(w.clone())]);
    section.sourced(
        Formula::equal(Formula::minus(product, mirrored), momentum(sheet, c, mv, i)),
        sheet.source(Place::Riccati),
    );
    let mut with = Vec::new();
    if named {
        with.push(Formula::equal(letter.clone(), sheet.math(&mv.factor)));
    }
    if !mv.rest.is_zero() {
        let rest = sheet.derived(&expr::sub(mu, mv.rest.clone()));
        with.push(Formula::equal(n.clone(), rest));
    }
    if !with.is_empty() {
        section.equation(match <[Formula; 1]>::try_from(with) {
            Ok([only]) => only,
            Err(several) => Formula::List(several),
        });
    }
    reason(sheet, section, c, mv, i, coupled);
}

/// Why the equation is closed, or which quantities couple it to the other equations.
fn reason(
    sheet: &Sheet,
    section: &mut Section,
    c: &Configuration,
    mv: &MoserVeselov,
    i: usize,
    coupled: bool,
) {
    let s = sheet.symbols();
    let (letter, _) = factor(sheet, mv, i);
    let n = edge(sheet, mv, i);
    if !coupled {
        let constant = expr::letters(&mv.factor)
            .iter()
            .all(|l| matches!(s.get(l.symbol).role, Role::Parameter | Role::Step));
        let known = if constant {
            " is constant and "
        } else {
            " and "
        };
        let end = if constant {
            " depends on data at the node only: no approximation is involved."
        } else {
            " depend on data at the node only: no approximation is involved."
        };
        section.paragraph([letter.into(), known.into(), n.into(), end.into()]);
        return;
    }
    let holders = |e: &Expr| -> Vec<Vec<Inline>> {
        let others = sheet.d.spec.configurations.iter();
        let others = others.filter(|o| o.velocity != c.velocity);
        others
            .filter(|o| expr::letters(e).iter().any(|l| l.symbol == o.velocity))
            .map(|o| vec![Inline::from(sheet.here(o.velocity))])
            .collect()
    };
    let mut clauses = Vec::new();
    for (name, e) in [(letter, &mv.factor), (n, &mv.rest)] {
        let found = holders(e);
        if !found.is_empty() {
            let mut clause: Vec<Inline> = vec![name.into(), " contains ".into()];
            clause.extend(listed(found));
            clauses.push(clause);
        }
    }
    if clauses.is_empty() {
        return;
    }
    let mut words: Vec<Inline> = vec!["It is coupled: ".into()];
    words.extend(listed(clauses));
    words.push(".".into());
    section.paragraph(words);
}

fn riccati(sheet: &Sheet, section: &mut Section, c: &Configuration, mv: &MoserVeselov, i: usize) {
    let (letter, _) = factor(sheet, mv, i);
    let name = |base: &str| sheet.name(base, i);
    let (a, sym, x, ham) = (name("A"), name("S"), name("X"), name("H"));
    let w = sheet.here(c.velocity);
    let ct = transposed(mv, &letter);
    let square = |f: &Formula| Formula::Product(vec![f.clone(), f.clone()]);
    let zero = || Formula::Expr(expr::integer(0));
    let two = || Formula::Expr(expr::integer(2));
    section.paragraph([
        "With ".into(),
        Formula::Relation(
            vec![
                x.clone(),
                Formula::Product(vec![w.clone(), ct.clone()]),
                Formula::Sum(vec![sym.clone(), a.clone()]),
            ],
            Relation::Equal,
        )
        .into(),
        ", ".into(),
        sym.clone().into(),
        " symmetric and ".into(),
        Formula::equal(
            a.clone(),
            Formula::Quotient(Box::new(momentum(sheet, c, mv, i)), Box::new(two())),
        )
        .into(),
        " skew, orthogonality of ".into(),
        w.clone().into(),
        " is a matrix Riccati equation:".into(),
    ]);
    let own = if mv.symmetric {
        square(&letter)
    } else {
        Formula::Product(vec![letter.clone(), ct.clone()])
    };
    section.equation(Formula::equal(
        Formula::Sum(vec![
            square(&sym),
            Formula::Product(vec![sym.clone(), a.clone()]),
            Formula::neg(Formula::Product(vec![a.clone(), sym.clone()])),
            Formula::neg(square(&a)),
            Formula::neg(own.clone()),
        ]),
        zero(),
    ));
    let id = Formula::Expr(expr::identity(c.group.size()));
    let column = |rows: Vec<Formula>| Formula::Matrix(rows.into_iter().map(|f| vec![f]).collect());
    section.text("Its Hamiltonian matrix is");
    section.equation(Formula::List(vec![
        Formula::equal(
            ham.clone(),
            Formula::Matrix(vec![
                vec![a.clone(), id.clone()],
                vec![Formula::Sum(vec![square(&a), own]), a.clone()],
            ]),
        ),
        Formula::equal(
            Formula::Product(vec![ham, column(vec![id.clone(), sym.clone()])]),
            Formula::Product(vec![column(vec![id, sym.clone()]), x.clone()]),
        ),
    ]));
    if sheet.d.solve.needs_second_moments()
        && let Some(degenerate) = degenerate(sheet)
    {
        section.paragraph([
            letter.into(),
            " is singular for all parameters and does not determine a solution: ".into(),
            degenerate.into(),
            ", and several velocities solve the Moser-Veselov equation.".into(),
        ]);
        return;
    }
    let (u1, u2) = (sheet.free("U_1"), sheet.free("U_2"));
    let wanted = if mv.symmetric {
        "The solution that tends to the identity as the step tends to zero"
    } else {
        "The principal solution"
    };
    section.paragraph([
        format!("{wanted} corresponds to the invariant subspace of the eigenvalues with positive real part: with a basis ").into(),
        column(vec![u1.clone(), u2.clone()]).into(),
        " of it,".into(),
    ]);
    let solved = Formula::Product(vec![
        Formula::Sum(vec![sym.clone(), a]),
        Formula::Inverse(Box::new(ct)),
    ]);
    section.equation(Formula::List(vec![
        Formula::equal(
            sym,
            Formula::Product(vec![u2, Formula::Inverse(Box::new(u1))]),
        ),
        Formula::equal(w.clone(), solved),
    ]));
    section.paragraph([
        "This requires an invertible ".into(),
        letter.clone().into(),
        "; for singular ".into(),
        letter.into(),
        " (a flat body) the Moser-Veselov equation itself is solved for ".into(),
        w.into(),
        ".".into(),
    ]);
}

/// The rank of the kinetic energy, if it is degenerate for all parameters.
fn degenerate(sheet: &Sheet) -> Option<String> {
    let kinetic = sheet.d.kinetic.as_ref().filter(|k| !k.first_order)?;
    let (rank, n) = kinetic.degenerate()?;
    Some(format!(
        "the kinetic energy has rank {rank} of {n} in the velocities"
    ))
}

/// Describes the method of the emitted stepper, or why none is emitted.
fn method(sheet: &Sheet, section: &mut Section) {
    let d = sheet.d;
    if let Some(refused) = emit::refusal(d) {
        section.text(&format!("No stepper is emitted: {}.", refused.message));
        return;
    }
    let reason = d.solve.reason.as_str();
    let letter = d.solve.riccati.first().and_then(|r| match r {
        StepEquation::Exact(mv) | StepEquation::Coupled(mv) => Some(factor(sheet, mv, 0).0),
        StepEquation::Quaternionic(_) | StepEquation::Linear(_) | StepEquation::None(_) => None,
    });
    let degenerate = degenerate(sheet);
    if d.solve.needs_second_moments()
        && let (Some(degenerate), Some(letter)) = (&degenerate, &letter)
    {
        section.paragraph([
            "The stepper makes no step: it rejects every value of ".into(),
            letter.clone().into(),
            format!(
                ", because {degenerate} for all parameters. The warning says what to write \
                 instead."
            )
            .into(),
        ]);
        return;
    }
    // An advected factor is constant in the body frame.
    let carried = d.solve.riccati.iter().any(|r| match r {
        StepEquation::Exact(mv) | StepEquation::Coupled(mv) => {
            expr::contains_role(sheet.symbols(), &mv.factor, Role::Advected)
        }
        StepEquation::Quaternionic(_) | StepEquation::Linear(_) | StepEquation::None(_) => false,
    });
    let frame = match carried {
        true => " in the body frame, where the equation is solved",
        false => "",
    };
    if let [only] = d.solve.blocks.as_slice()
        && let Some(what) = only.linear_work()
    {
        section.text(&format!("The stepper is explicit: {what} per step."));
        return;
    }
    let words = match (d.solve.method.clone(), letter) {
        (Method::FreeMoserVeselov, Some(letter)) => vec![
            "The stepper is explicit up to the root of one quartic for the whole trajectory: "
                .into(),
            letter.into(),
            format!(" is constant{frame}, and no force changes the momentum.").into(),
        ],
        (Method::ForcedMoserVeselov, Some(letter)) => vec![
            "The stepper is explicit up to the root of one quartic per step: ".into(),
            letter.into(),
            format!(" is symmetric and constant{frame}.").into(),
        ],
        (Method::UnitQuaternions, _) => {
            let why = reason.split_once(BECAUSE).map_or("", |(_, why)| why);
            vec![format!("The stepper solves only this scalar equation{BECAUSE}{why}.").into()]
        }
        (Method::Blocks, _) => {
            vec![format!("The stepper solves the equations block by block: {reason}.").into()]
        }
        (method, letter) => {
            let (how, why) = match reason.split_once(BECAUSE) {
                Some((how, why)) => (how, Some(why)),
                None => (reason, None),
            };
            let by_newton = how.strip_prefix("Newton's method on the derived residual");
            let lead = match method {
                Method::Newton if by_newton.is_some() && d.spec.has_only_fields() => {
                    "The stepper uses Newton's method".to_owned()
                }
                Method::Newton if by_newton.is_some() => {
                    "The stepper uses Newton's method on the group".to_owned()
                }
                Method::Newton if d.solve.one_system.contains(&0) => {
                    format!("The stepper solves {how}")
                }
                Method::Davenport => format!("The stepper finds {how}"),
                _ if how.starts_with("explicit") => format!("The stepper is {how}"),
                _ => format!("The stepper uses {how}"),
            };
            let mut words: Vec<Inline> = vec![lead.into()];
            if let Some(why) = why {
                words.push(BECAUSE.into());
                match (why.strip_prefix("the left factor "), letter) {
                    (Some(rest), Some(letter)) => {
                        words.extend([letter.into(), format!(" {rest}").into()]);
                    }
                    _ => words.push(why.into()),
                }
            }
            words.push(".".into());
            if matches!(method, Method::LeftFactor | Method::Davenport) {
                words.push(" You can choose another solver by name.".into());
            }
            words
        }
    };
    section.paragraph(words);
    unique(sheet, section);
    if let Some(degenerate) = degenerate {
        section.text(&format!(
            "But {degenerate} for all parameters: for small steps the equation does not \
             determine all velocities, and steps may fail."
        ));
    }
}

/// States which balances have a unique solution, and for which parameters.
fn unique(sheet: &Sheet, section: &mut Section) {
    let d = sheet.d;
    let one = |spec: &Spec, section: &mut Section| {
        let Some(found) = convexity(spec, sheet.symbols(), &d.action) else {
            return;
        };
        let velocities = spec.configurations.iter();
        let velocities = velocities.map(|c| vec![sheet.here(c.velocity).into()]);
        let sign = |sign: &str, e: &Expr| -> Vec<Inline> {
            vec![sheet.math(e).into(), format!(" {sign} 0").into()]
        };
        let positive = found.positive.iter().map(|e| sign(">", e));
        let others = found.not_negative.iter().map(|e| sign("≥", e));
        let mut words: Vec<Inline> = vec!["The discrete Lagrangian is convex in ".into()];
        words.extend(listed(velocities.collect()));
        words.push(" where ".into());
        words.extend(listed(positive.chain(others).collect()));
        words.push(": the solution is then unique.".into());
        section.paragraph(words);
    };
    if matches!(d.solve.method, Method::Newton) {
        one(&d.spec, section);
    }
    for b in d.solve.blocks.iter().filter(|b| b.is_newton()) {
        one(&d.of_block(b).spec, section);
    }
}
