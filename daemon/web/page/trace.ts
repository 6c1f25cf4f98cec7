// The last minutes of the wind as lines: measured, as it is blended, and the share of noise in it.
import { RecentWind } from "./status";
import { color, root_px } from "./style";
import { texts } from "./texts";
import uPlot from "./vendor/uplot/uPlot.esm.js";
import { plain_number_text } from "./wording";

const LENGTH_S = 180;
const LEAST_LENGTH_S = 30; // while there is little to show
const HEIGHT_REM = 12;
const LEAST_SCALE_M_S = 2;

export class Trace {
  readonly place = document.createElement("div");
  private plot: uPlot | undefined;
  private readonly times_s: number[] = [];
  private readonly measured: (number | null)[] = [];
  private readonly blended: (number | null)[] = [];
  private readonly noise: (number | null)[] = [];

  constructor() {
    this.place.className = "trace";
    this.place.setAttribute("role", "img");
    this.place.setAttribute("aria-label", texts.trace);
    new ResizeObserver(() => this.resize()).observe(this.place);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw_anew());
  }

  /** Puts the wind that the daemon remembers in place of what is shown of the same time, or was missed. */
  fill(past: RecentWind, now_s: number): void {
    const times_s = past.age_s.map((age_s) => now_s - age_s);
    const begin_s = times_s[0];
    if (begin_s === undefined) return;
    const kept = this.times_s.findIndex((time_s) => time_s >= begin_s);
    const before = kept < 0 ? this.times_s.length : kept;
    this.times_s.splice(before, Infinity, ...times_s);
    this.measured.splice(before, Infinity, ...past.measured_m_s);
    this.blended.splice(before, Infinity, ...past.blended_m_s);
    this.noise.splice(before, Infinity, ...past.noise_share.map((share) => 100 * share));
    this.draw();
  }

  /** Values at a time in s since 1970; null leaves a gap. */
  add(time_s: number, measured_m_s: number | null, blended_m_s: number | null, noise: number | null): void {
    this.times_s.push(time_s);
    this.measured.push(measured_m_s);
    this.blended.push(blended_m_s);
    this.noise.push(noise === null ? null : 100 * noise);
    while ((this.times_s[0] ?? time_s) < time_s - LENGTH_S) {
      for (const values of [this.times_s, this.measured, this.blended, this.noise]) values.shift();
    }
    this.draw();
  }

  /** Ends the lines: what follows is unknown. */
  interrupt(time_s: number): void {
    if (this.blended.length > 0 && this.blended[this.blended.length - 1] !== null) this.add(time_s, null, null, null);
  }

  private data(): uPlot.AlignedData {
    return [this.times_s, this.noise, this.blended, this.measured];
  }

  /** The first and the last moment that are shown. */
  private span_s(): [number, number] {
    const last_s = this.times_s[this.times_s.length - 1] ?? Date.now() / 1000;
    return [Math.min(this.times_s[0] ?? last_s, last_s - LEAST_LENGTH_S), last_s];
  }

  private draw(): void {
    if (this.plot) this.plot.setData(this.data());
    else if (this.place.clientWidth > 0) this.plot = new uPlot(this.options(), this.data(), this.place);
  }

  private draw_anew(): void {
    this.plot?.destroy();
    this.plot = undefined;
    this.draw();
  }

  private resize(): void {
    if (this.plot && this.place.clientWidth > 0) {
      if (this.plot.width !== this.place.clientWidth) this.draw_anew();
    } else {
      this.draw();
    }
  }

  private options(): uPlot.Options {
    const rem = root_px();
    const font = `${Math.round(0.75 * rem)}px system-ui, sans-serif`;
    const grid = { stroke: color("--line"), width: 1 };
    const axis = { stroke: color("--muted"), font, ticks: { show: false } };
    const clock = new Intl.DateTimeFormat("en-GB", { hour: "2-digit", minute: "2-digit", second: "2-digit" });
    const line = { width: 2, points: { show: false } };
    return {
      width: this.place.clientWidth,
      height: HEIGHT_REM * rem,
      padding: [0.6 * rem, 0, 0, 0],
      legend: { show: false },
      cursor: { show: false },
      scales: {
        x: { time: true, range: () => this.span_s() },
        speed: { range: (_plot, _least, most) => [0, Math.max(LEAST_SCALE_M_S, 1.15 * (most ?? 0))] },
        share: { range: [0, 100] },
      },
      axes: [
        { ...axis, grid: { show: false }, space: 6 * rem, size: 1.8 * rem, gap: 0.5 * rem,
          values: (_plot, splits) => splits.map((time_s) => clock.format(new Date(1000 * time_s))) },
        { ...axis, scale: "speed", grid, size: 1.9 * rem, gap: 0.3 * rem, space: 2.4 * rem,
          values: (_plot, splits) => splits.map(plain_number_text) },
        { ...axis, scale: "share", side: 1, grid: { show: false }, size: 2.9 * rem, gap: 0.3 * rem, space: 3.5 * rem,
          values: (_plot, splits) => splits.map((share) => share + " %") },
      ],
      series: [
        {},
        { ...line, scale: "share", width: 0, fill: color("--noise") },
        { ...line, scale: "speed", stroke: color("--blended") },
        { ...line, scale: "speed", stroke: color("--measured"), width: 1.5 },
      ],
    };
  }
}
