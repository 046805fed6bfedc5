//! Site data in cases: the value of an expression such as `"0.1*sin(2*pi*i/N)"` at a site.

use crate::diagnostic::closest;
use crate::syntax::ast::{Expression, Kind};
use crate::syntax::{self, unknown};
use std::collections::BTreeSet;

/// A function of a number, with its name.
type Function = (&'static str, fn(f64) -> f64);

/// Functions allowed in site data.
const FUNCTIONS: [Function; 12] = [
    ("sin", f64::sin),
    ("cos", f64::cos),
    ("tan", f64::tan),
    ("atan", f64::atan),
    ("exp", f64::exp),
    ("log", f64::ln),
    ("sqrt", f64::sqrt),
    ("sinh", f64::sinh),
    ("cosh", f64::cosh),
    ("tanh", f64::tanh),
    ("abs", f64::abs),
    ("sign", |x| if x == 0.0 { 0.0 } else { x.signum() }),
];

/// An expression for site data.
#[derive(Clone, Debug)]
pub struct SiteData {
    expression: Expression,
}

impl SiteData {
    /// Reads an expression.
    ///
    /// # Errors
    /// A description of the mistake in the text.
    pub fn read(text: &str) -> Result<SiteData, String> {
        let read = syntax::expression(text);
        let expression = read.map_err(|errors| {
            let first = errors.iter().next();
            first.map_or_else(
                || "it is not an expression".to_owned(),
                |d| match d.help.first() {
                    Some(help) => format!("{}; {help}", d.message),
                    None => d.message.clone(),
                },
            )
        })?;
        Ok(SiteData { expression })
    }

    /// Evaluates the expression with the values of names.
    ///
    /// # Errors
    /// A name without a value, or an operation that is not defined for numbers.
    pub fn value(&self, of: &Names<'_>) -> Result<f64, String> {
        self.value_and_slopes(of, &|_, _| None)
    }

    /// Evaluates with the slopes of names, `slope(S, 1)`, as [`SiteData::slopes`] lists them.
    ///
    /// # Errors
    /// As [`SiteData::value`]; an undefined slope.
    pub fn value_and_slopes(&self, of: &Names<'_>, slope: &Slopes<'_>) -> Result<f64, String> {
        value(&self.expression, &ValuesAndSlopes { of, slope })
    }

    /// The names in it, including the names in slopes.
    pub fn names(&self) -> BTreeSet<String> {
        let mut out = BTreeSet::new();
        self.expression.each(&mut |e| {
            if let Kind::Name(n) = &e.kind {
                out.insert(n.clone());
            }
        });
        out
    }

    /// The slopes in the expression: name and direction, counted from 1.
    ///
    /// # Errors
    /// One of the slopes is not a name with a numeric direction.
    pub fn slopes(&self) -> Result<Vec<(String, u64)>, String> {
        let mut out = Vec::new();
        self.expression.each(&mut |e| {
            if let Kind::Call(f, arguments) = &e.kind
                && f.text == SLOPE
            {
                out.push(slope_of(arguments).map(|(name, along)| (name.to_owned(), along)));
            }
        });
        out.into_iter().collect()
    }
}

/// The values of names.
pub type Names<'a> = dyn Fn(&str) -> Option<f64> + 'a;

/// The slopes of names along directions.
pub type Slopes<'a> = dyn Fn(&str, u64) -> Option<f64> + 'a;

/// The function `slope`, the derivative of a mesh along a direction.
const SLOPE: &str = "slope";

struct ValuesAndSlopes<'a> {
    of: &'a Names<'a>,
    slope: &'a Slopes<'a>,
}

/// The name and the direction of a slope.
fn slope_of(arguments: &[Expression]) -> Result<(&str, u64), String> {
    let [name, direction] = arguments else {
        return Err("`slope` takes a mesh and a direction, as in slope(S, 1)".to_owned());
    };
    let Kind::Name(name) = &name.kind else {
        return Err(
            "`slope` takes the name of a mesh, as in slope(S, 1): apply the product and chain rules yourself, as in \
             2*S*slope(S, 1) for S^2"
                .to_owned(),
        );
    };
    let along = match &direction.kind {
        Kind::Number(q) => q.as_integer().and_then(|n| u64::try_from(n).ok()),
        _ => None,
    };
    let along = along.ok_or_else(|| {
        format!("the direction of a slope must be a whole number, as in slope({name}, 1)")
    })?;
    Ok((name, along))
}

