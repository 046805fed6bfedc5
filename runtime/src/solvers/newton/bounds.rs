//! Velocities in bounds: all elements of a group whose coordinates, seen from a centre, do not
//! exceed given lengths.
//! Takes centre and lengths; gives what equations ask of a velocity, in variables chosen such that
//! it is affine in them: a rotation in the sine and the cosine of its angle, no product of them.

use crate::groups::{
    Additive, Group, Linear, Orthogonal, PlaneMotion, RigidMotion, Rotation, UnitQuaternion,
};
use crate::linalg::{left_multiplication, solve_many};
use crate::scalar::Enclosure;
use nalgebra::{SMatrix, SVector};
use num_traits::Zero;

/// All elements near a centre.
pub trait Region<const K: usize>: Sized {
    /// The group.
    type Centre: Group<f64>;

    /// How many variables they take; they begin with a new three.
    const VARIABLES: usize;

    /// The elements `centre . retract(xi)` with the coordinates `xi` of each part no longer than
    /// its radius, in the variables from `first` on.
    fn around(centre: &Self::Centre, radii: &[f64], first: usize) -> Self;

    /// The derivative of `xi -> retract(xi)` seen from the right, as
    /// `retract(xi)^-1 d retract(xi)`: `put(i, j, x)` for the entries that do not vanish.
    fn chart_tangent(radii: &[f64], first: usize, put: &mut impl FnMut(usize, usize, Enclosure<K>));
}

/// How many variables `count` coordinates take.
const fn threes(count: usize) -> usize {
    count.div_ceil(3) * 3
}

fn radius(radii: &[f64], part: usize) -> f64 {
    radii.get(part).copied().unwrap_or(0.0)
}

/// The sine of an angle, at most, and one less its cosine, at most, where twice the tangent of half
/// of it is at most this.
fn angle(radius: f64) -> (f64, f64) {
    let square = 0.25 * radius * radius;
    let sine = if radius < 2.0 {
        radius / (1.0 + square)
    } else {
        1.0
    };
    (sine, 2.0 * square / (1.0 + square))
}

/// A vector of variables no longer than a radius.
fn vector<const K: usize>(radius: f64, first: usize) -> SVector<Enclosure<K>, 3> {
    SVector::from_fn(|i, _| Enclosure::variable(radius, first + i))
}

/// The matrix times a known one from the left.
fn times<const K: usize, const N: usize, const C: usize>(
    a: &SMatrix<f64, N, N>,
    b: &SMatrix<Enclosure<K>, N, C>,
) -> SMatrix<Enclosure<K>, N, C> {
    SMatrix::from_fn(|i, j| {
        (0..N).fold(Enclosure::zero(), |sum, k| sum + b[(k, j)].times(a[(i, k)]))
    })
}

/// Rotations of space by `1 + hat(s) + S`, `s = sin(a) n`, `S = (1 - cos a)(n n^T - 1)`.
#[derive(Clone, Copy, Debug)]
pub struct RotationRegion<const K: usize> {
    matrix: SMatrix<Enclosure<K>, 3, 3>,
}

/// `s`, the diagonal of `S` and the other entries: (2, 3), (3, 1), (1, 2).
fn turn<const K: usize>(radius: f64, first: usize) -> [SVector<Enclosure<K>, 3>; 3] {
    let (sine, rest) = angle(radius);
    // The diagonal is -t (1 - n_i^2), t from 0 to `rest`: no farther than sqrt(3)/2 of `rest` from
    // -1/2; the others are t n_i n_j, no farther than 1/sqrt(3) from 0.
    let middle = Enclosure::exactly(-0.5 * rest);
    let diagonal = vector(0.8661 * rest, first + 3).map(|x: Enclosure<K>| x + middle);
    [
        vector(sine, first),
        diagonal,
        vector(0.5774 * rest, first + 6),
    ]
}

impl<const K: usize> RotationRegion<K> {
    /// The matrices.
    #[must_use]
    pub fn matrix(&self) -> SMatrix<Enclosure<K>, 3, 3> {
        self.matrix
    }
}

impl<const K: usize> Region<K> for RotationRegion<K> {
    type Centre = Rotation<f64>;
    const VARIABLES: usize = 9;

