//! Ten random hyperelastic energies, each with three strains, stated on GL(3) in the body frame, in the space frame,
//! and by a matrix field. Compares the derived equations and one emitted step with the variation of the action of the
//! placement, by dual numbers; the three motions agree. An energy with one exponent changed fails.

use super::energy::Energy;
use clebsch::card::{Card, Settings, Trajectory};
use clebsch_core::{Assignment, Derivation, derive_source};
use clebsch_oracle::oracle::action::elastic::entries;
use clebsch_oracle::oracle::dual::{Dual, Number};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::Square;

type Matrix = Square<f64, 3>;

/// The strain that an energy depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Strain {
    /// `C = Qᵀ C0 Q`: the energy does not change if the body is rotated in space.
    Reference,
    /// `S = Q I0 Qᵀ`: the energy does not change if the points of the body are renamed.
    Space,
    /// `C I0`, which has the invariants of `C0 S`: both symmetries.
    Both,
}

/// How the motion is stated.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Statement {
    Convective,
    Spatial,
    Material,
}

const STRAINS: [Strain; 3] = [Strain::Reference, Strain::Space, Strain::Both];
const STATEMENTS: [Statement; 3] = [
    Statement::Convective,
    Statement::Spatial,
    Statement::Material,
];

impl Strain {
    /// The strain of a placement, for the action typed by hand.
    fn of<T: Number>(self, body: &Body, q: &Square<T, 3>) -> Square<T, 3> {
        let (metric, moments) = (
            Square::constant(&body.metric),
            Square::constant(&body.moments),
        );
        match self {
            Self::Reference => q.transpose() * metric * *q,
            Self::Space => *q * moments * q.transpose(),
            Self::Both => q.transpose() * metric * *q * moments,
        }
    }
}

impl Statement {
    fn text(self, strain: Strain, energy: &Energy) -> String {
        let (carried, kinetic) = match self {
            Self::Convective => (
                "group Q: GL<3> velocity G; advected C: Sym<3> = Q^T*C0*Q;
                 constraint next(Q) = Q*G; constraint next(C) = G^T*C*G;",
                "tr(C*(G - Id)*I0*(G - Id)^T)",
            ),
            Self::Spatial => (
                "group Q: GL<3> velocity g; advected S: Sym<3> = Q*I0*Q^T;
                 constraint next(Q) = g*Q; constraint next(S) = g*S*g^T;",
                "tr(C0*(g - Id)*S*(g - Id)^T)",
            ),
            Self::Material => (
                "field Q: Mat<3>;",
                "tr(C0*(next(Q) - Q)*I0*(next(Q) - Q)^T)",
            ),
        };
        // If the statement does not advect a strain, it is written in terms of the placement.
        let strain = match (self, strain) {
            (Self::Convective, Strain::Reference) => "C",
            (_, Strain::Reference) => "Q^T*C0*Q",
            (Self::Spatial, Strain::Space) => "S",
            (_, Strain::Space) => "Q*I0*Q^T",
            (Self::Convective, Strain::Both) => "C*I0",
            (Self::Spatial, Strain::Both) => "C0*S",
            (Self::Material, Strain::Both) => "Q^T*C0*Q*I0",
        };
        format!(
            "model {self:?}{} {{ param C0, I0: Sym<3>; {carried} let X = {strain}; let W = {};
             lagrangian = {kinetic}/(2*h) - h*W; }}",
            "Body",
            energy.text()
        )
    }

    /// The change of a placement along a direction: in the body frame, in the space frame, or for each entry.
    fn change(self, q: &Matrix, direction: &Matrix) -> Matrix {
        match self {
            Self::Convective => *q * *direction,
            Self::Spatial => *direction * *q,
            Self::Material => *direction,
        }
    }
}

/// The data of a body other than its energy.
struct Body {
    metric: Matrix,
    moments: Matrix,
}

impl Body {
    /// Metric and moments with eigenvalues from 0.65 to 1.5, not diagonal.
    fn random(source: &mut Source) -> Self {
        let mut near_one = || (Square::identity() + source.positive()).scaled(0.5);
        Self {
            metric: near_one(),
            moments: near_one(),
        }
    }

    /// The action of a step between two placements, by summands.
    fn action<T: Number>(
        &self,
        energy: &Energy,
        strain: Strain,
        h: f64,
        [tail, head]: [&Square<T, 3>; 2],
    ) -> Vec<T> {
        let d = *head - *tail;
        let kinetic =
            Square::constant(&self.metric) * d * Square::constant(&self.moments) * d.transpose();
        let mut all = vec![kinetic.trace() / T::constant(2.0 * h)];
        for q in [tail, head] {
            let terms = energy.terms(&strain.of(self, q));
            all.extend(terms.into_iter().map(|w| T::constant(-0.5 * h) * w));
        }
        all
    }
}

