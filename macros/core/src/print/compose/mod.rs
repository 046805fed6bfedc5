//! Composes expressions and formulas into layouts. All decisions on brackets, signs, scripts and fractions are made
//! here, once for all formats.

mod expression;
mod formula;
mod functional;
pub(super) mod parts;

use super::Style;
use super::layout::{Fence, Layout, Sign, Strength};
use super::level::{Level, RankedLayout};
use super::width::{Size, width};
use super::{name, tex};
use crate::algebra::Rational;
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{Constant, Letter};

/// From this width in tenths of a point, a hat is no longer drawn over its argument.
const WIDEST_HAT: usize = 540;

/// Composes layouts in one style.
pub(super) struct Composer<'a> {
    pub symbols: &'a Symbols,
    pub style: &'a Style,
    /// Whether numerators are placed above denominators.
    pub stacked: bool,
}

impl Composer<'_> {
    /// A letter with its indices.
    fn letter(&self, at: Letter) -> Layout {
        let symbol = self.symbols.get(at.symbol);
        if let (true, Some(latex)) = (self.stacked, &symbol.typeset) {
            let name = Layout::Typeset(latex.clone(), Box::new(tex::layout(latex)));
            return self.indexed(name, Vec::new(), symbol.role, at);
        }
        let parsed = symbol.parsed();
        let subs: Vec<Layout> = parsed.subs.iter().map(|s| name::script(s)).collect();
        let layout = self.indexed(letters(parsed.base), subs, symbol.role, at);
        match parsed.sup.as_deref() {
            Some(text) => layout.superscript(name::script(text)),
            None => layout,
        }
    }

    /// A name with its own subscripts and those of the time node and the labels.
    fn indexed(&self, base: Layout, mut subs: Vec<Layout>, role: Role, at: Letter) -> Layout {
        if lives_in_time(role) {
            subs.extend(offset(&self.style.time_index, at.shift.time));
            for (i, by) in at.shift.label.into_iter().enumerate() {
                let index = self.style.label_indices.get(i).map_or("", String::as_str);
                subs.extend(offset(index, by));
            }
        }
        subscripted(base, subs)
    }

    /// A name with scripts given as text.
    fn name(&self, base: &str, sub: Option<&str>, sup: Option<&str>) -> Layout {
        let parsed = name::parse(base);
        let texts = parsed.subs.iter().map(String::as_str).chain(sub);
        let subs = texts.map(name::script).collect();
        scripted(parsed.base, subs, sup.or(parsed.sup.as_deref()))
    }

    /// A non-negative number.
    fn number(&self, q: Rational) -> RankedLayout {
        let digits = |n: i128| Layout::Number(n.to_string());
        let (num, den) = (q.numerator(), q.denominator());
        if den == 1 {
            return RankedLayout::atom(digits(num));
        }
        if let Some(decimal) = decimal(num, den) {
            return RankedLayout::atom(Layout::Number(decimal));
        }
        if self.stacked {
            let fraction = Layout::Fraction(Box::new(digits(num)), Box::new(digits(den)));
            return RankedLayout::new(fraction, Level::Prefix);
        }
        match vulgar(num, den) {
            Some(c) => RankedLayout::new(Layout::Number(c.to_string()), Level::Prefix),
            None => {
                let row = vec![digits(num), Layout::Sign(Sign::Slash), digits(den)];
                RankedLayout::new(Layout::Row(row), Level::Slash)
            }
        }
    }

    /// A constant that exact arithmetic does not cover: π, or digits times a power of ten.
    fn constant(&self, c: Constant) -> RankedLayout {
        let number = |text: &str| Layout::Number(text.to_owned());
        if c == Constant::PI {
            return RankedLayout::atom(Layout::Identifier("π".to_owned()));
        }
        let (digits, power) = c.digits();
        if (-4..=8).contains(&power) {
            return RankedLayout::atom(number(&c.value().to_string()));
        }
        let mut exponent = Vec::new();
        if power < 0 {
            exponent.push(Layout::Sign(Sign::Tight('-')));
        }
        exponent.push(number(&power.unsigned_abs().to_string()));
        let ten = number("10").superscript(Layout::row(exponent));
        let row = match digits.as_str() {
            "1" => vec![ten],
            _ => vec![number(&digits), Layout::Sign(Sign::Cross), ten],
        };
        RankedLayout::new(Layout::row(row), Level::Infix)
    }

    /// A sum of signed terms; `true` marks one that is subtracted.
    fn sum(&self, terms: Vec<(bool, RankedLayout)>) -> RankedLayout {
        let several = terms.len() > 1;
        let signed = terms.first().is_some_and(|(minus, _)| *minus);
        if !several && !signed {
            let zero = || RankedLayout::atom(Layout::Number("0".to_owned()));
            return terms.into_iter().next().map_or_else(zero, |(_, only)| only);
        }
        let mut row = Vec::new();
        for (i, (minus, term)) in terms.into_iter().enumerate() {
            match (i, minus) {
                (0, true) => row.push(Layout::Sign(Sign::Negative)),
                (0, false) => {}
                (_, minus) => {
                    row.push(Layout::Break(Strength::Term));
                    let sign = if minus { Sign::Minus } else { Sign::Plus };
                    row.push(Layout::Sign(sign));
                }
            }
            row.push(term.term());
        }
        let level = if several { Level::Sum } else { Level::Signed };
        RankedLayout::new(Layout::Row(row), level)
    }

    /// Juxtaposes factors that already have their brackets.
    fn beside(&self, factors: Vec<Layout>) -> RankedLayout {
        let mut row = Vec::new();
        for f in factors {
            if !row.is_empty() {
                row.push(Layout::Break(Strength::Factor));
                row.push(Layout::Sign(Sign::Times));
            }
            row.push(f);
        }
        RankedLayout::new(Layout::row(row), Level::Product)
    }

    /// A numerator over a denominator.
    fn fraction(&self, top: RankedLayout, bottom: RankedLayout) -> RankedLayout {
        if self.stacked {
            let fraction = Layout::Fraction(Box::new(top.layout), Box::new(bottom.layout));
            return RankedLayout::new(fraction, Level::Prefix);
        }
        let row = vec![
            top.before_slash(),
            Layout::Sign(Sign::Slash),
            bottom.after_slash(),
        ];
        RankedLayout::new(Layout::Row(row), Level::Slash)
    }

    /// Joins `a` and `b` with an infix sign.
    fn infix(&self, a: RankedLayout, sign: Sign, b: RankedLayout, level: Level) -> RankedLayout {
        let at = Layout::Break(Strength::Factor);
        let row = vec![a.operand(), at, Layout::Sign(sign), b.operand()];
        RankedLayout::new(Layout::Row(row), level)
    }

    /// A rational power.
    fn power(&self, base: RankedLayout, q: Rational) -> RankedLayout {
        if q.is_one() {
            return base;
        }
        if q == Rational::HALF {
            return self.root(base);
        }
        let mut row = Vec::new();
        if q.is_negative() {
            row.push(Layout::Sign(Sign::Tight('-')));
        }
        row.push(Layout::Number(q.numerator().unsigned_abs().to_string()));
        if q.denominator() != 1 {
            row.push(Layout::Sign(Sign::Tight('/')));
            row.push(Layout::Number(q.denominator().to_string()));
        }
        base.raised(Layout::row(row))
    }

    fn root(&self, inner: RankedLayout) -> RankedLayout {
        let layout = if self.stacked {
            Layout::Root(Box::new(inner.layout))
        } else {
            Layout::Row(vec![Layout::Sign(Sign::Root), inner.base()])
        };
        RankedLayout::new(layout, Level::Prefix)
    }

    /// The skew matrix of a vector: a hat, over the letter only if there are scripts.
    fn hat(&self, inner: RankedLayout) -> RankedLayout {
        if !self.stacked {
            return self.call("hat", inner);
        }
        let hat = |a: Layout| Layout::Hat(Box::new(a));
        RankedLayout::atom(match inner.layout {
            Layout::Script {
                base,
                sub,
                sup: None,
            } if matches!(*base, Layout::Identifier(_)) => Layout::Script {
                base: Box::new(hat(*base)),
                sub,
                sup: None,
            },
            wide if width(&wide, Size::Display) > WIDEST_HAT => {
                Layout::fenced(Fence::Round, wide).superscript(Layout::Sign(Sign::Wedge))
            }
            narrow => hat(narrow),
        })
    }

    /// A named operator with its argument in brackets.
    fn call(&self, word: &str, argument: RankedLayout) -> RankedLayout {
        self.applied(Layout::Word(word.to_owned()), vec![argument.layout])
    }

    /// `f(a, b, ...)`.
    fn applied(&self, function: Layout, arguments: Vec<Layout>) -> RankedLayout {
        let arguments = Layout::fenced(Fence::Round, self.commas(arguments));
        RankedLayout::atom(Layout::Row(vec![
            function,
            Layout::Sign(Sign::Apply),
            arguments,
        ]))
    }

    fn commas(&self, parts: Vec<Layout>) -> Layout {
        let mut row = Vec::new();
        for (i, part) in parts.into_iter().enumerate() {
            if i > 0 {
                row.push(Layout::Sign(Sign::Comma));
                row.push(Layout::Break(Strength::Term));
            }
            row.push(part);
        }
        Layout::row(row)
    }
}

