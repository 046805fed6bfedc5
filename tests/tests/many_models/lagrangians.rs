//! Random Lagrangians of a rotation, in two halves that run side by side.

use super::common::lagrangians::agree_and_their_mutants_do_not;
use clebsch_oracle::oracle::action::Side;
use clebsch_oracle::oracle::random::RandomLagrangian;
use clebsch_oracle::oracle::random::tree::{Kind, Role};

/// Well beyond a hundred of them have advected vectors or symmetric matrices.
const LAGRANGIANS: u64 = 160;

#[test]
fn of_even_seeds() {
    agree_and_their_mutants_do_not((0..LAGRANGIANS).step_by(2));
}

#[test]
fn of_odd_seeds() {
    agree_and_their_mutants_do_not((1..LAGRANGIANS).step_by(2));
}

#[test]
fn more_than_a_hundred_carry_vectors_or_symmetric_matrices() {
    let (mut vectors, mut matrices, mut either, mut spatial) = (0, 0, 0, 0);
    for seed in 0..LAGRANGIANS {
        let lagrangian = RandomLagrangian::of_seed(seed);
        let carries = |kind: Kind| {
            lagrangian
                .symbols
                .iter()
                .enumerate()
                .any(|(index, symbol)| {
                    symbol.kind == kind
                        && matches!(symbol.role, Role::Advected { .. })
                        && lagrangian.uses(index)
                })
        };
        let (vector, matrix) = (carries(Kind::Vector), carries(Kind::Symmetric));
        vectors += usize::from(vector);
        matrices += usize::from(matrix);
        either += usize::from(vector || matrix);
        spatial += usize::from(lagrangian.side == Side::Space);
    }
    println!("vectors {vectors}, symmetric {matrices}, either {either}, spatial {spatial}");
    assert!(either >= 100 && vectors >= 50 && matrices >= 50 && spatial >= 20);
}
