// Curves, Cartesian and polar, in total or by component.

import { axis, decades, extent, layout, upTo } from "./plotting.js";
import { fromLog10, name, number, subscript, unit } from "./words.js";

const DASHES = { total: "solid", diffuse_lobe: "dot", specular_lobe: "dash", specular_spike: "dashdot" };
/** So many decades are shown at first; "Whole range" shows the rest. */
const depth = (state) => Number(state.decades) || 12;

/** Which curves are drawn if nobody says: all of one scene, the totals of several. */
export const natural = (count) => (count > 1 ? "total" : "all");

/** Which columns of a curve are drawn: the total last, on top of its parts. */
function keys(curve, shown) {
  const all = Object.keys(curve.columns);
  if (!all.includes("total")) return all;
  const components = all.filter((key) => key !== "total");
  if (shown === "total" || components.length === 0) return ["total"];
  return shown === "components" ? components : [...components, "total"];
}

/** Every line: its name, look and values. */
function traces(data, state, colours) {
  const log = state.scale === "log10";
  const several = data.curves.length > 1;
  const shown = state.curves || natural(data.curves.length);
  const order = ["total", "diffuse_lobe", "specular_lobe", "specular_spike"];
  return data.curves.flatMap((curve, at) =>
    keys(curve, shown).map((key) => {
      const y = (log ? curve.logs : curve.columns)[key];
      const x = curve.xOf?.(key, log) ?? curve.x;
      const component = order.indexOf(key);
      const palette = colours.colours[(several || component < 0 ? at : component) % colours.colours.length];
      // What a figure compares with its first model lies on top of it.
      const isSecond = curve.panel > 0;
      const colour = isSecond ? colours.text : palette;
      const label =
        several || component < 0
          ? `${curve.label}${key === "total" || component < 0 ? "" : ` ${name(key)}`}`
          : name(key);
      const line = {
        color: colour,
        width: key === "total" && !isSecond ? 2.2 : 1.7,
        dash: isSecond ? "dot" : several || key !== "total" ? DASHES[key] : "solid",
      };
      return { key, curve: at, x, y, label: subscript(label), line, log };
    }),
  );
}

const hover = (trace) => trace.y.map((value) => (trace.log ? fromLog10(value) : number(value, 6)));

/** The axis title: what, in which unit. */
const quantity = (data) => [name(data.quantity), data.unit && `(${unit(data.unit)})`].filter(Boolean).join(" ");

const narrow = () => innerWidth < 500;

/** A Cartesian plot. */
export function cartesian(data, state, colours, whole) {
  const lines = traces(data, state, colours);
  const log = state.scale === "log10";
  const drawn = lines.map(({ x, y, label, line }, at) => ({
    type: "scatter",
    mode: "lines",
    x,
    y,
    name: label,
    line,
    customdata: hover(lines[at]),
    hovertemplate: `%{x}°: %{customdata}<extra>${label}</extra>`,
  }));
  const [least, most] = extent(lines.map(({ y }) => y));
  const linear = upTo(lines, whole);
  const side = log
    ? { ...decades(least, most, whole ? Infinity : depth(state)) }
    : { ...linear.side, exponentformat: "power" };
  return {
    traces: drawn,
    layout: layout(colours, {
      xaxis: axis(colours, {
        title: { text: subscript(`${name(data.axis)} (degrees)`), standoff: 6 },
        ticksuffix: "°",
        nticks: narrow() ? 6 : 13,
        tickangle: 0,
      }),
      yaxis: axis(colours, { title: { text: quantity(data), standoff: 8 }, ...side }),
      showlegend: lines.length > 1,
      hovermode: "closest",
    }),
    clipped: log ? most - least > depth(state) : linear.isClipped,
  };
}

