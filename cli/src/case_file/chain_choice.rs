//! The number of sites of a case and the ends of its chain: its tables `[labels]` and `[ends]`. Takes the text;
//! gives the choice, or an error.

use super::location::File;
use super::scope::Scope;
use super::space::Space;
use super::stated::Stated;
use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::{ChainConfig, Lattice};
use clebsch_core::{document, pipeline};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The default number of sites.
const SITES: usize = 8;

/// The default number of particles of a fluid.
const PARTICLES: usize = 64;

/// The choice that applies if a case sets nothing.
pub(crate) fn default_choice(stated: &Stated) -> Option<ChainConfig> {
    let shortest = pipeline::representative(&stated.model, &stated.lattice).ok()?;
    let mut choice = document::default_choice(&stated.lattice, shortest);
    for count in &mut choice.counts {
        *count = SITES;
    }
    if let Some(space) = Space::sample(stated) {
        for (count, label) in choice.counts.iter_mut().zip(&stated.lattice.labels) {
            *count = if label.grid { space.count() } else { PARTICLES };
        }
    }
    Some(choice)
}

/// The choice that a case makes in its tables `[labels]` and `[ends]`. `None` if the model cannot be expanded;
/// its derivation reports the error, with the position in its text.
///
/// # Errors
/// Usage: the text is not TOML, a label or an end condition is unknown, or a number of sites is invalid.
pub(crate) fn choice(
    name: &str,
    text: &str,
    stated: &Stated,
) -> Result<Option<ChainConfig>, Failure> {
    let file = File::new(name, text);
    let document = file.document()?;
    of_case(&file, document.get_ref(), stated)
}

/// The choice of a case that is being read.
pub(super) fn of_case(
    file: &File<'_>,
    top: &DeTable<'_>,
    stated: &Stated,
) -> Result<Option<ChainConfig>, Failure> {
    let lattice = &stated.lattice;
    let Some(mut choice) = default_choice(stated) else {
        return Ok(None);
    };
    let Some(labels) = file.table(top, "labels")? else {
        let keys: Vec<String> = lattice
            .labels
            .iter()
            .map(|l| format!("{} = {SITES}", l.index.text))
            .collect();
        let message = format!(
            "missing table [labels] with the numbers of sites: for example {}",
            keys.join(", ")
        );
        return Err(file.wrong(None, &message));
    };
    let space = Space::read(file, top, stated)?;
    let scope = Scope::of(top);
    for (key, value) in labels {
        let asked = key.get_ref().as_ref();
        let own = lattice
            .labels
            .iter()
            .find(|l| l.index.text == asked || l.count.text == asked);
        let label = own.map_or(asked, |l| l.index.text.as_str());
        let wrong =
            |message: &str| file.wrong(Some(&value.span()), &format!("labels.{asked}: {message}"));
        let count = match value.get_ref() {
            // The domain gives the number of cells of a grid.
            _ if own.is_some_and(|l| l.grid) => space.as_ref().map(Space::count),
            other => {
                let count = scope.whole(other).map_err(|why| wrong(&why))?;
                count.and_then(|n| usize::try_from(n).ok())
            }
        };
        let count = count.ok_or_else(|| wrong("expected a whole number of sites, at least 1"))?;
        choice = choice
            .with_count(lattice, label, count)
            .map_err(|refusal| wrong(&refusal.to_string()))?;
    }
    if let Some(missing) = lattice.labels.iter().find(|l| {
        !labels.contains_key(l.index.text.as_str()) && !labels.contains_key(l.count.text.as_str())
    }) {
        let index = &missing.index.text;
        let message = format!("missing key `labels.{index}`: the number of sites");
        return Err(file.wrong(None, &message));
    }
    let ends = file.table(top, "ends")?;
    for (key, value) in ends.into_iter().flatten() {
        choice = ended(file, lattice, choice, key.get_ref().as_ref(), value)?;
    }
    if ends.is_none_or(DeTable::is_empty) {
        let parameters = file.table(top, "parameters")?;
        ends_unchosen(file, stated, &choice, parameters)?;
    }
    Ok(Some(choice))
}

