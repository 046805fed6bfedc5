//! Site data in cases: the value of an expression such as `"0.1*sin(2*pi*i/N)"` at a site.

use crate::syntax;
use crate::syntax::ast::{Expression, Kind};

/// Functions that site data may hold.
const FUNCTIONS: [&str; 12] = [
    "sin", "cos", "tan", "atan", "exp", "log", "sqrt", "sinh", "cosh", "tanh", "abs", "sign",
];

/// An expression that was read.
#[derive(Clone, Debug)]
pub struct SiteData {
    expression: Expression,
}

impl SiteData {
    /// Reads an expression.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    pub fn read(text: &str) -> Result<SiteData, String> {
        let read = syntax::expression(text);
        let expression = read.map_err(|errors| {
            let first = errors.iter().next().map(|d| d.message.clone());
            first.unwrap_or_else(|| "it is no expression".to_owned())
        })?;
        Ok(SiteData { expression })
    }

    /// Its value, with the values of names.
    ///
    /// # Errors
    /// A name without a value, or an operation that numbers do not have.
    pub fn value(&self, of: &dyn Fn(&str) -> Option<f64>) -> Result<f64, String> {
        value(&self.expression, of)
    }
}

fn value(e: &Expression, of: &dyn Fn(&str) -> Option<f64>) -> Result<f64, String> {
    Ok(match &e.kind {
        Kind::Number(q) => q.value(),
        Kind::Constant(c) => c.value(),
        Kind::Name(n) if crate::syntax::is_circle(n) => std::f64::consts::PI,
        Kind::Name(n) => of(n).ok_or_else(|| match n.as_str() {
            "t" => "`t` has no value here: data are of the start, and what an end holds stays as it is there".to_owned(),
            n => format!("`{n}` has no value here"),
        })?,
        Kind::Shaped(a, _) => value(a, of)?,
        Kind::Sum(terms) => {
            let mut total = 0.0;
            for (minus, t) in terms {
                let v = value(t, of)?;
                total += if *minus { -v } else { v };
            }
            total
        }
        Kind::Product(list) => {
            let mut total = 1.0;
            for f in list {
                total *= value(f, of)?;
            }
            total
        }
        Kind::Quotient(a, b) => value(a, of)? / value(b, of)?,
        Kind::Neg(a) => -value(a, of)?,
        Kind::Power(a, q) => {
            let base = value(a, of)?;
            match q.as_integer() {
                Some(n) => base.powi(n),
                None => base.powf(q.value()),
            }
        }
        Kind::Call(f, arguments) => {
            let [x] = arguments.as_slice() else {
                return Err(format!("`{}` takes one number here", f.text));
            };
            let x = value(x, of)?;
            match f.text.as_str() {
                "sin" => x.sin(),
                "cos" => x.cos(),
                "tan" => x.tan(),
                "atan" => x.atan(),
                "exp" => x.exp(),
                "log" => x.ln(),
                "sqrt" => x.sqrt(),
                "sinh" => x.sinh(),
                "cosh" => x.cosh(),
                "tanh" => x.tanh(),
                "abs" => x.abs(),
                "sign" if x == 0.0 => 0.0,
                "sign" => x.signum(),
                other => {
                    let known = FUNCTIONS.join(" ");
                    return Err(format!(
                        "`{other}` is no function of site data; there are {known}"
                    ));
                }
            }
        }
        Kind::Transpose(_) | Kind::Component(..) => {
            return Err(
                "site data are numbers: components and transposes have no place".to_owned(),
            );
        }
    })
}