/** A polar plot: the angle from the normal, the value along the radius. */
export function polar(data, state, colours, whole) {
  const lines = traces(data, state, colours);
  const log = state.scale === "log10";
  const [least, most] = extent(lines.map(({ y }) => y));
  const ticks = log ? decades(least, most, whole ? Infinity : depth(state)) : {};
  const linear = upTo(lines, whole);
  const base = log ? (ticks.range?.[0] ?? 0) : 0;
  const drawn = lines.map(({ x, y, label, line }, at) => ({
    // Below the innermost circle is the centre: a negative radius would be drawn on the other side.
    type: "scatterpolar",
    mode: "lines",
    theta: x,
    r: y.map((value) => (value === null ? null : Math.max(value - base, 0))),
    name: label,
    line,
    customdata: hover(lines[at]),
    hovertemplate: `%{theta}: %{customdata}<extra>${label}</extra>`,
  }));
  const radius = log
    ? {
        range: [0, (ticks.range?.[1] ?? 1) - base],
        tickvals: ticks.tickvals?.map((at) => at - base),
        ticktext: ticks.ticktext,
      }
    : { range: [0, linear.most], exponentformat: "power", nticks: 5 };
  return {
    traces: drawn,
    layout: layout(colours, {
      margin: { l: 30, r: 30, t: 44, b: 24 },
      legend: { orientation: "h", x: 0, y: 1.1, yanchor: "bottom", font: { size: 12 } },
      polar: {
        bgcolor: "rgba(0,0,0,0)",
        sector: [0, 180],
        angularaxis: {
          rotation: 90,
          direction: "clockwise",
          gridcolor: colours.line,
          linecolor: colours.muted,
          tickvals: [-90, -75, -60, -45, -30, -15, 0, 15, 30, 45, 60, 75, 90],
          ticktext: ["90°", "75°", "60°", "45°", "30°", "15°", "0°", "15°", "30°", "45°", "60°", "75°", "90°"].map(
            (text, i) => (i < 6 ? `−${text}` : text),
          ),
        },
        radialaxis: {
          gridcolor: colours.line,
          linecolor: colours.line,
          angle: 90,
          tickangle: 90,
          tickfont: { size: 11, color: colours.muted },
          ...radius,
        },
      },
      showlegend: lines.length > 1,
    }),
    clipped: log ? most - least > depth(state) : linear.isClipped,
  };
}

/** What a plot of curves shows, in words. */
export function words(data) {
  const peaks = data.curves.slice(0, 4).map((curve) => {
    const key = curve.columns.total ? "total" : Object.keys(curve.columns)[0];
    const y = curve.logs[key];
    const x = curve.xOf?.(key, true) ?? curve.x;
    let best = -1;
    y.forEach((value, i) => {
      if (value !== null && (best < 0 || value > y[best])) best = i;
    });
    if (best < 0) return `${curve.label}: no finite value`;
    return `${data.curves.length > 1 ? `${curve.label}: ` : ""}largest ${fromLog10(y[best])} at ${number(x[best], 6)}°`;
  });
  const rest = data.curves.length > 4 ? `; and ${data.curves.length - 4} more curves` : "";
  return `${peaks.join("; ")}${rest}.`.replace(/^l/, "L");
}

/** The values as a table: heads, and rows of text; at most so many rows, evenly spaced. */
export function table(data, most = 200) {
  const heads = [name(data.axis)];
  const columns = [];
  for (const curve of data.curves) {
    for (const key of Object.keys(curve.columns)) {
      heads.push([data.curves.length > 1 ? curve.label : "", name(key)].filter(Boolean).join(" "));
      columns.push((at) =>
        curve.columns[key][at] === 0 ? fromLog10(curve.logs[key][at]) : number(curve.columns[key][at], 8),
      );
    }
    for (const key of ["relative_error_bound", "roughness_g", "method"]) {
      const values = curve.series[key];
      if (!values) continue;
      heads.push(
        [data.curves.length > 1 ? curve.label : "", key === "relative_error_bound" ? "error bound" : name(key)]
          .filter(Boolean)
          .join(" "),
      );
      columns.push((at) => (typeof values[at] === "string" ? values[at] : number(values[at], 3)));
    }
  }
  const x = data.curves[0]?.x ?? [];
  const every = Math.max(1, Math.ceil(x.length / most));
  const rows = [];
  for (let at = 0; at < x.length; at += every)
    rows.push([`${number(x[at], 6)}°`, ...columns.map((column) => column(at))]);
  return { heads, rows, every };
}
