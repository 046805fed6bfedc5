//! Signs of unit quaternions along a chain. `q` and `-q` are the same attitude. If neighbours differ in sign, a term
//! with the real part of `q* p` stores the energy of a full turn. Signs are therefore made consistent at the start of a
//! trajectory. Takes attitudes in order along the chain; changes signs, or reports that they cannot be consistent
//! around a ring.

use super::Attitudes;
use crate::error::Problem;
use crate::linalg::{quaternion_imaginary, quaternion_real};
use crate::{ParameterError, Real};
use nalgebra::Matrix4;

/// The scalar product of two quaternions.
fn pairing<T: Real>(a: [T; 4], b: [T; 4]) -> T {
    let [a0, a1, a2, a3] = a;
    let [b0, b1, b2, b3] = b;
    (a0 * b0 + a1 * b1) + (a2 * b2 + a3 * b3)
}

/// In each lane, -1 if the number is negative, otherwise 1.
fn sign<T: Real>(x: T) -> T {
    let sign = x.sign();
    sign + (T::one() - sign * sign)
}

/// Negates each unit quaternion whose scalar product with the previous one is negative.
pub fn agree<T: Real>(list: &mut Attitudes<T>) {
    let mut before: Option<[T; 4]> = None;
    for site in 0..list.len() {
        let x = list.at(site);
        let own = x.unit_quaternion().components();
        let x = before.map_or(x, |before| x.of_sign(sign(pairing(before, own))));
        list.set(site, x);
        before = Some(x.unit_quaternion().components());
    }
}

/// Negates all quaternions if the scalar product of the quaternion at `site` with a prescribed end quaternion is
/// negative. `wall` is the matrix of left multiplication by the end quaternion.
pub fn turn_towards<T: Real>(list: &mut Attitudes<T>, site: usize, wall: &Matrix4<T>) {
    let v = quaternion_imaginary(wall);
    let wall = [quaternion_real(wall), v.x, v.y, v.z];
    if site < list.len() {
        let sign = sign(pairing(wall, list.at(site).unit_quaternion().components()));
        for site in 0..list.len() {
            list.set(site, list.at(site).of_sign(sign));
        }
    }
}

/// Checks that the signs of the last and the first quaternion are consistent.
///
/// # Errors
/// Fails if they are not: the attitudes make an odd number of turns around the ring.
pub fn closes<T: Real>(quantity: &'static str, list: &Attitudes<T>) -> Result<(), ParameterError> {
    if list.is_empty() {
        return Ok(());
    }
    let (first, last) = (list.at(0), list.at(list.len() - 1));
    let [first, last] = [first, last].map(|x| x.unit_quaternion().components());
    match pairing(first, last).least() < 0.0 {
        true => Err(ParameterError {
            field: quantity,
            problem: Problem::SignAroundRing,
            remedy: "make the coupling of neighbours even in each quaternion, with products of two components of \
                im(q^T*next(q, i)), or give attitudes that make an even number of turns",
        }),
        false => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::{agree, closes, turn_towards};
    use crate::line::{Attitude, Attitudes};
    use crate::{Rotation, UnitQuaternion};
    use nalgebra::Vector3;

    /// Attitudes that make `turns` turns along the list, with random signs.
    fn turning(turns: f64, count: usize) -> Attitudes<f64> {
        let each = (0..count).map(|i| {
            let half = std::f64::consts::PI * turns * i as f64 / count as f64;
            let sign = if i * i % 7 < 3 { 1.0 } else { -1.0 };
            let q = [half.cos(), half.sin(), 0.0, 0.0].map(|x| x * sign);
            Attitude::of_quaternion(UnitQuaternion::from_components(q).expect("of unit length"))
        });
        each.collect()
    }

    #[test]
    fn signs_agree_from_site_to_site_and_attitudes_stay() {
        for turns in [0.3, 1.0, 2.0, 5.0] {
            let given = turning(turns, 40);
            let mut list = given.clone();
            agree(&mut list);
            for site in 1..list.len() {
                let [a, b] = [site - 1, site].map(|i| list.at(i).unit_quaternion());
                assert!((a.inverse() * b).real() > 0.0);
                assert_eq!(list.at(site).matrix(), given.at(site).matrix());
            }
            let before = list.clone();
            agree(&mut list);
            assert_eq!(list, before);
        }
    }

    #[test]
    fn an_odd_number_of_turns_around_a_ring_is_told() {
        for (turns, is_odd) in [(0.0, false), (1.0, true), (2.0, false), (3.0, true)] {
            let mut list = turning(turns, 40);
            agree(&mut list);
            let told = closes("q", &list);
            assert_eq!(told.is_err(), is_odd, "{turns} turns: {told:?}");
        }
    }

    #[test]
    fn a_line_turns_towards_what_an_end_gives() {
        let wall = Rotation::exp(&Vector3::new(0.1, 0.2, -0.1)).quaternion();
        for sign in [1.0, -1.0] {
            let wall = UnitQuaternion::from_components(wall.map(|x| x * sign)).expect("a wall");
            let mut list = turning(0.2, 5);
            agree(&mut list);
            turn_towards(&mut list, 0, &wall.matrix());
            assert!((wall.inverse() * list.at(0).unit_quaternion()).real() > 0.0);
        }
    }
}
