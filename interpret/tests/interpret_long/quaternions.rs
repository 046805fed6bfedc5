//! Chains in unit quaternions that run from their text, with any initial signs. Every number equals the number from the
//! compiled stepper bit for bit, and the number from the expanded bodies to rounding.

use crate::comparison::{self, choice, values};
use crate::compiled::{Case, quaternions};
use clebsch::card::Settings;
use clebsch_interpret::lines::LineModel;

#[test]
fn lines_in_quaternions_equal_the_compiled_ones_to_the_last_bit() {
    comparison::equal_to_the_last_bit(quaternions::all());
}

/// Long, since every line is derived body by body.
#[test]
fn lines_in_quaternions_move_as_their_bodies_do() {
    comparison::move_as_bodies_do(quaternions::all(), 5);
}

#[test]
fn a_line_in_quaternions_is_written_down_and_goes_on_to_the_last_bit() {
    comparison::go_on(quaternions::all());
}

#[test]
fn a_term_that_is_left_out_is_seen() {
    let all = quaternions::all();
    let rod = (quaternions::ROD, "\n        - (2*h/s)*dot(U, K*U)", "");
    let spins = (all[1].source, "(4*c*h/s)*re(U)", "0");
    for (source, term, rest) in [rod, spins] {
        comparison::another_term_is_seen(&all, source, term, rest);
    }
}

/// Attitudes that turn once around a ring: the compiled chain, the interpreted chain and the expanded bodies give the same error.
#[test]
fn an_odd_number_of_turns_around_a_ring_is_told_alike() {
    let [_, own] = quaternions::all();
    let source = own.source;
    let model = LineModel::read(source).expect("is read");
    let case = Case::new(12, None);
    let data = (own.data)(&case);
    for (turns, is_told) in [(1.0, true), (2.0, false)] {
        let once = data.with("q", |q| {
            for (i, q) in q.chunks_mut(4).enumerate() {
                let half = std::f64::consts::PI * turns * i as f64 / 12.0;
                q.copy_from_slice(&[half.cos(), half.sin(), 0.0, 0.0]);
            }
        });
        let chosen = choice(source, case.n, case.ends);
        let built = (own.make)(&case, &once).err();
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
