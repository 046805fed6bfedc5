//! Constraint-preserving variations at node k: the configuration moves by a free element of its Lie algebra, the two
//! adjacent velocities absorb the motion, and every advected quantity follows. A quantity can follow exactly if a
//! group action of the right side advects it.

use super::Letters;
use super::lie;
use crate::algebra::{Algebra, Factor, Poly, Rational, Source};
use crate::check::spec::{Advected, Configuration, Group, Spec};
use crate::diagnostic::{Diagnostic, Errors};
use crate::expr::shape::{Dim, Shape};
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Shift};

/// The changes of all quantities if one configuration varies at node k.
#[derive(Clone, Debug)]
pub struct Variation {
    /// The group element at node k: `Λ ξ` (body) or `ξ Λ` (spatial).
    pub element: (Letter, Expr),
    /// Its velocity on the edge that starts at node k.
    pub outgoing: (Letter, Expr),
    /// Its velocity on the edge that ends at node k.
    pub incoming: (Letter, Expr),
    /// Every advected quantity at node k, in order of declaration.
    pub advected: Vec<(Letter, Expr)>,
}

impl Variation {
    /// Changes of the quantities on the outgoing edge: its velocity and all quantities at node k.
    pub fn on_outgoing(&self) -> Vec<(Letter, Expr)> {
        let mut all = vec![self.element.clone(), self.outgoing.clone()];
        all.extend(self.advected.iter().cloned());
        all
    }

    /// Changes of the quantities on the incoming edge.
    pub fn on_incoming(&self) -> Vec<(Letter, Expr)> {
        let mut all = vec![self.element.clone(), self.incoming.clone()];
        all.extend(self.advected.iter().cloned());
        all
    }
}

pub(crate) fn at(symbol: SymbolId, shift: Shift) -> Letter {
    Letter { symbol, shift }
}

/// The variations of all configurations.
pub fn variations(
    spec: &Spec,
    letters: &Letters,
    algebra: &Algebra,
) -> Result<Vec<Variation>, Errors> {
    let mut errors = Errors::new();
    let mut out = Vec::new();
    let back = PreviousNode {
        shell: on_shell(spec, letters),
        elements: previous_elements(spec, letters),
    };
    for (i, c) in spec.configurations.iter().enumerate() {
        let mut v = of_configuration(c, letters, i);
        for (j, a) in spec.advected.iter().enumerate() {
            match of_advected(spec, letters, algebra, &v, a, j, &back) {
                Ok(change) => v.advected.push(change),
                Err(d) => {
                    errors.push(*d);
                    break;
                }
            }
        }
        out.push(v);
        if errors.iter().next().is_some() {
            break;
        }
    }
    errors.propagate()?;
    Ok(out)
}

fn of_configuration(c: &Configuration, letters: &Letters, i: usize) -> Variation {
    let s = &letters.symbols;
    let g = expr::here(s, c.element);
    let xi = lie::element(s, c.group, letters.variation[i]);
    let out = expr::here(s, c.velocity);
    let back = expr::letter(s, c.velocity, Shift::PREVIOUS);
    // The outgoing velocity changes on the opposite side.
    let other = c.side.opposite();
    let d_out = expr::neg(c.group.moved(other, out, xi.clone()));
    let (dg, d_in) = (
        c.group.moved(c.side, g, xi.clone()),
        c.group.moved(c.side, back, xi),
    );
    Variation {
        element: (at(c.element, Shift::HERE), dg),
        outgoing: (at(c.velocity, Shift::HERE), d_out),
        incoming: (at(c.velocity, Shift::PREVIOUS), d_in),
        advected: Vec::new(),
    }
}

/// Replacements at the previous node, which are the same for every quantity.
struct PreviousNode {
    shell: Vec<(Letter, Expr)>,
    elements: Vec<(Letter, Expr)>,
}

