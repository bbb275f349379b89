// A structure over its height: what is drawn, where, and which of many quantities are listed.
import assert from "node:assert/strict";
import { test } from "node:test";
import {
  driftPath,
  headlines,
  pointNames,
  profileColumns,
  profileDrifts,
  profileModes,
  profileOf,
  profilePeaks,
  worstAlong,
} from "../../../results/report/page/profile.js";
import { ResponseMap } from "../../../results/report/page/record.js";
import { sampleGroup, sampleRecord } from "./sample_record.mjs";

const storeys = (count, name) => Array.from({ length: count }, (_, i) => `${name}${i + 1}`);

function profileOfFloors(count, columns = {}) {
  const owners = [...storeys(count, "floor"), ...storeys(count, "columns")].join(",");
  const texts = {
    masses: storeys(count, "floor").join(","),
    springs: storeys(count, "columns").join(","),
    owners,
  };
  return profileOf(sampleRecord({ profile: sampleGroup(texts, columns) }));
}

// A map of F x r, 2 x 3 points.
function mapOf(quantities) {
  const axis = (name, values, stride) => ({
    name,
    size: values.length,
    stride,
    coordinates: [{ name, unit: "1", long_name: "", values, monotone: true }],
  });
  const variables = Object.entries(quantities).map(([name, values]) => ({
    name,
    unit: "m",
    kind: "float",
    values: Float64Array.from(values),
  }));
  return new ResponseMap([axis("F", [1, 2], 3), axis("r", [0.1, 0.2, 0.3], 1)], variables, {
    parameters: ["F", "r"],
    left_out: [],
  });
}

const map = mapOf({
  floor1_peak: [1, 2, 1, 1, 1, 4],
  floor2_peak: [1, 3, 5, NaN, 1, 2],
  columns2_stroke: [7, 8, 9, 10, 11, 12],
});

test("heights are those of the study, else the numbers of the masses", () => {
  assert.deepEqual(profileOfFloors(3).heights, [1, 2, 3]);
  const known = profileOfFloors(2, { height: ["m", "place", [4, 7.5]] });
  assert.deepEqual([known.heights, known.unit], [[4, 7.5], "m"]);
  assert.equal(profileOf(sampleRecord({})), null);
});

test("peaks lie at the heights of their masses, as far as they are recorded", () => {
  const peaks = profilePeaks(map, profileOfFloors(3));
  assert.deepEqual(
    peaks.map(({ mass, height, variable }) => [mass, height, map.value(variable, [0, 2])]),
    [
      ["floor1", 1, 1],
      ["floor2", 2, 5],
    ],
  );
});

test("a stroke reaches from one mass to the next, and lines break where no spring joins them", () => {
  const all = mapOf({ columns1_stroke: [1, 0, 0, 0, 0, 0], columns2_stroke: [2, 0, 0, 0, 0, 0] });
  const path = (one) => driftPath(one, profileDrifts(one, profileOfFloors(3)), [0, 0]);
  assert.deepEqual(path(all), { x: [1, 1, 2, 2], y: [0, 1, 1, 2] });
  assert.deepEqual(path(map), { x: [7, 7], y: [1, 2] });
  const gap = mapOf({ columns1_stroke: [1, 0, 0, 0, 0, 0], columns3_stroke: [3, 0, 0, 0, 0, 0] });
  assert.deepEqual(path(gap), { x: [1, 1, NaN, 3, 3], y: [0, 1, NaN, 2, 3] });
});

test("the worst point along an axis has the largest peak of any mass", () => {
  assert.deepEqual(worstAlong(map, profileOfFloors(2), [0, 0], 1), [0, 2]);
  assert.deepEqual(worstAlong(map, profileOfFloors(2), [1, 0], 1), [1, 2]);
  assert.deepEqual(worstAlong(map, profileOfFloors(2), [0, 0], 0), [0, 0]);
});

test("points are named by what differs, and the CSV has a column for each", () => {
  assert.deepEqual(pointNames(map, [[0, 1]]), ["F = 1, r = 0.2"]);
  const points = [
    [0, 1],
    [1, 1],
  ];
  assert.deepEqual(pointNames(map, points), ["F = 1", "F = 2"]);
  const peaks = profilePeaks(map, profileOfFloors(2));
  const columns = profileColumns(map, points, "peak", peaks, []);
  assert.deepEqual(
    columns.map(({ name, unit, values }) => [name, unit, values]),
    [
      ["peak at F = 1", "m", [2, 3]],
      ["peak at F = 2", "m", [1, 1]],
    ],
  );
});

test("mode shapes are those of the profile's masses, in its order, of six modes at most", () => {
  const frequencies = [1, 2, 3, 4, 5, 6, 7];
  const shapes = Object.fromEntries(
    frequencies.map((k) => [`mode_shape_${k}`, ["1", "mode_mass", [0.1 * k, 0.2 * k, 0.3 * k]]]),
  );
  const group = sampleGroup(
    { masses: "tmd,floor1,floor2", point: "r=1" },
    { mode_frequency: ["1", "mode", frequencies], mode_damping: ["1", "mode", frequencies], ...shapes },
  );
  const modes = profileModes(group, profileOfFloors(2));
  assert.equal(modes.length, 6);
  assert.deepEqual(modes[1], { mode: 2, frequency: 2, damping: 2, shape: [0.4, 0.3 * 2] });
});

test("of a quantity that many masses have, those of the profile's ends are listed", () => {
  const names = [
    ...storeys(20, "floor").map((name) => `${name}_peak`),
    ...storeys(20, "columns").map((name) => `${name}_stroke`),
    ...storeys(8, "columns").map((name) => `${name}_energy`),
    ...storeys(30, "natural_frequency_"),
    "status",
  ];
  const many = mapOf(Object.fromEntries(names.map((name) => [name, [0, 0, 0, 0, 0, 0]])));
  const listed = headlines(many, profileOfFloors(20)).map(({ name }) => name);
  assert.deepEqual(listed, [
    "floor1_peak",
    "floor20_peak",
    "columns1_stroke",
    "columns20_stroke",
    ...storeys(8, "columns").map((name) => `${name}_energy`),
    "natural_frequency_1",
    "natural_frequency_30",
    "status",
  ]);
  assert.equal(headlines(many, null).length, names.length);
});
