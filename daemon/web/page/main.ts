// The page: the daemon's state goes into the views; a clock keeps ages correct between two states.
import { ArchiveView } from "./archive_view";
import { CalibrationView } from "./calibration_view";
import { CameraView } from "./camera_view";
import { Change } from "./change";
import { by_id, element, set_text } from "./element";
import { FleetView } from "./fleet_view";
import { HandView } from "./hand_view";
import { HealthView } from "./health_view";
import { HistoryView } from "./history_view";
import { listen } from "./link";
import { LogView } from "./log_view";
import { LookView } from "./look_view";
import { Pairing } from "./pairing";
import { PlayersView } from "./players_view";
import { ask } from "./request";
import { ScenesView } from "./scenes_view";
import { Knowledge, verdict_of } from "./sentence";
import { SensorsView } from "./sensors_view";
import { SetupView } from "./setup_view";
import { FleetNode, Player, Scene, Status } from "./status";
import { SupportView } from "./support_view";
import { DAEMON_LANGUAGE, fill_in_texts, offer_languages, texts } from "./texts";
import { WindView } from "./wind_view";

const REDRAW_EVERY_MS = 200;
const ASK_FOR_LISTS_EVERY_MS = 2000;
const NEWS_ARE_OLD_AFTER_S = 3;

fill_in_texts();
offer_languages(by_id("language") as HTMLSelectElement);

const pairing = new Pairing();
const change = new Change(pairing);
const wind = new WindView(by_id("wind"));
const sensors = new SensorsView(by_id("sensors"));
const setup = new SetupView(by_id("setup-place"), change);
new CalibrationView(by_id("setup-place"), change, () => void setup.ask_now());
const scenes = new ScenesView(by_id("scenes"), change);
const players = new PlayersView(by_id("recordings-card"), by_id("recordings"), change);
const fleet = new FleetView(by_id("fleet-card"), by_id("fleet"));
const history = new HistoryView(by_id("history"));
const log = new LogView(by_id("log") as HTMLDetailsElement, by_id("log-note"), by_id("log-lines"));
const archive = new ArchiveView(by_id("archive") as HTMLDetailsElement, by_id("archive-note"), by_id("archive-list"), change);
const support = new SupportView(by_id("support") as HTMLDetailsElement, change);
const hand = new HandView(by_id("hand"), change);
const camera = new CameraView(by_id("look"), change);
const look = new LookView(by_id("look") as HTMLDetailsElement, change);
const health = new HealthView(by_id("health"));

let knowledge: Knowledge = { kind: "connecting" };
let heard_ms = 0; // when the last status came, by performance.now()
let heard_at = new Date();

/** Of the last status, since it came. */
const since_s = () => (performance.now() - heard_ms) / 1000;

function show_attention(items: string[]): void {
  const list = by_id("attention");
  const text = items.join("\n");
  if (list.dataset["items"] === text) return;
  list.dataset["items"] = text;
  list.replaceChildren(...items.map((item) => element("li", { lang: DAEMON_LANGUAGE }, item)));
  list.hidden = items.length === 0;
}

function show_verdict(): void {
  const verdict = verdict_of(knowledge);
  by_id("verdict").dataset["light"] = verdict.light;
  set_text(by_id("sentence"), verdict.text);
  set_text(by_id("announcement"), verdict.announcement);
  by_id("unpaired").hidden = !(knowledge.kind === "refused" && knowledge.needs_pairing);
  const title = texts.titles[verdict.light];
  if (document.title !== `${title} – Yuragi`) document.title = `${title} – Yuragi`;
}

/** The previous state is no longer valid. */
function forget(what: Knowledge): void {
  if (knowledge.kind === "news") {
    wind.clear();
    sensors.clear(heard_at);
    scenes.clear();
    players.clear();
    fleet.clear();
    health.clear();
    look.clear();
    hand.clear();
    camera.clear();
    show_attention([]);
  }
  knowledge = what;
  show_verdict();
}

const lost = () => {
  if (knowledge.kind !== "lost") forget({ kind: "lost", since: heard_at });
};

function redraw(): void {
  if (knowledge.kind !== "news") return;
  if (since_s() > NEWS_ARE_OLD_AFTER_S) return lost();
  knowledge.age_s = since_s();
  sensors.show(knowledge.status, knowledge.age_s);
  hand.show(knowledge.status.by_hand, knowledge.status.age_s + knowledge.age_s);
  show_verdict();
}

async function ask_for_lists(): Promise<void> {
  if (knowledge.kind !== "news") return;
  try {
    const shown = await ask<{ scenes: Scene[] }>("/api/v1/scenes");
    const playing = await ask<{ players: Player[] }>("/api/v1/player");
    const walls = await ask<{ nodes: FleetNode[] }>("/api/v1/fleet");
    if (knowledge.kind !== "news") return;
    scenes.show(shown.scenes);
    players.show(playing.players);
    fleet.show(walls.nodes);
  } catch {
    // The link shows what is wrong.
  }
}

async function keep_lists(): Promise<never> {
  for (;;) {
    await ask_for_lists();
    await new Promise((resolve) => setTimeout(resolve, ASK_FOR_LISTS_EVERY_MS));
  }
}

by_id("pair-now").addEventListener("click", () => void pairing.open());
document.addEventListener("visibilitychange", redraw); // timers rest while nobody looks
setInterval(redraw, REDRAW_EVERY_MS);

void listen({
  news(status: Status) {
    const is_back = knowledge.kind !== "news";
    heard_ms = performance.now();
    heard_at = new Date();
    knowledge = { kind: "news", status, age_s: 0 };
    by_id("cards").hidden = false;
    wind.show(status);
    health.show(status);
    camera.show(status);
    history.show(status.recorder !== null);
    show_attention(status.attention);
    set_text(by_id("host"), location.host);
    redraw();
    if (is_back) {
      void ask_for_lists();
      void wind.fill();
      void setup.ask_now();
      history.ask_now();
      log.ask_now();
      archive.ask_now();
      support.ask_now();
      look.ask_now();
    }
  },
  refused(refusal) {
    forget({ kind: "refused", needs_pairing: refusal.status === 401, why: refusal.message });
  },
  lost,
});
void keep_lists();
