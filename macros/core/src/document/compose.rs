//! Composes the sections of a derivation in the order of a paper. This file writes the sections up to the Clebsch
//! relations; other files write motion, solution and outlook.

use super::citations::{Citations, Place};
use super::sheet::{Sheet, references};
use super::{holds, motion, outlook, scheme, solution, source, structure};
use crate::check::spec::Subject;
use crate::derive::Derivation;
use crate::derive::clebsch::constraint_terms;
use crate::derive::warnings::Warning;
use crate::expr::shape::{Shape, Structure};
use crate::expr::{self, Expr, Node, Shift};
use crate::print::document::{Document, Inline, Section};
use crate::print::formula::{Formula, Relation};
use crate::syntax::ast::NodeRule;

/// What a document contains besides the equations of the derivation.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct DocumentExtras<'a> {
    /// The text of the model, if known.
    pub stated: Option<&'a str>,
    /// Where a work has the equations, and remarks on them.
    pub citations: Citations,
    /// Whether to begin with the variational principle and the algorithm of a step, as a paper does.
    pub scheme: bool,
}

/// The derivation as a document without citations.
pub fn document(d: &Derivation) -> Document {
    let told = DocumentExtras {
        stated: None,
        citations: Citations::NONE,
        scheme: false,
    };
    document_telling(d, told)
}

/// The derivation as a document with the given additions.
pub fn document_telling(d: &Derivation, told: DocumentExtras<'_>) -> Document {
    let sheet = Sheet::new(d, told.citations);
    let mut doc = Document::titled(format!("{}: discrete equations of motion", d.spec.name));
    doc.work = told.citations.work;
    model(&sheet, &mut doc, told);
    warnings(&sheet, &mut doc);
    structure::reduction(&sheet, &mut doc);
    constraints(&sheet, &mut doc);
    action(&sheet, &mut doc);
    variations(&sheet, &mut doc);
    relations(&sheet, &mut doc);
    motion::momentum_maps(&sheet, &mut doc);
    motion::balance(&sheet, &mut doc);
    solution::moser_veselov(&sheet, &mut doc);
    holds::held(&sheet, &mut doc);
    structure::bracket(&sheet, &mut doc);
    outlook::invariants(&sheet, &mut doc);
    structure::lax(&sheet, &mut doc);
    outlook::limit(&sheet, &mut doc);
    outlook::certificate(&sheet, &mut doc);
    if told.scheme {
        scheme::up_front(&sheet, &mut doc);
    }
    doc
}

fn model(sheet: &Sheet, doc: &mut Document, told: DocumentExtras<'_>) {
    let section = doc.section("Model");
    let docs = sheet.d.spec.docs.iter().map(|l| l.trim());
    let words: Vec<&str> = docs.filter(|l| !l.is_empty()).collect();
    if !words.is_empty() {
        section.text(&words.join(" "));
    }
    let own = source(sheet.d);
    section.code(without_remarks(told.stated.unwrap_or(&own)));
    let meanings = meanings(sheet);
    if !meanings.is_empty() {
        section.list(meanings);
    }
    if !told.citations.statement.is_empty() {
        section.paragraph(Inline::with_names(told.citations.statement));
    }
}

/// Removes the comments from the text of a model.
pub fn without_remarks(stated: &str) -> String {
    let bare = |line: &str| line.split("//").next().unwrap_or("").trim_end().to_owned();
    let lines = stated
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .map(bare);
    lines.collect::<Vec<String>>().join("\n").trim().to_owned()
}

