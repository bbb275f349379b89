// The page of one motion: a free vibration or a forced one from given initial values.
import { motionFigureParts } from "../figures/motion_figures.js";
import { dampingRatio, isOneMode, isRounding, isStill, motionOf, swingsAboutZero } from "../motion.js";
import { decrementText, restText, sparseText, whatItMeans } from "../motion_words.js";
import { element, section, table } from "../parts/elements.js";
import { figureCards } from "../parts/figure_cards.js";
import { meaningSection } from "../parts/meaning.js";
import { numberText, shareText, quantityText, withUnit, unitText, words } from "../units.js";

const kinds = ["decay", "transient"];

export function hasMotion(record) {
  return kinds.some((kind) => record.groups.has(kind));
}

function motionsOf(record) {
  return kinds.filter((kind) => record.groups.has(kind)).map((kind) => motionOf(record, kind));
}

const turnsOf = (mass, motion) => (isStill(mass, motion) ? [] : mass.turningPoints);
const decrementsOf = (mass, motion) => (swingsAboutZero(mass, motion) ? mass.decrements : []);

function ratioOf(mass, motion) {
  const [first = NaN] = decrementsOf(mass, motion);
  return isOneMode(motion) && !isRounding(first) ? dampingRatio(first) : NaN;
}

// Columns of the table of masses that any mass has: heading, number and its text, both of a mass and its motion.
const massColumns = [
  ["turns", (mass, motion) => turnsOf(mass, motion).length || NaN, (value) => numberText(value)],
  [
    "first turn",
    (mass, motion) => turnsOf(mass, motion)[0] ?? NaN,
    (value, { unit }) => quantityText(value, unit),
  ],
  [
    "decrement, first cycle",
    (mass, motion) => decrementsOf(mass, motion)[0] ?? NaN,
    (value) => decrementText(value, 6),
  ],
  ["as damping ratio", ratioOf, (value) => numberText(value)],
  [
    "decrement, last cycle",
    (mass, motion) => decrementsOf(mass, motion).at(-1) ?? NaN,
    (value) => decrementText(value, 6),
  ],
  ["rest or limit", ({ rest }) => rest, (value, mass) => restText(mass, 6)],
  ["largest displacement", ({ peak }) => peak, (value, { unit }) => quantityText(value, unit)],
  ["at", ({ peakTime }) => peakTime, (value, _, { units }) => quantityText(value, units.time)],
];

function massesTable(motion) {
  const { masses } = motion;
  const columns = massColumns.filter(([, of]) => masses.some((mass) => !Number.isNaN(of(mass, motion))));
  if (columns.length === 0) return [];
  const rows = masses.map((mass) => [
    words(mass.name),
    ...columns.map(([, of, text]) => text(of(mass, motion), mass, motion)),
  ]);
  const nouns = [...new Set(masses.map(({ noun }) => noun))];
  return [
    table([nouns.join(" or "), ...columns.map(([name]) => name)], rows, {
      numeric: columns.map((_, i) => i + 1),
    }),
  ];
}

function stopText({ stopTime, units }) {
  if (Number.isNaN(stopTime)) return "not within the duration";
  return stopTime === 0 ? "the start" : quantityText(stopTime, units.time, 8);
}

// The single numbers of a motion that the page shows nowhere else.
function factsTable(motion) {
  const { group, hysteretic, duration, discretisationError, units, kind } = motion;
  const reference = hysteretic ? group.column("reference_frequency") : undefined;
  const text = (value, unit) => (Number.isFinite(value) ? quantityText(value, unit, 8) : "");
  const rows = [
    ["recorded until", text(duration, units.time)],
    ["all at rest from", kind === "decay" ? stopText(motion) : ""],
    ["reference frequency of hysteretic elements", text(reference?.values[0], reference?.unit)],
    [
      "discretisation error of the run",
      text(discretisationError, group.column("discretisation_error")?.unit),
    ],
  ].filter(([, value]) => value !== "");
  return rows.length ? [table(["", ""], rows)] : [];
}

function turningTable({ name, unit, turningTimes, turningPoints, decrements }, { units }) {
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
    table(["number", withUnit("time", unitText(units.time)), "displacement", "logarithmic decrement"], rows, {
      numeric: [0, 1, 2, 3],
    }),
  );
}

function energyTable({ energies, group, units }) {
  const whole = [
    ["energy at the start", "initial_energy"],
    ["work of the excitation", "energy_input"],
    ["energy at the end", "final_energy"],
  ]
    .filter(([, name]) => group.has(name))
    .map(([text, name]) => [text, quantityText(group.number(name), units.energy), ""]);
  const rows = energies.map(({ name, energy, share }) => [
    `dissipated by ${words(name)}`,
    quantityText(energy, units.energy),
    shareText(share, 5),
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

function stopsTable({ stops, units }) {
  const headed = (text) => withUnit(text, unitText(units.time));
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
      table(["contact", ...["sticks from", "to", "for"].map(headed)], rows, { numeric: [1, 2, 3] }),
    ),
  ];
}

function sparseNotes(motion) {
  const text = sparseText(motion);
  return text ? [element("p", { class: "warning" }, text)] : [];
}

function partsOf(record, motion) {
  const {
    records,
    histories: [first, ...others],
    turning,
    energies,
  } = motionFigureParts(motion);
  const energy = energyTable(motion);
  return [
    meaningSection(whatItMeans(motion)),
    section("Numbers", ...massesTable(motion), ...factsTable(motion)),
    ...(first
      ? [
          section(
            "Motion",
            ...sparseNotes(motion),
            ...figureCards([...records, first], record, "wide"),
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
            ...motion.masses
              .filter(({ turningTimes }) => turningTimes.length > 0)
              .map((mass) => turningTable(mass, motion)),
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
