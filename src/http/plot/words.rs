//! What is written at a diagram: title and parameters of its scene, in the report's symbols.

use super::Plot;
use super::ticks::{minus, raised, unit};
use crate::http::api::light::Light;
use crate::reflectance::diagram::{Sweep, SweepAxis};
use crate::reflectance::evaluate::Quantity;
use crate::reflectance::fresnel::{Medium, Polarization};
use crate::reflectance::material::Lookup;
use crate::reflectance::numeric::lobe_series::Method;
use crate::reflectance::quantity::Wavelength;
use crate::reflectance::scene::{CameraSensor, Component, Model, Scene, Sensor};
use crate::reflectance::shadowing::Shadowing;

/// Title and parameters.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Words {
    pub(crate) title: String,
    pub(crate) parameters: String,
}

impl Words {
    /// Of a scene over a sweep.
    pub(crate) fn of(scene: &Scene, light: &Light, quantity: Quantity, sweep: &Sweep) -> Self {
        let of = scene.parameters();
        let over = match sweep.axis() {
            SweepAxis::ThetaR => "over the viewing angle",
            SweepAxis::ThetaI => "over the source angle",
        };
        let title = format!("{} {over}, {}", name(quantity.name()), model(of.model));
        let mut parts = Vec::new();
        let surface = &of.surface;
        parts.extend(surface.rms_height.map(|height| format!("σ_h = {} µm", number(height.get()))));
        parts.extend(surface.correlation_length.map(|length| format!("T = {} µm", number(length.get()))));
        parts.extend(surface.facet_slope.map(|slope| format!("σ_α = {}°", number(slope.get()))));
        parts.extend(medium(surface.medium, light));
        if let (Light::One(_), Some(wavelength)) = (light, of.illumination.wavelength) {
            parts.push(format!("λ = {} µm", number(wavelength.get())));
        }
        if surface.diffuse_albedo.get() > 0.0 {
            parts.push(format!("ρ = {}", number(surface.diffuse_albedo.get())));
        }
        parts.extend(surface.specular_scale.map(|scale| format!("c·a_f = {} sr⁻¹", number(scale.get()))));
        parts.extend(shadowing(scene));
        parts.extend(polarization(of.illumination.polarization));
        if of.illumination.irradiance.get() != 1.0 {
            parts.push(format!("irradiance {} W m⁻²", number(of.illumination.irradiance.get())));
        }
        parts.extend(of.sensor.as_ref().map(sensor));
        if of.accuracy.method != Method::Auto {
            parts.push(format!("method {}", of.accuracy.method.name()));
        }
        if let [at] = sweep.at() {
            parts.push(format!("{} = {}°", symbol(sweep.axis().fixed_name()).0, number(*at)));
        }
        if sweep.phi_r() != 0.0 {
            parts.push(format!("φ_r = {}°", number(sweep.phi_r())));
        }
        Self { title, parameters: parts.join(", ") }
    }
}

impl Plot {
    /// With its words and axes, without curves.
    pub(crate) fn framed(words: Words, quantity: Quantity, sweep: &Sweep) -> Self {
        let positions = sweep.positions();
        let fixed_name = sweep.axis().fixed_name();
        Self {
            title: words.title,
            parameters: words.parameters,
            quantity: name(quantity.name()),
            unit: unit(quantity.unit()),
            axis: symbol(sweep.axis().name()),
            ends: (
                positions.first().copied().unwrap_or_default(),
                positions.last().copied().unwrap_or_default(),
            ),
            fixed: if let [at] = sweep.at() { Some((direction(fixed_name), *at)) } else { None },
            ..Self::default()
        }
    }
}

/// What tells a curve from the others.
pub(crate) fn curve_label(sweep: &Sweep, at: Option<f64>, wavelength: Option<Wavelength>) -> String {
    let wavelength = wavelength.map(|wavelength| format!("λ = {} µm", number(wavelength.get())));
    let at = at.map(|at| format!("{} = {}°", symbol(sweep.axis().fixed_name()).0, number(at)));
    wavelength.into_iter().chain(at).collect::<Vec<_>>().join(", ")
}

