// The state of the page: the names and values of a link to /v1/diagrams, and a few names of how it is drawn.
// All of it stands in the fragment, so that every state is a link and the back button works.

/** How the answer is drawn, by the names that the service has for its own pictures where it has them; everything else is
 * the request. */
export const VIEW = ["plot", "figure", "scale", "curves", "decades", "theme", "width_px", "height_px"];
/** Choices of the page among fields that exclude each other. They follow from which of the fields are there. */
const KINDS = ["medium", "sensor"];
const PATCH = ["footprint_um2", "patch_half_x_um", "patch_half_y_um"];
const CAMERA = ["pixel_area_um2", "distance_um", "focal_length_um", "aperture_um", "off_axis_deg"];

/** What a visitor sees first: a spike that stands out of a lobe. */
export const START = {
  model: "beckmann_spizzichino",
  rms_height_um: "0.1",
  correlation_length_um: "2",
  wavelength_um: "0.55",
  medium: "perfect_conductor",
  sensor: "patch",
  footprint_um2: "400",
  patch_half_x_um: "10",
  patch_half_y_um: "10",
  sweep: "theta_r_deg",
  from_deg: "-80",
  to_deg: "80",
  step_deg: "0.5",
  at_deg: "30",
  plot: "curve",
  scale: "linear",
};

/** Where choices and directions begin if a link does not say. */
const DEFAULTS = { plot: "curve", scale: "linear", sweep: "theta_r_deg", from_deg: "-89", to_deg: "89", at_deg: "30" };

/** A state out of a link's parameters. */
export function parse(text) {
  const given = new URLSearchParams(text);
  // A link that names no scene is about the one that visitors see first.
  const state = given.has("model") || given.has("figure") ? { ...DEFAULTS } : { ...START };
  // A list may come as several parameters of one name.
  for (const key of given.keys()) state[key] = given.getAll(key).join(",");
  state.medium = state.material !== undefined ? "material" : state.n !== undefined ? "index" : "perfect_conductor";
  const has = (names) => names.some((name) => state[name] !== undefined);
  state.sensor = has(CAMERA) ? "camera" : has(PATCH) ? "patch" : "none";
  if (state.parallel !== undefined) state.polarization = "mix";
  return state;
}

/** The names of a state that the service gets: nothing that a choice of the state leaves out. */
export function query(state) {
  const left = new Set([...VIEW, ...KINDS]);
  if (state.medium !== "index") ["n", "k"].forEach((name) => left.add(name));
  if (state.medium !== "material") ["material", "source"].forEach((name) => left.add(name));
  if (state.sensor !== "patch") PATCH.forEach((name) => left.add(name));
  if (state.sensor !== "camera") CAMERA.forEach((name) => left.add(name));
  if (state.polarization === "mix") left.add("polarization");
  else ["parallel", "perpendicular"].forEach((name) => left.add(name));
  if (state.points) left.add("step_deg");
  const pairs = Object.entries(state).filter(([name, value]) => !left.has(name) && value !== "" && value !== undefined);
  return Object.fromEntries(pairs);
}

/** Parameters as a text that is a valid query and still readable: commas stay. */
export function encode(pairs) {
  return Object.entries(pairs)
    .map(([name, value]) => `${encodeURIComponent(name)}=${encodeURIComponent(value).replaceAll("%2C", ",")}`)
    .join("&");
}

/** The fragment that stands for a state. */
export function fragment(state) {
  const view = VIEW.filter((name) => state[name]).map((name) => [name, state[name]]);
  return encode({ ...query(state), ...Object.fromEntries(view) });
}

/** The numbers of a field that may be a list. */
export const list = (text) =>
  (text ?? "")
    .split(",")
    .map((part) => part.trim())
    .filter(Boolean)
    .map(Number);

/** How many rows the service will answer: points along the sweep, times fixed angles, times wavelengths. */
export function rows(state) {
  const series = Math.max(1, list(state.at_deg).length) * Math.max(1, list(state.wavelength_um).length);
  return series * points(state);
}

/** Points along the sweep. */
export function points(state) {
  if (state.points) return Number(state.points);
  const step = Number(state.step_deg || 1);
  return Math.floor((Number(state.to_deg) - Number(state.from_deg)) / step + 1e-9) + 1;
}

/** Keeps the state in the address bar. */
export class Address {
  /** `changed` is called with a state that a link or the back button asks for. */
  constructor(changed) {
    addEventListener("popstate", () => changed(this.state()));
    addEventListener("hashchange", () => changed(this.state()));
  }

  /** The state of the address as it stands. */
  state() {
    const text = location.hash.slice(1);
    return text.includes("=") ? parse(text) : { ...START };
  }

  /** A state worth going back to. */
  push(state) {
    const next = `#${fragment(state)}`;
    const now = location.hash || `#${fragment(START)}`;
    if (next !== now) history.pushState(null, "", next);
  }
}
