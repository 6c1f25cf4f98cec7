// The daemon's page in a real browser. Each test waits for what the page shows; HANG_MS is reached only by what hangs.
// usage: page_test.py
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import http from "node:http";
import { createRequire } from "node:module";
import path from "node:path";
import { after, before, test } from "node:test";

import { begin, HANG_MS } from "./chromium.mjs";

const [chromiumPath, programs, tools, screenshots, ...ports] = process.argv.slice(2);
const [httpPort, sensorPort, pairingPort, readingPort, playerPort, recordingPort, archivePort, setupPort, calibrationPort, keepPort] = ports;
const require = createRequire(path.join(tools, "package.json"));

const HOSTILE = `<img src=x onerror="document.title='owned'">`;
const SCENES = `
[[scene]]
name = "meadow"
kind = "grass"
blades_across = 20
blades_deep = 20
[[scene]]
name = "lawn"
kind = "grass"
blades_across = 20
blades_deep = 20
[[camera]]
name = "gate"
scene = "meadow"
[[camera]]
name = "pond"
scene = "lawn"
`;
const PAUSE_MS = 50; // between two looks
let world;

const start = (...args) => world.start(...args);
const kill = (child) => world.kill(child);
/** For tests of what a large screen shows. The others have a small one, which software draws in less time. */
const WIDE = { width: 1920, height: 1080 };
const open = (url, options = {}) => world.open(url, { viewport: { width: 800, height: 600 }, ...options });
const configured = (name, text) => world.file(name, text + SCENES);
const startDaemon = (file) => start("yuragi", ["run", "--config", file, "--listen", "127.0.0.1:0"], /answering at/);
const startSensor = () => start("yuragi-sim", ["nmea", "--tcp", `127.0.0.1:${sensorPort}`, "--rate", "5"], /listening|127\.0\.0\.1/);

const sentence = (page) => page.textContent("#sentence");
const waitForSentence = (page, pattern) =>
  page.waitForFunction((source) => new RegExp(source).test(document.getElementById("sentence").textContent), pattern.source, { polling: PAUSE_MS });
const assertAccessible = async (page, what) => assert.deepEqual(await world.accessibilityFaults(page), [], what);
/** Waits until the daemon is so. */
async function waitFor(holds) {
  for (const hangs = Date.now() + HANG_MS; !(await holds()); await new Promise((resolve) => setTimeout(resolve, PAUSE_MS))) assert.ok(Date.now() < hangs, String(holds));
}
const screenshot = (page, name) => page.screenshot({ path: path.join(screenshots, name + ".png"), fullPage: true });

const LIVE = /^Live: roof, (\d+\.\d m\/s from the [a-z-]+|calm), \d+(\.\d)? s old$/;
let config, daemon, sensor, url;

before(async () => {
  fs.mkdirSync(screenshots, { recursive: true });
  world = await begin({ chromiumPath, programs, tools });
  config = configured("live.toml", `
[http]
listen = "127.0.0.1:${httpPort}"
[[sensor]]
name = "roof"
driver = "nmea"
transport = "tcp"
host = "127.0.0.1"
port = ${sensorPort}
`);
  url = `http://127.0.0.1:${httpPort}/`;
  sensor = await startSensor();
  daemon = await startDaemon(config);
});
after(() => world?.end());

test("it needs nothing but the daemon, and says nothing on the console", { timeout: 2 * HANG_MS }, async () => {
  for (const [colorScheme, width] of [["light", 320], ["dark", 1920]]) {
    const page = await open(url, { colorScheme, viewport: { width, height: 800 } });
    await waitForSentence(page, LIVE);
    await page.waitForSelector("#scenes [role=switch]");
    await page.waitForSelector(".trace canvas");
    assert.match(await page.title(), /^Live(, with faults)? – Yuragi$/); // faults: ticks are late where the machine has much to do
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= width, "wider than the screen");
    await assertAccessible(page, colorScheme);
    await screenshot(page, `live-${width}-${colorScheme}`);
    assert.deepEqual(page.complaints, []);
    await page.context().close();
  }
});

