// Pages of motions under records and of samples: what drives a motion, the records' names, the spread of samples.
import assert from "node:assert/strict";
import { copyFileSync, existsSync, readFileSync, writeFileSync } from "node:fs";
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

const figure = (page, name) => page.locator(`[data-figure=${name}]`);

// The longest text of a cell in a table of the page.
function longestCell(page) {
  return page.evaluate(() =>
    Math.max(
      ...[...document.querySelectorAll("main section")]
        .filter((part) => part.querySelector("h2").textContent !== "Provenance")
        .flatMap((part) => [...part.querySelectorAll("td")].map((cell) => cell.textContent.length)),
    ),
  );
}

async function checked(page, complaints, name) {
  for (const width of [1280, 390]) {
    await page.setViewportSize({ width, height: 800 });
    await page.waitForTimeout(300);
    assert.deepEqual(await badLabels(page), [], `${width} wide`);
  }
  assert.ok((await longestCell(page)) <= 200);
  const unnamed = await page.evaluate(
    () =>
      [...document.querySelectorAll(".plot > svg")].filter((svg) => !svg.getAttribute("aria-label")).length,
  );
  assert.equal(unnamed, 0, "figures without a name for who cannot see them");
  await photographed(page, name);
  assert.deepEqual(complaints, []);
}

test("the record stands above the motion it drives, on the same axis of time", async (t) => {
  const folder = folderOf(t),
    file = join(folder, "quake.h5");
  frahm(["run", study("quake_frame"), "-o", file, "--progress", "none"]);
  frahm(["report", file]);
  const { page, complaints } = await open(t, join(folder, "quake.html"));
  const record = figure(page, "base_recorded_acceleration");
  const ends = await page.evaluate(() =>
    ["base_recorded_acceleration", "displacement"].map(
      (name) => document.querySelector(`[data-figure=${name}] svg`).scale("x").domain,
    ),
  );
  assert.deepEqual(ends[0], ends[1]);
  assert.ok((await record.boundingBox()).y < (await figure(page, "displacement").boundingBox()).y);
  const rows = csvRows((await saved(page, record.locator(".save-csv"))).text);
  const peak = Math.max(...rows.map((row) => Math.abs(Number(row["base_recorded_acceleration [m s-2]"]))));
  assert.ok(Math.abs(peak - 0.319 * 9.80665) < 1e-3, `${peak}`); // as synthetic_quake.csv says
  await checked(page, complaints, "quake_frame");
});

const overRecords = `
[study]
schema = 1
kind = "transient"
title = "own"
[parameters]
c = { value = 300, unit = "N s/m" }
[[mass]]
name = "roof"
mass = 1000
[[element]]
name = "columns"
type = "spring"
between = ["base", "roof"]
stiffness = 1.6e5
[[element]]
name = "damper"
type = "damper"
between = ["base", "roof"]
damping = "c"
[[excitation.record]]
acceleration_of = "base"
unit = "m/s^2"
[transient]
duration = 4
[[axis]]
records = ["a_quiet_day.csv", "a_loud_day.csv", "a_middling_day_with_a_very_long_name.csv"]
[[axis]]
parameter = "c"
unit = "N s/m"
from = 300
to = 3000
points = 5
[output]
quantities = ["columns_stroke", "status"]
`;

