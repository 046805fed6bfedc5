//! Quantities as arrays of a file: numbers and vectors unchanged, attitudes as the axes of their bodies.
//! Takes the columns of a quantity at every point or cell; gives its arrays for a sample.

use crate::output::attitude::matrix;
use clebsch::card::{Field, Kind};
use clebsch::record::vtk::Values;
use std::ops::Range;

/// A quantity at every point or at every cell.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    /// The name in files.
    pub name: String,
    /// The prefix of the names of its axes; empty if there is only one body.
    pub prefix: String,
    pub kind: Kind,
    pub rows: usize,
    pub cols: usize,
    /// The columns at each point or cell; `None` if the value is unknown.
    pub at: Vec<Option<Range<usize>>>,
}

impl Columns {
    /// A quantity of a field's shape.
    pub(super) fn of(name: &str, field: &Field, at: Vec<Option<Range<usize>>>) -> Self {
        Columns {
            name: name.to_owned(),
            prefix: String::new(),
            kind: field.kind,
            rows: field.rows,
            cols: field.cols,
            at,
        }
    }

    /// The arrays of a sample.
    pub(super) fn values(&self, row: &[f64]) -> Vec<Values> {
        let count = self.rows * self.cols;
        let unknown = vec![f64::NAN; count];
        let each = self.at.iter().map(|at| {
            let own = at.as_ref().and_then(|at| row.get(at.clone()));
            own.unwrap_or(&unknown)
        });
        if axes(self.kind, [self.rows, self.cols], &unknown).is_some() {
            let frames: Vec<[[f64; 3]; 3]> = each
                .map(|own| axes(self.kind, [self.rows, self.cols], own).unwrap_or_default())
                .collect();
            let one = |d: usize| {
                let vectors: Vec<[f64; 3]> = frames.iter().map(|f| f[d]).collect();
                Values::vectors(&format!("{}d{}", self.prefix, d + 1), &vectors)
            };
            return (0..3).map(one).collect();
        }
        if self.cols == 1 && [2, 3].contains(&self.rows) {
            let vectors: Vec<[f64; 3]> = each.map(in_space).collect();
            return vec![Values::vectors(&self.name, &vectors)];
        }
        let split = self.is_motion().then_some(self.rows / 2);
        if let Some(3) = split {
            // Angular, then linear.
            let part = |from: usize| -> Vec<[f64; 3]> {
                let own = self.at.iter().map(|at| {
                    let own = at.as_ref().and_then(|at| row.get(at.clone()));
                    in_space(
                        own.and_then(|x| x.get(from..from + 3))
                            .unwrap_or(&[f64::NAN; 3]),
                    )
                });
                own.collect()
            };
            return vec![
                Values::vectors(&self.name, &part(0)),
                Values::vectors(&format!("{}_linear", self.name), &part(3)),
            ];
        }
        vec![Values {
            name: self.name.clone(),
            components: count,
            numbers: each.flatten().copied().collect(),
        }]
    }

    /// Whether it is the momentum of a rigid motion in space.
    fn is_motion(&self) -> bool {
        let momentum = [Kind::BodyMomentum, Kind::SpatialMomentum].contains(&self.kind);
        momentum && self.rows == 6 && self.cols == 1
    }
}

/// A vector of the plane or of space.
pub(super) fn in_space(own: &[f64]) -> [f64; 3] {
    let mut out = [0.0; 3];
    out.iter_mut().zip(own).for_each(|(out, x)| *out = *x);
    out
}

/// The axes of a body in space: the images of the unit vectors of its own frame.
pub(super) fn axes(kind: Kind, [rows, cols]: [usize; 2], own: &[f64]) -> Option<[[f64; 3]; 3]> {
    let entry = |i: usize, j: usize| own.get(i * cols + j).copied().unwrap_or(f64::NAN);
    let plane = || {
        [
            [entry(0, 0), entry(1, 0), 0.0],
            [entry(0, 1), entry(1, 1), 0.0],
            [0.0, 0.0, 1.0],
        ]
    };
    let space = || [0, 1, 2].map(|j| [0, 1, 2].map(|i| entry(i, j)));
    match (kind, rows, cols) {
        (Kind::UnitQuaternion, ..) => {
            let turn = matrix(own)?;
            Some([0, 1, 2].map(|j| [0, 1, 2].map(|i| turn[(i, j)])))
        }
        (Kind::Rotation | Kind::Matrix, 3, 3) | (Kind::RigidMotion, 4, 4) => Some(space()),
        (Kind::Rotation, 2, 2) | (Kind::RigidMotion, 3, 3) => Some(plane()),
        _ => None,
    }
}

/// The image of the origin under a rigid motion.
pub(super) fn place(kind: Kind, size: usize, own: &[f64]) -> Option<[f64; 3]> {
    let entry = |i: usize| own.get(i * size + size - 1).copied().unwrap_or(f64::NAN);
    match (kind, size) {
        (Kind::RigidMotion, 4) => Some([entry(0), entry(1), entry(2)]),
        (Kind::RigidMotion, 3) => Some([entry(0), entry(1), 0.0]),
        _ => None,
    }
}

/// If there are several bodies, the names of their axes start with the name of the body.
pub(super) fn name_axes(all: &mut [Columns]) {
    let turns = |c: &Columns| axes(c.kind, [c.rows, c.cols], &[f64::NAN; 16]).is_some();
    if all.iter().filter(|c| turns(c)).count() > 1 {
        for own in all.iter_mut().filter(|c| turns(c)) {
            own.prefix = format!("{}_", own.name);
        }
    }
}
