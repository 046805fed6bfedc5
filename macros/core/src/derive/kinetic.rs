//! The kinetic energy of a step: the part of its action proportional to 1/h, to second order in velocities `Ω = exp(s
//! ξ)` at the identity. Takes the action; gives the quadratic form in `ξ` and its rank for general parameters, even
//! if the whole action has no limit of small steps.

use super::Letters;
use super::action::Action;
use super::bracket;
use super::first_order;
use super::lie;
use super::limit::Limit;
use super::variation::at;
use crate::algebra::exact::{self, Matrix, Point, negate};
use crate::algebra::{Algebra, Atom, Poly, Rational, assumed};
use crate::check::spec::Spec;
use crate::expr::shape::{Dim, Shape};
use crate::expr::symbol::SymbolId;
use crate::expr::{self, Expr, Letter, Shift};

/// The quadratic form of the kinetic energy, and the number of velocities on which it depends.
#[derive(Clone, Debug)]
pub struct Kinetic {
    /// The kinetic energy in the letters of [`Letters::variation`].
    pub energy: Expr,
    /// The rank of the form at a point in general position of parameters and configurations, and the number of
    /// velocities; `None` if the form is too large to evaluate.
    pub rank: Option<(usize, usize)>,
    /// Whether the Lagrangian is linear in all velocities and determines them, so that the model needs no kinetic
    /// energy.
    pub first_order: bool,
}

impl Kinetic {
    /// The rank and the number of velocities, if the form is singular for all parameters.
    pub fn degenerate(&self) -> Option<(usize, usize)> {
        self.rank.filter(|(rank, n)| rank < n)
    }
}

/// The size of the largest expression that is differentiated twice.
const LARGEST: u32 = 20_000;

/// The largest number of nodes that are evaluated for the rank.
const EVALUATED: u64 = 100_000;

/// The largest number of velocities for which the matrix of the form is computed; its elimination costs the cube of
/// this number.
const VELOCITIES: usize = 256;

/// The number of points in general position that are tried. The rank is the largest one found.
const POINTS: u64 = 3;

/// The kinetic energy, if the step size occurs only outside functions and roots.
pub fn kinetic(
    spec: &Spec,
    letters: &Letters,
    action: &Action,
    limit: Option<&Limit>,
    assumed: &[Expr],
    algebra: &Algebra,
) -> Option<Kinetic> {
    let energy = match limit {
        Some(l) => l.kinetic.clone(),
        None => expanded(spec, letters, action, algebra)?,
    };
    let rank = rank(spec, letters, &energy, assumed);
    let first_order = limit.is_some_and(|l| first_order::is_first_order(spec, letters, l, assumed));
    Some(Kinetic {
        energy,
        rank,
        first_order,
    })
}

/// The kinetic energy of an action without a limit: half the coefficient of `1/h` in the second derivative of the
/// action along the velocities, at zero velocity.
fn expanded(spec: &Spec, letters: &Letters, action: &Action, algebra: &Algebra) -> Option<Expr> {
    let s = &letters.symbols;
    // Uses the remaining work; the derivation itself is not charged for it.
    let algebra = algebra.over(s);
    let (mut identity, mut first, mut second) = (Vec::new(), Vec::new(), Vec::new());
    for (c, xi) in spec.configurations.iter().zip(&letters.variation) {
        let xi = lie::element(s, c.group, *xi);
        let w = at(c.velocity, Shift::HERE);
        identity.push((w, c.group.identity()));
        first.push((w, xi.clone()));
        second.push((w, c.group.second(xi)));
    }
    let l = expr::substitute(s, &action.total, &spec.end_of_edge());
    let once = expr::directional(s, &l, &first);
    if once.size() > LARGEST {
        return None;
    }
    let twice = expr::add(
        expr::directional(s, &once, &first),
        expr::directional(s, &l, &second),
    );
    let twice = algebra.lower(&expr::substitute(s, &twice, &identity));
    let h = Atom::Letter(at(spec.step, Shift::HERE));
    let mut form = Poly::zero(Shape::SCALAR);
    for (term, coefficient) in &twice.terms {
        let mut term = term.clone();
        let Some(i) = term.monomial.iter().position(|(a, _)| *a == h) else {
            // The step size occurs inside a root or a function, as in `sqrt(h^2 - x)`, so the order is unknown.
            let value = algebra.raise(&Poly::term(Shape::SCALAR, *coefficient, term));
            if expr::contains(&value, at(spec.step, Shift::HERE)) {
                return None;
            }
            continue;
        };
        let (_, order) = term.monomial.remove(i);
        if order == Rational::MINUS_ONE && !form.push(term, *coefficient) {
            return None;
        }
    }
    let form = algebra.raise(&form);
    let inside = expr::contains(&form, at(spec.step, Shift::HERE));
    (!algebra.exhausted() && !inside).then(|| expr::scale(Rational::HALF, form))
}

