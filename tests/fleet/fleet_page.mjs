// The leader's page in a real browser: which walls there are, and which one is silent.
// usage: fleet_page.mjs CHROMIUM FOLDER_OF_BROWSER_TOOLS FOLDER_OF_SCREENSHOTS ADDRESS PROCESS_OF_THE_WALL_FOYER
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";

import { begin } from "../e2e/chromium.mjs";

const [chromiumPath, tools, screenshots, url, foyer] = process.argv.slice(2);
fs.mkdirSync(screenshots, { recursive: true });
const world = await begin({ chromiumPath, programs: "", tools });
try {
  const page = await world.open(url, { viewport: { width: 390, height: 844 }, locale: "de-DE" });
  const row = (name) => page.locator("#fleet li").filter({ has: page.getByRole("heading", { name, exact: true }) });
  // On a busy machine ticks are late, which needs attention.
  for (const name of ["roof", "foyer"]) await row(name).getByText(/^(in Ordnung|braucht Aufmerksamkeit)$/).waitFor();
  await row("foyer").getByText("the same picture as its leader").waitFor();
  await row("foyer").getByText(/m\/s/).waitFor();
  await page.locator("#fleet-card").screenshot({ path: path.join(screenshots, "fleet.png") });
  process.kill(Number(foyer), "SIGKILL");
  await row("foyer").getByText("stumm").waitFor();
  await row("foyer").getByText("the same picture").waitFor({ state: "detached" });
  await row("foyer").getByText(/zuletzt gehört vor/).waitFor();
  await page.locator("#attention").getByText(/node foyer: no word for/).waitFor();
  await page.locator("#fleet-card").screenshot({ path: path.join(screenshots, "silent.png") });
  assert.deepEqual(await world.accessibilityFaults(page), []);
  assert.deepEqual(page.complaints, []);
} finally {
  await world.end();
}
