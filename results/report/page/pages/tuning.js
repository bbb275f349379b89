// The page of a tuning: its results as text, the optimum and what holds it, and its progress.
import { symbolText } from "../axes.js";
import { columnFigure, responseFigure, scheduleFigure, weightFigure } from "../figures/tuning_response.js";
import {
  detuningFigure,
  frontFigure,
  gapFigure,
  objectiveLabel,
  roundsFigure,
  startsFigure,
} from "../figures/tuning_progress.js";
import { heldBounds, knotsAtBounds, responseWords, settlingRounds, tuningOf } from "../tuning.js";
import { outcomeWarning, reasonText } from "../certificate_words.js";
import { whatItMeans } from "../tuning_words.js";
import { element, section, table } from "../parts/elements.js";
import { figureCards } from "../parts/figure_cards.js";
import { meaningSection } from "../parts/meaning.js";
import { numberText, quantityText, unitText, withUnit, words } from "../units.js";

function per(value, objectiveUnit, unit) {
  return `${quantityText(value, objectiveUnit)} per ${unitText(unit) || "unit"}`;
}

// The bounds that a parameter lies on, in a design that is no proven optimum.
function metText({ scheduled, ...parameter }) {
  const { lower, upper } = knotsAtBounds(parameter);
  const of = (end, { length }) => `on its ${end} bound${scheduled ? ` at ${length} knots` : ""}`;
  return [...(lower.length ? [of("lower", lower)] : []), ...(upper.length ? [of("upper", upper)] : [])].join(
    "; ",
  );
}

function heldText(tuning, parameter) {
  const held = tuning.converged
    ? heldBounds(tuning, parameter)
        .map(({ end, knots }) => `${end} bound${parameter.scheduled ? `, at ${knots} knots` : ""}`)
        .join("; ")
    : metText(parameter);
  return held || "\u2013";
}

// The gain of moving outwards the bounds that hold the design.
function boundsTable(tuning) {
  const rows = tuning.parameters.flatMap((parameter) =>
    heldBounds(tuning, parameter).map(({ end, knots, multiplier, gain }) => [
      symbolText(parameter.name),
      `${end}${parameter.scheduled ? `, at ${knots} knots` : ""}`,
      per(multiplier, tuning.unit, parameter.unit),
      quantityText((parameter.upper - parameter.lower) / 100, parameter.unit, 4),
      `${numberText(100 * gain, 3)} %`,
    ]),
  );
  if (rows.length === 0) return [];
  return [
    note(
      "Bounds that hold the design: how the objective falls as the bound is moved outwards (to first order; for a schedule " +
        "the sum over its knots).",
    ),
    table(["parameter", "bound", "multiplier", "1 % of the range", "gives"], rows, { numeric: [2, 3, 4] }),
  ];
}

function note(text) {
  return element("p", { class: "note" }, text);
}

function optimumText({ scheduled, values, name }) {
  if (!scheduled) return numberText(values[0] ?? NaN, 8);
  const least = Math.min(...values),
    greatest = Math.max(...values);
  return `${numberText(least)} to ${numberText(greatest)}: schedule, see figure of ${symbolText(name)}`;
}

function changeText({ scheduled, values, before }) {
  if (scheduled || !(before !== 0)) return "\u2013";
  const change = 100 * (values[0] / before - 1);
  return `${change > 0 ? "+" : ""}${numberText(change, 3)} %`;
}

function optimumTable(tuning) {
  const { parameters } = tuning;
  const anyConstant = parameters.some(({ constant }) => Number.isFinite(constant));
  const head = [
    "parameter",
    "optimum",
    "before",
    "change",
    ...(anyConstant ? ["best constant"] : []),
    "lower bound",
    "upper bound",
    tuning.converged ? "held by" : "lies",
  ];
  const rows = parameters.map((parameter) => [
    withUnit(symbolText(parameter.name), unitText(parameter.unit)),
    optimumText(parameter),
    numberText(parameter.before),
    changeText(parameter),
    ...(anyConstant ? [numberText(parameter.constant)] : []),
    numberText(parameter.lower),
    numberText(parameter.upper),
    heldText(tuning, parameter),
  ]);
  return table(head, rows, { numeric: head.map((_, i) => i).slice(2, -1) });
}

