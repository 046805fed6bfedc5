//! Errors about fields: constraints, sums of increments, names of functions, shapes of one column. Valid constraints
//! that contain increments are read as intended.

use crate::pipeline::derive_source;
use crate::print::{Format, Style, expression};

/// The errors of a rejected model, each with its help.
fn refused(body: &str) -> String {
    let text = format!("model M {{ {body} }}");
    match derive_source(&text) {
        Ok(_) => format!("derives: {text}"),
        Err(errors) => errors.to_string(),
    }
}

const MOTION: &str = "let d = next(X) - X; lagrangian = m*dot(d, d)/(2*h) - h*dot(Y, Y);";

fn carried(constraint: &str) -> String {
    format!(
        "param m: Real; param a: Vec<3>; field X: Vec<3>; advected Y: Vec<3>; {constraint} {MOTION}"
    )
}

#[test]
fn increments_in_constraints_are_seen() {
    let update = |body: &str| {
        let d = derive_source(&format!("model M {{ {body} }}"))
            .unwrap_or_else(|e| panic!("{body}\n{e}"));
        let source = crate::document::source(&d);
        // The stored text derives the same model.
        let again = derive_source(&source).unwrap_or_else(|e| panic!("{source}\n{e}"));
        assert_eq!(crate::document::source(&again), source);
        let a = &d.spec.advected[0];
        let style = Style::new(&d.spec.time_index);
        expression(&a.update, &d.letters.symbols, &style, Format::Text)
    };
    for constraint in [
        "constraint next(Y) = Y + (next(X) - X);",
        "constraint next(Y) = next(X) - (X - Y);",
        "let moved = next(X) - X; constraint next(Y) = (Y + 2*moved) - moved;",
    ] {
        let found = update(&carried(constraint));
        assert!(
            ["Y_k + ΔX_k", "ΔX_k + Y_k"].contains(&found.as_str()),
            "{constraint}: {found}"
        );
    }
    // A definition with a constraint, functions of increments, and the element of a group at the end of the step.
    update(
        &carried("constraint next(Y) = Y + next(X) - X;")
            .replace("advected Y: Vec<3>", "advected Y: Vec<3> = X - a"),
    );
    update(
        "param m: Real; field X: Real; advected Y: Real; constraint next(Y) = exp(next(X) - X)*Y; lagrangian = m*(next(X) - X)^2/(2*h) - h*Y;",
    );
    let turned = "param m: Real; param J: Sym<3>; group Q: SO<3> velocity W; field X: Vec<3>; advected Y: Vec<3>; \
        constraint next(Q) = Q*W; constraint next(Y) = next(Q)^T*Q*Y; let d = next(X) - X; \
        lagrangian = -tr(J*W)/h + m*dot(d, d)/(2*h) - h*dot(Y, Y + X);";
    assert_eq!(update(turned), "W_kᵀ Y_k");
}

#[test]
fn what_a_field_does_not_carry_is_told_so() {
    let never = ["ΔX * X", "ΔX * Y", "ΔX^T", "other side", "derives"];
    let says = |body: &str, said: &[&str]| {
        let message = refused(body);
        for s in said {
            assert!(message.contains(s), "{body}\n{message}");
        }
        for s in never {
            assert!(!message.contains(s), "{body}\n{message}");
        }
    };
    let example = "`constraint next(Y) = Y + (next(X) - X);`";
    says(
        &carried("constraint next(Y) = Y + next(X);"),
        &["add up", "leaves -ξ", example],
    );
    says(
        &carried("constraint next(Y) = Y + dot(next(X) - X, X)*X;"),
        &["add up", example],
    );
    says(
        &carried("constraint next(Y) = hat(next(X) - X)*Y;"),
        &["has no inverse", example],
    );
    says(&carried(""), &["no evolution constraint", example]);
    let matrix = |constraint: &str| {
        carried(constraint)
            .replace("Y: Vec<3>", "Y: Mat<3>")
            .replace("dot(Y, Y)", "tr(Y)")
    };
    says(&matrix(""), &["`constraint next(Y) = Y;`"]);
    says(
        &matrix("constraint next(Y) = hat(next(X))*Y;"),
        &["has no inverse", "in terms of `X` in the Lagrangian"],
    );
    let contrary = carried("constraint next(Y) = Y - (next(X) - X);")
        .replace("advected Y: Vec<3>", "advected Y: Vec<3> = X - a");
    says(
        &contrary,
        &[
            "contradicts",
            "-a + X_k + ΔX_k",
            "differ by -2 ΔX_k",
            "`next(Y) = Y + (next(X) - X)`",
        ],
    );
    // With a group declared after the field, the group advects.
    let both = "param m: Real; param J: Sym<3>; field X: Vec<3>; group Q: SO<3> velocity W; advected Y: Vec<3>; \
        constraint next(Q) = Q*W; let d = next(X) - X; lagrangian = -tr(J*W)/h + m*dot(d, d)/(2*h) - h*dot(Y, Y);";
    says(both, &["`constraint next(Y) = W^T * Y;`"]);
}

