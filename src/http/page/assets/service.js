// Everything that is asked of the service: one request after another, the last one counts.

const KEY = "reflectance.key";
let key = read();

function read() {
  try {
    return sessionStorage.getItem(KEY) ?? "";
  } catch {
    // Storage may be forbidden; the key is asked for again then.
    return "";
  }
}

/** Keeps a key for as long as the tab is open. It is never part of a link. */
export function useKey(text) {
  key = text;
  try {
    sessionStorage.setItem(KEY, text);
  } catch {
    // It holds until the page is left.
  }
}

/** The service cannot be reached. */
export class Away extends Error {}

/** The service refused, and says why. */
export class Refused extends Error {
  constructor(status, problem, retryAfter) {
    super(problem.detail ?? problem.title ?? `The service answered with status ${status}.`);
    this.status = status;
    this.problem = problem;
    /** Seconds to wait, where asking again later helps. */
    this.retryAfter = retryAfter;
  }
}

/** Sends a request; the path is relative to the page, so that a prefix in front of both does no harm. */
export async function ask(path, { body, accept = "application/json", signal } = {}) {
  const headers = { accept };
  if (key) headers.authorization = `Bearer ${key}`;
  if (body !== undefined) headers["content-type"] = "application/json";
  let response;
  try {
    response = await fetch(path, {
      method: body === undefined ? "GET" : "POST",
      headers,
      signal,
      body: body === undefined ? undefined : JSON.stringify(body),
    });
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new Away();
  }
  if (response.ok) return response;
  // A proxy in front answers so when there is nobody behind it.
  if (response.status === 502 || response.status === 504) throw new Away();
  const problem = await response.json().catch(() => ({}));
  const wait = Number(response.headers.get("retry-after"));
  const later = response.status === 503 || response.status === 429;
  throw new Refused(response.status, problem, later ? Math.max(1, wait || 1) : undefined);
}

/** An answer as JSON. */
export const json = async (path, options) =>
  taken(
    () => ask(path, options),
    (response) => response.json(),
  );

async function taken(send, read) {
  const response = await send();
  try {
    return await read(response);
  } catch (error) {
    if (error.name === "AbortError" || error instanceof SyntaxError) throw error;
    const answers = await isThere();
    throw answers
      ? new Error("The service ended its answer before it was whole: it takes longer than is allowed.")
      : new Away();
  }
}

/** Reads an answer while it arrives, and gives each piece of bytes to `each`. */
export async function stream(path, options, each) {
  return taken(
    () => ask(path, options),
    async (response) => {
      const reader = response.body.getReader();
      for (;;) {
        const { done, value } = await reader.read();
        if (done) return response;
        each(value);
      }
    },
  );
}

/** The same, line by line. */
export async function lines(path, options, each) {
  const decoder = new TextDecoder();
  let rest = "";
  const take = (text) => {
    const parts = (rest + text).split("\n");
    rest = parts.pop();
    parts.forEach((line) => each(line.replace(/\r$/, "")));
  };
  await stream(path, options, (bytes) => take(decoder.decode(bytes, { stream: true })));
  take(`${decoder.decode()}\n`);
}

/** Of several requests for the same place only the last counts: those before it are cancelled, and what they still
 * answer is dropped. */
export class Latest {
  #controller = null;

  /** Runs `work` with a signal; its value, or undefined if another was begun meanwhile. */
  async run(work) {
    this.cancel();
    const controller = new AbortController();
    this.#controller = controller;
    try {
      const value = await work(controller.signal);
      return this.#controller === controller ? value : undefined;
    } catch (error) {
      if (this.#controller !== controller || error.name === "AbortError") return undefined;
      throw error;
    }
  }

  cancel() {
    this.#controller?.abort();
    this.#controller = null;
  }
}

async function isThere() {
  const answer = await fetch("livez", { cache: "no-store" }).catch(() => null);
  return answer?.ok === true;
}

/** Waits until the service answers again. */
export async function back() {
  for (;;) {
    await new Promise((resolve) => setTimeout(resolve, 1000));
    if (await isThere()) return;
  }
}
