//! Checks that a page prints what was derived. If the letters of parts are replaced by their definitions, the algebra
//! proves each expression equal to the derived one. Pages contain no inclusions and define every letter.

use super::Motions;
use super::display::Display;
use super::each_formula;
use super::names::Names;
use crate::algebra::Algebra;
use crate::derive_source;
use crate::document::{document, printed, printed_lattice};
use crate::expr::{self, Expr};
use crate::pipeline::parse_source;
use crate::print::Format;

/// Models with rigid motions of space and of the plane: several motions, with rotations and fields, on both sides,
/// with advected points, constraints, and names that the page would choose itself.
const MODELS: [&str; 8] = [
    "model Alone {
        param J: Sym<3>;
        param m, k: Real;
        param a, w: Vec<3>;
        group G: SE<3> velocity V;
        constraint next(G) = G*V;
        let y = pos(next(G)) - pos(G);
        lagrangian = -tr(J*rot(V))/h + m*dot(y, y)/(2*h) - h*k*dot(pos(G) + rot(G)*a, w);
    }",
    "model Two {
        param J, K: Sym<3>;
        param m, n, k: Real;
        param a, b: Vec<3>;
        group A: SE<3> velocity V;
        group B: SE<3> velocity W;
        constraint next(A) = A*V;
        constraint next(B) = B*W;
        let s = pos(A) + rot(A)*a - pos(B) - rot(B)*b;
        lagrangian = -tr(J*rot(V))/h + m*dot(pos(V), pos(V))/(2*h) - tr(K*rot(W))/h
            + n*dot(pos(W), pos(W))/(2*h) - h*k*dot(s, s)/2;
    }",
    "model Beside {
        param J, K: Sym<3>;
        param m, k, π, p: Real;
        param a, R, x: Vec<3>;
        group A: SE<3> velocity V;
        group B: SO<3> velocity W;
        field X: Vec<3>;
        field Z: Vec<4>;
        constraint next(A) = A*V;
        constraint next(B) = B*W;
        let apart = pos(A) + rot(A)*a - B*R - X;
        lagrangian = -tr(J*rot(V))/h + m*dot(pos(V), pos(V))/(2*h) - tr(K*W)/h
            + π*dot(next(X) - X, next(X) - X)/h - h*k*dot(apart, apart)/2 - h*p*dot(x, X)
            + m*dot(next(Z) - Z, next(Z) - Z)/h - h*k*dot(Z, Z);
    }",
    "model Plane {
        param J: Sym<2>;
        param K: Sym<3>;
        param m, k: Real;
        param u: Vec<2>;
        param Z: Vec<3>;
        group G: SE<2> velocity V;
        advected P: Vec<3> = G^T*Z;
        constraint next(G) = G*V;
        constraint next(P) = V^T*P;
        lagrangian = -tr(J*rot(V))/h + m*dot(pos(V), pos(V))/(2*h) + h*dot(P, K*P)
            - h*k*exp(-dot(pos(G), pos(G)))*dot(rot(G)*u, u);
    }",
    "model Held {
        param J: Sym<3>;
        param m, l: Real;
        param a, w: Vec<3>;
        group G: SE<3> velocity V;
        constraint next(G) = G*V;
        hold λ: dot(pos(G) + rot(G)*a, pos(G) + rot(G)*a) = l^2;
        lagrangian = -tr(J*rot(V))/h + m*dot(pos(V), pos(V))/(2*h) - h*dot(w, pos(G));
    }",
    "model Fluid {
        param J, M: Sym<3>;
        param D: Mat<3>;
        param b, Z: Vec<4>;
        group G: SE<3> velocity V;
        advected P: Vec<4> = G^T*Z;
        constraint next(G) = G*V;
        constraint next(P) = V^T*P;
        let u = (pos(V) - pos(V^-1))/2;
        lagrangian = -tr(J*rot(V))/h + dot(u, M*u)/(2*h) + dot(vee(rot(V)), D*u)/h - h*dot(b, P);
    }",
    "model Space {
        param Q: Sym<4>;
        param b: Vec<3>;
        param Z: Vec<4>;
        group G: SE<3> velocity V;
        advected P: Vec<4> = (G^-1)^T*Z;
        advected Γ: Vec<3> = rot(G)*b;
        constraint next(G) = V*G;
        constraint next(P) = (V^-1)^T*P;
        constraint next(Γ) = rot(V)*Γ;
        lagrangian = tr((V - Id)*Q*(V - Id)^T)/(2*h) - h*dot(P, Q*P) - h*dot(Γ, b);
    }",
    "model Sledge {
        param J: Sym<2>;
        param m: Real;
        param a, w: Vec<2>;
        group G: SE<2> velocity V;
        constraint next(G) = G*V;
        let y = pos(next(G)) - pos(G);
        lagrangian = -tr(J*rot(V))/h + m*dot(y, y)/(2*h) - h*dot(w, pos(G) + rot(G)*a);
    }",
];

