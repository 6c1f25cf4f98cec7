// The recordings that sensors play: where they are, and their buttons.
import { Change } from "./change";
import { element, Rows, set_text } from "./element";
import { Player } from "./status";
import { place_text } from "./wording";

const RATES = ["0.5", "1", "2", "10", "60"];

interface Row {
  item: HTMLElement;
  file: HTMLElement;
  place: HTMLElement;
  progress: HTMLProgressElement;
  pause: HTMLButtonElement;
  rate: HTMLSelectElement;
  controls: HTMLFieldSetElement;
}

export class PlayersView {
  private readonly rows: Rows<Row>;

  constructor(
    private readonly card: HTMLElement,
    list: HTMLElement,
    private readonly change: Change,
  ) {
    this.rows = new Rows(list, (sensor) => this.make_row(sensor), "None.");
  }

  show(players: Player[]): void {
    this.card.hidden = players.length === 0;
    const rows = this.rows.for_names(players.map((player) => player.sensor));
    players.forEach((player, index) => {
      const row = rows[index];
      if (!row) return;
      row.controls.disabled = !player.is_open;
      set_text(row.file, player.file.split("/").pop() ?? player.file);
      const position_s = player.position_s ?? 0;
      const length_s = player.length_s ?? 0;
      const state = player.refusal ? player.refusal : !player.is_open ? "not open" : player.is_finished ? "at its end" : player.is_paused ? "paused" : "";
      set_text(row.place, `${place_text(position_s)} of ${place_text(length_s)}${state ? ", " + state : ""}`);
      row.progress.max = Math.max(length_s, 1);
      row.progress.value = position_s;
      row.pause.dataset["action"] = player.is_paused ? "resume" : "pause";
      set_text(row.pause, player.is_paused ? "Resume" : "Pause");
      if (player.rate !== null && document.activeElement !== row.rate) this.show_rate(row.rate, String(player.rate));
    });
  }

  clear(): void {
    this.card.hidden = true;
  }

  private show_rate(select: HTMLSelectElement, rate: string): void {
    const is_there = Array.from(select.options).some((option) => option.value === rate);
    if (!is_there) select.append(element("option", { value: rate }, rate + " ×"));
    select.value = rate;
  }

  private make_row(sensor: string): { item: HTMLElement; row: Row } {
    const post = async (order: object) => {
      const answer = await this.change.make<{ players: Player[] }>("/api/v1/player", { sensor, ...order });
      if (answer) this.show(answer.players);
    };
    const button = (text: string, label: string, order: () => object) => {
      const made = element("button", { type: "button", ...(label && { "aria-label": label }) }, text);
      made.addEventListener("click", () => void post(order()));
      return made;
    };
    const file = element("span", { class: "age" });
    const place = element("p", { class: "reason" });
    const progress = element("progress", { "aria-label": `Place in the recording of ${sensor}` });
    const pause = button("Pause", "", () => ({ action: pause.dataset["action"] ?? "pause" }));
    const rate = element("select", { "aria-label": "Rate" }, ...RATES.map((value) => element("option", { value }, value + " ×")));
    rate.addEventListener("change", () => void post({ action: "rate", rate: Number(rate.value) }));
    const controls = element("fieldset", { class: "buttons" }, element("legend", { class: "unseen" }, `Play ${sensor}`),
      button("−30 s", "Back by 30 seconds", () => ({ action: "seek", place: "-30" })), pause,
      button("+30 s", "Forward by 30 seconds", () => ({ action: "seek", place: "+30" })), rate);
    const item = element("li", {}, element("div", { class: "line" }, element("h3", {}, sensor), file), progress, place, controls);
    return { item, row: { item, file, place, progress, pause, rate, controls } };
  }
}
