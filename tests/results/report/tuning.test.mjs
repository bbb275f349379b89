// The numbers behind what a tuning means, against numbers by hand.
import assert from "node:assert/strict";
import { test } from "node:test";
import {
  heldBounds,
  knotsAtBounds,
  rootUnit,
  settlingRounds,
  steepestPieces,
  tuningOf,
} from "../../../results/report/page/tuning.js";
import {
  bandBelowBefore,
  nonNegative,
  reduction,
  whatItMeans,
  worstDetuning,
} from "../../../results/report/page/tuning_words.js";
import { outcomeWarning } from "../../../results/report/page/certificate_words.js";
import { sampleGroup, sampleRecord } from "./sample_record.mjs";

const rounding = 1e-12;
const outcomes = [
  "not_computed",
  "converged",
  "not_converged",
  "infeasible",
  "unbounded",
  "failed",
  "stopped",
];

function close(value, expected, tolerance = rounding) {
  assert.ok(
    Math.abs(value - expected) <= tolerance * Math.max(1, Math.abs(expected)),
    `${value} is not ${expected}`,
  );
}

const ends = ["not_computed", "no", "lower", "upper"];

// Of a tuning that did not converge no multiplier is known.
function minimax(changes = {}, outcome = 1, texts = {}, atBound = [3]) {
  const known = (values) => (outcome === 1 ? values : values.map(() => NaN));
  const group = sampleGroup(
    {
      reason: "because",
      objective_kind: "minimax",
      quantity: "main_peak",
      band_parameter: "omega",
      parameters: "k",
      scenarios: "study",
      limits: "",
      solver: "ipopt",
      start: "given",
      ...texts,
    },
    {
      objective: ["m", "", 0.025],
      certificate_gap: ["1", "", 1e-9],
      kkt_residual: ["1", "", 2e-10],
      tolerance: ["1", "", 1e-6],
      violation: ["1", "", 0],
      best_start: ["1", "", 0],
      k: ["N/m", "", 1000],
      k_lower: ["N/m", "", 500],
      k_upper: ["N/m", "", 1000],
      k_before: ["N/m", "", 800],
      k_lower_multiplier: ["m (N/m)-1", "", known([0])],
      k_upper_multiplier: ["m (N/m)-1", "", known([1e-5])],
      peak_omega: ["rad s-1", "peak", [12, 18]],
      peak_value: ["m", "peak", [0.025, 0.02]],
      peak_multiplier: ["1", "peak", known([1, 0])],
      peak_scenario: ["1", "peak", [0, 0]],
      k_sensitivity: ["m (N/m)-1", "peak", [-1e-5, 2e-5]],
      omega: ["rad s-1", "omega", [10, 12, 14, 16, 20]],
      response_before: ["m", "omega", [0.01, 0.1, 0.02, 0.01, 0.03]],
      response_after: ["m", "omega", [0.012, 0.025, 0.02, 0.015, 0.01]],
      worst_before: ["m", "", 0.1],
      worst_after: ["m", "", 0.025],
      change: ["1", "change", [-0.05, 0.05]],
      k_detuning: ["1", "change", [0.2, -0.01]],
      ...changes,
    },
    { outcome: ["", outcome, outcomes], k_at_bound: ["", atBound, ends] },
  );
  return sampleRecord({ optimum: group });
}

test("a quarter of the peak is 75 percent or 12 dB less", () => {
  const { percent, decibel } = reduction(0.1, 0.025);
  close(percent, 75);
  close(decibel, -12.041199826559248);
});

test("stretches where a line is not negative end where it crosses zero", () => {
  const { intervals, share } = nonNegative([0, 1, 2, 3, 4], [1, -1, -1, 1, 0]);
  assert.deepEqual(intervals, [
    [0, 0.5],
    [2.5, 4],
  ]);
  close(share, 0.5);
});

test("a line that is never negative holds over the whole band, one that always is nowhere", () => {
  assert.deepEqual(nonNegative([0, 1, 2], [0, 0, 3]), { intervals: [[0, 2]], share: 1 });
  assert.deepEqual(nonNegative([0, 1, 2], [-1, -2, -1]), { intervals: [], share: 0 });
});

