// What is said when the service refuses, is busy, or is gone.

import { Away, back, useKey } from "./service.js";
import { element } from "./words.js";

const $ = (id) => document.getElementById(id);
const GONE =
  "The service does not answer. The plot shows the last answer; the page goes on as soon as the service is back.";

export class Trouble {
  #page;
  #isAway = false;

  /** `controls()` are those of the page, if there are any yet; `again(wait)` asks once more after so many milliseconds;
   * `withKey()` begins anew. */
  constructor(page) {
    this.#page = page;
  }

  /** The service answered. */
  settle() {
    this.#isAway = false;
    $("away").hidden = true;
    $("problem").hidden = true;
    this.#page.controls()?.complain([]);
  }

  /** Says what went wrong, where it went wrong. */
  fail(error) {
    $("plot").classList.add("stale");
    if (error instanceof Away) {
      this.#away();
      return;
    }
    $("away").hidden = true;
    const errors = error.problem?.errors ?? [];
    const controls = this.#page.controls();
    const label = (pointer) => controls?.label(pointer) ?? pointer;
    const rest = controls?.complain(errors) ?? errors;
    const title = error.problem?.title ?? "Something went wrong";
    const names = [...new Set(errors.map(({ pointer }) => label(pointer)))];
    const marked = `see the marked ${names.length === 1 ? "field" : "fields"}: ${names.join(", ")}.`;
    const isMarked = errors.length > 0 && rest.length === 0;
    const parts = [element("strong", {}, title), ": ", isMarked ? marked : error.message];
    if (rest.length > 0) {
      const items = rest.map(({ pointer, detail }) => element("li", {}, `${label(pointer)}: ${detail}`));
      parts.push(element("ul", {}, ...items));
    }
    if (error.status === 401) parts.push(this.#keyForm());
    if (error.retryAfter) {
      parts.push(` Asking again in ${error.retryAfter} s.`);
      this.#page.again(1000 * error.retryAfter);
    }
    $("problem").replaceChildren(...parts);
    $("problem").hidden = false;
  }

  /** A plain message, and on again as soon as the service is there. */
  async #away() {
    $("away").textContent = GONE;
    $("away").hidden = false;
    if (this.#isAway) return;
    this.#isAway = true;
    await back();
    this.#isAway = false;
    this.#page.again(0);
  }

  #keyForm() {
    const input = element("input", { type: "password", autocomplete: "off", id: "key" });
    const button = element("button", { class: "primary" }, "Use it");
    const form = element("form", {}, element("label", { for: "key" }, "Key"), input, button);
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      useKey(input.value.trim());
      $("problem").hidden = true;
      this.#page.withKey();
    });
    return form;
  }
}
