// Which controls there are, in which group, and over what a slider runs. Ranges, choices and explanations are the
// service's own: they come out of its document at run time.

import { list } from "./state.js";

const heights = (state) =>
  state.model !== "lambertian" && !(state.model === "torrance_sparrow" && state.facet_slope_deg);
const facets = (state) => state.model === "torrance_sparrow" || state.model === "unified";
const specular = (state) => state.model !== "lambertian";
const diffuse = (state) => state.model !== "beckmann_spizzichino";

/** σ_h over λ, and σ_h over T: what the models depend on. */
const roughness = (state) => Number(state.rms_height_um) / list(state.wavelength_um)[0];
const slope = (state) => Number(state.rms_height_um) / Number(state.correlation_length_um);
const digits = (value) => String(Number(value.toPrecision(5)));

/** Two sliders that are no fields of the service: they move several. */
const DERIVED = [
  {
    name: "roughness",
    label: "Roughness",
    symbol: "σ_h / λ",
    unit: "λ",
    log: [0.002, 10],
    when: heights,
    derived: true,
    hint: "Moves σ_h and T together, so that the slope stays: from a mirror with a spike to a rough surface with a lobe.",
    get: roughness,
    set: (state, value) => {
      const height = value * (list(state.wavelength_um)[0] || 1);
      return { rms_height_um: digits(height), correlation_length_um: digits(height / slope(state)) };
    },
  },
  {
    name: "slope",
    label: "Slope",
    symbol: "σ_h / T",
    unit: "",
    log: [0.002, 1],
    when: heights,
    derived: true,
    hint: "Moves T: gentle surfaces have narrow lobes.",
    get: slope,
    set: (state, value) => ({ correlation_length_um: digits(Number(state.rms_height_um) / value) }),
  },
];

/** The groups in their order. `log` and `linear` are the ends of a slider; the box beside it takes all that the
 * service takes. */