/// `T`, or `-T` for the transpose of an inverse.
fn transposition(inverted: bool) -> Layout {
    let t = Layout::Word("T".to_owned());
    if inverted {
        Layout::Row(vec![Layout::Sign(Sign::Tight('-')), t])
    } else {
        t
    }
}

fn lives_in_time(role: Role) -> bool {
    match role {
        Role::Element | Role::Velocity | Role::Advected | Role::Multiplier | Role::Derived => true,
        Role::Step | Role::Parameter | Role::Variation => false,
    }
}

/// The subscript `k`, `k+1` or `k-1`; `None` for a nameless index without offset.
fn offset(index: &str, by: i8) -> Option<Layout> {
    let mut row = Vec::new();
    if !index.is_empty() {
        row.push(name::script(index));
    }
    if by != 0 {
        let sign = if by > 0 { '+' } else { '-' };
        row.push(Layout::Sign(Sign::Tight(sign)));
        row.push(Layout::Number(by.unsigned_abs().to_string()));
    }
    (!row.is_empty()).then(|| Layout::row(row))
}

fn scripted(base: String, subs: Vec<Layout>, sup: Option<&str>) -> Layout {
    let layout = subscripted(letters(base), subs);
    match sup {
        Some(text) => layout.superscript(name::script(text)),
        None => layout,
    }
}

