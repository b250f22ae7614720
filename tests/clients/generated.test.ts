// The types that openapi-typescript makes of the document, with openapi-fetch, against the running service. tsc checks
// them when it makes JavaScript of this file: the lines marked with @ts-expect-error have to be wrong.

import assert from "node:assert/strict";
import { test } from "node:test";
import createClient from "openapi-fetch";
import type { components, paths } from "./document.js";

type RadianceRequest = components["schemas"]["RadianceRequest"];

const { REFLECTANCE_URL: baseUrl = "", REFLECTANCE_KEY: key = "" } = process.env;
const client = createClient<paths>({ baseUrl, headers: { authorization: `Bearer ${key}` } });

const scene: RadianceRequest = {
  model: "beckmann_spizzichino",
  surface: { rms_height_um: 0.2, correlation_length_um: 4 },
  illumination: { wavelength_um: 0.55 },
  geometry: { theta_i_deg: 30, theta_r_deg: [30, 45] },
};

test("radiance", async () => {
  const { data, error } = await client.POST("/v1/radiance", { body: scene });
  assert.equal(error, undefined);
  assert.ok(typeof data === "object" && "total" in data);
  assert.deepEqual(data.total, [9.870528376282403, 1.9158949680966844]);
  assert.equal(data.omitted[0]?.component, "specular_spike");
});

test("radiance at several wavelengths", async () => {
  const body: RadianceRequest = { ...scene, illumination: { wavelength_um: [0.45, 0.55] } };
  const { data } = await client.POST("/v1/radiance", { body });
  assert.ok(typeof data === "object" && "spectrum" in data);
  assert.deepEqual(data.spectrum.map((line) => line.wavelength_um), [0.45, 0.55]);
});

test("roughness", async () => {
  const query = { rms_height_um: 0.0003, correlation_length_um: 0.01 };
  const { data } = await client.GET("/v1/roughness", { params: { query } });
  assert.equal(data?.facet_slope_deg, 2.4279433133767867);
});

test("diagram", async () => {
  const { data } = await client.POST("/v1/diagrams", {
    body: {
      model: "torrance_sparrow",
      surface: { facet_slope_deg: 9 },
      sweep: "theta_r_deg",
      from_deg: -80,
      to_deg: 80,
      points: 81,
      at_deg: [30, 60],
    },
  });
  assert.ok(typeof data === "object");
  assert.deepEqual(data.series.map((series) => [series.at_deg, series.total?.length]), [[30, 81], [60, 81]]);
});

test("figure as CSV", async () => {
  const { data } = await client.GET("/v1/figures/{id}", {
    params: { path: { id: "23a" } },
    headers: { accept: "text/csv" },
    parseAs: "text",
  });
  assert.ok(typeof data === "string" && data.startsWith("label,theta_r_deg,theta_i_deg"));
});

test("mistakes", async () => {
  const body: RadianceRequest = { ...scene, surface: { rms_height_um: -1 } };
  const { error, response } = await client.POST("/v1/radiance", { body });
  assert.equal(response.status, 422);
  assert.ok(error?.errors);
  const pointers = error.errors.map(({ pointer }) => pointer).sort();
  assert.deepEqual(pointers, ["/surface/correlation_length_um", "/surface/rms_height_um"]);
});

test("what the types refuse, the service refuses", async () => {
  // @ts-expect-error: not one of the models.
  const model: RadianceRequest["model"] = "phong";
  // @ts-expect-error: no such member.
  const surface: RadianceRequest["surface"] = { rms_height: 0.2 };
  const { error } = await client.POST("/v1/radiance", { body: { ...scene, model, surface } });
  const pointers = error?.errors?.map(({ pointer }) => pointer);
  assert.ok(pointers?.includes("/model") && pointers.includes("/surface/rms_height"), JSON.stringify(error));
});
