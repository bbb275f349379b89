// Terminal, file and page say the same of one result: its flags, its counts, and what lies beyond a threshold.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { folderOf, frahm, open, recordOf, study } from "./page.mjs";

const sameToPage = 1e-3; // relative; the page shows four digits in its sentences

// What a run printed, what its file holds and what its page says.
async function resultOf(t, text, { group, code = 0 }) {
  const folder = folderOf(t),
    path = join(folder, "own.toml"),
    file = join(folder, "own.h5");
  writeFileSync(path, text);
  const said = frahm(["run", path, "-o", file, "--progress", "none"], { code });
  frahm(["report", file]);
  const { page, complaints } = await open(t, join(folder, "own.html"));
  assert.deepEqual(complaints, []);
  const rows = await page
    .locator("main tr")
    .evaluateAll((all) => all.map((row) => [...row.cells].map((cell) => cell.textContent)));
  const shown = await page.locator("main").innerText();
  return { said, record: recordOf(file, group), shown, rows };
}

const textOf = (name) => readFileSync(study(name), "utf8");
const row = (rows, name) => rows.find((cells) => cells[0]?.startsWith(name)) ?? [];
const line = (said, name) => said.split("\n").find((each) => each.startsWith(`${name} `)) ?? "";

test("a map: how many points have which status", async (t) => {
  const { said, record, shown } = await resultOf(
    t,
    `[study]
schema = 1
kind = "sweep"
[parameters]
w = 1.0
[[mass]]
name = "m"
mass = 1.0
[[element]]
name = "s"
type = "spring"
between = ["ground", "m"]
stiffness = 1e3
[[element]]
name = "guide"
type = "coulomb"
between = ["ground", "m"]
force = 0.5
[excitation]
frequency = "w"
[[excitation.force]]
on = "m"
amplitude = 1.0
[[axis]]
parameter = "w"
values = [1e-7, 20, 31.622776601683793, 60] # too slow to follow, two answers, driven at resonance
[output]
quantities = ["m_peak", "status"]
`,
    { group: "/", code: 3 },
  );
  const counts = {};
  for (const word of record.status) counts[word] = (counts[word] ?? 0) + 1;
  assert.deepEqual(counts, { failed: 1, ok: 2, unbounded: 1 });
  for (const [word, count] of Object.entries(counts))
    assert.match(line(said, "status"), new RegExp(`${word} ${count} \\(`));
  assert.match(shown, /1 of 4 points failed/);
  assert.match(shown, /1 of 4 points have no bounded response/);
  // A value is missing in all three where the status says so.
  assert.deepEqual(record.m_peak.map(Number.isNaN), [true, false, true, false]);
  assert.equal(said.match(/no value/g).length, 2);
});

test("a tuning: what lies on a bound, whether it converged, its certificate", async (t) => {
  const { said, record, shown, rows } = await resultOf(t, textOf("tune_rig_inertance_stiffness"), {
    group: "optimum",
  });
  assert.equal(record.I_at_bound, "lower");
  assert.match(line(said, "I"), /lower bound/);
  assert.equal(row(rows, "I (kg)").at(-1), "lower bound");
  assert.equal(record.k_at_bound, "no");
  assert.doesNotMatch(line(said, "k"), /bound/);
  assert.equal(row(rows, "k (N/m)").at(-1), "–");
  assert.equal(record.outcome, "converged");
  assert.match(line(said, "outcome"), /^outcome +converged:/);
  assert.equal(row(rows, "outcome").at(-1), "converged");
  // What holds it: a multiplier of the record is not 0, in the terminal and on the page.
  assert.ok(record.I_lower_multiplier > 0 && record.k_lower_multiplier === 0);
  assert.match(line(said, "I"), new RegExp(record.I_lower_multiplier.toPrecision(4)));
  assert.match(shown, /the lower bound of I/);
  assert.doesNotMatch(shown, /bound of k/);
});