/// Rejects a case that gives a parameter of an end condition, or of the ring, without choosing that end
/// condition. clebsch would ignore such a parameter. Parameters of the default ends are accepted.
fn ends_unchosen(
    file: &File<'_>,
    stated: &Stated,
    choice: &ChainConfig,
    parameters: Option<&DeTable<'_>>,
) -> Result<(), Failure> {
    let lattice = &stated.lattice;
    let Some(line) = lattice.line_label() else {
        return Ok(());
    };
    let [first, last] = [false, true].map(|end| lattice.alternatives(end));
    for key in parameters.into_iter().flat_map(|t| t.keys()) {
        let asked = key.get_ref().as_ref();
        if !stated.of_other_ends(asked) {
            continue;
        }
        let bare = asked.rsplit_once('_').map_or(asked, |(base, _)| base);
        let owners: Vec<(usize, usize)> = [0, 1]
            .into_iter()
            .flat_map(|end| {
                let all = lattice.ends.get(end).into_iter().flatten().enumerate();
                let own = all.filter(|(_, a)| {
                    let mut names = a.params.iter().flat_map(|(names, _)| names);
                    names.any(|n| [asked, bare].contains(&ascii(&n.text).as_str()))
                });
                own.map(move |(which, _)| (end, which)).collect::<Vec<_>>()
            })
            .collect();
        if choice.periodic
            || owners
                .iter()
                .any(|(end, which)| choice.ends[*end] == *which)
        {
            continue;
        }
        let mut names = choice.ends;
        let owner = match owners.first() {
            Some((end, which)) => {
                names[*end] = *which;
                let own = [&first, &last][*end].get(*which);
                format!("the end condition `{}`", own.map_or("", String::as_str))
            }
            None => "the ring".to_owned(),
        };
        let index = &line.index.text;
        let [a, b] = [(&first, names[0]), (&last, names[1])]
            .map(|(l, k)| l.get(k).map_or("", String::as_str));
        let example = match owners.is_empty() {
            true => format!("{index} = \"periodic\""),
            false => format!("{index} = [\"{a}\", \"{b}\"]"),
        };
        let ring = match lattice.periodic.is_some() {
            true => "; or \"periodic\"",
            false => "",
        };
        let message = format!(
            "parameters.{}: belongs to {owner}, but the case does not choose the ends: add [ends] with {example} (first end: \
             {}; last end: {}{ring})",
            shown(asked),
            first.join(", "),
            last.join(", "),
        );
        return Err(file.wrong(Some(&key.span()), &message));
    }
    Ok(())
}

/// `i = "periodic"`, `i = "pinned"` at both ends, or `i = ["clamped", "free"]`.
fn ended(
    file: &File<'_>,
    lattice: &Lattice,
    choice: ChainConfig,
    key: &str,
    value: &Spanned<DeValue<'_>>,
) -> Result<ChainConfig, Failure> {
    let wrong = |message: &str| {
        file.wrong(
            Some(&value.span()),
            &format!("ends.{}: {message}", shown(key)),
        )
    };
    let line = lattice.line_label().map(|l| l.index.text.as_str());
    if line != Some(key) {
        return Err(wrong(&match line {
            Some(line) => format!("the label of the chain is `{line}`"),
            None => "the model has no chain that could have ends".to_owned(),
        }));
    }
    let names: Option<Vec<&str>> = match value.get_ref() {
        DeValue::String(name) => Some(vec![name.as_ref(), name.as_ref()]),
        DeValue::Array(list) => list.iter().map(|v| v.get_ref().as_str()).collect(),
        _ => None,
    };
    match names.as_deref() {
        Some(["periodic", _]) => choice
            .with_ring(lattice)
            .map_err(|refusal| wrong(&refusal.to_string())),
        Some([first, last]) => {
            let choice = choice.with_end(lattice, false, first);
            choice
                .and_then(|c| c.with_end(lattice, true, last))
                .map_err(|refusal| wrong(&refusal.to_string()))
        }
        _ => Err(wrong(
            "expected \"periodic\", the name of an end condition, or two of them, [\"free\", \"free\"]",
        )),
    }
}
