//! Values of a case from an array of a file: `q = { npz = "out/trajectory.npz", key = "q", sample = -1 }`.
//! Takes the table and the quantity; gives its numbers at each of its sites, or an error with its position.

use super::archive::{Archive, Array};
use super::location::File;
use crate::words::plain::shown;
use crate::words::suggestion::did_you_mean;
use clebsch::card::{Field, Kind};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The keys that the table may contain.
const KEYS: [&str; 3] = ["npz", "key", "sample"];

/// Whether a value is a table with such keys.
pub(super) fn is_meant(value: &DeValue<'_>) -> bool {
    let table = value.as_table();
    table.is_some_and(|t| KEYS.iter().any(|key| t.contains_key(*key)))
}

/// The shapes and sites that a quantity accepts from an array.
#[derive(Clone, Copy, Debug)]
pub(super) struct AcceptedShapes<'a> {
    /// The accepted shapes of a value.
    pub values: &'a [Vec<usize>],
    /// The sites of the quantity, if it has sites.
    pub sites: Option<&'a [usize]>,
    /// For momenta: the sites whose configuration no end condition prescribes. An array may contain only these sites.
    pub moving: Option<&'a [usize]>,
}

/// A mistake, and its range in the text.
#[derive(Debug)]
pub(super) struct Fault {
    pub why: String,
    pub at: Range<usize>,
}

/// The files of a case, each opened once, and the values read from them.
#[derive(Debug)]
pub(super) struct Arrays {
    folder: PathBuf,
    files: RefCell<BTreeMap<PathBuf, Rc<Archive>>>,
    taken: RefCell<BTreeMap<usize, Rc<ArrayValues>>>,
}

/// The values of a quantity.
#[derive(Clone, Debug)]
pub(super) struct ArrayValues {
    numbers: Vec<f64>,
    /// The shape of a value.
    shape: Vec<usize>,
    /// The index of the value of each site, if the quantity has sites.
    places: Option<BTreeMap<usize, usize>>,
    /// The array and its file, for messages.
    name: String,
}

impl Arrays {
    /// The arrays of a case file. Paths are relative to its folder.
    pub(super) fn of(file: &File<'_>) -> Self {
        let folder = Path::new(file.name).parent();
        Arrays {
            folder: folder.map(Path::to_path_buf).unwrap_or_default(),
            files: RefCell::default(),
            taken: RefCell::default(),
        }
    }

    /// The values that a table requests. If it names no array, the array is called `named`.
    pub(super) fn take(
        &self,
        value: &Spanned<DeValue<'_>>,
        named: &str,
        wanted: AcceptedShapes<'_>,
    ) -> Result<Rc<ArrayValues>, Fault> {
        let start = value.span().start;
        if let Some(known) = self.taken.borrow().get(&start) {
            return Ok(known.clone());
        }
        let taken = Rc::new(self.read(value, named, wanted)?);
        self.taken.borrow_mut().insert(start, taken.clone());
        Ok(taken)
    }