    fn around(centre: &Rotation<f64>, radii: &[f64], first: usize) -> Self {
        let [s, d, o] = turn(radius(radii, 0), first);
        let one = Enclosure::exactly(1.0);
        let turned = SMatrix::from_fn(|i, j| {
            let k = 3 - (i + j).min(3);
            match (j + 3 - i) % 3 {
                0 => one + d[i],
                1 => o[k] - s[k],
                _ => o[k] + s[k],
            }
        });
        Self {
            matrix: times(&centre.matrix(), &turned),
        }
    }

    /// `(1 - hat(xi)/2) / (1 + |xi|^2/4)`, which is `(1 + tr R)/4` less half the skew part of `R`.
    fn chart_tangent(
        radii: &[f64],
        first: usize,
        put: &mut impl FnMut(usize, usize, Enclosure<K>),
    ) {
        let [s, d, _] = turn::<K>(radius(radii, 0), first);
        let trace = Enclosure::exactly(1.0) + (d[0] + d[1] + d[2]).times(0.25);
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            put(i, i, trace);
            put(i, j, s[k].times(0.5));
            put(j, i, s[k].times(-0.5));
        }
    }
}

/// Unit quaternions.
#[derive(Clone, Copy, Debug)]
pub struct QuaternionRegion<const K: usize> {
    components: SVector<Enclosure<K>, 4>,
}

/// Real and imaginary part.
fn half_turn<const K: usize>(
    radius: f64,
    first: usize,
) -> (Enclosure<K>, SVector<Enclosure<K>, 3>) {
    let cosine = 1.0 / (1.0 + 0.25 * radius * radius).sqrt();
    let real = Enclosure::exactly(0.5 * (1.0 + cosine))
        + Enclosure::variable(0.5 * (1.0 - cosine), first + 3);
    (real, vector(0.5 * radius * cosine, first))
}

impl<const K: usize> QuaternionRegion<K> {
    /// The real parts.
    #[must_use]
    pub fn real(&self) -> Enclosure<K> {
        self.components[0]
    }

    /// The imaginary parts.
    #[must_use]
    pub fn imaginary(&self) -> SVector<Enclosure<K>, 3> {
        let [[_, x, y, z]] = self.components.data.0;
        SVector::<_, 3>::new(x, y, z)
    }

    /// The matrices of the left multiplication.
    #[must_use]
    pub fn matrix(&self) -> SMatrix<Enclosure<K>, 4, 4> {
        let [components] = self.components.data.0;
        left_multiplication(components)
    }
}

impl<const K: usize> Region<K> for QuaternionRegion<K> {
    type Centre = UnitQuaternion<f64>;
    const VARIABLES: usize = 6;

    fn around(centre: &UnitQuaternion<f64>, radii: &[f64], first: usize) -> Self {
        let (w, v) = half_turn(radius(radii, 0), first);
        let turned = SVector::<Enclosure<K>, 4>::new(w, v[0], v[1], v[2]);
        Self {
            components: times(&centre.matrix(), &turned),
        }
    }

    /// That of the rotation, `w (w - hat(v))`.
    fn chart_tangent(
        radii: &[f64],
        first: usize,
        put: &mut impl FnMut(usize, usize, Enclosure<K>),
    ) {
        let (w, v) = half_turn::<K>(radius(radii, 0), first);
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            put(i, i, w * w);
            put(i, j, w * v[k]);
            put(j, i, -(w * v[k]));
        }
    }
}

/// Rigid motions.
#[derive(Clone, Copy, Debug)]
pub struct MotionRegion<const K: usize> {
    /// The rotations.
    pub rotation: RotationRegion<K>,
    /// The translations.
    pub translation: SVector<Enclosure<K>, 3>,
}

impl<const K: usize> MotionRegion<K> {
    /// The homogeneous matrices.
    #[must_use]
    pub fn matrix(&self) -> SMatrix<Enclosure<K>, 4, 4> {
        SMatrix::from_fn(|i, j| match (i, j) {
            (3, _) => Enclosure::exactly(f64::from(u8::from(j == 3))),
            (_, 3) => self.translation[i],
            _ => self.rotation.matrix[(i, j)],
        })
    }
}

