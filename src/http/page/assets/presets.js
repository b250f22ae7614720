// Where a visitor may start from: the report's figures, and materials by name.

import { json } from "./service.js";
import { VIEW, parse } from "./state.js";
import { element, number, plain } from "./words.js";

/** Characters of a figure's parameters in the menu. */
const SHORT = 46;
const shorten = (text) => (text.length > SHORT ? `${text.slice(0, SHORT - 1)}…` : text);
const option = (value, text) => element("option", { value }, plain(text));
const named = ({ name, aliases }) => (aliases[0] ? `${aliases[0]} (${name})` : name);

/** What of a state is of the page alone. */
const view = (from) => Object.fromEntries(VIEW.filter((name) => from[name]).map((name) => [name, from[name]]));

export class Presets {
  #page;
  #figures = [];
  #materials = [];
  #controls;
  #sourcesOf;
  #menu = document.getElementById("preset");

  /** `state()` is the page's, `take(state)` gives it another. */
  constructor(page) {
    this.#page = page;
  }

  wire() {
    this.#menu.addEventListener("change", () => this.#page.take(this.#chosen(this.#menu.value)));
  }

  /** Shows which figure a state is, if it is one. */
  show(state) {
    this.#menu.value = state.figure ? `figure:${state.figure}` : "";
  }

  /** The scene behind a figure, as the service links it; its first, where it compares two. */
  #scene(id) {
    const link = this.#figures.find((figure) => figure.id === id)?.diagrams[0];
    return link && parse(link.split("?")[1]);
  }

  /** Whether a figure has no scene. */
  isFormula(id) {
    return this.#figures.some((figure) => figure.id === id && figure.diagrams.length === 0);
  }

  #chosen(value) {
    const state = { ...this.#page.state() };
    const [kind, id] = value.split(":");
    delete state.figure;
    if (kind === "figure") return { ...(this.#scene(id) ?? state), ...natural(id), figure: id };
    return kind === "material" ? { ...state, medium: "material", material: id, source: "" } : state;
  }

  /** Fills the menus. The first picture does without them. */
  async offer(controls) {
    this.#controls = controls;
    const [{ figures }, { materials }] = await Promise.all([json("v1/figures"), json("v1/materials")]);
    [this.#figures, this.#materials] = [figures, materials];
    const ofFigure = ({ id, title, parameters }) => option(`figure:${id}`, `${id}: ${title} (${shorten(parameters)})`);
    const group = (label, options) => element("optgroup", { label }, ...options);
    this.#menu.replaceChildren(
      option("", "Own scene"),
      group("Figures of the report", figures.map(ofFigure)),
      group(
        "This scene in a material",
        materials.map((one) => option(`material:${one.name}`, named(one))),
      ),
    );
    controls.offer(
      "material",
      materials.map((one) => [one.name, named(one)]),
    );
    this.sources();
    const state = this.#page.state();
    this.show(state);
    // A link may name a figure alone: its scene is known now.
    const scene = state.figure && !state.model && this.#scene(state.figure);
    if (scene) this.#page.take({ ...scene, ...view(state) });
  }

  /** Offers the sources of the chosen material, with the wavelengths that they cover. */
  sources() {
    const { material } = this.#page.state();
    const found = this.#materials.find((one) => one.name === material);
    if (!found || this.#sourcesOf === material) return;
    this.#sourcesOf = material;
    const range = ({ least, largest }) => `${number(least)} to ${number(largest)} µm`;
    this.#controls.offer(
      "source",
      found.sources.map((one) => [one.id, `${one.id}, ${range(one.wavelength_um)}`]),
    );
  }
}

/** As the report draws it: 22 and 24 are polar. */
const natural = (id) => ({ plot: id === "22" || id === "24" ? "polar" : "curve", scale: "linear" });
