//! Fluids: particles, the cells of their Voronoi mesh on a torus, the nodes of a grid. Takes a card and a plan; gives a
//! part for each.

use super::columns::{Columns, in_space};
use super::kinematics::{Kinematics, Motion};
use super::{Data, Part};
use crate::case_file::labels::Stated;
use crate::case_file::space::Space;
use crate::output::sites::{AtSites, at_sites};
use crate::plan::Plan;
use crate::plots::particles::space;
use clebsch::card::Card;
use clebsch::mesh::{Domain, Voronoi};
use clebsch::nalgebra::SVector;
use clebsch::record::vtk::{ImageData, PolyData, Values};
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::Kind;
use std::ops::Range;
use std::rc::Rc;

/// Particles in their domain.
struct Particles {
    space: Space,
    /// The columns of the place of each, and of its momentum.
    places: Vec<Range<usize>>,
    momenta: Vec<Range<usize>>,
    kinematics: Option<Kinematics>,
    /// Quantities at particles.
    columns: Vec<Columns>,
    /// What does not change.
    constant: Vec<Values>,
}

struct Dots(Rc<Particles>);

/// The cells of particles on a torus of two dimensions.
pub(crate) struct Cells {
    particles: Rc<Particles>,
    mesh: Voronoi<f64>,
}

struct Grid {
    origin: [f64; 3],
    spacing: [f64; 3],
    nodes: [usize; 3],
    /// Which node of the model stands at each of the image.
    order: Vec<usize>,
    columns: Vec<Columns>,
}

/// The cells of a fluid, if it has any.
pub(crate) fn cells(card: &Card, plan: &Plan) -> Option<Cells> {
    let (space, stated) = space(card, plan)?;
    let on_torus = Space::torus(&stated).is_some();
    let particles = particles((card, plan), &at_sites(card), space, &stated)?;
    Cells::of(&Rc::new(particles), on_torus)
}

/// The particles of a fluid with what stands at them.
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

/// Where a quantity stands in a row, at each of its sites.
fn columns(q: &AtSites<'_>) -> Vec<Range<usize>> {
    q.members.iter().map(|(_, c)| c.clone()).collect()
}

fn at(q: &AtSites<'_>) -> Columns {
    let at = columns(q).into_iter().map(Some).collect();
    Columns::of(&q.key, q.field, at)
}

/// The parts of a fluid; none of other models.
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

/// The grid of a domain with what stands at its nodes.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss
)]
fn grid(space: &Space, columns: Vec<Columns>) -> Option<Grid> {
    let cells = space.cells.as_ref()?;
    let (places, _) = space.nodes().ok()?;
    let mut spacing = [1.0; 3];
    let mut nodes = [1; 3];
    for (d, (length, n)) in space.lengths.iter().zip(cells).enumerate() {
        *spacing.get_mut(d)? = length / *n as f64;
        // Of a periodic direction the first node once more, at the seam.
        *nodes.get_mut(d)? = n + 1;
    }
    let mut order = vec![None; nodes.iter().product()];
    for (number, place) in places.iter().enumerate() {
        let each = place.iter().zip(&spacing).zip(&space.walls).zip(&nodes);
        let each = each.map(|(((x, by), wall), n)| {
            let at = (x / by).round() as usize;
            match !wall && at == 0 {
                true => vec![0, n - 1],
                false => vec![at],
            }
        });
        let mut each = each.collect::<Vec<_>>().into_iter();
        let (first, second) = (each.next()?, each.next().unwrap_or_else(|| vec![0]));
        for j in &second {
            for i in &first {
                *order.get_mut(j * nodes[0] + i)? = Some(number);
            }
        }
    }
    Some(Grid {
        origin: [0.0; 3],
        spacing,
        nodes,
        order: order.into_iter().collect::<Option<_>>()?,
        columns,
    })
}

impl Particles {
    /// Numbers of all particles, one after the other.
    fn numbers(columns: &[Range<usize>], row: &[f64]) -> Vec<f64> {
        let each = columns
            .iter()
            .flat_map(|c| row.get(c.clone()).unwrap_or_default());
        each.copied().collect()
    }

    /// Where a particle is, within the domain.
    fn within(&self, place: &[f64]) -> Vec<f64> {
        let each = place.iter().zip(&self.space.lengths).zip(&self.space.walls);
        each.map(|((x, length), wall)| if *wall { *x } else { x.rem_euclid(*length) })
            .collect()
    }

