//! What printed derivations cite: the key of each source, how sentences name it, and its entries in bibliographies.

/// A source.
struct Source {
    /// As `\cite` calls it.
    key: &'static str,
    /// How sentences name it.
    named: &'static str,
    /// What of that the citation itself says, and takes the place of.
    year: &'static str,
    /// Its entry for BibTeX.
    entry: &'static str,
    /// The same in `thebibliography`.
    item: &'static str,
}

/// The thesis, as `\cite` calls it.
pub(super) const THESIS: &str = "dixon2007";

const SOURCES: [Source; 3] = [
    Source {
        key: THESIS,
        named: "",
        year: "",
        entry: "@phdthesis{dixon2007, author = {Dixon, M. F.}, title = {Geometric integrators for continuum dynamics}, \
                school = {Imperial College London}, year = {2007}}",
        item: "M. F. Dixon, \\emph{Geometric integrators for continuum dynamics}, PhD thesis, Imperial College London, 2007.",
    },
    Source {
        key: "holm1998",
        named: "Holm, Marsden and Ratiu",
        year: " (1998)",
        entry: "@article{holm1998, author = {Holm, D. D. and Marsden, J. E. and Ratiu, T. S.}, title = {The \
                {Euler--Poincar\\'e} equations and semidirect products with applications to continuum theories}, \
                journal = {Advances in Mathematics}, volume = {137}, pages = {1--81}, year = {1998}}",
        item: "D. D. Holm, J. E. Marsden and T. S. Ratiu, The Euler--Poincar\\'e equations and semidirect products with \
               applications to continuum theories, \\emph{Advances in Mathematics} \\textbf{137} (1998), 1--81.",
    },
    Source {
        key: "moser1991",
        named: "Moser and Veselov",
        year: "",
        entry: "@article{moser1991, author = {Moser, J. and Veselov, A. P.}, title = {Discrete versions of some classical \
                integrable systems and factorization of matrix polynomials}, journal = {Communications in Mathematical \
                Physics}, volume = {139}, pages = {217--243}, year = {1991}}",
        item: "J. Moser and A. P. Veselov, Discrete versions of some classical integrable systems and factorization of \
               matrix polynomials, \\emph{Communications in Mathematical Physics} \\textbf{139} (1991), 217--243.",
    },
];

/// Words in LaTeX with citations behind the sources that they name.
pub(super) fn citing(words: &str) -> String {
    let named = SOURCES.iter().filter(|s| !s.named.is_empty());
    named.fold(words.to_owned(), |words, s| {
        let cited = format!("{}~\\cite{{{}}}", s.named, s.key);
        words.replace(&format!("{}{}", s.named, s.year), &cited)
    })
}

/// The sources that a text in LaTeX cites.
fn cited(text: &str) -> impl Iterator<Item = &'static Source> {
    let cites = |s: &&Source| {
        let key = format!("{{{}}}", s.key);
        text.split("\\cite").skip(1).any(|rest| {
            let place = rest.split('{').next().map_or(0, str::len);
            rest.get(place..).is_some_and(|at| at.starts_with(&key))
        })
    };
    SOURCES.iter().filter(cites)
}

/// The head of a section: what it needs of the document that it becomes part of.
pub(super) fn needs(section: &str) -> String {
    let entries: Vec<&str> = cited(section).map(|s| s.entry).collect();
    match entries.is_empty() {
        true => "% Needs \\usepackage{amsmath}.\n".to_owned(),
        false => {
            let entries = entries.iter().map(|entry| format!("% {entry}\n"));
            let entries: String = entries.collect();
            format!("% Needs \\usepackage{{amsmath}}, and in the bibliography\n{entries}")
        }
    }
}

/// A section as a document that compiles by itself, with its bibliography.
pub fn standalone(section: &str) -> String {
    let lines = section.lines().skip_while(|line| line.starts_with('%'));
    let body: Vec<&str> = lines.collect();
    let body = body.join("\n");
    let items: Vec<String> = cited(&body)
        .map(|s| format!("\\bibitem{{{}}} {}\n", s.key, s.item))
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

/// The class and the packages of a document by itself; the last two hold letters that a model may be typeset with.
const HEAD: &str = "\\documentclass{article}\n\\usepackage[T1]{fontenc}\n\\usepackage[utf8]{inputenc}\n\\usepackage{amsmath}\n\
                    \\usepackage{amssymb}\n\\usepackage{bm}\n";
