// What is set by hand for a time: the wind of the scenes, and a blackout. Stop is the way back.
import { Change } from "./change";
import { Compass } from "./compass";
import { element, set_text } from "./element";
import { ByHand, left_of } from "./status";
import { texts } from "./texts";
import { from_text, left_text, plain_number_text } from "./wording";

const MOST_M_S = "30";
const UNTIL_ENDED = "null";

interface Slider {
  box: HTMLElement;
  node: HTMLInputElement;
}

/** `text`: of its value, for people. */
function slider(id: string, name: string, value: string, limits: { max: string; step: string }, text: (value: number) => string): Slider {
  const node = element("input", { type: "range", id, min: "0", ...limits, value });
  const output = element("output", { for: id, class: "strong" });
  const show = () => {
    set_text(output, text(Number(node.value)));
    node.setAttribute("aria-valuetext", text(Number(node.value)));
  };
  node.addEventListener("input", show);
  show();
  return { box: element("div", { class: "parameter" }, element("div", { class: "line" }, element("label", { for: id }, name), output), node), node };
}

/** How long, in seconds. */
function time_select(id: string, times: Record<string, string>): HTMLSelectElement {
  return element("select", { id }, ...Object.entries(times).map(([value, text]) => element("option", { value }, text)));
}

export class HandView {
  private readonly all = element("fieldset");
  private readonly compass = new Compass();
  private readonly speed = slider("hand-speed", texts.hand_speed, "8", { max: MOST_M_S, step: "0.5" }, (value) => plain_number_text(value) + " m/s");
  private readonly direction = slider("hand-direction", texts.hand_direction, "270", { max: "355", step: "5" },
    (value) => `${plain_number_text(value)}°${texts.between}${from_text(value)}`);
  private readonly time = time_select("hand-time", texts.hand_times);
  private readonly dark_time = time_select("dark-time", { ...texts.dark_times, [UNTIL_ENDED]: texts.until_ended });
  private readonly stop = element("button", { type: "button" }, texts.hand_stop);
  private readonly light = element("button", { type: "button" }, texts.dark_stop);
  private readonly wind_note = element("p", { class: "reason" });
  private readonly dark_note = element("p", { class: "reason" });

  constructor(place: HTMLElement, private readonly change: Change) {
    const button = (text: string, path: string, order: () => object) => {
      const made = element("button", { type: "button", class: "primary" }, text);
      made.addEventListener("click", () => void this.post(path, order()));
      return made;
    };
    const start = button(texts.hand_start, "/api/v1/hand",
      () => ({ speed_m_s: Number(this.speed.node.value), direction_deg: Number(this.direction.node.value), for_s: Number(this.time.value) }));
    const dark = button(texts.dark_start, "/api/v1/blackout",
      () => ({ for_s: this.dark_time.value === UNTIL_ENDED ? null : Number(this.dark_time.value) }));
    this.stop.addEventListener("click", () => void this.post("/api/v1/hand", { release: true }));
    this.light.addEventListener("click", () => void this.post("/api/v1/blackout", { release: true }));
    this.direction.node.addEventListener("input", () => this.point());
    this.time.value = "60";
    this.dark_time.value = "3600";
    this.point();
    const line = (id: string, name: string, select: HTMLSelectElement) =>
      element("p", { class: "line" }, element("label", { for: id }, name), select);
    this.all.append(element("legend", { class: "unseen" }, texts.by_hand),
      element("div", { class: "hand" }, this.compass.dial, element("div", {}, this.speed.box, this.direction.box)),
      line("hand-time", texts.hand_time, this.time), element("div", { class: "buttons" }, start, this.stop), this.wind_note,
      line("dark-time", texts.dark_time, this.dark_time), element("div", { class: "buttons" }, dark, this.light), this.dark_note);
    place.append(this.all);
  }

  /** `since_s`: how old it is. */
  show({ wind, blackout }: ByHand, since_s: number): void {
    this.all.disabled = false;
    this.stop.disabled = wind === null;
    this.light.disabled = blackout === null;
    set_text(this.wind_note, wind === null ? texts.hand_off : left_text(left_of(wind, since_s)));
    set_text(this.dark_note, blackout === null ? texts.dark_off : left_text(left_of(blackout, since_s)));
  }

  clear(): void {
    this.all.disabled = true;
    for (const note of [this.wind_note, this.dark_note]) set_text(note, "");
  }

  private point(): void {
    this.compass.show(null, Number(this.direction.node.value));
  }

  private async post(path: string, order: object): Promise<void> {
    const answer = await this.change.make<{ by_hand: ByHand }>(path, order);
    if (answer) this.show(answer.by_hand, 0);
  }
}