/// The model's documentation of its symbols and statements.
fn meanings(sheet: &Sheet) -> Vec<Vec<Inline>> {
    let spec = &sheet.d.spec;
    let mut out: Vec<Vec<Inline>> = Vec::new();
    // The documentation of the last item, and the position after its names: one statement documents all its names.
    let mut shared: Option<(String, usize)> = None;
    // Letters that the derivation adds are undocumented.
    for id in spec.symbols.ids() {
        let symbol = spec.symbols.get(id);
        let doc = symbol.doc();
        if doc.is_empty() && symbol.typeset.is_none() {
            continue;
        }
        // Printed without a time index: the sentence names the quantity, not its value at a node.
        let name: Inline = Formula::Continuous(Box::new(sheet.here(id))).into();
        if symbol.typeset.is_none()
            && let Some((_, end)) = shared.as_mut().filter(|(shared, _)| *shared == doc)
            && let Some(item) = out.last_mut()
        {
            item.splice(*end..*end, [", ".into(), name]);
            *end += 2;
            continue;
        }
        shared = symbol.typeset.is_none().then(|| (doc.clone(), 1));
        let mut words: Vec<Inline> = vec![name];
        if symbol.typeset.is_some() {
            words.extend([" is ".into(), Inline::Code(symbol.name.clone())]);
            words.push(" of the model".into());
        }
        if !doc.is_empty() {
            words.push(": ".into());
            words.extend(Inline::marked(&doc));
        }
        out.push(words);
    }
    for (subject, lines) in &spec.remarks {
        let name = |id| &spec.symbols.get(id).name;
        let statement = match subject {
            Subject::Dimension(i) => match spec.dimensions.get(*i) {
                Some(n) => n.name.clone(),
                None => "dim".to_owned(),
            },
            Subject::Time => "time".to_owned(),
            Subject::Assumption(i) => {
                let a = spec.assumptions.get(*i);
                a.map_or_else(|| "assume".to_owned(), |a| source::assumption(sheet.d, a))
            }
            Subject::Constraint(id) => format!("constraint next({})", name(*id)),
            Subject::Hold(id) => format!("hold {}", name(*id)),
            Subject::Scale => "scale".to_owned(),
            Subject::Node => "node".to_owned(),
            Subject::Lagrangian => "lagrangian".to_owned(),
        };
        let words: Vec<&str> = lines.iter().map(|l| l.trim()).collect();
        let mut item = vec![Inline::Code(statement), ": ".into()];
        item.extend(Inline::marked(words.join(" ").trim()));
        out.push(item);
    }
    out
}

/// The warnings, if there are any.
fn warnings(sheet: &Sheet, doc: &mut Document) {
    let list = &sheet.d.warnings;
    if list.is_empty() {
        return;
    }
    doc.remarks = list.iter().map(Warning::remark).collect();
    let items = list.iter().map(|w| {
        let mut words = Inline::marked(&w.diagnostic.message);
        words.push(".".into());
        for help in &w.diagnostic.help {
            words.push(" ".into());
            words.extend(Inline::marked(&capitalised(help)));
            words.push(".".into());
        }
        words
    });
    doc.section("Warnings").list(items.collect());
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(letters).collect()
}

fn constraints(sheet: &Sheet, doc: &mut Document) {
    let spec = &sheet.d.spec;
    let section = doc.section("Constraints");
    for c in &spec.configurations {
        if c.group.is_additive() {
            let (here, next) = (sheet.here(c.element), sheet.at(c.element, Shift::NEXT));
            section.paragraph([
                here.clone().into(),
                format!(", {}, is the configuration at node ", sheet.group(c)).into(),
                Formula::name(&spec.time_index).into(),
                "; its velocity is the increment ".into(),
                Formula::equal(
                    sheet.here(c.velocity),
                    Formula::Sum(vec![next.clone(), Formula::neg(here)]),
                )
                .into(),
                " over the edge from this node to the next:".into(),
            ]);
            section.equation(Formula::equal(next, sheet.math(&c.update)));
            continue;
        }
        // Rigid bodies have a body frame; linear groups describe deformations of a reference shape.
        let rigid = !c.group.is_linear();
        let (frame, product) = match (rigid, c.side.is_body()) {
            (true, true) => ("; its velocity in the body is ", true),
            (true, false) => ("; its velocity in space is ", false),
            (false, true) => ("; its convective velocity is ", true),
            (false, false) => ("; its velocity in space is ", false),
        };
        let from = if rigid {
            "the body"
        } else {
            "the reference shape"
        };
        let (element, next) = (sheet.here(c.element), sheet.at(c.element, Shift::NEXT));
        let back = if c.group.structure().is_orthogonal() {
            Formula::transpose(element.clone())
        } else {
            Formula::Inverse(Box::new(element.clone()))
        };
        let velocity = if product {
            vec![back, next]
        } else {
            vec![next, back]
        };
        section.paragraph([
            element.into(),
            format!(" in {} is the configuration at node ", sheet.group(c)).into(),
            Formula::name(&spec.time_index).into(),
            format!(", from {from} to space{frame}").into(),
            Formula::equal(sheet.here(c.velocity), Formula::Product(velocity)).into(),
            ", on the edge from this node to the next:".into(),
        ]);
        let equation = Formula::equal(sheet.at(c.element, Shift::NEXT), sheet.math(&c.update));
        section.sourced(
            equation,
            sheet.source(Place::Reconstruction(sheet.name_of(c.element))),
        );
    }
    advected(sheet, section);
    holds::stated(sheet, section);
}

