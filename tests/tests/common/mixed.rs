//! Random models of fields and groups together: one to four configurations of random kinds and sides,
//! their kinetic energies, and terms that join them at a node or over an edge. The residual of the
//! derivation at random nodes, which solve nothing, against the variation of the action by dual numbers.
//! The text and its meaning are drawn together; the text is never read back.

use super::oracle_bridge::{AGREEMENT, disagreement};
use clebsch_core::{Assignment, derive_source};
use clebsch_oracle::oracle::action::Variation;
use clebsch_oracle::oracle::dual::{Dual, Number};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::dot;
use clebsch_oracle::physics::measure::worse;
use std::array::from_fn;

mod configuration;
use configuration::{
    Configuration, KINDS, Kind, NUMBERS, Parameters, VECTORS, constant, rotation_of, turn, vector,
};

/// A vector that a configuration gives at a node, with the vector parameter in it.
#[derive(Clone, Copy, Debug)]
enum Feature {
    /// The matrix of the configuration times the parameter, or its transpose.
    Turned { transposed: bool },
    /// The place, or the field itself; a number times the parameter.
    Place,
    /// The imaginary part of a quaternion.
    Imaginary,
}

#[derive(Clone, Debug)]
struct Seen {
    configuration: usize,
    feature: Feature,
    vector: usize,
    /// At the end of the edge.
    end: bool,
}

#[derive(Clone, Copy, Debug)]
enum Shape {
    Plain,
    Square,
    Cube,
    Root,
    Logarithm,
    Exponential,
    Sine,
}

const SHAPES: [Shape; 7] = [
    Shape::Plain,
    Shape::Square,
    Shape::Cube,
    Shape::Root,
    Shape::Logarithm,
    Shape::Exponential,
    Shape::Sine,
];

/// `±k h^power shape(a · b)`.
#[derive(Clone, Debug)]
struct Term {
    negative: bool,
    number: usize,
    over_step: bool,
    shape: Shape,
    seen: [Seen; 2],
}

struct Random {
    configurations: Vec<Configuration>,
    terms: Vec<Term>,
    parameters: Parameters,
    h: f64,
    incoming: bool,
}

impl Random {
    fn of_seed(seed: u64) -> Self {
        let mut source = Source::seeded(seed);
        let count = 1 + source.below(4);
        let mut configurations: Vec<Configuration> = Vec::new();
        let mut at = 0;
        for i in 0..count {
            let kind = *source.choose(&KINDS).unwrap_or(&Kind::Vector);
            // One field at least in every model.
            let kind = match i + 1 == count && !configurations.iter().any(|c| c.kind.is_field()) {
                true => Kind::Vector,
                false => kind,
            };
            configurations.push(Configuration {
                kind,
                name: format!("q{}", i + 1),
                velocity: format!("v{}", i + 1),
                spatial: !kind.is_field() && source.chance(30),
                at,
            });
            at += kind.entries();
        }
        let terms = 1 + source.below(4);
        let terms = (0..terms).map(|_| {
            let edge = source.chance(30);
            let mut seen = || {
                let configuration = source.below(count);
                let features = configurations[configuration].features();
                Seen {
                    configuration,
                    feature: *source.choose(&features).unwrap_or(&Feature::Place),
                    vector: source.below(VECTORS),
                    end: edge && source.chance(50),
                }
            };
            let seen = [seen(), seen()];
            Term {
                negative: source.chance(50),
                number: source.below(NUMBERS),
                over_step: source.chance(30),
                shape: *source.choose(&SHAPES).unwrap_or(&Shape::Plain),
                seen,
            }
        });
        let terms = terms.collect();
        Random {
            terms,
            parameters: Parameters {
                vectors: from_fn(|_| source.vector()),
                numbers: from_fn(|_| source.between(0.5, 1.5)),
                matrices: from_fn(|_| source.positive()),
            },
            h: source.between(0.2, 1.0),
            incoming: source.chance(15),
            configurations,
        }
    }

