// The wind of the last day, week, month or year from the daemon's own recording: of each sensor its mean, between its least and
// its largest, and where the wind came from.
import { element, set_text } from "./element";
import { ask, Refused } from "./request";
import { most_frequent_deg, Rose } from "./rose";
import { History } from "./status";
import { color, root_px } from "./style";
import { language, texts } from "./texts";
import uPlot from "./vendor/uplot/uPlot.esm.js";
import { date_text, from_text, number_text, plain_number_text } from "./wording";

const ASK_EVERY_MS = 60_000;
const ASK_AGAIN_MS = 5000; // while it is still being read
const PATIENCE_MS = 10_000;
const HEIGHT_REM = 12;
const LEAST_SCALE_M_S = 2;
const COLORS = ["--measured", "--blended", "--other", "--live"]; // as .legend of page.css has them
const BAND_OPACITY = "40";

const DAY_S = 86_400;
const MONTH_S = 30 * DAY_S; // of uPlot, which then takes the calendar's
const LENGTHS = {
  day: { hours: 24, space_rem: 5, marks_s: undefined, format: new Intl.DateTimeFormat("en-GB", { hour: "2-digit", minute: "2-digit" }) },
  week: { hours: 7 * 24, space_rem: 5, marks_s: [1, 2, 3].map((days) => days * DAY_S), format: new Intl.DateTimeFormat(language, { day: "numeric", month: "short" }) },
  month: { hours: 31 * 24, space_rem: 5, marks_s: [2, 4, 7, 14].map((days) => days * DAY_S), format: new Intl.DateTimeFormat(language, { day: "numeric", month: "short" }) },
  year: { hours: 366 * 24, space_rem: 3.5, marks_s: [1, 2, 3, 6].map((months) => months * MONTH_S), format: new Intl.DateTimeFormat(language, { month: "short" }) },
};
type Length = keyof typeof LENGTHS;
type Values = (number | null)[];

const color_index = (sensor: number) => String(sensor % COLORS.length);
const known = (values: Values) => values.flatMap((value) => (value === null ? [] : [value]));

/** Steps with a value between two without: a line alone would not show them. */
function alone_in(values: Values): number[] {
  return values.flatMap((value, index) => (value !== null && values[index - 1] == null && values[index + 1] == null ? [index] : []));
}

/** "roof: mean 4.2 m/s, largest 18.3 m/s (12 Nov 2026, 14:00), mostly from the south-west" */
function summary_of(sensor: History["sensors"][number], history: History): string {
  const means = known(sensor.mean_m_s);
  if (means.length === 0) return texts.nothing_recorded;
  const speed = (value_m_s: number) => number_text(value_m_s, 1) + " m/s";
  const largest_m_s = Math.max(...known(sensor.max_m_s));
  const largest_s = history.begin_s + sensor.max_m_s.indexOf(largest_m_s) * history.step_s;
  const from_deg = most_frequent_deg(sensor.direction_deg);
  const percent = Math.round(100 * (1 - means.length / history.step_count));
  return [
    texts.mean_is(speed(means.reduce((sum, mean) => sum + mean, 0) / means.length)),
    texts.largest_is(speed(largest_m_s), history.step_s < DAY_S ? date_text(largest_s) : new Date(1000 * largest_s).toLocaleDateString(language, { dateStyle: "medium" })),
    ...(from_deg === undefined ? [] : [texts.mostly(from_text(from_deg))]),
    ...(percent === 0 ? [] : [texts.share_without_readings(String(percent))]),
  ].join(texts.between);
}

export class HistoryView {
  private readonly note = element("p", { class: "empty", role: "status" }, texts.loading);
  private readonly plot_place = element("div", { class: "history", role: "img" });
  private readonly rose = new Rose();
  private readonly legend = element("ul", { class: "legend" });
  private readonly left_out = element("p", { class: "empty", hidden: "" });
  private readonly picture = element("div", { hidden: "" }, element("div", { class: "history-row" }, this.plot_place, this.rose.dial), this.legend, this.left_out);
  private readonly choice = element("fieldset", { class: "buttons lengths", "aria-label": texts.length_shown, hidden: "" });
  private length: Length = "day";
  private plot: uPlot | undefined;
  private history: History | undefined;
  private due: ReturnType<typeof setTimeout> | undefined;
  private is_recorded: boolean | undefined;
  private is_asking = false;

