// The plot library, loaded when everything else is there, and the look of its plots.

import { powerOfTen } from "./words.js";

let loading;

/** The library, fetched once. */
export function library() {
  loading ??= new Promise((resolve, reject) => {
    const script = document.createElement("script");
    script.src = document.body.dataset.plotly;
    script.addEventListener("load", () => resolve(globalThis.Plotly));
    script.addEventListener("error", () => {
      loading = undefined;
      script.remove();
      reject(new Error("The plot library could not be loaded."));
    });
    document.head.append(script);
  });
  return loading;
}

const LIGHT = ["#0b62c4", "#c2500c", "#0f7b4f", "#8b2fc9", "#b0134a", "#66700a", "#0b7285", "#6b4226"];
const DARK = ["#6cb2ff", "#ff9d5c", "#4fd39b", "#cf9bff", "#ff86aa", "#d6d35a", "#5fd4e6", "#d9a77f"];

/** Colours as the page has them now. */
export function theme() {
  const probe = document.createElement("span");
  document.body.append(probe);
  const read = (name) => {
    probe.style.color = `var(${name})`;
    return getComputedStyle(probe).color;
  };
  const found = {
    text: read("--text"),
    muted: read("--muted"),
    line: read("--line"),
    card: read("--card"),
    accent: read("--accent"),
  };
  probe.remove();
  const [red, green, blue] = found.card.match(/\d+(\.\d+)?/g).map(Number);
  found.isDark = red + green + blue <= 384;
  found.colours = found.isDark ? DARK : LIGHT;
  return found;
}

/** What all plots have in common. */
export function layout(colours, more) {
  return {
    paper_bgcolor: "rgba(0,0,0,0)",
    plot_bgcolor: "rgba(0,0,0,0)",
    font: { family: 'system-ui, -apple-system, "Segoe UI", Roboto, sans-serif', size: 13, color: colours.text },
    margin: { l: 62, r: 14, t: 30, b: 46 },
    colorway: colours.colours,
    legend: { orientation: "h", x: 0, y: 1.01, yanchor: "bottom", font: { size: 12 }, bgcolor: "rgba(0,0,0,0)" },
    hoverlabel: { font: { size: 12 } },
    dragmode: matchMedia("(pointer: coarse)").matches ? false : "zoom",
    ...more,
  };
}

/** An axis in the page's colours. */
export const axis = (colours, more) => ({
  gridcolor: colours.line,
  linecolor: colours.muted,
  zerolinecolor: colours.line,
  ticks: "outside",
  tickcolor: colours.line,
  ticklen: 4,
  automargin: true,
  ...more,
});

/** An axis of decimal logarithms: ticks at whole powers, as many as there is room for, and a range that begins no
 * more than `depth` decades below the top. */
export function decades(least, most, depth = Infinity) {
  if (!Number.isFinite(least) || !Number.isFinite(most)) return {};
  const bottom = Math.max(least, most - depth);
  const margin = Math.max(0.03 * (most - bottom), 0.05);
  const range = [bottom - margin, most + margin];
  // All the way down, for who zooms out; but no endless list.
  const every = Math.max(1, Math.ceil((range[1] - range[0]) / 8));
  const first = Math.max(Math.floor(least), Math.floor(range[0]) - 400 * every);
  const tickvals = [];
  for (let at = Math.ceil(range[1] / every) * every; at >= first; at -= every) tickvals.push(at);
  if (range[1] - range[0] < 2) {
    const ticks = [];
    for (let at = Math.floor(range[0]); at <= range[1]; at += 1) {
      for (const digit of [1, 2, 5])
        ticks.push([at + Math.log10(digit), `${digit === 1 ? "" : `${digit}·`}${powerOfTen(at)}`]);
    }
    return { range, tickvals: ticks.map(([at]) => at), ticktext: ticks.map(([, text]) => text) };
  }
  return { range, tickvals, ticktext: tickvals.map(powerOfTen) };
}

/** Beyond this zenith no value sets the scale: towards grazing views the models grow without bound. */
export const SCALED = 80;

/** A linear axis from 0 to what is there short of grazing; with the whole range, to the largest of all. */
export function upTo(lines, whole) {
  const inner = extent(lines.map(({ x, y }) => y.filter((_, at) => Math.abs(x[at]) <= SCALED)))[1];
  const [least, most] = extent(lines.map(({ y }) => y));
  const isClipped = inner > 0 && most > 1.3 * inner;
  if (!isClipped || whole) return { side: { rangemode: "tozero" }, isClipped, most };
  return { side: { range: [Math.min(0, least), 1.06 * inner] }, isClipped, most: inner };
}

/** Least and largest of the numbers in columns that may hold nulls; infinite if there are none. */
export function extent(columns) {
  let least = Infinity;
  let most = -Infinity;
  for (const column of columns) {
    for (const value of column) {
      if (value === null || !Number.isFinite(value)) continue;
      if (value < least) least = value;
      if (value > most) most = value;
    }
  }
  return [least, most];
}

export const CONFIGURATION = { displayModeBar: false, responsive: true, displaylogo: false };
