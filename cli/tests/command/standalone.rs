//! `derive --standalone`: complete documents. Every command in them belongs to LaTeX or to a package that they load.
//! Environments, brackets and dollar signs pair, the bibliography contains every citation, and every reference has
//! its label.

use crate::common::{Folder, clebsch, runs};
use std::collections::BTreeSet;

/// Commands of LaTeX itself, and Greek letters.
const LATEX: &str = "documentclass usepackage begin end section subsection item label cite bibitem footnote mbox textbf \
    raggedright emergencystretch ttfamily noindent emph texttt frac sqrt mathit mathrm mathsf mathbf mathcal left right bigl \
    bigr Bigl Bigr Biggl Biggr quad cdot times diamond langle rangle nabla delta sum surd wedge to equiv approx in le ge ne \
    hat widehat bar vec overline overrightarrow det exp log sin cos sinh cosh tanh ell partial infty circ otimes mapsto pm \
    backslash sim textbackslash textasciitilde textasciicircum nolimits mathop Big prime dagger parallel perp hbar tilde dot \
    ddot max min big bigg Bigg alpha beta gamma epsilon varepsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau \
    upsilon phi varphi chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega varpi vartheta varrho \
    varsigma imath jmath";

/// Commands of amsmath, of amssymb and of bm.
const PACKAGES: &str = "operatorname text eqref lvert rvert lVert rVert notag tfrac implies allowdisplaybreaks boldsymbol \
    rtimes mathbb bm";

const ENVIRONMENTS: &str = "document itemize flushleft thebibliography equation gather subequations aligned align align* \
    pmatrix";

/// The arguments of a command, without the square brackets before them.
fn arguments<'a>(text: &'a str, command: &str) -> Vec<&'a str> {
    let behind = text.split(command).skip(1);
    let braced = behind.filter_map(|rest| {
        let rest = match rest.strip_prefix('[') {
            Some(inner) => inner.split_once(']')?.1,
            None => rest,
        };
        Some(rest.strip_prefix('{')?.split_once('}')?.0)
    });
    braced.collect()
}

/// The words of commands, and signs after a backslash, extracted from the text.
fn read(text: &str) -> (BTreeSet<String>, String) {
    let (mut commands, mut rest) = (BTreeSet::new(), String::new());
    let mut letters = text.chars().peekable();
    while let Some(c) = letters.next() {
        if c != '\\' {
            rest.push(c);
            continue;
        }
        let mut word = String::new();
        while let Some(letter) = letters.next_if(char::is_ascii_alphabetic) {
            word.push(letter);
        }
        match word.is_empty() {
            // `\%`, `\{`, `\\`, `\,`
            true => drop(letters.next()),
            false => drop(commands.insert(word)),
        }
    }
    (commands, rest)
}

fn compiles(what: &str, text: &str) {
    assert!(
        text.starts_with("\\documentclass{article}\n"),
        "{what}: {text}"
    );
    assert!(text.ends_with("\n\\end{document}\n"), "{what}: {text}");
    let (commands, rest) = read(text);
    let known: BTreeSet<&str> = [LATEX, PACKAGES]
        .iter()
        .flat_map(|l| l.split_whitespace())
        .collect();
    for command in &commands {
        assert!(known.contains(command.as_str()), "{what}: \\{command}");
    }
    // Text after a percent sign would be lost.
    assert!(!rest.contains('%'), "{what}");
    let strange = rest.chars().find(|c| !c.is_ascii() && *c > '\u{17f}');
    assert_eq!(strange, None, "{what}");
    let mut depth = 0_i64;
    for c in rest.chars() {
        depth += match c {
            '{' => 1,
            '}' => -1,
            _ => 0,
        };
        assert!(depth >= 0, "{what}: a brace closes that none opens");
    }
    assert_eq!(depth, 0, "{what}: braces");
    for paragraph in rest.split("\n\n") {
        assert_eq!(paragraph.matches('$').count() % 2, 0, "{what}: {paragraph}");
    }
    assert_eq!(
        text.matches("\\left").count() - text.matches("\\leftarrow").count(),
        text.matches("\\right").count() - text.matches("\\rightarrow").count(),
        "{what}"
    );
    let mut open: Vec<&str> = Vec::new();
    for piece in text.split('\\') {
        if let Some(name) = piece.strip_prefix("begin{") {
            let name = name.split('}').next().unwrap_or_default();
            assert!(
                ENVIRONMENTS.split_whitespace().any(|e| e == name),
                "{what}: {name}"
            );
            open.push(name);
        } else if let Some(name) = piece.strip_prefix("end{") {
            assert_eq!(open.pop(), name.split('}').next(), "{what}");
        }
    }
    assert!(open.is_empty(), "{what}: {open:?}");
    let cited: BTreeSet<&str> = arguments(text, "\\cite").into_iter().collect();
    let listed: BTreeSet<&str> = arguments(text, "\\bibitem").into_iter().collect();
    assert_eq!(cited, listed, "{what}");
    let labels: Vec<&str> = arguments(text, "\\label");
    let unique: BTreeSet<&str> = labels.iter().copied().collect();
    assert_eq!(labels.len(), unique.len(), "{what}: labels");
    for reference in arguments(text, "\\eqref") {
        assert!(unique.contains(reference), "{what}: {reference}");
    }
}

