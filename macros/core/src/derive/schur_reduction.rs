//! Schur reduction: unknowns that occur linearly in their own equations are eliminated in closed form before the
//! other unknowns are solved. These are translations of rigid motions, if the balance of linear momentum is linear in
//! them. Its matrix must be a product of invertible factors that contain rotations and constants. Newton's method
//! then finds rotations only, with the whole derivative of the remaining equations. Takes velocities in parts and
//! their equations; gives the solution and the remaining equations.

use super::parts::{Parts, Velocity};
use super::tangent::Direction;
use crate::check::spec::Side;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, InvertedFactor, Letter, Shift};

const THREE: Dim = Dim::Fixed(3);

/// The unknowns that are eliminated, and their solution.
#[derive(Clone, Debug)]
pub struct SchurReduction {
    /// The letters of the parts, and those below.
    pub symbols: Symbols,
    /// The rotation of every velocity.
    pub rotations: Vec<SymbolId>,
    /// The Rodrigues vector of the rotation of every velocity.
    pub turns: Vec<SymbolId>,
    /// The translations.
    pub places: Vec<Place>,
}

/// A translation that is solved for.
#[derive(Clone, Debug)]
pub struct Place {
    /// The velocity to which it belongs.
    pub velocity: usize,
    /// The index of its equation, in blocks of three.
    pub block: usize,
    /// The letter of the node momentum in it.
    pub momentum: SymbolId,
    /// The intermediate values from which it is computed, in order; the translation itself is the last.
    pub steps: Vec<(SymbolId, Expr)>,
    /// The matrix of its equation.
    factors: Vec<InvertedFactor>,
}

impl Place {
    /// The constant matrices whose inverses are needed.
    pub fn constants(&self) -> impl Iterator<Item = &Expr> {
        self.factors.iter().filter_map(|f| match f {
            InvertedFactor::Matrix(a) => Some(a),
            InvertedFactor::Cayley { .. } | InvertedFactor::Turn(_) => None,
        })
    }

    /// An expression in which intermediate values replace the expressions that they equal.
    fn by_steps(&self, symbols: &Symbols, e: &Expr) -> Expr {
        let steps: Vec<Expr> = self
            .steps
            .iter()
            .map(|(id, _)| expr::here(symbols, *id))
            .collect();
        let mut e = e.clone();
        for (f, pair) in self.factors.iter().skip(1).zip(steps.windows(2)).rev() {
            e = f.acted(symbols, &e, &pair[1], &pair[0]);
        }
        e
    }
}

fn at(symbol: SymbolId) -> Letter {
    Letter {
        symbol,
        shift: Shift::HERE,
    }
}

impl SchurReduction {
    /// The reduction of equations in parts, if the velocities are rotations and rigid motions.
    pub fn of(parts: &Parts, list: &[Expr]) -> Option<SchurReduction> {
        let mut symbols = parts.symbols.clone();
        let vector = Shape::vector(THREE);
        let mut add = |name: &str| {
            let name = symbols.fresh_name(name);
            symbols.add(&name, vector, Structure::General, Role::Derived)
        };
        let (mut turns, mut rotations, mut motions, mut block) = (vec![], vec![], vec![], 0);
        for (velocity, v) in parts.velocities.iter().enumerate() {
            let (rotation, position) = match *v {
                Velocity::Rotation(w) => (w, None),
                Velocity::Motion(w, x) => (w, Some(x)),
                Velocity::Quaternion(..) => return None,
            };
            let name = parts.symbols.get(rotation).name.clone();
            turns.push(add(&format!("{name}_turn")));
            rotations.push(rotation);
            if let Some(x) = position {
                let name = parts.symbols.get(x).name.clone();
                let momentum = add(&format!("{name}_momentum"));
                // One letter per factor of a matrix, apart from the translation itself.
                let before: Vec<SymbolId> = (1..5).map(|i| add(&format!("{name}_{i}"))).collect();
                motions.push((velocity, block + 1, x, momentum, before));
            }
            block += 1 + usize::from(position.is_some());
        }
        let turn_of = |q: &Expr| {
            let i = rotations
                .iter()
                .position(|w| expr::here(&symbols, *w) == *q)?;
            Some(expr::here(&symbols, turns[i]))
        };
        let direction = Direction {
            symbols: &symbols,
            letter: parts.direction,
        };
        let mut places: Vec<Place> = Vec::new();
        for (velocity, block, x, momentum, before) in motions {
            let along = [(at(x), expr::here(&symbols, parts.direction))];
            let derivative =
                expr::collect(&symbols, &expr::directional(&symbols, &list[block], &along));
            let Some(matrix) = direction.matrix(&derivative) else {
                continue;
            };
            let matrix = expr::factored(&symbols, &matrix);
            // Translations that are already eliminated do not count as known either.
            let known = |x: SymbolId| !expr::contains(&matrix, at(x));
            let met = |p: &Place| {
                let own = p
                    .steps
                    .last()
                    .is_some_and(|(x, _)| expr::contains(&list[block], at(*x)));
                own || expr::contains(&list[p.block], at(x))
            };
            if !known(x) || places.iter().any(met) {
                continue;
            }
            let Some((number, factors)) = InvertedFactor::factors(&symbols, &matrix, turn_of)
            else {
                continue;
            };
            if factors.len() > before.len() {
                continue;
            }
            let nowhere = [(at(x), expr::zero(vector))];
            let rest = expr::substitute(&symbols, &list[block], &nowhere);
            let asked = expr::sub(expr::here(&symbols, momentum), rest);
            let asked = expr::collect(&symbols, &expr::mul(number, asked));
            let mut value = expr::factored(&symbols, &asked);
            let mut steps = Vec::new();
            for (i, f) in factors.iter().enumerate() {
                value = f.undo(&symbols, &value, false);
                let name = if i + 1 == factors.len() { x } else { before[i] };
                steps.push((name, value));
                value = expr::here(&symbols, name);
            }
            if factors.is_empty() {
                steps.push((x, value));
            }
            places.push(Place {
                velocity,
                block,
                momentum,
                steps,
                factors,
            });
        }
        (!places.is_empty()).then_some(SchurReduction {
            symbols,
            rotations,
            turns,
            places,
        })
    }

