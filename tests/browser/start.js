// A service of one's own and a browser that looks at it.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { createInterface } from "node:readline";
import { after } from "node:test";
import { chromium } from "playwright-core";

const BINARY = process.env.REFLECTANCE_BINARY ?? "target/release/reflectance";
const CHROMIUM = process.env.CHROMIUM ?? "/usr/bin/chromium";
const FLAGS = [
  "--no-sandbox",
  "--disable-gpu",
  "--disable-background-networking",
  "--no-first-run",
  "--enable-unsafe-swiftshader",
];

/** Starts the service, on a port of its own or on a given one. */
export async function serve(flags = [], port = 0) {
  const process = spawn(BINARY, ["--listen", `127.0.0.1:${port}`, "--log-level", "off", ...flags], {
    stdio: ["ignore", "pipe", "inherit"],
  });
  const lines = createInterface({ input: process.stdout });
  const [line] = await once(lines, "line");
  const url = line.match(/http:\/\/[^/ ]*/)[0];
  return {
    url,
    port: Number(new URL(url).port),
    async stop() {
      process.kill("SIGKILL");
      if (process.exitCode === null && process.signalCode === null) await once(process, "exit");
    },
  };
}

export const launch = () => chromium.launch({ executablePath: CHROMIUM, args: FLAGS });

/** A service and a browser for a file of tests, which end with it. */
export async function begin() {
  const [service, browser] = await Promise.all([serve(), launch()]);
  after(async () => {
    await browser.close();
    await service.stop();
  });
  return [service, browser];
}

/** What visitors without wishes of their own share: the plot library is read once. */
const shared = new WeakMap();

async function contextOf(browser, options) {
  const made = () => browser.newContext({ viewport: { width: 1280, height: 860 }, ...options });
  if (Object.keys(options).length > 0) return made();
  if (!shared.has(browser)) shared.set(browser, await made());
  return shared.get(browser);
}

/** Opens the page, and waits for its first plot unless told otherwise. What the console complains of is an error of the
 * test, but for answers that the test provokes: `expected` matches those. */
export async function open(browser, url, { hash = "", expected, drawn = true, ...options } = {}) {
  const context = await contextOf(browser, options);
  const page = await context.newPage();
  const complaints = [];
  page.on("console", (message) => {
    const text = message.text();
    // What the software renderer says of its own speed is not the page's doing.
    if (
      ["error", "warning"].includes(message.type()) &&
      !/GL Driver Message|willReadFrequently/.test(text) &&
      !expected?.test(text)
    )
      complaints.push(text);
  });
  page.on("pageerror", (error) => complaints.push(error.stack));
  page.on("request", (request) => {
    const { origin, protocol } = new URL(request.url());
    if (protocol !== "data:" && protocol !== "blob:" && origin !== new URL(url).origin)
      complaints.push(`asks ${request.url()}`);
  });
  await page.goto(hash ? `${url}/#${hash}` : `${url}/`);
  if (drawn) await drawing(page);
  return {
    page,
    async close() {
      await (context === shared.get(browser) ? page : context).close();
      assert.deepEqual(complaints, []);
    },
  };
}

const count = (page) => page.evaluate(() => Number(document.body.dataset.drawn ?? 0));

/** Waits until the page has drawn more often than it had, after the action if there is one. */
export async function drawing(page, action) {
  const before = action ? await count(page) : 0;
  await action?.();
  await page.waitForFunction((least) => Number(document.body.dataset.drawn ?? 0) > least, before, { timeout: 20000 });
}

/** What is plotted, by the names in the legend. */
export const plotted = (page) =>
  page.evaluate(() =>
    document
      .getElementById("plot")
      .data.map(({ name, type, x, y, z, r, theta }) => ({ name, type, x, y, z, r, theta })),
  );

/** The link of the request behind the plot, taken from the page's own code. */
export async function request(page) {
  const text = await page.locator("#code").textContent();
  return text.match(/'(http[^']*)'/)[1];
}

export const ask = async (url, accept = "application/json") => (await fetch(url, { headers: { accept } })).json();

/** Sets a field as a visitor does. */
export async function fill(page, field, value) {
  await drawing(page, async () => {
    await page.fill(`#field-${field}`, value);
    await page.keyboard.press("Tab");
  });
}

/** Opens every group of controls. */
export const unfold = (page) =>
  page.evaluate(() =>
    document.querySelectorAll("details.group").forEach((group) => {
      group.open = true;
    }),
  );
