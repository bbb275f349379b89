// Pages of several kinds without a finding of axe-core, wide and narrow, light and dark; and a map that is read and steered
// by keys and by touch alone.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { test } from "node:test";
import { everyKind, folderOf, frahm, open, study } from "./page.mjs";

const axe = readFileSync(
  createRequire(join(process.env.FRAHM_NODE_MODULES, "page.cjs")).resolve("axe-core/axe.min.js"),
  "utf8",
);

// A page's findings, each as one line.
async function findings(page) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => globalThis.axe.run(document));
  return violations.flatMap(({ id, nodes }) =>
    nodes.map(({ html, failureSummary }) => `${id}: ${html}\n${failureSummary}`),
  );
}

function pageOf(t, name) {
  const folder = folderOf(t),
    file = join(folder, `${name}.h5`);
  frahm(["run", study(name), "-o", file, "--progress", "none"]);
  frahm(["report", file]);
  return join(folder, `${name}.html`);
}

const some = {
  "a map with branches": "machine_on_stops",
  "a tuning": "tune_friction_absorber",
  "an identification": "identify_rig_forced",
};
const others = {
  "a map": "slipping_brace",
  samples: "absorber_scatter",
  "a structure": "tower_damper",
  "a map of motions over records": "response_spectrum",
  "a trade-off": "tune_rig_trade_off",
  "a decay": "rig_decay_main",
  "a transient with a crank": "rig_forced_250rpm_I6_crank",
};

for (const [kind, name] of Object.entries({ ...some, ...(everyKind ? others : {}) })) {
  test(`the page of ${kind} is accessible`, async (t) => {
    const { page } = await open(t, pageOf(t, name));
    const wide = await findings(page);
    assert.equal(wide.length, 0, wide.join("\n\n"));
    await page.emulateMedia({ colorScheme: "dark" });
    await page.setViewportSize({ width: 390, height: 844 });
    await page.waitForTimeout(300); // figures are drawn anew
    const narrow = await findings(page);
    assert.equal(narrow.length, 0, narrow.join("\n\n"));
  });
}

// The numbers of the chosen point, as the page tells them.
const place = (page) => page.locator("main section:has(> h2:text-is('Point'))").textContent();

test("a map", async (t) => {
  const file = pageOf(t, "regime_map");

  await t.test("the arrow keys move the chosen point", async (t) => {
    const { page } = await open(t, file);
    const plot = page.locator("[aria-label^='response map']");
    const before = await place(page);
    for (let i = 0; i < 200 && !(await plot.evaluate((each) => each === document.activeElement)); ++i)
      await page.keyboard.press("Tab");
    assert.ok(await plot.evaluate((each) => each === document.activeElement), "Tab comes to the map");
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("Shift+ArrowUp");
    const told = page.locator("[role=status]");
    await page.waitForFunction(() => document.querySelector("[role=status]").textContent !== "");
    await page.waitForTimeout(300); // the frame in which it is drawn
    assert.match(await told.textContent(), /^Point: .*= /);
    assert.notEqual(await place(page), before);
  });

  await t.test(
    "a tap takes a point on a phone, and its controls are large enough for a finger",
    async (t) => {
      const { page } = await open(t, file, { width: 390, height: 844, hasTouch: true });
      const before = await place(page);
      const box = await page.locator("[aria-label^='response map'] svg").first().boundingBox();
      await page.touchscreen.tap(box.x + 0.5 * box.width, box.y + 0.6 * box.height);
      await page.waitForTimeout(300);
      assert.notEqual(await place(page), before);
      const small = await page.evaluate(() =>
        [...document.querySelectorAll("button, select, input")]
          .filter((each) => each.checkVisibility() && each.getBoundingClientRect().height < 24)
          .map((each) => each.outerHTML.slice(0, 80)),
      );
      assert.deepEqual(small, []);
    },
  );

  await t.test("it ends where its axes do", async (t) => {
    const { page } = await open(t, file);
    const ends = await page.evaluate(() => {
      const svg = document.querySelector("[aria-label^='response map'] svg");
      return { x: svg.scale("x").domain, y: svg.scale("y").domain };
    });
    const text = readFileSync(study("regime_map"), "utf8");
    const axes = [
      ...text.matchAll(/\[\[axis\]\]\s+parameter = "(\w+)"[^[]*?from = ([\d.]+)[^[]*?to = ([\d.]+)/g),
    ];
    for (const [, name, from, to] of axes) {
      const shown = Object.values(ends).find(([low, high]) => low === Number(from) && high === Number(to));
      assert.ok(shown || name === "zeta", `${name}: ${from} to ${to}, drawn ${JSON.stringify(ends)}`);
    }
  });
});