test("a tuning that breaks a limit: which, by how much, and no certificate", async (t) => {
  const { said, record, shown, rows } = await resultOf(
    t,
    textOf("tune_classical").replace(
      /\[\[design\]\]/,
      '[[constraint]]\nquantity = "tmd_spring_stroke"\nupper = 5\n[[design]]',
    ),
    { group: "optimum", code: 7 },
  );
  assert.equal(record.outcome, "infeasible");
  assert.match(line(said, "outcome"), /^outcome +infeasible:/);
  assert.equal(row(rows, "outcome").at(-1), "infeasible");
  const excess = (100 * record.tmd_spring_stroke_limit_excess).toPrecision(4);
  assert.ok(record.tmd_spring_stroke_limit_excess > record.tolerance);
  const terminal = Number(/broken by ([\d.]+) %/.exec(line(said, "tmd_spring_stroke"))[1]),
    page = Number(/It breaks the limit of tmd spring stroke, at most [^,]+, by ([\d.]+) %/.exec(shown)[1]);
  for (const percent of [terminal, page])
    assert.ok(Math.abs(percent / excess - 1) < sameToPage, `${percent} % and ${excess} %`);
  // Nothing was pressed towards a bound.
  for (const name of ["certificate_gap", "kkt_residual"]) assert.ok(Number.isNaN(record[name]), name);
  assert.doesNotMatch(said, /certificate gap|KKT residual/);
  assert.equal(row(rows, "certificate gap").at(-1), "–");
  assert.equal(row(rows, "KKT residual").at(-1), "–");
});

test("a decay: that it comes to rest, when and where; what its energy balance is", async (t) => {
  const { said, record, shown } = await resultOf(t, textOf("rig_decay_main"), { group: "decay" });
  assert.ok(Number.isFinite(record.stop_time)); // NaN: it never comes to rest
  const stop = record.stop_time.toPrecision(10);
  assert.match(said, new RegExp(`comes to rest at ${stop} s`));
  assert.match(shown, /Nothing moves after 10\.77 s/);
  assert.match(shown, new RegExp(`all at rest from\\s+${record.stop_time.toPrecision(8)} s`));
  assert.equal(record.main_extremum.length, 82);
  assert.match(said, /main: 82 extrema/);
  assert.match(shown, /Mass main turns 82 times/);
  assert.match(said, /balance to 2\.\de-14/);
  assert.match(shown, /balance closes to 2\.\d×10⁻¹⁴/);
});

test("a transient: its largest displacement and the error of its stairs", async (t) => {
  const { said, record, shown } = await resultOf(t, textOf("run_up"), { group: "transient" });
  const error = record.discretisation_error;
  const terminal = Number(/by more than ([\d.e+-]+) m /.exec(said)[1]),
    page = Number(/discretisation error of the run\s+([\d.]+) nm/.exec(shown)[1]) * 1e-9;
  assert.ok(Math.abs(terminal / error - 1) < 0.02, `${terminal} and ${error}`); // two digits
  assert.ok(Math.abs(page / error - 1) < sameToPage, `${page} and ${error}`);
  assert.match(said, new RegExp(record.machine_peak.toPrecision(10)));
  assert.match(shown, new RegExp(`${(1e3 * record.machine_peak).toPrecision(4)} mm`));
});

test("an identification: its estimates, that it converged, and its notes", async (t) => {
  const folder = folderOf(t),
    file = join(folder, "fit.h5");
  const said = frahm(["run", study("identify_rig_forced"), "-o", file, "--progress", "none"]);
  frahm(["report", file]);
  const { page } = await open(t, join(folder, "fit.html"));
  const record = recordOf(file, "identification"),
    shown = await page.locator("main").innerText();
  assert.equal(record.outcome, "converged");
  assert.match(shown, /method grey box; converged; /);
  for (const name of ["c_const", "c_I", "d"]) {
    const numbers = [record[name], record[`${name}_low`], record[`${name}_high`]];
    for (const number of numbers) {
      const digits = String(Number(number.toPrecision(8)));
      assert.ok(line(said, name).includes(digits), `${digits} in "${line(said, name)}"`);
    }
  }
  assert.match(shown, new RegExp(`d = ${record.d.toPrecision(4)}`));
  const notes = said.split("\n").filter((each) => each.startsWith("note: ")).length;
  assert.equal(await page.locator(".warning").count(), notes);
});
