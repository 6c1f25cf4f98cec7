// The daemons that move in one wind, if this one leads: each with its wind, how late it is, and what needs attention.
import { element, Rows, set_text } from "./element";
import { FleetNode } from "./status";
import { DAEMON_LANGUAGE, texts } from "./texts";
import { duration_text, milliseconds_text, wind_text, word_of } from "./wording";

interface Row {
  item: HTMLElement;
  state: HTMLElement;
  wind: HTMLElement;
  age: HTMLElement;
  reason: HTMLElement;
}

function make_row(name: string): { item: HTMLElement; row: Row } {
  const state = element("span", { class: "badge" });
  const wind = element("span");
  const age = element("span", { class: "age" });
  const reason = element("p", { class: "reason", lang: DAEMON_LANGUAGE });
  const item = element("li", {}, element("div", { class: "line" }, element("h3", {}, name), state),
    element("div", { class: "line" }, wind, age), reason);
  return { item, row: { item, state, wind, age, reason } };
}

const state_of = (node: FleetNode) => (node.is_silent ? "silent" : node.attention.length > 0 ? "attention" : "well");

export class FleetView {
  private readonly rows: Rows<Row>;

  constructor(private readonly card: HTMLElement, list: HTMLElement) {
    this.rows = new Rows(list, make_row, texts.none);
  }

  show(nodes: FleetNode[]): void {
    this.card.hidden = nodes.length === 0;
    const rows = this.rows.for_names(nodes.map((node) => node.node));
    nodes.forEach((node, index) => {
      const row = rows[index];
      if (!row) return;
      const state = state_of(node);
      row.item.dataset["state"] = state === "well" ? "live" : state;
      set_text(row.state, word_of(texts.node_states, state));
      row.wind.className = node.is_silent ? "age" : "strong";
      set_text(row.wind, node.is_silent ? "–" : wind_text(node.wind_m_s, node.wind_from_deg));
      set_text(row.age, node.is_silent ? texts.node_heard(texts.ago(duration_text(node.last_word_s)))
        : texts.node_late(milliseconds_text(node.behind_s)) + texts.between + node.software);
      set_text(row.reason, node.is_silent ? "" : [node.part, ...node.attention].join(". ")); // nothing that may no longer be so
    });
  }

  clear(): void {
    this.card.hidden = true;
  }
}
