//! Functionals and their derivatives in every format.

use crate::expr::functional::tests::Table;
use crate::expr::{self, Expr};
use crate::print::{Format, Style, expression, statement::statement};

fn samples(t: &Table) -> Vec<Expr> {
    let s = &t.sample.symbols;
    let (x, y, u, m) = (t.at(t.x), t.at(t.y), t.at(t.u), t.at(t.m));
    let f = t.sample.of("f", &[&x]);
    let half = expr::quotient(expr::add(x.clone(), y.clone()), m.clone());
    let g = t.sample.of("g", &[&half, &y]);
    let one = expr::integer(1);
    let along = t.sample.along("g", &[&half, &y], &[(0, &u)]);
    let k = t.sample.along("f", &[&x], &[(0, &u)]);
    vec![
        f.clone(),
        expr::neg(expr::mul(m.clone(), f)),
        g.clone(),
        t.sample.of("f", &[&g]),
        t.sample.back("f", &[&x], 0, &m),
        t.sample.back("g", &[&half, &y], 0, &u),
        t.sample.back("g", &[&half, &y], 1, &u),
        t.sample
            .back("q", &[&expr::hat(x.clone())], 0, &expr::hat(y.clone())),
        expr::dot(t.sample.back("f", &[&x], 0, &one), u.clone()),
        expr::derived(s, along.clone()),
        expr::pull_back(s, along, 1, x.clone()),
        expr::pull_back(s, k, 0, one),
        expr::transpose(s, t.sample.back("f", &[&x], 0, &m)),
    ]
}

#[test]
fn functionals_read_as_on_paper() {
    let t = Table::new();
    let list = samples(&t);
    let print = |format| {
        let print = |e: &Expr| expression(e, &t.sample.symbols, &Style::default(), format);
        list.iter().map(print).collect::<Vec<String>>()
    };
    let text = [
        "f(X_k)",
        "-m f(X_k)",
        "g((X_k + Y_k)/m, Y_k)",
        "f(g((X_k + Y_k)/m, Y_k))",
        "m ∇f(X_k)",
        "(D₁ g((X_k + Y_k)/m, Y_k))ᵀ[u]",
        "(D_{Y_k} g((X_k + Y_k)/m, Y_k))ᵀ[u]",
        "(Dq(hat(X_k)))ᵀ[hat(Y_k)]",
        "∇f(X_k)·u",
        "D₁ g((X_k + Y_k)/m, Y_k)[u]",
        "(D₁D_{Y_k} g((X_k + Y_k)/m, Y_k)[u])ᵀ[X_k]",
        "D∇f(X_k)[u]",
        "m (∇f(X_k))ᵀ",
    ];
    assert_eq!(print(Format::Text), text);
    let latex = print(Format::Latex);
    assert_eq!(latex[4], "m\\,\\nabla f(X_{k})");
    assert_eq!(
        latex[5],
        "\\left(\\mathrm{D}_{1}g\\left(\\frac{X_{k} + Y_{k}}{m}, Y_{k}\\right)\\right)^{\\mathsf{T}}[u]"
    );
    let mathml = print(Format::MathMl);
    assert!(
        mathml
            .iter()
            .all(|m| m.contains("<math") || m.contains("<mi>")),
        "{mathml:?}"
    );
    assert!(
        print(Format::Markdown)
            .iter()
            .zip(&latex)
            .all(|(m, l)| m.contains(l))
    );
    let json = print(Format::Json);
    assert!(
        json.iter().zip(text).all(|(j, t)| j.contains(t)),
        "{json:?}"
    );
}

#[test]
fn functionals_in_the_language() {
    let t = Table::new();
    let style = Style::default();
    let text = |e: &Expr| statement(e, &t.sample.symbols, &style);
    let list = samples(&t);
    assert_eq!(text(&list[1]), "-m*f(X)");
    assert_eq!(text(&list[3]), "f(g((X + Y)/m, Y))");
    assert_eq!(text(&list[5]), "pull_back(g((X + Y)/m, Y), 1, u)");
    assert_eq!(text(&list[9]), "along(g((X + Y)/m, Y), 1, u)");
}
