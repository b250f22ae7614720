// Watches the specular spike die: the same surface from 0.002 to 10 wavelengths of roughness, seen by a camera from the
// mirror direction. No dependencies: node 20 or a browser. The service is at REFLECTANCE_URL.

const url = globalThis.process?.env.REFLECTANCE_URL ?? "http://127.0.0.1:8080";

/** Posts JSON. What is wrong with a request is told with every field of it. */
async function post(path, body) {
  const response = await fetch(url + path, {
    method: "POST",
    headers: { "content-type": "application/json" },
    body: JSON.stringify(body),
  });
  const answer = await response.json();
  if (!response.ok) {
    const faults = (answer.errors ?? []).map(({ pointer, detail }) => `\n  ${pointer}: ${detail}`);
    throw new Error(`${answer.title}${faults.join("")}`);
  }
  return answer;
}

const wavelength = 0.55;
const roughnesses = [0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10];

const answers = await Promise.all(
  roughnesses.map((ratio) =>
    post("/v1/radiance", {
      model: "beckmann_spizzichino",
      surface: { rms_height_um: ratio * wavelength, correlation_length_um: 200 * wavelength },
      illumination: { wavelength_um: wavelength },
      sensor: { pixel_area_um2: 25, distance_um: 5e5, focal_length_um: 5e4, aperture_um: 1e4 },
      geometry: { theta_i_deg: 30, theta_r_deg: 30 },
      components: ["specular_lobe", "specular_spike"],
      output: { log10: true, per_direction: true },
    }),
  ),
);

// What underflows has its logarithm still.
const power = (log10) => (log10 === null ? "0" : `10^${log10.toFixed(2)}`);
console.log("σ_h/λ".padStart(7), "g".padStart(10), "spike".padStart(12), "lobe".padStart(10), "  error at most");
for (const [place, answer] of answers.entries()) {
  console.log(
    String(roughnesses[place]).padStart(7),
    answer.roughness_g[0].toPrecision(3).padStart(10),
    power(answer.log10_specular_spike[0]).padStart(12),
    power(answer.log10_specular_lobe[0]).padStart(10),
    `  ${answer.relative_error_bound[0].toExponential(1)}`,
  );
}
const dies = answers.findIndex((answer) => answer.log10_specular_spike[0] < answer.log10_specular_lobe[0]);
console.log(`From ${roughnesses[dies]} wavelengths on the lobe is the brighter one.`);
