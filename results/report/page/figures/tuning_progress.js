// The progress and robustness of a tuning: detuning, rounds of exchange, starts, the front of a trade-off.
import { symbolText } from "../axes.js";
import { quantityWords, settlingRounds } from "../tuning.js";
import { words } from "../units.js";
import { lineFigure, style } from "./line_figure.js";
import { lineColours } from "./frame.js";

const objectiveWords = {
  minimax: "worst",
  worst_peak: "worst",
  mean_peak: "mean",
  mean_square: "mean square of",
  variance: "variance of",
};

export function objectiveLabel(tuning) {
  return (
    `${objectiveWords[tuning.kind] ?? words(tuning.kind)} ` +
    `${tuning.weight ? "weighted " : ""}${quantityWords(tuning)}`
  );
}

function percent(values) {
  return Float64Array.from(values, (value) => 100 * value);
}

// Detuning curves, with the optimum itself added at no change.
export function detuningFigure({ group, parameters, isWorst }) {
  const changes = Array.from(group.values("change"));
  const order = [...changes.keys()].sort((a, b) => changes[a] - changes[b]);
  const place = order.findIndex((i) => changes[i] > 0);
  const withOptimum = (values) => {
    const sorted = order.map((i) => values[i]);
    sorted.splice(place < 0 ? sorted.length : place, 0, 0);
    return percent(sorted);
  };
  const x = withOptimum(changes);
  const lines = parameters
    .filter(({ detuning }) => detuning)
    .map(({ name, detuning }, i) => ({
      name: `${name}_detuning`,
      text: symbolText(name),
      x,
      y: withOptimum(detuning),
      ...style(i),
    }));
  const grows = isWorst ? "worst peak" : "objective";
  return lineFigure({
    name: "detuning",
    title: "The cost of a parameter that is off",
    caption:
      `One parameter is changed, the others are kept. Where the ${grows} falls, a bound or a limit prevents ` +
      `the change.`,
    x: { label: "change of one parameter", name: "change", unit: "percent" },
    y: { label: `growth of the ${grows}`, unit: "percent" },
    lines,
    points: dotted(lines),
  });
}

// The rounds that lower the objective, without those that settle what it leaves free.
function pressingRounds(tuning) {
  const { group } = tuning;
  const count = group.values("round_bound").length - settlingRounds(tuning);
  const of = (name) => group.values(name)?.subarray(0, count);
  return {
    x: Float64Array.from({ length: count }, (_, i) => i + 1),
    bound: of("round_bound"),
    worst: of("round_worst"),
    violation: of("round_violation"),
  };
}

function settlingText(tuning) {
  const count = settlingRounds(tuning);
  if (count === 0) return "";
  return (
    ` The last ${count === 1 ? "round is" : `${count} rounds are`} not drawn: with the worst peak fixed, ` +
    `${count === 1 ? "it reduces" : "they reduce"} the mean response.`
  );
}

const roundAxis = (x) => ({ label: "round", unit: "1", ticks: whole(x.length), tickFormat: "d" });
const dotted = (lines) => lines.map((drawn) => ({ ...drawn, silent: true, text: "" }));

export function roundsFigure(tuning) {
  const { isWorst, unit, parameters, records } = tuning;
  const { x, bound, worst } = pressingRounds(tuning);
  const [cases, everywhere] = records.length
    ? ["instants", "all of each record"]
    : ["frequencies", "the whole band"];
  const lines = [
    {
      name: "round_bound",
      text: isWorst ? `bound: over the active ${cases}` : "objective",
      x,
      y: bound,
      ...style(0),
    },
    ...(isWorst
      ? [{ name: "round_worst", text: `worst: over ${everywhere}`, x, y: worst, ...style(1) }]
      : []),
  ];
  const adds = `Each round adds the peaks found to the active ${cases}, until bound and worst peak meet.`;
  const exchange = isWorst ? adds : "";
  const constants = parameters.some(({ scheduled }) => scheduled)
    ? " The best constants come first, then the schedule."
    : "";
  return lineFigure({
    name: "rounds",
    title: "Rounds of the tuning",
    caption: `${exchange}${constants}${settlingText(tuning)}`.trim(),
    x: roundAxis(x),
    y: { label: objectiveLabel(tuning), unit },
    lines,
    points: dotted(lines),
  });
}

