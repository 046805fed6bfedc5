//! Ambiguous notation is rejected with a suggestion. Components and diagonals agree with unit vectors.

mod fields;
mod formulas;
mod holds;
mod mistakes;
mod motions;

use super::check;
use super::spec::Spec;
use crate::algebra::Algebra;
use crate::diagnostic::Errors;
use crate::expr::Expr;
use crate::syntax::{parse, tokens};

fn checked(declarations: &str, potential: &str) -> Result<Spec, Errors> {
    let source = format!(
        "model Top {{ param J: Sym<3>; param m, g: Real; param v: Vec<3>; param F: Mat<3, 2>; \
         param w: Vec<4>; {declarations} group Λ: SO<3> velocity Ω; advected Γ: Vec<3>; \
         constraint next(Λ) = Λ*Ω; constraint next(Γ) = Ω^T*Γ; \
         lagrangian = -tr(J*Ω)/h - h*({potential}); }}"
    );
    check(&tokens(&source).and_then(parse)?)
}

/// The error and its suggestions.
fn refused(declarations: &str, potential: &str) -> String {
    match checked(declarations, potential) {
        Ok(_) => format!("`{potential}` is accepted"),
        Err(errors) => errors.to_string(),
    }
}

fn accepted(potential: &str) -> Expr {
    checked("", potential).map_or_else(|e| panic!("{potential}: {e}"), |s| s.typed)
}

/// Asserts that both texts are the same expression.
fn same(a: &str, b: &str) {
    let spec = checked("", a).unwrap_or_else(|e| panic!("{a}: {e}"));
    let algebra = Algebra::new(&spec.symbols);
    assert!(algebra.equal(&spec.typed, &accepted(b)), "{a} is not {b}");
}

#[test]
fn multiples_of_unit_vectors_have_the_size_of_what_is_beside_them() {
    same("dot(2*E1, w)", "2*w[1]");
    same("dot(w, 2*E4 - E1)", "2*w[4] - w[1]");
    same("dot(2*E3, v)", "2*v[3]");
}

#[test]
fn numbers_glued_to_names_are_refused() {
    for (text, spelled, remedies) in [
        ("2m", "2m", vec!["`2*m`"]),
        ("2.5m*g", "2.5m", vec!["`2.5*m`"]),
        ("1e3m", "1e3m", vec!["`1e3*m`"]),
        ("2*(g) + 3m", "3m", vec!["`3*m`"]),
        ("m/2g", "2g", vec!["`/(2*g)`", "`/2*g`"]),
        ("m/-2g", "2g", vec!["`2*g`"]),
        ("m 2g", "2g", vec!["`2*g`"]),
        ("m^2g", "2g", vec!["`2*g`"]),
        ("sin(2m)", "2m", vec!["`2*m`"]),
        ("2h", "2h", vec!["`2*h`"]),
    ] {
        let message = refused("", text);
        let said = format!("`{spelled}` is neither a number nor a name");
        assert!(message.contains(&said), "{text}: {message}");
        for remedy in remedies {
            assert!(message.contains(remedy), "{text}: {message}");
        }
    }
    same("2*m + 3 g", "3*g + m*2");
}

#[test]
fn juxtaposition_after_a_divisor_is_refused() {
    for (text, below, beside) in [
        ("m/g Γ[1]", "`/(g*Γ)`", "`/g*Γ`"),
        ("m/2 g", "`/(2*g)`", "`/2*g`"),
        ("m/2 (g + m)", "`/(2*(...))`", "`/2*(...)`"),
        ("m/(g) m", "`/(g*m)`", "`/g*m`"),
        ("m/g^2 m", "`/(a*m)`", "`/a*m`"),
        ("m/-g m", "`/(a*m)`", "`/a*m`"),
        ("m*g/m g/2", "`/(m*g)`", "`/m*g`"),
        ("m/g 2", "`/(g*2)`", "`/g*2`"),
        ("m/sqrt(g) m", "`/(a*m)`", "`/a*m`"),
    ] {
        let message = refused("", text);
        assert!(message.contains("is ambiguous"), "{text}: {message}");
        assert!(message.contains(below), "{text}: {message}");
        assert!(message.contains(beside), "{text}: {message}");
    }
    same("m g/2*m", "m*g*m/2");
    same("m g/(2 m)", "g/2");
}

