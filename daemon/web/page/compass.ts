// Where the wind comes from: an arrow that blows across a dial, north on top.
import { svg } from "./element";
import { texts } from "./texts";

const CARDINAL_RADIUS = 80;

/** An arrow that turns the shorter way. */
class Needle {
  private turned_deg = 0;

  constructor(readonly shape: SVGElement) {}

  point(direction_deg: number | null): void {
    this.shape.style.visibility = direction_deg === null ? "hidden" : "visible";
    if (direction_deg === null) return;
    this.turned_deg += ((((direction_deg - this.turned_deg + 180) % 360) + 360) % 360) - 180;
    this.shape.style.transform = `rotate(${this.turned_deg}deg)`;
  }
}

/** Rim, ticks and letters, of a radius of 98. */
export function dial_parts(): SVGElement[] {
  const ticks = Array.from({ length: 36 }, (_, index) =>
    svg("path", { class: index % 9 === 0 ? "tick main" : "tick", d: "M0-92v-6", transform: `rotate(${index * 10})` }),
  );
  const letters = texts.compass.map((point, index) => {
    const angle = (index * Math.PI) / 2;
    const x = CARDINAL_RADIUS * Math.sin(angle);
    const y = -CARDINAL_RADIUS * Math.cos(angle);
    return svg("text", { x, y, class: "point" }, point);
  });
  return [svg("circle", { r: 98, class: "rim" }), ...ticks, ...letters];
}

export const DIAL = { viewBox: "-108 -108 216 216", "aria-hidden": "true" };

export class Compass {
  readonly dial: SVGElement;
  private readonly measured: Needle;
  private readonly blended: Needle;

  constructor() {
    this.measured = new Needle(svg("path", { class: "needle measured", d: "M0-92l6-12h-12z" }));
    this.blended = new Needle(svg("path", { class: "needle blended", d: "M0 62l-17-32h11v-84h12v84h11z" }));
    this.dial = svg("svg", { ...DIAL, class: "compass" }, ...dial_parts(), this.blended.shape, this.measured.shape);
  }

  show(measured_deg: number | null, blended_deg: number | null): void {
    this.measured.point(measured_deg);
    this.blended.point(blended_deg);
  }
}
