//! Random hyperelastic energies: sums of products of powers, logarithms and exponentials of the invariants of a
//! matrix X. Takes a seeded source; gives the text of an energy and its value in any numbers of the oracle.

use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::Square;

/// The invariants from which energies are built, in the syntax of the language.
const INVARIANTS: [&str; 4] = ["I1(X)", "I2(X)", "det(X)", "tr(X*X)"];

/// Functions of one invariant.
#[derive(Clone, Copy, Debug)]
enum Function {
    /// An exponent as a quotient of whole numbers.
    Power(i32, i32),
    /// The logarithm to a power.
    Log(i32),
    /// The exponential of this share of the invariant, in tenths, as of Fung's energies.
    Exp(i32),
}

#[derive(Clone, Copy, Debug)]
struct Factor {
    invariant: usize,
    function: Function,
}

/// A coefficient in hundredths times one or two factors.
#[derive(Clone, Debug)]
struct Term {
    hundredths: i32,
    factors: Vec<Factor>,
}

/// An energy of a unit of volume of the reference.
#[derive(Clone, Debug)]
pub struct Energy(Vec<Term>);

impl Function {
    fn random(source: &mut Source) -> Self {
        const POWERS: [(i32, i32); 8] = [
            (1, 1),
            (1, 1),
            (2, 1),
            (-1, 1),
            (1, 2),
            (3, 2),
            (-1, 3),
            (-2, 3),
        ];
        match source.below(5) {
            0 => Self::Log(if source.chance(50) { 1 } else { 2 }),
            1 => Self::Exp(if source.chance(50) { 1 } else { -1 }),
            _ => {
                let (n, d) = POWERS[source.below(POWERS.len())];
                Self::Power(n, d)
            }
        }
    }

    /// A function that grows slowly, so that products of two do not disrupt a body.
    fn slow(source: &mut Source) -> Self {
        match source.below(4) {
            0 => Self::Log(1),
            1 => Self::Exp(-1),
            2 => Self::Power(1, 2),
            _ => Self::Power(-2, 3),
        }
    }

    fn text(self, of: &str) -> String {
        match self {
            Self::Power(1, 1) => of.to_owned(),
            Self::Power(n, 1) => format!("({of})^({n})"),
            Self::Power(n, d) => format!("({of})^({n}/{d})"),
            Self::Log(1) => format!("log({of})"),
            Self::Log(n) => format!("log({of})^{n}"),
            Self::Exp(tenths) => format!("exp(({tenths}/10)*{of})"),
        }
    }

    fn value<T: Number>(self, of: T) -> T {
        match self {
            Self::Power(n, 1) => of.power(n),
            Self::Power(n, d) => of.fraction(n, d),
            Self::Log(n) => of.ln().power(n),
            Self::Exp(tenths) => (T::constant(f64::from(tenths) / 10.0) * of).exp(),
        }
    }
}

impl Energy {
    /// Three to five terms, and a term that keeps determinants away from zero.
    pub fn random(source: &mut Source) -> Self {
        let mut terms = vec![Term {
            hundredths: -50 - source.below(100) as i32,
            factors: vec![Factor {
                invariant: 2,
                function: Function::Log(1),
            }],
        }];
        for _ in 0..3 + source.below(3) {
            let mut factor = |function: fn(&mut Source) -> Function| Factor {
                invariant: source.below(INVARIANTS.len()),
                function: function(source),
            };
            let mut factors = vec![factor(Function::random)];
            let second = factor(Function::slow);
            if source.chance(50) {
                factors.push(second);
            }
            terms.push(Term {
                hundredths: 10 + source.below(90) as i32,
                factors,
            });
        }
        Self(terms)
    }

    /// As the language writes it, of a matrix X.
    pub fn text(&self) -> String {
        let term = |term: &Term| {
            let factors = term.factors.iter();
            let factors: Vec<String> = factors
                .map(|f| f.function.text(INVARIANTS[f.invariant]))
                .collect();
            format!("({}/100)*{}", term.hundredths, factors.join("*"))
        };
        self.0.iter().map(term).collect::<Vec<_>>().join(" + ")
    }

    /// The energy with another exponent or weight in one factor.
    pub fn changed(&self, source: &mut Source) -> Self {
        let mut terms = self.0.clone();
        let at = source.below(terms.len());
        let factors = &mut terms[at].factors;
        let at = source.below(factors.len());
        factors[at].function = match factors[at].function {
            Function::Power(n, d) => Function::Power(n + d, d),
            Function::Log(n) => Function::Log(3 - n),
            Function::Exp(tenths) => Function::Exp(-tenths),
        };
        Self(terms)
    }

    /// The values of its terms.
    pub fn terms<T: Number>(&self, x: &Square<T, 3>) -> Vec<T> {
        let invariants = [
            x.trace(),
            x.second_invariant(),
            x.determinant(),
            (*x * *x).trace(),
        ];
        let one = |term: &Term| {
            let coefficient = T::constant(f64::from(term.hundredths) / 100.0);
            let factors = term.factors.iter();
            factors.fold(coefficient, |product, f| {
                product * f.function.value(invariants[f.invariant])
            })
        };
        self.0.iter().map(one).collect()
    }
}