/// A name, or a number used as a name.
fn letters(base: String) -> Layout {
    if base.chars().all(|c| c.is_ascii_digit()) {
        Layout::Number(base)
    } else {
        Layout::Identifier(base)
    }
}

fn subscripted(base: Layout, subs: Vec<Layout>) -> Layout {
    let mut row = Vec::new();
    for sub in subs {
        if !row.is_empty() {
            row.push(Layout::Sign(Sign::Tight(',')));
        }
        row.push(sub);
    }
    match row.is_empty() {
        true => base,
        false => base.subscript(Layout::row(row)),
    }
}

/// Restores a decimal number of many digits that was read as a fraction.
fn decimal(num: i128, den: i128) -> Option<String> {
    const LARGEST: i128 = 1_000_000;
    let mut rest = den;
    for prime in [2, 5] {
        while rest % prime == 0 {
            rest /= prime;
        }
    }
    #[allow(clippy::cast_precision_loss)]
    let value = num as f64 / den as f64;
    (den > LARGEST && rest == 1 && (1e-5..1e16).contains(&value)).then(|| value.to_string())
}

/// The character of a common fraction.
fn vulgar(num: i128, den: i128) -> Option<char> {
    const TABLE: [(i128, i128, char); 15] = [
        (1, 2, '½'),
        (1, 3, '⅓'),
        (2, 3, '⅔'),
        (1, 4, '¼'),
        (3, 4, '¾'),
        (1, 5, '⅕'),
        (2, 5, '⅖'),
        (3, 5, '⅗'),
        (4, 5, '⅘'),
        (1, 6, '⅙'),
        (5, 6, '⅚'),
        (1, 8, '⅛'),
        (3, 8, '⅜'),
        (5, 8, '⅝'),
        (7, 8, '⅞'),
    ];
    let (_, _, c) = TABLE.iter().find(|(n, d, _)| (*n, *d) == (num, den))?;
    Some(*c)
}
