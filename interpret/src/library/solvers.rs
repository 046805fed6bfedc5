//! The solvers of steps, and their prepared data.

use super::momenta::three;
use crate::code::Native;
use crate::failure::Failure;
use crate::value::{Frame, MatrixGroup, Value};
use clebsch::emitted::{
    Edge, Free, LeftFactor, Poinsot, QuaternionBody, divided, reach_of, rotation_at,
};
use clebsch::linalg::Dense;
use clebsch::solvers::two_sided::SingularFactor;
use clebsch::{OfScalars, Real, StepCause};
use nalgebra::{SMatrix, Vector3};
use std::sync::Arc;

/// A left factor of one of the sizes that are compiled.
#[derive(Clone, Debug)]
pub enum Factor<T: Real> {
    /// Two rows.
    Two(Arc<LeftFactor<2, T>>),
    /// Three.
    Three(Arc<LeftFactor<3, T>>),
    /// Four.
    Four(Arc<LeftFactor<4, T>>),
    /// Five.
    Five(Arc<LeftFactor<5, T>>),
    /// Six.
    Six(Arc<LeftFactor<6, T>>),
    /// Seven.
    Seven(Arc<LeftFactor<7, T>>),
    /// Eight.
    Eight(Arc<LeftFactor<8, T>>),
}

fn prepared<T: Real>(c: &Dense<T>) -> Option<Value<T>> {
    macro_rules! of {
        ($($n:literal $kind:ident),*) => {
            match c.rows {
                $($n => LeftFactor::<$n, T>::new(c.fixed())
                    .map(|f| Factor::$kind(Arc::new(f)))
                    .map_err(Failure::from),)*
                _ => return None,
            }
        };
    }
    let factor = of!(2 Two, 3 Three, 4 Four, 5 Five, 6 Six, 7 Seven, 8 Eight);
    Some(match factor {
        Ok(factor) => Value::LeftFactor(factor),
        Err(e) => Value::failed(e),
    })
}

impl<T: Real> Factor<T> {
    /// The factor with every number replaced.
    pub fn over<U: Real>(&self, change: &mut impl FnMut(T) -> U) -> Factor<U> {
        match self {
            Factor::Two(f) => Factor::Two(Arc::new(f.over(change))),
            Factor::Three(f) => Factor::Three(Arc::new(f.over(change))),
            Factor::Four(f) => Factor::Four(Arc::new(f.over(change))),
            Factor::Five(f) => Factor::Five(Arc::new(f.over(change))),
            Factor::Six(f) => Factor::Six(Arc::new(f.over(change))),
            Factor::Seven(f) => Factor::Seven(Arc::new(f.over(change))),
            Factor::Eight(f) => Factor::Eight(Arc::new(f.over(change))),
        }
    }

    /// Whether both have the same size and form.
    pub fn is_alike(&self, other: &Self) -> bool {
        match (self, other) {
            (Factor::Two(a), Factor::Two(b)) => a.is_alike(b),
            (Factor::Three(a), Factor::Three(b)) => a.is_alike(b),
            (Factor::Four(a), Factor::Four(b)) => a.is_alike(b),
            (Factor::Five(a), Factor::Five(b)) => a.is_alike(b),
            (Factor::Six(a), Factor::Six(b)) => a.is_alike(b),
            (Factor::Seven(a), Factor::Seven(b)) => a.is_alike(b),
            (Factor::Eight(a), Factor::Eight(b)) => a.is_alike(b),
            _ => false,
        }
    }
}

macro_rules! with_factor {
    ($factor:expr, $f:ident => $body:expr) => {
        match $factor {
            Factor::Two($f) => $body,
            Factor::Three($f) => $body,
            Factor::Four($f) => $body,
            Factor::Five($f) => $body,
            Factor::Six($f) => $body,
            Factor::Seven($f) => $body,
            Factor::Eight($f) => $body,
        }
    };
}

fn turned<T: Real>(a: &[&Value<T>], _: &[usize]) -> Option<Value<T>> {
    let (edge, method, body, h, element) = match a {
        [edge, body, h, element] => (edge, None, body, h, element),
        [edge, Value::Method(method), body, h, element] => (edge, Some(*method), body, h, element),
        _ => return None,
    };
    let (Value::Edge(edge), Value::Real(h)) = (edge, h) else {
        return None;
    };
    Some(match (body, element, method) {
        (Value::Poinsot(body), Value::Rotation(r), None) => {
            Value::result(edge.turn(body, *h, r).map(Value::Turned))
        }
        (Value::Poinsot(body), Value::Rotation(r), Some(method)) => {
            Value::result(edge.turn_by(method, body, *h, r).map(Value::Turned))
        }
        _ => return None,
    })
}

