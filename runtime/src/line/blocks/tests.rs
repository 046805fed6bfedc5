//! Solutions multiplied by their matrix: arrays and lists, open chains and rings, blocks that need pivots.

use super::{Blocks, Fixed};

/// Numbers between -1/2 and 1/2.
fn drawn(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005);
    *state = state.wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
}

/// A matrix whose diagonal blocks are `own` plus small numbers, as blocks and as a dense matrix, row by row.
fn made<const N: usize>(
    sites: usize,
    ring: bool,
    own: impl Fn(usize, usize) -> f64,
) -> (Blocks<f64>, Vec<Vec<f64>>) {
    let mut state = 7;
    let mut blocks = Blocks::new(N, sites, ring);
    let mut dense = vec![vec![0.0; N * sites]; N * sites];
    for row in 0..sites {
        let after = if row + 1 < sites { row + 1 } else { 0 };
        let before = if row > 0 { row - 1 } else { sites - 1 };
        for column in [row, after, before] {
            if column != row && !ring && column.abs_diff(row) > 1 {
                continue;
            }
            let block: [[f64; N]; N] = core::array::from_fn(|j| {
                core::array::from_fn(|i| {
                    let whole = if row == column { own(i, j) } else { 0.0 };
                    whole + 0.2 * drawn(&mut state)
                })
            });
            blocks.add_block(row, column, &block);
            for (j, list) in block.iter().enumerate() {
                for (i, x) in list.iter().enumerate() {
                    dense[N * row + i][N * column + j] += x;
                }
            }
        }
    }
    (blocks, dense)
}

/// The largest residual of a solution, and of a second solution with the same factors.
fn residual<const N: usize>(
    (blocks, dense): &mut (Blocks<f64>, Vec<Vec<f64>>),
    lists: bool,
) -> f64 {
    let mut state = 3;
    let mut worst = 0.0_f64;
    for again in [false, true] {
        let known: Vec<f64> = dense.iter().map(|_| drawn(&mut state)).collect();
        let mut x = known.clone();
        match (lists, again) {
            (true, false) => {
                blocks.factor_lists(N, 1e-12).expect("pivots");
                blocks.solve_lists(N, &mut x);
            }
            (true, true) => blocks.solve_lists(N, &mut x),
            (false, false) => {
                (blocks.factor_and_solve(Fixed::<N>, 1e-12, &mut x)).expect("pivots");
            }
            (false, true) => blocks.solve(Fixed::<N>, &mut x),
        }
        for (row, known) in dense.iter().zip(&known) {
            let sum: f64 = row.iter().zip(&x).map(|(a, x)| a * x).sum();
            worst = worst.max((sum - known).abs());
        }
    }
    worst
}

fn all<const N: usize>() {
    let diagonal = |i: usize, j: usize| if i == j { 2.0 + i as f64 } else { 0.0 };
    // Columns nearly alike: only pivots will do.
    let alike = |i: usize, j: usize| 3.0 + if i == j { 0.3 } else { 0.0 };
    for sites in [1, 2, 3, 7] {
        for ring in [false, true] {
            for lists in [false, true] {
                let straight = residual::<N>(&mut made::<N>(sites, ring, diagonal), lists);
                let pivoted = residual::<N>(&mut made::<N>(sites, ring, alike), lists);
                // Numbers of size one, some roundings of a few sites.
                assert!(straight < 1e-14, "{N} {sites} {ring} {lists}: {straight:e}");
                assert!(pivoted < 1e-12, "{N} {sites} {ring} {lists}: {pivoted:e}");
            }
        }
    }
}

#[test]
fn solutions_solve_whatever_the_size_of_blocks() {
    all::<1>();
    all::<2>();
    all::<3>();
    all::<4>();
    all::<6>();
    all::<7>();
}

#[test]
fn a_block_of_dependent_columns_is_named() {
    let mut blocks = Blocks::new(3, 4, false);
    for site in 0..4 {
        let last = if site == 2 { 0.0 } else { 1.0 };
        blocks.add_block(
            site,
            site,
            &[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, last]],
        );
    }
    let told = blocks.factor_and_solve(Fixed::<3>, 1e-12, &mut [1.0; 12]);
    assert_eq!((told, blocks.without_pivot()), (Err(2), Some(2)));
}

/// The remainder of a block may be well conditioned and yet be rounding of the block.
#[test]
fn what_rounding_leaves_of_a_block_is_no_pivot() {
    let mut blocks = Blocks::new(3, 2, false);
    let [mut one, mut other] = [[[0.0; 3]; 3]; 2];
    for k in 0..3 {
        one[k][k] = 1.0;
        other[k][k] = 1.0 + 1e-15;
    }
    blocks.add_block(0, 0, &one);
    blocks.add_block(0, 1, &one);
    blocks.add_block(1, 0, &one);
    blocks.add_block(1, 1, &other);
    let told = blocks.factor_and_solve(Fixed::<3>, 64.0 * f64::EPSILON, &mut [1.0; 6]);
    assert_eq!(told, Err(1));
}
