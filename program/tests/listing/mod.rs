//! Listings of random tapes, read back line by line and evaluated: the results agree with the tapes bit for bit.

use crate::random_tapes::{FUNCTIONS, INPUTS, Random, computed, random_tape, same};
use clebsch_program::Machine;
use std::collections::BTreeMap;

/// Number of random tapes.
const TAPES: u64 = 300;

/// The values of a listing by their names.
struct Evaluated {
    of: BTreeMap<String, f64>,
    /// Whether all decisions hold.
    holds: bool,
}

impl Evaluated {
    fn at(&self, name: &str) -> f64 {
        let known = self.of.get(name).copied();
        known.unwrap_or_else(|| name.parse().expect("a name or a number"))
    }

    fn expression(&self, text: &str) -> f64 {
        if let Some(x) = text.strip_suffix(" > 0, otherwise 0") {
            let (value, sign) = x.split_once(" if ").expect("a condition");
            return if self.at(sign) > 0.0 {
                self.at(value)
            } else {
                0.0
            };
        }
        let calls = FUNCTIONS.iter().find_map(|f| {
            let inner = text.strip_prefix(f.word())?.strip_prefix('(')?;
            Some(f.of(self.at(inner.strip_suffix(')')?)))
        });
        if let Some(x) = calls {
            return x;
        }
        match text.split(' ').collect::<Vec<_>>().as_slice() {
            [a, "+", b] => self.at(a) + self.at(b),
            [a, "-", b] => self.at(a) - self.at(b),
            [a, "*", b] => self.at(a) * self.at(b),
            [a, "/", b] => self.at(a) / self.at(b),
            [a] => -self.at(a.strip_prefix('-').expect("a sign")),
            _ => panic!("cannot read `{text}`"),
        }
    }

    fn test(&self, text: &str) -> bool {
        let (a, rest) = text.split_once(' ').expect("a test");
        let x = self.at(a);
        let of = |word: &str| rest.strip_prefix(word).map(|b| self.at(b));
        let not = |holds: bool| !holds;
        let tests = [
            of("<= ").map(|y| x <= y),
            of("is not <= ").map(|y| not(x <= y)),
            of("< ").map(|y| x < y),
            of("is not < ").map(|y| not(x < y)),
            of("= ").map(|y| x == y),
            of("differs from ").map(|y| x != y),
        ];
        let known = tests.into_iter().flatten().next();
        known.unwrap_or_else(|| x.is_finite() == (rest == "is finite"))
    }

    fn line(&mut self, line: &str) {
        if let Some(test) = line.strip_prefix("only if ") {
            self.holds &= self.test(test);
        } else if let Some((name, value)) = line.split_once(" := ") {
            self.of.insert(name.to_owned(), self.at(value));
        } else if let Some((names, value)) = line.split_once(" = ") {
            match value.strip_prefix("call of ") {
                // The function of the random tapes: sums of neighbours.
                Some(all) => {
                    let x: Vec<f64> = all.split(", ").map(|name| self.at(name)).collect();
                    for (i, name) in names.split(", ").enumerate() {
                        self.of.insert(name.to_owned(), x[i] + x[(i + 1) % x.len()]);
                    }
                }
                None => {
                    let x = self.expression(value);
                    self.of.insert(names.to_owned(), x);
                }
            }
        }
    }
}

#[test]
fn a_listing_has_the_bits_of_its_tape() {
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    let names: Vec<String> = (0..INPUTS).map(|i| format!("in{i}")).collect();
    for _ in 0..TAPES {
        let tape = random_tape(&mut random);
        let machine = Machine::new(&tape, INPUTS);
        let listing = machine.listing(&names, &[]);
        let operations = machine.counts().operations();
        assert_eq!(operations, machine.operations());
        for _ in 0..4 {
            let inputs: Vec<f64> = (0..INPUTS).map(|_| random.number()).collect();
            let (outputs, holds) = computed(&tape, &inputs);
            let of = names.iter().cloned().zip(inputs.iter().copied()).collect();
            let mut own = Evaluated { of, holds: true };
            listing.lines().for_each(|line| own.line(line));
            assert_eq!(own.holds, holds, "{listing}");
            for (i, wanted) in outputs.iter().enumerate() {
                let found = own.at(&format!("y{i}"));
                assert!(same(found, *wanted), "output {i} of {listing}");
            }
        }
    }
}
