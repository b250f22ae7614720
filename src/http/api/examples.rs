//! Requests that the document shows. A test sends every one of them.

/// A request body, with the operation it belongs to.
pub(crate) struct Example {
    /// Path of the operation.
    pub(crate) path: &'static str,
    /// Key among the operation's examples.
    pub(crate) name: &'static str,
    /// What it shows.
    pub(crate) summary: &'static str,
    /// The body, JSON.
    pub(crate) body: &'static str,
}

/// What the program suggests when it starts.
pub(crate) const FIRST: &str = r#"{"model": "beckmann_spizzichino",
 "surface": {"rms_height_um": 0.2, "correlation_length_um": 4},
 "illumination": {"wavelength_um": 0.55},
 "geometry": {"theta_i_deg": 30, "theta_r_deg": [0, 15, 30, 45]}}"#;

const CAMERA: &str = r#"{"model": "beckmann_spizzichino",
 "surface": {"rms_height_um": 0.05, "correlation_length_um": 5, "medium": {"n": 1.44, "k": 5.23}},
 "illumination": {"wavelength_um": 0.55, "irradiance": 100, "polarization": "unpolarized"},
 "sensor": {"pixel_area_um2": 25, "distance_um": 500000, "focal_length_um": 50000, "aperture_um": 25000},
 "geometry": {"theta_i_deg": 45, "theta_r_deg": [44, 45, 46]},
 "components": ["specular_lobe", "specular_spike"],
 "output": {"log10": true, "per_direction": true}}"#;

const FACETS: &str = r#"{"model": "torrance_sparrow",
 "surface": {"facet_slope_deg": 13, "medium": {"n": 1.5}, "diffuse_albedo": 0.3},
 "illumination": {"irradiance": 10, "polarization": {"parallel": 0.25, "perpendicular": 0.75}},
 "geometry": {"theta_i_deg": 60, "theta_r_deg": [-30, 0, 30, 60, 75], "phi_r_deg": 0}}"#;

const UNIFIED: &str = r#"{"model": "unified",
 "surface": {"rms_height_um": 0.1, "correlation_length_um": 10, "diffuse_albedo": 0.2},
 "illumination": {"wavelength_um": 0.633},
 "sensor": {"footprint_um2": 1e6, "patch_half_x_um": 500, "patch_half_y_um": 500},
 "geometry": {"theta_i_deg": [10, 30, 60], "theta_r_deg": [10, 30, 60]}}"#;

const SPECTRUM: &str = r#"{"model": "beckmann_spizzichino",
 "surface": {"rms_height_um": 0.3, "correlation_length_um": 5, "medium": {"material": "Al"}},
 "illumination": {"wavelength_um": [0.405, 0.532, 0.633]},
 "geometry": {"theta_i_deg": 30, "theta_r_deg": [15, 30, 45]}}"#;

const PAPER: &str = r#"{"model": "beckmann_spizzichino",
 "surface": {"rms_height_um": 1, "correlation_length_um": 10},
 "illumination": {"wavelength_um": 0.5},
 "geometry": {"theta_i_deg": 10, "theta_r_deg": 10},
 "accuracy": {"relative_tolerance": 1e-6, "method": "paper"}}"#;

const MIRROR: &str = r#"{"model": "beckmann_spizzichino",
 "surface": {"rms_height_um": 0.0005, "correlation_length_um": 1, "medium": {"n": 1.37, "k": 7.62}},
 "illumination": {"wavelength_um": 0.633},
 "sensor": {"footprint_um2": 1e6, "patch_half_x_um": 500, "patch_half_y_um": 500},
 "geometry": {"theta_i_deg": [0, 15, 30, 45], "theta_r_deg": [0, 15, 30, 45]},
 "accuracy": {"relative_tolerance": 1e-6}}"#;

const LAMBERTIAN: &str = r#"{"model": "lambertian", "surface": {"diffuse_albedo": 0.8},
 "illumination": {"irradiance": 3.141592653589793}, "geometry": {"theta_i_deg": 60, "theta_r_deg": 20}}"#;

const ALBEDO: &str = r#"{"model": "beckmann_spizzichino",
 "surface": {"rms_height_um": 0.1, "correlation_length_um": 5, "medium": {"n": 1.37, "k": 7.62}},
 "illumination": {"wavelength_um": 0.633}, "theta_i_deg": [0, 30, 60, 75]}"#;

const BRIGHT: &str = r#"{"model": "torrance_sparrow",
 "surface": {"rms_height_um": 3, "correlation_length_um": 20, "shadowing": "none"},
 "theta_i_deg": [0, 45, 60, 75, 80, 85], "accuracy": {"relative_tolerance": 1e-9}}"#;

const DIAGRAM: &str = r#"{"quantity": "brdf", "model": "beckmann_spizzichino",
 "surface": {"rms_height_um": 0.5, "correlation_length_um": 5},
 "illumination": {"wavelength_um": 0.5},
 "sweep": "theta_r_deg", "from_deg": -80, "to_deg": 80, "step_deg": 5, "at_deg": [10, 30, 45, 60]}"#;

