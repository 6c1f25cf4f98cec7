// A browser, and our programs beside it, for tests of what the daemon shows in it.
import { spawn } from "node:child_process";
import fs from "node:fs";
import { createRequire } from "node:module";
import os from "node:os";
import path from "node:path";

export const HANG_MS = 120_000; // reached only by what hangs

/** On a machine that is too busy to open a WebSocket in time, the page gives it up and requests the state instead. */
const TOO_BUSY = /WebSocket is closed before the connection is established/;

/** `tools`: the folder with playwright-core; `programs`: that of ours. */
export async function begin({ chromiumPath, programs, tools }) {
  const require = createRequire(path.join(tools, "package.json"));
  const { chromium } = require("playwright-core");
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "yuragi-browser-"));
  const running = new Set();
  const browser = await chromium.launch({
    executablePath: chromiumPath,
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=gl-egl", "--ignore-gpu-blocklist"],
  });

  return {
    browser,
    folder,

    file(name, text) {
      const file = path.join(folder, name);
      fs.writeFileSync(file, text);
      return file;
    },

    /** Runs a program until it prints what is awaited. */
    start(program, args, awaited) {
      const child = spawn(path.join(programs, program), args, { stdio: ["ignore", "pipe", "pipe"] });
      running.add(child);
      child.ended = new Promise((resolve) => child.on("exit", resolve));
      let printed = "";
      return new Promise((resolve, reject) => {
        const read = (text) => {
          printed += text;
          child.answer ??= awaited.exec(printed);
          if (child.answer) resolve(child);
        };
        child.stdout.on("data", read);
        child.stderr.on("data", read);
        child.on("exit", () => reject(new Error(`${program} ended: ${printed}`)));
      });
    },

    async kill(child) {
      child.kill("SIGKILL");
      await child.ended;
      running.delete(child);
    },

    /** A page, and all that it writes on its console or asks of others. Without motion, which the processor would draw.
        `script`: what the page runs before its own scripts. */
    async open(url, { script, ...options } = {}) {
      const context = await browser.newContext({ viewport: { width: 320, height: 180 }, reducedMotion: "reduce", ...options });
      const page = await context.newPage();
      page.setDefaultTimeout(HANG_MS);
      if (script) await page.addInitScript({ content: script });
      page.complaints = [];
      page.on("console", (message) => {
        if (!TOO_BUSY.test(message.text())) page.complaints.push(message.text());
      });
      page.on("pageerror", (error) => page.complaints.push(error.message));
      page.on("request", (request) => {
        if (!request.url().startsWith(new URL(url).origin)) page.complaints.push("asks for " + request.url());
      });
      await page.goto(url);
      return page;
    },

    /** The faults of this page that axe-core finds: they keep some people from using it. */
    async accessibilityFaults(page) {
      return page.evaluate(async (source) => {
        if (!window.axe) Object.assign(window, { axe: new Function(source + "; return axe;")() });
        const { violations } = await window.axe.run({ resultTypes: ["violations"] });
        return violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => `${node.html} ${node.failureSummary}`).join("; ")}`);
      }, fs.readFileSync(require.resolve("axe-core/axe.min.js"), "utf8"));
    },

    async end() {
      await browser.close();
      for (const child of running) await this.kill(child);
      fs.rmSync(folder, { recursive: true });
    },
  };
}
