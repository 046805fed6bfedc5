//! Layouts of formulas, with one match arm for each kind.

use super::{Composer, transposition};
use crate::algebra::Rational;
use crate::expr::Node;
use crate::print::Style;
use crate::print::formula::{Formula, Operator, Relation};
use crate::print::layout::{Fence, Layout, Sign, Strength};
use crate::print::level::{Level, RankedLayout};
use crate::print::name;

impl Composer<'_> {
    /// Lays out a formula.
    pub fn formula(&self, f: &Formula) -> RankedLayout {
        match f {
            Formula::Expr(e) => self.expression(e),
            Formula::Name { base, sub, sup } => {
                RankedLayout::atom(self.name(base, sub.as_deref(), sup.as_deref()))
            }
            Formula::Relation(members, relation) => self.relation(members, *relation),
            Formula::Sum(_) | Formula::Diff(..) | Formula::Neg(_) => {
                self.sum(self.formula_terms(f))
            }
            Formula::Product(factors) => self.formula_product(factors),
            Formula::Quotient(a, b) => self.fraction(self.formula(a), self.formula(b)),
            Formula::Power(a, q) => self.power(self.formula(a), *q),
            Formula::Transpose(a) => match &**a {
                Formula::Inverse(inner) => self.formula(inner).raised(transposition(true)),
                _ => self.formula(a).raised(transposition(false)),
            },
            Formula::Inverse(a) => match &**a {
                Formula::Transpose(inner) => self.formula(inner).raised(transposition(true)),
                Formula::Expr(e) => self.inverted(e),
                _ => self.power(self.formula(a), Rational::MINUS_ONE),
            },
            Formula::Dot(a, b) => self.between(a, Sign::Dot, b, Level::Dot),
            Formula::Cross(a, b) => self.between(a, Sign::Cross, b, Level::Infix),
            Formula::Diamond(a, b) => self.between(a, Sign::Diamond, b, Level::Infix),
            Formula::Bracket(a, b) => self.pair(Fence::Square, a, b),
            Formula::Pairing(a, b) => self.pair(Fence::Angle, a, b),
            Formula::Ad { group, argument } => self.adjoint("Ad", None, group, argument),
            Formula::AdStar { group, momentum } => {
                self.adjoint("Ad", Some(Layout::Sign(Sign::Star)), group, momentum)
            }
            Formula::LieAdStar { algebra, momentum } => {
                self.adjoint("ad", Some(Layout::Sign(Sign::Star)), algebra, momentum)
            }
            Formula::Rate(a) => self.rate(a),
            Formula::Matrix(rows) => {
                let entries = |r: &Vec<Formula>| r.iter().map(|f| self.formula(f).layout).collect();
                RankedLayout::atom(Layout::Grid(rows.iter().map(entries).collect()))
            }
            Formula::Continuous(a) => {
                let style = Style {
                    time_index: String::new(),
                    ..self.style.clone()
                };
                let composer = Composer {
                    symbols: self.symbols,
                    style: &style,
                    stacked: self.stacked,
                };
                composer.formula(a)
            }
            Formula::Gradient { of, wrt } => {
                let nabla = Layout::Sign(Sign::Nabla).subscript(self.letter(*wrt));
                let of = self.name(of, None, None);
                let row = vec![nabla, Layout::Sign(Sign::Operand), of];
                RankedLayout::new(Layout::Row(row), Level::Gradient)
            }
            Formula::Variation(a) => {
                let row = vec![Layout::Sign(Sign::Delta), self.formula(a).base()];
                RankedLayout::new(Layout::Row(row), Level::Prefix)
            }
            Formula::Tangent { parameter, of } => self.tangent(parameter, of),
            Formula::Operator(operator, a) => self.call(word(*operator), self.formula(a)),
            Formula::HatOf(a) => self.hat(self.formula(a)),
            Formula::Norm(a) => {
                RankedLayout::atom(Layout::fenced(Fence::Bars, self.formula(a).layout))
            }
            Formula::Apply {
                function,
                arguments,
            } => {
                let arguments = arguments.iter().map(|a| self.formula(a).layout);
                self.applied(self.formula(function).base(), arguments.collect())
            }
            Formula::SumOver {
                index,
                from,
                to,
                of,
            } => self.sum_over(index, from.as_deref(), to.as_deref(), of),
            Formula::Grouped(a) => {
                RankedLayout::atom(Layout::fenced(Fence::Round, self.formula(a).layout))
            }
            Formula::List(parts) | Formula::Rows(parts) => {
                let mut row = Vec::new();
                for part in parts {
                    if !row.is_empty() {
                        row.push(Layout::Sign(Sign::Comma));
                        row.push(Layout::Sign(Sign::Wide));
                        row.push(Layout::Break(Strength::Term));
                    }
                    row.push(self.formula(part).layout);
                }
                RankedLayout::new(Layout::Row(row), Level::Loose)
            }
            Formula::Sequence(parts) => {
                let mut row = Vec::new();
                for part in parts {
                    if !row.is_empty() {
                        row.push(Layout::Sign(Sign::Wide));
                    }
                    row.push(self.formula(part).layout);
                }
                RankedLayout::new(Layout::Row(row), Level::Loose)
            }
            Formula::Text(words) => RankedLayout::atom(Layout::Text(words.clone())),
        }
    }

    /// The signed terms of a formula; a negated sum keeps its brackets.
    fn formula_terms(&self, f: &Formula) -> Vec<(bool, RankedLayout)> {
        let negative = |a: &Formula| {
            let mut terms = self.formula_terms(a);
            match (terms.pop(), terms.is_empty()) {
                (Some((minus, only)), true) => (!minus, only),
                (last, _) => {
                    terms.extend(last);
                    (true, self.sum(terms))
                }
            }
        };
        match f {
            Formula::Expr(e) => self.terms(e),
            // Terms that vanish are omitted instead of printed as `+ 0`.
            Formula::Sum(parts) => parts
                .iter()
                .filter(|p| !matches!(p, Formula::Expr(e) if e.is_zero()))
                .flat_map(|p| self.formula_terms(p))
                .collect(),
            Formula::Diff(a, b) => {
                let mut terms = self.formula_terms(a);
                terms.push(negative(b));
                terms
            }
            Formula::Neg(a) => vec![negative(a)],
            _ => vec![(false, self.formula(f))],
        }
    }

    fn formula_product(&self, factors: &[Formula]) -> RankedLayout {
        let letter = |f: &Formula| match f {
            Formula::Name { .. } => true,
            Formula::Expr(e) => matches!(e.node(), Node::Letter(_)),
            _ => false,
        };
        let mut parts: Vec<RankedLayout> = Vec::new();
        for run in factors.chunk_by(|a, b| a == b && letter(a)) {
            match (run, i64::try_from(run.len())) {
                ([first, _, ..], Ok(n)) => {
                    parts.push(self.power(self.formula(first), Rational::integer(n)));
                }
                _ => parts.extend(run.iter().map(|f| self.formula(f))),
            }
        }
        let last = parts.len().saturating_sub(1);
        if last == 0
            && let Some(only) = parts.pop()
        {
            return only;
        }
        let beside = parts.into_iter().enumerate().map(|(i, laid)| {
            let digits = i > 0 && matches!(laid.layout, Layout::Number(_));
            // `v a·b` reads as `(v a)·b`.
            let dot = laid.level == Level::Dot;
            if digits {
                RankedLayout::new(laid.layout, Level::Sum).factor(false)
            } else {
                laid.factor(i == last && !dot)
            }
        });
        self.beside(beside.collect())
    }

    fn relation(&self, members: &[Formula], relation: Relation) -> RankedLayout {
        let each = members.iter().map(|member| {
            let laid = self.formula(member);
            let nested = laid.level == Level::Relation && relation != Relation::Implies;
            match nested {
                true => Layout::fenced(Fence::Round, laid.layout),
                false => laid.layout,
            }
        });
        let mut each: Vec<Layout> = each.collect();
        // Drop repeated members: `b = b` is trivial.
        if relation == Relation::Equal && each.len() > 2 {
            each.dedup();
        }
        let mut row = Vec::new();
        for member in each {
            if !row.is_empty() {
                row.push(Layout::Break(Strength::Relation));
                row.push(Layout::Sign(Sign::Relation(relation)));
            }
            row.push(member);
        }
        RankedLayout::new(Layout::Row(row), Level::Relation)
    }

    /// Whether all sides of a relation print the same, as in `0 = 0`.
    pub fn says_nothing(&self, f: &Formula) -> bool {
        match f {
            Formula::Continuous(inner) => self.says_nothing(inner),
            Formula::Rows(rows) => rows.iter().all(|row| self.says_nothing(row)),
            Formula::Relation(members, Relation::Equal | Relation::Identical) => {
                let mut sides = members.iter().map(|member| self.formula(member).layout);
                let first = sides.next();
                members.len() > 1 && sides.all(|side| Some(&side) == first.as_ref())
            }
            _ => false,
        }
    }

    fn between(&self, a: &Formula, sign: Sign, b: &Formula, level: Level) -> RankedLayout {
        self.infix(self.formula(a), sign, self.formula(b), level)
    }

    fn pair(&self, fence: Fence, a: &Formula, b: &Formula) -> RankedLayout {
        let inner = self.commas(vec![self.formula(a).layout, self.formula(b).layout]);
        RankedLayout::atom(Layout::fenced(fence, inner))
    }

    fn adjoint(
        &self,
        word: &str,
        star: Option<Layout>,
        group: &Formula,
        argument: &Formula,
    ) -> RankedLayout {
        let operator = Layout::Script {
            base: Box::new(Layout::Word(word.to_owned())),
            sub: Some(Box::new(self.formula(group).layout)),
            sup: star.map(Box::new),
        };
        let argument = self.formula(argument);
        let bare = argument.level >= Level::Application;
        let argument = if bare {
            argument.layout
        } else {
            argument.base()
        };
        let row = vec![operator, Layout::Sign(Sign::Operand), argument];
        RankedLayout::new(Layout::Row(row), Level::Application)
    }

    /// `da/dt`, with the letter in the numerator if `a` is one letter.
    fn rate(&self, a: &Formula) -> RankedLayout {
        let d = || Layout::Identifier("d".to_owned());
        let below = Layout::row(vec![d(), Layout::Identifier("t".to_owned())]);
        let laid = self.formula(a);
        let (above, behind) = if laid.level == Level::Atom {
            (Layout::row(vec![d(), laid.layout]), None)
        } else {
            (d(), Some(laid.base()))
        };
        let derivative = if self.stacked {
            Layout::Fraction(Box::new(above), Box::new(below))
        } else {
            Layout::Row(vec![above, Layout::Sign(Sign::Slash), below])
        };
        let Some(behind) = behind else {
            return RankedLayout::new(derivative, Level::Prefix);
        };
        let row = vec![derivative, Layout::Sign(Sign::Thin), behind];
        RankedLayout::new(Layout::Row(row), Level::Application)
    }

    fn tangent(&self, parameter: &str, of: &Formula) -> RankedLayout {
        let d = || Layout::Identifier("d".to_owned());
        let below = Layout::row(vec![d(), self.name(parameter, None, None)]);
        let derivative = if self.stacked {
            Layout::Fraction(Box::new(d()), Box::new(below))
        } else {
            Layout::Row(vec![d(), Layout::Sign(Sign::Slash), below])
        };
        let place = Layout::Row(vec![
            name::script(parameter),
            Layout::Sign(Sign::Tight('=')),
            Layout::Number("0".to_owned()),
        ]);
        let row = vec![
            derivative,
            Layout::Sign(Sign::Bar).subscript(place),
            Layout::Sign(Sign::Thin),
            self.formula(of).term(),
        ];
        RankedLayout::new(Layout::Row(row), Level::Application)
    }

    fn sum_over(
        &self,
        index: &str,
        from: Option<&str>,
        to: Option<&str>,
        of: &Formula,
    ) -> RankedLayout {
        let mut below = vec![name::script(index)];
        if let Some(from) = from {
            below.push(Layout::Sign(Sign::Tight('=')));
            below.push(name::script(from));
        }
        let sign = Layout::Script {
            base: Box::new(Layout::Sign(Sign::Sum)),
            sub: Some(Box::new(Layout::row(below))),
            sup: to.map(|to| Box::new(name::script(to))),
        };
        let row = vec![sign, Layout::Sign(Sign::Operand), self.formula(of).term()];
        RankedLayout::new(Layout::Row(row), Level::Application)
    }
}

fn word(operator: Operator) -> &'static str {
    match operator {
        Operator::Trace => "tr",
        Operator::Det => "det",
        Operator::Sym => "sym",
        Operator::Skew => "skew",
        Operator::Diag => "diag",
        Operator::Vee => "vee",
        Operator::Exp => "exp",
        Operator::Log => "log",
    }
}
