//! Interleaved timing of two implementations: blocks in the order A B B A, so that a slow drift of the machine affects both
//! equally. Takes functions that make a fresh block of work; gives medians and the spread of the ratio.

use rustix::time::{ClockId, clock_gettime};

/// Groups of four blocks in each process, which gives a median over 42 blocks for each implementation.
pub const QUADRUPLES: usize = 21;

/// Steps per block: about a millisecond, far above the clock resolution and below a time slice.
pub const STEPS: u32 = 32_000;

/// Times per step in nanoseconds.
pub struct Comparison {
    /// Median over the blocks of the generated stepper.
    pub generated: f64,
    /// Median over the blocks of the hand-written stepper.
    pub hand: f64,
    /// Lower and upper quartile of the ratio within groups of four.
    pub quartiles: [f64; 2],
}

/// Times both. `generated` and `hand` prepare, outside the measured time, a block of [`STEPS`] steps.
pub fn compare<A: FnOnce(), B: FnOnce()>(
    generated: impl Fn() -> A,
    hand: impl Fn() -> B,
) -> Comparison {
    compare_blocks(STEPS, STEPS, QUADRUPLES, generated, hand)
}

/// Like `compare`, with the given numbers of steps per block and of groups of four blocks.
pub fn compare_blocks<A: FnOnce(), B: FnOnce()>(
    steps_generated: u32,
    steps_hand: u32,
    quadruples: usize,
    generated: impl Fn() -> A,
    hand: impl Fn() -> B,
) -> Comparison {
    let (mut first, mut second, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    // The first groups warm caches, predictors and clock frequency.
    for group in 0..quadruples + 5 {
        let a1 = time(steps_generated, generated());
        let b1 = time(steps_hand, hand());
        let b2 = time(steps_hand, hand());
        let a2 = time(steps_generated, generated());
        if group >= 5 {
            first.extend([a1, a2]);
            second.extend([b1, b2]);
            ratios.push((a1 + a2) / (b1 + b2));
        }
    }
    Comparison {
        generated: quantile(&mut first, 0.5),
        hand: quantile(&mut second, 0.5),
        quartiles: [quantile(&mut ratios, 0.25), quantile(&mut ratios, 0.75)],
    }
}

/// CPU time of this thread in nanoseconds, without the time spent waiting for a processor.
pub fn computed() -> f64 {
    let now = clock_gettime(ClockId::ThreadCPUTime);
    now.tv_sec as f64 * 1e9 + now.tv_nsec as f64
}

fn time(steps: u32, work: impl FnOnce()) -> f64 {
    let begin = computed();
    work();
    (computed() - begin) / f64::from(steps)
}

fn quantile(times: &mut [f64], share: f64) -> f64 {
    times.sort_by(f64::total_cmp);
    let place = share * (times.len() - 1) as f64;
    let (below, above) = (times[place.floor() as usize], times[place.ceil() as usize]);
    below + (above - below) * place.fract()
}
