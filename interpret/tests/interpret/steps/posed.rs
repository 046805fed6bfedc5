//! Data of a card as the oracle has them: elements exactly in their groups, momenta along the directions of a basis.
//! Takes values of a card; gives a problem to solve, and the numbers that a state shows.

use super::data::{Data, Draw, moving};
use super::row::Row;
use clebsch::card::{Card, Field, Kind};
use clebsch_oracle::oracle::action::quaternions::left;
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::pair::Pair;
use clebsch_oracle::oracle::sides::Side;
use clebsch_oracle::oracle::step::group;
use clebsch_oracle::oracle::step::{Block, Motion, Problem, Table};

/// The basis of a group, from the fields of its element and its momentum.
fn basis(element: &Field, momentum: &Field) -> Motion {
    let side = match momentum.kind {
        Kind::SpatialMomentum => Side::Space,
        Kind::BodyMomentum => Side::Body,
        _ => return Motion::Added,
    };
    let basis = match element.kind {
        Kind::Rotation => group::rotations(element.rows),
        Kind::UnitQuaternion => group::quaternions(),
        Kind::RigidMotion => group::rigid_motions(element.rows - 1),
        _ => group::linear_maps(element.rows),
    };
    Motion::Turned(basis, side)
}

/// An element in 32 digits, as a matrix; exactly in its group.
pub fn element(field: &Field, list: &[f64]) -> Vec<Pair> {
    let exact = |list: &[f64]| list.iter().map(|x| Pair::constant(*x)).collect::<Vec<_>>();
    match field.kind {
        Kind::Rotation => group::orthogonal(field.rows, list),
        Kind::UnitQuaternion => {
            let q = exact(list);
            let each = q.iter().map(|x| *x * *x);
            let length = each.fold(Pair::constant(0.0), |a, b| a + b).sqrt();
            let q = std::array::from_fn(|i| q[i] / length);
            left(q).0.concat()
        }
        Kind::RigidMotion => {
            let n = field.rows;
            let turn: Vec<f64> = (0..n - 1)
                .flat_map(|i| list[i * n..i * n + n - 1].to_vec())
                .collect();
            let turn = group::orthogonal(n - 1, &turn);
            let mut out = exact(list);
            for (k, x) in turn.into_iter().enumerate() {
                out[k / (n - 1) * n + k % (n - 1)] = x;
            }
            out
        }
        _ => exact(list),
    }
}

/// The output for an element, as a matrix that is not moved into its group.
pub fn shown(field: &Field, list: &[f64]) -> Vec<Pair> {
    match field.kind {
        Kind::UnitQuaternion => {
            let q = std::array::from_fn(|i| Pair::constant(list[i]));
            left(q).0.concat()
        }
        _ => list.iter().map(|x| Pair::constant(*x)).collect(),
    }
}

/// A momentum along the directions of its basis: of skew matrices the entries below the diagonal.
pub fn along(element: &Field, momentum: &Field, list: &[f64]) -> Vec<f64> {
    let n = momentum.rows;
    match element.kind == Kind::Rotation && momentum.cols == n && n > 1 {
        true => {
            let pairs = (0..n).flat_map(|i| (0..i).map(move |j| i * n + j));
            pairs.map(|k| list[k]).collect()
        }
        false => list.to_vec(),
    }
}

/// The starts that differ from this start by a small rotation: one for each direction of each group element.
pub fn turned(card: &Card, data: &Data, problem: &Problem, by: f64) -> Vec<(String, Data)> {
    let mut out = Vec::new();
    let all = moving(card).into_iter().filter(|(_, p)| p.is_some());
    for (block, (i, _)) in problem.blocks.iter().zip(all) {
        let field = &card.initial[i];
        if !matches!(block.motion, Motion::Turned(..)) {
            continue;
        }
        for k in 0..block.directions() {
            let mut along = vec![Pair::constant(0.0); block.directions()];
            along[k] = Pair::constant(by);
            let value = block.moved(&problem.start[block.at..block.at + block.size()], &along);
            let mut wrong = data.clone();
            wrong.initial[i] = match field.kind {
                Kind::UnitQuaternion => (0..4).map(|j| value[4 * j].high).collect(),
                _ => value.iter().map(|x| x.high).collect(),
            };
            out.push((format!("{} turned[{k}]", field.name), wrong));
        }
    }
    out
}

/// These data as a problem of the oracle.
pub fn problem(row: &Row, card: &Card, draw: &Draw, data: &Data) -> Problem {
    let mut names = Table::default();
    let mut given = Vec::new();
    for (field, list) in card.parameters.iter().zip(&data.parameters) {
        names.push(field.name, 1, [field.rows, field.cols]);
        given.extend(list.iter().map(|x| Pair::constant(*x)));
    }
    let mut all = Table::default();
    let (mut blocks, mut momenta) = (Vec::new(), Vec::new());
    let (mut told, mut start) = (Vec::new(), Vec::new());
    for (i, p) in moving(card) {
        let own = &card.initial[i];
        let value = element(own, &data.initial[i]);
        let size = match own.kind {
            Kind::UnitQuaternion => [4, 4],
            _ => [own.rows, own.cols],
        };
        let Some(p) = p else {
            names.push(own.name, 1, size);
            given.extend(value);
            continue;
        };
        let at = all.count;
        all.push(own.name, 1, size);
        told.extend(shown(own, &data.initial[i]));
        start.extend(value);
        blocks.push(Block {
            site: 0,
            at,
            rows: size[0],
            cols: size[1],
            motion: basis(own, &card.initial[p]),
        });
        let own = along(own, &card.initial[p], &data.initial[p]);
        momenta.extend(own.into_iter().map(Pair::constant));
    }
    Problem {
        action: row.action,
        h: draw.h,
        names,
        given,
        moving: all,
        blocks,
        told,
        start,
        momenta,
        reach: None,
    }
}

/// The output for a state in the form of the oracle: moving quantities, and momenta.
pub fn observed(card: &Card, all: &[f64]) -> (Vec<Pair>, Vec<f64>) {
    let seen = |name: &str| {
        let mut from = 0;
        for field in card.observables {
            if field.ascii == name {
                return &all[from..from + field.count()];
            }
            from += field.count();
        }
        panic!("`{name}` is not shown")
    };
    let (mut head, mut momenta) = (Vec::new(), Vec::new());
    for (i, p) in moving(card) {
        let Some(p) = p else { continue };
        let (own, p) = (&card.initial[i], &card.initial[p]);
        head.extend(shown(own, seen(own.ascii)));
        momenta.extend(along(own, p, seen(p.ascii)));
    }
    (head, momenta)
}
