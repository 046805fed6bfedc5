//! A tape of sites and how it runs: numbers are loaded from lists, computed side by side and stored in lists.

use super::load::{column, extend, fill, numbers_of, store};
use super::{Lists, SiteRecording};
use crate::code::{Code, Places};
use crate::listing::{FieldNames, Section, numbered};
use crate::map_scalar::alike;
use crate::recorded::form::{is_same, stands};
use crate::recorded::loop_inputs::{Fixed, InputSource, List};
use crate::recorded::tape_storage::Pool;
use crate::sites::Column;
use crate::value::Value;
use clebsch_program::{Frame, Machine, WIDTH};

/// At most this many sites are run one by one.
const FEW: usize = 8;

/// A value that is read: its kind, and which of its components enter which inputs.
#[derive(Debug)]
struct Source<F> {
    from: F,
    kind: Value<f64>,
    components: Vec<(usize, usize)>,
}

/// The place of a value that is the same for all sites.
#[derive(Debug)]
enum ConstantPlace {
    Around(Code<f64>),
    Of(List, usize),
}

/// A tape of sites.
#[derive(Debug)]
pub struct SiteTape {
    machine: Machine,
    steady: Vec<Source<ConstantPlace>>,
    /// Values of a list at this distance from the site of the loop.
    moving: Vec<Source<(List, isize)>>,
    fixed: Fixed,
    gives: Vec<Value<f64>>,
    frames: Pool<Frames>,
}

type Frames = (Frame<1>, Frame<WIDTH>);

impl SiteTape {
    /// The tape of recordings at two sites; `None` if the recordings differ. If the body `clamps` sites to a list, a
    /// list that is read at one site must have one.
    pub fn of(
        [here, there]: [usize; 2],
        [first, second]: [SiteRecording; 2],
        clamps: bool,
    ) -> Option<Self> {
        let values = first.gives.iter().zip(&second.gives);
        let same_kinds =
            first.gives.len() == second.gives.len() && values.clone().all(|(a, b)| alike(a, b));
        let same = first.tape == second.tape && first.reads.len() == second.reads.len();
        if !(same && same_kinds) {
            return None;
        }
        let machine = Machine::new(&first.tape, first.inputs);
        let (mut steady, mut moving) = (Vec::new(), Vec::new());
        for (a, b) in first.reads.into_iter().zip(second.reads) {
            if a.first != b.first || !alike(&a.kind, &b.kind) {
                return None;
            }
            let inputs = (0..a.count).map(|component| (a.first + component, component));
            let components: Vec<_> = inputs.filter(|(input, _)| machine.reads(*input)).collect();
            let kind = a.kind;
            let (from, off) = match (a.from, b.from) {
                (InputSource::Around(path), InputSource::Around(_)) => {
                    (ConstantPlace::Around(path), None)
                }
                (InputSource::Of(list, site, alone), InputSource::Of(other, second, _)) => {
                    let paths = match (&list.path, &other.path) {
                        (Some(a), Some(b)) => is_same(a, b),
                        (None, None) => true,
                        _ => false,
                    };
                    if !paths || list.fields != other.fields {
                        return None;
                    }
                    let off = isize::try_from(site).ok()? - isize::try_from(here).ok()?;
                    match (second + here == site + there, second == site) {
                        (true, _) => (ConstantPlace::Of(list, site), Some(off)),
                        (_, true) if alone || !clamps => (ConstantPlace::Of(list, site), None),
                        _ => return None,
                    }
                }
                _ => return None,
            };
            if components.is_empty() {
                continue;
            }
            match (from, off) {
                (ConstantPlace::Of(list, _), Some(off)) => moving.push(Source {
                    from: (list, off),
                    kind,
                    components,
                }),
                (from, _) => steady.push(Source {
                    from,
                    kind,
                    components,
                }),
            }
        }
        Some(SiteTape {
            machine,
            steady,
            moving,
            fixed: first.fixed,
            gives: first.gives,
            frames: Pool::new(),
        })
    }

    /// The operations at one site as text.
    pub fn section(&self, title: &str, names: &FieldNames) -> Section {
        let mut inputs = numbered("unused", self.machine.inputs());
        let mut name = |kind: &Value<f64>, path: &str, components: &[(usize, usize)]| {
            let mut own = Vec::new();
            names.numbers(path, kind, &mut own);
            for (input, component) in components {
                if let (Some(slot), Some(name)) = (inputs.get_mut(*input), own.get(*component)) {
                    slot.clone_from(name);
                }
            }
        };
        for source in &self.steady {
            let path = match &source.from {
                ConstantPlace::Around(path) => names.path(path),
                ConstantPlace::Of(list, site) => format!("{}[{site}]", names.list(list)),
            };
            name(&source.kind, &path, &source.components);
        }
        for source in &self.moving {
            let (list, off) = &source.from;
            let list = names.list(list);
            let path = match off {
                0 => format!("{list}[k]"),
                off => format!("{list}[k{off:+}]"),
            };
            name(&source.kind, &path, &source.components);
        }
        let outputs = numbered("result", self.machine.outputs());
        Section::of(title, &self.machine, &inputs, &outputs)
    }

