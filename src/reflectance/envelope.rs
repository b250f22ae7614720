//! How large a component can be over a region of directions, and how small: its logarithm from both sides at a fraction
//! of the price of its value.
//!
//! All are radiances over the irradiance, before what the specular components have in common where only they are
//! compared: F′ of (41) and (71) is the same number for spike and lobe.

use super::beckmann_spizzichino::{Patch, RelativeRoughness};
use super::degrees::SinCos;
use super::fresnel::{Energy, Medium, Polarization};
use super::fresnel_average::FresnelAverage;
use super::numeric::lobe_series::between;
use super::quantity::Wavelength;
use super::region::{Region, Span};
use super::scene::{Component, Model, Scene};
use super::shadowing::{ShadowingFunction, Smith};
use super::unified;
use super::view::View;
use core::f64::consts::{FRAC_PI_4, LN_2, PI};

/// A component's logarithm is −∞ here: it is exactly 0.
pub(super) const NOTHING: Span = Span { least: f64::NEG_INFINITY, most: f64::NEG_INFINITY };
/// Nothing is known.
const UNKNOWN: Span = Span { least: f64::NEG_INFINITY, most: f64::INFINITY };
/// Rounding of a sum of logarithms, relative to its largest term: a dozen operations of a few ε each.
const SLACK: f64 = 1e-13;
/// |d ln S/d ln g| is not above this where it is negative: −1.3 at x = 0, and it grows with x.
const STEEPEST: f64 = 1.5;

/// What the bounds need of a scene.
pub(super) struct Envelopes {
    model: Model,
    shadowing: ShadowingFunction,
    diffuse_albedo: f64,
    medium: Medium,
    polarization: Polarization,
    /// Over what F of the lobe is averaged; the spike has the mean plane's.
    average: FresnelAverage,
    /// F′ is common to the components compared, or 1.
    without_fresnel: bool,
    roughness: Option<RelativeRoughness>,
    view: Option<View>,
    /// σ_α and ln(c a_f/4).
    facets: Option<(f64, f64)>,
    /// Whether the facet lobe carries 1 − e^{−g}.
    shares: bool,
}

impl Envelopes {
    /// For comparing `components` with each other.
    pub(super) fn new(scene: &Scene, components: &[Component]) -> Self {
        let p = scene.parameters();
        let surface = &p.surface;
        let wavelength = p.illumination.wavelength.map(Wavelength::get);
        let has = |component| components.contains(&component);
        let average = scene.fresnel_average();
        let is_common = !has(Component::DiffuseLobe)
            && (average == FresnelAverage::MeanPlane
                || !(has(Component::SpecularLobe) && has(Component::SpecularSpike)));
        Self {
            model: p.model,
            shadowing: scene.shadowing_function(),
            diffuse_albedo: surface.diffuse_albedo.get(),
            medium: surface.medium,
            polarization: p.illumination.polarization,
            average,
            without_fresnel: is_common || surface.medium == Medium::PerfectConductor,
            roughness: scene.relative_roughness(),
            view: p.sensor.zip(wavelength).map(|(sensor, wavelength)| View::new(sensor, wavelength)),
            facets: scene.facets.map(|facets| (facets.sigma_alpha, libm::log(facets.scale) - 2.0 * LN_2)),
            shares: p.model == Model::Unified && surface.specular_scale.is_none(),
        }
    }

    /// The natural logarithm of a component from below and from above.
    pub(super) fn of(&self, component: Component, region: &Region) -> Span {
        if region.cos_sum.most == 0.0 {
            return UNKNOWN;
        }
        let bounds = match component {
            Component::DiffuseLobe => {
                // A product would round a subnormal albedo, even to 0.
                sum(&[constant(libm::log(self.diffuse_albedo)), constant(-libm::log(PI)), region.cos_i.ln()])
            }
            Component::SpecularLobe if self.model == Model::BeckmannSpizzichino => self.height_lobe(region),
            Component::SpecularLobe => self.facet_lobe(region),
            Component::SpecularSpike => self.spike(region),
        };
        // A NaN is a limit that depends on the path.
        if bounds.least.is_nan() || bounds.most.is_nan() { UNKNOWN } else { bounds }
    }

