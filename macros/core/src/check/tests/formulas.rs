//! Functions defined by a formula, in the model or by a case. A call equals the formula at its argument, and a syntax
//! error in the formula is reported at its position.

use crate::algebra::Algebra;
use crate::pipeline::{derive_source, parse_source};
use crate::syntax::formula;

fn text(given: &str, term: &str) -> String {
    format!(
        "model M {{ param m, g, A, x: Real; {given} field X: Vec<2>; field u: Real; \
         lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) + m*(next(u) - u)^2/(2*h) - h*({term}); }}"
    )
}

/// Asserts that two models are the same.
fn same(given: &str, term: &str, by_hand: &str) {
    let of = |text: &str| derive_source(text).unwrap_or_else(|e| panic!("{text}\n{e}"));
    let (a, b) = (of(&text(given, term)), of(&text("", by_hand)));
    let algebra = Algebra::new(&a.letters.symbols);
    assert!(
        algebra.equal(&a.spec.lagrangian, &b.spec.lagrangian),
        "{given}: {term} is not {by_hand}"
    );
}

fn refused(given: &str, term: &str) -> String {
    let text = text(given, term);
    match derive_source(&text) {
        Ok(_) => format!("derives: {text}"),
        Err(errors) => errors.to_string(),
    }
}

#[test]
fn a_call_is_the_expression_at_its_argument() {
    let b = "given b(Vec<2>): Real = \"A*cos(2*x)*y^2\";";
    same(b, "m*g*b(X)", "m*g*A*cos(2*X[1])*X[2]^2");
    same(b, "b(2*X)", "4*A*cos(4*X[1])*X[2]^2");
    same(
        "given b(Vec<2>): Real = \"x1 - x2\";",
        "b(b(X)*X)",
        "(X[1] - X[2])^2",
    );
    same(
        "given R(Vec<2>): Vec<2> = [\"-y*g\", \"x\"];",
        "dot(R(X), X)",
        "(1 - g)*X[1]*X[2]",
    );
    same(
        "given f(Real): Real = \"tanh(x)\";",
        "f(u)*f(g*u)",
        "tanh(u)*tanh(g*u)",
    );
    // A component hides a parameter of the same name.
    same("given f(Real): Real = \"A*x\";", "f(u) + u*x - u*x", "A*u");
    same(
        "given f(Real): Real = \"cos(2*pi*x)^2*sin(pi*x)\";",
        "f(u)",
        "cos(2*pi*u)^2*sin(pi*u)",
    );
    // Functions that use other functions, in any order.
    same(
        "given f(Real): Real = \"w(x)^2 + w(2*x)\"; given w(Real): Real = \"A*x\";",
        "f(u)",
        "A^2*u^2 + 2*A*u",
    );
    // Given by a case.
    same("given f(Real): Real = case \"A*x\";", "f(u)", "A*u");
}

#[test]
fn constants_of_many_digits_are_letters() {
    let k = "given f(Real): Real = \"1.380649e-23*x^2 + 6.62607015e-34*x^4\";";
    same(k, "f(u)*f(u)", "(1.380649e-23*u^2 + 6.62607015e-34*u^4)^2");
    same(k, "f(u)", "u^2*(1.380649e-23 + 6.62607015e-34*u^2)");
    same(
        "given f(Real): Real = \"sin(pi^3*x)\";",
        "f(u)",
        "sin(π*π*π*u)",
    );
    same("", "299792458*u - 299792458*u + pi*u/pi", "u");
}

#[test]
fn calls_within_calls_do_not_grow_without_bound() {
    let nested = |deep: usize| (0..deep).fold("u".to_owned(), |e, _| format!("f({e})"));
    let given = "given f(Real): Real = \"x*x\";";
    same(given, &nested(4), "u^16");
    let told = refused(given, &nested(60));
    assert!(
        told.contains("too large once its functions are substituted"),
        "{told}"
    );
}

#[test]
fn what_is_stored_derives_the_same_model() {
    let given =
        "given b(Vec<2>): Real = case \"A*x*y\"; given R(Vec<2>): Vec<2> = [\"pi*y\", \"x\"];";
    let d = derive_source(&text(given, "b(X) + dot(R(X), X)")).expect("derives");
    let source = crate::document::source(&d);
    assert!(
        source.contains("given b(Vec<2>): Real = case \"A*x*y\";"),
        "{source}"
    );
    assert!(source.contains("= [\"pi*y\", \"x\"];"), "{source}");
    let again = derive_source(&source).unwrap_or_else(|e| panic!("{source}\n{e}"));
    assert_eq!(crate::document::source(&again), source);
}

#[test]
fn what_the_case_gives_derives_and_is_not_emitted() {
    let text = text("given b(Vec<2>): Real = case;", "b(X)");
    let d = derive_source(&text).expect("derives");
    let told = crate::emit::refusal(&d).expect("refused").message;
    assert!(told.contains("the case gives the function `b`"), "{told}");
    let open = formula::open(&parse_source(&text).expect("reads")).expect("readable");
    assert_eq!(open.len(), 1);
    assert!(!open[0].is_filled && open[0].components == 1);
}

#[test]
fn what_is_no_such_function_is_refused() {
    for (given, term, said) in [
        (
            "given b(Vec<2>): Real = \"A*(x\";",
            "b(X)",
            "this `(` is not closed",
        ),
        (
            "given b(Vec<2>): Real = \"A x;\";",
            "b(X)",
            "in this expression",
        ),
        (
            "given b(Vec<2>): Real = \"q*x\";",
            "b(X)",
            "`q` is unknown here: the expression may contain the argument x, y",
        ),
        (
            "given b(Vec<2>): Real = [\"x\", \"y\"];",
            "b(X)",
            "the function declares 1 components and gives 2",
        ),
        (
            "given b(Mat<2>): Real = \"x\";",
            "b(X)",
            "takes one number or a vector of known size",
        ),
        (
            "given b(Real, Real): Real = \"x\";",
            "b(u, u)",
            "takes one number or a vector of known size",
        ),
        (
            "given b(Real): Real = \"x\"; param b: Real;",
            "b(u)",
            "`b` is declared twice",
        ),
        (
            "given b(Real): Real = \"x\";",
            "b(u, u)",
            "`b` takes one argument, not 2",
        ),
        (
            "given b(Real): Real = \"x\";",
            "2*b",
            "`b` is a function and needs an argument",
        ),
        (
            "given b(Vec<3>): Real = \"x + y\";",
            "b(X)",
            "this is a vector of length 2, but a vector of length 3 is needed here",
        ),
        ("given b(Real): Real = \"3*x\";", "b(X)", "is needed here"),
        ("given b(Real): Real = \"u*x\";", "b(u)", "`u` is unknown"),
        (
            "given b(Real): Real = \"next(x)\";",
            "b(u)",
            "a function cannot contain",
        ),
        (
            "given b(Real): Real = \"c(x)\"; given c(Real): Real = \"b(x)\";",
            "b(u)",
            "`b` calls itself",
        ),
        (
            "given b(Real): Real = \"x + x**2\";",
            "b(u)",
            "write a power as `a^2`",
        ),
        (
            "given b(Vec<2>): Real = 3;",
            "b(X)",
            "an expression in quotes",
        ),
    ] {
        let found = refused(given, term);
        assert!(found.contains(said), "{given}: {found}");
    }
}