test("the band below the response before is found between the samples", () => {
  // Differences before - after: -0.002, 0.075, 0, -0.005, 0.02; zeros by hand.
  const { intervals, share } = bandBelowBefore(tuningOf(minimax()));
  const first = 10 + (2 * 0.002) / 0.077,
    last = 16 + (4 * 0.005) / 0.025;
  assert.equal(intervals.length, 2);
  close(intervals[0][0], first, 1e-6);
  close(intervals[0][1], 14, 1e-6);
  close(intervals[1][0], last, 1e-6);
  close(share, (14 - first + 20 - last) / 10, 1e-6);
});

test("in every scenario means in the worst of them", () => {
  const two = minimax(
    {
      response_before_a: ["m", "omega", [1, 1, 1, 1, 1]],
      response_after_a: ["m", "omega", [0.5, 0.5, 0.5, 0.5, 0.5]],
      response_before_b: ["m", "omega", [1, 1, 1, 1, 1]],
      response_after_b: ["m", "omega", [0.5, 0.5, 0.5, 1.5, 1.5]],
    },
    1,
    { scenarios: "a,b" },
  );
  const { intervals, share } = bandBelowBefore(tuningOf(two));
  close(intervals[0][1], 15, 1e-6);
  close(share, 0.5, 1e-6);
});

test("the sentences tell reduction, band, certificate and what determines the design", () => {
  const text = whatItMeans(tuningOf(minimax())).flat().join(" ");
  assert.match(text, /Worst main peak over 10 to 20 rad\/s of ω: 25 mm\./);
  assert.match(text, /Against the design before \(100 mm\): 75 % less \(−12 dB\)\./);
  assert.match(text, /at or below 25 mm over the whole band/);
  assert.match(text, /the worst of them and the bound of the tuning agree to 1×10⁻⁹ \(relative\)/);
  assert.match(text, /held by the peak at 12 rad\/s, share 100 %; the upper bound of k \(moved out by 1 %/);
  assert.match(text, /of the range it gives 0\.2 %, to first order\)/);
  assert.match(text, /off by 5 % makes the worst peak grow by at most 20 % \(k 5 % less\)/);
});

test("a bound that holds gives its multiplier times a hundredth of the range", () => {
  const tuning = tuningOf(minimax());
  const [held, ...others] = heldBounds(tuning, tuning.parameters[0]);
  assert.equal(held.end, "upper");
  assert.equal(others.length, 0);
  close(held.gain, (1e-5 * 5) / 0.025);
});

test("the worst detuning is the largest growth of that change", () => {
  assert.deepEqual(worstDetuning(tuningOf(minimax()), 0.05), { growth: 0.2, name: "k", change: -0.05 });
  assert.equal(worstDetuning(tuningOf(minimax()), 0.1), null);
});

test("knots on a bound are counted", () => {
  const { parameters } = tuningOf(minimax({}, 1, {}, [2, 2, 1, 3]));
  assert.deepEqual(knotsAtBounds(parameters[0]), { lower: [0, 1], upper: [3] });
});

test("of a mean square the words are of roots, and the decibels of amplitudes", () => {
  const record = minimax(
    { objective: ["(m)2", "", 4e-6], worst_before: ["(m)2", "", 16e-6], worst_after: ["(m)2", "", 4e-6] },
    1,
    { objective_kind: "mean_square" },
  );
  const text = whatItMeans(tuningOf(record)).flat().join(" ");
  assert.match(text, /Root mean square of main peak over 10 to 20 rad\/s of ω: 2 mm\./);
  assert.match(text, /\(4 mm\): 50 % less \(−6\.02 dB\)/);
  assert.doesNotMatch(text, /Certificate/);
  assert.equal(rootUnit("(m)2"), "m");
  assert.equal(rootUnit("1"), "1");
});

test("a tuning that did not converge, was infeasible, without bound, failed or stopped says so with its reason", () => {
  assert.equal(outcomeWarning(tuningOf(minimax())), "");
  const words = [/did not converge/, /meets every limit/, /no bound/, /failed/, /stopped/];
  words.forEach((word, i) => {
    const warning = outcomeWarning(tuningOf(minimax({ violation: ["1", "", 0.25] }, i + 2)));
    assert.match(warning, word);
    assert.match(warning, word.source.includes("meets every limit") ? /25 %\)\.$/ : /25 %.*because\.$/);
  });
});

