// What an identification's page says of its estimates.
import assert from "node:assert/strict";
import { test } from "node:test";
import {
  certainty,
  closePairs,
  hasFreedom,
  identificationOf,
  residualRms,
} from "../../../results/report/page/identification.js";
import {
  correlationText,
  estimateText,
  noteSentence,
  outcomeWarning,
  whatItMeans,
} from "../../../results/report/page/identification_words.js";
import { sampleGroup, sampleRecord } from "./sample_record.mjs";

const estimate = (value, low, high, unit = "N") => ({ name: "d", unit, value, low, high });

function identified(columns = {}, outcome = 1) {
  const texts = { method: "grey_box", estimates: "c d", records: "run run_2", notes: "one\ntwo" };
  return identificationOf(
    sampleRecord({
      identification: sampleGroup(
        texts,
        {
          c: ["N s m-1", "", 26.5],
          c_low: ["N s m-1", "", -1],
          c_high: ["N s m-1", "", 54],
          c_standard_error: ["N s m-1", "", 13],
          d: ["N", "", 15],
          d_low: ["N", "", 14],
          d_high: ["N", "", 16],
          d_standard_error: ["N", "", 0.5],
          c_correlation: ["1", "estimate", [1, -0.99]],
          d_correlation: ["1", "estimate", [-0.99, 1]],
          nrmse: ["percent", "record", [99.5, 98]],
          run_time: ["s", "run_time", [0, 1, 2]],
          run_2_time: ["s", "run_2_time", [0, 1, 2]],
          run_x_measured: ["m", "run_time", [1, 2, 3]],
          run_x_fitted: ["m", "run_time", [1, 1, 1]],
          run_x_residual: ["m", "run_time", [0, 1, 2]],
          run_x_nrmse: ["percent", "", 99.5],
          run_2_x_measured: ["m", "run_2_time", [3, 4, NaN]],
          run_2_x_fitted: ["m", "run_2_time", [0, 0, 0]],
          run_2_x_residual: ["m", "run_2_time", [3, 4, NaN]],
          run_2_x_nrmse: ["percent", "", 98],
          ...columns,
        },
        { outcome: ["", outcome, ["not_computed", "converged", "not_converged"]] },
      ),
    }),
  );
}

test("an estimate is told with its interval in one unit", () => {
  assert.equal(estimateText(estimate(0.001, 0.0009, 0.0011, "m")), "1 mm (95 %: 0.9 to 1.1)");
});

test("what the data do not determine is said so", () => {
  assert.equal(certainty(estimate(1, -Infinity, Infinity)), "undetermined");
  assert.equal(certainty(estimate(NaN, NaN, NaN)), "undetermined");
  assert.equal(certainty(estimate(1, NaN, NaN)), "untold");
  assert.equal(certainty(estimate(1, 0, 2)), "determined");
  assert.match(estimateText(estimate(1, -Infinity, Infinity)), /do not determine/);
  assert.match(estimateText(estimate(1, NaN, NaN)), /no more data than unknowns/);
});

test("series go to the record whose name is longest", () => {
  const { series } = identified();
  assert.deepEqual(
    series.map(({ record, quantity, over }) => [record, quantity, over]),
    [
      ["run", "x", "time"],
      ["run_2", "x", "time"],
    ],
  );
  assert.equal(residualRms(series[1]), Math.sqrt(12.5));
});

test("the closest pair and what is not told from zero are named", () => {
  const found = identified();
  assert.deepEqual(closePairs(found, 0.95), [{ a: "c", b: "d", value: -0.99 }]);
  assert.deepEqual(closePairs(found, 0.995), []);
  const text = whatItMeans(found).flat().join(" ");
  assert.match(text, /c = 26\.5 N s\/m \(95 %: −1 to 54\); d = 15 N \(95 %: 14 to 16\)/);
  assert.match(text, /99\.5 % of run, 98 % of run 2/);
  assert.match(text, /Not distinguished from zero at 95 %: c\./);
  assert.match(text, /The data hardly distinguish c and d \(correlation −0\.99\)\./);
});

test("a fit that did not converge warns, and notes are kept line by line", () => {
  assert.equal(outcomeWarning(identified()), "");
  assert.match(outcomeWarning(identified({}, 2)), /did not converge/);
  assert.deepEqual(identified().notes, ["one", "two"]);
});

test("estimates that follow from others are left out of the pairs, those told twice do not hide them", () => {
  const names = ["slope", "damping_ratio", "damping", "friction_force", "friction_force_line"];
  const signs = [1, 1, 1, -1, -1];
  const estimates = names.map((name, i) => ({
    name,
    correlation: names.map((other, j) => ({ with: other, value: signs[i] === signs[j] ? 1 : -0.987 })),
  }));
  assert.deepEqual(closePairs({ method: "forced_resonance", estimates }, 0.95), [
    { a: "damping", b: "friction_force", value: -0.987 },
  ]);
  assert.deepEqual(closePairs({ method: "hysteresis_loop", estimates }, 0.95), []);
  assert.equal(closePairs({ method: "grey_box", estimates }, 0.95).length, 10);
});

test("an interval narrower than the digits shown is told by its half-width, and the value by as many as it needs", () => {
  const x0 = estimate(0.030001854909, 0.029994313909, 0.030009395909, "m");
  assert.equal(estimateText(x0), "30.0019 mm (95 %: ±0.0075)");
  assert.equal(estimateText(estimate(26.51, 26.42, 26.6)), "26.51 N (95 %: 26.42 to 26.6)");
  assert.match(estimateText(estimate(2, 2 - 1e-15, 2 + 1e-15)), /^2 N \(95 %: only rounding\)/);
});

test("correlations near one have the digits that tell them from it, rounding is zero", () => {
  assert.equal(correlationText(0.99996), "0.99996");
  assert.equal(correlationText(-0.98713), "−0.9871");
  assert.equal(correlationText(1), "1");
  assert.equal(correlationText(-3.51e-14), "0");
});

test("a record of no more data than unknowns does not count as reproduced", () => {
  const two = identified({ run_x_measured: ["m", "run_time", [1, 2]] });
  assert.equal(hasFreedom(two, "run"), false);
  assert.match(whatItMeans(two).flat().join(" "), /The model reproduces 98 % of run 2 \(/);
});

test("what is not determined by the data is said in a whole sentence", () => {
  const text = whatItMeans(identified({ c: ["N s m-1", "", NaN] }))
    .flat()
    .join(" ");
  assert.match(text, /c is not determined by the data; d = 15 N/);
});

test("a note is a sentence of plain text, and a name that it begins with keeps its letters", () => {
  assert.equal(noteSentence("over 5 cycles, 11 extremes"), "Over 5 cycles, 11 extremes.");
  assert.equal(noteSentence("`k` is held by its upper bound"), "Estimate k is held by its upper bound.");
  assert.equal(noteSentence("is the sign right?"), "Is the sign right?");
});