    /// Whether the values that the tape assumes constant are unchanged.
    pub fn fits(&self, places: &Places<f64>) -> bool {
        stands(&self.fixed, places)
    }

    /// Whether all neighbours that the tape reads exist at a site.
    pub fn admits(&self, places: &Places<f64>, site: usize) -> bool {
        self.admitted(places, site, site + 1).is_some()
    }

    /// Runs the sites from `from` to `to - 1`; returns the next site that needs the body.
    pub fn run(
        &self,
        places: &Places<f64>,
        sites: [usize; 2],
        lists: &mut Lists<'_>,
    ) -> Option<usize> {
        let frames = || (self.machine.frame(), self.machine.frame());
        self.frames
            .with(frames, |frames| self.run_in(places, sites, lists, frames))
    }

    fn run_in(
        &self,
        places: &Places<f64>,
        [from, to]: [usize; 2],
        lists: &mut Lists<'_>,
        (one, wide): &mut Frames,
    ) -> Option<usize> {
        let Some(to) = self.admitted(places, from, to) else {
            return Some(from);
        };
        self.load_steady(places, one.inputs())?;
        if to - from > FEW {
            self.load_steady(places, wide.inputs())?;
        }
        let mut site = from;
        while site < to {
            let count = (to - site).min(WIDTH);
            if count > FEW {
                self.load(places, lists, [site, count], wide.inputs())?;
                if clebsch_lanes::run(&self.machine, wide) {
                    let output = |which| self.machine.output(wide, which).as_slice();
                    self.store(lists, [site, count], &output)?;
                    site += count;
                    continue;
                }
            }
            for _ in 0..count {
                self.load(places, lists, [site, 1], one.inputs())?;
                if !self.machine.run(one) {
                    return Some(site);
                }
                let output = |which| self.machine.output(one, which).as_slice();
                self.store(lists, [site, 1], &output)?;
                site += 1;
            }
        }
        Some(to)
    }

    /// The end of the sites with all neighbours; `None` if the first site lacks one.
    fn admitted(&self, places: &Places<f64>, from: usize, to: usize) -> Option<usize> {
        let mut end = to;
        for source in &self.moving {
            let (list, off) = &source.from;
            from.checked_add_signed(*off)?;
            if let Some(column) = column(list, places) {
                end = end.min(column.len().checked_add_signed(-*off)?);
            }
        }
        (from < end).then_some(end)
    }

    fn load_steady<const L: usize>(
        &self,
        places: &Places<f64>,
        inputs: &mut [[f64; L]],
    ) -> Option<()> {
        let mut own = Vec::new();
        for source in &self.steady {
            match &source.from {
                ConstantPlace::Around(path) => {
                    numbers_of(path.place(places)?, &source.kind, &mut own)?;
                }
                ConstantPlace::Of(list, site) => {
                    let value = column(list, places)?.get(*site)?;
                    numbers_of(&value, &source.kind, &mut own)?;
                }
            }
            for (input, component) in &source.components {
                *inputs.get_mut(*input)? = [*own.get(*component)?; L];
            }
        }
        Some(())
    }

    fn load<const L: usize>(
        &self,
        places: &Places<f64>,
        lists: &Lists<'_>,
        [site, count]: [usize; 2],
        inputs: &mut [[f64; L]],
    ) -> Option<()> {
        for source in &self.moving {
            let (list, off) = &source.from;
            let from = site.checked_add_signed(*off)?;
            let column: &Column<f64> = match (&list.path, &lists.kept) {
                (None, Some((kept, _))) => kept,
                _ => column(list, places)?,
            };
            fill(
                column,
                &source.kind,
                [from, count],
                &source.components,
                inputs,
            )?;
        }
        Some(())
    }

    fn store<'a>(
        &self,
        lists: &mut Lists<'_>,
        [site, count]: [usize; 2],
        output: &impl Fn(usize) -> &'a [f64],
    ) -> Option<()> {
        let mut next = 0;
        let mut gives = self.gives.iter();
        for (column, from) in [&mut lists.out, &mut lists.kept].into_iter().flatten() {
            let sites = [*from + site, count];
            store(column, sites, gives.next()?, &mut next, output)?;
        }
        if let Some(column) = &mut lists.gathered {
            let (kind, from) = (gives.next()?, column.len());
            extend(column, count, kind)?;
            store(column, [from, count], kind, &mut next, output)?;
        }
        Some(())
    }
}
