//! Random data of a card.
//! Takes a card, scales and a source; gives parameters and initial values.

use super::row::Row;
use clebsch::card::{Card, Field, Kind};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::Square;

/// The settings of one draw.
#[derive(Clone, Copy, Debug)]
pub struct Draw {
    pub h: f64,
    pub mass: f64,
    pub momentum: f64,
    /// Whether elements start at the identity and positions near zero, where increments have all digits.
    pub fine: bool,
}

/// Values of a card.
#[derive(Clone, Debug)]
pub struct Data {
    pub parameters: Vec<Vec<f64>>,
    pub initial: Vec<Vec<f64>>,
}

pub fn is_momentum(field: &Field) -> bool {
    matches!(
        field.kind,
        Kind::BodyMomentum | Kind::SpatialMomentum | Kind::FieldMomentum
    )
}

fn matrix<const N: usize>(m: Square<f64, N>) -> Vec<f64> {
    m.0.concat()
}

/// A function of the requested size.
macro_rules! sized {
    ($n:expr, $source:ident, $f:ident) => {
        match $n {
            2 => matrix::<2>($source.$f()),
            3 => matrix::<3>($source.$f()),
            4 => matrix::<4>($source.$f()),
            n => panic!("no random matrix of {n} rows"),
        }
    };
}

fn vector(source: &mut Source, count: usize, low: f64) -> Vec<f64> {
    (0..count).map(|_| source.between(low, 1.0)).collect()
}

fn is_one(n: usize) -> Vec<f64> {
    (0..n * n)
        .map(|k| f64::from(u8::from(k / n == k % n)))
        .collect()
}

fn parameter(row: &Row, field: &Field, draw: &Draw, source: &mut Source) -> Vec<f64> {
    let is_inertia = row.inertias.contains(&field.name);
    let is_positive = is_inertia || row.positive.contains(&field.name);
    let mut out = match field.kind {
        Kind::Scalar => vec![source.between(0.4, 1.2)],
        Kind::Symmetric | Kind::SecondMoments if is_positive => {
            sized!(field.rows, source, positive)
        }
        Kind::Symmetric | Kind::SecondMoments => sized!(field.rows, source, symmetric),
        Kind::Diagonal if field.cols > 1 => {
            let entry = |k: usize, source: &mut Source| match k / field.cols == k % field.cols {
                true => source.between(0.3, 1.0),
                false => 0.0,
            };
            (0..field.count()).map(|k| entry(k, source)).collect()
        }
        Kind::Skew => sized!(field.rows, source, skew),
        Kind::Rotation => sized!(field.rows, source, orthogonal),
        _ => vector(source, field.count(), if is_positive { 0.3 } else { -1.0 }),
    };
    if is_inertia {
        out.iter_mut().for_each(|x| *x *= draw.mass);
    }
    out
}

/// The kind of motion of an initial value.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Moves {
    Not,
    Added,
    InGroup,
}

impl Moves {
    /// By its momentum.
    fn of(card: &Card, momentum: Option<usize>) -> Self {
        match momentum.map(|p| card.initial[p].kind) {
            None => Moves::Not,
            Some(Kind::FieldMomentum) => Moves::Added,
            Some(_) => Moves::InGroup,
        }
    }
}

/// An initial value other than a momentum.
fn place(row: &Row, field: &Field, moves: Moves, draw: &Draw, source: &mut Source) -> Vec<f64> {
    let n = field.rows;
    let fine = draw.fine && moves != Moves::Not;
    match field.kind {
        Kind::Rotation if fine => is_one(n),
        Kind::Rotation => sized!(n, source, orthogonal),
        Kind::UnitQuaternion if fine => vec![1.0, 0.0, 0.0, 0.0],
        Kind::UnitQuaternion => {
            let q: [f64; 4] = source.vector();
            let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
            q.map(|x| x / length).to_vec()
        }
        Kind::RigidMotion => {
            let turn = match fine {
                true => is_one(n - 1),
                false => sized!(n - 1, source, orthogonal),
            };
            let entry = |i: usize, j: usize, source: &mut Source| match (i + 1 == n, j + 1 == n) {
                (false, false) => turn[i * (n - 1) + j],
                (false, true) if fine => 0.0,
                (false, true) => source.between(-1.0, 1.0),
                (true, last) => f64::from(u8::from(last)),
            };
            (0..n * n).map(|k| entry(k / n, k % n, source)).collect()
        }
        Kind::Matrix if moves == Moves::InGroup => match fine {
            true => is_one(n),
            false => sized!(n, source, invertible),
        },
        // A quantity that a body advects may be its inertia.
        Kind::Symmetric | Kind::SecondMoments if row.inertias.contains(&field.name) => {
            let own = sized!(n, source, positive);
            own.into_iter().map(|x| x * draw.mass).collect()
        }
        Kind::Symmetric | Kind::SecondMoments => sized!(n, source, symmetric),
        _ if row.positive.contains(&field.name) => vector(source, field.count(), 0.4),
        _ => {
            let size = if fine { 1e-3 } else { 1.0 };
            let list = vector(source, field.count(), -1.0);
            list.into_iter().map(|x| x * size).collect()
        }
    }
}

/// Each initial value, with its momentum if it moves.
pub fn moving(card: &Card) -> Vec<(usize, Option<usize>)> {
    let all = card.initial;
    let own = (0..all.len()).filter(|i| !is_momentum(&all[*i]));
    own.map(|i| {
        (
            i,
            (i + 1 < all.len() && is_momentum(&all[i + 1])).then_some(i + 1),
        )
    })
    .collect()
}

fn momentum(element: &Field, field: &Field, draw: &Draw, source: &mut Source) -> Vec<f64> {
    let n = field.rows;
    let own = match element.kind == Kind::Rotation && field.cols == n && n > 1 {
        true => sized!(n, source, skew),
        false => vector(source, field.count(), -1.0),
    };
    own.into_iter().map(|x| x * draw.momentum).collect()
}

/// Random values of a card.
pub fn drawn(row: &Row, card: &Card, draw: &Draw, source: &mut Source) -> Data {
    let pairs = moving(card);
    let parameters = card.parameters.iter();
    let mut parameters: Vec<Vec<f64>> = parameters
        .map(|f| parameter(row, f, draw, source))
        .collect();
    let mut initial = vec![Vec::new(); card.initial.len()];
    for (i, p) in pairs {
        let own = &card.initial[i];
        initial[i] = place(row, own, Moves::of(card, p), draw, source);
        if let Some(p) = p {
            initial[p] = momentum(own, &card.initial[p], draw, source);
        }
    }
    let fields = card.parameters.iter().chain(card.initial).map(|f| f.name);
    let lists = parameters.iter_mut().chain(&mut initial);
    let mut named = fields.zip(lists.map(std::mem::take)).collect();
    (row.settle)(&mut named);
    let lists = |fields: &[Field]| fields.iter().map(|f| named[f.name].clone()).collect();
    Data {
        parameters: lists(card.parameters),
        initial: lists(card.initial),
    }
}
