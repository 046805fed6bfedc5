//! Writes a random model in the model language.
//! Takes the tree; gives the text of a whole `model`, with only the parentheses that the precedence of
//! the language asks for: sums, then products and juxtaposition, then the unary minus, then postfixes.

use super::RandomLagrangian;
use super::tree::{Carried, Expr, Kind, Named, Role, Symbol};
use crate::oracle::action::{NodeRule, Side};
use std::fmt::Write;

/// How tightly an expression binds, loosest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Unary,
    Postfix,
    Atom,
}

/// The names in scope.
struct Names<'a> {
    symbols: &'a [Symbol],
    lets: &'a [Named],
    step: &'a str,
}

impl Names<'_> {
    fn symbol(&self, index: usize) -> &str {
        self.symbols.get(index).map_or("?", |symbol| &symbol.name)
    }

    /// The expression, in parentheses if it binds more loosely than asked.
    fn write(&self, expr: &Expr, least: Binding) -> String {
        let (text, binding) = match expr {
            Expr::Number(typed, _) => ((*typed).to_owned(), Binding::Atom),
            Expr::Step => (self.step.to_owned(), Binding::Atom),
            Expr::Identity => ("Id".to_owned(), Binding::Atom),
            Expr::Axis(axis) => (format!("E{axis}"), Binding::Atom),
            Expr::Symbol(index) => (self.symbol(*index).to_owned(), Binding::Atom),
            Expr::Next(index) => (format!("next({})", self.symbol(*index)), Binding::Atom),
            Expr::Let(index) => {
                let name = self.lets.get(*index).map_or("?", |named| &named.name);
                (name.to_owned(), Binding::Atom)
            }
            Expr::Negated(a) => {
                // A second minus in front would be legal and unreadable.
                (
                    format!("-{}", self.write(a, Binding::Postfix)),
                    Binding::Unary,
                )
            }
            Expr::Sum(a, b) => (self.pair(a, " + ", b, Binding::Sum), Binding::Sum),
            Expr::Difference(a, b) => (self.pair(a, " - ", b, Binding::Sum), Binding::Sum),
            Expr::Product(a, b, false) => {
                (self.pair(a, "*", b, Binding::Product), Binding::Product)
            }
            Expr::Product(a, b, true) => (self.juxtaposed(a, b), Binding::Product),
            Expr::Quotient(a, b) => {
                let (above, below) = (
                    self.write(a, Binding::Product),
                    self.write(b, Binding::Postfix),
                );
                (format!("{above}/{below}"), Binding::Product)
            }
            Expr::Power(a, exponent) => (
                format!("{}^{exponent}", self.write(a, Binding::Atom)),
                Binding::Postfix,
            ),
            Expr::Transposed(a) => (
                format!("{}^T", self.write(a, Binding::Atom)),
                Binding::Postfix,
            ),
            Expr::Call(name, arguments) => {
                let arguments: Vec<String> = arguments
                    .iter()
                    .map(|argument| self.write(argument, Binding::Sum))
                    .collect();
                (format!("{name}({})", arguments.join(", ")), Binding::Atom)
            }
            Expr::Grouped(a) => (format!("({})", self.write(a, Binding::Sum)), Binding::Atom),
        };
        if binding < least {
            format!("({text})")
        } else {
            text
        }
    }

    /// A left-associative pair: the right operand binds one level tighter.
    fn pair(&self, a: &Expr, operator: &str, b: &Expr, binding: Binding) -> String {
        let right = match binding {
            Binding::Sum => Binding::Product,
            _ => Binding::Unary,
        };
        format!(
            "{}{operator}{}",
            self.write(a, binding),
            self.write(b, right)
        )
    }

    /// A product without a star, unless the language would read it otherwise or refuse it: two
    /// numbers, what follows a divisor, and parentheses after a name, a call, a component or a power.
    fn juxtaposed(&self, a: &Expr, b: &Expr) -> String {
        let (left, right) = (
            self.write(a, Binding::Product),
            self.write(b, Binding::Postfix),
        );
        let digit = |text: &str| text.starts_with(|first: char| first.is_ascii_digit());
        let call = right.starts_with('(')
            && !left.ends_with("^T")
            && left.ends_with(|last: char| last.is_alphanumeric() || "_])".contains(last));
        if digit(&right) || call || matches!(a, Expr::Quotient(..)) {
            format!("{left}*{right}")
        } else {
            format!("{left} {right}")
        }
    }
}

