// The wind of the last day from the daemon's own recording: of each sensor its mean, between its least and its largest.
import { element, set_text } from "./element";
import { ask, Refused } from "./request";
import { History } from "./status";
import { color, root_px } from "./style";
import { texts } from "./texts";
import uPlot from "./vendor/uplot/uPlot.esm.js";
import { plain_number_text } from "./wording";

const ASK_EVERY_MS = 60_000;
const ASK_AGAIN_MS = 5000; // while it is still being read
const PATIENCE_MS = 10_000;
const HEIGHT_REM = 12;
const LEAST_SCALE_M_S = 2;
const COLORS = ["--measured", "--blended", "--other", "--live"]; // as .legend of page.css has them
const BAND_OPACITY = "40";

export class HistoryView {
  private readonly note = element("p", { class: "empty" }, texts.loading);
  private readonly place = element("div", { class: "history", role: "img", hidden: "" });
  private readonly legend = element("ul", { class: "legend", hidden: "" });
  private plot: uPlot | undefined;
  private history: History | undefined;
  private due: ReturnType<typeof setTimeout> | undefined;
  private is_recorded: boolean | undefined;
  private is_asking = false;

  constructor(place: HTMLElement) {
    place.append(this.note, this.place, this.legend);
    new ResizeObserver(() => {
      if (this.plot?.width !== this.place.clientWidth) this.draw();
    }).observe(this.place);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  /** Without a recording no history is requested. */
  show(is_recorded: boolean): void {
    if (is_recorded === this.is_recorded) return;
    this.is_recorded = is_recorded;
    if (!is_recorded) this.say(texts.nothing_recorded_ever);
    this.ask_now();
  }

  /** Asks now, and then each minute. */
  ask_now(): void {
    clearTimeout(this.due);
    if (this.is_recorded) void this.load();
  }

  private async load(): Promise<void> {
    if (this.is_asking) return;
    this.is_asking = true;
    let again_ms = ASK_EVERY_MS;
    try {
      this.history = await ask<History>("/api/v1/history?hours=24", undefined, PATIENCE_MS);
      const names = this.history.sensors.map((sensor) => sensor.name);
      this.say(names.length > 0 ? "" : texts.nothing_recorded);
      this.place.setAttribute("aria-label", texts.recorded_wind(names.join(texts.between)));
      this.legend.replaceChildren(...names.map((name, index) => element("li", { "data-color": String(index % COLORS.length) }, name)));
      this.draw();
    } catch (error) {
      if (error instanceof Refused && error.status === 404) {
        this.say(texts.nothing_recorded_ever);
      } else {
        again_ms = ASK_AGAIN_MS;
        const is_slow = error instanceof Refused && error.status === 503;
        if (!this.history) this.say(is_slow ? texts.still_read : texts.recording_unreadable);
      }
    } finally {
      this.is_asking = false;
      this.due = setTimeout(() => this.ask_now(), again_ms);
    }
  }

  /** In place of the picture; nothing: the picture. */
  private say(text: string): void {
    set_text(this.note, text);
    this.note.hidden = text === "";
    this.place.hidden = this.legend.hidden = text !== "";
  }

  private draw(): void {
    this.plot?.destroy();
    this.plot = undefined;
    const history = this.history;
    if (!history || this.place.clientWidth === 0) return;
    const times_s = Array.from({ length: history.step_count }, (_, index) => history.begin_s + index * history.step_s);
    const rows = history.sensors.flatMap((sensor) => [sensor.max_m_s, sensor.min_m_s, sensor.mean_m_s]);
    this.plot = new uPlot(this.options(history), [times_s, ...rows], this.place);
  }

  private options(history: History): uPlot.Options {
    const rem = root_px();
    const font = `${Math.round(0.75 * rem)}px system-ui, sans-serif`;
    const axis = { stroke: color("--muted"), font, ticks: { show: false } };
    const clock = new Intl.DateTimeFormat("en-GB", { hour: "2-digit", minute: "2-digit" });
    const colors = history.sensors.map((_, index) => color(COLORS[index % COLORS.length] as string));
    const hidden = { width: 0, points: { show: false } };
    return {
      width: this.place.clientWidth,
      height: HEIGHT_REM * rem,
      padding: [0.6 * rem, 0.6 * rem, 0, 0],
      legend: { show: false },
      cursor: { show: false },
      scales: {
        x: { time: true, range: [history.begin_s, history.begin_s + history.step_count * history.step_s] },
        y: { range: (_plot, _least, most) => [0, Math.max(LEAST_SCALE_M_S, 1.1 * (most ?? 0))] },
      },
      axes: [
        { ...axis, grid: { show: false }, space: 5 * rem, size: 1.8 * rem, gap: 0.5 * rem,
          values: (_plot, splits) => splits.map((time_s) => clock.format(new Date(1000 * time_s))) },
        { ...axis, grid: { stroke: color("--line"), width: 1 }, size: 1.9 * rem, gap: 0.3 * rem, space: 2.4 * rem,
          values: (_plot, splits) => splits.map(plain_number_text) },
      ],
      series: [{}, ...colors.flatMap((stroke) => [hidden, hidden, { stroke, width: 1.5 }])],
      bands: colors.map((fill, index) => ({ series: [3 * index + 1, 3 * index + 2] as uPlot.Band.Bounds, fill: fill + BAND_OPACITY })),
    };
  }
}
