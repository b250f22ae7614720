//! Every method against the sum, over the whole plane and densely where methods change hands.

use super::{LobeSeries, Method, evaluate};

/// Points (g, x) on a grid of decades and quarters, g from 1e-12 to 1e14 and x from 0 to 1e14.
fn plane() -> impl Iterator<Item = (f64, f64)> {
    let quarter = |exponent: i32| 10f64.powf(0.25 * f64::from(exponent));
    (-48..=56)
        .flat_map(move |i| core::iter::once(0.0).chain((-32..=56).map(quarter)).map(move |x| (quarter(i), x)))
}

/// Where the terms begin to be strided, the expansion begins to serve and is taken by `auto`, and
/// the first term or 100 terms cease to be enough.
fn switches() -> impl Iterator<Item = (f64, f64)> {
    (0..=400).flat_map(|i| {
        let step = f64::from(i) / 400.0;
        [1e-12, 1e-6, 0.01, 0.3, 1.0, 3.0, 10.0, 100.0]
            .into_iter()
            .flat_map(move |u| [(12.0 + 8.0 * step, u), (56.0 + 16.0 * step, u), (1400.0 + 4000.0 * step, u)])
            // From μ = g e^u back to g and x.
            .map(|(mu, u)| (mu * libm::exp(-u), mu * mu * u))
            .chain([(4e-15 * (0.5 + step), 1e-9), (0.5 + step, 1.0), (40.0 + 60.0 * step, 1.0)])
    })
}

/// Whether the two values can both be within their bounds of one S.
fn agree(a: &LobeSeries, b: &LobeSeries) -> bool {
    let distance = a.estimate.value.distance(b.estimate.value);
    let room = a.estimate.error + b.estimate.error;
    distance.is_zero() || (distance / room).to_f64() <= 1.0
}

#[test]
fn no_method_exceeds_its_bound() {
    let mut checked = 0;
    for (g, x) in plane().chain(switches()) {
        let series = evaluate(Method::Series, g, x);
        for method in [Method::Auto, Method::Paper, Method::Uniform, Method::Smooth, Method::Rough] {
            let value = evaluate(method, g, x);
            assert!(agree(&value, &series), "{} at g = {g:e}, x = {x:e}", method.name());
            checked += 1;
        }
    }
    assert!(checked > 100_000, "{checked}");
}

#[test]
fn auto_is_as_good_as_the_sum() {
    for (g, x) in plane().chain(switches()) {
        let (auto, series) = (evaluate(Method::Auto, g, x), evaluate(Method::Series, g, x));
        // Its truncation disappears in the rounding that both allow for; a factor for the conditions,
        // which the methods know to a few per cent.
        let (auto, series) = (auto.estimate.relative_error(), series.estimate.relative_error());
        assert!(auto <= 2.0 * series, "g = {g:e}, x = {x:e}: {auto:e} against {series:e}");
    }
}

#[test]
fn named_methods_say_how_far_off_they_are() {
    // 100 terms at g = 200: nothing of the sum is left. (49) at g = 1e-3: a thousand times too much.
    let paper = evaluate(Method::Paper, 200.0, 0.0).estimate;
    assert!((0.9..1.1).contains(&paper.relative_error()), "{}", paper.relative_error());
    let rough = evaluate(Method::Rough, 1e-3, 0.0).estimate;
    assert!((1e5..1e7).contains(&rough.relative_error()), "{}", rough.relative_error());
    let smooth = evaluate(Method::Smooth, 1e-9, 0.0).estimate;
    assert!(smooth.relative_error() < 3e-10, "{}", smooth.relative_error());
}
