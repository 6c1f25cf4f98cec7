// Values of the style sheet, for canvases, which have none.

/** The value of a variable: "#67d3c8". */
export function color(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** The length of 1 rem. */
export const root_px = () => parseFloat(getComputedStyle(document.documentElement).fontSize);
