// What each tolerance would take: the same plan at several, beside the one that is chosen.

import { directions, radiance } from "./bodies.js";
import { json } from "./service.js";
import { bound, element, methods, name, number } from "./words.js";

const TOLERANCES = [1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1e-1];
const DEFAULT = 1e-9;
/** Directions of a plan for each fixed angle: enough to see where methods change. */
const MOST = 181;

const at = (state, tolerance) => ({
  ...state,
  relative_tolerance: tolerance === undefined ? state.relative_tolerance : String(tolerance),
});

/** The plan of the state as it is. */
export const plan = (state, signal) => json("v1/plan", { body: radiance(state, directions(state, MOST)), signal });

/** Plans at every tolerance of the table. The one chosen is `chosen` already. */
export async function compare(state, chosen, signal) {
  const own = Number(state.relative_tolerance || DEFAULT);
  const tolerances = [...new Set([...TOLERANCES, own])].sort((a, b) => a - b);
  const plans = await Promise.all(
    tolerances.map((tolerance) => (tolerance === own ? chosen : plan(at(state, tolerance), signal))),
  );
  return tolerances.map((tolerance, i) => ({ tolerance, plan: plans[i], now: tolerance === own }));
}

/** The table, with what differs from the row above it in words. */
export function show(box, rows) {
  const head = element(
    "tr",
    {},
    ...["Tolerance", "Bound", "Cost"].map((text) => element("th", { scope: "col" }, text)),
    element("th", { scope: "col", class: "words" }, "Methods"),
    element("th", { scope: "col", class: "words" }, "Left out"),
  );
  const body = rows.map(({ tolerance, plan: planned, now }) =>
    element(
      "tr",
      now ? { class: "now", "aria-current": "true" } : {},
      element("th", { scope: "row" }, number(tolerance)),
      element("td", {}, bound(planned.relative_error_bound)),
      element("td", {}, number(planned.cost.per_direction, 3)),
      element("td", { class: "words" }, methods(planned.methods)),
      element(
        "td",
        { class: "words" },
        planned.omitted.map((item) => `${name(item.component)} (${bound(item.bound)})`).join(", ") || "nothing",
      ),
    ),
  );
  const chosen = rows.find((row) => row.now).plan;
  const saved = chosen.cost.relative_to_full_series;
  const words = `Cost in units of one exp() a direction. As chosen, ${saved < 0.995 ? `${number(100 * saved, 2)} % of` : "as much as"} all components by the full series; planned at ${chosen.sampled} of ${chosen.directions} directions.`;
  box.replaceChildren(
    element("p", { class: "muted" }, words),
    element(
      "div",
      { class: "table", tabindex: "0", role: "region", "aria-label": "Plans by tolerance" },
      element("table", {}, element("thead", {}, head), element("tbody", {}, ...body)),
    ),
  );
}