/// What an answer's quantity is called in print.
pub(super) fn name(quantity: &str) -> &'static str {
    match quantity {
        "radiance" => "Radiance",
        "brdf" => "BRDF",
        "fresnel_reflectance" => "Fresnel reflectance F′",
        "geometrical_attenuation" => "Geometrical attenuation G",
        _ => "Value",
    }
}

/// The symbol of an angle, and what it is.
pub(super) fn symbol(angle: &str) -> (&'static str, &'static str) {
    match angle {
        "theta_i_deg" => ("θ_i", "Source angle"),
        "theta_r_deg" => ("θ_r", "Viewing angle"),
        _ => ("θ′", "Local angle of incidence"),
    }
}

/// What the direction of a fixed angle belongs to.
pub(super) fn direction(angle: &str) -> &'static str {
    if angle == "theta_i_deg" { "source" } else { "viewer" }
}

/// A component in words.
pub(crate) const fn component(component: Component) -> &'static str {
    match component {
        Component::DiffuseLobe => "diffuse lobe",
        Component::SpecularLobe => "specular lobe",
        Component::SpecularSpike => "specular spike",
    }
}

const fn model(model: Model) -> &'static str {
    match model {
        Model::BeckmannSpizzichino => "Beckmann-Spizzichino",
        Model::TorranceSparrow => "Torrance-Sparrow",
        Model::Lambertian => "Lambertian",
        Model::Unified => "unified model of section 5.1",
    }
}

fn medium(medium: Medium, light: &Light) -> Option<String> {
    let lookup = match light {
        Light::One(lookup) => *lookup,
        Light::Spectrum(lines) => {
            let lookup = lines.first().and_then(|line| line.lookup)?;
            return Some(format!("{} ({})", lookup.material.name, lookup.source.id));
        }
    };
    let Medium::Index(index) = medium else { return None };
    let (n, k) = (index.n.get(), index.k.get());
    Some(match lookup {
        // What was looked up between two samples has more digits than are known.
        Some(Lookup { material, source, .. }) => {
            let (n, k) = (super::ticks::short(n), super::ticks::short(k));
            format!("{} ({}): n = {n}, k = {k}", material.name, source.id)
        }
        None => format!("n = {}, k = {}", number(n), number(k)),
    })
}

fn shadowing(scene: &Scene) -> Option<String> {
    let is_lobe = scene.evaluated().contains(&Component::SpecularLobe);
    match scene.shadowing() {
        _ if !is_lobe => None,
        // The height model has none unless it is asked for.
        Shadowing::None if scene.parameters().model == Model::BeckmannSpizzichino => None,
        Shadowing::None => Some("no shadowing".to_owned()),
        Shadowing::VGroove => Some("shadowing by V-grooves".to_owned()),
        Shadowing::Smith => Some("shadowing after Smith".to_owned()),
        Shadowing::SmithUncorrelated => Some("shadowing after Smith, uncorrelated".to_owned()),
    }
}

fn polarization(polarization: Polarization) -> Option<String> {
    if polarization == Polarization::unpolarized() {
        return None;
    }
    let [h, v] = [polarization.h(), polarization.v()].map(number);
    Some(format!("polarized: h = {h}, v = {v}"))
}

fn sensor(sensor: &Sensor) -> String {
    match sensor {
        Sensor::Patch { footprint, half_x, half_y } => format!(
            "X = {} µm, Y = {} µm, footprint {} µm²",
            number(half_x.get()),
            number(half_y.get()),
            number(footprint.get())
        ),
        Sensor::Camera(CameraSensor { pixel_area, distance, focal_length, aperture, off_axis }) => {
            let [area, z, f, d] =
                [pixel_area.get(), distance.get(), focal_length.get(), aperture.get()].map(number);
            let gamma = number(off_axis.get());
            format!("camera: pixel {area} µm², z = {z} µm, f = {f} µm, d = {d} µm, γ = {gamma}°")
        }
    }
}

/// A number with all its digits.
fn number(value: f64) -> String {
    if value == 0.0 || (1e-4..1e7).contains(&value.abs()) {
        return minus(&value.to_string());
    }
    let text = format!("{value:e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent = raised(exponent);
    minus(&if digits == "1" { format!("10{exponent}") } else { format!("{digits}×10{exponent}") })
}