    /// The intermediate values from which translations are computed, in order.
    pub fn steps(&self) -> Vec<(SymbolId, Expr)> {
        self.places.iter().flat_map(|p| p.steps.clone()).collect()
    }

    /// Whether this is one of the letters that vary with the unknowns.
    pub fn varies(&self, l: Letter) -> bool {
        let mut steps = self.places.iter().flat_map(|p| &p.steps);
        self.turns.iter().any(|t| at(*t) == l) || steps.any(|(id, _)| at(*id) == l)
    }

    /// The indices of the remaining equations.
    pub fn left(&self, count: usize) -> Vec<usize> {
        (0..count)
            .filter(|i| self.places.iter().all(|p| p.block != *i))
            .collect()
    }

    /// An expression in the intermediate values of the translations.
    pub fn written(&self, e: &Expr) -> Expr {
        let all = self.places.iter();
        all.fold(e.clone(), |e, p| p.by_steps(&self.symbols, &e))
    }

    /// The whole derivative of the remaining equations, from the blocks of the tangent row by row. `along` has the
    /// blocks for independent changes of the translations.
    pub fn tangent(&self, blocks: &[Expr], along: &[Expr], side: Side) -> Vec<Expr> {
        let s = &self.symbols;
        let count = blocks.len().isqrt();
        let left = self.left(count);
        let of = |i: usize, j: usize| blocks[i * count + j].clone();
        let mut out = Vec::new();
        for i in &left {
            for j in &left {
                let mut total = self.written(&of(*i, *j));
                for p in &self.places {
                    let column = if side.is_body() {
                        along[i * count + p.block].clone()
                    } else {
                        of(*i, p.block)
                    };
                    total = expr::sub(
                        total,
                        self.carried(p, column, of(p.block, *j), along, count),
                    );
                }
                out.push(expr::simpler(s, &total));
            }
        }
        out
    }

    /// `A B⁻¹ C`, where `B` is the matrix of a translation.
    fn carried(&self, p: &Place, a: Expr, c: Expr, along: &[Expr], count: usize) -> Expr {
        let s = &self.symbols;
        let own = &along[p.block * count + p.block];
        let turn = |_: &Expr| Some(expr::zero(Shape::vector(THREE)));
        let number =
            InvertedFactor::factors(s, own, turn).map_or(expr::integer(1), |(number, _)| number);
        let mut factors = p.factors.as_slice();
        let (mut a, mut c) = (a, c);
        if let [before @ .., last] = factors
            && last.stands_in(&a, true)
        {
            a = last.undo(s, &a, true);
            factors = before;
        }
        for f in factors {
            c = f.undo(s, &c, false);
        }
        expr::product([number, self.written(&a), self.written(&c)])
    }
}
