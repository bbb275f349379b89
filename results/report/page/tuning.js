// A tuning as its page uses it, read from the group /optimum: designs, responses, peaks, limits.
import { words } from "./units.js";

export const designNames = { before: "before", after: "tuned", constant: "best constant", rule: "rule" };
const sameHeight = 1e-6; // relative, within which two peaks are as high

// "(m)2" to "m": the unit of the root of a mean square or a variance.
export function rootUnit(unit) {
  return /^\((.*)\)2$/.exec(unit)?.[1] ?? unit;
}

// The quantity tuned in words; a variance is of the motion, not of its root mean square.
export function quantityWords({ kind, quantity }) {
  const text = words(quantity);
  return kind === "variance" ? text.replace(/ rms$/, "") : text;
}

// The quantity with its weight: the response in the record.
export function responseWords(tuning) {
  return `${tuning.weight ? "weighted " : ""}${words(tuning.quantity)}`;
}

function listOf(text) {
  return (text ?? "").split(",").filter(Boolean);
}

function parameterOf(group, name) {
  const column = group.column(name);
  const number = (suffix) => group.number(`${name}_${suffix}`);
  const knots = group.values(`knots_${name}`);
  return {
    name,
    unit: column?.unit ?? "1",
    values: column?.values ?? new Float64Array(0),
    knots,
    scheduled: knots !== undefined,
    lower: number("lower"),
    upper: number("upper"),
    before: number("before"),
    constant: number("constant"),
    maxSlope: number("max_slope"),
    jump: { at: number("jump_at"), from: number("jump_from"), to: number("jump_to") },
    atBound: group.words(`${name}_at_bound`),
    lowerMultiplier: group.values(`${name}_lower_multiplier`) ?? [],
    upperMultiplier: group.values(`${name}_upper_multiplier`) ?? [],
    schedule: group.values(`${name}_schedule`),
    rule: group.values(`${name}_rule`),
    sensitivity: group.values(`${name}_sensitivity`) ?? [],
    detuning: group.values(`${name}_detuning`),
  };
}

// Whether a value of the band's parameter is an end of the band.
function isEndOf(band, at) {
  if (!band?.length) return false;
  const near = 1e-9 * Math.abs(band.at(-1) - band[0]);
  return Math.abs(at - band[0]) <= near || Math.abs(at - band.at(-1)) <= near;
}

// What an objective is: an amplitude or a mean of squares; the worst of several or their mean.
const amplitudes = ["minimax", "worst_peak", "mean_peak"];
const worsts = ["minimax", "worst_peak"];

// The peaks that hold the design are known only if the tuning converged; of a mean every peak counts, so none holds it.
function peaksOf(group, band, { scenarios, records }, { isWorst, objective }) {
  const values = group.values("peak_value") ?? [];
  return Array.from(values, (value, i) => {
    const share = group.values("peak_multiplier")[i],
      at = group.values(`peak_${band}`)[i];
    return {
      at,
      atEnd: isEndOf(group.values(band), at),
      value,
      share,
      before: group.values("peak_before")?.[i] ?? NaN,
      active: isWorst && share > 0,
      asHigh: Math.abs(value - objective) <= sameHeight * Math.abs(objective),
      number: i,
      scenario: scenarios[group.values("peak_scenario")[i]] ?? "",
      record: records[group.values("peak_record")?.[i]] ?? "",
    };
  });
}

// The part of the band over which a limit holds, if the study names one.
function limitBand(study, name) {
  return study?.has(`${name}_band_from`)
    ? { from: study.number(`${name}_band_from`), to: study.number(`${name}_band_to`) }
    : null;
}

function limitsOf({ group, study, scenarios, converged, objective }, names) {
  return names.map((name) => {
    const number = (suffix) => group.number(`${name}_${suffix}`);
    const value = number("limited"),
      lower = number("lower_limit"),
      multiplier = number("limit_multiplier");
    return {
      name,
      unit: group.column(`${name}_limited`)?.unit ?? "1",
      value,
      at: number("limited_at"),
      scenario: scenarios[number("limited_scenario")] ?? "",
      lower,
      upper: number("upper_limit"),
      multiplier,
      band: limitBand(study, name),
      excess: number("limit_excess"),
      brokenEnd: value < lower ? "at least" : "at most",
      active: multiplier > 0,
    };
  });
}

function responsesOf(group, suffixes) {
  return Object.keys(designNames)
    .flatMap((design) =>
      suffixes.map(({ suffix, scenario }) => ({
        design,
        scenario,
        values: group.values(`response_${design}${suffix}`),
      })),
    )
    .filter(({ values }) => values);
}

function extraColumns(group, band) {
  return group
    .along(band)
    .filter(({ name }) => group.has(`${name}_range`) && group.column(`${name}_range`).kind === "flag")
    .map((column) => ({
      ...column,
      range: group.column(`${column.name}_range`),
      lower: group.number(`${column.name}_range_lower`),
      upper: group.number(`${column.name}_range_upper`),
    }));
}

// Bounds of a parameter that hold the design: [{end, knots, multiplier, gain}], gain: relative fall of the objective
// when that bound is moved outwards by a hundredth of the range.
export function heldBounds({ objective }, parameter) {
  const room = (parameter.upper - parameter.lower) / 100;
  return [
    ["lower", parameter.lowerMultiplier],
    ["upper", parameter.upperMultiplier],
  ]
    .map(([end, multipliers]) => {
      const holding = Array.from(multipliers).filter((multiplier) => multiplier > 0);
      const sum = holding.reduce((a, b) => a + b, 0);
      return { end, knots: holding.length, multiplier: sum, gain: (sum * room) / objective };
    })
    .filter(({ knots }) => knots > 0);
}

