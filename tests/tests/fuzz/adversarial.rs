//! Adversarial inputs of at most 10 kB, with names: deep nesting, expressions that explode when expanded, absurd numbers.

use crate::probe::Input;
use std::fmt::Write;

/// A heavy top with a different Lagrangian, and additional statements before it.
fn top(statements: &str, lagrangian: &str) -> String {
    format!(
        "model Top {{ param J, K: Sym<3>; param B: Mat<3>; param c: Real; param gU, z: Vec<3>; \
         group Λ: SO<3> velocity Ω; advected Γ: Vec<3> = Λ^T*z; advected S: Sym<3>; \
         constraint next(Λ) = Λ*Ω; constraint next(Γ) = Ω^T*Γ; constraint next(S) = Ω^T*S*Ω; \
         {statements} lagrangian = -tr(J*Ω)/h - {lagrangian}; }}"
    )
}

fn nested(open: &str, depth: usize, core: &str, close: &str) -> String {
    format!("{}{core}{}", open.repeat(depth), close.repeat(depth))
}

fn joined(count: usize, separator: &str, part: impl Fn(usize) -> String) -> String {
    let parts: Vec<String> = (0..count).map(part).collect();
    parts.join(separator)
}

/// `let v1 = f(v0); let v2 = f(v1); ...`, where `step` writes f.
fn chain(count: usize, first: &str, step: impl Fn(&str) -> String) -> String {
    let mut text = format!("let v0 = {first};");
    for place in 0..count {
        let value = step(&format!("v{place}"));
        // Writing to a string cannot fail.
        let _ = write!(text, " let v{} = {value};", place + 1);
    }
    text
}

fn depths() -> Vec<(&'static str, String)> {
    vec![
        ("parentheses", top("", &nested("(", 4000, "c", ")"))),
        ("parentheses alone", nested("(", 4900, "", ")")),
        ("parentheses left open", "(".repeat(9000)),
        ("parentheses closed", ")".repeat(9000)),
        ("brackets left open", top("", &"[({".repeat(3000))),
        ("braces", nested("{", 4900, "", "}")),
        ("models in models", nested("model A { ", 700, "", "}")),
        ("minuses", top("", &format!("{}c", "-".repeat(8000)))),
        ("minuses apart", top("", &format!("{}c", "- ".repeat(4000)))),
        (
            "transposes",
            top("", &format!("tr(J{})", "^T".repeat(4500))),
        ),
        (
            "inverses",
            top("", &format!("tr((Id+S*S){})", "^-1".repeat(3000))),
        ),
        (
            "powers of powers",
            top("", &format!("c{}", "^2".repeat(60))),
        ),
        ("traces", top("", &nested("tr(", 1200, "J", ")"))),
        (
            "traces of multiples",
            top("", &nested("tr(J*", 900, "Ω", ")")),
        ),
        (
            "exponentials",
            top("", &nested("exp(", 1500, "dot(Γ,gU)", ")")),
        ),
        (
            "roots",
            top("", &nested("sqrt(1+", 1100, "dot(Γ,gU)^2", ")")),
        ),
        (
            "few roots",
            top("", &nested("sqrt(1+", 40, "dot(Γ,gU)^2", ")")),
        ),
        (
            "logarithms",
            top("", &nested("log(2+", 60, "dot(Γ,gU)^2", ")")),
        ),
        (
            "inverses nested",
            top("", &format!("tr({})", nested("inv(Id+", 400, "S*S", ")"))),
        ),
        (
            "few inverses nested",
            top("", &format!("tr({})", nested("inv(Id+", 12, "S*S", ")"))),
        ),
        (
            "continued fraction",
            top("", &nested("1/(1+", 900, "dot(Γ,gU)^2", ")")),
        ),
        (
            "short continued fraction",
            top("", &nested("1/(1+", 30, "dot(Γ,gU)^2", ")")),
        ),
        (
            "vector products",
            top(
                "",
                &format!("dot(Γ,{})", nested("cross(Γ,", 500, "gU", ")")),
            ),
        ),
        (
            "hats",
            top("", &format!("tr({})", nested("hat(vee(", 400, "S", "))"))),
        ),
        (
            "halves",
            top("", &format!("tr({})", nested("sym(B*", 30, "S", ")"))),
        ),
        (
            "skew halves",
            top("", &format!("tr({})", nested("skew(Ω*", 25, "S", ")"))),
        ),
        (
            "next of next",
            top("", &format!("dot(gU,{})", nested("next(", 1500, "Γ", ")"))),
        ),
        (
            "second invariants",
            top("", &nested("I2(J*", 300, "Ω", ")")),
        ),
        ("determinants", top("", &nested("det(S*", 100, "Ω", ")"))),
        ("let block", top(&"{".repeat(3000), "c")),
        ("comment left open", top("/*", "c")),
        ("comments nested", nested("/*", 2400, "", "*/")),
        (
            "generics",
            top(
                &format!("param X: {};", nested("Vec<", 1500, "3", ">")),
                "c",
            ),
        ),
    ]
}