/// Whether a symmetric 3 x 3 matrix is the second moments of a rotating body in the kinetic energy. It then occurs as
/// `-½ tr(J X²)` with the angular velocity `X = hat(ω)` of one configuration, which equals `½ ω·Iω` with `I = tr(J)
/// Id - J`.
pub fn is_second_moment(spec: &Spec, letters: &Letters, energy: &Expr, symbol: SymbolId) -> bool {
    let s = &letters.symbols;
    let three = Dim::Fixed(3);
    let of_body = s.get(symbol).structure.is_symmetric()
        && s.get(symbol).shape == Shape::square(three)
        && energy.size() <= LARGEST;
    let matrix = at(symbol, Shift::HERE);
    if !of_body || !expr::contains(energy, matrix) {
        return false;
    }
    let without = expr::substitute(s, energy, &[(matrix, expr::zero(Shape::square(three)))]);
    let own = expr::sub(energy.clone(), without);
    let mut turns = spec.configurations.iter().zip(&letters.variation);
    turns.any(|(c, xi)| {
        let xi = expr::here(s, *xi);
        // For a group that rotates space, the letters of variation are matrices, or begin with the axis.
        let element = expr::here(s, c.element);
        let turn = match (c.group.turn(s, &element), c.group.coordinates()) {
            (None, _) => return false,
            (Some(_), None) => xi,
            (Some(_), Some(n)) if n == three => expr::hat(xi),
            (Some(_), Some(_)) => match c.group.rigid() {
                Some(rigid) => expr::hat(rigid.angular(s, &xi)),
                None => return false,
            },
        };
        let word = expr::product([expr::here(s, symbol), turn.clone(), turn]);
        let half = expr::scale(Rational::HALF, expr::trace(word));
        exact::vanishes(s, &expr::add(own.clone(), half))
    })
}

/// One letter of variation for each basis element of its Lie algebra.
pub(crate) fn basis(
    spec: &Spec,
    letters: &Letters,
    size: &dyn Fn(crate::expr::shape::Dim) -> usize,
) -> Vec<(Letter, bracket::Element)> {
    let mut out = Vec::new();
    for (c, xi) in spec.configurations.iter().zip(&letters.variation) {
        let elements = c.group.basis(size);
        out.extend(elements.into_iter().map(|e| (at(*xi, Shift::HERE), e)));
    }
    out
}

/// The gradients of the form, one per configuration. A column of the matrix then costs one evaluation.
pub(crate) fn gradients(letters: &Letters, form: &Expr) -> Vec<Expr> {
    let list = letters.variation.iter();
    list.map(|xi| expr::gradient(&letters.symbols, form, at(*xi, Shift::HERE)))
        .collect()
}

pub(super) fn rank(
    spec: &Spec,
    letters: &Letters,
    form: &Expr,
    equations: &[Expr],
) -> Option<(usize, usize)> {
    rank_of(spec, letters, &gradients(letters, form), equations)
}

