//! Six surfaces as they are met, each as a camera or an antenna sees it.

use reflectance::reflectance::fresnel::{Medium, Polarization, RefractiveIndex};
use reflectance::reflectance::numeric::lobe_series::Method;
use reflectance::reflectance::quantity::Quantity as InRange;
use reflectance::reflectance::scene::{
    Accuracy, Components, Illumination, Model, Scene, SceneParameters, Sensor, Surface,
};

/// A number that is known to be in range.
pub(crate) fn in_range<Q: InRange>(value: f64) -> Q {
    Q::new(value).expect("in range")
}

/// A surface with a name.
pub(crate) struct Realistic {
    pub(crate) name: &'static str,
    model: Model,
    /// σ_h, T, λ, µm.
    lengths: [f64; 3],
    /// n and k.
    index: [f64; 2],
    diffuse_albedo: f64,
    /// Side of the square patch, µm.
    side: f64,
}

pub(crate) const SCENES: [Realistic; 6] = [
    Realistic {
        name: "polished metal (aluminium)",
        model: Model::BeckmannSpizzichino,
        lengths: [0.02, 5.0, 0.55],
        index: [0.96, 6.7],
        diffuse_albedo: 0.0,
        side: 1e3,
    },
    Realistic {
        name: "brushed metal (steel)",
        model: Model::BeckmannSpizzichino,
        lengths: [0.8, 8.0, 0.55],
        index: [2.9, 3.1],
        diffuse_albedo: 0.0,
        side: 1e3,
    },
    Realistic {
        name: "painted",
        model: Model::Unified,
        lengths: [0.6, 15.0, 0.55],
        index: [1.5, 0.0],
        diffuse_albedo: 0.6,
        side: 1e3,
    },
    Realistic {
        name: "plaster",
        model: Model::Unified,
        lengths: [15.0, 60.0, 0.55],
        index: [1.5, 0.0],
        diffuse_albedo: 0.9,
        side: 1e3,
    },
    Realistic {
        name: "optical mirror (silver) at 633 nm",
        model: Model::BeckmannSpizzichino,
        lengths: [0.0005, 0.5, 0.633],
        index: [0.13, 4.0],
        diffuse_albedo: 0.0,
        side: 2e3,
    },
    Realistic {
        name: "wet soil at 3 cm (radar)",
        model: Model::BeckmannSpizzichino,
        lengths: [4e3, 6e4, 3e4],
        index: [4.5, 1.0],
        diffuse_albedo: 0.0,
        side: 1e6,
    },
];

impl Realistic {
    /// The scene, its components left to the tolerance.
    pub(crate) fn scene(&self, tolerance: f64) -> Scene {
        let [height, length, wavelength] = self.lengths;
        Scene::new(SceneParameters {
            model: self.model,
            surface: Surface {
                rms_height: Some(in_range(height)),
                correlation_length: Some(in_range(length)),
                facet_slope: None,
                medium: Medium::Index(RefractiveIndex {
                    n: in_range(self.index[0]),
                    k: in_range(self.index[1]),
                }),
                diffuse_albedo: in_range(self.diffuse_albedo),
                specular_scale: None,
                shadowing: None,
                fresnel_average: None,
            },
            illumination: Illumination {
                wavelength: Some(in_range(wavelength)),
                irradiance: in_range(1.0),
                polarization: Polarization::unpolarized(),
            },
            sensor: Some(Sensor::Patch {
                footprint: in_range(self.side * self.side),
                half_x: in_range(0.5 * self.side),
                half_y: in_range(0.5 * self.side),
            }),
            receiver: None,
            components: Components::Auto,
            accuracy: Accuracy { relative_tolerance: in_range(tolerance), method: Method::Auto },
        })
        .expect("a scene that fits together")
    }
}
