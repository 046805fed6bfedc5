//! Values of a fluid at its particles and nodes: places on a lattice, depths, velocities, expressions of the place.
//! Takes a case; gives the numbers of every quantity at all of its sites.

use super::labels::{Stated, table};
use super::location::File;
use super::sites;
use super::space::Space;
use super::start::places;
use super::value::number;
use crate::failure::Failure;
use clebsch::card::Field;
use clebsch::line::LineError;
use clebsch::mesh::{Domain, Voronoi};
use clebsch::nalgebra::SVector;
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::value::SiteData;
use clebsch_core::lattice::{Choice, Kind, Quantity};
use clebsch_interpret::lines::{LineModel, Unstarted};
use std::collections::BTreeMap;
use std::collections::HashSet;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The numbers of one quantity.
#[derive(Clone, Debug)]
pub(super) struct Column {
    numbers: Vec<f64>,
    /// How many there are at a site.
    size: usize,
    /// The line of the file that they came from.
    line: usize,
}

/// All of them.
#[derive(Clone, Debug, Default)]
pub(super) struct Fluid {
    columns: BTreeMap<String, Column>,
    /// What belongs to no site, by name.
    whole: BTreeMap<String, Vec<f64>>,
    /// Keys that were read.
    used: HashSet<String>,
}

/// How values at sites are read.
struct Reader<'a> {
    file: &'a File<'a>,
    stated: &'a Stated,
    choice: &'a Choice,
    space: &'a Space,
    numbers: Vec<(String, f64)>,
    /// Where the nodes of the grid are, and their weights.
    nodes: (Vec<Vec<f64>>, Vec<f64>),
    fluid: Fluid,
}

type Given<'a, 'i> = Option<&'a Spanned<DeValue<'i>>>;

