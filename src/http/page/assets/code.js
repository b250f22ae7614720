// The request behind the plot, as a command line and as programs.

import { source } from "./bodies.js";
import { albedoRequest, tradeoffRequest } from "./charts.js";
import { link } from "./diagram.js";
import { radiance } from "./bodies.js";

const base = () => new URL(".", location.href).href.replace(/[?#].*$/, "");

/** What the plot asks for. `grid` says how the directions of a hemisphere are made: too many to print. */
function request(state) {
  if (state.plot === "albedo") return { path: "v1/albedo", body: albedoRequest(state) };
  if (state.plot === "tradeoff") return { path: "v1/tradeoff", body: tradeoffRequest(state) };
  if (state.plot === "hemisphere" || state.plot === "lobe") {
    const path = state.quantity === "brdf" ? "v1/brdf" : "v1/radiance";
    return { path, body: radiance(state, { theta_i_deg: source(state) }), grid: true };
  }
  return { path: link(state) };
}

const quote = (text) => `'${text.replaceAll("'", "'\\''")}'`;

function curl({ path, body, grid }) {
  const url = quote(base() + path);
  if (!body) return `curl -s ${url} -H 'accept: text/csv'`;
  const post = `curl -s ${url} -H 'content-type: application/json' -H 'accept: text/csv' -d`;
  if (!grid) return `${post} ${quote(JSON.stringify(body))}`;
  // The directions every 5 degrees, made by the shell.
  const [before, after] = JSON.stringify({ ...body, geometry: { ...body.geometry, theta_r_deg: "R", phi_r_deg: "P" } })
    .replace('"P"', "[$P]")
    .split('"R"');
  return [
    "R=$(for t in $(seq 0 5 90); do for p in $(seq 0 5 355); do echo $t; done; done | paste -sd,)",
    "P=$(for t in $(seq 0 5 90); do for p in $(seq 0 5 355); do echo $p; done; done | paste -sd,)",
    `${post} @- <<END`,
    `${before}[$R]${after}`,
    "END",
  ].join("\n");
}

/** JSON as a Python literal: three words differ. */
const python = (value) =>
  JSON.stringify(value, null, 4)
    .replace(/\btrue\b/g, "True")
    .replace(/\bfalse\b/g, "False")
    .replace(/\bnull\b/g, "None");

function pythonProgram({ path, body, grid }) {
  const url = JSON.stringify(base() + path);
  const end = "answer.raise_for_status()\nprint(answer.json())";
  if (!body) return `import httpx\n\nanswer = httpx.get(${url})\n${end}`;
  const lines = ["import httpx", "", `request = ${python(body)}`];
  if (grid) {
    lines.push(
      'request["geometry"]["theta_r_deg"] = [t for t in range(0, 91, 5) for p in range(0, 360, 5)]',
      'request["geometry"]["phi_r_deg"] = [p for t in range(0, 91, 5) for p in range(0, 360, 5)]',
    );
  }
  return [...lines, `answer = httpx.post(${url}, json=request)`, end].join("\n");
}

function javascript({ path, body, grid }) {
  const url = JSON.stringify(base() + path);
  const end = "if (!answer.ok) throw new Error((await answer.json()).detail);\nconsole.log(await answer.json());";
  if (!body) return `const answer = await fetch(${url});\n${end}`;
  const lines = [`const request = ${JSON.stringify(body, null, 2)};`];
  if (grid) {
    lines.push(
      "const grid = Array.from({ length: 19 * 72 }, (_, i) => [5 * Math.floor(i / 72), 5 * (i % 72)]);",
      "request.geometry.theta_r_deg = grid.map(([theta]) => theta);",
      "request.geometry.phi_r_deg = grid.map(([, phi]) => phi);",
    );
  }
  return [
    ...lines,
    `const answer = await fetch(${url}, {`,
    '  method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(request),',
    "});",
    end,
  ].join("\n");
}

/** The program text in one of three languages. */
export function code(state, language) {
  const wanted = request(state);
  return { curl, python: pythonProgram, javascript }[language](wanted);
}
