//! Shapes and groups by name, and the side on which a velocity acts.

use super::declare::DeclaredGroup;
use super::entries::Entries;
use super::spec::{Group, Side};
use crate::diagnostic::{Diagnostic, Errors, closest};
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr};
use crate::groups;
use crate::syntax::ast::{Size, SizedName};
use crate::syntax::unknown;

/// The largest matrix size of the language.
const LARGEST: u64 = 32;

const SHAPES: [&str; 6] = ["Real", "Vec", "Sym", "Skew", "Diag", "Mat"];

/// The advice if a size of this kind is 0 or 1.
fn instead_of_one(kind: &str) -> &'static str {
    match kind {
        "SO" => {
            "that group has one element, so nothing moves: remove it; rotations of the plane are `SO<2>`, rotations of space \
             `SO<3>`"
        }
        "GL" => {
            "write a positive factor as the exponential of a field: `field x: Real;` and `exp(x)`; linear maps of the plane \
             are `GL<2>`"
        }
        _ => "a single number is `Real`",
    }
}

fn size(symbols: &Symbols, kind: &str, s: &Size, errors: &mut Errors) -> Option<Dim> {
    match s {
        Size::Number(n, place) => {
            if (2..=LARGEST).contains(n) {
                return u32::try_from(*n).ok().map(Dim::Fixed);
            }
            errors.push(
                Diagnostic::new(
                    *place,
                    format!("a size must be between 2 and {LARGEST}, not {n}"),
                )
                .help(match n {
                    0 | 1 => instead_of_one(kind),
                    _ => "use a smaller system, or split it into blocks",
                }),
            );
            None
        }
        Size::Name(name) => {
            let found = symbols.find_dim(&name.text);
            if found.is_none() {
                errors.push(
                    Diagnostic::new(
                        name.place,
                        format!("`{}` is not a declared dimension", name.text),
                    )
                    .help(format!("declare it first: `dim {} in 3..=8;`", name.text)),
                );
            }
            found
        }
    }
}

fn sizes(symbols: &Symbols, k: &SizedName, count: usize, errors: &mut Errors) -> Option<Vec<Dim>> {
    if k.sizes.len() != count {
        let name = &k.name.text;
        let example = match count {
            0 => format!("`{name}`"),
            _ => format!("`{name}<3>`"),
        };
        errors.push(
            Diagnostic::new(
                k.place,
                format!(
                    "`{name}` takes {}, {} given",
                    match count {
                        0 => "no size",
                        1 => "one size",
                        _ => "two sizes",
                    },
                    k.sizes.len()
                ),
            )
            .help(format!("write {example}")),
        );
        return None;
    }
    let kind = k.name.text.as_str();
    k.sizes
        .iter()
        .map(|s| size(symbols, kind, s, errors))
        .collect()
}

/// The shape and structure of a parameter.
pub fn shape(symbols: &Symbols, k: &SizedName, errors: &mut Errors) -> Option<(Shape, Structure)> {
    let square = |structure| move |d: Vec<Dim>| (Shape::square(d[0]), structure);
    let one = |errors: &mut Errors| sizes(symbols, k, 1, errors);
    match k.name.text.as_str() {
        "Real" => sizes(symbols, k, 0, errors).map(|_| (Shape::SCALAR, Structure::General)),
        "Vec" => one(errors).map(|d| (Shape::vector(d[0]), Structure::General)),
        "Sym" => one(errors).map(square(Structure::Symmetric)),
        "Skew" => one(errors).map(square(Structure::Skew)),
        "Diag" => one(errors).map(square(Structure::Diagonal)),
        "Mat" if k.sizes.len() == 2 && is_column(k) => {
            let own = k.sizes.iter().map(size_text);
            let own = own.collect::<Vec<_>>().join(", ");
            let other = k.sizes.iter().find(|s| !is_one(s)).map(size_text);
            let d = Diagnostic::new(
                k.place,
                format!("`Mat<{own}>` is not a matrix: each size must be at least 2"),
            );
            errors.push(match other {
                Some(n) if k.sizes.first().is_some_and(is_one) => d.help(format!(
                    "a row is the transpose of a vector: declare `Vec<{n}>` and write `v^T` for it"
                )),
                Some(n) => d.help(format!("a column is a vector: write `Vec<{n}>`")),
                None => d.help("a single number is `Real`"),
            });
            None
        }
        "Mat" if k.sizes.len() == 2 => sizes(symbols, k, 2, errors).map(|d| {
            let shape = Shape {
                rows: d[0],
                cols: d[1],
            };
            (shape, Structure::General)
        }),
        "Mat" => one(errors).map(square(Structure::General)),
        name if is_group(name) => group(symbols, k, errors).map(|g| (g.shape(), g.structure())),
        other => {
            let mut e = Diagnostic::new(k.name.place, format!("`{other}` is not a shape"));
            let near = closest(other, SHAPES.into_iter().chain(groups::families()));
            let meant = sized(other).or_else(|| unknown::shape(other).map(str::to_owned));
            e = match (meant, near) {
                (Some(written), _) => e.help(format!("write `{written}`")),
                (None, Some(near)) => e.help(format!("did you mean `{near}`?")),
                (None, None) => {
                    e.help("shapes are Real, Vec<n>, Sym<n>, Skew<n>, Diag<n>, Mat<n>, Mat<n, m>")
                }
            };
            errors.push(e);
            None
        }
    }
}