fn advected(sheet: &Sheet, section: &mut Section) {
    let spec = &sheet.d.spec;
    if spec.advected.is_empty() {
        return;
    }
    section.text("Advected quantities evolve by");
    for (j, a) in spec.advected.iter().enumerate() {
        let update = Formula::equal(sheet.at(a.quantity, Shift::NEXT), sheet.math(&a.update));
        let equation = match &a.definition {
            Some(e) => {
                let own = Formula::equal(sheet.here(a.quantity), sheet.math(e));
                Formula::List(vec![update, own])
            }
            None => update,
        };
        section.sourced(
            equation,
            sheet.source(Place::Rule(sheet.name_of(a.quantity))),
        );
        section.labelled(&transport_label(j));
    }
}

/// The label of the advection constraint of quantity `j`.
pub fn transport_label(j: usize) -> String {
    format!("transport {j}")
}

fn action(sheet: &Sheet, doc: &mut Document) {
    let d = sheet.d;
    let k = &d.spec.time_index;
    let section = doc.section("Discrete Lagrangian");
    if let Some(scale) = &d.spec.scale {
        let typed = Formula::name("ℓ^{typed}");
        section.paragraph([
            "The model states ".into(),
            sheet.math(scale).into(),
            " times the discrete Lagrangian:".into(),
        ]);
        let times = |e: &Expr| Formula::Product(vec![sheet.math(e), Formula::name("ℓ")]);
        let scaled = match scale.node() {
            Node::Neg(inner) => Formula::neg(times(inner)),
            _ => times(scale),
        };
        section.equation(Formula::Relation(
            vec![typed, sheet.math(&d.spec.typed), scaled],
            Relation::Equal,
        ));
        section.text("so that the discrete Lagrangian is");
        section.equation(Formula::equal(Formula::name("ℓ"), physical(sheet)));
    }
    if d.action.nodal.is_zero() {
        section.text("The discrete Lagrangian of the step from one node to the next:");
    } else {
        section.text(match d.spec.node_rule {
            NodeRule::Symmetric => {
                "Nodal terms are split evenly between the two adjacent edges. The discrete Lagrangian:"
            }
            NodeRule::Incoming => {
                "Nodal terms belong to the edge that ends at the node. The discrete Lagrangian:"
            }
            NodeRule::Outgoing => {
                "Nodal terms belong to the edge that starts at the node. The discrete Lagrangian:"
            }
        });
    }
    section.sourced(
        Formula::defined(
            Formula::name(&format!("ℓ_{k}")),
            sheet.math(&d.action.total),
        ),
        sheet.source(Place::Action),
    );
    let weight = if d
        .spec
        .configurations
        .iter()
        .any(|c| c.group.is_orthogonal())
    {
        ", and gradients are taken in this pairing. The Clebsch action adds one multiplier for each constraint; the multiplier of a rotation enters with a factor 1/2:"
    } else {
        ", and gradients are taken in this pairing. The Clebsch action adds one multiplier for each constraint:"
    };
    section.paragraph([
        "Matrices are paired by ".into(),
        pairing(sheet.free("A"), sheet.free("B"), false).into(),
        weight.into(),
    ]);
    let terms = constraint_terms(&d.spec, &d.letters);
    let total = expr::sum(
        [d.action.total.clone()].into_iter().chain(terms),
        Shape::SCALAR,
    );
    section.sourced(
        Formula::defined(Formula::name(&format!("ℓ^c_{k}")), sheet.math(&total)),
        sheet.source(Place::ClebschAction),
    );
}

/// `⟨A, B⟩ = tr(Aᵀ B)`, or half of it.
pub fn pairing(a: Formula, b: Formula, half: bool) -> Formula {
    let product = Formula::Product(vec![Formula::transpose(a.clone()), b.clone()]);
    let trace = Formula::operator(crate::print::formula::Operator::Trace, product);
    let value = if half {
        Formula::Product(vec![
            Formula::Expr(expr::number(crate::algebra::Rational::HALF)),
            trace,
        ])
    } else {
        trace
    };
    Formula::equal(Formula::pairing(a, b), value)
}

/// The Lagrangian divided by its declared scale, term by term.
pub fn physical(sheet: &Sheet) -> Formula {
    let terms = crate::derive::action::summands(&sheet.d.letters.symbols, &sheet.d.spec.lagrangian);
    sheet.math(&expr::sum(terms, Shape::SCALAR))
}