test("recorded wind: what to do where nothing is recorded; a day and a year of what is", { timeout: 2 * HANG_MS }, async () => {
  const page = await open(url, { viewport: WIDE });
  await page.waitForSelector("#history .empty:text('[recording] file')");
  assert.deepEqual(page.complaints, []);
  const row = (values) => Array.from({ length: 481 }, (_, step) => (step > 100 && step < 160 ? null : values(step)));
  const roof = { name: HOSTILE, min_m_s: row(() => 1), mean_m_s: row((step) => 3 + Math.sin(step / 30)), max_m_s: row(() => 6), direction_deg: row(() => 220) };
  const mast = { ...roof, name: "mast", mean_m_s: row(() => 2) };
  const history = { begin_s: 1_780_000_000, step_s: 180, step_count: 481, files_left_out: 0, sensors: [roof, mast] };
  let asked = 0;
  await page.route("**/api/v1/history?hours=24", (route) =>
    asked++ === 0 ? route.fulfill({ status: 503, json: { detail: "busy" } }) : route.fulfill({ json: history }));
  const status = await (await fetch(url + "api/v1/status")).json();
  const recorder = { state: "writing", written: 1, waiting: 0, lost: 0, recorded_elsewhere: 0, free_bytes: null, error: "", clock_doubt: "" };
  await page.route("**/api/v1/status", (route) => route.fulfill({ json: { ...status, recorder } }));
  await page.route("**/api/v1/openapi.json", (route) => route.fulfill({ json: { paths: {} } })); // without a WebSocket, which has the real state
  await page.reload();
  await page.waitForSelector("#history canvas");
  assert.ok(asked >= 2, "a daemon that is busy is asked again");
  const legend = () => page.$$eval("#history .legend li", (all) => all.map((one) => one.textContent));
  assert.match((await legend())[0], /^<img .*> mean 3\.\d m\/s, largest 6\.0 m\/s \(.*\), mostly from the south-west, no readings in 12 % of the time$/);
  assert.match((await legend())[1], /^mast mean 2\.0 m\/s, /);
  assert.match(await page.getAttribute("#history .history", "aria-label"), /24 hours: .*mast/);
  await assertAccessible(page, "24 hours");
  await screenshot(page, "24-hours-1920-light");

  const days = (values) => Array.from({ length: 367 }, (_, day) => (day < 40 || (day > 150 && day < 165) || day === 200 || day === 202 ? null : values(day)));
  const storm = (day) => 4 + 2 * Math.cos(day / 58) + 1.5 * Math.sin(day * day);
  const tower = { name: "tower", min_m_s: days(() => 0.2), mean_m_s: days(storm), max_m_s: days((day) => 2.5 * storm(day) + (day === 300 ? 9 : 0)),
    direction_deg: days((day) => (day % 3 === 0 ? 290 : 215 + (day % 11))) };
  const year = { begin_s: 1_750_032_000, step_s: 86_400, step_count: 367, files_left_out: 1, sensors: [tower] };
  let askedOfYear = 0;
  await page.route("**/api/v1/history?hours=8784", (route) =>
    askedOfYear++ === 0 ? route.fulfill({ status: 503, json: { detail: "busy" } }) : route.fulfill({ json: year }));
  await page.click("#history [data-length=year]");
  await page.waitForSelector("#history .empty:text('Still being read')");
  await page.waitForSelector("#history .legend .strong:text('tower')");
  assert.ok(askedOfYear >= 2, "a daemon that is busy is asked again");
  assert.deepEqual(await page.$$eval("#history [aria-pressed=true]", (all) => all.map((one) => one.textContent)), ["12 months"]);
  assert.match((await legend())[0], /^tower mean \d\.\d m\/s, largest \d+\.\d m\/s \(.*20\d\d\), mostly from the south-west, no readings in 15 % of the time$/);
  assert.match(await page.getAttribute("#history .history", "aria-label"), /12 months: tower/);
  await page.waitForSelector("#history .rose .petal", { state: "attached" });
  await page.waitForSelector("#history .empty:text('Damaged files of the recording, which are left out: 1')");
  for (const [colorScheme, width] of [["light", 1400], ["dark", 1400], ["light", 390], ["dark", 390], ["light", 320]]) {
    await page.emulateMedia({ colorScheme });
    await page.setViewportSize({ width, height: 900 });
    await page.waitForFunction(() => document.querySelector("#history canvas").clientWidth <= document.querySelector("#history .history").clientWidth);
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= width, "wider than the screen");
    await assertAccessible(page, `a year, ${width}, ${colorScheme}`);
    await screenshot(page, `year-${width}-${colorScheme}`);
  }
  await page.click("#history [data-length=day]");
  await page.waitForSelector("#history .legend .strong:text('mast')");
  await page.context().close();
});

test("24 hours of a daemon that records, and its log", { timeout: 2 * HANG_MS }, async () => {
  await startDaemon(configured("recorded.toml", `
[http]
listen = "127.0.0.1:${recordingPort}"
[recording]
file = "${path.join(world.folder, "wall.windlog")}"
[[sensor]]
name = "wall"
driver = "synthetic"
`));
  const base = `http://127.0.0.1:${recordingPort}/`;
  const page = await open(base, { viewport: { width: 320, height: 800 }, colorScheme: "dark" });
  await page.waitForSelector("#history canvas, #history .empty:text('Nothing was recorded')");
  assert.equal(await page.isVisible("#log-lines"), false);
  await page.click("#log summary");
  await page.waitForSelector("#log-lines li:text('recording to')");
  const line = { time_s: 1_780_000_000.5, level: "warning", text: HOSTILE };
  await page.route("**/api/v1/log?lines=200", (route) => route.fulfill({ json: { lines: [{ ...line, level: "info" }, line] } }));
  await page.waitForSelector("#log-lines li.serious");
  assert.deepEqual(await page.$$eval("#log-lines li", (all) => all.map((one) => one.className)), ["", "serious"]);
  assert.ok((await page.textContent("#log-lines li.serious")).endsWith(`warning ${HOSTILE}`));
  assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 320, "wider than the screen");
  await assertAccessible(page, "log");
  await screenshot(page, "log-320-dark");
  assert.deepEqual(page.complaints.filter((complaint) => !complaint.includes("503")), []); // where the machine has much to do
  await page.context().close();

  const elsewhere = await open(base, { extraHTTPHeaders: { "X-Forwarded-For": "192.0.2.7" } });
  await elsewhere.click("#log summary");
  await elsewhere.waitForSelector("#log-note:text('paired')");
  await elsewhere.context().close();
});

/** The file that a button lets the browser store. */
async function downloaded(page, button) {
  const [download] = await Promise.all([page.waitForEvent("download", { timeout: HANG_MS }), page.getByRole("button", { name: button, exact: true }).click()]);
  return { name: download.suggestedFilename(), bytes: fs.readFileSync(await download.path()) };
}
/** Imports a recording of so many seconds at 1 Hz. */
function importRecording(file, seconds) {
  const table = path.join(world.folder, "wind.csv");
  const rows = Array.from({ length: seconds }, (_, i) => `2026-01-01T00:${String(Math.floor(i / 60)).padStart(2, "0")}:${String(i % 60).padStart(2, "0")}Z,3.${i % 10},200`);
  fs.writeFileSync(table, ["time,speed,direction", ...rows, ""].join("\n"));
  execFileSync(path.join(programs, "yuragi"), ["import", table, "-o", file]);
}

