// A result as its page uses it: axes, variables on them, groups of columns, texts. Plain data and look-ups.
import { unpackLevels, unpackNumbers } from "./numbers.js";

// The values of flags and counts that mean "missing".
const none = { flag: 0, count: -1 };

export function isMissing({ kind }, value) {
  return Number.isNaN(value) || value === none[kind];
}

// One column of a group: name, unit, long_name, kind, flags, dimension, values (Float64Array).
export class Group {
  constructor(texts, columns) {
    this.texts = texts;
    this.columns = columns;
    this.byName = new Map(columns.map((column) => [column.name, column]));
  }
  has(name) {
    return this.byName.has(name);
  }
  // The column, or undefined.
  column(name) {
    return this.byName.get(name);
  }
  values(name) {
    return this.byName.get(name)?.values;
  }
  // A single number, or NaN where there is none.
  number(name) {
    return this.byName.get(name)?.values[0] ?? NaN;
  }
  // The word of a flag (a single one, or that of row i).
  word(name, i = 0) {
    const column = this.byName.get(name);
    return column ? meaningOf(column, column.values[i]) : "";
  }
  // The words of a flag, one for each row; empty if there is no such flag.
  words(name) {
    return Array.from(this.values(name) ?? [], (_, i) => this.word(name, i));
  }
  along(dimension) {
    return this.columns.filter((column) => column.dimension === dimension);
  }
}

export function meaningOf(variable, value) {
  return variable.flags?.find(([code]) => code === value)?.[1] ?? "";
}

// Axes: {name, size, stride, coordinates: [{name, unit, long_name, values, names, monotone}]}; the first coordinate
// is monotone and represents the axis; names: of its values (records), or undefined.
export class ResponseMap {
  constructor(axes, variables, { parameters, left_out, samples = null }) {
    this.axes = axes;
    this.samples = samples; // the axis along which parameters scatter, or null
    this.variables = variables;
    this.parameters = new Set(parameters); // coordinates that are the study's own
    this.leftOut = left_out;
    this.byName = new Map(variables.map((variable) => [variable.name, variable]));
    this.points = axes.reduce((points, axis) => points * axis.size, 1);
  }
  variable(name) {
    return this.byName.get(name);
  }
  offset(index) {
    return index.reduce((offset, i, axis) => offset + i * this.axes[axis].stride, 0);
  }
  // The value at a point, NaN where there is none.
  value(variable, index) {
    const value = variable.values[this.offset(index)];
    return isMissing(variable, value) ? NaN : value;
  }
  // Values along an axis through a point.
  line(variable, index, axis) {
    const { size, stride } = this.axes[axis];
    const start = this.offset(index) - index[axis] * stride;
    return Float64Array.from({ length: size }, (_, i) => {
      const value = variable.values[start + i * stride];
      return isMissing(variable, value) ? NaN : value;
    });
  }
}

function isMonotone(values) {
  const sign = Math.sign(values.at(-1) - values[0]);
  return values.every((value, i) => i === 0 || (value - values[i - 1]) * sign > 0);
}

// The index along an axis; it scales figures if the axis's own values are not monotone.
function indexAlong({ name, size, coordinates }) {
  return {
    name: coordinates.some((coordinate) => coordinate.name === name) ? `${name}_number` : name,
    unit: "1",
    long_name: "",
    monotone: true,
    values: Array.from({ length: size }, (_, i) => i),
  };
}

const sixDigits = 6;

async function unpackMap(data) {
  const sizes = data.axes.map((axis) => axis.size);
  const strides = sizes.map((_, i) => sizes.slice(i + 1).reduce((a, b) => a * b, 1));
  const axes = data.axes.map((axis, i) => ({ ...axis, stride: strides[i] }));
  for (const axis of axes) {
    for (const coordinate of axis.coordinates) coordinate.monotone = isMonotone(coordinate.values);
    if (axis.coordinates.length === 0 || !axis.coordinates[0].monotone)
      axis.coordinates.unshift(indexAlong(axis));
  }
  const line = { size: sizes[data.along], stride: strides[data.along] };
  const levelsOf = new Map(data.variables.map(({ name, levels }) => [name, levels]));
  const unpacked = new Map(); // by levels and scale: some variables are equal
  const valuesOf = ({ name, values, levels_of: carrier = name, scale, low, step }) => {
    if (values) return unpackNumbers(values);
    const key = [carrier, scale, low, step].join(" ");
    if (!unpacked.has(key))
      unpacked.set(key, unpackLevels({ levels: levelsOf.get(carrier), scale, low, step }, line));
    return unpacked.get(key);
  };
  const variables = await Promise.all(
    data.variables.map(async (variable) => {
      const values = await valuesOf(variable);
      const { levels, levels_of, scale, low, step, ...described } = variable;
      const digits = variable.values || variable.kind !== "float" ? undefined : sixDigits;
      return { ...described, values, digits };
    }),
  );
  return new ResponseMap(axes, variables, data);
}

async function unpackGroup({ texts, columns }) {
  return new Group(
    texts,
    await Promise.all(
      columns.map(async (column) => ({ ...column, values: await unpackNumbers(column.values) })),
    ),
  );
}

// data: the page's JSON. The record: {file, title, source, history, map (or null), groups: Map, provenance}.
export async function unpackRecord(data) {
  if (data.format !== 1)
    throw new Error(`the page's data have format ${data.format}, but its script reads format 1`);
  const groups = new Map();
  for (const [name, group] of Object.entries(data.groups)) groups.set(name, await unpackGroup(group));
  return {
    file: data.file,
    title: data.title,
    source: data.source,
    history: data.history,
    map: data.map ? await unpackMap(data.map) : null,
    groups,
    provenance: data.provenance,
  };
}
