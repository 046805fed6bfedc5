//! Detects drift in an oscillating series, by the slope of block means relative to its standard error. Gives the amplitude, the
//! total change along the fitted line, and that change in standard errors, which account for the correlation of neighbouring
//! blocks.

/// A line through the block means of a series.
#[derive(Clone, Copy, Debug)]
pub struct Trend {
    /// Half the distance between the largest and the smallest sample.
    pub amplitude: f64,
    /// Change along the fitted line over the whole series.
    pub change: f64,
    /// |slope| over its standard error.
    pub significance: f64,
}

/// Number of blocks: enough for a standard error, and few enough that each block contains many periods.
const BLOCKS: usize = 64;

/// Fits the line. The series should oscillate many times within 1/64 of its length.
pub fn trend(series: &[f64]) -> Trend {
    let length = series.len() / BLOCKS;
    let means: Vec<f64> = series
        .chunks_exact(length.max(1))
        .take(BLOCKS)
        .map(|block| block.iter().map(|e| e - series[0]).sum::<f64>() / block.len() as f64)
        .collect();
    let n = means.len() as f64;
    let (centre, mean) = ((n - 1.0) / 2.0, means.iter().sum::<f64>() / n);
    let place = |i: usize| i as f64 - centre;
    let spread: f64 = (0..means.len()).map(|i| place(i) * place(i)).sum();
    let slope = means
        .iter()
        .enumerate()
        .map(|(i, m)| place(i) * (m - mean))
        .sum::<f64>()
        / spread;
    let rest: Vec<f64> = means
        .iter()
        .enumerate()
        .map(|(i, m)| m - mean - slope * place(i))
        .collect();
    let power: f64 = rest.iter().map(|r| r * r).sum();
    let neighbours: f64 = rest.windows(2).map(|pair| pair[0] * pair[1]).sum();
    // Effective number of independent blocks for a first-order autoregressive remainder. A negative correlation, from a beat with
    // the block length, does not narrow the error.
    let correlation = if power > 0.0 {
        (neighbours / power).clamp(0.0, 0.95)
    } else {
        0.0
    };
    let widening = (1.0 + correlation) / (1.0 - correlation);
    let error = (power / (n - 2.0) / spread * widening).sqrt();
    let (low, high) = series
        .iter()
        .fold((f64::MAX, f64::MIN), |(l, h), e| (l.min(*e), h.max(*e)));
    Trend {
        amplitude: 0.5 * (high - low),
        change: slope * n,
        significance: if slope == 0.0 {
            0.0
        } else {
            slope.abs() / error
        },
    }
}

impl Trend {
    /// Whether the change is within three standard errors and five percent of the amplitude.
    pub fn is_flat(&self) -> bool {
        self.significance <= 3.0 && self.change.abs() <= 0.05 * self.amplitude
    }
}
