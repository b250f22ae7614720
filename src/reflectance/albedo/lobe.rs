//! What a specular lobe sends into the hemisphere, over what arrives: ∫ f_r cos θ_r dω_r.
//!
//! With the facets of [`super::hemisphere`] the lobe of (47) is (x S(g, x)/π) F′ G/cos θ_i · cos θ′/cos α d(ln tan α) dψ, and
//! (70) is c·a_f p(α) F′ G/cos θ_i · cos θ′ dω: neither divides by cos θ_r.

use super::hemisphere::{Extent, Facet, Hemisphere, Kinks, Ring};
use crate::reflectance::beckmann_spizzichino::RelativeRoughness;
use crate::reflectance::degrees::SinCos;
use crate::reflectance::fresnel::{Energies, Energy, Medium, Polarization};
use crate::reflectance::numeric::EPSILON;
use crate::reflectance::numeric::cubature::{self, Cubature, Goal, Grid, NODES};
use crate::reflectance::numeric::dispatch::InstructionSet;
use crate::reflectance::numeric::lobe_series::lanes::{self, Batch, Choice, LANES};
use crate::reflectance::numeric::lobe_series::patches::{self, Tier};
use crate::reflectance::numeric::lobe_series::{self, LobeSeries, Method};
use crate::reflectance::shadowing::ShadowingFunction;
use core::f64::consts::{PI, SQRT_2};

/// Rectangles at most: a tenth of a second.
const MOST_RECTANGLES: usize = 4000;
/// Where the value serves to warn.
const MOST_ROUGHLY: usize = 60;
/// Facets whose density is e^{−100} of the level ones' reflect less than rounding loses, whatever their F′.
const CUT: f64 = 100.0;
/// Rounding of what surrounds S or p in ε, and what it does to them: four times what counting roundings gives.
const FACTOR_UNITS: f64 = 256.0;
const G_UNITS: f64 = 128.0;
const X_UNITS: f64 = 128.0;
const ALPHA_UNITS: f64 = 32.0;

/// A specular lobe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lobe {
    pub(super) slopes: Slopes,
    pub(super) medium: Medium,
    pub(super) polarization: Polarization,
    pub(super) shadowing: ShadowingFunction,
    /// Viewers closer than this to the normal are all alike to its shadowing: the steepest facets of a Gaussian surface hide
    /// others from there on.
    pub(super) finest: f64,
}

/// Where its facets come from.
#[derive(Clone, Copy, Debug)]
pub(super) enum Slopes {
    /// The second term of (47).
    Heights { roughness: RelativeRoughness, method: Method, tier: &'static Tier },
    /// (70): σ_α in radians, c·a_f over the value that tiles the mean plane, and that value.
    Angles { sigma_alpha: f64, scale: f64 },
}

impl Lobe {
    /// ∫ f_r cos θ_r dω_r, without the 1/cos θ_i where there is no shadowing, to a tolerance of it and what is `beside` it
    /// together. None as soon as `is_over` says so.
    pub(super) fn power(
        &self,
        source: SinCos,
        tolerance: f64,
        beside: f64,
        is_over: impl Fn() -> bool,
    ) -> Option<Cubature> {
        let kinks =
            Kinks { grooves: self.shadowing == ShadowingFunction::VGroove, critical: self.critical() };
        let goal = Goal { tolerance, beside, most: MOST_RECTANGLES, has_kinks: false };
        let whole = self.over_hemisphere(source, kinks, goal, is_over)?;
        Some(Cubature { error: whole.error + self.beyond(source), ..whole })
    }

    /// The same to 0.02 of it and what is `beside` it together, its kinks left to chance, by the coarsest series.
    pub(super) fn roughly(mut self, source: SinCos, beside: f64) -> f64 {
        if let Slopes::Heights { method, tier, .. } = &mut self.slopes {
            (*method, *tier) = (Method::Auto, patches::within(0.1));
        }
        let goal = Goal { tolerance: 0.02, beside, most: MOST_ROUGHLY, has_kinks: false };
        self.over_hemisphere(source, Kinks::default(), goal, || false).map_or(0.0, |whole| whole.value)
    }

