//! Compares generated steppers of fields, of ellipsoids on GL(n) and of four groups together with hand-written steppers: one step
//! from each of five hundred random states. A test checks that the comparison detects a relative change of 1e-6 in every datum.
//! Another test checks the closed form of the rotation of a charge.

use super::groups_against_hand::{System, agree, generated, rigid, stretched};
use clebsch_oracle::handwritten::attitude::{
    Matrix, Quaternion, Vector, apply_transposed, cross, dot,
};
use clebsch_oracle::handwritten::body_n::Square;
use clebsch_oracle::handwritten::charged_particle::{Charge, ChargedParticle};
use clebsch_oracle::handwritten::ellipsoid::{ElasticEllipsoid, Ellipsoid, Of};
use clebsch_oracle::handwritten::kepler::Kepler;
use clebsch_oracle::handwritten::mixed_four::{Four, MixedFour, Momenta, Places};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::physics::measure::worse;
use std::array::from_fn;

/// A random position at distance one from the origin.
fn direction(source: &mut Source) -> Vector {
    let v: Vector = source.vector();
    let length = dot(&v, &v).sqrt();
    v.map(|x| x / length)
}

#[derive(Clone, Copy)]
struct Planet {
    m: f64,
    k: f64,
    place: Vector,
    momentum: Vector,
    h: f64,
}

impl System for Planet {
    const KINDS: usize = 3;

    fn draw(source: &mut Source) -> Self {
        Planet {
            m: source.between(0.5, 2.0),
            k: source.between(0.5, 2.0),
            place: direction(source),
            momentum: source.vector(),
            h: source.between(0.01, 0.1),
        }
    }

    fn nudged(&self, kind: usize, share: f64) -> Self {
        let factor = 1.0 + share;
        let mut moved = *self;
        match kind {
            0 => moved.momentum = stretched(self.momentum, factor),
            1 => moved.m *= factor,
            _ => moved.k *= factor,
        }
        moved
    }

    fn by_hand(&self) -> Option<Vec<f64>> {
        let mut planet = Kepler::start(self.m, self.k, &self.place, &self.momentum, self.h).ok()?;
        planet.step().ok()?;
        Some([planet.place(), planet.momentum()].concat())
    }

    fn generated(&self) -> Option<Vec<f64>> {
        let parameters = [vec![self.m], vec![self.k]];
        let initial = [self.place.to_vec(), self.momentum.to_vec()];
        generated("kepler", &["X", "momentum"], &parameters, &initial, self.h)
    }
}

#[derive(Clone, Copy)]
struct InFields {
    charge: Charge,
    place: Vector,
    momentum: Vector,
    h: f64,
}

impl InFields {
    fn parameters(&self) -> [Vec<f64>; 4] {
        let Charge {
            mass,
            charge,
            magnetic,
            electric,
        } = &self.charge;
        [
            vec![*mass],
            vec![*charge],
            magnetic.to_vec(),
            electric.to_vec(),
        ]
    }
}

impl System for InFields {
    const KINDS: usize = 6;

    fn draw(source: &mut Source) -> Self {
        InFields {
            charge: Charge {
                mass: source.between(0.5, 2.0),
                charge: source.between(0.5, 2.0),
                magnetic: source.vector(),
                electric: source.vector(),
            },
            place: source.vector(),
            momentum: source.vector(),
            h: source.between(0.05, 0.5),
        }
    }

    fn nudged(&self, kind: usize, share: f64) -> Self {
        let factor = 1.0 + share;
        let mut moved = *self;
        let charge = &mut moved.charge;
        match kind {
            0 => moved.momentum = stretched(self.momentum, factor),
            1 => charge.mass *= factor,
            2 => charge.charge *= factor,
            3 => charge.magnetic = stretched(charge.magnetic, factor),
            4 => charge.electric = stretched(charge.electric, factor),
            _ => moved.place = stretched(self.place, factor),
        }
        moved
    }

    fn by_hand(&self) -> Option<Vec<f64>> {
        let (x, p) = (&self.place, &self.momentum);
        let mut particle = ChargedParticle::start(&self.charge, x, p, self.h).ok()?;
        particle.step().ok()?;
        Some([particle.place(), particle.momentum()].concat())
    }

    fn generated(&self) -> Option<Vec<f64>> {
        let initial = [self.place.to_vec(), self.momentum.to_vec()];
        let shown = ["X", "momentum"];
        generated(
            "charged-particle",
            &shown,
            &self.parameters(),
            &initial,
            self.h,
        )
    }
}

/// An ellipsoid in N dimensions near its reference. With `MOMENTS`, the energy depends on the spatial second moments.
#[derive(Clone, Copy)]
struct Elastic<const N: usize, const MOMENTS: bool> {
    body: Ellipsoid<N>,
    placement: Square<N>,
    momentum: Square<N>,
    h: f64,
}

impl<const N: usize, const MOMENTS: bool> System for Elastic<N, MOMENTS> {
    const KINDS: usize = 8;

