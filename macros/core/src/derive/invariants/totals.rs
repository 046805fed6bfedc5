//! Sums of the momenta of several bodies in the frame of one of them. Advected rotations transform momenta between
//! frames: the bodies that they connect can be rotated together, for any other couplings of the action. Takes the
//! configurations and the constraints; gives vectors for candidates for Casimirs.

use super::Inputs;
use super::casimir_candidates::Piece;
use super::noether::components;
use super::random_step::RandomStep;
use crate::algebra::Rational;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::SymbolId;
use crate::expr::{self, Expr};

const THREE: Dim = Dim::Fixed(3);

/// An advected rotation from one body's frame to another's.
struct Carrier {
    from: usize,
    to: usize,
    rotation: Expr,
    /// Whether it connects a body frame to space: a rotation of one is the inverse of a rotation of the other.
    opposite: bool,
}

/// The momentum of a body in the frame of another.
struct MomentumInFrame {
    body: usize,
    /// The rotations on the path, the last one first.
    by: Vec<Expr>,
    opposite: bool,
}

/// The sums, in the frame of every body of every set.
pub(super) fn totals(x: &Inputs, passages: &[RandomStep]) -> Vec<Piece> {
    let s = &x.letters.symbols;
    let carriers = carriers(x, passages);
    let mut sets = joined(x, &carriers);
    // Momenta in space are added directly.
    let of_space = |set: &Vec<usize>| {
        set.len() > 1
            && set.iter().all(|i| turn(x, *i).is_some())
            && set
                .iter()
                .all(|i| x.spec.configurations[*i].side.is_spatial())
    };
    let coupled: Vec<Vec<usize>> = components(x).into_iter().filter(of_space).collect();
    sets.retain(|set| !coupled.contains(set));
    let space = coupled.iter().flat_map(|set| {
        set.iter().map(move |frame| {
            let plain = |i: &usize| MomentumInFrame {
                body: *i,
                by: Vec::new(),
                opposite: false,
            };
            let first = std::iter::once(frame).chain(set.iter().filter(move |i| *i != frame));
            (set, first.map(plain).collect())
        })
    });
    let turned = sets.iter().flat_map(|set| {
        let carriers = &carriers;
        set.iter()
            .map(move |frame| (set, in_frame(carriers, *frame)))
    });
    let piece = |(set, list): (&Vec<usize>, Vec<MomentumInFrame>)| {
        let terms = list.into_iter().map(|c| {
            let turned = expr::product(c.by.into_iter().chain([momentum(x, c.body)]));
            match c.opposite {
                true => expr::scale(Rational::MINUS_ONE, turned),
                false => turned,
            }
        });
        let value = expr::sum(terms.collect::<Vec<_>>(), Shape::vector(THREE));
        let mut name = "total_momentum".to_owned();
        if set.len() < x.spec.configurations.len() {
            let elements = set.iter().map(|i| x.spec.configurations[*i].element);
            elements.for_each(|e| name += &format!("_{}", s.get(e).ascii));
        }
        Piece { name, value }
    };
    space.chain(turned).map(piece).collect()
}

fn momentum(x: &Inputs, body: usize) -> Expr {
    expr::here(&x.letters.symbols, x.letters.node_momentum[body])
}

/// The rotation of a three-dimensional element or velocity, or the rotation that it covers.
fn rotation(x: &Inputs, id: SymbolId) -> Option<Expr> {
    let s = &x.letters.symbols;
    let symbol = s.get(id);
    match symbol.structure {
        Structure::Orthogonal if symbol.shape == Shape::square(THREE) => Some(expr::here(s, id)),
        Structure::UnitQuaternion => Some(expr::rotation(s, expr::here(s, id))),
        _ => None,
    }
}

/// The rotation of the frame of a body in a step.
fn turn(x: &Inputs, body: usize) -> Option<Expr> {
    rotation(x, x.spec.configurations[body].velocity)
}

/// All advected rotations that connect two frames, in both directions. Only bodies whose velocities occur in the
/// constraint of the rotation can be connected by it.
fn carriers(x: &Inputs, passages: &[RandomStep]) -> Vec<Carrier> {
    let s = &x.letters.symbols;
    let mut out = Vec::new();
    for a in &x.spec.advected {
        let Some(own) = rotation(x, a.quantity) else {
            continue;
        };
        let letters = expr::letters(&a.update);
        let all = x.spec.configurations.iter().enumerate();
        let named = all.filter(|(_, c)| letters.iter().any(|l| l.symbol == c.velocity));
        let named: Vec<usize> = named.map(|(i, _)| i).collect();
        for rotation in [own.clone(), expr::transpose(s, own)] {
            let pairs = named
                .iter()
                .flat_map(|i| named.iter().map(move |j| (*i, *j)));
            for (from, to) in pairs.filter(|(from, to)| from != to) {
                let (Some(start), Some(end)) = (turn(x, from), turn(x, to)) else {
                    continue;
                };
                let side = |i: usize| x.spec.configurations[i].side;
                // A rotation in space is inverted at the start, and one in a body at the end.
                let start = if side(from).is_body() {
                    start
                } else {
                    expr::transpose(s, start)
                };
                let end = if side(to).is_body() {
                    expr::transpose(s, end)
                } else {
                    end
                };
                let carried = expr::product([end, rotation.clone(), start]);
                let joins = passages
                    .iter()
                    .all(|p| p.before.value(&carried) == p.after.value(&rotation));
                if joins {
                    out.push(Carrier {
                        from,
                        to,
                        rotation: rotation.clone(),
                        opposite: side(from) != side(to),
                    });
                }
            }
        }
    }
    out
}

/// Sets of bodies that advected rotations connect, in order of declaration.
fn joined(x: &Inputs, carriers: &[Carrier]) -> Vec<Vec<usize>> {
    let mut out: Vec<Vec<usize>> = Vec::new();
    for i in 0..x.spec.configurations.len() {
        if out.iter().any(|set| set.contains(&i)) {
            continue;
        }
        let mut set: Vec<usize> = in_frame(carriers, i).iter().map(|c| c.body).collect();
        set.sort_unstable();
        if set.len() > 1 {
            out.push(set);
        }
    }
    out
}

/// The bodies that rotations connect to a frame, with these rotations. The frame itself comes first.
fn in_frame(carriers: &[Carrier], frame: usize) -> Vec<MomentumInFrame> {
    let mut reached = vec![MomentumInFrame {
        body: frame,
        by: Vec::new(),
        opposite: false,
    }];
    let mut k = 0;
    while let Some(here) = reached.get(k) {
        let (to, by, opposite) = (here.body, here.by.clone(), here.opposite);
        for c in carriers.iter().filter(|c| c.to == to) {
            if reached.iter().all(|r| r.body != c.from) {
                reached.push(MomentumInFrame {
                    body: c.from,
                    by: by.iter().cloned().chain([c.rotation.clone()]).collect(),
                    opposite: opposite != c.opposite,
                });
            }
        }
        k += 1;
    }
    reached.sort_by_key(|c| (c.body != frame, c.body));
    reached
}
