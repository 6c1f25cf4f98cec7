// The one sentence and the one light on top. Pure: what is known and the time in, text in the reader's language out.
import { leading_sensor, left_of, Sensor, Status } from "./status";
import { texts } from "./texts";
import { clock_text, duration_text, left_text, wind_text, word_of } from "./wording";

/** What the page knows of the daemon. */
export type Knowledge =
  | { kind: "connecting" }
  | { kind: "news"; status: Status; /** of the status since it came */ age_s: number }
  | { kind: "lost"; since: Date }
  | { kind: "refused"; needs_pairing: boolean; why: string };

/** live: measured now. attention: measured, and something is wrong. other: another wind. lost: not known. */
export type Light = "live" | "attention" | "other" | "lost";

export interface Verdict {
  light: Light;
  text: string;
  /** The same without what changes all the time: for those who hear it. */
  announcement: string;
}

/** Of a reading, now. */
export function age_of(sensor: Sensor, status: Status, since_s: number): number | null {
  return sensor.age_s === null ? null : sensor.age_s + status.age_s + since_s;
}

function verdict_of_sensor(sensor: Sensor, status: Status, since_s: number): Verdict {
  const age_s = age_of(sensor, status, since_s);
  const announcement = texts.source_and_sensor(word_of(texts.sources, sensor.state), sensor.name);
  const age = age_s === null ? [] : [texts.old(duration_text(age_s))];
  const light = sensor.state !== "live" ? "other" : status.verdict === "well" ? "live" : "attention";
  return { light, text: [announcement, wind_text(sensor.speed_m_s, sensor.direction_deg), ...age].join(texts.between), announcement };
}

function verdict_without_sensor(status: Status): Verdict {
  const wind =
    status.wind.source === "live" ? texts.recording_plays
    : status.wind.source === "handover" ? texts.no_longer_measured
    : texts.synthetic_wind;
  const states = status.sensors.map((sensor) => texts.sensor_is(sensor.name, word_of(texts.states, sensor.state)));
  const why =
    states.length === 0 ? texts.no_sensor_configured
    : states.length === 1 ? states.join()
    : texts.no_sensor_live(states.join(texts.between));
  const text = texts.wind_because(wind, why);
  return { light: "other", text, announcement: text };
}

/** undefined: the walls show the real wind. */
function verdict_of_hand({ by_hand: { wind, blackout }, age_s }: Status, since_s: number): Verdict | undefined {
  if (wind === null && blackout === null) return undefined;
  const parts = [
    ...(blackout ? [[texts.dark_by_hand, left_text(left_of(blackout, age_s + since_s))].join(texts.between)] : []),
    ...(wind ? [texts.is_what([texts.wind_by_hand, left_text(left_of(wind, age_s + since_s))].join(texts.between), wind_text(wind.speed_m_s, wind.direction_deg))] : []),
  ];
  const announcement = [...(blackout ? [texts.dark_by_hand] : []), ...(wind ? [texts.wind_by_hand] : [])].join(texts.between_sentences);
  return { light: "other", text: parts.join(texts.between_sentences), announcement };
}

export function verdict_of(knowledge: Knowledge): Verdict {
  switch (knowledge.kind) {
    case "connecting":
      return { light: "lost", text: texts.connecting, announcement: "" };
    case "lost": {
      const text = texts.no_connection_since(clock_text(knowledge.since));
      return { light: "lost", text, announcement: text };
    }
    case "refused": {
      const text = knowledge.needs_pairing ? texts.not_readable_yet : texts.no_news_because(knowledge.why);
      return { light: "lost", text, announcement: knowledge.needs_pairing ? text : texts.no_news };
    }
    case "news": {
      const by_hand = verdict_of_hand(knowledge.status, knowledge.age_s);
      if (by_hand) return by_hand;
      const sensor = leading_sensor(knowledge.status);
      return sensor
        ? verdict_of_sensor(sensor, knowledge.status, knowledge.age_s)
        : verdict_without_sensor(knowledge.status);
    }
  }
}
