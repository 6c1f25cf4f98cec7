// A wind rose: how often the wind came from each of 16 directions, as petals on a dial.
import { dial_parts, DIAL } from "./compass";
import { svg } from "./element";

const SECTORS = 16;
const LONGEST = 66; // within the letters of the dial
const HALF_WIDTH_RAD = (0.42 * 2 * Math.PI) / SECTORS;

/** How many of the directions are in each sector, the first one around north; empty without a direction. */
function counts_of(directions_deg: (number | null)[], sectors: number): number[] {
  const counts = Array.from({ length: sectors }, () => 0);
  for (const direction_deg of directions_deg) {
    if (direction_deg === null) continue;
    const sector = Math.round((direction_deg * sectors) / 360) % sectors;
    counts[sector] = (counts[sector] ?? 0) + 1;
  }
  return counts.some((count) => count > 0) ? counts : [];
}

/** The middle of the most frequent of 8 sectors; undefined without a direction. */
export function most_frequent_deg(directions_deg: (number | null)[]): number | undefined {
  const counts = counts_of(directions_deg, 8);
  return counts.length === 0 ? undefined : counts.indexOf(Math.max(...counts)) * 45;
}

export class Rose {
  private readonly petals = svg("g");
  readonly dial = svg("svg", { ...DIAL, class: "rose" }, ...dial_parts(), this.petals);

  /** `color_index`: of the sensor, as in the legend. Hidden without a direction. */
  show(directions_deg: (number | null)[], color_index: string): void {
    const counts = counts_of(directions_deg, SECTORS);
    this.dial.toggleAttribute("hidden", counts.length === 0);
    this.dial.setAttribute("data-color", color_index);
    const most = Math.max(...counts);
    this.petals.replaceChildren(...counts.map((count, sector) => {
      const length = (LONGEST * count) / most;
      const x = length * Math.sin(HALF_WIDTH_RAD);
      const y = -length * Math.cos(HALF_WIDTH_RAD);
      return svg("path", { class: "petal", d: `M0 0L${-x} ${y}A${length} ${length} 0 0 1 ${x} ${y}Z`, transform: `rotate(${(sector * 360) / SECTORS})` });
    }));
  }
}
