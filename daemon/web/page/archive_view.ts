// The files of the daemon's recording: to download, to verify, and for a report. For those who may change something.
import { Change } from "./change";
import { element, Rows, set_text } from "./element";
import { carry_out, download } from "./job";
import { PrivatePart } from "./private_part";
import { ask } from "./request";
import { Recording, Verification } from "./status";
import { DAEMON_LANGUAGE, language, texts } from "./texts";
import { bytes_text, date_text, plain_number_text } from "./wording";

const PATH = "/api/v1/recordings";
const ASK_EVERY_MS = 10_000;

interface Row {
  about: HTMLElement;
  is_written: boolean;
}

export class ArchiveView {
  private readonly rows: Rows<Row>;
  private readonly part: PrivatePart;

  constructor(
    private readonly details: HTMLDetailsElement,
    note: HTMLElement,
    list: HTMLElement,
    private readonly change: Change,
  ) {
    this.part = new PrivatePart(note, list, texts.archive_unpaired);
    this.rows = new Rows(list, (name) => this.make_row(name), texts.nothing_recorded_ever);
    details.addEventListener("toggle", () => this.ask_now());
    setInterval(() => this.ask_now(), ASK_EVERY_MS);
  }

  ask_now(): void {
    if (!this.details.open) return;
    void this.part.load(ask<{ recordings: Recording[] }>(PATH), ({ recordings }) => {
      this.show(recordings);
      return "";
    });
  }

  private show(recordings: Recording[]): void {
    const rows = this.rows.for_names(recordings.map((recording) => recording.name));
    recordings.forEach(({ bytes, first_s, last_s, is_written }, index) => {
      const row = rows[index];
      if (!row) return;
      row.is_written = is_written;
      const span = first_s !== null && last_s !== null ? [texts.span(date_text(first_s), date_text(last_s))] : [];
      set_text(row.about, [bytes_text(bytes), ...span, ...(is_written ? [texts.being_written] : [])].join(texts.between));
    });
  }

  private make_row(name: string): { item: HTMLElement; row: Row } {
    const path = `${PATH}/${encodeURIComponent(name)}`;
    const about = element("p", { class: "reason" });
    const result = element("div", { class: "result", role: "status" });
    const row = { about, is_written: false };
    const buttons = element("div", { class: "buttons" });
    const show = (text: string, lang = language) => result.replaceChildren(...(text ? [element("p", { lang }, text)] : []));
    const button = (text: string, label: string, act: () => Promise<void>) => {
      const made = element("button", { type: "button", "aria-label": label }, text);
      made.addEventListener("click", async () => {
        for (const one of buttons.children) (one as HTMLButtonElement).disabled = true;
        await act();
        for (const one of buttons.children) (one as HTMLButtonElement).disabled = false;
        made.focus();
      });
      buttons.append(made);
    };
    /** The job, if it has succeeded. */
    const job = async (kind: string) => {
      const ended = await carry_out(this.change, `${path}/${kind}`, (text) => show(text));
      if (ended?.state === "failed") show(ended.message, DAEMON_LANGUAGE);
      return ended?.state === "done" ? ended : undefined;
    };
    button(texts.download, texts.download_of(name), async () => {
      if (!row.is_written) return download(path, name);
      const file = (await job("copy"))?.file;
      if (!file) return;
      show("");
      download(file.path, file.name);
    });
    button(texts.verify, texts.verify_of(name), async () => {
      const verification = (await job("verify"))?.result as Verification | null | undefined;
      if (verification) result.replaceChildren(...verification_text(verification));
    });
    button(texts.report, texts.report_of(name), async () => {
      const file = (await job("report"))?.file;
      if (file) result.replaceChildren(element("p", {}, element("a", { href: file.path, target: "_blank", rel: "noopener" }, texts.open_report)));
    });
    return { item: element("li", {}, element("h3", {}, name), about, buttons, result), row };
  }
}

function verification_text({ is_sound, files, missing, gaps }: Verification): HTMLElement[] {
  const readings = files.reduce((sum, file) => sum + file.readings, 0);
  const summary = texts.verified(plain_number_text(readings), plain_number_text(files.length), plain_number_text(gaps.length));
  const damage = files.flatMap((file) => file.damage.map((what) => `${file.file}: ${what}`)).concat(missing.map((file) => `${file}: missing`));
  return [
    element("p", { class: is_sound ? "sound" : "error" }, (is_sound ? texts.sound : texts.damaged) + texts.between_sentences + summary),
    ...(damage.length > 0 ? [element("ul", { lang: DAEMON_LANGUAGE }, ...damage.map((what) => element("li", {}, what)))] : []),
  ];
}
