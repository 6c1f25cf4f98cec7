// Each sensor with its state, the reason of it, and how old its last reading is.
import { element, Rows, set_text } from "./element";
import { age_of } from "./sentence";
import { is_believed, Sensor, Status } from "./status";
import { DAEMON_LANGUAGE, texts } from "./texts";
import { clock_text, duration_text, number_text, wind_text, word_of } from "./wording";

interface Row {
  item: HTMLElement;
  state: HTMLElement;
  wind: HTMLElement;
  age: HTMLElement;
  reason: HTMLElement;
  details: HTMLElement;
}

function make_row(name: string): { item: HTMLElement; row: Row } {
  const state = element("span", { class: "badge" });
  const wind = element("span", { class: "strong" });
  const age = element("span", { class: "age" });
  const reason = element("span", { lang: DAEMON_LANGUAGE });
  const details = element("span");
  const item = element("li", { class: "sensor" },
    element("div", { class: "line" }, element("h3", {}, name), state),
    element("div", { class: "line" }, wind, age), element("p", { class: "reason" }, reason, details));
  return { item, row: { item, state, wind, age, reason, details } };
}

function reading_text(sensor: Sensor): string {
  if (sensor.speed_m_s === null) return texts.no_reading;
  const wind = wind_text(sensor.speed_m_s, sensor.direction_deg);
  return is_believed(sensor) ? wind : texts.last_reading(wind);
}

/** From here on it is shown, as `yuragi sensors watch` does. */
const SHOWN_TIMES_GROUP = 1.03;

/** What stands behind the reason of its state. */
function details_text(sensor: Sensor): string {
  const missing = sensor.quantities.filter((quantity) => quantity.is_missing);
  const speed = sensor.value === "" ? [] : [texts.speed_is(sensor.value)];
  const times = sensor.reads_times_group;
  const group = Math.abs(Math.log(times)) < Math.log(SHOWN_TIMES_GROUP) ? [] : [texts.times_group(number_text(times, 2))];
  const no_quantity = missing.map(({ name, reason }) => texts.quantity_missing(word_of(texts.quantities, name), reason));
  return [...speed, ...group, ...no_quantity].join(texts.between_sentences);
}

export class SensorsView {
  private readonly rows: Rows<Row>;
  private status: Status | undefined;

  constructor(list: HTMLElement) {
    this.rows = new Rows(list, make_row, texts.no_sensor);
  }

  show(status: Status, since_s: number): void {
    this.status = status;
    const rows = this.rows.for_names(status.sensors.map((sensor) => sensor.name));
    status.sensors.forEach((sensor, index) => {
      const row = rows[index];
      if (!row) return;
      const age_s = age_of(sensor, status, since_s);
      row.item.dataset["state"] = sensor.state;
      set_text(row.state, word_of(texts.states, sensor.state));
      row.wind.className = is_believed(sensor) ? "strong" : "age";
      set_text(row.wind, reading_text(sensor));
      set_text(row.age, age_s === null ? sensor.driver : `${sensor.driver} · ${texts.old(duration_text(age_s))}`);
      const details = details_text(sensor);
      set_text(row.reason, sensor.state_reason + (details && texts.between_sentences));
      set_text(row.details, details);
    });
  }

  /** Nothing is known any more. */
  clear(since: Date): void {
    if (!this.status) return;
    const rows = this.rows.for_names(this.status.sensors.map((sensor) => sensor.name));
    this.status.sensors.forEach((sensor, index) => {
      const row = rows[index];
      if (!row) return;
      row.item.dataset["state"] = "unknown";
      set_text(row.state, texts.not_known);
      row.wind.className = "age";
      set_text(row.wind, "–");
      set_text(row.age, sensor.driver);
      set_text(row.reason, "");
      set_text(row.details, texts.was(word_of(texts.states, sensor.state), clock_text(since)));
    });
    this.status = undefined;
  }
}
