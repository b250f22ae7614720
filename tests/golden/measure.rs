//! The error measure, defined once. See README.md for why it is this one.
//!
//! With ε = 2⁻⁵³ and t = C ε (1 + cint), a computed value passes at C units when
//! |computed − exact| ≤ (t + t²) |exact| + 2⁻¹⁰⁷⁴, and its decimal logarithm when
//! |log10 − l| ≤ C ε (|l| + 1 + cint/ln 10).

use crate::table::Exact;

/// ε = 2⁻⁵³, half the spacing of doubles just above 1.
pub(crate) const EPSILON: f64 = f64::EPSILON / 2.0;
/// 2⁻¹⁰⁷⁴, the smallest subnormal.
const SMALLEST: f64 = 5e-324;

/// Whether an error is larger than it may be. Not a number counts as infinitely wrong.
pub(crate) fn exceeds(error: f64, most: f64) -> bool {
    error.is_nan() || most.is_nan() || error > most
}

/// computed − exact, with the digits of the exact value that its nearest double leaves out.
/// The subtraction of neighbouring doubles is exact, so the error is seen well below one ulp.
pub(crate) fn difference(computed: f64, exact: &Exact) -> f64 {
    (computed - exact.nearest) - exact.rest
}

/// The smallest C at which `computed` passes; infinite when none does.
pub(crate) fn units(computed: f64, exact: &Exact, cint: f64) -> f64 {
    if computed.is_nan() || exact.nearest.is_infinite() || computed.is_infinite() {
        return if computed == exact.nearest { 0.0 } else { f64::INFINITY };
    }
    let excess = difference(computed, exact).abs() - SMALLEST;
    if excess <= 0.0 {
        return 0.0;
    }
    // t + t² = excess/|exact|, solved for t in the form that does not cancel.
    let relative = excess / exact.nearest.abs();
    if relative.is_infinite() {
        return f64::INFINITY;
    }
    let t = 2.0 * relative / (1.0 + (1.0 + 4.0 * relative).sqrt());
    t / (EPSILON * (1.0 + cint))
}

/// The same for a decimal logarithm. The logarithm of an exact zero is −∞.
pub(crate) fn log_units(computed: f64, exact: &Exact, cint: f64) -> f64 {
    let log10 = exact.log10();
    if log10.is_infinite() || !computed.is_finite() {
        return if computed == log10 { 0.0 } else { f64::INFINITY };
    }
    (computed - log10).abs() / (EPSILON * (log10.abs() + 1.0 + cint / core::f64::consts::LN_10))
}

/// For a difference of two numbers that may cancel: C such that |computed − exact| = C ε scale + step.
pub(crate) fn absolute_units(computed: f64, exact: &Exact, scale: f64, step: f64) -> f64 {
    let error = difference(computed, exact).abs() - step.max(SMALLEST);
    if error <= 0.0 { 0.0 } else { error / (EPSILON * scale) }
}

/// |computed/exact − 1|, by the logarithms where the doubles run out. A logarithm shows no less than its own
/// rounding and the oracle's.
pub(crate) fn relative_error(value: f64, log10: f64, exact: &Exact) -> f64 {
    if exact.log.is_none() && value.abs() >= f64::MIN_POSITIVE {
        return (difference(value, exact) / exact.nearest).abs();
    }
    let off = (log10 - exact.log10()).abs() - 2.0 * EPSILON * (1.0 + exact.log10().abs());
    if off <= 0.0 {
        0.0
    } else {
        (off.copysign(log10 - exact.log10()) * core::f64::consts::LN_10).exp_m1().abs()
    }
}

#[test]
fn hundred_units_off_measures_hundred_units() {
    for value in [1.0, 0.1, 3.7e-200, -2.5e300] {
        let exact = Exact::of(value);
        for (cint, units_off) in [(0.0, 100.0), (49.0, 100.0), (1e4, 3.0)] {
            let computed = value * (1.0 + units_off * EPSILON * (1.0 + cint));
            let measured = units(computed, &exact, cint);
            assert!((measured / units_off - 1.0).abs() < 0.02, "{value} {cint}: {measured}");
        }
    }
}