#[test]
fn what_is_printed_is_what_was_derived() {
    for text in MODELS {
        let d = derive_source(text).expect("a model");
        let doc = document(&d);
        let mut page = Display::new(Names::new(
            &d.letters.symbols,
            &doc,
            &d.spec.lets,
            Motions::InParts,
            false,
        ));
        let mut derived: Vec<Expr> = Vec::new();
        each_formula(&doc, &mut |f| {
            f.each_expression(&mut |e| derived.push(e.clone()))
        });
        let mut changed = 0;
        for e in &derived {
            let shown = page.tidy(e);
            changed += usize::from(shown != *e);
            let mut pairs = vec![(e.clone(), shown)];
            if let Some([angular, linear]) = page.names.twist(e) {
                pairs.push((e.clone(), expr::stacked(angular, linear)));
            }
            if page.names.is_of_points(e.shape())
                && let (Some(top), Some(last)) = (page.names.top(e), page.names.last(e))
            {
                let rows = e.shape().rows;
                let put = expr::inclusion(rows, expr::within(rows), 0);
                let unit = expr::unit(rows, expr::last_axis(rows));
                pairs.push((
                    e.clone(),
                    expr::add(expr::mul(put, top), expr::mul(last, unit)),
                ));
            }
            for (derived, shown) in pairs {
                let again = page.names.written_out(&shown);
                let algebra = Algebra::new(&page.names.symbols);
                assert!(
                    algebra.equal(&derived, &again),
                    "{}: {derived:?}\nis printed as {shown:?}",
                    d.spec.name
                );
            }
        }
        assert!(
            changed > 10,
            "{}: {changed} of {}",
            d.spec.name,
            derived.len()
        );
    }
}

/// A satellite around a planet, with gravity to second order and `let` names.
const SATELLITE: &str = "model Satellite {
    param m, GM: Real;
    param J: Sym<3>;
    group Λ: SO<3> velocity Ω;
    field x: Vec<3>;
    constraint next(Λ) = Λ*Ω;
    let r = sqrt(dot(x, x));
    let I = tr(J)*Id - J;
    let y = Λ^T*x;
    lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - tr(J*Ω)/h + h*GM*m/r + h*GM*tr(I)/(2*r^3)
        - (3/2)*h*GM*dot(y, I*y)/r^5;
}";

#[test]
fn names_of_the_model_stand_in_text_as_on_a_page() {
    for text in MODELS.into_iter().chain([SATELLITE]) {
        let d = derive_source(text).expect("a model");
        let doc = document(&d);
        let symbols = &d.letters.symbols;
        let names = Names::new(symbols, &doc, &d.spec.lets, Motions::Whole, false);
        let mut page = Display::new(names);
        let mut derived: Vec<Expr> = Vec::new();
        each_formula(&doc, &mut |f| {
            f.each_expression(&mut |e| derived.push(e.clone()))
        });
        for e in &derived {
            let again = page.tidy(e);
            let again = page.names.written_out(&again);
            let algebra = Algebra::new(&page.names.symbols);
            assert!(algebra.equal(e, &again), "{}: {e:?}", d.spec.name);
        }
    }
    let d = derive_source(SATELLITE).expect("a model");
    let text = printed(&d, Format::Text);
    for said in [
        "We write y_k := Λ_kᵀ x_k; I := tr(J) Id - J; r_k := |x_k|.",
        // Like terms are collected, and powers of the length are powers of its name.
        "p_{2,k} = m Δx_k/h + h m GM x_k/(2 r_k³) - 3 h GM tr(J) x_k/(4 r_k⁵)",
        "+ 15 h GM (y_k·(J y_k)) x_k/(4 r_k⁷) - 3 h GM Λ_k J y_k/(2 r_k⁵)",
        "L = ½ m ζ₂·ζ₂ + ½ tr(J) ζ₁·ζ₁ - ½ ζ₁·(J ζ₁) + m GM/r - GM tr(J)/(2 r³) + 3 GM y·(J y)/(2 r⁵)",
    ] {
        assert!(words(&text).contains(&words(said)), "{said}\n{text}");
    }
    for never in ["√", "|x_{k+1}|", "Λ_kᵀ x_k)"] {
        assert!(!text.contains(never), "{never}\n{text}");
    }
    let page = printed(&d, Format::Latex);
    assert!(!page.contains("\\sqrt"), "{page}");
    assert!(page.contains("\\lvert x_{k}\\rvert"), "{page}");
    // Without names, norms replace the square roots.
    let bare = SATELLITE.replace("let r = sqrt(dot(x, x));", "");
    let bare = bare
        .replace("/r", "/sqrt(dot(x, x))")
        .replace("(2*r^3)", "(2*sqrt(dot(x, x))^3)");
    let d = derive_source(&bare).expect("a model");
    let text = words(&printed(&d, Format::Text));
    assert!(text.contains("h m GM x_k/(2 |x_k|³)"), "{text}");
    let page = printed(&d, Format::Latex);
    assert!(page.contains("2\\,\\lvert x_{k}\\rvert^{3}"), "{page}");
}

