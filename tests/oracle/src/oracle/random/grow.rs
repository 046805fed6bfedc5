//! Grows random expressions of a wanted shape.
//! Takes a table of letters; gives scalars, vectors and matrices that stay of moderate size, with
//! arguments of roots, logarithms and inverses kept positive and those of exponentials bounded.

use super::tree::{Expr, Kind, Named, Role, Symbol};
use crate::oracle::points::Source;

/// Attempts to grow an expression with a wanted property before something simple is taken instead.
const ATTEMPTS: usize = 60;
/// The largest tree of one summand: derivations stay short and values moderate.
const LARGEST: usize = 40;

/// Where expressions grow.
#[derive(Debug)]
pub struct Garden<'a> {
    source: &'a mut Source,
    symbols: &'a [Symbol],
    lets: &'a [Named],
    /// Whether velocities and quantities at the head may occur.
    moving: bool,
}

impl<'a> Garden<'a> {
    /// A garden over a table of letters.
    pub fn new(
        source: &'a mut Source,
        symbols: &'a [Symbol],
        lets: &'a [Named],
        moving: bool,
    ) -> Self {
        Self {
            source,
            symbols,
            lets,
            moving,
        }
    }

    fn attempt(&mut self, wanted: impl Fn(&Expr) -> bool) -> Option<Expr> {
        for _ in 0..ATTEMPTS {
            let depth = 1 + self.source.below(4);
            let expr = self.scalar(depth);
            if expr.size() <= LARGEST && wanted(&expr) {
                return Some(expr);
            }
        }
        None
    }

    /// A scalar in which the velocity itself occurs.
    pub fn moving_with_velocity(&mut self) -> Expr {
        let lets = self.lets;
        let velocity = |expr: &Expr| matches!(expr, Expr::Symbol(1));
        self.attempt(|expr| expr.mentions(lets, &velocity))
            .unwrap_or_else(|| Expr::call("tr", vec![Expr::Symbol(2).times(Expr::Symbol(1))]))
    }

    /// A scalar with a velocity or a quantity at the head.
    pub fn moving(&mut self) -> Option<Expr> {
        let lets = self.lets;
        let moves = |expr: &Expr| matches!(expr, Expr::Symbol(1) | Expr::Next(_));
        self.attempt(|expr| expr.mentions(lets, &moves))
    }

    /// A scalar of advected quantities at one node.
    pub fn resting(&mut self) -> Option<Expr> {
        let (lets, symbols) = (self.lets, self.symbols);
        let moves = |expr: &Expr| matches!(expr, Expr::Symbol(1) | Expr::Next(_));
        let advected = |expr: &Expr| match expr {
            Expr::Symbol(index) => symbols
                .get(*index)
                .is_some_and(|symbol| matches!(symbol.role, Role::Advected { .. })),
            _ => false,
        };
        self.attempt(|expr| !expr.mentions(lets, &moves) && expr.mentions(lets, &advected))
    }

    fn letters(&self, kinds: &[Kind], advected: bool) -> Vec<usize> {
        (0..self.symbols.len())
            .filter(|&index| {
                self.symbols.get(index).is_some_and(|symbol| {
                    let fits = match symbol.role {
                        Role::Parameter => !advected,
                        Role::Advected { .. } => advected,
                        Role::Group | Role::Velocity => false,
                    };
                    fits && kinds.contains(&symbol.kind)
                })
            })
            .collect()
    }

    /// A letter of one of the kinds: advected with preference, at the head now and then.
    fn letter(&mut self, kinds: &[Kind]) -> Option<Expr> {
        let (parameters, advected) = (self.letters(kinds, false), self.letters(kinds, true));
        if self.source.chance(70)
            && let Some(&index) = self.source.choose(&advected)
        {
            let at_head = self.moving && self.source.chance(15);
            return Some(if at_head {
                Expr::Next(index)
            } else {
                Expr::Symbol(index)
            });
        }
        self.source
            .choose(&parameters)
            .map(|&index| Expr::Symbol(index))
    }

    /// The named subexpression, now and then, if it is of the kind.
    fn named(&mut self, kind: Kind) -> Option<Expr> {
        let fits = self.lets.first().is_some_and(|named| named.kind == kind);
        (fits && self.source.chance(45)).then_some(Expr::Let(0))
    }

    /// Parentheses now and then.
    fn dress(&mut self, expr: Expr) -> Expr {
        if self.source.chance(6) {
            expr.grouped()
        } else {
            expr
        }
    }

