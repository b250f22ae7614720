// Two more pictures of the scene: how much light comes back in all, and what accuracy costs.

import { directions, radiance, scene } from "./bodies.js";
import { axis, decades, extent, layout } from "./plotting.js";
import { json, lines } from "./service.js";
import { bound, name, number } from "./words.js";

const INCIDENCES = Array.from({ length: 45 }, (_, i) => i * 2);

/** The request of the albedo table. */
export const albedoRequest = (state) => ({ ...scene(state), theta_i_deg: INCIDENCES });

/** The albedo by incidence: every row costs an integral, so rows are counted as they arrive. */
export async function loadAlbedo(state, signal, progress) {
  let heads;
  const rows = [];
  progress.begin(INCIDENCES.length, "incidences");
  try {
    await lines("v1/albedo", { body: albedoRequest(state), accept: "text/csv", signal }, (line) => {
      if (line === "") return;
      const cells = line.split(",");
      if (!heads) heads = cells;
      else rows.push(cells.map((cell) => (cell === "" ? null : Number(cell))));
      progress.reach(rows.length);
    });
  } finally {
    progress.end();
  }
  const column = (head) => rows.map((row) => row[heads.indexOf(head)]);
  const shown = ["total", "diffuse_lobe", "specular_lobe", "specular_spike", "fresnel_reflectance"].filter((head) =>
    heads.includes(head),
  );
  return {
    x: column("theta_i_deg"),
    columns: Object.fromEntries(shown.map((head) => [head, column(head)])),
    bounds: column("relative_error_bound"),
  };
}

const LOOK = {
  total: [0, "solid"],
  diffuse_lobe: [1, "dot"],
  specular_lobe: [2, "dash"],
  specular_spike: [3, "dashdot"],
  fresnel_reflectance: [5, "solid"],
};

/** Albedo over the incidence, and 1 as a line that no surface crosses. */
export function albedo(data, state, colours, whole) {
  const log = state.scale === "log10";
  const keys = Object.keys(data.columns);
  const value = (number) => (log ? (number > 0 ? Math.log10(number) : null) : number);
  const traces = keys.map((key) => ({
    type: "scatter",
    mode: "lines",
    name: key === "fresnel_reflectance" ? "F′ of a smooth plate" : name(key),
    x: data.x,
    y: data.columns[key].map(value),
    line: {
      color: colours.colours[LOOK[key][0]],
      dash: LOOK[key][1],
      width: key === "total" ? 2.4 : key === "fresnel_reflectance" ? 1 : 1.8,
    },
    customdata: data.columns[key].map((value) => number(value, 5)),
    hovertemplate: "%{x}°: %{customdata}",
  }));
  const [least, most] = extent(traces.map(({ y }) => y));
  const side = log ? decades(least, most, whole ? Infinity : 8) : { rangemode: "tozero" };
  const one = log ? 0 : 1;
  return {
    traces,
    layout: layout(colours, {
      xaxis: axis(colours, { title: { text: "θ<sub>i</sub> (degrees)", standoff: 6 }, ticksuffix: "°" }),
      yaxis: axis(colours, { title: { text: "Share of the beam", standoff: 8 }, ...side }),
      shapes: [
        {
          type: "line",
          xref: "paper",
          x0: 0,
          x1: 1,
          y0: one,
          y1: one,
          line: { color: colours.muted, width: 1, dash: "dot" },
        },
      ],
    }),
    clipped: log && most - least > 8,
  };
}

/** In words. */
export function albedoWords(data) {
  const { total } = data.columns;
  const most = total.reduce((best, value, i) => (value !== null && (best < 0 || value > total[best]) ? i : best), -1);
  if (most < 0) return "No incidence has a finite albedo.";
  return `Of a beam at normal incidence ${number(total[0])} comes back; most at θ_i = ${data.x[most]}°: ${number(total[most])}.`;
}

/** As a table. */
export function albedoTable(data) {
  const keys = Object.keys(data.columns);
  const rows = data.x.map((x, at) => [
    `${x}°`,
    ...keys.map((key) => number(data.columns[key][at], 6)),
    bound(data.bounds[at]),
  ]);
  return { heads: ["θ_i", ...keys.map(name), "error bound"], rows, every: 1 };
}

/** The request of a trade: the directions of the diagram, thinned to what is measured. */
export const tradeoffRequest = (state) => radiance(state, directions(state, 64));

/** Measures every method now. */
export const loadTradeoff = (state, signal) => json("v1/tradeoff", { body: tradeoffRequest(state), signal });