/// Solves the outgoing constraint for the change of `a`, then requires the incoming one.
fn of_advected(
    spec: &Spec,
    letters: &Letters,
    algebra: &Algebra,
    v: &Variation,
    a: &Advected,
    j: usize,
    back: &PreviousNode,
) -> Result<(Letter, Expr), Box<Diagnostic>> {
    let s = &letters.symbols;
    let here = at(a.quantity, Shift::HERE);
    let name = &s.get(a.quantity).name;
    let shape = s.get(a.quantity).shape;
    // next(a) = f(a, ...) with next(a) fixed: D_a f[da] = -D_rest f.
    let rest = expr::directional(s, &a.update, &v.on_outgoing());
    let marker = expr::here(s, letters.placeholder[j]);
    let own = expr::directional(s, &a.update, &[(here, marker)]);
    let marker = at(letters.placeholder[j], Shift::HERE);
    let read = sandwich(algebra, &algebra.lower(&own), marker);
    let in_blocks = || sandwich(algebra, &algebra.lower_in_blocks(&own)?, marker);
    let Some((left, right)) = read.or_else(in_blocks) else {
        // A quantity that no configuration moves does not vary, for any factors.
        if is_left_alone(s, a, &own) {
            return Ok((here, expr::zero(shape)));
        }
        return Err(Box::new(
            Diagnostic::new(
                a.place,
                format!("the constraint of `{name}` cannot be inverted for `{name}`: it must multiply `{name}` once, between invertible factors"),
            )
            .help(match by_field(spec, a) {
                _ if !is_moved(spec, a) => format!("if no configuration moves the quantity, multiply it by a factor, \
                    `next({name}) = c*{name}`, or add a summand, `next({name}) = {name} + h`"),
                Some(x) => format!("an expression of `{x}` or its increment has no inverse and cannot be a factor of `{name}`; \
                    {}", of_field(s, a, &x)),
                None => "write an action as `Ω^T * Γ` or `Ω^T * S * Ω`; velocities and parameters in a group are invertible".to_owned(),
            }),
        ));
    };
    let solved = expr::neg(expr::product([
        expr::inverse(s, left),
        rest,
        expr::inverse(s, right),
    ]));
    let solved = algebra.shortest(&solved);
    // The incoming constraint a = f(-1), on shell.
    let backward = expr::shift_time(s, &a.update, Shift::PREVIOUS.time);
    let wanted = expr::directional(s, &backward, &v.on_incoming());
    let wanted = expr::substitute(s, &wanted, &back.elements);
    let found = expr::substitute(s, &solved, &back.shell);
    let difference = expr::sub(found, wanted);
    if algebra.is_zero(&difference) || algebra.exhausted() {
        return Ok((here, solved));
    }
    let left_over = algebra.lower(&difference);
    Err(Box::new(wrong_side(
        spec, letters, algebra, a, &left_over, shape,
    )))
}

/// Whether a quantity changes in proportion to itself, with no configuration in its constraint. `own` is the
/// derivative of its update with respect to it.
fn is_left_alone(s: &Symbols, a: &Advected, own: &Expr) -> bool {
    let role = |l: &Letter| s.get(l.symbol).role;
    let is_given = |l: &Letter| matches!(role(l), Role::Parameter | Role::Step);
    let made_of = |e: &Expr, besides: &dyn Fn(&Letter) -> bool| {
        let letters = expr::letters(e);
        letters.iter().all(|l| besides(l) || is_given(l))
    };
    a.update.shape().is_scalar()
        && made_of(&a.update, &|l| l.symbol == a.quantity)
        && made_of(own, &|l| role(l) == Role::Variation)
}

/// Whether the constraint of a quantity contains a configuration or its velocity.
fn is_moved(spec: &Spec, a: &Advected) -> bool {
    let letters = expr::letters(&a.update);
    let mut all = spec.configurations.iter();
    all.any(|c| {
        let mut own = letters.iter();
        own.any(|l| l.symbol == c.velocity || l.symbol == c.element)
    })
}

/// Replacements that express advected quantities at node k by node k-1.
pub(super) fn on_shell(spec: &Spec, letters: &Letters) -> Vec<(Letter, Expr)> {
    let s = &letters.symbols;
    let back = |e: &Expr| expr::shift_time(s, e, Shift::PREVIOUS.time);
    let advected = spec
        .advected
        .iter()
        .map(|a| (at(a.quantity, Shift::HERE), back(&a.update)));
    advected.collect()
}