#[test]
fn parentheses_after_what_is_no_function_are_refused() {
    for (text, said) in [
        ("m(g + 1)", "`m` is a quantity, not a function"),
        ("m (g + 1)", "`m*(...)`"),
        ("h(g)", "`h*(...)`"),
        ("dot(Λ(v), Γ)", "`Λ*(...)`"),
        ("dot(E1(m), Γ)", "`E1*(...)`"),
        ("foo(m)", "`foo` is not a function of the language"),
        ("tan(m)", "`sin(a)/cos(a)`"),
        ("sine(m)", "did you mean `sin`?"),
        ("trace(J)", "`tr(A)`"),
        ("trce(J)", "for `trace`: write `tr"),
        ("normm(Γ)", "for `norm`: the length of a vector x"),
        ("part(m)", "`part*(...)`"),
    ] {
        let message = refused("let part = m*g;", text);
        assert!(message.contains(said), "{text}: {message}");
        // The full list of functions appears only if there is no better suggestion.
        let list = message.contains("functions: tr det log exp sqrt sin cos");
        let known = ["(a)", "(A)", "Λ*"]
            .iter()
            .any(|better| said.contains(better));
        assert_eq!(list, !known, "{text}: {message}");
    }
    for word in ["sin", "cos", "sinh", "cosh", "tanh", "abs", "sign", "exp"] {
        let message = refused(&format!("param {word}: Real;"), &format!("{word}(m)"));
        let said = format!("`{word}` has a fixed meaning in the language");
        assert!(message.contains(&said), "{message}");
    }
    let message = refused("param rot: Real;", "rot(m)");
    assert!(message.contains("shadows the function") && message.contains("`rot*(...)`"));
    assert!(checked("param rot: Real;", "rot*(m)").is_ok());
}

#[test]
fn components_are_counted_from_one() {
    same("Γ[1]", "dot(E1, Γ)");
    same("Γ[3]^2", "dot(Γ, E3)^2");
    same("J[1, 2]", "dot(E1, J*E2)");
    same("(Λ*Γ)[2]", "dot(E2, Λ*Γ)");
    same("(Γ*v^T)[2, 3]", "Γ[2]*v[3]");
    same("J^T[1, 3]", "J[3, 1]");
    for (text, said) in [
        ("Γ[0]", "counted from 1 to 3"),
        ("Γ[4]", "no component 4"),
        ("w[5]", "counted from 1 to 4"),
        ("F[1, 3]", "counted from 1 to 2"),
        ("F[4, 1]", "counted from 1 to 3"),
        ("Γ[1, 1]", "a vector of length 3"),
        ("J[1]", "`A[1, 2]`"),
        ("m[1]", "a number has no components"),
        ("Γ[k]", "counted from 1"),
        ("Γ[]", "counted from 1"),
        ("Γ[-1]", "counted from 1"),
        ("v^T[1]", "has no component with one index"),
    ] {
        let message = refused("", text);
        assert!(message.contains(said), "{text}: {message}");
    }
    assert_eq!(accepted("w[4]").shape(), crate::expr::shape::Shape::SCALAR);
}

