// Maps that are hard to draw: nothing bounded, axes out of order, a quantity that is zero everywhere, an outlier.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { badLabels, csvRows, folderOf, frahm, isTold, open, saved, stored } from "./page.mjs";

// Den Hartog's oscillator with these axes: [parameter, lines of its table].
function oscillator(axes, more = "") {
  return `[study]
schema = 1
kind = "sweep"
title = "hard to draw"
units = "dimensionless"
[parameters]
zeta = 0.0
f = 0.1
r = 1.0
[[mass]]
name = "main"
mass = 1
[[element]]
name = "spring"
type = "spring"
between = ["ground", "main"]
stiffness = 1
[[element]]
name = "damper"
type = "damper"
between = ["ground", "main"]
damping = "2*zeta"
[[element]]
name = "friction"
type = "coulomb"
between = ["ground", "main"]
force = "f"
[excitation]
frequency = "r"
[[excitation.force]]
on = "main"
amplitude = 1
${axes.map(([parameter, lines]) => `[[axis]]\nparameter = "${parameter}"\n${lines}\n`).join("")}${more}`;
}

async function pageOf(t, text) {
  const folder = folderOf(t),
    file = join(folder, "hard.h5");
  writeFileSync(join(folder, "hard.toml"), text);
  frahm(["run", join(folder, "hard.toml"), "-o", file, "--progress", "none"]);
  frahm(["report", file]);
  const figures = join(folder, "figures");
  frahm(["report", file, "--figures", figures]);
  return { file, figures, ...(await open(t, join(folder, "hard.html"))) };
}

test("where nothing is bounded the page says so", async (t) => {
  const axes = [
    ["f", "values = [0, 0.1, 0.2]"],
    ["r", "values = [1.0]"],
  ];
  const { page, complaints } = await pageOf(t, oscillator(axes));
  assert.match(
    await page.locator(".warning").first().textContent(),
    /3 of 3 points have no bounded response/,
  );
  assert.deepEqual(complaints, []);
});

test("an axis out of order is shown by its number, with its true values", async (t) => {
  const axes = [
    ["zeta", "values = [0.5, 0.05, 0.2]"],
    ["f", "from = 0.1\nto = 1.1\npoints = 6"],
    ["r", "from = 0.5\nto = 1.5\npoints = 21"],
  ];
  const { page, complaints, file } = await pageOf(t, oscillator(axes, "[output]\nborders = true\n"));
  await page.locator("input[data-axis=zeta]").fill("2");
  await page.waitForFunction(() => document.querySelector("#point h3").textContent.includes("ζ = 0.2"));
  assert.match(await page.locator("#point code").textContent(), /--at zeta=0\.2,f=[\d.]+,r=[\d.]+$/);
  assert.ok((await page.locator("[data-figure^=map_] [data-mark=line]").count()) > 0, "no borders");
  const rows = csvRows((await saved(page, page.locator("[data-figure^=map_] .save-csv"))).text);
  assert.ok(rows.every((row) => row.zeta === "0.2"));
  const row = rows.find(({ f, r }) => Math.abs(f - 0.3) < 1e-9 && Math.abs(r - 0.9) < 1e-9);
  const value = stored(file, "main_peak", [2, 1, 8]);
  assert.ok(isTold(Number(row.main_peak), value), `${row.main_peak}, ${value}`);
  assert.deepEqual(await badLabels(page), []);
  assert.deepEqual(complaints, []);
});

test("a quantity that is zero everywhere has a map in any colours", async (t) => {
  const axes = [
    ["f", "from = 0.5\nto = 1.1\npoints = 7"],
    ["r", "from = 0.5\nto = 1.5\npoints = 11"],
  ];
  const more =
    '[output]\nquantities = ["main_peak", "main_mean", "spring_energy", "status"]\n[report]\nquantities = ["main_peak", "spring_energy"]\n';
  const { page, complaints } = await pageOf(t, oscillator(axes, more));
  await page.locator("label", { hasText: "colours" }).locator("select").selectOption("log");
  await page
    .locator("label", { hasText: "quantity" })
    .locator("select")
    .first()
    .selectOption("spring_energy");
  await page.waitForFunction(() =>
    document.querySelector("[data-figure^=map_] svg").textContent.includes("spring energy"),
  );
  assert.deepEqual(complaints, []);
});

test("beside a response a billion times larger the small ones keep six digits, and figures all", async (t) => {
  const axes = [
    ["f", "values = [0, 0.9]"],
    ["r", "values = [0.5, 0.9999999995, 1.5]"],
  ];
  const { page, file, figures } = await pageOf(t, oscillator(axes));
  const largest = stored(file, "main_peak", [0, 1]),
    small = stored(file, "main_peak", [1, 2]);
  assert.ok(largest > 1e8 * small, `${largest}, ${small}`);
  const rows = csvRows((await saved(page, page.locator("[data-figure^=map_] .save-csv"))).text);
  const shown = Number(rows.find(({ f, r }) => f === "0.9" && r === "1.5").main_peak);
  assert.ok(isTold(shown, small), `${shown}, ${small}`);
  const exact = csvRows(readFileSync(join(figures, "map_main_peak.csv"), "utf8"));
  assert.equal(Number(exact.find(({ f, r }) => f === "0.9" && r === "1.5").main_peak), small);
});