impl Fluid {
    /// That of a case; nothing for models that are no fluids.
    pub(super) fn read(
        file: &File<'_>,
        top: &DeTable<'_>,
        stated: &Stated,
        choice: &Choice,
        source: &str,
    ) -> Result<Option<Fluid>, Failure> {
        let Some(space) = Space::read(file, top, stated)? else {
            return Ok(None);
        };
        let parameters = table(file, top, "parameters")?;
        let initial = table(file, top, "initial")?;
        let nodes = match &space.cells {
            Some(_) => space.nodes().map_err(|why| file.wrong(None, &why))?,
            None => Default::default(),
        };
        let mut reader = Reader {
            file,
            stated,
            choice,
            space: &space,
            numbers: sites::numbers(top, parameters),
            nodes,
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
        for q in quantities.iter().filter(|q| q.kind == Kind::Configuration) {
            reader.motion(q, initial, source)?;
        }
        Ok(Some(reader.fluid))
    }

    /// The numbers of a field of the card, and the line that they came from, where they need no reading: finite ones of a number
    /// or a vector.
    pub(super) fn numbers(
        &self,
        field: &Field,
        key: Option<(&str, usize)>,
    ) -> Option<(&[f64], usize)> {
        let (key, site) = key?;
        let column = self.columns.get(key)?;
        let plain = field.cols == 1 && field.rows == column.size;
        let own = column
            .numbers
            .get(site * column.size..(site + 1) * column.size)?;
        (plain && own.iter().all(|x| x.is_finite())).then_some((own, column.line))
    }

    /// The value of a field of the card, and the line that it came from.
    pub(super) fn text(&self, field: &str, key: Option<(&str, usize)>) -> Option<(String, usize)> {
        if let Some(list) = self.whole.get(field) {
            return Some((spelt(list), 0));
        }
        let (key, site) = key?;
        let column = self.columns.get(key)?;
        let own = column
            .numbers
            .get(site * column.size..(site + 1) * column.size)?;
        Some((spelt(own), column.line))
    }

    /// The keys that were read.
    pub(super) fn used(&self) -> impl Iterator<Item = &str> {
        self.used.iter().map(String::as_str)
    }
}

/// Numbers as TOML reads them back.
fn spelt(list: &[f64]) -> String {
    let one = |x: &f64| match *x {
        v if v.is_nan() => "nan".to_owned(),
        v if v.is_infinite() => if v > 0.0 { "inf" } else { "-inf" }.to_owned(),
        v => format!("{v:?}"),
    };
    match list {
        [x] => one(x),
        all => format!("[{}]", all.iter().map(one).collect::<Vec<_>>().join(", ")),
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

    /// The value of a name at a site.
    #[allow(clippy::cast_precision_loss)]
    fn number(&self, q: &Quantity, name: &str, site: usize) -> Option<f64> {
        let lattice = &self.stated.lattice;
        if let Some(l) = lattice.labels.get(q.label) {
            if l.index.text == name {
                return Some(site as f64);
            }
            if !l.grid && l.count.text == name {
                return Some(self.count(q) as f64);
            }
        }
        let lengths = &self.space.lengths;
        let even = lengths.iter().all(|l| Some(l) == lengths.first());
        let torus = Space::torus(self.stated).unwrap_or("L");
        match name {
            "x" | "y" => self.coordinate(q, usize::from(name == "y"), site),
            "Lx" => lengths.first().copied(),
            "Ly" => lengths.get(1).copied(),
            _ if name == torus && even => lengths.first().copied(),
            _ => {
                let known = self.numbers.iter().find(|(own, _)| own == name);
                known.map(|(_, x)| *x).or_else(|| {
                    let own = lattice
                        .quantities
                        .iter()
                        .find(|o| ascii(&o.name.text) == name)?;
                    let column = self.fluid.columns.get(name)?;
                    let fits = own.label == q.label && column.size == 1;
                    column.numbers.get(site).copied().filter(|_| fits)
                })
            }
        }
    }

    /// A coordinate of a particle or a node.
    fn coordinate(&self, q: &Quantity, d: usize, site: usize) -> Option<f64> {
        if self.is_grid(q) {
            return self.nodes.0.get(site)?.get(d).copied();
        }
        let own = self.stated.lattice.places()?;
        let column = self.fluid.columns.get(&ascii(&own.name.text))?;
        let all = column
            .numbers
            .get(site * column.size..(site + 1) * column.size)?;
        all.get(d).copied()
    }

    /// Numbers, expressions, a list of either for each component, or a list with an element for each site.
    fn read(&self, q: &Quantity, value: &DeValue<'_>) -> Result<Vec<f64>, String> {
        let (size, count) = (size(q), self.count(q));
        let list = match value {
            DeValue::Array(list) => list,
            single if size == 1 => return self.component(q, single),
            _ => {
                return Err(format!(
                    "expected {size} numbers or expressions, or a list with such for each site"
                ));
            }
        };
        let nested = list.iter().any(|v| v.get_ref().is_array());
        if !nested && size > 1 && list.len() == size {
            let each = list.iter().map(|v| self.component(q, v.get_ref()));
            let each: Vec<Vec<f64>> = each.collect::<Result<_, _>>()?;
            let at = |site: usize| each.iter().filter_map(move |c| c.get(site).copied());
            return Ok((0..count).flat_map(at).collect());
        }
        if list.len() != count {
            return Err(format!(
                "a list has a value for each of the {count} sites, and this one has {}",
                list.len()
            ));
        }
        let mut out = Vec::with_capacity(count * size);
        for (site, one) in list.iter().enumerate() {
            let own = match one.get_ref() {
                DeValue::Array(own) => own.iter().map(Spanned::get_ref).collect(),
                single => vec![single],
            };
            if own.len() != size {
                return Err(format!(
                    "site {site} has {} numbers, where {size} are taken",
                    own.len()
                ));
            }
            for value in own {
                out.push(self.at(q, value, site)?);
            }
        }
        Ok(out)
    }

    /// One number or expression, at all sites.
    fn component(&self, q: &Quantity, value: &DeValue<'_>) -> Result<Vec<f64>, String> {
        let DeValue::String(text) = value else {
            return Ok(vec![number(value)?; self.count(q)]);
        };
        let told = |why: String| format!("\"{text}\": {why}");
        let data = SiteData::read(text).map_err(told)?;
        let each = (0..self.count(q)).map(|site| {
            let value = data.value(&|name| self.number(q, name, site))?;
            finite(value, site)
        });
        each.collect::<Result<_, _>>().map_err(told)
    }

    fn at(&self, q: &Quantity, value: &DeValue<'_>, site: usize) -> Result<f64, String> {
        let DeValue::String(text) = value else {
            return number(value);
        };
        let value = SiteData::read(text).and_then(|d| d.value(&|name| self.number(q, name, site)));
        let value = value.and_then(|value| finite(value, site));
        value.map_err(|why| format!("\"{text}\": {why}"))
    }

    fn keep(&mut self, key: &str, numbers: Vec<f64>, size: usize, value: Given<'_, '_>) {
        let line = value.map_or(0, |v| self.file.line(&v.span()));
        let column = Column {
            numbers,
            size,
            line,
        };
        self.fluid.columns.insert(key.to_owned(), column);
        self.fluid.used.insert(key.to_owned());
    }

    fn wrong(&self, key: &str, value: Given<'_, '_>, message: &str) -> Failure {
        let span = value.map(|v| v.span());
        self.file.wrong(span.as_ref(), &format!("{key}: {message}"))
    }

    /// Where particles are.
    fn places(&mut self, q: &Quantity, value: Given<'_, '_>) -> Result<(), Failure> {
        let key = ascii(&q.name.text);
        let named = format!("initial.{key}");
        let Some(given) = value else {
            let message = "missing: where particles are, such as { lattice = \"brick\", jitter = 0.1 }, or \
                           expressions in the index of a particle";
            return Err(self.wrong(&named, value, message));
        };
        let read = match given.get_ref() {
            DeValue::Table(table) => places(table, self.space, self.count(q)),
            own => self.read(q, own),
        };
        let numbers = read.map_err(|why| self.wrong(&named, value, &why))?;
        self.keep(&key, numbers, size(q), value);
        Ok(())
    }

    /// A parameter at particles or at nodes.
    #[allow(clippy::cast_precision_loss)]
    fn parameter(&mut self, q: &Quantity, value: Given<'_, '_>) -> Result<(), Failure> {
        let key = ascii(&q.name.text);
        let named = format!("parameters.{key}");
        let read = match value.map(Spanned::get_ref) {
            None if self.is_grid(q) && size(q) == 1 => Ok(self.nodes.1.clone()),
            None => {
                let message = "missing: a number, an expression of the place x, y, a list with a value for each \
                               site, or { depth = \"...\" }";
                return Err(self.wrong(&named, value, message));
            }
            Some(DeValue::Table(table)) => match (table.get("depth"), table.get("share")) {
                (Some(depth), share)
                    if !self.is_grid(q)
                        && size(q) == 1
                        && table.len() == 1 + usize::from(share.is_some()) =>
                {
                    let depths = self.read(q, depth.get_ref()).and_then(positive);
                    let shares = self.shares(q, share.map(Spanned::get_ref));
                    depths.and_then(|all| {
                        let each = all.into_iter().zip(shares?);
                        Ok(each.map(|(depth, share)| depth * share).collect())
                    })
                }
                _ => Err(
                    "expected { depth = \"an expression of x, y\" }, for a particle's share of it, \
                     and share = \"cells\" beside it for that of its Voronoi cell"
                        .to_owned(),
                ),
            },
            Some(own) => self.read(q, own),
        };
        let numbers = read.map_err(|why| self.wrong(&named, value, &why))?;
        self.keep(&key, numbers, size(q), value);
        Ok(())
    }

    /// The part of the domain that each particle has: the same for all, or its Voronoi cell.
    #[allow(clippy::cast_precision_loss)]
    fn shares(&self, q: &Quantity, given: Option<&DeValue<'_>>) -> Result<Vec<f64>, String> {
        let count = self.count(q);
        match given.map(DeValue::as_str) {
            None | Some(Some("equal")) => Ok(vec![self.space.measure() / count as f64; count]),
            Some(Some("cells")) => {
                let none =
                    "share: Voronoi cells are those of particles on a torus of two dimensions";
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

    /// Momenta, given or by their velocities.
    fn motion(
        &mut self,
        q: &Quantity,
        initial: Option<&DeTable<'_>>,
        source: &str,
    ) -> Result<(), Failure> {
        let name = ascii(&q.name.text);
        let [momentum, velocity] = ["momentum", "velocity"].map(|w| format!("{w}_{name}"));
        let get = |key: &str| initial.and_then(|t| t.get(key));
        let (p, v) = (get(&momentum), get(&velocity));
        let (key, value) = match (p, v) {
            (Some(_), None) => (&momentum, p),
            (None, Some(_)) => (&velocity, v),
            (Some(_), Some(_)) => {
                let message = format!("is given beside {velocity}: give one of them");
                return Err(self.wrong(&format!("initial.{momentum}"), p, &message));
            }
            (None, None) => {
                let message =
                    format!("missing: give it, or {velocity}, in expressions of the place x, y");
                return Err(self.wrong(&format!("initial.{momentum}"), None, &message));
            }
        };
        let Some(given) = value else { return Ok(()) };
        let named = format!("initial.{key}");
        let numbers = self.read(q, given.get_ref());
        let mut numbers = numbers.map_err(|why| self.wrong(&named, value, &why))?;
        if v.is_some() {
            let own = self.of_velocities(q, &numbers, source);
            numbers = own.map_err(|why| match why {
                Untold::Parameter(why) => self.wrong("parameters", None, &why),
                Untold::Velocity(why) => self.wrong(&named, value, &why),
            })?;
            self.fluid.used.insert(velocity);
        }
        self.keep(&momentum, numbers, size(q), value);
        Ok(())
    }

    /// The momenta that the model gives to velocities.
    fn of_velocities(
        &self,
        q: &Quantity,
        velocities: &[f64],
        source: &str,
    ) -> Result<Vec<f64>, Untold> {
        let model = LineModel::read(source).map_err(|e| Untold::Velocity(e.to_string()))?;
        let given = |name: &str| {
            let key = ascii(name);
            let column = self.fluid.columns.get(&key).map(|c| c.numbers.clone());
            let whole = || self.fluid.whole.get(&key).cloned();
            let number = || {
                let known = self.numbers.iter().find(|(own, _)| *own == key);
                known.map(|(_, x)| vec![*x])
            };
            column.or_else(whole).or_else(number)
        };
        let found = model.momenta(self.choice, &given, &q.name.text, velocities);
        let found = found.map_err(|e| match e {
            Unstarted::Missing(name) => {
                let key = ascii(&name);
                Untold::Parameter(format!(
                    "missing key `parameters.{key}`, or no finite number there: the momenta of velocities take it"
                ))
            }
            Unstarted::Line(LineError::Parameter(e)) => Untold::Parameter(e.to_string()),
            other => Untold::Velocity(other.to_string()),
        })?;
        found.ok_or_else(|| {
            let message = "the model does not tell the momenta of velocities: give momenta";
            Untold::Velocity(message.to_owned())
        })
    }
}

/// A value of an expression at a site, if it is a number.
fn finite(value: f64, site: usize) -> Result<f64, String> {
    match value.is_finite() {
        true => Ok(value),
        false => Err(format!("{value} at site {site} is not a finite number")),
    }
}

/// Depths, if all of them are some.
fn positive(depths: Vec<f64>) -> Result<Vec<f64>, String> {
    match depths.iter().position(|depth| *depth <= 0.0) {
        None => Ok(depths),
        Some(site) => Err(format!(
            "the depth at particle {site} is {}, and a particle carries a positive share of it: place particles where the depth is positive",
            depths[site]
        )),
    }
}

/// Why velocities have no momenta.
enum Untold {
    /// A parameter is missing or not admissible.
    Parameter(String),
    /// The velocities are not, or the model does not say.
    Velocity(String),
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
