//! The Voronoi cells of a fluid on a torus as polygons, with depth, vorticity and potential vorticity. Takes particles and
//! a sample; gives the data.

use super::fluid::{Particles, add};
use super::{Data, Part};
use clebsch::mesh::{Domain, Voronoi};
use clebsch::nalgebra::SVector;
use clebsch::record::vtk::{PolyData, Values};
use std::rc::Rc;

/// The cells of particles on a torus of two dimensions.
pub(crate) struct Cells {
    particles: Rc<Particles>,
    mesh: Voronoi<f64>,
}

impl Part for Cells {
    fn data(&mut self, row: &[f64]) -> Data {
        Data::Poly(self.polygons(row))
    }
}

impl Cells {
    pub(super) fn of(particles: &Rc<Particles>, on_torus: bool) -> Option<Self> {
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

    /// The cells of a sample with the values at their particles. Empty if particles coincide.
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
