//! Elimination of the multipliers: the momentum map at both ends of an edge, and from it the discrete Euler-Poincaré
//! equations with coadjoint action and diamonds, each defined where it is used.

use super::citations::Place;
use super::compose::{pairing, relation_label, transport_label, variation_label};
use super::sheet::{Sheet, references};
use crate::check::spec::Configuration;
use crate::derive::momentum::Momentum;
use crate::expr::symbol::{Role, SymbolId};
use crate::expr::{self, Expr, Letter, Shift};
use crate::print::document::{Document, Inline, Section};
use crate::print::formula::{Formula, Operator, Relation};

/// The quantities in the action that vary with configuration `i`: symbol, whether the outgoing edge depends on it,
/// and whether the incoming edge does.
fn forces(sheet: &Sheet, i: usize) -> Vec<(SymbolId, bool, bool)> {
    let d = sheet.d;
    let s = sheet.symbols();
    let holds = |symbol: SymbolId, shift: Shift| {
        !expr::gradient(s, &d.action.total, Letter { symbol, shift }).is_zero()
    };
    let advected = d.spec.advected.iter().enumerate();
    let advected = advected.filter(|(j, _)| sheet.moves(i, *j));
    let elements = d.spec.configurations.get(i).map(|c| c.element);
    advected
        .map(|(_, a)| a.quantity)
        .chain(elements)
        .map(|x| (x, holds(x, Shift::HERE), holds(x, Shift::NEXT)))
        .filter(|(_, start, end)| *start || *end)
        .collect()
}

/// `(∇_a ℓ_{k-1} + ∇_a ℓ_k) ◇ a` for each advected quantity.
fn diamonds(sheet: &Sheet, i: usize) -> Vec<Formula> {
    let each = forces(sheet, i).into_iter().map(|(x, start, end)| {
        let incoming = end.then(|| sheet.gradient(-1, x));
        let outgoing = start.then(|| sheet.gradient(0, x));
        let terms: Vec<Formula> = incoming.into_iter().chain(outgoing).collect();
        let gradient = match <[Formula; 1]>::try_from(terms) {
            Ok([only]) => only,
            Err(both) => Formula::Sum(both),
        };
        // For a field, the force is the gradient itself.
        let own = |c: &Configuration| c.element == x && c.group.is_additive();
        match sheet.d.spec.configurations.iter().any(own) {
            true => gradient,
            false => Formula::diamond(gradient, sheet.here(x)),
        }
    });
    each.collect()
}

/// `Ad*_Ω M`.
fn carried(sheet: &Sheet, c: &Configuration, i: usize, shift: Shift) -> Formula {
    match c.group.is_additive() {
        true => sheet.edge_momentum(i, shift),
        false => Formula::ad_star(sheet.at(c.velocity, shift), sheet.edge_momentum(i, shift)),
    }
}

/// The section on momentum maps: of the multipliers, and of the edge at both its ends.
pub fn momentum_maps(sheet: &Sheet, doc: &mut Document) {
    let d = sheet.d;
    let section = doc.section("Momentum maps");
    definitions(sheet, section);
    for (i, (c, m)) in d.spec.configurations.iter().zip(&d.momenta).enumerate() {
        let translation = match c.group.is_additive() {
            true => "translation",
            false => c.side.of("right translation", "left translation"),
        };
        let lifted = if (0..d.spec.advected.len()).any(|j| sheet.moves(i, j)) {
            " and of the associated action on the advected quantities, cotangent-lifted to the multipliers, at a node:"
        } else {
            ", cotangent-lifted to its multiplier, at a node:"
        };
        section.paragraph([
            format!("The momentum map of the {translation} of ").into(),
            sheet.here(c.element).into(),
            lifted.into(),
        ]);
        let mut terms = vec![sheet.derived(&m.cotangent)];
        for (j, a) in d.spec.advected.iter().enumerate() {
            if sheet.moves(i, j)
                && let Some(v) = d.letters.multiplier.get(j)
            {
                terms.push(Formula::diamond(sheet.here(*v), sheet.here(a.quantity)));
            }
        }
        section.sourced(
            Formula::equal(sheet.lifted(i, 0), Formula::Sum(terms)),
            sheet.source(Place::Lifted),
        );
        section.labelled(&format!("lifted {i}"));
        section.paragraph(["The edge momentum:".into()]);
        edge(sheet, section, c, m, i);
        elimination(sheet, section, c, i);
    }
}

