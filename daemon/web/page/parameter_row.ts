// One value of [look] or of a scene: its control by its kind, its help, and why a new value was refused.
import { element, set_text } from "./element";
import { Parameter, ParameterValue } from "./status";
import { DAEMON_LANGUAGE, texts } from "./texts";
import { plain_number_text } from "./wording";

const SEND_AFTER_MS = 250; // of rest: a key that is held, or a slider that is dragged, is one change
const WIDE = 1000; // a slider would be too coarse for a range as wide
const LEAST_STEPS = 200;
const UNKNOWN = "–";

let made = 0;

/** 1, 2 or 5 times a power of ten: about 200 to a range. */
function step_of(range: number): number {
  const rough = range / LEAST_STEPS;
  const power = 10 ** Math.floor(Math.log10(rough));
  return power * ([1, 2, 5].find((factor) => factor * power >= rough) ?? 10);
}

/** An input and its value in the daemon's type. */
interface Control {
  node: HTMLInputElement | HTMLSelectElement;
  show(value: ParameterValue): void;
  value(): ParameterValue;
}

/** `otherwise`: where it stands while the value is left out. */
function slider(min: number, max: number, otherwise: number, is_whole: boolean): Control {
  const step = is_whole ? 1 : step_of(max - min);
  const on_step = (number: number, round: (number: number) => number) => String(Number((round(number / step) * step).toPrecision(6)));
  const node = element("input", { type: "range", step: String(step), min: on_step(min, Math.floor), max: on_step(max, Math.ceil) });
  return {
    node,
    show: (value) => (node.value = String(value ?? otherwise)),
    value: () => Math.min(max, Math.max(min, Number(node.value))),
  };
}

function number_field(parameter: Parameter): Control {
  const limits = { ...(parameter.min !== null && { min: String(parameter.min) }), ...(parameter.max !== null && { max: String(parameter.max) }) };
  const node = element("input", { type: "number", step: parameter.kind === "whole number" ? "1" : "any", ...limits });
  return { node, show: (value) => (node.value = String(value ?? "")), value: () => (node.value === "" ? null : Number(node.value)) };
}

function text_field(): Control {
  const node = element("input", { type: "text", lang: DAEMON_LANGUAGE, spellcheck: "false", autocapitalize: "off" });
  return { node, show: (value) => (node.value = String(value ?? "")), value: () => node.value || null };
}

function choice(choices: string[], may_be_left_out: boolean): Control {
  const options = [...(may_be_left_out ? [element("option", { value: "" }, UNKNOWN)] : []),
    ...choices.map((value) => element("option", { value, lang: DAEMON_LANGUAGE }, value))];
  const node = element("select", {}, ...options);
  return { node, show: (value) => (node.value = String(value ?? "")), value: () => node.value || null };
}

function switch_of(): Control {
  const node = element("input", { type: "checkbox", role: "switch" });
  return { node, show: (value) => (node.checked = value === true), value: () => node.checked };
}

function control_of(parameter: Parameter): Control {
  const { kind, min, max, choices } = parameter;
  if (kind === "true or false") return switch_of();
  if (kind === "text") return choices.length > 0 ? choice(choices, parameter.default === null) : text_field();
  if (min !== null && max !== null && max - min <= WIDE) {
    const in_effect = parseFloat(parameter.left_out); // "35.68, Tokyo"
    return slider(min, max, Number.isNaN(in_effect) ? min : in_effect, kind === "whole number");
  }
  return number_field(parameter);
}

/** Sends a value that somebody chose; false if it was not set. */
type Send = (row: ParameterRow, value: ParameterValue, before: ParameterValue) => Promise<boolean>;

export class ParameterRow {
  readonly item: HTMLElement;
  private readonly control: Control;
  private readonly output: HTMLOutputElement | undefined; // of a slider
  private readonly error = element("p", { class: "error", role: "alert", lang: DAEMON_LANGUAGE });
  private shown: ParameterValue = null; // the daemon's
  private is_touched = false; // what is in the control is not yet the daemon's
  private is_sending = false;
  private due: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly parameter: Parameter, private readonly send: Send) {
    const id = `parameter-${made++}`;
    this.control = control_of(parameter);
    const { node } = this.control;
    node.id = id;
    node.setAttribute("aria-describedby", `${id}-help ${id}-error`);
    this.error.id = id + "-error";
    if (node.type === "range") this.output = element("output", { for: id, class: "strong" });
    const label = element("label", { for: id, lang: DAEMON_LANGUAGE }, this.name, ...(this.output || !this.unit ? [] : [` (${this.unit.trim()})`]));
    const left_out = parameter.left_out === "" ? [] : [texts.between_sentences, texts.left_out, " ", element("span", { lang: DAEMON_LANGUAGE }, parameter.left_out)];
    const help = element("p", { id: id + "-help", class: "reason" }, element("span", { lang: DAEMON_LANGUAGE }, parameter.help), ...left_out);
    const head = element("div", { class: "line" }, label, ...(this.output ? [this.output] : node.type === "checkbox" ? [node] : []));
    this.item = element("li", { class: "parameter" }, head, ...(node.type === "checkbox" ? [] : [node]), this.error, help);
    node.addEventListener("input", () => this.touch());
    node.addEventListener("change", () => this.settle());
    node.addEventListener("blur", () => this.leave());
  }

  /** For people: "sun height" */
  get name(): string {
    return this.parameter.name.replace(/_/g, " ");
  }

  get key(): string {
    return this.parameter.name;
  }

  /** Shows the daemon's value, unless another one is being entered. */
  show(value: ParameterValue): void {
    this.shown = value;
    if (!this.is_touched) this.show_shown();
  }

  refuse(reason: string): void {
    set_text(this.error, reason);
  }

  /** Behind a number: "°", " m/s" */
  private get unit(): string {
    const { unit } = this.parameter;
    return unit === "deg" ? "°" : unit && " " + unit;
  }

  private show_shown(): void {
    this.control.show(this.shown);
    this.show_output(this.shown);
  }

  private show_output(value: ParameterValue): void {
    if (!this.output) return;
    const text = typeof value === "number" ? plain_number_text(value) + this.unit : UNKNOWN;
    set_text(this.output, text);
    this.control.node.setAttribute("aria-valuetext", text);
  }

  private touch(): void {
    this.is_touched = true;
    this.show_output(this.control.value());
  }

  private settle(): void {
    this.is_touched = true;
    clearTimeout(this.due);
    this.due = setTimeout(() => void this.hand_over(), SEND_AFTER_MS);
  }

  /** What was typed, and taken back again, is no change. */
  private leave(): void {
    if (this.due !== undefined || this.is_sending) return;
    this.is_touched = false;
    this.show_shown();
  }

  private async hand_over(): Promise<void> {
    if (this.is_sending) return this.settle();
    this.due = undefined;
    this.is_sending = true;
    const value = this.control.value();
    const before = this.shown;
    const is_set = await this.send(this, value, before);
    this.is_sending = false;
    if (this.due !== undefined) return; // moved on meanwhile
    this.is_touched = false;
    if (is_set && value !== null) this.shown = value;
    this.show_shown();
  }
}
