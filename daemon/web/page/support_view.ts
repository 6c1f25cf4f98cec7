// What a helper needs: the support bundle, and the configuration with its findings, to read. For those who may change something.
import { Change } from "./change";
import { element, set_text_in } from "./element";
import { carry_out, download } from "./job";
import { PrivatePart } from "./private_part";
import { ask } from "./request";
import { Configuration } from "./status";
import { DAEMON_LANGUAGE, language, texts } from "./texts";

const PATIENCE_MS = 60_000; // the daemon checks the configuration first

export class SupportView {
  private readonly progress = element("p", { class: "reason", role: "status" });
  private readonly note = element("p", { class: "empty" }, texts.loading);
  private readonly findings = element("ul", { class: "attention", lang: DAEMON_LANGUAGE });
  private readonly filter = element("input", { type: "search", id: "configuration-filter", autocomplete: "off", spellcheck: "false" });
  private readonly values = element("dl", { class: "facts configuration", lang: DAEMON_LANGUAGE, tabindex: "0", "aria-label": texts.configuration });
  private readonly configuration = element("div", { hidden: "" }, this.findings,
    element("label", { for: "configuration-filter" }, texts.filter), this.filter, this.values);
  private readonly part = new PrivatePart(this.note, this.configuration, texts.configuration_unpaired);

  constructor(private readonly details: HTMLDetailsElement, private readonly change: Change) {
    const bundle = element("button", { type: "button" }, texts.make_bundle);
    bundle.addEventListener("click", async () => {
      bundle.disabled = true;
      await this.make_bundle();
      bundle.disabled = false;
      bundle.focus();
    });
    this.filter.addEventListener("input", () => this.apply_filter());
    details.append(element("p", { class: "empty" }, texts.bundle_help), element("div", { class: "buttons" }, bundle), this.progress,
      element("h3", {}, texts.configuration), this.note, this.configuration);
    details.addEventListener("toggle", () => this.ask_now());
  }

  ask_now(): void {
    if (!this.details.open) return;
    void this.part.load(ask<Configuration>("/api/v1/configuration", undefined, PATIENCE_MS), (reply) => this.show(reply));
  }

  private async make_bundle(): Promise<void> {
    const show = (text: string, lang = language) => set_text_in(lang, this.progress, text);
    const job = await carry_out(this.change, "/api/v1/support-bundle", (text) => show(text));
    if (job?.state === "failed") show(job.message, DAEMON_LANGUAGE);
    if (!job?.file) return;
    show("");
    download(job.file.path, job.file.name);
  }

  private show({ findings, configuration }: Configuration): string {
    this.findings.replaceChildren(...findings.map((finding) => element("li", {}, finding)));
    this.values.replaceChildren(...lines_of(configuration).map(([key, value]) =>
      element("div", {}, element("dt", {}, key), element("dd", {}, value))));
    this.values.hidden = configuration === null;
    this.apply_filter();
    return "";
  }

  private apply_filter(): void {
    const wanted = this.filter.value.trim().toLowerCase();
    for (const line of this.values.children) (line as HTMLElement).hidden = !line.textContent?.toLowerCase().includes(wanted);
  }
}

/** The values with their keys, a line each: "http.listen", "sensors.roof.values.host". */
function lines_of(value: unknown, key = ""): [string, string][] {
  const below = (name: string) => (key === "" ? name : `${key}.${name}`);
  if (Array.isArray(value) && value.some((item) => typeof item === "object"))
    return value.flatMap((item: unknown, index) => lines_of(item, below(name_of(item) ?? String(index + 1))));
  if (typeof value === "object" && value !== null && !Array.isArray(value)) return Object.entries(value).flatMap(([name, item]) => lines_of(item, below(name)));
  return key === "" ? [] : [[key, typeof value === "string" ? value : JSON.stringify(value)]];
}

function name_of(item: unknown): string | undefined {
  const name = typeof item === "object" && item !== null ? (item as { name?: unknown }).name : undefined;
  return typeof name === "string" && name !== "" ? name : undefined;
}
