//! Calls of the model's functionals: arguments, then directions ordered by their arguments, then the seed.

use super::Lowering;
use crate::expr::{Applied, Expr};
use clebsch_program::{Call, Operation, Value};

impl Lowering<'_> {
    pub(super) fn functional(&mut self, e: &Expr, a: &Applied, back: Option<(u8, &Expr)>) -> Value {
        let mut along: Vec<&(u8, Expr)> = a.along.iter().collect();
        along.sort_by_key(|(which, _)| *which);
        let directions = along.iter().map(|(_, x)| x);
        let all = a.arguments.iter().chain(directions);
        let all: Vec<&Expr> = all.chain(back.map(|(_, seed)| seed)).collect();
        let values = all.into_iter().map(|x| self.value(x)).collect();
        self.push(Operation::Functional(Call {
            functional: a.functional.0 as usize,
            arguments: a.arguments.len(),
            along: along.iter().map(|(which, _)| *which).collect(),
            back: back.map(|(which, _)| which),
            values,
            shape: e.shape(),
        }))
    }
}
