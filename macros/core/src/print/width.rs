//! Estimates the printed width of mathematics in tenths of a point, from the characters of Computer Modern at ten
//! points and TeX's spacing around signs. Unknown widths are overestimated, since a line that ends early is harmless.

use super::layout::{Fence, Layout, Sign};
use super::lines::Piece;

/// The size of mathematics.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Size {
    /// Displayed: sums have limits above and below, and fractions are full size.
    Display,
    /// In a sentence, a numerator or a matrix.
    Text,
    /// A script, or a numerator in a sentence.
    Script,
    /// A script of a script.
    Tiny,
}

impl Size {
    /// The size of scripts.
    fn script(self) -> Size {
        match self {
            Size::Display | Size::Text => Size::Script,
            Size::Script | Size::Tiny => Size::Tiny,
        }
    }

    /// The size of numerators.
    fn above(self) -> Size {
        match self {
            Size::Display => Size::Text,
            smaller => smaller.script(),
        }
    }

    /// Scales a width at ten points to this size; smaller letters are relatively wider.
    fn scaled(self, width: usize) -> usize {
        match self {
            Size::Display | Size::Text => width,
            Size::Script => width * 82 / 100,
            Size::Tiny => width * 68 / 100,
        }
    }

    /// Whether signs have space around them.
    fn is_spaced(self) -> bool {
        matches!(self, Size::Display | Size::Text)
    }
}

/// Lower-case italic letters, `a` to `z`.
const ITALIC: [usize; 26] = [
    53, 43, 44, 53, 47, 60, 52, 58, 35, 47, 56, 32, 88, 60, 49, 51, 48, 48, 47, 37, 58, 53, 75, 58,
    53, 51,
];

/// Italic capitals, `A` to `Z`, including their slant.
const CAPITALS: [usize; 26] = [
    75, 81, 79, 86, 80, 78, 79, 92, 52, 65, 92, 69, 108, 92, 80, 78, 80, 77, 67, 73, 80, 81, 109,
    91, 81, 76,
];

/// Lower-case upright letters, `a` to `z`.
const UPRIGHT: [usize; 26] = [
    50, 56, 45, 56, 45, 34, 51, 56, 28, 31, 53, 28, 84, 56, 50, 56, 53, 40, 40, 39, 56, 54, 73, 53,
    54, 45,
];

/// Lower-case Greek letters whose width differs from about 60.
const GREEK: [(char, usize); 14] = [
    ('γ', 58),
    ('δ', 50),
    ('ε', 47),
    ('ζ', 52),
    ('η', 54),
    ('θ', 50),
    ('ι', 36),
    ('ν', 56),
    ('ξ', 49),
    ('π', 61),
    ('τ', 56),
    ('χ', 63),
    ('ψ', 66),
    ('ω', 63),
];

/// The width of a bracket around content of normal height.
fn bracket(fence: Fence) -> usize {
    match fence {
        Fence::Round | Fence::Angle => 39,
        Fence::Square | Fence::Bars => 28,
    }
}

/// The width of a bracket; `tall` if its content is taller than a line.
fn delimiter(fence: Fence, tall: bool) -> usize {
    match tall {
        true => 96,
        false => bracket(fence),
    }
}

/// The width of an italic letter.
fn letter(c: char) -> usize {
    let place = |first: u8| usize::from(u8::try_from(c).unwrap_or(first).saturating_sub(first));
    match c {
        'a'..='z' => ITALIC[place(b'a')],
        'A'..='Z' => CAPITALS[place(b'A')],
        'ℓ' => 42,
        // Accents do not add width.
        '\u{300}'..='\u{36f}' => 0,
        '0'..='9' => 50,
        'Α'..='Ω' => 79,
        _ => GREEK.iter().find(|(g, _)| *g == c).map_or(62, |(_, w)| *w),
    }
}

/// The width of an upright letter.
pub(super) fn upright(c: char) -> usize {
    let place = |first: u8| usize::from(u8::try_from(c).unwrap_or(first).saturating_sub(first));
    match c {
        'a'..='z' => UPRIGHT[place(b'a')],
        ' ' => 34,
        '.' | ',' | ':' | ';' | '\'' => 28,
        '(' | ')' => 39,
        '0'..='9' => 50,
        'A'..='Z' => 76,
        _ => letter(c),
    }
}

fn sign(sign: Sign, size: Size) -> usize {
    let (glyph, around) = match sign {
        Sign::Relation(super::formula::Relation::Implies) => (165, 112),
        Sign::Relation(super::formula::Relation::Defined) => (106, 56),
        Sign::Relation(super::formula::Relation::Carried) => (100, 56),
        Sign::Relation(_) => (78, 56),
        Sign::Plus | Sign::Minus | Sign::Cross => (78, 45),
        Sign::Diamond => (50, 45),
        Sign::Dot => (28, 45),
        Sign::Sum if size == Size::Display => (145, 17),
        Sign::Sum => (106, 17),
        Sign::Comma => (28, 17),
        Sign::Negative | Sign::Wedge => (78, 0),
        Sign::Nabla | Sign::Root => (84, 0),
        Sign::Delta => (50, 0),
        Sign::Slash | Sign::Star => (50, 0),
        Sign::Bar => (34, 0),
        // Explicit spaces have the same width in all sizes.
        Sign::Times | Sign::Thin => return 17,
        Sign::Wide => return 28,
        Sign::Operand | Sign::Apply => (0, 0),
        Sign::Tight('+' | '-' | '=' | '<' | '>') => (78, 0),
        Sign::Tight(',' | '.' | ':') => (28, 0),
        Sign::Tight(_) => (50, 0),
    };
    size.scaled(glyph) + if size.is_spaced() { around } else { 0 }
}