test("a map over records has their names, and the largest and the mean of all", async (t) => {
  const folder = folderOf(t),
    text = join(folder, "own.toml"),
    file = join(folder, "own.h5");
  writeFileSync(text, overRecords);
  const push = [1, 4, 2]; // one record is a multiple of the other, and so is what it does
  ["a_quiet_day", "a_loud_day", "a_middling_day_with_a_very_long_name"].forEach((name, i) =>
    writeFileSync(join(folder, `${name}.csv`), `time,acceleration\n0,0\n0.2,${push[i]}\n0.4,0\n2,0\n`),
  );
  frahm(["run", text, "-o", file, "--progress", "none"]);
  frahm(["report", file]);
  const { page, complaints } = await open(t, join(folder, "own.html"));
  const labels = await figure(page, "map_columns_stroke").locator("svg").first().textContent();
  assert.match(labels, /a_quiet_day/);
  assert.match(labels, /a_middling_\u2026/);
  const row = page.locator("#records tbody tr", { hasText: "columns stroke" });
  const cells = await row.locator("td").allTextContents();
  const middle = [0, 1, 2].map((record) => stored(file, "columns_stroke", [record, 2]));
  assert.ok(isTold(Number(cells[2]), middle[1]) && cells[3].includes("a_loud_day"), cells.join());
  assert.ok(isTold(Number(cells[4]), (middle[1] * 7) / 12), cells.join());
  const rows = csvRows((await saved(page, figure(page, "records_columns_stroke").locator(".save-csv"))).text);
  rows.forEach((each, i) => {
    const mean = Number(each["columns_stroke mean [m]"]);
    assert.ok(isTold(mean, (stored(file, "columns_stroke", [1, i]) * 7) / 12), `${mean}`);
  });
  assert.match(await page.locator("#point code").textContent(), /record=1,c=/);
  await page.locator("label", { hasText: "along" }).locator("select").first().selectOption("0:0");
  await page.waitForFunction(() =>
    document.querySelector("[data-figure=curves_columns_stroke] svg").textContent.includes("a_loud_day"),
  );
  await checked(page, complaints, "over_records");
});

test("samples have quantile bands, a histogram and a tornado", async (t) => {
  const folder = folderOf(t),
    text = join(folder, "few.toml"),
    file = join(folder, "few.h5");
  copyFileSync(study("absorber_scatter"), text);
  writeFileSync(text, readFileSync(text, "utf8").replace("points = 121", "points = 13"));
  frahm(["run", text, "-o", file, "--progress", "none"]);
  frahm(["report", file]);
  const { page, complaints } = await open(t, join(folder, "few.html"));
  const csvOf = async (name) => csvRows((await saved(page, figure(page, name).locator(".save-csv"))).text);

  const bands = await csvOf("quantiles_machine_peak");
  bands.forEach((row, i) => {
    for (const name of ["machine_peak_q5", "machine_peak_q50_low", "machine_peak_q95_high"])
      assert.equal(Number(row[name]), stored(file, `statistics/${name}`, [i]));
  });
  const legend = await figure(page, "quantiles_machine_peak").locator("[data-mark=legend]").textContent();
  assert.match(legend, /median.*5 % to 95 %.*95 % interval/);

  const bins = await csvOf("histogram_machine_peak");
  assert.equal(
    bins.reduce((sum, row) => sum + Number(row.samples), 0),
    1000,
  );
  const worst = bands.reduce(
    (best, row, i) => (Number(row.machine_peak_q95) > Number(bands[best].machine_peak_q95) ? i : best),
    0,
  );
  const tornado = await csvOf("tornado_machine_peak");
  assert.deepEqual(
    tornado.map(({ name }) => name),
    ["\u03bd", "\u03b6"], // what changes most comes first
  );
  const change = stored(file, "tornado/machine_peak_by_nu", [worst]);
  assert.equal(Number(tornado[0]["change of machine peak"]), change);
  const cells = await page
    .locator("section", { hasText: "Scatter" })
    .first()
    .locator("tbody tr")
    .first()
    .locator("td")
    .allTextContents();
  assert.ok(
    isTold(Number.parseFloat(cells.at(-1)), stored(file, "statistics/machine_peak_q95", [worst])),
    cells.join(),
  );

  await page
    .locator("label", { hasText: "quantity shown" })
    .locator("select")
    .selectOption("absorber_spring_stroke");
  await page.waitForFunction(() =>
    document.querySelector("section").textContent.includes("have absorber spring stroke below"),
  );
  await checked(page, complaints, "scatter");

  frahm(["report", file, "--figures", folder]);
  for (const name of ["quantiles", "histogram", "tornado"])
    assert.ok(
      existsSync(join(folder, `${name}_machine_peak.svg`)) &&
        existsSync(join(folder, `${name}_machine_peak.csv`)),
      name,
    );
});
