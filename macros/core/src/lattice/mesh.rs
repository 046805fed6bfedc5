//! Functionals of all sites as a model declares them: the function that computes each, the field or functional it
//! depends on, and its constants. Mistakes in the declarations are reported here.

#[cfg(test)]
mod tests;

use super::declared::{Kind, Lattice, Quantity, Sites};
use crate::diagnostic::{Diagnostic, Errors, closest};
use crate::syntax::ast::{Extent, Model, Name, Statement};

/// The quantity that a functional depends on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// A field of positions, by name.
    Field(String),
    /// Another functional, by its number.
    Functional(usize),
}

/// A functional of all sites.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// The name of its values.
    pub name: Name,
    /// The Rust path of the function that computes it.
    pub path: String,
    /// The quantity it depends on.
    pub of: Source,
    /// Its arguments in order. The first is the quantity it depends on; the others are parameters.
    pub arguments: Vec<Name>,
    /// Its known properties.
    pub kind: FunctionalKind,
}

/// The known properties of a functional.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FunctionalKind {
    /// It belongs to cells and particles, and is invariant when all positions move by the same amount.
    Cells,
    /// It belongs to grids, made for the dimension of the domain.
    Grid,
    /// Only its path is known.
    Path,
}

/// A functional that the runtime provides under a bare name.
struct Supplied {
    name: &'static str,
    /// Whether it depends on another functional.
    of_functional: bool,
    /// How many parameters it takes.
    data: usize,
    /// Whether it is for cells and particles in the plane, or for grids.
    kind: FunctionalKind,
}

/// A functional of cells in the plane, which is invariant under equal shifts of all positions.
const fn cells(name: &'static str, data: usize) -> Supplied {
    let (of_functional, kind) = (false, FunctionalKind::Cells);
    Supplied {
        name,
        of_functional,
        data,
        kind,
    }
}

/// A functional on a grid.
const fn grid(name: &'static str, of_functional: bool) -> Supplied {
    let (data, kind) = (1, FunctionalKind::Grid);
    Supplied {
        name,
        of_functional,
        data,
        kind,
    }
}

const SUPPLIED: [Supplied; 10] = [
    cells("voronoi_area", 0),
    cells("helmholtz_depth", 2),
    cells("helmholtz_twice", 2),
    cells("kernel_depth", 2),
    cells("pair_core", 3),
    cells("second_moment", 0),
    grid("deposit", false),
    grid("deposit_quintic", false),
    grid("smooth", true),
    grid("smooth_isotropic", true),
];

