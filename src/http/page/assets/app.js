// The page: state in, requests out, answers drawn.

import { Address, VIEW, parse } from "./state.js";
import { Controls } from "./controls.js";
import { fields } from "./document.js";
import { Latest, back, json, useKey, Away } from "./service.js";
import { VIEWS, headline } from "./views.js";
import { CONFIGURATION, library, theme } from "./plotting.js";
import * as findings from "./findings.js";
import * as plans from "./plan.js";
import { code } from "./code.js";
import { download, has } from "./download.js";
import { element, number, plain, rich } from "./words.js";
import { Progress } from "./progress.js";

/** While a slider moves, so many milliseconds pass between its last movement and the request. */
const DEBOUNCE = 60;
/** The table of tolerances is six plans: it waits until the hand rests. */
const REST = 350;

const $ = (id) => document.getElementById(id);
const address = new Address((state) => adopt(state));
const main = new Latest();
const planning = new Latest();
const saving = new Latest();
const progress = new Progress($("progress"), () => { main.cancel(); saving.cancel(); });

let state = address.state();
let controls;
let drawn = null;
let whole = false;
let timer;
let resting;
let figures = [];
let isAway = false;

/** Shows a state that came from elsewhere than the controls: a link, the back button, a preset. */
function adopt(next) {
  state = next;
  controls?.show(state);
  options();
  refresh(0);
}

/** The choices above the plot. */
function options() {
  for (const name of ["plot", "scale"]) {
    const radio = document.querySelector(`input[name="${name}"][value="${CSS.escape(state[name])}"]`);
    if (radio) radio.checked = true;
    else state[name] = document.querySelector(`input[name="${name}"]`).value;
  }
  $("parts").checked = state.parts === "1";
  $("preset").value = state.figure ? `figure:${state.figure}` : "";
  if (state.figure && !["curve", "polar"].includes(state.plot)) delete state.figure;
  const isCurve = ["curve", "polar"].includes(state.plot);
  $("parts").closest("label").hidden = !isCurve;
  document.querySelector('fieldset:has([name="scale"])').hidden = state.plot === "tradeoff";
  for (const button of document.querySelectorAll("[data-format]")) button.disabled = !has(state, button.dataset.format);
  texts();
}

/** What follows from the state without the service. */
function texts() {
  const language = document.querySelector('input[name="language"]:checked').value;
  $("code").textContent = code(state, language);
}

/** A new state from the page itself. */
function change(next, settled) {
  state = next;
  options();
  if (settled) {
    address.push(state);
    whole = false;
  }
  refresh(settled ? 0 : DEBOUNCE);
}

/** Asks again, unless the next change comes first. */
function refresh(wait) {
  clearTimeout(timer);
  timer = setTimeout(answer, wait);
}

async function answer() {
  const asked = { ...state };
  const view = VIEWS[asked.plot];
  const began = performance.now();
  clearTimeout(resting);
  planning.cancel();
  try {
    const data = await main.run((signal) => view.load(asked, signal, progress));
    if (data === undefined) return;
    settle();
    drawn = { view, data, state: asked, milliseconds: performance.now() - began };
    await draw();
  } catch (error) {
    fail(error);
    return;
  }
  resting = setTimeout(() => rest(asked), asked.plot === "tradeoff" ? 0 : REST);
  findings.show($("findings"), drawn.view.findings(drawn.data), drawn.plan, drawn.data.medium);
}

/** What is asked once the hand rests: the plan, and the plan at other tolerances. */
async function rest(asked) {
  try {
    if (asked.figure && !sceneOf(asked.figure)) {
      $("plan").replaceChildren(element("p", { class: "muted" }, "This figure has no scene: it plots a formula."));
      return;
    }
    const rows = await planning.run(async (signal) => plans.compare(asked, await plans.plan(asked, signal), signal));
    if (rows === undefined) return;
    plans.show($("plan"), rows);
    drawn.plan = rows.find((row) => row.now).plan;
    findings.show($("findings"), drawn.view.findings(drawn.data), drawn.plan, drawn.data.medium);
  } catch (error) {
    // The same scene was answered before: what remains is that the service went away or takes no more for now.
    if (error instanceof Away) fail(error);
    else $("plan").replaceChildren(element("p", { class: "muted" }, error.message));
  }
}

