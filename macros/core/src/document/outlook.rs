//! Consequences of the equations: invariants, the continuous equations of motion as the step size tends to zero, and
//! the identities that prove the derivation.

use super::citations::Place;
use super::sheet::{Sheet, references};
use crate::check::spec::Configuration;
use crate::derive::holds;
use crate::derive::invariants::{CasimirSearch, Invariant, Kind};
use crate::derive::limit::STANDING;
use crate::derive::reversal::Reversal;
use crate::expr::{self, Letter, Shift, spelling};
use crate::print::document::{Document, Inline, Section};
use crate::print::formula::{Formula, Relation};

/// The section on invariants and time reversal.
pub fn invariants(sheet: &Sheet, doc: &mut Document) {
    let d = sheet.d;
    let section = doc.section("Invariants");
    let mut items: Vec<Vec<Inline>> = d.invariants.iter().map(|v| invariant(sheet, v)).collect();
    if let CasimirSearch::NotSought(why) = &d.integrability.casimirs {
        items.push(vec![
            format!("clebsch does not look for Casimirs: {why}").into(),
        ]);
    }
    if items.is_empty() {
        section.text("None was found among the candidates.");
    } else {
        section.list(items);
    }
    let energy = &d.integrability.discrete_energy;
    let (how, why) = d.discrete_energy();
    section
        .text("The discrete energy of an edge")
        .equation(sheet.derived(&energy.value))
        .labelled("energy")
        .text(&format!("is {how}: {why}."));
    reversal(sheet, section);
}

/// States whether the step is reversible, so that steps may be composed, or why it is not.
fn reversal(sheet: &Sheet, section: &mut Section) {
    let step = sheet.here(sheet.d.spec.step);
    let symmetric = |ends: &str| -> Vec<Inline> {
        vec![
            "The discrete Lagrangian changes sign when the ends of the step are exchanged and ".into(),
            step.clone().into(),
            " is replaced by ".into(),
            Formula::neg(step.clone()).into(),
            format!(", that is, it is self-adjoint{ends}: the scheme is symmetric under time reversal, of even order, and may be composed.").into(),
        ]
    };
    let first = "the scheme is of first order and must not be composed.";
    match &sheet.d.reversal {
        Reversal::Symmetric => section.paragraph(symmetric("")),
        Reversal::Assumed => section.paragraph(symmetric(
            ", for the parameters that the assumptions admit",
        )),
        Reversal::Broken(None) => section.text(&format!(
            "The discrete Lagrangian is not self-adjoint: {first}"
        )),
        Reversal::Broken(Some(left)) => section.paragraph([
            "The discrete Lagrangian is not self-adjoint: the sum of the Lagrangian and its adjoint (ends exchanged, step reversed) is ".into(),
            sheet.derived(left).into(),
            format!(", not constant in general: {first}").into(),
        ]),
    };
}

fn invariant(sheet: &Sheet, v: &Invariant) -> Vec<Inline> {
    let mut line: Vec<Inline> =
        vec![format!("{}: ", spelling::in_words(&v.name).replace('_', " ")).into()];
    match (&v.value, &v.kind) {
        (Some(e), _) => line.push(sheet.derived(e).into()),
        (None, Kind::Spectrum) => {
            line.extend(spectrum(sheet));
        }
        (None, Kind::ConstraintRate(j)) => {
            let hold = &sheet.d.spec.holds[*j];
            line.push("rate of change of ".into());
            line.push(sheet.derived(&hold.value).into());
        }
        (None, _) => line.push("kinetic plus potential energy of the limit".into()),
    }
    let how = if v.exact { "exact" } else { "bounded" };
    line.push(format!(" ({how}: {})", v.reason).into());
    line
}

/// The coefficients of `det(ν + μ + λ C²)` in which the momentum occurs.
fn spectrum(sheet: &Sheet) -> Vec<Inline> {
    let letters = &sheet.d.letters;
    let (Some(mu), Some(lax)) = (letters.node_momentum.first(), &sheet.d.integrability.lax) else {
        return Vec::new();
    };
    let square = expr::mul(lax.factor.clone(), lax.factor.clone());
    let matrix = Formula::Sum(vec![
        sheet.free("ν"),
        sheet.here(*mu),
        Formula::Product(vec![sheet.here(letters.spectral), sheet.math(&square)]),
    ]);
    vec![
        "the coefficients of ".into(),
        Formula::operator(crate::print::formula::Operator::Det, matrix).into(),
        " that hold ".into(),
        sheet.here(*mu).into(),
        ", equation ".into(),
        Inline::reference("Lax"),
    ]
}