test("recordings are downloaded, verified and reported, and a support bundle is made", { timeout: 4 * HANG_MS }, async () => {
  const archive = path.join(world.folder, "archive");
  fs.mkdirSync(archive);
  const completed = "wall-20260101T000000Z.windlog";
  importRecording(path.join(archive, completed), 600);
  const recording = await startDaemon(configured("archive.toml", `
[http]
listen = "127.0.0.1:${archivePort}"
[recording]
file = "${path.join(archive, "wall.windlog")}"
[[sensor]]
name = "wall"
driver = "synthetic"
`));
  const base = `http://127.0.0.1:${archivePort}/`;
  const page = await open(base, { viewport: { width: 320, height: 800 }, colorScheme: "dark" });
  await page.click("#archive > summary");
  await page.waitForSelector("#archive-list li:nth-child(2)");
  assert.deepEqual(await page.$$eval("#archive-list h3", (all) => all.map((one) => one.textContent)), ["wall.windlog", completed]);
  assert.match(await page.textContent("#archive-list li:nth-child(1) .reason"), /, being written$/);
  assert.match(await page.textContent("#archive-list li:nth-child(2) .reason"), /^\d+ kB, .* to .*2026/);

  const copy = await downloaded(page, "Download: wall.windlog");
  assert.equal(copy.name, "wall.windlog");
  assert.equal(copy.bytes.subarray(0, 15).toString(), "SQLite format 3");
  const file = await downloaded(page, "Download: " + completed);
  assert.equal(file.name, completed);
  assert.ok(file.bytes.equals(fs.readFileSync(path.join(archive, completed))));

  await page.getByRole("button", { name: "Verify: " + completed }).click();
  await page.waitForSelector("#archive-list li:nth-child(2) .sound:text('Sound. Readings: 600, files: 1, gaps: 0')");
  const [job] = await Promise.all([page.waitForResponse((response) => response.url().endsWith("/report")),
    page.getByRole("button", { name: "Report: " + completed }).click()]);
  assert.equal(job.status(), 202);
  await page.waitForSelector("#archive-list li:nth-child(2) .result a");
  const [report] = await Promise.all([page.context().waitForEvent("page"), page.click("#archive-list li:nth-child(2) .result a")]);
  await report.waitForSelector("svg, img");
  assert.match(await report.textContent("body"), /600 in 1 session/);
  assert.equal(await report.evaluate(() => window.origin), "null", "a report has no rights of the page");
  await report.close();
  const verification = { is_sound: false, files: [{ file: "wall.windlog", damage: [HOSTILE], readings: 1 }], missing: ["gone.windlog"], gaps: [] };
  await page.route("**/verify", (route) => route.fulfill({ status: 202, json: { id: "1", state: "done", message: "", result: verification, file: null, run_for_s: 1 } }));
  await page.getByRole("button", { name: "Verify: " + completed }).click();
  await page.waitForSelector("#archive-list .error:text('Damaged')");
  assert.deepEqual(await page.$$eval("#archive-list .result li", (all) => all.map((one) => one.textContent)), [`wall.windlog: ${HOSTILE}`, "gone.windlog: missing"]);
  assert.equal(await isWider(page, 320), false);
  await assertAccessible(page, "recordings");
  await screenshot(page, "recordings-320-dark");

  await page.click("#support > summary");
  await page.waitForSelector("#support .configuration div");
  const shown = () => page.$$eval("#support .configuration > div:not([hidden])", (all) => all.map((one) => one.textContent));
  assert.ok((await shown()).includes("sensors.wall.driversynthetic"), (await shown()).join());
  await page.fill("#configuration-filter", "http.LISTEN");
  assert.deepEqual(await shown(), [`http.listen127.0.0.1:${archivePort}`]);
  const bundle = await downloaded(page, "Make a support bundle");
  assert.equal(bundle.name, "yuragi-support.tar.gz");
  assert.deepEqual([...bundle.bytes.subarray(0, 2)], [0x1f, 0x8b]);
  await page.fill("#configuration-filter", "");
  assert.equal(await isWider(page, 320), false);
  await assertAccessible(page, "support");
  await screenshot(page, "support-320-dark");
  assert.deepEqual(page.complaints.filter((complaint) => !complaint.includes("503")), []); // where the machine has much to do
  await page.context().close();

  const elsewhere = await open(base, { extraHTTPHeaders: { "X-Forwarded-For": "192.0.2.7" } });
  await elsewhere.click("#archive > summary");
  await elsewhere.waitForSelector("#archive-note:text('paired')");
  await elsewhere.click("#support > summary");
  await elsewhere.waitForSelector("#support .empty:text('paired')");
  await elsewhere.context().close();
  await kill(recording);
});