/// The arguments of a step in unit quaternions.
macro_rules! in_quaternions {
    ($a:expr, $edge:ident, $body:ident, $h:ident, $q:ident, $made:expr) => {{
        let [
            Value::Edge($edge),
            Value::QuaternionBody($body),
            Value::Real($h),
            Value::Quaternion($q),
        ] = $a
        else {
            return None;
        };
        Some($made)
    }};
}

fn vector<T: Real>(a: &Value<T>) -> Option<Vector3<T>> {
    match a {
        Value::Vector(v) => Some(*v),
        _ => None,
    }
}

fn text<T: Real>(a: &Value<T>) -> Option<&'static str> {
    match a {
        Value::Text(name) => Some(name),
        _ => None,
    }
}

/// The solution of a linear equation, or the singular factor.
fn increment<T: Real>(solved: Option<Dense<T>>, factor: &'static str) -> Value<T> {
    match solved {
        Some(x) => Value::Element(MatrixGroup::Field, x),
        None => Value::failed(SingularFactor { factor }),
    }
}

/// The value computed from inverses that the model keeps, or the first singular factor.
fn kept<T: Real>(
    inverses: &[(&Dense<T>, &'static str)],
    made: impl FnOnce() -> Dense<T>,
) -> Value<T> {
    let singular = inverses
        .iter()
        .find(|(inverse, _)| !inverse.trace().is_finite());
    increment(
        singular.is_none().then(made),
        singular.map_or("", |(_, factor)| *factor),
    )
}

/// The solution of `left X right = known`, or the singular factor.
fn between<T: Real>(a: &[&Value<T>]) -> Option<Result<Dense<T>, SingularFactor>> {
    let [left, known, right, label] = a else {
        return None;
    };
    let (l, m, r) = (left.dense()?, known.dense()?, right.dense()?);
    let [first, second] = names(label)?;
    if l.cols != m.rows || m.cols != r.rows {
        return None;
    }
    let Some(half) = l.small_solve(&m) else {
        return Some(Err(SingularFactor { factor: first }));
    };
    let whole = r.transpose().small_solve(&half.transpose());
    Some(match whole {
        Some(x) => Ok(x.transpose()),
        None => Err(SingularFactor { factor: second }),
    })
}

/// The names of two factors, as static strings for errors.
fn names<T: Real>(a: &Value<T>) -> Option<[&'static str; 2]> {
    match a {
        Value::List(list) => match list.as_slice() {
            [Value::Text(a), Value::Text(b)] => Some([a, b]),
            _ => None,
        },
        _ => None,
    }
}

pub(super) fn native<T: Real>(name: &str, arguments: usize) -> Option<Native<T>> {
    Some(match (name, arguments) {
        ("Edge::new", 2) => |a, _| {
            let part = |a: &Value<T>| match a {
                Value::Zeros => Some(Vector3::zeros()),
                a => vector(a),
            };
            Some(Value::Edge(Edge::new(part(a.first()?)?, part(a.get(1)?)?)))
        },
        ("Edge::of_space", 2) => |a, _| match (a.first()?, a.get(1)?) {
            (space, Value::Rotation(attitude)) => {
                Some(Value::Edge(Edge::of_space(vector(space)?, attitude)))
            }
            _ => None,
        },
        ("space", 1) => |a, _| match a.first()? {
            Value::Edge(edge) => Some(Value::Vector(edge.space())),
            _ => None,
        },
        ("body", 1) => |a, _| match a.first()? {
            Value::Edge(edge) => Some(Value::Vector(edge.body())),
            _ => None,
        },
        ("turn", 4) | ("turn_by", 5) => turned,
        ("turn_in_quaternions", 4) => |a, _| {
            in_quaternions!(a, edge, body, h, q, {
                Value::result(edge.turn_in_quaternions(body, *h, q).map(Value::Turned))
            })
        },
        ("free_in_quaternions", 4) => {
            |a, _| {
                in_quaternions!(a, edge, body, h, q, {
                    let solved = edge.free_in_quaternions(body, *h, q);
                    Value::result(solved.map(|(q, edge)| {
                        Value::List(vec![Value::Quaternion(q), Value::Edge(edge)])
                    }))
                })
            }
        }
        ("Poinsot::new", 1) => |a, _| match a.first()? {
            Value::Matrix(j) => {
                let body = Poinsot::new(*j);
                Some(Value::result(body.map(|b| Value::Poinsot(Arc::new(b)))))
            }
            _ => None,
        },
        ("QuaternionBody::new", 3) => |a, _| match a {
            [Value::Text(name), Value::Matrix(m), Value::Real(c)] => {
                let body = QuaternionBody::new(name, *m, *c);
                Some(Value::result(
                    body.map(|b| Value::QuaternionBody(Arc::new(b))),
                ))
            }
            _ => None,
        },
        ("velocity", 2) => |a, _| match a {
            [Value::QuaternionBody(body), Value::Vector(v)] => {
                Some(Value::result(body.velocity(v).map(Value::Quaternion)))
            }
            _ => None,
        },
        ("LeftFactor::new", 1) => |a, _| prepared(&a.first()?.dense()?),
        ("solve", 3) => |a, _| match a {
            [Value::LeftFactor(f), v, Value::Method(method)] => {
                let v = v.dense()?;
                with_factor!(f, f => {
                    let solved = f.solve(&v.fixed(), *method);
                    Some(Value::result(
                        solved.map(|g| Value::Element(MatrixGroup::Orthogonal, Dense::of(&g.matrix()))),
                    ))
                })
            }
            _ => None,
        },
        ("rotation", 3) => |a, _| match a {
            [
                Value::LeftFactor(f),
                Value::Vector(v),
                Value::Method(method),
            ] => {
                with_factor!(f, f => Some(Value::result(f.rotation(v, *method).map(Value::Rotation))))
            }
            _ => None,
        },
        ("rotations", 3) => |a, _| match a {
            [
                Value::LeftFactor(f),
                Value::List(all),
                Value::Method(method),
            ] => {
                let one = |v: &Value<T>| {
                    let v = vector(v)?;
                    Some(with_factor!(f, f => f.rotation(&v, *method)))
                };
                let solved: Option<Result<Vec<_>, _>> = all.iter().map(one).collect();
                let listed =
                    |all: Vec<_>| Value::List(all.into_iter().map(Value::Rotation).collect());
                Some(Value::result(solved?.map(listed)))
            }
            _ => None,
        },
        ("reach", 2) => |a, _| match a {
            [Value::LeftFactor(f), v] => {
                let v = v.dense()?;
                with_factor!(f, f => Some(Value::Double(f.reach(&v.fixed()))))
            }
            _ => None,
        },
        ("reach_of", 2) => |a, _| {
            let (c, v) = (a.first()?.dense()?, a.get(1)?.dense()?);
            macro_rules! of {
                ($($n:literal)*) => {
                    match c.rows {
                        $($n => reach_of::<T, $n>(&c.fixed(), &v.fixed()),)*
                        _ => return None,
                    }
                };
            }
            Some(Value::Double(of!(2 3 4 5 6 7 8)))
        },
        ("rotation_at", 3) => |a, _| match a {
            [Value::Matrix(c), Value::Vector(v), Value::Method(method)] => Some(Value::result(
                rotation_at(c, v, *method).map(Value::Rotation),
            )),
            _ => None,
        },
        ("Free::start_of_order", 5) => |a, _| match a {
            [
                Value::Poinsot(body),
                Value::Rotation(r),
                m,
                Value::Real(h),
                Value::Order(order),
            ] => {
                let m = clebsch::SpatialMomentum(three(Frame::Spatial, m)?);
                let free = Free::start_of_order(body, r, &m, *h, *order);
                Some(Value::result(free.map(|f| Value::Free(Box::new(f)))))
            }
            _ => None,
        },
        ("solved_by", 2) => |a, _| match a {
            [Value::Free(free), Value::Method(method)] => {
                Some(Value::Free(Box::new(free.solved_by(*method))))
            }
            _ => None,
        },
        ("compensated", 1) => |a, _| match a.first()? {
            Value::Free(free) => Some(Value::Free(Box::new(free.compensated()))),
            _ => None,
        },
        ("body_momentum", 1) => |a, _| match a.first()? {
            Value::Free(free) => Some(Value::Momentum(Frame::Body, free.body_momentum().0)),
            _ => None,
        },
        ("serving", 2) => |a, _| match a {
            [Value::Method(method), n] => Some(Value::Method(method.serving(n.count()?))),
            _ => None,
        },
        ("Method::of_size", 1) => |a, _| {
            Some(Value::Method(clebsch::solvers::Method::of_size(
                a.first()?.count()?,
            )))
        },
        ("two_sided", 4) => |a, _| {
            let solved = between(a)?;
            Some(Value::result(solved.map(|x| {
                let one = Dense::identity(x.rows, x.cols);
                Value::Element(MatrixGroup::Linear, one.plus(&x))
            })))
        },
        ("two_sided_increment", 4) => |a, _| {
            let solved = between(a)?;
            Some(Value::result(
                solved.map(|x| Value::Element(MatrixGroup::Field, x)),
            ))
        },
        ("increment_between", 4) => |a, _| {
            let (l, m, r) = (a.first()?.dense()?, a.get(1)?.dense()?, a.get(2)?.dense()?);
            let [first, second] = names(a.get(3)?)?;
            let fits = l.cols == m.rows && m.cols == r.rows;
            fits.then(|| kept(&[(&l, first), (&r, second)], || l.times(&m).times(&r)))
        },
        ("increment_behind", 3) => |a, _| {
            let (l, m, label) = (a.first()?.dense()?, a.get(1)?.dense()?, text(a.get(2)?)?);
            (l.cols == m.rows).then(|| kept(&[(&l, label)], || l.times(&m)))
        },
        ("increment_before", 3) => |a, _| {
            let (m, r, label) = (a.first()?.dense()?, a.get(1)?.dense()?, text(a.get(2)?)?);
            (m.cols == r.rows).then(|| kept(&[(&r, label)], || m.times(&r)))
        },
        ("displaced", 5) => |a, _| {
            let [element, left, known, right, label] = a else {
                return None;
            };
            let Value::Element(MatrixGroup::Linear, q) = element else {
                return None;
            };
            let (l, m, r) = (left.dense()?, known.dense()?, right.dense()?);
            let singular = [&l, &r].into_iter().zip(names(label)?);
            for (inverse, factor) in singular {
                if !inverse.trace().is_finite() {
                    return Some(Value::failed(SingularFactor { factor }));
                }
            }
            let seen = m.times(&super::groups::linear_inverse(q).transpose());
            let change = Value::of(l.times(&seen.times(&r)));
            let solved: Result<_, SingularFactor> = Ok(change);
            Some(Value::result(solved))
        },
        ("left_sided", 3) => |a, _| {
            let (l, m, label) = (a.first()?.dense()?, a.get(1)?.dense()?, text(a.get(2)?)?);
            (l.cols == m.rows).then(|| increment(l.small_solve(&m), label))
        },
        ("right_sided", 3) => |a, _| {
            let (m, r, label) = (a.first()?.dense()?, a.get(1)?.dense()?, text(a.get(2)?)?);
            let solved = || r.transpose().small_solve(&m.transpose());
            (m.cols == r.rows).then(|| increment(solved().map(|x| x.transpose()), label))
        },
        ("divided", 3) => |a, _| {
            let (m, label) = (a.first()?.dense()?, text(a.get(2)?)?);
            let Value::Real(number) = a.get(1)? else {
                return None;
            };
            // The entries of a matrix of any shape, times the inverse.
            let inverse = divided(&SMatrix::<T, 1, 1>::new(T::one()), *number, label);
            Some(Value::result(inverse.map(|x| {
                let inverse = x.matrix()[(0, 0)];
                Value::Element(MatrixGroup::Field, m.map(|entry| entry * inverse))
            })))
        },
        ("StepCause::from", 1) => |a, _| match a.first()? {
            Value::Failed(e) => Some(Value::failed((**e).clone().cause())),
            _ => None,
        },
        (
            "StepCause::Singular"
            | "StepCause::Factor"
            | "StepCause::LeftFactor"
            | "StepCause::NoRoot"
            | "StepCause::NoReaction",
            1,
        ) => |a, _| match a.first()? {
            Value::Failed(e) => Some(Value::failed((**e).clone().cause())),
            _ => None,
        },
        ("StepCause::not_finite", 1) => |a, _| {
            let what = text(a.first()?)?;
            Some(Value::failed(StepCause::NotFinite { what }))
        },
        ("StartError::Refused", 1) => |a, _| match a.first()? {
            Value::Failed(e) => {
                let cause = (**e).clone().cause();
                Some(Value::failed(clebsch::StartError::Refused(cause)))
            }
            _ => None,
        },
        ("at_node", 2) => |a, _| match (a.first()?, a.get(1)?) {
            (Value::Failed(e), Value::Int(node)) => {
                let cause = (**e).clone().cause();
                Some(Value::failed(cause.at_node(u64::try_from(*node).ok()?)))
            }
            _ => None,
        },
        ("in_field", 2) => |a, _| match (a.first()?, a.get(1)?) {
            (Value::Failed(e), Value::Text(field)) => {
                Some(Value::failed((**e).clone().in_field(field)))
            }
            _ => None,
        },
        ("alike", 2) => |a, _| match (a.first()?, a.get(1)?) {
            (Value::Search(search), Value::Search(like)) => Some(Value::Search(search.alike(like))),
            _ => None,
        },
        // Whether a step is only a trial. A value other than a search is returned unchanged.
        ("tries", 1) => |a, _| match a.first()? {
            Value::Search(search) => Some(Value::Bool(search.tries())),
            other => Some((*other).clone()),
        },
        ("ok", 1) => |a, _| match a.first()? {
            Value::Failed(_) => Some(Value::None),
            other => Some((*other).clone()),
        },
        ("unwrap_or", 2) => |a, _| match a.first()? {
            Value::None => Some((*a.get(1)?).clone()),
            other => Some((*other).clone()),
        },
        // `Ok`, `Some` and `Err` return their content.
        ("Ok", 1) | ("Some", 1) | ("Err", 1) => |a, _| Some((*a.first()?).clone()),
        _ => return None,
    })
}
