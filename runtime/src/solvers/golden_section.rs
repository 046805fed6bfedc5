//! The maximum of a function with one peak, for the bounds of solvability. Takes the function and
//! an interval that contains the peak; gives its height.

/// The maximum of a function with one peak between `low` and `high`, by golden section. The maximum
/// is accurate to rounding when its position is known to half the digits, after about fifty
/// sections.
pub(super) fn peak(f: &impl Fn(f64) -> f64, mut low: f64, mut high: f64, sections: u32) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let mut left = high - GOLDEN * (high - low);
    let mut right = low + GOLDEN * (high - low);
    let (mut f_left, mut f_right) = (f(left), f(right));
    for _ in 0..sections {
        if f_left < f_right {
            low = left;
            (left, f_left) = (right, f_right);
            right = low + GOLDEN * (high - low);
            f_right = f(right);
        } else {
            high = right;
            (right, f_right) = (left, f_left);
            left = high - GOLDEN * (high - low);
            f_left = f(left);
        }
    }
    f_left.max(f_right)
}