/// The rank of a bilinear form at a point in general position, and the number of velocities. The form is given by its
/// gradients, one for each configuration, linear in the letters of variation.
pub(super) fn rank_of(
    spec: &Spec,
    letters: &Letters,
    gradients: &[Expr],
    equations: &[Expr],
) -> Option<(usize, usize)> {
    let s = &letters.symbols;
    let cost: u64 = gradients.iter().map(|g| u64::from(g.size())).sum();
    let (mut best, mut found) = (None, 0);
    for attempt in 0..crate::algebra::exact::ATTEMPTS {
        let Some(mut point) = assumed::point(s, attempt, equations) else {
            continue;
        };
        let basis = basis(spec, letters, &|n| point.dim(n));
        if basis.len() > VELOCITIES || cost * basis.len() as u64 > EVALUATED {
            return None;
        }
        let still = |p: &mut Point| {
            for xi in &letters.variation {
                let shape = s.get(*xi).shape;
                let zero = Matrix::zeros(p.dim(shape.rows), p.dim(shape.cols));
                p.set(at(*xi, Shift::HERE), zero);
            }
        };
        let element = |p: &Point, letter: Letter, e: &bracket::Element| {
            let shape = s.get(letter.symbol).shape;
            let mut m = Matrix::zeros(p.dim(shape.rows), p.dim(shape.cols));
            let cols = m.cols;
            for (i, j, x) in e {
                m.data[i * cols + j] = if *x < 0 { negate(1) } else { 1 };
            }
            m
        };
        let mut rows = Vec::with_capacity(basis.len());
        for (letter, e) in &basis {
            still(&mut point);
            point.set(*letter, element(&point, *letter, e));
            let values: Option<Vec<Matrix>> = gradients.iter().map(|g| point.value(g)).collect();
            let Some(values) = values else { break };
            let along = basis.iter().map(|(other, f)| {
                let i = letters.variation.iter().position(|x| *x == other.symbol);
                let value = i.and_then(|i| values.get(i));
                value.map_or(0, |v| v.paired(f))
            });
            rows.push(along.collect::<Vec<u64>>());
        }
        if rows.len() < basis.len() {
            continue;
        }
        let n = basis.len();
        best = best.max(Some((assumed::rank(&rows), n)));
        found += 1;
        if found == POINTS || best.is_some_and(|(r, n)| r == n) {
            break;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::is_second_moment;
    use crate::pipeline::derive_source;

    /// The symbols of a model that are second moments.
    fn moments(body: &str) -> Vec<String> {
        let text = format!("model M {{ {body} }}");
        let d = match derive_source(&text) {
            Ok(d) => d,
            Err(e) => panic!("{text}\n{e}"),
        };
        let Some(form) = &d.kinetic else {
            return Vec::new();
        };
        let s = &d.spec.symbols;
        let found = s
            .ids()
            .filter(|id| is_second_moment(&d.spec, &d.letters, &form.energy, *id));
        found.map(|id| s.get(id).name.clone()).collect()
    }

    #[test]
    fn the_form_of_a_large_field_is_not_made_a_matrix() {
        let rank = |size: usize, kinetic: &str| {
            let text = format!(
                "model M {{ param m: Real; param a: Vec<{size}>; field X: Mat<{size}>; \
                 let d = next(X) - X; lagrangian = m*{kinetic}/(2*h) - h*tr(X*X*X); }}"
            );
            let d = derive_source(&text).unwrap_or_else(|e| panic!("{text}\n{e}"));
            d.kinetic.and_then(|k| k.rank)
        };
        assert_eq!(rank(5, "tr(d^T*d)"), Some((25, 25)));
        assert_eq!(rank(5, "dot(d*a, d*a)"), Some((5, 25)));
        assert_eq!(rank(5, "tr((d - d^T)^T*(d - d^T))"), Some((10, 25)));
        assert_eq!(rank(16, "tr(d^T*d)"), Some((256, 256)));
        // With a thousand velocities, their cube exceeds the limit.
        assert_eq!(rank(32, "tr(d^T*d)"), None);
    }

    #[test]
    fn second_moments_are_told_by_what_they_do() {
        let body = "group Λ: SO<3> velocity Ω; constraint next(Λ) = Λ*Ω;";
        let of = |text: &str| moments(&format!("{body} {text}"));
        assert_eq!(of("param J: Sym<3>; lagrangian = -tr(J*Ω)/h;"), ["J"]);
        assert_eq!(
            of("param A, B: Sym<3>; lagrangian = -tr((A + B)*Ω)/h;"),
            ["A", "B"]
        );
        let field = "param J, K: Sym<3>; advected Γ: Vec<3>; constraint next(Γ) = Ω^T*Γ; \
                     lagrangian = -tr(J*Ω)/h - h*dot(Γ, K*Γ);";
        assert_eq!(of(field), ["J"]);
        // Another multiple, the inertia itself, and a squared term.
        assert!(of("param J: Sym<3>; lagrangian = -2*tr(J*Ω)/h;").is_empty());
        assert!(of("param I: Sym<3>; lagrangian = -tr((tr(I)/2*Id - I)*Ω)/h;").is_empty());
        assert!(of("param J: Sym<3>; lagrangian = -tr(J*J*Ω)/h;").is_empty());
        let spatial = "group Λ: SO<3> velocity ω; advected J: Sym<3>; constraint next(Λ) = ω*Λ; \
                       constraint next(J) = ω*J*ω^T; lagrangian = -tr(ω*J)/h;";
        assert_eq!(moments(spatial), ["J"]);
        let motion = "param J, M: Sym<3>; group G: SE<3> velocity V; constraint next(G) = G*V; \
                      let u = (pos(V) - pos(V^-1))/2; \
                      lagrangian = -tr(J*rot(V))/h + dot(u, M*u)/(2*h);";
        assert_eq!(moments(motion), ["J"]);
        let quaternion = "param J: Sym<3>; group q: SU<2> velocity W; constraint next(q) = q*W; \
                          lagrangian = -tr(J*rot(W))/h;";
        assert_eq!(moments(quaternion), ["J"]);
    }
}
