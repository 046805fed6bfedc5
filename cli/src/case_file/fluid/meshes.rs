//! Meshes of a model in initial values: `S`, interpolated at the particles, and `slope(S, 1)`.
//! Takes an expression; gives its meshes at the initial positions of the particles, computed by the model's own
//! functionals. Reports a mesh that is undefined there.

use super::Reader;
use crate::case_file::names::Names as _;
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::value::SiteData;
use clebsch_core::lattice::{Kind, Quantity};
use clebsch_interpret::{AtParticles, Placed, Unvalued, at_particles};
use std::rc::Rc;

/// The meshes in an expression, by the names in its text.
pub(super) struct Meshes {
    each: Vec<(String, Rc<AtParticles>)>,
    /// How many directions the domain has.
    directions: usize,
}

impl Meshes {
    fn of(&self, name: &str) -> Option<&AtParticles> {
        let own = self.each.iter().find(|(own, _)| own == name);
        own.map(|(_, at)| &**at)
    }

    /// The value of a mesh at a particle.
    pub(super) fn value(&self, name: &str, site: usize) -> Option<f64> {
        self.of(name)?.values.get(site).copied()
    }

    /// The slope of a mesh along a direction, counted from 1, at a particle.
    pub(super) fn slope(&self, name: &str, along: u64, site: usize) -> Option<f64> {
        let slopes = self.of(name)?.slopes.as_ref()?;
        let d = usize::try_from(along).ok()?.checked_sub(1)?;
        let own = slopes.get(site * self.directions..(site + 1) * self.directions)?;
        own.get(d).copied()
    }
}

impl Reader<'_> {
    /// The numbers that the case gives for a name of the model: at all sites, of the domain, or a single one.
    pub(super) fn given(&self, name: &str) -> Option<Vec<f64>> {
        let key = ascii(name);
        let column = self.fluid.columns.get(&key).map(|c| c.numbers.clone());
        let whole = || self.fluid.whole.get(&key).cloned();
        let number = || self.scope.number(&key).map(|x| vec![x]);
        column.or_else(whole).or_else(number)
    }

    /// The meshes in an expression, if they are allowed there.
    pub(super) fn meshes_in(&self, q: &Quantity, data: &SiteData) -> Result<Meshes, String> {
        let directions = self.space.lengths.len();
        for (name, along) in data.slopes()? {
            let mesh = self.mesh(&name).ok_or_else(|| self.is_none(&name))?;
            if !self.stands_on_grid(mesh) {
                return Err(format!(
                    "slope({name}, {along}): `{name}` has values only at the particles; slopes exist for meshes on a grid{}",
                    self.on_grid()
                ));
            }
            if along == 0 || along > directions as u64 {
                let known = match directions {
                    1 => "has one direction: write 1",
                    _ => "has two directions: write 1 or 2",
                };
                return Err(format!("slope({name}, {along}): the domain {known}"));
            }
        }
        let mut each = Vec::new();
        for name in data.names() {
            // A name that already has a value keeps this value.
            if let Some(mesh) = self.mesh(&name)
                && self.number(q, &name, 0).is_none()
            {
                let at = self.at_start(q, &name, mesh)?;
                each.push((name, at));
            }
        }
        Ok(Meshes { each, directions })
    }

    /// The number of a mesh, by its name as the model or as a case writes it.
    fn mesh(&self, name: &str) -> Option<usize> {
        let mut all = self.stated.lattice.meshes.iter();
        all.position(|m| m.name.text == name || ascii(&m.name.text) == name)
    }

    fn stands_on_grid(&self, mesh: usize) -> bool {
        let lattice = &self.stated.lattice;
        let own = lattice.meshes.get(mesh).map(|m| m.name.text.as_str());
        let own = own.and_then(|name| lattice.find(name));
        own.is_some_and(|q| self.is_grid(q))
    }

    /// The names of the meshes whose slopes are defined, for messages.
    fn on_grid(&self) -> String {
        let all = self.stated.lattice.meshes.iter().enumerate();
        let own = all.filter(|(at, _)| self.stands_on_grid(*at));
        let names: Vec<String> = own
            .map(|(_, m)| format!("`{}`", ascii(&m.name.text)))
            .collect();
        match names.as_slice() {
            [] => ", and the model has none".to_owned(),
            names => format!(", of which the model has {}", names.join(", ")),
        }
    }

    fn is_none(&self, name: &str) -> String {
        format!(
            "slope({name}, ...): `{name}` is not a mesh of the model; slopes exist for meshes on a grid{}",
            self.on_grid()
        )
    }

    /// A mesh at the initial positions of the particles, for a value of a quantity.
    fn at_start(&self, q: &Quantity, name: &str, mesh: usize) -> Result<Rc<AtParticles>, String> {
        let lattice = &self.stated.lattice;
        let Some(places) = lattice.places() else {
            return Err(format!(
                "`{name}` depends on positions, and the model has none"
            ));
        };
        let of = ascii(&places.name.text);
        let instead = || self.instead(name, &of, mesh);
        if q.kind == Kind::Parameter {
            return Err(format!(
                "`{name}` is a mesh, whose values depend on the parameters and the positions {of}: {}",
                instead()
            ));
        }
        let Some(at) = self.fluid.columns.get(&of) else {
            return Err(format!(
                "`{name}` depends on the positions {of}, which this entry defines: write {of} as a lattice, or in terms of the \
                 index of a particle; {}",
                instead()
            ));
        };
        if q.label != places.label {
            let labels = &lattice.labels;
            let index = |label: usize| labels.get(label).map_or("", |l| l.index.text.as_str());
            return Err(format!(
                "`{name}` has values at the particles `{}`, but the values of {} belong to `{}`: {}",
                index(places.label),
                ascii(&q.name.text),
                index(q.label),
                instead()
            ));
        }
        if let Some(known) = self.meshes.borrow().get(&mesh) {
            return Ok(known.clone());
        }
        let placed = Placed {
            lengths: &self.space.lengths,
            walls: &self.space.walls,
            cells: self.space.cells.as_deref(),
            at: &at.numbers,
        };
        let found = at_particles(lattice, mesh, &placed, &|name| self.given(name));
        let found = found.map_err(|why| match why {
            Unvalued::Missing(of) => {
                let key = ascii(&of);
                format!(
                    "`{name}` needs {key}: missing key `parameters.{key}`, or not a finite number there"
                )
            }
            other => format!("`{name}` has no value at these positions: {other}"),
        })?;
        let found = Rc::new(found);
        self.meshes.borrow_mut().insert(mesh, found.clone());
        Ok(found)
    }

    /// The message that states where a mesh may be used.
    fn instead(&self, name: &str, of: &str, mesh: usize) -> String {
        let example = match (self.stands_on_grid(mesh), self.space.lengths.len()) {
            (false, 1) => format!("\"{name}\""),
            (false, _) => format!("[\"{name}\", 0.0]"),
            (true, 1) => format!("\"-slope({name}, 1)\""),
            (true, _) => format!("[\"-slope({name}, 2)\", \"slope({name}, 1)\"]"),
        };
        format!(
            "write it in velocities and momenta of {of} in [initial], as in velocity_{of} = {example}"
        )
    }
}
