// Sensors are set up here: found, tried, named and added; what was added or calibrated here is removed, and the last change is undone.
import { Change } from "./change";
import { by_id, element, set_text, set_text_in } from "./element";
import { carry_out } from "./job";
import { ask } from "./request";
import { Driver, DriverKey, FoundDevice, Job, Sensor, SetUp } from "./status";
import { DAEMON_LANGUAGE, language, texts } from "./texts";
import { plain_number_text, wind_text, word_of } from "./wording";

const PATH = "/api/v1/sensors";
const PATIENCE_MS = 60_000; // the daemon asks a program of its own for the drivers

type Value = string | number | boolean;

/** A key of a driver with its control; what was not typed is the driver's default. */
interface Key {
  item: HTMLElement;
  set(value: string): void;
  value(): Value | undefined;
}

function limits_of({ min, max }: DriverKey): Record<string, string> {
  return { ...(min !== null && { min: String(min) }), ...(max !== null && { max: String(max) }) };
}

function key_of(key: DriverKey): Key {
  const id = `setup-${key.name}`;
  const about = { id, "aria-describedby": id + "-help" };
  const otherwise = key.default === null ? "" : String(key.default);
  const label = element("label", { for: id, lang: DAEMON_LANGUAGE }, key.name.replace(/_/g, " "), ...(key.unit ? [` (${key.unit})`] : []));
  const limits = key.min !== null && key.max !== null ? [element("span", { class: "age" }, `${plain_number_text(key.min)} … ${plain_number_text(key.max)}`)] : [];
  const help = element("p", { id: id + "-help", class: "reason", lang: DAEMON_LANGUAGE }, key.help);
  const item = (node: HTMLElement) => element("div", { class: "parameter" }, element("div", { class: "line" }, label, ...limits), node, help);
  if (key.type === "boolean") {
    const node = element("input", { ...about, type: "checkbox", role: "switch" });
    node.checked = key.default === true;
    return { item: item(node), set: (value) => (node.checked = value === "true"), value: () => (node.checked === (key.default === true) ? undefined : node.checked) };
  }
  if (key.choices !== null) {
    const node = element("select", about, ...key.choices.map((choice) => element("option", { value: choice, lang: DAEMON_LANGUAGE }, choice)));
    node.value = otherwise;
    return { item: item(node), set: (value) => (node.value = value), value: () => (node.value === otherwise ? undefined : node.value) };
  }
  const is_number = key.type === "number" || key.type === "integer";
  const type = is_number ? "number" : key.type === "secret" ? "password" : "text";
  const node = element("input", { ...about, type, placeholder: otherwise, autocomplete: "off", spellcheck: "false", autocapitalize: "off",
    ...(is_number && { step: key.type === "integer" ? "1" : "any", ...limits_of(key) }) });
  return {
    item: item(node),
    set: (value) => (node.value = value),
    value: () => (node.value === "" ? undefined : is_number ? Number(node.value) : node.value),
  };
}