    fn star(&mut self, left: Expr, right: Expr) -> Expr {
        let juxtaposed = self.source.chance(15);
        Expr::product(left, right, juxtaposed)
    }

    fn velocity(&mut self) -> Expr {
        let velocity = Expr::Symbol(1);
        match self.source.below(20) {
            0 => velocity.to_power(-1),
            1 => Expr::call("inv", vec![velocity]),
            2..=7 => velocity.transposed(),
            _ => velocity,
        }
    }

    fn vector_atom(&mut self) -> Expr {
        if self.source.chance(8) {
            return Expr::Axis(1 + self.source.below(3));
        }
        self.letter(&[Kind::Vector]).unwrap_or(Expr::Axis(3))
    }

    fn matrix_atom(&mut self) -> Expr {
        if self.moving && self.source.chance(45) {
            return self.velocity();
        }
        if self.source.chance(12) {
            let vector = self.vector_atom();
            return Expr::call("hat", vec![vector]);
        }
        let kinds = [Kind::Symmetric, Kind::Positive, Kind::Skew, Kind::Matrix];
        self.letter(&kinds).unwrap_or(Expr::Identity)
    }

    /// A scalar of bounded size, for exponentials.
    fn bounded(&mut self) -> Expr {
        let inner = match self.source.below(3) {
            0 => {
                let (a, b) = (self.vector_atom(), self.vector_atom());
                Expr::call("dot", vec![a, b])
            }
            1 => {
                let (a, m, b) = (self.vector_atom(), self.matrix_atom(), self.vector_atom());
                let carried = self.star(m, b);
                Expr::call("dot", vec![a, carried])
            }
            _ => {
                let m = self.matrix_atom();
                Expr::call("tr", vec![m])
            }
        };
        inner.over(Expr::number("4", 4.0))
    }

    /// `1 + v·v`, `2 + x²` or a determinant that is at least 1.
    fn positive(&mut self, depth: usize) -> Expr {
        match self.source.below(4) {
            0 | 1 => {
                let v = self.vector(depth);
                Expr::number("1", 1.0).plus(Expr::call("dot", vec![v.clone(), v]))
            }
            2 => Expr::number("2", 2.0).plus(self.scalar(depth).to_power(2)),
            _ => {
                let matrix = self.positive_matrix();
                Expr::call("det", vec![matrix])
            }
        }
    }

    /// `Id + M Mᵀ` or the kinetic matrix: symmetric with eigenvalues bounded below.
    fn positive_matrix(&mut self) -> Expr {
        if self.source.chance(20) {
            return Expr::Symbol(2);
        }
        let m = self.matrix_atom();
        let m = if self.source.chance(40) {
            let other = self.matrix_atom();
            m.plus(other)
        } else {
            m
        };
        Expr::Identity.plus(self.star(m.clone(), m.transposed()))
    }

    /// A scalar.
    pub fn scalar(&mut self, depth: usize) -> Expr {
        if let Some(named) = self.named(Kind::Real) {
            return named;
        }
        let next = depth.saturating_sub(1);
        // Functions of scalars and determinants are offered twice: the idle ones among them fall away.
        let choice = match depth {
            0 => self.source.below(40),
            _ if self.source.chance(18) => 69 + self.source.below(25),
            _ => self.source.below(100),
        };
        let expr = match choice {
            0..=11 => {
                let (a, b) = (self.vector(next), self.vector(next));
                Expr::call("dot", vec![a, b])
            }
            12..=29 => {
                let m = self.matrix(next);
                Expr::call("tr", vec![m])
            }
            30..=35 => {
                let (a, b) = (self.vector_atom(), self.vector_atom());
                let m = self.matrix_atom();
                let carried = self.star(m, b);
                Expr::call("dot", vec![a, carried])
            }
            36..=37 => self.letter(&[Kind::Real]).unwrap_or(Expr::number("2", 2.0)),
            38..=39 => Expr::number("1.5", 1.5),
            40..=53 => {
                let (a, m, b) = (self.matrix_atom(), self.matrix_atom(), self.matrix_atom());
                let left = self.star(a, m);
                Expr::call("tr", vec![left.times(b)])
            }
            54..=58 => {
                let (a, b, c) = (self.vector(next), self.vector_atom(), self.vector_atom());
                Expr::call("dot", vec![a, Expr::call("cross", vec![b, c])])
            }
            59..=62 => {
                let (a, m, b) = (self.vector_atom(), self.matrix_atom(), self.vector_atom());
                let row = self.star(a.transposed(), m);
                row.times(b)
            }
            63..=68 => {
                let (a, b) = (self.scalar(next), self.scalar(next));
                self.star(a, b)
            }
            69..=73 => {
                let exponent = if self.source.chance(70) { 2 } else { 3 };
                self.scalar(next).to_power(exponent)
            }
            74..=77 => {
                let inner = self.positive(next);
                Expr::call("sqrt", vec![inner])
            }
            78..=80 => {
                let inner = self.bounded();
                Expr::call("exp", vec![inner])
            }
            81..=84 => {
                let inner = self.positive(next);
                Expr::call("log", vec![inner])
            }
            85..=87 => {
                let (above, below) = (self.scalar(next), self.positive(next));
                above.over(below)
            }
            88 => self.positive(next).to_power(-1),
            89..=91 => {
                let (a, b) = (self.matrix_atom(), self.matrix_atom());
                Expr::call("det", vec![a.plus(b)])
            }
            92..=93 => {
                let m = self.matrix(next);
                Expr::call("I2", vec![m])
            }
            94 => {
                let m = self.matrix(next);
                Expr::call("I1", vec![m])
            }
            95..=97 => {
                let (a, b) = (self.scalar(next), self.scalar(next));
                if self.source.chance(50) {
                    a.plus(b)
                } else {
                    a.minus(b)
                }
            }
            _ => self.scalar(next).negated(),
        };
        self.dress(expr)
    }

