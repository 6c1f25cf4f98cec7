// The one sentence and the one light on top. Pure: what is known and the time in, text out.
import { leading_sensor, Sensor, Status } from "./status";
import { clock_text, duration_text, wind_text } from "./wording";

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

const HOW: Record<string, string> = {
  live: "Live",
  replayed: "A recording, not live",
  simulated: "Synthetic wind, not measured",
};

function verdict_of_sensor(sensor: Sensor, status: Status, since_s: number): Verdict {
  const age_s = age_of(sensor, status, since_s);
  const how = HOW[sensor.state] ?? sensor.state;
  const announcement = `${how}: ${sensor.name}`;
  const age = age_s === null ? "" : `, ${duration_text(age_s)} old`;
  const light = sensor.state !== "live" ? "other" : status.verdict === "well" ? "live" : "attention";
  return { light, text: `${announcement}, ${wind_text(sensor.speed_m_s, sensor.direction_deg)}${age}`, announcement };
}

function verdict_without_sensor(status: Status): Verdict {
  const wind =
    status.wind.source === "live" ? "A recording plays, nothing is measured"
    : status.wind.source === "handover" ? "No longer measured"
    : "Synthetic wind";
  const [first, ...others] = status.sensors;
  const why =
    first === undefined ? "no sensor is configured"
    : others.length === 0 ? `${first.name} is ${first.state}`
    : `no sensor is live: ${status.sensors.map((sensor) => `${sensor.name} is ${sensor.state}`).join(", ")}`;
  const text = `${wind}, because ${why}`;
  return { light: "other", text, announcement: text };
}

export function verdict_of(knowledge: Knowledge): Verdict {
  switch (knowledge.kind) {
    case "connecting":
      return { light: "lost", text: "Connecting to the daemon …", announcement: "" };
    case "lost": {
      const text = `No connection since ${clock_text(knowledge.since)}`;
      return { light: "lost", text, announcement: text };
    }
    case "refused": {
      const text = knowledge.needs_pairing ? "This browser may not see anything until it is paired" : `No news: ${knowledge.why}`;
      return { light: "lost", text, announcement: knowledge.needs_pairing ? text : "No news from the daemon" };
    }
    case "news": {
      const sensor = leading_sensor(knowledge.status);
      return sensor
        ? verdict_of_sensor(sensor, knowledge.status, knowledge.age_s)
        : verdict_without_sensor(knowledge.status);
    }
  }
}
