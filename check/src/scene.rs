//! The values of names on one edge: the stored numbers of both nodes, and variations about them. Takes the model and
//! the numbers of a state; gives elements, velocities, fields, and advected quantities. The constraints of advected
//! quantities advect them from the stored to the varied configuration.

use crate::evaluate::{Evaluated, Here};
use crate::expression::Expression;
use crate::group::{Group, LEFT};
use crate::matrix::Matrix;
use crate::number::{Number, UNIT};
use crate::setup::{Numbers, Setup};
use crate::sites::range;
use crate::stated::{Quantity, Role, Side, Sites, Stated};
use crate::terms::Term;
use crate::value::Value;
use crate::varied::{field, small, stored, varied_element};
use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};

/// A quantity at a site: its name, and the site if it has any.
pub type Copy<'a> = (&'a str, Option<usize>);

/// The varied configurations.
#[derive(Clone, Debug, Default)]
pub struct Varied<'a> {
    /// Each with its first variable. The variables of the second node follow the variables of the first.
    pub first: BTreeMap<Copy<'a>, u32>,
    /// Whether configurations vary at the first node only.
    pub at_first_node_only: bool,
}

impl Varied<'_> {
    /// The first variable of a configuration, if it varies at this node.
    fn at(&self, node: usize, name: &str, site: Option<usize>) -> Option<u32> {
        match self.at_first_node_only && node > 0 {
            true => None,
            false => self.first.get(&(name, site)).copied(),
        }
    }
}

type Key<'a> = (&'a str, Option<usize>, i32, Option<usize>);