fn value(e: &Expression, of: &ValuesAndSlopes<'_>) -> Result<f64, String> {
    Ok(match &e.kind {
        Kind::Number(q) => q.value(),
        Kind::Constant(c) => c.value(),
        Kind::Name(n) if crate::syntax::is_circle(n) => std::f64::consts::PI,
        Kind::Name(n) => (of.of)(n).ok_or_else(|| match n.as_str() {
            "t" => "`t` has no value here: the case gives initial values, and values at an end are constant in time".to_owned(),
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
        Kind::Call(f, arguments) if f.text == SLOPE => {
            let (name, along) = slope_of(arguments)?;
            (of.slope)(name, along).ok_or_else(|| {
                format!(
                    "slope({name}, {along}) has no value here: use it for meshes on the grid of a fluid, in [initial] values \
                     at its particles"
                )
            })?
        }
        Kind::Call(f, arguments) => {
            let own = FUNCTIONS.iter().find(|(name, _)| *name == f.text);
            let Some((_, function)) = own else {
                let known = FUNCTIONS.map(|(name, _)| name);
                let written = unknown::function(&f.text).filter(|help| is_of_sites(help));
                let help = match (written, closest(&f.text, known)) {
                    (Some(written), _) => format!("{written}. There"),
                    (None, Some(near)) => format!("did you mean `{near}`? There"),
                    (None, None) => "there".to_owned(),
                };
                return Err(format!(
                    "`{}` is not a function of site data; {help} are {}, and for fluids on a grid slope",
                    f.text,
                    known.join(" ")
                ));
            };
            let [x] = arguments.as_slice() else {
                return Err(format!("`{}` takes one number here", f.text));
            };
            function(value(x, of)?)
        }
        Kind::Transpose(_) | Kind::Component(..) => {
            return Err(
                "site data must be numbers: components and transposes are not supported".to_owned(),
            );
        }
    })
}

/// Suggests a replacement for an undefined name that other languages define.
#[must_use]
pub fn instead_of(name: &str) -> Option<String> {
    match unknown::name(name) {
        Some("pi") => Some("write `pi`".to_owned()),
        _ if unknown::ANGLES.contains(&name) => Some(unknown::RADIANS.to_owned()),
        _ => None,
    }
}

/// Translates an expression of another language, such as `2*np.pi**2`; `None` if the result is not an expression.
#[must_use]
pub fn translated(text: &str) -> Option<String> {
    let mut out = text.trim().replace("**", "^");
    for module in unknown::MODULES {
        out = without_module(&out, module);
    }
    SiteData::read(&out).ok().map(|_| out)
}

/// Removes a module prefix from names: `np.sin(x)` becomes `sin(x)`.
fn without_module(text: &str, module: &str) -> String {
    let prefix = format!("{module}.");
    let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
    let mut out = String::new();
    for piece in text.split_inclusive(prefix.as_str()) {
        let Some(before) = piece.strip_suffix(prefix.as_str()) else {
            out.push_str(piece);
            continue;
        };
        out.push_str(before);
        if out.ends_with(is_part) {
            out.push_str(&prefix);
        }
    }
    out
}

/// Whether the suggestion of a help text is valid site data.
fn is_of_sites(help: &str) -> bool {
    let Some(Ok(data)) = help.split('`').nth(1).map(SiteData::read) else {
        return false;
    };
    let mut known = true;
    data.expression.each(&mut |e| {
        if let Kind::Call(f, _) = &e.kind {
            known &= FUNCTIONS.iter().any(|(name, _)| *name == f.text);
        }
    });
    known
}

#[cfg(test)]
mod tests {
    use super::SiteData;

    #[test]
    fn expressions_of_python_are_translated_or_told() {
        let translated = super::translated;
        assert_eq!(translated("2*np.pi**2").as_deref(), Some("2*pi^2"));
        assert_eq!(translated("math.sin(2)").as_deref(), Some("sin(2)"));
        for none in ["(3.0, 0.0)", "", "x.np.sin(1)", "[1, 2]"] {
            assert_eq!(translated(none), None, "{none}");
        }
        let why = |text: &str| SiteData::read(text).expect_err("a module");
        assert!(why("2*np.pi").contains("write `pi`"), "{}", why("2*np.pi"));
        let sine = why("np.sin(i)");
        assert!(sine.contains("write `sin(...)`"), "{sine}");
    }

    #[test]
    fn names_and_slopes_are_listed_and_have_their_values() {
        let data = SiteData::read("-(c^2/f)*slope(S, 2) + sqrt(S)").expect("is read");
        assert_eq!(data.slopes(), Ok(vec![("S".to_owned(), 2)]));
        assert_eq!(Vec::from_iter(data.names()), ["S", "c", "f"]);
        let of = |name: &str| Some(if name == "S" { 4.0 } else { 3.0 });
        let slope = |name: &str, along: u64| (name == "S" && along == 2).then_some(0.5);
        assert_eq!(data.value_and_slopes(&of, &slope), Ok(-1.5 + 2.0));
        let none = data.value(&of).expect_err("no slopes here");
        assert!(none.contains("slope(S, 2) has no value here"), "{none}");
        for wrong in [
            "slope(S)",
            "slope(S, 1.5)",
            "slope(S, -1)",
            "slope(2*S, 1)",
            "slope(S, c)",
        ] {
            let data = SiteData::read(wrong).expect("is read");
            assert!(data.slopes().is_err(), "{wrong}");
        }
    }
}
