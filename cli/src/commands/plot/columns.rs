//! Columns of a finished run by their names: `X.1`, `X_1`, `X[1]`, `q_3`, `invariant_energy`, `time`.
//! Takes the folder of a run; gives the numbers of a column within a range of time.

use crate::case_file::archive::{Archive, Array};
use crate::case_file::quantity_of;
use crate::output::is_multiplier;
use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use crate::words::suggestion::nearest;
use clebsch::scalar::{larger, largest};
use clebsch_core::expr::symbol::ascii;
use serde_json::Value;
use std::ops::Range;
use std::path::Path;

/// A run that is complete, or stopped.
pub(super) struct Columns {
    archive: Archive,
    run: Value,
    times: Vec<f64>,
    /// Whether the first sample is of node 0, before any step.
    from_start: bool,
}

/// A column within the range of time.
#[derive(Clone, Debug)]
pub(super) struct Series {
    /// The name as the user typed it.
    pub name: String,
    /// The array that contains the column.
    pub of: String,
    /// Its numbers, one per sample. A multiplier is undefined at node 0, before any step.
    pub values: Vec<f64>,
    /// The largest number of the array over all samples, or the scale of the invariant. Numbers far below it may be
    /// rounding errors.
    pub size: f64,
}

impl Columns {
    /// Opens the run in a folder.
    ///
    /// # Errors
    /// Usage: there is no run, or its trajectory cannot be read.
    pub fn open(folder: &Path) -> Result<Self, Failure> {
        let file = folder.join("trajectory.npz");
        if !file.is_file() {
            return Err(Failure::Usage(format!(
                "{} contains no trajectory.npz; give the folder that `clebsch run --out` wrote",
                shown(folder)
            )));
        }
        let archive = Archive::open(&file).map_err(Failure::Usage)?;
        let text = std::fs::read_to_string(folder.join("run.json")).unwrap_or_default();
        let run = text.parse().unwrap_or(Value::Null);
        let times = archive.array("time").map_err(Failure::Usage)?;
        let count = times.shape.first().copied().unwrap_or(0);
        let times = times.numbers(0, count);
        let nodes = archive.array("node").ok();
        let first = nodes.and_then(|nodes| nodes.numbers(0, 1).first().copied());
        Ok(Self {
            archive,
            run,
            times,
            from_start: first == Some(0.0),
        })
    }

    /// Model and case, for a picture.
    pub fn title(&self) -> String {
        let word = |key: &str| self.run[key].as_str().unwrap_or("?").to_owned();
        format!("{}, case {}", word("model"), shown(word("case").as_str()))
    }

    /// One line for each array: its name and its components.
    pub fn described(&self) -> Vec<String> {
        let each = self.archive.names().filter_map(|name| {
            let array = self.archive.array(name).ok()?;
            if array.shape.first() != Some(&self.times.len()) {
                return None;
            }
            let inner = array.shape.get(1..)?;
            Some(match inner {
                [] => name.to_owned(),
                [_, rest @ ..] if self.has_sites(name) => {
                    let sites = self.sites(name, inner);
                    let ends = [sites.first(), sites.last()];
                    let [first, last] = ends.map(|site| site.copied().unwrap_or(0));
                    let [a, b] = match rest {
                        [] => [String::new(), String::new()],
                        [r] => [".1".to_owned(), format!(".{r}")],
                        [r, c] => [".11".to_owned(), format!(".{r}{c}")],
                        _ => return None,
                    };
                    format!("{name}_{first}{a} to {name}_{last}{b}")
                }
                [n] => format!("{name}.1 to {name}.{n}"),
                [r, c] => format!("{name}.11 to {name}.{r}{c}"),
                more => format!("{name}, {more:?}"),
            })
        });
        each.collect()
    }