/// Long, since every shipped model is derived.
#[test]
fn every_shipped_model_is_a_document_that_compiles_by_itself() {
    let done = clebsch("list --json");
    let json = done.json();
    let models = json["models"].as_array().expect("a list");
    for model in models {
        let name = model["model"].as_str().expect("a name");
        let done = runs(&format!("derive {name} --standalone"));
        compiles(name, &done.out);
    }
    let top = clebsch("derive heavy-top --standalone --explain");
    compiles("heavy-top with its proof", &top.out);
    top.prints([
        "\\bibitem{dixon2007} M. F. Dixon, \\emph{Geometric integrators for continuum dynamics}",
        "\\bibitem{holm1998} D. D. Holm, J. E. Marsden and T. S. Ratiu",
        "the diamond of Holm, Marsden and Ratiu~\\cite{holm1998}, for whom",
        "Proof.~Each~step",
    ]);
    let free = clebsch("derive free-body --standalone --no-thesis");
    compiles("free-body without the thesis", &free.out);
    free.never_prints("dixon2007");
}

#[test]
fn only_models_of_the_gallery_cite_whatever_the_structure_of_a_file() {
    let folder = Folder::new("cited");
    let text = clebsch_models::find("heavy-top")
        .expect("a model")
        .card
        .source;
    folder.write("own.clebsch", text);
    for format in ["text", "latex", "markdown", "json"] {
        let own = folder.runs(&format!("derive @own.clebsch --format {format}"));
        let bare = clebsch(&format!("derive heavy-top --no-thesis --format {format}"));
        assert_eq!(own.out, bare.out);
        let cites = |out: &str| ["thesis", "dixon2007", "section 2.7.1"].map(|w| out.contains(w));
        assert_eq!(cites(&own.out), [false; 3], "{}", own.out);
        let gallery = clebsch(&format!("derive heavy-top --format {format}"));
        assert!(cites(&gallery.out).contains(&true), "{}", gallery.out);
    }
}

#[test]
fn names_of_all_kinds_compile() {
    let folder = Folder::new("standalone");
    let model = "model Sätze_1 {
    /// mass, 100 % of it & more
    param m: Real as r\"\\mathbb{M}_{\\bm x}\";
    param c_0: Real;
    field phi, theta_dot: Real;
    field x: Vec<3>;
    let r = sqrt(dot(x, x));
    lagrangian = m*(next(phi) - phi)^2/(2*h) + (next(theta_dot) - theta_dot)^2/(2*h)
        + m*dot(next(x) - x, next(x) - x)/(2*h) - h*c_0*phi^2*theta_dot/r^3;
}";
    let file = folder.write("own.clebsch", model);
    for more in [&[][..], &["--explain"], &["--format", "latex"]] {
        let done = runs(&[&["derive", &file, "--standalone"], more].concat());
        compiles("a model of one's own", &done.out);
    }
    folder
        .clebsch("derive @own.clebsch --standalone --format markdown")
        .refuses("`--standalone` prints LaTeX, not markdown; remove `--format`");
}
