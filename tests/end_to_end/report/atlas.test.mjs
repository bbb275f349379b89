// The page of the rig atlas: sliders, a click, numbers, exports, sizes.
import assert from "node:assert/strict";
import { statSync } from "node:fs";
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
  saved,
  stored,
  study,
} from "./page.mjs";

const mostBytes = 6e6;

test("the page of the full rig atlas", async (t) => {
  const folder = folderOf(t),
    file = join(folder, "rig_atlas.h5"),
    html = join(folder, "rig_atlas.html");
  frahm(["run", study("rig_atlas"), "-o", file, "--progress", "none"]);
  frahm(["report", file]);
  const { page, complaints } = await open(t, html);

  await t.test("is small enough to send", () => {
    assert.ok(statSync(html).size < mostBytes, `${statSync(html).size} bytes`);
  });

  await t.test("moves its map and its curve with the slider", async () => {
    const before = await page.locator("[data-figure=map_main_peak] image").first().getAttribute("href");
    const title = await page.locator("[data-figure=map_main_peak] h3").textContent();
    await page.locator("input[data-axis=FP]").fill("3");
    await page.waitForFunction(
      (old) => document.querySelector("[data-figure=map_main_peak] image").getAttribute("href") !== old,
      before,
    );
    assert.match(await page.locator("[data-figure=map_main_peak] h3").textContent(), /FP = 0\.03$/);
    assert.notEqual(title, await page.locator("[data-figure=map_main_peak] h3").textContent());
  });

  await t.test("shows the stored numbers of a point that is clicked", async () => {
    const frame = await page.evaluate(() => {
      document.querySelector("[data-figure=map_main_peak]").scrollIntoView({ block: "end" });
      const svg = document.querySelector("[data-figure=map_main_peak] svg");
      const box = svg.getBoundingClientRect(),
        x = svg.scale("x").apply(250),
        y = svg.scale("y").apply(4.72);
      const scale = box.width / svg.viewBox.baseVal.width;
      return { x: box.left + scale * x, y: box.top + scale * y - 3 };
    });
    await page.mouse.click(frame.x, frame.y);
    await page.waitForFunction(() => document.querySelector("#point h3").textContent.includes("I = 4.72 kg"));
    const heading = await page.locator("#point h3").textContent();
    assert.match(heading, /I = 4\.72 kg, FP = 0\.03, ω = 250 rpm/);
    const at = [0, 3, 200];
    for (const name of ["main_peak", "tmd_peak", "tmd_spring_stroke"]) {
      const shown = Number(
        await page
          .locator("#point tr", { hasText: name.replaceAll("_", " ") })
          .locator("td.number")
          .first()
          .textContent(),
      );
      const value = stored(file, name, at);
      assert.ok(isTold(shown, value), `${name}: ${shown} is shown, ${value} is stored`);
    }
    const command = await page.locator("#point code").textContent();
    const json = frahm([
      "point",
      study("rig_atlas"),
      ...command
        .replaceAll("'", "")
        .split(/ (?=--at)/)[1]
        .split(/(?<=--at) /),
      "--json",
    ]);
    assert.ok(
      Math.abs(JSON.parse(json).quantities.main_peak.value - stored(file, "main_peak", at)) < 1e-9,
      command,
    );
  });

  await t.test("keeps several curves and colours them by regime", async () => {
    await page.locator("#keep").click();
    await page.locator("input[data-axis=FP]").fill("28");
    await page.locator("label", { hasText: "colour by regime" }).locator("input").check();
    await page.waitForFunction(() =>
      document
        .querySelector("[data-figure=curves_main_peak] [data-mark=legend]")
        ?.textContent.includes("non stop"),
    );
    await page.locator("label", { hasText: "scale" }).locator("select").selectOption("dB");
    await page.waitForFunction(() =>
      document.querySelector("[data-figure=curves_main_peak] svg").textContent.includes("dB re 1 m"),
    );
  });

  await t.test("exports a figure as SVG and its numbers as CSV", async () => {
    const card = page.locator("[data-figure=map_main_peak]");
    const svg = await saved(page, card.locator(".save-svg"));
    assert.equal(svg.name, "map_main_peak.svg");
    for (const part of ["<title>", "rpm", "(kg)", "data:image/png"])
      assert.ok(svg.text.includes(part), `no ${part} in the SVG`);
    const wellFormed = await page.evaluate(
      (text) => new DOMParser().parseFromString(text, "image/svg+xml").querySelector("parsererror") === null,
      svg.text,
    );
    assert.ok(wellFormed);
    const csv = await saved(page, card.locator(".save-csv"));
    const rows = csvRows(csv.text);
    assert.equal(rows.length, 42 * 401);
    const row = rows.find((one) => one["omega [rpm]"] === "250" && Number(one["I [kg]"]) === 4.72);
    assert.ok(isTold(Number(row["main_peak [m]"]), stored(file, "main_peak", [0, 28, 200])));
  });

  await t.test("is as well light on dark", async () => {
    const lightness = (selector, property) =>
      page.evaluate(
        ([found, what]) => Number(/\d+/.exec(getComputedStyle(document.querySelector(found))[what])[0]) / 255,
        [selector, property],
      );
    await page.emulateMedia({ colorScheme: "dark" });
    assert.ok((await lightness("body", "backgroundColor")) < 0.3);
    assert.ok((await lightness("#point td", "color")) > 0.7);
    assert.ok((await lightness("[data-figure=map_main_peak] [data-mark='x-axis label'] text", "fill")) > 0.7);
    assert.deepEqual(await badLabels(page), []);
    await page.emulateMedia({ colorScheme: "light" });
  });

  await t.test(
    "shows words, counts and signed numbers on linear scales, whatever was asked for",
    async () => {
      await page
        .locator("label", { hasText: "quantity" })
        .first()
        .locator("select")
        .selectOption("tmd_friction_stops");
      await page.locator("label", { hasText: "colours" }).locator("select").selectOption("log");
      await page.waitForFunction(() =>
        document.querySelector("[data-figure^=map_] h3").textContent.startsWith("Number of stops of"),
      );
      const figure = page.locator("[data-figure^=map_]");
      assert.match(await figure.locator("[data-mark='colour scale']").textContent(), /^0/);
      await page
        .locator("label", { hasText: "quantity" })
        .first()
        .locator("select")
        .selectOption("tmd_friction_regime");
      await page.waitForFunction(
        () =>
          document.querySelector("[data-figure^=curves_]").textContent.includes("one stop") &&
          !document.querySelector("[data-figure^=curves_] svg").textContent.includes("dB"),
      );
      const csv = await saved(page, figure.locator(".save-csv"));
      assert.ok(csvRows(csv.text).every((row) => /^(non_stop|one_stop)$/.test(row.tmd_friction_regime)));
      await page
        .locator("label", { hasText: "quantity" })
        .first()
        .locator("select")
        .selectOption("main_peak");
    },
  );

  await t.test("reads as well on a phone, on a laptop and on paper", async () => {
    assert.deepEqual(await badLabels(page), []);
    await photographed(page, "atlas");
  });

  assert.deepEqual(complaints, []);
});