#[test]
fn a_size_with_a_name_has_the_components_of_its_smallest() {
    let model = |index: u32| {
        format!(
            "model Body {{ dim n in 3..=8; param J: Sym<n>; param v: Vec<n>; \
             group Λ: SO<n> velocity Ω; constraint next(Λ) = Λ*Ω; \
             lagrangian = -tr((J + diag(v))*Ω)/h - v[{index}]; }}"
        )
    };
    let checked = |index| check(&tokens(&model(index)).and_then(parse)?);
    assert!(checked(3).is_ok());
    let message = checked(4).map_or_else(|e| e.to_string(), |_| "accepted".to_owned());
    assert!(message.contains("the smallest `n`"), "{message}");
}

#[test]
fn functions_have_their_parities_and_relations() {
    same("sin(-m)", "-sin(m)");
    same("cos(g - m)", "cos(m - g)");
    same("abs(m - g)", "abs(g - m)");
    same("cosh(m)^2 - sinh(m)^2", "1");
    same("sin(m)^2 + cos(m)^2", "1");
    same("tanh(m)*cosh(m)", "sinh(m)");
    same("exp(m) - exp(-m)", "2*sinh(m)");
    same("abs(m)", "sign(m)*m");
    let different = |a: &str, b: &str| {
        let spec = checked("", a).unwrap_or_else(|e| panic!("{a}: {e}"));
        let algebra = Algebra::new(&spec.symbols);
        assert!(!algebra.equal(&spec.typed, &accepted(b)), "{a} is not {b}");
    };
    different("sin(m)", "sin(g)");
    different("sin(m)", "cos(m)");
    different("sinh(m)", "sin(m)");
    different("sign(m)", "sign(g)");
    different("abs(m)", "m");
    different("exp(m)", "exp(-m)");
    different("cosh(m)^2 + sinh(m)^2", "1");
}

#[test]
fn a_diagonal_is_that_of_a_vector_or_of_a_matrix() {
    same(
        "tr(diag(Γ)*J)",
        "Γ[1]*J[1, 1] + Γ[2]*J[2, 2] + Γ[3]*J[3, 3]",
    );
    same("tr(diag(J)*J)", "J[1, 1]^2 + J[2, 2]^2 + J[3, 3]^2");
    same(
        "dot(v, diag(v)*Γ)",
        "v[1]^2*Γ[1] + v[2]^2*Γ[2] + v[3]^2*Γ[3]",
    );
    assert!(refused("", "tr(diag(F))").contains("square matrix"));
}

/// A body in two advected fields, declared as `declared` says.
fn carried(declared: &str) -> Result<Spec, Errors> {
    let source = format!(
        "model Body {{ param J: Sym<3>; group Λ: SO<3> velocity Ω; {declared} \
         constraint next(Λ) = Λ*Ω; constraint next(A) = Ω^T*A*Ω; constraint next(B) = Ω^T*B*Ω; \
         lagrangian = -tr(J*Ω)/h - h*tr(J*A*B) - 2*h*tr(J*B); }}"
    );
    check(&tokens(&source).and_then(parse)?)
}

#[test]
fn advected_quantities_are_declared_together_as_apart() {
    let read = |declared: &str| carried(declared).unwrap_or_else(|e| panic!("{declared}: {e}"));
    let apart = read("/// field\nadvected A: Sym<3>; /// field\nadvected B: Sym<3>;");
    let together = read("/// field\nadvected A, B: Sym<3>;");
    // Symbols with shape, structure, role and documentation, in this order, and the expressions built from them.
    assert_eq!(together.symbols, apart.symbols);
    assert_eq!(together.typed, apart.typed);
    let updates = |spec: &Spec| -> Vec<_> {
        let all = spec.advected.iter();
        all.map(|a| (a.quantity, a.update.clone(), a.definition.clone()))
            .collect()
    };
    assert_eq!(updates(&together), updates(&apart));
    assert_eq!(together.advected.len(), 2);
    for a in &together.advected {
        let symbol = together.symbols.get(a.quantity);
        assert_eq!(symbol.docs, [" field"], "{}", symbol.name);
        assert_eq!(symbol.structure, crate::expr::shape::Structure::Symmetric);
    }
    // Symbols keep the order of declaration, and the shapes are not interchanged.
    assert_ne!(read("advected B, A: Sym<3>;").symbols, apart.symbols);
    assert_ne!(
        read("advected A: Sym<3>; advected B: Mat<3, 3>;").symbols,
        apart.symbols
    );
    let refused = |declared: &str| match carried(declared) {
        Ok(_) => format!("`{declared}` is accepted"),
        Err(errors) => errors.to_string(),
    };
    for (declared, said) in [
        (
            "advected A, B: Sym<3> = Λ^T*J*Λ;",
            "only one quantity can have a definition",
        ),
        ("advected A, A: Sym<3>;", "`A`"),
        ("advected A, J: Sym<3>;", "`J`"),
        ("advected A, : Sym<3>;", "the name of an advected quantity"),
        ("advected A B: Sym<3>;", "`:`"),
        ("advected A, B, C: Sym<3>;", "`C`"),
    ] {
        let message = refused(declared);
        assert!(
            message.contains(said) && !message.contains("is accepted"),
            "{declared}: {message}"
        );
    }
}

