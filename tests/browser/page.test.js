// The page with a real browser and a real service: what is plotted is what the service answers.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { ask, begin, drawing, fill, open, plotted, request, unfold } from "./start.js";

const [service, browser] = await begin();

/** The total of the first curve. */
const total = async (page) => (await plotted(page)).find(({ name }) => name === "total" || name.startsWith("θ"));

test("the first picture is the service's answer", async () => {
  const { page, close } = await open(browser, service.url);
  const answer = await ask(await request(page));
  const [series] = answer.series;
  const lines = await plotted(page);
  assert.deepEqual(
    lines.map(({ name }) => name),
    ["specular lobe", "specular spike", "total"],
  );
  for (const [at, key] of ["specular_lobe", "specular_spike", "total"].entries()) {
    assert.deepEqual(lines[at].y, series[key]);
    assert.deepEqual(lines[at].x, answer.axis.values);
  }
  // Ranges and explanations are those of the document.
  const document = await ask(`${service.url}/openapi.json`);
  const { description } = document.paths["/v1/diagrams"].get.parameters.find(({ name }) => name === "rms_height_um");
  await page.check("#explain");
  const hint = page.locator("#field-rms_height_um-hint");
  assert.ok((await hint.textContent()).endsWith("From 10⁻⁶⁰ to 10⁶⁰ µm."));
  assert.equal(await page.locator('[data-field="rms_height_um"]').getAttribute("title"), description);
  assert.ok(await hint.isVisible());
  // And no field of a diagram is without a control; `form` is the choice between curves and polar.
  const names = document.paths["/v1/diagrams"].get.parameters.map(({ name }) => name);
  const controls = await page.$$eval("[data-field]", (fields) => fields.map((field) => field.dataset.field));
  const above = await page.$$eval("#options input", (inputs) => inputs.map(({ name, id }) => name || id));
  assert.deepEqual(
    names.filter((name) => !controls.includes(name) && !above.includes(name) && name !== "form"),
    [],
  );
  await close();
});

test("moved controls change plot, link and code, and the back button takes them back", async () => {
  const { page, close } = await open(browser, service.url);
  const first = await request(page);
  const slider = page.locator('[data-field="roughness"] input[type="range"]');
  await slider.focus();
  for (const key of ["ArrowRight", "PageUp", "Home"]) {
    await drawing(page, () => page.keyboard.press(key));
    const link = await request(page);
    assert.deepEqual((await total(page)).y, (await ask(link)).series[0].total);
    assert.ok(page.url().includes(new URL(link).searchParams.get("rms_height_um")), page.url());
  }
  // At the end of the slider the spike is all there is, and the answer says so.
  assert.equal(await page.locator("#field-roughness").inputValue(), "0.002");
  await page.waitForFunction(() => document.getElementById("findings").textContent.includes("Components"));
  await page.goBack();
  await page.goBack();
  await drawing(page, () => page.goBack());
  assert.equal(await request(page), first);
  await close();
});

test("a scene may be changed in every way", async () => {
  const { page, close } = await open(browser, service.url);
  await unfold(page);
  await drawing(page, () => page.selectOption("#field-model", "unified"));
  await drawing(page, () => page.selectOption("#field-medium", "material"));
  await drawing(page, () => page.selectOption("#field-material", "Au"));
  await drawing(page, () => page.selectOption("#field-source", "McPeak"));
  await drawing(page, () => page.selectOption("#field-polarization", "mix"));
  await fill(page, "parallel", "0.25");
  await drawing(page, () => page.selectOption("#field-sensor", "camera"));
  await drawing(page, () => page.selectOption("#field-sweep", "theta_i_deg"));
  await fill(page, "at_deg", "10, -20");
  await fill(page, "wavelength_um", "0.5,0.6");
  await drawing(page, () => page.selectOption("#field-quantity", "brdf"));
  const link = new URL(await request(page));
  const expected = {
    material: "Au",
    source: "McPeak",
    parallel: "0.25",
    perpendicular: "0.75",
    pixel_area_um2: "25",
    sweep: "theta_i_deg",
    at_deg: "10,-20",
    wavelength_um: "0.5,0.6",
    quantity: "brdf",
  };
  for (const [name, value] of Object.entries(expected)) assert.equal(link.searchParams.get(name), value, name);
  const answer = await ask(link);
  const totals = (await plotted(page)).filter(({ name }) => !/lobe|spike/.test(name));
  assert.deepEqual(
    totals.map(({ y }) => y),
    answer.series.map((series) => series.total),
  );
  assert.match(await page.locator("#findings").textContent(), /Au \(McPeak\): n = /);
  await close();
});

for (const [id, polar] of [
  ["13a", false],
  ["23c", false],
  ["24", true],
]) {
  test(`figure ${id} is the service's, and goes on as a scene`, async () => {
    const { page, close } = await open(browser, service.url);
    await page.waitForSelector(`#preset option[value="figure:${id}"]`, { state: "attached" });
    await drawing(page, () => page.selectOption("#preset", `figure:${id}`));
    const figure = await ask(`${service.url}/v1/figures/${id}`);
    const values = (series) => (polar ? series.map(({ r }) => r) : series.map(({ y }) => y));
    const totals = (await plotted(page)).filter(({ name }) => !/lobe$|spike$/.test(name));
    assert.deepEqual(
      values(totals),
      figure.panels.flatMap(({ diagram }) => diagram.series.map((series) => series.total)),
    );
    assert.match(await page.locator("#stage-title").textContent(), new RegExp(`^Figure ${id}: `));
    // The controls hold the figure's scene: the diagram of the first panel is the figure's.
    await drawing(page, () => page.selectOption("#preset", ""));
    const link = await request(page);
    assert.ok(link.includes("/v1/diagrams?"), link);
    const again = (await plotted(page)).filter(({ name }) => !/lobe$|spike$/.test(name));
    assert.deepEqual(
      values(again),
      figure.panels[0].diagram.series.map((series) => series.total),
    );
    await close();
  });
}

