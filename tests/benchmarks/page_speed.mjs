// How fast a page opens and follows its slider, in a headless Chromium:  see tests/end_to_end/report/page.mjs for the
// environment.   FRAHM_CHROMIUM=... FRAHM_NODE_MODULES=... node page_speed.mjs PAGE.html
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const { chromium } = createRequire(join(process.env.FRAHM_NODE_MODULES, "page.cjs"))("playwright-core");
const rounds = 7,
  moves = 30;

const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];
const told = (name, values) =>
  console.log(
    `${name}: median ${median(values).toFixed(0)} ms, worst ${Math.max(...values).toFixed(0)} ms of ${values.length}`,
  );

const browser = await chromium.launch({ executablePath: process.env.FRAHM_CHROMIUM, args: ["--no-sandbox"] });
const opening = [],
  sliding = [];
for (let round = 0; round < rounds; ++round) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
  await page.goto(pathToFileURL(process.argv[2]).href);
  // From the start of the navigation until every figure is drawn and a frame has passed.
  opening.push(
    await page.evaluate(async () => {
      const drawn = () =>
        document.body.dataset.state === "ready" &&
        [...document.querySelectorAll(".plot")].every((plot) => plot.querySelector("svg"));
      while (!drawn()) await new Promise((later) => setTimeout(later, 5));
      await new Promise((later) => requestAnimationFrame(later));
      return performance.now();
    }),
  );
  // From the slider's event until the frame with the new figures has been handed on.
  sliding.push(
    ...(await page.evaluate(async (count) => {
      const slider = document.querySelector("input[type=range]"),
        times = [];
      if (!slider) return times;
      for (let k = 0; k < count; ++k) {
        slider.value = String((Number(slider.value) + 1) % (Number(slider.max) + 1));
        const start = performance.now();
        slider.dispatchEvent(new Event("input", { bubbles: true }));
        await new Promise((later) => requestAnimationFrame(() => setTimeout(later, 0)));
        times.push(performance.now() - start);
      }
      return times;
    }, moves)),
  );
  await page.close();
}
await browser.close();
told("opens", opening);
if (sliding.length) told("follows the slider", sliding);