test("rounds that settle a schedule are told from those that press the worst peak down", () => {
  const bounds = [0.04, 0.03, 0.025 * (1 - 1e-9), 0.009, 0.008];
  const scheduled = {
    k: ["N/m", "knots_k", [600, 900]],
    knots_k: ["rad s-1", "knots_k", [10, 20]],
    round_bound: ["m", "round", bounds],
  };
  assert.equal(settlingRounds(tuningOf(minimax(scheduled))), 2);
  assert.equal(settlingRounds(tuningOf(minimax({ round_bound: ["m", "round", bounds] }))), 0);
});

test("where what stands beside the schedule leaves its range is told", () => {
  const ratio = {
    ratio: ["1", "omega", [0.5, 0.7, 0.9, 1.1, 1.5]],
    ratio_range_lower: ["1", "", 0.6],
    ratio_range_upper: ["1", "", 1.1],
  };
  const record = minimax(ratio);
  const group = record.groups.get("optimum");
  group.byName.set("ratio_range", {
    name: "ratio_range",
    kind: "flag",
    dimension: "omega",
    flags: [[1, "within"]],
    values: Float64Array.from([2, 1, 1, 1, 3]),
  });
  assert.match(
    whatItMeans(tuningOf(record)).flat().join(" "),
    /ratio is within its range over 50 % of the band \(11 to 16 rad\/s\)\./,
  );
});

test("of a design that did not converge nothing is said of its being free or best", () => {
  const text = whatItMeans(
    tuningOf(
      minimax({ k_upper_multiplier: ["m (N/m)-1", "", 0], peak_multiplier: ["1", "peak", [0, 0]] }, 3),
    ),
  )
    .flat()
    .join(" ");
  assert.doesNotMatch(text, /free on all sides|no better design/);
});

const told = (...of) =>
  whatItMeans(tuningOf(minimax(...of)))
    .flat()
    .join(" ");

test("of a design that breaks a limit there is no certificate, no multiplier, and what it breaks is told", () => {
  const broken = {
    // As the record has them of such a design.
    certificate_gap: ["1", "", NaN],
    kkt_residual: ["1", "", NaN],
    violation: ["1", "", 6.14],
    stroke_limited: ["mm", "", 35.7],
    stroke_upper_limit: ["mm", "", 5],
    stroke_lower_limit: ["mm", "", NaN],
    stroke_limit_excess: ["1", "", 6.14],
    stroke_limit_multiplier: ["m (mm)-1", "", NaN],
  };
  const text = told(broken, 3, { limits: "stroke" });
  assert.match(
    text,
    /It breaks the limit of stroke, at most 5 mm, by 614 %: 35\.7 mm\. It lies on the upper bound of k\./,
  );
  assert.doesNotMatch(text, /held by|relaxed|[Cc]ertificate|hold to|differ|KKT/);
  const tuning = tuningOf(minimax(broken, 3, { limits: "stroke" }));
  assert.deepEqual(
    tuning.peaks.map(({ active }) => active),
    [false, false],
  );
  assert.equal(tuning.limits[0].active, false);
  assert.deepEqual(heldBounds(tuning, tuning.parameters[0]), []);
});

test("a gap below rounding is told as rounding, a negative one by its size", () => {
  assert.match(told({ certificate_gap: ["1", "", -1e-15] }), /agree to rounding\./);
  assert.match(told({ certificate_gap: ["1", "", -5e-8] }), /agree to 5×10⁻⁸ \(relative\)\./);
});

test("a weighted response is told as weighted throughout", () => {
  const text = told({ weight: ["1", "omega", [1, 1, 1, 1, 1]] });
  assert.match(text, /Worst weighted main peak over/);
  assert.match(text, /The weighted response stays at or below/);
});

test("a tuning without bound says so, with the place in the band by its name", () => {
  const unbounded = tuningOf(
    minimax({ objective: ["m", "", NaN], worst_before: ["m", "", Infinity] }, 4, {
      reason: "the response has no bound at 1 of the band: an undamped mode",
    }),
  );
  assert.deepEqual(whatItMeans(unbounded), [
    ["The worst main peak of this design is unbounded.", "So is that of the design before."],
  ]);
  assert.match(outcomeWarning(unbounded), /no bound at ω = 1 rad\/s: an undamped mode/);
});

