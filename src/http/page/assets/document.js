// What the service says of its fields: ranges, choices and explanations from /openapi.json, units from /v1/limits.

import { json } from "./service.js";
import { unitSign } from "./words.js";

const SUFFIXES = [
  [/_um2$/, "square micrometres"],
  [/_um$/, "micrometres"],
  [/_deg$/, "degrees"],
];

/** The fields of a diagram by name: `minimum`, `maximum`, `choices`, `description`, `unit`. */
export async function fields() {
  const [document, limits] = await Promise.all([json("openapi.json"), limitsIfAllowed()]);
  const units = new Map(
    limits.ranges.filter((range) => range.of === "DiagramRequest").map((range) => [range.name, range.unit]),
  );
  const found = new Map();
  for (const parameter of document.paths["/v1/diagrams"].get.parameters) {
    const { name, description = "", schema } = parameter;
    const number = scalar(schema);
    const stated = units.get(name) ?? SUFFIXES.find(([suffix]) => suffix.test(name))?.[1] ?? "";
    found.set(name, {
      description,
      choices: number.enum,
      minimum: number.minimum,
      maximum: number.maximum,
      unit: unitSign(stated),
    });
  }
  return found;
}

/** The schema of one value, where there may be a list. */
function scalar(schema) {
  const one = schema.oneOf?.find((option) => option.type !== "array") ?? schema;
  return one.type === "array" ? one.items : one;
}

/** With keys in force the limits are behind them; the page does without until there is one. */
async function limitsIfAllowed() {
  try {
    return await json("v1/limits");
  } catch (error) {
    if (error.status === undefined) throw error;
    return { ranges: [] };
  }
}
