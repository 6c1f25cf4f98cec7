// The connection to the daemon: its state over the WebSocket /ws if it has one, otherwise requested twice a second.
import { ask, Refused } from "./request";
import { Status } from "./status";

const ASK_EVERY_MS = 500;
const TRY_AGAIN_AFTER_MS = 500;
const USELESS_FOR_MS = 2000; // of a stream for which there was no use
const POLICY_ERROR = 1008; // of RFC 6455, 7.4.1
const SILENCE_MS = 2500; // of a WebSocket that sends twice a second

export interface Listener {
  news(status: Status): void;
  /** The daemon replies, but without its state. */
  refused(refusal: Refused): void;
  /** It does not answer. */
  lost(): void;
}

/** The stream of poses that is wanted beside the state: /ws of the guide describes it. */
export interface StreamWish {
  scenes?: string[];
  /** With light, cameras and what else the viewer's picture takes beside poses. */
  sensors: true;
  every: number;
  rate: number;
}
export interface Stream {
  wish: StreamWish;
  /** Before each connection. Returns false if there is no use for it now. */
  begin(): Promise<boolean>;
  /** Takes a message. Returns false if the connection is of no use. */
  take(message: ArrayBuffer): boolean;
  /** The daemon does not send what was wished, for this reason. */
  refused(why: string): void;
}

const after = (time_ms: number) => new Promise((resolve) => setTimeout(resolve, time_ms));

/** Returns true if the daemon states that it has /ws. */
async function has_web_socket(): Promise<boolean> {
  const description = await ask<{ paths: object }>("/api/v1/openapi.json");
  return "/ws" in description.paths;
}

/** Receives from the WebSocket until it ends. Returns false if nothing came: there was no place, or a proxy lets none through. */
function hear(listener: Listener, stream?: Stream): Promise<boolean> {
  return new Promise((resolve) => {
    let has_heard = false;
    const socket = new WebSocket((location.protocol === "https:" ? "wss://" : "ws://") + location.host + "/ws");
    socket.binaryType = "arraybuffer";
    const end = () => {
      document.removeEventListener("visibilitychange", rest);
      socket.onclose = socket.onmessage = null;
      socket.close();
      resolve(has_heard);
    };
    const rest = () => {
      if (stream && document.hidden) end();
    };
    document.addEventListener("visibilitychange", rest);
    let silence = setTimeout(end, SILENCE_MS);
    socket.onopen = () => socket.send(JSON.stringify({ status: 2, ...(stream && { stream: stream.wish }) }));
    socket.onclose = (event) => {
      clearTimeout(silence);
      if (event.code === POLICY_ERROR) stream?.refused(event.reason);
      end();
    };
    socket.onmessage = (message) => {
      if (message.data instanceof ArrayBuffer && stream?.take(message.data) === false) end();
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

/** While the page is visible. */
const sight = () => new Promise<void>((resolve) => {
  const look = () => {
    if (document.hidden) return;
    document.removeEventListener("visibilitychange", look);
    resolve();
  };
  document.addEventListener("visibilitychange", look);
  look();
});

/** Never ends. Each failure is reported at once. With a stream it rests while the page is hidden. */
export async function listen(listener: Listener, stream?: Stream): Promise<never> {
  for (;;) {
    if (stream) await sight();
    try {
      listener.news(await ask<Status>("/api/v1/status"));
      const is_ready = stream === undefined || (await stream.begin());
      if (is_ready && (await has_web_socket()) && (await hear(listener, stream))) listener.lost();
      if (stream) await after(is_ready ? 0 : USELESS_FOR_MS);
      while (!stream) {
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