fn explosions() -> Vec<(&'static str, String)> {
    let letters: Vec<String> = (b'a'..=b'z')
        .map(|letter| format!("{}_", char::from(letter)))
        .collect();
    let declared = format!("param {}: Real;", letters.join(", "));
    let sum = letters.join("+");
    let velocities = joined(12, "+", |n| format!("tr(J*{}Ω)", "K*".repeat(n)));
    let vectors = joined(8, "+", |n| format!("dot(Γ,{}gU)", "K*".repeat(n)));
    let product = joined(40, "*", |_| "(J+K+Ω+S)".to_owned());
    vec![
        (
            "sum to a power",
            top(&declared, &format!("dot(Γ,gU)*({sum})^64")),
        ),
        (
            "sum to a large power",
            top(&declared, &format!("({sum})^1000000000")),
        ),
        (
            "velocities to a power",
            top("", &format!("({velocities})^64")),
        ),
        ("potentials to a power", top("", &format!("({vectors})^64"))),
        (
            "potentials to a moderate power",
            top("", &format!("({vectors})^6")),
        ),
        ("negative power", top("", &format!("(2+({vectors})^2)^-64"))),
        ("product of sums", top("", &format!("tr({product})"))),
        (
            "determinant of a product of sums",
            top(
                "",
                &format!("det(Id+{})^-1", joined(16, "*", |_| "(Ω+S)".to_owned())),
            ),
        ),
        (
            "product of a named sum",
            top(
                "let W = c*I1(S) + c*I2(S) + det(S) - c/2*log(1+tr(S)^2);",
                &joined(10, " ", |_| "h*W".to_owned()),
            ),
        ),
        (
            "product of scalar sums",
            top("", &joined(60, "*", |_| "(c+dot(Γ,gU)+tr(S))".to_owned())),
        ),
        (
            "product of fractions",
            top("", &joined(60, "*", |_| "(1+1/(2+dot(Γ,gU)^2))".to_owned())),
        ),
        (
            "lets that double",
            top(&chain(200, "dot(Γ,gU)", |v| format!("{v}+{v}")), "v200"),
        ),
        (
            "lets that square",
            top(&chain(200, "dot(Γ,gU)", |v| format!("{v}*{v}")), "v200"),
        ),
        (
            "lets that square a sum",
            top(&chain(60, "1+dot(Γ,gU)", |v| format!("{v}*{v}+1")), "v60"),
        ),
        (
            "lets that square a matrix",
            top(&chain(60, "J+Ω", |v| format!("{v}*{v}")), "tr(v60)"),
        ),
        (
            "lets that square a word",
            top(&chain(60, "Ω*J", |v| format!("{v}*{v}")), "tr(v60)"),
        ),
        (
            "lets of inverses",
            top(&chain(60, "S", |v| format!("inv(Id+{v}*{v})")), "tr(v60)"),
        ),
        (
            "lets of determinants",
            top(&chain(40, "S", |v| format!("det({v}+Ω)*{v}")), "tr(v40)"),
        ),
        (
            "lets of roots",
            top(
                &chain(60, "dot(Γ,gU)", |v| format!("sqrt(1+{v}*{v})")),
                "v60",
            ),
        ),
        (
            "lets of exponentials",
            top(
                &chain(60, "dot(Γ,gU)", |v| format!("exp({v}*{v})+{v}")),
                "v60",
            ),
        ),
        (
            "lets of products",
            top(
                &chain(60, "Γ", |v| format!("cross({v},S*{v})")),
                "dot(v60,gU)",
            ),
        ),
        (
            "lets of symmetric parts",
            top(&chain(60, "S", |v| format!("sym({v}*Ω*{v})")), "tr(v60)"),
        ),
        (
            "lets unused",
            top(&chain(300, "Γ", |v| format!("{v}+{v}")), "c"),
        ),
        (
            "long word",
            top(
                "",
                &format!("tr({})", joined(1800, "*", |_| "Ω".to_owned())),
            ),
        ),
        (
            "long mixed word",
            top(
                "",
                &format!("tr({})", joined(700, "*", |_| "J*Ω".to_owned())),
            ),
        ),
        (
            "long juxtaposition",
            top("", &format!("tr({})", "J Ω ".repeat(500))),
        ),
        (
            "many summands",
            top("", &joined(300, "+", |n| format!("{}*dot(Γ,K*gU)", n + 1))),
        ),
        (
            "many different summands",
            top(
                "",
                &joined(40, "+", |n| format!("tr({}Ω)", "K*J*".repeat(n))),
            ),
        ),
        (
            "many primes",
            top("", &joined(300, "+", |n| format!("c/{}", 2 * n + 3))),
        ),
        (
            "many quotients",
            top("", &format!("c{}", "/3".repeat(3000))),
        ),
        (
            "as many quotients as may be",
            top("", &format!("c{}", "/3".repeat(498))),
        ),
        (
            "many products of a number",
            top("", &format!("c{}", "*3".repeat(3000))),
        ),
        ("power of the velocity", top("", "tr(Ω)^200")),
        ("power of a determinant", top("", "det(S+Ω)^100")),
        (
            "determinants of sums",
            top("", "det(J+K+S+Ω+B+Id)^3*I2(J+K+S+Ω+B)^4"),
        ),
        (
            "nested squares",
            top("", &nested("(1+", 24, "dot(Γ,gU)", ")^2")),
        ),
    ]
}

