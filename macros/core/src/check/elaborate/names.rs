//! Elaborates names: declared or bound names, `Id`, and unit vectors of the size that the context requires. For an
//! unknown name, the error suggests its probable meaning.

use super::{Elaborated, Elaborator, UNITS, fail};
use crate::check::messages::shape_text;
use crate::diagnostic::{Diagnostic, Place, closest};
use crate::expr;
use crate::expr::shape::{Dim, Shape};
use crate::expr::spelling::skeleton;
use crate::expr::symbol::{Role, Symbols};
use crate::syntax::{FUNCTIONS, unknown};

/// The quantity whose value at the next node a name probably means: `q_next`, `q_new`, `next_q`.
fn next_of<'n>(name: &'n str, symbols: &Symbols) -> Option<&'n str> {
    let stems = [
        name.strip_suffix("_next"),
        name.strip_suffix("_new"),
        name.strip_suffix("next"),
        name.strip_prefix("next_"),
    ];
    let moves = |stem: &&str| {
        let role = symbols.find(stem).map(|id| symbols.get(id).role);
        matches!(role, Some(Role::Element | Role::Advected))
    };
    stems.into_iter().flatten().find(moves)
}

/// The scalar at an end of the step that a name probably means, `q0` or `q_1`, and whether it is at the end of the
/// step.
fn end_of<'n>(name: &'n str, symbols: &Symbols) -> Option<(&'n str, bool)> {
    let end = name.ends_with('1');
    let stem = name.strip_suffix(['0', '1'])?;
    let stem = stem.strip_suffix('_').unwrap_or(stem);
    let symbol = symbols.get(symbols.find(stem)?);
    let moves = matches!(symbol.role, Role::Element | Role::Advected);
    (moves && symbol.shape.is_scalar()).then_some((stem, end))
}

/// The component that a name probably means: `x_3`, `x3`, `x_z`.
fn component_of(name: &str, symbols: &Symbols) -> Option<String> {
    let (at, last) = name.char_indices().next_back()?;
    let stem = name.get(..at)?;
    let stem = stem.strip_suffix('_').unwrap_or(stem);
    let vector = symbols.get(symbols.find(stem)?).shape;
    let number = match last {
        'x' => 1,
        'y' => 2,
        'z' => 3,
        digit => digit.to_digit(10)?,
    };
    (vector.is_vector() && number > 0).then(|| format!("{stem}[{number}]"))
}

/// The quantity whose rate a name probably means: `dX`, `X_dot`, `Xdot`.
fn rate_of<'n>(name: &'n str, symbols: &Symbols) -> Option<&'n str> {
    let moves = |stem: &str| {
        let role = symbols.find(stem).map(|id| symbols.get(id).role);
        matches!(role, Some(Role::Element | Role::Advected))
    };
    let stems = [
        name.strip_prefix('d'),
        name.strip_suffix("_dot"),
        name.strip_suffix("dot"),
        name.strip_suffix(DOT),
        DOTTED
            .iter()
            .find(|(dotted, _)| *dotted == name)
            .map(|(_, plain)| *plain),
    ];
    stems.into_iter().flatten().find(|stem| moves(stem))
}

/// The combining dot above the preceding letter.
const DOT: char = '\u{307}';

/// Letters with a dot above them.
const DOTTED: [(&str, &str); 6] = [
    ("ẋ", "x"),
    ("ẏ", "y"),
    ("ż", "z"),
    ("ṙ", "r"),
    ("ṡ", "s"),
    ("ẇ", "w"),
];