/// Defines pairing, diamond and coadjoint action, one sentence each.
fn definitions(sheet: &Sheet, section: &mut Section) {
    let d = sheet.d;
    let free = |base: &str| sheet.free(base);
    let orthogonal = d
        .spec
        .configurations
        .iter()
        .any(|c| c.group.is_orthogonal());
    if orthogonal {
        section.paragraph([
            "Skew matrices are paired with half the trace, ".into(),
            pairing(free("M"), free("ξ"), true).into(),
            ", which in three dimensions is the scalar product of their axial vectors.".into(),
        ]);
    }
    if d.spec.has_only_fields() {
        return;
    }
    let star = Formula::ad_star(free("g"), free("M"));
    let turned = Formula::Product(vec![
        Formula::transpose(free("g")),
        free("M"),
        Formula::transpose(Formula::Inverse(Box::new(free("g")))),
    ]);
    section.paragraph([
        "The coadjoint action is ".into(),
        Formula::equal(star, turned).into(),
        ", the dual of ".into(),
        Formula::equal(
            Formula::Ad {
                group: Box::new(free("g")),
                argument: Box::new(free("ξ")),
            },
            Formula::Product(vec![
                free("g"),
                free("ξ"),
                Formula::Inverse(Box::new(free("g"))),
            ]),
        )
        .into(),
        ".".into(),
    ]);
    let moved: Vec<(usize, usize)> = (0..d.spec.configurations.len())
        .flat_map(|i| (0..d.spec.advected.len()).map(move |j| (i, j)))
        .filter(|(i, j)| sheet.moves(*i, *j))
        .collect();
    let elements = (0..d.spec.configurations.len()).any(|i| {
        let own = forces(sheet, i).into_iter();
        own.filter(|(x, ..)| sheet.symbols().get(*x).role == Role::Element)
            .count()
            > 0
    });
    if moved.is_empty() && !elements {
        return;
    }
    let labels: Vec<String> = moved.iter().map(|(i, j)| variation_label(*i, *j)).collect();
    let mut words: Vec<Inline> = vec![
        "The diamond of a covector and a quantity is defined by ".into(),
        Formula::equal(
            Formula::pairing(Formula::diamond(free("v"), free("a")), free("ξ")),
            Formula::pairing(free("v"), Formula::apply(free("ξ"), vec![free("a")])),
        )
        .into(),
        ", where ".into(),
        Formula::apply(free("ξ"), vec![free("a")]).into(),
        " is the action of the Lie algebra on the quantity, that is its variation along ".into(),
        free("ξ").into(),
    ];
    if !labels.is_empty() {
        words.push(
            if labels.len() == 1 {
                ", equation "
            } else {
                ", equations "
            }
            .into(),
        );
        words.extend(references(&labels));
    }
    words.push(
        "; it is the diamond of Holm, Marsden and Ratiu (1998), for whom the variation is ".into(),
    );
    words.push(Formula::neg(Formula::Product(vec![free("ξ"), free("a")])).into());
    words.push(if moved.is_empty() {
        ".".into()
    } else {
        ":".into()
    });
    section.paragraph(words);
    for (i, j) in moved {
        let (Some(m), Some(a), Some(v)) = (
            d.momenta.get(i).and_then(|m| m.diamonds.get(j)),
            d.spec.advected.get(j),
            d.letters.multiplier.get(j),
        ) else {
            continue;
        };
        let mut parts = vec![Formula::equal(
            Formula::diamond(sheet.here(*v), sheet.here(a.quantity)),
            sheet.derived(m),
        )];
        if let Some(c) = d.spec.configurations.get(i)
            && d.spec.configurations.len() > 1
        {
            parts.push(Formula::text("for"));
            parts.push(sheet.here(c.element));
        }
        section.equation(match <[Formula; 1]>::try_from(parts) {
            Ok([only]) => only,
            Err(several) => Formula::Sequence(several),
        });
    }
}

