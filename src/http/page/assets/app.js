// The page: state in, requests out, answers drawn.

import { Address, list } from "./state.js";
import { Controls } from "./controls.js";
import { fields } from "./document.js";
import { Away, Latest } from "./service.js";
import { VIEWS, headline } from "./views.js";
import { CONFIGURATION, library, theme } from "./plotting.js";
import * as findings from "./findings.js";
import * as plans from "./plan.js";
import { code } from "./code.js";
import { natural } from "./curves.js";
import { link } from "./diagram.js";
import { download, has } from "./download.js";
import { element, number, plain, rich } from "./words.js";
import { Presets } from "./presets.js";
import { Progress } from "./progress.js";
import { themes } from "./theme.js";
import { Trouble } from "./trouble.js";

/** While a slider moves, so many milliseconds pass between its last movement and the request. */
const DEBOUNCE = 60;
/** The table of tolerances is six plans: it waits until the hand rests. */
const REST = 350;

const $ = (id) => document.getElementById(id);
const address = new Address((state) => adopt(state));
const main = new Latest();
const planning = new Latest();
const saving = new Latest();
const progress = new Progress($("progress"), stop);

let state = address.state();
let controls;
let drawn = null;
let whole = false;
let timer;
let resting;

const trouble = new Trouble({
  controls: () => controls,
  again: (wait) => (controls ? refresh(wait) : begin()),
  withKey: () => begin(),
});
const presets = new Presets({
  state: () => state,
  take: (next) => {
    address.push(next);
    whole = false;
    adopt(next);
  },
});

/** The visitor has waited enough. */
function stop() {
  main.cancel();
  saving.cancel();
  $("status").textContent = "Stopped";
  if (drawn && link(drawn.state) === link(state)) return;
  $("plot").classList.add("stale");
  $("summary").textContent = "Stopped: the plot shows the scene before.";
}

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
  const count = Math.max(1, list(state.at_deg).length) * Math.max(1, list(state.wavelength_um).length);
  $("curves").checked = (state.curves || natural(count)) !== "total";
  const isCurve = ["curve", "polar"].includes(state.plot);
  // A figure is curves; another plot is of the scene behind it.
  if (!isCurve) delete state.figure;
  presets.show(state);
  $("curves").closest("label").hidden = !isCurve;
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
  presets.sources();
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
    const answers = await main.run((signal) =>
      Promise.all([view.load(asked, signal, progress), planned(asked, signal)]),
    );
    if (answers === undefined) return;
    trouble.settle();
    const [data, plan] = answers;
    drawn = { view, data, plan, state: asked, milliseconds: performance.now() - began };
    findings.show($("findings"), view.findings(data), plan, data.medium);
    await draw();
    resting = setTimeout(() => rest(asked, plan), REST);
  } catch (error) {
    trouble.fail(error);
  }
}

/** The plan of a scene; none for figures that plot a formula. */
async function planned(asked, signal) {
  if (!asked.model || (asked.figure && presets.isFormula(asked.figure))) return null;
  try {
    return await plans.plan(asked, signal);
  } catch (error) {
    // The answer itself says what is wrong with the scene.
    if (error.status !== undefined) return null;
    throw error;
  }
}

/** What is asked once the hand rests: the plan at other tolerances. */
async function rest(asked, plan) {
  try {
    const rows = plan && (await planning.run((signal) => plans.compare(asked, plan, signal)));
    if (rows) plans.show($("plan"), rows);
    else if (rows === null) $("plan").replaceChildren(element("p", { class: "muted" }, "There is no scene to plan."));
  } catch (error) {
    // The same scene was answered before: what remains is that the service went away or takes no more for now.
    if (error instanceof Away) trouble.fail(error);
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
  await Plotly.react(
    $("plot"),
    picture.traces,
    { ...picture.layout, uirevision: `${asked.plot}${asked.scale}${whole}` },
    CONFIGURATION,
  );
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
  const body = rows.map(([first, ...rest]) =>
    element("tr", {}, element("th", { scope: "row" }, first), ...rest.map((text) => element("td", {}, text))),
  );
  const note = every > 1 ? [element("p", { class: "muted" }, `Every ${every}th row; downloads have all.`)] : [];
  $("table").replaceChildren(...note, element("table", {}, element("thead", {}, head), element("tbody", {}, ...body)));
}

function wire() {
  // The fragment is the state: to jump within the page must not change it.
  document.querySelector(".skip").addEventListener("click", (event) => {
    event.preventDefault();
    $("controls").focus();
  });
  document
    .querySelectorAll('input[name="plot"], input[name="scale"]')
    .forEach((radio) => radio.addEventListener("change", () => change({ ...state, [radio.name]: radio.value }, true)));
  $("curves").addEventListener("change", () =>
    change({ ...state, curves: $("curves").checked ? "all" : "total" }, true),
  );
  presets.wire();
  $("whole").addEventListener("click", () => {
    whole = !whole;
    draw();
  });
  document.querySelectorAll('input[name="language"]').forEach((radio) => radio.addEventListener("change", texts));
  $("explain").addEventListener("change", () => $("form").classList.toggle("explained", $("explain").checked));
  $("values").addEventListener("toggle", () => {
    if ($("values").open) values();
  });
  $("copy").addEventListener("click", () => copy($("code").textContent, $("copy")));
  $("link").addEventListener("click", () => {
    address.push(state);
    copy(location.href, $("link"));
  });
  document
    .querySelectorAll("[data-format]")
    .forEach((button) => button.addEventListener("click", () => fetchFile(button.dataset.format)));
}

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
  setTimeout(() => {
    button.textContent = label;
  }, 1500);
}

async function fetchFile(format) {
  try {
    const name = await saving.run((signal) =>
      download({ ...state }, format, signal, progress, $("plot"), theme().isDark),
    );
    if (name) $("status").textContent = `${name} was saved`;
  } catch (error) {
    trouble.fail(error);
  }
}

/** Reads what the service says of itself, makes the controls, and asks for the first picture. */
async function begin() {
  try {
    const known = await fields();
    controls = new Controls($("form"), known, change);
    performance.mark("controls");
    trouble.settle();
    adopt(state);
    // It takes longest to arrive and is not needed for anything else; a failure is told when a plot is drawn.
    library().catch(() => {});
    await presets.offer(controls);
  } catch (error) {
    trouble.fail(error);
  }
}

themes(() => drawn && draw());
wire();
options();
await begin();