#[test]
fn digits_beyond_the_double_count() {
    // The exact value lies 0.4 ulp above its nearest double: that double is 0.8 ε off at 1.
    let exact = Exact { rest: 0.4 * f64::EPSILON, ..Exact::of(1.0) };
    assert!((units(1.0, &exact, 0.0) - 0.8).abs() < 1e-12);
    assert!((units(1.0 + f64::EPSILON, &exact, 0.0) - 1.2).abs() < 1e-12);
}

#[test]
fn one_subnormal_step_is_forgiven_and_no_more() {
    assert_eq!(units(5e-324, &Exact::of(0.0), 0.0), 0.0);
    assert_eq!(units(1e-323, &Exact::of(5e-324), 0.0), 0.0);
    assert!(units(1e-322, &Exact::of(5e-324), 0.0) > 1e15);
    assert_eq!(units(1e-323, &Exact::of(0.0), 0.0), f64::INFINITY);
}

#[test]
fn the_square_admits_a_zero_next_to_a_zero_only() {
    // t = 64 ε (1 + 1e14) ≈ 0.71: a tenth of it in t is measured as a tenth of 64 units.
    let cint = 1e14;
    let t = 6.4 * EPSILON * (1.0 + cint);
    let measured = units(1.0 + t + t * t, &Exact::of(1.0), cint);
    assert!((measured - 6.4).abs() < 1e-9, "{measured}");
}

#[test]
fn what_is_not_a_number_or_not_finite_fails_unless_the_exact_value_overflows() {
    for computed in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(units(computed, &Exact::of(1.0), 1e30), f64::INFINITY);
        assert_eq!(log_units(computed, &Exact::of(1.0), 1e30), f64::INFINITY);
    }
    let overflow = Exact { log: Some(310.5), ..Exact::of(f64::INFINITY) };
    assert_eq!(units(f64::INFINITY, &overflow, 0.0), 0.0);
    assert_eq!(units(f64::MAX, &overflow, 0.0), f64::INFINITY);
    let off = log_units(310.5 * (1.0 + 100.0 * EPSILON), &overflow, 0.0);
    assert!((off - 100.0).abs() < 2.0, "{off}");
}

#[test]
fn the_logarithm_of_an_underflow_is_judged_and_that_of_a_zero_is_minus_infinity() {
    let underflow = Exact { log: Some(-85351646.43537854), ..Exact::of(0.0) };
    assert_eq!(log_units(-85351646.43537854, &underflow, 0.0), 0.0);
    let off = log_units(-85351646.43537854 - 200.0 * 85351646.0 * EPSILON, &underflow, 0.0);
    assert!((off - 200.0).abs() < 2.0, "{off}");
    let zero = Exact::of(0.0);
    assert_eq!(log_units(f64::NEG_INFINITY, &zero, 0.0), 0.0);
    assert_eq!(log_units(-400.0, &zero, 0.0), f64::INFINITY);
}

#[test]
fn a_difference_is_judged_by_the_size_of_its_terms() {
    let exact = Exact::of(1e-12);
    assert!((absolute_units(1e-12 + 10.0 * EPSILON, &exact, 1.0, 0.0) - 10.0).abs() < 1e-3);
    assert_eq!(absolute_units(1e-12, &exact, 0.0, 0.0), 0.0);
    assert_eq!(absolute_units(2e-12, &exact, 0.0, 0.0), f64::INFINITY);
}

#[test]
fn errors_of_totals_are_seen_by_value_and_by_logarithm() {
    assert_eq!(relative_error(1.5, 1.5f64.log10(), &Exact::of(1.0)), 0.5);
    let underflow = Exact { log: Some(-1000.0), ..Exact::of(0.0) };
    assert_eq!(relative_error(0.0, -1000.0, &underflow), 0.0);
    assert!((relative_error(0.0, -999.0, &underflow) - 9.0).abs() < 1e-9);
    assert!((relative_error(0.0, -1001.0, &underflow) - 0.9).abs() < 1e-9);
    assert_eq!(relative_error(0.0, f64::NEG_INFINITY, &underflow), 1.0);
}
