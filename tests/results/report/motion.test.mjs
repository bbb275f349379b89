// What the page of a motion reads from it.
import assert from "node:assert/strict";
import { test } from "node:test";
import { cranksOf, largestErrors } from "../../../results/report/page/crank.js";
import {
  dampingRatio,
  envelope,
  interpolated,
  isOneMode,
  motionOf,
  samplingOf,
  stretch,
} from "../../../results/report/page/motion.js";
import { sparseText, whatItMeans } from "../../../results/report/page/motion_words.js";
import { sampleGroup, sampleRecord } from "./sample_record.mjs";

const rounding = 1e-12;

function decay(columns = {}, facts = {}) {
  return motionOf(
    sampleRecord({
      study: sampleGroup({}, facts),
      decay: sampleGroup(
        {},
        {
          main_extremum_time: ["s", "extremum", [0, 1, 2, 3, NaN]],
          main_extremum: ["m", "extremum", [0.008, -0.006, 0.004, -0.002, NaN]],
          main_log_decrement: ["1", "extremum", [Math.log(2), Math.log(3), NaN, NaN, NaN]],
          main_rest: ["m", "", 0],
          stop_time: ["s", "", NaN],
          duration: ["s", "", 4],
          reference_frequency: ["rad s-1", "", 3],
          ...columns,
        },
      ),
    }),
    "decay",
  );
}

test("the damping ratio of a decrement gives the decrement back", () => {
  const zeta = 0.07;
  assert.ok(Math.abs(dampingRatio((2 * Math.PI * zeta) / Math.sqrt(1 - zeta * zeta)) - zeta) < rounding);
});

test("turning points stop where their numbers do, and fall on two sides", () => {
  const [main] = decay().masses;
  assert.equal(main.turningTimes.length, 4);
  assert.equal(main.decrements.length, 2);
  const { upper, lower } = envelope(main);
  assert.deepEqual(upper, { x: [0, 2], y: [0.008, 0.004] });
  assert.deepEqual(lower, { x: [1, 3], y: [-0.006, -0.002] });
});

const told = (motion) => whatItMeans(motion).flat().join(" ");

test("a decay that does not come to rest says so once, and one without friction never arrives", () => {
  const moving = told(decay());
  assert.match(moving, /It does not reach its rest position, 0 m, within 4 s\./);
  assert.doesNotMatch(moving, /comes to/);
  const free = told(decay({}, { rubbing_elements: ["1", "", 0] }));
  assert.match(free, /It tends to 0 m without ever arriving\./);
  assert.doesNotMatch(free, /comes to|come to/);
  assert.match(told(decay({ main_rest: ["m", "", NaN] })), /Within 4 s it does not come to rest\./);
  assert.match(
    whatItMeans(decay({ stop_time: ["s", "", 3.5] }))
      .flat()
      .join(" "),
    /Nothing moves after 3\.5 s\./,
  );
});

test("the damping budget names each share", () => {
  const text = whatItMeans(
    decay({
      guide_energy: ["J", "", 3],
      guide_energy_share: ["1", "", 0.75],
      c_energy: ["J", "", 1],
      c_energy_share: ["1", "", 0.25],
      energy_balance: ["1", "", 1e-12],
    }),
  )
    .flat()
    .join(" ");
  assert.match(text, /Of the 4 J dissipated, 75 % in guide, 25 % in c\. The energy balance closes to 1×10⁻¹²\./);
});

test("a contact that is not released sticks to the end", () => {
  const time = [0, 1, 2, 3, 4];
  const motion = motionOf(
    sampleRecord({
      transient: sampleGroup(
        {},
        {
          time: ["s", "time", time],
          x_displacement: ["m", "time", time],
          guide_stop_onset: ["s", "stop", [1, 3, NaN]],
          guide_release: ["s", "stop", [2, NaN, NaN]],
          other_stop_onset: ["s", "stop", [NaN, NaN, NaN]],
          other_release: ["s", "stop", [NaN, NaN, NaN]],
        },
      ),
    }),
    "transient",
  );
  assert.equal(motion.stops.length, 1);
  assert.deepEqual(Array.from(motion.stops[0].to), [2, 4]);
  assert.match(whatItMeans(motion).flat().join(" "), /Contact guide sticks 2 times, 2 s in all\./);
});

test("a signal is called one, and does not make one mass two", () => {
  const columns = {
    sway_extremum_time: ["s", "extremum", [0, 1, 2, 3, NaN]],
    sway_extremum: ["m", "extremum", [0.016, -0.012, 0.008, -0.004, NaN]],
  };
  const record = (texts) =>
    motionOf(
      sampleRecord({
        study: sampleGroup(texts, {}),
        decay: sampleGroup(
          {},
          {
            main_extremum_time: columns.sway_extremum_time,
            main_extremum: columns.sway_extremum,
            ...columns,
          },
        ),
      }),
      "decay",
    );
  const motion = record({ signals: "sway" });
  assert.match(told(motion), /Mass main turns 4 times/);
  assert.match(told(motion), /Signal sway turns 4 times/);
  assert.ok(isOneMode(motion));
  assert.ok(!isOneMode(record({ signals: "" })));
});