impl<const K: usize> Region<K> for MotionRegion<K> {
    type Centre = RigidMotion<f64>;
    const VARIABLES: usize = 12;

    fn around(centre: &RigidMotion<f64>, radii: &[f64], first: usize) -> Self {
        let rotation = RotationRegion::around(&centre.rotation, radii, first);
        let shift = vector(radius(radii, 1), first + 9);
        let middle = centre.translation.map(Enclosure::exactly);
        Self {
            rotation,
            translation: middle + times(&centre.rotation.matrix(), &shift),
        }
    }

    /// That of the rotation, and the inverse rotation for the translation.
    fn chart_tangent(
        radii: &[f64],
        first: usize,
        put: &mut impl FnMut(usize, usize, Enclosure<K>),
    ) {
        RotationRegion::chart_tangent(radii, first, put);
        let turn = RotationRegion::<K>::around(&Rotation::identity(), radii, first).matrix;
        for i in 0..3 {
            for j in 0..3 {
                put(3 + i, 3 + j, turn[(j, i)]);
            }
        }
    }
}

/// Rigid motions of the plane.
#[derive(Clone, Copy, Debug)]
pub struct PlaneMotionRegion<const K: usize> {
    rotation: SMatrix<Enclosure<K>, 2, 2>,
    /// The translations.
    pub translation: SVector<Enclosure<K>, 2>,
}

impl<const K: usize> PlaneMotionRegion<K> {
    /// The homogeneous matrices.
    #[must_use]
    pub fn matrix(&self) -> SMatrix<Enclosure<K>, 3, 3> {
        SMatrix::from_fn(|i, j| match (i, j) {
            (2, _) => Enclosure::exactly(f64::from(u8::from(j == 2))),
            (_, 2) => self.translation[i],
            _ => self.rotation[(i, j)],
        })
    }

    /// Sine and cosine of the angle, each by a variable of its own.
    fn angle(radii: &[f64], first: usize) -> [Enclosure<K>; 2] {
        let (sine, rest) = angle(radius(radii, 0));
        let middle = Enclosure::exactly(1.0 - 0.5 * rest);
        [
            Enclosure::variable(sine, first),
            middle + Enclosure::variable(0.5 * rest, first + 3),
        ]
    }

    fn turn(radii: &[f64], first: usize) -> SMatrix<Enclosure<K>, 2, 2> {
        let [sine, cosine] = Self::angle(radii, first);
        SMatrix::<_, 2, 2>::new(cosine, -sine, sine, cosine)
    }
}

impl<const K: usize> Region<K> for PlaneMotionRegion<K> {
    type Centre = PlaneMotion<f64>;
    const VARIABLES: usize = 9;

    fn around(centre: &PlaneMotion<f64>, radii: &[f64], first: usize) -> Self {
        let turn = centre.rotation.matrix();
        let shift = SVector::<Enclosure<K>, 2>::from_fn(|i, _| {
            Enclosure::variable(radius(radii, 1), first + 6 + i)
        });
        Self {
            rotation: times(&turn, &Self::turn(radii, first)),
            translation: centre.translation.map(Enclosure::exactly) + times(&turn, &shift),
        }
    }

    /// Half of `1 + cos a` for the angle, whose coordinate is twice the tangent of half of it, and the
    /// inverse rotation for the translation.
    fn chart_tangent(
        radii: &[f64],
        first: usize,
        put: &mut impl FnMut(usize, usize, Enclosure<K>),
    ) {
        let [_, cosine] = Self::angle(radii, first);
        put(0, 0, (Enclosure::exactly(1.0) + cosine).times(0.5));
        let turn = Self::turn(radii, first);
        for i in 0..2 {
            for j in 0..2 {
                put(1 + i, 1 + j, turn[(j, i)]);
            }
        }
    }
}

/// Invertible matrices.
#[derive(Clone, Copy, Debug)]
pub struct LinearRegion<const N: usize, const K: usize> {
    matrix: SMatrix<Enclosure<K>, N, N>,
}

