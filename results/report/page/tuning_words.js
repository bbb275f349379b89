// The results of a tuning as sentences, computed here from the numbers of the record.
import { symbolText } from "./axes.js";
import { certificateSentences } from "./certificate_words.js";
import { heldBounds, knotsAtBounds, nearestToConstant, quantityWords, steepestPieces } from "./tuning.js";
import { numberText, quantityText, sentence, unitText, words } from "./units.js";

const digits = 4;
const mostIntervals = 4; // that a sentence lists one by one

// The change from one amplitude to another: {percent: reduction, decibel: 20 log10(after / before)}.
export function reduction(before, after) {
  return { percent: 100 * (1 - after / before), decibel: 20 * Math.log10(after / before) };
}

// Where y >= 0 along x, by linear interpolation: {intervals: [[from, to], ...], share of the whole}.
export function nonNegative(x, y) {
  const intervals = [];
  const extend = (from, to) => {
    if (intervals.length && intervals.at(-1)[1] === from) intervals.at(-1)[1] = to;
    else intervals.push([from, to]);
  };
  for (let i = 0; i + 1 < x.length; ++i) {
    const [a, b] = [y[i], y[i + 1]];
    const zero = x[i] + ((x[i + 1] - x[i]) * a) / (a - b);
    if (a >= 0 && b >= 0) extend(x[i], x[i + 1]);
    else if (a >= 0 && b < 0 && zero > x[i]) extend(x[i], zero);
    else if (a < 0 && b >= 0 && zero < x[i + 1]) extend(zero, x[i + 1]);
  }
  const length = intervals.reduce((sum, [from, to]) => sum + to - from, 0);
  return { intervals, share: length / (x[x.length - 1] - x[0]) };
}

// Where the tuned response is at or below the one before, in every scenario.
export function bandBelowBefore({ band, responses }) {
  const of = (design) =>
    responses.filter((response) => response.design === design).map(({ values }) => values);
  const before = of("before"),
    after = of("after");
  if (!band || before.length === 0 || before.length !== after.length) return null;
  const least = Array.from(band.values, (_, i) =>
    Math.min(...before.map((values, s) => values[i] * (1 + 1e-9) - after[s][i])),
  );
  return nonNegative(band.values, least);
}

// The largest growth of the objective when one parameter is off by `change`: {growth, name, change}, or null.
export function worstDetuning({ group, parameters }, change) {
  const changes = Array.from(group.values("change") ?? []);
  let worst = null;
  for (const { name, detuning } of parameters) {
    changes.forEach((value, i) => {
      if (
        !detuning ||
        Math.abs(Math.abs(value) - change) > 1e-9 ||
        !(detuning[i] > (worst?.growth ?? -Infinity))
      )
        return;
      worst = { growth: detuning[i], name, change: value };
    });
  }
  return worst;
}

const percentText = (value, places = 3) => `${numberText(value, places)} %`;

function lessText(before, after) {
  const { percent, decibel } = reduction(before, after);
  if (Math.abs(percent) < 1e-3) return "the same to 0.001 %";
  const change = `${percentText(Math.abs(percent))} ${percent > 0 ? "less" : "more"}`;
  return `${change} (${decibel > 0 ? "+" : ""}${numberText(decibel, 3)} dB)`;
}

const kindWords = {
  minimax: "worst",
  worst_peak: "worst",
  mean_peak: "mean",
  mean_square: "root mean square of",
  variance: "standard deviation of",
};

function spoken(tuning) {
  const weighted = tuning.weight ? "weighted " : "";
  return `${kindWords[tuning.kind] ?? words(tuning.kind)} ${weighted}${quantityWords(tuning)}`;
}

// The objective as an amplitude: itself, or the root of a mean square or variance.
function amplitude(tuning, objective) {
  return tuning.isAmplitude ? objective : Math.sqrt(objective);
}

function placeText(tuning, value) {
  return quantityText(value, tuning.place.unit, digits);
}

function bandText(tuning) {
  const { values, unit } = tuning.band,
    after = unitText(unit);
  return (
    `${numberText(values[0], digits)} to ${numberText(values.at(-1), digits)}${after ? ` ${after}` : ""} of ` +
    `${symbolText(tuning.band.name)}`
  );
}

