//! The sections of a derivation, in the order of the paper.

use super::source;
use crate::check::spec::{Group, Side};
use crate::derive::Derivation;
use crate::derive::clebsch::constraint_terms;
use crate::derive::recognise::{Method, Riccati};
use crate::expr::shape::{Dim, Shape};
use crate::expr::{self, Expr, Letter, Shift};
use crate::print::document::{Document, Inline};
use crate::print::formula::{Formula, Operator, Relation};
use crate::syntax::ast::NodeRule;

fn math(e: &Expr) -> Formula {
    Formula::Expr(e.clone())
}

fn at(symbol: crate::expr::symbol::SymbolId, shift: Shift) -> Letter {
    Letter { symbol, shift }
}

/// The derivation as a document.
pub fn document(d: &Derivation) -> Document {
    let mut doc = Document::titled(format!("{}: discrete equations of motion", d.spec.name));
    model(d, &mut doc);
    action(d, &mut doc);
    variations(d, &mut doc);
    relations(d, &mut doc);
    momentum(d, &mut doc);
    solve(d, &mut doc);
    invariants(d, &mut doc);
    limit(d, &mut doc);
    certificate(d, &mut doc);
    doc
}

fn model(d: &Derivation, doc: &mut Document) {
    let section = doc.section("Model");
    let words: Vec<&str> = d
        .spec
        .docs
        .iter()
        .map(|l| l.trim())
        .filter(|l| !l.is_empty())
        .collect();
    if !words.is_empty() {
        section.text(&words.join(" "));
    }
    let text = source(d);
    let statement: Vec<&str> = text.lines().filter(|l| !l.starts_with("///")).collect();
    section.code(statement.join("\n"));
}

fn action(d: &Derivation, doc: &mut Document) {
    let k = &d.spec.time_index;
    let section = doc.section("Action");
    if let Some(scale) = &d.spec.scale {
        section.paragraph([
            "The Lagrangian is typed as ".into(),
            math(scale).into(),
            " times the physical action of one step; the physical form is used below.".into(),
        ]);
        section.equation(Formula::equal(Formula::name("ℓ"), math(&d.spec.typed)));
    }
    section.equation(Formula::defined(
        Formula::name(&format!("ℓ_{k}")),
        math(&d.action.total),
    ));
    if !d.action.nodal.is_zero() {
        let how = match d.spec.node_rule {
            NodeRule::Symmetric => {
                "Terms at one node are split evenly between the two adjacent edges."
            }
            NodeRule::Incoming => "Terms at one node belong to the edge that ends there.",
            NodeRule::Outgoing => "Terms at one node belong to the edge that starts there.",
        };
        section.text(how);
    }
    section.text("The Clebsch action adds one multiplier for each constraint:");
    let terms = constraint_terms(&d.spec, &d.letters);
    let total = expr::sum(
        [d.action.total.clone()].into_iter().chain(terms),
        Shape::SCALAR,
    );
    section.equation(Formula::defined(
        Formula::name(&format!("ℓ^c_{k}")),
        math(&total),
    ));
}

fn variations(d: &Derivation, doc: &mut Document) {
    let s = &d.letters.symbols;
    let section = doc.section("Variations that keep the constraints");
    section.text("One element varies freely at its node; the velocities of the two adjacent edges and the advected quantities follow.");
    for (v, xi) in d.variations.iter().zip(&d.letters.variation) {
        let mut list = vec![&v.element, &v.outgoing, &v.incoming];
        list.extend(v.advected.iter().filter(|(_, e)| !e.is_zero()));
        for (letter, change) in list {
            let x = expr::letter(s, letter.symbol, letter.shift);
            section.equation(Formula::equal(Formula::variation(math(&x)), math(change)));
        }
        let algebra = match d.spec.configurations.first().map(|c| c.group) {
            Some(Group::GeneralLinear(_)) | None => " is an arbitrary matrix.",
            Some(Group::SpecialOrthogonal(_)) => " is an arbitrary skew matrix.",
        };
        section.paragraph([
            "Here ".into(),
            math(&expr::here(s, *xi)).into(),
            algebra.into(),
        ]);
    }
}

fn relations(d: &Derivation, doc: &mut Document) {
    let s = &d.letters.symbols;
    let section = doc.section("Clebsch relations");
    section.text("Stationarity of the Clebsch action in each variable:");
    for r in &d.relations {
        let x = expr::letter(s, r.variable.symbol, r.variable.shift);
        let right = if r.up_to_group_multiplier {
            Formula::Product(vec![Formula::name("Θ"), math(&x)])
        } else {
            Formula::Expr(expr::integer(0))
        };
        section.equation(Formula::equal(math(&r.gradient), right));
        let mut note = format!("variation of {}", s.get(r.variable.symbol).name);
        if r.up_to_group_multiplier {
            note.push_str("; Θ is symmetric, the multiplier of the group");
        }
        section.noted(&note);
    }
}

