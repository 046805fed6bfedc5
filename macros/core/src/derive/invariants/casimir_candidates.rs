//! Candidates for Casimirs: scalar products, traces and determinants of words in the momenta and advected quantities,
//! simple ones first. Takes the momenta and advected quantities of a model; gives scalars that may or may not be
//! Casimirs.

use super::homogeneous;
use super::random_step::RandomStep;
use super::{Candidate, Inputs, here, totals};
use crate::algebra::Rational;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::SymbolId;
use crate::expr::{self, Expr, Part};

/// The largest number of candidates that are tested.
const MOST: usize = 400;

/// A part of a word, with its name.
#[derive(Clone)]
pub(super) struct Piece {
    pub(super) name: String,
    pub(super) value: Expr,
}

/// All candidates, simple ones first.
pub(super) fn candidates(x: &Inputs, passages: &[RandomStep]) -> Vec<Candidate> {
    let vectors = vectors(x, passages);
    let matrices = matrices(x);
    let mut out: Vec<Candidate> = Vec::new();
    let chain = |words: &[&Piece]| -> Option<(String, Expr)> {
        let fit = |w: &[&Piece]| w[0].value.shape().cols == w[1].value.shape().rows;
        let value = expr::product(words.iter().map(|w| w.value.clone()).collect::<Vec<_>>());
        words.windows(2).all(fit).then(|| (joined(words), value))
    };
    let bracket = |u: &Piece, middle: &[&Piece], v: &Piece| -> Option<Candidate> {
        let (between, m) = chain(middle)?;
        let right = if middle.is_empty() {
            v.value.clone()
        } else {
            if m.shape().cols != v.value.shape().rows {
                return None;
            }
            expr::mul(m, v.value.clone())
        };
        if right.shape() != u.value.shape() {
            return None;
        }
        let name = match (middle.is_empty(), u.name == v.name) {
            (true, true) => format!("{}_squared", u.name),
            (true, false) => format!("{}_{}", u.name, v.name),
            _ => format!("{}_{between}_{}", u.name, v.name),
        };
        Some(Candidate {
            name,
            value: expr::dot(u.value.clone(), right),
        })
    };
    let trace = |word: &[&Piece]| -> Option<Candidate> {
        let (name, value) = chain(word)?;
        value.shape().is_square().then(|| Candidate {
            name: format!("trace_{name}"),
            value: expr::trace(value),
        })
    };
    let pairs = |out: &mut Vec<Candidate>, middle: &[&Piece]| {
        for (i, u) in vectors.iter().enumerate() {
            for v in &vectors[i..] {
                if out.len() > MOST {
                    return;
                }
                out.extend(bracket(u, middle, v));
            }
        }
    };
    pairs(&mut out, &[]);
    for m in matrices.iter().filter(|m| is_skew(x, &m.value)) {
        let t = expr::transpose(&x.letters.symbols, m.value.clone());
        let square = expr::trace(expr::mul(t, m.value.clone()));
        out.push(Candidate {
            name: format!("{}_squared", m.name),
            value: expr::scale(Rational::HALF, square),
        });
    }
    for m in &matrices {
        let largest = x.letters.symbols.sizes(m.value.shape().rows).1;
        let longest = largest.clamp(3, 8);
        let powers = (1..=longest).filter_map(|n| {
            let mut c = trace(&vec![m; n])?;
            if n == 1 {
                // The invariants `trace_J1`, `trace_J2`, ... represent the eigenvalues.
                c.name = format!("trace_{}", power(&m.name, 1));
            }
            Some(c)
        });
        out.extend(powers);
    }
    for m in &matrices {
        pairs(&mut out, &[m]);
    }
    for length in 2..=4 {
        for word in words(&matrices, length) {
            if length <= 3 {
                pairs(&mut out, &word);
            }
            if is_first(&matrices, &word) {
                out.extend(trace(&word));
            }
        }
        if out.len() > MOST {
            break;
        }
    }
    out.extend(homogeneous::weights(x));
    out.extend(areas(&vectors));
    out.extend(products_in_three(&vectors));
    out.extend(of_forms(x));
    out.extend(across(x, &vectors));
    for m in matrices.iter().filter(|m| m.value.shape().is_square()) {
        out.push(Candidate {
            name: format!("det_{}", m.name),
            value: expr::det(m.value.clone()),
        });
    }
    out.truncate(MOST);
    out
}

fn is_skew(x: &Inputs, e: &Expr) -> bool {
    match e.node() {
        expr::Node::Letter(l) => x.letters.symbols.get(l.symbol).structure == Structure::Skew,
        _ => false,
    }
}

/// Names in order, with repetitions as powers: `J`, `J2`, `J_K`.
fn joined(words: &[&Piece]) -> String {
    let mut out: Vec<(String, usize)> = Vec::new();
    for w in words {
        match out.last_mut() {
            Some((name, n)) if *name == w.name => *n += 1,
            _ => out.push((w.name.clone(), 1)),
        }
    }
    let runs = out.iter().map(|(name, n)| match n {
        1 => name.clone(),
        n => power(name, *n),
    });
    runs.collect::<Vec<_>>().join("_")
}

