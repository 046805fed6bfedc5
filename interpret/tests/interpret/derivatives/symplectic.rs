//! Tangents of steps preserve the canonical form of configurations and momenta, which is typed here in the body frame.

use super::gallery::{cases, open};
use clebsch::card::{Kind, Settings};
use clebsch::derivatives::{Derivatives, Point};
use nalgebra::{DMatrix, Vector3};

/// Rounding of a product of three matrices of up to thirty rows, relative to the form.
const NEAR: f64 = 1e-13;

/// The bracket of two elements of the algebra of a group.
fn bracket(kind: Kind, a: &[f64], b: &[f64]) -> Vec<f64> {
    let v = |x: &[f64]| Vector3::new(x[0], x[1], x[2]);
    match kind {
        Kind::Rotation | Kind::UnitQuaternion => v(a).cross(&v(b)).as_slice().to_vec(),
        Kind::RigidMotion => {
            let turned = v(a).cross(&v(b));
            let moved = v(a).cross(&v(&b[3..])) - v(b).cross(&v(&a[3..]));
            [turned.as_slice(), moved.as_slice()].concat()
        }
        _ => vec![0.0; a.len()],
    }
}

/// The canonical form at a state: `dm(x).w(y) - dm(y).w(x) - m.[w(x), w(y)]` for each configuration. `None` if a field is
/// neither a configuration of these groups nor its momentum.
fn form(flow: &mut dyn Derivatives, at: &Point) -> Option<DMatrix<f64>> {
    let card = flow.card();
    let dimensions = flow.dimensions();
    let n: usize = dimensions.iter().sum();
    let seen = flow.observe(at).expect("observables");
    let value = |name: &str| {
        let mut first = 0;
        for field in card.observables {
            if field.name == name {
                return seen[first..first + field.count()].to_vec();
            }
            first += field.count();
        }
        Vec::new()
    };
    let mut form = DMatrix::zeros(n, n);
    let mut first = 0;
    for (pair, sizes) in card.initial.chunks(2).zip(dimensions.chunks(2)) {
        let ([place, momentum], [size, same]) = (pair, sizes) else {
            return None;
        };
        let kinds = (place.kind, momentum.kind);
        let is_pair = matches!(
            kinds,
            (
                Kind::Rotation | Kind::UnitQuaternion | Kind::RigidMotion,
                Kind::BodyMomentum
            ) | (_, Kind::FieldMomentum)
        );
        let is_known = match place.kind {
            // Rotations given by a skew momentum have other coordinates.
            Kind::Rotation => *size == 3 && momentum.cols == 1,
            Kind::RigidMotion => *size == 6,
            _ => true,
        };
        if !is_pair || !is_known || size != same {
            return None;
        }
        let m = value(momentum.name);
        let unit =
            |k: usize| -> Vec<f64> { (0..*size).map(|i| f64::from(u8::from(i == k))).collect() };
        for i in 0..*size {
            form[(first + size + i, first + i)] = 1.0;
            form[(first + i, first + size + i)] = -1.0;
            for j in 0..*size {
                let bent = bracket(place.kind, &unit(i), &unit(j));
                let along: f64 = m.iter().zip(&bent).map(|(m, x)| m * x).sum();
                form[(first + i, first + j)] -= along;
            }
        }
        first += 2 * size;
    }
    Some(form)
}

#[test]
fn tangents_preserve_the_canonical_form() {
    let mut names = Vec::new();
    for (card, case) in cases(2) {
        let mut flow = open(&card, &case, Settings::step(case.h));
        let mut at = flow.start();
        for _ in 0..5 {
            let Some(before) = form(&mut *flow, &at) else {
                break;
            };
            let (next, tangent) = flow.tangent(&at).expect("a tangent");
            let tangent = DMatrix::from_column_slice(tangent.rows, tangent.cols, &tangent.entries);
            let after = form(&mut *flow, &next).expect("the same fields");
            let pulled = tangent.transpose() * after * &tangent;
            let off = (pulled - &before).amax() / before.amax().max(tangent.amax().powi(2));
            assert!(off < NEAR, "{} {}: {off:e}", card.name, case.name);
            at = next;
            names.push(card.name);
        }
    }
    names.dedup();
    assert!(names.len() >= 7, "{names:?}");
}

/// The form tells a wrong sign: without the bracket, a turning body does not preserve it.
#[test]
fn a_form_without_the_bracket_is_not_preserved() {
    let (card, case) = cases(1)
        .find(|(card, _)| card.name == "HeavyTop")
        .expect("a top");
    let mut flow = open(&card, &case, Settings::step(case.h));
    let at = flow.start();
    let (_, tangent) = flow.tangent(&at).expect("a tangent");
    let tangent = DMatrix::from_column_slice(6, 6, &tangent.entries);
    let mut flat = DMatrix::zeros(6, 6);
    for i in 0..3 {
        flat[(3 + i, i)] = 1.0;
        flat[(i, 3 + i)] = -1.0;
    }
    let pulled = tangent.transpose() * &flat * &tangent;
    assert!((pulled - flat).amax() > 1e-3);
}
