//! The choices that a case makes for a chain: the number of sites, open or periodic, and the end conditions.

use super::declared::{Label, Lattice, Quantity, Sites};
use core::fmt;

/// The numbers of sites and the end conditions of one chain.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct ChainConfig {
    /// For each label: the number of segments of an open chain, or of sites of a ring or a set.
    pub counts: Vec<usize>,
    /// Whether the chain is a ring.
    pub periodic: bool,
    /// Which alternative applies at the first and at the last site.
    pub ends: [usize; 2],
}

/// Why a choice cannot be made.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Refusal {
    /// The model does not have this label.
    Label {
        /// The requested name.
        name: String,
        /// The names that the model has.
        known: Vec<String>,
    },
    /// The model does not have this end condition.
    End {
        /// The requested name.
        name: String,
        /// Whether the last end was requested.
        last: bool,
        /// The names that the model has.
        known: Vec<String>,
    },
    /// The chain is not declared periodic.
    NotPeriodic {
        /// The label of the chain.
        label: String,
    },
    /// Too few sites.
    Few {
        /// The label.
        label: String,
        /// The requested number.
        found: usize,
        /// The smallest possible number.
        least: usize,
    },
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Label { name, known } => write!(
                f,
                "the model has no label `{name}`; it has {}",
                listed(known)
            ),
            Self::End { name, last, known } => write!(
                f,
                "the model has no end condition `{name}` at the {} site; it has {}",
                if *last { "last" } else { "first" },
                listed(known)
            ),
            Self::NotPeriodic { label } => write!(
                f,
                "the chain `{label}` is not declared periodic: add `periodic;` to the model"
            ),
            Self::Few {
                label,
                found,
                least,
            } => write!(
                f,
                "the label `{label}` has {found} where at least {least} {} needed",
                if *least == 1 { "is" } else { "are" }
            ),
        }
    }
}

impl std::error::Error for Refusal {}

fn listed(names: &[String]) -> String {
    let quoted: Vec<String> = names.iter().map(|n| format!("`{n}`")).collect();
    quoted.join(", ")
}

impl ChainConfig {
    /// The shortest chain on which the middle site and each end have all the neighbours in their equations: its results
    /// hold for every longer chain. A ring has an odd number of sites, so that its even and odd sites are not two
    /// separate chains.
    pub fn representative(lattice: &Lattice, reach: usize) -> ChainConfig {
        let count = |l: &Label| match l.set {
            // If there are functionals of all sites, one site represents all of them.
            true if !lattice.meshes.is_empty() => 1,
            true => 2,
            false => 2 * reach.max(1) + 2,
        };
        ChainConfig {
            counts: lattice.labels.iter().map(count).collect(),
            periodic: false,
            ends: [0, 0],
        }
    }

    /// The ring of this choice, with an odd number of sites.
    #[must_use]
    pub fn as_ring(mut self, lattice: &Lattice) -> ChainConfig {
        self.periodic = true;
        if let Some(count) = lattice.line.and_then(|i| self.counts.get_mut(i)) {
            *count |= 1;
        }
        self
    }

    /// Sets the number of segments or sites of a label.
    ///
    /// # Errors
    /// The label does not exist, or the requested number is too small.
    pub fn with_count(
        mut self,
        lattice: &Lattice,
        label: &str,
        count: usize,
    ) -> Result<ChainConfig, Refusal> {
        let place = lattice.labels.iter().position(|l| l.index.text == label);
        let Some(i) = place else {
            return Err(Refusal::Label {
                name: label.to_owned(),
                known: lattice
                    .labels
                    .iter()
                    .map(|l| l.index.text.clone())
                    .collect(),
            });
        };
        if count == 0 {
            return Err(Refusal::Few {
                label: label.to_owned(),
                found: 0,
                least: 1,
            });
        }
        self.counts[i] = count;
        Ok(self)
    }

    /// Closes the chain to a ring.
    ///
    /// # Errors
    /// The model does not declare `periodic;`.
    pub fn with_ring(mut self, lattice: &Lattice) -> Result<ChainConfig, Refusal> {
        if lattice.periodic.is_none() {
            let line = lattice.line.and_then(|i| lattice.labels.get(i));
            let label = line.map_or_else(String::new, |l| l.index.text.clone());
            return Err(Refusal::NotPeriodic { label });
        }
        self.periodic = true;
        Ok(self)
    }

    /// Sets the end condition at the first or the last site.
    ///
    /// # Errors
    /// The alternative does not exist.
    pub fn with_end(
        mut self,
        lattice: &Lattice,
        last: bool,
        name: &str,
    ) -> Result<ChainConfig, Refusal> {
        let known = lattice.alternatives(last);
        match known.iter().position(|k| k == name) {
            Some(i) => {
                self.ends[usize::from(last)] = i;
                self.periodic = false;
                Ok(self)
            }
            None => Err(Refusal::End {
                name: name.to_owned(),
                last,
                known,
            }),
        }
    }

    /// The number chosen for a label.
    pub fn count(&self, label: usize) -> usize {
        self.counts.get(label).copied().unwrap_or(0)
    }

    /// The number of sites of a kind that a label has.
    pub fn sites(&self, lattice: &Lattice, label: usize, sites: Sites) -> usize {
        let open = lattice.line == Some(label) && !self.periodic;
        self.count(label) + usize::from(open && sites == Sites::Nodes)
    }

    /// The number of sites of a quantity.
    pub fn sites_of(&self, lattice: &Lattice, q: &Quantity) -> usize {
        self.sites(lattice, q.label, q.sites)
    }

    /// The ends of an open chain in words: `with both ends free`.
    pub fn held(&self, lattice: &Lattice) -> String {
        let name = |last: bool| {
            let names = lattice.alternatives(last);
            let chosen = names.get(self.ends[usize::from(last)]).cloned();
            chosen.unwrap_or_default()
        };
        let (a, b) = (name(false), name(true));
        match a == b {
            true => format!("with both ends {a}"),
            false => format!("with the first end {a} and the last end {b}"),
        }
    }

    /// Describes the choice: `i = 4, periodic`.
    pub fn words(&self, lattice: &Lattice) -> String {
        let counts = lattice.labels.iter().zip(&self.counts);
        let mut words: Vec<String> = counts
            .map(|(l, n)| format!("{} = {n}", l.count.text))
            .collect();
        if self.periodic {
            words.push("periodic".to_owned());
        } else if lattice.line.is_some() {
            for last in [false, true] {
                let names = lattice.alternatives(last);
                let chosen = names.get(self.ends[usize::from(last)]);
                words.extend(chosen.filter(|_| names.len() > 1).cloned());
            }
        }
        words.join(", ")
    }
}
