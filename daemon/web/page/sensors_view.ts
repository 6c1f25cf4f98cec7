// Each sensor with its state, the reason of it, and how old its last reading is.
import { element, Rows, set_text } from "./element";
import { age_of } from "./sentence";
import { is_believed, Sensor, Status } from "./status";
import { clock_text, duration_text, wind_text } from "./wording";

interface Row {
  item: HTMLElement;
  state: HTMLElement;
  wind: HTMLElement;
  age: HTMLElement;
  reason: HTMLElement;
}

function make_row(name: string): { item: HTMLElement; row: Row } {
  const state = element("span", { class: "badge" });
  const wind = element("span", { class: "strong" });
  const age = element("span", { class: "age" });
  const reason = element("p", { class: "reason" });
  const item = element("li", { class: "sensor" },
    element("div", { class: "line" }, element("h3", {}, name), state),
    element("div", { class: "line" }, wind, age), reason);
  return { item, row: { item, state, wind, age, reason } };
}

function reading_text(sensor: Sensor): string {
  if (sensor.speed_m_s === null) return "No reading yet";
  const wind = wind_text(sensor.speed_m_s, sensor.direction_deg);
  return is_believed(sensor) ? wind : "Last: " + wind;
}

/** From here on it is shown, as `yuragi sensors watch` does. */
const SHOWN_TIMES_GROUP = 1.03;

function reason_text(sensor: Sensor): string {
  const missing = sensor.quantities.filter((quantity) => quantity.is_missing);
  const speed = sensor.value === "" ? [] : [`Speed: ${sensor.value}`];
  const times = sensor.reads_times_group;
  const group = Math.abs(Math.log(times)) < Math.log(SHOWN_TIMES_GROUP) ? [] : [`Reads ${times.toFixed(2)} times the group`];
  return [sensor.state_reason, ...speed, ...group, ...missing.map((quantity) => `No ${quantity.name}: ${quantity.reason}`)].join(". ");
}

export class SensorsView {
  private readonly rows: Rows<Row>;
  private status: Status | undefined;

  constructor(list: HTMLElement) {
    this.rows = new Rows(list, make_row, "No sensor is configured.");
  }

  show(status: Status, since_s: number): void {
    this.status = status;
    const rows = this.rows.for_names(status.sensors.map((sensor) => sensor.name));
    status.sensors.forEach((sensor, index) => {
      const row = rows[index];
      if (!row) return;
      const age_s = age_of(sensor, status, since_s);
      row.item.dataset["state"] = sensor.state;
      set_text(row.state, sensor.state);
      row.wind.className = is_believed(sensor) ? "strong" : "age";
      set_text(row.wind, reading_text(sensor));
      set_text(row.age, age_s === null ? sensor.driver : `${sensor.driver} · ${duration_text(age_s)} old`);
      set_text(row.reason, reason_text(sensor));
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
      set_text(row.state, "not known");
      row.wind.className = "age";
      set_text(row.wind, "–");
      set_text(row.age, sensor.driver);
      set_text(row.reason, `It was ${sensor.state} at ${clock_text(since)}.`);
    });
    this.status = undefined;
  }
}
