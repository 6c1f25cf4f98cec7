// Which camera all viewers show: that of the time of day, or one that somebody chose.
import { Change } from "./change";
import { element } from "./element";
import { Status } from "./status";
import { texts } from "./texts";

const BY_TIME = "";

export class CameraView {
  private readonly select = element("select", { id: "camera" });
  private readonly line = element("p", { class: "line", hidden: "" }, element("label", { for: "camera" }, texts.camera), this.select);
  private names = "";
  private is_busy = false; // a change is on its way: earlier states of the daemon are outdated

  constructor(place: HTMLElement, private readonly change: Change) {
    place.append(this.line);
    this.select.addEventListener("change", () => void this.choose());
  }

  show({ cameras, camera, by_hand }: Status): void {
    this.line.hidden = cameras.length === 0;
    if (this.is_busy) return;
    this.select.disabled = false;
    const names = JSON.stringify(cameras);
    if (names !== this.names) {
      this.names = names;
      this.select.replaceChildren(element("option", { value: BY_TIME }, texts.camera_of_time),
        ...cameras.map((name) => element("option", { value: name }, name)));
    }
    if (document.activeElement !== this.select) this.select.value = by_hand.camera === null ? BY_TIME : camera ?? BY_TIME;
  }

  clear(): void {
    this.select.disabled = true;
  }

  private async choose(): Promise<void> {
    this.is_busy = true;
    const camera = this.select.value;
    await this.change.make("/api/v1/camera", camera === BY_TIME ? { release: true } : { camera, for_s: null });
    this.is_busy = false;
    this.select.blur(); // the next state shows what was done
  }
}