function scenarioText({ scenarios, records, isWorst, texts }) {
  const over = [
    ...(records.length > 1 ? [`${records.length} records`] : []),
    ...(scenarios.length > 1 ? [`${scenarios.length} scenarios`] : []),
  ].join(" and ");
  if (over === "") return "";
  if (texts.samples && scenarios.length > 1) {
    const share = Number(texts.quantile ?? 1);
    return share < 1
      ? `, the ${numberText(100 * share, 4)} % quantile of the worst of each of ${scenarios.length} samples`
      : `, over ${scenarios.length} samples`;
  }
  return isWorst ? `, in the worst of ${over}` : `, as the mean of ${over}`;
}

// The conditions of a variance: "relative to base under white noise, ...".
function noiseText({ texts }) {
  const { noise, noise_density: density, relative_to: support } = texts;
  if (!noise) return "";
  const [, number, unit = ""] = /^(\S+) ?(.*)$/.exec(density);
  const [squared, per] = unit.split(" per ").map(unitText);
  const of = unit ? `${squared} per ${per}` : "";
  return (
    `${support ? ` relative to ${words(support)}` : ""} under white noise, ${words(noise)} ` +
    `(two-sided spectral density ${numberText(Number(number))}${of ? ` ${of}` : ""})`
  );
}

function reductionSentences(tuning) {
  const level = (objective) => quantityText(amplitude(tuning, objective), tuning.root, digits);
  const over = tuning.kind !== "variance" && tuning.band ? ` over ${bandText(tuning)}` : "";
  const { before, constant, rule, after } = tuning.worst;
  const tuned = amplitude(tuning, Number.isFinite(after) ? after : tuning.objective);
  const against = (name, other) =>
    Number.isFinite(other) && other > 0
      ? [`Against ${name} (${level(other)}): ${lessText(amplitude(tuning, other), tuned)}.`]
      : [];
  return [
    `${sentence(spoken(tuning))}${over}${noiseText(tuning)}${scenarioText(tuning)}: ${level(tuning.objective)}.`,
    ...against("the design before", before),
    ...against("the best design without a schedule", constant),
    ...against("the rule", rule),
  ];
}

function listText(texts) {
  return texts.length < 2 ? texts.join("") : `${texts.slice(0, -1).join(", ")} and ${texts.at(-1)}`;
}

function intervalText(tuning, { intervals, share }) {
  if (share > 1 - 1e-9) return "over the whole band";
  const told =
    intervals.length > mostIntervals
      ? `${intervals.length} stretches`
      : listText(intervals.map(([from, to]) => `${numberText(from, digits)} to ${placeText(tuning, to)}`));
  return `over ${percentText(100 * share)} of the band${intervals.length ? ` (${told})` : ""}`;
}

function bandSentences(tuning) {
  if (!tuning.band) return [];
  const sentences = [];
  if (tuning.kind === "minimax")
    sentences.push(
      `The ${tuning.weight ? "weighted " : ""}response stays at or below ${quantityText(tuning.objective, tuning.unit, digits)} over the whole band, ` +
        `${bandText(tuning)}.`,
    );
  const below = bandBelowBefore(tuning);
  if (below)
    sentences.push(
      `It is at or below the response before ` +
        `${intervalText(tuning, below)}${tuning.scenarios.length > 1 ? ", in every scenario" : ""}.`,
    );
  return sentences;
}

// The active peaks, bounds and limits that hold the design, as phrases.
function holders(tuning) {
  const peaks = tuning.peaks
    .filter(({ active }) => active)
    .map(
      ({ at, atEnd, share, scenario, record }) =>
        `the ${atEnd ? "response" : "peak"} at ${placeText(tuning, at)}${atEnd ? ", the end of the band" : ""}` +
        `${record || scenario ? ` (${[record, words(scenario)].filter(Boolean).join(", ")})` : ""}, share ` +
        `${percentText(100 * share)}`,
    );
  const bounds = tuning.parameters.flatMap((parameter) =>
    heldBounds(tuning, parameter).map(
      ({ end, knots, gain }) =>
        `the ${end} bound of ` +
        `${symbolText(parameter.name)}${parameter.scheduled ? ` at ${knots} of ${parameter.knots.length} knots` : ""}` +
        ` (moved out by 1 % of the range it gives ${percentText(100 * gain, 2)}, to first order)`,
    ),
  );
  const limits = tuning.limits
    .filter(({ active }) => active)
    .map(
      ({ name, value, multiplier }) =>
        `the limit of ${words(name)} (relaxed by 1 % it gives ` +
        `${percentText((multiplier * Math.abs(value)) / tuning.objective, 2)}, to first order)`,
    );
  return [...peaks, ...bounds, ...limits];
}