    fn text(&self, source: &mut Source) -> String {
        let mut out = "model Random {\n    param c1, c2, c3, c4: Vec<3>;\n    param k1, k2, k3, k4: Real;\n    param J1, J2: Sym<3>;\n".to_owned();
        for c in &self.configurations {
            out += &format!("    {}\n", c.declared());
        }
        if self.incoming {
            out += "    node incoming;\n";
        }
        let by_velocity = source.chance(50);
        let kinetic = self
            .configurations
            .iter()
            .map(|c| c.kinetic_text(by_velocity));
        out += &format!(
            "    lagrangian = {}",
            kinetic.collect::<Vec<_>>().join("\n        + ")
        );
        for t in &self.terms {
            out += &format!("\n        {}", self.term_text(t));
        }
        out + ";\n}\n"
    }

    fn term_text(&self, t: &Term) -> String {
        let seen = |s: &Seen| {
            let c = &self.configurations[s.configuration];
            let x = match s.end {
                true => format!("next({})", c.name),
                false => c.name.clone(),
            };
            let own = match c.kind {
                Kind::Quaternion | Kind::Motion => format!("rot({x})"),
                _ => x.clone(),
            };
            let vector = format!("c{}", s.vector + 1);
            match (s.feature, c.kind) {
                (Feature::Turned { transposed: false }, _) => format!("{own}*{vector}"),
                (Feature::Turned { transposed: true }, _) => format!("{own}^T*{vector}"),
                (Feature::Imaginary, _) => format!("im({x})"),
                (Feature::Place, Kind::Motion) => format!("pos({x})"),
                (Feature::Place, Kind::Number) => format!("{x}*{vector}"),
                (Feature::Place, _) => x,
            }
        };
        let d = format!("dot({}, {})", seen(&t.seen[0]), seen(&t.seen[1]));
        let value = match t.shape {
            Shape::Plain => d,
            Shape::Square => format!("{d}^2"),
            Shape::Cube => format!("{d}^3"),
            Shape::Root => format!("sqrt(1 + {d}^2)"),
            Shape::Logarithm => format!("log(2 + {d}^2)"),
            Shape::Exponential => format!("exp(-{d}/4)"),
            Shape::Sine => format!("sin({d})"),
        };
        let sign = if t.negative { "-" } else { "+" };
        let k = format!("k{}", t.number + 1);
        match t.over_step {
            true => format!("{sign} {k}*{value}/h"),
            false => format!("{sign} h*{k}*{value}"),
        }
    }

    /// A term at one node is one of the potential, whatever the power of the step.
    fn is_nodal(&self, t: &Term) -> bool {
        t.seen[0].end == t.seen[1].end
    }

    fn term<T: Number>(&self, t: &Term, tail: &[T], head: &[T]) -> T {
        let seen = |s: &Seen| -> [T; 3] {
            let c = &self.configurations[s.configuration];
            let x = &(if s.end { head } else { tail })[c.at..];
            let v: [T; 3] = constant(&self.parameters.vectors[s.vector]);
            let matrix = || match c.kind {
                Kind::Quaternion => rotation_of(x),
                _ => turn(x),
            };
            match (s.feature, c.kind) {
                (Feature::Turned { transposed: false }, _) => matrix().apply(&v),
                (Feature::Turned { transposed: true }, _) => matrix().transpose().apply(&v),
                (Feature::Imaginary, _) => vector(&x[1..]),
                (Feature::Place, Kind::Motion) => vector(&x[9..]),
                (Feature::Place, Kind::Number) => from_fn(|i| x[0] * v[i]),
                (Feature::Place, _) => vector(x),
            }
        };
        let d = dot(&seen(&t.seen[0]), &seen(&t.seen[1]));
        let value = match t.shape {
            Shape::Plain => d,
            Shape::Square => d * d,
            Shape::Cube => d * d * d,
            Shape::Root => (T::constant(1.0) + d * d).sqrt(),
            Shape::Logarithm => (T::constant(2.0) + d * d).ln(),
            Shape::Exponential => (d * T::constant(-0.25)).exp(),
            Shape::Sine => d.sin(),
        };
        let k = self.parameters.numbers[t.number];
        let weight = match t.over_step {
            true => k / self.h,
            false => k * self.h,
        };
        T::constant(if t.negative { -weight } else { weight }) * value
    }

    fn edge<T: Number>(&self, tail: &[T], head: &[T]) -> Vec<T> {
        let kinetic = self.configurations.iter();
        let mut all: Vec<T> = kinetic
            .flat_map(|c| c.kinetic(tail, head, &self.parameters, self.h))
            .collect();
        for t in &self.terms {
            match (self.is_nodal(t), self.incoming) {
                (false, _) => all.push(self.term(t, tail, head)),
                (true, true) => all.push(self.term(t, head, head)),
                (true, false) => {
                    let half = T::constant(0.5);
                    all.extend([tail, head].map(|x| half * self.term(t, x, x)));
                }
            }
        }
        all
    }