    fn motion(&self, row: &[f64]) -> Option<Motion> {
        let places = Self::numbers(&self.places, row);
        let momenta = Self::numbers(&self.momenta, row);
        self.kinematics.as_ref()?.motion(&places, &momenta)
    }

    /// What stands at particles, with their velocities.
    fn values(&self, row: &[f64], motion: Option<&Motion>) -> Vec<Values> {
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

/// Adds values, unless the model has some by the same name.
fn add(out: &mut Vec<Values>, values: Values) {
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

/// The letter of the index of a grid.
fn grid_index(stated: &Stated) -> Option<String> {
    Some(stated.lattice.grid()?.index.text.clone())
}

impl Part for Cells {
    fn data(&mut self, row: &[f64]) -> Data {
        Data::Poly(self.polygons(row))
    }
}

impl Cells {
    fn of(particles: &Rc<Particles>, on_torus: bool) -> Option<Self> {
        let [width, height] = *particles.space.lengths.as_slice() else {
            return None;
        };
        let domain = Domain::torus([width, height]);
        let mesh = Voronoi::new(&domain, particles.places.len()).ok()?;
        on_torus.then(|| Cells {
            particles: Rc::clone(particles),
            mesh,
        })
    }

    /// The cells of a sample, with what stands at their particles; none where particles coincide.
    pub(crate) fn polygons(&mut self, row: &[f64]) -> PolyData {
        let own = &self.particles;
        let places: Vec<SVector<f64, 2>> = own
            .places
            .iter()
            .filter_map(|c| match row.get(c.clone())? {
                [x, y] => Some(SVector::<f64, 2>::new(*x, *y)),
                _ => None,
            })
            .collect();
        let mut data = PolyData::default();
        let count = places.len();
        let mut areas = vec![0.0; count];
        if self.mesh.update(&places).is_err() || self.mesh.areas(&mut areas).is_err() {
            return data;
        }
        self.mesh.polygons(|site, corners| {
            let centre = places.get(site).map(|x| own.within(x.as_slice()));
            let [x, y] = centre.as_deref().map_or([0.0; 2], |c| match *c {
                [x, y] => [x, y],
                _ => [0.0; 2],
            });
            let first = data.points.len() as u64;
            data.polygons
                .push((first..first + corners.len() as u64).collect());
            data.points
                .extend(corners.iter().map(|c| [x + c[0], y + c[1], 0.0]));
        });
        let motion = own.motion(row);
        let mut values = own.values(row, motion.as_ref());
        let depth = motion
            .as_ref()
            .and_then(|m| m.masses.as_ref())
            .map(|masses| {
                let each = masses.iter().zip(&areas);
                each.map(|(m, a)| m / a).collect::<Vec<f64>>()
            });
        if let Some(motion) = &motion {
            let velocities: Vec<SVector<f64, 2>> = motion
                .velocities
                .as_chunks::<2>()
                .0
                .iter()
                .map(|[u, v]| SVector::<f64, 2>::new(*u, *v))
                .collect();
            let mut vorticity = vec![0.0; count];
            if self.mesh.curl(&velocities, &mut vorticity).is_ok() {
                let both = motion.rotations.as_ref().zip(depth.as_ref());
                let potential = both.map(|(f, h)| {
                    let each = vorticity.iter().zip(f).zip(h);
                    each.map(|((zeta, f), h)| (zeta + f) / h).collect()
                });
                add(&mut values, Values::numbers("vorticity", vorticity));
                if let Some(potential) = potential {
                    add(
                        &mut values,
                        Values::numbers("potential_vorticity", potential),
                    );
                }
            }
        }
        if let Some(depth) = depth {
            add(&mut values, Values::numbers("depth", depth));
        }
        add(&mut values, Values::numbers("area", areas));
        data.cell_data = values;
        data
    }
}

impl Part for Grid {
    fn ending(&self) -> &'static str {
        "vti"
    }

    fn data(&mut self, row: &[f64]) -> Data {
        let reordered = |values: Values| {
            let n = values.components;
            let at = |node: &usize| values.numbers.get(node * n..(node + 1) * n);
            let numbers = self.order.iter().filter_map(at).flatten().copied();
            Values {
                numbers: numbers.collect(),
                ..values
            }
        };
        let values = self.columns.iter().flat_map(|c| c.values(row));
        Data::Image(ImageData {
            origin: self.origin,
            spacing: self.spacing,
            nodes: self.nodes,
            point_data: values.map(reordered).collect(),
        })
    }
}