test("a trade-off tells which limits converged and which design is shown", () => {
  const record = minimax({ trade_off: ["mm", "", 5] }, 3, { limits: "stroke" });
  record.groups.set(
    "optimum/front",
    sampleGroup(
      {},
      {
        trade_off: ["mm", "trade_off", [40, 36, 20, 5]],
        objective: ["m", "trade_off", [0.02052, 0.02108, 0.04, 0.04]],
      },
      { outcome: ["trade_off", [1, 1, 3, 3], outcomes] },
    ),
  );
  const tuning = tuningOf(record);
  assert.deepEqual(whatItMeans(tuning)[0], [
    "Trade-off over 4 limits of stroke, 2 converged: worst main peak from 20.52 mm at 40 mm to 21.08 mm at 36 mm.",
    "What follows is the design for the last limit, 5 mm.",
  ]);
  assert.match(outcomeWarning(tuning), /^For the last limit, 5 mm: no design was found/);
});

test("a schedule tells where it is as steep as it may be, and one that dominates how near it comes", () => {
  const scheduled = {
    k: ["N/m", "knots_k", [600, 800, 850, 650]],
    knots_k: ["rad s-1", "knots_k", [10, 12, 14, 16]],
    k_max_slope: ["N/m (rad s-1)-1", "", 100],
    response_constant: ["m", "omega", [0.02, 0.05, 0.04, 0.015000001, 0.02]],
  };
  assert.equal(steepestPieces(tuningOf(minimax(scheduled)).parameters[0]), 2);
  const text = told(scheduled, 1, { dominate: "constant" });
  assert.match(
    text,
    /k changes as fast as allowed \(100 N\/m per rad\/s of ω\) at 2 of 3 pieces, which also determines the design\./,
  );
  assert.match(
    text,
    /nowhere above .*: it is at most 100 % of it, at 16 rad\/s, which also determines the design\./,
  );
  assert.doesNotMatch(told(scheduled), /nowhere above/);
  assert.ok(Number.isNaN(steepestPieces(tuningOf(minimax()).parameters[0])));
});

test("a standard deviation is compared with that of the design before", () => {
  const text = told(
    { objective: ["(m)2", "", 4e-6], worst_before: ["(m)2", "", 16e-6], worst_after: ["(m)2", "", 4e-6] },
    1,
    { objective_kind: "variance", quantity: "main_rms" },
  );
  assert.match(text, /Standard deviation of main: 2 mm\. Against the design before \(4 mm\): 50 % less/);
});

test("a variance says what its noise is, and what the motion is relative to", () => {
  const of = (noise) =>
    told({ objective: ["(m)2", "", 4e-6] }, 1, {
      objective_kind: "variance",
      quantity: "main_rms",
      ...noise,
    });
  const support = {
    noise: "the acceleration of base",
    noise_density: "0.5 (m s-2)2 per rad s-1",
    relative_to: "base",
  };
  assert.match(
    of(support),
    /Standard deviation of main relative to base under white noise, the acceleration of base \(two-sided spectral density 0\.5 \(m\/s²\)² per rad\/s\): 2 mm\./,
  );
  assert.match(
    of({ noise: "a force on main", noise_density: "2" }),
    /Standard deviation of main under white noise, a force on main \(two-sided spectral density 2\): 2 mm\./,
  );
});

test("of a design that did not converge, but keeps its limits, the gap that is left is told", () => {
  const text = told({ certificate_gap: ["1", "", -0.0139], kkt_residual: ["1", "", 0.49] }, 2);
  assert.match(text, /There is no certificate; .* differ by 0\.014 \(relative\)/);
  assert.match(text, /local optimum do not hold: KKT residual 0\.49/);
});

test("the conditions of an optimum are judged by the tolerance that the study asks for", () => {
  const at = (tolerance) => told({ kkt_residual: ["1", "", 1e-4], tolerance: ["1", "", tolerance] }, 2);
  assert.match(at(1e-3), /hold to 0\.0001 \(relative\) at the last step/);
  assert.match(at(1e-6), /do not hold: KKT residual/);
});