test("the frequency at the peak of a run-up lies between its samples", () => {
  assert.equal(interpolated([0, 1, 2], [10, 20, 40], 1.5), 30);
  assert.equal(interpolated([0, 1, 2], [10, 20, 40], 0), 10);
  assert.ok(Number.isNaN(interpolated([0, 1], [1, 2], 3)));
});

test("the last cycles are a stretch at the end, of a short motion there is none", () => {
  const motion = (periods) => {
    const time = Float64Array.from({ length: 100 * periods + 1 }, (_, i) => (i + 0.3) / 100);
    return {
      time: { values: time },
      masses: [{ velocity: { values: time.map((t) => Math.cos(2 * Math.PI * t)) } }],
    };
  };
  const last = stretch(motion(100), 12, "last"),
    first = stretch(motion(100), 12, "first");
  assert.ok(Math.abs(last.to - last.from - 600) < 100, `${last.to - last.from} samples`);
  assert.equal(last.to, 10001);
  assert.equal(first.from, 0);
  assert.equal(stretch(motion(10), 12, "last"), null);
});

test("the largest errors of a cut are those of its columns, and a second crank on a node is another", () => {
  const cranks = cranksOf(
    sampleRecord({
      crank: sampleGroup(
        {},
        {
          angle: ["rad", "angle", [0, 1, 2]],
          exciter_motion: ["m", "angle", [0.1, 0.05, -0.2]],
          exciter_taylor_1: ["m", "angle", [0.1, 0.06, -0.2]],
          exciter_taylor_1_error: ["1", "angle", [0, 0.02, 0]],
          exciter_2_motion: ["m", "angle", [0, 0, 0]],
        },
      ),
    }),
  );
  assert.deepEqual(
    cranks.map(({ name, cuts }) => [name, cuts.map(({ order }) => order)]),
    [
      ["exciter", [1]],
      ["exciter_2", []],
    ],
  );
  const { length, relative } = largestErrors(cranks[0], cranks[0].cuts[0]);
  assert.ok(Math.abs(length - 0.01) < rounding);
  assert.equal(relative, 0.02);
});

// Free vibration of period 2 s and 100 s, with `count` samples.
function sampledDecay(count) {
  const turns = Array.from({ length: 101 }, (_, i) => i);
  const time = Array.from({ length: count }, (_, i) => (100 * i) / (count - 1));
  return decay({
    main_extremum_time: ["s", "extremum", turns],
    main_extremum: ["m", "extremum", turns.map((i) => 0.01 * (-1) ** i)],
    duration: ["s", "", 100],
    time: ["s", "time", time],
    main_displacement: ["m", "time", time.map((t) => 0.01 * Math.cos(Math.PI * t))],
  });
}

test("a history of fewer than 8 samples a period is sparse, and is told how many would do", () => {
  assert.equal(samplingOf(sampledDecay(399)).sparse, true);
  assert.equal(samplingOf(sampledDecay(402)).sparse, false);
  assert.match(
    sparseText(sampledDecay(51)),
    /are 2 s apart, 1 per period of 2 s: .* dots, .* With samples = 1001 or more in \[decay\]/,
  );
  assert.equal(sparseText(sampledDecay(1001)), "");
  assert.equal(samplingOf(decay()).sparse, false);
});

function forced(peak, frequency) {
  const time = Array.from({ length: 101 }, (_, i) => i / 10);
  return motionOf(
    sampleRecord({
      ...(frequency ? { study: sampleGroup({}, { excitation_frequency: ["rad s-1", "", frequency] }) } : {}),
      transient: sampleGroup(
        {},
        {
          time: ["s", "time", time],
          main_displacement: ["m", "time", time.map((t) => 0.01 * Math.sin(t))],
          main_peak: ["m", "", peak],
        },
      ),
    }),
    "transient",
  );
}

test("a forced history is sparse by its excitation's period, or by a peak that its samples miss", () => {
  assert.equal(samplingOf(forced(0.01, 2 * Math.PI)).sparse, false); // 10 samples a period
  assert.equal(samplingOf(forced(0.01, 4 * Math.PI)).sparse, true);
  assert.equal(samplingOf(forced(0.01)).sparse, false);
  const missed = forced(0.012);
  assert.equal(samplingOf(missed).sparse, true);
  assert.match(
    sparseText(missed),
    /the largest displacement lies between them.*With more samples in \[transient\]/,
  );
});

test("decrements and turning points below rounding are told as rounding", () => {
  const undamped = decay({ main_log_decrement: ["1", "extremum", [1e-15, -2e-15, NaN, NaN, NaN]] });
  assert.match(told(undamped), /Its logarithmic decrement is 0 apart from rounding: nothing damps it\./);
  const far = decay({
    main_extremum: ["m", "extremum", [0.008, -0.006, 1e-16, -1e-17, NaN]],
    main_log_decrement: ["1", "extremum", [0.5, NaN, NaN, NaN, NaN]],
  });
  assert.match(told(far), /last at a displacement below rounding\./);
  assert.match(told(decay()), /last at −2 mm\..* and 1\.099 in the last\./);
  const early = decay({ main_log_decrement: ["1", "extremum", [0.5, NaN, NaN, NaN, NaN]] });
  assert.match(told(early), /0\.5 in the first cycle/);
});