impl<const N: usize, const K: usize> LinearRegion<N, K> {
    /// The matrices.
    #[must_use]
    pub fn matrix(&self) -> SMatrix<Enclosure<K>, N, N> {
        self.matrix
    }

    fn near_one(radii: &[f64], first: usize) -> SMatrix<Enclosure<K>, N, N> {
        let radius = radius(radii, 0);
        SMatrix::from_fn(|i, j| {
            let one = Enclosure::exactly(f64::from(u8::from(i == j)));
            one + Enclosure::variable(radius, first + N * i + j)
        })
    }
}

impl<const N: usize, const K: usize> Region<K> for LinearRegion<N, K> {
    type Centre = Linear<N, f64>;
    const VARIABLES: usize = threes(N * N);

    fn around(centre: &Linear<N, f64>, radii: &[f64], first: usize) -> Self {
        Self {
            matrix: times(&centre.matrix(), &Self::near_one(radii, first)),
        }
    }

    /// `dX -> (1 + X)^-1 dX`.
    fn chart_tangent(
        radii: &[f64],
        first: usize,
        put: &mut impl FnMut(usize, usize, Enclosure<K>),
    ) {
        let back = inverse(&Self::near_one(radii, first));
        for i in 0..N {
            for k in 0..N {
                for j in 0..N {
                    put(N * i + j, N * k + j, back[(i, k)]);
                }
            }
        }
    }
}

/// Increments of a field.
#[derive(Clone, Copy, Debug)]
pub struct AdditiveRegion<const R: usize, const C: usize, const K: usize> {
    array: SMatrix<Enclosure<K>, R, C>,
}

impl<const R: usize, const C: usize, const K: usize> AdditiveRegion<R, C, K> {
    /// The increments.
    #[must_use]
    pub fn matrix(&self) -> SMatrix<Enclosure<K>, R, C> {
        self.array
    }
}

impl<const R: usize, const C: usize, const K: usize> Region<K> for AdditiveRegion<R, C, K> {
    type Centre = Additive<R, C, f64>;
    const VARIABLES: usize = threes(R * C);

    fn around(centre: &Additive<R, C, f64>, radii: &[f64], first: usize) -> Self {
        let (radius, middle) = (radius(radii, 0), centre.matrix());
        let entry = |i: usize, j: usize| {
            Enclosure::exactly(middle[(i, j)]) + Enclosure::variable(radius, first + C * i + j)
        };
        Self {
            array: SMatrix::from_fn(entry),
        }
    }

    /// The coordinates are the increments.
    fn chart_tangent(_: &[f64], _: usize, put: &mut impl FnMut(usize, usize, Enclosure<K>)) {
        for k in 0..R * C {
            put(k, k, Enclosure::exactly(1.0));
        }
    }
}

/// Rotations in `N` dimensions.
#[derive(Clone, Copy, Debug)]
pub struct OrthogonalRegion<const N: usize, const K: usize> {
    matrix: SMatrix<Enclosure<K>, N, N>,
}

/// The pairs `i < j` of axes, row by row.
fn pairs<const N: usize>() -> impl Iterator<Item = (usize, usize)> {
    (0..N).flat_map(|i| (i + 1..N).map(move |j| (i, j)))
}

impl<const N: usize, const K: usize> OrthogonalRegion<N, K> {
    /// The matrices.
    #[must_use]
    pub fn matrix(&self) -> SMatrix<Enclosure<K>, N, N> {
        self.matrix
    }

    /// `(1 - X/2)^-1`: the Cayley map is twice that less one.
    fn root(radii: &[f64], first: usize) -> SMatrix<Enclosure<K>, N, N> {
        let half = 0.5 * radius(radii, 0);
        let one = Enclosure::exactly(1.0);
        let mut a = SMatrix::from_diagonal_element(one);
        for (k, (i, j)) in pairs::<N>().enumerate() {
            let x = Enclosure::variable(half, first + k);
            a[(i, j)] = x;
            a[(j, i)] = -x;
        }
        inverse(&a)
    }
}

impl<const N: usize, const K: usize> Region<K> for OrthogonalRegion<N, K> {
    type Centre = Orthogonal<N, f64>;
    const VARIABLES: usize = threes(N * N.saturating_sub(1) / 2);