/// Replacements that express group elements at node k-1 by node k: `Λ(-1) = Λ Ω(-1)^-1`.
pub(super) fn previous_elements(spec: &Spec, letters: &Letters) -> Vec<(Letter, Expr)> {
    let s = &letters.symbols;
    spec.configurations
        .iter()
        .map(|c| {
            let g = expr::here(s, c.element);
            let w = expr::letter(s, c.velocity, Shift::PREVIOUS);
            let before = c.group.advanced(c.side, g, c.group.inverse(s, w));
            (at(c.element, Shift::PREVIOUS), before)
        })
        .collect()
}

/// Splits a normal form that contains the letter once into `L x R`; `L` and `R` must be invertible.
fn sandwich(algebra: &Algebra, poly: &Poly, x: Letter) -> Option<(Expr, Expr)> {
    let mut terms = poly.terms.iter();
    let (term, coefficient) = terms.next()?;
    if terms.next().is_some() || coefficient.is_zero() {
        return None;
    }
    let number = |monomial| {
        let term = crate::algebra::Term {
            monomial,
            word: Vec::new(),
        };
        algebra.raise(&Poly::term(Shape::SCALAR, *coefficient, term))
    };
    if poly.shape.is_scalar() {
        // A scalar: the letter is one atom of the monomial.
        let mut monomial = term.monomial.clone();
        let i = monomial.iter().position(|(atom, e)| {
            matches!(atom, crate::algebra::Atom::Letter(l) if *l == x) && e.is_one()
        })?;
        monomial.remove(i);
        return Some((number(monomial), expr::integer(1)));
    }
    let is_x =
        |f: &Factor| matches!(f, Factor::Letter { source: Source::Letter(l), .. } if *l == x);
    let i = term.word.iter().position(is_x)?;
    let plain = matches!(
        &term.word[i],
        Factor::Letter {
            transposed: false,
            inverted: false,
            ..
        }
    );
    let (before, after) = (&term.word[..i], &term.word[i + 1..]);
    let invertible = |f: &Factor| match f {
        Factor::Letter {
            source: Source::Letter(l),
            ..
        } => algebra.symbols().get(l.symbol).structure.is_invertible(),
        Factor::Letter {
            source: Source::Rotation(_),
            ..
        } => true,
        Factor::Letter { .. }
        | Factor::Unit { .. }
        | Factor::Inclusion { .. }
        | Factor::Axial { .. }
        | Factor::Hat(_)
        | Factor::Pure(_)
        | Factor::Imaginary { .. }
        | Factor::Vee { .. } => false,
    };
    if !plain || !before.iter().chain(after).all(invertible) || after.iter().any(is_x) {
        return None;
    }
    let word = |w: &[Factor], n: Dim| {
        let shape = Shape::square(n);
        let term = crate::algebra::Term {
            monomial: Vec::new(),
            word: w.to_vec(),
        };
        algebra.raise(&Poly::term(shape, Rational::ONE, term))
    };
    let left = expr::mul(number(term.monomial.clone()), word(before, poly.shape.rows));
    Some((left, word(after, poly.shape.cols)))
}