/// The shape that a name with an attached size probably means: `Vec3`, `SO3`.
fn sized(name: &str) -> Option<String> {
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let size = name.strip_prefix(stem).filter(|n| !n.is_empty())?;
    let mut known = SHAPES.into_iter().chain(groups::families());
    let known = stem != "Real" && known.any(|shape| shape == stem);
    known.then(|| format!("{stem}<{size}>"))
}

/// The shape and structure of an advected quantity.
pub fn advected_shape(
    symbols: &Symbols,
    k: &SizedName,
    errors: &mut Errors,
) -> Option<(Shape, Structure)> {
    shape(symbols, k, errors)
}

/// The shape in which a field is stored and varied, and how its matrix is built from it.
pub fn field(symbols: &Symbols, k: &SizedName, errors: &mut Errors) -> Option<(Shape, Entries)> {
    let (found, structure) = shape(symbols, k, errors)?;
    let column = |n: u32| match n {
        1 => Shape::SCALAR,
        n => Shape::vector(Dim::Fixed(n)),
    };
    match (structure, found.rows) {
        (Structure::General, _) => return Some((found, Entries::Own)),
        (Structure::Diagonal, rows) => return Some((Shape::vector(rows), Entries::Diagonal)),
        (Structure::Symmetric, Dim::Fixed(n)) => {
            return Some((column(n * (n + 1) / 2), Entries::Symmetric(n)));
        }
        (Structure::Skew, Dim::Fixed(n)) => {
            return Some((column(n * (n - 1) / 2), Entries::Skew(n)));
        }
        _ => {}
    }
    let own = written(k);
    let (message, help) = match is_group(&k.name.text) {
        true => (
            format!("a field is a sum of its increments, and `{own}` is not closed under sums"),
            format!("declare a configuration in a group as `group Λ: {own} velocity Ω;`"),
        ),
        false => (
            format!(
                "the entries of a field are independent, and the entries of `{own}` are not"
            ),
            "fields can be Real, Vec<n>, Diag<n>, Mat<n> or Mat<n, m>, and Sym<n> and Skew<n> if n is a number".to_owned(),
        ),
    };
    errors.push(Diagnostic::new(k.place, message).help(help));
    None
}

fn is_one(size: &Size) -> bool {
    matches!(size, Size::Number(1, _))
}

/// Whether one of the sizes is 1.
fn is_column(k: &SizedName) -> bool {
    k.sizes.iter().any(is_one)
}

fn size_text(size: &Size) -> String {
    match size {
        Size::Number(n, _) => n.to_string(),
        Size::Name(name) => name.text.clone(),
    }
}

/// A shape or a group in the notation of the language.
fn written(k: &SizedName) -> String {
    let sizes: Vec<String> = k.sizes.iter().map(size_text).collect();
    match sizes.is_empty() {
        true => k.name.text.clone(),
        false => format!("{}<{}>", k.name.text, sizes.join(", ")),
    }
}

fn is_group(name: &str) -> bool {
    groups::families().any(|family| family == name)
}

/// The group that a name and a size denote.
pub fn group(symbols: &Symbols, k: &SizedName, errors: &mut Errors) -> Option<Group> {
    let name = k.name.text.as_str();
    let all = || groups::listed("and", |_, _| true);
    if !is_group(name) {
        let e = Diagnostic::new(k.name.place, format!("`{name}` is not a group"));
        errors.push(match closest(name, groups::families()) {
            Some(near) => e.help(format!("did you mean `{near}<3>`?")),
            None => e.help(format!("the groups are {}", all())),
        });
        return None;
    }
    // In a family with few sizes, any other number is an invalid size.
    let given = match k.sizes.as_slice() {
        [Size::Number(n, _)] if groups::has_few_sizes(name) => {
            u32::try_from(*n).ok().map(Dim::Fixed)
        }
        _ => Some(*sizes(symbols, k, 1, errors)?.first()?),
    };
    let found = given.and_then(|n| groups::named(name, n));
    if found.is_none() {
        let own = groups::listed("and", |family, _| family == name);
        let own = own.replace(" and ", "` and `").replace(", ", "`, `");
        let message = format!("this version does not support the group `{}`", written(k));
        errors.push(Diagnostic::new(k.place, message).help(format!(
            "clebsch supports `{own}` in this family; the groups are {}",
            all()
        )));
    }
    found
}

/// The side, body or spatial, of a reconstruction.
pub fn side(symbols: &Symbols, g: &DeclaredGroup, update: &Expr) -> Option<Side> {
    let element = expr::here(symbols, g.element);
    let velocity = expr::here(symbols, g.velocity);
    if *update == expr::mul(element.clone(), velocity.clone()) {
        Some(Side::Body)
    } else if *update == expr::mul(velocity, element) {
        Some(Side::Spatial)
    } else {
        None
    }
}
