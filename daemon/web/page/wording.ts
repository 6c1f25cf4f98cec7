// Numbers as people read them, in their language.
import { language, texts } from "./texts";

const FORMATS = [0, 1, 2].map((digits) =>
  new Intl.NumberFormat(language, { minimumFractionDigits: digits, maximumFractionDigits: digits }));
const PLAIN = new Intl.NumberFormat(language);

/** With 0, 1 or 2 digits behind the point: "3.2", "3,2" */
export function number_text(number: number, digits: 0 | 1 | 2): string {
  return (FORMATS[digits] ?? PLAIN).format(number);
}

/** With as many digits as it takes: "0.25", "1,234" */
export const plain_number_text = (number: number) => PLAIN.format(number);

/** "from the south-west" */
export function from_text(direction_deg: number): string {
  return texts.from[Math.round(direction_deg / 45) & 7] ?? "";
}

/** "3.2 m/s from the south-west"; "calm" */
export function wind_text(speed_m_s: number | null, direction_deg: number | null): string {
  if (speed_m_s === null) return texts.no_speed;
  if (speed_m_s < 0.05) return texts.calm;
  const speed = number_text(speed_m_s, 1) + " m/s";
  return direction_deg === null ? speed : texts.speed_from(speed, from_text(direction_deg));
}

/** "0.1 s", "12 s", "3 min", "5 h" */
export function duration_text(duration_s: number): string {
  if (duration_s < 9.95) return texts.seconds(number_text(Math.max(0, duration_s), 1));
  if (duration_s < 119.5) return texts.seconds(number_text(duration_s, 0));
  if (duration_s < 7170) return texts.minutes(number_text(duration_s / 60, 0));
  return texts.hours(number_text(duration_s / 3600, 0));
}

/** "42 s left", "until somebody ends it" */
export function left_text(left_s: number | null): string {
  if (left_s === null) return texts.until_ended;
  return texts.left(left_s < 119.5 ? texts.seconds(number_text(Math.ceil(left_s), 0)) : duration_text(left_s));
}

/** A place in a recording: "1:02:03" */
export function place_text(place_s: number): string {
  const whole = Math.floor(Math.max(0, place_s));
  const two = (number: number) => String(number).padStart(2, "0");
  const minutes = Math.floor(whole / 60) % 60;
  const hours = Math.floor(whole / 3600);
  return (hours > 0 ? hours + ":" + two(minutes) : String(minutes)) + ":" + two(whole % 60);
}

/** "14:03:12" of the clock here, in each language */
export function clock_text(time: Date): string {
  return time.toLocaleTimeString("en-GB", { hour12: false });
}

/** "23 Nov 2026, 14:03" of the calendar and clock here */
export function date_text(time_s: number): string {
  return new Date(1000 * time_s).toLocaleString(language, { dateStyle: "medium", timeStyle: "short" });
}

/** "1.5 ms"; with two digits behind the point: "1.50 ms" */
export function milliseconds_text(duration_s: number, digits: 0 | 1 | 2 = duration_s < 0.01 ? 1 : 0): string {
  return number_text(duration_s * 1e3, digits) + " ms";
}

/** "56 kB", "12.3 GB" */
export function bytes_text(bytes: number): string {
  if (bytes < 1e6) return number_text(bytes / 1e3, 0) + " kB";
  if (bytes < 1e9) return number_text(bytes / 1e6, 0) + " MB";
  return number_text(bytes / 1e9, bytes < 1e11 ? 1 : 0) + " GB";
}

/** The language's word for a word of the daemon; one that is not known stays. */
export function word_of(words: Record<string, string>, word: string): string {
  return words[word] ?? word;
}
