// The controls: made once from the fields, then kept in step with the state.

import { BEGIN, GROUPS, pointed } from "./fields.js";
import { VIEW, list } from "./state.js";
import { compact, element, name as inWords, number, plain, rich } from "./words.js";

/** Positions of a slider over decades: 300 are finer than a hand. */
const STEPS = 300;

export class Controls {
  #fields = new Map();
  #groups = [];
  #state = {};

  /** `changed(state, settled)` is called with every new state; settled is false while a slider is dragged. */
  constructor(form, known, changed) {
    this.form = form;
    this.changed = changed;
    const groups = GROUPS.map((group) => this.#group(group, known)).filter((group) => group.querySelector(".field"));
    form.replaceChildren(...groups);
    form.addEventListener("submit", (event) => event.preventDefault());
  }

  #group(group, known) {
    const said = element("span", { class: "said" });
    const fields = element("div", { class: "fields" });
    const details = element(
      "details",
      { class: "group", open: group.open === true },
      element("summary", {}, group.title, said),
      fields,
    );
    for (const field of group.fields) {
      if (field.optional && !known.has(field.name)) continue;
      const control = this.#field(field, known.get(field.name) ?? {});
      control.details = details;
      this.#fields.set(field.name, control);
      fields.append(control.box);
    }
    this.#groups.push({ group, said });
    return details;
  }

