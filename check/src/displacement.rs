//! Configurations after a time of motion with given velocities. Takes numbers of a state, velocities and a time; gives the numbers
//! at the end.

use crate::group::{Group, LEFT};
use crate::matrix::Matrix;
use crate::number::{Number, larger};
use crate::stated::{Role, Side};

/// The axes of an angular velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// Components in the body: the rate of change is `R hat(w)`.
    Body,
    /// Components in space: the rate of change is `hat(w) R`.
    Space,
}

/// The velocity of a configuration.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Velocity {
    /// The angular velocity of a rotating configuration, by the components of its momentum.
    pub turning: Option<(Vec<f64>, Frame)>,
    /// The rate of change of a field, of a linear map, or of the position of a rigid motion, by entries.
    pub moving: Option<Vec<f64>>,
}

impl Velocity {
    /// The largest of its numbers.
    #[must_use]
    pub fn size(&self) -> f64 {
        let turning = self.turning.iter().flat_map(|(w, _)| w);
        let moving = self.moving.iter().flatten();
        turning.chain(moving).map(|x| x.abs()).fold(0.0, larger)
    }

    /// Whether nothing moves.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.size() == 0.0
    }
}

/// The numbers of a configuration after `time`; `None` if sizes do not fit.
#[must_use]
pub fn moved(role: &Role, numbers: &[f64], velocity: &Velocity, time: f64) -> Option<Vec<f64>> {
    let shifted = |from: &[f64]| -> Option<Vec<f64>> {
        let Some(rates) = &velocity.moving else {
            return Some(from.to_vec());
        };
        let each = from.iter().zip(rates).map(|(x, v)| x + time * v);
        (from.len() == rates.len()).then(|| each.collect())
    };
    match role {
        Role::Element(Group::Linear(_), _) | Role::Field(_) => shifted(numbers),
        Role::Element(group, _) => {
            let turned = turned(*group, numbers, velocity, time)?;
            let Group::Motion(n) = *group else {
                return Some(turned);
            };
            let of_place = |i: usize| i * (n + 1) + n;
            let place: Option<Vec<f64>> =
                (0..n).map(|i| numbers.get(of_place(i)).copied()).collect();
            let mut out = turned;
            for (i, x) in shifted(&place?)?.into_iter().enumerate() {
                *out.get_mut(of_place(i))? = x;
            }
            Some(out)
        }
        Role::Parameter | Role::Advected => None,
    }
}

/// A velocity by the components of the variation of its configuration; `None` if sizes do not fit.
#[must_use]
pub fn along(role: &Role, numbers: &[f64], velocity: &Velocity) -> Option<Vec<f64>> {
    let (group, side) = match role {
        Role::Element(group, side) => (*group, *side),
        Role::Field(_) => return velocity.moving.clone(),
        Role::Parameter | Role::Advected => return None,
    };
    let n = group.rows();
    let element = group.element(side, numbers, 0.0)?;
    let mut rate = Matrix::from_entries(n, n, |_, _| Number::default());
    if let Some((rates, frame)) = &velocity.turning {
        let mut generator = vec![0.0; n * n];
        for (entries, rate) in group.basis().iter().zip(rates) {
            for (i, j, c) in entries {
                *generator.get_mut(i * n + j)? += rate * c;
            }
        }
        let generator = Matrix::from_entries(n, n, |i, j| {
            Number::exact(generator.get(i * n + j).copied().unwrap_or(f64::NAN))
        });
        rate = match frame {
            Frame::Body => element.times(&generator)?,
            Frame::Space => generator.times(&element)?,
        };
    }
    if let Group::Motion(_) | Group::Linear(_) = group {
        // The last column of a rigid motion changes with the linear velocity, whatever the rotation.
        let moving = velocity.moving.as_deref();
        let of = |i: usize| moving.map_or(0.0, |v| v.get(i).copied().unwrap_or(f64::NAN));
        let is_motion = matches!(group, Group::Motion(_));
        rate = Matrix::from_entries(n, n, |i, j| match (is_motion, j + 1 == n) {
            (true, true) if i + 1 < n => Number::exact(of(i)),
            (true, _) => rate.at(i, j),
            (false, _) => Number::exact(of(i * n + j)),
        });
    }
    let back = group.inverse(&element)?;
    let seen = match side {
        Side::Body => back.times(&rate)?,
        Side::Space => rate.times(&back)?,
    };
    let each = group.basis().into_iter().map(|entries| {
        let (i, j, c) = entries.first().copied()?;
        Some(seen.at(i, j).value / c)
    });
    each.collect()
}

