//! Fluids: particles, the cells of their Voronoi mesh on a torus, the nodes of a grid. Takes a card and a plan; gives
//! a part for each kind of object.

use super::cells::Cells;
use super::columns::{Columns, in_space};
use super::grid::grid;
use super::kinematics::{Kinematics, Motion};
use super::{Data, Part};
use crate::case_file::space::Space;
use crate::case_file::stated::Stated;
use crate::output::fluid::space;
use crate::output::sites::{AtSites, at_sites};
use crate::plan::Plan;
use clebsch::card::Card;
use clebsch::record::vtk::{PolyData, Values};
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::Kind;
use std::ops::Range;
use std::rc::Rc;

/// Particles in their domain.
pub(super) struct Particles {
    pub(super) space: Space,
    /// The columns of the position of each particle, and of its momentum.
    pub(super) places: Vec<Range<usize>>,
    momenta: Vec<Range<usize>>,
    kinematics: Option<Kinematics>,
    /// Quantities at particles.
    columns: Vec<Columns>,
    /// Values that do not change during the run.
    constant: Vec<Values>,
}

struct Dots(Rc<Particles>);

/// The cells of a fluid, if it has any.
pub(crate) fn cells(card: &Card, plan: &Plan) -> Option<Cells> {
    let (space, stated) = space(card, plan)?;
    let on_torus = Space::torus(&stated).is_some();
    let particles = particles((card, plan), &at_sites(card), space, &stated)?;
    Cells::of(&Rc::new(particles), on_torus)
}

/// The particles of a fluid with their values.
fn particles(
    (card, plan): (&Card, &Plan),
    all: &[AtSites<'_>],
    space: Space,
    stated: &Stated,
) -> Option<Particles> {
    let own = stated.lattice.places()?;
    let find = |key: &str| all.iter().find(|q| q.key == key);
    let key = ascii(&own.name.text);
    let places = find(&key)?;
    let momenta = find(&format!("momentum_{key}"));
    let size = space.lengths.len();
    let kinematics = Kinematics::of((card, plan), &own.name.text, size, &space.lengths);
    let here = all
        .iter()
        .filter(|q| q.index == places.index && q.key != key);
    let given = stated.lattice.quantities.iter();
    let given = given.filter(|q| q.kind == Kind::Parameter && q.label == own.label);
    let constant = given.filter_map(|q| {
        let name = ascii(&q.name.text);
        let values = kinematics.as_ref()?.parameter(&name)?;
        (values.len() == places.members.len()).then(|| Values::numbers(&name, values.clone()))
    });
    let own = Particles {
        places: columns(places),
        momenta: momenta.map_or_else(Vec::new, columns),
        columns: here.map(at).collect(),
        constant: constant.collect(),
        kinematics,
        space,
    };
    Some(own)
}

/// The columns of a quantity in a row, for each of its sites.
fn columns(q: &AtSites<'_>) -> Vec<Range<usize>> {
    q.members.iter().map(|(_, c)| c.clone()).collect()
}

fn at(q: &AtSites<'_>) -> Columns {
    let at = columns(q).into_iter().map(Some).collect();
    Columns::of(&q.key, q.field, at)
}

/// The parts of a fluid; empty for other models.
pub(super) fn parts(card: &Card, plan: &Plan) -> Vec<(String, Box<dyn Part>)> {
    let mut out: Vec<(String, Box<dyn Part>)> = Vec::new();
    let Some((space, stated)) = space(card, plan) else {
        return out;
    };
    let all = at_sites(card);
    let Some(particles) = particles((card, plan), &all, space, &stated) else {
        return out;
    };
    let particles = Rc::new(particles);
    if let Some(cells) = Cells::of(&particles, Space::torus(&stated).is_some()) {
        out.push(("cells".to_owned(), Box::new(cells)));
    }
    let space = &particles.space;
    let on_grid = all
        .iter()
        .filter(|q| !q.on_line && Some(&q.index) == grid_index(&stated).as_ref())
        .map(at);
    if let Some(grid) = grid(space, on_grid.collect()) {
        out.push(("grid".to_owned(), Box::new(grid)));
    }
    out.push(("particles".to_owned(), Box::new(Dots(particles))));
    out
}

impl Particles {
    /// The numbers of all particles, concatenated.
    fn numbers(columns: &[Range<usize>], row: &[f64]) -> Vec<f64> {
        let each = columns
            .iter()
            .flat_map(|c| row.get(c.clone()).unwrap_or_default());
        each.copied().collect()
    }

    /// The position of a particle within the domain.
    pub(super) fn within(&self, place: &[f64]) -> Vec<f64> {
        let each = place.iter().zip(&self.space.lengths).zip(&self.space.walls);
        each.map(|((x, length), wall)| if *wall { *x } else { x.rem_euclid(*length) })
            .collect()
    }

    pub(super) fn motion(&self, row: &[f64]) -> Option<Motion> {
        let places = Self::numbers(&self.places, row);
        let momenta = Self::numbers(&self.momenta, row);
        self.kinematics.as_ref()?.motion(&places, &momenta)
    }

    /// The values at particles, including their velocities.
    pub(super) fn values(&self, row: &[f64], motion: Option<&Motion>) -> Vec<Values> {
        let mut out: Vec<Values> = self.columns.iter().flat_map(|c| c.values(row)).collect();
        out.extend(self.constant.iter().cloned());
        if let Some(motion) = motion {
            let size = self.space.lengths.len();
            let each = motion.velocities.chunks(size).map(in_space);
            add(
                &mut out,
                Values::vectors("velocity", &each.collect::<Vec<_>>()),
            );
        }
        out
    }
}

/// Adds values, unless the model has values with the same name.
pub(super) fn add(out: &mut Vec<Values>, values: Values) {
    if out.iter().all(|own| own.name != values.name) {
        out.push(values);
    }
}

impl Part for Dots {
    fn data(&mut self, row: &[f64]) -> Data {
        let own = &self.0;
        let places = own
            .places
            .iter()
            .map(|c| row.get(c.clone()).unwrap_or_default());
        let places = places.map(|x| in_space(&own.within(x)));
        let mut data = PolyData::of_points(places.collect());
        data.point_data = own.values(row, own.motion(row).as_ref());
        Data::Poly(data)
    }
}

/// The label of the index of a grid.
fn grid_index(stated: &Stated) -> Option<String> {
    Some(stated.lattice.grid()?.index.text.clone())
}
