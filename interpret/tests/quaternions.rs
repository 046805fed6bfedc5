//! Lines in unit quaternions that run from their text: every number equals, to the last bit, that of the stepper which
//! is compiled, and to rounding that of the bodies written out, whatever the signs with which they start.

#![allow(missing_docs, mixed_script_confusables)]

#[allow(dead_code)]
#[path = "lines/beside.rs"]
mod beside;
#[allow(dead_code)]
#[path = "lines/compiled.rs"]
mod compiled;

use beside::{bits, choice, start, values};
use clebsch::card::Settings;
use clebsch_interpret::lines::LineModel;
use compiled::{Case, quaternions};

#[test]
fn lines_in_quaternions_equal_the_compiled_ones_to_the_last_bit() {
    beside::equal_to_the_last_bit(quaternions::all().into_iter());
}

#[test]
fn lines_in_quaternions_move_as_their_bodies_do() {
    beside::move_as_bodies_do(quaternions::all().into_iter(), 5);
}

#[test]
fn a_line_in_quaternions_is_written_down_and_goes_on_to_the_last_bit() {
    beside::go_on(quaternions::all().into_iter());
}

#[test]
fn a_term_that_is_left_out_is_seen() {
    let rod = (quaternions::ROD, "\n        - (2*h/s)*dot(U, K*U)", "");
    let own = quaternions::all().into_iter().next_back().expect("a line");
    for (source, term, rest) in [rod, (own.0, "(4 * c * h / s) * re (U)", "0")] {
        let mutated = match source.contains(term) {
            true => source.replacen(term, rest, 1),
            false => source.replacen("(4*c*h/s)*re(U)", "0", 1),
        };
        assert_ne!(mutated, source, "{term}");
        let model = LineModel::read(&mutated).expect("is read");
        let all = quaternions::all();
        let found = all.iter().find(|(own, ..)| *own == source);
        let (_, make, _) = found.expect("is here");
        let case = Case::new(5, Some(["free", "free"]));
        let (mut built, data) = make(&case);
        let mut line = start(&model, &mutated, &case, &data);
        for _ in 0..3 {
            built.step().expect("steps");
            line.step().expect("steps");
        }
        let differs = model.observers().any(|name| {
            let read = line.observe(&name).expect("is observed");
            bits(&read) != bits(&built.seen(&name))
        });
        assert!(differs, "{term}");
    }
}

/// Attitudes that turn once around a ring: told alike by the built line, the one that is read and its bodies.
#[test]
fn an_odd_number_of_turns_around_a_ring_is_told_alike() {
    let (source, make, _) = quaternions::all().into_iter().next_back().expect("a line");
    let model = LineModel::read(source).expect("is read");
    let case = Case::new(12, None);
    let (_, data) = make(&case);
    for (turns, is_told) in [(1.0, true), (2.0, false)] {
        let once = data.with("q", |q| {
            for (i, q) in q.chunks_mut(4).enumerate() {
                let half = std::f64::consts::PI * turns * i as f64 / 12.0;
                q.copy_from_slice(&[half.cos(), half.sin(), 0.0, 0.0]);
            }
        });
        let chosen = choice(source, case.n, case.ends);
        let built = quaternions::twisted_of(&case, &once).err();
        let read = model.start(&chosen, case.h, &|name| once.get(name));
        let read = read.err().map(|e| e.to_string());
        assert_eq!(read, built, "{turns}");
        let (card, _) =
            clebsch_interpret::card_on_lattice(source, &chosen).expect("is written out");
        let (parameters, initial) = (values(card.parameters, &once), values(card.initial, &once));
        let bodies = (card.open)(&parameters, &initial, Settings::step(case.h));
        let bodies = bodies.err().map(|e| e.to_string());
        for told in [built, bodies] {
            assert_eq!(told.is_some(), is_told, "{turns}: {told:?}");
            let told = told.unwrap_or_else(|| "an odd number of turns".to_owned());
            assert!(told.contains("an odd number of turns"), "{told}");
        }
    }
}