/// `∇_a ℓ ◇ a` for the advected quantities that the action contains at this end of the edge.
fn diamonds(d: &Derivation, i: usize, level: &str, end: bool) -> Vec<Formula> {
    let s = &d.letters.symbols;
    let v = &d.variations[i];
    let mut out = Vec::new();
    for (j, a) in d.spec.advected.iter().enumerate() {
        let (start, stop) = &d.balances[i].advected_gradients[j];
        let g = if end { stop } else { start };
        let moves = v.advected.get(j).is_some_and(|(_, e)| !e.is_zero());
        if g.is_zero() || !moves {
            continue;
        }
        let gradient = Formula::gradient(&format!("ℓ_{level}"), at(a.quantity, Shift::HERE));
        out.push(Formula::diamond(gradient, math(&expr::here(s, a.quantity))));
    }
    out
}

fn momentum(d: &Derivation, doc: &mut Document) {
    let s = &d.letters.symbols;
    let k = &d.spec.time_index;
    let section = doc.section("Momentum map and discrete Euler-Poincaré equation");
    for (i, (c, m)) in d.spec.configurations.iter().zip(&d.momenta).enumerate() {
        let edge = expr::here(s, d.letters.edge_momentum[i]);
        let before = expr::letter(s, d.letters.edge_momentum[i], Shift::PREVIOUS);
        let w = expr::letter(s, c.velocity, Shift::PREVIOUS);
        section.paragraph([
            "The momentum of the edge, by the gradient of the action in the velocity and as the momentum map of the lifted action:".into(),
        ]);
        let gradient = Formula::gradient(&format!("ℓ_{k}"), at(c.velocity, Shift::HERE));
        let wt = Formula::transpose(math(&expr::here(s, c.velocity)));
        let product = match c.side {
            Side::Body => Formula::Product(vec![gradient, wt]),
            Side::Spatial => Formula::Product(vec![wt, gradient]),
        };
        let by_gradient = if c.group.is_orthogonal() {
            Formula::Product(vec![
                Formula::Expr(expr::integer(2)),
                Formula::operator(Operator::Skew, product),
            ])
        } else {
            product
        };
        section.cited(
            Formula::Relation(
                vec![math(&edge), by_gradient, math(&m.reduced)],
                Relation::Equal,
            ),
            "momentum map; thesis (2.86) up to its factor -h",
        );
        section.equation(Formula::equal(Formula::name("J^R"), math(&m.cotangent)));
        section.text("Balance at a node, in terms of the coadjoint action and the diamond of each advected quantity:");
        let sign = |list: Vec<Formula>, plus: bool| -> Vec<Formula> {
            list.into_iter()
                .map(|f| if plus { f } else { Formula::neg(f) })
                .collect()
        };
        let body = c.side == Side::Body;
        let mut left = vec![math(&edge)];
        left.extend(sign(diamonds(d, i, k, false), body));
        let mut right = vec![Formula::ad_star(math(&w), math(&before))];
        right.extend(sign(diamonds(d, i, &format!("{k}-1"), true), !body));
        section.cited(
            Formula::equal(Formula::Sum(left), Formula::Sum(right)),
            "discrete Euler-Poincaré equation; thesis (2.85), (2.155) corrected",
        );
        let b = &d.balances[i];
        let mu = expr::here(s, d.letters.node_momentum[i]);
        section.paragraph([
            "As components, which is what the emitted residual evaluates; ".into(),
            math(&mu).into(),
            " is the momentum at the node:".into(),
        ]);
        section.equation(Formula::Relation(
            vec![math(&mu), math(&b.outgoing)],
            Relation::Equal,
        ));
        let next = expr::letter(s, d.letters.node_momentum[i], Shift::NEXT);
        section.equation(Formula::equal(math(&next), math(&b.incoming)));
    }
}

