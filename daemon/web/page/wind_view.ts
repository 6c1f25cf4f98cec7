// Compass, figures and trace of the wind.
import { Compass } from "./compass";
import { element, set_text } from "./element";
import { ask } from "./request";
import { leading_sensor, RecentWind, Status } from "./status";
import { texts } from "./texts";
import { Trace } from "./trace";
import { from_text, number_text } from "./wording";

const UNKNOWN = "–";

class Figure {
  readonly box: HTMLElement;
  private readonly value = element("span", { class: "number" }, UNKNOWN);
  private readonly note = element("span", { class: "note" });

  constructor(name: string, kind: string, unit: string) {
    this.box = element("div", { class: "figure" }, element("dt", { class: kind }, name),
      element("dd", {}, this.value, element("span", { class: "unit" }, " " + unit), this.note));
  }

  show(value: string, note = ""): void {
    set_text(this.value, value);
    set_text(this.note, note);
  }
}

export class WindView {
  private readonly compass = new Compass();
  private readonly trace = new Trace();
  private readonly measured = new Figure(texts.measured, "measured", "m/s");
  private readonly blended = new Figure(texts.blended, "blended", "m/s");
  private readonly noise = new Figure(texts.noise, "noise", "%");

  constructor(place: HTMLElement) {
    place.append(
      this.compass.dial,
      element("dl", { class: "figures" }, this.measured.box, this.blended.box, this.noise.box),
      this.trace.place,
    );
  }

  show(status: Status): void {
    const sensor = leading_sensor(status);
    const measured_m_s = sensor?.speed_m_s ?? null;
    const wind = status.wind;
    const share = 1 - wind.live_weight;
    const direction = (direction_deg: number | null | undefined) => (direction_deg == null ? "" : from_text(direction_deg));
    this.compass.show(sensor?.direction_deg ?? null, wind.direction_deg);
    this.measured.show(measured_m_s === null ? UNKNOWN : number_text(measured_m_s, 1), direction(sensor?.direction_deg));
    this.blended.show(number_text(wind.speed_m_s, 1), direction(wind.direction_deg));
    this.noise.show(number_text(100 * share, 0), "");
    this.trace.add(Date.now() / 1000, measured_m_s, wind.speed_m_s, share);
  }

  /** Fills the trace with the minutes before the page was opened, or while it had no connection. */
  async fill(): Promise<void> {
    try {
      this.trace.fill(await ask<RecentWind>("/api/v1/wind"), Date.now() / 1000);
    } catch {
      // The trace begins now; the link shows what is wrong.
    }
  }

  /** Nothing is known any more; the trace stays, with its times. */
  clear(): void {
    this.compass.show(null, null);
    for (const figure of [this.measured, this.blended, this.noise]) figure.show(UNKNOWN);
    this.trace.interrupt(Date.now() / 1000);
  }
}