function schedulesTables({ parameters, band }) {
  return parameters
    .filter(({ scheduled }) => scheduled)
    .map((parameter) =>
      element(
        "details",
        {},
        element("summary", {}, `Knots of the schedule of ${symbolText(parameter.name)}`),
        table(
          [
            withUnit(symbolText(band.name), unitText(band.unit)),
            withUnit(symbolText(parameter.name), unitText(parameter.unit)),
          ],
          Array.from(parameter.knots, (knot, i) => [numberText(knot), numberText(parameter.values[i])]),
          { numeric: [0, 1] },
        ),
      ),
    );
}

// The share of a peak in holding the optimum; only peaks of a worst case can hold one.
function shareText({ converged }, { active, asHigh, share }) {
  if (!converged) return "not known";
  if (active) return `${numberText(100 * share, 4)} %`;
  return asHigh ? "as high, not active" : "not active";
}

function peaksTable(tuning) {
  const { parameters, place, root, scenarios, records, isWorst: held } = tuning;
  const drawn = tuning.texts.samples && records.length; // many motions: those that hold the design
  const peaks = tuning.peaks.filter(({ active }) => active || !drawn);
  if (peaks.length === 0) return [];
  const several = scenarios.length > 1,
    before = peaks.some((peak) => Number.isFinite(peak.before));
  const head = [
    withUnit(symbolText(place.name), unitText(place.unit)),
    ...(records.length ? ["record"] : []),
    ...(several ? ["scenario"] : []),
    responseWords(tuning),
    ...(before ? ["before"] : []),
    ...(held ? ["share in what holds it"] : []),
    ...parameters.map(({ name, unit: of }) => `by ${symbolText(name)}: per ${unitText(of) || "unit"}`),
  ];
  const rows = peaks.map((peak) => [
    `${numberText(peak.at)}${peak.atEnd ? " (end)" : ""}`,
    ...(records.length ? [peak.record] : []),
    ...(several ? [words(peak.scenario)] : []),
    quantityText(peak.value, root),
    ...(before ? [quantityText(peak.before, root)] : []),
    ...(held ? [shareText(tuning, peak)] : []),
    ...parameters.map(({ sensitivity }) => quantityText(sensitivity[peak.number] ?? NaN, root, 4)),
  ]);
  const texts = ["record", "scenario"];
  const numeric = head.map((_, i) => i).filter((i) => !texts.includes(head[i]));
  return [
    note(
      `Peaks of the design${peaks.some(({ atEnd }) => atEnd) ? ", with the ends of the band to which the response rises (end)" : ""}, ` +
        "and how each changes with each parameter (a schedule is moved as a whole).",
    ),
    table(head, rows, { numeric }),
  ];
}

function multiplierText(tuning, limit) {
  if (limit.excess > 0) {
    const side = limit.brokenEnd === "at most" ? "above" : "below";
    return `${numberText(100 * limit.excess, 4)} % ${side} its limit`;
  }
  if (!tuning.converged) return "not known";
  return limit.active ? per(limit.multiplier, tuning.unit, limit.unit) : "does not bind";
}

function limitsTable(tuning) {
  const { limits, band, scenarios } = tuning;
  if (limits.length === 0) return [];
  const place = ({ at, scenario }) =>
    [
      Number.isFinite(at) && band ? quantityText(at, band.unit) : "\u2013",
      scenarios.length > 1 && scenario ? words(scenario) : "",
    ]
      .filter(Boolean)
      .join(", ");
  const parts = limits.some((limit) => limit.band);
  const partOf = (limit) =>
    limit.band
      ? `${numberText(limit.band.from)} to ${quantityText(limit.band.to, band.unit)}`
      : "the whole band";
  const rows = limits.map((limit) => [
    withUnit(words(limit.name), unitText(limit.unit)),
    ...(parts ? [partOf(limit)] : []),
    numberText(limit.value),
    place(limit),
    numberText(limit.lower),
    numberText(limit.upper),
    multiplierText(tuning, limit),
  ]);
  return [
    note(
      "Limits: the quantity where it is nearest to its limit, and how the objective falls as the limit is relaxed.",
    ),
    table(
      ["limit on", ...(parts ? ["over"] : []), "nearest", "at", "at least", "at most", "multiplier"],
      rows,
      { numeric: [1, 3, 4].map((column) => column + (parts ? 1 : 0)) },
    ),
  ];
}

