// pictures.mjs: draws the pictures of pages that the documents show anew, from the studies that they are of.
import { join } from "node:path";
import { closeBrowser, folderOf, frahm, open, sources, study } from "./page.mjs";

const width = 960;

// What a test gives its helpers: calls kept for the end.
const ends = [closeBrowser];
const keeper = { after: (call) => ends.push(call) };

async function pageOf(name) {
  const file = join(folderOf(keeper), `${name}.h5`);
  frahm(["run", study(name), "-o", file, "--progress", "none"]);
  frahm(["report", file]);
  const { page } = await open(keeper, file.replace(/h5$/, "html"), { width });
  return page;
}

// The page from its head to the end of a section.
async function drawn(page, section, picture) {
  await page.evaluate(() => window.scrollTo(0, 0));
  const last = page.locator("main section").filter({ has: page.locator("h2", { hasText: section }) });
  const { y, height } = await last.first().boundingBox();
  const clip = { x: 0, y: 0, width, height: Math.ceil(y + height) };
  await page.screenshot({ fullPage: true, clip, path: join(sources, "results/report", picture) });
}

// Takes a point of the map, keeping the curves of the one before: by its place in the frame, from 0 to 1.
async function take(page, across, up, modifiers) {
  const frame = await page.locator("main figure.card .plot svg image").first().boundingBox();
  const at = { x: frame.x + across * frame.width, y: frame.y + (1 - up) * frame.height };
  for (const key of modifiers) await page.keyboard.down(key);
  await page.mouse.click(at.x, at.y);
  for (const key of modifiers) await page.keyboard.up(key);
  await page.mouse.move(0, 0);
}

try {
  await drawn(await pageOf("tune_rig_schedule"), "Response", "tuning.png");
  const map = await pageOf("regime_map");
  await take(map, 0.42, 0.25, []);
  await take(map, 0.42, 0.545, ["Shift"]);
  await take(map, 0.42, 0.725, ["Shift"]);
  await map.getByLabel("colour by regime").check();
  await map.evaluate(() => document.activeElement.blur());
  await map.waitForTimeout(500);
  await drawn(map, "Response curves", "atlas.png");
} finally {
  for (const end of ends.reverse()) await end();
}
