//! Differences from zero velocity: `A Ω - A` as `A (Ω - Id)`, `tr(J) - tr(J Ω)` as `-tr(J (Ω - Id))`, `cosh(Δx) - 1`
//! as `2 sinh(Δx/2)^2`. For small steps a velocity is near the identity, and the difference loses no digits only if
//! both are in one term. `emit` writes it so if [`Symbols::differences`] requires it. Takes an expression; gives an
//! equal one.

use crate::algebra::Rational;
use crate::expr::shape::{self, Shape, Structure};
use crate::expr::symbol::{Role, Symbols};
use crate::expr::*;

/// Whether a Lagrangian divides by more than the first power of the step size. Differences from the identity then
/// occur to a power, and their rounding errors are divided by the step size more often than the rounding errors of a
/// matrix of second moments. A step size inside a function or a root counts too.
pub fn divides_twice(e: &Expr, step: Letter) -> bool {
    lowest(e, step).is_none_or(|n| n < -1.0)
}

/// Whether a moving scalar multiplies or divides a scalar with the velocity of a rotation, as in `q^2*(3 - tr(Ω))/h`.
/// The difference from the identity then occurs in the momentum of `q`, where its rounding error would be divided by
/// the step size.
pub fn varies_with_rotations(symbols: &Symbols, e: &Expr) -> bool {
    let has = |e: &Expr, wanted: &dyn Fn(Role, Structure) -> bool| {
        letters(e).iter().any(|l| {
            let symbol = symbols.get(l.symbol);
            wanted(symbol.role, symbol.structure)
        })
    };
    let turns = |e: &Expr| {
        has(e, &|role, structure| {
            role == Role::Velocity && structure.is_orthogonal()
        })
    };
    let moves = |e: &Expr| has(e, &|role, _| matches!(role, Role::Element | Role::Advected));
    let both = |factors: &[&Expr]| {
        let turning = factors.iter().position(|f| turns(f));
        turning.is_some_and(|at| (0..factors.len()).any(|i| i != at && moves(factors[i])))
    };
    let here = e.shape().is_scalar()
        && match e.node() {
            Node::Product(list) => {
                list.iter().all(|f| f.shape().is_scalar()) && both(&list.iter().collect::<Vec<_>>())
            }
            Node::Quotient(a, b) => both(&[a, b]),
            _ => false,
        };
    here || e
        .children()
        .into_iter()
        .any(|child| varies_with_rotations(symbols, child))
}

/// The lowest power of the step size in an expression; `None` if it cannot be determined.
fn lowest(e: &Expr, step: Letter) -> Option<f64> {
    if !contains(e, step) {
        return Some(0.0);
    }
    match e.node() {
        Node::Letter(_) => Some(1.0),
        Node::Sum(terms) => terms
            .iter()
            .try_fold(f64::INFINITY, |least, t| Some(least.min(lowest(t, step)?))),
        Node::Product(factors) => factors
            .iter()
            .try_fold(0.0, |all, f| Some(all + lowest(f, step)?)),
        Node::Neg(a) | Node::Trace(a) | Node::Transpose(a) | Node::Part(_, a) => lowest(a, step),
        Node::Dot(a, b) | Node::Cross(a, b) => Some(lowest(a, step)? + lowest(b, step)?),
        Node::Quotient(a, b) => Some(lowest(a, step)? - exact(b, step)?),
        Node::Power(a, q) => {
            let times = q.as_integer()? as f64;
            match q.is_negative() {
                true => Some(exact(a, step)? * times),
                false => Some(lowest(a, step)? * times),
            }
        }
        _ => None,
    }
}

/// The exponent of the step size to which a factor is proportional.
fn exact(e: &Expr, step: Letter) -> Option<f64> {
    match e.node() {
        Node::Sum(_) if contains(e, step) => None,
        _ => lowest(e, step),
    }
}

