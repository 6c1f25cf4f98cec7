// A sensor is calibrated here, step by step: what to prepare, the readings meanwhile, the values found with their effect, and whether to keep them.
import { Change } from "./change";
import { by_id, element, set_text, set_text_in } from "./element";
import { carry_out } from "./job";
import { ask } from "./request";
import { CalibratedSensor, CalibrationState, CalibrationWay, Job } from "./status";
import { DAEMON_LANGUAGE, language, texts } from "./texts";
import { number_text, plain_number_text, wind_text, word_of } from "./wording";

const PATIENCE_MS = 60_000; // the daemon asks a program of its own
const NUMBER = "{number}"; // in a preparation: the bearing or the speed

type Point = CalibrationState["points"][number];

const state_of = (job: Job | undefined) => (job?.kind === "calibrate" ? (job.result as unknown as CalibrationState | null) : null);

function progress_text({ elapsed_s, duration_s, readings }: CalibrationState): string {
  const left = texts.left(texts.seconds(number_text(Math.ceil(duration_s - (elapsed_s ?? 0)), 0)));
  return [left, ...readings.map(({ sensor, count, speed_m_s, direction_deg }) =>
    `${sensor}: ${count === 0 ? texts.no_reading : texts.readings_so_far(plain_number_text(count), wind_text(speed_m_s, direction_deg))}`)].join(texts.between);
}

/** "1.04", "0:0 5:5.2" */
const value_text = (value: number | string) => (typeof value === "number" ? String(value) : value === "" ? "–" : value);

function table(heads: string[], rows: string[][]): HTMLElement {
  return element("table", { class: "values" },
    element("thead", {}, element("tr", {}, ...heads.map((head) => (head === "" ? element("td", {}) : element("th", { scope: "col" }, head))))),
    element("tbody", {}, ...rows.map((row) => element("tr", {}, ...row.map((cell) => element("td", {}, cell))))));
}

export class CalibrationView {
  private readonly dialog = by_id("calibration") as HTMLDialogElement;
  private readonly sensor = by_id("calibration-sensor") as HTMLSelectElement;
  private readonly way = by_id("calibration-way") as HTMLSelectElement;
  private readonly steps = by_id("calibration-steps");
  private readonly number = by_id("calibration-number") as HTMLInputElement;
  private readonly reference = by_id("calibration-reference") as HTMLSelectElement;
  private readonly time = by_id("calibration-time") as HTMLInputElement;
  private readonly preparation = by_id("calibration-preparation");
  private readonly progress = by_id("calibration-progress");
  private readonly result = by_id("calibration-result");
  private readonly error = by_id("calibration-error");
  private readonly stop = by_id("calibration-stop") as HTMLButtonElement;
  private readonly keep = by_id("calibration-keep") as HTMLButtonElement;
  private readonly inputs = [this.sensor, this.way, this.number, this.reference, this.time, by_id("calibration-start") as HTMLButtonElement];
  private sensors: CalibratedSensor[] = [];
  private points: Point[] = []; // known winds that were measured, of this sensor
  private found: CalibrationState | undefined;
  private running: string | undefined; // the job

  /** `changed`: something was kept. */
  constructor(place: HTMLElement, private readonly change: Change, private readonly changed: () => void) {
    const begin = element("button", { type: "button" }, texts.calibrate_sensor);
    place.append(element("div", { class: "buttons" }, begin));
    begin.addEventListener("click", () => void this.open());
    this.sensor.addEventListener("change", () => this.choose_sensor());
    this.way.addEventListener("change", () => this.choose_way());
    this.number.addEventListener("input", () => this.show_preparation());
    this.stop.addEventListener("click", () => void this.cancel());
    this.keep.addEventListener("click", () => void this.keep_values());
    by_id("calibration-close").addEventListener("click", () => this.dialog.close());
    this.dialog.addEventListener("close", () => void this.cancel());
    by_id("calibration-form").addEventListener("submit", (event) => {
      event.preventDefault();
      void this.measure();
    });
  }

  private async open(): Promise<void> {
    const known = await this.change.with_rights(() => ask<{ sensors: CalibratedSensor[] }>("/api/v1/calibrations", undefined, PATIENCE_MS));
    if (!known) return;
    this.sensors = known.sensors;
    this.sensor.replaceChildren(...this.sensors.map(({ sensor, driver }) => element("option", { value: sensor }, `${sensor} (${driver})`)));
    this.choose_sensor();
    this.dialog.showModal();
  }

  private chosen(): { sensor: CalibratedSensor | undefined; way: CalibrationWay | undefined } {
    const sensor = this.sensors[this.sensor.selectedIndex];
    return { sensor, way: sensor && this.ways_of(sensor)[this.way.selectedIndex] };
  }

  private ways_of = ({ ways }: CalibratedSensor) => ways.filter(({ given }) => given !== "reference" || this.sensors.length > 1);

  private choose_sensor(): void {
    const { sensor } = this.chosen();
    const ways = sensor ? this.ways_of(sensor) : [];
    const label = ({ calibration, given }: CalibrationWay) => word_of(texts.calibration_ways, `${calibration}-${given}`);
    this.way.replaceChildren(...ways.map((way) => element("option", {}, label(way))));
    this.reference.replaceChildren(...this.sensors.filter((one) => one !== sensor).map((one) => element("option", { value: one.sensor }, one.sensor)));
    this.steps.hidden = ways.length === 0;
    this.choose_way();
    if (ways.length === 0) this.refuse(texts.cannot_calibrate, language);
  }

