// /wall: the picture alone, for a screen, a phone or another program's browser source.
//   /wall?camera=dawn&scene=meadow&look=time=21:00&every=2&rate=30&transparent=1&words=0
import { by_id, set_text } from "./element";
import { listen, StreamWish } from "./link";
import { Knowledge, verdict_of } from "./sentence";
import { fill_in_texts, texts } from "./texts";
import { Trouble, Viewer } from "./viewer";

const REDRAW_WORDS_EVERY_MS = 200;
const NEWS_ARE_OLD_AFTER_S = 3;

const query = new URLSearchParams(location.search);
const number_of = (name: string, otherwise: number) => {
  const number = Number(query.get(name) ?? otherwise);
  return Number.isFinite(number) ? number : otherwise;
};
const canvas = by_id("wall") as HTMLCanvasElement;
const has_words = query.get("words") !== "0";
const is_transparent = query.get("transparent") === "1";

let knowledge: Knowledge = { kind: "connecting" };
let heard_ms = 0; // when the last status came, by performance.now()
let heard_at = new Date();
let trouble: Trouble | null = null;
let refusal = ""; // of the stream

function words_of(what: Trouble): string {
  if (what === "no program") return texts.wall_no_program;
  if (what === "no WebGL") return texts.wall_no_webgl;
  if (what === "lost context") return texts.wall_lost_context;
  return what.reason;
}

/** Says why the picture is not that of the wind outside; nothing if it is. */
function show_words(): void {
  if (knowledge.kind === "news") {
    knowledge.age_s = (performance.now() - heard_ms) / 1000;
    if (knowledge.age_s > NEWS_ARE_OLD_AFTER_S) knowledge = { kind: "lost", since: heard_at };
  }
  const verdict = verdict_of(knowledge);
  const is_live = verdict.light === "live" || verdict.light === "attention";
  const text = trouble !== null ? words_of(trouble) : refusal || (is_live ? "" : verdict.text);
  const notice = by_id("notice");
  notice.hidden = text === "" || !has_words;
  set_text(notice, text);
}

const viewer = new Viewer(canvas, {
  camera: query.get("camera") ?? "",
  scene: query.get("scene") ?? "",
  look: query.getAll("look"),
  is_transparent,
}, (what) => {
  trouble = what;
  show_words();
});

function follow_size(): void {
  const scale = window.devicePixelRatio;
  canvas.width = Math.max(1, Math.round(canvas.clientWidth * scale));
  canvas.height = Math.max(1, Math.round(canvas.clientHeight * scale));
}

function draw(): void {
  requestAnimationFrame(draw); // never while the page is hidden
  viewer.draw();
}

const wish: StreamWish = { sensors: true, every: Math.max(1, Math.round(number_of("every", 1))), rate: Math.max(0, number_of("rate", 0)) };
const scene = query.get("scene");
if (scene) wish.scenes = [scene];

fill_in_texts();
document.documentElement.classList.toggle("transparent", is_transparent);
new ResizeObserver(follow_size).observe(canvas);
follow_size();
setInterval(show_words, REDRAW_WORDS_EVERY_MS);
requestAnimationFrame(draw);
void listen({
  news(status) {
    heard_ms = performance.now();
    heard_at = new Date();
    knowledge = { kind: "news", status, age_s: 0 };
    show_words();
  },
  refused(refusal) {
    knowledge = { kind: "refused", needs_pairing: refusal.status === 401, why: refusal.message };
    show_words();
  },
  lost() {
    if (knowledge.kind !== "lost") knowledge = { kind: "lost", since: heard_at };
    show_words();
  },
}, {
  wish,
  begin: () => viewer.open(),
  take(message) {
    refusal = "";
    return viewer.take(message);
  },
  refused(why) {
    refusal = why;
    show_words();
  },
});

// For tests, and people who look.
Object.assign(window, { wall: { get pictures() { return viewer.pictures; }, get pace() { return viewer.pace; } } });