/// The value at zero velocity: the identity for an orthogonal velocity or the rotation of a quaternion velocity; 1
/// for the real part of a quaternion.
pub fn at_rest(symbols: &Symbols, e: &Expr) -> Option<Expr> {
    if !symbols.differences() {
        return None;
    }
    match e.node() {
        Node::Letter(l) => {
            let symbol = symbols.get(l.symbol);
            let moves = matches!(symbol.role, Role::Velocity | Role::Derived);
            (moves && symbol.structure.is_orthogonal()).then(|| identity(e.shape().rows))
        }
        Node::Transpose(a) => at_rest(symbols, a),
        Node::Map(Map::Rotation, a) => is_velocity(symbols, a).then(|| identity(e.shape().rows)),
        Node::Map(Map::Real, a) => is_velocity(symbols, a).then(|| integer(1)),
        _ => None,
    }
}

fn is_velocity(symbols: &Symbols, e: &Expr) -> bool {
    matches!(e.node(), Node::Letter(l) if symbols.get(l.symbol).role == Role::Velocity)
}

/// Whether this is exactly a difference from zero velocity, which must stay whole.
pub fn is_difference(symbols: &Symbols, e: &Expr) -> bool {
    let Node::Sum(terms) = e.node() else {
        return false;
    };
    let [a, b] = terms.as_slice() else {
        return false;
    };
    let opposite = |moving: &Expr, rest: &Expr| match moving.node() {
        Node::Neg(x) => at_rest(symbols, x).is_some_and(|r| r == *rest),
        _ => at_rest(symbols, moving).is_some_and(|r| neg(r) == *rest),
    };
    opposite(a, b) || opposite(b, a)
}

/// Whether the expression must not be split: a difference from zero velocity, or from the identity.
pub(super) fn stays_whole(symbols: &Symbols, e: &Expr) -> bool {
    is_difference(symbols, e) || super::increments::is_increment(symbols, e)
}

/// The expression rebuilt with `go` applied to its children; a difference from zero velocity is unchanged.
pub(super) fn rebuilt(symbols: &Symbols, e: &Expr, go: &mut dyn FnMut(&Expr) -> Expr) -> Expr {
    match stays_whole(symbols, e) {
        true => e.clone(),
        false => rebuild(symbols, e, go),
    }
}

/// The expression with differences from zero velocity in increment form, at every depth.
pub fn displaced(symbols: &Symbols, e: &Expr) -> Expr {
    // Applied to the whole, since a product that is expanded in one part would cancel against other parts.
    parts_displaced(symbols, &super::increments::by_increments(symbols, e))
}

fn parts_displaced(symbols: &Symbols, e: &Expr) -> Expr {
    let wanted = symbols.differences() || calls_what_moves(symbols, e);
    if !wanted || !moves(symbols, e) {
        return e.clone();
    }
    let e = rebuild(symbols, e, &mut |x| parts_displaced(symbols, x));
    match e.node() {
        Node::Sum(terms) => of_sum(symbols, terms, e.shape()),
        Node::Vee(a) => of_axial(symbols, a).unwrap_or(e),
        _ => e,
    }
}

/// `vee(A Ω)` as `vee(A (Ω - Id)) + vee(A)`, if `vee(A)` is known. If `A` is symmetric, its axial vector is zero, so
/// that the large entries of `A` multiply small ones only. The entries of `vee(Ω)` are small already.
fn of_axial(symbols: &Symbols, a: &Expr) -> Option<Expr> {
    if at_rest(symbols, a).is_some() {
        return None;
    }
    differences(symbols, a)
        .into_iter()
        .find_map(|(rest, moved)| Some(add(vee(moved), axial(symbols, &rest)?)))
}

