//! Breaks the text of a model into lines that fit on a page. A statement continues at its terms, indented as one
//! would type it.

/// Spaces of indentation of a continued statement, and again for each open bracket.
const INDENT: usize = 4;

/// The cost of each further bracket level, as unused width in percent of a line. It favours a short line over a
/// broken term.
const DEPTH_COST: usize = 60;

/// The additional cost of a break after `=` or before a factor, within a term.
const INSIDE_COST: usize = 90;

/// The start of a comment.
const REMARK: &str = "//";

/// Breaks a text into lines no wider than `limit` where possible; `measure` gives the width of a character.
pub(super) fn fitted(code: &str, limit: usize, measure: &dyn Fn(char) -> usize) -> Vec<String> {
    code.lines()
        .flat_map(|line| match line.trim_start().starts_with(REMARK) {
            true => vec![line.to_owned()],
            false => statement(line, limit, measure),
        })
        .collect()
}

/// Breaks one line into several.
fn statement(line: &str, limit: usize, measure: &dyn Fn(char) -> usize) -> Vec<String> {
    let own = line.chars().take_while(|c| *c == ' ').count();
    let (mut rest, mut indent) = (line.trim_start().to_owned(), own);
    // Brackets that are still open from the previous lines.
    let mut open = 0;
    let mut braces = 0;
    let mut out = Vec::new();
    loop {
        let width: usize = rest.chars().map(measure).sum();
        let room = limit.saturating_sub(indent * measure(' '));
        let found = (width > room).then(|| cheapest(&rest, open, room, limit, measure));
        let Some(Some(cut)) = found else {
            out.push(" ".repeat(indent) + &rest);
            return out;
        };
        let tail = rest.split_off(cut.at).trim_start().to_owned();
        out.push(" ".repeat(indent) + rest.trim_end());
        let begins = ends_statement(&rest);
        braces = (braces + rest.matches('{').count()).saturating_sub(rest.matches('}').count());
        (rest, open) = (tail, cut.depth);
        indent = match begins {
            true => own + INDENT * braces,
            false => own + INDENT * (1 + braces + cut.depth),
        };
    }
}

/// A possible break.
struct LineBreak {
    /// The byte offset before which the line breaks.
    at: usize,
    /// The number of open brackets there.
    depth: usize,
}

/// The cheapest break that fits, otherwise the first one beyond the limit.
fn cheapest(
    rest: &str,
    open: usize,
    room: usize,
    limit: usize,
    measure: &dyn Fn(char) -> usize,
) -> Option<LineBreak> {
    let mut depth = open;
    let mut used = 0;
    let mut quoted = false;
    let mut best: Option<(usize, LineBreak)> = None;
    for (at, c) in rest.char_indices() {
        let (before, after) = rest.split_at(at);
        let inside = match quoted {
            true => None,
            false => place(before, after),
        };
        if let Some(inside) = inside.filter(|_| at > 0) {
            let empty = match used <= room {
                true => room - used,
                false => 100 * limit + used,
            };
            let percent = DEPTH_COST * depth + if inside { INSIDE_COST } else { 0 };
            let cost = empty + percent * limit / 100;
            if best.as_ref().is_none_or(|(least, _)| cost <= *least) {
                best = Some((cost, LineBreak { at, depth }));
            }
        }
        used += measure(c);
        match c {
            '"' => quoted = !quoted,
            '(' | '[' if !quoted => depth += 1,
            ')' | ']' if !quoted => depth = depth.saturating_sub(1),
            _ => {}
        }
    }
    best.map(|(_, cut)| cut)
}

/// Whether a line may break between these texts: `Some(false)` at the end of a statement, term or argument,
/// `Some(true)` within one, `None` if it may not.
fn place(before: &str, after: &str) -> Option<bool> {
    let sign = |s: &str| after.starts_with(s);
    let term = before.ends_with(' ') && (sign("+ ") || sign("- "));
    let ends = |s: &str| before.ends_with(s);
    let statement = before.ends_with(' ') && ends_statement(before);
    match () {
        () if term || statement || ends(", ") => Some(false),
        () if ends("= ") || sign("*") => Some(true),
        () => None,
    }
}

/// Whether the next statement begins after this text.
fn ends_statement(before: &str) -> bool {
    before.trim_end().ends_with([';', '{'])
}

#[cfg(test)]
mod tests {
    use super::fitted;

    fn lines(code: &str, limit: usize) -> Vec<String> {
        fitted(code, limit, &|_| 1)
    }

    #[test]
    fn a_statement_goes_on_at_its_terms() {
        let code = "model M {\n    lagrangian = -tr(J*A)/h - h*dot(gU, C) + (a - b)*c;\n}";
        let broken = [
            "model M {",
            "    lagrangian = -tr(J*A)/h",
            "        - h*dot(gU, C) + (a - b)*c;",
            "}",
        ];
        assert_eq!(lines(code, 40), broken);
        assert_eq!(lines(code, 80), code.lines().collect::<Vec<_>>());
    }

    #[test]
    fn where_no_term_ends_it_goes_on_inside() {
        let code = "    hold p: dot(Q - P, hat(w)*(Q + P)) = long;";
        assert_eq!(
            lines(code, 36),
            [
                "    hold p: dot(Q - P,",
                "            hat(w)*(Q + P)) = long;"
            ]
        );
        assert_eq!(lines("a = b*c*d*e", 8), ["a = b*c", "    *d*e"]);
    }

    #[test]
    fn statements_on_one_line_are_parted() {
        let code = "model M { label i in 0..N; param m: Real at i; }";
        assert_eq!(
            lines(code, 30),
            ["model M { label i in 0..N;", "    param m: Real at i; }"]
        );
    }

    #[test]
    fn names_in_quotes_and_remarks_stay_whole() {
        let quoted = "param gU: Vec<3> as \"m g, chi + x\";";
        assert_eq!(lines(quoted, 10), [quoted]);
        assert_eq!(lines("// a, b, c, d, e", 6), ["// a, b, c, d, e"]);
    }
}