#[test]
fn what_stands_without_a_sign_after_a_factor_is_refused() {
    for (text, remedy) in [
        ("Γ[1]2", "`*2`"),
        ("(m + g)2", "`*2`"),
        ("m 2", "`*2`"),
        ("2 3", "`*3`"),
        ("m^2 3", "`*3`"),
        ("-dot(v, Γ) 2.5", "`*2.5`"),
        ("dot(v, Γ)(2)", "`*(...)`"),
        ("Γ[1](m + g)", "`*(...)`"),
        ("J[1, 2] (m + g)", "`*(...)`"),
        ("m^2(3)", "`*(...)`"),
        ("g*m^2(3)", "`*(...)`"),
        ("m^1/2", "`m^(1/2)`"),
        ("m^1/2", "`m/2`"),
        ("2*(m + g)^1/3*g", "`a^(1/3)`"),
    ] {
        let message = refused("", text);
        assert!(message.contains(remedy), "{text}: {message}");
    }
    // Unambiguous notation is accepted.
    same("2 (m + g)", "2*m + 2*g");
    same("(m + g)(m - g)", "m^2 - g^2");
    same("(m^2)(m + g)", "m^3 + m^2*g");
    same("(dot(v, Γ))(m + g) m", "dot(v, Γ)*m^2 + m*g*dot(v, Γ)");
    same("dot(v, Γ) m", "m*dot(v, Γ)");
    same("m^2/2 - m^4/4", "(m^2 - m^4/2)/2");
    same("m^(1/2)*m^(1/2)", "m");
    same("m^-1/2*g", "g/(2*m)");
}

#[test]
fn numbers_of_other_languages_are_refused() {
    for (text, said) in [
        ("0x10*m", "write `16`"),
        ("m*0xff", "write `255`"),
        ("0b11*m", "write `3`"),
        ("m^0x2", "write `2`"),
        ("0o1_7*m", "write `15`"),
        (
            "0xffffffffffffffffffffffffffffffffff*m",
            "numbers are decimal",
        ),
        ("2f64*m", "write `2`"),
        ("1.5f32*m", "write `1.5`"),
        ("3u8*m", "have no type"),
    ] {
        let message = refused("", text);
        assert!(message.contains(said), "{text}: {message}");
    }
}

