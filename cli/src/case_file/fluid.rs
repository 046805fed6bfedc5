//! Values of a fluid at its particles and nodes: positions on a lattice, depths, velocities, expressions in the
//! position.
//! Takes a case; gives the numbers of every quantity at all of its sites.

mod expressions;
mod meshes;

use super::from_npz::{self, Arrays, Fault};
use super::location::File;
use super::scope::Scope;
use super::space::Space;
use super::start::places;
use super::stated::Stated;
use super::value::names_a_file;
use crate::terminal::failure::Failure;
use clebsch::mesh::{Domain, Voronoi};
use clebsch::nalgebra::SVector;
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::{ChainConfig, Kind, Quantity};
use clebsch_interpret::AtParticles;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::collections::HashSet;
use std::ops::Range;
use std::rc::Rc;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The numbers of one quantity.
#[derive(Clone, Debug)]
pub(super) struct Column {
    numbers: Vec<f64>,
    /// How many there are at a site.
    size: usize,
    /// The line of the file that contains them.
    line: usize,
}

/// All values of a fluid.
#[derive(Clone, Debug, Default)]
pub(super) struct Fluid {
    columns: BTreeMap<String, Column>,
    /// The quantities without a site, by name.
    whole: BTreeMap<String, Vec<f64>>,
    /// Keys that were read.
    used: HashSet<String>,
}

/// How values at sites are read.
struct Reader<'a> {
    file: &'a File<'a>,
    stated: &'a Stated,
    choice: &'a ChainConfig,
    space: &'a Space,
    scope: Scope,
    /// The positions of the nodes of the grid, and their weights.
    nodes: (Vec<Vec<f64>>, Vec<f64>),
    /// Meshes at the particles, by number, if an expression uses them.
    meshes: RefCell<BTreeMap<usize, Rc<AtParticles>>>,
    arrays: Arrays,
    fluid: Fluid,
}

/// A mistake in a value, with its range in the text if only a part of the value is wrong.
struct Wrong {
    why: String,
    at: Option<Range<usize>>,
}

impl From<String> for Wrong {
    fn from(why: String) -> Self {
        Wrong { why, at: None }
    }
}

impl From<Fault> for Wrong {
    fn from(fault: Fault) -> Self {
        Wrong {
            why: fault.why,
            at: Some(fault.at),
        }
    }
}

type OptionalValue<'a, 'i> = Option<&'a Spanned<DeValue<'i>>>;

impl Fluid {
    /// Reads the fluid of a case; `None` if the model is not a fluid.
    pub(super) fn read(
        file: &File<'_>,
        top: &DeTable<'_>,
        stated: &Stated,
        choice: &ChainConfig,
    ) -> Result<Option<Fluid>, Failure> {
        let Some(space) = Space::read(file, top, stated)? else {
            return Ok(None);
        };
        let parameters = file.table(top, "parameters")?;
        let initial = file.table(top, "initial")?;
        let nodes = match &space.cells {
            Some(_) => space.nodes().map_err(|why| file.wrong(None, &why))?,
            None => Default::default(),
        };
        let mut reader = Reader {
            file,
            stated,
            choice,
            space: &space,
            scope: Scope::of(top),
            nodes,
            meshes: RefCell::default(),
            arrays: Arrays::of(file),
            fluid: Fluid::default(),
        };
        reader.whole();
        let quantities = &stated.lattice.quantities;
        if let Some(places) = stated.lattice.places() {
            let key = ascii(&places.name.text);
            reader.places(places, initial.and_then(|t| t.get(key.as_str())))?;
        }
        for q in quantities.iter().filter(|q| q.kind == Kind::Parameter) {
            let key = ascii(&q.name.text);
            reader.parameter(q, parameters.and_then(|t| t.get(key.as_str())))?;
        }
        let moving = || quantities.iter().filter(|q| q.kind == Kind::Configuration);
        for q in moving().filter(|q| q.domain.is_none()) {
            let key = ascii(&q.name.text);
            reader.beside_places(q, initial.and_then(|t| t.get(key.as_str())))?;
        }
        for q in moving() {
            reader.motion(q, initial)?;
        }
        Ok(Some(reader.fluid))
    }

    /// The numbers of a field of the card, found by its name or by its quantity and site, and their line.
    pub(super) fn numbers(
        &self,
        field: &str,
        key: Option<(&str, usize)>,
    ) -> Option<(&[f64], usize)> {
        if let Some(list) = self.whole.get(field) {
            return Some((list, 0));
        }
        let (key, site) = key?;
        let Column {
            numbers,
            size,
            line,
        } = self.columns.get(key)?;
        let own = numbers.get(site * size..(site + 1) * size)?;
        Some((own, *line))
    }

    /// The keys that were read.
    pub(super) fn used(&self) -> impl Iterator<Item = &str> {
        self.used.iter().map(String::as_str)
    }
}

