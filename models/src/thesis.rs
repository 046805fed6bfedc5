//! The thesis cited by the gallery: its bibliography entries, and the remark on a model that it derives.

use crate::case::Work;

/// The thesis.
pub(crate) const THESIS: Work = Work {
    named: "thesis",
    key: "dixon2007",
    entry: "@phdthesis{dixon2007, author = {Dixon, M. F.}, title = {Geometric integrators for continuum dynamics}, \
            school = {Imperial College London}, year = {2007}}",
    item: "M. F. Dixon, \\emph{Geometric integrators for continuum dynamics}, PhD thesis, Imperial College London, 2007.",
};

/// The remark on the model of a section; the thesis's Lagrangian is `$factor` times the action of a step here.
macro_rules! system {
    ($section:literal, $factor:literal) => {
        concat!(
            "This is the system of section ",
            $section,
            " of M. F. Dixon, Geometric integrators for continuum dynamics (2007), the thesis cited below; its Lagrangian \
             and momenta are $",
            $factor,
            "$ times those printed here, and it indexes velocities by the end of the step."
        )
    };
}
pub(crate) use system;