  #field(field, about) {
    const id = `field-${field.name}`;
    const unit = field.unit ?? about.unit ?? "";
    const symbol = element("span", { class: "symbol" }, ...rich(field.symbol ?? ""));
    const hint = element("p", { class: "hint", id: `${id}-hint` }, ...rich(explain(field, about, unit)));
    const error = element("p", { class: "error", id: `${id}-error`, hidden: true });
    const control = { field, about, unit, symbol, error, inputs: [] };
    const described = `${id}-hint ${id}-error`;
    const input = this.#input(control, id, described);
    const isGroup = field.several !== undefined;
    const label = isGroup
      ? element("span", { class: "label", id: `${id}-label` }, field.label)
      : element("label", { for: id }, field.label, symbol);
    control.box = element(
      "div",
      { class: "field", "data-field": field.name, title: about.description ?? field.hint },
      label,
      input,
      hint,
      error,
    );
    return control;
  }

  #input(control, id, described) {
    const { field, about } = control;
    const common = { id, "aria-describedby": described };
    if (field.several) return this.#several(control, id, described);
    if (field.flag) {
      const box = element("input", { type: "checkbox", ...common });
      box.addEventListener("change", () =>
        this.#set(control, box.checked === Boolean(field.empty) ? "" : String(box.checked), true),
      );
      control.inputs.push(box);
      control.show = (text) => {
        box.checked = text === "" ? Boolean(field.empty) : text === "true";
      };
      return element("div", { class: "check" }, box, field.flag);
    }
    if (field.choices || field.kinds || field.materials || field.sources) {
      const select = element("select", { class: "wide", ...common });
      control.options = (names) => {
        const first =
          field.empty === undefined
            ? []
            : [element("option", { value: "" }, `${plain(inWords(field.empty))} (default)`)];
        select.replaceChildren(
          ...first,
          ...names
            .filter(([value]) => value !== field.empty)
            .map(([value, words]) => element("option", { value }, plain(words))),
        );
      };
      const names = [...(field.kinds ?? about.choices ?? []), ...(field.more ?? [])];
      control.options(names.map((value) => [value, inWords(value)]));
      select.addEventListener("change", () => this.#set(control, select.value, true));
      control.inputs.push(select);
      control.show = (given) => {
        let text = given;
        // The default by its name is the default; a name that is not listed yet, or never, is still the state's.
        if (text === field.empty) text = "";
        if (![...select.options].some((option) => option.value === text))
          select.append(element("option", { value: text }, text));
        select.value = text;
      };
      return element("div", { class: "row" }, select);
    }
    return this.#number(control, common);
  }

  #several(control, id, described) {
    const boxes = control.field.several.map((value) =>
      element("input", { type: "checkbox", value, "aria-describedby": described }),
    );
    const auto = element("input", { type: "checkbox", value: "auto", id });
    const take = (event) => {
      const chosen = boxes.filter((box) => box.checked).map((box) => box.value);
      const isAuto = event.target === auto ? auto.checked : chosen.length === 0;
      this.#set(control, isAuto ? "" : (chosen.length > 0 ? chosen : control.field.several).join(","), true);
    };
    [auto, ...boxes].forEach((box) => box.addEventListener("change", take));
    control.inputs.push(auto, ...boxes);
    control.show = (text) => {
      const chosen = text === "auto" ? [] : text.split(",");
      auto.checked = text === "" || text === "auto";
      boxes.forEach((box) => {
        box.checked = chosen.includes(box.value);
      });
    };
    const labels = [auto, ...boxes].map((box) => element("label", { class: "check" }, box, inWords(box.value)));
    return element("div", { class: "choices", role: "group", "aria-labelledby": `${id}-label` }, ...labels);
  }

  #number(control, common) {
    const { field, unit } = control;
    const ends = field.log ?? field.linear;
    const text = element("input", {
      type: "text",
      inputmode: field.list ? "text" : "decimal",
      spellcheck: "false",
      placeholder: field.empty,
      class: ends ? undefined : "wide",
      ...common,
    });
    text.addEventListener("change", () =>
      this.#set(control, text.value.replaceAll(/\s/g, "").replaceAll("−", "-"), true),
    );
    control.inputs.push(text);
    const row = element("div", { class: "row" });
    if (ends) {
      const slider = this.#slider(control, ends);
      control.inputs.push(slider);
      row.append(slider);
      control.show = (value) => {
        text.value = value;
        const at = list(value)[0] ?? (Number.isNaN(Number(field.empty)) ? ends[0] : Number(field.empty));
        slider.value = String(field.log ? position(ends, at) : at);
        slider.setAttribute("aria-valuetext", `${value || field.empty || ""} ${unit}`.trim());
      };
    } else {
      control.show = (value) => {
        text.value = value;
      };
    }
    row.append(text, element("span", { class: "unit" }, unit));
    return row;
  }

  #slider(control, ends) {
    const { field } = control;
    const range = field.log ? { min: 0, max: STEPS, step: 1 } : { min: ends[0], max: ends[1], step: ends[2] };
    const slider = element("input", { type: "range", ...range, "aria-label": `${field.label}, slider` });
    const take = (settled) => {
      const value = Number(slider.value);
      const moved = compact(field.log ? decades(ends, value) : value);
      // Of a list the first value moves.
      const rest = field.list ? (this.#state[field.name] ?? "").split(",").slice(1) : [];
      this.#set(control, [moved, ...rest].join(","), settled);
    };
    slider.addEventListener("input", () => take(false));
    slider.addEventListener("change", () => take(true));
    return slider;
  }

  #set({ field }, text, settled) {
    let patch = field.derived ? field.set(this.#state, Number(text)) : { [field.name]: text };
    const begin = BEGIN[field.name]?.[text];
    for (const [key, value] of Object.entries(begin ?? {})) patch[key] = this.#state[key] || value;
    // Two shares are one choice.
    if (field.name === "parallel") patch.perpendicular = compact(1 - Number(text));
    if (field.name === "perpendicular") patch.parallel = compact(1 - Number(text));
    if (field.name === "material") patch.source = "";
    if (field.name === "points" && text === "" && !this.#state.step_deg) patch.step_deg = "1";
    if (Object.values(patch).some((value) => value === "NaN")) patch = {};
    const state = { ...this.#state, ...patch };
    // A scene that was changed is no longer the report's.
    if (!VIEW.includes(field.name)) delete state.figure;
    this.show(state);
    this.changed(state, settled);
  }

  /** Shows a state. */
  show(state) {
    this.#state = state;
    for (const control of this.#fields.values()) {
      const { field, box, symbol } = control;
      box.hidden = field.when !== undefined && !field.when(state);
      if (field.symbolOf) symbol.replaceChildren(...rich(field.symbolOf(state)));
      const value = field.derived ? derived(field, state) : (state[field.name] ?? "");
      control.show(value);
    }
    for (const { group, said } of this.#groups) {
      const text = group.said(state) ?? "";
      said.replaceChildren(...rich(inWords(text)));
    }
  }

  /** The choices of a field that only the service knows. */
  offer(field, options) {
    const control = this.#fields.get(field);
    control.options(options);
    control.show(this.#state[field] ?? "");
  }

  /** Puts every error at the field that it points to; gives those back that have none. */
  complain(errors) {
    for (const { error, inputs } of this.#fields.values()) {
      error.hidden = true;
      error.textContent = "";
      inputs.forEach((input) => input.removeAttribute("aria-invalid"));
    }
    return errors.filter(({ pointer, detail }) => {
      const control = this.#fields.get(pointed(pointer, this.#fields) ?? "");
      if (!control || control.box.hidden) return true;
      control.error.hidden = false;
      control.error.textContent = [control.error.textContent, detail].filter(Boolean).join("; ");
      control.inputs.forEach((input) => input.setAttribute("aria-invalid", "true"));
      control.details.open = true;
      return false;
    });
  }

  /** What a field is called. */
  label(pointer) {
    return this.#fields.get(pointed(pointer, this.#fields) ?? "")?.field.label ?? pointer;
  }
}

function derived(field, state) {
  const value = field.get(state);
  return Number.isFinite(value) && value > 0 ? compact(value) : "";
}

function explain(field, about, unit) {
  const { minimum, maximum } = about;
  const range =
    minimum === undefined ? "" : ` From ${number(minimum)} to ${number(maximum)}${unit === "°" ? "" : " "}${unit}.`;
  return `${about.description ?? field.hint ?? ""}${range}`;
}

const position = ([least, most], value) => Math.round((STEPS * Math.log(value / least)) / Math.log(most / least));
const decades = ([least, most], at) => least * (most / least) ** (at / STEPS);
