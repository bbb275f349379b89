// Pages of identifications, decays, transients and other tunings: they open without a complaint, at every size, with no
// label cut off or over another.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import {
  badLabels,
  csvRows,
  everyKind,
  folderOf,
  frahm,
  open,
  photographed,
  stored,
  study,
} from "./page.mjs";

const some = [
  { name: "identify_rig_forced", shows: ["Data against model", "NRMSE", "95 % interval"] },
  { name: "rig_decay_main", shows: ["Damping budget", "Turning points of main", "Phase portrait of main"] },
  { name: "rig_forced_250rpm_I6_crank", shows: ["Damping budget", "Crank"] },
  { name: "tune_rig_trade_off", shows: ["What this means"] },
];
const others = [
  { name: "identify_paper_half_power", shows: ["ζ"] },
  { name: "run_up", shows: ["discretisation error of the run"] },
  { name: "tune_h2_support", shows: ["What this means"] },
  { name: "rig_energy_shares", shows: ["Damping budget"] },
  { name: "lecture_hysteretic", shows: ["Resonance"] },
  { name: "shaken_frame", shows: ["floor10 peak", "brace5 slips"] },
];

// Numbers in tables that take more than one line.
function brokenNumbers(page) {
  return page.evaluate(() => {
    const lines = (cell) => {
      const range = document.createRange();
      range.selectNodeContents(cell);
      return new Set([...range.getClientRects()].map(({ bottom }) => Math.round(bottom / 8))).size;
    };
    return [...document.querySelectorAll("td.number")]
      .filter((cell) => cell.checkVisibility() && lines(cell) > 1)
      .map((cell) => cell.textContent);
  });
}

// As a printer on A4 has it: tables that do not fit, and numbers that take more than one line.
async function misprinted(page) {
  await page.setViewportSize({ width: 718, height: 1123 }); // between margins
  await page.emulateMedia({ media: "print" });
  const wide = await page.evaluate(() =>
    [...document.querySelectorAll("main table")]
      .filter((table) => table.getBoundingClientRect().right > window.innerWidth + 1)
      .map((table) => table.textContent.slice(0, 80)),
  );
  const broken = await brokenNumbers(page);
  await page.emulateMedia({ media: "screen" });
  return [...wide, ...broken];
}

for (const { name, shows } of everyKind ? [...some, ...others] : some) {
  test(`the page of ${name}`, async (t) => {
    const folder = folderOf(t),
      file = join(folder, `${name}.h5`);
    frahm(["run", study(name), "-o", file, "--progress", "none"]);
    frahm(["report", file]);
    const { page, complaints } = await open(t, join(folder, `${name}.html`));
    const text = await page.evaluate(() =>
      [...document.querySelectorAll("main section")]
        .filter((part) => part.querySelector("h2").textContent !== "Provenance") // which has the study's own words
        .map((part) => part.textContent)
        .join(),
    );
    for (const words of shows) assert.ok(text.includes(words), `no "${words}" in the page of ${name}`);
    for (const width of [1280, 390]) {
      await page.setViewportSize({ width, height: 800 });
      await page.waitForTimeout(300);
      assert.deepEqual(await badLabels(page), [], `${width} wide`);
      assert.deepEqual(await brokenNumbers(page), [], `${width} wide`);
    }
    assert.deepEqual(await misprinted(page), []);
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
    .locator("tr", { hasText: "all quantities" })
    .first()
    .locator("td.number")
    .first()
    .textContent();
  assert.ok(Math.abs(Number(row) - value) < 1e-4, `${row}, ${value}`);
});

// A free vibration of a study of its own, with its page and figures, in a folder of the test's.
function decayOf(t, { units, masses, elements, initial }) {
  const folder = folderOf(t),
    text = join(folder, "own.toml"),
    file = join(folder, "own.h5");
  const table = (name, entries) =>
    [
      `[[${name}]]`,
      ...Object.entries(entries).map(([key, value]) => `${key} = ${JSON.stringify(value)}`),
    ].join("\n");
  writeFileSync(
    text,
    [
      `[study]\nschema = 1\nkind = "decay"\ntitle = "own"\nunits = "${units}"`,
      ...masses.map((mass) => table("mass", mass)),
      ...elements.map((element) => table("element", element)),
      "[decay]\nsamples = 501",
      table("initial", initial),
    ].join("\n"),
  );
  frahm(["run", text, "-o", file, "--progress", "none"]);
  frahm(["report", file, "--figures", folder]);
  frahm(["report", file]);
  return folder;
}

test("a dimensionless decay has no unit, on its page and in its files", async (t) => {
  const folder = decayOf(t, {
    units: "dimensionless",
    masses: [{ name: "M", mass: 2.5 }],
    elements: [
      { name: "spring", type: "spring", between: ["ground", "M"], stiffness: 1000 },
      { name: "damper", type: "damper", between: ["ground", "M"], damping: 5 },
    ],
    initial: { node: "M", displacement: 20 },
  });
  assert.deepEqual(Object.keys(csvRows(readFileSync(join(folder, "dissipation.csv"), "utf8"))[0]), [
    "time",
    "damper_dissipated",
  ]);
  const { page } = await open(t, join(folder, "own.html"));
  const text = await page.locator("main section", { hasText: "What this means" }).first().textContent();
  assert.match(text, /Of the 200000 dissipated, 100 % in damper/);
  const labels = await page.locator(".plot svg").allTextContents();
  assert.ok(!labels.some((label) => /\((s|k?J|m?m|m\/s)\)/.test(label)), labels.join("\n"));
});

test("a mass that friction holds has reached its rest while another swings on", async (t) => {
  const name = "a_rather_long_name_of_a_mass_that_goes_on_and_on";
  const folder = decayOf(t, {
    units: "SI",
    masses: [
      { name, mass: 1 },
      { name: "b", mass: 1 },
    ],
    elements: [
      { name: "s1", type: "spring", between: ["ground", name], stiffness: 400 },
      { name: "s2", type: "spring", between: ["b", name], stiffness: 300 },
      { name: "c2", type: "damper", between: ["b", name], damping: 0.8 },
      { name: "guide", type: "coulomb", between: ["ground", name], force: 3 },
    ],
    initial: { node: "b", displacement: 0.03 },
  });
  const { page } = await open(t, join(folder, "own.html"));
  const text = await page.locator("p.words").first().textContent();
  assert.match(text, /goes on and on turns 3 times.* It reaches its rest position, −2\.822 mm, at 0\.4321 s\. Mass b/);
  assert.match(text, /Mass b .* It tends to −2\.822 mm\./);
  assert.doesNotMatch(text, /decrement|–/);
  for (const width of [1200, 390]) {
    await page.setViewportSize({ width, height: 800 });
    assert.deepEqual(await brokenNumbers(page), [], `${width} wide`);
  }
  assert.deepEqual(await misprinted(page), []);
});
