//! Writes a random model in the model language, with parentheses around every compound expression or only where precedence requires
//! them.

use super::model::{Action, Body, Letter, Model, Role, Style};
use super::tree::Tree;
use crate::oracle::sides::{NodeRule, Side};
use std::fmt::Write;

/// The name of a `let` subexpression.
const NAMED: &str = "part";

/// Binding strength of an expression, from loose to tight.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Postfix,
    Atom,
}

impl Tree {
    fn binding(&self, model: &Model) -> Binding {
        match self {
            _ if model.style.named.as_ref() == Some(self) => Binding::Atom,
            Tree::Number(typed, _) if typed.starts_with('-') => Binding::Sum,
            Tree::Sum(_) => Binding::Sum,
            Tree::Product(_) | Tree::Quotient(..) => Binding::Product,
            Tree::Power(..) | Tree::Transposed(_) | Tree::Component(..) => Binding::Postfix,
            _ => Binding::Atom,
        }
    }

    /// The text, in parentheses if it binds more loosely than `least` or if the style always adds them.
    fn operand(&self, model: &Model, least: Binding) -> String {
        let least = if model.style.bare {
            least
        } else {
            Binding::Atom
        };
        let text = self.text(model);
        match self.binding(model) < least {
            true => format!("({text})"),
            false => text,
        }
    }

    /// The text, or the `let` name if the expression has one.
    fn text(&self, model: &Model) -> String {
        match model.style.named.as_ref() == Some(self) {
            true => NAMED.to_owned(),
            false => self.spelt(model),
        }
    }

    /// The text without its name.
    fn spelt(&self, model: &Model) -> String {
        let name = |index: &usize| model.letters.get(*index).map_or("?", |l| l.name.as_str());
        let atom = |t: &Tree| t.operand(model, Binding::Atom);
        match self {
            Tree::Number(typed, _) => (*typed).to_owned(),
            Tree::Step => model.style.step.to_owned(),
            Tree::Identity(_) => "Id".to_owned(),
            Tree::Axis(_, axis) => format!("E{axis}"),
            Tree::Letter(index, _) => name(index).to_owned(),
            Tree::Next(index, _) => format!("next({})", name(index)),
            Tree::Sum(terms) => sum(terms, model),
            Tree::Product(list) => {
                let mut text = String::new();
                for (i, t) in list.iter().enumerate() {
                    let own = match i {
                        0 => t.operand(model, Binding::Product),
                        _ => t.operand(model, Binding::Postfix),
                    };
                    // Juxtaposes factors unless the language would parse them differently: two numbers, a factor after a divisor, a
                    // call.
                    let apart = own.starts_with(|c: char| c == '(' || c.is_ascii_digit())
                        || i > 0 && matches!(list[i - 1], Tree::Quotient(..));
                    text.push_str(match (i, model.style.juxtaposed && !apart) {
                        (0, _) => "",
                        (_, true) => " ",
                        (_, false) => "*",
                    });
                    text.push_str(&own);
                }
                text
            }
            Tree::Quotient(a, b) => {
                let above = a.operand(model, Binding::Product);
                format!("{above}/{}", b.operand(model, Binding::Postfix))
            }
            Tree::Power(a, n, 1) => format!("{}^{n}", atom(a)),
            Tree::Power(a, n, d) => format!("{}^({n}/{d})", atom(a)),
            Tree::Transposed(a) => format!("{}^T", atom(a)),
            Tree::Component(a, indices) => {
                let indices: Vec<String> = indices.iter().map(usize::to_string).collect();
                format!("{}[{}]", atom(a), indices.join(", "))
            }
            Tree::Call(name, list) => {
                let texts: Vec<String> = list.iter().map(|t| t.text(model)).collect();
                format!("{name}({})", texts.join(", "))
            }
        }
    }
}

/// Terms with their signs.
fn sum(terms: &[(bool, Tree)], model: &Model) -> String {
    let mut text = String::new();
    for (i, (minus, t)) in terms.iter().enumerate() {
        text.push_str(match (i, minus) {
            (0, false) => "",
            (0, true) => "-",
            (_, false) => " + ",
            (_, true) => " - ",
        });
        text.push_str(&t.operand(model, Binding::Product));
    }
    text
}

/// `V` or `rot(V)`, with its inverse and transposes in the notation of the group.
struct Acting {
    g: String,
    inverse: String,
}