// Knots of a schedule that lie on a bound: {lower, upper}, each an array of numbers of knots.
export function knotsAtBounds({ atBound }) {
  const on = (end) => atBound.flatMap((at, i) => (at === end ? [i] : []));
  return { lower: on("lower"), upper: on("upper") };
}

const atSlope = 1e-6; // relative, within which a piece is as steep as it may be

// Pieces of a schedule that are as steep as they may be, its jump left out; NaN where nothing bounds its slope.
export function steepestPieces({ knots, values, maxSlope, jump }) {
  if (!Number.isFinite(maxSlope)) return NaN;
  let count = 0;
  for (let i = 0; i + 1 < knots.length; ++i) {
    if (knots[i] < jump?.at && jump?.at < knots[i + 1]) continue;
    const slope = Math.abs((values[i + 1] - values[i]) / (knots[i + 1] - knots[i]));
    if (slope >= maxSlope * (1 - atSlope)) ++count;
  }
  return count;
}

// The largest ratio of the tuned response to that of the best constant design: {ratio, at}; null if the record lacks
// one of the two.
export function nearestToConstant({ band, responses }) {
  const of = (design) => responses.filter((response) => response.design === design);
  const after = of("after"),
    constant = of("constant");
  if (!band || after.length === 0 || after.length !== constant.length) return null;
  let nearest = { ratio: -Infinity, at: NaN };
  after.forEach(({ values }, s) =>
    values.forEach((value, i) => {
      const ratio = value / constant[s].values[i];
      if (ratio > nearest.ratio) nearest = { ratio, at: band.values[i] };
    }),
  );
  return nearest;
}

// The number of final rounds that settle what a schedule's worst peak leaves free; their bound is a mean response.
export function settlingRounds({ group, kind, parameters, objective }) {
  const bounds = group.values("round_bound") ?? [];
  if (kind !== "minimax" || !parameters.some(({ scheduled }) => scheduled)) return 0;
  const bound = objective * (1 - group.number("certificate_gap"));
  const decisive = bounds.findLastIndex((value) => Math.abs(value - bound) <= 1e-6 * Math.abs(bound));
  return decisive < 0 ? 0 : bounds.length - 1 - decisive;
}

// Of a tuning over records the file has the peaks before; a quantile of them is not made here.
function worstOf(group, peaks, { isWorst, texts, objective }) {
  const worst = Object.fromEntries(
    Object.keys(designNames).map((design) => [design, group.number(`worst_${design}`)]),
  );
  const before = peaks.map((peak) => peak.before).filter(Number.isFinite);
  if (before.length === 0 || before.length < peaks.length || texts.quantile) return worst;
  const mean = before.reduce((sum, value) => sum + value, 0) / before.length;
  return { ...worst, before: isWorst ? Math.max(...before) : mean, after: objective };
}

// The excitation of each scenario, where these differ in it.
function excitationsOf(study, scenarios) {
  return scenarios
    .map((scenario) => ({ scenario, excitation: study?.texts[`excitation_${scenario}`] ?? "" }))
    .filter(({ excitation }) => excitation !== "");
}

export function tuningOf(record) {
  const group = record.groups.get("optimum"),
    { texts } = group;
  const band = texts.band_parameter,
    objective = group.number("objective");
  const scenarios = listOf(texts.scenarios);
  const several =
    scenarios.some((scenario) => group.has(`response_after_${scenario}`)) || scenarios.length > 1;
  const suffixes = several
    ? scenarios.map((scenario) => ({ scenario, suffix: `_${scenario}` }))
    : [{ scenario: "", suffix: "" }];
  const unit = group.column("objective")?.unit ?? "1";
  const kind = texts.objective_kind,
    isWorst = worsts.includes(kind),
    isAmplitude = amplitudes.includes(kind);
  const outcome = group.word("outcome"),
    state = { converged: outcome === "converged", objective, isWorst };
  const records = listOf(texts.records),
    peaks = peaksOf(group, band, { scenarios: several ? scenarios : [], records }, state);
  return {
    group,
    texts,
    ...state,
    outcome,
    kind,
    isAmplitude,
    quantity: texts.quantity,
    unit,
    root: isAmplitude ? unit : rootUnit(unit),
    reason: texts.reason ?? "",
    excitation: record.groups.get("study")?.texts.excitation ?? "",
    excitations: excitationsOf(record.groups.get("study"), scenarios),
    scenarios: several ? scenarios : [],
    parameters: listOf(texts.parameters).map((name) => parameterOf(group, name)),
    records,
    peaks,
    limits: limitsOf(
      { group, study: record.groups.get("study"), scenarios: several ? scenarios : [], ...state },
      listOf(texts.limits),
    ),
    band: band && group.has(band) ? group.column(band) : null,
    place: { name: band, unit: (group.column(band) ?? group.column(`peak_${band}`))?.unit ?? "1" }, // of peaks
    weight: group.values("weight"),
    responses: responsesOf(group, suffixes),
    worst: worstOf(group, peaks, { isWorst, texts, objective }),
    columns: band ? extraColumns(group, band) : [],
    front: record.groups.get("optimum/front"),
  };
}