/// One edge.
pub struct Scene<'a> {
    /// The model.
    stated: &'a Stated,
    /// Sites, ends and constants.
    setup: &'a Setup,
    /// The numbers of both nodes.
    nodes: [&'a [f64]; 2],
    /// The varied configurations.
    varied: &'a Varied<'a>,
    /// Parameters of an end condition, at this site.
    local: Option<(&'a [String], usize)>,
    /// The range of sums over sites, while a constraint on sums is evaluated.
    sums: RefCell<Option<Option<Vec<i64>>>>,
    /// Whether configurations at the second node have the rounding of the increments that lead to them.
    is_of_a_step: bool,
    known: RefCell<HashMap<Key<'a>, Value>>,
}

impl<'a> Scene<'a> {
    /// An edge between two nodes.
    #[must_use]
    pub fn new(
        stated: &'a Stated,
        setup: &'a Setup,
        nodes: [&'a [f64]; 2],
        varied: &'a Varied<'a>,
    ) -> Self {
        Self {
            stated,
            setup,
            nodes,
            varied,
            local: None,
            sums: RefCell::new(None),
            is_of_a_step: false,
            known: RefCell::new(HashMap::new()),
        }
    }

    /// With the rounding of the increments in the configurations at the second node.
    #[must_use]
    pub fn of_a_step(mut self) -> Self {
        self.is_of_a_step = true;
        self
    }

    /// With the parameters of an end condition.
    #[must_use]
    pub fn with_end(mut self, names: &'a [String], site: usize) -> Self {
        self.local = Some((names, site));
        self
    }

    /// The model.
    #[must_use]
    pub fn stated(&self) -> &'a Stated {
        self.stated
    }

    /// Sets the range of sums: the given sites, or all sites of their letters. With `None`, a sum is the value at one
    /// site.
    pub fn sum_over(&self, over: Option<Option<Vec<i64>>>) {
        *self.sums.borrow_mut() = over;
    }

    /// The range of sums.
    #[must_use]
    pub fn summed_over(&self) -> Option<Option<Vec<i64>>> {
        self.sums.borrow().clone()
    }

    /// The indices over which a term is summed.
    #[must_use]
    pub fn range_of(&self, term: &Term) -> Vec<i64> {
        range(self.stated, self.setup, term).map_or_else(|| vec![0], Iterator::collect)
    }

    /// The value of a name.
    ///
    /// # Errors
    /// It is not known here.
    pub fn name(&self, n: &str, here: Here) -> Evaluated {
        if n == self.stated.step {
            // No time passes between the stored and the varied configuration.
            return Ok(Value::number(Number::exact(match here.carried {
                None => self.setup.h,
                Some(_) => 0.0,
            })));
        }
        if let Some((names, site)) = self.local
            && names.iter().any(|own| own == n)
        {
            return self.parameter(n, Some(site), false);
        }
        let velocity = self.stated.velocities.get_key_value(n);
        let element = velocity.map_or(n, |(_, element)| element.as_str());
        let Some((name, q)) = self.stated.quantities.get_key_value(element) else {
            return plain(n).ok_or_else(|| format!("`{n}` is unknown"));
        };
        let (site, turns) = self.site(q, here)?;
        let key_name = velocity.map_or(name.as_str(), |(own, _)| own.as_str());
        let key = (key_name, site, here.time, here.carried);
        if let Some(value) = self.known.borrow().get(&key) {
            return self.offset(q, turns, value.clone());
        }
        let value = match velocity {
            Some(_) => self.velocity(q, site, here),
            None => self.quantity(q, site, here),
        }?;
        self.known.borrow_mut().insert(key, value.clone());
        self.offset(q, turns, value)
    }

    /// The site of a quantity, and how many times its index has gone around the ring.
    fn site(&self, q: &Quantity, here: Here) -> Result<(Option<usize>, i64), String> {
        let Some((label, sites)) = q.at else {
            return Ok((None, 0));
        };
        let count = self.setup.sites(self.stated, label, sites);
        let size = i64::try_from(count).unwrap_or(i64::MAX);
        let back = i64::from(here.at_last && sites == Sites::Segments);
        let mut at = here.index - back;
        let mut turns = 0;
        if self.setup.periodic && self.stated.line == Some(label) && size > 0 {
            (turns, at) = (at.div_euclid(size), at.rem_euclid(size));
        }
        match usize::try_from(at).ok().filter(|s| *s < count) {
            Some(site) => Ok((Some(site), turns)),
            None => Err(format!("`{}` does not exist at site {at}", q.name)),
        }
    }

    fn offset(&self, q: &Quantity, turns: i64, value: Value) -> Evaluated {
        let Some(offset) = q.offset.as_ref().filter(|_| turns != 0) else {
            return Ok(value);
        };
        #[allow(clippy::cast_precision_loss)]
        let turns = Number::exact(turns as f64);
        let step = self
            .parameter(offset, None, false)?
            .map(|x| x.times(&turns));
        value
            .plus(&step)
            .ok_or_else(|| format!("the size of `{offset}` does not match"))
    }

    fn quantity(&self, q: &'a Quantity, site: Option<usize>, here: Here) -> Evaluated {
        let node = match (here.carried, here.time) {
            // Parameters are the same at every node.
            _ if matches!(q.role, Role::Parameter) => 0,
            (None, 0) => 0,
            (None, 1) => 1,
            (Some(node), 0 | 1) => node,
            _ => {
                return Err(format!("`{}` is taken at a node outside the step", q.name));
            }
        };
        let own = self.setup.observed(&q.name, site);
        let moves = here.carried.is_none() || here.time == 1;
        match (&q.role, own) {
            // Also a configuration that an end condition prescribes.
            (Role::Parameter, _) | (Role::Element(..) | Role::Field(_), None) => {
                self.parameter(&q.name, site, q.is_quaternion)
            }
            (Role::Element(group, side), Some(own)) => {
                let numbers = own.of(self.nodes[node]);
                let mut element = group
                    .element(*side, numbers, UNIT)
                    .ok_or_else(|| misread(&q.name))?;
                if let Some(before) = self.before(own, node) {
                    group.add_rounding_of_increment(&mut element, before, numbers);
                }
                let first = self.varied.at(node, &q.name, site).filter(|_| moves);
                Ok(Value::Known(match first {
                    Some(first) => {
                        varied_element(&element, *group, *side, first + of_node(*group, node))
                    }
                    None => element,
                }))
            }
            (Role::Field(layout), Some(own)) => {
                let first = self.varied.at(node, &q.name, site).filter(|_| moves);
                let numbers = own.of(self.nodes[node]);
                let first = first.map(|f| f + small(numbers.len() * node));
                let before = self.before(own, node);
                field(*layout, own, (before, numbers), first).ok_or_else(|| misread(&q.name))
            }
            (Role::Advected, Some(own)) => match (here.carried, here.time, &q.update) {
                (Some(_), 0, _) | (None, _, None) => {
                    Ok(stored(own, own.of(self.nodes[node]), q.is_quaternion))
                }
                // A quantity that no velocity advects is not varied. Its update may change it even in zero time, as `t
                // + 1` does.
                (None, _, Some(update)) if !self.is_taken_along(update) => {
                    Ok(stored(own, own.of(self.nodes[node]), q.is_quaternion))
                }
                (None, _, Some(update)) => self.value(
                    update,
                    Here {
                        time: 0,
                        index: site.map_or(here.index, |s| i64::try_from(s).unwrap_or(0)),
                        at_last: false,
                        carried: Some(node),
                    },
                ),
                _ => Err(format!("`{}` after a variation", q.name)),
            },
            (Role::Advected, None) => match &q.definition {
                Some(definition) => self.value(
                    definition,
                    Here {
                        index: site.map_or(here.index, |s| i64::try_from(s).unwrap_or(0)),
                        at_last: false,
                        ..here
                    },
                ),
                None => self.parameter(&q.name, site, q.is_quaternion),
            },
        }
    }

    /// The numbers from which an increment leads to a node.
    fn before(&self, own: &Numbers, node: usize) -> Option<&'a [f64]> {
        (self.is_of_a_step && node == 1).then(|| own.of(self.nodes[0]))
    }

    /// Whether an update contains a velocity.
    fn is_taken_along(&self, update: &Expression) -> bool {
        let mut velocities = self.stated.velocities.keys();
        velocities.any(|velocity| update.has(velocity))
    }

    /// The velocity of the edge by the stated constraint, or the velocity from the stored to the varied configuration.
    fn velocity(&self, q: &'a Quantity, site: Option<usize>, here: Here) -> Evaluated {
        let Role::Element(group, side) = &q.role else {
            return Err(format!("`{}` has no velocity", q.name));
        };
        let identity = Matrix::identity(group.rows());
        if here.time != 0 {
            return Err(format!(
                "the velocity of `{}` is taken at another edge",
                q.name
            ));
        }
        if self.setup.observed(&q.name, site).is_none() {
            return Ok(Value::Known(identity));
        }
        if let Some(node) = here.carried {
            let first = self.varied.at(node, &q.name, site);
            return Ok(Value::Known(match first {
                Some(first) => {
                    varied_element(&identity, *group, *side, first + of_node(*group, node))
                }
                None => identity,
            }));
        }
        let at = |time: i32| match self.quantity(q, site, Here { time, ..here })? {
            Value::Known(m) => Ok(m),
            Value::Open(_) => Err(misread(&q.name)),
        };
        let (start, end) = (at(0)?, at(1)?);
        let back = group.inverse(&start).ok_or_else(|| misread(&q.name))?;
        let product = match side {
            Side::Body => back.times(&end),
            Side::Space => end.times(&back),
        };
        product.map(Value::Known).ok_or_else(|| misread(&q.name))
    }

    /// A parameter, with the given value.
    fn parameter(&self, name: &str, site: Option<usize>, is_quaternion: bool) -> Evaluated {
        let found = self.setup.parameter(name, site);
        let (own, numbers) = found.ok_or_else(|| format!("`{name}` is missing"))?;
        if is_quaternion && numbers.len() == 4 {
            let unit = |i: usize, j: usize| {
                let (which, sign) = LEFT[i][j];
                Number::within(sign * numbers[which], UNIT)
            };
            return Ok(Value::Known(Matrix::from_entries(4, 4, unit)));
        }
        let entries = numbers.iter().map(|x| Number::exact(*x)).collect();
        Ok(Value::Known(Matrix::of_rows(own.rows, own.cols, entries)))
    }
}

fn misread(name: &str) -> String {
    format!("the number of entries of `{name}` does not match its shape")
}

/// The number of variables before the variables of a node.
fn of_node(group: Group, node: usize) -> u32 {
    small(group.basis().len() * node)
}

/// The constants of the language.
fn plain(n: &str) -> Option<Value> {
    if n == "Id" {
        return Some(Value::identity());
    }
    let direction: usize = n.strip_prefix('E')?.parse().ok()?;
    (1..=8)
        .contains(&direction)
        .then(|| Value::unit(direction - 1))
}