/// The edge momentum as the gradient with respect to the velocity.
fn edge(sheet: &Sheet, section: &mut Section, c: &Configuration, m: &Momentum, i: usize) {
    let product = Formula::Product(vec![
        sheet.gradient(0, c.velocity),
        Formula::transpose(sheet.here(c.velocity)),
    ]);
    let by_gradient = if c.group.is_additive() {
        Some(sheet.gradient(0, c.velocity))
    } else if c.group.is_orthogonal() {
        Some(Formula::Product(vec![
            Formula::Expr(expr::integer(2)),
            Formula::operator(Operator::Skew, product),
        ]))
    } else {
        // If the group has coordinates, the pairing with the gradient is already the reduced form.
        c.group.coordinates().is_none().then_some(product)
    };
    section.sourced(
        Formula::Relation(
            [Some(sheet.edge_momentum(i, Shift::HERE)), by_gradient]
                .into_iter()
                .flatten()
                .chain([sheet.derived(&m.reduced)])
                .collect(),
            Relation::Equal,
        ),
        sheet.source(Place::Momentum),
    );
}

/// Multiplies the Clebsch relation of the velocity by the velocity from either side.
fn elimination(sheet: &Sheet, section: &mut Section, c: &Configuration, i: usize) {
    if c.group.is_additive() {
        return of_field(sheet, section, c, i);
    }
    let (behind, before) = c.side.of(
        ("from the right", "from the left"),
        ("from the left", "from the right"),
    );
    let half = if c.group.is_orthogonal() {
        " and take twice the skew part"
    } else if c.group.coordinates().is_some() {
        " and pair with the Lie algebra"
    } else {
        ""
    };
    let turned: Inline = Formula::transpose(sheet.here(c.velocity)).into();
    let mut others = vec![relation_label(c.element)];
    let advected = sheet.d.spec.advected.iter().enumerate();
    let advected = advected.filter(|(j, _)| sheet.moves(i, *j));
    others.extend(advected.clone().map(|(_, a)| relation_label(a.quantity)));
    let mut words: Vec<Inline> = vec![
        "Multiply ".into(),
        Inline::reference(&relation_label(c.velocity)),
        " by ".into(),
        turned.clone(),
        format!(" {behind}{half}; with ").into(),
    ];
    words.extend(references(&others));
    words.push(" this gives the momentum map at the start of the edge:".into());
    section.paragraph(words);
    let (start, end) = if c.side.is_body() {
        (
            sheet.edge_momentum(i, Shift::HERE),
            carried(sheet, c, i, Shift::HERE),
        )
    } else {
        (
            carried(sheet, c, i, Shift::HERE),
            sheet.edge_momentum(i, Shift::HERE),
        )
    };
    let mut terms = vec![sheet.lifted(i, 0)];
    terms.extend(diamonds(sheet, i));
    section.sourced(
        Formula::equal(start, Formula::Sum(terms)),
        sheet.source(Place::AtStart),
    );
    section.labelled(&format!("start {i}"));
    let mut words: Vec<Inline> = vec![
        "Multiplying by ".into(),
        turned,
        format!(" {before} instead gives, by the constraints, the momentum map at its end:").into(),
    ];
    if advected.count() == 0 {
        words = vec![
            "Multiplying by ".into(),
            Formula::transpose(sheet.here(c.velocity)).into(),
            format!(" {before} instead gives, by the reconstruction, the momentum map at its end:")
                .into(),
        ];
    }
    section.paragraph(words);
    section.sourced(
        Formula::equal(end, sheet.lifted(i, 1)),
        sheet.source(Place::AtEnd),
    );
    section.labelled(&format!("end {i}"));
}