/// `J2` for the square of `J`, `J1_2` for the square of `J1`.
fn power(name: &str, n: usize) -> String {
    match name.ends_with(|c: char| c.is_ascii_digit()) {
        true => format!("{name}_{n}"),
        false => format!("{name}{n}"),
    }
}

/// Whether the word comes first among its cyclic rotations and the cyclic rotations of its transpose, which all have
/// the same trace.
fn is_first(letters: &[Piece], word: &[&Piece]) -> bool {
    let index = |name: &str| letters.iter().position(|l| l.name == name).unwrap_or(0);
    let own: Vec<usize> = word.iter().map(|w| index(&w.name)).collect();
    let mirrored = word.iter().rev().map(|w| {
        let other = match w.name.strip_suffix('t') {
            Some(plain) if letters.iter().any(|l| l.name == plain) => plain.to_owned(),
            _ => format!("{}t", w.name),
        };
        let found = letters.iter().position(|l| l.name == other);
        found.unwrap_or_else(|| index(&w.name))
    });
    let mirrored: Vec<usize> = mirrored.collect();
    (0..own.len()).all(|turn| {
        let turned = |list: &[usize]| {
            let mut t = list.to_vec();
            t.rotate_left(turn);
            t
        };
        own <= turned(&own) && own <= turned(&mirrored)
    })
}

/// All words of this length that are not powers of one letter, in order.
fn words(letters: &[Piece], length: usize) -> Vec<Vec<&Piece>> {
    let mut out: Vec<Vec<&Piece>> = vec![Vec::new()];
    for _ in 0..length {
        out = out
            .iter()
            .flat_map(|w| {
                letters.iter().map(move |l| {
                    let mut longer = w.clone();
                    longer.push(l);
                    longer
                })
            })
            .collect();
        if out.len() > MOST {
            return Vec::new();
        }
    }
    out
}

/// Vectors of the reduced space: momenta, their sums in one frame, advected vectors.
fn vectors(x: &Inputs, passages: &[RandomStep]) -> Vec<Piece> {
    let s = &x.letters.symbols;
    let mut out = Vec::new();
    let several = x.spec.configurations.len() > 1;
    for (i, c) in x.spec.configurations.iter().enumerate() {
        let mu = expr::here(s, x.letters.node_momentum[i]);
        let name = match several {
            true => format!("momentum_{}", s.get(c.element).ascii),
            false => "momentum".to_owned(),
        };
        if let Some(rigid) = c.group.rigid() {
            for (which, value) in [
                ("angular", rigid.angular(s, &mu)),
                ("linear", rigid.linear(s, &mu)),
            ] {
                out.push(Piece {
                    name: format!("{name}_{which}"),
                    value,
                });
            }
        } else if mu.shape().is_vector() {
            out.push(Piece { name, value: mu });
        }
    }
    out.extend(totals::totals(x, passages));
    for a in &x.spec.advected {
        let e = expr::here(s, a.quantity);
        if e.shape().is_vector() {
            let name = s.get(a.quantity).ascii.clone();
            out.push(Piece { name, value: e });
        }
    }
    out.extend(homogeneous::pieces(x));
    out
}

/// Matrices of the reduced space and their transposes.
fn matrices(x: &Inputs) -> Vec<Piece> {
    let s = &x.letters.symbols;
    let several = x.spec.configurations.len() > 1;
    let mut out = Vec::new();
    let momenta = x.spec.configurations.iter().zip(&x.letters.node_momentum);
    let momenta = momenta.map(|(c, id)| {
        let name = match several {
            true => format!("momentum_{}", s.get(c.element).ascii),
            false => "momentum".to_owned(),
        };
        (name, *id)
    });
    let advected = x.spec.advected.iter();
    let advected = advected.map(|a| (s.get(a.quantity).ascii.clone(), a.quantity));
    for (name, id) in momenta.chain(advected) {
        let symbol = s.get(id);
        if symbol.shape.is_vector() || symbol.shape.is_scalar() {
            continue;
        }
        let e = expr::here(s, id);
        let t = match symbol.structure {
            Structure::Symmetric | Structure::Diagonal | Structure::Skew => None,
            Structure::General
            | Structure::Orthogonal
            | Structure::Invertible
            | Structure::UnitQuaternion
            | Structure::RigidMotion => Some(expr::transpose(s, e.clone())),
        };
        out.push(Piece {
            name: name.clone(),
            value: e,
        });
        out.extend(t.map(|value| Piece {
            name: format!("{name}t"),
            value,
        }));
    }
    out
}

/// Squared cross products of two vectors, which give the part of one orthogonal to the other.
fn areas(vectors: &[Piece]) -> Vec<Candidate> {
    let three = |v: &&Piece| v.value.shape() == Shape::vector(Dim::Fixed(3));
    let list: Vec<&Piece> = vectors.iter().filter(three).take(8).collect();
    let mut out = Vec::new();
    for (i, u) in list.iter().enumerate() {
        for v in &list[i + 1..] {
            let across = expr::cross(u.value.clone(), v.value.clone());
            out.push(Candidate {
                name: format!("{}_across_{}_squared", u.name, v.name),
                value: expr::dot(across.clone(), across),
            });
        }
    }
    out
}

