// Keyboard, screen readers, contrast, small screens; and how soon there is something to see.

import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { test } from "node:test";
import { ask, begin, drawing, open, plotted, request, unfold } from "./start.js";

const AXE = createRequire(import.meta.url).resolve("axe-core/axe.min.js");

const [service, browser] = await begin();

/** What axe finds, in short. The page's policy lets no script in that is not its own: axe runs beside it. */
async function violations(page) {
  await page.addScriptTag({ path: AXE });
  const found = await page.evaluate(() => globalThis.axe.run(document, { resultTypes: ["violations"] }));
  return found.violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html.slice(0, 120)).join(" | ")}`);
}

for (const colorScheme of ["light", "dark"]) {
  for (const width of [1280, 390]) {
    test(`axe finds nothing: ${colorScheme}, ${width} px`, async () => {
      const { page, close } = await open(browser, service.url, {
        colorScheme,
        viewport: { width, height: 844 },
        bypassCSP: true,
        expected: /Failed to load resource/,
      });
      await unfold(page);
      await page.check("#explain");
      await page.locator("#plan tr.now").waitFor();
      await page.click("#values summary");
      assert.deepEqual(await violations(page), []);
      const wide = await page.evaluate(
        () => document.documentElement.scrollWidth - document.documentElement.clientWidth,
      );
      assert.ok(wide <= 0, `the page is ${wide} px too wide`);
      // With a mistake shown it is another page.
      if (width > 390) return close();
      await page.fill("#field-to_deg", "100");
      await page.keyboard.press("Tab");
      await page.waitForSelector('#field-to_deg[aria-invalid="true"]');
      assert.deepEqual(await violations(page), []);
      return close();
    });
  }
}

test("the keyboard is enough", async () => {
  const { page, close } = await open(browser, service.url);
  const focused = () =>
    page.evaluate(() => {
      const { id, name, value, tagName } = document.activeElement;
      return id || `${name || tagName}:${value ?? document.activeElement.textContent}`;
    });
  await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "Skip to the controls");
  await page.keyboard.press("Enter");
  await page.keyboard.press("Tab");
  assert.equal(await focused(), "explain");
  // On to the first slider, which the arrows move.
  const reached = [];
  for (let presses = 0; presses < 20 && !reached.includes("field-roughness"); presses += 1) {
    await page.keyboard.press("Tab");
    reached.push(await focused());
  }
  assert.ok(reached.includes("field-model") && reached.includes("field-roughness"), reached.join(" "));
  await page.keyboard.press("Shift+Tab");
  await drawing(page, () => page.keyboard.press("ArrowRight"));
  assert.deepEqual((await plotted(page)).at(-1).y, (await ask(await request(page))).series[0].total);
  // Every control of the page can be reached from its start, and what has the focus shows it.
  await page.evaluate(() =>
    document.querySelectorAll("details.group").forEach((group) => {
      group.open = false;
    }),
  );
  await page.evaluate(() => document.querySelector(".skip").focus());
  const seen = new Set();
  for (let presses = 0; presses < 60; presses += 1) {
    await page.keyboard.press("Tab");
    seen.add(await focused());
    if (await page.evaluate(() => document.activeElement.matches("#values summary"))) break;
  }
  for (const id of [
    "theme",
    "preset",
    "plot:curve",
    "scale:linear",
    "curves",
    "explain",
    "link",
    "language:curl",
    "copy",
    "code",
  ]) {
    assert.ok(seen.has(id), `${id} among ${[...seen].join(", ")}`);
  }
  // Groups open and plots change without a mouse.
  await page.focus("details.group:nth-of-type(4) summary");
  await page.keyboard.press("Enter");
  assert.ok(await page.locator("#field-wavelength_um").isVisible());
  await page.focus('input[name="plot"][value="curve"]');
  await drawing(page, () => page.keyboard.press("ArrowRight"));
  assert.equal((await plotted(page))[0].type, "scatterpolar");
  await close();
});

test("what is drawn is also said", async () => {
  const { page, close } = await open(browser, service.url);
  const label = await page.locator("#plot").getAttribute("aria-label");
  assert.match(label, /^Radiance over θᵣ\. Largest 38\.\d+ at 30°\.$/);
  assert.equal(await page.locator("#status").textContent(), label.replace(". ", ": "));
  await page.click("#values summary");
  // The browser tells of an opened group a moment later, and the table is made then.
  await page.waitForSelector("#table tbody tr");
  const [first] = await page.$$eval("#table tbody tr", (rows) =>
    rows.map((row) => [...row.children].map((cell) => cell.textContent)),
  );
  const answer = await ask(await request(page));
  assert.equal(first[0], "-80°");
  assert.equal(
    Number(first[3].replace(" × 10⁻", "e-").replace("⁵", "5")) > 0 || answer.series[0].total[0] < 1e-3,
    true,
  );
  await close();
});

test("the theme is the system's until another is chosen, and stays", async () => {
  const { page, close } = await open(browser, service.url, { colorScheme: "dark" });
  const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const dark = await ground();
  await drawing(page, () => page.selectOption("#theme", "light"));
  const light = await ground();
  assert.notEqual(light, dark);
  await page.reload();
  assert.equal(await ground(), light);
  await close();
});

test("the picture comes after the controls, and little comes before the first paint", async (t) => {
  const context = await browser.newContext({ viewport: { width: 1280, height: 860 } });
  const page = await context.newPage();
  await page.goto(`${service.url}/`);
  await drawing(page);
  const seen = await page.evaluate(() => {
    const paint = performance.getEntriesByName("first-contentful-paint")[0].startTime;
    const entries = performance.getEntriesByType("resource");
    const library = entries.find(({ name }) => name.endsWith("plotly.min.js"));
    const document = performance.getEntriesByType("navigation")[0];
    const before = entries.filter(({ responseEnd }) => responseEnd <= paint);
    const bytes = before.reduce((sum, { transferSize }) => sum + transferSize, document.transferSize);
    return {
      paint,
      begun: library.startTime,
      controls: performance.getEntriesByName("controls")[0].startTime,
      library: library.transferSize,
      bytes,
      drawn: performance.getEntriesByName("drawn")[0].startTime,
    };
  });
  assert.ok(seen.begun >= seen.controls, "the library is asked for before the controls are there");
  const rounded = Object.fromEntries(Object.entries(seen).map(([name, value]) => [name, Math.round(value)]));
  t.diagnostic(
    `first paint ${rounded.paint} ms after ${rounded.bytes} bytes, controls ${rounded.controls} ms, plot ${rounded.drawn} ms; plot library ${rounded.library} bytes`,
  );
  await context.close();
});