    /// A vector.
    pub fn vector(&mut self, depth: usize) -> Expr {
        if let Some(named) = self.named(Kind::Vector) {
            return named;
        }
        let next = depth.saturating_sub(1);
        let choice = if depth == 0 {
            0
        } else {
            self.source.below(100)
        };
        let expr = match choice {
            0..=34 => self.vector_atom(),
            35..=59 => {
                let (m, v) = (self.matrix(next), self.vector(next));
                self.star(m, v)
            }
            60..=69 => {
                let (a, b) = (self.vector(next), self.vector(next));
                Expr::call("cross", vec![a, b])
            }
            70..=77 => {
                let (a, b) = (self.vector(next), self.vector(next));
                if self.source.chance(50) {
                    a.plus(b)
                } else {
                    a.minus(b)
                }
            }
            78..=82 => {
                let (s, v) = (self.scalar(0), self.vector(next));
                self.star(s, v)
            }
            83..=86 => self.vector(next).negated(),
            87..=91 => {
                let m = self.matrix_atom();
                Expr::call("vee", vec![m.clone().minus(m.transposed())])
            }
            92..=94 => {
                let m = self.matrix(next);
                Expr::call("vee", vec![Expr::call("skew", vec![m])])
            }
            95..=97 => {
                let (m, v) = (self.positive_matrix(), self.vector_atom());
                Expr::call("inv", vec![m]).times(v)
            }
            _ => self.vector(next).over(Expr::number("2", 2.0)),
        };
        self.dress(expr)
    }

    /// A matrix.
    pub fn matrix(&mut self, depth: usize) -> Expr {
        if let Some(named) = self.named(Kind::Matrix) {
            return named;
        }
        let next = depth.saturating_sub(1);
        let choice = if depth == 0 {
            0
        } else {
            self.source.below(100)
        };
        let expr = match choice {
            0..=29 => self.matrix_atom(),
            30..=54 => {
                let (a, b) = (self.matrix(next), self.matrix(next));
                self.star(a, b)
            }
            55..=64 => {
                let (a, b) = (self.matrix(next), self.matrix(next));
                if self.source.chance(50) {
                    a.plus(b)
                } else {
                    a.minus(b)
                }
            }
            65..=69 => self.matrix(next).minus(Expr::Identity),
            70..=75 => self.matrix(next).transposed(),
            76..=80 => {
                let (a, b) = (self.vector(next), self.vector(next));
                self.star(a, b.transposed())
            }
            81..=84 => {
                let inner = self.positive_matrix();
                if self.source.chance(70) {
                    Expr::call("inv", vec![inner])
                } else {
                    inner.to_power(-1)
                }
            }
            85..=87 => Expr::call("sym", vec![self.matrix(next)]),
            88..=90 => Expr::call("skew", vec![self.matrix(next)]),
            91..=93 => Expr::call("hat", vec![self.vector(next)]),
            94..=96 => {
                let (s, m) = (self.scalar(0), self.matrix(next));
                self.star(s, m)
            }
            97 => self.matrix(next).over(Expr::number("3", 3.0)),
            _ => self.matrix(next).negated(),
        };
        self.dress(expr)
    }
}
