//! Which assumptions of the models a scene strains in the directions asked for, each with the number behind it.
//!
//! Directions are told apart by comparing their angles with limits that are worked out once: a direction costs a few
//! comparisons, and more only where it lies near a limit.

use super::degrees::{self, SinCos};
use super::directions::{Directions, Extents};
use super::findings::{Concern, Omitted, Warning, WarningCode};
use super::requirement;
use super::roughness::BeckmannWidth;
use super::scene::{Component, Model, Scene, Sensor};
use super::shadowing::{Shadowing, smith_lambda};
use super::source_energy::{SourceEnergy, Sources};
use super::surface::{self, curvature_radius_in_wavelengths};
use core::f64::consts::PI;

/// 4π r cos θ′ is to be so many wavelengths, as in [`surface::is_locally_flat`].
const FLAT_FROM: f64 = 10.0;
/// A ≫ T²: ten correlation lengths a side.
const LARGE_FROM: f64 = 100.0;
/// σ_h/T up to which (79) fits the rough lobe within 3 % of its peak (errata E46).
const GENTLE_UP_TO: f64 = 0.1;
/// 1 − G above this is significant: Λ_i + Λ_r of 1/9.
const HIDDEN_FROM: f64 = 0.1;

/// What a caller should know of a scene in these directions before any of its numbers: `needed` is the scene with the
/// components that are evaluated, and `omitted` are the others.
pub(super) fn warnings(
    scene: &Scene,
    needed: &Scene,
    directions: &Directions,
    extents: &Extents,
    omitted: &[Omitted],
) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if requirement::lacks_sensor(scene) {
        let spike = omitted.iter().find(|omitted| omitted.component == Component::SpecularSpike);
        let share = spike.and_then(|spike| spike.bound);
        if share.is_none_or(|share| share > scene.parameters().accuracy.relative_tolerance.get()) {
            warnings.push(Warning::of_scene(WarningCode::SpikeWithoutSensor, share, None));
        }
    }
    let unused = scene.unused().into_iter();
    warnings.extend(unused.map(|name| Warning::of_scene(WarningCode::ParameterNotUsed, None, Some(name))));
    if needed.evaluated().contains(&Component::SpecularLobe) {
        of_directions(needed, directions, extents, &mut warnings);
    }
    // Of all that the scene reflects, also where these directions need not all of it.
    if let Some(energy) = SourceEnergy::of(scene) {
        let sources = Sources::new(&energy, extents.theta_i);
        warnings.extend(sources.warnings(directions));
    }
    warnings
}

/// Beckmann's m = 2σ_h/T of the facets of the lobe; those of a σ_α by the inverse of (79).
pub(super) fn slope_width(scene: &Scene) -> Option<f64> {
    // (79) has no inverse from 90°/√2 on: facets of every slope.
    let of_every_slope = || scene.parameters().surface.facet_slope.map(|_| f64::INFINITY);
    scene.slope().map(BeckmannWidth::get).or_else(of_every_slope)
}

/// The warnings of a scene with a specular lobe.
fn of_directions(scene: &Scene, directions: &Directions, extents: &Extents, warnings: &mut Vec<Warning>) {
    let p = scene.parameters();
    let mut checks = Vec::with_capacity(4);
    if p.model == Model::BeckmannSpizzichino {
        checks.extend(Curvature::of(scene, extents).map(Check::Curvature));
        checks.extend(PatchSize::of(scene, extents).map(Check::Patch));
    } else {
        if let Some(roughness) = scene.relative_roughness()
            && !surface::is_geometrical(roughness.height)
        {
            let code = WarningCode::HeightBelowGeometricalOptics;
            warnings.push(Warning::of_scene(code, Some(roughness.height), None));
        }
        let heights = p.surface.rms_height.zip(p.surface.correlation_length);
        if let (None, Some((height, length))) = (p.surface.facet_slope, heights) {
            let ratio = height.get() / length.get();
            if ratio > GENTLE_UP_TO {
                warnings.push(Warning::of_scene(WarningCode::SmallSlopesViolated, Some(ratio), None));
            }
        }
    }
    if scene.shadowing() == Shadowing::None
        && let Some(width) = slope_width(scene)
    {
        checks.extend(Hidden::of(width, extents).map(Check::Hidden));
    }
    let mut concerns: Vec<Concern> = checks.iter().map(|_| Concern::default()).collect();
    if !checks.is_empty() {
        for index in 0..directions.count() {
            let (theta_i, theta_r, _) = directions.angles(index);
            let zeniths = [theta_i.get(), theta_r.get().abs()];
            for (check, concern) in checks.iter().zip(&mut concerns) {
                if check.concerns(zeniths, directions, index) {
                    concern.add(index, 0.0);
                }
            }
        }
    }
    for (check, concern) in checks.into_iter().zip(concerns) {
        let (code, value) = check.finding();
        warnings.extend(concern.warning(code, Some(value)));
    }
}

