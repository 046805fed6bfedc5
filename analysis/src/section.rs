//! Crossings of a surface g(z) = 0 by a trajectory.
//!
//! Steps of size theta h from the last node, with theta between 0 and 1, locate a change of sign of g. A located state
//! is thus a state of the method, and its error has the order of the method. Compare Henon, Physica D 5, 1982, who
//! changes the independent variable instead.
//!
//! Two crossings within one step leave the sign unchanged. They are found only with [`Section::rate`], which reveals a
//! turn of g within the step.

use crate::crossing::{Crossing, Direction, Section, SectionError, Sections};
use crate::error;
use crate::flow::Flow;
use crate::root::bracketed;

/// A node of the trajectory, or a state within a step.
#[derive(Clone)]
struct Node<S> {
    state: S,
    /// The number of steps up to the node; not an integer within a step.
    steps: f64,
    value: f64,
}

/// A node on the surface, and whether g grows there.
type Found<F> = (Node<<F as Flow>::State>, bool);

/// A located value beyond this part of the values at both nodes shows a jump of g. Rounding leaves less than 1e-9 of them, even after
/// cancellation of six digits.
const JUMP: f64 = 1e-3;

struct Search<'a, F: Flow> {
    flow: &'a F,
    h: f64,
    section: &'a Section<'a, F::State>,
}

impl<F: Flow> Search<'_, F> {
    /// The node after `theta` steps from a node.
    fn after(
        &self,
        from: &Node<F::State>,
        theta: f64,
    ) -> Result<Node<F::State>, SectionError<F::Error>> {
        let step = from.steps as usize;
        let state = self
            .flow
            .step(&from.state, theta * self.h)
            .map_err(|source| SectionError::Step { step, source })?;
        self.node(state, from.steps + theta)
    }

    fn node(&self, state: F::State, steps: f64) -> Result<Node<F::State>, SectionError<F::Error>> {
        let value = (self.section.value)(&state);
        error::finite("value of the section", &[value])?;
        Ok(Node {
            state,
            steps,
            value,
        })
    }

    /// The state on the surface between `a` and `b`, two values of theta with opposite signs of g.
    fn root(
        &self,
        from: &Node<F::State>,
        a: (f64, f64),
        b: (f64, f64),
    ) -> Result<Node<F::State>, SectionError<F::Error>> {
        let theta = bracketed(
            |theta| Ok::<_, SectionError<F::Error>>(self.after(from, theta)?.value),
            a,
            b,
        )?;
        self.after(from, theta)
    }

    /// The state within a step where g turns back towards zero, if it has crossed zero there.
    fn turn(
        &self,
        from: &Node<F::State>,
        to: &Node<F::State>,
    ) -> Result<Option<(f64, f64)>, SectionError<F::Error>> {
        let Some(rate) = self.section.rate else {
            return Ok(None);
        };
        let (start, end) = (self.h * rate(&from.state), self.h * rate(&to.state));
        if start * from.value >= 0.0 || end * to.value <= 0.0 {
            return Ok(None);
        }
        let slope = |theta: f64| {
            Ok::<_, SectionError<F::Error>>(self.h * rate(&self.after(from, theta)?.state))
        };
        let theta = bracketed(slope, (0.0, start), (1.0, end))?;
        let value = self.after(from, theta)?.value;
        Ok((value * from.value < 0.0).then_some((theta, value)))
    }

    /// The nodes on the surface within one step that begins with a value that is not zero.
    fn within(
        &self,
        from: &Node<F::State>,
        to: &Node<F::State>,
    ) -> Result<Vec<Found<F>>, SectionError<F::Error>> {
        let (start, end) = ((0.0, from.value), (1.0, to.value));
        let upward = from.value < 0.0;
        if from.value * to.value < 0.0 {
            let at = self.root(from, start, end)?;
            // Where g jumps, as at a pole, its sign changes without a zero.
            let is_zero = at.value.abs() <= JUMP * from.value.abs().min(to.value.abs());
            return Ok(if is_zero {
                vec![(at, upward)]
            } else {
                Vec::new()
            });
        }
        match self.turn(from, to)? {
            Some(turn) => Ok(vec![
                (self.root(from, start, turn)?, upward),
                (self.root(from, turn, end)?, !upward),
            ]),
            None => Ok(Vec::new()),
        }
    }
}

/// The first `count` crossings of a surface by a trajectory of at most `max_steps` steps of size `h`.
///
/// A start on the surface is not a crossing. A node on the surface is a crossing if g has opposite signs around it.
///
/// # Errors
///
/// An argument cannot be used, a step fails, or the trajectory does not cross the surface. Fewer crossings than `count` are no error; see
/// [`Sections::complete`].
pub fn sections<F: Flow>(
    flow: &F,
    start: &F::State,
    h: f64,
    section: &Section<'_, F::State>,
    count: usize,
    max_steps: usize,
) -> Result<Sections<F::State>, SectionError<F::Error>> {
    error::step_size(h)?;
    error::number("crossings", count, usize::MAX)?;
    error::number("steps", max_steps, usize::MAX)?;
    let search = Search { flow, h, section };
    let mut node = search.node(start.clone(), 0.0)?;
    let (mut least, mut largest) = (node.value, node.value);
    let mut crossings = Vec::new();
    let mut steps = 0;
    // The node on the surface that the trajectory has reached, and the sign of g before.
    let mut touched: Option<(Node<F::State>, f64)> = None;
    while steps < max_steps && crossings.len() < count {
        let next = search.after(&node, 1.0)?;
        steps += 1;
        (least, largest) = (least.min(next.value), largest.max(next.value));
        let mut found = Vec::new();
        if node.value != 0.0 && next.value == 0.0 {
            touched = Some((next.clone(), node.value));
        } else if node.value != 0.0 {
            found = search.within(&node, &next)?;
        } else if next.value != 0.0 {
            found.extend(
                touched
                    .take()
                    .filter(|(_, before)| before * next.value < 0.0)
                    .map(|(at, before)| (at, before < 0.0)),
            );
        }
        let counts = |upward: bool| match section.direction {
            Direction::Up => upward,
            Direction::Down => !upward,
            Direction::Both => true,
        };
        let found = found.into_iter().filter(|(_, upward)| counts(*upward));
        crossings.extend(found.map(|(at, upward)| Crossing {
            time: at.steps * h,
            state: at.state,
            value: at.value,
            upward,
        }));
        node = next;
    }
    crossings.truncate(count);
    match crossings.is_empty() {
        true => Err(SectionError::Never {
            steps,
            least,
            largest,
        }),
        false => Ok(Sections {
            complete: crossings.len() == count,
            crossings,
            steps,
        }),
    }
}
