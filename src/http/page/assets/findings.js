// What answers say besides numbers: what was left out, what is strained, why a value is missing.

import { bound, element, heading, methods, name, number, rich } from "./words.js";

/** Shows what a plan says of the scene and what the answer says of itself. `answers` are the parts of an answer that
 * carry findings, each with the label of its curve. */
export function show(box, answers, plan, medium) {
  const facts = [];
  if (plan?.roughness_g) {
    const { least, largest } = plan.roughness_g;
    const regime = plan.regime ? `: ${span(plan.regime.least, plan.regime.largest)}` : "";
    facts.push(["Roughness g", `${span(number(least), number(largest))}${regime}`]);
  }
  if (plan) facts.push(["Components", plan.components.map(name).join(", ") || "none"]);
  const counts = {};
  for (const answer of answers) {
    for (const [method, count] of Object.entries(answer.methods ?? {})) counts[method] = (counts[method] ?? 0) + count;
  }
  if (Object.keys(counts).length > 0) facts.push(["Methods", `${methods(counts)} directions`]);
  const bounds = answers.flatMap((answer) => answer.relative_error_bound ?? []).filter((value) => value !== null);
  // Spread over a call, a long column would overflow the stack.
  if (bounds.length > 0)
    facts.push(["Error bound", `at most ${bound(bounds.reduce((a, b) => Math.max(a, b)))}, relative`]);
  else if (plan) facts.push(["Error bound", `at most ${bound(plan.relative_error_bound)}, relative (planned)`]);
  const looked = medium ?? plan?.medium;
  if (looked)
    facts.push([
      "Looked up",
      `${looked.material} (${looked.source}): n = ${number(looked.n, 6)}, k = ${number(looked.k, 6)}`,
    ]);
  const spectrum = answers.filter((answer) => answer.medium && answer.wavelength_um !== undefined);
  for (const { medium: one, wavelength_um } of spectrum.slice(0, 6)) {
    facts.push([
      `At ${number(wavelength_um)} µm`,
      `${one.material} (${one.source}): n = ${number(one.n, 6)}, k = ${number(one.k, 6)}`,
    ]);
  }
  const list = element(
    "dl",
    { class: "facts" },
    ...facts.flatMap(([term, words]) => [element("dt", {}, term), element("dd", {}, ...rich(words))]),
  );
  const said = answers.length > 0 ? answers : [plan ?? {}];
  const notes = [
    ...grouped(said, "omitted", (item) => item.component).map(([item, where]) =>
      note("omitted", `Left out: ${name(item.component)}`, sentence(item.reason), item.bound, where, "adds at most"),
    ),
    ...grouped(said, "warnings", (item) => `${item.code}${item.parameter ?? ""}`).map(([item, where]) =>
      note(
        "warning",
        heading(item.code),
        `${item.parameter ? `${item.parameter}: ` : ""}${sentence(item.detail)}`,
        item.value,
        where,
        "value",
      ),
    ),
    ...grouped(said, "diagnostics", (item) => item.code).map(([item, where, count]) =>
      note(
        "warning",
        heading(item.code),
        sentence(item.detail),
        undefined,
        where,
        "",
        `${count} ${count === 1 ? "value" : "values"}`,
      ),
    ),
  ];
  const none = element("p", { class: "muted" }, "Nothing was left out, and nothing needs a warning.");
  box.replaceChildren(list, notes.length > 0 ? element("ul", { class: "notes" }, ...notes) : none);
}

const span = (a, b) => (a === b ? String(a) : `${a} to ${b}`);
const sentence = (text) => text.replace(/^./, (first) => first.toUpperCase());

/** What several curves say alike is said once, with the curves. */
function grouped(answers, kind, keyOf) {
  const groups = new Map();
  for (const answer of answers) {
    for (const item of answer[kind] ?? []) {
      const key = keyOf(item);
      if (!groups.has(key)) groups.set(key, [item, new Set(), 0]);
      const group = groups.get(key);
      if (answer.label) group[1].add(answer.label);
      group[2] += 1;
    }
  }
  return [...groups.values()].map(([item, labels, count]) => [
    item,
    answers.length > 1 && labels.size < answers.length ? [...labels] : [],
    count,
  ]);
}

function note(kind, title, detail, value, where, words, more) {
  const parts = [element("b", {}, title), ". ", ...rich(detail), /[.!?]$/.test(detail) ? "" : "."];
  const extra = [];
  if (value !== undefined && value !== null) extra.push(`${words} ${number(value, 3)}`);
  if (more) extra.push(more);
  if (where.length > 0) extra.push(where.slice(0, 4).join("; "));
  if (extra.length > 0) parts.push(element("span", { class: "at" }, ...rich(` (${extra.join("; ")})`)));
  return element("li", { class: kind }, ...parts);
}