    /// ln F′ of the lobe: of one direction its value if it is that of one angle.
    fn lobe_reflectance(&self, region: &Region) -> Span {
        if self.without_fresnel {
            return constant(0.0);
        }
        match (self.average, region.direction) {
            (FresnelAverage::HalfVector, Some(geometry)) => self.reflectance_at(geometry.local_incidence()),
            (FresnelAverage::HalfVector, None) => self.reflectance_between(region.cos_local()),
            (FresnelAverage::MeanPlane, _) => self.mean_plane(region),
            (FresnelAverage::SlopeAverage, _) => self.reflectance_between(Span { least: 0.0, most: 1.0 }),
        }
    }

    /// ln F′ of the mean plane.
    fn mean_plane(&self, region: &Region) -> Span {
        let Region { sin_i, cos_i, .. } = region;
        if self.without_fresnel {
            constant(0.0)
        } else if cos_i.least.to_bits() == cos_i.most.to_bits() && sin_i.least == sin_i.most {
            self.reflectance_at(SinCos { sin: sin_i.least, cos: cos_i.least })
        } else {
            self.reflectance_between(*cos_i)
        }
    }

    /// ln F′ at one angle of incidence.
    fn reflectance_at(&self, incidence: SinCos) -> Span {
        let energy = self.medium.reflectance(incidence, self.polarization);
        let (least, most) = ((energy.value - energy.error).max(0.0), (energy.value + energy.error).min(1.0));
        Span { least, most }.ln()
    }

    /// ln F′ between two cosines of incidence, and of any mean between them. F′_perp falls with the cosine,
    /// d ln F′_perp/d cos θ = −4 Re(1/√(Y² − sin²θ)), and F′_para is not above it: their fields' ratio is that of
    /// √(Y² − sin²θ) cos θ ∓ sin²θ.
    fn reflectance_between(&self, cos: Span) -> Span {
        let perpendicular = |cos: f64, slack: f64| {
            let cos = (cos - slack).clamp(0.0, 1.0);
            let sin = ((1.0 - cos) * (1.0 + cos) + slack).clamp(0.0, 1.0).sqrt();
            self.medium.energies(SinCos { sin, cos }).perpendicular
        };
        // The cosines are rounded.
        let slack = 1e-15;
        let (near, far) = (perpendicular(cos.most, -slack), perpendicular(cos.least, slack));
        let least = |energy: Energy| (energy.value - energy.error).max(0.0);
        Span { least: self.polarization.v() * least(near), most: (far.value + far.error).min(1.0) }.ln()
    }

    /// ln(G/cos θ_r)
    fn shadowing_over_cos_r(&self, region: &Region) -> Span {
        let &Region { cos_i, cos_r, .. } = region;
        let open = Span { least: 1.0 / cos_r.most, most: 1.0 / cos_r.least };
        let span = match self.shadowing {
            ShadowingFunction::None => open,
            ShadowingFunction::Smith(smith) => smith_over_cos_r(smith, region),
            ShadowingFunction::VGroove => {
                let groove = region.groove();
                Span {
                    least: open.least.min(groove.least * (cos_i.least / cos_r.most).min(1.0)),
                    most: open.most.min(groove.most * (cos_i.most / cos_r.least).min(1.0)),
                }
            }
        };
        span.ln()
    }

    /// The second term of (47).
    fn height_lobe(&self, region: &Region) -> Span {
        let Some(roughness) = self.roughness else { return UNKNOWN };
        let facet = region.facet_factor().ln();
        let patch = libm::log(FRAC_PI_4) + 2.0 * libm::log(roughness.correlation_length);
        sum(&[
            constant(patch),
            Span { least: 2.0 * facet.least, most: 2.0 * facet.most },
            self.shadowing_over_cos_r(region),
            lobe_series(roughness, region),
            self.lobe_reflectance(region),
        ])
    }

    /// (70)
    fn facet_lobe(&self, region: &Region) -> Span {
        let Some((sigma_alpha, scale)) = self.facets else { return UNKNOWN };
        let exponent = |alpha: f64| {
            let ratio = alpha / sigma_alpha;
            -0.5 * ratio * ratio
        };
        let alpha = region.alpha();
        let share = match self.roughness {
            Some(roughness) if self.shares => {
                let share =
                    |cos: f64| libm::log(unified::lobe_share(unified::mirror_g(roughness.height, 1.0, cos)));
                Span { least: share(region.cos_i.least), most: share(region.cos_i.most) }
            }
            _ => constant(0.0),
        };
        sum(&[
            constant(scale),
            Span { least: exponent(alpha.most), most: exponent(alpha.least) },
            self.shadowing_over_cos_r(region),
            share,
            self.lobe_reflectance(region),
        ])
    }

