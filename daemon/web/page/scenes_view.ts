// The scenes, each with a switch that shows or hides it, and a button for all of them.
import { Change } from "./change";
import { element, Rows, set_text } from "./element";
import { Scene } from "./status";
import { texts } from "./texts";

interface Row {
  control: HTMLInputElement;
  kind: HTMLElement;
}

export class ScenesView {
  private readonly rows: Rows<Row>;
  private readonly fade = element("select", { id: "fade" },
    ...Object.entries(texts.fades).map(([value, text]) => element("option", { value }, text)));
  private readonly all = element("fieldset");
  private readonly every = element("button", { type: "button", class: "every" });
  private scenes: Scene[] = [];
  private is_busy = false; // a change is on its way: earlier states of the daemon are outdated

  constructor(place: HTMLElement, private readonly change: Change) {
    const list = element("ul", { class: "rows" });
    this.rows = new Rows(list, (name) => this.make_row(name), texts.no_scene);
    this.fade.value = "2";
    this.all.append(element("legend", { class: "unseen" }, texts.show_or_hide), list,
      element("p", { class: "line fade" }, element("label", { for: "fade" }, texts.scenes_change), this.fade), this.every);
    this.every.addEventListener("click", () => void this.show_or_hide_all());
    place.append(this.all);
  }

  show(scenes: Scene[]): void {
    if (this.is_busy) return;
    this.scenes = scenes;
    this.all.disabled = false;
    this.every.hidden = scenes.length < 2;
    set_text(this.every, this.is_any_shown() ? texts.hide_all : texts.show_all);
    const rows = this.rows.for_names(scenes.map((scene) => scene.name));
    scenes.forEach((scene, index) => {
      const row = rows[index];
      if (!row) return;
      row.control.checked = scene.is_shown;
      row.kind.textContent = scene.kind === scene.name ? "" : scene.kind;
    });
  }

  clear(): void {
    this.all.disabled = true;
  }

  private make_row(name: string): { item: HTMLElement; row: Row } {
    const control = element("input", { type: "checkbox", role: "switch" });
    const kind = element("span", { class: "age" });
    control.addEventListener("change", () => void this.show_or_hide(name, control));
    const item = element("li", {},
      element("label", { class: "line" }, element("span", { class: "strong" }, name), kind, control));
    return { item, row: { control, kind } };
  }

  private is_any_shown(): boolean {
    return this.scenes.some((scene) => scene.is_shown);
  }

  private async show_or_hide(scene: string, control: HTMLInputElement): Promise<void> {
    const shown = control.checked;
    if (!(await this.order([scene], shown))) control.checked = !shown;
  }

  private async show_or_hide_all(): Promise<void> {
    const shown = !this.is_any_shown();
    await this.order(this.scenes.filter((scene) => scene.is_shown !== shown).map((scene) => scene.name), shown);
  }

  /** One order after the other; false from the first that is not carried out. */
  private async order(names: string[], shown: boolean): Promise<boolean> {
    this.is_busy = true;
    let now: Scene[] | undefined;
    let is_done = true;
    for (const scene of names) {
      const answer = await this.change.make<{ scenes: Scene[] }>("/api/v1/scenes", { scene, shown, over_s: Number(this.fade.value) });
      is_done = answer !== undefined;
      if (!answer) break;
      now = answer.scenes;
    }
    this.is_busy = false;
    if (now) this.show(now);
    return is_done;
  }
}
