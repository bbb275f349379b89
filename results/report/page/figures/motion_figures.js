// Histories of a motion, its turning points, phase portraits, decrements, and where its energy goes.
import { decrementsEndEarly, envelope, isOneMode, isRounding, samplingOf, stretch } from "../motion.js";
import { approachOf, restText } from "../motion_words.js";
import { groupedByUnit, sentence, shareText, quantityText, words } from "../units.js";
import { barFigure } from "./bar_figure.js";
import { lineFigure, style } from "./line_figure.js";
import { lineColours } from "./frame.js";

const bandColours = [
  lineColours[4],
  lineColours[3],
  lineColours[2],
  lineColours[6],
  lineColours[1],
  lineColours[5],
];
const shownTurns = 12; // of a stretch at the start or at the end
const timeAxis = ({ units }) => ({ label: "time", name: "time", unit: units.time, tight: true });

function stuckBands({ stops }) {
  return stops.map(({ name, from, to }, i) => ({
    text: `${words(name)} sticks`,
    from,
    to,
    fill: bandColours[i % bandColours.length],
  }));
}

function moments({ stopTime, units }) {
  const from = stopTime === 0 ? "the start" : quantityText(stopTime, units.time, 5);
  return Number.isFinite(stopTime) ? [{ x: stopTime, text: `all at rest from ${from}`, dash: "2 3" }] : [];
}

const sparseCaption = "Samples, not joined: they are too far apart to show the motion between them.";

// Draws curves as dots if the samples are too far apart to be joined.
function joinedOrDots(motion, lines) {
  return samplingOf(motion).sparse
    ? { lines: [], points: lines.map((line) => ({ ...line, r: 1.5 })), caption: sparseCaption }
    : { lines, points: [], caption: "" };
}

const several = (masses) => masses.length > 1;

// Masses that move farthest first, so that they do not hide the others; each keeps its colour.
function farthestFirst(masses, quantity) {
  const extent = ({ values }) => values.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
  return masses
    .map((mass, i) => ({ mass, stroke: style(i).stroke, extent: extent(mass[quantity]) }))
    .sort((a, b) => b.extent - a.extent);
}

function historyLines(motion, quantity, { from, to } = { from: 0, to: motion.time.values.length }) {
  const shown = motion.masses.filter((mass) => mass[quantity]);
  const x = motion.time.values.subarray(from, to);
  return farthestFirst(shown, quantity).map(({ mass, stroke }) => ({
    name: mass[quantity].name,
    text: several(shown) ? words(mass.name) : "",
    x,
    y: mass[quantity].values.subarray(from, to),
    width: 1.3,
    stroke,
  }));
}

// The motion with the masses that can share an axis, once for each unit of displacement.
function partsByUnit(motion) {
  const moving = motion.masses.filter(({ displacement }) => displacement);
  return groupedByUnit(moving, ({ displacement }) => displacement.unit).map(({ unit, members }) => ({
    ...motion,
    masses: members,
    suffix: unit === "rad" && members.length < moving.length ? "_of_rotations" : "",
  }));
}

function titleOf(motion, quantity) {
  const shown = motion.masses.filter((mass) => mass[quantity]);
  const [one, many] =
    quantity === "velocity" ? ["Velocity", "Velocities"] : ["Displacement", "Displacements"];
  const signals = shown.some(({ noun }) => noun === "signal") ? " and signals" : "";
  return several(shown) ? `${many} of the masses${signals}` : `${one} of ${words(shown[0].name)}`;
}

const unitOf = (motion, quantity) => motion.masses.find((mass) => mass[quantity])[quantity].unit;

function historyFigure(motion, quantity) {
  const displacement = quantity === "displacement";
  return lineFigure({
    name: `${quantity}${motion.suffix}`,
    title: titleOf(motion, quantity),
    ratio: displacement ? 0.45 : undefined,
    x: { ...timeAxis(motion), ...(Number.isFinite(motion.stopTime) ? { tight: false, zero: true } : {}) },
    y: { label: quantity, unit: unitOf(motion, quantity) },
    ...joinedOrDots(motion, historyLines(motion, quantity)),
    bands: displacement ? stuckBands(motion) : [],
    moments: displacement ? moments(motion) : [],
  });
}

// Each record over the time of the motion below it, so that both share one axis.
function recordFigure({ name, time, values, unit, meaning }, motion) {
  const ends = [motion.time.values[0], motion.time.values.at(-1)];
  return lineFigure({
    name,
    title: sentence(meaning),
    caption: "The record, with its scale, on the time axis of the motion.",
    ratio: 0.25,
    x: { ...timeAxis(motion), domain: ends },
    y: { label: words(name.replace(/^.*_recorded_/, "")), unit },
    lines: [{ name, x: time, y: values, stroke: lineColours[7], width: 1 }],
  });
}

