//! Words that do not begin a statement.

use super::super::ast::Name;
use super::super::token::{Cursor, KEYWORDS, Token};
use super::names::STEPS;
use crate::diagnostic::{Diagnostic, closest};

/// The advice for uniform damping.
/// The advice for a force with a potential.
const DAMPING: &str = "to damp all momenta at one rate γ, declare a clock, `advected t: Real; constraint next(t) = t + h;`, \
    and multiply kinetic terms by `exp(γ*(t + next(t))/2)` and potentials by `exp(γ*t)`";

const POTENTIAL: &str = "for a force with a potential V, add the term `-h*V` to the Lagrangian; for a constant force F along a \
    number x, add `h*F*x`";

/// Names of forces that may have a potential.
const FORCES: [&str; 8] = [
    "force",
    "forces",
    "external_force",
    "external",
    "torque",
    "control",
    "input",
    "actuator",
];

/// Names of dissipative forces.
const FRICTION: [&str; 9] = [
    "friction",
    "dissipation",
    "dissipative",
    "damping",
    "damper",
    "drag",
    "viscosity",
    "rayleigh",
    "Rayleigh",
];

/// Whether a name probably means a force.
pub(crate) fn is_force(name: &str) -> bool {
    FORCES.contains(&name) || FRICTION.contains(&name)
}

/// The error for a statement that begins with this word, with the statement that was probably meant. The cursor is
/// after the word.
pub(in crate::syntax) fn statement(c: &Cursor, keyword: &Name) -> Diagnostic {
    let word = keyword.text.as_str();
    let force = FORCES.contains(&word);
    if is_force(word) {
        let message = format!(
            "`{word}` is not a statement: forces without a potential, such as friction, are not supported yet"
        );
        let d = Diagnostic::new(keyword.place, message);
        return if force { d.help(POTENTIAL) } else { d }.help(DAMPING);
    }
    let message = format!("`{word}` does not start a statement");
    Diagnostic::new(keyword.place, message).help(meant(c, word))
}

/// The statement to write instead of a declaration of another language.
fn declaration(word: &str) -> Option<&'static str> {
    Some(match word {
        "var" | "variable" | "variables" | "state" | "coordinate" | "coordinates" | "coord"
        | "coords" | "dof" | "config" | "configuration" | "unknown" | "particle" | "mass" => {
            "declare a configuration as `field q: Real;` or `field x: Vec<3>;`, the attitude of a body as `group Λ: SO<3> \
             velocity Ω;`"
        }
        "body" | "rigid" | "rotation" => {
            "declare a body with a fixed point as `group Λ: SO<3> velocity Ω;`, a free body as `group G: SE<3> velocity V;`, \
             each with its constraint, `constraint next(Λ) = Λ*Ω;`"
        }
        "const" | "constant" | "parameter" | "parameters" | "params" | "real" | "float"
        | "double" | "int" => {
            "declare a parameter as `param m: Real;`, and give its value in the case; to name a number, write `let m = 2;`"
        }
        "lambda" | "define" | "val" | "auto" | "where" | "with" => {
            "to name an expression, write `let`, as in `let d = next(x) - x;`"
        }
        "import" | "from" | "use" | "include" | "using" => {
            "functions need no import: write `sin(q)`, `sqrt(x)`, `dot(a, b)`"
        }
        "def" | "fn" | "function" | "func" => {
            "declare a function of the position as `given V(Real): Real = \"k*x^2/2\";`, an abbreviation as `let V = k*q^2/2;`"
        }
        "for" | "while" | "loop" => {
            "the language has no loops: quantities `at nodes` of a label `label i in 0..N;` are summed over its sites"
        }
        "if" | "else" | "match" | "switch" => {
            "the language has no conditionals: use `abs(x)` and `sign(x)`; `(x + abs(x))/2` is x where x > 0 and 0 elsewhere"
        }
        "initial" | "init" | "start" | "steps" | "solve" | "run" | "simulate" | "plot"
        | "output" | "bounds" => {
            "a model states the equations only. Put numbers and initial values into a case file; `clebsch case FILE` prints one"
        }
        "constraints" => "to constrain configurations, write `hold λ: dot(x, x) = L^2;`",
        _ => return None,
    })
}

/// The advice for other probable meanings of the word.
fn meant(c: &Cursor, word: &str) -> String {
    let assigned = matches!(c.peek(), Some(Token::Punct('=', _)));
    if assigned && let Some(said) = assignment(c, word) {
        return said;
    }
    if let Some(said) = declaration(word) {
        return said.to_owned();
    }
    if let Some(near) = closest(word, KEYWORDS) {
        return format!("did you mean `{near}`?");
    }
    match c.peek() {
        Some(Token::Punct('=', _)) => {
            format!("to name an expression, write `let {word} = ...;`")
        }
        Some(Token::Punct(':' | ',', _)) => format!(
            "say what it is: `param {word}: ...;` for a constant, `field {word}: ...;` for a configuration in a vector space, \
             `group {word}: ... velocity ...;` for one in a Lie group"
        ),
        _ => STARTS.to_owned(),
    }
}

/// The probable meaning of `word = ...`, if it is not a definition.
fn assignment(c: &Cursor, word: &str) -> Option<String> {
    let number = match (c.peek_at(1), c.peek_at(2)) {
        (Some(Token::Number(n)), Some(Token::Punct(';', _))) => Some(n.as_str()),
        _ => None,
    };
    if number.is_some() && STEPS.contains(&word) {
        return Some("give the step size in the case file, as `h = 0.01`".to_owned());
    }
    if let Some(n) = number {
        return Some(format!(
            "declare a parameter, `param {word}: Real;`, and give its value in the case; or name the number, `let {word} = \
             {n};`"
        ));
    }
    match word {
        "L" | "l" | "ℓ" | "Lagrangian" | "lagrange" => Some(
            "write `lagrangian = ...;`: the discrete Lagrangian of a step is (kinetic - potential) times the step"
                .to_owned(),
        ),
        "T" | "Id" | "E1" | "E2" | "E3" => Some(format!(
            "`{word}` has a fixed meaning; to name an expression, choose another name, for example `let K = ...;`"
        )),
        _ if word == "H" || word.eq_ignore_ascii_case("hamiltonian") => Some(
            "state the discrete Lagrangian of a step, `lagrangian = ...;`".to_owned(),
        ),
        _ => None,
    }
}

/// The words that start statements.
const STARTS: &str = "statements start with dim, time, label, periodic, end, grid, param, assume, group, field, advected, constraint, hold, given, mesh, let, scale, node or lagrangian";

/// The advice if a statement should start but no word follows.
pub(in crate::syntax) fn no_start(c: &Cursor, error: Diagnostic) -> Diagnostic {
    match c.peek() {
        Some(Token::Punct('%' | '/' | '*', _)) => {
            error.help("write a comment after `//`, documentation after `///`")
        }
        _ => error.help(STARTS),
    }
}
