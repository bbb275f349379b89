// Figures of a recorded orbit: time history, phase portrait, friction-force loop.
import { coordinateText } from "../axes.js";
import { mostListed } from "../profile.js";
import { groupedByUnit, shownUnit, withUnit, words } from "../units.js";
import { curve, dots, drawFrame, grid, lineColours, roomFor } from "./frame.js";

// The samples of orbit k (a ragged group: those from row_start[k] up to the next), as name -> {unit, values}.
export function orbitSamples(group, k) {
  const start = group.values("row_start");
  const along = group.along("sample");
  const end = k + 1 < start.length ? start[k + 1] : (along[0]?.values.length ?? 0);
  return new Map(
    along.map((column) => [column.name, { ...column, values: column.values.slice(start[k], end) }]),
  );
}

const inset = 8; // pixels between curves and frame: a friction force stays at its limits

// Closes a period: repeats the first sample at the end of a loop.
const closed = (values) => (values.length ? [...values, values[0]] : values);

function shownColumn(column) {
  const { factor, text } = shownUnit(column.unit, column.values);
  return { values: Array.from(column.values, (value) => value * factor), unit: text };
}

const namesEnding = (samples, end) =>
  [...samples.keys()].filter((name) => name.endsWith(end)).map((name) => name.slice(0, -end.length));

// Of many names the first and the last.
export const endsOfMany = (names) => (names.length > mostListed ? [names[0], names.at(-1)] : names);

// Masses have an acceleration, contacts a sliding velocity.
export function massesOf(samples) {
  return namesEnding(samples, "_acceleration");
}
function contactsOf(samples) {
  return namesEnding(samples, "_sliding_velocity");
}

function traces(canvas, samples, names, axis, symbol) {
  const time = samples.get("time");
  const all = names.map((name) => samples.get(name));
  const { factor, text } = shownUnit(
    all[0].unit,
    all.flatMap(({ values }) => Array.from(values)),
  );
  const shown = all.map(({ values }) => Array.from(values, (value) => value * factor));
  return drawFrame(canvas, {
    x: { label: withUnit("time t", time.unit === "1" ? "" : time.unit) },
    y: { label: withUnit(axis, text), ...roomFor(shown.flat()), inset },
    legend: names.map((name, n) => ({
      text: words(name.replace(symbol, "")),
      stroke: lineColours[n % lineColours.length],
    })),
    marks: [
      ...grid(),
      ...shown.map((values, n) =>
        curve(time.values, values, { stroke: lineColours[n % lineColours.length] }),
      ),
    ],
  });
}

// A contact at rest is drawn as a point.
function loopMarks(x, y) {
  const stroke = lineColours[0];
  const isPoint = [x, y].every((values) => values.every((value) => value === values[0]));
  return isPoint
    ? [dots(x.slice(0, 1), y.slice(0, 1), { fill: stroke })]
    : [curve(closed(x), closed(y), { stroke })];
}

function loop(canvas, xColumn, yColumn, xLabel, yLabel) {
  const x = shownColumn(xColumn),
    y = shownColumn(yColumn);
  return drawFrame(canvas, {
    x: { label: withUnit(xLabel, x.unit), ...roomFor(x.values), inset },
    y: { label: withUnit(yLabel, y.unit), ...roomFor(y.values), inset },
    marks: [...grid(), ...loopMarks(x.values, y.values)],
  });
}

const columnsOf = (samples, names) =>
  names.map((name) => ({ name, unit: samples.get(name).unit, values: samples.get(name).values }));

// Figures of one orbit: of many masses or contacts, of the first and the last.  label: its point in words; suffix: of their
// files; portraits: the masses whose phase portraits they are.
export function orbitFigures(samples, label, suffix, portraits = endsOfMany(massesOf(samples))) {
  if (!samples.get("time")?.values.length) return [];
  const masses = massesOf(samples);
  const unitOf = (name) => samples.get(name).unit;
  const figures = [];
  for (const { unit, members } of groupedByUnit(
    masses.map((mass) => `${mass}_displacement`),
    unitOf,
  )) {
    const turns = unit === "rad";
    figures.push({
      name: `orbit_${turns ? "rotations" : "history"}${suffix}`,
      title: `${turns ? "Rotations" : "Displacements"} over one period`,
      caption: label,
      draw: (canvas) =>
        traces(canvas, samples, endsOfMany(members), turns ? "rotation" : "displacement", "_displacement"),
      table: () => columnsOf(samples, ["time", ...members]),
    });
  }
  for (const { unit, members } of groupedByUnit(
    contactsOf(samples).map((contact) => `${contact}_force`),
    unitOf,
  )) {
    const word = unit === "N m" ? "torque" : "force";
    figures.push({
      name: `orbit_friction${unit === "N m" ? "_torque" : ""}${suffix}`,
      title: `Friction ${word}s over one period`,
      caption: label,
      draw: (canvas) => traces(canvas, samples, endsOfMany(members), `friction ${word}`, "_force"),
      table: () => columnsOf(samples, ["time", ...members]),
    });
  }
  for (const mass of portraits) {
    const [x, v] = [`${mass}_displacement`, `${mass}_velocity`];
    figures.push({
      name: `orbit_phase_portrait_${mass}${suffix}`,
      title: `Phase portrait of ${words(mass)}`,
      caption: label,
      ratio: 0.7,
      draw: (canvas) =>
        loop(canvas, samples.get(x), samples.get(v), `displacement of ${words(mass)}`, "velocity"),
      table: () => columnsOf(samples, ["time", x, v]),
    });
  }
  for (const contact of endsOfMany(contactsOf(samples))) {
    const [u, v, f] = [`${contact}_displacement`, `${contact}_sliding_velocity`, `${contact}_force`];
    figures.push({
      name: `orbit_friction_loop_${contact}${suffix}`,
      title: `Friction-force loop of ${words(contact)}`,
      ratio: 0.7,
      caption: `${label}; its area is the energy lost in a period`,
      draw: (canvas) =>
        loop(canvas, samples.get(u), samples.get(f), "relative displacement", "friction force"),
      table: () => columnsOf(samples, ["time", u, v, f]),
    });
  }
  return figures;
}

// "ω = 250 rpm, I = 6.36 kg" of row k.
export function orbitLabel(group, k) {
  return group
    .along("orbit")
    .filter(({ name }) => name !== "row_start")
    .map((coordinate) => coordinateText(coordinate, k))
    .join(", ");
}
