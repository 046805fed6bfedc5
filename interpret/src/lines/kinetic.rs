//! Checks whether the kinetic energy of the particles of a fluid is positive at the start of a run. Takes the
//! momenta as functions of velocities; gives the same warning as for other models, summed over particles.

use super::{LineModel, Numbers};
use clebsch::kinetic::KineticWarning;
use clebsch_core::lattice::ChainConfig;

impl LineModel {
    /// A warning if the kinetic energy is not positive. Returns nothing if the model is not a fluid, or does not define
    /// momenta of given velocities. `sites` returns the number of sites of a field.
    pub(super) fn kinetic_warning(
        &self,
        choice: &ChainConfig,
        numbers: &Numbers<'_>,
        sites: impl Fn(&str) -> Option<usize>,
    ) -> Option<KineticWarning> {
        // In other models, neighbours may share a kinetic energy.
        self.space().next()?;
        let (name, _) = self.momenta.first()?;
        let field = name.strip_prefix("momenta_of_")?;
        let count = sites(field).filter(|n| *n > 0)?;
        let size = numbers(field)?.len() / count;
        let momenta = |velocities: &[f64]| {
            let found = self.momenta(choice, numbers, field, velocities);
            found.ok().flatten().filter(|p| p.len() == count * size)
        };
        // A vector potential adds a term that does not depend on velocities.
        let at_rest = momenta(&vec![0.0; count * size])?;
        let along = |d: usize| {
            let unit: Vec<f64> = (0..count * size)
                .map(|i| if i % size == d { 1.0 } else { 0.0 })
                .collect();
            momenta(&unit)
        };
        let columns: Vec<Vec<f64>> = (0..size).map(along).collect::<Option<_>>()?;
        let form = |site: usize, i: usize, j: usize| {
            let at = site * size + i;
            columns[j][at] - at_rest[at]
        };
        (0..count)
            .filter_map(|site| KineticWarning::of_entries(size, &|i, j| form(site, i, j)))
            .reduce(|a, b| KineticWarning {
                velocities: a.velocities,
                negative: a.negative + b.negative,
                vanishing: a.vanishing + b.vanishing,
                smallest: a.smallest.min(b.smallest),
            })
            .map(|all| KineticWarning {
                velocities: count * size,
                ..all
            })
    }
}