/// Derivatives of a sum along all nine directions, with the size of its summands.
fn derivative(
    at: &Matrix,
    statement: Statement,
    sum: impl Fn(&Square<Dual, 3>) -> Vec<Dual>,
) -> (Vec<f64>, f64) {
    let mut sizes: Vec<f64> = Vec::new();
    let slopes = entries().into_iter().map(|direction| {
        let change = statement.change(at, &direction);
        let all = sum(&Square::from_entries(|i, j| Dual {
            value: at.0[i][j],
            slope: change.0[i][j],
        }));
        sizes.resize(all.len(), 0.0);
        for (size, x) in sizes.iter_mut().zip(&all) {
            *size = size.max(x.value.abs()).max(x.slope.abs());
        }
        all.iter().map(|x| x.slope).sum()
    });
    let slopes = slopes.collect();
    (slopes, sizes.iter().sum())
}

/// The largest difference over the size.
fn off(expected: &[f64], found: &[f64], size: f64) -> f64 {
    assert_eq!(expected.len(), found.len());
    let each = expected
        .iter()
        .zip(found)
        .map(|(a, b)| (a - b).abs() / size);
    clebsch::scalar::largest(each)
}

/// Near the identity, so that powers and logarithms of all invariants exist.
fn placement(source: &mut Source) -> Matrix {
    Square::identity() + source.matrix().scaled(0.25)
}

/// The residual of the derived equations at three nodes against the variation of the action.
fn equations(
    derivation: &Derivation,
    energy: &Energy,
    [statement, strain]: [usize; 2],
    source: &mut Source,
) -> f64 {
    let (statement, strain) = (STATEMENTS[statement], STRAINS[strain]);
    let each = (0..20).map(|_| {
        let body = Body::random(source);
        let h = source.between(0.1, 1.0);
        let nodes: [Matrix; 3] = std::array::from_fn(|_| placement(source));
        let [before, after] = [&nodes[0], &nodes[2]].map(Square::constant);
        let (expected, size) = derivative(&nodes[1], statement, |q| {
            let mut all = body.action(energy, strain, h, [&before, q]);
            all.extend(body.action(energy, strain, h, [q, &after]));
            all
        });
        let mut given = Assignment::new();
        given.set_scalar("h", h);
        given.set("C0", 0, 3, 3, &body.metric.0.concat());
        given.set("I0", 0, 3, 3, &body.moments.0.concat());
        for (shift, q) in [-1, 0, 1].into_iter().zip(&nodes) {
            given.set("Q", shift, 3, 3, &q.0.concat());
        }
        let found = derivation.residual(&given).expect("all values are given");
        off(&expected, &found, size)
    });
    clebsch::scalar::largest(each)
}

fn opened(card: &Card, body: &Body, h: f64, q: &Matrix, p: &[f64]) -> Box<dyn Trajectory> {
    let parameters = [body.metric.0.concat(), body.moments.0.concat()];
    let started = (card.open)(&parameters, &[q.0.concat(), p.to_vec()], Settings::step(h));
    started.unwrap_or_else(|e| panic!("{e}\n{}", card.source))
}

/// Placement and momentum that a trajectory shows.
fn seen(card: &Card, of: &dyn Trajectory) -> [Vec<f64>; 2] {
    let mut all = vec![0.0; card.observable_count()];
    of.observe(&mut all);
    let wanted = [card.initial[0].name, card.initial[1].name];
    wanted.map(|name| {
        let place = card.observables.iter().position(|f| f.name == name);
        let place = place.expect("what starts is shown");
        let first = card.observables[..place].iter().map(|f| f.count()).sum();
        all[first..first + 9].to_vec()
    })
}

/// A step from a random state: the derivatives of the action of its edge are the momenta at both ends.
fn step(
    card: &Card,
    energy: &Energy,
    statement: Statement,
    strain: Strain,
    source: &mut Source,
) -> f64 {
    let body = Body::random(source);
    let h = STEP;
    let q = placement(source);
    let p = source.matrix::<3>().scaled(0.3).0.concat();
    let mut t = opened(card, &body, h, &q, &p);
    let [_, before] = seen(card, &*t);
    t.step().unwrap_or_else(|e| panic!("{e}\n{}", card.source));
    let [moved, after] = seen(card, &*t);
    let moved = Square(std::array::from_fn(|i| {
        std::array::from_fn(|j| moved[3 * i + j])
    }));
    let (tail, head) = (Square::constant(&q), Square::constant(&moved));
    let (left, size) = derivative(&q, statement, |q| {
        body.action(energy, strain, h, [q, &head])
    });
    let left: Vec<f64> = left.iter().map(|x| -x).collect();
    let (right, other) = derivative(&moved, statement, |q| {
        body.action(energy, strain, h, [&tail, q])
    });
    off(&left, &before, size).max(off(&right, &after, other))
}