/// An attitude after a rotation; the position of a rigid motion is unchanged.
fn turned(group: Group, numbers: &[f64], velocity: &Velocity, time: f64) -> Option<Vec<f64>> {
    let Some((rates, frame)) = &velocity.turning else {
        return Some(numbers.to_vec());
    };
    let size = match group {
        Group::Rotation(n) | Group::Motion(n) => n,
        Group::Linear(_) | Group::Quaternion => 4,
    };
    // The first elements of the basis are rotations.
    let basis = group.basis();
    let mut generator = vec![0.0; size * size];
    for (entries, rate) in basis.iter().zip(rates) {
        for (i, j, c) in entries {
            *generator.get_mut(i * size + j)? += time * rate * c;
        }
    }
    let turn = exponential(&generator, size);
    let stride = match group {
        Group::Motion(n) => n + 1,
        _ => size,
    };
    let at = |i: usize, j: usize| match group {
        Group::Quaternion => numbers.get(LEFT[i][j].0).map(|x| LEFT[i][j].1 * x),
        _ => numbers.get(i * stride + j).copied(),
    };
    let attitude: Option<Vec<f64>> = (0..size * size).map(|k| at(k / size, k % size)).collect();
    let product = match frame {
        Frame::Body => product(&attitude?, &turn, size),
        Frame::Space => product(&turn, &attitude?, size),
    };
    if group == Group::Quaternion {
        return Some(product.iter().step_by(4).copied().collect());
    }
    let mut out = numbers.to_vec();
    for (k, x) in product.into_iter().enumerate() {
        *out.get_mut(k / size * stride + k % size)? = x;
    }
    Some(out)
}

fn product(a: &[f64], b: &[f64], n: usize) -> Vec<f64> {
    let at = |m: &[f64], i: usize, j: usize| m.get(i * n + j).copied().unwrap_or(f64::NAN);
    let entry = |k: usize| (0..n).map(|l| at(a, k / n, l) * at(b, l, k % n)).sum();
    (0..n * n).map(entry).collect()
}

/// The exponential of a matrix: the series for a fraction of it, squared repeatedly.
fn exponential(x: &[f64], n: usize) -> Vec<f64> {
    const TERMS: u32 = 18;
    let size = x.iter().map(|e| e * e).sum::<f64>().sqrt();
    let mut halvings = 0;
    while size / f64::from(1_u32 << halvings) > 0.5 && halvings < 30 {
        halvings += 1;
    }
    let part: Vec<f64> = x.iter().map(|e| e / f64::from(1_u32 << halvings)).collect();
    let identity: Vec<f64> = (0..n * n)
        .map(|k| f64::from(u8::from(k / n == k % n)))
        .collect();
    // By Horner's scheme: Id + X (Id + X/2 (Id + X/3 (...))).
    let mut out = identity.clone();
    for term in (1..=TERMS).rev() {
        let step = product(&part, &out, n);
        let each = identity.iter().zip(step);
        out = each.map(|(one, x)| one + x / f64::from(term)).collect();
    }
    for _ in 0..halvings {
        out = product(&out, &out, n);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{Frame, Velocity, moved};
    use crate::group::Group;
    use crate::stated::{Role, Side};

    fn off(a: &[f64], b: &[f64]) -> f64 {
        let each = a.iter().zip(b).map(|(x, y)| (x - y).abs());
        each.fold((a.len() != b.len()).into(), f64::max)
    }

    #[test]
    fn attitudes_turn_by_the_angle_about_the_axis() {
        let role = |g| Role::Element(g, Side::Body);
        let about = |w: Vec<f64>, frame| Velocity {
            turning: Some((w, frame)),
            moving: None,
        };
        let quarter = [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        let identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let half_pi = std::f64::consts::FRAC_PI_2;
        let third = about(vec![0.0, 0.0, half_pi / 2.0], Frame::Body);
        let found = moved(&role(Group::Rotation(3)), &identity, &third, 2.0).expect("it fits");
        assert!(off(&found, &quarter) < 1e-15, "{found:?}");
        // A quarter turn about the third axis, then a quarter turn about the first axis of the body, or of space.
        let first = |frame| about(vec![half_pi, 0.0, 0.0], frame);
        let body = moved(
            &role(Group::Rotation(3)),
            &quarter,
            &first(Frame::Body),
            1.0,
        );
        let space = moved(
            &role(Group::Rotation(3)),
            &quarter,
            &first(Frame::Space),
            1.0,
        );
        let of_body = [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let of_space = [0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0];
        assert!(off(&body.expect("it fits"), &of_body) < 1e-15);
        assert!(off(&space.expect("it fits"), &of_space) < 1e-15);
        // A quaternion contains half of the angle.
        let one = [1.0, 0.0, 0.0, 0.0];
        let found = moved(&role(Group::Quaternion), &one, &third, 2.0).expect("it fits");
        let half = std::f64::consts::FRAC_1_SQRT_2;
        assert!(off(&found, &[half, 0.0, 0.0, half]) < 1e-15, "{found:?}");
        // A rigid motion of the plane rotates, and its position moves in space.
        let motion = [1.0, 0.0, 2.0, 0.0, 1.0, 3.0, 0.0, 0.0, 1.0];
        let both = Velocity {
            turning: Some((vec![half_pi], Frame::Body)),
            moving: Some(vec![0.5, -1.0]),
        };
        let found = moved(&role(Group::Motion(2)), &motion, &both, 1.0).expect("it fits");
        let expected = [0.0, -1.0, 2.5, 1.0, 0.0, 2.0, 0.0, 0.0, 1.0];
        assert!(off(&found, &expected) < 1e-15, "{found:?}");
    }
}
