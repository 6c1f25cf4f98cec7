// The scenes, each with a switch that shows or hides it.
import { Change } from "./change";
import { element, Rows } from "./element";
import { Scene } from "./status";

const FADES_S: [string, string][] = [["0", "at once"], ["2", "in 2 s"], ["10", "in 10 s"], ["60", "in a minute"]];

interface Row {
  control: HTMLInputElement;
  kind: HTMLElement;
}

export class ScenesView {
  private readonly rows: Rows<Row>;
  private readonly fade = element("select", { id: "fade" },
    ...FADES_S.map(([value, text]) => element("option", { value }, text)));
  private readonly all = element("fieldset");
  private is_busy = false; // a change is on its way: what the daemon said before it is old

  constructor(place: HTMLElement, private readonly change: Change) {
    const list = element("ul", { class: "rows" });
    this.rows = new Rows(list, (name) => this.make_row(name), "No scene is configured.");
    this.fade.value = "2";
    this.all.append(element("legend", { class: "unseen" }, "Show or hide scenes"), list,
      element("p", { class: "line fade" }, element("label", { for: "fade" }, "Scenes change"), this.fade));
    place.append(this.all);
  }

  show(scenes: Scene[]): void {
    if (this.is_busy) return;
    this.all.disabled = false;
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

  private async show_or_hide(scene: string, control: HTMLInputElement): Promise<void> {
    const shown = control.checked;
    this.is_busy = true;
    const answer = await this.change.make<{ scenes: Scene[] }>("/api/v1/scenes", { scene, shown, over_s: Number(this.fade.value) });
    this.is_busy = false;
    if (answer) this.show(answer.scenes);
    else control.checked = !shown;
  }
}