// "8, the best is number 3, counted from 0"; one start has no best.
function startsText({ group, texts }) {
  const number = group.values("start_objective")?.length ?? 1,
    start = texts.start ?? "given";
  const from = start === String(number) ? "" : ` (${words(start)})`;
  const best = number > 1 ? `, the best is number ${group.number("best_start")}, counted from 0` : "";
  return `${number}${from}${best}`;
}

function factsTable(tuning) {
  const { group, texts, isAmplitude } = tuning;
  const count = (name) => (group.number(name) > 0 ? numberText(group.number(name), 12) : "");
  const proof = (name) => numberText(group.number(name), 3);
  const rows = [
    [objectiveLabel(tuning), quantityText(tuning.objective, tuning.unit, 8)],
    ...(isAmplitude
      ? [["certificate gap", proof("certificate_gap")]]
      : [["its root", quantityText(Math.sqrt(tuning.objective), tuning.root, 8)]]),
    ...(Number.isFinite(group.number("path_bound"))
      ? [
          [
            "lower bound for every schedule with these constants, as far as a grid shows",
            quantityText(group.number("path_bound"), tuning.unit, 8),
          ],
        ]
      : []),
    ...tuning.parameters
      .filter(({ jump }) => Number.isFinite(jump.at))
      .map(({ name, unit, jump }) => [
        `${name} jumps at`,
        `${quantityText(jump.at, tuning.band.unit, 8)}, from ${quantityText(jump.from, unit, 6)} to ${quantityText(jump.to, unit, 6)}`,
      ]),
    ["KKT residual", proof("kkt_residual")],
    ["violation of limits, relative", numberText(group.number("violation"), 3)],
    ["outcome", words(tuning.outcome)],
    ["reason", reasonText(tuning)],
    ["iterations", count("iterations")],
    ["orbits", count("orbits")],
    ["gradients", count("gradients")],
    ["solver", texts.solver ?? ""],
    ["starts", startsText(tuning)],
  ];
  return table(
    ["", ""],
    rows.filter(([, text]) => text !== ""),
  );
}

// For which excitation each scenario holds, where these differ in it; many are folded up.
function excitationsTable({ excitations }) {
  if (excitations.length === 0) return null;
  const shown = 8;
  const rows = excitations.map(({ scenario, excitation }) => [words(scenario), excitation]);
  const listed = table(["scenario", "excitation for which it holds"], rows);
  if (rows.length <= shown) return listed;
  return element(
    "details",
    {},
    element("summary", {}, `Excitation of each of ${rows.length} scenarios`),
    listed,
  );
}

function worstTable(tuning) {
  const names = { before: "before", after: "tuned", constant: "best constant", rule: "by the rule" };
  const known = Object.entries(names).filter(([design]) => Number.isFinite(tuning.worst[design]));
  if (known.length === 0) return null;
  const rows = known.map(([design, name]) => [name, quantityText(tuning.worst[design], tuning.unit)]);
  return table(["design", objectiveLabel(tuning)], rows, { numeric: [1] });
}

// The caption states the other objective of the last rounds, if they have one.
function roundsCaption(tuning) {
  const count = settlingRounds(tuning);
  if (count === 0) return "Rounds of the tuning.";
  const last = count === 1 ? "The last reduces" : `The last ${count} reduce`;
  return `Rounds of the tuning. ${last} the mean response with the worst peak fixed: there "bound" is that mean.`;
}

