// All directions of the hemisphere at once: as a disc seen from above, and as a lobe in space.

import { radiance, source } from "./bodies.js";
import { SCALED, axis, decades, extent, layout } from "./plotting.js";
import { json } from "./service.js";
import { fromLog10, name, number, subscript, unit } from "./words.js";

/** Degrees between the points of the disc: 11,300 directions. */
const DISC = 1.5;
const DEPTH = 6;
const degrees = 180 / Math.PI;
const rounded = (angle) => Number(angle.toFixed(9));

const rated = (data, values) =>
  extent(values.map((row, i) => row.filter((_, j) => data.grid.cells[i][j]?.[0] <= SCALED)));

/** Zenith and azimuth of every point of the disc, whose radius is the zenith; null outside of it. */
function disc() {
  const side = Array.from({ length: 180 / DISC + 1 }, (_, i) => i * DISC - 90);
  const cells = side.map((y) =>
    side.map((x) => {
      const zenith = Math.hypot(x, y);
      return zenith <= 90 ? [rounded(zenith), rounded(Math.atan2(y, x) * degrees)] : null;
    }),
  );
  return { side, cells };
}

/** Rows of one zenith, columns of one azimuth. */
function globe() {
  const zeniths = Array.from({ length: 61 }, (_, i) => i * 1.5);
  const azimuths = Array.from({ length: 91 }, (_, i) => i * 4);
  return zeniths.map((zenith) => azimuths.map((azimuth) => [zenith, azimuth === 360 ? 0 : azimuth]));
}

/** The request of a plot of this kind. */
export function request(state) {
  const lobe = state.plot === "lobe";
  const grid = lobe ? { cells: globe() } : disc();
  const inside = grid.cells.flat().filter(Boolean);
  const geometry = {
    theta_i_deg: source(state),
    theta_r_deg: inside.map(([zenith]) => zenith),
    phi_r_deg: inside.map(([, azimuth]) => azimuth),
  };
  const output = { log10: state.scale === "log10" };
  return { path: state.quantity === "brdf" ? "v1/brdf" : "v1/radiance", body: radiance(state, geometry, output), grid };
}

/** Asks for it, and puts the answer's numbers back on the grid. */
export async function load(state, signal) {
  const { path, body, grid } = request(state);
  const answer = await json(path, { body, signal });
  const on = (column) => {
    let next = 0;
    return grid.cells.map((row) => row.map((cell) => (cell ? column[next++] : null)));
  };
  const total = on(answer.total);
  const logs = on(answer.log10_total ?? answer.total.map((value) => (value > 0 ? Math.log10(value) : null)));
  const hasSpike = answer.specular_spike !== undefined;
  return {
    answer,
    grid,
    total,
    logs,
    source: body.geometry.theta_i_deg,
    hasSpike,
    unit: answer.unit,
    quantity: answer.quantity,
  };
}

const shown = (data) => data.logs.map((row) => row.map((value) => (value === null ? "" : fromLog10(value))));

function colourBar(data, log, least, most, whole) {
  const title = { text: unit(data.unit), side: "right", font: { size: 12 } };
  if (!log) return { bar: { title, thickness: 14, exponentformat: "power", outlinewidth: 0 } };
  const { range, tickvals, ticktext } = decades(least, most, whole ? Infinity : DEPTH);
  return { bar: { title, thickness: 14, tickvals, ticktext, outlinewidth: 0 }, range };
}

/** Circles of one zenith, and where the source and the mirror direction are. */
function marks(data, colours) {
  const circle = (radius) => ({
    type: "circle",
    x0: -radius,
    x1: radius,
    y0: -radius,
    y1: radius,
    line: { color: colours.muted, width: radius === 90 ? 1.2 : 0.6, dash: radius === 90 ? "solid" : "dot" },
  });
  const label = (x, text, more) => ({
    x,
    y: 0,
    text,
    showarrow: false,
    font: { size: 12, color: colours.text },
    bgcolor: colours.card,
    opacity: 0.9,
    borderpad: 2,
    ...more,
  });
  const rings = [30, 60].map((radius) => ({
    x: 0,
    y: -radius,
    text: `${radius}°`,
    showarrow: false,
    font: { size: 11, color: colours.text },
    bgcolor: colours.card,
    opacity: 0.8,
    borderpad: 1,
  }));
  const cross = {
    type: "scatter",
    mode: "markers",
    x: [-data.source, data.source],
    y: [0, 0],
    hoverinfo: "text",
    showlegend: false,
    text: [`source, θ_i = ${data.source}°`, "mirror direction"],
    marker: {
      symbol: ["star", "x-thin"],
      size: [11, 11],
      color: colours.text,
      line: { width: 1.6, color: [colours.card, colours.text] },
    },
  };
  return {
    shapes: [30, 60, 90].map(circle),
    annotations: [
      ...rings,
      label(-98, "180°", { xanchor: "right", bgcolor: undefined }),
      label(98, subscript("φ_r = 0°"), { xanchor: "left", bgcolor: undefined }),
    ],
    cross,
  };
}

