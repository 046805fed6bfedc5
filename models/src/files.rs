//! Models that are shipped as text: the files of `elastic/`, `lattices/` and `fluids/` with their cases. `build.rs`
//! lists the folders, so that new files are included automatically.

/// The family of a model, by which `clebsch list` groups models.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// Rigid bodies.
    Rigid,
    /// Point masses.
    Particle,
    /// Bodies with homogeneous deformations, and single rods.
    Elastic,
    /// Sites along a label: rods, chains, lattices.
    Chain,
    /// Fluids as particles, with functionals of all particles.
    Fluid,
}

impl Family {
    /// All families, in the order of the list.
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

/// A model file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ModelFile {
    /// The file's name without its extension, such as `toda-chain`.
    pub name: &'static str,
    /// Its family.
    pub family: Family,
    /// The text of the model.
    pub text: &'static str,
    /// Its cases; the first one is the default.
    pub cases: &'static [CaseFile],
}

/// A case file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CaseFile {
    /// The file's name without its extension.
    pub stem: &'static str,
    /// Its TOML text.
    pub text: &'static str,
}

/// All shipped model files, by family, then by name.
pub const FILES: &[ModelFile] = include!(concat!(env!("OUT_DIR"), "/files.rs"));
