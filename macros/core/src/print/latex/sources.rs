//! Citations in printed derivations: works named in sentences, and the work that a document cites as its source.

use crate::print::document::Work;

/// Works named in sentences, and the year after the name that the citation replaces.
static NAMED: [(Work, &str); 2] = [
    (
        Work {
            key: "holm1998",
            named: "Holm, Marsden and Ratiu",
            entry: "@article{holm1998, author = {Holm, D. D. and Marsden, J. E. and Ratiu, T. S.}, title = {The \
                    {Euler--Poincar\\'e} equations and semidirect products with applications to continuum theories}, \
                    journal = {Advances in Mathematics}, volume = {137}, pages = {1--81}, year = {1998}}",
            item: "D. D. Holm, J. E. Marsden and T. S. Ratiu, The Euler--Poincar\\'e equations and semidirect products with \
                   applications to continuum theories, \\emph{Advances in Mathematics} \\textbf{137} (1998), 1--81.",
        },
        " (1998)",
    ),
    (
        Work {
            key: "moser1991",
            named: "Moser and Veselov",
            entry: "@article{moser1991, author = {Moser, J. and Veselov, A. P.}, title = {Discrete versions of some classical \
                    integrable systems and factorization of matrix polynomials}, journal = {Communications in Mathematical \
                    Physics}, volume = {139}, pages = {217--243}, year = {1991}}",
            item: "J. Moser and A. P. Veselov, Discrete versions of some classical integrable systems and factorization of \
                   matrix polynomials, \\emph{Communications in Mathematical Physics} \\textbf{139} (1991), 217--243.",
        },
        "",
    ),
];

/// Adds citations after the works named in LaTeX text.
pub(super) fn citing(words: &str) -> String {
    let cite = |words: String, (work, year): &(Work, &str)| {
        let cited = format!("{}~\\cite{{{}}}", work.named, work.key);
        words.replace(&format!("{}{year}", work.named), &cited)
    };
    NAMED.iter().fold(words.to_owned(), cite)
}

/// The works that a LaTeX text cites, with the document's source first.
fn cited<'a>(text: &str, work: Option<&'a Work>) -> impl Iterator<Item = &'a Work> {
    let cites = |w: &&Work| {
        let key = format!("{{{}}}", w.key);
        text.split("\\cite").skip(1).any(|rest| {
            let place = rest.split('{').next().map_or(0, str::len);
            rest.get(place..).is_some_and(|at| at.starts_with(&key))
        })
    };
    let named = NAMED.iter().map(|(work, _)| work);
    work.into_iter().chain(named).filter(cites)
}

/// The head of a section: comments on what the enclosing document must provide.
pub(super) fn needs(section: &str, work: Option<&Work>) -> String {
    let entries: Vec<&str> = cited(section, work).map(|w| w.entry).collect();
    match entries.is_empty() {
        true => "% Needs \\usepackage{amsmath}.\n".to_owned(),
        false => {
            let entries = entries.iter().map(|entry| format!("% {entry}\n"));
            let entries: String = entries.collect();
            format!("% Needs \\usepackage{{amsmath}}, and in the bibliography\n{entries}")
        }
    }
}

/// Turns a section into a document that compiles on its own, with a bibliography. The sources of its equations are in
/// `work`.
pub fn standalone(section: &str, work: Option<&Work>) -> String {
    let lines = section.lines().skip_while(|line| line.starts_with('%'));
    let body: Vec<&str> = lines.collect();
    let body = body.join("\n");
    let items: Vec<String> = cited(&body, work)
        .map(|w| format!("\\bibitem{{{}}} {}\n", w.key, w.item))
        .collect();
    let bibliography = match items.is_empty() {
        true => String::new(),
        false => format!(
            "\n\\begin{{thebibliography}}{{9}}\n{}\\end{{thebibliography}}\n",
            items.concat()
        ),
    };
    format!(
        "{HEAD}\\begin{{document}}\n\n{}\n{bibliography}\n\\end{{document}}\n",
        body.trim()
    )
}

/// Class and packages of a standalone document; the last two packages provide letters that a model may be typeset
/// with.
const HEAD: &str = "\\documentclass{article}\n\\usepackage[T1]{fontenc}\n\\usepackage[utf8]{inputenc}\n\\usepackage{amsmath}\n\
                    \\usepackage{amssymb}\n\\usepackage{bm}\n";
