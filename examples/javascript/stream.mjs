// A long diagram, read while it is computed: rows are looked at as they come, and the service stops when the reader leaves.
// No dependencies: node 20 or a browser. The service is at REFLECTANCE_URL.

const url = globalThis.process?.env.REFLECTANCE_URL ?? "http://127.0.0.1:8080";

const points = 100_000;
const query = new URLSearchParams({
  model: "beckmann_spizzichino",
  rms_height_um: "0.2",
  correlation_length_um: "4",
  wavelength_um: "0.55",
  components: "specular_lobe",
  sweep: "theta_r_deg",
  from_deg: "-89",
  to_deg: "89",
  points: String(points),
  at_deg: "0,30,60",
});

/** The rows of a CSV answer, each as an object of numbers by name. */
async function* rows(response) {
  let names;
  let ahead = "";
  for await (const piece of response.body.pipeThrough(new TextDecoderStream())) {
    const lines = (ahead + piece).split("\r\n");
    // The last may have come in part.
    ahead = lines.pop();
    for (const line of lines) {
      const cells = line.split(",");
      if (names) {
        yield Object.fromEntries(names.map((name, column) => [name, Number(cells[column])]));
      } else {
        names = cells;
      }
    }
  }
}

const leave = new AbortController();
const response = await fetch(`${url}/v1/diagrams?${query}`, { headers: { accept: "text/csv" }, signal: leave.signal });
if (!response.ok) {
  throw new Error(await response.text());
}

const total = "total_W_m-2_sr-1";
const peaks = new Map();
let count = 0;
for await (const row of rows(response)) {
  count += 1;
  const peak = peaks.get(row.theta_i_deg);
  if (!peak || row[total] > peak[total]) {
    peaks.set(row.theta_i_deg, row);
  }
  if (count === 2 * points) {
    // Two of the three curves are enough: what is left of the third need not be computed.
    leave.abort();
    break;
  }
}
for (const [source, row] of peaks) {
  console.log(`source at ${source}°: brightest at ${Math.round(100 * row.theta_r_deg) / 100}°, ${row[total].toPrecision(6)} W m^-2 sr^-1`);
}
console.log(`${count} of ${3 * points} rows read`);