    /// The first term of (47); |sinc a| is not above 1/a.
    fn spike(&self, region: &Region) -> Span {
        let (Some(roughness), Some(view)) = (self.roughness, self.view) else { return UNKNOWN };
        let phase = |cos_sum: f64| {
            let root = 2.0 * PI * roughness.height * cos_sum;
            -root * root
        };
        let (cos_i, cos_r) = (region.cos_i.ln(), region.cos_r.ln());
        let (near, far) = (view.patch(region.cos_r.most), view.patch(region.cos_r.least));
        let footprint = near.footprint.ln();
        let shape = match region.direction {
            Some(geometry) => {
                let rho = near.rho_squared(&geometry);
                Span { least: rho.least.ln(), most: (rho.value + rho.error).ln() }
            }
            None => pattern(region, &near, &far),
        };
        sum(&[
            constant(footprint),
            Span { least: phase(region.cos_sum.most), most: phase(region.cos_sum.least) },
            Span { least: 2.0 * cos_i.least, most: 2.0 * cos_i.most },
            Span { least: -2.0 * cos_r.most, most: -2.0 * cos_r.least },
            shape,
            self.mean_plane(region),
        ])
    }
}

/// Smith's G/cos θ_r over a region: cos θ_i/(cos θ_r A_i + cos θ_i A_r) with A = (½ + Λ) cos θ, or over B_i B_r with
/// B = (1 + Λ) cos θ.
fn smith_over_cos_r(smith: Smith, region: &Region) -> Span {
    let (cos_i, cos_r) = (region.cos_i, region.cos_r);
    // 0/0 stands in the corner where both directions are grazing, where nothing is known.
    let over = |near: f64, far: f64| if near == 0.0 { 0.0 } else { near / far };
    let hidden_i = smith.hidden(region.sin_i, cos_i);
    let hidden_r = smith.hidden(region.sin_r, cos_r);
    if smith.is_correlated() {
        // Of the divisor over cos θ_i: ½ cos θ_r + hidden_r, and cos θ_r times ½ + Λ_i.
        let lambda_i = Span { least: over(hidden_i.least, cos_i.most), most: hidden_i.most / cos_i.least };
        let of_source = |cos_r: f64, lambda_i: f64| if cos_r == 0.0 { 0.0 } else { cos_r * (0.5 + lambda_i) };
        Span {
            least: 1.0 / (of_source(cos_r.most, lambda_i.most) + 0.5 * cos_r.most + hidden_r.most),
            most: 1.0 / (of_source(cos_r.least, lambda_i.least) + 0.5 * cos_r.least + hidden_r.least),
        }
    } else {
        let visible = |cos: f64, hidden: f64| over(cos, cos + hidden);
        Span {
            least: visible(cos_i.least, hidden_i.most) / (cos_r.most + hidden_r.most),
            most: visible(cos_i.most, hidden_i.least) / (cos_r.least + hidden_r.least),
        }
    }
}

/// ln ρ_o² over a region; the patch is the smallest at `near` and the largest at `far`.
fn pattern(region: &Region, near: &Patch, far: &Patch) -> Span {
    let one = |half_near: f64, half_far: f64, component: Span| {
        let (low, high) = (2.0 * PI * half_near * component.least, 2.0 * PI * half_far * component.most);
        let most = if low > 1.0 { -libm::log(low) } else { 0.0 };
        // sinc falls up to its first zero, π.
        let least = if high < 3.0 { libm::log(super::numeric::sinc::sinc(high)) } else { f64::NEG_INFINITY };
        Span { least: 2.0 * least, most: 2.0 * most }
    };
    one(near.half_x, far.half_x, region.along).plus(one(near.half_y, far.half_y, region.across))
}

