// Diagrams and figures of the service as curves: read whole, or line by line where they are long.

import { json, lines } from "./service.js";
import { encode, list, points, query, rows } from "./state.js";
import { name, number } from "./words.js";

/** Above so many rows a diagram is read as it streams, and drawn by the least and largest of each stretch. */
export const LONG = 20000;
const STRETCHES = 1000;
const COMPONENTS = ["diffuse_lobe", "specular_lobe", "specular_spike"];

/** The link of the state's diagram at the service. */
export function link(state) {
  if (state.figure)
    return `v1/figures/${encodeURIComponent(state.figure)}${state.scale === "log10" ? "?log10=true" : ""}`;
  const pairs = query(state);
  if (state.scale === "log10") pairs.log10 = "true";
  return `v1/diagrams?${encode(pairs)}`;
}

/** The link of the service's own picture of it. */
export function picture(state, isDark) {
  const { scale, curves, decades, width_px, height_px } = state;
  const options = {
    form: state.plot === "polar" ? "polar" : "cartesian",
    scale,
    curves,
    decades,
    width_px,
    height_px,
    theme: state.theme || (isDark ? "dark" : "light"),
  };
  const given = Object.fromEntries(Object.entries(options).filter(([, value]) => value));
  const path = link({ ...state, scale: "linear" });
  return `${path}${path.includes("?") ? "&" : "?"}${encode(given)}`;
}

/** The curves of a state. */
export async function load(state, signal, progress) {
  if (state.figure) {
    const figure = await json(link(state), { signal });
    const panels = figure.panels.map(({ label, diagram }) => curves(diagram, figure.panels.length > 1 ? label : ""));
    const all = panels.flatMap((panel, at) => panel.curves.map((curve) => ({ ...curve, panel: at })));
    return { ...panels[0], curves: all, figure };
  }
  if (rows(state) > LONG) return long(state, signal, progress);
  return curves(await json(link(state), { signal }), "");
}

function curves(diagram, label) {
  const { axis, fixed, quantity, unit, medium } = diagram;
  const made = diagram.series.map((series) => {
    const keys = [...COMPONENTS, "total", quantity].filter((key) => series[key]);
    const columns = Object.fromEntries(keys.map((key) => [key, series[key]]));
    const logs = Object.fromEntries(keys.map((key) => [key, series[`log10_${key}`] ?? series[key].map(logarithm)]));
    return { label: title(series, fixed, label, quantity), x: axis.values, columns, logs, series };
  });
  return { axis: axis.name, fixed: fixed?.name, quantity, unit, medium, curves: made };
}

const logarithm = (value) => (value > 0 ? Math.log10(value) : null);

/** What tells a curve from the others. */
function title(series, fixed, panel, quantity) {
  const parts = [];
  if (panel) parts.push(panel);
  if (series.at_deg !== undefined) parts.push(`${name(fixed.name)} = ${number(series.at_deg, 6)}°`);
  if (series.wavelength_um !== undefined) parts.push(`λ = ${number(series.wavelength_um)} µm`);
  if (parts.length === 0 || (!fixed && series.label)) parts.splice(0, parts.length, series.label ?? name(quantity));
  return parts.join(", ");
}

/** A long diagram: rows are counted as they arrive, and each stretch leaves two points of each column. */
async function long(state, signal, progress) {
  const total = rows(state);
  const each = points(state);
  const stretch = Math.max(1, Math.ceil(each / STRETCHES));
  const fixedAt = state.sweep === "theta_i_deg" ? "theta_r_deg" : "theta_i_deg";
  const found = new Map();
  let heading;
  let count = 0;
  progress.begin(total, "rows");
  const take = (line) => {
    if (line === "") return;
    const cells = line.split(",");
    if (!heading) {
      heading = columnsOf(cells, state.sweep, fixedAt);
      return;
    }
    const key = `${cells[heading.fixed]},${heading.wavelength < 0 ? "" : cells[heading.wavelength]}`;
    let curve = found.get(key);
    if (!curve) found.set(key, (curve = new Thinned(heading, stretch)));
    curve.add(cells);
    count += 1;
    if (count % 1000 === 0) progress.reach(count);
  };
  try {
    await lines(link(state), { accept: "text/csv", signal }, take);
  } finally {
    progress.end();
  }
  const made = [...found].map(([key, thinned]) => {
    const [at, wavelength] = key.split(",");
    const series = { at_deg: Number(at), methods: {}, omitted: [], warnings: [], diagnostics: [] };
    if (wavelength && list(state.wavelength_um).length > 1) series.wavelength_um = Number(wavelength);
    return { label: title(series, { name: fixedAt }, "", ""), ...thinned.curve(), series };
  });
  const quantity = state.quantity || "radiance";
  return {
    axis: state.sweep,
    fixed: fixedAt,
    quantity,
    unit: heading.unit,
    curves: made,
    rows: count,
    thinned: stretch > 1,
  };
}

/** Which column of a table is what: `total_W_m-2_sr-1`, `log10_total`. */
function columnsOf(cells, axis, fixed) {
  const values = [];
  let unit = "";
  cells.forEach((cell, at) => {
    for (const key of [...COMPONENTS, "total"]) {
      if (cell === `log10_${key}`) values.push({ key, at, log: true });
      else if (cell === key || cell.startsWith(`${key}_`)) {
        values.push({ key, at, log: false });
        if (key === "total")
          unit = cell
            .slice(key.length + 1)
            .replaceAll("_", " ")
            .replace(/([a-z])(-\d)/g, "$1^$2");
      }
    }
  });
  return {
    axis: cells.indexOf(axis),
    fixed: cells.indexOf(fixed),
    wavelength: cells.indexOf("wavelength_um"),
    values,
    unit,
  };
}

/** Least and largest of each stretch, in the order in which they came. */
class Thinned {
  constructor(heading, stretch) {
    this.heading = heading;
    this.stretch = stretch;
    this.count = 0;
    this.columns = heading.values.map(() => ({ x: [], y: [] }));
    this.open = heading.values.map(() => null);
  }

  add(cells) {
    const x = Number(cells[this.heading.axis]);
    this.heading.values.forEach(({ at }, column) => {
      const cell = cells[at];
      if (cell === "") return;
      const y = Number(cell);
      const open = this.open[column];
      if (!open) this.open[column] = { least: [x, y], most: [x, y] };
      else if (y < open.least[1]) open.least = [x, y];
      else if (y > open.most[1]) open.most = [x, y];
    });
    this.count += 1;
    if (this.count % this.stretch === 0) this.close();
  }

  close() {
    this.open.forEach((open, column) => {
      if (!open) return;
      const both = [open.least, open.most].sort((a, b) => a[0] - b[0]);
      const kept = open.least === open.most || both[0][0] === both[1][0] ? both.slice(0, 1) : both;
      for (const [x, y] of kept) {
        this.columns[column].x.push(x);
        this.columns[column].y.push(y);
      }
      this.open[column] = null;
    });
  }

  curve() {
    this.close();
    const columns = {};
    const logs = {};
    const xs = {};
    this.heading.values.forEach(({ key, log }, at) => {
      (log ? logs : columns)[key] = this.columns[at].y;
      xs[`${log}${key}`] = this.columns[at].x;
    });
    for (const key of Object.keys(columns)) logs[key] ??= columns[key].map(logarithm);
    return { x: xs.falsetotal, columns, logs, xOf: (key, log) => xs[`${log}${key}`] ?? xs[`false${key}`] };
  }
}
