//! Parses the typesetting of a declared name: `as "m g \chi"` after its shape. The LaTeX must be valid in any
//! formula; commands that would affect the rest of a document are rejected.

use super::ast::Name;
use super::token::{Cursor, Token};
use crate::diagnostic::{Diagnostic, closest};
use crate::expr::symbol::{GREEK, greek_command};

/// `as "m g \chi"`, with one text for each of the names.
pub(super) fn typeset(c: &mut Cursor, names: &mut [Name]) -> Result<(), Diagnostic> {
    if !c.take_word("as") {
        return Ok(());
    }
    for (i, name) in names.iter_mut().enumerate() {
        if i > 0 && !c.take_punct(',') {
            return Err(c
                .unexpected(&format!("`,` and the LaTeX of `{}`", name.text))
                .help(
                    "write one text for each name: `param a, b: Real as \"\\alpha\", \"\\beta\";`",
                ));
        }
        let Some(Token::Literal(literal)) = c.peek() else {
            return Err(c
                .unexpected("a symbol of LaTeX in quotes")
                .help("write for example `param gU: Vec<3> as \"m g \\chi\";`, in Rust `as r\"m g \\chi\"`"));
        };
        match latex(literal) {
            Ok(text) => name.typeset = Some((text, c.place())),
            Err(why) => {
                let d = Diagnostic::new(c.place(), format!("this is not a symbol in LaTeX: {why}"));
                return Err(d.help(
                    "write what you would put between two dollar signs, such as `m g \\chi` or \
                    `J_{\\mathrm{eff}}`",
                ));
            }
        }
        c.advance();
    }
    Ok(())
}

/// The maximum length of a typeset name, in characters.
const LONGEST_NAME: usize = 120;

/// The LaTeX in a string literal. A single or doubled backslash is one backslash; raw strings are unchanged.
fn latex(literal: &str) -> Result<String, String> {
    let raw = literal.starts_with('r');
    let inside = literal
        .trim_start_matches('r')
        .trim_matches('#')
        .strip_prefix('"')
        .and_then(|s| s.strip_suffix('"'))
        .ok_or("it must be in double quotes")?;
    let inside = inside.replace(super::text::BACKSLASH, "\\");
    let text = match raw {
        true => inside,
        false => inside.replace("\\\\", "\\").replace("\\\"", "\""),
    };
    let text = text.trim().to_owned();
    if text.is_empty() || text.chars().count() > LONGEST_NAME {
        return Err(format!("it must have 1 to {LONGEST_NAME} characters"));
    }
    let mut rest = text.chars().peekable();
    row(&mut rest, 0)?;
    Ok(text)
}

type Rest<'a> = std::iter::Peekable<std::str::Chars<'a>>;

/// LaTeX commands for letters and signs, besides Greek letters.
const SIGNS: &str = "varepsilon varphi ell hbar partial nabla infty prime dagger ddagger ast star circ bullet \
    cdot cdots ldots dots times pm mp oplus otimes perp parallel top bot imath jmath aleph Re Im wp langle rangle \
    lvert rvert lVert rVert vert Vert mid wedge vee flat sharp natural diamond triangle square odot ominus \
    quad qquad epsilon phi max min";

/// Commands with one argument, such as accents and fonts.
const OVER: &str = "hat widehat bar overline underline tilde widetilde vec dot ddot check breve acute grave mathring \
    overrightarrow mathrm mathit mathnormal mathbf mathsf mathtt mathcal mathscr mathbb mathfrak boldsymbol bm text \
    textrm textit textbf textsf operatorname sqrt";

/// Fractions, which take two arguments.
const FRACTIONS: &str = "frac tfrac dfrac";

/// The maximum nesting of braces.
const DEEPEST: usize = 8;

/// Parses a row of pieces with scripts, up to its closing brace or the end. It accepts what may replace a letter in a
/// formula, and rejects commands that affect the rest of the document.
fn row(rest: &mut Rest, depth: usize) -> Result<(), String> {
    let unpaired = || "its braces do not match, or it is incomplete".to_owned();
    if depth > DEEPEST {
        return Err(format!("its braces are nested deeper than {DEEPEST}"));
    }
    let (mut below, mut above) = (false, false);
    while let Some(c) = rest.next() {
        match c {
            '}' if depth > 0 => return Ok(()),
            '}' => return Err(unpaired()),
            '_' | '^' => {
                let taken = if c == '_' { &mut below } else { &mut above };
                if std::mem::replace(taken, true) {
                    return Err(format!(
                        "one symbol has two scripts `{c}`: combine them, `x{c}{{1 2}}`"
                    ));
                }
                argument(rest, depth)?;
            }
            c if c.is_whitespace() && !c.is_control() => {}
            c => {
                (below, above) = (false, false);
                piece(c, rest, depth)?;
            }
        }
    }
    match depth {
        0 => Ok(()),
        _ => Err(unpaired()),
    }
}

/// The argument of a script or a command: a group in braces, or one piece.
fn argument(rest: &mut Rest, depth: usize) -> Result<(), String> {
    while rest.next_if(|c| c.is_whitespace()).is_some() {}
    match rest.next() {
        None | Some('}' | '_' | '^') => {
            Err("its braces do not match, or it is incomplete".to_owned())
        }
        Some(c) => piece(c, rest, depth),
    }
}

fn piece(c: char, rest: &mut Rest, depth: usize) -> Result<(), String> {
    match c {
        '{' => row(rest, depth + 1),
        '\\' => command(rest, depth),
        c if c.is_control() || "$%#&~\"".contains(c) => {
            Err(format!("it contains `{}`", c.escape_default()))
        }
        c if !c.is_ascii() => Err(match GREEK.iter().find(|(letter, _)| *letter == c) {
            Some((_, name)) => format!("it contains `{c}`; write `{}`", greek_command(name)),
            None => format!("it contains `{c}`, which LaTeX cannot print"),
        }),
        _ => Ok(()),
    }
}

fn command(rest: &mut Rest, depth: usize) -> Result<(), String> {
    let mut word = String::new();
    while let Some(c) = rest.next_if(char::is_ascii_alphabetic) {
        word.push(c);
    }
    if word.is_empty() {
        return match rest.next() {
            Some(',' | ';' | ':' | '!' | ' ') => Ok(()),
            Some(c) => Err(format!(
                "`\\{}` is neither a symbol nor a space",
                c.escape_default()
            )),
            None => Err("it is incomplete".to_owned()),
        };
    }
    let among = |list: &str| list.split_whitespace().any(|w| w == word);
    let greek = GREEK
        .iter()
        .any(|(_, name)| *name == word && !name.starts_with("straight"));
    let arguments = match (among(OVER), among(FRACTIONS)) {
        (true, _) => 1,
        (_, true) => 2,
        _ if greek || among(SIGNS) => 0,
        _ => {
            let known = [SIGNS, OVER, FRACTIONS]
                .into_iter()
                .flat_map(str::split_whitespace);
            let known = known.chain(GREEK.iter().map(|(_, name)| *name));
            let near = closest(&word, known).map(|near| format!(", did you mean `\\{near}`?"));
            return Err(format!(
                "`\\{word}` is not a symbol, an accent or a font that clebsch accepts{}",
                near.unwrap_or_default()
            ));
        }
    };
    (0..arguments).try_for_each(|_| argument(rest, depth))
}