/// ln S: it falls with x; g^1.5 S grows with g.
fn lobe_series(roughness: RelativeRoughness, region: &Region) -> Span {
    let g = |cos_sum: f64| {
        let root = 2.0 * PI * roughness.height * cos_sum;
        root * root
    };
    let x = |horizontal: f64| {
        let root = PI * roughness.correlation_length * horizontal;
        root * root
    };
    let (low, high) = (g(region.cos_sum.least), g(region.cos_sum.most));
    if low == 0.0 {
        return UNKNOWN;
    }
    // g and x are known to a few ε, and the condition of S is not much above 1 + |ln S|.
    let blurred = |g: f64, x: f64| {
        let (low, high) = between(g, x);
        let (least, most) = (low.ln(), high.ln());
        let slack = SLACK * (1.0 + most.abs());
        (least - slack, most + slack)
    };
    if let Some(geometry) = &region.direction {
        // Its region may be wider than the direction itself: the azimuth's ends are rounded.
        let (least, most) = blurred(roughness.g(geometry), roughness.x(geometry));
        return Span { least, most };
    }
    let spread = STEEPEST * (libm::log(high) - libm::log(low));
    Span {
        least: blurred(low, x(region.horizontal.most)).0 - spread,
        most: blurred(high, x(region.horizontal.least)).1 + spread,
    }
}

const fn constant(value: f64) -> Span {
    Span { least: value, most: value }
}

/// The sum of logarithms, with its rounding.
fn sum(terms: &[Span]) -> Span {
    let (mut least, mut most, mut low, mut high) = (0.0, 0.0, 0.0, 0.0);
    for term in terms {
        least += term.least;
        most += term.most;
        low += term.least.abs();
        high += term.most.abs();
    }
    // An infinite bound is exact.
    let slack = |size: f64| if f64::is_finite(size) { SLACK * (1.0 + size) } else { 0.0 };
    Span { least: least - slack(low), most: most + slack(high) }
}

#[cfg(test)]
mod tests {
    use super::{Region, RelativeRoughness, STEEPEST, lobe_series};
    use crate::reflectance::directions::{Angles, Directions};
    use crate::reflectance::numeric::lobe_series::{Method, evaluate};
    use crate::reflectance::quantity::{Azimuth, Quantity as _, SourceZenith, ViewerZenith};

    #[test]
    fn the_series_falls_no_faster_than_assumed() {
        let mut least = f64::INFINITY;
        for i in -80..80 {
            let g = 10f64.powf(0.1 * f64::from(i));
            for x in [0.0, 1e-3, 0.1, 1.0, 10.0, 1e3, 1e6] {
                let ln = |g: f64| evaluate(Method::Series, g, x).estimate.value.ln();
                let step = 0.01;
                let slope = (ln(g * f64::exp(step)) - ln(g)) / step;
                least = least.min(slope);
            }
        }
        // And the constant is not idle.
        assert!(-STEEPEST < least && least < -1.1, "{least}");
    }

    #[test]
    fn of_one_direction_the_bounds_are_about_its_own_series() {
        let below_grazing = |doubles: u64| f64::from_bits(90f64.to_bits() - doubles);
        // The last one plus 90 is no double.
        for azimuth in [0.0, 1e-9, 180.0, f64::from_bits(180f64.to_bits() + 1)] {
            for (i, r) in (0..64).map(|pair| (below_grazing(pair / 8), below_grazing(1 + pair % 8))) {
                let directions = Directions::new(
                    Angles::One(SourceZenith::new(i).unwrap()),
                    Angles::One(ViewerZenith::new(if azimuth < 90.0 { r } else { -r }).unwrap()),
                    Angles::One(Azimuth::new(azimuth).unwrap()),
                )
                .unwrap();
                let geometry = directions.geometry(0);
                // x of 1 to 300, g of 40.
                let height = 1.0 / geometry.cos_sum;
                let longest = 1.0 / (geometry.horizontal + 1e-16 * geometry.cos_sum);
                for correlation_length in [0.3 * longest, longest, 6.0 * longest] {
                    let roughness = RelativeRoughness { height, correlation_length };
                    let region = Region::new(&directions.extents(0..1), Some(geometry));
                    let bounds = lobe_series(roughness, &region);
                    let (g, x) = (roughness.g(&geometry), roughness.x(&geometry));
                    let exact = evaluate(Method::Series, g, x).estimate.value.ln();
                    assert!(
                        bounds.least <= exact && exact <= bounds.most,
                        "{i} {r} {azimuth} {bounds:?} {exact}"
                    );
                }
            }
        }
    }
}
