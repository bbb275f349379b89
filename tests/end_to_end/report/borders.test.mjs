// Regime borders over a map, and orbits with their friction loops: the page of regime_map.toml.
import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { badLabels, csvRows, folderOf, frahm, open, photographed, saved, study } from "./page.mjs";

// f_crit of Den Hartog's oscillator (Trans. ASME 53, 1931) for r >= 0.5, where the contact first sticks just after a
// reversal: V/sqrt(H^2 + S^2), S = (1 + G + 2 zeta r H)/r^2.
function criticalFriction(r, zeta) {
  const th = Math.PI / r,
    s = Math.sqrt(1 - zeta ** 2);
  const V = 1 / Math.hypot(1 - r ** 2, 2 * zeta * r),
    Dn = Math.cosh(zeta * th) + Math.cos(s * th);
  const G = (Math.sinh(zeta * th) - (zeta / s) * Math.sin(s * th)) / Dn,
    H = Math.sin(s * th) / (s * r * Dn);
  return V / Math.hypot(H, (1 + G + 2 * zeta * r * H) / r ** 2);
}

// Points of the curves drawn between two regimes, in the units of the axes.
async function drawnBorder(page, dash) {
  return page.evaluate((wanted) => {
    const svg = document.querySelector("[data-figure^=map_] svg"),
      x = svg.scale("x"),
      y = svg.scale("y");
    const lines = [...svg.querySelectorAll("[data-mark=line]")].filter(
      (g) => g.getAttribute("stroke") === "black" && (g.getAttribute("stroke-dasharray") ?? "") === wanted,
    );
    const places = lines
      .flatMap((g) => [...g.querySelectorAll("path")])
      .flatMap((path) => path.getAttribute("d").slice(1).split(/[LM]/))
      .map((text) => text.split(",").map(Number));
    return places.map(([px, py]) => [x.invert(px), y.invert(py)]);
  }, dash);
}

test("the page of a map with borders and orbits", async (t) => {
  const folder = folderOf(t),
    file = join(folder, "regime_map.h5");
  frahm(["run", study("regime_map"), "-o", file, "--progress", "none"]);
  frahm(["report", file]);
  const { page, complaints } = await open(t, join(folder, "regime_map.html"));
  await page.locator("input[data-axis=zeta]").fill("1");

  await t.test("draws the border of motion without stops where the closed form has it", async () => {
    await page.waitForFunction(() =>
      document.querySelector("[data-figure^=map_] h3").textContent.includes("ζ = 0.05"),
    );
    const border = (await drawnBorder(page, "")).filter(([r]) => r >= 0.55);
    assert.ok(border.length > 100, `${border.length} points`);
    const straight = 2e-3; // of the frame: points along r lie on the curve, joined by straight lines; pixels have 0.01
    for (const [r, f] of border)
      assert.ok(
        Math.abs(f - criticalFriction(r, 0.05)) < straight,
        `r = ${r}: ${f}, f_crit ${criticalFriction(r, 0.05)}`,
      );
    assert.match(
      await page.locator("[data-figure^=map_] [data-mark=legend]").textContent(),
      /non stop \| one stop/,
    );
  });

  await t.test("shows an orbit of each regime, and its friction loop", async () => {
    const loop = page.locator("[data-figure^=orbit_friction_loop_friction]");
    const areas = [];
    for (const k of [0, 1, 2]) {
      await page.locator("label", { hasText: "orbit" }).locator("select").selectOption(String(k));
      await page.waitForFunction(
        (n) => document.querySelector(`[data-figure=orbit_friction_loop_friction_${n}] svg`),
        k + 1,
      );
      const rows = csvRows((await saved(page, loop.locator(".save-csv"))).text);
      const force = rows.map((row) => Number(row.friction_force)),
        u = rows.map((row) => Number(row.friction_displacement));
      areas.push(
        Math.abs(
          force.reduce((sum, value, i) => sum + (value * (u[(i + 1) % u.length] - u.at(i - 1))) / 2, 0),
        ),
      );
      const limit = [0.3, 0.8, 0.5][k],
        stroke = Math.max(...u);
      assert.ok(
        Math.abs(areas[k] - 4 * limit * stroke) < 0.02 * areas[k],
        `orbit ${k}: the loop of area ${areas[k]}, 4 F X = ${4 * limit * stroke}`,
      );
    }
    assert.equal(await page.locator("[data-figure^=orbit_history]").count(), 1);
  });

  assert.deepEqual(await badLabels(page), []);
  await photographed(page, "regimes");
  assert.deepEqual(complaints, []);
});
