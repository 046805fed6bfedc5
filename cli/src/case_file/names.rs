//! The values of names in expressions of a case. Takes an expression and known names; gives its value.

use clebsch_core::lattice::value::SiteData;
use std::rc::Rc;

/// The names that an expression can use.
pub(super) trait Names {
    /// The value of a name.
    fn number(&self, name: &str) -> Option<f64>;

    /// The expression of a text. An expression for many sites is parsed only once.
    fn expression(&self, text: &str) -> Result<Rc<SiteData>, String> {
        SiteData::read(text).map(Rc::new)
    }
}

/// The values of names in expressions.
pub(super) type Numbers<'a> = dyn Names + 'a;

/// Expressions without names.
pub(super) struct Nameless;

impl Names for Nameless {
    fn number(&self, _: &str) -> Option<f64> {
        None
    }
}

/// The value of an expression, even if it is not finite.
pub(super) fn value(text: &str, of: &Numbers<'_>) -> Result<f64, String> {
    let data = of.expression(text);
    let value = data.and_then(|data| data.value(&|name| of.number(name)));
    value.map_err(|why| format!("\"{text}\": {why}"))
}

/// The value of an expression, if it is a finite number.
pub(super) fn evaluated(text: &str, of: &Numbers<'_>) -> Result<f64, String> {
    match value(text, of)? {
        x if x.is_finite() => Ok(x),
        x => Err(format!("\"{text}\": {x} is not a finite number")),
    }
}