/// Elimination for a field, where nothing needs to be multiplied.
fn of_field(sheet: &Sheet, section: &mut Section, c: &Configuration, i: usize) {
    let relation = |symbol| Inline::reference(&relation_label(symbol));
    section.paragraph([
        "By ".into(),
        relation(c.element),
        ", ".into(),
        relation(c.velocity),
        " is the momentum at the start of the edge:".into(),
    ]);
    let mut terms = vec![sheet.lifted(i, 0)];
    terms.extend(diamonds(sheet, i));
    let momentum = sheet.edge_momentum(i, Shift::HERE);
    section.equation(Formula::equal(momentum.clone(), Formula::Sum(terms)));
    section.labelled(&format!("start {i}"));
    section.text("and, without further substitution, the momentum at its end:");
    section.equation(Formula::equal(momentum, sheet.lifted(i, 1)));
    section.labelled(&format!("end {i}"));
}

/// The name of the equations of motion.
pub fn equations_name(sheet: &Sheet) -> &'static str {
    match sheet.d.spec.has_only_fields() {
        true => "Euler-Lagrange",
        false => "Euler-Poincaré",
    }
}

/// The discrete Euler-Poincaré equations and their components.
pub fn balance(sheet: &Sheet, doc: &mut Document) {
    let d = sheet.d;
    let section = doc.section(format!("Discrete {} equations", equations_name(sheet)));
    for (i, (c, b)) in d.spec.configurations.iter().zip(&d.balances).enumerate() {
        section.paragraph([
            "Subtracting ".into(),
            Inline::reference(&format!("end {i}")),
            ", shifted by one step, from ".into(),
            Inline::reference(&format!("start {i}")),
            " eliminates the multipliers:".into(),
        ]);
        let (left, first) = if c.side.is_body() {
            (
                sheet.edge_momentum(i, Shift::HERE),
                carried(sheet, c, i, Shift::PREVIOUS),
            )
        } else {
            (
                carried(sheet, c, i, Shift::HERE),
                sheet.edge_momentum(i, Shift::PREVIOUS),
            )
        };
        let terms: Vec<Formula> = [first].into_iter().chain(diamonds(sheet, i)).collect();
        section.sourced(
            Formula::equal(left, Formula::Sum(terms)),
            sheet.source(Place::Balance),
        );
        section.labelled(&format!("balance {i}"));
        gradients(sheet, section, i);
        let with: Vec<String> = (0..d.spec.advected.len()).map(transport_label).collect();
        if !with.is_empty() {
            let mut words: Vec<Inline> = vec!["Together with ".into()];
            words.extend(references(&with));
            words.push(
                format!(
                    " it forms the discrete {} equations.",
                    equations_name(sheet)
                )
                .into(),
            );
            section.paragraph(words);
        }
        let mu = sheet.here(d.letters.node_momentum[i]);
        let frame = match c.group.is_additive() {
            true => "",
            false => c.side.of("body ", "spatial "),
        };
        section.paragraph([
            format!("In terms of the {frame}momentum ").into(),
            mu.clone().into(),
            " at the node, where the first equation is solved for the velocity and the second gives the momentum at the next node:".into(),
        ]);
        section.equation(Formula::equal(mu, sheet.derived(&b.outgoing)));
        section.labelled(&format!("outgoing {i}"));
        let next = sheet.at(d.letters.node_momentum[i], Shift::NEXT);
        section.equation(Formula::equal(next, sheet.derived(&b.incoming)));
        section.labelled(&format!("incoming {i}"));
    }
}

/// Expands the gradients in the diamonds.
fn gradients(sheet: &Sheet, section: &mut Section, i: usize) {
    let d = sheet.d;
    let s = sheet.symbols();
    for (x, start, end) in forces(sheet, i) {
        let back = expr::shift_time(s, &d.action.total, Shift::PREVIOUS.time);
        let wrt = Letter {
            symbol: x,
            shift: Shift::HERE,
        };
        let structure = s.get(x).structure;
        let own = |l: &Expr| expr::projected(s, structure, &expr::gradient(s, l, wrt));
        let incoming = end.then(|| sheet.gradient(-1, x));
        let outgoing = start.then(|| sheet.gradient(0, x));
        let names: Vec<Formula> = incoming.into_iter().chain(outgoing).collect();
        let total = expr::add(own(&back), own(&d.action.total));
        section.equation(Formula::equal(Formula::Sum(names), sheet.derived(&total)));
    }
}
