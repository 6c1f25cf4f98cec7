// The last lines of the daemon's log, while they are visible.
import { element } from "./element";
import { PrivatePart } from "./private_part";
import { ask } from "./request";
import { LogLine } from "./status";
import { DAEMON_LANGUAGE, texts } from "./texts";
import { clock_text } from "./wording";

const ASK_EVERY_MS = 5000;
const QUIET = ["trace", "debug", "info"];

export class LogView {
  private readonly part: PrivatePart;

  constructor(
    private readonly details: HTMLDetailsElement,
    note: HTMLElement,
    private readonly list: HTMLElement,
  ) {
    this.part = new PrivatePart(note, list, texts.log_unpaired);
    details.addEventListener("toggle", () => this.ask_now());
    setInterval(() => this.ask_now(), ASK_EVERY_MS);
  }

  ask_now(): void {
    if (!this.details.open) return;
    void this.part.load(ask<{ lines: LogLine[] }>("/api/v1/log?lines=200"), ({ lines }) => {
      this.show(lines);
      return lines.length > 0 ? "" : texts.log_empty;
    });
  }

  private show(lines: LogLine[]): void {
    const last = JSON.stringify([lines.length, lines[lines.length - 1]]);
    if (this.list.dataset["last"] === last) return;
    this.list.dataset["last"] = last;
    this.list.replaceChildren(...lines.map(item_of));
    this.list.scrollTop = this.list.scrollHeight;
  }
}

function item_of({ time_s, level, text }: LogLine): HTMLElement {
  const time = new Date(1000 * time_s);
  return element(
    "li",
    { lang: DAEMON_LANGUAGE, ...(!QUIET.includes(level) && { class: "serious" }) },
    element("time", { datetime: time.toISOString() }, clock_text(time)),
    " ",
    element("span", { class: "level" }, level),
    " " + text,
  );
}
