//! The series of (33) against the integral that it expands.

use reflectance::reflectance::numeric::EPSILON;
use reflectance::reflectance::numeric::lobe_series::{self, Method};
use reflectance::reflectance::numeric::quadrature::{Integral, integrate};

/// S(g, x) = ∫₀^∞ J₀(2√(xt)) (e^{−g(1−e^{−t})} − e^{−g}) dt with t = s², and the integral of its magnitude.
///
/// The range is cut where e^{−t} of the integrand is e^{−50}, and into pieces of one half-wave of J₀.
fn hankel(g: f64, x: f64) -> (Integral, f64) {
    let end = (50.0 + g.max(1.0).ln()).sqrt();
    let half_wave = core::f64::consts::PI / (2.0 * x.sqrt()).max(1.0);
    // A strong phase decays within t = 1/g: two more cuts keep the pieces of its size.
    let mut cuts =
        vec![0.0, (1.0 / (1.0 + g)).sqrt().min(half_wave), (8.0 / (1.0 + g)).sqrt().min(half_wave)];
    let mut cut = half_wave;
    while cut < end {
        cuts.push(cut);
        cut += half_wave;
    }
    cuts.push(end);
    let weight = |s: f64| 2.0 * s * libm::exp(-g) * libm::expm1(g * libm::exp(-s * s));
    let mut whole = Integral::ZERO;
    let mut size = 0.0;
    for piece in cuts.windows(2) {
        whole = whole.plus(integrate(piece[0], piece[1], |s| libm::j0(2.0 * x.sqrt() * s) * weight(s)));
        size += integrate(piece[0], piece[1], weight).value;
    }
    (whole, size)
}

#[test]
fn the_series_is_the_integral_before_its_expansion() {
    for g in [1e-3, 0.1, 1.0, 2.5, 10.0, 40.0, 150.0] {
        for relative_x in [0.0, 0.1, 1.0, 3.0] {
            // Steps of x/g, on which the lobe depends when g is large.
            let x: f64 = relative_x * (1.0 + g);
            let series = lobe_series::evaluate(Method::Series, g, x);
            let (integral, size) = hankel(g, x);
            // libm's J₀ is good to a few ulp of 1 where it is small, and the phase 2√x s, up to 2√(52x), is rounded twice:
            // 16 + 2·2√(52x) ε of the integral's magnitude.
            let slack = integral.error + EPSILON * (16.0 + 4.0 * (52.0 * x).sqrt()) * size;
            // The weight e^{−g} expm1(…) carries g ε of its own exponents.
            let slack = slack + EPSILON * 2.0 * g * size;
            let difference = (series.estimate.value.to_f64() - integral.value).abs();
            assert!(
                difference <= slack,
                "g {g} x {x}: {} {integral:?} {difference} {slack}",
                series.estimate.value.to_f64()
            );
            // And the tolerance is not the whole value.
            assert!(slack < 1e-9 * integral.value, "g {g} x {x}: {slack} {}", integral.value);
        }
    }
}
