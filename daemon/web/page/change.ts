// Changes something: sends the request, pairs the browser if needed, and shows the result.
import { by_id, set_text, set_text_in } from "./element";
import { Pairing } from "./pairing";
import { ask, Refused } from "./request";
import { DAEMON_LANGUAGE, language, texts } from "./texts";

const TOLD_FOR_MS = 6000;

export class Change {
  private hide: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly pairing: Pairing) {}

  /** Sends the request; undefined if it was not carried out. The page then shows why, or `refused` does. */
  async make<T>(path: string, body: object, refused = (why: string) => this.tell(DAEMON_LANGUAGE, why), method = "POST"): Promise<T | undefined> {
    return this.with_rights(() => ask<T>(path, body, undefined, method), refused);
  }

  /** Asks for something that takes the right to change something; undefined if it was refused. */
  async with_rights<T>(act: () => Promise<T>, refused = (why: string) => this.tell(DAEMON_LANGUAGE, why)): Promise<T | undefined> {
    try {
      return await act();
    } catch (error) {
      if (error instanceof Refused && error.status === 401) {
        if (await this.pairing.open(error.message)) return this.with_rights(act, refused);
      } else if (error instanceof Refused) {
        refused(error.message);
      } else {
        this.tell(language, texts.not_done_no_reply);
      }
      return undefined;
    }
  }

  tell(lang: string, text: string): void {
    const toast = by_id("toast");
    set_text_in(lang, by_id("alert"), text);
    set_text_in(lang, toast, text);
    toast.hidden = false;
    clearTimeout(this.hide);
    this.hide = setTimeout(() => {
      toast.hidden = true;
      set_text(by_id("alert"), "");
    }, TOLD_FOR_MS);
  }
}
