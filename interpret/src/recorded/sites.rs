//! The body of a loop over sites as a tape: recorded at two neighbouring sites, and run at many sites side by side.
//!
//! A body reads a list at a distance from the loop's site, or at a fixed site. The two recordings show which of the
//! two it is. If the operations may depend on the number of a site, clebsch runs the body itself.

mod load;
mod run;

use super::form::Form;
use super::loop_inputs::{Fixed, ReadValue, SiteReader};
use super::tape_storage::MOST;
use super::traced::{Traced, record};
use crate::code::{Code, Evaluated, Places, unfit};
use crate::listing::{FieldNames, Section};
use crate::map_scalar::{map_scalar, numbers};
use crate::sites::Column;
use crate::value::Value;
use clebsch::Real;
use clebsch::linalg::Dense;
use run::SiteTape;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock, PoisonError, RwLock};

/// The lists that a loop fills, each with its first site.
pub struct Lists<'a, T: Real = f64> {
    /// The list that the loop fills.
    pub out: Option<(&'a mut Column<T>, usize)>,
    /// The list that the loop reads and changes, site by site.
    pub kept: Option<(&'a mut Column<T>, usize)>,
    /// The list to which the loop appends values.
    pub gathered: Option<&'a mut Column<T>>,
}

impl<T: Real> Default for Lists<'_, T> {
    fn default() -> Self {
        Lists {
            out: None,
            kept: None,
            gathered: None,
        }
    }
}

/// The body of a loop: a function of a site and, in some loops, of the stored value at the site.
pub trait SiteBody<T: Real> {
    /// The value of the body at these arguments.
    ///
    /// # Errors
    /// [`Exit`](crate::code::Exit) if the operations do not fit their values.
    fn at(&self, arguments: &[Value<T>], places: &mut Places<T>) -> Evaluated<T>;

    /// Runs sites by tapes as far as possible; returns the next site, which the body itself must compute.
    fn advance(
        &self,
        _places: &Places<T>,
        [from, _]: [usize; 2],
        _lists: &mut Lists<'_, T>,
    ) -> usize {
        from
    }
}

/// The body of a loop over the recording scalar, recorded at each site.
#[derive(Debug)]
pub struct TracedSite {
    parameters: Vec<usize>,
    body: Code<Traced>,
}

impl SiteBody<Traced> for TracedSite {
    fn at(&self, arguments: &[Value<Traced>], places: &mut Places<Traced>) -> Evaluated<Traced> {
        at_arguments((&self.parameters, &self.body), arguments, places)
    }
}

fn at_arguments<T: Real>(
    (parameters, body): (&[usize], &Code<T>),
    arguments: &[Value<T>],
    places: &mut Places<T>,
) -> Evaluated<T> {
    for (at, value) in parameters.iter().zip(arguments) {
        *unfit(places.get_mut(*at))? = value.clone();
    }
    body.returned(places)
}

impl Lists<'_> {
    /// The shapes of the results, if they are arrays.
    fn shapes(&self) -> Vec<Option<[usize; 2]>> {
        let shape = |column: &Column<f64>| match column {
            Column::Arrays(dims, _) => Some(*dims),
            _ => None,
        };
        let filled = self.out.iter().chain(&self.kept);
        let filled = filled.map(|(column, _)| shape(column));
        let gathered = self.gathered.iter().map(|column| shape(column));
        filled.chain(gathered).collect()
    }
}

/// The body of a loop with its tapes.
#[derive(Debug)]
pub struct SiteFunction {
    parameters: Vec<usize>,
    body: Code<f64>,
    /// The form, and whether the body may clamp sites to a list.
    form: OnceLock<Option<(Form, bool)>>,
    /// The newest tape is last.
    tapes: RwLock<Vec<Arc<SiteTape>>>,
    /// How often recording failed.
    failures: AtomicUsize,
}

impl SiteFunction {
    /// A body with its parameters at these places.
    pub fn new(parameters: Vec<usize>, body: Code<f64>) -> Self {
        SiteFunction {
            parameters,
            body,
            form: OnceLock::new(),
            tapes: RwLock::default(),
            failures: AtomicUsize::default(),
        }
    }

    /// The body over the recording scalar, recorded at each site. Returns nothing if it cannot be recorded.
    pub fn recorded_at_each(&self) -> Option<TracedSite> {
        Some(TracedSite {
            parameters: self.parameters.clone(),
            body: self.body.map_scalar(Traced::constant)?,
        })
    }

    /// The newest tape as text.
    pub fn section(&self, title: &str, names: &FieldNames) -> Option<Section> {
        let tapes = self.tapes.read().unwrap_or_else(PoisonError::into_inner);
        tapes.last().map(|tape| tape.section(title, names))
    }