#[test]
fn what_has_no_value_anywhere_is_refused() {
    let declared = "param p: Real; param S: Skew<3>;";
    for (text, said) in [
        ("log(0)", "`log` is zero"),
        ("log(p - p)", "`log` is zero"),
        ("log(det(hat(v)))", "`log` is zero"),
        ("log(-1)", "`log` is negative"),
        ("log(-p*p)", "negative or zero"),
        ("log(-dot(Γ, Γ))", "negative or zero"),
        ("log(sin(p) - 2)", "`log` is negative"),
        ("log(-exp(p))", "`log` is negative"),
        ("log(tanh(p) - 1)", "`log` is negative"),
        ("sqrt(-1)", "root is negative"),
        ("sqrt(-1 - p^2)", "root is negative"),
        ("sqrt(-abs(p))", "root is negative or zero"),
        ("(-dot(v, v) - 1)^(3/2)", "root is negative"),
        ("(p - p)^-2", "identically zero"),
        ("(p - p)^(-1/2)", "identically zero"),
        ("tr(hat(Γ)^-1)", "has no inverse"),
        ("tr(inv(S)*J)", "has no inverse"),
        ("tr((v*Γ^T)^-1)", "has no inverse"),
        ("tr(inv(hat(v)*J)*J)", "has no inverse"),
        ("3^1000000", "from -256 to 256"),
        ("p^257", "from -256 to 256"),
        ("p^-300", "from -256 to 256"),
        ("p^(1000/3)", "from -256 to 256"),
        ("J[1, 1]*exp(1000)", "1.8e308"),
        ("1e30^25", "1.8e308"),
        ("cosh(p)*exp(exp(exp(10)))", "1.8e308"),
    ] {
        let message = refused(declared, text);
        assert!(message.contains(said), "{text}: {message}");
    }
    for text in [
        "log(p)",
        "log(-p)",
        "log(1 - p^2)",
        "sqrt(0)",
        "sqrt(p - 1)",
        "sqrt(-p)",
        "log(dot(Γ, Γ))",
        "log(2 + sin(p))",
        "log(1 - tanh(p))",
        "tr((hat(v) + Id)^-1)",
        "tr((S*S - J)^-1)",
        "p^256 + p^-256 + p^1.4",
        "exp(-1000)*p",
        "exp(700)*p",
        "abs(p)^(1/3)",
    ] {
        assert!(
            checked(declared, text).is_ok(),
            "{}",
            refused(declared, text)
        );
    }
    // The position of the expression does not matter.
    let message = refused("param p: Real; assume log(-p^2) > 0;", "p");
    assert!(message.contains("negative or zero"), "{message}");
}

/// The error for a term in n dimensions, added to a valid term.
fn of_size(n: &str, term: &str) -> String {
    let source = format!(
        "model Body {{ {n} param J: Sym<n>; param v: Vec<n>; group Λ: SO<n> velocity Ω; \
         constraint next(Λ) = Λ*Ω; lagrangian = -tr(J*Ω)/h - h*{term}; }}"
    );
    let source = match n.strip_prefix("size ") {
        Some(size) => source.replace(n, "").replace("<n>", &format!("<{size}>")),
        None => source,
    };
    match tokens(&source).and_then(parse).and_then(|m| check(&m)) {
        Ok(_) => "accepted".to_owned(),
        Err(errors) => errors.to_string(),
    }
}

#[test]
fn unit_vectors_are_those_of_the_size() {
    for (n, term) in [
        ("size 2", "dot(Λ*v, E2)"),
        ("size 4", "dot(Λ*v, E4)"),
        ("size 5", "tr(Λ*E4*E5^T)"),
        ("size 8", "dot(E8, Λ*(E1 + E8))"),
        ("dim n in 4..=6;", "dot(Λ*v, E4)"),
    ] {
        assert_eq!(of_size(n, term), "accepted", "{n}: {term}");
    }
    for (n, term, said) in [
        (
            "size 2",
            "dot(Λ*v, E3)",
            "`E3` does not exist in 2 dimensions\n  help: the unit vectors here are `E1` and `E2`",
        ),
        (
            "size 2",
            "dot(Λ*E3, v)",
            "`E3` does not exist in 2 dimensions",
        ),
        (
            "size 2",
            "tr(Λ*E1*E3^T)",
            "`E3` does not exist in 2 dimensions",
        ),
        (
            "size 3",
            "dot(Λ*v, E4)",
            "`E4` does not exist in 3 dimensions\n  help: the unit vectors here are `E1` to `E3`",
        ),
        ("size 3", "dot(Λ*v, E1 + E5)", "`E5` does not exist"),
        (
            "size 3",
            "dot(Λ*v, E9)",
            "the named unit vectors are `E1` to `E8`",
        ),
        (
            "dim n in 3..=8;",
            "dot(Λ*v, E4)",
            "`E4` does not exist for the smallest `n`, which is 3",
        ),
    ] {
        let message = of_size(n, term);
        assert!(message.contains(said), "{n}: {term}: {message}");
        assert!(!message.contains("declare it"), "{message}");
    }
}

