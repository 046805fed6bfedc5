//! The values around a loop over the recording scalar. Each number becomes an input, and its origin is noted.

use crate::code::{Code, Places};
use crate::map_scalar::{map_scalar, numbers};
use crate::recorded::Traced;
use crate::sites::{Column, TrackedList};
use crate::value::{Struct, Value};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// A list, or a field of the entries of a list.
#[derive(Clone, Debug)]
pub struct List {
    /// The path, or `None` for the list that the loop updates.
    pub path: Option<Code<f64>>,
    /// The field, as a path of nested fields.
    pub fields: Vec<usize>,
}

/// A value that was read.
#[derive(Clone, Debug)]
pub struct ReadValue {
    /// The source of the value.
    pub from: InputSource,
    /// Its first input.
    pub first: usize,
    /// How many inputs it has.
    pub count: usize,
    /// A value of the same kind.
    pub kind: Value<f64>,
}

/// The source of a value.
#[derive(Clone, Debug)]
pub enum InputSource {
    /// A value at a path outside the loop.
    Around(Code<f64>),
    /// A value at a site of a list. The flag tells whether the list has only this site.
    Of(List, usize, bool),
}

#[derive(Debug, Default)]
struct Log {
    reads: Vec<ReadValue>,
    inputs: usize,
}

impl Log {
    /// The numbers of a value as inputs, from the next one on.
    fn read(&mut self, from: InputSource, value: &Value<f64>) -> Option<Value<Traced>> {
        let mut own = Vec::new();
        numbers(value, &mut own)?;
        let made = map_scalar(value, &mut Traced::input)?;
        self.reads.push(ReadValue {
            from,
            first: self.inputs,
            count: own.len(),
            kind: value.clone(),
        });
        self.inputs += own.len();
        Some(made)
    }
}

/// The largest distance from its own site at which a body may read.
const NEAR: usize = 8;

/// A list that notes which of its values are read.
#[derive(Debug)]
struct Leaf {
    list: List,
    len: usize,
    /// Values near the site of the loop, and at both ends.
    near: BTreeMap<usize, Value<f64>>,
    known: Mutex<BTreeMap<usize, Value<Traced>>>,
    log: Arc<Mutex<Log>>,
}

impl TrackedList<Traced> for Leaf {
    fn len(&self) -> usize {
        self.len
    }

    fn at(&self, site: usize) -> Option<Value<Traced>> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(value) = known.get(&site) {
            return Some(value.clone());
        }
        let value = self.near.get(&site)?;
        let mut log = self.log.lock().unwrap_or_else(PoisonError::into_inner);
        let made = log.read(
            InputSource::Of(self.list.clone(), site, self.len == 1),
            value,
        )?;
        known.insert(site, made.clone());
        Some(made)
    }
}

/// Values at paths that a tape assumes constant, except for their numbers.
pub type Fixed = Vec<(Code<f64>, Value<f64>)>;

/// Provides what a body reads at one site.
pub struct SiteReader {
    site: usize,
    log: Arc<Mutex<Log>>,
    fixed: Fixed,
}

impl SiteReader {
    /// A reader for this site.
    pub fn new(site: usize) -> Self {
        SiteReader {
            site,
            log: Arc::default(),
            fixed: Vec::new(),
        }
    }

    /// The values that were read, and the values that the tape assumes constant; for a list, its length.
    pub fn into_reads(self) -> (Vec<ReadValue>, Fixed) {
        let mut log = self.log.lock().unwrap_or_else(PoisonError::into_inner);
        (std::mem::take(&mut log.reads), self.fixed)
    }

    /// Reads a value as inputs.
    pub fn read(&self, from: InputSource, value: &Value<f64>) -> Option<Value<Traced>> {
        let mut log = self.log.lock().unwrap_or_else(PoisonError::into_inner);
        log.read(from, value)
    }

    /// Puts the value of a path into the places of the body. Structs along the path contain nothing else.
    pub fn provide(
        &mut self,
        path: &Code<f64>,
        places: &Places<f64>,
        own: &mut Places<Traced>,
    ) -> Option<()> {
        let value = path.place(places)?;
        let made = self.value(path, value)?;
        *slot(path, places, own)? = made;
        Some(())
    }

    /// The value that the loop stores at a site.
    pub fn kept(&self, column: &Column<f64>, site: usize) -> Option<Value<Traced>> {
        let list = List {
            path: None,
            fields: Vec::new(),
        };
        self.read(InputSource::Of(list, site, false), &column.get(site)?)
    }

    fn value(&mut self, path: &Code<f64>, value: &Value<f64>) -> Option<Value<Traced>> {
        match value {
            Value::Sites(column) => {
                let count = i64::try_from(column.len()).ok()?;
                self.fixed.push((path.clone(), Value::Int(count)));
                let list = List {
                    path: Some(path.clone()),
                    fields: Vec::new(),
                };
                Some(Value::Sites(self.column(&list, column)?))
            }
            // The body need not read every field.
            Value::Struct(s) => {
                let mut values = Vec::new();
                for (name, value) in s.layout.fields.iter().zip(&s.values) {
                    let path = Code::Field(Box::new(path.clone()), *name);
                    values.push(self.value(&path, value).unwrap_or(Value::Unit));
                }
                Some(Value::Struct(Struct {
                    layout: s.layout.clone(),
                    values,
                }))
            }
            value => {
                let made = self.read(InputSource::Around(path.clone()), value)?;
                self.fixed.push((path.clone(), value.clone()));
                Some(made)
            }
        }
    }

    fn column(&self, list: &List, column: &Column<f64>) -> Option<Column<Traced>> {
        if let Column::Structs(layout, fields, count) = column {
            let field = |(at, field): (usize, &Column<f64>)| {
                let mut list = list.clone();
                list.fields.push(at);
                self.column(&list, field)
            };
            let fields = fields.iter().enumerate().map(field);
            let fields = fields.collect::<Option<_>>()?;
            return Some(Column::Structs(layout.clone(), fields, *count));
        }
        let near = self.site.saturating_sub(NEAR)..(self.site + NEAR).min(column.len());
        let sites = near.chain([0, column.len().saturating_sub(1)]);
        let near = sites.filter_map(|site| Some((site, column.get(site)?)));
        Some(Column::Tracked(Arc::new(Leaf {
            list: list.clone(),
            len: column.len(),
            near: near.collect(),
            known: Mutex::default(),
            log: self.log.clone(),
        })))
    }
}

fn slot<'a>(
    path: &Code<f64>,
    places: &Places<f64>,
    own: &'a mut Places<Traced>,
) -> Option<&'a mut Value<Traced>> {
    match path {
        Code::Place(at) => own.get_mut(*at),
        Code::Field(base, name) => {
            let Value::Struct(there) = base.place(places)? else {
                return None;
            };
            let above = slot(base, places, own)?;
            if !matches!(above, Value::Struct(_)) {
                *above = Value::Struct(Struct {
                    layout: there.layout.clone(),
                    values: vec![Value::Unit; there.values.len()],
                });
            }
            match above {
                Value::Struct(s) => s.field_mut(*name),
                _ => None,
            }
        }
        _ => None,
    }
}
