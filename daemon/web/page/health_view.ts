// The health of the daemon itself.
import { element, set_text } from "./element";
import { Animation, Feed, GustReach, Lateness, Recorder, Status } from "./status";
import { bytes_text, milliseconds_text } from "./wording";

const UNKNOWN = "–";

function lateness_text(lateness: Lateness | null): string {
  if (!lateness) return UNKNOWN;
  return `${milliseconds_text(lateness.p50_s)} typical, 1 % over ${milliseconds_text(lateness.p99_s)}`;
}

function animation_text(animation: Animation | null): string {
  if (!animation) return UNKNOWN;
  const times = animation.carried_times;
  const carried = times === null ? "" : times < 1 ? ": much for this machine" : `: this machine carries ${times.toFixed(1)} times as much`;
  return `${milliseconds_text(animation.tick_s)} of each ${milliseconds_text(animation.period_s)}${carried}`;
}

/** The costliest first. */
function scene_costs_text(animation: Animation | null): string {
  const shown = (animation?.scenes ?? []).filter((scene) => scene.tick_s > 0).sort((one, other) => other.tick_s - one.tick_s);
  if (shown.length === 0) return UNKNOWN;
  return shown.map((scene) => `${scene.name} ${milliseconds_text(scene.tick_s, 2)} (${Math.round(100 * scene.share)} %)`).join(", ");
}

function recorder_text(recorder: Recorder | null): string {
  if (!recorder) return "off";
  if (recorder.state !== "writing") return `${recorder.state ?? "in an unknown state"}: ${recorder.error}`;
  const lost = recorder.lost > 0 ? `, ${recorder.lost} dropped` : "";
  return `writing, ${recorder.written.toLocaleString("en")} readings${lost}`;
}

/** As `yuragi sensors watch` shows it. */
function reach_text(reach: GustReach): string {
  const shown = [reach.across === null ? "" : `${reach.across.toFixed(2)} times as far across the wind`,
    reach.along === null ? "" : `${reach.along.toFixed(2)} times as far along the wind`].filter((text) => text !== "");
  return shown.length === 0 ? UNKNOWN : `${shown.join(" and ")} as usually`;
}

/** As `yuragi status` shows it. */
function feeds_text(feeds: Feed[]): string {
  if (feeds.length === 0) return "nobody";
  return feeds.map((feed) => {
    const last = feed.last_sent_age_s === null ? "nothing sent yet" : `last ${feed.last_sent_age_s.toFixed(1)} s ago`;
    return `${feed.name} (${feed.kind}) at ${feed.target}: ${feed.sends}; ${feed.trouble === "" ? last : `cannot send: ${feed.trouble}`}`;
  }).join("; ");
}

const FACTS: [string, (status: Status) => string][] = [
  ["Ticks", (status) => `${status.tick_rate_hz} Hz, ${status.recent_skipped_ticks.toLocaleString("en")} skipped in 10 minutes`],
  ["Work of a tick", (status) => animation_text(status.animation)],
  ["Of it, by scene", (status) => scene_costs_text(status.animation)],
  ["Ticks late by", (status) => lateness_text(status.tick_lateness)],
  ["Sensors and clients late by", (status) => lateness_text(status.io_lateness)],
  ["Gusts are alike", (status) => reach_text(status.gust_reach)],
  ["Recorder", (status) => recorder_text(status.recorder)],
  ["Free on its disk", (status) => (status.recorder?.free_bytes == null ? UNKNOWN : bytes_text(status.recorder.free_bytes))],
  ["Sends the wind to", (status) => feeds_text(status.feeds)],
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
