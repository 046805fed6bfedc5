//! Conditions of LaTeX and GitHub on printed derivations, checked without either: environments, braces and brackets
//! are balanced, commands belong to plain amsmath, and references have labels.

use crate::derive_source;
use crate::document::printed;
use crate::print::Format;

const MODELS: [&str; 4] = [
    "model Tensor { param w: Real; param z: Vec<3>;
        group Λ: SO<3> velocity ω; advected J: Sym<3>; advected chi: Vec<3>;
        constraint next(Λ) = ω*Λ; constraint next(J) = ω*J*ω^T; constraint next(chi) = ω*chi;
        lagrangian = -tr(ω*J)/h - h*w*dot(chi, z); }",
    "model Pair { param J1, J2: Sym<3>; param d1, d2: Vec<3>; param eps: Real;
        group Λ1: SO<3> velocity Ω1; group Λ2: SO<3> velocity Ω2;
        advected R: SO<3> = Λ1^T*Λ2;
        constraint next(Λ1) = Λ1*Ω1; constraint next(Λ2) = Λ2*Ω2;
        constraint next(R) = Ω1^T*R*Ω2;
        lagrangian = -(tr(J1*Ω1) + tr(J2*Ω2) + eps*dot((Ω1 - Id)*d1, R*(Ω2 - Id)*d2))/h; }",
    "model Shape { dim n in 2..=4; param C0, I0: Sym<n>; param a, b, c, d: Real;
        group Q: GL<n> velocity G; advected C: Sym<n> = Q^T*C0*Q;
        constraint next(Q) = Q*G; constraint next(C) = G^T*C*G;
        let W = a*I1(C) + b*I2(C) + c*det(C) - (d/2)*log(det(C));
        lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) - h*W; }",
    "model Four { param C: Mat<4>; group Λ: SO<4> velocity Ω; constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(C^T*Ω)/h; }",
];

/// The commands of LaTeX and amsmath that may appear.
const KNOWN: [&str; 75] = [
    "Bigg",
    "Biggl",
    "Biggr",
    "Big",
    "Gamma",
    "Lambda",
    "Omega",
    "Theta",
    "begin",
    "bigl",
    "bigr",
    "cdot",
    "chi",
    "delta",
    "det",
    "diamond",
    "ell",
    "end",
    "eqref",
    "exp",
    "frac",
    "gamma",
    "hat",
    "item",
    "label",
    "langle",
    "left",
    "log",
    "lvert",
    "mathit",
    "mathrm",
    "mbox",
    "mu",
    "nabla",
    "noindent",
    "nolimits",
    "mathop",
    "omega",
    "operatorname",
    "qquad",
    "quad",
    "rangle",
    "right",
    "rvert",
    "section",
    "sqrt",
    "subsection",
    "tag",
    "text",
    "tfrac",
    "times",
    "ttfamily",
    "usepackage",
    "widehat",
    "xi",
    "zeta",
    "to",
    "sum",
    "mathsf",
    "cite",
    "footnote",
    "in",
    "wedge",
    "kappa",
    "varepsilon",
    "eta",
    "textasciicircum",
    "textasciitilde",
    "textbackslash",
    "rtimes",
    "pm",
    "allowdisplaybreaks",
    "emergencystretch",
    "notag",
    "raggedright",
];

/// Checks braces, environments, `\left` and `\right`, and the commands of a text.
fn check(tex: &str, what: &str) {
    let mut depth = 0i64;
    let mut environments: Vec<String> = Vec::new();
    let mut fences: Vec<i64> = Vec::new();
    let mut rest = tex.char_indices().peekable();
    while let Some((at, c)) = rest.next() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            '\\' => {
                let mut name = String::new();
                while let Some((_, letter)) = rest.next_if(|(_, l)| l.is_ascii_alphabetic()) {
                    name.push(letter);
                }
                if name.is_empty() {
                    // `\{`, `\\` and `\,` are commands of one character.
                    rest.next();
                    continue;
                }
                assert!(KNOWN.contains(&name.as_str()), "{what}: \\{name}");
                let argument = || {
                    let open = tex[at..].find('{').unwrap();
                    let close = tex[at..].find('}').unwrap();
                    tex[at + open + 1..at + close].to_owned()
                };
                match name.as_str() {
                    "begin" => environments.push(argument()),
                    "end" => assert_eq!(environments.pop(), Some(argument()), "{what}"),
                    "left" => fences.push(depth),
                    // A pair must close within its group.
                    "right" => assert_eq!(fences.pop(), Some(depth), "{what}"),
                    _ => {}
                }
            }
            _ => {}
        }
        assert!(depth >= 0, "{what}: a brace is closed that was not opened");
    }
    assert_eq!(depth, 0, "{what}: braces");
    assert!(environments.is_empty() && fences.is_empty(), "{what}");
}

fn print(source: &str, format: Format) -> String {
    let d = derive_source(source).unwrap_or_else(|errors| panic!("{errors}"));
    printed(&d, format)
}

#[test]
fn latex_is_balanced_and_refers_to_what_is_there() {
    for source in MODELS {
        let tex = print(source, Format::Latex);
        let title = tex.lines().find(|line| line.starts_with("\\section"));
        let name: String = title.unwrap_or_default().to_owned();
        check(&tex, &name);
        assert!(
            tex.is_ascii() || tex.chars().all(|c| c < '\u{180}'),
            "{name}"
        );
        let mut references = 0;
        for part in tex.split("\\eqref{").skip(1) {
            let label = part.split('}').next().unwrap();
            assert!(label != "eq:none", "{name}: a reference leads nowhere");
            assert_eq!(
                tex.matches(&format!("\\label{{{label}}}")).count(),
                1,
                "{name}: {label}"
            );
            references += 1;
        }
        assert!(references > 5, "{name}");
    }
}

#[test]
fn every_formula_of_the_markdown_is_fenced_and_balanced() {
    for source in MODELS {
        let md = print(source, Format::Markdown);
        let mut formulas = 0;
        let blocks: Vec<&str> = md.split("```").collect();
        assert!(blocks.len() % 2 == 1, "a fence is not closed");
        for (i, block) in blocks.into_iter().enumerate() {
            let inside = i % 2 == 1;
            if inside && let Some(math) = block.strip_prefix("math\n") {
                check(math, math);
                assert!(math.contains("\\tag{"), "{math}");
                formulas += 1;
            }
            if !inside {
                let pieces: Vec<&str> = block.split("$`").collect();
                for piece in &pieces[1..] {
                    let (math, _) = piece.split_once("`$").expect("an open formula");
                    check(math, math);
                }
            }
        }
        assert!(formulas > 10, "{formulas}");
        assert!(!md.contains("operatorname"));
        assert!(!md.contains("(0)"), "a reference leads nowhere");
    }
}

#[test]
fn an_unbalanced_text_is_found() {
    for wrong in [
        "{a",
        "a}",
        "\\begin{equation}",
        "\\left( a",
        "{\\left( a} \\right)",
        "\\newcommand",
    ] {
        assert!(
            std::panic::catch_unwind(|| check(wrong, "wrong")).is_err(),
            "{wrong}"
        );
    }
}