fn acting(model: &Model, body: &Body, turns: bool, letter: usize) -> Acting {
    let name = model.letters.get(letter).map_or("?", |l| l.name.as_str());
    let (g, orthogonal) = match turns {
        true => (format!("rot({name})"), true),
        false => (name.to_owned(), body.family.is_orthogonal()),
    };
    let inverse = match orthogonal {
        true => format!("{g}^T"),
        false => format!("{g}^-1"),
    };
    // On the body side the inverse acts.
    match body.side {
        Side::Body => Acting {
            g: inverse,
            inverse: g,
        },
        Side::Space => Acting { g, inverse },
    }
}

impl Acting {
    fn on(&self, action: Action, quantity: &str) -> String {
        let (g, inverse) = (&self.g, &self.inverse);
        let transposed = |x: &str| match x.strip_suffix("^T") {
            Some(bare) => bare.to_owned(),
            None if x.ends_with("^-1") => format!("({x})^T"),
            None => format!("{x}^T"),
        };
        match action {
            Action::Forward => format!("{g}*{quantity}"),
            Action::Dual => format!("{}*{quantity}", transposed(inverse)),
            Action::Congruence => format!("{g}*{quantity}*{}", transposed(g)),
            Action::DualCongruence => format!("{}*{quantity}*{inverse}", transposed(inverse)),
            Action::Conjugation => format!("{g}*{quantity}*{inverse}"),
            Action::Weight => format!("det({g})*{quantity}"),
        }
    }
}

impl Model {
    /// The model in the model language.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = format!("model {} {{\n", self.name);
        let Style { time, step, .. } = self.style;
        if step != "h" {
            line(&mut text, &format!("time {time} step {step};"));
        }
        if self.rule != NodeRule::Symmetric {
            line(&mut text, &format!("node {};", self.rule.word()));
        }
        if let Some(scale) = &self.scale {
            line(&mut text, &format!("scale {};", scale.text(self)));
        }
        for (index, letter) in self.letters.iter().enumerate() {
            if matches!(letter.role, Role::Parameter) && self.uses(index) {
                line(
                    &mut text,
                    &format!("param {}: {};", letter.name, letter.kind.text()),
                );
            }
        }
        for (index, letter) in self.letters.iter().enumerate() {
            if self.uses(index) {
                for statement in self.statements(letter) {
                    line(&mut text, &statement);
                }
            }
        }
        if let Some(named) = &self.style.named {
            line(&mut text, &format!("let {NAMED} = {};", named.spelt(self)));
        }
        line(
            &mut text,
            &format!("lagrangian = {};", sum(&self.summands, self)),
        );
        text.push('}');
        text
    }

    fn name_of(&self, index: usize) -> &str {
        self.letters.get(index).map_or("?", |l| l.name.as_str())
    }

    fn statements(&self, letter: &Letter) -> Vec<String> {
        let (name, kind) = (&letter.name, letter.kind.text());
        match letter.role {
            Role::Parameter | Role::Velocity(_) => Vec::new(),
            Role::Element(body) => {
                let body = &self.bodies[body];
                if body.family.is_added() {
                    return vec![format!("field {name}: {kind};")];
                }
                let velocity = self.name_of(body.element + 1);
                let product = match body.side {
                    Side::Body => format!("{name}*{velocity}"),
                    Side::Space => format!("{velocity}*{name}"),
                };
                vec![
                    format!("group {name}: {kind} velocity {velocity};"),
                    format!("constraint next({name}) = {product};"),
                ]
            }
            Role::Advected {
                body,
                action,
                turns,
                definition,
            } => {
                let body = &self.bodies[body];
                let mut declared = format!("advected {name}: {kind}");
                if let Some(by) = definition {
                    let value =
                        acting(self, body, turns, body.element).on(action, self.name_of(by));
                    // Writing to a string cannot fail.
                    let _ = write!(declared, " = {value}");
                }
                declared.push(';');
                let update = acting(self, body, turns, body.element + 1).on(action, name);
                vec![declared, format!("constraint next({name}) = {update};")]
            }
            Role::Relative {
                first,
                second,
                defined,
            } => {
                let word = |shift: usize, middle: &str| {
                    let (a, b) = (&self.bodies[first], &self.bodies[second]);
                    let left = acting(self, a, false, a.element + shift).g;
                    let right = self.name_of(b.element + shift);
                    match middle {
                        "" => format!("{left}*{right}"),
                        _ => format!("{left}*{middle}*{right}"),
                    }
                };
                let definition = match defined {
                    true => format!(" = {}", word(0, "")),
                    false => String::new(),
                };
                vec![
                    format!("advected {name}: {kind}{definition};"),
                    format!("constraint next({name}) = {};", word(1, name)),
                ]
            }
        }
    }
}

fn line(text: &mut String, statement: &str) {
    text.push_str("    ");
    text.push_str(statement);
    text.push('\n');
}
