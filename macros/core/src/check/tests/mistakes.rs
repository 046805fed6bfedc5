//! Notation of papers or of other languages, and the errors for it.

mod elsewhere;

use crate::pipeline::derive_source;

fn message(statements: &str, term: &str) -> String {
    let text = format!(
        "model M {{ time k step dt; param m: Real; field q: Real; field x: Vec<3>; {statements} \
         lagrangian = m*(next(q) - q)^2/(2*dt) + m*dot(next(x) - x, next(x) - x)/(2*dt) - dt*({term}); }}"
    );
    match derive_source(&text) {
        Ok(_) => format!("derives: {text}"),
        Err(errors) => errors.to_string(),
    }
}

#[test]
fn notation_of_papers_is_told_with_what_to_write() {
    for (statements, term, wanted) in [
        ("", "x·x", "`dot(a, b)`"),
        ("", "m·(q)", "write `a*b` for a product"),
        ("param A: Mat<3>;", "dot(x, Aᵀ*x)", "`A^T` for a transpose"),
        ("", "q[k+1]", "`next(q)` at the next node in time"),
        ("", "q_{k+1}", "write `next(q)` for the next node in time"),
        (
            "",
            "q_next",
            "write the value at the next node as `next(q)`",
        ),
        ("", "x_3", "write a component as `x[3]`"),
        ("", "q/h", "the time step is named `dt` here"),
        ("", "q % 2", "the language has no remainder"),
        ("param l = 1;", "q", "values belong in the case"),
        (
            "param l: R^3;",
            "q",
            "a vector with three components is `Vec<3>`",
        ),
        ("param l: Scalar;", "q", "write `Real`"),
        ("", "M_PI*q", "write `pi`"),
        ("", "dot(e_z, x)", "write `E3`"),
        ("", "q^m", "`exp(a*log(x))`"),
        (
            "given f(Real): Real = x^2;",
            "f(q)",
            "the expression of a function in quotes",
        ),
        ("let u: Real = q;", "u", "write `=` before an expression"),
        ("hamiltonian = q;", "q", "the discrete Lagrangian of a step"),
    ] {
        let found = message(statements, term);
        assert!(found.contains(wanted), "{statements} {term}\n{found}");
    }
}

#[test]
fn unit_vectors_have_the_size_of_what_is_beside_them() {
    // The first configuration is a scalar field, which does not have unit vectors.
    let found = message(
        "group U: SU<2> velocity V; constraint next(U) = U*V;",
        "dot(rot(U)*E1 - rot(U)*E2, rot(U)*E1 - x) + 2*dot(im(V), im(V))/dt^2",
    );
    assert!(found.contains("derives"), "{found}");
}

#[test]
fn names_that_are_nearly_right_are_told_with_those_that_are_meant() {
    for (statements, term, wanted) in [
        // Two transposed letters, at the beginning and later.
        ("", "isn(q)", Some("`sin`")),
        ("", "snih(q)", Some("`sinh`")),
        // A long name may have two wrong letters, a short one only one.
        ("param gravity: Real;", "gravtyy*q", Some("`gravity`")),
        ("param mass: Real;", "mqqs*q", None),
    ] {
        let found = message(statements, term);
        match wanted {
            Some(name) => {
                let wanted = format!("did you mean {name}?");
                assert!(found.contains(&wanted), "{term}\n{found}");
            }
            None => assert!(!found.contains("did you mean `mass`"), "{term}\n{found}"),
        }
    }
}

#[test]
fn a_wrong_constraint_is_not_told_to_be_missing_as_well() {
    let found = derive_source(
        "model M { param J: Sym<3>; group Q: SO<3> velocity W; advected Y: Vec<3>; \
         constraint next(Q) = Q*W; constraint next(Y) = W^T*Z; lagrangian = -tr(J*W)/h - h*dot(Y, Y); }",
    );
    let found = found.map_or_else(|e| e.to_string(), |_| "derives".to_owned());
    assert!(found.contains("`Z`"), "{found}");
    assert!(!found.contains("no evolution constraint"), "{found}");
}

#[test]
fn the_transpose_of_what_is_needed_is_told_to_be_transposed() {
    let of = |update: &str| {
        let text = format!(
            "model M {{ param J: Sym<3>; group Q: SO<3> velocity W; advected Y: Vec<3>; constraint next(Q) = Q*W; \
             constraint next(Y) = {update}; lagrangian = -tr(J*W)/h - h*dot(Y, Y); }}"
        );
        derive_source(&text).map_or_else(|e| e.to_string(), |_| "derives".to_owned())
    };
    let found = of("Y^T*W");
    assert!(found.contains("transpose it with `^T`"), "{found}");
    let found = of("W^T");
    assert!(!found.contains("transpose it with `^T`"), "{found}");
}

/// Terminal output quotes only the part of a very long line around the mistake.
#[test]
fn long_lines_are_cut_around_a_mistake() {
    let filler = "q + ".repeat(100);
    for (term, before, behind) in [
        (format!("wrong + {filler}q"), false, true),
        (format!("{filler}wrong + {filler}q"), true, true),
        (format!("{filler}wrong"), true, false),
    ] {
        let text = format!("model M {{ field q: Real; lagrangian =\n{term}\n; }}");
        let errors = derive_source(&text).err().unwrap_or_default();
        let told = errors
            .iter()
            .next()
            .map(|d| d.render("error", &text, "m.model"));
        let told = told.unwrap_or_default();
        let line = told
            .lines()
            .find(|l| l.contains("wrong +") || l.contains("+ wrong"));
        let line = line.unwrap_or_else(|| panic!("{told}"));
        let shown = line.split_once("| ").map_or("", |(_, rest)| rest);
        assert_eq!(
            (shown.starts_with("..."), shown.ends_with("...")),
            (before, behind),
            "{told}"
        );
        let marked = told
            .lines()
            .find_map(|l| Some((l.find('^')?, l.matches('^').count())));
        assert_eq!(marked, line.find("wrong").map(|at| (at, 5)), "{told}");
    }
}