test("a shared link shows the same", async () => {
  const { page, close } = await open(browser, service.url);
  await fill(page, "correlation_length_um", "4");
  await drawing(page, () => page.check('input[name="scale"][value="log10"]', { force: true }));
  const [url, lines] = [page.url(), await plotted(page)];
  const other = await open(browser, service.url, { hash: url.split("#")[1] });
  assert.deepEqual(await plotted(other.page), lines);
  assert.equal(await other.page.locator("#field-correlation_length_um").inputValue(), "4");
  await other.close();
  await close();
});

test("values below every float are plotted by their logarithm", async () => {
  const hash =
    "model=beckmann_spizzichino&rms_height_um=0.001&correlation_length_um=0.01&wavelength_um=0.0001&footprint_um2=400&patch_half_x_um=10&patch_half_y_um=10&components=specular_spike&sweep=theta_i_deg&from_deg=0&to_deg=80&step_deg=20&at_deg=60&scale=log10";
  const { page, close } = await open(browser, service.url, { hash });
  const [series] = (await ask(await request(page))).series;
  assert.ok(series.total.every((value) => value === 0));
  assert.deepEqual((await total(page)).y, series.log10_total);
  assert.match(await page.locator("#findings").textContent(), /Underflow/);
  await close();
});

test("the hemisphere, the lobe, the albedo and the trade are the service's numbers", async () => {
  const { page, close } = await open(browser, service.url);
  const choose = (plot) => drawing(page, () => page.check(`input[name="plot"][value="${plot}"]`, { force: true }));
  const answers = [];
  page.on("response", (response) => answers.push(response));
  const answered = async (path) => answers.findLast((response) => response.url().endsWith(path));
  await choose("hemisphere");
  const [heat] = await plotted(page);
  const radiance = await (await answered("/v1/radiance")).json();
  assert.deepEqual(
    heat.z.flat().filter((value) => value !== null),
    radiance.total.filter((value) => value !== null),
  );
  await choose("lobe");
  assert.deepEqual(
    (await plotted(page)).map(({ type }) => type),
    ["surface", "scatter3d", "scatter3d"],
  );
  await choose("albedo");
  const table = (await (await answered("/v1/albedo")).text())
    .trim()
    .split("\n")
    .map((line) => line.split(","));
  const column = table[0].indexOf("total");
  assert.deepEqual(
    (await plotted(page))[0].y,
    table.slice(1).map((cells) => Number(cells[column])),
  );
  await choose("tradeoff");
  const trade = await (await answered("/v1/tradeoff")).json();
  const points = (await plotted(page)).filter(({ name }) => name !== "bound stated").flatMap(({ y }) => y);
  assert.deepEqual(
    points.sort(),
    trade.rows
      .filter((row) => row.largest_relative_error > 0)
      .map((row) => Math.log10(row.largest_relative_error))
      .sort(),
  );
  await close();
});

test("the tolerance shows what it changes", async () => {
  const { page, close } = await open(browser, service.url);
  const now = page.locator("#plan tr.now");
  await now.waitFor();
  const texts = [await now.textContent()];
  for (const tolerance of ["1e-2", "1e-14"]) {
    await fill(page, "relative_tolerance", tolerance);
    await page.waitForFunction(
      (before) => document.querySelector("#plan tr.now")?.textContent !== before,
      texts.at(-1),
    );
    texts.push(await now.textContent());
  }
  assert.match(texts[1], /^0\.01.*uniform/);
  assert.match(texts[2], /^10⁻¹⁴.*series/);
  await close();
});

/** What a button saves. */
async function saved(page, format) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(`[data-format="${format}"]`)]);
  return readFile(await download.path());
}

test("data and pictures come as files", async () => {
  const { page, close } = await open(browser, service.url);
  const fetched = async (link, accept) => Buffer.from(await (await fetch(link, { headers: { accept } })).arrayBuffer());
  const link = await request(page);
  for (const [format, accept] of [
    ["csv", "text/csv"],
    ["arrow", "application/vnd.apache.arrow.stream"],
    ["json", "application/json"],
  ]) {
    assert.deepEqual(await saved(page, format), await fetched(link, accept), format);
  }
  // Pictures of diagrams are the service's own, others are of the plot.
  const picture = `${link}&form=cartesian&scale=linear&theme=light`;
  assert.deepEqual(await saved(page, "svg"), await fetched(picture, "image/svg+xml"));
  await drawing(page, () => page.check('input[name="plot"][value="hemisphere"]', { force: true }));
  assert.match((await saved(page, "svg")).toString(), /^<svg/);
  assert.match((await saved(page, "png")).toString("latin1"), /^\x89PNG/);
  await close();
});
