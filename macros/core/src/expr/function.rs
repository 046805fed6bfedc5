//! Functions of one scalar: their names, derivatives and parity. All other properties are left to the evaluators.

use super::{Expr, Node, call, integer, mul, neg, power, quotient, sub, zero};
use crate::algebra::Rational;

/// Functions of one scalar.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Function {
    /// Exponential.
    Exp,
    /// Natural logarithm.
    Log,
    /// Sine.
    Sin,
    /// Cosine.
    Cos,
    /// Hyperbolic sine.
    Sinh,
    /// Hyperbolic cosine.
    Cosh,
    /// Hyperbolic tangent.
    Tanh,
    /// Absolute value; its derivative at 0, where it does not exist, is set to 0.
    Abs,
    /// The sign: -1, 0 or 1.
    Sign,
}

/// How the value changes with the sign of the argument.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Parity {
    /// `f(-x) = f(x)`.
    Even,
    /// `f(-x) = -f(x)`.
    Odd,
    /// Neither.
    None,
}

impl Function {
    /// All functions.
    pub const ALL: [Function; 9] = [
        Function::Exp,
        Function::Log,
        Function::Sin,
        Function::Cos,
        Function::Sinh,
        Function::Cosh,
        Function::Tanh,
        Function::Abs,
        Function::Sign,
    ];

    /// Its name in the language, and upright in formulas.
    pub fn word(self) -> &'static str {
        match self {
            Function::Exp => "exp",
            Function::Log => "log",
            Function::Sin => "sin",
            Function::Cos => "cos",
            Function::Sinh => "sinh",
            Function::Cosh => "cosh",
            Function::Tanh => "tanh",
            Function::Abs => "abs",
            Function::Sign => "sign",
        }
    }

    /// The function of that name.
    pub fn named(word: &str) -> Option<Function> {
        Function::ALL.into_iter().find(|f| f.word() == word)
    }

    /// Whether it is differentiable wherever it is defined.
    pub fn is_smooth(self) -> bool {
        !matches!(self, Function::Abs | Function::Sign)
    }

    /// Its parity.
    pub fn parity(self) -> Parity {
        match self {
            Function::Cos | Function::Cosh | Function::Abs => Parity::Even,
            Function::Sin | Function::Sinh | Function::Tanh | Function::Sign => Parity::Odd,
            Function::Exp | Function::Log => Parity::None,
        }
    }

    /// `f'(a) seed`, where `whole` is `f(a)`.
    pub(super) fn chain(self, whole: &Expr, a: &Expr, seed: Expr) -> Expr {
        match self {
            Function::Exp => mul(seed, whole.clone()),
            Function::Log => quotient(seed, a.clone()),
            Function::Sin => mul(seed, call(Function::Cos, a.clone())),
            Function::Cos => neg(mul(seed, call(Function::Sin, a.clone()))),
            Function::Sinh => mul(seed, call(Function::Cosh, a.clone())),
            Function::Cosh => mul(seed, call(Function::Sinh, a.clone())),
            Function::Tanh => {
                let square = power(whole.clone(), Rational::integer(2));
                mul(seed, sub(integer(1), square))
            }
            Function::Abs => mul(seed, call(Function::Sign, a.clone())),
            Function::Sign => zero(seed.shape()),
        }
    }

    /// Its value at an exactly known argument, if the value is rational.
    pub(super) fn at(self, a: &Expr) -> Option<Expr> {
        if let (Function::Abs, Node::Constant(_)) = (self, a.node()) {
            return Some(a.clone());
        }
        let Node::Number(q) = a.node() else {
            return None;
        };
        match self {
            Function::Sin | Function::Sinh | Function::Tanh if q.is_zero() => Some(integer(0)),
            Function::Cos | Function::Cosh | Function::Exp if q.is_zero() => Some(integer(1)),
            Function::Log if q.is_one() => Some(integer(0)),
            Function::Abs if q.is_negative() => Some(neg(a.clone())),
            Function::Abs => Some(a.clone()),
            Function::Sign => Some(integer(match (q.is_zero(), q.is_negative()) {
                (true, _) => 0,
                (_, true) => -1,
                _ => 1,
            })),
            _ => None,
        }
    }
}
