// Pages of identifications, decays, transients and other tunings: they open without a complaint, at every size, with no
// label cut off or over another.
import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { badLabels, folderOf, frahm, open, photographed, stored, study } from "./page.mjs";

const cases = [
  { name: "identify_rig_forced", shows: ["Data against model", "NRMSE", "95 % interval"] },
  { name: "identify_paper_half_power", shows: ["zeta"] },
  { name: "rig_decay_main", shows: ["Damping budget", "Turning points of main", "Phase portrait of main"] },
  { name: "rig_forced_250rpm_I6_crank", shows: ["Damping budget", "crank"] },
  { name: "run_up", shows: ["discretisation"] },
  { name: "tune_h2_support", shows: ["What this means"] },
  { name: "tune_rig_trade_off", shows: ["What this means"] },
  { name: "rig_energy_shares", shows: ["Damping budget"] },
  { name: "lecture_hysteretic", shows: ["Resonance"] },
];

for (const { name, shows } of cases) {
  test(`the page of ${name}`, async (t) => {
    const folder = folderOf(t),
      file = join(folder, `${name}.h5`);
    frahm(["run", study(name), "-o", file, "--progress", "none"]);
    frahm(["report", file]);
    const { page, complaints } = await open(t, join(folder, `${name}.html`));
    const text = await page.locator("main").textContent();
    for (const words of shows) assert.ok(text.includes(words), `no "${words}" in the page of ${name}`);
    for (const width of [1280, 390]) {
      await page.setViewportSize({ width, height: 800 });
      await page.waitForTimeout(300);
      assert.deepEqual(await badLabels(page), [], `${width} wide`);
    }
    await photographed(page, name);
    assert.deepEqual(complaints, []);
  });
}

test("the fit quality shown is that of the file", async (t) => {
  const folder = folderOf(t),
    file = join(folder, "fit.h5");
  frahm(["run", study("identify_rig_forced"), "-o", file, "--progress", "none"]);
  frahm(["report", file]);
  const { page } = await open(t, join(folder, "fit.html"));
  const value = stored(file, "identification/nrmse", [0]);
  const row = await page
    .locator("tr", { hasText: "all of it" })
    .first()
    .locator("td.number")
    .first()
    .textContent();
  assert.ok(Math.abs(Number(row) - value) < 1e-4, `${row}, ${value}`);
});