  constructor(place: HTMLElement) {
    for (const length of Object.keys(LENGTHS) as Length[]) {
      const button = element("button", { type: "button", "aria-pressed": String(length === this.length), "data-length": length }, texts.lengths[length]);
      button.addEventListener("click", () => this.choose(length));
      this.choice.append(button);
    }
    place.append(this.choice, this.note, this.picture);
    new ResizeObserver(() => {
      if (this.plot?.width !== this.plot_place.clientWidth) this.draw();
    }).observe(this.plot_place);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  /** Without a recording no history is requested. */
  show(is_recorded: boolean): void {
    if (is_recorded === this.is_recorded) return;
    this.is_recorded = is_recorded;
    this.choice.hidden = !is_recorded;
    if (!is_recorded) this.say(texts.nothing_recorded_ever);
    this.ask_now();
  }

  /** Asks now, and then each minute. */
  ask_now(): void {
    clearTimeout(this.due);
    if (this.is_recorded) void this.load();
  }

  private choose(length: Length): void {
    if (length === this.length) return;
    this.length = length;
    for (const button of this.choice.children) button.setAttribute("aria-pressed", String(button.getAttribute("data-length") === length));
    this.history = undefined;
    this.say(texts.loading);
    this.ask_now();
  }

  private async load(): Promise<void> {
    if (this.is_asking) return;
    this.is_asking = true;
    const length = this.length;
    let again_ms = ASK_EVERY_MS;
    try {
      const history = await ask<History>(`/api/v1/history?hours=${LENGTHS[length].hours}`, undefined, PATIENCE_MS);
      if (length === this.length) this.take(history);
    } catch (error) {
      if (length !== this.length) {
        // Another length was chosen meanwhile.
      } else if (error instanceof Refused && error.status === 404) {
        this.say(texts.nothing_recorded_ever);
      } else {
        again_ms = ASK_AGAIN_MS;
        const is_slow = error instanceof Refused && error.status === 503;
        if (!this.history) this.say(is_slow ? texts.still_read : texts.recording_unreadable);
      }
    } finally {
      this.is_asking = false;
      this.due = setTimeout(() => this.ask_now(), length === this.length ? again_ms : 0);
    }
  }

  private take(history: History): void {
    this.history = history;
    const { sensors } = history;
    this.say(sensors.length > 0 ? "" : texts.nothing_recorded);
    this.plot_place.setAttribute("aria-label", texts.recorded_wind(texts.lengths[this.length], sensors.map(({ name }) => name).join(texts.between)));
    this.legend.replaceChildren(...sensors.map((sensor, index) =>
      element("li", { "data-color": color_index(index) }, element("span", { class: "strong" }, sensor.name), " ", summary_of(sensor, history))));
    const vane = sensors.findIndex((sensor) => known(sensor.direction_deg).length > 0);
    this.rose.show(sensors[vane]?.direction_deg ?? [], color_index(Math.max(0, vane)));
    set_text(this.left_out, texts.files_left_out(plain_number_text(history.files_left_out)));
    this.left_out.hidden = history.files_left_out === 0;
    this.draw();
  }

  /** In place of the picture; nothing: the picture. */
  private say(text: string): void {
    set_text(this.note, text);
    this.note.hidden = text === "";
    this.picture.hidden = text !== "";
  }

  private draw(): void {
    this.plot?.destroy();
    this.plot = undefined;
    const history = this.history;
    if (!history || this.plot_place.clientWidth === 0) return;
    const times_s = Array.from({ length: history.step_count }, (_, index) => history.begin_s + (index + 0.5) * history.step_s);
    const rows = history.sensors.flatMap((sensor) => [sensor.max_m_s, sensor.min_m_s, sensor.mean_m_s]);
    this.plot = new uPlot(this.options(history), [times_s, ...rows], this.plot_place);
  }

  private options(history: History): uPlot.Options {
    const rem = root_px();
    const font = `${Math.round(0.75 * rem)}px system-ui, sans-serif`;
    const axis = { stroke: color("--muted"), font, ticks: { show: false } };
    const { format, marks_s, space_rem } = LENGTHS[this.length];
    const colors = history.sensors.map((_, index) => color(COLORS[index % COLORS.length] as string));
    const hidden = { width: 0, points: { show: false } };
    const mean = (stroke: string, index: number) => {
      const alone = alone_in(history.sensors[index]?.mean_m_s ?? []);
      return { stroke, width: 1.5, points: { show: alone.length > 0, filter: () => alone, size: 0.35 * rem, fill: stroke } };
    };
    return {
      width: this.plot_place.clientWidth,
      height: HEIGHT_REM * rem,
      padding: [0.6 * rem, 0.6 * rem, 0, 0],
      legend: { show: false },
      cursor: { show: false },
      scales: {
        x: { time: true, range: [history.begin_s, history.begin_s + history.step_count * history.step_s] },
        y: { range: (_plot, _least, most) => [0, Math.max(LEAST_SCALE_M_S, 1.1 * (most ?? 0))] },
      },
      axes: [
        { ...axis, grid: { show: false }, space: space_rem * rem, size: 1.8 * rem, gap: 0.5 * rem, ...(marks_s && { incrs: marks_s }),
          values: (_plot, splits) => splits.map((time_s) => format.format(new Date(1000 * time_s))) },
        { ...axis, grid: { stroke: color("--line"), width: 1 }, size: 1.9 * rem, gap: 0.3 * rem, space: 2.4 * rem,
          values: (_plot, splits) => splits.map(plain_number_text) },
      ],
      series: [{}, ...colors.flatMap((stroke, index) => [hidden, hidden, mean(stroke, index)])],
      bands: colors.map((fill, index) => ({ series: [3 * index + 1, 3 * index + 2] as uPlot.Band.Bounds, fill: fill + BAND_OPACITY })),
    };
  }
}