export const GROUPS = [
  {
    title: "Model",
    open: true,
    said: (state) => state.model,
    fields: [
      { name: "model", label: "Model", choices: true },
      { name: "quantity", label: "Quantity", choices: true, empty: "radiance" },
      { name: "components", label: "Components", several: ["diffuse_lobe", "specular_lobe", "specular_spike"] },
    ],
  },
  {
    title: "Surface",
    open: true,
    said: (state) => (state.rms_height_um ? `σ_h ${state.rms_height_um} µm` : ""),
    fields: [
      ...DERIVED,
      { name: "rms_height_um", label: "RMS height", symbol: "σ_h", log: [1e-4, 100], when: specular },
      { name: "correlation_length_um", label: "Correlation length", symbol: "T", log: [1e-3, 1000], when: specular },
      {
        name: "facet_slope_deg",
        label: "Facet slope",
        symbol: "σ_α",
        log: [0.01, 60],
        empty: "from σ_h/T",
        when: facets,
      },
      { name: "diffuse_albedo", label: "Diffuse albedo", symbol: "ρ", linear: [0, 1, 0.01], empty: "0", when: diffuse },
      { name: "specular_scale", label: "Specular scale", symbol: "c·a_f", empty: "normalized", when: facets },
      { name: "shadowing", label: "Shadowing", choices: true, empty: "of the model", when: specular },
    ],
  },
  {
    title: "Medium",
    said: (state) =>
      state.medium === "material"
        ? state.material
        : state.medium === "index"
          ? `${state.n} − ${state.k || 0}i`
          : "perfect conductor",
    fields: [
      { name: "medium", label: "Medium", kinds: ["perfect_conductor", "index", "material"] },
      { name: "material", label: "Material", materials: true, when: (state) => state.medium === "material" },
      {
        name: "source",
        label: "Source of n and k",
        sources: true,
        empty: "default",
        when: (state) => state.medium === "material",
      },
      { name: "n", label: "Index", symbol: "n", linear: [0.05, 4, 0.01], when: (state) => state.medium === "index" },
      {
        name: "k",
        label: "Extinction",
        symbol: "k",
        linear: [0, 10, 0.01],
        empty: "0",
        when: (state) => state.medium === "index",
      },
      {
        name: "fresnel_average",
        label: "Average of F",
        choices: true,
        empty: "half_vector",
        when: (state) => state.medium !== "perfect_conductor",
      },
    ],
  },
  {
    title: "Light",
    said: (state) => (state.wavelength_um ? `λ ${state.wavelength_um} µm` : ""),
    fields: [
      { name: "wavelength_um", label: "Wavelength", symbol: "λ", log: [1e-4, 100], list: true },
      { name: "irradiance", label: "Irradiance", empty: "1", log: [1e-3, 1e6] },
      { name: "polarization", label: "Polarization", choices: true, more: ["mix"], empty: "unpolarized" },
      {
        name: "parallel",
        label: "Parallel share",
        symbol: "h",
        linear: [0, 1, 0.01],
        when: (state) => state.polarization === "mix",
      },
      {
        name: "perpendicular",
        label: "Perpendicular share",
        symbol: "v",
        linear: [0, 1, 0.01],
        when: (state) => state.polarization === "mix",
      },
    ],
  },
  {
    title: "Directions",
    open: true,
    said: (state) => `${state.sweep === "theta_i_deg" ? "θ_i" : "θ_r"} ${state.from_deg} to ${state.to_deg}°`,
    fields: [
      { name: "sweep", label: "Swept angle", choices: true },
      {
        name: "at_deg",
        label: "Fixed angles",
        linear: [0, 89.5, 0.5],
        list: true,
        symbolOf: (state) => (state.sweep === "theta_i_deg" ? "θ_r" : "θ_i"),
      },
      { name: "phi_r_deg", label: "Azimuth of the viewer", symbol: "φ_r", linear: [-180, 180, 1], empty: "0" },
      { name: "from_deg", label: "From", linear: [-90, 90, 0.5] },
      { name: "to_deg", label: "To", linear: [-90, 90, 0.5] },
      { name: "step_deg", label: "Step", log: [0.001, 10], empty: "1", when: (state) => !state.points },
      { name: "points", label: "Points instead of a step", empty: "by step" },
    ],
  },
  {
    title: "Sensor",
    said: (state) => state.sensor,
    fields: [
      { name: "sensor", label: "Sensor", kinds: ["none", "patch", "camera"] },
      ...[
        { name: "footprint_um2", label: "Footprint", log: [1e-2, 1e8] },
        { name: "patch_half_x_um", label: "Half patch along x", symbol: "X", log: [1e-2, 1e4] },
        { name: "patch_half_y_um", label: "Half patch along y", symbol: "Y", log: [1e-2, 1e4] },
      ].map((field) => ({ ...field, when: (state) => state.sensor === "patch" })),
      ...[
        { name: "pixel_area_um2", label: "Pixel area", symbol: "dA", log: [1, 1e4] },
        { name: "distance_um", label: "Distance", symbol: "z", log: [1e4, 1e7] },
        { name: "focal_length_um", label: "Focal length", symbol: "f", log: [1e3, 1e6] },
        { name: "aperture_um", label: "Aperture", symbol: "d", log: [1e2, 1e6] },
        { name: "off_axis_deg", label: "Off axis", symbol: "γ", linear: [0, 60, 0.5], empty: "0" },
      ].map((field) => ({ ...field, when: (state) => state.sensor === "camera" })),
      {
        name: "receiver_half_angle_deg",
        label: "Half angle of the receiver",
        symbol: "β",
        linear: [0, 15, 0.1],
        empty: "0",
      },
    ],
  },
  {
    title: "Accuracy",
    open: true,
    said: (state) => state.relative_tolerance || "1e-9",
    fields: [
      { name: "relative_tolerance", label: "Tolerance", symbol: "relative", log: [1e-15, 0.1], empty: "1e-9" },
      { name: "method", label: "Method of the lobe series", choices: true, empty: "auto" },
    ],
  },
  {
    title: "Picture",
    said: () => "",
    fields: [
      { name: "decades", label: "Decades of a log scale", empty: "12", optional: true },
      { name: "width_px", label: "Width of a file", empty: "720", unit: "px", optional: true },
      { name: "height_px", label: "Height of a file", empty: "480", unit: "px", optional: true },
      { name: "theme", label: "Colours of a file", choices: true, empty: "as the page", optional: true },
    ],
  },
  {
    title: "Answer",
    said: () => "",
    fields: [
      { name: "log10", label: "Logarithms", flag: "Add the logarithm of every value" },
      { name: "per_direction", label: "Per direction", flag: "Add method and roughness g of each direction" },
      { name: "angles", label: "Angles", flag: "Columns of angles in tables", empty: true },
    ],
  },
];

/** What a choice needs to begin with, so that taking it gives a scene that can be answered. */
export const BEGIN = {
  medium: { index: { n: "1.5", k: "0" }, material: { material: "Al" } },
  sensor: {
    patch: { footprint_um2: "16", patch_half_x_um: "2", patch_half_y_um: "2" },
    camera: { pixel_area_um2: "25", distance_um: "500000", focal_length_um: "25000", aperture_um: "5000" },
  },
  polarization: { mix: { parallel: "0.5", perpendicular: "0.5" } },
};

/** Which field a JSON Pointer means: the deepest name that has a control. */
export function pointed(pointer, known) {
  const names = pointer.split("/").slice(1).reverse();
  const directions = { theta_i_deg: "at_deg", theta_r_deg: "at_deg", geometry: "at_deg" };
  return names.map((name) => (known.has(name) ? name : directions[name])).find(Boolean);
}
