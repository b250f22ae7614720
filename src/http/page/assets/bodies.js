// Request bodies out of the flat names of the state.

import { list, points, query } from "./state.js";

const SURFACE = [
  "rms_height_um",
  "correlation_length_um",
  "facet_slope_deg",
  "diffuse_albedo",
  "specular_scale",
  "shadowing",
  "fresnel_average",
];
const SENSOR = [
  "footprint_um2",
  "patch_half_x_um",
  "patch_half_y_um",
  "pixel_area_um2",
  "distance_um",
  "focal_length_um",
  "aperture_um",
  "off_axis_deg",
  "receiver_half_angle_deg",
];
const TEXTS = new Set(["shadowing", "fresnel_average", "material", "source", "polarization", "method"]);

/** A field's value as JSON has it; what is no number goes as it is, for the service to say so. */
function value(name, text) {
  if (TEXTS.has(name)) return text;
  const number = Number(text);
  return text.trim() === "" || Number.isNaN(number) ? text : number;
}

function pick(from, names) {
  const found = names.filter((name) => from[name] !== undefined).map((name) => [name, value(name, from[name])]);
  return Object.fromEntries(found);
}

/** The scene: a request without directions. */
export function scene(state) {
  const flat = query(state);
  const surface = pick(flat, SURFACE);
  if (flat.material !== undefined) surface.medium = pick(flat, ["material", "source"]);
  else if (flat.n !== undefined) surface.medium = pick(flat, ["n", "k"]);
  const illumination = pick(flat, ["irradiance", "polarization"]);
  if (flat.wavelength_um !== undefined) {
    const all = flat.wavelength_um.split(",").map((text) => value("wavelength_um", text));
    illumination.wavelength_um = all.length === 1 ? all[0] : all;
  }
  if (flat.parallel !== undefined) illumination.polarization = pick(flat, ["parallel", "perpendicular"]);
  const body = { model: flat.model, surface, illumination };
  const sensor = pick(flat, SENSOR);
  if (Object.keys(sensor).length > 0) body.sensor = sensor;
  if (flat.components !== undefined && flat.components !== "auto") body.components = flat.components.split(",");
  const accuracy = pick(flat, ["relative_tolerance", "method"]);
  if (Object.keys(accuracy).length > 0) body.accuracy = accuracy;
  return body;
}

/** The source's zenith for plots that have one source: the first of the fixed angles. */
export const source = (state) => Math.min(90, Math.abs(list(state.at_deg)[0] ?? 30));

/** The directions of the sweep, at most so many for each fixed angle. */
export function directions(state, most) {
  const from = Number(state.from_deg);
  const to = Number(state.to_deg);
  const count = Math.max(2, Math.min(most, points(state) || 2));
  const swept = Array.from({ length: count }, (_, i) => from + ((to - from) * i) / (count - 1));
  const over = state.sweep === "theta_i_deg";
  const phi = Number(state.phi_r_deg || 0);
  const geometry = { theta_i_deg: [], theta_r_deg: [], phi_r_deg: [] };
  for (const at of list(state.at_deg)) {
    for (const angle of swept) {
      // A source at a negative zenith is one at the positive, seen from the other side.
      const [source, viewer] = over ? [Math.abs(angle), angle < 0 ? -at : at] : [at, angle];
      geometry.theta_i_deg.push(source);
      geometry.theta_r_deg.push(viewer);
      geometry.phi_r_deg.push(phi);
    }
  }
  return geometry;
}

/** One wavelength: plans, trades and hemispheres are of one. */
export function atOneWavelength(body) {
  const wavelength = body.illumination.wavelength_um;
  if (!Array.isArray(wavelength)) return body;
  return { ...body, illumination: { ...body.illumination, wavelength_um: wavelength[0] } };
}

/** A request of /v1/radiance, /v1/brdf, /v1/plan or /v1/tradeoff. */
export const radiance = (state, geometry, output) => ({
  ...atOneWavelength(scene(state)),
  geometry,
  ...(output ? { output } : {}),
});