// Two masses: "a", that starts from rest at zero and that friction holds from 2 on, and "b", that goes on.
function coupled(columns = {}, facts = {}) {
  return decay(
    {
      main_extremum_time: ["s", "extremum", [NaN, NaN, NaN, NaN]],
      main_extremum: ["m", "extremum", [NaN, NaN, NaN, NaN]],
      main_log_decrement: ["1", "extremum", [NaN, NaN, NaN, NaN]],
      a_extremum_time: ["s", "extremum", [0, 1, 2, NaN]],
      a_extremum: ["m", "extremum", [0, 0.009, -0.003, NaN]],
      a_log_decrement: ["1", "extremum", [NaN, NaN, NaN, NaN]],
      a_rest: ["m", "", -0.003],
      b_extremum_time: ["s", "extremum", [0, 1.5, 2.5, 3.5]],
      b_extremum: ["m", "extremum", [0.03, -0.016, -0.001, -0.007]],
      b_log_decrement: ["1", "extremum", [3.4, 0.83, NaN, NaN]],
      b_rest: ["m", "", -0.003],
      ...columns,
    },
    { rubbing_elements: ["1", "", 1], given_duration: ["1", "", 0], ...facts },
  );
}

test("a start from rest at zero is no turning point", () => {
  const a = coupled().masses.find(({ name }) => name === "a");
  assert.deepEqual(Array.from(a.turningPoints), [0.009, -0.003]);
  assert.match(told(coupled()), /Mass a turns 2 times, first at 9 mm, last at −3 mm\./);
});

test("each mass is told as held by friction, on its way, or tending to its rest position, by its own turning points", () => {
  const text = told(coupled());
  assert.match(text, /Mass a .* It reaches its rest position, −3 mm, at 2 s\. Mass b .* It tends to −3 mm\./);
  const cut = told(coupled({}, { given_duration: ["1", "", 1] }));
  assert.match(
    cut,
    /Mass a .* It reaches its rest position, .* Mass b .* It does not reach its rest position, −3 mm, within 4 s\./,
  );
  const withoutFriction = told(coupled({}, { rubbing_elements: ["1", "", 0] }));
  assert.match(withoutFriction, /Mass a .* It tends to −3 mm without .* Mass b .* It tends to −3 mm without/);
});

test("a decrement is told of what swings about zero, and as a damping ratio only of one mass alone", () => {
  assert.doesNotMatch(told(coupled()), /decrement|–/);
  const alternating = told(coupled({ b_extremum: ["m", "extremum", [0.03, -0.016, 0.001, -0.0007]] }));
  assert.match(alternating, /Its logarithmic decrement is 3\.4 in the first cycle and 0\.83 in the last\./);
  assert.match(told(decay()), /0\.6931 in the first cycle \(as with 11 % viscous damping\)/);
});

test("what friction holds from the start does not move", () => {
  const still = decay({
    main_extremum_time: ["s", "extremum", [0]],
    main_extremum: ["m", "extremum", [0.01]],
    main_log_decrement: ["1", "extremum", [NaN]],
    main_rest: ["m", "", 0.01],
    stop_time: ["s", "", 0],
  });
  assert.equal(told(still), "Mass main does not move: it rests at 10 mm.");
});

test("a dimensionless motion has no seconds, metres or joules", () => {
  const plain = decay({
    main_extremum_time: ["1", "extremum", [0, 1, 2, 3, NaN]],
    main_extremum: ["1", "extremum", [8, -6, 4, -2, NaN]],
    main_rest: ["1", "", 0],
    duration: ["1", "", 4],
    stop_time: ["1", "", NaN],
    guide_energy: ["1", "", 3],
    guide_energy_share: ["1", "", 1],
    guide_stop_onset: ["1", "stop", [1, NaN]],
    guide_release: ["1", "stop", [2, NaN]],
  });
  assert.deepEqual(plain.units, { time: "1", energy: "1" });
  assert.doesNotMatch(told(plain), /\d (s|J|m|k)\b/);
  assert.deepEqual(decay({ guide_energy: ["J", "", 3] }).units, { time: "s", energy: "J" });
});

test("the frequency of a run is told in the study's unit, and its period is that of its angular frequency", () => {
  const rpm = (2 * Math.PI) / 60,
    time = Array.from({ length: 101 }, (_, i) => i / 10);
  const run = motionOf(
    sampleRecord({
      study: sampleGroup({}, { frequency_unit: ["rpm", "", rpm] }),
      transient: sampleGroup(
        {},
        {
          time: ["s", "time", time],
          frequency: ["rpm", "time", time.map((t) => 60 + 6 * t)],
          main_displacement: ["m", "time", time.map(Math.sin)],
        },
      ),
    }),
    "transient",
  );
  assert.match(told(run), /The excitation runs up from 60 rpm to 120 rpm\./);
  assert.ok(Math.abs(samplingOf(run).period - 0.5) < rounding);
});
