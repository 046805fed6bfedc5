//! Functionals of all sites as a model declares them: what computes each, of which field or other functional,
//! and of which constants. Mistakes of the declarations are told here.

#[cfg(test)]
mod tests;

use super::declared::{Kind, Lattice, Sites};
use crate::diagnostic::{Diagnostic, Errors, closest};
use crate::syntax::ast::{Model, Name, Statement};

/// What a functional is made of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// A field of places, by name.
    Field(String),
    /// Another functional, by its number.
    Functional(usize),
}

/// A functional of all sites.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// Its values, by this name.
    pub name: Name,
    /// The path of Rust of what computes it.
    pub path: String,
    /// What it is made of.
    pub of: Source,
    /// Its arguments in order, the first being what it is made of; the others are parameters.
    pub arguments: Vec<Name>,
    /// Whether it stays as it is when all places move by the same amount.
    pub is_uniform: bool,
    /// Whether what computes it is made for one dimension of the domain.
    pub of_dimension: bool,
}

/// What the runtime supplies by a bare name.
struct Supplied {
    name: &'static str,
    /// Whether it is made of another functional.
    of_functional: bool,
    /// How many parameters it takes.
    data: usize,
    /// Whether it is one of cells and particles in the plane; otherwise of grids.
    of_cells: bool,
}

/// One of cells in the plane, which equal shifts of all places leave as it is.
const fn cells(name: &'static str, data: usize) -> Supplied {
    let (of_functional, of_cells) = (false, true);
    Supplied {
        name,
        of_functional,
        data,
        of_cells,
    }
}

/// One of a grid.
const fn grid(name: &'static str, of_functional: bool) -> Supplied {
    let (data, of_cells) = (1, false);
    Supplied {
        name,
        of_functional,
        data,
        of_cells,
    }
}

const SUPPLIED: [Supplied; 8] = [
    cells("voronoi_area", 0),
    cells("helmholtz_depth", 2),
    cells("pair_core", 3),
    cells("second_moment", 0),
    grid("deposit", false),
    grid("deposit_quintic", false),
    grid("smooth", true),
    grid("smooth_isotropic", true),
];

impl Lattice {
    /// Reads the functionals, once everything that they may be made of is known.
    pub(super) fn functionals(&mut self, model: &Model, errors: &mut Errors) {
        for statement in &model.statements {
            let Statement::Mesh {
                name,
                shape,
                at,
                path,
                arguments,
            } = statement
            else {
                continue;
            };
            let Some(at) = at else {
                let d = Diagnostic::new(name.place, "at which sites its values stand is not said");
                errors.push(d.help(format!(
                    "write for example `mesh {}: Real at a = {}(X);`",
                    name.text, path.text
                )));
                continue;
            };
            if shape.name.text != "Real" {
                let d = Diagnostic::new(
                    shape.place,
                    "a functional of all sites has one number at each site",
                );
                errors.push(d.help(format!("write `mesh {}: Real at ...`", name.text)));
            }
            let one = std::slice::from_ref(name);
            self.quantities_at(one, shape, Some(at), Kind::Functional, errors);
            let on_line = self.find(&name.text).filter(|q| q.sites != Sites::Members);
            if on_line.is_some() {
                let d = Diagnostic::new(
                    at.place,
                    "functionals of all sites stand at sets of sites and at grids",
                );
                errors.push(d.help(
                    "along a line write the neighbours out: `2*m/(next(X, i) - prev(X, i))`",
                ));
                continue;
            }
            if let Some(mesh) = self.functional(name, path, arguments, errors) {
                self.meshes.push(mesh);
            }
        }
    }

    fn functional(
        &self,
        name: &Name,
        path: &Name,
        arguments: &[Name],
        errors: &mut Errors,
    ) -> Option<Mesh> {
        let first = arguments.first()?;
        let of = match self.find(&first.text).map(|q| q.kind) {
            Some(Kind::Configuration) => Source::Field(first.text.clone()),
            Some(Kind::Functional) => {
                let known = self.meshes.iter().position(|m| m.name.text == first.text);
                match known {
                    Some(i) => Source::Functional(i),
                    None => {
                        let message =
                            format!("`{}` is declared behind what is made of it", first.text);
                        errors
                            .push(Diagnostic::new(first.place, message).help("declare it before"));
                        return None;
                    }
                }
            }
            _ => {
                let message = format!(
                    "`{}` is neither a field at sites nor another functional",
                    first.text
                );
                let d = Diagnostic::new(first.place, message);
                errors.push(d.help(
                    "the first argument is what moves: `field X: Vec<2> at a on torus(L);`, then `mesh A: Real at a = voronoi_area(X);`",
                ));
                return None;
            }
        };
        let moving = |n: &&Name| self.moving.contains(&n.text);
        if let Some(second) = arguments.iter().skip(1).find(moving) {
            let message = format!("`{}` moves, and only the first argument may", second.text);
            errors.push(Diagnostic::new(second.place, message).help("the others are parameters"));
            return None;
        }
        if path.text.contains("::") {
            return Some(Mesh {
                name: name.clone(),
                path: path.text.clone(),
                of,
                arguments: arguments.to_vec(),
                is_uniform: false,
                of_dimension: false,
            });
        }
        let Some(known) = SUPPLIED.iter().find(|s| s.name == path.text) else {
            let d = Diagnostic::new(
                path.place,
                format!("`{}` is no functional that is known by its name", path.text),
            );
            let names = SUPPLIED.iter().map(|s| s.name);
            let d = match closest(&path.text, names.clone()) {
                Some(near) => d.help(format!("did you mean `{near}`?")),
                None => d.help(format!(
                    "known are {}",
                    names.collect::<Vec<_>>().join(", ")
                )),
            };
            errors.push(d.help("one of your own is given by its path, `crate::area(X)`"));
            return None;
        };
        let of_grid = matches!(of, Source::Functional(_));
        let data = known.data;
        if known.of_functional != of_grid || arguments.len() != data + 1 {
            let what = match known.of_functional {
                true => "another functional",
                false => "a field",
            };
            let message = format!(
                "`{}` is made of {what}, with {data} parameter{} behind it",
                path.text,
                if data == 1 { "" } else { "s" }
            );
            errors.push(Diagnostic::new(path.place, message).help(example(&path.text)));
            return None;
        }
        Some(Mesh {
            name: name.clone(),
            path: format!("clebsch::mesh::{}", path.text),
            of,
            arguments: arguments.to_vec(),
            is_uniform: known.of_cells,
            of_dimension: !known.of_cells,
        })
    }
}

/// How it is written.
fn example(name: &str) -> String {
    let call = match name {
        "voronoi_area" => "mesh A: Real at a = voronoi_area(X)",
        "helmholtz_depth" => "mesh phi: Real at a = helmholtz_depth(X, m, alpha)",
        "pair_core" => "mesh core: Real at a = pair_core(X, m, rc, kappa)",
        "second_moment" => "mesh I: Real at a = second_moment(X)",
        "smooth" | "smooth_isotropic" => "mesh S: Real at n = smooth(H, alpha)",
        _ => "mesh H: Real at n = deposit(X, m)",
    };
    format!("write for example `{call};`")
}
