// Branches over a map's curves: the page of machine_on_stops.toml, and that of one branch alone.
import assert from "node:assert/strict";
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { badLabels, csvRows, folderOf, frahm, open, photographed, saved, study } from "./page.mjs";

const folds = [2.00180666851, 1.4086707284];

// Points of the dashed and of the solid lines of a figure, in the units of its axes; the map's own curve is faint.
async function drawn(page, figure, isDashed) {
  return page.evaluate(
    ([name, wanted]) => {
      const svg = document.querySelector(`[data-figure^=${name}] svg`),
        x = svg.scale("x"),
        y = svg.scale("y");
      const lines = [...svg.querySelectorAll("[data-mark=line]")].filter((g) => {
        const dash = g.getAttribute("stroke-dasharray"); // a compared curve is dotted
        return (wanted ? dash?.startsWith("5") : !dash) && !g.hasAttribute("stroke-opacity");
      });
      return lines
        .flatMap((g) => [...g.querySelectorAll("path")])
        .flatMap((path) => path.getAttribute("d").slice(1).split(/[LM]/))
        .map((text) => text.split(",").map(Number))
        .map(([px, py]) => [x.invert(px), y.invert(py)]);
    },
    [figure, isDashed],
  );
}

const legend = (page, figure) => page.locator(`[data-figure^=${figure}] [data-mark=legend]`).textContent();

test("the page of a map with branches", async (t) => {
  const folder = folderOf(t),
    file = join(folder, "stops.h5");
  frahm(["run", study("machine_on_stops"), "-o", file, "--progress", "none"]);
  frahm(["report", file]);
  const { page, complaints } = await open(t, join(folder, "stops.html"));

  await t.test("draws what is unstable dashed, from fold to fold", async () => {
    const dashed = await drawn(page, "curves_", true);
    const at = dashed.map(([x]) => x);
    assert.ok(dashed.length > 20, `${dashed.length} points`);
    assert.ok(Math.abs(Math.max(...at) - folds[0]) < 1e-3 && Math.abs(Math.min(...at) - folds[1]) < 1e-3);
    const solid = await drawn(page, "curves_", false);
    assert.ok(Math.max(...solid.map(([, y]) => y)) > 4.9);
    assert.match(await legend(page, "curves_"), /unstable.*fold.*grazing/);
  });

  await t.test("gives each branch as columns", async () => {
    const { text } = await saved(page, page.locator("[data-figure^=curves_] .save-csv"));
    const special = csvRows(text).filter((row) => row["special of branch 1"] === "fold");
    special.forEach((row, i) => assert.ok(Math.abs(Number(row["r of branch 1"]) - folds[i]) < 1e-8));
    assert.equal(special.length, 2);
    assert.ok(csvRows(text).some((row) => row["stability of branch 1"] === "unstable"));
  });

  assert.deepEqual(await badLabels(page), []);
  await photographed(page, "branches");

  await t.test("leaves them out at a click", async () => {
    await page.locator("label", { hasText: "branches" }).locator("input").uncheck();
    await page.waitForFunction(
      () => !document.querySelector("[data-figure^=curves_] svg").textContent.includes("unstable"),
    );
    assert.deepEqual(await drawn(page, "curves_", true), []);
  });
  assert.deepEqual(complaints, []);
});

test("the page of one branch, and its figures without a browser", async (t) => {
  const folder = folderOf(t),
    file = join(folder, "one.h5");
  frahm(["branch", study("machine_on_stops"), "--along", "r", "-o", file, "--progress", "none"]);
  frahm(["report", file]);
  const { page, complaints } = await open(t, join(folder, "one.html"));
  assert.ok((await drawn(page, "branches_", true)).length > 20);
  assert.match(
    await page.locator("section", { hasText: "Special points" }).locator("table").textContent(),
    /fold2\.00180666/,
  );
  assert.deepEqual(await badLabels(page), []);
  assert.deepEqual(complaints, []);
  frahm(["report", file, "--figures", folder]);
  const names = readdirSync(folder).filter((name) => name.endsWith(".svg"));
  assert.ok(names.includes("branches_machine_peak.svg"), names.join());
  assert.match(readFileSync(join(folder, "branches_machine_peak.svg"), "utf8"), /unstable/);
  assert.ok(existsSync(join(folder, "branches_machine_peak.csv")));
});
