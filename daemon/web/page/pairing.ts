// The dialog for the code that pairs this browser.
import { by_id, set_text_in } from "./element";
import { ask, Refused } from "./request";
import { DAEMON_LANGUAGE, language, texts } from "./texts";

export class Pairing {
  private readonly dialog = by_id("pairing") as HTMLDialogElement;
  private readonly code = by_id("pairing-code") as HTMLInputElement;
  private readonly error = by_id("pairing-error");
  private done: ((is_paired: boolean) => void) | undefined;

  constructor() {
    by_id("pairing-form").addEventListener("submit", (event) => {
      event.preventDefault();
      void this.send();
    });
    by_id("pairing-cancel").addEventListener("click", () => this.dialog.close());
    this.dialog.addEventListener("close", () => this.end(false));
  }

  /** Opens it; true once this browser is paired, false if the dialog is cancelled. */
  open(why = ""): Promise<boolean> {
    this.end(false);
    this.code.value = "";
    set_text_in(DAEMON_LANGUAGE, this.error, why.includes("token_file") ? why : "");
    this.dialog.showModal();
    return new Promise((resolve) => (this.done = resolve));
  }

  private end(is_paired: boolean): void {
    this.done?.(is_paired);
    this.done = undefined;
  }

  private async send(): Promise<void> {
    try {
      await ask("/api/v1/pair", { code: this.code.value });
      this.end(true);
      this.dialog.close();
    } catch (error) {
      if (error instanceof Refused) set_text_in(DAEMON_LANGUAGE, this.error, error.message);
      else set_text_in(language, this.error, texts.no_reply);
      this.code.select();
    }
  }
}