#[test]
fn definitions_in_a_circle_are_told_as_one() {
    let cases = [
        ("let a = 2*a;", "`a` is defined in terms of itself"),
        (
            "let a = 2*b; let b = m + a;",
            "these definitions are circular: `a` uses `b`, `b` uses `a`",
        ),
        (
            "let a = tr(J)*b; let b = -(c[1]); let c = a*v; let d = a;",
            "these definitions are circular: `a` uses `b`, `b` uses `c`, `c` uses `a`",
        ),
        (
            // The error lists the cycle, without the path that leads to it.
            "let d = a; let a = b^2; let b = sin(a);",
            "these definitions are circular: `a` uses `b`, `b` uses `a`",
        ),
    ];
    for (lets, said) in cases {
        let message = refused(lets, "a");
        assert_eq!(message.lines().next(), Some(said), "{lets}: {message}");
        assert!(!message.contains("move `let"), "{lets}: {message}");
    }
    let two = refused("let a = b; let b = a; let c = d; let d = c;", "a + c");
    assert!(
        two.contains("`a` uses `b`") && two.contains("`c` uses `d`"),
        "{two}"
    );
    let order = refused("let a = 2*b; let b = m;", "a");
    assert!(order.contains("move `let b = ...;` up"), "{order}");
}

#[test]
fn what_papers_write_otherwise_is_told_as_the_language_writes_it() {
    for (declared, term, said) in [
        ("param u: Vec3;", "m", "write `Vec<3>`"),
        ("param u: Sym3;", "m", "write `Sym<3>`"),
        ("param u: SO3;", "m", "write `SO<3>`"),
        ("param u: Vec(3);", "m", "write sizes in angle brackets"),
        ("param u: Real = 1.0;", "m", "values belong in the case"),
        (
            "group R: SO(3) velocity w;",
            "m",
            "write sizes in angle brackets",
        ),
        ("# a remark\n", "m", "write a comment after `//`"),
        ("L = m;", "m", "write `lagrangian = ...;`"),
        (
            "E = m*g;",
            "m",
            "to name an expression, write `let E = ...;`",
        ),
        ("q: Vec<3>;", "m", "`field q: ...;` for a configuration"),
        ("", "m/dt^2", "the time step is named `h` here"),
        (
            "",
            "m*t",
            "cannot depend on the time `t` unless you declare a clock",
        ),
        ("", "v.z", "write a component of a vector as `v[3]`"),
        ("", "m**2", "write a power as `a^2`"),
        ("", "|v|", "the length of a vector is `sqrt(dot(X, X))`"),
        ("", "m/|v|", "the length of a vector is `sqrt(dot(X, X))`"),
        ("", "dot(dΓ, v)", "`(next(Γ) - Γ)/h`"),
        ("", "dot(dΓ/dt, v)", "`(next(Γ) - Γ)/h`"),
        ("", "dot(Γ_dot, v)", "`(next(Γ) - Γ)/h`"),
    ] {
        let found = refused(declared, term);
        assert!(found.contains(said), "{declared} {term}: {found}");
    }
    // Quantities that do not move do not have rates.
    assert!(!refused("", "dm").contains("next"), "{}", refused("", "dm"));
}
