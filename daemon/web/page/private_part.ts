// A part of the page for those who may change something: what it shows, or a note that states why it is not shown.
import { set_text_in } from "./element";
import { Refused } from "./request";
import { DAEMON_LANGUAGE, language } from "./texts";

export class PrivatePart {
  /** `unpaired`: the note for a browser that has to be paired first. */
  constructor(private readonly note: HTMLElement, private readonly content: HTMLElement, private readonly unpaired: string) {}

  /** Asks for what is shown, and shows it; `show` returns a note in place of it, or "". */
  async load<Reply>(asked: Promise<Reply>, show: (reply: Reply) => string): Promise<void> {
    try {
      this.say(show(await asked));
    } catch (error) {
      if (!(error instanceof Refused)) return; // the link shows what is wrong
      if (error.status === 401) this.say(this.unpaired);
      else this.say(error.message, DAEMON_LANGUAGE);
    }
  }

  private say(text: string, lang = language): void {
    set_text_in(lang, this.note, text);
    this.note.hidden = text === "";
    this.content.hidden = text !== "";
  }
}
