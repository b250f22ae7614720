// Answers as files, counted while they arrive.

import { request as hemisphere } from "./hemisphere.js";
import { albedoRequest, tradeoffRequest } from "./charts.js";
import { link, picture } from "./diagram.js";
import { library } from "./plotting.js";
import { stream } from "./service.js";
import { rows } from "./state.js";

const TYPES = {
  csv: "text/csv",
  arrow: "application/vnd.apache.arrow.stream",
  npy: "application/x-npy",
  json: "application/json",
  svg: "image/svg+xml",
  png: "image/png",
};
const PICTURES = new Set(["svg", "png"]);
const DIAGRAMS = new Set(["curve", "polar"]);

/** Whether what is plotted can be had in a format. */
export const has = (state, format) => PICTURES.has(format) || format === "json" || state.plot !== "tradeoff";

function request(state) {
  if (state.plot === "albedo") return { path: "v1/albedo", body: albedoRequest(state) };
  if (state.plot === "tradeoff") return { path: "v1/tradeoff", body: tradeoffRequest(state) };
  if (state.plot === "hemisphere" || state.plot === "lobe") return hemisphere(state);
  return { path: link(state) };
}

function save(blob, name) {
  const anchor = document.createElement("a");
  anchor.href = URL.createObjectURL(blob);
  anchor.download = name;
  anchor.click();
  // The browser has taken hold of it by then.
  setTimeout(() => URL.revokeObjectURL(anchor.href), 10000);
}

/** Fetches the plot's data in a format and saves it. Pictures of diagrams are the service's; others are of the plot as it
 * stands. */
export async function download(state, format, signal, progress, plot, isDark) {
  const name = `reflectance-${state.figure ? `figure-${state.figure}` : state.plot}.${format}`;
  const isPicture = PICTURES.has(format);
  if (isPicture && !DIAGRAMS.has(state.plot)) {
    const Plotly = await library();
    const url = await Plotly.toImage(plot, { format, width: 900, height: 600, scale: format === "png" ? 2 : 1 });
    save(await asBlob(url), name);
    return name;
  }
  const { path, body } = isPicture ? { path: picture(state, isDark) } : request(state);
  const isDiagram = path.startsWith("v1/diagrams");
  const isLines = format === "csv" && isDiagram;
  const pieces = [];
  let count = 0;
  progress.begin(isLines ? rows(state) : 0, isLines ? "rows" : "bytes");
  try {
    await stream(path, { body, accept: TYPES[format], signal }, (bytes) => {
      pieces.push(bytes);
      count += isLines ? newlines(bytes) : bytes.length;
      progress.reach(count);
    });
  } finally {
    progress.end();
  }
  save(new Blob(pieces, { type: TYPES[format] }), name);
  return name;
}

function newlines(bytes) {
  let count = 0;
  for (let at = bytes.indexOf(10); at >= 0; at = bytes.indexOf(10, at + 1)) count += 1;
  return count;
}

/** A data URL's content; fetching it would need another permission of the content-security policy. */
async function asBlob(url) {
  const [head, content] = [url.slice(5, url.indexOf(",")), url.slice(url.indexOf(",") + 1)];
  const type = head.split(";")[0];
  if (!head.endsWith("base64")) return new Blob([decodeURIComponent(content)], { type });
  return new Blob([Uint8Array.from(atob(content), (sign) => sign.charCodeAt(0))], { type });
}
