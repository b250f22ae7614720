// Numbers and names as people write them.

const SUPERSCRIPT = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };

/** 10 to an integer power. */
export function powerOfTen(exponent) {
  return `10${[...String(exponent)].map((sign) => SUPERSCRIPT[sign]).join("")}`;
}

/** A number in a few digits, with × 10ⁿ where it is far from 1. */
export function number(value, digits = 4) {
  if (value === null || value === undefined) return "undefined";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e-3 && size < 1e5) return String(Number(value.toPrecision(digits)));
  const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
  const short = String(Number(mantissa));
  const power = powerOfTen(Number(exponent));
  return short === "1" ? power : `${short} × ${power}`;
}

/** A bound of an error: two digits are plenty. */
export const bound = (value) => (value === null || value === undefined ? "none known" : number(value, 2));

/** 10^x for an x whose power may be no double. */
export function fromLog10(exponent) {
  if (exponent === null || exponent === undefined) return "undefined";
  if (exponent > -300 && exponent < 300) return number(10 ** exponent);
  const whole = Math.floor(exponent);
  return `${Number((10 ** (exponent - whole)).toPrecision(3))} × ${powerOfTen(whole)}`;
}

/** The shortest text that still is the same slider position: links stay readable. */
export const compact = (value) => String(Number(value.toPrecision(4)));

const NAMES = {
  total: "total",
  diffuse_lobe: "diffuse lobe",
  specular_lobe: "specular lobe",
  specular_spike: "specular spike",
  radiance: "Radiance",
  brdf: "BRDF",
  fresnel_reflectance: "Fresnel reflectance F′",
  geometrical_attenuation: "Attenuation factor G",
  beckmann_spizzichino: "Beckmann-Spizzichino",
  torrance_sparrow: "Torrance-Sparrow",
  lambertian: "Lambertian",
  unified: "Unified",
  perfect_conductor: "Perfect conductor",
  index: "Index n − ik",
  material: "Material by name",
  none: "None",
  "of the model": "By the model",
  patch: "Footprint and patch",
  camera: "Camera",
  v_groove: "V-grooves (65)",
  smith: "Smith",
  smith_uncorrelated: "Smith, uncorrelated",
  half_vector: "Half vector",
  mean_plane: "Mean plane",
  slope_average: "Average over slopes",
  unpolarized: "Unpolarized",
  parallel: "Parallel",
  perpendicular: "Perpendicular",
  mix: "Mixture",
  auto: "Auto",
  series: "Series, converged",
  paper: "Paper, 100 terms",
  uniform: "Uniform (saddle point)",
  smooth: "Smooth (48)",
  rough: "Rough (49)",
  closed_form: "Closed form",
  theta_i_deg: "θ_i",
  theta_r_deg: "θ_r",
  local_incidence_deg: "local angle of incidence",
};

/** A name of the service's in words. */
export const name = (key) => NAMES[key] ?? key.replaceAll("_", " ");

/** A symbol with its index set lower, for the plot library. */
export const subscript = (text) => text.replace(/([θφσ])_([a-zα])/g, "$1<sub>$2</sub>");

/** Text with its indices set lower, as nodes: θ_r, σ_α, c·a_f. */
export function rich(text) {
  return text.split(/([θφσκΛa]_[a-zα])(?![a-z])/).map((part, at) => {
    if (at % 2 === 0) return part;
    const [letter, index] = part.split("_");
    const sub = document.createElement("sub");
    sub.append(index);
    const both = document.createElement("span");
    both.append(letter, sub);
    return both;
  });
}

const LOWER = { i: "ᵢ", r: "ᵣ", h: "ₕ" };

/** The same where there is only plain text: in a menu, or read aloud. */
export const plain = (text) => text.replace(/([θφσ])_([irh])(?![a-z])/g, (_, letter, index) => letter + LOWER[index]);

/** A unit in signs: W m^-2 becomes W m⁻². */
export const unit = (text) =>
  text.replace(/\^(-?\d+)/g, (_, digits) => [...digits].map((sign) => SUPERSCRIPT[sign]).join(""));

const UNITS = { micrometres: "µm", "square micrometres": "µm²", degrees: "°" };

/** The unit that the service states, as a sign. */
export const unitSign = (text) => UNITS[text] ?? unit(text);

/** "uniform × 120, series × 3" */
export function methods(counts) {
  const entries = Object.entries(counts).sort((a, b) => b[1] - a[1]);
  return entries.map(([method, count]) => `${method.replaceAll("_", " ")} × ${count}`).join(", ") || "none";
}

/** A snake_case code as a heading. */
export const heading = (code) => code.replaceAll("_", " ").replace(/^./, (first) => first.toUpperCase());

/** Makes an element: its attributes, then its children. */
export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === true) made.setAttribute(key, "");
    else if (value !== false && value !== undefined) made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}