/** Methods that often do alike have their names on two sides. */
const PLACES = {
  auto: "middle left",
  series: "top right",
  paper: "bottom right",
  smooth: "top right",
  rough: "bottom right",
};

/** Largest error over time, one point for each way to evaluate the scene. */
export function tradeoff(data, state, colours) {
  // An error of exactly 0 has no logarithm; the service counts none below the reference's own bound.
  const rows = data.rows.filter((row) => row.largest_relative_error > 0);
  const log = Math.log10;
  const text = (row) => (row.method === "auto" ? `auto at ${number(row.relative_tolerance)}` : name(row.method));
  const told = (row) =>
    `${text(row)}<br>${number(row.nanoseconds_per_direction, 3)} ns a direction, ${number(row.time_ratio, 3)} × the cheapest<br>largest error ${bound(row.largest_relative_error)}, bound ${bound(row.largest_relative_error_bound)}`;
  const group = (title, members, colour, symbol) => ({
    type: "scatter",
    mode: "markers+text",
    name: title,
    x: members.map((row) => log(row.nanoseconds_per_direction)),
    y: members.map((row) => log(row.largest_relative_error)),
    // With room for the marks of the bounds.
    text: members.map((row) =>
      row.method === "auto" ? `${number(row.relative_tolerance)}   ` : `  ${name(row.method)}`,
    ),
    textposition: members.map((row) => PLACES[row.method] ?? "middle right"),
    textfont: { size: 11, color: colours.text },
    customdata: members.map(told),
    hovertemplate: "%{customdata}<extra></extra>",
    marker: {
      size: members.map((row) => (row.as_requested ? 15 : 10)),
      symbol,
      color: colour,
      line: { color: colours.text, width: members.map((row) => (row.as_requested ? 2 : 0)) },
    },
  });
  const auto = rows.filter((row) => row.method === "auto");
  const named = rows.filter((row) => row.method !== "auto");
  const bounds = rows.filter((row) => row.largest_relative_error_bound > 0);
  const traces = [
    {
      type: "scatter",
      mode: "markers",
      name: "bound stated",
      x: bounds.map((row) => log(row.nanoseconds_per_direction)),
      y: bounds.map((row) => log(row.largest_relative_error_bound)),
      marker: { symbol: "line-ew-open", size: 12, color: colours.muted, line: { width: 2 } },
      hoverinfo: "skip",
    },
    group("auto, by tolerance", auto, colours.colours[0], "circle"),
    group("by name", named, colours.colours[1], "diamond"),
  ].filter((trace) => trace.x.length > 0);
  const xs = extent(traces.map(({ x }) => x));
  const ys = extent(traces.map(({ y }) => y));
  const padded = ([least, most], by) => (Number.isFinite(least) ? [least - by, most + by] : [-1, 1]);
  return {
    traces,
    layout: layout(colours, {
      hovermode: "closest",
      xaxis: axis(colours, {
        title: { text: "Nanoseconds a direction, measured now", standoff: 6 },
        ...decades(...padded(xs, 0.35)),
      }),
      yaxis: axis(colours, { title: { text: "Largest relative error", standoff: 8 }, ...decades(...padded(ys, 0.6)) }),
    }),
    clipped: false,
  };
}

/** In words. */
export function tradeoffWords(data) {
  const asked = data.rows.find((row) => row.as_requested);
  const cheapest = data.rows.reduce((best, row) => (row.time_ratio < best.time_ratio ? row : best), data.rows[0]);
  if (!asked) return "";
  return (
    `As asked: ${number(asked.nanoseconds_per_direction, 3)} ns a direction, largest error ${bound(asked.largest_relative_error)}, bound ${bound(asked.largest_relative_error_bound)}. ` +
    `Cheapest: ${name(cheapest.method).toLowerCase()}, ${number(cheapest.nanoseconds_per_direction, 3)} ns. Reference: ${name(data.reference.method).toLowerCase()}.`
  );
}

/** As a table. */
export function tradeoffTable(data) {
  const rows = data.rows.map((row) => [
    row.method === "auto" ? `auto at ${number(row.relative_tolerance)}` : name(row.method),
    number(row.nanoseconds_per_direction, 3),
    number(row.time_ratio, 3),
    bound(row.largest_relative_error),
    bound(row.median_relative_error),
    bound(row.largest_relative_error_bound),
    row.keeps_tolerance ? "yes" : "no",
  ]);
  return {
    heads: ["method", "ns a direction", "ratio", "largest error", "median error", "bound", "keeps the tolerance"],
    rows,
    every: 1,
  };
}