fn numbers() -> Vec<(&'static str, String)> {
    let digits = "9".repeat(5000);
    let numbers = [
        ("exponent of a number", "c*1e400"),
        ("negative exponent", "c*1e-400"),
        ("huge exponent", "c*1e999999999999"),
        ("hundred zeros", "c*1e100"),
        ("power of two", "c*340282366920938463463374607431768211456"),
        ("power of a number", "c*3^400"),
        ("power of a fraction", "c*(1/3)^400"),
        ("huge power", "c^99999999999999999999"),
        ("largest power", "c^2147483648"),
        ("least power", "c^-2147483648"),
        ("decimal power", "c^0.3333333333333333333333"),
        ("decimal", "0.1234567890123456789012345678901234567890*c"),
        ("division by zero", "c/0"),
        ("division by a difference", "c/(h-h)"),
        ("inverse of zero", "0^-1"),
        ("zero by zero", "0/0"),
        ("zero to zero", "0^0"),
        ("infinite tower", "c^2^2^2^2^2^2^2^2^2^2^2"),
        ("hexadecimal", "0xffffffffffffffffffffffff*c"),
        ("suffix", "3u8*c"),
        ("float suffix", "1.0f32*c"),
        ("two dots", "1..2*c"),
        ("product of tenths", "0.1^40*c"),
        ("logarithm of zero", "log(0)*c"),
        ("root of minus one", "sqrt(-1)*c"),
        ("inverse of zero matrix", "tr(inv(J-J)*S)"),
        ("transpose of a number", "2^T*c"),
        ("letter as power", "c^c"),
        ("nothing as power", "c^"),
    ];
    let mut inputs: Vec<(&'static str, String)> = numbers
        .iter()
        .map(|(name, text)| (*name, top("", text)))
        .collect();
    inputs.push(("five thousand digits", top("", &format!("c*{digits}"))));
    inputs.push(("five thousand decimals", top("", &format!("c*0.{digits}"))));
    inputs
}

fn declarations() -> Vec<(&'static str, String)> {
    let statements = [
        ("large dimension", "dim n in 0..=99999; param X: Sym<n>;"),
        ("empty dimension", "dim n in 9..=2; param X: Sym<n>;"),
        (
            "huge dimension",
            "dim n in 0..=99999999999999999999999; param X: Sym<n>;",
        ),
        ("large vector", "param X: Vec<4000000000>;"),
        ("empty vector", "param X: Vec<0>;"),
        ("absurd matrix", "param X: Mat<4000000000, 4000000000>;"),
        ("absurd symmetric", "param X: Sym<99999999999999999999>;"),
        (
            "large group",
            "group X: SO<1000> velocity W; constraint next(X) = X*W;",
        ),
        (
            "larger group",
            "group X: GL<4000000000> velocity W; constraint next(X) = X*W;",
        ),
        (
            "no group",
            "group X: SO<0> velocity W; constraint next(X) = X*W;",
        ),
        (
            "group of one",
            "group X: SO<1> velocity W; constraint next(X) = X*W;",
        ),
        ("let of itself", "let v = v;"),
        ("lets of each other", "let v = w; let w = v;"),
        (
            "advected by itself",
            "advected Y: Vec<3> = Y; constraint next(Y) = Y;",
        ),
        (
            "advected by its next",
            "advected Y: Vec<3>; constraint next(Y) = next(Y);",
        ),
        ("constraint twice", "constraint next(Γ) = Ω^T*Γ;"),
        ("declared twice", "param J: Sym<3>;"),
        ("scale of zero", "scale 0;"),
        ("scale of a difference", "scale h - h;"),
        ("scale of a matrix", "scale J;"),
        ("scale of a velocity", "scale tr(Ω);"),
        ("node of nothing", "node;"),
        ("second lagrangian", "lagrangian = c;"),
        ("time of itself", "time h step h;"),
        ("label", "label i in 0..N step s;"),
        ("mesh", "mesh H: Real at n = deposit(m, X);"),
        (
            "given",
            "given RF(Sym<3>): Real = clebsch::functions::carlson_rf;",
        ),
        ("end", "end i = 0 { free; }"),
    ];
    let mut inputs: Vec<(&'static str, String)> = statements
        .iter()
        .map(|(name, text)| (*name, top(text, "tr(S)")))
        .collect();
    let symbols = joined(500, ", ", |n| format!("p{n}"));
    let used = joined(500, "+", |n| format!("p{n}"));
    inputs.push((
        "five hundred symbols",
        top(
            &format!("param {symbols}: Real;"),
            &format!("({used})*tr(S)"),
        ),
    ));
    let groups = joined(60, " ", |n| {
        format!("group G{n}: SO<3> velocity W{n}; constraint next(G{n}) = G{n}*W{n};")
    });
    let kinetic = joined(60, "+", |n| format!("tr(J*W{n})"));
    inputs.push(("sixty groups", top(&groups, &kinetic)));
    let advected = joined(90, " ", |n| {
        format!("advected a{n}: Vec<3>; constraint next(a{n}) = Ω^T*a{n};")
    });
    let potentials = joined(90, "+", |n| format!("dot(a{n},gU)"));
    inputs.push(("ninety advected", top(&advected, &potentials)));
    inputs.push((
        "long name",
        top(&format!("param {}: Real;", "x".repeat(9000)), "c"),
    ));
    inputs
}

fn letters() -> Vec<(&'static str, String)> {
    let junk = [
        ("nothing", ""),
        ("blank", " \n\t\r\n "),
        ("zero bytes", "model\0Top\0{\0}"),
        ("byte order mark", "\u{feff}model Top {}"),
        (
            "right to left",
            "model \u{202e}poT { lagrangian \u{2066}= 0; }",
        ),
        (
            "zero width",
            "model T\u{200b}op { lagra\u{200d}ngian = 0; }",
        ),
        ("pictures", "model 🦀 { lagrangian = 🎩*🪀; }"),
        (
            "combining",
            "model M\u{302}\u{302}\u{302} { lagrangian = a\u{301}; }",
        ),
        (
            "mathematics",
            "model Top { lagrangian = ½⟨Ω, JΩ⟩ − ∑ ∇·Γ ⊗ χ⁺ ∘ Ω₁; }",
        ),
        ("private use", "\u{e000}\u{f8ff}\u{10ffff}"),
        ("full width", "ｍｏｄｅｌ Ｔｏｐ ｛ ｝"),
        ("string left open", "model Top { \"text }"),
        ("character left open", "model Top { 'x }"),
        ("raw string", "model Top { r##\"text\"# }"),
        ("lifetimes", "model Top { lagrangian = 'a 'b 'static; }"),
        ("unicode escape", "model Top { \"\\u{110000}\" }"),
        (
            "prime",
            "model Top { group Λ: SO<3> velocity Ω; constraint Λ' = Λ*Ω; }",
        ),
        ("attribute", "#![allow(x)] #[doc = 3] model Top { }"),
        ("doc comment", "/// text\npub model Top { /// inner\n }"),
        ("two models", "model A {} model B {}"),
        ("no name", "model {}"),
        ("no body", "model Top"),
        ("empty body", "model Top {}"),
        ("macro", "model! { model Top {} }"),
        ("dollar", "model $top { $($x:tt)* }"),
        ("shebang", "#!/bin/sh\nmodel Top {}"),
        ("line ends", "model Top {\r lagrangian = 0;\u{2028}\u{85} }"),
    ];
    let mut inputs: Vec<(&'static str, String)> = junk
        .iter()
        .map(|(name, text)| (*name, (*text).to_owned()))
        .collect();
    let every: String = (0..2200)
        .filter_map(|code| char::from_u32(code * 31 + 7))
        .collect();
    inputs.push(("every script", every.chars().take(2400).collect()));
    inputs.push(("names of pictures", top("", &"🦀".repeat(1500))));
    inputs
}

/// All adversarial inputs.
pub fn inputs() -> Vec<Input> {
    [depths(), explosions(), numbers(), declarations(), letters()]
        .into_iter()
        .flatten()
        .map(|(name, text)| Input {
            name: name.to_owned(),
            text,
        })
        .collect()
}
