// The report of a rig tuning with a schedule: what was gained, the response, the schedule, and their files.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { badLabels, csvRows, folderOf, frahm, open, photographed, saved, stored, study } from "./page.mjs";

test("the report of a tuning", async (t) => {
  const folder = folderOf(t),
    file = join(folder, "tuning.h5");
  frahm(["run", study("tune_rig_schedule"), "-o", file, "--progress", "none"]);
  frahm(["report", file]);
  const { page, complaints } = await open(t, join(folder, "tuning.html"));
  const before = stored(file, "optimum/worst_before"),
    after = stored(file, "optimum/worst_after");

  await t.test("says in percent and dB what was gained", async () => {
    const said = await page.locator("section", { hasText: "What this means" }).first().textContent();
    const percent = Number(/([\d.]+) % less/.exec(said)[1]),
      dB = Number(/[−-]([\d.]+) dB/.exec(said)[1]);
    assert.ok(Math.abs(percent - 100 * (1 - after / before)) < 0.06, `${percent} %`);
    assert.ok(Math.abs(dB - 20 * Math.log10(before / after)) < 0.06, `${dB} dB`);
  });

  await t.test("shows the objective as the file has it", async () => {
    const row = await page.locator("tr", { hasText: "worst main peak" }).last().textContent();
    const shown = Number(/([\d.]+) mm/.exec(row)[1]);
    assert.ok(Math.abs(shown * 1e-3 - stored(file, "optimum/objective")) < 1e-8, row);
  });

  await t.test("exports the response and the schedule", async () => {
    const cards = page.locator("figure.card");
    const names = await cards.evaluateAll((all) => all.map((card) => card.dataset.figure));
    const response = cards.nth(names.findIndex((name) => name.includes("response")));
    const rows = csvRows((await saved(page, response.locator(".save-csv"))).text);
    const largest = Math.max(
      ...rows.flatMap((row) =>
        Object.entries(row)
          .filter(([name]) => name.startsWith("response_after"))
          .map(([, value]) => Number(value)),
      ),
    );
    assert.ok(Math.abs(largest - after) < 1e-9 * after + 1e-12, `${largest} and ${after}`);
    const schedule = cards.nth(names.findIndex((name) => name.includes("schedule")));
    const svg = (await saved(page, schedule.locator(".save-svg"))).text;
    for (const words of ["rad/s", "(kg)", "<title>"])
      assert.ok(svg.includes(words), `no ${words} in the SVG`);
  });

  assert.deepEqual(await badLabels(page), []);
  await photographed(page, "tuning");
  assert.deepEqual(complaints, []);
});

// A trade-off whose last limit no design keeps.
const tradeOff = `
[study]
schema = 1
kind = "tune"
title = "trade-off with an end that no design keeps"
units = "SI"
[parameters]
omega = { value = 50, unit = "rad/s" }
kt = { value = 10, unit = "kN/m" }
ct = { value = 60, unit = "N s/m" }
[[mass]]
name = "main"
mass = 100
[[mass]]
name = "tmd"
mass = 5
[[element]]
name = "ms"
type = "spring"
between = ["ground", "main"]
stiffness = 250000
[[element]]
name = "ts"
type = "spring"
between = ["main", "tmd"]
stiffness = "kt"
[[element]]
name = "td"
type = "damper"
between = ["main", "tmd"]
damping = "ct"
[excitation]
frequency = "omega"
[[excitation.force]]
on = "main"
amplitude = 100
[tune]
objective = "minimax"
quantity = "main_peak"
band = { parameter = "omega", from = 20, to = 90 }
trade_off = { quantity = "ts_stroke", values = [20, 10, 4], unit = "mm" }
[[design]]
parameter = "kt"
lower = 3
upper = 30
unit = "kN/m"
[[design]]
parameter = "ct"
lower = 1
upper = 500
`;

test("a front tells what keeps its limit from what does not", async (t) => {
  const folder = folderOf(t),
    file = join(folder, "front.h5");
  writeFileSync(join(folder, "front.toml"), tradeOff);
  const noOptimum = 7;
  frahm(["run", join(folder, "front.toml"), "-o", file, "--progress", "none"], { code: noOptimum });
  frahm(["report", file, "--figures", folder]);
  const rows = csvRows(readFileSync(join(folder, "front.csv"), "utf8"));
  assert.deepEqual(
    rows.map((row) => [Number(row["ts_stroke_limit [mm]"]), row.outcome]),
    [
      [4, "infeasible"],
      [10, "converged"],
      [20, "converged"],
    ],
  );
  assert.ok(Number(rows[0].violation) > 1);
  assert.equal(Number(rows[2]["objective [m]"]), stored(file, "optimum/front/objective", [0]));
  frahm(["report", file]);
  const { page, complaints } = await open(t, join(folder, "front.html"));
  const gap = page.locator("tr", { hasText: "certificate gap" }).last().locator("td").last();
  assert.equal(await gap.textContent(), "–");
  assert.deepEqual(complaints, []);
});

