// What the page does when things are slow, wrong or gone.

import assert from "node:assert/strict";
import { writeFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { ask, begin, drawing, fill, open, plotted, request, serve } from "./start.js";

const [service, browser] = await begin();

const REFUSED = /Failed to load resource/;
const total = async (page) => (await plotted(page)).find(({ name }) => name === "total").y;

test("a mistake is shown at its field, and goes when it is mended", async () => {
  const { page, close } = await open(browser, service.url, { expected: REFUSED });
  await page.fill("#field-from_deg", "-95");
  await page.keyboard.press("Tab");
  const box = page.locator("#field-from_deg");
  await page.waitForSelector('#field-from_deg[aria-invalid="true"]');
  assert.match(
    await page.locator("#field-from_deg-error").textContent(),
    /-95 is outside: expected a number from -90 to 90/,
  );
  assert.ok((await box.getAttribute("aria-describedby")).includes("field-from_deg-error"));
  assert.match(await page.locator("#problem").textContent(), /invalid fields.*From/);
  // A mistake in a field of a folded group opens it.
  await page.fill("#field-from_deg", "-80");
  await page.evaluate(() => {
    document.querySelector('[data-field="wavelength_um"]').closest("details").open = true;
  });
  await page.fill("#field-wavelength_um", "green");
  await page.keyboard.press("Tab");
  await page.waitForSelector('#field-wavelength_um[aria-invalid="true"]');
  await fill(page, "wavelength_um", "0.5");
  assert.equal(await page.locator('[aria-invalid="true"]').count(), 0);
  assert.ok(await page.locator("#problem").isHidden());
  await close();
});

test("answers that come late are dropped: the last scene counts", async () => {
  const { page, close } = await open(browser, service.url, { expected: REFUSED });
  const held = [];
  let aborted = 0;
  page.on("requestfailed", () => {
    aborted += 1;
  });
  await page.route(/v1\/diagrams.*correlation_length_um=3&/, (route) => held.push(route));
  await page.fill("#field-correlation_length_um", "3");
  await page.keyboard.press("Tab");
  while (held.length === 0) await page.waitForTimeout(10);
  await fill(page, "correlation_length_um", "5");
  const expected = (await ask(await request(page))).series[0].total;
  assert.deepEqual(await total(page), expected);
  // The first request was cancelled; its answer, if there still were one, changes nothing.
  await Promise.all(held.map((route) => route.continue().catch(() => {})));
  await page.waitForTimeout(300);
  assert.ok(aborted > 0);
  assert.deepEqual(await total(page), expected);
  assert.match(await request(page), /correlation_length_um=5&/);
  await close();
});

test("a link that names no scene is about the first one", async () => {
  const { page, close } = await open(browser, service.url, { hash: "plot=polar" });
  const [first] = await plotted(page);
  assert.equal(first.type, "scatterpolar");
  assert.equal(await page.locator("#field-model").inputValue(), "beckmann_spizzichino");
  await close();
});

test("a slider that moves fast asks seldom, and ends where it is", async () => {
  const { page, close } = await open(browser, service.url);
  let asked = 0;
  page.on("request", (sent) => {
    asked += sent.url().includes("/v1/diagrams") ? 1 : 0;
  });
  await drawing(page, () =>
    page.evaluate(() => {
      const slider = document.querySelector('[data-field="slope"] input[type="range"]');
      for (let at = 100; at <= 200; at += 1) {
        slider.value = String(at);
        slider.dispatchEvent(new Event("input", { bubbles: true }));
      }
      slider.dispatchEvent(new Event("change", { bubbles: true }));
    }),
  );
  await page.waitForTimeout(300);
  assert.ok(asked <= 2, `${asked} requests`);
  assert.deepEqual(await total(page), (await ask(await request(page))).series[0].total);
  await close();
});

test("a service that is gone is said to be gone, and the page goes on when it is back", async () => {
  let own = await serve();
  const { page, close } = await open(browser, own.url, { expected: REFUSED });
  await own.stop();
  await page.fill("#field-correlation_length_um", "7");
  await page.keyboard.press("Tab");
  await page.waitForSelector("#away:not([hidden])");
  assert.match(await page.locator("#away").textContent(), /does not answer/);
  await drawing(page, async () => {
    own = await serve([], own.port);
  });
  assert.ok(await page.locator("#away").isHidden());
  assert.deepEqual(await total(page), (await ask(await request(page))).series[0].total);
  await close();
  await own.stop();
});

test("long diagrams are counted while they arrive, and can be stopped", async () => {
  const { page, close } = await open(browser, service.url);
  await drawing(page, () =>
    page
      .fill("#field-points", "1000000")
      .then(() => page.keyboard.press("Tab"))
      .then(() => page.waitForSelector("#progress:not([hidden])")),
  );
  assert.ok(await page.locator("#progress").isHidden());
  const y = await total(page);
  const short = (await ask((await request(page)).replace("points=1000000", "points=1601"))).series[0].total;
  assert.ok(y.length > 1000 && y.length <= 2002, `${y.length} points`);
  // Each stretch keeps its largest value: none of the coarser sweep is above them.
  assert.ok(Math.max(...y) >= Math.max(...short));
  await page.fill("#field-at_deg", "10,20,30,40,50");
  await page.keyboard.press("Tab");
  await page.waitForSelector("#progress:not([hidden])");
  assert.match(await page.locator("#progress-text").textContent(), /of 5,000,000 rows/);
  await page.click("#stop");
  assert.ok(await page.locator("#progress").isHidden());
  assert.deepEqual(await total(page), y);
  assert.match(await page.locator("#summary").textContent(), /^Stopped/);
  await close();
});

test("a service with keys asks for one, and keeps it out of links", async () => {
  const key = "0123456789abcdef0123456789abcdef";
  const file = join(tmpdir(), `reflectance-keys-${process.pid}`);
  await writeFile(file, `visitor ${key}\n`);
  const own = await serve(["--api-keys-file", file]);
  const { page, close } = await open(browser, own.url, { expected: REFUSED, drawn: false });
  await page.fill("#key", key);
  await drawing(page, () => page.keyboard.press("Enter"));
  await page.waitForSelector('#preset option[value="figure:24"]', { state: "attached" });
  assert.ok(!page.url().includes(key));
  assert.ok(!(await page.locator("#code").textContent()).includes(key));
  await close();
  await own.stop();
  await rm(file);
});