/** The hemisphere as a disc. */
export function disk(data, state, colours, whole) {
  const log = state.scale === "log10";
  const z = log ? data.logs : data.total;
  const [least, most] = rated(data, z);
  const { bar, range } = colourBar(data, log, least, most, whole);
  const { shapes, annotations, cross } = marks(data, colours);
  const { side } = data.grid;
  const heat = {
    type: "heatmap",
    x: side,
    y: side,
    z,
    colorscale: "Viridis",
    colorbar: bar,
    customdata: shown(data),
    zsmooth: false,
    hoverongaps: false,
    text: data.grid.cells.map((row) =>
      row.map((cell) => (cell ? `θ_r ${number(cell[0])}°, φ_r ${number(cell[1])}°` : "")),
    ),
    hovertemplate: "%{text}: %{customdata}<extra></extra>",
    ...(range ? { zmin: range[0], zmax: range[1] } : { zmin: 0, zmax: most || 1 }),
  };
  const bare = { visible: false, range: [-92, 92], constrain: "domain" };
  return {
    traces: [heat, cross],
    layout: layout(colours, {
      margin: { l: 44, r: 10, t: 10, b: 10 },
      shapes,
      annotations,
      showlegend: false,
      xaxis: axis(colours, { ...bare, range: [-118, 125] }),
      yaxis: axis(colours, { ...bare, scaleanchor: "x" }),
    }),
    clipped: log && most - least > DEPTH,
  };
}

/** The hemisphere as a surface whose distance from the point is the value. */
export function lobe(data, state, colours, whole) {
  const log = state.scale === "log10";
  const values = log ? data.logs : data.total;
  const [least, most] = rated(data, values);
  const { bar, range } = colourBar(data, log, least, most, whole);
  const base = range ? range[0] : 0;
  const reach = (value) => (value === null ? 0 : Math.min(1.1, Math.max(0, (value - base) / (most - base || 1))));
  const grid = data.grid.cells;
  const place = (along) =>
    grid.map((row, i) =>
      row.map(([zenith, azimuth], j) => reach(values[i][j]) * along(zenith / degrees, azimuth / degrees)),
    );
  const surface = {
    type: "surface",
    x: place((zenith, azimuth) => Math.sin(zenith) * Math.cos(azimuth)),
    y: place((zenith, azimuth) => Math.sin(zenith) * Math.sin(azimuth)),
    z: place((zenith) => Math.cos(zenith)),
    surfacecolor: values,
    colorscale: "Viridis",
    colorbar: bar,
    customdata: shown(data),
    hovertemplate: "%{customdata}<extra></extra>",
    cmin: base,
    cmax: range ? range[1] : most || 1,
  };
  const ray = (side, label, dash) => ({
    type: "scatter3d",
    mode: "lines",
    name: label,
    hoverinfo: "name",
    line: { color: colours.text, width: 4, dash },
    x: [side * 1.1 * Math.sin(data.source / degrees), 0],
    y: [0, 0],
    z: [1.1 * Math.cos(data.source / degrees), 0],
  });
  const wall = {
    title: { text: "" },
    showticklabels: false,
    gridcolor: colours.line,
    zerolinecolor: colours.muted,
    backgroundcolor: "rgba(0,0,0,0)",
    range: [-1.1, 1.1],
  };
  return {
    traces: [surface, ray(-1, "source", "solid"), ray(1, "mirror direction", "dash")],
    layout: layout(colours, {
      margin: { l: 0, r: 0, t: 0, b: 0 },
      showlegend: false,
      dragmode: "turntable",
      scene: {
        xaxis: wall,
        yaxis: wall,
        zaxis: { ...wall, range: [0, 1.1] },
        aspectmode: "manual",
        aspectratio: { x: 1.8, y: 1.8, z: 0.9 },
        camera: { eye: { x: 1.1, y: -1.7, z: 0.7 }, center: { x: 0, y: 0, z: -0.1 } },
      },
    }),
    clipped: log && most - least > DEPTH,
  };
}

/** In words. */
export function words(data) {
  let best = null;
  data.logs.forEach((row, i) =>
    row.forEach((value, j) => {
      if (value !== null && data.grid.cells[i][j] && (best === null || value > best.value))
        best = { value, cell: data.grid.cells[i][j] };
    }),
  );
  if (!best) return "No direction has a finite value.";
  const spike = data.hasSpike
    ? " The specular spike is narrower than the distance of the points: what is drawn of it is the mirror direction."
    : "";
  return `Source at θ_i = ${number(data.source)}°. Largest ${fromLog10(best.value)} at θ_r = ${number(best.cell[0])}°, φ_r = ${number(best.cell[1])}°.${spike}`;
}

/** Along the plane of incidence. */
export function table(data) {
  const { answer } = data;
  const rows = [];
  let next = 0;
  for (const cell of data.grid.cells.flat()) {
    if (!cell) continue;
    const at = next++;
    if (cell[1] !== 0 && cell[1] !== 180) continue;
    rows.push([
      `${number(cell[1] === 0 ? cell[0] : -cell[0], 6)}°`,
      number(answer.total[at], 8),
      number(answer.relative_error_bound[at], 3),
    ]);
  }
  rows.sort((a, b) => Number.parseFloat(a[0]) - Number.parseFloat(b[0]));
  return { heads: [`${name("theta_r_deg")} in the plane of incidence`, "total", "error bound"], rows, every: 1 };
}
