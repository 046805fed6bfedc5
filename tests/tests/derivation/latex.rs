//! Checks the structure of printed LaTeX: braces and dollars match, environments and `\\left` nest, every row of an alignment has
//! its mark, and only known commands occur. Covers the derivations of the gallery, and extra models for output that the gallery
//! does not produce.

use clebsch_core::document::{Citations, printed_telling};
use clebsch_core::print::{Format, Style};
use clebsch_core::{Derivation, derive_source};

fn derive(text: &str) -> Derivation {
    derive_source(text).unwrap_or_else(|e| panic!("{e}"))
}

fn latex(text: &str, citations: Citations) -> String {
    let columns = Style::default().columns;
    printed_telling(&derive(text), Format::Latex, columns, citations, None)
}

/// Permitted commands of LaTeX and amsmath.
const COMMANDS: &[&str] = &[
    "Big",
    "Biggl",
    "Biggr",
    "Bigl",
    "Bigr",
    "Delta",
    "Gamma",
    "Lambda",
    "Omega",
    "Phi",
    "Pi",
    "Psi",
    "Sigma",
    "Theta",
    "Upsilon",
    "Xi",
    "allowdisplaybreaks",
    "alpha",
    "bar",
    "begin",
    "beta",
    "biggl",
    "biggr",
    "bigl",
    "bigr",
    "cdot",
    "chi",
    "cite",
    "delta",
    "det",
    "diamond",
    "dot",
    "ell",
    "emergencystretch",
    "end",
    "epsilon",
    "eqref",
    "eta",
    "exp",
    "footnote",
    "frac",
    "gamma",
    "ge",
    "hat",
    "in",
    "iota",
    "item",
    "kappa",
    "label",
    "lambda",
    "langle",
    "le",
    "left",
    "log",
    "ln",
    "lvert",
    "mathbf",
    "mathit",
    "mathrm",
    "mathsf",
    "mbox",
    "mu",
    "nabla",
    "neq",
    "noindent",
    "notag",
    "nu",
    "omega",
    "operatorname",
    "partial",
    "phi",
    "pi",
    "psi",
    "quad",
    "raggedright",
    "rangle",
    "rho",
    "right",
    "rvert",
    "section",
    "sigma",
    "sqrt",
    "subsection",
    "sum",
    "tau",
    "text",
    "textasciicircum",
    "textasciitilde",
    "textbackslash",
    "texttt",
    "tfrac",
    "theta",
    "times",
    "to",
    "ttfamily",
    "upsilon",
    "usepackage",
    "varepsilon",
    "varphi",
    "varpi",
    "varrho",
    "varsigma",
    "vartheta",
    "vec",
    "wedge",
    "widehat",
    "xi",
    "zeta",
];

/// Delimiters of mathematics.
const MATHEMATICS: [&str; 6] = ["$", "\\[", "equation", "gather", "align", "align*"];

/// The first error in a piece of LaTeX, if any.
fn fault(text: &str) -> Option<String> {
    let characters: Vec<char> = text.chars().collect();
    // Open groups: a brace, a dollar, an environment, or a `\left`.
    let mut open: Vec<String> = Vec::new();
    // Open alignments, and the number of marks in the current row; matrix rows may have any number.
    let mut rows: Vec<(String, usize)> = Vec::new();
    let (mut i, mut line) = (0, 1);
    let close = |open: &mut Vec<String>, wanted: &str, line: usize| match open.pop() {
        Some(found) if found == wanted => None,
        found => Some(format!("line {line}: {wanted} closes {found:?}")),
    };
    while i < characters.len() {
        let c = characters[i];
        i += 1;
        match c {
            '\n' => line += 1,
            '%' => {
                while characters.get(i).is_some_and(|c| *c != '\n') {
                    i += 1;
                }
            }
            '{' => open.push("{".to_owned()),
            '}' => {
                if let Some(f) = close(&mut open, "{", line) {
                    return Some(f);
                }
            }
            '$' => match open.last().map(String::as_str) {
                Some("$") => drop(open.pop()),
                _ => open.push("$".to_owned()),
            },
            '&' => match rows.last_mut() {
                Some((_, n)) => *n += 1,
                None => return Some(format!("line {line}: & outside of an alignment")),
            },
            '^' | '_' if !open.iter().any(|o| MATHEMATICS.contains(&o.as_str())) => {
                return Some(format!("line {line}: {c} outside of mathematics"));
            }
            '\\' => {
                let start = i;
                while characters.get(i).is_some_and(char::is_ascii_alphabetic) {
                    i += 1;
                }
                let command: String = characters[start..i].iter().collect();
                if command.is_empty() {
                    // An escaped character, a space, or the end of a row.
                    let sign = characters.get(i).copied().unwrap_or(' ');
                    i += 1;
                    match sign {
                        '[' => open.push("\\[".to_owned()),
                        ']' => {
                            if let Some(f) = close(&mut open, "\\[", line) {
                                return Some(f);
                            }
                        }
                        _ => {}
                    }
                    if sign == '\\'
                        && let Some((kind, n)) = rows.last_mut()
                    {
                        if kind != "pmatrix" && *n != 1 {
                            return Some(format!("line {line}: {n} marks in a row"));
                        }
                        *n = 0;
                    }
                    continue;
                }
                if !COMMANDS.contains(&command.as_str()) {
                    return Some(format!("line {line}: unknown command {command}"));
                }
                match command.as_str() {
                    "left" | "bigl" | "Bigl" | "biggl" | "Biggl" => open.push("left".to_owned()),
                    "right" | "bigr" | "Bigr" | "biggr" | "Biggr" => {
                        if let Some(f) = close(&mut open, "left", line) {
                            return Some(f);
                        }
                    }
                    "begin" | "end" => {
                        let end = (i..characters.len()).find(|k| characters[*k] == '}')?;
                        let name: String = characters[i + 1..end].iter().collect();
                        i = end + 1;
                        let rowed =
                            ["aligned", "align", "align*", "pmatrix"].contains(&name.as_str());
                        if command == "begin" {
                            rows.extend(rowed.then(|| (name.clone(), 0)));
                            open.push(name);
                            continue;
                        }
                        if rowed {
                            match rows.pop() {
                                Some((kind, n)) if kind != "pmatrix" && n != 1 => {
                                    return Some(format!("line {line}: {n} marks in the last row"));
                                }
                                _ => {}
                            }
                        }
                        if let Some(f) = close(&mut open, &name, line) {
                            return Some(f);
                        }
                    }
                    _ => {}
                }
            }
            // LaTeX reads UTF-8, so names may contain accents.
            c if !c.is_ascii() && c != 'é' => {
                return Some(format!("line {line}: {c} is no ASCII"));
            }
            _ => {}
        }
    }
    open.pop().map(|o| format!("{o} is never closed"))
}

