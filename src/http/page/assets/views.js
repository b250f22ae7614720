// Each way to look at the scene: how it is asked for, drawn, told and tabulated.

import * as charts from "./charts.js";
import * as curves from "./curves.js";
import * as diagram from "./diagram.js";
import * as hemisphere from "./hemisphere.js";
import { source } from "./bodies.js";
import { name, number } from "./words.js";

const ofCurves = (data) => data.curves.map(({ label, series }) => ({ ...series, label }));
const ofAnswer = ({ answer }) => [answer];
const nothing = () => [];

/** By the name of the plot. */
export const VIEWS = {
  curve: { load: diagram.load, draw: curves.cartesian, words: curves.words, table: curves.table, findings: ofCurves },
  polar: { load: diagram.load, draw: curves.polar, words: curves.words, table: curves.table, findings: ofCurves },
  hemisphere: {
    load: hemisphere.load,
    draw: hemisphere.disk,
    words: hemisphere.words,
    table: hemisphere.table,
    findings: ofAnswer,
  },
  lobe: {
    load: hemisphere.load,
    draw: hemisphere.lobe,
    words: hemisphere.words,
    table: hemisphere.table,
    findings: ofAnswer,
  },
  albedo: {
    load: charts.loadAlbedo,
    draw: charts.albedo,
    words: charts.albedoWords,
    table: charts.albedoTable,
    findings: nothing,
  },
  tradeoff: {
    load: charts.loadTradeoff,
    draw: charts.tradeoff,
    words: charts.tradeoffWords,
    table: charts.tradeoffTable,
    findings: nothing,
  },
};

/** Title and line below it. */
export function headline(state, data) {
  if (data.figure) return [`Figure ${data.figure.id}: ${data.figure.title}`, data.figure.parameters];
  const what = name(state.quantity || "radiance");
  const title = {
    curve: `${what} over ${name(state.sweep)}`,
    polar: `${what} over ${name(state.sweep)}, polar`,
    hemisphere: `${what} over the hemisphere, θ_i = ${number(source(state))}°`,
    lobe: `${what} in space, θ_i = ${number(source(state))}°`,
    albedo: "Albedo over θ_i: what comes back of the beam",
    tradeoff: "What accuracy costs in this scene",
  }[state.plot];
  const parts = [name(state.model)];
  const add = (symbol, key, unit) => state[key] && parts.push(`${symbol} = ${state[key].replaceAll(",", ", ")}${unit}`);
  if (state.model !== "lambertian") {
    if (state.facet_slope_deg) add("σ_α", "facet_slope_deg", "°");
    if (state.model !== "torrance_sparrow" || !state.facet_slope_deg) {
      add("σ_h", "rms_height_um", " µm");
      add("T", "correlation_length_um", " µm");
    }
  }
  if (state.model !== "beckmann_spizzichino") add("ρ", "diffuse_albedo", "");
  if (state.medium === "material") parts.push(state.material);
  if (state.medium === "index") parts.push(`n − ik = ${state.n} − ${state.k || 0}i`);
  add("λ", "wavelength_um", " µm");
  return [title, parts.join(" · ")];
}