    /// The samples between two times.
    ///
    /// # Errors
    /// Usage: the range contains fewer than two samples.
    pub fn range(&self, from: Option<f64>, to: Option<f64>) -> Result<Range<usize>, Failure> {
        let (from, to) = (
            from.unwrap_or(f64::NEG_INFINITY),
            to.unwrap_or(f64::INFINITY),
        );
        let inside = |time: &f64| (from..=to).contains(time);
        let first = self.times.iter().position(inside);
        let last = self.times.iter().rposition(inside);
        match (first, last) {
            (Some(first), Some(last)) if last > first => Ok(first..last + 1),
            _ => {
                let times = [self.times.first(), self.times.last()];
                let [first, last] = times.map(|t| t.copied().unwrap_or(0.0));
                Err(Failure::Usage(format!(
                    "fewer than two samples are between --from and --to; the run has times {first} to {last}"
                )))
            }
        }
    }

    /// All columns with this name: one component, or each component of a vector or a matrix.
    ///
    /// # Errors
    /// Usage: the run does not contain this column.
    pub fn all(&self, name: &str, range: &Range<usize>) -> Result<Vec<Series>, Failure> {
        let shape = match self.archive.has(name) && !self.has_sites(name) {
            true => Some(self.archive.array(name).map_err(Failure::Usage)?.shape),
            false => self.shape_at_site(name),
        };
        // Behind the sample, or the sample and the site.
        let inner = shape.as_ref().and_then(|shape| shape.get(1..));
        let names: Vec<String> = match inner {
            Some([n]) => (1..=*n).map(|i| format!("{name}.{i}")).collect(),
            Some([r, c]) if *r < 10 && *c < 10 => (1..=*r)
                .flat_map(|i| (1..=*c).map(move |j| format!("{name}.{i}{j}")))
                .collect(),
            _ => vec![name.to_owned()],
        };
        names.iter().map(|name| self.series(name, range)).collect()
    }

    /// One column.
    ///
    /// # Errors
    /// Usage: the run does not contain this column.
    pub fn series(&self, name: &str, range: &Range<usize>) -> Result<Series, Failure> {
        let (of, array, entry) = self.found(name)?;
        let stride: usize = array.shape.iter().skip(1).product();
        let undetermined = self.from_start && self.is_multiplier(&of);
        let values = range.clone().filter_map(|sample| {
            let value = array.numbers(sample * stride + entry, 1).first().copied();
            value.map(|value| match undetermined && sample == 0 {
                true => f64::NAN,
                false => value,
            })
        });
        let values: Vec<f64> = values.collect();
        let all = array.numbers(0, self.times.len() * stride);
        let finite = all.into_iter().filter(|x| x.is_finite());
        let size = larger(largest(finite), self.scale(&of));
        Ok(Series {
            name: name.to_owned(),
            of,
            values,
            size,
        })
    }

    /// The scale of an invariant in the run; 0 for other arrays.
    fn scale(&self, array: &str) -> f64 {
        let own = array.strip_prefix("invariant_");
        let invariants = self.run["results"]["invariants"].as_array();
        let mut all = invariants.into_iter().flatten();
        let found = all.find(|told| told["name"].as_str().map(ascii).as_deref() == own);
        found.and_then(|told| told["scale"].as_f64()).unwrap_or(0.0)
    }

    /// Whether an array is a multiplier. A run has two invariants for each multiplier.
    fn is_multiplier(&self, array: &str) -> bool {
        is_multiplier(array, |name| self.archive.has(&format!("invariant_{name}")))
    }

    /// The first and the last of the arrays of one name at sites: `tension_0 to tension_9`.
    fn copies(&self, name: &str) -> Option<String> {
        let site = |known: &str| -> Option<usize> {
            let rest = known.strip_prefix(name)?.strip_prefix('_')?;
            rest.parse().ok()
        };
        let sites = || self.archive.names().filter_map(site);
        let (first, last) = (sites().min()?, sites().max()?);
        Some(format!("{name}_{first} to {name}_{last}"))
    }