impl Lattice {
    /// Reads the functionals, after everything they may depend on has been read.
    pub(super) fn functionals(&mut self, model: &Model, errors: &mut Errors) {
        let parameters = parameters(model);
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
                let d = Diagnostic::new(
                    name.place,
                    "this functional does not say at which sites it has values",
                );
                errors.push(d.help(format!(
                    "write for example `mesh {}: Real at a = {}(X);`",
                    name.text, path.text
                )));
                continue;
            };
            if shape.name.text != "Real" {
                let d = Diagnostic::new(
                    shape.place,
                    "a functional of all sites must have one number at each site",
                );
                errors.push(d.help(format!("write `mesh {}: Real at ...`", name.text)));
            }
            if let Some(line) = self.line_label() {
                let d = Diagnostic::new(
                    name.place,
                    "functionals of all sites need a set of sites or a grid, and this model has a chain",
                );
                errors.push(d.also(line.index.place, "the chain is declared here").help(
                    "along a chain write the neighbours out, `2*m/(next(X, i) - prev(X, i))`; for a set of sites, declare the \
                     quantities `at a`",
                ));
                continue;
            }
            let one = std::slice::from_ref(name);
            self.quantities_at(one, shape, Some(at), Kind::Functional, errors);
            if self.find(&name.text).is_none() {
                continue;
            }
            match self.functional(name, path, arguments, &parameters) {
                Ok(mesh) => self.meshes.push(mesh),
                Err(d) => errors.push(*d),
            }
        }
        self.domains(model, &parameters, errors);
        self.unused(model, errors);
    }

    /// Every functional must occur in a term, or be an argument of another functional.
    fn unused(&self, model: &Model, errors: &mut Errors) {
        let stands = |name: &str, statement: &Statement| match statement {
            Statement::Let { value, .. } | Statement::Lagrangian(value) => {
                value.name_that(&|n| n == name).is_some()
            }
            Statement::Mesh { arguments, .. } => arguments.iter().any(|a| a.text == name),
            _ => false,
        };
        for statement in &model.statements {
            let Statement::Mesh { name, .. } = statement else {
                continue;
            };
            if !model.statements.iter().any(|s| stands(&name.text, s)) {
                let message = format!("no term of the Lagrangian contains `{}`", name.text);
                errors.push(
                    Diagnostic::new(name.place, message)
                        .help("add the term that uses it, or remove the functional"),
                );
            }
        }
    }

    /// Checks that at most one field has a domain, at a set of sites. Constraints, assumptions and advected quantities must
    /// not contain functionals.
    fn domains(&self, model: &Model, parameters: &[Parameter], errors: &mut Errors) {
        let is_mesh = |s: &&Statement| matches!(s, Statement::Mesh { .. });
        let stated = model.statements.iter().filter(is_mesh).count();
        let mut with = self.quantities.iter().filter(|q| q.domain.is_some());
        if let (Some(first), Some(second)) = (with.next(), with.next()) {
            let d = Diagnostic::new(second.name.place, "a second field is declared in a domain");
            errors.push(
                d.also(first.name.place, "the first field is declared here")
                    .help("a model has one domain: remove `on ...` from the other field"),
            );
        }
        for q in self.quantities.iter().filter(|q| q.domain.is_some()) {
            if q.sites != Sites::Members {
                let d = Diagnostic::new(
                    q.name.place,
                    "only a field at a set of sites can have a domain",
                );
                errors.push(d.help("along a ring write `offset L` instead of `on ...`"));
            } else if stated == self.meshes.len()
                && !self
                    .meshes
                    .iter()
                    .any(|m| m.of == Source::Field(q.name.text.clone()))
            {
                let message = format!("`{}` has a domain, but no functional uses it", q.name.text);
                errors.push(Diagnostic::new(q.name.place, message).help(
                    "declare a functional, `mesh A: Real at a = voronoi_area(X);`, or remove `on ...`",
                ));
            }
            if let Some(Extent::Torus(lengths)) = &q.domain
                && let Some(twice) = parameters.iter().find(|p| p.name.text == lengths.text)
            {
                let message = format!("`{}` is declared twice", lengths.text);
                errors.push(
                    Diagnostic::new(twice.name.place, message)
                        .also(lengths.place, "here it names the side lengths of the torus"),
                );
            }
        }
        let mut grids = self.labels.iter().filter(|l| l.grid);
        if let (Some(first), Some(second)) = (grids.next(), grids.next()) {
            let d = Diagnostic::new(second.index.place, "a model can have only one grid");
            errors.push(d.also(first.index.place, "the first grid is declared here"));
        }
        for statement in &model.statements {
            let (found, what) = match statement {
                Statement::Hold { left, right, .. } => {
                    ([Some(left), Some(right)], "a `hold` constraint")
                }
                Statement::Assume { left, right, .. } => {
                    ([Some(left), Some(right)], "an assumption")
                }
                Statement::Constraint { value, .. } => {
                    ([Some(value), None], "an evolution constraint")
                }
                Statement::Advected { definition, .. } => {
                    ([definition.as_ref(), None], "the definition of a quantity")
                }
                _ => continue,
            };
            if let Some(e) = found.into_iter().flatten().find(|e| self.has_functional(e)) {
                let message = format!("{what} cannot contain a functional of all sites");
                errors.push(
                    Diagnostic::new(e.place, message)
                        .help("use functionals in the Lagrangian, in terms at one node"),
                );
            }
        }
    }

    fn functional(
        &self,
        name: &Name,
        path: &Name,
        arguments: &[Name],
        parameters: &[Parameter],
    ) -> Checked<Mesh> {
        let refused = |place, message: String, help: &str| {
            Err(Box::new(Diagnostic::new(place, message).help(help)))
        };
        let Some(first) = arguments.first() else {
            return refused(
                path.place,
                "a functional needs an argument".to_owned(),
                &example(&path.text),
            );
        };
        let of = self.source(first)?;
        for data in arguments.iter().skip(1) {
            if self.moving.contains(&data.text) {
                let message = format!(
                    "only the first argument may be a field or a functional, and `{}` is one",
                    data.text
                );
                return refused(
                    data.place,
                    message,
                    "the other arguments must be parameters",
                );
            }
            if !parameters.iter().any(|p| p.name.text == data.text) {
                let message = format!("`{}` is not a parameter", data.text);
                return refused(
                    data.place,
                    message,
                    "declare it, `param alpha: Real;`, or at each site, `param m: Real at a;`",
                );
            }
        }
        let mesh = |path: String, kind: FunctionalKind| Mesh {
            name: name.clone(),
            path,
            of: of.clone(),
            arguments: arguments.to_vec(),
            kind,
        };
        if path.text.contains("::") {
            return Ok(mesh(path.text.clone(), FunctionalKind::Path));
        }
        let Some(known) = SUPPLIED.iter().find(|s| s.name == path.text) else {
            let d = Diagnostic::new(
                path.place,
                format!("`{}` is not a functional of clebsch", path.text),
            );
            let names = SUPPLIED.iter().map(|s| s.name);
            let d = match closest(&path.text, names.clone()) {
                Some(near) => d.help(format!("did you mean `{near}`?")),
                None => d.help(format!(
                    "known are {}",
                    names.collect::<Vec<_>>().join(", ")
                )),
            };
            return Err(Box::new(
                d.help("give your own functional by its path, `crate::area(X)`"),
            ));
        };
        self.supplied(known, name, path, arguments, &of, parameters)?;
        Ok(mesh(format!("clebsch::mesh::{}", path.text), known.kind))
    }

    /// The source that the first argument denotes.
    fn source(&self, first: &Name) -> Checked<Source> {
        let found = self.find(&first.text);
        let message = match found.map(|q| (q.kind, q.shape.name.text.as_str())) {
            Some((Kind::Configuration, "Real" | "Vec")) => {
                return Ok(Source::Field(first.text.clone()));
            }
            Some((Kind::Configuration, _)) => {
                format!(
                    "`{}` is not a position: a position is a number or a vector",
                    first.text
                )
            }
            Some((Kind::Functional, _)) => {
                let known = self.meshes.iter().position(|m| m.name.text == first.text);
                match known {
                    Some(i) => return Ok(Source::Functional(i)),
                    None => format!("`{}` is used before its declaration", first.text),
                }
            }
            _ => format!(
                "`{}` is neither a field at sites nor a functional declared earlier",
                first.text
            ),
        };
        Err(Box::new(Diagnostic::new(first.place, message).help(
            "the first argument must be the field, `field X: Vec<2> at a on torus(L);`, as in `mesh A: Real at a = \
             voronoi_area(X);`",
        )))
    }

    /// Checks that a functional of the runtime has an argument of the right kind, and is declared at the sites of its
    /// values.
    fn supplied(
        &self,
        known: &Supplied,
        name: &Name,
        path: &Name,
        arguments: &[Name],
        of: &Source,
        parameters: &[Parameter],
    ) -> Checked<()> {
        let refused = |place, message: String, help: String| {
            Err(Box::new(Diagnostic::new(place, message).help(help)))
        };
        let what = match known.of_functional {
            true => "another functional",
            false => "a field",
        };
        let write = || example(&path.text);
        let of_cells = known.kind == FunctionalKind::Cells;
        if known.of_functional != matches!(of, Source::Functional(_)) {
            let message = format!("the first argument of `{}` must be {what}", path.text);
            return refused(path.place, message, write());
        }
        if arguments.len() != known.data + 1 {
            let message = match known.data {
                0 => format!("`{}` takes only {what}", path.text),
                1 => format!("`{}` takes {what} and one parameter", path.text),
                n => format!("`{}` takes {what} and {n} parameters", path.text),
            };
            return refused(path.place, message, write());
        }
        let label_of = |n: &str| self.find(n).map(|q| q.label);
        let is_grid = |l: Option<usize>| l.is_some_and(|l| self.is_grid(l));
        let (own, theirs) = (label_of(&name.text), label_of(&arguments[0].text));
        let (first, place) = (&arguments[0], arguments[0].place);
        match known.of_functional {
            true if !is_grid(theirs) => {
                let message = format!("`{}` is not declared at the nodes of a grid", first.text);
                return refused(place, message, write());
            }
            true if own != theirs => {
                let message = format!(
                    "`{}` must be declared at the same sites as `{}`",
                    path.text, first.text
                );
                return refused(name.place, message, write());
            }
            true => {}
            false => {
                let q = self.find(&first.text);
                if q.is_some_and(|q| q.domain.is_none()) {
                    let message = format!("the positions `{}` have no domain", first.text);
                    let help = "write `field X: Vec<2> at a on torus(L);`, or `on box`".to_owned();
                    return refused(place, message, help);
                }
                let sizes = q.and_then(|q| q.shape.components());
                if sizes != Some(2) && (of_cells || sizes != Some(1)) {
                    let message = match of_cells {
                        true => format!(
                            "`{}` needs positions in the plane, and `{}` has another shape",
                            path.text, first.text
                        ),
                        false => format!(
                            "`{}` needs positions on a line or in the plane, and `{}` has another shape",
                            path.text, first.text
                        ),
                    };
                    return refused(
                        place,
                        message,
                        "write `field X: Vec<2> at a on torus(L);`".to_owned(),
                    );
                }
                if of_cells && own != theirs {
                    let message = format!("`{}` has its values at the particles", path.text);
                    return refused(name.place, message, write());
                }
                if !of_cells && !is_grid(own) {
                    let message = format!("`{}` has its values at the nodes of a grid", path.text);
                    return refused(
                        name.place,
                        message,
                        format!("declare a grid, `grid n;`, and {}", write()),
                    );
                }
            }
        }
        if known.name == "smooth_isotropic" {
            let plane = |q: &Quantity| q.shape.components() == Some(2);
            if self.places().is_some_and(|q| !plane(q)) {
                let message =
                    "`smooth_isotropic` works in the plane only: on a line write `smooth`"
                        .to_owned();
                return refused(path.place, message, write());
            }
        }
        for (i, data) in arguments.iter().enumerate().skip(1) {
            let masses = !known.of_functional && i == 1;
            let Some(p) = parameters.iter().find(|p| p.name.text == data.text) else {
                continue;
            };
            let at = label_of(&data.text);
            if p.shape != "Real" || masses != at.is_some() || (masses && at != theirs) {
                let message = match masses {
                    true => format!(
                        "`{}` is not one number per particle: this argument is the masses",
                        data.text
                    ),
                    false => format!("`{}` is not a single number", data.text),
                };
                return refused(data.place, message, write());
            }
        }
        Ok(())
    }
}