    fn form(&self) -> Option<(Form, bool)> {
        if self.body.chooses() {
            return None;
        }
        let form = Form::of(&self.parameters, &self.body)?;
        Some((form, self.body.clamps()))
    }

    fn recorded(
        &self,
        (form, clamps): &(Form, bool),
        places: &Places<f64>,
        site: usize,
        lists: &Lists<'_>,
    ) -> Option<Arc<SiteTape>> {
        if self.failures.load(Ordering::Relaxed) >= MOST {
            return None;
        }
        let first = self.once(form, places, site, lists);
        let made = first.and_then(|first| {
            let second = self.once(form, places, site + 1, lists)?;
            SiteTape::of([site, site + 1], [first, second], *clamps)
        });
        match made {
            Some(tape) => {
                let tape = Arc::new(tape);
                let mut tapes = self.tapes.write().unwrap_or_else(PoisonError::into_inner);
                if tapes.len() == MOST {
                    tapes.remove(0);
                }
                tapes.push(tape.clone());
                Some(tape)
            }
            None => {
                self.failures.fetch_add(1, Ordering::Relaxed);
                None
            }
        }
    }

    /// The body at one site.
    fn once(
        &self,
        form: &Form,
        places: &Places<f64>,
        site: usize,
        lists: &Lists<'_>,
    ) -> Option<SiteRecording> {
        let mut asker = SiteReader::new(site);
        let mut gives = Vec::new();
        let (tape, inputs) = record(|| {
            let mut own = form.places(&mut asker, places)?;
            *own.get_mut(*self.parameters.first()?)? = Value::Int(i64::try_from(site).ok()?);
            if let (Some((kept, from)), Some(at)) = (&lists.kept, self.parameters.get(1)) {
                *own.get_mut(*at)? = asker.kept(kept, from + site)?;
            }
            let value = form.run(&mut own)?;
            let shapes = lists.shapes();
            let values = match (shapes.len(), value) {
                (_, Value::None) => return None,
                (0, _) => Vec::new(),
                (1, value) => vec![value],
                (2, Value::List(both)) => both,
                _ => return None,
            };
            let mut outputs = Vec::new();
            for (value, shape) in values.into_iter().zip(shapes) {
                let value = match (value, shape) {
                    (Value::Zeros, Some([rows, cols])) => Value::of(Dense::zeros(rows, cols)),
                    (value, _) => value,
                };
                gives.push(map_scalar(&value, &mut |_| 0.0)?);
                numbers(&value, &mut outputs)?;
            }
            Some(outputs)
        })?;
        let (reads, fixed) = asker.into_reads();
        Some(SiteRecording {
            tape,
            inputs,
            reads,
            fixed,
            gives,
        })
    }
}

impl SiteBody<f64> for SiteFunction {
    fn at(&self, arguments: &[Value<f64>], places: &mut Places<f64>) -> Evaluated<f64> {
        at_arguments((&self.parameters, &self.body), arguments, places)
    }

    fn advance(
        &self,
        places: &Places<f64>,
        [from, to]: [usize; 2],
        lists: &mut Lists<'_>,
    ) -> usize {
        let Some(form) = self.form.get_or_init(|| self.form()) else {
            return from;
        };
        let mut site = from;
        while site < to {
            let before = site;
            let fitting: Vec<Arc<SiteTape>> = {
                let tapes = self.tapes.read().unwrap_or_else(PoisonError::into_inner);
                tapes
                    .iter()
                    .rev()
                    .filter(|tape| tape.fits(places))
                    .cloned()
                    .collect()
            };
            // The newest tape runs as many sites as it can, older tapes the remaining ones.
            for (k, tape) in fitting.iter().enumerate() {
                let end = if k == 0 { to } else { to.min(site + 1) };
                site = tape.run(places, [site, end], lists).unwrap_or(site);
                if site > before {
                    break;
                }
            }
            if site > before {
                continue;
            }
            // Record in the middle, where neighbours exist, or at the site where a decision differs.
            let at = match fitting.first() {
                None => from + (to - from - 1) / 2,
                Some(tape) if tape.admits(places, site) => site,
                Some(_) => return site,
            };
            let made = (at + 1 < to)
                .then(|| self.recorded(form, places, at, lists))
                .flatten();
            let Some(tape) = made else {
                return site;
            };
            site = tape.run(places, [site, to], lists).unwrap_or(site);
            if site == before {
                return site;
            }
        }
        site
    }
}

/// A recording at one site.
struct SiteRecording {
    tape: clebsch_program::Tape,
    inputs: usize,
    /// Where inputs come from.
    reads: Vec<ReadValue>,
    /// The values that the tape assumes constant.
    fixed: Fixed,
    gives: Vec<Value<f64>>,
}