    /// The shape of an array at one site, without the number of samples, for a name such as `x_10`.
    fn shape_at_site(&self, name: &str) -> Option<Vec<usize>> {
        let plain = plain(name);
        let (head, site) = plain.rsplit_once(['_', '.'])?;
        let site: usize = site.parse().ok()?;
        if !self.archive.has(head) || !self.has_sites(head) {
            return None;
        }
        let array = self.archive.array(head).ok()?;
        let (samples, inner) = array.shape.split_first()?;
        let known = self.sites(head, inner).contains(&site);
        let rest = inner.get(1..).filter(|_| known)?;
        Some([&[*samples], rest].concat())
    }

    /// The site in the name of a column whose value an end condition prescribes: it is a parameter of the run, not a
    /// column.
    fn prescribed<'a>(&self, head: &str, component: &'a str) -> Option<&'a str> {
        let mut parts = component.split(['.', '_']).filter(|part| !part.is_empty());
        let site = parts.next()?;
        site.parse::<usize>().ok()?;
        self.run["parameters"]
            .get(format!("{head}_{site}"))
            .map(|_| site)
    }

    /// The array of a column, and which of its entries the column is.
    fn found(&self, name: &str) -> Result<(String, Array, usize), Failure> {
        let plain = plain(name);
        let name = plain.as_str();
        let splits = name
            .char_indices()
            .filter(|(_, c)| ['.', '_'].contains(c))
            .map(|(at, _)| at)
            .rev();
        let heads = std::iter::once((name, "")).chain(splits.map(|at| name.split_at(at)));
        for (head, component) in heads {
            if !self.archive.has(head) {
                continue;
            }
            let array = self.archive.array(head).map_err(Failure::Usage)?;
            if array.shape.first() != Some(&self.times.len()) {
                continue;
            }
            let inner = array.shape.get(1..).unwrap_or_default();
            let sites = self.has_sites(head).then(|| self.sites(head, inner));
            if let Some(entry) = entry(component, inner, sites.as_deref()) {
                return Ok((head.to_owned(), array, entry));
            }
            let site = sites
                .as_ref()
                .and_then(|_| self.prescribed(head, component));
            let what = match site {
                Some(site) => {
                    format!("an end prescribes `{head}_{site}`, so the run has no such column")
                }
                None => format!("`{}` does not name one column of `{head}`", shown(name)),
            };
            let instead = example(head, inner, sites.as_deref());
            return Err(Failure::Usage(format!("{what}; give {instead}")));
        }
        if let Some(copies) = self.copies(name) {
            return Err(Failure::Usage(format!(
                "`{name}` has a column at each site; give a site, {copies}"
            )));
        }
        let end = format!("_{name}");
        let longer = self.archive.names().find(|known| known.ends_with(&end));
        let near = match longer.or_else(|| nearest(name, self.archive.names())) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "`clebsch plot DIR` lists the columns".to_owned(),
        };
        Err(Failure::Usage(format!(
            "the run has no column `{}`; {near}",
            shown(name)
        )))
    }

    /// Whether the index after the sample is a site. This holds for a quantity with copies at sites, and for an
    /// observable of such a quantity.
    fn has_sites(&self, array: &str) -> bool {
        let initial = self.run["initial"].as_object();
        let keys = || initial.into_iter().flat_map(|all| all.keys());
        let quantities = keys().filter_map(|key| quantity_of(key));
        let mut at_sites = quantities.filter(|of| !keys().any(|key| key == of));
        at_sites.any(|of| {
            array == of
                || array
                    .strip_suffix(of)
                    .is_some_and(|rest| rest.ends_with('_'))
        })
    }

    /// The sites of an array, in its order. Sites with a prescribed value are omitted.
    fn sites(&self, array: &str, inner: &[usize]) -> Vec<usize> {
        let count = inner.first().copied().unwrap_or(0);
        let stated = self.archive.array(&format!("sites_of_{array}")).ok();
        let stated = stated.filter(|stated| stated.shape.as_slice() == [count]);
        match stated {
            // Whole numbers, small and exact.
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            Some(stated) => stated
                .numbers(0, count)
                .into_iter()
                .map(|x| x as usize)
                .collect(),
            None => (0..count).collect(),
        }
    }
}

