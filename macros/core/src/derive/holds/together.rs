//! Momenta of several configurations of which a reaction changes each, but not the sum: what constraints between
//! bodies leave. Takes the momenta that are conserved without constraints; gives their sums.

use crate::check::spec::Spec;
use crate::derive::Letters;
use crate::derive::invariants::{Family, Invariant, Kind};
use crate::expr::shape::Shape;
use crate::expr::{self, Expr};

/// Momenta that are added: of one shape, and read alike.
struct Sum<'v> {
    shape: Shape,
    /// What is read of them: `angular_g`, say.
    reading: String,
    list: Vec<&'v Invariant>,
    configurations: Vec<usize>,
}

/// The sums of the momenta that were found for single bodies and sets of them, each over all that are read alike.
pub(super) fn sums(spec: &Spec, letters: &Letters, changed: &[Invariant]) -> Vec<Invariant> {
    let mut sums: Vec<Sum> = Vec::new();
    for v in changed.iter().filter(|v| v.family == Family::Noether) {
        let Some(value) = &v.value else { continue };
        let set = moved(letters, value);
        let Some(reading) = reading(spec, letters, &v.name, &set) else {
            continue;
        };
        let shape = value.shape();
        let alike = |s: &&mut Sum| s.shape == shape && s.reading == reading;
        match sums.iter_mut().find(alike) {
            Some(sum) => {
                sum.list.push(v);
                sum.configurations.extend(set);
            }
            None => sums.push(Sum {
                shape,
                reading,
                list: vec![v],
                configurations: set,
            }),
        }
    }
    let several = sums.into_iter().filter(|s| s.list.len() > 1);
    several.filter_map(|s| added(spec, letters, s)).collect()
}

/// The configurations whose momenta stand in a value.
fn moved(letters: &Letters, value: &Expr) -> Vec<usize> {
    let momenta = letters.node_momentum.iter().enumerate();
    let found = expr::letters(value);
    let stands = |id| found.iter().any(|l| l.symbol == id);
    let moved = momenta.filter(|(_, m)| stands(**m)).map(|(i, _)| i);
    moved.collect()
}

/// What is read of a momentum, by its name: without what it is of. Turns of bodies and turns of places are read alike.
fn reading(spec: &Spec, letters: &Letters, name: &str, set: &[usize]) -> Option<String> {
    let mut stem = format!("{name}_");
    // The longest first: `x_1` begins `x_12`.
    let mut elements: Vec<String> = set
        .iter()
        .map(|i| {
            let element = spec.configurations[*i].element;
            format!("_{}_", letters.symbols.get(element).ascii)
        })
        .collect();
    elements.sort_by_key(|e| std::cmp::Reverse(e.len()));
    for e in elements {
        stem = stem.replacen(&e, "_", 1);
    }
    let stem = stem.strip_prefix("total_").unwrap_or(&stem);
    let stem = stem.strip_prefix("spatial_").unwrap_or(stem);
    let rest = stem.strip_prefix("momentum_")?.trim_end_matches('_');
    let turns = |i: &usize| spec.configurations[*i].group.only_turns();
    Some(match set.iter().all(turns) && !rest.contains("angular") {
        true if rest.is_empty() => "angular".to_owned(),
        true => format!("angular_{rest}"),
        false => rest.to_owned(),
    })
}

fn added(spec: &Spec, letters: &Letters, sum: Sum) -> Option<Invariant> {
    let mut set = sum.configurations;
    set.sort_unstable();
    let count = set.len();
    set.dedup();
    // Two readings of one momentum are not added.
    if set.len() < count {
        return None;
    }
    let mut name = "total_momentum".to_owned();
    if set.len() < spec.configurations.len() {
        for i in set {
            let element = spec.configurations[i].element;
            name += &format!("_{}", letters.symbols.get(element).ascii);
        }
    }
    if !sum.reading.is_empty() {
        name += &format!("_{}", sum.reading);
    }
    let values = sum.list.iter().filter_map(|v| v.value.clone());
    let scales = sum.list.iter().filter_map(|v| v.scale.clone());
    let scales: Vec<Expr> = scales.collect();
    let alike = scales.windows(2).all(|w| w[0].shape() == w[1].shape());
    let shape = scales.first().map_or(Shape::SCALAR, Expr::shape);
    let first = sum.list.first()?;
    Some(Invariant {
        name,
        kind: Kind::Value,
        family: Family::Noether,
        value: Some(expr::sum(values.collect::<Vec<_>>(), sum.shape)),
        scale: alike.then(|| expr::sum(scales, shape)),
        exact: true,
        reason: first.reason.clone(),
    })
}