test("the keyboard shows and hides a scene", { timeout: 2 * HANG_MS }, async () => {
  const page = await open(url);
  const meadow = page.getByRole("switch", { name: /meadow/ });
  await meadow.waitFor();
  await page.selectOption("#fade", "0");
  await meadow.focus();
  const [answer] = await Promise.all([page.waitForResponse((response) => response.request().method() === "POST"), page.keyboard.press("Space")]);
  assert.equal((await answer.json()).scenes[0].is_shown, false);
  await page.waitForFunction(() => !document.querySelector("#scenes [role=switch]").checked);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("one button hides all scenes, and shows them again", { timeout: 2 * HANG_MS }, async () => {
  const page = await open(url);
  await page.getByRole("switch", { name: /lawn/ }).waitFor();
  await page.selectOption("#fade", "0");
  /** The button's word follows the first scene, the other one may come later. */
  const waitForAll = (checked) => page.waitForFunction((checked) =>
    [...document.querySelectorAll("#scenes [role=switch]")].every((one) => one.checked === checked), checked);
  await page.getByRole("button", { name: "Hide all" }).click();
  await page.getByRole("button", { name: "Show all" }).waitFor();
  await waitForAll(false);
  await page.getByRole("button", { name: "Show all" }).click();
  await page.getByRole("button", { name: "Hide all" }).waitFor();
  await waitForAll(true);
  await page.context().close();
});

/** The sentence of a live sensor in each language, and the texts of ours that are the same as in English. */
const LANGUAGES = [
  { locale: "en-GB", live: LIVE, same: [] },
  { locale: "de-AT", live: /^Live: roof, (\d+,\d m\/s aus [A-Z][a-zü]+|windstill), vor \d+(,\d)? s$/, same: ["Wind", "Code", "in 2 s", "in 10 s", "Sensor"] },
  { locale: "fr-FR", live: /^En direct\u00a0: roof, (\d+,\d m\/s (du|de l’)\s?[a-z-]+|calme), il y a \d+(,\d)? s$/, same: ["Code"] },
  { locale: "ja-JP", live: /^実測中：roof、([東西南北]+の風 \d+\.\d m\/s|無風)、\d+(\.\d)? 秒前$/, same: [] },
];
/** One of them, whose page axe looks at besides the English one: all have the same parts. */
const AXE_LOCALE = "ja-JP";
/** Texts of ours that do not change while the page is open. */
const ownTexts = (page) => page.evaluate(() => [
  ...[...document.querySelectorAll("[data-text]:not(#sentence), dt, legend, #look button, #look .empty, #look > .line label, #support h3, #support button, #support .empty, #support label, #hand label, #hand option, #hand button, #scenes .fade label, #fade option, .every")].map((one) => one.textContent),
  ...[...document.querySelectorAll("[data-label], .trace")].map((one) => one.ariaLabel),
]);
const isWider = (page, width) => page.evaluate((width) => document.documentElement.scrollWidth > width, width);

/** Opens the card with the values of [look], and of the first scene. */
async function openLook(page) {
  await page.click("#look > summary");
  await page.click("#look .group:nth-child(1) summary");
  await page.click("#look .group:nth-child(2) summary");
  await page.waitForSelector("#look fieldset:enabled");
}
/** The value that the daemon has; without a scene: of [look]. */
async function parameterOf(name, scene = "") {
  const { parameters } = await (await fetch(url + "api/v1/parameters")).json();
  return parameters.find((group) => group.scene === scene).parameters.find((parameter) => parameter.name === name).value;
}
const isSent = (page) => page.waitForResponse((response) => response.request().method() === "POST");

test("the keyboard moves a slider of the look, and undo gives its value before back", { timeout: 2 * HANG_MS }, async () => {
  const page = await open(url);
  await openLook(page);
  const clouds = page.getByRole("slider", { name: "clouds" });
  const waitForClouds = (text) => page.waitForSelector(`.parameter:has(label:text-is("clouds")) output:text-is("${text}")`);
  await waitForClouds("0.3");
  await clouds.focus();
  const sent = isSent(page);
  await page.keyboard.press("ArrowRight");
  await sent;
  await waitForClouds("0.305");
  assert.equal(await parameterOf("clouds"), 0.305);
  assert.equal(await clouds.getAttribute("aria-valuetext"), "0.305");
  const undone = isSent(page);
  await page.getByRole("button", { name: "Undo: clouds" }).click();
  await undone;
  await waitForClouds("0.3");
  assert.equal(await parameterOf("clouds"), 0.3);
  assert.ok(await page.getByRole("button", { name: "Undo" }).isDisabled());
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("a select, a field and a switch set values; those of others appear; one that is refused goes back with its reason", { timeout: 2 * HANG_MS }, async () => {
  const page = await open(url, { viewport: WIDE });
  await openLook(page);
  const answered = async (act) => (await Promise.all([isSent(page), act()]))[0].status();
  const palette = page.getByLabel("palette");
  assert.equal(await answered(() => palette.selectOption("autumn")), 200);
  assert.equal(await parameterOf("palette"), "autumn");
  const x = page.locator("#look .group:nth-child(2)").getByLabel("x (m)", { exact: true });
  const setX = async (value) => {
    await x.fill(value);
    await x.press("Enter");
  };
  assert.equal(await answered(() => setX("2.5")), 200);
  assert.equal(await parameterOf("x", "meadow"), 2.5);
  assert.equal(await answered(() => setX("5000")), 409);
  await page.waitForSelector(`.parameter:has(label:text-is("x (m)")) .error:text("is 5000; allowed: number from -1000 to 1000")`);
  await page.waitForFunction((x) => x.value === "2.5", await x.elementHandle());
  assert.equal(await parameterOf("x", "meadow"), 2.5);
  await assertAccessible(page, "look");
  await screenshot(page, "look-1920-light");
  assert.equal(await answered(() => page.locator("#look .group:nth-child(2)").getByRole("switch", { name: "shown" }).click()), 200);
  assert.equal(await parameterOf("shown", "meadow"), false);
  for (const name of ["shown", "x", "palette"]) assert.equal(await answered(() => page.getByRole("button", { name: "Undo: " + name }).click()), 200);
  assert.deepEqual([await parameterOf("shown", "meadow"), await parameterOf("x", "meadow"), await parameterOf("palette")], [true, 0, "meadow"]);
  const set = (body) => fetch(url + "api/v1/parameters", { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) });
  assert.ok((await set({ set: { haze: 0.61 } })).ok);
  await page.waitForSelector(`.parameter:has(label:text-is("haze")) output:text-is("0.61")`);
  assert.ok((await set({ reset: ["haze"] })).ok);
  await page.waitForSelector(`.parameter:has(label:text-is("haze")) output:text-is("0.15")`);
  assert.ok(page.complaints.every((complaint) => complaint.includes("409")), page.complaints.join()); // the browser reports the refusal
  await page.context().close();
});

test("a wind by hand is in the sentence with its time until it is stopped, and so is a blackout", { timeout: 2 * HANG_MS }, async () => {
  const page = await open(url, { viewport: WIDE });
  await waitForSentence(page, LIVE);
  const speed = page.getByRole("slider", { name: "Wind speed" });
  await speed.focus();
  await page.keyboard.press("ArrowRight");
  assert.equal(await speed.getAttribute("aria-valuetext"), "8.5 m/s");
  assert.ok(await page.getByRole("button", { name: "Stop" }).isDisabled());
  await page.selectOption("#hand-time", "3600");
  await page.getByRole("button", { name: "Start this wind" }).click();
  await waitForSentence(page, /^The wind is set by hand, \d+ (min|h) left: 8\.5 m\/s from the west$/);
  assert.equal(await page.getAttribute("#verdict", "data-light"), "other");
  await page.selectOption("#dark-time", { label: "until somebody ends it" });
  await page.getByRole("button", { name: "Blackout" }).click();
  await waitForSentence(page, /^The walls are dark by hand, until somebody ends it\. The wind is set by hand, /);
  await page.waitForSelector("#attention li");
  await assertAccessible(page, "by hand");
  await screenshot(page, "hand-1920-light");
  await page.getByRole("button", { name: "Stop" }).click();
  await waitForSentence(page, /^The walls are dark by hand, until somebody ends it$/);
  await page.getByRole("button", { name: "Lights on" }).click();
  await waitForSentence(page, LIVE);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("a camera is chosen for all viewers, and that of the time of day again", { timeout: 2 * HANG_MS }, async () => {
  const page = await open(url);
  await openLook(page);
  const cameraIs = async (name, byHand) => {
    const { camera, by_hand } = await (await fetch(url + "api/v1/status")).json();
    return camera === name && (by_hand.camera !== null) === byHand;
  };
  const choose = async (label) => (await Promise.all([isSent(page), page.getByLabel("Camera").selectOption({ label })]))[0].status();
  assert.ok(await cameraIs("gate", false));
  assert.equal(await choose("pond"), 200);
  await waitFor(() => cameraIs("pond", true));
  await page.waitForFunction(() => document.getElementById("camera").value === "pond");
  assert.equal(await choose("by the time of day"), 200);
  await waitFor(() => cameraIs("gate", false));
  await page.waitForFunction(() => document.getElementById("camera").value === "");
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("in each language that the browser asks for, on a phone", { timeout: 4 * HANG_MS }, async () => {
  let english;
  for (const { locale, live, same } of LANGUAGES) {
    const page = await open(url, { locale, viewport: { width: 390, height: 844 } });
    await waitForSentence(page, live);
    await page.waitForSelector("#scenes [role=switch]");
    await page.waitForSelector(".trace canvas");
    assert.equal(await page.getAttribute("html", "lang"), locale.slice(0, 2));
    assert.equal(await page.inputValue("#language"), locale.slice(0, 2));
    const own = await ownTexts(page);
    assert.ok(own.length > 40 && own.every((text) => text !== ""), "texts are missing: " + own);
    english ??= own;
    if (english !== own) assert.deepEqual(own.filter((text, i) => text === english[i] && !same.includes(text)), [], locale);
    await page.click("#log summary");
    await page.waitForSelector("#log-lines li");
    await openLook(page);
    assert.equal(await isWider(page, 390), false, locale);
    if (locale === AXE_LOCALE) await assertAccessible(page, locale);
    await screenshot(page, `language-${locale}-390`);
    await page.evaluate(() => document.getElementById("pairing").showModal());
    assert.equal(await isWider(page, 390), false, locale);
    if (locale === AXE_LOCALE) await assertAccessible(page, "pairing, " + locale);
    await page.screenshot({ path: path.join(screenshots, `language-${locale}-390-pairing.png`) });
    assert.deepEqual(page.complaints, []);
    await page.context().close();
  }
});

test("another language is chosen, and kept", { timeout: 2 * HANG_MS }, async () => {
  const page = await open(url, { locale: "pt-BR" }); // has no texts: English
  await waitForSentence(page, LIVE);
  await page.selectOption("#language", "de");
  await waitForSentence(page, LANGUAGES[1].live);
  assert.equal(await page.evaluate(() => document.activeElement.id), "language");
  const again = await page.context().newPage();
  await again.goto(url);
  await waitForSentence(again, LANGUAGES[1].live);
  assert.equal(await again.evaluate(() => document.activeElement.id), "");
  assert.equal(await again.getAttribute("html", "lang"), "de");
  await page.context().close();
});

test("motion is left out for whoever wants none", { timeout: 2 * HANG_MS }, async () => {
  for (const [reducedMotion, duration] of [["reduce", "0s"], ["no-preference", "0.4s"]]) {
    const page = await open(url, { reducedMotion });
    await waitForSentence(page, LIVE);
    assert.equal(await page.evaluate(() => getComputedStyle(document.querySelector(".needle")).transitionDuration), duration);
    await page.context().close();
  }
});

test("the sentence follows a sensor that is killed, and one that is back", { timeout: 2 * HANG_MS }, async () => {
  const page = await open(url, { viewport: WIDE });
  await waitForSentence(page, LIVE);
  await kill(sensor);
  await waitForSentence(page, /because roof is disconnected$/);
  assert.equal(await page.getAttribute("#verdict", "data-light"), "other");
  assert.match(await page.textContent("#attention"), /sensor roof is disconnected: /);
  assert.equal(await page.textContent("#sensors .badge"), "disconnected");
  await screenshot(page, "sensor-killed-1920-light");
  sensor = await startSensor();
  await waitForSentence(page, LIVE);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("a daemon that is killed is told at once, nothing old is shown, and it is back without a reload", { timeout: 2 * HANG_MS }, async () => {
  const page = await open(url, { viewport: { width: 320, height: 800 }, colorScheme: "dark" });
  await waitForSentence(page, LIVE);
  await page.waitForSelector("#scenes [role=switch]");
  await page.evaluate(() => (window.loadedOnce = true));
  await kill(daemon);
  await waitForSentence(page, /^No connection since \d\d:\d\d:\d\d$/);
  assert.equal(await page.getAttribute("#verdict", "data-light"), "lost");
  const numbers = await page.$$eval(".figure .number, #sensors li > .line:nth-child(2) > :first-child, #health dd", (all) => all.map((one) => one.textContent));
  assert.deepEqual([...new Set(numbers)], ["–"]);
  assert.equal(await page.textContent("#sensors .badge"), "not known");
  assert.ok(await page.isDisabled("#scenes [role=switch]"));
  await assertAccessible(page, "lost");
  await screenshot(page, "lost-320-dark");
  daemon = await startDaemon(config);
  await waitForSentence(page, LIVE);
  assert.equal(await page.evaluate(() => window.loadedOnce), true);
  await page.context().close();
});

test("a recording that plays is paused and resumed", { timeout: 2 * HANG_MS }, async () => {
  const recording = path.join(world.folder, "summer.windlog");
  importRecording(recording, 300);
  await startDaemon(configured("player.toml", `
[http]
listen = "127.0.0.1:${playerPort}"
[[sensor]]
name = "summer"
driver = "windlog"
file = "${recording}"
loop = true
`));
  const page = await open(`http://127.0.0.1:${playerPort}/`);
  await waitForSentence(page, /^A recording, not live: summer, /);
  await page.click("#recordings button:text-is('Pause')");
  await page.waitForSelector("#recordings button:text-is('Resume')");
  assert.match(await page.textContent("#recordings .reason"), /^\d:\d\d of 4:59, paused$/);
  await page.click("#recordings button:text-is('Resume')");
  await page.waitForSelector("#recordings button:text-is('Pause')");
  await page.selectOption("#recordings select", "10");
  await page.waitForResponse(async (response) => response.url().endsWith("/player") && (await response.json()).players[0].rate === 10);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("by WebSocket: each message is shown, and silence is no connection", { timeout: 2 * HANG_MS }, async () => {
  const context = await world.browser.newContext();
  const page = await context.newPage();
  page.setDefaultTimeout(HANG_MS);
  const status = await (await fetch(url + "api/v1/status")).json();
  let open;
  const opened = new Promise((resolve) => (open = resolve));
  await page.routeWebSocket(/\/ws$/, open);
  await page.route("**/api/v1/openapi.json", (route) => route.fulfill({ json: { paths: { "/ws": {} } } }));
  await page.goto(url);
  const socket = await opened;
  const sensors = [{ ...status.sensors[0], state: "live", speed_m_s: 17.3, direction_deg: 225, age_s: 0.1 }];
  for (const [attention, light] of [[[], "live"], [["the disk is nearly full"], "attention"]]) {
    socket.send(JSON.stringify({ status: { ...status, sensors, attention, verdict: attention.length === 0 ? "well" : "attention" } }));
    await page.waitForSelector(`[data-light=${light}]`);
    assert.match(await sentence(page), /^Live: roof, 17\.3 m\/s from the south-west, /);
    assert.equal(await page.textContent("#attention"), attention.join());
  }
  await page.route("**/api/v1/status", (route) => route.abort());
  await waitForSentence(page, /^No connection since /);
  await page.unroute("**/api/v1/status");
  await waitForSentence(page, LIVE);
  await context.close();
});

/** A daemon with a token, asked as from another machine: the page, and the code of now. */
async function openFromElsewhere(port, settings, options = {}) {
  const file = configured(`paired-${port}.toml`, `
[http]
listen = "127.0.0.1:${port}"
token_file = "${path.join(world.folder, `token-${port}`)}"
${settings}
[[sensor]]
name = ${JSON.stringify(HOSTILE)}
driver = "synthetic"
`);
  const token = (...args) => execFileSync(path.join(programs, "yuragi"), ["token", "--config", file, ...args], { encoding: "utf8" });
  token("--new");
  await startDaemon(file);
  const page = await open(`http://127.0.0.1:${port}/`, { ...options, extraHTTPHeaders: { "X-Forwarded-For": "192.0.2.7" } });
  return { page, token, code: () => JSON.parse(token("--json")).pairing_code };
}

test("a sensor is set up on the page, from nothing to live, removed, and back by undo", { timeout: 4 * HANG_MS }, async () => {
  const file = configured("setup.toml", `
[http]
listen = "127.0.0.1:${setupPort}"
token_file = "${path.join(world.folder, "token-setup")}"
`);
  const token = (...args) => execFileSync(path.join(programs, "yuragi"), ["token", "--config", file, ...args], { encoding: "utf8" });
  token("--new");
  await startDaemon(file);
  const station = await start("yuragi-sim", ["nmea", "--tcp", "127.0.0.1:0", "--rate", "5"], /127\.0\.0\.1:(\d+)/);
  const page = await open(`http://127.0.0.1:${setupPort}/`, { viewport: WIDE, extraHTTPHeaders: { "X-Forwarded-For": "192.0.2.7" } });
  await waitForSentence(page, /^Synthetic wind, not measured: synthetic/);
  await page.getByRole("button", { name: "Add a sensor" }).click();
  await page.fill("#pairing-code", JSON.parse(token("--json")).pairing_code);
  await page.getByRole("button", { name: "Pair", exact: true }).click();
  await page.waitForSelector("#setup[open]");
  await page.route("**/api/v1/sensors/find", (route) => route.fulfill({ status: 202, json: { id: "0", kind: "find", recording: null, state: "done", run_for_s: 1, message: "", file: null,
    result: [{ driver: "nmea", device: HOSTILE, settings: `transport = "tcp"\nhost = "192.0.2.1"  # "here"\nport = 4800  # or 9600\n`, trouble: HOSTILE, remedy: null }] } }));
  await page.click("#setup-find");
  await page.locator("#setup-found button").click();
  assert.equal(await page.inputValue("#setup-driver"), "nmea");
  assert.deepEqual([await page.inputValue("#setup-transport"), await page.inputValue("#setup-host"), await page.inputValue("#setup-port")], ["tcp", "192.0.2.1", "4800"]);
  assert.equal(await page.isVisible("#setup-file"), false, "a file is not for the page");
  await page.fill("#setup-host", "127.0.0.1");
  await page.fill("#setup-port", station.answer[1]);
  await assertAccessible(page, "setup");
  await page.click("#setup-try");
  await page.waitForSelector("#setup-result:text-matches('^live: ')");
  await page.waitForSelector("#setup-result:text-matches('^It works: live: ')");
  await screenshot(page, "setup-1920-light");
  await page.fill("#setup-port", "70000");
  await page.fill("#setup-name", "roof");
  await page.evaluate(() => (document.getElementById("setup-form").noValidate = true)); // what the browser would refuse is sent
  await page.click("#setup-add");
  await page.waitForSelector("#setup-error:text('sensor.port: is 70000; allowed: whole number from 1 to 65535')");
  await page.fill("#setup-port", station.answer[1]);
  await page.click("#setup-add");
  await page.waitForSelector("#setup:not([open])", { state: "attached" });
  await waitForSentence(page, LIVE);
  assert.deepEqual(await page.$$eval("#sensors h3", (all) => all.map((one) => one.textContent)), ["roof"]);
  await page.getByRole("button", { name: "Remove: roof" }).click();
  await waitForSentence(page, /^Synthetic wind, not measured: synthetic/);
  await page.getByRole("button", { name: "Undo the last change" }).click();
  await waitForSentence(page, LIVE);
  await assertAccessible(page, "a sensor of the page");
  await page.setViewportSize({ width: 320, height: 800 });
  await page.getByRole("button", { name: "Add a sensor" }).click();
  await page.waitForSelector("#setup[open]");
  assert.equal(await isWider(page, 320), false);
  await screenshot(page, "setup-320-light");
  assert.equal(await page.evaluate(() => document.title.includes("owned")), false);
  await page.context().close();
  await kill(station);
});

test("a sensor is calibrated on the page: stopped, measured, kept, and undone", { timeout: 4 * HANG_MS }, async () => {
  const station = await start("yuragi-sim", ["nmea", "--tcp", "127.0.0.1:0", "--rate", "5", "--speed", "8", "--direction", "350", "--turbulence", "0"], /127\.0\.0\.1:(\d+)/);
  const file = configured("calibration.toml", `
[http]
listen = "127.0.0.1:${calibrationPort}"
token_file = "${path.join(world.folder, "token-calibration")}"
[[sensor]]
name = "roof"
driver = "nmea"
transport = "tcp"
host = "127.0.0.1"
port = ${station.answer[1]}
`);
  const token = (...args) => execFileSync(path.join(programs, "yuragi"), ["token", "--config", file, ...args], { encoding: "utf8" });
  token("--new");
  await startDaemon(file);
  const page = await open(`http://127.0.0.1:${calibrationPort}/`, { extraHTTPHeaders: { "X-Forwarded-For": "192.0.2.7" }, viewport: { width: 320, height: 800 } });
  await waitForSentence(page, /^Live: roof, \d\.\d m\/s from the north,/);
  await page.getByRole("button", { name: "Calibrate a sensor" }).click();
  await page.fill("#pairing-code", JSON.parse(token("--json")).pairing_code);
  await page.getByRole("button", { name: "Pair", exact: true }).click();
  await page.waitForSelector("#calibration[open]");
  await page.waitForSelector("#calibration-preparation:text-matches('^The air at the sensor must not move')");
  await page.fill("#calibration-time", "1800");
  await page.click("#calibration-start");
  await page.waitForSelector("#calibration-progress:text-matches('s left, roof: \\\\d+\\\\.\\\\d m/s')");
  await page.click("#calibration-stop");
  await page.waitForSelector("#calibration-error:text('it was cancelled')");
  assert.equal(await page.isEnabled("#calibration-keep"), false);

  await page.selectOption("#calibration-way", { label: "North: by a landmark" });
  await page.fill("#calibration-number", "90");
  await page.waitForSelector("#calibration-preparation:text-matches('the landmark at 90 degrees')");
  await page.fill("#calibration-time", "5");
  await page.click("#calibration-start");
  await page.waitForSelector("#calibration-keep:enabled");
  assert.match(await page.textContent("#calibration-result"), /The vane reads .*north_offset0(9[89]|10[0-2])/);
  await assertAccessible(page, "calibration");
  assert.equal(await isWider(page, 320), false);
  await screenshot(page, "calibration-320-light");
  await page.click("#calibration-keep");
  await page.waitForSelector("#calibration:not([open])", { state: "attached" });
  await waitForSentence(page, /^Live: roof, \d\.\d m\/s from the east,/);
  await page.getByRole("button", { name: "Remove the calibration: roof" }).waitFor();
  await page.getByRole("button", { name: "Undo the last change" }).click();
  await waitForSentence(page, /^Live: roof, \d\.\d m\/s from the north,/);
  await page.context().close();
  await kill(station);
});

test("a value of the look and of a scene is kept, undone, and goes back to the configuration", { timeout: 4 * HANG_MS }, async () => {
  const { page, code } = await openFromElsewhere(keepPort, "", { viewport: WIDE });
  const button = (name) => page.locator("#look").getByRole("button", { name, exact: true });
  const waitForHaze = (text) => page.waitForSelector(`.parameter:has(label:text-is("haze")) output:text-is("${text}")`);
  const x = page.locator("#look .group:nth-child(2)").getByLabel("x (m)", { exact: true });
  const waitForX = async (value) => page.waitForFunction(([x, value]) => x.value === value, [await x.elementHandle(), value]);
  await openLook(page);
  await waitForHaze("0.15");
  assert.equal(await button("Keep these values").isVisible(), false, "nothing differs");
  assert.equal(await button("Back to the configuration").isVisible(), false);
  await page.getByRole("slider", { name: "haze" }).focus();
  await page.keyboard.press("ArrowRight");
  await page.waitForSelector("#pairing-code", { state: "visible" });
  await page.fill("#pairing-code", code());
  await page.keyboard.press("Enter");
  await waitForHaze("0.155");
  await button("Undo: haze").waitFor(); // paired, and set: before that a second change would pair once more
  await x.fill("2.5");
  await x.press("Enter");
  await button("Undo: x").waitFor();
  await button("Keep these values").click();
  await page.waitForSelector("#toast:text('2 values are kept')");
  await button("Keep these values").waitFor({ state: "hidden" });
  await button("Back to the configuration").waitFor();
  await button("Undo the last change of kept values").waitFor();
  await assertAccessible(page, "kept values");
  await screenshot(page, "kept-1920-light");

  await button("Undo the last change of kept values").click();
  await waitForHaze("0.15");
  await waitForX("0");
  await button("Back to the configuration").waitFor({ state: "hidden" });
  await button("Undo the last change of kept values").click();
  await waitForHaze("0.155");
  await waitForX("2.5");
  await button("Back to the configuration").click();
  await waitForHaze("0.15");
  await waitForX("0");
  await button("Back to the configuration").waitFor({ state: "hidden" });
  await page.context().close();
});

test("another machine reads, and pairs before it changes something; hostile names stay text", { timeout: 2 * HANG_MS }, async () => {
  const { page, token, code } = await openFromElsewhere(pairingPort, "", { viewport: WIDE });
  await waitForSentence(page, /^Synthetic wind, not measured: <img/);
  assert.ok((await sentence(page)).includes(HOSTILE));
  assert.equal(await page.textContent("#sensors h3"), HOSTILE);
  assert.equal(await page.$("main img"), null);
  assert.equal(await page.title(), "Not live – Yuragi");
  assert.deepEqual(page.complaints, []);

  await page.getByRole("switch", { name: /meadow/ }).click();
  await page.click("#pairing-cancel");
  await openLook(page);
  await page.getByRole("slider", { name: "haze" }).focus();
  await page.keyboard.press("ArrowRight");
  await page.waitForSelector("#pairing-code", { state: "visible" });
  await page.click("#pairing-cancel");
  await page.waitForSelector(`.parameter:has(label:text-is("haze")) output:text-is("0.15")`);

  await page.getByRole("switch", { name: /meadow/ }).click();
  await page.fill("#pairing-code", "0000-0000");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => /not the code/.test(document.getElementById("pairing-error").textContent));
  await assertAccessible(page, "pairing");
  await screenshot(page, "pairing-1920-light");
  await page.fill("#pairing-code", code());
  const done = page.waitForResponse((response) => response.url().endsWith("/scenes") && response.request().method() === "POST" && response.ok());
  await page.click("#pairing button.primary");
  assert.equal((await (await done).json()).scenes[0].is_shown, false);

  for (const session of JSON.parse(token("--sessions", "--json")).sessions) token("--revoke", session.id);
  await page.getByRole("switch", { name: /meadow/ }).click();
  await page.waitForSelector("#pairing-code", { state: "visible" }); // it may be paired again
  await page.context().close();
});

test("where reading takes the token, another machine sees nothing until it is paired", { timeout: 2 * HANG_MS }, async () => {
  const { page, code } = await openFromElsewhere(readingPort, 'readers = "token"');
  await waitForSentence(page, /until it is paired$/);
  assert.equal(await page.isVisible("#cards"), false);
  await page.click("#pair-now");
  await page.fill("#pairing-code", code());
  await page.keyboard.press("Enter");
  await waitForSentence(page, /^Synthetic wind, not measured: /);
  await page.context().close();
});

/** A page of another origin, with nothing on it. */
async function foreignPage() {
  const server = http.createServer((_, reply) => reply.writeHead(200, { "Content-Type": "text/html" }).end("<title>foreign</title>"));
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  after(() => server.close());
  return `http://127.0.0.1:${server.address().port}`;
}
/** What a page of that origin gets of the daemon: its state by HTTP, and the first message of a WebSocket. */
async function readFrom(origin, daemonUrl) {
  const page = await world.browser.newPage();
  await page.goto(origin);
  const got = await page.evaluate(async (url) => {
    const state = await fetch(url + "/api/v1/status").then((answer) => answer.ok, () => false);
    const change = await fetch(url + "/api/v1/scenes", {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify({ scene: "meadow", shown: false }),
    }).then(() => true, () => false);
    const wind = await new Promise((resolve) => {
      const socket = new WebSocket(url.replace("http", "ws") + "/ws");
      socket.onopen = () => socket.send(JSON.stringify({ wind: 60 }));
      socket.onmessage = (event) => resolve(Number.isFinite(JSON.parse(event.data).wind.speed));
      socket.onclose = () => resolve(false);
    });
    return { state, change, wind };
  }, daemonUrl);
  await page.close();
  return got;
}

test("own pages draw the wind at /site/; a foreign page reads only if it is listed, and changes nothing", { timeout: 2 * HANG_MS }, async () => {
  const listed = await foreignPage();
  const other = await foreignPage();
  const www = path.join(world.folder, "www");
  fs.cpSync(path.join(import.meta.dirname ?? path.dirname(process.argv[1]), "../../config/examples/www"), www, { recursive: true });
  fs.copyFileSync(require.resolve("p5/lib/p5.min.js"), path.join(www, "p5.min.js"));
  const file = configured("site.toml", `
[http]
listen = "127.0.0.1:0"
origins = "${listed}"
folder = "${www}"
[[sensor]]
driver = "synthetic"
`);
  const daemon = await start("yuragi", ["run", "--config", file, "--listen", "127.0.0.1:0"], /answering at (http:\/\/\S+)/);
  const base = daemon.answer[1];
  const page = await open(base + "/", { viewport: WIDE });
  const messages = [];
  // The daemon's own page, which is left here, may still get its state.
  page.on("websocket", (socket) => socket.on("framereceived", ({ payload }) => {
    const message = JSON.parse(payload);
    if ("wind" in message) messages.push(message);
  }));
  await page.goto(base + "/site/");
  await page.waitForFunction(() => wind && wind.speed > 0 && frameCount > 10);
  while (messages.length < 120) await page.waitForTimeout(PAUSE_MS);
  assert.ok(messages.every(({ t }, i) => i === 0 || t > messages[i - 1].t));
  assert.deepEqual(page.complaints, []);
  await screenshot(page, "site");
  await page.context().close();

  assert.deepEqual(await readFrom(listed, base), { state: true, change: false, wind: true });
  assert.deepEqual(await readFrom(other, base), { state: false, change: false, wind: false });
  await kill(daemon);
});