    fn over_hemisphere(
        &self,
        source: SinCos,
        kinks: Kinks,
        goal: Goal,
        is_over: impl Fn() -> bool,
    ) -> Option<Cubature> {
        let hemisphere = Hemisphere::new(source, &self.extent(source), kinks);
        let mut batch = Batch::new();
        let fill = |square: usize, grid: &mut Grid| match self.slopes {
            Slopes::Heights { .. } => self.fill_heights(&hemisphere, square, grid, &mut batch),
            Slopes::Angles { sigma_alpha, scale } => {
                self.fill_angles(&hemisphere, square, grid, sigma_alpha, scale);
            }
        };
        cubature::integrate(hemisphere.squares(), goal, is_over, fill)
    }

    /// Whether it has no strength, or there is no surface.
    pub(super) fn is_dark(&self) -> bool {
        let overhead = SinCos { sin: 0.0, cos: 1.0 };
        matches!(self.slopes, Slopes::Angles { scale: 0.0, .. })
            || self.medium.energies(overhead) == Energies::NONE
    }

    /// cos of the critical angle, beyond which all is reflected.
    fn critical(&self) -> Option<f64> {
        match self.medium {
            // More absorption rounds the corner off.
            Medium::Index(index) if index.n.get() < 1.0 && index.k.get() < 0.5 => {
                let n = index.n.get();
                Some(((1.0 - n) * (1.0 + n)).sqrt())
            }
            Medium::Index(_) | Medium::PerfectConductor => None,
        }
    }

    /// The width of the lobe, and where it may be cut.
    fn extent(&self, source: SinCos) -> Extent {
        let (width, end) = match self.slopes {
            Slopes::Heights { roughness, .. } => (roughness.facet_width(source.cos), f64::INFINITY),
            Slopes::Angles { sigma_alpha, .. } => {
                let end = match self.most_over_cos_i(source) {
                    Some(most) => sigma_alpha * SQRT_2 * (CUT + libm::log(most.max(1.0))).sqrt(),
                    None => PI,
                };
                let end = if end < 1.57 { libm::tan(end) } else { f64::INFINITY };
                (libm::tan(sigma_alpha.min(0.785)), end)
            }
        };
        Extent { width, finest: self.finest, end }
    }

    /// cos θ′ times the shadowing over cos θ_i is not larger; none where nothing is known.
    fn most_over_cos_i(&self, source: SinCos) -> Option<f64> {
        if self.shadowing == ShadowingFunction::None {
            Some(1.0)
        } else {
            (source.cos > 0.0).then_some(1.0 / source.cos)
        }
    }

    /// What is reflected beyond the cut.
    fn beyond(&self, source: SinCos) -> f64 {
        match self.slopes {
            Slopes::Heights { .. } => 0.0,
            // ∫ p(α) 2π α dα from where p is e^{−100}/most.
            Slopes::Angles { sigma_alpha, scale } => self.most_over_cos_i(source).map_or(0.0, |most| {
                2.0 * PI * sigma_alpha * sigma_alpha * scale * libm::exp(-CUT) * most / most.max(1.0)
            }),
        }
    }

    /// F′ and G/cos θ_i of one facet, without the 1/cos θ_i where there is no shadowing.
    fn reflected(&self, ring: &Ring, facet: &Facet) -> Energy {
        let energy = match self.medium {
            Medium::PerfectConductor => Energy::ONE,
            Medium::Index(_) => self.medium.reflectance(ring.local_incidence(facet), self.polarization),
        };
        if self.shadowing == ShadowingFunction::None {
            return energy;
        }
        // At the horizon itself there are no viewers.
        let seen = if facet.cos_r > 0.0 {
            self.shadowing.factor_over_cosines(&ring.geometry(facet)) * facet.cos_r
        } else {
            0.0
        };
        Energy { value: energy.value * seen, error: energy.error * seen }
    }

    /// Rounding of what surrounds S or p in ε.
    fn units(&self) -> f64 {
        FACTOR_UNITS + self.shadowing.units()
    }

