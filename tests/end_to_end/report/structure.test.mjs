// The page and the figures of a building: profiles over its height, mode shapes, short lists of many quantities.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import {
  badLabels,
  csvRows,
  folderOf,
  frahm,
  isTold,
  open,
  photographed,
  recordOf,
  saved,
  stored,
  study,
} from "./page.mjs";

const storeys = 20;

test("a building is shown over its height", async (t) => {
  const folder = folderOf(t),
    file = join(folder, "building.h5");
  frahm(["run", study("twenty_storeys"), "-o", file, "--progress", "none"]);
  frahm(["report", file]);
  const { page, complaints } = await open(t, join(folder, "building.html"));
  // A column of values is named by its point, in quotes.
  const csvOf = async (figure) => {
    const { text } = await saved(page, page.locator(`[data-figure=${figure}] .save-csv`));
    return csvRows(text.replaceAll(/"[^"]*"/g, "value"));
  };

  await t.test("the profile has the stored peaks of the chosen point, and follows it", async () => {
    for (const [r, F] of [
      [30, 1],
      [6, 0],
    ]) {
      await page.evaluate(
        ([i, j]) => {
          const svg = document.querySelector("[data-figure^=map_] svg");
          const box = svg.getBoundingClientRect(),
            scale = box.width / svg.viewBox.baseVal.width;
          const x = box.left + scale * svg.scale("x").apply(0.04 + 0.006 * i),
            y = box.top + scale * svg.scale("y").apply([0.02, 0.1, 0.5][j]);
          svg.parentElement.dispatchEvent(new MouseEvent("click", { clientX: x, clientY: y, bubbles: true }));
        },
        [r, F],
      );
      await page.waitForTimeout(200);
      const peaks = await csvOf("profile_peak"),
        drifts = await csvOf("profile_drift");
      assert.equal(peaks.length, storeys);
      assert.equal(drifts.length, storeys);
      for (const floor of [1, 7, 20]) {
        const row = peaks[floor - 1];
        assert.equal(row.mass, `floor${floor}`);
        assert.equal(Number(row.height), floor);
        assert.ok(isTold(Number(row.value), stored(file, `floor${floor}_peak`, [F, r])), row.value);
        const stroke = Number(drifts[floor - 1].value);
        assert.ok(isTold(stroke, stored(file, `columns${floor}_stroke`, [F, r])), `${stroke}`);
      }
    }
  });

  await t.test("a point that is kept stands beside the new one", async () => {
    await page.locator("#keep").click();
    await page.evaluate(() => {
      const plot = document.querySelector("[data-figure^=map_] svg");
      const box = plot.getBoundingClientRect();
      const at = { clientX: box.left + box.width / 2, clientY: box.top + box.height / 4, bubbles: true };
      plot.parentElement.dispatchEvent(new MouseEvent("click", at));
    });
    await page.waitForFunction(
      () => document.querySelectorAll("[data-figure=profile_peak] [data-mark=legend] path").length === 2,
    );
    await page.locator("#clear").click();
  });

  await t.test("the mode shapes are those of the file, those of a uniform chain", async () => {
    const rows = await csvOf("mode_shapes"),
      modes = recordOf(file, "modes");
    assert.equal(rows.length, storeys);
    assert.equal(Object.keys(rows[0]).filter((name) => name.startsWith("mode_")).length, 6);
    assert.equal(Number(rows[4].mode_2), modes.mode_shape_2[4]);
    assert.ok(Math.abs(modes.mode_frequency[0] - 2 * Math.sin(Math.PI / 2 / (2 * storeys + 1))) < 1e-12);
  });

  await t.test("lists and tables are short, and any quantity is found by its name", async () => {
    const quantities = page.locator("label", { hasText: "quantity" }).first().locator("option");
    assert.ok((await quantities.count()) <= 12, `${await quantities.count()} quantities are listed`);
    assert.ok((await page.locator("#point tr").count()) <= 16);
    const field = page.locator("input[type=search]").first();
    await field.fill("floor12 peak");
    await field.dispatchEvent("change");
    await page.waitForFunction(() =>
      document
        .querySelector("[data-figure=map_floor12_peak], [data-figure^=map_] h3")
        ?.textContent.includes("floor12"),
    );
    assert.ok((await page.locator("#point").textContent()).includes("floor12 peak"));
  });

  for (const width of [1280, 390]) {
    await page.setViewportSize({ width, height: 800 });
    await page.waitForTimeout(300);
    assert.deepEqual(await badLabels(page), [], `${width} wide`);
  }
  await photographed(page, "twenty_storeys");
  assert.deepEqual(complaints, []);
});

test("the figures for papers have the profiles of the worst points and the mode shapes", (t) => {
  const folder = folderOf(t),
    file = join(folder, "building.h5");
  frahm(["run", study("twenty_storeys"), "-o", file, "--progress", "none"]);
  const names = frahm(["report", file, "--figures", folder]);
  for (const name of ["profile_peak", "profile_drift", "mode_shapes"]) {
    assert.ok(names.includes(name), names);
    assert.doesNotMatch(readFileSync(join(folder, `${name}.svg`), "utf8"), /NaN|undefined|Infinity/, name);
  }
  assert.ok(!names.includes("floor12"), "only the ends of the profile have figures of their own");
  const rows = csvRows(readFileSync(join(folder, "profile_peak.csv"), "utf8").replaceAll(/"[^"]*"/g, "peak"));
  assert.equal(rows.length, storeys);
});

test("a part of a building is chosen and given its heights", (t) => {
  const folder = folderOf(t),
    file = join(folder, "part.h5"),
    text = join(folder, "part.toml");
  const own = readFileSync(study("twenty_storeys"), "utf8");
  writeFileSync(text, own.replace('profile = "floor*"', 'profile = "floor1*"\nheight = 3.5'));
  frahm(["run", text, "-o", file, "--progress", "none"]);
  frahm(["report", file, "--figures", folder]);
  const rows = csvRows(readFileSync(join(folder, "mode_shapes.csv"), "utf8"));
  assert.deepEqual(
    rows.map(({ mass }) => mass),
    ["floor1", ...Array.from({ length: 10 }, (_, i) => `floor${10 + i}`)],
  );
  assert.equal(Number(rows[10].height), 38.5);
});