/// The axial vector of a matrix that contains only symmetric matrices and hats; None for other matrices.
fn axial(symbols: &Symbols, e: &Expr) -> Option<Expr> {
    let vector = Shape::vector(shape::Dim::Fixed(3));
    match e.node() {
        Node::Identity(_) => Some(zero(vector)),
        Node::Letter(l) => matches!(
            symbols.get(l.symbol).structure,
            Structure::Symmetric | Structure::Diagonal
        )
        .then(|| zero(vector)),
        Node::Hat(v) => Some(v.clone()),
        Node::Neg(a) => axial(symbols, a).map(neg),
        Node::Quotient(a, b) => Some(quotient(axial(symbols, a)?, b.clone())),
        Node::Sum(terms) => {
            let terms: Option<Vec<Expr>> = terms.iter().map(|t| axial(symbols, t)).collect();
            Some(sum(terms?, vector))
        }
        Node::Product(factors) => {
            let mut matrices = factors
                .iter()
                .enumerate()
                .filter(|(_, f)| !f.shape().is_scalar());
            let (Some((at, only)), None) = (matrices.next(), matrices.next()) else {
                return None;
            };
            let mut all = factors.clone();
            all[at] = axial(symbols, only)?;
            Some(product(all))
        }
        _ => None,
    }
}

fn moves(symbols: &Symbols, e: &Expr) -> bool {
    [Role::Velocity, Role::Derived]
        .into_iter()
        .any(|role| contains_role(symbols, e, role))
}

/// Whether the expression contains a function of a moving quantity that is 1 at zero.
fn calls_what_moves(symbols: &Symbols, e: &Expr) -> bool {
    above_one(symbols, e).is_some()
        || e.children()
            .into_iter()
            .any(|child| calls_what_moves(symbols, child))
}

/// `cos(u) - 1`, `cosh(u) - 1` or `exp(u) - 1` of a moving quantity, without cancellation.
fn above_one(symbols: &Symbols, e: &Expr) -> Option<Expr> {
    let Node::Call(f, a) = e.node() else {
        return None;
    };
    let half = || scale(Rational::HALF, a.clone());
    let of_half = |f: Function| call(f, half());
    let square = |f| power(of_half(f), Rational::integer(2));
    let above = match f {
        Function::Cos => scale(Rational::integer(-2), square(Function::Sin)),
        Function::Cosh => scale(Rational::integer(2), square(Function::Sinh)),
        Function::Exp => scale(
            Rational::integer(2),
            mul(of_half(Function::Sinh), of_half(Function::Exp)),
        ),
        _ => return None,
    };
    moves(symbols, a).then_some(above)
}

fn of_sum(symbols: &Symbols, terms: &[Expr], shape: Shape) -> Expr {
    let mut left: Vec<Expr> = terms.to_vec();
    let mut found = Vec::new();
    let mut i = 0;
    while i < left.len() {
        let partner = differences(symbols, &left[i])
            .into_iter()
            .find_map(|(rest, moved)| {
                // A difference without a factor is a sum already.
                let open = matches!(moved.node(), Node::Sum(_));
                let opposite = neg(rest);
                let at = left.iter().position(|t| !open && *t == opposite)?;
                Some((at, moved))
            });
        match partner {
            Some((at, moved)) if at != i => {
                found.push(moved);
                left.remove(at.max(i));
                left.remove(at.min(i));
                i = i.saturating_sub(usize::from(at < i));
            }
            _ => i += 1,
        }
    }
    sum(left.into_iter().chain(found), shape)
}