// The stops that reach into a stretch of time, cut to it.
function within(bands, low, high) {
  return bands
    .map(({ from, to, ...band }) => {
      const rows = Array.from(from, (_, i) => i).filter((i) => to[i] >= low && from[i] <= high);
      return {
        ...band,
        from: rows.map((i) => Math.max(low, from[i])),
        to: rows.map((i) => Math.min(high, to[i])),
      };
    })
    .filter(({ from }) => from.length > 0);
}

// The first and the last few cycles of a motion so long that its history shows no single cycle.
function cyclesFigures(motion) {
  return ["first", "last"].flatMap((end) => {
    const part = stretch(motion, shownTurns, end);
    if (!part) return [];
    const lines = historyLines(motion, "displacement", part),
      { x } = lines[0];
    return [
      lineFigure({
        name: `displacement_${end}_cycles${motion.suffix}`,
        title: `The ${end} cycles`,
        caption: "",
        x: timeAxis(motion),
        y: { label: "displacement", unit: unitOf(motion, "displacement") },
        lines,
        bands: within(stuckBands(motion), x[0], x[x.length - 1]),
      }),
    ];
  });
}

const restWords = { rests: "rest at", held: "rest at", tends: "tends to", moves: "rest, not reached:" };

function turningFigure(motion, mass) {
  const { name, unit, displacement, turningTimes, turningPoints, rest } = mass;
  const { upper, lower } = envelope(mass);
  const side = ({ x, y }, text) => ({
    name: `${name}_envelope_${text ? "upper" : "lower"}`,
    text,
    x,
    y,
    stroke: lineColours[1],
    dash: "5 3",
    width: 1.2,
    silent: true,
  });
  return lineFigure({
    name: `turning_points_${name}`,
    title: `Turning points of ${words(name)}`,
    caption: "The envelope joins the turning points of each side.",
    x: { ...timeAxis(motion), tight: false, zero: true },
    y: { label: "displacement", unit },
    lines: [
      ...(displacement && !samplingOf(motion).sparse
        ? [
            {
              name: displacement.name,
              text: "displacement",
              x: motion.time.values,
              y: displacement.values,
              stroke: lineColours[0],
              width: 1.3,
            },
          ]
        : []),
      side(upper, "envelope"),
      side(lower, ""),
    ],
    points: [
      {
        name: `${name}_extremum`,
        text: "turning point",
        x: turningTimes,
        y: turningPoints,
        stroke: lineColours[1],
        r: 2.6,
        symbol: "open",
      },
    ],
    levels: Number.isFinite(rest)
      ? [{ y: rest, text: `${restWords[approachOf(mass, motion)]} ${restText(mass)}`, dash: "1 3" }]
      : [],
    moments: moments(motion),
  });
}

function decrementFigure(motion) {
  const { masses } = motion;
  const meaning = isOneMode(motion)
    ? "With viscous damping it is the same in every cycle; friction makes it grow."
    : "It is computed from displacements from zero: for a mass that swings about another place, or in several modes at once, it " +
      "is not a measure of the damping.";
  const shown = masses.filter(({ decrements }) => decrements.length > 0);
  const early = shown.some(decrementsEndEarly)
    ? " It ends before the motion does, because the turning points after it are rounding."
    : "";
  const lines = shown.map(({ name, decrements }, i) => ({
    name: `${name}_log_decrement`,
    text: several(shown) ? words(name) : "",
    x: Float64Array.from(decrements, (_, k) => k / 2),
    y: decrements,
    ...style(i),
  }));
  return lineFigure({
    name: "log_decrement",
    title: "Logarithmic decrement from cycle to cycle",
    caption: `Over a full cycle from each turning point. ${meaning}${early}`,
    x: { label: "cycles since the first turning point", name: "cycle", unit: "1" },
    y: { label: "logarithmic decrement", unit: "1", zero: true },
    lines,
    points: lines.map((line) => ({ ...line, text: "", silent: true, r: 2.6 })),
  });
}