fn solve(d: &Derivation, doc: &mut Document) {
    let s = &d.letters.symbols;
    let section = doc.section("Moser-Veselov and Riccati form");
    let step = math(&expr::here(s, d.spec.step));
    for (i, (c, r)) in d
        .spec
        .configurations
        .iter()
        .zip(&d.solve.riccati)
        .enumerate()
    {
        let w = math(&expr::here(s, c.velocity));
        let mu = math(&expr::here(s, d.letters.node_momentum[i]));
        let mv = match r {
            Riccati::None(why) => {
                section.paragraph([
                    "There is no Riccati form for ".into(),
                    w.into(),
                    format!(": {why}.").into(),
                ]);
                continue;
            }
            Riccati::Exact(mv) => {
                section.paragraph(["The velocity solves an exact matrix Riccati equation:".into()]);
                mv
            }
            Riccati::Coupled(mv) => {
                section.paragraph([
                    "The velocity solves a matrix Riccati equation coupled to the other velocities:".into(),
                ]);
                mv
            }
        };
        let (cc, n, a, sym) = (
            Formula::name("C"),
            Formula::name("N"),
            Formula::name("A"),
            Formula::name("S"),
        );
        let ct = Formula::transpose(cc.clone());
        let edge = if c.group.size() == Dim::Fixed(3) {
            Formula::hat(n.clone())
        } else {
            n.clone()
        };
        section.cited(
            Formula::equal(
                Formula::minus(
                    Formula::Product(vec![w.clone(), ct.clone()]),
                    Formula::Product(vec![cc.clone(), Formula::transpose(w.clone())]),
                ),
                Formula::Product(vec![step.clone(), edge.clone()]),
            ),
            "Moser-Veselov equation",
        );
        section.equation(Formula::List(vec![
            Formula::equal(cc.clone(), math(&mv.factor)),
            Formula::equal(
                n,
                if mv.rest.is_zero() {
                    mu
                } else {
                    Formula::minus(mu, math(&mv.rest))
                },
            ),
        ]));
        section.cited(
            Formula::Relation(
                vec![
                    Formula::Sum(vec![
                        Formula::Product(vec![sym.clone(), sym.clone()]),
                        Formula::Product(vec![sym.clone(), a.clone()]),
                        Formula::neg(Formula::Product(vec![a.clone(), sym.clone()])),
                        Formula::neg(Formula::Product(vec![a.clone(), a.clone()])),
                        Formula::neg(Formula::Product(vec![cc.clone(), ct.clone()])),
                    ]),
                    Formula::Expr(expr::integer(0)),
                ],
                Relation::Equal,
            ),
            "matrix Riccati equation for the symmetric S",
        );
        section.equation(Formula::List(vec![
            Formula::equal(
                w,
                Formula::Product(vec![
                    Formula::Sum(vec![sym, a.clone()]),
                    Formula::Inverse(Box::new(ct)),
                ]),
            ),
            Formula::equal(
                a,
                Formula::Quotient(
                    Box::new(Formula::Product(vec![step.clone(), edge])),
                    Box::new(Formula::Expr(expr::integer(2))),
                ),
            ),
        ]));
    }
    let method = match d.solve.method {
        Method::FreeMoserVeselov => "The stepper solves it explicitly, with κ found once",
        Method::ForcedMoserVeselov => {
            "The stepper solves it explicitly, with one quartic for κ a step"
        }
        Method::Newton => "The stepper iterates with Newton's method on the group",
    };
    section.text(&format!("{method}: {}.", d.solve.reason));
}

fn invariants(d: &Derivation, doc: &mut Document) {
    let section = doc.section("Invariants");
    let items: Vec<Vec<Inline>> = d
        .invariants
        .iter()
        .map(|v| {
            let mut line: Vec<Inline> = vec![format!("{}: ", v.name.replace('_', " ")).into()];
            match &v.value {
                Some(e) => line.push(math(e).into()),
                None => line.push("kinetic plus potential energy of the limit".into()),
            }
            let how = if v.exact { "exact" } else { "bounded" };
            line.push(format!(" ({how}: {})", v.reason).into());
            line
        })
        .collect();
    if items.is_empty() {
        section.text("None was found among the candidates.");
    } else {
        section.list(items);
    }
    section.text(if d.reversible {
        "The action of one step changes sign when its ends change places and the step changes sign: the scheme is symmetric under time reversal, of even order, and may be composed."
    } else {
        "The action of one step is not symmetric under time reversal: the scheme is of first order and must not be composed."
    });
}

fn limit(d: &Derivation, doc: &mut Document) {
    let section = doc.section("Limit of small steps");
    match &d.limit {
        Ok(l) => {
            section
                .text("With the velocity exp(h ξ), the action of one step per unit time tends to");
            section.equation(Formula::equal(Formula::name("L"), math(&l.lagrangian)));
        }
        Err(why) => {
            section.text(&format!("There is none: {why}."));
        }
    }
}

fn certificate(d: &Derivation, doc: &mut Document) {
    let section = doc.section("Certificate");
    section.text(&format!("{}:", d.certificate.summary()));
    section.list(
        d.certificate
            .steps
            .iter()
            .map(|step| vec![Inline::from(format!("{}.", step.name))])
            .collect(),
    );
}