/// For each velocity of the term: the term at zero velocity, and the term with the difference in place of the
/// velocity.
fn differences(symbols: &Symbols, e: &Expr) -> Vec<(Expr, Expr)> {
    if !moves(symbols, e) {
        return Vec::new();
    }
    if let Some(rest) = at_rest(symbols, e) {
        return vec![(rest.clone(), sub(e.clone(), rest))];
    }
    if let Some(above) = above_one(symbols, e) {
        return vec![(integer(1), above)];
    }
    let each = |a: &Expr, with: &dyn Fn(Expr) -> Expr| -> Vec<(Expr, Expr)> {
        let list = differences(symbols, a).into_iter();
        list.map(|(rest, moved)| (with(rest), with(moved)))
            .collect()
    };
    match e.node() {
        Node::Neg(a) => each(a, &neg),
        Node::Trace(a) => each(a, &trace),
        Node::Quotient(a, b) => each(a, &|x| quotient(x, b.clone())),
        Node::Power(a, q) if *q == Rational::integer(2) => each(a, &|x| mul(x, a.clone())),
        Node::Dot(a, b) => {
            let mut all = each(a, &|x| dot(x, b.clone()));
            all.extend(each(b, &|x| dot(a.clone(), x)));
            all
        }
        Node::Product(factors) => (0..factors.len())
            .flat_map(|i| {
                each(&factors[i], &|x| {
                    let (before, after) = (&factors[..i], &factors[i + 1..]);
                    product(before.iter().chain([&x]).chain(after).cloned())
                })
            })
            .collect(),
        _ => Vec::new(),
    }
}

/// The expression with `re(q) - 1` as `-|im(q)|²/(1 + re(q))`, if quaternions are split. The trace of their matrix is
/// `4 re(q)`.
pub fn by_imaginary(symbols: &Symbols, e: &Expr) -> Expr {
    if !symbols.differences() {
        return e.clone();
    }
    let e = rebuild(symbols, e, &mut |x| by_imaginary(symbols, x));
    let fall = |q: &Expr| {
        let v = imaginary(q.clone());
        let above = add(integer(1), real(q.clone()));
        quotient(dot(v.clone(), v), above)
    };
    match e.node() {
        Node::Trace(a) if is_difference(symbols, a) => {
            let Node::Sum(terms) = a.node() else {
                return e;
            };
            let fallen = terms.iter().find_map(|t| {
                let (sign, q) = signed(t);
                let of_quaternion = is_velocity(symbols, q)
                    && q.shape() == shape::Shape::square(shape::Dim::Fixed(4));
                of_quaternion.then(|| scale(Rational::integer(-4 * sign), fall(q)))
            });
            fallen.unwrap_or(e)
        }
        Node::Sum(terms) => {
            let found = terms.iter().enumerate().find_map(|(i, t)| {
                let (sign, term) = signed(t);
                let q = match term.node() {
                    Node::Map(Map::Real, q) if is_velocity(symbols, q) => q,
                    _ => return None,
                };
                let at = terms.iter().position(|t| *t == integer(-sign))?;
                Some((i, at, scale(Rational::integer(-sign), fall(q))))
            });
            let Some((i, at, fallen)) = found else {
                return e;
            };
            let others = (0..terms.len()).filter(|k| *k != i && *k != at);
            let others = others.map(|k| terms[k].clone());
            sum(others.chain([fallen]), e.shape())
        }
        _ => e,
    }
}

/// The sign of a term, and the term without it.
fn signed(e: &Expr) -> (i64, &Expr) {
    match e.node() {
        Node::Neg(a) => (-1, a),
        _ => (1, e),
    }
}

#[cfg(test)]
mod tests {
    use super::{by_imaginary, displaced, is_difference};
    use crate::algebra::Algebra;
    use crate::expr::shape::{Dim, Shape, Structure};
    use crate::expr::symbol::{Role, Symbols};
    use crate::expr::{
        Expr, Function, call, here, identity, integer, mul, neg, real, sub, sum, trace,
    };
    use crate::interpret::{Assignment, evaluate};
    use crate::pipeline::derive_source;

    /// Whether the step of this Lagrangian preserves the digits of differences.
    fn kept(lagrangian: &str) -> bool {
        let text = format!(
            "model M {{ param J: Sym<3>; param d: Vec<3>; param k: Real; group A: SO<3> velocity u; \
             constraint next(A) = A*u; lagrangian = {lagrangian}; }}"
        );
        let d = derive_source(&text).unwrap_or_else(|e| panic!("{text}\n{e}"));
        d.letters.symbols.differences()
    }

