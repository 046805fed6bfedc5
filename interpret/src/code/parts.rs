//! Constants, the parts of an operation, and the places around it that it reads.

use super::{Code, Operator, Pattern};
use crate::listing::{FieldNames, Section};
use crate::value::Value;
use clebsch::Real;
use std::collections::BTreeSet;
use std::sync::Arc;

impl<T: Real> Code<T> {
    /// A constant.
    pub fn constant(value: Value<T>) -> Self {
        Code::Constant(Box::new(value))
    }

    /// The constant count, if the expression is one.
    pub fn constant_count(&self) -> Option<usize> {
        match self {
            Code::Constant(value) => value.count(),
            _ => None,
        }
    }

    /// The direct operands, without the operations of called functions.
    pub fn parts(&self) -> Vec<&Code<T>> {
        match self {
            Code::Constant(_) | Code::Place(_) | Code::Iterate(_) => Vec::new(),
            Code::Field(a, _)
            | Code::Inner(a)
            | Code::Negative(a)
            | Code::Not(a)
            | Code::Closure(_, a)
            | Code::Once(_, a)
            | Code::Momentum(_, a)
            | Code::Function(a)
            | Code::Return(a)
            | Code::Try(a) => vec![a],
            Code::Binary(_, a, b)
            | Code::Lazy(_, a, b)
            | Code::While(a, b)
            | Code::Increase(a, b)
            | Code::Repeat(a, b) => vec![a, b],
            Code::Index(a, all) => std::iter::once(&**a).chain(all).collect(),
            Code::Assign(all, a) => all.iter().chain([&**a]).collect(),
            Code::Call(_, all, ..)
            | Code::Special(_, all, _)
            | Code::Routine(_, all)
            | Code::Block(all)
            | Code::List(all) => all.iter().collect(),
            Code::Let(_, a, b) => [Some(&**a), b.as_deref()].into_iter().flatten().collect(),
            Code::If(a, b, c) => {
                let all = [Some(&**a), Some(&**b), c.as_deref()];
                all.into_iter().flatten().collect()
            }
            Code::Match(value, arms) => {
                let arms = arms
                    .iter()
                    .flat_map(|arm| arm.guard.iter().chain([&arm.body]));
                std::iter::once(&**value).chain(arms).collect()
            }
            Code::For(_, a, b, c) | Code::Down(_, a, b, c) => vec![a, b, c],
            Code::Struct(_, given, base) => {
                let given = given.iter().map(|(_, code)| code);
                given.chain(base.as_deref()).collect()
            }
        }
    }

    /// The recorded loops of a function and of the functions that it calls, each once, in the order of the text.
    pub fn sections(&self, names: &FieldNames, met: &mut BTreeSet<usize>, out: &mut Vec<Section>) {
        match self {
            Code::Iterate(each) => {
                let address = Arc::as_ptr(each).cast::<()>() as usize;
                if met.insert(address) {
                    out.extend(each.section(names));
                }
            }
            Code::Routine(called, _) => {
                let address = Arc::as_ptr(called) as usize;
                if let (true, Some(routine)) = (met.insert(address), called.get()) {
                    routine.body.sections(names, met, out);
                }
            }
            _ => {}
        }
        for part in self.parts() {
            part.sections(names, met, out);
        }
    }

    /// The places that it fills.
    pub fn fills(&self, out: &mut BTreeSet<usize>) {
        match self {
            Code::Let(pattern, ..) => pattern.fills(out),
            Code::Match(_, arms) => arms.iter().for_each(|arm| arm.pattern.fills(out)),
            Code::Closure(places, _) => out.extend(places),
            Code::Once(at, _) | Code::For(at, ..) | Code::Down(at, ..) => {
                out.insert(*at);
            }
            Code::Assign(targets, _) => out.extend(targets.iter().filter_map(Code::root)),
            Code::Increase(target, _) => out.extend(target.root()),
            _ => {}
        }
        for part in self.parts() {
            part.fills(out);
        }
    }

    /// The number of the place, if the expression is a whole place.
    pub fn number(&self) -> Option<usize> {
        match self {
            Code::Place(at) => Some(*at),
            _ => None,
        }
    }

    /// The place that a path such as `state.places` begins with.
    pub fn root(&self) -> Option<usize> {
        match self {
            Code::Place(at) => Some(*at),
            Code::Field(base, _) => base.root(),
            _ => None,
        }
    }

    /// The paths that it reads from places which it does not fill itself, each with all its fields as written.
    pub fn reads<'a>(&'a self, filled: &BTreeSet<usize>, out: &mut Vec<&'a Code<T>>) {
        match self.root() {
            Some(root) if filled.contains(&root) => {}
            Some(_) => out.push(self),
            None => {
                for part in self.parts() {
                    part.reads(filled, out);
                }
            }
        }
    }

    /// Whether the body may clamp a site to the last site of a list: `site.min(list.len() - 1)`.
    pub fn clamps(&self) -> bool {
        let own = matches!(self, Code::Call(_, _, _, name) if &**name == "min");
        own || self.parts().into_iter().any(Code::clamps)
    }

    /// Whether the operations that it takes may depend on a count, such as the site of a loop.
    pub fn chooses(&self) -> bool {
        let own = match self {
            Code::Binary(operator, ..) => !matches!(
                operator,
                Operator::Add | Operator::Sub | Operator::Mul | Operator::Div
            ),
            Code::Match(_, arms) => arms.iter().any(|arm| arm.pattern.is_exact()),
            Code::Call(_, _, _, name) => {
                matches!(&**name, "max" | "saturating_sub" | "usize::from")
            }
            Code::Routine(..) | Code::Iterate(_) => true,
            _ => false,
        };
        own || self.parts().into_iter().any(Code::chooses)
    }
}

impl<T: Real> Pattern<T> {
    fn fills(&self, out: &mut BTreeSet<usize>) {
        match self {
            Pattern::Place(at) => {
                out.insert(*at);
            }
            Pattern::List(all) | Pattern::Or(all) => all.iter().for_each(|p| p.fills(out)),
            Pattern::Done(inner) | Pattern::Failed(inner) => inner.fills(out),
            Pattern::Variant(_, fields) => fields.iter().for_each(|(_, p)| p.fills(out)),
            Pattern::Any | Pattern::None | Pattern::Exactly(_) => {}
        }
    }

    fn is_exact(&self) -> bool {
        match self {
            Pattern::Exactly(_) => true,
            Pattern::List(all) | Pattern::Or(all) => all.iter().any(Pattern::is_exact),
            Pattern::Done(inner) | Pattern::Failed(inner) => inner.is_exact(),
            Pattern::Variant(_, fields) => fields.iter().any(|(_, p)| p.is_exact()),
            Pattern::Any | Pattern::Place(_) | Pattern::None => false,
        }
    }
}