function portraitFigure({ name, displacement, velocity }) {
  return lineFigure({
    name: `phase_portrait_${name}`,
    title: `Phase portrait of ${words(name)}`,
    caption: "The filled point is the start.",
    ratio: 0.8,
    x: { label: "displacement", name: displacement.name, unit: displacement.unit },
    y: { label: "velocity", unit: velocity.unit },
    lines: [
      {
        name: velocity.name,
        x: displacement.values,
        y: velocity.values,
        stroke: lineColours[0],
        width: 1.2,
        path: true,
      },
    ],
    points: [
      {
        name: "start",
        x: displacement.values.subarray(0, 1),
        y: velocity.values.subarray(0, 1),
        stroke: lineColours[1],
        r: 4,
        silent: true,
      },
    ],
  });
}

function runFigure(motion) {
  const { masses, frequency, discretisationError } = motion;
  const shown = masses.filter(({ displacement }) => displacement);
  const rising = frequency.values[0] < frequency.values.at(-1);
  const order = (values) => (rising ? values : Float64Array.from(values).reverse());
  const x = order(frequency.values);
  const drawn = joinedOrDots(
    motion,
    shown.map(({ name, displacement }, i) => ({
      name: displacement.name,
      text: several(shown) ? words(name) : "",
      x,
      y: order(displacement.values),
      width: 1.3,
      stroke: style(i).stroke,
    })),
  );
  const error = Number.isFinite(discretisationError)
    ? `Discretisation error of the run: ${quantityText(discretisationError, shown[0].unit, 3)}.`
    : "";
  return lineFigure({
    name: "run",
    title: `Displacement over the excitation's frequency, run ${rising ? "up" : "down"}`,
    ratio: 0.45,
    x: { label: "frequency of the excitation", name: "frequency", unit: frequency.unit, tight: true },
    y: { label: "displacement", unit: shown[0].displacement.unit },
    ...drawn,
    caption: [error, drawn.caption].filter(Boolean).join(" "),
  });
}

function frequencyFigure(motion) {
  const { time, frequency } = motion;
  return lineFigure({
    name: "frequency",
    title: "Frequency of the excitation",
    caption: "",
    x: timeAxis(motion),
    y: { label: "frequency of the excitation", unit: frequency.unit },
    lines: [{ name: "frequency", x: time.values, y: frequency.values, stroke: lineColours[0] }],
  });
}

function budgetFigure({ energies, units }) {
  const sorted = [...energies].sort((a, b) => b.energy - a.energy);
  return barFigure({
    name: "damping_budget",
    title: "Damping budget",
    caption: "What each element has dissipated from start to end, and its share of all.",
    label: "energy dissipated",
    unit: units.energy,
    bars: sorted.map(({ name, energy, share }) => ({
      name: words(name),
      value: energy,
      note: shareText(share),
    })),
  });
}

function dissipationFigure(motion) {
  const { time, energies, units } = motion;
  const shown = energies.filter(({ dissipated }) => dissipated);
  return lineFigure({
    name: "dissipation",
    title: "Energy dissipated so far",
    caption: "",
    x: timeAxis(motion),
    y: { label: "energy dissipated", unit: units.energy, zero: true },
    lines: shown.map(({ name, dissipated }, i) => ({
      name: dissipated.name,
      text: words(name),
      x: time.values,
      y: dissipated.values,
      ...style(i),
    })),
  });
}

// {records, histories, turning, energies}: figures of each part of the page.
export function motionFigureParts(motion) {
  const { masses, time, frequency, energies } = motion;
  const { sparse } = samplingOf(motion);
  const histories = time && masses.some(({ displacement }) => displacement);
  const parts = partsByUnit(motion);
  return {
    records: histories ? motion.records.map((record) => recordFigure(record, motion)) : [],
    histories: histories
      ? [
          ...parts.map((part) => historyFigure(part, "displacement")),
          ...(sparse ? [] : parts.flatMap(cyclesFigures)),
          ...(frequency ? [runFigure(motion), frequencyFigure(motion)] : []),
          ...parts
            .filter((part) => part.masses.some(({ velocity }) => velocity))
            .map((part) => historyFigure(part, "velocity")),
          ...masses
            .filter(({ displacement, velocity }) => !sparse && displacement && velocity)
            .map(portraitFigure),
        ]
      : [],
    turning: [
      ...masses
        .filter(({ turningPoints }) => turningPoints.length > 0)
        .map((mass) => turningFigure(motion, mass)),
      ...(masses.some(({ decrements }) => decrements.some((decrement) => !isRounding(decrement)))
        ? [decrementFigure(motion)]
        : []),
    ],
    energies: [
      ...(energies.some(({ energy }) => energy > 0) ? [budgetFigure(motion)] : []),
      ...(time && energies.some(({ dissipated }) => dissipated) ? [dissipationFigure(motion)] : []),
    ],
  };
}
