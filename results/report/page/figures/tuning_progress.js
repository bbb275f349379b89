// How a tuning came about and how firm it stands: detuning, rounds of exchange, starts, the front of a trade-off.
import { symbolText } from "../axes.js";
import { words } from "../units.js";
import { lineFigure, style } from "./line_figure.js";
import { lineColours } from "./frame.js";

const objectiveWords = { minimax: "worst", mean_square: "mean square of", variance: "variance of" };

export function objectiveLabel({ kind, quantity, weight }) {
  return `${objectiveWords[kind] ?? words(kind)} ${weight ? "weighted " : ""}${words(quantity)}`;
}

function percent(values) {
  return Float64Array.from(values, (value) => 100 * value);
}

// Curves through the optimum itself, where nothing has changed.
export function detuningFigure({ group, parameters, kind }) {
  const changes = Array.from(group.values("change"));
  const order = [...changes.keys()].sort((a, b) => changes[a] - changes[b]);
  const place = order.findIndex((i) => changes[i] > 0);
  const withOptimum = (values) => {
    const sorted = order.map((i) => values[i]);
    sorted.splice(place < 0 ? sorted.length : place, 0, 0);
    return percent(sorted);
  };
  const x = withOptimum(changes);
  const lines = parameters.filter(({ detuning }) => detuning).map(({ name, detuning }, i) => (
    { name: `${name}_detuning`, text: symbolText(name), x, y: withOptimum(detuning), ...style(i) }));
  const grows = kind === "minimax" ? "worst peak" : "objective";
  return lineFigure({
    name: "detuning", title: "What a parameter that is off costs",
    caption: `One parameter is changed, the others stay. Where the ${grows} falls, a bound or a limit stands in the way of the change.`,
    x: { label: "change of one parameter", name: "change", unit: "percent" }, y: { label: `growth of the ${grows}`, unit: "percent" },
    lines, points: lines.map((line) => ({ ...line, silent: true, text: "" })),
  });
}

export function roundsFigure(tuning) {
  const { group, kind, unit } = tuning;
  const x = Float64Array.from(group.values("round_bound"), (_, i) => i + 1);
  const line = (name, text, number) => ({ name, text, x, y: group.values(name), ...style(number) });
  const lines = [line("round_bound", kind === "minimax" ? "bound: over the active frequencies" : "objective", 0),
    ...(kind === "minimax" ? [line("round_worst", "worst: over the whole band", 1)] : [])];
  return lineFigure({
    name: "rounds", title: "Rounds of the tuning",
    caption: kind === "minimax" ? "Each round adds the peaks found to the active frequencies, until bound and worst peak meet." : "",
    x: { label: "round", unit: "1", ticks: whole(x.length), tickFormat: "d" }, y: { label: objectiveLabel(tuning), unit },
    lines, points: lines.map((drawn) => ({ ...drawn, silent: true, text: "" })),
  });
}

// What is left between bound and worst peak, relative, by rounds.
export function gapFigure({ group }) {
  const bound = group.values("round_bound"), worst = group.values("round_worst");
  const x = Float64Array.from(bound, (_, i) => i + 1);
  const gap = Float64Array.from(bound, (value, i) => Math.abs(worst[i] - value) / Math.abs(worst[i]));
  const violation = group.values("round_violation");
  const drawn = [{ name: "round_gap", text: "gap: (worst \u2212 bound) / worst, magnitude", x, y: gap, ...style(0) }];
  if (violation?.some((value) => value > 0)) drawn.push({ name: "round_violation", text: "violation of the limits", x, y: violation, ...style(1) });
  return lineFigure({
    name: "gap", title: "Gap by rounds", caption: "On a logarithmic scale; what is exactly zero is not drawn.",
    x: { label: "round", unit: "1", ticks: whole(x.length), tickFormat: "d" }, y: { label: "relative", unit: "1", type: "log" },
    lines: drawn, points: drawn.map((line) => ({ ...line, silent: true, text: "" })),
  });
}

function whole(count) {
  const step = Math.ceil(count / 12);
  return Array.from({ length: count }, (_, i) => i + 1).filter((i) => (i - 1) % step === 0);
}

const outcomeColours = { converged: lineColours[0], not_converged: lineColours[4], infeasible: lineColours[1], stopped: lineColours[5] };

function byOutcome(group, column, x, y, name) {
  const outcomes = group.column(column);
  return outcomes.flags.map(([code, word]) => {
    const rows = Array.from(x, (_, i) => i).filter((i) => outcomes.values[i] === code);
    return { name: `${name}_${word}`, text: words(word), stroke: outcomeColours[word] ?? lineColours[6], r: 4,
      symbol: word === "converged" ? "full" : "open", x: rows.map((i) => x[i]), y: rows.map((i) => y[i]) };
  }).filter((points) => points.x.length > 0);
}

export function startsFigure(tuning) {
  const { group, unit } = tuning;
  const x = group.values("start"), y = group.values("start_objective");
  return lineFigure({
    name: "starts", title: "What each start found", caption: `The best is start ${group.number("best_start")}.`,
    x: { label: "start", unit: "1", tickFormat: "d", ticks: whole(x.length).map((i) => x[i - 1]) },
    y: { label: objectiveLabel(tuning), unit },
    points: byOutcome(group, "start_outcome", x, y, "objective"),
    levels: [{ text: "chosen", y: group.number("objective"), stroke: lineColours[7], dash: "4 3" }],
  });
}

export function frontFigure(tuning) {
  const { front, limits, unit } = tuning;
  const limit = front.column("trade_off"), y = front.values("objective");
  const name = words(limits.at(-1)?.name ?? "limit");
  const order = [...limit.values.keys()].sort((a, b) => limit.values[a] - limit.values[b]);
  const sorted = (values) => Float64Array.from(order, (i) => values[i]);
  return lineFigure({
    name: "front", title: `Front: ${objectiveLabel(tuning)} against the limit of ${name}`,
    caption: "Each point is tuned for itself; where the front is level the limit does not bind.",
    x: { label: `limit of ${name}`, name: "trade_off", unit: limit.unit }, y: { label: objectiveLabel(tuning), unit },
    lines: [{ name: "objective", x: sorted(limit.values), y: sorted(y), stroke: lineColours[7], width: 1.2 }],
    points: byOutcome(front, "outcome", limit.values, y, "objective").map((points) => ({ ...points, silent: true })),
  });
}
