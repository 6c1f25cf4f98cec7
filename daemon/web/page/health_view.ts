// The health of the daemon itself.
import { element, set_text } from "./element";
import { Animation, Feed, GustReach, Lateness, Recorder, Status } from "./status";
import { texts } from "./texts";
import { bytes_text, duration_text, milliseconds_text, number_text, plain_number_text, word_of } from "./wording";

const UNKNOWN = "–";

function lateness_text(lateness: Lateness | null): string {
  if (!lateness) return UNKNOWN;
  return texts.lateness(milliseconds_text(lateness.p50_s), milliseconds_text(lateness.p99_s));
}

function animation_text(animation: Animation | null): string {
  if (!animation) return UNKNOWN;
  const times = animation.carried_times;
  const carried = times === null ? "" : times < 1 ? texts.carries_too_much : texts.carries(number_text(times, 1));
  return texts.work_of_period(milliseconds_text(animation.tick_s), milliseconds_text(animation.period_s)) + carried;
}

/** The costliest first. */
function scene_costs_text(animation: Animation | null): string {
  const shown = (animation?.scenes ?? []).filter((scene) => scene.tick_s > 0).sort((one, other) => other.tick_s - one.tick_s);
  if (shown.length === 0) return UNKNOWN;
  return shown.map((scene) => `${scene.name} ${milliseconds_text(scene.tick_s, 2)} (${Math.round(100 * scene.share)} %)`).join(texts.between);
}

function recorder_text(recorder: Recorder | null): string {
  if (!recorder) return texts.recorder_off;
  if (recorder.state !== "writing") {
    const state = recorder.state === null ? texts.recorder_unknown : word_of(texts.recorder_states, recorder.state);
    return texts.recorder_fails(state, recorder.error);
  }
  const lost = recorder.lost > 0 ? texts.readings_lost(plain_number_text(recorder.lost)) : "";
  return texts.recorder_writes(plain_number_text(recorder.written)) + lost;
}

/** As `yuragi sensors watch` shows it. */
function reach_text(reach: GustReach): string {
  const shown = [reach.across === null ? "" : texts.far_across(number_text(reach.across, 2)),
    reach.along === null ? "" : texts.far_along(number_text(reach.along, 2))].filter((text) => text !== "");
  return shown.length === 0 ? UNKNOWN : texts.than_usually(shown.join(texts.and));
}

/** As `yuragi status` shows it. */
function feeds_text(feeds: Feed[]): string {
  if (feeds.length === 0) return texts.nobody;
  return feeds.map((feed) => {
    const last = feed.last_sent_age_s === null ? texts.nothing_sent : texts.last_sent(duration_text(feed.last_sent_age_s));
    return `${texts.feed_at(feed.name, feed.kind, feed.target)}${feed.sends}; ${feed.trouble === "" ? last : texts.cannot_send(feed.trouble)}`;
  }).join("; ");
}

const FACTS: [string, (status: Status) => string][] = [
  [texts.ticks, (status) => texts.ticks_skipped(plain_number_text(status.tick_rate_hz), plain_number_text(status.recent_skipped_ticks))],
  [texts.tick_work, (status) => animation_text(status.animation)],
  [texts.work_by_scene, (status) => scene_costs_text(status.animation)],
  [texts.ticks_late, (status) => lateness_text(status.tick_lateness)],
  [texts.io_late, (status) => lateness_text(status.io_lateness)],
  [texts.gusts_alike, (status) => reach_text(status.gust_reach)],
  [texts.recorder, (status) => recorder_text(status.recorder)],
  [texts.disk_free, (status) => (status.recorder?.free_bytes == null ? UNKNOWN : bytes_text(status.recorder.free_bytes))],
  [texts.wind_goes_to, (status) => feeds_text(status.feeds)],
  [texts.viewers, (status) => texts.connected(plain_number_text(status.clients.connected))],
  [texts.program, (status) => status.software],
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
