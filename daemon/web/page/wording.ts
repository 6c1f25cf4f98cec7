// Numbers as people read them.

const POINTS = ["north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west"];

/** "from the south-west" */
export function from_text(direction_deg: number): string {
  return "from the " + POINTS[Math.round(direction_deg / 45) & 7];
}

/** "3.2 m/s from the south-west"; "calm" */
export function wind_text(speed_m_s: number | null, direction_deg: number | null): string {
  if (speed_m_s === null) return "no speed";
  if (speed_m_s < 0.05) return "calm";
  const speed = speed_m_s.toFixed(1) + " m/s";
  return direction_deg === null ? speed : speed + " " + from_text(direction_deg);
}

/** "0.1 s", "12 s", "3 min", "5 h" */
export function duration_text(duration_s: number): string {
  if (duration_s < 9.95) return Math.max(0, duration_s).toFixed(1) + " s";
  if (duration_s < 119.5) return duration_s.toFixed(0) + " s";
  if (duration_s < 7170) return (duration_s / 60).toFixed(0) + " min";
  return (duration_s / 3600).toFixed(0) + " h";
}

/** A place in a recording: "1:02:03" */
export function place_text(place_s: number): string {
  const whole = Math.floor(Math.max(0, place_s));
  const two = (number: number) => String(number).padStart(2, "0");
  const minutes = Math.floor(whole / 60) % 60;
  const hours = Math.floor(whole / 3600);
  return (hours > 0 ? hours + ":" + two(minutes) : String(minutes)) + ":" + two(whole % 60);
}

/** "14:03:12" of the clock here */
export function clock_text(time: Date): string {
  return time.toLocaleTimeString("en-GB", { hour12: false });
}

/** "1.5 ms"; with more digits behind the point: "1.50 ms" */
export function milliseconds_text(duration_s: number, digits = duration_s < 0.01 ? 1 : 0): string {
  return (duration_s * 1e3).toFixed(digits) + " ms";
}

/** "12.3 GB" */
export function bytes_text(bytes: number): string {
  if (bytes < 1e9) return (bytes / 1e6).toFixed(0) + " MB";
  return (bytes / 1e9).toFixed(bytes < 1e11 ? 1 : 0) + " GB";
}
