// The values of [look] and of the scenes, for those who may change them: while they are visible, they follow the daemon. They last until the
// configuration is read again, unless they are kept.
import { Change } from "./change";
import { element, set_text } from "./element";
import { ParameterRow } from "./parameter_row";
import { ask } from "./request";
import { Kept, Parameter, ParameterGroup, ParameterValue } from "./status";
import { DAEMON_LANGUAGE, texts } from "./texts";

const PATH = "/api/v1/parameters";
const KEPT_PATH = "/api/v1/kept";
const ASK_EVERY_MS = 2000;
/** Values that a request cannot change take a restart or a reload: they are not shown. */
const CHANGEABLE = ["at once", "cross-fade"];

/** A value that was changed here, and its value before. */
interface Step {
  scene: string;
  row: ParameterRow;
  before: ParameterValue;
}

/** Values that differ from those that are read at the next start, by the scene's name; empty: of [look]. */
type Different = Map<string, Record<string, ParameterValue>>;

const is_changeable = (parameter: Parameter) => CHANGEABLE.includes(parameter.change);

function different_of(groups: ParameterGroup[]): Different {
  const all = groups.map(({ scene, parameters }) => [scene, parameters.filter((one) => is_changeable(one) && one.value !== null && one.value !== one.configured)] as const);
  return new Map(all.filter(([, parameters]) => parameters.length > 0).map(([scene, parameters]) => [scene, Object.fromEntries(parameters.map(({ name, value }) => [name, value]))]));
}

/** null: the configuration's value again. */
const order_of = (scene: string, key: string, value: ParameterValue) => ({ scene, ...(value === null ? { reset: [key] } : { set: { [key]: value } }) });

export class LookView {
  private readonly all = element("fieldset", { disabled: "" });
  private readonly keep = element("button", { type: "button", hidden: "" }, texts.keep);
  private readonly back = element("button", { type: "button", hidden: "" }, texts.back_to_configuration);
  private readonly undo_kept = element("button", { type: "button", hidden: "" }, texts.undo_kept);
  private readonly groups = element("div");
  private readonly undo = element("button", { type: "button", disabled: "" }, texts.undo);
  private rows = new Map<string, ParameterRow>();
  private steps: Step[] = [];
  private shape = "";
  private changes = 0; // answers from before the last change are outdated
  private different: Different = new Map();
  private is_any_kept = false;

  constructor(private readonly details: HTMLDetailsElement, private readonly change: Change) {
    this.all.append(element("legend", { class: "unseen" }, texts.look), element("p", { class: "empty" }, texts.look_lasts), this.undo,
      element("div", { class: "buttons" }, this.keep, this.back, this.undo_kept), this.groups);
    details.append(this.all);
    this.undo.addEventListener("click", () => void this.take_back());
    this.keep.addEventListener("click", () => void this.change_kept(KEPT_PATH, this.kept_body()));
    this.back.addEventListener("click", () => void this.change_kept(KEPT_PATH, {}, "DELETE"));
    this.undo_kept.addEventListener("click", () => void this.change_kept(KEPT_PATH + "/undo", {}));
    details.addEventListener("toggle", () => {
      this.ask_now();
      if (details.open) void this.load_kept();
    });
    setInterval(() => this.ask_now(), ASK_EVERY_MS);
  }

  ask_now(): void {
    if (this.details.open) void this.load();
  }

  clear(): void {
    this.all.disabled = true;
  }

  private async load(): Promise<void> {
    const changes = this.changes;
    try {
      const { parameters } = await ask<{ parameters: ParameterGroup[] }>(PATH);
      if (changes !== this.changes) return;
      this.show(parameters);
      this.all.disabled = false;
    } catch {
      // The link shows what is wrong.
    }
  }

  /** Only those who may change the kept values are shown them. */
  private async load_kept(): Promise<void> {
    try {
      const { kept, can_undo } = await ask<Kept>(KEPT_PATH);
      this.is_any_kept = kept.length > 0;
      this.undo_kept.hidden = !can_undo;
    } catch {
      this.is_any_kept = false;
      this.undo_kept.hidden = true;
    }
    this.show_buttons();
  }

  private show_buttons(): void {
    this.keep.hidden = this.different.size === 0;
    this.back.hidden = this.keep.hidden && !this.is_any_kept;
  }

  private kept_body(): object {
    const scenes = [...this.different].filter(([scene]) => scene !== "");
    return { look: this.different.get("") ?? {}, scenes: Object.fromEntries(scenes) };
  }

  /** The daemon then reads its configuration again: what was set before is no longer to be undone one by one. */
  private async change_kept(path: string, body: object, method = "POST"): Promise<void> {
    this.changes++;
    const done = await this.change.make<{ message: string }>(path, body, undefined, method);
    this.changes++;
    if (done) {
      this.show_steps([]);
      this.change.tell(DAEMON_LANGUAGE, done.message);
    }
    void this.load();
    void this.load_kept();
  }

  private show(groups: ParameterGroup[]): void {
    this.different = different_of(groups);
    this.show_buttons();
    const shape = JSON.stringify(groups.map((group) => [group.scene, group.kind, group.parameters.map((parameter) => parameter.name)]));
    if (shape !== this.shape) {
      this.shape = shape;
      this.rows.clear();
      this.show_steps([]);
      this.groups.replaceChildren(...groups.map((group) => this.make_group(group)));
    }
    for (const { scene, parameters } of groups) {
      for (const { name, value } of parameters) this.rows.get(JSON.stringify([scene, name]))?.show(value);
    }
  }

  private make_group({ scene, kind, parameters }: ParameterGroup): HTMLElement {
    const rows = parameters.filter(is_changeable).map((parameter) => {
      const row = new ParameterRow(parameter, (row, value, before) => this.set(scene, row, value, before));
      this.rows.set(JSON.stringify([scene, parameter.name]), row);
      return row.item;
    });
    const title = scene === "" ? [texts.look_of_all] : [scene, ...(kind === scene ? [] : [" ", element("span", { class: "age", lang: DAEMON_LANGUAGE }, kind)])];
    return element("details", { class: "group" }, element("summary", {}, element("h3", {}, ...title)), element("ul", { class: "parameters" }, ...rows));
  }

  private async set(scene: string, row: ParameterRow, value: ParameterValue, before: ParameterValue): Promise<boolean> {
    const is_set = await this.order(row, order_of(scene, row.key, value));
    if (is_set) this.show_steps([...this.steps, { scene, row, before }]);
    return is_set;
  }

  private async take_back(): Promise<void> {
    const step = this.steps[this.steps.length - 1];
    if (step && (await this.order(step.row, order_of(step.scene, step.row.key, step.before)))) {
      this.show_steps(this.steps.filter((other) => other !== step));
    }
  }

  private async order(row: ParameterRow, order: object): Promise<boolean> {
    this.changes++;
    row.refuse("");
    const answer = await this.change.make(PATH, order, (reason) => row.refuse(reason));
    this.changes++;
    void this.load();
    return answer !== undefined;
  }

  private show_steps(steps: Step[]): void {
    this.steps = steps;
    const last = steps[steps.length - 1];
    this.undo.disabled = last === undefined;
    set_text(this.undo, last ? texts.undo_of(last.row.name) : texts.undo);
  }
}
