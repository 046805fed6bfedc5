//! Functionals in emitted programs: one call for each functional and arguments, as a temporary of its own.

use crate::emit::expression::{Bindings, Writer, program};
use crate::expr::functional::sample::at;
use crate::expr::functional::tests::Table;
use crate::expr::{self, Expr};
use crate::interpret::{Evaluator, evaluate};
use crate::schedule;
use quote::quote;

#[test]
fn values_and_pull_backs_are_calls_of_methods() {
    let t = Table::new();
    let s = &t.sample.symbols;
    let bindings = Bindings::new();
    let writer = Writer {
        symbols: s,
        bindings: &bindings,
    };
    let (x, y, u, m) = (t.at(t.x), t.at(t.y), t.at(t.u), t.at(t.m));
    let text = |e: &Expr| writer.write(e).to_string();
    let g = t.sample.of("g", &[&x, &y]);
    assert_eq!(text(&g), quote!(g.value(&X, &Y)).to_string());
    let back = t.sample.back("g", &[&x, &g], 1, &expr::mul(m, u.clone()));
    let wanted = quote!(g.pull_back_2(&X, &g.value(&X, &Y), &u) * m);
    assert_eq!(
        text(&back).replace(' ', ""),
        wanted.to_string().replace(' ', "")
    );
    let along = t.sample.along("g", &[&x, &y], &[(1, &u), (0, &y)]);
    let wanted = quote!(g.along_1_2(&X, &Y, &Y, &u));
    assert_eq!(text(&expr::derived(s, along.clone())), wanted.to_string());
    let back = expr::pull_back(s, along, 1, x);
    let wanted = quote!(g.pull_back_2_along_1_2(&X, &Y, &Y, &u, &X));
    assert_eq!(text(&back), wanted.to_string());
}

#[test]
fn a_functional_is_computed_once_for_its_arguments() {
    let t = Table::new();
    let s = &t.sample.symbols;
    let values = t.values();
    let f = t
        .sample
        .of("f", &[&t.sample.of("g", &[&t.at(t.x), &t.at(t.y)])]);
    let e = expr::mul(
        t.at(t.m),
        expr::power(f, crate::algebra::Rational::integer(3)),
    );
    let list = [
        e.clone(),
        expr::gradient(s, &e, at(t.x)),
        expr::gradient(s, &e, at(t.y)),
    ];
    let p = schedule::program(s, &list, "t");
    let (lets, results) = program(&p, &Bindings::new());
    let text = format!("{lets} {results:?}").replace(' ', "");
    for call in [
        "g.value(",
        "f.value(",
        "f.pull_back_1(",
        "g.pull_back_1(",
        "g.pull_back_2(",
    ] {
        assert_eq!(text.matches(call).count(), 1, "{call} in {lets}");
    }
    // Each functional is a temporary, even if it is used once.
    let stages = p
        .temporaries
        .iter()
        .filter(|(_, e)| matches!(e.node(), expr::Node::Given(_) | expr::Node::PullBack(..)));
    assert_eq!(stages.count(), 5);
    let found = Evaluator::of(&p).run(&values).unwrap();
    for (e, value) in list.iter().zip(found) {
        let wanted = evaluate(s, e, &values).unwrap();
        let pairs = wanted.data.iter().zip(&value.data);
        pairs.for_each(|(a, b)| assert!((a - b).abs() < 1e-14 * a.abs().max(1.0)));
    }
}
