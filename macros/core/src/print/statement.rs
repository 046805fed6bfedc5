//! Writes expressions in the model language, with names as declared. Parsing the text gives the same expression
//! again, so brackets are added wherever the expression constructors would otherwise group differently.

use super::Style;
use crate::algebra::Rational;
use crate::expr::shape::Dim;
use crate::expr::symbol::Symbols;
use crate::expr::{Applied, Expr, Map, Node, Part};

/// Writes an expression as model text, e.g. `-(tr(J*Ω)/h) - h*dot(gU, Γ)`. Time offsets become `next(...)` and
/// `prev(...)`; label offsets use the label names of `style`. `Id`, `0` and `E1` take their shape from the context.
pub fn statement(e: &Expr, symbols: &Symbols, style: &Style) -> String {
    Writer { symbols, style }.write(e).text
}

/// Axes with named unit vectors, `E1` to `E3`; components along other axes are written by index.
const NAMED_AXES: u32 = 3;

/// Precedence of text in the model language, loosest binding first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Tightness {
    Sum,
    Minus,
    Product,
    Postfix,
    Operand,
}

struct RankedText {
    text: String,
    tightness: Tightness,
}

impl RankedText {
    fn new(text: String, tightness: Tightness) -> RankedText {
        RankedText { text, tightness }
    }

    fn at_least(self, wanted: Tightness) -> String {
        if self.tightness >= wanted {
            self.text
        } else {
            format!("({})", self.text)
        }
    }
}

struct Writer<'a> {
    symbols: &'a Symbols,
    style: &'a Style,
}