/// A name with its indices behind points: `X[1]` is `X.1`.
fn plain(name: &str) -> String {
    let points = name.replace(['[', ','], ".");
    points.replace([']', ' '], "")
}

/// The entry that a component names; `None` for a single number. Sites have their numbers along the chain.
fn entry(component: &str, inner: &[usize], sites: Option<&[usize]>) -> Option<usize> {
    let parts = component.split(['.', '_']);
    let parts: Vec<&str> = parts.filter(|part| !part.is_empty()).collect();
    let counted = |text: &str, most: usize| {
        let number = text.parse::<usize>().ok()?;
        number.checked_sub(1).filter(|i| *i < most)
    };
    let lettered = |text: &str, most: usize| {
        let letter = ["x", "y", "z"].iter().position(|letter| *letter == text);
        letter.filter(|_| most == 3).or_else(|| counted(text, most))
    };
    let pair = |text: &str, r: usize, c: usize| {
        let (row, column) = text
            .is_ascii()
            .then(|| text.split_at_checked(1))
            .flatten()?;
        Some(counted(row, r)? * c + counted(column, c)?)
    };
    let (before, inner, parts) = match (sites, inner.split_first(), parts.split_first()) {
        (None, ..) => (0, inner, parts.as_slice()),
        (Some(sites), Some((_, inner)), Some((site, parts))) => {
            let site = site.parse::<usize>().ok()?;
            let place = sites.iter().position(|own| *own == site)?;
            (place * inner.iter().product::<usize>(), inner, parts)
        }
        _ => return None,
    };
    let own = match (inner, parts) {
        ([], []) => 0,
        ([n], [row]) => lettered(row, *n)?,
        ([r, c], [both]) => pair(both, *r, *c)?,
        ([r, c], [row, column]) => counted(row, *r)? * c + counted(column, *c)?,
        _ => return None,
    };
    Some(before + own)
}

/// An example of the name of a column of an array.
fn example(name: &str, inner: &[usize], sites: Option<&[usize]>) -> String {
    let ends = sites.and_then(|sites| sites.first().zip(sites.last()));
    match (inner, ends) {
        ([_], Some((first, last))) => format!("a site, {name}_{first} to {name}_{last}"),
        ([_, n], Some((first, last))) => {
            format!("a site and a component, {name}_{first}.1 to {name}_{last}.{n}")
        }
        (_, Some((first, _))) => format!("a site and an entry, {name}_{first}.11"),
        ([], None) => format!("`{name}` itself"),
        ([n], None) => format!("a component, {name}.1 to {name}.{n}"),
        (_, None) => format!("an entry, {name}.11"),
    }
}

#[cfg(test)]
mod tests {
    use super::entry;

    #[test]
    fn components_are_counted_from_one_and_sites_from_zero() {
        let (none, whole, later) = (None, Some(&[0, 1, 2, 3, 4][..]), Some(&[1, 2, 3, 4, 5][..]));
        for (component, inner, sites, at) in [
            ("", &[][..], none, Some(0)),
            (".1", &[3], none, Some(0)),
            ("_3", &[3], none, Some(2)),
            (".z", &[3], none, Some(2)),
            (".4", &[3], none, None),
            (".0", &[3], none, None),
            (".23", &[3, 3], none, Some(5)),
            (".2_3", &[3, 3], none, Some(5)),
            ("_0", &[5], whole, Some(0)),
            ("_5", &[5], whole, None),
            ("_2.y", &[5, 3], whole, Some(7)),
            ("_2_2", &[5, 3], whole, Some(7)),
            ("_1.12", &[5, 2, 2], whole, Some(5)),
            // The value at the first site is prescribed.
            ("_0", &[5], later, None),
            ("_5", &[5], later, Some(4)),
            ("_2.y", &[5, 3], later, Some(4)),
            ("", &[3], none, None),
            (".é", &[3, 3], none, None),
        ] {
            assert_eq!(entry(component, inner, sites), at, "{component}");
        }
    }
}