const FIXED_VIEW_DIAGRAM: &str = r#"{"model": "torrance_sparrow",
 "surface": {"facet_slope_deg": 8, "medium": {"n": 1.5, "k": 0}},
 "illumination": {"irradiance": 1},
 "sweep": "theta_i_deg", "from_deg": -85, "to_deg": 85, "points": 35, "at_deg": [0, 45],
 "output": {"log10": true}, "plot": {"form": "polar", "scale": "log10", "decades": 4, "theme": "dark"}}"#;

const FIXED_SOURCE: &str = r#"{"model": "fixed_source", "C_dl": 0.2, "C_sl": 0.5, "C_ss": 4,
 "facet_slope_deg": 6, "spike": {"shape": "gaussian", "width_deg": 0.5},
 "geometry": {"theta_i_deg": 30, "theta_r_deg": [25, 29, 30, 31, 35]}}"#;

const FIXED_VIEW: &str = r#"{"model": "fixed_view", "K_dl": 0.2, "K_sl": 0.5, "K_ss": 4,
 "facet_slope_deg": 6,
 "spike": {"shape": "sinc2", "patch_half_x_um": 50, "patch_half_y_um": 50, "wavelength_um": 0.5},
 "geometry": {"theta_i_deg": [40, 45, 50], "theta_r_deg": 45}, "output": {"log10": true}}"#;

/// Every example of a body.
pub(crate) const BODIES: &[Example] = &[
    example(
        "/v1/radiance",
        "rough_conductor",
        "Four directions of a rough conductor, all else by default",
        FIRST,
    ),
    example(
        "/v1/radiance",
        "camera",
        "Spike and lobe of aluminium as a camera sees them, with logarithms",
        CAMERA,
    ),
    example("/v1/radiance", "facets", "Torrance-Sparrow facets of glass over a diffuse base", FACETS),
    example("/v1/radiance", "unified", "All three components at once, in mirror directions", UNIFIED),
    example(
        "/v1/radiance",
        "as_the_authors",
        "The first 100 terms only, with the error bound they have",
        PAPER,
    ),
    example(
        "/v1/radiance",
        "spectrum",
        "Brushed aluminium at three wavelengths, n and k looked up",
        SPECTRUM,
    ),
    example("/v1/radiance", "lambertian", "An ideal diffuser", LAMBERTIAN),
    example(
        "/v1/brdf",
        "rough_conductor",
        "Four directions of a rough conductor, all else by default",
        FIRST,
    ),
    example("/v1/brdf", "facets", "Torrance-Sparrow facets of glass over a diffuse base", FACETS),
    example("/v1/albedo", "aluminium", "How spike and lobe of a metal share the energy", ALBEDO),
    example("/v1/albedo", "above_one", "Facets without shadowing reflect more than arrives", BRIGHT),
    example(
        "/v1/plan",
        "polished_metal",
        "Is the lobe of a polished mirror needed in its mirror directions?",
        MIRROR,
    ),
    example("/v1/plan", "facets", "Torrance-Sparrow facets of glass over a diffuse base", FACETS),
    example("/v1/tradeoff", "rough_conductor", "Every method on four directions of a rough conductor", FIRST),
    example("/v1/tradeoff", "camera", "The same trade with a spike beside the lobe", CAMERA),
    example("/v1/diagrams", "fixed_source", "BRDF over the viewing angle for four sources", DIAGRAM),
    example(
        "/v1/diagrams",
        "fixed_view",
        "Radiance over the source angle for two views, dark and polar where it is drawn",
        FIXED_VIEW_DIAGRAM,
    ),
    example("/v1/image-irradiance", "camera", "What a pixel receives from aluminium, (51)", CAMERA),
    example("/v1/image-irradiance", "fixed_source", "The linear model (74) about its spike", FIXED_SOURCE),
    example(
        "/v1/image-irradiance",
        "fixed_view",
        "The linear model (80) with the spike of a patch",
        FIXED_VIEW,
    ),
];

/// The query that an operation shows: the examples of its parameters, which together make one link.
pub(crate) struct Link {
    /// Path of the operation.
    pub(crate) path: &'static str,
    /// Parameters and their values, JSON.
    pub(crate) values: &'static [(&'static str, &'static str)],
}

/// Every example of a query.
pub(crate) const LINKS: &[Link] = &[
    Link {
        path: "/v1/roughness",
        values: &[
            ("rms_height_um", "0.2"),
            ("correlation_length_um", "4"),
            ("wavelength_um", "0.55"),
            ("theta_i_deg", "30"),
        ],
    },
    Link { path: "/v1/materials/{name}", values: &[("wavelength_um", "0.633")] },
    Link {
        path: "/v1/diagrams",
        values: &[
            ("model", "\"beckmann_spizzichino\""),
            ("rms_height_um", "0.5"),
            ("correlation_length_um", "5"),
            ("wavelength_um", "0.5"),
            ("sweep", "\"theta_r_deg\""),
            ("from_deg", "-80"),
            ("to_deg", "80"),
            ("step_deg", "5"),
            ("at_deg", "[10, 30, 45, 60]"),
            ("scale", "\"log10\""),
            ("width_px", "600"),
        ],
    },
    Link {
        path: "/v1/figures/{id}",
        values: &[("form", "\"polar\""), ("scale", "\"log10\""), ("decades", "4"), ("theme", "\"dark\"")],
    },
];

const fn example(
    path: &'static str,
    name: &'static str,
    summary: &'static str,
    body: &'static str,
) -> Example {
    Example { path, name, summary, body }
}
