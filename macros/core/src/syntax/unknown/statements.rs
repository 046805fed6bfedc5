//! Words that do not begin a statement.

use super::super::ast::Name;
use super::super::token::{Cursor, KEYWORDS, Token};
use super::names::STEPS;
use crate::diagnostic::{Diagnostic, closest};

/// The advice for uniform damping.
const DAMPING: &str = "damping of all momenta at one rate γ can be stated: declare a clock, `advected t: Real; constraint next(t) = t + h;`, \
    and multiply kinetic terms by `exp(γ*(t + next(t))/2)` and potentials by `exp(γ*t)`";

/// The advice for a force with a potential.
const POTENTIAL: &str = "a force with a potential V is the term `-h*V` of the Lagrangian; a constant force F along a number x is `h*F*x`";

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
            "`{word}` cannot be stated: forces without a potential, friction among them, are not supported yet"
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
            "a configuration is declared by `field q: Real;` or `field x: Vec<3>;`, the attitude of a body by `group Λ: SO<3> velocity Ω;`"
        }
        "body" | "rigid" | "rotation" => {
            "a body with a fixed point is declared by `group Λ: SO<3> velocity Ω;`, a free one by `group G: SE<3> velocity V;`, each with \
             its constraint `next(Λ) = Λ*Ω`"
        }
        "const" | "constant" | "parameter" | "parameters" | "params" | "real" | "float"
        | "double" | "int" => {
            "a parameter is declared by `param m: Real;`, its value stands in the case; `let m = 2;` names a number"
        }
        "lambda" | "define" | "val" | "auto" | "where" | "with" => {
            "an expression is given a name by `let`, as in `let d = next(x) - x;`"
        }
        "import" | "from" | "use" | "include" | "using" => {
            "functions need no import: write `sin(q)`, `sqrt(x)`, `dot(a, b)`"
        }
        "def" | "fn" | "function" | "func" => {
            "a function of the position is stated by `given V(Real): Real = \"k*x^2/2\";`, an abbreviation by `let V = k*q^2/2;`"
        }
        "for" | "while" | "loop" => {
            "there are no loops: quantities `at nodes` of a label `label i in 0..N;` are summed over its sites"
        }
        "if" | "else" | "match" | "switch" => {
            "there are no cases: `abs(x)` and `sign(x)` are functions, and `(x + abs(x))/2` is x where x > 0 and 0 elsewhere"
        }
        "initial" | "init" | "start" | "steps" | "solve" | "run" | "simulate" | "plot"
        | "output" | "bounds" => {
            "the model states the equations only. Numbers and initial values stand in the case file: `clebsch case FILE` prints one"
        }
        "constraints" => "write `hold λ: dot(x, x) = L^2;` for a constraint on configurations",
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
            format!("an expression is given a name by `let {word} = ...;`")
        }
        Some(Token::Punct(':' | ',', _)) => format!(
            "say what it is: `param {word}: ...;` does not move, `field {word}: ...;` moves in a vector space, `group {word}: ... velocity ...;` in a Lie group"
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
        return Some("the step size stands in the case file, as `h = 0.01`".to_owned());
    }
    if let Some(n) = number {
        return Some(format!(
            "declare a parameter, `param {word}: Real;`, whose value stands in the case, or name the number, `let {word} = {n};`"
        ));
    }
    match word {
        "L" | "l" | "ℓ" | "Lagrangian" | "lagrange" => Some(
            "the discrete Lagrangian of a step is stated by `lagrangian = ...;`, (kinetic - potential) times the step"
                .to_owned(),
        ),
        "T" | "Id" | "E1" | "E2" | "E3" => Some(format!(
            "an expression is given a name by `let`; `{word}` has a meaning of its own, so choose another name, for example `let K = ...;`"
        )),
        _ if word == "H" || word.eq_ignore_ascii_case("hamiltonian") => Some(
            "a model is stated by the discrete Lagrangian of a step, `lagrangian = ...;`".to_owned(),
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
            error.help("remarks begin with `//`, documentation with `///`")
        }
        _ => error.help(STARTS),
    }
}