/** The lines `key = value  # comment` of a found device: texts without their quotes, and numbers. */
function values_in(settings: string): [string, string][] {
  return settings.split("\n").flatMap((line) => {
    const [, key, text, plain] = /^([a-z0-9_]+) = (?:"((?:[^"\\]|\\.)*)"|([^#"]+))/.exec(line) ?? [];
    return key === undefined ? [] : [[key, text?.replace(/\\(["\\])/g, "$1") ?? plain?.trim() ?? ""]];
  });
}

export class SetupView {
  private readonly dialog = by_id("setup") as HTMLDialogElement;
  private readonly found = by_id("setup-found");
  private readonly driver = by_id("setup-driver") as HTMLSelectElement;
  private readonly about = by_id("setup-about");
  private readonly keys_list = by_id("setup-keys");
  private readonly result = by_id("setup-result");
  private readonly error = by_id("setup-error");
  private readonly name = by_id("setup-name") as HTMLInputElement;
  private readonly buttons = ["setup-find", "setup-try", "setup-add"].map((id) => by_id(id) as HTMLButtonElement);
  private readonly undo: HTMLButtonElement;
  private readonly removals = element("div", { class: "buttons" });
  private drivers: Driver[] = [];
  private keys = new Map<string, Key>();

  constructor(place: HTMLElement, private readonly change: Change) {
    const add = element("button", { type: "button" }, texts.add_sensor);
    this.undo = element("button", { type: "button", hidden: "" }, texts.undo_sensors);
    place.append(this.removals, element("div", { class: "buttons" }, add, this.undo));
    add.addEventListener("click", () => void this.open());
    this.undo.addEventListener("click", () => void this.make(PATH + "/undo", {}));
    this.driver.addEventListener("change", () => this.choose(this.driver.value));
    by_id("setup-cancel").addEventListener("click", () => this.dialog.close());
    by_id("setup-find").addEventListener("click", () => void this.busy(() => this.find()));
    by_id("setup-try").addEventListener("click", () => void this.busy(() => this.try()));
    by_id("setup-form").addEventListener("submit", (event) => {
      event.preventDefault();
      void this.busy(() => this.add());
    });
  }

  /** What was set up here; nothing is shown to those who may not change it. */
  async ask_now(): Promise<void> {
    try {
      const { sensors, calibrated, can_undo } = await ask<SetUp>(PATH);
      const removal = (text: string, path: string) => {
        const remove = element("button", { type: "button" }, text);
        remove.addEventListener("click", () => void this.make(path, {}, "DELETE"));
        return remove;
      };
      this.removals.replaceChildren(...sensors.map((name) => removal(texts.remove_sensor(name), `${PATH}/${encodeURIComponent(name)}`)),
        ...calibrated.map((name) => removal(texts.remove_calibration(name), `${PATH}/${encodeURIComponent(name)}/calibration`)));
      this.undo.hidden = !can_undo;
    } catch {
      this.removals.replaceChildren();
      this.undo.hidden = true;
    }
  }

  private async open(): Promise<void> {
    const known = await this.change.with_rights(() => ask<{ drivers: Driver[] }>("/api/v1/drivers", undefined, PATIENCE_MS));
    if (!known) return;
    this.drivers = known.drivers;
    this.driver.replaceChildren(...known.drivers.map(({ name, summary }) => element("option", { value: name, lang: DAEMON_LANGUAGE }, `${name}: ${summary}`)));
    this.found.replaceChildren();
    this.name.value = "";
    this.choose(this.driver.value);
    this.dialog.showModal();
  }

  /** Shows the form of a driver, with these values. */
  private choose(name: string, values: [string, string][] = []): void {
    const driver = this.drivers.find((one) => one.name === name);
    if (!driver) return;
    this.driver.value = name;
    this.keys = new Map(driver.parameters.map((key) => [key.name, key_of(key)]));
    for (const [key, value] of values) this.keys.get(key)?.set(value);
    this.keys_list.replaceChildren(...Array.from(this.keys.values(), ({ item }) => item));
    set_text(this.about, driver.device_setup ?? "");
    this.show("");
  }

  private body(): { driver: string; parameters: Record<string, Value> } {
    const given = Array.from(this.keys, ([name, key]) => [name, key.value()] as const).filter((one): one is readonly [string, Value] => one[1] !== undefined);
    return { driver: this.driver.value, parameters: Object.fromEntries(given) };
  }

  private async find(): Promise<void> {
    const job = await carry_out(this.change, PATH + "/find", (text) => this.show(text), {}, (why) => this.refuse(why));
    if (job?.state === "failed") return this.refuse(job.message);
    if (!job) return;
    this.show("");
    const devices = job.result as unknown as FoundDevice[];
    const items = devices.map(({ driver, device, settings, trouble, remedy }) => {
      const take = element("button", { type: "button", lang: DAEMON_LANGUAGE }, `${device} (${driver})`);
      take.addEventListener("click", () => this.choose(driver, values_in(settings ?? "")));
      return element("li", {}, take, ...(trouble === null ? [] : [element("p", { class: "reason", lang: DAEMON_LANGUAGE }, [trouble, remedy ?? ""].join(texts.between_sentences))]));
    });
    this.found.replaceChildren(...(items.length > 0 ? items : [element("li", { class: "empty" }, texts.nothing_found)]));
  }

  private async try(): Promise<void> {
    const show = (text: string, job?: Job) => this.show(sensor_text(job) ?? text);
    const job = await carry_out(this.change, PATH + "/try", show, this.body(), (why) => this.refuse(why));
    if (job?.state === "failed") this.refuse(job.message);
    if (job?.state === "done") this.show(texts.sensor_works(sensor_text(job) ?? ""));
  }

  private async add(): Promise<void> {
    if (await this.make(PATH, { name: this.name.value, ...this.body() }, "POST", (why) => this.refuse(why))) this.dialog.close();
  }

  private async make(path: string, body: object, method = "POST", refused?: (why: string) => void): Promise<boolean> {
    const done = await this.change.make<{ message: string }>(path, body, refused, method);
    if (done) this.change.tell(DAEMON_LANGUAGE, done.message);
    await this.ask_now();
    return done !== undefined;
  }

  private async busy(act: () => Promise<void>): Promise<void> {
    set_text(this.error, "");
    for (const button of this.buttons) button.disabled = true;
    await act();
    for (const button of this.buttons) button.disabled = false;
  }

  private show(text: string): void {
    set_text_in(language, this.result, text);
    set_text(this.error, "");
  }

  private refuse(why: string): void {
    this.show("");
    set_text_in(DAEMON_LANGUAGE, this.error, why);
  }
}

/** The state of the sensor that is tried: "live: 3.2 m/s from the west". */
function sensor_text(job: Job | undefined): string | undefined {
  const sensor = job && Array.isArray(job.result) ? (job.result[0] as Sensor | undefined) : undefined;
  if (!sensor) return undefined;
  return texts.is_what(word_of(texts.states, sensor.state), sensor.speed_m_s === null ? texts.no_reading : wind_text(sensor.speed_m_s, sensor.direction_deg));
}