impl Reader<'_> {
    /// Lengths, walls and cells.
    #[allow(clippy::cast_precision_loss)]
    fn whole(&mut self) {
        let torus = Space::torus(self.stated);
        let key = torus.map_or_else(|| "domain".to_owned(), ascii);
        let own = self.space.numbers(torus.is_none());
        self.fluid.whole.insert(key, own);
        let grid = self.stated.lattice.grid();
        if let (Some(grid), Some(cells)) = (grid, &self.space.cells) {
            let cells = cells.iter().map(|n| *n as f64).collect();
            self.fluid.whole.insert(ascii(&grid.index.text), cells);
        }
    }

    fn count(&self, q: &Quantity) -> usize {
        self.choice.sites_of(&self.stated.lattice, q)
    }

    fn is_grid(&self, q: &Quantity) -> bool {
        self.stated.lattice.is_grid(q.label)
    }

    fn keep(&mut self, key: &str, numbers: Vec<f64>, size: usize, value: OptionalValue<'_, '_>) {
        let line = value.map_or(0, |v| self.file.line(&v.span()));
        let column = Column {
            numbers,
            size,
            line,
        };
        self.fluid.columns.insert(key.to_owned(), column);
        self.fluid.used.insert(key.to_owned());
    }

    fn wrong(&self, key: &str, value: OptionalValue<'_, '_>, message: &str) -> Failure {
        let span = value.map(|v| v.span());
        self.file.wrong(span.as_ref(), &format!("{key}: {message}"))
    }

    /// The failure for a mistake in a part of a value.
    fn wrong_part(&self, key: &str, value: OptionalValue<'_, '_>, wrong: &Wrong) -> Failure {
        match &wrong.at {
            Some(span) => self
                .file
                .wrong(Some(span), &format!("{key}: {}", wrong.why)),
            None => self.wrong(key, value, &wrong.why),
        }
    }

    /// The positions of the particles.
    fn places(&mut self, q: &Quantity, value: OptionalValue<'_, '_>) -> Result<(), Failure> {
        let key = ascii(&q.name.text);
        let named = format!("initial.{key}");
        let Some(given) = value else {
            let message = "missing: give the particles, such as { lattice = \"brick\", jitter = 0.1 }, or expressions in the \
                index of a particle";
            return Err(self.wrong(&named, value, message));
        };
        let read = match given.get_ref() {
            own if from_npz::is_meant(own) => self.read(q, &key, given),
            DeValue::Table(table) if !names_a_file(given.get_ref()) => {
                places(table, self.space, self.count(q), &self.scope).map_err(Wrong::from)
            }
            _ => self.read(q, &key, given),
        };
        let numbers = read.map_err(|wrong| self.wrong_part(&named, value, &wrong))?;
        if let Some(why) = self.outside(&numbers) {
            return Err(self.wrong(&named, value, &why));
        }
        self.keep(&key, numbers, size(q), value);
        Ok(())
    }

    /// The first particle that starts beyond a wall. Reflections assume that a particle starts inside.
    fn outside(&self, places: &[f64]) -> Option<String> {
        const ROUNDING: f64 = 1e-12;
        let d = self.space.lengths.len();
        let sides = self.space.lengths.iter().zip(&self.space.walls).cycle();
        let mut all = places.iter().zip(sides).enumerate();
        let is_beyond = |(_, (x, (length, solid))): &(usize, (&f64, (&f64, &bool)))| {
            let inside = -ROUNDING * **length..=(1.0 + ROUNDING) * **length;
            **solid && !inside.contains(*x)
        };
        let (at, (_, (length, _))) = all.find(is_beyond)?;
        let particle = at / d;
        let place: Vec<String> = places
            .iter()
            .skip(particle * d)
            .take(d)
            .map(f64::to_string)
            .collect();
        let place = match place.as_slice() {
            [x] => x.clone(),
            all => format!("({})", all.join(", ")),
        };
        let which = match (d, at % d) {
            (1, _) => "",
            (_, 0) => " in x",
            _ => " in y",
        };
        Some(format!(
            "particle {particle} at {place} lies outside the walls 0 to {length}{which}"
        ))
    }

    /// Reads a field other than the positions of particles. A missing field is reported later, when the card is
    /// filled.
    fn beside_places(&mut self, q: &Quantity, value: OptionalValue<'_, '_>) -> Result<(), Failure> {
        let (Some(given), Some(_)) = (value, q.shape.components()) else {
            return Ok(());
        };
        let key = ascii(&q.name.text);
        let numbers = self.read(q, &key, given);
        let numbers =
            numbers.map_err(|wrong| self.wrong_part(&format!("initial.{key}"), value, &wrong))?;
        self.keep(&key, numbers, size(q), value);
        Ok(())
    }

    /// A parameter at particles or at nodes.
    #[allow(clippy::cast_precision_loss)]
    fn parameter(&mut self, q: &Quantity, value: OptionalValue<'_, '_>) -> Result<(), Failure> {
        let key = ascii(&q.name.text);
        let named = format!("parameters.{key}");
        let read = match value {
            None if self.is_grid(q) && size(q) == 1 => Ok(self.nodes.1.clone()),
            None => {
                let message = "missing: give a number, an expression in the position x, y, a list with a value for each site, \
                    or { depth = \"...\" }";
                return Err(self.wrong(&named, value, message));
            }
            Some(own) if from_npz::is_meant(own.get_ref()) => self.read(q, &key, own),
            Some(own) if let DeValue::Table(table) = own.get_ref() => match (table.get("depth"), table.get("share")) {
                (Some(depth), share)
                    if !self.is_grid(q)
                        && size(q) == 1
                        && table.len() == 1 + usize::from(share.is_some()) =>
                {
                    let depths = self.read(q, &key, depth).and_then(|all| Ok(positive(all)?));
                    let shares = self.shares(q, share.map(Spanned::get_ref));
                    depths.and_then(|all| {
                        let each = all.into_iter().zip(shares?);
                        Ok(each.map(|(depth, share)| depth * share).collect())
                    })
                }
                _ => Err(
                    "expected { depth = \"an expression of x, y\" }, and optionally share = \"cells\" for the depth times the \
                     Voronoi cell"
                        .to_owned()
                        .into(),
                ),
            },
            Some(own) => self.read(q, &key, own),
        };
        let numbers = read.map_err(|wrong| self.wrong_part(&named, value, &wrong))?;
        self.keep(&key, numbers, size(q), value);
        Ok(())
    }

    /// The part of the domain that belongs to each particle: equal parts, or its Voronoi cell.
    #[allow(clippy::cast_precision_loss)]
    fn shares(&self, q: &Quantity, given: Option<&DeValue<'_>>) -> Result<Vec<f64>, String> {
        let count = self.count(q);
        match given.map(DeValue::as_str) {
            None | Some(Some("equal")) => Ok(vec![self.space.measure() / count as f64; count]),
            Some(Some("cells")) => {
                let none = "share: Voronoi cells need particles on a torus of two dimensions";
                let own = self.stated.lattice.places().map(|p| ascii(&p.name.text));
                let own = own.and_then(|key| self.fluid.columns.get(&key));
                match (own, &self.space.lengths[..], Space::torus(self.stated)) {
                    (Some(places), [width, height], Some(_)) => {
                        cells([*width, *height], &places.numbers)
                            .map_err(|why| format!("share: {why}"))
                    }
                    _ => Err(none.to_owned()),
                }
            }
            _ => Err("share: expected \"equal\" or \"cells\"".to_owned()),
        }
    }

    /// Reads momenta or velocities. Without either, the particles start at rest. Momenta are computed from velocities
    /// later, when the card is filled.
    fn motion(&mut self, q: &Quantity, initial: Option<&DeTable<'_>>) -> Result<(), Failure> {
        let name = ascii(&q.name.text);
        for key in ["momentum", "velocity"].map(|word| format!("{word}_{name}")) {
            let value = initial.and_then(|t| t.get(key.as_str()));
            let Some(given) = value else { continue };
            let numbers = self.read(q, &key, given);
            let named = format!("initial.{key}");
            let numbers = numbers.map_err(|wrong| self.wrong_part(&named, value, &wrong))?;
            self.keep(&key, numbers, size(q), value);
        }
        Ok(())
    }
}

/// The depths, if all of them are positive.
fn positive(depths: Vec<f64>) -> Result<Vec<f64>, String> {
    match depths.iter().position(|depth| *depth <= 0.0) {
        None => Ok(depths),
        Some(site) => Err(format!(
            "the depth at particle {site} is {}, and masses must be positive: place particles where the depth is positive",
            depths[site]
        )),
    }
}

/// The areas of the Voronoi cells of particles on a torus.
fn cells(lengths: [f64; 2], places: &[f64]) -> Result<Vec<f64>, String> {
    let places = places.as_chunks::<2>().0.iter();
    let places: Vec<SVector<f64, 2>> = places.map(|x| SVector::from(*x)).collect();
    let mut mesh =
        Voronoi::new(&Domain::torus(lengths), places.len()).map_err(|e| e.to_string())?;
    let mut areas = vec![0.0; places.len()];
    mesh.update(&places).map_err(|e| e.to_string())?;
    mesh.areas(&mut areas).map_err(|e| e.to_string())?;
    Ok(areas)
}

/// How many numbers a quantity has at a site.
fn size(q: &Quantity) -> usize {
    q.shape.components().unwrap_or(1)
}