/** Draws what was answered last, with the colours of now. */
async function draw() {
  const { view, data, state: asked } = drawn;
  const [title, subtitle] = headline(asked, data);
  $("stage-title").replaceChildren(...rich(title));
  $("subtitle").replaceChildren(...rich(subtitle));
  const words = view.words(data);
  const Plotly = await library();
  // Another answer may have come while the library was loading.
  if (drawn.data !== data) return;
  const picture = view.draw(data, asked, theme(), whole);
  await Plotly.react($("plot"), picture.traces, { ...picture.layout, uirevision: `${asked.plot}${asked.scale}${whole}` }, CONFIGURATION);
  $("plot").classList.remove("stale");
  $("plot").setAttribute("aria-label", plain(`${title}. ${words}`));
  $("whole").hidden = !picture.clipped;
  $("whole").textContent = whole ? "Near the top" : "Whole range";
  const clipped = picture.clipped && !whole ? " The top of a larger range is shown." : "";
  $("summary").replaceChildren(...rich(`${words}${clipped} Answered in ${number(drawn.milliseconds, 2)} ms.`));
  $("status").textContent = plain(`${title}: ${words}`);
  performance.mark("drawn");
  document.body.dataset.drawn = String(Number(document.body.dataset.drawn ?? 0) + 1);
  if ($("values").open) values();
}

function values() {
  if (!drawn) return;
  const { heads, rows, every } = drawn.view.table(drawn.data);
  const head = element("tr", {}, ...heads.map((text) => element("th", { scope: "col" }, text)));
  const body = rows.map(([first, ...rest]) => element("tr", {}, element("th", { scope: "row" }, first), ...rest.map((text) => element("td", {}, text))));
  const note = every > 1 ? [element("p", { class: "muted" }, `Every ${every}th row; downloads have all.`)] : [];
  $("table").replaceChildren(...note, element("table", {}, element("thead", {}, head), element("tbody", {}, ...body)));
}

/** The service answered. */
function settle() {
  isAway = false;
  $("away").hidden = true;
  $("problem").hidden = true;
  controls.complain([]);
}

/** Says what went wrong, where it went wrong. */
function fail(error) {
  $("plot").classList.add("stale");
  if (error instanceof Away) {
    away();
    return;
  }
  $("away").hidden = true;
  const errors = error.problem?.errors ?? [];
  const rest = controls.complain(errors);
  const placed = errors.length - rest.length;
  const box = $("problem");
  const title = error.problem?.title ?? "Something went wrong";
  const parts = [element("strong", {}, title), ": "];
  parts.push(errors.length === 0 ? error.message : placed > 0 && rest.length === 0 ? `see the marked ${placed === 1 ? "field" : "fields"} (${[...new Set(errors.map(({ pointer }) => controls.label(pointer)))].join(", ")}).` : error.message);
  if (rest.length > 0) parts.push(element("ul", {}, ...rest.map(({ pointer, detail }) => element("li", {}, `${controls.label(pointer)}: ${detail}`))));
  if (error.status === 401) parts.push(keyForm());
  box.replaceChildren(...parts);
  box.hidden = false;
  if (error.retryAfter) {
    box.append(` Asking again in ${error.retryAfter} s.`);
    refresh(1000 * error.retryAfter);
  }
}

/** A plain message, and on again as soon as the service is there. */
async function away() {
  $("away").textContent = "The service does not answer. The plot shows the last answer; the page goes on as soon as the service is back.";
  $("away").hidden = false;
  if (isAway) return;
  isAway = true;
  await back();
  if (!controls) await begin();
  else refresh(0);
}

function keyForm() {
  const input = element("input", { type: "password", autocomplete: "off", id: "key" });
  const form = element("form", {}, element("label", { for: "key" }, "Key"), input, element("button", { class: "primary" }, "Use it"));
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    useKey(input.value.trim());
    $("problem").hidden = true;
    begin();
  });
  return form;
}

/** What of a state is of the page alone. */
const view = (from) => Object.fromEntries(VIEW.filter((name) => from[name]).map((name) => [name, from[name]]));

/** The scene behind a figure, as the service links it. */
const sceneOf = (id) => figures.find((figure) => figure.id === id)?.diagrams?.[0];

function preset(choice) {
  const [kind, id] = choice.split(":");
  let next;
  if (kind === "figure") {
    const linked = sceneOf(id);
    const isPolar = id === "22" || id === "24";
    const query = linked ? parse(linked.split("?")[1]) : { ...state };
    next = { ...query, figure: id, plot: isPolar ? "polar" : "curve", scale: "linear", parts: isPolar ? "1" : "" };
  } else {
    next = { ...state, medium: "material", material: id, source: "", fresnel_average: state.fresnel_average };
    delete next.figure;
  }
  address.push(next);
  whole = false;
  adopt(next);
}