// The relative gap between bound and worst peak, round by round.
export function gapFigure(tuning) {
  const { x, bound, worst, violation } = pressingRounds(tuning);
  const gap = Float64Array.from(bound, (value, i) => Math.abs(worst[i] - value) / Math.abs(worst[i]));
  const lines = [{ name: "round_gap", text: "|worst \u2212 bound| / worst", x, y: gap, ...style(0) }];
  if (violation?.some((value) => value > 0))
    lines.push({ name: "round_violation", text: "violation of the limits", x, y: violation, ...style(1) });
  return lineFigure({
    name: "gap",
    title: "Gap by rounds",
    caption: "Exact zeros are not drawn on the logarithmic scale.",
    x: roundAxis(x),
    y: { label: "relative gap", unit: "1", type: "log" },
    lines,
    points: dotted(lines),
  });
}

function whole(count) {
  const step = Math.ceil(count / 12);
  return Array.from({ length: count }, (_, i) => i + 1).filter((i) => (i - 1) % step === 0);
}

const outcomeColours = {
  converged: lineColours[0],
  not_converged: lineColours[4],
  infeasible: lineColours[1],
  stopped: lineColours[5],
};

function byOutcome(group, column, x, y, name) {
  const outcomes = group.column(column);
  return outcomes.flags
    .map(([code, word]) => {
      const rows = Array.from(x, (_, i) => i).filter((i) => outcomes.values[i] === code);
      return {
        name: `${name}_${word}`,
        text: words(word),
        stroke: outcomeColours[word] ?? lineColours[6],
        r: 4,
        symbol: word === "converged" ? "full" : "open",
        x: rows.map((i) => x[i]),
        y: rows.map((i) => y[i]),
      };
    })
    .filter((points) => points.x.length > 0);
}

export function startsFigure(tuning) {
  const { group, unit } = tuning;
  const x = group.values("start"),
    y = group.values("start_objective");
  return lineFigure({
    name: "starts",
    title: "Result of each start",
    caption: `The best is start ${group.number("best_start")}, counted from 0.`,
    x: { label: "start", unit: "1", tickFormat: "d", ticks: whole(x.length).map((i) => x[i - 1]) },
    y: { label: objectiveLabel(tuning), unit },
    points: byOutcome(group, "start_outcome", x, y, "objective"),
    levels: [{ text: "chosen", y: group.number("objective"), stroke: lineColours[7], dash: "4 3" }],
  });
}

function frontCaption(outcomes) {
  const infeasible = outcomes.includes("infeasible")
    ? " An infeasible point is the design that breaks the limits least; it does not keep its limit."
    : "";
  return (
    "Each point is a tuning of its own. The line joins those that converged; where it is level, the limit does not bind." +
    infeasible
  );
}

export function frontFigure(tuning) {
  const { front, limits, unit } = tuning;
  const limit = front.column("trade_off"),
    y = front.values("objective");
  const name = words(limits.at(-1)?.name ?? "limit");
  const order = [...limit.values.keys()].sort((a, b) => limit.values[a] - limit.values[b]);
  const sorted = (values) => Array.from(order, (i) => values[i]);
  const rows = Array.from(limit.values, (_, i) => front.word("outcome", i));
  const joined = Array.from(y, (value, i) => (rows[i] === "converged" ? value : NaN));
  const figure = lineFigure({
    name: "front",
    title: `Front: ${objectiveLabel(tuning)} against the limit of ${name}`,
    caption: frontCaption(rows),
    x: { label: `limit of ${name}`, unit: limit.unit },
    y: { label: objectiveLabel(tuning), unit },
    lines: [{ x: sorted(limit.values), y: sorted(joined), stroke: lineColours[7], width: 1.2, silent: true }],
    points: byOutcome(front, "outcome", limit.values, y, "objective"),
  });
  const columns = [
    { name: `${limits.at(-1)?.name ?? "trade_off"}_limit`, unit: limit.unit, values: sorted(limit.values) },
    { name: "objective", unit, values: sorted(y) },
    { name: "outcome", unit: "1", values: sorted(rows) },
    { name: "violation", unit: "1", values: sorted(front.values("violation") ?? []) },
  ];
  return { ...figure, table: () => columns };
}