/// Products of three vectors.
fn products_in_three(vectors: &[Piece]) -> Vec<Candidate> {
    let three = |v: &&Piece| v.value.shape() == Shape::vector(Dim::Fixed(3));
    // If there are many vectors, the first eight are enough: the scalar products of all vectors are Casimirs already.
    let list: Vec<&Piece> = vectors.iter().filter(three).take(8).collect();
    let mut out = Vec::new();
    for (i, u) in list.iter().enumerate() {
        for (j, v) in list.iter().enumerate().skip(i + 1) {
            for w in &list[j + 1..] {
                out.push(Candidate {
                    name: format!("{}_{}_{}", u.name, v.name, w.name),
                    value: expr::dot(
                        u.value.clone(),
                        expr::cross(v.value.clone(), w.value.clone()),
                    ),
                });
            }
        }
    }
    out
}

/// For SO(n): traces of even powers of the part of a momentum that preserves an advected vector `a`, `|a|² μ - a
/// a^T μ - μ a a^T`.
fn across(x: &Inputs, vectors: &[Piece]) -> Vec<Candidate> {
    let s = &x.letters.symbols;
    let mut out = Vec::new();
    for id in &x.letters.node_momentum {
        let mu = expr::here(s, *id);
        for v in vectors {
            let n = v.value.shape().rows;
            if mu.shape() != Shape::square(n) || s.get(*id).structure != Structure::Skew {
                continue;
            }
            let outer = expr::mul(v.value.clone(), expr::transpose(s, v.value.clone()));
            let square = expr::dot(v.value.clone(), v.value.clone());
            let part = expr::sum(
                [
                    expr::mul(square, mu.clone()),
                    expr::neg(expr::mul(outer.clone(), mu.clone())),
                    expr::neg(expr::mul(mu.clone(), outer)),
                ],
                mu.shape(),
            );
            for power in [2i64, 4, 6] {
                let word = (0..power).map(|_| part.clone()).collect::<Vec<_>>();
                out.push(Candidate {
                    name: format!("momentum_across_{}_{power}", v.name),
                    value: expr::trace(expr::product(word)),
                });
            }
        }
    }
    out
}

/// For GL(n) with an advected form `C`: traces of powers of `C skew(C⁻¹ μ)`, and of the mirrored expressions. If the
/// velocity is in body axes, they are traces for the angular momentum in space, with the metric in the body frame. If
/// the velocity is in spatial axes, they are traces for the circulation, with the shape in the frame of space.
fn of_forms(x: &Inputs) -> Vec<Candidate> {
    let s = &x.letters.symbols;
    let mut out = Vec::new();
    for (i, c) in x.spec.configurations.iter().enumerate() {
        if !c.group.is_linear() {
            continue;
        }
        let n = c.group.size();
        let mu = expr::here(s, x.letters.node_momentum[i]);
        for a in &x.spec.advected {
            let symbol = s.get(a.quantity);
            if symbol.shape != Shape::square(n) || !symbol.structure.is_symmetric() {
                continue;
            }
            let form = expr::here(s, a.quantity);
            let inverse = expr::inverse(s, form.clone());
            let skew = |e: Expr| expr::part(Part::Skew, e);
            let name = match c.side.is_body() {
                true => "angular_momentum",
                false => "circulation",
            };
            let images = [
                expr::mul(form.clone(), skew(expr::mul(inverse.clone(), mu.clone()))),
                expr::mul(skew(expr::mul(mu.clone(), inverse.clone())), form.clone()),
                expr::mul(inverse.clone(), skew(expr::mul(form.clone(), mu.clone()))),
                expr::mul(skew(expr::mul(mu.clone(), form.clone())), inverse),
            ];
            for power in [2i64, 4] {
                for k in &images {
                    let word = (0..power).map(|_| k.clone()).collect::<Vec<_>>();
                    out.push(Candidate {
                        name: format!("{name}_{}_{power}", symbol.ascii),
                        value: expr::trace(expr::product(word)),
                    });
                }
            }
        }
    }
    out
}

/// The letters a candidate may depend on: node momenta and advected quantities.
pub(super) fn letters(x: &Inputs) -> Vec<SymbolId> {
    let momenta = x.letters.node_momentum.iter().copied();
    momenta
        .chain(x.spec.advected.iter().map(|a| a.quantity))
        .collect()
}

/// Whether a value depends only on momenta, advected quantities and parameters at the node.
pub(super) fn is_reduced(x: &Inputs, e: &Expr) -> bool {
    let own = letters(x);
    expr::letters(e).iter().all(|l| {
        *l == here(l.symbol) && (own.contains(&l.symbol) || x.spec.parameters.contains(&l.symbol))
    })
}
