// What the daemon answers, as openapi.json describes it. What is not known is null.

export interface Wind {
  speed_m_s: number;
  direction_deg: number | null;
  source: "default" | "handover" | "live" | null;
  live_weight: number;
}

export interface Quantity {
  name: string;
  age_s: number | null;
  is_missing: boolean;
  reason: string;
}

export interface Sensor {
  name: string;
  driver: string;
  state: string;
  state_reason: string;
  value: string;
  reads_times_group: number;
  quantities: Quantity[];
  speed_m_s: number | null;
  direction_deg: number | null;
  gust_m_s: number | null;
  age_s: number | null;
}

/** How many times as far gusts are alike here as usually: learnt from sensors at several places. */
export interface GustReach {
  across: number | null;
  along: number | null;
}

export interface Lateness {
  p50_s: number;
  p99_s: number;
  max_s: number;
}

/** What the animation costs, as means of the last seconds. */
export interface Animation {
  running_s: number;
  period_s: number;
  tick_s: number;
  carried_times: number | null;
  scenes: { name: string; tick_s: number; share: number }[];
}

export interface Recorder {
  state: "writing" | "retrying" | "hanging" | null;
  written: number;
  waiting: number;
  lost: number;
  recorded_elsewhere: number;
  free_bytes: number | null;
  error: string;
  clock_doubt: string;
}

/** An output of the wind for other programs. */
export interface Feed {
  kind: string;
  name: string;
  target: string;
  sends: string;
  messages: number;
  bytes: number;
  last_sent_age_s: number | null;
  trouble: string;
}

/** Set by hand; null: until somebody ends it. */
export interface Hold {
  left_s: number | null;
}

/** What is set by hand now; null: not set. */
export interface ByHand {
  wind: (Hold & { speed_m_s: number; direction_deg: number }) | null;
  blackout: Hold | null;
  camera: Hold | null;
}

/** How long it still lasts. */
export const left_of = ({ left_s }: Hold, since_s: number) => (left_s === null ? null : Math.max(0, left_s - since_s));

export interface Status {
  verdict: "well" | "attention";
  attention: string[];
  age_s: number;
  address: string;
  software: string;
  tick_rate_hz: number;
  wind: Wind;
  sensors: Sensor[];
  by_hand: ByHand;
  cameras: string[];
  camera: string | null;
  recorder: Recorder | null;
  clients: { connected: number; refused: number; stuck: number; idle: number };
  gust_reach: GustReach;
  late_ticks: number;
  recent_ticks: number;
  recent_skipped_ticks: number;
  io_lateness: Lateness | null;
  tick_lateness: Lateness | null;
  animation: Animation | null;
  feeds: Feed[];
}

export interface Scene {
  name: string;
  kind: string;
  is_shown: boolean;
}

export interface Player {
  sensor: string;
  file: string;
  is_open: boolean;
  position_s: number | null;
  length_s: number | null;
  rate: number | null;
  is_paused: boolean | null;
  is_finished: boolean | null;
  refusal: string;
}

/** A daemon that moves in the same wind, as its leader has heard it. */
export interface FleetNode {
  node: string;
  is_silent: boolean;
  last_word_s: number;
  software: string;
  part: string;
  wind_m_s: number;
  wind_from_deg: number;
  behind_s: number;
  clock_offset_s: number | null;
  attention: string[];
}

/** Of the last minutes, oldest first. */
export interface RecentWind {
  age_s: number[];
  measured_m_s: (number | null)[];
  blended_m_s: number[];
  noise_share: number[];
}

/** Of the recording, in steps of equal length; null: a gap. */
export interface History {
  begin_s: number;
  step_s: number;
  step_count: number;
  files_left_out: number;
  sensors: {
    name: string;
    min_m_s: (number | null)[];
    mean_m_s: (number | null)[];
    max_m_s: (number | null)[];
    direction_deg: (number | null)[];
  }[];
}

/** A file of the daemon's recording. */
export interface Recording {
  name: string;
  bytes: number;
  first_s: number | null;
  last_s: number | null;
  is_written: boolean;
}

/** What `yuragi verify --json` prints. */
export interface Verification {
  is_sound: boolean;
  files: { file: string; damage: string[]; readings: number }[];
  missing: string[];
  gaps: { sensor: string; length_s: number }[];
}

/** A command that the daemon carries out. */
export interface Job {
  id: string;
  kind: string;
  recording: string | null;
  state: "running" | "done" | "failed";
  run_for_s: number;
  message: string;
  result: Verification | CalibrationState | object[] | null;
  file: { path: string; name: string; bytes: number } | null;
}

/** A device that was found; settings: lines of TOML. */
export interface FoundDevice {
  driver: string;
  device: string;
  settings: string | null;
  trouble: string | null;
  remedy: string | null;
}

export interface DriverKey {
  name: string;
  type: "boolean" | "integer" | "number" | "text" | "secret";
  unit: string | null;
  default: number | boolean | string | null;
  min: number | null;
  max: number | null;
  choices: string[] | null;
  help: string;
}

export interface Driver {
  name: string;
  summary: string;
  parameters: DriverKey[];
  device_setup: string | null;
}

/** The values of [look] and of scenes in the file of the page. */
export interface Kept {
  kept: string[];
  can_undo: boolean;
  trouble: string | null;
}

/** A way to calibrate a sensor. */
export interface CalibrationWay {
  calibration: string;
  given: "nothing" | "bearing" | "speed" | "reference";
  duration_s: number;
  preparation: string;
}

export interface CalibratedSensor {
  sensor: string;
  driver: string;
  ways: CalibrationWay[];
}

type CalibrationValues = Record<string, number | string>;

/** A line of `yuragi calibrate --json`. Null: not yet known, or there is nothing to change. */
export interface CalibrationState {
  duration_s: number;
  elapsed_s: number | null;
  readings: { sensor: string; count: number; speed_m_s: number | null; direction_deg: number | null }[];
  notes: string[];
  points: { measured_m_s: number; true_m_s: number }[];
  before: CalibrationValues | null;
  after: CalibrationValues | null;
  effect: { indicated_unit: string; unit: string; rows: { indicated: number; now: number; then: number }[] } | null;
}

/** The sensors that were set up on the page, and those of the configuration that were calibrated there. */
export interface SetUp {
  sensors: string[];
  calibrated: string[];
  can_undo: boolean;
}

export interface Configuration {
  file: string;
  is_valid: boolean;
  findings: string[];
  configuration: object | null;
}

export interface LogLine {
  time_s: number;
  level: string;
  text: string;
}

/** In the type of the parameter; null: left out. */
export type ParameterValue = number | boolean | string | null;

export interface Parameter {
  name: string;
  value: ParameterValue;
  configured: ParameterValue;
  default: ParameterValue;
  unit: string;
  kind: "number" | "whole number" | "true or false" | "text";
  min: number | null;
  max: number | null;
  choices: string[];
  left_out: string;
  change: "at once" | "cross-fade" | "takes a restart" | "takes a reload";
  help: string;
}

/** Of a scene; without a name: of [look]. */
export interface ParameterGroup {
  scene: string;
  kind: string;
  parameters: Parameter[];
}

/** The states of a sensor whose readings make the wind. */
const BELIEVED = ["live", "replayed", "simulated"];

export const is_believed = (sensor: Sensor) => BELIEVED.includes(sensor.state);

/** The sensor that the page speaks of: the most real one that is believed, and of these the first. */
export function leading_sensor(status: Status): Sensor | undefined {
  return status.sensors
    .filter(is_believed)
    .sort((one, other) => BELIEVED.indexOf(one.state) - BELIEVED.indexOf(other.state))[0];
}
