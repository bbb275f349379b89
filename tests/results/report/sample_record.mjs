// Records for the tests of the page, as unpackRecord gives them, without a file.
import { Group } from "../../../results/report/page/record.js";

// columns: {name: [unit, dimension, values]}; flags: {name: [dimension, values, meanings]}.
export function sampleGroup(texts, columns, flags = {}) {
  const numbers = Object.entries(columns).map(([name, [unit, dimension, values]]) => ({
    name,
    unit,
    dimension,
    long_name: "",
    kind: "float",
    values: Float64Array.from([values].flat()),
  }));
  const words = Object.entries(flags).map(([name, [dimension, values, meanings]]) => ({
    name,
    unit: "1",
    dimension,
    long_name: "",
    kind: "flag",
    values: Float64Array.from([values].flat()),
    flags: meanings.map((word, code) => [code, word]),
  }));
  return new Group(texts, [...numbers, ...words]);
}

export function sampleRecord(groups) {
  return {
    file: "sample.h5",
    title: "sample",
    source: "frahm",
    history: "",
    map: null,
    groups: new Map(Object.entries(groups)),
    provenance: {},
  };
}