function roundsTable(tuning) {
  const { group, unit, isWorst, records } = tuning;
  const active = group.values("round_active");
  if (!active) return null;
  const of = (name, i) => group.values(name)[i];
  const rows = Array.from(active, (count, i) => [
    String(i + 1),
    ...(isWorst ? [String(count)] : []),
    String(of("round_iterations", i)),
    quantityText(of("round_bound", i), unit),
    ...(isWorst ? [quantityText(of("round_worst", i), unit)] : []),
    numberText(of("round_violation", i), 3),
  ]);
  const head = [
    "round",
    ...(isWorst ? [`active ${records.length ? "instants" : "frequencies"}`] : []),
    "iterations",
    "bound",
    ...(isWorst ? ["worst"] : []),
    "violation",
  ];
  return table(head, rows, { numeric: head.map((_, i) => i), caption: roundsCaption(tuning) });
}

function frontTable({ front, parameters, limits, unit }) {
  if (!front) return null;
  const limit = front.column("trade_off"),
    of = (name, i) => front.values(name)?.[i];
  const constants = parameters.filter(({ name }) => front.has(name));
  const head = [
    withUnit(`limit of ${words(limits.at(-1)?.name ?? "trade-off")}`, unitText(limit.unit)),
    "objective",
    ...constants.map(({ name, unit: of }) => withUnit(symbolText(name), unitText(of))),
    "certificate gap",
    "violation",
    "outcome",
  ];
  const rows = Array.from(limit.values, (value, i) => [
    numberText(value),
    quantityText(of("objective", i), unit),
    ...constants.map(({ name }) => numberText(of(name, i))),
    numberText(of("certificate_gap", i), 2),
    numberText(of("violation", i), 2),
    words(front.word("outcome", i)),
  ]);
  return table(head, rows, { numeric: head.map((_, i) => i).slice(0, -1) });
}

function resultFigures(tuning) {
  const { band, parameters, columns } = tuning;
  if (!band) return [];
  return [
    ...(tuning.responses.length ? [responseFigure(tuning)] : []),
    ...parameters
      .filter(({ scheduled, values }) => scheduled && values.length)
      .map((parameter) => scheduleFigure(tuning, parameter, knotsAtBounds(parameter))),
    ...columns.map((column) => columnFigure(tuning, column)),
    ...(tuning.weight ? [weightFigure(tuning)] : []),
  ];
}

function frontFigures(tuning) {
  return tuning.front ? [frontFigure(tuning)] : [];
}

function detuningFigures(tuning) {
  return tuning.parameters.some(({ detuning }) => detuning?.some(Number.isFinite))
    ? [detuningFigure(tuning)]
    : [];
}

function progressFigures(tuning) {
  const { group, isWorst } = tuning;
  const several = (name) => (group.values(name)?.length ?? 0) > 1;
  return [
    ...(several("round_bound") ? [roundsFigure(tuning), ...(isWorst ? [gapFigure(tuning)] : [])] : []),
    ...(several("start_objective") ? [startsFigure(tuning)] : []),
  ];
}

// The section, unless it is empty.
function sectionOf(title, children) {
  const known = children.filter((child) => child !== null);
  return known.length ? [section(title, ...known)] : [];
}

export function tuningParts(record) {
  const tuning = tuningOf(record),
    warning = outcomeWarning(tuning);
  const [first, ...others] = resultFigures(tuning);
  return [
    ...(warning ? [element("p", { class: "warning" }, warning)] : []),
    meaningSection(whatItMeans(tuning)),
    ...sectionOf("Optimum", [
      optimumTable(tuning),
      ...schedulesTables(tuning),
      worstTable(tuning),
      excitationsTable(tuning),
    ]),
    ...sectionOf(
      "Response",
      first ? [...figureCards([first], record, "wide"), ...figureCards(others, record)] : [],
    ),
    ...sectionOf("Trade-off", [...figureCards(frontFigures(tuning), record), frontTable(tuning)]),
    ...sectionOf("What determines the design", [
      ...peaksTable(tuning),
      ...boundsTable(tuning),
      ...limitsTable(tuning),
      ...figureCards(detuningFigures(tuning), record),
    ]),
    ...sectionOf("How it was found", [
      factsTable(tuning),
      ...figureCards(progressFigures(tuning), record),
      roundsTable(tuning),
    ]),
  ];
}

export function tuningFigures(record) {
  const tuning = tuningOf(record);
  return [
    ...resultFigures(tuning),
    ...frontFigures(tuning),
    ...detuningFigures(tuning),
    ...progressFigures(tuning),
  ];
}
