// The last lines of the daemon's log, while they are visible.
import { element, set_text_in } from "./element";
import { ask, Refused } from "./request";
import { LogLine } from "./status";
import { DAEMON_LANGUAGE, language, texts } from "./texts";
import { clock_text } from "./wording";

const ASK_EVERY_MS = 5000;
const QUIET = ["trace", "debug", "info"];

export class LogView {
  constructor(
    private readonly details: HTMLDetailsElement,
    private readonly note: HTMLElement,
    private readonly list: HTMLElement,
  ) {
    details.addEventListener("toggle", () => this.ask_now());
    setInterval(() => this.ask_now(), ASK_EVERY_MS);
  }

  ask_now(): void {
    if (this.details.open) void this.load();
  }

  private async load(): Promise<void> {
    try {
      const { lines } = await ask<{ lines: LogLine[] }>("/api/v1/log?lines=200");
      this.say(lines.length > 0 ? "" : texts.log_empty);
      this.show(lines);
    } catch (error) {
      if (!(error instanceof Refused)) return; // the link shows what is wrong
      if (error.status === 401) this.say(texts.log_unpaired);
      else this.say(error.message, DAEMON_LANGUAGE);
    }
  }

  private say(text: string, lang = language): void {
    set_text_in(lang, this.note, text);
    this.note.hidden = text === "";
    this.list.hidden = text !== "";
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
