// The recordings that sensors play: where they are, and their buttons.
import { Change } from "./change";
import { element, Rows, set_text } from "./element";
import { Player } from "./status";
import { texts } from "./texts";
import { place_text, plain_number_text } from "./wording";

const RATES = ["0.5", "1", "2", "10", "60"];

const rate_option = (value: string) => element("option", { value }, plain_number_text(Number(value)) + " ×");

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
    this.rows = new Rows(list, (sensor) => this.make_row(sensor), texts.none);
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
      const state = player.refusal ? player.refusal : !player.is_open ? texts.not_open : player.is_finished ? texts.at_end : player.is_paused ? texts.paused : "";
      set_text(row.place, texts.place_of(place_text(position_s), place_text(length_s)) + (state && texts.between + state));
      row.progress.max = Math.max(length_s, 1);
      row.progress.value = position_s;
      row.pause.dataset["action"] = player.is_paused ? "resume" : "pause";
      set_text(row.pause, player.is_paused ? texts.resume : texts.pause);
      if (player.rate !== null && document.activeElement !== row.rate) this.show_rate(row.rate, String(player.rate));
    });
  }

  clear(): void {
    this.card.hidden = true;
  }

  private show_rate(select: HTMLSelectElement, rate: string): void {
    const is_there = Array.from(select.options).some((option) => option.value === rate);
    if (!is_there) select.append(rate_option(rate));
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
    const progress = element("progress", { "aria-label": texts.place_in(sensor) });
    const pause = button(texts.pause, "", () => ({ action: pause.dataset["action"] ?? "pause" }));
    const rate = element("select", { "aria-label": texts.rate }, ...RATES.map(rate_option));
    rate.addEventListener("change", () => void post({ action: "rate", rate: Number(rate.value) }));
    const controls = element("fieldset", { class: "buttons" }, element("legend", { class: "unseen" }, texts.play(sensor)),
      button("−" + texts.seconds("30"), texts.back, () => ({ action: "seek", place: "-30" })), pause,
      button("+" + texts.seconds("30"), texts.forward, () => ({ action: "seek", place: "+30" })), rate);
    const item = element("li", {}, element("div", { class: "line" }, element("h3", {}, sensor), file), progress, place, controls);
    return { item, row: { item, file, place, progress, pause, rate, controls } };
  }
}