impl RandomLagrangian {
    /// The model in the model language.
    #[must_use]
    pub fn text(&self) -> String {
        let names = Names {
            symbols: &self.symbols,
            lets: &self.lets,
            step: self.step,
        };
        let mut text = format!("model {} {{\n", self.name);
        if self.step != "h" {
            line(
                &mut text,
                &format!("time {} step {};", self.time, self.step),
            );
        }
        if let Some(scale) = &self.scale {
            line(
                &mut text,
                &format!("scale {};", names.write(scale, Binding::Sum)),
            );
        }
        if self.rule != NodeRule::Symmetric {
            line(&mut text, &format!("node {};", self.rule.word()));
        }
        for (index, symbol) in self.symbols.iter().enumerate() {
            if self.declares(index) {
                for statement in self.statements(&names, symbol) {
                    line(&mut text, &statement);
                }
            }
        }
        for (index, named) in self.lets.iter().enumerate() {
            if self.mentions_let(index) {
                let value = names.write(&named.expr, Binding::Sum);
                line(&mut text, &format!("let {} = {value};", named.name));
            }
        }
        let mut lagrangian = String::new();
        for (place, summand) in self.summands.iter().enumerate() {
            let sign = match (place, summand.subtracted) {
                (0, false) => "",
                (0, true) => "-",
                (_, false) => " + ",
                (_, true) => " - ",
            };
            // A leading minus binds tighter than the product behind it, with the same value.
            let least = if place == 0 && summand.subtracted && leads_with_minus(&summand.expr) {
                Binding::Atom
            } else {
                Binding::Product
            };
            lagrangian.push_str(sign);
            lagrangian.push_str(&names.write(&summand.expr, least));
        }
        line(&mut text, &format!("lagrangian = {lagrangian};"));
        text.push('}');
        text
    }

    fn declares(&self, index: usize) -> bool {
        // The group and its velocity are declared in one statement, at the group.
        index == 0 || (index > 1 && self.uses(index))
    }

    fn mentions_let(&self, index: usize) -> bool {
        self.summands.iter().any(|summand| {
            summand.expr.mentions(
                &[],
                &|part| matches!(part, Expr::Let(other) if *other == index),
            )
        })
    }

    /// The declaration of a letter, and its constraint if it has one.
    fn statements(&self, names: &Names<'_>, symbol: &Symbol) -> Vec<String> {
        let (name, velocity) = (&symbol.name, names.symbol(1));
        let shape = match symbol.kind {
            Kind::Real => "Real",
            Kind::Vector => "Vec<3>",
            Kind::Symmetric | Kind::Positive => "Sym<3>",
            Kind::Skew => "Skew<3>",
            Kind::Matrix => "Mat<3>",
            Kind::Rotation => "SO<3>",
        };
        match &symbol.role {
            Role::Velocity => Vec::new(),
            Role::Parameter => vec![format!("param {name}: {shape};")],
            Role::Group => {
                let product = match self.side {
                    Side::Body => format!("{name}*{velocity}"),
                    Side::Space => format!("{velocity}*{name}"),
                };
                vec![
                    format!("group {name}: {shape} velocity {velocity};"),
                    format!("constraint next({name}) = {product};"),
                ]
            }
            Role::Advected {
                carried,
                definition,
            } => {
                let mut declaration = format!("advected {name}: {shape}");
                if let Some(definition) = definition {
                    let value = names.write(definition, Binding::Sum);
                    // Writing to a string cannot fail.
                    let _ = write!(declaration, " = {value}");
                }
                declaration.push(';');
                let (left, right) = match self.side {
                    Side::Body => (format!("{velocity}^T"), velocity.to_owned()),
                    Side::Space => (velocity.to_owned(), format!("{velocity}^T")),
                };
                let product = match carried {
                    Carried::Vector | Carried::OneSided => format!("{left}*{name}"),
                    Carried::Congruence => format!("{left}*{name}*{right}"),
                };
                vec![declaration, format!("constraint next({name}) = {product};")]
            }
        }
    }
}

fn line(text: &mut String, statement: &str) {
    text.push_str("    ");
    text.push_str(statement);
    text.push('\n');
}

/// Whether the text of an expression begins with a minus.
fn leads_with_minus(expr: &Expr) -> bool {
    match expr {
        Expr::Negated(_) => true,
        Expr::Sum(a, _)
        | Expr::Difference(a, _)
        | Expr::Product(a, _, _)
        | Expr::Quotient(a, _) => leads_with_minus(a),
        _ => false,
    }
}
