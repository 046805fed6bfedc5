//! Names of the copies of a quantity, one for each of its sites: `q_3` is `q` at site 3.

use crate::syntax::ast::Name;

/// A copy: its own name, the name of the quantity, and its site.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Copied {
    /// The name in the expanded model.
    pub name: String,
    /// The declared name.
    pub of: String,
    /// The site, counted from 0.
    pub site: usize,
}

/// The name of a copy.
pub fn copy_name(of: &str, site: usize) -> String {
    format!("{of}_{site}")
}

/// The copy of a declared name, typeset with its site as an index.
pub(super) fn copy(of: &Name, site: usize) -> Name {
    let typeset = of.typeset.as_ref();
    Name {
        text: copy_name(&of.text, site),
        place: of.place,
        typeset: typeset.map(|(latex, place)| (format!("{{{latex}}}_{{{site}}}"), *place)),
        is_copy: true,
    }
}