/// Models by name, with their citations.
fn documents() -> Vec<(String, String, Citations)> {
    let gallery = clebsch_models::gallery();
    let mut all: Vec<(String, String, Citations)> = gallery
        .iter()
        .map(|e| {
            (
                e.card.name.to_owned(),
                e.card.source.to_owned(),
                e.citations,
            )
        })
        .collect();
    for text in [
        clebsch_oracle::oracle::action::mixed::REDUCED,
        clebsch_oracle::oracle::action::mixed::UNREDUCED,
        "model Ellipsoid {
            dim n in 2..=4; param C0, I0: Sym<n>; param a, b, c: Real;
            group Q: GL<n> velocity G; advected C: Sym<n> = Q^T*C0*Q;
            constraint next(Q) = Q*G; constraint next(C) = G^T*C*G;
            let W = a*I1(C) + b*I2(C) + c*det(C) - (a/2)*log(det(C));
            lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) - h*W;
        }",
        "model Names {
            param J_long, alpha_2: Sym<3>; param x_y_z, under_score: Real; param g: Vec<3>;
            assume x_y_z >= under_score;
            group Lambda_body: SO<3> velocity W_body;
            advected Gamma_k: Vec<3>;
            constraint next(Lambda_body) = Lambda_body*W_body;
            constraint next(Gamma_k) = W_body^T*Gamma_k;
            lagrangian = -tr((J_long + alpha_2)*W_body)/h
                - h*exp(-x_y_z*dot(g, Gamma_k))*sqrt(1 + under_score^2 + dot(Gamma_k, Gamma_k));
        }",
    ] {
        all.push((
            text.chars().take(24).collect(),
            text.to_owned(),
            Citations::NONE,
        ));
    }
    all
}

#[test]
fn every_derivation_is_well_formed_latex() {
    for (name, source, citations) in documents() {
        let text = latex(&source, citations);
        if let Some(fault) = fault(&text) {
            panic!("{name}: {fault}\n{text}");
        }
    }
}

#[test]
fn faults_are_noticed() {
    let model = clebsch_models::find("heavy-top").expect("in the gallery");
    let right = latex(model.card.source, model.citations);
    assert_eq!(fault(&right), None);
    for (from, to) in [
        ("}", ""),
        ("{", ""),
        ("\\end{equation}", ""),
        ("\\end{aligned}", "\\end{equation}"),
        ("& :=", ":="),
        ("&\\quad", "\\quad"),
        ("$", ""),
        ("\\operatorname", "\\operator"),
        ("\\Lambda", "Λ"),
    ] {
        // Skips the comments at the top.
        let (comments, body) = right.split_at(right.find("\\section").expect("a section"));
        let wrong = format!("{comments}{}", body.replacen(from, to, 1));
        assert_ne!(wrong, right, "{from} does not occur");
        assert!(fault(&wrong).is_some(), "{from} by {to} is not noticed");
    }
}
