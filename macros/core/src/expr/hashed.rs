//! Hashes of expressions. Each hash is computed once, when the expression is created, and uses whole words, since the
//! macro's engine is compiled without optimisation. Gives maps and sets of expressions that use these hashes. They
//! are looked up, never iterated.

use super::Expr;
use core::hash::{BuildHasherDefault, Hasher};
use std::collections::{HashMap, HashSet};

/// A map whose keys are expressions.
pub(crate) type Hashed<V> = HashMap<Expr, V, BuildHasherDefault<Words>>;

/// A set of expressions.
pub(crate) type Exprs = HashSet<Expr, BuildHasherDefault<Words>>;

/// A fixed hash: equal on every machine and in every run.
#[derive(Default)]
pub(crate) struct Words(u64);

impl Words {
    fn word(&mut self, x: u64) {
        self.0 = (self.0.rotate_left(5) ^ x).wrapping_mul(0x517c_c1b7_2722_0a95);
    }
}

impl Hasher for Words {
    fn finish(&self) -> u64 {
        // Hash tables use the lowest and the highest bits.
        self.0 ^ self.0 >> 29
    }

    fn write(&mut self, bytes: &[u8]) {
        for b in bytes {
            self.word(u64::from(*b));
        }
    }

    fn write_u8(&mut self, x: u8) {
        self.word(u64::from(x));
    }

    fn write_u32(&mut self, x: u32) {
        self.word(u64::from(x));
    }

    fn write_u64(&mut self, x: u64) {
        self.word(x);
    }

    fn write_u128(&mut self, x: u128) {
        self.word(x as u64);
        self.word((x >> 64) as u64);
    }

    fn write_usize(&mut self, x: usize) {
        self.word(x as u64);
    }

    fn write_i8(&mut self, x: i8) {
        self.word(x as u64);
    }

    fn write_i64(&mut self, x: i64) {
        self.word(x as u64);
    }

    fn write_i128(&mut self, x: i128) {
        self.write_u128(x as u128);
    }

    fn write_isize(&mut self, x: isize) {
        self.word(x as u64);
    }
}
