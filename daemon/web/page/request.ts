// Requests to the daemon, each within a time.

const PATIENCE_MS = 2500;
const CHANGE_PATIENCE_MS = 65_000; // the daemon may make scenes anew; after 60 s it gives up by itself, with words

/** The daemon replied, but refused the request. */
export class Refused extends Error {
  constructor(
    readonly status: number,
    detail: string,
  ) {
    super(detail);
  }
}

/** The JSON of its answer. Throws Refused, or any other error if no reply came. */
export async function ask<T>(path: string, body?: object, patience_ms = body ? CHANGE_PATIENCE_MS : PATIENCE_MS, method = "POST"): Promise<T> {
  const abort = new AbortController();
  const patience = setTimeout(() => abort.abort(), patience_ms);
  try {
    const answer = await fetch(path, {
      signal: abort.signal,
      ...(body && { method, headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) }),
    });
    if (answer.ok) return (await answer.json()) as T;
    throw new Refused(answer.status, await detail_of(answer));
  } finally {
    clearTimeout(patience);
  }
}

/** Of a problem (RFC 9457), or what else it is. */
async function detail_of(answer: Response): Promise<string> {
  try {
    const problem = (await answer.clone().json()) as { detail?: unknown };
    if (typeof problem.detail === "string") return problem.detail;
  } catch {
    // Not JSON: it is from a server in front of the daemon.
  }
  return `${answer.status} ${answer.statusText}`.trim();
}