/// The width of a layout.
pub(super) fn width(layout: &Layout, size: Size) -> usize {
    let go = |a: &Layout| width(a, size);
    match layout {
        Layout::Identifier(s) => size.scaled(s.chars().map(letter).sum()),
        Layout::Number(s) => size.scaled(50 * s.chars().count()),
        Layout::Word(s) => size.scaled(s.chars().map(upright).sum::<usize>() + 17),
        Layout::Text(s) => size.scaled(s.chars().map(upright).sum()),
        Layout::Sign(s) => sign(*s, size),
        Layout::Row(parts) => parts.iter().map(go).sum(),
        Layout::Script { base, sub, sup } => {
            let script = |a: &Option<Box<Layout>>| {
                let inside = a.as_ref().map(|a| width(a, size.script()));
                inside.map_or(0, |w| w + 5)
            };
            let scripts = script(sub).max(script(sup));
            match **base {
                Layout::Sign(Sign::Sum) if size == Size::Display => go(base).max(scripts + 17),
                _ => go(base) + scripts,
            }
        }
        Layout::Fraction(a, b) => {
            let above = size.above();
            width(a, above).max(width(b, above)) + 24
        }
        Layout::Root(a) => go(a) + size.scaled(100),
        Layout::Hat(a) | Layout::Typeset(_, a) => go(a),
        Layout::Fenced(fence, a) => 2 * size.scaled(delimiter(*fence, a.is_tall())) + go(a),
        Layout::Grid(rows) => {
            let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
            let widest = |j: usize| {
                let entries = rows.iter().filter_map(|r| r.get(j));
                let widths = entries.map(|e| width(e, Size::Text));
                widths.max().unwrap_or(0)
            };
            let gaps = 100 * columns.saturating_sub(1);
            (0..columns).map(widest).sum::<usize>() + gaps + 2 * 90
        }
        Layout::Break(_) => 0,
    }
}

impl Piece<'_> {
    /// The width on a displayed line.
    pub fn width(&self) -> usize {
        match self {
            Piece::Whole(layout) => width(layout, Size::Display),
            Piece::Open(fence, tall) | Piece::Close(fence, tall) => delimiter(*fence, *tall),
            Piece::Break(..) => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Size, width};
    use crate::expr::symbol::Symbols;
    use crate::print::formula::{Formula, Operator, Relation};
    use crate::print::{Page, Style};

    /// Widths that LaTeX measured with `\wd` for `$\displaystyle ...$`, in points.
    #[test]
    fn formulas_are_as_wide_as_latex_sets_them() {
        let name = Formula::name;
        let boxed = |f: Formula| Box::new(f);
        let over = |a, b| Formula::Quotient(boxed(a), boxed(b));
        let sum = Formula::Sum(vec![name("a"), name("b")]);
        let grouped = Formula::Grouped(boxed(over(sum, name("c"))));
        let square = |n| Formula::Product(vec![name(n), name(n)]);
        let squares = Formula::Sum(vec![square("A"), square("J")]);
        let difference = Formula::minus(
            name("Λ_{k+1}"),
            Formula::Product(vec![name("Λ_k"), name("Ω_k")]),
        );
        let cross = Formula::Cross(boxed(name("a")), boxed(name("b")));
        let cases = [
            (
                Formula::operator(
                    Operator::Trace,
                    Formula::Product(vec![Formula::transpose(name("P_{k+1}")), difference]),
                ),
                // The first measured box without its `\frac{1}{2}\,`.
                117.1 - 9.1,
            ),
            (Formula::Product(vec![grouped, name("μ_k")]), 53.2),
            (
                Formula::Matrix(vec![vec![name("A"), name("Id")], vec![squares, name("A")]]),
                69.1,
            ),
            (
                Formula::Relation(
                    vec![
                        name("ΔX_k"),
                        Formula::Power(boxed(cross), crate::algebra::Rational::HALF),
                    ],
                    Relation::Defined,
                ),
                68.4,
            ),
        ];
        let symbols = Symbols::default();
        let style = Style::default();
        let page = Page {
            symbols: &symbols,
            style: &style,
        };
        for (formula, points) in cases {
            let estimate = width(&page.stacked(&formula), Size::Display);
            let estimate = u32::try_from(estimate).map_or(0.0, f64::from) / 10.0;
            // The estimate may be at most one point too small, and about a tenth too large.
            let within = estimate > points - 1.0 && estimate < 1.1 * points + 3.0;
            assert!(within, "{formula:?}: {estimate} for {points}");
        }
    }
}