/// A check that directions fail one by one.
enum Check {
    Curvature(Curvature),
    Patch(PatchSize),
    Hidden(Hidden),
}

impl Check {
    /// Whether the direction of these zeniths, degrees, fails it.
    fn concerns(&self, zeniths: [f64; 2], directions: &Directions, index: usize) -> bool {
        match self {
            Self::Curvature(check) => {
                // θ′ is half the angle between source and viewer, which their zeniths bound.
                check.radius < FLAT_FROM
                    || zeniths[0] + zeniths[1] > check.twice_limit
                        && check.radius * 0.5 * directions.geometry(index).length() < FLAT_FROM
            }
            Self::Patch(check) => zeniths[1] < check.up_to,
            Self::Hidden(check) => {
                let steepest = zeniths[0].max(zeniths[1]);
                steepest > check.either
                    || steepest > check.both
                        && hidden(lambda(zeniths[0], check.width) + lambda(zeniths[1], check.width))
                            > HIDDEN_FROM
            }
        }
    }

    fn finding(&self) -> (WarningCode, f64) {
        match self {
            Self::Curvature(check) => (WarningCode::KirchhoffCurvature, check.radius),
            Self::Patch(check) => (WarningCode::PatchNotLarge, check.least),
            Self::Hidden(check) => (WarningCode::ShadowingSignificant, check.value),
        }
    }
}

/// Section 4.1.3.
struct Curvature {
    /// 4π r/λ
    radius: f64,
    /// θ_i + θ_r up to which θ′ cannot be too large, degrees.
    twice_limit: f64,
}

impl Curvature {
    fn of(scene: &Scene, extents: &Extents) -> Option<Self> {
        let roughness = scene.relative_roughness()?;
        let radius =
            4.0 * PI * curvature_radius_in_wavelengths(roughness.height, roughness.correlation_length, 1.0);
        // A little early: the direction itself decides.
        let twice_limit = 2.0 * degrees::from_radians(libm::acos((FLAT_FROM / radius).min(1.0))) - 1e-9;
        let most = extents.theta_i[1] + extents.zenith[1];
        (radius < FLAT_FROM || most > twice_limit).then_some(Self { radius, twice_limit })
    }
}

/// A ≫ T² of (33).
struct PatchSize {
    /// The least A/T².
    least: f64,
    /// Zenith of the viewer, degrees, up to which A is too small: a camera sees more at grazing view.
    up_to: f64,
}

impl PatchSize {
    fn of(scene: &Scene, extents: &Extents) -> Option<Self> {
        let p = scene.parameters();
        let length = p.surface.correlation_length?.get();
        match p.sensor? {
            Sensor::Patch { half_x, half_y, .. } => {
                let least = 4.0 * (half_x.get() / length) * (half_y.get() / length);
                (least < LARGE_FROM).then_some(Self { least, up_to: f64::INFINITY })
            }
            Sensor::Camera(camera) => {
                let facing = camera.optics().half_side(1.0) / length;
                let facing = 4.0 * facing * facing;
                let least = facing / SinCos::of_degrees(extents.zenith[0]).cos;
                let up_to = degrees::from_radians(libm::acos((facing / LARGE_FROM).min(1.0)));
                (least < LARGE_FROM).then_some(Self { least, up_to })
            }
        }
    }
}

/// Shadowing that is left out.
struct Hidden {
    width: f64,
    /// Zenith, degrees, above which one direction alone suffices, and below which even two do not.
    either: f64,
    both: f64,
    /// 1 − G at the largest zeniths.
    value: f64,
}

impl Hidden {
    fn of(width: f64, extents: &Extents) -> Option<Self> {
        let value = hidden(lambda(extents.theta_i[1], width) + lambda(extents.zenith[1], width));
        if value <= HIDDEN_FROM {
            return None;
        }
        let most = HIDDEN_FROM / (1.0 - HIDDEN_FROM);
        Some(Self { width, either: zenith_of(most, width), both: zenith_of(0.5 * most, width), value })
    }
}

/// 1 − G = 1 − 1/(1 + Λ_i + Λ_r)
fn hidden(lambda: f64) -> f64 {
    if lambda.is_infinite() { 1.0 } else { lambda / (1.0 + lambda) }
}

/// Λ in a direction of this zenith, degrees.
pub(super) fn lambda(zenith: f64, width: f64) -> f64 {
    if zenith == 0.0 { 0.0 } else { smith_lambda(SinCos::of_degrees(zenith), width) }
}

/// The zenith, degrees, where Λ is this; it grows with the zenith.
fn zenith_of(target: f64, width: f64) -> f64 {
    let (mut low, mut high) = (0.0, 90.0);
    // To 1e-12 of a degree.
    for _ in 0..47 {
        let middle = 0.5 * (low + high);
        if lambda(middle, width) < target {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}
