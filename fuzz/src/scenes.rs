//! Requests of the right form with values of every kind: what random bytes would not reach.

use arbitrary::Arbitrary;
use serde_json::{Map, Value, json};

/// A number of any size, with those at which formulas change overrepresented.
#[derive(Arbitrary, Debug)]
pub enum Number {
    /// Any bits.
    Bits(f64),
    /// A small whole one.
    Whole(i8),
    /// A mantissa and a power of ten.
    Power(u8, i8),
    /// One of [`EDGES`].
    Edge(u8),
    /// A fraction of 1.
    Share(u8),
}

/// Where something changes: grazing, exact zeros, the ends of the ranges and of f64.
pub const EDGES: [f64; 20] = [
    0.0,
    -0.0,
    90.0,
    -90.0,
    89.999_999_999_999_99,
    45.0,
    180.0,
    360.0,
    -360.0,
    1e-300,
    5e-324,
    f64::MIN_POSITIVE,
    f64::MAX,
    1e-12,
    1e9,
    0.1,
    1e-15,
    63.639_610_306_789_28,
    1.0,
    f64::EPSILON,
];

impl Number {
    fn value(&self) -> f64 {
        match *self {
            Self::Bits(value) if value.is_finite() => value,
            Self::Bits(_) => 0.5,
            Self::Whole(value) => f64::from(value),
            Self::Power(mantissa, exponent) => f64::from(mantissa) * 10f64.powi(i32::from(exponent / 4)),
            Self::Edge(index) => EDGES[usize::from(index) % EDGES.len()],
            Self::Share(part) => f64::from(part) / 255.0,
        }
    }
}

/// A request for radiance.
#[derive(Arbitrary, Debug)]
pub struct Scene {
    model: u8,
    surface: [Option<Number>; 5],
    medium: Option<(Number, Number)>,
    shadowing: Option<u8>,
    wavelength: Option<Number>,
    irradiance: Option<Number>,
    polarization: Option<u8>,
    sensor: Option<[Number; 3]>,
    camera: Option<[Number; 5]>,
    theta_i: Vec<Number>,
    theta_r: Vec<Number>,
    phi_r: Option<Number>,
    components: Option<u8>,
    tolerance: Option<Number>,
    method: Option<u8>,
    log10: bool,
    per_direction: bool,
}

const MODELS: [&str; 4] = ["beckmann_spizzichino", "torrance_sparrow", "lambertian", "unified"];
const COMPONENTS: [&str; 3] = ["diffuse_lobe", "specular_lobe", "specular_spike"];
const METHODS: [&str; 6] = ["auto", "series", "paper", "uniform", "smooth", "rough"];
const SHADOWINGS: [&str; 3] = ["none", "v_groove", "smith"];
const POLARIZATIONS: [&str; 3] = ["unpolarized", "parallel", "perpendicular"];
const SURFACE: [&str; 5] =
    ["rms_height_um", "correlation_length_um", "facet_slope_deg", "diffuse_albedo", "specular_scale"];
const SENSOR: [&str; 3] = ["footprint_um2", "patch_half_x_um", "patch_half_y_um"];
const CAMERA: [&str; 5] = ["pixel_area_um2", "distance_um", "focal_length_um", "aperture_um", "off_axis_deg"];

/// Directions at most.
const DIRECTIONS: usize = 8;

fn one_of(words: &[&'static str], index: u8) -> &'static str {
    words[usize::from(index) % words.len()]
}

fn members(names: &[&str], numbers: &[Number]) -> Value {
    let members = names.iter().zip(numbers);
    Value::Object(members.map(|(name, number)| ((*name).to_owned(), number.value().into())).collect())
}

/// One angle as a number, more as an array.
fn angles(numbers: &[Number], count: usize) -> Value {
    match numbers {
        [] => json!(30),
        [only] => only.value().into(),
        _ => numbers.iter().take(count).map(Number::value).collect(),
    }
}

impl Scene {
    /// The request in JSON, and how many directions it has if it is accepted.
    pub fn request(&self) -> (Value, usize) {
        let mut surface = Map::new();
        for (name, number) in SURFACE.iter().zip(&self.surface) {
            surface.extend(number.as_ref().map(|number| ((*name).to_owned(), number.value().into())));
        }
        surface.extend(
            self.medium.as_ref().map(|(n, k)| ("medium".to_owned(), json!({"n": n.value(), "k": k.value()}))),
        );
        surface
            .extend(self.shadowing.map(|index| ("shadowing".to_owned(), one_of(&SHADOWINGS, index).into())));
        let mut illumination = Map::new();
        for (name, number) in [("wavelength_um", &self.wavelength), ("irradiance", &self.irradiance)] {
            illumination.extend(number.as_ref().map(|number| (name.to_owned(), number.value().into())));
        }
        let polarization = self.polarization.map(|index| one_of(&POLARIZATIONS, index));
        illumination.extend(polarization.map(|word| ("polarization".to_owned(), word.into())));

        // Arrays have one length.
        let longest = self.theta_i.len().max(self.theta_r.len()).min(DIRECTIONS);
        let both = self.theta_i.len().min(self.theta_r.len()).min(DIRECTIONS);
        let count = if both > 1 { both } else { longest };
        let mut geometry = Map::new();
        geometry.insert("theta_i_deg".to_owned(), angles(&self.theta_i, count));
        geometry.insert("theta_r_deg".to_owned(), angles(&self.theta_r, count));
        geometry.extend(self.phi_r.as_ref().map(|number| ("phi_r_deg".to_owned(), number.value().into())));

        let mut request = json!({
            "model": one_of(&MODELS, self.model),
            "surface": surface,
            "illumination": illumination,
            "geometry": geometry,
            "output": {"log10": self.log10, "per_direction": self.per_direction}
        });
        if let Some(bits) = self.components {
            let named = COMPONENTS.iter().enumerate().filter(|(index, _)| bits >> index & 1 == 1);
            request["components"] = named.map(|(_, name)| *name).collect();
        }
        if let Some(sensor) = &self.sensor {
            request["sensor"] = members(&SENSOR, sensor);
        } else if let Some(camera) = &self.camera {
            request["sensor"] = members(&CAMERA, camera);
        }
        let mut accuracy = Map::new();
        accuracy.extend(self.tolerance.as_ref().map(|t| ("relative_tolerance".to_owned(), t.value().into())));
        accuracy.extend(self.method.map(|index| ("method".to_owned(), one_of(&METHODS, index).into())));
        request["accuracy"] = accuracy.into();
        (request, count.max(1))
    }
}