    /// The variation of the action of two edges at the node between them.
    fn variation(&self, nodes: &[Vec<f64>; 3]) -> Variation {
        let still = |x: &[f64]| -> Vec<Dual> { x.iter().map(|v| Dual::constant(*v)).collect() };
        let (before, after) = (still(&nodes[0]), still(&nodes[2]));
        let (mut derivative, mut scale) = (Vec::new(), 0.0f64);
        for c in &self.configurations {
            for direction in c.directions(&nodes[1]) {
                let mut moved = still(&nodes[1]);
                for (x, slope) in moved[c.at..].iter_mut().zip(&direction) {
                    x.slope = *slope;
                }
                let terms = self.edge(&before, &moved).into_iter();
                let terms = terms.chain(self.edge(&moved, &after));
                let slopes: Vec<f64> = terms.map(|t| t.slope).collect();
                derivative.push(slopes.iter().sum());
                scale = scale.max(slopes.iter().map(|x| x.abs()).sum());
            }
        }
        Variation { derivative, scale }
    }

    fn values(&self, nodes: &[Vec<f64>; 3]) -> Assignment {
        let mut values = Assignment::new();
        values.set_scalar("h", self.h);
        for (i, v) in self.parameters.vectors.iter().enumerate() {
            values.set(&format!("c{}", i + 1), 0, 3, 1, v);
        }
        for (i, k) in self.parameters.numbers.iter().enumerate() {
            values.set_scalar(&format!("k{}", i + 1), *k);
        }
        for (i, j) in self.parameters.matrices.iter().enumerate() {
            values.set(&format!("J{}", i + 1), 0, 3, 3, &j.0.concat());
        }
        for c in &self.configurations {
            for (shift, node) in (-1..=1).zip(nodes) {
                c.assign(&mut values, shift, node);
            }
        }
        values
    }

    fn nodes(&self, source: &mut Source) -> [Vec<f64>; 3] {
        from_fn(|_| {
            let all = self.configurations.iter();
            all.flat_map(|c| c.draw(source)).collect()
        })
    }
}

/// The largest disagreement of a model at a few points, and the one where every kinetic energy is a millionth off.
fn worst(random: &Random, text: &str, source: &mut Source) -> [f64; 2] {
    let d = derive_source(text).unwrap_or_else(|e| panic!("{text}\n{e}"));
    let (mut worst, mut off) = (0.0, 0.0);
    for _ in 0..5 {
        let nodes = random.nodes(source);
        let wanted = random.variation(&nodes);
        let mut values = random.values(&nodes);
        let at = |values: &Assignment| {
            let found = d.residual(values);
            let found = found.unwrap_or_else(|e| panic!("{text}\n{e:?}"));
            assert_eq!(found.len(), wanted.derivative.len(), "{text}");
            disagreement(&wanted, &found)
        };
        worst = worse(worst, at(&values));
        values.set_scalar("k1", random.parameters.numbers[0] * (1.0 + 1e-6));
        values.set_scalar("k2", random.parameters.numbers[1] * (1.0 + 1e-6));
        let j = random.parameters.matrices[0].scaled(1.0 + 1e-6);
        values.set("J1", 0, 3, 3, &j.0.concat());
        let j = random.parameters.matrices[1].scaled(1.0 + 1e-6);
        values.set("J2", 0, 3, 3, &j.0.concat());
        off = worse(off, at(&values));
    }
    [worst, off]
}

/// Fails if the model of a seed disagrees with the oracle, or does not where its masses are a millionth off.
pub fn agree_with_their_own_masses_alone(seeds: impl Iterator<Item = u64>) {
    for seed in seeds {
        let random = Random::of_seed(seed);
        let mut source = Source::seeded(seed + 1_000_000);
        let text = random.text(&mut source);
        let [found, off] = worst(&random, &text, &mut source);
        assert!(found < AGREEMENT, "seed {seed}: {found:e}\n{text}");
        assert!(off > AGREEMENT, "seed {seed}: {off:e}\n{text}");
    }
}