#[test]
fn a_name_is_found_in_a_trace_from_whichever_factor_on() {
    let model = "model Body {
        param A, I: Sym<3>;
        param a, b: Real;
        field Q: Mat<3>;
        let C = Q^T*A*Q;
        lagrangian = tr((next(Q) - Q)*I*(next(Q) - Q)^T)/(2*h) - h*(a*tr(C)^2 + b*tr(C*C*C));
    }";
    let d = derive_source(model).expect("a model");
    let text = words(&printed(&d, Format::Text));
    for said in ["- a tr(C)² - b tr(C³)", "tr(C_k) A Q_k"] {
        assert!(text.contains(said), "{said}\n{text}");
    }
    assert!(!text.contains("tr(A Q"), "{text}");
}

/// Joins the words of a text across line breaks.
fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn no_inclusion_is_left_in_print() {
    for text in MODELS {
        let d = derive_source(text).expect("a model");
        for format in [
            Format::Markdown,
            Format::Latex,
            Format::MathMl,
            Format::Json,
        ] {
            let page = printed(&d, format);
            assert!(
                !page.contains("\\iota") && !page.contains('ι'),
                "{}",
                d.spec.name
            );
        }
        let line = printed(&d, Format::Text);
        assert!(!line.contains('ι'), "{line}");
    }
}

#[test]
fn letters_are_introduced_where_they_first_stand() {
    let d = derive_source(MODELS[5]).expect("a model");
    let page = printed(&d, Format::Markdown);
    for said in [
        "We write $`V_{k} = (F_{k}, \\;y_{k})`$, rotation and translation; \
         $`u_{k} := \\frac{1}{2}\\,(y_{k} + F_{k}^{\\mathsf{T}}\\,y_{k})`$.",
        "We write $`\\xi = (\\varphi, \\;\\psi)`$, angular and linear part; \
         $`P_{k} = (\\bar{P}_{k}, \\;P_{k}^{4})`$, the first three entries and the last.",
        "We write $`\\zeta = (\\omega, \\;v)`$, angular and linear part.",
    ] {
        assert_eq!(page.matches(said).count(), 1, "{said}\n{page}");
    }
    let balance = page
        .find("\\pi_{k} & = ")
        .expect("the angular part of the balance");
    assert!(
        page.find("p_{k} & = ").is_some_and(|at| at > balance),
        "{page}"
    );
    // A name of the model stays reserved for it.
    let d = derive_source(MODELS[2]).expect("a model");
    let page = printed(&d, Format::Markdown);
    assert!(
        page.contains("\\mu_{1,k} = (\\kappa_{1,k}, \\;\\nu_{1,k})"),
        "{page}"
    );
    assert!(page.contains("A_{k} = (Q_{k}, \\;q_{k})"), "{page}");
}

#[test]
fn letters_of_sites_are_introduced_once() {
    let text = "model Chain {
        label i in 0..N;
        param J: Sym<3>;
        param m, k: Real;
        param a, b: Vec<3>;
        group G: SE<3> at nodes velocity V;
        constraint next(G) = G*V;
        let apart = pos(next(G, i)) + rot(next(G, i))*b - pos(G) - rot(G)*a;
        lagrangian = -tr(J*rot(V))/h + m*dot(pos(V), pos(V))/(2*h) - h*k*dot(apart, apart)/2;
    }";
    let model = parse_source(text).expect("a model");
    let page = printed_lattice(&model, text, Format::Markdown, 100).expect("a derivation");
    let page = page.text;
    assert!(!page.contains("\\iota"), "{page}");
    for said in [
        "We write $`V_{i,k} = (F_{i,k}, \\;y_{i,k})`$ and $`G_{i,k} = (R_{i,k}, \\;x_{i,k})`$, rotation and translation.",
        "We write $`\\mu_{i,k} = (\\pi_{i,k}, \\;p_{i,k})`$, angular and linear part.",
    ] {
        assert!(page.contains(said), "{said}\n{page}");
    }
    assert_eq!(page.matches("We write").count(), 2, "{page}");
    assert!(page.contains("\\pi_{N,k} & = "), "{page}");
}

#[test]
fn what_no_parameter_names_is_told_and_its_variation_has_letters_for_its_parts() {
    let d = derive_source(
        "model Tied { param J: Sym<3>; param m, k: Real; param a: Vec<3>; group G: SE<3> velocity V;
         constraint next(G) = G*V;
         let end = pos(G) + rot(G)*a; let y = pos(next(G)) - pos(G);
         lagrangian = -tr(J*rot(V))/h + m*dot(y, y)/(2*h) - h*k*dot(end, end)/2; }",
    )
    .expect("a model");
    let text = printed(&d, Format::Text);
    for said in [
        "metric_{G,k} is the scalar product of space seen from the body.",
        "E_{4,body,k} is the origin of space seen from the body, in homogeneous coordinates.",
    ] {
        assert!(text.contains(said), "{said}\n{text}");
    }
    let page = printed(&d, Format::Markdown);
    assert!(!page.contains("lin}(\\xi)"), "{page}");
}