    fn fill_angles(
        &self,
        hemisphere: &Hemisphere,
        square: usize,
        grid: &mut Grid,
        sigma_alpha: f64,
        scale: f64,
    ) {
        for i in 0..NODES {
            let ring = hemisphere.ring(square, grid.first[i]);
            let ratio = libm::atan2(ring.slope.sin, ring.slope.cos) / sigma_alpha;
            let density = scale * libm::exp(-0.5 * ratio * ratio);
            // sin α dα = sin² α cos α d ln tan α
            let density = density * ring.slope.sin * ring.slope.sin * ring.slope.cos;
            let rounding = EPSILON * (self.units() + ALPHA_UNITS * ratio * ratio);
            for j in 0..NODES {
                let facet = ring.facet(grid.second[j]);
                let Energy { value, error } = self.reflected(&ring, &facet);
                let factor = density * facet.measure * facet.cos_local;
                grid.values[i][j] = factor * value;
                grid.errors[i][j] = factor * (error + rounding * value);
            }
        }
    }

    fn fill_heights(&self, hemisphere: &Hemisphere, square: usize, grid: &mut Grid, batch: &mut Batch) {
        let Slopes::Heights { roughness, method, tier } = self.slopes else { return };
        let mut points = Points::default();
        for i in 0..NODES {
            let ring = hemisphere.ring(square, grid.first[i]);
            for j in 0..NODES {
                let facet = ring.facet(grid.second[j]);
                let reflected = self.reflected(&ring, &facet);
                // v/k is 2 cos θ′ at the angle α from the vertical.
                let phase = 4.0 * PI * roughness.height * facet.cos_local * ring.slope.cos;
                let across = 2.0 * PI * roughness.correlation_length * facet.cos_local * ring.slope.sin;
                points.g.push(phase * phase);
                points.x.push(across * across);
                points.factors.push(facet.measure * facet.cos_local / (PI * ring.slope.cos));
                points.reflected.push(reflected);
            }
        }
        for (place, (value, error)) in
            points.evaluate(method, tier, batch, self.units()).into_iter().enumerate()
        {
            grid.values[place / NODES][place % NODES] = value;
            grid.errors[place / NODES][place % NODES] = error;
        }
    }
}

/// The points of one rule.
#[derive(Default)]
struct Points {
    g: Vec<f64>,
    x: Vec<f64>,
    factors: Vec<f64>,
    reflected: Vec<Energy>,
}

impl Points {
    /// Values and the bounds of their errors.
    fn evaluate(
        &self,
        method: Method,
        tier: &'static Tier,
        batch: &mut Batch,
        units: f64,
    ) -> Vec<(f64, f64)> {
        let mut found = Vec::with_capacity(self.g.len());
        for first in (0..self.g.len()).step_by(LANES) {
            let range = first..self.g.len().min(first + LANES);
            if method == Method::Auto {
                let (g, x) = (&self.g[range.clone()], &self.x[range.clone()]);
                lanes::evaluate(InstructionSet::widest(), Choice::auto(tier), g, x, batch);
            }
            for place in range {
                let (g, x) = (self.g[place], self.x[place]);
                let many = if method == Method::Auto { batch.get(place - first) } else { None };
                let series = many.unwrap_or_else(|| {
                    if method == Method::Auto {
                        lobe_series::evaluate_within(tier, g, x)
                    } else {
                        lobe_series::evaluate(method, g, x)
                    }
                });
                found.push(self.at(place, &series, units));
            }
        }
        found
    }

    fn at(&self, place: usize, series: &LobeSeries, units: f64) -> (f64, f64) {
        let (x, factor, Energy { value, error }) =
            (self.x[place], self.factors[place], self.reflected[place]);
        let sent = (series.estimate.value * x).to_f64() * factor;
        let unsure = (series.estimate.error * x).to_f64() * factor;
        let conditions = G_UNITS * series.condition_g + X_UNITS * series.condition_x;
        let rounding = EPSILON * (units + conditions);
        (sent * value, unsure * (value + error) + sent * (error + rounding * value))
    }
}