impl Elaborator<'_> {
    /// The unit vector along an axis, if the axis exists for every allowed size.
    fn unit(&self, size: Dim, axis: usize, place: Place) -> Elaborated {
        let symbols = &self.names.symbols;
        let (least, _) = symbols.sizes(size);
        if let Some(axis) = u8::try_from(axis).ok().filter(|a| usize::from(*a) < least) {
            return Ok(expr::unit(size, axis));
        }
        let bound = match size {
            Dim::Fixed(n) => format!("in {n} dimensions"),
            Dim::Named(_) => format!(
                "for the smallest `{}`, which is {least}",
                symbols.dim_text(size)
            ),
        };
        let there = match least {
            0 | 1 => "`E1` alone".to_owned(),
            2 => "`E1` and `E2`".to_owned(),
            n => format!("`E1` to `E{n}`"),
        };
        let message = format!(
            "`{}` does not exist {bound}",
            UNITS.get(axis).unwrap_or(&"En")
        );
        fail(Diagnostic::new(place, message).help(format!("the unit vectors here are {there}")))
    }

    pub(super) fn name(&self, n: &str, place: Place, expected: Option<Shape>) -> Elaborated {
        if let Some((_, value)) = self.bindings.iter().find(|(b, _)| b == n) {
            return Ok(value.clone());
        }
        if let Some(id) = self.names.symbols.find(n) {
            let own = expr::here(&self.names.symbols, id);
            return Ok(self.names.entries(id).matrix(&self.names.symbols, own));
        }
        if n == "Id" {
            let size = match expected {
                Some(s) if s.is_square() && !s.is_scalar() => s.rows,
                Some(s) if !s.is_square() => {
                    let what = shape_text(&self.names.symbols, s);
                    let message = format!("`Id` is square, but {what} is needed here");
                    return fail(Diagnostic::new(place, message));
                }
                _ => self.default_size(),
            };
            return Ok(expr::identity(size));
        }
        if let Some(axis) = UNITS.iter().position(|u| *u == n) {
            let size = match expected {
                // The size is taken from the required column, or from the required product.
                Some(s) if s.rows != Dim::Fixed(1) => s.rows,
                _ => self.default_size(),
            };
            return self.unit(size, axis, place);
        }
        let declared: Vec<&String> = self
            .names
            .symbols
            .ids()
            .map(|id| &self.names.symbols.get(id).name)
            .collect();
        let bound = self.bindings.iter().map(|(b, _)| b);
        let alike = {
            let mut known = declared.iter().copied().chain(bound.clone());
            known.find(|other| skeleton(other) == skeleton(n)).cloned()
        };
        let h = &self.names.symbols.get(self.names.step).name;
        let mut fields = self
            .names
            .configurations
            .iter()
            .filter(|c| c.group.is_additive());
        let field = fields.next().filter(|_| unknown::VELOCITIES.contains(&n));
        let velocity = field.map(|c| &self.names.symbols.get(c.element).name);
        let mut d = Diagnostic::new(place, format!("`{n}` is not declared"));
        if self.names.was_declared(n) || self.unbound.contains(&(n.to_owned(), true)) {
            d = Diagnostic::following(place, format!("the declaration of `{n}` has an error"));
        } else if let Some(other) = alike {
            d = d.help(format!(
                "`{other}` is declared; it looks the same, but has different characters: copy the name from its declaration"
            ));
        } else if n == "T" {
            d = d.help("`T` means the transpose, as in `A^T`; give a kinetic energy another name, for example `K`");
        } else if self.unbound.contains(&(n.to_owned(), false)) {
            d = Diagnostic::new(place, format!("`{n}` is used before its `let`"))
                .help(format!("move `let {n} = ...;` up, before its first use"));
        } else if let Some(moving) = rate_of(n, &self.names.symbols) {
            d = d.help(format!(
                "write a rate of change as a difference over the step: `(next({moving}) - {moving})/{h}`"
            ));
        } else if let Some(moving) = next_of(n, &self.names.symbols) {
            d = d.help(format!(
                "write the value at the next node as `next({moving})`"
            ));
        } else if let Some((moving, end)) = end_of(n, &self.names.symbols) {
            d = d.help(match end {
                true => format!("write the value at the end of the step as `next({moving})`"),
                false => format!("write the value at the start of the step as `{moving}`"),
            });
        } else if let Some(component) = component_of(n, &self.names.symbols) {
            d = d.help(format!("write a component as `{component}`"));
        } else if n == "sum" {
            d = unknown::how_to_sum(Diagnostic::new(
                place,
                "`sum` needs its summand in parentheses",
            ));
        } else if FUNCTIONS.contains(&n) {
            d = Diagnostic::new(place, format!("`{n}` is a function of the language"))
                .help(format!("write `{n}(...)`"));
        } else if unknown::STEPS.contains(&n) {
            d = d.help(format!(
                "the time step is named `{h}` here; to name it `{n}`, write `time k step {n};` at the top"
            ));
        } else if unknown::TIMES.contains(&n) {
            // The files of a run already have a column `time`.
            let clock = if n == "time" { "clock" } else { n };
            d = Diagnostic::new(
                place,
                format!("the Lagrangian cannot depend on the time `{n}` unless you declare a clock"),
            )
            .help(format!(
                "declare a clock, `advected {clock}: Real; constraint next({clock}) = {clock} + {h};`, and write `{clock}`; \
                 the case gives its initial value"
            ));
        } else if let Some(near) = closest(n, declared.into_iter().chain(bound).map(String::as_str))
        {
            d = d.help(format!("did you mean `{near}`?"));
        } else if unknown::ANGLES.contains(&n) {
            d = d.help(unknown::RADIANS);
        } else if let Some(written) = unknown::name(n) {
            d = d.help(format!("write `{written}`"));
        } else if let Some(moving) = velocity {
            d = d.help(format!(
                "write a velocity as a difference over the step: `let {n} = (next({moving}) - {moving})/{h};`"
            ));
        } else if let Some(near) = closest(n, FUNCTIONS) {
            d = d.help(format!("did you mean the function `{near}`?"));
        } else if n == self.names.time_index {
            d = d.help(format!(
                "`{n}` is the time index; write `next(x)` for `x` at the next node"
            ));
        } else if n.strip_prefix('E').is_some_and(|i| i.parse::<u8>().is_ok()) {
            d = d.help(format!(
                "the named unit vectors are `E1` to `E{}`, up to the size of the vector; write components as `v[2]` and `A[1, \
                 2]`",
                UNITS.len()
            ));
        } else {
            d = d.help(format!(
                "declare it, for example `param {n}: Real;`, or name an expression, `let {n} = ...;`"
            ));
        }
        fail(d)
    }
}
