// The connection to the daemon: its state over the WebSocket /ws if it has one, otherwise requested twice a second.
import { ask, Refused } from "./request";
import { Status } from "./status";

const ASK_EVERY_MS = 500;
const TRY_AGAIN_AFTER_MS = 500;
const SILENCE_MS = 2500; // of a WebSocket that sends twice a second

export interface Listener {
  news(status: Status): void;
  /** The daemon replies, but without its state. */
  refused(refusal: Refused): void;
  /** It does not answer. */
  lost(): void;
}

const after = (time_ms: number) => new Promise((resolve) => setTimeout(resolve, time_ms));

/** Returns true if the daemon states that it has /ws. */
async function has_web_socket(): Promise<boolean> {
  const description = await ask<{ paths: object }>("/api/v1/openapi.json");
  return "/ws" in description.paths;
}

/** Receives from the WebSocket until it ends. Returns false if nothing came: there was no place, or a proxy lets none through. */
function hear(listener: Listener): Promise<boolean> {
  return new Promise((resolve) => {
    let has_heard = false;
    const socket = new WebSocket((location.protocol === "https:" ? "wss://" : "ws://") + location.host + "/ws");
    const end = () => {
      socket.onclose = socket.onmessage = null;
      socket.close();
      resolve(has_heard);
    };
    let silence = setTimeout(end, SILENCE_MS);
    socket.onopen = () => socket.send(JSON.stringify({ status: 2 }));
    socket.onclose = () => {
      clearTimeout(silence);
      end();
    };
    socket.onmessage = (message) => {
      if (typeof message.data !== "string") return;
      clearTimeout(silence);
      silence = setTimeout(end, SILENCE_MS);
      const { status } = JSON.parse(message.data) as { status?: Status };
      if (!status) return;
      has_heard = true;
      listener.news(status);
    };
  });
}

/** Never ends. Each failure is reported at once. */
export async function listen(listener: Listener): Promise<never> {
  for (;;) {
    try {
      listener.news(await ask<Status>("/api/v1/status"));
      if ((await has_web_socket()) && (await hear(listener))) listener.lost();
      for (;;) {
        await after(ASK_EVERY_MS);
        listener.news(await ask<Status>("/api/v1/status"));
      }
    } catch (error) {
      if (error instanceof Refused) listener.refused(error);
      else listener.lost();
    }
    await after(TRY_AGAIN_AFTER_MS);
  }
}
