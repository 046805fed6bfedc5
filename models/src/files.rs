//! Models that are shipped as text: the files of `elastic/`, `lattices/` and `fluids/` with their cases.
//! `build.rs` lists the folders, so that a new file is shipped without being named anywhere.

/// What a model is about; `clebsch list` groups models by it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// Bodies that turn.
    Rigid,
    /// Point masses.
    Particle,
    /// Bodies that deform homogeneously, and single rods.
    Elastic,
    /// Sites along a label: rods, chains, lattices.
    Chain,
    /// Fluids as particles, with functionals of all of them.
    Fluid,
}

impl Family {
    /// All families, in the order in which they are listed.
    pub const ALL: [Self; 5] = [
        Self::Rigid,
        Self::Particle,
        Self::Elastic,
        Self::Chain,
        Self::Fluid,
    ];

    /// The name that `clebsch list` takes.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rigid => "rigid",
            Self::Particle => "particle",
            Self::Elastic => "elastic",
            Self::Chain => "chain",
            Self::Fluid => "fluid",
        }
    }
}

/// A model as text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ModelFile {
    /// The file's name without its ending, such as `toda-chain`.
    pub name: &'static str,
    /// What it is about.
    pub family: Family,
    /// The statement.
    pub text: &'static str,
    /// Its cases; the first one is the default.
    pub cases: &'static [CaseFile],
}

/// A case as text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CaseFile {
    /// The file's name without its ending.
    pub stem: &'static str,
    /// Its TOML.
    pub text: &'static str,
}

/// Every shipped model file, by family, then by name.
pub const FILES: &[ModelFile] = include!(concat!(env!("OUT_DIR"), "/files.rs"));