test("a broken limit is told with the bound that it breaks, its part of the band, and where", () => {
  const record = minimax(
    {
      stroke_limited: ["mm", "", 0.15],
      stroke_limited_at: ["rad s-1", "", 20],
      stroke_lower_limit: ["mm", "", 0.2],
      stroke_upper_limit: ["mm", "", 8],
      stroke_limit_excess: ["1", "", 0.25],
      stroke_2_limited: ["mm", "", 9],
      stroke_2_limited_at: ["rad s-1", "", 12],
      stroke_2_lower_limit: ["mm", "", NaN],
      stroke_2_upper_limit: ["mm", "", 7.5],
      stroke_2_limit_excess: ["1", "", 0.2],
    },
    3,
    { limits: "stroke,stroke_2" },
  );
  const part = { stroke_2_band_from: ["1", "", 10], stroke_2_band_to: ["1", "", 16] };
  record.groups.set("study", sampleGroup({}, part));
  const text = whatItMeans(tuningOf(record)).flat().join(" ");
  assert.match(text, /limit of stroke, at least 0\.2 mm, by 25 %: 0\.15 mm at 20 rad\/s\./);
  assert.match(text, /limit of stroke 2, at most 7\.5 mm over 10 to 16 rad\/s, by 20 %: 9 mm at 12 rad\/s\./);
});

test("the end of the band is no peak", () => {
  const text = told({ peak_omega: ["rad s-1", "peak", [20, 12]] });
  assert.match(text, /held by the response at 20 rad\/s, the end of the band, share 100 %/);
  assert.doesNotMatch(text, /peak at 20/);
});

test("of several responses the page claims no more than what was found", () => {
  const text = (texts) =>
    whatItMeans(tuningOf(minimax({}, 1, texts)))
      .flat()
      .join(" ");
  assert.match(text({}), /Certificate: all peaks/);
  assert.doesNotMatch(text({}), /Several responses/);
  const searched = text({ not_proved: "it is not proved that none was missed" });
  assert.match(searched, /Among the responses found: all peaks/);
  assert.match(searched, /Several responses may exist: it is not proved that none was missed\./);
});

// Of two records.
function overRecords(kind, texts = {}) {
  const [value, share] =
    kind === "worst_peak"
      ? [
          [4e-3, 2e-3],
          [1, 0],
        ]
      : [
          [5e-3, 3e-3],
          [0.5, 0.5],
        ];
  const optimum = sampleGroup(
    {
      objective_kind: kind,
      quantity: "main_peak",
      band_parameter: "time",
      records: "north,south",
      scenarios: "study",
      ...texts,
    },
    {
      objective: ["m", "", 4e-3],
      certificate_gap: ["1", "", 1e-9],
      kkt_residual: ["1", "", 2e-10],
      peak_time: ["s", "peak", [3, 4]],
      peak_record: ["1", "peak", [0, 1]],
      peak_value: ["m", "peak", value],
      peak_before: ["m", "peak", [8e-3, 2e-3]],
      peak_multiplier: ["1", "peak", share],
      peak_scenario: ["1", "peak", [0, 0]],
    },
    { outcome: ["", 1, outcomes] },
  );
  return sampleRecord({ optimum });
}

test("a tuning over records says its worst or mean peak, in its unit, and which record holds it", () => {
  const worst = whatItMeans(tuningOf(overRecords("worst_peak")))
    .flat()
    .join(" ");
  assert.match(worst, /Worst main peak, in the worst of 2 records: 4 mm\./);
  assert.match(worst, /Against the design before \(8 mm\): 50 % less \(−6\.02 dB\)/);
  assert.match(worst, /Certificate: the motion under every record was solved to its end; the worst of them/);
  assert.match(worst, /held by the peak at 3 s \(north\), share 100 %/);
  const mean = whatItMeans(tuningOf(overRecords("mean_peak")))
    .flat()
    .join(" ");
  assert.match(mean, /Mean main peak, as the mean of 2 records: 4 mm\./);
  assert.match(mean, /Against the design before \(5 mm\): 20 % less/);
  assert.doesNotMatch(mean, /peak at 3 s/);
});

test("no design before is compared with a quantile", () => {
  const text = whatItMeans(tuningOf(overRecords("worst_peak", { quantile: "0.9" })))
    .flat()
    .join(" ");
  assert.doesNotMatch(text, /design before/);
});