#[test]
fn a_field_has_no_constraint() {
    for update in ["X + d", "X", "R*X", "W*X"] {
        let body = format!(
            "param m: Real; param R: Mat<3>; group Q: SO<3> velocity W; constraint next(Q) = Q*W; field X: Vec<3>; \
             let d = next(X) - X; constraint next(X) = {update}; \
             lagrangian = -tr(R*W)/h + m*dot(d, d)/(2*h) - h*dot(X, X);"
        );
        let message = refused(&body);
        assert!(
            message.contains("a field cannot have a constraint"),
            "{message}"
        );
        assert!(
            message.contains("by its increment `next(X) - X`"),
            "{message}"
        );
        assert!(message.contains("remove the constraint"), "{message}");
        assert_eq!(message.matches("help: ").count(), 2, "{message}");
    }
}

#[test]
fn an_equation_without_increments_is_told_so() {
    let message = refused("param m: Real; field X, Y: Real; lagrangian = m*X*(next(Y) - Y);");
    assert!(
        message.contains("a step cannot be solved for `X`"),
        "{message}"
    );
    assert!(message.contains("`m*(next(X) - X)^2/(2*h)`"), "{message}");
    // The suggested model derives.
    let kinetic = "m*(next(X) - X)^2/(2*h) + m*(next(Y) - Y)^2/(2*h)";
    let mended = format!(
        "model M {{ param m: Real; field X, Y: Real; lagrangian = {kinetic} + m*(X + next(X))/2*(next(Y) - Y); }}"
    );
    let d = derive_source(&mended).unwrap_or_else(|e| panic!("{e}"));
    assert!(d.warnings.is_empty(), "{:?}", d.warnings);
}

#[test]
fn one_column_is_a_vector() {
    for (declared, said) in [
        ("field X: Mat<3, 1>;", "write `Vec<3>`"),
        ("param X: Mat<4,1>;", "write `Vec<4>`"),
        ("advected X: Mat<1, 3>;", "declare `Vec<3>` and write `v^T`"),
        ("field X: Mat<1, 1>;", "a single number is `Real`"),
        ("dim n in 3..=5; field X: Mat<n, 1>;", "write `Vec<n>`"),
    ] {
        let message = refused(&format!("{declared} lagrangian = 0;"));
        assert!(message.contains(said), "{declared}: {message}");
        assert!(
            !message.contains("between 2 and 32"),
            "{declared}: {message}"
        );
    }
}

#[test]
fn names_of_functions_are_refused_where_they_are_declared() {
    for name in [
        "momentum",
        "node",
        "energy",
        "step",
        "parameters",
        "body_momentum",
    ] {
        let field = format!(
            "param m: Real; field {name}: Vec<3>; let d = next({name}) - {name}; lagrangian = m*dot(d, d)/(2*h);"
        );
        let group = format!(
            "param J: Sym<3>; group {name}: SO<3> velocity W; constraint next({name}) = {name}*W; lagrangian = -tr(J*W)/h;"
        );
        let carried = format!(
            "param J: Sym<3>; group Q: SO<3> velocity W; advected {name}: Vec<3>; constraint next(Q) = Q*W; \
            constraint next({name}) = W^T*{name}; lagrangian = -tr(J*W)/h - h*dot({name}, J*{name});"
        );
        for body in [field, group, carried] {
            let message = refused(&body);
            assert!(
                message.contains(&format!("`{name}` is already the name of a function")),
                "{message}"
            );
            assert!(
                message.contains(&format!("for example `{name}1`")),
                "{message}"
            );
            // With another name the model derives, and a parameter may have this name.
            let other = body.replace(name, &format!("{name}1"));
            assert!(refused(&other).starts_with("derives"), "{other}");
            let parameter =
                format!("param {name}: Real; {other}").replace("/h", &format!("*{name}/h"));
            assert!(refused(&parameter).starts_with("derives"), "{parameter}");
        }
    }
}

