// A job of the daemon: begun, and asked for until it has ended.
import { Change } from "./change";
import { ask, Refused } from "./request";
import { Job } from "./status";
import { texts } from "./texts";
import { duration_text } from "./wording";

const ASK_EVERY_MS = 500;
const MAX_FAILURES = 20;

/** Begins a job and waits for its end; undefined if it was not begun, or the daemon does not know it any more. `show` gets what to show meanwhile. */
export async function carry_out(change: Change, path: string, show: (text: string, job?: Job) => void, body: object = {}, refused?: (why: string) => void): Promise<Job | undefined> {
  let job = await change.make<Job>(path, body, refused);
  for (let failures = 0; job?.state === "running"; ) {
    show(texts.job_runs(duration_text(job.run_for_s)), job);
    await new Promise((resolve) => setTimeout(resolve, ASK_EVERY_MS));
    try {
      job = await ask<Job>(`/api/v1/jobs/${job.id}`);
      failures = 0;
    } catch (error) {
      if (error instanceof Refused || ++failures === MAX_FAILURES) {
        show(texts.job_lost);
        return undefined;
      }
    }
  }
  if (job === undefined) show("");
  return job;
}

/** Lets the browser store a file. */
export function download(path: string, name: string): void {
  const link = document.createElement("a");
  link.href = path;
  link.download = name;
  link.click();
}