    fn read(
        &self,
        value: &Spanned<DeValue<'_>>,
        named: &str,
        wanted: AcceptedShapes<'_>,
    ) -> Result<ArrayValues, Fault> {
        let whole = |why: String| Fault {
            why,
            at: value.span(),
        };
        let none = DeTable::new();
        let table = value.get_ref().as_table().unwrap_or(&none);
        for key in table.keys() {
            let asked = key.get_ref().as_ref();
            if !KEYS.contains(&asked) {
                let hint = did_you_mean(asked, KEYS);
                return Err(Fault {
                    why: format!("unknown key `{}`{hint}", shown(asked)),
                    at: key.span(),
                });
            }
        }
        let Some(path) = text(table, "npz")? else {
            let why = "missing key `npz`: the file with the array, such as { npz = \"out/trajectory.npz\" }";
            return Err(whole(why.to_owned()));
        };
        let key = text(table, "key")?;
        let sample = table
            .get("sample")
            .map(|v| Ok((whole_number(v)?, v.span())));
        let sample = sample.transpose()?;
        let span = |key: &str| table.get(key).map_or(value.span(), Spanned::span);
        let archive = self.archive(&self.folder.join(path)).map_err(|why| Fault {
            why,
            at: span("npz"),
        })?;
        let of_key = |why: String| Fault {
            why,
            at: span("key"),
        };
        let named = key.unwrap_or(named);
        let array = archive.array(named).map_err(of_key)?;
        // If an end condition prescribes the value at some site, the run lists the sites of its array in a second
        // array.
        let told = format!("sites_of_{named}");
        let told = match wanted.sites.is_some() && archive.has(&told) {
            true => Some(whole_numbers(&archive.array(&told).map_err(of_key)?)),
            false => None,
        };
        let name = format!("the array `{}` of {}", shown(named), archive.name());
        let Some(fit) = fit(&array.shape, wanted, told.as_deref(), sample.is_some()) else {
            return Err(of_key(misshapen(&name, &array, wanted, told.as_deref())));
        };
        let size = fit.rows.as_ref().map_or(1, |r| r.len()) * fit.value.iter().product::<usize>();
        let from = match (fit.samples, &sample) {
            (None, None) => 0,
            (None, Some((_, at))) => {
                return Err(Fault {
                    why: format!(
                        "sample: {name} has no samples, its shape is {}",
                        list(&array.shape)
                    ),
                    at: at.clone(),
                });
            }
            (Some(count), sample) => {
                let asked = sample.as_ref().map_or(-1, |(k, _)| *k);
                let count = i64::try_from(count).unwrap_or(i64::MAX);
                let own = if asked < 0 { count + asked } else { asked };
                if !(0..count).contains(&own) {
                    return Err(Fault {
                        why: format!(
                            "sample: {name} has {count} samples, 0 to {} or, counted from the end, -1 to -{count}; found {asked}",
                            count - 1
                        ),
                        at: sample.as_ref().map_or(value.span(), |(_, at)| at.clone()),
                    });
                }
                usize::try_from(own).unwrap_or(0)
            }
        };
        let numbers = array.numbers(from * size, size);
        let rows = fit.rows;
        let one = fit.value.iter().product::<usize>();
        if let Some(at) = numbers.iter().position(|x| !x.is_finite()) {
            let site = rows.as_ref().and_then(|r| r.get(at / one));
            let site = site.map_or_else(String::new, |site| format!(" at site {site}"));
            let component = match one {
                1 => String::new(),
                _ => format!(", number {} of the value", at % one + 1),
            };
            return Err(of_key(format!(
                "{name} is {}{site}{component}, which is not a finite number",
                numbers.get(at).copied().unwrap_or_default()
            )));
        }
        Ok(ArrayValues {
            numbers,
            shape: fit.value,
            places: rows.map(|r| r.iter().enumerate().map(|(at, site)| (*site, at)).collect()),
            name,
        })
    }

    fn archive(&self, path: &Path) -> Result<Rc<Archive>, String> {
        if let Some(known) = self.files.borrow().get(path) {
            return Ok(known.clone());
        }
        let archive = Rc::new(Archive::open(path)?);
        let mut files = self.files.borrow_mut();
        files.insert(path.to_path_buf(), archive.clone());
        Ok(archive)
    }
}

impl ArrayValues {
    /// The numbers of a site. If the quantity has no sites, all its numbers.
    pub(super) fn at(&self, site: usize) -> Result<&[f64], String> {
        let Some(places) = &self.places else {
            return Ok(&self.numbers);
        };
        let size = self.shape.iter().product::<usize>();
        let own = places.get(&site);
        let own = own.and_then(|at| self.numbers.get(at * size..(at + 1) * size));
        own.ok_or_else(|| {
            format!(
                "{} has no value at site {site}, according to its sites_of array: give the value in the case, under a name \
                 with the site",
                self.name
            )
        })
    }

    /// The shape of a value.
    pub(super) fn shape(&self) -> &[usize] {
        &self.shape
    }
}

/// The shapes of an array for one value of a field.
pub(super) fn shapes(field: &Field) -> Vec<Vec<usize>> {
    let Field { rows, cols, .. } = *field;
    match field.kind {
        _ if rows * cols == 1 => vec![vec![]],
        Kind::Rotation if rows == 3 => vec![vec![3, 3], vec![4]],
        Kind::UnitQuaternion if cols == 4 => vec![vec![4, 4], vec![4]],
        Kind::Diagonal => vec![vec![rows, cols], vec![rows]],
        _ if cols == 1 => vec![vec![rows]],
        _ => vec![vec![rows, cols]],
    }
}

/// How an array fits a quantity.
struct Fit {
    /// How many samples there are, if any.
    samples: Option<usize>,
    /// The sites of its values, in order.
    rows: Option<Vec<usize>>,
    /// The shape of a value.
    value: Vec<usize>,
}