    #[test]
    fn differences_are_kept_where_the_step_divides_twice() {
        for plain in [
            "-tr(J*u)/h",
            "-tr(J*u)/h - h*k*dot(d, A*d)",
            "-tr(J*u)/h - k*dot((u - Id)*d, (u - Id)*d)/(2*h)",
            "-h*tr(J*u)/h^2",
        ] {
            assert!(!kept(plain), "{plain}");
        }
        for quartic in [
            "-tr(J*u)/h + (k/h^3)*tr(Id - u)^2",
            "-tr(J*u)/h + h*k*(tr(Id - u)/h^2)^2",
            "-tr(J*u)/h - k*h*dot((u - Id)*d, (u - Id)*d)^2/h^4",
            "-tr(J*u)/h - k*h*sqrt(1 + tr(Id - u)/h^2)",
        ] {
            assert!(kept(quartic), "{quartic}");
        }
    }

    #[test]
    fn functions_of_velocities_less_their_value_at_rest_do_not_cancel() {
        let mut s = Symbols::default();
        let v = s.add("v", Shape::SCALAR, Structure::General, Role::Velocity);
        let q = s.add("q", Shape::SCALAR, Structure::General, Role::Element);
        let (v, q) = (here(&s, v), here(&s, q));
        let mut at = Assignment::new();
        at.set("v", 0, 1, 1, &[1e-8]);
        at.set("q", 0, 1, 1, &[3.0]);
        let of = |f, x: &Expr| call(f, x.clone());
        for (f, wanted) in [
            (Function::Cosh, 0.5e-16),
            (Function::Cos, -0.5e-16),
            (Function::Exp, 1e-8 + 0.5e-16),
        ] {
            let one = sub(of(f, &v), integer(1));
            let many = sub(mul(q.clone(), of(f, &v)), q.clone());
            for (e, wanted) in [(one, wanted), (many, 3.0 * wanted)] {
                let made = evaluate(&s, &displaced(&s, &e), &at).unwrap().data[0];
                // The next terms of the series are smaller by a factor of 1e-16.
                assert!(
                    (made - wanted).abs() <= 1e-15 * wanted.abs(),
                    "{e:?}: {made:e}"
                );
            }
            // A function of constants stays as it is.
            let still = sub(of(f, &q), integer(1));
            assert_eq!(displaced(&s, &still), still);
        }
    }

    #[test]
    fn a_difference_from_rest_is_one_in_either_order() {
        let mut s = Symbols::default();
        s.keep_differences(true);
        let three = Dim::Fixed(3);
        let mut add = |name, role| s.add(name, Shape::square(three), Structure::Orthogonal, role);
        let (o, q) = (add("O", Role::Velocity), add("Q", Role::Element));
        let (o, q) = (here(&s, o), here(&s, q));
        let one = || identity(three);
        let of = |a, b| sum([a, b], Shape::square(three));
        for (a, b, known) in [
            (o.clone(), neg(one()), true),
            (neg(one()), o.clone(), true),
            (one(), neg(o.clone()), true),
            (neg(o.clone()), one(), true),
            (o.clone(), one(), false),
            (q.clone(), neg(one()), false),
            (o, neg(q), false),
        ] {
            let difference = of(a, b);
            assert_eq!(is_difference(&s, &difference), known, "{difference:?}");
        }
    }

    #[test]
    fn quaternions_near_rest_are_told_by_their_imaginary_part() {
        let mut s = Symbols::default();
        s.keep_differences(true);
        let four = Dim::Fixed(4);
        let q = s.add(
            "q",
            Shape::square(four),
            Structure::UnitQuaternion,
            Role::Velocity,
        );
        let q = here(&s, q);
        let algebra = Algebra::new(&s);
        for fallen in [
            sub(real(q.clone()), integer(1)),
            sub(integer(1), real(q.clone())),
            trace(sub(q.clone(), identity(four))),
            trace(sub(identity(four), q)),
        ] {
            let made = by_imaginary(&s, &fallen);
            assert_ne!(made, fallen);
            assert!(algebra.equal(&made, &fallen), "{fallen:?}");
        }
    }
}