/** Presets and materials are not needed for the first picture. */
async function offer() {
  const [figureList, materialList] = await Promise.all([json("v1/figures"), json("v1/materials")]);
  figures = figureList.figures;
  const named = (material) => (material.aliases[0] ? `${material.aliases[0]} (${material.name})` : material.name);
  const group = (label, options) => element("optgroup", { label }, ...options);
  $("preset").replaceChildren(
    element("option", { value: "" }, "Own scene"),
    group("Figures of the report", figures.map(({ id, title, parameters }) => element("option", { value: `figure:${id}` }, plain(`${id}: ${title} (${parameters.length > 46 ? `${parameters.slice(0, 45)}…` : parameters})`)))),
    group("This scene in a material", materialList.materials.map((material) => element("option", { value: `material:${material.name}` }, named(material)))),
  );
  $("preset").value = state.figure ? `figure:${state.figure}` : "";
  // A link may name a figure alone.
  if (state.figure && !state.model && sceneOf(state.figure)) adopt({ ...parse(sceneOf(state.figure).split("?")[1]), ...view(state) });
  materials = materialList.materials;
  controls.offer("material", materials.map((material) => [material.name, named(material)]));
  sources();
}

let materials = [];
let sourcesOf = "";

/** The sources of the chosen material, with the wavelengths that they cover. */
function sources() {
  if (state.material === sourcesOf) return;
  const material = materials.find((one) => one.name === state.material);
  if (!material) return;
  sourcesOf = state.material;
  controls.offer("source", material.sources.map(({ id, wavelength_um }) => [id, `${id}, ${number(wavelength_um.least)} to ${number(wavelength_um.largest)} µm`]));
}

function wire() {
  document.querySelectorAll('input[name="plot"], input[name="scale"]').forEach((radio) =>
    radio.addEventListener("change", () => change({ ...state, [radio.name]: radio.value }, true)));
  $("parts").addEventListener("change", () => change({ ...state, parts: $("parts").checked ? "1" : "" }, true));
  $("preset").addEventListener("change", () => ($("preset").value ? preset($("preset").value) : change(without(state, "figure"), true)));
  $("whole").addEventListener("click", () => { whole = !whole; draw(); });
  document.querySelectorAll('input[name="language"]').forEach((radio) => radio.addEventListener("change", texts));
  $("explain").addEventListener("change", () => $("form").classList.toggle("explained", $("explain").checked));
  $("values").addEventListener("toggle", () => { if ($("values").open) values(); });
  $("copy").addEventListener("click", () => copy($("code").textContent, $("copy")));
  $("link").addEventListener("click", () => { address.push(state); copy(location.href, $("link")); });
  document.querySelectorAll("[data-format]").forEach((button) => button.addEventListener("click", () => fetchFile(button.dataset.format)));
}

const without = (from, name) => Object.fromEntries(Object.entries(from).filter(([key]) => key !== name));

async function copy(text, button) {
  const label = button.textContent;
  let said = "Copied";
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    // Without permission the text is selected, for the keyboard to copy.
    getSelection().selectAllChildren($("code"));
    said = "Press Ctrl C";
  }
  button.textContent = said;
  $("status").textContent = said;
  setTimeout(() => { button.textContent = label; }, 1500);
}

async function fetchFile(format) {
  try {
    const name = await saving.run((signal) => download({ ...state }, format, signal, progress, $("plot")));
    if (name) $("status").textContent = `${name} was saved`;
  } catch (error) {
    fail(error);
  }
}

function themes() {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const apply = (chosen) => {
    if (chosen) document.documentElement.dataset.theme = chosen;
    else delete document.documentElement.dataset.theme;
    if (drawn) draw();
  };
  let kept = "";
  try {
    kept = localStorage.getItem("reflectance.theme") ?? "";
  } catch {
    // Storage may be forbidden: the theme is the system's then.
  }
  $("theme").value = kept;
  apply(kept);
  $("theme").addEventListener("change", () => {
    apply($("theme").value);
    try {
      localStorage.setItem("reflectance.theme", $("theme").value);
    } catch {
      // It holds until the page is left.
    }
  });
  dark.addEventListener("change", () => drawn && draw());
}

async function begin() {
  try {
    const { found } = await fields();
    controls = new Controls($("form"), found, (next, settled) => {
      change(next, settled);
      sources();
    });
    performance.mark("controls");
    settle();
    adopt(state);
    // It takes longest to arrive and is not needed for anything else; a failure is told when a plot is drawn.
    library().catch(() => {});
    await offer();
  } catch (error) {
    if (error instanceof Away) await away();
    else if (controls) fail(error);
    else throw error;
  }
}

themes();
wire();
options();
await begin();