/// The interpretation of an array with a given shape. Unless samples are requested, it first tries to read the array
/// without samples.
fn fit(
    shape: &[usize],
    wanted: AcceptedShapes<'_>,
    told: Option<&[usize]>,
    sampled: bool,
) -> Option<Fit> {
    let plain = |shape: &[usize], samples: Option<usize>| {
        wanted.values.iter().find_map(|value| {
            let before = shape.strip_suffix(value.as_slice())?;
            let rows = match (before, wanted.sites) {
                ([], None) => None,
                ([count], Some(all)) => {
                    let may = told.or(Some(all)).into_iter();
                    let mut may = may.chain(wanted.moving.filter(|_| told.is_none()));
                    Some(may.find(|sites| sites.len() == *count)?.to_vec())
                }
                _ => return None,
            };
            Some(Fit {
                samples,
                rows,
                value: value.clone(),
            })
        })
    };
    let with_samples = || {
        let (samples, rest) = shape.split_first()?;
        plain(rest, Some(*samples))
    };
    match sampled {
        true => with_samples().or_else(|| plain(shape, None)),
        // A list of numbers may be intended as values at sites, so it is not read as samples; the message explains
        // this.
        false if wanted.sites.is_none() && shape.len() == 1 => plain(shape, None),
        false => plain(shape, None).or_else(with_samples),
    }
}

/// The message for an array with none of the accepted shapes.
fn misshapen(
    name: &str,
    array: &Array,
    wanted: AcceptedShapes<'_>,
    told: Option<&[usize]>,
) -> String {
    let mut counts: Vec<Option<usize>> = match (told, wanted.sites) {
        (Some(sites), _) | (None, Some(sites)) => vec![Some(sites.len())],
        (None, None) => vec![None],
    };
    let moving = wanted.moving.filter(|_| told.is_none()).map(<[usize]>::len);
    counts.extend(moving.map(Some).filter(|n| !counts.contains(n)));
    let shapes = counts.iter().flat_map(|count| {
        let own = wanted.values.iter();
        own.map(move |value| count.iter().chain(value).map(usize::to_string).collect())
    });
    let shapes: Vec<Vec<String>> = shapes.collect();
    let sampled = shapes.iter().map(|shape| {
        let before = std::iter::once("samples".to_owned());
        tuple(&before.chain(shape.iter().cloned()).collect::<Vec<_>>())
    });
    let all: Vec<String> = shapes.iter().map(|s| tuple(s)).chain(sampled).collect();
    let of_sites = match counts.first() {
        Some(Some(n)) => format!(" at each of {n} sites"),
        _ => String::new(),
    };
    let said = match (counts.first(), array.shape.len()) {
        (Some(None), 1) => "; to read one of several samples, add the key `sample`",
        _ => "",
    };
    format!(
        "{name} has the shape {}; a value{of_sites} takes {}{said}",
        list(&array.shape),
        all.join(" or ")
    )
}

/// A shape as numpy prints it.
fn list(shape: &[usize]) -> String {
    let each: Vec<String> = shape.iter().map(usize::to_string).collect();
    tuple(&each)
}

fn tuple(each: &[String]) -> String {
    match each {
        [n] => format!("({n},)"),
        all => format!("({})", all.join(", ")),
    }
}

/// A text of the table.
fn text<'a>(table: &'a DeTable<'_>, key: &str) -> Result<Option<&'a str>, Fault> {
    let Some(value) = table.get(key) else {
        return Ok(None);
    };
    let own = value.get_ref().as_str();
    own.map(Some).ok_or_else(|| Fault {
        why: format!(
            "{key}: expected a string in quotes, found a value of type {}",
            value.get_ref().type_str()
        ),
        at: value.span(),
    })
}

/// An integer of the table.
fn whole_number(value: &Spanned<DeValue<'_>>) -> Result<i64, Fault> {
    let own = match value.get_ref() {
        DeValue::Integer(n) => i64::from_str_radix(n.as_str(), n.radix()).ok(),
        _ => None,
    };
    own.ok_or_else(|| Fault {
        why: "sample: expected a whole number; negative numbers count from the end".to_owned(),
        at: value.span(),
    })
}

/// Sites, which are integers.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn whole_numbers(array: &Array) -> Vec<usize> {
    let count = array.shape.iter().product();
    let all = array.numbers(0, count);
    all.into_iter().map(|x| x as usize).collect()
}
