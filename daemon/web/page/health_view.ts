// How the daemon itself does.
import { element, set_text } from "./element";
import { Lateness, Recorder, Status } from "./status";
import { bytes_text, milliseconds_text } from "./wording";

const UNKNOWN = "–";

function lateness_text(lateness: Lateness | null): string {
  if (!lateness) return UNKNOWN;
  return `${milliseconds_text(lateness.p50_s)} typical, 1 % over ${milliseconds_text(lateness.p99_s)}`;
}

function recorder_text(recorder: Recorder | null): string {
  if (!recorder) return "off";
  if (recorder.state !== "writing") return `${recorder.state ?? "in an unknown state"}: ${recorder.error}`;
  const lost = recorder.lost > 0 ? `, ${recorder.lost} dropped` : "";
  return `writing, ${recorder.written.toLocaleString("en")} readings${lost}`;
}

const FACTS: [string, (status: Status) => string][] = [
  ["Ticks", (status) => `${status.tick_rate_hz} Hz, ${status.late_ticks.toLocaleString("en")} skipped`],
  ["Ticks late by", (status) => lateness_text(status.tick_lateness)],
  ["Sensors and clients late by", (status) => lateness_text(status.io_lateness)],
  ["Recorder", (status) => recorder_text(status.recorder)],
  ["Free on its disk", (status) => (status.recorder?.free_bytes == null ? UNKNOWN : bytes_text(status.recorder.free_bytes))],
  ["Viewers", (status) => `${status.clients.connected} connected`],
  ["Program", (status) => status.software],
];

export class HealthView {
  private readonly values: HTMLElement[];

  constructor(place: HTMLElement) {
    this.values = FACTS.map(() => element("dd", {}, UNKNOWN));
    FACTS.forEach(([name], index) => place.append(element("div", {}, element("dt", {}, name), this.values[index] ?? "")));
  }

  show(status: Status): void {
    FACTS.forEach(([, text], index) => set_text(this.values[index] as Node, text(status)));
  }

  clear(): void {
    for (const value of this.values) set_text(value, UNKNOWN);
  }
}
