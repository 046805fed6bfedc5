//! How a LaTeX name is interpreted for printing, in the form in which plain names are compared. Spaces and braces
//! print nothing, and upright and italic words look alike; other fonts and accents do not.

use super::{shown, skeleton};
use crate::expr::symbol::GREEK;

/// A row of pieces: its text, and the scripts of its last piece.
#[derive(Default)]
struct Row {
    line: String,
    below: Vec<String>,
    above: String,
}

impl Row {
    /// Appends a piece. The scripts of the previous piece then belong to the text.
    fn push(&mut self, piece: &str) {
        let scripts = std::mem::take(&mut self.below).join(",");
        let above = std::mem::take(&mut self.above);
        if !scripts.is_empty() || !above.is_empty() {
            self.line.push_str(&format!("_{scripts}^{above} "));
        }
        self.line.push_str(piece);
    }

    /// The row as a piece of another row.
    fn text(self) -> String {
        match (self.below.is_empty(), self.above.is_empty()) {
            (true, true) => self.line,
            _ => format!("{}_{}^{}", self.line, self.below.join(","), self.above),
        }
    }
}

/// A LaTeX name as a reader sees it. `index` is the time index.
pub(crate) fn seen_typeset(latex: &str, index: &str) -> String {
    let latex = skeleton(latex);
    let row = row(&mut latex.chars().peekable());
    shown(&row.line, row.below, &row.above, index)
}

type Rest<'a> = std::iter::Peekable<std::str::Chars<'a>>;

/// Everything up to a closing brace, or the end.
fn row(rest: &mut Rest) -> Row {
    let mut out = Row::default();
    while let Some(c) = rest.next() {
        match c {
            '}' => break,
            '_' => out.below.push(argument(rest)),
            '^' => out.above = argument(rest),
            '\'' => out.above.push('′'),
            '{' => {
                let inner = row(rest);
                out.push(&inner.line);
                (out.below, out.above) = (inner.below, inner.above);
            }
            '\\' => {
                let piece = command(rest);
                if !piece.is_empty() {
                    out.push(&piece);
                }
            }
            c if c.is_whitespace() => {}
            c => out.push(&c.to_string()),
        }
    }
    out
}

/// The argument of a script or a command: a group in braces, or one piece.
fn argument(rest: &mut Rest) -> String {
    while rest.next_if(|c| c.is_whitespace()).is_some() {}
    match rest.next() {
        Some('{') => row(rest).text(),
        Some('\\') => command(rest),
        Some(c) => c.to_string(),
        None => String::new(),
    }
}

fn command(rest: &mut Rest) -> String {
    let mut word = String::new();
    while let Some(c) = rest.next_if(char::is_ascii_alphabetic) {
        word.push(c);
    }
    if word.is_empty() {
        // `\,` and the like: a space.
        rest.next();
        return String::new();
    }
    // The engine's plain letters are LaTeX's variant letters.
    let name = match word.as_str() {
        "varepsilon" => "epsilon",
        "epsilon" => "straightepsilon",
        "varphi" => "phi",
        "phi" => "straightphi",
        other => other,
    };
    if let Some((letter, _)) = GREEK.iter().find(|(_, n)| *n == name) {
        return letter.to_string();
    }
    match name {
        "ell" => "ℓ".to_owned(),
        "quad" | "qquad" => String::new(),
        "mathrm" | "mathit" | "mathnormal" | "text" | "textrm" | "textit" | "operatorname" => {
            argument(rest)
        }
        _ => format!("\\{name} "),
    }
}

#[cfg(test)]
mod tests {
    use super::super::seen;
    use super::seen_typeset;

    #[test]
    fn names_in_latex_that_print_alike_are_one_name() {
        for (latex, name) in [
            ("\\mu", "mu"),
            ("{\\mu}", "μ"),
            ("x_1", "x1"),
            ("x_{1}", "x_1"),
            ("J_{\\mathrm{eff}}", "J_eff"),
            ("J^R_{12}", "J_12^R"),
            ("J_{12}^{R}", "J_12^R"),
            ("\\mathit{gU}", "gU"),
            ("g\\,U", "gU"),
            ("M_k", "M"),
            ("M_{k+1}", "M"),
            ("{M}_{k-1}", "M_k"),
            ("\\gamma_{0k}", "gamma0"),
            ("\\gamma_{0,k+1}", "gamma_0"),
            ("\\varphi", "phi"),
            ("\\phi", "ϕ"),
            ("\\epsilon", "ϵ"),
            ("\\ell", "ℓ"),
            ("\\Omega", "Ω"),
            ("H", "Eta"),
        ] {
            assert_eq!(seen_typeset(latex, "k"), seen(name, "k"), "{latex}");
        }
        for (a, b) in [
            ("x", "y"),
            ("\\mathbf{x}", "x"),
            ("\\hat x", "x"),
            ("\\hat x", "\\bar x"),
            ("\\phi", "\\varphi"),
            ("x_1 y", "x y_1"),
            ("x^2", "x_2"),
            ("m_1 m_2", "m_2 m_1"),
            ("x'", "x"),
            ("x_{\\mathrm{ok}}", "x_o"),
            ("\\mathcal{I}", "I"),
        ] {
            assert_ne!(seen_typeset(a, "k"), seen_typeset(b, "k"), "{a} {b}");
        }
    }
}