/// Short enough that placements stay invertible under each of these forces.
const STEP: f64 = 2e-3;

/// Rounding errors are 1e-14 of the sum of all terms; inverses and fractional powers near their singularities lose a
/// few more digits.
const AGREEMENT: f64 = 1e-10;

/// Long, since ninety models are derived, and thirty of them stepped.
#[test]
fn ten_random_energies_are_varied_as_the_oracle_varies_them() {
    let mut source = Source::seeded(31);
    let mut worst = [0.0_f64; 2];
    for n in 0..10 {
        let energy = Energy::random(&mut source);
        for (s, strain) in STRAINS.into_iter().enumerate() {
            for (k, statement) in STATEMENTS.into_iter().enumerate() {
                let text = statement.text(strain, &energy);
                let derivation = derive_source(&text);
                let derivation = derivation.unwrap_or_else(|e| panic!("{text}\nis refused:\n{e}"));
                let found = equations(&derivation, &energy, [k, s], &mut source);
                assert!(found < AGREEMENT, "{n}: {text}\n{found:e}");
                worst[0] = worst[0].max(found);
                let other = energy.changed(&mut source);
                let found = equations(&derivation, &other, [k, s], &mut source);
                assert!(
                    found > 1e-4,
                    "{n}: {text} is not {}: {found:e}",
                    other.text()
                );
            }
        }
        let both = Strain::Both;
        for statement in STATEMENTS {
            let text = statement.text(both, &energy);
            let card = clebsch_interpret::card(&text).expect("is read");
            for _ in 0..10 {
                let found = step(&card, &energy, statement, both, &mut source);
                assert!(found < AGREEMENT, "{n}: {text}\nstep {found:e}");
                worst[1] = worst[1].max(found);
            }
        }
    }
    println!("worst of equations and of steps {worst:?}");
}

/// Placements after several steps for the statements in the body frame, in the space frame and as a matrix: `Q`, `Q`,
/// `Q`.
fn end(
    card: &Card,
    statement: Statement,
    body: &Body,
    q: &Matrix,
    v: &Matrix,
    steps: usize,
) -> Vec<f64> {
    // The momentum of each entry for the velocity v; along Q E and E Q it is Qᵀ p and p Qᵀ.
    let p = body.metric * *v * body.moments;
    let p = match statement {
        Statement::Convective => q.transpose() * p,
        Statement::Spatial => p * q.transpose(),
        Statement::Material => p,
    };
    let mut t = opened(card, body, STEP, q, &p.0.concat());
    for _ in 0..steps {
        t.step().unwrap_or_else(|e| panic!("{e}\n{}", card.source));
    }
    let [q, _] = seen(card, &*t);
    q
}

/// Every step rounds by several units in the last place; strains of order one amplify these errors over the run.
const ROUNDING: f64 = 1e-12;

#[test]
fn the_three_statements_of_a_random_energy_are_one_motion() {
    let mut source = Source::seeded(32);
    for n in 0..5 {
        let energy = Energy::random(&mut source);
        let body = Body::random(&mut source);
        let (q, v) = (placement(&mut source), source.matrix().scaled(0.3));
        let run = |statement: Statement, energy: &Energy| {
            let text = statement.text(Strain::Both, energy);
            let card = clebsch_interpret::card(&text).expect("is read");
            end(&card, statement, &body, &q, &v, 200)
        };
        let all = STATEMENTS.map(|statement| run(statement, &energy));
        for (statement, found) in STATEMENTS.iter().zip(&all).skip(1) {
            let apart = off(&all[0], found, 1.0);
            println!("{n} {statement:?}: {apart:e}");
            assert!(
                apart < ROUNDING,
                "{n} {statement:?}: {apart:e}\n{}",
                energy.text()
            );
        }
        // Another energy gives a clearly different motion.
        let other = run(Statement::Material, &energy.changed(&mut source));
        assert!(off(&all[0], &other, 1.0) > 1e-5);
        assert!(off(&all[0], &q.0.concat(), 1.0) > 1e-2);
    }
}