    fn draw(source: &mut Source) -> Self {
        let mut placement = source.matrix::<N>().scaled(0.1).0;
        for (i, row) in placement.iter_mut().enumerate() {
            row[i] += 1.0;
        }
        Elastic {
            body: Ellipsoid {
                metric: source.positive::<N>().0,
                moments: source.positive::<N>().0,
                energy: from_fn(|_| source.between(0.1, 1.0)),
                of: if MOMENTS { Of::Moments } else { Of::Metric },
            },
            placement,
            momentum: source.matrix::<N>().scaled(0.3).0,
            h: source.between(0.005, 0.02),
        }
    }

    fn nudged(&self, kind: usize, share: f64) -> Self {
        let factor = 1.0 + share;
        let larger = |m: &Square<N>| m.map(|row| row.map(|x| x * factor));
        let mut moved = *self;
        match kind {
            0 => moved.momentum = larger(&self.momentum),
            1 => moved.body.metric = larger(&self.body.metric),
            2 => moved.body.moments = larger(&self.body.moments),
            3 => moved.placement = larger(&self.placement),
            _ => moved.body.energy[kind - 4] *= factor,
        }
        moved
    }

    fn by_hand(&self) -> Option<Vec<f64>> {
        let (q, p) = (&self.placement, &self.momentum);
        let mut body = ElasticEllipsoid::start(&self.body, q, p, self.h).ok()?;
        body.step().ok()?;
        Some(
            [
                body.placement().as_flattened(),
                body.momentum().as_flattened(),
            ]
            .concat(),
        )
    }

    fn generated(&self) -> Option<Vec<f64>> {
        let flat = |m: &Square<N>| m.as_flattened().to_vec();
        let mut parameters = vec![flat(&self.body.metric), flat(&self.body.moments)];
        parameters.extend(self.body.energy.map(|x| vec![x]));
        let initial = [flat(&self.placement), flat(&self.momentum)];
        let (model, momentum) = match MOMENTS {
            true => ("ellipsoid-spatial", "spatial_momentum"),
            false => ("ellipsoid-convective", "body_momentum"),
        };
        generated(model, &["Q", momentum], &parameters, &initial, self.h)
    }
}

#[derive(Clone, Copy)]
struct Joined {
    four: Four,
    places: Places,
    momenta: Momenta,
    h: f64,
}

/// `tr J - J`.
fn inertia(poinsot: &Matrix) -> Matrix {
    let trace: f64 = (0..3).map(|i| poinsot[i][i]).sum();
    from_fn(|i| from_fn(|j| if i == j { trace } else { 0.0 } - poinsot[i][j]))
}

impl Joined {
    /// The body momenta of the first three bodies.
    fn own(&self, places: &Places, at: usize, momentum: &Vector) -> Vector {
        apply_transposed(&places.attitudes[at].matrix(), momentum)
    }

    fn shown(&self, places: &Places, momenta: &Momenta) -> Vec<Vec<f64>> {
        let [one, two, three] = &places.attitudes;
        vec![
            one.matrix().concat(),
            self.own(places, 0, &momenta.angular[0]).to_vec(),
            rigid(two, &places.motion),
            [
                self.own(places, 1, &momenta.angular[1]),
                self.own(places, 1, &momenta.motion),
            ]
            .concat(),
            three.0.to_vec(),
            self.own(places, 2, &momenta.angular[2]).to_vec(),
            places.point.to_vec(),
            momenta.point.to_vec(),
        ]
    }
}

impl System for Joined {
    const KINDS: usize = 14;

    fn draw(source: &mut Source) -> Self {
        let small = |source: &mut Source| -> Vector { stretched(source.vector(), 0.5) };
        let mut attitude = || Quaternion(source.vector()).normalised();
        let attitudes = [attitude(), attitude(), attitude()];
        // In unit quaternions the principal axes are the coordinate axes.
        let second: Vector = from_fn(|_| source.between(0.2, 1.0));
        let second = from_fn(|i| from_fn(|j| if i == j { second[i] } else { 0.0 }));
        Joined {
            four: Four {
                poinsots: [source.positive::<3>().0, source.positive::<3>().0, second],
                motion_mass: source.between(0.5, 2.0),
                point_mass: source.between(0.5, 2.0),
                quartic: source.between(0.1, 3.0),
                stiffness: source.between(0.5, 2.0),
                arms: [source.vector(), source.vector(), source.vector()],
                gravity: source.vector(),
            },
            places: Places {
                attitudes,
                motion: source.vector(),
                point: source.vector(),
            },
            momenta: Momenta {
                angular: [small(source), small(source), small(source)],
                motion: small(source),
                point: small(source),
            },
            h: source.between(0.02, 0.1),
        }
    }