test("a tuning with friction says for which excitation it holds, one without does not", async (t) => {
  const folder = folderOf(t);
  const wordsOf = async (name) => {
    const file = join(folder, `${name}.h5`);
    frahm(["run", study(name), "-o", file, "--progress", "none"]);
    frahm(["report", file]);
    const { page } = await open(t, join(folder, `${name}.html`));
    return page.locator("main section", { hasText: "What this means" }).first().textContent();
  };
  assert.match(
    await wordsOf("tune_friction_absorber"),
    /holds for this excitation: force on main, 1\. Friction, stops/,
  );
  assert.match(
    await wordsOf("tune_rig_stiffness_damping"),
    /holds for this excitation: motion of \w+, [\d.]+ m/,
  );
  assert.doesNotMatch(await wordsOf("tune_classical"), /holds for this excitation/);
});

test("a tuning with friction lists the excitation of each scenario where these differ in it", async (t) => {
  const folder = folderOf(t),
    text = readFileSync(study("tune_friction_absorber"), "utf8");
  const pageOf = async (name, scenarios) => {
    const file = join(folder, `${name}.toml`);
    const driven = text
      .replace("amplitude = 1.0", 'amplitude = "P"')
      .replace("[parameters]", "[parameters]\nP = 1.0");
    writeFileSync(
      file,
      driven + scenarios.map((set, i) => `\n[[scenario]]\nname = "s${i}"\nset = ${set}\n`).join(""),
    );
    frahm(["run", file, "-o", join(folder, `${name}.h5`), "--progress", "none"]);
    frahm(["report", join(folder, `${name}.h5`)]);
    return (await open(t, join(folder, `${name}.html`))).page;
  };
  const differing = await pageOf("differing", ["{ P = 0.8 }", "{ P = 1.2 }"]);
  const said = (page) => page.locator("main section", { hasText: "What this means" }).first().textContent();
  assert.match(
    await said(differing),
    /holds for the excitations of its 2 scenarios, which are listed below\. Friction/,
  );
  const rows = differing.locator("table", { hasText: "excitation for which it holds" }).locator("tbody tr");
  assert.deepEqual(await rows.allTextContents(), ["s0force on main, 0.8", "s1force on main, 1.2"]);
  const same = await pageOf("same", ["{ P = 2, mu = 0.05 }", "{ P = 2, mu = 0.06 }"]);
  assert.match(await said(same), /holds for this excitation: force on main, 2\. Friction/);
});

// The house of tune_slip_force in two short earthquakes, from one start.
const overRecords = readFileSync(study("tune_slip_force"), "utf8")
  .replace(/start +=.*/, "")
  .replace("count = 5", "count = 2")
  .replace("duration = 20", "duration = 6")
  .replace("level_end = 10", "level_end = 4")
  .replace("duration  = 22", "duration  = 7");

for (const [kind, how] of [
  ["worst_peak", "Worst drift peak, in the worst of 2 records"],
  ["mean_peak", "Mean drift peak, as the mean of 2 records"],
]) {
  test(`the report of a tuning over records: ${kind}`, async (t) => {
    const folder = folderOf(t),
      file = join(folder, "tuning.h5");
    writeFileSync(join(folder, "tuning.toml"), overRecords.replace("worst_peak", kind));
    frahm(["run", join(folder, "tuning.toml"), "-o", file, "--progress", "none"]);
    frahm(["report", file]);
    const { page, complaints } = await open(t, join(folder, "tuning.html"));
    const said = await page.locator("section", { hasText: "What this means" }).first().textContent();
    assert.ok(said.includes(how), said);
    const [, number, prefix] = /records: ([\d.]+) (m|\u00b5)m\./.exec(said);
    const objective = stored(file, "optimum/objective"),
      shown = Number(number) * (prefix === "m" ? 1e-3 : 1e-6);
    assert.ok(Math.abs(shown - objective) < 1e-3 * objective, `${shown} and ${objective}`);
    const rows = await page.locator("tr", { hasText: "kanai_tajimi" }).count();
    assert.equal(rows, 2);
    assert.deepEqual(await badLabels(page), []);
    assert.deepEqual(complaints, []);
  });
}