fn wrong_side(
    spec: &Spec,
    letters: &Letters,
    algebra: &Algebra,
    a: &Advected,
    left_over: &Poly,
    shape: Shape,
) -> Diagnostic {
    let s = &letters.symbols;
    let name = &s.get(a.quantity).name;
    let style = crate::print::Style::new(&spec.time_index);
    let rest = crate::print::expression(
        &algebra.raise(left_over),
        s,
        &style,
        crate::print::Format::Text,
    );
    // The group that the constraint already names.
    let moved = |c: &&Configuration| {
        let letters = crate::expr::letters(&a.update);
        letters.iter().any(|l| l.symbol == c.velocity)
    };
    let all = &spec.configurations;
    if let Some(x) = by_field(spec, a) {
        return Diagnostic::new(
            a.place,
            format!(
                "`{name}` is not advected by the group: increments of the field `{x}` add up, but two steps of this constraint \
                 are not one step by their sum; its variation leaves {rest}"
            ),
        )
        .help(of_field(s, a, &x));
    }
    let turning = |c: &&Configuration| !c.group.is_additive();
    let acting = all.iter().find(moved).or(all.iter().find(turning));
    let text = |of: fn(&Configuration) -> SymbolId| {
        acting.map_or(String::new(), |c| s.get(of(c)).name.clone())
    };
    let (g, w) = (text(|c| c.element), text(|c| c.velocity));
    let body = acting.is_none_or(|c| c.side.is_body());
    let (there, back) = acting.map_or_else(
        || (w.clone(), format!("{w}^T")),
        |c| action(c.group, &w, shape.rows),
    );
    // The form of a linear map remains symmetric, because it is a pull-back.
    let back = match s.get(a.quantity).structure.is_symmetric() && there == w {
        true => format!("{w}^T"),
        false => back,
    };
    let example = match (shape.is_vector(), body) {
        (true, true) => format!("next({name}) = {back} * {name}"),
        (true, false) => format!("next({name}) = {there} * {name}"),
        (false, true) => format!("next({name}) = {back} * {name} * {there}"),
        (false, false) => format!("next({name}) = {there} * {name} * {back}"),
    };
    let reconstruction = if body {
        format!("next({g}) = {g} * {w}")
    } else {
        format!("next({g}) = {w} * {g}")
    };
    Diagnostic::new(
        a.place,
        format!(
            "`{name}` is not advected by the group: its constraint is not a group action compatible with `{reconstruction}`; residual of its variation: {rest}"
        ),
    )
    .help(format!(
        "with this reconstruction, write for example `constraint {example};`"
    ))
}

/// The field whose increment alone advects a quantity; the constraint contains no velocity of a group. If the
/// constraint contains no velocity at all, the first field of a model that has only fields.
fn by_field(spec: &Spec, a: &Advected) -> Option<String> {
    let letters = crate::expr::letters(&a.update);
    let stands = |c: &&Configuration| {
        let mut own = letters.iter();
        own.any(|l| l.symbol == c.velocity || l.symbol == c.element)
    };
    let all = &spec.configurations;
    let turning = |c: &&Configuration| !c.group.is_additive();
    if all.iter().filter(turning).any(|c| stands(&c)) {
        return None;
    }
    let only = || all.first().filter(|_| !all.iter().any(|c| turning(&c)));
    let field = all.iter().find(stands).or_else(only)?;
    Some(spec.symbols.get(field.element).name.clone())
}

/// The constraint by which a field usually advects a quantity.
fn of_field(s: &Symbols, a: &Advected, field: &str) -> String {
    let q = s.get(a.quantity);
    let name = &q.name;
    let same = s.find(field).is_some_and(|x| s.get(x).shape == q.shape);
    match same {
        true => format!(
            "to advect a quantity with the field, write `constraint next({name}) = {name} + (next({field}) - {field});`; if it \
             is a function of `{field}`, write it in terms of `{field}` in the Lagrangian, without a constraint"
        ),
        false => format!(
            "if `{name}` is a function of `{field}`, write it in terms of `{field}` in the Lagrangian, without a constraint; \
             if it is constant, write `constraint next({name}) = {name};`"
        ),
    }
}

/// The usual notation for the action of an element `w` of a group and of its inverse on quantities with this number
/// of rows. Quaternions and rigid motions act on vectors in space by the rotation that they cover.
fn action(group: Group, w: &str, rows: Dim) -> (String, String) {
    let turned = rows == Dim::Fixed(3);
    let inverse = |w: String, mark: &str| (w.clone(), format!("{w}^{mark}"));
    match group.coordinates() {
        Some(_) if turned => inverse(format!("rot({w})"), "T"),
        _ if group.structure().is_orthogonal() => inverse(w.to_owned(), "T"),
        _ => inverse(w.to_owned(), "-1"),
    }
}