/// A parameter of a model.
struct Parameter {
    name: Name,
    shape: String,
}

fn parameters(model: &Model) -> Vec<Parameter> {
    let each = model.statements.iter().filter_map(|s| match s {
        Statement::Param { names, shape, .. } => Some((names, &shape.name.text)),
        _ => None,
    });
    let each = each.flat_map(|(names, shape)| {
        names.iter().map(move |name| Parameter {
            name: name.clone(),
            shape: shape.clone(),
        })
    });
    each.collect()
}

type Checked<T> = Result<T, Box<Diagnostic>>;

/// An example of a declaration.
fn example(name: &str) -> String {
    let call = match name {
        "voronoi_area" => "mesh A: Real at a = voronoi_area(X)",
        "helmholtz_depth" => "mesh phi: Real at a = helmholtz_depth(X, m, alpha)",
        "helmholtz_twice" => "mesh phi: Real at a = helmholtz_twice(X, m, alpha)",
        "kernel_depth" => "mesh phi: Real at a = kernel_depth(X, m, alpha)",
        "pair_core" => "mesh core: Real at a = pair_core(X, m, rc, kappa)",
        "second_moment" => "mesh I: Real at a = second_moment(X)",
        "smooth" | "smooth_isotropic" => "mesh S: Real at n = smooth(H, alpha)",
        _ => "mesh H: Real at n = deposit(X, m)",
    };
    format!("write for example `{call};`")
}
