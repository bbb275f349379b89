// The page of one motion: a free vibration or a forced one from given initial values.
import { motionFigureParts } from "../figures/motion_figures.js";
import { dampingRatio, isRounding, motionOf } from "../motion.js";
import { decrementText, restText, sparseText, whatItMeans } from "../motion_words.js";
import { element, section, table } from "../parts/elements.js";
import { figureCards } from "../parts/figure_cards.js";
import { numberText, quantityText, words } from "../units.js";

const kinds = ["decay", "transient"];

export function hasMotion(record) {
  return kinds.some((kind) => record.groups.has(kind));
}

function motionsOf(record) {
  return kinds.filter((kind) => record.groups.has(kind)).map((kind) => motionOf(record, kind));
}

// Columns of the table of masses that any mass has.
const massColumns = [
  ["turning points", ({ turningPoints }) => turningPoints.length || NaN, (value) => numberText(value)],
  [
    "first turning point",
    ({ turningPoints }) => turningPoints[0] ?? NaN,
    (value, { unit }) => quantityText(value, unit),
  ],
  [
    "decrement of the first cycle",
    ({ decrements }) => decrements[0] ?? NaN,
    (value) => decrementText(value, 6),
  ],
  [
    "as viscous damping ratio",
    ({ decrements }) => (isRounding(decrements[0]) ? NaN : dampingRatio(decrements[0] ?? NaN)),
    (value) => numberText(value),
  ],
  [
    "decrement of the last cycle above rounding",
    ({ decrements }) => decrements.at(-1) ?? NaN,
    (value) => decrementText(value, 6),
  ],
  ["rest or limit", ({ rest }) => rest, (value, mass) => restText(mass, 6)],
  ["largest displacement", ({ peak }) => peak, (value, { unit }) => quantityText(value, unit)],
  ["at", ({ peakTime }) => peakTime, (value) => quantityText(value, "s")],
];

function massesTable({ masses }) {
  const columns = massColumns.filter(([, of]) => masses.some((mass) => !Number.isNaN(of(mass))));
  if (columns.length === 0) return [];
  const rows = masses.map((mass) => [
    words(mass.name),
    ...columns.map(([, of, text]) => text(of(mass), mass)),
  ]);
  return [table(["mass", ...columns.map(([name]) => name)], rows, { numeric: columns.map((_, i) => i + 1) })];
}

function factsTable({ group, hysteretic, stopTime, duration, discretisationError, masses, kind }) {
  const rows = [
    ["recorded until", duration, "s"],
    ["all at rest from", stopTime, "s"],
    [
      "reference frequency of hysteretic elements",
      hysteretic ? group.number("reference_frequency") : NaN,
      "rad s-1",
    ],
    ["discretisation error of the run", discretisationError, masses[0]?.unit ?? "m"],
  ]
    .filter(([name, value]) => Number.isFinite(value) || (name === "all at rest from" && kind === "decay"))
    .map(([name, value, unit]) => [
      name,
      Number.isFinite(value) ? quantityText(value, unit, 8) : "not within the duration",
    ]);
  return rows.length ? [table(["", ""], rows)] : [];
}

function turningTable({ name, unit, turningTimes, turningPoints, decrements }) {
  const rows = Array.from(turningTimes, (time, i) => [
    String(i + 1),
    numberText(time, 8),
    quantityText(turningPoints[i], unit),
    decrementText(decrements[i] ?? NaN, 6),
  ]);
  return element(
    "details",
    {},
    element("summary", {}, `Turning points of ${words(name)}`),
    table(["number", "time (s)", "displacement", "logarithmic decrement"], rows, { numeric: [0, 1, 2, 3] }),
  );
}

function energyTable({ energies, group }) {
  const whole = [
    ["energy at the start", "initial_energy"],
    ["work of the excitation", "energy_input"],
    ["energy at the end", "final_energy"],
  ]
    .filter(([, name]) => group.has(name))
    .map(([text, name]) => [text, quantityText(group.number(name), "J"), ""]);
  const rows = energies.map(({ name, energy, share }) => [
    `dissipated by ${words(name)}`,
    quantityText(energy, "J"),
    `${numberText(100 * share, 5)} %`,
  ]);
  const balance = group.number("energy_balance");
  if (rows.length + whole.length === 0) return [];
  return [
    table(
      ["", "energy", "share"],
      [
        ...whole,
        ...rows,
        ...(Number.isFinite(balance) ? [["balance, relative", numberText(balance, 3), ""]] : []),
      ],
      { numeric: [1, 2] },
    ),
  ];
}

function stopsTable({ stops }) {
  const rows = stops.flatMap(({ name, from, to }) =>
    Array.from(from, (start, i) => [
      words(name),
      numberText(start, 8),
      numberText(to[i], 8),
      numberText(to[i] - start, 4),
    ]),
  );
  if (rows.length === 0) return [];
  return [
    element(
      "details",
      {},
      element("summary", {}, `Stops (${rows.length})`),
      table(["contact", "sticks from (s)", "to (s)", "for (s)"], rows, { numeric: [1, 2, 3] }),
    ),
  ];
}

function sparseNotes(motion) {
  const text = sparseText(motion);
  return text ? [element("p", { class: "warning" }, text)] : [];
}

function partsOf(record, motion) {
  const {
    histories: [first, ...others],
    turning,
    energies,
  } = motionFigureParts(motion);
  const energy = energyTable(motion);
  return [
    section(
      "What this means",
      ...whatItMeans(motion).map((sentences) => element("p", { class: "words" }, sentences.join(" "))),
    ),
    section("Numbers", ...massesTable(motion), ...factsTable(motion)),
    ...(first
      ? [
          section(
            "Motion",
            ...sparseNotes(motion),
            ...figureCards([first], record, "wide"),
            ...figureCards(others, record),
            ...stopsTable(motion),
          ),
        ]
      : []),
    ...(turning.length
      ? [
          section(
            "Decay",
            ...figureCards(turning, record),
            ...motion.masses.filter(({ turningTimes }) => turningTimes.length > 0).map(turningTable),
          ),
        ]
      : []),
    ...(energy.length ? [section("Energy", ...energy, ...figureCards(energies, record))] : []),
  ];
}

export function motionParts(record) {
  return motionsOf(record).flatMap((motion) => partsOf(record, motion));
}

export function motionFigures(record) {
  return motionsOf(record).flatMap((motion) => Object.values(motionFigureParts(motion)).flat());
}