  private choose_way(): void {
    const { way } = this.chosen();
    this.points = [];
    this.show_found(undefined);
    set_text(this.progress, "");
    set_text(this.error, "");
    if (!way) return;
    const has_number = way.given === "bearing" || way.given === "speed";
    (this.number.parentElement as HTMLElement).hidden = !has_number;
    (this.reference.parentElement as HTMLElement).hidden = way.given !== "reference";
    this.number.required = has_number;
    this.number.min = way.given === "speed" ? "0.1" : "0";
    this.number.max = way.given === "speed" ? "100" : "360";
    this.number.value = "";
    set_text(by_id("calibration-number-label"), way.given === "speed" ? texts.known_speed : texts.known_bearing);
    this.time.value = String(way.duration_s);
    this.show_preparation();
  }

  private show_preparation(): void {
    set_text(this.preparation, (this.chosen().way?.preparation ?? "").replace(NUMBER, this.number.value || "…").replace(/\n/g, " "));
  }

  private async measure(): Promise<void> {
    const { sensor, way } = this.chosen();
    if (!sensor || !way || this.running !== undefined) return;
    set_text(this.error, "");
    this.show_found(undefined);
    const given = way.given === "bearing" ? { bearing_deg: Number(this.number.value) } : way.given === "speed" ? { speed_m_s: Number(this.number.value) }
      : way.given === "reference" ? { reference: this.reference.value } : {};
    this.busy(true);
    const ended = await this.carry_out(sensor, { calibration: way.calibration, for_s: Number(this.time.value), ...given });
    const point = state_of(ended)?.points[0];
    if (way.given === "speed" && point) {
      this.points = [...this.points, point].sort((one, other) => one.measured_m_s - other.measured_m_s);
      // A line through all of them.
      if (this.points.length > 1) await this.carry_out(sensor, { calibration: way.calibration, points: this.points.map(({ measured_m_s, true_m_s }) => `${measured_m_s}:${true_m_s}`).join(" ") });
    }
    this.busy(false);
  }

  /** The job, when it has ended; shows its result. */
  private async carry_out(sensor: CalibratedSensor, body: object): Promise<Job | undefined> {
    set_text(this.error, "");
    const show = (text: string, job?: Job) => {
      this.running = job?.id;
      const state = state_of(job);
      set_text_in(language, this.progress, state?.elapsed_s != null ? progress_text(state) : text);
    };
    const job = await carry_out(this.change, `/api/v1/sensors/${encodeURIComponent(sensor.sensor)}/calibrate`, show, body, (why) => this.refuse(why));
    this.running = undefined;
    set_text(this.progress, "");
    if (job?.state === "failed") this.refuse(job.message);
    const state = state_of(job);
    if (state) this.show_found(state, job?.state === "done");
    return job;
  }

  private show_found(state: CalibrationState | undefined, is_done = false): void {
    const { before, after, effect } = state ?? {};
    const { way } = this.chosen();
    const can_keep = is_done && !!before && !!after;
    this.found = can_keep ? state : undefined;
    this.keep.disabled = !can_keep;
    const cell = (value: number, unit: string) => `${number_text(value, unit === "m/s" ? 2 : 1)} ${unit}`;
    this.result.replaceChildren(
      ...(state?.notes ?? []).map((note) => element("p", { lang: DAEMON_LANGUAGE }, note)),
      ...(before && after ? [table(["", texts.value_before, texts.value_after], Object.entries(after).map(([key, value]) => [key, value_text(before[key] ?? ""), value_text(value)]))] : []),
      ...(effect ? [table([texts.sensor_reads, texts.value_before, texts.value_after],
        effect.rows.map(({ indicated, now, then }) => [cell(indicated, effect.indicated_unit), cell(now, effect.unit), cell(then, effect.unit)]))] : []),
      ...(can_keep && way?.calibration === "span" && way.given === "speed" ? [element("p", {}, texts.more_winds)] : []));
  }

  private async cancel(): Promise<void> {
    if (this.running !== undefined) await this.change.make(`/api/v1/jobs/${this.running}`, {}, undefined, "DELETE");
  }

  private async keep_values(): Promise<void> {
    const { sensor } = this.chosen();
    if (!sensor || !this.found) return;
    const { before, after } = this.found;
    const done = await this.change.make<{ message: string }>(`/api/v1/sensors/${encodeURIComponent(sensor.sensor)}/calibration`, { before, after }, (why) => this.refuse(why));
    if (!done) return;
    this.change.tell(DAEMON_LANGUAGE, done.message);
    this.dialog.close();
    this.changed();
  }

  private busy(is_busy: boolean): void {
    for (const input of this.inputs) input.disabled = is_busy;
    this.stop.hidden = !is_busy;
    if (!is_busy) (by_id("calibration-start") as HTMLButtonElement).focus();
  }

  private refuse(why: string, lang = DAEMON_LANGUAGE): void {
    set_text_in(lang, this.error, why);
  }
}
