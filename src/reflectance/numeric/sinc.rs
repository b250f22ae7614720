//! sin(a)/a.

/// sin(a)/a, 1 at 0; relative error below 3 ε of the value for the exact double `a` away from
/// the zeros a = mπ, where the absolute error stays below ε/|a|.
pub fn sinc(a: f64) -> f64 {
    if a.abs() < 1e-8 {
        // 1 − a²/6 is 1 within 2e-17.
        1.0
    } else {
        libm::sin(a) / a
    }
}