    fn nudged(&self, kind: usize, share: f64) -> Self {
        let factor = 1.0 + share;
        let mut moved = *self;
        let four = &mut moved.four;
        match kind {
            0 => {
                moved.momenta = Momenta {
                    angular: self.momenta.angular.map(|v| stretched(v, factor)),
                    motion: stretched(self.momenta.motion, factor),
                    point: stretched(self.momenta.point, factor),
                };
            }
            1..4 => {
                let larger = |row: Vector| stretched(row, factor);
                four.poinsots[kind - 1] = four.poinsots[kind - 1].map(larger);
            }
            4 => four.motion_mass *= factor,
            5 => four.point_mass *= factor,
            6 => four.quartic *= factor,
            7 => four.stiffness *= factor,
            8..11 => four.arms[kind - 8] = stretched(four.arms[kind - 8], factor),
            11 => four.gravity = stretched(four.gravity, factor),
            12 => moved.places.motion = stretched(self.places.motion, factor),
            _ => moved.places.point = stretched(self.places.point, factor),
        }
        moved
    }

    fn by_hand(&self) -> Option<Vec<f64>> {
        let mut four = MixedFour::start(&self.four, &self.places, &self.momenta, self.h).ok()?;
        four.step().ok()?;
        Some(self.shown(&four.places(), &four.momenta()).concat())
    }

    fn generated(&self) -> Option<Vec<f64>> {
        let f = &self.four;
        let [one, two, three] = &f.poinsots;
        let [p, s, e] = f.arms;
        let parameters = [
            one.concat(),
            two.concat(),
            vec![f.motion_mass],
            inertia(three).concat(),
            vec![f.point_mass],
            vec![f.quartic],
            vec![f.stiffness],
            p.to_vec(),
            s.to_vec(),
            e.to_vec(),
            f.gravity.to_vec(),
        ];
        let initial = self.shown(&self.places, &self.momenta);
        let shown = [
            "R",
            "body_momentum_R",
            "G",
            "body_momentum_G",
            "q",
            "body_momentum_q",
            "X",
            "momentum_X",
        ];
        generated("mixed-four", &shown, &parameters, &initial, self.h)
    }
}

#[test]
fn kepler() {
    agree::<Planet>("Kepler");
}

#[test]
fn charged_particle() {
    agree::<InFields>("charge");
}

#[test]
fn ellipsoids_seen_from_the_body() {
    agree::<Elastic<2, false>>("ellipsoid in two dimensions");
    agree::<Elastic<3, false>>("ellipsoid in three dimensions");
    agree::<Elastic<4, false>>("ellipsoid in four dimensions");
}

#[test]
fn ellipsoids_seen_from_space() {
    agree::<Elastic<2, true>>("ellipsoid in two dimensions, spatial");
    agree::<Elastic<3, true>>("ellipsoid in three dimensions, spatial");
    agree::<Elastic<4, true>>("ellipsoid in four dimensions, spatial");
}

#[test]
fn mixed_four() {
    agree::<Joined>("four groups");
}

/// The difference between the kinetic momentum `p - (q/2) B x X` after a step and its initial value rotated about `-B` by `angle`.
fn off_a_turn(start: &InFields, angle: f64) -> f64 {
    let after = start.generated().expect("solvable");
    let kinetic = |x: &Vector, p: &Vector| -> Vector {
        let turned = cross(&start.charge.magnetic, x);
        from_fn(|i| p[i] - 0.5 * start.charge.charge * turned[i])
    };
    let before = kinetic(&start.place, &start.momentum);
    let after = kinetic(&from_fn(|i| after[i]), &from_fn(|i| after[3 + i]));
    let field = start.charge.magnetic;
    let axis = stretched(field, -1.0 / dot(&field, &field).sqrt());
    let (sine, cosine) = angle.sin_cos();
    let (across, along) = (cross(&axis, &before), dot(&axis, &before));
    let turned: Vector =
        from_fn(|i| cosine * before[i] + sine * across[i] + (1.0 - cosine) * along * axis[i]);
    let scale = dot(&before, &before).sqrt();
    (0..3).fold(0.0, |m: f64, i| {
        worse(m, (turned[i] - after[i]).abs() / scale)
    })
}

#[test]
fn kinetic_momenta_of_a_charge_turn_by_twice_the_angle_of_boris() {
    let mut source = Source::seeded(44);
    let (mut exact, mut continuous) = (0.0_f64, 0.0_f64);
    for _ in 0..500 {
        let mut start = InFields::draw(&mut source);
        start.charge.electric = [0.0; 3];
        // The rotation stays well below half a revolution.
        let field = start.charge.magnetic;
        let frequency = start.charge.charge * dot(&field, &field).sqrt() / start.charge.mass;
        exact = worse(
            exact,
            off_a_turn(&start, 2.0 * (0.5 * frequency * start.h).atan()),
        );
        continuous = worse(continuous, off_a_turn(&start, frequency * start.h));
    }
    println!("{exact:e}, by the continuous angle {continuous:e}");
    // A few rounding errors of a momentum of order one, relative to kinetic momenta as small as 0.01.
    assert!(exact < 1e-13, "{exact:e}");
    assert!(
        continuous > 1e-3,
        "the angles are not told apart: {continuous:e}"
    );
}