/// Column names in files are unique: `time` is reserved, and `x_1` is a component of a vector `x`.
#[test]
fn names_of_columns_are_refused() {
    for (declared, message, help) in [
        ("field time: Vec<3>;", "a column named `time`", "`time1`"),
        (
            "field invariant_q: Vec<3>;",
            "a column named `invariant_q`",
            "`invariant_q1`",
        ),
        (
            "field q: Vec<3>; field q_1: Real;",
            "name component 1 of `q` `q_1`",
            "`q1`",
        ),
        (
            "field q: Mat<2>; field q_12: Real;",
            "name component 12 of `q` `q_12`",
            "`q12`",
        ),
    ] {
        let names: Vec<&str> = declared
            .split("field ")
            .filter_map(|one| Some(one.split_once(':')?.0))
            .collect();
        let terms = |names: &[&str]| {
            let each = names.iter().map(|n| format!("m*tr(next({n})^T*{n})/h"));
            each.collect::<Vec<_>>().join(" + ")
        };
        let body = format!("param m: Real; {declared} lagrangian = {};", terms(&names));
        let refusal = refused(&body);
        assert!(
            refusal.contains(message) && refusal.contains(help),
            "{refusal}"
        );
    }
    for (a, b) in [("Real", "Real"), ("Vec<2>", "Vec<2>")] {
        let apart = format!(
            "param m: Real; field q: {a}; field q_1: {b}; let u = next(q) - q; let v = next(q_1) - q_1; \
             lagrangian = m*tr(u^T*u)/(2*h) + m*tr(v^T*v)/(2*h);"
        );
        assert!(
            refused(&apart).starts_with("derives"),
            "{}",
            refused(&apart)
        );
    }
    let beyond = "param m: Real; field q: Vec<2>; field q_3: Real; let u = next(q) - q; let v = next(q_3) - q_3; \
        lagrangian = m*(dot(u, u) + v^2)/(2*h);";
    assert!(
        refused(beyond).starts_with("derives"),
        "{}",
        refused(beyond)
    );
}

/// A quantity without motion may be multiplied by any scalar function of parameters and the step size, including
/// sums.
#[test]
fn a_number_goes_on_by_a_sum_of_parameters_and_the_step() {
    let with = |constraint: &str| {
        refused(&format!(
            "param m, a: Real; field X: Vec<2>; advected t: Real; constraint next(t) = {constraint};
             let d = next(X) - X; lagrangian = m*dot(d, d)/(2*h) - h*t*dot(X, X);"
        ))
    };
    for constraint in ["t*(1 + h)", "t - a*t*h", "(a + h)^2*t", "t*(1 + h) + a"] {
        let told = with(constraint);
        assert!(told.starts_with("derives"), "{constraint}: {told}");
    }
    let told = with("t*(1 + X[1])");
    assert!(told.contains("an expression of `X`"), "{told}");
    let told = with("t^2 + t");
    assert!(!told.contains("increment"), "{told}");
    assert!(told.contains("`next(t) = c*t`"), "{told}");
}

/// The suggestion for an exponent that is too large derives.
#[test]
fn large_powers_are_offered_what_derives() {
    let with = |potential: &str| {
        refused(&format!(
            "param m, p: Real; field x: Real;
             lagrangian = m*(next(x) - x)^2/(2*h) - h*({potential});"
        ))
    };
    let told = with("x^1000");
    assert!(told.contains("`exp(p*log(x))`"), "{told}");
    for potential in ["exp(p*log(x))", "x^250*x^250"] {
        let told = with(potential);
        assert!(told.starts_with("derives"), "{potential}: {told}");
    }
}

/// Groups with one element, and groups of scalars, are not `Real`.
#[test]
fn groups_of_size_one_say_what_there_is_instead() {
    for (group, said) in [
        ("SO<1>", "that group has one element"),
        ("GL<1>", "the exponential of a field"),
    ] {
        let told = refused(&format!("group R: {group} velocity W; lagrangian = 0;"));
        assert!(told.contains(said), "{group}: {told}");
        assert!(!told.contains("a single number"), "{group}: {told}");
    }
}

/// The diagonal of a product of matrices of a named size is decided by exact evaluation.
#[test]
fn diagonal_matrices_of_a_named_size_are_fields() {
    for potential in [
        "tr(D*D)",
        "tr(D*D*D*D)",
        "tr((D + next(D))*B*(D + next(D))*B)",
    ] {
        let d = derive_source(&format!(
            "model M {{ dim n in 2..=3; param m, k: Real; param B: Mat<n>; field D: Diag<n>; let V = next(D) - D; \
             lagrangian = m*tr(V*V)/(2*h) - h*k*{potential}; }}"
        ));
        let d = d.unwrap_or_else(|e| panic!("{potential}: {e}"));
        assert!(d.reversible, "{potential}");
        // The kinetic energy alone gives one division.
        assert_eq!(
            d.how_solved().contains("Newton"),
            potential.contains("next")
        );
    }
}