// "the upper bound of ζ", for parameters of one value.
function boundsMet({ parameters }) {
  return parameters
    .filter(({ scheduled, values }) => !scheduled && values.length > 0)
    .flatMap((parameter) => {
      const { lower, upper } = knotsAtBounds(parameter);
      const of = (end) => `the ${end} bound of ${symbolText(parameter.name)}`;
      return [...(lower.length ? [of("lower")] : []), ...(upper.length ? [of("upper")] : [])];
    });
}

// "It breaks the limit of stroke, at most 5 mm over 20 to 48 rad/s, by 12 %: 5.6 mm at 30 rad/s (heavy)."
function brokenSentence(tuning, { name, unit, value, at, scenario, band, lower, upper, excess, brokenEnd }) {
  const text = (number) => quantityText(number, unit, digits);
  const over = band ? ` over ${numberText(band.from, digits)} to ${placeText(tuning, band.to)}` : "";
  const there = Number.isFinite(at) ? ` at ${placeText(tuning, at)}` : "";
  return (
    `It breaks the limit of ${words(name)}, ${brokenEnd} ${text(brokenEnd === "at most" ? upper : lower)}${over}, by ` +
    `${percentText(100 * excess, digits)}: ${text(value)}${there}${scenario ? ` (${words(scenario)})` : ""}.`
  );
}

// For a design that is no proven optimum: the limits it breaks and the bounds it lies on; its multipliers mean nothing.
function unprovenSentences(tuning) {
  const broken = tuning.limits
    .filter((limit) => limit.excess > 0)
    .map((limit) => brokenSentence(tuning, limit));
  const met = boundsMet(tuning);
  return [...broken, ...(met.length ? [`It lies on ${listText(met)}.`] : [])];
}

function heldSentences(tuning) {
  if (!tuning.converged) return unprovenSentences(tuning);
  const held = holders(tuning);
  return held.length
    ? [`The design is held by ${held.join("; ")}.`]
    : ["Neither a bound nor a limit determines the design: it is free on all sides."];
}

function knotSentences({ parameters }) {
  const knots = parameters
    .filter(({ scheduled }) => scheduled)
    .map((parameter) => {
      const { lower, upper } = knotsAtBounds(parameter);
      return (
        `${symbolText(parameter.name)} lies on its lower bound at ${lower.length} and on its upper at ` +
        `${upper.length} of ${parameter.knots.length} knots`
      );
    });
  return knots.length ? [`${knots.join("; ")}.`] : [];
}

function slopeText({ unit, maxSlope }, band) {
  const per = unitText(band.unit);
  return `${quantityText(maxSlope, unit, digits)} per ${per || "unit"} of ${symbolText(band.name)}`;
}

// Where schedules change as fast as they may.
function slopeSentences({ parameters, band }) {
  return parameters
    .filter((parameter) => parameter.scheduled && band && Number.isFinite(parameter.maxSlope))
    .map((parameter) => {
      const steep = steepestPieces(parameter),
        all = parameter.knots.length - 1;
      const where = steep > 0 ? `at ${steep} of ${all} pieces, which also determines the design` : "nowhere";
      return `${symbolText(parameter.name)} changes as fast as allowed (${slopeText(parameter, band)}) ${where}.`;
    });
}

const touching = 0.999; // share of the constant's response, from which the constant determines the design