/// The section on the limit of small step size.
pub fn limit(sheet: &Sheet, doc: &mut Document) {
    let d = sheet.d;
    let section = doc.section("Limit of small steps");
    let (Ok(_), Some(x)) = (&d.limit, &d.continuous) else {
        if let Err(why) = &d.limit {
            let none = match why.as_str() {
                STANDING => "There is no limit",
                _ => "clebsch does not derive the limit",
            };
            section.text(&format!("{none}: {why}."));
        }
        return;
    };
    let mut words: Vec<Inline> = vec!["With ".into()];
    let velocities = d.spec.configurations.iter().zip(&d.letters.rate);
    let velocities = velocities.map(|(c, zeta)| {
        let zeta = crate::derive::continuous::velocity(&d.letters, c.group, *zeta);
        let hat = c.group.element(zeta);
        let h = sheet.here(d.spec.step);
        if c.group.is_additive() {
            let increment = Formula::Product(vec![h, Formula::Expr(hat)]);
            return vec![Inline::from(Formula::equal(
                sheet.here(c.velocity),
                increment,
            ))];
        }
        let turn = Formula::operator(
            crate::print::formula::Operator::Exp,
            Formula::Product(vec![h, Formula::Expr(hat)]),
        );
        vec![Inline::from(Formula::equal(sheet.here(c.velocity), turn))]
    });
    words.extend(super::sheet::listed(velocities.collect()));
    words.push(" the discrete Lagrangian divided by the step tends to the Lagrangian".into());
    section.paragraph(words);
    let lagrangian = sheet.symbols().fresh_name("L");
    let l = Formula::name(&lagrangian);
    section.equation(steady(Formula::equal(l, sheet.math(&x.lagrangian))));
    for (i, c) in d.spec.configurations.iter().enumerate() {
        equations(sheet, section, c, i, &lagrangian);
    }
    for (a, rate) in d.spec.advected.iter().zip(&x.rates) {
        section.equation(steady(Formula::equal(
            Formula::rate(sheet.here(a.quantity)),
            sheet.derived(rate),
        )));
    }
    let labels: Vec<String> = (0..d.spec.configurations.len())
        .map(|i| format!("balance {i}"))
        .collect();
    let mut words: Vec<Inline> = vec![
        format!(
            "This is the limit of the discrete {} equations ",
            super::motion::equations_name(sheet)
        )
        .into(),
    ];
    words.extend(references(&labels));
    words.push(" over the step".into());
    words.push(match d.spec.holds.is_empty() {
        true => ".".into(),
        false => "; the constraints on configurations determine the multipliers.".into(),
    });
    section.paragraph(words);
}

/// Momentum, Euler-Poincaré equation and reconstruction of one configuration.
fn equations(sheet: &Sheet, section: &mut Section, c: &Configuration, i: usize, l: &str) {
    let d = sheet.d;
    let Some(x) = &d.continuous else { return };
    let (Some(mu), Some(zeta)) = (d.letters.node_momentum.get(i), d.letters.rate.get(i)) else {
        return;
    };
    let zeta_letter = Letter {
        symbol: *zeta,
        shift: Shift::HERE,
    };
    let (Some(momentum), Some(coadjoint), Some(force)) =
        (x.momenta.get(i), x.coadjoint.get(i), x.forces.get(i))
    else {
        return;
    };
    let gradient = |letter: Letter| Formula::Gradient {
        of: l.to_owned(),
        wrt: letter,
    };
    let derivative = if sheet.has_vectors(c) || !c.group.is_orthogonal() {
        gradient(zeta_letter)
    } else {
        Formula::Product(vec![Formula::Expr(expr::integer(2)), gradient(zeta_letter)])
    };
    let mu = sheet.here(*mu);
    let field = c.group.is_additive();
    if field {
        section.text("The momentum and the Euler-Lagrange equation:");
    } else {
        section.paragraph([
            "The momentum and the Euler-Poincaré equation with advected quantities, ".into(),
            steady(Formula::equal(
                Formula::pairing(
                    Formula::lie_ad_star(sheet.here(*zeta), mu.clone()),
                    sheet.free("ξ"),
                ),
                Formula::pairing(
                    mu.clone(),
                    Formula::Bracket(Box::new(sheet.here(*zeta)), Box::new(sheet.free("ξ"))),
                ),
            ))
            .into(),
            ":".into(),
        ]);
    }
    section.equation(steady(Formula::Relation(
        vec![mu.clone(), derivative, sheet.derived(momentum)],
        Relation::Equal,
    )));
    let ad_star = Formula::lie_ad_star(sheet.here(*zeta), mu.clone());
    let ad_star = if c.side.is_body() {
        ad_star
    } else {
        Formula::neg(ad_star)
    };
    let mut named = match field {
        true => Vec::new(),
        false => vec![ad_star],
    };
    for (j, (a, g)) in d.spec.advected.iter().zip(&x.gradients).enumerate() {
        if !g.is_zero() && sheet.moves(i, j) {
            let wrt = Letter {
                symbol: a.quantity,
                shift: Shift::HERE,
            };
            named.push(Formula::diamond(gradient(wrt), sheet.here(a.quantity)));
        }
    }
    let element = Letter {
        symbol: c.element,
        shift: Shift::HERE,
    };
    if expr::contains(&x.lagrangian, element) {
        named.push(match field {
            true => gradient(element),
            false => Formula::diamond(gradient(element), sheet.here(c.element)),
        });
    }
    let reactions = holds::reactions(d, i);
    let reactions = || reactions.iter().map(|e| sheet.derived(e));
    named.extend(reactions());
    if named.is_empty() {
        named.push(Formula::Expr(expr::zero(
            d.letters.symbols.get(c.element).shape,
        )));
    }
    let known = [sheet.derived(coadjoint), sheet.derived(force)];
    let explicit = Formula::Sum(known.into_iter().chain(reactions()).collect());
    section.sourced(
        steady(Formula::Relation(
            vec![Formula::rate(mu), Formula::Sum(named), explicit],
            Relation::Equal,
        )),
        sheet.source(Place::Continuous),
    );
    section.labelled(&format!("continuous {i}"));
    if let Some(turn) = x.reconstruction.get(i) {
        section.equation(steady(Formula::equal(
            Formula::rate(sheet.here(c.element)),
            sheet.derived(turn),
        )));
    }
}

fn steady(f: Formula) -> Formula {
    Formula::continuous(f)
}

/// The identities that prove the derivation.
pub fn certificate(sheet: &Sheet, doc: &mut Document) {
    let d = sheet.d;
    let section = doc.section("Certificate");
    section.appendix = true;
    section.text(&format!("{}:", d.certificate.summary()));
    let items = d.certificate.steps.iter();
    section.list(
        items
            .map(|step| vec![Inline::from(format!("{}.", step.name))])
            .collect(),
    );
}