impl Writer<'_> {
    fn write(&self, e: &Expr) -> RankedText {
        use Tightness::{Minus, Operand, Postfix, Product, Sum};
        let operand = |text: String| RankedText::new(text, Operand);
        match e.node() {
            Node::Number(q) => {
                let text = rational(*q);
                let tightness = match (q.is_negative(), q.denominator()) {
                    (true, _) => Minus,
                    (false, 1) => Operand,
                    (false, _) => Product,
                };
                RankedText::new(text, tightness)
            }
            Node::Constant(c) => operand(c.to_string()),
            Node::Letter(at) => {
                let mut text = self.symbols.get(at.symbol).name.clone();
                text = shifted(text, at.shift.time, "");
                for (i, by) in at.shift.label.into_iter().enumerate() {
                    let label = self.style.label_indices.get(i);
                    let label = label.map_or_else(String::new, |l| format!(", {l}"));
                    text = shifted(text, by, &label);
                }
                operand(text)
            }
            Node::Identity(_) => operand("Id".to_owned()),
            Node::Zero(_) => operand("0".to_owned()),
            Node::Unit(_, axis) => operand(format!("E{}", u32::from(*axis) + 1)),
            // Only derived expressions contain inclusions; statements do not.
            Node::Inclusion(..) => operand("ι".to_owned()),
            Node::Sum(terms) => RankedText::new(self.sum(terms), Sum),
            Node::Neg(a) => RankedText::new(self.negated(a), Minus),
            Node::Product(factors) => RankedText::new(self.product(factors), Product),
            Node::Quotient(a, b) => RankedText::new(self.quotient(a, b), Product),
            Node::Power(a, q) => self.power(a, *q),
            Node::Transpose(a) => RankedText::new(format!("{}^T", self.base(a)), Postfix),
            Node::Inverse(a) => RankedText::new(format!("{}^-1", self.base(a)), Postfix),
            Node::Trace(a) => operand(self.call("tr", &[a])),
            Node::Det(a) => operand(self.call("det", &[a])),
            // The language does not have a word for the adjugate, and statements do not contain one.
            Node::Adjugate(a) => {
                operand(format!("(det({})*{}^-1)", self.write(a).text, self.base(a)))
            }
            Node::Dot(a, b) => match self.component(a, b) {
                Some(text) => RankedText::new(text, Postfix),
                None => operand(self.call("dot", &[a, b])),
            },
            Node::Cross(a, b) => operand(self.call("cross", &[a, b])),
            Node::Hat(a) => operand(self.call("hat", &[a])),
            Node::Vee(a) => operand(self.call("vee", &[a])),
            Node::Part(which, a) => operand(self.call(
                match which {
                    Part::Symmetric => "sym",
                    Part::Skew => "skew",
                    Part::Diagonal => "diag",
                },
                &[a],
            )),
            Node::Call(function, a) => operand(self.call(function.word(), &[a])),
            Node::Map(map, a) => operand(self.call(
                match map {
                    Map::Real => "re",
                    Map::Imaginary => "im",
                    Map::Pure => "quat",
                    Map::Rotation => "rot",
                    Map::Translation => "pos",
                    Map::Twist => "twist",
                    Map::Diagonal => "diag",
                    // Occurs in derived expressions only, not in statements.
                    Map::DiagonalOf => "diagonal",
                },
                &[a],
            )),
            Node::Given(a) => operand(self.functional(a)),
            // Occurs in derived expressions only, not in statements.
            Node::PullBack(a, which, seed) => {
                let (f, seed) = (self.functional(a), self.write(seed).text);
                operand(format!("pull_back({f}, {}, {seed})", u32::from(*which) + 1))
            }
        }
    }

    /// `f(x, y)`, wrapped in its derivatives. Statements do not contain derivatives.
    fn functional(&self, a: &Applied) -> String {
        let arguments: Vec<&Expr> = a.arguments.iter().collect();
        let name = &self.symbols.functional(a.functional).name;
        let value = self.call(name, &arguments);
        a.along.iter().fold(value, |inside, (which, x)| {
            let along = self.write(x).text;
            format!("along({inside}, {}, {along})", u32::from(*which) + 1)
        })
    }

    fn call(&self, name: &str, arguments: &[&Expr]) -> String {
        let texts: Vec<String> = arguments.iter().map(|a| self.write(a).text).collect();
        format!("{name}({})", texts.join(", "))
    }

    /// A component along an axis without a named unit vector.
    fn component(&self, a: &Expr, axis: &Expr) -> Option<String> {
        let count = |e: &Expr| match e.node() {
            Node::Unit(_, axis) => Some(u32::from(*axis) + 1),
            _ => None,
        };
        let i = count(axis)?;
        if let Node::Product(factors) = a.node()
            && let [rest @ .., last] = factors.as_slice()
            && let Some(j) = count(last)
            && i.max(j) > NAMED_AXES
        {
            let rest = crate::expr::product(rest.to_vec());
            return Some(format!("{}[{i}, {j}]", self.base(&rest)));
        }
        (i > NAMED_AXES).then(|| format!("{}[{i}]", self.base(a)))
    }

    fn base(&self, a: &Expr) -> String {
        self.write(a).at_least(Tightness::Operand)
    }

    fn power(&self, a: &Expr, q: Rational) -> RankedText {
        if q == Rational::HALF {
            return RankedText::new(self.call("sqrt", &[a]), Tightness::Operand);
        }
        let exponent = if q.denominator() == 1 {
            q.numerator().to_string()
        } else {
            format!("({})", rational(q))
        };
        RankedText::new(format!("{}^{exponent}", self.base(a)), Tightness::Postfix)
    }

    /// A minus sign and its operand. The minus binds to the first factor only. The constructors move it out of a
    /// product, but into a sum or a single number.
    fn negated(&self, a: &Expr) -> String {
        let carried = |first: Option<&Expr>| !matches!(first.map(Expr::node), Some(Node::Sum(_)));
        let bare = match a.node() {
            Node::Product(factors) => carried(factors.first()),
            Node::Quotient(top, _) => match top.node() {
                Node::Product(factors) => carried(factors.first()),
                Node::Number(_) | Node::Quotient(..) | Node::Sum(_) => false,
                _ => true,
            },
            _ => false,
        };
        let wanted = if bare {
            Tightness::Product
        } else {
            Tightness::Postfix
        };
        format!("-{}", self.write(a).at_least(wanted))
    }

    fn sum(&self, terms: &[Expr]) -> String {
        let mut text = String::new();
        for t in terms {
            if text.is_empty() {
                text = self.write(t).at_least(Tightness::Minus);
                continue;
            }
            let (sign, inner) = match t.node() {
                Node::Neg(inner) => (" - ", self.write(inner)),
                Node::Number(q) if q.is_negative() => {
                    (" - ", self.write(&crate::expr::number(q.negated())))
                }
                _ => (" + ", self.write(t)),
            };
            text.push_str(sign);
            text.push_str(&inner.at_least(Tightness::Product));
        }
        text
    }

    /// A factor between asterisks; a product as a factor keeps its brackets.
    fn factor(&self, f: &Expr) -> String {
        self.write(f).at_least(Tightness::Postfix)
    }

    fn product(&self, factors: &[Expr]) -> String {
        let (numbers, matrices): (Vec<&Expr>, Vec<&Expr>) =
            factors.iter().partition(|f| f.shape().is_scalar());
        let mut parts: Vec<String> = numbers.iter().map(|f| self.factor(f)).collect();
        // A row times a column would become a number before the next factor. So a column is grouped with the row
        // after it, and numbers with the row before it.
        let mut words: Vec<String> = Vec::new();
        let mut list = matrices.iter().peekable();
        while let Some(f) = list.next() {
            let mut word = self.factor(f);
            if f.shape().is_vector()
                && let Some(next) = list.next_if(|n| n.shape().transposed().is_vector())
            {
                word = format!("({word}*{})", self.factor(next));
            }
            words.push(word);
        }
        let one = Dim::Fixed(1);
        let scalar = matrices.first().is_some_and(|f| f.shape().rows == one)
            && matrices.last().is_some_and(|f| f.shape().cols == one);
        if scalar && !parts.is_empty() && words.len() > 1 {
            parts.push(words.remove(0));
            words.insert(0, format!("({})", parts.join("*")));
            parts.clear();
        }
        parts.append(&mut words);
        parts.join("*")
    }

    fn quotient(&self, a: &Expr, b: &Expr) -> String {
        let bottom = self.write(b).at_least(Tightness::Postfix);
        match a.node() {
            // The constructors would merge a quotient over a divisor into one quotient.
            Node::Quotient(..) => format!("(1/{bottom})*({})", self.write(a).text),
            Node::Number(q) if q.denominator() == 1 => {
                format!("{}/{bottom}", self.write(a).at_least(Tightness::Minus))
            }
            _ => format!("{}/{bottom}", self.write(a).at_least(Tightness::Product)),
        }
    }
}

fn rational(q: Rational) -> String {
    if q.denominator() == 1 {
        q.numerator().to_string()
    } else {
        format!("{}/{}", q.numerator(), q.denominator())
    }
}

fn shifted(mut text: String, by: i8, label: &str) -> String {
    let word = if by > 0 { "next" } else { "prev" };
    for _ in 0..by.unsigned_abs() {
        text = format!("{word}({text}{label})");
    }
    text
}