function dominateSentences(tuning) {
  const nearest = tuning.texts.dominate === "constant" ? nearestToConstant(tuning) : null;
  if (!nearest) return [];
  const holds = tuning.converged && nearest.ratio > touching ? ", which also determines the design" : "";
  return [
    `The study requires a response nowhere above that of the best constant design: it is at most ` +
      `${percentText(100 * nearest.ratio, 6)} of it, at ${placeText(tuning, nearest.at)}${holds}.`,
  ];
}

// Where the columns beside the schedule are within their range.
function columnSentences(tuning) {
  return tuning.columns
    .filter(({ lower, upper }) => Number.isFinite(lower) || Number.isFinite(upper))
    .map(({ name, values, lower, upper }) => {
      const room = Float64Array.from(values, (value) =>
        Math.min(
          Number.isFinite(lower) ? value - lower : Infinity,
          Number.isFinite(upper) ? upper - value : Infinity,
        ),
      );
      const inside = nonNegative(tuning.band.values, room);
      return `${words(name)} is within its range ${intervalText(tuning, inside)}.`;
    });
}

function detuningSentences(tuning) {
  const worst = worstDetuning(tuning, 0.05);
  if (!worst) return [];
  const off = `${symbolText(worst.name)} 5 % ${worst.change < 0 ? "less" : "more"}`;
  if (worst.growth <= 0) return ["No parameter that is off by 5 % makes it worse."];
  return [
    `One parameter that is off by 5 % makes the ` +
      `${tuning.isWorst ? "worst peak" : tuning.kind === "variance" ? "variance" : "mean square"} grow ` +
      `by at most ${percentText(100 * worst.growth)} (${off}).`,
  ];
}

// With friction, stops or tables a response does not grow in proportion to its excitation, and nor does an optimum hold
// for another one.
function excitationSentences({ excitation, excitations }) {
  if (!excitation && excitations.length === 0) return [];
  const held = excitation
    ? `this excitation: ${excitation}`
    : `the excitations of its ${excitations.length} scenarios, which are listed below`;
  return [
    `The design holds for ${held}. Friction, stops and tables do not scale with the motion: under ` +
      `another amplitude it is the best only if their forces and clearances are changed in the same proportion.`,
  ];
}

function noNumberSentences(tuning) {
  const { before } = tuning.worst;
  if (tuning.outcome !== "unbounded") return [`There is no number for the ${spoken(tuning)} of this design.`];
  return [
    `The ${spoken(tuning)} of this design is unbounded.`,
    ...(before === Infinity ? ["So is that of the design before."] : []),
  ];
}

// The limits for which the problem was solved, and the limit whose design the page shows.
function tradeOffSentences(tuning) {
  const { front, limits, group } = tuning;
  if (!front) return [];
  const { values, unit } = front.column("trade_off"),
    objectives = front.values("objective");
  const told = Array.from(values, (_, i) => i).filter((i) => front.word("outcome", i) === "converged");
  const point = (i) =>
    `${quantityText(amplitude(tuning, objectives[i]), tuning.root, digits)} at ${quantityText(values[i], unit, digits)}`;
  const range =
    told.length > 1
      ? `: ${spoken(tuning)} from ${point(told[0])} to ${point(told.at(-1))}`
      : told.map((i) => `: ${spoken(tuning)} ${point(i)}`).join("");
  const count = told.length === values.length ? "all" : told.length === 0 ? "none" : told.length;
  return [
    `Trade-off over ${values.length} limits of ${words(limits.at(-1)?.name ?? "one quantity")}, ${count} converged${range}.`,
    `What follows is the design for the last limit, ${quantityText(group.number("trade_off"), unit, digits)}.`,
  ];
}

// The text on a tuning, as paragraphs: [[sentence, ...], ...].
export function whatItMeans(tuning) {
  if (!Number.isFinite(tuning.objective)) return [noNumberSentences(tuning)];
  return [
    tradeOffSentences(tuning),
    [...reductionSentences(tuning), ...bandSentences(tuning), ...excitationSentences(tuning)],
    certificateSentences(tuning),
    [
      ...heldSentences(tuning),
      ...knotSentences(tuning),
      ...slopeSentences(tuning),
      ...dominateSentences(tuning),
      ...columnSentences(tuning),
      ...detuningSentences(tuning),
    ],
  ].filter((paragraph) => paragraph.length > 0);
}
