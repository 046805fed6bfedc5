//! Finds the part of the initial action that is NaN. Takes the numbers of a node; gives the smallest part of the
//! statement with an infinite or undefined value or derivative, its site and the values of its arguments.

mod text;

use crate::evaluate::Here;
use crate::expression::{Expression, Kind};
use crate::scene::Scene;
use crate::setup::Setup;
use crate::sites::{all_moving, range, varied};
use crate::stated::{Role, Stated};
use crate::terms::{Term, TermTime};
use crate::value::Value;
use std::fmt;

/// A part of the statement that is not finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Undefined {
    /// The label's index and the site, if the part belongs to a site.
    pub site: Option<(String, i64)>,
    /// The part, as text of the model.
    pub part: String,
    /// Its value, or `None` if only its derivative is infinite or undefined.
    pub value: Option<f64>,
    /// Its arguments, each as text of the model, with its value.
    pub arguments: Vec<(String, f64)>,
    /// The vector whose length is the part, if the part is a length.
    pub length_of: Option<String>,
}

impl fmt::Display for Undefined {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((index, site)) = &self.site {
            write!(f, "at {index} = {site}, ")?;
        }
        match (&self.length_of, self.value) {
            (Some(vector), None) => {
                return write!(
                    f,
                    "the length of `{vector}` is 0, where it has no derivative"
                );
            }
            (_, None) => write!(f, "`{}` has no finite derivative", self.part)?,
            (_, Some(value)) if value.is_nan() => write!(f, "`{}` is not a number", self.part)?,
            (_, Some(_)) => write!(f, "`{}` exceeds the largest double", self.part)?,
        }
        for (n, (argument, value)) in self.arguments.iter().enumerate() {
            let word = if n == 0 { ":" } else { "," };
            match value.abs() < 1e15 {
                true => write!(f, "{word} `{argument}` is {value}")?,
                false => write!(f, "{word} `{argument}` is {value:e}")?,
            }
        }
        Ok(())
    }
}

impl Undefined {
    /// The first such part, in the order of sites, at a node with zero displacements. The observables of the setup
    /// are the initial values.
    ///
    /// # Errors
    /// Why the statement cannot be evaluated.
    pub fn find(stated: &Stated, setup: &Setup, node: &[f64]) -> Result<Option<Self>, String> {
        let moving = all_moving(stated, setup);
        let by = varied(&moving);
        let scene = Scene::new(stated, setup, [node, node], &by);
        // The root of zero is reported only if no part is infinite.
        let kinds: [FaultTest; 2] = [&|scene, e, here| fault(scene, e, here), &root_of_zero];
        for wanted in kinds {
            let mut first: Option<(i64, Undefined)> = None;
            for term in &stated.terms {
                for index in range(stated, setup, term).unwrap_or(0..=0) {
                    if first.as_ref().is_some_and(|(own, _)| *own <= index) {
                        break;
                    }
                    if let Some(found) = innermost(&scene, &term.value, at(term, index), wanted) {
                        first = Some((index, found));
                        break;
                    }
                }
            }
            if let Some((_, found)) = first {
                return Ok(Some(found));
            }
        }
        Ok(None)
    }
}

/// The position of a term at the first node of a step.
fn at(term: &Term, index: i64) -> Here {
    let here = Here::at(index);
    match term.lives {
        TermTime::Node(level) => here.later(-level),
        _ => here,
    }
}

/// The part of a value that is not finite.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    Value(f64),
    Slope,
}

/// A test for the faults that a search looks for.
type FaultTest<'w> = &'w dyn Fn(&Scene<'_>, &Expression, Here) -> Option<Fault>;

/// The fault of an expression, if its value or derivative is not finite. If this crate does not evaluate an
/// expression, such as a functional of all sites, the error of the step remains.
fn fault(scene: &Scene<'_>, e: &Expression, here: Here) -> Option<Fault> {
    let Ok(Value::Known(value)) = scene.value(e, here) else {
        return None;
    };
    if let Some(x) = value.entries.iter().find(|x| !x.value.is_finite()) {
        return Some(Fault::Value(x.value));
    }
    let mut slopes = value.entries.iter().flat_map(|x| &x.slopes);
    let infinite = slopes.any(|slope| !slope.value.is_finite());
    infinite.then_some(Fault::Slope)
}

/// Whether it is a root of a moving expression that is zero: the derivative is infinite, even if the derivative of the
/// expression vanishes.
fn root_of_zero(scene: &Scene<'_>, e: &Expression, here: Here) -> Option<Fault> {
    let argument = match &e.kind {
        Kind::Call(f, list) if f == "sqrt" => list.first()?,
        Kind::Power(a, above, below) if (0..*below).contains(above) => a,
        _ => return None,
    };
    let stated = scene.stated();
    let mut moves = false;
    argument.each(&mut |part| {
        if let Kind::Name(n) = &part.kind {
            let own = stated.quantities.get(n);
            moves |= own.is_some_and(|q| !matches!(q.role, Role::Parameter));
        }
    });
    let value = scene.value(argument, here).ok()?;
    let zero = value.as_number().is_some_and(|x| x.value == 0.0);
    (moves && zero).then_some(Fault::Slope)
}

/// The smallest part of an expression with the given fault.
fn innermost(
    scene: &Scene<'_>,
    e: &Expression,
    here: Here,
    wanted: FaultTest<'_>,
) -> Option<Undefined> {
    let inner = here.within(e);
    let mut parts = e.parts().into_iter();
    if let Some(found) = parts.find_map(|part| innermost(scene, part, inner, wanted)) {
        return Some(found);
    }
    let own = wanted(scene, e, here)?;
    let mut arguments = Vec::new();
    for part in e.parts() {
        let value = scene.value(part, inner).ok();
        let number = value.as_ref().and_then(Value::as_number).map(|x| x.value);
        // Numbers of the statement need no value.
        let is_named = !matches!(part.kind, Kind::Number(..) | Kind::Constant(_));
        if let (Some(number), true) = (number, is_named) {
            arguments.push((text::of(part), number));
        }
    }
    let stated = scene.stated();
    let index = stated.line.and_then(|line| stated.labels.get(line));
    Some(Undefined {
        site: index.map(|index| (index.clone(), inner.index)),
        part: text::of(e),
        value: match own {
            Fault::Value(x) => Some(x),
            Fault::Slope => None,
        },
        arguments,
        length_of: length_of(e).map(text::of),
    })
}

/// The vector of which an expression is the length.
fn length_of(e: &Expression) -> Option<&Expression> {
    let squared = match &e.kind {
        Kind::Call(f, list) if f == "sqrt" => list.first()?,
        Kind::Power(a, 1, 2) => a,
        _ => return None,
    };
    match &squared.kind {
        Kind::Call(f, list) if f == "dot" => match list.as_slice() {
            [a, b] if text::of(a) == text::of(b) => Some(a),
            _ => None,
        },
        _ => None,
    }
}