fn variations(sheet: &Sheet, doc: &mut Document) {
    let d = sheet.d;
    let section = doc.section("Constrained variations");
    section.text("Let a configuration vary freely at its node; the constraints then determine the variations of the two adjacent velocities and of the advected quantities.");
    for (i, (v, xi)) in d.variations.iter().zip(&d.letters.variation).enumerate() {
        for (letter, change) in [&v.element, &v.outgoing, &v.incoming] {
            let x = sheet.at(letter.symbol, letter.shift);
            section.equation(Formula::equal(Formula::variation(x), sheet.derived(change)));
        }
        for (j, (letter, change)) in v.advected.iter().enumerate() {
            if change.is_zero() {
                continue;
            }
            let x = sheet.at(letter.symbol, letter.shift);
            section.equation(Formula::equal(Formula::variation(x), sheet.derived(change)));
            section.labelled(&variation_label(i, j));
        }
        let words = d
            .spec
            .configurations
            .get(i)
            .map(|c| c.group.variation_words());
        let algebra = match words {
            Some([line, page]) if line == page => line.into(),
            Some([line, page]) => Inline::Notation { line, page },
            None => "".into(),
        };
        section.paragraph(["Here ".into(), sheet.here(*xi).into(), algebra]);
    }
}

/// The label of the variation of advected quantity `j` by configuration `i`.
pub fn variation_label(i: usize, j: usize) -> String {
    format!("variation {i} {j}")
}

fn relations(sheet: &Sheet, doc: &mut Document) {
    let d = sheet.d;
    let section = doc.section("Clebsch relations");
    section.text("Stationarity of the sum of the Clebsch actions over all edges yields, besides the constraints, the Clebsch relations:");
    for r in &d.relations {
        let x = sheet.at(r.variable.symbol, r.variable.shift);
        let right = if r.up_to_group_multiplier {
            // An orthogonal matrix is its own inverse transpose.
            let back = match sheet.symbols().get(r.variable.symbol).structure {
                Structure::RigidMotion => Formula::transpose(Formula::Inverse(Box::new(x))),
                _ => x,
            };
            Formula::Product(vec![theta(sheet, r.variable.symbol), back])
        } else {
            Formula::Expr(expr::integer(0))
        };
        let equation = Formula::equal(sheet.derived(&r.gradient), right);
        let name = sheet.name_of(r.variable.symbol);
        section.sourced(equation, sheet.source(Place::Relation(name)));
        section.labelled(&relation_label(r.variable.symbol));
        section.noted(&format!("Variation of {name}."));
    }
    theta_explained(sheet, section);
}

fn theta(sheet: &Sheet, velocity: expr::symbol::SymbolId) -> Formula {
    let configurations = &sheet.d.spec.configurations;
    let i = configurations.iter().position(|c| c.velocity == velocity);
    sheet.name("Θ", i.unwrap_or(0))
}

fn theta_explained(sheet: &Sheet, section: &mut Section) {
    let rotations: Vec<&crate::derive::clebsch::Relation> = sheet
        .d
        .relations
        .iter()
        .filter(|r| r.up_to_group_multiplier)
        .collect();
    let names = rotations.iter().map(|r| {
        let name: Inline = theta(sheet, r.variable.symbol).into();
        vec![name]
    });
    let names = super::sheet::listed(names.collect());
    if names.is_empty() {
        return;
    }
    let labels: Vec<String> = rotations
        .iter()
        .map(|r| relation_label(r.variable.symbol))
        .collect();
    let normal = sheet.d.spec.configurations.iter();
    let normal = normal.map(|c| c.group.coordinates().is_some());
    let words = if normal.fold(false, |any, one| any | one) {
        match rotations.len() {
            1 => {
                " is normal to the Lie algebra: the multiplier of the constraint that velocities are elements of the group."
            }
            _ => {
                " are normal to the Lie algebras: the multipliers of the constraint that velocities are elements of the groups."
            }
        }
    } else if rotations.len() == 1 {
        " is a symmetric matrix, the multiplier of the constraint that velocities are rotations."
    } else {
        " are symmetric matrices, the multipliers of the constraint that velocities are rotations."
    };
    let mut parts = vec![Inline::from("In ")];
    parts.extend(references(&labels));
    parts.push(" ".into());
    parts.extend(names);
    parts.push(words.into());
    section.paragraph(parts);
}

/// The label of the Clebsch relation of a variable.
pub fn relation_label(symbol: expr::symbol::SymbolId) -> String {
    format!("relation {}", symbol.0)
}
