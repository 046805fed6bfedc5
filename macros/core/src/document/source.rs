//! The canonical text of a model. It is stored with results, and derives the same model again.

use crate::check::spec::{Assumption, Configuration, Spec, Subject};
use crate::derive::Derivation;
use crate::expr::functional::Kind;
use crate::expr::shape::Structure;
use crate::expr::symbol::SymbolId;
use crate::expr::{self, Expr, Letter, Shift};
use crate::groups;
use crate::print::statement;
use crate::syntax::ast::{Comparison, NodeRule};

/// The canonical text of the model.
pub fn source(d: &Derivation) -> String {
    let spec = &d.spec;
    let st = super::style(d);
    let increments = increments(spec);
    let show = |e: &Expr| {
        let e = expr::substitute(&spec.symbols, e, &increments);
        statement(&e, &spec.symbols, &st)
    };
    let name = |id: SymbolId| spec.symbols.get(id).name.clone();
    let mut out = String::new();
    for line in &spec.docs {
        out.push_str(&format!("///{line}\n"));
    }
    let public = if spec.public { "pub " } else { "" };
    out.push_str(&format!("{public}model {} {{\n", spec.name));
    let mut line = |docs: &[String], text: String| {
        for doc in docs {
            out.push_str(&format!("    ///{doc}\n"));
        }
        out.push_str(&format!("    {text};\n"));
    };
    let docs = |id: SymbolId| spec.symbols.get(id).docs.as_slice();
    let named = |id: SymbolId| match &spec.symbols.get(id).typeset {
        Some(latex) => format!(" as \"{latex}\""),
        None => String::new(),
    };
    let said = |subject| spec.remark(subject);
    for (i, n) in spec.dimensions.iter().enumerate() {
        line(
            said(Subject::Dimension(i)),
            format!("dim {} in {}..={}", n.name, n.from, n.to),
        );
    }
    let step = name(spec.step);
    if spec.time_index != "k" || step != "h" {
        line(
            said(Subject::Time),
            format!("time {} step {step}", spec.time_index),
        );
    }
    for p in &spec.parameters {
        line(
            docs(*p),
            format!("param {}: {}{}", name(*p), shape(spec, *p), named(*p)),
        );
    }
    for (i, a) in spec.assumptions.iter().enumerate() {
        line(said(Subject::Assumption(i)), assumption(d, a));
    }
    for f in spec.symbols.functionals() {
        let kinds: Vec<String> = f.arguments.iter().map(|k| kind(spec, *k)).collect();
        let text = format!(
            "given {}({}): {} = {}",
            f.name,
            kinds.join(", "),
            kind(spec, f.value),
            f.path
        );
        line(&[], text);
    }
    for text in &spec.formulas {
        line(&[], text.clone());
    }
    for c in &spec.configurations {
        let group = c.group.statement(&|n| spec.symbols.dim_text(n).to_string());
        if c.group.is_additive() {
            let declared = format!("field {}: {group}{}", name(c.element), named(c.element));
            line(docs(c.element), declared);
            continue;
        }
        line(
            docs(c.element),
            format!(
                "group {}: {group}{} velocity {}{}",
                name(c.element),
                named(c.element),
                name(c.velocity),
                named(c.velocity)
            ),
        );
    }
    for a in spec.advected.iter().filter(|a| !a.found) {
        let definition = a.definition.as_ref().map(|e| format!(" = {}", show(e)));
        let definition = definition.unwrap_or_default();
        line(
            docs(a.quantity),
            format!(
                "advected {}: {}{}{definition}",
                name(a.quantity),
                shape(spec, a.quantity),
                named(a.quantity)
            ),
        );
    }
    let groups = spec.configurations.iter();
    let groups = groups.filter(|c| !c.group.is_additive());
    let configurations = groups.map(|c| (c.element, &c.update));
    let stated = spec.advected.iter().filter(|a| !a.found);
    let advected = stated.map(|a| (a.quantity, &a.update));
    for (quantity, update) in configurations.chain(advected) {
        line(
            said(Subject::Constraint(quantity)),
            format!("constraint next({}) = {}", name(quantity), show(update)),
        );
    }
    for hold in &spec.holds {
        line(
            said(Subject::Hold(hold.multiplier)),
            format!(
                "hold {}: {} = {}",
                name(hold.multiplier),
                show(&hold.left),
                show(&hold.right)
            ),
        );
    }
    if let Some(scale) = &spec.scale {
        line(said(Subject::Scale), format!("scale {}", show(scale)));
    }
    match spec.node_rule {
        NodeRule::Symmetric => {}
        NodeRule::Incoming => line(said(Subject::Node), "node incoming".to_owned()),
        NodeRule::Outgoing => line(said(Subject::Node), "node outgoing".to_owned()),
    }
    line(
        said(Subject::Lagrangian),
        format!("lagrangian = {}", show(&spec.typed)),
    );
    out.push('}');
    out
}

/// Increments of fields in the notation of the language: `next(X) - X`.
fn increments(spec: &Spec) -> Vec<(Letter, Expr)> {
    let s = &spec.symbols;
    let fields = spec.configurations.iter().filter(|c| c.group.is_additive());
    let difference = |c: &Configuration| {
        let end = expr::letter(s, c.element, Shift::NEXT);
        (at(c.velocity), expr::sub(end, expr::here(s, c.element)))
    };
    fields.map(difference).collect()
}

fn at(symbol: SymbolId) -> Letter {
    Letter {
        symbol,
        shift: Shift::HERE,
    }
}

/// An assumption as a statement.
pub(super) fn assumption(d: &Derivation, a: &Assumption) -> String {
    let st = super::style(d);
    let show = |e: &Expr| statement(e, &d.spec.symbols, &st);
    let relation = match a.relation {
        Comparison::Equal => "==",
        Comparison::Greater => ">",
        Comparison::AtLeast => ">=",
        Comparison::Less => "<",
        Comparison::AtMost => "<=",
    };
    format!("assume {} {relation} {}", show(&a.left), show(&a.right))
}

fn shape(spec: &Spec, id: SymbolId) -> String {
    let symbol = spec.symbols.get(id);
    kind(
        spec,
        Kind {
            shape: symbol.shape,
            structure: symbol.structure,
        },
    )
}

fn kind(spec: &Spec, symbol: Kind) -> String {
    let (rows, cols) = (
        spec.symbols.dim_text(symbol.shape.rows),
        spec.symbols.dim_text(symbol.shape.cols),
    );
    if symbol.shape.is_scalar() {
        return "Real".to_owned();
    }
    if symbol.shape.is_vector() {
        return format!("Vec<{rows}>");
    }
    match symbol.structure {
        Structure::Symmetric => format!("Sym<{rows}>"),
        Structure::Skew => format!("Skew<{rows}>"),
        Structure::Diagonal => format!("Diag<{rows}>"),
        Structure::General if symbol.shape.is_square() => format!("Mat<{rows}>"),
        Structure::General => format!("Mat<{rows}, {cols}>"),
        Structure::Orthogonal
        | Structure::Invertible
        | Structure::UnitQuaternion
        | Structure::RigidMotion => {
            let group = groups::of_elements(symbol.structure, symbol.shape);
            let size = |n| spec.symbols.dim_text(n);
            group.map_or(format!("Mat<{rows}>"), |g| g.statement(&size))
        }
    }
}