    fn around(centre: &Orthogonal<N, f64>, radii: &[f64], first: usize) -> Self {
        let one = SMatrix::from_diagonal_element(Enclosure::exactly(1.0));
        let turned = Self::root(radii, first).map(|x| x.times(2.0)) - one;
        Self {
            matrix: times(&centre.matrix(), &turned),
        }
    }

    /// `dX -> (1 + X/2)^-1 dX (1 - X/2)^-1`.
    fn chart_tangent(
        radii: &[f64],
        first: usize,
        put: &mut impl FnMut(usize, usize, Enclosure<K>),
    ) {
        let p = Self::root(radii, first);
        for (row, (i, j)) in pairs::<N>().enumerate() {
            for (column, (k, l)) in pairs::<N>().enumerate() {
                // The entry (j, i) of p^T (e_l e_k^T - e_k e_l^T) p.
                put(row, column, p[(l, j)] * p[(k, i)] - p[(k, j)] * p[(l, i)]);
            }
        }
    }
}

/// The inverse; unbounded where there may be none.
fn inverse<const N: usize, const K: usize>(
    a: &SMatrix<Enclosure<K>, N, N>,
) -> SMatrix<Enclosure<K>, N, N> {
    let one = SMatrix::from_diagonal_element(Enclosure::exactly(1.0));
    let unknown = Enclosure::around(f64::NAN, f64::NAN);
    solve_many(a, &one).unwrap_or_else(|| SMatrix::repeat(unknown))
}

impl<R: Region<K>, const COUNT: usize, const K: usize> Region<K> for [R; COUNT] {
    type Centre = [R::Centre; COUNT];
    const VARIABLES: usize = COUNT * R::VARIABLES;

    fn around(centre: &Self::Centre, radii: &[f64], first: usize) -> Self {
        core::array::from_fn(|i| {
            let own = radii.get(i * R::Centre::PARTS..).unwrap_or(&[]);
            R::around(&centre[i], own, first + i * R::VARIABLES)
        })
    }

    fn chart_tangent(
        radii: &[f64],
        first: usize,
        put: &mut impl FnMut(usize, usize, Enclosure<K>),
    ) {
        for i in 0..COUNT {
            let own = radii.get(i * R::Centre::PARTS..).unwrap_or(&[]);
            let at = i * R::Centre::DIMENSION;
            R::chart_tangent(own, first + i * R::VARIABLES, &mut |row, column, x| {
                put(at + row, at + column, x);
            });
        }
    }
}

/// Different groups side by side.
macro_rules! regions_of {
    ($($region:ident $index:tt),+) => {
        impl<const K: usize, $($region: Region<K>),+> Region<K> for ($($region,)+) {
            type Centre = ($($region::Centre,)+);
            const VARIABLES: usize = 0 $(+ $region::VARIABLES)+;

            fn around(centre: &Self::Centre, radii: &[f64], first: usize) -> Self {
                let (mut part, mut next) = (0, first);
                ($({
                    let own = radii.get(part..).unwrap_or(&[]);
                    let region = $region::around(&centre.$index, own, next);
                    part += $region::Centre::PARTS;
                    next += $region::VARIABLES;
                    let _ = (part, next);
                    region
                },)+)
            }

            fn chart_tangent(
                radii: &[f64],
                first: usize,
                put: &mut impl FnMut(usize, usize, Enclosure<K>),
            ) {
                let (mut part, mut next, mut at) = (0, first, 0);
                $(
                    let own = radii.get(part..).unwrap_or(&[]);
                    $region::chart_tangent(own, next, &mut |row, column, x| {
                        put(at + row, at + column, x);
                    });
                    part += $region::Centre::PARTS;
                    next += $region::VARIABLES;
                    at += $region::Centre::DIMENSION;
                )+
                let _ = (part, next, at);
            }
        }
    };
}

regions_of!(A 0, B 1);
regions_of!(A 0, B 1, C 2);
regions_of!(A 0, B 1, C 2, D 3);
regions_of!(A 0, B 1, C 2, D 3, E 4);
regions_of!(A 0, B 1, C 2, D 3, E 4, F 5);
