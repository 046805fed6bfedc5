//! Models with functionals, built for tests: a functional replaces a parameter of a Lagrangian, and every result is
//! compared with the model in which the functional is written out.

use super::warnings::Topic;
use super::{Derivation, derive};
use crate::check::{self, spec::Spec};
use crate::document::printed;
use crate::emit;
use crate::expr::functional::sample::{Sample, at};
use crate::expr::{self, Expr, Node};
use crate::interpret::{Assignment, evaluate};
use crate::print::Format;
use crate::syntax;

/// The expression that replaces the parameter `w`.
type Replacement = dyn Fn(&Sample, &dyn Fn(&str) -> Expr) -> Expr;

/// The models with a functional in place of `w`, and with its definition in place of `w`.
fn stated(body: &str, made: &Replacement) -> (Spec, Spec, Sample) {
    let text = format!("model Functional {{ param m: Real; param z: Vec<3>; {body} }}");
    let tokens = syntax::tokens(&text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let spec = check::check(&syntax::parse(tokens).unwrap_or_else(|e| panic!("{e}\n{text}")));
    let spec = spec.unwrap_or_else(|e| panic!("{e}\n{text}"));
    let sample = Sample::over(spec.symbols.clone());
    let s = &sample.symbols;
    let letter = |name: &str| match name.strip_prefix('+') {
        Some(name) => expr::letter(s, s.find(name).unwrap(), expr::Shift::NEXT),
        None => expr::here(s, s.find(name).unwrap()),
    };
    let value = made(&sample, &letter);
    let with = |value: Expr| {
        let mut spec = spec.clone();
        spec.symbols = s.clone();
        let w = at(s.find("w").unwrap());
        let put = |e: &mut Expr| *e = expr::substitute(s, e, &[(w, value.clone())]);
        put(&mut spec.lagrangian);
        put(&mut spec.typed);
        spec.terms.iter_mut().for_each(|(e, _)| put(e));
        spec
    };
    let (own, open) = (with(value.clone()), with(sample.opened(&value)));
    (own, open, sample)
}

fn derived(spec: Spec) -> Derivation {
    derive(spec).unwrap_or_else(|e| panic!("{e}"))
}

fn pair(body: &str, made: &Replacement) -> (Derivation, Derivation, Sample) {
    let (own, open, sample) = stated(body, made);
    (derived(own), derived(open), sample)
}

fn method(d: &Derivation) -> String {
    format!("{:?}", d.solve.method)
}

fn residuals(d: &Derivation, values: &Assignment) -> Vec<f64> {
    d.residual(values).unwrap_or_else(|e| panic!("{e}"))
}

fn same(a: &[f64], b: &[f64]) {
    assert_eq!(a.len(), b.len());
    let moved = a.iter().any(|x| x.abs() > 1e-3);
    let pairs = a.iter().zip(b);
    assert!(
        moved && pairs.into_iter().all(|(x, y)| (x - y).abs() < 1e-11),
        "{a:?}\n{b:?}"
    );
}

/// Rotations by these angles about axes between the third and the first.
fn turn(values: &mut Assignment, name: &str) {
    for (level, angle) in [(-1, 0.2f64), (0, 0.5), (1, 0.9)] {
        let (s, c) = angle.sin_cos();
        let (t, d) = (angle * 0.7).sin_cos();
        let about = [c, -s, 0.0, s * d, c * d, -t, s * t, c * t, d];
        values.set(name, level, 3, 3, &about);
    }
}

fn values(sample: &Sample) -> Assignment {
    let mut values = Assignment::new();
    sample.define(&mut values);
    values.set_scalar("h", 0.1);
    values.set_scalar("m", 1.4);
    values.set_scalar("w", 0.0);
    values.set("z", 0, 3, 1, &[0.4, -0.3, 0.8]);
    values.set("J", 0, 3, 3, &[1.0, 0.1, 0.0, 0.1, 0.8, 0.2, 0.0, 0.2, 0.5]);
    for (level, x) in [(-1, 0.1), (0, 0.25), (1, 0.32)] {
        values.set("X", level, 3, 1, &[x, 0.5 - 2.0 * x, x * x]);
    }
    turn(&mut values, "Λ");
    values
}

const KINETIC: &str = "m*dot(next(X) - X, next(X) - X)/(2*h)";

fn printed_everywhere(d: &Derivation, wanted: &str) {
    for format in [
        Format::Text,
        Format::Markdown,
        Format::MathMl,
        Format::Json,
        Format::Latex,
    ] {
        assert!(printed(d, format).len() > 500);
    }
    let text = printed(d, Format::Text);
    assert!(text.contains(wanted), "{wanted} in\n{text}");
}

#[test]
fn a_potential_of_a_field_is_stepped_explicitly() {
    let body = format!("param w: Real; field X: Vec<3>; lagrangian = {KINETIC} - h*w;");
    let (own, open, sample) = pair(&body, &|s, x| s.of("f", &[&x("X")]));
    let values = values(&sample);
    same(&residuals(&own, &values), &residuals(&open, &values));
    assert_eq!(method(&own), method(&open));
    assert!(own.reversible);
    printed_everywhere(&own, "∇f(X_k)");
    let tokens = emit::emit(&own, true).to_string().replace(' ', "");
    assert!(tokens.contains("f.pull_back_1(&"), "{tokens}");
    // If the form of the functional is unknown, only the symplectic form and, approximately, the energy are conserved.
    let free = format!("field X: Vec<3>; param w: Real; lagrangian = {KINETIC} - h*w;");
    let (free, ..) = pair(&free, &|s, x| s.of("f", &[&x("z")]));
    assert!(own.invariants.len() < free.invariants.len());
}

#[test]
fn functionals_of_functionals_keep_the_chain_rule() {
    let body = format!("param w: Real; field X: Vec<3>; lagrangian = {KINETIC} - h*w;");
    let (own, _, sample) = stated(&body, &|s, x| {
        let g = s.of("g", &[&x("X"), &s.of("g", &[&x("z"), &x("X")])]);
        expr::mul(s.of("k", &[&s.of("f", &[&g])]), x("m"))
    });
    let values = values(&sample);
    let s = sample.symbols.clone();
    let two = expr::add(
        own.lagrangian.clone(),
        expr::shift_time(&s, &own.lagrangian, -1),
    );
    let residual = residuals(&derived(own), &values);
    // The derivative of the action of two steps with respect to the node between them, by difference quotients.
    for (i, residual) in residual.into_iter().enumerate() {
        let moved = |by: f64| {
            let mut place = [0.25, 0.0, 0.0625];
            place[i] += by;
            let mut values = values.clone();
            values.set("X", 0, 3, 1, &place);
            evaluate(&s, &two, &values).unwrap().get(0, 0)
        };
        let quotient = (moved(1e-5) - moved(-1e-5)) / 2e-5;
        assert!(
            (quotient - residual).abs() < 1e-8 && residual.abs() > 1e-3,
            "{quotient} {residual}"
        );
    }
}

#[test]
fn a_functional_between_nodes_is_solved_by_second_derivatives() {
    let body =
        format!("param w: Vec<3>; field X: Vec<3>; lagrangian = {KINETIC} + dot(w, next(X) - X);");
    let (own, open, sample) = pair(&body, &|s, x| {
        let middle = expr::scale(crate::algebra::Rational::HALF, expr::add(x("X"), x("+X")));
        s.of("g", &[&middle, &x("z")])
    });
    let values = values(&sample);
    same(&residuals(&own, &values), &residuals(&open, &values));
    // For any functional, the balance is not linear in the velocity.
    assert_eq!(method(&own), "Newton");
    let tokens = emit::emit(&own, true).to_string().replace(' ', "");
    assert!(tokens.contains("g.pull_back_1("), "{tokens}");
    assert!(tokens.contains("g.along_1(") && tokens.contains("g.pull_back_1_along_1("));
    assert!(own.reversible);
}

#[test]
fn an_argument_with_the_step_is_not_claimed_even() {
    let body = format!("param w: Real; field X: Vec<3>; lagrangian = {KINETIC} - h*w;");
    let (own, ..) = pair(&body, &|s, x| {
        s.of("k", &[&expr::mul(x("h"), s.of("f", &[&x("X")]))])
    });
    assert!(!own.reversible);
    assert!(own.limit.is_err());
    // There is no warning that the step is of first order either.
    let first = |w: &&super::warnings::Warning| matches!(w.topic, Topic::FirstOrder);
    assert_eq!(own.warnings.iter().filter(first).count(), 0);
}

#[test]
fn a_torque_by_an_advected_direction() {
    let body = "param w: Real; param J: Sym<3>; group Λ: SO<3> velocity Ω; \
        advected Γ: Vec<3> = Λ^T*z; constraint next(Λ) = Λ*Ω; constraint next(Γ) = Ω^T*Γ; \
        lagrangian = -tr(J*Ω)/h - h*w;";
    let (own, open, sample) = pair(body, &|s, x| s.of("f", &[&x("Γ")]));
    let values = values(&sample);
    same(&residuals(&own, &values), &residuals(&open, &values));
    assert_eq!(method(&own), method(&open));
    printed_everywhere(&own, "∇f(Γ_k)");
}

#[test]
fn an_unreduced_functional_is_reduced_through_its_arguments() {
    let body = "param w: Real; param J: Sym<3>; group Λ: SO<3> velocity Ω; \
        constraint next(Λ) = Λ*Ω; lagrangian = -tr(J*Λ^T*next(Λ))/h - h*w;";
    let (own, open, sample) = pair(body, &|s, x| {
        let seen = expr::mul(expr::transpose(&s.symbols, x("Λ")), x("z"));
        s.of("f", &[&s.of("g", &[&seen, &x("z")])])
    });
    let values = values(&sample);
    same(&residuals(&own, &values), &residuals(&open, &values));
    let mut inside = vec![own.spec.lagrangian.clone()];
    let mut found = 0;
    while let Some(e) = inside.pop() {
        if let Node::Given(_) = e.node() {
            found += 1;
            assert!(!expr::contains_role(
                &own.letters.symbols,
                &e,
                expr::symbol::Role::Element
            ));
        }
        inside.extend(e.children().into_iter().cloned());
    }
    assert_eq!(found, 2);
}
