//! The equation of a step on SU(2), if it reduces to one scalar equation: the equation, its linear part and the
//! scalar.

use super::sheet::Sheet;
use crate::check::spec::Configuration;
use crate::derive::quaternionic::Quaternionic;
use crate::expr::{self, Expr};
use crate::print::document::{Inline, Section};
use crate::print::formula::{Formula, Relation};

/// Adds the equation and how it is solved.
pub(super) fn equation(
    sheet: &Sheet,
    section: &mut Section,
    c: &Configuration,
    q: &Quaternionic,
    i: usize,
) {
    let d = sheet.d;
    let name = |base: &str| sheet.name(base, i);
    let (w, v, a, real) = (name("w"), name("v"), name("A"), name("β"));
    let (u, s) = (name("u"), name("s"));
    let mu = expr::here(sheet.symbols(), d.letters.node_momentum[i]);
    let n = match q.edge.rest.is_zero() {
        true => Formula::Expr(mu.clone()),
        false => name("N"),
    };
    let h = sheet.here(d.spec.step);
    let number = |k: i64| Formula::Expr(expr::integer(k));
    let product = |list: &[&Formula]| Formula::Product(list.iter().map(|f| (*f).clone()).collect());
    let boxed = |f: &Formula| Box::new(f.clone());
    let image = product(&[&a, &v]);
    section.paragraph([
        "There is no Riccati form for ".into(),
        sheet.here(c.velocity).into(),
        ": the group is not SO(n). In terms of its real part ".into(),
        w.clone().into(),
        " and its imaginary part ".into(),
        v.clone().into(),
        ", equation ".into(),
        Inline::reference(&format!("outgoing {i}")),
        " reads".into(),
    ]);
    let half = Formula::Quotient(Box::new(product(&[&h, &n])), Box::new(number(2)));
    section.equation(Formula::Relation(
        vec![
            Formula::Sum(vec![
                product(&[&w, &a, &v]),
                Formula::Cross(boxed(&v), Box::new(image.clone())),
                product(&[&real, &v]),
            ]),
            half,
            u.clone(),
        ],
        Relation::Equal,
    ));
    let mut with = vec![
        Formula::equal(a.clone(), sheet.math(&q.edge.factor)),
        Formula::equal(real.clone(), sheet.math(&q.real)),
    ];
    if !q.edge.rest.is_zero() {
        let rest = sheet.derived(&expr::sub(mu, q.edge.rest.clone()));
        with.push(Formula::equal(n, rest));
    }
    section.equation(Formula::List(with));
    section.text("If the number");
    let less = Formula::minus(number(1), w.clone());
    section.equation(Formula::equal(
        s.clone(),
        Formula::Sum(vec![
            Formula::Dot(boxed(&v), Box::new(image)),
            Formula::Product(vec![real.clone(), less.clone()]),
        ]),
    ));
    section.text("is known, the equation is linear:");
    let id: Expr = expr::identity(crate::expr::shape::Dim::Fixed(3));
    let shifted = Formula::Product(vec![
        Formula::minus(real.clone(), s.clone()),
        Formula::Expr(id),
    ]);
    let matrix = Formula::Sum(vec![a, shifted, Formula::neg(Formula::hat(u.clone()))]);
    section.equation(Formula::equal(
        Formula::Product(vec![matrix, v.clone()]),
        product(&[&w, &u]),
    ));
    section.paragraph([
        "This gives the direction of ".into(),
        Formula::List(vec![w.clone(), v.clone()]).into(),
        " as polynomials in ".into(),
        s.clone().into(),
        "; the length is 1. One equation for ".into(),
        s.clone().into(),
        " remains:".into(),
    ]);
    section.equation(Formula::equal(
        Formula::minus(Formula::Dot(boxed(&u), boxed(&v)), product(&[&s, &w])),
        Formula::Product(vec![real, less]),
    ));
}
